//! Records and brackets with their place in the (η, ρ) plane, and counts over all of them.

use std::collections::HashMap;

use super::input::Input;
use crate::event::Rig;
use crate::identify::evidence::boundary::predicted_hz;
use crate::identify::evidence::flights::is_flown;
use crate::motion::{BoundaryKind, Bracket, Motion, Observation};
use crate::record::Sweep;
use crate::signal::robust;

/// Counts and ranges of what was measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overview {
    /// Number of records.
    pub records: usize,
    /// Number of records without a flag that excludes them.
    pub records_used: usize,
    /// Number of impacts detected.
    pub impacts: usize,
    /// Median length of a record, s.
    pub record_length_s: Option<f64>,
    /// Median sample rate, Hz.
    pub sample_rate_hz: Option<f64>,
    /// Least and greatest measured drive frequency, Hz.
    pub frequency_range_hz: Option<[f64; 2]>,
    /// The clearances r, m, ascending.
    pub clearances_m: Vec<f64>,
}

pub(super) fn overview(input: &Input) -> Overview {
    let all = input.observations;
    let frequencies = || all.iter().filter_map(|o| Some(o.drive?.frequency_hz));
    let mut clearances: Vec<f64> = all.iter().filter_map(|o| o.setting.clearance_m).collect();
    clearances.sort_by(f64::total_cmp);
    clearances.dedup();
    let median = |f: fn(&Observation) -> f64| {
        robust::median(&all.iter().map(f).filter(|v| *v > 0.0).collect::<Vec<_>>())
    };
    let ends = frequencies()
        .reduce(f64::min)
        .zip(frequencies().reduce(f64::max));
    Overview {
        records: all.len(),
        records_used: all.iter().filter(|o| !o.excluded()).count(),
        impacts: all.iter().map(|o| o.impacts.len()).sum(),
        record_length_s: median(|o| o.duration_s),
        sample_rate_hz: median(|o| o.sample_rate_hz),
        frequency_range_hz: ends.map(|(low, high)| [low, high]),
        clearances_m: clearances,
    }
}

/// One record as observed, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordRow {
    /// The record's name.
    pub id: String,
    /// Rig, mass or bumper, if the campaign has several.
    pub specimen: Option<String>,
    /// Measured drive frequency, Hz; `None` without a drive.
    pub frequency_hz: Option<f64>,
    /// η = f/f0, if f0 is known.
    pub eta: Option<f64>,
    /// Clearance r, m.
    pub clearance_m: Option<f64>,
    /// ρ = r/x_st, if x_st is known.
    pub rho: Option<f64>,
    /// Direction of the sweep.
    pub sweep: Sweep,
    /// Type of motion found.
    pub motion: Motion,
    /// Confidence in the type of motion, 0 to 1.
    pub confidence: f64,
    /// Number of impacts detected.
    pub impacts: usize,
    /// Codes of its flags.
    pub flags: Vec<String>,
    /// The methods that used the record.
    pub used_by: Vec<String>,
    /// Why no method used it, if none did.
    pub left_out: Option<String>,
}

/// Most records that are listed; of more, every second, third … The replayed ones are always
/// among them.
const MOST_RECORDS: usize = 6_000;

pub(super) fn records(input: &Input, chosen: &[usize]) -> Vec<RecordRow> {
    let reasons = input.left_out.iter().rev();
    let reasons: HashMap<&str, &str> = reasons.map(|(n, why)| (n.as_str(), why.as_str())).collect();
    let all = input.observations;
    let stride = all.len().div_ceil(MOST_RECORDS).max(1);
    all.iter()
        .enumerate()
        .filter(|(i, _)| i.is_multiple_of(stride) || chosen.contains(i))
        .map(|(_, o)| record(input, o, reasons.get(o.record.as_str()).copied()))
        .collect()
}

