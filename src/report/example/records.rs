//! The example's records, swept up and down, and the brackets between them.

use super::oscillator::{self, State};
use super::{Extent, F0, Noise, PERIODS, TRUTH, X_ST};
use crate::motion::Motion;
use crate::record::Sweep;
use crate::report::content::{BoundaryKind, BracketRow, RecordRow};

pub fn records(extent: Extent) -> Vec<RecordRow> {
    let mut rows = Vec::new();
    for g in 0..extent.clearances {
        let rho = 0.35 + 0.32 * g as f64 + if extent.clearances == 1 { 0.9 } else { 0.0 };
        let mut state = State::default();
        let up = (0..extent.frequencies).map(|i| (i, Sweep::Up));
        let down = (0..extent.frequencies).rev().map(|i| (i, Sweep::Down));
        for (i, sweep) in up.chain(down) {
            let eta = 0.82 + 2.1 * i as f64 / (extent.frequencies - 1) as f64;
            state.phase = state.phase.rem_euclid(std::f64::consts::TAU);
            let (end, hits, _) = oscillator::march(&TRUTH, (eta, rho), state, 2 * PERIODS, 40);
            state = end;
            rows.push(row(
                rows.len(),
                (eta, rho),
                sweep,
                oscillator::classify(&hits, end.phase, PERIODS),
            ));
        }
    }
    rows
}

fn row(index: usize, (eta, rho): (f64, f64), sweep: Sweep, motion: Motion) -> RecordRow {
    let mut noise = Noise::new(index as u64 + 1);
    let motion = if index % 97 == 41 {
        Motion::Undetermined {
            reason: "the record ends before the motion settled".into(),
        }
    } else {
        motion
    };
    let (impacts_p, periods_n) = match &motion {
        Motion::Impactless => (Some(0), Some(1)),
        Motion::Periodic {
            impacts_p,
            periods_n,
            ..
        } => (Some(*impacts_p), Some(*periods_n)),
        _ => (None, None),
    };
    let undetermined = matches!(motion, Motion::Undetermined { .. });
    RecordRow {
        id: format!("r{:04}", index + 1),
        specimen: None,
        frequency_hz: Some(eta * F0 + 2e-4 * noise.gauss()),
        eta: Some(eta),
        clearance_m: Some(rho * X_ST),
        rho: Some(rho),
        sweep,
        impacts: if motion == Motion::Impactless { 0 } else { 13 },
        motion,
        impacts_p,
        periods_n,
        confidence: Some(if undetermined {
            0.31
        } else {
            0.93 + 0.06 * noise.next()
        }),
        flags: if index % 61 == 7 {
            vec!["dropped samples".into()]
        } else {
            vec![]
        },
        used_by: if undetermined {
            vec![]
        } else {
            vec!["trajectories".into()]
        },
        left_out: undetermined.then(|| "motion not settled".into()),
    }
}

pub fn brackets(records: &[RecordRow]) -> Vec<BracketRow> {
    let impactless = |r: &RecordRow| r.motion == Motion::Impactless;
    let mut found = Vec::new();
    for pair in records.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let told = |r: &RecordRow| !matches!(r.motion, Motion::Undetermined { .. });
        if a.rho != b.rho
            || a.sweep != b.sweep
            || impactless(a) == impactless(b)
            || !told(a)
            || !told(b)
        {
            continue;
        }
        let (low, high) = if a.eta < b.eta { (a, b) } else { (b, a) };
        let kind = if b.sweep == Sweep::Up && impactless(b) {
            BoundaryKind::S2
        } else if impactless(a) {
            BoundaryKind::Grazing
        } else {
            BoundaryKind::Edge
        };
        let n = if low.eta.unwrap_or(0.0) > 2.05 { 2 } else { 1 };
        found.push(BracketRow {
            kind,
            motion: Motion::periodic(1, n),
            clearance_m: a.clearance_m.unwrap_or(0.0),
            rho: a.rho,
            frequency_low_hz: low.frequency_hz.unwrap_or(0.0),
            frequency_high_hz: high.frequency_hz.unwrap_or(0.0),
            eta_low: low.eta,
            eta_high: high.eta,
            direction: a.sweep,
            simulated_hz: Some(
                0.5 * (low.frequency_hz.unwrap_or(0.0) + high.frequency_hz.unwrap_or(0.0)),
            ),
            records: Some([low.id.clone(), high.id.clone()]),
            left_out: (found.len() % 9 == 4).then(|| "jumped early".into()),
        });
    }
    found
}
