//! Channels that are not as stated, as impactless records show them: the drive's channel ([`super::drive_channel`]), or
//! channels of the motion behind a low-pass of one pole. Phases tell them, as the amplitudes tell f0 and β. More poles turn
//! phases as a delay does.

use nalgebra::Complex;
use std::f64::consts::TAU;

use crate::evidence::{Evidence, Nominal};
use crate::methods::blocks::Blocks;
use crate::methods::resonance::drive_channel;
use crate::methods::resonance::fit;
use crate::methods::resonance::force_law;
use crate::methods::resonance::misfit::{least_of, left_by, misfit};
use crate::methods::resonance::phases::{
    EXPLAINED, Misstated, ONE, Phases, fastest_hz, with_responses,
};
use crate::methods::resonance::unsteady;
use impact_records::motion::{LateChannel, Observation};
use impact_records::record::{LowPass, Role};

/// Part of the misfit without a cause that one with it may leave: a lag leaves more of an unstated high-pass, whose phase
/// lag falls with the frequency instead of rising with it, as `valid_a_high_pass_that_is_not_stated_is_no_late_drive` has
/// it over corners of 0.5 to 4 Hz.
const LEFT: f64 = 0.1;
/// Greatest time constant of a pole that is looked for, and the steps of the search, in radians of the fastest drive: a
/// corner at a third of it.
const SLOWEST: f64 = 3.0;
const POLE_STEP: f64 = 0.1;

/// The channels that impactless records show not to be as stated, by the one cause that leaves least of the misfit; none
/// where no cause leaves little of it. What a force that rises with the frequency leaves is no channel's.
pub fn misstated_channels(evidence: &Evidence<'_>) -> Vec<LateChannel> {
    let impactless = evidence.impactless();
    let of_impactless = evidence.of_records(&impactless);
    let stated = Blocks::new(&of_impactless);
    let law = force_law::force_law(&of_impactless);
    let blocks = law.map_or_else(|| stated.clone(), |law| force_law::followed(&stated, law));
    let found = causes(&of_impactless, &blocks).unwrap_or_default();
    let best = found.into_iter().min_by(|a, b| a.left.total_cmp(&b.left));
    best.map(|best| best.channels).unwrap_or_default()
}

/// The causes that leave little of the misfit without them; `None` where the phases tell nothing.
fn causes(evidence: &Evidence<'_>, blocks: &Blocks) -> Option<Vec<Misstated>> {
    if blocks.resonance.points.is_empty() || !blocks.resonance.has_phases() {
        return None;
    }
    let stated = fit::start(blocks, &evidence.nominal)?;
    let at_once = left_by(blocks, &stated)?;
    let phases = Phases {
        evidence,
        blocks,
        stated: &stated,
        at_once,
    };
    let sets = if at_once > EXPLAINED {
        sets(blocks, evidence.observations)
    } else {
        Vec::new()
    };
    let filtered = sets.iter().filter_map(|set| {
        let pole = OnePole {
            blocks,
            nominal: &evidence.nominal,
            set,
        };
        pole.cause(at_once)
    });
    let explains = |cause: &Misstated| cause.left < LEFT * at_once;
    let of_drive = drive_channel::causes(&phases);
    let mut found: Vec<Misstated> = of_drive.chain(filtered).filter(explains).collect();
    // a few frequencies do not tell whether the force rises
    if found.is_empty() && at_once > EXPLAINED && force_law::has_frequencies(blocks) {
        let candidates = may_be_unsteady(blocks, evidence.observations);
        found.extend(unsteady::channel(&phases, &candidates).filter(explains));
    }
    Some(found)
}

/// The channels that may be at another time in each record: those of the motion if there are several, and the drive's where
/// the frequencies are known without it.
fn may_be_unsteady(blocks: &Blocks, observations: &[Observation]) -> Vec<Role> {
    let mut roles = measured(blocks);
    if roles.len() < 2 {
        roles.clear();
    }
    let states = |o: &Observation| o.setting.stated_frequency_hz.is_some();
    roles.extend(observations.iter().all(states).then_some(Role::Drive));
    roles
}

