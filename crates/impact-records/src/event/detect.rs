//! From a record to its impacts: contact pulses and velocity jumps fused, times refined.

use std::f64::consts::SQRT_2;

use crate::event::arcs::{self, Arcs, Candidate, Instant};
use crate::event::channel_lags::{ChannelLag, channel_lags};
use crate::event::contact::{Closed, closed_intervals};
use crate::event::directions::{JumpDirections, jump_directions};
use crate::event::drive::{self, DriveTone};
use crate::event::finite_contact::{self, FiniteContact};
use crate::event::heights::by_heights;
use crate::event::impact::{DetectionSource, Impact};
use crate::event::jumps::{self, Jump, JumpSearch, KnownJumps};
use crate::event::kinematics::{Body, Kinematics, RigKind, Series};
use crate::event::refine;
use crate::event::ringing::Ringing;
use crate::event::touches::touches;
use crate::event::{drift, free_flight, impact_speeds, integrated};
use crate::record::{Flag, FlagCode, ListedTimes, Problem, Record, Role};
use crate::signal::local_fit::LocalFit;
use crate::signal::whole;
use labfiles::units::Dimension;

/// Forces on a body between impacts, as far as the detection depends on them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlightKind {
    /// Springs and a harmonic drive: arcs are smooth curves.
    #[default]
    Harmonic,
    /// A constant force toward the stop, and friction: arcs are straight in velocity.
    ConstantForce,
}

/// Settings of the detection. All times in s.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DetectSettings {
    /// Pulses of the contact closer than this belong to one bouncing contact.
    pub bounce_s: f64,
    /// A contact closed for longer than this is a dead zone.
    pub dead_zone_s: f64,
    /// One-sided window as a fraction of the drive period.
    pub window_periods: f64,
    /// Relative difference above which the measured drive frequency contradicts the stated one.
    pub drive_tolerance: f64,
    /// Forces between impacts.
    pub flight: FlightKind,
}

impl Detection {
    /// Time from an impact in which a channel may show its jump, s: that of the jump and one sample.
    pub(crate) fn guard_s(&self) -> f64 {
        (self.jump_samples as f64 + 1.0) / self.kinematics.rate_hz
    }

    /// Its impacts, for a search in the same velocity when it is smoothed.
    fn known_jumps(&self) -> KnownJumps {
        let rate_hz = self.kinematics.rate_hz;
        KnownJumps {
            places: self.impacts.iter().map(|i| i.time_s * rate_hz).collect(),
            rang: self.ringing.map_or(0.0, |r| r.beside[0].max(r.beside[1])),
        }
    }

    /// Samples that a jump takes by its contact, without those that differentiating or integrating adds.
    pub(crate) fn contact_samples(&self) -> usize {
        let velocity = self.kinematics.relative.velocity.as_ref();
        let added = velocity.map_or(0, |v| v.least_gap() - 1);
        self.jump_samples.saturating_sub(added).max(1)
    }
}

impl Default for DetectSettings {
    fn default() -> Self {
        Self {
            bounce_s: 3e-3,
            dead_zone_s: 4e-3,
            window_periods: 0.1,
            drive_tolerance: 5e-3,
            flight: FlightKind::Harmonic,
        }
    }
}

/// What was found in one record.
#[derive(Debug, Clone)]
pub struct Detection {
    /// The drive as measured.
    pub drive: Option<DriveTone>,
    /// The motion with drift removed.
    pub kinematics: Kinematics,
    /// The impacts in order of time.
    pub impacts: Vec<Impact>,
    /// Samples of the kinematics that a jump takes; more than one if the contact lasts longer than a step.
    pub jump_samples: usize,
    /// Contact pulses that show no jump of velocity, although velocity is measured.
    pub unsupported_pulses: usize,
    /// Impacts that the contact channel missed, although there is one.
    pub missed_pulses: usize,
    /// Times at which the masses come as close as at the impacts and no jump of velocity shows.
    pub unsupported_touches: usize,
    /// Fraction of the record in which the contact was closed.
    pub closed_fraction: f64,
    /// How much later than the contact or the other mass the channels show impacts; looked for where impacts
    /// are closer than one delay could make them, or contradict the contact.
    pub lags: Vec<ChannelLag>,
    /// Ways in which the velocities of the masses jump; looked at where jumps go up, contradict the contact, or are
    /// not found.
    pub directions: Vec<JumpDirections>,
    /// Problems found.
    pub flags: Vec<Flag>,
    /// How the approach velocity rings beside its jumps; `None` where few of these are strong.
    pub(crate) ringing: Option<Ringing>,
}

/// Detect the impacts of a record.
///
/// Impacts come from the contact channel and from jumps of the approach velocity, fused; a record
/// without any velocity gives impacts without speeds. No parameter of the model enters.
///
/// A mass against a stop whose velocity climbs from −1 to 1 m/s and turns every 0.1 s:
///
/// ```
/// use impact_records::event::{DetectSettings, RigKind, detect};
/// use impact_records::record::{Channel, Record, Role, Setting, Sweep};
/// use labfiles::units::Dimension;
///
/// let values = (0..800).map(|i| (i % 100) as f64 / 49.5 - 1.0).collect();
/// let record = Record {
///     id: "r1".into(),
///     sample_rate_hz: 1000.0,
///     channels: vec![Channel {
///         role: Role::VelocityX,
///         name: "v".into(),
///         dimension: Dimension::Velocity,
///         values,
///         high_pass_hz: None,
///         low_pass: None,
///         smoothing: None,
///         threshold: None,
///     }],
///     setting: Setting {
///         stated_frequency_hz: None,
///         clearance_m: None,
///         sweep: Sweep::Unknown,
///         drive_amplitude: 1.0,
///         sequence: 0,
///         specimen: None,
///         ..Setting::default()
///     },
///     listed: Default::default(),
///     flags: Vec::new(),
/// };
/// let found = detect(&record, RigKind::Single, &DetectSettings::default());
/// assert_eq!(found.impacts.len(), 7);
/// assert!((found.impacts[0].time_s - 0.0995).abs() < 1e-4);
/// assert!((found.impacts[0].approach_speed_before_m_s.unwrap() - 1.01).abs() < 1e-3);
/// ```
pub fn detect(record: &Record, rig: RigKind, settings: &DetectSettings) -> Detection {
    detect_at(record, rig, settings, None)
}

