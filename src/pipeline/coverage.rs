//! Many synthetic campaigns with random truths, noise and faults, identified like real ones: what
//! the intervals are worth, and whether mistakes of the laboratory are found.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use crate::event::{DetectSettings, RigKind};
use crate::identify::evidence::{Evidence, Nominal};
use crate::identify::fit::parameters::Parameters;
use crate::identify::run::identify;
use crate::identify::uncertainty::bound::bounds;
use crate::identify::uncertainty::coverage::{Score, Trial, scores, table};
use crate::identify::uncertainty::{IntervalMethod, UncertaintyOptions};
use crate::identify::{Finding, Identification};
use crate::motion::{Bracket, ClassifySettings, Observation, brackets, observe, scale_drives};
use crate::pipeline::{PipelineError, Progress};
use crate::record::{FlagCode, Record, Role};
use crate::synthetic::run::calibrated;
use crate::synthetic::{Draw, Reach, RigSpec, Truth, draw, records};

/// What a coverage study finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// Campaigns of the main study.
    pub campaigns: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// The rig: exact, realistic, or its effects with their strengths.
    pub rig: String,
    /// Every estimate of every campaign, as CSV.
    #[serde(skip)]
    pub estimates: String,
    /// Scores by method (`joint` among them) and parameter.
    pub methods: BTreeMap<String, BTreeMap<String, Score>>,
    /// Campaigns in which nothing touches: how often R was called not identifiable, as it must.
    pub nothing_touches: Tally,
    /// Mistakes of the laboratory: how often each was found and named.
    pub mistakes: BTreeMap<&'static str, Tally>,
    /// Campaigns without a mistake in which one was suspected.
    pub false_alarms: Tally,
}

/// So many of so many.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Tally {
    /// How often it happened.
    pub found: usize,
    /// Out of how many campaigns.
    pub of: usize,
}

/// A mistake of the laboratory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mistake {
    /// One gap is stated 0.05 mm too wide.
    WrongClearance,
    /// The velocities of both masses are plugged the wrong way round.
    SwappedChannels,
    /// One channel's gain is 5 % off.
    WrongGain,
}

impl Mistake {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::WrongClearance, Self::SwappedChannels, Self::WrongGain];

    /// Name in the result.
    pub fn name(self) -> &'static str {
        match self {
            Self::WrongClearance => "wrong_clearance",
            Self::SwappedChannels => "swapped_channels",
            Self::WrongGain => "wrong_gain",
        }
    }

    /// Make the mistake in a campaign's records.
    fn commit(self, records: &mut [Record]) {
        match self {
            Self::WrongClearance => widen_one_gap(records, 0.05e-3),
            Self::SwappedChannels => {
                for record in records {
                    swap_roles(record, Role::VelocityX, Role::VelocityY);
                }
            }
            Self::WrongGain => {
                for record in records {
                    let channel = record
                        .channels
                        .iter_mut()
                        .find(|c| c.role == Role::DisplacementX);
                    for v in channel.into_iter().flat_map(|c| &mut c.values) {
                        *v *= 1.05;
                    }
                }
            }
        }
    }

    /// Whether a finding is this mistake.
    fn is(self, finding: &Finding) -> bool {
        match self {
            Self::WrongClearance => matches!(finding, Finding::WrongClearance { .. }),
            Self::SwappedChannels => matches!(finding, Finding::SwappedChannels { .. }),
            Self::WrongGain => matches!(finding, Finding::WrongGain { .. }),
        }
    }

    /// Whether an outcome names it.
    fn is_named_by(self, seen: &Seen) -> bool {
        match self {
            Self::SwappedChannels if seen.flag(FlagCode::SwappedMasses) => true,
            _ => seen.outcome.suspicions.iter().any(|s| self.is(s)),
        }
    }
}

/// State the gap that most records have (the open one of the resonance curve apart) too wide.
fn widen_one_gap(records: &mut [Record], by_m: f64) {
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

fn swap_roles(record: &mut Record, a: Role, b: Role) {
    for channel in &mut record.channels {
        if channel.role == a {
            channel.role = b;
        } else if channel.role == b {
            channel.role = a;
        }
    }
}

/// A campaign after identification.
struct Seen {
    observations: Vec<Observation>,
    brackets: Vec<Bracket>,
    outcome: Identification,
}

impl Seen {
    fn flag(&self, code: FlagCode) -> bool {
        let count = |o: &&Observation| o.flags.iter().any(|f| f.code == code);
        2 * self.observations.iter().filter(count).count() > self.observations.len()
    }
}

fn evidence<'a>(
    observations: &'a [Observation],
    brackets: &'a [Bracket],
    draw: &Draw,
) -> Evidence<'a> {
    Evidence {
        rig: RigKind::Double,
        observations,
        brackets,
        nominal: Nominal {
            gain_uncertainty: draw.faults.gain_deviation,
            corner_uncertainty: draw.faults.corner_deviation,
            clearance_uncertainty_m: draw.clearance_uncertainty_m.unwrap_or(0.0),
            ..Nominal::default()
        },
        // Nobody reads profiles of hundreds of campaigns.
        uncertainty: UncertaintyOptions {
            intervals: IntervalMethod::Covariance,
            ..UncertaintyOptions::default()
        },
        progress: None,
    }
}

