//! The summary of a record that is kept: its motion, its impacts and the numbers that the
//! identification needs, without the samples.

use std::sync::Arc;

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::event::{
    ChannelLag, DetectSettings, DriveTone, FlightKind, Impact, JumpDirections, RigKind, calmed,
    detect, detect_at, of_motion,
};
use crate::motion::classify::{Classification, ClassifySettings, classify, undetermined};
use crate::motion::fold::{Folded, fold};
use crate::motion::force_law::ForceLaw;
use crate::motion::kind::Motion;
use crate::motion::late_channel::LateChannel;
use crate::motion::no_decay::cause;
use crate::motion::response::{Response, responses};
use crate::motion::undetermined::Undetermined;
use crate::record::{Channel, Excitation, Flag, FlagCode, Problem, Record, Role, Setting};
use crate::signal::decay::{self, Decay, Rails, Watched};
use crate::signal::{columns, robust};

/// Greatest and least value of a motion channel, SI, about its mean.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Amplitude {
    /// Which channel.
    pub role: Role,
    /// Half the difference of greatest and least sample, SI.
    pub half_range: f64,
    /// Root mean square about the mean, SI.
    pub rms: f64,
}

/// A record as observed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// The record's name.
    pub record: String,
    /// The stated setting.
    pub setting: Setting,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// Duration, s.
    pub duration_s: f64,
    /// The drive as measured.
    pub drive: Option<DriveTone>,
    /// The tone that the motion has at the stated frequency of a drive that was not recorded: its
    /// frequency is the drive's, its phase is not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_tone: Option<DriveTone>,
    /// The motion and its evidence.
    #[serde(rename = "finding")]
    pub classification: Classification,
    /// The impacts.
    pub impacts: Vec<Impact>,
    /// Contact pulses without a jump of velocity.
    pub unsupported_pulses: usize,
    /// Impacts that the contact channel missed.
    pub missed_pulses: usize,
    /// Samples in which impacts are looked for that a jump of velocity takes by its contact.
    pub jump_samples: usize,
    /// Whether a motion channel has passed a low-pass, so that the speeds at impacts are not those of flights.
    #[serde(default)]
    pub low_pass: bool,
    /// Whether the motion was smoothed because it rings beside impacts.
    #[serde(default)]
    pub smoothed: bool,
    /// How much later than the contact or the other mass the channels show impacts, where that may matter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lags: Vec<ChannelLag>,
    /// Ways in which the velocities of the masses jump, where that may matter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<JumpDirections>,
    /// Channels that were found late, beyond what is stated, or of the other sign; their samples have been corrected.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub late: Vec<LateChannel>,
    /// The law by which the driving force was found to change with the frequency; the drive amplitude follows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_law: Option<ForceLaw>,
    /// Amplitudes of the motion channels.
    pub amplitudes: Vec<Amplitude>,
    /// Response at the drive's frequency; only of impactless records.
    pub response: Vec<Response>,
    /// The folded waveform; only of periodic records with one impact in n drive periods.
    #[serde(default, with = "shared")]
    pub folded: Option<Arc<Folded>>,
    /// The free decays, one after each blow or release; only of records without drive and impacts.
    #[serde(default)]
    pub decays: Vec<Decay>,
    /// Problems found.
    pub flags: Vec<Flag>,
}

impl Observation {
    /// The drive, else the motion's tone at its stated frequency.
    pub fn tone(&self) -> Option<DriveTone> {
        self.drive.or(self.motion_tone)
    }

    /// Measured drive frequency, Hz; the stated one if the drive was not recorded.
    pub fn frequency_hz(&self) -> Option<f64> {
        self.tone()
            .map(|d| d.frequency_hz)
            .or(self.setting.stated_frequency_hz)
    }

    /// Standard error of the measured phase of the drive at the middle of the record, rad: that of
    /// a tone with white noise in as many samples. Zero if the drive was not recorded.
    pub fn drive_phase_error_rad(&self) -> f64 {
        let samples = (self.duration_s * self.sample_rate_hz).max(1.0);
        self.drive
            .map_or(0.0, |d| d.residual_ratio * (2.0 / samples).sqrt())
    }

