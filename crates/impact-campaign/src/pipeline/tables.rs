//! records.parquet, impacts.parquet and boundaries.csv: the names of their columns (units included)
//! and their values.

use std::path::Path;

use crate::pipeline::table::{Get, Table};
use crate::pipeline::{Observed, PipelineError};
use impact_records::event::{Impact, MassSpeeds};
use impact_records::motion::{Bracket, Motion, Observation};
use impact_records::record::Role;
use labfiles_write::output::write_together;

fn amplitude(o: &Observation, role: Role) -> Option<f64> {
    o.amplitudes
        .iter()
        .find(|a| a.role == role)
        .map(|a| a.half_range)
}

fn reason(o: &Observation) -> Option<String> {
    match &o.classification.motion {
        Motion::Undetermined { reason } => Some(reason.to_string()),
        _ => None,
    }
}

fn flags(o: &Observation) -> Option<String> {
    let list: Vec<String> = o
        .flags
        .iter()
        .map(|f| match &f.channel {
            Some(channel) => format!("{}({channel})", f.code),
            None => f.code.name().to_owned(),
        })
        .collect();
    Some(list.join(";"))
}

/// Columns of records.parquet.
const RECORDS: &[(&str, Get<Observation>)] = &[
    ("record", Get::Text(|o| Some(o.record.clone()))),
    ("specimen", Get::Text(|o| o.setting.specimen.clone())),
    ("sequence", Get::Count(|o| Some(o.setting.sequence))),
    ("frequency_hz", Get::Number(Observation::frequency_hz)),
    (
        "frequency_error_hz",
        Get::Number(|o| Some(o.tone()?.frequency_error_hz)),
    ),
    (
        "stated_frequency_hz",
        Get::Number(|o| o.setting.stated_frequency_hz),
    ),
    ("drive_amplitude", Get::Number(|o| Some(o.drive?.amplitude))),
    ("clearance_m", Get::Number(|o| o.setting.clearance_m)),
    (
        "sweep",
        Get::Text(|o| Some(o.setting.sweep.name().to_owned())),
    ),
    (
        "motion",
        Get::Text(|o| Some(o.classification.motion.label())),
    ),
    (
        "impacts_p",
        Get::Count(|o| o.classification.impacts_and_periods().map(|p| p.0 as usize)),
    ),
    (
        "periods_n",
        Get::Count(|o| o.classification.impacts_and_periods().map(|p| p.1 as usize)),
    ),
    (
        "confidence",
        Get::Number(|o| Some(o.classification.confidence)),
    ),
    ("reason", Get::Text(reason)),
    ("impacts", Get::Count(|o| Some(o.impacts.len()))),
    (
        "missed_contact_pulses",
        Get::Count(|o| Some(o.missed_pulses)),
    ),
    (
        "contact_pulses_without_jump",
        Get::Count(|o| Some(o.unsupported_pulses)),
    ),
    (
        "periods_observed",
        Get::Number(|o| Some(o.classification.evidence.periods_observed)),
    ),
    (
        "waveform_closure_ratio",
        Get::Number(|o| o.classification.evidence.waveform_closure),
    ),
    (
        "shorter_closure_ratio",
        Get::Number(|o| o.classification.evidence.shorter_closure),
    ),
    (
        "noise_ratio",
        Get::Number(|o| o.classification.evidence.noise_ratio),
    ),
    (
        "impact_closure_rad",
        Get::Number(|o| Some(o.classification.evidence.impact_closure?.phase_rad)),
    ),
    (
        "impact_closure_speed_ratio",
        Get::Number(|o| o.classification.evidence.impact_closure?.speed_ratio),
    ),
    (
        "count_agreement",
        Get::Number(|o| o.classification.evidence.count_agreement),
    ),
    (
        "impactless_periods",
        Get::Number(|o| Some(o.classification.evidence.irregularity?.impactless_periods)),
    ),
    (
        "speed_roughness",
        Get::Number(|o| Some(o.classification.evidence.irregularity?.speed_roughness)),
    ),
    (
        "velocity_x_amplitude_m_s",
        Get::Number(|o| amplitude(o, Role::VelocityX)),
    ),
    (
        "velocity_y_amplitude_m_s",
        Get::Number(|o| amplitude(o, Role::VelocityY)),
    ),
    (
        "displacement_x_amplitude_m",
        Get::Number(|o| amplitude(o, Role::DisplacementX)),
    ),
    (
        "displacement_y_amplitude_m",
        Get::Number(|o| amplitude(o, Role::DisplacementY)),
    ),
    (
        "acceleration_x_amplitude_m_s2",
        Get::Number(|o| amplitude(o, Role::AccelerationX)),
    ),
    (
        "acceleration_y_amplitude_m_s2",
        Get::Number(|o| amplitude(o, Role::AccelerationY)),
    ),
    (
        "decay_natural_frequency_hz",
        Get::Number(|o| Some(o.best_decay()?.natural_frequency_hz)),
    ),
    (
        "decay_natural_frequency_error_hz",
        Get::Number(|o| Some(o.best_decay()?.natural_frequency_error_hz)),
    ),
    (
        "decay_damping_ratio",
        Get::Number(|o| Some(o.best_decay()?.damping_ratio)),
    ),
    (
        "decay_damping_ratio_error",
        Get::Number(|o| Some(o.best_decay()?.damping_ratio_error)),
    ),
    ("flags", Get::Text(flags)),
    ("excluded", Get::Flag(|o| Some(o.excluded()))),
];

