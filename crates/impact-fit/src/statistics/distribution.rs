//! Tail probabilities of the normal, of Student's and of Fisher's distribution.

use std::f64::consts::FRAC_1_SQRT_2;

/// From this many degrees of freedom on, Fisher's second ones are not distinguished from infinitely
/// many, and Student's tail is the normal one of a transformed t.
const MOST: f64 = 1e6;
/// Relative error of the continued fraction.
const ENOUGH: f64 = 1e-14;
/// Most terms of it: some √(a + b) suffice.
const TERMS: i32 = 20_000;

/// Probability that |z| of the normal distribution is exceeded.
pub fn normal_tail(z: f64) -> f64 {
    libm::erfc(z.abs() * FRAC_1_SQRT_2)
}

/// Probability that |t| of Student's distribution with any number ν > 0 of degrees of freedom is
/// exceeded. Above a million the normal one is taken of z = √((ν − ½) ln(1 + t²/ν)) (Hill 1970), whose
/// error is of order 1/ν².
pub fn student_tail(t: f64, freedom: f64) -> f64 {
    let t = t.abs();
    if freedom > MOST {
        let z = if freedom.is_finite() {
            ((freedom - 0.5) * (t * t / freedom).ln_1p()).sqrt()
        } else {
            t
        };
        return normal_tail(z);
    }
    incomplete_beta(0.5 * freedom, 0.5, student_ln_share(t.ln(), freedom))
}

/// The logarithm of ν/(ν + t²) from that of t, of any size.
pub(super) fn student_ln_share(ln_t: f64, freedom: f64) -> f64 {
    let ln_ratio = 2.0 * ln_t - freedom.ln();
    // ln(1 + e^x)
    -(ln_ratio.max(0.0) + (-ln_ratio.abs()).exp().ln_1p())
}

/// The logarithm of the slope of ln |t| of Student's tail with ν degrees of freedom, without its sign:
/// 2 t f(t), f the density.
pub(super) fn student_ln_slope(ln_t: f64, freedom: f64) -> f64 {
    let share = student_ln_share(ln_t, freedom);
    std::f64::consts::LN_2 - ln_beta(0.5 * freedom, 0.5) + ln_t - 0.5 * freedom.ln()
        + 0.5 * (freedom + 1.0) * share
}

/// The tail of Student's distribution at e^`ln_t`.
pub(super) fn student_tail_at(ln_t: f64, freedom: f64) -> f64 {
    incomplete_beta(0.5 * freedom, 0.5, student_ln_share(ln_t, freedom))
}

/// Probability that F of Fisher's distribution with two degrees of freedom is exceeded; infinite ones of
/// the second give that of χ²/ν₁.
pub fn fisher_tail(f: f64, first: f64, second: f64) -> f64 {
    let n = second.min(MOST);
    incomplete_beta(0.5 * n, 0.5 * first, -(first * f.max(0.0) / n).ln_1p())
}

/// The regularised incomplete beta function `I_x(a`, b) at the logarithm of x, by its continued fraction
/// (Abramowitz and Stegun 26.5.8, Lentz's method).
fn incomplete_beta(a: f64, b: f64, ln_x: f64) -> f64 {
    if !(ln_x < 0.0) {
        return 1.0;
    }
    let (x, rest) = (ln_x.exp(), -ln_x.exp_m1());
    let front = (a * ln_x + b * rest.ln() - ln_beta(a, b)).exp();
    if x < (a + 1.0) / (a + b + 2.0) {
        front * fraction(a, b, x) / a
    } else {
        1.0 - front * fraction(b, a, rest) / b
    }
}

/// The logarithm of the beta function. That of a large a and b = ½ is by Stirling's series of the ratio
/// of both gamma functions, which are large and nearly equal.
fn ln_beta(a: f64, b: f64) -> f64 {
    if b == 0.5 && a > 50.0 {
        let square = (a * a).recip();
        let ratio =
            -0.125 + square * (1.0 / 192.0 + square * (-1.0 / 640.0 + square * 17.0 / 14336.0));
        return libm::lgamma(b) - 0.5 * a.ln() - ratio / a;
    }
    libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b)
}