/// The channels of the motion that impactless records have.
fn measured(blocks: &Blocks) -> Vec<Role> {
    let mut roles: Vec<Role> = blocks.resonance.channels().map(|(role, _)| role).collect();
    roles.sort_unstable();
    roles.dedup();
    roles
}

/// Channels of the motion that may have passed one filter, with what is known of each: all, those of one mass, those of
/// one quantity, each alone.
fn sets(blocks: &Blocks, observations: &[Observation]) -> Vec<Vec<LateChannel>> {
    let roles = measured(blocks);
    let together = |alike: &dyn Fn(Role) -> bool| -> Vec<Role> {
        roles.iter().copied().filter(|role| alike(*role)).collect()
    };
    let masses = [false, true].map(|y| together(&|role| role.is_of_y() == y));
    let quantities = [0, 1, 2].map(|order| together(&|role| role.derivative() == Some(order)));
    let alone = roles.iter().map(|role| vec![*role]);
    let candidates = masses.into_iter().chain(quantities).chain(alone);
    let mut sets = vec![roles.clone()];
    for set in candidates {
        if !set.is_empty() && !sets.contains(&set) {
            sets.push(set);
        }
    }
    let known = observations.first().map_or(&[][..], |o| &o.late);
    let of = |role: &Role| {
        let known = known.iter().find(|late| late.role == *role);
        known.copied().unwrap_or(LateChannel::by(*role, 0.0))
    };
    let with_known = sets.iter().map(|set| set.iter().map(of).collect());
    let passed_none = |set: &Vec<LateChannel>| set.iter().all(|c| c.low_pass.is_none());
    with_known.filter(passed_none).collect()
}

/// A low-pass of one pole that some channels have passed, in place of the delay with which they were corrected.
struct OnePole<'a> {
    blocks: &'a Blocks,
    nominal: &'a Nominal,
    set: &'a [LateChannel],
}

