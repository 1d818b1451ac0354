//! Free decays with their fits.

use std::collections::BTreeMap;

use super::{Gathered, moves};
use crate::identify::Reason;
use crate::motion::Observation;
use crate::record::{Channel, Record};
use crate::report::content::{FreeDecay, Signal};
use crate::signal::decay::Decay;

/// Most decays that are drawn.
const MOST: usize = 12;
/// How much is drawn before the fit begins, s.
const SHOWN_BEFORE_S: f64 = 0.03;
/// Most points of a drawn decay: more than the figure can show.
const MOST_POINTS: usize = 3000;

/// Records whose decay is drawn: of each specimen as many as of the others, in the order of
/// acquisition, those first that look misfiled or fit worst.
pub fn shown_decays(observations: &[Observation]) -> Vec<usize> {
    let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, o) in observations.iter().enumerate() {
        if o.decay.is_some() && !o.excluded() {
            let name = o.setting.specimen.as_deref().unwrap_or("");
            groups.entry(name).or_default().push(i);
        }
    }
    let ratio = |i: &usize| observations[*i].decay.map_or(0.0, |d| d.residual_ratio);
    for members in groups.values_mut() {
        members.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
    }
    let mut shown: Vec<usize> = Vec::new();
    let longest = groups.values().map(Vec::len).max().unwrap_or(0);
    for rank in 0..longest {
        shown.extend(groups.values().filter_map(|g| g.get(rank)));
    }
    shown.truncate(MOST);
    shown.sort_unstable();
    shown
}

pub(super) fn free_decays(gathered: &Gathered) -> Vec<FreeDecay> {
    let pairs = gathered.decays.iter().zip(gathered.decay_records);
    let reasons = gathered.record_reasons();
    pairs
        .filter_map(|(index, record)| {
            let reason = reasons.get(index).copied();
            free_decay(&gathered.observations[*index], record, reason)
        })
        .collect()
}

fn free_decay(o: &Observation, record: &Record, left: Option<&Reason>) -> Option<FreeDecay> {
    let decay = o.decay?;
    let fitted = decay.values(record.sample_rate_hz);
    let channel = record
        .channels
        .iter()
        .filter(|c| moves(c.role) && c.values.len() >= decay.first + decay.samples)
        .min_by(|a, b| apart(a, &decay, &fitted).total_cmp(&apart(b, &decay, &fitted)))?;
    let name = match &o.setting.specimen {
        Some(specimen) => format!("{specimen}: {}", o.record),
        None => o.record.clone(),
    };
    // the blow itself would dwarf what was fitted
    let before = (SHOWN_BEFORE_S * record.sample_rate_hz) as usize;
    let shown = decay.first.saturating_sub(before);
    Some(FreeDecay {
        record: name,
        dimension: channel.dimension,
        measured: thinned(record.sample_rate_hz, shown, &channel.values[shown..]),
        fitted: Some(thinned(record.sample_rate_hz, decay.first, &fitted)),
        natural_frequency_hz: Some(decay.natural_frequency_hz),
        natural_frequency_error_hz: Some(decay.natural_frequency_error_hz),
        damping_ratio: Some(decay.damping_ratio),
        damping_ratio_error: Some(decay.damping_ratio_error),
        note: left.map(ToString::to_string).unwrap_or_default(),
    })
}

/// Squares that a fitted decay leaves of a channel, over the channel's own.
fn apart(channel: &Channel, decay: &Decay, fitted: &[f64]) -> f64 {
    let tail = &channel.values[decay.first..][..decay.samples];
    let left: f64 = tail.iter().zip(fitted).map(|(m, f)| (m - f).powi(2)).sum();
    left / tail.iter().map(|m| m * m).sum::<f64>()
}

/// Samples from an index on as a signal of few enough points.
fn thinned(rate_hz: f64, first: usize, values: &[f64]) -> Signal {
    let stride = values.len().div_ceil(MOST_POINTS).max(1);
    let kept = (0..values.len()).step_by(stride);
    Signal {
        time_s: kept.clone().map(|i| (first + i) as f64 / rate_hz).collect(),
        values: kept.map(|i| values[i]).collect(),
    }
}
