//! What a method noticed about its data.

use serde::{Deserialize, Serialize};

use super::{Item, Note};
use crate::message::{Message, Value};
use crate::messages;

/// R at one approach speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedPoint {
    /// Approach speed before the impact, m/s.
    pub speed_m_s: f64,
    /// R at this speed.
    pub restitution: f64,
}

/// What a method noticed about its data. Shares and deviations are relative (0.01 is 1 %).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, strum::IntoStaticStr)]
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
    /// R is the same at all speeds.
    RestitutionConstant {
        /// Slowest approach speed, m/s.
        slow_m_s: f64,
        /// Fastest approach speed, m/s.
        fast_m_s: f64,
        /// Change of R between them that the data allow.
        within: f64,
    },
    /// R depends on the speed.
    RestitutionChanges {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
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

impl Message for Remark {
    fn kind(&self) -> &'static str {
        self.into()
    }

    fn english(&self) -> &'static str {
        match self {
            Self::OneDegreeOfFreedom { .. } => {
                "the responses follow one degree of freedom within {share}"
            }
            Self::NotOneDegreeOfFreedom { .. } => {
                "the responses deviate by {share} from the curve of one degree of freedom: there \
                 is more than one resonance, or the damping is not viscous"
            }
            Self::WaveformsUnexplained { .. } => {
                "the simulated waveforms leave {share} of the measured ones unexplained"
            }
            Self::WaveformsThinned { .. } => {
                "waveforms of {some} of {count} periodic records are fitted, evenly chosen"
            }
            Self::StatesDeviate { .. } => {
                "from impact to impact, the states deviate {ratio} times their errors"
            }
            Self::BracketMidpoints { .. } => {
                "plain least squares on the midpoints of the s2 brackets: $R$ = {value} ± {half}"
            }
            Self::RestitutionConstant { .. } => {
                "$R$ is the same from {slow} to {fast} m/s within {change}"
            }
            Self::RestitutionChanges { .. } => {
                "$R$ goes from {first} at {slow} m/s to {last} at {fast} m/s: $R$ depends on the \
                 speed, one constant does not describe it"
            }
            Self::LongContact { .. } => {
                "$R$ goes from {first} at {slow} m/s to {last} at {fast} m/s, and a contact lasts \
                 {count} samples: it is not an instantaneous impact, so one coefficient of \
                 restitution does not describe it"
            }
            Self::OutlyingImpacts { .. } => {
                "impacts with speeds far from those of the others, left out: {count} ({which})"
            }
            Self::DecaysUnexplained { .. } => "the decays leave {share} of the signal unexplained",
            Self::DecaysDiffer { .. } => {
                "the decays' natural frequencies differ by up to {share}: they are not of one \
                 oscillator"
            }
            Self::NoResult { .. } => "{why}",
            Self::PublishedSpeedsMet { .. } => {
                "with $β$ = {value} the speeds are met within {share}"
            }
        }
    }

    fn german(&self) -> &'static str {
        match self {
            Self::OneDegreeOfFreedom { .. } => {
                "die Antworten folgen einem Freiheitsgrad auf {share}"
            }
            Self::NotOneDegreeOfFreedom { .. } => {
                "die Antworten weichen um {share} von der Kurve eines Freiheitsgrads ab: Es gibt \
                 mehr als eine Resonanz, oder die Dämpfung ist nicht zäh"
            }
            Self::WaveformsUnexplained { .. } => {
                "die simulierten Verläufe lassen {share} der gemessenen unerklärt"
            }
            Self::WaveformsThinned { .. } => {
                "angepasst sind die Verläufe von {some} der {count} periodischen Aufzeichnungen, \
                 gleichmäßig gewählt"
            }
            Self::StatesDeviate { .. } => {
                "von Stoß zu Stoß weichen die Zustände um das {ratio}-Fache ihrer Fehler ab"
            }
            Self::BracketMidpoints { .. } => {
                "einfache kleinste Quadrate auf den Mitten der Schranken von s2: $R$ = {value} ± \
                 {half}"
            }
            Self::RestitutionConstant { .. } => {
                "$R$ ist von {slow} bis {fast} m/s gleich, auf {change}"
            }
            Self::RestitutionChanges { .. } => {
                "$R$ geht von {first} bei {slow} m/s auf {last} bei {fast} m/s: $R$ hängt von der \
                 Geschwindigkeit ab, eine Konstante beschreibt es nicht"
            }
            Self::LongContact { .. } => {
                "$R$ geht von {first} bei {slow} m/s auf {last} bei {fast} m/s, und ein Kontakt \
                 dauert {count} Abtastwerte: Es ist kein augenblicklicher Stoß, und eine Stoßzahl \
                 beschreibt ihn nicht"
            }
            Self::OutlyingImpacts { .. } => {
                "Stöße mit Geschwindigkeiten weit von denen der übrigen, ausgelassen: {count} \
                 ({which})"
            }
            Self::DecaysUnexplained { .. } => {
                "die Ausschwingversuche lassen {share} des Signals unerklärt"
            }
            Self::DecaysDiffer { .. } => {
                "die Eigenfrequenzen der Ausschwingversuche unterscheiden sich um bis zu {share} \
                 %: Sie sind nicht die eines Schwingers"
            }
            Self::NoResult { .. } => "{why}",
            Self::PublishedSpeedsMet { .. } => {
                "mit $β$ = {value} sind die Geschwindigkeiten auf {share} getroffen"
            }
        }
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        match self {
            Self::OneDegreeOfFreedom { deviation } => {
                vec![("share", Value::Percent(*deviation, 2))]
            }
            Self::NotOneDegreeOfFreedom { deviation } => {
                vec![("share", Value::Percent(*deviation, 0))]
            }
            Self::WaveformsUnexplained { share } => vec![("share", Value::Percent(*share, 2))],
            Self::WaveformsThinned { fitted, periodic } => vec![
                ("some", Value::Count(*fitted)),
                ("count", Value::Count(*periodic)),
            ],
            Self::StatesDeviate { ratio } => vec![("ratio", Value::Number(*ratio, 1))],
            Self::BracketMidpoints {
                restitution,
                half_width,
            } => vec![
                ("value", Value::Number(*restitution, 3)),
                ("half", Value::Number(*half_width, 3)),
            ],
            Self::RestitutionConstant {
                slow_m_s,
                fast_m_s,
                within,
            } => vec![
                ("slow", Value::Number(*slow_m_s, 3)),
                ("fast", Value::Number(*fast_m_s, 3)),
                ("change", Value::Number(*within, 3)),
            ],
            Self::RestitutionChanges { slower, faster } => change(slower, faster),
            Self::LongContact {
                slower,
                faster,
                samples,
            } => {
                let mut values = change(slower, faster);
                values.push(("count", Value::Number(*samples, 0)));
                values
            }
            Self::OutlyingImpacts { count, first } => {
                let mut which: Vec<Value<'_>> = first.iter().map(|i| Value::Message(i)).collect();
                which.extend((*count > first.len()).then_some(Value::Name("…")));
                vec![
                    ("count", Value::Count(*count)),
                    ("which", Value::List(which)),
                ]
            }
            Self::DecaysUnexplained { share } => vec![("share", Value::Percent(*share, 1))],
            Self::DecaysDiffer { spread } => vec![("share", Value::Percent(*spread, 1))],
            Self::NoResult { why } => vec![("why", Value::Message(why))],
            Self::PublishedSpeedsMet {
                damping_ratio,
                deviation,
            } => vec![
                ("value", Value::Number(*damping_ratio, 4)),
                ("share", Value::Percent(*deviation, 2)),
            ],
        }
    }
}

fn change(slower: &SpeedPoint, faster: &SpeedPoint) -> Vec<(&'static str, Value<'static>)> {
    vec![
        ("first", Value::Number(slower.restitution, 3)),
        ("slow", Value::Number(slower.speed_m_s, 3)),
        ("last", Value::Number(faster.restitution, 3)),
        ("fast", Value::Number(faster.speed_m_s, 3)),
    ]
}
