//! β of free decays whose damping may be dry friction in part.
//!
//! A viscous fit gives v = β + ρ with ρ ≥ 0, what friction is worth; the form of the decay gives an estimate r of ρ. Both are
//! normal and not correlated, so that the likelihood of β, profiled over ρ ≥ 0, is
//!
//! χ²(β) = min over ρ ≥ 0 of ((v − β − ρ)/`s_v`)² + ((r − ρ)/`s_r`)².
//!
//! Its 95 % interval reaches from v up by no more than that of a viscous fit, and down by what friction the decay leaves
//! possible. In several decays ρ need not be the same: means of v and r with the same weights obey the same equation.
//!
//! Drag of the air that is worth δ makes the rate of decay fall along the decay by as much as friction worth δ makes it rise,
//! to first order in what the amplitude loses: r is an estimate of ρ − δ, and with −r in the place of r the profile has
//! what drag leaves of β.

use impact_records::signal::decay::{BesideFriction, Decay, OpenOnset};

use crate::estimate::{self, Estimate, Status};
use crate::messages::{Note, Remark};
use crate::parameters::Coordinate;
use crate::statistics::quantile::student_975;
use crate::statistics::scatter::Spread;
use crate::statistics::weighted::{self, Measured};

/// Normal deviate from which a change along a decay is no chance.
pub(super) const CHANGES: f64 = 3.3;

/// Damping of decays that friction may have part of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shared {
    /// Damping ratio of viscous fits, with its error.
    viscous: (f64, Spread),
    /// What friction is worth of it, with its error.
    friction: (f64, Spread),
    /// What is open of it, below and above, because it is not known when friction begins.
    open: [f64; 2],
    /// Whether drag of the air may have part of it.
    drag: bool,
}

impl Shared {
    /// The mean of decays.
    pub(super) fn of(decays: &[&Decay]) -> Self {
        let both: Vec<[Measured; 2]> = decays.iter().map(|d| measured(d)).collect();
        let weights: Vec<f64> = both
            .iter()
            .map(|[v, r]| (v.error.powi(2) + r.error.powi(2)).recip())
            .collect();
        let mean = |k: usize| {
            let values: Vec<Measured> = both.iter().map(|b| b[k]).collect();
            weighted::mean(&values, &weights)
        };
        Self {
            viscous: mean(0),
            friction: mean(1),
            open: open(decays, &weights, |o| o.damping_ratio),
            drag: false,
        }
    }

    /// The same where drag of the air is possible, or not.
    pub(super) fn with_drag(self, drag: bool) -> Self {
        Self { drag, ..self }
    }

    /// Whether friction is beyond chance.
    pub(super) fn is_told(&self) -> bool {
        let (friction, spread) = self.friction;
        friction > CHANGES * spread.error
    }

    /// What is told of friction that is beyond chance.
    pub(super) fn remark(&self) -> Option<Remark> {
        let (friction, spread) = self.friction;
        let of = |part: f64| part / self.viscous.0;
        self.is_told().then(|| Remark::DecaysRubbed {
            share: of(friction),
            half: of(spread.half95()),
        })
    }

    /// Student's quantile.
    fn quantile(&self) -> f64 {
        student_975(self.viscous.1.freedom.min(self.friction.1.freedom))
    }

    /// β: that of a viscous fit where friction may be none, else without it.
    fn value(&self) -> f64 {
        let (friction, spread) = self.friction;
        if friction > self.quantile() * spread.error {
            self.viscous.0 - friction
        } else {
            self.viscous.0
        }
    }

    /// What drag leaves of β at least, where it is possible.
    fn beside_drag(&self) -> Option<f64> {
        let (friction, spread) = self.friction;
        let mirrored = Self {
            friction: (-friction, spread),
            ..*self
        };
        self.drag.then(|| mirrored.interval()[0])
    }

