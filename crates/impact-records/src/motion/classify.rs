//! The type of motion of a record, with its evidence and a confidence.

use serde::{Deserialize, Serialize};

use crate::event::{Detection, Impact};
use crate::motion::alternation::{self, Change};
use crate::motion::aperiodic::Irregularity;
use crate::motion::closure::{self, Count, ImpactClosure, WaveformClosure};
use crate::motion::harmonics;
use crate::motion::kind::Motion;
use crate::motion::settling;
use crate::motion::undetermined::Undetermined;
use crate::signal::ringing;
use crate::signal::whole;

/// Settings of the classification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClassifySettings {
    /// Largest n of z = p/n that is looked for.
    pub most_periods: u32,
    /// Largest p of z = p/n that is believed.
    pub most_impacts: u32,
    /// Waveform closure (relative) up to which a motion counts as periodic, beside its noise.
    pub closed_ratio: f64,
    /// Waveform closure from which on a motion counts as not periodic.
    pub open_ratio: f64,
}

impl Default for ClassifySettings {
    fn default() -> Self {
        Self {
            most_periods: 8,
            most_impacts: 12,
            closed_ratio: 0.02,
            open_ratio: 0.10,
        }
    }
}

/// What the decision rests on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionEvidence {
    /// Drive periods in the record.
    pub periods_observed: f64,
    /// Periods of the motion in the record.
    pub cycles_observed: f64,
    /// Waveform closure at the chosen n (the best one if none was chosen), relative.
    pub waveform_closure: Option<f64>,
    /// Waveform closure of the best shorter period, relative.
    pub shorter_closure: Option<f64>,
    /// Noise of the approach velocity over its root mean square.
    pub noise_ratio: Option<f64>,
    /// Closure of the impacts at the chosen p/n.
    pub impact_closure: Option<ImpactClosure>,
    /// Fraction of windows of n periods that hold p impacts.
    pub count_agreement: Option<f64>,
    /// What dies away while the motion is recorded, over the waveform's root mean square; `None` of a
    /// motion that has settled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settling: Option<f64>,
    /// The same of what grows, as by chance it does as often as it dies away where a motion wanders: R scatters from
    /// impact to impact, or the drive is unsteady.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growing: Option<f64>,
    /// Number of impacts in the record.
    pub impacts: usize,
    /// Times at which the masses come as close as at the impacts and no jump of velocity shows.
    #[serde(default, skip_serializing_if = "is_none_at_all")]
    pub touches: usize,
    /// Measures that distinguish a beat from chaos, if the motion does not close.
    pub irregularity: Option<Irregularity>,
}

fn is_none_at_all(count: &usize) -> bool {
    *count == 0
}

/// A motion type with its evidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Classification {
    /// The motion.
    pub motion: Motion,
    /// Between 0 and 1; from 0.9 on the program counts as sure.
    pub confidence: f64,
    /// What it rests on.
    pub evidence: MotionEvidence,
}

impl Classification {
    /// p and n of a periodic motion (0/1 for the impactless one).
    pub fn impacts_and_periods(&self) -> Option<(u32, u32)> {
        match self.motion {
            Motion::Impactless => Some((0, 1)),
            Motion::Periodic {
                impacts_p,
                periods_n,
                ..
            } => Some((impacts_p, periods_n)),
            _ => None,
        }
    }
}

pub(super) fn undetermined(reason: Undetermined, evidence: MotionEvidence) -> Classification {
    Classification {
        motion: Motion::Undetermined { reason },
        confidence: 0.0,
        evidence,
    }
}

/// Classify the motion of a record of `duration_s` from what was detected in it; the crate's example does so.
pub fn classify(
    detection: &Detection,
    duration_s: f64,
    settings: &ClassifySettings,
) -> Classification {
    let mut evidence = MotionEvidence {
        impacts: detection.impacts.len(),
        touches: detection.unsupported_touches,
        ..MotionEvidence::default()
    };
    let Some(drive) = &detection.drive else {
        return undetermined(Undetermined::NoDrive, evidence);
    };
    let period_s = drive.period_s();
    evidence.periods_observed = duration_s / period_s;
    if evidence.periods_observed < 2.0 {
        return undetermined(Undetermined::FewerThanTwoPeriods, evidence);
    }
    let View {
        closures,
        noise_ratio,
        rest,
    } = View::of(detection, period_s, settings);
    evidence.noise_ratio = noise_ratio;
    if rest && detection.closed_fraction > 0.9 {
        return Classification {
            motion: Motion::Sticking,
            confidence: 0.95,
            evidence,
        };
    }
    let case = Case {
        detection,
        period_s,
        duration_s,
        noise: noise_ratio.unwrap_or(0.0),
        settings,
    };
    match closures.as_slice() {
        [] => case.by_impacts_alone(evidence),
        closures => case.by_waveform(closures, evidence),
    }
}

