//! A list of changes, as logic analysers write it: a row wherever a line goes from one of its two levels to the
//! other; with the column of the line's state, or of the times alone.

use labfiles::DatasetInfo;

use crate::signal::robust;

/// Fewest rows of a list of changes.
const FEWEST_ROWS: usize = 6;

/// How much longer one level must last than the other to be told by it which is which. Of two gates that a bouncing mass
/// passes in turn, the way back takes 1/R times as long as the way there: up to twice from R = 0.5 on. Contacts are told
/// down to flights of twice their length: `prop_contacts_are_told_and_gates_in_turn_are_not`.
const LONGER: f64 = 2.0;

/// How much longer each flight must be than each contact where no state tells them apart.
const APART: f64 = 1.5;
/// Longest time that a contact takes, s.
const LONGEST_CONTACT_S: f64 = 0.1;
/// Fewest contacts by which a list of changes is recognised without a state.
const FEWEST_CONTACTS: usize = 3;
/// Share of the intervals that may be longer than the one before where a mass bounces: once a throw, or where an
/// impact was missed.
const MOST_RISE: f64 = 0.4;

/// The two levels of a column that changes with each row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// The level of an open contact.
    pub open: f64,
    /// The level of a closed one.
    pub closed: f64,
}

/// The contacts of a list of changes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Closings {
    /// When each closes, s.
    pub(super) times_s: Vec<f64>,
    /// How long they are usually closed, s.
    pub(super) closed_s: f64,
}

/// What a list of times holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Listing {
    /// The impacts.
    Impacts,
    /// The changes of a contact: closed, open, closed ….
    Changes(Closings),
    /// Neither, as intervals are longer than the one before.
    Unclear(Rises),
}

/// Intervals that are longer than the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rises {
    /// All intervals.
    pub(super) intervals: usize,
    /// Those that are longer.
    pub(super) longer: usize,
    /// The row at the end of the first of these, counted from 1.
    pub(super) row: usize,
}

/// The rows in which a state differs from that of the row before.
fn changed(times: &[f64], states: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let rows = times.iter().copied().zip(states.iter().copied());
    let mut before = None;
    rows.filter(|(_, state)| before.replace(*state) != Some(*state))
        .unzip()
}

/// The levels of a column of states beside the times of its changes, if each row differs from the one before and
/// there are two of them. A contact is closed for a shorter time than a flight lasts.
pub fn levels(times: &[f64], states: &[f64]) -> Option<Levels> {
    let changes = states.windows(2).all(|w| w[0] != w[1]);
    line_levels(times, states).filter(|_| changes)
}

/// As [`levels`], of a line among several, any of which changes with a row.
pub fn line_levels(times: &[f64], states: &[f64]) -> Option<Levels> {
    if times.len() != states.len() {
        return None;
    }
    let (times, states) = changed(times, states);
    let first = *states.first()?;
    let other = *states.get(1)?;
    let two = states.iter().all(|s| *s == first || *s == other);
    if !two || states.len() < FEWEST_ROWS {
        return None;
    }
    let usual = |level: f64| usually_lasts(&times, &states, level);
    let (high, low) = (first.max(other), first.min(other));
    let closed = match (usual(high)?, usual(low)?) {
        (of_high, of_low) if of_high > LONGER * of_low => low,
        (of_high, of_low) if of_low > LONGER * of_high => high,
        // two gates that are passed in turn
        _ => return None,
    };
    Some(Levels {
        open: high + low - closed,
        closed,
    })
}

/// How long a level usually lasts in a list of changes, s.
fn usually_lasts(times: &[f64], states: &[f64], level: f64) -> Option<f64> {
    let at_level = times.windows(2).zip(states).filter(|(_, s)| **s == level);
    let lasting: Vec<f64> = at_level.map(|(t, _)| t[1] - t[0]).collect();
    robust::median(&lasting)
}

/// The contacts of a line whose levels are known.
pub(super) fn closings(times: &[f64], states: &[f64], levels: Levels) -> Closings {
    let (times, states) = changed(times, states);
    let closing = times.iter().zip(&states);
    let closing = closing.filter(|(_, state)| **state == levels.closed);
    Closings {
        times_s: closing.map(|(t, _)| *t).collect(),
        closed_s: usually_lasts(&times, &states, levels.closed).unwrap_or(0.0),
    }
}

/// What rising times are, s, by themselves: times that come in groups, each short beside the flights between them,
/// are the changes of a contact, or its bounces, and the first of each group is the impact. Groups that last longer
/// than a contact may be throws one after the other.
pub(super) fn listing(times: &[f64]) -> Listing {
    let contacts = groups(times).filter(|found| found.closed_s <= LONGEST_CONTACT_S);
    let contacts = contacts.or_else(|| chattering(times));
    let rises = match &contacts {
        Some(closings) => rises(times, &closings.times_s),
        None => rises(times, times),
    };
    let unclear = rises.filter(|r| {
        let most = MOST_RISE * (r.intervals - 1) as f64;
        r.longer > 1 && r.longer as f64 > most
    });
    match (unclear, contacts) {
        (Some(rises), _) => Listing::Unclear(rises),
        (None, Some(closings)) => Listing::Changes(closings),
        (None, None) => Listing::Impacts,
    }
}

