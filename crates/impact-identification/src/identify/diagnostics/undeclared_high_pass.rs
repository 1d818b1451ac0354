//! Whether channels have passed a high-pass that is not stated: the resonance curve and some waveforms are fitted once
//! more as if one of them had, then another one beside it, or all of them, as long as that explains far more.

use crate::identify::diagnostics::suspicion::SURE;
use impact_fit::messages::Finding;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::weighing::LEAST_ALLOWANCE;
use impact_fit::parameters::gain_index;
use impact_fit::solver::Fit;
use impact_records::record::Role;
use std::sync::Arc;

/// Standard uncertainty of the corners' logarithms in these fits.
pub const WIDE: f64 = 1.5;
/// Points of the resonance curve that are looked at.
const FEW: usize = 64;
/// Waveforms that are looked at.
const RECORDS: usize = 12;
/// Lowest frequency of the drive over the corner from which a fit starts.
const BELOW: f64 = 20.0;
/// The same over a corner that is found, at most: a lower one turns phases by less than 0.001 rad, so that what the fit
/// gains by it has another cause.
const FURTHEST_BELOW: f64 = 1e3;
/// Least ratio of the sums of squares without and with the high-pass: errors of the model may make less.
const CLEARLY: f64 = 1.5;

/// The channels without a stated high-pass of which resonance curve and waveforms show one, by the least cost of a fit
/// `fit` in which corners are [`WIDE`] open; none where what channels pick up of the drive, which `picking_up` fits, explains
/// down to the noise.
pub fn undeclared(
    blocks: &Blocks,
    fit: &dyn Fn(&Blocks) -> Option<Fit>,
    picking_up: &dyn Fn(&Blocks) -> Option<Fit>,
) -> Vec<Finding> {
    let mut now = blocks.with_trajectory(blocks.trajectory.few(RECORDS));
    now.resonance = blocks.resonance.few(FEW);
    // what a high-pass makes of a record is no error of its own
    for point in &mut now.resonance.points {
        point.own_relative_error = 0.0;
    }
    now.resonance.allow(LEAST_ALLOWANCE);
    let of_curve = now.resonance.points.iter().map(|p| p.frequency_hz);
    let of_records = now.trajectory.records.iter().map(|r| r.frequency_hz);
    let frequencies = of_curve.chain(of_records);
    let start_hz = frequencies.fold(f64::INFINITY, f64::min) / BELOW;
    if unstated(&now).is_empty() {
        return Vec::new();
    }
    let Some(mut here) = fit(&now) else {
        return Vec::new();
    };
    let stated = now.clone();
    let mut found: Vec<(Role, f64)> = Vec::new();
    while let Some(step) = step(&now, &here, start_hz, fit) {
        found.extend(step.roles.iter().map(|role| (*role, step.z_score)));
        (here, now) = (step.fit, step.blocks);
    }
    // what was taken before others were found may not be needed beside these
    for (channel, _) in found.clone() {
        let others = found.iter().map(|(role, _)| *role);
        let others: Vec<Role> = others.filter(|role| *role != channel).collect();
        let without = (!others.is_empty()).then(|| fit(&behind(&stated, &others, start_hz)));
        if let Some(without) = without.flatten().filter(|other| !explains(other, &here)) {
            found.retain(|(role, _)| *role != channel);
            here = without;
        }
    }
    // a high-pass of several channels is explained by a pick-up of one as little as by a high-pass of one
    let picked_up = |other: Fit| {
        let noise = CLEARLY * other.residuals as f64;
        other.cost <= noise && CLEARLY * other.cost <= here.cost
    };
    if !found.is_empty() && picking_up(&stated).is_some_and(picked_up) {
        return Vec::new();
    }
    let found = found.into_iter();
    let found = found.map(|(channel, z_score)| Finding::UndeclaredHighPass {
        channel,
        corner_hz: start_hz * here.parameters.corner(channel),
        z_score,
    });
    found.collect()
}

/// Channels of which a high-pass is found, and the fit with it.
struct Step {
    roles: Vec<Role>,
    z_score: f64,
    fit: Fit,
    blocks: Blocks,
}

