//! Times of impacts from the velocity alone: the bodies touch at every impact, so that the relative
//! displacement is the same at both ends of an arc between two impacts.
//!
//! Unknown are the shift `δ_k` of each impact within its sample interval and the level L of the
//! velocity in each arc. For arc k of duration T, with the speeds beside its ends,
//!
//! area + `v₋δ_{k+1}` − `v₊δ_k` = `T L_k`.
//!
//! Undoing a high-pass of corner ω integrates the signal by trapezoids, as if each jump J were in the
//! middle of its interval: a shift δ leaves the level of all later arcs off by −ωJδ over the rate,
//! noise makes it walk, and the lost mean of the signal gives it a slope. So
//! `L_{k+1}` = `L_k` − `c_{k+1}δ_{k+1}` + slope + walk. The least squares of both are those of a Kalman
//! filter over `(δ_k, δ_{k+1}, L_k, slope)` and its smoother (Rauch, Tung and Striebel 1965).
//!
//! The filter takes the shifts for independent before the arcs tell of them. Where the period of a motion is close to a
//! whole number of samples, its impacts all have the same shift, which no arc tells from the level: its error is then
//! that of any place within the sample interval, as far as the places of the impacts are not spread over it.

use nalgebra::{Matrix4, Vector4};

use crate::event::arcs::{Arcs, Instant, speeds};
use crate::event::drift::integral;
use crate::event::impact::MassSpeeds;
use crate::event::kinematics::{Body, Kinematics, RelativeSource, Series};
use crate::signal::{kalman, robust};

/// Relative error of an arc's area by trapezoids: it scales with the speeds.
const TRAPEZOIDS: f64 = 1e-3;

/// Impacts from which arcs tell where in their sample intervals they were.
const FEWEST: usize = 3;

/// How the level of the relative velocity changes from arc to arc.
struct Drift {
    /// Of each impact, by how much a shift of it lowers the level of all later arcs, m/s per sample.
    by_shift: Vec<f64>,
    /// Variance that noise adds to the level per sample.
    walk: f64,
    /// Whether the level has a slope.
    slopes: bool,
}

impl Drift {
    fn of(kinematics: &Kinematics, arcs: Arcs<'_>, plain: &[Instant]) -> Self {
        let factor = match kinematics.relative_from {
            Some(RelativeSource::Doubled) => 2.0,
            _ => 1.0,
        };
        let mut drift = Self {
            by_shift: vec![0.0; plain.len()],
            walk: 0.0,
            slopes: false,
        };
        for Body { velocity, .. } in [&kinematics.x, &kinematics.y] {
            let Some(velocity) = velocity else { continue };
            let Some(corner_hz) = velocity.high_pass_hz else {
                continue;
            };
            let per_sample = factor * std::f64::consts::TAU * corner_hz / kinematics.rate_hz;
            // What was integrated itself walks by its noise.
            let step = if corner_hz > 0.0 {
                per_sample * velocity.noise
            } else {
                factor * velocity.noise
            };
            drift.walk += step * step;
            drift.slopes = true;
            for (i, by_shift) in drift.by_shift.iter_mut().enumerate() {
                if let Some(s) = speeds(velocity, arcs, i, plain[i]) {
                    *by_shift += per_sample * s.jump_m_s();
                }
            }
        }
        drift
    }
}

/// Mean and covariance of `(δ_k, δ_{k+1}, L_k, slope)`.
#[derive(Clone, Copy)]
struct State {
    mean: Vector4<f64>,
    covariance: Matrix4<f64>,
}

impl State {
    fn moved(&self, flow: &Matrix4<f64>, noise: &Matrix4<f64>) -> Self {
        Self {
            mean: flow * self.mean,
            covariance: flow * self.covariance * flow.transpose() + noise,
        }
    }

    /// The same with what later arcs tell: `predicted` of the next state by this one, `later` as it is.
    fn smoothed(&self, flow: &Matrix4<f64>, predicted: &Self, later: &Self) -> Option<Self> {
        let back = self.covariance * flow.transpose() * predicted.covariance.try_inverse()?;
        let difference = later.covariance - predicted.covariance;
        Some(Self {
            mean: self.mean + back * (later.mean - predicted.mean),
            covariance: self.covariance + back * difference * back.transpose(),
        })
    }
}

/// A step from one arc to the next.
struct Step {
    filtered: State,
    flow: Matrix4<f64>,
    predicted: State,
}

