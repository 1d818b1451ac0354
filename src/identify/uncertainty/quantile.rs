//! Quantiles of the normal, of Student's and of the χ² distribution.

/// 97.5 % point of the normal distribution.
pub const NORMAL_975: f64 = 1.959_963_984_540_054;

/// 97.5 % point of Student's distribution (Hill's expansion about the normal one; better than 1 %
/// from 2 degrees of freedom on, below which 2 are taken).
pub fn student_975(freedom: f64) -> f64 {
    let n = freedom.max(2.0);
    let z = NORMAL_975;
    let square = z * z;
    let terms = [
        z * (square + 1.0) / 4.0,
        z * (3.0 + square * (16.0 + square * 5.0)) / 96.0,
        z * (-15.0 + square * (17.0 + square * (19.0 + square * 3.0))) / 384.0,
        z * (-945.0 + square * (-1920.0 + square * (1482.0 + square * (776.0 + square * 79.0))))
            / 92160.0,
    ];
    let series = terms.iter().rev().fold(0.0, |sum, term| (sum + term) / n);
    z + series
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
        // Tables: 12.706 (1, not met), 4.303 (2), 3.182 (3), 2.571 (5), 2.228 (10), 1.960.
        for (freedom, want) in [(2.0, 4.303), (3.0, 3.182), (5.0, 2.571), (10.0, 2.228)] {
            assert!(
                (student_975(freedom) / want - 1.0).abs() < 0.01,
                "{freedom}"
            );
        }
        assert!((student_975(f64::INFINITY) - NORMAL_975).abs() < 1e-12);
    }
}