    /// Whether the record must stay out of the identification.
    pub fn excluded(&self) -> bool {
        self.flags.iter().any(|f| f.excludes)
    }

    /// Whether it has a flag of a code.
    pub fn has_flag(&self, code: FlagCode) -> bool {
        self.flags.iter().any(|f| f.code == code)
    }

    /// The channel that the speed of a mass at impacts comes from.
    pub fn speed_from(&self, of_y: bool) -> Option<Role> {
        let roles = if of_y {
            [Role::VelocityY, Role::DisplacementY, Role::AccelerationY]
        } else {
            [Role::VelocityX, Role::DisplacementX, Role::AccelerationX]
        };
        let measured = |role: &Role| self.amplitudes.iter().any(|a| a.role == *role);
        roles.into_iter().find(measured)
    }

    /// Whether speeds at impacts come from accelerations whose spikes are clipped: an offset of such a channel cannot
    /// be told from what its spikes lack.
    pub fn speeds_lack_spikes(&self) -> bool {
        let from = [self.speed_from(false), self.speed_from(true)];
        let mut from = from.iter().flatten();
        self.has_flag(FlagCode::Clipped)
            && from.any(|r| matches!(r, Role::AccelerationX | Role::AccelerationY))
    }

    /// How much later a displacement is than the velocity of the same mass, by their responses, s: less than half a
    /// period.
    pub(super) fn lag_s(&self, displacement: Role, velocity: Role) -> Option<f64> {
        let of = |role| {
            let found = self.response.iter().find(|r| r.role == role)?;
            Some(Complex::new(found.real, found.imaginary))
        };
        let rate = std::f64::consts::TAU * self.tone()?.frequency_hz;
        let turned = of(displacement)? * Complex::i() * of(velocity)?.conj();
        (turned.norm() > 0.0).then(|| -turned.arg() / rate)
    }

    /// The observation without what takes room: impacts, amplitudes, responses, waveform and decays.
    #[must_use]
    pub fn outline(&self) -> Self {
        Self {
            record: self.record.clone(),
            setting: self.setting.clone(),
            classification: self.classification.clone(),
            flags: self.flags.clone(),
            impacts: Vec::new(),
            lags: Vec::new(),
            directions: Vec::new(),
            late: self.late.clone(),
            amplitudes: Vec::new(),
            response: Vec::new(),
            folded: None,
            decays: Vec::new(),
            ..*self
        }
    }

    /// The force at the record's frequency over that to which its law refers: 1 without a law.
    pub(super) fn force_factor(&self) -> f64 {
        let factor = |law: ForceLaw| Some(law.factor(self.frequency_hz()?));
        self.force_law.and_then(factor).unwrap_or(1.0)
    }

    /// The drive amplitude as stated or measured, relative to the nominal one, without the law of the force.
    pub fn stated_drive(&self) -> f64 {
        self.setting.drive_amplitude / self.force_factor()
    }

    /// The measured drive amplitude with the stated one that it contradicts, if it does.
    fn contradicted_drive(&self) -> Option<(f64, f64)> {
        self.flags.iter().find_map(|flag| match flag.problem {
            Problem::AmplitudeUnlikeStated { measured, stated } => Some((measured, stated)),
            _ => None,
        })
    }

    /// Whether its drive amplitude is the stated one though the measured one contradicts it.
    pub fn drives_as_stated(&self) -> bool {
        let used = self.stated_drive();
        self.contradicted_drive()
            .is_some_and(|(measured, stated)| (used - stated).abs() < (used - measured).abs())
    }

    /// The free decay that determines f0 best.
    pub fn best_decay(&self) -> Option<&Decay> {
        decay::best(&self.decays)
    }

    /// Whether no impact was detected.
    fn shows_no_impact(&self) -> bool {
        self.impacts.is_empty()
            && self.unsupported_pulses == 0
            && matches!(
                self.classification.motion,
                Motion::Impactless | Motion::Undetermined { .. }
            )
    }

