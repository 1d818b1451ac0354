//! Free decays beside their fits.

use std::collections::BTreeMap;

use super::input::Input;
use super::traces::Signal;
use impact_fit::Reason;
use impact_records::motion::Observation;
use impact_records::record::{Channel, Record};
use impact_records::signal::decay::Decay;
use impact_records::signal::whole;
use labfiles::units::Dimension;

/// A free decay with its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeDecay {
    /// The record's name.
    pub record: String,
    /// The specimen, if the campaign has several.
    pub specimen: Option<String>,
    /// Dimension of the signal.
    pub dimension: Dimension,
    /// As measured.
    pub measured: Signal,
    /// The fitted decay.
    pub fitted: Signal,
    /// Natural frequency f0, Hz (undamped), and its standard error.
    pub natural_frequency_hz: [f64; 2],
    /// Damping ratio β and its standard error.
    pub damping_ratio: [f64; 2],
    /// Why the fit left it out; `None` if it did not.
    pub left_out: Option<Reason>,
}

/// Most decays that are shown.
const MOST: usize = 12;
/// How much is shown before the fit begins, periods.
const SHOWN_BEFORE: f64 = 0.5;
/// Most points of a decay: more than a figure can show.
const MOST_POINTS: usize = 3000;

/// Indices of the records whose decay is shown, in the order of acquisition: of each specimen as
/// many as of the others, first those whose fit leaves most of the signal.
fn shown(observations: &[Observation]) -> Vec<usize> {
    let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, o) in observations.iter().enumerate() {
        if !o.decays.is_empty() && !o.excluded() {
            let name = o.setting.specimen.as_deref().unwrap_or("");
            groups.entry(name).or_default().push(i);
        }
    }
    let ratio = |i: &usize| {
        observations[*i]
            .best_decay()
            .map_or(0.0, |d| d.residual_ratio)
    };
    for members in groups.values_mut() {
        members.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
    }
    let longest = groups.values().map(Vec::len).max().unwrap_or(0);
    let by_rank = |rank| groups.values().filter_map(move |g| g.get(rank).copied());
    let mut shown: Vec<usize> = (0..longest).flat_map(by_rank).take(MOST).collect();
    shown.sort_unstable();
    shown
}

pub(super) fn free_decays(input: &Input<'_>) -> Vec<FreeDecay> {
    let reasons = input.record_reasons();
    let records = shown(input.observations).into_iter();
    let decays = records.filter_map(|i| {
        let reason = reasons.get(&i).copied();
        free_decay(&input.observations[i], &(input.read)(i)?, reason)
    });
    decays.collect()
}

/// The free decay of a record that determines f0 best, beside its fit; `None` of a record that has none.
pub(super) fn free_decay(
    o: &Observation,
    record: &Record,
    reason: Option<&Reason>,
) -> Option<FreeDecay> {
    let decay = o.best_decay()?;
    let fitted = decay.values(record.sample_rate_hz);
    let long_enough = |c: &&Channel| c.values.len() >= decay.first + decay.samples;
    let channels = record.channels.iter();
    let channel = channels
        .filter(|c| c.role.is_motion())
        .filter(long_enough)
        .min_by(|a, b| unexplained(a, decay, &fitted).total_cmp(&unexplained(b, decay, &fitted)))?;
    // the blow itself would dwarf what was fitted
    let before = whole::index(SHOWN_BEFORE * record.sample_rate_hz / decay.natural_frequency_hz);
    let first = decay.first.saturating_sub(before);
    Some(FreeDecay {
        record: o.record.clone(),
        specimen: o.setting.specimen.clone(),
        dimension: channel.dimension,
        measured: thinned(record.sample_rate_hz, first, &channel.values[first..]),
        fitted: thinned(record.sample_rate_hz, decay.first, &fitted),
        natural_frequency_hz: [decay.natural_frequency_hz, decay.natural_frequency_error_hz],
        damping_ratio: [decay.damping_ratio, decay.damping_ratio_error],
        left_out: reason.cloned(),
    })
}

/// Squares that a fitted decay leaves of a channel, over the channel's own.
fn unexplained(channel: &Channel, decay: &Decay, fitted: &[f64]) -> f64 {
    let tail = &channel.values[decay.first..][..decay.samples];
    let left: f64 = tail.iter().zip(fitted).map(|(m, f)| (m - f).powi(2)).sum();
    left / tail.iter().map(|m| m * m).sum::<f64>()
}

/// Samples from an index on as a signal of few enough points.
fn thinned(rate_hz: f64, first: usize, values: &[f64]) -> Signal {
    let stride = values.len().div_ceil(MOST_POINTS).max(1);
    let kept = (0..values.len()).step_by(stride);
    let kept = kept.filter(|i| values[*i].is_finite());
    Signal {
        time_s: kept.clone().map(|i| (first + i) as f64 / rate_hz).collect(),
        values: kept.map(|i| values[i]).collect(),
    }
}
