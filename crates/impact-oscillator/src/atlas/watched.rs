//! Cells in which the kernel recognised no orbit, watched once more with their impacts: they may
//! converge slowly, beat, or be chaotic.

use super::grid::MapSettings;
use super::kernel::{Cell, Course, Feed, Outcome, Strike, run};
use super::lyapunov::{Lyapunov, Variations};
use super::settling::{CHAOTIC_PERIODS, MOST_ROUNDS, is_hardly_seen, variations};
use super::threads::{Shared, available, march_all, on_all_threads};
use super::unit_mass::UnitMass;
use crate::model::recurrence::{Return, observe, of_returns};
use crate::model::{
    Impact, ImpactKind, Initial, Machine, Setting, SettledMotion, Simulator, Watch,
};
use crate::parallel;

/// A thread's cells that are watched, each with its impacts so far.
struct Watching<'a> {
    cells: Shared<'a>,
    machine: &'a Machine,
    watch: &'a Watch,
    /// The watch by which the motion was taken for settled.
    settled_by: &'a Watch,
    open: Vec<Open>,
    done: Vec<(usize, Seen)>,
}

/// What a watch has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Seen {
    /// The motion.
    Motion(SettledMotion),
    /// No recurrence, or one that was hardly seen, and it is open whether variations grow.
    Open,
    /// A mass rested, which the kernel's impacts do not tell, or variations decay.
    Inexact,
}

/// A cell that is being watched.
struct Open {
    index: usize,
    start: Cell,
    strikes: Vec<Strike>,
    rests: bool,
}

impl Watching<'_> {
    fn open(&mut self, index: usize) -> Option<&mut Open> {
        self.open.iter_mut().find(|cell| cell.index == index)
    }

    fn seen(&self, cell: &Open) -> Seen {
        let setting = Setting::new(cell.start.eta, cell.start.rho);
        let interval = (0.0, self.watch.watch_periods * setting.period());
        let Some(restitution) = self
            .machine
            .restitution()
            .constant()
            .filter(|_| !cell.rests)
        else {
            return Seen::Inexact;
        };
        let strikes = cell.strikes.iter();
        let returns = strikes.map(|strike| bounce(&cell.start, restitution, *strike));
        let returns: Vec<Return> = returns.collect();
        let motion = of_returns(&returns, self.machine, setting, interval, self.watch);
        let is_late = is_hardly_seen(&motion, self.settled_by);
        if is_late && self.watch.watch_periods < CHAOTIC_PERIODS {
            return Seen::Open;
        }
        if motion != SettledMotion::Chaotic && !is_late {
            return Seen::Motion(motion);
        }
        let mut lyapunov = Lyapunov::new(self.machine, setting.frequency_ratio);
        for strike in &returns {
            lyapunov.strike(strike.x, &strike.impact);
        }
        match lyapunov.variations() {
            Variations::Grow => Seen::Motion(SettledMotion::Chaotic),
            _ if is_late => Seen::Motion(motion),
            Variations::Decay => Seen::Inexact,
            Variations::Open => Seen::Open,
        }
    }
}

impl Feed for Watching<'_> {
    fn next(&mut self) -> Option<(usize, Cell)> {
        let (index, start) = self.cells.take()?;
        self.open.push(Open {
            index,
            start,
            strikes: Vec::new(),
            rests: false,
        });
        Some((index, start))
    }

    fn impact(&mut self, index: usize, strike: Strike) {
        if let Some(cell) = self.open(index) {
            cell.strikes.push(strike);
        }
    }

    fn rests(&mut self, index: usize) {
        if let Some(cell) = self.open(index) {
            cell.rests = true;
        }
    }

    fn done(&mut self, index: usize, _: Outcome) {
        if let Some(place) = self.open.iter().position(|cell| cell.index == index) {
            let cell = self.open.swap_remove(place);
            self.done.push((index, self.seen(&cell)));
        }
    }
}

