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

use crate::event::arcs::{Arcs, Candidate, Instant, flights};
use crate::event::contact_profile::{ContactProfile, TabulatedProfile};
use crate::event::contact_samples::{Passage, Samples, beside, measured_velocity, samples};
use crate::event::jumps::Jump;
use crate::event::kinematics::{Body, Kinematics};
use crate::event::refine::{self, instants};
use crate::signal::robust;
use crate::signal::whole;

/// Fewest impacts that show how long they last.
const FEWEST: usize = 5;
/// Fall of the sum of squares, over an instantaneous impact, from which a contact lasts or a
/// velocity is delayed.
const SIGNIFICANT: f64 = 25.0;
/// Error of a sample's share where it places the impact: the contact's true profile.
const PLACE_ERROR: f64 = 0.04;
/// Squared deviation beyond which a sample counts no more.
const OUTLYING: f64 = 16.0;
/// Squared deviation of one impact's samples that noise explains.
const EXPLAINED: f64 = 8.0;
/// Looser times of the impacts, in samples, in the coarse search: the mean delay is not searched.
const LOOSE: f64 = 0.3;
/// Shortest duration and delay, in samples, that make a difference.
const SHORTEST: f64 = 0.04;
/// Longest duration looked for, in samples.
const LONGEST: f64 = 6.0;
/// Greatest delay looked for, in samples.
const LATEST: f64 = 1.0;

/// How long the impacts of a record last, and how late each velocity shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FiniteContact {
    /// Duration, samples; zero if it is indistinguishable from an instant.
    pub duration: f64,
    /// Delay of each body's velocity against the kink of the displacement, samples.
    pub delays: [f64; 2],
    /// Time from the mean kink of the bodies' displacements to either, samples: their channels may be late by
    /// different delays.
    pub kinks_apart: f64,
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

    /// Delay of the velocities against the kink, the mean of both bodies, samples.
    pub(super) fn delay(&self) -> f64 {
        0.5 * (self.delays[0] + self.delays[1])
    }

    /// Times of impacts from the kink of the displacement and the samples within the contact.
    pub(super) fn placed(
        &self,
        kinematics: &Kinematics,
        arcs: Arcs<'_>,
        instants: &[Instant],
    ) -> Vec<Instant> {
        let mut out = instants.to_vec();
        if self.duration == 0.0 {
            return out;
        }
        let bodies = [
            (&kinematics.x, self.delays[0]),
            (&kinematics.y, self.delays[1]),
        ];
        for (i, instant) in out.iter_mut().enumerate() {
            if arcs.candidates[i].dead_samples > 0.0 {
                continue;
            }
            let samples: Vec<(Passage, f64)> = bodies
                .iter()
                .filter_map(|(body, delay)| Some((measured_velocity(body)?, *delay)))
                .flat_map(|(velocity, delay)| {
                    let samples = beside(velocity, arcs, i, *instant);
                    samples.into_iter().map(move |p| (p, delay))
                })
                .collect();
            *instant = self.best_time(*instant, &samples);
        }
        out
    }

    /// The time that fits the samples of an impact and its first time, each by its error.
    fn best_time(&self, first: Instant, samples: &[(Passage, f64)]) -> Instant {
        let centre = self.profile.centre() * self.duration;
        let cost = |shift: f64| -> f64 {
            let deviation = |(p, delay): &(Passage, f64)| {
                let done = self
                    .profile
                    .done((p.offset - shift - delay + centre) / self.duration);
                ((p.share - done) / p.share_error.max(PLACE_ERROR))
                    .powi(2)
                    .min(OUTLYING)
            };
            (shift / first.error).powi(2) + samples.iter().map(deviation).sum::<f64>()
        };
        let reach = (3.0 * first.error).min(self.duration);
        let step = reach / 60.0;
        let shifts = (-60..=60).map(|i| step * f64::from(i));
        let costs: Vec<(f64, f64)> = shifts.map(|s| (cost(s), s)).collect();
        let Some(least) = costs.iter().map(|c| c.0).min_by(f64::total_cmp) else {
            return first;
        };
        // mean and deviation of the likelihood e^{−cost/2}
        let weights = costs.iter().map(|(c, s)| ((-0.5 * (c - least)).exp(), *s));
        let sums = weights.fold([0.0; 3], |[w, a, b], (p, s)| {
            [w + p, a + p * s, b + p * s * s]
        });
        let mean = sums[1] / sums[0];
        Instant {
            time: first.time + mean,
            error: (sums[2] / sums[0] - mean * mean).max(0.0).sqrt(),
        }
    }

    /// Candidates whose jumps span all samples that a contact may touch.
    pub(super) fn spanned(&self, candidates: &[Candidate], instants: &[Instant]) -> Vec<Candidate> {
        let [first, last] = [
            self.delays[0].min(self.delays[1]).min(-self.kinks_apart),
            self.delays[0].max(self.delays[1]).max(self.kinks_apart),
        ];
        let spanned = |(c, instant): (&Candidate, &Instant)| {
            let (start, end) = self.span(instant.time);
            let margin = 0.02 + 2.0 * instant.error.min(0.1);
            let left = (start + first - margin).floor().max(0.0);
            let right = (end + last + margin).ceil().max(left + 1.0);
            let mut spanned = c.clone();
            spanned.jump = Jump {
                // Both are small whole numbers.
                left: whole::index(left),
                gap: whole::index(right - left),
                ..c.jump
            };
            spanned
        };
        candidates.iter().zip(instants).map(spanned).collect()
    }
}

