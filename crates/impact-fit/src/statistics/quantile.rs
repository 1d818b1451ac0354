//! Quantiles of the normal, of Student's and of the χ² distribution.

use crate::statistics::distribution::{student_ln_slope, student_tail_at};

/// 97.5 % point of the normal distribution.
pub const NORMAL_975: f64 = 1.959_963_984_540_054;

/// 97.5 % point of Student's distribution with any number ν > 0 of degrees of freedom: where
/// [`student_tail`](super::distribution::student_tail) is 5 %, by Newton's method in the logarithms of both, in which the tail is concave, so
/// that every step from the second on comes from the same side. Infinite where it is beyond all numbers.
pub fn student_975(freedom: f64) -> f64 {
    if !(freedom > 0.0) {
        return f64::INFINITY;
    }
    if freedom >= SERIES {
        return hill_975(freedom);
    }
    let mut ln_t = NORMAL_975.ln();
    for _ in 0..MOST_STEPS {
        let tail = student_tail_at(ln_t, freedom).ln();
        let step = (tail - 0.05f64.ln()) / (student_ln_slope(ln_t, freedom) - tail).exp();
        ln_t += step;
        if step.abs() < 1e-14 * ln_t.abs() {
            break;
        }
    }
    ln_t.exp()
}

/// Degrees of freedom from which Hill's expansion is exact to rounding.
const SERIES: f64 = 2e3;
/// Steps of Newton's method, of which six to ten suffice.
const MOST_STEPS: usize = 60;

/// Hill's expansion of Student's 97.5 % point about the normal one.
fn hill_975(freedom: f64) -> f64 {
    let z = NORMAL_975;
    let square = z * z;
    let terms = [
        z * (square + 1.0) / 4.0,
        z * (3.0 + square * (16.0 + square * 5.0)) / 96.0,
        z * (-15.0 + square * (17.0 + square * (19.0 + square * 3.0))) / 384.0,
        z * (-945.0 + square * (-1920.0 + square * (1482.0 + square * (776.0 + square * 79.0))))
            / 92160.0,
    ];
    z + terms
        .iter()
        .rev()
        .fold(0.0, |sum, term| (sum + term) / freedom)
}

/// 99 % point of the χ² distribution (Wilson and Hilferty; within 2 % from 2 degrees of freedom on).
pub fn chi_squared_99(freedom: f64) -> f64 {
    const NORMAL_99: f64 = 2.326_347_874_040_841;
    let ninth = 2.0 / (9.0 * freedom);
    freedom * (1.0 - ninth + NORMAL_99 * ninth.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::distribution::student_tail;

    #[test]
    fn valid_quantiles_of_chi_squared() {
        // Tables: 9.210 (2), 15.086 (5), 18.475 (7), 23.209 (10), 37.566 (20).
        for (freedom, want) in [
            (2.0, 9.21),
            (5.0, 15.086),
            (7.0, 18.475),
            (10.0, 23.209),
            (20.0, 37.566),
        ] {
            assert!(
                (chi_squared_99(freedom) / want - 1.0).abs() < 0.02,
                "{freedom}"
            );
        }
    }

    #[test]
    fn valid_students_quantiles() {
        // Tables: 12.706 (1), 4.303 (2), 3.182 (3), 2.571 (5), 2.228 (10), 2.000 (60), 1.960.
        for (freedom, want) in [
            (1.0, 12.706_204_736_174_7),
            (2.0, 4.302_652_729_749_46),
            (3.0, 3.182_446_305_283_71),
            (5.0, 2.570_581_835_636_31),
            (10.0, 2.228_138_851_986_27),
            (60.0, 2.000_297_822_014_26),
        ] {
            let apart = student_975(freedom) / want - 1.0;
            assert!(apart.abs() < 1e-12, "{freedom}: {apart}");
        }
        assert_eq!(student_975(f64::INFINITY), NORMAL_975);
    }

    #[test]
    fn valid_students_quantiles_of_1_2_and_4_degrees_of_freedom_are_closed() {
        // tan(0.475 π), 0.95 √(2/0.0975), and 2 √(q − 1) with q = cos(⅓ arccos √α)/√α, α = 0.0975
        let alpha = 0.0975f64;
        let q = (alpha.sqrt().acos() / 3.0).cos() / alpha.sqrt();
        for (freedom, want) in [
            (1.0, (0.475 * std::f64::consts::PI).tan()),
            (2.0, 0.95 * (2.0 / alpha).sqrt()),
            (4.0, 2.0 * (q - 1.0).sqrt()),
        ] {
            let apart = student_975(freedom) / want - 1.0;
            assert!(apart.abs() < 1e-12, "{freedom}: {apart}");
        }
    }

    #[test]
    fn valid_students_quantiles_below_two_degrees_of_freedom() {
        // scipy.stats.t.ppf(0.975, ν)
        for (freedom, want) in [
            (0.25, 43_640.149_267_980_35),
            (0.5, 164.557_673_480_488_18),
            (1.0007, 12.685_220_407_993_402),
            (1.19, 8.786_227_475_547_996),
            (1.215, 8.451_441_349_688_524),
            (1.67, 5.229_529_908_369_298),
            (1.7, 5.118_838_988_253_057),
        ] {
            let apart = student_975(freedom) / want - 1.0;
            assert!(apart.abs() < 1e-11, "{freedom}: {apart}");
        }
    }

    #[test]
    fn prop_a_quantile_leaves_five_per_cent_and_falls_with_the_degrees_of_freedom() {
        let mut last = f64::INFINITY;
        for k in 0..400 {
            let freedom = 0.02 * 1.06f64.powi(k);
            let t = student_975(freedom);
            let tail = student_tail(t, freedom);
            assert!((tail - 0.05).abs() < 1e-11, "{freedom}: {t}, {tail}");
            assert!(t < last && t > NORMAL_975, "{freedom}");
            last = t;
        }
        assert_eq!(student_975(0.0), f64::INFINITY);
    }
}
