//! The motion at the cursor, carried or from its start; characteristics along a line; basins.

use std::time::{Duration, Instant};

use serde_json::json;

use super::frame::Frame;
use super::job::Job;
use super::maps::{BEYOND, cells, style};
use super::state::Cursor;
use super::stop::Stop;
use super::{ExploreError, State};
use impact_oscillator::atlas::BasinGrid;
use impact_oscillator::atlas::basins::basin_rows;
use impact_oscillator::atlas::map::{UnitMass, even};
use impact_oscillator::atlas::portrait::{LONGEST_LAG, Portrait, PortraitPlan, portrait};
use impact_oscillator::atlas::sweep::{Carried, SweepPoint, impactless};
use impact_oscillator::model::patience::{carry, still_wanted};
use impact_oscillator::model::range;
use impact_oscillator::model::simulate::Snapshot;
use impact_oscillator::{
    Machine, MapSettings, Setting, SettledMotion, Simulator, Trajectory, Watch,
};
use impact_records::signal::whole;

/// Time after which steps of a sweep are sent together.
const BATCH: Duration = Duration::from_millis(40);
/// Starts settled between two looks at whether the page wants something newer.
const STRIP_CELLS: usize = 2048;
/// The same where the exact simulator settles them.
const SLOW_STRIP_CELLS: usize = 128;

/// Greatest steps of η and ρ on the way of a carried motion: a greater one would throw it out of
/// its basin.
const STEP: (f64, f64) = (0.01, 0.05);
/// Most steps of one way.
const MOST_STEPS: f64 = 400.0;
/// Drive periods of each.
const STEP_PERIODS: f64 = 12.0;

/// Steps on the way of a carried motion; none where it stays.
fn steps_between(from: (f64, f64), to: (f64, f64)) -> u32 {
    let steps = ((to.0 - from.0).abs() / STEP.0).max((to.1 - from.1).abs() / STEP.1);
    whole::count(steps.clamp(0.0, MOST_STEPS).ceil())
}

/// What is seen at the cursor.
pub(super) struct Seen {
    /// Where the motion is now: the next one is carried from there.
    pub cursor: Cursor,
    /// What it settles on, with its characteristics.
    pub point: SweepPoint,
    /// The motion in full.
    pub portrait: Portrait,
}

/// The motion at the cursor: from its start, or carried to it from another (η, ρ), where it settles.
pub(super) fn seen(state: &State, carried_from: Option<(f64, f64)>) -> Result<Seen, ExploreError> {
    let machine = state.machine();
    let cursor = state.cursor;
    let (eta, rho) = carried_from.unwrap_or((cursor.eta, cursor.rho));
    let setting = Setting::new(eta, rho).at_phase(cursor.phase);
    let mut carried = Carried::start_in(&machine, setting, cursor.start, state.watch)?;
    let (begun, phase_then) = carried.place();
    let to = (cursor.eta, cursor.rho);
    carried.go(
        ((eta, rho), to),
        steps_between((eta, rho), to),
        STEP_PERIODS,
    )?;
    let point = carried.step(to)?;
    let (start, phase) = match carried_from {
        Some(_) => carried.place(),
        None => (begun, phase_then),
    };
    let cursor = Cursor {
        start,
        phase,
        ..cursor
    };
    let shown = State {
        cursor,
        ..state.clone()
    };
    let portrait = portrait(&machine, &shown.portrait())?;
    still_wanted()?;
    Ok(Seen {
        cursor,
        point,
        portrait,
    })
}

/// Send the motion at the cursor.
pub(super) fn motion(
    state: &State,
    carried_from: Option<(f64, f64)>,
    job: &Job,
) -> Result<(), Stop> {
    let Seen {
        cursor,
        point,
        portrait,
    } = seen(state, carried_from)?;
    let frame = job
        .frame("motion")
        .with("cursor", cursor)
        .with("gap", portrait.gap)
        .with("two_masses", portrait.two_masses);
    let frame = with_facts(frame, &state.machine(), &point);
    Ok(job.send(with_portrait(frame, &portrait))?)
}