/// How long the impacts of a record last; `None` if they are instants, or if nothing shows it
/// (it takes measured velocity and displacement, not smoothed).
pub(super) fn measure(kinematics: &Kinematics, arcs: Arcs<'_>) -> Option<FiniteContact> {
    let displacement = kinematics.relative.displacement.as_ref()?;
    if displacement.spread > 0 {
        return None;
    }
    let candidates = &widened(arcs.candidates);
    let arcs = arcs.of(candidates);
    let instants = instants(kinematics, arcs);
    let bodies = [&kinematics.x, &kinematics.y].map(measured_velocity);
    let impacts: Vec<Samples> = (0..candidates.len())
        .filter_map(|i| samples(bodies, arcs, i, instants[i]))
        .collect();
    if impacts.len() < FEWEST {
        return None;
    }
    let profile = ContactProfile::new(typical_ratio(kinematics, arcs, &instants)?);
    let tabulated = TabulatedProfile::new(&profile);
    let search = Search {
        profile,
        tabulated,
        impacts,
    };
    let mut found = search.best()?;
    found.kinks_apart = kinks_apart(kinematics, arcs);
    match bodies {
        [Some(_), None] => found.delays[1] = found.delays[0],
        [None, Some(_)] => found.delays[0] = found.delays[1],
        _ => {}
    }
    Some(found)
}

/// Impacts that tell how far apart the bodies' kinks are.
const KINKS: usize = 20;

/// Half the time between the kinks of both bodies' displacements, samples; 0 of a single one.
fn kinks_apart(kinematics: &Kinematics, arcs: Arcs<'_>) -> f64 {
    let rate_hz = kinematics.rate_hz;
    let kink = |body: &Body, i: usize| {
        let both = (body.displacement.as_ref()?, body.velocity.as_ref()?);
        Some(refine::kink(both, arcs, i, rate_hz)?.time)
    };
    let few = 0..arcs.candidates.len().min(KINKS);
    let apart: Vec<f64> = few
        .filter_map(|i| Some(kink(&kinematics.x, i)? - kink(&kinematics.y, i)?))
        .collect();
    robust::median(&apart).map_or(0.0, |apart| 0.5 * apart.abs())
}

/// The candidates with one sample more on either side left to the contact: so far from a delayed jump of
/// velocity may the kink of the displacement be.
pub(super) fn widened(candidates: &[Candidate]) -> Vec<Candidate> {
    let widened = |candidate: &Candidate| {
        let mut wide = candidate.clone();
        wide.jump.left = candidate.jump.left.saturating_sub(1);
        wide.jump.gap = candidate.jump.left + candidate.jump.gap + 1 - wide.jump.left;
        wide
    };
    candidates.iter().map(widened).collect()
}

/// Speed after over before the impacts, median.
fn typical_ratio(kinematics: &Kinematics, arcs: Arcs<'_>, instants: &[Instant]) -> Option<f64> {
    let velocity = kinematics.relative.velocity.as_ref()?;
    let offset = robust::mean(&velocity.values);
    let ratios: Vec<f64> = (0..instants.len())
        .filter(|i| arcs.candidates[*i].dead_samples == 0.0)
        .filter_map(|i| {
            let [before, after] = flights(velocity, arcs, i)?;
            let time = instants[i].time;
            Some((offset - after.value(time)) / (before.value(time) - offset))
        })
        .collect();
    robust::median(&ratios)
}

/// Shifts of an impact's time, in its standard errors, from none outwards.
const SHIFTS: [f64; 17] = [
    0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9, -1.2, 1.2, -1.5, 1.5, -1.8, 1.8, -2.1, 2.1, -2.4, 2.4,
];

/// Least squares over duration and delays; each impact's time is free within its error.
struct Search {
    profile: ContactProfile,
    tabulated: TabulatedProfile,
    impacts: Vec<Samples>,
}

/// Duration, mean delay of both bodies, delay of x less that of y; in samples.
type Place = [f64; 3];

