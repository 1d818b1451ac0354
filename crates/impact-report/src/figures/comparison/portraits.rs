//! The phase portraits of a comparison.

use super::sheet::{BACK_WIDTH, PORTRAIT_LEFT, PORTRAIT_WIDTH, Sheet, TOP};
use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Stroke, TextLook};
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::kit::units::{PrintUnit, print_unit};
use crate::kit::{look, marks};
use crate::phrase::Phrase;
use impact_identification::replay::{ReplayedRecord, Signal, Trace};
use impact_records::record::Role;
use labfiles::units::Dimension;

/// Velocity over displacement of one mass: points (m, m/s) in order of time.
pub(super) struct Portrait {
    /// Name of the mass, `x` or `y`.
    mass: char,
    measured: Vec<[f64; 2]>,
    simulated: Vec<[f64; 2]>,
}

/// The portraits of the masses whose displacement and velocity are both known.
pub(super) fn portraits(comparison: &ReplayedRecord) -> Vec<Portrait> {
    let trace = |role: Role| comparison.traces.iter().find(|t| t.role == role);
    let points = |d: &Signal, v: &Signal| -> Vec<[f64; 2]> {
        let pairs = d.values.iter().zip(&v.values);
        pairs.map(|(d, v)| [*d, *v]).collect()
    };
    let portrait = |mass, d: &Trace, v: &Trace| Portrait {
        mass,
        measured: points(&d.measured, &v.measured),
        simulated: match (&d.simulated, &v.simulated) {
            (Some(d), Some(v)) => points(d, v),
            _ => Vec::new(),
        },
    };
    let masses = [
        ('x', Role::DisplacementX, Role::VelocityX),
        ('y', Role::DisplacementY, Role::VelocityY),
    ];
    masses
        .into_iter()
        .filter_map(|(mass, d, v)| Some(portrait(mass, trace(d)?, trace(v)?)))
        .collect()
}

/// Units of length and velocity that suit all portraits, so that they compare.
fn units(shown: &[Portrait]) -> [PrintUnit; 2] {
    let all = || {
        shown
            .iter()
            .flat_map(|p| p.measured.iter().chain(&p.simulated))
    };
    let peak = |k: usize| all().map(|p| p[k].abs()).fold(0.0, f64::max);
    [
        print_unit(Dimension::Length, peak(0)),
        print_unit(Dimension::Velocity, peak(1)),
    ]
}

impl Sheet<'_> {
    /// Velocity over displacement of each mass, one above the other.
    pub(super) fn portraits(&mut self, shown: &[Portrait], stack: f64) {
        if shown.is_empty() {
            return;
        }
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        let middle = PORTRAIT_LEFT + 0.5 * PORTRAIT_WIDTH;
        self.canvas.text(
            (middle, TOP - 4.0),
            &self.locale.translate(Phrase::PhasePortraits),
            title,
        );
        let units = units(shown);
        let count = shown.len() as f64;
        let height = ((stack - (count - 1.0) * 24.0) / count).min(PORTRAIT_WIDTH);
        for (i, portrait) in shown.iter().enumerate() {
            let top = TOP + i as f64 * (height + 24.0);
            self.portrait(
                portrait,
                Rect::new(PORTRAIT_LEFT, top, PORTRAIT_WIDTH, height),
                units,
            );
        }
    }

    fn portrait(&mut self, portrait: &Portrait, rect: Rect, [length, speed]: [PrintUnit; 2]) {
        let all = || portrait.measured.iter().chain(&portrait.simulated);
        let mass = portrait.mass;
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
        let colour = if mass == 'y' {
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
        panel.frame(&mut self.canvas, Sides::BOTH, self.locale);
    }
}
