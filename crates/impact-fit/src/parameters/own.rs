//! A record's own parameters: where drift, the force against frequency, errors of the clearances and the
//! length of contacts have been applied to those of the campaign.

use super::Parameters;
use super::coordinate::Coordinate;
use super::effect::Effect;

/// Where and when a record was taken, as far as effects depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Circumstances {
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap as stated, m (against a stop: the whole gap).
    pub clearance_m: f64,
    /// Place of the clearance among the stated ones that carry an error of their own.
    pub gap: Option<usize>,
    /// Place in the campaign: −½ (first record) to ½ (last).
    pub place: f64,
    /// Approach speed at the impacts, m/s; zero without impacts.
    pub approach_m_s: f64,
    /// The campaign's typical approach speed, m/s; zero where it is not known.
    pub typical_approach_m_s: f64,
    /// Acceleration of the masses toward each other at the impacts over the approach speed, 1/s.
    pub press_per_s: f64,
    /// Displacements that close the gap together: 2, or 1 against a stop.
    pub masses: f64,
}

impl Circumstances {
    /// Logarithm of the approach speed over the campaign's typical one; 0 where either is not known.
    fn log_speed(&self) -> f64 {
        log_speed(self.approach_m_s, self.typical_approach_m_s)
    }
}

/// Logarithm of an approach speed over the typical one; 0 where either is not positive.
pub fn log_speed(approach_m_s: f64, typical_m_s: f64) -> f64 {
    if approach_m_s > 0.0 && typical_m_s > 0.0 {
        (approach_m_s / typical_m_s).ln()
    } else {
        0.0
    }
}

/// Derivative of a record's own parameters over one coordinate of the fit: of R, ln f0, ln β,
/// ln `x_st`, and of the clearance in m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OwnSlope {
    /// Of R, ln f0, ln β and ln `x_st`.
    pub physical: [f64; 4],
    /// Of the clearance, m.
    pub clearance_m: f64,
}

/// Of one of R, ln f0, ln β and ln `x_st` alone.
fn only(i: usize, slope: f64) -> Option<OwnSlope> {
    let mut found = OwnSlope::default();
    found.physical[i] = slope;
    Some(found)
}

/// Of the clearance alone.
fn clearance(clearance_m: f64) -> Option<OwnSlope> {
    Some(OwnSlope {
        clearance_m,
        ..OwnSlope::default()
    })
}

impl Parameters {
    /// Force over its value at η = 1, and its derivative over η.
    fn lean(&self, eta: f64) -> [f64; 2] {
        let (slope, curve) = (
            self.effect(Effect::ForceSlope),
            self.effect(Effect::ForceCurve),
        );
        let off = eta - 1.0;
        [1.0 + off * (slope + curve * off), slope + 2.0 * curve * off]
    }

    /// Equivalent viscous damping over its value at η = 1, and its derivative over η: of a hysteretic
    /// share s, 1 + s (1/η − 1).
    fn equivalent_damping(&self, eta: f64) -> [f64; 2] {
        let share = self.effect(Effect::HystereticDamping);
        let whole = 1.0 + share * (1.0 / eta - 1.0);
        if whole > 0.01 {
            [whole, -share / (eta * eta)]
        } else {
            [0.01, 0.0]
        }
    }

    /// Frequency ratio of a record; 1 where nothing is known of its drive.
    fn eta(&self, at: &Circumstances) -> f64 {
        if at.frequency_hz > 0.0 {
            at.frequency_hz / self.natural_frequency_hz
        } else {
            1.0
        }
    }

