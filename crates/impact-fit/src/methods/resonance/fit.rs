//! f0, β and `x_st` from the impactless records.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{FitResult, alone};
use crate::methods::resonance::block::ResonanceBlock;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{FitError, Precision, mean_squares};

/// What the impactless records tell.
pub const TELLS: [Coordinate; 3] = [
    Coordinate::Frequency,
    Coordinate::Damping,
    Coordinate::Deflection,
];

/// f0, β and `x_st` from the impactless records; the gains' uncertainty enters `x_st`.
pub fn first(blocks: &Blocks, nominal: &Nominal) -> Option<FitResult> {
    if !enough(blocks) {
        return None;
    }
    match start(blocks, nominal) {
        Some(start) => from(blocks, nominal, start),
        None => Some(Err(FitError::Singular)),
    }
}

/// The best of several fits of few records without effects, from which that of all starts.
pub fn start(blocks: &Blocks, nominal: &Nominal) -> Option<Parameters> {
    if !enough(blocks) {
        return None;
    }
    let (few, ideal) = (blocks.resonance.few(MOST_FOR_A_START), nominal.ideal());
    let curve = |start| alone(&few, blocks, &ideal, &TELLS, start, Precision::Start).ok();
    let fits = starts(&few, nominal).into_iter().filter_map(curve);
    let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
    best.map(|best| best.fit.parameters)
}

/// The same from a start near the optimum.
pub fn from(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    let (curve, precision) = (&blocks.resonance, Precision::Result);
    enough(blocks).then(|| alone(curve, blocks, nominal, &TELLS, start, precision))
}

fn enough(blocks: &Blocks) -> bool {
    blocks.resonance.points.len() >= TELLS.len()
}

/// Impactless records from which the fit of all is started.
const MOST_FOR_A_START: usize = 64;

/// Starting values of the resonance curve: the stated ones, and a coarse grid whose deflection
/// follows from the greatest response. Where masses are stated that differ, springs, dashpots and drives are as unlike
/// as they, or equal.
fn starts(block: &ResonanceBlock, nominal: &Nominal) -> Vec<Parameters> {
    let frequencies: Vec<f64> = block.points.iter().map(|p| p.frequency_hz).collect();
    let low = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
    let high = frequencies.iter().copied().fold(0.0, f64::max);
    let mut out = Vec::new();
    let mut grid: Vec<f64> = (0..7)
        .map(|i| low * 0.8 * (high * 1.25 / (low * 0.8)).powf(f64::from(i) / 6.0))
        .collect();
    grid.extend(nominal.natural_frequency_hz);
    let unlike = nominal.mass_asymmetry.map_or(0.0, |[centre, _]| centre);
    let per_mass: &[f64] = if unlike == 0.0 {
        &[0.0]
    } else {
        &[0.0, -unlike]
    };
    for f0 in grid {
        let each = [0.01, 0.05, 0.2].into_iter();
        for (beta, per_mass) in each.flat_map(|beta| per_mass.iter().map(move |u| (beta, u))) {
            let beta = nominal.damping_ratio.unwrap_or(beta);
            let unit = Parameters {
                drive_asymmetry: nominal
                    .drive_asymmetry
                    .map_or(*per_mass, |[centre, _]| centre),
                stiffness_asymmetry: *per_mass,
                damping_asymmetry: *per_mass,
                ..nominal.applied(Parameters::symmetric(0.8, f0, beta, 1.0))
            };
            out.push(Parameters {
                static_deflection_m: deflection_guess(block, &unit),
                ..unit
            });
        }
    }
    let cost = |p: Parameters| {
        let mean_squares = mean_squares(block, &p);
        (mean_squares.into_iter().flatten().sum::<f64>(), p)
    };
    let mut costs: Vec<(f64, Parameters)> = out.into_iter().map(cost).collect();
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs.into_iter().take(3).map(|(_, start)| start).collect()
}

/// Deflection that best scales the unit response to the measured amplitudes.
pub fn deflection_guess(block: &ResonanceBlock, unit: &Parameters) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for point in &block.points {
        for r in &point.responses {
            let model = block.response(unit, point, r.role);
            let weight = r.error.hypot(1e-2 * r.amplitude()).powi(-2);
            product += weight * model.norm() * r.amplitude();
            square += weight * model.norm_sqr();
        }
    }
    if square > 0.0 { product / square } else { 1e-3 }
}
