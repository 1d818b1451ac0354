//! `[rig]` as written to nominal values, their uncertainties and the effects that the fit allows.

use std::str::FromStr;

use strum::VariantNames;

use super::context::ResolveContext;
use super::diagnostic::Code;
use super::resolved::{NominalValues, RecordEntry};
use super::written::{self, Placed};
use impact_identification::compare::Common;
use impact_identification::identify::parameters::effect::EffectKind;
use impact_records::record::calibrate::ChannelSetup;
use labfiles::units::Dimension;

/// Nominal values and uncertainties, defaults included.
pub(super) fn resolve(rig: &written::Rig, context: &mut ResolveContext<'_>) -> NominalValues {
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
        name: written::value(&rig.name),
        shared: shared(&rig.shared, context),
    }
}

/// What the campaigns on the rig have in common, by its names.
fn shared(placed: &Placed<Vec<String>>, context: &mut ResolveContext<'_>) -> Vec<Common> {
    let unknown = |name: &str| format!("campaigns cannot share '{name}'");
    let remedy = "remove the line";
    named(placed, ("rig.shared", remedy), unknown, context).unwrap_or_default()
}

/// The effects that the fit allows, by their names.
fn effects(
    placed: &Placed<Vec<String>>,
    context: &mut ResolveContext<'_>,
) -> Option<Vec<EffectKind>> {
    let unknown = |name: &str| format!("no effect is called '{name}'");
    let remedy = "remove the line to allow all";
    named(placed, ("rig.effects", remedy), unknown, context)
}

/// The variants that a list names; a name that is `unknown` is a fault, with what else may be done.
fn named<T: FromStr + VariantNames>(
    placed: &Placed<Vec<String>>,
    (key, otherwise): (&str, &str),
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

/// The delay of a channel must be less than a period of the drive.
pub(super) fn refuse_long_delays(
    channels: &[ChannelSetup],
    records: &[RecordEntry],
    written: &written::Channels,
    context: &mut ResolveContext<'_>,
) {
    let stated = records.iter().filter_map(|r| r.setting.stated_frequency_hz);
    let fastest = stated.fold(0.0, f64::max);
    for channel in channels.iter().filter(|c| c.delay_s.abs() * fastest >= 1.0) {
        let Some(placed) = written.of(channel.role) else {
            continue;
        };
        let what = format!(
            "{:.4} s is longer than a period of the drive at {fastest} Hz",
            channel.delay_s
        );
        context.fault(
            Code::OutOfRange,
            placed,
            &format!("channels.{}.delay", channel.role.name()),
            what,
            "state the delay against the drive's channel, with its unit",
        );
    }
}
