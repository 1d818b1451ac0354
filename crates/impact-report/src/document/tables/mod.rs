//! The tables of the document.

mod brackets;
mod budget;
mod campaigns;
mod column;
mod estimates;
mod fitted;
mod records;

use std::collections::BTreeMap;

pub(super) use brackets::brackets;
pub(super) use budget::budget;
pub use budget::budget_source;
pub(super) use campaigns::{campaigns, differences, separate, shared};
pub(super) use estimates::{agreement, methods, specimen_methods, specimens};
pub(super) use records::records;

use column::{Column, table};

use crate::content::ReportContent;
use crate::document::model::{Align, Rich, Table};
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_fit::Item;
use impact_identification::replay::{Unusable, UnusableReason};

/// Further tables of the content.
pub(super) fn further<'a>(
    content: &'a ReportContent,
    locale: Locale<'a>,
) -> impl Iterator<Item = Table> + 'a {
    let with_rows = content.tables.iter().filter(|t| !t.rows.is_empty());
    with_rows.map(move |t| {
        let rows = t
            .rows
            .iter()
            .map(|row| row.iter().map(Rich::from).collect());
        let heads = t.heads.iter().map(|h| Rich::from(locale.text(h)));
        Table {
            caption: Rich::from(locale.translate(t.caption)),
            heads: heads.collect(),
            align: vec![Align::Right; t.heads.len()],
            widths: vec![0; t.heads.len()],
            ..Table::of(rows.collect())
        }
    })
}

/// Records that no method could use, by reason, and what the fits left out.
pub(super) fn left_out(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let records = content.compared.unusable.iter().map(|u| {
        let count = Some(u.records.len()).filter(|n| *n > 1);
        (
            Rich::verbatim(first_few(&u.records)),
            count,
            Rich::verbatim(unusable(u, locale)),
        )
    });
    let fits = fits_left_out(content, locale);
    let rows = records.chain(fits).map(|(what, count, why)| {
        let count = count.map_or(String::new(), |c| c.to_string());
        vec![what, Rich::from(count), why]
    });
    let columns = vec![
        Column::wide(Phrase::LeftOut, 2),
        Column::right(Phrase::Count),
        Column::wide(Phrase::Why, 5),
    ];
    table("", columns, rows.collect(), locale)
}

/// What the fits left out: items with one reason in one row.
fn fits_left_out(content: &ReportContent, locale: Locale<'_>) -> Vec<(Rich, Option<usize>, Rich)> {
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    // impacts are in a remark of their method
    let items = content.identification.left_out.iter();
    for one in items.filter(|l| !matches!(l.item, Item::Impact { .. })) {
        let (item, why) = (locale.message(&one.item), locale.message(&one.reason));
        match groups.iter_mut().find(|group| group.0 == why) {
            Some((_, items)) => items.push(item),
            None => groups.push((why, vec![item])),
        }
    }
    let row = |(why, items): (String, Vec<String>)| {
        let count = Some(items.len()).filter(|n| *n > 1);
        (Rich::from(first_few(&items)), count, Rich::from(why))
    };
    groups.into_iter().map(row).collect()
}

/// The first few names.
fn first_few(records: &[String]) -> String {
    match records {
        [a, b, c, _, ..] => format!("{a}, {b}, {c} …"),
        few => few.join(", "),
    }
}

/// Why records are unusable: the flag, then its details, or why the motion is undetermined.
fn unusable(unusable: &Unusable, locale: Locale<'_>) -> String {
    let (what, details) = match &unusable.reason {
        UnusableReason::Flag(problem) => (locale.message(&problem.code()), locale.message(problem)),
        UnusableReason::Undetermined(why) => {
            let what = locale.translate(Phrase::MotionUndetermined);
            (what, locale.message(why))
        }
    };
    let of = unusable.channel.as_ref().map(|c| format!(" ({c})"));
    let text = format!("{what}{}: {details}", of.unwrap_or_default());
    match unusable.records.first().filter(|_| unusable.differ) {
        Some(record) => {
            let values = [("details", text.as_str()), ("record", record.as_str())];
            locale.translate_with(Phrase::DetailsOfOne, &values)
        }
        None => text,
    }
}

/// SHA-256 of the inputs. A folder of several is stated once, before them.
pub(super) fn hashes(inputs: &BTreeMap<String, String>, locale: Locale<'_>) -> Option<Table> {
    let mut folders: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
    for (path, hash) in inputs {
        let (folder, name) = path.split_at(path.rfind(['/', '\\']).map_or(0, |at| at + 1));
        folders.entry(folder).or_default().push((name, hash));
    }
    let row = |name: String, hash: &str| {
        let cells = [name, hash.to_owned()];
        cells.map(Rich::verbatim).to_vec()
    };
    let mut rows = Vec::new();
    for (folder, files) in folders {
        let shared = !folder.is_empty() && files.len() > 1;
        if shared {
            rows.push(row(folder.to_owned(), ""));
        }
        let before = if shared { INDENT } else { folder };
        rows.extend(
            files
                .iter()
                .map(|(n, hash)| row(format!("{before}{n}"), hash)),
        );
    }
    let columns = vec![Column::wide(Phrase::Input, 1), Column::left("SHA-256")];
    table(Phrase::TableHashes, columns, rows, locale).map(|t| Table {
        size: 5.6,
        code: true,
        ..t
    })
}

/// Before the name of a file that is listed under its folder.
const INDENT: &str = "\u{2003}";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_of_inputs_is_stated_once() {
        let paths = ["campaign.toml", "hall 3/a.csv", "hall 3/b.csv", "one/c.csv"];
        let hash = |path: &str| (path.to_owned(), format!("{:064x}", path.len()));
        let inputs = paths.into_iter().map(hash).collect();
        let table = hashes(&inputs, Locale::default()).expect("a table");
        let names: Vec<String> = table.rows.iter().map(|row| row[0].plain()).collect();
        let listed = ["campaign.toml", "hall 3/", "\u{2003}a.csv", "\u{2003}b.csv"];
        assert_eq!(names[..4], listed);
        assert_eq!(names[4..], ["one/c.csv"]);
        let of_folders = table.rows.iter().filter(|row| row[1] == Rich::default());
        assert_eq!(of_folders.count(), 1);
    }
}