/// The continued fraction of [`incomplete_beta`].
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    let safe = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let (mut c, mut d) = (1.0, 1.0 / safe(1.0 - (a + b) * x / (a + 1.0)));
    let mut value = d;
    for term in 1..TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for factor in [even, odd] {
            d = 1.0 / safe(1.0 + factor * d);
            c = safe(1.0 + factor / c);
            change = c * d;
            value *= change;
        }
        if (change - 1.0).abs() < ENOUGH {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_students_tails_are_those_of_tables() {
        // two-sided 5 %: 12.706 (1), 2.776 (4), 2.228 (10), 1.960
        for (freedom, t) in [
            (1.0, 12.706_204_736),
            (4.0, 2.776_445_105),
            (10.0, 2.228_138_852),
        ] {
            assert!((student_tail(t, freedom) - 0.05).abs() < 1e-9, "{freedom}");
        }
        let normal = student_tail(1.959_963_984_540_054, f64::INFINITY);
        assert!((normal - 0.05).abs() < 1e-14, "{normal}");
        assert!((student_tail(0.0, 7.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn valid_students_tail_of_1_2_and_4_degrees_of_freedom_is_closed() {
        let share = |t: f64, freedom: f64| {
            // ∫ of the density from −t to t, with x = t/√(ν + t²)
            let x = t / (freedom + t * t).sqrt();
            match freedom {
                1.0 => 2.0 / std::f64::consts::PI * t.atan(),
                2.0 => x,
                _ => 1.5 * x - 0.5 * x.powi(3),
            }
        };
        for freedom in [1.0, 2.0, 4.0] {
            for t in [1e-3, 0.1, 0.7, 1.3, 2.0, 5.0, 13.0, 90.0] {
                let apart = student_tail(t, freedom) - (1.0 - share(t, freedom));
                assert!(apart.abs() < 1e-13, "{t}, {freedom}: {apart}");
            }
        }
    }

    #[test]
    fn valid_students_tail_is_the_integral_of_its_density() {
        // Simpson's rule over s = ln t of 2 t f(t), where both ends are negligible; the tail beyond the
        // upper end is that of the power t^−ν.
        for freedom in [0.3f64, 0.8, 1.19, 1.7, 2.4, 7.7, 60.0, 300.0] {
            let constant = (libm::lgamma(0.5 * (freedom + 1.0)) - libm::lgamma(0.5 * freedom))
                .exp()
                / (freedom * std::f64::consts::PI).sqrt();
            let slope = |s: f64| {
                let t = s.exp();
                2.0 * t * constant * (1.0 + t * t / freedom).powf(-0.5 * (freedom + 1.0))
            };
            let (low, high, steps) = (1.5f64.ln(), 30.0, 60_000);
            let h = (high - low) / f64::from(steps);
            let at = |k: i32| slope(low + h * f64::from(k));
            let weight = |k: i32| if k % 2 == 0 { 2.0 } else { 4.0 };
            let inner: f64 = (1..steps).map(|k| weight(k) * at(k)).sum();
            let integral = h / 3.0 * (at(0) + inner + at(steps)) + slope(high) / freedom;
            let apart = student_tail(1.5, freedom) / integral - 1.0;
            assert!(apart.abs() < 1e-9, "{freedom}: {apart}");
        }
    }

    #[test]
    fn valid_p_values_of_the_normal_distribution() {
        assert!((normal_tail(1.959_963_984_540_054) - 0.05).abs() < 1e-15);
        assert!((normal_tail(0.0) - 1.0).abs() < 1e-15);
        assert!((normal_tail(-3.290_526_731_491_895) - 0.001).abs() < 1e-15);
    }

    #[test]
    fn valid_fishers_tails_are_those_of_tables() {
        // upper 5 %: F(1, 10) 4.9646, F(4, 20) 2.8661; χ²(4) 9.4877
        for (f, first, second) in [(4.964_602_74, 1.0, 10.0), (2.866_081_40, 4.0, 20.0)] {
            assert!((fisher_tail(f, first, second) - 0.05).abs() < 1e-8, "{f}");
        }
        let chi2 = fisher_tail(9.487_729_037 / 4.0, 4.0, f64::INFINITY);
        assert!((chi2 - 0.05).abs() < 1e-5, "{chi2}");
    }

    #[test]
    fn prop_tails_fall_from_one_to_zero() {
        for freedom in [1.0, 3.5, 40.0, 1e5] {
            let tails: Vec<f64> = (0..60)
                .map(|i| fisher_tail(0.25 * f64::from(i), 3.0, freedom))
                .collect();
            assert_eq!(tails[0], 1.0);
            assert!(
                tails
                    .windows(2)
                    .all(|w| w[1] <= w[0] + 1e-12 && w[1] >= 0.0)
            );
        }
    }
}
