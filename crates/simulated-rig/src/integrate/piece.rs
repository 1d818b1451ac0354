//! A smooth piece of motion: the state at its start and the rates of the motion from there.

use crate::equations::{ContactModel, Equations, Phase4};

/// Where the masses are relative to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touch {
    /// Apart.
    Apart,
    /// In a compliant contact that presses.
    Pressed,
    /// Still overlapping, but separating faster than the contact recovers.
    Recovering,
    /// Together after an instantaneous impact (dead zone).
    Joined,
}

/// Sliding direction of a mass under dry friction: 1, −1, or 0 while it sticks.
pub(super) type Direction = f64;

/// A smooth piece of motion from its start on.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) equations: Equations,
    /// Phase of the drive, rad.
    pub(super) phase: f64,
    /// [X, X', Y, Y'].
    pub(super) state: Phase4,
    pub(super) touch: Touch,
    pub(super) slides: [Direction; 2],
}

impl Piece {
    /// Forces on both masses beside friction.
    pub(super) fn forces(&self, drive: f64, s: &Phase4) -> [f64; 2] {
        let free = self.equations.free(drive, s);
        match (self.touch, &self.equations.law) {
            (Touch::Pressed, ContactModel::Compliant(c)) => {
                let press = c.press(self.equations.overlap(s), s[1] + s[3]);
                // The contact is that of two unit masses: on unlike ones with the same reduced mass.
                std::array::from_fn(|i| free[i] - 2.0 * self.equations.mobility[i] * press)
            }
            _ => free,
        }
    }

    pub(super) fn rate(&self, drive: f64, s: &Phase4) -> Phase4 {
        let friction = self.equations.friction;
        let forces = self.forces(drive, s);
        let mut a: [f64; 2] = std::array::from_fn(|i| {
            let sticks = friction > 0.0 && self.slides[i] == 0.0;
            if sticks {
                0.0
            } else {
                forces[i] - friction * self.slides[i]
            }
        });
        if self.touch == Touch::Joined {
            let [of_x, of_y] = self.equations.mobility;
            let together = of_y * a[0] - of_x * a[1];
            a = [together, -together];
        }
        [s[1], a[0], s[3], a[1]]
    }

    /// The state after a time, by one Runge–Kutta step: rates at its start, middle and end.
    pub(super) fn moved(&self, t: f64) -> Phase4 {
        let eta = self.equations.eta;
        let drive = |share: f64| self.equations.drive(self.phase + share * eta * t);
        let (p0, p1, p2) = (drive(0.0), drive(0.5), drive(1.0));
        let s = &self.state;
        let along = |k: &Phase4, h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let k1 = self.rate(p0, s);
        let k2 = self.rate(p1, &along(&k1, 0.5 * t));
        let k3 = self.rate(p1, &along(&k2, 0.5 * t));
        let k4 = self.rate(p2, &along(&k3, t));
        std::array::from_fn(|i| s[i] + t / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// Force that friction has to hold, per sliding mass.
    pub(super) fn pull(&self, mass: usize, drive: f64, s: &Phase4) -> f64 {
        let forces = self.forces(drive, s);
        if self.touch == Touch::Joined {
            let share = self.equations.mobility;
            share[1 - mass] * forces[mass] - share[mass] * forces[1 - mass]
        } else {
            forces[mass]
        }
    }
}
