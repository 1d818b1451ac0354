//! Tables that are of a decay or of bounces, and are not read: with the reason and what to save instead.

use super::place::Place;
use super::{heights, lists};
use impact_records::record::time_axis;
use impact_records::signal::swings;
use labfiles::{ChannelInfo, Source, StoredType};

/// Most rows of a table of swings.
const MOST_ROWS: u64 = 100;
/// How many times as much the amplitude falls in the first half of the rows as in the second, at least: what rolls
/// away falls by as much.
const SLOWS: f64 = 1.2;
/// What the columns of such tables are called.
const SWINGS: [&str; 12] = [
    "ampl",
    "ausschlag",
    "swing",
    "schwing",
    "peak",
    "maxim",
    "a_n",
    "a_k",
    "x_n",
    "dekrement",
    "decrement",
    "ln(",
];

/// Why the one table of a file is not read, and the remedy.
pub(super) fn why(source: &dyn Source) -> Option<[String; 2]> {
    let [set] = source.datasets() else {
        return None;
    };
    let place = Place { source, dataset: 0 };
    if let Some(laps) = lists::laps_alone(place) {
        let name = &set.channels[laps].name;
        return Some([
            format!(
                "the times of day in '{name}' do not rise: they are laps, of which the first is lost, as times of day count \
                 from the first row on"
            ),
            "write the laps in seconds, in a column lap (s), or the total times beside them"
                .to_owned(),
        ]);
    }
    if lists::is_list(place) || heights::of(place).is_some() {
        return None;
    }
    if let Some(names) = heights::side_by_side(place) {
        return Some([
            format!(
                "{} each fall from one impact to the next: they are the heights of throws of their own",
                names.join(", ")
            ),
            "give each throw a file of its own, with the columns bounce and height (cm)".to_owned(),
        ]);
    }
    let swings = (0..set.channels.len()).find(|i| are_swings(place, *i))?;
    let name = &set.channels[swings].name;
    Some([
        format!(
            "'{name}' holds the amplitudes of successive swings, as of a logarithmic decrement, and not the motion"
        ),
        "record the motion itself, with eight samples a period or more; by hand, β = δ/√(4π² + δ²) with δ = ln(A₀/Aₙ)/n"
            .to_owned(),
    ])
}

/// Whether a column is of amplitudes of successive swings: they fall from row to row, of one sign or of either in turn, and it
/// is called so, or the rows are counted and it falls by less and less.
fn are_swings(place: Place<'_>, index: usize) -> bool {
    let set = place.set();
    let channel = &set.channels[index];
    let counted = |(i, c): (usize, &ChannelInfo)| {
        let frames = time_axis::counts_frames(set, i);
        c.unit.is_none() && !frames && lists::counts_rows(&place.numbers(i))
    };
    let is_number = channel.stored != StoredType::Text && channel.stored != StoredType::Time;
    if channel.samples > MOST_ROWS || !is_number || set.time_axis == Some(index) {
        return false;
    }
    let values = place.numbers(index);
    let called = |name: &str| {
        let lower = name.to_lowercase();
        SWINGS.iter().any(|word| lower.contains(word))
    };
    let some_counted = set.channels.iter().enumerate().any(counted);
    let named = called(&channel.name);
    swings::are_swings(&values) && (named || some_counted && slows(&values))
        || named && channel.name.to_lowercase().starts_with("ln") && some_counted
}

/// Whether sizes fall by more in the first half of the rows than in the second.
fn slows(values: &[f64]) -> bool {
    let last = values.len().saturating_sub(1);
    let [first, middle, end] = [0, last / 2, last].map(|i| values.get(i).map_or(0.0, |v| v.abs()));
    first - middle > SLOWS * (middle - end)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Why a list in a text is not read.
    fn of(text: &str) -> Option<String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("list.csv");
        std::fs::write(&path, text).unwrap();
        let source = labfiles::open(&path).unwrap();
        why(source.as_ref()).map(|[reason, _]| reason)
    }

    fn rows(heading: &str, row: impl Fn(i32) -> String) -> String {
        let rows = (0..20).map(|k| format!("{}\n", row(k)));
        std::iter::once(format!("{heading}\n"))
            .chain(rows)
            .collect()
    }

    #[test]
    fn amplitudes_of_swings_are_named_and_records_are_not() {
        let fall = |k: i32| 40.0 * 0.93_f64.powi(k);
        let swings = [
            rows("n,A (mm)", |k| format!("{k},{:.1}", fall(k))),
            rows("Swing,Amplitude (mm)", |k| format!("{k},{:.1}", fall(k))),
            rows("n,t_n (s),A_n (cm)", |k| {
                format!("{k},{:.2},{:.2}", 0.8 * f64::from(k), fall(k))
            }),
            rows("n,A_n / cm,ln(A_0/A_n)", |k| {
                format!("{k},{:.2},{:.4}", fall(k), (40.0 / fall(k)).ln())
            }),
            rows("k,x_k (mm)", |k| {
                format!("{k},{:.1}", fall(k) * f64::from(1 - 2 * (k % 2)))
            }),
        ];
        for text in &swings {
            let reason = of(text).unwrap_or_default();
            assert!(reason.contains("successive swings"), "{text}: {reason}");
        }
        let cart = rows("Sample,x (mm)", |k| {
            format!("{k},{:.1}", 900.0 - 30.0 * f64::from(k))
        });
        let heights = "Bounce,Height (cm)\n0,100\n1,64.1\n2,41.0\n3,26.2\n4,16.9\n";
        let decay = rows("t (s),Amplitude (V)", |k| {
            format!(
                "{:.2},{:.3}",
                0.02 * f64::from(k),
                (0.9 * f64::from(k)).cos()
            )
        });
        for text in [cart.as_str(), heights, &decay] {
            assert_eq!(of(text), None, "{text}");
        }
    }

    #[test]
    fn laps_alone_as_times_of_day_are_named() {
        let laps = "Lap\n00:00.98\n00:00.83\n00:00.69\n00:00.58\n00:00.49\n";
        assert!(of(laps).unwrap_or_default().contains("laps"));
        let totals = "Total\n00:00.98\n00:01.81\n00:02.50\n00:03.08\n00:03.57\n";
        assert_eq!(of(totals), None);
    }
}
