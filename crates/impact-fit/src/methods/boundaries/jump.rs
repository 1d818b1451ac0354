//! Where a motion jumps as a sweep nears a boundary: disturbances make it jump early, by an exponentially
//! distributed distance, never late but for a small error of the setting. A step of the setting is a disturbance too, by which
//! a motion is thrown out from farther away, or not at all.

use std::f64::consts::{PI, SQRT_2};

use impact_records::motion::{BoundaryKind, Bracket};
use impact_records::record::Sweep;

/// How often a change of z = 1/n is not that of the nearest s1 (other doubled motions lie beside it)
/// or, for n > 1, not that of the nearest s2 (an impact more may end it first).
const STRAY: f64 = 0.3;
/// Frequencies over which such a change may lie, relative.
const STRAY_RANGE: f64 = 0.6;
/// How far from s1, relative to the frequency, a record may still show the motion of the other side:
/// it settles there as slowly as a multiplier near −1 lets it.
const SLOW_DOUBLING: f64 = 5e-3;
/// Relative error of a frequency setting.
const SETTING_ERROR: f64 = 2e-4;
/// Least probability of a bracket.
const LEAST: f64 = 1e-280;

/// How early jumps come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Early {
    /// Mean distance from the boundary, relative to the frequency.
    pub scale: f64,
    /// Share of the jumps that are early, the others coming at the boundary.
    pub share: f64,
}

impl Early {
    /// All of them early.
    pub const fn all(scale: f64) -> Self {
        Self { scale, share: 1.0 }
    }

    /// Half of them early.
    pub const fn half(scale: f64) -> Self {
        Self { scale, share: 0.5 }
    }
}

/// The jump that a bracket holds.
#[derive(Debug, Clone, Copy)]
pub struct Jump {
    low: f64,
    high: f64,
    early: f64,
    /// Share of the jumps that are early.
    thrown: f64,
    setting: f64,
    rising: bool,
    /// Probability that the bracket holds no such boundary at all, over its width.
    stray: f64,
}

/// Logarithm of a probability over a frequency, with its first and second derivative.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tilt {
    /// The logarithm.
    pub log: f64,
    /// Its slope, 1/Hz.
    pub slope: f64,
    /// Its curvature, 1/Hz².
    pub curvature: f64,
}

impl Tilt {
    /// Of a probability with its derivatives; flat where it vanishes.
    pub fn of([value, slope, curvature]: [f64; 3]) -> Self {
        if value < LEAST {
            return Self {
                log: LEAST.ln(),
                ..Self::default()
            };
        }
        let slope = slope / value;
        Self {
            log: value.ln(),
            slope,
            curvature: curvature / value - slope * slope,
        }
    }
}

impl Jump {
    /// Of a bracket.
    pub fn of(bracket: &Bracket, early: Early) -> Self {
        let middle = bracket.middle_hz();
        let known = (SETTING_ERROR * middle).max(0.02 * bracket.width_hz());
        let (setting, stray) = match (bracket.kind, bracket.periods_n) {
            (BoundaryKind::PeriodDoubling, _) => (SLOW_DOUBLING * middle, STRAY),
            (BoundaryKind::SaddleNode, 2..) => (known, STRAY),
            _ => (known, 0.0),
        };
        Self {
            low: bracket.frequency_low_hz,
            high: bracket.frequency_high_hz,
            early: early.scale * middle,
            thrown: early.share,
            setting,
            rising: bracket.sweep != Sweep::Down,
            stray,
        }
    }

    /// The same of a boundary that may be seen anywhere within a range, Hz.
    #[must_use]
    pub fn seen_within(self, range_hz: f64) -> Self {
        Self {
            setting: self.setting.hypot(range_hz / 12f64.sqrt()),
            ..self
        }
    }

    /// Probability that the jump falls into the bracket when the boundary lies at a frequency, or
    /// is none of this boundary.
    pub fn probability(&self, boundary_hz: f64) -> f64 {
        self.derivatives(boundary_hz, self.setting)[0].max(LEAST)
    }

