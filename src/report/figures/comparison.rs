//! A chosen point: simulated beside measured over the drive periods, phase portraits, residuals.

use super::axes::{Axis, Panel, Sides, range};
use super::canvas::{Anchor, Canvas, Colour, Stroke, TextLook};
use super::csv::Csv;
use super::fonts::Face;
use super::look::{self, NumberLook};
use super::marks;
use super::path::Rect;
use super::units::{PrintUnit, print_unit};
use super::{Figure, richtext};
use crate::record::Role;
use crate::report::content::{Comparison, Portrait, Signal, Trace};

const LEFT: f64 = 40.0;
/// Width of a column of panels beside phase portraits, and without them.
const COLUMNS: [f64; 2] = [136.0, 201.0];
const COLUMN_GAP: f64 = 35.0;
const PORTRAIT_LEFT: f64 = 387.0;
/// Distance of the titles of upward axes from their frames.
const TITLE_REACH: f64 = 22.0;
const PORTRAIT_WIDTH: f64 = look::FULL_WIDTH - PORTRAIT_LEFT - 2.0;
const ROW_GAP: f64 = 5.0;
const TOP: f64 = 27.0;
const BOTTOM: f64 = 22.0;
const BACK_WIDTH: f64 = 1.7;

/// A row of panels: which channels, how tall, how titled.
struct Row<'a> {
    traces: Vec<(&'a Trace, Colour)>,
    height: f64,
    unit: PrintUnit,
    title: String,
    residual: bool,
}

/// Draws one comparison; `None` where it has no trace at all.
pub fn draw(comparison: &Comparison, numbers: NumberLook) -> Option<Figure> {
    let rows = rows(comparison);
    if rows.is_empty() && comparison.portraits.is_empty() {
        return None;
    }
    let stack: f64 = rows.iter().map(|r| r.height + ROW_GAP).sum::<f64>() - ROW_GAP;
    let stack = stack.max(if comparison.portraits.is_empty() {
        0.0
    } else {
        100.0
    });
    let mut sheet = Sheet {
        comparison,
        numbers,
        canvas: Canvas::new(look::FULL_WIDTH, TOP + stack + BOTTOM),
        time: time_axis(comparison, &rows),
        column: COLUMNS[usize::from(comparison.portraits.is_empty())],
    };
    sheet.heading();
    sheet.columns(&rows);
    sheet.portraits(stack);
    let name = name(comparison);
    let title = format!("Point ({}): simulated and measured", comparison.letter);
    Some(Figure::new(name, &title, sheet.canvas, csv(comparison)))
}

/// Name of a comparison's figure.
pub fn name(comparison: &Comparison) -> String {
    let letter = comparison.letter.chars();
    let letter: String = letter
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    format!("comparison_{letter}")
}

fn rows(comparison: &Comparison) -> Vec<Row<'_>> {
    let pairs = [
        ([Role::DisplacementX, Role::DisplacementY], "$x$, $y$", 38.0),
        ([Role::VelocityX, Role::VelocityY], "$v_x$, $v_y$", 38.0),
        (
            [Role::AccelerationX, Role::AccelerationY],
            "$a_x$, $a_y$",
            38.0,
        ),
        ([Role::Drive, Role::Drive], "drive", 22.0),
        ([Role::Contact, Role::Contact], "contact", 21.0),
        ([Role::FrameX, Role::FrameY], "frame", 21.0),
    ];
    let mut rows: Vec<Row<'_>> = pairs
        .iter()
        .filter_map(|(roles, name, height)| row(comparison, roles, name, *height))
        .collect();
    rows.extend(residual_row(comparison));
    rows
}

fn row<'a>(
    comparison: &'a Comparison,
    roles: &[Role; 2],
    name: &str,
    height: f64,
) -> Option<Row<'a>> {
    let traces = pick(comparison, roles, |t| {
        t.measured.is_some() || t.simulated.is_some()
    });
    let dimension = traces.first()?.0.dimension;
    let peak = traces
        .iter()
        .flat_map(|(t, _)| [&t.measured, &t.simulated])
        .flatten()
        .map(peak)
        .fold(0.0, f64::max);
    let unit = print_unit(dimension, peak);
    let between = if height < 30.0 { "\n" } else { " " };
    let title = format!("{name}{between}({})", unit.symbol);
    Some(Row {
        traces,
        height,
        title,
        unit,
        residual: false,
    })
}

