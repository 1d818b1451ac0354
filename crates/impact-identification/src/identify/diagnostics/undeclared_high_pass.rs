//! Whether channels have passed a high-pass that is not stated: the resonance curve is fitted once more as if
//! one of them had, then another one beside it, as long as that explains far more.

use crate::identify::diagnostics::suspicion::SURE;
use impact_fit::messages::Finding;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::weighing::LEAST_ALLOWANCE;
use impact_fit::parameters::gain_index;
use impact_fit::solver::Fit;
use impact_records::record::Role;

/// Standard uncertainty of the corners' logarithms in these fits.
pub const WIDE: f64 = 1.5;
/// Points of the resonance curve that are looked at.
const FEW: usize = 64;
/// Lowest frequency of the drive over the corner from which a fit starts.
const BELOW: f64 = 20.0;
/// The same over a corner that is found, at most: a lower one turns phases by less than 0.001 rad, so that what the fit
/// gains by it has another cause.
const FURTHEST_BELOW: f64 = 1e3;
/// Least ratio of the sums of squares without and with the high-pass: errors of the model may make less.
const CLEARLY: f64 = 1.5;

/// The channels without a stated high-pass of which the resonance curve shows one, by the least cost of a fit
/// of it in which corners are [`WIDE`] open.
pub fn undeclared(blocks: &Blocks, fit: &dyn Fn(&Blocks) -> Option<Fit>) -> Vec<Finding> {
    let mut now = blocks.with_trajectory(blocks.trajectory.with_records(Vec::new()));
    now.resonance = blocks.resonance.few(FEW);
    // what a high-pass makes of a record is no error of its own
    for point in &mut now.resonance.points {
        point.own_relative_error = 0.0;
    }
    now.resonance.allow(LEAST_ALLOWANCE);
    let frequencies = now.resonance.points.iter().map(|p| p.frequency_hz);
    let start_hz = frequencies.fold(f64::INFINITY, f64::min) / BELOW;
    let Some(mut here) = fit(&now) else {
        return Vec::new();
    };
    let mut z_scores: Vec<(Role, f64)> = Vec::new();
    loop {
        let tried = unstated(&now).into_iter().filter_map(|role| {
            let other = behind(&now, role, start_hz);
            Some((role, fit(&other)?, other))
        });
        let best = tried.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let Some((role, there, other)) = best else {
            break;
        };
        let typical = (there.cost / there.residuals.max(1) as f64).max(1.0);
        let z_score = ((here.cost - there.cost) / typical).max(0.0).sqrt();
        let without_effect = BELOW / there.parameters.corner(role) > FURTHEST_BELOW;
        if z_score <= SURE || here.cost < CLEARLY * there.cost || without_effect {
            break;
        }
        z_scores.push((role, z_score));
        (here, now) = (there, other);
    }
    let found = z_scores.into_iter();
    let found = found.map(|(channel, z_score)| Finding::UndeclaredHighPass {
        channel,
        corner_hz: start_hz * here.parameters.corner(channel),
        z_score,
    });
    found.collect()
}

/// The channels of the resonance curve that no high-pass is stated of.
fn unstated(blocks: &Blocks) -> Vec<Role> {
    let responses = blocks.resonance.points.iter().flat_map(|p| &p.responses);
    let without = responses.filter(|r| r.high_pass_hz.is_none() && gain_index(r.role).is_some());
    let mut roles: Vec<Role> = without.map(|r| r.role).collect();
    roles.sort_unstable();
    roles.dedup();
    roles
}

/// As if a channel had passed a high-pass.
fn behind(blocks: &Blocks, role: Role, corner_hz: f64) -> Blocks {
    let mut other = blocks.clone();
    for point in &mut other.resonance.points {
        for response in point.responses.iter_mut().filter(|r| r.role == role) {
            *response = response.behind(Some(corner_hz), point.frequency_hz);
        }
    }
    other.resonance.allow(LEAST_ALLOWANCE);
    other
}