    /// The same where the boundary is normally distributed about a frequency, over that frequency.
    pub fn about(&self, boundary_hz: f64, variance_hz2: f64) -> Tilt {
        let setting = self.setting.hypot(variance_hz2.max(0.0).sqrt());
        let found = self.derivatives(boundary_hz, setting);
        if found[0] < LEAST {
            self.far(boundary_hz, setting)
        } else {
            Tilt::of(found)
        }
    }

    /// The same of a boundary so far off that the probability itself would vanish.
    fn far(&self, boundary: f64, s: f64) -> Tilt {
        let (near, far, sign) = self.ends(boundary);
        let e = self.early;
        let normal = |x: f64| {
            let score = x / s;
            Tilt {
                log: -0.5 * score * score - (score.abs() * (2.0 * PI).sqrt()).ln(),
                slope: -sign * score / s,
                curvature: -(s * s).recip(),
            }
        };
        if near > 0.0 {
            let (tail, later) = (normal(near), s / e);
            let lasting = 1.0 - self.thrown + self.thrown * later / (near / s + later);
            let log = tail.log + lasting.ln();
            return Tilt { log, ..tail };
        }
        if far / s + s / e > 0.0 {
            return normal(far);
        }
        let inside = -(-(far - near) / e).exp_m1();
        Tilt {
            log: far / e + 0.5 * (s / e).powi(2) + (self.thrown * inside).ln(),
            slope: sign / e,
            curvature: 0.0,
        }
    }

    /// By how much the ends lie above the boundary (of a falling sweep: below), and the sign of that over the
    /// boundary.
    fn ends(&self, boundary: f64) -> (f64, f64, f64) {
        if self.rising {
            (self.low - boundary, self.high - boundary, -1.0)
        } else {
            (boundary - self.high, boundary - self.low, 1.0)
        }
    }

    /// The probability with a given deviation of the setting, and its derivatives over the boundary.
    fn derivatives(&self, boundary: f64, setting: f64) -> [f64; 3] {
        let (near, far, sign) = self.ends(boundary);
        // Above the boundary what is left of the distribution is taken: the difference from 1 would be rounded off.
        let above = near > 0.0;
        let [near, far] = [near, far].map(|x| self.distribution(x, setting, above));
        let mut held: [f64; 3] = std::array::from_fn(|i| far[i] - near[i]);
        if above {
            held[0] = near[0] - far[0];
        }
        let middle = 0.5 * (self.low + self.high);
        let anywhere = (self.high - self.low) / (STRAY_RANGE * middle);
        let share = 1.0 - self.stray;
        [
            share * held[0] + self.stray * anywhere,
            share * sign * held[1],
            share * held[2],
        ]
    }

    /// Distribution function of (jump − boundary) for a rising sweep, a normal error less, of those that are early, an
    /// exponential one (or what it lacks of 1), its density, and that one's slope.
    fn distribution(&self, x: f64, s: f64, lacking: bool) -> [f64; 3] {
        let e = self.early;
        let (score, later) = (x / s, x / s + s / e);
        let mixed = match later < 5.0 {
            true => (x / e + 0.5 * (s / e).powi(2)).exp() * normal(-later),
            // the same by Mills' ratio: the exponential alone would overflow
            false => density(score) * mills_ratio(later),
        };
        let density = density(score) / s;
        let (thrown, mixed) = (self.thrown, self.thrown * mixed);
        [
            if lacking {
                normal(-score) - mixed
            } else {
                normal(score) + mixed
            },
            (1.0 - thrown) * density + mixed / e,
            -(1.0 - thrown) * density * score / s + (mixed / e - thrown * density) / e,
        ]
    }

