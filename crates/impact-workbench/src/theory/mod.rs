//! Studies of the theory: small TOML files that list what to simulate. Each writes tables as CSV
//! and Parquet, and a figure as SVG, PNG and PDF.

pub mod basins;
mod context;
pub mod map;
pub mod plan;
pub mod regions;
pub mod sweep;
pub mod time_series;

use impact_campaign::pipeline::PipelineError;

pub use context::{Output, Pictures, StudyContext};
pub use plan::Study;

/// Do all the work of a study.
///
/// # Errors
/// [`PipelineError`] with the first piece of work that could not be done.
pub fn run(study: &Study, context: &StudyContext<'_>) -> Result<(), PipelineError> {
    let machine = study.machine();
    machine
        .check()
        .map_err(PipelineError::in_study("machine"))?;
    for (name, plan) in &study.time_series {
        time_series::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.sweep {
        sweep::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.basins {
        basins::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.map {
        map::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.regions {
        regions::run(&machine, name, plan, context)?;
    }
    Ok(())
}