/// With the motion and its characteristics.
fn with_facts(frame: Frame, machine: &Machine, point: &SweepPoint) -> Frame {
    let free = impactless(machine, point.eta);
    frame
        .with("motion", style(&point.motion))
        .with("lyapunov_error", point.lyapunov_error)
        .with("x_max", point.x_max)
        .with("x_min", point.x_min)
        .with("lyapunov", point.lyapunov)
        .with("approach_speeds", &point.approach_speeds)
        .with("impactless", json!({"x": free.x, "y": free.y}))
}

fn with_portrait(frame: Frame, p: &Portrait) -> Frame {
    let (s, i, q) = (&p.samples, &p.impacts, &p.poincare);
    let or_nan = |v: Option<f64>| v.unwrap_or(f64::NAN);
    frame
        .column("periods", s.iter().map(|s| s.periods))
        .column("x", s.iter().map(|s| s.x))
        .column("vx", s.iter().map(|s| s.vx))
        .column("y", s.iter().map(|s| s.y))
        .column("sticking", s.iter().map(|s| f64::from(s.sticking)))
        .column("impact_periods", i.iter().map(|i| i.periods))
        .column("impact_x", i.iter().map(|i| i.x))
        .column("impact_vx_before", i.iter().map(|i| or_nan(i.vx_before)))
        .column("impact_vx_after", i.iter().map(|i| or_nan(i.vx_after)))
        .column("poincare_x", q.iter().map(|s| s[0]))
        .column("poincare_vx", q.iter().map(|s| s[1]))
        .column("lag", p.autocorrelation.iter().map(|a| a.0))
        .column("autocorrelation", p.autocorrelation.iter().map(|a| a.1))
}

/// Most drive periods that a stretch of a running motion may have.
const MOST_RUN: f64 = 50.0;
/// Samples of a running motion in a drive period.
const RUN_SAMPLES: f64 = 80.0;

/// Drive periods that a running motion is looked at to say what it is now.
const NOW_PERIODS: f64 = 24.0;

/// What a running motion is now: its coming periods, without settling.
fn now(
    state: &State,
    machine: &Machine,
    from: &Snapshot,
    frame: Frame,
) -> Result<Frame, ExploreError> {
    let cursor = &state.cursor;
    let watch = Watch {
        settle_periods: 0.0,
        watch_periods: NOW_PERIODS,
        ..state.watch
    };
    let mut motion = Carried::resume(machine, from, watch)?;
    let (start, phase) = motion.place();
    let point = motion.step((cursor.eta, cursor.rho))?;
    let plan = PortraitPlan {
        setting: Setting::new(cursor.eta, cursor.rho).at_phase(phase),
        start,
        periods: NOW_PERIODS,
        poincare_periods: 2 * LONGEST_LAG,
        ..state.portrait()
    };
    let seen = portrait(machine, &plan)?;
    let mut style = style(&point.motion);
    if !point.motion.is_periodic() {
        style.label = "not periodic".into();
    }
    Ok(with_facts(frame, machine, &point)
        .with("motion", style)
        .column("lag", seen.autocorrelation.iter().map(|a| a.0))
        .column("autocorrelation", seen.autocorrelation.iter().map(|a| a.1)))
}

/// The next stretch of the motion at the cursor, and where it is then.
pub(super) fn run(state: &State, periods: f64, facts: bool, job: &Job) -> Result<(), Stop> {
    let some = periods > 0.0 && periods <= MOST_RUN;
    range("periods", periods, some, "above 0, at most 50")?;
    let machine = state.machine();
    let setting = state.cursor.setting();
    let start = Carried::start_in(&machine, setting, state.cursor.start, state.watch)?;
    let mut simulator = Simulator::resume(&machine, &start.snapshot())?;
    let mut stretch = Trajectory::default();
    let period = setting.period();
    simulator.advance(periods * period, &mut stretch);
    still_wanted()?;
    let steps = whole::index((periods * RUN_SAMPLES).ceil());
    let taus = even((0.0, periods * period, steps + 1));
    let states = stretch.sample(taus.iter().copied());
    let (start, phase) = (simulator.state().into(), simulator.phase());
    let cursor = Cursor {
        start,
        phase,
        ..state.cursor
    };
    let lead = (state.poincare_phase - state.cursor.phase).rem_euclid(std::f64::consts::TAU);
    let first = lead / setting.frequency_ratio;
    let strobes = (0..).map(|k| first + f64::from(k) * period);
    let strobes: Vec<f64> = strobes.take_while(|t| *t < periods * period).collect();
    let crossed = stretch.sample(strobes);
    let hits = &stretch.impacts;
    let frame = job
        .frame("run")
        .with("cursor", cursor)
        .with("gap", machine.gap(state.cursor.rho))
        .with("two_masses", machine.y.is_some());
    let frame = if facts {
        now(state, &machine, &simulator.snapshot(), frame)?
    } else {
        frame
    };
    let frame = frame
        .column("periods", taus.iter().map(|t| t / period))
        .column("x", states.iter().map(|s| s.x))
        .column("vx", states.iter().map(|s| s.vx))
        .column("y", states.iter().map(|s| s.y))
        .column("poincare_x", crossed.iter().map(|s| s.x))
        .column("poincare_vx", crossed.iter().map(|s| s.vx))
        .column("impact_periods", hits.iter().map(|i| i.tau / period))
        .column("impact_x", hits.iter().map(|i| stretch.at(i.tau).x))
        .column("impact_vx_before", hits.iter().map(|i| i.vx_before))
        .column("impact_vx_after", hits.iter().map(|i| i.vx_after));
    Ok(job.send(frame)?)
}

