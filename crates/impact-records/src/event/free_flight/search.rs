//! The search for impacts between free flights.

use crate::event::contact::Closed;
use crate::event::contact_profile::ContactProfile;
use crate::event::impact::{DetectionSource, Impact, MassSpeeds};
use crate::event::kinematics::{Body, Kinematics, RigKind, Series};
use crate::record::{Flag, Problem};
use crate::signal::local_fit::crossing;
use crate::signal::{robust, whole};

use super::drag::Drag;
use super::fall::{self, Fall};
use super::stretch::{self, Scale, Side, Stretch};

/// Speed at an impact above the fastest sample of its flight that is refused, relative.
const BEYOND: f64 = 0.1;
/// Part of the fastest sample that a flight's own acceleration may add up to the impact.
const ADDED: f64 = 0.6;
/// Acceleration after an impact over that before it, at most: friction turns around.
const TURNED: f64 = 2.0;
/// What rings after a contact. `prop_separation_speeds_hold_the_truth_over_a_range_of_what_is_taken_for_ringing` has the
/// same share of intervals hold the truth from half to twice of each.
#[derive(Debug, Clone, Copy)]
struct Ringing {
    /// How many times as long as the falls beside it a flight lasts that is none of a ringing, whose velocity rises for
    /// as long as it falls.
    long: usize,
    /// How many times as long as a contact its bumpers ring before a flight.
    rings: usize,
}

const RINGING: Ringing = Ringing { long: 2, rings: 3 };
/// Times that drag is fitted: a flight that drag bends is found whole with it alone.
const DRAG_FITS: usize = 3;
/// Fewest samples of a mean of the separation speed.
const LEAST_MEAN: usize = 3;
/// Greatest ratio of separation to approach speed that an impact can have.
const GREATEST_RATIO: f64 = 1.3;
/// Part of the drop of a fall that the flights beside it explain, else something else made it.
const EXPLAINED: f64 = 0.5;
/// Standard errors by which each mass's speed must change.
const CHANGED: f64 = 3.0;
/// Part of an approach that is told from none.
const LEAST_SHARE: f64 = 0.02;
/// Standard error of the time of a crossing of two parabolas, samples: what the contact takes.
const BLUR: f64 = 0.25;
/// Standard deviation of the place of a jump between two samples, samples.
const STEP_SPREAD: f64 = 0.29;
/// Least standard error of the time of an impact between two lines of velocity, samples.
const LEAST_SPREAD: f64 = 0.1;
/// Samples of a fall of differences of a displacement at a jump of the velocity.
const IN_AN_INSTANT: f64 = 3.0;
/// Standard deviations of noise within which a difference of displacements is that of a flight.
const HIDES: f64 = 2.0;
/// Standard error of where a contact begins and ends, over its length, by the law of its force: that of a viscous bumper fades
/// below the tenth at which a fall ends over some eighth of it, that of a spring alone over a few hundredths.
const ENDS: f64 = 0.125;
/// Share of the approach that must be free flight, else what is left out is noted.
const USED: f64 = 0.85;

/// Impacts of a record under constant force.
#[derive(Debug, Clone, Default, PartialEq)]
pub(in crate::event) struct FreeFlights {
    /// The impacts in order of time.
    pub impacts: Vec<Impact>,
    /// Samples that a fall takes in the median.
    pub jump_samples: usize,
    /// What was turned around and what was left out.
    pub flags: Vec<Flag>,
}

/// The bodies of a record and where their approach velocity falls.
pub(super) struct Search<'a> {
    bodies: Vec<&'a Body>,
    rate_hz: f64,
    falls: Vec<Fall>,
    relative: &'a [f64],
    greatest_m_s: f64,
    ringing: Ringing,
    drag: Drag,
}

/// What a flight shows of the force on the bodies.
#[derive(Debug, Clone, Copy)]
struct Force {
    /// Samples of the flight.
    samples: usize,
    /// Size of the change of the approach velocity per sample, as far as it stands out of the noise, m/s.
    step: f64,
}