/// The times of all impacts, from the middles of their sample intervals.
pub(super) fn arc_times(
    kinematics: &Kinematics,
    velocity: &Series,
    arcs: Arcs<'_>,
    plain: &[Instant],
) -> Vec<Instant> {
    let count = plain.len();
    if count < FEWEST {
        return plain.to_vec();
    }
    let beside: Vec<Option<MassSpeeds>> = (0..count)
        .map(|i| speeds(velocity, arcs, i, plain[i]))
        .collect();
    let drift = Drift::of(kinematics, arcs, plain);
    let Some(states) = smoothed(velocity, plain, &beside, &drift) else {
        return plain.to_vec();
    };
    let shift = |i: usize| match states.get(i) {
        Some(state) => (state.mean[0], state.covariance[(0, 0)]),
        None => {
            let last = &states[states.len() - 1];
            (last.mean[1], last.covariance[(1, 1)])
        }
    };
    let alike = alike(plain);
    (0..count)
        .map(|i| {
            let half = 0.5 * arcs.candidates[i].jump.gap as f64;
            let (mean, variance) = shift(i);
            let shared = alike * plain[i].error.powi(2);
            Instant {
                time: plain[i].time + mean.clamp(-half, half),
                error: (variance.max(0.0) + shared).sqrt().min(plain[i].error),
            }
        })
        .collect()
}

/// Impacts of a period at most of which the places in their sample intervals are compared.
const MOST_ALIKE: usize = 8;

/// The correlation between the shifts of two impacts of a record of the same kind, in the mean over all pairs: 1 where the
/// period is a whole number of samples, 0 where the impacts are spread over the sample interval or have no period.
fn alike(plain: &[Instant]) -> f64 {
    let lags = 1..=MOST_ALIKE.min(plain.len() / FEWEST);
    let Some((lag, period)) = lags
        .into_iter()
        .find_map(|lag| Some((lag, period(plain, lag)?)))
    else {
        return 0.0;
    };
    let count = plain.len() / lag;
    let pairs = (1..count).map(|apart| {
        let place = (apart as f64 * period).rem_euclid(1.0);
        (count - apart) as f64 * correlation_of_places(place)
    });
    let possible = 0.5 * (count * (count - 1)) as f64;
    (pairs.sum::<f64>() / possible).max(0.0)
}

/// Correlation of the errors of two impacts whose places between samples are Δ of 0 to 1 sampling intervals apart, where
/// an error runs evenly through its range from one sample to the next: 1 − 6Δ(1 − Δ).
pub fn correlation_of_places(apart: f64) -> f64 {
    1.0 - 6.0 * apart * (1.0 - apart)
}

/// The time between each impact and the one so many later, in samples, by least squares, if all are that but for the
/// sampling.
fn period(plain: &[Instant], lag: usize) -> Option<f64> {
    let later = plain.iter().skip(lag);
    let between: Vec<f64> = plain
        .iter()
        .zip(later)
        .map(|(a, b)| b.time - a.time)
        .collect();
    let mean = robust::mean(&between);
    if between.iter().any(|b| (b - mean).abs() >= 1.0) {
        return None;
    }
    let count = plain.len() / lag;
    let middle = 0.5 * (count - 1) as f64;
    let (mut both, mut own) = (0.0, 0.0);
    for (i, instant) in plain[..count * lag].iter().enumerate() {
        let from_middle = (i / lag) as f64 - middle;
        both += from_middle * instant.time;
        own += from_middle * from_middle;
    }
    Some(both / own)
}