    /// Whether the masses never touched: no impact was detected and nothing indicates one. Motion
    /// that is not harmonic widens the error of such a record's response.
    fn has_no_impact(&self) -> bool {
        self.shows_no_impact()
            && !matches!(
                self.classification.motion,
                Motion::Undetermined {
                    reason: Undetermined::HarmonicsWithoutImpact
                        | Undetermined::RepeatsWithoutImpact { .. }
                }
            )
    }

    /// Whether the motion is z = 1/n without a dead zone; gives n.
    pub fn one_impact_in(&self) -> Option<u32> {
        match self.classification.motion {
            Motion::Periodic {
                impacts_p: 1,
                periods_n,
                dead_zone: false,
            } => Some(periods_n),
            _ => None,
        }
    }
}

/// Observe one record: detect, classify, and keep what the identification needs.
pub fn observe(
    record: &Record,
    rig: RigKind,
    detecting: &DetectSettings,
    classifying: &ClassifySettings,
) -> Observation {
    let decays = record.setting.excitation == Excitation::FreeDecay;
    if (decays || detecting.flight == FlightKind::ConstantForce) && record.has_gaps() {
        let of_part = |part: &Record| observe(part, rig, detecting, classifying);
        return observe_parts(record, of_part);
    }
    if decays {
        return observe_decay(record);
    }
    let first = detect(record, rig, detecting);
    let calm = calmed(record, &first, |smooth| {
        detect_at(smooth, rig, detecting, Some(&first))
    });
    let (calm, mut detection) = calm.map_or((None, first), |(calm, found)| (Some(calm), found));
    let record = calm.as_ref().unwrap_or(record);
    let drive = detection.drive;
    let motion = detection.kinematics.waveform.as_ref();
    let motion_tone = motion
        .filter(|_| drive.is_none() && detecting.flight == FlightKind::Harmonic)
        .and_then(|motion| of_motion(record, &motion.values, detection.kinematics.rate_hz));
    detection.drive = drive.or(motion_tone);
    let classification = classify(&detection, record.duration_s(), classifying);
    let mut flags = record.flags.clone();
    flags.append(&mut detection.flags);
    let mut flags = without_what_follows(record, flags);
    flags.extend(contact_flag(
        record,
        &detection.impacts,
        detection.unsupported_pulses,
    ));
    let mut observation = Observation {
        drive,
        motion_tone,
        impacts: detection.impacts.clone(),
        unsupported_pulses: detection.unsupported_pulses,
        missed_pulses: detection.missed_pulses,
        jump_samples: detection.contact_samples(),
        lags: detection.lags.clone(),
        directions: detection.directions.clone(),
        flags,
        classification,
        ..undriven(record)
    };
    if observation.shows_no_impact() && detecting.flight == FlightKind::Harmonic {
        observation.flags.extend(beyond_stop(record, rig));
    }
    if let Some(tone) = observation.tone().filter(|_| observation.has_no_impact()) {
        // within less than a period a tone is hardly told from a line
        if record.duration_s() * tone.frequency_hz >= 1.0 {
            observation.response = responses(record, &tone);
        }
    } else if let (Some(drive), Some(n)) = (drive, observation.one_impact_in()) {
        observation.folded = Some(Arc::new(fold(record, rig, &detection, &drive, n)));
    }
    observation
}

/// Observe what lies between the gaps of a record: the impacts and decays of all parts, in the time of the record. Where
/// none has any, the longest part shows why.
fn observe_parts(record: &Record, of_part: impl Fn(&Record) -> Observation) -> Observation {
    let rate_hz = record.sample_rate_hz;
    let mut observed: Vec<Observation> = Vec::new();
    for (first, part) in record.between_gaps() {
        let mut found = of_part(&part);
        let later_s = first as f64 / rate_hz;
        found.impacts.iter_mut().for_each(|i| i.time_s += later_s);
        found
            .decays
            .iter_mut()
            .for_each(|d| d.shift(first, rate_hz));
        observed.push(found);
    }
    let shows = |o: &Observation| !(o.impacts.is_empty() && o.decays.is_empty());
    if observed.iter().any(shows) {
        observed.retain(shows);
    }
    let longest = observed
        .iter()
        .max_by(|a, b| a.duration_s.total_cmp(&b.duration_s));
    let mut whole = longest.map_or_else(|| undriven(record), Observation::outline);
    whole.duration_s = record.duration_s();
    whole.flags.clone_from(&record.flags);
    for found in observed {
        let told = found.flags.into_iter().filter(|f| !whole.flags.contains(f));
        let told: Vec<Flag> = told.collect();
        whole.flags.extend(told);
        whole.impacts.extend(found.impacts);
        whole.decays.extend(found.decays);
        if whole.amplitudes.is_empty() {
            whole.amplitudes = found.amplitudes;
        }
    }
    whole
}

