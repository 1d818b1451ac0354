//! All records of a campaign as observed, and the boundaries that they bracket.

use std::path::Path;

use super::block_cache::BlockCache;
use super::checkpoint;
use super::error::{PipelineError, Progress, RefusedRecord};
use super::evidence;
use super::observe;
use crate::campaign::resolved::ResolvedCampaign;
use impact_fit::evidence::Evidence;
use impact_fit::methods::resonance::late_drive::late_drive;
use impact_records::motion::{
    Bracket, LateChannel, Observation, brackets, late_channels, scale_drives,
};
use impact_records::record::Role;
use labfiles::output::OutputError;

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
        let kept = BlockCache::none();
        let whole = campaign.records.len();
        let observations = observe::observe_in_chunks(campaign, &kept, whole, progress)?;
        Self::from_observations(campaign, observations, progress)
    }

    /// Observe all records of a campaign with checkpoints in `out`; with `resume` those of an
    /// interrupted run are used.
    ///
    /// # Errors
    /// As [`Observed::of`], and if a checkpoint cannot be written.
    pub(super) fn resumable(
        campaign: &ResolvedCampaign,
        (out, resume): (&Path, bool),
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
    /// channels are late.
    ///
    /// # Errors
    /// [`PipelineError::NothingUsable`] where no record can be used.
    pub(super) fn from_observations(
        campaign: &ResolvedCampaign,
        observations: Vec<Observation>,
        progress: Progress<'_>,
    ) -> Result<Self, PipelineError> {
        let mut observations = aligned(campaign, observations, progress)?;
        scale_drives(&mut observations);
        if observations.iter().all(Observation::excluded) {
            let refused = observations.into_iter().zip(&campaign.records);
            let refused = refused.map(|(o, entry)| RefusedRecord {
                file: entry.file.clone(),
                record: o.record,
                flags: o.flags,
            });
            return Err(PipelineError::NothingUsable(refused.collect()));
        }
        Ok(Self::bracketed(observations))
    }

    /// Observations whose drives are scaled, with the brackets in them.
    pub(super) fn bracketed(observations: Vec<Observation>) -> Self {
        Self {
            brackets: brackets(&observations),
            observations,
        }
    }
}

/// The observations; made again where they show that channels are later than stated, with what these show
/// moved back: channels beside each other by their impacts, then the drive's by the phases of the motion.
fn aligned(
    campaign: &ResolvedCampaign,
    observations: Vec<Observation>,
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let mut late = late_channels(&observations);
    let mut observations = observations;
    if !late.is_empty() {
        observations = observed_again(campaign, &late, progress)?;
    }
    scale_drives(&mut observations);
    let Some(delay_s) = late_drive(&evidence::evidence(campaign, &observations, &[])) else {
        return Ok(observations);
    };
    late.push(LateChannel::by(Role::Drive, delay_s));
    observed_again(campaign, &late, progress)
}

/// The observations with what late channels show moved back.
fn observed_again(
    campaign: &ResolvedCampaign,
    late: &[LateChannel],
    progress: Progress<'_>,
) -> Result<Vec<Observation>, OutputError> {
    let (campaign, kept) = (campaign.with_late(late), BlockCache::none());
    let whole = campaign.records.len();
    let mut again = observe::observe_in_chunks(&campaign, &kept, whole, progress)?;
    for observation in &mut again {
        observation.late = late.to_vec();
    }
    Ok(again)
}
