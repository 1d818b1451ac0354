//! What is wrong with the samples of a record: unequal lengths, missing values, dead, clipped
//! and held channels.

use std::borrow::Cow;
use std::ops::Range;

use super::gaps::{self, AROUND, FEWEST_SAMPLES, runs};
use super::held;
use super::spikes::without_spikes;
use super::{Channel, Excitation, Flag, Problem, Record, Role, time_axis};
use crate::signal::{columns, interpolation, robust, whole};

/// Part of a channel's samples at the rail above which the record is left out.
const CLIPPED_PART: f64 = 0.005;

/// Relative difference of lengths above which the record is left out.
const LENGTH_DIFFERENCE: f64 = 0.01;

/// Cut all channels to the shortest, as those of a record are of one length also where they have no shared times.
pub(super) fn cut_to_shortest(record: &mut Record) {
    if let Some(shortest) = record.channels.iter().map(|c| c.values.len()).min() {
        cut(record, shortest);
    }
}

fn cut(record: &mut Record, samples: usize) {
    for channel in &mut record.channels {
        channel.values.truncate(samples);
    }
}

/// Cut all channels and the time axis to the shortest.
pub(super) fn equal_lengths(record: &mut Record, times: Option<&mut Vec<f64>>) {
    let of_time = times.as_ref().map(|t| t.len());
    let lengths = || {
        record
            .channels
            .iter()
            .map(|c| c.values.len())
            .chain(of_time)
    };
    let (Some(shortest), Some(longest)) = (lengths().min(), lengths().max()) else {
        return;
    };
    if shortest == longest {
        return;
    }
    let short = record.channels.iter().find(|c| c.values.len() == shortest);
    let short = short.map(|c| c.name.clone());
    cut(record, shortest);
    if let Some(times) = times {
        times.truncate(shortest);
    }
    let found = Flag::new(
        short.as_deref(),
        Problem::LengthsDiffer { shortest, longest },
    );
    let much = (longest - shortest) as f64 > LENGTH_DIFFERENCE * longest as f64;
    record.flags.push(found.excluding(much));
}

/// Cut samples off both ends if a channel has no value there (exports often pad so).
pub(super) fn trim_missing(record: &mut Record, times: Option<&mut Vec<f64>>) {
    let samples = record.samples();
    if samples == 0 {
        return;
    }
    let whole = |i: usize| record.channels.iter().all(|c| c.values[i].is_finite());
    let Some(first) = (0..samples).find(|i| whole(*i)) else {
        record.flags.push(never_whole(record));
        return;
    };
    let last = (first..samples).rev().find(|i| whole(*i)).unwrap_or(first);
    let cut = first + samples - 1 - last;
    if cut == 0 {
        return;
    }
    let lacking = record.channels.iter().find(|c| {
        c.values[..first]
            .iter()
            .chain(&c.values[last + 1..])
            .any(|v| !v.is_finite())
    });
    let name = lacking.map(|c| c.name.clone());
    for channel in &mut record.channels {
        keep(&mut channel.values, first, last);
    }
    if let Some(times) = times {
        keep(times, first, last);
    }
    record.flags.push(trimmed(name, cut));
}

/// Leave out the start of a record: what is wrong with it and with its time axis there does not count.
pub(super) fn skip(record: &mut Record, times: Option<&mut Vec<f64>>, skip_s: f64) {
    if skip_s <= 0.0 {
        return;
    }
    let step = times
        .as_deref()
        .and_then(|times| time_axis::usual_step(times));
    let step_s = step.unwrap_or(record.sample_rate_hz.recip());
    let count = match &times {
        Some(times) => {
            let before = |t: &&f64| **t - times[0] < skip_s - 0.5 * step_s;
            times.iter().take_while(before).count()
        }
        None => whole::index((skip_s / step_s).round()),
    };
    if count == 0 || record.samples() == 0 {
        return;
    }
    if count >= record.samples() {
        // to the nanosecond: steps of printed times are no exact numbers
        let duration_s = (1e9 * record.samples() as f64 * step_s).round() / 1e9;
        let problem = Problem::AllSkipped { duration_s, skip_s };
        record.flags.push(Flag::new(None, problem));
    }
    for channel in &mut record.channels {
        channel.values.drain(..count.min(channel.values.len()));
    }
    if let Some(times) = times {
        times.drain(..count.min(times.len()));
    }
}

/// The range of a channel's samples without those that have no value at its ends; all where none has one.
pub(super) fn filled(values: &[f64]) -> (usize, usize) {
    let first = values.iter().position(|v| v.is_finite());
    let last = values.iter().rposition(|v| v.is_finite());
    first
        .zip(last)
        .map_or((0, values.len()), |(first, last)| (first, last + 1))
}

fn never_whole(record: &Record) -> Flag {
    let worst = record
        .channels
        .iter()
        .max_by_key(|c| c.values.iter().filter(|v| !v.is_finite()).count())
        .map(|c| c.name.clone());
    Flag::new(worst.as_deref(), Problem::NoCompleteSample)
}

