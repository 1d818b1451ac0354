//! `[rig]` as written to nominal values, their uncertainties and the effects that the fit allows.

use std::str::FromStr;

use serde::{Deserialize, Serialize};
use strum::VariantNames;

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::values::{Placed, WrittenQuantity, value};
use impact_fit::parameters::effect::EffectKind;
use impact_identification::compare::Common;
use labfiles::units::Dimension;

keys! {
    /// `[rig]`: nominal values, all optional.
    #[serde(default)]
    pub struct RigTable {
        /// nominal f0
        natural_frequency: Placed<WrittenQuantity>, default "none",
            init r#"# natural_frequency = "12.6 Hz""#;
        /// nominal β
        damping_ratio: Placed<WrittenQuantity>, default "none", init "# damping_ratio = 0.07";
        /// nominal x_st = F0/k
        static_deflection: Placed<WrittenQuantity>, default "none",
            init r#"# static_deflection = "1.0 mm"   # x_st = F0/k"#;
        /// nominal R
        restitution: Placed<WrittenQuantity>, default "none", init "# restitution = 0.9";
        /// of the scales of the channels, relative
        gain_uncertainty: Placed<WrittenQuantity>, default "`\"0.5 %\"`",
            init r#"gain_uncertainty = "0.5 %"       # of the channels' scales"#;
        /// of the corners of the channels' high-pass, relative
        corner_uncertainty: Placed<WrittenQuantity>, default "`\"5 %\"`",
            init r#"corner_uncertainty = "5 %"       # of the corners of the channels' high-pass"#;
        /// of the clock of the sampler, relative: times and thus f0 follow from it
        clock_uncertainty: Placed<WrittenQuantity>, default "`\"50 ppm\"`",
            init r#"clock_uncertainty = "50 ppm"     # of the clock of the sampler, in f0"#;
        /// of each stated clearance, and of the zero that all share
        clearance_uncertainty: Placed<WrittenQuantity>, default "`\"10 um\"`",
            init r#"clearance_uncertainty = "10 um"  # of each stated clearance, and of the zero that all share"#;
        /// mass x; with `mass_y` it states the asymmetry of the masses
        mass_x: Placed<WrittenQuantity>, default "none",
            init r#"# mass_x = "1.50 kg"             # both masses, if weighed, with mass_uncertainty = "0.5 %""#;
        /// mass y
        mass_y: Placed<WrittenQuantity>, default "none";
        /// of each mass, relative
        mass_uncertainty: Placed<WrittenQuantity>, default "`\"0.5 %\"`";
        /// effects beyond the model that the fit allows, any of `"harmonics"`, `"force_frequency"`, `"hardening"`,
        /// `"friction"`, `"drift"`, `"contact_duration"`, `"restitution_speed"`, `"drag"`,
        /// `"spring_asymmetry"`, `"hysteretic_damping"`, `"pickup"`
        effects: Placed<Vec<String>>, default "all",
            init r#"# effects = ["harmonics", "force_frequency", "hardening", "friction", "drift", "contact_duration",
#            "restitution_speed", "drag", "spring_asymmetry", "hysteretic_damping", "pickup"]
#                                # what springs, drive and contact may add to the model; all by default"#;
        /// which rig it is, as text; of what `shared` lists, campaigns on rigs of other names share nothing (channels
        /// with the same `instrument` still share gain and corner)
        name: Placed<String>, default "none",
            init r#"# name = "rig 1"                 # which rig it is, where campaigns are compared (impactid compare)"#;
        /// errors that stay the same in all campaigns on the rig, any of `"gains"`, `"corners"`, `"delays"`,
        /// `"clearance_zero"`, `"clearances"` (the zero and the error of each stated clearance), `"asymmetries"`,
        /// `"harmonics"`, `"force_frequency"`: they cancel in `impactid compare`
        shared: Placed<Vec<String>>, default "none",
            init r#"# shared = ["clearances"]        # errors that stay the same in all campaigns on it"#;
    }
}