impl OnePole<'_> {
    /// The pole with which the responses fit best, if the channels have passed one: better than with a delay.
    fn cause(&self, at_once: f64) -> Option<Misstated> {
        let unit_s = 1.0 / (TAU * fastest_hz(self.blocks));
        let with_pole = |constant_s: f64| {
            let undone = || self.misfit(|rate| 1.0 + rate * constant_s);
            (constant_s >= 0.0).then(undone).flatten()
        };
        let uncorrected = self.set.iter().all(|c| c.delay_s == 0.0);
        // a pole that is far too fast fits better than none
        if uncorrected && with_pole(POLE_STEP * unit_s)? > at_once {
            return None;
        }
        let constant_s = least_of(SLOWEST * unit_s, POLE_STEP * unit_s, &with_pole)?;
        let left = with_pole(constant_s)?;
        let with_delay = |delay_s: f64| self.misfit(|rate| (rate * delay_s).exp());
        let delay_s = least_of(2.0 * constant_s, 0.25 * constant_s, &with_delay);
        let of_delay = delay_s.and_then(with_delay).unwrap_or(at_once);
        if left >= of_delay {
            return None;
        }
        let low_pass = LowPass {
            corner_hz: 1.0 / (TAU * constant_s),
            order: 1,
        };
        let passed = |known: &LateChannel| LateChannel {
            low_pass: Some(low_pass),
            order_share: self.open(left, of_delay).min(1.0),
            ..LateChannel::by(known.role, -known.delay_s)
        };
        Some(Misstated {
            channels: self.set.iter().map(passed).collect(),
            left,
        })
    }

    /// Standard error of a part between a delay, of 0, and the pole, of 1, whose misfits are mean squares of each record:
    /// of the amplitudes that the pole lowers nothing else tells.
    fn open(&self, of_pole: f64, of_delay: f64) -> f64 {
        let records = self.blocks.resonance.points.len() as f64;
        (of_pole / (records * (of_delay - of_pole))).sqrt()
    }

    /// The misfit of the responses times a factor of iω, 1/s, and with the delays of which the channels were
    /// corrected.
    fn misfit(&self, factor: impl Fn(Complex<f64>) -> Complex<f64>) -> Option<f64> {
        let of_channel = |role: Role, rate: Complex<f64>| {
            let known = self.set.iter().find(|c| c.role == role);
            known.map_or(ONE, |c| factor(rate) * (-rate * c.delay_s).exp())
        };
        misfit(&with_responses(self.blocks, of_channel), self.nominal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};
    use impact_records::record::Record;

    /// The record with the drive's channel so many samples later than the others, or earlier.
    fn with_late_drive(record: &Record, samples: isize) -> Record {
        let mut record = record.clone();
        for channel in &mut record.channels {
            let from_end = (channel.role == Role::Drive) == (samples > 0);
            let count = channel.values.len();
            let kept = count - samples.unsigned_abs();
            if from_end {
                channel.values.truncate(kept);
            } else {
                channel.values.drain(..count - kept);
            }
        }
        record
    }

    #[test]
    fn valid_a_late_drive_is_told_from_the_phases_and_none_where_there_is_none() {
        let records = recorded(0.8, 12.0, 60, 41);
        let step_s = 1.0 / records[0].sample_rate_hz;
        for samples in [-30, -6, 0, 1, 3, 10, 40] {
            let late: Vec<Record> = records
                .iter()
                .map(|r| with_late_drive(r, samples))
                .collect();
            let observations = observed(&late);
            let found = misstated_channels(&evidence(&observations));
            if samples.abs() < 2 {
                assert_eq!(found, [], "{samples} samples");
            } else {
                let [found] = found[..] else {
                    panic!("{samples} samples: {found:?}");
                };
                assert!(!found.inverted && found.role == Role::Drive, "{found:?}");
                let off = found.delay_s / step_s - samples as f64;
                assert!(off.abs() < 0.5, "{samples} samples: {off} off");
            }
        }
    }

    #[test]
    fn valid_a_drive_of_the_other_sign_is_told_from_the_phases_whether_it_is_late_or_not() {
        let records = recorded(0.8, 12.0, 60, 43);
        let turned = |record: &Record| {
            let mut record = record.clone();
            let drive = record.channels.iter_mut().filter(|c| c.role == Role::Drive);
            let values = drive.flat_map(|c| &mut c.values);
            values.for_each(|v| *v = -*v);
            record
        };
        for samples in [0, 6] {
            let as_stated: Vec<Record> = records
                .iter()
                .map(|r| with_late_drive(r, samples))
                .collect();
            let other: Vec<Record> = as_stated.iter().map(turned).collect();
            let observations = observed(&other);
            let found = misstated_channels(&evidence(&observations));
            assert_eq!(found, [LateChannel::inverted(Role::Drive)]);
        }
    }

    #[test]
    fn valid_a_high_pass_that_is_not_stated_is_no_late_drive() {
        let mut observations = observed(&recorded(0.8, 12.0, 60, 42));
        for corner_hz in [0.5, 2.0, 4.0] {
            for o in &mut observations {
                let Some(tone) = o.tone() else { continue };
                let lag = corner_hz / tone.frequency_hz;
                for r in &mut o.response {
                    // 1/(1 − i f_c/f)
                    let passed = nalgebra::Complex::new(r.real, r.imaginary)
                        / nalgebra::Complex::new(1.0, -lag);
                    (r.real, r.imaginary) = (passed.re, passed.im);
                }
            }
            let found = misstated_channels(&evidence(&observations));
            assert_eq!(found, [], "{corner_hz} Hz");
        }
    }

    #[test]
    fn valid_a_high_pass_of_the_drive_s_channel_is_told() {
        let known = observed(&recorded(0.8, 12.0, 60, 42));
        for corner_hz in [0.3, 1.5, 5.0] {
            let mut observations = known.clone();
            for o in &mut observations {
                let Some(tone) = o.tone() else { continue };
                // the motion over the drive's channel, which shows f/(f − i f_c) of the drive
                let over_drive = Complex::new(1.0, -corner_hz / tone.frequency_hz);
                for r in &mut o.response {
                    *r = r.times(over_drive / over_drive.norm());
                    r.high_pass_hz = None;
                }
                let drive = o.drive.iter_mut();
                drive.for_each(|drive| drive.amplitude /= over_drive.norm());
            }
            let [found] = misstated_channels(&evidence(&observations))[..] else {
                panic!("{corner_hz} Hz");
            };
            assert_eq!(found.role, Role::Drive);
            let off = found.high_pass_hz.expect("a high-pass") / corner_hz - 1.0;
            assert!(off.abs() < 0.05, "{off} at {corner_hz} Hz");
        }
    }

    #[test]
    fn valid_a_drive_at_another_time_in_each_record_is_told_where_frequencies_are_stated() {
        let mut observations = observed(&recorded(0.8, 12.0, 60, 42));
        for (i, o) in observations.iter_mut().enumerate() {
            let Some(tone) = o.tone() else { continue };
            let late = 3e-3 * ((i * 7 % 13) as f64 - 6.0) / 6.0;
            let turned = Complex::from_polar(1.0, TAU * tone.frequency_hz * late);
            let responses = o.response.iter_mut();
            responses.for_each(|r| *r = r.times(turned));
            o.setting.stated_frequency_hz = None;
        }
        assert_eq!(misstated_channels(&evidence(&observations)), []);
        for o in &mut observations {
            o.setting.stated_frequency_hz = o.frequency_hz();
        }
        let [found] = misstated_channels(&evidence(&observations))[..] else {
            panic!("one channel");
        };
        assert_eq!(found.role, Role::Drive);
        let scatter_s = found.unsteady_s.expect("a scatter");
        assert!((1e-3..3e-3).contains(&scatter_s), "{scatter_s}");
    }

    #[test]
    fn valid_a_force_that_rises_with_the_frequency_is_no_channel_that_is_not_as_stated() {
        let mut observations = observed(&recorded(0.8, 12.0, 60, 42));
        for o in &mut observations {
            let Some(hz) = o.frequency_hz() else { continue };
            o.setting.stated_frequency_hz = Some(hz);
            for r in &mut o.response {
                *r = r.times(Complex::from((hz / 12.0).powi(2)));
            }
        }
        assert_eq!(misstated_channels(&evidence(&observations)), []);
    }

    #[test]
    fn valid_a_low_pass_of_one_pole_is_told_from_a_delay_and_which_channels_have_passed_it() {
        let known = observed(&recorded(0.8, 12.0, 60, 42));
        let both = [Role::VelocityX, Role::VelocityY];
        for (roles, corner_hz) in [(&both[..], 60.0), (&both[..], 250.0), (&both[1..], 120.0)] {
            let mut observations = known.clone();
            for o in &mut observations {
                let Some(tone) = o.tone() else { continue };
                let passed = Complex::new(1.0, tone.frequency_hz / corner_hz).inv();
                let responses = o.response.iter_mut();
                for r in responses.filter(|r| roles.contains(&r.role)) {
                    *r = r.times(passed);
                }
            }
            let found = misstated_channels(&evidence(&observations));
            assert_eq!(found.iter().map(|c| c.role).collect::<Vec<_>>(), roles);
            for channel in found {
                let filter = channel.low_pass.expect("a low-pass");
                assert_eq!(filter.order, 1);
                let off = filter.corner_hz / corner_hz - 1.0;
                assert!(off.abs() < 0.05, "{off} at {corner_hz} Hz");
                assert!(channel.order_share < 0.3, "{channel:?}");
            }
        }
    }
}
