//! Estimates with intervals and a status, from a fit's covariance.

use serde::{Deserialize, Serialize};

use crate::messages::Note;
use crate::method_fit::MethodFit;
use crate::parameters::Coordinate;
use crate::solver::Fit;
use crate::statistics::quantile::NORMAL_975;
use crate::statistics::scatter::Spread;

/// How well the data determine a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Status {
    /// Well.
    Identified,
    /// Poorly; the note states what the estimate depends on.
    Weak,
    /// Not at all: there is no value.
    NotIdentifiable,
}

impl Status {
    /// Its name in the results.
    pub fn name(self) -> &'static str {
        self.into()
    }
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
    /// Static deflection `x_st` = F0/k, m.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub static_deflection_m: Option<Estimate>,
}

/// Half widths of a 95 % interval (of the coordinate: R absolute, the others relative) from which a
/// parameter is weak and from which it is not identifiable. Weak is what is not known within 5 %, and f0,
/// on which all settings depend by η, within 2 %.
pub fn limits(coordinate: Coordinate) -> (f64, f64) {
    match coordinate {
        Coordinate::Restitution => (0.05, 0.3),
        Coordinate::Frequency => (0.02, 0.16),
        Coordinate::Damping => (0.05, 1.8),
        _ => (0.05, 1.0),
    }
}

