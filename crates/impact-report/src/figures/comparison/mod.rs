//! A chosen point: simulated beside measured over the drive periods, phase portraits, residuals.

mod data;
mod portraits;
mod rows;
mod sheet;

pub(crate) use data::name;

use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Canvas, Stroke, TextLook};
use crate::kit::figure::Figure;
use crate::kit::fonts::Face;
use crate::kit::look;
use crate::kit::marks;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::kit::richtext;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::{ReplayedRecord, Signal};
use impact_records::record::Role;
use impact_records::signal::robust::range;
use rows::{Row, rows, shown, symbol};
use sheet::{Sheet, TOP, TimeAxis};

/// Room left of the first column, for numbers and titles, points.
const LEFT: f64 = 40.0;
/// Width of a column of panels beside phase portraits, and without them.
const COLUMNS: [f64; 2] = [136.0, 201.0];
/// Room between the columns of panels, points.
const COLUMN_GAP: f64 = 35.0;
/// Distance of the titles of upward axes from their frames.
const TITLE_REACH: f64 = 22.0;
/// Room between the rows of panels, points.
const ROW_GAP: f64 = 5.0;
/// Room below the panels, for numbers and title, points.
const BOTTOM: f64 = 22.0;

/// Draws one comparison; `None` if it has no trace at all.
pub(crate) fn draw<'a>(comparison: &'a ReplayedRecord, locale: Locale<'a>) -> Option<Figure> {
    let rows = rows(comparison);
    let portraits = portraits::portraits(comparison);
    if rows.is_empty() {
        return None;
    }
    let stack: f64 = rows.iter().map(|r| r.height + ROW_GAP).sum::<f64>() - ROW_GAP;
    let stack = stack.max(if portraits.is_empty() { 0.0 } else { 100.0 });
    let mut sheet = Sheet {
        comparison,
        locale,
        canvas: Canvas::new(look::FULL_WIDTH, TOP + stack + BOTTOM),
        time: time_axis(comparison, &rows),
        column: COLUMNS[usize::from(portraits.is_empty())],
    };
    sheet.heading();
    sheet.columns(&rows);
    sheet.portraits(&portraits, stack);
    let name = name(comparison);
    let letter = comparison.letter.to_string();
    let values = [("letter", letter.as_str())];
    let title = locale.translate_with(Phrase::PointComparedTitle, &values);
    Some(Figure::new(
        name,
        &title,
        sheet.canvas,
        data::csv(comparison),
    ))
}