/// The residual of the best channel that has one: velocity first.
fn residual_row(comparison: &Comparison) -> Option<Row<'_>> {
    let families = [
        [Role::VelocityX, Role::VelocityY],
        [Role::DisplacementX, Role::DisplacementY],
        [Role::AccelerationX, Role::AccelerationY],
    ];
    families.iter().find_map(|roles| {
        let traces = pick(comparison, roles, |t| t.residual.is_some());
        let dimension = traces.first()?.0.dimension;
        let peak = traces
            .iter()
            .filter_map(|(t, _)| t.residual.as_ref())
            .map(peak)
            .fold(0.0, f64::max);
        let unit = print_unit(dimension, peak);
        let title = format!("residual\n({})", unit.symbol);
        Some(Row {
            traces,
            height: 30.0,
            title,
            unit,
            residual: true,
        })
    })
}

fn pick<'a>(
    comparison: &'a Comparison,
    roles: &[Role; 2],
    wanted: impl Fn(&Trace) -> bool,
) -> Vec<(&'a Trace, Colour)> {
    let colour = |role: Role| {
        if role == roles[0] {
            look::BLUE
        } else {
            look::VERMILION
        }
    };
    comparison
        .traces
        .iter()
        .filter(|t| roles.contains(&t.role) && wanted(t))
        .map(|t| (t, colour(t.role)))
        .collect()
}

fn peak(signal: &Signal) -> f64 {
    signal
        .values
        .iter()
        .filter(|v| v.is_finite())
        .fold(0.0, |m, v| m.max(v.abs()))
}