/// Estimate of one coordinate from its value and standard error (both of the coordinate).
pub fn estimate(coordinate: Coordinate, value: f64, error: f64) -> Estimate {
    estimate_within(coordinate, value, Spread::known(error), None)
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
    let half = spread.half95();
    if !half.is_finite() || half >= unknown {
        let parameter = coordinate;
        return not_identifiable(if half.is_finite() {
            Note::Open {
                parameter,
                standard_error: error,
            }
        } else {
            Note::NotDetermined { parameter }
        });
    }
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
    let status = if half >= weak {
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
    in_doubt(coordinate, estimate, by, Note::MethodsDisagree)
}

/// An estimate that something leaves further open, so that it is weak: by a standard uncertainty, of R
/// absolute, of the others relative.
pub fn in_doubt(coordinate: Coordinate, estimate: &Estimate, by: f64, why: Note) -> Estimate {
    let wider = wider(coordinate, estimate, by);
    match wider.status {
        Status::NotIdentifiable => wider,
        _ => Estimate {
            status: Status::Weak,
            note: Some(why),
            ..wider
        },
    }
}

/// An estimate with a further standard uncertainty, of R absolute, of the others relative.
pub fn wider(coordinate: Coordinate, estimate: &Estimate, by: f64) -> Estimate {
    let (Some(value), Some(error), Some([low, high])) =
        (estimate.value, estimate.standard_error, estimate.interval95)
    else {
        return estimate.clone();
    };
    let logarithm = coordinate.is_logarithm();
    let unit = coordinate.slope(value);
    let half = (0.5 * (high - low) / unit).hypot(NORMAL_975 * by);
    let interval = if logarithm {
        [value * (-half).exp(), value * half.exp()]
    } else {
        [(value - half).max(0.0), (value + half).min(1.0)]
    };
    let error = error.hypot(by * unit);
    let mut wider = Estimate {
        value: Some(value),
        standard_error: Some(error),
        interval95: Some(interval),
        ..estimate.clone()
    };
    let standard_error = error / unit;
    if standard_error >= limits(coordinate).0 {
        wider.doubt(Note::Open {
            parameter: coordinate,
            standard_error,
        });
    }
    wider
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
    let natural_frequency_hz = of(Coordinate::Frequency);
    let open = |f0: &Estimate| f0.status == Status::NotIdentifiable;
    let static_deflection_m = match natural_frequency_hz.as_ref().is_some_and(open) {
        // amplitudes tell both only together
        true => of(Coordinate::Deflection).map(|_| {
            not_identifiable(Note::NotDetermined {
                parameter: Coordinate::Deflection,
            })
        }),
        false => of(Coordinate::Deflection),
    };
    ParameterSet {
        restitution: of(Coordinate::Restitution),
        natural_frequency_hz,
        damping_ratio: of(Coordinate::Damping),
        static_deflection_m,
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

impl Estimate {
    /// Mark it as weak for a reason.
    pub fn weaken(&mut self, why: Note) {
        self.status = Status::Weak;
        self.note = Some(why);
    }

    /// Mark it as weak for a reason where it is identified; what is weak already keeps its own.
    pub fn doubt(&mut self, why: Note) {
        if self.status == Status::Identified {
            self.weaken(why);
        }
    }

    /// Mark it as no one number, with an interval that holds all of its values (of R).
    pub fn is_not_one_number(&mut self, values: &[f64]) {
        self.weaken(Note::NotOneNumber);
        if let Some([low, high]) = &mut self.interval95 {
            *low = values.iter().copied().fold(*low, f64::min).max(0.0);
            *high = values.iter().copied().fold(*high, f64::max).min(1.0);
        }
    }
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

    /// Replace the estimate of a physical coordinate, if there is one.
    pub fn change(&mut self, coordinate: Coordinate, of: impl FnOnce(&Estimate) -> Estimate) {
        if let Some(Some(estimate)) = self.slot(coordinate) {
            *estimate = of(estimate);
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

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::parameters::Parameters;
    use crate::solver::FitReport;

    #[test]
    fn valid_an_interval_is_1_96_errors_to_either_side_of_the_coordinate() {
        let r = estimate(Coordinate::Restitution, 0.8, 0.01);
        assert_eq!(r.status, Status::Identified);
        let [low, high] = r.interval95.expect("an interval");
        assert!((low - 0.780_400_36).abs() < 1e-8 && (high - 0.819_599_64).abs() < 1e-8);
        // of a logarithm: 12 Hz ± 0.5 %, [12·e^−0.0098, 12·e^0.0098]
        let f = estimate(Coordinate::Frequency, 12f64.ln(), 0.005);
        assert!((f.standard_error.expect("an error") - 0.06).abs() < 1e-12);
        let [low, high] = f.interval95.expect("an interval");
        assert!((low - 11.882_976).abs() < 1e-6 && (high - 12.118_176).abs() < 1e-6);
    }

    #[test]
    fn r_stays_between_0_and_1() {
        let near_one = estimate(Coordinate::Restitution, 0.99, 0.02);
        assert_eq!(near_one.interval95.map(|i| i[1]), Some(1.0));
    }

    #[test]
    fn an_error_above_its_limit_leaves_no_value_and_a_note() {
        let note = Some(Note::NotSeparable);
        let error = Spread::known(0.2);
        let weak = estimate_within(Coordinate::Damping, 0.05f64.ln(), error, note);
        assert_eq!(
            (weak.status, weak.note),
            (Status::Weak, Some(Note::NotSeparable))
        );
        let parameter = Coordinate::Damping;
        let open = estimate(parameter, 0.05f64.ln(), 0.95);
        let note = Note::Open {
            parameter,
            standard_error: 0.95,
        };
        assert_eq!((open.value, open.note), (None, Some(note)));
        let unbounded = estimate(parameter, 0.0, f64::INFINITY);
        assert_eq!(unbounded.note, Some(Note::NotDetermined { parameter }));
    }

    #[test]
    fn a_weak_estimate_names_the_parameter_that_it_is_most_correlated_with() {
        let free = vec![
            Coordinate::Restitution,
            Coordinate::Damping,
            Coordinate::Deflection,
        ];
        let covariance =
            DMatrix::from_row_slice(3, 3, &[1.0, -0.9, 0.2, -0.9, 1.0, 0.1, 0.2, 0.1, 1.0]);
        let fit = Fit {
            parameters: Parameters::symmetric(0.8, 12.0, 0.05, 1e-3),
            free,
            covariance,
            cost: 0.0,
            residuals: 0,
            report: FitReport::default(),
        };
        let note = leaning(&fit, Coordinate::Restitution);
        let Some(Note::LeansOn {
            parameter,
            correlation,
        }) = note
        else {
            panic!("{note:?}");
        };
        assert_eq!(parameter, Coordinate::Damping);
        assert!((correlation + 0.9).abs() < 1e-12);
        assert_eq!(leaning(&fit, Coordinate::Deflection), None);
    }
}
