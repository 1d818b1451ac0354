//! Contacts that a file states as events: times, intervals, or the sound of them.

use super::changes::{Closings, Listing, Rises, listing};
use super::content::ContactContent;
use super::table_rows::table_rows;
use super::{Channel, Flag, ListedTimes, Problem, Record, Role};
use crate::signal::onsets;
use labfiles::units::Dimension;

/// Fewest impacts from which flight times can be compared.
const FEWEST: usize = 3;

/// The impacts of a list.
struct Found {
    times_s: Vec<f64>,
    /// How long each contact lasts; 0 where the list does not tell it.
    contact_s: f64,
    /// What was taken.
    note: Option<Flag>,
}

impl Found {
    /// Impacts of which nothing but their times is known.
    fn alone(times_s: Vec<f64>) -> Self {
        Self {
            times_s,
            contact_s: 0.0,
            note: None,
        }
    }
}

/// Time between throws that a table has in its rows, over the longest flight: far more than a flight that is two, the impact
/// between them missing.
const REST: f64 = 10.0;

/// Turn a contact that is stated as events into the times of its impacts, s. The record then has the
/// mean rate of its impacts as its rate. `closed_s` is how long a contact lasts, if the rows have told it; `beside` are the
/// columns that follow where each row is a throw of its own.
pub(super) fn settle(
    record: &mut Record,
    content: ContactContent,
    closed_s: f64,
    beside: &[Vec<f64>],
) {
    let rate_hz = record.sample_rate_hz;
    let Some(channel) = record.channels.iter_mut().find(|c| c.role == Role::Contact) else {
        return;
    };
    let printed = || {
        let columns = beside.iter().map(|column| printed_step(column));
        columns.fold(printed_step(&channel.values), f64::min)
    };
    let (found, step_s) = match content {
        ContactContent::Signal | ContactContent::Heights | ContactContent::Rebounds => return,
        ContactContent::Times | ContactContent::Intervals if !beside.is_empty() => {
            (across(channel, beside, content), printed())
        }
        ContactContent::Times => (
            times(&channel.values)
                .map_err(|row| not_rising(channel, row))
                .and_then(|times| impacts(times, channel)),
            printed(),
        ),
        ContactContent::Intervals => (impacts(added_up(&channel.values), channel), printed()),
        ContactContent::Sound => (Ok(sounds(channel, rate_hz)), rate_hz.recip()),
    };
    let Found {
        times_s,
        contact_s,
        note,
    } = match found {
        Ok(found) if found.times_s.len() < FEWEST => {
            let flag = too_few(channel, found.times_s.len(), content);
            return record.flags.push(flag);
        }
        Ok(found) => found,
        Err(flag) => return record.flags.push(flag),
    };
    let span_s = times_s[times_s.len() - 1] - times_s[0];
    record.sample_rate_hz = (times_s.len() - 1) as f64 / span_s.max(f64::MIN_POSITIVE);
    // where in a step, and where in the contact, the impact was is not known
    let contact_s = closed_s.max(contact_s);
    record.listed = ListedTimes {
        error_s: step_s.hypot(contact_s) / 12f64.sqrt(),
        contact_s,
        ..ListedTimes::default()
    };
    channel.values = times_s;
    channel.dimension = Dimension::Time;
    channel.threshold = None;
    record.flags.extend(note);
    record.channels.retain(|c| c.role == Role::Contact);
}

/// The impacts that are heard, without their echoes.
fn sounds(channel: &Channel, rate_hz: f64) -> Found {
    let heard = onsets::listen(&channel.values, rate_hz);
    let problem = Problem::EchoesLeftOut {
        count: heard.echoes,
        impacts: heard.times.len(),
        delay_ms: 1e3 * heard.delay / rate_hz,
    };
    let note = Flag::new(Some(&channel.name), problem).excluding(false);
    Found {
        note: (heard.echoes > 0).then_some(note),
        ..Found::alone(heard.times.iter().map(|i| i / rate_hz).collect())
    }
}

/// The times of throws that lie along the rows, one throw after the other with a rest between them. A row ends at the first
/// cell that is empty, or zero; one with too few impacts is passed over.
fn across(channel: &Channel, beside: &[Vec<f64>], content: ContactContent) -> Result<Found, Flag> {
    let mut throws: Vec<Vec<f64>> = Vec::new();
    for cells in table_rows(&channel.values, beside) {
        let throw = match content {
            ContactContent::Intervals => added_up(&cells),
            _ => {
                let filled = cells.iter().copied().take_while(|t| t.is_finite());
                let times: Vec<f64> = filled.collect();
                if let Some(at) = times.windows(2).position(|w| w[1] <= w[0]) {
                    return Err(not_rising(channel, at + 2));
                }
                times
            }
        };
        if throw.len() >= FEWEST {
            throws.push(throw);
        }
    }
    let flights = throws
        .iter()
        .flat_map(|t| t.windows(2).map(|w| w[1] - w[0]));
    let rest_s = REST * flights.fold(0.0, f64::max);
    let problem = Problem::ThrowsInRows {
        throws: throws.len(),
        impacts: throws.iter().map(Vec::len).sum(),
    };
    let note = Flag::new(Some(&channel.name), problem).excluding(false);
    let mut times: Vec<f64> = Vec::new();
    for throw in throws {
        let begin_s = times.last().map_or(0.0, |last| last + rest_s);
        times.extend(throw.iter().map(|t| begin_s + t - throw[0]));
    }
    Ok(Found {
        note: Some(note),
        ..Found::alone(times)
    })
}

