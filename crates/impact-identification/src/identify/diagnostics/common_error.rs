//! Clearances that are all off alike: by one length, where they are counted from another zero than where the masses touch,
//! or by one factor, where they or the channels of motion have another scale.
//!
//! The errors of all clearances are those of a fit that is free to have them. Gains that are off show in it as errors in
//! proportion to the clearances, as far as their uncertainty goes; a factor beyond that is one of the clearances or of all
//! gains.

use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::parameters::{Coordinate, GAIN_ROLES, Parameters};
use impact_fit::solver::{Fit, Prior};
use impact_records::record::Role;
use impact_records::signal::columns::{dot, extremes};
use impact_records::signal::robust::{self, mean};

use super::doubt::{Doubt, Suspicion};
use super::off_stated::{self, Off};
use super::suspicion::{self, GAP_SURE};

/// Waveforms of each gap that are looked at.
pub const FEW: usize = 12;
/// Stated uncertainties that each clearance has at least in the fit that tells its error.
const OPEN: f64 = 20.0;
/// Share of that from which an error is far off, and times an error is that the clearance may be off by then.
const FAR: f64 = 0.5;
const FREE: f64 = 3.0;
/// Fewest gaps that tell an error of all from their own.
const FEWEST_GAPS: usize = 3;
/// Standard deviations of what is stated, of a gap and of what all share, from which it is named.
const NAMED: f64 = 4.0;
/// Greatest distance of a gap's error from the common one, over that.
const ALIKE: f64 = 0.4;

/// What is stated of the clearances' errors and of what takes their part.
#[derive(Debug, Clone, Copy)]
pub struct Stated {
    /// Standard uncertainty of each clearance, m.
    pub clearance_m: f64,
    /// Relative one of each gain.
    pub gain: f64,
    /// How many gains there are.
    pub gains: usize,
}

impl Stated {
    /// Relative standard uncertainty of what the gains have in common.
    fn of_all_gains(self) -> f64 {
        self.gain / (self.gains.max(1) as f64).sqrt()
    }
}

/// A fit that starts at errors of the clearances, m, of which each has a standard uncertainty, m.
pub type FitFrom<'a> = &'a dyn Fn(&[f64], f64) -> Option<Fit>;

/// The error that clearances share, by fits that are free to have errors of them: from the clearances as stated and, where these
/// are far off, from where flights put them. One gain that is off is no error that all share.
pub fn searched(
    gaps_m: &[f64],
    flown_m: Vec<f64>,
    stated: Stated,
    fit: FitFrom<'_>,
) -> Option<CommonError> {
    let open_m = OPEN * stated.clearance_m;
    let is_far = |errors_m: &[f64]| errors_m.iter().any(|e| e.abs() > FAR * open_m);
    let free = |from_m: &[f64]| {
        let most_m = from_m.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
        fit(from_m, open_m.max(FREE * most_m))
    };
    let as_stated_m = vec![0.0; gaps_m.len()];
    let starts = [Some(as_stated_m), is_far(&flown_m).then_some(flown_m)];
    let found = starts.into_iter().flatten().filter_map(|from_m| {
        let first = free(&from_m)?;
        let errors_m = errors_m(&first.parameters, gaps_m.len());
        // what is stated of clearances that are far off no longer holds the errors back
        if is_far(&errors_m) {
            free(&errors_m)
        } else {
            Some(first)
        }
    });
    let mean_square = |fit: &Fit| fit.cost / fit.residuals.max(1) as f64;
    let best = found.min_by(|a, b| mean_square(a).total_cmp(&mean_square(b)))?;
    let alike = gains_apart(&best) < NAMED * std::f64::consts::SQRT_2 * stated.gain;
    let errors_m = errors_m(&best.parameters, gaps_m.len());
    alike
        .then(|| CommonError::of(gaps_m, &errors_m, stated))
        .flatten()
}

/// The errors of all clearances that a fit found, m.
fn errors_m(found: &Parameters, gaps: usize) -> Vec<f64> {
    let of = |i| found.screw_zero_m + found.gap_errors_m.of(i);
    (0..gaps).map(of).collect()
}

