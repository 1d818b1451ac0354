//! Motions that rest in a dead zone: after each release from the contact the motion is the
//! same, so they are found by one flight from the release, and their edges by bisection.
//!
//! At the release of one mass (or of two equal ones) the displacement is ρ, the velocity 0 and
//! the drive's phase arccos ρ, falling; one such start at every ρ in (−1, 1). With constant R
//! all of them are marched in the vector kernel; other machines are followed exactly
//! (`atlas::release`).

use serde::{Deserialize, Serialize};

use super::edge::EdgeKind;
use super::grid::{End as MapEnd, MapGrid, MapSettings, Start, clear_of};
use super::kernel::{Cell, Kernel};
use super::release::{Label, Releases as ExactReleases, RestingStart, Run, RunEnd};
use super::threads::march_all;
use super::unit_mass::UnitMass;
use crate::model::{Initial, Machine, Watch};
use crate::parallel;

/// A resting motion's interval along ρ at one η.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RestingSlice {
    /// η
    pub eta: f64,
    /// Impacts in a period of the motion; 1 where they are a complete chatter.
    pub p: u32,
    /// Drive periods in a period of the motion.
    pub n: u32,
    /// Rows that show it, first and last.
    pub interval: (f64, f64),
    /// Its lower edge; `None` where the search's bound comes first.
    pub low: Option<(f64, EdgeKind)>,
    /// Its upper edge.
    pub high: Option<(f64, EdgeKind)>,
}

impl RestingSlice {
    /// Whether it is the motion of p impacts in n periods.
    pub fn is(&self, p: u32, n: u32) -> bool {
        (self.p, self.n) == (p, n)
    }

    /// Whether it contains a clearance.
    pub(super) fn holds(&self, rho: f64) -> bool {
        let low = self.low.map_or(self.interval.0, |e| e.0);
        let high = self.high.map_or(self.interval.1, |e| e.0);
        (low..=high).contains(&rho)
    }
}

/// What the motions that start at the release show, at many (η, ρ) at once.
struct Releases<'a> {
    unit: UnitMass,
    settings: &'a MapSettings,
}

impl Releases<'_> {
    /// (p, n) of each; `None`: it does not rest again and again in the same way.
    fn labels(&self, points: &[(f64, f64)]) -> Vec<Option<Label>> {
        let length = self.unit.scales().0;
        let released = |rho: f64| (-1.0..1.0).contains(&(rho / length));
        let (numbers, cells): (Vec<usize>, Vec<Cell>) = points
            .iter()
            .enumerate()
            .filter(|(_, at)| released(at.1))
            .map(|(i, &at)| {
                let start = Start {
                    at,
                    initial: Initial::both(at.1, 0.0),
                    phase: (at.1 / length).acos(),
                };
                (i, self.unit.cell(&start))
            })
            .unzip();
        let course = self.unit.course(self.settings);
        let outcomes = march_all(&course, &cells, self.settings.kernel);
        let mut labels = vec![None; points.len()];
        for (i, outcome) in numbers.into_iter().zip(outcomes) {
            labels[i] = outcome.motion.numbers(true);
        }
        labels
    }

    /// Move all ends to where their labels change, to 1e-7.
    fn bisect(&self, ends: &mut [End]) {
        let wide = |end: &End| (end.outside - end.inside).abs() > 1e-7;
        loop {
            let open: Vec<usize> = (0..ends.len()).filter(|&i| wide(&ends[i])).collect();
            if open.is_empty() {
                return;
            }
            let middle = |i: &usize| 0.5 * (ends[*i].inside + ends[*i].outside);
            let points: Vec<(f64, f64)> = open.iter().map(|i| (ends[*i].eta, middle(i))).collect();
            for (i, (label, at)) in open.iter().zip(self.labels(&points).iter().zip(points)) {
                let end = &mut ends[*i];
                if *label == Some(end.label) {
                    end.inside = at.1;
                } else {
                    end.outside = at.1;
                }
            }
        }
    }
}

