//! Decimal numbers from bytes, exactly rounded, fast for the lengths that instruments print.

use crate::text::decimal;
use crate::text::digits::{self, MOST_DIGITS, few_digits, many_digits};

/// A decimal number at the front of `bytes`: its value and the number of bytes it takes.
///
/// `mark` is the decimal mark. Exponents are written with e, E, d or D. The value is the
/// binary64 number nearest to the decimal one. `None`: there is no number.
pub(crate) fn parse_prefix(bytes: &[u8], mark: u8) -> Option<(f64, usize)> {
    parse_at(bytes, 0, mark)
}

/// The decimal number at `at` of a text, and the place after it; as [`parse_prefix`], faster
/// for a number inside a text.
// Not inlined, its result goes through memory: a tenth of the time of reading a table.
#[expect(clippy::cast_possible_wrap, reason = "fewer digits than 2^63")]
#[inline(always)]
pub(crate) fn parse_at(text: &[u8], at: usize, mark: u8) -> Option<(f64, usize)> {
    let sign = *text.get(at)?;
    let negative = sign == b'-';
    let first = at + usize::from(negative | (sign == b'+'));
    let Some(read) = digits::at_once(text, first, mark) else {
        return step_by_step(text, at, mark);
    };
    let places = read.places as i64;
    let (power, end) = exponent_at(text, read.end).unwrap_or((0, read.end));
    let value = match decimal::nearest(read.mantissa, power - places) {
        Some(value) => signed(value, negative),
        None => slow(&text[at..end], mark)?,
    };
    Some((value, end))
}

#[inline]
fn signed(value: f64, negative: bool) -> f64 {
    f64::from_bits(value.to_bits() | u64::from(negative) << 63)
}

/// As [`parse_at`], digit by digit.
#[expect(clippy::cast_possible_wrap, reason = "fewer digits than 2^63")]
#[inline(never)]
fn step_by_step(text: &[u8], at: usize, mark: u8) -> Option<(f64, usize)> {
    let sign = *text.get(at)?;
    let first = at + usize::from(matches!(sign, b'-' | b'+'));
    let mut mantissa = 0;
    let mut end = few_digits(text, first, &mut mantissa);
    let mut digits = end - first;
    let mut exponent = 0;
    if text.get(end) == Some(&mark) {
        let (whole, fraction) = (mantissa, end + 1);
        end = many_digits(text, fraction, &mut mantissa);
        exponent = -((end - fraction) as i64);
        if digits == 0 && end == fraction {
            return None;
        }
        // Zeros before the first digit that counts do not lengthen the mantissa.
        digits = if whole == 0 && digits <= MOST_DIGITS {
            significant(text, fraction, end)
        } else {
            digits + end - fraction
        };
    } else if digits == 0 {
        return None;
    }
    let (power, end) = exponent_at(text, end).unwrap_or((0, end));
    let fits = digits <= MOST_DIGITS;
    let value = match fits
        .then(|| decimal::nearest(mantissa, exponent + power))
        .flatten()
    {
        Some(value) => signed(value, sign == b'-'),
        None => slow(&text[at..end], mark)?,
    };
    Some((value, end))
}

/// Digits of a fraction from the first that is not 0.
#[inline]
fn significant(bytes: &[u8], from: usize, to: usize) -> usize {
    if to - from <= MOST_DIGITS {
        return to - from;
    }
    let zeros = bytes[from..to].iter().take_while(|&&b| b == b'0').count();
    to - from - zeros
}

#[inline]
fn digit_at(bytes: &[u8], i: usize) -> Option<i64> {
    let digit = bytes.get(i)?.wrapping_sub(b'0');
    (digit < 10).then_some(i64::from(digit))
}

/// The power of ten of an exponent at `i` and where it ends.
#[inline]
fn exponent_at(bytes: &[u8], i: usize) -> Option<(i64, usize)> {
    if !matches!(bytes.get(i)?, b'e' | b'E' | b'd' | b'D') {
        return None;
    }
    let sign = bytes.get(i + 1)?;
    let mut end = i + 1 + usize::from(matches!(sign, b'+' | b'-'));
    digit_at(bytes, end)?;
    let mut power = 0i64;
    while let Some(digit) = digit_at(bytes, end) {
        power = (power * 10 + digit).min(100_000);
        end += 1;
    }
    Some((if *sign == b'-' { -power } else { power }, end))
}

