//! A channel whose gain changes in the course of a campaign, as where an amplifier's range is switched or a sensor is
//! mounted anew: two channels of the same motions tell it far better than their calibration.

use crate::identify::diagnostics::change::{Search, Step, ranks};
use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use impact_fit::evidence::Evidence;
use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::parameters::{Coordinate, GAIN_ROLES};
use impact_records::record::Role;

/// The least change of a gain that is named: amplifiers and sensors are as stable within a campaign.
const LEAST: f64 = 2e-3;

/// A gain that changes in the course of a campaign.
pub struct GainChange {
    channel: Role,
    step: Step,
    /// What is fitted, in the order of the step's shifts.
    free: Vec<Coordinate>,
}

impl GainChange {
    /// The finding, and what it leaves open of each parameter: what the fit would change with it.
    pub fn suspicion(&self, evidence: &Evidence<'_>, found: &MethodFit) -> Suspicion {
        let observations = evidence.observations;
        let of = observations.len();
        let first = ranks(observations)
            .iter()
            .position(|r| *r == self.step.rank);
        let record = first.map_or_else(String::new, |i| observations[i].record.clone());
        let shifts = self.free.iter().zip(&self.step.shift);
        let physical = shifts.filter(|(parameter, _)| Coordinate::PHYSICAL.contains(parameter));
        let doubts = physical.filter_map(|(parameter, by)| {
            Doubt::material(found, *parameter, by.abs(), Note::InstrumentOff)
        });
        Suspicion {
            doubts: doubts.collect(),
            finding: Finding::GainChanged {
                channel: self.channel,
                record,
                number: self.step.rank + 1,
                of,
                deviation: self.step.change[0].exp_m1(),
            },
        }
    }
}

impl Search<'_> {
    /// The channel whose gain changes from some record on, where that explains the records' rows better than a change
    /// of all four parameters.
    pub fn gain_in_time(&self) -> Option<GainChange> {
        let ranks = ranks(self.evidence.observations);
        // what waveforms are allowed beside their noise acts on whole records
        let allowed = self.fitted.selection.blocks.trajectory.relative_error();
        let changes = self.fitted.problem.free.iter().filter_map(|of| {
            let index = of.gain()?;
            let step = self.most(&ranks, |c| c == *of)?;
            (step.change[0].abs() > LEAST.max(allowed)).then_some(GainChange {
                channel: GAIN_ROLES[index],
                step,
                free: self.fitted.problem.free.clone(),
            })
        });
        let found = changes.max_by(|a, b| a.step.chi2.total_cmp(&b.step.chi2))?;
        let of_rig = self.by_rows(&ranks).map_or(0.0, |(chi2, _)| chi2);
        (found.step.chi2 > of_rig).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::run::identify;
    use impact_fit::fixture::{evidence, observed, recorded};
    use impact_fit::methods::answer::VerdictKind;
    use impact_fit::parameters::effect::EffectKind;

    #[test]
    fn valid_a_gain_that_changes_half_way_is_named_with_the_record_and_the_change() {
        let exact = recorded(0.8, 12.0, 72, 11);
        let found = |factor: f64| {
            let mut records = exact.clone();
            for channel in records.iter_mut().skip(36).flat_map(|r| &mut r.channels) {
                if channel.role == Role::VelocityY {
                    channel.values.iter_mut().for_each(|v| *v *= factor);
                }
            }
            identify(&evidence(&observed(&records)))
        };
        for factor in [1.03, 0.98] {
            let found = found(factor);
            let changed = found.suspicions.iter().find_map(|finding| match finding {
                Finding::GainChanged {
                    channel,
                    number,
                    deviation,
                    ..
                } => Some((*channel, *number, *deviation)),
                _ => None,
            });
            let (channel, number, deviation) = changed.expect("a change");
            assert_eq!(channel, Role::VelocityY);
            assert!((35..=39).contains(&number), "{number}");
            assert!((deviation + 1.0 - factor).abs() < 1e-3, "{deviation}");
            let deflection = found.joint.parameters.static_deflection_m.expect("x_st");
            let [low, high] = deflection.interval95.expect("an interval");
            assert!((low..high).contains(&1e-3), "{low} {high}");
            // no other change and no drift is named beside it
            let named = &found.verdict.findings;
            let drifts = |finding: &Finding| match finding {
                Finding::BeyondModel { effect, .. } => effect.kind() == EffectKind::Drift,
                other => matches!(other, Finding::RigChanged { .. }),
            };
            assert!(!named.iter().any(drifts), "{named:?}");
        }
        let same = found(1.0);
        assert_eq!(same.verdict.kind, VerdictKind::Identified);
        assert!(same.suspicions.is_empty(), "{:?}", same.suspicions);
    }
}