/// An end of a slice between a clearance that shows its label and one that does not.
struct End {
    eta: f64,
    label: Label,
    inside: f64,
    outside: f64,
}

/// All resting motions of at most `most` impacts in at most `longest` drive periods along ρ, for
/// each column of a grid, distinguished at its rows; edges to 1e-7. Cells of the grid's brute-force
/// maps that rest are starts for machines that the kernel cannot march; there may be none.
pub(super) fn resting_slices(
    machine: &Machine,
    grid: &MapGrid,
    (most, longest): (u32, u32),
    kernel: Option<Kernel>,
    maps: &[Vec<MapEnd>],
) -> Vec<Vec<RestingSlice>> {
    let Some(unit) = UnitMass::of(machine) else {
        return exact_slices(machine, grid, (most, longest), maps);
    };
    let settings = release_settings(longest, kernel);
    let releases = Releases {
        unit,
        settings: &settings,
    };
    let points: Vec<(f64, f64)> = (0..grid.len()).map(|i| grid.at(i)).collect();
    let labels = releases.labels(&points);
    let (mut slices, mut ends) = (Vec::new(), Vec::new());
    for column in 0..grid.eta.len() {
        let own: Vec<Option<Label>> = (0..grid.rho.len())
            .map(|k| labels[k * grid.eta.len() + column])
            .collect();
        let mut first = 0;
        for run in own.chunk_by(|a, b| a == b) {
            let last = first + run.len() - 1;
            if let Some(label) = run[0].filter(|l| l.0 <= most && l.1 <= longest) {
                let open = add_ends(grid, column, label, (first, last), &mut ends);
                slices.push((column, open));
            }
            first = last + 1;
        }
    }
    releases.bisect(&mut ends);
    let mut columns = vec![Vec::new(); grid.eta.len()];
    let length = releases.unit.scales().0;
    for (column, slice) in slices {
        columns[column].push(finished(slice, &ends, length));
    }
    columns
}

/// The η between the first and the last of a rising list at which the resting motion of p impacts
/// in n drive periods begins or ends at a clearance, to 1e-7, and whether it is below that η.
pub(super) fn resting_etas(
    machine: &Machine,
    rho: f64,
    (p, n): (u32, u32),
    etas: &[f64],
    kernel: Option<Kernel>,
) -> Vec<(f64, bool)> {
    let Some(unit) = UnitMass::of(machine) else {
        return exact_etas(machine, rho, (p, n), etas);
    };
    let settings = release_settings(n, kernel);
    let releases = Releases {
        unit,
        settings: &settings,
    };
    let shows = |etas: &[f64]| -> Vec<bool> {
        let points: Vec<(f64, f64)> = etas.iter().map(|&eta| (eta, rho)).collect();
        let labels = releases.labels(&points);
        labels.iter().map(|label| *label == Some((p, n))).collect()
    };
    let there = shows(etas);
    let change = |k: &usize| there[*k - 1] != there[*k];
    let edge = |k: usize| {
        let (mut low, mut high) = (etas[k - 1], etas[k]);
        while high - low > 1e-7 {
            let middle = 0.5 * (low + high);
            let side = if shows(&[middle])[0] == there[k - 1] {
                &mut low
            } else {
                &mut high
            };
            *side = middle;
        }
        (if there[k - 1] { low } else { high }, there[k - 1])
    };
    (1..etas.len()).filter(change).map(edge).collect()
}

