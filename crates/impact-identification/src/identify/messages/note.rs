//! Why a parameter is weak or not identifiable.

use serde::{Deserialize, Serialize};

use crate::identify::method::Method;
use crate::identify::parameters::Coordinate;
use crate::identify::solver::FitError;
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
    /// The record ends after too few periods for a test of the decay.
    FewPeriods {
        /// How many.
        periods: f64,
    },
    /// Nothing damps the motion that stands out of the noise.
    Undamped {
        /// Damping ratio that is not exceeded, at 97.5 %.
        most: f64,
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
            FitError::Solver => Self::SolverFailed,
            FitError::Singular => Self::NotSeparable,
        }
    }
}

messages!(Note);

message_table! { Note;
    Self::Open { parameter, standard_error } =>
        "the data leave {parameter} open by ± {width}",
        "die Daten lassen {parameter} um ± {width} offen",
        parameter = Value::Message(parameter), width = width(*parameter, *standard_error);
    Self::NotDetermined { parameter } =>
        "the data do not determine {parameter}",
        "die Daten bestimmen {parameter} nicht",
        parameter = Value::Message(parameter);
    Self::LeansOn { parameter, correlation } =>
        "depends on {parameter} (correlation {correlation})",
        "hängt von {parameter} ab (Korrelation {correlation})",
        parameter = Value::Message(parameter), correlation = Value::Number(*correlation, 2);
    Self::MethodsDisagree =>
        "the methods do not agree on it: the interval is widened by their disagreement",
        "die Verfahren stimmen darin nicht überein: das Intervall ist um ihren Unterschied \
         verbreitert";
    Self::InstrumentOff =>
        "an instrument is off, see the finding: the interval is widened by what that leaves open",
        "ein Messgerät zeigt falsch, siehe den Befund: das Intervall ist um das verbreitert, was \
         das offen lässt";
    Self::NotOfImpacts =>
        "the speeds after impacts exceed those before: see the remark",
        "die Geschwindigkeiten nach Stößen übersteigen die davor: siehe die Anmerkung";
    Self::NotOneNumber =>
        "$R$ is not one number here: see the remark on its change",
        "$R$ ist hier nicht eine Zahl: siehe die Anmerkung zu seiner Änderung";
    Self::Changes =>
        "is another before and after the change that the findings name; the interval holds both",
        "ist vor und nach der Änderung, die die Befunde nennen, ein anderer Wert; das Intervall \
         enthält beide";
    Self::WithoutImpact =>
        "no record has an impact, and only impacts tell it: record motions at clearances that the \
         masses reach",
        "keine Aufzeichnung hat einen Stoß, und nur Stöße sagen etwas darüber: Bewegungen bei \
         Spielen aufzeichnen, die die Massen erreichen";
    Self::NoFrequency =>
        "no record shows its drive or states its frequency: record the generator or its current \
         and name that channel in [channels.drive], or state drive_frequency",
        "keine Aufzeichnung zeigt ihre Erregung oder gibt deren Frequenz an: den Generator oder \
         seinen Strom aufzeichnen und den Kanal in [channels.drive] nennen, oder drive_frequency \
         angeben";
    Self::Bent =>
        "rests on fits that the cause named in the findings bends: neither its value nor its \
         interval is to be trusted until that is mended",
        "beruht auf Anpassungen, die die in den Befunden genannte Ursache verfälscht: weder dem \
         Wert noch dem Intervall ist zu trauen, bis sie behoben ist";
    Self::ByMethodAlone { method } =>
        "is that of one method alone ({method}), which the cause named in the findings does not \
         reach",
        "ist der eines Verfahrens allein ({method}), das die in den Befunden genannte Ursache nicht \
         erreicht",
        method = Value::Message(method);
    Self::Drifts =>
        "the frequency changes over the decay, so that it is no single $f_0$: see the remark",
        "die Frequenz ändert sich beim Ausschwingen und ist nicht ein $f_0$: siehe die Anmerkung";
    Self::DampingChanges =>
        "the damping ratio changes over the decay, so that it is no single $β$: the interval holds \
         its values; see the remark",
        "der Dämpfungsgrad ändert sich beim Ausschwingen und ist nicht ein $β$: Das Intervall \
         enthält seine Werte; siehe die Anmerkung";
    Self::FewPeriods { periods } =>
        "the record ends after {periods} periods of the decay, too few to test whether one frequency \
         and one damping ratio hold along it: record three or more",
        "die Aufnahme endet nach {periods} Perioden des Ausschwingens, zu wenigen für die Prüfung, ob \
         eine Frequenz und ein Dämpfungsgrad gelten: drei oder mehr aufnehmen",
        periods = Value::Number(*periods, 1);
    Self::Undamped { most } =>
        "the amplitude does not fall by more than its noise: an upper limit, $β$ < {most}",
        "die Amplitude fällt nicht stärker als ihr Rauschen: eine obere Grenze, $β$ < {most}",
        most = Value::Number(*most, digits(*most));
    Self::SeveralSpecimens =>
        "the campaign has several specimens; each has its own parameters",
        "die Messreihe hat mehrere Prüflinge; jeder hat seine eigenen Parameter";
    Self::NoPublishedMotion =>
        "no damping ratio gives all of these motions",
        "kein Dämpfungsgrad ergibt alle diese Bewegungen";
    Self::NoStart { observations } =>
        "the model has no such motion at the starting values for {count} of the observations",
        "das Modell hat bei den Startwerten für {count} der Beobachtungen keine solche Bewegung",
        count = Value::Count(*observations);
    Self::NothingToFit =>
        "there are no observations to fit",
        "es gibt keine Beobachtungen für eine Anpassung";
    Self::OneOfTwo =>
        "only one of the two masses is measured: $R$ is the ratio of the speeds of both, and the \
         other mass need not move alike",
        "nur eine der beiden Massen ist gemessen: $R$ ist das Verhältnis der Geschwindigkeiten \
         beider, und die andere Masse muss sich nicht gleich bewegen";
    Self::Differentiated =>
        "the speeds at impacts come from differentiated displacements, whose kinks at the impacts they smooth",
        "die Geschwindigkeiten an Stößen stammen aus differenzierten Wegen, deren Knicke an den Stößen sie glätten";
    Self::SolverFailed => "the solver failed", "der Löser versagte";
    Self::NotSeparable =>
        "the data do not separate the parameters",
        "die Daten trennen die Parameter nicht";
}

/// Decimals that show two digits of a small number.
fn digits(value: f64) -> usize {
    let shows = |n: &usize| format!("{value:.n$}").trim_start_matches(['0', '.']).len() > 1;
    (2..10).find(shows).unwrap_or(9)
}

/// A standard error of a parameter: relative or, of R, absolute.
fn width(parameter: Coordinate, standard_error: f64) -> Value<'static> {
    match parameter.is_logarithm() {
        true => Value::Percent(standard_error, 2),
        false => Value::Number(standard_error, 2),
    }
}
