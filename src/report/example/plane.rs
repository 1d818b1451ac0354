//! The example's plane: boundaries in closed form, and a simulated map.

use super::oscillator::{self, Parameters, State};
use super::{PERIODS, TRUTH};
use crate::motion::Motion;
use crate::report::content::{BoundaryCurve, BoundaryKind, RegionMap};

pub fn curves() -> Vec<BoundaryCurve> {
    let etas =
        |low: f64, high: f64| (0..=160).map(move |i| low + (high - low) * f64::from(i) / 160.0);
    let mut curves = vec![BoundaryCurve {
        kind: BoundaryKind::Grazing,
        periods_n: 1,
        points: etas(0.75, 3.05)
            .map(|e| [e, oscillator::grazing(&TRUTH, e)])
            .collect(),
        band95: etas(0.75, 3.05)
            .map(|e| {
                let rho = oscillator::grazing(&TRUTH, e);
                [e, rho * 0.985, rho * 1.015]
            })
            .collect(),
    }];
    for (n, low, high) in [(1, 1.02, 1.995), (2, 2.02, 3.05)] {
        let s2 = |p: &Parameters, e: f64| oscillator::boundaries(p, e, n).0;
        let more = Parameters {
            restitution: 0.915,
            ..TRUTH
        };
        let less = Parameters {
            restitution: 0.885,
            ..TRUTH
        };
        curves.push(BoundaryCurve {
            kind: BoundaryKind::S2,
            periods_n: n,
            points: etas(low, high).map(|e| [e, s2(&TRUTH, e)]).collect(),
            band95: etas(low, high)
                .map(|e| [e, s2(&less, e), s2(&more, e)])
                .collect(),
        });
    }
    curves.push(BoundaryCurve {
        kind: BoundaryKind::S1,
        periods_n: 1,
        points: etas(0.78, 0.98)
            .map(|e| [e, oscillator::boundaries(&TRUTH, e, 1).1])
            .filter(|p| p[1].is_finite() && p[1] > 0.0)
            .collect(),
        band95: Vec::new(),
    });
    curves
}

pub fn region_map((columns, rows): (usize, usize)) -> RegionMap {
    let eta: Vec<f64> = (0..columns)
        .map(|i| 0.76 + 2.24 * (i as f64 + 0.5) / columns as f64)
        .collect();
    let rho: Vec<f64> = (0..rows)
        .map(|j| 0.05 + 3.3 * (j as f64 + 0.5) / rows as f64)
        .collect();
    let kick = State {
        x: 0.0,
        v: -6.0,
        phase: 3.0,
    };
    let from = |start: State| -> Vec<Motion> {
        let cells = rho.iter().flat_map(|r| eta.iter().map(move |e| (*e, *r)));
        let motion = |at| {
            let (end, hits, _) = oscillator::march(&TRUTH, at, start, 70, 30);
            oscillator::classify(&hits, end.phase, PERIODS)
        };
        cells.map(motion).collect()
    };
    let (first, second) = (from(State::default()), from(kick));
    let note = "From rest and from the z = 1/n motions; 120 drive periods.";
    RegionMap::of_motions(eta, rho, &first, &second, note)
}
