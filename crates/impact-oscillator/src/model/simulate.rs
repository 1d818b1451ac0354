//! The motion from a start: flights, impacts, dead zones one after the other, each exact.

use std::f64::consts::TAU;

use super::contact::{self, ImpactKind, Impact, Outcome};
use super::crossing::first_zero;
use super::flight::{Drive, FlightPaths, State, free_flight, sticking_flight, press};
use super::params::{Initial, Machine, ModelError, Setting};

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

/// A motion that can be continued, with η and ρ changed on the way (quasi-stationary sweeps):
/// the drive's phase stays continuous.
#[derive(Debug, Clone)]
pub struct Simulator {
    machine: Machine,
    eta: f64,
    clearance: f64,
    tau: f64,
    phase: f64,
    state: State,
    sticking: bool,
    size: f64,
}

/// A motion at an instant, to go on from later.
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
        initial.check()?;
        let (y, vy) = if machine.y.is_some() {
            (initial.y, initial.vy)
        } else {
            (0.0, 0.0)
        };
        let state = State {
            x: initial.x,
            vx: initial.vx,
            y,
            vy,
            ..State::default()
        };
        let mut new = Self {
            machine: machine.clone(),
            eta: setting.frequency_ratio,
            clearance: setting.clearance,
            tau: 0.0,
            phase: setting.phase.rem_euclid(TAU),
            state,
            sticking: false,
            size: 0.0,
        };
        let depth = -new.gap_left();
        if depth > 1e-12 * (1.0 + state.x.abs() + state.y.abs()) {
            return Err(ModelError::StartsInContact { depth });
        }
        new.settle();
        Ok(new)
    }

    /// Everything that the rest of the motion depends on, beside the machine.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            eta: self.eta,
            clearance: self.clearance,
            tau: self.tau,
            phase: self.phase,
            state: self.state,
            sticking: self.sticking,
            size: self.size,
        }
    }

    /// Go on from a snapshot, bit for bit as if there had been no break.
    ///
    /// # Errors
    /// [`ModelError`] where the machine's parameters are out of range.
    pub fn resume(machine: &Machine, snapshot: &Snapshot) -> Result<Self, ModelError> {
        machine.check()?;
        Ok(Self {
            machine: machine.clone(),
            eta: snapshot.eta,
            clearance: snapshot.clearance,
            tau: snapshot.tau,
            phase: snapshot.phase,
            state: snapshot.state,
            sticking: snapshot.sticking,
            size: snapshot.size,
        })
    }

    /// The machine.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// τ reached.
    pub fn tau(&self) -> f64 {
        self.tau
    }

    /// Phase of the drive now, rad in [0, 2π).
    pub fn phase(&self) -> f64 {
        self.phase
    }

    /// Displacements, velocities and accelerations now.
    pub fn state(&self) -> State {
        self.paths().at(0.0)
    }

    /// Whether the masses stick together now.
    pub fn is_sticking(&self) -> bool {
        self.sticking
    }

    /// Go on with another frequency ratio and clearance; the drive's phase and the motion stay
    /// continuous. Where the smaller clearance cuts into the motion, the masses are set back to
    /// the contact, each by its mobility.
    pub fn set(&mut self, frequency_ratio: f64, clearance: f64) {
        (self.eta, self.clearance) = (frequency_ratio, clearance);
        if self.sticking {
            self.state = contact::sticking_state(&self.machine, clearance, &self.state);
        } else if self.gap_left() < 0.0 {
            self.state = contact::in_contact(&self.machine, clearance, &self.state);
        }
        self.settle();
    }

    /// Continue for a time in units of τ; the sink receives arcs and impacts in the order of time.
    pub fn advance(&mut self, duration: f64, sink: &mut impl Sink) {
        let end = self.tau + duration;
        while self.tau < end {
            if self.sticking {
                self.stay(end, sink);
            } else {
                self.fly(end, sink);
            }
        }
    }

    fn drive(&self) -> Drive {
        Drive {
            eta: self.eta,
            phase: self.phase,
        }
    }

    fn gap_left(&self) -> f64 {
        self.machine.gap(self.clearance) - self.state.x - self.state.y
    }

    fn paths(&self) -> FlightPaths {
        if self.sticking {
            sticking_flight(&self.machine, self.drive(), self.clearance, &self.state)
        } else {
            free_flight(&self.machine, self.drive(), &self.state)
        }
    }

    /// Let masses stick that are in contact without relative velocity and are pressed together.
    fn settle(&mut self) {
        let s = &self.state;
        let still = 1e-12 * (1.0 + s.x.abs() + s.y.abs() + s.vx.abs() + s.vy.abs());
        if self.sticking || self.gap_left() > still || (s.vx + s.vy).abs() > still {
            return;
        }
        let (ax, ay) = contact::free_accelerations(&self.machine, self.drive(), s);
        if ax + ay > 0.0 {
            self.sticking = true;
            self.state = contact::sticking_state(&self.machine, self.clearance, s);
        }
    }

    /// Move along an arc of a given length and report it; the last arc ends exactly at `end`.
    fn move_on(&mut self, paths: &FlightPaths, length: f64, end: f64, sink: &mut impl Sink) {
        let (tau, sticking, phase) = (self.tau, self.sticking, self.phase);
        sink.arc(&Arc {
            tau,
            duration: length,
            sticking,
            phase,
            paths: *paths,
        });
        self.state = paths.at(length);
        self.phase = (self.phase + self.eta * length).rem_euclid(TAU);
        self.tau = if length >= end - tau {
            end
        } else {
            tau + length
        };
    }

    fn fly(&mut self, end: f64, sink: &mut impl Sink) {
        let paths = self.paths();
        let gap = paths.gap(self.machine.gap(self.clearance));
        // on an incline a chatter's flights shrink without a scale of their own
        let known = if gap.is_bounded() { 0.0 } else { self.size };
        self.size = gap.size().max(known);
        let limit = (end - self.tau).min(paths.valid_for);
        match first_zero(&gap, limit) {
            Some(hit) => {
                self.move_on(&paths, hit.time, end, sink);
                self.impact(sink);
            }
            None => {
                self.move_on(&paths, limit, end, sink);
                if limit == paths.valid_for {
                    self.state.vx = 0.0;
                }
            }
        }
    }

    fn impact(&mut self, sink: &mut impl Sink) {
        let before = contact::in_contact(&self.machine, self.clearance, &self.state);
        let Outcome {
            after,
            kind,
            until_rest,
        } = contact::impact(&self.machine, self.drive(), &before, self.size);
        self.state = after;
        let sticks = matches!(kind, ImpactKind::Stick | ImpactKind::ChatterEnd);
        let mut dead_zone = 0.0;
        if sticks {
            self.sticking = true;
            self.state = contact::sticking_state(&self.machine, self.clearance, &after);
            let release =
                contact::release_time(&self.machine, self.drive(), self.clearance, &self.state);
            dead_zone = (release - until_rest).max(0.0);
        }
        sink.impact(&Impact {
            tau: self.tau + until_rest,
            phase: (self.phase + self.eta * until_rest).rem_euclid(TAU),
            vx_before: before.vx,
            vx_after: self.state.vx,
            vy_before: before.vy,
            vy_after: self.state.vy,
            approach_speed: (before.vx + before.vy).max(0.0),
            separation_speed: -(self.state.vx + self.state.vy),
            kind,
            dead_zone,
        });
    }

    fn stay(&mut self, end: f64, sink: &mut impl Sink) {
        let paths = self.paths();
        let press = press(&self.machine, self.drive(), &paths);
        if press.at(0.0)[0] <= 0.0 {
            self.sticking = false;
            return;
        }
        let limit = end - self.tau;
        match first_zero(&press, limit) {
            Some(release) => {
                self.move_on(&paths, release.time, end, sink);
                self.sticking = false;
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

/// Simulate a motion from a start for a time.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the start is beyond the contact.
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
