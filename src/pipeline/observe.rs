//! Reading and observing all records, file by file, in parallel; samples are dropped at once.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use rayon::prelude::*;

use crate::campaign::check::by_file;
use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::motion::{Observation, observe};
use crate::pipeline::Progress;
use crate::pipeline::checkpoint::Checkpoint;
use crate::record::calibrate::{calibrate, unreadable};
use crate::record::{Flag, FlagCode, Record};
use labfiles::open;
use labfiles::output::OutputError;
use labfiles::{ReadError, Source};

/// Most records of a campaign whose folded waveforms are kept. Of more records those of every
/// second, third … are kept, so that memory does not grow with them: thousands of waveforms
/// determine the parameters as well as all of them.
const MOST_WAVEFORMS: usize = 4_000;

/// Records read ahead of the one that is processed.
const READ_AHEAD: usize = 256;

/// Observe every record, in the order of the campaign.
pub fn observe_all(campaign: &ResolvedCampaign, progress: Progress<'_>) -> Vec<Observation> {
    let total = campaign.records.len() as u64;
    let done = AtomicU64::new(0);
    observe_some(
        campaign,
        &campaign.records,
        &SourceCache::default(),
        &|| {
            progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        },
    )
}

/// Observe every record in chunks of `chunk` records; chunks in the checkpoint are loaded, the others
/// are saved there.
///
/// # Errors
/// If a chunk cannot be written.
pub fn observe_in_chunks(
    campaign: &ResolvedCampaign,
    checkpoint: &Checkpoint,
    chunk: usize,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let total = campaign.records.len() as u64;
    let done = AtomicU64::new(0);
    let cache = SourceCache::default();
    let mut all = Vec::with_capacity(campaign.records.len());
    for (number, entries) in campaign.records.chunks(chunk.max(1)).enumerate() {
        if let Some(kept) = checkpoint.load(number, entries.len()) {
            done.fetch_add(entries.len() as u64, Ordering::Relaxed);
            all.extend(kept);
            continue;
        }
        let observed = observe_some(campaign, entries, &cache, &|| {
            progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        });
        checkpoint.save(number, &observed)?;
        all.extend(observed);
    }
    Ok(all)
}

/// The file that was opened last, so that the next records need not open it again.
#[derive(Default)]
pub struct SourceCache(Mutex<Option<Arc<dyn Source>>>);

impl SourceCache {
    /// With the file of a campaign's first record, which usually holds all of them; one that cannot be
    /// opened is named where a record is read.
    pub fn of(campaign: &ResolvedCampaign) -> Self {
        let cache = Self::default();
        if let Some(first) = campaign.records.first() {
            let _ = cache.open(&first.file);
        }
        cache
    }

    /// The file, opened unless it was the last one.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn open(&self, path: &Path) -> Result<Arc<dyn Source>, ReadError> {
        let held = self.0.lock().ok().and_then(|held| held.clone());
        if let Some(source) = held.filter(|s| s.path() == path) {
            return Ok(source);
        }
        let source: Arc<dyn Source> = Arc::from(open(path)?);
        if let Ok(mut held) = self.0.lock() {
            *held = Some(Arc::clone(&source));
        }
        Ok(source)
    }
}

/// Observe some records, file by file; `each` is called after each.
fn observe_some(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    cache: &SourceCache,
    each: &(dyn Fn() + Sync),
) -> Vec<Observation> {
    each_cached(campaign, entries, cache, |entry, record| {
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
    observe(record, campaign.machine, &detect, &settings)
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
    each_cached(campaign, entries, &SourceCache::default(), act)
}

fn each_cached<T: Send>(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    cache: &SourceCache,
    act: impl Fn(&RecordEntry, Record) -> T + Sync,
) -> Vec<T> {
    let parts: Vec<Vec<T>> = by_file(entries)
        .into_par_iter()
        .map(|entries| records_of(campaign, entries, cache, &act))
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
    let cache = SourceCache::default();
    for group in by_file(&campaign.records) {
        for entries in group.chunks(READ_AHEAD) {
            let records = records_of(campaign, entries, &cache, |_, record| record);
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
    cache: &SourceCache,
    act: impl Fn(&RecordEntry, Record) -> T + Sync,
) -> Vec<T> {
    let Some(first) = entries.first() else {
        return Vec::new();
    };
    let source = cache.open(&first.file);
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
        record.flags.push(Flag::new(
            FlagCode::Excluded,
            None,
            "campaign.toml excludes this record",
            "remove it from `exclude` in [analysis] to use it",
        ));
    }
    record
}

/// Read one record by its entry.
pub fn read_one(campaign: &ResolvedCampaign, entry: &RecordEntry, cache: &SourceCache) -> Record {
    match cache.open(&entry.file) {
        Ok(source) => read(campaign, entry, source.as_ref()),
        Err(error) => unreadable(&entry.id, &entry.setting, &error),
    }
}