/// An impact with its record's name.
type ImpactRow = (String, Impact);

fn before(speeds: Option<MassSpeeds>) -> Option<f64> {
    speeds.map(|s| s.before_m_s)
}

fn after(speeds: Option<MassSpeeds>) -> Option<f64> {
    speeds.map(|s| s.after_m_s)
}

/// Columns of impacts.parquet.
const IMPACTS: &[(&str, Get<ImpactRow>)] = &[
    ("record", Get::Text(|r| Some(r.0.clone()))),
    ("time_s", Get::Number(|r| Some(r.1.time_s))),
    ("time_error_s", Get::Number(|r| Some(r.1.time_error_s))),
    ("drive_phase_rad", Get::Number(|r| r.1.drive_phase_rad)),
    (
        "closing_speed_before_m_s",
        Get::Number(|r| r.1.approach_speed_before_m_s),
    ),
    (
        "closing_speed_after_m_s",
        Get::Number(|r| r.1.approach_speed_after_m_s),
    ),
    ("speed_error_m_s", Get::Number(|r| r.1.speed_error_m_s())),
    ("velocity_x_before_m_s", Get::Number(|r| before(r.1.x))),
    ("velocity_x_after_m_s", Get::Number(|r| after(r.1.x))),
    ("velocity_y_before_m_s", Get::Number(|r| before(r.1.y))),
    ("velocity_y_after_m_s", Get::Number(|r| after(r.1.y))),
    ("dead_zone_s", Get::Number(|r| Some(r.1.dead_zone_s))),
    ("seen", Get::Text(|r| Some(r.1.source.name().to_owned()))),
];

/// Columns of boundaries.csv.
const BOUNDARIES: &[(&str, Get<Bracket>)] = &[
    ("kind", Get::Text(|b| Some(b.kind.name().to_owned()))),
    ("periods_n", Get::Count(|b| Some(b.periods_n as usize))),
    ("clearance_m", Get::Number(|b| Some(b.clearance_m))),
    ("drive_amplitude", Get::Number(|b| Some(b.drive_amplitude))),
    (
        "frequency_low_hz",
        Get::Number(|b| Some(b.frequency_low_hz)),
    ),
    (
        "frequency_high_hz",
        Get::Number(|b| Some(b.frequency_high_hz)),
    ),
    ("direction", Get::Text(|b| Some(b.sweep.name().to_owned()))),
    ("motion_before", Get::Text(|b| Some(b.from.clone()))),
    ("motion_after", Get::Text(|b| Some(b.to.clone()))),
    ("record_before", Get::Text(|b| Some(b.records[0].clone()))),
    ("record_after", Get::Text(|b| Some(b.records[1].clone()))),
];

/// Records whose rows are in memory at a time.
const RECORDS_AT_ONCE: usize = 4096;

/// records.parquet, impacts.parquet and boundaries.csv: names and bytes.
///
/// # Errors
/// If a table cannot be made.
pub fn files(observed: &Observed) -> Result<Vec<(&'static str, Vec<u8>)>, PipelineError> {
    let all = &observed.observations;
    let none = all.is_empty().then_some(&[][..]);
    let parts = || all.chunks(RECORDS_AT_ONCE).chain(none);
    let records = parts().map(|some| Table::of(some, RECORDS));
    let impacts = parts().map(|some| {
        let of = |o: &Observation| {
            let record = o.record.clone();
            o.impacts
                .iter()
                .map(move |i| (record.clone(), i.clone()))
                .collect::<Vec<_>>()
        };
        Table::of(&some.iter().flat_map(of).collect::<Vec<_>>(), IMPACTS)
    });
    let boundaries = Table::of(&observed.brackets, BOUNDARIES).csv();
    Ok(vec![
        parquet(RECORDS_FILE, records)?,
        parquet(IMPACTS_FILE, impacts)?,
        (BOUNDARIES_FILE, boundaries.into_bytes()),
    ])
}

const RECORDS_FILE: &str = "records.parquet";
const IMPACTS_FILE: &str = "impacts.parquet";
const BOUNDARIES_FILE: &str = "boundaries.csv";

/// Write what [`files`] gave: all appear, or none.
///
/// # Errors
/// If a file cannot be written.
pub fn write(files: &[(&str, Vec<u8>)], out: &Path) -> Result<(), PipelineError> {
    Ok(write_together(out, files)?)
}

fn parquet(
    name: &'static str,
    parts: impl Iterator<Item = Table>,
) -> Result<(&'static str, Vec<u8>), PipelineError> {
    let bytes = Table::parquet_of(parts).map_err(PipelineError::in_table(name))?;
    Ok((name, bytes))
}