/// The states of all arcs.
fn smoothed(
    velocity: &Series,
    plain: &[Instant],
    beside: &[Option<MassSpeeds>],
    drift: &Drift,
) -> Option<Vec<State>> {
    let known = beside.iter().flatten();
    let fastest = known.map(|s| s.before_m_s.abs()).fold(0.0, f64::max);
    if fastest <= 0.0 {
        return None;
    }
    let span = plain[1].time - plain[0].time;
    let prior = |i: usize| plain[i].error.powi(2);
    let mut state = State {
        mean: Vector4::zeros(),
        covariance: Matrix4::from_diagonal(&Vector4::new(
            prior(0),
            prior(1),
            fastest * fastest,
            (fastest / span).powi(2),
        )),
    };
    let mut steps = Vec::with_capacity(plain.len());
    for k in 0..plain.len() - 1 {
        let (from, to) = (plain[k].time, plain[k + 1].time);
        if let (Some(start), Some(end)) = (beside[k], beside[k + 1])
            && let Some(area) = integral(&velocity.values, from, to)
        {
            let row = Vector4::new(-start.after_m_s, end.before_m_s, from - to, 0.0);
            // Noise adds up over the arc.
            let error = velocity.noise * (to - from).sqrt() + TRAPEZOIDS * end.before_m_s.abs();
            kalman::update(
                &mut state.mean,
                &mut state.covariance,
                row,
                -area,
                error * error,
            );
        }
        let Some(next) = plain.get(k + 2) else { break };
        let between = 0.5 * (next.time - from);
        let mut flow = Matrix4::zeros();
        flow[(0, 1)] = 1.0;
        flow[(2, 1)] = -drift.by_shift[k + 1];
        flow[(2, 2)] = 1.0;
        flow[(2, 3)] = if drift.slopes { between } else { 0.0 };
        flow[(3, 3)] = 1.0;
        let noise = Vector4::new(0.0, prior(k + 2), drift.walk * between, 0.0);
        let predicted = state.moved(&flow, &Matrix4::from_diagonal(&noise));
        steps.push(Step {
            filtered: state,
            flow,
            predicted,
        });
        state = predicted;
    }
    let mut states = vec![state];
    for step in steps.iter().rev() {
        let later = states[states.len() - 1];
        let here = step.filtered.smoothed(&step.flow, &step.predicted, &later);
        states.push(here.unwrap_or(step.filtered));
    }
    states.reverse();
    Some(states)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::arcs::Candidate;
    use crate::event::impact::DetectionSource;
    use crate::event::jumps::Jump;
    use crate::event::kinematics::Body;
    use crate::record::Role;

    const RATE_HZ: f64 = 2000.0;
    /// Samples of a flight, speed before an impact in m/s, restitution.
    const FLIGHT: f64 = 120.37;
    const SPEED: f64 = 0.3;
    const RESTITUTION: f64 = 0.8;
    const CORNER_HZ: f64 = 0.4;

    /// A flight v = V(−R + as + bs²), s = 0…1, whose mean is zero: a = 4R − 2, b = 3(1 − R).
    fn flight(s: f64) -> f64 {
        let (a, b) = (4.0 * RESTITUTION - 2.0, 3.0 * (1.0 - RESTITUTION));
        SPEED * (-RESTITUTION + s * (a + s * b))
    }

    fn impact(k: usize) -> f64 {
        FLIGHT * (k as f64 + 0.4)
    }

    /// A long record whose high-pass was undone by trapezoids: after each jump the velocity is off by
    /// what the trapezoid has wrong, which adds up.
    fn undone(samples: usize) -> Kinematics {
        let omega = std::f64::consts::TAU * CORNER_HZ / RATE_HZ;
        let mut level = 0.0;
        let mut next = 0;
        let values: Vec<f64> = (0..samples)
            .map(|i| {
                let at = i as f64;
                if at > impact(next) {
                    let left = impact(next).floor();
                    let jump = (1.0 + RESTITUTION) * SPEED;
                    level -= omega * jump * (impact(next) - left - 0.5);
                    next += 1;
                }
                flight((at / FLIGHT + 0.6).fract()) + level
            })
            .collect();
        let velocity = Series {
            role: Role::VelocityX,
            values,
            noise: 1e-6,
            high_pass_hz: Some(CORNER_HZ),
            spread: 0,
        };
        let body = Body {
            velocity: Some(velocity),
            displacement: None,
        };
        Kinematics {
            rate_hz: RATE_HZ,
            x: body.clone(),
            y: Body::default(),
            relative: body,
            relative_from: Some(RelativeSource::One),
            waveform: None,
            spikes_clipped: false,
        }
    }

    /// Two impacts of a period, at shares of it.
    fn twice_a_period(samples: f64) -> Vec<Instant> {
        let at =
            |k: usize| samples * (((k / 2) as f64) + if k.is_multiple_of(2) { 0.21 } else { 0.63 });
        let middle = |k: usize| Instant {
            time: at(k).floor() + 0.5,
            error: 12_f64.sqrt().recip(),
        };
        (0..60).map(middle).collect()
    }

    #[test]
    fn valid_shifts_are_shared_where_a_period_is_a_whole_number_of_samples() {
        assert!(alike(&twice_a_period(73.0)) > 0.999);
        assert!(alike(&twice_a_period(73.003)) > 0.3);
        for spread in [73.381_966, 72.118_034, 73.05] {
            let shared = alike(&twice_a_period(spread));
            assert!(shared < 0.1, "{spread}: {shared}");
        }
        let half = alike(&twice_a_period(73.5));
        assert!((half - 0.25).abs() < 0.1, "{half}");
    }

    #[test]
    fn valid_times_in_a_long_record_follow_although_its_undone_high_pass_drifts() {
        let samples = 20_000;
        let kinematics = undone(samples);
        let candidates: Vec<Candidate> = (0..)
            .map(impact)
            .take_while(|t| *t < samples as f64 - 40.0)
            .map(|t| Candidate {
                jump: Jump {
                    left: crate::signal::whole::index(t.floor()),
                    gap: 1,
                    height: -(1.0 + RESTITUTION) * SPEED,
                    error: 1e-6,
                },
                source: DetectionSource::Velocity,
                calm_from: 0,
                dead_samples: 0.0,
            })
            .collect();
        assert!(candidates.len() > 150);
        let arcs = Arcs {
            candidates: &candidates,
            samples: 16,
        };
        let plain: Vec<Instant> = candidates
            .iter()
            .map(|c| Instant {
                time: c.jump.middle(),
                error: c.middle_error(),
            })
            .collect();
        let velocity = kinematics.relative.velocity.as_ref().expect("a velocity");
        let found = arc_times(&kinematics, velocity, arcs, &plain);
        let apart = found
            .iter()
            .enumerate()
            .map(|(k, instant)| instant.time - impact(k));
        let mean_square = apart.map(|d| d * d).sum::<f64>() / found.len() as f64;
        // The middles are 1/√12 = 0.29 samples off.
        assert!(mean_square.sqrt() < 0.1, "{}", mean_square.sqrt());
    }
}