/// The same of a record that was smoothed: impacts are those that were found before, or that the contact shows.
pub(crate) fn detect_at(
    record: &Record,
    rig: RigKind,
    settings: &DetectSettings,
    before: Option<&Detection>,
) -> Detection {
    let (drive, mut flags) = drive::measure(record, settings.drive_tolerance);
    let stride = stride(record, drive.as_ref(), settings.flight);
    let contact = record.channel(Role::Contact);
    if let Some(channel) = contact.filter(|c| c.dimension == Dimension::Time) {
        let kinematics = Kinematics::of(record, rig, stride);
        return listed(kinematics, &channel.values, record.listed);
    }
    if let Some(channel) = contact.filter(|c| c.dimension == Dimension::Length) {
        let kinematics = Kinematics::of(record, rig, stride);
        return of_impacts(kinematics, by_heights(&channel.values, record.listed));
    }
    let closed = contact.map_or_else(Vec::new, |channel| {
        closed_intervals(
            channel,
            samples_of(settings.bounce_s, record.sample_rate_hz),
        )
    });
    if settings.flight == FlightKind::ConstantForce {
        return freely(record, rig, &closed);
    }
    let mut kinematics = Kinematics::of(record, rig, stride);
    let rate_hz = kinematics.rate_hz;
    let closed_samples: usize = closed.iter().map(Closed::samples).sum();
    let closed: Vec<Closed> = closed.iter().map(|c| c.every(stride)).collect();
    let dead_from = samples_of(settings.dead_zone_s, rate_hz).max(4);
    let per_period = drive.as_ref().map(|d| rate_hz / d.frequency_hz);
    let width = width(&kinematics, per_period, settings.window_periods);
    let arc_samples = arc_samples(width);
    let found = match &kinematics.relative.velocity {
        Some(velocity) => {
            let known = before.map(Detection::known_jumps);
            // a displacement that is cut off has kinks of its own
            let clipped = record.flags.iter().any(|f| f.code == FlagCode::Clipped);
            let recurs_after = per_period.filter(|_| !clipped);
            let body = (&kinematics.relative, velocity);
            let found = fuse(
                body,
                (&closed, known.as_ref()),
                (width, recurs_after),
                dead_from,
            );
            found.confirmed(velocity, arc_samples)
        }
        None => from_contact_alone(&closed, dead_from),
    };
    if let Some(flag) = wrong_way(&found, record) {
        flags.push(flag);
    }
    let arcs = Arcs {
        candidates: &found.candidates,
        samples: arc_samples,
    };
    let lags = if found.may_be_late(&kinematics) {
        channel_lags(&kinematics, &closed, width)
    } else {
        Vec::new()
    };
    let directions = if found.may_be_inverted(&kinematics) {
        jump_directions(&kinematics, width)
    } else {
        Vec::new()
    };
    let impacts = refined(&mut kinematics, arcs, drive.as_ref(), rig);
    Detection {
        drive,
        lags,
        directions,
        impacts,
        jump_samples: found.jump_samples,
        unsupported_pulses: found.unsupported,
        unsupported_touches: found.unsupported_touches,
        missed_pulses: if record.channel(Role::Contact).is_some() {
            found.missed
        } else {
            0
        },
        closed_fraction: closed_samples as f64 / record.samples().max(1) as f64,
        kinematics,
        flags,
        ringing: found.ringing,
    }
}

/// Slowest rate at which impacts between flights are looked for, Hz: that of a common camera.
const SLOWEST_HZ: f64 = 25.0;

/// Impacts between flights under a constant force, without a drive. Differences of displacements that were taken often
/// may be nothing but noise; then fewer of the samples show the speeds.
fn freely(record: &Record, rig: RigKind, closed: &[Closed]) -> Detection {
    let fine = freely_every(record, rig, closed, 1);
    let mut moving = record.channels.iter().filter(|c| c.role.is_motion());
    let placed = moving.all(|c| matches!(c.dimension, Dimension::Length | Dimension::Angle));
    if !fine.impacts.is_empty() || !placed || fine.kinematics.relative.velocity.is_none() {
        return fine;
    }
    let strides = [2, 4, 8, 16].into_iter();
    let strides = strides.filter(|s| record.sample_rate_hz / *s as f64 >= SLOWEST_HZ);
    let mut coarser: Vec<Detection> = strides
        .map(|stride| freely_every(record, rig, closed, stride))
        .collect();
    // the finest of those that show the most, else of those that show bodies along one axis
    let along = |found: &Detection| found.flags.iter().any(|f| f.code == FlagCode::OppositeSign);
    let tells = |found: &Detection| (found.impacts.len(), along(found));
    coarser.reverse();
    let most = coarser.into_iter().max_by_key(tells);
    most.filter(|found| tells(found) > (0, false))
        .unwrap_or(fine)
}

