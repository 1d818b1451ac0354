//! The map's tiles, coarse first, and the boundaries, bare first.

use std::time::Duration;

use rayon::prelude::*;

use super::beside::coexisting;
use super::frame::Frame;
use super::job::Job;
use super::state::MAP_CELLS;
use super::stop::Stop;
use super::{ExploreError, State};
use impact_oscillator::atlas::coexisting::MOST_PERIODS;
use impact_oscillator::atlas::map::{UnitMass, even, first_map};
use impact_oscillator::model::boundary::{rho_sticking, s1_of_branch, s2_of_branch};
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::patience::carry;
use impact_oscillator::model::range;
use impact_oscillator::{
    BoundaryPoint, Machine, MapGrid, MapSettings, SettledMotion, region_map, rho_grazing, rho_s1,
    rho_s2,
};
use impact_records::motion::Motion;
use impact_report::style::MotionStyle;

/// Columns and rows of the first tile.
const COARSE: (usize, usize) = (32, 24);
/// Of the last one, of machines that the vector kernel marches.
const FINE: (usize, usize) = (384, 288);
/// Cells of a strip of the last tile: what is asked for meanwhile, as the boundaries, waits for one strip at most.
const STRIP_CELLS: usize = 3072;
/// The same of every tile of machines that the exact simulator marches, some 0.4 ms a cell.
const SLOW_STRIP_CELLS: usize = 192;
/// How long a page is left as it is before what coexists is sought, which keeps the processors from a next map.
const UNTOUCHED: Duration = Duration::from_millis(250);
/// Most points of a boundary that a page may ask for.
const MOST_POINTS: usize = 2000;

/// Cell of a start that is beyond the contact.
pub(super) const BEYOND: u16 = u16::MAX;

/// Motions as cells: each motion that occurs once, and its number in each cell. There are at most as many
/// motions as cells, and no strip has as many cells as 16 bits have numbers.
pub(super) fn cells<'a>(
    motions: impl Iterator<Item = &'a SettledMotion>,
) -> (Vec<MotionStyle>, Vec<u16>) {
    let mut known: Vec<SettledMotion> = Vec::new();
    let index = |motion: &SettledMotion| {
        let found = known.iter().position(|m| m == motion);
        let index = found.unwrap_or_else(|| {
            known.push(*motion);
            known.len() - 1
        });
        u16::try_from(index).unwrap_or(BEYOND - 1)
    };
    let cells = motions.map(index).collect();
    (known.iter().map(style).collect(), cells)
}

/// How a simulated motion is shown.
pub(super) fn style(motion: &SettledMotion) -> MotionStyle {
    MotionStyle {
        label: motion.label(),
        ..MotionStyle::of(&Motion::from(*motion))
    }
}

/// The region map of what the page shows: 32 × 24, 128 × 96, of fast machines then strips of 384 × 288; at last
/// for each cell of 128 × 96 a motion that coexists with its own.
pub(super) fn map(state: &State, job: &Job) -> Result<(), Stop> {
    let before_boundaries = job.first_tiles();
    let machine = state.machine();
    let fast = UnitMass::of(&machine).is_some();
    let levels: &[(usize, usize)] = if fast {
        &[COARSE, MAP_CELLS, FINE]
    } else {
        &[COARSE, MAP_CELLS]
    };
    let tiles = Tiles {
        state,
        machine: &machine,
        fast,
        finest: levels.len() - 1,
        first: if fast { levels.len() - 1 } else { 0 },
        job,
    };
    let mut waiting = Some(before_boundaries);
    for (level, &size) in levels.iter().enumerate() {
        if level >= tiles.first {
            waiting = None;
        }
        tiles.send(level, size)?;
    }
    drop(waiting);
    job.wait_while_wanted(UNTOUCHED)?;
    tiles.send_coexisting()
}

/// The levels of a map.
struct Tiles<'a> {
    state: &'a State,
    machine: &'a Machine,
    /// Whether the vector kernel marches it.
    fast: bool,
    /// The last level.
    finest: usize,
    /// The first level that is not of the first tiles.
    first: usize,
    job: &'a Job,
}

impl Tiles<'_> {
    /// Send a level strip by strip, each a frame.
    fn send(&self, level: usize, size: (usize, usize)) -> Result<(), Stop> {
        let settings = MapSettings {
            start: self.state.map_start,
            ..self.state.map_settings()
        };
        self.strips(size, |grid, first_row, last| {
            let (machine, pools) = (self.machine, &self.job.pools);
            let map = if level < self.first {
                pools.first_tiles(|| first_map(machine, grid, &settings))
            } else {
                pools.work(|| region_map(machine, grid, &settings))
            }?;
            let last = last && level == self.finest;
            let frame = self.frame("map", size, first_row).with("level", level);
            let (motions, cells) = cells(map.cells.iter());
            let frame = frame.with("last", last).with("motions", motions);
            Ok(self.job.send(frame.cells(cells))?)
        })
    }

    /// Send what coexists with the motions of 128 × 96 cells.
    fn send_coexisting(&self) -> Result<(), Stop> {
        self.strips(MAP_CELLS, |grid, first_row, _| {
            let find = || coexisting(self.state, self.machine, grid);
            let found = self.job.pools.work(find)?;
            let (motions, cells) = cells(found.iter());
            let frame = self.frame("beside", MAP_CELLS, first_row);
            Ok(self.job.send(frame.with("motions", motions).cells(cells))?)
        })
    }

    fn frame(&self, kind: &str, size: (usize, usize), first_row: usize) -> Frame {
        let frame = self.job.frame(kind).with("size", size);
        let frame = frame.with("first_row", first_row);
        frame
            .with("eta", self.state.view.eta)
            .with("rho", self.state.view.rho)
    }

    /// Cells of a strip at most: the first tiles of fast machines are whole.
    fn strip_cells(&self, size: (usize, usize)) -> usize {
        match (self.fast, size) {
            (false, _) => SLOW_STRIP_CELLS,
            (true, FINE) => STRIP_CELLS,
            (true, _) => size.0 * size.1,
        }
    }

    /// Work on strips of rows, each with the number of its first row and whether it is the last.
    fn strips(
        &self,
        size: (usize, usize),
        mut work: impl FnMut(&MapGrid, usize, bool) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        let plan = self.state.map_plan(size);
        let (eta, rho) = (even(plan.eta), even(plan.rho));
        let rows = (self.strip_cells(size) / size.0).max(1);
        let last = (rho.len() - 1) / rows;
        for (number, strip) in rho.chunks(rows).enumerate() {
            if self.job.is_stale() {
                return Err(Stop::Stale);
            }
            let grid = MapGrid {
                eta: eta.clone(),
                rho: strip.to_vec(),
            };
            work(&grid, number * rows, number == last)?;
        }
        Ok(())
    }
}

