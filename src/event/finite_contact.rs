//! Impacts of finite duration: how long the contact lasts, from samples taken while it lasts.
//!
//! Beside an impact the velocity follows one flight before first touch and another one after the
//! end of contact. A sample in between has gone a share S of the way from one to the other. With
//! the shares of all impacts of a record, taken at all places within the contact, the duration T
//! is found by least squares against the profile of a linear contact (a spring and a damper that
//! only press), which R alone shapes.
//!
//! The contact acts on the flights like an instantaneous impulse at its centre: the flights'
//! displacements cross there. So the kink of the displacement places the contact, and T gives its
//! start and end. Each body's velocity channel may lag by a delay of its own.

use crate::event::jumps::Jump;
use crate::event::kinematics::{Body, Kinematics, Series};
use crate::event::refine::{ArcFit, Candidate, Instant, arcs, instants};
use crate::record::Role;
use crate::signal::robust;

/// Fewest impacts that show how long they last.
const FEWEST: usize = 5;
/// Least height of a jump, in noise deviations, from which its samples are used.
const CLEAR_JUMP: f64 = 25.0;
/// Error of a sample's share beside the noise: what the flights' extrapolation leaves open.
const SHARE_ERROR: f64 = 0.01;
/// Fall of the sum of squares, over an instantaneous impact, from which a contact lasts or a
/// velocity is delayed.
const SIGNIFICANT: f64 = 25.0;
/// Squared deviation beyond which a sample counts no more.
const OUTLYING: f64 = 16.0;
/// Shortest duration and delay, in samples, that make a difference.
const SHORTEST: f64 = 0.04;
/// Longest duration looked for, in samples.
const LONGEST: f64 = 6.0;
/// Greatest delay looked for, in samples.
const LATEST: f64 = 1.0;

/// A linear contact of a given restitution, in shares of its duration.
///
/// With u'' + 2ζω u' + ω² u = 0 from u = 0 until the press ends, ω√(1−ζ²)T = φ = π − 2α and
/// ζ = sin α, where R = e^{−κ}, κ = φ tan α.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ContactProfile {
    restitution: f64,
    decay: f64,
    angle: f64,
}

impl ContactProfile {
    /// The profile for R; it is that of R = 0.15 below (a linear contact has R > 0.135).
    pub(super) fn new(restitution: f64) -> Self {
        let restitution = restitution.clamp(0.15, 1.0);
        let decay = -restitution.ln();
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if (std::f64::consts::PI - 2.0 * middle) * middle.tan() < decay {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self {
            restitution,
            decay,
            angle: std::f64::consts::PI - 2.0 * low,
        }
    }

    /// Share of the change of velocity that is done at a share of the duration.
    pub(super) fn done(&self, share: f64) -> f64 {
        if share <= 0.0 {
            return 0.0;
        }
        if share >= 1.0 {
            return 1.0;
        }
        let (sin, cos) = (self.angle * share).sin_cos();
        let speed = (-self.decay * share).exp() * (cos - self.decay / self.angle * sin);
        (1.0 - speed) / (1.0 + self.restitution)
    }

    /// Share of the duration by which the mean instant of the impulse follows first touch.
    pub(super) fn centre(&self) -> f64 {
        (self.restitution + self.drift()) / (1.0 + self.restitution)
    }

    /// Change of the speed at the end of contact by a constant acceleration that acts beside the
    /// contact, over what it would be without the contact's spring: R sin φ/φ.
    pub(super) fn drift(&self) -> f64 {
        self.restitution * self.angle.sin() / self.angle
    }
}

/// How long the impacts of a record last, and how late each velocity shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FiniteContact {
    /// Duration, samples; zero if it is not told from an instant.
    pub duration: f64,
    /// Delay of each body's velocity against the kink of the displacement, samples.
    pub delays: [f64; 2],
    /// Its shape.
    pub profile: ContactProfile,
}

impl FiniteContact {
    /// Start and end of a contact whose centre is at a time, in samples, without delays.
    pub(super) fn span(&self, time: f64) -> (f64, f64) {
        let centre = self.profile.centre();
        (
            time - centre * self.duration,
            time + (1.0 - centre) * self.duration,
        )
    }

    /// Candidates whose jumps span all samples that a contact may touch.
    pub(super) fn spanned(&self, candidates: &[Candidate], instants: &[Instant]) -> Vec<Candidate> {
        let [first, last] = [
            self.delays[0].min(self.delays[1]).min(0.0),
            self.delays[0].max(self.delays[1]).max(0.0),
        ];
        let spanned = |(c, instant): (&Candidate, &Instant)| {
            let (start, end) = self.span(instant.time);
            let margin = 0.02 + 2.0 * instant.error.min(0.1);
            let left = (start + first - margin).floor().max(0.0);
            let right = (end + last + margin).ceil().max(left + 1.0);
            let mut spanned = c.clone();
            spanned.jump = Jump {
                // Both are small whole numbers.
                left: left as usize,
                gap: (right - left) as usize,
                ..c.jump
            };
            spanned
        };
        candidates.iter().zip(instants).map(spanned).collect()
    }
}