/// By how much a displacement goes farther than the clearance lets it before that is a contradiction: gains,
/// drift and noise do a little.
const BEYOND: f64 = 1.1;

/// A motion that shows no impact although its displacement, about its middle, goes farther than the stop or the
/// other mass lets it.
fn beyond_stop(record: &Record, rig: RigKind) -> Option<Flag> {
    let clearance_m = record.setting.clearance_m.filter(|c| *c > 0.0)?;
    let x = record.channel(Role::DisplacementX)?;
    let together: Vec<f64> = match rig {
        RigKind::Single => x.values.clone(),
        RigKind::Double => {
            let y = record.values(Role::DisplacementY)?;
            x.values.iter().zip(y).map(|(x, y)| 0.5 * (x + y)).collect()
        }
    };
    let (low, high) = robust::range(together)?;
    let reached_m = 0.5 * (high - low);
    (reached_m > BEYOND * clearance_m).then(|| {
        let problem = match rig {
            RigKind::Single => Problem::PathBeyondStop {
                reached_m,
                clearance_m,
            },
            RigKind::Double => Problem::PathBeyondMass {
                reached_m,
                clearance_m,
            },
        };
        Flag::new(Some(&x.name), problem).excluding(false)
    })
}

/// Observe free decays: no drive, no impacts, a fit after each blow or release.
fn observe_decay(record: &Record) -> Observation {
    let mut observation = undriven(record);
    observation.decays = free_decays(record);
    if observation.decays.is_empty() {
        let masses = [false, true].into_iter();
        let shown: Vec<Watched<'_>> = masses.flat_map(|y| watched(record, y)).collect();
        let problem = cause(&shown);
        observation.flags.push(Flag::new(None, problem));
    }
    observation.flags = without_what_follows(record, observation.flags);
    observation
}

/// Flags without those that follow from what excludes the record already, as a channel that is missing: that nothing
/// is found in it.
fn without_what_follows(record: &Record, mut flags: Vec<Flag>) -> Vec<Flag> {
    let mut known = record.flags.iter();
    let too_short = known.any(|f| f.code == FlagCode::TooFewSamples);
    let follows = |f: &Flag| {
        use FlagCode::{DriveNotHarmonic, NoFreeDecay, NoImpact, OneMassAlone};
        matches!(f.code, NoImpact | NoFreeDecay | OneMassAlone)
            || too_short && f.code == DriveNotHarmonic
    };
    if record.flags.iter().any(|f| f.excludes && !follows(f)) {
        flags.retain(|f| !follows(f));
    }
    flags
}

/// A record without a drive and impacts, of which nothing is fitted.
fn undriven(record: &Record) -> Observation {
    Observation {
        record: record.id.clone(),
        setting: record.setting.clone(),
        sample_rate_hz: record.sample_rate_hz,
        duration_s: record.duration_s(),
        drive: None,
        motion_tone: None,
        classification: undetermined(Undetermined::DecayWithoutDrive, Default::default()),
        impacts: Vec::new(),
        unsupported_pulses: 0,
        missed_pulses: 0,
        jump_samples: 1,
        low_pass: smears_jumps(record),
        smoothed: record.channels.iter().any(|c| c.smoothing.is_some()),
        lags: Vec::new(),
        directions: Vec::new(),
        late: Vec::new(),
        force_law: None,
        amplitudes: amplitudes(record),
        response: Vec::new(),
        folded: None,
        decays: Vec::new(),
        flags: record.flags.clone(),
    }
}

