//! All motions along a line of the (η, ρ) plane: a column at one η or a row at one ρ, each motion
//! followed along it to both its edges.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::continuation::{Along, branch_at_doubling, follow};
use super::edge::{Edge, EdgeKind};
use super::grid::{End, clear_of};
use super::settings::AtlasSettings;
use crate::model::boundary::etas_s2;
use crate::model::orbit::stable_orbit;
use crate::model::{
    Existence, Impact, Initial, Machine, PeriodicOrbit, Setting, SettledMotion, Simulator, rho_s2,
};

/// One motion's interval of existence and stability along a line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Span {
    /// Impacts in a period of the motion.
    pub(super) p: u32,
    /// Drive periods in a period of the motion.
    pub(super) n: u32,
    /// Its lower edge.
    pub(super) low: Edge,
    /// Its upper edge.
    pub(super) high: Edge,
    /// The line's parameter and the greatest approach speed of its orbits, the parameter rising.
    pub(super) branch: Vec<(f64, f64)>,
}

impl Span {
    /// Greatest approach speed at a value of the parameter, between the orbits that were followed.
    fn speed_at(&self, value: f64) -> f64 {
        let k = self.branch.partition_point(|b| b.0 < value);
        match (self.branch.get(k.wrapping_sub(1)), self.branch.get(k)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (value - a.0) / (b.0 - a.0),
            (Some(a), None) | (None, Some(a)) => a.1,
            (None, None) => f64::NAN,
        }
    }

    /// Whether an orbit of a greatest approach speed at a value lies on this branch. Branches of
    /// the same p/n that coexist differ in speed but where they meet.
    fn is_at(&self, value: f64, speed: f64) -> bool {
        (speed - self.speed_at(value)).abs() <= 0.05 * (1.0 + speed)
    }
}

/// One motion's interval of existence and stability along ρ at one η.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slice {
    /// η
    pub eta: f64,
    /// Impacts in a period of the motion.
    pub p: u32,
    /// Drive periods in a period of the motion.
    pub n: u32,
    /// Its lower edge.
    pub low: Edge,
    /// Its upper edge.
    pub high: Edge,
}

impl Slice {
    /// The motion.
    pub fn motion(&self) -> SettledMotion {
        SettledMotion::periodic(self.p, self.n)
    }

    /// Whether it contains a clearance.
    pub fn holds(&self, rho: f64) -> bool {
        self.low.orbit.rho <= rho && rho <= self.high.orbit.rho
    }
}

/// A line of the settings' grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    /// The machine.
    pub(super) machine: &'a Machine,
    /// The grid, the motions that are sought, and how cells are marched.
    pub(super) settings: &'a AtlasSettings,
    /// ρ for a column of the grid, η for a row.
    pub(super) along: Along,
    /// Number of the column or of the row.
    pub(super) number: usize,
}

/// A periodic cell of a line.
#[derive(Debug, Clone, Copy)]
struct CellSeed {
    /// p and n.
    motion: (u32, u32),
    /// Its place along the line.
    k: usize,
    end: End,
}