    /// The parameters that a record has of its own, and its clearance, m: where drift, the force
    /// against frequency, R over the speed, errors of the clearances and the length of contacts have been applied.
    ///
    /// A contact that lasts a time acts outside of it like an impact where both flights meet.
    pub fn own(&self, at: &Circumstances) -> (Self, f64) {
        let drift = |effect| self.effect(effect) * at.place;
        let bending = self.effect(Effect::FrequencyBend) * bend(at.place);
        let eta = self.eta(at);
        let [lean, _] = self.lean(eta);
        let [viscous, _] = self.equivalent_damping(eta);
        let contact_s = 1e-3 * self.effect(Effect::ContactDuration) * self.contact_speed(at)[0];
        let contact = short_contact(self.restitution);
        let [press_law, drag_law] = self.contact_law();
        let beyond = press_law * contact.press * at.press_per_s
            + drag_law * contact.drag * self.decay_per_s();
        let over_speed = self.effect(Effect::RestitutionSpeed) * at.log_speed();
        let in_time = drift(Effect::RestitutionDrift);
        let restitution = self.restitution + over_speed + in_time + contact_s * beyond;
        let own = Self {
            restitution: restitution.clamp(0.0, 1.0),
            natural_frequency_hz: self.natural_frequency_hz
                * (drift(Effect::FrequencyDrift) + bending).exp(),
            damping_ratio: self.damping_ratio * viscous * drift(Effect::DampingDrift).exp(),
            static_deflection_m: self.static_deflection_m
                * lean.max(0.01)
                * drift(Effect::DeflectionDrift).exp(),
            ..*self
        };
        let error = at.gap.map_or(0.0, |i| self.gap_errors_m.of(i));
        let bent = self.effect(Effect::ContactReach) * contact_s * at.press_per_s;
        let reach = contact.reach * (1.0 + bent);
        let reach_m = at.approach_m_s * contact_s * reach / at.masses.max(1.0);
        let drift_m = self.static_deflection_m * drift(Effect::ClearanceDrift);
        (
            own,
            at.clearance_m + self.screw_zero_m + error + drift_m + reach_m,
        )
    }

    /// How the parameters of [`Parameters::own`] change per unit of a coordinate; `None` where they
    /// do not.
    pub fn own_slope(&self, at: &Circumstances, coordinate: Coordinate) -> Option<OwnSlope> {
        let none = OwnSlope::default();
        let eta = self.eta(at);
        let [lean, over_eta] = self.lean(eta);
        let [viscous, damping_over_eta] = self.equivalent_damping(eta);
        let contact = short_contact(self.restitution);
        let [slower, slower_slope] = self.contact_speed(at);
        let duration_s = 1e-3 * self.effect(Effect::ContactDuration);
        let contact_s = duration_s * slower;
        let speed = at.approach_m_s / at.masses.max(1.0);
        let decay = self.decay_per_s();
        let [press_law, drag_law] = self.contact_law();
        let pressed = contact_s * at.press_per_s;
        let bent = self.effect(Effect::ContactReach) * pressed;
        let drag = contact_s * drag_law * contact.drag * decay;
        let beyond = press_law * contact.press * at.press_per_s + drag_law * contact.drag * decay;
        let beyond_slope = press_law * contact.press_slope * at.press_per_s
            + drag_law * contact.drag_slope * decay;
        let of_law = contact.press * at.press_per_s + DRAG_OF_LAW * contact.drag * decay;
        // of a contact that lasts longer by so many seconds
        let length = |longer_s: f64| {
            Some(OwnSlope {
                physical: [longer_s * beyond, 0.0, 0.0, 0.0],
                clearance_m: longer_s * speed * contact.reach * (1.0 + 2.0 * bent),
            })
        };
        match coordinate {
            Coordinate::Restitution => Some(OwnSlope {
                physical: [1.0 + contact_s * beyond_slope, 0.0, 0.0, 0.0],
                clearance_m: contact_s * speed * contact.reach_slope * (1.0 + bent),
            }),
            Coordinate::Frequency => Some(OwnSlope {
                physical: [
                    drag,
                    1.0,
                    -eta * damping_over_eta / viscous,
                    -eta * over_eta / lean,
                ],
                ..none
            }),
            Coordinate::Damping => Some(OwnSlope {
                physical: [drag, 0.0, 1.0, 0.0],
                ..none
            }),
            Coordinate::Deflection => Some(OwnSlope {
                physical: [0.0, 0.0, 0.0, 1.0],
                clearance_m: self.static_deflection_m
                    * self.effect(Effect::ClearanceDrift)
                    * at.place,
            }),
            Coordinate::ScrewZero => clearance(1e-3),
            Coordinate::Gap(i) if at.gap == Some(i) => clearance(1e-3),
            Coordinate::Effect(effect) => match effect {
                Effect::ForceSlope => only(3, (eta - 1.0) / lean),
                Effect::ForceCurve => only(3, (eta - 1.0).powi(2) / lean),
                Effect::FrequencyDrift => only(1, at.place),
                Effect::FrequencyBend => only(1, bend(at.place)),
                Effect::DampingDrift => only(2, at.place),
                Effect::HystereticDamping => only(2, (1.0 / eta - 1.0) / viscous),
                Effect::DeflectionDrift => only(3, at.place),
                Effect::ClearanceDrift => clearance(self.static_deflection_m * at.place),
                Effect::ContactDuration => length(1e-3 * slower),
                Effect::ContactSpeed => length(duration_s * slower_slope),
                Effect::RestitutionSpeed => only(0, at.log_speed()),
                Effect::RestitutionDrift => only(0, at.place),
                Effect::ContactLaw => only(0, contact_s * of_law),
                Effect::ContactReach => clearance(contact_s * speed * contact.reach * pressed),
                _ => None,
            },
            _ => None,
        }
    }