/// Whether a motion channel's low-pass takes more than a sample to settle.
fn smears_jumps(record: &Record) -> bool {
    let motion = record.channels.iter().filter(|c| c.role.is_motion());
    let mut filters = motion.filter_map(|c| c.low_pass);
    filters.any(|filter| filter.settling_s() * record.sample_rate_hz > 1.0)
}

/// Set each record's drive amplitude to what was measured, if that differs from the stated one. The nominal drive is
/// the one that most of its specimen's records have by what they state: where all state the same, the median.
pub fn scale_drives(observations: &mut [Observation]) {
    let groups: std::collections::BTreeSet<Option<String>> = observations
        .iter()
        .map(|o| o.setting.specimen.clone())
        .collect();
    for group in groups {
        let same = |o: &&mut Observation| o.setting.specimen == group;
        let measured: Vec<f64> = observations
            .iter()
            .filter(|o| o.setting.specimen == group && !o.excluded())
            .filter_map(|o| Some(o.drive?.amplitude / o.stated_drive()))
            .collect();
        let Some(nominal) = crate::signal::robust::median(&measured).filter(|m| *m > 0.0) else {
            continue;
        };
        let stated = observations
            .iter()
            .filter(|o| o.setting.specimen == group)
            .map(Observation::stated_drive);
        let (least, greatest) = columns::extremes(&stated.collect::<Vec<f64>>());
        let is_stated = greatest > (1.0 + DRIVE_CHANGES) * least;
        for o in observations.iter_mut().filter(same) {
            let Some(drive) = o.drive else { continue };
            let (measured, stated) = (drive.amplitude / nominal, o.stated_drive());
            let apart = (measured / stated - 1.0).abs();
            let known = o.has_flag(FlagCode::DriveAmplitudeContradicts);
            if is_stated && apart > DRIVE_CONTRADICTS && !known {
                let problem = Problem::AmplitudeUnlikeStated { measured, stated };
                o.flags.push(Flag::new(None, problem).excluding(false));
            }
            if apart > DRIVE_CHANGES {
                o.setting.drive_amplitude = measured * o.force_factor();
            }
        }
    }
}

/// Set the drive amplitudes that measured ones contradict to the stated ones.
pub fn state_drives(observations: &mut [Observation]) {
    for o in observations {
        if let Some((_, stated)) = o.contradicted_drive() {
            o.setting.drive_amplitude = stated * o.force_factor();
        }
    }
}

/// Let the drive amplitudes of all records follow a law, beside what is stated or measured of them; in place of one that
/// they follow already.
pub fn follow_force_law(observations: &mut [Observation], law: ForceLaw) {
    for o in observations {
        let stated = o.stated_drive();
        o.force_law = Some(law);
        o.setting.drive_amplitude = stated * o.force_factor();
    }
}

/// Relative change of the measured drive amplitude from which it counts.
const DRIVE_CHANGES: f64 = 5e-3;
/// Relative difference of it from a stated one from which it is named.
const DRIVE_CONTRADICTS: f64 = 0.1;

/// Free decays of the motion channels of mass x, else of mass y; of both where they swing at unlike frequencies.
fn free_decays(record: &Record) -> Vec<Decay> {
    let of_mass = |y| decay::fit_channels(&watched(record, y), record.sample_rate_hz);
    let [mut found, of_y] = [false, true].map(of_mass);
    if found.is_empty() {
        return of_y;
    }
    decay::append_unlike(&mut found, of_y);
    found
}

/// The motion channels of a mass without gaps.
fn watched(record: &Record, of_y: bool) -> Vec<Watched<'_>> {
    let channel = |role: Role| {
        Some(Watched {
            rails: rails(record, role),
            ..Watched::new(record.values(role)?, role.motion_signal())
        })
    };
    Role::ALL
        .iter()
        .copied()
        .filter(|role| role.is_motion() && role.is_of_y() == of_y)
        .filter_map(channel)
        .filter(|channel| channel.values.iter().all(|v| v.is_finite()))
        .collect()
}

