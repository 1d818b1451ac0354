//! Records with gaps: samples at which a motion channel has no value.

use std::ops::Range;

use super::{Channel, Excitation, Flag, Problem, Record, Role};
use crate::signal::{interpolation, robust};

/// Samples of the shortest record in which a constant channel is told from one that was cut short.
pub(super) const FEWEST_SAMPLES: usize = 16;

/// Samples on either side of a frozen picture between which it is interpolated, and the most that are.
pub(super) const AROUND: usize = 3;

/// Share of the samples that are filled at most.
const FILLED: f64 = 0.1;
/// Root mean square by which a polynomial misses samples that are known, over the motion's, at most.
const MISSED: f64 = 0.05;

/// Fill the gaps of a displacement, a velocity or, of a motion without impacts, an acceleration that are as short as
/// repeated pictures may be, and as well surrounded, where a polynomial through as many samples foretells those that
/// are known.
pub(super) fn fill(channel: &mut Channel, excitation: Excitation) -> Option<Flag> {
    use Role::{AccelerationX, AccelerationY, DisplacementX, DisplacementY, VelocityX, VelocityY};
    let moves = match channel.role {
        DisplacementX | DisplacementY | VelocityX | VelocityY => true,
        AccelerationX | AccelerationY => excitation == Excitation::FreeDecay,
        _ => false,
    };
    let values = &channel.values;
    let whole = |range: Range<usize>| values[range].iter().all(|v| v.is_finite());
    let gaps: Vec<Range<usize>> = runs(values, |v| !v.is_finite())
        .filter(|gap| gap.len() <= AROUND && gap.start >= AROUND)
        .filter(|gap| gap.end + AROUND <= values.len())
        .filter(|gap| whole(gap.start - AROUND..gap.start) && whole(gap.end..gap.end + AROUND))
        .collect();
    let count: usize = gaps.iter().map(Range::len).sum();
    let longest = gaps.iter().map(Range::len).max()?;
    if !moves || count as f64 > FILLED * values.len() as f64 || !foretells(values, longest) {
        return None;
    }
    let problem = Problem::ShortGapsFilled {
        channel: channel.name.clone(),
        count,
        gaps: gaps.len(),
        first: gaps[0].start,
    };
    for gap in gaps {
        for i in gap.clone() {
            channel.values[i] = between(&channel.values, &gap, i);
        }
    }
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// Value of a sample of a gap by Lagrange's polynomial through those around the gap.
fn between(values: &[f64], gap: &Range<usize>, at: usize) -> f64 {
    let around = (gap.start - AROUND..gap.start).chain(gap.end..gap.end + AROUND);
    interpolation::through(values, &around.collect::<Vec<_>>(), at)
}

/// Whether gaps of a length would be filled well where samples are known.
fn foretells(values: &[f64], length: usize) -> bool {
    let span = 2 * AROUND + length;
    let known = values.windows(span).enumerate();
    let known = known.filter(|(_, around)| around.iter().all(|v| v.is_finite()));
    let off = known.map(|(i, _)| {
        let gap = i + AROUND..i + AROUND + length;
        let at = gap.start + length / 2;
        values[at] - between(values, &gap, at)
    });
    let off: Vec<f64> = off.collect();
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    !off.is_empty() && robust::rms(&off) < MISSED * robust::rms_about_mean(&finite)
}

/// Name the gaps of a channel of which what lies between them is used.
pub(super) fn left_out(channel: &Channel) -> Option<Flag> {
    let first = channel.values.iter().position(|v| !v.is_finite())?;
    let missing: Vec<Range<usize>> = runs(&channel.values, |v| !v.is_finite()).collect();
    let problem = Problem::GapsLeftOut {
        channel: channel.name.clone(),
        count: missing.iter().map(Range::len).sum(),
        gaps: missing.len(),
        first,
    };
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// The ranges of samples between gaps at which all channels of motion have values, those that are long enough.
pub(super) fn parts(record: &Record) -> Vec<Range<usize>> {
    let moving: Vec<&Channel> = record
        .channels
        .iter()
        .filter(|c| c.role.is_motion())
        .collect();
    let whole = |i: usize| moving.iter().all(|c| c.values[i].is_finite());
    let parts = stretches(record.samples(), whole);
    parts.filter(|part| part.len() >= FEWEST_SAMPLES).collect()
}

/// The longest stretches of values that pass a test.
pub(super) fn runs(
    values: &[f64],
    test: impl Fn(f64) -> bool,
) -> impl Iterator<Item = Range<usize>> {
    stretches(values.len(), move |i| test(values[i]))
}

/// The longest stretches of the numbers below a count that pass a test.
fn stretches(count: usize, test: impl Fn(usize) -> bool) -> impl Iterator<Item = Range<usize>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = (from..count).find(|i| test(*i))?;
        from = (start..count).find(|i| !test(*i)).unwrap_or(count);
        Some(start..from)
    })
}

impl Record {
    /// Whether a motion channel lacks the values of some samples.
    pub fn has_gaps(&self) -> bool {
        let mut moving = self.channels.iter().filter(|c| c.role.is_motion());
        moving.any(|c| c.values.iter().any(|v| !v.is_finite()))
    }

    /// The parts between its gaps as records of their own without flags, each with the sample at which it begins.
    pub fn between_gaps(&self) -> Vec<(usize, Self)> {
        let part = |range: Range<usize>| {
            let channels = self.channels.iter().map(|channel| Channel {
                values: channel.values[range.clone()].to_vec(),
                ..channel.clone()
            });
            let part = Self {
                id: self.id.clone(),
                channels: channels.collect(),
                setting: self.setting.clone(),
                flags: Vec::new(),
                ..*self
            };
            (range.start, part)
        };
        parts(self).into_iter().map(part).collect()
    }
}

/// A slow motion in an undriven record, with gaps.
#[cfg(test)]
pub(super) fn gapped_record(missing: &[Range<usize>]) -> Record {
    let wave = |i: usize| (0.05 * i as f64).sin();
    let gap = |i: &usize| missing.iter().any(|m| m.contains(i));
    let values: Vec<f64> = (0..1000)
        .map(|i| if gap(&i) { f64::NAN } else { wave(i) })
        .collect();
    let mut record = Record::of(100.0, &[(Role::VelocityX, &values)]);
    record.setting.excitation = super::Excitation::FreeDecay;
    record
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_between_gaps_are_parts_of_their_own() {
        let wave = |i: usize| (0.05 * i as f64).sin();
        let record = gapped_record(&[300..310, 315..316, 700..740]);
        let parts = record.between_gaps();
        let places: Vec<[usize; 2]> = parts.iter().map(|(i, p)| [*i, p.samples()]).collect();
        // five samples between two gaps are none
        assert_eq!(places, [[0, 300], [316, 384], [740, 260]]);
        let (first, part) = &parts[1];
        assert_eq!(part.channels[0].values[3], wave(first + 3));
        assert!(record.has_gaps() && !part.has_gaps());
    }
}