fn trimmed(channel: Option<String>, count: usize) -> Flag {
    Flag::new(channel.as_deref(), Problem::EndsCutOff { count }).excluding(false)
}

fn keep(values: &mut Vec<f64>, first: usize, last: usize) {
    values.truncate(last + 1);
    values.drain(..first);
}

/// Check every channel: values that are no numbers, dead and clipped channels, held samples.
/// `ranges`: greatest magnitude the converter gives, SI, per channel. `driven`: whether a drive
/// must be seen.
pub(super) fn inspect(record: &mut Record, ranges: &[Option<f64>], driven: bool) {
    if record.channels.is_empty() || record.samples() == 0 {
        record.flags.push(no_samples(record));
        return;
    }
    if let Some(flag) = too_short(record, driven) {
        record.flags.push(flag);
        return;
    }
    let mut flags = Vec::new();
    if !driven {
        let excitation = record.setting.excitation;
        if excitation == Excitation::FreeDecay {
            flags.extend(record.channels.iter_mut().filter_map(held::without_held));
        }
        let channels = record.channels.iter_mut();
        flags.extend(channels.filter_map(|channel| gaps::fill(channel, excitation)));
    }
    let rate_hz = record.sample_rate_hz;
    let crests = Crests {
        excitation: record.setting.excitation,
    };
    let in_parts = !driven && !gaps::parts(record).is_empty();
    for (channel, range) in record.channels.iter().zip(ranges) {
        // between impacts and after blows what lies outside of a gap stands for itself
        let missing = match channel.role.is_motion() && in_parts {
            true => gaps::left_out(channel),
            false => not_numbers(channel),
        };
        let of_values = if missing.as_ref().is_some_and(|flag| flag.excludes) {
            None
        } else {
            let whole = match missing {
                Some(_) => Cow::Owned(with_values(channel)),
                None => Cow::Borrowed(channel),
            };
            let span = Span::of(&whole.values);
            dead(&whole, &span, driven).or_else(|| clipped(&whole, &span, crests, *range, rate_hz))
        };
        let found = missing.into_iter().chain(of_values);
        // What is wrong with a frame's channel leaves no record out.
        flags.extend(found.map(|flag| Flag {
            excludes: flag.excludes && !channel.role.is_frame(),
            ..flag
        }));
    }
    if flags.is_empty() && driven {
        // Without a drive a body comes to rest.
        flags.extend(held(record));
    }
    let displacements =
        |c: &&mut Channel| matches!(c.role, Role::DisplacementX | Role::DisplacementY);
    let moving = record.channels.iter_mut().filter(displacements);
    let frozen: Vec<Flag> = moving.filter_map(without_frozen).collect();
    // one camera takes all of them
    flags.extend(frozen.into_iter().next());
    let spikes = record.channels.iter_mut().filter_map(without_spikes);
    flags.extend(spikes);
    record.flags.extend(flags);
}

/// Part of the way that a motion would have made while the picture stood still, at the lesser of the speeds before and
/// after, from which its jump is the motion that went on unseen: that makes the whole way or more, less the step of
/// rounding in the twenty or more of two samples. A body that rests and then moves on jumps by one sample's way, half of it
/// or less. The value is between them.
const UNSEEN_PART: f64 = 2.0 / 3.0;

/// Steps of the converter a sample from which a motion does not rest by rounding, for which half a step suffices, nor by
/// noise of up to two steps: its difference of two samples would have to cancel these ten steps twice in a row, at 3.5 of
/// its deviations each.
const STEPS_A_SAMPLE: f64 = 10.0;

