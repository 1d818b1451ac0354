//! Motion of a rig with effects beyond the model, by the classical Runge–Kutta method of fourth
//! order between events: impacts, ends of contact, turns of a mass under dry friction. Each event
//! is located to rounding, so no step crosses a discontinuity.

use std::f64::consts::TAU;

mod events;
mod piece;
mod recording;

use super::equations::{ContactModel, Equations, Phase4};
use events::{Event, SHORTEST};
use piece::{Piece, Touch};
use recording::Segment;
pub(super) use recording::{Hit, Recording};

/// Steps in a period of the drive or of the natural vibration, whichever is shorter.
const STEPS_PER_PERIOD: f64 = 200.0;
/// Steps in a contact of finite duration.
const STEPS_PER_CONTACT: f64 = 30.0;
/// Separation speed of an instantaneous impact below which pressed masses stay together.
const STICKS_BELOW: f64 = 1e-6;

/// A motion that can be continued with other coefficients; phase and motion stay continuous unless
/// the phase is shifted.
#[derive(Debug, Clone)]
pub struct Integrator {
    piece: Piece,
    tau: f64,
    recording: Option<Recording>,
    touched_at: f64,
    hits: usize,
    dead_zones: usize,
}

impl Integrator {
    /// Both masses at rest, the drive at phase 0.
    pub fn at_rest(equations: Equations) -> Self {
        let mut new = Self {
            piece: Piece {
                equations,
                phase: 0.0,
                state: [0.0; 4],
                touch: Touch::Apart,
                slides: [0.0; 2],
            },
            tau: 0.0,
            recording: None,
            touched_at: 0.0,
            hits: 0,
            dead_zones: 0,
        };
        new.turn(0);
        new.turn(1);
        new
    }

    /// Continue with other coefficients.
    pub fn set(&mut self, equations: Equations) {
        self.piece.equations = equations;
    }

    /// Let the drive's phase jump, rad.
    pub fn shift_phase(&mut self, jump_rad: f64) {
        self.piece.phase = (self.piece.phase + jump_rad).rem_euclid(TAU);
        for mass in 0..2 {
            if self.piece.slides[mass] == 0.0 && self.piece.state[2 * mass + 1] == 0.0 {
                self.turn(mass);
            }
        }
    }

    /// How the masses act on each other.
    pub fn law(&self) -> ContactModel {
        self.piece.equations.law
    }

    /// Dimensionless time.
    pub fn tau(&self) -> f64 {
        self.tau
    }

    /// Phase of the drive, rad in [0, 2π).
    pub fn phase(&self) -> f64 {
        self.piece.phase
    }

    /// [X, X', Y, Y'].
    pub fn state(&self) -> Phase4 {
        self.piece.state
    }

    /// Impacts since the start, and those with a dead zone.
    pub fn counts(&self) -> [usize; 2] {
        [self.hits, self.dead_zones]
    }

    /// Continue for a time.
    pub fn advance(&mut self, duration: f64) {
        let end = self.tau + duration;
        while self.tau < end - SHORTEST {
            self.step(end - self.tau);
        }
    }

    /// Continue for a time and record it.
    pub fn record(&mut self, duration: f64) -> Recording {
        self.recording = Some(Recording::default());
        self.advance(duration);
        self.recording.take().unwrap_or_default()
    }

    /// One step of at most `limit`, shorter if an event comes first.
    fn step(&mut self, limit: f64) {
        let mut length = self.usual_step().min(limit);
        let mut to = self.piece.moved(length);
        if let Some(apex) = self.grazing(length, &to) {
            (length, to) = (apex, self.piece.moved(apex));
        }
        let mut happening = None;
        for event in Event::ALL {
            if let Some(crossing) = self.piece.crossing(event, length, &to) {
                length = crossing.length;
                to = self.piece.moved(length);
                happening = crossing.fires.then_some(event);
            }
        }
        self.move_to(length, to);
        if let Some(event) = happening {
            self.happen(event);
        }
    }

    fn usual_step(&self) -> f64 {
        let smooth = TAU / self.piece.equations.eta.max(1.0) / STEPS_PER_PERIOD;
        match (self.piece.touch, &self.piece.equations.law) {
            (Touch::Pressed | Touch::Recovering, ContactModel::Compliant(c)) => {
                smooth.min(c.duration / STEPS_PER_CONTACT)
            }
            _ => smooth,
        }
    }

    fn move_to(&mut self, length: f64, to: Phase4) {
        let phase = self.piece.phase + self.piece.equations.eta * length;
        if self.recording.is_some() {
            let segment = Segment {
                tau: self.tau,
                length,
                from: self.piece.state,
                from_rate: self.piece.rate(
                    self.piece.equations.drive(self.piece.phase),
                    &self.piece.state,
                ),
                to,
                to_rate: self.piece.rate(self.piece.equations.drive(phase), &to),
            };
            if let Some(recording) = &mut self.recording {
                recording.segments.push(segment);
            }
        }
        self.tau += length;
        self.piece.phase = phase.rem_euclid(TAU);
        self.piece.state = to;
    }

