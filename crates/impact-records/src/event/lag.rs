//! What delays of the channels change of the approach speeds at instantaneous impacts.
//!
//! The kink of the displacements places an impact. If a velocity's channel is later than that, by L beyond what
//! is assumed, its flights before and after are read too early by L: by L times their accelerations. The drift
//! is removed so that the mean velocity from kink to kink is zero; shifted by L that mean is off by L times the
//! jumps of velocity over the time between impacts.

use crate::event::arcs::{Arcs, Candidate, Instant, flights};
use crate::event::contact_samples::measured_velocity;
use crate::event::finite_contact::FiniteContact;
use crate::event::impact::Lag;
use crate::event::kinematics::{Body, Kinematics, RelativeSource};
use crate::record::Role;
use crate::signal::local_fit::LocalFit;

/// Of every impact, per mass; `None` where contacts last, or the time is not that of a kink of measured
/// displacements.
pub(super) fn lags(
    kinematics: &Kinematics,
    arcs: Arcs<'_>,
    instants: &[Instant],
    contact: Option<&FiniteContact>,
) -> Vec<[Option<Lag>; 2]> {
    let lasting = contact.is_some_and(|c| c.duration > 0.0);
    if lasting || kinematics.relative.displacement.is_none() {
        return vec![[None, None]; arcs.candidates.len()];
    }
    let assumed = contact.map_or([0.0; 2], |c| c.delays);
    let of = |(i, candidate): (usize, &Candidate)| {
        let placed = candidate.dead_samples == 0.0 && instants[i].error < candidate.middle_error();
        let read = |body: &Body, delay: f64| {
            let fits = flights(measured_velocity(body)?, arcs, i)?;
            Read::of(body, fits, (instants[i].time, delay), kinematics)
        };
        if placed {
            [
                read(&kinematics.x, assumed[0]),
                read(&kinematics.y, assumed[1]),
            ]
        } else {
            [None, None]
        }
    };
    let read: Vec<[Option<Read>; 2]> = arcs.candidates.iter().enumerate().map(of).collect();
    let per_second = arcs_per_second(instants, kinematics.rate_hz);
    let drifts = [0, 1].map(|body| {
        let jumps: Vec<f64> = read
            .iter()
            .filter_map(|r| Some(r[body]?.jump_m_s))
            .collect();
        per_second * jumps.iter().sum::<f64>() / jumps.len().max(1) as f64
    });
    let bodies = kinematics.bodies().count();
    let complete = |masses: &[Option<Read>; 2]| masses.iter().flatten().count() == bodies;
    let shared = |masses: &[Option<Read>; 2]| {
        let jump_m_s: f64 = masses.iter().flatten().map(|m| m.jump_m_s).sum();
        let known = complete(masses) && jump_m_s > 0.0;
        [0, 1].map(|body| {
            let mass = masses[body].filter(|_| known)?;
            Some(mass.lag(mass.jump_m_s / jump_m_s, drifts[body]))
        })
    };
    read.iter().map(shared).collect()
}

/// Flights between impacts over the time from the first to the last one, 1/s.
fn arcs_per_second(instants: &[Instant], rate_hz: f64) -> f64 {
    match instants {
        [first, .., last] if last.time > first.time => {
            (instants.len() - 1) as f64 * rate_hz / (last.time - first.time)
        }
        _ => 0.0,
    }
}

/// One mass's velocity beside an impact.
#[derive(Clone, Copy)]
struct Read {
    velocity: Role,
    displacement: Role,
    assumed_s: f64,
    /// What the mass adds to the jump of the approach velocity, m/s.
    jump_m_s: f64,
    /// To its acceleration before and after, m/s².
    accelerations_m_s2: [f64; 2],
}

impl Read {
    /// From the flights before and after, at the kink and a delay, samples.
    fn of(
        body: &Body,
        fits: [LocalFit; 2],
        (kink, delay): (f64, f64),
        kinematics: &Kinematics,
    ) -> Option<Self> {
        let factor = match kinematics.relative_from? {
            RelativeSource::Doubled => 2.0,
            RelativeSource::Both | RelativeSource::One => 1.0,
        };
        let [before, after] = fits.each_ref().map(|f| f.value(kink + delay));
        let rate_hz = kinematics.rate_hz;
        Some(Self {
            velocity: measured_velocity(body)?.role,
            displacement: body.displacement.as_ref()?.role,
            assumed_s: delay / rate_hz,
            jump_m_s: factor * (before - after),
            accelerations_m_s2: fits.map(|f| factor * rate_hz * f.slope(kink + delay)),
        })
    }

    /// With its share of the jump, and what a later jump changes of the drift, m/s².
    fn lag(self, share: f64, drift_m_s2: f64) -> Lag {
        Lag {
            velocity: self.velocity,
            displacement: self.displacement,
            share,
            assumed_s: self.assumed_s,
            accelerations_m_s2: self.accelerations_m_s2.map(|a| a - drift_m_s2),
        }
    }
}
