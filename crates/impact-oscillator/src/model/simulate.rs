//! The motion from a start: flights, impacts, dead zones one after the other, each exact.

use std::f64::consts::TAU;

use super::contact::{self, Impact, ImpactKind};
use super::crossing::first_zero;
use super::flight::{Drive, FlightPaths, State, free_flight, press, sticking_flight};
use super::params::{Initial, Machine, ModelError, Setting};
use crate::model::patience;

/// Pieces of motion between two looks at whether it is still wanted.
const BETWEEN_LOOKS: u32 = 256;

/// A piece of the motion between two events.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// τ at its start.
    pub tau: f64,
    /// How long it lasts.
    pub duration: f64,
    /// Whether the masses stick together in it (a dead zone).
    pub sticking: bool,
    /// Phase of the drive at its start, rad.
    pub phase: f64,
    /// Displacements in time since its start.
    pub paths: FlightPaths,
}

/// Receives what a simulation produces, in the order of time.
pub trait Sink {
    /// A finished piece of motion.
    fn arc(&mut self, _arc: &Arc) {}
    /// An impact.
    fn impact(&mut self, _impact: &Impact) {}
}

impl<F: FnMut(&Impact)> Sink for F {
    fn impact(&mut self, impact: &Impact) {
        self(impact);
    }
}

/// A motion that can be continued, with η and ρ changed between (quasi-stationary sweeps): the
/// drive's phase stays continuous.
///
/// ```
/// use impact_oscillator::{Impact, Initial, Machine, Setting, Simulator};
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// let setting = Setting::new(1.2, 6.0);
/// let mut simulator = Simulator::new(&machine, setting, Initial::rest())?;
/// // far above grazing, ρ'(1.2) = 2.123
/// simulator.advance(200.0 * setting.period(), &mut |_: &Impact| unreachable!());
/// // with a smaller clearance it hits once per drive period
/// simulator.set(1.2, 2.0);
/// simulator.advance(300.0 * setting.period(), &mut |_: &Impact| ());
/// simulator.advance(1.0 * setting.period(), &mut |i: &Impact| {
///     assert!((i.approach_speed - 2.0 * 2.413_516).abs() < 1e-5);
/// });
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulator {
    machine: Machine,
    now: Snapshot,
}

/// A motion at an instant: everything that the rest of it depends on, beside the machine.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Snapshot {
    eta: f64,
    clearance: f64,
    tau: f64,
    phase: f64,
    state: State,
    sticking: bool,
    size: f64,
}

impl Simulator {
    /// Start a motion at τ = 0. Masses that start in contact, at rest and pressed together
    /// start sticking.
    ///
    /// # Errors
    /// [`ModelError`] where a parameter is out of range or the start is beyond the contact.
    pub fn new(machine: &Machine, setting: Setting, initial: Initial) -> Result<Self, ModelError> {
        machine.check()?;
        setting.check()?;
        let now = Snapshot {
            eta: setting.frequency_ratio,
            clearance: setting.clearance,
            tau: 0.0,
            phase: setting.phase.rem_euclid(TAU),
            state: initial.state(machine, setting.clearance)?,
            sticking: false,
            size: 0.0,
        };
        let machine = machine.clone();
        let mut new = Self { machine, now };
        new.settle();
        Ok(new)
    }

    /// The motion now.
    pub fn snapshot(&self) -> Snapshot {
        self.now
    }

    /// Continue from a snapshot, bit for bit as without a break.
    ///
    /// # Errors
    /// [`ModelError`] where the machine's parameters are out of range.
    pub fn resume(machine: &Machine, snapshot: &Snapshot) -> Result<Self, ModelError> {
        machine.check()?;
        Ok(Self {
            machine: machine.clone(),
            now: *snapshot,
        })
    }

    /// The machine.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// τ reached.
    pub fn tau(&self) -> f64 {
        self.now.tau
    }

    /// Phase of the drive now, rad in [0, 2π).
    pub fn phase(&self) -> f64 {
        self.now.phase
    }

    /// Displacements, velocities and accelerations now.
    pub fn state(&self) -> State {
        self.paths().at(0.0)
    }

    /// Whether the masses stick together now.
    pub fn is_sticking(&self) -> bool {
        self.now.sticking
    }

