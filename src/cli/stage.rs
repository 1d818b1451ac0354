//! The single stages: `ingest`, `classify`, `identify`, `report`; each reads what the one before
//! wrote.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use clap::Args;

use super::details::{print_fits, print_records};
use super::left_out::print_left_out;
use super::load::load_campaign;
use super::premises::print_premises;
use super::progress::Progress;
use super::report_args::{ReportArgs, print_report_paths, quoted};
use super::run_one::{command_line, print_verdict};
use super::speech::Speech;
use super::stdout::{print, print_json_file};
use super::{Exit, Failure, Verbosity, interrupt, out_folder};
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_campaign::pipeline::resolved_file::read_resolved;
use impact_campaign::pipeline::{self, store};
use impact_report::catalog::Catalog;
use labfiles_write::output::Lock;

/// Arguments of `impactid ingest`.
#[derive(Debug, Args)]
#[command(after_help = INGEST)]
pub(super) struct Ingest {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Folder for the results; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

const INGEST: &str = "\
Example:
  impactid ingest   campaign.toml --out results/
  impactid classify results/
  impactid identify results/
  impactid report   results/";

/// The folder of the previous stage.
#[derive(Debug, Args)]
pub(super) struct Folder {
    /// Folder of the previous stage (or campaign.toml, with the folder as --out)
    #[arg(value_name = "DIR")]
    given: PathBuf,
    /// Folder of the previous stage, if DIR names campaign.toml
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Folder {
    /// The results' folder, locked for this run.
    fn take(&self) -> Result<(PathBuf, Lock), Failure> {
        let folder = self.out.as_ref().unwrap_or(&self.given);
        let elsewhere = self.out.as_ref().filter(|out| **out != self.given);
        if let Some(out) = elsewhere.filter(|_| read_resolved(&self.given).is_ok()) {
            let given = self.given.display();
            return Err(Failure::new(
                format!(
                    "{given} has the results, and {} is named beside it with --out",
                    out.display()
                ),
                format!(
                    "leave --out out: what is made goes into {given}, and can be copied from there"
                ),
            ));
        }
        if !folder.is_dir() {
            return Err(Failure::new(
                format!("{} is not a folder with results", folder.display()),
                "name the folder of the previous stage; the first stage is \
                 `impactid ingest campaign.toml --out DIR`",
            ));
        }
        if folder.join("campaign.toml").exists() && read_resolved(folder).is_err() {
            return Err(Failure::new(
                format!(
                    "{} is the folder of a campaign, not one with results",
                    folder.display()
                ),
                "name the folder that `impactid run` or `impactid ingest` wrote with --out",
            ));
        }
        let lock = interrupt::lock(folder)?;
        Ok((folder.clone(), lock))
    }
}

/// Arguments of `impactid classify`.
#[derive(Debug, Args)]
#[command(after_help = CLASSIFY)]
pub(super) struct Classify {
    #[command(flatten)]
    folder: Folder,
}

const CLASSIFY: &str = "\
Example:
  impactid classify results/

It reads the output of `impactid ingest` there and writes records.parquet, impacts.parquet and \
boundaries.csv. With -vv it lists the classification of each record.";

/// Arguments of `impactid identify`.
#[derive(Debug, Args)]
#[command(after_help = IDENTIFY)]
pub(super) struct Identify {
    #[command(flatten)]
    folder: Folder,
    /// Print identification.json too
    #[arg(long)]
    json: bool,
}

const IDENTIFY: &str = "\
Example:
  impactid identify results/

It reads the output of `impactid classify` there and writes identification.json.
Exit codes: 0 success; 1 the model does not fit or a parameter is not identifiable; 2 bad \
input.";

/// Arguments of `impactid report`.
#[derive(Debug, Args)]
#[command(after_help = REPORT)]
pub(super) struct Report {
    #[command(flatten)]
    folder: Option<Folder>,
    /// Print every phrase of a report as a table to translate, and exit
    #[arg(long, exclusive = true)]
    list_words: bool,
    #[command(flatten)]
    options: ReportArgs,
}

const REPORT: &str = "\
Example:
  impactid report results/
  impactid report results/ --format html,png --template mine.typ
  impactid report --list-words > words.toml
  impactid report results/ --words words.toml

It reads the output of `impactid identify` or of `impactid run` there and writes the formats asked for \
and the data of the figures.";

/// The commands that make a report in stages.
fn commands(campaign: &Path, folder: &Path, options: &ReportArgs) -> String {
    let (campaign, out) = (quoted(campaign), quoted(folder));
    format!(
        "impactid ingest {campaign} --out {out}\nimpactid classify {out}\n\
         impactid identify {out}\nimpactid report {out}{}",
        options.typed()
    )
}

impl Ingest {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let campaign = load_campaign(&self.campaign, verbosity)?;
        let _lock = out_folder::take_for(&self.out, &campaign)?;
        let bar = Progress::new(verbosity, "ingest", campaign.records.len() as u64);
        let usable = store::ingest(&campaign, &self.out, &|_, done, total| bar.set(done, total))?;
        drop(bar);
        verbosity.info(&format!(
            "{usable} of {} records are usable.",
            campaign.records.len()
        ));
        Ok(Exit::Done)
    }
}

impl Classify {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let (folder, _lock) = self.folder.take()?;
        let bar = Progress::new(verbosity, "classify", 0);
        let observed = store::classify(&folder, &|_, done, total| bar.set(done, total))?;
        drop(bar);
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for observation in &observed.observations {
            *counts
                .entry(observation.classification.motion.label())
                .or_default() += 1;
        }
        print_records(&observed.observations, verbosity);
        for (motion, count) in counts {
            verbosity.info(&format!("{count:6}  {motion}"));
        }
        Ok(Exit::Done)
    }
}