/// Time axis in drive periods from the first whole period.
fn time_axis(comparison: &ReplayedRecord, rows: &[Row<'_>]) -> TimeAxis {
    let signals = rows.iter().flat_map(|r| &r.traces).flat_map(|(t, _)| {
        let others = t.simulated.iter().chain(&t.residual);
        std::iter::once(&t.measured).chain(others)
    });
    let span = range(
        signals
            .flat_map(|s| s.time_s.first().into_iter().chain(s.time_s.last()))
            .copied(),
    );
    let (first, last) = span.unwrap_or((0.0, 1.0));
    let period = comparison.drive_period_s;
    let start = (first / period + 1e-6).floor() * period;
    TimeAxis {
        start,
        period,
        shown: ((first - start) / period, (last - start) / period),
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Simulated,
    Measured,
}

impl Sheet<'_> {
    /// Left edge of a column of panels.
    fn left(&self, side: Side) -> f64 {
        match side {
            Side::Simulated => LEFT,
            Side::Measured => LEFT + self.column + COLUMN_GAP,
        }
    }

    /// The point's letter and mark, before the titles of the columns.
    fn heading(&mut self) {
        let c = self.comparison;
        let letter = format!("({})", c.letter);
        let bold = TextLook::new(9.0, Anchor::Left)
            .face(Face::Bold)
            .colour(look::INK);
        self.canvas.text((1.0, TOP - 4.0), &letter, bold);
        let after = 1.0 + richtext::width(&letter, Face::Bold, 9.0) + 6.0;
        marks::draw(
            &mut self.canvas,
            (after, TOP - 7.0),
            2.9,
            marks::of(&c.motion),
        );
    }

    fn columns(&mut self, rows: &[Row<'_>]) {
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        let middle = |sheet: &Self, side: Side| sheet.left(side) + 0.5 * sheet.column;
        if !rows.is_empty() {
            for (side, word) in [
                (Side::Simulated, Phrase::Simulated),
                (Side::Measured, Phrase::Measured),
            ] {
                let at = (middle(self, side), TOP - 4.0);
                self.canvas.text(at, &self.locale.translate(word), title);
            }
        }
        let last_plain = rows.iter().rposition(|r| !r.residual);
        let mut top = TOP;
        for (i, row) in rows.iter().enumerate() {
            let last = i + 1 == rows.len();
            if row.residual {
                self.panel(row, Side::Measured, top, last);
                self.residual_note(row, top);
            } else {
                self.panel(row, Side::Simulated, top, Some(i) == last_plain);
                self.panel(row, Side::Measured, top, last);
            }
            top += row.height + ROW_GAP;
        }
    }

    fn panel(&mut self, row: &Row<'_>, side: Side, top: f64, below: bool) {
        let rect = Rect::new(self.left(side), top, self.column, row.height);
        let values = row.traces.iter().flat_map(|(t, _)| match row.residual {
            // The sample of a contact shows neither flight.
            true => t.clear_residual().unwrap_or_default(),
            false => shown(t).flat_map(|s| s.values.iter().copied()).collect(),
        });
        let contact = row.traces.iter().any(|(t, _)| t.role == Role::Contact);
        let least: &[f64] = if contact { &[0.0, 1.0] } else { &[] };
        let values = values.chain(least.iter().copied());
        let values = values.map(|v| v * row.unit.factor);
        let y = Axis::around(values, 0.08, row.title.clone());
        let y = y.with_ticks(if row.height > 35.0 { 3 } else { 2 });
        let panel = Panel::new(rect, self.time.axis(), y).with_title_reach(TITLE_REACH);
        self.canvas.layer(0);
        if !self.is_empty(row, side) && panel.y.low < 0.0 && panel.y.high > 0.0 {
            panel.level(&mut self.canvas, 0.0, look::ZERO_STROKE);
        }
        self.impacts(&panel, side);
        self.canvas.layer(1);
        // The first mass last and thinner, so that both are seen where they move alike.
        for (i, (trace, colour)) in row.traces.iter().enumerate().rev() {
            let signal = match (row.residual, side) {
                (true, _) => trace.residual.as_ref(),
                (false, Side::Simulated) => trace.simulated.as_ref(),
                (false, Side::Measured) => Some(&trace.measured),
            };
            if let Some(signal) = signal {
                let stroke = match (row.residual, i) {
                    (true, _) => Stroke::solid(*colour, 0.45),
                    (false, 0) => Stroke::solid(*colour, 0.6),
                    (false, _) => Stroke::solid(marks::mix(*colour, 0.75), 1.6),
                };
                self.signal(&panel, signal, row.unit.factor, stroke);
            }
        }
        self.canvas.layer(2);
        let left = side == Side::Simulated || row.residual;
        panel.frame(&mut self.canvas, Sides { below, left }, self.locale);
        self.empty_note(row, side, &panel);
    }

    fn signal(&mut self, panel: &Panel, signal: &Signal, factor: f64, stroke: Stroke) {
        let data = signal.time_s.iter().zip(&signal.values);
        let data: Vec<_> = data.map(|(t, v)| (self.time.of(*t), v * factor)).collect();
        panel.curve(&mut self.canvas, data, stroke);
    }

    /// Pale upright lines at the impacts.
    fn impacts(&mut self, panel: &Panel, side: Side) {
        let times = match side {
            Side::Measured => &self.comparison.impacts_s,
            Side::Simulated => &self.comparison.simulated_impacts_s,
        };
        for t in times.iter().map(|t| self.time.of(*t)) {
            panel.upright(
                &mut self.canvas,
                t,
                Stroke::dashed(look::ZERO_STROKE.colour, 0.4, &[1.0, 1.5]),
            );
        }
    }

    fn is_empty(&self, row: &Row<'_>, side: Side) -> bool {
        let simulated = row.traces.iter().any(|(t, _)| t.simulated.is_some());
        !row.residual && side == Side::Simulated && !simulated
    }

    /// In place of what is not simulated: of the contact its impacts, else a note.
    fn empty_note(&mut self, row: &Row<'_>, side: Side, panel: &Panel) {
        if !self.is_empty(row, side) {
            return;
        }
        let contact = row.traces.iter().any(|(t, _)| t.role == Role::Contact);
        if contact {
            return self.contact_stems(panel);
        }
        let r = panel.rect;
        let at = (0.5 * (r.left + r.right), 0.5 * (r.top + r.bottom) + 2.5);
        let quiet = TextLook::new(look::NOTE_SIZE, Anchor::Middle).colour(look::QUIET);
        self.canvas
            .text(at, &self.locale.translate(Phrase::NotModelled), quiet);
    }

    /// The impacts of the simulation as stems on a level line.
    fn contact_stems(&mut self, panel: &Panel) {
        let (low, high) = (panel.y.low.max(0.0), 0.93 * panel.y.high);
        let stroke = Stroke::solid(look::BLUE, 0.65);
        panel.level(&mut self.canvas, low, stroke);
        for time in &self.comparison.simulated_impacts_s {
            panel.error_bar(&mut self.canvas, self.time.of(*time), (low, high), stroke);
        }
    }

    /// Under the simulated column, beside the residual: its size in words.
    fn residual_note(&mut self, row: &Row<'_>, top: f64) {
        let quiet = TextLook::new(look::NOTE_SIZE, Anchor::Left).colour(look::QUIET);
        let lines = row.traces.iter().filter_map(|(trace, _)| {
            let [rms, whole] = trace.residual_and_whole()?;
            let value = self.locale.significant(rms * row.unit.factor, 2);
            let share = self.locale.significant(100.0 * rms / whole, 2);
            let name = symbol(trace.role);
            let text = Phrase::RmsResidual;
            let value = format!("{value} {}", row.unit.symbol);
            let values = [("name", name), ("value", &value), ("share", &share)];
            Some(self.locale.translate_with(text, &values))
        });
        // up to the two lines of the residual's title
        let room = self.column + COLUMN_GAP - TITLE_REACH - 2.0 * look::TITLE_SIZE;
        for (i, line) in lines.collect::<Vec<_>>().iter().enumerate() {
            let y = top + 24.0 + 9.5 * i as f64;
            let width = richtext::width(line, Face::Regular, look::NOTE_SIZE);
            let size = look::NOTE_SIZE * (room / width).min(1.0);
            self.canvas
                .text((LEFT, y), line, TextLook { size, ..quiet });
        }
    }
}
