//! What a coordinate of the fit changes in the dimensionless machine, in its setting and in the
//! units of the channels.

use crate::parameters::Coordinate;
use impact_oscillator::model::params::{Machine, Oscillator};
use impact_oscillator::model::sensitivity::{Change, MassChange};

/// Change of machine and setting per unit of a record's own R, ln f0, ln β, ln `x_st` or of an
/// asymmetry, at η and a gap; all other coordinates change neither.
pub fn change(machine: &Machine, eta: f64, gap: f64, coordinate: Coordinate) -> Change {
    let none = Change::default();
    match coordinate {
        Coordinate::Restitution => Change {
            restitution: 1.0,
            ..none
        },
        Coordinate::Frequency => Change { eta: -eta, ..none },
        Coordinate::Deflection => Change { gap: -gap, ..none },
        Coordinate::Damping => both(machine, |_, o| MassChange {
            decay_rate: o.decay_rate(),
            ..MassChange::default()
        }),
        // A single mass carries no asymmetry.
        _ => machine
            .y
            .map(|y| apart(machine, &y, coordinate))
            .unwrap_or_default(),
    }
}

/// A change of both masses, of which the first has the sign +.
fn both(machine: &Machine, of: impl Fn(f64, &Oscillator) -> MassChange) -> Change {
    Change {
        x: of(1.0, &machine.x),
        y: machine.y.map(|o| of(-1.0, &o)).unwrap_or_default(),
        ..Change::default()
    }
}

/// Change of two masses per unit of an asymmetry, by which f0, β and `x_st` stay.
fn apart(machine: &Machine, y: &Oscillator, coordinate: Coordinate) -> Change {
    // What the means of deflections and of damping ratios stay by: tanh of half the logarithm of
    // their ratio.
    let unlike = |of: fn(&Oscillator) -> f64| {
        let (x, y) = (of(&machine.x), of(y));
        (x - y) / (x + y)
    };
    let deflection = unlike(|o| o.drive_per_mass() / o.stiffness_per_mass());
    let damping = unlike(|o| o.damping_ratio);
    match coordinate {
        Coordinate::DriveAsymmetry => both(machine, |sign, o| MassChange {
            drive_per_mass: 0.5 * (sign - deflection) * o.drive_per_mass(),
            ..MassChange::default()
        }),
        Coordinate::StiffnessAsymmetry => both(machine, |sign, o| MassChange {
            stiffness_per_mass: 0.5 * sign * o.stiffness_per_mass(),
            decay_rate: 0.25 * damping * o.decay_rate(),
            drive_per_mass: 0.5 * deflection * o.drive_per_mass(),
            ..MassChange::default()
        }),
        Coordinate::DampingAsymmetry => both(machine, |sign, o| MassChange {
            decay_rate: 0.5 * (sign - damping) * o.decay_rate(),
            ..MassChange::default()
        }),
        Coordinate::MassAsymmetry => both(machine, |sign, _| {
            let (x, y) = machine.mobility();
            MassChange {
                mobility: -sign * x * y,
                ..MassChange::default()
            }
        }),
        _ => Change::default(),
    }
}

/// Relative change of the unit of length per unit of a coordinate.
pub fn relative_length(coordinate: Coordinate) -> f64 {
    f64::from(u8::from(coordinate == Coordinate::Deflection))
}

/// Relative change of the unit of angular frequency per unit of a coordinate.
pub fn relative_rate(coordinate: Coordinate) -> f64 {
    f64::from(u8::from(coordinate == Coordinate::Frequency))
}
