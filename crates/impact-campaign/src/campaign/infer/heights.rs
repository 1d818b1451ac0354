//! Tables of heights: which columns contain those of drops and of the tops after impacts.

use super::place::Place;
use super::roles::words;
use impact_records::record::ContactContent;
use impact_records::signal::robust;
use labfiles::units::{self, Dimension};
use labfiles::{ChannelInfo, StoredType, timing, without_run};

/// Fewest rows of heights below each other, and most rows.
const FEWEST_BELOW: usize = 3;
const MOST_ROWS: u64 = 400;
/// Stems of the word for a height, lower case.
const HEIGHTS: [&str; 7] = [
    "height",
    "rebound",
    "höhe",
    "hoehe",
    "rückprall",
    "hauteur",
    "altezza",
];
/// Stems of words for what falls and rises again, whose lengths are heights.
const MOTIONS: [&str; 5] = ["drop", "bounce", "fall", "rebond", "chute"];
/// Stems of words in the names of lengths that no body has reached: computed, expected, or its size; lower case.
const COMPUTED: [&str; 30] = [
    "mean",
    "average",
    "avg",
    "mittel",
    "moyenne",
    "lost",
    "loss",
    "verlust",
    "differen",
    "delta",
    "δ",
    "ratio",
    "deviation",
    "uncertain",
    "error",
    "abw",
    "unsicher",
    "fehler",
    "energ",
    "percent",
    "prozent",
    "efficien",
    "restitution",
    "±",
    "theor",
    "expect",
    "predict",
    "diamet",
    "durchmess",
    "radius",
];
/// Whole words of the same.
const COMPUTED_WORDS: [&str; 7] = ["sd", "std", "stdev", "sem", "cor", "diff", "unc"];
/// Words that count the tops of a throw, lower case.
const ORDINALS: [&str; 10] = [
    "first", "second", "third", "fourth", "fifth", "erste", "zweite", "dritte", "vierte", "next",
];
/// Stems of words that tell a drop from its rebounds, lower case.
const STAGES: [&str; 6] = ["drop", "fall", "release", "rebound", "bounce", "sprung"];
/// Part of the heights below each other that are below the one before.
const MOSTLY: f64 = 0.6;
/// Least fall from the second column to the third over that from the first to the second, in logarithms, of heights
/// that follow from one another: repeated rebounds of one drop are alike.
const FOLLOWS: f64 = 0.4;

/// How a table states heights: the columns in their order, and what they contain.
pub(super) struct Heights {
    pub(super) columns: Vec<usize>,
    /// Whether the names of the rebounds are those of bodies or floors, and no numbers.
    pub(super) of_bodies: bool,
    pub(super) content: ContactContent,
}

/// The heights of a table: a column of them beside numbers of its rows and what is computed from it, or columns in a unit
/// of length beside others of no time.
pub(super) fn of(place: Place<'_>) -> Option<Heights> {
    let channels = &place.set().channels;
    let rows = channels.iter().map(|c| c.samples).max().unwrap_or(0);
    let counts =
        |c: &ChannelInfo| c.stored == StoredType::Text || c.unit.is_none() && numbers_rows(&c.name);
    let computed =
        |c: &ChannelInfo| is_computed(c) || channels.iter().any(|of| is_uncertainty_of(c, of));
    let numbers: Vec<usize> = (0..channels.len())
        .filter(|i| !counts(&channels[*i]) && !computed(&channels[*i]))
        .collect();
    let (used, others): (Vec<usize>, Vec<usize>) =
        numbers.iter().partition(|i| may_be_height(&channels[**i]));
    let bounces = counts_bounces(channels);
    let named = bounces || used.iter().any(|i| names_height(&channels[*i]));
    let alone =
        others.is_empty() || used.len() > 1 && !others.iter().any(|i| may_be_time(&channels[*i]));
    if rows > MOST_ROWS || !named || !alone {
        return None;
    }
    let values = in_one_unit(place, &used);
    let tops = used.iter().skip(1).map(|i| &channels[*i]);
    let of_bodies = used.len() > 2 && !numbered(tops);
    let content = match values.as_slice() {
        [] => None,
        [below] => falls(below).then_some(ContactContent::Heights),
        _ if bounces && are_of_throws(&values) => None,
        [first, second] => below(first, second).then_some(ContactContent::Heights),
        [first, second, third, ..] => {
            let all = values[1..].iter().all(|column| below(first, column));
            let follow = !of_bodies && fall(second, third) > FOLLOWS * fall(first, second);
            let tells = |i: &usize| called(&channels[*i], &STAGES);
            let alike = used.iter().all(|i| tells(i) == tells(&used[0]));
            (all && !(alike && are_throws(&values))).then_some(if follow {
                ContactContent::Heights
            } else {
                ContactContent::Rebounds
            })
        }
    };
    Some(Heights {
        columns: used,
        of_bodies,
        content: content?,
    })
}

