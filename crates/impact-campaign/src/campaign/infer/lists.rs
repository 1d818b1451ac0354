//! Lists of times: which tables are such, and which of their columns contain the times.

use super::heights::{is_computed, is_trial, numbers_rows};
use super::place::Place;
use impact_records::record::{ContactContent, changes};
use impact_records::signal::columns;
use labfiles::units::{self, Dimension};
use labfiles::{ChannelInfo, DatasetInfo, StoredType, timing};

/// Fewest and most rows of a list.
const FEWEST_EVENTS: u64 = 3;
const MOST_EVENTS: u64 = 400;
/// Fewest columns of times that contain a throw along each row beside columns of other numbers.
const FEWEST_BESIDE: usize = 3;
/// How many times longer than the shortest the longest interval of a list is where other columns are beside it: samples
/// are taken at even times.
const UNEVEN: f64 = 1.2;
/// Part of the intervals that are shorter than the one before where a mass bounces.
const MOST_SHORTER: f64 = 0.75;

/// Whether a dataset is a list of times.
pub(super) fn is_list(place: Place<'_>) -> bool {
    !listed(place).is_empty()
}

/// The columns that contain times or intervals of a list, or of one of changes that is as long as a record.
pub(super) fn of_times(place: Place<'_>) -> Vec<usize> {
    let mut found = listed(place);
    if found.is_empty() {
        found.extend(changes_at(place));
    }
    found
}

/// The columns of a list that contain times or intervals; none where the dataset is no list. Clocks are read from their first
/// row on, so that intervals that are written as times of day alone are none.
fn listed(place: Place<'_>) -> Vec<usize> {
    let found = of_columns(place);
    if are_clocks_alone(place, &found) {
        return Vec::new();
    }
    found
}

/// The first column of laps that are written as times of day alone.
pub(super) fn laps_alone(place: Place<'_>) -> Option<usize> {
    let found = of_columns(place);
    let first = *found.first()?;
    are_clocks_alone(place, &found).then_some(first)
}

/// Whether columns are times of day none of which goes on.
fn are_clocks_alone(place: Place<'_>, columns: &[usize]) -> bool {
    let clock = |i: &usize| place.set().channels[*i].stored == StoredType::Time;
    let goes_on = |i: &usize| {
        let values = place.numbers(*i);
        !intervals(&values).is_empty() || are_reversed(&values)
    };
    columns.iter().all(clock) && !columns.iter().any(goes_on)
}

/// The columns that contain times or intervals by their names, units and numbers.
///
/// A table of few rows is one if all its columns are in units of time, or those of times contain a throw along each row.
/// Beside remarks, as in a track of labels or beside the state of a line, its times must be uneven. Beside other numbers,
/// and where neither a name nor a unit states that a column contains times, they must be those of a mass that bounces:
/// each interval shorter than the one before.
fn of_columns(place: Place<'_>) -> Vec<usize> {
    let set = place.set();
    let rows = set.channels.iter().map(|c| c.samples).max().unwrap_or(0);
    if rows < FEWEST_EVENTS {
        return of_few_rows(place);
    }
    if rows > MOST_EVENTS {
        return Vec::new();
    }
    if let Some(time) = changes_at(place) {
        return vec![time];
    }
    let numbers = numbers(place);
    let (of_time, others): (Vec<usize>, Vec<usize>) =
        numbers.iter().partition(|i| is_of_time(&set.channels[**i]));
    let text = |c: &ChannelInfo| c.stored == StoredType::Text;
    if others.is_empty() && !set.channels.iter().any(text) {
        return of_time;
    }
    let named = |i: &usize| of_time.contains(i) || is_named_time(&set.channels[*i].name);
    let (named, others): (Vec<usize>, Vec<usize>) = numbers.iter().partition(|i| named(i));
    let throws = others.is_empty() || named.len() >= FEWEST_BESIDE;
    if throws && along_rows(place, &named).is_some() {
        return named;
    }
    match (named.first(), others.first()) {
        (Some(time), None) if is_uneven(&place.numbers(*time)) => named,
        (Some(time), Some(_)) if bounces(&place.numbers(*time)) => vec![*time],
        (None, Some(time)) if may_be_times(set, &others) && bounces(&place.numbers(*time)) => {
            vec![*time]
        }
        _ => Vec::new(),
    }
}

