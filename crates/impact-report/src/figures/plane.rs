//! The plane of the map: (η, ρ) where f0 and `x_st` are known, else frequency and clearance.

use crate::content::ReportContent;
use crate::kit::axis::Axis;
use crate::phrase::Phrase;
use impact_fit::Estimate;
use impact_identification::identify::plan::Proposal;
use impact_identification::replay::{BracketRow, RecordRow};
use impact_records::motion::Motion;
use impact_records::signal::robust::range;

/// Least and greatest value, where there is any.
type Range = Option<(f64, f64)>;

/// What part of a plane the map shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct View {
    /// Across.
    pub x: Axis,
    /// Upward.
    pub y: Axis,
    /// Clearances above the axis, ascending, each shown in a strip of its own.
    pub strips: Vec<f64>,
}

/// Which coordinates the map has, and how they turn into laboratory units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// Whether in (η, ρ).
    pub dimensionless: bool,
    /// f0, Hz, where known.
    pub natural_frequency_hz: Option<f64>,
    /// `x_st`, m, where known.
    pub static_deflection_m: Option<f64>,
}

impl Plane {
    /// The plane in which the records can be shown; `None` if they have no place in any.
    pub(crate) fn of(content: &ReportContent) -> Option<Self> {
        let joint = &content.identification.joint.parameters;
        let value = |e: &Option<Estimate>| e.as_ref().and_then(|e| e.value).filter(|v| *v > 0.0);
        let plane = |dimensionless| Self {
            dimensionless,
            natural_frequency_hz: value(&joint.natural_frequency_hz),
            static_deflection_m: value(&joint.static_deflection_m),
        };
        let placed = |p: Self| {
            content
                .compared
                .records
                .iter()
                .any(|r| p.record(r).is_some())
                || content
                    .compared
                    .brackets
                    .iter()
                    .any(|b| p.bracket(b).is_some())
        };
        let modelled = !content.compared.curves.is_empty() || content.compared.region_map.is_some();
        [plane(true), plane(false)]
            .into_iter()
            .find(|p| placed(*p) || (p.dimensionless && modelled))
    }

    /// Position of a record.
    pub(crate) fn record(&self, record: &RecordRow) -> Option<(f64, f64)> {
        if self.dimensionless {
            Some((record.eta?, record.rho?))
        } else {
            Some((record.frequency_hz?, record.clearance_m? * 1e3))
        }
    }

    /// Ends and height of a bracket.
    pub(crate) fn bracket(&self, bracket: &BracketRow) -> Option<((f64, f64), f64)> {
        if self.dimensionless {
            Some((bracket.eta?.into(), bracket.rho?))
        } else {
            let ends = (bracket.frequency_low_hz, bracket.frequency_high_hz);
            Some((ends, bracket.clearance_m * 1e3))
        }
    }

    /// The axes that show all records, brackets and the simulated map. Clearances far above all
    /// that happens are shown in strips above the axes, so that they do not squeeze the rest.
    pub(crate) fn view(&self, content: &ReportContent) -> View {
        let records = || {
            content
                .compared
                .records
                .iter()
                .filter_map(|r| Some((r, self.record(r)?)))
        };
        let brackets = || {
            content
                .compared
                .brackets
                .iter()
                .filter_map(|b| self.bracket(b))
        };
        let xs = records().map(|(_, p)| p.0);
        let x = pad(
            range(xs.chain(brackets().flat_map(|b| [b.0.0, b.0.1]))),
            0.03,
        );
        let ys: Vec<f64> = records().map(|(_, p)| p.1).collect();
        let busy = records().filter(|(r, _)| busy(&r.motion)).map(|(_, p)| p.1);
        let proposed = || content.proposals.iter().map(|p| self.proposed(p).1);
        let busy = range(busy.chain(brackets().map(|b| b.1)).chain(proposed()));
        let strips = strips(&ys, busy);
        let below = ys
            .iter()
            .copied()
            .filter(|y| !strips.iter().any(|s| same(*s, *y)));
        let others = brackets().map(|b| b.1).chain(proposed());
        let y = pad(range(below.chain(others)), 0.06);
        let (x, y) = if self.dimensionless {
            self.with_map(content, x, y)
        } else {
            (x, y)
        };
        let (x, y) = (x.unwrap_or((0.5, 3.0)), y.unwrap_or((0.0, 3.0)));
        let titles = if self.dimensionless {
            ((Phrase::FrequencyRatio, "1"), (Phrase::ClearanceRatio, "1"))
        } else {
            ((Phrase::DriveFrequency, "Hz"), (Phrase::Clearance, "mm"))
        };
        View {
            x: Axis::new(x.0, x.1, titles.0).with_ticks(8),
            y: Axis::new(y.0, y.1, titles.1).with_ticks(7),
            strips: strips.into_iter().filter(|s| *s > y.1).collect(),
        }
    }

    /// Place of a setting that is proposed.
    pub(crate) fn proposed(&self, point: &Proposal) -> (f64, f64) {
        if self.dimensionless {
            (point.frequency_ratio, point.clearance_ratio)
        } else {
            (point.frequency_hz, 1e3 * point.clearance_m)
        }
    }

    fn with_map(&self, content: &ReportContent, x: Range, y: Range) -> (Range, Range) {
        match &content.compared.region_map {
            Some(map) => (union(x, edges(&map.x)), union(y, edges(&map.y))),
            None => (x, y),
        }
    }
}

/// Whether a motion is one that the map is drawn for: one with impacts.
pub fn busy(motion: &Motion) -> bool {
    !matches!(motion, Motion::Impactless | Motion::Undetermined { .. })
}

/// Whether two clearances are one, as set on a rig.
pub(crate) fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 5e-3 * a.abs().max(b.abs())
}

/// The clearances, ascending, far above all impacts, which are within a range; none if they are many.
pub fn strips(all: &[f64], busy: Option<(f64, f64)>) -> Vec<f64> {
    /// More strips than this make a plane of their own.
    const MOST: usize = 3;
    /// Over the highest busy clearance; nearer ones stay in the plane.
    const FAR: f64 = 1.3;
    let Some((_, high)) = busy else {
        return Vec::new();
    };
    let mut far: Vec<f64> = Vec::new();
    for y in all.iter().filter(|y| **y > FAR * high) {
        if !far.iter().any(|f| same(*f, *y)) {
            far.push(*y);
        }
    }
    far.sort_by(f64::total_cmp);
    if far.len() > MOST { Vec::new() } else { far }
}

fn pad(seen: Range, share: f64) -> Range {
    let (low, high) = seen?;
    let pad = if high > low {
        share * (high - low)
    } else {
        0.1 * high.abs().max(1e-3)
    };
    Some((low - pad, high + pad))
}

fn union(a: Range, b: Range) -> Range {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (a, b) => a.or(b),
    }
}

/// Outer edges of evenly spaced cells.
pub(super) fn edges(centres: &[f64]) -> Range {
    let n = centres.len();
    if n < 2 {
        return None;
    }
    let half = 0.5 * (centres[1] - centres[0]);
    Some((centres[0] - half, centres[n - 1] + half))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clearances_far_above_all_impacts_stand_in_strips() {
        let all = [0.6, 1.4, 4.4, 8.9, 8.93];
        assert_eq!(strips(&all, Some((0.6, 4.4))), [8.9]);
        assert!(strips(&all, None).is_empty());
        let many: Vec<f64> = (1..20).map(f64::from).collect();
        assert!(strips(&many, Some((1.0, 2.0))).is_empty());
    }
}