    /// The profile's 95 % interval beside friction, up to the viscous fit's where the profile leaves no damping: friction that is worth
    /// more than all of it is none.
    fn interval(&self) -> [f64; 2] {
        let (viscous, friction) = (self.viscous.0, self.friction.0);
        let [of_viscous, of_friction] = [self.viscous.1.error, self.friction.1.error];
        let quantile = self.quantile();
        let both = of_viscous.hypot(of_friction);
        // where no friction fits best, χ² has this beside it
        let least = (friction.min(0.0) / of_friction).powi(2);
        let free = |side: f64| friction + side * both * (quantile.powi(2) + least).sqrt();
        let none = {
            let left = quantile.powi(2) + least - (friction / of_friction).powi(2);
            of_viscous * left.max(0.0).sqrt()
        };
        // v − β at both ends: ρ fits best at zero where this is negative
        let rubs = |apart: &f64| apart * of_friction.powi(2) + friction * of_viscous.powi(2) >= 0.0;
        let below = Some(free(1.0)).filter(rubs).unwrap_or(none);
        let above = Some(free(-1.0)).filter(rubs).unwrap_or(-none);
        let high = Some(viscous - above).filter(|high| *high > 0.0);
        [
            viscous - below,
            high.unwrap_or(viscous + self.viscous.1.half95()),
        ]
    }

    /// β with its interval, from decays of which the longest has a number of periods.
    pub(super) fn estimate(&self, periods: f64) -> Estimate {
        let [low, high] = self.interval();
        let (viscous, spread) = self.viscous;
        let [below, above] = self.open;
        let (low, high) = (low - below, spread.upper_end(viscous, high + above));
        let value = self.value();
        let most = estimate::limits(Coordinate::Damping).0;
        let undamped = viscous <= spread.half95();
        let error_from = |low: f64| 0.5 * (high - low) / self.quantile();
        let is_open = |low: f64| low <= 0.0 || error_from(low) > most * value;
        let by_friction = is_open(low);
        let low = self.beside_drag().map_or(low, |own| own.min(low));
        let error = error_from(low);
        let is_weak = undamped || is_open(low);
        let note = if undamped {
            Some(Note::Undamped { most: high })
        } else if !is_weak || spread.error > most * viscous {
            None
        } else if by_friction {
            Some(Note::FrictionNotTold {
                periods,
                equivalent: viscous,
            })
        } else {
            Some(Note::DragNotTold {
                periods,
                equivalent: viscous,
            })
        };
        Estimate {
            value: Some(value.max(0.0)),
            standard_error: Some(error),
            interval95: Some([low.max(0.0), high]),
            status: if is_weak {
                Status::Weak
            } else {
                Status::Identified
            },
            note,
        }
    }
}

/// What is open of a quantity, below and above, because it is not known when friction begins in decays with weights.
pub(super) fn open(
    decays: &[&Decay],
    weights: &[f64],
    of: impl Fn(&OpenOnset) -> [f64; 2],
) -> [f64; 2] {
    let all: f64 = weights.iter().sum();
    let own = |d: &Decay| d.beside_friction.map_or([0.0; 2], |b| of(&b.open));
    [0, 1].map(|k| {
        let weighed = decays.iter().zip(weights).map(|(d, w)| w * own(d)[k]);
        weighed.sum::<f64>() / all
    })
}

/// Whether the fall of the amplitude alone tells friction, and the damping does not change beyond chance from part to part: what
/// makes the harmonics that contradict the friction may make the rest.
fn is_doubtful(decay: &Decay, found: &BesideFriction) -> bool {
    let changes = decay.course.damping_z_score.abs() > CHANGES;
    found.by_fall && found.added > CHANGES * found.added_error && !changes
}

