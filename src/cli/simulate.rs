//! `impactid simulate`: motions of the theory, and campaigns with known truth.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::machine::{MachineArgs, StartArgs, at_least};
use super::out_folder::Work;
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity, out_folder};
use impact_campaign::pipeline::synthesise::{Recipe, write_campaign};
use impact_oscillator::atlas::portrait::{PortraitPlan, Soft};
use impact_oscillator::model::Setting;
use simulated_rig::truth::draw_differences;
use simulated_rig::{Faults, RigSpec, Truth};

/// Arguments of `impactid simulate`.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLE,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub(super) struct Simulate {
    #[command(subcommand)]
    what: Option<What>,
    #[command(flatten)]
    motion: MotionArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid simulate --eta 0.95 --rho 0.7 --phase 0.7854 --restitution 0 --damping-ratio 0.1 \\
      --start=-1,1.5,-3,2.5 --periods 3 --out fig2/
  impactid simulate --eta 2.8 --rho 0.02 --skip-periods 300 --periods 12 --out chaos/
  impactid simulate campaign --seed 1 --restitution 0.9 --damping-ratio 0.07 --out synthetic/

A motion writes its time series (motion), motion-impacts, motion-poincare and \
motion-autocorrelation as CSV and Parquet, a figure with phase trajectories and Poincaré map \
as SVG, PNG and PDF, and study.toml to replay it.";

#[derive(Debug, Subcommand)]
enum What {
    /// A whole campaign as a laboratory would record it, the truth in truth.json beside it
    Campaign(Campaign),
}

/// A motion of the theory.
#[derive(Debug, Clone, Args)]
pub(super) struct MotionArgs {
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratio η
    #[arg(long, value_name = "ETA", required = true)]
    eta: Option<f64>,
    /// Clearance ρ
    #[arg(
        long,
        value_name = "RHO",
        required = true,
        allow_negative_numbers = true
    )]
    rho: Option<f64>,
    /// Phase φ of the drive at the start, rad
    #[arg(
        long,
        value_name = "PHI",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    phase: f64,
    #[command(flatten)]
    start: StartArgs,
    /// Drive periods skipped first
    #[arg(long, value_name = "N", default_value_t = 0.0)]
    skip_periods: f64,
    /// Drive periods of the time series
    #[arg(long, value_name = "N", default_value_t = 10.0)]
    periods: f64,
    /// Samples of the time series in a drive period
    #[arg(long, value_name = "N", default_value_t = 200)]
    samples_per_period: usize,
    /// Drive periods of the Poincaré map and of the autocorrelation
    #[arg(long, value_name = "N", default_value_t = 500)]
    poincare_periods: usize,
    /// Phase of the drive at which the Poincaré map is taken, rad
    #[arg(
        long,
        value_name = "PHI",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    poincare_phase: f64,
    /// Contact of a finite stiffness (over the spring's) instead of Newton's law; its damper
    /// gives the same R
    #[arg(long, value_name = "KAPPA")]
    contact_stiffness: Option<f64>,
    #[command(flatten)]
    out: OutArgs,
}

impl MotionArgs {
    fn run(&self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut study = self.machine.study("A motion")?;
        let plan = PortraitPlan {
            setting: Setting::new(self.eta.unwrap_or(1.0), self.rho.unwrap_or(1.0))
                .at_phase(self.phase),
            start: self.start.initial()?,
            skip_periods: self.skip_periods.max(0.0),
            periods: self.periods.max(0.0),
            samples_per_period: self.samples_per_period.max(1),
            poincare_periods: self.poincare_periods,
            poincare_phase: self.poincare_phase,
            soft: self.contact_stiffness.map(|stiffness| Soft { stiffness }),
        };
        study.time_series.insert("motion".into(), plan);
        self.out.study(&study, "simulate", verbosity)
    }
}

const CAMPAIGN_HELP: &str = "\
Example:
  impactid simulate campaign --seed 1 --restitution 0.9 --damping-ratio 0.07 --out synthetic/
  impactid simulate campaign --rig realistic --out realistic/
  impactid simulate campaign --rig contact=0.3,friction --out soft-contact/

Effects and the strengths they have if none is given (0 switches one off):
  gaps=0.003               each stated gap is off; standard deviation over x_st
  gap-offset=0.003         all gaps are off alike; standard deviation over x_st
  damping-asymmetry=0.05   difference of the damping ratios over their mean
  drive-asymmetry=0.05     difference of the forces over their mean; 2: one mass is driven alone
  second-harmonic=0.005    of the drive force, over its fundamental
  third-harmonic=0.003     of the drive force, over its fundamental
  force-slope=0.01         relative change of the force per unit of eta, about eta = 1
  force-curvature=0.005    the same, per unit of eta squared
  hardening=0.004          relative stiffening of the springs at x_st/(2 beta)
  friction=0.005           Coulomb friction of each mass over F0
  frequency-drift=0.002    relative change of f0 over the campaign
  damping-drift=0.02       relative change of the dashpots over the campaign
  contact=0.64             duration of an impact, ms (needs R of 0.136 or more)
  delays=0.5               greatest delay of a channel against the drive, samples
  flicker=0.001            1/f noise, V rms
  hum=0.001                mains hum, V amplitude
  drag=0.005               quadratic drag of each mass over F0, at the speed 2 pi f0 x_st/(2 beta)
  spring-asymmetry=0.003   relative stiffening of the springs from rest to x_st/(2 beta) toward the other mass
  hysteretic-damping=0.05  share of the damping that falls with the frequency, as inside of springs