impl Force {
    fn of(flights: &[Stretch]) -> Self {
        let samples = flights.iter().map(|s| s.samples.1 - s.samples.0).min();
        let at = |s: &Stretch| s.sure_step(s.samples.0 as f64, CHANGED);
        Self {
            samples: samples.unwrap_or(0),
            step: flights.iter().map(at).sum::<f64>().abs(),
        }
    }
}

/// Change of one body over what shows one, and what shows one over that of the other, from which one body alone meets
/// something.
const ALONE: f64 = 1.5;

/// An impact, or why a fall is none.
enum Found {
    Impact(Box<Impact>, Option<usize>),
    /// No flight beside the fall: time, s, and on which side.
    NoFlight(f64, Side),
    /// The speed at the impact is beyond any that was measured.
    Beyond(f64),
    /// One of two bodies changes its velocity, and the other flies on.
    OneBody,
    Nothing,
}

fn separate_bodies(alone: usize, together: usize) -> Flag {
    Flag::new(None, Problem::MassesDoNotMeet { alone, together })
}

impl<'a> Search<'a> {
    pub(super) fn new(kinematics: &'a Kinematics, rig: RigKind) -> Self {
        Self::beside(kinematics, rig, RINGING)
    }

    fn beside(kinematics: &'a Kinematics, rig: RigKind, ringing: Ringing) -> Self {
        let bodies = match rig {
            RigKind::Single => vec![&kinematics.x],
            RigKind::Double => vec![&kinematics.x, &kinematics.y],
        };
        let velocity = kinematics.relative.velocity.as_ref();
        let relative = velocity.map_or(&[][..], |v| v.values.as_slice());
        let greatest_m_s = typical_greatest(relative);
        let mut search = Self {
            bodies,
            rate_hz: kinematics.rate_hz,
            falls: velocity.map_or_else(Vec::new, |v| fall::find(v, greatest_m_s)),
            relative,
            greatest_m_s,
            ringing,
            drag: Drag::default(),
        };
        search.falls = search.after_flights();
        for _ in 0..DRAG_FITS {
            search.drag = search.drag_shown();
        }
        search
    }

    /// The falls but those of a ringing: the flight between one of them and the fall before it is as short as they
    /// are, and steeper than any flight that is longer than the falls beside it. A constant force is the same in
    /// all flights.
    fn after_flights(&self) -> Vec<Fall> {
        let count = self.falls.len();
        let flight = |i: usize| self.stretches(i, Side::Before).map(|own| Force::of(&own));
        let before: Vec<Option<Force>> = (0..count).map(flight).collect();
        let last = count.checked_sub(1);
        let last = last.and_then(|i| self.stretches(i, Side::After));
        let duration = |i: usize| self.falls.get(i).map_or(0, |f| f.last - f.first);
        let beside =
            |i: usize| self.ringing.long * duration(i).max(i.checked_sub(1).map_or(0, duration));
        let long = before.iter().enumerate();
        let long = long.filter_map(|(i, force)| force.filter(|f| f.samples > beside(i)));
        let long = long.chain(last.map(|own| Force::of(&own)));
        let most = TURNED * long.map(|f| f.step).fold(0.0, f64::max);
        let rings = |i: usize| {
            let own = before[i].filter(|f| i > 0 && f.samples <= beside(i));
            own.is_some_and(|f| f.step > most)
        };
        (0..count)
            .filter(|i| !rings(*i))
            .map(|i| self.falls[i])
            .collect()
    }

    /// Drag that the flights of one body show, each flight once. What acts on two bodies is not told apart.
    fn drag_shown(&self) -> Drag {
        if self.bodies.len() > 1 {
            return Drag::default();
        }
        let sides = (0..self.falls.len()).map(|i| (i, Side::After));
        let sides = std::iter::once((0, Side::Before)).chain(sides);
        let flights = sides.filter(|(i, _)| *i < self.falls.len());
        let flights = flights.filter_map(|(i, side)| self.stretches(i, side));
        let shown = flights.flatten().filter_map(|flight| flight.shown);
        let drag = Drag::of(&shown.collect::<Vec<_>>());
        // its error is one for both speeds of an impact: it moves one up and the other down
        Drag {
            error_per_m: std::f64::consts::SQRT_2 * drag.error_per_m,
            ..drag
        }
    }