/// Stems of the words for an impact that rows are counted by, lower case.
const BOUNCES: [&str; 6] = ["bounce", "impact", "prell", "aufprall", "rebond", "rimbalz"];

/// Whether a column of plain numbers counts the impacts of one throw, row by row.
fn counts_bounces(channels: &[ChannelInfo]) -> bool {
    let of_rows = |c: &ChannelInfo| c.unit.is_none() && numbers_rows(&c.name);
    channels.iter().any(|c| of_rows(c) && called(c, &BOUNCES))
}

/// Whether several columns fall from row to row each, as where each is a throw of its own.
fn are_of_throws(columns: &[Vec<f64>]) -> bool {
    columns.len() > 1 && columns.iter().all(|column| falls(column))
}

/// The columns of a table whose rows are the impacts of several throws, one beside the other.
pub(super) fn side_by_side(place: Place<'_>) -> Option<Vec<&str>> {
    let channels = &place.set().channels;
    let rows = channels.iter().map(|c| c.samples).max().unwrap_or(0);
    if rows > MOST_ROWS || !counts_bounces(channels) {
        return None;
    }
    let each = channels.iter().enumerate();
    let heights = each.filter(|(_, c)| may_be_height(c) && !is_computed(c));
    let used: Vec<usize> = heights.map(|(i, _)| i).collect();
    let names = used.iter().map(|i| channels[*i].name.as_str());
    are_of_throws(&in_one_unit(place, &used)).then(|| names.collect())
}

/// Whether a column numbers the rows, or the trials.
pub(super) fn numbers_rows(name: &str) -> bool {
    timing::numbers_rows(name) || is_trial(name)
}

/// Whether a name is a word of a trial alone: `Trial`, `Versuch`.
pub(super) fn is_trial(name: &str) -> bool {
    let run = without_run(&format!("{} 1", name.trim()));
    run.is_some_and(|(bare, _)| bare.is_empty())
}

/// Whether a column is computed from others by its name.
pub(super) fn is_computed(channel: &ChannelInfo) -> bool {
    called(channel, &COMPUTED)
        || words(&channel.name)
            .iter()
            .any(|w| COMPUTED_WORDS.contains(&&**w))
}

/// Letters before the name of a quantity whose uncertainty a column states: `dh0`, `u(h0)`, `σ_h0`; lower case.
const UNCERTAINTIES: [&str; 7] = ["d", "u", "s", "σ", "sd", "err", "unc"];

/// Whether a column is called as the uncertainty of another.
fn is_uncertainty_of(channel: &ChannelInfo, of: &ChannelInfo) -> bool {
    let plain = |name: &str| -> String {
        let letters = name.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    let (own, other) = (plain(&channel.name), plain(&of.name));
    let before = own.strip_suffix(other.as_str());
    !other.is_empty() && before.is_some_and(|letters| UNCERTAINTIES.contains(&letters))
}

/// Whether a name is the letter of a height with a number or without: `h`, `h0`, `h_1`, `H 2`.
fn is_letter_of_height(name: &str) -> bool {
    let number = name.trim().strip_prefix(['h', 'H']);
    number.is_some_and(|n| {
        n.chars()
            .all(|c| c.is_ascii_digit() || matches!(c, '_' | ' '))
    })
}

/// Whether each of some names has a number in it, as where they count the tops of a throw; names without are those of
/// bodies or floors.
fn numbered<'a>(mut channels: impl Iterator<Item = &'a ChannelInfo>) -> bool {
    let counts = |word: &str| {
        word.contains(|c: char| c.is_ascii_digit()) || ORDINALS.iter().any(|o| word.starts_with(o))
    };
    channels.all(|channel| words(&channel.name).iter().any(|word| counts(word)))
}