/// The waveform's closures as far as the record reaches.
struct View {
    closures: Vec<WaveformClosure>,
    noise_ratio: Option<f64>,
    rest: bool,
}

impl View {
    fn of(detection: &Detection, period_s: f64, settings: &ClassifySettings) -> Self {
        let Some(velocity) = &detection.kinematics.waveform else {
            return Self {
                closures: Vec::new(),
                noise_ratio: None,
                rest: false,
            };
        };
        let rate_hz = detection.kinematics.rate_hz;
        let times: Vec<f64> = detection
            .impacts
            .iter()
            .map(|i| i.time_s * rate_hz)
            .collect();
        let of_jump = [detection.jump_samples as f64 + 1.5; 2];
        let period = period_s * rate_hz;
        let periods = velocity.values.len() as f64 / period;
        // At least three drive periods, or as many again, must overlap.
        let reach = whole::count((periods - 3.0).max(0.5 * periods).floor().max(1.0));
        let most = settings.most_periods.min(reach);
        let size = |guard| closure::size(&velocity.values, &times, guard);
        let first = size(of_jump);
        let [before, after] = ringing::beside_impacts(&velocity.values, &times, first);
        let guard = [of_jump[0].max(before), of_jump[1].max(after)];
        let level = if guard == of_jump { first } else { size(guard) };
        Self {
            closures: closures_beside_hum(&velocity.values, period, &times, guard, most, rate_hz),
            noise_ratio: (level > 0.0).then(|| velocity.noise / level),
            rest: level < 3.0 * velocity.noise,
        }
    }
}

/// Frequencies of the mains and of what a rectifier makes of them, Hz.
const MAINS_HZ: [f64; 6] = [50.0, 60.0, 100.0, 120.0, 150.0, 180.0];

/// The closures of a waveform; where one drive period is not the best, without hum.
fn closures_beside_hum(
    values: &[f64],
    period: f64,
    impacts: &[f64],
    guard: [f64; 2],
    most: u32,
    rate_hz: f64,
) -> Vec<WaveformClosure> {
    let closures = closure::waveform(values, period, impacts, guard, most, &[]);
    if closures
        .first()
        .is_some_and(|first| first.ratio <= slack(&closures))
    {
        return closures;
    }
    let below = |f: &f64| *f < 0.5 * rate_hz;
    let hum: Vec<f64> = MAINS_HZ
        .into_iter()
        .filter(below)
        .map(|f| f / rate_hz)
        .collect();
    closure::waveform(values, period, impacts, guard, most, &hum)
}

/// Up to what ratio a motion closes about as well as at its best: white noise leaves a few per cent of
/// scatter between the ratios, and interpolation a little more.
fn slack(closures: &[WaveformClosure]) -> f64 {
    let ratios = closures.iter().map(|c| c.ratio);
    1.12 * ratios.fold(f64::INFINITY, f64::min) + 1e-4
}

/// Closings of the contact in a drive period from which they may be the impacts of a motion that noise hides: z = 1/5 has as many.
const OF_IMPACTS: f64 = 0.2;

/// Confidence in a motion beside what a longer period would have closed by: it is not certain to die away.
const ALTERNATES: f64 = 0.8;

/// The closure that a motion is named by.
struct Choice<'c> {
    chosen: &'c WaveformClosure,
    /// The alternation that dies away, and that grows, over the waveform's root mean square, where it does not close within half
    /// the period.
    dying: Option<f64>,
    growing: Option<f64>,
    /// Confidence as far as it rests on the choice.
    sure: f64,
}

/// One record under decision.
struct Case<'a> {
    detection: &'a Detection,
    period_s: f64,
    duration_s: f64,
    noise: f64,
    settings: &'a ClassifySettings,
}