    /// Go on with another frequency ratio and clearance; the drive's phase and the motion stay
    /// continuous. Where the smaller clearance cuts into the motion, the masses are set back to
    /// the contact, each by its mobility.
    pub fn set(&mut self, frequency_ratio: f64, clearance: f64) {
        (self.now.eta, self.now.clearance) = (frequency_ratio, clearance);
        if self.now.sticking {
            self.now.state = contact::sticking_state(&self.machine, clearance, &self.now.state);
        } else if self.gap_left() < 0.0 {
            self.now.state = contact::in_contact(&self.machine, clearance, &self.now.state);
        }
        self.settle();
    }

    /// Continue for a time in units of τ; the sink receives arcs and impacts in the order of time. Under a
    /// [`Patience`](crate::Patience) that is over it stops where it is.
    pub fn advance(&mut self, duration: f64, sink: &mut impl Sink) {
        let end = self.now.tau + duration;
        let mut pieces = 0_u32;
        while self.now.tau < end {
            if pieces.is_multiple_of(BETWEEN_LOOKS) && patience::is_over() {
                self.now.tau = end;
                return;
            }
            pieces = pieces.wrapping_add(1);
            if self.now.sticking {
                self.stay(end, sink);
            } else {
                self.fly(end, sink);
            }
        }
    }

    fn drive(&self) -> Drive {
        Drive {
            eta: self.now.eta,
            phase: self.now.phase,
        }
    }

    fn gap_left(&self) -> f64 {
        self.machine.gap(self.now.clearance) - self.now.state.x - self.now.state.y
    }

    fn paths(&self) -> FlightPaths {
        if self.now.sticking {
            sticking_flight(
                &self.machine,
                self.drive(),
                self.now.clearance,
                &self.now.state,
            )
        } else {
            free_flight(&self.machine, self.drive(), &self.now.state)
        }
    }

    /// Let masses stick that are in contact without relative velocity and are pressed together.
    fn settle(&mut self) {
        let s = &self.now.state;
        let still = 1e-12 * (1.0 + s.x.abs() + s.y.abs() + s.vx.abs() + s.vy.abs());
        if self.now.sticking || self.gap_left() > still || (s.vx + s.vy).abs() > still {
            return;
        }
        let (ax, ay) = contact::free_accelerations(&self.machine, self.drive(), s);
        if ax + ay > 0.0 {
            self.now.sticking = true;
            self.now.state = contact::sticking_state(&self.machine, self.now.clearance, s);
        }
    }

    /// Move along an arc of a given length and report it; the last arc ends exactly at `end`.
    fn move_on(&mut self, paths: &FlightPaths, length: f64, end: f64, sink: &mut impl Sink) {
        let (tau, sticking, phase) = (self.now.tau, self.now.sticking, self.now.phase);
        sink.arc(&Arc {
            tau,
            duration: length,
            sticking,
            phase,
            paths: *paths,
        });
        self.now.state = paths.at(length);
        self.now.phase = (self.now.phase + self.now.eta * length).rem_euclid(TAU);
        self.now.tau = if length >= end - tau {
            end
        } else {
            tau + length
        };
    }

    fn fly(&mut self, end: f64, sink: &mut impl Sink) {
        let paths = self.paths();
        let gap = paths.gap(self.machine.gap(self.now.clearance));
        // on an incline a chatter's flights shrink without a scale of their own
        let known = if gap.is_bounded() { 0.0 } else { self.now.size };
        self.now.size = gap.size().max(known);
        let limit = (end - self.now.tau).min(paths.valid_for);
        match first_zero(&gap, limit) {
            Some(time) => {
                self.move_on(&paths, time, end, sink);
                self.impact(sink);
            }
            None => {
                self.move_on(&paths, limit, end, sink);
                if limit == paths.valid_for {
                    self.now.state.vx = 0.0;
                }
            }
        }
    }

    fn impact(&mut self, sink: &mut impl Sink) {
        let before = contact::in_contact(&self.machine, self.now.clearance, &self.now.state);
        let (after, kind, until_rest) =
            contact::impact(&self.machine, self.drive(), &before, self.now.size);
        self.now.state = after;
        let sticks = matches!(kind, ImpactKind::Stick | ImpactKind::ChatterEnd);
        let mut dead_zone = 0.0;
        if sticks {
            self.now.sticking = true;
            self.now.state = contact::sticking_state(&self.machine, self.now.clearance, &after);
            let release = contact::release_time(
                &self.machine,
                self.drive(),
                self.now.clearance,
                &self.now.state,
            );
            dead_zone = (release - until_rest).max(0.0);
        }
        sink.impact(&Impact {
            tau: self.now.tau + until_rest,
            phase: (self.now.phase + self.now.eta * until_rest).rem_euclid(TAU),
            vx_before: before.vx,
            vx_after: self.now.state.vx,
            vy_before: before.vy,
            vy_after: self.now.state.vy,
            approach_speed: (before.vx + before.vy).max(0.0),
            separation_speed: -(self.now.state.vx + self.now.state.vy),
            kind,
            dead_zone,
        });
    }

