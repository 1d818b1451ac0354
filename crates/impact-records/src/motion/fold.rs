//! A periodic record folded onto one period of its motion: means over narrow bins of phase, the
//! few numbers that carry all the information of a periodic waveform.

use serde::{Deserialize, Serialize};

use crate::event::{Detection, DriveTone, RigKind, noise_with_converter};
use crate::record::{Channel, LowPass, Record, Role};
use crate::signal::columns::{self, subtract};
use crate::signal::interpolation::later;
use crate::signal::whole;

/// Bins in one drive period.
const BINS_PER_PERIOD: usize = 64;

/// Mean of one channel in one bin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FoldedPoint {
    /// Mean phase of the samples, rad; 0 … 2πn, where 0 is the drive's zero phase before the
    /// impact (for an impactless motion, any zero phase of the drive).
    pub phase_rad: f64,
    /// Root mean square spread of the phases about it, rad.
    pub spread_rad: f64,
    /// Mean value, SI.
    pub value: f64,
    /// Number of samples.
    pub samples: u32,
}

/// One channel folded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoldedChannel {
    /// Which channel.
    pub role: Role,
    /// Noise of a single sample, SI.
    pub noise: f64,
    /// Corner of the first-order high-pass that the values have passed, Hz, its settling removed;
    /// `None`: none.
    #[serde(default)]
    pub high_pass_hz: Option<f64>,
    /// Low-pass that the values have passed and that has settled in them; `None`: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_pass: Option<LowPass>,
    /// Points that keep clear of impacts, by phase.
    pub points: Vec<FoldedPoint>,
}

/// A periodic record folded onto n drive periods.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Folded {
    /// Drive periods in one period of the motion.
    pub periods_n: u32,
    /// Mean phase of the impacts, rad in 0 … 2πn; `None` for an impactless motion.
    pub impact_phase_rad: Option<f64>,
    /// The channels: displacements, velocities and accelerations of both masses, as measured.
    pub channels: Vec<FoldedChannel>,
}

impl Folded {
    /// A phase of the drive at the impact, on the fold's axis: whole turns put it next to the
    /// measured one.
    pub fn on_fold(&self, phase_rad: f64) -> f64 {
        let measured = self.impact_phase_rad.unwrap_or(phase_rad);
        let turns = ((measured - phase_rad) / std::f64::consts::TAU).round();
        phase_rad + turns * std::f64::consts::TAU
    }
}

/// Fold a record with at most one impact in n drive periods.
///
/// A bin that an impact passes, with the time that channels may take to show it, does not count: its mean
/// would be one of both sides of the jump. A constant part of each channel is left in: an offset is a
/// nuisance of the fit. A high-pass is left in too, and the model is filtered: undoing it would integrate
/// the noise, and jumps whose instants are known only roughly. Each sensor is folded once, as it measures.
pub(super) fn fold(
    record: &Record,
    rig: RigKind,
    detection: &Detection,
    drive: &DriveTone,
    periods_n: u32,
) -> Folded {
    let span = std::f64::consts::TAU * f64::from(periods_n);
    let first = detection.impacts.first().map(|i| i.time_s);
    // Whole turns that put the first impact into the first drive period.
    let start = first.map_or(0.0, |t| {
        let total = std::f64::consts::TAU * drive.frequency_hz * t + drive.phase_rad;
        (total / std::f64::consts::TAU).floor() * std::f64::consts::TAU
    });
    let phase = |time_s: f64| {
        let total = std::f64::consts::TAU * drive.frequency_hz * time_s + drive.phase_rad;
        within(total - start, span)
    };
    let rate = std::f64::consts::TAU * drive.frequency_hz;
    let [before, after] = guards_s(record, detection.guard_s()).map(|s| rate * s);
    let mut bins = Bins::new(span, BINS_PER_PERIOD * periods_n as usize);
    for impact in &detection.impacts {
        bins.block(
            phase(impact.time_s),
            [before, after + rate * impact.dead_zone_s],
        );
    }
    let impact_phase_rad = mean_impact_phase(detection, phase, span);
    // Also at the record's edges, where no impact can be detected.
    if let Some(impact) = impact_phase_rad {
        bins.block(impact, [before, after]);
    }
    let times = (0..record.samples()).map(|i| i as f64 / record.sample_rate_hz);
    let axis = Axis::new(times.map(phase).collect(), bins);
    Folded {
        periods_n,
        impact_phase_rad,
        channels: channels(record, rig, detection, &axis),
    }
}

