//! How a velocity rings beside its jumps, and what that leaves of its flights.

use crate::event::arcs::{Arcs, Candidate, flights};
use crate::event::kinematics::Series;
use crate::signal::local_fit::LocalFit;
use crate::signal::{ringing, robust};

/// Height of a jump, over the third, from which it is one of those by which ringing is told.
const STRONG: f64 = 0.5;

/// How a velocity rings beside its strong jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ringing {
    /// Samples before and after a jump in which it rings.
    pub(super) beside: [f64; 2],
    /// What the flights beside the jumps leave; where it neither rings nor was smoothed nobody asks for it.
    pub(super) rough: Option<Roughness>,
}

/// What the flights beside strong jumps leave of a velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Roughness {
    /// Mean square of what they leave, (m/s)².
    pub(super) left: f64,
    /// Their samples.
    pub(super) samples: usize,
    /// Variance of a flight's value in the middle of the jump over that of its noise.
    pub(super) factor: f64,
    /// Usual samples from one jump to the next.
    pub(super) apart: f64,
}

impl Ringing {
    /// That of a velocity with jumps and flights beside these; `None` where few are strong.
    pub(super) fn of(velocity: &Series, all: Arcs<'_>) -> Option<Self> {
        let height = |c: &Candidate| c.jump.height.abs();
        let mut heights: Vec<f64> = all.candidates.iter().map(height).collect();
        heights.sort_by(|a, b| b.total_cmp(a));
        // one or two may be misread
        let usual = *heights.get(ringing::FEWEST - 1)?;
        let strong = all.candidates.iter().filter(|c| height(c) > STRONG * usual);
        let strong: Vec<Candidate> = strong.cloned().collect();
        let jumps: Vec<f64> = strong.iter().map(|c| c.jump.middle()).collect();
        let size = robust::robust_deviation(&velocity.values).unwrap_or(0.0);
        let beside = ringing::beside_impacts(&velocity.values, &jumps, size);
        let asked = beside != [0.0; 2] || velocity.spread > 0;
        let rough = asked.then(|| Roughness::of(velocity, all.of(&strong), &jumps));
        Some(Self {
            beside,
            rough: rough.flatten(),
        })
    }
}

impl Roughness {
    fn of(velocity: &Series, strong: Arcs<'_>, jumps: &[f64]) -> Option<Self> {
        let mut beside: Vec<(LocalFit, f64)> = Vec::new();
        for (i, at) in jumps.iter().enumerate() {
            let both = flights(velocity, strong, i).into_iter().flatten();
            beside.extend(both.map(|flight| (flight, *at)));
        }
        let left: Vec<f64> = beside.iter().map(|(flight, _)| left(flight)).collect();
        let factors = beside
            .iter()
            .map(|(flight, at)| flight.error_factor(*at).powi(2));
        let factors: Vec<f64> = factors.collect();
        let apart: Vec<f64> = jumps.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Some(Self {
            left: robust::median(&left)?,
            samples: beside.iter().map(|(flight, _)| flight.samples).sum(),
            factor: robust::median(&factors)?,
            apart: robust::median(&apart)?,
        })
    }
}

/// Variance of the noise beside a polynomial of a flight, from what it leaves, (m/s)².
fn left(flight: &LocalFit) -> f64 {
    flight.residual_squares / flight.freedom().max(1) as f64
}