/// The intervals between impacts, which are among the rows' times, that are longer than the one before; `None`
/// where there are none.
fn rises(times: &[f64], impacts: &[f64]) -> Option<Rises> {
    let gaps: Vec<f64> = impacts.windows(2).map(|w| w[1] - w[0]).collect();
    let longer = |k: &usize| gaps[*k] > 1.05 * gaps[k - 1];
    let first = (1..gaps.len()).find(longer)?;
    Some(Rises {
        intervals: gaps.len(),
        longer: (1..gaps.len()).filter(longer).count(),
        row: times.iter().position(|t| *t == impacts[first + 1])? + 1,
    })
}

/// The groups of times: the intervals are of two kinds, and none of the long ones follows another but at the ends.
fn groups(times: &[f64]) -> Option<Closings> {
    let gaps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let mut sorted = gaps.clone();
    sorted.sort_by(f64::total_cmp);
    let steps = sorted.windows(2).filter(|w| w[1] > APART * w[0]);
    let limits = steps.map(|w| (w[1] / w[0], (w[0] * w[1]).sqrt()));
    let grouped = limits.filter_map(|(ratio, limit)| Some((ratio, grouped(times, limit)?)));
    let best = grouped.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, closings)| closings)
}

/// Longest time from one closing of a contact that bounces to the next, s.
const CHATTER_S: f64 = 3e-3;
/// How long a contact bounces over the shortest flight, at most.
const CHATTERS: f64 = 0.1;

/// The impacts of a contact that bounces at some of them, if each flight is far longer.
fn chattering(times: &[f64]) -> Option<Closings> {
    let all: Vec<&[f64]> = times.chunk_by(|a, b| b - a <= CHATTER_S).collect();
    let lasting = all.iter().map(|g| g[g.len() - 1] - g[0]);
    let lasting: Vec<f64> = lasting.filter(|s| *s > 0.0).collect();
    let longest = lasting.iter().copied().reduce(f64::max)?;
    let times_s: Vec<f64> = all.iter().map(|g| g[0]).collect();
    let flights = times_s.windows(2).map(|w| w[1] - w[0]);
    let shortest = flights.reduce(f64::min)?;
    if times_s.len() < FEWEST_CONTACTS || longest > CHATTERS * shortest {
        return None;
    }
    Some(Closings {
        times_s,
        closed_s: robust::median(&lasting)?,
    })
}

/// The groups of times that are no longer apart than a limit, if all have several but perhaps the first, where the
/// list begins with the state at its start, and the last.
fn grouped(times: &[f64], limit: f64) -> Option<Closings> {
    let mut all: Vec<&[f64]> = times.chunk_by(|a, b| b - a <= limit).collect();
    if all.first()?.len() == 1 {
        all.remove(0);
    }
    let inner = &all[..all.len().saturating_sub(1)];
    if all.len() < FEWEST_CONTACTS || inner.iter().any(|g| g.len() < 2) {
        return None;
    }
    let lasting: Vec<f64> = inner.iter().map(|g| g[g.len() - 1] - g[0]).collect();
    Some(Closings {
        times_s: all.iter().map(|g| g[0]).collect(),
        closed_s: robust::median(&lasting)?,
    })
}

/// Whether each row after the first changes one of several lines.
pub fn all_change(lines: &[Vec<f64>]) -> bool {
    let rows = lines.iter().map(Vec::len).min().unwrap_or(0);
    let changes = |row: usize| lines.iter().any(|line| line[row] != line[row - 1]);
    rows > 1 && (1..rows).all(changes)
}

