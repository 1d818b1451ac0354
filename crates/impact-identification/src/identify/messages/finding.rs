//! What the verdict rests on: mistakes of the laboratory, methods that do not fit, notes, disagreement.

use serde::{Deserialize, Serialize};

use super::beyond::beyond;
use super::direction::direction;
use super::{Note, PairAgreement, Reason, Remark, Sentence, StatedValue};
use crate::identify::messages::cause::Cause;
use crate::identify::method::Method;
use crate::identify::parameters::Coordinate;
use crate::identify::parameters::effect::Effect;
use impact_records::message::{Message, Value};
use impact_records::record::Role;
use impact_records::{message_table, messages};

/// Something that the data give away. Deviations are relative (0.01 is 1 %); a z-score is a deviation
/// over its standard error.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Finding {
    /// A gap is not as stated.
    WrongClearance {
        /// The clearance as stated, m.
        stated_m: f64,
        /// The clearance that fits, m.
        fitting_m: f64,
        /// How sure.
        z_score: f64,
    },
    /// The gain of a channel is far off the stated one.
    WrongGain {
        /// The channel.
        channel: Role,
        /// Relative deviation, positive where the channel reads too high.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// One of the gains of two channels is off, the data do not tell which.
    GainsApart {
        /// The channels, the one that reads more first.
        channels: [Role; 2],
        /// How much more it reads for the same motion, relative.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// A channel is later or earlier than stated.
    LateChannel {
        /// The channel.
        channel: Role,
        /// By how much it is later than stated, ms; negative where it is earlier.
        later_ms: f64,
        /// How sure.
        z_score: f64,
    },
    /// The corner of a channel's high-pass is far off the stated one.
    WrongCorner {
        /// The channel.
        channel: Role,
        /// Relative deviation, positive where the corner is above the stated one.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// A channel has passed a high-pass that is not stated.
    UndeclaredHighPass {
        /// The channel.
        channel: Role,
        /// Its corner as it fits, Hz.
        corner_hz: f64,
        /// How sure.
        z_score: f64,
    },
    /// A channel has passed a low-pass that is not stated.
    UndeclaredLowPass {
        /// The channel.
        channel: Role,
        /// Its corner, as jumps show it, Hz.
        corner_hz: f64,
    },
    /// The masses, springs, dashpots or drives of both sides differ by far more than is stated or assumed.
    SidesUnlike {
        /// Which of them.
        coordinate: Coordinate,
        /// Relative difference, x less y.
        difference: f64,
        /// How many of its standard uncertainties that is off what is stated or assumed.
        deviations: f64,
    },
    /// The velocities of both masses are swapped.
    SwappedChannels {
        /// How sure.
        z_score: f64,
    },
    /// The drive runs at one multiple of the stated frequencies in most records.
    FrequenciesOffAlike {
        /// Measured over stated frequency.
        ratio: f64,
        /// Records in which they contradict each other.
        records: usize,
        /// Records in which both are known.
        of: usize,
    },
    /// All stated frequencies are off by one small ratio: the sampler's clock is, or the generator.
    ClockOrGenerator {
        /// Measured over stated frequency, the mean.
        ratio: f64,
        /// Its standard error.
        standard_error: f64,
        /// Standard uncertainty of the clock, relative.
        clock_uncertainty: f64,
        /// Records in which both are known.
        records: usize,
        /// How sure.
        z_score: f64,
    },
    /// The drive's frequencies are not the stated ones in most records.
    FrequenciesOff {
        /// Records in which they contradict each other.
        records: usize,
        /// Records in which both are known.
        of: usize,
    },
    /// A drive's frequency is stated, and no record shows its drive.
    DriveNotMeasured {
        /// Records that state a frequency.
        records: usize,
    },
    /// No record shows its drive; the motions have its stated frequencies, and no phase.
    PhaseNotMeasured {
        /// Records whose motion has the stated frequency.
        records: usize,
    },
    /// The records are of two rigs, one after the other.
    RigChanged {
        /// The first record after the change.
        record: String,
        /// Its number in the order of acquisition, from 1.
        number: usize,
        /// Number of records.
        of: usize,
        /// What differs, as it was before.
        before: Vec<StatedValue>,
        /// The same after.
        after: Vec<StatedValue>,
    },
    /// Many records begin before their motion has settled.
    RecordsNotSettled {
        /// How many.
        records: usize,
        /// Of how many.
        of: usize,
        /// Time after which a thousandth of a disturbance is left, s.
        wait_s: f64,
    },
    /// The stated clearances are all about twice those that the motions show; none of them is used.
    WholeGapsStated {
        /// Clearance by the motions over the stated one.
        ratio: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// The clearances that the motions show are one multiple of the stated ones; none of them is used.
    ClearancesOffAlike {
        /// Clearance by the motions over the stated one.
        ratio: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// The clearances that the motions show are the stated ones and one length; none of them is used.
    ClearancesShifted {
        /// What has to be added to each, m.
        added_m: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// Two free masses do not change their speeds in the ratio of the stated masses.
    MomentumNotConserved {
        /// `m_y/m_x` as the speeds show it.
        measured: f64,
        /// `m_y/m_x` as stated.
        stated: f64,
        /// How sure.
        z_score: f64,
    },
    /// The rig has an effect beyond the model, which the estimates allow for.
    BeyondModel {
        /// The effect; a harmonic's cosine names its amplitude.
        effect: Effect,
        /// Its strength.
        strength: f64,
        /// Standard error of the strength.
        standard_error: f64,
        /// How sure.
        z_score: f64,
    },
    /// The model does not fit a method's data.
    Misfit {
        /// The method.
        method: Method,
        /// What it noticed.
        remark: Remark,
    },
    /// A method noticed what the laboratory can mend.
    Noticed {
        /// The method.
        method: Method,
        /// What it noticed.
        remark: Remark,
    },
    /// Why a parameter is weak or not identifiable.
    Parameter {
        /// The parameter.
        parameter: Coordinate,
        /// Why.
        note: Note,
    },
    /// Two methods do not agree.
    Disagreement {
        /// The two of those that do not agree which are furthest apart.
        pair: PairAgreement,
    },
    /// The verdict on a specimen.
    Specimen {
        /// Its name.
        specimen: String,
        /// The verdict.
        verdict: Vec<Sentence>,
    },
    /// A record is filed under the wrong specimen.
    MisfiledRecord {
        /// The record's name.
        record: String,
        /// Why it looks so.
        reason: Reason,
    },
    /// A printed damping ratio fits the published speeds.
    PrintedDampingFits {
        /// The printed damping ratio.
        printed: f64,
    },
    /// A printed damping ratio does not fit the published speeds.
    PrintedDampingDoesNotFit {
        /// The printed damping ratio.
        printed: f64,
        /// Greatest relative deviation of a speed.
        deviation: f64,
    },
    /// Some of the published speeds have no motion with a printed damping ratio.
    PrintedDampingWithoutMotion {
        /// The printed damping ratio.
        printed: f64,
        /// Greatest relative deviation of a speed; `None` if one has no motion at any setting.
        deviation: Option<f64>,
        /// The settings without a motion.
        settings: Vec<PublishedSetting>,
    },
}

messages!(Finding);

impl Finding {
    /// The kind of cause that it names; `None` where it has no part in the fits.
    pub fn cause(&self) -> Option<Cause> {
        match self {
            Self::UndeclaredHighPass { .. } => Some(Cause::Channel),
            Self::RigChanged { .. } => Some(Cause::Change),
            Self::RecordsNotSettled { records, of, .. } if 4 * records > *of => {
                Some(Cause::Unsettled)
            }
            Self::WrongClearance { .. }
            | Self::WrongGain { .. }
            | Self::GainsApart { .. }
            | Self::LateChannel { .. }
            | Self::UndeclaredLowPass { .. }
            | Self::WrongCorner { .. }
            | Self::SidesUnlike { .. }
            | Self::SwappedChannels { .. } => Some(Cause::Statement),
            Self::BeyondModel { .. } => Some(Cause::Effect),
            Self::Misfit { remark, .. } => remark.cause(),
            Self::Disagreement { .. } => Some(Cause::Symptom),
            _ => None,
        }
    }
}

message_table! { Finding, key = template_key;
    Self::WrongClearance { stated_m, fitting_m, .. } =>
        "the gap stated with a clearance of {stated_mm} mm moves like one of {fitting_mm} mm: \
         measure it again and correct the run table; its records stay out of the fit",
        "der mit einem Spiel von {stated_mm} mm angegebene Abstand bewegt sich wie einer von \
         {fitting_mm} mm: nachmessen und die Versuchstabelle richtigstellen; seine Aufzeichnungen \
         bleiben außerhalb der Anpassung",
        stated_mm = millimetres(*stated_m), fitting_mm = millimetres(*fitting_m);
    Self::WrongGain { channel, deviation, .. } =>
        "{channel} reads {share} too {direction}: correct scale in [channels.{channel}], or state \
         a larger gain_uncertainty in [rig]",
        "{channel} zeigt {share} zu {direction}: scale in [channels.{channel}] richtigstellen, \
         oder eine größere gain_uncertainty in [rig] angeben",
        channel = Value::Name(channel.name()),
        share = Value::Percent(deviation.abs(), 1),
        direction = direction(*deviation);
    Self::GainsApart { channels: [high, low], deviation, .. } =>
        "{high} reads {share} more than {low} for the same motion, and the data do not tell which \
         is off: calibrate both, correct scale in [channels.{high}] or [channels.{low}], or state a \
         larger gain_uncertainty in [rig]",
        "{high} zeigt bei gleicher Bewegung {share} mehr als {low}; welcher Kanal falsch zeigt, \
         sagen die Daten nicht: beide kalibrieren, scale in [channels.{high}] oder [channels.{low}] \
         richtigstellen, oder eine größere gain_uncertainty in [rig] angeben",
        high = Value::Name(high.name()),
        low = Value::Name(low.name()),
        share = Value::Percent(*deviation, 1);
    Self::LateChannel { channel, later_ms, .. } =>
        match *later_ms > 0.0 {
            true => "{channel} shows the motion {time} ms later than stated: measure its delay and \
                     state it as delay in [channels.{channel}]; all is corrected by it here",
            false => "{channel} shows the motion {time} ms earlier than stated: check the delays of \
                      it and of the drive's channel, and state it as delay in [channels.{channel}]; \
                      all is corrected by it here",
        },
        match *later_ms > 0.0 {
            true => "{channel} zeigt die Bewegung {time} ms später als angegeben: die Verzögerung \
                     messen und als delay in [channels.{channel}] angeben; hier ist alles um sie \
                     berichtigt",
            false => "{channel} zeigt die Bewegung {time} ms früher als angegeben: die Verzögerungen \
                      dieses Kanals und der Erregung prüfen und als delay in [channels.{channel}] \
                      angeben; hier ist alles um sie berichtigt",
        },
        channel = Value::Name(channel.name()),
        time = Value::Number(later_ms.abs(), 2);
    Self::WrongCorner { channel, deviation, .. } =>
        "the corner of the high-pass of {channel} is {share} too {direction} for the stated one: \
         correct high_pass in [channels.{channel}], or state a larger corner_uncertainty in [rig]",
        "die Grenzfrequenz des Hochpasses von {channel} liegt {share} zu {direction} gegen die \
         angegebene: high_pass in [channels.{channel}] richtigstellen, oder eine größere \
         corner_uncertainty in [rig] angeben",
        channel = Value::Name(channel.name()),
        share = Value::Percent(deviation.abs(), 0),
        direction = direction(*deviation);
    Self::UndeclaredHighPass { channel, corner_hz, .. } =>
        "{channel} fits far better behind a high-pass of about {corner} Hz, and none is stated: look \
         up what sensors, amplifiers and converters of all channels have, and state it as high_pass \
         in [channels.{channel}] and theirs",
        "{channel} passt weit besser hinter einem Hochpass von etwa {corner} Hz, und keiner ist \
         angegeben: nachsehen, was Aufnehmer, Verstärker und Wandler aller Kanäle haben, und als \
         high_pass in [channels.{channel}] und den anderen angeben",
        channel = Value::Name(channel.name()),
        corner = Value::Shortest(two_digits(*corner_hz));
    Self::UndeclaredLowPass { channel, corner_hz } =>
        "{channel} takes longer for a jump than the contact is closed, as behind a low-pass of about \
         {corner} Hz, and none is stated: look up the filters of vibrometer, amplifier and converter, \
         and state low_pass and low_pass_order in [channels.{channel}]; here that corner is used, and \
         the speeds at impacts are not",
        "{channel} braucht für einen Sprung länger, als der Kontakt geschlossen ist, wie hinter einem \
         Tiefpass von etwa {corner} Hz, und keiner ist angegeben: die Filter von Vibrometer, \
         Verstärker und Wandler nachsehen und als low_pass und low_pass_order in \
         [channels.{channel}] angeben; hier wird diese Grenzfrequenz verwendet, und die \
         Geschwindigkeiten an Stößen werden es nicht",
        channel = Value::Name(channel.name()),
        corner = Value::Shortest(two_digits(*corner_hz));
    Self::SidesUnlike { coordinate, difference, deviations } =>
        "the fit needs a {coordinate} of {share}, {deviations} times its uncertainty off what is \
         stated or assumed: weigh both masses and state mass_x and mass_y in [rig], and check springs, \
         dashpots and drives of both sides",
        "die Anpassung braucht {coordinate} = {share}, um das {deviations}-Fache der Unsicherheit neben \
         dem, was angegeben oder angenommen ist: beide Massen wiegen und mass_x und mass_y in [rig] \
         angeben, und Federn, Dämpfer und Antriebe beider Seiten prüfen",
        coordinate = Value::Message(coordinate),
        share = Value::Percent(*difference, 1),
        deviations = Value::Number(deviations.abs(), 1);
    Self::SwappedChannels { .. } =>
        "all data fit far better with the velocities of both masses swapped: swap \
         [channels.velocity_x] and [channels.velocity_y], or the displacements",
        "alle Daten passen weit besser, wenn die Geschwindigkeiten beider Massen vertauscht sind: \
         [channels.velocity_x] und [channels.velocity_y] tauschen, oder die Wege";
    Self::FrequenciesOffAlike { ratio, records, of } =>
        "the drive runs at {ratio} times the stated frequency in {records} of {of} records: check \
         the sample rate and the time axis of the files, from which $f_0$ follows, or correct the \
         run table",
        "die Erregung hat das {ratio}-fache der angegebenen Frequenz in {records} von {of} \
         Aufzeichnungen: Abtastrate und Zeitachse der Dateien prüfen, aus denen $f_0$ folgt, oder \
         die Versuchstabelle richtigstellen",
        ratio = Value::Number(*ratio, 4),
        records = Value::Count(*records),
        of = Value::Count(*of);
    Self::ClockOrGenerator { ratio, clock_uncertainty, records, .. } =>
        "the measured drive is at {ratio} times the stated frequencies on average over {records} \
         records, which the clock's {clock} ppm do not explain: the sampler's clock or the generator \
         is off; measure both with a frequency counter and correct sample_rate or the stated \
         frequencies: until then $f_0$ is known no better than that",
        "die gemessene Erregung hat im Mittel über {records} Aufzeichnungen das {ratio}-fache der \
         angegebenen Frequenzen, was die {clock} ppm des Taktes nicht erklären: der Abtasttakt oder \
         der Generator ist falsch; beide mit einem Frequenzzähler messen und sample_rate oder die \
         angegebenen Frequenzen richtigstellen: bis dahin ist $f_0$ nicht besser bekannt",
        ratio = Value::Number(*ratio, 5),
        clock = Value::Shortest(two_digits(1e6 * clock_uncertainty)),
        records = Value::Count(*records);
    Self::FrequenciesOff { records, of } =>
        "the drive's frequency is not the stated one in {records} of {of} records: check that \
         each row of the run table names its own file",
        "die Frequenz der Erregung ist nicht die angegebene in {records} von {of} Aufzeichnungen: \
         prüfen, ob jede Zeile der Versuchstabelle ihre eigene Datei nennt",
        records = Value::Count(*records), of = Value::Count(*of);
    Self::DriveNotMeasured { records } =>
        "no drive was measured in the {records} records that state its frequency, so no motion is \
         named, and neither $f_0$, $β$ nor $x_st$ follow: record the generator or its current, and \
         name that channel in [channels.drive]",
        "in den {records} Aufzeichnungen, die ihre Frequenz angeben, ist keine Erregung gemessen; \
         daher wird keine Bewegung benannt, und weder $f_0$ noch $β$ noch $x_st$ folgen: den \
         Generator oder seinen Strom aufzeichnen und den Kanal in [channels.drive] nennen",
        records = Value::Count(*records);
    Self::PhaseNotMeasured { records } =>
        "no record shows its drive: $f_0$, $β$ and $x_st$ rest on the amplitudes of the resonance \
         curve at the frequencies that the motions of {records} records have, and no waveform is \
         fitted: record the generator or its current, and name that channel in [channels.drive]",
        "keine Aufzeichnung zeigt ihre Erregung: $f_0$, $β$ und $x_st$ beruhen auf den Amplituden der \
         Resonanzkurve bei den Frequenzen, die die Bewegungen in {records} Aufzeichnungen haben, und \
         kein Verlauf wird angepasst: den Generator oder seinen Strom aufzeichnen und den Kanal in \
         [channels.drive] nennen",
        records = Value::Count(*records);
    Self::RigChanged { record, number, of, before, after } =>
        "the records are not of one rig: before {record} (number {number} of {of}) they have {before}, \
         from it on {after}: look for what was changed there (masses, springs, clamps, bumpers, \
         amplifier, sensors), and identify both parts by themselves",
        "die Aufzeichnungen sind nicht von einem Prüfstand: vor {record} (Nummer {number} von {of}) \
         haben sie {before}, von da an {after}: suchen, was dort geändert wurde (Massen, Federn, \
         Einspannungen, Puffer, Verstärker, Aufnehmer), und beide Teile für sich identifizieren",
        record = Value::Name(record), number = Value::Count(*number), of = Value::Count(*of),
        before = Value::list(before), after = Value::list(after);
    Self::RecordsNotSettled { records, of, wait_s } =>
        "{records} of {of} records begin before their motion has settled, so that their motions are \
         not known, or named less surely: wait at least {wait} s after each change of a setting \
         before recording",
        "{records} von {of} Aufzeichnungen beginnen, bevor ihre Bewegung eingeschwungen ist, so dass \
         ihre Bewegungen nicht oder weniger sicher bestimmt sind: nach jeder Änderung einer \
         Einstellung mindestens {wait} s warten, ehe aufgezeichnet wird",
        records = Value::Count(*records), of = Value::Count(*of),
        wait = Value::Shortest(two_digits(*wait_s));
    Self::WholeGapsStated { ratio, records } =>
        "the masses hit as if the clearances were {ratio} times the stated ones in {records} \
         records: whole gaps are stated, a clearance is half of one; no clearance is used until the \
         run table is corrected",
        "die Massen stoßen in {records} Aufzeichnungen, als wären die Spiele das {ratio}-fache der \
         angegebenen: Angegeben sind ganze Abstände, ein Spiel ist die Hälfte davon; bis die \
         Versuchstabelle richtiggestellt ist, wird kein Spiel verwendet",
        ratio = Value::Number(*ratio, 2), records = Value::Count(*records);
    Self::ClearancesOffAlike { ratio, records } =>
        "the masses hit as if the clearances were {ratio} times the stated ones in {records} \
         records: check their unit in the run table, that each is half of the gap between the \
         masses, and the scales of the motion channels; no clearance is used until then",
        "die Massen stoßen in {records} Aufzeichnungen, als wären die Spiele das {ratio}-fache der \
         angegebenen: prüfen, welche Einheit sie in der Versuchstabelle haben, ob jedes die Hälfte \
         des Abstands der Massen ist, und die Maßstäbe der Bewegungskanäle; bis dahin wird kein \
         Spiel verwendet",
        ratio = Value::Shortest(two_digits(*ratio)), records = Value::Count(*records);
    Self::ClearancesShifted { added_m, records } =>
        "the masses hit as if {added_mm} mm had to be added to every clearance in {records} \
         records: count them from where the masses touch; no clearance is used until the run table \
         is corrected",
        "die Massen stoßen in {records} Aufzeichnungen, als wäre zu jedem Spiel {added_mm} mm zu \
         addieren: von der Berührung der Massen an zählen; bis die Versuchstabelle \
         richtiggestellt ist, wird kein Spiel verwendet",
        added_mm = Value::Number(1e3 * added_m, 2), records = Value::Count(*records);
    Self::MomentumNotConserved { measured, stated, .. } =>
        "the speeds of both masses change as if $m_y$/$m_x$ were {measured}, the stated masses \
         give {stated}: weigh them again, check the scales of both velocities, and that nothing \
         else touches the masses",
        "die Geschwindigkeiten beider Massen ändern sich, als wäre $m_y$/$m_x$ = {measured}; die \
         angegebenen Massen geben {stated}: nachwiegen, die Maßstäbe beider Geschwindigkeiten \
         prüfen, und dass sonst nichts die Massen berührt",
        measured = Value::Number(*measured, 3), stated = Value::Number(*stated, 3);
    Self::BeyondModel { effect, strength, standard_error, .. } =>
        beyond(*effect, *strength > 0.0)[0],
        beyond(*effect, *strength > 0.0)[1],
        strength = Value::Number(scale(*effect) * strength.abs(), 3),
        error = Value::Number(1.96 * scale(*effect) * standard_error, 3);
    Self::Misfit { method, remark } | Self::Noticed { method, remark } =>
        "{method}: {remark}",
        "{method}: {remark}",
        method = Value::Message(method), remark = Value::Message(remark);
    Self::Parameter { parameter, note } =>
        "{parameter}: {note}",
        "{parameter}: {note}",
        parameter = Value::Message(parameter), note = Value::Message(note);
    Self::Disagreement { pair } =>
        "the methods do not agree on {pair}",
        "die Verfahren stimmen nicht überein bei {pair}",
        pair = Value::Message(pair);
    Self::Specimen { specimen, verdict } =>
        "{specimen}: {verdict}",
        "{specimen}: {verdict}",
        specimen = Value::Name(specimen), verdict = sentences(verdict);
    Self::MisfiledRecord { record, reason } =>
        "{record}: {reason}",
        "{record}: {reason}",
        record = Value::Name(record), reason = Value::Message(reason);
    Self::PrintedDampingFits { printed } =>
        "The printed $β$ = {value} fits the speeds.",
        "Das gedruckte $β$ = {value} passt zu den Geschwindigkeiten.",
        value = Value::Shortest(*printed);
    Self::PrintedDampingDoesNotFit { printed, deviation } =>
        "The printed $β$ = {value} does not fit: a speed is off by {share}.",
        "Das gedruckte $β$ = {value} passt nicht: Eine Geschwindigkeit liegt um {share} daneben.",
        value = Value::Shortest(*printed), share = Value::Percent(*deviation, 1);
    Self::PrintedDampingWithoutMotion { printed, settings, .. } =>
        "The printed $β$ = {value} does not fit: the motion for {settings} does not exist with it.",
        "Das gedruckte $β$ = {value} passt nicht: Die Bewegung bei {settings} gibt es damit nicht.",
        value = Value::Shortest(*printed), settings = Value::list(settings);
}

/// The kind or, of an effect beyond the model, its name and sign, which have texts of their own.
fn template_key(finding: &Finding) -> String {
    match finding {
        Finding::BeyondModel {
            effect, strength, ..
        } => {
            let way = if *strength > 0.0 { "above" } else { "below" };
            format!("{}_{}_zero", effect.name(), way)
        }
        Finding::LateChannel { later_ms, .. } if *later_ms <= 0.0 => "early_channel".to_owned(),
        _ => finding.kind().to_owned(),
    }
}

fn millimetres(metres: f64) -> Value<'static> {
    Value::Number(1e3 * metres, 4)
}

/// Rounded to two significant digits.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// From the strength of an effect to the number in its text: per cent, or milliseconds.
fn scale(effect: Effect) -> f64 {
    match effect {
        Effect::ContactDuration => 1.0,
        _ => 100.0,
    }
}

fn sentences(verdict: &[Sentence]) -> Value<'_> {
    Value::Sentences(verdict.iter().map(|s| Value::Message(s)).collect())
}

/// A published speed's setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PublishedSetting {
    /// R.
    pub restitution: f64,
    /// η.
    pub frequency_ratio: f64,
}

impl Message for PublishedSetting {
    fn kind(&self) -> &'static str {
        "published_setting"
    }

    fn texts(&self) -> [&'static str; 2] {
        [
            "$R$ = {restitution} at $η$ = {frequency_ratio}",
            "$R$ = {restitution} und $η$ = {frequency_ratio}",
        ]
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        vec![
            ("restitution", Value::Shortest(self.restitution)),
            ("frequency_ratio", Value::Shortest(self.frequency_ratio)),
        ]
    }
}
