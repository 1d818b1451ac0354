//! How much later than the contact, or than the other mass, a channel shows the impacts: each impact makes
//! the velocities of both masses jump while the contact closes, so that the same time between them at all
//! impacts is a delay.

use serde::{Deserialize, Serialize};

use crate::event::contact::Closed;
use crate::event::jumps::JumpSearch;
use crate::event::kinematics::{Kinematics, Series};
use crate::record::Role;
use crate::signal::{robust, whole};

/// How much later than a reference a channel shows the impacts of a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChannelLag {
    /// The channel.
    pub role: Role,
    /// Whether the reference is the contact; else it is the velocity of mass x.
    pub behind_contact: bool,
    /// Mean lag, s; negative where the channel is earlier.
    pub lag_s: f64,
    /// Impacts that it is the mean of.
    pub impacts: usize,
    /// Time that a jump of the channel takes, s.
    pub rise_s: f64,
    /// Time for which the contact is closed in the median impact, s; `None` without a contact.
    pub closed_s: Option<f64>,
    /// Time between the values that were looked at, s.
    pub step_s: f64,
}

/// Share of the usual time between impacts beyond which a jump may belong to the next one.
const NEAREST: f64 = 0.3;
/// Samples within which lags of one delay agree: both instants are known to half a sample.
const AGREE: f64 = 1.5;
/// Share of the impacts whose lags must agree, and the fewest.
const SHARE: f64 = 0.6;
const FEWEST: usize = 3;

/// Rate at which jumps are looked for, Hz: of more samples every second, third … is taken.
const RATE_HZ: f64 = 2000.0;

/// The lags of the velocities of the masses behind the contact or, without one, behind the first.
pub(super) fn channel_lags(
    kinematics: &Kinematics,
    closed: &[Closed],
    width: usize,
) -> Vec<ChannelLag> {
    let stride = whole::index(kinematics.rate_hz / RATE_HZ).max(1);
    let step_s = stride as f64 / kinematics.rate_hz;
    let jumps: Vec<(Role, f64, Vec<f64>)> = kinematics
        .bodies()
        .filter_map(|body| {
            let velocity = body.velocity.as_ref()?;
            let values = velocity.values.iter().step_by(stride).copied();
            let velocity = Series {
                values: values.collect(),
                spread: velocity.spread.div_ceil(stride),
                ..*velocity
            };
            let search = JumpSearch::new(&velocity, width / stride);
            let jumps = search.find();
            let times = jumps.iter().map(|j| j.middle() * step_s).collect();
            let rise = search.gap.saturating_sub(2 * velocity.spread).max(1);
            Some((velocity.role, rise as f64 * step_s, times))
        })
        .collect();
    let time = |samples: f64| samples / kinematics.rate_hz;
    let lasting: Vec<f64> = closed.iter().map(|c| c.samples() as f64).collect();
    let closed_samples = robust::median(&lasting);
    // the contact closes between an open sample and the first closed one; where the masses press for longer,
    // the velocities change in the midst of it
    let usual = closed_samples.unwrap_or(1.0);
    let middle = |c: &Closed| c.first as f64 - 0.5 + 0.5 * (usual.min(c.samples() as f64) - 1.0);
    let pulses: Vec<f64> = closed.iter().map(|c| time(middle(c))).collect();
    let behind_contact = !pulses.is_empty();
    let reference = match jumps.first() {
        _ if behind_contact => pulses,
        Some((_, _, first)) => first.clone(),
        None => return Vec::new(),
    };
    let each = jumps.iter().filter_map(|(role, rise_s, own)| {
        let (lag_s, impacts) = common_lag(own, &reference, step_s)?;
        Some(ChannelLag {
            role: *role,
            behind_contact,
            lag_s,
            impacts,
            rise_s: *rise_s,
            closed_s: closed_samples.map(time),
            step_s,
        })
    });
    each.collect()
}

/// The lag of instants behind others that most of these agree on, and their number; all in s.
fn common_lag(own: &[f64], reference: &[f64], step_s: f64) -> Option<(f64, usize)> {
    let apart: Vec<f64> = reference.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let reach = NEAREST * robust::median(&apart)?;
    let nearest = |at: &f64| {
        let next = own.partition_point(|t| t < at);
        let beside = [next.checked_sub(1), Some(next)];
        let lags = beside.into_iter().flatten().filter_map(|i| own.get(i));
        let lags = lags.map(|t| t - at).filter(|lag| lag.abs() <= reach);
        lags.min_by(|a, b| a.abs().total_cmp(&b.abs()))
    };
    let lags: Vec<f64> = reference.iter().filter_map(nearest).collect();
    let middle = robust::median(&lags)?;
    let agreeing: Vec<f64> = lags
        .into_iter()
        .filter(|lag| (lag - middle).abs() <= AGREE * step_s)
        .collect();
    let enough = (SHARE * reference.len() as f64).max(FEWEST as f64);
    (agreeing.len() as f64 >= enough).then(|| (robust::mean(&agreeing), agreeing.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lag_is_that_on_which_most_impacts_agree() {
        let step_s = 0.5e-3;
        let reference: Vec<f64> = (0..10).map(|i| 0.05 * f64::from(i)).collect();
        let mut own: Vec<f64> = reference.iter().map(|t| t + 1.5e-3).collect();
        own[4] += 10e-3; // beside another jump
        let (lag, impacts) = common_lag(&own, &reference, step_s).expect("a lag");
        assert!((lag - 1.5e-3).abs() < 1e-9);
        assert_eq!(impacts, 9);
        // a lag of a quarter of the time between impacts
        let late: Vec<f64> = reference.iter().map(|t| t + 12.5e-3).collect();
        let (lag, _) = common_lag(&late, &reference, step_s).expect("a lag");
        assert!((lag - 12.5e-3).abs() < 1e-9);
        // no agreement, no lag
        let scattered = |i: u32| 0.05 * f64::from(i) + 0.5e-3 * f64::from(i * i % 13);
        let scattered: Vec<f64> = (0..10).map(scattered).collect();
        assert_eq!(common_lag(&scattered, &reference, step_s), None);
    }
}
