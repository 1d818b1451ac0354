//! Velocity and displacement of each body and of their relative motion on one time axis, with the
//! integrators' high-pass undone and the noise estimated.

use serde::{Deserialize, Serialize};

use crate::event::impact::MassSpeeds;
use crate::record::{FlagCode, Record, Role};
use crate::signal::whole;
use crate::signal::{columns, drift, robust};

/// Kind of rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigKind {
    /// Two masses that hit each other; approach speed x' + y'.
    Double,
    /// One mass that hits a fixed stop; approach speed x'.
    Single,
}

/// A signal in SI with its noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The channel that it comes from; of a relative motion an acceleration if there is one, else the first.
    pub role: Role,
    /// Samples, SI.
    pub values: Vec<f64>,
    /// Standard deviation of the white noise, SI; at least the converter's step over √12.
    pub noise: f64,
    /// Corner of the high-pass that was undone, Hz: a constant and a ramp remain unknown. `None` if
    /// the signal had none.
    pub high_pass_hz: Option<f64>,
    /// Samples to either side by which smoothing has spread a jump.
    pub spread: usize,
}

impl Series {
    /// Correct the undoing of the high-pass for a jump between two samples that are `shown_steps` from the
    /// first one, of a signal that jumped at `time_steps`.
    ///
    /// The integral `ω_c` ∫ y dt was taken by trapezoids, as if the jump were in the middle of its
    /// interval; for a jump u intervals after its begin the area differs by (before − after)(u − ½) steps.
    pub fn correct_jump(
        &mut self,
        (shown_steps, time_steps): (f64, f64),
        speeds: MassSpeeds,
        rate_hz: f64,
    ) {
        let Some(corner_hz) = self.high_pass_hz else {
            return;
        };
        let left = shown_steps.floor();
        let jump = speeds.jump_m_s();
        let area = jump * (time_steps - left - 0.5) / rate_hz;
        let step = std::f64::consts::TAU * corner_hz * area;
        for value in self.values.iter_mut().skip(whole::index(left) + 1) {
            *value += step;
        }
    }
}

impl Series {
    /// Every `stride`-th sample.
    fn every(mut self, stride: usize) -> Self {
        if stride > 1 {
            self.values = self.values.into_iter().step_by(stride).collect();
            self.spread = self.spread.div_ceil(stride);
        }
        self
    }

    /// Fewest samples from the last one before a jump to the first one after it: a difference of displacements
    /// beside a kink mixes both sides in two samples, the integral of a spike stands halfway in one; smoothing mixes more.
    pub(super) fn least_gap(&self) -> usize {
        let measured = match self.role {
            Role::DisplacementX | Role::DisplacementY => 3,
            Role::AccelerationX | Role::AccelerationY => 2,
            _ => 1,
        };
        measured + 2 * self.spread
    }

    /// Standard error, by noise, of the sum of neighbouring samples with weights: neighbours of a differentiated
    /// displacement share its samples, so that most of their noise cancels in a sum.
    pub(super) fn error_of_sum(&self, weights: &[f64]) -> f64 {
        if !self.is_differentiated() {
            return self.noise * columns::dot(weights, weights).sqrt();
        }
        let weight = |i: Option<usize>| i.and_then(|i| weights.get(i)).copied().unwrap_or(0.0);
        let of_sample = |i: usize| weight(i.checked_sub(2)) - weight(Some(i));
        let of_samples: Vec<f64> = (0..weights.len() + 2).map(of_sample).collect();
        self.noise * (0.5 * columns::dot(&of_samples, &of_samples)).sqrt()
    }

    /// Part of a velocity that this one shows at a frequency, in periods per sample, and the deviation of white noise that
    /// is as large as its noise there: differences of displacements over two samples show less of what is faster.
    pub(crate) fn shown_at(&self, frequency: f64) -> (f64, f64) {
        if !self.is_differentiated() {
            return (1.0, self.noise);
        }
        let turned = std::f64::consts::TAU * frequency;
        let part = turned.sin().abs();
        (part / turned, 2f64.sqrt() * part * self.noise)
    }

    /// Whether it is a velocity by differences of a displacement.
    pub(super) fn is_differentiated(&self) -> bool {
        matches!(self.role, Role::DisplacementX | Role::DisplacementY)
    }

    /// Whether it is a velocity by integrating an acceleration: what it is off changes by its noise from sample to
    /// sample, and each flight between impacts has a constant of its own.
    pub(super) fn is_integrated(&self) -> bool {
        matches!(self.role, Role::AccelerationX | Role::AccelerationY)
    }

