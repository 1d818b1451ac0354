//! `impactid simulate`: campaigns with known truth.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{Exit, Failure, Voice, interrupt};
use crate::output::Lock;
use crate::pipeline::synthesise::{Recipe, write_campaign};
use crate::synthetic::truth::draw_asymmetry;
use crate::synthetic::{Faults, Truth};

/// Arguments of `impactid simulate`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Simulate {
    #[command(subcommand)]
    what: What,
}

const EXAMPLE: &str = "\
Example:
  impactid simulate campaign --seed 1 --restitution 0.9 --damping-ratio 0.07 \\
      --natural-frequency-hz 12.6 --static-deflection-m 0.001 --out synthetic/";

#[derive(Debug, Subcommand)]
enum What {
    /// A whole campaign as a laboratory would record it, the truth in truth.json beside it
    Campaign(Campaign),
}

/// Arguments of `impactid simulate campaign`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLE)]
pub struct Campaign {
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Coefficient of restitution R, 0 to 1
    #[arg(long, value_name = "R", default_value_t = 0.9, value_parser = restitution)]
    pub restitution: f64,
    /// Damping ratio β, 0 to 0.5
    #[arg(long, value_name = "B", default_value_t = 0.07, value_parser = damping_ratio)]
    pub damping_ratio: f64,
    /// Natural frequency f0, Hz
    #[arg(long, value_name = "F", default_value_t = 12.6, value_parser = frequency)]
    pub natural_frequency_hz: f64,
    /// Static deflection x_st = F0/k, m
    #[arg(long, value_name = "X", default_value_t = 1e-3, value_parser = deflection)]
    pub static_deflection_m: f64,
    /// Number of records; the usual grid of frequencies and gaps where it is not given
    #[arg(long, value_name = "N")]
    pub records: Option<std::num::NonZeroUsize>,
    /// Folder for the campaign
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
    /// A rig without faults: no noise, no rounding, no filter, no asymmetry
    #[arg(long)]
    pub ideal: bool,
    /// Write over a campaign that is there
    #[arg(long)]
    pub force: bool,
}

/// Records of a campaign where the number is not given.
const DEFAULT_RECORDS: usize = 200;

fn restitution(text: &str) -> Result<f64, String> {
    number_within(text, 0.0, 1.0)
}

fn damping_ratio(text: &str) -> Result<f64, String> {
    number_within(text, 1e-6, 0.5)
}

fn frequency(text: &str) -> Result<f64, String> {
    number_within(text, 1e-3, 1e5)
}

fn deflection(text: &str) -> Result<f64, String> {
    number_within(text, 1e-9, 1.0)
}

fn number_within(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        Ok(_) => Err(format!("it must lie between {low} and {high}")),
        Err(_) => Err("it is not a number".to_owned()),
    }
}

impl Simulate {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        match self.what {
            What::Campaign(campaign) => campaign.go(voice),
        }
    }
}

impl Campaign {
    fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let _lock = Lock::take(&self.out)?;
        if self.out.join("campaign.toml").exists() && !self.force {
            return Err(Failure::new(
                format!("{} holds a campaign already", self.out.display()),
                "name another folder with --out, or add --force",
            ));
        }
        interrupt::watch(self.out.clone());
        let faults = if self.ideal {
            Faults::none()
        } else {
            Faults::default()
        };
        let (drive_asymmetry, stiffness_asymmetry) = draw_asymmetry(&faults, self.seed);
        let recipe = Recipe {
            truth: Truth {
                restitution: self.restitution,
                natural_frequency_hz: self.natural_frequency_hz,
                damping_ratio: self.damping_ratio,
                static_deflection_m: self.static_deflection_m,
                drive_asymmetry,
                stiffness_asymmetry,
            },
            faults,
            records: self
                .records
                .map_or(DEFAULT_RECORDS, std::num::NonZeroUsize::get),
            seed: self.seed,
        };
        let count = write_campaign(&recipe, &self.out)?;
        voice.say(&format!(
            "{count} synthetic records in {0}; next: impactid run {0}/campaign.toml --out results/",
            self.out.display()
        ));
        Ok(Exit::Done)
    }
}
