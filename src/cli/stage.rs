//! The stages alone: `ingest`, `classify`, `identify`, `report`, each from what the one before
//! wrote.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;

use super::fail::rendered_fault;
use super::look::{Look, quoted};
use super::progress::Progress;
use super::run::say_report;
use super::voice::print;
use super::{Exit, Failure, Voice, interrupt};
use crate::campaign::faults::Severity;
use crate::campaign::load;
use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::{self, store};
use crate::report::words::Words;
use labfiles::open;
use labfiles::output::Lock;

/// Arguments of `impactid ingest`.
#[derive(Debug, Args)]
#[command(after_help = INGEST)]
pub struct Ingest {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Folder for the results; it is made where it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

const INGEST: &str = "\
Example:
  impactid ingest   campaign.toml --out results/
  impactid classify results/
  impactid identify results/
  impactid report   results/";

/// The folder that the stage before wrote into.
#[derive(Debug, Args)]
pub struct Folder {
    /// Folder that the stage before wrote into (or campaign.toml, with the folder as --out)
    #[arg(value_name = "DIR")]
    given: PathBuf,
    /// Folder that the stage before wrote into, where DIR names campaign.toml
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Folder {
    /// The results' folder, locked for this run.
    fn take(&self) -> Result<(PathBuf, Lock), Failure> {
        let folder = self.out.as_ref().unwrap_or(&self.given);
        if !folder.is_dir() {
            return Err(Failure::new(
                format!("{} is no folder with results", folder.display()),
                "name the folder that the stage before wrote into; the first stage is \
                 `impactid ingest campaign.toml --out DIR`",
            ));
        }
        let lock = Lock::take(folder)?;
        interrupt::watch(folder.clone());
        Ok((folder.clone(), lock))
    }
}

/// Arguments of `impactid classify`.
#[derive(Debug, Args)]
#[command(after_help = CLASSIFY)]
pub struct Classify {
    #[command(flatten)]
    folder: Folder,
}

const CLASSIFY: &str = "\
Example:
  impactid classify results/

It reads what `impactid ingest` left there and writes records.parquet, impacts.parquet and
boundaries.csv.";

/// Arguments of `impactid identify`.
#[derive(Debug, Args)]
#[command(after_help = IDENTIFY)]
pub struct Identify {
    #[command(flatten)]
    folder: Folder,
}

const IDENTIFY: &str = "\
Example:
  impactid identify results/

It reads what `impactid classify` left there and writes identification.json.
Exit codes: 0 done; 1 done, but the answer is \"does not fit\" or \"not identifiable\"; 2 bad input.";

/// Arguments of `impactid report`.
#[derive(Debug, Args)]
#[command(after_help = REPORT)]
pub struct Report {
    #[command(flatten)]
    folder: Option<Folder>,
    /// Print every phrase of a report as a table of words to be filled in, and do nothing else
    #[arg(long, exclusive = true)]
    list_words: bool,
    #[command(flatten)]
    look: Look,
}

const REPORT: &str = "\
Example:
  impactid report results/
  impactid report results/ --format html,png --template mine.typ
  impactid report --list-words > words.toml
  impactid report results/ --words words.toml

It reads what `impactid identify` left there and writes report.pdf and the figures' data.";

/// The commands that make a report in stages.
fn commands(campaign: &Path, folder: &Path, look: &Look) -> String {
    let (campaign, out) = (quoted(campaign), quoted(folder));
    format!(
        "impactid ingest {campaign} --out {out}\nimpactid classify {out}\n\
         impactid identify {out}\nimpactid report {out}{}",
        look.typed()
    )
}

impl Ingest {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let campaign = load_campaign(&self.campaign, voice)?;
        let _lock = Lock::take(&self.out)?;
        interrupt::watch(self.out.clone());
        let bar = Progress::new(voice, "ingest", campaign.records.len() as u64);
        let usable = store::ingest(&campaign, &self.out, &|_, done, total| bar.set(done, total))?;
        drop(bar);
        voice.say(&format!(
            "{usable} of {} records are usable.",
            campaign.records.len()
        ));
        Ok(Exit::Done)
    }
}

impl Classify {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let (folder, _lock) = self.folder.take()?;
        let bar = Progress::new(voice, "classify", 0);
        let observed = store::classify(&folder, &|_, done, total| bar.set(done, total))?;
        drop(bar);
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for observation in &observed.observations {
            *counts
                .entry(observation.classification.motion.label())
                .or_default() += 1;
        }
        for (motion, count) in counts {
            voice.say(&format!("{count:6}  {motion}"));
        }
        Ok(Exit::Done)
    }
}

impl Identify {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let (folder, _lock) = self.folder.take()?;
        let campaign = store::read_resolved(&folder)?;
        let observed = store::read_observed(&folder)?;
        let found = pipeline::identify::identify(&campaign, &observed)?;
        pipeline::identify::write(&found, &folder)?;
        let verdict = &found.identification.verdict;
        voice.say(&verdict.to_string());
        Ok(Exit::of(verdict.kind))
    }
}

impl Report {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let Some(folder) = self.folder.filter(|_| !self.list_words) else {
            print(&Words::blank())?;
            return Ok(Exit::Done);
        };
        let (folder, _lock) = folder.take()?;
        let mut campaign = store::read_resolved(&folder)?;
        self.look.apply(&mut campaign.report, voice)?;
        let observed = store::read_observed(&folder)?;
        let found = store::read_identification(&folder)?;
        let command = commands(&campaign.file, &folder, &self.look);
        let report = pipeline::report::files(&campaign, &observed, &found, &command)?;
        pipeline::report::write(&report, &folder)?;
        say_report(&campaign, &folder, voice);
        Ok(Exit::Done)
    }
}

/// The resolved campaign; faults that stop it are an error, the others are said.
pub fn load_campaign(path: &Path, voice: Voice) -> Result<ResolvedCampaign, Failure> {
    let outcome = load(path, &open);
    let Some(campaign) = outcome.campaign else {
        return Err(outcome.faults.into());
    };
    for fault in &outcome.faults.0 {
        if fault.severity == Severity::Record && !voice.is_quiet() {
            eprint!("{}", rendered_fault(fault));
        }
    }
    Ok(campaign)
}
