//! Mistakes of a laboratory, made in simulated records on purpose.

use super::seen::Seen;
use impact_fit::Finding;
use impact_records::record::{FlagCode, Record, Role};
use simulated_rig::{Effect, Laboratory};

/// A mistake of the laboratory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Mistake {
    /// One gap is stated 0.05 mm too wide.
    WrongClearance,
    /// One gap is off by five times its stated uncertainty.
    GapOffByFiveUncertainties,
    /// One gap is off by its stated uncertainty: no mistake, and not to be called one.
    GapOffByItsUncertainty,
    /// The velocities of both masses are plugged the wrong way round.
    SwappedChannels,
    /// One channel's gain is 5 % off.
    WrongGain,
    /// One channel's gain is off by its stated uncertainty: no mistake, and not to be called one.
    GainOffByItsUncertainty,
    /// The sampler's clock is 500 ppm off.
    WrongClock,
}

impl Mistake {
    /// All of them.
    pub(super) const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Name in the result.
    pub(super) fn name(self) -> &'static str {
        self.into()
    }

    /// The campaign with an uncertainty of its gaps stated, where the mistake is measured by it.
    pub(super) fn stated(self, draw: &Laboratory) -> Laboratory {
        let typical_m = Effect::Gaps.typical_strength() * draw.truth.static_deflection_m();
        let uncertainty_m = match self {
            Self::GapOffByFiveUncertainties | Self::GapOffByItsUncertainty => {
                Some(draw.clearance_uncertainty_m.unwrap_or(typical_m))
            }
            _ => draw.clearance_uncertainty_m,
        };
        Laboratory {
            clearance_uncertainty_m: uncertainty_m,
            ..draw.clone()
        }
    }

    /// Make the mistake in a campaign's records.
    pub(super) fn commit(self, records: &mut [Record], clearance_uncertainty_m: f64) {
        match self {
            Self::WrongClearance => widen_one_gap(records, 0.05e-3),
            Self::GapOffByFiveUncertainties => {
                widen_one_gap(records, 5.0 * clearance_uncertainty_m);
            }
            Self::GapOffByItsUncertainty => widen_one_gap(records, clearance_uncertainty_m),
            Self::SwappedChannels => {
                for record in records {
                    swap_roles(record, Role::VelocityX, Role::VelocityY);
                }
            }
            Self::WrongGain => amplify(records, 1.05),
            Self::GainOffByItsUncertainty => amplify(records, 1.005),
            Self::WrongClock => {
                for stated in records
                    .iter_mut()
                    .filter_map(|r| r.setting.stated_frequency_hz.as_mut())
                {
                    *stated *= 1.0005;
                }
            }
        }
    }

    /// Whether a finding is this mistake.
    fn is(self, finding: &Finding) -> bool {
        match self {
            Self::WrongClearance
            | Self::GapOffByFiveUncertainties
            | Self::GapOffByItsUncertainty => {
                matches!(finding, Finding::WrongClearance { .. })
            }
            Self::SwappedChannels => matches!(finding, Finding::SwappedChannels { .. }),
            Self::WrongGain | Self::GainOffByItsUncertainty => matches!(
                finding,
                Finding::WrongGain { .. } | Finding::GainsApart { .. }
            ),
            Self::WrongClock => matches!(finding, Finding::ClockOrGenerator { .. }),
        }
    }

    /// Whether an outcome names it.
    pub(super) fn is_named_by(self, seen: &Seen) -> bool {
        match self {
            Self::SwappedChannels if seen.flag(FlagCode::SwappedMasses) => true,
            _ => seen.outcome.suspicions.iter().any(|s| self.is(s)),
        }
    }
}

/// State the gap that most records have (the open one of the resonance curve apart) too wide.
pub(super) fn widen_one_gap(records: &mut [Record], by_m: f64) {
    let open = records.first().and_then(|r| r.setting.clearance_m);
    let Some(gap) = records
        .iter()
        .map(|r| r.setting.clearance_m)
        .find(|c| *c != open)
        .flatten()
    else {
        return;
    };
    for record in records {
        if record.setting.clearance_m == Some(gap) {
            record.setting.clearance_m = Some(gap + by_m);
        }
    }
}

/// Multiply the displacement of mass x.
fn amplify(records: &mut [Record], factor: f64) {
    for channel in records.iter_mut().flat_map(|r| &mut r.channels) {
        if channel.role == Role::DisplacementX {
            channel.values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}

fn swap_roles(record: &mut Record, a: Role, b: Role) {
    for channel in &mut record.channels {
        if channel.role == a {
            channel.role = b;
        } else if channel.role == b {
            channel.role = a;
        }
    }
}