fn record(input: &Input, o: &Observation, reason: Option<&str>) -> RecordRow {
    let (eta, rho) = input.place(o);
    let used_by = if o.excluded() {
        Vec::new()
    } else {
        used_by(input.rig, o, reason.is_some())
    };
    let excluding = o.flags.iter().find(|f| f.excludes);
    let excluding = excluding.map(|f| f.message.clone());
    RecordRow {
        id: o.record.clone(),
        specimen: o.setting.specimen.clone(),
        frequency_hz: o.frequency_hz(),
        eta,
        clearance_m: o.setting.clearance_m,
        rho,
        sweep: o.setting.sweep,
        motion: o.finding.motion.clone(),
        confidence: o.finding.confidence,
        impacts: o.impacts.len(),
        flags: o.flags.iter().map(|f| f.code.clone()).collect(),
        left_out: excluding
            .or_else(|| reason.map(str::to_owned))
            .filter(|_| used_by.is_empty()),
        used_by,
    }
}

fn used_by(rig: Rig, o: &Observation, left_out: bool) -> Vec<String> {
    let speeds = |o: &Observation| {
        let mut impacts = o.impacts.iter();
        impacts.any(|i| i.closing_speed_before_m_s.is_some())
    };
    let methods = [
        ("resonance", !o.response.is_empty() && !left_out),
        ("trajectories", o.folded.is_some() && !left_out),
        ("impacts", speeds(o)),
        ("flights", is_flown(rig, o) && !left_out),
        ("free_decay", o.decay.is_some()),
    ];
    let used = methods.into_iter().filter(|(_, used)| *used);
    used.map(|(name, _)| name.to_owned()).collect()
}

/// A boundary as measured, between two neighbouring records, beside the fitted model's.
#[derive(Debug, Clone, PartialEq)]
pub struct BracketRow {
    /// Which boundary.
    pub kind: BoundaryKind,
    /// The motion that ends or begins there.
    pub motion: Motion,
    /// Clearance r, m.
    pub clearance_m: f64,
    /// ρ, if x_st is known.
    pub rho: Option<f64>,
    /// Drive frequency of the record on the low side, Hz.
    pub frequency_low_hz: f64,
    /// Drive frequency of the record on the high side, Hz.
    pub frequency_high_hz: f64,
    /// η of the low and the high side, if f0 is known.
    pub eta: Option<[f64; 2]>,
    /// Direction of the sweep.
    pub sweep: Sweep,
    /// The boundary of the fitted model, Hz, if it has one at this clearance in closed form.
    pub simulated_hz: Option<f64>,
    /// Why the fit left it out; `None` if it did not.
    pub left_out: Option<String>,
}

pub(super) fn brackets(input: &Input) -> Vec<BracketRow> {
    input.brackets.iter().map(|b| bracket(input, b)).collect()
}

fn bracket(input: &Input, b: &Bracket) -> BracketRow {
    let parameters = input.parameters();
    let ends = [b.frequency_low_hz, b.frequency_high_hz];
    let closed_form = matches!(b.kind, BoundaryKind::SaddleNode | BoundaryKind::Grazing);
    let place = format!("bracket {} {:.2}–{:.2} Hz", b.kind.name(), ends[0], ends[1]);
    let reason = |(what, why): &(String, String)| what.starts_with(&place).then(|| why.clone());
    BracketRow {
        kind: b.kind,
        motion: match b.kind {
            BoundaryKind::Grazing => Motion::Impactless,
            _ => Motion::periodic(1, b.periods_n),
        },
        clearance_m: b.clearance_m,
        rho: parameters.map(|p| b.clearance_m / (p.static_deflection_m * b.drive_amplitude)),
        frequency_low_hz: ends[0],
        frequency_high_hz: ends[1],
        eta: parameters.map(|p| ends.map(|f| f / p.natural_frequency_hz)),
        sweep: b.sweep,
        simulated_hz: parameters
            .filter(|_| closed_form)
            .and_then(|p| predicted_hz(b, p, input.rig)),
        left_out: input.left_out.iter().find_map(reason),
    }
}
