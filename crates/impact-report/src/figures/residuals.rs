//! Residual diagnostics of one method: histogram, autocorrelation, over frequency, over gap.

use crate::kit::axis::Axis;
use crate::kit::canvas::{Canvas, Stroke};
use crate::kit::csv::Csv;
use crate::kit::dots::{self, DotLook, Dots};
use crate::kit::figure::Figure;
use crate::kit::look;
use crate::kit::marks;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::locale::Locale;
use crate::parameters::NORMAL_95;
use crate::phrase::{Phrase, Text};
use impact_identification::replay::{ResidualPoint, ResidualSet};
use impact_records::signal::robust::range;
use impact_records::signal::whole;

/// Height of the panels, points.
const HEIGHT: f64 = 84.0;
/// Room above the panels, points.
const TOP: f64 = 3.0;

/// Draws the diagnostics of one method; `None` if it has no residuals.
pub(crate) fn draw<'a>(set: &'a ResidualSet, name: &str, locale: Locale<'a>) -> Option<Figure> {
    if set.points.is_empty() {
        return None;
    }
    let mut sheet = Sheet {
        set,
        locale,
        canvas: Canvas::new(look::FULL_WIDTH, TOP + HEIGHT + look::BELOW_PANEL),
    };
    let mut drawers: Vec<fn(&mut Sheet<'_>, Rect)> = vec![|s, r| s.histogram(r)];
    if set.autocorrelation.len() > 2 {
        drawers.push(|s, r| s.autocorrelation(r));
    }
    if set.points.iter().any(|p| p.frequency_hz.is_some()) {
        drawers.push(|s, r| s.over(r, (Phrase::DriveFrequency, "Hz"), |p| p.frequency_hz));
    }
    if set.points.iter().any(|p| p.clearance_m.is_some()) {
        drawers.push(|s, r| {
            s.over(r, (Phrase::Clearance, "mm"), |p| {
                p.clearance_m.map(|c| 1e3 * c)
            });
        });
    }
    let count = drawers.len() as f64;
    let step = (look::FULL_WIDTH - 2.0) / count;
    for (i, draw) in drawers.iter().enumerate() {
        draw(
            &mut sheet,
            Rect::new(31.0 + i as f64 * step, TOP, step - 36.0, HEIGHT),
        );
    }
    let title = locale.translate(Phrase::ResidualDiagnostics);
    Some(Figure::new(name, &title, sheet.canvas, csv(set)))
}

struct Sheet<'a> {
    set: &'a ResidualSet,
    locale: Locale<'a>,
    canvas: Canvas,
}

