//! Reading and observing all records, file by file, in parallel; samples are let go at once.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::campaign::check::by_file;
use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::event::detect::DetectSettings;
use crate::motion::{ClassifySettings, Observation, observe};
use crate::output::OutputError;
use crate::pipeline::Progress;
use crate::pipeline::checkpoint::Checkpoint;
use crate::record::calibrate::{calibrate, unreadable};
use crate::record::open::open;
use crate::record::source::Source;
use crate::record::{Flag, Record};

/// Settings of the detection as the campaign has them.
fn detect_settings(campaign: &ResolvedCampaign) -> DetectSettings {
    DetectSettings {
        flight: campaign.flight,
        ..DetectSettings::default()
    }
}

/// Settings of the classification as the campaign has them.
fn classify_settings(campaign: &ResolvedCampaign) -> ClassifySettings {
    ClassifySettings {
        most_periods: campaign.analysis.longest_period_n,
        ..ClassifySettings::default()
    }
}

/// Observe every record, in the order of the campaign.
pub fn observe_all(campaign: &ResolvedCampaign, progress: Progress) -> Vec<Observation> {
    let total = campaign.records.len() as u64;
    let done = AtomicU64::new(0);
    observe_some(campaign, &campaign.records, &|| {
        progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
    })
}

/// Observe every record in chunks of so many; a chunk that an earlier run kept is taken over,
/// another is kept when it is done.
///
/// # Errors
/// Where a chunk cannot be written.
pub fn observe_in_chunks(
    campaign: &ResolvedCampaign,
    checkpoint: &Checkpoint,
    chunk: usize,
    progress: Progress,
) -> Result<Vec<Observation>, OutputError> {
    let total = campaign.records.len() as u64;
    let done = AtomicU64::new(0);
    let mut all = Vec::with_capacity(campaign.records.len());
    for (number, entries) in campaign.records.chunks(chunk.max(1)).enumerate() {
        if let Some(kept) = checkpoint.load(number, entries.len()) {
            let count = entries.len() as u64;
            progress(
                "observe",
                done.fetch_add(count, Ordering::Relaxed) + count,
                total,
            );
            all.extend(kept);
            continue;
        }
        let observed = observe_some(campaign, entries, &|| {
            progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
        });
        checkpoint.save(number, &observed)?;
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
    let settings = classify_settings(campaign);
    let parts: Vec<Vec<Observation>> = by_file(entries)
        .into_par_iter()
        .map(|entries| {
            each_record(campaign, entries, |record| {
                let detect = detect_settings(campaign);
                let observation = observe(&record, campaign.machine, &detect, &settings);
                each();
                observation
            })
        })
        .collect();
    parts.into_iter().flatten().collect()
}

/// Do something with every record of one file, which is opened once.
pub fn each_record<T: Send>(
    campaign: &ResolvedCampaign,
    entries: &[RecordEntry],
    act: impl Fn(Record) -> T + Sync,
) -> Vec<T> {
    let Some(first) = entries.first() else {
        return Vec::new();
    };
    let source = open(&first.file);
    entries
        .par_iter()
        .map(|entry| {
            let record = match &source {
                Ok(source) => read(campaign, entry, source.as_ref()),
                Err(error) => unreadable(&entry.id, &entry.setting, error),
            };
            act(record)
        })
        .collect()
}

/// Read one record from its open file.
fn read(campaign: &ResolvedCampaign, entry: &RecordEntry, source: &dyn Source) -> Record {
    let mut record = calibrate(source, &campaign.setup_of(entry));
    if entry.excluded {
        record.flags.push(Flag {
            code: "excluded".into(),
            channel: None,
            message: "campaign.toml leaves this record out".into(),
            remedy: "remove it from `exclude` in [analysis] to use it".into(),
            excludes: true,
        });
    }
    record
}

/// Read one record by its entry.
pub fn read_one(campaign: &ResolvedCampaign, entry: &RecordEntry) -> Record {
    match open(&entry.file) {
        Ok(source) => read(campaign, entry, source.as_ref()),
        Err(error) => unreadable(&entry.id, &entry.setting, &error),
    }
}
