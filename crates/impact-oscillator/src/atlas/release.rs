//! Motions that rest in a dead zone, for machines of any kind: periodic orbits through a release.
//!
//! While the masses stay together X = ρ + J, Y = ρ − J, and they part where the relative
//! acceleration that they would have apart, X'' + Y'', falls to zero. So J and J' determine a release;
//! the drive's phase follows from them. A resting motion is a fixed point of the map from one
//! release to the one n drive periods later, found by Newton's method. With one mass, or two
//! equal ones, J has no part in it, and the release is a single state.

use std::collections::BTreeSet;

use nalgebra::{Matrix2, Vector2};

use super::edge::EdgeKind;
use crate::model::boundary::rho_sticking;
use crate::model::recurrence::observe;
use crate::model::simulate::{Arc, Sink};
use crate::model::{Flight, Initial, Machine, Oscillator, Setting, Simulator, Watch};

/// p and n.
pub(super) type Label = (u32, u32);

/// J and J'.
type Difference = Vector2<f64>;

/// A place in the plane: (η, ρ).
type Place = (f64, f64);

/// A state of a motion that rests: its p and n, the state, the drive's phase.
pub(super) type RestingStart = (Label, Initial, f64);

/// A resting motion at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rest {
    /// p and n.
    pub(super) label: Label,
    /// J and J' at the release.
    difference: Difference,
    /// Largest modulus of the release map's multipliers.
    multiplier: f64,
}

impl Rest {
    fn is_stable(&self) -> bool {
        self.multiplier < 1.0
    }
}

/// Where a run of equal labels ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RunEnd {
    /// The last place that shows it, to 1e-7.
    pub(super) at: Place,
    /// What ends it.
    pub(super) kind: EdgeKind,
}

/// Neighbouring points of a line that show one resting motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    /// p and n.
    pub(super) label: Label,
    /// First and last point.
    pub(super) points: (usize, usize),
    /// Its end before the first point; `None` where the line begins.
    pub(super) low: Option<RunEnd>,
    /// Its end behind the last point.
    pub(super) high: Option<RunEnd>,
}

/// Ends of runs are located to this.
const RESOLUTION: f64 = 1e-7;

/// Steps of Newton's method before it is given up.
const MOST_STEPS: usize = 12;

/// The resting motions of a machine up to a longest period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Releases<'a> {
    machine: &'a Machine,
    longest: u32,
}

/// Receives the releases of a simulation: τ, J and J' of each.
#[derive(Default)]
struct Seen {
    resting: Option<(f64, Difference)>,
    releases: Vec<(f64, Difference)>,
}

impl Sink for Seen {
    fn arc(&mut self, arc: &Arc) {
        if arc.sticking {
            let s = arc.paths.at(arc.duration);
            let difference = 0.5 * Difference::new(s.x - s.y, s.vx - s.vy);
            self.resting = Some((arc.tau + arc.duration, difference));
        } else {
            self.releases.extend(self.resting.take());
        }
    }
}

impl<'a> Releases<'a> {
    /// Of a machine, motions of at most `longest` drive periods. `None` where the flight is not
    /// harmonic.
    pub(super) fn new(machine: &'a Machine, longest: u32) -> Option<Self> {
        (machine.flight == Flight::Harmonic).then_some(Self { machine, longest })
    }

    /// All runs of resting motions along a line of points; motions that coexist have runs of
    /// their own. `starts` gives states that rest at a point: p and n, state and drive phase.
    pub(super) fn runs(
        &self,
        points: &[Place],
        starts: impl Fn(usize) -> Vec<RestingStart>,
    ) -> Vec<Run> {
        let mut rests: Vec<Vec<Rest>> = Vec::with_capacity(points.len());
        for (k, &at) in points.iter().enumerate() {
            let mut there = Vec::new();
            self.carry(at, rests.last().map_or(&[], Vec::as_slice), &mut there);
            self.reach(at, &starts(k), &mut there);
            rests.push(there);
        }
        for k in (1..points.len()).rev() {
            let (before, after) = rests.split_at_mut(k);
            self.carry(points[k - 1], &after[0], &mut before[k - 1]);
        }
        let labels: BTreeSet<Label> = rests.iter().flatten().map(|r| r.label).collect();
        let of = |label: Label| {
            let own = |there: &Vec<Rest>| there.iter().find(|r| r.label == label).copied();
            self.runs_of(points, &rests.iter().map(own).collect::<Vec<_>>())
        };
        labels.into_iter().flat_map(of).collect()
    }

