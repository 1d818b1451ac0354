//! What a method noticed about its data.

use serde::{Deserialize, Serialize};

use super::{DampingPoint, Item, Note};
use crate::identify::evidence::structure::ImpactGroup;
use crate::identify::messages::cause::Cause;
use crate::identify::method::Method;
use crate::identify::statistics::quantile::NORMAL_975;
use impact_records::message::{Message, Value};
use impact_records::signal::decay::DampingLaw;
use impact_records::{message_table, messages};

/// R at one approach speed.
#[derive(Debug, Default, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedPoint {
    /// Approach speed before the impact, m/s.
    pub speed_m_s: f64,
    /// R at this speed.
    pub restitution: f64,
}

/// R of a bounce or of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupPoint {
    /// Number of the bounce, from 1, or name of the record.
    pub group: String,
    /// R.
    pub restitution: f64,
    /// Half its 95 % interval.
    pub half_width: f64,
}

impl GroupPoint {
    /// Of a group of impacts.
    pub fn of(group: &ImpactGroup) -> Self {
        Self {
            group: group.group.clone(),
            restitution: group.restitution.min(1.0),
            half_width: NORMAL_975 * group.standard_error,
        }
    }
}

impl Message for GroupPoint {
    fn kind(&self) -> &'static str {
        "group_point"
    }

    fn texts(&self) -> [&'static str; 2] {
        ["{value} ± {half} ({group})"; 2]
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        vec![
            ("value", Value::Number(self.restitution, 3)),
            ("half", Value::Number(self.half_width, 3)),
            ("group", Value::Name(&self.group)),
        ]
    }
}

/// Groups that a remark names.
const NAMED: usize = 6;

/// The first few groups.
fn named(groups: &[GroupPoint]) -> Value<'_> {
    abridged(&groups[..groups.len().min(NAMED)], groups.len())
}

/// The first of `count` messages, with an ellipsis for the others.
fn abridged(first: &[impl Message], count: usize) -> Value<'_> {
    let mut each: Vec<Value<'_>> = first.iter().map(|m| Value::Message(m)).collect();
    each.extend((count > first.len()).then_some(Value::Name("…")));
    Value::List(each)
}

