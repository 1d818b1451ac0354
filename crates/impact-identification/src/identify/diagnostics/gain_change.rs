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

/// Share of a change's gain of χ² from which another channel's change explains the records as well: where one gain changes
/// at once the other channel's has less than two fifths of it, where one drifts nearly all (kinds `gain_step` and
/// `gain_drift` of tests/scripts, seeds 701 to 703).
const AS_WELL: f64 = 0.7;

/// A gain that changes in the course of a campaign.
pub struct GainChange {
    channel: Role,
    /// The channel whose gain may change instead, with its change.
    other: Option<(Role, Step)>,
    step: Step,
    /// What is fitted, in the order of the step's shifts.
    free: Vec<Coordinate>,
}

impl GainChange {
    /// The finding, and what it leaves open of each parameter: what the fit would change with it, whichever gain it is.
    pub fn suspicion(&self, evidence: &Evidence<'_>, found: &MethodFit) -> Suspicion {
        let observations = evidence.observations;
        let of = observations.len();
        let first = ranks(observations)
            .iter()
            .position(|r| *r == self.step.rank);
        let record = first.map_or_else(String::new, |i| observations[i].record.clone());
        // for which part the stated gain holds is not known
        let stated = |parameter: Coordinate| match parameter {
            Coordinate::Deflection => self.step.change[0].abs(),
            _ => 0.0,
        };
        let shift = |place: usize| {
            let other = self
                .other
                .as_ref()
                .map_or(0.0, |(_, step)| step.shift[place]);
            self.step.shift[place].abs().max(other.abs())
        };
        let places = self.free.iter().enumerate();
        let physical = places.filter(|(_, parameter)| Coordinate::PHYSICAL.contains(parameter));
        let doubts = physical.filter_map(|(place, parameter)| {
            let by = shift(place).max(stated(*parameter));
            Doubt::material(found, *parameter, by, Note::InstrumentOff)
        });
        let (channel, number) = (self.channel, self.step.rank + 1);
        let deviation = self.step.change[0].exp_m1();
        let finding = match &self.other {
            Some((other, _)) => Finding::GainsPart {
                channel,
                other: *other,
                record,
                number,
                of,
                deviation,
            },
            None => Finding::GainChanged {
                channel,
                record,
                number,
                of,
                deviation,
            },
        };
        Suspicion {
            doubts: doubts.collect(),
            finding,
        }
    }
}

/// Whether a finding is a trace of a gain that changes: corners that do not change take up a part of it.
pub fn explains(finding: &Finding) -> bool {
    matches!(finding, Finding::WrongCorner { .. })
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
                other: None,
                step,
                free: self.fitted.problem.free.clone(),
            })
        });
        let mut changes: Vec<GainChange> = changes.collect();
        changes.sort_by(|a, b| b.step.chi2.total_cmp(&a.step.chi2));
        let mut changes = changes.into_iter();
        let mut found = changes.next()?;
        let as_well = changes.find(|c| c.step.chi2 > AS_WELL * found.step.chi2);
        found.other = as_well.map(|c| (c.channel, c.step));
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

    #[test]
    fn a_gain_that_drifts_is_named_alone_or_with_the_other_that_may_and_no_corner_beside_it() {
        let mut records = recorded(0.8, 12.0, 72, 11);
        let last = records.len() as f64 - 1.0;
        for (i, record) in records.iter_mut().enumerate() {
            let factor = 1.0 + 0.02 * i as f64 / last;
            for channel in &mut record.channels {
                if channel.role == Role::VelocityX {
                    channel.values.iter_mut().for_each(|v| *v *= factor);
                }
            }
        }
        let found = identify(&evidence(&observed(&records)));
        let parts = found.suspicions.iter().find_map(|finding| match finding {
            Finding::GainsPart {
                channel, deviation, ..
            } => Some((*channel, *deviation)),
            Finding::GainChanged {
                channel: Role::VelocityX,
                deviation,
                ..
            } => Some((Role::VelocityX, *deviation)),
            _ => None,
        });
        let (channel, deviation) = parts.expect("a change");
        let of_x = if channel == Role::VelocityX {
            deviation
        } else {
            -deviation
        };
        assert!((0.005..0.015).contains(&of_x), "{of_x}");
        let corner = |finding: &Finding| matches!(finding, Finding::WrongCorner { .. });
        assert!(
            !found.suspicions.iter().any(corner),
            "{:?}",
            found.suspicions
        );
    }
}
