//! Largest Lyapunov exponent of a simulated motion: variations mapped exactly through flights
//! and, by saltation matrices, through impacts and into dead zones.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Matrix4};

use crate::model::contact::free_accelerations;
use crate::model::flight::{Drive, State};
use crate::model::simulate::{Arc, Sink};
use crate::model::variation::{
    eigenvalues, free_flow, free_flow_of_one, saltation, saltation_of_one,
};
use crate::model::{Impact, ImpactKind, Machine, Restitution};

/// Stretches from whose scatter an exponent's error is taken.
const STRETCHES: usize = 20;

/// What becomes of a motion's variations, beyond the error of its exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variations {
    /// They grow: chaos.
    Grow,
    /// They decay: it converges.
    Decay,
    /// The exponent is not known well enough.
    Open,
}

/// Follows variations along a simulation; pass it to [`Simulator::advance`].
///
/// [`Simulator::advance`]: crate::Simulator::advance
///
/// ```
/// use impact_oscillator::atlas::Lyapunov;
/// use impact_oscillator::model::orbit::stable_orbit;
/// use impact_oscillator::{Impact, Initial, Machine, Setting, Simulator};
///
/// let machine = Machine::single(0.07, 0.9);
/// let setting = Setting::new(1.2, 2.0);
/// let mut simulator = Simulator::new(&machine, setting, Initial::rest())?;
/// simulator.advance(300.0 * setting.period(), &mut |_: &Impact| ());
/// let mut lyapunov = Lyapunov::new(&machine, setting.frequency_ratio);
/// simulator.advance(2000.0 * setting.period(), &mut lyapunov);
/// // a stable orbit has the logarithm of its largest multiplier per period
/// let orbit = stable_orbit(&machine, setting, 1)?.expect("z = 1");
/// let expected = orbit.multipliers[0].norm().ln() / setting.period();
/// assert!(expected < 0.0 && (lyapunov.exponent() - expected).abs() < 1e-3);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Lyapunov<'a> {
    machine: &'a Machine,
    eta: f64,
    /// What has become of a variation of each coordinate, as columns, over their size.
    variations: Matrix4<f64>,
    /// Logarithm of their size over that at the start.
    growth: f64,
    time: f64,
    /// Time and growth at the end of each drive period.
    periods: Vec<(f64, f64)>,
    before: State,
}

impl<'a> Lyapunov<'a> {
    /// Start with a variation of each coordinate.
    pub fn new(machine: &'a Machine, eta: f64) -> Self {
        let mut variations = Matrix4::identity();
        if machine.y.is_none() {
            variations
                .fixed_view_mut::<2, 2>(2, 2)
                .copy_from(&Matrix2::zeros());
        }
        Self {
            machine,
            eta,
            variations: variations.normalize(),
            growth: 0.0,
            time: 0.0,
            periods: Vec::new(),
            before: State::default(),
        }
    }

    /// Mean growth rate so far of all variations together, per unit of τ; −∞ where a dead zone wiped every one out.
    pub fn exponent(&self) -> f64 {
        if self.time > 0.0 {
            self.growth / self.time
        } else {
            0.0
        }
    }

    /// Growth rate of the greatest multiplier of what was followed: after whole periods of a periodic motion, in which
    /// variations also turn and swing, its exponent.
    pub(super) fn of_multiplier(&self) -> f64 {
        // the start was over its size
        let start = if self.machine.y.is_some() {
            4.0_f64
        } else {
            2.0
        };
        let multiplier = eigenvalues(self.machine, &self.variations)[0].norm() * start.sqrt();
        (self.growth + multiplier.ln()) / self.time
    }

    /// What becomes of variations, beyond the exponent's error.
    pub(super) fn variations(&self) -> Variations {
        let exponent = self.exponent();
        let error = self.standard_error().unwrap_or(f64::INFINITY);
        if exponent == f64::NEG_INFINITY || exponent + 2.0 * error < 0.0 {
            Variations::Decay
        } else if exponent - 2.0 * error > 0.0 {
            Variations::Grow
        } else {
            Variations::Open
        }
    }