/// Displacements that stand still in the midst of a motion and then jump by as much as it would have gone on: a camera
/// that repeats pictures. What moves by many steps of the converter a sample cannot rest by its rounding. Repeated
/// pictures, which show the motion late, are replaced by a polynomial through those around them.
fn without_frozen(channel: &mut Channel) -> Option<Flag> {
    let frozen = frozen_stretches(&channel.values);
    let (first, length) = *frozen.first()?;
    let values = &mut channel.values;
    let replaced = frozen.iter().filter(|s| interpolate(values, &frozen, **s));
    let replaced = replaced.count();
    let problem = Problem::FrozenPictures {
        channel: channel.name.clone(),
        count: frozen.len(),
        samples: length + 1,
        first,
        interpolated: replaced,
    };
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// Replace the repeated pictures of a stretch by Lagrange's polynomial through those around it; whether they could be.
fn interpolate(
    values: &mut [f64],
    all: &[(usize, usize)],
    (first, length): (usize, usize),
) -> bool {
    let repeated = |i: usize| {
        all.iter()
            .any(|(from, n)| (from + 1..=from + n).contains(&i))
    };
    let before = (0..=first).rev().filter(|i| !repeated(*i)).take(AROUND);
    let after = (first + length + 1..values.len()).filter(|i| !repeated(*i));
    let nodes: Vec<usize> = before.chain(after.take(AROUND)).collect();
    if length > AROUND || nodes.len() < 2 * AROUND {
        return false;
    }
    let places = first + 1..=first + length;
    let between: Vec<f64> = places
        .map(|i| interpolation::through(values, &nodes, i))
        .collect();
    values[first + 1..=first + length].copy_from_slice(&between);
    true
}

/// Chance that noise alone makes as many samples stand still.
const BY_CHANCE: f64 = 1e-3;

/// Where samples stand still although the motion goes on: the first sample and the number of steps. Noise of many steps of
/// the converter makes a sample repeat the one before by chance, but a short way as often as none: of the steps up to half
/// of the motion's, one in as many as there are digits in that is none.
fn frozen_stretches(values: &[f64]) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> = stretches(values).filter(|(_, n)| *n > 0).collect();
    if found.is_empty() {
        return found;
    }
    let step = |i: usize| values[i + 1] - values[i];
    let (low, high) = columns::extremes(values);
    let moving = STEPS_A_SAMPLE * columns::least_step(values, 1e-12 * (high - low));
    // the motion's way a sample where it goes on by what was not seen, and the number of steps
    let short_way = |(i, still): (usize, usize)| {
        // a short step is looked at as one that might have been none
        let length = still.max(1);
        let after = i + length;
        if after + 2 >= values.len() {
            return None;
        }
        let (before, jump, next) = (step(i - 1), step(after), step(after + 1));
        let way = before.abs().min(next.abs());
        let unseen = UNSEEN_PART * (length + 1) as f64 * way;
        let fast = way >= moving && before * next > 0.0;
        let short = step(i).abs() <= 0.5 * way;
        let goes_on = before * jump > 0.0 && jump.abs() >= unseen;
        (fast && short && goes_on).then_some((way, length))
    };
    found.retain(|stretch| short_way(*stretch).is_some());
    if found.is_empty() {
        return found;
    }
    let short_ways = stretches(values).filter_map(short_way);
    // of values that are no multiples of a digit none equals another by chance
    let digit = columns::digit(values);
    let digit = if are_multiples(values, digit) {
        digit
    } else {
        0.0
    };
    let chance = |(way, length): (f64, usize)| {
        let each = (digit / way).min(1.0);
        each.powi(i32::try_from(length).unwrap_or(i32::MAX))
    };
    let expected = short_ways.map(chance).sum();
    if at_least(found.len(), expected) > BY_CHANCE {
        found.clear();
    }
    found
}

/// Every sample but the first and the last at which values do not stand still, or begin to, with the number of steps for
/// which they do.
fn stretches(values: &[f64]) -> impl Iterator<Item = (usize, usize)> {
    let stretch = |i: usize| {
        let pairs = values.get(i..)?.windows(2);
        let still = pairs.clone().take_while(|pair| pair[0] == pair[1]);
        (pairs.len() > 0).then(|| (i, still.count()))
    };
    std::iter::successors(stretch(1), move |(i, still)| stretch(i + still + 1))
}

/// Whether values are apart by multiples of a digit, but for some.
fn are_multiples(values: &[f64], digit: f64) -> bool {
    let off = |v: &&f64| {
        let digits = (**v - values[0]) / digit;
        (digits - digits.round()).abs() > 0.05
    };
    // of any values a tenth are so near to multiples
    2 * values.iter().filter(off).count() < values.len()
}

/// Chance of so many events or more where a number is expected (Poisson's distribution).
fn at_least(count: usize, expected: f64) -> f64 {
    let terms = std::iter::successors(Some((0usize, (-expected).exp())), |(k, chance)| {
        Some((k + 1, chance * expected / (k + 1) as f64))
    });
    // what follows these is negligible
    let last = count + 50 + whole::index(4.0 * expected);
    terms.take(last).skip(count).map(|(_, chance)| chance).sum()
}

fn no_samples(record: &Record) -> Flag {
    let problem = if record.channels.is_empty() {
        Problem::NoUsableChannel
    } else {
        Problem::NoSamples
    };
    Flag::new(None, problem)
}

fn not_numbers(channel: &Channel) -> Option<Flag> {
    if columns::all_finite(&channel.values) {
        return None;
    }
    let count = channel.values.iter().filter(|v| !v.is_finite()).count();
    let first = channel.values.iter().position(|v| !v.is_finite())?;
    let problem = Problem::MissingValues {
        channel: channel.name.clone(),
        count,
        first,
    };
    Some(Flag::new(Some(&channel.name), problem))
}

/// A channel without the samples that have no value.
fn with_values(channel: &Channel) -> Channel {
    let finite = channel.values.iter().copied().filter(|v| v.is_finite());
    Channel {
        values: finite.collect(),
        ..channel.clone()
    }
}

/// Least and greatest value and the smallest step between neighbours that is not zero.
struct Span {
    low: f64,
    high: f64,
    step: f64,
}

