//! Tail probabilities of Student's and of Fisher's distribution.

/// From this many degrees of freedom on, none are distinguished from infinitely many.
const MOST: f64 = 1e6;
/// Relative error of the continued fraction.
const ENOUGH: f64 = 1e-14;
/// Most terms of it: some √(a + b) suffice.
const TERMS: i32 = 20_000;

/// Probability that |t| of Student's distribution with ν degrees of freedom is exceeded.
pub(super) fn student_tail(t: f64, freedom: f64) -> f64 {
    let n = freedom.min(MOST);
    incomplete_beta(0.5 * n, 0.5, n / (n + t * t))
}

/// Probability that F of Fisher's distribution with two degrees of freedom is exceeded; infinite ones of
/// the second give that of χ²/ν₁.
pub(super) fn fisher_tail(f: f64, first: f64, second: f64) -> f64 {
    let n = second.min(MOST);
    incomplete_beta(0.5 * n, 0.5 * first, n / (n + first * f.max(0.0)))
}

/// The regularised incomplete beta function `I_x(a`, b), by its continued fraction (Abramowitz and
/// Stegun 26.5.8, Lentz's method).
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if !(x > 0.0) {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    let front =
        libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * x.ln() + b * (-x).ln_1p();
    if x < (a + 1.0) / (a + b + 2.0) {
        front.exp() * fraction(a, b, x) / a
    } else {
        1.0 - front.exp() * fraction(b, a, 1.0 - x) / b
    }
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
        let normal = student_tail(1.959_963_985, f64::INFINITY);
        assert!((normal - 0.05).abs() < 1e-6, "{normal}");
        assert!((student_tail(0.0, 7.0) - 1.0).abs() < 1e-12);
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