/// The impacts among listed times.
fn impacts(times: Vec<f64>, channel: &Channel) -> Result<Found, Flag> {
    match listing(&times) {
        Listing::Impacts => Ok(Found::alone(times)),
        Listing::Changes(Closings { times_s, closed_s }) => {
            let note = alternating(channel, times_s.len(), closed_s);
            Ok(Found {
                times_s,
                contact_s: closed_s,
                note: Some(note),
            })
        }
        Listing::Unclear(rises) => Err(unclear(channel, rises)),
    }
}

/// Most digits after the point that times in s are printed with.
const MOST_DIGITS: i32 = 12;

/// The step of the last digit with which numbers are printed; 0 where they are not rounded.
pub(super) fn printed_step(times: &[f64]) -> f64 {
    let finite = || times.iter().filter(|t| t.is_finite());
    let whole = |digits: &i32| {
        finite().all(|t| {
            let steps = t * 10f64.powi(*digits);
            // beyond, a number of 53 bits is near a whole one by itself
            steps.abs() < 1e12 && (steps - steps.round()).abs() < 1e-3
        })
    };
    let digits = (0..=MOST_DIGITS).find(whole);
    digits.map_or(0.0, |digits| 10f64.powi(-digits))
}

/// The stated times without empty rows, the earliest first; the first row that does not rise as the error.
fn times(values: &[f64]) -> Result<Vec<f64>, usize> {
    let mut filled: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    if filled.windows(2).all(|w| w[1] < w[0]) {
        filled.reverse();
    }
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
    let (impacts, needed) = (found, FEWEST);
    let problem = match content {
        ContactContent::Sound => Problem::FewSounds { impacts, needed },
        _ => Problem::FewTimes { impacts, needed },
    };
    Flag::new(Some(&channel.name), problem)
}

fn alternating(channel: &Channel, impacts: usize, closed_s: f64) -> Flag {
    let problem = Problem::GroupsOfRows { closed_s, impacts };
    Flag::new(Some(&channel.name), problem).excluding(false)
}

fn unclear(channel: &Channel, rises: Rises) -> Flag {
    let Rises {
        intervals,
        longer,
        row,
    } = rises;
    let problem = Problem::GrowingIntervals {
        intervals,
        longer,
        row,
    };
    Flag::new(Some(&channel.name), problem)
}