/// A boundary by η.
type Boundary = fn(&Machine, f64, u32) -> Option<BoundaryPoint>;

/// The η at which a page wants the boundaries.
fn boundary_etas(state: &State, points: usize) -> Result<Vec<f64>, ExploreError> {
    let some = (2..=MOST_POINTS).contains(&points);
    range("points", points as f64, some, "2 to 2000")?;
    let (low, high) = state.view.eta;
    Ok(even((low, high, points)))
}

/// The boundaries of z = 1/n, ρ' and ρp without a check of where they exist.
pub(super) fn bare(state: &State, points: usize, id: u32) -> Result<Frame, ExploreError> {
    let machine = state.machine();
    let etas = boundary_etas(state, points)?;
    let first = Frame::new("boundaries", id)
        .column("eta", etas.iter().copied())
        .column("grazing", etas.iter().map(|e| rho_grazing(&machine, *e)))
        .column("sticking", etas.iter().map(|e| rho_sticking(&machine, *e)));
    Ok((1..=MOST_PERIODS).fold(first, |frame, n| {
        let frame = frame.column(&format!("s2:{n}"), bare_s2(&machine, &etas, n));
        frame.column(&format!("s1:{n}"), bare_s1(&machine, &etas, n))
    }))
}

/// The boundaries of z = 1/n with where they exist, one frame each: after the first tiles of a fast map, and all
/// in one go, so that no strip of it comes between them.
pub(super) fn boundaries(state: &State, points: usize, job: &Job) -> Result<(), Stop> {
    let machine = state.machine();
    let etas = boundary_etas(state, points)?;
    let both = |n| [("s2", n, rho_s2 as Boundary), ("s1", n, rho_s1)];
    let curves: Vec<_> = (1..=MOST_PERIODS).flat_map(both).collect();
    let curve = &|&(kind, n, of): &(&str, u32, Boundary)| curve(&machine, &etas, kind, n, of, job);
    job.wait_for_first_tiles();
    let tasks: Vec<_> = curves.iter().map(|c| carry(move || curve(c))).collect();
    let frames: Vec<Frame> = job.pools.boundaries(|| {
        let found = tasks.into_par_iter().map(|task| task());
        found.collect::<Result<_, Stop>>()
    })?;
    Ok(frames.into_iter().try_for_each(|frame| job.send(frame))?)
}

/// One boundary of z = 1/n with where it exists.
fn curve(
    machine: &Machine,
    etas: &[f64],
    kind: &str,
    n: u32,
    of: Boundary,
    job: &Job,
) -> Result<Frame, Stop> {
    let point = |eta: &f64| {
        if job.is_stale() {
            Err(Stop::Stale)
        } else {
            Ok(of(machine, *eta, n))
        }
    };
    let found: Vec<Option<BoundaryPoint>> = etas.iter().map(point).collect::<Result<_, _>>()?;
    let rho = |p: &Option<BoundaryPoint>| p.map_or(f64::NAN, |p| p.rho);
    let valid = |p: &Option<BoundaryPoint>| f64::from(p.is_some_and(|p| p.is_valid()));
    Ok(job
        .frame("boundary")
        .with("name", format!("{kind}:{n}"))
        .with("last", n == MOST_PERIODS && kind == "s1")
        .column("eta", etas.iter().copied())
        .column("rho", found.iter().map(rho))
        .column("exists", found.iter().map(valid)))
}

/// ρ at s2 without a check of existence; none where R depends on the speed.
fn bare_s2(machine: &Machine, etas: &[f64], n: u32) -> Vec<f64> {
    let Some(r) = machine.restitution().constant() else {
        return Vec::new();
    };
    let rho = |e: &f64| s2_of_branch(&Branch::new(machine, *e, n), r).0 / machine.gap(1.0);
    etas.iter().map(rho).collect()
}

/// ρ at s1 without a check of existence; none where it has no closed form.
fn bare_s1(machine: &Machine, etas: &[f64], n: u32) -> Vec<f64> {
    let equal = machine.y.is_none() || machine.is_symmetric();
    let Some(r) = machine.restitution().constant().filter(|_| equal) else {
        return Vec::new();
    };
    let rho = |e: &f64| {
        let found = s1_of_branch(machine, &Branch::new(machine, *e, n), r);
        found.map_or(f64::NAN, |(rho, _)| rho)
    };
    etas.iter().map(rho).collect()
}
