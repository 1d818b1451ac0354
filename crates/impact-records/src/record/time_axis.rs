//! The time axis of a record: which channel holds it, its step, and what is wrong with it.

use super::bind::ChannelKey;
use super::{Flag, Problem};
use crate::signal::whole;
use labfiles::{ChannelInfo, DatasetInfo, StoredType, timing, units};

/// Most steps by which a time axis without gaps may stray from equal steps.
const MOST_STRAY_STEPS: f64 = 2.0;

/// Index of the channel that holds the time: as campaign.toml states, else as the reader found.
///
/// # Errors
/// The flag for a channel that campaign.toml names and the dataset lacks.
pub fn find(key: Option<&ChannelKey>, dataset: &DatasetInfo) -> Result<Option<usize>, Flag> {
    let Some(key) = key else {
        return Ok(dataset.time_axis.or_else(|| by_name(dataset)));
    };
    let found = key.find(dataset);
    found.map(Some).ok_or_else(|| {
        let channel = key.text();
        Flag::new(None, Problem::NoSuchTimeAxis { channel })
    })
}

/// A channel in units of time by name and unit, which a reader did not take for a time axis,
/// perhaps because it runs backward; only if no sample rate is stated.
fn by_name(dataset: &DatasetInfo) -> Option<usize> {
    if dataset.channels.iter().any(|c| c.sample_rate_hz.is_some()) {
        return None;
    }
    let numbers = |c: &ChannelInfo| c.stored != StoredType::Text && timing::is_time_name(&c.name);
    dataset.channels.iter().position(numbers)
}

/// Whether a channel counts the frames of a camera.
pub fn counts_frames(dataset: &DatasetInfo, index: usize) -> bool {
    let info = &dataset.channels[index];
    let name = units::split_unit(&info.name).0.trim().to_lowercase();
    let named = [
        "frame",
        "frames",
        "sub frame",
        "frame number",
        "frame no",
        "image",
        "bild",
        "slice",
    ];
    info.unit.is_none() && named.contains(&name.as_str())
}