    pub(super) fn impacts(&self, closed: &[Closed]) -> FreeFlights {
        let mut found = FreeFlights {
            jump_samples: self.jump_samples(),
            ..FreeFlights::default()
        };
        let (mut cut, mut hidden, mut beyond) = (Vec::new(), Vec::new(), Vec::new());
        let mut alone = 0;
        for index in 0..self.falls.len() {
            match self.impact(index, closed) {
                Found::Impact(impact, left_out) => {
                    cut.extend(left_out.map(|n| (impact.time_s, n)));
                    found.impacts.push(*impact);
                }
                Found::NoFlight(time_s, side) => hidden.push((time_s, side)),
                Found::Beyond(time_s) => beyond.push(time_s),
                Found::OneBody => alone += 1,
                Found::Nothing => {}
            }
        }
        if alone > found.impacts.len() + 1 {
            return FreeFlights {
                impacts: Vec::new(),
                flags: vec![separate_bodies(alone, found.impacts.len())],
                ..found
            };
        }
        found.flags.extend(cut_flag(&cut, self.rate_hz));
        found.flags.extend(hidden_flag(&hidden));
        found.flags.extend(beyond_flag(&beyond));
        found
    }

    /// Whether all bodies lose speed at one of the falls, as they do where they meet: what one of them strikes, or its own ringing,
    /// makes falls of that one alone.
    pub(super) fn falls_of_all_bodies(&self) -> bool {
        let loses = |body: &Body, fall: &Fall| {
            body.velocity.as_ref().is_some_and(|own| {
                let lost = own.values[fall.first] - own.values[fall.last];
                let noise = CHANGED * std::f64::consts::SQRT_2 * own.noise;
                lost > noise.max(LEAST_SHARE * self.drop(*fall))
            })
        };
        let all = |fall: &Fall| self.bodies.iter().all(|body| loses(body, fall));
        self.falls.iter().any(all)
    }

    /// Samples that a fall takes in the median; a velocity derived from a displacement smears it by two.
    fn jump_samples(&self) -> usize {
        let gaps: Vec<f64> = self
            .falls
            .iter()
            .map(|f| (f.last - f.first) as f64)
            .collect();
        let derived = |b: &&Body| match (&b.velocity, &b.displacement) {
            (Some(velocity), Some(displacement)) => velocity.role == displacement.role,
            _ => false,
        };
        let smeared = if self.bodies.iter().any(derived) {
            2.0
        } else {
            0.0
        };
        robust::median(&gaps).map_or(1, |g| whole::index((g - smeared).round().max(1.0)))
    }

    /// The fall of differences of the displacements, if all are measured, without what noise adds at its ends: values that are
    /// those of the flights.
    fn fall_shown(&self, index: usize, before: &[Stretch], after: &[Stretch]) -> ShownBy {
        let fall = self.falls[index];
        let displacements = self.bodies.iter().map(|body| body.displacement.as_ref());
        let Some(displacements) = displacements.collect::<Option<Vec<&Series>>>() else {
            return ShownBy::Velocity(fall);
        };
        let values: Vec<&[f64]> = displacements.iter().map(|d| d.values.as_slice()).collect();
        let Some(fall) = fall::of_displacements(&values, fall) else {
            return ShownBy::Velocity(fall);
        };
        let variance: f64 = displacements.iter().map(|d| d.noise.powi(2)).sum();
        let noise = HIDES * (0.5 * variance).sqrt() * self.rate_hz;
        let beside = |flights: &[Stretch], i: usize| {
            let flight: f64 = flights.iter().map(|s| s.speed(i as f64)).sum();
            (self.rate_hz * fall::differences(&values, i) - flight).abs() < noise
        };
        let mut inside = fall.first..fall.last;
        let first = inside.rfind(|i| beside(before, *i));
        let first = first.unwrap_or(fall.first);
        let last = (first + 1..fall.last).find(|i| beside(after, *i));
        ShownBy::Displacement {
            fall: Fall {
                first,
                last: last.unwrap_or(fall.last),
            },
            hidden: noise / self.drop(self.falls[index]),
        }
    }

