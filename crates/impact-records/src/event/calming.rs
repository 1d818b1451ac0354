//! Records whose velocities ring beside impacts: behind the steep filters of converters before and after a jump, behind
//! others after it. Smoothing takes the ringing away; a jump takes some samples more then.

use crate::event::detect::Detection;
use crate::event::impact::Impact;
use crate::event::kinematics::noise_with_converter;
use crate::record::{Channel, Record, Role, Smoothing};
use crate::signal::smoothing::{Kernel, LONG, SHORT};

/// Distances of the taps, samples of the record: they take away what turns over in as many.
const APART: [usize; 12] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24];
/// Share of the usual time between impacts that smoothing may take at one of them.
const MOST: f64 = 0.15;
/// Part of what flights leave beyond noise that smoothing may leave.
const LEFT: f64 = 0.25;
/// Standard errors of a mean square of noise within which it is one of noise.
const NOISE: f64 = 4.0;

/// The record with its motion smoothed such that flights no more ring and speeds at its impacts have the least errors, and
/// what was found in it. What still rings is an error of all impacts, noise is one of each. `None` where it does not ring,
/// where smoothing does not help, and where a known low-pass or contacts that last explain it.
pub(crate) fn calmed(
    record: &Record,
    found: &Detection,
    detect: impl Fn(&Record) -> Detection,
) -> Option<(Record, Detection)> {
    let filtered = |c: &Channel| c.role.is_motion() && c.low_pass.is_some();
    let lasting = |i: &Impact| i.contact_duration_s.is_some();
    if record.channels.iter().any(filtered) || found.impacts.iter().any(lasting) {
        return None;
    }
    let rough = found.ringing?.rough?;
    let error = (2.0 / rough.samples as f64).sqrt();
    let velocity = found.kinematics.relative.velocity.as_ref()?;
    // displacements have kinks, which hardly ring
    if matches!(velocity.role, Role::DisplacementX | Role::DisplacementY) {
        return None;
    }
    let noise = velocity.noise.powi(2);
    let beyond = rough.left - noise;
    if beyond < NOISE * error * noise {
        return None;
    }
    let stride = record.sample_rate_hz / found.kinematics.rate_hz;
    let most = MOST * rough.apart * stride;
    let jump_s = (found.contact_samples() - 1) as f64 / found.kinematics.rate_hz;
    let impacts = found.impacts.len() as f64;
    let all = APART
        .into_iter()
        .flat_map(|apart| [(SHORT, apart), (LONG, apart)]);
    let fit = all.filter(|(kernel, apart)| 2.0 * kernel.reach(*apart) as f64 <= most);
    let tried = fit.filter_map(|(kernel, apart)| {
        let smooth = smoothed_record(record, kernel, apart, jump_s);
        let found = detect(&smooth);
        let rough = found.ringing?.rough?;
        let left = (rough.left - kernel.noise_gain() * noise).max(0.0);
        let variance = (noise / impacts + left) * rough.factor;
        (left < LEFT * beyond).then_some((variance, smooth, found))
    });
    let (_, smooth, mut calm) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    // how long a jump takes tells of a low-pass, and is that before smoothing
    calm.lags.clone_from(&found.lags);
    Some((smooth, calm))
}

