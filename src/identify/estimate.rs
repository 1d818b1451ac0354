//! Estimates with intervals and a status, from a fit's covariance.

use serde::{Deserialize, Serialize};

use crate::identify::fit::Fit;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::messages::Note;
use crate::identify::methods::MethodFit;
use crate::identify::uncertainty::scatter::Spread;

/// How well the data determine a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Well.
    Identified,
    /// Poorly; the note states what the estimate depends on.
    Weak,
    /// Not at all: there is no value.
    NotIdentifiable,
}

/// An estimate of one parameter with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Best value in SI; `None` where not identifiable.
    pub value: Option<f64>,
    /// Standard error in the same unit.
    pub standard_error: Option<f64>,
    /// 95 % interval, low and high.
    pub interval95: Option<[f64; 2]>,
    /// How well the data determine it.
    pub status: Status,
    /// Why weak or not identifiable.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub note: Option<Note>,
}

/// The parameters of the oscillator, as far as a method determines them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterSet {
    /// Coefficient of restitution R.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub restitution: Option<Estimate>,
    /// Natural frequency f0, Hz.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub natural_frequency_hz: Option<Estimate>,
    /// Damping ratio β = b/(2√(km)).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub damping_ratio: Option<Estimate>,
    /// Static deflection x_st = F0/k, m.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub static_deflection_m: Option<Estimate>,
}

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

/// Estimate of one coordinate from its value and standard error (both of the coordinate); a weak one
/// carries the note.
pub fn estimate(coordinate: Coordinate, value: f64, error: f64, note: Option<Note>) -> Estimate {
    estimate_within(coordinate, value, Spread::known(error), note)
}

/// Estimate of one coordinate from its value and how far it may be off.
pub fn estimate_within(
    coordinate: Coordinate,
    value: f64,
    spread: Spread,
    note: Option<Note>,
) -> Estimate {
    let error = spread.error;
    let (weak, unknown) = limits(coordinate);
    if !error.is_finite() || error >= unknown {
        return not_identifiable(Note::Open {
            parameter: coordinate,
            standard_error: error.is_finite().then_some(error),
        });
    }
    let half = spread.half95();
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
        note: note.filter(|_| status == Status::Weak),
    }
}

/// An estimate that a disagreement of methods leaves further open: by a standard uncertainty, of R
/// absolute, of the others relative.
pub fn widened(coordinate: Coordinate, estimate: &Estimate, by: f64) -> Estimate {
    let (Some(value), Some(error), Some([low, high])) =
        (estimate.value, estimate.standard_error, estimate.interval95)
    else {
        return estimate.clone();
    };
    let logarithm = coordinate.is_logarithm();
    let unit = if logarithm { value } else { 1.0 };
    let half = (0.5 * (high - low) / unit).hypot(NORMAL_975 * by);
    let interval = match logarithm {
        true => [value * (-half).exp(), value * half.exp()],
        false => [(value - half).max(0.0), (value + half).min(1.0)],
    };
    Estimate {
        value: Some(value),
        standard_error: Some(error.hypot(by * unit)),
        interval95: Some(interval),
        status: Status::Weak,
        note: Some(Note::MethodsDisagree),
    }
}

/// A missing estimate with the reason.
pub fn not_identifiable(why: Note) -> Estimate {
    Estimate {
        value: None,
        standard_error: None,
        interval95: None,
        status: Status::NotIdentifiable,
        note: Some(why),
    }
}

/// Estimates of the physical parameters that a fit left free.
pub fn parameter_set(found: &MethodFit, tells: &[Coordinate]) -> ParameterSet {
    let fit = &found.fit;
    let of = |coordinate: Coordinate| {
        if !tells.contains(&coordinate) {
            return None;
        }
        let spread = found.spread(coordinate)?;
        let value = fit.parameters.coordinate(coordinate);
        let note = leaning(fit, coordinate);
        Some(estimate_within(coordinate, value, spread, note))
    };
    ParameterSet {
        restitution: of(Coordinate::Restitution),
        natural_frequency_hz: of(Coordinate::Frequency),
        damping_ratio: of(Coordinate::Damping),
        static_deflection_m: of(Coordinate::Deflection),
    }
}

/// The other parameter with which an estimate is strongly correlated.
fn leaning(fit: &Fit, coordinate: Coordinate) -> Option<Note> {
    let (parameter, correlation) = fit
        .free
        .iter()
        .filter(|c| **c != coordinate)
        .filter_map(|c| Some((*c, fit.correlation(coordinate, *c)?)))
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    (correlation.abs() > 0.7).then_some(Note::LeansOn {
        parameter,
        correlation,
    })
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