    /// Samples between the neighbouring falls.
    fn bounds(&self, index: usize) -> (usize, usize) {
        let low = index.checked_sub(1).map_or(0, |i| self.falls[i].last);
        let next = self.falls.get(index + 1);
        (low, next.map_or(self.relative.len(), |f| f.first + 1))
    }

    fn stretches(&self, index: usize, side: Side) -> Option<Vec<Stretch>> {
        let scale = Scale {
            rate_hz: self.rate_hz,
            greatest_m_s: self.greatest_m_s,
            drag: self.drag,
        };
        let bounds = self.bounds(index);
        self.bodies
            .iter()
            .map(|body| {
                let fall = self.falls[index];
                let ringing = self.ringing.rings * (fall.last - fall.first);
                stretch::find(body, (side, ringing), fall, bounds, scale)
            })
            .collect()
    }

    fn impact(&self, index: usize, closed: &[Closed]) -> Found {
        let fall = self.falls[index];
        let middle_s = 0.5 * (fall.first + fall.last) as f64 / self.rate_hz;
        let Some(before) = self.stretches(index, Side::Before) else {
            return Found::NoFlight(middle_s, Side::Before);
        };
        let Some(after) = self.stretches(index, Side::After) else {
            return Found::NoFlight(middle_s, Side::After);
        };
        let (time, time_error) = self.instant(fall, &before, &after);
        let contact = Contact::of(
            self.fall_shown(index, &before, &after),
            time,
            &before,
            &after,
        );
        let (begin, end) = (contact.begin, contact.end);
        let approach: f64 = before.iter().map(|s| s.speed(begin)).sum();
        let separation: f64 = -after.iter().map(|s| s.speed(end)).sum::<f64>();
        let [low, high] = self.separation_measured(index, &before, &after);
        let beyond = separation - separation.clamp(low, high);
        let separation = separation - beyond;
        let error = speed_error(&before, &after, (time, time_error))
            .hypot(beyond)
            .hypot(self.ringing(fall, &after))
            .hypot(friction_in_contact(fall, &before, &after))
            .hypot(force_in_contact(&contact, time, &before, &after));
        if self.is_beyond(index, &before, approach, error) {
            return Found::Beyond(time / self.rate_hz);
        }
        let rebounds = match self.bodies.len() {
            1 => separation > CHANGED * error,
            _ => separation > -CHANGED * error.max(LEAST_SHARE * approach),
        };
        let pairs = before.iter().zip(&after);
        // each body's change over what shows one
        let changes: Vec<f64> = pairs
            .map(|(b, a)| {
                let least = LEAST_SHARE * approach;
                let shows = (CHANGED * b.error(time).hypot(a.error(time))).max(least);
                (b.speed(begin) - a.speed(end)) / shows
            })
            .collect();
        let changed = |change: &f64| *change > 1.0;
        if changes.len() > 1
            && changes.iter().any(|c| *c > ALONE)
            && changes.iter().any(|c| c.abs() < 1.0 / ALONE)
        {
            return Found::OneBody;
        }
        if approach < CHANGED * error
            || !rebounds
            || !changes.iter().all(changed)
            || separation > GREATEST_RATIO * approach
            || approach + separation < EXPLAINED * self.drop(fall)
        {
            return Found::Nothing;
        }
        let of_body = |body: usize| MassSpeeds {
            before_m_s: before[body].speed(begin),
            after_m_s: after[body].speed(end),
        };
        let touched = closed
            .iter()
            .any(|c| c.first <= fall.last + 1 && fall.first <= c.last + 1);
        let impact = Impact {
            approach_speed_before_m_s: Some(approach),
            approach_speed_after_m_s: Some(-separation),
            speed_errors_m_s: Some([error; 2]),
            x: Some(of_body(0)),
            y: (self.bodies.len() > 1).then(|| of_body(1)),
            source: if touched {
                DetectionSource::Both
            } else {
                DetectionSource::Velocity
            },
            ..Impact::timed(time / self.rate_hz, time_error / self.rate_hz)
        };
        Found::Impact(Box::new(impact), self.left_out(index, &before))
    }

