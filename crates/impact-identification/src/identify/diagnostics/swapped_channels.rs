//! Whether the velocities of both masses were interchanged: all data are fitted once more as if
//! they were.

use std::sync::Arc;

use crate::identify::diagnostics::suspicion::SURE;
use impact_fit::messages::Finding;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::joint::{self, Weights};
use impact_fit::methods::thinning::every;
use impact_fit::methods::weighing::LEAST_ALLOWANCE;
use impact_fit::parameters::gain_index;
use impact_records::record::Role;

/// Relative difference of two sums of squares that errors of the model may make.
const MODEL_CHANCE: f64 = 0.3;

/// Whether all data fit far better with the velocities of both masses interchanged, by the least
/// cost and the number of residuals of a joint fit with given weights.
pub fn swapped(
    blocks: &Blocks,
    cost: &dyn Fn(&Blocks, &Weights) -> Option<(f64, usize)>,
) -> Option<Finding> {
    let velocities = [Role::VelocityX, Role::VelocityY].map(gain_index);
    if !velocities.into_iter().flatten().all(|i| blocks.sees(i)) {
        return None;
    }
    // What was recorded under the other's name came through its own filter, or the filters too
    // are stated the wrong way round. One after the other: each is a copy of all waveforms.
    let best = |blocks: &Blocks, weights: &Weights| {
        [Filters::OfTheData, Filters::OfTheName]
            .into_iter()
            .filter_map(|filters| cost(&interchanged(blocks, filters)?, weights))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let alone = joint::curve();
    let both = joint::curve_and_waveforms();
    // Often the resonance curve alone, or a few waveforms beside it, speak against it.
    let few = allowed_least(thinned(blocks));
    for (weights, against) in [(&alone, 2.0), (&both, 1.0)] {
        if let (Some((here, _)), Some((there, _))) = (cost(&few, weights), best(&few, weights))
            && there > against * here
        {
            return None;
        }
    }
    let whole = allowed_least(blocks.clone());
    let ((here, freedom), (there, _)) = (cost(&whole, &both)?, best(&whole, &both)?);
    let typical = (there / freedom.max(1) as f64).max(1.0);
    let z_score = ((here - there) / typical).max(0.0).sqrt();
    // Where the model leaves more than noise, chance may favour either by some of it.
    let clearly = 1.0 + MODEL_CHANCE * (1.0 - typical.recip());
    (z_score > SURE && here > clearly * there).then_some(Finding::SwappedChannels { z_score })
}

/// Waveforms, and points of the resonance curve, that are looked at first.
const FEW: usize = 16;
const FEW_POINTS: usize = 64;

/// The blocks with next to nothing allowed beside the noise: an allowance for what the model leaves open
/// would hide what the interchange explains.
fn allowed_least(mut blocks: Blocks) -> Blocks {
    blocks.resonance.allow(LEAST_ALLOWANCE);
    blocks.trajectory.allow(LEAST_ALLOWANCE);
    blocks
}

/// The blocks with a few of the waveforms and of the impactless records, spread over the campaign.
fn thinned(blocks: &Blocks) -> Blocks {
    let records = every(&blocks.trajectory.records, FEW);
    let mut few = blocks.with_trajectory(blocks.trajectory.with_records(records));
    few.resonance.points = every(&blocks.resonance.points, FEW_POINTS);
    few
}

/// Whose filter an interchanged velocity has passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Filters {
    /// That which is stated for the data, wherever they were put.
    OfTheData,
    /// That which is stated for the name they get.
    OfTheName,
}

/// The blocks with the velocities of both masses interchanged; `None` where that changes nothing, or
/// nothing beside what [`Filters::OfTheData`] does.
fn interchanged(blocks: &Blocks, filters: Filters) -> Option<Blocks> {
    let mut other = blocks.clone();
    let mut moved = false;
    // New name and corner of what was recorded under one name, by the corners of all.
    let mut renamed = |stated: &[Passed], (role, own): Passed| {
        let name = match role {
            Role::VelocityX => Role::VelocityY,
            Role::VelocityY => Role::VelocityX,
            other => other,
        };
        let of_name = stated.iter().find(|s| s.0 == name).map_or(own, |s| s.1);
        let (corner_hz, changed) = match filters {
            Filters::OfTheData => (own, name != role),
            Filters::OfTheName => (of_name, of_name != own),
        };
        moved |= changed;
        (name, corner_hz)
    };
    for record in &mut other.trajectory.records {
        let channels = &mut Arc::make_mut(&mut record.folded).channels;
        let stated: Vec<Passed> = channels.iter().map(|c| (c.role, c.high_pass_hz)).collect();
        for channel in channels {
            let now = (channel.role, channel.high_pass_hz);
            (channel.role, channel.high_pass_hz) = renamed(&stated, now);
        }
    }
    for point in &mut other.resonance.points {
        let responses = &mut point.responses;
        let stated: Vec<Passed> = responses.iter().map(|r| (r.role, r.high_pass_hz)).collect();
        for response in responses {
            let (role, corner_hz) = renamed(&stated, (response.role, response.high_pass_hz));
            if corner_hz != response.high_pass_hz {
                *response = response.behind(corner_hz, point.frequency_hz);
            }
            response.role = role;
        }
    }
    other.resonance.allow(LEAST_ALLOWANCE);
    moved.then_some(other)
}

/// A channel and the corner of the high-pass that it has passed, Hz.
type Passed = (Role, Option<f64>);
