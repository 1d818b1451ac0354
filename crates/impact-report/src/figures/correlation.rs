//! Correlation of the jointly estimated parameters as a matrix of tinted squares with numbers.
//!
//! The columns are the parameters that are asked for; how the others hang together among
//! themselves is in the figure's data.

use std::ops::Range;

use crate::kit::canvas::{Anchor, Canvas, Colour, TextLook};
use crate::kit::csv::Csv;
use crate::kit::figure::Figure;
use crate::kit::fonts::Face;
use crate::kit::look;
use crate::kit::marks::mix;
use crate::kit::path::Rect;
use crate::kit::richtext;
use crate::locale::Locale;
use crate::parameters::parameter;
use crate::phrase::Phrase;
use impact_fit::parameters::Coordinate;
use impact_identification::replay::Correlation;

/// Room above the cells for the columns' symbols, points.
const TOP: f64 = 14.0;

/// Draws the matrix; `None` if it is empty or not square.
pub(crate) fn draw(correlation: &Correlation, locale: Locale<'_>) -> Option<Figure> {
    let n = correlation.parameters.len();
    let square = correlation.matrix.len() == n && correlation.matrix.iter().all(|r| r.len() == n);
    if n < 2 || !square {
        return None;
    }
    let names: Vec<String> = correlation
        .parameters
        .iter()
        .map(|p| name(*p, locale))
        .collect();
    let columns = columns(correlation);
    let layout = Layout::new(&names, &columns);
    let cells = Cells {
        correlation,
        columns: &columns,
        names: &names,
        locale,
    };
    let mut canvas = Canvas::new(layout.width(), layout.height());
    for (block, first) in (0..n).step_by(layout.rows).enumerate() {
        let corner = (block as f64 * layout.block_width(), TOP);
        let rows = first..(first + layout.rows).min(n);
        cells.draw(&mut canvas, &layout, corner, rows);
    }
    Some(Figure::new(
        "correlation",
        &locale.translate(Phrase::CorrelationOfTheParameters),
        canvas,
        csv(correlation),
    ))
}

/// Most rows under each other; more of them stand in two blocks side by side.
const MOST_ROWS: usize = 24;
/// Space between two blocks, points.
const GUTTER: f64 = 14.0;

/// Sizes of the cells, points.
struct Layout {
    /// Rows of a block.
    rows: usize,
    blocks: usize,
    /// Room for the names left of the cells.
    left: f64,
    columns: usize,
    cell: (f64, f64),
}

impl Layout {
    fn new(names: &[String], columns: &[usize]) -> Self {
        let (count, across) = (names.len(), columns.len());
        let blocks = if across < count && count > MOST_ROWS {
            2
        } else {
            1
        };
        let widths = names
            .iter()
            .map(|t| richtext::width(t, Face::Regular, look::TITLE_SIZE));
        let left = widths.fold(0.0, f64::max) + 8.0;
        let whole = match blocks {
            1 => look::HALF_WIDTH - 4.0,
            _ => 0.5 * (look::FULL_WIDTH - GUTTER) - 2.0,
        };
        let wide = ((whole - left) / across as f64).min(34.0);
        let high = if across < count { 12.0 } else { wide };
        Self {
            rows: count.div_ceil(blocks),
            blocks,
            left,
            columns: across,
            cell: (wide, high),
        }
    }

    /// From the left edge of a block to that of the next.
    fn block_width(&self) -> f64 {
        self.left + self.columns as f64 * self.cell.0 + GUTTER
    }

    fn width(&self) -> f64 {
        match self.blocks {
            1 => look::HALF_WIDTH,
            blocks => blocks as f64 * self.block_width() - GUTTER + 2.0,
        }
    }

    fn height(&self) -> f64 {
        TOP + self.cell.1 * self.rows as f64 + 2.0
    }
}

/// What stands in the cells.
struct Cells<'a> {
    correlation: &'a Correlation,
    columns: &'a [usize],
    names: &'a [String],
    locale: Locale<'a>,
}

impl Cells<'_> {
    /// Some rows with the columns' names above them.
    fn draw(&self, canvas: &mut Canvas, layout: &Layout, (x0, y0): (f64, f64), rows: Range<usize>) {
        let (wide, high) = layout.cell;
        let left = x0 + layout.left;
        for (i, &column) in self.columns.iter().enumerate() {
            let text_look = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::INK);
            let at = (left + (i as f64 + 0.5) * wide, y0 - 4.5);
            canvas.text(at, &self.names[column], text_look);
        }
        for (line, j) in rows.enumerate() {
            let y = y0 + line as f64 * high;
            let label = TextLook::new(look::TITLE_SIZE, Anchor::Right).colour(look::INK);
            canvas.text((left - 5.0, y + 0.5 * high + 2.7), &self.names[j], label);
            // each pair once
            let once = self.columns.iter().enumerate();
            for (i, &column) in once.filter(|(_, c)| **c <= j || !self.columns.contains(&j)) {
                let rect = Rect::new(left + i as f64 * wide, y, wide, high);
                let value = (column != j).then_some(self.correlation.matrix[j][column]);
                cell(canvas, &rect, value, self.locale);
            }
        }
    }
}

/// The columns of the matrix: the parameters that are asked for.
fn columns(correlation: &Correlation) -> Vec<usize> {
    let all = 0..correlation.parameters.len();
    let asked = |i: &usize| parameter(correlation.parameters[*i]).is_some();
    let main: Vec<usize> = all.clone().filter(asked).collect();
    if main.is_empty() { all.collect() } else { main }
}

/// A tinted cell with its number; `None` for a parameter with itself.
fn cell(canvas: &mut Canvas, rect: &Rect, value: Option<f64>, locale: Locale<'_>) {
    let (from, to) = (
        (rect.left + 0.5, rect.top + 0.5),
        (rect.right - 0.5, rect.bottom - 0.5),
    );
    canvas.rectangle(from, to, tint(value.unwrap_or(1.0)));
    let dark = value.is_none_or(|v| v.abs() > 0.75);
    let size = (0.34 * rect.width()).min(look::TICK_SIZE);
    let text_look =
        TextLook::new(size, Anchor::Middle).colour(if dark { look::PAPER } else { look::INK });
    let text = value.map_or("1".into(), |v| locale.fixed(v, 2));
    let middle = (
        0.5 * (rect.left + rect.right),
        0.5 * (rect.top + rect.bottom) + 2.4,
    );
    canvas.text(middle, &text, text_look);
}

/// Symbol of a parameter, or the name of what is fitted beside it.
pub(crate) fn name(coordinate: Coordinate, locale: Locale<'_>) -> String {
    match parameter(coordinate) {
        Some(asked) => asked.symbol.to_owned(),
        None => locale.message(&coordinate),
    }
}

/// Blue for positive, vermilion for negative, deeper for stronger.
fn tint(value: f64) -> Colour {
    let end = if value >= 0.0 {
        look::BLUE
    } else {
        look::VERMILION
    };
    if !value.is_finite() {
        return look::BLANK;
    }
    mix(end, value.abs().min(1.0) * 0.9 + 0.04)
}

fn csv(correlation: &Correlation) -> String {
    let mut csv = Csv::new(&["parameter", "with", "correlation"]);
    for (a, row) in correlation.parameters.iter().zip(&correlation.matrix) {
        for (b, value) in correlation.parameters.iter().zip(row) {
            csv.row()
                .texts(&[a.name(), b.name()])
                .numbers(&[Some(*value)]);
        }
    }
    csv.finish()
}