/// The next channel of which a high-pass explains far more, or all together: two masses whose channels turn phases
/// alike are fitted by another natural frequency as well as one of them can be.
fn step(
    now: &Blocks,
    here: &Fit,
    start_hz: f64,
    fit: &dyn Fn(&Blocks) -> Option<Fit>,
) -> Option<Step> {
    let roles = unstated(now);
    let tried = |roles: Vec<Role>| {
        let blocks = behind(now, &roles, start_hz);
        let fit = fit(&blocks)?;
        Some(Step {
            roles,
            z_score: z_score(here, &fit),
            fit,
            blocks,
        })
    };
    let is_told = |step: &Step| {
        let mut corners = step
            .roles
            .iter()
            .map(|role| step.fit.parameters.corner(*role));
        explains(here, &step.fit) && corners.all(|corner| BELOW / corner <= FURTHEST_BELOW)
    };
    let alone = roles.iter().filter_map(|role| tried(vec![*role]));
    let best = alone.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
    let together = || tried(roles.clone()).filter(|_| roles.len() > 1);
    best.filter(is_told).or_else(|| together().filter(is_told))
}

/// Standard deviations by which a fit with a high-pass more is better than one without it.
fn z_score(without: &Fit, with: &Fit) -> f64 {
    let typical = (with.cost / with.residuals.max(1) as f64).max(1.0);
    ((without.cost - with.cost) / typical).max(0.0).sqrt()
}

/// Whether a high-pass more explains far more than a fit without it does.
fn explains(without: &Fit, with: &Fit) -> bool {
    let clearly = without.cost >= CLEARLY * with.cost || leaves_noise(with);
    z_score(without, with) > SURE && clearly
}

/// Whether a fit leaves nothing beside the noise, so that no error of the model is in what it gained.
fn leaves_noise(fit: &Fit) -> bool {
    fit.cost <= fit.residuals as f64
}

/// The channels that no high-pass is stated of.
fn unstated(blocks: &Blocks) -> Vec<Role> {
    let channels = blocks
        .resonance
        .channels()
        .chain(blocks.trajectory.channels());
    let without =
        channels.filter(|(role, corner_hz)| corner_hz.is_none() && gain_index(*role).is_some());
    let mut roles: Vec<Role> = without.map(|(role, _)| role).collect();
    roles.sort_unstable();
    roles.dedup();
    roles
}

/// As if channels had passed a high-pass.
fn behind(blocks: &Blocks, roles: &[Role], corner_hz: f64) -> Blocks {
    let mut other = blocks.clone();
    for point in &mut other.resonance.points {
        for response in point
            .responses
            .iter_mut()
            .filter(|r| roles.contains(&r.role))
        {
            *response = response.behind(Some(corner_hz), point.frequency_hz);
        }
    }
    for record in &mut other.trajectory.records {
        record.reduced = None;
        let folded = Arc::make_mut(&mut record.folded);
        for channel in folded
            .channels
            .iter_mut()
            .filter(|c| roles.contains(&c.role))
        {
            channel.high_pass_hz = Some(corner_hz);
        }
    }
    other.resonance.allow(LEAST_ALLOWANCE);
    other
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::run::identify;
    use impact_fit::fixture::{evidence, observed, recorded};
    use impact_records::record::Record;

    const CORNER_HZ: f64 = 0.5;

    /// A record without displacements of which both velocities have passed a high-pass of the first order, not stated.
    fn passed(mut record: Record) -> Record {
        let kept = (-std::f64::consts::TAU * CORNER_HZ / record.sample_rate_hz).exp();
        let displacements = [Role::DisplacementX, Role::DisplacementY];
        record.channels.retain(|c| !displacements.contains(&c.role));
        let motion = record.channels.iter_mut().filter(|c| c.role.is_motion());
        for channel in motion {
            if channel.high_pass_hz.take().is_none() {
                let (mut before, mut out) = (channel.values[0], 0.0);
                for value in &mut channel.values {
                    out = kept * out + 0.5 * (1.0 + kept) * (*value - before);
                    (before, *value) = (*value, out);
                }
            }
        }
        record
    }

    #[test]
    fn valid_a_high_pass_of_all_channels_is_found_although_the_resonance_curve_does_not_tell_it() {
        let records = recorded(0.75, 12.0, 40, 4).into_iter().map(passed);
        let observations = observed(&records.collect::<Vec<_>>());
        let found = identify(&evidence(&observations)).suspicions;
        let corners = found.iter().filter_map(|finding| match finding {
            Finding::UndeclaredHighPass {
                channel, corner_hz, ..
            } => Some((*channel, *corner_hz)),
            _ => None,
        });
        let corners: Vec<(Role, f64)> = corners.collect();
        let velocities = corners.iter().map(|(channel, _)| *channel);
        assert_eq!(
            Vec::from_iter(velocities),
            [Role::VelocityX, Role::VelocityY],
            "{found:?}"
        );
        for (channel, corner_hz) in corners {
            // this filter starts with each record, and is not settled as a laboratory's is
            assert!(
                (corner_hz / CORNER_HZ - 1.0).abs() < 0.15,
                "{channel:?}: {corner_hz}"
            );
        }
    }
}
