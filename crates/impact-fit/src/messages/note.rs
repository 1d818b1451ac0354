//! Why a parameter is weak or not identifiable.

use serde::{Deserialize, Serialize};

use crate::method::Method;
use crate::parameters::Coordinate;
use crate::solver::FitError;
use impact_records::message::Value;
use impact_records::{message_table, messages};

/// Why a parameter is weak or not identifiable, or why a method has no result.
#[derive(
    Debug, Default, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Note {
    /// The data leave the parameter open.
    Open {
        /// The parameter.
        parameter: Coordinate,
        /// Standard error, of R absolute, of the others relative.
        standard_error: f64,
    },
    /// Nothing bounds the parameter.
    NotDetermined {
        /// The parameter.
        parameter: Coordinate,
    },
    /// Nothing but its interval makes it weak.
    Wide {
        /// The parameter.
        parameter: Coordinate,
        /// Half of the 95 % interval, of R absolute, of the others relative.
        half_width: f64,
        /// Half of the interval from which on the parameter is weak.
        limit: f64,
    },
    /// The estimate depends strongly on another parameter.
    LeansOn {
        /// The other parameter.
        parameter: Coordinate,
        /// Correlation of both estimates.
        correlation: f64,
    },
    /// Methods do not agree on it; the interval covers them.
    MethodsDisagree,
    /// An instrument is off, as a finding says; the interval covers what that leaves open.
    InstrumentOff,
    /// Speeds after impacts exceed those before.
    NotOfImpacts,
    /// R depends on the speed.
    NotOneNumber,
    /// It changes during the campaign.
    Changes,
    /// No record has an impact.
    WithoutImpact,
    /// No record shows its drive or states its frequency.
    NoFrequency,
    /// No record without impacts and no nominal value tells where the fits start.
    GuessedStart,
    /// A cause that the findings name bends the fits that it rests on.
    Bent,
    /// It is that of one method, which a cause that the findings name does not reach.
    ByMethodAlone {
        /// The method.
        method: Method,
    },
    /// The frequency changes over the decay.
    Drifts,
    /// The damping ratio changes over the decay.
    DampingChanges,
    /// Decays have unlike damping ratios.
    DampingsDiffer,
    /// Flights do not become shorter beyond the errors of R.
    FlightsAlike,
    /// Three times in one record leave nothing that tells their errors.
    TimesNotTold {
        /// The error that each is given, s.
        error_s: f64,
    },
    /// One impact, or two of one drop, leave nothing that tells the errors of heights.
    HeightsNotTold {
        /// The error that each is given, m.
        error_m: f64,
    },
    /// What oscillates does not decay, beside or after a motion that does.
    MayBeForced,
    /// The fits leave more of the decays than noise, so that they are not of one oscillation.
    NotOneOscillation,
    /// The record holds too few periods of motion for a test of the decay.
    FewPeriods {
        /// How many.
        periods: f64,
    },
    /// Dry friction and viscous damping are not told apart well enough.
    FrictionNotTold {
        /// Periods of the longest decay.
        periods: f64,
        /// Damping ratio that both together are worth.
        equivalent: f64,
    },
    /// Drag of the air and viscous damping are not told apart well enough.
    DragNotTold {
        /// Periods of the longest decay.
        periods: f64,
        /// Damping ratio that both together are worth.
        equivalent: f64,
    },
    /// Nothing damps the motion that stands out of the noise.
    Undamped {
        /// Damping ratio that is not exceeded, at 97.5 %.
        most: f64,
    },
    /// An oscillation that does not decay has the frequency of the mains or a multiple of it.
    MayBeHum {
        /// The mains' frequency, Hz.
        mains_hz: f64,
    },
    /// Each specimen has parameters of its own.
    SeveralSpecimens,
    /// No damping ratio gives the published motions.
    NoPublishedMotion,
    /// The model has no such motion at the starting values.
    NoStart {
        /// Number of observations without a motion in the model.
        observations: usize,
    },
    /// There is nothing to fit.
    NothingToFit,
    /// Only one of two masses is measured: the speeds of both make R.
    OneOfTwo,
    /// The speeds at impacts come from differentiated displacements.
    Differentiated,
    /// The velocities ring beside the impacts.
    Ringing,
    /// Accelerations are clipped at most impacts.
    ClippedAccelerations,
    /// The solver failed.
    SolverFailed,
    /// The data do not separate the parameters.
    #[default]
    NotSeparable,
}

impl From<&FitError> for Note {
    fn from(error: &FitError) -> Self {
        match error {
            FitError::NoModel(items) => Self::NoStart {
                observations: items.len(),
            },
            FitError::Empty => Self::NothingToFit,
            FitError::OneOfTwo => Self::OneOfTwo,
            FitError::Differentiated => Self::Differentiated,
            FitError::Ringing => Self::Ringing,
            FitError::Clipped => Self::ClippedAccelerations,
            FitError::Solver => Self::SolverFailed,
            FitError::Singular => Self::NotSeparable,
        }
    }
}

messages!(Note);

message_table! { "note": Note;
    Self::Open { parameter, standard_error } =>
        parameter = Value::Message(parameter),
        width = width(*parameter, *standard_error);
    Self::Wide { parameter, half_width, limit } =>
        width = width(*parameter, *half_width),
        limit = width(*parameter, *limit);
    Self::NotDetermined { parameter } => parameter = Value::Message(parameter);
    Self::LeansOn { parameter, correlation } =>
        parameter = Value::Message(parameter),
        correlation = Value::Number(*correlation, 2);
    Self::ByMethodAlone { method } => method = Value::Message(method);
    Self::HeightsNotTold { error_m } => error = Value::Number(1e3 * *error_m, 0);
    Self::TimesNotTold { error_s } => error = Value::Number(1e3 * *error_s, 1);
    Self::FewPeriods { periods } => periods = Value::Number(*periods, 1);
    Self::FrictionNotTold { periods, equivalent } =>
        periods = Value::Number(*periods, 1),
        equivalent = Value::Number(*equivalent, digits(*equivalent) + 1);
    Self::DragNotTold { periods, equivalent } =>
        periods = Value::Number(*periods, 1),
        equivalent = Value::Number(*equivalent, digits(*equivalent) + 1);
    Self::Undamped { most } => most = Value::Number(*most, digits(*most));
    Self::MayBeHum { mains_hz } => mains = Value::Number(*mains_hz, 0);
    Self::NoStart { observations } => count = Value::Count(*observations);
}

/// Decimals that show two digits of a small number.
fn digits(value: f64) -> usize {
    let shows = |n: &usize| format!("{value:.n$}").trim_start_matches(['0', '.']).len() > 1;
    (2..10).find(shows).unwrap_or(9)
}

/// An error of a parameter: relative or, of R, absolute.
fn width(parameter: Coordinate, error: f64) -> Value<'static> {
    if parameter.is_logarithm() {
        Value::Percent(error, 2)
    } else {
        Value::Number(error, 2)
    }
}
