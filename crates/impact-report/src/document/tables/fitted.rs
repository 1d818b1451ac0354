//! Tables with names too long for the page: what the other columns leave is shared among the names.

use crate::document::model::{Align, Rich, Table};
use crate::kit::fonts::{self, Face};
use crate::kit::look;
use impact_records::signal::whole;

/// Room that a cell takes beside its text, over the size of the type, as the template has it.
const PADDING: f64 = 0.9;
/// Share of the page that a column of sentences needs at most.
const SENTENCES: f64 = 0.3;
/// Least width of a column of names, over the size of the type.
const LEAST_NAME: f64 = 8.0;

/// The table with names that leave the other columns their room: those with blanks wrap, others are cut at their front. A table
/// whose columns fit is as it was.
pub(super) fn fitted(table: Table) -> Table {
    let size = table.size;
    let text = |cell: &Rich| fonts::width(&cell.plain(), Face::Bold, size);
    let need = |i: usize| {
        let cells = table.rows.iter().map(|row| text(&row[i]));
        cells.fold(text(&table.heads[i]), f64::max) + PADDING * size
    };
    let mut widths: Vec<f64> = (0..table.heads.len())
        .map(|i| match table.widths[i] {
            0 => need(i),
            _ => need(i).min(SENTENCES * look::FULL_WIDTH),
        })
        .collect();
    let excess = widths.iter().sum::<f64>() - look::FULL_WIDTH;
    let least = LEAST_NAME * size;
    let names: Vec<usize> = (0..widths.len())
        .filter(|i| table.widths[*i] == 0 && table.align[*i] == Align::Left && widths[*i] > least)
        .collect();
    let spare: f64 = names.iter().map(|i| widths[*i] - least).sum();
    if excess <= 0.0 || spare <= 0.0 {
        return table;
    }
    let share = (excess / spare).min(1.0);
    let mut rows = table.rows;
    for &i in &names {
        widths[i] -= share * (widths[i] - least);
        let room = widths[i] - PADDING * size;
        for row in &mut rows {
            let plain = row[i].plain();
            let mut words = plain.split([' ', '-']);
            if words.any(|word| fonts::width(word, Face::Bold, size) > room) {
                row[i] = shortened(&row[i], room, size);
            }
        }
    }
    let whole = |width: &f64| u16::try_from(whole::count(width.floor())).unwrap_or(u16::MAX);
    Table {
        widths: widths.iter().map(whole).collect(),
        rows,
        ..table
    }
}

/// A name cut at its front if it is wider than its column: a wrapped line would shift the rows.
pub(super) fn shortened(name: &Rich, room: f64, size: f64) -> Rich {
    let plain = name.plain();
    let wide = |text: &str| fonts::width(text, Face::Bold, size) > room;
    if !wide(&plain) {
        return name.clone();
    }
    let starts = plain.char_indices().map(|(i, _)| i).skip(1);
    let fitting = starts
        .map(|i| format!("…{}", &plain[i..]))
        .find(|text| !wide(text));
    Rich::verbatim(fitting.unwrap_or_else(|| "…".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of a name, a group, a number and a sentence in each row.
    fn table(name: &str, group: &str) -> Table {
        let row = [
            name,
            group,
            "12.320",
            "speeds at impact, multiple shooting, trajectories",
        ];
        let rows = vec![row.map(|t| Rich::verbatim(t.to_owned())).to_vec(); 3];
        Table {
            heads: ["record", "specimen", "f (Hz)", "used by"]
                .map(|t| Rich::verbatim(t.to_owned()))
                .to_vec(),
            align: vec![Align::Left, Align::Left, Align::Right, Align::Left],
            widths: vec![0, 0, 0, 1],
            ..Table::of(rows)
        }
    }

    #[test]
    fn long_names_leave_the_other_columns_their_room() {
        let short = fitted(table("r001", "felt"));
        assert_eq!(short.widths, [0, 0, 0, 1]);
        let name = "Messreihe_2026_03_12_Pruefstand_A_Lauf_001_aufwaerts_9p400Hz_Spalt_2p400mm";
        let long = fitted(table(name, "Gummipuffer Shore 60 A, Charge eins"));
        let sum: f64 = long.widths.iter().map(|w| f64::from(*w)).sum();
        assert!(sum <= look::FULL_WIDTH && f64::from(long.widths[3]) > 0.25 * look::FULL_WIDTH);
        let cut = long.rows[0][0].plain();
        assert!(cut.starts_with('…') && cut.ends_with("2p400mm"), "{cut}");
        assert!(fonts::width(&cut, Face::Bold, long.size) < f64::from(long.widths[0]));
        // one with blanks wraps
        assert_eq!(
            long.rows[0][1].plain(),
            "Gummipuffer Shore 60 A, Charge eins"
        );
    }
}
