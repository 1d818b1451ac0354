//! Soft contact as an alternative to Newton's law: a Kelvin–Voigt spring and damper that only
//! presses, F = max(0, κu + cu') where u = X + Y − 2ρ > 0 and nothing elsewhere. Piecewise
//! linear, so every phase is a closed form and its end a zero of a path.
//!
//! For one mass, or two with the same mass, spring and dashpot (drives may differ): there the
//! relative motion U = X + Y and V = X − Y do not couple.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::crossing::first_zero;
use super::error::range;
use super::flight::{Drive, FlightPaths, State, forced_amplitude, free_mode};
use super::params::{Flight, Initial, Machine, ModelError, Oscillator, Setting};
use super::path::{C64, Mode, Path};
use super::simulate::{Arc, Trajectory};

/// The contact's spring κ and damper c, in units of the nominal spring k and of √(km).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoftContact {
    /// κ, positive.
    pub stiffness: f64,
    /// c, not negative.
    pub damping: f64,
}

/// One contact of a motion with soft contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SoftImpact {
    /// τ at first touch.
    pub tau: f64,
    /// How long the contact presses.
    pub duration: f64,
    /// Approach speed at first touch.
    pub approach_speed: f64,
    /// Separation speed when the contact ends, not negative.
    pub separation_speed: f64,
}

/// A simulated motion with soft contacts; arcs with a contact are marked as sticking.
#[derive(Debug, Clone, Default)]
pub struct SoftMotion {
    /// The motion, exact at every instant; its list of rigid impacts is empty.
    pub trajectory: Trajectory,
    /// All contacts that have ended, in the order of time.
    pub contacts: Vec<SoftImpact>,
}

impl SoftContact {
    /// The contact of a given stiffness whose impacts, when short, have restitution R > 0.
    ///
    /// With contact damping ratio ζ the press ends at angle φ, cos φ = 2ζ² − 1, where the speed
    /// is −v e^{−ζφ/√(1−ζ²)}: R of an instantaneous contact.
    ///
    /// # Errors
    /// [`ModelError`] where R is not within 0 (excluded) and 1, or the stiffness not positive.
    pub fn with_restitution(machine: &Machine, stiffness: f64, r: f64) -> Result<Self, ModelError> {
        let least = restitution_of(1.0 - 1e-12);
        let expected = "0.1353 (critically damped contact) < R ≤ 1";
        range("restitution", r, least < r && r <= 1.0, expected)?;
        let (mut low, mut high) = (0.0, 1.0 - 1e-12);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if restitution_of(middle) > r {
                low = middle;
            } else {
                high = middle;
            }
        }
        let ratio = if r == 1.0 { 0.0 } else { 0.5 * (low + high) };
        let new = Self {
            stiffness,
            damping: 2.0 * ratio * (stiffness / compliance(machine)).sqrt(),
        };
        new.check()?;
        Ok(new)
    }

    fn check(&self) -> Result<(), ModelError> {
        let Self { stiffness, damping } = *self;
        range("stiffness", stiffness, stiffness > 0.0, "positive")?;
        range("damping", damping, damping >= 0.0, "not negative")
    }
}

/// R of a short contact of damping ratio ζ < 1.
fn restitution_of(ratio: f64) -> f64 {
    let root = (1.0 - ratio * ratio).sqrt();
    let angle = if ratio == 0.0 {
        PI
    } else {
        (2.0 * ratio * root).atan2(2.0 * ratio * ratio - 1.0)
    };
    (-ratio * angle / root).exp()
}

/// 1/m₁ + 1/m₂.
fn compliance(machine: &Machine) -> f64 {
    1.0 / machine.x.mass + machine.y.map_or(0.0, |y| 1.0 / y.mass)
}

/// In which phase the motion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Apart.
    Free,
    /// Pressed together.
    Pressed,
    /// Overlapping still, but separation faster than the contact recovers.
    Recovering,
}

struct Runner<'a> {
    machine: &'a Machine,
    contact: SoftContact,
    gap: f64,
    eta: f64,
    tau: f64,
    drive_phase: f64,
    state: State,
    phase: Phase,
    touch: Option<(f64, f64)>,
}

/// Simulate a motion with soft contact from a start over a duration in units of τ.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range, the masses differ in more than their
/// drives, or the start is beyond the contact.
///
/// ```
/// use impact_oscillator::model::soft::{SoftContact, simulate_soft};
/// use impact_oscillator::{Initial, Machine, Setting};
///
/// let machine = Machine::symmetric(0.07, 0.8);
/// let contact = SoftContact::with_restitution(&machine, 1e8, 0.8)?;
/// let motion = simulate_soft(&machine, contact, Setting::new(1.25, 1.0), Initial::rest(), 25.0)?;
/// let first = motion.contacts[0];
/// assert!((first.separation_speed / first.approach_speed - 0.8).abs() < 1e-3);
/// // half a period of the contact's vibration, π/√(2κ), shortened by its damper
/// assert!(first.duration < 2.3e-4);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn simulate_soft(
    machine: &Machine,
    contact: SoftContact,
    setting: Setting,
    initial: Initial,
    duration: f64,
) -> Result<SoftMotion, ModelError> {
    check(machine, contact, setting)?;
    let mut runner = Runner {
        machine,
        contact,
        gap: machine.gap(setting.clearance),
        eta: setting.frequency_ratio,
        tau: 0.0,
        drive_phase: setting.phase.rem_euclid(TAU),
        state: initial.state(machine, setting.clearance)?,
        phase: Phase::Free,
        touch: None,
    };
    let mut motion = SoftMotion::default();
    while runner.tau < duration {
        runner.step(duration, &mut motion);
    }
    Ok(motion)
}