/// Whether a column may be that of a time: by its unit or, without one, its name.
fn may_be_time(channel: &ChannelInfo) -> bool {
    match units::unit_of(channel.unit.as_deref(), &channel.name) {
        Some(unit) => unit.dimension == Dimension::Time,
        None => timing::is_time_name(&channel.name),
    }
}

/// Whether a column is one of heights by its name: of a height, or of what falls and rises in a unit of length.
fn names_height(channel: &ChannelInfo) -> bool {
    let in_length = units::unit_of(channel.unit.as_deref(), &channel.name).is_some();
    let moves = called(channel, &MOTIONS) || is_letter_of_height(&channel.name);
    called(channel, &HEIGHTS) || in_length && moves
}

/// The numbers of columns, m; a column without a unit has that of the first one with one.
fn in_one_unit(place: Place<'_>, columns: &[usize]) -> Vec<Vec<f64>> {
    let channels = &place.set().channels;
    let factor = |i: &usize| {
        let channel = &channels[*i];
        units::unit_of(channel.unit.as_deref(), &channel.name).map(|unit| unit.to_si)
    };
    let of_first = columns.iter().find_map(factor).unwrap_or(1.0);
    let numbers = |i: &usize| {
        let factor = factor(i).unwrap_or(of_first);
        let values = place.numbers(*i).into_iter();
        values.map(|value| factor * value).collect()
    };
    columns.iter().map(numbers).collect()
}

fn called(channel: &ChannelInfo, stems: &[&str]) -> bool {
    let name = channel.name.to_lowercase();
    stems.iter().any(|stem| name.contains(stem))
}

/// Whether a column is a length by its unit or, without one, a height by its name or a trial of one.
fn may_be_height(channel: &ChannelInfo) -> bool {
    match units::unit_of(channel.unit.as_deref(), &channel.name) {
        Some(unit) => unit.dimension == Dimension::Length,
        None => {
            let run = without_run(&channel.name);
            let named = called(channel, &HEIGHTS) || is_letter_of_height(&channel.name);
            channel.unit.is_none() && (named || run.is_some_and(|(bare, _)| bare.is_empty()))
        }
    }
}

/// Whether heights below each other are those of a mass that bounces.
fn falls(values: &[f64]) -> bool {
    let filled: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let lower = filled.windows(2).filter(|w| w[1] < w[0]).count();
    filled.len() >= FEWEST_BELOW && lower as f64 >= MOSTLY * (filled.len() - 1) as f64
}

/// Whether each height of a column is below that in another.
fn below(before: &[f64], after: &[f64]) -> bool {
    let pairs = before.iter().zip(after);
    let mut filled = pairs.filter(|(b, a)| b.is_finite() && a.is_finite());
    filled.all(|(b, a)| *a > 0.0 && a < b)
}

/// How many times the fall from the first column to the others heights fall from row to row, at least, where each column is a
/// throw of its own.
const DOWN: f64 = 4.0;

/// Whether each column is the tops of a throw: they fall from row to row, and are alike along the rows.
fn are_throws(columns: &[Vec<f64>]) -> bool {
    let down = |column: &Vec<f64>| {
        let below = column.get(1..).unwrap_or_default();
        fall(column, below)
    };
    let along = |column: &Vec<f64>| fall(&columns[0], column).abs();
    let most = columns.iter().map(along).fold(0.0, f64::max);
    columns.iter().all(|c| falls(c)) && columns.iter().all(|c| down(c) > DOWN * most)
}