Effects that realistic leaves out:
  gap-drift=0.01           drift of all gaps over the campaign, over x_st
And those that the fit does not know:
  backlash=0.005           gaps of upward sweeps are wider than those of downward ones, over x_st
  compression=0.005        relative loss of the motion channels at x_st/(2 beta), by the square of the signal
  restarts=0.5             the drive starts again at every setting; greatest jump of its phase, turns
truth.json states what was drawn.";

/// Arguments of `impactid simulate campaign`.
#[derive(Debug, Clone, Args)]
#[command(after_help = CAMPAIGN_HELP)]
pub(super) struct Campaign {
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Seed of the rig's own errors (gains, corners, gaps, asymmetries, effects), to measure one rig
    /// several times; campaign.toml then states what the campaigns share [default: that of --seed]
    #[arg(long, value_name = "N")]
    pub rig_seed: Option<u64>,
    /// Coefficient of restitution R, 0 to 1
    #[arg(long, value_name = "R", default_value_t = 0.9, value_parser = within(0.0, 1.0))]
    pub restitution: f64,
    /// Damping ratio β, above 0, up to 0.5
    #[arg(long, value_name = "B", default_value_t = 0.07, value_parser = within(1e-6, 0.5))]
    pub damping_ratio: f64,
    /// Natural frequency f0, Hz
    #[arg(long, value_name = "F", default_value_t = 12.6, value_parser = within(1e-3, 1e5))]
    pub natural_frequency_hz: f64,
    /// Static deflection `x_st` = F0/k, m
    #[arg(long, value_name = "X", default_value_t = 1e-3, value_parser = within(1e-9, 1.0))]
    pub static_deflection_m: f64,
    /// Number of records [default: 200]
    #[arg(long, value_name = "N", value_parser = at_least::<1>)]
    pub records: Option<usize>,
    /// Folder for the campaign
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
    /// Effects beyond the model: exact (none), realistic (what the fit models but gap-drift, and 1/f noise
    /// and hum, at half to one and a half times the strengths below), or EFFECT[=STRENGTH],… as listed below
    #[arg(long, value_name = "RIG", default_value = "exact")]
    pub rig: RigSpec,
    /// Upward sweeps that pass the motions between ρ′ and z = 1 in small steps: z = 1/5 to 1/2, 2/2, chaos
    #[arg(long)]
    pub beats: bool,
    /// A rig without faults: no noise, no rounding, no filter, no asymmetry
    #[arg(long)]
    pub ideal: bool,
    /// Write over a campaign that is there
    #[arg(long)]
    pub force: bool,
}

/// Records of a campaign where the number is not given.
const DEFAULT_RECORDS: usize = 200;

/// Reads a number from `low` to `high`.
pub(super) fn within(low: f64, high: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        Ok(_) => Err(format!("it must lie between {low} and {high}")),
        Err(_) => Err("it is not a number".to_owned()),
    }
}

impl Simulate {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        match self.what {
            Some(What::Campaign(campaign)) => campaign.run(verbosity),
            None => self.motion.run(verbosity),
        }
    }
}

impl Campaign {
    fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let _lock = out_folder::take(&self.out, Work::Simulation)?;
        if self.out.join("campaign.toml").exists() && !self.force {
            return Err(Failure::new(
                format!("{} holds a campaign already", self.out.display()),
                "name another folder with --out, or add --force",
            ));
        }
        let faults = if self.ideal {
            Faults::none()
        } else {
            Faults::default()
        };
        let differences = draw_differences(&faults, self.rig_seed.unwrap_or(self.seed));
        let recipe = Recipe {
            truth: Truth::symmetric(
                self.restitution,
                self.natural_frequency_hz,
                self.damping_ratio,
                self.static_deflection_m,
            )
            .with_differences(&differences),
            faults,
            rig: self.rig,
            records: self.records.unwrap_or(DEFAULT_RECORDS),
            beats: self.beats,
            seed: self.seed,
            rig_seed: self.rig_seed,
        };
        let count = write_campaign(&recipe, &self.out)?;
        verbosity.info(&format!(
            "{count} synthetic records in {}; next: impactid run {} --out results/",
            self.out.display(),
            self.out.join("campaign.toml").display()
        ));
        Ok(Exit::Done)
    }
}
