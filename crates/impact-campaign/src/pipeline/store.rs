//! The files that the stages exchange: the resolved campaign, the calibrated records, the
//! observations.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::pipeline::identify::{self, IdentificationFile};
use crate::pipeline::json::{read_json, store_error, write_json};
use crate::pipeline::observe::each_record;
pub use crate::pipeline::resolved_file::{read_resolved, write_resolved};
use crate::pipeline::{Observed, PipelineError, Progress, RefusedRecord, gzip_json};
use impact_identification::identify::residuals::MethodResiduals;
use impact_records::motion::{Folded, Observation, brackets};
use impact_records::record::calibrate::{
    ChannelKey, ChannelSetup, HEIGHTS_DIGIT, HEIGHTS_ERROR, StatedTimes, TIMES_CONTACT, TIMES_ERROR,
};
use impact_records::record::{ContactContent, Flag, Record, Role};
use labfiles::units::{Dimension, Quantity, Unit};
use labfiles_write::hdf5::{AttributeValue, CampaignWriter, ColumnToWrite, RecordTable};

const INGESTED: &str = "ingested.h5";
const INGESTED_CAMPAIGN: &str = "ingested.json";
const OBSERVATIONS: &str = "observations.json.gz";
const WAVEFORMS: &str = "waveforms.json.gz";
const RESIDUALS: &str = "residuals.json.gz";
/// What a run keeps for its report.
const KEPT: &str = "report_data.json.gz";

/// The calibrated campaign: records in SI in our own HDF5 files, with the flags of the calibration.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Ingested {
    campaign: ResolvedCampaign,
    flags: Vec<Vec<Flag>>,
}

/// Stage 1: read and calibrate every record and write it in SI; returns the number of usable records.
///
/// # Errors
/// If nothing is usable or the outputs cannot be written.
pub fn ingest(
    campaign: &ResolvedCampaign,
    out: &Path,
    progress: Progress<'_>,
) -> Result<usize, PipelineError> {
    let mut writer = IngestWriter::new(out);
    let total = campaign.records.len() as u64;
    each_record(campaign, |entry, record| {
        writer.add(entry, record)?;
        progress("ingest", writer.entries.len() as u64, total);
        Ok::<_, PipelineError>(())
    })?;
    let IngestWriter {
        roles,
        entries,
        flags,
        ..
    } = writer.finish()?;
    if entries.iter().all(|e| e.dataset.is_none()) {
        let refused = campaign.records.iter().zip(flags);
        let refused = refused.map(|(entry, flags)| RefusedRecord {
            file: entry.file.clone(),
            record: entry.id.clone(),
            flags,
        });
        return Err(PipelineError::NothingUsable(refused.collect()));
    }
    write_resolved(campaign, out)?;
    let ingested = Ingested {
        campaign: ResolvedCampaign {
            channels: roles,
            times: StatedTimes::default(),
            records: entries,
            ..campaign.clone()
        },
        flags,
    };
    let usable = ingested
        .flags
        .iter()
        .filter(|f| !f.iter().any(|f| f.excludes))
        .count();
    write_json(&out.join(INGESTED_CAMPAIGN), &ingested)?;
    Ok(usable)
}

/// Most records in one of our HDF5 files: that many are in memory at a time, for each thread.
pub(super) const RECORDS_A_FILE: usize = 1000;

/// Writes calibrated records, file by file.
struct IngestWriter<'a> {
    out: &'a Path,
    writer: CampaignWriter,
    file: std::path::PathBuf,
    /// Records in the current file.
    held: usize,
    files: usize,
    entries: Vec<RecordEntry>,
    flags: Vec<Vec<Flag>>,
    roles: Vec<ChannelSetup>,
}

impl<'a> IngestWriter<'a> {
    fn new(out: &'a Path) -> Self {
        let file = out.join(INGESTED);
        Self {
            out,
            writer: CampaignWriter::create(&file),
            file,
            held: 0,
            files: 1,
            entries: Vec::new(),
            flags: Vec::new(),
            roles: Vec::new(),
        }
    }

