//! Records and brackets with their place in the (η, ρ) plane, and counts over all of them.

use super::input::Input;
use impact_fit::methods::boundaries::block::predicted_hz;
use impact_fit::{Method, Reason};
use impact_records::motion::{BoundaryKind, Bracket, Motion, Observation};
use impact_records::record::{FlagCode, Problem, Sweep};
use impact_records::signal::robust;

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

pub(super) fn overview(input: &Input<'_>) -> Overview {
    let all = input.observations;
    let frequencies = all.iter().filter_map(|o| Some(o.tone()?.frequency_hz));
    let mut clearances: Vec<f64> = all.iter().filter_map(|o| o.setting.clearance_m).collect();
    clearances.sort_by(f64::total_cmp);
    clearances.dedup();
    let median = |f: fn(&Observation) -> f64| {
        robust::median(&all.iter().map(f).filter(|v| *v > 0.0).collect::<Vec<_>>())
    };
    Overview {
        records: all.len(),
        records_used: all.iter().filter(|o| !o.excluded()).count(),
        impacts: all.iter().map(|o| o.impacts.len()).sum(),
        record_length_s: median(|o| o.duration_s),
        sample_rate_hz: median(|o| o.sample_rate_hz),
        frequency_range_hz: robust::range(frequencies).map(Into::into),
        clearances_m: clearances,
    }
}

/// One record as observed, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordRow {
    /// The record's name.
    pub id: String,
    /// `RigKind`, mass or bumper, if the campaign has several.
    pub specimen: Option<String>,
    /// Measured drive frequency, Hz; `None` without a drive.
    pub frequency_hz: Option<f64>,
    /// η = f/f0, if f0 is known.
    pub eta: Option<f64>,
    /// Clearance r, m.
    pub clearance_m: Option<f64>,
    /// ρ = `r/x_st`, if `x_st` is known.
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
    pub flags: Vec<FlagCode>,
    /// The methods whose fit used the record.
    pub used_by: Vec<Method>,
    /// What excludes it, if something does.
    pub excluded: Option<Problem>,
    /// Why a fit left it out; `None` if none did.
    pub left_out: Option<Reason>,
}

/// Most records that are listed; of more, every second, third … The replayed ones are always
/// among them.
const MOST_RECORDS: usize = 6_000;

pub(super) fn records(input: &Input<'_>, chosen: &[usize]) -> Vec<RecordRow> {
    let reasons = input.record_reasons();
    let all = input.observations;
    let stride = all.len().div_ceil(MOST_RECORDS).max(1);
    let listed = |i: &usize| i.is_multiple_of(stride) || chosen.contains(i);
    (0..all.len())
        .filter(listed)
        .map(|i| record(input, i, reasons.get(&i).copied()))
        .collect()
}

/// Every record, however many.
pub(super) fn all_records(input: &Input<'_>) -> Vec<RecordRow> {
    let reasons = input.record_reasons();
    let row = |i| record(input, i, reasons.get(&i).copied());
    (0..input.observations.len()).map(row).collect()
}

fn record(input: &Input<'_>, index: usize, reason: Option<&Reason>) -> RecordRow {
    let o = &input.observations[index];
    let (eta, rho) = input.place(o);
    let excluding = o.flags.iter().find(|f| f.excludes);
    RecordRow {
        id: o.record.clone(),
        specimen: o.setting.specimen.clone(),
        frequency_hz: o.frequency_hz(),
        eta,
        clearance_m: o.setting.clearance_m,
        rho,
        sweep: o.setting.sweep,
        motion: o.classification.motion.clone(),
        confidence: o.classification.confidence,
        impacts: o.impacts.len(),
        flags: o.flags.iter().map(|f| f.code).collect(),
        used_by: input.identification.methods_using(index).collect(),
        excluded: excluding.map(|f| f.problem.clone()),
        left_out: reason.cloned(),
    }
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
    /// ρ, if `x_st` is known.
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
    pub left_out: Option<Reason>,
}

pub(super) fn brackets(input: &Input<'_>) -> Vec<BracketRow> {
    let reasons = input.bracket_reasons();
    let brackets = input.brackets.iter().enumerate();
    let row = |(i, b)| bracket(input, b, reasons.get(&i).copied());
    brackets.map(row).collect()
}

fn bracket(input: &Input<'_>, b: &Bracket, reason: Option<&Reason>) -> BracketRow {
    let parameters = input.parameters();
    let ends = [b.frequency_low_hz, b.frequency_high_hz];
    let closed_form = matches!(b.kind, BoundaryKind::SaddleNode | BoundaryKind::Grazing);
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
        left_out: reason.cloned(),
    }
}