/// The columns of a table of one row or two, of times alone, each of which is a throw.
fn of_few_rows(place: Place<'_>) -> Vec<usize> {
    let found = numbers(place);
    let of_times = found.iter().all(|i| is_of_time(&place.set().channels[*i]));
    let throws = of_times && found.len() >= FEWEST_BESIDE && along_rows(place, &found).is_some();
    if throws { found } else { Vec::new() }
}

/// Part of the rows that go the same way where each is a throw of its own.
const MOSTLY: f64 = 0.9;

/// What the rows of several columns of times are, where each is a throw of its own: times that rise along them, or flights that
/// become shorter, and neither down the first column, of three rows and more, unless another column numbers the trials.
pub(super) fn along_rows(place: Place<'_>, columns: &[usize]) -> Option<ContactContent> {
    let values: Vec<Vec<f64>> = columns.iter().map(|i| place.numbers(*i)).collect();
    let first = values.first()?;
    let row = |k: usize| -> Vec<f64> {
        let cells = values.iter().filter_map(|column| column.get(k).copied());
        cells.take_while(|t| t.is_finite()).collect()
    };
    let rows: Vec<Vec<f64>> = (0..first.len()).map(row).collect();
    let goes = |all: &[f64], down: bool| {
        let mut steps = all.windows(2).map(|w| w[1] - w[0]);
        steps.all(|step| if down { step < 0.0 } else { step > 0.0 })
    };
    let mostly = |fewest: usize, down: bool| {
        let long = rows.iter().filter(|row| row.len() >= fewest);
        let along = long.filter(|row| goes(row, down)).count();
        along as f64 >= MOSTLY * rows.len() as f64
    };
    let shorter = first.windows(2).filter(|w| w[1] < w[0]).count() as f64;
    let steps = first.len().saturating_sub(1) as f64;
    let few = (first.len() as u64) < FEWEST_EVENTS;
    if rows.is_empty() || !few && goes(first, false) && !numbers_trials(place) {
        None
    } else if mostly(3, false) {
        Some(ContactContent::Times)
    } else if mostly(2, true) && (few || shorter < MOST_SHORTER * steps) {
        Some(ContactContent::Intervals)
    } else {
        None
    }
}

/// Whether a column numbers the rows as trials: `Trial`, `Versuch`.
fn numbers_trials(place: Place<'_>) -> bool {
    let mut columns = place.set().channels.iter().enumerate();
    columns.any(|(i, c)| is_trial(&c.name) && counts_rows(&place.numbers(i)))
}

/// The columns of numbers, without those that count the rows or are computed from others.
fn numbers(place: Place<'_>) -> Vec<usize> {
    let counts = |i: usize, c: &ChannelInfo| {
        let stated = c.unit.is_some() || c.stored == StoredType::Time;
        !stated && (numbers_rows(&c.name) || counts_rows(&place.numbers(i)))
    };
    let columns = place.set().channels.iter().enumerate();
    let columns =
        columns.filter(|(i, c)| c.stored != StoredType::Text && !is_computed(c) && !counts(*i, c));
    columns.map(|(i, _)| i).collect()
}

/// Whether numbers count rows, up or down, as a stopwatch counts its laps.
pub(super) fn counts_rows(values: &[f64]) -> bool {
    let steps = |step: f64| values.windows(2).all(|w| w[1] - w[0] == step);
    let first = values.first().is_some_and(|v| v.fract() == 0.0);
    values.len() > 2 && first && (steps(1.0) || steps(-1.0))
}

/// Whether a name is that of a time, which may be one of several: `t`, `Time 2`, `t3`.
fn is_named_time(name: &str) -> bool {
    timing::is_time_name(name.trim_end_matches(|c: char| c.is_ascii_digit()))
}

/// Whether a column is in a unit of time, or holds points in time.
fn is_of_time(channel: &ChannelInfo) -> bool {
    if channel.stored == StoredType::Time {
        return true;
    }
    let unit = units::unit_of(channel.unit.as_deref(), &channel.name);
    unit.is_some_and(|u| u.dimension == Dimension::Time)
}

/// Whether the first of columns without a word of time may contain times: it has no unit, and is the only one or has
/// no name either.
fn may_be_times(set: &DatasetInfo, columns: &[usize]) -> bool {
    let first = &set.channels[columns[0]];
    let unnamed = first.name == format!("column_{}", columns[0] + 1);
    first.unit.is_none() && (unnamed || columns.len() == 1)
}

