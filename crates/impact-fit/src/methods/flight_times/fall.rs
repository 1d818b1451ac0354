//! A fall and the rise after it, by their heights.

use impact_records::event::GRAVITY_M_S2;

/// A fall to an impact and the rise after it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fall {
    pub(super) before_m: f64,
    pub(super) after_m: f64,
    /// Number of the impact in its drop, from 0: beyond the first its fall is the rise after the one before.
    pub(super) bounce: usize,
}

impl Fall {
    /// Flights of the duration that the heights have in free fall, s.
    pub(super) fn flights_s(&self) -> [f64; 2] {
        [self.before_m, self.after_m].map(|h| (8.0 * h / GRAVITY_M_S2).sqrt())
    }

    /// What an error of 1 m of the height before changes of the logarithm of R, and one of the height after.
    fn slopes(&self) -> [f64; 2] {
        [-0.5 / self.before_m, 0.5 / self.after_m]
    }

    /// Covariance of the logarithms of two of consecutive falls, 1/m², for independent errors of 1 m of each height.
    pub(super) fn covariance(falls: &[Self], i: usize, k: usize) -> f64 {
        let (first, second) = (i.min(k), i.max(k));
        let ([before, after], [next, _]) = (falls[first].slopes(), falls[second].slopes());
        match second - first {
            0 => before * before + after * after,
            1 if falls[second].bounce > 0 => after * next,
            _ => 0.0,
        }
    }
}