/// The standard library's conversion, for long mantissas and great exponents.
#[cold]
fn slow(bytes: &[u8], decimal: u8) -> Option<f64> {
    let mut short = [0u8; 64];
    let mut long = Vec::new();
    let text = if bytes.len() <= short.len() {
        &mut short[..bytes.len()]
    } else {
        long.resize(bytes.len(), 0);
        &mut long[..]
    };
    text.copy_from_slice(bytes);
    for b in text.iter_mut() {
        if *b == decimal {
            *b = b'.';
        } else if matches!(*b, b'd' | b'D') {
            *b = b'e';
        }
    }
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// Marks between groups of three digits.
pub(crate) const GROUP_MARKS: [char; 8] = [
    '.', ',', ' ', '\u{a0}', '\u{202f}', '\u{2009}', '\'', '\u{2019}',
];

/// A number whose thousands are separated, as `1.234,56` in a table with decimal commas, and whether it has a
/// decimal part; without one the mark could be the decimal one of another table.
pub(crate) fn parse_grouped(cell: &[u8], decimal: u8) -> Option<(f64, bool)> {
    let text = crate::text::decode(cell.trim_ascii());
    let body = text.strip_prefix(['-', '+', '\u{2212}']).unwrap_or(&text);
    let (whole, fraction) = match body.split_once(char::from(decimal)) {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (body, None),
    };
    let mark = whole.chars().find(|c| !c.is_ascii_digit())?;
    let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
    let mut groups = whole.split(mark);
    groups
        .next()
        .filter(|g| (1..=3).contains(&g.len()) && !g.starts_with('0'))?;
    let known = GROUP_MARKS.contains(&mark) && mark != char::from(decimal);
    if !known || !groups.all(|g| g.len() == 3 && digits(g)) || !fraction.is_none_or(digits) {
        return None;
    }
    let plain: String = whole.chars().filter(|c| *c != mark).collect();
    let value: f64 = format!("{plain}.{}", fraction.unwrap_or("0"))
        .parse()
        .ok()?;
    let negative = text.starts_with(['-', '\u{2212}']);
    Some((if negative { -value } else { value }, fraction.is_some()))
}

/// How the numbers of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Notation {
    /// The decimal mark.
    pub decimal: u8,
    /// Whether a mark between groups of three digits separates thousands, also where no decimal mark shows it.
    pub groups: bool,
}

impl Notation {
    /// Numbers with a decimal mark whose thousands are not separated, or are where both marks show it.
    pub(crate) fn plain(decimal: u8) -> Self {
        Self {
            decimal,
            groups: false,
        }
    }

    /// A cell as a number, as [`parse_cell`], also with its thousands separated.
    pub(crate) fn parse(self, cell: &[u8]) -> Option<f64> {
        parse_cell(cell, self.decimal).or_else(|| {
            let (value, both) = parse_grouped(cell, self.decimal)?;
            (both || self.groups).then_some(value)
        })
    }
}

/// Tokens by which instruments state that there is no number.
const MISSING: [&str; 14] = [
    "", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---", "?", "*", "1.#qnan", "1.#ind",
];

/// Words by which instruments state that a value was beyond their range, lower case.
const OVERLOADS: [&str; 16] = [
    "ovld",
    "ovl",
    "ol",
    "o.l",
    "o.l.",
    "over",
    "overload",
    "overrange",
    "over range",
    "overflow",
    "ovf",
    "ovrflw",
    "clip",
    "clipped",
    "überlauf",
    "übersteuert",
];

/// The sign of minus, which some programs write for a hyphen.
const MINUS: &str = "\u{2212}";

/// The longest word for a number, bytes.
const LONGEST_WORD: usize = 13;