/// [`resting_slices`] of machines that the kernel cannot march.
fn exact_slices(
    machine: &Machine,
    grid: &MapGrid,
    (most, longest): (u32, u32),
    maps: &[Vec<MapEnd>],
) -> Vec<Vec<RestingSlice>> {
    let Some(releases) = ExactReleases::new(machine, longest) else {
        return vec![Vec::new(); grid.eta.len()];
    };
    let column = |&i: &usize| {
        let eta = grid.eta[i];
        let points: Vec<(f64, f64)> = grid.rho.iter().map(|&rho| (eta, rho)).collect();
        let starts = |k: usize| resting_starts(machine, grid.rho[k], maps, k * grid.eta.len() + i);
        let slice = |run: Run| RestingSlice {
            eta,
            p: run.label.0,
            n: run.label.1,
            interval: (grid.rho[run.points.0], grid.rho[run.points.1]),
            low: run.low.map(|end| (end.at.1, end.kind)),
            high: run.high.map(|end| (end.at.1, end.kind)),
        };
        let sought = |s: &RestingSlice| s.p <= most && s.n <= longest;
        let runs = releases.runs(&points, starts);
        runs.into_iter().map(slice).filter(sought).collect()
    };
    let columns: Vec<usize> = (0..grid.eta.len()).collect();
    parallel::map(&columns, column)
}

/// The ends of a cell's motions that rest, as starts.
fn resting_starts(
    machine: &Machine,
    rho: f64,
    maps: &[Vec<MapEnd>],
    cell: usize,
) -> Vec<RestingStart> {
    let start = |end: &MapEnd| {
        let initial = clear_of(machine, rho, end.initial);
        Some((end.motion.numbers(true)?, initial, end.phase))
    };
    maps.iter()
        .filter_map(|map| start(map.get(cell)?))
        .collect()
}

/// [`resting_etas`] of machines that the kernel cannot march.
fn exact_etas(machine: &Machine, rho: f64, label: Label, etas: &[f64]) -> Vec<(f64, bool)> {
    let Some(releases) = ExactReleases::new(machine, label.1) else {
        return Vec::new();
    };
    let points: Vec<(f64, f64)> = etas.iter().map(|&eta| (eta, rho)).collect();
    let runs = releases.runs(&points, |_| Vec::new());
    let told = |end: Option<RunEnd>| end.filter(|e| e.kind == EdgeKind::DeadZone).map(|e| e.at.0);
    let ends = |run: Run| {
        let (low, high) = (told(run.low), told(run.high));
        low.map(|eta| (eta, false))
            .into_iter()
            .chain(high.map(|eta| (eta, true)))
    };
    let own = runs.into_iter().filter(|run| run.label == label);
    own.flat_map(ends).collect()
}

/// How a motion is marched from its release: settled after at most `longest` drive periods.
fn release_settings(longest: u32, kernel: Option<Kernel>) -> MapSettings {
    MapSettings {
        watch: Watch {
            settle_periods: f64::from(2 * longest + 1),
            watch_periods: 1.0,
            ..Watch::default()
        },
        kernel,
        ..MapSettings::default()
    }
}

/// A slice whose ends are numbers of ends that are still to be moved.
type Open = (RestingSlice, Option<usize>, Option<usize>);

fn add_ends(
    grid: &MapGrid,
    column: usize,
    label: Label,
    (first, last): (usize, usize),
    ends: &mut Vec<End>,
) -> Open {
    let (eta, rho) = (grid.eta[column], &grid.rho);
    let mut add = |inside: usize, outside: usize| {
        ends.push(End {
            eta,
            label,
            inside: rho[inside],
            outside: rho[outside],
        });
        ends.len() - 1
    };
    let low = (first > 0).then(|| add(first, first - 1));
    let high = (last + 1 < rho.len()).then(|| add(last, last + 1));
    let slice = RestingSlice {
        eta,
        p: label.0,
        n: label.1,
        interval: (rho[first], rho[last]),
        low: None,
        high: None,
    };
    (slice, low, high)
}

fn finished((slice, low, high): Open, ends: &[End], length: f64) -> RestingSlice {
    let edge = |i: usize| {
        let rho = ends[i].inside;
        let sticking = rho / length < -1.0 + 1e-6;
        let kind = if sticking {
            EdgeKind::Sticking
        } else {
            EdgeKind::DeadZone
        };
        (rho, kind)
    };
    RestingSlice {
        low: low.map(edge),
        high: high.map(edge),
        ..slice
    }
}
