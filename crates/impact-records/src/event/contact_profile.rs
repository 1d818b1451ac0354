//! How a linear contact, a spring and a damper that only press, changes the velocity in time.

use std::iter::successors;

use impact_oscillator::model::path::C64;

use crate::signal::whole;

/// A linear contact of a given restitution, in shares of its duration.
///
/// With u'' + 2ζω u' + ω² u = 0 from u = 0 until the press ends, ω√(1−ζ²)T = φ = π − 2α and
/// ζ = sin α, where R = e^{−κ}, κ = φ tan α.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ContactProfile {
    restitution: f64,
    decay: f64,
    angle: f64,
}

impl ContactProfile {
    /// The profile for R; it is that of R = 0.15 below (a linear contact has R > 0.135).
    pub(super) fn new(restitution: f64) -> Self {
        let restitution = restitution.clamp(0.15, 1.0);
        let decay = -restitution.ln();
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if (std::f64::consts::PI - 2.0 * middle) * middle.tan() < decay {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self {
            restitution,
            decay,
            angle: std::f64::consts::PI - 2.0 * low,
        }
    }

    /// Share of the change of velocity that is done at a share of the duration.
    pub(super) fn done(&self, share: f64) -> f64 {
        if share <= 0.0 {
            return 0.0;
        }
        if share >= 1.0 {
            return 1.0;
        }
        self.done_at(self.vibration(share))
    }

    /// e^{(−κ + iφ)s} at a share s of the duration.
    fn vibration(&self, share: f64) -> C64 {
        C64::from_polar((-self.decay * share).exp(), self.angle * share)
    }

    /// What is done where the vibration is at a value.
    fn done_at(&self, vibration: C64) -> f64 {
        let speed = vibration.re - self.decay / self.angle * vibration.im;
        (1.0 - speed) / (1.0 + self.restitution)
    }

    /// Slope of what is done, over the share of the duration, where the vibration is at a value.
    fn slope_at(&self, vibration: C64) -> f64 {
        let (damping, rate) = (self.decay, self.angle);
        let across = rate - damping * damping / rate;
        let fall = 2.0 * damping * vibration.re + across * vibration.im;
        fall / (1.0 + self.restitution)
    }

    /// Share of the duration by which the mean instant of the impulse follows first touch.
    pub(super) fn centre(&self) -> f64 {
        (self.restitution + self.drift()) / (1.0 + self.restitution)
    }

    /// Change of the speed at the end of contact by a constant acceleration that acts beside the
    /// contact, over what it would be without the contact's spring: R sin φ/φ.
    pub(super) fn drift(&self) -> f64 {
        self.restitution * self.angle.sin() / self.angle
    }
}

/// A profile by cubics between even places, where it is asked for many times: within 1e-10 of it.
pub(super) struct TabulatedProfile {
    /// Of each cubic its coefficients, of the constant first.
    cubics: Vec<[f64; 4]>,
}

/// Cubics that a tabulated profile consists of.
const CUBICS: usize = 512;

impl TabulatedProfile {
    /// Of a profile.
    pub(super) fn new(profile: &ContactProfile) -> Self {
        let width = (CUBICS as f64).recip();
        let turn = profile.vibration(width);
        let vibration = successors(Some(C64::new(1.0, 0.0)), |v| Some(v * turn));
        let ends = vibration.map(|v| [profile.done_at(v), width * profile.slope_at(v)]);
        let ends: Vec<[f64; 2]> = ends.take(CUBICS + 1).collect();
        // Hermite's, by the values and slopes at both ends
        let cubic = |ends: &[[f64; 2]]| {
            let [[a, slope_a], [b, slope_b]] = [ends[0], ends[1]];
            let rise = b - a;
            let [square, cube] = [
                3.0 * rise - 2.0 * slope_a - slope_b,
                slope_a + slope_b - 2.0 * rise,
            ];
            [a, slope_a, square, cube]
        };
        Self {
            cubics: ends.windows(2).map(cubic).collect(),
        }
    }

    /// Share of the change of velocity that is done at a share of the duration.
    pub(super) fn done(&self, share: f64) -> f64 {
        if share <= 0.0 {
            return 0.0;
        }
        if share >= 1.0 {
            return 1.0;
        }
        let place = CUBICS as f64 * share;
        let i = whole::index(place);
        let [a, slope, square, cube] = self.cubics[i];
        let t = place - i as f64;
        a + t * (slope + t * (square + t * cube))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_the_profile_of_an_elastic_contact_is_a_half_sine_force() {
        let profile = ContactProfile::new(1.0);
        for share in [0.1, 0.5, 0.7] {
            let expected = 0.5 * (1.0 - (std::f64::consts::PI * share).cos());
            assert!((profile.done(share) - expected).abs() < 1e-9);
        }
        assert!((profile.centre() - 0.5).abs() < 1e-9 && profile.drift() < 1e-9);
    }

    #[test]
    fn prop_a_tabulated_profile_is_the_profile() {
        for restitution in [0.15, 0.4, 0.7, 0.93, 1.0] {
            let profile = ContactProfile::new(restitution);
            let tabulated = TabulatedProfile::new(&profile);
            for i in -100..=10_100 {
                let share = f64::from(i) * 1e-4;
                let apart = tabulated.done(share) - profile.done(share);
                assert!(apart.abs() < 1e-10, "{restitution} {share}: {apart:e}");
            }
        }
    }

    #[test]
    fn prop_the_profile_rises_from_nothing_to_all_about_its_centre() {
        for restitution in [0.2, 0.5, 0.8, 0.95] {
            let profile = ContactProfile::new(restitution);
            let shares: Vec<f64> = (0..=2000).map(|i| f64::from(i) / 2000.0).collect();
            let done: Vec<f64> = shares.iter().map(|s| profile.done(*s)).collect();
            assert!(done.windows(2).all(|w| w[1] >= w[0]));
            assert!(
                (profile.done(1.0 - 1e-9) - 1.0).abs() < 1e-6,
                "{restitution}"
            );
            // mean instant of the impulse: the integral of what is not yet done
            let left: f64 = done.iter().map(|d| (1.0 - d) / 2000.0).sum();
            assert!(
                (left - 0.5 / 2000.0 - profile.centre()).abs() < 1e-6,
                "{restitution}"
            );
        }
    }
}