fn not_rising(channel: &Channel, impact: usize) -> Flag {
    let problem = Problem::ImpactsNotInOrder { impact };
    Flag::new(Some(&channel.name), problem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::FlagCode;

    fn record(values: &[f64]) -> Record {
        let mut record = Record::of(100.0, &[(Role::Contact, values)]);
        record.channels[0].threshold = None;
        record
    }

    #[test]
    fn intervals_add_up_to_times_until_one_is_zero() {
        let mut list = record(&[0.5, 0.4, 0.32, 0.0]);
        settle(&mut list, ContactContent::Intervals, 0.0, &[]);
        let times = list.values(Role::Contact).unwrap();
        assert_eq!(times.len(), 4);
        assert!((times[3] - 1.22).abs() < 1e-12);
        assert!((list.sample_rate_hz - 3.0 / 1.22).abs() < 1e-12);
        assert!(list.flags.is_empty());
    }

    #[test]
    fn valid_the_impacts_of_a_sound_are_heard_without_its_echoes() {
        // a click of 2 kHz at each bounce with R = 0.75, and from a wall 45 ms later at 40 %
        let at_s = |k: i32| 0.3 + 0.8 * (1.0 - 0.75_f64.powi(k)) / 0.25;
        let click = |t: f64, size: f64| match t {
            t if t < 0.0 => 0.0,
            t => size * (-t / 4e-3).exp() * (1.3e4 * t).sin(),
        };
        let heard = |t: f64, echo: f64| {
            let bounces = (0..8).map(|k| (t - at_s(k), 0.75_f64.powi(k)));
            let both = bounces.map(|(t, size)| click(t, size) + echo * click(t - 0.045, size));
            both.sum::<f64>() + 3e-4 * (2.399_963 * (t * 44_100.0).powi(2)).sin()
        };
        for echo in [0.0, 0.4] {
            let values: Vec<f64> = (0..170_000)
                .map(|i| heard(f64::from(i) / 44_100.0, echo))
                .collect();
            let mut sound = record(&values);
            sound.sample_rate_hz = 44_100.0;
            settle(&mut sound, ContactContent::Sound, 0.0, &[]);
            let times = sound.values(Role::Contact).unwrap();
            assert_eq!(times.len(), 8, "{echo}: {times:?}");
            let off = |(k, t): (i32, &f64)| (t - at_s(k)).abs();
            assert!((0..).zip(times).map(off).all(|off| off < 2e-3));
            let said = sound.flags.iter().map(Flag::message);
            let said: Vec<String> = said.collect();
            assert_eq!(said.len(), usize::from(echo > 0.0), "{said:?}");
            let start = "8 impacts are heard, and 8 echoes, 45 ms after";
            assert!(said.iter().all(|s| s.starts_with(start)), "{said:?}");
            assert!(!sound.excluded());
        }
    }

    #[test]
    fn throws_along_the_rows_follow_each_other_after_a_rest() {
        let beside = [vec![0.4, 0.5, 0.4], vec![0.32, 0.0, 0.3]];
        let mut list = record(&[0.5, 0.0, 0.5]);
        settle(&mut list, ContactContent::Intervals, 0.0, &beside);
        let times = list.values(Role::Contact).unwrap().to_vec();
        let expected = [0.0, 0.5, 0.9, 1.22, 6.22, 6.72, 7.12, 7.42];
        assert_eq!(times.len(), expected.len());
        for (time, expected) in times.iter().zip(expected) {
            assert!((time - expected).abs() < 1e-12, "{times:?}");
        }
        assert!((list.listed.error_s - 1e-2 / 12f64.sqrt()).abs() < 1e-15);
        let [taken] = &list.flags[..] else {
            panic!("{:?}", list.flags);
        };
        assert!(!list.excluded());
        let said = "each row is taken as a throw of its own: 2 throws with 8 impacts";
        assert!(taken.message().contains(said), "{}", taken.message());
        let mut list = record(&[0.1, 7.0]);
        let beside = [vec![0.6, 7.5], vec![1.0, 7.9]];
        settle(&mut list, ContactContent::Times, 0.0, &beside);
        assert_eq!(list.values(Role::Contact).unwrap().len(), 6);
        let mut back = record(&[0.1]);
        settle(
            &mut back,
            ContactContent::Times,
            0.0,
            &[vec![0.6], vec![0.5]],
        );
        assert!(
            back.flags[0].message().contains("impact 3"),
            "{:?}",
            back.flags
        );
    }

    #[test]
    fn a_list_of_times_with_the_last_impact_first_is_turned_around() {
        let mut list = record(&[1.22, 0.9, 0.5, 0.0]);
        settle(&mut list, ContactContent::Times, 0.0, &[]);
        assert_eq!(list.values(Role::Contact).unwrap(), [0.0, 0.5, 0.9, 1.22]);
        assert!(list.flags.is_empty());
    }

    #[test]
    fn lists_that_are_none_are_refused_with_the_row() {
        let mut back = record(&[1.0, 2.0, 1.5, 3.0]);
        settle(&mut back, ContactContent::Times, 0.0, &[]);
        assert!(
            back.flags[0].message().contains("impact 3"),
            "{:?}",
            back.flags
        );
        let mut short = record(&[1.0, 2.0, f64::NAN]);
        settle(&mut short, ContactContent::Times, 0.0, &[]);
        assert_eq!(short.flags[0].code, FlagCode::NoImpact);
    }

    #[test]
    fn the_row_at_which_the_intervals_grow_is_named() {
        // passages of a gate
        let mut gate = record(&[0.0, 0.12, 0.5, 0.62, 0.9, 1.02, 1.22, 1.34]);
        settle(&mut gate, ContactContent::Times, 0.0, &[]);
        assert_eq!(gate.flags[0].code, FlagCode::ContactUnclear);
        let message = gate.flags[0].message();
        let start = "3 of 7 intervals are longer than the one before, the first of them the one that ends with row 3";
        assert!(message.starts_with(start), "{message}");
    }

    #[test]
    fn the_error_of_times_is_that_of_their_last_digit_and_of_the_contact() {
        for (times, step_s) in [
            (vec![0.519_275, 1.030_116, 1.438_788], 1e-6),
            (vec![0.5, 1.03, 1.4], 1e-2),
            (vec![1.0, 5.0, 8.0], 1.0),
            (vec![0.5_f64.sqrt(), 1.1_f64.sqrt(), 1.4_f64.sqrt()], 0.0),
        ] {
            let mut list = record(&times);
            settle(&mut list, ContactContent::Times, 0.0, &[]);
            assert!(
                (list.listed.error_s - step_s / 12f64.sqrt()).abs() < 1e-15,
                "{times:?}"
            );
        }
        let mut changes = record(&[0.0, 2e-3, 0.5, 0.502, 0.9, 0.902]);
        settle(&mut changes, ContactContent::Times, 0.0, &[]);
        assert_eq!(changes.values(Role::Contact).unwrap(), [0.0, 0.5, 0.9]);
        assert!((changes.listed.error_s - 2.236e-3 / 12f64.sqrt()).abs() < 1e-6);
        assert_eq!(changes.flags[0].code, FlagCode::ContactChanges);
        assert!(!changes.excluded());
    }
}
