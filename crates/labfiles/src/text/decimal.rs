//! From a decimal mantissa and exponent to the nearest binary64 number, without a detour by text.
//!
//! Short mantissas are divided or multiplied by a power of ten that binary64 holds (W. D.
//! Clinger, "How to read floating point numbers accurately", PLDI 1990); longer ones, of up to
//! 19 digits, are multiplied by a power of five in 128 bits (D. Lemire, "Number parsing at a
//! gigabyte per second", Software: Practice and Experience 51, 2021, algorithm 1).

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "words are cut into halves; exponents are between -27 and 27"
)]

/// Greatest power of five whose square fits 128 bits, and for which the algorithm is exact.
const GREATEST_POWER: i64 = 27;
/// Mantissas below it binary64 holds, and so it does a few above it; by this bound numbers of the
/// usual 16 and 17 digits all take the same way.
const SHORT: u64 = 1_000_000_000_000_000;
/// Explicit bits of a binary64 mantissa.
const MANTISSA_BITS: u64 = 52;

/// Powers of ten that binary64 holds exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Powers of five from 5^-27 to 5^27, shifted so that the top bit of 128 is set; those below 1
/// are rounded up.
static FIVES: [u128; 2 * GREATEST_POWER as usize + 1] = fives();

const fn fives() -> [u128; 2 * GREATEST_POWER as usize + 1] {
    let mut all = [0; 2 * GREATEST_POWER as usize + 1];
    let (mut power, mut k) = (1u128, 0);
    while k <= GREATEST_POWER as usize {
        if k > 0 {
            all[GREATEST_POWER as usize - k] = reciprocal(power);
        }
        all[GREATEST_POWER as usize + k] = power << power.leading_zeros();
        (power, k) = (power * 5, k + 1);
    }
    all
}

/// 2^b / power rounded up (no power of five divides one of two), with b such that it fills 128 bits, by long division.
const fn reciprocal(power: u128) -> u128 {
    let (mut quotient, mut rest) = (0u128, 1u128);
    while quotient >> 127 == 0 {
        rest <<= 1;
        quotient <<= 1;
        if rest >= power {
            rest -= power;
            quotient |= 1;
        }
    }
    quotient + 1
}

/// The binary64 number nearest to mantissa · 10^exponent; `None` where another way must be
/// taken: the exponent is great.
#[inline]
pub(crate) fn nearest(mantissa: u64, exponent: i64) -> Option<f64> {
    if mantissa < SHORT && (-22..=22).contains(&exponent) {
        let power = EXACT_POWERS[exponent.unsigned_abs() as usize];
        return Some(if exponent < 0 {
            mantissa as f64 / power
        } else {
            mantissa as f64 * power
        });
    }
    if (-GREATEST_POWER..=GREATEST_POWER).contains(&exponent) && mantissa > 0 {
        Some(long(mantissa, exponent))
    } else {
        None
    }
}

/// Algorithm 1 of the paper, for exponents at which it needs no further case.
#[inline]
fn long(mantissa: u64, exponent: i64) -> f64 {
    let shift = mantissa.leading_zeros();
    let (high, low) = product(
        mantissa << shift,
        FIVES[(exponent + GREATEST_POWER) as usize],
    );
    let upper = high >> 63;
    let drop = upper + 64 - MANTISSA_BITS - 3;
    let mut bits = high >> drop;
    // 217706 / 2^16 is log2(10) from below, near enough for these exponents.
    let power = ((exponent * 217_706) >> 16) + 63 + upper as i64 - i64::from(shift) + 1023;
    // Half-way between two numbers: to the even one.
    let between = low <= 1 && (-4..=23).contains(&exponent) && bits & 3 == 1;
    if between && bits << drop == high {
        bits &= !1;
    }
    bits = (bits + (bits & 1)) >> 1;
    // The mantissa's top bit counts one step of the exponent, and a carry out of it another.
    f64::from_bits((((power - 1) as u64) << MANTISSA_BITS) + bits)
}

/// The upper 128 of the 192 bits of a product, as far as they are needed.
#[inline]
fn product(word: u64, five: u128) -> (u64, u64) {
    const UNSURE: u64 = u64::MAX >> (MANTISSA_BITS + 3);
    let first = u128::from(word) * (five >> 64);
    let high = (first >> 64) as u64;
    if high & UNSURE != UNSURE {
        return (high, first as u64);
    }
    let second = u128::from(word) * u128::from(five as u64);
    let sum = first + (second >> 64);
    ((sum >> 64) as u64, sum as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn valid_numbers_half_way_go_to_the_even_one() {
        for (mantissa, exponent) in [
            (9_007_199_254_740_993, 0),
            (9_007_199_254_740_995, 0),
            (90_071_992_547_409_930, -1),
            (u64::MAX, 0),
            (10_000_000_000_000_000_000, 27),
            (9_007_199_254_740_994, 22),
        ] {
            let text = format!("{mantissa}e{exponent}");
            let expected: f64 = text.parse().unwrap();
            assert_eq!(nearest(mantissa, exponent), Some(expected), "{text}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        #[test]
        fn prop_long_mantissas_equal_the_standard_parsers(mantissa: u64, drop in 0u32..40, exponent in -27i64..=27) {
            let mantissa = mantissa >> drop;
            let expected: f64 = format!("{mantissa}e{exponent}").parse().unwrap();
            if let Some(value) = nearest(mantissa, exponent) {
                prop_assert_eq!(value.to_bits(), expected.to_bits());
            }
            if mantissa > 0 {
                prop_assert_eq!(long(mantissa, exponent).to_bits(), expected.to_bits());
            }
        }
    }
}