/// Time axis in drive periods from the first whole period, in seconds without a drive.
fn time_axis(comparison: &Comparison, rows: &[Row<'_>]) -> TimeAxis {
    let signals = rows.iter().flat_map(|r| &r.traces).flat_map(|(t, _)| {
        [&t.measured, &t.simulated]
            .into_iter()
            .flatten()
            .chain(t.residual.as_ref())
    });
    let span = range(
        signals
            .flat_map(|s| s.time_s.first().into_iter().chain(s.time_s.last()))
            .copied(),
    );
    let (first, last) = span.unwrap_or((0.0, 1.0));
    match comparison.drive_period_s.filter(|t| *t > 0.0) {
        Some(period) => {
            let start = (first / period + 1e-6).floor() * period;
            let shown = ((first - start) / period, (last - start) / period);
            TimeAxis {
                start,
                unit: period,
                shown,
                title: "$t$/$T$ (drive periods)",
            }
        }
        None => TimeAxis {
            start: 0.0,
            unit: 1.0,
            shown: (first, last),
            title: "$t$ (s)",
        },
    }
}

struct TimeAxis {
    start: f64,
    unit: f64,
    shown: (f64, f64),
    title: &'static str,
}

impl TimeAxis {
    fn axis(&self) -> Axis {
        Axis::new(self.shown.0, self.shown.1, self.title).with_ticks(5)
    }

    fn of(&self, time_s: f64) -> f64 {
        (time_s - self.start) / self.unit
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Simulated,
    Measured,
}

struct Sheet<'a> {
    comparison: &'a Comparison,
    numbers: NumberLook,
    canvas: Canvas,
    time: TimeAxis,
    column: f64,
}

impl Sheet<'_> {
    /// Left edge of a column of panels.
    fn left(&self, side: Side) -> f64 {
        match side {
            Side::Simulated => LEFT,
            Side::Measured => LEFT + self.column + COLUMN_GAP,
        }
    }

    fn heading(&mut self) {
        let c = self.comparison;
        marks::draw(
            &mut self.canvas,
            (LEFT + 3.5, 5.5),
            3.0,
            marks::of(&c.motion),
        );
        let letter = format!("({})", c.letter);
        let bold = TextLook::new(9.0, Anchor::Left)
            .face(Face::Bold)
            .colour(look::INK);
        let x = LEFT + 10.0;
        self.canvas.text((x, 8.5), &letter, bold);
        let x = x + richtext::width(&letter, Face::Bold, 9.0) + 6.0;
        let driven = c.drive_period_s.is_some();
        let mut text = if driven {
            format!("$z$ = {}", c.motion.label())
        } else {
            String::new()
        };
        if let (Some(eta), Some(rho)) = (c.eta, c.rho) {
            let (eta, rho) = (self.numbers.fixed(eta, 3), self.numbers.fixed(rho, 3));
            text.push_str(&format!(",   $η$ = {eta},   $ρ$ = {rho}"));
        }
        self.canvas.text((x, 8.5), &text, bold.face(Face::Regular));
        let after = x + richtext::width(&text, Face::Regular, 9.0) + 12.0;
        let quiet = TextLook::new(8.0, Anchor::Left).colour(look::QUIET);
        let mut note = format!("record {}", c.record);
        if let Some(simulated) = c.simulated_motion.as_ref().filter(|m| **m != c.motion) {
            note.push_str(&format!("; simulated motion: {}", simulated.label()));
        }
        self.canvas.text((after, 8.5), &note, quiet);
    }

    fn columns(&mut self, rows: &[Row<'_>]) {
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        let middle = |sheet: &Self, side: Side| sheet.left(side) + 0.5 * sheet.column;
        if !rows.is_empty() {
            self.canvas.text(
                (middle(self, Side::Simulated), TOP - 4.0),
                "simulated",
                title,
            );
            self.canvas
                .text((middle(self, Side::Measured), TOP - 4.0), "measured", title);
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
        let values = row
            .traces
            .iter()
            .flat_map(|(t, _)| shown(t, row.residual))
            .flat_map(|s| &s.values);
        let y = Axis::around(values.map(|v| v * row.unit.factor), 0.08, row.title.clone());
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
                (true, _) => &trace.residual,
                (false, Side::Simulated) => &trace.simulated,
                (false, Side::Measured) => &trace.measured,
            };
            if let Some(signal) = signal {
                let width = if i == 0 { 0.65 } else { 1.25 };
                let stroke = Stroke::solid(*colour, width);
                self.signal(&panel, signal, row.unit.factor, stroke);
            }
        }
        self.canvas.layer(2);
        let left = side == Side::Simulated || row.residual;
        panel.frame(&mut self.canvas, Sides { below, left }, self.numbers);
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
        !row.residual
            && row.traces.iter().all(|(t, _)| match side {
                Side::Simulated => t.simulated.is_none(),
                Side::Measured => t.measured.is_none(),
            })
    }

    /// Where a side has nothing to show: the simulated contact as its impacts, else a word.
    fn empty_note(&mut self, row: &Row<'_>, side: Side, panel: &Panel) {
        if !self.is_empty(row, side) {
            return;
        }
        let contact = row.traces.iter().any(|(t, _)| t.role == Role::Contact);
        if contact && side == Side::Simulated {
            return self.contact_stems(panel);
        }
        let text = if side == Side::Simulated {
            "not modelled"
        } else {
            "not measured"
        };
        let r = panel.rect;
        let at = (0.5 * (r.left + r.right), 0.5 * (r.top + r.bottom) + 2.5);
        let quiet = TextLook::new(look::NOTE_SIZE, Anchor::Middle).colour(look::QUIET);
        self.canvas.text(at, text, quiet);
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
            let rms = root_mean_square(trace.residual.as_ref()?)?;
            let whole = root_mean_square(trace.measured.as_ref()?)?;
            let value = self.numbers.significant(rms * row.unit.factor, 2);
            let share = self.numbers.significant(100.0 * rms / whole, 2);
            let name = symbol(trace.role);
            Some(format!(
                "{name}: rms residual {value} {} = {share} % of rms",
                row.unit.symbol
            ))
        });
        for (i, line) in lines.collect::<Vec<_>>().iter().enumerate() {
            let y = top + 24.0 + 9.5 * i as f64;
            self.canvas.text((LEFT, y), line, quiet);
        }
    }

    fn portraits(&mut self, stack: f64) {
        let shown: Vec<&Portrait> = self.comparison.portraits.iter().take(2).collect();
        if shown.is_empty() {
            return;
        }
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        let middle = PORTRAIT_LEFT + 0.5 * PORTRAIT_WIDTH;
        self.canvas
            .text((middle, TOP - 4.0), "phase portraits", title);
        let count = shown.len() as f64;
        let height = ((stack - (count - 1.0) * 24.0) / count).min(PORTRAIT_WIDTH);
        for (i, portrait) in shown.into_iter().enumerate() {
            let top = TOP + i as f64 * (height + 24.0);
            self.portrait(
                portrait,
                Rect::new(PORTRAIT_LEFT, top, PORTRAIT_WIDTH, height),
            );
        }
    }

    fn portrait(&mut self, portrait: &Portrait, rect: Rect) {
        let all = || portrait.measured.iter().chain(&portrait.simulated);
        let peak = |k: usize| all().map(|p| p[k].abs()).fold(0.0, f64::max);
        let (length, speed) = (
            print_unit(crate::units::Dimension::Length, peak(0)),
            print_unit(crate::units::Dimension::Velocity, peak(1)),
        );
        let mass = &portrait.mass;
        let x = Axis::around(
            all().map(|p| p[0] * length.factor),
            0.06,
            format!("${mass}$ ({})", length.symbol),
        );
        let y = Axis::around(
            all().map(|p| p[1] * speed.factor),
            0.06,
            format!("$v_{mass}$ ({})", speed.symbol),
        );
        let panel = Panel::new(rect, x.with_ticks(4), y.with_ticks(4));
        let colour = if mass == "y" {
            look::VERMILION
        } else {
            look::BLUE
        };
        let strokes = [
            (
                &portrait.simulated,
                Stroke::solid(marks::mix(colour, 0.40), BACK_WIDTH),
            ),
            (&portrait.measured, Stroke::solid(look::INK, 0.45)),
        ];
        self.canvas.layer(1);
        for (points, stroke) in strokes {
            let data: Vec<_> = points
                .iter()
                .map(|p| (p[0] * length.factor, p[1] * speed.factor))
                .collect();
            panel.curve(&mut self.canvas, data, stroke);
        }
        self.canvas.layer(2);
        panel.frame(&mut self.canvas, Sides::BOTH, self.numbers);
    }
}