/// Where samples of a channel are clipped, if they are.
fn rails(record: &Record, role: Role) -> Option<Rails<'_>> {
    let Channel { name, values, .. } = record.channel(role)?;
    record.flags.iter().find_map(|flag| match &flag.problem {
        Problem::ClippedSwings {
            channel, low, high, ..
        } if channel == name => Some(Rails {
            recorded: values,
            low: *low,
            high: *high,
        }),
        _ => None,
    })
}

fn contact_flag(record: &Record, impacts: &[Impact], unsupported: usize) -> Option<Flag> {
    (unsupported > 2 && unsupported > impacts.len()).then(|| {
        let channel = record.channel(Role::Contact).map(|c| c.name.as_str());
        let problem = Problem::PulsesWithoutJump {
            pulses: unsupported,
            impacts: impacts.len(),
        };
        Flag::new(channel, problem)
    })
}

fn amplitudes(record: &Record) -> Vec<Amplitude> {
    record
        .channels
        .iter()
        .filter(|c| !matches!(c.role, Role::Drive | Role::Contact) && !c.values.is_empty())
        .map(|c| {
            let (low, high) = columns::extremes(&c.values);
            let mean = crate::signal::robust::mean(&c.values);
            let centred: Vec<f64> = c.values.iter().map(|v| v - mean).collect();
            Amplitude {
                role: c.role,
                half_range: 0.5 * (high - low),
                rms: crate::signal::robust::rms(&centred),
            }
        })
        .collect()
}

impl Observation {
    /// A record of a motion at a drive frequency in an upward sweep at a clearance of 1 mm, sampled at
    /// 2 kHz for 1 s; nothing else is known.
    pub fn of(record: &str, frequency_hz: f64, motion: Motion) -> Self {
        let setting = Setting {
            stated_frequency_hz: Some(frequency_hz),
            clearance_m: Some(1e-3),
            sweep: crate::record::Sweep::Up,
            ..Setting::default()
        };
        Self {
            record: record.to_owned(),
            setting,
            sample_rate_hz: 2000.0,
            duration_s: 1.0,
            drive: None,
            motion_tone: None,
            classification: Classification {
                motion,
                confidence: 1.0,
                evidence: Default::default(),
            },
            impacts: Vec::new(),
            unsupported_pulses: 0,
            missed_pulses: 0,
            jump_samples: 1,
            low_pass: false,
            smoothed: false,
            lags: Vec::new(),
            directions: Vec::new(),
            late: Vec::new(),
            force_law: None,
            amplitudes: Vec::new(),
            response: Vec::new(),
            folded: None,
            decays: Vec::new(),
            flags: Vec::new(),
        }
    }
}

/// A shared waveform is stored as if its record alone had it.
mod shared {
    use std::sync::Arc;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::motion::fold::Folded;