/// The usual step of a time axis, in its own unit.
pub(super) fn usual_step(times: &[f64]) -> Option<f64> {
    let steps = times.windows(2).map(|w| w[1] - w[0]).filter(|s| *s > 0.0);
    let mut steps: Vec<f64> = steps.collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

/// Samples per second of a time axis in s, Hz; `None` if no step can be determined. What is wrong with it
/// is noted in `flags`.
///
/// Time stamps printed with few digits, also such that many samples share one, are taken as uniform as long as
/// no stamp strays from a straight line by more than their own rounding; the rate is that of the line nearest to
/// all of them.
pub fn inspect(times: &[f64], flags: &mut Vec<Flag>) -> Option<f64> {
    if times.len() < 2 || times.iter().any(|t| !t.is_finite()) {
        if !times.is_empty() {
            flags.push(Flag::new(None, Problem::NoTimes));
        }
        return None;
    }
    let times = &unwrapped(times)[..];
    let mut steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    if let Some(at) = steps.iter().position(|s| *s < 0.0) {
        flags.push(backward_at(times, at));
        return None;
    }
    let in_order = steps.clone();
    steps.sort_by(f64::total_cmp);
    let quantile = |q: f64| steps[whole::index((steps.len() - 1) as f64 * q)];
    let mean = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let spread = quantile(0.95) - quantile(0.05);
    let shared = quantile(0.5) <= 0.0;
    if mean > 0.0 && (spread > 0.2 * mean || shared) {
        // steps that scatter: rounded stamps of a uniform axis, or no uniform axis
        let printed = steps.iter().copied().find(|s| *s > 0.0).filter(|_| shared);
        let rounding = spread.max(mean).max(printed.unwrap_or(0.0));
        let line = if shared {
            shared_step(times)
        } else {
            Ok(nearest_step(times))
        };
        let line = match line {
            Ok(line) => line,
            Err(stamps) => {
                let samples = times.len();
                flags.push(Flag::new(None, Problem::FewStamps { samples, stamps }));
                return None;
            }
        };
        if strays(times, line) > 1.05 * rounding {
            let problem = match printed {
                Some(unit_s) => Problem::UnevenStamps { unit_s },
                None => Problem::ScatteredSteps {
                    spread_s: spread,
                    mean_s: mean,
                },
            };
            flags.push(Flag::new(None, problem));
        }
        return Some(1.0 / line);
    }
    regular(times, &in_order, quantile(0.5), flags)
}

/// A counter of a microcontroller that runs over.
struct Counter {
    bits: i32,
    /// What it counts.
    unit: &'static str,
    /// That in s.
    to_s: f64,
}

impl Counter {
    /// The time at which it begins again, s.
    fn end_s(&self) -> f64 {
        2.0_f64.powi(self.bits) * self.to_s
    }
}

const COUNTERS: [Counter; 4] = [
    counter(32, "µs", 1e-6),
    counter(32, "ms", 1e-3),
    counter(16, "ms", 1e-3),
    counter(16, "µs", 1e-6),
];

const fn counter(bits: i32, unit: &'static str, to_s: f64) -> Counter {
    Counter { bits, unit, to_s }
}

/// Part of the usual step by which the step over the end of a counter may differ from it: between it and none, or two.
const HALF_STEP: f64 = 0.5;

/// Times that go on where a counter runs over and no sample is missing there: the step over its end is the usual one.
fn unwrapped(times: &[f64]) -> Vec<f64> {
    let mut out = times.to_vec();
    let Some(usual) = usual_step(times) else {
        return out;
    };
    let mut added = 0.0;
    for (at, two) in times.windows(2).enumerate() {
        if two[1] < two[0]
            && let Some(counter) = turned(times, at)
        {
            let end = counter.end_s();
            let over = two[1] + end - two[0];
            if (over - usual).abs() < HALF_STEP * usual {
                added += end;
            }
        }
        out[at + 1] += added;
    }
    out
}

/// The counter that ran over where times fall: they fall from its end to zero, within two steps each.
fn turned(times: &[f64], at: usize) -> Option<&'static Counter> {
    let within = 2.0 * usual_step(times)?;
    let [before, after] = [times[at], times[at + 1]];
    let ends = |counter: &&Counter| {
        let end = counter.end_s();
        (end - within..=end).contains(&before) && (0.0..=within).contains(&after)
    };
    COUNTERS.iter().find(ends)
}

fn backward_at(times: &[f64], at: usize) -> Flag {
    if let Some(counter) = turned(times, at) {
        let problem = Problem::TimeTurns {
            sample: at,
            bits: whole::index(counter.bits.into()),
            unit: counter.unit.to_owned(),
        };
        return Flag::new(None, problem);
    }
    let problem = Problem::TimeFalls {
        sample: at,
        before_s: times[at],
        after_s: times[at + 1],
    };
    Flag::new(None, problem)
}

/// The step of the straight line nearest to times by least squares, s.
fn nearest_step(times: &[f64]) -> f64 {
    let middle = (times.len() - 1) as f64 / 2.0;
    let mut sums = (0.0, 0.0);
    for (i, t) in times.iter().enumerate() {
        let x = i as f64 - middle;
        sums = (sums.0 + x * (t - times[0]), sums.1 + x * x);
    }
    sums.0 / sums.1
}

/// Relative error of a rate that rounding of the stamps may leave.
const COARSE: f64 = 1e-4;

/// Greatest unit of printed stamps, over the usual step, at which a sample that is missing or repeated strays farther
/// from any straight line, by half a step, than stamps that are rounded to the unit.
const FINE_UNIT: f64 = 0.6;

