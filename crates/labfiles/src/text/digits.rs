//! Digits of decimal numbers, many at a time.
//!
//! Eight bytes are added up in a word and sixteen in a vector, pairs of neighbours first (the
//! method of D. Lemire, "Number parsing at a gigabyte per second", Software: Practice and
//! Experience 51, 2021).

use wide::{i8x16, i16x8, i32x8};

/// Bytes before a number and bytes from its first digit on that [`at_once`] needs.
const BEFORE: usize = 16;
const BEHIND: usize = 32;
/// Bytes of a word.
const WORD: usize = 8;
/// Most digits whose integer 64 bits hold.
pub(crate) const MOST_DIGITS: usize = 19;

/// Least integer that may not fit 64 bits with sixteen further digits.
const LEAST_TOO_GREAT: u64 = 1000;

/// Powers of ten that 64 bits hold.
static TENS: [u64; MOST_DIGITS + 1] = tens();

const fn tens() -> [u64; MOST_DIGITS + 1] {
    let mut all = [1; MOST_DIGITS + 1];
    let mut i = 1;
    while i < all.len() {
        all[i] = 10 * all[i - 1];
        i += 1;
    }
    all
}

/// From the place `n` on, a mask that leaves the last `n` digits of sixteen.
static LAST: [u8; 2 * BEFORE] = last();

const fn last() -> [u8; 2 * BEFORE] {
    let mut all = [0; 2 * BEFORE];
    let mut i = BEFORE;
    while i < all.len() {
        all[i] = 0x0f;
        i += 1;
    }
    all
}

/// A decimal number without sign and exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unsigned {
    /// The integer that all digits make, below 10^19.
    pub mantissa: u64,
    /// Digits after the decimal mark.
    pub places: usize,
    /// The place after the number in the text.
    pub end: usize,
}

/// The number whose first digit is at `at`, without a step for each digit.
///
/// `None` if another way must be taken: the text ends too near, there is no digit, more
/// than seven precede the mark, or all are more than 64 bits hold.
#[inline]
pub(crate) fn at_once(text: &[u8], at: usize, mark: u8) -> Option<Unsigned> {
    let around: &[u8; BEFORE + BEHIND] = text.get(at.wrapping_sub(BEFORE)..)?.first_chunk()?;
    let others = no_digits(around);
    let whole = others.trailing_zeros() as usize;
    if whole == 0 || whole >= WORD {
        return None;
    }
    let first = word(around, BEFORE);
    let (first, end) = if around[BEFORE + whole] == mark {
        let before = (1 << (8 * whole)) - 1;
        let without_mark = (first & before) | (word(around, BEFORE + 1) & !before);
        let next = others & (others - 1);
        (without_mark, next.trailing_zeros() as usize)
    } else {
        (first, whole)
    };
    let places = end.saturating_sub(whole + 1);
    let tail = places.min(BEFORE);
    let lead = whole + places - tail;
    if lead > WORD {
        return None;
    }
    let lead_digits = eight_digits(front(first, lead));
    if lead_digits >= LEAST_TOO_GREAT && lead_digits >= TENS[MOST_DIGITS - tail] {
        return None;
    }
    let tail_digits = sixteen_digits(around[end..].first_chunk()?, LAST[tail..].first_chunk()?);
    Some(Unsigned {
        mantissa: lead_digits * TENS[tail] + tail_digits,
        places,
        end: at + end,
    })
}

/// A bit for each byte from the number's first on that is no digit.
#[inline]
fn no_digits(around: &[u8; BEFORE + BEHIND]) -> u32 {
    let bits = |from: usize| {
        // moved so that the digits are the ten least of the signed numbers
        let moved = |i: usize| around[from + i].wrapping_add(128 - b'0').cast_signed();
        let bytes = i8x16::new(std::array::from_fn(moved));
        bytes.simd_gt(i8x16::splat(-128 + 9)).to_bitmask()
    };
    bits(BEFORE) | bits(2 * BEFORE) << 16
}

/// Eight bytes as a number whose lowest byte is the first.
#[inline]
fn word(around: &[u8; BEFORE + BEHIND], at: usize) -> u64 {
    let mut bytes = [0; WORD];
    bytes.copy_from_slice(&around[at..at + WORD]);
    u64::from_le_bytes(bytes)
}

/// The first `count` bytes of a word moved to its end, zeros before them.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "at most a word's bytes")]
fn front(word: u64, count: usize) -> u64 {
    let half = 4 * (WORD - count) as u32;
    (word << half) << half
}