/// The intervals of times that rise from row to row, up to empty rows at their end; none if they do not.
fn intervals(times: &[f64]) -> Vec<f64> {
    let filled = times.iter().copied().filter(|t| t.is_finite());
    let filled: Vec<f64> = filled.collect();
    let intervals: Vec<f64> = filled.windows(2).map(|w| w[1] - w[0]).collect();
    let rise = intervals.iter().all(|i| *i > 0.0);
    if rise { intervals } else { Vec::new() }
}

/// Whether times rise, by uneven steps.
fn is_uneven(times: &[f64]) -> bool {
    let intervals = intervals(times);
    let (least, greatest) = columns::extremes(&intervals);
    !intervals.is_empty() && greatest > UNEVEN * least
}

/// Whether times are those of a mass that bounces.
fn bounces(times: &[f64]) -> bool {
    let intervals = intervals(times);
    let shorter = intervals.windows(2).filter(|w| w[1] < w[0]).count();
    let most = MOST_SHORTER * intervals.len().saturating_sub(1) as f64;
    is_uneven(times) && shorter > 0 && shorter as f64 >= most
}

/// The column of times of a list of changes.
fn changes_at(place: Place<'_>) -> Option<usize> {
    let set = place.set();
    let time = set.time_axis?;
    let times = place.numbers(time);
    let states = changes::candidates(set, time).map(|state| place.numbers(state));
    // an analyser lists the rows of all its lines, those too that never change
    let lines: Vec<Vec<f64>> = states.filter(|s| s.len() == times.len()).collect();
    let mut levels = lines.iter().map(|line| changes::line_levels(&times, line));
    let found = changes::all_change(&lines) && levels.any(|found| found.is_some());
    // a square wave that is sampled at even times changes with each row too
    let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let (least, greatest) = columns::extremes(&steps);
    (found && greatest > 2.0 * least).then_some(time)
}