    /// A free flight of one mass and the impact at its end on the stop, which is at x.
    pub(super) fn strike(&mut self, x: f64, impact: &Impact) {
        let drive = Drive {
            eta: self.eta,
            phase: impact.phase,
        };
        let state = |vx: f64| {
            let state = State {
                x,
                vx,
                ..State::default()
            };
            let (ax, _) = free_accelerations(self.machine, drive, &state);
            State { ax, ..state }
        };
        let (before, after) = (state(impact.vx_before), state(impact.vx_after));
        let flight = impact.tau - self.time;
        let flown =
            free_flow_of_one(&self.machine.x, flight) * self.variations.fixed_view::<2, 2>(0, 0);
        let struck = saltation_of_one(self.machine, &before, &after) * flown;
        self.pass(flight);
        let mut all = Matrix4::zeros();
        all.fixed_view_mut::<2, 2>(0, 0).copy_from(&struck);
        self.varied(all);
    }

    /// Time passes; at the end of a drive period the growth is noted.
    fn pass(&mut self, duration: f64) {
        if self.time * self.eta >= TAU * (self.periods.len() + 1) as f64 {
            self.periods.push((self.time, self.growth));
        }
        self.time += duration;
    }

    /// Standard error of [`Lyapunov::exponent`]: from the scatter of its mean over stretches of some drive periods;
    /// `None` where fewer than two stretches were followed.
    pub fn standard_error(&self) -> Option<f64> {
        let length = self.periods.len() / STRETCHES;
        let ends = std::iter::once(&(0.0, 0.0)).chain(&self.periods);
        let ends: Vec<&(f64, f64)> = ends.step_by(length.max(1)).collect();
        let rates: Vec<f64> = ends
            .windows(2)
            .map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0))
            .collect();
        let count = rates.len() as f64;
        let mean = rates.iter().sum::<f64>() / count;
        let squares: f64 = rates.iter().map(|r| (r - mean).powi(2)).sum();
        (rates.len() > 1).then(|| (squares / (count * (count - 1.0))).sqrt())
    }

    fn apply(&mut self, map: &Matrix4<f64>) {
        self.varied(map * self.variations);
    }

    /// The variations as they have become, whose growth is noted.
    fn varied(&mut self, variations: Matrix4<f64>) {
        self.variations = variations;
        let size = self.variations.norm();
        if size > 0.0 {
            self.growth += size.ln();
            self.variations /= size;
        } else {
            self.growth = f64::NEG_INFINITY;
        }
    }

    /// Into a dead zone: the impact's map with R = 0, relative motion gone.
    fn rest_map(&self, impact: &Impact, after: &State) -> Matrix4<f64> {
        let plastic = self
            .machine
            .clone()
            .with_restitution(Restitution::Constant(0.0));
        if impact.kind == ImpactKind::Stick && self.machine.y.is_some() {
            let (mx, my) = self.machine.mobility();
            let press = after.ax + after.ay;
            let rest = State {
                ax: after.ax - mx * press,
                ay: after.ay - my * press,
                ..*after
            };
            return saltation(&plastic, &self.before, &rest);
        }
        let (mx, my) = self.machine.mobility();
        let mut rest = Matrix4::identity();
        for (row, share) in [(0, mx), (1, mx), (2, my), (3, my)] {
            rest[(row, row % 2)] -= share;
            rest[(row, row % 2 + 2)] -= share;
        }
        rest
    }
}

impl Sink for Lyapunov<'_> {
    fn arc(&mut self, arc: &Arc) {
        self.pass(arc.duration);
        self.before = arc.paths.at(arc.duration);
        if !arc.sticking {
            self.apply(&free_flow(self.machine, arc.duration));
        } else if self.machine.is_symmetric() {
            // the common motion of joined equal masses is each mass's free vibration
            self.apply(&free_flow(self.machine, arc.duration));
        } else if let Some(y) = &self.machine.y {
            let decay = (self.machine.x.mass * self.machine.x.decay_rate()
                + y.mass * y.decay_rate())
                / (self.machine.x.mass + y.mass);
            self.apply(&(Matrix4::identity() * (-decay * arc.duration).exp()));
        }
    }

    fn impact(&mut self, impact: &Impact) {
        let drive = Drive {
            eta: self.eta,
            phase: impact.phase,
        };
        let mut after = State {
            vx: impact.vx_after,
            vy: impact.vy_after,
            ..self.before
        };
        (after.ax, after.ay) = free_accelerations(self.machine, drive, &after);
        let map = match impact.kind {
            ImpactKind::Stick | ImpactKind::ChatterEnd => self.rest_map(impact, &after),
            ImpactKind::Bounce | ImpactKind::Plastic => {
                saltation(self.machine, &self.before, &after)
            }
        };
        self.apply(&map);
    }
}