/// How far the logarithms of the gains of a fit are apart.
fn gains_apart(fit: &Fit) -> f64 {
    let gains = fit.free.iter().filter_map(|c| c.gain());
    let logs: Vec<f64> = gains.map(|i| fit.parameters.gains[i].ln()).collect();
    let (low, high) = extremes(&logs);
    (high - low).max(0.0)
}

/// The error that all clearances share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CommonError {
    /// A length that must be added to them, m.
    Zero {
        /// That length.
        added_m: f64,
    },
    /// One factor of them: the motion channels read too much or too little, or the clearances do.
    Scale {
        /// Its logarithm, positive where the masses move as if all clearances were greater.
        share: f64,
        /// That over its standard error.
        z_score: f64,
    },
}

impl CommonError {
    /// The error that clearances share, by the errors that a fit found of them, m.
    fn of(gaps_m: &[f64], errors_m: &[f64], stated: Stated) -> Option<Self> {
        if gaps_m.len() < FEWEST_GAPS || gaps_m.len() != errors_m.len() {
            return None;
        }
        zero(gaps_m, errors_m, stated).or_else(|| scale(gaps_m, errors_m, stated))
    }

    /// The clearance that is meant by a stated one, m.
    pub fn corrected_m(self, stated_m: f64) -> f64 {
        match self {
            Self::Zero { added_m } => stated_m + added_m,
            Self::Scale { share, .. } => stated_m * share.exp(),
        }
    }

    /// That which a fit carries within the priors of the clearances, where it is beyond chance and explains their errors better
    /// than that of one clearance alone does.
    pub fn carried(gaps_m: &[f64], found: &MethodFit, uncertainty_m: f64) -> Option<Self> {
        let stated = |coordinate| Prior::new(coordinate, 0.0, 1e3 * uncertainty_m);
        let gaps = gaps_m.iter().enumerate();
        let scale: Vec<(Prior, f64)> = gaps
            .map(|(i, gap)| (stated(Coordinate::Gap(i)), 1e3 * gap))
            .collect();
        let scale = off_stated::along(found, &scale).filter(|_| scale.len() > 1);
        let zero = off_stated::alone(found, stated(Coordinate::ScrewZero));
        let zero = zero.filter(|_| gaps_m.len() >= FEWEST_GAPS);
        let of_scale = |off: Off| Self::Scale {
            share: off.by,
            z_score: off.z_score,
        };
        let of_zero = |off: Off| Self::Zero {
            added_m: 1e-3 * off.by,
        };
        let scale = scale.map(|off| (off.z_score.abs(), of_scale(off)));
        let zero = zero.map(|off| (off.z_score.abs(), of_zero(off)));
        let both = scale.into_iter().chain(zero);
        let (sure, error) = both.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let alone = suspicion::gaps_beyond_stated(gaps_m, found, uncertainty_m);
        let better = alone.iter().all(|odd| odd.z_score.abs() < sure);
        (sure > GAP_SURE && better).then_some(error)
    }

    /// The finding, with what it leaves open of `x_st`, which the gains tell if the clearances are off, and the clearances
    /// if the gains are.
    pub fn suspicion(self, gaps_m: &[f64], found: &MethodFit) -> Suspicion {
        let (finding, by) = match self {
            Self::Zero { added_m } => {
                let relative = robust::median(gaps_m).map_or(0.0, |gap| added_m / gap);
                (Finding::CommonZero { added_m }, relative)
            }
            Self::Scale { share, z_score } => {
                let deviation = share.exp_m1();
                let finding = match only_channel(found) {
                    Some(channel) => Finding::GainOrClearances {
                        channel,
                        deviation,
                        z_score,
                    },
                    None => Finding::GainsOrClearances { deviation, z_score },
                };
                (finding, share)
            }
        };
        let doubt = Doubt::material(found, Coordinate::Deflection, by.abs(), Note::InstrumentOff);
        Suspicion {
            finding,
            doubts: Vec::from_iter(doubt),
        }
    }
}

/// The one channel of motion of which a fit has a gain.
fn only_channel(found: &MethodFit) -> Option<Role> {
    let mut gains = found.fit.free.iter().filter_map(|c| c.gain());
    let only = gains.next().filter(|_| gains.next().is_none());
    GAIN_ROLES.get(only?).copied()
}

