//! Quantiles of the normal and of Student's distribution.

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

#[cfg(test)]
mod tests {
    use super::*;

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
