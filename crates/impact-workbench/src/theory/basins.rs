//! Basins of attraction, block of rows by block of rows, and their figure.

use super::context::StudyContext;
use super::plan::BasinPlan;
use crate::figures::basins::draw;
use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::table::Table;
use impact_identification::replay::RegionMap;
use impact_oscillator::atlas::basins::{Basins, basin_rows};
use impact_oscillator::atlas::map::even;
use impact_oscillator::{Machine, MapSettings, Restitution, SettledMotion};
use impact_records::motion::{Motion, Undetermined};

/// Rows of a block.
const BLOCK: usize = 8;

/// Settle every start and write table and figure.
///
/// # Errors
/// [`PipelineError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &BasinPlan,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    let machine = match plan.restitution {
        Some(r) => machine.clone().with_restitution(Restitution::Constant(r)),
        None => machine.clone(),
    };
    let basins = Basins {
        x: even(plan.grid.x),
        vx: even(plan.grid.vx),
        cells: cells(&machine, name, plan, context)?,
    };
    context.table(name, &table(&basins))?;
    (context.inform)(&shares(name, &basins));
    let title = format!("Basins of attraction at {}", setting(plan));
    context.figure(draw(&motions(&basins), name, &title).as_ref())
}

/// The motion to which each start leads.
fn motions(basins: &Basins) -> RegionMap {
    let motion = |cell: &Option<SettledMotion>| match cell {
        Some(motion) => Motion::from(*motion),
        None => Motion::Undetermined {
            reason: Undetermined::BeyondContact,
        },
    };
    let cells: Vec<Motion> = basins.cells.iter().map(motion).collect();
    RegionMap::new(basins.x.clone(), basins.vx.clone(), &cells, &[])
}

fn setting(plan: &BasinPlan) -> String {
    let s = &plan.setting;
    format!(
        "η = {}, ρ = {}, φ = {}",
        s.frequency_ratio, s.clearance, s.phase
    )
}

fn cells(
    machine: &Machine,
    name: &str,
    plan: &BasinPlan,
    context: &StudyContext<'_>,
) -> Result<Vec<Option<SettledMotion>>, PipelineError> {
    let settings = MapSettings {
        watch: plan.watch,
        ..MapSettings::default()
    };
    let rows = format!("{name} rows");
    context.in_blocks(&rows, plan.grid.rows(), BLOCK, |rows| {
        basin_rows(machine, plan.setting, &plan.grid, &settings, rows)
            .map_err(PipelineError::in_study(name))
    })
}

fn label(cell: &Option<SettledMotion>) -> String {
    cell.map_or("beyond contact".into(), SettledMotion::label)
}

fn table(b: &Basins) -> Table {
    let columns = b.x.len();
    let count = b.cells.len();
    Table::new()
        .numbers("x", (0..count).map(|i| b.x[i % columns]))
        .numbers("x_velocity", (0..count).map(|i| b.vx[i / columns]))
        .texts("motion", b.cells.iter().map(label))
}

/// Which motions hold which share of the starts that were tried.
fn shares(name: &str, basins: &Basins) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for cell in basins.cells.iter().filter(|c| c.is_some()) {
        let text = label(cell);
        match counts.iter_mut().find(|c| c.0 == text) {
            Some(count) => count.1 += 1,
            None => counts.push((text, 1)),
        }
    }
    counts.sort_by_key(|c| std::cmp::Reverse(c.1));
    let all: usize = counts.iter().map(|c| c.1).sum();
    let part = |c: &(String, usize)| {
        format!(
            "z = {}: {:.1} %",
            c.0,
            100.0 * c.1 as f64 / all.max(1) as f64
        )
    };
    let parts: Vec<String> = counts.iter().take(5).map(part).collect();
    format!("{name}: {} of {all} starts", parts.join(", "))
}