    /// Relative changes of a record's own `x_st` and β per unit of the logarithm of its drive's
    /// frequency: force and damping against frequency.
    pub fn own_over_drive(&self, frequency_hz: f64) -> [(Coordinate, f64); 2] {
        let eta = frequency_hz / self.natural_frequency_hz;
        let [lean, over_eta] = self.lean(eta);
        let [viscous, damping_over_eta] = self.equivalent_damping(eta);
        [
            (Coordinate::Deflection, eta * over_eta / lean),
            (Coordinate::Damping, eta * damping_over_eta / viscous),
        ]
    }

    /// What another law of contact makes of g and h, as factors.
    fn contact_law(&self) -> [f64; 2] {
        let law = self.effect(Effect::ContactLaw);
        [1.0 + law, 1.0 + DRAG_OF_LAW * law]
    }

    /// Length of a contact over that at the typical speed, v over it to the power −κ, and the slope over κ.
    fn contact_speed(&self, at: &Circumstances) -> [f64; 2] {
        let log = at.log_speed();
        let slower = (-self.effect(Effect::ContactSpeed) * log).exp();
        [slower, -log * slower]
    }

    /// βΩ, 1/s.
    fn decay_per_s(&self) -> f64 {
        self.damping_ratio * self.natural_rate()
    }
}

/// What a short contact of unit duration, a spring and a damper that only press, makes of the impact
/// outside of it, and the slopes over R.
struct ShortContact {
    /// Where both flights meet, beyond the gap, over the approach speed.
    reach: f64,
    reach_slope: f64,
    /// What the ratio of the speeds there is above R, over a/w.
    press: f64,
    press_slope: f64,
    /// The same over βΩ: the flights' damping acts on a contact less than on flights of its length.
    drag: f64,
    drag_slope: f64,
}

/// Relative departure of h with another law of contact, over that of g.
const DRAG_OF_LAW: f64 = 0.45;

/// Least R for which a contact's effect is taken.
const LEAST_RESTITUTION: f64 = 0.05;

/// With a contact of duration t, both flights meet at ½R^{1/3} w t beyond the gap, where their speeds
/// are in the ratio R + t (g a/w + hβΩ), a being the masses' acceleration toward each other before the
/// impact: with q = 1 − R, g = q (0.594 + 0.032 q + 0.05 q²) and h = 1 + q (0.388 − 0.054 q), fits to the
/// exact contact within 0.4 % for R of 0.3 to 1 as t becomes short.
fn short_contact(restitution: f64) -> ShortContact {
    let r = restitution.max(LEAST_RESTITUTION);
    let q = 1.0 - r;
    let reach = 0.5 * r.cbrt();
    ShortContact {
        reach,
        reach_slope: reach / (3.0 * r),
        press: q * (0.594 + q * (0.032 + 0.05 * q)),
        press_slope: -(0.594 + q * (0.064 + 0.15 * q)),
        drag: 1.0 + q * (0.388 - 0.054 * q),
        drag_slope: -(0.388 - 0.108 * q),
    }
}

