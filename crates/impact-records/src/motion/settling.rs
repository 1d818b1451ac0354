//! Whether a motion still settles while it is recorded: what its waveform misses closing by dies away.
//!
//! The waveform is compared with itself n drive periods later; a motion p/n that has settled misses by as
//! much in the first half of the record as in the second. What dies away is a disturbance that was there
//! when the record began.

use crate::motion::closure::WaveformClosure;

/// Ratio of what a waveform misses closing by in the first half of a record to that in the second from
/// which it dies away. Noise of some hundred samples makes a ratio of 1.1; that of a settled motion of
/// period n, looked at after fewer periods, differs by which of its n parts lie in which half.
const DYING: f64 = 1.5;
/// Least disturbance, over the waveform's root mean square, that is worth a name.
pub(super) const LEAST: f64 = 5e-3;
/// The same beside a motion of one drive period, which it does not hide.
const LEAST_OF_ONE: f64 = 2e-2;
/// Ratio from which a motion that does not close settles. Of an irregular one each half holds several
/// periods that differ as much.
const DYING_WHILE_OPEN: f64 = 2.5;

impl WaveformClosure {
    /// That of the waveform from its end to its begin.
    pub(super) fn reversed(&self) -> Self {
        Self {
            halves: self.halves.map(|[first, second]| [second, first]),
            ..*self
        }
    }

    /// What dies away from the first half of the record to the second, over the waveform's root mean
    /// square.
    fn dying(&self, ratio: f64) -> Option<f64> {
        let [first, second] = self.halves?;
        (first > ratio * second).then(|| (first * first - second * second).sqrt())
    }
}

/// The disturbance that dies away while a motion is recorded, over the waveform's root mean square.
///
/// `chosen`: the smallest number of drive periods after which the waveform closes about as well as after
/// any; `closed`: the ratio up to which it counts as closed; `periods`: drive periods in the record; `calm`:
/// whether the masses hit each other in its first half alone.
pub(super) fn disturbance(
    closures: &[WaveformClosure],
    chosen: &WaveformClosure,
    closed: f64,
    periods: f64,
    calm: bool,
) -> Option<f64> {
    let n = f64::from(chosen.periods_n);
    if chosen.ratio > closed {
        let closes_at_last = |c: &WaveformClosure| c.halves.is_some_and(|h| h[1] <= closed);
        let settles = |c: &WaveformClosure| match (c.periods_n, calm) {
            // what still swings without an impact need not close yet
            (1, true) => c.dying(DYING),
            (1, false) => c.dying(DYING_WHILE_OPEN),
            _ => c.dying(DYING_WHILE_OPEN).filter(|_| closes_at_last(c)),
        };
        return closures.iter().find_map(settles);
    }
    let least = if chosen.periods_n == 1 {
        LEAST_OF_ONE
    } else {
        LEAST
    };
    // each half holds the motion's period at least once
    let shorter = closures
        .iter()
        .filter(|c| c.periods_n < chosen.periods_n && periods - f64::from(c.periods_n) >= 2.0 * n);
    let looked_at = std::iter::once(chosen).chain(shorter);
    let found = looked_at.filter_map(|c| c.dying(DYING));
    found.filter(|size| *size > least).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::closure::waveform;

    const PERIOD: f64 = 157.3;

    /// What dies away in 13 drive periods of a waveform over its phase, with noise of 0.2 %.
    fn found(of: impl Fn(f64) -> f64) -> Option<f64> {
        use rand::SeedableRng;
        use rand_distr::{Distribution, Normal};
        let noise = Normal::new(0.0, 1.4e-3).expect("a deviation");
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let values: Vec<f64> = (0..2045)
            .map(|i| of(f64::from(i) / PERIOD) + noise.sample(&mut random))
            .collect();
        let closures = waveform(&values, PERIOD, &[], [2.0; 2], 6, &[]);
        let least = closures
            .iter()
            .map(|c| c.ratio)
            .fold(f64::INFINITY, f64::min);
        let chosen = closures.iter().find(|c| c.ratio < 1.12 * least + 1e-4);
        disturbance(&closures, chosen.expect("a closure"), 0.02, 13.0, false)
    }

    const TURN: f64 = std::f64::consts::TAU;

    #[test]
    fn valid_a_doubling_that_dies_away_is_settling_and_one_that_stays_is_not() {
        let doubled = |size: f64, rate: f64| {
            move |t: f64| (TURN * t).cos() + size * (-rate * t).exp() * (0.5 * TURN * t).cos()
        };
        assert_eq!(found(doubled(0.0, 0.0)), None);
        assert_eq!(found(doubled(0.1, 0.0)), None);
        assert_eq!(found(doubled(0.01, 0.0)), None);
        for size in [0.05, 0.1, 0.3] {
            let dying = found(doubled(size, 0.3)).expect("a disturbance");
            assert!(dying > 0.2 * size && dying < 2.0 * size, "{size}: {dying}");
        }
    }

    #[test]
    fn valid_motions_of_three_and_four_periods_have_settled() {
        for n in [3.0, 4.0] {
            let steady = |t: f64| {
                (TURN * t).cos() + 0.2 * (TURN * t / n).cos() + 0.1 * (2.0 * TURN * t / n).sin()
            };
            assert_eq!(found(steady), None, "{n}");
        }
    }

    #[test]
    fn what_never_closes_is_irregular_and_not_settling() {
        let open = |t: f64| (TURN * t).cos() + 0.8 * (TURN * t * 2f64.sqrt() / 1.3).sin();
        assert_eq!(found(open), None);
        let settles = |t: f64| (TURN * t).cos() + 2.0 * (-0.6 * t).exp() * (0.7 * TURN * t).cos();
        assert!(found(settles).is_some());
    }
}
