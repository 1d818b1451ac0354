//! Machines that reduce to one mass, which the vector kernel marches.

use super::grid::{End, MapSettings, Start};
use super::kernel::{Cell, Course, Outcome};
use crate::model::{Flight, Initial, Machine, Oscillator};

/// A machine that is one mass of unit frequency, mass and drive in scaled quantities:
/// η' = η/Ω, lengths in units of (drive per mass)/Ω².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitMass {
    oscillator: Oscillator,
    restitution: f64,
}

impl UnitMass {
    /// `None` where the machine does not reduce to one mass with constant R.
    pub fn of(machine: &Machine) -> Option<Self> {
        let reduces = machine.y.is_none() || machine.is_symmetric();
        let restitution = machine.restitution().constant()?;
        let driven = machine.x.drive_amplitude > 0.0;
        (reduces && driven && machine.flight == Flight::Harmonic).then_some(Self {
            oscillator: machine.x,
            restitution,
        })
    }

    /// Length and rate by which the quantities are scaled.
    pub fn scales(&self) -> (f64, f64) {
        let o = &self.oscillator;
        (
            o.drive_per_mass() / o.stiffness_per_mass(),
            o.natural_frequency_ratio,
        )
    }

    /// The machine in the scaled quantities: one nominal mass against a stop.
    pub(super) fn machine(&self) -> Machine {
        Machine::single(self.oscillator.damping_ratio, self.restitution)
    }

    /// A cell in the scaled quantities.
    pub fn cell(&self, s: &Start) -> Cell {
        let (length, rate) = self.scales();
        Cell {
            eta: s.at.0 / rate,
            rho: s.at.1 / length,
            x: s.initial.x / length,
            v: s.initial.vx / (length * rate),
            phase: s.phase,
        }
    }

    /// Where an outcome ended, in the machine's own quantities.
    pub(super) fn end(&self, o: &Outcome) -> End {
        let (length, rate) = self.scales();
        let initial = Initial::both(o.end.x * length, o.end.v * length * rate);
        End {
            motion: o.motion,
            initial,
            phase: o.end.phase,
        }
    }

    /// The course of a map.
    pub fn course(&self, settings: &MapSettings) -> Course {
        Course {
            damping_ratio: self.oscillator.damping_ratio,
            restitution: self.restitution,
            settle_periods: settings.watch.settle_periods,
            watch_periods: settings.watch.watch_periods,
            leave_early: settings.leave_early,
            tight: 1e-11,
            loose: settings.watch.tolerance,
            every_impact: false,
        }
    }
}