/// What a drift that bends adds at a place −½ … ½ in the campaign: 1 in the middle of it, −1 at both
/// ends.
fn bend(place: f64) -> f64 {
    1.0 - 8.0 * place * place
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::impacts::block::PUSH_OF_LAWS;
    use crate::parameters::contact_laws::{Coefficients, Law};
    use crate::parameters::effect::Acts;

    /// R, g and h from an independent program in Python that integrates flights and contact from first touch
    /// to last (Runge–Kutta), t = 0.004 natural radians.
    const EXACT: [[f64; 3]; 7] = [
        [0.4, 0.3787, 1.2136],
        [0.5, 0.3109, 1.1808],
        [0.6, 0.2456, 1.1467],
        [0.7, 0.1823, 1.1116],
        [0.8, 0.1205, 1.0755],
        [0.9, 0.0598, 1.0383],
        [0.98, 0.0119, 1.0078],
    ];

    #[test]
    fn valid_a_short_contact_is_the_exact_one() {
        for [r, press, drag] in EXACT {
            let found = short_contact(r);
            assert!(
                (found.press / press - 1.0).abs() < 4e-3,
                "g at R = {r}: {}",
                found.press
            );
            assert!(
                (found.drag / drag - 1.0).abs() < 3e-3,
                "h at R = {r}: {}",
                found.drag
            );
        }
    }

    #[test]
    fn slopes_of_a_short_contact_are_those_of_differences() {
        let (r, step) = (0.7, 1e-6);
        let [below, here, above] = [r - step, r, r + step].map(short_contact);
        let slope = |of: fn(&ShortContact) -> f64| (of(&above) - of(&below)) / (2.0 * step);
        assert!((slope(|c| c.reach) - here.reach_slope).abs() < 1e-8);
        assert!((slope(|c| c.press) - here.press_slope).abs() < 1e-8);
        assert!((slope(|c| c.drag) - here.drag_slope).abs() < 1e-8);
    }

    /// Root mean square of the relative departures of other laws of contact from g and from h, both over the
    /// reach: a fit tells the length of contacts from that.
    fn departures(restitution: f64) -> [f64; 2] {
        let formula = short_contact(restitution);
        let laws = Law::OTHERS.map(|law| {
            let c = Coefficients::of(law, restitution);
            let over =
                |own: f64, formula_own: f64| (own / c.reach) / (formula_own / formula.reach) - 1.0;
            [over(c.press, formula.press), over(c.drag, formula.drag)]
        });
        // the spring and damper themselves depart by nothing
        let count = laws.len() as f64 + 1.0;
        [0, 1].map(|i| (laws.iter().map(|l| l[i].powi(2)).sum::<f64>() / count).sqrt())
    }

    #[test]
    fn valid_the_coefficients_are_those_of_a_spring_and_damper_integrated_step_by_step() {
        for r in [0.5, 0.7, 0.9] {
            let (c, formula) = (Coefficients::of(Law::KelvinVoigt, r), short_contact(r));
            assert!(
                (c.reach / formula.reach - 1.0).abs() < 0.014,
                "{r}: {}",
                c.reach
            );
            assert!(
                (c.press / formula.press - 1.0).abs() < 0.01,
                "{r}: {}",
                c.press
            );
            assert!(
                (c.drag / formula.drag - 1.0).abs() < 0.01,
                "{r}: {}",
                c.drag
            );
        }
    }

    #[test]
    fn valid_other_laws_of_contact_push_as_much_more_as_impacts_allow_for() {
        let found = [0.5, 0.6, 0.7, 0.8, 0.9].map(|r| {
            let own = Coefficients::of(Law::KelvinVoigt, r).push;
            let others = Law::OTHERS.map(|law| (Coefficients::of(law, r).push / own - 1.0).powi(2));
            (others.iter().sum::<f64>() / (others.len() as f64 + 1.0)).sqrt()
        });
        let mean = found.iter().sum::<f64>() / 5.0;
        assert!((mean / PUSH_OF_LAWS - 1.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn valid_other_laws_of_contact_depart_as_much_as_their_prior_has_it() {
        let found = [0.5, 0.6, 0.7, 0.8, 0.9].map(departures);
        let mean = |i: usize| found.iter().map(|d| d[i]).sum::<f64>() / 5.0;
        let [press, drag] = [mean(0), mean(1)];
        assert!(
            (press / Effect::ContactLaw.accepted() - 1.0).abs() < 0.1,
            "{found:?}"
        );
        assert!((drag / press / DRAG_OF_LAW - 1.0).abs() < 0.25, "{found:?}");
    }

    #[test]
    fn prop_each_effect_changes_of_a_record_what_its_row_has_it_act_on() {
        let p = Parameters {
            effects: [0.1; Effect::COUNT],
            ..Parameters::symmetric(0.8, 12.6, 0.07, 1e-3)
        };
        let at = Circumstances {
            frequency_hz: 14.0,
            place: 0.3,
            approach_m_s: 0.1,
            typical_approach_m_s: 0.07,
            press_per_s: 40.0,
            masses: 2.0,
            ..Circumstances::default()
        };
        for effect in Effect::ALL {
            let slope = p.own_slope(&at, Coordinate::Effect(*effect));
            let acts = slope.map(|slope| {
                let [restitution, oscillator @ ..] = slope.physical;
                if oscillator.iter().any(|s| *s != 0.0) {
                    return Acts::Oscillator;
                }
                assert!(restitution != 0.0 || slope.clearance_m != 0.0);
                Acts::Impacts
            });
            let expected = Some(effect.acts()).filter(|_| !effect.is_perturbation());
            assert_eq!(acts, expected, "{effect:?}");
        }
    }
}