    fn add(&mut self, entry: &RecordEntry, record: Record) -> Result<(), PipelineError> {
        if self.held == RECORDS_A_FILE {
            self.next_file()?;
        }
        let kept = record.samples() > 0;
        self.entries.push(RecordEntry {
            file: self.file.clone(),
            dataset: kept.then_some(self.held),
            ..entry.clone()
        });
        if kept {
            note_roles(&mut self.roles, &record);
            self.writer.add(table(self.held, &record))?;
            self.held += 1;
        }
        self.flags.push(record.flags);
        Ok(())
    }

    /// Write the current file and begin another.
    fn next_file(&mut self) -> Result<(), PipelineError> {
        self.files += 1;
        self.file = self.out.join(format!("ingested_{}.h5", self.files));
        self.held = 0;
        let next = CampaignWriter::create(&self.file);
        Ok(std::mem::replace(&mut self.writer, next).finish()?)
    }

    fn finish(mut self) -> Result<Self, PipelineError> {
        self.next_file()?;
        Ok(self)
    }
}

/// A record as it is written: named by its place in the file, so that readers, which sort names,
/// keep the order of acquisition.
fn table(place: usize, record: &Record) -> RecordTable {
    RecordTable {
        name: format!("record{place:04}"),
        sample_rate_hz: Some(record.sample_rate_hz),
        channels: record
            .channels
            .iter()
            .map(|c| {
                ColumnToWrite::numbers(c.role.name(), c.dimension.si_symbol(), c.values.clone())
            })
            .collect(),
        attributes: table_attributes(record),
    }
}

fn table_attributes(record: &Record) -> Vec<(String, AttributeValue)> {
    let listed = record.listed;
    let known = [
        (TIMES_ERROR, listed.error_s),
        (TIMES_CONTACT, listed.contact_s),
        (HEIGHTS_DIGIT, listed.digit_m),
        (HEIGHTS_ERROR, listed.height_m),
    ];
    let known = known.into_iter().filter(|(_, value)| *value > 0.0);
    let known = known.map(|(key, value)| (key.to_owned(), value.into()));
    let named = ("record".to_owned(), record.id.as_str().into());
    std::iter::once(named).chain(known).collect()
}

/// Set-ups that read the calibrated channels without conversion.
fn note_roles(roles: &mut Vec<ChannelSetup>, record: &Record) {
    for channel in &record.channels {
        if roles.iter().any(|r| r.role == channel.role) {
            continue;
        }
        let key = ChannelKey::Name(channel.role.name().to_owned());
        roles.push(ChannelSetup {
            unit: Some(Unit {
                dimension: channel.dimension,
                to_si: 1.0,
            }),
            high_pass_hz: channel.high_pass_hz,
            low_pass: channel.low_pass,
            // the channel has been moved back already by its filter's delay
            delay_s: channel.low_pass.map_or(0.0, |filter| -filter.delay_s()),
            threshold: channel
                .threshold
                .map(|si| Quantity {
                    si,
                    dimension: channel.dimension,
                })
                .filter(|_| channel.role == Role::Contact),
            content: match (channel.role, channel.dimension) {
                (Role::Contact, Dimension::Time) => ContactContent::Times,
                (Role::Contact, Dimension::Length) => ContactContent::Heights,
                _ => ContactContent::Signal,
            },
            ..ChannelSetup::plain(channel.role, key)
        });
    }
}

/// Stage 2: observe the calibrated records and write the observations, which come back without
/// their waveforms.
///
/// # Errors
/// If the files of stage 1 are missing or the outputs cannot be written.
pub fn classify(out: &Path, progress: Progress<'_>) -> Result<Observed, PipelineError> {
    let ingested = read_ingested(out)?;
    let mut observed = Observed::of(&ingested.campaign, progress)?;
    // what was found in the record itself is first: it has the channels' own names
    for (observation, flags) in observed.observations.iter_mut().zip(ingested.flags) {
        let again = std::mem::replace(&mut observation.flags, flags);
        for flag in again {
            if !observation.flags.contains(&flag) {
                observation.flags.push(flag);
            }
        }
    }
    observed.brackets = brackets(&observed.observations);
    super::tables::write(&super::tables::files(&observed)?, out)?;
    write_observed(&mut observed, out)?;
    Ok(observed)
}