/// Whether numbers that all fall are times of bounces of which the last is first: they fall by more and more, and flights,
/// which follow a geometric row themselves, by less and less.
pub(super) fn are_reversed(values: &[f64]) -> bool {
    let steps: Vec<f64> = values.windows(2).map(|w| w[0] - w[1]).collect();
    let grow = steps.windows(2).filter(|w| w[1] > w[0]).count();
    steps.iter().all(|step| *step > 0.0)
        && 3 * grow >= 2 * steps.len().saturating_sub(1)
        && grow > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found in a list in a text.
    fn found<T>(text: &str, find: impl Fn(Place<'_>) -> T) -> T {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("list.csv");
        std::fs::write(&path, text).unwrap();
        let source = labfiles::open(&path).unwrap();
        find(Place {
            source: source.as_ref(),
            dataset: 0,
        })
    }

    /// The columns of a list in a text.
    fn of(text: &str) -> Vec<usize> {
        found(text, listed)
    }

    #[test]
    fn rows_are_throws_where_they_go_one_way_and_the_columns_do_not() {
        let along = |text: &str| found(text, |place| along_rows(place, &listed(place)));
        let flights = "trial,t1_s,t2_s,t3_s\n1,0.61,0.50,0.42\n2,0.64,0.53,0.43\n3,0.60,0.49,0.41\n4,0.65,0.54,0.45\n";
        assert_eq!(along(flights), Some(ContactContent::Intervals));
        let times =
            "trial,b1 (s),b2 (s),b3 (s)\n1,0.3,0.91,1.41\n2,0.3,0.94,1.47\n3,0.3,0.90,1.39\n";
        assert_eq!(along(times), Some(ContactContent::Times));
        // from greater heights each time
        let rising = "Versuch;Zeit 1 (s);Zeit 2 (s);Zeit 3 (s)\n1;0,53;0,44;0,37\n2;0,58;0,48;0,40\n3;0,62;0,52;0,43\n";
        assert_eq!(along(rising), Some(ContactContent::Intervals));
        // remarks, means and heights beside them
        let beside = "trial,drop (cm),t1 (s),t2 (s),t3 (s),mean (s),surface\n1,50,0.61,0.50,0.42,0.51,oak\n2,55,0.64,0.53,0.43,0.53,oak\n3,50,0.60,0.49,0.41,0.50,oak\n4,55,0.65,0.54,0.45,0.55,oak\n";
        assert_eq!(of(beside), [2, 3, 4]);
        assert_eq!(along(beside), Some(ContactContent::Intervals));
        let without_unit = "trial,t1,t2,t3\n1,0.61,0.50,0.42\n2,0.64,0.53,0.43\n3,0.60,0.49,0.41\n";
        assert_eq!(of(without_unit), [1, 2, 3]);
        let heights = "trial,h1,h2,h3\n1,0.61,0.50,0.42\n2,0.64,0.53,0.43\n3,0.60,0.49,0.41\n";
        assert!(of(heights).is_empty());
        // a throw in each file
        let one = "Interval 1 (s),Interval 2 (s),Interval 3 (s)\n0.53,0.42,0.33\n";
        assert_eq!(along(one), Some(ContactContent::Intervals));
        let one = "t1 (s),t2 (s),t3 (s)\n0.30,0.90,1.40\n";
        assert_eq!(along(one), Some(ContactContent::Times));
        assert!(of("a (s),b (s),c (s)\n0.30,0.90,0.40\n").is_empty());
        // each column is a throw
        let columns =
            "a (s),b (s),c (s)\n0.61,0.64,0.60\n0.50,0.53,0.49\n0.42,0.43,0.41\n0.35,0.36,0.34\n";
        assert_eq!(along(columns), None);
        // times beside their intervals
        let both = "t (s),interval (s)\n1.0,0.50\n1.42,0.42\n1.77,0.35\n2.06,0.29\n";
        assert_eq!(along(both), None);
    }

    #[test]
    fn times_beside_remarks_states_and_strengths_are_lists() {
        let labels = "3.9504\t3.9504\tbounce 1\n4.5410\t4.5410\tbounce 2\n5.0400\t5.0400\tbounce 3\n\
                      5.4616\t5.4616\tbounce 4\n";
        assert_eq!(of(labels), [0]);
        let trials = "Trial,Interval 1 (s),Interval 2 (s)\n1,0.4747,0.3942\n2,0.4730,0.3936\n3,0.4748,0.3921\n";
        assert_eq!(of(trials), [1, 2]);
        let edges = "t_us,state\n5602888,CLOSED\n5604188,OPEN\n6076704,CLOSED\n6078028,OPEN\n";
        assert_eq!(of(edges), [0]);
        let epoch = "Timestamp,Peak\n1684140000690,0.9\n1684140001163,0.8\n1684140001581,0.7\n1684140001952,0.6\n";
        assert_eq!(of(epoch), [0]);
        let numbered =
            "bounce no.,Ball A (ms),Ball B (ms)\n1,0.1,0.2\n2,500.0,510.0\n3,900.0,930.0\n";
        assert_eq!(of(numbered), [1, 2]);
    }

    #[test]
    fn laps_of_a_stopwatch_beside_their_sums_are_lists() {
        let laps = "Lap,Lap Time,Total Time\n1,00:00.64,00:00.64\n2,00:00.51,00:01.15\n3,00:00.39,00:01.54\n4,00:00.31,00:01.85\n";
        assert_eq!(of(laps), [1, 2]);
        let in_s = "Lap,Lap (s),Total (s)\n1,0.64,0.64\n2,0.51,1.15\n3,0.39,1.54\n4,0.31,1.85\n";
        assert_eq!(of(in_s), [1, 2]);
        let newest_first = "Lap,Time,Total\n4,00:00.31,00:01.85\n3,00:00.39,00:01.54\n2,00:00.51,00:01.15\n1,00:00.64,00:00.64\n";
        assert_eq!(of(newest_first), [1, 2]);
        let clocks_alone = "Lap,Lap Time\n1,00:00.64\n2,00:00.51\n3,00:00.39\n4,00:00.31\n";
        assert!(of(clocks_alone).is_empty());
    }

    #[test]
    fn short_tables_of_other_quantities_are_no_lists() {
        let heights = "trial,drop_height_cm,rebound_height_cm\n1,50.0,27.6\n2,75.0,41.7\n3,100.0,55.7\n4,50.0,28.7\n";
        assert!(of(heights).is_empty());
        // a calibration, and a short series at even times
        let calibration = "volts,mm\n0.0,0.0\n1.0,2.1\n1.9,4.0\n2.7,5.7\n";
        assert!(of(calibration).is_empty());
        let series = "time (s),temperature\n0,20.1\n60,20.4\n120,20.8\n180,21.0\n";
        assert!(of(series).is_empty());
        let uneven = "time (s),temperature\n0,20.1\n50,20.4\n170,20.8\n210,21.0\n900,21.3\n";
        assert!(of(uneven).is_empty());
    }
}
