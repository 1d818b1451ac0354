//! The paper's published numbers, computed on the user's machine.

use std::f64::consts::PI;

use impact_oscillator::model::boundary::{eta_s2, rho_grazing, rho_s1};
use impact_oscillator::model::orbit::stable_orbit;
use impact_oscillator::model::params::{Initial, Machine, ModelError, Setting};
use impact_oscillator::model::simulate::simulate;

/// One published number and the computed one.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Check {
    /// The figure and the quantity.
    pub what: String,
    /// As published, or as an independent simulation gave it.
    pub published: f64,
    /// As computed here.
    pub computed: f64,
    /// Greatest difference allowed by the printed digits and the paper's steps.
    pub tolerance: f64,
}

impl Check {
    fn new(what: impl Into<String>, published: f64, computed: f64, tolerance: f64) -> Self {
        Self {
            what: what.into(),
            published,
            computed,
            tolerance,
        }
    }

    /// Whether the two agree.
    pub fn agrees(&self) -> bool {
        (self.published - self.computed).abs() <= self.tolerance
    }
}

/// All checks, in the order of the paper's figures.
///
/// # Errors
/// [`ModelError`] if the simulation refuses a setting of the paper.
pub fn checks() -> Result<Vec<Check>, ModelError> {
    let mut all = figure_2()?;
    all.extend(figure_4());
    all.extend(figure_5()?);
    Ok(all)
}

/// Fig. 2: plastic impacts with dead zones, η = 0.95, β = 0.1, ρ = 0.7, R = 0, φ = π/4.
fn figure_2() -> Result<Vec<Check>, ModelError> {
    let setting = Setting::new(0.95, 0.7).at_phase(PI / 4.0);
    let start = Initial {
        x: -1.0,
        vx: 1.5,
        y: -3.0,
        vy: 2.5,
    };
    let period = setting.period();
    let found = simulate(&Machine::symmetric(0.1, 0.0), setting, start, 3.0 * period)?;
    let expected = [
        (0.1589, 4.9422),
        (0.8846, 4.6027),
        (1.8677, 4.4129),
        (2.8677, 4.4129),
    ];
    let mut all = vec![Check::new(
        "Fig. 2: impacts in 3 periods",
        4.0,
        found.impacts.len() as f64,
        0.0,
    )];
    for (i, ((time, speed), impact)) in expected.iter().zip(&found.impacts).enumerate() {
        let n = i + 1;
        all.push(Check::new(
            format!("Fig. 2: time of impact {n}, τ/T"),
            *time,
            impact.tau / period,
            6e-5,
        ));
        all.push(Check::new(
            format!("Fig. 2: approach speed of impact {n}"),
            *speed,
            impact.approach_speed,
            6e-5,
        ));
    }
    Ok(all)
}

/// Fig. 4: what the motion becomes along ρ = 3, R = 0, β = 0.002.
fn figure_4() -> Vec<Check> {
    let machine = Machine::symmetric(0.002, 0.0);
    let grazing = |eta: f64| rho_grazing(&machine, eta) - 3.0;
    let doubling = |eta: f64| rho_s1(&machine, eta, 1).map_or(f64::NAN, |p| p.rho - 3.0);
    let end = eta_s2(&machine, 3.0, 1).map_or(f64::NAN, |p| p.eta);
    vec![
        Check::new(
            "Fig. 4: grazing G1, η",
            0.8165,
            root(grazing, 0.5, 0.95),
            1e-4,
        ),
        Check::new(
            "Fig. 4: period doubling s1, η",
            0.889,
            root(doubling, 0.87, 0.92),
            6e-4,
        ),
        Check::new(
            "Fig. 4: grazing G2, η",
            1.1546,
            root(grazing, 1.05, 1.5),
            2e-4,
        ),
        Check::new("Fig. 4: saddle-node s2, η", 1.2728, end, 3e-4),
    ]
}

/// Root of a function that changes its sign between two points.
fn root(function: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let falls = function(low) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (function(middle) > 0.0) == falls {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Fig. 5: greatest approach speed of z = 1 at ρ = 3; β = 0.005, which follows from the speeds.
fn figure_5() -> Result<Vec<Check>, ModelError> {
    let mut all = Vec::new();
    for (restitution, published) in [(0.0, 9.26), (0.3, 9.53), (0.6, 11.9), (0.9, 28.16)] {
        let machine = Machine::symmetric(0.005, restitution);
        let mut greatest = 0.0_f64;
        for step in 0..1000 {
            let setting = Setting::new(1.0 + f64::from(step) * 1e-3, 3.0);
            let orbit = stable_orbit(&machine, setting, 1)?;
            greatest = orbit.map_or(greatest, |o| greatest.max(o.approach_speed));
        }
        all.push(Check::new(
            format!("Fig. 5: greatest approach speed, R = {restitution}"),
            published,
            greatest,
            2e-3 * published,
        ));
    }
    let orbit = stable_orbit(&Machine::symmetric(0.005, 0.9), Setting::new(1.5, 3.0), 1)?;
    let speed = orbit.map_or(f64::NAN, |o| o.approach_speed);
    all.push(Check::new(
        "Fig. 5: approach speed at η = 1.5, R = 0.9",
        13.65,
        speed,
        0.01,
    ));
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_the_paper_s_numbers_are_met() {
        let all = checks().unwrap();
        assert_eq!(all.len(), 18);
        for check in all {
            assert!(check.agrees(), "{check:?}");
        }
    }
}