    /// Boundary frequency at which the bracket is most likely, and that probability.
    pub fn best(&self) -> (f64, f64) {
        let count = 60;
        let span = self.high - self.low + 4.0 * self.setting;
        (0..=count)
            .map(|i| self.low - 2.0 * self.setting + span * f64::from(i) / f64::from(count))
            .map(|f| (f, self.probability(f)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((0.5 * (self.low + self.high), 1.0))
    }
}

/// Normal distribution function.
pub fn normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// Density of the normal distribution.
pub fn density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / (2.0 * PI).sqrt()
}

/// (1 − Φ(x))/φ(x) for x of 5 and more: Laplace's continued fraction.
pub fn mills_ratio(x: f64) -> f64 {
    let fraction = (1..=12).rev().fold(x, |below, k| x + f64::from(k) / below);
    fraction.recip()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jump(rising: bool, stray: f64) -> Jump {
        Jump {
            low: 13.0,
            high: 13.2,
            early: 0.05,
            thrown: 1.0,
            setting: 0.01,
            rising,
            stray,
        }
    }

    #[test]
    fn valid_derivatives_are_those_of_differences() {
        for (rising, stray, thrown) in [(true, 0.0, 1.0), (false, 0.3, 1.0), (true, 0.0, 0.5)] {
            let jump = Jump {
                thrown,
                ..jump(rising, stray)
            };
            for at in [12.97, 13.03, 13.19, 13.25] {
                let of = |f: f64| jump.about(f, 4e-4);
                let step = 1e-5;
                let (below, here, above) = (of(at - step), of(at), of(at + step));
                let slope = (above.log - below.log) / (2.0 * step);
                let curvature = (above.slope - below.slope) / (2.0 * step);
                assert!(
                    (here.slope - slope).abs() < 1e-5 * (1.0 + slope.abs()),
                    "{at}"
                );
                assert!(
                    (here.curvature - curvature).abs() < 1e-4 * (1.0 + curvature.abs()),
                    "{at}"
                );
            }
        }
    }

    #[test]
    fn valid_a_boundary_far_off_goes_on_where_its_probability_would_vanish() {
        // about 36 deviations of the setting below, and 640 scales of early jumps above, the probability leaves
        // the range of numbers
        for rising in [true, false] {
            let jump = jump(rising, 0.0);
            for at in [13.0 - 0.357, 13.2 + 32.0, 13.2 + 0.357, 13.0 - 32.0] {
                let (near, far) = (jump.about(at, 0.0), jump.far(at, jump.setting));
                assert!(
                    (near.log / far.log - 1.0).abs() < 0.01,
                    "{at} {near:?} {far:?}"
                );
                assert!(
                    (near.slope / far.slope - 1.0).abs() < 0.01,
                    "{at} {near:?} {far:?}"
                );
            }
        }
    }

    #[test]
    fn valid_both_forms_of_the_mixed_distribution_meet_where_one_takes_over() {
        let jump = jump(true, 0.0);
        // x/s + s/e = 5 at x = 0.048 with s = 0.01, e = 0.05
        let [below, above] =
            [0.048 - 1e-9, 0.048 + 1e-9].map(|x| jump.distribution(x, 0.01, false));
        for (a, b) in below.iter().zip(&above) {
            assert!(
                (a - b).abs() < 1e-6 * (1.0 + a.abs()),
                "{below:?} {above:?}"
            );
        }
        // 1 − Φ(5) = 2.866516e-7
        assert!((mills_ratio(5.0) * density(5.0) / 2.866_515_7e-7 - 1.0).abs() < 1e-7);
    }

    #[test]
    fn valid_a_boundary_that_is_uncertain_is_the_mean_over_where_it_may_lie() {
        let jump = jump(true, 0.0);
        let (centre, deviation) = (13.1, 0.08);
        let step = 1e-3;
        let mean: f64 = (-400..=400)
            .map(|i| f64::from(i) * step)
            .map(|x| density(x / deviation) / deviation * jump.probability(centre + x) * step)
            .sum();
        let found = jump.about(centre, deviation * deviation).log.exp();
        assert!((found - mean).abs() < 1e-5, "{found} {mean}");
    }
}