/// The same, one sample of every so many looked at.
fn freely_every(record: &Record, rig: RigKind, closed: &[Closed], stride: usize) -> Detection {
    let kinematics = Kinematics::of(record, rig, stride);
    let closed: Vec<Closed> = closed.iter().map(|c| c.every(stride)).collect();
    let found = match kinematics.relative.velocity {
        Some(_) => free_flight::detect(&kinematics, rig, &closed),
        None => free_flight::FreeFlights {
            impacts: pulses(&closed, kinematics.rate_hz),
            jump_samples: 1,
            flags: Vec::new(),
        },
    };
    let mut found = found;
    let samples = record.samples() / stride;
    if found.impacts.is_empty() && !found.flags.iter().any(|f| f.excludes) {
        // what was left out is why there is none
        let hidden = found.flags.iter().position(is_without_flight);
        let why = hidden.map_or_else(no_impact, |i| found.flags.remove(i));
        found.flags.push(why.excluding(true));
    }
    let closed_samples: usize = closed.iter().map(Closed::samples).sum();
    Detection {
        drive: None,
        impacts: found.impacts,
        jump_samples: found.jump_samples,
        unsupported_pulses: 0,
        missed_pulses: 0,
        unsupported_touches: 0,
        closed_fraction: closed_samples as f64 / samples.max(1) as f64,
        kinematics,
        lags: Vec::new(),
        directions: Vec::new(),
        flags: found.flags,
        ringing: None,
    }
}

/// Impacts between free flights that a contact alone shows, each as long as its pulse: a sample more than are closed, at
/// most.
fn pulses(closed: &[Closed], rate_hz: f64) -> Vec<Impact> {
    let candidates = from_contact_alone(closed, usize::MAX).candidates;
    let impacts = without_speeds(&candidates, None, rate_hz).into_iter();
    let lasting = |(impact, pulse): (Impact, &Closed)| Impact {
        contact_duration_s: Some((pulse.samples() + 1) as f64 / rate_hz),
        ..impact
    };
    impacts.zip(closed).map(lasting).collect()
}

/// Impacts that the record states as a list of times.
fn listed(kinematics: Kinematics, times_s: &[f64], known: ListedTimes) -> Detection {
    let impacts = times_s.iter().map(|time_s| Impact {
        contact_duration_s: Some(known.contact_s).filter(|s| *s > 0.0),
        ..Impact::timed(*time_s, known.error_s)
    });
    of_impacts(kinematics, impacts.collect())
}

/// Impacts that nothing was looked for in.
fn of_impacts(kinematics: Kinematics, impacts: Vec<Impact>) -> Detection {
    Detection {
        drive: None,
        impacts,
        jump_samples: 1,
        unsupported_pulses: 0,
        missed_pulses: 0,
        unsupported_touches: 0,
        closed_fraction: 0.0,
        kinematics,
        lags: Vec::new(),
        directions: Vec::new(),
        flags: Vec::new(),
        ringing: None,
    }
}

fn is_without_flight(flag: &Flag) -> bool {
    matches!(
        flag.problem,
        Problem::NoFlightBefore { .. } | Problem::NoFlightAfter { .. }
    )
}

fn no_impact() -> Flag {
    Flag::new(None, Problem::NoImpactBetweenFlights)
}

/// Samples in a drive period in which impacts are looked for. More of them would show no further impact:
/// windows, arcs and lengths of contacts are counted in samples and are shares of the period then.
const SAMPLES_PER_PERIOD: f64 = 200.0;

/// Every how many samples impacts are looked for: a jump stays a jump when samples between are left out, and
/// its contact may take many samples of a fast converter. Contacts without a motion keep all samples.
fn stride(record: &Record, drive: Option<&DriveTone>, flight: FlightKind) -> usize {
    let moves = record.channels.iter().any(|c| c.role.is_motion());
    let measured_hz = drive.map(|d| d.frequency_hz);
    let frequency_hz = measured_hz.or(record.setting.stated_frequency_hz);
    let frequency_hz = frequency_hz.filter(|_| moves && flight == FlightKind::Harmonic);
    frequency_hz.map_or(1, |f| stride_of(record.sample_rate_hz / f))
}

fn stride_of(per_period: f64) -> usize {
    whole::index((per_period / SAMPLES_PER_PERIOD).floor()).max(1)
}

/// Error of a speed that is extrapolated from an arc beside an impact to the middle of a jump that takes so many samples, of a
/// motion as fast as its drive, over its amplitude: what polynomials miss where a period has few samples.
pub fn extrapolation_error(samples_per_period: f64, jump_samples: usize) -> f64 {
    let per_period = samples_per_period / stride_of(samples_per_period) as f64;
    let width = window_samples(per_period, DetectSettings::default().window_periods);
    let count = arc_samples(width);
    let all = Arcs {
        candidates: &[],
        samples: count,
    };
    let apart = |of: fn(f64) -> f64| {
        let value = |at: f64| of(std::f64::consts::TAU * at / per_period);
        let values: Vec<f64> = (0..count).map(|i| value(i as f64)).collect();
        let far = 0.5 * jump_samples as f64;
        let at = (count - 1) as f64 + far;
        let fit = LocalFit::new(&values, 0, count, all.degree(count, far));
        fit.map_or(1.0, |fit| fit.value(at) - value(at))
    };
    apart(f64::cos).hypot(apart(f64::sin))
}

fn samples_of(time_s: f64, rate_hz: f64) -> usize {
    whole::index((time_s * rate_hz).round())
}

fn window_samples(per_period: f64, periods: f64) -> usize {
    whole::index((periods * per_period).round()).clamp(4, 16)
}

