//! Whether an alternation between impacts dies away.
//!
//! A motion that settles with a multiplier near −1, as near a period doubling, repeats after two of its periods nearly as well as
//! one that has doubled. The speeds of its impacts tell the two apart: of
//!
//! `s_k` = c + g k + (−1)^k (a + b k), k from the middle of the record,
//!
//! a doubled motion has b = 0, and where an alternation dies away b is against a.

use nalgebra::{DMatrix, DVector};

use crate::event::Impact;
use crate::signal::robust;

/// Fewest impacts that tell: two more than there are unknowns.
const FEWEST: usize = 6;
/// Standard errors from which an alternation changes; they are no less than those of the speeds themselves, so that few
/// impacts do not by chance follow the line too well.
const CHANGES: f64 = 4.0;

/// How an alternation of impacts changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// It dies away.
    Dies,
    /// It grows.
    Grows,
}

/// How the alternation of the impacts' speeds changes; `None` where it stays, or they do not tell.
pub(super) fn change(impacts: &[Impact]) -> Option<Change> {
    match score(impacts)? {
        score if score < -CHANGES => Some(Change::Dies),
        score if score > CHANGES => Some(Change::Grows),
        _ => None,
    }
}

/// b over its standard error, with the sign of its growth; `None` of few impacts with speeds.
fn score(impacts: &[Impact]) -> Option<f64> {
    let known = |(k, impact): (usize, &Impact)| {
        let speed = impact.approach_speed_before_m_s?;
        Some((k, speed, impact.speed_error_m_s()?))
    };
    let known: Vec<(usize, f64, f64)> = impacts.iter().enumerate().filter_map(known).collect();
    if known.len() < FEWEST {
        return None;
    }
    let middle = 0.5 * (known[0].0 + known[known.len() - 1].0) as f64;
    let term = |i: usize, column: usize| {
        let sign = if known[i].0.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let place = known[i].0 as f64 - middle;
        [1.0, place, sign, sign * place][column]
    };
    let design = DMatrix::from_fn(known.len(), 4, term);
    let speeds = DVector::from_iterator(known.len(), known.iter().map(|(_, speed, _)| *speed));
    let inverse = design.tr_mul(&design).try_inverse()?;
    let found = &inverse * design.tr_mul(&speeds);
    let freedom = (known.len() - 4) as f64;
    let scatter = (speeds - &design * &found).norm() / freedom.sqrt();
    let errors: Vec<f64> = known.iter().map(|(_, _, error)| *error).collect();
    let error = scatter.max(robust::rms(&errors)) * inverse[(3, 3)].sqrt();
    Some(found[3] * found[2].signum() / error)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    use super::*;

    /// Impacts whose speeds alternate by so much at first, of which each keeps a share, with noise of 0.2 mm/s.
    fn impacts(alternation_m_s: f64, kept: f64, seed: u64) -> Vec<Impact> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let noise = Normal::new(0.0, 2e-4).expect("a deviation");
        let of = |k: i32| Impact {
            approach_speed_before_m_s: Some(
                0.2 + alternation_m_s * (-kept).powi(k) + noise.sample(&mut rng),
            ),
            speed_errors_m_s: Some([2e-4; 2]),
            ..Impact::timed(0.08 * f64::from(k), 1e-5)
        };
        (0..12).map(of).collect()
    }

    #[test]
    fn valid_an_alternation_that_dies_away_is_told_from_one_that_stays() {
        for seed in 0..20 {
            for size in [0.004, 0.02] {
                let dying = change(&impacts(size, 0.8, seed));
                assert_eq!(dying, Some(Change::Dies), "{seed} {size}");
                let staying = change(&impacts(size, 1.0, seed));
                assert_ne!(staying, Some(Change::Dies), "{seed} {size}");
                let mut reversed = impacts(size, 0.8, seed);
                reversed.reverse();
                assert_eq!(change(&reversed), Some(Change::Grows), "{seed} {size}");
            }
            let none = change(&impacts(0.0, 1.0, seed));
            assert_ne!(none, Some(Change::Dies), "{seed}");
        }
        assert_eq!(change(&impacts(0.02, 0.8, 1)[..5]), None);
    }
}
