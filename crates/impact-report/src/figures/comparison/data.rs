//! A comparison's name and its data as CSV.

use crate::kit::csv::Csv;
use impact_identification::replay::{ReplayedRecord, Signal, Trace};

/// Name of a comparison's figure.
pub(crate) fn name(comparison: &ReplayedRecord) -> String {
    format!("comparison_{}", comparison.letter)
}

/// All traces as CSV: a row a time, a column a trace with its SI unit. Traces on other times than
/// the first have rows of their own below.
pub(super) fn csv(comparison: &ReplayedRecord) -> String {
    let traces: Vec<(String, &Signal)> = comparison.traces.iter().flat_map(columns).collect();
    let mut heads = vec!["time_s"];
    heads.extend(traces.iter().map(|(head, _)| head.as_str()));
    let mut csv = Csv::new(&heads);
    let mut axes: Vec<&[f64]> = Vec::new();
    for (_, signal) in &traces {
        if !axes.contains(&signal.time_s.as_slice()) {
            axes.push(&signal.time_s);
        }
    }
    for times in axes {
        let on_it: Vec<bool> = traces.iter().map(|(_, s)| s.time_s == times).collect();
        for (i, time) in times.iter().enumerate() {
            let values = traces.iter().zip(&on_it).map(|((_, signal), on_it)| {
                let value = signal.values.get(i).copied();
                value.filter(|_| *on_it)
            });
            let row: Vec<Option<f64>> = std::iter::once(Some(*time)).chain(values).collect();
            csv.row().numbers(&row);
        }
    }
    csv.finish()
}

/// The columns of a trace: heads and signals.
fn columns(trace: &Trace) -> Vec<(String, &Signal)> {
    let unit = match trace.dimension.si_symbol() {
        "" => String::new(),
        unit => format!(" ({unit})"),
    };
    let role = trace.role.name();
    let sources = [
        ("measured", Some(&trace.measured)),
        ("simulated", trace.simulated.as_ref()),
        ("residual", trace.residual.as_ref()),
    ];
    sources
        .into_iter()
        .filter_map(|(source, signal)| Some((format!("{role} {source}{unit}"), signal?)))
        .collect()
}
