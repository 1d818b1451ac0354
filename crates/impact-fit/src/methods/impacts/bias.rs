//! What R from speeds at impacts leaves open beside its noise.

use crate::method_fit::MethodFit;
use crate::methods::impacts::block::ImpactBlock;
use crate::parameters::Coordinate;
use crate::parameters::effect::{Effect, Effects};
use crate::solver::Fit;
use impact_records::signal::robust;

/// What the extrapolation of speeds to the impact leaves open in R.
const IMPACT_BIAS: f64 = 2e-4;
/// What it leaves open beside that where a contact has a length: all of it from `SHORT_CONTACT_MS` on, and
/// more per ms.
const CONTACT_BIAS: f64 = 2.5e-3;
const CONTACT_BIAS_PER_MS: f64 = 3e-3;
/// What channels that are late by different delays leave open beside that, per ms between the first and the last.
const DELAY_BIAS_PER_MS: f64 = 3e-3;
/// A contact that the flights' extrapolation begins to notice, ms.
const SHORT_CONTACT_MS: f64 = 0.1;

/// What the extrapolation of speeds to the impacts and the law of contact leave open in R, with the length of a contact and the
/// delays of the channels that a fit of waveforms found. Where the fit tells nothing of the length, all of what
/// a good laboratory would accept is left, if the rig may have it (`effects`) and is driven through its impacts.
pub(super) fn impact_bias(block: &ImpactBlock, waveforms: &Fit, effects: Effects) -> f64 {
    let length = Effect::ContactDuration;
    let untold = !waveforms.free.contains(&Coordinate::Effect(length));
    let contact_ms = if untold && !block.free && effects.iter().any(|e| e == length) {
        length.accepted()
    } else {
        waveforms.parameters.effect(length)
    };
    let noticed = (contact_ms / SHORT_CONTACT_MS).clamp(-1.0, 1.0);
    let delays_s = robust::range(waveforms.parameters.delays_s);
    let apart_ms = delays_s.map_or(0.0, |(first, last)| 1e3 * (last - first));
    IMPACT_BIAS
        .hypot(CONTACT_BIAS * noticed)
        .hypot(CONTACT_BIAS_PER_MS * contact_ms)
        .hypot(DELAY_BIAS_PER_MS * apart_ms)
        .hypot(block.open_by_law())
}

/// Weight of the impacts among the other methods: what the extrapolation of speeds leaves open, `bias`, is
/// common to all impacts, so that all together tell no more than that.
pub(super) fn weight(found: &MethodFit, bias: f64) -> f64 {
    let square = found.fit.conditional_variance(Coordinate::Restitution);
    let square = square.unwrap_or(0.0) * found.factor;
    square / (square + bias * bias) / found.factor
}
