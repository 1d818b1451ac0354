//! A periodic record folded onto one period of its motion: means over narrow bins of phase, the
//! few numbers that carry all the information of a periodic waveform.

use serde::{Deserialize, Serialize};

use crate::event::{Detection, DriveTone, Series};
use crate::record::{Channel, LowPass, Record, Role};
use crate::signal::columns::subtract;
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
    /// The channels: velocities and displacements of both masses, as measured.
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
/// Bins within two samples of an impact are left out. A constant part of each channel is left
/// in: an offset is a nuisance of the fit. A high-pass is left in too, and the model is filtered:
/// undoing it would integrate the noise, and jumps whose instants are known only roughly.
pub(super) fn fold(
    record: &Record,
    detection: &Detection,
    drive: &DriveTone,
    periods_n: u32,
) -> Folded {
    let rate_hz = detection.kinematics.rate_hz;
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
    let impact_phase_rad = mean_impact_phase(detection, phase, span);
    let phases: Vec<f64> = (0..sample_count(detection))
        .map(|i| phase(i as f64 / rate_hz))
        .collect();
    let guards_s = guards_s(record, (detection.jump_samples as f64 + 1.0) / rate_hz);
    let mut blocked = blocked(detection, guards_s);
    if let Some(impact) = impact_phase_rad {
        // Also at the record's edges, where no impact can be detected.
        let [before, after] = guards_s.map(|s| s * std::f64::consts::TAU * drive.frequency_hz);
        for (phase, blocked) in phases.iter().zip(&mut blocked) {
            let since = within(phase - impact, span);
            *blocked |= since < after || span - since < before;
        }
    }
    let axis = Axis::new(
        phases,
        blocked,
        (span, BINS_PER_PERIOD * periods_n as usize),
    );
    Folded {
        periods_n,
        impact_phase_rad,
        channels: channels(record, detection, &axis),
    }
}

/// A phase on 0 … span.
fn within(phase: f64, span: f64) -> f64 {
    let phase = phase - (phase / span).floor() * span;
    if phase < span { phase.max(0.0) } else { 0.0 }
}