/// Simulate, observe and identify a campaign, with a mistake or without.
fn campaign(draw: &Draw, mistake: Option<Mistake>) -> Result<Seen, PipelineError> {
    let raw = records(&draw.laboratory())?;
    let mut records: Vec<Record> = raw
        .iter()
        .map(|r| calibrated(r, &draw.truth, &draw.faults))
        .collect();
    if let Some(mistake) = mistake {
        mistake.commit(&mut records);
    }
    let mut observations: Vec<Observation> = records
        .into_par_iter()
        .map(|mut record| {
            let found = crate::record::consistency::inspect(&record);
            record.flags.extend(found);
            let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
            observe(&record, RigKind::Double, &detect, &classify)
        })
        .collect();
    scale_drives(&mut observations);
    let brackets = brackets(&observations);
    let outcome = identify(&evidence(&observations, &brackets, draw));
    Ok(Seen {
        observations,
        brackets,
        outcome,
    })
}

/// Simulate, observe and identify a campaign without a mistake.
///
/// # Errors
/// Where the simulation refuses its parameters.
pub(super) fn identified(draw: &Draw) -> Result<Identification, PipelineError> {
    Ok(campaign(draw, None)?.outcome)
}

/// What a campaign contributes to the scores.
fn trial(seen: &Seen, draw: &Draw) -> Trial {
    let truth = parameters(&draw.truth);
    let bounds = bounds(&evidence(&seen.observations, &seen.brackets, draw), &truth);
    Trial::new(truth, &seen.outcome.joint, &seen.outcome.methods, bounds)
}

fn parameters(truth: &Truth) -> Parameters {
    Parameters {
        drive_asymmetry: truth.drive_asymmetry,
        stiffness_asymmetry: truth.stiffness_asymmetry,
        damping_asymmetry: truth.damping_asymmetry,
        ..Parameters::symmetric(
            truth.restitution,
            truth.natural_frequency_hz,
            truth.damping_ratio,
            truth.static_deflection_m,
        )
    }
}

/// Run a study of that many campaigns on rigs with these effects, and a fifth as many for each
/// mistake.
///
/// # Errors
/// Where a simulation refuses its parameters.
pub fn study(
    campaigns: usize,
    seed: u64,
    rig: &RigSpec,
    progress: Progress<'_>,
) -> Result<Coverage, PipelineError> {
    let few = campaigns.div_ceil(5);
    let total = (campaigns + few * (1 + Mistake::ALL.len())) as u64;
    let done = AtomicU64::new(0);
    let step = || {
        progress("campaigns", done.fetch_add(1, Ordering::Relaxed) + 1, total);
    };
    let main: Vec<(bool, Trial)> = (0..campaigns as u64)
        .into_par_iter()
        .map(|i| {
            let draw = draw(seed, i, Reach::Full, rig);
            let seen = campaign(&draw, None)?;
            let trial = trial(&seen, &draw);
            step();
            Ok((!seen.outcome.suspicions.is_empty(), trial))
        })
        .collect::<Result<_, PipelineError>>()?;
    let alarms = main.iter().filter(|(alarm, _)| *alarm).count();
    let trials: Vec<Trial> = main.into_iter().map(|(_, trial)| trial).collect();
    let count = |reach: Reach, mistake: Option<Mistake>, named: &(dyn Fn(&Seen) -> bool + Sync)| {
        let found: Vec<bool> = (0..few as u64)
            .into_par_iter()
            .map(|i| {
                let seen = campaign(&draw(seed ^ 0x00FA_0175, i, reach, rig), mistake)?;
                step();
                Ok(named(&seen))
            })
            .collect::<Result<_, PipelineError>>()?;
        Ok::<Tally, PipelineError>(Tally {
            found: found.iter().filter(|f| **f).count(),
            of: few,
        })
    };
    let nothing_touches = count(Reach::NothingTouches, None, &|seen| {
        let r = seen.outcome.joint.parameters.restitution.as_ref();
        r.is_none_or(|r| r.value.is_none())
    })?;
    let mut mistakes = BTreeMap::new();
    for mistake in Mistake::ALL {
        let tally = count(Reach::Full, Some(mistake), &|seen| {
            mistake.is_named_by(seen)
        })?;
        mistakes.insert(mistake.name(), tally);
    }
    Ok(Coverage {
        campaigns,
        seed,
        rig: rig.to_string(),
        methods: scores(&trials),
        estimates: table(&trials),
        nothing_touches,
        mistakes,
        false_alarms: Tally {
            found: alarms,
            of: campaigns,
        },
    })
}
