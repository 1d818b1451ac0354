//! Whether the velocities of both masses were interchanged: all data are fitted once more as if
//! they were.

use crate::identify::blocks::Blocks;
use crate::identify::joint::Weights;
use crate::identify::suspicion::{SURE, Suspicion};
use crate::identify::weighing::LEAST_ALLOWANCE;
use crate::record::Role;

/// Relative difference of two sums of squares that errors of the model may make.
const MODEL_CHANCE: f64 = 0.3;

/// Whether all data fit far better with the velocities of both masses interchanged, by the least
/// cost and the number of residuals of a joint fit with given weights.
pub fn swapped(
    blocks: &Blocks,
    cost: &dyn Fn(&Blocks, &Weights) -> Option<(f64, usize)>,
) -> Option<Suspicion> {
    // An allowance for what the model leaves open would hide what the interchange explains.
    let mut here = blocks.clone();
    (
        here.resonance.relative_error,
        here.trajectory.relative_error,
    ) = (LEAST_ALLOWANCE, LEAST_ALLOWANCE);
    // What was recorded under the other's name came through its own filter, or the filters too
    // are stated the wrong way round.
    let others: Vec<Blocks> = [Filters::OfTheData, Filters::OfTheName]
        .into_iter()
        .filter_map(|filters| interchanged(&here, filters))
        .collect();
    let best = |weights: &Weights| {
        let costs = others.iter().filter_map(|other| cost(other, weights));
        costs.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    // Often the resonance curve alone speaks against it.
    let alone = [Some(1.0), None, None, None, None];
    if let (Some((here, _)), Some((there, _))) = (cost(&here, &alone), best(&alone))
        && there > 2.0 * here
    {
        return None;
    }
    let both = [Some(1.0), Some(1.0), None, None, None];
    let ((here, freedom), (there, _)) = (cost(&here, &both)?, best(&both)?);
    let typical = (there / freedom.max(1) as f64).max(1.0);
    let z_score = ((here - there) / typical).max(0.0).sqrt();
    // Where the model leaves more than noise, chance may favour either by some of it.
    let clearly = 1.0 + MODEL_CHANCE * (1.0 - typical.recip());
    (z_score > SURE && here > clearly * there).then(|| Suspicion {
        kind: "swapped_channels".into(),
        subject: "velocity_x, velocity_y".into(),
        z_score,
        message: "all data fit far better with the velocities of both masses interchanged: swap \
                  [channels.velocity_x] and [channels.velocity_y], or the displacements"
            .into(),
    })
}

/// Whose filter an interchanged velocity has passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Filters {
    /// That which is stated for the data, wherever they were put.
    OfTheData,
    /// That which is stated for the name they get.
    OfTheName,
}

/// The blocks with the velocities of both masses interchanged; `None` where that changes nothing.
fn interchanged(blocks: &Blocks, filters: Filters) -> Option<Blocks> {
    let mut other = blocks.clone();
    let swap = |role: Role| match role {
        Role::VelocityX => Role::VelocityY,
        Role::VelocityY => Role::VelocityX,
        other => other,
    };
    let mut moved = false;
    for record in &mut other.trajectory.records {
        let stated: Vec<(Role, Option<f64>)> = record
            .folded
            .channels
            .iter()
            .map(|c| (c.role, c.high_pass_hz))
            .collect();
        for channel in &mut record.folded.channels {
            let role = swap(channel.role);
            moved |= role != channel.role;
            channel.role = role;
            if filters == Filters::OfTheName {
                let of_role = stated.iter().find(|s| s.0 == role);
                channel.high_pass_hz = of_role.map_or(channel.high_pass_hz, |s| s.1);
            }
        }
    }
    for point in &mut other.resonance.points {
        let stated: Vec<(Role, Option<f64>)> = point
            .responses
            .iter()
            .map(|r| (r.role, r.high_pass_hz))
            .collect();
        for response in &mut point.responses {
            let role = swap(response.role);
            moved |= role != response.role;
            response.role = role;
            if filters == Filters::OfTheName
                && let Some((_, corner_hz)) = stated.iter().find(|s| s.0 == role)
            {
                *response = response.behind(*corner_hz, point.frequency_hz);
            }
        }
    }
    moved.then_some(other)
}