/// The typical fall from one column to another, as a logarithm.
fn fall(before: &[f64], after: &[f64]) -> f64 {
    let each = before.iter().zip(after).map(|(b, a)| (b / a).ln());
    let each: Vec<f64> = each.filter(|l| l.is_finite()).collect();
    robust::median(&each).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The heights of a text.
    fn of_text(text: &str) -> Option<(Vec<usize>, ContactContent)> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("heights.csv");
        std::fs::write(&path, text).unwrap();
        let source = labfiles::open(&path).unwrap();
        let place = Place {
            source: source.as_ref(),
            dataset: 0,
        };
        of(place).map(|found| (found.columns, found.content))
    }

    #[test]
    fn heights_are_pairs_rows_repeated_rebounds_or_a_column() {
        use ContactContent::{Heights, Rebounds};
        let pairs =
            "trial,drop_height_cm,rebound_height_cm\n1,50.0,27.6\n2,75.0,41.7\n3,100.0,55.7\n";
        assert_eq!(of_text(pairs), Some((vec![1, 2], Heights)));
        let german = "Fallhöhe (cm);Sprunghöhe (cm)\n50;27\n75;41\n100;55\n";
        assert_eq!(of_text(german), Some((vec![0, 1], Heights)));
        let along = "height 0 (m),height 1 (m),height 2 (m)\n1.0,0.64,0.41\n1.0,0.63,0.40\n";
        assert_eq!(of_text(along), Some((vec![0, 1, 2], Heights)));
        let trials = "Drop height (cm),Trial 1 (cm),Trial 2 (cm),Trial 3 (cm),Average (cm)\n\
                      100,64,63,65,64\n80,51,50.5,52,51.2\n60,38,38.5,39,38.5\n";
        assert_eq!(of_text(trials), Some((vec![0, 1, 2, 3], Rebounds)));
        // of two balls, beside what is computed from them and other quantities
        let bodies = "Drop height (cm),Ball A rebound (cm),Ball B rebound (cm)\n100,64,36\n80,51,29\n60,38,22\n";
        assert_eq!(of_text(bodies), Some((vec![0, 1, 2], Rebounds)));
        // of a ball that loses little
        let steel = "Drop height (cm),Ball A (cm),Ball B (cm)\n100,98,97\n70,68.6,67.9\n50,49,48.5\n30,29.4,29.1\n";
        assert_eq!(of_text(steel), Some((vec![0, 1, 2], Rebounds)));
        let lost = "Drop height (cm),Rebound height (cm),Height lost (cm),SD (cm),COR\n100,64,36,1,0.8\n80,51,29,1,0.8\n";
        assert_eq!(of_text(lost), Some((vec![0, 1], Heights)));
        let warm = "Temperature (°C),Drop (m),Bounce (cm)\n20,1.0,64\n30,0.8,51\n40,0.6,38\n";
        assert_eq!(of_text(warm), Some((vec![1, 2], Heights)));
        let uncertain = "trial,h0 (cm),Δh0 (cm),h1 (cm),dh1 (cm)\n1,40,0.2,24.4,0.5\n2,52,0.2,31.7,0.5\n3,64,0.2,39.0,0.5\n";
        assert_eq!(of_text(uncertain), Some((vec![1, 3], Heights)));
        let turned = "Drop height (cm),40,60,80,100\nRebound height (cm),24.4,36.5,48.6,60.8\n";
        assert_eq!(of_text(turned), Some((vec![0, 1], Heights)));
        let column = "bounce,height (cm)\n0,100\n1,64.2\n2,40.9\n3,26.0\n";
        assert_eq!(of_text(column), Some((vec![1], Heights)));
    }

    #[test]
    fn other_tables_are_none_of_heights() {
        assert_eq!(
            of_text("height (cm),time (s)\n50,27\n75,41\n100,55\n"),
            None
        );
        assert_eq!(of_text("volts,mm\n3.0,0.5\n2.1,0.3\n1.9,0.1\n"), None);
        assert_eq!(
            of_text("height (cm),mass (kg)\n170,70\n180,80\n190,90\n"),
            None
        );
        // a throw in each column
        let throws = "Ball A height (cm),Ball B height (cm),Ball C height (cm)\n100,99,98\n66,65,64\n43,42.5,42\n28,27.5,27\n";
        assert_eq!(of_text(throws), None);
        // of people
        assert_eq!(of_text("height (cm)\n170\n180\n165\n190\n"), None);
    }
}