/// One direction of a sweep, with the steps that were not sent yet.
struct Way<'a> {
    name: &'static str,
    carried: Carried<'a>,
    places: Vec<(f64, f64)>,
    sent: usize,
    points: Vec<SweepPoint>,
}

impl<'a> Way<'a> {
    fn new(
        name: &'static str,
        machine: &'a Machine,
        state: &State,
        (places, start): (Vec<(f64, f64)>, impact_oscillator::Initial),
    ) -> Result<Self, ExploreError> {
        let first = places.first().copied().unwrap_or((1.0, 0.0));
        Ok(Self {
            name,
            carried: Carried::start(machine, first, start, state.watch)?,
            places,
            sent: 0,
            points: Vec::new(),
        })
    }

    fn step(&mut self) -> Result<(), ExploreError> {
        if let Some(at) = self.places.get(self.sent + self.points.len()) {
            self.points.push(self.carried.step(*at)?);
        }
        Ok(())
    }

    /// The steps that were not sent yet.
    fn frame(&mut self, machine: &Machine, job: &Job) -> Frame {
        let points = std::mem::take(&mut self.points);
        let first = self.sent;
        self.sent += points.len();
        let speeds = points.iter().enumerate();
        let speeds = speeds.flat_map(|(i, p)| p.approach_speeds.iter().map(move |v| (i, *v)));
        let speeds: Vec<(usize, f64)> = speeds.collect();
        let x_speeds = points.iter().flat_map(|p| p.x_speeds.iter().copied());
        let free = |p: &SweepPoint| impactless(machine, p.eta);
        let labels: Vec<String> = points.iter().map(|p| p.motion.label()).collect();
        job.frame("line")
            .with("way", self.name)
            .with("first", first)
            .with("all", self.places.len())
            .with("labels", labels)
            .column("eta", points.iter().map(|p| p.eta))
            .column("rho", points.iter().map(|p| p.rho))
            .column("x_max", points.iter().map(|p| p.x_max))
            .column("x_min", points.iter().map(|p| p.x_min))
            .column(
                "lyapunov",
                points.iter().map(|p| p.lyapunov.unwrap_or(f64::NAN)),
            )
            .column(
                "lyapunov_error",
                points.iter().map(|p| p.lyapunov_error.unwrap_or(0.0)),
            )
            .column("impactless", points.iter().map(|p| free(p).x.0))
            .column("impactless_phase", points.iter().map(|p| free(p).x.1))
            .column(
                "correlation",
                points
                    .iter()
                    .map(|p| p.autocorrelation.first().copied().unwrap_or(f64::NAN)),
            )
            .column("impact_step", speeds.iter().map(|s| (first + s.0) as f64))
            .column("impact_speed", speeds.iter().map(|s| s.1))
            .column("impact_x_speed", x_speeds)
    }
}