impl Line<'_> {
    /// All motions: from closed forms, from the maps' cells, from period doublings.
    pub(super) fn spans(&self, maps: &[Vec<End>]) -> Vec<Span> {
        let mut seeds = self.closed_form_seeds();
        let mut cells = self.cell_seeds(maps).into_iter();
        let mut spans: Vec<Span> = Vec::new();
        loop {
            let seed = match seeds.pop_front() {
                Some(seed) => Some(seed),
                None => match cells.next() {
                    Some(cell) => self.seed_of(&cell, &spans),
                    None => return spans,
                },
            };
            let Some(span) = seed.and_then(|seed| self.new_span(&seed, &spans)) else {
                continue;
            };
            seeds.extend(self.doubled(&span));
            spans.push(span);
        }
    }

    /// The orbit of a cell that lies on no known branch.
    fn seed_of(&self, cell: &CellSeed, spans: &[Span]) -> Option<PeriodicOrbit> {
        let value = self.values()[cell.k];
        let mut there = self.spans_at(spans, cell.motion, value).peekable();
        if there.peek().is_some() {
            let at = self.settings.grid.at(self.cell(cell.k));
            let speed = greatest_speed(self.machine, at, &cell.end, cell.motion.1)?;
            if there.any(|s| s.is_at(value, speed)) {
                return None;
            }
        }
        self.stable_orbit_of(cell.k, &cell.end, cell.motion)
    }

    /// The span of a seed that lies on no known branch.
    fn new_span(&self, seed: &PeriodicOrbit, spans: &[Span]) -> Option<Span> {
        let (motion, value) = ((seed.p(), seed.n), self.along.of(seed));
        let speed = seed.greatest_speed();
        if self
            .spans_at(spans, motion, value)
            .any(|s| s.is_at(value, speed))
        {
            return None;
        }
        let span = self.span(seed)?;
        let ends = |s: &Span| (self.along.of(&s.low.orbit), self.along.of(&s.high.orbit));
        let (low, high) = ends(&span);
        let same = |s: &&Span| {
            let (other_low, other_high) = ends(s);
            (low - other_low).abs() < 1e-5 && (high - other_high).abs() < 1e-5
        };
        let mut alike = spans.iter().filter(|s| (s.p, s.n) == motion);
        (!alike.any(|s| same(&s))).then_some(span)
    }

    /// The parameter's values along the line.
    fn values(&self) -> &[f64] {
        match self.along {
            Along::Clearance => &self.settings.grid.rho,
            Along::FrequencyRatio => &self.settings.grid.eta,
        }
    }

    /// Number of a cell of the line in the whole grid.
    fn cell(&self, k: usize) -> usize {
        let columns = self.settings.grid.eta.len();
        match self.along {
            Along::Clearance => k * columns + self.number,
            Along::FrequencyRatio => self.number * columns + k,
        }
    }

    /// The spans of a motion that hold a value.
    fn spans_at<'s>(
        &self,
        spans: &'s [Span],
        motion: (u32, u32),
        value: f64,
    ) -> impl Iterator<Item = &'s Span> + use<'s> {
        let along = self.along;
        let at = move |edge: &Edge| along.of(&edge.orbit);
        let holds = move |s: &&Span| at(&s.low) <= value && value <= at(&s.high);
        let alike = spans.iter().filter(move |s| (s.p, s.n) == motion);
        alike.filter(holds)
    }

    /// Orbits of doubled period where a motion ends in a doubling.
    fn doubled(&self, span: &Span) -> Vec<PeriodicOrbit> {
        let most = (self.settings.largest_p, self.settings.largest_n);
        if 2 * span.p > most.0 || 2 * span.n > most.1 {
            return Vec::new();
        }
        [&span.low, &span.high]
            .into_iter()
            .filter(|edge| edge.kind == EdgeKind::PeriodDoubling)
            // not where it was itself born
            .filter(|edge| edge.orbit.reduced_within(1e-3).n == edge.orbit.n)
            .filter_map(|edge| branch_at_doubling(self.machine, &edge.orbit, self.along))
            .collect()
    }

    /// z = 1/n just inside its saddle-node.
    fn closed_form_seeds(&self) -> VecDeque<PeriodicOrbit> {
        let (machine, grid) = (self.machine, &self.settings.grid);
        let all = 1..=self.settings.largest_n;
        match self.along {
            Along::Clearance => {
                let eta = grid.eta[self.number];
                let seed = |n: u32| {
                    let s2 = rho_s2(machine, eta, n)?;
                    let inside = s2.rho - 1e-4 * (0.1 + s2.rho.abs());
                    single_impact(machine, Setting::new(eta, inside), n)
                };
                all.filter_map(seed).collect()
            }
            Along::FrequencyRatio => {
                let rho = grid.rho[self.number];
                let seeds = |n: u32| {
                    let beside = |eta: f64| [eta * (1.0 - 1e-4), eta * (1.0 + 1e-4)];
                    let etas = etas_s2(machine, rho, n).into_iter().map(move |p| p.eta);
                    etas.flat_map(beside)
                        .filter_map(move |eta| single_impact(machine, Setting::new(eta, rho), n))
                };
                all.flat_map(seeds).collect()
            }
        }
    }

    /// The periodic cells of each map: the middle one of every run of equal ones first, which
    /// mostly lies in the region of all, then the others: a run may hold several branches of p/n
    /// orbits, so all are compared with the known ones by their speed.
    fn cell_seeds(&self, maps: &[Vec<End>]) -> Vec<CellSeed> {
        let count = self.values().len();
        let (mut middles, mut others) = (Vec::new(), Vec::new());
        for map in maps {
            let at = |k: usize| map[self.cell(k)];
            let mut first = 0;
            for k in 1..=count {
                if k < count && at(k).motion == at(first).motion {
                    continue;
                }
                if let Some(motion) = self.sought(at(first).motion) {
                    let middle = (first + k - 1) / 2;
                    let seed = |i: usize| CellSeed {
                        motion,
                        k: i,
                        end: at(i),
                    };
                    middles.push(seed(middle));
                    others.extend((first..k).filter(|&i| i != middle).map(seed));
                }
                first = k;
            }
        }
        middles.append(&mut others);
        middles
    }

    /// p and n of a motion without dead zone within the greatest that are sought.
    fn sought(&self, motion: SettledMotion) -> Option<(u32, u32)> {
        let (p, n) = motion.numbers(false)?;
        (p <= self.settings.largest_p && n <= self.settings.largest_n).then_some((p, n))
    }

    fn stable_orbit_of(&self, k: usize, end: &End, motion: (u32, u32)) -> Option<PeriodicOrbit> {
        let at = self.settings.grid.at(self.cell(k));
        let orbit = orbit_of_cell(self.machine, at, end, motion)?;
        let good = orbit.existence(self.machine) == Existence::Exists;
        (good && orbit.is_stable(self.machine)).then_some(orbit)
    }

    fn span(&self, seed: &PeriodicOrbit) -> Option<Span> {
        let values = self.values();
        let bounds = (*values.first()?, *values.last()?);
        let edge = |direction| follow(self.machine, seed, self.along, direction, bounds);
        let (mut low, mut high) = (edge(-1.0), edge(1.0));
        if self.along.of(&low.edge.orbit) > self.along.of(&high.edge.orbit) {
            std::mem::swap(&mut low, &mut high);
        }
        let mut branch = [low.passed, high.passed].concat();
        branch.sort_by(|a, b| a.0.total_cmp(&b.0));
        branch.dedup_by(|a, b| a.0 == b.0);
        Some(Span {
            p: seed.p(),
            n: seed.n,
            low: low.edge,
            high: high.edge,
            branch,
        })
    }
}

