//! The campaign's summary and the rows of records and brackets.

use super::{ChannelFacts, Gathered};
use crate::identify::Reason;
use crate::motion::{self, Motion, Observation};
use crate::report::content::{
    BoundaryKind, BracketRow, CampaignSummary, ChannelRow, NominalValue, RecordRow,
};
use crate::signal::robust;

pub(super) fn summary(gathered: &Gathered) -> CampaignSummary {
    let all = gathered.observations;
    let frequencies: Vec<f64> = all
        .iter()
        .filter_map(|o| Some(o.drive?.frequency_hz))
        .collect();
    let mut clearances: Vec<f64> = all.iter().filter_map(|o| o.setting.clearance_m).collect();
    clearances.sort_by(f64::total_cmp);
    clearances.dedup();
    let median = |f: fn(&Observation) -> f64| {
        robust::median(&all.iter().map(f).filter(|v| *v > 0.0).collect::<Vec<_>>())
    };
    CampaignSummary {
        name: gathered.campaign.name.clone(),
        rig: match gathered.campaign.rig {
            crate::event::RigKind::Double => "two masses against each other".into(),
            crate::event::RigKind::Single => "one mass against a stop".into(),
        },
        records_total: all.len(),
        records_used: all.iter().filter(|o| !o.excluded()).count(),
        impacts_total: all.iter().map(|o| o.impacts.len()).sum(),
        files_total: gathered.campaign.files,
        record_length_s: median(|o| o.duration_s),
        sample_rate_hz: median(|o| o.sample_rate_hz),
        frequency_range_hz: range(&frequencies),
        clearances_m: clearances,
        nominal: gathered
            .campaign
            .nominal
            .iter()
            .map(|(name, value, unit)| NominalValue {
                name: name.clone(),
                value: *value,
                unit: unit.clone(),
            })
            .collect(),
        channels: gathered.campaign.channels.iter().map(channel_row).collect(),
        laboratory: gathered.campaign.laboratory.clone(),
        dates: gathered.campaign.dates.clone(),
        synthetic: gathered.campaign.synthetic,
        ..CampaignSummary::default()
    }
}

fn channel_row(channel: &ChannelFacts) -> ChannelRow {
    let unit = channel.role.dimension().map_or("", |d| d.si_symbol());
    ChannelRow {
        role: channel.role,
        name: channel.name.clone(),
        unit: unit.to_owned(),
        note: channel.instrument.clone().unwrap_or_default(),
        high_pass_hz: channel.high_pass_hz,
    }
}

fn range(values: &[f64]) -> Option<[f64; 2]> {
    let low = values.iter().copied().reduce(f64::min)?;
    let high = values.iter().copied().reduce(f64::max)?;
    Some([low, high])
}

/// η and ρ of a setting with the fitted parameters.
pub(super) fn place(gathered: &Gathered, o: &Observation) -> (Option<f64>, Option<f64>) {
    let Some(parameters) = gathered.parameters() else {
        return (None, None);
    };
    let eta = o
        .frequency_hz()
        .map(|f| f / parameters.natural_frequency_hz);
    let scale = parameters.static_deflection_m * o.setting.drive_amplitude;
    (eta, o.setting.clearance_m.map(|c| c / scale))
}

/// Most records that the report lists and draws; of more, every second, third … The chosen ones
/// are always among them, and records.parquet holds all.
const MOST_RECORDS: usize = 6_000;

pub(super) fn records(gathered: &Gathered) -> Vec<RecordRow> {
    let left = gathered.record_reasons();
    let all = gathered.observations;
    let stride = all.len().div_ceil(MOST_RECORDS).max(1);
    all.iter()
        .enumerate()
        .filter(|(i, _)| i.is_multiple_of(stride) || gathered.chosen.contains(i))
        .map(|(i, o)| record(gathered, i, o, left.get(&i).copied()))
        .collect()
}

fn record(gathered: &Gathered, index: usize, o: &Observation, left: Option<&Reason>) -> RecordRow {
    let (eta, rho) = place(gathered, o);
    let pair = o.classification.impacts_and_periods();
    let using = gathered.identification.methods_using(index);
    let used_by: Vec<String> = using.map(|m| m.name().to_owned()).collect();
    let excluded = o
        .flags
        .iter()
        .find(|f| f.excludes)
        .map(|f| f.message.clone());
    RecordRow {
        id: o.record.clone(),
        specimen: o.setting.specimen.clone(),
        frequency_hz: o.frequency_hz(),
        eta,
        clearance_m: o.setting.clearance_m,
        rho,
        sweep: o.setting.sweep,
        motion: o.classification.motion.clone(),
        impacts_p: pair.map(|p| p.0),
        periods_n: pair.map(|p| p.1),
        confidence: Some(o.classification.confidence),
        impacts: o.impacts.len(),
        flags: o.flags.iter().map(|f| f.code.replace('_', " ")).collect(),
        left_out: excluded
            .or_else(|| left.map(ToString::to_string))
            .filter(|_| used_by.is_empty()),
        used_by,
    }
}

pub(super) fn brackets(gathered: &Gathered) -> Vec<BracketRow> {
    gathered
        .brackets
        .iter()
        .enumerate()
        .map(|(i, b)| bracket(gathered, i, b))
        .collect()
}

fn bracket(gathered: &Gathered, index: usize, b: &motion::Bracket) -> BracketRow {
    let parameters = gathered.parameters();
    let eta = |f: f64| parameters.map(|p| f / p.natural_frequency_hz);
    let closed_form = matches!(
        b.kind,
        motion::BoundaryKind::SaddleNode | motion::BoundaryKind::Grazing
    );
    BracketRow {
        kind: match b.kind {
            motion::BoundaryKind::SaddleNode => BoundaryKind::S2,
            motion::BoundaryKind::PeriodDoubling => BoundaryKind::S1,
            motion::BoundaryKind::Grazing => BoundaryKind::Grazing,
            motion::BoundaryKind::Other => BoundaryKind::Edge,
        },
        motion: match b.kind {
            motion::BoundaryKind::Grazing => Motion::Impactless,
            _ => Motion::periodic(1, b.periods_n),
        },
        clearance_m: b.clearance_m,
        rho: parameters.map(|p| b.clearance_m / (p.static_deflection_m * b.drive_amplitude)),
        frequency_low_hz: b.frequency_low_hz,
        frequency_high_hz: b.frequency_high_hz,
        eta_low: eta(b.frequency_low_hz),
        eta_high: eta(b.frequency_high_hz),
        direction: b.sweep,
        simulated_hz: parameters.filter(|_| closed_form).and_then(|p| {
            crate::identify::evidence::boundary::predicted_hz(b, p, gathered.campaign.rig)
        }),
        records: Some(b.records.clone()),
        left_out: gathered.bracket_reason(index).map(ToString::to_string),
    }
}