/// Greatest shares of a period in which a jump is looked for to either side, where noise asks for it: of a measured velocity such
/// that polynomials through the arcs of that width miss no more than a thousandth of a motion; of a displacement, whose
/// differences from sample to sample may be nothing but noise, such that impacts twice in a period leave both sides to themselves.
const WIDEST_PERIODS: f64 = 0.15;
const WIDEST_PERIODS_OF_DIFFERENCES: f64 = 0.25;

/// Samples of the windows in which jumps are looked for: a share of the period, or more under noise.
fn width(kinematics: &Kinematics, per_period: Option<f64>, periods: f64) -> usize {
    let Some(per_period) = per_period else {
        return 5;
    };
    let least = window_samples(per_period, periods);
    let velocity = kinematics.relative.velocity.as_ref();
    velocity.map_or(least, |v| {
        let widest = if v.is_differentiated() {
            WIDEST_PERIODS_OF_DIFFERENCES
        } else {
            WIDEST_PERIODS
        };
        jumps::window(v, per_period, least, whole::index(widest * per_period))
    })
}

/// Most samples of an arc beside an impact, from those of a window in which jumps are looked for.
fn arc_samples(width: usize) -> usize {
    (5 * width / 3).max(7)
}

/// Refine the times, remove the drift that follows from them, refine again, extrapolate the speeds.
fn refined(
    kinematics: &mut Kinematics,
    arcs: Arcs<'_>,
    drive: Option<&DriveTone>,
    rig: RigKind,
) -> Vec<Impact> {
    let candidates = arcs.candidates;
    if kinematics.relative.velocity.is_none() {
        return without_speeds(candidates, drive, kinematics.rate_hz);
    }
    let Some(contact) = finite_contact::measure(kinematics, arcs) else {
        return undrifted(kinematics, arcs, drive, (rig, None));
    };
    let wide = finite_contact::widened(candidates);
    let instants = refine::instants(kinematics, arcs.of(&wide));
    let spanned = contact.spanned(candidates, &instants);
    let instants = refine::instants(kinematics, arcs.of(&spanned));
    let instants = contact.placed(kinematics, arcs.of(&spanned), &instants);
    let spanned = contact.spanned(candidates, &instants);
    let arcs = arcs.of(&spanned);
    finite_contact::bridge(kinematics, arcs, &instants, &contact);
    kinematics.update_relative(rig);
    undrifted(kinematics, arcs, drive, (rig, Some((&contact, &instants))))
}

/// Correct the velocities for jumps and drift, then refine the impacts.
fn undrifted(
    kinematics: &mut Kinematics,
    arcs: Arcs<'_>,
    drive: Option<&DriveTone>,
    (rig, contact): (RigKind, Option<(&FiniteContact, &[Instant])>),
) -> Vec<Impact> {
    // The times of a contact that lasts are known from its samples.
    let instants = |kinematics: &Kinematics| match contact {
        Some((_, placed)) => placed.to_vec(),
        None => refine::instants(kinematics, arcs),
    };
    // The lost mean of what has passed a high-pass would otherwise shift the times.
    let middles: Vec<f64> = arcs.candidates.iter().map(|c| c.jump.middle()).collect();
    remove_drifts(kinematics, &middles, drive);
    let instants = instants(kinematics);
    let (delay, delays) = contact.map_or((0.0, [0.0; 2]), |(c, _)| (c.delay(), c.delays));
    let jumps: Vec<Instant> = instants.iter().map(|i| i.later(delay)).collect();
    let later = delays.map(|own| own - delay);
    refine::correct_jumps(kinematics, arcs, (&jumps, later));
    kinematics.update_relative(rig);
    let times: Vec<f64> = jumps.iter().map(|i| i.time).collect();
    remove_drifts(kinematics, &times, drive);
    let approach = kinematics.relative.velocity.as_mut();
    if let Some(velocity) = approach.filter(|v| v.is_integrated()) {
        integrated::close_flights(velocity, arcs, &instants);
    }
    let contact = contact.map(|(contact, _)| contact);
    impact_speeds::impacts(kinematics, arcs, &instants, drive, contact)
}

/// Remove the drift of all velocities by the arcs between times of impacts, in samples.
fn remove_drifts(kinematics: &mut Kinematics, times: &[f64], drive: Option<&DriveTone>) {
    if kinematics.spikes_clipped {
        // What the spikes lack would be taken for a ramp.
        return;
    }
    let rate_hz = kinematics.rate_hz;
    let Kinematics { relative, x, y, .. } = kinematics;
    let bodies = [relative, x, y].into_iter();
    for velocity in bodies.filter_map(|b| b.velocity.as_mut()) {
        drift::remove_drift(velocity, times, drive, rate_hz);
    }
}

/// Candidates for impacts, and counts of what supports and contradicts them.
#[derive(Default)]
struct Fused {
    candidates: Vec<Candidate>,
    /// Samples that a jump takes.
    jump_samples: usize,
    /// Contact pulses without a jump of the velocity.
    unsupported: usize,
    /// Touches of the masses without a jump of the velocity.
    unsupported_touches: usize,
    /// Jumps without a contact pulse.
    missed: usize,
    /// Jumps upward, which no impact makes.
    upward: usize,
    /// Jumps downward, as impacts make them.
    downward: usize,
    /// How the velocity rings beside its jumps.
    ringing: Option<Ringing>,
}