/// A length that all errors have in common but for what gains within their uncertainty add, and that explains them better
/// than a factor or one gap that is off does.
fn zero(gaps_m: &[f64], errors_m: &[f64], stated: Stated) -> Option<CommonError> {
    let slope = slope(gaps_m, errors_m, stated);
    let shares = gaps_m.iter().zip(errors_m).map(|(gap, e)| e - slope * gap);
    let shares: Vec<f64> = shares.collect();
    let added_m = mean(&shares);
    let apart = |share: &f64| share - added_m;
    let alike = shares
        .iter()
        .all(|share| apart(share).abs() < ALIKE * added_m.abs());
    let left: f64 = shares.iter().map(|share| apart(share).powi(2)).sum();
    let by_gains = slope.abs() < NAMED * stated.of_all_gains();
    let named = added_m.abs() > NAMED * std::f64::consts::SQRT_2 * stated.clearance_m;
    let better = left < left_by(factor(gaps_m, errors_m), gaps_m, errors_m)
        && left + (stated.clearance_m * slope / stated.of_all_gains()).powi(2)
            < left_by_one(errors_m);
    (alike && by_gains && named && better).then_some(CommonError::Zero { added_m })
}

/// A factor that all errors have in common, beyond what gains within their uncertainty are.
fn scale(gaps_m: &[f64], errors_m: &[f64], stated: Stated) -> Option<CommonError> {
    let factor = factor(gaps_m, errors_m);
    let mut shares = gaps_m.iter().zip(errors_m).map(|(gap, e)| e / gap);
    let alike = shares.all(|share| (share - factor).abs() < ALIKE * factor.abs());
    let of_clearances = stated.clearance_m / dot(gaps_m, gaps_m).sqrt();
    let z_score = factor / stated.of_all_gains().hypot(of_clearances);
    (alike && z_score.abs() > NAMED && factor > -1.0).then(|| CommonError::Scale {
        share: factor.ln_1p(),
        z_score,
    })
}

/// Slope of errors over gaps, whose standard uncertainties are as stated, by a line with a free intercept.
fn slope(gaps_m: &[f64], errors_m: &[f64], stated: Stated) -> f64 {
    let (gap, error) = (mean(gaps_m), mean(errors_m));
    let apart = gaps_m
        .iter()
        .zip(errors_m)
        .map(|(g, e)| (g - gap, e - error));
    let (squares, products) = apart.fold((0.0, 0.0), |(xx, xy), (x, y)| (xx + x * x, xy + x * y));
    let known = (stated.clearance_m / stated.of_all_gains().max(f64::MIN_POSITIVE)).powi(2);
    products / (squares + known)
}

/// The factor of the gaps that errors are nearest to.
fn factor(gaps_m: &[f64], errors_m: &[f64]) -> f64 {
    dot(gaps_m, errors_m) / dot(gaps_m, gaps_m)
}

/// Sum of the squares that a factor leaves of errors.
fn left_by(factor: f64, gaps_m: &[f64], errors_m: &[f64]) -> f64 {
    let left = gaps_m.iter().zip(errors_m).map(|(g, e)| e - factor * g);
    left.map(|left| left * left).sum()
}

