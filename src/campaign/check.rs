//! Reading all records for their faults alone, a record at a time.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::faults::{Fault, Severity};
use super::records::Opener;
use super::resolved::{RecordEntry, ResolvedCampaign};
use crate::record::calibrate;
use crate::record::source::Source;
use crate::record::{Flag, Record};

/// What reading all records found.
#[derive(Debug, Default)]
pub struct Checked {
    /// One fault a flag.
    pub faults: Vec<Fault>,
    /// Records that can be used.
    pub usable: usize,
}

/// Records of one file, in their order: a file is opened once for all of them.
pub fn by_file(records: &[RecordEntry]) -> Vec<&[RecordEntry]> {
    records.chunk_by(|a, b| a.file == b.file).collect()
}

/// Read every record of the campaign and list what is wrong with it. `done` is told the number
/// of records read so far.
pub fn read_all(
    campaign: &ResolvedCampaign,
    open: Opener<'_>,
    done: &(dyn Fn(u64) + Sync),
) -> Checked {
    let count = AtomicU64::new(0);
    let found: Vec<Checked> = by_file(&campaign.records)
        .into_par_iter()
        .map(|entries| {
            let checked = read_file(campaign, entries, open);
            done(count.fetch_add(entries.len() as u64, Ordering::Relaxed) + entries.len() as u64);
            checked
        })
        .collect();
    let mut all = Checked::default();
    for one in found {
        all.faults.extend(one.faults);
        all.usable += one.usable;
    }
    all
}

fn read_file(campaign: &ResolvedCampaign, entries: &[RecordEntry], open: Opener<'_>) -> Checked {
    // a file that cannot be opened was told when the records were listed
    let Ok(source) = open(&entries[0].file) else {
        return Checked::default();
    };
    let parts: Vec<Checked> = entries
        .par_iter()
        .filter(|e| e.dataset.is_some() && !e.excluded)
        .map(|entry| read_one(campaign, entry, source.as_ref()))
        .collect();
    let usable = parts.iter().map(|p| p.usable).sum();
    Checked { faults: parts.into_iter().flat_map(|p| p.faults).collect(), usable }
}

fn read_one(campaign: &ResolvedCampaign, entry: &RecordEntry, source: &dyn Source) -> Checked {
    let record = calibrate::calibrate(source, &campaign.setup_of(entry));
    let faults = record
        .flags
        .iter()
        .filter(|f| !LISTED.contains(&f.code.as_str()))
        .map(|f| fault_of(f, &record, &entry.file))
        .collect();
    Checked { faults, usable: usize::from(!record.excluded()) }
}

/// Codes that the listing of the records tells already.
const LISTED: [&str; 4] = ["missing_channel", "wrong_unit", "unit_missing", "unreadable_file"];

fn fault_of(flag: &Flag, record: &Record, file: &Path) -> Fault {
    Fault {
        file: file.to_path_buf(),
        line: None,
        key: match &flag.channel {
            Some(channel) => format!("{}: {channel}", record.id),
            None => record.id.clone(),
        },
        what: flag.message.clone(),
        remedy: flag.remedy.clone(),
        severity: if flag.excludes { Severity::Record } else { Severity::Note },
    }
}