/// What stage 1 left in a folder, wherever the folder is now.
fn read_ingested(out: &Path) -> Result<Ingested, PipelineError> {
    let path = of_stage(out, INGESTED_CAMPAIGN, "calibrated records")?;
    let mut ingested: Ingested = read_json(&path)?;
    for entry in &mut ingested.campaign.records {
        let name = entry.file.file_name().unwrap_or_default();
        entry.file = out.join(name);
        if entry.dataset.is_some() && !entry.file.is_file() {
            return Err(store_error(&entry.file, "it is not there"));
        }
    }
    Ok(ingested)
}

/// Write the observations, and their waveforms, which the report does not need, into a file of their
/// own. While there are new waveforms there are no old observations; residuals of others, which state
/// their records by index, go with them.
fn write_observed(observed: &mut Observed, out: &Path) -> Result<(), PipelineError> {
    remove(&out.join(RESIDUALS))?;
    remove(&out.join(KEPT))?;
    let path = out.join(OBSERVATIONS);
    remove(&path)?;
    let each = observed.observations.iter();
    let waveforms: Vec<Option<&Folded>> = each.map(|o| o.folded.as_deref()).collect();
    gzip_json::write(&out.join(WAVEFORMS), &waveforms)?;
    observed.drop_waveforms();
    Ok(gzip_json::write(&path, &observed.observations)?)
}

/// Remove what stages and an earlier run have left for the report: it does not belong to what is written now.
///
/// # Errors
/// If it cannot be removed.
pub(super) fn forget(out: &Path) -> Result<(), PipelineError> {
    let names = [KEPT, OBSERVATIONS, WAVEFORMS, RESIDUALS];
    names.iter().try_for_each(|name| remove(&out.join(name)))
}

/// Keep what a report needs of a run beside its results: the observations, which have no waveforms any more, and
/// the residuals.
///
/// # Errors
/// If it cannot be written.
pub(super) fn keep(
    observed: &Observed,
    found: &IdentificationFile,
    out: &Path,
) -> Result<(), PipelineError> {
    let kept = (&observed.observations, &found.identification.residuals);
    Ok(gzip_json::write(&out.join(KEPT), &kept)?)
}

/// What a run kept in a folder, unless stages have been run there since.
fn kept(out: &Path) -> Result<Option<(Vec<Observation>, Vec<MethodResiduals>)>, PipelineError> {
    let path = out.join(KEPT);
    let staged = out.join(OBSERVATIONS).exists();
    if staged || !path.exists() {
        return Ok(None);
    }
    gzip_json::read(&path)
        .map(Some)
        .map_err(|e| store_error(&path, labfiles::said(&e)))
}

/// Whether a folder holds the calibrated records of stage 1.
pub fn is_staged(out: &Path) -> bool {
    out.join(INGESTED_CAMPAIGN).exists()
}

/// Remove a file that no longer holds, if it is there.
fn remove(path: &Path) -> Result<(), PipelineError> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(store_error(path, labfiles::said(&e)))
        }
        _ => Ok(()),
    }
}

/// A file of a previous stage.
///
/// # Errors
/// [`PipelineError::NoResults`] if it is missing from results of `impactid run`, which writes none.
fn of_stage(out: &Path, name: &str, what: &str) -> Result<PathBuf, PipelineError> {
    let path = out.join(name);
    if !path.exists() && out.join(identify::FILE).exists() {
        return Err(PipelineError::NoResults {
            path: out.display().to_string(),
            reason: format!("there are no {what}: `impactid run` does not keep them"),
            remedy:
                "run the stages ingest, classify, identify, report, or give `impactid run` the \
                     options of the report"
                    .to_owned(),
        });
    }
    Ok(path)
}

/// Stage 3: write identification.json, and the residuals, which the report needs, into a file of their
/// own. While there is a new identification there are no old residuals.
///
/// # Errors
/// If they cannot be written.
pub fn write_identified(found: &IdentificationFile, out: &Path) -> Result<(), PipelineError> {
    let path = out.join(RESIDUALS);
    remove(&path)?;
    identify::write(found, out)?;
    Ok(gzip_json::write(&path, &found.identification.residuals)?)
}