    /// Time within a step at which masses that nearly touch come closest, if they overlap there:
    /// both ends of such a step are apart.
    fn grazing(&self, length: f64, to: &Phase4) -> Option<f64> {
        let (from, e) = (&self.piece.state, &self.piece.equations);
        let (closing, opening) = (from[1] + from[3], to[1] + to[3]);
        if self.piece.touch != Touch::Apart
            || closing <= 0.0
            || opening >= 0.0
            || e.overlap(to) > 0.0
        {
            return None;
        }
        let apex = closing / (closing - opening) * length;
        let near = e.overlap(from) + 0.75 * closing * apex > 0.0;
        (near && e.overlap(&self.piece.moved(apex)) > 0.0).then_some(apex)
    }

    fn happen(&mut self, event: Event) {
        match (event, self.piece.touch, self.piece.equations.law) {
            (Event::TurnX, ..) => self.turn(0),
            (Event::TurnY, ..) => self.turn(1),
            (Event::PressedAgain, ..) => self.piece.touch = Touch::Pressed,
            (Event::Contact, Touch::Apart, ContactModel::Newton(r)) => self.bounce(r),
            (Event::Contact, Touch::Apart, ContactModel::Compliant(_)) => {
                self.begin_hit();
                self.piece.touch = Touch::Pressed;
            }
            (Event::Contact, Touch::Pressed, ContactModel::Compliant(c)) => {
                let overlaps =
                    c.damping > 0.0 && self.piece.equations.overlap(&self.piece.state) > 0.0;
                self.piece.touch = if overlaps {
                    Touch::Recovering
                } else {
                    Touch::Apart
                };
                self.end_hit(3.0 * c.duration);
            }
            (Event::Contact, Touch::Joined, _) => {
                self.piece.touch = Touch::Apart;
                self.end_hit(0.0);
            }
            (Event::Contact, ..) => self.piece.touch = Touch::Apart,
        }
    }

    /// An instantaneous impact by Newton's law.
    fn bounce(&mut self, restitution: f64) {
        self.begin_hit();
        let approach = self.piece.state[1] + self.piece.state[3];
        let drive = self.piece.equations.drive(self.piece.phase);
        let forces = self.piece.forces(drive, &self.piece.state);
        let sticks = restitution * approach < STICKS_BELOW && forces[0] + forces[1] > 0.0;
        let ratio = if sticks { 0.0 } else { restitution };
        let [of_x, of_y] = self.piece.equations.mobility;
        let change = (1.0 + ratio) * approach;
        self.piece.state[1] -= of_x * change;
        self.piece.state[3] -= of_y * change;
        for mass in [0, 1] {
            self.piece.slides[mass] = self.piece.state[2 * mass + 1].signum();
        }
        if sticks {
            self.piece.touch = Touch::Joined;
        } else {
            self.end_hit(f64::INFINITY);
        }
    }

    /// A mass stands still for an instant: it sticks, or slides where it is pulled.
    fn turn(&mut self, mass: usize) {
        let pull = self.piece.pull(
            mass,
            self.piece.equations.drive(self.piece.phase),
            &self.piece.state,
        );
        let slides = if pull.abs() > self.piece.equations.friction {
            pull.signum()
        } else {
            0.0
        };
        self.piece.state[2 * mass + 1] = 0.0;
        self.piece.slides[mass] = slides;
        if self.piece.touch == Touch::Joined {
            self.piece.state[3 - 2 * mass] = 0.0;
            self.piece.slides[1 - mass] = -slides;
        }
    }

    fn begin_hit(&mut self) {
        self.hits += 1;
        self.touched_at = self.tau;
        if let Some(recording) = &mut self.recording {
            recording.hits.push(Hit {
                tau: self.tau,
                approach: self.piece.state[1] + self.piece.state[3],
                separation: 0.0,
                duration: 0.0,
                dead_zone: f64::INFINITY,
            });
        }
    }