impl Case<'_> {
    fn by_waveform(
        &self,
        closures: &[WaveformClosure],
        mut evidence: MotionEvidence,
    ) -> Classification {
        let closed = (2.5 * self.noise).max(self.settings.closed_ratio);
        let Some(choice) = self.choice(closures, closed) else {
            return undetermined(Undetermined::NotComparable, evidence);
        };
        let chosen = choice.chosen;
        evidence.waveform_closure = Some(chosen.ratio);
        evidence.shorter_closure = closures
            .iter()
            .filter(|c| c.periods_n < chosen.periods_n)
            .map(|c| c.ratio)
            .reduce(f64::min);
        let open = (5.0 * self.noise).max(self.settings.open_ratio);
        let impacts = &self.detection.impacts;
        let early = impacts.iter().all(|i| i.time_s < 0.5 * self.duration_s);
        let calm = early && !impacts.is_empty();
        evidence.settling =
            settling::disturbance(closures, chosen, closed, evidence.periods_observed, calm)
                .or(choice.dying);
        let reversed: Vec<WaveformClosure> =
            closures.iter().map(WaveformClosure::reversed).collect();
        evidence.growing = settling::disturbance(
            &reversed,
            &chosen.reversed(),
            closed,
            evidence.periods_observed,
            false,
        )
        .or(choice.growing);
        if evidence.settling.is_some() && (chosen.periods_n > 1 || chosen.ratio > closed) {
            return undetermined(Undetermined::NotSettled, evidence);
        }
        if chosen.ratio > closed && impacts.is_empty() && self.has_harmonics_of_impacts() {
            return undetermined(Undetermined::HarmonicsWithoutImpact, evidence);
        }
        if chosen.ratio > open {
            return self.aperiodic(evidence);
        }
        if chosen.ratio > closed {
            return undetermined(
                Undetermined::NearlyCloses {
                    periods_n: chosen.periods_n,
                },
                evidence,
            );
        }
        let quality = choice.sure / (1.0 + (chosen.ratio / closed).powi(6));
        self.periodic(chosen.periods_n, quality, evidence)
    }

    /// The closure that the motion is named by: of the smallest n that closes about as well as any, or by what is not worth a
    /// name, as a doubled motion whose parts differ by less lies closer to its doubling than settings are set. Where it
    /// alternates and that dies away, it is that of half the period, if the waveform closes there.
    fn choice<'c>(&self, closures: &'c [WaveformClosure], closed: f64) -> Option<Choice<'c>> {
        let slack = slack(closures);
        let close = |c: &&WaveformClosure| c.ratio <= slack.max(settling::LEAST);
        let best = closures.iter().find(close)?;
        let half = closures
            .iter()
            .find(|c| 2 * c.periods_n == best.periods_n && self.has_two_impacts(best));
        let change = half.and_then(|_| alternation::change(&self.detection.impacts));
        let dying = half.filter(|_| change == Some(Change::Dies));
        let growing = half.filter(|_| change == Some(Change::Grows));
        let chosen = dying.filter(|half| half.ratio <= closed).unwrap_or(best);
        let alternates = chosen.ratio > slack || dying.is_some();
        let open = |half: &WaveformClosure| Some(half.ratio).filter(|size| *size > closed);
        Some(Choice {
            chosen,
            dying: dying.and_then(open),
            growing: growing.and_then(open),
            sure: if alternates { ALTERNATES } else { 1.0 },
        })
    }

    /// Whether two impacts fall into the period after which a waveform closes.
    fn has_two_impacts(&self, closure: &WaveformClosure) -> bool {
        let count = self.count(closure.periods_n);
        count.is_some_and(|count| count.impacts_p == 2)
    }

    /// Without velocity: the smallest n for which the impact times close.
    fn by_impacts_alone(&self, mut evidence: MotionEvidence) -> Classification {
        let impacts = &self.detection.impacts;
        if impacts.is_empty() {
            return undetermined(Undetermined::NoMotion, evidence);
        }
        let limit = 0.05f64.max(3.0 * self.timing_noise_rad());
        let reach = whole::count((0.5 * evidence.periods_observed).floor());
        for n in 1..=self.settings.most_periods.min(reach.max(1)) {
            let Some(count) = self.count(n) else { continue };
            let closure = closure::impacts(impacts, self.period_s, count.impacts_p, n);
            if closure.is_some_and(|c| c.phase_rad <= limit && c.pairs >= 2) {
                return self.periodic(n, 0.9, evidence);
            }
        }
        evidence.irregularity = Irregularity::of(impacts, self.period_s, self.duration_s);
        undetermined(Undetermined::NoPeriodOfImpacts, evidence)
    }

    fn timing_noise_rad(&self) -> f64 {
        let errors: Vec<f64> = self
            .detection
            .impacts
            .iter()
            .map(|i| i.time_error_s)
            .collect();
        crate::signal::robust::rms(&errors) * 2f64.sqrt() * std::f64::consts::TAU / self.period_s
    }

    fn count(&self, periods_n: u32) -> Option<Count> {
        let times: Vec<f64> = self.detection.impacts.iter().map(|i| i.time_s).collect();
        closure::count(&times, self.period_s, self.duration_s, periods_n)
    }

    /// The waveform (or the impact times) close after n periods: count the impacts in them.
    fn periodic(
        &self,
        periods_n: u32,
        quality: f64,
        mut evidence: MotionEvidence,
    ) -> Classification {
        evidence.cycles_observed = evidence.periods_observed / f64::from(periods_n);
        let Some(count) = self.count(periods_n) else {
            return undetermined(Undetermined::NoWholePeriod, evidence);
        };
        evidence.count_agreement = Some(count.agreement);
        if count.impacts_p == 0 {
            return self.impactless(periods_n, count, quality, evidence);
        }
        if count.impacts_p > self.settings.most_impacts {
            let reason = Undetermined::TooManyImpacts {
                periods_n,
                impacts_p: count.impacts_p,
                most: self.settings.most_impacts,
            };
            return undetermined(reason, evidence);
        }
        let closure = closure::impacts(
            &self.detection.impacts,
            self.period_s,
            count.impacts_p,
            periods_n,
        );
        evidence.impact_closure = closure;
        let limit = 0.1f64.max(4.0 * self.timing_noise_rad());
        let steady = closure.is_none_or(|c| c.phase_rad <= limit);
        if count.agreement < 0.6 || !steady {
            let reason = Undetermined::ImpactsDoNotRepeat { periods_n };
            return undetermined(reason, evidence);
        }
        let motion = Motion::Periodic {
            impacts_p: count.impacts_p,
            periods_n,
            dead_zone: has_dead_zone(&self.detection.impacts),
        };
        let confidence = quality
            * count.agreement.powi(2)
            * cycles_factor(evidence.cycles_observed)
            * self.hidden_factor(&evidence)
            * shorter_factor(&evidence);
        Classification {
            motion,
            confidence,
            evidence,
        }
    }

    /// Each touch, and each closing of the contact, without a jump may be an impact that noise hides.
    fn hidden_factor(&self, evidence: &MotionEvidence) -> f64 {
        let impacts = evidence.impacts as f64;
        let hidden = evidence.touches.max(self.detection.unsupported_pulses) as f64;
        impacts / (impacts + hidden).max(1.0)
    }

    fn impactless(
        &self,
        periods_n: u32,
        count: Count,
        quality: f64,
        evidence: MotionEvidence,
    ) -> Classification {
        if periods_n > 1 && evidence.shorter_closure > evidence.waveform_closure.map(|c| 2.0 * c) {
            return undetermined(Undetermined::RepeatsWithoutImpact { periods_n }, evidence);
        }
        if self.has_harmonics_of_impacts() {
            return undetermined(Undetermined::HarmonicsWithoutImpact, evidence);
        }
        let pulses = self.detection.unsupported_pulses;
        let share = pulses as f64 / evidence.periods_observed;
        if share > OF_IMPACTS {
            return undetermined(Undetermined::ContactAlone { pulses }, evidence);
        }
        let confidence = quality * count.agreement.powi(2) * (1.0 - share);
        Classification {
            motion: Motion::Impactless,
            confidence,
            evidence,
        }
    }

    /// Whether the motion has the harmonics of impacts, be they found or not.
    fn has_harmonics_of_impacts(&self) -> bool {
        let kinematics = &self.detection.kinematics;
        let velocity = kinematics.relative.velocity.as_ref();
        let period = self.period_s * kinematics.rate_hz;
        velocity.is_some_and(|v| harmonics::are_of_impacts(v, period))
    }

    fn aperiodic(&self, mut evidence: MotionEvidence) -> Classification {
        let impacts = &self.detection.impacts;
        if impacts.is_empty() {
            return undetermined(Undetermined::SettlingWithoutImpact, evidence);
        }
        evidence.irregularity = Irregularity::of(impacts, self.period_s, self.duration_s);
        let Some(irregularity) = evidence.irregularity else {
            return undetermined(Undetermined::FewImpacts, evidence);
        };
        let motion = if irregularity.is_beat() {
            Motion::Beat
        } else {
            Motion::Chaotic
        };
        let seen = (evidence.periods_observed / 8.0).min(1.0);
        let open = evidence.waveform_closure.unwrap_or(0.0) / self.settings.open_ratio;
        let confidence = 0.9 * seen * (1.0 - (-open).exp());
        Classification {
            motion,
            confidence,
            evidence,
        }
    }
}