/// The value of the digits that a mask leaves of sixteen bytes.
#[inline]
fn sixteen_digits(bytes: &[u8; 16], mask: &[u8; 16]) -> u64 {
    let byte = |i: usize| bytes[i] & mask[i];
    let pair = |i: usize| i16::from_le_bytes([byte(2 * i), byte(2 * i + 1)]);
    let pairs = i16x8::new(std::array::from_fn(pair));
    let second: i16x8 = pairs >> 8;
    let twos: i16x8 = (pairs & i16x8::splat(0xff)) * i16x8::splat(10) + second;
    let fours = twos
        .dot(i16x8::new([100, 1, 100, 1, 100, 1, 100, 1]))
        .to_array();
    let [a, b, c, d] = fours;
    let narrow = i16x8::from_i32x8_saturate(i32x8::new([a, b, c, d, 0, 0, 0, 0]));
    let eights = narrow
        .dot(i16x8::new([10_000, 1, 10_000, 1, 0, 0, 0, 0]))
        .to_array();
    u64::from(eights[0].cast_unsigned()) * 100_000_000 + u64::from(eights[1].cast_unsigned())
}

/// Whether eight characters are digits: each becomes 0 to 9 by the exclusive or, and 6 more stay
/// below 16.
#[inline]
fn are_digits(word: u64) -> bool {
    let values = word ^ 0x3030_3030_3030_3030;
    (values.wrapping_add(0x0606_0606_0606_0606) | values) & 0xf0f0_f0f0_f0f0_f0f0 == 0
}

/// The value of eight digits: pairs, then fours, then all at once.
#[inline]
fn eight_digits(word: u64) -> u64 {
    let pairs = (word & 0x0f0f_0f0f_0f0f_0f0f).wrapping_mul((10 << 8) + 1) >> 8;
    let fours = (pairs & 0x00ff_00ff_00ff_00ff).wrapping_mul((100 << 16) + 1) >> 16;
    (fours & 0x0000_ffff_0000_ffff).wrapping_mul((10_000 << 32) + 1) >> 32
}

/// Add the digits from `i` on to a mantissa, eight at a time while there are that many; the place
/// after them.
#[inline]
pub(crate) fn many_digits(bytes: &[u8], mut i: usize, mantissa: &mut u64) -> usize {
    while let Some(eight) = bytes.get(i..).and_then(|rest| rest.first_chunk::<8>()) {
        let word = u64::from_le_bytes(*eight);
        if !are_digits(word) {
            break;
        }
        let moved = mantissa.wrapping_mul(100_000_000);
        *mantissa = moved.wrapping_add(eight_digits(word));
        i += 8;
    }
    few_digits(bytes, i, mantissa)
}

/// Add the digits from `i` on to a mantissa; the place after them.
#[inline]
pub(crate) fn few_digits(bytes: &[u8], mut i: usize, mantissa: &mut u64) -> usize {
    while let Some(digit) = bytes
        .get(i)
        .map(|b| b.wrapping_sub(b'0'))
        .filter(|d| *d < 10)
    {
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        i += 1;
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_end_at_any_other_character() {
        for byte in (0..=255u8).filter(|b| !b.is_ascii_digit()) {
            for place in 0..19 {
                let mut text = *b"1234567890987654321x";
                text[place] = byte;
                let mut mantissa = 0;
                assert_eq!(many_digits(&text, 0, &mut mantissa), place);
                let expected = std::str::from_utf8(&text[..place]).unwrap();
                assert_eq!(mantissa, expected.parse().unwrap_or(0), "{byte} at {place}");
            }
        }
    }

    #[test]
    fn numbers_at_once_end_at_any_other_character() {
        for byte in (0..=255u8).filter(|b| !b.is_ascii_digit()) {
            for (whole, places) in (1..=7).flat_map(|w| (0..=19).map(move |p| (w, p))) {
                let number = [
                    &b"98765432"[..whole],
                    b".",
                    &b"10987654321098765432"[..places],
                ]
                .concat();
                let text = [&[b'7'; 16][..], &number, &[byte], &[b'8'; 32]].concat();
                let expected: String = number
                    .iter()
                    .filter(|b| **b != b'.')
                    .map(|b| char::from(*b))
                    .collect();
                match at_once(&text, 16, b'.') {
                    Some(read) => {
                        assert_eq!(Ok(read.mantissa), expected.parse());
                        assert_eq!((read.places, read.end), (places, 16 + number.len()));
                    }
                    None => assert!(whole + places > MOST_DIGITS),
                }
            }
        }
    }
}
