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
/// Deviation of the waveforms from those of a fit, over the waveforms, up to which it follows them: as of the resonance curve.
pub(super) const FITS: f64 = 0.01;
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
/// Most steps of a fit to the majority.
const CONCENTRATIONS: usize = 10;
/// The score of a record without an orbit: as of one that fits a thousand times worse than its noise.
const LOST: f64 = 13.8;

/// The given start where most records have an orbit and a fit from it follows them, else the best one.
pub(super) fn best(blocks: &Blocks, nominal: &Nominal, given: Parameters) -> Parameters {
    let few = thinned(blocks);
    let follows = || {
        let fitted = fitted(&few, nominal, given);
        fitted.is_some_and(|fitted| deviation(&few, &fitted) < FITS)
    };
    if few.trajectory.records.is_empty() || with_orbits(&few, &given) >= ENOUGH && follows() {
        return given;
    }
    let (_, best) = searched(&few, nominal, given);
    best
}

/// The fit of some records that scores best, and its score, of those from the likeliest starts and from the given one.
pub(super) fn searched(few: &Blocks, nominal: &Nominal, given: Parameters) -> (f64, Parameters) {
    let starts = likeliest(few, nominal, given).into_iter().chain([given]);
    let fits = starts.map(|start| {
        let whole = fitted(few, nominal, start).unwrap_or(start);
        fitted_to_majority(few, nominal, whole)
    });
    let scored = fits.map(|fit| (score(few, &fit), fit));
    let best = scored.min_by(|a, b| a.0.total_cmp(&b.0));
    best.unwrap_or((LOST, given))
}

/// Root mean square of what a fit leaves of the waveforms over that of the waveforms; a record without an orbit leaves all.
pub(super) fn deviation(blocks: &Blocks, fitted: &Parameters) -> f64 {
    let left = blocks.trajectory.differences(fitted);
    let records = blocks.trajectory.records.iter().zip(left);
    let each = records.map(|(record, left)| {
        let zeros = vec![0.0; left.as_ref().map_or(1, Vec::len)];
        let whole = robust::rms(&record.apart(&zeros));
        left.map_or(1.0, |left| robust::rms(&left) / whole)
    });
    robust::rms(&each.collect::<Vec<f64>>())
}

/// The combinations of f0, β and `x_st` that score best.
fn likeliest(few: &Blocks, nominal: &Nominal, given: Parameters) -> Vec<Parameters> {
    let scored = |start: Parameters| (score(few, &start), start);
    let grid = grid(few, nominal, given).into_par_iter();
    let mut tried: Vec<(f64, Parameters)> = grid.map(scored).collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = tried.into_iter().take(FITTED);
    best.map(|(_, start)| start).collect()
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
fn score(blocks: &Blocks, at: &Parameters) -> f64 {
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
fn fitted(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<Parameters> {
    fitted_to(blocks, nominal, start, blocks.trajectory.records.len())
}

/// The same of so many records at most, those that the start fits best.
fn fitted_to(
    blocks: &Blocks,
    nominal: &Nominal,
    start: Parameters,
    most: usize,
) -> Option<Parameters> {
    let found = mean_squares(&blocks.trajectory, &start);
    let records = blocks.trajectory.records.iter().zip(found);
    let mut with_orbit: Vec<_> = records
        .filter_map(|(r, square)| Some((square?, r)))
        .collect();
    if with_orbit.len() > most {
        with_orbit.sort_by(|a, b| a.0.total_cmp(&b.0));
        with_orbit.truncate(most);
    }
    let kept = with_orbit.into_iter().map(|(_, record)| record.clone());
    let some = blocks.with_trajectory(blocks.trajectory.with_records(kept.collect()));
    let both = joint::curve_and_waveforms();
    joint::rough(&some, start, &both, &nominal.ideal()).map(|fit| fit.parameters)
}

/// A fit to the majority of the records: of those that fit best, again and again, as long as the whole fits better. Records
/// whose motions are not those of the start do not pull it away (least trimmed squares by concentration steps; Rousseeuw
/// and Van Driessen 2006).
fn fitted_to_majority(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Parameters {
    let majority = blocks.trajectory.records.len() / 2 + 1;
    let mut best = (score(blocks, &start), start);
    for _ in 0..CONCENTRATIONS {
        let Some(next) = fitted_to(blocks, nominal, best.1, majority) else {
            break;
        };
        let next = (score(blocks, &next), next);
        if next.0 >= best.0 {
            break;
        }
        best = next;
    }
    best.1
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
