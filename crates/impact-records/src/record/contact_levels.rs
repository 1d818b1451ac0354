//! What the level and the sign of a contact's channel are worth: a threshold within the channel's own noise tells
//! nothing, and masses that move against each other do not touch all the while.

use super::{Channel, Flag, Problem, Record, Role};
use crate::signal::{columns, robust};

/// Noise deviations from the level at rest up to which a threshold is crossed by noise alone.
const IN_NOISE: f64 = 4.0;
/// Noise deviations that closing must lift the channel by for a threshold to be put halfway.
const LIFTS: f64 = 12.0;
/// Share of a record from which a contact is closed most of the time.
const MOSTLY: f64 = 0.5;
/// Noise deviations of a motion's own scatter from which it moves.
const MOVES: f64 = 5.0;
/// Least scatter of the motion while the contact is closed, over that while it is open, of masses that do not rest
/// against each other.
const ALIKE: f64 = 0.3;
/// Fewest samples of which a scatter is known.
const FEWEST: usize = 8;

/// Put aside a threshold that is within the noise, with the whole channel where no level tells open from closed, and
/// turn around a channel that is closed most of the time while the masses move: it opens at their impacts.
pub(super) fn settle(record: &mut Record) {
    let moves = |r: Role| r.is_motion();
    if !record.channels.iter().any(|c| moves(c.role)) {
        return;
    }
    let flags = [beside_noise(record), turned_around(record)];
    record.flags.extend(flags.into_iter().flatten());
}

fn contact(record: &mut Record) -> Option<&mut Channel> {
    let mut channels = record.channels.iter_mut();
    channels.find(|c| c.role == Role::Contact)
}

/// A level halfway in place of one within the noise; without one the channel is left out.
fn beside_noise(record: &mut Record) -> Option<Flag> {
    let channel = contact(record)?;
    let threshold = channel.threshold?;
    let noise = robust::noise_deviation(&channel.values);
    let rest = robust::median(&channel.values)?;
    if !((threshold - rest).abs() < IN_NOISE * noise) {
        return None;
    }
    let (low, high) = columns::extremes(&channel.values);
    let lifts = high - low > LIFTS * noise;
    let (name, dimension) = (channel.name.clone(), channel.dimension);
    channel.threshold = lifts.then_some(f64::midpoint(low, high));
    if !lifts {
        record.channels.retain(|c| c.role != Role::Contact);
    }
    let problem = Problem::ThresholdWithinNoise {
        threshold,
        rest,
        noise,
        dimension,
    };
    Some(Flag::new(Some(&name), problem).excluding(false))
}

/// A normally closed contact, turned around about its threshold.
fn turned_around(record: &mut Record) -> Option<Flag> {
    let channel = record.channel(Role::Contact)?;
    let level = channel.threshold?;
    let closed = |v: &f64| if level >= 0.0 { *v > level } else { *v < level };
    let closed: Vec<bool> = channel.values.iter().map(closed).collect();
    let share = closed.iter().filter(|c| **c).count() as f64 / closed.len().max(1) as f64;
    if share <= MOSTLY || !moves_while_closed(&motion_together(record)?, &closed) {
        return None;
    }
    let channel = contact(record)?;
    let values = channel.values.iter_mut();
    values.for_each(|v| *v = 2.0 * level - *v);
    let flag = Flag::new(Some(&channel.name), Problem::ContactOpens { share });
    Some(flag.excluding(false))
}

/// The motion of the masses against each other, of the first quantity that was measured.
fn motion_together(record: &Record) -> Option<Vec<f64>> {
    let of = |roles: &[Role; 2]| {
        let mut measured = roles.iter().filter_map(|r| record.values(*r));
        let first = measured.next()?.to_vec();
        let Some(second) = measured.next() else {
            return Some(first);
        };
        Some(first.iter().zip(second).map(|(a, b)| a + b).collect())
    };
    Role::OF_BOTH.iter().find_map(of)
}