/// A phase on 0 … span.
fn within(phase: f64, span: f64) -> f64 {
    let phase = phase - (phase / span).floor() * span;
    if phase < span { phase.max(0.0) } else { 0.0 }
}

/// Times before and after an impact that are left out, s: a guard on either side and, of channels behind a
/// low-pass, whose values were moved back by its delay, what it takes to settle.
fn guards_s(record: &Record, guard_s: f64) -> [f64; 2] {
    let motion = record.channels.iter().filter(|c| c.role.is_motion());
    let filters = motion.filter_map(|c| c.low_pass);
    filters.fold([guard_s; 2], |[before, after], filter| {
        let (delay_s, settling_s) = (filter.delay_s(), filter.settling_s());
        [
            before.max(guard_s + delay_s),
            after.max(guard_s + settling_s - delay_s),
        ]
    })
}

/// Circular mean of the impacts' phases on 0 … span.
fn mean_impact_phase(detection: &Detection, phase: impl Fn(f64) -> f64, span: f64) -> Option<f64> {
    let turn = std::f64::consts::TAU / span;
    let (mut cos, mut sin) = (0.0, 0.0);
    for impact in &detection.impacts {
        let (s, c) = (phase(impact.time_s) * turn).sin_cos();
        cos += c;
        sin += s;
    }
    (!detection.impacts.is_empty()).then(|| sin.atan2(cos).rem_euclid(std::f64::consts::TAU) / turn)
}

/// Bins of phase on 0 … span, and which of them an impact passes.
struct Bins {
    span: f64,
    blocked: Vec<bool>,
}

impl Bins {
    fn new(span: f64, count: usize) -> Self {
        Self {
            span,
            blocked: vec![false; count],
        }
    }

    /// The bin of a phase.
    fn place(&self, phase: f64) -> usize {
        let count = self.blocked.len();
        whole::index(phase / self.span * count as f64).min(count - 1)
    }

    /// Leave out every bin that touches the phases from so much before to so much after one.
    fn block(&mut self, phase: f64, [before, after]: [f64; 2]) {
        let count = self.blocked.len();
        let width = self.span / count as f64;
        let first = ((phase - before) / width).floor();
        let passed = whole::index(((phase + after) / width).floor() - first) + 1;
        let first = self.place(within(first * width + 0.5 * width, self.span));
        for k in 0..passed.min(count) {
            self.blocked[(first + k) % count] = true;
        }
    }
}

struct Axis {
    phases: Vec<f64>,
    bins: Bins,
    /// The bin of each sample; none where it does not count.
    bin: Vec<Option<u32>>,
}

impl Axis {
    fn new(phases: Vec<f64>, bins: Bins) -> Self {
        let places = phases.iter().map(|phase| bins.place(*phase));
        let bin = places.map(|k| (!bins.blocked[k]).then(|| whole::count(k as f64)));
        Self {
            bin: bin.collect(),
            phases,
            bins,
        }
    }

    /// Subtract what is left of a high-pass' settling, a multiple of e^{−rate·i} at sample i, from values whose
    /// motion is periodic: the least-squares fit of its change over a period to the differences of values a
    /// period apart.
    fn remove_decay(&self, values: &mut [f64], rate: f64) {
        let added = decay(rate, values.len());
        let amplitude = self.amplitude(values, &added, rate);
        subtract(values, amplitude, &added);
    }

    fn amplitude(&self, values: &[f64], added: &[f64], rate: f64) -> f64 {
        let [first, second, ..] = self.phases[..] else {
            return 0.0;
        };
        let lag = self.bins.span / (second - first).rem_euclid(self.bins.span);
        let share = (-rate * lag).exp_m1();
        let (mut product, mut square) = (0.0, 0.0);
        for (i, later) in later(values, lag).into_iter().enumerate() {
            let partner = whole::index((i as f64 + lag).round());
            if self.bin[i].is_some() && self.bin[partner].is_some() {
                let gained = share * added[i];
                product += (later - values[i]) * gained;
                square += gained * gained;
            }
        }
        if square > 0.0 { product / square } else { 0.0 }
    }
}

/// e^{−rate·i} for i = 0, 1, …, block by block.
fn decay(rate: f64, count: usize) -> Vec<f64> {
    const BLOCK: usize = 64;
    let at = |step: usize| (-rate * step as f64).exp();
    let within: [f64; BLOCK] = std::array::from_fn(at);
    let blocks = (0..count).step_by(BLOCK).map(at);
    let mut values: Vec<f64> = blocks.flat_map(|first| within.map(|w| first * w)).collect();
    values.truncate(count);
    values
}

