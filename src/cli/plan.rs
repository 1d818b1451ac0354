//! `impactid plan`: which settings to measure next.

use std::path::PathBuf;

use clap::Args;

use super::machine::at_least;
use super::out_folder::Work;
use super::stdout::print_json;
use super::{Exit, Failure, Progress, Verbosity, out_folder};
use impact_campaign::pipeline::plan;
use impact_identification::identify::boundary_plan::BoundaryPlan;
use impact_records::message::plain;
use impact_records::motion::Motion;
use impact_records::signal::digits::decimals_for;

/// Arguments of `impactid plan`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Plan {
    /// The campaign as measured so far
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Number of settings to propose
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = at_least::<1>)]
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

The settings are within the frequencies and gaps of the campaign. Each assumes that those \
above it are measured, with records as long and as noisy as those of the campaign. What the \
interval allows for beyond noise stays in the errors: more records do not reduce it. Below them: \
how finely to step through the ends of z = 1 so that R's interval from the measured boundaries alone \
is halved.
Exit codes: 0 success; 1 nothing can be proposed; 2 bad input.";

impl Plan {
    /// Identify, propose, draw.
    ///
    /// # Errors
    /// [`Failure`] where the campaign cannot be used or an output cannot be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let campaign = super::load::load_campaign(&self.campaign, verbosity)?;
        let _lock = out_folder::take(&self.out, Work::Plan)?;
        let bar = Progress::new(verbosity, "observe", campaign.records.len() as u64);
        let step = |stage: &'static str, done, total| bar.step(stage, done, total);
        let found = plan::plan(&campaign, self.settings, &self.out, &step)?;
        drop(bar);
        if self.json {
            print_json(&found)?;
        } else if !verbosity.is_quiet() {
            print_table(&found);
        }
        Ok(match &found.obstacle {
            Some(obstacle) => {
                verbosity.info(&format!("Nothing can be proposed: {obstacle}."));
                Exit::AnswerIsNo
            }
            None => Exit::Done,
        })
    }
}

/// How to step through the ends of z = 1, for R from the boundaries alone.
fn boundaries(plan: &BoundaryPlan) -> String {
    let [now, then] = [plan.half_width95_now, plan.half_width95_then].map(uncertainty);
    let mut text = if plan.halved {
        format!(
            "R from the measured boundaries alone is ± {now} (95 %); it would be ± {then} with these upward \
             sweeps past the end of z = 1:\n"
        )
    } else {
        format!(
            "R from the measured boundaries alone is ± {now} (95 %). Finer steps do not halve it: with these it \
             would be ± {then}, and the rest is what acts on boundaries beside R (f0, β, x_st and clearances as \
             they are known, the length of contacts):\n"
        )
    };
    text += &format!(
        "{:>13} {:>12} {:>12} {:>12}\n",
        "clearance, mm", "from, Hz", "to, Hz", "step, Hz"
    );
    for sweep in &plan.sweeps {
        text += &format!(
            "{:>13.4} {:>12.3} {:>12.3} {:>12.4}\n",
            1e3 * sweep.clearance_m,
            sweep.from_hz,
            sweep.to_hz,
            sweep.step_hz
        );
    }
    text
}

/// Standard errors from the middle of a normal distribution to either end of its 95 % interval.
const NORMAL_95: f64 = 1.96;

/// An uncertainty with two significant digits.
fn uncertainty(value: f64) -> String {
    format!("{value:.0$}", decimals_for(value))
}

fn print_table(found: &plan::MeasurementPlan) {
    print_settings(found);
    if let Some(plan) = &found.boundaries {
        print!("{}", boundaries(plan));
    }
}

fn print_settings(found: &plan::MeasurementPlan) {
    if let (Some(r), Some(error)) = (found.restitution, found.restitution_error_now) {
        let half = NORMAL_95 * error;
        let decimals = decimals_for(half);
        println!("R = {r:.decimals$} ± {half:.decimals$} (95 %) now");
    }
    if found.proposals.is_empty() {
        return;
    }
    println!(
        "{:>4} {:>12} {:>13} {:>8} {:>8} {:>6} {:>10} {:>15}",
        "", "drive, Hz", "clearance, mm", "η", "ρ", "z", "approach", "± of R then"
    );
    for (i, p) in found.proposals.iter().enumerate() {
        let motion = Motion::periodic(1, p.periods_n).label();
        println!(
            "{:>4} {:>12.3} {:>13.4} {:>8.4} {:>8.4} {motion:>6} {:>10} {:>15}",
            format!("P{}", i + 1),
            p.frequency_hz,
            1e3 * p.clearance_m,
            p.frequency_ratio,
            p.clearance_ratio,
            plain(&p.approach),
            uncertainty(NORMAL_95 * p.restitution_error_after)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_identification::identify::boundary_plan::FineSweep;

    #[test]
    fn what_finer_steps_make_of_boundaries_is_said() {
        let plan = |halved| BoundaryPlan {
            half_width95_now: 0.057,
            half_width95_then: 0.02,
            halved,
            sweeps: vec![FineSweep {
                clearance_m: 1.25e-3,
                from_hz: 13.8,
                to_hz: 14.6,
                step_hz: 0.1,
            }],
        };
        let text = boundaries(&plan(true));
        assert!(
            text.starts_with(
                "R from the measured boundaries alone is ± 0.057 (95 %); it would be ± 0.020"
            ),
            "{text}"
        );
        assert!(
            text.ends_with("1.2500       13.800       14.600       0.1000\n"),
            "{text}"
        );
        assert!(boundaries(&plan(false)).contains("do not halve it"));
    }
}
