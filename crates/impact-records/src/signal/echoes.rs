//! Echoes among onsets of sounds: each follows its sound after the same time, weaker by the same factor. Flights become shorter
//! from bounce to bounce, whereas the intervals between sounds and echoes are long and short in turn.

use super::robust;

/// Longest time that an echo takes, s: it comes from a wall 60 m away.
const LONGEST_S: f64 = 0.35;
/// Time by which echoes of one wall are apart at most, s: an onset is timed to a millisecond.
const ALIKE_S: f64 = 1.5e-3;
/// Amplitude of an echo over that of its sound at most, and how far off that of others, in its logarithm.
const WEAKER: f64 = 0.85;
const ALIKE: f64 = 0.5;
/// Fewest echoes of a wall, and their share of the onsets: half if each sound is heard twice, a third if throws of three
/// impacts from one height follow each other, which have flights of equal length.
const FEWEST: usize = 3;
const SHARE: f64 = 0.4;

/// An onset: its time in samples, and the greatest amplitude after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Onset {
    /// Time, samples.
    pub at: f64,
    /// Amplitude.
    pub peak: f64,
}

/// Onsets without echoes, and what was left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heard {
    /// Times of the onsets, samples.
    pub times: Vec<f64>,
    /// Echoes that were left out.
    pub echoes: usize,
    /// How long they took, samples.
    pub delay: f64,
}

/// Leave out the echoes among onsets in order of time, if what is left shrinks from bounce to bounce where the intervals of all
/// grow and shrink in turn.
pub(super) fn without(onsets: Vec<Onset>, rate_hz: f64) -> Heard {
    let all = times(&onsets);
    let heard = wall(&onsets, rate_hz).and_then(|echo| {
        let kept = times(&leave_out(onsets, echo, rate_hz));
        let echoes = all.len() - kept.len();
        let shrinks = 2 * growths(&all) >= 2 * growths(&kept) + echoes;
        shrinks.then_some(Heard {
            times: kept,
            echoes,
            delay: echo.0,
        })
    });
    heard.unwrap_or(Heard {
        times: all,
        ..Heard::default()
    })
}

fn times(onsets: &[Onset]) -> Vec<f64> {
    onsets.iter().map(|onset| onset.at).collect()
}

/// How many intervals are longer than the one before.
fn growths(times: &[f64]) -> usize {
    let longer = |w: &&[f64]| w[2] - w[1] > w[1] - w[0];
    times.windows(3).filter(longer).count()
}

/// The delay of the echoes of a wall, samples, with the logarithm of their amplitude over that of the sounds.
fn wall(onsets: &[Onset], rate_hz: f64) -> Option<(f64, f64)> {
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for (k, own) in onsets.iter().enumerate() {
        let later = onsets[k + 1..]
            .iter()
            .take_while(|o| o.at - own.at < LONGEST_S * rate_hz);
        let weaker = later.filter(|o| o.peak < WEAKER * own.peak);
        pairs.extend(weaker.map(|o| (o.at - own.at, (o.peak / own.peak).ln())));
    }
    let alike = |own: &(f64, f64)| -> Vec<(f64, f64)> {
        let near = pairs.iter().filter(|p| are_alike(**p, *own, rate_hz));
        near.copied().collect()
    };
    let most = pairs.iter().map(alike).max_by_key(Vec::len)?;
    let middle = |of: &dyn Fn(&(f64, f64)) -> f64| {
        robust::median(&most.iter().map(of).collect::<Vec<f64>>())
    };
    let share = most.len() as f64 / onsets.len() as f64;
    (most.len() >= FEWEST && share >= SHARE).then_some((middle(&|p| p.0)?, middle(&|p| p.1)?))
}

fn are_alike(a: (f64, f64), b: (f64, f64), rate_hz: f64) -> bool {
    (a.0 - b.0).abs() < ALIKE_S * rate_hz && (a.1 - b.1).abs() < ALIKE
}

/// Onsets but those that follow another one as an echo does.
fn leave_out(onsets: Vec<Onset>, echo: (f64, f64), rate_hz: f64) -> Vec<Onset> {
    let mut kept: Vec<Onset> = Vec::new();
    for onset in onsets {
        let of = |own: &Onset| (onset.at - own.at, (onset.peak / own.peak).ln());
        if !kept.iter().any(|own| are_alike(of(own), echo, rate_hz)) {
            kept.push(onset);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    const RATE_HZ: f64 = 44_100.0;

    /// Onsets of a throw with R, each of a strength that scatters by a third.
    fn throw(ratio: f64, flight_s: f64, count: usize, rng: &mut ChaCha8Rng) -> Vec<Onset> {
        let (mut at, mut flight) = (1.0, flight_s * RATE_HZ);
        let mut size = 1.0;
        let mut all = Vec::new();
        for _ in 0..count {
            let peak = size * rng.random_range(0.67..1.33);
            all.push(Onset { at, peak });
            at += flight;
            flight *= ratio;
            size *= ratio;
        }
        all
    }

    #[test]
    fn prop_bounces_are_no_echoes() {
        let mut rng = ChaCha8Rng::seed_from_u64(20_261_130);
        for _ in 0..2000 {
            let ratio = rng.random_range(0.4..0.97);
            let flight_s = rng.random_range(0.15..1.0);
            let heard = |k: &i32| flight_s * f64::powi(ratio, *k) > 0.04;
            let count = (0..60).take_while(heard).count() + 1;
            let alone = throw(ratio, flight_s, count, &mut rng);
            let times: Vec<f64> = alone.iter().map(|o| o.at).collect();
            assert_eq!(
                without(alone, RATE_HZ).times,
                times,
                "{ratio} {flight_s} {count}"
            );
        }
        // five throws from one height, three impacts of each
        let one = throw(0.6, 0.3, 3, &mut rng);
        let later = |k: i32| one.iter().map(move |o| (o.at + 3e5 * f64::from(k), o.peak));
        let throws = (0..5).flat_map(later);
        let throws: Vec<Onset> = throws.map(|(at, peak)| Onset { at, peak }).collect();
        assert_eq!(without(throws, RATE_HZ).echoes, 0);
    }

    #[test]
    fn prop_echoes_are_left_out() {
        let mut rng = ChaCha8Rng::seed_from_u64(45);
        for _ in 0..200 {
            let ratio = rng.random_range(0.75..0.92);
            let count = rng.random_range(5..10);
            let delay = rng.random_range(0.041..0.15) * RATE_HZ;
            let weaker = rng.random_range(0.2..0.6);
            let sounds = throw(ratio, 0.9, count, &mut rng);
            let echo = |own: &Onset| Onset {
                at: own.at + delay + rng.random_range(-20.0..20.0),
                peak: weaker * own.peak,
            };
            let mut all: Vec<Onset> = sounds.iter().map(echo).collect();
            all.extend(&sounds);
            all.sort_by(|a, b| a.at.total_cmp(&b.at));
            let heard = without(all, RATE_HZ);
            let times: Vec<f64> = sounds.iter().map(|o| o.at).collect();
            assert_eq!(heard.times, times, "{ratio} {delay}");
            assert_eq!(heard.echoes, count);
            assert!((heard.delay - delay).abs() < 20.0, "{heard:?}");
        }
    }
}
