//! `impactid study`: studies of the theory from small TOML files that can be kept and replayed:
//! time series, quasi-stationary sweeps, basins of attraction and regions.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Deserialize;

use super::atlas::{curves_csv, label, maps_csv, write};
use super::machine::refused;
use super::{Exit, Failure, Progress, Voice};
use crate::atlas::basins::{BasinGrid, basins};
use crate::atlas::map::{MapGrid, MapSettings, even};
use crate::atlas::regions::{AtlasSettings, atlas};
use crate::atlas::sweep::{Sweep, SweepPoint, sweep};
use crate::model::params::Asymmetry;
use crate::model::{Initial, Machine, Restitution, Setting, Watch, simulate};

/// Arguments of `impactid study`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Study {
    /// The studies
    #[arg(value_name = "STUDY.TOML", required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results, one folder in it for each study
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Go on after an interruption: leave studies out whose results are there
    #[arg(long)]
    resume: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid study data-samples/studies/*.toml --out studies/

replays the studies of the paper's Figs. 2 to 8. Each leaves its tables in a folder of its own.";

/// A study as written.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    /// What it shows.
    title: String,
    damping_ratio: f64,
    restitution: Law,
    #[serde(default)]
    asymmetry: Asymmetry,
    #[serde(default)]
    time_series: Vec<TimeSeries>,
    #[serde(default)]
    sweep: Vec<SweepPlan>,
    #[serde(default)]
    basins: Vec<BasinPlan>,
    regions: Option<Regions>,
}

/// R as a number or as a law R(v).
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Law {
    Constant(f64),
    Law(Restitution),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct TimeSeries {
    name: String,
    setting: Setting,
    #[serde(default)]
    start: Initial,
    #[serde(default)]
    skip_periods: f64,
    periods: f64,
    #[serde(default = "two_hundred")]
    samples_per_period: usize,
}

fn two_hundred() -> usize {
    200
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepPlan {
    name: String,
    /// First and last η, and number of steps.
    eta: (f64, f64),
    /// First and last ρ.
    rho: (f64, f64),
    steps: usize,
    #[serde(default)]
    start: Initial,
    #[serde(default)]
    watch: Watch,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct BasinPlan {
    name: String,
    setting: Setting,
    grid: BasinGrid,
    restitution: Option<f64>,
    #[serde(default)]
    watch: Watch,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Regions {
    eta: (f64, f64, usize),
    rho: (f64, f64, usize),
    largest_p: u32,
    largest_n: u32,
}

impl Written {
    fn machine(&self) -> Machine {
        let law = match &self.restitution {
            Law::Constant(r) => Restitution::Constant(*r),
            Law::Law(law) => law.clone(),
        };
        let symmetric = self.asymmetry == Asymmetry::default();
        let machine = if symmetric {
            Machine::symmetric(self.damping_ratio, 0.0)
        } else {
            Machine::asymmetric(self.damping_ratio, 0.0, self.asymmetry)
        };
        machine.with_restitution(law)
    }

    fn parts(&self) -> u64 {
        let regions = usize::from(self.regions.is_some());
        (self.time_series.len() + self.sweep.len() + self.basins.len() + regions) as u64
    }
}

/// Name of the study's copy beside its results; it is written last.
const COPY: &str = "study.toml";

impl Study {
    /// Run all studies.
    ///
    /// # Errors
    /// [`Failure`] where a study cannot be read, a parameter is out of range or a file cannot
    /// be written.
    pub fn go(self, voice: Voice) -> Result<Exit, Failure> {
        for file in &self.files {
            let text = fs::read_to_string(file).map_err(|e| Failure::io(file, &e))?;
            let study: Written = toml::from_str(&text).map_err(|e| {
                let remedy = "correct the place named; the studies shipped are examples";
                Failure::new(format!("{}: {e}", file.display()), remedy)
            })?;
            let name = file
                .file_stem()
                .map_or("study".into(), |n| n.to_string_lossy());
            let folder = self.out.join(name.as_ref());
            let there = fs::read_to_string(folder.join(COPY)).is_ok_and(|copy| copy == text);
            if self.resume && there {
                voice.say(&format!("{name}: there already"));
                continue;
            }
            fs::create_dir_all(&folder).map_err(|e| Failure::io(&folder, &e))?;
            voice.say(&format!("{name}: {}", study.title));
            run(&study, &folder, voice)?;
            write(&folder, COPY, text.as_bytes())?;
        }
        Ok(Exit::Done)
    }
}

fn run(study: &Written, folder: &Path, voice: Voice) -> Result<(), Failure> {
    let machine = study.machine();
    machine.check().map_err(|e| refused(&e))?;
    let (progress, mut done) = (Progress::new(voice, "study", study.parts()), 0);
    let mut tick = || {
        done += 1;
        progress.set(done, study.parts());
    };
    for plan in &study.time_series {
        time_series(&machine, plan, folder)?;
        tick();
    }
    for plan in &study.sweep {
        let text = sweep_csv(&machine, plan)?;
        write(folder, &format!("{}.csv", plan.name), text.as_bytes())?;
        tick();
    }
    for plan in &study.basins {
        let text = basins_csv(&machine, plan)?;
        write(folder, &format!("{}.csv", plan.name), text.as_bytes())?;
        tick();
    }
    if let Some(plan) = &study.regions {
        regions(&machine, plan, folder, voice)?;
        tick();
    }
    Ok(())
}

fn time_series(machine: &Machine, plan: &TimeSeries, folder: &Path) -> Result<(), Failure> {
    let period = plan.setting.period();
    let (skip, all) = (
        plan.skip_periods * period,
        (plan.skip_periods + plan.periods) * period,
    );
    let t = simulate(machine, plan.setting, plan.start, all).map_err(|e| refused(&e))?;
    let count = (plan.periods * plan.samples_per_period as f64).round() as usize;
    let taus = even((skip, all, count + 1));
    let mut text = String::from("tau,x,x_velocity,y,y_velocity,joined\n");
    for (tau, s) in taus.iter().zip(t.sample(taus.iter().copied())) {
        let joined = t.arc_at(*tau).is_some_and(|arc| arc.joined);
        let _ = writeln!(text, "{tau},{},{},{},{},{joined}", s.x, s.vx, s.y, s.vy);
    }
    write(folder, &format!("{}.csv", plan.name), text.as_bytes())?;
    let mut text = String::from(
        "tau,phase_rad,x_velocity_before,x_velocity_after,y_velocity_before,y_velocity_after,\
         closing_speed,dead_zone,kind\n",
    );
    for i in t.impacts.iter().filter(|i| i.tau >= skip) {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{:?}",
            i.tau,
            i.phase,
            i.vx_before,
            i.vx_after,
            i.vy_before,
            i.vy_after,
            i.closing_before,
            i.dead_zone,
            i.kind
        );
    }
    write(
        folder,
        &format!("{}-impacts.csv", plan.name),
        text.as_bytes(),
    )?;
    Ok(())
}

fn sweep_csv(machine: &Machine, plan: &SweepPlan) -> Result<String, Failure> {
    let eta = even((plan.eta.0, plan.eta.1, plan.steps));
    let rho = even((plan.rho.0, plan.rho.1, plan.steps));
    let steps: Vec<(f64, f64)> = eta.into_iter().zip(rho).collect();
    let back: Vec<(f64, f64)> = steps.iter().rev().copied().collect();
    let one = |steps| {
        let sweep_plan = Sweep {
            steps,
            start: plan.start,
            watch: plan.watch,
        };
        sweep(machine, &sweep_plan, |_| true).map_err(|e| refused(&e))
    };
    let (there, back) = rayon::join(|| one(steps), || one(back));
    let mut text = String::from(
        "direction,eta,rho,motion,x_max,y_max,lyapunov_exponent,closing_speeds,x_velocities_before\n",
    );
    for (direction, points) in [("forward", there?), ("backward", back?)] {
        for p in &points {
            let _ = writeln!(text, "{direction},{}", sweep_row(p));
        }
    }
    Ok(text)
}

fn sweep_row(p: &SweepPoint) -> String {
    let list = |l: &[f64]| l.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let exponent = p.lyapunov.map_or(String::new(), |l| l.to_string());
    let (closing, x) = (list(&p.closing_speeds), list(&p.x_speeds));
    let motion = label(p.motion);
    format!(
        "{},{},{motion},{},{},{exponent},{closing},{x}",
        p.eta, p.rho, p.x_max, p.y_max
    )
}

fn basins_csv(machine: &Machine, plan: &BasinPlan) -> Result<String, Failure> {
    let machine = match plan.restitution {
        Some(r) => machine.clone().with_restitution(Restitution::Constant(r)),
        None => machine.clone(),
    };
    let settings = MapSettings {
        watch: plan.watch,
        ..MapSettings::default()
    };
    let b = basins(&machine, plan.setting, &plan.grid, &settings).map_err(|e| refused(&e))?;
    let mut text = String::from("x,x_velocity,motion\n");
    for (i, cell) in b.cells.iter().enumerate() {
        let motion = cell.map_or("beyond contact".into(), label);
        let _ = writeln!(
            text,
            "{},{},{motion}",
            b.x[i % b.x.len()],
            b.vx[i / b.x.len()]
        );
    }
    Ok(text)
}

fn regions(machine: &Machine, plan: &Regions, folder: &Path, voice: Voice) -> Result<(), Failure> {
    let settings = AtlasSettings {
        grid: MapGrid::even(plan.eta, plan.rho),
        largest_p: plan.largest_p,
        largest_n: plan.largest_n,
        map: MapSettings::default(),
    };
    let regions = atlas(machine, &settings).map_err(|e| refused(&e))?;
    super::atlas::say(voice, &regions);
    write(folder, "curves.csv", curves_csv(&regions).as_bytes())?;
    write(
        folder,
        "map.csv",
        maps_csv(&settings.grid, &regions).as_bytes(),
    )?;
    Ok(())
}