    /// Correct the undoing of the high-pass for samples whose sum, before one of them, was changed
    /// by `area` (in samples).
    pub(super) fn correct_area(&mut self, from: usize, area: f64, rate_hz: f64) {
        let Some(corner_hz) = self.high_pass_hz else {
            return;
        };
        let step = std::f64::consts::TAU * corner_hz * area / rate_hz;
        for value in self.values.iter_mut().skip(from) {
            *value += step;
        }
    }
}

/// Velocity and displacement of one body (or of the relative motion) toward the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Body {
    /// Velocity, m/s: measured, else differentiated displacement, else integrated acceleration.
    pub velocity: Option<Series>,
    /// Displacement, m, as measured; its constant part is unknown.
    pub displacement: Option<Series>,
}

/// Channels from which the relative motion was built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RelativeSource {
    /// x + y, both measured.
    Both,
    /// x of a single mass against a stop.
    One,
    /// Twice the one of two masses that was measured: enough to find impacts, not for their R.
    Doubled,
}

/// Motion of both bodies in one record.
#[derive(Debug, Clone, PartialEq)]
pub struct Kinematics {
    /// Samples per second of all signals here, Hz: those of the record, or every so many of them.
    pub rate_hz: f64,
    /// Mass x.
    pub x: Body,
    /// Mass y.
    pub y: Body,
    /// The relative motion: displacement u = x + y, velocity u' (for one mass x alone).
    pub relative: Body,
    /// Channels of the approach velocity; `None` without any velocity.
    pub relative_from: Option<RelativeSource>,
    /// Whether the approach velocity was integrated from an acceleration whose spikes at impacts are clipped.
    pub spikes_clipped: bool,
    /// The relative motion as it was measured (velocity, else displacement, else acceleration),
    /// without drift of an integration: it is compared with itself a period later.
    pub waveform: Option<Series>,
}

impl Kinematics {
    /// Build the kinematics of a record from the motion channels that it has, with every `stride`-th sample:
    /// accelerations are integrated before others are left out, displacements differentiated after that.
    pub fn of(record: &Record, rig: RigKind, stride: usize) -> Self {
        let stride = stride.max(1);
        let rate_hz = record.sample_rate_hz / stride as f64;
        let of_x = Measured::of(
            record,
            [Role::VelocityX, Role::DisplacementX, Role::AccelerationX],
        );
        let of_y = match rig {
            RigKind::Double => Measured::of(
                record,
                [Role::VelocityY, Role::DisplacementY, Role::AccelerationY],
            ),
            RigKind::Single => Measured::default(),
        };
        let kinds: [fn(&Measured) -> &Option<Series>; 3] =
            [|m| &m.velocity, |m| &m.displacement, |m| &m.acceleration];
        let mut waveforms = kinds
            .into_iter()
            .map(|kind| combined(kind(&of_x), kind(&of_y), rig).0);
        let waveform = waveforms.find_map(|waveform| waveform);
        let waveform = waveform.map(|w| w.every(stride));
        let body = |measured: Measured| measured.body(record.sample_rate_hz, stride);
        let (x, y) = (body(of_x), body(of_y));
        let (relative, relative_from) = relative_motion(&x, &y, rig);
        let clipped = record.flags.iter().any(|f| f.code == FlagCode::Clipped);
        let velocity = relative.velocity.as_ref();
        Self {
            rate_hz,
            spikes_clipped: clipped && velocity.is_some_and(Series::is_integrated),
            x,
            y,
            relative,
            relative_from,
            waveform,
        }
    }

    /// Build the relative motion again after the bodies' signals were corrected.
    pub fn update_relative(&mut self, rig: RigKind) {
        (self.relative, self.relative_from) = relative_motion(&self.x, &self.y, rig);
    }

    /// The measured bodies with a velocity, x first.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        [&self.x, &self.y]
            .into_iter()
            .filter(|b| b.velocity.is_some())
    }
}

fn relative_motion(x: &Body, y: &Body, rig: RigKind) -> (Body, Option<RelativeSource>) {
    let (velocity, relative_from) = combined(&x.velocity, &y.velocity, rig);
    let (displacement, displacement_from) = combined(&x.displacement, &y.displacement, rig);
    // A relative displacement from other channels than the velocity would not fit to it.
    let displacement = displacement.filter(|_| displacement_from == relative_from);
    (
        Body {
            velocity,
            displacement,
        },
        relative_from,
    )
}

/// The motion channels of one body.
#[derive(Default)]
struct Measured {
    velocity: Option<Series>,
    displacement: Option<Series>,
    /// Left out where one of the others is there.
    acceleration: Option<Series>,
}

impl Measured {
    fn of(record: &Record, [velocity, displacement, acceleration]: [Role; 3]) -> Self {
        let (velocity, displacement) = (series(record, velocity), series(record, displacement));
        let alone = velocity.is_none() && displacement.is_none();
        Self {
            velocity,
            displacement,
            acceleration: alone.then(|| series(record, acceleration)).flatten(),
        }
    }

