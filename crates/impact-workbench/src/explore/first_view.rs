//! What of the plane a campaign shows first.

use super::limits::ETA;
use super::state::{State, Window};
use impact_records::signal::robust;
use impact_report::figures::plane;

/// A record's place in the plane.
pub(super) struct Place {
    pub eta: f64,
    pub rho: f64,
    /// Whether it has impacts.
    pub strikes: bool,
}

/// All records, and clearances far above all impacts in strips above the map, as in the report.
pub(super) struct FirstView {
    pub window: Window,
    /// ρ of the strips, ascending.
    pub strips: Vec<f64>,
}

/// Room about the records, over what they span.
const MARGIN: f64 = 0.08;
/// Share of the greatest ρ below which the map begins at 0.
const NEAR_ZERO: f64 = 0.25;
/// Greatest ρ that is shown first.
const HIGHEST: f64 = 20.0;

impl FirstView {
    /// Of records and of the ρ of brackets.
    pub(super) fn of(places: &[Place], brackets: Vec<f64>) -> Self {
        let all: Vec<f64> = places.iter().map(|p| p.rho).collect();
        let strike = places.iter().filter(|p| p.strikes).map(|p| p.rho);
        let strips = plane::strips(&all, robust::range(strike.chain(brackets)));
        let lowest = strips.first().copied().unwrap_or(f64::INFINITY);
        let below = all.into_iter().filter(|rho| *rho < lowest);
        let eta = padded(robust::range(places.iter().map(|p| p.eta)));
        let (Some(eta), Some(rho)) = (eta, padded(robust::range(below))) else {
            let window = State::default().view;
            return Self { window, strips };
        };
        let high = (eta.1.clamp(0.2, ETA.high), rho.1.clamp(0.2, HIGHEST));
        let low = if rho.0 < NEAR_ZERO * high.1 {
            0.0
        } else {
            rho.0.min(high.1 - 0.1)
        };
        let window = Window {
            eta: (eta.0.clamp(0.05, high.0 - 0.1), high.0),
            rho: (low, high.1),
        };
        let strips = strips.into_iter().filter(|s| *s > high.1).collect();
        Self { window, strips }
    }
}

fn padded(range: Option<(f64, f64)>) -> Option<(f64, f64)> {
    let (low, high) = range?;
    let margin = MARGIN * (high - low).max(0.2);
    Some((low - margin, high + margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clearance_far_above_all_impacts_does_not_squeeze_the_map() {
        let place = |rho: f64, strikes| Place {
            eta: 1.0 + 0.1 * rho,
            rho,
            strikes,
        };
        let near: Vec<Place> = [0.6, 2.0, 5.0].map(|rho| place(rho, true)).into();
        let far = [place(9.0, false), place(9.01, false), place(40.0, false)];
        let all: Vec<Place> = near.into_iter().chain(far).collect();
        let view = FirstView::of(&all, vec![5.0]);
        assert_eq!(view.strips, [9.0, 40.0]);
        let (low, high) = view.window.rho;
        assert!(low == 0.0 && (5.0..6.0).contains(&high), "{low} {high}");
        // without impacts there is no far
        let quiet: Vec<Place> = [0.6, 9.0].map(|rho| place(rho, false)).into();
        let view = FirstView::of(&quiet, Vec::new());
        assert!(view.strips.is_empty() && view.window.rho.1 > 9.0);
    }
}
