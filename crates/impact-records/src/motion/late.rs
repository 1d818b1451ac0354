//! Channels of a campaign that show all impacts later than the contact and the other channels do.

use super::late_channel::LateChannel;
use super::observation::Observation;
use crate::event::ChannelLag;
use crate::record::{LowPass, Role};
use crate::signal::robust;

/// Samples of delay that the detection of impacts does not notice: a jump may take two.
const UNNOTICED: f64 = 1.5;
/// Impacts from which a delay is told.
const FEWEST_IMPACTS: usize = 8;
/// Greatest median difference of the records' lags from their median, in the steps in which they are found.
const ALIKE: f64 = 0.75;
/// Steps beyond which a jump takes time: an instant takes one, or two where readings are averaged or shifted
/// by less than a sample; a differentiated displacement shows one more.
const TAKES_TIME: f64 = 2.5;
const DIFFERENTIATED: f64 = 1.0;
/// Time that a jump takes behind a low-pass, in steps of more than a twentieth of it, over the period of its
/// corner: 0.59 (second order) and 0.71 in simulated campaigns at 2 kHz with a corner of 200 Hz.
const RISE: f64 = 0.65;
/// Poles that a low-pass is taken to have whose jumps tell its corner.
const ORDER: u32 = 2;
/// Share of a jump that one step of it has at least.
const LEAST_STEP: f64 = 0.05;

/// What the records tell of one channel.
struct Told {
    role: Role,
    lag_s: f64,
    low_pass: Option<LowPass>,
    /// By how much the time of a jump is uncertain, s: the step in which it was found, and behind a stated
    /// low-pass half of what a jump takes.
    uncertain_s: f64,
}

/// The channels that are later than the earliest of all, of which the contact is one, by more than the
/// detection of impacts bears, or whose jumps take longer than the contact is closed; one that is earlier than the
/// contact and another, which agree; and the contact, where it is later than all others.
pub fn late_channels(observations: &[Observation]) -> Vec<LateChannel> {
    let usable = observations.iter().filter(|o| !o.excluded());
    let all: Vec<(&Observation, &ChannelLag)> = usable
        .flat_map(|o| o.lags.iter().map(move |lag| (o, lag)))
        .collect();
    let behind_contact = all.iter().filter(|(_, lag)| lag.behind_contact).count();
    let by_contact = 2 * behind_contact > all.len();
    let mut roles: Vec<Role> = all.iter().map(|(_, lag)| lag.role).collect();
    roles.sort_unstable();
    roles.dedup();
    let of = |role: Role| {
        let same = all.iter().copied();
        let same = same.filter(|(_, l)| l.role == role && l.behind_contact == by_contact);
        told(role, &same.collect::<Vec<_>>())
    };
    let told: Vec<Told> = roles.into_iter().filter_map(of).collect();
    let reference_s = if by_contact {
        beside_contact(&told)
    } else {
        earliest(&told)
    };
    let late = told.into_iter().filter_map(|t| {
        let late_s = t.lag_s - reference_s;
        let noticed = late_s.abs() > UNNOTICED * t.uncertain_s;
        let delay_s = match t.low_pass {
            // without a contact nothing tells the delay of what all channels have passed
            Some(filter) if by_contact => late_s - filter.delay_s(),
            _ => late_s,
        };
        (noticed || t.low_pass.is_some()).then(|| LateChannel {
            low_pass: t.low_pass,
            ..LateChannel::by(t.role, delay_s)
        })
    });
    // all are earlier than the contact
    let by_s = -reference_s;
    let contact = (by_contact && by_s > 0.0).then(|| LateChannel::by(Role::Contact, by_s));
    late.chain(contact).collect()
}

/// The lag of the earliest channel.
fn earliest(told: &[Told]) -> f64 {
    told.iter().map(|t| t.lag_s).fold(f64::INFINITY, f64::min)
}

/// The lag that channels on time have behind the contact: none, unless all that are told are earlier, so that the contact is
/// the late one.
fn beside_contact(told: &[Told]) -> f64 {
    let on_time = |t: &Told| t.lag_s.abs() <= UNNOTICED * t.uncertain_s;
    if told.iter().any(on_time) {
        0.0
    } else {
        earliest(told).min(0.0)
    }
}

/// The corner of a low-pass of one pole, Hz, behind which jumps take as long as behind one of more poles whose corner
/// they show, where they were looked at in steps of `step_s`.
///
/// Behind one pole of the time constant τ a jump's step from t on is e^(−t/τ)(1 − e^(−s/τ)) of it, so that the jump takes
/// τ ln((1 − e^(−s/τ))/0.05).
pub fn one_pole_hz(shown_hz: f64, step_s: f64) -> f64 {
    let rise = RISE / shown_hz / step_s;
    let takes = |constant: f64| -constant * (LEAST_STEP / -(-constant.recip()).exp_m1()).ln();
    // slower jumps than those of 7 steps have none of a twentieth
    let (mut low, mut high) = (0.1, 7.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if takes(middle) < rise {
            low = middle;
        } else {
            high = middle;
        }
    }
    (std::f64::consts::TAU * low * step_s).recip()
}

