//! What a coordinate of the fit changes in the dimensionless machine, in its setting and in the
//! units of the channels.

use crate::identify::fit::parameters::Coordinate;
use impact_oscillator::model::params::{Machine, Oscillator};
use impact_oscillator::model::sensitivity::{Change, MassChange};

/// Change of machine and setting per unit of a record's own R, ln f0, ln β, ln `x_st` or of an
/// asymmetry, at η and a gap; all other coordinates change neither.
pub fn change(machine: &Machine, eta: f64, gap: f64, coordinate: Coordinate) -> Change {
    let none = Change::default();
    let both = |of: &dyn Fn(f64, &Oscillator) -> MassChange| Change {
        x: of(1.0, &machine.x),
        y: machine.y.map(|o| of(-1.0, &o)).unwrap_or_default(),
        ..none
    };
    // A single mass carries no asymmetry.
    let half = if machine.y.is_some() { 0.5 } else { 0.0 };
    match coordinate {
        Coordinate::Restitution => Change {
            restitution: 1.0,
            ..none
        },
        Coordinate::Frequency => Change { eta: -eta, ..none },
        Coordinate::Deflection => Change { gap: -gap, ..none },
        Coordinate::Damping => both(&|_, o| MassChange {
            decay_rate: o.decay_rate(),
            ..MassChange::default()
        }),
        Coordinate::DriveAsymmetry => both(&|sign, _| MassChange {
            drive_per_mass: sign * half,
            ..MassChange::default()
        }),
        Coordinate::StiffnessAsymmetry => both(&|sign, _| MassChange {
            stiffness_per_mass: sign * half,
            ..MassChange::default()
        }),
        Coordinate::DampingAsymmetry => both(&|sign, _| MassChange {
            decay_rate: sign * half * mean_decay_rate(machine),
            ..MassChange::default()
        }),
        Coordinate::MassAsymmetry => both(&|sign, _| MassChange {
            mobility: -0.5 * sign * half,
            ..MassChange::default()
        }),
        _ => none,
    }
}

/// Mean of both masses' coefficients of damping.
fn mean_decay_rate(machine: &Machine) -> f64 {
    let x = machine.x.decay_rate();
    machine.y.map_or(x, |y| 0.5 * (x + y.decay_rate()))
}

/// Relative change of the unit of length per unit of a coordinate.
pub fn relative_length(coordinate: Coordinate) -> f64 {
    f64::from(u8::from(coordinate == Coordinate::Deflection))
}

/// Relative change of the unit of angular frequency per unit of a coordinate.
pub fn relative_rate(coordinate: Coordinate) -> f64 {
    f64::from(u8::from(coordinate == Coordinate::Frequency))
}