impl Identify {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let (folder, _lock) = self.folder.take()?;
        let campaign = store::read_resolved(&folder)?;
        let observed = store::read_observed(&folder)?;
        let bar = Progress::new(verbosity, "identify", 1);
        let found = pipeline::identify::identify(&campaign, &observed, Some(bar.fits()))?;
        store::write_identified(&found, &folder)?;
        drop(bar);
        let speech = Speech::of(&campaign.report)?;
        print_premises(&campaign, &observed.observations, &speech, verbosity);
        print_fits(&found.identification, verbosity);
        print_left_out(&observed.observations, &speech, verbosity);
        print_verdict(&found.identification, &speech, verbosity);
        if self.json {
            print_json_file(&folder.join(pipeline::identify::FILE))?;
        }
        Ok(Exit::of(found.identification.verdict.kind))
    }
}

impl Report {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let Some(folder) = self.folder.filter(|_| !self.list_words) else {
            print(&Catalog::blank())?;
            return Ok(Exit::Done);
        };
        let (folder, _lock) = folder.take()?;
        let mut campaign = store::read_resolved(&folder)?;
        self.options.apply(&mut campaign.report, verbosity)?;
        let command = if store::is_staged(&folder) {
            commands(&campaign.file, &folder, &self.options)
        } else {
            command_line(&campaign.file, &folder, &self.options)
        };
        note_missing(&campaign, verbosity);
        let bar = Progress::new(verbosity, "report", 1);
        let report = match &campaign.published {
            Some(published) => {
                let found = store::read_identification(&folder)?;
                pipeline::published::report_files(&campaign, published, &found, &command)?
            }
            None => {
                let (observed, found) = store::read_for_report(&folder)?;
                pipeline::report::files(&campaign, &observed, &found, &command)?
            }
        };
        let beside = pipeline::report::write(&report, &folder)?;
        drop(bar);
        let speech = Speech::of(&campaign.report)?;
        print_report_paths(&campaign, &folder, &beside, &speech, verbosity);
        Ok(Exit::Done)
    }
}

/// Say which record files are gone: what a report draws of them is left out.
fn note_missing(campaign: &ResolvedCampaign, verbosity: Verbosity) {
    let files: BTreeSet<&Path> = campaign.records.iter().map(|r| r.file.as_path()).collect();
    let mut missing = files.into_iter().filter(|file| !file.exists());
    if let Some(first) = missing.next() {
        let count = 1 + missing.count();
        verbosity.info(&format!(
            "{count} of the record files are not found, {} first: figures that compare them are left out",
            first.display()
        ));
    }
}
