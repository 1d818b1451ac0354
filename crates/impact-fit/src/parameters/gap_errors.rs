//! Errors of the stated clearances that carry one of their own.

use serde::{Deserialize, Serialize};

/// Most stated clearances that carry an error of their own.
pub const MOST_GAPS: usize = 48;

/// Errors of the stated clearances, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<f64>", into = "Vec<f64>")]
pub struct GapErrors([f64; MOST_GAPS]);

impl GapErrors {
    /// Error of a clearance by its place; zero beyond the last.
    pub fn of(&self, place: usize) -> f64 {
        self.0.get(place).copied().unwrap_or(0.0)
    }

    /// Set the error of a clearance; nothing beyond the last.
    pub fn set(&mut self, place: usize, error_m: f64) {
        if let Some(error) = self.0.get_mut(place) {
            *error = error_m;
        }
    }
}

impl Default for GapErrors {
    fn default() -> Self {
        Self([0.0; MOST_GAPS])
    }
}

impl From<Vec<f64>> for GapErrors {
    fn from(errors: Vec<f64>) -> Self {
        let mut all = Self::default();
        for (place, error) in all.0.iter_mut().zip(errors) {
            *place = error;
        }
        all
    }
}

impl From<GapErrors> for Vec<f64> {
    fn from(errors: GapErrors) -> Self {
        let used = errors.0.iter().rposition(|e| *e != 0.0);
        errors.0[..used.map_or(0, |last| last + 1)].to_vec()
    }
}
