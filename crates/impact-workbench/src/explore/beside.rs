//! Motions that coexist with those of a strip of the map's cells.

use super::state::State;
use impact_oscillator::atlas::carried_maps;
use impact_oscillator::atlas::coexisting::beside;
use impact_oscillator::atlas::map::{End, Start, first_map, march_from};
use impact_oscillator::{Initial, Machine, MapGrid, MapSettings, ModelError, SettledMotion, Watch};

/// X' and Y' of the lively start.
const LIVELY_SPEED: f64 = 3.0;
/// How many times as long a motion settles before a pair with it is believed.
const LONGER: f64 = 10.0;

/// The start from which motions are sought that coexist with those of the map: lively where the map is from rest.
fn other_start(state: &State) -> Initial {
    let lively = Initial::both(0.0, LIVELY_SPEED);
    if state.map_start == lively {
        Initial::rest()
    } else {
        lively
    }
}

/// Beside each cell's motion another one: what another start or sweeps in rising and falling η settle on, or a stable
/// motion in closed form; the cell's own where there is none.
pub(super) fn coexisting(
    state: &State,
    machine: &Machine,
    grid: &MapGrid,
) -> Result<Vec<SettledMotion>, ModelError> {
    let from = |start| MapSettings {
        start,
        ..state.map_settings()
    };
    let start = |initial| {
        let start = move |i: usize| Start {
            at: grid.at(i),
            initial,
            phase: 0.0,
        };
        (0..grid.len()).map(start).collect::<Vec<Start>>()
    };
    let (rest, settings) = (start(state.map_start), from(state.map_start));
    // as the tile shows them
    let own = first_map(machine, grid, &settings)?.cells;
    let other = march_from(machine, &start(other_start(state)), &settings)?;
    let [up, down] = carried_maps(machine, grid, &settings)?;
    let maps = [other, up, down];
    let labels: Vec<Vec<SettledMotion>> = maps.iter().map(|ends| motions(ends)).collect();
    let [other, up, down] = &labels[..] else {
        return Ok(own);
    };
    let mut found = beside(machine, grid, &[&own, other, up, down])?;
    let ends = |i: usize| maps.iter().map(move |ends| ends[i]);
    let doubtful: Vec<(usize, Start, Start)> = (0..grid.len())
        .filter(|i| found[*i] != own[*i] && (is_doubtful(own[*i]) || is_doubtful(found[*i])))
        .filter_map(|i| {
            let end = ends(i).find(|end| end.motion == found[i])?;
            let goes_on = Start {
                at: grid.at(i),
                initial: end.initial,
                phase: end.phase,
            };
            Some((i, rest[i], goes_on))
        })
        .collect();
    let settle_periods = LONGER * settings.watch.settle_periods;
    let longer = MapSettings {
        watch: Watch {
            settle_periods,
            ..settings.watch
        },
        ..settings
    };
    let settled = |of: fn(&(usize, Start, Start)) -> Start| {
        let starts: Vec<Start> = doubtful.iter().map(of).collect();
        march_from(machine, &starts, &longer)
    };
    let (first, second) = (settled(|d| d.1)?, settled(|d| d.2)?);
    for ((i, ..), (first, second)) in doubtful.iter().zip(first.iter().zip(&second)) {
        if first.motion == second.motion || second.motion != found[*i] {
            found[*i] = own[*i];
        }
    }
    Ok(found)
}

fn motions(ends: &[End]) -> Vec<SettledMotion> {
    ends.iter().map(|end| end.motion).collect()
}

/// Whether a motion may be another one that settles slowly: near a period doubling or in transient chaos. z = 0 and
/// z = 1/n are not.
fn is_doubtful(motion: SettledMotion) -> bool {
    !matches!(
        motion,
        SettledMotion::Impactless | SettledMotion::Periodic { p: 0..=1, .. }
    )
}