/// Damping ratio of a viscous fit and what friction is worth of it. Where friction is not told from the rest, it may be
/// all or nothing.
fn measured(decay: &Decay) -> [Measured; 2] {
    let told = decay.beside_friction.as_ref();
    let Some(found) = told.filter(|found| !is_doubtful(decay, found)) else {
        let viscous = Measured {
            value: decay.damping_ratio,
            error: decay.damping_ratio_error,
            freedom: decay.freedom,
        };
        let all = Measured {
            value: 0.0,
            error: decay.damping_ratio.abs().max(decay.damping_ratio_error),
            freedom: f64::INFINITY,
        };
        return [viscous, all];
    };
    let BesideFriction {
        known_friction_error,
        added,
        added_error,
        freedom,
        ..
    } = *found;
    // no β is known better than its digits
    let of = |value: f64, error: f64| Measured {
        value,
        error: error.max(f64::EPSILON),
        freedom,
    };
    [
        of(found.damping_ratio + added, known_friction_error),
        of(added, added_error),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn shared(viscous: f64, friction: f64, errors: [f64; 2]) -> Shared {
        Shared {
            viscous: (viscous, Spread::known(errors[0])),
            friction: (friction, Spread::known(errors[1])),
            open: [0.0; 2],
            drag: false,
        }
    }

    #[test]
    fn valid_drag_leaves_of_beta_what_friction_of_the_same_size_would() {
        // the rate of decay falls along the decay: drag worth 4e-3 of 0.01
        let own = shared(0.01, -4e-3, [1e-4, 5e-4]);
        let plain = own.estimate(9.0);
        assert_eq!(plain.status, Status::Identified);
        let with = own.with_drag(true).estimate(9.0);
        let [low, high] = with.interval95.unwrap();
        assert!(low < 0.006 && high > 0.01, "{low} {high}");
        assert!(
            matches!(with.note, Some(Note::DragNotTold { .. })),
            "{with:?}"
        );
        assert_eq!(with.value, plain.value);
        // friction of that size leaves as much
        let rubbed = shared(0.01, 4e-3, [1e-4, 5e-4]);
        assert!((rubbed.interval()[0] - low).abs() < 1e-12);
    }

    #[test]
    fn valid_the_ends_of_the_interval_are_where_the_profile_rises_by_the_squared_quantile() {
        let errors = [1e-4, 4e-4];
        for friction in [-9e-4, -2e-4, 0.0, 3e-4, 7e-4, 3e-3] {
            let own = shared(0.01, friction, errors);
            let chi = |beta: f64, rho: f64| {
                ((0.01 - beta - rho) / errors[0]).powi(2) + ((friction - rho) / errors[1]).powi(2)
            };
            // by a search over ρ
            let profile = |beta: f64| {
                let tried = (0..=60_000).map(|k| chi(beta, 1e-7 * f64::from(k)));
                tried.fold(f64::INFINITY, f64::min)
            };
            let best = (0..=800).map(|k| profile(0.0065 + 5e-6 * f64::from(k)));
            let least = best.fold(f64::INFINITY, f64::min);
            for end in own.interval() {
                let rises = profile(end) - least - own.quantile().powi(2);
                assert!(rises.abs() < 0.02, "{friction}: {end} {rises}");
            }
            let [low, high] = own.interval();
            assert!((low..=high).contains(&own.value()), "{friction}");
        }
    }

    #[test]
    fn prop_the_interval_holds_beta_whatever_the_friction() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_127);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        for ratio in [0.3, 3.0, 100.0] {
            for friction in [0.0, 0.5, 1.5, 5.0] {
                let errors = [1e-4, ratio * 1e-4];
                let held = (0..4000).filter(|_| {
                    let rho = friction * errors[1];
                    let viscous = 0.01 + rho + errors[0] * normal();
                    let own = shared(viscous, rho + errors[1] * normal(), errors);
                    let [low, high] = own.interval();
                    (low..=high).contains(&0.01)
                });
                let share = held.count() as f64 / 4000.0;
                assert!(
                    (0.93..=0.98).contains(&share),
                    "{ratio} {friction}: {share}"
                );
            }
        }
    }
}