/// The record with the channels of motion smoothed by taps so many samples apart, of jumps that took some time before.
fn smoothed_record(record: &Record, kernel: Kernel, apart: usize, jump_s: f64) -> Record {
    let mut smooth = record.clone();
    for channel in smooth.channels.iter_mut().filter(|c| c.role.is_motion()) {
        channel.smoothing = Some(Smoothing {
            reach_s: kernel.reach(apart) as f64 / record.sample_rate_hz + 0.5 * jump_s,
            noise: noise_with_converter(&channel.values),
        });
        channel.values = kernel.smoothed(&channel.values, apart);
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::{DetectSettings, RigKind, detect, detect_at};

    const RATE_HZ: f64 = 2000.0;
    /// Flight time in samples, approach speed in m/s, restitution.
    const FLIGHT: f64 = 127.3;
    const SPEED: f64 = 0.5;
    const RESTITUTION: f64 = 0.8;

    /// Flights whose velocities rise from −R to 1 like v = V(−R + as + bs²), s = 0…1; the impacts are at (k + 0.4) flights.
    fn flights() -> Vec<f64> {
        let (a, b) = (4.0 * RESTITUTION - 2.0, 3.0 * (1.0 - RESTITUTION));
        let value = |i: usize| {
            let s = (i as f64 / FLIGHT + 0.6).fract();
            SPEED * (-RESTITUTION + a * s + b * s * s)
        };
        (0..2000).map(value).collect()
    }

    /// What the filter of a converter adds to each jump: its step response less the step itself. The filter is a sinc
    /// that ends at 0.47 of the rate under a window cos².
    fn ringing() -> Vec<f64> {
        const HALF: f64 = 24.0;
        const PARTS: usize = 100;
        let kernel = |t: f64| {
            let x = std::f64::consts::TAU * 0.47 * t;
            let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
            sinc * (0.5 * std::f64::consts::PI * t / HALF).cos().powi(2)
        };
        let count = 2 * 24 * PARTS;
        let at = |k: usize| (k as f64 + 0.5) / PARTS as f64 - HALF;
        let sums: Vec<f64> = (0..count)
            .scan(0.0, |sum, k| {
                *sum += kernel(at(k));
                Some(*sum)
            })
            .collect();
        let whole = sums[count - 1];
        let mut added = vec![0.0; 2000];
        let jump = -(1.0 + RESTITUTION) * SPEED;
        for impact in (0..16).map(|k| FLIGHT * (f64::from(k) + 0.4)) {
            for (i, value) in added.iter_mut().enumerate() {
                let since = i as f64 - impact;
                if since.abs() < HALF {
                    let passed = sums[crate::signal::whole::index((since + HALF) * PARTS as f64)];
                    *value += jump * (passed / whole - f64::from(since >= 0.0));
                }
            }
        }
        added
    }

    /// With the drive that the impacts follow.
    fn record(values: &[f64]) -> Record {
        let drive = |i: usize| (std::f64::consts::TAU * i as f64 / FLIGHT).cos();
        let drive: Vec<f64> = (0..values.len()).map(drive).collect();
        Record::of(RATE_HZ, &[(Role::Drive, &drive), (Role::VelocityX, values)])
    }

    fn found(record: &Record) -> Detection {
        detect(record, RigKind::Single, &DetectSettings::default())
    }

    fn calm(record: &Record) -> Option<(Record, Detection)> {
        let found = found(record);
        calmed(record, &found, |smooth| {
            let settings = DetectSettings::default();
            detect_at(smooth, RigKind::Single, &settings, Some(&found))
        })
    }

    /// Usual deviation of a ratio of speeds from R.
    fn off(found: &Detection) -> f64 {
        let ratio = |i: &crate::event::Impact| {
            -i.approach_speed_after_m_s.unwrap() / i.approach_speed_before_m_s.unwrap()
        };
        let off = found.impacts.iter().map(|i| (ratio(i) - RESTITUTION).abs());
        crate::signal::robust::median(&off.collect::<Vec<f64>>()).unwrap()
    }

    #[test]
    fn valid_speeds_at_impacts_are_right_behind_the_filter_of_a_converter() {
        let added = ringing();
        let rings: Vec<f64> = flights().iter().zip(added).map(|(v, a)| v + a).collect();
        let rings = record(&rings);
        assert!(off(&found(&rings)) > 0.02, "{}", off(&found(&rings)));
        let (smooth, calm) = calm(&rings).expect("it rings");
        assert_eq!(calm.impacts.len(), 16);
        assert!(off(&calm) < 0.005, "{}", off(&calm));
        for (k, impact) in calm.impacts.iter().enumerate() {
            let late = impact.time_s * RATE_HZ - FLIGHT * (k as f64 + 0.4);
            assert!(late.abs() < 0.1, "{k}: {late}");
        }
        let smoothing = smooth.channels[1].smoothing.expect("smoothed");
        assert!(smoothing.reach_s < 10.0 / RATE_HZ);
    }

    #[test]
    fn a_velocity_that_does_not_ring_stays_as_it_was_measured() {
        assert!(calm(&record(&flights())).is_none());
    }
}
