//! What happens at an impact: Newton's law with momentum conserved, plastic impacts with a dead zone
//! (eqs. 4–6 of the paper), and the end of a complete chatter.

use serde::{Deserialize, Serialize};

use super::crossing::first_zero;
use super::flight::{Drive, FlightPaths, State, press, sticking_flight, with_friction};
use super::params::{Flight, Machine, Oscillator};

/// What kind of impact it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ImpactKind {
    /// The masses separate again.
    Bounce,
    /// Plastic, but nothing presses the masses together: they separate without a dead zone (the
    /// paper's eq. 6).
    Plastic,
    /// Plastic, followed by a dead zone.
    Stick,
    /// The accumulation point of a complete chatter: infinitely many impacts in finite time,
    /// then a dead zone. It represents the infinitely many impacts that remain.
    ChatterEnd,
}

impl ImpactKind {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::Plastic => "plastic",
            Self::Stick => "stick",
            Self::ChatterEnd => "chatter_end",
        }
    }
}

/// One impact of a simulated motion, dimensionless; speeds in units of `x_st` Ω. All of it is exact,
/// unlike an impact that is detected in a measured signal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// τ of the impact.
    pub tau: f64,
    /// Phase of the drive there, rad in [0, 2π).
    pub phase: f64,
    /// X'₋
    pub vx_before: f64,
    /// X'₊
    pub vx_after: f64,
    /// Y'₋ (0 against a stop)
    pub vy_before: f64,
    /// Y'₊
    pub vy_after: f64,
    /// X'₋ + Y'₋, positive.
    pub approach_speed: f64,
    /// −(X'₊ + Y'₊) = R(X'₋ + Y'₋), not negative.
    pub separation_speed: f64,
    /// What kind of impact.
    pub kind: ImpactKind,
    /// Length of the dead zone that follows; 0 without one, infinite where it never ends.
    pub dead_zone: f64,
}

/// Displacement resolution, relative to the motion's size, below which a bounce is not distinguished
/// from rest.
const RESOLUTION: f64 = 1e-13;

/// Velocities after an impact: X'₊ = X'₋ − μ₁(1+R)w, Y'₊ = Y'₋ − μ₂(1+R)w with the approach
/// speed w and the mobilities μ of [`Machine::mobility`]: eq. (4).
fn newton(machine: &Machine, before: &State) -> State {
    let w = before.vx + before.vy;
    let change = (1.0 + machine.restitution().at(w)) * w;
    let (mx, my) = machine.mobility();
    State {
        vx: before.vx - mx * change,
        vy: before.vy - my * change,
        ..*before
    }
}

/// The states just before and just after an impact, from displacement and velocity of each mass
/// before it.
pub(crate) fn impact_pair(machine: &Machine, drive: Drive, at: [(f64, f64); 2]) -> (State, State) {
    let [(x, vx), (y, vy)] = at;
    let mut before = State {
        x,
        vx,
        y,
        vy,
        ..State::default()
    };
    (before.ax, before.ay) = free_accelerations(machine, drive, &before);
    let mut after = newton(machine, &before);
    (after.ax, after.ay) = free_accelerations(machine, drive, &after);
    (before, after)
}

/// Free accelerations of both masses in a state.
pub(crate) fn free_accelerations(machine: &Machine, drive: Drive, s: &State) -> (f64, f64) {
    if let Flight::ConstantForce {
        acceleration,
        friction,
    } = machine.flight
    {
        return (with_friction(acceleration, friction, s.vx).0, 0.0);
    }
    let cos = drive.phase.cos();
    let of = |o: &Oscillator, x: f64, v: f64| {
        o.drive_per_mass() * cos - 2.0 * o.decay_rate() * v - o.stiffness_per_mass() * x
    };
    (
        of(&machine.x, s.x, s.vx),
        machine.y.as_ref().map_or(0.0, |o| of(o, s.y, s.vy)),
    )
}