    fn body(self, rate_hz: f64, stride: usize) -> Body {
        let thinned = |series: Option<Series>| series.map(|s| s.every(stride));
        let displacement = thinned(self.displacement);
        let differentiate = || {
            let displacement = displacement.as_ref()?;
            Some(differentiated(displacement, rate_hz / stride as f64))
        };
        let integrate = || {
            let mut velocity = integrated(self.acceleration.as_ref()?, rate_hz).every(stride);
            // The steps between are independent of each other.
            velocity.noise *= (stride as f64).sqrt();
            Some(velocity)
        };
        let velocity = thinned(self.velocity);
        Body {
            velocity: velocity.or_else(differentiate).or_else(integrate),
            displacement,
        }
    }
}

fn series(record: &Record, role: Role) -> Option<Series> {
    let channel = record.channel(role)?;
    if channel.values.is_empty() || !columns::all_finite(&channel.values) {
        return None;
    }
    let smoothing = channel.smoothing;
    let noise = smoothing.map_or_else(|| noise_with_converter(&channel.values), |s| s.noise);
    let values = match channel.high_pass_hz {
        Some(corner) => {
            let mean = robust::mean(&channel.values);
            let centred: Vec<f64> = channel.values.iter().map(|v| v - mean).collect();
            drift::undo_high_pass(&centred, record.sample_rate_hz, corner)
        }
        None => channel.values.clone(),
    };
    let mut series = Series {
        role,
        values,
        noise,
        high_pass_hz: channel.high_pass_hz,
        spread: smoothing.map_or(0, |s| {
            whole::index((s.reach_s * record.sample_rate_hz - 1e-6).ceil())
        }),
    };
    if series.high_pass_hz.is_some() {
        // The high-pass has removed the constant part; a measured one is kept for `remove_drift`.
        remove_mean(&mut series.values);
    }
    Some(series)
}

fn remove_mean(values: &mut [f64]) {
    let mean = robust::mean(values);
    drift::remove_line(values, mean, 0.0);
}

/// Noise deviation of a channel's samples, not below the converter's step over √12.
pub(crate) fn noise_with_converter(values: &[f64]) -> f64 {
    let (low, high) = columns::extremes(values);
    let scale = high.max(-low);
    let step = columns::least_step(values, 1e-9 * scale);
    let converter = if step.is_finite() {
        step / 12f64.sqrt()
    } else {
        0.0
    };
    // A step as large as the noise itself is noise, not a converter.
    let noise = robust::noise_deviation(values);
    noise.max(converter.min(0.05 * scale)).max(1e-12 * scale)
}

fn differentiated(displacement: &Series, rate_hz: f64) -> Series {
    let x = &displacement.values;
    let last = x.len().saturating_sub(1);
    let values = (0..x.len())
        .map(|i| {
            let (low, high) = (i.saturating_sub(1), (i + 1).min(last));
            (x[high] - x[low]) * rate_hz / (high - low).max(1) as f64
        })
        .collect();
    Series {
        role: displacement.role,
        values,
        noise: displacement.noise * rate_hz / 2f64.sqrt(),
        high_pass_hz: displacement.high_pass_hz,
        spread: displacement.spread,
    }
}

fn integrated(acceleration: &Series, rate_hz: f64) -> Series {
    let mut sum = 0.0;
    let mut previous = acceleration.values[0];
    let mut values: Vec<f64> = acceleration
        .values
        .iter()
        .map(|&a| {
            sum += 0.5 * (a + previous) / rate_hz;
            previous = a;
            sum
        })
        .collect();
    remove_mean(&mut values);
    let high_pass_hz = Some(acceleration.high_pass_hz.unwrap_or(0.0));
    Series {
        role: acceleration.role,
        noise: acceleration.noise / rate_hz,
        values,
        high_pass_hz,
        spread: acceleration.spread,
    }
}

fn combined(
    x: &Option<Series>,
    y: &Option<Series>,
    rig: RigKind,
) -> (Option<Series>, Option<RelativeSource>) {
    match (x, y, rig) {
        (Some(x), _, RigKind::Single) => (Some(x.clone()), Some(RelativeSource::One)),
        (Some(x), Some(y), RigKind::Double) => {
            let values = x.values.iter().zip(&y.values).map(|(a, b)| a + b).collect();
            let noise = x.noise.hypot(y.noise);
            let high_pass_hz = x.high_pass_hz.or(y.high_pass_hz);
            (
                Some(Series {
                    role: if y.is_integrated() { y.role } else { x.role },
                    values,
                    noise,
                    high_pass_hz,
                    spread: x.spread.max(y.spread),
                }),
                Some(RelativeSource::Both),
            )
        }
        (Some(one), None, RigKind::Double) | (None, Some(one), RigKind::Double) => {
            let values = one.values.iter().map(|v| 2.0 * v).collect();
            let series = Series {
                role: one.role,
                values,
                noise: 2.0 * one.noise,
                high_pass_hz: one.high_pass_hz,
                spread: one.spread,
            };
            (Some(series), Some(RelativeSource::Doubled))
        }
        _ => (None, None),
    }
}

