//! `impactid sweep`: quasi-stationary characteristics in both directions.

use clap::Args;

use super::machine::{MachineArgs, StartArgs, WatchArgs, at_least, range};
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity};
use impact_workbench::theory::plan::SweepPlan;

/// Arguments of `impactid sweep`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Sweep {
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratios η: the sweep's ends, or one value where ρ moves
    #[arg(long, value_name = "FROM..TO|ETA", value_parser = ends)]
    eta: (f64, f64),
    /// Clearances ρ: the sweep's ends, or one value where η moves
    #[arg(long, value_name = "FROM..TO|RHO", value_parser = ends, allow_hyphen_values = true)]
    rho: (f64, f64),
    /// Steps from end to end
    #[arg(long, value_name = "N", default_value_t = 301, value_parser = at_least::<2>)]
    steps: usize,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    watch: WatchArgs,
    #[command(flatten)]
    out: OutArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid sweep --eta 0.78..1.4 --rho 3 --restitution 0 --damping-ratio 0.002 --out fig4/
  impactid sweep --eta 1.2 --rho 0.1..5 --out over-rho/

It writes sweep.csv and .parquet (amplitudes, approach speeds, Lyapunov exponents, \
autocorrelation, amplitude and phase of the impactless motion), sweep-impacts (every impact's \
speeds), the figure as SVG, PNG and PDF, and study.toml to replay it.";

/// `from..to`, or one number for both.
fn ends(text: &str) -> Result<(f64, f64), String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((value, value)),
        _ => range(text),
    }
}

impl Sweep {
    /// Sweep there and back.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range or a file cannot be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        if self.eta.0 == self.eta.1 && self.rho.0 == self.rho.1 {
            return Err(Failure::new(
                format!(
                    "η = {} and ρ = {} are one point: nothing is swept",
                    self.eta.0, self.rho.0
                ),
                "give one of them as a range, --eta 0.8..1.4; `impactid simulate` computes one point",
            ));
        }
        let mut study = self.machine.study("Quasi-stationary characteristics")?;
        let plan = SweepPlan {
            eta: self.eta,
            rho: self.rho,
            steps: self.steps,
            start: self.start.initial()?,
            watch: self.watch.watch(),
        };
        study.sweep.insert("sweep".into(), plan);
        self.out.study(&study, "sweep", verbosity)
    }
}