/// A sample beside an impact: when, from the contact's centre, and how far the velocity has gone.
#[derive(Debug, Clone, Copy)]
struct Passage {
    offset: f64,
    offset_error: f64,
    share: f64,
    share_error: f64,
}

/// How long the impacts of a record last; `None` if they are instants, or if nothing shows it
/// (it takes measured velocity and displacement).
pub(super) fn measure(
    kinematics: &Kinematics,
    candidates: &[Candidate],
    arc: ArcFit,
) -> Option<FiniteContact> {
    kinematics.relative.displacement.as_ref()?;
    let wide: Vec<Candidate> = candidates.iter().map(widened).collect();
    let instants = instants(kinematics, &wide, arc);
    let passages = [&kinematics.x, &kinematics.y]
        .map(|body| passages(measured_velocity(body)?, &wide, &instants, arc));
    if passages.iter().all(Option::is_none) {
        return None;
    }
    let profile = ContactProfile::new(typical_ratio(kinematics, &wide, &instants, arc)?);
    let passages = passages.map(Option::unwrap_or_default);
    Search { profile, passages }.best()
}

/// The candidate with one sample more on either side left to the contact.
fn widened(candidate: &Candidate) -> Candidate {
    let mut wide = candidate.clone();
    wide.jump.left = candidate.jump.left.saturating_sub(1);
    wide.jump.gap = candidate.jump.left + candidate.jump.gap + 1 - wide.jump.left;
    wide
}

/// A body's velocity if it was measured as such: differentiated displacements smear every jump.
fn measured_velocity(body: &Body) -> Option<&Series> {
    let velocity = body.velocity.as_ref()?;
    matches!(velocity.role, Role::VelocityX | Role::VelocityY).then_some(velocity)
}

/// Speed after over before the impacts, median.
fn typical_ratio(
    kinematics: &Kinematics,
    candidates: &[Candidate],
    instants: &[Instant],
    arc: ArcFit,
) -> Option<f64> {
    let velocity = kinematics.relative.velocity.as_ref()?;
    let offset = robust::mean(&velocity.values);
    let ratios: Vec<f64> = (0..candidates.len())
        .filter(|i| candidates[*i].dead_samples == 0.0)
        .filter_map(|i| {
            let [before, after] = arcs(velocity, candidates, i, arc)?;
            let time = instants[i].time;
            Some((offset - after.value(time)) / (before.value(time) - offset))
        })
        .collect();
    robust::median(&ratios)
}

/// Samples beside the impacts of one velocity, from one sample before the jump to one after.
fn passages(
    velocity: &Series,
    candidates: &[Candidate],
    instants: &[Instant],
    arc: ArcFit,
) -> Option<Vec<Passage>> {
    let mut out = Vec::new();
    let mut impacts = 0;
    for (i, instant) in instants.iter().enumerate() {
        if candidates[i].dead_samples > 0.0 {
            continue;
        }
        let Some([before, after]) = arcs(velocity, candidates, i, arc) else {
            continue;
        };
        let jump = candidates[i].jump;
        let height = before.value(instant.time) - after.value(instant.time);
        let full = before.samples.min(after.samples) > arc.degree + 1;
        if !full || height < CLEAR_JUMP * velocity.noise || instant.error > 0.1 {
            continue;
        }
        impacts += 1;
        for k in jump.left + 1..jump.left + jump.gap {
            let at = k as f64;
            let (b, a) = (before.value(at), after.value(at));
            let spread = 1f64.hypot(before.error_factor(at).max(after.error_factor(at)));
            out.push(Passage {
                offset: at - instant.time,
                offset_error: instant.error,
                share: (b - velocity.values[k]) / (b - a),
                share_error: (velocity.noise * spread / height).hypot(SHARE_ERROR),
            });
        }
    }
    (impacts >= FEWEST).then_some(out)
}

/// Least squares over duration and delays.
struct Search {
    profile: ContactProfile,
    passages: [Vec<Passage>; 2],
}

impl Search {
    fn best(&self) -> Option<FiniteContact> {
        let unexplained: f64 = [0, 1].map(|body| self.excess(body)).iter().sum();
        if unexplained < SIGNIFICANT {
            return None;
        }
        let instant: f64 = [0, 1].map(|body| self.cost(body, 0.0, 0.0)).iter().sum();
        let coarse = (0..=12).map(|i| {
            let duration = LONGEST * (f64::from(i) / 12.0).powi(2);
            let [x, y] = [0, 1].map(|body| self.best_delay(body, duration));
            (x.0 + y.0, [duration, x.1, y.1])
        });
        let (cost, start) = coarse.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (cost, [duration, x, y]) = self.refined(cost, start);
        let told = |v: f64| if v.abs() < SHORTEST { 0.0 } else { v };
        let found = FiniteContact {
            duration: told(duration),
            delays: [told(x), told(y)],
            profile: self.profile,
        };
        let differs = found.duration > 0.0 || found.delays != [0.0; 2];
        (differs && instant - cost > SIGNIFICANT).then_some(found)
    }

