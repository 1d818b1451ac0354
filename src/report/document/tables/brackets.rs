//! The table of measured brackets.

use super::{Column, arrow, table};
use crate::compare::BracketRow;
use crate::report::content::ReportContent;
use crate::report::document::model::{Rich, Table};
use crate::report::figures::boundaries::symbol;
use crate::report::speech::Speech;

/// From how many brackets on their table is set small and in two columns.
const MANY_BRACKETS: usize = 14;

/// The measured brackets beside the simulated boundary; many of them small and in two columns.
pub fn brackets(content: &ReportContent, speech: Speech) -> Option<Table> {
    let many = content.compared.brackets.len() > MANY_BRACKETS;
    let rows = content
        .compared
        .brackets
        .iter()
        .map(|b| bracket_row(b, many, speech))
        .collect();
    let columns: [Column; 8] = [
        Column::left(if many { "" } else { "boundary" }),
        Column::left("$z$"),
        Column::right("$r$ (mm)"),
        Column::right("$ρ$"),
        Column::center(if many { "" } else { "sweep" }),
        Column::center("measured between (Hz)"),
        Column::right("simulated (Hz)"),
        Column::wide(if many { "" } else { "remark" }, 1),
    ];
    let caption = if many {
        "Measured brackets of the boundaries, and the boundary of the fitted model: = within the \
         bracket, < below, > above it; × not used in the fit."
    } else {
        "Measured brackets of the boundaries, and the boundary of the fitted model."
    };
    let table = table(caption, &columns, rows, speech)?;
    Some(if many {
        Table {
            size: 6.8,
            side_by_side: 2,
            ..table
        }
    } else {
        Table { size: 8.0, ..table }
    })
}

fn bracket_row(b: &BracketRow, many: bool, speech: Speech) -> Vec<Rich> {
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    vec![
        Rich::from(speech.say(symbol(b.kind))),
        Rich::from(speech.say(&b.motion.label())),
        Rich::from(speech.significant(1e3 * b.clearance_m, 3)),
        Rich::from(b.rho.map_or("–".into(), |r| speech.fixed(r, 3))),
        Rich::from(arrow(b.sweep)),
        Rich::from(format!(
            "{} … {}",
            speech.fixed(low, 3),
            speech.fixed(high, 3)
        )),
        Rich::from(b.simulated_hz.map_or("–".into(), |f| speech.fixed(f, 3))),
        Rich::from(if many {
            bracket_sign(b).into()
        } else {
            bracket_remark(b, speech)
        }),
    ]
}

fn bracket_sign(b: &BracketRow) -> &'static str {
    match (&b.left_out, b.simulated_hz) {
        (Some(_), _) => "×",
        (None, Some(f)) if f < b.frequency_low_hz => "<",
        (None, Some(f)) if f > b.frequency_high_hz => ">",
        (None, Some(_)) => "=",
        (None, None) => "",
    }
}

fn bracket_remark(b: &BracketRow, speech: Speech) -> String {
    let by = |phrase: &str, distance: f64| {
        speech.say_with(phrase, &[("distance", &speech.fixed(distance, 3))])
    };
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    match (&b.left_out, b.simulated_hz) {
        (Some(why), _) => {
            let why = speech.tell(&why.to_string());
            speech.say_with("not used: {why}", &[("why", &why)])
        }
        (None, Some(f)) if f < low => by("below by {distance} Hz", low - f),
        (None, Some(f)) if f > high => by("above by {distance} Hz", f - high),
        (None, Some(_)) => speech.say("within"),
        (None, None) => String::new(),
    }
}
