//! All records of a campaign as observed, and the boundaries that they bracket.

use std::path::Path;

use super::block_cache::BlockCache;
use super::checkpoint;
use super::error::{PipelineError, Progress, RefusedRecord};
use super::evidence;
use super::observe;
use crate::campaign::resolved::ResolvedCampaign;
use impact_fit::evidence::Evidence;
use impact_fit::methods::resonance::channels::misstated_channels;
use impact_fit::methods::resonance::drive_amplitudes::follow_stated;
use impact_fit::methods::resonance::force_law;
use impact_fit::methods::trajectories::rising_force::rising_force;
use impact_fit::parameters::Coordinate;
use impact_fit::parameters::effect::Effect;
use impact_identification::identify::identify_campaign;
use impact_records::motion::{
    Bracket, ForceLaw, LateChannel, Observation, brackets, follow_force_law, inverted_channels,
    late_channels, scale_drives, state_drives, turned_channels,
};
use impact_records::record::{Flag, FlagCode, Problem};
use labfiles_write::output::OutputError;

/// All records as observed.
#[derive(Debug, Clone)]
pub struct Observed {
    /// One entry per record, in the order of acquisition.
    pub observations: Vec<Observation>,
    /// The brackets of boundaries.
    pub brackets: Vec<Bracket>,
}

impl Observed {
    /// Observe all records of a campaign.
    ///
    /// # Errors
    /// [`PipelineError::NothingUsable`] where no record can be used.
    pub fn of(campaign: &ResolvedCampaign, progress: Progress<'_>) -> Result<Self, PipelineError> {
        Self::whatever_is_there(campaign, progress)?.usable(campaign)
    }

    /// Observe all records of a campaign, of which none need be there any more.
    ///
    /// # Errors
    /// [`PipelineError`] where what is observed cannot be kept.
    pub fn whatever_is_there(
        campaign: &ResolvedCampaign,
        progress: Progress<'_>,
    ) -> Result<Self, PipelineError> {
        let observations = observe_all(campaign, progress)?;
        Self::corrected(campaign, observations, progress)
    }

    /// Observe all records of a campaign with checkpoints in `out`; with `resume` those of an
    /// interrupted run are used.
    ///
    /// # Errors
    /// As [`Observed::of`], and if a checkpoint cannot be written.
    pub(super) fn resumable(
        campaign: &ResolvedCampaign,
        out: &Path,
        resume: bool,
        progress: Progress<'_>,
    ) -> Result<Self, PipelineError> {
        let kept = checkpoint::open(campaign, out, resume)?;
        let chunk = checkpoint::chunk_of(campaign.records.len());
        let observations = observe::observe_in_chunks(campaign, &kept, chunk, progress)?;
        Self::from_observations(campaign, observations, progress)
    }

    /// The channels that were found late, and whose samples were moved back.
    pub fn late(&self) -> &[LateChannel] {
        evidence::late(&self.observations)
    }

    /// What an identification of the campaign starts from.
    pub fn evidence(&self, campaign: &ResolvedCampaign) -> Evidence<'_> {
        evidence::evidence(campaign, &self.observations, &self.brackets)
    }

    /// Forget the folded waveforms of all records.
    pub(super) fn drop_waveforms(&mut self) {
        for observation in &mut self.observations {
            observation.folded = None;
        }
    }

    /// What was observed of a campaign's records, in their order, with the brackets in it; observed again where
    /// channels are not as stated.
    ///
    /// # Errors
    /// [`PipelineError::NothingUsable`] where no record can be used.
    pub(super) fn from_observations(
        campaign: &ResolvedCampaign,
        observations: Vec<Observation>,
        progress: Progress<'_>,
    ) -> Result<Self, PipelineError> {
        Self::corrected(campaign, observations, progress)?.usable(campaign)
    }

    /// With the brackets; observed again where channels are not as stated.
    fn corrected(
        campaign: &ResolvedCampaign,
        observations: Vec<Observation>,
        progress: Progress<'_>,
    ) -> Result<Self, PipelineError> {
        let mut observations = aligned(campaign, observations, progress)?;
        leave_out_other_rows(&mut observations);
        Ok(Self::bracketed(observations))
    }

    /// Refuse where no record can be used.
    fn usable(self, campaign: &ResolvedCampaign) -> Result<Self, PipelineError> {
        if self.observations.iter().all(Observation::excluded) {
            let refused = self.observations.into_iter().zip(&campaign.records);
            let refused = refused.map(|(o, entry)| RefusedRecord {
                file: entry.file.clone(),
                record: o.record,
                flags: o.flags,
            });
            return Err(PipelineError::NothingUsable(refused.collect()));
        }
        Ok(self)
    }

    /// Observations whose drives are scaled, with the brackets in them.
    pub(super) fn bracketed(observations: Vec<Observation>) -> Self {
        Self {
            brackets: brackets(&observations),
            observations,
        }
    }
}

/// The observations; made again where they show that channels are not as stated, with these corrected: signs by the
/// directions of jumps, in some records or in all, channels beside each other by the times of impacts, then the drive's,
/// and a low-pass that no jump shows, by the phases of the motion. The drive amplitudes are as measured, and follow the
/// law of the force that the resonance curve shows.
fn aligned(
    campaign: &ResolvedCampaign,
    observations: Vec<Observation>,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let turned = turned_channels(&observations);
    if turned.is_empty() {
        return aligned_in_all(campaign, observations, progress);
    }
    let campaign = campaign.clone().with_turned(turned);
    let again = observe_all(&campaign, progress)?;
    aligned_in_all(&campaign, again, progress)
}

