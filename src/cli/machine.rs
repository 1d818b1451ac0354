//! Arguments that describe the dimensionless machine, shared by the verbs of the theory.

use clap::Args;

use super::Failure;
use crate::model::Machine;
use crate::model::params::Asymmetry;

/// The dimensionless machine.
#[derive(Debug, Clone, Args)]
pub struct MachineArgs {
    /// Coefficient of restitution R, 0 to 1
    #[arg(long, value_name = "R", default_value_t = 0.9)]
    pub restitution: f64,
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
    /// The machine, its parameters checked.
    ///
    /// # Errors
    /// [`Failure`] naming the parameter that is out of range.
    pub fn machine(&self) -> Result<Machine, Failure> {
        let asymmetry = Asymmetry {
            drive_amplitude: self.drive_ratio,
            stiffness: self.stiffness_ratio,
            mass: self.mass_ratio,
        };
        let machine = if self.single {
            Machine::single(self.damping_ratio, self.restitution)
        } else if asymmetry == Asymmetry::default() {
            Machine::symmetric(self.damping_ratio, self.restitution)
        } else {
            Machine::asymmetric(self.damping_ratio, self.restitution, asymmetry)
        };
        machine.check().map_err(|e| refused(&e))?;
        Ok(machine)
    }
}

/// A model's refusal as the user sees it.
pub fn refused(error: &crate::model::ModelError) -> Failure {
    Failure::new(
        error.to_string(),
        "give a value within the range that the message names",
    )
}

/// A motion z = p/n as text: `1`, `1/2`, `2/1`.
pub fn motion(text: &str) -> Result<(u32, u32), String> {
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
pub fn range(text: &str) -> Result<(f64, f64), String> {
    let wrong = || format!("“{text}” is no range: write low..high, such as 0.6..3");
    let (low, high) = text.split_once("..").ok_or_else(wrong)?;
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    match (number(low), number(high)) {
        (Some(low), Some(high)) if low < high => Ok((low, high)),
        _ => Err(wrong()),
    }
}