/// Fuse jumps and contact pulses: a jump within reach of a pulse belongs to it; a pulse without a
/// jump admits a weaker jump beside it, as does a touch; a long pulse is a dead zone. Where impacts are known already,
/// no others are found without a pulse.
fn fuse(
    (relative, velocity): (&Body, &Series),
    (closed, known): (&[Closed], Option<&KnownJumps>),
    (width, recurs_after): (usize, Option<f64>),
    dead_from: usize,
) -> Fused {
    let search = JumpSearch::new(velocity, width);
    let mut jumps = search.find();
    match known {
        Some(known) => search.keep_known(&mut jumps, known),
        None if closed.is_empty() => search.admit_recurring(recurs_after, &mut jumps),
        None => {}
    }
    let (upward, downward) = search.directions();
    let mut unsupported = Vec::new();
    for pulse in closed {
        let (first, last) = reach(pulse, search.gap);
        if jumps.iter().any(|j| (first..=last).contains(&j.left)) {
            continue;
        }
        let end = last.min(first + 4 + search.gap);
        if !search.admit((first, end), &mut jumps) {
            unsupported.push(pulse);
        }
    }
    let mut unsupported_touches = 0;
    for at in touches(relative, &jumps, width) {
        let first = at.saturating_sub(search.gap + 2);
        if !search.admit((first, at + 2), &mut jumps) {
            unsupported_touches += 1;
        }
    }
    let mut candidates = candidates(&jumps, closed, search.gap, dead_from, velocity);
    // the flights beside a jump that is seen across an impact of which the record shows too little, not the samples
    let crosses = |c: &Candidate| {
        let reaches = |pulse: &&Closed| pulse.first.abs_diff(c.jump.left) <= width;
        let shown = c
            .jump
            .fall(&velocity.values)
            .is_some_and(|fall| fall + 3.0 * SQRT_2 * velocity.noise > SHOWN * c.jump.height.abs());
        c.source == DetectionSource::Velocity && !shown && unsupported.iter().any(reaches)
    };
    candidates.retain(|c| !crosses(c));
    Fused {
        candidates,
        jump_samples: search.gap,
        unsupported: unsupported.len(),
        unsupported_touches,
        missed: 0,
        upward,
        downward,
        ringing: None,
    }
}

/// Time between impacts below which one of them may be the other, seen by a late channel, s.
const ONE_IMPACT_S: f64 = 10e-3;

impl Fused {
    /// Whether a channel may be late: jumps take more than a sample, follow each other closely, or contradict
    /// the contact.
    fn may_be_late(&self, kinematics: &Kinematics) -> bool {
        let all = &self.candidates;
        let rate_hz = kinematics.rate_hz;
        let spread = kinematics
            .relative
            .velocity
            .as_ref()
            .map_or(0, |v| v.spread);
        let pairs = all.windows(2);
        let close = pairs
            .filter(|pair| pair[1].jump.middle() - pair[0].jump.middle() < ONE_IMPACT_S * rate_hz)
            .count();
        let contradicted = self.unsupported + self.missed;
        !all.is_empty()
            && (self.jump_samples > 1 + 2 * spread
                || 4 * close > all.len()
                || 2 * contradicted > all.len())
    }
}

impl Fused {
    /// Whether a channel may be of the other sign: jumps go up, of both masses together or of one that the other
    /// outweighs, contradict the contact, or are not found, as where those of two masses cancel each other.
    fn may_be_inverted(&self, kinematics: &Kinematics) -> bool {
        let contradicted = self.unsupported + self.missed;
        let upward = |body: &Body| {
            let velocity = body.velocity.as_ref();
            velocity.is_some_and(|v| 2 * self.going_up(v) > self.candidates.len())
        };
        self.upward > 0
            || 2 * contradicted > self.candidates.len()
            || self.candidates.is_empty()
            || kinematics.bodies().any(upward)
    }

    /// At how many candidates a mass's velocity rises.
    fn going_up(&self, velocity: &Series) -> usize {
        let rises = |c: &&Candidate| c.jump.fall(&velocity.values).is_some_and(|fall| fall < 0.0);
        self.candidates.iter().filter(rises).count()
    }
}

/// Share of a jump that the samples or the flights beside it must show.
const SHOWN: f64 = 0.5;
/// Height of a jump, over that of the one before it, up to which it may be what that one's ringing leaves; any that
/// the contact does not show, after one that it does, may be.
const OF_RINGING: f64 = 0.3;

impl Fused {
    /// Without the jumps that no contact pulse and no difference of the flights beside them confirm:
    /// extrapolated across an impact nearby, a velocity seems to jump. Flights begin where ringing has ended.
    fn confirmed(self, velocity: &Series, samples: usize) -> Self {
        let without_pulse = |c: &Candidate| c.source == DetectionSource::Velocity;
        let all = &self.candidates;
        let candidates = all.as_slice();
        let arcs = Arcs {
            candidates,
            samples,
        };
        let ringing = Ringing::of(velocity, arcs);
        let rings = ringing.map_or(0.0, |r| r.beside[1]);
        let shows = |i: usize| {
            let middle = all[i].jump.middle();
            let mut windows = arcs::windows(velocity, arcs, i);
            let other = i.checked_sub(1).map(|k| &all[k]);
            let may_ring = |other: &&Candidate| {
                let height = all[i].jump.height.abs();
                let weak = height < OF_RINGING * other.jump.height.abs();
                rings > 0.0 && (weak || other.source == DetectionSource::Both)
            };
            if let Some(other) = other.filter(may_ring) {
                let first = &mut windows[0];
                first.0 = first.0.max(other.calm_behind(rings));
                if first.0 + arcs::DEGREE + 1 > first.1 {
                    return false;
                }
            }
            let Some([before, after]) = arcs::fits(&velocity.values, windows, arcs) else {
                return true;
            };
            let fall = before.value(middle) - after.value(middle);
            let error = before
                .error_factor(middle)
                .hypot(after.error_factor(middle));
            fall + 3.0 * velocity.noise * error > SHOWN * all[i].jump.height.abs()
        };
        let kept = (0..all.len()).filter(|i| !without_pulse(&all[*i]) || shows(*i));
        let calm = |c: &Candidate| Candidate {
            calm_from: c.calm_from.max(c.calm_behind(rings)),
            ..c.clone()
        };
        let candidates: Vec<Candidate> = kept.map(|i| calm(&all[i])).collect();
        Self {
            missed: candidates.iter().filter(|c| without_pulse(c)).count(),
            candidates,
            ringing,
            ..self
        }
    }
}

