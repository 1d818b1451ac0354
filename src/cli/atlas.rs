//! `impactid atlas`: regions of all motions in the (η, ρ) plane, their boundaries as curves, and
//! the brute-force map beside them; `--shard` computes a part of it for `impactid merge`.

use clap::{Args, ValueEnum};

use super::atlas_part::{NAME, computed};
use super::machine::{MachineArgs, WatchArgs, at_least, range};
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity, interrupt};
use impact_oscillator::atlas::map::{Kernel, MapSettings};
use impact_workbench::theory::Study;
use impact_workbench::theory::plan::RegionsPlan;
use labfiles_write::output::{Lock, write_json_line};

/// Arguments of `impactid atlas`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Atlas {
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratios η
    #[arg(long, value_name = "LOW..HIGH", default_value = "0.3..5", value_parser = range)]
    eta: (f64, f64),
    /// Clearances ρ
    #[arg(long, value_name = "LOW..HIGH", default_value = "-1.2..8", value_parser = range,
          allow_hyphen_values = true)]
    rho: (f64, f64),
    /// Columns (η) of the grid
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = at_least::<2>)]
    columns: usize,
    /// Rows (ρ) of the grid
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = at_least::<2>)]
    rows: usize,
    /// Greatest number of impacts p per period of the motion
    #[arg(long, value_name = "P", default_value_t = 4)]
    largest_p: u32,
    /// Greatest number of drive periods n per period of the motion
    #[arg(long, value_name = "N", default_value_t = 6)]
    largest_n: u32,
    #[command(flatten)]
    watch: WatchArgs,
    /// Instruction set [default: the widest that this processor runs]
    #[arg(long, value_enum, value_name = "SET")]
    kernel: Option<Instructions>,
    /// Compute only part I of N, I from 0, for `impactid merge`
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<(usize, usize)>,
    /// Share the work among the ranks of `mpirun`; the first writes the results
    #[cfg(feature = "mpi")]
    #[arg(long, conflicts_with_all = ["shard", "resume"])]
    mpi: bool,
    #[command(flatten)]
    out: OutArgs,
}

/// Instruction sets of the marching kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Instructions {
    /// Plain arithmetic, any processor
    Scalar,
    /// AVX2 and FMA
    Avx2,
    /// AVX-512
    Avx512,
}

const EXAMPLE: &str = "\
Example:
  impactid atlas --restitution 0.9 --damping-ratio 0.07 --out atlas/
  impactid atlas --columns 2000 --rows 1500 --shard 3/16 --out parts/

All of --shard 0/16 to 15/16 make one atlas: impactid merge parts/*.json --out atlas/
It writes atlas-curves and atlas-map as CSV and Parquet, the figure atlas as SVG, PNG and PDF, \
atlas.json with how curves and brute force agree, and study.toml to replay it; with --shard \
only part-I-of-N.json. Rounding differs between instruction sets: parts for machines of \
several kinds need one --kernel.";

fn shard(text: &str) -> Result<(usize, usize), String> {
    let wrong = || format!("“{text}” is no part: write I/N with I from 0 to N−1, such as 3/16");
    let (number, of) = text.split_once('/').ok_or_else(wrong)?;
    match (number.trim().parse(), of.trim().parse()) {
        (Ok(number), Ok(of)) if number < of => Ok((number, of)),
        _ => Err(wrong()),
    }
}

impl Atlas {
    /// Compute and write.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range or a file cannot be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let title = "Regions of existence and stability of all motions";
        let mut study = self.machine.study(title)?;
        let plan = self.plan()?;
        study.regions.insert(NAME.into(), plan.clone());
        if let Some((number, of)) = self.shard {
            return self.part(&study, &plan, number, of, verbosity);
        }
        #[cfg(feature = "mpi")]
        if self.mpi {
            return super::mpi::run(&study, &plan, &self.out, verbosity);
        }
        self.out.study(&study, "atlas", verbosity)
    }

    fn plan(&self) -> Result<RegionsPlan, Failure> {
        let kernel = self.kernel.map(|k| match k {
            Instructions::Scalar => Kernel::Scalar,
            Instructions::Avx2 => Kernel::Avx2,
            Instructions::Avx512 => Kernel::Avx512,
        });
        if kernel.is_some_and(|k| !k.is_available()) {
            return Err(Failure::new(
                "this processor does not have the instruction set named with --kernel",
                "leave --kernel out, or name one that it has: scalar always works",
            ));
        }
        Ok(RegionsPlan {
            eta: (self.eta.0, self.eta.1, self.columns),
            rho: (self.rho.0, self.rho.1, self.rows),
            largest_p: self.largest_p,
            largest_n: self.largest_n,
            map: MapSettings {
                watch: self.watch.watch(),
                kernel,
                ..MapSettings::default()
            },
        })
    }

    fn part(
        &self,
        study: &Study,
        plan: &RegionsPlan,
        number: usize,
        of: usize,
        verbosity: Verbosity,
    ) -> Result<Exit, Failure> {
        let file = self
            .out
            .folder()
            .join(format!("part-{number}-of-{of}.json"));
        labfiles_write::output::make_folder(self.out.folder())?;
        interrupt::watch(self.out.folder().to_path_buf());
        // many parts of an array of jobs may share the folder: the lock is the part's own
        let _lock = Lock::take(&self.out.folder().join(format!(".part-{number}")))?;
        let part = computed(study, plan, number, of)?;
        write_json_line(&file, &part)?;
        drop(_lock);
        let _ = std::fs::remove_dir(self.out.folder().join(format!(".part-{number}")));
        verbosity.info(&format!("{}; next: impactid merge", file.display()));
        Ok(Exit::Done)
    }
}
