//! Samples of a decay at which a channel holds its value, or shows none: a sensor that is slower than the record, a
//! transmission that stopped.

use std::ops::Range;

use super::gaps::AROUND;
use super::{Channel, Flag, Problem};
use crate::signal::{columns, interpolation, robust};

/// Fewest repeats of a value that is held.
const REPEATS: usize = 3;
/// Steps of the converter by which a motion comes to a held value, and leaves it, at least: values that are rounded come to
/// each by one.
const STEPS: f64 = 5.0;
/// Share of the samples that repeat another from which the sensor is slower than the record.
const SLOWER: f64 = 0.5;
/// Number of such stretches that noise alone makes by chance, at most.
const BY_CHANCE: f64 = 1e-3;
/// How far on each side of a stretch the motion is looked at, in its lengths, and the part of the channel's range that it goes
/// through there at least: a mass at rest holds its value.
const BESIDE: usize = 2;
const MOVES: f64 = 0.1;

/// Interpolate between the values of a sensor that is slower than the record; else take the values away that a channel
/// holds in the midst of a decay.
pub(super) fn without_held(channel: &mut Channel) -> Option<Flag> {
    if !channel.role.is_motion() {
        return None;
    }
    let held = stretches(&channel.values);
    let repeats: Vec<f64> = held.iter().map(|s| (s.len() - 1) as f64).collect();
    let name = channel.name.clone();
    let problem = if repeats.iter().sum::<f64>() > SLOWER * channel.values.len() as f64 {
        // near a turn its values are as near as those that are rounded
        let all: Vec<Range<usize>> = equal(&channel.values).collect();
        interpolate(&mut channel.values, &all);
        Problem::SlowerSensor {
            channel: name,
            samples: robust::median(&repeats)? + 1.0,
        }
    } else {
        let held: Vec<Range<usize>> = held
            .into_iter()
            .filter(|s| in_motion(&channel.values, s))
            .collect();
        let first = held.first()?.start;
        for stretch in &held {
            channel.values[stretch.clone()].fill(f64::NAN);
        }
        Problem::HeldLeftOut {
            channel: name,
            count: held.len(),
            samples: held.iter().map(Range::len).sum(),
            first,
        }
    };
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// The stretches of equal values to which a motion comes by many steps of the converter and which it leaves by as many.
fn stretches(values: &[f64]) -> Vec<Range<usize>> {
    let (low, high) = columns::extremes(values);
    let still = 1e-12 * (high - low);
    let digit = columns::least_step(values, still);
    let ways = values.windows(2).map(|w| (w[1] - w[0]).abs());
    let ways: Vec<f64> = ways.filter(|way| *way > 0.0).collect();
    let Some(way) = robust::median(&ways) else {
        return Vec::new();
    };
    let by_chance = |repeats: usize| {
        let each = (digit / way).min(1.0);
        values.len() as f64 * each.powi(i32::try_from(repeats).unwrap_or(i32::MAX))
    };
    let far = |a: usize, b: usize, digit: f64| (values[a] - values[b]).abs() >= STEPS * digit;
    let both_far = |s: &Range<usize>| {
        let digit = digit_at(values, s.start, still);
        far(s.start, s.start - 1, digit) && far(s.end, s.end - 1, digit)
    };
    // what is clipped stands at either end of the range
    let inside = |v: f64| v > low && v < high;
    let is_held = |s: &Range<usize>| {
        s.start > 0
            && s.end < values.len()
            && s.len() > REPEATS
            && inside(values[s.start])
            && by_chance(s.len() - 1) < BY_CHANCE
            && both_far(s)
    };
    equal(values).filter(is_held).collect()
}

/// Whether a channel moves before and after a stretch.
fn in_motion(values: &[f64], stretch: &Range<usize>) -> bool {
    let range = |side: &[f64]| {
        let (low, high) = columns::extremes(side);
        high - low
    };
    let reach = BESIDE * stretch.len();
    let before = &values[stretch.start.saturating_sub(reach)..stretch.start];
    let after = &values[stretch.end..(stretch.end + reach).min(values.len())];
    let least = MOVES * range(values);
    range(before) > least && range(after) > least
}

/// The least step between values of the size of one, or greater: printed with so many significant digits, small values have
/// finer steps.
fn digit_at(values: &[f64], index: usize, still: f64) -> f64 {
    let size = values[index].abs();
    let decade = if size > 0.0 {
        10f64.powf(size.log10().floor())
    } else {
        0.0
    };
    let as_great = |v: &f64| v.abs() >= decade;
    let steps = values.windows(2).filter(|w| w.iter().all(as_great));
    let steps = steps.map(|w| (w[1] - w[0]).abs());
    steps
        .filter(|step| *step > still)
        .fold(f64::INFINITY, f64::min)
}

/// The stretches of equal values.
fn equal(values: &[f64]) -> impl Iterator<Item = Range<usize>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let value = *values.get(from)?;
        let count = values[from..].iter().take_while(|v| **v == value).count();
        // what is no number equals nothing
        let stretch = from..from + count.max(1);
        from = stretch.end;
        Some(stretch)
    })
}