/// What records tell of a channel, if they are enough and agree.
fn told(role: Role, lags: &[(&Observation, &ChannelLag)]) -> Option<Told> {
    let median = |of: &dyn Fn(&(&Observation, &ChannelLag)) -> f64| {
        robust::median(&lags.iter().map(of).collect::<Vec<f64>>())
    };
    let lag_s = median(&|(_, l)| l.lag_s)?;
    let step_s = median(&|(_, l)| l.step_s)?;
    let apart_s = median(&|(_, l)| (l.lag_s - lag_s).abs())?;
    let impacts: usize = lags.iter().map(|(_, l)| l.impacts).sum();
    if impacts < FEWEST_IMPACTS || apart_s > ALIKE * step_s {
        return None;
    }
    let measured = matches!(role, Role::VelocityX | Role::VelocityY);
    let instant = if measured { 0.0 } else { DIFFERENTIATED } * step_s;
    let rise_s = median(&|(_, l)| l.rise_s)? - instant;
    let closed_s = median(&|(_, l)| l.closed_s.unwrap_or(0.0))?;
    let known = lags.iter().any(|(o, _)| o.low_pass);
    let smeared = rise_s > closed_s + UNNOTICED * step_s && rise_s > TAKES_TIME * step_s;
    Some(Told {
        role,
        lag_s,
        low_pass: (smeared && !known).then(|| LowPass {
            corner_hz: RISE / rise_s,
            order: ORDER,
        }),
        uncertain_s: if known {
            step_s.max(0.5 * rise_s)
        } else {
            step_s
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;

    fn observed(lags_ms: [f64; 2], behind_contact: bool) -> Vec<Observation> {
        let [x, y] = lags_ms;
        let lag = |role, ms: f64| ChannelLag {
            role,
            behind_contact,
            lag_s: 1e-3 * ms,
            impacts: 5,
            rise_s: 0.5e-3,
            closed_s: behind_contact.then_some(0.5e-3),
            step_s: 0.5e-3,
        };
        let one = |_| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.lags = vec![lag(Role::VelocityX, x), lag(Role::VelocityY, y)];
            o
        };
        (0..4).map(one).collect()
    }

    #[test]
    fn a_channel_is_late_against_the_earliest_of_all() {
        let late = |lags, contact| late_channels(&observed(lags, contact));
        let x = |delay_s| LateChannel::by(Role::VelocityX, delay_s);
        assert_eq!(late([1.5, 0.1], true), [x(1.5e-3)]);
        // both behind the contact, within what the detection bears
        assert_eq!(late([0.5, 0.4], true), []);
        // the contact is the late one
        let contact = LateChannel::by(Role::Contact, 2e-3);
        assert_eq!(late([-2.0, -2.0], true), [contact]);
        // x is early: the contact and y agree
        assert_eq!(late([-3.0, 0.1], true), [x(-3e-3)]);
        // without a contact: y behind x
        let [y] = late([0.0, 1.5], false)[..] else {
            panic!("one channel is late");
        };
        assert_eq!(y.role, Role::VelocityY);
    }

    #[test]
    fn valid_a_jump_behind_one_pole_of_200_hz_tells_that() {
        let (step_s, time_s) = (0.5e-3, 1.0 / (std::f64::consts::TAU * 200.0));
        let shown = |k: i32| 1.0 - (-f64::from(k) * step_s / time_s).exp();
        let rise = (0..100)
            .take_while(|k| shown(k + 1) - shown(*k) > LEAST_STEP)
            .count();
        // whole steps tell the corner as well as they tell the time
        let corner = |rise: f64| one_pole_hz(RISE / (rise * step_s), step_s);
        let rise = rise as f64;
        assert!(corner(rise - 1.0) > 200.0 && 200.0 > corner(rise), "{rise}");
    }

    #[test]
    fn jumps_that_take_longer_than_the_contact_is_closed_are_those_of_a_low_pass() {
        let mut observations = observed([1.2, 1.2], true);
        let lags = observations.iter_mut().flat_map(|o| &mut o.lags);
        lags.for_each(|lag| lag.rise_s = 3.25e-3);
        let late = late_channels(&observations);
        assert_eq!(late.len(), 2);
        let filter = late[0].low_pass.expect("a low-pass");
        assert!((filter.corner_hz - 200.0).abs() < 1e-9);
        assert!((late[0].delay_s - (1.2e-3 - filter.delay_s())).abs() < 1e-12);
        // a contact that is closed as long, and a low-pass that is stated
        let lags = observations.iter_mut().flat_map(|o| &mut o.lags);
        lags.for_each(|lag| lag.closed_s = Some(3.25e-3));
        assert!(
            late_channels(&observations)
                .iter()
                .all(|l| l.low_pass.is_none())
        );
    }
}
