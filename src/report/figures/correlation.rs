//! Correlation of the jointly estimated parameters as a matrix of tinted squares with numbers.
//!
//! The columns are the parameters that are asked for; how the others hang together among
//! themselves is in the figure's data.

use super::canvas::{Anchor, Canvas, Colour, TextLook};
use super::csv::Csv;
use super::figure::Figure;
use super::fonts::Face;
use super::look;
use super::marks::mix;
use super::path::Rect;
use super::richtext;
use crate::compare::Correlation;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::{Effect, GAIN_ROLES};
use crate::report::locale::Locale;
use crate::report::parameters::parameter;
use crate::report::phrase::{Phrase, Text};

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
    let widths = names
        .iter()
        .map(|t| richtext::width(t, Face::Regular, look::TITLE_SIZE));
    let left = widths.fold(0.0, f64::max) + 8.0;
    let wide = ((look::HALF_WIDTH - left - 4.0) / columns.len() as f64).min(34.0);
    let high = if columns.len() < n { 14.5 } else { wide };
    let mut canvas = Canvas::new(look::HALF_WIDTH, TOP + high * n as f64 + 2.0);
    for (i, &column) in columns.iter().enumerate() {
        let text_look = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::INK);
        let at = (left + (i as f64 + 0.5) * wide, TOP - 4.5);
        canvas.text(at, &names[column], text_look);
    }
    for (j, row) in correlation.matrix.iter().enumerate() {
        let y = TOP + j as f64 * high;
        let label = TextLook::new(look::TITLE_SIZE, Anchor::Right).colour(look::INK);
        canvas.text((left - 5.0, y + 0.5 * high + 2.7), &names[j], label);
        // each pair once
        let once = columns.iter().enumerate();
        for (i, &column) in once.filter(|(_, c)| **c <= j || !columns.contains(&j)) {
            let x = left + i as f64 * wide;
            let rect = Rect::new(x, y, wide, high);
            let value = (column != j).then_some(row[column]);
            cell(&mut canvas, &rect, value, locale);
        }
    }
    Some(Figure::new(
        "correlation",
        &locale.translate(Phrase::CorrelationOfTheParameters),
        canvas,
        csv(correlation),
    ))
}

/// The columns of the matrix: the parameters that are asked for.
fn columns(correlation: &Correlation) -> Vec<usize> {
    let all = 0..correlation.parameters.len();
    let asked = |i: &usize| parameter(correlation.parameters[*i].name()).is_some();
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
    let of_channel = |phrase: Phrase, channel: usize| {
        let role = GAIN_ROLES.get(channel).copied();
        let role = role.map_or_else(String::new, |role| locale.role(role));
        locale.translate_with(phrase, &[("channel", &role)])
    };
    match coordinate {
        Coordinate::Gain(i) => of_channel(Phrase::GainOf, i),
        Coordinate::Corner(i) => of_channel(Phrase::CornerOf, i),
        Coordinate::Delay(i) => of_channel(Phrase::DelayOf, i),
        Coordinate::Gap(i) => {
            let number = (i + 1).to_string();
            locale.translate_with(Phrase::ClearanceErrorOf, &[("number", &number)])
        }
        other => locale.text(&coordinate_text(other)),
    }
}

/// Name of a coordinate that belongs to no channel and no single clearance.
fn coordinate_text(coordinate: Coordinate) -> Text {
    let phrase = match coordinate {
        Coordinate::DriveAsymmetry => Phrase::DriveAsymmetry,
        Coordinate::StiffnessAsymmetry => Phrase::StiffnessAsymmetry,
        Coordinate::DampingAsymmetry => Phrase::DampingAsymmetry,
        Coordinate::MassAsymmetry => Phrase::MassAsymmetry,
        Coordinate::ScrewZero => Phrase::ScrewZero,
        Coordinate::Effect(effect) => effect_phrase(effect),
        other => {
            return parameter(other.name())
                .map_or(other.name(), |p| p.symbol)
                .into();
        }
    };
    phrase.into()
}

fn effect_phrase(effect: Effect) -> Phrase {
    match effect {
        Effect::SecondHarmonicCos => Phrase::DriveHarmonic2Cos,
        Effect::SecondHarmonicSin => Phrase::DriveHarmonic2Sin,
        Effect::ThirdHarmonicCos => Phrase::DriveHarmonic3Cos,
        Effect::ThirdHarmonicSin => Phrase::DriveHarmonic3Sin,
        Effect::ForceSlope => Phrase::ForceSlope,
        Effect::ForceCurve => Phrase::ForceCurve,
        Effect::Hardening => Phrase::Hardening,
        Effect::Friction => Phrase::Friction,
        Effect::FrequencyDrift => Phrase::FrequencyDrift,
        Effect::FrequencyBend => Phrase::FrequencyDriftBend,
        Effect::DampingDrift => Phrase::DampingDrift,
        Effect::DeflectionDrift => Phrase::DeflectionDrift,
        Effect::ContactDuration => Phrase::ContactDuration,
        Effect::ContactLaw => Phrase::ContactLaw,
        Effect::ContactReach => Phrase::ContactReach,
        Effect::Drag => Phrase::Drag,
        Effect::SpringAsymmetry => Phrase::SpringAsymmetry,
        Effect::HystereticDamping => Phrase::HystereticDamping,
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
