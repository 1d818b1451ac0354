//! `impactid run`: all stages, from campaign.toml to the report.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::look::{Look, quoted};
use super::progress::{Later, Progress};
use super::{Exit, Failure, Voice, interrupt};
use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::{self, Destination, checkpoint};
use crate::report::Format;
use labfiles::output::Lock;

/// Arguments of `impactid run`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Run {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Folder for the results; it is made where it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Take over what a run that was broken off left in DIR
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    look: Look,
}

const EXAMPLE: &str = "\
Example:
  impactid run data-samples/double-oscillator/campaign.toml --out results/
  impactid run campaign.toml --out results/ --format pdf,html,svg,png --paper letter

It leaves report.pdf, the figures' data in figures/, identification.json, records.parquet, impacts.parquet and boundaries.csv.
Exit codes: 0 done; 1 done, but the answer is \"does not fit\" or \"not identifiable\"; 2 bad input.";

/// Say where the report lies.
pub(super) fn say_report(campaign: &ResolvedCampaign, out: &Path, voice: Voice) {
    for format in &campaign.report.formats {
        let name = match format {
            Format::Pdf => "report.pdf",
            Format::Html => "report.html",
            Format::Svg | Format::Png | Format::Csv => "figures/",
        };
        voice.say(&format!(
            "Report ({}): {}",
            format.name(),
            out.join(name).display()
        ));
    }
}

/// What fitting, report and writing take, measured on campaigns of 846 to 100,000 records
/// (docs/validation.md): of very long campaigns not all waveforms are fitted and not all rows printed.
pub(super) const LATER: Later = Later {
    part: 0.45,
    bounded: (0.4, 10_000),
    fixed: Duration::from_secs(1),
};

/// From how many records on observations are kept; `IMPACTID_KEEP_FROM` sets another number, so
/// that small campaigns can be tried.
fn keep_from() -> usize {
    let set = std::env::var("IMPACTID_KEEP_FROM").ok();
    set.and_then(|n| n.parse().ok())
        .unwrap_or(checkpoint::FEWEST)
}

impl Run {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let mut campaign = super::stage::load_campaign(&self.campaign, voice)?;
        self.look.apply(&mut campaign.report, voice)?;
        let _lock = Lock::take(&self.out)?;
        interrupt::watch(self.out.clone());
        voice.detail(&format!("{} records", campaign.records.len()));
        let records = campaign.records.len() as u64;
        let progress = Progress::new(voice, "observe", records).with_later(LATER);
        let told = |stage: &'static str, done: u64, total: u64| {
            progress.stage(stage);
            progress.set(done, total);
        };
        let command = format!(
            "impactid run {} --out {}{}",
            quoted(&self.campaign),
            quoted(&self.out),
            self.look.typed()
        );
        let destination = Destination {
            out: &self.out,
            resume: self.resume,
            keep_from: keep_from(),
            command_line: &command,
        };
        let found = pipeline::run(&campaign, &destination, &told)?;
        drop(progress);
        voice.say(&found.to_string());
        for finding in &found.findings {
            voice.say(&format!("  - {finding}"));
        }
        say_report(&campaign, &self.out, voice);
        Ok(Exit::of(found.kind))
    }
}