    /// Time of an impact in samples with its standard error: where the displacements of both flights
    /// cross.
    fn instant(&self, fall: Fall, before: &[Stretch], after: &[Stretch]) -> (f64, f64) {
        let (low, high) = (fall.first as f64 - 1.0, fall.last as f64 + 1.0);
        if let ([before], [after]) = (before, after)
            && let (Some(b), Some(a)) = (before.displacement(), after.displacement())
            && let Some(time) = crossing(b, a, low, high)
        {
            return (time, BLUR);
        }
        self.crossing_of_areas(fall, before, after)
    }

    /// Time at which the displacements of both flights meet: they enclose the area under the velocity.
    /// It does not depend on how many samples the contact takes, nor on a smoothing of the velocity.
    fn crossing_of_areas(&self, fall: Fall, before: &[Stretch], after: &[Stretch]) -> (f64, f64) {
        let middle = 0.5 * (fall.first + fall.last) as f64;
        let from = before.iter().map(|s| s.samples.1.saturating_sub(1)).min();
        let to = after.iter().map(|s| s.samples.0).max();
        let (Some(from), Some(to)) = (from, to) else {
            return (middle, 0.5);
        };
        let area: f64 = self.relative[from..=to]
            .windows(2)
            .map(|w| 0.5 * (w[0] + w[1]))
            .sum();
        let speed = |flights: &[Stretch], t: f64| flights.iter().map(|s| s.speed(t)).sum::<f64>();
        let under = |flights: &[Stretch], a: f64, b: f64| {
            0.5 * (speed(flights, a) + speed(flights, b)) * (b - a)
        };
        let (low, high) = (from as f64, to as f64);
        let mut time = middle;
        for _ in 0..20 {
            let off = under(before, low, time) + under(after, time, high) - area;
            let step = off / (speed(before, time) - speed(after, time));
            time -= step;
            if !time.is_finite() || time < low || time > high {
                return (middle, 0.5);
            }
            if step.abs() < 1e-9 {
                break;
            }
        }
        // A jump between two samples is somewhere between them; one over several is resolved.
        let steps = (fall.last - fall.first).max(1) as f64;
        (time, (STEP_SPREAD / steps).max(LEAST_SPREAD))
    }

    /// Whether the approach speed is beyond what was measured on its flight.
    fn is_beyond(&self, index: usize, before: &[Stretch], approach: f64, error: f64) -> bool {
        let (low, _) = self.bounds(index);
        let fall = self.falls[index];
        let fastest = self.relative[low..=fall.first]
            .iter()
            .fold(0.0f64, |m, v| m.max(*v));
        let used = before.iter().map(|s| s.samples.1.saturating_sub(1)).min();
        let middle = 0.5 * (fall.first + fall.last) as f64;
        let gap = (middle - used.unwrap_or(fall.first) as f64).max(1.0);
        let slope: f64 = before.iter().map(|s| s.step(fall.first as f64)).sum();
        let added = (slope.max(0.0) * gap).min(ADDED * fastest);
        approach > (1.0 + BEYOND) * fastest + added + CHANGED * error
    }

