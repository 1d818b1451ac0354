//! Arguments that describe the dimensionless machine, shared by the verbs of the theory.

use clap::Args;

use super::Failure;
use impact_oscillator::model::params::Asymmetry;
use impact_oscillator::model::{Initial, Machine, Restitution, Watch};
use impact_workbench::theory::Study;
use impact_workbench::theory::plan::RestitutionLaw;

/// The dimensionless machine.
#[derive(Debug, Clone, Args)]
pub(super) struct MachineArgs {
    /// Coefficient of restitution R, 0 to 1, or a law of the approach speed: `table = [[0, 0.95],
    /// [6, 0.85]]`, `power_law = {…}`, `exponential = {…}`
    #[arg(long, value_name = "R|LAW", default_value = "0.9", value_parser = law)]
    pub restitution: RestitutionLaw,
    /// Damping ratio β, from 0 to below 1
    #[arg(long, value_name = "B", default_value_t = 0.07)]
    pub damping_ratio: f64,
    /// One mass against a fixed stop instead of two against each other
    #[arg(long, conflicts_with_all = ["drive_ratio", "stiffness_ratio", "mass_ratio"])]
    pub single: bool,
    /// Drive amplitude of Y over that of X (eq. 13 of the paper: 0.95)
    #[arg(long, value_name = "A", default_value_t = 1.0)]
    pub drive_ratio: f64,
    /// Spring stiffness of Y over that of X (eq. 15 of the paper: 0.95)
    #[arg(long, value_name = "K", default_value_t = 1.0)]
    pub stiffness_ratio: f64,
    /// Mass of Y over that of X
    #[arg(long, value_name = "M", default_value_t = 1.0)]
    pub mass_ratio: f64,
}

impl MachineArgs {
    /// A study of the machine without any work, its parameters checked.
    ///
    /// # Errors
    /// [`Failure`] naming the parameter that is out of range.
    pub(super) fn study(&self, title: &str) -> Result<Study, Failure> {
        let study = Study {
            single: self.single,
            asymmetry: Asymmetry {
                drive_amplitude: self.drive_ratio,
                stiffness: self.stiffness_ratio,
                mass: self.mass_ratio,
            },
            ..Study::empty(title, self.damping_ratio, self.restitution.clone())
        };
        study.machine().check().map_err(|e| refused(&e))?;
        Ok(study)
    }

    /// The machine, its parameters checked.
    ///
    /// # Errors
    /// [`Failure`] naming the parameter that is out of range.
    pub(super) fn machine(&self) -> Result<Machine, Failure> {
        Ok(self.study("")?.machine())
    }
}

/// R as a number, or a law of the approach speed as a key and its value in TOML.
fn law(text: &str) -> Result<RestitutionLaw, String> {
    #[derive(serde::Deserialize)]
    struct Wrapped {
        law: Restitution,
    }
    if let Ok(r) = text.trim().parse::<f64>() {
        return Ok(RestitutionLaw::Constant(r));
    }
    toml::from_str::<Wrapped>(&format!("law = {{ {text} }}"))
        .map(|w| RestitutionLaw::Law(w.law))
        .map_err(|_| {
            format!(
                "“{text}” is neither a number nor a law: write 0.9, or a law such as \
                 table = [[0, 0.95], [6, 0.85]]"
            )
        })
}

/// The start of a motion.
#[derive(Debug, Clone, Args)]
pub(super) struct StartArgs {
    /// Start X, X' or X, X', Y, Y'; two numbers start both masses alike
    #[arg(
        long,
        value_name = "X,X'[,Y,Y']",
        default_value = "0,0",
        allow_hyphen_values = true
    )]
    pub start: String,
}

impl StartArgs {
    /// The start.
    ///
    /// # Errors
    /// [`Failure`] where the text is not two or four numbers.
    pub(super) fn initial(&self) -> Result<Initial, Failure> {
        let numbers: Result<Vec<f64>, _> =
            self.start.split(',').map(|n| n.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[x, vx]) => Ok(Initial::both(x, vx)),
            Ok(&[x, vx, y, vy]) => Ok(Initial { x, vx, y, vy }),
            _ => Err(Failure::new(
                format!("“{}” is no start", self.start),
                "write X,X' for both masses alike, or X,X',Y,Y', such as --start=-1,1.5,-3,2.5",
            )),
        }
    }
}

/// How long a motion settles and is watched.
#[derive(Debug, Clone, Args)]
pub(super) struct WatchArgs {
    /// Drive periods that a motion settles before it is observed
    #[arg(long, value_name = "N", default_value_t = 200.0)]
    pub settle_periods: f64,
    /// Drive periods observed
    #[arg(long, value_name = "N", default_value_t = 60.0)]
    pub watch_periods: f64,
}

impl WatchArgs {
    /// Settling and watch.
    pub(super) fn watch(&self) -> Watch {
        Watch {
            settle_periods: self.settle_periods.max(0.0),
            watch_periods: self.watch_periods.max(1.0),
            ..Watch::default()
        }
    }
}

/// A model's error as the user sees it.
pub(super) fn refused(error: &impact_oscillator::model::ModelError) -> Failure {
    Failure::new(
        error.to_string(),
        "give a value within the range that the message names",
    )
}

/// A motion z = p/n as text: `1`, `1/2`, `2/1`.
pub(super) fn motion(text: &str) -> Result<(u32, u32), String> {
    let number = |part: &str| match part.trim().parse::<u32>() {
        Ok(n) if (1..=64).contains(&n) => Ok(n),
        _ => Err(format!(
            "“{text}” is no motion: write p/n with p and n of 1 to 64, such as 1/2"
        )),
    };
    match text.split_once('/') {
        Some((p, n)) => Ok((number(p)?, number(n)?)),
        None => Ok((number(text)?, 1)),
    }
}

/// A range as text: `low..high`.
pub(super) fn range(text: &str) -> Result<(f64, f64), String> {
    let wrong = || format!("“{text}” is no range: write low..high, such as 0.6..3");
    let (low, high) = text.split_once("..").ok_or_else(wrong)?;
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    match (number(low), number(high)) {
        (Some(low), Some(high)) if low < high => Ok((low, high)),
        _ => Err(wrong()),
    }
}

/// A whole number from `LEAST` on.
pub(super) fn at_least<const LEAST: usize>(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| *n >= LEAST);
    number.ok_or_else(|| format!("write a whole number, {LEAST} or more"))
}