/// Samples at which a jump that belongs to a pulse may begin.
fn reach(pulse: &Closed, gap: usize) -> (usize, usize) {
    (pulse.first.saturating_sub(gap + 2), pulse.last + 1)
}

fn candidates(
    jumps: &[Jump],
    closed: &[Closed],
    gap: usize,
    dead_from: usize,
    velocity: &Series,
) -> Vec<Candidate> {
    let mut out: Vec<Candidate> = Vec::new();
    for (i, jump) in jumps.iter().enumerate() {
        let pulse = closed.iter().find(|p| {
            let (first, last) = reach(p, gap);
            (first..=last).contains(&jump.left)
        });
        let next = jumps.get(i + 1).map_or(velocity.values.len(), |j| j.left);
        let contact_dead = pulse
            .filter(|p| p.samples() >= dead_from)
            .map(|p| p.last.min(next).saturating_sub(jump.left) as f64)
            .filter(|d| *d >= dead_from as f64);
        let dead_samples = match (contact_dead, closed.is_empty()) {
            (Some(dead), _) => dead,
            (None, true) => resting_samples(velocity, jump, next, dead_from),
            (None, false) => 0.0,
        };
        let source = if pulse.is_some() {
            DetectionSource::Both
        } else {
            DetectionSource::Velocity
        };
        out.push(Candidate {
            jump: *jump,
            source,
            dead_samples,
            calm_from: pulse
                .filter(|p| p.samples() < dead_from)
                .map_or(0, |p| p.last + 1),
        });
    }
    out
}

/// Share of a jump below which a velocity that stays there after it rests.
const AT_REST: f64 = 0.1;

/// Samples for which the approach velocity stays at zero after a jump, for records without a
/// contact channel; of means of so many samples that noise could not hide a rebound, no more than a dead zone has.
fn resting_samples(velocity: &Series, jump: &Jump, next: usize, dead_from: usize) -> f64 {
    let begin = jump.left + jump.gap;
    let height = jump.height.abs();
    let noise = |count: usize| 4.0 * velocity.error_of_sum(&vec![1.0 / count as f64; count]);
    let tells = (1..=dead_from).find(|count| noise(*count) <= AT_REST * height);
    let Some(count) = tells else {
        return 0.0;
    };
    let rest_below = noise(count) + 5e-3 * height;
    let means = velocity.values[begin.min(next)..next].windows(count);
    let rests = |mean: &f64| mean.abs() <= rest_below;
    let resting = means
        .map(|samples| samples.iter().sum::<f64>() / count as f64)
        .take_while(rests)
        .count();
    // the samples of the last of these means
    let samples = resting + (count - 1) * usize::from(resting > 0);
    if samples >= dead_from {
        samples as f64
    } else {
        0.0
    }
}

fn from_contact_alone(closed: &[Closed], dead_from: usize) -> Fused {
    let candidates = closed
        .iter()
        .map(|pulse| Candidate {
            jump: Jump {
                left: pulse.first.saturating_sub(1),
                gap: 1,
                height: f64::NAN,
                error: f64::NAN,
            },
            source: DetectionSource::Contact,
            calm_from: 0,
            dead_samples: if pulse.samples() >= dead_from {
                pulse.samples() as f64
            } else {
                0.0
            },
        })
        .collect();
    Fused {
        candidates,
        jump_samples: 1,
        ..Fused::default()
    }
}

fn without_speeds(
    candidates: &[Candidate],
    drive: Option<&DriveTone>,
    rate_hz: f64,
) -> Vec<Impact> {
    candidates
        .iter()
        .map(|c| {
            let time_s = c.jump.middle() / rate_hz;
            Impact {
                drive_phase_rad: drive.map(|d| d.phase_at(time_s)),
                dead_zone_s: c.dead_samples / rate_hz,
                source: c.source,
                ..Impact::timed(time_s, 1.0 / (rate_hz * 12f64.sqrt()))
            }
        })
        .collect()
}