/// A whole cell as a number: a decimal number, an infinity, or NaN for a cell that states that
/// there is none. `None`: the cell holds something else.
pub(crate) fn parse_cell(cell: &[u8], decimal: u8) -> Option<f64> {
    let cell = cell.trim_ascii();
    if let Some((value, end)) = parse_prefix(cell, decimal)
        && end == cell.len()
    {
        return Some(value);
    }
    if let Some(rest) = cell.strip_prefix(MINUS.as_bytes()) {
        let unsigned = rest
            .first()
            .is_some_and(|b| b.is_ascii_digit() || *b == decimal);
        return parse_cell(rest, decimal)
            .filter(|_| unsigned)
            .map(|value| -value);
    }
    if cell.len() > LONGEST_WORD {
        return None;
    }
    let text = crate::text::decode(cell).to_lowercase();
    if MISSING.contains(&text.as_str()) || is_overload(&text) {
        return Some(f64::NAN);
    }
    match text.trim_start_matches('+') {
        "inf" | "infinity" | "1.#inf" => Some(f64::INFINITY),
        "-inf" | "-infinity" | "-1.#inf" => Some(f64::NEG_INFINITY),
        "-nan" | "-1.#ind" | "-1.#qnan" => Some(f64::NAN),
        _ => None,
    }
}