/// The step of even times whose stamps are whole numbers of a unit less than a step, so that single steps are a unit
/// longer or shorter; `None` where stamps are farther than half a unit from the straight line of least greatest
/// distance.
fn rounded_step(times: &[f64], steps: &[f64], usual: f64) -> Option<f64> {
    let off = steps.iter().map(|s| (s - usual).abs());
    let unit = off.filter(|d| *d > 1e-3 * usual).reduce(f64::min)?;
    let line = nearest_step(times);
    let within = unit <= FINE_UNIT * usual && least_range(times, line) <= 1.05 * unit;
    within.then_some(line)
}

/// Divisions by three of the steps among which that of least range is looked for.
const DIVISIONS: usize = 40;

/// The range of what straight lines leave of times, s, of the step near one for which it is least: twice the least
/// greatest distance from a line whose start is free.
fn least_range(times: &[f64], near: f64) -> f64 {
    let range = |step: f64| range_about(times, step);
    // a line that is farther off than this leaves more over the whole length
    let width = 2.0 * range(near) / (times.len() - 1) as f64;
    let (mut low, mut high) = (near - width, near + width);
    for _ in 0..DIVISIONS {
        let third = (high - low) / 3.0;
        if range(low + third) < range(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    range(0.5 * (low + high)).min(range(near))
}

/// The step of samples of which many share a stamp, s: that of the line through the samples at which the stamp
/// changes, as each of them lies within one step of it; the number of stamps where those are too few to tell it.
fn shared_step(times: &[f64]) -> Result<f64, usize> {
    let changes: Vec<(f64, f64)> = (1..times.len())
        .filter(|i| times[*i] > times[i - 1])
        .map(|i| (i as f64, times[i]))
        .collect();
    let (Some(first), Some(last)) = (changes.first(), changes.last()) else {
        return Err(1);
    };
    let between = (last.0 - first.0) * (changes.len() as f64).sqrt();
    if between * COARSE < 1.0 {
        return Err(changes.len() + 1);
    }
    let count = changes.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| changes.iter().map(of).sum::<f64>() / count;
    let (at, time) = (mean(|c| c.0), mean(|c| c.1));
    let (mut both, mut own) = (0.0, 0.0);
    for change in &changes {
        both += (change.0 - at) * (change.1 - time);
        own += (change.0 - at).powi(2);
    }
    Ok(both / own)
}

/// How far times are at most from a straight line through the first, s.
fn strays(times: &[f64], step: f64) -> f64 {
    let stray = |(i, t): (usize, &f64)| (t - times[0] - i as f64 * step).abs();
    times.iter().enumerate().map(stray).fold(0.0, f64::max)
}

/// The range of what straight lines of a step leave of times, s.
fn range_about(times: &[f64], step: f64) -> f64 {
    let rest = times.iter().enumerate();
    let rest = rest.map(|(i, t)| t - times[0] - i as f64 * step);
    let ends = rest.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), r| {
        (r.min(low), r.max(high))
    });
    ends.1 - ends.0
}

/// Part of a step by which times may stray from equal steps before they count as uneven.
const EVEN: f64 = 0.02;

/// Most decimals of a second that printed times are looked at with.
const DECIMALS: i32 = 9;

/// Whether rising times without gaps stray from equal steps by more than what rounding them explains: to the decimals
/// with which they are printed.
pub(super) fn strays_unrounded(times: &[f64]) -> bool {
    let step = nearest_step(times);
    let even_s = (1.05 * printed_unit_s(times, step)).max(EVEN * step);
    // of most axes the nearest line shows already that they do not
    range_about(times, step) > even_s && least_range(times, step) > even_s
}

/// The greatest power of ten up to a step, s, of which all times are whole multiples; zero if none is.
fn printed_unit_s(times: &[f64], step: f64) -> f64 {
    let coarsest = whole::integer((-step.log10()).floor()).clamp(0, DECIMALS);
    let mut units = (coarsest..=DECIMALS).map(|decimals| 10_f64.powi(-decimals));
    let whole = |unit: f64| {
        let off = |t: f64| (t / unit - (t / unit).round()).abs();
        times.iter().all(|t| off(*t) < 1e-3)
    };
    units.find(|unit| whole(*unit)).unwrap_or(0.0)
}

