//! Whole numbers from floating-point ones.
//!
//! The conversions of Rust cut the fraction and take the nearest number that the type has: negative
//! numbers and NaN are 0 of an unsigned type, what is too large is its greatest number. That is what
//! indices and counts of samples, bins and steps want, all of which are far below these limits.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the limits of the conversions are stated above"
)]

/// An index or a count of samples.
pub const fn index(value: f64) -> usize {
    value as usize
}

/// A count that is stored in 32 bits.
pub const fn count(value: f64) -> u32 {
    value as u32
}

/// An integer of either sign.
pub const fn integer(value: f64) -> i32 {
    value as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_cut_and_limits_are_kept() {
        assert_eq!((index(2.9), index(-3.5), index(f64::NAN)), (2, 0, 0));
        assert_eq!((count(1e12), count(7.0)), (u32::MAX, 7));
        assert_eq!((integer(-2.5), integer(1e12)), (-2, i32::MAX));
    }
}
