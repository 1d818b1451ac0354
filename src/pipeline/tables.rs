//! records.parquet, impacts.parquet and boundaries.csv: one table of columns each, with the
//! column's name (unit included) and how to get it.

use std::path::Path;

use polars::prelude::{Column, DataFrame};
use polars_io::parquet::write::ParquetWriter;

use crate::event::{Impact, MassSpeeds};
use crate::motion::{Bracket, Motion, Observation};
use crate::pipeline::{Observed, PipelineError};
use crate::record::Role;
use labfiles::output::write_bytes;

/// How a column's value is got from a row.
enum Get<T> {
    Text(fn(&T) -> Option<String>),
    Number(fn(&T) -> Option<f64>),
    Count(fn(&T) -> Option<u32>),
    Flag(fn(&T) -> Option<bool>),
}

fn column<T>(name: &str, rows: &[T], get: &Get<T>) -> Column {
    match get {
        Get::Text(f) => Column::new(name.into(), rows.iter().map(f).collect::<Vec<_>>()),
        Get::Number(f) => Column::new(name.into(), rows.iter().map(f).collect::<Vec<_>>()),
        Get::Count(f) => Column::new(name.into(), rows.iter().map(f).collect::<Vec<_>>()),
        Get::Flag(f) => Column::new(name.into(), rows.iter().map(f).collect::<Vec<_>>()),
    }
}

fn amplitude(o: &Observation, role: Role) -> Option<f64> {
    o.amplitudes
        .iter()
        .find(|a| a.role == role)
        .map(|a| a.half_range)
}

fn reason(o: &Observation) -> Option<String> {
    match &o.classification.motion {
        Motion::Undetermined { reason } => Some(reason.clone()),
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
    ("sequence", Get::Count(|o| Some(o.setting.sequence as u32))),
    ("frequency_hz", Get::Number(Observation::frequency_hz)),
    (
        "frequency_error_hz",
        Get::Number(|o| Some(o.drive?.frequency_error_hz)),
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
        Get::Count(|o| o.classification.impacts_and_periods().map(|p| p.0)),
    ),
    (
        "periods_n",
        Get::Count(|o| o.classification.impacts_and_periods().map(|p| p.1)),
    ),
    (
        "confidence",
        Get::Number(|o| Some(o.classification.confidence)),
    ),
    ("reason", Get::Text(reason)),
    ("impacts", Get::Count(|o| Some(o.impacts.len() as u32))),
    (
        "missed_contact_pulses",
        Get::Count(|o| Some(o.missed_pulses as u32)),
    ),
    (
        "contact_pulses_without_jump",
        Get::Count(|o| Some(o.unsupported_pulses as u32)),
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
        Get::Number(|o| Some(o.decay?.natural_frequency_hz)),
    ),
    (
        "decay_natural_frequency_error_hz",
        Get::Number(|o| Some(o.decay?.natural_frequency_error_hz)),
    ),
    (
        "decay_damping_ratio",
        Get::Number(|o| Some(o.decay?.damping_ratio)),
    ),
    (
        "decay_damping_ratio_error",
        Get::Number(|o| Some(o.decay?.damping_ratio_error)),
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
    ("speed_error_m_s", Get::Number(|r| r.1.speed_error_m_s)),
    ("velocity_x_before_m_s", Get::Number(|r| before(r.1.x))),
    ("velocity_x_after_m_s", Get::Number(|r| after(r.1.x))),
    ("velocity_y_before_m_s", Get::Number(|r| before(r.1.y))),
    ("velocity_y_after_m_s", Get::Number(|r| after(r.1.y))),
    ("dead_zone_s", Get::Number(|r| Some(r.1.dead_zone_s))),
    ("seen", Get::Text(|r| Some(r.1.source.name().to_owned()))),
];

fn frame<T>(
    table: &str,
    rows: &[T],
    columns: &[(&str, Get<T>)],
) -> Result<DataFrame, PipelineError> {
    let columns = columns
        .iter()
        .map(|(name, get)| column(name, rows, get))
        .collect();
    DataFrame::new(rows.len(), columns).map_err(|e| failed(table, &e))
}

fn failed(table: &str, error: &dyn std::fmt::Display) -> PipelineError {
    PipelineError::Table {
        table: table.to_owned(),
        reason: error.to_string(),
    }
}

fn write_parquet(out: &Path, name: &str, mut frame: DataFrame) -> Result<(), PipelineError> {
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes)
        .finish(&mut frame)
        .map_err(|e| failed(name, &e))?;
    Ok(write_bytes(&out.join(name), &bytes)?)
}

/// Write records.parquet, impacts.parquet and boundaries.csv.
///
/// # Errors
/// Where a file cannot be written.
pub fn write_all(observed: &Observed, out: &Path) -> Result<(), PipelineError> {
    let records = frame("records.parquet", &observed.observations, RECORDS)?;
    write_parquet(out, "records.parquet", records)?;
    let rows: Vec<ImpactRow> = observed
        .observations
        .iter()
        .flat_map(|o| o.impacts.iter().map(|i| (o.record.clone(), i.clone())))
        .collect();
    write_parquet(
        out,
        "impacts.parquet",
        frame("impacts.parquet", &rows, IMPACTS)?,
    )?;
    Ok(write_bytes(
        &out.join("boundaries.csv"),
        &boundaries(&observed.brackets)?,
    )?)
}

fn boundaries(brackets: &[Bracket]) -> Result<Vec<u8>, PipelineError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let error = |e: &dyn std::fmt::Display| failed("boundaries.csv", e);
    let header = [
        "kind",
        "periods_n",
        "clearance_m",
        "drive_amplitude",
        "frequency_low_hz",
        "frequency_high_hz",
        "direction",
        "motion_before",
        "motion_after",
        "record_before",
        "record_after",
    ];
    writer.write_record(header).map_err(|e| error(&e))?;
    for b in brackets {
        let row = [
            b.kind.name().to_owned(),
            b.periods_n.to_string(),
            b.clearance_m.to_string(),
            b.drive_amplitude.to_string(),
            b.frequency_low_hz.to_string(),
            b.frequency_high_hz.to_string(),
            b.sweep.name().to_owned(),
            b.from.clone(),
            b.to.clone(),
            b.records[0].clone(),
            b.records[1].clone(),
        ];
        writer.write_record(&row).map_err(|e| error(&e))?;
    }
    writer.into_inner().map_err(|e| error(&e))
}