/// Every sensor of a mass's motion, once and as it measures.
fn channels(
    record: &Record,
    rig: RigKind,
    detection: &Detection,
    axis: &Axis,
) -> Vec<FoldedChannel> {
    let moves = |c: &&Channel| c.role.is_motion() && (rig == RigKind::Double || !c.role.is_of_y());
    let sound = |c: &&Channel| !c.values.is_empty() && columns::all_finite(&c.values);
    let channels = record.channels.iter().filter(moves).filter(sound);
    channels
        .map(|channel| {
            let high_pass_hz = channel.high_pass_hz.filter(|f| *f > 0.0);
            let mut settled = None;
            if let Some(corner_hz) = high_pass_hz {
                let rate = std::f64::consts::TAU * corner_hz / record.sample_rate_hz;
                let values = settled.insert(channel.values.clone());
                axis.remove_decay(values, rate);
            }
            FoldedChannel {
                role: channel.role,
                noise: noise(channel, detection),
                high_pass_hz,
                low_pass: channel.low_pass,
                points: points(settled.as_ref().unwrap_or(&channel.values), axis),
            }
        })
        .collect()
}

/// Noise of a channel's samples, as it was found for the detection.
fn noise(channel: &Channel, detection: &Detection) -> f64 {
    let k = &detection.kinematics;
    let body = if channel.role.is_of_y() { &k.y } else { &k.x };
    let found = match channel.role {
        Role::VelocityX | Role::VelocityY => body.velocity.as_ref(),
        Role::DisplacementX | Role::DisplacementY => body.displacement.as_ref(),
        _ => None,
    };
    let found = found.filter(|series| series.role == channel.role);
    found.map_or_else(|| noise_with_converter(&channel.values), |s| s.noise)
}