fn shown(trace: &Trace, residual: bool) -> Vec<&Signal> {
    let picked = if residual {
        [trace.residual.as_ref(), None]
    } else {
        [trace.measured.as_ref(), trace.simulated.as_ref()]
    };
    picked.into_iter().flatten().collect()
}

fn symbol(role: Role) -> &'static str {
    match role {
        Role::VelocityX => "$v_x$",
        Role::VelocityY => "$v_y$",
        Role::DisplacementX => "$x$",
        Role::DisplacementY => "$y$",
        Role::AccelerationX => "$a_x$",
        Role::AccelerationY => "$a_y$",
        other => other.name(),
    }
}

fn root_mean_square(signal: &Signal) -> Option<f64> {
    let n = signal.values.len();
    (n > 0).then(|| (signal.values.iter().map(|v| v * v).sum::<f64>() / n as f64).sqrt())
}

fn csv(comparison: &Comparison) -> String {
    let mut csv = Csv::new(&["channel", "source", "time_s", "value_si"]);
    for trace in &comparison.traces {
        let sources = [
            ("measured", &trace.measured),
            ("simulated", &trace.simulated),
            ("residual", &trace.residual),
        ];
        for (source, signal) in sources {
            let Some(signal) = signal else { continue };
            for (t, v) in signal.time_s.iter().zip(&signal.values) {
                csv.row()
                    .texts(&[trace.role.name(), source])
                    .numbers(&[Some(*t), Some(*v)]);
            }
        }
    }
    csv.finish()
}
