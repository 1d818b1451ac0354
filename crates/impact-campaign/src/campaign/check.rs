//! Reading all records for their faults alone, a record at a time.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::diagnostic::{Code, Diagnostic, Place, Severity};
use super::discovery::Opener;
use super::resolved::{RecordEntry, ResolvedCampaign};
use impact_records::event::DetectionSource;
use impact_records::motion::observe;
use impact_records::record::calibrate;
use impact_records::record::{Flag, FlagCode, Record, Role};
use labfiles::Source;

/// What reading all records found.
#[derive(Debug, Default)]
pub struct Checked {
    /// One problem per flag.
    pub diagnostics: Vec<Diagnostic>,
    /// Records that can be used.
    pub usable: usize,
    /// What distinguishes each record from the others.
    fingerprints: Vec<Fingerprint>,
}

impl Checked {
    /// With what reading the records after these found.
    fn and(mut self, later: Self) -> Self {
        self.diagnostics.extend(later.diagnostics);
        self.usable += later.usable;
        self.fingerprints.extend(later.fingerprints);
        self
    }
}

/// What distinguishes a record from others.
#[derive(Debug)]
struct Fingerprint {
    /// Hash of the samples; `None` where there are none.
    hash: Option<[u8; 32]>,
    samples: usize,
    id: String,
    file: PathBuf,
}

/// Records of one file, in their order: a file is opened once for all of them.
pub fn by_file(records: &[RecordEntry]) -> Vec<&[RecordEntry]> {
    records.chunk_by(|a, b| a.file == b.file).collect()
}

/// Read every record of the campaign and list what is wrong with it. `done` is called with the
/// number of records read so far.
pub fn read_all(
    campaign: &ResolvedCampaign,
    open: Opener<'_>,
    done: &(dyn Fn(u64) + Sync),
) -> Checked {
    let count = AtomicU64::new(0);
    let found = by_file(&campaign.records).into_par_iter().map(|entries| {
        let checked = read_file(campaign, entries, open);
        done(count.fetch_add(entries.len() as u64, Ordering::Relaxed) + entries.len() as u64);
        checked
    });
    let mut all = found.reduce(Checked::default, Checked::and);
    all.diagnostics.extend(duplicates(&all.fingerprints));
    let driven = campaign.records.iter().any(|r| campaign.driven(r));
    if driven {
        all.diagnostics.extend(short(&all.fingerprints));
    }
    all
}

fn read_file(campaign: &ResolvedCampaign, entries: &[RecordEntry], open: Opener<'_>) -> Checked {
    // a file that cannot be opened was reported when the records were listed
    let Ok(source) = open(&entries[0].file) else {
        return Checked::default();
    };
    let usable = |e: &&RecordEntry| e.dataset.is_some() && !e.excluded;
    let each = entries.par_iter().filter(usable);
    let each = each.map(|entry| read_one(campaign, entry, source.as_ref()));
    each.reduce(Checked::default, Checked::and)
}

fn read_one(campaign: &ResolvedCampaign, entry: &RecordEntry, source: &dyn Source) -> Checked {
    let record = calibrate::calibrate(source, &campaign.setup_of(entry));
    // What `run` would do with it: a record that it refuses is refused here, for the same reason.
    let (detect, classify) = (campaign.detect_settings(), campaign.classify_settings());
    let observed = observe(&record, campaign.machine, &detect, &classify);
    let mut flags = observed.flags;
    if campaign.driven(entry) && !flags.iter().any(|f| f.excludes) {
        let supported = observed.impacts.iter();
        let supported = supported
            .filter(|i| i.source == DetectionSource::Both)
            .count();
        let pulses = (observed.unsupported_pulses, supported);
        flags.extend(contact_without_jump(&record, pulses));
    }
    let diagnostics = flags
        .iter()
        .filter(|f| !LISTED.contains(&f.code))
        .map(|f| Diagnostic::of_flag(&entry.file, &record.id, f))
        .collect();
    let usable = usize::from(!flags.iter().any(|f| f.excludes));
    let print = Fingerprint {
        hash: fingerprint(&record),
        samples: record.samples(),
        id: record.id,
        file: entry.file.clone(),
    };
    Checked {
        diagnostics,
        usable,
        fingerprints: vec![print],
    }
}

/// A contact that closes again and again while no velocity changes is no contact of the masses.
fn contact_without_jump(record: &Record, (unsupported, supported): (usize, usize)) -> Option<Flag> {
    let channel = record.channel(Role::Contact)?;
    (unsupported >= 3 && unsupported > 2 * supported).then(|| {
        let message = format!(
            "the contact closes {unsupported} times without a jump of the velocity, {supported} times \
             with one"
        );
        let remedy = "fix threshold or channel in [channels.contact], or check whether the \
                      velocity channels belong to this record";
        Flag::new(
            FlagCode::ContactWithoutJump,
            Some(&channel.name),
            message,
            remedy,
        )
        .excluding(false)
    })
}

/// The samples in a number; records that share it are the same.
fn fingerprint(record: &Record) -> Option<[u8; 32]> {
    if record.samples() == 0 {
        return None;
    }
    let mut hash = Sha256::new();
    for channel in &record.channels {
        hash.update(channel.role.name().as_bytes());
        channel
            .values
            .iter()
            .for_each(|v| hash.update(v.to_le_bytes()));
    }
    Some(hash.finalize().into())
}

/// Records whose samples are in the campaign twice.
fn duplicates(fingerprints: &[Fingerprint]) -> Vec<Diagnostic> {
    let mut first: HashMap<[u8; 32], &str> = HashMap::new();
    let mut found = Vec::new();
    for print in fingerprints {
        let Some(hash) = print.hash else { continue };
        match first.get(&hash) {
            None => drop(first.insert(hash, &print.id)),
            Some(other) => found.push(Diagnostic::new(
                (Code::DuplicateRecord, Severity::Record),
                print.place(),
                format!("its samples are those of the record '{other}'"),
                "remove one of the two: a record counted twice makes intervals too narrow",
            )),
        }
    }
    found
}

/// Records much shorter than the usual one of a driven campaign: those that end when somebody stops
/// them are of any length.
fn short(fingerprints: &[Fingerprint]) -> Vec<Diagnostic> {
    let lengths = fingerprints.iter().map(|p| p.samples).filter(|n| *n > 0);
    let mut lengths: Vec<usize> = lengths.collect();
    lengths.sort_unstable();
    if lengths.len() < 3 {
        return Vec::new();
    }
    let usual = lengths[lengths.len() / 2];
    let short = |p: &&Fingerprint| p.samples > 0 && 10 * p.samples < 8 * usual;
    let diagnostic = |p: &Fingerprint| {
        Diagnostic::new(
            (Code::ShortRecord, Severity::Note),
            p.place(),
            format!("it holds {} samples, the usual record {usual}", p.samples),
            "nothing, if it was stopped early; else compare it with the laboratory book",
        )
    };
    fingerprints.iter().filter(short).map(diagnostic).collect()
}

impl Fingerprint {
    fn place(&self) -> Place {
        Place::of_record(&self.file, &self.id, "")
    }
}

/// Codes that the discovery of the records has reported already.
pub const LISTED: [FlagCode; 3] = [
    FlagCode::MissingChannel,
    FlagCode::WrongUnit,
    FlagCode::UnitMissing,
];
