//! Onsets of sounds: where the envelope of a signal rises above what was heard before.

use super::echoes::{self, Heard, Onset};
use super::{robust, whole};

/// Window of the envelope, s.
const WINDOW_S: f64 = 1e-3;
/// Time that the envelope must rise within, and before which it is compared, s.
const BEFORE_S: f64 = 15e-3;
/// Least time between two onsets, s.
const APART_S: f64 = 40e-3;
/// Rise over the envelope before that is an onset.
const RISE: f64 = 4.0;
/// Level over the quietest part of the record that is an onset.
const OVER_NOISE: f64 = 8.0;
/// Share of the loudest part that is an onset.
const OF_LOUDEST: f64 = 2e-3;
/// Share of an onset's own peak at which it is timed.
const OF_PEAK: f64 = 0.2;

/// Times of all onsets in samples, but of echoes.
///
/// The envelope is the root mean square over a millisecond. An onset is a rise by a factor of four
/// within 15 ms to well above the noise; it is timed where the envelope passes a fifth of its peak.
///
/// ```
/// use impact_records::signal::onsets;
///
/// // Two clicks of 3 kHz at 0.1 and 0.5 s that die away, the second much weaker.
/// let click = |i: usize, from: usize, size: f64| match i.checked_sub(from) {
///     Some(k) => size * (-(k as f64) / 400.0).exp() * (0.43 * k as f64).sin(),
///     None => 0.0,
/// };
/// let hiss = |i: usize| 1e-4 * (i as f64 * 2.399).sin();
/// let sound: Vec<f64> = (0..44_100)
///     .map(|i| hiss(i) + click(i, 4410, 1.0) + click(i, 22_050, 0.05))
///     .collect();
/// let found = onsets::find(&sound, 44_100.0);
/// assert_eq!(found.len(), 2);
/// assert!((found[0] - 4410.0).abs() < 44.0 && (found[1] - 22_050.0).abs() < 44.0);
/// ```
pub fn find(samples: &[f64], rate_hz: f64) -> Vec<f64> {
    listen(samples, rate_hz).times
}

/// The onsets, as [`find`] gives them, with the echoes that were left out.
pub fn listen(samples: &[f64], rate_hz: f64) -> Heard {
    echoes::without(all(samples, rate_hz), rate_hz)
}

/// All onsets, echoes too.
fn all(samples: &[f64], rate_hz: f64) -> Vec<Onset> {
    let steps = |time_s: f64| whole::index((time_s * rate_hz).round()).max(1);
    let envelope = envelope(samples, steps(WINDOW_S));
    let (before, apart) = (steps(BEFORE_S), steps(APART_S));
    let loudest = envelope.iter().copied().fold(0.0, f64::max);
    let Some(quiet) = robust::median(&lowest(&envelope)) else {
        return Vec::new();
    };
    let least = (OVER_NOISE * quiet).max(OF_LOUDEST * loudest);
    let mut found: Vec<Onset> = Vec::new();
    let mut i = before;
    while i < envelope.len() {
        let past = envelope[i - before];
        if envelope[i] > least && envelope[i] > RISE * past {
            let end = (i + before).min(envelope.len());
            let peak = envelope[i..end].iter().copied().fold(0.0, f64::max);
            let from = i - before;
            let passed = (from..end).find(|k| envelope[*k] > (OF_PEAK * peak).max(past));
            let at = passed.unwrap_or(i) as f64;
            found.push(Onset { at, peak });
            i += apart;
        } else {
            i += 1;
        }
    }
    found
}

/// Root mean square about the mean over a centred window.
fn envelope(samples: &[f64], window: usize) -> Vec<f64> {
    let mean = robust::mean(samples);
    let mut sums = Vec::with_capacity(samples.len() + 1);
    sums.push(0.0);
    let mut sum = 0.0;
    for value in samples {
        sum += (value - mean).powi(2);
        sums.push(sum);
    }
    (0..samples.len())
        .map(|i| {
            let from = i.saturating_sub(window / 2);
            let to = (i + window / 2 + 1).min(samples.len());
            ((sums[to] - sums[from]).max(0.0) / (to - from) as f64).sqrt()
        })
        .collect()
}

/// The lower half of the values.
fn lowest(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.truncate(values.len().div_ceil(2));
    sorted
}
