//! A drive's channel that is later than the channels of the motion, or of the other sign: their phases tell it, as the
//! amplitudes tell f0 and β.

use crate::evidence::{Evidence, Nominal};
use crate::messages::ONE_DEGREE_OF_FREEDOM;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::fit;
use crate::methods::resonance::misfit::{least_of, left_by, misfit};
use crate::methods::resonance::result::deviation;
use impact_records::motion::LateChannel;
use impact_records::record::Role;

/// Greatest lag that is looked for, in periods of the fastest drive.
const WIDEST: f64 = 1.0;
/// Steps of the search in such a period: a tenth of a radian apart.
const STEPS: f64 = 60.0;
/// Times the stated uncertainty of delays from which a lag counts.
const SURE: f64 = 4.0;
/// Part of the misfit without a lag that one with it may leave: an unstated high-pass, whose phase lag falls with the
/// frequency instead of rising with it, leaves more, as `valid_a_high_pass_that_is_not_stated_is_no_late_drive` has it
/// over corners of 0.5 to 4 Hz.
const LEFT: f64 = 0.1;

/// The drive's channel where impactless records show it to be later or earlier than is stated, beside all channels of
/// the motion, or to be of the other sign; `None` where they do not.
pub fn late_drive(evidence: &Evidence<'_>) -> Option<LateChannel> {
    let blocks = Blocks::new(evidence);
    if blocks.resonance.points.is_empty() || !blocks.resonance.has_phases() {
        return None;
    }
    let stated = fit::start(&blocks, &evidence.nominal)?;
    let at_once = left_by(&blocks, &stated)?;
    let fits = deviation(&blocks.resonance, &stated) < ONE_DEGREE_OF_FREEDOM;
    let late = lag(&blocks, &evidence.nominal, at_once, fits).map(|(lag_s, left)| {
        let late = LateChannel::by(Role::Drive, lag_s);
        (late, left)
    });
    let turned = misfit(&turned_around(&blocks), &evidence.nominal)
        .map(|left| (LateChannel::inverted(Role::Drive), left));
    let fitting = late.into_iter().chain(turned);
    let fitting = fitting.filter(|(_, left)| *left < LEFT * at_once);
    let best = fitting.min_by(|a, b| a.1.total_cmp(&b.1));
    best.map(|(channel, _)| channel)
}

/// The blocks with all responses of the other sign.
fn turned_around(blocks: &Blocks) -> Blocks {
    let mut turned = blocks.clone();
    let points = turned.resonance.points.iter_mut();
    for response in points.flat_map(|p| &mut p.responses) {
        (response.real, response.imaginary) = (-response.real, -response.imaginary);
    }
    turned
}

/// The lag of the drive's channel with which the phases fit best, s, if it is noticed, and the misfit that it leaves;
/// `at_once`: that without one, and whether the responses are those of one degree of freedom then.
fn lag(blocks: &Blocks, nominal: &Nominal, at_once: f64, fits: bool) -> Option<(f64, f64)> {
    let points = blocks.resonance.points.iter();
    let fastest_hz = points.map(|p| p.frequency_hz).fold(0.0, f64::max);
    let misfit = |lag_s: f64| misfit(blocks, &behind(nominal, lag_s));
    let stated = nominal.delay_uncertainties_s.iter();
    let stated_s = stated.map(|own| own.unwrap_or(blocks.half_sample_s()));
    let unnoticed_s = SURE * stated_s.fold(0.0, f64::max);
    // the phases fit, and best near no lag
    if fits
        && [-unnoticed_s, unnoticed_s]
            .into_iter()
            .all(|lag_s| misfit(lag_s).is_none_or(|with| with > at_once))
    {
        return None;
    }
    let step_s = 1.0 / (STEPS * fastest_hz);
    let lag_s = least_of(WIDEST * STEPS * step_s, step_s, &misfit)?;
    let left = misfit(lag_s)?;
    (lag_s.abs() > unnoticed_s).then_some((lag_s, left))
}

/// What is stated, with the motion's channels as much earlier as the drive is later.
fn behind(nominal: &Nominal, lag_s: f64) -> Nominal {
    Nominal {
        delays_s: nominal.delays_s.map(|delay_s| delay_s - lag_s),
        ..*nominal
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
            let found = late_drive(&evidence(&observations));
            if samples.abs() < 2 {
                assert_eq!(found, None, "{samples} samples");
            } else {
                let found = found.expect("a lag");
                assert!(!found.inverted, "{samples} samples");
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
            let found = late_drive(&evidence(&observations));
            assert_eq!(found, Some(LateChannel::inverted(Role::Drive)));
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
            assert_eq!(late_drive(&evidence(&observations)), None, "{corner_hz} Hz");
        }
    }
}