/// Replace the repeats of each stretch by the polynomial through the first values of those around it.
fn interpolate(values: &mut [f64], held: &[Range<usize>]) {
    let mut repeated = vec![false; values.len()];
    for stretch in held {
        repeated[stretch.start + 1..stretch.end].fill(true);
    }
    let fresh: Vec<usize> = (0..values.len()).filter(|i| !repeated[*i]).collect();
    let known = values.to_vec();
    for i in (0..values.len()).filter(|i| repeated[*i]) {
        let after = fresh.partition_point(|k| *k < i);
        let nodes = &fresh[after.saturating_sub(AROUND)..(after + AROUND).min(fresh.len())];
        values[i] = interpolation::through(&known, nodes, i);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Excitation, FlagCode, Record, Role};
    use crate::signal::decay;

    /// 2.7 Hz, β = 0.008, at 200 Hz in steps of 0.001 with a scatter.
    fn swings(i: usize) -> f64 {
        let t = i as f64 / 200.0;
        let natural = std::f64::consts::TAU * 2.7;
        let scatter = 0.02 * (2.399_963 * (i * i) as f64).sin();
        let value = 20.0 * (-0.008 * natural * t).exp() * (natural * t).cos() + scatter;
        (value * 1e3).round() / 1e3
    }

    fn inspected(values: &[f64]) -> Record {
        let mut record = Record::of(200.0, &[(Role::DisplacementX, values)]);
        record.setting.excitation = Excitation::FreeDecay;
        crate::record::condition::inspect(&mut record, &[None], false);
        record
    }

    #[test]
    fn values_that_a_channel_holds_in_a_decay_are_left_out_and_zeros_too() {
        let whole: Vec<f64> = (0..3000).map(swings).collect();
        assert!(inspected(&whole).flags.is_empty());
        let mut frozen = whole.clone();
        for start in [300, 900, 1500] {
            let held = frozen[start];
            frozen[start..start + 45].fill(held);
        }
        let mut zeros = whole;
        for start in [503, 1210] {
            zeros[start..start + 60].fill(0.0);
        }
        for values in [frozen, zeros] {
            let record = inspected(&values);
            let codes: Vec<FlagCode> = record.flags.iter().map(|f| f.code).collect();
            assert!(codes.contains(&FlagCode::FrozenFrames), "{codes:?}");
            assert!(record.flags.iter().all(|f| !f.excludes));
            let held = record.channels[0].values.iter().filter(|v| v.is_nan());
            assert!((118..=138).contains(&held.count()));
        }
    }

    #[test]
    fn valid_a_sensor_slower_than_the_record_shows_the_decay() {
        let held: Vec<f64> = (0..3000).map(|i| swings(i - i % 8)).collect();
        let record = inspected(&held);
        assert!(matches!(
            &record.flags[..],
            [Flag {
                code: FlagCode::FrozenFrames,
                excludes: false,
                ..
            }]
        ));
        let found = decay::fit(&record.channels[0].values, 200.0).unwrap();
        assert!((found.natural_frequency_hz - 2.7).abs() < 1e-3, "{found:?}");
        assert!((found.damping_ratio - 0.008).abs() < 1e-4, "{found:?}");
        assert!(found.structured_ratio < 0.02, "{found:?}");
    }

    #[test]
    fn rounding_rest_and_clipping_hold_no_value() {
        // a coarse converter, at rest before and after
        let coarse = |i: usize| (swings(i.saturating_sub(400)) / 2.0).round() * 2.0;
        let coarse: Vec<f64> = (0..3400).map(coarse).collect();
        assert!(stretches(&coarse).is_empty());
        let clipped: Vec<f64> = (0..3000).map(|i| swings(i).clamp(-14.0, 14.0)).collect();
        assert!(stretches(&clipped).is_empty());
        // printed with three significant digits, which are coarser at the turns than near zero
        let three = |v: f64| format!("{v:.2e}").parse::<f64>().unwrap();
        let printed: Vec<f64> = (0..3000).map(|i| three(swings(i) + 8.0)).collect();
        assert!(stretches(&printed).is_empty());
        // an echo that goes to and fro between two values at rest, before and after the motion
        let echo = |i: usize| if i % 11 < 8 { 0.013 } else { -0.913 };
        let echoes = |i: usize| match i {
            500..2500 => swings(i - 500),
            _ => echo(i),
        };
        let echoes: Vec<f64> = (0..3000).map(echoes).collect();
        let held = stretches(&echoes);
        assert!(held.iter().all(|s| !in_motion(&echoes, s)));
        // at rest, then struck
        let struck: Vec<f64> = (0..1000)
            .map(|i| if i < 500 { 0.0 } else { swings(i - 500) })
            .collect();
        assert!(stretches(&struck).is_empty());
    }
}