fn check(machine: &Machine, contact: SoftContact, setting: Setting) -> Result<(), ModelError> {
    machine.check()?;
    contact.check()?;
    setting.check()?;
    let alike = |y: &Oscillator| {
        Oscillator {
            drive_amplitude: machine.x.drive_amplitude,
            ..*y
        } == machine.x
    };
    if machine.flight != Flight::Harmonic || !machine.y.as_ref().is_none_or(alike) {
        return Err(ModelError::Unsupported(
            "soft contact is for one mass, or two that differ in their drives alone, in harmonic flight",
        ));
    }
    Ok(())
}

impl Runner<'_> {
    fn drive(&self) -> Drive {
        Drive {
            eta: self.eta,
            phase: self.drive_phase,
        }
    }

    /// Paths of the phase: U with or without the contact's spring and damper, V free.
    fn paths(&self) -> FlightPaths {
        let (o, s) = (&self.machine.x, &self.state);
        let pressed = self.phase == Phase::Pressed;
        let force = self.machine.y.map_or(0.0, |y| y.drive_amplitude);
        let relative = Relative {
            oscillator: Oscillator {
                drive_amplitude: o.drive_amplitude + force,
                ..*o
            },
            added: if pressed {
                compliance(self.machine)
            } else {
                0.0
            },
            contact: self.contact,
            gap: self.gap,
        };
        let u = relative.path(self.drive(), s.x + s.y, s.vx + s.vy);
        if self.machine.y.is_none() {
            return FlightPaths::lasting(u, Path::constant(0.0, self.eta));
        }
        let apart = Relative {
            oscillator: Oscillator {
                drive_amplitude: o.drive_amplitude - force,
                ..*o
            },
            added: 0.0,
            ..relative
        };
        let v = apart.path(self.drive(), s.x - s.y, s.vx - s.vy);
        let (x, y) = (u.plus(1.0, &v).scaled(0.5), u.plus(-1.0, &v).scaled(0.5));
        FlightPaths::lasting(x, y)
    }

    /// The phase's paths, the next change within a time and the phase after it.
    fn step(&mut self, end: f64, motion: &mut SoftMotion) {
        let paths = self.paths();
        let limit = end - self.tau;
        let gap = paths.gap(self.gap);
        // κu + cu' with u = −gap
        let press = gap
            .scaled(-self.contact.stiffness)
            .plus(-self.contact.damping, &gap.derivative());
        let (change, next) = match self.phase {
            Phase::Free => (first_zero(&gap, limit), Phase::Pressed),
            Phase::Pressed => (first_zero(&press, limit), Phase::Recovering),
            Phase::Recovering => {
                let apart = first_zero(&gap.scaled(-1.0), limit);
                let again = first_zero(&press.scaled(-1.0), limit);
                match (apart, again) {
                    (Some(a), Some(b)) if b < a => (Some(b), Phase::Pressed),
                    (None, Some(b)) => (Some(b), Phase::Pressed),
                    (a, _) => (a, Phase::Free),
                }
            }
        };
        let length = change.unwrap_or(limit);
        motion.trajectory.arcs.push(Arc {
            tau: self.tau,
            duration: length,
            sticking: self.phase == Phase::Pressed,
            phase: self.drive_phase,
            paths,
        });
        self.state = paths.at(length);
        self.drive_phase = (self.drive_phase + self.eta * length).rem_euclid(TAU);
        self.tau = if length >= limit {
            end
        } else {
            self.tau + length
        };
        if change.is_some() {
            self.enter(next, motion);
        }
    }

    fn enter(&mut self, next: Phase, motion: &mut SoftMotion) {
        let approach = self.state.vx + self.state.vy;
        if next == Phase::Pressed {
            self.touch = Some((self.tau, approach));
        }
        if self.phase == Phase::Pressed
            && let Some((tau, approach_speed)) = self.touch.take()
        {
            let duration = self.tau - tau;
            let contact = SoftImpact {
                tau,
                duration,
                approach_speed,
                separation_speed: -approach,
            };
            motion.contacts.push(contact);
        }
        // without a damper the press ends where the overlap does
        let straight = next == Phase::Recovering && self.contact.damping == 0.0;
        self.phase = if straight { Phase::Free } else { next };
    }
}

/// The relative coordinate's linear equation, with the contact added or not.
#[derive(Debug, Clone, Copy)]
struct Relative {
    oscillator: Oscillator,
    added: f64,
    contact: SoftContact,
    gap: f64,
}

