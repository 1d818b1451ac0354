//! The rate at which samples follow, from a time axis.

use crate::units::parse_unit;

/// How many values at the front of a time axis give its usual step.
pub(crate) const HEAD_SAMPLES: usize = 256;

/// Samples per second of an axis, in s if its unit is not known: from its ends where the samples
/// between them are complete, else from the usual steps of its head, so that dropped samples do not
/// bend it.
///
/// `head` are the first values, `end` is the last of `count`. `None`: the axis does not climb or
/// has fewer than two values.
pub(crate) fn from_axis(
    head: &[f64],
    end: Option<f64>,
    count: u64,
    unit: Option<&str>,
) -> Option<f64> {
    let median = median_step(head)?;
    let usual: Vec<f64> = head
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|s| (s - median).abs() <= 0.5 * median)
        .collect();
    let step = usual.iter().sum::<f64>() / usual.len() as f64;
    let between = count.checked_sub(1).filter(|n| *n > 0)? as f64;
    let whole = end.map(|e| (e - head[0]) / between).filter(|s| {
        // Ends and head must agree within half a sample, or within the head's own uncertainty.
        (s - step).abs() * between < 0.5 * step + 1e-3 * between * step
    });
    let rate = 1.0 / whole.unwrap_or(step);
    let seconds = unit.and_then(parse_unit).map_or(1.0, |u| u.to_si);
    rate.is_finite().then_some(rate / seconds)
}

/// The median of the steps forward.
pub(crate) fn median_step(values: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = values
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|s| *s > 0.0 && s.is_finite())
        .collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_survives_rounding_and_dropped_samples() {
        let printed: Vec<f64> = (0..300)
            .map(|i| (f64::from(i) / 1652.9 * 1e6).round() / 1e6)
            .collect();
        let end = (9_999.0 / 1652.9f64 * 1e6).round() / 1e6;
        assert!((from_axis(&printed, Some(end), 10_000, None).unwrap() - 1652.9).abs() < 1e-3);
        let gap = from_axis(&printed, Some(end + 3.0), 10_000, None).unwrap();
        assert!((gap - 1652.9).abs() < 0.5, "{gap}");
        assert_eq!(from_axis(&[0.0, 0.0], None, 2, None), None);
    }
}
