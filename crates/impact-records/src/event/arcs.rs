//! Arcs of flight between impacts, and the speeds beside an impact extrapolated from them.

use crate::event::impact::{DetectionSource, MassSpeeds};
use crate::event::jumps::Jump;
use crate::event::kinematics::Series;
use crate::signal::local_fit::LocalFit;
use crate::signal::whole;

/// Degree of the polynomials by which velocity and displacement are extrapolated from the arcs beside
/// an impact to it; one more where an arc is hardly shorter than those that are fitted at most and its end near the impact. What
/// a cubic misses there is alike at all impacts that follow each other alike, so that no number of them averages it out.
pub(super) const DEGREE: usize = 3;

/// Part of an arc's length beyond its end from which on one degree more doubles the error that noise makes: least squares
/// through 7 to 26 samples even in time.
const NEAR: f64 = 0.15;

/// Part of an arc that may be left out beside an impact: a third.
const LEFT_OUT: usize = 3;

/// An impact's time in samples with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    /// Time, samples from the first.
    pub time: f64,
    /// Standard error, samples.
    pub error: f64,
}

impl Instant {
    /// So many samples later.
    pub(super) fn later(self, samples: f64) -> Self {
        Self {
            time: self.time + samples,
            ..self
        }
    }
}

/// A jump that may be an impact.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Candidate {
    /// The jump of velocity.
    pub jump: Jump,
    /// Channels that show it.
    pub source: DetectionSource,
    /// Samples the contact stayed closed beyond an ordinary pulse.
    pub dead_samples: f64,
    /// First sample behind it that shows a flight: the contact of an ordinary pulse is open again, which cables pick
    /// up, and a filter rings no more; 0 where nothing is known of either.
    pub calm_from: usize,
}

impl Candidate {
    /// Standard error of its middle as the time of the impact, samples.
    pub(super) fn middle_error(&self) -> f64 {
        self.jump.gap as f64 / 12f64.sqrt()
    }

    /// First sample that does not show the ringing behind it, which lasts so many samples.
    pub(super) fn calm_behind(&self, rings: f64) -> usize {
        whole::index(self.jump.middle().floor() + rings)
    }
}

/// The candidates of a record, and the most samples of an arc that is fitted beside one of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arcs<'a> {
    pub candidates: &'a [Candidate],
    pub samples: usize,
}

impl<'a> Arcs<'a> {
    /// The same beside other candidates.
    pub(super) fn of(self, candidates: &'a [Candidate]) -> Self {
        Self { candidates, ..self }
    }

    /// Degree of a polynomial through so many samples of an arc that ends so many samples from the impact.
    pub(super) fn degree(self, samples: usize, far: f64) -> usize {
        let long = 4 * samples >= 3 * self.samples;
        DEGREE + usize::from(long && far <= NEAR * samples as f64)
    }
}

/// Windows before and after one candidate: ranges that contain no other impact.
pub(super) fn windows(velocity: &Series, arcs: Arcs<'_>, index: usize) -> [(usize, usize); 2] {
    let (candidates, width) = (arcs.candidates, arcs.samples);
    let samples = velocity.values.len();
    let jump = candidates[index].jump;
    let low = match index.checked_sub(1).map(|i| &candidates[i]) {
        Some(c) => c.jump.left + c.jump.gap + whole::index(c.dead_samples.ceil()),
        None => 0,
    };
    let high = candidates
        .get(index + 1)
        .map_or(samples, |c| c.jump.left + 1);
    let begin = jump.left + jump.gap;
    // Where leaving them out would take much of the arc, samples that are not calm are kept.
    let calm_from = candidates[index].calm_from;
    let few = calm_from <= begin + width / LEFT_OUT && calm_from + width / 2 <= high;
    let begin = if few { begin.max(calm_from) } else { begin };
    let dead = whole::index(candidates[index].dead_samples);
    // Within a dead zone the bodies move together: "after" is limited to its samples.
    let end = if dead > 3 {
        begin + dead
    } else {
        begin + width
    };
    [
        (
            low.max((jump.left + 1).saturating_sub(width))
                .min(jump.left),
            jump.left + 1,
        ),
        (begin, end.min(high).min(begin + width).max(begin + 1)),
    ]
}

/// Polynomials through values in two windows of arcs.
pub(super) fn fits(
    values: &[f64],
    windows: [(usize, usize); 2],
    arcs: Arcs<'_>,
) -> Option<[LocalFit; 2]> {
    let fit = |(first, end): (usize, usize), far: f64| {
        let degree = arcs.degree(end.saturating_sub(first), far);
        LocalFit::new(values, first, end, degree)
    };
    // an impact is half a sample behind the arc before it, or a little later
    let [before, after] = windows;
    let later = after.0 as f64 - before.1 as f64;
    Some([fit(before, 0.5)?, fit(after, later + 0.5)?])
}

/// Flights of one signal before and after a candidate, fitted to samples that touch no impact.
pub(super) fn flights(velocity: &Series, arcs: Arcs<'_>, index: usize) -> Option<[LocalFit; 2]> {
    fits(&velocity.values, windows(velocity, arcs, index), arcs)
}

/// Mean instant, in samples, of the change from the flight before a candidate to the one after: half a sample behind the
/// last one before it, and as many more as the shares that are left to change, as they are to be taken, add up to.
pub(super) fn jump_centre(
    velocity: &Series,
    arcs: Arcs<'_>,
    index: usize,
    taken: impl Fn(f64) -> f64,
) -> Option<f64> {
    let jump = arcs.candidates[index].jump;
    let [before, after] = flights(velocity, arcs, index)?;
    let left_to_do = |k: usize| {
        let (from, to) = (before.value(k as f64), after.value(k as f64));
        taken((velocity.values[k] - to) / (from - to))
    };
    let inside = jump.left + 1..(jump.left + jump.gap).min(velocity.values.len());
    Some(jump.left as f64 + 0.5 + inside.map(left_to_do).sum::<f64>())
}

/// Speeds of one signal before and after a candidate, as they were read at a time.
pub(super) struct Reading {
    pub speeds: MassSpeeds,
    /// Standard errors of both by noise, m/s.
    pub errors_m_s: [f64; 2],
    /// What either changes by per sample that the time is later, m/s.
    pub slopes_m_s: [f64; 2],
}

/// Speeds of one signal before and after a candidate at a time.
pub(super) fn read(
    velocity: &Series,
    arcs: Arcs<'_>,
    index: usize,
    instant: Instant,
) -> Option<Reading> {
    let [before, after] = flights(velocity, arcs, index)?;
    let time = instant.time;
    Some(Reading {
        speeds: MassSpeeds {
            before_m_s: before.value(time),
            after_m_s: after.value(time),
        },
        errors_m_s: [&before, &after].map(|flight| velocity.noise * flight.error_factor(time)),
        slopes_m_s: [before.slope(time), after.slope(time)],
    })
}

/// The same without their errors.
pub(super) fn speeds(
    velocity: &Series,
    arcs: Arcs<'_>,
    index: usize,
    instant: Instant,
) -> Option<MassSpeeds> {
    Some(read(velocity, arcs, index, instant)?.speeds)
}