#[cfg(test)]
impl Series {
    /// A velocity of mass x with a noise of 1e-3 that never passed a high-pass.
    pub(crate) fn clean(values: Vec<f64>) -> Self {
        Self {
            role: Role::VelocityX,
            values,
            noise: 1e-3,
            high_pass_hz: None,
            spread: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;

    fn sine(samples: usize, step: f64) -> Vec<f64> {
        (0..samples).map(|i| (step * i as f64).sin()).collect()
    }

    #[test]
    fn valid_the_relative_motion_of_two_masses_is_their_sum() {
        let x = sine(200, 0.1);
        let y: Vec<f64> = sine(200, 0.1).iter().map(|v| 2.0 * v).collect();
        let record = Record::of(2000.0, &[(Role::VelocityX, &x), (Role::VelocityY, &y)]);
        let both = Kinematics::of(&record, RigKind::Double, 1);
        let velocity = both.relative.velocity.unwrap();
        assert!(
            velocity
                .values
                .iter()
                .zip(&x)
                .all(|(u, x)| (u - 3.0 * x).abs() < 1e-12)
        );
        assert_eq!(both.relative_from, Some(RelativeSource::Both));
        // One mass against a stop moves alone; one measured mass of two counts twice.
        let record = Record::of(2000.0, &[(Role::VelocityX, &x)]);
        let one = Kinematics::of(&record, RigKind::Single, 1);
        assert_eq!(one.relative.velocity.unwrap().values, x);
        let doubled = Kinematics::of(&record, RigKind::Double, 1);
        assert_eq!(doubled.relative.velocity.unwrap().values[7], 2.0 * x[7]);
        assert_eq!(doubled.relative_from, Some(RelativeSource::Doubled));
    }

    #[test]
    fn valid_a_displacement_is_differentiated_and_an_acceleration_integrated() {
        // x = t² at 100 Hz: the central difference of a parabola is exact, 2t.
        let parabola: Vec<f64> = (0..50).map(|i| (f64::from(i) / 100.0).powi(2)).collect();
        let record = Record::of(100.0, &[(Role::DisplacementX, &parabola)]);
        let velocity = Kinematics::of(&record, RigKind::Single, 1)
            .x
            .velocity
            .unwrap();
        assert!((velocity.values[10] - 0.2).abs() < 1e-12);
        // a = 3 from t = 0: v = 3t without its mean, which integration loses.
        let mut constant = vec![3.0; 51];
        constant[50] = 3.0 + 1e-9;
        let record = Record::of(100.0, &[(Role::AccelerationX, &constant)]);
        let velocity = Kinematics::of(&record, RigKind::Single, 1)
            .x
            .velocity
            .unwrap();
        assert!((velocity.values[40] - velocity.values[10] - 0.9).abs() < 1e-9);
        assert_eq!(velocity.high_pass_hz, Some(0.0));
    }

    #[test]
    fn valid_noise_of_a_differentiated_displacement_cancels_in_sums() {
        // the mean of n differences over two samples is (x_n + x_{n−1} − x_0 − x_{−1})/2n: √4/2n of the displacement's
        // noise, √2/n of that of the differences, 1/√2
        let mut series = Series::clean(vec![0.0; 9]);
        series.noise = 0.5f64.sqrt();
        let mean = [0.125; 8];
        assert!((series.error_of_sum(&mean) - 0.5f64.sqrt() / 8f64.sqrt()).abs() < 1e-15);
        series.role = Role::DisplacementX;
        assert!((series.error_of_sum(&mean) - 0.125).abs() < 1e-15);
    }

    #[test]
    fn valid_a_jump_off_the_middle_of_its_interval_shifts_all_later_samples() {
        // ω_c = 2π/s, jump from 1 to −1 at a quarter of the interval 10…11, 100 samples per s:
        // 2π · 2 · (0.25 − 0.5)/100 = −π/100.
        let mut series = Series {
            high_pass_hz: Some(1.0),
            ..Series::clean(vec![0.0; 20])
        };
        let speeds = MassSpeeds {
            before_m_s: 1.0,
            after_m_s: -1.0,
        };
        series.correct_jump((10.5, 10.25), speeds, 100.0);
        assert_eq!(series.values[10], 0.0);
        assert!((series.values[11] + std::f64::consts::PI / 100.0).abs() < 1e-15);
        assert_eq!(series.values[11], series.values[19]);
    }
}
