//! Replay demos without a browser: every step's state is in range, its map and its motion can be
//! computed, and the motion is the one that the demo expects.

use super::demo::{Demo, list, shipped};
use super::motions::seen;
use super::{ExploreError, State};
use impact_oscillator::{MapGrid, region_map};

/// Columns and rows of the map that is computed of each step.
const CELLS: (usize, usize) = (16, 12);

/// Replay every demo that comes with the program; returns a line for each.
///
/// # Errors
/// [`ExploreError::Demos`] with every step that differs from what it states.
pub fn check() -> Result<Vec<String>, ExploreError> {
    let (mut lines, mut differing) = (Vec::new(), Vec::new());
    for name in list() {
        match shipped(name).and_then(|demo| check_one(&demo)) {
            Ok(line) => lines.push(line),
            Err(ExploreError::Demos(steps)) => differing.extend(steps),
            Err(error) => differing.push(format!("{name}: {error}")),
        }
    }
    if differing.is_empty() {
        Ok(lines)
    } else {
        Err(ExploreError::Demos(differing))
    }
}

/// Replay one demo.
pub(super) fn check_one(demo: &Demo) -> Result<String, ExploreError> {
    let mut differing = Vec::new();
    let mut expected = 0;
    let mut before: Option<State> = None;
    for (number, (step, state)) in demo.steps.iter().enumerate() {
        let mut state = state.clone();
        let mut from = None;
        if let Some(then) = before.as_ref().filter(|_| step.carry) {
            (state.cursor.start, state.cursor.phase) = (then.cursor.start, then.cursor.phase);
            from = Some((then.cursor.eta, then.cursor.rho));
        }
        let plan = state.map_plan(CELLS);
        region_map(
            &state.machine(),
            &MapGrid::even(plan.eta, plan.rho),
            &plan.map,
        )?;
        let found = seen(&state, from)?;
        state.cursor = found.cursor;
        let label = found.point.motion.label();
        if let Some(expect) = &step.expect {
            expected += 1;
            if *expect != label {
                let number = number + 1;
                let text = format!("{}, step {number}: z = {label}, not {expect}", demo.title);
                differing.push(text);
            }
        }
        before = Some(state);
    }
    if !differing.is_empty() {
        return Err(ExploreError::Demos(differing));
    }
    Ok(format!(
        "{}: {} steps, {expected} motions as expected",
        demo.title,
        demo.steps.len()
    ))
}