impl Sheet<'_> {
    fn reach(&self) -> f64 {
        let most = self
            .set
            .points
            .iter()
            .map(|p| p.residual.abs())
            .filter(|r| r.is_finite());
        most.fold(3.0, f64::max).min(8.0)
    }

    /// Bars beside the normal curve of unit width.
    fn histogram(&mut self, rect: Rect) {
        let reach = self.reach();
        let n = self.set.points.len() as f64;
        let bins = whole::index((n.sqrt() * 1.2).clamp(7.0, 41.0)) | 1;
        let width = 2.0 * reach / bins as f64;
        let mut counts = vec![0usize; bins];
        for p in &self.set.points {
            let index = ((p.residual + reach) / width).floor();
            counts[whole::index(index.max(0.0)).min(bins - 1)] += 1;
        }
        let density: Vec<f64> = counts.iter().map(|c| *c as f64 / (n * width)).collect();
        let highest = density.iter().copied().fold(0.4, f64::max);
        let x = Axis::new(-reach, reach, (Phrase::WeightedResidual, "1")).with_ticks(4);
        let y = Axis::new(0.0, 1.1 * highest, (Phrase::Density, "1")).with_ticks(3);
        let panel = Panel::new(rect, x, y);
        for (i, d) in density.iter().enumerate() {
            let from = -reach + i as f64 * width;
            let (a, b) = (panel.at(from, *d), panel.at(from + width, 0.0));
            self.canvas.rectangle(
                (a.0 + 0.2, a.1),
                (b.0 - 0.2, b.1),
                marks::mix(look::BLUE, 0.45),
            );
        }
        let normal = (0..=80).map(|i| {
            let r = reach * (f64::from(i) / 40.0 - 1.0);
            (r, (-0.5 * r * r).exp() / std::f64::consts::TAU.sqrt())
        });
        panel.curve(
            &mut self.canvas,
            normal,
            Stroke::solid(look::VERMILION, 0.9),
        );
        panel.frame(&mut self.canvas, Sides::BOTH, self.locale);
    }

    /// Stems from lag 1, with the band in which white residuals stay.
    fn autocorrelation(&mut self, rect: Rect) {
        let rho = &self.set.autocorrelation;
        let limit = NORMAL_95 / (self.set.total as f64).sqrt();
        let (low, high) = range(rho[1..].iter().copied()).unwrap_or((0.0, 0.0));
        let x = Axis::new(0.0, rho.len() as f64, Phrase::LagInObservations).with_ticks(4);
        let reach = (1.2 * low.abs().max(high.abs())).max(2.0 * limit).min(1.0);
        let y = Axis::new(-reach, reach, (Phrase::Autocorrelation, "1")).with_ticks(4);
        let panel = Panel::new(rect, x, y);
        let corners = (
            panel.at(panel.x.low, limit.min(reach)),
            panel.at(panel.x.high, -limit.min(reach)),
        );
        self.canvas.rectangle(corners.0, corners.1, look::BAND);
        panel.level(&mut self.canvas, 0.0, look::ZERO_STROKE);
        for (lag, r) in rho.iter().enumerate().skip(1) {
            panel.error_bar(
                &mut self.canvas,
                lag as f64,
                (0.0, *r),
                Stroke::solid(look::INK, 0.9),
            );
        }
        panel.frame(&mut self.canvas, Sides::BOTH, self.locale);
    }

    /// Residuals over a quantity, with lines at ±1.96.
    fn over(
        &mut self,
        rect: Rect,
        title: impl Into<Text> + Clone,
        of: fn(&ResidualPoint) -> Option<f64>,
    ) {
        let reach = self.reach();
        let x = over_axis(self.set.points.iter().filter_map(of), title);
        let panel = Panel::new(
            rect,
            x,
            Axis::new(-reach, reach, (Phrase::WeightedResidual, "1")).with_ticks(4),
        );
        panel.level(&mut self.canvas, 0.0, look::ZERO_STROKE);
        for level in [-NORMAL_95, NORMAL_95] {
            let stroke = Stroke::dashed(look::ZERO_STROKE.colour, 0.5, &[2.0, 2.0]);
            panel.level(&mut self.canvas, level, stroke);
        }
        let dot = DotLook::full(dots::radius(self.set.points.len()), look::BLUE);
        let mut taken = Dots::default();
        for p in &self.set.points {
            let Some(value) = of(p) else { continue };
            let shown = p.residual.clamp(-reach, reach);
            if let Some(at) = taken.put(&mut self.canvas, &panel, (value, shown), dot) {
                let r = self.locale.fixed(p.residual, 2);
                let values = [("value", r.as_str())];
                let residual = self.locale.translate_with(Phrase::ResidualOf, &values);
                self.canvas.spot(at, format!("{}\n{residual}", p.record));
            }
        }
        panel.frame(&mut self.canvas, Sides::BOTH, self.locale);
    }
}

/// An axis over values as they are set on a rig: what differs by less than one can set is one.
fn over_axis(values: impl Iterator<Item = f64> + Clone, title: impl Into<Text> + Clone) -> Axis {
    /// Relative difference of settings that are one.
    const SAME: f64 = 1e-3;
    let axis = Axis::around(values.clone(), 0.05, title.clone());
    let (low, high) = range(values).unwrap_or((0.0, 1.0));
    let axis = if high - low < SAME * high.abs() {
        Axis::around([0.5 * (low + high)], 0.05, title)
    } else {
        axis
    };
    axis.with_ticks(4)
}

fn csv(set: &ResidualSet) -> String {
    let mut csv = Csv::new(&["record", "residual", "frequency_hz", "clearance_m"]);
    for p in &set.points {
        csv.row()
            .texts(&[&p.record])
            .numbers(&[Some(p.residual), p.frequency_hz, p.clearance_m]);
    }
    csv.finish()
}