    /// The contact ends; one that lasted longer than `dead_zone` counts as a dead zone.
    fn end_hit(&mut self, dead_zone: f64) {
        let duration = self.tau - self.touched_at;
        let stays = duration > dead_zone;
        self.dead_zones += usize::from(stays);
        // A contact that began before the recording is not in it.
        if let Some(hit) = self.recording.as_mut().and_then(|r| r.hits.last_mut()) {
            hit.separation = -(self.piece.state[1] + self.piece.state[3]);
            [hit.duration, hit.dead_zone] = if stays {
                [0.0, duration]
            } else {
                [duration, 0.0]
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equations::Compliance;

    /// Turning points of mass x from displacement `a` at rest: time and displacement.
    fn turning_points(equations: Equations, a: f64, count: usize) -> Vec<(f64, f64)> {
        let mut motion = Integrator::at_rest(equations);
        motion.piece.state = [a, 0.0, 0.0, 0.0];
        motion.turn(0);
        let recording = motion.record(TAU * (count as f64 + 1.0));
        let turns = recording
            .segments
            .iter()
            .filter(|s| s.from[1] * s.to[1] < 0.0);
        // Velocity is near linear in a step: its zero to second order, the displacement to fourth.
        let at = turns.map(|s| {
            let tau = s.tau + s.length * s.from[1] / (s.from[1] - s.to[1]);
            (tau, s.at(tau)[0])
        });
        at.take(count).collect()
    }

    #[test]
    fn valid_hardening_springs_vibrate_faster_by_three_eighths() {
        // Backbone of the Duffing oscillator: Ω = 1 + 3/8 ε a² − 21/256 ε² a⁴ + …
        let (epsilon, a) = (4e-3, 1.5f64);
        let equations = Equations::undriven(1.0, epsilon, 0.0, ContactModel::Newton(0.9));
        let turns = turning_points(equations, a, 20);
        let period = (turns[19].0 - turns[1].0) / 9.0;
        let e = epsilon * a * a;
        let expected = 1.0 + 0.375 * e - 21.0 / 256.0 * e * e;
        assert!(
            (TAU / period - expected).abs() < 1e-6,
            "{} {expected}",
            TAU / period
        );
    }

    #[test]
    fn valid_drag_takes_what_its_first_integral_says_from_every_half_cycle() {
        // x'' = −x + d x'² while x' < 0: from a turning point a to the next one b,
        // (1 + 2db) e^{−2db} = (1 + 2da) e^{−2da}
        let d = 0.02;
        let equations = Equations::undriven(1.0, 0.0, 0.0, ContactModel::Newton(0.9));
        let turns = turning_points(equations.with(0.0, d), 1.5, 20);
        let invariant = |x: f64| (1.0 + 2.0 * d * x) * (-2.0 * d * x).exp();
        for pair in turns.windows(2) {
            let [a, b] = [pair[0].1.abs(), pair[1].1.abs()];
            assert!(
                b < a && (invariant(a) - invariant(-b)).abs() < 1e-8,
                "{a} {b}"
            );
        }
    }

    #[test]
    fn valid_springs_stiffer_to_one_side_turn_where_their_energy_is_the_same() {
        let q = 0.05;
        let equations = Equations::undriven(1.0, 0.0, 0.0, ContactModel::Newton(0.9));
        let energy = |x: f64| x * x / 2.0 + q * x.powi(3) / 3.0;
        for (_, x) in turning_points(equations.with(q, 0.0), 1.5, 10) {
            assert!((energy(x) - energy(1.5)).abs() < 1e-7, "{x}");
        }
    }

    #[test]
    fn valid_friction_takes_four_times_its_share_from_every_cycle() {
        // free decay under Coulomb friction: the amplitude falls by 2μ/k in every half cycle
        let mu = 0.01;
        let equations = Equations::undriven(1.0, 0.0, mu, ContactModel::Newton(0.9));
        let mut motion = Integrator::at_rest(equations);
        motion.piece.state = [1.0, 0.0, 0.0, 0.0];
        motion.turn(0);
        for half in 1..=40 {
            motion.advance(0.5 * TAU);
            let expected = 1.0 - 2.0 * mu * f64::from(half);
            assert!(
                (motion.piece.state[0].abs() - expected).abs() < 1e-7,
                "{half}"
            );
        }
        // 1 − 2μ·49.5 = μ: after the fiftieth half cycle it sticks within ±μ
        motion.advance(20.0 * TAU);
        assert!(motion.piece.state[0].abs() <= mu && motion.piece.state[1] == 0.0);
    }

    #[test]
    fn valid_a_contact_of_finite_duration_has_the_restitution_and_the_duration_asked_for() {
        for (r, duration) in [(1.0, 0.05), (0.9, 0.08), (0.598, 0.05), (0.2, 0.003)] {
            let law = ContactModel::Compliant(Compliance::new(r, duration).unwrap());
            let equations = Equations::undriven(0.0, 0.0, 0.0, law);
            let mut motion = Integrator::at_rest(equations);
            motion.piece.state = [499.0, 2.0, 499.0, 1.0];
            let recording = motion.record(3.0);
            let hit = recording.hits[0];
            assert!((hit.tau - 2.0 / 3.0).abs() < 1e-9 && recording.hits.len() == 1);
            assert!(
                (hit.separation / hit.approach - r).abs() < 1e-6,
                "{r} {hit:?}"
            );
            assert!(
                (hit.duration - duration).abs() < 1e-6 * duration.max(0.1),
                "{r} {hit:?}"
            );
            // momentum of both masses: X' − Y'
            assert!((motion.piece.state[1] - motion.piece.state[3] - 1.0).abs() < 1e-9);
        }
    }
}
