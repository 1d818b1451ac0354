//! `impactid plan`: which settings to measure next.

use std::path::PathBuf;

use clap::Args;

use super::voice::print_json;
use super::{Exit, Failure, Progress, Voice, interrupt};
use crate::motion::Motion;
use crate::pipeline::plan;
use labfiles::output::Lock;

/// Arguments of `impactid plan`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Plan {
    /// The campaign as measured so far
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Number of settings to propose
    #[arg(long, value_name = "N", default_value_t = 6)]
    settings: usize,
    /// Folder for plan.json, plan.csv and the map
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid plan data-samples/double-oscillator/campaign.toml --out plan/

The settings lie within the frequencies and gaps that the campaign has visited. Each takes those
above it as measured, with records as long and as noisy as the campaign's own.
Exit codes: 0 done; 1 nothing can be proposed; 2 bad input.";

impl Plan {
    /// Identify, propose, draw.
    ///
    /// # Errors
    /// [`Failure`] where the campaign cannot be used or an output cannot be written.
    pub fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let campaign = super::stage::load_campaign(&self.campaign, voice)?;
        let _lock = Lock::take(&self.out)?;
        interrupt::watch(self.out.clone());
        let bar = Progress::new(voice, "observe", campaign.records.len() as u64);
        let told = |stage: &'static str, done: u64, total: u64| {
            bar.stage(stage);
            bar.set(done, total);
        };
        let found = plan::plan(&campaign, self.settings, &self.out, &told)?;
        drop(bar);
        if self.json {
            print_json(&found)?;
        } else if !voice.is_quiet() {
            print_table(&found);
        }
        if found.proposals.is_empty() {
            voice
                .say("Nothing can be proposed: R was not fitted from velocities or displacements.");
            return Ok(Exit::AnswerIsNo);
        }
        Ok(Exit::Done)
    }
}

fn print_table(found: &plan::Plan) {
    if let (Some(r), Some(error)) = (found.restitution, found.restitution_error_now) {
        println!("R = {r:.6}, standard error now {error:.2e}");
    }
    println!(
        "{:>4} {:>12} {:>13} {:>8} {:>8} {:>6} {:>15}",
        "", "drive, Hz", "clearance, mm", "η", "ρ", "z", "error of R then"
    );
    for (i, p) in found.proposals.iter().enumerate() {
        let motion = Motion::periodic(1, p.periods_n).label();
        println!(
            "{:>4} {:>12.3} {:>13.4} {:>8.4} {:>8.4} {motion:>6} {:>15.2e}",
            i + 1,
            p.frequency_hz,
            1e3 * p.clearance_m,
            p.frequency_ratio,
            p.clearance_ratio,
            p.restitution_error_after
        );
    }
}
