//! Impacts that a table states by heights: a mass falls from one height and rises to the next.

use super::content::ContactContent;
use super::table_rows::table_rows;
use super::{Channel, Flag, ListedTimes, Problem, Record};

/// Greatest share of the steps of a list that may rise, each to a new drop: rebounds of one height rise and fall alike.
const MOST_RISE: f64 = 0.4;

/// Heights that follow from one another by impacts, m: that of the drop, and of the top after each.
type Drop = Vec<f64>;

/// Turn the heights of a table, the columns in their order, into drops one after the other with NaN between them.
/// `step_m` is that of the last digit; a record that was settled before states it and gets no note again.
pub(super) fn settle(
    record: &mut Record,
    content: ContactContent,
    beside: &[Vec<f64>],
    (step_m, known): (f64, ListedTimes),
) {
    let Some(channel) = record.channels.first_mut() else {
        return;
    };
    let found = match (content, beside.is_empty()) {
        (ContactContent::Heights, true) => down(&channel.values, channel),
        _ => across(&channel.values, beside, content, channel),
    };
    let drops = match found {
        Ok(drops) => drops,
        Err(flag) => return record.flags.push(flag),
    };
    let impacts: usize = drops.iter().map(|d| d.len() - 1).sum();
    if impacts == 0 {
        let flag = Flag::new(Some(&channel.name), Problem::NoReboundHeight);
        return record.flags.push(flag);
    }
    let heights = || drops.iter().flatten().copied();
    let problem = Problem::HeightsTaken {
        impacts,
        drops: drops.len(),
        highest_m: heights().fold(f64::NEG_INFINITY, f64::max),
        lowest_m: heights().fold(f64::INFINITY, f64::min),
    };
    let note = Flag::new(Some(&channel.name), problem).excluding(false);
    let again = known.digit_m > 0.0 || known.height_m > 0.0;
    record.flags.extend((!again).then_some(note));
    channel.values = drops.join(&f64::NAN);
    record.sample_rate_hz = 1.0;
    record.listed = ListedTimes {
        digit_m: known.digit_m.max(step_m / 12f64.sqrt()),
        ..known
    };
}

/// Drops down a column: a row without a height, or with one that is not below the one before, begins a new one.
fn down(values: &[f64], channel: &Channel) -> Result<Vec<Drop>, Flag> {
    let heights = values.split(|h| h.is_nan() || *h == 0.0);
    let heights: Vec<&[f64]> = heights.filter(|part| !part.is_empty()).collect();
    if let Some(row) = values.iter().position(|h| *h < 0.0) {
        return Err(negative(channel, row));
    }
    let steps = heights.iter().flat_map(|part| part.windows(2));
    let (rise, all) = steps.fold((0, 0), |(rise, all), w| {
        (rise + usize::from(w[1] >= w[0]), all + 1)
    });
    if rise as f64 > MOST_RISE * all as f64 {
        let problem = Problem::HeightsRise { rise, all };
        return Err(Flag::new(Some(&channel.name), problem));
    }
    let parts = heights.iter().flat_map(|part| part.chunk_by(|a, b| b < a));
    let drops = parts.filter(|drop| drop.len() > 1);
    Ok(drops.map(<[f64]>::to_vec).collect())
}

/// Drops along the rows.
fn across(
    first: &[f64],
    beside: &[Vec<f64>],
    content: ContactContent,
    channel: &Channel,
) -> Result<Vec<Drop>, Flag> {
    let mut drops = Vec::new();
    for (row, row_of) in table_rows(first, beside).enumerate() {
        let first = row_of[0];
        if row_of.iter().any(|h| *h < 0.0) {
            return Err(negative(channel, row));
        }
        let filled = |h: &f64| *h > 0.0;
        let own: Vec<Drop> = match content {
            ContactContent::Rebounds if first.is_finite() => {
                let tops = row_of[1..].iter().filter(|h| filled(h));
                tops.map(|top| vec![first, *top]).collect()
            }
            ContactContent::Rebounds => Vec::new(),
            _ => vec![row_of.iter().copied().take_while(filled).collect()],
        };
        for drop in own.into_iter().filter(|drop| drop.len() > 1) {
            if let Some(w) = drop.windows(2).find(|w| w[1] > w[0]) {
                let problem = Problem::ReboundAboveDrop {
                    row: row + 1,
                    from_m: w[0],
                    to_m: w[1],
                };
                return Err(Flag::new(Some(&channel.name), problem));
            }
            drops.push(drop);
        }
    }
    Ok(drops)
}

fn negative(channel: &Channel, row: usize) -> Flag {
    Flag::new(
        Some(&channel.name),
        Problem::HeightBelowPlate { row: row + 1 },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Role;

    /// The heights that a table gives, and what is said of it.
    fn settled(content: ContactContent, first: &[f64], beside: &[&[f64]]) -> (Vec<f64>, String) {
        let mut record = Record::of(1.0, &[(Role::Contact, first)]);
        let beside: Vec<Vec<f64>> = beside.iter().map(|c| c.to_vec()).collect();
        settle(
            &mut record,
            content,
            &beside,
            (1e-3, ListedTimes::default()),
        );
        let message = record.flags.first().map(Flag::message).unwrap_or_default();
        (record.channels[0].values.clone(), message)
    }

    #[test]
    fn drops_lie_down_a_column_or_along_rows() {
        use ContactContent::{Heights, Rebounds};
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let two = [1.0, 0.64, 0.41, f64::NAN, 1.0, 0.63, 0.40];
        let (below, note) = settled(Heights, &[1.0, 0.64, 0.41, 1.0, 0.63, 0.40], &[]);
        assert_eq!(bits(&below), bits(&two));
        assert!(note.contains("4 impacts of 2 drops"), "{note}");
        let beside = settled(Heights, &[1.0, 1.0], &[&[0.64, 0.63], &[0.41, 0.40]]).0;
        assert_eq!(bits(&beside), bits(&two));
        let pairs = settled(Rebounds, &[1.0], &[&[0.64], &[0.63]]).0;
        assert_eq!(bits(&pairs), bits(&[1.0, 0.64, f64::NAN, 1.0, 0.63]));
    }

    #[test]
    fn heights_that_are_none_of_a_mass_that_bounces_are_refused() {
        use ContactContent::{Heights, Rebounds};
        // rebounds of one drop height
        let (_, said) = settled(Heights, &[0.64, 0.63, 0.65, 0.64, 0.66], &[]);
        assert!(said.starts_with("2 of 4 heights"), "{said}");
        let (_, said) = settled(Rebounds, &[0.5, 0.3], &[&[0.4, 0.45]]);
        assert!(said.contains("row 2"), "{said}");
        let (_, said) = settled(Heights, &[0.0, -0.3, -0.5], &[]);
        assert!(said.contains("row 2"), "{said}");
        let (_, said) = settled(Heights, &[0.6], &[]);
        assert!(said.contains("no height"), "{said}");
    }
}