    /// How badly instants explain the samples, noise left aside.
    fn excess(&self, body: usize) -> f64 {
        let samples = self.passages[body].iter();
        samples
            .map(|p| (self.squared_deviation(p, 0.0, 0.0) - 6.0).max(0.0))
            .sum()
    }

    fn cost(&self, body: usize, duration: f64, delay: f64) -> f64 {
        let samples = self.passages[body].iter();
        samples
            .map(|p| self.squared_deviation(p, duration, delay))
            .sum()
    }

    /// Squared deviation of a sample over its variance; its place in the contact is known within an
    /// error, over which the profile is averaged.
    fn squared_deviation(&self, p: &Passage, duration: f64, delay: f64) -> f64 {
        let centre = self.profile.centre() * duration;
        let done = |offset: f64| {
            if duration > 0.0 {
                self.profile.done((offset - delay + centre) / duration)
            } else {
                f64::from(offset > delay)
            }
        };
        let (low, middle, high) = (
            done(p.offset - 1.2 * p.offset_error),
            done(p.offset),
            done(p.offset + 1.2 * p.offset_error),
        );
        let mean = 0.25 * (low + high) + 0.5 * middle;
        let spread = 0.5 * (high - low);
        let variance = p.share_error * p.share_error + spread * spread;
        ((p.share - mean).powi(2) / variance).min(OUTLYING)
    }

    /// Least cost of one body's samples over its delay, and that delay.
    fn best_delay(&self, body: usize, duration: f64) -> (f64, f64) {
        let delays = (-10..=10).map(|i| LATEST * f64::from(i) / 10.0);
        let costs = delays.map(|delay| (self.cost(body, duration, delay), delay));
        let least = costs.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.abs().total_cmp(&b.1.abs())));
        least.unwrap_or_default()
    }

    /// Search along the coordinates in steps that are halved.
    fn refined(&self, mut least: f64, mut at: [f64; 3]) -> (f64, [f64; 3]) {
        let mut step = 0.16f64;
        while step > 0.002 {
            let mut better = false;
            for axis in 0..3 {
                for sign in [-1.0, 1.0] {
                    let mut next = at;
                    next[axis] += sign * step;
                    next[0] = next[0].max(0.0);
                    let cost = self.cost(0, next[0], next[1]) + self.cost(1, next[0], next[2]);
                    if cost < least {
                        (least, at, better) = (cost, next, true);
                    }
                }
            }
            if !better {
                step *= 0.5;
            }
        }
        (least, at)
    }
}

/// Replace the samples that a contact touches by the flights on either side of its centre, as if
/// the impact were an instant: integrals over the velocities are right then.
pub(super) fn bridge(
    kinematics: &mut Kinematics,
    candidates: &[Candidate],
    instants: &[Instant],
    contact: &FiniteContact,
    arc: ArcFit,
) {
    let rate_hz = kinematics.rate_hz;
    for (body, delay) in [&mut kinematics.x, &mut kinematics.y]
        .into_iter()
        .zip(contact.delays)
    {
        let Some(velocity) = body.velocity.as_mut() else {
            continue;
        };
        let flights: Vec<_> = (0..candidates.len())
            .map(|i| arcs(velocity, candidates, i, arc))
            .collect();
        for ((candidate, instant), flights) in candidates.iter().zip(instants).zip(flights) {
            let Some([before, after]) = flights else {
                continue;
            };
            let jump = candidate.jump;
            let mut area = 0.0;
            for k in jump.left + 1..(jump.left + jump.gap).min(velocity.values.len()) {
                let at = k as f64;
                let flight = if at < instant.time + delay {
                    &before
                } else {
                    &after
                };
                area += flight.value(at) - velocity.values[k];
                velocity.values[k] = flight.value(at);
            }
            velocity.correct_area(jump.left + jump.gap, area, rate_hz);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_the_profile_of_an_elastic_contact_is_a_half_sine_force() {
        let profile = ContactProfile::new(1.0);
        for share in [0.1, 0.5, 0.7] {
            let expected = 0.5 * (1.0 - (std::f64::consts::PI * share).cos());
            assert!((profile.done(share) - expected).abs() < 1e-9);
        }
        assert!((profile.centre() - 0.5).abs() < 1e-9 && profile.drift() < 1e-9);
    }

    #[test]
    fn prop_the_profile_rises_from_nothing_to_all_about_its_centre() {
        for restitution in [0.2, 0.5, 0.8, 0.95] {
            let profile = ContactProfile::new(restitution);
            let shares: Vec<f64> = (0..=2000).map(|i| f64::from(i) / 2000.0).collect();
            let done: Vec<f64> = shares.iter().map(|s| profile.done(*s)).collect();
            assert!(done.windows(2).all(|w| w[1] >= w[0]));
            assert!(
                (profile.done(1.0 - 1e-9) - 1.0).abs() < 1e-6,
                "{restitution}"
            );
            // mean instant of the impulse: the integral of what is not yet done
            let left: f64 = done.iter().map(|d| (1.0 - d) / 2000.0).sum();
            assert!(
                (left - 0.5 / 2000.0 - profile.centre()).abs() < 1e-6,
                "{restitution}"
            );
        }
    }
}