/// What a report is made of: from what a run kept for it, or from what stages 2 and 3 left.
///
/// # Errors
/// Where something of it is missing or unreadable.
pub fn read_for_report(out: &Path) -> Result<(Observed, IdentificationFile), PipelineError> {
    let (observations, residuals) = match kept(out)? {
        Some((observations, residuals)) => (observations, Some(residuals)),
        None => (staged_observations(out)?, None),
    };
    let mut found = read_identification(out)?;
    found.identification.residuals = match residuals {
        Some(residuals) => residuals,
        None => staged_residuals(out)?,
    };
    Ok((Observed::bracketed(observations), found))
}

/// The residuals of stage 3.
fn staged_residuals(out: &Path) -> Result<Vec<MethodResiduals>, PipelineError> {
    let is_missing = |name: &str| !out.join(name).exists();
    if is_missing(RESIDUALS) && !is_missing(OBSERVATIONS) {
        return Err(PipelineError::NoResults {
            path: out.display().to_string(),
            reason: "the records were classified after they were identified".to_owned(),
            remedy: "run impactid identify on the folder again".to_owned(),
        });
    }
    let path = of_stage(out, RESIDUALS, "residuals")?;
    gzip_json::read(&path).map_err(|e| store_error(&path, labfiles::said(&e)))
}

/// The identification of stage 3 or of a run, without the residuals.
///
/// # Errors
/// Where it is missing or unreadable.
pub fn read_identification(out: &Path) -> Result<IdentificationFile, PipelineError> {
    read_json(&out.join(identify::FILE))
}

/// The observations of stage 2.
///
/// # Errors
/// If they are missing or unreadable.
pub fn read_observed(out: &Path) -> Result<Observed, PipelineError> {
    let path = of_stage(out, WAVEFORMS, "waveforms")?;
    let mut observed = Observed::bracketed(staged_observations(out)?);
    let waveforms: Vec<Option<Folded>> =
        gzip_json::read(&path).map_err(|e| store_error(&path, labfiles::said(&e)))?;
    for (observation, folded) in observed.observations.iter_mut().zip(waveforms) {
        observation.folded = folded.map(Arc::new);
    }
    Ok(observed)
}

/// The observations of stage 2 without their waveforms.
fn staged_observations(out: &Path) -> Result<Vec<Observation>, PipelineError> {
    let path = of_stage(out, OBSERVATIONS, "observations")?;
    gzip_json::read(&path).map_err(|e| store_error(&path, labfiles::said(&e)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::Method;
    use impact_identification::identify::{Identification, Provenance};

    #[test]
    fn results_of_a_run_are_refused_with_the_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let store = |e: PipelineError| matches!(e, PipelineError::Store { .. });
        assert!(read_observed(folder.path()).is_err_and(store));
        std::fs::write(folder.path().join(identify::FILE), "{}").unwrap();
        let error = read_observed(folder.path()).err().unwrap();
        assert!(error.to_string().ends_with("does not keep them"), "{error}");
        assert!(
            error
                .remedy()
                .contains("ingest, classify, identify, report")
        );
    }

    #[test]
    fn new_observations_leave_no_residuals_of_others() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        let mut found = IdentificationFile {
            identification: Identification::default(),
            provenance: Provenance::default(),
        };
        found.identification.residuals = vec![MethodResiduals {
            method: Method::Impacts,
            residuals: vec![(7, 0.5)],
            total: 1,
            autocorrelation: vec![1.0],
        }];
        write_identified(&found, out).unwrap();
        let kept = staged_residuals(out).unwrap();
        assert_eq!(kept, found.identification.residuals);
        let mut none = Observed {
            observations: Vec::new(),
            brackets: Vec::new(),
        };
        write_observed(&mut none, out).unwrap();
        let error = staged_residuals(out).err().unwrap();
        assert!(error.to_string().contains("after they were identified"));
        assert!(error.remedy().contains("impactid identify"));
    }
}