    #[expect(clippy::ref_option, reason = "serde passes a reference to the field")]
    pub(super) fn serialize<S: Serializer>(
        folded: &Option<Arc<Folded>>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        folded.as_deref().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Arc<Folded>>, D::Error> {
        Ok(Option::<Folded>::deserialize(deserializer)?.map(Arc::new))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displacement_beyond_the_stop_is_named() {
        let wave = |amplitude: f64| -> Vec<f64> {
            (0..2000)
                .map(|i| 0.5e-3 + amplitude * (f64::from(i) * 0.04).sin())
                .collect()
        };
        let flag = |amplitude: f64, rig: RigKind| {
            let (x, drive) = (wave(amplitude), wave(1.0));
            let channels: &[(Role, &[f64])] = &[
                (Role::Drive, &drive),
                (Role::DisplacementX, &x),
                (Role::DisplacementY, &x),
            ];
            let mut record = Record::of(2000.0, channels);
            record.setting.clearance_m = Some(1e-3);
            beyond_stop(&record, rig)
        };
        for rig in [RigKind::Single, RigKind::Double] {
            assert_eq!(flag(1.05e-3, rig), None);
            let found = flag(1.5e-3, rig).unwrap();
            assert!(
                found.message().contains("1.5000 mm toward the"),
                "{}",
                found.message()
            );
            assert!(!found.excludes);
        }
    }

    #[test]
    fn what_follows_from_a_missing_channel_is_not_said_beside_it() {
        use FlagCode::{Clipped, MissingChannel, NoFreeDecay, NoImpact};
        let flag = |code: FlagCode| {
            let mut all = <Problem as strum::IntoEnumIterator>::iter();
            Flag::new(None, all.find(|p| p.code() == code).unwrap())
        };
        let said = |causes: &[FlagCode], all: &[FlagCode]| -> Vec<FlagCode> {
            let mut record = Record::of(1000.0, &[]);
            record.flags = causes.iter().map(|code| flag(*code)).collect();
            let all = all.iter().map(|code| flag(*code)).collect();
            let left = without_what_follows(&record, all);
            left.iter().map(|f| f.code).collect()
        };
        assert_eq!(said(&[], &[NoFreeDecay]), [NoFreeDecay]);
        for follows in [NoFreeDecay, NoImpact] {
            let all = [MissingChannel, Clipped, follows];
            assert_eq!(said(&all[..2], &all), all[..2]);
        }
        // a list that holds too few impacts says so itself
        assert_eq!(said(&[NoImpact], &[NoImpact]), [NoImpact]);
    }

    #[test]
    fn drive_amplitudes_are_relative_to_the_median_of_their_specimen() {
        let measured = |specimen: &str, amplitude: f64| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.setting.specimen = Some(specimen.to_owned());
            o.drive = Some(DriveTone::at(12.0, amplitude));
            o
        };
        let mut all = [
            measured("a", 1.0),
            measured("a", 2.0),
            measured("a", 2.005),
            measured("b", 30.0),
        ];
        scale_drives(&mut all);
        // 2.005/2 differs by less than 0.5 %: the stated amplitude stays.
        let amplitudes = all.map(|o| o.setting.drive_amplitude);
        assert_eq!(amplitudes, [0.5, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn amplitudes_follow_the_law_however_often_they_are_scaled() {
        let at = |hz: f64| Observation::of("r", hz, Motion::Impactless);
        let mut all = [at(10.0), at(20.0)];
        let law = ForceLaw {
            power: 2.0,
            at_hz: 10.0,
        };
        follow_force_law(&mut all, law);
        scale_drives(&mut all);
        let amplitudes = all.map(|o| o.setting.drive_amplitude);
        assert!((amplitudes[0] - 1.0).abs() < 1e-12 && (amplitudes[1] - 4.0).abs() < 1e-12);
    }

    #[test]
    fn drives_are_set_to_what_is_stated_where_what_is_measured_contradicts_it() {
        let stated = |stated: f64| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.setting.drive_amplitude = stated;
            o.drive = Some(DriveTone::at(12.0, 2.0));
            o
        };
        let mut all = [1.0, 0.6, 1.5].map(stated);
        let amplitudes = |all: &[Observation]| -> Vec<f64> {
            all.iter().map(|o| o.setting.drive_amplitude).collect()
        };
        for _ in 0..2 {
            scale_drives(&mut all);
            assert_eq!(amplitudes(&all), [1.0; 3]);
            assert!(all.iter().all(|o| !o.drives_as_stated()));
            state_drives(&mut all);
            assert_eq!(amplitudes(&all), [1.0, 0.6, 1.5]);
            assert_eq!(
                all.each_ref().map(Observation::drives_as_stated),
                [false, true, true]
            );
        }
        // a contradiction is told once
        assert!(all.iter().all(|o| o.flags.len() <= 1));
    }

    #[test]
    fn stated_drive_amplitudes_stay_relative_to_the_nominal_one() {
        let stated = |stated: f64, measured: f64| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.setting.drive_amplitude = stated;
            o.drive = Some(DriveTone::at(12.0, measured));
            o
        };
        // 3 V are the nominal drive; the last record had 3.3 V where 3 V were stated
        let mut all = [(0.5, 1.5), (1.5, 4.5), (1.5, 4.51), (1.0, 3.3)].map(|(s, m)| stated(s, m));
        scale_drives(&mut all);
        let found = all.map(|o| o.setting.drive_amplitude);
        let wanted = [0.5, 1.5, 1.5, 1.1];
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 3e-3, "{found} for {wanted}");
        }
    }

