//! The rig's electronics: integrators with a high-pass, gains, noise, contact, converter.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::synthetic::truth::Faults;

/// Full scale of the converter, V (±).
pub const FULL_SCALE_V: f64 = 5.0;

/// First-order high-pass x → y, y' + ω_c y = x', run at a fine step.
#[derive(Debug, Clone)]
pub struct HighPass {
    low: f64,
    decay: f64,
}

impl HighPass {
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
        .map(|bits| 2.0 * FULL_SCALE_V / 2f64.powi(bits as i32))
}

/// Voltage of the contact at each sample: 5 V while it is closed.
///
/// `impacts`: time and length of the dead zone of each, s.
pub fn contact_volts(
    times_s: &[f64],
    impacts: &[(f64, f64)],
    faults: &Faults,
    rng: &mut ChaCha8Rng,
) -> Vec<f64> {
    let mut closed: Vec<(f64, f64)> = Vec::new();
    for &(time, dead_zone) in impacts {
        if dead_zone > 0.0 {
            closed.push((time, time + dead_zone.min(1e3)));
            continue;
        }
        if rng.random_bool(faults.missed_probability) {
            continue;
        }
        closed.push((time, time + faults.contact_pulse_s));
        if rng.random_bool(faults.bounce_probability) {
            let again = time + rng.random_range(0.7e-3..1.5e-3);
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