impl Span {
    fn of(values: &[f64]) -> Self {
        let (low, high) = columns::extremes(values);
        Self {
            low,
            high,
            step: columns::least_step(values, 1e-12 * (high - low)),
        }
    }
}

/// A record of so few samples that none of its channels can be judged.
fn too_short(record: &Record, driven: bool) -> Option<Flag> {
    let samples = record.samples();
    let is_dead =
        |c: &Channel| !c.role.is_frame() && dead(c, &Span::of(&c.values), driven).is_some();
    if samples >= FEWEST_SAMPLES || !record.channels.iter().any(is_dead) {
        return None;
    }
    let problem = match samples {
        1 => Problem::SingleSample,
        samples => Problem::FewSamples { samples },
    };
    Some(Flag::new(None, problem))
}

/// A channel that shows nothing but one value or two neighbouring steps of the converter. A
/// contact may well stay open.
fn dead(channel: &Channel, span: &Span, driven: bool) -> Option<Flag> {
    if channel.role == Role::Contact || (channel.role == Role::Drive && !driven) {
        return None;
    }
    let Span { low, high, step } = *span;
    if high > low && high - low > 1.001 * step {
        return None;
    }
    let problem = Problem::ConstantChannel {
        channel: channel.name.clone(),
        level: low,
        dimension: channel.dimension,
    };
    Some(Flag::new(Some(&channel.name), problem))
}

/// A channel that runs into the rails of its converter: at its greatest or least value it stays
/// for three samples or more and got there by a step that no quantised crest makes.
fn clipped(
    channel: &Channel,
    span: &Span,
    crests: Crests,
    range: Option<f64>,
    rate_hz: f64,
) -> Option<Flag> {
    if channel.role == Role::Contact {
        return None;
    }
    let Span { low, high, step } = *span;
    // Where the converter's range is stated, only samples at its end are clipped: a coarse
    // converter rests on one code at the top of any slow wave.
    let end = range.map(|r| (r - 1.5 * step).max(r * (1.0 - 1e-9) - 2.0 * step));
    let spikes = spikes_at_rails(channel, span, end, rate_hz);
    let all: usize = match end {
        Some(end) => channel.values.iter().filter(|v| v.abs() >= end).count(),
        None => at_rails(channel, span, crests),
    };
    let counted = spikes.iter().filter(|s| end.is_some() || s.len() >= 3);
    let count = all - counted.map(Range::len).sum::<usize>().min(all);
    if count == 0 {
        return clipped_spikes(channel, &spikes, end.is_some());
    }
    let name = channel.name.clone();
    let dimension = channel.dimension;
    if crests.excitation == Excitation::FreeDecay && channel.role.is_motion() {
        // what follows the clipped swings is a decay too
        let problem = Problem::ClippedSwings {
            channel: name,
            count,
            low,
            high,
            dimension,
        };
        return Some(Flag::new(Some(&channel.name), problem).excluding(false));
    }
    let share = count as f64 / channel.values.len() as f64;
    let problem = Problem::ClippedSamples {
        channel: name,
        count,
        share,
        low,
        high,
        dimension,
    };
    let excludes = share > CLIPPED_PART && channel.role != Role::Drive;
    Some(Flag::new(Some(&channel.name), problem).excluding(excludes))
}

/// Time in which an acceleration rises from half a rail to it at an impact, and two samples at least, s.
const SPIKE_RISES_S: f64 = 3e-4;

/// The runs of samples at a rail in which an acceleration shows an impact: shortly before and after them it is
/// below half of the rail.
fn spikes_at_rails(
    channel: &Channel,
    span: &Span,
    end: Option<f64>,
    rate_hz: f64,
) -> Vec<Range<usize>> {
    if !matches!(channel.role, Role::AccelerationX | Role::AccelerationY) {
        return Vec::new();
    }
    let values = &channel.values;
    let at_rail = |v: f64| match end {
        Some(end) => v.abs() >= end,
        None => v != 0.0 && (v == span.low || v == span.high),
    };
    let reach = whole::index((SPIKE_RISES_S * rate_hz).round()).max(2);
    // A wave stays within three times its root mean square; short spikes are beyond it.
    let least = 3.0 * robust::rms(values);
    let at_rail = |v: f64| v.abs() > least && at_rail(v);
    let spikes = runs(values, at_rail).filter(|run| {
        let below = |i: Option<usize>| {
            let beside = i.and_then(|i| values.get(i));
            beside.is_none_or(|v| v.abs() < 0.5 * values[run.start].abs())
        };
        below(run.start.checked_sub(reach)) && below(Some(run.end + reach - 1))
    });
    spikes.collect()
}