/// Characteristics along the line, up and down, streamed as they are computed.
pub(super) fn line(state: &State, job: &Job) -> Result<(), Stop> {
    let Some(line) = &state.line else {
        let message = "no line is chosen: draw one with L, or press H or I";
        return Err(Stop::Refused(ExploreError::Absent(message.into())));
    };
    let machine = state.machine();
    let eta = even((line.eta.0, line.eta.1, line.steps));
    let rho = even((line.rho.0, line.rho.1, line.steps));
    let up: Vec<(f64, f64)> = eta.into_iter().zip(rho).collect();
    let down: Vec<(f64, f64)> = up.iter().rev().copied().collect();
    let mut up = Way::new("up", &machine, state, (up, line.start))?;
    let mut down = Way::new("down", &machine, state, (down, line.start))?;
    let mut since = Instant::now();
    for step in 1..=line.steps {
        let (a, b) = (carry(|| up.step()), carry(|| down.step()));
        let (a, b) = job.pools.work(|| rayon::join(a, b));
        a.and(b)?;
        if job.is_stale() {
            return Err(Stop::Stale);
        }
        if step == line.steps || since.elapsed() > BATCH {
            job.send(up.frame(&machine, job))?;
            job.send(down.frame(&machine, job))?;
            since = Instant::now();
        }
    }
    Ok(())
}

/// Columns and rows of the first basins, and of the starts of coexisting motions.
const COARSE_STARTS: usize = 24;

/// The basins' grid with few starts.
fn coarse_starts(state: &State) -> BasinGrid {
    let mut grid = state.basin_grid();
    (grid.x.2, grid.vx.2) = (grid.x.2.min(COARSE_STARTS), grid.vx.2.min(COARSE_STARTS));
    grid
}

/// What the starts of a grid settle on, strip by strip: `each` takes the first row and its starts.
fn settled_starts(
    state: &State,
    grid: &BasinGrid,
    job: &Job,
    mut each: impl FnMut(usize, &[Option<SettledMotion>]) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let machine = state.machine();
    let fast = UnitMass::of(&machine).is_some();
    let strip_cells = if fast { STRIP_CELLS } else { SLOW_STRIP_CELLS };
    let settings = MapSettings {
        watch: state.watch,
        ..MapSettings::default()
    };
    let setting = state.cursor.setting();
    let rows = (strip_cells / grid.x.2).max(1);
    let mut first = 0;
    while first < grid.rows() {
        if job.is_stale() {
            return Err(Stop::Stale);
        }
        let last = (first + rows).min(grid.rows());
        let rows = || basin_rows(&machine, setting, grid, &settings, first..last);
        each(first, &job.pools.work(rows)?)?;
        first = last;
    }
    Ok(())
}

/// Basins of attraction at the cursor, coarse first, with the share of each motion.
pub(super) fn basins(state: &State, job: &Job) -> Result<(), Stop> {
    let grids = [coarse_starts(state), state.basin_grid()];
    for (level, grid) in grids.into_iter().enumerate() {
        settled_starts(state, &grid, job, |first, found| {
            let frame = job
                .frame("basins")
                .with("level", level)
                .with("size", (grid.x.2, grid.vx.2))
                .with("first_row", first)
                .with("x", (grid.x.0, grid.x.1))
                .with("vx", (grid.vx.0, grid.vx.1));
            Ok(job.send(with_starts(frame, found))?)
        })?;
    }
    Ok(())
}

/// The motions that starts at the cursor settle on, and the number of starts of each.
pub(super) fn coexisting(state: &State, job: &Job) -> Result<(), Stop> {
    let mut all = Vec::new();
    settled_starts(state, &coarse_starts(state), job, |_, found| {
        all.extend(found.iter().flatten().copied());
        Ok(())
    })?;
    let (motions, cell) = cells(all.iter());
    let count = |k: usize| cell.iter().filter(|c| usize::from(**c) == k).count();
    let counts: Vec<usize> = (0..motions.len()).map(count).collect();
    let frame = job.frame("coexisting").with("motions", motions);
    Ok(job.send(frame.with("counts", counts))?)
}

fn with_starts(frame: Frame, found: &[Option<SettledMotion>]) -> Frame {
    let (motions, known) = cells(found.iter().flatten());
    let mut known = known.into_iter();
    let cell = |c: &Option<SettledMotion>| match c {
        Some(_) => known.next().unwrap_or(BEYOND),
        None => BEYOND,
    };
    let all = found.iter().map(cell).collect();
    frame.with("motions", motions).cells(all)
}
