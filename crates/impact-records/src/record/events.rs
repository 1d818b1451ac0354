//! Contacts that a file states as events: times, intervals, or the sound of them.

use serde::{Deserialize, Serialize};

use super::{Channel, Flag, FlagCode, Record, Role};
use crate::signal::onsets;
use labfiles::units::Dimension;

/// What the contact's channel contains.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactContent {
    /// A signal that jumps while the bodies touch.
    #[default]
    Signal,
    /// The times of the impacts, one in each row.
    Times,
    /// The times between impacts, one in each row.
    Intervals,
    /// A microphone's signal.
    Sound,
}

impl ContactContent {
    /// Whether the rows are impacts, so that there is no time axis.
    pub(super) fn is_list(self) -> bool {
        matches!(self, Self::Times | Self::Intervals)
    }
}

/// Fewest impacts from which flight times can be compared.
const FEWEST: usize = 3;

/// Turn a contact that is stated as events into the times of its impacts, s. The record then has the
/// mean rate of its impacts as its rate.
pub(super) fn settle(record: &mut Record, content: ContactContent) {
    let rate_hz = record.sample_rate_hz;
    let Some(channel) = record.channels.iter_mut().find(|c| c.role == Role::Contact) else {
        return;
    };
    let times = match content {
        ContactContent::Signal => return,
        ContactContent::Times => times(&channel.values),
        ContactContent::Intervals => Ok(added_up(&channel.values)),
        ContactContent::Sound => {
            let found = onsets::find(&channel.values, rate_hz);
            Ok(found.iter().map(|i| i / rate_hz).collect())
        }
    };
    let flag = match times {
        Ok(times) if times.len() >= FEWEST => {
            let span_s = times[times.len() - 1] - times[0];
            record.sample_rate_hz = (times.len() - 1) as f64 / span_s.max(f64::MIN_POSITIVE);
            channel.values = times;
            channel.dimension = Dimension::Time;
            channel.threshold = None;
            record.channels.retain(|c| c.role == Role::Contact);
            return;
        }
        Ok(times) => too_few(channel, times.len(), content),
        Err(row) => not_rising(channel, row),
    };
    record.flags.push(flag);
}

/// The stated times without empty rows at their end; the first row that does not rise as the error.
fn times(values: &[f64]) -> Result<Vec<f64>, usize> {
    let filled: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    match filled.windows(2).position(|w| w[1] <= w[0]) {
        Some(row) => Err(row + 2),
        None => Ok(filled),
    }
}

/// Times from intervals; the list ends at the first that is not positive, as of the last impact.
fn added_up(values: &[f64]) -> Vec<f64> {
    let mut times = vec![0.0];
    let mut sum = 0.0;
    for interval in values.iter().take_while(|v| **v > 0.0) {
        sum += interval;
        times.push(sum);
    }
    times
}

fn too_few(channel: &Channel, found: usize, content: ContactContent) -> Flag {
    let remedy = match content {
        ContactContent::Sound => "record nearer to the impact, or with less noise",
        _ => "let the mass bounce longer",
    };
    Flag::new(
        FlagCode::NoImpact,
        Some(&channel.name),
        format!("{found} impacts, {FEWEST} or more are needed to compare flight times"),
        remedy,
    )
}

fn not_rising(channel: &Channel, row: usize) -> Flag {
    Flag::new(
        FlagCode::TimeBackward,
        Some(&channel.name),
        format!("the time of impact {row} is not after the one before"),
        "name the column with the times of the impacts, or write content = \"intervals\"",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(values: &[f64]) -> Record {
        let mut record = Record::of(100.0, &[(Role::Contact, values)]);
        record.channels[0].threshold = None;
        record
    }

    #[test]
    fn intervals_add_up_to_times_until_one_is_zero() {
        let mut list = record(&[0.5, 0.4, 0.32, 0.0]);
        settle(&mut list, ContactContent::Intervals);
        let times = list.values(Role::Contact).unwrap();
        assert_eq!(times.len(), 4);
        assert!((times[3] - 1.22).abs() < 1e-12);
        assert!((list.sample_rate_hz - 3.0 / 1.22).abs() < 1e-12);
        assert!(list.flags.is_empty());
    }

    #[test]
    fn lists_that_are_none_are_refused_with_the_row() {
        let mut back = record(&[1.0, 2.0, 1.5, 3.0]);
        settle(&mut back, ContactContent::Times);
        assert!(
            back.flags[0].message.contains("impact 3"),
            "{:?}",
            back.flags
        );
        let mut short = record(&[1.0, 2.0, f64::NAN]);
        settle(&mut short, ContactContent::Times);
        assert_eq!(short.flags[0].code, FlagCode::NoImpact);
    }
}
