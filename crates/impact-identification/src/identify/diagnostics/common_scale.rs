//! Clearances that are all off by one ratio: the motion channels read too much or too little, or the clearances do.
//!
//! A fit carries the error of each clearance with a prior of the standard uncertainty u. If the clearances g are all
//! off by the share s, the priors' centres are s g instead of 0. With the errors e of the fit and their covariance C the
//! sum of squares then falls by (gᵀe/u²)²/I at s = (gᵀe/u²)/I, I = gᵀ(1/u² − C/u⁴)g; if one clearance alone is off,
//! by the same with a unit vector for g.

use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use crate::identify::diagnostics::suspicion::{self, GAP_SURE, INFORMED, OddGap};
use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::{Coordinate, GAIN_ROLES};

/// The share by which all clearances of a fit are off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonScale {
    /// The share, as a logarithm; positive where the masses move as if all clearances were greater.
    pub share: f64,
    /// The share over its standard error.
    pub z_score: f64,
}

/// The share by which all clearances are off, where they are off by it beyond chance and that explains their errors better
/// than one of them alone does.
pub fn common_scale(blocks: &Blocks, found: &MethodFit, uncertainty_m: f64) -> Option<CommonScale> {
    let all = of_clearances(found, &blocks.gaps_m, uncertainty_m)?;
    let alone = suspicion::gaps_beyond_stated(blocks, found, uncertainty_m);
    let better = |odd: &OddGap| odd.z_score.abs() < all.z_score.abs();
    (all.z_score.abs() > GAP_SURE && alone.iter().all(better)).then_some(all)
}

fn of_clearances(found: &MethodFit, gaps_m: &[f64], uncertainty_m: f64) -> Option<CommonScale> {
    let places = found.fit.free.iter().enumerate();
    let gaps: Vec<(usize, f64)> = places
        .filter_map(|(place, coordinate)| match coordinate {
            Coordinate::Gap(i) => Some((place, 1e3 * gaps_m.get(*i)?)),
            _ => None,
        })
        .collect();
    if gaps.len() < 2 || uncertainty_m <= 0.0 {
        return None;
    }
    let precision = (1e3 * uncertainty_m).powi(-2);
    let error = |place: usize| found.fit.parameters.coordinate(found.fit.free[place]);
    let score: f64 = gaps
        .iter()
        .map(|(i, gap)| precision * gap * error(*i))
        .sum();
    let stated: f64 = gaps.iter().map(|(_, gap)| precision * gap * gap).sum();
    let pairs = gaps.iter().flat_map(|a| gaps.iter().map(move |b| (a, b)));
    let left: f64 = pairs
        .map(|((i, a), (k, b))| a * b * found.fit.covariance[(*i, *k)] * found.factor)
        .sum();
    let information = stated - precision.powi(2) * left;
    (information > INFORMED * stated).then(|| CommonScale {
        share: score / information,
        z_score: score / information.sqrt(),
    })
}

/// The finding, and what it leaves open of `x_st`, which is read by the gains where the clearances are off, and by the
/// clearances where the gains are.
pub fn suspicion(scale: CommonScale, found: &MethodFit) -> Suspicion {
    let CommonScale { share, z_score } = scale;
    let mut gains = found.fit.free.iter().filter_map(|c| c.gain());
    let only = gains.next().filter(|_| gains.next().is_none());
    let deviation = share.exp_m1();
    let finding = match only.and_then(|i| GAIN_ROLES.get(i)) {
        Some(channel) => Finding::GainOrClearances {
            channel: *channel,
            deviation,
            z_score,
        },
        None => Finding::GainsOrClearances { deviation, z_score },
    };
    let doubt = Doubt::material(
        found,
        Coordinate::Deflection,
        share.abs(),
        Note::InstrumentOff,
    );
    Suspicion {
        finding,
        doubts: Vec::from_iter(doubt),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::fixture::fitted;
    use impact_fit::parameters::Parameters;
    use nalgebra::{DMatrix, DVector};

    const GAPS_M: [f64; 3] = [0.4e-3, 0.9e-3, 1.8e-3];
    const UNCERTAINTY_M: f64 = 1e-5;

    /// A fit whose data tell errors of clearances, mm, each within 1 µm.
    fn told(errors_mm: [f64; 3]) -> MethodFit {
        let (data, prior) = (1e6, (1e3 * UNCERTAINTY_M).powi(-2));
        let covariance = DMatrix::identity(3, 3) / (data + prior);
        let solution = &covariance * DVector::from_row_slice(&errors_mm) * data;
        let free: Vec<Coordinate> = (0..3).map(Coordinate::Gap).collect();
        let mut parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        for (coordinate, error) in free.iter().zip(&solution) {
            parameters = parameters.with(*coordinate, *error);
        }
        fitted(parameters, free, covariance)
    }

    #[test]
    fn valid_the_share_of_clearances_that_are_all_off_is_that_of_least_squares() {
        let all = told(GAPS_M.map(|gap_m| 0.05 * 1e3 * gap_m));
        let scale = of_clearances(&all, &GAPS_M, UNCERTAINTY_M).expect("a share");
        assert!((scale.share - 0.05).abs() < 1e-12, "{scale:?}");
        // 5 % of the clearances' norm, 2.05 mm, over 10 µm and 1 µm
        let expected = 0.05 * 4.21f64.sqrt() / 1.01e-4f64.sqrt();
        assert!((scale.z_score / expected - 1.0).abs() < 1e-9, "{scale:?}");
        assert_eq!(of_clearances(&all, &GAPS_M, 0.0), None);
    }

    #[test]
    fn one_clearance_that_is_off_is_no_common_share() {
        let one = told([0.0, 0.0, 0.09]);
        let scale = of_clearances(&one, &GAPS_M, UNCERTAINTY_M).expect("a share");
        assert!(scale.z_score < 0.09 / 1.01e-4f64.sqrt());
        let finding = |free: &[Coordinate]| {
            let mut found = one.clone();
            found.fit.free = free.to_vec();
            suspicion(scale, &found).finding
        };
        let channels = |finding| matches!(finding, Finding::GainsOrClearances { .. });
        assert!(channels(finding(&[
            Coordinate::Gain(0),
            Coordinate::Gain(1)
        ])));
        assert!(!channels(finding(&[Coordinate::Gain(0)])));
    }
}