/// Whether an impact at a approach speed is plastic: R = 0 but for rounding.
pub(crate) fn is_plastic(machine: &Machine, approach_speed: f64) -> bool {
    machine.restitution().at(approach_speed) <= 1e-15
}

/// What the impact of a state at contact leads to: the state just after, the kind of impact, and the time
/// until a chatter has come to rest (0 for the other kinds). `size` is the motion's displacement scale.
///
/// A rebound that would not rise above the resolution while the masses are pressed together is
/// the end of a chatter: flights last 2v/a, speeds fall by R, so rest comes after
/// 2v/(a(1−R)), the sum of the geometric sequence.
pub(crate) fn impact(
    machine: &Machine,
    drive: Drive,
    before: &State,
    size: f64,
) -> (State, ImpactKind, f64) {
    let mut after = newton(machine, before);
    let (ax, ay) = free_accelerations(machine, drive, &after);
    (after.ax, after.ay) = (ax, ay);
    let press = ax + ay;
    let separation = -(after.vx + after.vy);
    let plastic = is_plastic(machine, before.vx + before.vy) || separation <= 0.0;
    let (kind, until_rest) = if plastic {
        (
            if press > 0.0 {
                ImpactKind::Stick
            } else {
                ImpactKind::Plastic
            },
            0.0,
        )
    } else if press > 0.0 && separation * separation <= 2.0 * press * RESOLUTION * size {
        (
            ImpactKind::ChatterEnd,
            rest_after(machine, separation, press),
        )
    } else {
        (ImpactKind::Bounce, 0.0)
    };
    (after, kind, until_rest)
}

/// Sum of the flights of a chatter, eq. (6), that starts with separation speed v under relative
/// acceleration a: Σ 2vₖ/a with vₖ₊₁ = R vₖ; on an incline each flight also loses to friction.
fn rest_after(machine: &Machine, v: f64, a: f64) -> f64 {
    let law = machine.restitution();
    let (r, stretch) = (law.at(v), law.chatter_stretch());
    if let Flight::ConstantForce {
        acceleration,
        friction,
    } = machine.flight
    {
        let (up, down) = (acceleration + friction, acceleration - friction);
        let kept = (down / up).sqrt();
        // friction makes the sequence geometric again
        let stretch = if friction > 0.0 { 1.0 } else { stretch };
        return stretch * v * (1.0 / up + kept / down) / (1.0 - r * kept);
    }
    stretch * 2.0 * v / (a * (1.0 - r))
}

/// The state with the masses exactly in contact; what rounding left over is shared by mobility.
pub(crate) fn in_contact(machine: &Machine, clearance: f64, s: &State) -> State {
    let (mx, my) = machine.mobility();
    let depth = s.x + s.y - machine.gap(clearance);
    State {
        x: s.x - mx * depth,
        y: s.y - my * depth,
        ..*s
    }
}

/// The state with the masses in contact and without relative velocity; momentum is kept.
pub(crate) fn sticking_state(machine: &Machine, clearance: f64, s: &State) -> State {
    let (mx, my) = machine.mobility();
    let w = s.vx + s.vy;
    State {
        vx: s.vx - mx * w,
        vy: s.vy - my * w,
        ..in_contact(machine, clearance, s)
    }
}

/// Time until the press force vanishes, from the start of a dead zone; infinite if it never
/// does. Free vibrations of the joined masses have decayed within the search.
pub(crate) fn release_time(machine: &Machine, drive: Drive, clearance: f64, s: &State) -> f64 {
    let paths: FlightPaths = sticking_flight(machine, drive, clearance, s);
    let path = press(machine, drive, &paths);
    let slowest = path
        .modes()
        .iter()
        .map(|m| -m.exponent.re)
        .fold(f64::INFINITY, f64::min);
    let period = std::f64::consts::TAU / drive.eta;
    let transient = if path.modes().is_empty() {
        0.0
    } else {
        (40.0 / slowest).min(1e4 * period)
    };
    let horizon = transient + 2.0 * period;
    first_zero(&path, horizon).unwrap_or(f64::INFINITY)
}