/// The same of what all records have in common.
fn aligned_in_all(
    campaign: &ResolvedCampaign,
    observations: Vec<Observation>,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let found = inverted_channels(&observations);
    let observations = corrected(campaign, observations, found, progress)?;
    let found = late_channels(&observations);
    let mut observations = corrected(campaign, observations, found, progress)?;
    // of a drive of the other sign the delay is told once its sign is right
    for _ in 0..2 {
        scale(campaign, &mut observations);
        let found = misstated_channels(&evidence::evidence(campaign, &observations, &[]));
        let again = found.iter().any(|channel| channel.inverted);
        observations = corrected(campaign, observations, found, progress)?;
        if !again {
            break;
        }
    }
    scale(campaign, &mut observations);
    follow_the_force(campaign, &mut observations);
    Ok(observations)
}

/// Set the drive amplitudes to what was measured of them, or leave what is stated where that contradicts it and the motion
/// follows it.
fn scale(campaign: &ResolvedCampaign, observations: &mut [Observation]) {
    scale_drives(observations);
    if follow_stated(&evidence::evidence(campaign, observations, &[])) {
        state_drives(observations);
    }
}

/// Let the drive amplitudes follow the law of the force that the resonance curve or, where it has too few points to tell,
/// waveforms show, about the f0 that all records tell: they tell it better than the curve, which the power bends.
fn follow_the_force(campaign: &ResolvedCampaign, observations: &mut [Observation]) {
    let Some(mut law) = force_law_shown(&evidence::evidence(campaign, observations, &[])) else {
        return;
    };
    for _ in 0..LAW_ROUNDS {
        follow_force_law(observations, law);
        let Some(told) = law_told(campaign, observations, law.power) else {
            return;
        };
        let settled = told.power == law.power;
        law = told;
        if settled {
            break;
        }
    }
    follow_force_law(observations, law);
}

/// The law of the force that the resonance curve shows or, where it cannot tell, the waveforms.
fn force_law_shown(evidence: &Evidence<'_>) -> Option<ForceLaw> {
    if force_law::tells(evidence) {
        force_law::force_law(evidence)
    } else {
        rising_force(evidence)
    }
}

/// Times at most that all records tell the law: the slope of the force that a fit finds beside a power is what that leaves.
const LAW_ROUNDS: usize = 3;

/// The law that all records together tell: f0, and the given power with the slope of the force at f0 that it leaves, where that
/// is one that counts.
fn law_told(
    campaign: &ResolvedCampaign,
    observations: &[Observation],
    power: f64,
) -> Option<ForceLaw> {
    let found = identify_campaign(&evidence::evidence(campaign, observations, &[])).joint;
    let at_hz = found.parameters.natural_frequency_hz?.value?;
    let slope = found.further.get(&Coordinate::Effect(Effect::ForceSlope));
    let slope = slope.and_then(|slope| slope.value).unwrap_or(0.0);
    let left = if slope.abs() > force_law::LEAST {
        slope
    } else {
        0.0
    };
    Some(ForceLaw {
        power: power + left,
        at_hz,
    })
}

/// Share of the records with a drive of another frequency than stated up to which these are single rows that contradict, and not
/// what all frequencies have in common.
const SINGLE_ROWS: f64 = 0.2;

/// Leave out single records whose drive is not that of their row: the row's clearance and sweep may be another record's.
fn leave_out_other_rows(observations: &mut [Observation]) {
    let driven = observations.iter().filter(|o| o.drive.is_some()).count();
    let contradicts = |o: &Observation| o.has_flag(FlagCode::DriveFrequencyContradicts);
    let rows = observations.iter().filter(|o| contradicts(o)).count();
    if rows as f64 > SINGLE_ROWS * driven as f64 {
        return;
    }
    for o in observations.iter_mut().filter(|o| contradicts(o)) {
        let Some((drive, stated_hz)) = o.drive.zip(o.setting.stated_frequency_hz) else {
            continue;
        };
        let problem = Problem::RowOfAnother {
            measured_hz: drive.frequency_hz,
            stated_hz,
        };
        o.flags
            .retain(|f| f.code != FlagCode::DriveFrequencyContradicts);
        o.flags.push(Flag::new(None, problem));
    }
}

/// All records, without checkpoints.
fn observe_all(
    campaign: &ResolvedCampaign,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    observe::observe_in_chunks(
        campaign,
        &BlockCache::none(),
        campaign.records.len(),
        progress,
    )
}

/// The observations with what was found of channels corrected too; the same where nothing was.
fn corrected(
    campaign: &ResolvedCampaign,
    observations: Vec<Observation>,
    found: Vec<LateChannel>,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    if found.is_empty() {
        return Ok(observations);
    }
    let late = LateChannel::together(evidence::late(&observations), found);
    let mut again = observe_all(&campaign.with_late(&late), progress)?;
    for observation in &mut again {
        observation.late.clone_from(&late);
    }
    Ok(again)
}
