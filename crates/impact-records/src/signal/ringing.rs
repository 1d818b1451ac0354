//! For how long a waveform rings beside its impacts: behind an anti-alias filter, in a part that vibrates, in a cable.
//! A motion that repeats is not known by samples there.

use crate::signal::robust;
use crate::signal::whole;

/// Impacts of which the ringing is known.
pub(crate) const FEWEST: usize = 3;
/// Share of the usual time between impacts up to which ringing is looked for.
const REACH: f64 = 0.2;
/// Third difference from which a waveform rings, over its size.
const RINGS: f64 = 3e-3;
/// The same, over the usual third difference, which noise and a coarse sampling make.
const STANDS_OUT: f64 = 4.0;
/// Samples of a third difference.
const SPAN: usize = 4;
/// Samples without ringing that may be where a vibration passes through zero: two third differences.
const CALM: usize = 2 * SPAN;

/// Samples before and after an impact in which a waveform of a size rings, by third differences: these are small
/// along a flight. Times of impacts in samples; zero where impacts are few.
pub(crate) fn beside_impacts(values: &[f64], times: &[f64], size: f64) -> [f64; 2] {
    let apart: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = robust::median(&apart).filter(|_| times.len() >= FEWEST);
    let Some(usual) = usual.filter(|_| values.len() > SPAN) else {
        return [0.0; 2];
    };
    let thirds: Vec<f64> = values
        .windows(SPAN)
        .map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs())
        .collect();
    let quiet = robust::median(&thirds).unwrap_or(0.0);
    let limit = (RINGS * size).max(STANDS_OUT * quiet);
    let most = whole::index(REACH * usual);
    let rings = |first: &dyn Fn(f64) -> Option<usize>| {
        let beside = times.iter().filter_map(|t| thirds.get(first(*t)?));
        let (known, ringing) = beside.fold((0, 0), |(known, ringing), third| {
            (known + 1, ringing + usize::from(*third > limit))
        });
        2 * ringing > known
    };
    // of a difference the sample next to the impact
    let after = last(most, |k| rings(&|t| Some(whole::index(t.floor()) + k)));
    let before = last(most, |k| {
        rings(&|t| (whole::index(t.ceil())).checked_sub(k + SPAN - 1))
    });
    [before, after].map(|last| last.map_or(0.0, |k| (k + 1) as f64))
}

/// The last of the samples beside an impact that ring, up to `most`: what comes after a calm longer than the ringing is another
/// impact, which follows a strong one alike in every period.
fn last(most: usize, rings: impl Fn(usize) -> bool) -> Option<usize> {
    let mut last = None;
    for k in (1..=most).filter(|k| rings(*k)) {
        let begun = last.unwrap_or(0);
        if k - begun > CALM.max(begun) {
            break;
        }
        last = Some(k);
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: usize = 200;

    /// Twenty periods of a motion with a jump in each, behind which a vibration of 5 samples dies away.
    fn waveform(ringing: f64) -> Vec<f64> {
        let value = |i: usize| {
            let since = (i % PERIOD) as f64;
            let turns = std::f64::consts::TAU / 5.0 * since;
            since / PERIOD as f64 + ringing * (-since / 4.0).exp() * turns.sin()
        };
        (0..20 * PERIOD).map(value).collect()
    }

    fn found(values: &[f64]) -> [f64; 2] {
        let times: Vec<f64> = (1..20).map(|k| (k * PERIOD) as f64 - 0.5).collect();
        beside_impacts(values, &times, 0.3)
    }

    #[test]
    fn a_jump_does_not_ring_and_what_follows_it_does() {
        assert_eq!(found(&waveform(0.0)), [0.0; 2]);
        // 1.6·0.3·e^(−k/4) sinks below 3e-3·0.3 after 25 samples
        let [before, after] = found(&waveform(0.3));
        assert_eq!(before, 0.0);
        assert!((20.0..30.0).contains(&after), "{after}");
        // what is small beside the motion does not count
        assert_eq!(found(&waveform(3e-4)), [0.0; 2]);
    }

    #[test]
    fn an_impact_soon_after_another_is_no_ringing() {
        let mut values = waveform(0.0);
        for (i, value) in values.iter_mut().enumerate() {
            *value -= 0.1 * f64::from(u8::from(i % PERIOD >= 25));
        }
        assert_eq!(found(&values), [0.0; 2]);
    }

    #[test]
    fn noise_and_a_coarse_sampling_do_not_ring() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let noisy = waveform(0.0)
            .iter()
            .map(|v| v + random.random_range(-0.02..0.02))
            .collect::<Vec<f64>>();
        assert_eq!(found(&noisy), [0.0; 2]);
        let coarse: Vec<f64> = (0..400)
            .map(|i| f64::from(i % 20).powi(2) / 400.0)
            .collect();
        let times: Vec<f64> = (1..20).map(|k| f64::from(20 * k) - 0.5).collect();
        assert_eq!(beside_impacts(&coarse, &times, 0.3), [0.0; 2]);
    }
}
