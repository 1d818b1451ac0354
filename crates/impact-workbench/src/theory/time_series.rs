//! A motion in full: time series, impacts, Poincaré map, autocorrelation, and their figure.

use super::context::StudyContext;
use crate::figures::motion::draw;
use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::table::Table;
use impact_oscillator::atlas::portrait::{Portrait, PortraitPlan, Strike, portrait};
use impact_oscillator::model::Machine;

/// Simulate and write tables and figure.
///
/// # Errors
/// [`PipelineError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &PortraitPlan,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    (context.progress)(0, 2);
    let portrait = portrait(machine, plan).map_err(PipelineError::in_study(name))?;
    (context.progress)(1, 2);
    context.table(name, &series(&portrait))?;
    context.table(&format!("{name}-impacts"), &impacts(&portrait))?;
    context.table(&format!("{name}-poincare"), &poincare(&portrait))?;
    context.table(
        &format!("{name}-autocorrelation"),
        &autocorrelation(&portrait),
    )?;
    let s = &plan.setting;
    let title = format!("Motion at η = {}, ρ = {}", s.frequency_ratio, s.clearance);
    context.figure(Some(&draw(&portrait, name, &title)))?;
    (context.progress)(2, 2);
    Ok(())
}

fn series(p: &Portrait) -> Table {
    let of = |f: fn(&impact_oscillator::atlas::portrait::Sample) -> f64| p.samples.iter().map(f);
    let table = Table::new()
        .numbers("tau_over_period", of(|s| s.periods))
        .numbers("x", of(|s| s.x))
        .numbers("x_velocity", of(|s| s.vx));
    let table = if p.two_masses {
        table
            .numbers("y", of(|s| s.y))
            .numbers("y_velocity", of(|s| s.vy))
    } else {
        table
    };
    table.flags("joined", p.samples.iter().map(|s| s.sticking))
}

fn impacts(p: &Portrait) -> Table {
    let of = |f: fn(&Strike) -> f64| p.impacts.iter().map(f);
    let maybe = |f: fn(&Strike) -> Option<f64>| p.impacts.iter().map(f);
    Table::new()
        .numbers("tau_over_period", of(|i| i.periods))
        .numbers("phase_rad", of(|i| i.phase))
        .numbers("closing_speed_before", of(|i| i.approach_speed))
        .numbers("closing_speed_after", of(|i| -i.separation_speed))
        .missing("x_velocity_before", maybe(|i| i.vx_before))
        .missing("x_velocity_after", maybe(|i| i.vx_after))
        .missing("y_velocity_before", maybe(|i| i.vy_before))
        .missing("y_velocity_after", maybe(|i| i.vy_after))
        .numbers("together_over_period", of(|i| i.together_periods))
        .texts("kind", p.impacts.iter().map(|i| i.kind))
}

fn poincare(p: &Portrait) -> Table {
    let column = |k: usize| p.poincare.iter().map(move |s| s[k]);
    let table = Table::new()
        .counts("period", 0..p.poincare.len())
        .numbers("x", column(0))
        .numbers("x_velocity", column(1));
    if p.two_masses {
        table
            .numbers("y", column(2))
            .numbers("y_velocity", column(3))
    } else {
        table
    }
}

fn autocorrelation(p: &Portrait) -> Table {
    Table::new()
        .numbers("lag_over_period", p.autocorrelation.iter().map(|a| a.0))
        .numbers("autocorrelation", p.autocorrelation.iter().map(|a| a.1))
}