impl Relative {
    fn path(&self, drive: Drive, x0: f64, v0: f64) -> Path {
        let o = &self.oscillator;
        let stiffness = o.stiffness_per_mass() + self.added * self.contact.stiffness;
        let decay = o.decay_rate() + 0.5 * self.added * self.contact.damping;
        let mut path = Path::constant(
            self.added * self.contact.stiffness * self.gap / stiffness,
            drive.eta,
        );
        let free = o.stiffness_per_mass() - drive.eta * drive.eta;
        path.force = if self.added == 0.0 {
            forced_amplitude(o, drive)
        } else {
            let dynamic = C64::new(
                free + self.added * self.contact.stiffness,
                2.0 * decay * drive.eta,
            );
            C64::from_polar(o.drive_per_mass(), drive.phase) / dynamic
        };
        let x = x0 - path.force.re - path.polynomial[0];
        let v = v0 + drive.eta * path.force.im;
        for mode in modes(decay, stiffness, x, v) {
            path.add_mode(mode);
        }
        path
    }
}

/// Free modes of x'' + 2dx' + kx = 0 from (x, v): one complex, or two real where overdamped.
fn modes(decay: f64, stiffness: f64, x: f64, v: f64) -> Vec<Mode> {
    let square = stiffness - decay * decay;
    if square > 0.0 {
        return vec![free_mode(C64::new(-decay, square.sqrt()), x, v)];
    }
    let root = (-square).sqrt().max(1e-9 * decay);
    let (fast, slow) = (-decay - root, -decay + root);
    let a = (v - slow * x) / (fast - slow);
    [(a, fast), (x - a, slow)]
        .map(|(amplitude, exponent)| Mode {
            amplitude: C64::new(amplitude, 0.0),
            exponent: C64::new(exponent, 0.0),
        })
        .to_vec()
}

#[cfg(test)]
mod tests {
    use super::super::{orbit::stable_orbit, simulate};
    use super::*;

    #[test]
    fn valid_a_stiff_contact_is_the_rigid_one() {
        let machine = Machine::symmetric(0.07, 0.8);
        let setting = Setting::new(1.25, 1.0);
        let rigid = simulate(&machine, setting, Initial::rest(), 25.0).unwrap();
        let error = |stiffness: f64| {
            let soft = SoftContact::with_restitution(&machine, stiffness, 0.8).unwrap();
            let m = simulate_soft(&machine, soft, setting, Initial::rest(), 25.0).unwrap();
            (0..4)
                .map(|k| (m.contacts[k].tau - rigid.impacts[k].tau).abs())
                .fold(0.0, f64::max)
        };
        let errors: Vec<f64> = [1e4, 1e6, 1e8, 1e10].map(error).to_vec();
        // the contact lasts π/√(2κ): errors fall by ten for every hundredfold stiffness
        for pair in errors.windows(2) {
            assert!(
                pair[1] < 0.15 * pair[0] && pair[1] > 0.05 * pair[0],
                "{errors:?}"
            );
        }
    }

    #[test]
    fn valid_short_contacts_have_the_requested_restitution() {
        let machine = Machine::single(0.0, 0.5);
        for r in [0.2, 0.5, 0.9, 1.0] {
            let soft = SoftContact::with_restitution(&machine, 1e10, r).unwrap();
            let m = simulate_soft(&machine, soft, Setting::new(0.7, 0.4), Initial::rest(), 9.0)
                .unwrap();
            let c = m.contacts[0];
            assert!(
                (c.separation_speed / c.approach_speed - r).abs() < 1e-4,
                "{r} {c:?}"
            );
        }
    }

    #[test]
    fn the_motion_is_continuous_through_every_contact() {
        let machine = Machine::symmetric(0.05, 0.5);
        let soft = SoftContact {
            stiffness: 30.0,
            damping: 2.0,
        };
        let m = simulate_soft(
            &machine,
            soft,
            Setting::new(0.9, 0.5),
            Initial::rest(),
            80.0,
        )
        .unwrap();
        assert!(m.contacts.len() > 5);
        for pair in m.trajectory.arcs.windows(2) {
            let (a, b) = (pair[0].paths.at(pair[0].duration), pair[1].paths.at(0.0));
            assert!((a.x - b.x).abs() < 1e-12 && (a.vx - b.vx).abs() < 1e-12);
            assert!((pair[0].tau + pair[0].duration - pair[1].tau).abs() < 1e-12);
        }
        assert!(
            m.contacts
                .iter()
                .all(|c| c.approach_speed > 0.0 && c.duration > 0.0)
        );
    }

    #[test]
    fn a_stiff_orbit_settles_on_the_rigid_one() {
        let machine = Machine::symmetric(0.07, 0.8);
        let setting = Setting::new(1.25, 1.0);
        let orbit = stable_orbit(&machine, setting, 1).unwrap().unwrap();
        let soft = SoftContact::with_restitution(&machine, 1e9, 0.8).unwrap();
        let m = simulate_soft(&machine, soft, setting, Initial::rest(), 400.0).unwrap();
        let last = m.contacts.last().unwrap();
        assert!((last.approach_speed / orbit.approach_speed - 1.0).abs() < 1e-3);
    }
}