fn points(values: &[f64], axis: &Axis) -> Vec<FoldedPoint> {
    let mut sums = vec![[0.0; 4]; axis.bins.blocked.len()];
    for ((value, phase), bin) in values.iter().zip(&axis.phases).zip(&axis.bin) {
        if let Some(bin) = bin {
            let sum = &mut sums[*bin as usize];
            let more = [1.0, *phase, phase * phase, *value];
            *sum = std::array::from_fn(|k| sum[k] + more[k]);
        }
    }
    sums.iter()
        .filter(|s| s[0] > 0.0)
        .map(|[n, p, pp, v]| FoldedPoint {
            phase_rad: p / n,
            spread_rad: (pp / n - (p / n).powi(2)).max(0.0).sqrt(),
            value: v / n,
            samples: whole::count(*n),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::{DetectSettings, Impact, detect};

    const RATE_HZ: f64 = 2000.0;
    const FREQUENCY_HZ: f64 = 12.6;

    /// The drive's phase a time after the first sample.
    fn theta(time_s: f64) -> f64 {
        std::f64::consts::TAU * FREQUENCY_HZ * time_s + 0.7
    }

    /// When the phase is 1.2 beyond so many turns, s.
    fn time(turns: u32) -> f64 {
        let phase = 1.2 + std::f64::consts::TAU * f64::from(turns) - 0.7;
        phase / (std::f64::consts::TAU * FREQUENCY_HZ)
    }

    /// A record of one second of a waveform over the drive's phase, its detection with given impacts, its drive.
    fn record(
        rate_hz: f64,
        of: impl Fn(f64) -> f64,
        impacts: Vec<Impact>,
    ) -> (Record, Detection, DriveTone) {
        let thetas: Vec<f64> = (0..whole::index(rate_hz))
            .map(|i| theta(i as f64 / rate_hz))
            .collect();
        let drive: Vec<f64> = thetas.iter().map(|t| t.cos()).collect();
        let velocity: Vec<f64> = thetas.iter().map(|t| of(*t)).collect();
        let channels: [(Role, &[f64]); 2] = [(Role::Drive, &drive), (Role::VelocityX, &velocity)];
        let record = Record::of(rate_hz, &channels);
        let mut found = detect(&record, RigKind::Single, &DetectSettings::default());
        found.impacts = impacts;
        let drive = found.drive.unwrap();
        (record, found, drive)
    }

    #[test]
    fn valid_no_bin_mixes_both_sides_of_a_jump_at_any_rate() {
        // From the impact at phase 1.2 on, the velocity climbs from 0 to 1 and falls back at the next one.
        let turn = std::f64::consts::TAU;
        let wave = |theta: f64| (theta - 1.2).rem_euclid(turn) / turn;
        for rate_hz in [300.0, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4] {
            let impacts: Vec<Impact> = (0..12).map(|k| Impact::at(time(k), 1.0)).collect();
            let (record, detection, drive) = record(rate_hz, wave, impacts);
            let guard = turn * FREQUENCY_HZ * detection.guard_s();
            let folded = fold(&record, RigKind::Single, &detection, &drive, 1);
            let points = &folded.channels[0].points;
            for point in points {
                let apart = point.value - wave(point.phase_rad);
                assert!(apart.abs() < 1e-6, "{rate_hz}: {point:?}");
            }
            // Only bins that the impact and its guard touch are left out.
            let lost = BINS_PER_PERIOD - points.len();
            let touched = 2.0 * guard / turn * BINS_PER_PERIOD as f64;
            assert!(
                (touched..touched + 2.0).contains(&(lost as f64)),
                "{rate_hz}: {lost}"
            );
        }
    }

    #[test]
    fn a_sensor_is_folded_once_and_as_it_measures() {
        let values: Vec<f64> = (0..2000)
            .map(|i| theta(f64::from(i) / RATE_HZ).sin())
            .collect();
        let roles = [Role::DisplacementX, Role::VelocityY, Role::AccelerationX];
        for of in [&roles[..1], &roles[1..2], &roles[2..], &roles] {
            let mut channels: Vec<(Role, &[f64])> = vec![(Role::Drive, &values)];
            channels.extend(of.iter().map(|role| (*role, values.as_slice())));
            let record = Record::of(RATE_HZ, &channels);
            let detection = detect(&record, RigKind::Double, &DetectSettings::default());
            let drive = detection.drive.unwrap();
            let folded = fold(&record, RigKind::Double, &detection, &drive, 1);
            let found: Vec<Role> = folded.channels.iter().map(|c| c.role).collect();
            assert_eq!(found, of);
        }
    }

    #[test]
    fn valid_a_known_waveform_is_found_in_every_bin() {
        let wave = |theta: f64| 0.5 * (theta - 0.3).cos() + 0.1 * (2.0 * theta).sin();
        let (record, detection, drive) = record(RATE_HZ, wave, Vec::new());
        let folded = fold(&record, RigKind::Single, &detection, &drive, 1);
        assert_eq!((folded.periods_n, folded.impact_phase_rad), (1, None));
        let points = &folded.channels[0].points;
        assert_eq!(points.len(), BINS_PER_PERIOD);
        assert_eq!(points.iter().map(|p| p.samples).sum::<u32>(), 2000);
        for point in points {
            // A mean over a bin is below the crest by curvature · spread²/2.
            let allowed = 0.5 * 0.9 * point.spread_rad.powi(2) + 1e-5;
            assert!((point.value - wave(point.phase_rad)).abs() < allowed);
            assert!(point.spread_rad < 0.05);
        }
    }

    #[test]
    fn valid_a_subharmonic_is_folded_on_two_periods_with_its_impact_left_out() {
        let wave = |theta: f64| (0.5 * theta).sin();
        // An impact at phase 1.2 of every other period: (2πf t + 0.7) mod 4π = 1.2 + 2π.
        let impacts = (0..6).map(|k| Impact::at(time(2 * k + 1), 1.0)).collect();
        let (record, detection, drive) = record(RATE_HZ, wave, impacts);
        let folded = fold(&record, RigKind::Single, &detection, &drive, 2);
        // The first impact is put into the first period, so the fold starts one turn later.
        let impact = folded.impact_phase_rad.unwrap();
        assert!((impact - 1.2).abs() < 1e-6, "{impact}");
        assert!((folded.on_fold(1.3 - 2.0 * std::f64::consts::TAU) - 1.3).abs() < 1e-12);
        let guard = 2.0 / RATE_HZ * std::f64::consts::TAU * FREQUENCY_HZ;
        for point in &folded.channels[0].points {
            let shifted = wave(point.phase_rad + std::f64::consts::TAU);
            assert!((point.value - shifted).abs() < 1e-3);
            assert!((point.phase_rad - impact).abs() > 0.5 * guard);
        }
    }
}