/// An impact of one mass against the stop, as the simulator has it.
fn bounce(start: &Cell, restitution: f64, strike: Strike) -> Return {
    let separation_speed = -strike.v_after;
    let approach_speed = separation_speed / restitution;
    let phase = start.phase + start.eta * strike.t;
    Return {
        impact: Impact {
            tau: strike.t,
            phase: phase.rem_euclid(std::f64::consts::TAU),
            vx_before: approach_speed,
            vx_after: strike.v_after,
            vy_before: 0.0,
            vy_after: 0.0,
            approach_speed,
            separation_speed,
            kind: ImpactKind::Bounce,
            dead_zone: 0.0,
        },
        x: start.rho,
    }
}

/// How long a motion is followed in which no orbit was recognised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Follow {
    /// One watch long: what is open then has not settled.
    Watch,
    /// Until it recurs or is known to be chaos, within limits.
    Decision,
}

/// Watch the outcomes without a recognised motion, or with one that was hardly seen, once more, in the kernel, where a mass comes to rest in the exact
/// simulator; up to a decision, longer where it stays open whether they are chaotic, and settling on where variations
/// decay.
pub(super) fn watch_again(
    unit: &UnitMass,
    outcomes: &mut [Outcome],
    settings: &MapSettings,
    follow: Follow,
) {
    let watch = settings.watch;
    let is_open =
        |o: &Outcome| o.motion == SettledMotion::Chaotic || is_hardly_seen(&o.motion, &watch);
    let mut open: Vec<&mut Outcome> = outcomes.iter_mut().filter(|o| is_open(o)).collect();
    let mut inexact: Vec<&mut Outcome> = Vec::new();
    let rounds: &[f64] = match follow {
        Follow::Watch => &[0.0],
        Follow::Decision => &[0.0, CHAOTIC_PERIODS],
    };
    for &periods in rounds {
        let watch_periods = watch.watch_periods.max(periods);
        let ends: Vec<Cell> = open.iter().map(|o| o.end).collect();
        let watch = Watch {
            watch_periods,
            ..watch
        };
        let found = watched(unit, &ends, &watch, settings);
        let seen = std::mem::take(&mut open).into_iter().zip(found);
        for (outcome, seen) in seen {
            match seen {
                Seen::Motion(motion) => outcome.motion = motion,
                Seen::Open => open.push(outcome),
                Seen::Inexact => inexact.push(outcome),
            }
        }
    }
    match follow {
        Follow::Watch => {
            for outcome in open {
                outcome.motion = SettledMotion::NotSettled;
            }
        }
        Follow::Decision => inexact.append(&mut open),
    }
    observe_exactly(unit, inexact, settings, follow);
}

/// Observe motions in the exact simulator from where they end; up to a decision those that are no chaos settle on in the
/// kernel between, as one does in [`settle_on`](super::settling::settle_on).
fn observe_exactly(
    unit: &UnitMass,
    mut open: Vec<&mut Outcome>,
    settings: &MapSettings,
    follow: Follow,
) {
    let (machine, watch) = (unit.machine(), settings.watch);
    let observe = |open: &mut Vec<&mut Outcome>, may_be_chaos: bool| {
        let ends: Vec<Cell> = open.iter().map(|o| o.end).collect();
        let motions = parallel::map(&ends, |end| observed(&machine, end, &watch, may_be_chaos));
        for (outcome, motion) in open.iter_mut().zip(motions) {
            outcome.motion = motion;
        }
        open.retain(|o| o.motion == SettledMotion::NotSettled);
    };
    observe(&mut open, false);
    if follow == Follow::Watch {
        return;
    }
    if watch.settle_periods == 0.0 {
        // a watch of what is now is not judged
        open.iter_mut()
            .for_each(|o| o.motion = SettledMotion::Chaotic);
        return;
    }
    for round in 0..=MOST_ROUNDS {
        if open.is_empty() {
            return;
        }
        let course = Course {
            settle_periods: watch.settle_periods * 2_f64.powi(round),
            watch_periods: 0.0,
            leave_early: false,
            ..unit.course(settings)
        };
        let ends: Vec<Cell> = open.iter().map(|o| o.end).collect();
        let settled = march_all(&course, &ends, settings.kernel);
        for (outcome, settled) in open.iter_mut().zip(settled) {
            outcome.end = settled.end;
        }
        observe(&mut open, true);
    }
}