    fn stay(&mut self, end: f64, sink: &mut impl Sink) {
        let paths = self.paths();
        let press = press(&self.machine, self.drive(), &paths);
        if press.at(0.0)[0] <= 0.0 {
            self.now.sticking = false;
            return;
        }
        let limit = end - self.now.tau;
        match first_zero(&press, limit) {
            Some(time) => {
                self.move_on(&paths, time, end, sink);
                self.now.sticking = false;
            }
            None => self.move_on(&paths, limit, end, sink),
        }
    }
}

/// A simulated motion, exact at every instant.
#[derive(Debug, Clone, Default)]
pub struct Trajectory {
    /// Pieces of motion in the order of time, without a gap between them.
    pub arcs: Vec<Arc>,
    /// All impacts in the order of time.
    pub impacts: Vec<Impact>,
}

impl Sink for Trajectory {
    fn arc(&mut self, arc: &Arc) {
        self.arcs.push(*arc);
    }
    fn impact(&mut self, impact: &Impact) {
        self.impacts.push(*impact);
    }
}

impl Trajectory {
    /// The motion at a time; before the first and after the last arc that arc is continued as
    /// if no impact came. An instant of impact belongs to the arc that follows.
    pub fn at(&self, tau: f64) -> State {
        self.arc_at(tau)
            .map_or(State::default(), |arc| arc.paths.at(tau - arc.tau))
    }

    /// The arc that holds a time.
    pub fn arc_at(&self, tau: f64) -> Option<&Arc> {
        let after = self.arcs.partition_point(|arc| arc.tau <= tau);
        self.arcs.get(after.saturating_sub(1))
    }

    /// τ at the end.
    pub fn end(&self) -> f64 {
        self.arcs.last().map_or(0.0, |arc| arc.tau + arc.duration)
    }

    /// The motion at many times in rising order, faster than one by one.
    pub fn sample(&self, taus: impl IntoIterator<Item = f64>) -> Vec<State> {
        let mut k = 0;
        let at = |tau: f64| {
            while k + 1 < self.arcs.len() && self.arcs[k + 1].tau <= tau {
                k += 1;
            }
            self.arcs
                .get(k)
                .map_or(State::default(), |arc| arc.paths.at(tau - arc.tau))
        };
        taus.into_iter().map(at).collect()
    }
}

/// Simulate a motion from a start over a duration in units of τ. The result is exact at every
/// instant: flights by eq. (2), the next impact by eq. (3), impacts by eq. (4).
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the start is beyond the contact.
///
/// ```
/// use impact_oscillator::{ImpactKind, Initial, Machine, Setting, simulate};
/// use std::f64::consts::PI;
///
/// // Fig. 2 of the paper: plastic impacts, three of which open a dead zone
/// let machine = Machine::symmetric(0.1, 0.0);
/// let setting = Setting { phase: PI / 4.0, ..Setting::new(0.95, 0.7) };
/// let start = Initial { x: -1.0, vx: 1.5, y: -3.0, vy: 2.5 };
/// let motion = simulate(&machine, setting, start, 3.0 * setting.period())?;
/// let expected = [(0.1589, 4.9422), (0.8846, 4.6027), (1.8677, 4.4129), (2.8677, 4.4129)];
/// assert_eq!(motion.impacts.len(), expected.len());
/// for (impact, (periods, speed)) in motion.impacts.iter().zip(expected) {
///     assert!((impact.tau / setting.period() - periods).abs() < 6e-5);
///     assert!((impact.approach_speed - speed).abs() < 6e-5);
/// }
/// assert_eq!(motion.impacts[3].kind, ImpactKind::Stick);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn simulate(
    machine: &Machine,
    setting: Setting,
    initial: Initial,
    duration: f64,
) -> Result<Trajectory, ModelError> {
    let mut trajectory = Trajectory::default();
    Simulator::new(machine, setting, initial)?.advance(duration, &mut trajectory);
    Ok(trajectory)
}
