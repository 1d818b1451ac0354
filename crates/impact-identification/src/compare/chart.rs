//! The unknowns in which the Gaussians of several campaigns are added.
//!
//! A fit does not change if `x_st` and all clearances grow by one factor and the gains fall by it. In `ln x_st`,
//! the logarithms of the gains and those of the clearances that direction is the same wherever each campaign's
//! optimum lies; in the errors of the clearances it is not, and what two precise campaigns share would not
//! cancel. So a clearance whose error is shared enters by its logarithm.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use crate::compare::Campaign;
use crate::compare::share::{Nuisance, Sharing};
use impact_fit::JointFit;
use impact_fit::parameters::coordinate::Coordinate;

/// Share of a stated clearance that the fitted one must reach for its logarithm to stand for its error.
const LEAST_SHARE: f64 = 0.5;

/// The clearances that enter by their logarithms: those that are shared with the common error of all
/// clearances, and far from closed in every campaign.
pub(super) fn relative(campaigns: &[Campaign], sharing: &Sharing) -> BTreeSet<Nuisance> {
    let fits: Vec<&JointFit> = campaigns.iter().filter_map(|c| c.fit.as_ref()).collect();
    let zero = Nuisance::Of(Coordinate::ScrewZero);
    let mut of_zero = sharing.shared.iter().filter(|(n, _)| *n == zero);
    let sharing_zero = of_zero.next().map(|(_, shared)| &shared.campaigns);
    let zero_is_free = |fit: &&JointFit| fit.fit.free.contains(&Coordinate::ScrewZero);
    let zero_is_free = fits.iter().any(zero_is_free);
    let shared = sharing.shared.iter();
    shared
        .filter(|(_, shared)| !zero_is_free || sharing_zero == Some(&shared.campaigns))
        .map(|(nuisance, _)| *nuisance)
        .filter(|nuisance| fits.iter().all(|fit| is_open(fit, *nuisance)))
        .collect()
}

/// Whether a nuisance is the error of a clearance that is far from closed, if a fit has it at all.
fn is_open(joint: &JointFit, nuisance: Nuisance) -> bool {
    let Nuisance::Clearance(_) = nuisance else {
        return false;
    };
    let mut free = joint.fit.free.iter();
    match free.find(|c| Nuisance::of(**c, joint) == Some(nuisance)) {
        Some(Coordinate::Gap(place)) => {
            let stated_m = joint.gaps_m.get(*place).copied().unwrap_or(0.0);
            stated_m > 0.0 && fitted_m(joint, *place) > LEAST_SHARE * stated_m
        }
        _ => true,
    }
}

/// A clearance as the fit has it, m.
fn fitted_m(joint: &JointFit, place: usize) -> f64 {
    let parameters = &joint.fit.parameters;
    let stated_m = joint.gaps_m.get(place).copied().unwrap_or(0.0);
    stated_m + parameters.screw_zero_m + parameters.gap_errors_m.of(place)
}

/// The unknowns of a joint fit: its free coordinates, but ln of the clearance in mm instead of its error.
pub(super) struct Chart {
    /// Values of the unknowns at the optimum.
    values: DVector<f64>,
    /// Values of the coordinates there.
    coordinates: DVector<f64>,
    /// Slopes of the coordinates over the unknowns.
    slopes: DMatrix<f64>,
}

impl Chart {
    /// Of a joint fit, where some clearances enter by their logarithms.
    pub(super) fn new(joint: &JointFit, relative: &BTreeSet<Nuisance>) -> Self {
        let free = &joint.fit.free;
        let at = |c: &Coordinate| joint.fit.parameters.coordinate(*c);
        let coordinates = DVector::from_iterator(free.len(), free.iter().map(at));
        let mut values = coordinates.clone();
        let mut slopes = DMatrix::identity(free.len(), free.len());
        let zero = free.iter().position(|c| *c == Coordinate::ScrewZero);
        for (i, coordinate) in free.iter().enumerate() {
            let is_relative = Nuisance::of(*coordinate, joint).filter(|n| relative.contains(n));
            let (Coordinate::Gap(place), Some(_)) = (coordinate, is_relative) else {
                continue;
            };
            let fitted_mm = 1e3 * fitted_m(joint, *place);
            values[i] = fitted_mm.ln();
            slopes[(i, i)] = fitted_mm;
            if let Some(zero) = zero {
                slopes[(i, zero)] = -1.0;
            }
        }
        Self {
            values,
            coordinates,
            slopes,
        }
    }

    /// Values of the unknowns at the optimum.
    pub(super) fn values(&self) -> &DVector<f64> {
        &self.values
    }

    /// Information about the unknowns from that about the coordinates.
    pub(super) fn information(&self, of_coordinates: &DMatrix<f64>) -> DMatrix<f64> {
        self.slopes.transpose() * of_coordinates * &self.slopes
    }

    /// A prior on a coordinate with a centre: the multiples of the unknowns whose sum it is on, and the
    /// centre of that sum of their deviations from a reference.
    pub(super) fn prior(
        &self,
        coordinate: usize,
        centre: f64,
        reference: &DVector<f64>,
    ) -> (Vec<(usize, f64)>, f64) {
        let slopes = self.slopes.row(coordinate);
        let row: Vec<(usize, f64)> = slopes
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, slope)| *slope != 0.0)
            .collect();
        let deviations = &self.values - reference;
        let here: f64 = row.iter().map(|(k, slope)| slope * deviations[*k]).sum();
        (row, centre + here - self.coordinates[coordinate])
    }
}
