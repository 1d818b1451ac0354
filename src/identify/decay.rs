//! Free decays: f0 and β of each record, pooled, and records that are filed under the wrong name.

use std::collections::BTreeMap;

use crate::identify::estimate::{self, Status};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::identification::MethodResult;
use crate::identify::messages::{Item, LeftOut, Note, Reason, Remark};
use crate::identify::uncertainty::quantile::NORMAL_975;
use crate::motion::Observation;
use crate::signal::decay::Decay;
use crate::signal::robust;

/// Relative spread of f0 from which decays are not of one oscillator.
const ONE_OSCILLATOR: f64 = 0.02;
/// Relative difference of f0 from its own group's from which a record is looked at.
const STRANGE: f64 = 0.05;
/// Share of the signal that is neither the fitted decay nor noise from which a decay does not fit.
const STRUCTURE: f64 = 0.15;
/// Standard errors from which a drift of the frequency is significant.
const DRIFTS: f64 = 5.0;
/// Drift from which a decay has no single frequency, in half widths of its 95 % interval.
const NO_SINGLE: f64 = 5.0;

/// All free decays of a campaign, pooled; `None` without any.
pub fn pooled(observations: &[Observation]) -> Option<MethodResult> {
    let decays: Vec<&Decay> = observations
        .iter()
        .filter(|o| !o.excluded())
        .filter_map(|o| o.decay.as_ref())
        .collect();
    if decays.is_empty() {
        return None;
    }
    let frequencies: Vec<(f64, f64)> = decays
        .iter()
        .map(|d| {
            let error = d.natural_frequency_error_hz.hypot(drift_error_hz(d));
            let f = d.natural_frequency_hz;
            (f.ln(), error / f)
        })
        .collect();
    let dampings: Vec<(f64, f64)> = decays
        .iter()
        .map(|d| {
            (
                d.damping_ratio.ln(),
                d.damping_ratio_error / d.damping_ratio,
            )
        })
        .collect();
    let mut result = MethodResult {
        observations: decays.iter().map(|d| d.samples).sum(),
        records: decays.len(),
        ..MethodResult::default()
    };
    let (f, f_error) = weighted_mean(&frequencies);
    let (b, b_error) = weighted_mean(&dampings);
    result.parameters.natural_frequency_hz =
        Some(estimate::estimate(Coordinate::Frequency, f, f_error));
    result.parameters.damping_ratio = Some(estimate::estimate(Coordinate::Damping, b, b_error));
    let spread = frequencies
        .iter()
        .map(|p| (p.0 - f).abs())
        .fold(0.0, f64::max);
    judge(&mut result, &decays, spread);
    Some(result)
}

/// Judge whether the decays are of one linear oscillator: by what their residuals have beside noise,
/// not by the size of the noise.
fn judge(result: &mut MethodResult, decays: &[&Decay], spread: f64) {
    let median = |of: &dyn Fn(&Decay) -> f64| {
        robust::median(&decays.iter().map(|d| of(d)).collect::<Vec<_>>()).unwrap_or(0.0)
    };
    if spread > ONE_OSCILLATOR {
        result.fits = Some(false);
        result.remarks.push(Remark::DecaysDiffer { spread });
        return;
    }
    let share = median(&|d| d.residual_ratio);
    let structure = median(&|d| d.structured_ratio);
    result.fits = Some(structure < STRUCTURE);
    result.remarks.push(match structure < STRUCTURE {
        true => Remark::DecaysUnexplained { share, structure },
        false => Remark::DecaysHaveStructure { share, structure },
    });
    let drifting: Vec<&Decay> = decays.iter().copied().filter(|d| drifts(d)).collect();
    let half = |d: &Decay| NORMAL_975 * d.natural_frequency_error_hz;
    let change = |d: &Decay| d.drift.map_or(0.0, |d| d.last_hz - d.first_hz);
    let worst = drifting
        .iter()
        .max_by(|a, b| change(a).abs().total_cmp(&change(b).abs()));
    let Some((worst, drift)) = worst.and_then(|d| Some((d, d.drift?))) else {
        return;
    };
    let no_single = drifting
        .iter()
        .any(|d| change(d).abs() > NO_SINGLE * half(d).max(f64::MIN_POSITIVE));
    result.remarks.push(Remark::DecaysDrift {
        count: drifting.len(),
        first_hz: drift.first_hz,
        last_hz: drift.last_hz,
        intervals: change(worst).abs() / half(worst).max(f64::MIN_POSITIVE),
    });
    if no_single && 2 * drifting.len() > decays.len() {
        result.fits = Some(false);
        if let Some(estimate) = &mut result.parameters.natural_frequency_hz {
            estimate.status = Status::Weak;
            estimate.note = Some(Note::Drifts);
        }
    }
}

