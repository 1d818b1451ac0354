//! A driving force that rises with a power of the frequency: the resonance curve tells it where it is far from that of
//! a constant force.

use crate::evidence::Evidence;
use crate::messages::ONE_DEGREE_OF_FREEDOM;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::fit;
use crate::methods::resonance::misfit::{least_of, left_by, misfit};
use crate::methods::resonance::result::deviation;
use impact_records::motion::ForceLaw;

/// Greatest power that is looked for, and the steps of the search.
const STEEPEST: f64 = 4.0;
const STEP: f64 = 0.5;
/// Least power that counts: the effect `force_frequency`, of first and second order about f0, describes less of it.
pub const LEAST: f64 = 0.3;
/// Part of the misfit of a constant force that the law may leave.
const LEFT: f64 = 0.1;
/// Deviation of the responses from the curve of a constant force up to which there is no law: a power of 0.3 over
/// frequencies of 1.2 to 2 f0 leaves more.
const FITS: f64 = 0.01;
/// Frequencies of impactless records from which a law is told: two of them would determine a curve and the power.
const FEWEST: usize = 5;
/// Relative difference from which two frequencies are not those of one setting.
const APART: f64 = 1e-3;

/// Whether impactless records have enough frequencies that the resonance curve tells a law, or that there is none.
pub fn tells(evidence: &Evidence<'_>) -> bool {
    has_frequencies(&Blocks::new(evidence))
}

/// The blocks with a resonance curve whose forces follow a law.
pub(super) fn followed(blocks: &Blocks, law: ForceLaw) -> Blocks {
    let mut blocks = blocks.clone();
    for point in &mut blocks.resonance.points {
        point.drive_amplitude *= law.factor(point.frequency_hz);
    }
    blocks
}

/// Whether the resonance curve has so many different frequencies that it tells a law.
pub(super) fn has_frequencies(blocks: &Blocks) -> bool {
    let points = blocks.resonance.points.iter();
    let mut hz: Vec<f64> = points.map(|p| p.frequency_hz).collect();
    hz.sort_by(f64::total_cmp);
    hz.dedup_by(|next, kept| *next < *kept * (1.0 + APART));
    hz.len() >= FEWEST
}

/// The law, where the responses are those of one degree of freedom with it and not without; about the natural
/// frequency, so that `x_st` is that of the force there.
pub fn force_law(evidence: &Evidence<'_>) -> Option<ForceLaw> {
    let blocks = Blocks::new(evidence);
    if !has_frequencies(&blocks) {
        return None;
    }
    let constant = fit::start(&blocks, &evidence.nominal)?;
    if deviation(&blocks.resonance, &constant) < FITS {
        return None;
    }
    let hz: Vec<f64> = blocks
        .resonance
        .points
        .iter()
        .map(|p| p.frequency_hz)
        .collect();
    let middle_hz = impact_records::signal::robust::median(&hz)?;
    let about = |power: f64, at_hz: f64| followed(&blocks, ForceLaw { power, at_hz });
    let left = |power: f64| misfit(&about(power, middle_hz), &evidence.nominal);
    let power = least_of(STEEPEST, STEP, &left)?;
    let with = about(power, middle_hz);
    let start = fit::start(&with, &evidence.nominal)?;
    let left = left_by(&with, &start)?;
    let found = fit::from(&with, &evidence.nominal.ideal(), start)?.ok()?;
    let found = found.fit.parameters;
    let describes = left < LEFT * left_by(&blocks, &constant)?
        && deviation(&with.resonance, &found) < ONE_DEGREE_OF_FREEDOM;
    (describes && power.abs() > LEAST).then_some(ForceLaw {
        power,
        at_hz: found.natural_frequency_hz,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};

    #[test]
    fn valid_forces_that_rise_with_a_power_of_the_frequency_are_told_from_the_resonance_curve() {
        let constant = observed(&recorded(0.8, 12.0, 60, 44));
        for power in [-2.0, -1.0, 0.0, 0.1, 1.0, 2.0] {
            let mut observations = constant.clone();
            for o in &mut observations {
                let Some(hz) = o.frequency_hz() else { continue };
                let factor = (hz / 12.0).powf(power);
                for r in &mut o.response {
                    (r.real, r.imaginary) = (r.real * factor, r.imaginary * factor);
                }
            }
            let found = force_law(&evidence(&observations));
            if power.abs() < LEAST {
                assert_eq!(found, None);
            } else {
                let found = found.expect("a law");
                assert!((found.power - power).abs() < 0.02, "{found:?} for {power}");
                assert!((found.at_hz / 12.0 - 1.0).abs() < 0.01, "{found:?}");
            }
        }
    }
}
