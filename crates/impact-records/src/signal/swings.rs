//! Numbers that may be the amplitudes of successive swings, as of a logarithmic decrement.

/// Most numbers of such a list, which is written by hand, and fewest.
const MOST: usize = 100;
const FEWEST: usize = 3;
/// Share of their steps that fall.
const FALL: f64 = 0.9;
/// What is left of the first of them at the end, at most.
const LEFT: f64 = 0.9;

/// Whether the sizes of numbers fall from one to the next, and all are of one sign, or of either in turn.
///
/// ```
/// use impact_records::signal::swings::are_swings;
///
/// assert!(are_swings(&[40.0, 37.0, 34.5, 32.0]) && are_swings(&[40.0, -37.0, 34.5, -32.0]));
/// assert!(!are_swings(&[1.0, 2.0, 3.0]));
/// ```
pub fn are_swings(values: &[f64]) -> bool {
    let steps = values.len().saturating_sub(1) as f64;
    let share = |test: &dyn Fn(f64, f64) -> bool| {
        let pairs = values.windows(2).filter(|w| test(w[0], w[1]));
        pairs.count() as f64 >= FALL * steps
    };
    let ends = values.first().zip(values.last());
    let less = ends.is_some_and(|(first, last)| last.abs() < LEFT * first.abs());
    let of_one_sign = values.iter().all(|v| *v > 0.0);
    (FEWEST..=MOST).contains(&values.len())
        && less
        && share(&|a, b| b.abs() <= a.abs())
        && (of_one_sign || share(&|a, b| a * b < 0.0))
}