/// Whether the frequency of a decay drifts significantly.
fn drifts(decay: &Decay) -> bool {
    decay.drift.is_some_and(|d| d.z_score().abs() > DRIFTS)
}

/// What a significant drift leaves open of the frequency, Hz: it is anywhere between its ends.
fn drift_error_hz(decay: &Decay) -> f64 {
    match decay.drift.filter(|_| drifts(decay)) {
        Some(drift) => (drift.last_hz - drift.first_hz).abs() / 12f64.sqrt(),
        None => 0.0,
    }
}

/// Weighted mean with the greater of inner and outer standard error.
fn weighted_mean(values: &[(f64, f64)]) -> (f64, f64) {
    let weight: f64 = values.iter().map(|(_, e)| e.powi(-2)).sum();
    let mean = values.iter().map(|(v, e)| v / (e * e)).sum::<f64>() / weight;
    let inner = weight.recip().sqrt();
    if values.len() < 2 {
        return (mean, inner);
    }
    let chi: f64 = values.iter().map(|(v, e)| ((v - mean) / e).powi(2)).sum();
    let outer = inner * (chi / (values.len() - 1) as f64).sqrt();
    (mean, inner.max(outer))
}

/// Records whose natural frequency is not that of their specimen but that of another.
pub fn misfiled(observations: &[Observation]) -> Vec<LeftOut> {
    let mut groups: BTreeMap<&str, Vec<(usize, f64)>> = BTreeMap::new();
    for (index, o) in observations.iter().enumerate() {
        if let (Some(specimen), Some(decay)) = (&o.setting.specimen, &o.decay) {
            let group = groups.entry(specimen).or_default();
            group.push((index, decay.natural_frequency_hz));
        }
    }
    let centres: BTreeMap<&str, f64> = groups
        .iter()
        .filter_map(|(name, members)| {
            let f: Vec<f64> = members.iter().map(|m| m.1).collect();
            Some((*name, robust::median(&f)?))
        })
        .collect();
    let mut out = Vec::new();
    for (name, members) in &groups {
        for (index, f) in members {
            let own = centres[name];
            if members.len() < 3 || (f / own - 1.0).abs() < STRANGE {
                continue;
            }
            let other = centres
                .iter()
                .filter(|(other, _)| *other != name)
                .min_by(|a, b| (a.1 / f - 1.0).abs().total_cmp(&(b.1 / f - 1.0).abs()))
                .filter(|(_, centre)| (*centre / f - 1.0).abs() < 0.5 * STRANGE);
            out.push(LeftOut {
                item: Item::Record {
                    index: *index,
                    record: observations[*index].record.clone(),
                },
                reason: match other {
                    Some((like, like_hz)) => Reason::MisfiledLike {
                        specimen: (*name).to_owned(),
                        specimen_hz: own,
                        frequency_hz: *f,
                        like: (*like).to_owned(),
                        like_hz: *like_hz,
                    },
                    None => Reason::Misfiled {
                        specimen: (*name).to_owned(),
                        specimen_hz: own,
                        frequency_hz: *f,
                    },
                },
            });
        }
    }
    out
}
