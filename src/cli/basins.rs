//! `impactid basins`: basins of attraction in the plane of the starts.

use clap::Args;

use super::machine::{MachineArgs, WatchArgs, at_least, range};
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity};
use impact_oscillator::atlas::basins::{BasinGrid, Starts};
use impact_oscillator::model::Setting;
use impact_workbench::theory::plan::BasinPlan;

/// Arguments of `impactid basins`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Basins {
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratio η
    #[arg(long, value_name = "ETA")]
    eta: f64,
    /// Clearance ρ
    #[arg(long, value_name = "RHO", allow_negative_numbers = true)]
    rho: f64,
    /// Phase φ of the drive at the start, rad
    #[arg(
        long,
        value_name = "PHI",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    phase: f64,
    /// Starts X(0)
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    x: (f64, f64),
    /// Starts X'(0)
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    vx: (f64, f64),
    /// Columns: values of X(0)
    #[arg(long, value_name = "N", default_value_t = 601, value_parser = at_least::<2>)]
    columns: usize,
    /// Rows: values of X'(0)
    #[arg(long, value_name = "N", default_value_t = 451, value_parser = at_least::<2>)]
    rows: usize,
    /// Start X alone; Y starts at rest at zero (else both masses start alike)
    #[arg(long)]
    one_mass: bool,
    #[command(flatten)]
    watch: WatchArgs,
    #[command(flatten)]
    out: OutArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid basins --eta 1.19 --rho 3 --restitution 0 --damping-ratio 0.005 \\
      --x -12..3 --vx -12..12 --settle-periods 600 --out fig5a/

It writes basins.csv and .parquet, the figure as SVG, PNG and PDF, and study.toml to replay \
it.";

impl Basins {
    /// Settle every start.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range or a file cannot be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut study = self.machine.study("Basins of attraction")?;
        let starts = if self.one_mass {
            Starts::OneMass
        } else {
            Starts::BothMasses
        };
        let plan = BasinPlan {
            setting: Setting::new(self.eta, self.rho).at_phase(self.phase),
            grid: BasinGrid {
                x: (self.x.0, self.x.1, self.columns),
                vx: (self.vx.0, self.vx.1, self.rows),
                starts,
            },
            restitution: None,
            watch: self.watch.watch(),
        };
        study.basins.insert("basins".into(), plan);
        self.out.study(&study, "basins", verbosity)
    }
}
