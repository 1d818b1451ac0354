//! The map's tiles, coarse first, and the boundaries, bare first.

use rayon::prelude::*;

use super::answer::Stop;
use super::frame::Frame;
use super::jobs::Job;
use super::state::MAP_CELLS;
use super::{ExploreError, State};
use impact_oscillator::atlas::map::{UnitMass, even};
use impact_oscillator::model::boundary::{rho_sticking, s1_of_branch, s2_of_branch};
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::patience::carry;
use impact_oscillator::model::range;
use impact_oscillator::{
    BoundaryPoint, Initial, Machine, MapGrid, SettledMotion, region_map, rho_grazing, rho_s1,
    rho_s2,
};
use impact_records::motion::Motion;
use impact_report::style::MotionStyle;

/// Columns and rows of the first tile.
const COARSE: (usize, usize) = (32, 24);
/// Of the last one, of machines that the vector kernel marches.
const FINE: (usize, usize) = (384, 288);
/// Cells computed between two looks at whether the page wants something newer.
const STRIP_CELLS: usize = 12_288;
/// The same of machines that the exact simulator marches, some 0.4 ms a cell.
const SLOW_STRIP_CELLS: usize = 192;
/// X' and Y' of the lively start.
const LIVELY_SPEED: f64 = 3.0;
/// Greatest n of the boundaries of z = 1/n.
const MOST_PERIODS: u32 = 5;
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
    let style = |m: &SettledMotion| MotionStyle::of(&Motion::from(*m));
    (known.iter().map(style).collect(), cells)
}

/// The region map of what the page shows: 32 × 24, 128 × 96, then strips of 384 × 288; of fast machines then 128 × 96
/// from another start, which shows what coexists.
pub(super) fn map(state: &State, job: &Job) -> Result<(), Stop> {
    let before_boundaries = job.first_tiles();
    let machine = state.machine();
    let fast = UnitMass::of(&machine).is_some();
    let levels: &[(usize, usize)] = match fast {
        true => &[COARSE, MAP_CELLS, FINE],
        false => &[COARSE, MAP_CELLS],
    };
    let strip_cells = if fast { STRIP_CELLS } else { SLOW_STRIP_CELLS };
    let finest = levels.len() - 1;
    let first = if fast { finest } else { 0 };
    let tiles = levels.iter().enumerate().map(|(level, &size)| Tile {
        level,
        size,
        strip_cells,
        finest: level == finest,
        is_first: level < first,
        start: state.map_start,
    });
    let send = |tile: Tile| tile.send(state, &machine, job);
    tiles.clone().take(first).try_for_each(send)?;
    drop(before_boundaries);
    tiles.skip(first).try_for_each(send)?;
    match fast {
        true => send(Tile {
            level: levels.len(),
            size: MAP_CELLS,
            strip_cells,
            finest: false,
            is_first: false,
            start: other_start(state),
        }),
        false => Ok(()),
    }
}

/// The start from which motions are sought that coexist with those of the map: lively where the map is from rest.
fn other_start(state: &State) -> Initial {
    let lively = Initial::both(0.0, LIVELY_SPEED);
    if state.map_start == lively {
        Initial::rest()
    } else {
        lively
    }
}

/// One level of the map.
struct Tile {
    level: usize,
    /// Columns and rows.
    size: (usize, usize),
    /// Cells of a strip at most.
    strip_cells: usize,
    /// Whether no finer level follows.
    finest: bool,
    /// Whether it is one of the first tiles.
    is_first: bool,
    /// Start of its cells.
    start: Initial,
}

impl Tile {
    /// Send it strip by strip, each a frame.
    fn send(&self, state: &State, machine: &Machine, job: &Job) -> Result<(), Stop> {
        let mut plan = state.map_plan(self.size);
        plan.map.start = self.start;
        let (eta, rho) = (even(plan.eta), even(plan.rho));
        let rows = (self.strip_cells / self.size.0).max(1);
        let last = (rho.len() - 1) / rows;
        for (number, strip) in rho.chunks(rows).enumerate() {
            if job.is_stale() {
                return Err(Stop::Stale);
            }
            let grid = MapGrid {
                eta: eta.clone(),
                rho: strip.to_vec(),
            };
            let march = || region_map(machine, &grid, &plan.map);
            let map = match self.is_first {
                true => job.pools.first_tiles(march),
                false => job.pools.work(march),
            }?;
            let (motions, cells) = cells(map.cells.iter());
            let frame = job
                .frame("map")
                .with("level", self.level)
                .with("other", self.start != state.map_start)
                .with("size", self.size)
                .with("first_row", number * rows)
                .with("last", self.finest && number == last)
                .with("eta", state.view.eta)
                .with("rho", state.view.rho)
                .with("motions", motions);
            job.send(frame.cells(cells))?;
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
    let curve = &|c: &(&str, u32, Boundary)| curve(&machine, &etas, *c, job);
    job.wait_for_first_tiles();
    let tasks: Vec<_> = curves.iter().map(|c| carry(move || curve(c))).collect();
    let frames: Vec<Frame> = job.pools.work(|| {
        let found = tasks.into_par_iter().map(|task| task());
        found.collect::<Result<_, Stop>>()
    })?;
    Ok(frames.into_iter().try_for_each(|frame| job.send(frame))?)
}

/// One boundary of z = 1/n with where it exists.
fn curve(
    machine: &Machine,
    etas: &[f64],
    (kind, n, of): (&str, u32, Boundary),
    job: &Job,
) -> Result<Frame, Stop> {
    let point = |eta: &f64| match job.is_stale() {
        true => Err(Stop::Stale),
        false => Ok(of(machine, *eta, n)),
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
