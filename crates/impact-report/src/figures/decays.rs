//! Free decays with their fits, three to a row.

use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Canvas, Stroke, TextLook};
use crate::kit::csv::Csv;
use crate::kit::figure::Figure;
use crate::kit::fonts::Face;
use crate::kit::look;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::kit::units::print_unit;
use crate::locale::Locale;
use crate::parameters::decimals_for;
use crate::phrase::{Phrase, Text};
use impact_identification::replay::{FreeDecay, Signal};
use impact_records::signal::robust::range;
use labfiles::units::Dimension;

/// How many decays one figure holds.
pub(crate) const PER_FIGURE: usize = 6;

/// Panels in a row.
const COLUMNS: usize = 3;
/// Height of a panel, points.
const PANEL_HEIGHT: f64 = 74.0;
/// Height of a row with the words above and the numbers below its panels, points.
const ROW_HEIGHT: f64 = PANEL_HEIGHT + 58.0;
/// Characters of a title that fit above a panel.
const TITLE_LENGTH: usize = 30;

/// Draws up to [`PER_FIGURE`] decays; `None` for none.
pub(crate) fn draw(decays: &[FreeDecay], name: &str, locale: Locale<'_>) -> Option<Figure> {
    if decays.is_empty() {
        return None;
    }
    let rows = decays.len().div_ceil(COLUMNS);
    let mut canvas = Canvas::new(look::FULL_WIDTH, rows as f64 * ROW_HEIGHT);
    for (i, decay) in decays.iter().enumerate() {
        let left = 34.0 + (i % COLUMNS) as f64 * 161.0;
        let top = (i / COLUMNS) as f64 * ROW_HEIGHT + 33.0;
        one(
            &mut canvas,
            decay,
            Rect::new(left, top, 122.0, PANEL_HEIGHT),
            locale,
        );
    }
    Some(Figure::new(
        name,
        &locale.translate(Phrase::FreeDecaysAndTheirFits),
        canvas,
        csv(decays),
    ))
}

fn one(canvas: &mut Canvas, decay: &FreeDecay, rect: Rect, locale: Locale<'_>) {
    let peak = decay
        .measured
        .values
        .iter()
        .fold(0.0_f64, |m, v| m.max(v.abs()));
    let unit = print_unit(decay.dimension, peak);
    let symbol = match decay.dimension {
        Dimension::Acceleration => Some("$a$"),
        Dimension::Velocity => Some("$v$"),
        Dimension::Length => Some("$x$"),
        _ => None,
    };
    let title = match symbol {
        Some(symbol) => format!("{symbol} ({})", unit.symbol).into(),
        None => Text::from((Phrase::Signal, unit.symbol)),
    };
    let times = decay.measured.time_s.iter().copied();
    let (start, end) = range(times).unwrap_or((0.0, 1.0));
    let x = Axis::new(start, end, "$t$ (s)").with_ticks(4);
    let values = decay.measured.values.iter().map(|v| v * unit.factor);
    let y = Axis::around(values, 0.06, title).with_ticks(4);
    let panel = Panel::new(rect, x, y);
    canvas.layer(0);
    panel.level(canvas, 0.0, look::ZERO_STROKE);
    canvas.layer(1);
    signal(
        canvas,
        &panel,
        &decay.measured,
        unit.factor,
        Stroke::solid(look::INK, 0.5),
    );
    signal(
        canvas,
        &panel,
        &decay.fitted,
        unit.factor,
        Stroke::solid(look::VERMILION, 0.6),
    );
    canvas.layer(2);
    panel.frame(canvas, Sides::BOTH, locale);
    heading(canvas, decay, &rect, locale);
}

fn signal(canvas: &mut Canvas, panel: &Panel, signal: &Signal, factor: f64, stroke: Stroke) {
    let data = signal.time_s.iter().zip(&signal.values);
    panel.curve(canvas, data.map(|(t, v)| (*t, v * factor)), stroke);
}

fn heading(canvas: &mut Canvas, decay: &FreeDecay, rect: &Rect, locale: Locale<'_>) {
    let bold = TextLook::new(look::NOTE_SIZE, Anchor::Left)
        .face(Face::Bold)
        .colour(look::INK);
    // the values have lines of their own, so that a long name does not run into them
    canvas.text(
        (rect.left, rect.top - 23.0),
        &shortened(&title(decay)),
        bold,
    );
    let plain = TextLook::new(look::TICK_SIZE, Anchor::Right).colour(look::QUIET);
    let frequency = with_error(decay.natural_frequency_hz, locale);
    let lines = [
        format!("$f_0$ = {frequency}\u{2009}Hz"),
        format!("$β$ = {}", with_error(decay.damping_ratio, locale)),
    ];
    for (i, line) in lines.iter().enumerate() {
        canvas.text((rect.right, rect.top - 13.5 + 9.5 * i as f64), line, plain);
    }
}

/// A title with its middle left out where it is too long: names differ at their ends.
fn shortened(title: &str) -> String {
    let count = title.chars().count();
    if count <= TITLE_LENGTH {
        return title.to_owned();
    }
    let front: String = title.chars().take(TITLE_LENGTH / 3).collect();
    let end: String = title.chars().skip(count - 2 * TITLE_LENGTH / 3).collect();
    format!("{front}…{end}")
}

/// Name of a decay: its record's, after its specimen's if there are several.
pub(crate) fn title(decay: &FreeDecay) -> String {
    match &decay.specimen {
        Some(specimen) => format!("{specimen}: {}", decay.record),
        None => decay.record.clone(),
    }
}

fn with_error([value, error]: [f64; 2], locale: Locale<'_>) -> String {
    if error > 0.0 {
        let decimals = decimals_for(error);
        let [value, error] = [value, error].map(|v| locale.fixed(v, decimals));
        format!("{value} ± {error}")
    } else {
        locale.significant(value, 4)
    }
}

fn csv(decays: &[FreeDecay]) -> String {
    let mut csv = Csv::new(&["record", "source", "time_s", "value_si"]);
    for decay in decays {
        let record = title(decay);
        for (source, signal) in [("measured", &decay.measured), ("fitted", &decay.fitted)] {
            for (t, v) in signal.time_s.iter().zip(&signal.values) {
                csv.row()
                    .texts(&[&record, source])
                    .numbers(&[Some(*t), Some(*v)]);
            }
        }
    }
    csv.finish()
}
