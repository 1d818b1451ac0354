//! Observations that are kept while records arrive, so that each record is observed once.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::ledger::Stamp;
use crate::campaign::resolved::{RecordEntry, ResolvedCampaign};
use crate::pipeline::observe;
use impact_records::motion::Observation;
use impact_records::record::Record;

/// Which record: its file, its dataset, and its name in the campaign.
type Key = (PathBuf, Option<usize>, String);

fn key(entry: &RecordEntry) -> Key {
    (entry.file.clone(), entry.dataset, entry.id.clone())
}

/// Observations by record.
#[derive(Debug, Default)]
pub(super) struct Kept {
    /// What of the campaign they depend on.
    settings: String,
    records: HashMap<Key, One>,
}

/// One record.
#[derive(Debug)]
struct One {
    /// Its file when it was observed.
    stamp: Option<Stamp>,
    /// As it was listed; its place in the order does not count.
    entry: RecordEntry,
    /// Its samples, where its file holds others too.
    samples: Option<[u8; 32]>,
    observation: Observation,
}

impl Kept {
    /// Observe the records of a campaign that are not kept, and forget those that it no longer has;
    /// `stamp` identifies the state of a file. A record whose samples are still the same, in a file that has grown,
    /// is not observed again. Returns how many were observed.
    pub(super) fn observe(
        &mut self,
        campaign: &ResolvedCampaign,
        stamp: impl Fn(&Path) -> Option<Stamp>,
    ) -> usize {
        let settings = settings(campaign);
        if settings != self.settings {
            self.records.clear();
            self.settings = settings;
        }
        let mut stamps: HashMap<&Path, Option<Stamp>> = HashMap::new();
        let mut sizes: HashMap<&Path, usize> = HashMap::new();
        for entry in &campaign.records {
            stamps
                .entry(&entry.file)
                .or_insert_with(|| stamp(&entry.file));
            *sizes.entry(&entry.file).or_default() += 1;
        }
        let new = campaign.records.iter();
        let new = new.filter(|entry| !self.has(entry, stamps[entry.file.as_path()]));
        let new: Vec<RecordEntry> = new.cloned().collect();
        let found = observe::each_of(campaign, &new, |entry, record| {
            let samples = (sizes[entry.file.as_path()] > 1).then(|| fingerprint(&record));
            let known = samples.and_then(|s| self.with_samples(entry, s));
            let was_known = known.is_some();
            let observation = known.unwrap_or_else(|| observe::observe_record(campaign, &record));
            (samples, observation, was_known)
        });
        campaign.sources.close();
        let mut observed = 0;
        for (entry, (samples, observation, was_known)) in new.into_iter().zip(found) {
            observed += usize::from(!was_known);
            let one = One {
                stamp: stamps[entry.file.as_path()],
                samples,
                observation,
                entry: out_of_order(&entry),
            };
            self.records.insert(key(&entry), one);
        }
        let named: HashSet<Key> = campaign.records.iter().map(key).collect();
        self.records.retain(|key, _| named.contains(key));
        observed
    }

    fn one(&self, entry: &RecordEntry) -> Option<&One> {
        self.records.get(&key(entry))
    }

    fn has(&self, entry: &RecordEntry, stamp: Option<Stamp>) -> bool {
        let same = |one: &One| one.stamp == stamp && one.entry == out_of_order(entry);
        stamp.is_some() && self.one(entry).is_some_and(same)
    }

    fn with_samples(&self, entry: &RecordEntry, samples: [u8; 32]) -> Option<Observation> {
        let one = self.one(entry)?;
        let same = one.samples == Some(samples) && one.entry == out_of_order(entry);
        same.then(|| one.observation.clone())
    }

    /// The observations of a campaign, each record of which was observed, in its order and as a run
    /// would have them.
    pub(super) fn observations(&self, campaign: &ResolvedCampaign) -> Vec<Observation> {
        let in_order = campaign.records.iter().filter_map(|entry| {
            let mut observation = self.one(entry)?.observation.clone();
            observation.setting.sequence = entry.setting.sequence;
            if !observe::keeps_waveform(campaign, entry) {
                observation.folded = None;
            }
            Some(observation)
        });
        in_order.collect()
    }

    /// As [`Self::observations`], without impacts and waveforms: what the map shows.
    pub(super) fn outlines(&self, campaign: &ResolvedCampaign) -> Vec<Observation> {
        let in_order = campaign.records.iter().filter_map(|entry| {
            let mut outline = self.one(entry)?.observation.outline();
            outline.setting.sequence = entry.setting.sequence;
            Some(outline)
        });
        in_order.collect()
    }
}

/// An entry without its place in the order, which changes when others arrive before it.
fn out_of_order(entry: &RecordEntry) -> RecordEntry {
    let mut entry = entry.clone();
    entry.setting.sequence = 0;
    entry
}

/// A hash of all samples of a record and of what was noted when it was read.
fn fingerprint(record: &Record) -> [u8; 32] {
    let mut hash = Sha256::new();
    hash.update(format!("{} {:?}", record.sample_rate_hz, record.flags));
    for channel in &record.channels {
        hash.update(format!("{} {:?}", channel.name, channel.high_pass_hz));
        let bytes: Vec<u8> = channel
            .values
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        hash.update(&bytes);
    }
    hash.finalize().into()
}

/// Everything of a campaign but its records that observations depend on, or may depend on.
fn settings(campaign: &ResolvedCampaign) -> String {
    let ResolvedCampaign {
        about,
        rig,
        channels,
        times,
        analysis,
        file: _,
        run_table: _,
        records: _,
        report: _,
        published: _,
        sources: _,
    } = campaign;
    let about = about.observed();
    format!("{about:?} {rig:?} {channels:?} {times:?} {analysis:?}")
}