    /// The runs of one motion, present at some points.
    fn runs_of(&self, points: &[Place], rests: &[Option<Rest>]) -> Vec<Run> {
        let mut runs = Vec::new();
        let mut first = 0;
        for k in 1..=points.len() {
            if k < points.len() && rests[k].is_some() == rests[first].is_some() {
                continue;
            }
            runs.extend(self.run(points, rests, (first, k - 1)));
            first = k;
        }
        runs
    }

    /// Add the motions into which those of a neighbour continue.
    fn carry(&self, at: Place, from: &[Rest], there: &mut Vec<Rest>) {
        for rest in from {
            let known = |l: Label| move |r: &Rest| r.label == l;
            if !there.iter().any(known(rest.label)) {
                let found = self.carried(at, rest);
                there.extend(found.filter(|f| f.label == rest.label));
            }
        }
    }

    /// Add the motions that starts lead to: the release without a difference, then the given.
    fn reach(&self, at: Place, starts: &[RestingStart], there: &mut Vec<Rest>) {
        if self.is_one_state() {
            there.extend(self.rest(at, self.longest, Difference::zeros()));
            there.dedup_by_key(|r| r.label);
            return;
        }
        if there.is_empty() {
            let released = self.start(at, Difference::zeros());
            let found = released.and_then(|(s, initial)| self.settled(at, initial, s.phase));
            there.extend(found.filter(Rest::is_stable));
        }
        for &(label, initial, phase) in starts {
            if label.1 <= self.longest && !there.iter().any(|r| r.label == label) {
                let found = self.settled(at, initial, phase).filter(Rest::is_stable);
                there.extend(found.filter(|f| f.label == label));
            }
        }
    }

    /// The run from a first to a last point with its ends; `None` where nothing rests.
    fn run(
        &self,
        points: &[Place],
        rests: &[Option<Rest>],
        (first, last): (usize, usize),
    ) -> Option<Run> {
        let (low, high) = (rests[first]?, rests[last]?);
        let before = first.checked_sub(1);
        let behind = points.get(last + 1);
        Some(Run {
            label: low.label,
            points: (first, last),
            low: before.map(|k| self.end(points[first], points[k], low)),
            high: behind.map(|&outside| self.end(points[last], outside, high)),
        })
    }

    /// The end of a run between a place that shows it and one that does not. What was too long a
    /// step for Newton's method is tried again from nearby.
    fn end(&self, mut inside: Place, outside: Place, mut rest: Rest) -> RunEnd {
        let far = |a: Place, b: Place| (a.0 - b.0).abs().max((a.1 - b.1).abs()) > RESOLUTION;
        let mut failed = vec![outside];
        while let Some(&outside) = failed.last() {
            let near = !far(inside, outside);
            if near && failed.len() == 1 {
                break;
            }
            let middle = (0.5 * (inside.0 + outside.0), 0.5 * (inside.1 + outside.1));
            let next = if near { outside } else { middle };
            match self.carried(next, &rest).filter(|r| r.label == rest.label) {
                Some(found) => {
                    (inside, rest) = (next, found);
                    failed.truncate(failed.len() - usize::from(near));
                }
                None if near => break,
                None => failed.push(middle),
            }
        }
        RunEnd {
            at: inside,
            kind: self.kind(inside, failed.last().copied().unwrap_or(outside), &rest),
        }
    }

    fn kind(&self, inside: Place, outside: Place, rest: &Rest) -> EdgeKind {
        let sticking = rho_sticking(self.machine, inside.0);
        let goes_on = self.continued(outside, rest);
        if inside.1 - sticking < 1e-5 * (1.0 + sticking.abs()) {
            EdgeKind::Sticking
        } else if goes_on.is_some_and(|r| r.label == rest.label && !r.is_stable()) {
            EdgeKind::Unstable
        } else {
            EdgeKind::DeadZone
        }
    }

    /// The stable resting motion that a neighbour's continues into.
    fn carried(&self, at: Place, from: &Rest) -> Option<Rest> {
        self.continued(at, from).filter(Rest::is_stable)
    }

    /// The same, stable or not.
    fn continued(&self, at: Place, from: &Rest) -> Option<Rest> {
        self.rest(at, from.label.1, from.difference)
    }

    /// The resting motion near to which a start settles.
    fn settled(&self, at: Place, initial: Initial, phase: f64) -> Option<Rest> {
        let setting = Setting::new(at.0, at.1).at_phase(phase);
        let mut simulator = Simulator::new(self.machine, setting, initial).ok()?;
        let mut seen = Seen::default();
        let turns = f64::from(2 * self.longest + 1);
        let settling = self.settling_periods(setting).max(turns);
        simulator.advance(settling * setting.period(), &mut seen);
        let (_, difference) = *seen.releases.last()?;
        // Newton's method does the rest
        let watch = Watch {
            watch_periods: turns,
            tolerance: 1e-3,
            ..Watch::default()
        };
        let (_, n) = observe(&mut simulator, setting, &watch).0.numbers(true)?;
        self.rest(at, n, difference)
    }