    /// Separation speeds between which that of an impact lies: of means over the samples after it, which a contact
    /// that goes on or a ringing sways, and up to the greatest of them what the flight's own acceleration adds on
    /// the way back to the contact, which is no more than that of the approach, friction turned around.
    fn separation_measured(&self, index: usize, before: &[Stretch], after: &[Stretch]) -> [f64; 2] {
        let fall = self.falls[index];
        let (_, end) = self.bounds(index);
        let begin = after.iter().map(|s| s.samples.0).max();
        let begin = begin.unwrap_or(fall.last).clamp(fall.last, end);
        let used = after.iter().map(|s| s.samples.1).min();
        let used = used
            .unwrap_or(end)
            .clamp(begin, end.min(self.relative.len()));
        let gap = begin - fall.last;
        let width =
            (gap.max(fall.last - fall.first)).clamp(LEAST_MEAN, (used - begin).max(LEAST_MEAN));
        let from = fall.last.min(used.saturating_sub(width));
        let means = self.relative[from..used]
            .windows(width)
            .map(|w| -robust::mean(w));
        let means: Vec<f64> = means.collect();
        let near = (gap + width).min(means.len());
        let Some((low, _)) = robust::range(means.iter().copied().take(near)) else {
            return [f64::NEG_INFINITY, f64::INFINITY];
        };
        let high = means.iter().copied().fold(low, f64::max);
        let middle = 0.5 * (fall.first + fall.last) as f64;
        let steps = |flights: &[Stretch]| {
            let each = flights.iter().map(|s| s.sure_step(middle, CHANGED));
            each.sum::<f64>()
        };
        let own = steps(after).abs().min(steps(before).abs());
        let way = begin as f64 + 0.5 * width as f64 - middle;
        [low - own * way, high + own * way]
    }

    /// What the speed between the fall and the flight after it is in the mean beside that flight: ringing of the
    /// bumpers, friction that fades. How much of it the impact did is not known.
    fn ringing(&self, fall: Fall, after: &[Stretch]) -> f64 {
        let begin = after.iter().map(|s| s.samples.0).max();
        let between = fall.last..begin.unwrap_or(fall.last).min(self.relative.len());
        if between.len() < LEAST_MEAN {
            return 0.0;
        }
        let flight = |i: usize| after.iter().map(|s| s.speed(i as f64)).sum::<f64>();
        let off: Vec<f64> = between.map(|i| self.relative[i] - flight(i)).collect();
        robust::mean(&off).abs()
    }

    /// Drop of the velocity over a fall.
    fn drop(&self, fall: Fall) -> f64 {
        self.relative[fall.first] - self.relative[fall.last]
    }

    /// Samples of the approach that are no free flight, if they are many.
    fn left_out(&self, index: usize, before: &[Stretch]) -> Option<usize> {
        let (low, _) = self.bounds(index);
        let moving = 0.1 * self.greatest_m_s;
        let last = self.falls[index].first;
        let all = (low..=last)
            .rev()
            .take_while(|i| self.relative[*i] > moving)
            .count();
        let from = before.iter().map(|s| s.samples.0).max()?;
        let to = before.iter().map(|s| s.samples.1).min()?;
        let used = to.saturating_sub(from);
        let turned = self.bodies.len() == 1 && index > 0;
        (!turned && (used as f64) < USED * all as f64).then(|| all - used.min(all))
    }
}

/// What shows how long a contact lasts.
enum ShownBy {
    /// Differences of displacements, with the share of the drop that noise hides.
    Displacement { fall: Fall, hidden: f64 },
    /// Measured velocities.
    Velocity(Fall),
}

/// A contact between two flights, samples.
struct Contact {
    begin: f64,
    end: f64,
    /// Standard error of either.
    error: f64,
}

impl Contact {
    /// About the instant at which the flights meet: that of a spring and a damper which the speeds there make.
    ///
    /// A displacement is not smoothed; its differences are, over a jump in an instant they fall in three samples, and
    /// widths that follow each other add as their squares. A measured velocity falls over what the contact takes and what
    /// smooths the velocity, of which neither is known: the contact takes anything up to the whole of it.
    fn of(shown: ShownBy, time: f64, before: &[Stretch], after: &[Stretch]) -> Self {
        let speed = |flights: &[Stretch]| flights.iter().map(|s| s.speed(time)).sum::<f64>();
        let profile = ContactProfile::new(-speed(after) / speed(before));
        let (lasts, error) = match shown {
            ShownBy::Displacement { fall, hidden } => lasting(fall, &profile, hidden),
            ShownBy::Velocity(fall) => {
                let most = (fall.last - fall.first) as f64 / fall::seen(&profile, 0.0);
                (0.5 * most, 0.5 * most / 12f64.sqrt())
            }
        };
        let begin = time - profile.centre() * lasts;
        Self {
            begin,
            end: begin + lasts,
            error,
        }
    }
}