/// An axis of equal steps but for gaps and repetitions.
fn regular(times: &[f64], steps: &[f64], step: f64, flags: &mut Vec<Flag>) -> Option<f64> {
    let odd = steps.iter().any(|s| *s > 1.5 * step || *s < 0.5 * step);
    if let Some(line) = odd.then(|| rounded_step(times, steps, step)).flatten() {
        return Some(1.0 / line);
    }
    let known = flags.len();
    let lost: f64 = steps
        .iter()
        .filter(|s| **s > 1.5 * step)
        .map(|s| (s / step).round() - 1.0)
        .sum();
    if let Some(at) = steps.iter().position(|s| *s > 1.5 * step) {
        let problem = Problem::LostSamples {
            count: lost,
            after_s: times[at],
        };
        flags.push(Flag::new(None, problem));
    }
    let repeated = steps.iter().filter(|s| **s < 0.5 * step).count();
    if repeated > 0 {
        let problem = Problem::RepeatedStamps { count: repeated };
        flags.push(Flag::new(None, problem));
    }
    let whole = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let strayed = strays(times, whole);
    if flags.len() == known && strayed > MOST_STRAY_STEPS * whole {
        let problem = Problem::StrayingTimes {
            stray_s: strayed,
            step_s: whole,
        };
        flags.push(Flag::new(None, problem));
    }
    let good: Vec<f64> = steps
        .iter()
        .copied()
        .filter(|s| (s / step - 1.0).abs() <= 0.5)
        .collect();
    let mean = good.iter().sum::<f64>() / good.len().max(1) as f64;
    (mean > 0.0).then(|| 1.0 / mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(n: usize, step: f64) -> Vec<f64> {
        (0..n).map(|i| i as f64 * step).collect()
    }

    fn inspected(times: &[f64]) -> (Option<f64>, Vec<Flag>) {
        let mut flags = Vec::new();
        (inspect(times, &mut flags), flags)
    }

    fn codes((_, flags): &(Option<f64>, Vec<Flag>)) -> Vec<&str> {
        flags.iter().map(|f| f.code.name()).collect()
    }

    #[test]
    fn a_uniform_axis_gives_its_rate() {
        let axis = inspected(&uniform(2000, 5e-4));
        assert!(axis.1.is_empty());
        assert!((axis.0.unwrap() - 2000.0).abs() < 1e-6);
    }

    #[test]
    fn rounded_stamps_are_still_uniform() {
        for digits in [1e3, 1e4, 1e6] {
            let t: Vec<f64> = uniform(2000, 0.000_605_5)
                .iter()
                .map(|t| (t * digits).round() / digits)
                .collect();
            let axis = inspected(&t);
            assert!(axis.1.is_empty(), "{digits}: {:?}", axis.1);
            assert!((axis.0.unwrap() * 0.000_605_5 - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn many_samples_may_share_a_printed_stamp() {
        // 20 and 18.3 samples in each ms, printed to the ms: the step comes out to a millionth.
        for step in [5e-5, 1e-3 / 18.3] {
            let rounded = |t: &f64| (t * 1e3).floor() / 1e3;
            let printed: Vec<f64> = uniform(40_000, step).iter().map(rounded).collect();
            let axis = inspected(&printed);
            assert!(axis.1.is_empty(), "{:?}", axis.1);
            assert!((axis.0.unwrap() * step - 1.0).abs() < 3e-6, "{:?}", axis.0);
            let mut lost = printed.clone();
            lost.drain(9_000..9_100);
            assert_eq!(codes(&inspected(&lost)), ["time_not_uniform"]);
        }
        // 2 s at 1 kHz printed to the second
        let printed: Vec<f64> = uniform(2_000, 1e-3).iter().map(|t| t.floor()).collect();
        assert_eq!(codes(&inspected(&printed)), ["time_coarse"]);
        let printed: Vec<f64> = uniform(30_000, 1e-3).iter().map(|t| t.floor()).collect();
        assert!((inspected(&printed).0.unwrap() / 1000.0 - 1.0).abs() < 5e-5);
    }

    #[test]
    fn gaps_repetitions_and_backward_time_are_reported() {
        let mut t = uniform(1000, 1e-3);
        t.drain(300..303);
        let axis = inspected(&t);
        assert_eq!(codes(&axis), ["dropped_samples"]);
        assert!(axis.1[0].message().starts_with("3 samples"));
        assert!((axis.0.unwrap() - 1000.0).abs() < 1e-6);

        let mut t = uniform(1000, 1e-3);
        t[500] = t[499];
        assert!(codes(&inspected(&t)).contains(&"repeated_samples"));

        let mut t = uniform(1000, 1e-3);
        t.reverse();
        assert_eq!(codes(&inspected(&t)), ["time_backward"]);
    }

    #[test]
    fn valid_a_counter_that_runs_over_goes_on_or_is_named() {
        for (end, to_s, said) in [
            (
                2.0_f64.powi(32),
                1e-6,
                "a counter of 32 bits that counts µs has run over",
            ),
            (
                2.0_f64.powi(16),
                1e-3,
                "a counter of 16 bits that counts ms has run over",
            ),
        ] {
            let times = uniform(900, 0.01);
            let turned = times
                .iter()
                .map(|t| (end * to_s - 5.003 + t) % (end * to_s));
            let mut turned: Vec<f64> = turned.collect();
            // the step over the end is the usual one: the times go on
            let axis = inspected(&turned);
            assert!(axis.1.is_empty(), "{:?}", axis.1);
            assert!((axis.0.unwrap() - 100.0).abs() < 1e-6, "{:?}", axis.0);
            // where a sample is missing there
            let end = turned.windows(2).position(|w| w[1] < w[0]).unwrap();
            turned.remove(end);
            let axis = inspected(&turned);
            assert_eq!(codes(&axis), ["time_backward"]);
            let message = axis.1[0].message();
            assert!(message.ends_with(said), "{message}");
        }
        // runs of another length
        let times: Vec<f64> = uniform(900, 0.01).iter().map(|t| t % 5.0).collect();
        assert!(inspected(&times).1[0].message().contains("runs backward"));
    }

    #[test]
    fn valid_whole_stamps_that_are_now_and_then_one_early_are_even() {
        for early_every in [29, 40, 400] {
            let stamp = |i: i32| f64::from(2 * i - i32::from(i % early_every == 7)) / 1000.0;
            let t: Vec<f64> = (0..2000).map(stamp).collect();
            let axis = inspected(&t);
            assert!(axis.1.is_empty(), "{early_every}: {:?}", axis.1);
            assert!((axis.0.unwrap() / 500.0 - 1.0).abs() < 1e-5, "{:?}", axis.0);
            // a sample that is missing among them is seen
            let mut lost = t.clone();
            lost.remove(1000);
            assert_eq!(codes(&inspected(&lost))[0], "dropped_samples");
        }
        // a sample that is repeated, and one that is missing, in stamps of a tenth of the step
        let mut t = uniform(1000, 1e-3);
        t[500] = t[499];
        t[700] += 1e-4;
        assert!(codes(&inspected(&t)).contains(&"repeated_samples"));
    }

    #[test]
    fn an_irregular_axis_is_reported() {
        let t: Vec<f64> = uniform(1000, 1e-3).iter().map(|t| t * t).collect();
        assert_eq!(codes(&inspected(&t)), ["time_not_uniform"]);
    }

    #[test]
    fn a_clock_that_drifts_is_reported() {
        let drift = |by: f64| -> Vec<f64> {
            let t = uniform(2000, 1e-3);
            t.iter().map(|t| t * (1.0 + by * t)).collect()
        };
        assert!(inspected(&drift(1e-4)).1.is_empty());
        assert_eq!(codes(&inspected(&drift(0.02))), ["time_not_uniform"]);
    }
}
