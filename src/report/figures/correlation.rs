//! Correlation of the jointly estimated parameters as a matrix of tinted squares with numbers.

use plotters::style::RGBColor;

use super::Figure;
use super::canvas::{Anchor, Canvas, Colour, TextLook};
use super::csv::Csv;
use super::fonts::Face;
use super::look::{self, NumberLook};
use super::richtext;
use crate::report::content::Correlation;
use crate::report::parameters::parameter;

/// Draws the matrix; `None` where it is empty or not square.
pub fn draw(correlation: &Correlation, numbers: NumberLook) -> Option<Figure> {
    let n = correlation.parameters.len();
    let square = correlation.matrix.len() == n && correlation.matrix.iter().all(|r| r.len() == n);
    if n < 2 || !square {
        return None;
    }
    let names: Vec<String> = correlation.parameters.iter().map(|p| name(p, numbers)).collect();
    let widths = names
        .iter()
        .map(|t| richtext::width(t, Face::Regular, look::TITLE_SIZE));
    let left = widths.fold(0.0, f64::max) + 8.0;
    let side = ((look::HALF_WIDTH - left - 4.0) / n as f64).min(34.0);
    let rotated = n > 5;
    let top = if rotated { left } else { 14.0 };
    let mut canvas = Canvas::new(look::HALF_WIDTH, top + side * n as f64 + 2.0);
    for (j, row) in correlation.matrix.iter().enumerate() {
        let y = top + j as f64 * side;
        let label = TextLook::new(look::TITLE_SIZE, Anchor::Right).colour(look::INK);
        canvas.text((left - 5.0, y + 0.5 * side + 2.7), &names[j], label);
        head(
            &mut canvas,
            (left + (j as f64 + 0.5) * side, top - 4.5),
            &names[j],
            rotated,
        );
        for (i, value) in row.iter().enumerate().take(j + 1) {
            let x = left + i as f64 * side;
            canvas.rectangle(
                (x + 0.5, y + 0.5),
                (x + side - 0.5, y + side - 0.5),
                tint(*value),
            );
            let dark = value.abs() > 0.75;
            let text_look = TextLook::new((0.34 * side).min(look::TICK_SIZE), Anchor::Middle)
                .colour(if dark { look::PAPER } else { look::INK });
            let text = if i == j {
                "1".into()
            } else {
                numbers.fixed(*value, 2)
            };
            canvas.text((x + 0.5 * side, y + 0.5 * side + 2.4), &text, text_look);
        }
    }
    Some(Figure::new(
        "correlation",
        &numbers.say("Correlation of the parameters"),
        canvas,
        csv(correlation),
    ))
}

fn head(canvas: &mut Canvas, at: (f64, f64), name: &str, upward: bool) {
    let anchor = if upward { Anchor::Left } else { Anchor::Middle };
    let text_look = TextLook {
        upward,
        ..TextLook::new(look::TITLE_SIZE, anchor)
    };
    canvas.text(at, name, text_look.colour(look::INK));
}

fn name(key: &str, numbers: NumberLook) -> String {
    if let Some(shown) = parameter(key) {
        return shown.symbol.to_owned();
    }
    match key.split_once('_') {
        Some((what @ ("gain" | "corner"), role)) => {
            let of = numbers.say(&role.replace('_', " "));
            numbers.say_with(&format!("{what} of {{channel}}"), &[("channel", &of)])
        }
        _ => numbers.say(&key.replace('_', " ")),
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
        return RGBColor(0xee, 0xee, 0xee);
    }
    super::marks::mix(end, value.abs().min(1.0) * 0.9 + 0.04)
}

fn csv(correlation: &Correlation) -> String {
    let mut csv = Csv::new(&["parameter", "with", "correlation"]);
    for (a, row) in correlation.parameters.iter().zip(&correlation.matrix) {
        for (b, value) in correlation.parameters.iter().zip(row) {
            csv.row().texts(&[a, b]).numbers(&[Some(*value)]);
        }
    }
    csv.finish()
}