    #[test]
    fn valid_decays_on_either_side_of_a_gap_are_those_of_the_rig_and_impacts_keep_their_times() {
        let blows = [0.5, 5.5];
        let value = |i: usize| {
            let t = i as f64 / 500.0;
            let last = blows.iter().rev().find(|b| **b <= t);
            let since = last.map_or(-1.0, |b| t - b);
            let moving = (-0.4 * since).exp() * (std::f64::consts::TAU * 4.0 * since).sin();
            if since < 0.0 { 0.0 } else { moving }
        };
        let gapped = |i: usize| (1500..2600).contains(&i);
        let values = (0..5000).map(|i| if gapped(i) { f64::NAN } else { value(i) });
        let mut record = Record::of(500.0, &[(Role::VelocityX, &values.collect::<Vec<_>>())]);
        record.setting.excitation = Excitation::FreeDecay;
        let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
        let found = observe(&record, RigKind::Single, &detect, &classify);
        assert_eq!(found.decays.len(), 2);
        for (decay, blow) in found.decays.iter().zip(blows) {
            assert!((decay.natural_frequency_hz - 4.0).abs() < 2e-3, "{decay:?}");
            assert!((decay.first as f64 / 500.0 - blow).abs() < 0.2, "{decay:?}");
        }
        assert!((found.duration_s - 10.0).abs() < 1e-9);
        // a ball on flights of 0.5 s, out of sight for 10 samples in the third
        let height = |i: usize| 1.25 * 9.81 * (i % 50) as f64 * (50 - i % 50) as f64 / 1e4;
        let hidden = |i: usize| (120..130).contains(&i);
        let heights: Vec<f64> = (0..300)
            .map(|i| if hidden(i) { f64::NAN } else { -height(i) })
            .collect();
        let record = Record::of(100.0, &[(Role::DisplacementX, &heights)]);
        let detect = DetectSettings {
            flight: FlightKind::ConstantForce,
            ..detect
        };
        let found = observe(&record, RigKind::Single, &detect, &classify);
        let times: Vec<f64> = found.impacts.iter().map(|i| i.time_s).collect();
        assert_eq!(times.len(), 5, "{times:?}");
        for (k, time_s) in times.iter().enumerate() {
            assert!((time_s - 0.5 * (k + 1) as f64).abs() < 0.01, "{times:?}");
        }
    }

    #[test]
    fn the_response_of_less_than_a_drive_period_is_not_measured() {
        let observed = |samples: u32| {
            let tone = |i: u32| (std::f64::consts::TAU * 10.0 * f64::from(i) / 2000.0).sin();
            let values: Vec<f64> = (0..samples).map(tone).collect();
            let record = Record::of(
                2000.0,
                &[(Role::Drive, &values), (Role::VelocityX, &values)],
            );
            let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
            observe(&record, RigKind::Single, &detect, &classify)
        };
        assert_eq!(observed(2000).response.len(), 1);
        assert!(observed(60).response.is_empty());
    }

    #[test]
    fn pulses_without_jumps_exclude_a_record_if_they_outnumber_the_impacts() {
        let contact = [0.0; 10];
        let record = Record::of(2000.0, &[(Role::Contact, &contact)]);
        let impacts = [
            Impact::at(0.1, 1.0),
            Impact::at(0.2, 1.0),
            Impact::at(0.3, 1.0),
        ];
        assert_eq!(contact_flag(&record, &impacts, 3), None);
        let flag = contact_flag(&record, &impacts, 4).unwrap();
        assert_eq!(flag.code, FlagCode::ContactWithoutVelocityJump);
        assert_eq!(flag.channel.as_deref(), Some("contact"));
    }
}
