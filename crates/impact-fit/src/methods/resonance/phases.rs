//! What the phases of impactless records tell of their channels.

use nalgebra::Complex;
use std::f64::consts::TAU;

use crate::evidence::Evidence;
use crate::methods::blocks::Blocks;
use crate::parameters::Parameters;
use impact_records::motion::LateChannel;
use impact_records::record::Role;

/// Misfit, a mean square in units of the errors, up to which nothing is left to explain.
pub(super) const EXPLAINED: f64 = 4.0;
/// Times the stated uncertainty of delays from which a lag counts, and the error of a response from which it is seen.
pub(super) const SURE: f64 = 4.0;

/// Channels that are not as stated, and the misfit that is left with them.
pub(super) struct Misstated {
    pub(super) channels: Vec<LateChannel>,
    pub(super) left: f64,
}

/// What the phases of impactless records tell.
pub(super) struct Phases<'a> {
    /// The impactless records.
    pub(super) evidence: &'a Evidence<'a>,
    pub(super) blocks: &'a Blocks,
    /// The curve that fits best with all channels as stated.
    pub(super) stated: &'a Parameters,
    /// The misfit that it leaves.
    pub(super) at_once: f64,
}

impl Phases<'_> {
    /// The lag up to which nothing is noticed, s.
    pub(super) fn unnoticed_s(&self) -> f64 {
        let stated = self.evidence.nominal.delay_uncertainties_s.iter();
        let stated_s = stated.map(|own| own.unwrap_or(self.blocks.half_sample_s()));
        SURE * stated_s.fold(0.0, f64::max)
    }
}

/// The factor that changes nothing.
pub(super) const ONE: Complex<f64> = Complex::new(1.0, 0.0);

/// The blocks with all responses times a factor of their channel and iω, 1/s.
pub(super) fn with_responses(
    blocks: &Blocks,
    factor: impl Fn(Role, Complex<f64>) -> Complex<f64>,
) -> Blocks {
    let mut changed = blocks.clone();
    for point in &mut changed.resonance.points {
        let rate = Complex::new(0.0, TAU * point.frequency_hz);
        for response in &mut point.responses {
            *response = response.times(factor(response.role, rate));
        }
    }
    let relative_error = changed.resonance.relative_error();
    changed.resonance.allow(relative_error);
    changed
}

/// The frequency of the fastest drive, Hz.
pub(super) fn fastest_hz(blocks: &Blocks) -> f64 {
    let points = blocks.resonance.points.iter();
    points.map(|p| p.frequency_hz).fold(0.0, f64::max)
}