fn has_dead_zone(impacts: &[Impact]) -> bool {
    let with = impacts.iter().filter(|i| i.dead_zone_s > 0.0).count();
    2 * with >= impacts.len().max(1)
}

/// One period and a half of the motion must be seen; two are enough.
fn cycles_factor(cycles: f64) -> f64 {
    ((cycles - 1.0) / 0.8).clamp(0.0, 1.0)
}

/// A longer period must close clearly better than every shorter one.
fn shorter_factor(evidence: &MotionEvidence) -> f64 {
    match (evidence.shorter_closure, evidence.waveform_closure) {
        (Some(shorter), Some(chosen)) => {
            ((shorter / chosen.max(1e-12) - 1.0) / 0.6).clamp(0.3, 1.0)
        }
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::{DetectSettings, DriveTone, Kinematics, RigKind, detect};
    use crate::record::{Record, Role};

    const PERIOD_S: f64 = 0.1;
    const SAMPLES: usize = 2000;
    const RATE_HZ: f64 = 2000.0;

    /// What was detected in a second of a drive at 10 Hz, with a velocity if one is given.
    fn detection(impacts: Vec<Impact>, velocity: Option<&dyn Fn(f64) -> f64>) -> Detection {
        let values = velocity.map(|of| {
            let turns = (0..SAMPLES).map(|i| i as f64 / RATE_HZ / PERIOD_S);
            turns.map(of).collect::<Vec<f64>>()
        });
        let channels = values.iter().map(|v| (Role::VelocityX, v.as_slice()));
        let record = Record::of(RATE_HZ, &channels.collect::<Vec<_>>());
        Detection {
            drive: Some(DriveTone {
                frequency_hz: 1.0 / PERIOD_S,
                frequency_error_hz: 1e-6,
                amplitude: 1.0,
                phase_rad: 0.0,
                residual_ratio: 0.0,
            }),
            kinematics: Kinematics::of(&record, RigKind::Single, 1),
            impacts,
            jump_samples: 1,
            unsupported_pulses: 0,
            missed_pulses: 0,
            unsupported_touches: 0,
            closed_fraction: 0.0,
            lags: Vec::new(),
            directions: Vec::new(),
            flags: Vec::new(),
            ringing: None,
        }
    }

    /// Impacts at these drive periods, with these speeds.
    fn at(list: impl IntoIterator<Item = (f64, f64)>) -> Vec<Impact> {
        let impact = |(turns, speed): (f64, f64)| Impact::at(PERIOD_S * turns, speed);
        list.into_iter().map(impact).collect()
    }

    fn of(detection: &Detection) -> Classification {
        classify(
            detection,
            SAMPLES as f64 / RATE_HZ,
            &ClassifySettings::default(),
        )
    }

    fn label(impacts: Vec<Impact>, velocity: Option<&dyn Fn(f64) -> f64>) -> String {
        of(&detection(impacts, velocity)).motion.label()
    }

    const TURN: f64 = std::f64::consts::TAU;

    #[test]
    fn hand_made_sequences_of_impacts_alone() {
        let every = |step: f64, speed: f64| move |k: i32| (0.3 + step * f64::from(k), speed);
        assert_eq!(label(at((0..10).map(every(1.0, 1.0))), None), "1");
        assert_eq!(label(at((0..5).map(every(2.0, 1.0))), None), "1/2");
        // Two impacts in one period; two in two periods at unequal distances.
        let pair = |k: i32| [(f64::from(k) + 0.2, 1.0), (f64::from(k) + 0.6, 0.7)];
        assert_eq!(label(at((0..10).flat_map(pair)), None), "2/1");
        let doubled = |k: i32| [(f64::from(2 * k) + 0.2, 1.0), (f64::from(2 * k) + 1.4, 0.7)];
        assert_eq!(label(at((0..5).flat_map(doubled)), None), "2/2");
        let irregular = [0.3, 1.7, 2.1, 3.9, 4.4, 6.2, 6.8, 8.5, 9.4].map(|t| (t, 1.0));
        assert_eq!(label(at(irregular), None), "undetermined");
        assert_eq!(label(Vec::new(), None), "undetermined");
    }

    #[test]
    fn a_dead_zone_after_most_impacts_marks_the_motion() {
        let mut impacts = at((0..10).map(|k| (0.3 + f64::from(k), 1.0)));
        for impact in &mut impacts[..4] {
            impact.dead_zone_s = 0.01;
        }
        assert_eq!(label(impacts.clone(), None), "1");
        impacts[4].dead_zone_s = 0.01;
        assert_eq!(label(impacts, None), "1j");
    }

    #[test]
    fn valid_waveforms_with_their_impacts() {
        let tone = |t: f64| (TURN * t).cos();
        let sub = |t: f64| (TURN * t).cos() + 0.3 * (0.5 * TURN * t).sin();
        let once = || at((0..10).map(|k| (0.3 + f64::from(k), 1.0)));
        assert_eq!(label(Vec::new(), Some(&tone)), "0");
        assert_eq!(label(once(), Some(&tone)), "1");
        let half = at((0..5).map(|k| (0.3 + 2.0 * f64::from(k), 1.0)));
        assert_eq!(label(half, Some(&sub)), "1/2");
        // A subharmonic without any impact is not believed: an impact was too slow to see.
        assert_eq!(label(Vec::new(), Some(&sub)), "undetermined");
        let sure = of(&detection(once(), Some(&tone)));
        assert!(sure.confidence > 0.9, "{}", sure.confidence);
        assert!(sure.evidence.waveform_closure.unwrap() < 1e-3);
    }

    #[test]
    fn valid_beats_swell_and_chaos_does_not() {
        // Two tones of an irrational ratio never close within eight periods.
        let open = |t: f64| (TURN * t).cos() + 0.8 * (TURN * t * 2f64.sqrt() / 1.3).sin();
        let swelling = [0.2, 0.5, 0.9, 1.2, 1.0, 0.6, 0.3];
        let bursts = |begin: f64| {
            let speeds = swelling.into_iter().enumerate();
            speeds.map(move |(i, v)| (begin + 0.5 * i as f64 + 0.1, v))
        };
        assert_eq!(
            label(at(bursts(0.0).chain(bursts(5.0))), Some(&open)),
            "beat"
        );
        let speeds = [0.9, 0.1, 0.6, 0.2, 1.0, 0.3, 0.8, 0.1, 0.7];
        let chaos = speeds.into_iter().enumerate();
        let chaos = at(chaos.map(|(i, v)| (1.07 * i as f64 + 0.2, v)));
        assert_eq!(label(chaos, Some(&open)), "chaotic");
        assert_eq!(
            label(at([(0.3, 1.0), (4.1, 0.2)]), Some(&open)),
            "undetermined"
        );
    }

    #[test]
    fn without_a_drive_or_with_too_few_periods_nothing_is_decided() {
        let mut without = detection(at([(0.3, 1.0)]), None);
        without.drive = None;
        assert_eq!(of(&without).motion.label(), "undetermined");
        let with = detection(at([(0.3, 1.0)]), None);
        let short = classify(&with, 1.9 * PERIOD_S, &ClassifySettings::default());
        assert_eq!(short.motion.label(), "undetermined");
    }

    /// A second of a contact that closes twice in each of ten drive periods.
    fn two_pulses_a_period() -> Record {
        let phase = |i: usize| TURN * i as f64 / 200.0;
        let drive: Vec<f64> = (0..2000).map(|i| phase(i).cos()).collect();
        let closed = |i: usize| matches!(i % 200, 20..23 | 95..98);
        let contact: Vec<f64> = (0..2000)
            .map(|i| if closed(i) { 5.0 } else { 0.0 })
            .collect();
        Record::of(2000.0, &[(Role::Drive, &drive), (Role::Contact, &contact)])
    }

    #[test]
    fn more_impacts_than_are_looked_for_are_undetermined() {
        let record = two_pulses_a_period();
        let detection = detect(&record, RigKind::Double, &DetectSettings::default());
        let looked_for = |most_impacts: u32| {
            let settings = ClassifySettings {
                most_impacts,
                ..ClassifySettings::default()
            };
            classify(&detection, record.duration_s(), &settings)
        };
        assert_eq!(looked_for(2).impacts_and_periods(), Some((2, 1)));
        let Motion::Undetermined { reason } = looked_for(1).motion else {
            panic!("believed");
        };
        assert!(matches!(
            reason,
            Undetermined::TooManyImpacts { most: 1, .. }
        ));
    }
}