/// What the kernel's watch shows of cells.
fn watched(unit: &UnitMass, ends: &[Cell], watch: &Watch, settings: &MapSettings) -> Vec<Seen> {
    let machine = &unit.machine();
    if machine.restitution().constant() <= Some(0.0) {
        return vec![Seen::Inexact; ends.len()];
    }
    let course = Course {
        leave_early: false,
        every_impact: true,
        watch_periods: watch.watch_periods,
        ..unit.course(settings)
    };
    let kernel = available(settings.kernel);
    on_all_threads(ends, |cells| {
        let mut watching = Watching {
            cells,
            machine,
            watch,
            settled_by: &settings.watch,
            open: Vec::new(),
            done: Vec::new(),
        };
        run(kernel, &course, &mut watching);
        watching.done
    })
}

/// The motion from a cell's end on, in the exact simulator: without recurrence, or with one that was hardly seen, it has
/// not settled, or is chaos where that is judged and variations grow.
fn observed(machine: &Machine, end: &Cell, watch: &Watch, may_be_chaos: bool) -> SettledMotion {
    let setting = Setting::new(end.eta, end.rho).at_phase(end.phase);
    let start = Initial {
        x: end.x.min(end.rho),
        vx: end.v,
        ..Initial::rest()
    };
    let Ok(begin) = Simulator::new(machine, setting, start) else {
        return SettledMotion::NotSettled;
    };
    let motion = observe(&mut begin.clone(), setting, watch).0;
    let is_late = is_hardly_seen(&motion, watch);
    if motion != SettledMotion::Chaotic && !is_late {
        return motion;
    }
    if !may_be_chaos {
        return SettledMotion::NotSettled;
    }
    if variations(machine, begin, setting, watch) == Variations::Grow {
        SettledMotion::Chaotic
    } else if is_late {
        motion
    } else {
        SettledMotion::NotSettled
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::map::{Kernel, MapGrid, Start};
    use crate::atlas::settling::settle_on;
    use crate::atlas::{BasinGrid, Starts, basins};

    /// The motion from a cell's end on, by the exact simulator alone.
    fn settled(machine: &Machine, end: &Cell, watch: &Watch) -> SettledMotion {
        let setting = Setting::new(end.eta, end.rho).at_phase(end.phase);
        let start = Initial {
            x: end.x.min(end.rho),
            vx: end.v,
            ..Initial::rest()
        };
        let mut simulator = Simulator::new(machine, setting, start).expect("a simulator");
        let motion = observe(&mut simulator, setting, watch).0;
        if motion == SettledMotion::Chaotic || is_hardly_seen(&motion, watch) {
            return settle_on(machine, &mut simulator, setting, watch).motion;
        }
        motion
    }

    /// Where cells of a map end, taken for unrecognised whatever they are.
    fn ends(unit: &UnitMass, settings: &MapSettings) -> Vec<Outcome> {
        let grid = MapGrid::even((0.7, 1.5, 17), (0.2, 5.0, 13));
        let course = unit.course(settings);
        let start = |i: usize| {
            unit.cell(&Start {
                at: grid.at(i),
                initial: settings.start,
                phase: 0.0,
            })
        };
        let cells: Vec<Cell> = (0..grid.len()).map(start).collect();
        let mut outcomes = march_all(&course, &cells, settings.kernel);
        for outcome in &mut outcomes {
            outcome.motion = SettledMotion::Chaotic;
        }
        outcomes
    }

    #[test]
    fn valid_the_kernel_s_watch_sees_what_the_exact_simulator_sees() {
        let irregular =
            |m: &SettledMotion| matches!(m, SettledMotion::Chaotic | SettledMotion::Beat);
        let cases = [(0.07, 0.9, None), (0.03, 0.6, None), (0.07, 0.0, None)];
        let scalar = (0.07, 0.9, Some(Kernel::Scalar));
        for (damping_ratio, restitution, kernel) in cases.into_iter().chain([scalar]) {
            let settings = MapSettings {
                kernel,
                ..MapSettings::default()
            };
            let machine = Machine::single(damping_ratio, restitution);
            let unit = UnitMass::of(&machine).expect("one mass");
            let mut outcomes = ends(&unit, &settings);
            let exact: Vec<SettledMotion> = outcomes
                .iter()
                .map(|o| settled(&machine, &o.end, &settings.watch))
                .collect();
            watch_again(&unit, &mut outcomes, &settings, Follow::Decision);
            let mut kinds = [0; 3];
            for (outcome, exact) in outcomes.iter().zip(&exact) {
                // a chaotic motion is another after a few impacts
                let both = irregular(&outcome.motion) && irregular(exact);
                assert!(both || outcome.motion == *exact, "{:?}", outcome.end);
                kinds[match exact {
                    SettledMotion::Periodic { .. } => 0,
                    SettledMotion::Impactless => 1,
                    _ => 2,
                }] += 1;
            }
            assert!(kinds[0] > 30 && kinds[1] > 30, "{kinds:?}");
        }
    }

    /// Weak chaos comes as near to itself once in the watch as a motion of a long period does.
    #[test]
    fn chaos_of_one_mass_is_no_period_that_is_hardly_seen() {
        let grid = BasinGrid {
            x: (-4.0, 0.1, 24),
            vx: (-4.0, 4.0, 24),
            starts: Starts::BothMasses,
        };
        let (setting, settings) = (Setting::new(2.86, 0.1), MapSettings::default());
        let machine = Machine::symmetric(0.07, 0.9);
        let found = basins(&machine, setting, &grid, &settings).expect("basins");
        let motions: Vec<SettledMotion> = found.cells.into_iter().flatten().collect();
        let chaotic = motions.iter().filter(|m| **m == SettledMotion::Chaotic);
        assert!(
            motions.len() > 500 && chaotic.count() == motions.len(),
            "{motions:?}"
        );
    }

    #[test]
    fn valid_the_first_impacts_of_a_chaotic_motion_are_those_of_the_exact_simulator() {
        let (eta, rho) = (0.8, 0.9);
        let machine = Machine::single(0.02, 0.8);
        let unit = UnitMass::of(&machine).expect("one mass");
        let start = Cell {
            eta,
            rho,
            x: 0.0,
            v: 3.0,
            phase: 0.4,
        };
        let watch = Watch::default();
        let course = Course {
            leave_early: false,
            every_impact: true,
            ..unit.course(&MapSettings::default())
        };
        let mut collected = Collected {
            cell: start,
            is_taken: false,
            returns: Vec::new(),
        };
        run(available(None), &course, &mut collected);
        let setting = Setting::new(eta, rho).at_phase(0.4);
        let initial = Initial {
            vx: 3.0,
            ..Initial::rest()
        };
        let mut simulator = Simulator::new(&machine, setting, initial).expect("a simulator");
        let (_, exact) = observe(&mut simulator, setting, &watch);
        assert!(exact.len() > 20 && collected.returns.len().abs_diff(exact.len()) < 10);
        for (found, exact) in collected.returns.iter().zip(&exact).take(12) {
            assert!((found.impact.tau - exact.tau).abs() < 1e-8);
            assert!((found.impact.vx_before - exact.vx_before).abs() < 1e-8);
            assert!((found.impact.vx_after - exact.vx_after).abs() < 1e-8);
            assert!((found.impact.phase - exact.phase).abs() < 1e-8);
        }
    }

    struct Collected {
        cell: Cell,
        is_taken: bool,
        returns: Vec<Return>,
    }

    impl Feed for Collected {
        fn next(&mut self) -> Option<(usize, Cell)> {
            (!std::mem::replace(&mut self.is_taken, true)).then_some((0, self.cell))
        }
        fn impact(&mut self, _: usize, strike: Strike) {
            self.returns.push(bounce(&self.cell, 0.8, strike));
        }
        fn done(&mut self, _: usize, _: Outcome) {}
    }
}