impl Search {
    fn best(&self) -> Option<FiniteContact> {
        let instant: Vec<f64> = self.costs(&[0.0; 3]).collect();
        let unexplained: f64 = instant.iter().map(|c| (c - EXPLAINED).max(0.0)).sum();
        if unexplained < SIGNIFICANT {
            return None;
        }
        let grid = (0..=12).flat_map(|i| {
            let duration = LONGEST * (f64::from(i) / 12.0).powi(2);
            (-4..=4).map(move |k| [duration, 0.0, LATEST * f64::from(k) / 4.0])
        });
        let mut best = (f64::INFINITY, [0.0; 3]);
        for place in grid {
            if let Some(cost) = self.cost_below(best.0, &place, LOOSE) {
                best = (cost, place);
            }
        }
        let (_, start) = best;
        let (cost, [duration, mean, apart]) = self.refined(start);
        let known = |v: f64| if v.abs() < SHORTEST { 0.0 } else { v };
        let found = FiniteContact {
            duration: known(duration),
            delays: [known(mean + 0.5 * apart), known(mean - 0.5 * apart)],
            kinks_apart: 0.0,
            profile: self.profile,
        };
        let differs = found.duration > 0.0 || found.delays != [0.0; 2];
        (differs && instant.iter().sum::<f64>() - cost > SIGNIFICANT).then_some(found)
    }

    /// Cost of all impacts where it is below a limit; `loose` is added to the errors of their times.
    fn cost_below(&self, limit: f64, place: &Place, loose: f64) -> Option<f64> {
        let mut sum = 0.0;
        for impact in &self.impacts {
            sum += self.cost_of(impact, place, (loose, limit - sum))?;
            if sum >= limit {
                return None;
            }
        }
        (sum < limit).then_some(sum)
    }

    /// Cost of each impact.
    fn costs(&self, place: &Place) -> impl Iterator<Item = f64> {
        let cost = |i| self.cost_of(i, place, (0.0, f64::INFINITY));
        self.impacts.iter().filter_map(cost)
    }

    /// Least squared deviation of an impact's samples over its time where it is below a limit.
    fn cost_of(
        &self,
        impact: &Samples,
        [duration, mean, apart]: &Place,
        (loose, limit): (f64, f64),
    ) -> Option<f64> {
        let error = impact.time_error.hypot(loose);
        let centre = self.profile.centre() * duration;
        let delays = [mean + 0.5 * apart, mean - 0.5 * apart];
        let per_sample = duration.recip();
        let deviation = |(p, body): &(Passage, usize), shift: f64| {
            let since = p.offset - shift - delays[*body];
            let done = if *duration > 0.0 {
                self.tabulated.done((since + centre) * per_sample)
            } else {
                f64::from(since > 0.0)
            };
            ((p.share - done) / p.share_error).powi(2).min(OUTLYING)
        };
        // A shift whose sum exceeds the least is given up.
        let mut least = limit;
        for steps in SHIFTS {
            let (shift, mut sum) = (steps * error, steps * steps);
            let mut passages = impact.passages.iter();
            while sum < least
                && let Some(passage) = passages.next()
            {
                sum += deviation(passage, shift);
            }
            least = least.min(sum);
        }
        (least < limit).then_some(least)
    }

    /// Search along the coordinates in steps that are halved.
    fn refined(&self, mut at: Place) -> (f64, Place) {
        let mut least: f64 = self.costs(&at).sum();
        let mut step = 0.16f64;
        while step > 0.004 {
            let mut better = false;
            for axis in 0..3 {
                for sign in [-1.0, 1.0] {
                    let mut next = at;
                    next[axis] += sign * step;
                    next[0] = next[0].max(0.0);
                    if let Some(cost) = self.cost_below(least, &next, 0.0) {
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
/// the impact were an instant: integrals over the velocities are right then. Both bodies jump at the same
/// time then, at the mean delay.
pub(super) fn bridge(
    kinematics: &mut Kinematics,
    arcs: Arcs<'_>,
    instants: &[Instant],
    contact: &FiniteContact,
) {
    let rate_hz = kinematics.rate_hz;
    for body in [&mut kinematics.x, &mut kinematics.y] {
        let Some(velocity) = body.velocity.as_mut() else {
            continue;
        };
        let flights: Vec<_> = (0..arcs.candidates.len())
            .map(|i| flights(velocity, arcs, i))
            .collect();
        for ((candidate, instant), flights) in arcs.candidates.iter().zip(instants).zip(flights) {
            let Some([before, after]) = flights else {
                continue;
            };
            let jump = candidate.jump;
            let mut area = 0.0;
            for k in jump.left + 1..(jump.left + jump.gap).min(velocity.values.len()) {
                let at = k as f64;
                let flight = if at < instant.time + contact.delay() {
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
