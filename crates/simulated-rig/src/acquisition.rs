//! The rig's electronics: integrators with a high-pass, gains, noise, contact, converter.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::effects::RigEffects;
use crate::truth::{Faults, TrueImpact};

/// Samples per second, Hz.
pub const RATE_HZ: f64 = 2000.0;
/// Full scale of the converter, V (±).
pub const FULL_SCALE_V: f64 = 5.0;

/// First-order high-pass x → y, y' + `ω_c` y = x', run at a fine step.
#[derive(Debug, Clone)]
pub struct SensorHighPass {
    low: f64,
    decay: f64,
}

impl SensorHighPass {
    /// A high-pass of the given corner for samples `step_s` apart.
    pub fn new(corner_hz: f64, step_s: f64) -> Self {
        Self {
            low: 0.0,
            decay: (-std::f64::consts::TAU * corner_hz * step_s).exp(),
        }
    }

    /// The next sample; `mean` is the input's mean since the last one, which a jump between
    /// samples makes differ from the mean of both samples.
    pub fn next(&mut self, input: f64, mean: f64) -> f64 {
        self.low = self.decay * self.low + (1.0 - self.decay) * mean;
        input - self.low
    }
}

/// Add noise and round as the converter does, V to V.
pub fn convert(volts: &mut [f64], faults: &Faults, rng: &mut ChaCha8Rng) {
    let step = converter_step(faults);
    for v in volts {
        let normal: f64 = StandardNormal.sample(rng);
        *v += faults.noise_v * normal;
        if let Some(step) = step {
            *v = (*v / step)
                .round()
                .clamp(-FULL_SCALE_V / step, FULL_SCALE_V / step - 1.0)
                * step;
        }
    }
}

/// Step of the converter, V.
pub fn converter_step(faults: &Faults) -> Option<f64> {
    faults
        .converter_bits
        .map(|bits| 2.0 * FULL_SCALE_V / 2f64.powi(i32::try_from(bits).unwrap_or(i32::MAX)))
}

/// Voltage of the contact at each of the given times: 5 V while it is closed, at least for the
/// length of its pulse.
pub fn contact_volts(
    times_s: &[f64],
    impacts: &[TrueImpact],
    faults: &Faults,
    rng: &mut ChaCha8Rng,
) -> Vec<f64> {
    let mut closed: Vec<(f64, f64)> = Vec::new();
    for impact in impacts {
        let time = impact.time_s;
        if impact.dead_zone_s > 0.0 {
            closed.push((time, time + impact.dead_zone_s.min(1e3)));
            continue;
        }
        if rng.random_bool(faults.missed_probability) {
            continue;
        }
        closed.push((time, time + faults.contact_pulse_s.max(impact.duration_s)));
        if rng.random_bool(faults.bounce_probability) {
            let again = time + impact.duration_s + rng.random_range(0.7e-3..1.5e-3);
            closed.push((again, again + 0.7 * faults.contact_pulse_s));
        }
    }
    times_s
        .iter()
        .map(|t| {
            if closed.iter().any(|(a, b)| (*a..*b).contains(t)) {
                4.8
            } else {
                0.02
            }
        })
        .collect()
}

/// Frequency of the mains, Hz.
const MAINS_HZ: f64 = 50.0;
/// Corner of the slowest process that makes up the 1/f noise, Hz; the others are octaves above.
const SLOWEST_HZ: f64 = 0.25;
/// Number of those processes: up to half the rate of sampling.
const OCTAVES: usize = 12;

/// Noise that is not white: 1/f noise, a sum of first-order processes an octave apart with equal
/// variances, and mains hum at a phase of its own in every record.
#[derive(Debug)]
pub struct Disturbance {
    flicker_v: f64,
    hum_v: f64,
    hum_phase_rad: f64,
    rng: ChaCha8Rng,
}

impl Disturbance {
    /// That of one record of a campaign.
    pub fn new(effects: &RigEffects, seed: u64, record: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0xF11C_4E12);
        rng.set_stream(record as u64);
        Self {
            flicker_v: effects.flicker_v,
            hum_v: effects.hum_v,
            hum_phase_rad: rng.random_range(0.0..std::f64::consts::TAU),
            rng,
        }
    }

    /// Add it to the next channel, V.
    pub fn add(&mut self, volts: &mut [f64]) {
        if self.flicker_v > 0.0 {
            for octave in 0..OCTAVES {
                self.add_process(
                    SLOWEST_HZ * 2f64.powi(i32::try_from(octave).unwrap_or(i32::MAX)),
                    volts,
                );
            }
        }
        if self.hum_v > 0.0 {
            for (i, v) in volts.iter_mut().enumerate() {
                let turns = MAINS_HZ * i as f64 / RATE_HZ;
                *v += self.hum_v * (std::f64::consts::TAU * turns + self.hum_phase_rad).sin();
            }
        }
    }

    /// One stationary first-order process.
    fn add_process(&mut self, corner_hz: f64, volts: &mut [f64]) {
        let deviation = self.flicker_v / (OCTAVES as f64).sqrt();
        let decay = (-std::f64::consts::TAU * corner_hz / RATE_HZ).exp();
        let fresh = deviation * (1.0 - decay * decay).sqrt();
        let mut normal = || -> f64 { StandardNormal.sample(&mut self.rng) };
        let mut value = deviation * normal();
        for v in volts {
            *v += value;
            value = decay * value + fresh * normal();
        }
    }
}