    /// Drive periods in which free vibrations fall to e⁻⁵, at most 200.
    fn settling_periods(&self, setting: Setting) -> f64 {
        let x = self.machine.x.decay_rate();
        let slowest = self.machine.y.as_ref().map_or(x, |y| x.min(y.decay_rate()));
        (5.0 / (slowest * setting.period())).min(200.0)
    }

    /// The resting motion of at most n drive periods near a difference at the release.
    fn rest(&self, at: Place, n: u32, guess: Difference) -> Option<Rest> {
        let (difference, multiplier) = self.fixed_point(at, n, guess)?;
        let (setting, initial) = self.start(at, difference)?;
        let mut simulator = Simulator::new(self.machine, setting, initial).ok()?;
        let watch = Watch {
            watch_periods: f64::from(2 * n + 1),
            ..Watch::default()
        };
        let label = observe(&mut simulator, setting, &watch).0.numbers(true)?;
        Some(Rest {
            label,
            difference,
            multiplier,
        })
    }

    /// Whether all releases are one state.
    fn is_one_state(&self) -> bool {
        self.machine.y.is_none() || self.machine.is_symmetric()
    }

    /// Setting (with its phase) and state of a release; `None`: the drive cannot part the masses.
    fn start(&self, (eta, rho): Place, difference: Difference) -> Option<(Setting, Initial)> {
        let (j, dj) = (difference[0], difference[1]);
        let held =
            |o: &Oscillator, x: f64, v: f64| 2.0 * o.decay_rate() * v + o.stiffness_per_mass() * x;
        let x = &self.machine.x;
        let mut drive = x.drive_per_mass();
        let mut held_back = held(x, rho + j, dj);
        let mut initial = Initial {
            x: rho + j,
            vx: dj,
            ..Initial::rest()
        };
        if let Some(y) = &self.machine.y {
            drive += y.drive_per_mass();
            held_back += held(y, rho - j, -dj);
            (initial.y, initial.vy) = (rho - j, -dj);
        }
        let cosine = held_back / drive;
        let setting = Setting::new(eta, rho).at_phase(cosine.acos());
        (-1.0..1.0).contains(&cosine).then_some((setting, initial))
    }

    /// J and J' at the release about n drive periods after another.
    fn turn(&self, at: Place, n: u32, difference: Difference) -> Option<Difference> {
        let (setting, initial) = self.start(at, difference)?;
        let mut simulator = Simulator::new(self.machine, setting, initial).ok()?;
        let (period, mut seen) = (setting.period(), Seen::default());
        simulator.advance((f64::from(n) + 0.5) * period, &mut seen);
        let off = |tau: f64| (tau - f64::from(n) * period).abs();
        let nearest = seen
            .releases
            .into_iter()
            .min_by(|a, b| off(a.0).total_cmp(&off(b.0)))?;
        (off(nearest.0) < 0.25 * period).then_some(nearest.1)
    }

    /// The fixed point of [`Self::turn`] by Newton's method, and the largest modulus of its
    /// multipliers.
    fn fixed_point(&self, at: Place, n: u32, guess: Difference) -> Option<(Difference, f64)> {
        if self.is_one_state() {
            return Some((Difference::zeros(), 0.0));
        }
        let mut z = guess;
        for _ in 0..MOST_STEPS {
            let image = self.turn(at, n, z)?;
            let slope = self.slope(at, n, (z, image))?;
            let change = (Matrix2::identity() - slope).lu().solve(&(image - z))?;
            z += change;
            if change.amax() < 1e-10 * (1.0 + z.amax()) {
                return Some((z, spectral_radius(&slope)));
            }
        }
        None
    }

    /// Slope of [`Self::turn`] at a difference whose image is known, by differences on the side
    /// on which the motion still rests.
    fn slope(&self, at: Place, n: u32, known: (Difference, Difference)) -> Option<Matrix2<f64>> {
        let (z, image) = known;
        let step = 1e-7 * (1.0 + z.amax());
        let mut slope = Matrix2::zeros();
        for k in 0..2 {
            let column = [step, -step].into_iter().find_map(|h| {
                let mut beside = z;
                beside[k] += h;
                Some((self.turn(at, n, beside)? - image) / h)
            })?;
            slope.set_column(k, &column);
        }
        Some(slope)
    }
}

fn spectral_radius(m: &Matrix2<f64>) -> f64 {
    let (half, determinant) = (0.5 * m.trace(), m.determinant());
    let square = half * half - determinant;
    if square < 0.0 {
        determinant.sqrt()
    } else {
        half.abs() + square.sqrt()
    }
}