/// What a method noticed about its data. Shares and deviations are relative (0.01 is 1 %).
#[derive(
    Debug, Default, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Remark {
    /// The responses without impacts are those of one degree of freedom.
    OneDegreeOfFreedom {
        /// Root mean square of the relative deviations.
        deviation: f64,
    },
    /// They are not.
    NotOneDegreeOfFreedom {
        /// Root mean square of the relative deviations.
        deviation: f64,
    },
    /// How much of the waveforms the orbits leave unexplained, in the median record.
    WaveformsUnexplained {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
    },
    /// Only some of the waveforms were kept.
    WaveformsThinned {
        /// Number of periodic records whose waveform is fitted.
        fitted: usize,
        /// Number of periodic records.
        periodic: usize,
    },
    /// The method takes the rig as ideal, where effects beyond the model were found.
    #[default]
    IdealRig,
    /// How far the states deviate from impact to impact.
    StatesDeviate {
        /// Root mean square of the deviations over their standard errors.
        ratio: f64,
    },
    /// R by plain least squares on the midpoints of the saddle-node brackets.
    BracketMidpoints {
        /// R.
        restitution: f64,
        /// Half its 95 % interval.
        half_width: f64,
    },
    /// Motions end well before their boundaries.
    EarlyJumps {
        /// Mean distance from the boundary, relative to its frequency.
        distance: f64,
    },
    /// R of the impacts is not R of the whole bodies.
    WhichRestitution {
        /// R where the bodies touch, by the speeds at impacts.
        at_impact: f64,
        /// R of the whole bodies.
        of_bodies: f64,
        /// By which method.
        method: Method,
    },
    /// R is the same at all speeds.
    RestitutionConstant {
        /// Slowest approach speed, m/s.
        slow_m_s: f64,
        /// Fastest approach speed, m/s.
        fast_m_s: f64,
        /// Change of R between them that the data allow.
        within: f64,
    },
    /// R depends on the speed, by so little that one constant with that range as its error serves.
    RestitutionChangesLittle {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
    },
    /// R depends on the speed.
    RestitutionChanges {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
    },
    /// Speeds after impacts exceed those before.
    SpeedsGained {
        /// Approach speed before the impact, m/s.
        speed_m_s: f64,
        /// Speed after over speed before.
        ratio: f64,
    },
    /// R depends on the speed because a contact lasts several samples.
    LongContact {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
        /// Length of a contact, samples.
        samples: f64,
    },
    /// The speeds of most impacts cannot be used.
    FewUsable {
        /// Impacts whose speeds are used.
        used: usize,
        /// Impacts with speeds.
        of: usize,
    },
    /// R changes from bounce to bounce.
    RestitutionByBounce {
        /// R of the first, the second … bounce.
        points: Vec<GroupPoint>,
    },
    /// R differs between records.
    RecordsDiffer {
        /// R of each record.
        points: Vec<GroupPoint>,
    },
    /// The ratio of the masses by conservation of momentum.
    MassRatio {
        /// `m_y/m_x`.
        ratio: f64,
        /// Half its 95 % interval.
        half_width: f64,
    },
    /// How far the times of impacts are off the fitted rows.
    TimesScatter {
        /// Standard error of a time, s.
        error_s: f64,
    },
    /// One record has another R than all others, which agree; it is left out.
    OddRecord {
        /// Its name.
        record: String,
        /// Its R.
        restitution: f64,
        /// R of the others.
        others: f64,
    },
    /// Flights that follow none of R times their length were left out.
    FlightsLeftOut {
        /// How many.
        count: usize,
    },
    /// Impacts are missing among times: a flight is two.
    ImpactsMissed {
        /// How many.
        count: usize,
        /// The record of the first one.
        record: String,
        /// When it was, s.
        time_s: f64,
    },
    /// Impacts whose speeds are far from those of the others were left out.
    OutlyingImpacts {
        /// How many.
        count: usize,
        /// The first few of them.
        first: Vec<Item>,
    },
    /// How much of the free decays the fits leave unexplained, in the median record.
    DecaysUnexplained {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
        /// The part of it that is no noise.
        #[serde(default)]
        structure: f64,
    },
    /// The free decays have more than one oscillator and noise.
    DecaysHaveStructure {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
        /// The part of it that is no noise.
        structure: f64,
    },
    /// The frequency changes over the decays.
    DecaysDrift {
        /// Number of decays that do.
        count: usize,
        /// Natural frequency in the first quarter of the decay that drifts most, Hz.
        first_hz: f64,
        /// In its last quarter, Hz.
        last_hz: f64,
        /// The change over half the 95 % interval of the whole decay's frequency.
        intervals: f64,
    },
    /// The damping ratio changes over the decays.
    DecaysDamping {
        /// Number of decays along which it does.
        count: usize,
        /// Parts of the decay along which it changes most.
        points: Vec<DampingPoint>,
        /// What explains it.
        law: DampingLaw,
    },
    /// A steady tone beside the decays, fitted with them.
    DecaysHum {
        /// Number of decays with one.
        count: usize,
        /// Frequency of the strongest, Hz.
        frequency_hz: f64,
        /// Its amplitude over that of the decay.
        ratio: f64,
    },
    /// Another mode beside the decays, fitted with them.
    DecaysMode {
        /// Number of decays with one.
        count: usize,
        /// Frequency of the strongest, Hz.
        frequency_hz: f64,
        /// Its amplitude over that of the decay.
        ratio: f64,
    },
    /// Two modes of near frequencies beat, which one decay does not explain.
    DecaysBeat {
        /// Number of decays that do.
        count: usize,
        /// Frequency of the stronger one, Hz.
        first_hz: f64,
        /// Of the weaker one, Hz.
        second_hz: f64,
        /// Amplitude of the weaker over that of the stronger.
        ratio: f64,
    },
    /// A drift under the decays, fitted with them.
    DecaysBackground {
        /// Number of decays with one.
        count: usize,
        /// Its greatest range over the decay's amplitude.
        ratio: f64,
    },
    /// Slow noise under the decays makes their intervals wide.
    DecaysSlowNoise {
        /// Number of decays with such noise.
        count: usize,
        /// How many times as wide as by the scatter of neighbouring samples, at most.
        times: f64,
    },
    /// The free decays are not of one oscillator.
    DecaysDiffer {
        /// Greatest relative deviation of a natural frequency from the mean.
        spread: f64,
    },
    /// The method has no result.
    NoResult {
        /// Why.
        why: Note,
    },
    /// How well a damping ratio gives the published speeds.
    PublishedSpeedsMet {
        /// The damping ratio.
        damping_ratio: f64,
        /// Greatest relative deviation of a speed.
        deviation: f64,
    },
}

