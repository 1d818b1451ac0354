//! Readings that begin again at the other end of their range: angles after a turn, counters that run over.

use super::{columns, robust};

/// What an angle counts until it begins again: degrees, radians, gon.
const TURNS: [f64; 3] = [360.0, std::f64::consts::TAU, 400.0];
/// Bits of counters.
const BITS: [i32; 7] = [8, 10, 12, 14, 16, 24, 32];
/// Share of their range that readings which begin again go through, at least.
const GOES_THROUGH: f64 = 0.75;
/// Share of the range by which they jump there, at least, and by which the motion goes on from sample to sample, at most.
const JUMPS: f64 = 0.7;
const GOES_ON: f64 = 0.25;
/// Steps before and after a jump that show which way the motion goes: with few samples a period some are as far as a jump.
const BESIDE: usize = 3;
/// How much less smooth than elsewhere readings that go on may be where they began again.
const ROUGHER: f64 = 1.5;

/// Readings made to go on.
pub struct Unwrapped {
    /// The range after which they begin again.
    pub range: f64,
    /// The readings, with the range added from each jump on.
    pub values: Vec<f64>,
    /// How often they begin again.
    pub count: usize,
    /// The sample after which they do first.
    pub first: usize,
}

/// Readings that begin again made to go on: after a turn of an angle or where a counter of some bits runs over, if they are as
/// smooth there as elsewhere, else after the range that they show themselves, if some jump by it against the way that they go
/// before and after.
///
/// ```
/// use impact_records::signal::wrapped::go_on;
///
/// let angle: Vec<f64> = (0..80).map(|i| f64::from(10 * i % 360)).collect();
/// let whole = go_on(&angle).unwrap();
/// assert_eq!((whole.range, whole.count, whole.values[79]), (360.0, 2, 790.0));
/// assert!(go_on(&angle[..30]).is_none());
/// ```
pub fn go_on(values: &[f64]) -> Option<Unwrapped> {
    let (low, high) = columns::extremes(values);
    let begins = |range: &f64| {
        let signed = low >= -0.5 * range && high <= 0.5 * range;
        (low >= 0.0 || signed) && high <= *range
    };
    let of_bits = BITS.map(|bits| 2f64.powi(bits));
    let ranges = TURNS.into_iter().chain(of_bits).filter(begins);
    let found = ranges.filter_map(|range| Unwrapped::of(values, range));
    let found = found.map(|whole| (whole.roughness(values), whole));
    let known = found.min_by(|a, b| a.0.total_cmp(&b.0));
    let smooth = known.filter(|(rough, _)| *rough < ROUGHER);
    match smooth {
        Some((_, whole)) => Some(whole),
        None => Unwrapped::of(values, own_range(values)?),
    }
}

/// The range after which readings begin again that nothing tells but themselves: what their jumps against the way that they go
/// have more than the steps beside them, a whole number of whole readings.
fn own_range(values: &[f64]) -> Option<f64> {
    let (low, high) = columns::extremes(values);
    let span = high - low;
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let jumped = |steps: &[f64]| {
        let (before, after) = (&steps[..BESIDE], &steps[BESIDE + 1..]);
        let (last, jump, next) = (before[BESIDE - 1], steps[BESIDE], after[0]);
        // most steps of a record are none
        if jump.abs() <= JUMPS * span {
            return None;
        }
        let mut beside = before.iter().chain(after);
        let slow = beside.all(|s| s.abs() < GOES_ON * span);
        let back = last * jump < 0.0 && next * jump < 0.0;
        (slow && back).then(|| (jump - 0.5 * (last + next)).abs())
    };
    let each: Vec<f64> = steps.windows(2 * BESIDE + 1).filter_map(jumped).collect();
    let range = robust::median(&each)?;
    let counts = values.iter().all(|v| v.fract() == 0.0 || v.is_nan());
    Some(if counts { range.round() } else { range }.max(span))
}

impl Unwrapped {
    /// The greatest second difference where readings began again, over that elsewhere.
    fn roughness(&self, read: &[f64]) -> f64 {
        let mut most = [f64::MIN_POSITIVE, 0.0];
        for (own, read) in self.values.windows(3).zip(read.windows(3)) {
            let mut steps = read.windows(2).map(|w| (w[1] - w[0]).abs());
            let jumps = steps.any(|step| step > JUMPS * self.range);
            let bend = (own[2] - 2.0 * own[1] + own[0]).abs();
            let most = &mut most[usize::from(jumps)];
            *most = most.max(bend);
        }
        most[1] / most[0]
    }

    /// Readings that begin again after a range; `None` if they do not.
    fn of(values: &[f64], range: f64) -> Option<Self> {
        let (low, high) = columns::extremes(values);
        let span = high - low;
        if span > range || span < GOES_THROUGH * range {
            return None;
        }
        let mut turns = 0.0;
        let mut out = Vec::with_capacity(values.len());
        let (mut count, mut first, mut farthest) = (0, 0, 0.0f64);
        let mut last: Option<(f64, f64)> = None;
        for (i, value) in values.iter().enumerate() {
            if let Some((reading, place)) = last.filter(|_| value.is_finite()) {
                let jump = value - reading;
                if jump.abs() > JUMPS * range {
                    turns -= jump.signum();
                    first = if count == 0 { i - 1 } else { first };
                    count += 1;
                }
                farthest = farthest.max((value + turns * range - place).abs());
            }
            let place = value + turns * range;
            if value.is_finite() {
                last = Some((*value, place));
            }
            out.push(place);
        }
        (count > 0 && farthest < GOES_ON * range).then_some(Self {
            range,
            values: out,
            count,
            first,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_spikes_and_levels_do_not_begin_again() {
        let noise = |i: usize| (2.399_963 * (i * i) as f64).sin() * (1.0 + 0.004 * i as f64);
        let quiet = |i: usize| 0.01 * noise(i % 500);
        let spike = |i: usize| if i % 300 == 200 { 5.0 } else { quiet(i) };
        let spikes: Vec<f64> = (0..800).map(spike).collect();
        assert!(go_on(&spikes).is_none());
        let levels: Vec<f64> = (0..800).map(|i| f64::from(i / 100 % 2 * 5)).collect();
        assert!(go_on(&levels).is_none());
        // from three to five samples a period
        for k in 60..100 {
            let fast = |i: usize| (std::f64::consts::TAU * i as f64 / (0.05 * f64::from(k))).cos();
            let decay = |i: usize| fast(i) * (-0.01 * i as f64).exp();
            let decay: Vec<f64> = (0..400).map(decay).collect();
            assert!(go_on(&decay).is_none(), "{k}");
        }
    }

    #[test]
    fn readings_of_any_range_show_it_themselves() {
        let turn = |i: u32| std::f64::consts::TAU * 0.00125 * f64::from(i);
        let angle = |i: u32| 700.0 * (-0.03 * turn(i)).exp() * turn(i).cos();
        for range in [360.0, 1000.0, 1024.0, 720.0] {
            let reading = |i: u32| angle(i).round().rem_euclid(range);
            let wrapped: Vec<f64> = (0..4000).map(reading).collect();
            let found = go_on(&wrapped).unwrap();
            assert_eq!(found.range, range);
        }
    }
}