/// Samples that a contact takes in which the differences of a displacement fall, with the standard error of either end.
///
/// Differences over two samples are touched by a contact from the sample before that at which it begins to the one after that at
/// which it ends: a fall of s samples is that of a contact of more than s − 4 and less than s − 2, with the triangle's deviation
/// 6^−½. Of many samples the widths add as their squares, and the fall shows a share of a force that fades.
fn lasting(fall: Fall, profile: &ContactProfile, hidden: f64) -> (f64, f64) {
    let samples = (fall.last - fall.first) as f64;
    if samples < 2.0 * IN_AN_INSTANT {
        let lasting = (samples - IN_AN_INSTANT).max(0.0);
        (lasting, (0.5 / 6f64.sqrt()).hypot(ENDS * lasting))
    } else {
        let shown = (samples.powi(2) - IN_AN_INSTANT.powi(2)).sqrt();
        (shown / fall::seen(profile, hidden), ENDS * shown)
    }
}

/// What a force that goes on while the contact lasts, as on a slope, changes of the speeds beside it, whose ends are not known.
fn force_in_contact(contact: &Contact, time: f64, before: &[Stretch], after: &[Stretch]) -> f64 {
    let step = |flights: &[Stretch]| flights.iter().map(|s| s.step(time)).sum::<f64>();
    0.5 * (step(before) + step(after)).abs() * contact.error
}

/// What friction, which turns around at an impact, changes of the speeds while the contact lasts: it is not known
/// how much of the fall is before the turn.
fn friction_in_contact(fall: Fall, before: &[Stretch], after: &[Stretch]) -> f64 {
    let middle = 0.5 * (fall.first + fall.last) as f64;
    let turns = before.iter().zip(after);
    let friction = turns.map(|(b, a)| 0.5 * (b.step(middle) - a.step(middle)).abs());
    friction.sum::<f64>() * (fall.last - fall.first) as f64 / 12f64.sqrt()
}

/// Standard error of either approach speed: of the fits, and of the time where flights are steep.
fn speed_error(before: &[Stretch], after: &[Stretch], (time, time_error): (f64, f64)) -> f64 {
    let side = |flights: &[Stretch]| {
        let squares: f64 = flights.iter().map(|s| s.error(time).powi(2)).sum();
        let step: f64 = flights.iter().map(|s| s.step(time)).sum();
        squares.sqrt().hypot(step * time_error)
    };
    side(before).max(side(after))
}

/// The greatest speed but for a few samples, which may be faults.
fn typical_greatest(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let at = sizes.len().saturating_sub(1) * 98 / 100;
    sizes.get(at).copied().unwrap_or(0.0)
}

fn cut_flag(cut: &[(f64, usize)], rate_hz: f64) -> Option<Flag> {
    let (time_s, samples) = cut.first()?;
    let problem = Problem::ApproachInPart {
        time_s: *time_s,
        cut_s: *samples as f64 / rate_hz,
    };
    Some(Flag::new(None, problem).excluding(false))
}

fn hidden_flag(hidden: &[(f64, Side)]) -> Option<Flag> {
    let count = hidden.len();
    let problem = match *hidden.first()? {
        (time_s, Side::Before) => Problem::NoFlightBefore { count, time_s },
        (time_s, Side::After) => Problem::NoFlightAfter { count, time_s },
    };
    Some(Flag::new(None, problem).excluding(false))
}

fn beyond_flag(beyond: &[f64]) -> Option<Flag> {
    let problem = Problem::SpeedBeyondMeasured {
        count: beyond.len(),
        time_s: *beyond.first()?,
    };
    Some(Flag::new(None, problem).excluding(false))
}

#[cfg(test)]
mod tests;