/// Whether a motion scatters while the contact is closed as it does while it is open. Masses that touch rest.
fn moves_while_closed(motion: &[f64], closed: &[bool]) -> bool {
    let scatter = |of: bool| {
        let samples = motion.iter().zip(closed);
        let samples = samples.filter(|(_, c)| **c == of).map(|(v, _)| *v);
        let samples: Vec<f64> = samples.collect();
        (samples.len() >= FEWEST).then(|| robust::robust_deviation(&samples))?
    };
    let noise = robust::noise_deviation(motion);
    let Some(while_closed) = scatter(true) else {
        return false;
    };
    let alike = scatter(false).is_none_or(|open| while_closed > ALIKE * open);
    while_closed > MOVES * noise && alike
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::FlagCode;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    /// Two seconds of a mass that moves with 10 Hz and touches for two samples in each period, by a contact of
    /// `closed` volts, else `open`, with noise.
    fn record([closed, open, noise]: [f64; 3], threshold: f64) -> Record {
        let deviation = Normal::new(0.0, noise).expect("a deviation");
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let moves: Vec<f64> = (0..4000).map(|i| (0.0314 * f64::from(i)).sin()).collect();
        let contact: Vec<f64> = (0..4000)
            .map(|i| if i % 200 < 2 { closed } else { open })
            .map(|v| v + deviation.sample(&mut random))
            .collect();
        let mut record = Record::of(
            2000.0,
            &[(Role::VelocityX, &moves), (Role::Contact, &contact)],
        );
        record.channels[1].threshold = Some(threshold);
        record
    }

    /// The codes of the flags and the number of samples that are closed then.
    fn settled(mut record: Record) -> (Vec<FlagCode>, Option<usize>) {
        settle(&mut record);
        let codes = record.flags.iter().map(|f| f.code).collect();
        assert!(record.flags.iter().all(|f| !f.excludes));
        let closed = record.channel(Role::Contact).map(|c| {
            let level = c.threshold.expect("a level");
            c.values.iter().filter(|v| **v > level).count()
        });
        (codes, closed)
    }

    #[test]
    fn a_contact_that_is_closed_while_the_mass_moves_is_turned_around() {
        let normal = settled(record([5.0, 0.0, 0.05], 2.5));
        assert_eq!(normal, (vec![], Some(40)));
        let other = settled(record([0.0, 5.0, 0.05], 2.5));
        assert_eq!(other, (vec![FlagCode::ContactInverted], Some(40)));
    }

    #[test]
    fn a_contact_that_is_closed_while_the_mass_rests_stays_as_it_is() {
        // at rest against the stop for 150 of 200 samples, then a hop
        let of = |i: usize| (i % 200).checked_sub(150).map(|k| k as f64);
        let moves = |i| of(i).map_or(1e-5 * (i % 7) as f64, |k| (25.0 - k) / 25.0);
        let moves: Vec<f64> = (0..4000).map(moves).collect();
        let contact: Vec<f64> = (0..4000).map(|i| of(i).map_or(5.0, |_| 0.0)).collect();
        let mut record = Record::of(
            2000.0,
            &[(Role::VelocityX, &moves), (Role::Contact, &contact)],
        );
        record.channels[1].threshold = Some(2.5);
        assert_eq!(settled(record), (vec![], Some(3000)));
    }

    #[test]
    fn a_threshold_within_the_noise_is_put_halfway_or_the_contact_left_out() {
        let clear = settled(record([5.0, 0.0, 0.3], 0.6));
        assert_eq!(clear, (vec![FlagCode::ThresholdInNoise], Some(40)));
        let hidden = settled(record([0.0, 0.0, 0.3], 0.6));
        assert_eq!(hidden, (vec![FlagCode::ThresholdInNoise], None));
        let sound = settled(record([0.0, 0.0, 0.3], 2.5));
        assert_eq!(sound, (vec![], Some(0)));
    }
}
