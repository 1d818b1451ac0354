//! Reading all records for their faults alone, a record at a time.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::diagnostic::{Code, Diagnostic, Place, Severity};
use super::discovery::Opener;
use super::resolved::{RecordEntry, ResolvedCampaign};
use impact_records::event::{DetectionSource, Impact};
use impact_records::motion::{Observation, observe};
use impact_records::record::calibrate;
use impact_records::record::{Flag, FlagCode, Problem, Record, Role};
use labfiles::Source;

/// What reading all records found.
#[derive(Debug, Default)]
pub struct Checked {
    /// One problem per flag.
    pub diagnostics: Vec<Diagnostic>,
    /// Records that can be used.
    pub usable: usize,
    /// Whether any of them shows what a method of identification uses: a drive, impacts with speeds, a decay.
    telling: bool,
    /// Impacts of the records that can be used.
    impacts: usize,
    /// What distinguishes each record from the others.
    fingerprints: Vec<Fingerprint>,
}

impl Checked {
    /// With what reading the records after these found.
    fn and(mut self, later: Self) -> Self {
        self.diagnostics.extend(later.diagnostics);
        self.usable += later.usable;
        self.telling |= later.telling;
        self.impacts += later.impacts;
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
    if all.usable > 0 && !all.telling {
        all.diagnostics.extend(stated_nothing(campaign));
    }
    if all.impacts == 1 {
        all.diagnostics.push(one_impact(campaign));
    }
    all.diagnostics.extend(no_clearance(campaign, all.impacts));
    all
}

/// That no record of a driven campaign with impacts states a clearance.
pub fn clearance_unstated(
    campaign: &ResolvedCampaign,
    observations: &[Observation],
) -> Option<Diagnostic> {
    let usable = observations.iter().filter(|o| !o.excluded());
    no_clearance(campaign, usable.map(|o| o.impacts.len()).sum())
}

fn no_clearance(campaign: &ResolvedCampaign, impacts: usize) -> Option<Diagnostic> {
    let mut driven = campaign
        .records
        .iter()
        .filter(|r| campaign.driven(r))
        .peekable();
    let unstated = driven.peek().is_some() && driven.all(|r| r.setting.clearance_m.is_none());
    (unstated && impacts > 0).then(|| {
        Diagnostic::new(
            (Code::Missing, Severity::Note),
            of_records(campaign),
            "no clearance is stated: R rests on the speeds at impacts alone, and neither waveforms nor boundaries tell of it",
            "write the clearances into a run table, column clearance_mm, or clearance in [records] if all records have one",
        )
    })
}

/// That a campaign states neither a drive nor free decays nor free flights, and its records show none of them.
pub fn nothing_stated(
    campaign: &ResolvedCampaign,
    observations: &[Observation],
) -> Option<Diagnostic> {
    let mut usable = observations.iter().filter(|o| !o.excluded()).peekable();
    let silent = usable.peek().is_some() && !usable.any(tells);
    silent.then(|| stated_nothing(campaign)).flatten()
}

/// The place of what all records have in common.
fn of_records(campaign: &ResolvedCampaign) -> Place {
    Place {
        file: campaign.file.clone(),
        item: "records".to_owned(),
        ..Place::default()
    }
}

/// That the records of a campaign show one impact.
fn one_impact(campaign: &ResolvedCampaign) -> Diagnostic {
    Diagnostic::new(
        (Code::Missing, Severity::Note),
        of_records(campaign),
        "one impact is all that the records show: R is that of this impact, as sure as its speeds or heights are; whether \
         R scatters from impact to impact, or depends on the speed, is not known",
        "record more impacts, at unlike speeds",
    )
}

/// Whether a record shows what a method of identification uses.
fn tells(observation: &Observation) -> bool {
    let speeds = |i: &Impact| i.approach_speed_before_m_s.is_some();
    observation.tone().is_some()
        || !observation.decays.is_empty()
        || observation.impacts.iter().any(speeds)
}

/// That a campaign whose records show nothing states neither a drive nor free decays nor free flights.
fn stated_nothing(campaign: &ResolvedCampaign) -> Option<Diagnostic> {
    let drive = campaign.channels.iter().any(|c| c.role == Role::Drive);
    let undriven = |r: &RecordEntry| campaign.driven(r) && r.setting.stated_frequency_hz.is_none();
    (!drive && campaign.records.iter().all(undriven)).then(|| {
        Diagnostic::new(
            (Code::Missing, Severity::Campaign),
            of_records(campaign),
            "neither a drive nor free decays nor free flights are stated: nothing can be identified",
            "write excitation = \"free_decay\" in [records] for decays after a blow or a release, flight = \
             \"constant_force\" in [campaign] for masses that fly freely between impacts, or name the drive in \
             [channels.drive]",
        )
    })
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
    let observed = observe(&record, campaign.about.machine, &detect, &classify);
    let telling = tells(&observed);
    let mut flags = observed.flags;
    if campaign.driven(entry) && !flags.iter().any(|f| f.excludes) {
        let supported = observed.impacts.iter();
        let supported = supported
            .filter(|i| i.source == DetectionSource::Both)
            .count();
        let unsupported = observed.unsupported_pulses;
        flags.extend(contact_without_jump(&record, unsupported, supported));
    }
    let diagnostics = flags
        .iter()
        .filter(|f| !LISTED.contains(&f.code))
        .map(|f| Diagnostic::of_flag(&entry.file, &record.id, f))
        .collect();
    let usable = usize::from(!flags.iter().any(|f| f.excludes));
    let impacts = usable * observed.impacts.len();
    let print = Fingerprint {
        hash: fingerprint(&record),
        samples: record.samples(),
        id: record.id,
        file: entry.file.clone(),
    };
    Checked {
        diagnostics,
        usable,
        telling,
        impacts,
        fingerprints: vec![print],
    }
}

/// A contact that closes again and again while no velocity changes is no contact of the masses.
fn contact_without_jump(record: &Record, unsupported: usize, supported: usize) -> Option<Flag> {
    let channel = record.channel(Role::Contact)?;
    (unsupported >= 3 && unsupported > 2 * supported).then(|| {
        let problem = Problem::ContactsWithoutJump {
            without: unsupported,
            with: supported,
        };
        Flag::new(Some(&channel.name), problem).excluding(false)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::resolve::load;

    /// What is found in a decay of 6 Hz with a little noise, under a line of `[records]`.
    fn found_in_decay(line: &str) -> Vec<Diagnostic> {
        let folder = tempfile::tempdir().unwrap();
        let row = |i: u32| {
            let t = f64::from(i) / 500.0;
            let w = std::f64::consts::TAU * 6.0;
            let noise = 1e-3 * (1.7 * f64::from(i * i % 1009)).sin();
            format!(
                "{t:.4},{:.6}\n",
                (-0.02 * w * t).exp() * (w * t).cos() + noise
            )
        };
        let rows: String = (0..2000).map(row).collect();
        std::fs::write(
            folder.path().join("r.csv"),
            format!("t (s),v (m/s)\n{rows}"),
        )
        .unwrap();
        let toml = folder.path().join("campaign.toml");
        let text = format!(
            "[campaign]\nmachine = \"single\"\n[records]\nfiles = \"r.csv\"\n{line}\n\
             [channels.velocity_x]\nchannel = \"v\"\n"
        );
        std::fs::write(&toml, text).unwrap();
        let campaign = load(&toml, &labfiles::open).campaign.unwrap();
        read_all(&campaign, &labfiles::open, &|_| {}).diagnostics
    }

    #[test]
    fn a_campaign_that_states_nothing_to_identify_from_is_refused() {
        let nothing = |all: &[Diagnostic]| {
            let mut of_campaign = all.iter().filter(|d| d.severity == Severity::Campaign);
            of_campaign
                .next()
                .map(|d| (d.message.clone(), d.remedy.clone()))
        };
        let (message, remedy) = nothing(&found_in_decay("")).unwrap();
        assert_eq!(
            message,
            "neither a drive nor free decays nor free flights are stated: nothing can be identified"
        );
        assert!(remedy.contains("excitation = \"free_decay\""), "{remedy}");
        for stated in ["excitation = \"free_decay\"", "drive_frequency = \"6 Hz\""] {
            assert_eq!(nothing(&found_in_decay(stated)), None, "{stated}");
        }
    }
}