/// The columns of a dataset that may hold the states beside the times of its changes.
pub fn candidates(dataset: &DatasetInfo, times: usize) -> impl Iterator<Item = usize> {
    let samples = dataset.channels.get(times).map_or(0, |c| c.samples);
    let others = dataset.channels.iter().enumerate();
    let others = others.filter(move |(i, c)| *i != times && c.samples == samples);
    others.map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_alternate_are_changes_and_the_short_level_is_the_contact() {
        let times = [0.0, 0.5, 0.502, 1.0, 1.002, 1.4, 1.402];
        let states = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        let found = levels(&times, &states).unwrap();
        assert_eq!((found.open, found.closed), (0.0, 1.0));
        // a line that is pulled down by the contact
        let inverted = states.map(|s| 1.0 - s);
        assert_eq!(levels(&times, &inverted).unwrap().closed, 0.0);
        let gates = [0.0, 0.5, 0.9, 1.4, 1.8, 2.3, 2.7];
        assert_eq!(levels(&gates, &states), None);
        // rows in which another line changes
        let more = [0.0, 0.5, 0.502, 0.7, 1.0, 1.002, 1.4, 1.402];
        let with = [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        assert_eq!(levels(&more, &with), None);
        assert_eq!(line_levels(&more, &with).unwrap().closed, 1.0);
        assert_eq!(
            closings(
                &more,
                &with,
                Levels {
                    open: 0.0,
                    closed: 1.0
                }
            )
            .times_s,
            [0.5, 1.0, 1.4]
        );
        assert_eq!(levels(&times, &[0.0, 1.0, 2.0, 0.0, 1.0, 0.0, 1.0]), None);
    }

    #[test]
    fn prop_contacts_are_told_and_gates_in_turn_are_not() {
        use rand::{Rng, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_127);
        let states: Vec<f64> = (0..12u8).map(|k| f64::from(k % 2)).collect();
        let mut found = |lasts: [f64; 2]| {
            let mut at = 0.0;
            let next = (0..12).map(|k| {
                at += lasts[k % 2] * rng.random_range(0.95..1.05);
                at
            });
            levels(&next.collect::<Vec<f64>>(), &states)
        };
        for restitution in [0.55, 0.7, 0.9] {
            assert_eq!(found([1.0, 1.0 / restitution]), None, "{restitution}");
        }
        for flight in [2.5, 4.0, 20.0] {
            // the first row begins the level 0, which lasts until the second
            let of_contact = found([flight, 1.0]).map(|l| l.closed);
            let of_flight = found([1.0, flight]).map(|l| l.closed);
            assert_eq!([of_contact, of_flight], [Some(0.0), Some(1.0)], "{flight}");
        }
    }

    /// Times of `count` bounces, each flight `r` times the one before.
    fn bounces(first_s: f64, r: f64, count: i32) -> Vec<f64> {
        let flights = (0..count - 1).scan(first_s, |at, k| {
            *at += 0.5 * r.powi(k);
            Some(*at)
        });
        std::iter::once(first_s).chain(flights).collect()
    }

    #[test]
    fn prop_changes_without_a_state_are_told_from_impacts() {
        for r in [0.3, 0.5, 0.65, 0.8, 0.95] {
            let impacts = bounces(0.5, r, 5);
            assert_eq!(listing(&impacts), Listing::Impacts, "{r}");
            let changes: Vec<f64> = impacts.iter().flat_map(|t| [*t, t + 1.5e-3]).collect();
            let found = |times: &[f64]| match listing(times) {
                Listing::Changes(found) => found,
                other => panic!("{r}: {other:?}"),
            };
            assert_eq!(found(&changes).times_s, impacts);
            assert!((found(&changes).closed_s - 1.5e-3).abs() < 1e-9);
            // the state at the start, a cut at the end, a contact that bounces
            assert_eq!(found(&[&[0.0], &changes[..]].concat()).times_s, impacts);
            assert_eq!(found(&changes[..changes.len() - 1]).times_s, impacts);
            let bouncing = impacts
                .iter()
                .flat_map(|t| [*t, t + 2e-4, t + 3e-4, t + 2e-3]);
            assert_eq!(found(&bouncing.collect::<Vec<_>>()).times_s, impacts);
        }
    }

    #[test]
    fn a_contact_that_bounces_at_some_impacts_is_closed_once_at_each() {
        let impacts = bounces(0.5, 0.8, 7);
        let bouncing = impacts.iter().enumerate().flat_map(|(k, t)| {
            let count = [1, 3, 1, 1, 2, 3, 1][k];
            (0..count).map(move |i| t + 6e-4 * f64::from(i))
        });
        match listing(&bouncing.collect::<Vec<_>>()) {
            Listing::Changes(found) => {
                assert_eq!(found.times_s, impacts);
                assert!((found.closed_s - 1.2e-3).abs() < 1e-9);
            }
            other => panic!("{other:?}"),
        }
        // the last flights of a ball are short, and none of them is a bounce of the contact
        let short = bounces(0.5, 0.4, 8);
        assert_eq!(listing(&short), Listing::Impacts);
    }

    #[test]
    fn lists_that_are_neither_impacts_nor_changes_are_unclear() {
        // two throws in one list are impacts
        let throws = [bounces(0.5, 0.8, 5), bounces(9.0, 0.8, 5)].concat();
        assert_eq!(listing(&throws), Listing::Impacts);
        // and so are three, each far longer than a contact
        let throws = [0.4, 60.0, 120.0].map(|at| bounces(at, 0.8, 8)).concat();
        assert_eq!(listing(&throws), Listing::Impacts);
        // passages of a gate, far longer than a contact
        let gate: Vec<f64> = bounces(0.5, 0.8, 6)
            .iter()
            .flat_map(|t| [*t, t + 0.12])
            .collect();
        assert!(matches!(listing(&gate), Listing::Unclear(..)));
        // where flights become as short as the contacts, the list ends
        let late: Vec<f64> = bounces(0.5, 0.5, 10)
            .iter()
            .flat_map(|t| [*t, t + 2e-3])
            .collect();
        match listing(&late) {
            Listing::Changes(found) => assert_eq!(found.times_s, bounces(0.5, 0.5, 8)),
            other => panic!("{other:?}"),
        }
    }
}
