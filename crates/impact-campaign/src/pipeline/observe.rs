//! Reading and observing all records, file by file, in parallel; samples are dropped at once.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::campaign::check::by_file;
use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::pipeline::Progress;
use crate::pipeline::block_cache::BlockCache;
use impact_records::motion::{Observation, observe};
use impact_records::record::calibrate::{calibrate, unreadable};
use impact_records::record::{Flag, Problem, Record};
use labfiles::Source;
use labfiles_write::output::OutputError;

/// Most records of a campaign whose folded waveforms are kept. Of more records those of every
/// second, third … are kept, so that memory does not grow with them: thousands of waveforms
/// determine the parameters as well as all of them.
const MOST_WAVEFORMS: usize = 4_000;

/// Records read ahead of the one that is processed.
const READ_AHEAD: usize = 256;

/// Observe every record, in the order of the campaign, in chunks of `chunk` records; those that are kept
/// are loaded, the others are saved.
///
/// # Errors
/// If a chunk cannot be written.
pub fn observe_in_chunks(
    campaign: &ResolvedCampaign,
    kept: &BlockCache,
    chunk: usize,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let total = campaign.records.len() as u64;
    let done = AtomicU64::new(0);
    let mut all = Vec::with_capacity(campaign.records.len());
    for (number, entries) in campaign.records.chunks(chunk.max(1)).enumerate() {
        let name = format!("{number:06}");
        let chunk: Option<Vec<Observation>> = kept.load(&name);
        if let Some(chunk) = chunk.filter(|chunk| chunk.len() == entries.len()) {
            done.fetch_add(entries.len() as u64, Ordering::Relaxed);
            all.extend(chunk);
            continue;
        }
        let observed = observe_some(campaign, entries, &|| {
            progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        });
        kept.save(&name, &observed)?;
        all.extend(observed);
    }
    Ok(all)
}

/// Observe some records, file by file; `each` is called after each.
fn observe_some(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    each: &(dyn Fn() + Sync),
) -> Vec<Observation> {
    each_of(campaign, entries, |entry, record| {
        let mut observation = observe_record(campaign, &record);
        if !keeps_waveform(campaign, entry) {
            observation.folded = None;
        }
        each();
        observation
    })
}

/// Observe one record that was read.
pub(super) fn observe_record(campaign: &ResolvedCampaign, record: &Record) -> Observation {
    let (detect, settings) = (campaign.detect_settings(), campaign.classify_settings());
    observe(record, campaign.about.machine, &detect, &settings)
}

/// Whether the folded waveform of a record is kept.
pub(super) fn keeps_waveform(campaign: &ResolvedCampaign, entry: &RecordEntry) -> bool {
    let stride = campaign.records.len().div_ceil(MOST_WAVEFORMS).max(1);
    entry.setting.sequence.is_multiple_of(stride)
}

/// Read some records of a campaign and call `act` on each, in parallel; the results are in their order.
pub(super) fn each_of<T: Send>(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    act: impl Fn(&RecordEntry, Record) -> T + Sync,
) -> Vec<T> {
    let parts: Vec<Vec<T>> = by_file(entries)
        .into_par_iter()
        .map(|entries| records_of(campaign, entries, &act))
        .collect();
    parts.into_iter().flatten().collect()
}

/// Call `act` on every record in turn; they are read in parallel, a few hundred at a time.
///
/// # Errors
/// Those of `act`.
pub fn each_record<E>(
    campaign: &ResolvedCampaign,
    mut act: impl FnMut(&RecordEntry, Record) -> Result<(), E>,
) -> Result<(), E> {
    for group in by_file(&campaign.records) {
        for entries in group.chunks(READ_AHEAD) {
            let records = records_of(campaign, entries, |_, record| record);
            for (entry, record) in entries.iter().zip(records) {
                act(entry, record)?;
            }
        }
    }
    Ok(())
}

fn records_of<T: Send>(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    act: impl Fn(&RecordEntry, Record) -> T + Sync,
) -> Vec<T> {
    let Some(first) = entries.first() else {
        return Vec::new();
    };
    let source = campaign.sources.open(&first.file);
    entries
        .par_iter()
        .map(|entry| {
            let record = match &source {
                Ok(source) => read(campaign, entry, source.as_ref()),
                Err(error) => unreadable(&entry.id, &entry.setting, error),
            };
            act(entry, record)
        })
        .collect()
}

/// Read one record from its open file.
fn read(campaign: &ResolvedCampaign, entry: &RecordEntry, source: &dyn Source) -> Record {
    let mut record = calibrate(source, &campaign.setup_of(entry));
    if entry.excluded {
        let flag = Flag::new(None, Problem::ExcludedByCampaign);
        record.flags.push(flag);
    }
    record
}

/// Read one record by its entry.
pub fn read_one(campaign: &ResolvedCampaign, entry: &RecordEntry) -> Record {
    match campaign.sources.open(&entry.file) {
        Ok(source) => read(campaign, entry, source.as_ref()),
        Err(error) => unreadable(&entry.id, &entry.setting, &error),
    }
}
