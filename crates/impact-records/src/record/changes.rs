//! A list of changes, as logic analysers write it: a row wherever a line goes from one of its two levels to the
//! other.

use labfiles::DatasetInfo;

/// Fewest rows of a list of changes.
const FEWEST_ROWS: usize = 6;

/// How much longer one level must last than the other to be told by it which is which.
const LONGER: f64 = 2.0;

/// The two levels of a column that changes with each row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// The level of an open contact.
    pub open: f64,
    /// The level of a closed one.
    pub closed: f64,
}

/// The levels of a column of states beside the times of its changes, if each row differs from the one before and
/// there are two of them. A contact is closed for a shorter time than a flight lasts.
pub fn levels(times: &[f64], states: &[f64]) -> Option<Levels> {
    let first = *states.first()?;
    let other = *states.iter().find(|s| **s != first)?;
    let two = states.iter().all(|s| *s == first || *s == other);
    let changes = states.windows(2).all(|w| w[0] != w[1]);
    if !two || !changes || states.len() < FEWEST_ROWS || times.len() != states.len() {
        return None;
    }
    let usual = |level: f64| {
        let lasting = times.windows(2).zip(states).filter(|(_, s)| **s == level);
        let mut lasting: Vec<f64> = lasting.map(|(t, _)| t[1] - t[0]).collect();
        lasting.sort_by(f64::total_cmp);
        lasting.get(lasting.len() / 2).copied()
    };
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

/// The columns of a dataset that may hold the states beside the times of its changes.
pub fn candidates(dataset: &DatasetInfo, times: usize) -> impl Iterator<Item = usize> {
    let samples = dataset.channels.get(times).map_or(0, |c| c.samples);
    let others = dataset.channels.iter().enumerate();
    let others = others.filter(move |(i, c)| *i != times && c.samples == samples);
    others.map(|(i, _)| i).collect::<Vec<_>>().into_iter()
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
        assert_eq!(levels(&times, &[0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0]), None);
        assert_eq!(levels(&times, &[0.0, 1.0, 2.0, 0.0, 1.0, 0.0, 1.0]), None);
    }
}
