//! What a rig has beyond the model: the effects whose estimates are significant.

use impact_fit::messages::Finding;
use impact_fit::method_fit::MethodFit;
use impact_fit::parameters::Coordinate;
use impact_fit::parameters::effect::{Effect, EffectKind};

/// Standard errors from which an effect is named: by chance one in two thousand reaches them.
const NAMED: f64 = 3.5;
/// Accepted strengths from which an effect is named: a twentieth of what a good laboratory accepts is of no interest,
/// however small the noise that shows it.
const NAMED_STRENGTH: f64 = 0.05;
/// The same of pickup: less is in every laboratory, and the data tell a fifth of one.
const NAMED_PICKUP: f64 = 2.0;
/// χ² of two degrees of freedom that is as rare.
const NAMED_PAIR: f64 = 15.3;

/// The significant effects of a joint fit, in which R is that at an approach speed, m/s. The two parts of a harmonic
/// are named as its amplitude.
pub fn beyond(found: &MethodFit, speed_m_s: f64) -> Vec<Finding> {
    let harmonic = |cos, sin| harmonic(found, cos, sin, speed_m_s);
    Effect::ALL
        .iter()
        .copied()
        .filter_map(|effect| match effect {
            Effect::SecondHarmonicCos => harmonic(effect, Effect::SecondHarmonicSin),
            Effect::ThirdHarmonicCos => harmonic(effect, Effect::ThirdHarmonicSin),
            Effect::SecondHarmonicSin | Effect::ThirdHarmonicSin => None,
            single => {
                let (strength, standard_error) = estimated(found, single)?;
                let z_score = strength / standard_error;
                (z_score.abs() > NAMED && matters(effect, strength)).then_some(
                    Finding::BeyondModel {
                        effect,
                        strength,
                        standard_error,
                        z_score,
                        speed_m_s,
                    },
                )
            }
        })
        .collect()
}

/// The effects without those that other findings explain: what drifts where a gain changes.
pub fn unexplained(mut beyond: Vec<Finding>, suspicions: &[Finding]) -> Vec<Finding> {
    let changed = |finding: &Finding| {
        matches!(
            finding,
            Finding::GainChanged { .. } | Finding::GainsPart { .. }
        )
    };
    let drifts = |finding: &Finding| matches!(finding, Finding::BeyondModel { effect, .. } if effect.kind() == EffectKind::Drift);
    let gain_changed = suspicions.iter().any(changed);
    beyond.retain(|finding| !(gain_changed && drifts(finding)));
    beyond
}

/// Whether an effect is of interest by its strength.
fn matters(effect: Effect, strength: f64) -> bool {
    let accepted = match effect.kind() {
        EffectKind::Pickup => NAMED_PICKUP,
        _ => NAMED_STRENGTH,
    };
    strength.abs() > accepted * effect.accepted()
}

fn estimated(found: &MethodFit, effect: Effect) -> Option<(f64, f64)> {
    let coordinate = Coordinate::Effect(effect);
    let error = found.spread(coordinate)?.error;
    (error > 0.0).then(|| (found.fit.parameters.coordinate(coordinate), error))
}

fn harmonic(found: &MethodFit, cos: Effect, sin: Effect, speed_m_s: f64) -> Option<Finding> {
    let ((a, ea), (b, eb)) = (estimated(found, cos)?, estimated(found, sin)?);
    let correlation = found
        .fit
        .correlation(Coordinate::Effect(cos), Coordinate::Effect(sin))?;
    let (u, v) = (a / ea, b / eb);
    let chi2 = (u * u - 2.0 * correlation * u * v + v * v) / (1.0 - correlation * correlation);
    let strength = a.hypot(b);
    (chi2 > NAMED_PAIR && matters(cos, strength)).then(|| Finding::BeyondModel {
        effect: cos,
        strength,
        standard_error: (a * ea).hypot(b * eb) / strength,
        z_score: chi2.sqrt(),
        speed_m_s,
    })
}
