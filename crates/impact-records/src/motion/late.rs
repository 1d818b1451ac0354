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
/// Impactless records from which the phases of a displacement and a velocity tell a delay.
const FEWEST_RECORDS: usize = 3;
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
    let told: Vec<Told> = roles.iter().copied().filter_map(of).collect();
    let steady: Vec<Role> = told.iter().map(|t| t.role).collect();
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
    let mut found: Vec<LateChannel> = late.chain(contact).collect();
    // beside a channel whose delay behind the contact is the same in all records
    if by_contact && !steady.is_empty() {
        found.extend(roles.iter().filter_map(|role| unsteady(*role, &all)));
    }
    let displacements = late_displacements(observations, &found, &steady);
    found.extend(displacements);
    found
}

/// A channel that is at another time behind the contact in each record, as from a recorder of its own.
fn unsteady(role: Role, all: &[(&Observation, &ChannelLag)]) -> Option<LateChannel> {
    let same = all
        .iter()
        .filter(|(_, l)| l.role == role && l.behind_contact);
    let (lags_s, steps_s): (Vec<f64>, Vec<f64>) = same.map(|(_, l)| (l.lag_s, l.step_s)).unzip();
    let apart_s = robust::median_absolute_deviation(&lags_s)?;
    // the impacts of a record agree on one lag within this
    let unlike = apart_s > UNNOTICED * robust::median(&steps_s)?;
    (lags_s.len() >= FEWEST_IMPACTS && unlike).then(|| LateChannel::unsteady(role, apart_s))
}

/// Displacements that are later or earlier than the velocity of the same mass, by their phases at the drive's frequency
/// in impactless records, or at another time in each record beside a velocity that is `steady`; `found`: what is known of
/// the velocities.
fn late_displacements(
    observations: &[Observation],
    found: &[LateChannel],
    steady: &[Role],
) -> Vec<LateChannel> {
    let pairs = [
        (Role::DisplacementX, Role::VelocityX),
        (Role::DisplacementY, Role::VelocityY),
    ];
    let of = |(displacement, velocity): (Role, Role)| {
        // what is known of a filter is in the phases already
        let usable = observations.iter().filter(|o| !o.excluded() && !o.low_pass);
        let mut lags: Vec<Lag> = usable
            .filter_map(|o| lag(o, displacement, velocity))
            .collect();
        let step_s = robust::median(&of_each(&lags, |lag| lag.rate_hz))?.recip();
        let lags_s = of_each(&lags, |lag| lag.behind_s);
        let behind_s = robust::median(&lags_s)?;
        let apart_s = robust::median_absolute_deviation(&lags_s)?;
        if lags.len() < FEWEST_RECORDS {
            return None;
        }
        if apart_s > ALIKE * step_s {
            // what goes with the frequency, as behind a high-pass, is no scatter
            let own_s = neighbours_apart_s(&mut lags)?;
            let unsteady = own_s > UNNOTICED * step_s && steady.contains(&velocity);
            return unsteady.then(|| LateChannel::unsteady(displacement, own_s));
        }
        let of_velocity = found.iter().find(|late| late.role == velocity);
        let filtered = of_velocity.is_some_and(|late| late.low_pass.is_some());
        let delay_s = behind_s + of_velocity.map_or(0.0, |late| late.delay_s);
        let noticed = delay_s.abs() > UNNOTICED * step_s;
        (noticed && !filtered).then(|| LateChannel::by(displacement, delay_s))
    };
    pairs.into_iter().filter_map(of).collect()
}

/// By how much a channel is behind another in an impactless record.
struct Lag {
    behind_s: f64,
    frequency_hz: f64,
    rate_hz: f64,
}

fn lag(o: &Observation, channel: Role, reference: Role) -> Option<Lag> {
    Some(Lag {
        behind_s: o.lag_s(channel, reference)?,
        frequency_hz: o.frequency_hz()?,
        rate_hz: o.sample_rate_hz,
    })
}

fn of_each(lags: &[Lag], value: impl Fn(&Lag) -> f64) -> Vec<f64> {
    lags.iter().map(value).collect()
}

