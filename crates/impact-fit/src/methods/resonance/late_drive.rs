//! A drive's channel that is later than the channels of the motion: their phases tell it, as the amplitudes tell f0
//! and β.

use crate::evidence::{Evidence, Nominal};
use crate::methods::blocks::Blocks;
use crate::methods::resonance::fit;
use crate::solver::mean_squares;

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

/// By how much the drive's channel is later than all channels of the motion, s; `None` where impactless records do
/// not show it to be later or earlier than is stated.
pub fn late_drive(evidence: &Evidence<'_>) -> Option<f64> {
    let blocks = Blocks::new(evidence);
    let points = &blocks.resonance.points;
    let fastest_hz = points.iter().map(|p| p.frequency_hz).fold(0.0, f64::max);
    if fastest_hz == 0.0 || points.iter().any(|p| p.phase_error_rad.is_none()) {
        return None;
    }
    let misfit = |lag_s: f64| misfit(&blocks, &behind(&evidence.nominal, lag_s));
    let stated = evidence.nominal.delay_uncertainties_s.iter();
    let stated_s = stated.map(|own| own.unwrap_or(blocks.half_sample_s()));
    let unnoticed_s = SURE * stated_s.fold(0.0, f64::max);
    let at_once = misfit(0.0)?;
    // the phases fit best near no lag
    if [-unnoticed_s, unnoticed_s]
        .into_iter()
        .all(|lag_s| misfit(lag_s).is_none_or(|with| with > at_once))
    {
        return None;
    }
    let step_s = 1.0 / (STEPS * fastest_hz);
    let most = (WIDEST * STEPS).round();
    let lags = std::iter::successors(Some(-most), |i| (*i < most).then_some(i + 1.0));
    let found = lags.filter_map(|i| Some((i * step_s, misfit(i * step_s)?)));
    let (coarse_s, _) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
    if coarse_s.abs() > (most - 0.5) * step_s {
        return None;
    }
    let near_s = vertex(coarse_s, step_s, &misfit)?;
    let lag_s = vertex(near_s, 0.2 * step_s, &misfit)?;
    let told = lag_s.abs() > unnoticed_s && misfit(lag_s)? < LEFT * at_once;
    told.then_some(lag_s)
}

/// What is stated, with the motion's channels as much earlier as the drive is later.
fn behind(nominal: &Nominal, lag_s: f64) -> Nominal {
    Nominal {
        delays_s: nominal.delays_s.map(|delay_s| delay_s - lag_s),
        ..*nominal
    }
}

/// Mean square of what the best curve leaves of the responses.
fn misfit(blocks: &Blocks, nominal: &Nominal) -> Option<f64> {
    let found = fit::start(blocks, nominal)?;
    let left = mean_squares(&blocks.resonance, &found);
    let count = left.iter().flatten().count();
    (count > 0).then(|| left.iter().flatten().sum::<f64>() / count as f64)
}

/// Where the parabola through three values, a step apart, has its least value, within the steps.
fn vertex(middle: f64, step: f64, value: &impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let [low, at, high] = [middle - step, middle, middle + step].map(value);
    let (low, at, high) = (low?, at?, high?);
    let bend = low - 2.0 * at + high;
    let shift = if bend > 0.0 {
        (0.5 * (low - high) / bend).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    Some(middle + shift * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};
    use impact_records::record::{Record, Role};

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
        let records = recorded((0.8, 12.0), 60, 41);
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
                let off = found.expect("a lag") / step_s - samples as f64;
                assert!(off.abs() < 0.5, "{samples} samples: {off} off");
            }
        }
    }

    #[test]
    fn valid_a_high_pass_that_is_not_stated_is_no_late_drive() {
        let mut observations = observed(&recorded((0.8, 12.0), 60, 42));
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
