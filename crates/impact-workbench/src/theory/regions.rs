//! Regions of all motions: brute-force maps, boundaries as curves, their agreement, and the
//! figure.

use serde_json::json;

use super::context::StudyContext;
use super::plan::RegionsPlan;
use crate::figures::regions::draw;
use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::table::Table;
use impact_identification::replay::RegionMap;
use impact_oscillator::atlas::curves::{Curve, PointOfCurve};
use impact_oscillator::atlas::regions::{assemble, columns};
use impact_oscillator::atlas::shard::AtlasRequest;
use impact_oscillator::atlas::{Atlas, Cause, MapGrid, Maps, Slice, brute_maps};
use impact_oscillator::{Machine, SettledMotion, periodic_label};
use impact_records::motion::Motion;

/// Columns of a block.
const BLOCK: usize = 16;
/// Differing cells printed one by one.
const PRINTED: usize = 20;

/// Compute the regions and write tables and figure.
///
/// # Errors
/// [`PipelineError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &RegionsPlan,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    let request = AtlasRequest::new(machine.clone(), plan.settings());
    let maps: Maps = context.blocks.block(&format!("{name} maps"), || {
        brute_maps(machine, &request.settings.grid, &request.settings.map)
            .map_err(PipelineError::in_study(name))
    })?;
    write_atlas(&request, &maps, name, context)
}

/// From the maps on: follow every motion, compare, and write tables and figure.
///
/// # Errors
/// [`PipelineError`] where an output cannot be written.
pub fn write_atlas(
    request: &AtlasRequest,
    maps: &Maps,
    name: &str,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    let slices = all_columns(request, maps, name, context)?;
    let (machine, settings) = (&request.machine, &request.settings);
    let atlas = assemble(machine, settings, maps, slices);
    report_agreement(&atlas, context);
    context.table(&format!("{name}-curves"), &curves(&atlas.curves))?;
    context.table(&format!("{name}-map"), &map(&settings.grid, &atlas.maps))?;
    let summary = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "machine": machine,
        "settings": settings,
        "agreement": atlas.agreement,
    });
    context.bytes(&format!("{name}.json"), format!("{summary:#}\n").as_bytes())?;
    let second = atlas.other_motions(&settings.grid);
    let motions = |cells: &[SettledMotion]| -> Vec<Motion> {
        cells.iter().map(|cell| Motion::from(*cell)).collect()
    };
    let grid = settings.grid.clone();
    let map = RegionMap::new(
        grid.eta,
        grid.rho,
        &motions(&atlas.maps[0]),
        &motions(&second),
    );
    let title = "Regions of existence and stability of all motions";
    context.figure(draw((&map, &atlas.curves), name, title).as_ref())
}

fn all_columns(
    request: &AtlasRequest,
    maps: &Maps,
    name: &str,
    context: &StudyContext<'_>,
) -> Result<Vec<Vec<Slice>>, PipelineError> {
    let count = request.settings.grid.eta.len();
    context.in_blocks(&format!("{name} columns"), count, BLOCK, |chosen| {
        Ok(columns(&request.machine, &request.settings, maps, chosen))
    })
}

/// How curves and maps agree, as every run prints it.
fn report_agreement(atlas: &Atlas, context: &StudyContext<'_>) {
    let a = &atlas.agreement;
    (context.inform)(&format!(
        "{} curves; brute force: {} cells compared, {} differ from the curves, {} aperiodic, {} \
         beyond the largest p or n",
        atlas.curves.len(),
        a.compared,
        a.differing.len(),
        a.aperiodic,
        a.beyond
    ));
    if atlas.resting.is_empty() {
        (context.inform)("no motion rests in a dead zone here");
    }
    for d in a.differing.iter().take(PRINTED) {
        let (z, way) = (d.motion, d.seeding.name());
        (context.inform)(&format!(
            "  η = {:.4}  ρ = {:.4}  {way}  z = {z}: {}",
            d.eta,
            d.rho,
            why(d.cause)
        ));
    }
    if a.differing.len() > PRINTED {
        (context.inform)("  … all of them in the JSON file");
    }
}

/// A cause in words.
fn why(cause: Cause) -> String {
    match cause {
        Cause::NoRegion => "stable there, the curves miss it".into(),
        Cause::Converges { p, n } => {
            format!("still converging to z = {}", periodic_label(p, n, false))
        }
        Cause::Unstable { multiplier } => {
            format!("a transient near an unstable orbit, multiplier {multiplier:.4}")
        }
        Cause::NoOrbit => "a transient, no orbit there".into(),
    }
}

fn curves(curves: &[Curve]) -> Table {
    let rows: Vec<(usize, &Curve, &PointOfCurve)> = curves
        .iter()
        .enumerate()
        .flat_map(|(i, c)| c.points.iter().map(move |p| (i, c, p)))
        .collect();
    let motion = |c: &Curve| match c.p {
        0 => "0".into(),
        p => periodic_label(p, c.n, c.dead_zone),
    };
    let side = |c: &Curve| if c.upper { "upper" } else { "lower" };
    Table::new()
        .counts("curve", rows.iter().map(|r| r.0))
        .texts("kind", rows.iter().map(|r| r.1.kind.name()))
        .texts("motion", rows.iter().map(|r| motion(r.1)))
        .texts("side", rows.iter().map(|r| side(r.1)))
        .numbers("eta", rows.iter().map(|r| r.2.eta))
        .numbers("rho", rows.iter().map(|r| r.2.rho))
        .numbers("closing_speed", rows.iter().map(|r| r.2.approach_speed))
}

fn map(grid: &MapGrid, maps: &[Vec<SettledMotion>; 3]) -> Table {
    let labels = |k: usize| maps[k].iter().map(|m| m.label());
    Table::new()
        .numbers("eta", (0..grid.len()).map(|i| grid.at(i).0))
        .numbers("rho", (0..grid.len()).map(|i| grid.at(i).1))
        .texts("from_start", labels(0))
        .texts("rising", labels(1))
        .texts("falling", labels(2))
}
