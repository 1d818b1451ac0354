//! The plane of the map: (η, ρ) where f0 and x_st are known, else frequency and clearance.

use super::axes::{Axis, range};
use crate::identify::Estimate;
use crate::report::content::{BracketRow, RecordRow, ReportContent};

/// Which coordinates the map has, and how they turn into laboratory units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Whether in (η, ρ).
    pub dimensionless: bool,
    /// f0, Hz, where known.
    pub natural_frequency_hz: Option<f64>,
    /// x_st, m, where known.
    pub static_deflection_m: Option<f64>,
}

impl Plane {
    /// The plane in which the records can be shown; `None` where they have no place in any.
    pub fn of(content: &ReportContent) -> Option<Self> {
        let joint = &content.identification.joint.parameters;
        let value = |e: &Option<Estimate>| e.as_ref().and_then(|e| e.value).filter(|v| *v > 0.0);
        let plane = |dimensionless| Self {
            dimensionless,
            natural_frequency_hz: value(&joint.natural_frequency_hz),
            static_deflection_m: value(&joint.static_deflection_m),
        };
        let placed = |p: Self| {
            content.records.iter().any(|r| p.record(r).is_some())
                || content.brackets.iter().any(|b| p.bracket(b).is_some())
        };
        let modelled = !content.curves.is_empty() || content.region_map.is_some();
        [plane(true), plane(false)]
            .into_iter()
            .find(|p| placed(*p) || (p.dimensionless && modelled))
    }

    /// Where a record lies.
    pub fn record(&self, record: &RecordRow) -> Option<(f64, f64)> {
        if self.dimensionless {
            Some((record.eta?, record.rho?))
        } else {
            Some((record.frequency_hz?, record.clearance_m? * 1e3))
        }
    }

    /// Ends and height of a bracket.
    pub fn bracket(&self, bracket: &BracketRow) -> Option<((f64, f64), f64)> {
        if self.dimensionless {
            Some(((bracket.eta_low?, bracket.eta_high?), bracket.rho?))
        } else {
            let ends = (bracket.frequency_low_hz, bracket.frequency_high_hz);
            Some((ends, bracket.clearance_m * 1e3))
        }
    }

    /// The two axes that show all records, brackets and the simulated map.
    pub fn axes(&self, content: &ReportContent) -> (Axis, Axis) {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for (x, y) in content.records.iter().filter_map(|r| self.record(r)) {
            xs.push(x);
            ys.push(y);
        }
        for ((low, high), y) in content.brackets.iter().filter_map(|b| self.bracket(b)) {
            xs.extend([low, high]);
            ys.push(y);
        }
        let x = pad(range(xs), 0.03);
        let y = pad(range(ys), 0.06);
        let (x, y) = if self.dimensionless {
            self.with_map(content, x, y)
        } else {
            (x, y)
        };
        let (x, y) = (x.unwrap_or((0.5, 3.0)), y.unwrap_or((0.0, 3.0)));
        let titles = if self.dimensionless {
            (
                "frequency ratio $η$ = $f$/$f_0$ (1)",
                "clearance ratio $ρ$ = $r$/$x_{st}$ (1)",
            )
        } else {
            ("drive frequency $f$ (Hz)", "clearance $r$ (mm)")
        };
        (
            Axis::new(x.0, x.1, titles.0).with_ticks(8),
            Axis::new(y.0, y.1, titles.1).with_ticks(7),
        )
    }

    fn with_map(
        &self,
        content: &ReportContent,
        x: Option<(f64, f64)>,
        y: Option<(f64, f64)>,
    ) -> (Option<(f64, f64)>, Option<(f64, f64)>) {
        match &content.region_map {
            Some(map) => (union(x, edges(&map.eta)), union(y, edges(&map.rho))),
            None => (x, y),
        }
    }
}

fn pad(seen: Option<(f64, f64)>, share: f64) -> Option<(f64, f64)> {
    let (low, high) = seen?;
    let pad = if high > low {
        share * (high - low)
    } else {
        0.1 * high.abs().max(1e-3)
    };
    Some((low - pad, high + pad))
}

fn union(a: Option<(f64, f64)>, b: Option<(f64, f64)>) -> Option<(f64, f64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (a, b) => a.or(b),
    }
}

/// Outer edges of evenly spaced cells.
fn edges(centres: &[f64]) -> Option<(f64, f64)> {
    let n = centres.len();
    if n < 2 {
        return None;
    }
    let half = 0.5 * (centres[1] - centres[0]);
    Some((centres[0] - half, centres[n - 1] + half))
}
