//! Where decays begin: after each blow of a record, or after its release.

use crate::signal::{columns, robust, spectrum, whole};

/// Share of the greatest excursion from which the motion has begun.
const BEGUN: f64 = 0.7;
/// Part of a period that an oscillation stays above that share at most; longer is held.
const HELD: f64 = 0.35;
/// Part of a period that the motion may have lasted before.
const BEFORE: f64 = 0.75;
/// Samples before a motion that tell whether the mass is at rest.
const TELL_REST: usize = 8;
/// Standard deviations of their noise within which it still is.
const AT_REST: f64 = 4.0;
/// Share of the greatest excursion that a blow reaches, of those that are fitted.
const BLOW: f64 = 0.15;
/// Rise of the excursions, within a period, that is a blow.
const RISE: f64 = 2.0;
/// Share of the excursion that ends what is looked at for the first estimate of the frequency.
const DECAYED: f64 = 0.1;

/// Standard deviations of noise above which samples are of the motion, and the part of the greatest excursion from which those
/// hide where it ends.
const ABOVE_NOISE: f64 = 5.0;
const HIDES: f64 = 0.5;

/// Samples between which the parts of a record decay freely, each after a blow of its own.
pub(super) fn parts(samples: &[f64]) -> Vec<(usize, usize)> {
    let Some(centre) = robust::median(samples) else {
        return Vec::new();
    };
    let Some(period) = spectrum::peak_frequency(samples).map(|f| 1.0 / f) else {
        return vec![(0, samples.len())];
    };
    let window = whole::index((0.5 * period).ceil()).max(2);
    let heights: Vec<f64> = samples
        .chunks(window)
        .map(|c| c.iter().map(|v| (v - centre).abs()).fold(0.0, f64::max))
        .collect();
    let greatest = heights.iter().copied().fold(0.0, f64::max);
    let noise = ABOVE_NOISE * robust::noise_deviation(samples);
    let mut blows: Vec<usize> = (2..heights.len())
        .filter(|&i| {
            // the window of the blow and the one after it hold its height
            let height = heights[i..(i + 2).min(heights.len())]
                .iter()
                .copied()
                .fold(0.0, f64::max);
            let later = heights[i..(i + 6).min(heights.len())]
                .iter()
                .copied()
                .fold(0.0, f64::max);
            let before = heights[i - 2].max(heights[i - 1]);
            let rises = height > (RISE * before).max(before + noise);
            rises && height > BLOW * greatest && later <= 1.1 * height
        })
        .collect();
    blows.dedup_by(|b, a| *b <= *a + 2);
    let begins = blows.iter().map(|b| b * window);
    let mut edges: Vec<usize> = begins.map(|b| b.saturating_sub(1)).collect();
    edges.push(samples.len());
    let mut out = Vec::new();
    let mut from = 0;
    for edge in edges {
        if out.is_empty()
            && heights[..edge.div_ceil(window)]
                .iter()
                .all(|h| *h < BLOW * greatest)
        {
            // nothing but rest before the first blow: what hums in it is no decay
            continue;
        }
        out.push((from, edge));
        from = edge;
    }
    out
}

/// The first sample of a motion that a blow may have begun.
pub(super) fn moves(samples: &[f64]) -> Option<usize> {
    let centre = robust::median(samples)?;
    let size = |v: &f64| (v - centre).abs();
    let greatest = samples.iter().map(size).fold(0.0, f64::max);
    samples.iter().position(|v| size(v) > BLOW * greatest)
}

/// Where a motion begins: the first sample of a great excursion, and the first after which it is no longer
/// as great.
pub(super) fn begin(samples: &[f64]) -> Option<(usize, usize)> {
    let centre = robust::median(samples)?;
    let size = |v: &f64| (v - centre).abs();
    let greatest = samples.iter().map(size).fold(0.0, f64::max);
    if !(greatest > 0.0) {
        return None;
    }
    let above = |i: usize| size(&samples[i]) >= BEGUN * greatest;
    let first = (0..samples.len()).find(|i| above(*i))?;
    let held = (first..samples.len()).find(|i| !above(*i))?;
    Some((first, held))
}

/// The first sample that may be of the decay, of a period in samples: the motion may have begun before its
/// first great excursion, unless the mass was held there before it was released, or at rest up to there.
pub(super) fn earliest(samples: &[f64], (first, held): (usize, usize), period: f64) -> usize {
    if (held - first) as f64 > HELD * period {
        return held;
    }
    let earliest = first.saturating_sub(whole::index(BEFORE * period));
    let (before, between) = samples[..first].split_at(earliest);
    earliest + rests(before, between)
}

/// Samples `between` up to the last one that is at rest as those `before` are; none where too few tell that.
fn rests(before: &[f64], between: &[f64]) -> usize {
    if before.len() < TELL_REST {
        return 0;
    }
    let level = robust::mean(before);
    let rest: Vec<f64> = before.iter().map(|v| v - level).collect();
    let least = (AT_REST * robust::rms(&rest)).max(columns::digit(before));
    let last = between.iter().rposition(|v| (v - level).abs() <= least);
    last.map_or(0, |last| last + 1)
}

/// The part of a decay in which it is well above what is left of it; all of it where noise hides that.
pub(super) fn lasting(samples: &[f64]) -> &[f64] {
    let Some(centre) = robust::median(samples) else {
        return samples;
    };
    let size = |v: &f64| (v - centre).abs();
    let greatest = samples.iter().map(size).fold(0.0, f64::max);
    let noise = ABOVE_NOISE * robust::noise_deviation(samples);
    if noise > HIDES * greatest {
        return samples;
    }
    let least = (DECAYED * greatest).max(noise);
    let last = samples.iter().rposition(|v| size(v) > least);
    let end = last.map_or(samples.len(), |l| (l + 1) * 3 / 2).max(24);
    &samples[..end.min(samples.len())]
}