/// Sum of the squares that the gap with the greatest error leaves, if it alone is off.
fn left_by_one(errors_m: &[f64]) -> f64 {
    let most = errors_m.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
    dot(errors_m, errors_m) - most * most
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::fixture::fitted;
    use nalgebra::{DMatrix, DVector};

    const GAPS_M: [f64; 3] = [0.4e-3, 0.8e-3, 1.4e-3];

    fn common(errors_m: [f64; 3]) -> Option<CommonError> {
        let stated = Stated {
            clearance_m: 1e-6,
            gain: 5e-3,
            gains: 1,
        };
        CommonError::of(&GAPS_M, &errors_m, stated)
    }

    fn added_m(errors_m: [f64; 3]) -> f64 {
        match common(errors_m) {
            Some(CommonError::Zero { added_m }) => added_m,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn gaps_that_are_off_alike_have_another_zero_and_one_that_is_off_has_not() {
        // 19e-6 in the mean, and what gains may add to a gap of 0.87 mm: 2.2e-3 of it
        assert!((added_m([19e-6, 21e-6, 17e-6]) - 20.9e-6).abs() < 0.1e-6);
        assert_eq!(common([19e-6, 1e-6, 0.0]), None);
        assert_eq!(common([1e-6, 2e-6, 0.0]), None);
    }

    #[test]
    fn gains_that_are_off_beside_another_zero_are_told_from_it() {
        // 21e-6 with 5e-3 of the gaps, which the prior of the gains takes a part of
        let added = added_m([23e-6, 25e-6, 28e-6]);
        assert!((added - 21.3e-6).abs() < 0.1e-6, "{added}");
    }

    #[test]
    fn clearances_off_by_a_factor_have_another_scale() {
        let found = common(GAPS_M.map(|gap| -0.1 * gap)).expect("an error");
        let CommonError::Scale { share, z_score } = found else {
            panic!("{found:?}");
        };
        assert!((share.exp() - 0.9).abs() < 1e-12);
        assert!((z_score + 20.0).abs() < 0.5, "{z_score}");
        assert!((found.corrected_m(1e-3) - 0.9e-3).abs() < 1e-12);
        // within what the gains may be off
        assert_eq!(common(GAPS_M.map(|gap| 0.01 * gap)), None);
    }
    const UNCERTAINTY_M: f64 = 1e-5;

    /// A fit whose data tell the clearances, which are off by so much, each within 1 µm; mm.
    fn carrying(errors_mm: [f64; 3]) -> MethodFit {
        let (data, prior) = (1e6, (1e3 * UNCERTAINTY_M).powi(-2));
        // unknowns: the zero, then the gaps
        let slopes = DMatrix::from_fn(3, 4, |i, k| f64::from(u8::from(k == 0 || k == i + 1)));
        let information = slopes.transpose() * &slopes * data + DMatrix::identity(4, 4) * prior;
        let covariance = information.try_inverse().expect("regular");
        let told = slopes.transpose() * DVector::from_row_slice(&errors_mm) * data;
        let solution = &covariance * told;
        let gaps = (0..3).map(Coordinate::Gap);
        let free: Vec<Coordinate> = std::iter::once(Coordinate::ScrewZero).chain(gaps).collect();
        let mut parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        for (coordinate, error) in free.iter().zip(&solution) {
            parameters = parameters.with(*coordinate, *error);
        }
        fitted(parameters, free, covariance)
    }

    fn carried(errors_mm: [f64; 3]) -> Option<CommonError> {
        CommonError::carried(&GAPS_M, &carrying(errors_mm), UNCERTAINTY_M)
    }

    #[test]
    fn valid_an_error_that_all_clearances_share_is_told_by_a_fit_that_carries_them() {
        let Some(CommonError::Zero { added_m }) = carried([0.08; 3]) else {
            panic!("no zero");
        };
        assert!((added_m - 8e-5).abs() < 1e-6, "{added_m}");
        let Some(CommonError::Scale { share, .. }) = carried(GAPS_M.map(|gap| 80.0 * gap)) else {
            panic!("no scale");
        };
        assert!((share - 0.08).abs() < 0.02, "{share}");
        assert_eq!(carried([0.0, 0.0, 0.09]), None);
        assert_eq!(carried([0.01, -0.01, 0.01]), None);
    }

    #[test]
    fn without_another_gain_the_one_channel_is_named_beside_the_clearances() {
        let scale = CommonError::Scale {
            share: 0.05,
            z_score: 6.0,
        };
        let finding = |free: &[Coordinate]| {
            let mut found = carrying([0.0; 3]);
            found.fit.free = free.to_vec();
            scale.suspicion(&GAPS_M, &found).finding
        };
        let both = [Coordinate::Gain(0), Coordinate::Gain(1)];
        assert!(matches!(finding(&both), Finding::GainsOrClearances { .. }));
        assert!(matches!(
            finding(&both[..1]),
            Finding::GainOrClearances { .. }
        ));
    }
}