/// Impacts at which an acceleration is clipped: at the end of the stated range; else at one and the same greatest
/// value, which three impacts do not have by chance, nor two samples of one.
fn clipped_spikes(channel: &Channel, spikes: &[Range<usize>], stated: bool) -> Option<Flag> {
    let alike = spikes.len() >= 3 || spikes.iter().any(|s| s.len() > 1);
    let first = spikes.first().filter(|_| stated || alike)?;
    let problem = Problem::ClippedSpikes {
        channel: channel.name.clone(),
        count: spikes.len(),
        level: channel.values[first.start],
        dimension: channel.dimension,
    };
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// Number of samples at both rails. A mass that rests at its stop shows a plateau of displacement
/// at one side, which is no rail, unless it leaves it as a cut crest does.
fn at_rails(channel: &Channel, span: &Span, crests: Crests) -> usize {
    let ends = [span.low, span.high];
    let rails = ends.map(|rail| at_rail(&channel.values, rail, span.step));
    let displacement = matches!(channel.role, Role::DisplacementX | Role::DisplacementY);
    let is_cut = |rail: &f64| crests.are_cut(&channel.values, *rail);
    if displacement && rails.contains(&0) && !ends.iter().any(is_cut) {
        0
    } else {
        rails[0] + rails[1]
    }
}

/// What shows that crests of a displacement are cut off at a value: in a free decay, where no stop is, the motion leaves
/// it as fast as it came; of a driven motion it leaves it at speed, while a mass that rested starts from none.
#[derive(Debug, Clone, Copy)]
struct Crests {
    excitation: Excitation,
}

/// Greatest ratio of the second step of a motion to its first one behind a cut crest. A body that starts from rest within
/// a step has 5/3 at least, a parabola that is cut for three samples or more 7/5 at most.
const AT_SPEED: f64 = 1.5;

impl Crests {
    /// Whether crests are cut off at a value.
    fn are_cut(self, values: &[f64], rail: f64) -> bool {
        let inner = runs(values, |v| v == rail)
            .filter(|run| run.len() >= 3 && run.start >= 2 && run.end + 2 < values.len());
        let ratio = |run: Range<usize>| {
            let step = |i: usize| values[i + 1] - values[i];
            let after = step(run.end);
            match self.excitation {
                Excitation::FreeDecay => -after / step(run.start - 2),
                Excitation::Harmonic => step(run.end + 1) / after,
            }
        };
        let ratios: Vec<f64> = inner.map(ratio).collect();
        // before the one crest of a decay the mass was not held
        let (fewest, cut) = match self.excitation {
            Excitation::FreeDecay => (1, 0.5..1.5),
            Excitation::Harmonic => (3, 0.0..AT_SPEED),
        };
        ratios.len() >= fewest && robust::median(&ratios).is_some_and(|r| cut.contains(&r))
    }
}

/// Whether a crest that goes on as the values beside a run at a rail do would rise above it by more than the steps of the
/// converter explain: where they fall by d next to the run of n samples and by s in the step after, a parabola
/// rises s (n+1)²/4(n+2) above the first of them, and d is what is seen of it.
fn is_cut_off(values: &[f64], run: &Range<usize>, step: f64) -> bool {
    let inner = run.start >= 2 && run.end + 1 < values.len();
    if !inner {
        return true;
    }
    let rail = values[run.start];
    let sides = [(run.start - 1, run.start - 2), (run.end, run.end + 1)];
    let seen = sides.map(|(next, _)| (values[next] - rail).abs());
    let slope = sides.map(|(next, after)| (values[next] - values[after]).abs());
    let n = run.len() as f64;
    let share = 0.25 * (n + 1.0).powi(2) / (n + 2.0);
    let rises = |i: usize| share * slope[i].max(seen[i]) - seen[i];
    0.5 * (rises(0) + rises(1)) > (2.0 + share) * step
}

/// Number of samples in runs at a rail that were entered and left in motion, by more than a crest's
/// steps. A body at rest is no rail: at zero, or before or after its motion.
fn at_rail(values: &[f64], rail: f64, step: f64) -> usize {
    if rail == 0.0 {
        return 0;
    }
    let steep = |i: Option<usize>| {
        let beside = i.and_then(|i| values.get(i));
        beside.is_some_and(|v| (v - rail).abs() > 3.0 * step)
    };
    runs(values, |v| v == rail)
        .filter(|run| run.len() >= 3)
        .filter(|run| steep(run.start.checked_sub(1)) && steep(Some(run.end)))
        .filter(|run| is_cut_off(values, run, step))
        .map(|run| run.len())
        .sum()
}

/// A stretch in which every channel holds its value: samples were lost and the converter
/// repeated the last.
fn held(record: &Record) -> Option<Flag> {
    if record.channels.len() < 2 {
        return None;
    }
    let still = |i: usize| {
        record
            .channels
            .iter()
            .all(|c| c.values[i] == c.values[i - 1])
    };
    let (mut longest, mut run, mut at, mut all) = (0, 0, 0, 0);
    for i in 1..record.samples() {
        run = if still(i) { run + 1 } else { 0 };
        all += usize::from(run > 0);
        if run > longest {
            (longest, at) = (run, i - run);
        }
    }
    if longest < 6 || all > longest * 8 {
        return None;
    }
    let problem = Problem::HeldSamples {
        samples: longest,
        first: at,
    };
    Some(Flag::new(None, problem))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    use super::*;
    use crate::record::FlagCode;
    use crate::record::gaps::gapped_record;

    fn sine(i: usize) -> f64 {
        (0.05 * i as f64).sin()
    }

    fn record(of: impl Fn(usize) -> f64) -> Record {
        let values: Vec<f64> = (0..1000).map(of).collect();
        let drive: Vec<f64> = (0..1000).map(|i| (0.07 * f64::from(i)).cos()).collect();
        Record::of(2000.0, &[(Role::Drive, &drive), (Role::VelocityX, &values)])
    }

    fn inspected(mut record: Record, ranges: &[Option<f64>]) -> Vec<Flag> {
        inspect(&mut record, ranges, true);
        record.flags
    }

    /// An accelerometer's flags for a wave of 10 with a spike every 100 samples, clipped at a value.
    fn of_spikes(rail: f64, ranges: [Option<f64>; 2], width: usize) -> Vec<Flag> {
        let value = |i: usize| match i % 100 {
            k if (40..40 + width).contains(&k) => (-600.0 - i as f64).max(rail),
            _ => 10.0 * sine(i),
        };
        let mut record = record(value);
        record.channels[1].role = Role::AccelerationX;
        inspected(record, &ranges)
    }

    #[test]
    fn clipped_spikes_of_an_accelerometer_are_named_and_leave_its_record_in() {
        for (ranges, width) in [
            ([None, None], 1),
            ([None, None], 4),
            ([None, Some(500.0)], 1),
        ] {
            let flags = of_spikes(-500.0, ranges, width);
            assert_eq!(flags.len(), 1, "{ranges:?} {width}");
            assert!(!flags[0].excludes);
            assert_eq!(
                flags[0].message(),
                "channel 'velocity_x' is clipped at 10 impacts, at -500 m/s: what its spikes add up to is \
                 not the jump of the velocity"
            );
        }
        // Whole spikes differ from each other; a wave that is cut leaves the record out as ever.
        assert!(of_spikes(-9e9, [None, None], 1).is_empty());
        let mut cut = record(|i| sine(i).clamp(-0.9, 0.9));
        cut.channels[1].role = Role::AccelerationX;
        assert!(inspected(cut, &[None, None])[0].excludes);
    }

    #[test]
    fn a_record_of_two_samples_is_too_short_and_not_dead() {
        let values = [-10.707_03, 10.624_33];
        let mut record = Record::of(
            1000.0,
            &[(Role::VelocityX, &values), (Role::Drive, &values)],
        );
        inspect(&mut record, &[None, None], true);
        let found: Vec<_> = record.flags.iter().map(|f| f.code).collect();
        assert_eq!(found, [FlagCode::TooFewSamples]);
        assert_eq!(
            record.flags[0].message(),
            "the record is too short: 2 samples"
        );
        assert!(record.excluded());
    }

    #[test]
    fn each_defect_of_samples_has_its_flag() {
        let code = |of: &dyn Fn(usize) -> f64| {
            let flags = inspected(record(of), &[None, None]);
            flags.first().map(|f| f.code)
        };
        assert_eq!(code(&sine), None);
        assert_eq!(code(&|_| 0.25), Some(FlagCode::DeadChannel));
        let gap = |i: usize| if i == 7 { f64::NAN } else { sine(i) };
        assert_eq!(code(&gap), Some(FlagCode::NotANumber));
        // A sine cut at 0.9 stays there for 18 samples of every crest: 2 · 0.451/0.05.
        assert_eq!(code(&|i| sine(i).clamp(-0.9, 0.9)), Some(FlagCode::Clipped));
    }

    #[test]
    fn an_honest_sine_of_twelve_bits_that_dwells_at_its_crests_is_not_clipped() {
        // ±10 V in 4096 steps, printed with five decimals: steps of 0.00488 and 0.00489
        for k in 600..700 {
            let sine = |i: usize| {
                let phase = (0.004 + 5e-5 * f64::from(k)) * i as f64 + f64::from(k);
                let volts = (3.0 + 0.0045 * f64::from(k)) * phase.sin();
                let converted = (volts * 204.8).round() / 204.8;
                (converted * 1e5).round() / 1e5
            };
            assert_eq!(inspected(record(sine), &[None, None]), [], "{k}");
        }
    }

    #[test]
    fn a_cart_at_rest_is_not_clipped() {
        // It rests at zero for a third of the record, is pushed to 0.5 m/s, and stands still at the end.
        let speed = |i: usize| match i {
            i if i < 330 => 0.0,
            i if i < 360 => (i - 330) as f64 / 60.0,
            i if i < 800 => 0.5 - 1e-4 * (i - 360) as f64,
            _ => 0.0,
        };
        assert_eq!(inspected(record(speed), &[None, None]), []);
        // Turned around, zero is its greatest value.
        assert_eq!(inspected(record(|i| -speed(i)), &[None, None]), []);
        // An accelerometer that rests off zero before a blow and after it.
        let blow = |i: usize| {
            if (400..420).contains(&i) {
                sine(7 * i)
            } else {
                -1.1
            }
        };
        assert_eq!(inspected(record(blow), &[None, None]), []);
    }

    #[test]
    fn a_few_clipped_samples_do_not_exclude_a_record() {
        // One crest above a stated range of 0.999: 2 · arccos(0.999)/0.05 = 1.8 samples.
        let once = |i: usize| {
            if i < 60 {
                sine(i).min(0.999)
            } else {
                0.5 * sine(i)
            }
        };
        let flags = inspected(record(once), &[None, Some(0.999)]);
        assert_eq!(flags[0].code, FlagCode::Clipped);
        assert!(!flags[0].excludes);
        let all = inspected(record(|i| sine(i).clamp(-0.9, 0.9)), &[None, Some(0.9)]);
        assert!(all[0].excludes);
    }

    #[test]
    fn samples_that_all_channels_hold_were_lost() {
        let mut held = record(sine);
        for channel in &mut held.channels {
            let last = channel.values[499];
            channel.values[500..520].fill(last);
        }
        let flags = inspected(held, &[None, None]);
        assert_eq!(flags[0].code, FlagCode::DroppedSamples);
        assert!(
            flags[0].message().contains("20 samples from sample 499"),
            "{}",
            flags[0].message()
        );
    }

    #[test]
    fn valid_crests_cut_off_at_one_end_are_told_from_a_stop() {
        let decay = |i: usize| (0.1 * i as f64).sin() * (-0.002 * i as f64).exp();
        let cut: Vec<f64> = (0..1000).map(|i| decay(i).max(-0.6)).collect();
        let mut record = Record::of(100.0, &[(Role::DisplacementX, &cut)]);
        inspect(&mut record, &[None], false);
        assert_eq!(record.flags[0].code, FlagCode::Clipped);
        assert!(record.excluded());
        let clipped = |displacement: fn(u32) -> f64| {
            let values: Vec<f64> = (0..1000).map(displacement).collect();
            let mut record = Record::of(100.0, &[(Role::DisplacementX, &values)]);
            inspect(&mut record, &[None], false);
            record.flags.iter().any(|f| f.code == FlagCode::Clipped)
        };
        // a motion that comes back slower than it went
        assert!(clipped(|i| {
            let phase = 0.1 * f64::from(i);
            (phase.sin() + 0.4 * (2.0 * phase).cos()).max(-0.9)
        }));
        // a mass that meets a stop and rests there until it is drawn away
        assert!(!clipped(|i| match i % 60 {
            k @ 0..20 => 17.03 - f64::from(k) + 1e-3 * f64::from(i),
            20..30 => -3.0,
            k => 0.02 * f64::from(k - 29).powi(2) - 3.0,
        }));
    }

    #[test]
    fn channels_that_are_not_put_together_are_of_one_length_and_can_be_looked_at() {
        let count: Vec<f64> = (0..400).map(f64::from).collect();
        let channels: [(Role, &[f64]); 2] =
            [(Role::VelocityX, &count), (Role::DisplacementX, &count)];
        let mut record = Record::of(100.0, &channels);
        record.channels[1].values.truncate(200);
        cut_to_shortest(&mut record);
        inspect(&mut record, &[None, None], false);
        assert_eq!(record.channels[0].values.len(), 200);
    }

    #[test]
    fn one_crest_of_a_free_decay_that_is_cut_off_is_named_and_a_mass_that_was_held_is_not() {
        let flags = |values: Vec<f64>| {
            let mut record = Record::of(100.0, &[(Role::DisplacementX, &values)]);
            record.setting.excitation = Excitation::FreeDecay;
            inspect(&mut record, &[None], false);
            record.flags
        };
        let decay = |i: usize| (0.1 * i as f64).cos() * (-0.015 * i as f64).exp();
        let cut = flags((0..1000).map(|i| decay(i).max(-0.5)).collect());
        let Problem::ClippedSwings { low, count, .. } = cut[0].problem else {
            panic!("{cut:?}");
        };
        assert_eq!(low, -0.5);
        assert!(count > 10 && !cut[0].excludes, "{cut:?}");
        let held = |i: usize| decay(i.saturating_sub(200));
        assert_eq!(flags((0..1000).map(held).collect()), []);
    }

    #[test]
    fn a_picture_that_stands_still_in_the_midst_of_a_motion_is_named() {
        let moving: Vec<f64> = (0..300).map(|i| sine(i) + 1e-3 * (i % 7) as f64).collect();
        let mut frozen = moving.clone();
        let last = frozen[100];
        frozen[101..104].fill(last);
        assert_eq!(frozen_stretches(&moving), []);
        assert_eq!(frozen_stretches(&frozen), [(100, 3)]);
        // a coarse converter rests at each of its steps
        let coarse: Vec<f64> = (0..300).map(|i| (sine(i) / 0.2).round() * 0.2).collect();
        assert_eq!(frozen_stretches(&coarse), []);
        // noise of some printed digits makes neighbours equal by chance
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let noise = Normal::new(0.0, 8.0).expect("a deviation");
        let printed: Vec<f64> = (0..20_000)
            .map(|i| (1e4 * (5e-3 * f64::from(i)).sin() + noise.sample(&mut random)).round())
            .collect();
        assert_eq!(frozen_stretches(&printed), []);
        // a ball at rest before it is let go
        let let_go: Vec<f64> = (0..100)
            .map(|i| f64::from((i - 50).max(0)).powi(2))
            .collect();
        assert_eq!(frozen_stretches(&let_go), []);
        let mut record = Record::of(30.0, &[(Role::DisplacementX, &frozen)]);
        inspect(&mut record, &[None], false);
        assert_eq!(
            record.flags[0].message(),
            "channel 'displacement_x' stands still 1 times in the midst of a motion and then jumps, the first \
             time for 4 samples from sample 100 on: its pictures were frozen (1 of these are interpolated)"
        );
        let off = record.channels[0].values.iter().zip(&moving);
        let off = off
            .map(|(found, whole)| (found - whole).abs())
            .fold(0.0, f64::max);
        assert!(off < 0.02, "{off}");
    }

    #[test]
    fn valid_single_repeated_pictures_are_replaced_by_the_motion_between_their_neighbours() {
        // 2 Hz at 30 pictures a second, every seventh repeated
        let whole: Vec<f64> = (0..300).map(|i| (0.42 * f64::from(i)).sin()).collect();
        let repeated: Vec<f64> = (0..300)
            .map(|i| whole[i - usize::from(i % 7 == 6)])
            .collect();
        let mut record = Record::of(30.0, &[(Role::DisplacementX, &repeated)]);
        inspect(&mut record, &[None], false);
        assert_eq!(record.flags[0].code, FlagCode::FrozenFrames);
        let off = |values: &[f64]| {
            let apart: Vec<f64> = values.iter().zip(&whole).map(|(v, w)| v - w).collect();
            robust::rms(&apart)
        };
        let (before, after) = (off(&repeated), off(&record.channels[0].values));
        // next to a turn a repeated picture is not told from a motion that turns
        assert!(after < 0.5 * before, "{after} {before}");
    }

    #[test]
    fn ends_without_values_are_cut_and_lengths_made_equal() {
        let mut padded = record(|i| {
            if (3..990).contains(&i) {
                sine(i)
            } else {
                f64::NAN
            }
        });
        let mut times: Vec<f64> = (0..1000).map(f64::from).collect();
        trim_missing(&mut padded, Some(&mut times));
        assert_eq!((padded.samples(), times.len(), times[0]), (987, 987, 3.0));
        assert_eq!(padded.flags[0].code, FlagCode::Trimmed);
        assert!(!padded.excluded());
        // 5 of 1000 samples less are tolerated, 50 are not.
        for (short, excluded) in [(995, false), (950, true)] {
            let mut unequal = record(sine);
            unequal.channels[1].values.truncate(short);
            equal_lengths(&mut unequal, None);
            assert_eq!(unequal.channels[0].values.len(), short);
            assert_eq!(unequal.flags[0].code, FlagCode::UnequalLengths);
            assert_eq!(unequal.excluded(), excluded);
        }
    }

    #[test]
    fn gaps_are_named_and_leave_an_undriven_record_in() {
        for (driven, count) in [(false, 1), (true, 1)] {
            let mut gapped = gapped_record(std::slice::from_ref(&(300..310)));
            inspect(&mut gapped, &[None], driven);
            assert_eq!(gapped.flags.len(), count);
            assert_eq!(gapped.flags[0].code, FlagCode::NotANumber);
            assert_eq!(gapped.excluded(), driven);
        }
        let mut gapped = gapped_record(std::slice::from_ref(&(300..310)));
        inspect(&mut gapped, &[None], false);
        assert_eq!(
            gapped.flags[0].message(),
            "channel 'velocity_x' has no value at 10 samples in 1 gaps, the first at sample 300: what lies between \
             gaps is used, each part by itself"
        );
    }

    #[test]
    fn valid_gaps_of_up_to_three_samples_are_filled_where_the_motion_is_slow() {
        let mut gapped = gapped_record(&[100..101, 300..303, 990..992]);
        inspect(&mut gapped, &[None], false);
        let values = &gapped.channels[0].values;
        assert!((0..1000).all(|i| (values[i] - sine(i)).abs() < 1e-6));
        assert!(gapped.flags[0].message().contains("at 6 samples in 3 gaps"));
        // five samples a period are too few
        let fast: Vec<f64> = (0..1000)
            .map(|i| {
                if i == 500 {
                    f64::NAN
                } else {
                    (1.2 * f64::from(i)).sin()
                }
            })
            .collect();
        let mut fast = Record::of(100.0, &[(Role::VelocityX, &fast)]);
        inspect(&mut fast, &[None], false);
        assert!(fast.has_gaps());
    }
}
