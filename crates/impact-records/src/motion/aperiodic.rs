//! Motions that do not close within the record: beats against chaos.

use serde::{Deserialize, Serialize};

use crate::event::Impact;
use crate::signal::whole;

/// Measures that distinguish a beat from chaos.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Irregularity {
    /// Fraction of the drive periods without an impact.
    pub impactless_periods: f64,
    /// Von Neumann's ratio of the approach speeds: mean square of successive differences over the
    /// variance; about 2 for an irregular sequence, small for one that swells and dies away.
    pub speed_roughness: f64,
}

/// Roughness below which the speeds swell and die away rather than jump about.
const SMOOTH: f64 = 0.8;

impl Irregularity {
    /// Of impacts in a record; `None` with fewer than four impacts.
    pub fn of(impacts: &[Impact], period_s: f64, duration_s: f64) -> Option<Self> {
        if impacts.len() < 4 {
            return None;
        }
        let periods = whole::index((duration_s / period_s).floor().max(1.0));
        let mut hit = vec![false; periods];
        for impact in impacts {
            if let Some(slot) = hit.get_mut(whole::index((impact.time_s / period_s).floor())) {
                *slot = true;
            }
        }
        let empty = hit.iter().filter(|h| !**h).count();
        Some(Self {
            impactless_periods: empty as f64 / periods as f64,
            speed_roughness: roughness(impacts),
        })
    }

    /// Whether the impacts come in bursts that swell and die away, with impactless periods
    /// between them.
    pub fn is_beat(&self) -> bool {
        self.impactless_periods > 0.1 && self.speed_roughness < SMOOTH
    }
}

fn roughness(impacts: &[Impact]) -> f64 {
    let speeds: Vec<f64> = impacts
        .iter()
        .filter_map(|i| i.approach_speed_before_m_s)
        .collect();
    let variance = crate::signal::robust::squares_about_mean(&speeds);
    let steps: f64 = speeds.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    if variance > 0.0 {
        steps / variance
    } else {
        2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn irregularity(impacts: &[(f64, f64)]) -> Option<Irregularity> {
        let impacts: Vec<Impact> = impacts.iter().map(|(t, v)| Impact::at(*t, *v)).collect();
        Irregularity::of(&impacts, 0.1, 1.0)
    }

    #[test]
    fn valid_roughness_and_impactless_periods_of_four_impacts() {
        // Variance sum 5 and step sum 3: 0.6; four of ten periods hold an impact.
        let rising = irregularity(&[(0.05, 1.0), (0.15, 2.0), (0.25, 3.0), (0.35, 4.0)]).unwrap();
        assert!((rising.speed_roughness - 0.6).abs() < 1e-12);
        assert!((rising.impactless_periods - 0.6).abs() < 1e-12);
        assert!(rising.is_beat());
        // Variance sum 1 and step sum 3: 3; an alternating sequence is no beat.
        let rough = irregularity(&[(0.05, 1.0), (0.15, 2.0), (0.25, 1.0), (0.35, 2.0)]).unwrap();
        assert!((rough.speed_roughness - 3.0).abs() < 1e-12);
        assert!(!rough.is_beat());
        assert_eq!(irregularity(&[(0.05, 1.0), (0.15, 2.0), (0.25, 3.0)]), None);
    }
}
