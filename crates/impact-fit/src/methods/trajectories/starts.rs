//! Where the fit of the waveforms starts: with what the other methods know and, where that leaves most
//! records without a motion, with the best of many combinations of f0, β and `x_st`.
//!
//! A resonance curve of few points tells f0 and `x_st` only together, and what it then says of each may be
//! off by a factor. How many records have an orbit, and how well it fits them, tells combinations apart.

use rayon::prelude::*;

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::joint;
use crate::methods::resonance::fit::deflection_guess;
use crate::methods::thinning::every;
use crate::parameters::Parameters;
use crate::solver::{Block, mean_squares};
use impact_records::signal::robust;

/// Share of the periodic records that a good start gives an orbit.
const ENOUGH: f64 = 0.8;
/// Records that are looked at; of more, every second, third …
const MOST: usize = 24;
/// Natural frequencies that are tried, and the least and the greatest of them over the drive's.
const FREQUENCIES: usize = 24;
const FREQUENCY_RANGE: [f64; 2] = [0.6, 1.3];
/// Damping ratios that are tried.
const DAMPING: [f64; 4] = [0.01, 0.03, 0.08, 0.2];
/// Deflections that are tried, over that of the resonance curve or of the clearances.
const DEFLECTIONS: [f64; 7] = [0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.5];
/// Starts that are fitted.
const FITTED: usize = 4;
/// The score of a record without an orbit: as of one that fits a thousand times worse than its noise.
const LOST: f64 = 13.8;

/// The given start where it gives most records an orbit, else the best one.
pub(super) fn best(blocks: &Blocks, nominal: &Nominal, given: Parameters) -> Parameters {
    let few = thinned(blocks);
    if few.trajectory.records.is_empty() || with_orbits(&few, &given) >= ENOUGH {
        return given;
    }
    let mut tried: Vec<(f64, Parameters)> = grid(&few, nominal, given)
        .into_par_iter()
        .chain([given])
        .map(|start| (score(&few, &start), start))
        .collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    tried.truncate(FITTED);
    let fitted = tried.iter().filter_map(|(_, start)| {
        let fitted = fitted(&few, nominal, *start)?;
        Some((score(&few, &fitted), fitted))
    });
    let fitted: Vec<(f64, Parameters)> = fitted.collect();
    let all = tried.into_iter().chain(fitted);
    all.min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(given, |(_, start)| start)
}

/// The blocks with some of their records.
pub(super) fn thinned(blocks: &Blocks) -> Blocks {
    let records = &blocks.trajectory.records;
    let few = blocks.trajectory.with_records(every(records, MOST));
    let mut some = blocks.with_trajectory(few);
    some.resonance = blocks.resonance.few(MOST);
    some
}

/// Share of the periodic records that have an orbit.
fn with_orbits(blocks: &Blocks, at: &Parameters) -> f64 {
    let found = mean_squares(&blocks.trajectory, at);
    found.iter().flatten().count() as f64 / found.len().max(1) as f64
}

/// How badly records fit: the mean of the logarithms of their mean squares.
pub(super) fn score(blocks: &Blocks, at: &Parameters) -> f64 {
    let waveforms = mean_squares(&blocks.trajectory, at);
    let responses = mean_squares(&blocks.resonance, at);
    let scores: Vec<f64> = waveforms
        .iter()
        .chain(&responses)
        .map(|square| square.map_or(LOST, |s| s.max(1.0).ln().min(LOST)))
        .collect();
    robust::mean(&scores)
}

/// Combinations of f0, β and `x_st` with the given R.
fn grid(blocks: &Blocks, nominal: &Nominal, given: Parameters) -> Vec<Parameters> {
    let records = blocks.trajectory.records.iter();
    let driven = records.clone().map(|r| r.frequency_hz);
    let points = blocks.resonance.points.iter().map(|p| p.frequency_hz);
    let clearances: Vec<f64> = records.map(|r| r.clearance_m.abs()).collect();
    let Some((low, high)) = robust::range(driven.chain(points)) else {
        return Vec::new();
    };
    let [low, high] = [low * FREQUENCY_RANGE[0], high * FREQUENCY_RANGE[1]];
    let step = |i: usize| low * (high / low).powf(i as f64 / (FREQUENCIES - 1) as f64);
    let by_clearance = robust::median(&clearances).unwrap_or(1e-3);
    let mut all = Vec::new();
    for frequency_hz in (0..FREQUENCIES).map(step) {
        for damping in DAMPING {
            let unit = nominal.applied(Parameters::symmetric(
                given.restitution,
                frequency_hz,
                damping,
                1.0,
            ));
            let deflection_m = match blocks.resonance.items() {
                0 => by_clearance,
                _ => deflection_guess(&blocks.resonance, &unit),
            };
            for share in DEFLECTIONS {
                let mut start = unit;
                start.static_deflection_m = share * deflection_m;
                all.push(start);
            }
        }
    }
    all
}

/// A rough fit of resonance curve and waveforms together, of the records with an orbit at the start.
pub(super) fn fitted(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<Parameters> {
    let found = mean_squares(&blocks.trajectory, &start);
    let records = blocks.trajectory.records.iter().zip(found);
    let with_orbit = records.filter(|(_, square)| square.is_some());
    let kept = with_orbit.map(|(record, _)| record.clone()).collect();
    let some = blocks.with_trajectory(blocks.trajectory.with_records(kept));
    let both = joint::curve_and_waveforms();
    joint::rough(&some, start, &both, &nominal.ideal()).map(|fit| fit.parameters)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};

    #[test]
    fn a_start_far_from_the_rig_is_replaced_and_one_near_it_is_kept() {
        let observations = observed(&recorded(0.8, 12.0, 50, 3));
        let evidence = evidence(&observations);
        let blocks = Blocks::new(&evidence);
        let nominal = evidence.nominal.ideal();
        let near = Parameters::symmetric(0.8, 12.02, 0.06, 1.01e-3);
        assert_eq!(best(&blocks, &nominal, near), near);
        // a quarter of the deflection, as a resonance curve of three points may have it
        let far = Parameters::symmetric(0.8, 13.5, 0.06, 0.25e-3);
        assert!(with_orbits(&blocks, &far) < ENOUGH);
        let found = best(&blocks, &nominal, far);
        assert!(
            (found.natural_frequency_hz / 12.0 - 1.0).abs() < 0.02,
            "{found:?}"
        );
        assert!(
            (found.static_deflection_m / 1e-3 - 1.0).abs() < 0.05,
            "{found:?}"
        );
    }
}