fn sample_count(detection: &Detection) -> usize {
    let bodies = [&detection.kinematics.x, &detection.kinematics.y];
    bodies
        .iter()
        .flat_map(|b| [&b.velocity, &b.displacement])
        .flatten()
        .map(|s| s.values.len())
        .max()
        .unwrap_or(0)
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

fn blocked(detection: &Detection, [before_s, after_s]: [f64; 2]) -> Vec<bool> {
    let rate_hz = detection.kinematics.rate_hz;
    let mut blocked = vec![false; sample_count(detection)];
    for impact in &detection.impacts {
        let first = whole::index(((impact.time_s - before_s) * rate_hz).floor().max(0.0));
        let last = whole::index(((impact.time_s + after_s + impact.dead_zone_s) * rate_hz).ceil());
        let end = (last + 1).min(blocked.len());
        if let Some(range) = blocked.get_mut(first.min(end)..end) {
            range.fill(true);
        }
    }
    blocked
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

struct Axis {
    phases: Vec<f64>,
    blocked: Vec<bool>,
    span: f64,
    bins: usize,
    /// The bin of each sample that is not blocked.
    bin: Vec<Option<u32>>,
}

impl Axis {
    fn new(phases: Vec<f64>, blocked: Vec<bool>, (span, bins): (f64, usize)) -> Self {
        let last = bins as f64 - 1.0;
        let bin = |(phase, blocked): (&f64, &bool)| {
            (!blocked).then(|| whole::count((phase / span * bins as f64).min(last)))
        };
        Self {
            bin: phases.iter().zip(&blocked).map(bin).collect(),
            phases,
            blocked,
            span,
            bins,
        }
    }

    /// Amplitude of a shape in time that is added to a periodic motion: the least-squares fit of the
    /// shape's change over a period to the differences of values a period apart.
    fn amplitude(&self, values: &[f64], (shape, added): (&Shape, &[f64])) -> f64 {
        let [first, second, ..] = self.phases[..] else {
            return 0.0;
        };
        let lag = self.span / (second - first).rem_euclid(self.span);
        let gained_by = shape.gained(lag);
        let (mut product, mut square) = (0.0, 0.0);
        for (i, later) in later(values, lag).into_iter().enumerate() {
            let partner = whole::index((i as f64 + lag).round());
            if !self.blocked[i] && !self.blocked[partner] {
                let gained = gained_by(added[i]);
                product += (later - values[i]) * gained;
                square += gained * gained;
            }
        }
        if square > 0.0 { product / square } else { 0.0 }
    }

    /// Subtract a shape in time from values whose motion is periodic.
    fn remove(&self, values: &mut [f64], shape: &Shape) {
        let added = shape.values(values.len());
        let amplitude = self.amplitude(values, (shape, &added));
        subtract(values, amplitude, &added);
    }
}

/// A shape in time that is added to a periodic motion.
enum Shape {
    /// i at sample i.
    Ramp,
    /// e^{−rate·i} at sample i.
    Decay(f64),
}

impl Shape {
    fn values(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Ramp => (0..count).map(|i| i as f64).collect(),
            Self::Decay(rate) => decay(*rate, count),
        }
    }

    /// What it gains over a lag from where it has a value.
    fn gained(&self, lag: f64) -> impl Fn(f64) -> f64 {
        let (share, constant) = match self {
            Self::Ramp => (0.0, lag),
            Self::Decay(rate) => ((-rate * lag).exp_m1(), 0.0),
        };
        move |value| share * value + constant
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

fn channels(record: &Record, detection: &Detection, axis: &Axis) -> Vec<FoldedChannel> {
    let k = &detection.kinematics;
    [
        (Role::VelocityX, &k.x.velocity),
        (Role::VelocityY, &k.y.velocity),
        (Role::DisplacementX, &k.x.displacement),
        (Role::DisplacementY, &k.y.displacement),
    ]
    .into_iter()
    .filter_map(|(role, series)| {
        let series = series.as_ref()?;
        let channel = record.channel(role);
        let filtered = channel.and_then(|c| Some((c, c.high_pass_hz.filter(|f| *f > 0.0)?)));
        let values = match filtered {
            Some((channel, corner_hz)) => settled(channel, corner_hz / record.sample_rate_hz, axis),
            None => level(series, axis),
        };
        Some(FoldedChannel {
            role,
            noise: series.noise,
            high_pass_hz: filtered.map(|(_, corner_hz)| corner_hz),
            low_pass: channel.and_then(|c| c.low_pass),
            points: points(&values, axis),
        })
    })
    .collect()
}

/// A channel as it was measured behind its high-pass, without the filter's settling; the corner
/// in turns a sample.
fn settled(channel: &Channel, corner: f64, axis: &Axis) -> Vec<f64> {
    let mut values = channel.values.clone();
    let rate = std::f64::consts::TAU * corner;
    axis.remove(&mut values, &Shape::Decay(rate));
    values
}

/// A signal without the ramp that integrating it left.
fn level(series: &Series, axis: &Axis) -> Vec<f64> {
    let mut values = series.values.clone();
    if series.high_pass_hz.is_some() {
        axis.remove(&mut values, &Shape::Ramp);
    }
    values
}

fn points(values: &[f64], axis: &Axis) -> Vec<FoldedPoint> {
    let mut sums = vec![[0.0; 4]; axis.bins];
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
    use crate::event::{DetectSettings, Impact, RigKind, detect};

    const RATE_HZ: f64 = 2000.0;
    const FREQUENCY_HZ: f64 = 12.6;

    fn theta(i: usize) -> f64 {
        std::f64::consts::TAU * FREQUENCY_HZ * i as f64 / RATE_HZ + 0.7
    }

    /// A record of a waveform over the drive's phase, its detection with given impacts, its drive.
    fn record(of: impl Fn(f64) -> f64, impacts: Vec<Impact>) -> (Record, Detection, DriveTone) {
        let drive: Vec<f64> = (0..2000).map(|i| theta(i).cos()).collect();
        let velocity: Vec<f64> = (0..2000).map(|i| of(theta(i))).collect();
        let channels: [(Role, &[f64]); 2] = [(Role::Drive, &drive), (Role::VelocityX, &velocity)];
        let record = Record::of(RATE_HZ, &channels);
        let mut found = detect(&record, RigKind::Single, &DetectSettings::default());
        found.impacts = impacts;
        let drive = found.drive.unwrap();
        (record, found, drive)
    }

    #[test]
    fn valid_a_known_waveform_is_found_in_every_bin() {
        let wave = |theta: f64| 0.5 * (theta - 0.3).cos() + 0.1 * (2.0 * theta).sin();
        let (record, detection, drive) = record(wave, Vec::new());
        let folded = fold(&record, &detection, &drive, 1);
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
        let time = |k: usize| {
            let phase = 1.2 + std::f64::consts::TAU * (2 * k + 1) as f64 - 0.7;
            phase / (std::f64::consts::TAU * FREQUENCY_HZ)
        };
        let impacts = (0..6).map(|k| Impact::at(time(k), 1.0)).collect();
        let (record, detection, drive) = record(wave, impacts);
        let folded = fold(&record, &detection, &drive, 2);
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