/// Nominal values of the rig (`None`: not stated) and their standard uncertainties.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NominalValues {
    /// Natural frequency f0, Hz.
    pub natural_frequency_hz: Option<f64>,
    /// Damping ratio β.
    pub damping_ratio: Option<f64>,
    /// Static deflection `x_st`, m.
    pub static_deflection_m: Option<f64>,
    /// Coefficient of restitution R.
    pub restitution: Option<f64>,
    /// Mass x, kg.
    pub mass_x_kg: Option<f64>,
    /// Mass y, kg.
    pub mass_y_kg: Option<f64>,
    /// Standard uncertainty of the channels' scales, relative.
    pub gain_uncertainty: f64,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: f64,
    /// Standard uncertainty of the sampler's clock, relative.
    #[serde(default)]
    pub clock_uncertainty: f64,
    /// Standard uncertainty of the clearances, m.
    pub clearance_uncertainty_m: f64,
    /// Standard uncertainty of the masses, relative.
    #[serde(default)]
    pub mass_uncertainty: f64,
    /// Effects beyond the model that the fit allows; `None`: all.
    #[serde(default)]
    pub effects: Option<Vec<EffectKind>>,
    /// Which rig it is, in words.
    #[serde(default)]
    pub name: Option<String>,
    /// What stays the same in all campaigns on the rig.
    #[serde(default)]
    pub shared: Vec<Common>,
}

/// Nominal values and uncertainties, defaults included.
pub(crate) fn resolve(rig: &RigTable, context: &mut ResolveContext<'_>) -> NominalValues {
    use Dimension::{Frequency, Length, Mass, Number};
    let mut positive = |placed, name: &str, d| context.positive(placed, &format!("rig.{name}"), d);
    let natural_frequency_hz = positive(&rig.natural_frequency, "natural_frequency", Frequency);
    let static_deflection_m = positive(&rig.static_deflection, "static_deflection", Length);
    let mass_x_kg = positive(&rig.mass_x, "mass_x", Mass);
    let mass_y_kg = positive(&rig.mass_y, "mass_y", Mass);
    let mut part =
        |placed, name: &str, range| context.within(placed, &format!("rig.{name}"), Number, range);
    let damping_ratio = part(&rig.damping_ratio, "damping_ratio", [0.0, 0.999]);
    let restitution = part(&rig.restitution, "restitution", [0.0, 1.0]);
    let gain = part(&rig.gain_uncertainty, "gain_uncertainty", [0.0, 0.5]);
    let corner = part(&rig.corner_uncertainty, "corner_uncertainty", [0.0, 0.5]);
    let clock = part(&rig.clock_uncertainty, "clock_uncertainty", [0.0, 0.05]);
    let mass = part(&rig.mass_uncertainty, "mass_uncertainty", [0.0, 0.5]);
    let clearance = context.within(
        &rig.clearance_uncertainty,
        "rig.clearance_uncertainty",
        Length,
        [0.0, 1.0],
    );
    NominalValues {
        natural_frequency_hz,
        damping_ratio,
        static_deflection_m,
        restitution,
        mass_x_kg,
        mass_y_kg,
        gain_uncertainty: gain.unwrap_or(0.005),
        corner_uncertainty: corner.unwrap_or(0.05),
        clock_uncertainty: clock.unwrap_or(5e-5),
        clearance_uncertainty_m: clearance.unwrap_or(1e-5),
        mass_uncertainty: mass.unwrap_or(0.005),
        effects: effects(&rig.effects, context),
        name: value(&rig.name),
        shared: shared(&rig.shared, context),
    }
}

/// What the campaigns on the rig have in common, by its names.
fn shared(placed: &Placed<Vec<String>>, context: &mut ResolveContext<'_>) -> Vec<Common> {
    let unknown = |name: &str| format!("campaigns cannot share '{name}'");
    let remedy = "remove the line";
    named(placed, "rig.shared", remedy, unknown, context).unwrap_or_default()
}

/// The effects that the fit allows, by their names.
fn effects(
    placed: &Placed<Vec<String>>,
    context: &mut ResolveContext<'_>,
) -> Option<Vec<EffectKind>> {
    let unknown = |name: &str| format!("no effect is called '{name}'");
    let remedy = "remove the line to allow all";
    named(placed, "rig.effects", remedy, unknown, context)
}

/// The variants that a list names; a name that is `unknown` is a fault, with what else may be done.
fn named<T: FromStr + VariantNames>(
    placed: &Placed<Vec<String>>,
    key: &str,
    otherwise: &str,
    unknown: impl Fn(&str) -> String,
    context: &mut ResolveContext<'_>,
) -> Option<Vec<T>> {
    let placed = placed.as_ref()?;
    let mut found = Vec::new();
    for name in placed.get_ref() {
        match name.parse() {
            Ok(variant) => found.push(variant),
            Err(_) => {
                let known = T::VARIANTS.join(", ");
                let remedy = format!("choose among {known}, or {otherwise}");
                context.fault(Code::OutOfRange, placed, key, unknown(name), &remedy);
            }
        }
    }
    Some(found)
}
