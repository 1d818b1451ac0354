//! The rate at which samples follow, from a time axis.

/// How many values at the front of a time axis give its usual step.
pub const HEAD_SAMPLES: usize = 256;

/// Samples per second of an axis whose unit has so many seconds: from its ends where the samples
/// between them are complete or many share a printed time, else from the usual steps of its head, so that
/// dropped samples do not bend it.
///
/// `head` are the first values, `end` is the last of `count`. `None`: the axis does not climb or
/// has fewer than two values.
pub fn from_axis(head: &[f64], end: Option<f64>, count: u64, unit_s: f64) -> Option<f64> {
    let between = count.checked_sub(1).filter(|n| *n > 0)? as f64;
    if shares_stamps(head) {
        let (last, steps) = match end {
            Some(end) => (end, between),
            None => (*head.last()?, head.len() as f64 - 1.0),
        };
        let rate = steps / (last - head.first()?) / unit_s;
        return (rate.is_finite() && rate > 0.0).then_some(rate);
    }
    let median = median_step(head)?;
    let usual: Vec<f64> = head
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|s| (s - median).abs() <= 0.5 * median)
        .collect();
    let step = usual.iter().sum::<f64>() / usual.len() as f64;
    let whole = end.map(|e| (e - head[0]) / between).filter(|s| {
        // Ends and head must agree within half a sample, or within the head's own uncertainty.
        (s - step).abs() * between < 0.5 * step + 1e-3 * between * step
    });
    let rate = 1.0 / whole.unwrap_or(step);
    rate.is_finite().then_some(rate / unit_s)
}

/// Whether many samples have the printed time of the one before, as where the printer rounds it.
fn shares_stamps(head: &[f64]) -> bool {
    let same = head.windows(2).filter(|w| w[0] == w[1]).count();
    3 * same > head.len()
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
        assert!((from_axis(&printed, Some(end), 10_000, 1.0).unwrap() - 1652.9).abs() < 1e-3);
        let gap = from_axis(&printed, Some(end + 3.0), 10_000, 1.0).unwrap();
        assert!((gap - 1652.9).abs() < 0.5, "{gap}");
        assert_eq!(from_axis(&[0.0, 0.0], None, 2, 1.0), None);
        // 20 samples share a stamp of 1 ms.
        let coarse: Vec<f64> = (0..256).map(|i| f64::from(i / 20) * 1e-3).collect();
        let rate = from_axis(&coarse, Some(0.999), 20_000, 1.0).unwrap();
        assert!((rate / 20_000.0 - 1.0).abs() < 2e-3, "{rate}");
    }
}