/// Upward jumps, although impacts jump down: the sign of a channel is wrong.
fn wrong_way(found: &Fused, record: &Record) -> Option<Flag> {
    (found.upward >= 3 && found.upward > 2 * found.downward).then(|| {
        let channel = record
            .channel(Role::VelocityX)
            .or_else(|| record.channel(Role::DisplacementX))
            .map(|c| c.name.as_str());
        let problem = Problem::UpwardJumps {
            up: found.upward,
            down: found.downward,
        };
        Flag::new(channel, problem)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Channel, Setting, Sweep};
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A velocity that climbs from −1 to 1 within 100 samples and falls back at 99.5, 199.5, …
    fn sawtooth(samples: usize) -> Vec<f64> {
        let value = |i: usize| (i % 100) as f64 / 49.5 - 1.0;
        (0..samples).map(value).collect()
    }

    fn pulse(first: usize, last: usize) -> Closed {
        Closed {
            first,
            last,
            pulses: 1,
        }
    }

    #[test]
    fn a_jump_across_an_impact_that_the_contact_alone_shows_is_none() {
        // the last impact is too near the end for a jump, and those before it are seen across it
        let velocity = Series::clean(sawtooth(303));
        let closed = [pulse(100, 102), pulse(200, 202), pulse(300, 302)];
        let found = fuse(
            (&Body::default(), &velocity),
            (&closed, None),
            (8, None),
            10,
        );
        let places = |found: &Fused| -> Vec<usize> {
            found.candidates.iter().map(|c| c.jump.left).collect()
        };
        assert_eq!(places(&found), [99, 199]);
        // of two impacts that follow each other closely the contact may show one, and the velocity the other
        let velocity = Series::clean(sawtooth(400));
        let closed = [pulse(100, 102), pulse(205, 205), pulse(300, 302)];
        let found = fuse(
            (&Body::default(), &velocity),
            (&closed, None),
            (8, None),
            10,
        );
        assert_eq!(
            (places(&found).as_slice(), found.unsupported),
            ([99, 199, 299].as_slice(), 1)
        );
    }

    #[test]
    fn valid_an_inverted_channel_on_the_heavier_mass_is_looked_at() {
        let body = |share: f64| {
            let values = sawtooth(400).into_iter().map(|v| share * v).collect();
            let velocity = Some(Series::clean(values));
            Body {
                velocity,
                ..Body::default()
            }
        };
        // the lighter mass jumps farther, so that the approach speed falls
        let kinematics = |y: f64| {
            let mut of = Kinematics::of(&Record::of(100.0, &[]), RigKind::Double, 1);
            (of.x, of.y, of.relative) = (body(1.0), body(y), body(1.0 + y));
            of
        };
        for (y, inverted) in [(-0.8, true), (0.8, false)] {
            let of = kinematics(y);
            let velocity = of.relative.velocity.as_ref().unwrap();
            let found = fuse((&Body::default(), velocity), (&[], None), (8, None), 10);
            assert_eq!(found.candidates.len(), 3);
            assert_eq!(found.may_be_inverted(&of), inverted, "{y}");
        }
    }

    #[test]
    fn a_pulse_belongs_to_the_jump_within_its_reach() {
        let velocity = Series::clean(sawtooth(400));
        let closed = [pulse(100, 102), pulse(245, 247)];
        let found = fuse(
            (&Body::default(), &velocity),
            (&closed, None),
            (8, None),
            10,
        )
        .confirmed(&velocity, ARC_SAMPLES);
        let sources: Vec<_> = found.candidates.iter().map(|c| c.source).collect();
        use DetectionSource::{Both, Velocity};
        assert_eq!(sources, [Both, Velocity, Velocity]);
        assert_eq!((found.missed, found.unsupported), (2, 1));
        assert_eq!((found.upward, found.downward), (0, 3));
        assert_eq!(found.candidates[0].jump.left, 99);
        assert!(found.candidates.iter().all(|c| c.dead_samples == 0.0));
    }

    const ARC_SAMPLES: usize = 10;

    #[test]
    fn a_jump_that_the_flights_do_not_show_needs_a_pulse() {
        let velocity = Series::clean(sawtooth(400));
        let mut found = fuse((&Body::default(), &velocity), (&[], None), (8, None), 10);
        assert_eq!(found.candidates.len(), 3);
        // Between two impacts the velocity climbs steadily.
        let mut seeming = found.candidates[0].clone();
        seeming.jump.left = 150;
        found.candidates.insert(1, seeming);
        found.candidates[1].source = DetectionSource::Both;
        let with_pulse = found.confirmed(&velocity, ARC_SAMPLES);
        assert_eq!(with_pulse.candidates.len(), 4);
        let mut without = with_pulse;
        without.candidates[1].source = DetectionSource::Velocity;
        let kept = without.confirmed(&velocity, ARC_SAMPLES);
        let places: Vec<usize> = kept.candidates.iter().map(|c| c.jump.left).collect();
        assert_eq!((places, kept.missed), (vec![99, 199, 299], 3));
    }

    #[test]
    fn what_rings_after_a_jump_is_no_further_one() {
        // a vibration of 5 samples behind each jump, which dies away
        let rings = |i: usize| {
            let since = (i % 100) as f64;
            0.6 * (-since / 4.0).exp() * (std::f64::consts::TAU / 5.0 * since).sin()
        };
        let values = sawtooth(800).into_iter().enumerate();
        let ringing: Vec<f64> = values.map(|(i, v)| v + rings(i)).collect();
        let ringing = Series::clean(ringing);
        let mut found = fuse((&Body::default(), &ringing), (&[], None), (16, None), 10);
        let first = found.candidates[0].clone();
        let jumps = Arcs {
            candidates: &found.candidates,
            samples: ARC_SAMPLES,
        };
        let after = |velocity: &Series| Ringing::of(velocity, jumps).unwrap().beside[1];
        assert!(after(&ringing) > 12.0);
        assert!(after(&Series::clean(sawtooth(800))) < 3.0);
        let mut seeming = first.clone();
        seeming.jump.left += 10;
        seeming.jump.height *= 0.2;
        found.candidates = vec![first.clone(), seeming];
        for candidate in [200, 300, 400].map(|apart| apart + first.jump.left) {
            let mut further = first.clone();
            further.jump.left = candidate;
            found.candidates.push(further);
        }
        let kept = found.confirmed(&ringing, ARC_SAMPLES).candidates;
        let places: Vec<usize> = kept.iter().map(|c| c.jump.left).collect();
        assert!(!places.contains(&(first.jump.left + 10)), "{places:?}");
        assert_eq!(places[0], first.jump.left);
    }

    #[test]
    fn a_long_pulse_is_a_dead_zone_that_ends_at_the_next_jump() {
        let velocity = Series::clean(sawtooth(400));
        let found = fuse(
            (&Body::default(), &velocity),
            (&[pulse(100, 120), pulse(200, 330)], None),
            (8, None),
            10,
        );
        let dead: Vec<f64> = found.candidates.iter().map(|c| c.dead_samples).collect();
        // From the jump's left sample 99 to 120; from 199 to the next jump at 299.
        assert_eq!(dead[..2], [21.0, 100.0]);
    }

    #[test]
    fn valid_few_samples_a_period_leave_speeds_uncertain() {
        // The same least squares in numpy: np.polyfit of degree 4 through np.cos and np.sin.
        for (per_period, want) in [(24.0, 1.117e-3), (40.0, 8.86e-5), (160.0, 3.81e-5)] {
            let found = extrapolation_error(per_period, 1);
            assert!((found / want - 1.0).abs() < 0.02, "{per_period}: {found}");
        }
        // More samples than are looked at are the same.
        let (few, many) = (
            extrapolation_error(200.0, 1),
            extrapolation_error(5000.0, 1),
        );
        assert!((few - many).abs() < 1e-12);
    }

    #[test]
    fn without_velocity_the_pulses_alone_are_impacts() {
        let mut contact = vec![0.0; 400];
        contact[50..53].fill(5.0);
        contact[150..190].fill(5.0);
        let record = Record::of(1000.0, &[(Role::Contact, &contact)]);
        let found = detect(&record, RigKind::Double, &DetectSettings::default());
        assert_eq!(found.impacts.len(), 2);
        // The contact closed between samples 49 and 50.
        assert!((found.impacts[0].time_s - 0.0495).abs() < 1e-12);
        assert_eq!(found.impacts[0].source, DetectionSource::Contact);
        assert_eq!(found.impacts[0].approach_speed_before_m_s, None);
        assert_eq!(found.impacts[0].dead_zone_s, 0.0);
        assert!((found.impacts[1].dead_zone_s - 0.040).abs() < 1e-12);
        assert!((found.closed_fraction - 43.0 / 400.0).abs() < 1e-12);
    }

    #[test]
    fn a_velocity_of_the_wrong_sign_is_flagged() {
        let wrong: Vec<f64> = sawtooth(800).iter().map(|v| -v).collect();
        let record = Record::of(1000.0, &[(Role::VelocityX, &wrong)]);
        let found = detect(&record, RigKind::Single, &DetectSettings::default());
        assert_eq!(found.flags[0].code, FlagCode::JumpsPointTheWrongWay);
        assert!(found.flags[0].excludes);
        let right = sawtooth(800);
        let record = Record::of(1000.0, &[(Role::VelocityX, &right)]);
        let found = detect(&record, RigKind::Single, &DetectSettings::default());
        assert!(found.flags.is_empty());
        assert_eq!(found.impacts.len(), 7);
    }

    /// Heights of a ball of R = 0.8 that is dropped from 1 m, sampled so often that their differences are noise.
    fn bounces(rate_hz: f64, noise_m: f64, seed: u64) -> Record {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let first = (2.0 / 9.81f64).sqrt();
        let height = |t: f64| {
            let (mut at, mut speed) = (first, 0.8 * 9.81 * first);
            if t < at {
                return 1.0 - 0.5 * 9.81 * t * t;
            }
            while t > at + 2.0 * speed / 9.81 {
                at += 2.0 * speed / 9.81;
                speed *= 0.8;
            }
            speed * (t - at) - 0.5 * 9.81 * (t - at).powi(2)
        };
        let count = whole::index(2.2 * rate_hz);
        let values = (0..count).map(|i| {
            let shock: f64 = StandardNormal.sample(&mut rng);
            -height(i as f64 / rate_hz) + noise_m * shock
        });
        Record {
            id: "ball".into(),
            sample_rate_hz: rate_hz,
            channels: vec![Channel {
                role: Role::DisplacementX,
                name: "y".into(),
                dimension: Dimension::Length,
                values: values.collect(),
                high_pass_hz: None,
                low_pass: None,
                smoothing: None,
                threshold: None,
            }],
            setting: Setting {
                stated_frequency_hz: None,
                clearance_m: None,
                sweep: Sweep::Unknown,
                drive_amplitude: 1.0,
                sequence: 0,
                specimen: None,
                ..Setting::default()
            },
            listed: ListedTimes::default(),
            flags: Vec::new(),
        }
    }

    #[test]
    fn valid_a_finely_sampled_track_shows_its_impacts_though_its_differences_are_noise() {
        let settings = DetectSettings {
            flight: FlightKind::ConstantForce,
            ..DetectSettings::default()
        };
        for seed in 0..4 {
            let found = detect(&bounces(500.0, 4e-3, seed), RigKind::Single, &settings);
            assert!(found.impacts.len() > 1, "{seed}: {:?}", found.flags);
            for impact in &found.impacts {
                let speeds = [
                    impact.approach_speed_before_m_s,
                    impact.approach_speed_after_m_s,
                ];
                let [Some(before), Some(after)] = speeds else {
                    panic!("{impact:?}");
                };
                let error = impact.speed_error_m_s().unwrap() * 1.3 / before;
                assert!(
                    (-after / before - 0.8).abs() < 4.0 * error.max(0.01),
                    "{seed} {impact:?}"
                );
            }
        }
    }
}
