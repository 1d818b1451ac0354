//! A driving force that rises with a power of the frequency, told by waveforms: for campaigns whose impactless records have too
//! few frequencies to tell it.

use crate::evidence::{Evidence, Nominal};
use crate::methods::blocks::Blocks;
use crate::methods::trajectories::starts;
use crate::parameters::Parameters;
use impact_records::motion::ForceLaw;
use impact_records::signal::robust;

/// Periodic records from which a power is told: four of them determine the parameters.
const FEWEST: usize = 8;
/// Powers that are tried: a fit that has one of them tells by its slope of the force what is left.
const STEPS: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
/// Part of the mean square of a constant force that the law may leave, as of the resonance curve.
const LEFT: f64 = 0.1;

/// The law, where the waveforms are those of the model with it and not with a constant force, about the natural frequency; its
/// power is one of those tried.
pub fn rising_force(evidence: &Evidence<'_>) -> Option<ForceLaw> {
    let blocks = starts::thinned(&Blocks::new(evidence));
    let records = blocks.trajectory.records.iter();
    let hz: Vec<f64> = records.map(|record| record.frequency_hz).collect();
    if hz.len() < FEWEST {
        return None;
    }
    let search = Search {
        middle_hz: robust::median(&hz)?,
        nominal: &evidence.nominal,
        blocks: &blocks,
    };
    let constant = search.tried(0.0, search.guess());
    if starts::deviation(&blocks, &constant.fitted) < starts::FITS {
        return None;
    }
    let up = search.each(STEPS.into_iter(), &constant);
    let down = search.each(STEPS.into_iter().map(|step| -step), &constant);
    let all = up.into_iter().chain(down);
    let best = all.min_by(|a, b| a.score.total_cmp(&b.score))?;
    (best.score < constant.score + LEFT.ln()).then_some(ForceLaw {
        power: best.power,
        at_hz: best.fitted.natural_frequency_hz,
    })
}

/// The waveforms, and where their forces are alike.
struct Search<'a> {
    middle_hz: f64,
    nominal: &'a Nominal,
    blocks: &'a Blocks,
}

/// A power that was tried, its fit, and how badly the records fit: the mean of the logarithms of their mean squares.
#[derive(Clone)]
struct Tried {
    power: f64,
    fitted: Parameters,
    score: f64,
}

impl Search<'_> {
    /// Powers one after the other, each from where the fit of the one before ended.
    fn each(&self, powers: impl Iterator<Item = f64>, constant: &Tried) -> Vec<Tried> {
        let mut before = constant.fitted;
        let tried = powers.map(|power| {
            let tried = self.tried(power, before);
            before = tried.fitted;
            tried
        });
        tried.collect()
    }

    /// The best fit with a power.
    fn tried(&self, power: f64, start: Parameters) -> Tried {
        let blocks = self.about(power);
        let (score, fitted) = starts::searched(&blocks, self.nominal, start);
        Tried {
            power,
            fitted,
            score,
        }
    }

    /// The blocks with forces that rise with a power.
    fn about(&self, power: f64) -> Blocks {
        let law = ForceLaw {
            power,
            at_hz: self.middle_hz,
        };
        let mut blocks = self.blocks.clone();
        for record in &mut blocks.trajectory.records {
            record.drive_amplitude *= law.factor(record.frequency_hz);
        }
        for point in &mut blocks.resonance.points {
            point.drive_amplitude *= law.factor(point.frequency_hz);
        }
        blocks
    }

    /// Values of the scale of the campaign, with R as speeds at impacts tell it.
    fn guess(&self) -> Parameters {
        let records = self.blocks.trajectory.records.iter();
        let gaps_m: Vec<f64> = records.map(|record| record.clearance_m.abs()).collect();
        let restitution = self.blocks.impact.typical_ratio().unwrap_or(0.8);
        let scale_m = robust::median(&gaps_m).unwrap_or(1e-3);
        let guess = Parameters::symmetric(
            restitution.clamp(0.0, 1.0),
            self.middle_hz / 1.2,
            0.05,
            0.5 * scale_m,
        );
        self.nominal.applied(guess)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};

    #[test]
    fn valid_a_force_that_rises_with_the_frequency_is_told_by_waveforms_alone() {
        let constant = observed(&recorded(0.8, 12.0, 60, 45));
        for power in [-1.0, 0.0, 1.0, 2.0] {
            let mut observations = constant.clone();
            for o in &mut observations {
                let Some(hz) = o.frequency_hz() else { continue };
                // what is stated falls as the force beside it rises
                o.setting.drive_amplitude /= (hz / 12.0).powf(power);
                o.response.clear();
            }
            let found = rising_force(&evidence(&observations));
            let told = found.map_or(0.0, |law| law.power);
            assert!((told - power).abs() < 0.1, "{found:?} for {power}");
            if let Some(law) = found {
                assert!((law.at_hz / 12.0 - 1.0).abs() < 0.02, "{found:?}");
            }
        }
    }
}