messages!(Remark);

impl Remark {
    /// The kind of cause that it names, of a method that does not fit.
    pub fn cause(&self) -> Option<Cause> {
        match self {
            Self::RestitutionChanges { .. }
            | Self::LongContact { .. }
            | Self::RestitutionByBounce { .. } => Some(Cause::Contact),
            Self::RecordsDiffer { .. } => Some(Cause::Change),
            Self::NotOneDegreeOfFreedom { .. }
            | Self::WaveformsUnexplained { .. }
            | Self::StatesDeviate { .. }
            | Self::FewUsable { .. } => Some(Cause::Symptom),
            _ => None,
        }
    }
}

message_table! { Remark;
    Self::OneDegreeOfFreedom { deviation } =>
        "the responses follow one degree of freedom within {share}",
        "die Antworten folgen einem Freiheitsgrad auf {share}",
        share = Value::Percent(*deviation, 2);
    Self::NotOneDegreeOfFreedom { deviation } =>
        "the responses deviate by {share} from the curve of one degree of freedom: there is more \
         than one resonance, or the damping is not viscous",
        "die Antworten weichen um {share} von der Kurve eines Freiheitsgrads ab: Es gibt mehr als \
         eine Resonanz, oder die Dämpfung ist nicht zäh",
        share = Value::Percent(*deviation, 0);
    Self::WaveformsUnexplained { share } =>
        "the simulated waveforms leave {share} of the measured ones unexplained",
        "die simulierten Verläufe lassen {share} der gemessenen unerklärt",
        share = Value::Percent(*share, 2);
    Self::WaveformsThinned { fitted, periodic } =>
        "waveforms of {some} of {count} periodic records are fitted, evenly chosen",
        "angepasst sind die Verläufe von {some} der {count} periodischen Aufzeichnungen, \
         gleichmäßig gewählt",
        some = Value::Count(*fitted), count = Value::Count(*periodic);
    Self::IdealRig =>
        "it takes the rig as ideal, without the delays of channels and the effects found beyond \
         the model: it is not compared, and its intervals are widened by what it is off the joint \
         estimate",
        "es nimmt die Maschine als ideal an, ohne die Verzögerungen der Kanäle und die Effekte \
         über das Modell hinaus: es wird nicht verglichen, und seine Intervalle sind um die \
         Abweichung vom gemeinsamen Schätzwert erweitert";
    Self::StatesDeviate { ratio } =>
        "from impact to impact, the states deviate {ratio} times their errors",
        "von Stoß zu Stoß weichen die Zustände um das {ratio}-Fache ihrer Fehler ab",
        ratio = Value::Number(*ratio, 1);
    Self::BracketMidpoints { restitution, half_width } =>
        "plain least squares on the midpoints of the s2 brackets: $R$ = {value} ± {half}",
        "einfache kleinste Quadrate auf den Mitten der Schranken von s2: $R$ = {value} ± {half}",
        value = Value::Number(*restitution, 3), half = Value::Number(*half_width, 3);
    Self::EarlyJumps { distance } =>
        "by the waveforms the motions $z$ = 1 end {share} of the frequency before their s2 on \
         average, so the brackets determine $R$ poorly: let the drive go on from setting to \
         setting, in smaller steps",
        "nach den Verläufen enden die Bewegungen $z$ = 1 im Mittel {share} der Frequenz vor ihrem \
         s2, die Schranken bestimmen $R$ also schlecht: den Antrieb von Einstellung zu Einstellung \
         weiterlaufen lassen, in kleineren Schritten",
        share = Value::Percent(*distance, 1);
    Self::WhichRestitution { at_impact, of_bodies, method } =>
        "at the impacts $R$ = {impact}, of the whole bodies (method “{method}”) $R$ = {bodies}: these differ where a body \
         vibrates in itself or a contact is long, so state which one is meant",
        "an den Stößen ist $R$ = {impact}, für die ganzen Körper (Verfahren „{method}“) $R$ = {bodies}: Das unterscheidet \
         sich, wo ein Körper in sich schwingt oder ein Kontakt lang ist; angeben, welches gemeint ist",
        impact = Value::Number(*at_impact, 4),
        bodies = Value::Number(*of_bodies, 4),
        method = Value::Message(method);
    Self::RestitutionConstant { slow_m_s, fast_m_s, within } =>
        "$R$ is the same from {slow} to {fast} m/s within {change}",
        "$R$ ist von {slow} bis {fast} m/s gleich, auf {change}",
        slow = Value::Number(*slow_m_s, 3),
        fast = Value::Number(*fast_m_s, 3),
        change = Value::Number(*within, 3);
    Self::RestitutionChangesLittle { slower, faster } =>
        "$R$ goes from {first} at {slow} m/s to {last} at {fast} m/s: a small change with the speed, which \
         widens the interval",
        "$R$ geht von {first} bei {slow} m/s auf {last} bei {fast} m/s: eine kleine Änderung mit der \
         Geschwindigkeit, die das Intervall verbreitert",
        first = Value::Number(slower.restitution, 4),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 4),
        fast = Value::Number(faster.speed_m_s, 3);
    Self::RestitutionChanges { slower, faster } =>
        "$R$ goes from {first} at {slow} m/s to {last} at {fast} m/s: $R$ depends on the speed, \
         one constant does not describe it",
        "$R$ geht von {first} bei {slow} m/s auf {last} bei {fast} m/s: $R$ hängt von der \
         Geschwindigkeit ab, eine Konstante beschreibt es nicht",
        first = Value::Number(slower.restitution, 3),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 3),
        fast = Value::Number(faster.speed_m_s, 3);
    Self::SpeedsGained { speed_m_s, ratio } =>
        "the masses seem to part {ratio} times as fast as they met, at {speed} m/s, which no contact \
         makes: a velocity is late, filtered or wrongly scaled; no coefficient of restitution follows \
         from the speeds at impacts",
        "die Massen scheinen bei {speed} m/s {ratio}-mal so schnell auseinanderzugehen, wie sie sich \
         trafen, was kein Kontakt bewirkt: eine Geschwindigkeit ist verzögert, gefiltert oder falsch \
         skaliert; aus den Geschwindigkeiten an Stößen folgt keine Stoßzahl",
        ratio = Value::Number(*ratio, 1), speed = Value::Number(*speed_m_s, 3);
    Self::LongContact { slower, faster, samples } =>
        "$R$ goes from {first} at {slow} m/s to {last} at {fast} m/s, and a contact lasts {count} \
         samples: it is not an instantaneous impact, so one coefficient of restitution does not \
         describe it",
        "$R$ geht von {first} bei {slow} m/s auf {last} bei {fast} m/s, und ein Kontakt dauert \
         {count} Abtastwerte: Es ist kein augenblicklicher Stoß, und eine Stoßzahl beschreibt ihn \
         nicht",
        first = Value::Number(slower.restitution, 3),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 3),
        fast = Value::Number(faster.speed_m_s, 3),
        count = Value::Number(*samples, 0);
    Self::FewUsable { used, of } =>
        "the speeds of only {used} of {of} impacts can be used, as in the others the masses stay \
         together or the next one follows at once: contacts take too long, or none of them is an \
         impact",
        "nur von {used} der {of} Stöße sind die Geschwindigkeiten verwendbar, da bei den anderen \
         die Massen beisammen bleiben oder gleich der nächste folgt: Die Kontakte dauern zu lange, \
         oder sie sind keine Stöße",
        used = Value::Count(*used), of = Value::Count(*of);
    Self::RestitutionByBounce { points } =>
        "$R$ changes from bounce to bounce, and with it the speed: {points}; one constant does not \
         describe it",
        "$R$ ändert sich von Stoß zu Stoß, und mit ihm die Geschwindigkeit: {points}; eine \
         Konstante beschreibt es nicht",
        points = named(points);
    Self::RecordsDiffer { points } =>
        "$R$ differs between the records by more than its errors: {points}; they are not of one \
         contact",
        "$R$ unterscheidet sich zwischen den Aufzeichnungen um mehr als seine Fehler: {points}; \
         sie sind nicht die eines Kontakts",
        points = named(points);
    Self::MassRatio { ratio, half_width } =>
        "by conservation of momentum the masses are $m_y$/$m_x$ = {value} ± {half}",
        "nach der Impulserhaltung verhalten sich die Massen wie $m_y$/$m_x$ = {value} ± {half}",
        value = Value::Number(*ratio, 3), half = Value::Number(*half_width, 3);
    Self::TimesScatter { error_s } =>
        "the times of the impacts scatter by {error} ms",
        "die Zeiten der Stöße streuen um {error} ms",
        error = Value::Number(1e3 * error_s, 2);
    Self::OddRecord { record, restitution, others } =>
        "{record} has $R$ = {own} where all others agree on {others}: left out; see whether it fell \
         on the same spot and whether a bounce is missing",
        "{record} hat $R$ = {own}, wo alle anderen {others} ergeben: ausgelassen; prüfen, ob der \
         Fall auf dieselbe Stelle ging und ob ein Stoß fehlt",
        record = Value::Name(record),
        own = Value::Number(*restitution, 3),
        others = Value::Number(*others, 3);
    Self::FlightsLeftOut { count } =>
        "flights that do not follow from the one before, as where an impact was missed, left out: \
         {count}",
        "Flüge, die nicht aus dem vorigen folgen, etwa wo ein Stoß fehlt, ausgelassen: {count}",
        count = Value::Count(*count);
    Self::ImpactsMissed { count, record, time_s } =>
        "impacts missing among the times: {count}, the first in {record} at about {time} s; the \
         flights over them are left out: see why they were not heard",
        "unter den Zeiten fehlende Stöße: {count}, der erste in {record} bei etwa {time} s; die Flüge \
         darüber sind ausgelassen: prüfen, warum sie nicht gehört wurden",
        count = Value::Count(*count),
        record = Value::Name(record),
        time = Value::Number(*time_s, 3);
    Self::OutlyingImpacts { count, first } =>
        "impacts with speeds far from those of the others, left out: {count} ({which})",
        "Stöße mit Geschwindigkeiten weit von denen der übrigen, ausgelassen: {count} ({which})",
        count = Value::Count(*count), which = abridged(first, *count);
    Self::DecaysUnexplained { share, structure } =>
        "the fits leave {share} of the decays unexplained; {structure} is no noise",
        "die Anpassungen lassen {share} der Ausschwingversuche unerklärt; {structure} ist kein \
         Rauschen",
        share = Value::Percent(*share, 1), structure = Value::Percent(*structure, 1);
    Self::DecaysHaveStructure { share, structure } =>
        "the fits leave {share} of the decays unexplained, and {structure} is no noise: there is \
         another mode, or the damping is not viscous",
        "die Anpassungen lassen {share} der Ausschwingversuche unerklärt, und {structure} ist kein \
         Rauschen: Es gibt eine weitere Eigenschwingung, oder die Dämpfung ist nicht zäh",
        share = Value::Percent(*share, 1), structure = Value::Percent(*structure, 1);
    Self::DecaysDrift { count, first_hz, last_hz, intervals } =>
        "the frequency drifts in {count} of the decays, at most from {first} Hz in the first quarter \
         to {last} Hz in the last, {intervals} times half its interval: the spring is not linear, or \
         the mass moves in another direction too",
        "die Frequenz wandert in {count} der Ausschwingversuche, am meisten von {first} Hz im ersten \
         Viertel auf {last} Hz im letzten, um das {intervals}-Fache ihres halben Intervalls: Die \
         Feder ist nicht linear, oder die Masse bewegt sich auch anders",
        count = Value::Count(*count),
        first = Value::Number(*first_hz, 4),
        last = Value::Number(*last_hz, 4),
        intervals = Value::Number(*intervals, 0);
    Self::DecaysDamping { count, points, law } =>
        "the damping ratio changes along {count} of the decays, most of all from part to part of \
         one, each at its share of the amplitude: {points}; {law}",
        "der Dämpfungsgrad ändert sich in {count} der Ausschwingversuche, am meisten in einem von \
         Abschnitt zu Abschnitt, je bei seinem Anteil der Amplitude: {points}; {law}",
        count = Value::Count(*count),
        points = Value::list(points),
        law = Value::Message(law);
    Self::DecaysHum { count, frequency_hz, ratio } =>
        "a steady tone beside {count} of the decays, the strongest of {frequency} Hz and {share} of \
         a decay's amplitude, is fitted with them: look for hum of the mains or a fan",
        "ein gleichbleibender Ton neben {count} der Ausschwingversuche, der stärkste mit {frequency} \
         Hz und {share} der Amplitude, ist mit angepasst: nach Netzbrummen oder einem Lüfter suchen",
        count = Value::Count(*count),
        frequency = Value::Number(*frequency_hz, 1),
        share = Value::Percent(*ratio, 1);
    Self::DecaysMode { count, frequency_hz, ratio } =>
        "another mode beside {count} of the decays, the strongest of {frequency} Hz and {share} of a \
         decay's amplitude, is fitted with them",
        "eine weitere Eigenschwingung neben {count} der Ausschwingversuche, die stärkste mit \
         {frequency} Hz und {share} der Amplitude, ist mit angepasst",
        count = Value::Count(*count),
        frequency = Value::Number(*frequency_hz, 1),
        share = Value::Percent(*ratio, 0);
    Self::DecaysBeat { count, first_hz, second_hz, ratio } =>
        "two modes beat in {count} of the decays, of {first} Hz and of {second} Hz with {share} of its \
         amplitude: $f_0$ and $β$ are those of neither; hold the mass so that it moves in one \
         direction alone",
        "zwei Eigenschwingungen schweben in {count} der Ausschwingversuche, eine mit {first} Hz und \
         eine mit {second} Hz und {share} ihrer Amplitude: $f_0$ und $β$ sind keiner von beiden \
         eigen; die Masse so führen, dass sie sich nur in einer Richtung bewegt",
        count = Value::Count(*count),
        first = Value::Number(*first_hz, 3),
        second = Value::Number(*second_hz, 3),
        share = Value::Percent(*ratio, 0);
    Self::DecaysBackground { count, ratio } =>
        "a drift under {count} of the decays, by up to {share} of the amplitude, is fitted with \
         them: let the sensor warm up, or look for what creeps",
        "eine Drift unter {count} der Ausschwingversuche, um bis zu {share} der Amplitude, ist mit \
         angepasst: den Aufnehmer warm werden lassen, oder suchen, was kriecht",
        count = Value::Count(*count),
        share = Value::Percent(*ratio, 0);
    Self::DecaysSlowNoise { count, times } =>
        "slow noise under {count} of the decays, as of a drift or a hum, makes the intervals up to \
         {times} times as wide as the scatter of neighbouring samples would",
        "langsames Rauschen unter {count} der Ausschwingversuche, wie von einer Drift oder einem \
         Brummen, macht die Intervalle bis zu {times}-mal so weit, wie die Streuung benachbarter \
         Werte es täte",
        count = Value::Count(*count),
        times = Value::Number(*times, 0);
    Self::DecaysDiffer { spread } =>
        "the decays' natural frequencies differ by up to {share}: they are not of one oscillator",
        "die Eigenfrequenzen der Ausschwingversuche unterscheiden sich um bis zu {share}: Sie sind \
         nicht die eines Schwingers",
        share = Value::Percent(*spread, 1);
    Self::NoResult { why } => "{why}", "{why}", why = Value::Message(why);
    Self::PublishedSpeedsMet { damping_ratio, deviation } =>
        "with $β$ = {value} the speeds are met within {share}",
        "mit $β$ = {value} sind die Geschwindigkeiten auf {share} getroffen",
        value = Value::Number(*damping_ratio, 4), share = Value::Percent(*deviation, 2);
}
