//! Values in a range.

/// So many values from the least to the greatest, two or more, each over the one before alike.
///
/// ```
/// use impact_records::signal::spacing::by_ratio;
///
/// let values: Vec<f64> = by_ratio([1.0, 100.0], 3).collect();
/// assert!((values[1] - 10.0).abs() < 1e-12);
/// ```
pub fn by_ratio(ends: [f64; 2], count: usize) -> impl Iterator<Item = f64> {
    let [least, greatest] = ends.map(f64::ln);
    let share = move |k: usize| k as f64 / (count - 1) as f64;
    (0..count).map(move |k| (least + share(k) * (greatest - least)).exp())
}