/// Whether a word, lower case, states that a value was beyond the range: with a sign or without, or as a spreadsheet shows a
/// number that its column has no room for.
fn is_overload(word: &str) -> bool {
    let bare = word.trim_start_matches(['+', '-', '>', '<']).trim_start();
    OVERLOADS.contains(&bare) || (word.len() > 2 && word.bytes().all(|b| b == b'#'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn words_of_an_overload_are_no_number_and_no_error() {
        for word in [
            "OVLD",
            "-OL",
            "+OVER",
            "Over Range",
            "O.L",
            "#####",
            "Überlauf",
        ] {
            let read = parse_cell(word.as_bytes(), b'.');
            assert!(read.is_some_and(f64::is_nan), "{word}");
        }
        assert!(parse_cell(b"\xDCberlauf", b',').is_some_and(f64::is_nan));
        assert_eq!(parse_cell(b"oven", b'.'), None);
    }

    #[test]
    fn thousands_are_separated_where_all_groups_are_whole() {
        let of = |text: &str, decimal| parse_grouped(text.as_bytes(), decimal);
        assert_eq!(of("-2.387,95", b','), Some((-2387.95, true)));
        assert_eq!(of("1,234,567.5", b'.'), Some((1_234_567.5, true)));
        assert_eq!(of("1\u{a0}234,5", b','), Some((1234.5, true)));
        assert_eq!(of("12'345.25", b'.'), Some((12_345.25, true)));
        assert_eq!(of("2.388", b','), Some((2388.0, false)));
        for text in [
            "0.001",
            "12.34",
            "1.2345",
            "1.234.56",
            "1234.567",
            "1..234",
            "a.123",
            "1.234,5e2",
        ] {
            assert_eq!(of(text, b','), None, "{text}");
        }
        assert_eq!(Notation::plain(b',').parse(b"2.388"), None);
        assert_eq!(Notation::plain(b',').parse(b"2.388,5"), Some(2388.5));
    }

    #[test]
    fn numbers_as_instruments_print_them() {
        for (text, value) in [
            ("1.953125E-5", 1.953125e-5),
            ("-0.0", -0.0),
            (".5", 0.5),
            ("5.", 5.0),
            ("1D3", 1e3),
        ] {
            assert_eq!(parse_cell(text.as_bytes(), b'.'), Some(value), "{text}");
        }
        assert_eq!(parse_cell(b" 0,914018 ", b','), Some(0.914018));
        assert_eq!(parse_prefix(b"12;3", b','), Some((12.0, 2)));
        assert_eq!(parse_prefix(b"1e", b'.'), Some((1.0, 1)));
        for text in ["", ".", "-", "abc", "e5"] {
            assert_eq!(parse_prefix(text.as_bytes(), b'.'), None, "{text}");
        }
        assert!(parse_cell(b"NaN", b'.').unwrap().is_nan());
        assert_eq!(parse_cell(b"1.5 V", b'.'), None);
        assert_eq!(parse_cell("\u{2212}1,5e-3".as_bytes(), b','), Some(-1.5e-3));
        assert_eq!(parse_cell("\u{2212}\u{2212}1".as_bytes(), b','), None);
    }

    /// A decimal number as no instrument prints it: sign, zeros, up to thirty digits on either
    /// side of the mark, an exponent.
    fn odd_number(random: &mut impl rand::Rng, mark: char) -> String {
        let mut digits = |most: usize| -> String {
            let zeros = random.random_range(0..=most / 2) * usize::from(random.random_bool(0.3));
            let count = random.random_range(0..=most - zeros);
            let digit = |_| char::from(random.random_range(b'0'..=b'9'));
            let further: String = (0..count).map(digit).collect();
            "0".repeat(zeros) + &further
        };
        let (long, short) = (digits(30), digits(4));
        let (fraction, exponent) = (digits(30), digits(3));
        let whole = if random.random_bool(0.2) { long } else { short };
        let mut text = ["", "", "-", "+"][random.random_range(0..4)].to_owned() + &whole;
        if whole.is_empty() || random.random_bool(0.8) {
            text.push(mark);
            text += &fraction;
            if whole.is_empty() && fraction.is_empty() {
                text.push('5');
            }
        }
        if random.random_bool(0.3) && !exponent.is_empty() {
            text.push(['e', 'E', 'd', 'D'][random.random_range(0..4)]);
            text += ["", "-", "+"][random.random_range(0..3)];
            text += &exponent;
        }
        text
    }

    #[test]
    fn prop_numbers_inside_a_text_equal_the_standard_parsers() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for _ in 0..200_000 {
            let mark = [b'.', b','][random.random_range(0..2)];
            let written = match random.random_range(0..4) {
                0 => format!("{}", f64::from_bits(random.random())),
                1 => format!("{:e}", f64::from_bits(random.random::<u64>() >> 11)),
                2 => format!(
                    "{:.*}",
                    random.random_range(0..20),
                    random.random_range(-10.0..10.0)
                ),
                _ => odd_number(&mut random, '.'),
            };
            if written.contains(['N', 'i']) {
                continue;
            }
            let expected: f64 = written.replace(['d', 'D'], "e").parse().unwrap();
            let written = written.replace('.', &char::from(mark).to_string());
            let after = [";", "\n", " ", ";8,8.8", "x1"][random.random_range(0..5)];
            for blanks in [0, 16] {
                let text = format!("{:blanks$}{written}{after}{:40}", "", "");
                let (value, end) = parse_at(text.as_bytes(), blanks, mark).unwrap();
                assert_eq!(value.to_bits(), expected.to_bits(), "{written}");
                assert_eq!(end, blanks + written.len(), "{written}");
            }
        }
    }

    proptest! {
        #[test]
        fn prop_every_binary64_number_comes_back(bits: u64) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value}"), format!("{value:e}"), format!("{value:.6}")] {
                let expected: f64 = text.parse().unwrap();
                let (read, end) = parse_prefix(text.as_bytes(), b'.').unwrap();
                prop_assert_eq!(read.to_bits(), expected.to_bits());
                prop_assert_eq!(end, text.len());
            }
        }

        #[test]
        fn prop_short_decimals_are_rounded_once(m in -99_999_999i64..99_999_999, e in 0u32..9) {
            let text = format!("{:.*}", e as usize, m as f64 / 10f64.powi(e as i32));
            let expected: f64 = text.parse().unwrap();
            prop_assert_eq!(parse_prefix(text.as_bytes(), b'.').unwrap().0, expected);
        }

        #[test]
        fn prop_no_bytes_panic(bytes: Vec<u8>) {
            let _ = parse_cell(&bytes, b'.');
            let _ = parse_prefix(&bytes, b',');
            for at in 0..bytes.len() {
                let _ = parse_at(&bytes, at, b'.');
            }
        }
    }
}
