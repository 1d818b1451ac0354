//! From a fit's covariance to estimates with intervals and a status.

use crate::identify::fit::Fit;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::{Estimate, ParameterSet, Status};

/// 97.5 % point of the normal distribution.
pub const NORMAL_975: f64 = 1.959_963_984_540_054;

/// Standard errors (of the coordinate: R absolute, the others relative) from which a parameter is
/// weak and from which it is not identifiable.
pub(super) fn limits(coordinate: Coordinate) -> (f64, f64) {
    match coordinate {
        Coordinate::Restitution => (0.03, 0.15),
        Coordinate::Frequency => (0.01, 0.08),
        Coordinate::Damping => (0.15, 0.9),
        Coordinate::Deflection => (0.05, 0.5),
        _ => (0.05, 0.5),
    }
}

/// Estimate of one coordinate from its value and standard error (both of the coordinate).
pub fn estimate(
    coordinate: Coordinate,
    value: f64,
    error: f64,
    leans_on: Option<String>,
) -> Estimate {
    let (weak, unknown) = limits(coordinate);
    if !error.is_finite() || error >= unknown {
        return not_identifiable(format!(
            "the data leave {} open by ± {:.2}{}",
            coordinate.symbol(),
            error
                * if coordinate.is_logarithm() {
                    100.0
                } else {
                    1.0
                },
            if coordinate.is_logarithm() { " %" } else { "" },
        ));
    }
    let half = NORMAL_975 * error;
    let (value, standard_error, interval) = if coordinate.is_logarithm() {
        let v = value.exp();
        (v, v * error, [v * (-half).exp(), v * half.exp()])
    } else {
        (value, error, [value - half, value + half])
    };
    let interval = match coordinate {
        Coordinate::Restitution => [interval[0].max(0.0), interval[1].min(1.0)],
        _ => interval,
    };
    let status = if error >= weak {
        Status::Weak
    } else {
        Status::Identified
    };
    Estimate {
        value: Some(value),
        standard_error: Some(standard_error),
        interval95: Some(interval),
        status,
        note: if status == Status::Weak {
            leans_on
        } else {
            None
        },
    }
}

/// An estimate that says why there is none.
pub fn not_identifiable(reason: impl Into<String>) -> Estimate {
    Estimate {
        value: None,
        standard_error: None,
        interval95: None,
        status: Status::NotIdentifiable,
        note: Some(reason.into()),
    }
}

/// Estimates of the physical parameters that a fit left free; `factor` multiplies the covariance.
pub fn parameter_set(fit: &Fit, factor: f64, tells: &[Coordinate]) -> ParameterSet {
    let of = |coordinate: Coordinate| {
        if !tells.contains(&coordinate) {
            return None;
        }
        let error = fit.error(coordinate)? * factor.sqrt();
        let value = fit.parameters.coordinate(coordinate);
        Some(estimate(coordinate, value, error, leaning(fit, coordinate)))
    };
    ParameterSet {
        restitution: of(Coordinate::Restitution),
        natural_frequency_hz: of(Coordinate::Frequency),
        damping_ratio: of(Coordinate::Damping),
        static_deflection_m: of(Coordinate::Deflection),
    }
}

/// On which other parameter an estimate leans, in words.
fn leaning(fit: &Fit, coordinate: Coordinate) -> Option<String> {
    let (other, correlation) = fit
        .free
        .iter()
        .filter(|c| **c != coordinate)
        .filter_map(|c| Some((*c, fit.correlation(coordinate, *c)?)))
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    (correlation.abs() > 0.7)
        .then(|| format!("leans on {} (correlation {correlation:.2})", other.symbol()))
}

impl ParameterSet {
    /// Estimate of a coordinate.
    pub fn get(&self, coordinate: Coordinate) -> Option<&Estimate> {
        match coordinate {
            Coordinate::Restitution => self.restitution.as_ref(),
            Coordinate::Frequency => self.natural_frequency_hz.as_ref(),
            Coordinate::Damping => self.damping_ratio.as_ref(),
            Coordinate::Deflection => self.static_deflection_m.as_ref(),
            _ => None,
        }
    }

    /// Place of the estimate of a physical coordinate.
    pub fn slot(&mut self, coordinate: Coordinate) -> Option<&mut Option<Estimate>> {
        match coordinate {
            Coordinate::Restitution => Some(&mut self.restitution),
            Coordinate::Frequency => Some(&mut self.natural_frequency_hz),
            Coordinate::Damping => Some(&mut self.damping_ratio),
            Coordinate::Deflection => Some(&mut self.static_deflection_m),
            _ => None,
        }
    }
}
