//! Reading and observing all records, file by file, in parallel; samples are let go at once.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::campaign::check::by_file;
use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::event::detect::DetectSettings;
use crate::motion::{ClassifySettings, Observation, observe};
use crate::pipeline::Progress;
use crate::record::calibrate::{calibrate, unreadable};
use crate::record::open::open;
use crate::record::source::Source;
use crate::record::{Flag, Record};

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
    let parts: Vec<Vec<Observation>> = by_file(&campaign.records)
        .into_par_iter()
        .map(|entries| {
            each_record(campaign, entries, |record| {
                let observation = observe(
                    &record,
                    campaign.machine,
                    &DetectSettings::default(),
                    &classify_settings(campaign),
                );
                progress("observe", done.fetch_add(1, Ordering::Relaxed) + 1, total);
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