/// By how much lags differ from those of neighbours in frequency, s.
fn neighbours_apart_s(lags: &mut [Lag]) -> Option<f64> {
    lags.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let between = lags.iter().zip(lags.iter().skip(1));
    let between_s: Vec<f64> = between.map(|(a, b)| b.behind_s - a.behind_s).collect();
    robust::apart_from_neighbours(&between_s)
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
    let lags_s: Vec<f64> = lags.iter().map(|(_, l)| l.lag_s).collect();
    let lag_s = robust::median(&lags_s)?;
    let step_s = median(&|(_, l)| l.step_s)?;
    let apart_s = robust::median_absolute_deviation(&lags_s)?;
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
    use crate::event::DriveTone;
    use crate::motion::{Motion, Response};

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
    fn a_channel_at_another_time_in_each_record_is_told_beside_one_that_is_not() {
        let observed = |y_ms: &dyn Fn(u32) -> f64, x_ms: &dyn Fn(u32) -> f64| {
            let one = |i: u32| observed([x_ms(i), y_ms(i)], true).swap_remove(0);
            late_channels(&(0..12).map(one).collect::<Vec<_>>())
        };
        let own = |i: u32| 1.7 * f64::from(i * 5 % 12);
        let found = observed(&own, &|_| 0.0);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].role, Role::VelocityY);
        assert!((found[0].unsteady_s.expect("a scatter") - 5.1e-3).abs() < 1e-9);
        // of both it may be the contact
        assert_eq!(observed(&own, &own), []);
        // within what impacts of one lag differ
        assert_eq!(observed(&|i| 0.1 * f64::from(i % 3), &|_| 0.0), []);
    }

    #[test]
    fn a_displacement_is_late_against_the_velocity_of_the_same_mass() {
        // a velocity of 1 in phase with the drive, and its displacement, late by `late_s`, or behind a high-pass
        let observed = |late_s: f64, high_pass_hz: f64| {
            [10.0, 12.0, 14.0, 20.0].map(|frequency_hz| {
                let rate = std::f64::consts::TAU * frequency_hz;
                let turned = -0.5 * std::f64::consts::PI - rate * late_s
                    + (high_pass_hz / frequency_hz).atan();
                let response = |role, amplitude: f64, turned: f64| Response {
                    role,
                    real: amplitude * turned.cos(),
                    imaginary: amplitude * turned.sin(),
                    error: 0.0,
                    residual_rms: 0.0,
                    high_pass_hz: None,
                };
                let mut o = Observation::of("r", frequency_hz, Motion::Impactless);
                o.drive = Some(DriveTone::at(frequency_hz, 1.0));
                o.response = vec![
                    response(Role::VelocityX, 1.0, 0.0),
                    response(Role::DisplacementX, 1.0 / rate, turned),
                ];
                o
            })
        };
        let step_s = observed(0.0, 0.0)[0].sample_rate_hz.recip();
        for samples in [-4.0, 0.0, 1.0, 4.0] {
            let late = late_channels(&observed(samples * step_s, 0.0));
            if samples.abs() < UNNOTICED {
                assert_eq!(late, []);
            } else {
                assert_eq!(late.len(), 1);
                assert_eq!(late[0].role, Role::DisplacementX);
                assert!((late[0].delay_s - samples * step_s).abs() < 1e-9);
            }
        }
        // the lag of a high-pass falls with the frequency
        assert_eq!(late_channels(&observed(0.0, 4.0)), []);
        // the velocity is late as well: the contact tells that
        let known = [LateChannel::by(Role::VelocityX, 4.0 * step_s)];
        assert_eq!(
            late_displacements(&observed(-4.0 * step_s, 0.0), &known, &[]),
            []
        );
        // at another time in each record, beside a velocity that is not
        let mut each = observed(0.0, 0.0).to_vec();
        for (o, samples) in each.iter_mut().zip([6.0, -4.0, 5.0, -6.0]) {
            let turn =
                -std::f64::consts::TAU * o.frequency_hz().expect("a drive") * samples * step_s;
            let displacement = &mut o.response[1];
            *displacement = displacement.times(nalgebra::Complex::from_polar(1.0, turn));
        }
        assert_eq!(late_displacements(&each, &[], &[]), []);
        let found = late_displacements(&each, &[], &[Role::VelocityX]);
        assert_eq!(found.len(), 1);
        assert!(
            found[0]
                .unsteady_s
                .is_some_and(|apart_s| apart_s > 4.0 * step_s)
        );
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