/// The stable orbit z = 1/n at a setting.
fn single_impact(machine: &Machine, setting: Setting, n: u32) -> Option<PeriodicOrbit> {
    let orbit = stable_orbit(machine, setting, n).ok()??;
    let eta = setting.frequency_ratio;
    PeriodicOrbit {
        n,
        eta,
        rho: setting.clearance,
        times: vec![orbit.phase_at_impact / eta],
        speeds: vec![orbit.approach_speed],
    }
    .solve(machine)
}

/// Greatest approach speed in the n drive periods after a cell's end.
fn greatest_speed(machine: &Machine, at: (f64, f64), end: &End, n: u32) -> Option<f64> {
    let (mut simulator, setting) = from_end(machine, at, end)?;
    let mut greatest: Option<f64> = None;
    simulator.advance(f64::from(n) * setting.period(), &mut |i: &Impact| {
        let speed = i.approach_speed;
        greatest = Some(greatest.map_or(speed, |g| g.max(speed)));
    });
    greatest
}

/// The motion of a cell where it ended.
fn from_end(machine: &Machine, at: (f64, f64), end: &End) -> Option<(Simulator, Setting)> {
    let setting = Setting::new(at.0, at.1).at_phase(end.phase);
    let initial: Initial = clear_of(machine, at.1, end.initial);
    Some((Simulator::new(machine, setting, initial).ok()?, setting))
}

/// The p impacts that follow n drive periods after a cell's end.
fn last_impacts(
    machine: &Machine,
    at: (f64, f64),
    end: &End,
    (p, n): (u32, u32),
) -> Option<Vec<Impact>> {
    let (mut simulator, setting) = from_end(machine, at, end)?;
    let mut impacts: Vec<Impact> = Vec::new();
    let periods = f64::from(2 * n + 1);
    simulator.advance(periods * setting.period(), &mut |i: &Impact| {
        impacts.push(*i);
    });
    let last = impacts.len().checked_sub(p as usize)?;
    Some(impacts.split_off(last))
}

/// The orbit on which a cell's last impacts close, stable or not, with the fewest p and n that it
/// is. `None`: Newton's method finds none near them.
pub(super) fn orbit_of_cell(
    machine: &Machine,
    (eta, rho): (f64, f64),
    end: &End,
    motion: (u32, u32),
) -> Option<PeriodicOrbit> {
    let impacts = last_impacts(machine, (eta, rho), end, motion)?;
    let setting = Setting::new(eta, rho).at_phase(end.phase);
    let orbit = PeriodicOrbit::from_impacts(&impacts, setting, motion.1)?.solve(machine)?;
    Some(orbit.reduced())
}
