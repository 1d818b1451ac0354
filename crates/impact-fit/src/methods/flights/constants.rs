//! What the constant of a measured velocity is off by times of impacts that are late.
//!
//! It is that with which the mass returns: the mean of its velocity over the flights is zero. Where an impact is taken as e late, the
//! flight before it counts for e longer and the one after it for as much less, which is the fall of the velocity there times e; the
//! constant is off by the sum of these over the time of the flights, and every speed by minus as much.

use crate::methods::flights::node::Node;

/// What all speeds of a record are off by, of masses x and y; zero of velocities that are not measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Constants {
    /// By the time that all impacts are late by, m/s over s.
    pub by_late_m_s2: [f64; 2],
    /// Its deviation by what each impact is late by beside, m/s.
    pub deviation_m_s: [f64; 2],
}

impl Constants {
    /// Of a record whose impacts each have an error of their own.
    pub(super) fn of_record(nodes: &[Node], measured: [bool; 2]) -> Self {
        let ends = nodes.first().zip(nodes.last());
        let lasts_s = ends.map_or(0.0, |(first, last)| last.time_s - first.time_s);
        Self::of_motion(nodes, lasts_s, measured)
    }

    /// Of impacts within a time that repeat, each with the same error in every motion.
    pub(super) fn of_motion(nodes: &[Node], lasts_s: f64, measured: [bool; 2]) -> Self {
        if lasts_s <= 0.0 {
            return Self::default();
        }
        let falls = |mass: usize| {
            let nodes = nodes.iter().filter(move |_| measured[mass]);
            nodes.map(move |n| (n.before_m_s[mass] - n.after_m_s[mass], n.time_error_s))
        };
        let all = |mass: usize| falls(mass).map(|(fall_m_s, _)| fall_m_s).sum::<f64>();
        let squares = |mass: usize| {
            falls(mass)
                .map(|(fall_m_s, late_s)| (fall_m_s * late_s).powi(2))
                .sum::<f64>()
        };
        Self {
            by_late_m_s2: [0, 1].map(|mass| -all(mass) / lasts_s),
            deviation_m_s: [0, 1].map(|mass| squares(mass).sqrt() / lasts_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Impacts of a mass that climbs from −0.2 to 0.3 m/s between them, 0.1 s apart.
    fn nodes(time_error_s: f64) -> Vec<Node> {
        let node = |k: u32| Node {
            time_s: 0.1 * f64::from(k),
            time_error_s,
            drive_phase_rad: 0.0,
            before_m_s: [0.3, 0.0],
            after_m_s: [-0.2, 0.0],
            error_m_s: 1e-4,
            noise_m_s: 1e-4,
            corner_shifts: [None, None],
        };
        (0..3).map(node).collect()
    }

    #[test]
    fn valid_the_constant_of_a_velocity_is_off_by_its_falls_over_the_late_times() {
        // taken as 2 ms late, each flight has 2 ms at 0.3 m/s for 2 ms at −0.2 m/s: 1 mm in 0.1 s
        let one = Constants::of_motion(&nodes(2e-3)[..1], 0.1, [true, false]);
        assert!((one.by_late_m_s2[0] * 2e-3 + 1e-2).abs() < 1e-15);
        assert!((one.deviation_m_s[0] - 1e-2).abs() < 1e-15);
        assert_eq!((one.by_late_m_s2[1], one.deviation_m_s[1]), (0.0, 0.0));
        // errors of their own add up by their squares: √3 of 1 mm in 0.2 s
        let three = Constants::of_record(&nodes(2e-3), [true, false]);
        assert!((three.deviation_m_s[0] - 5e-3 * 3f64.sqrt()).abs() < 1e-15);
        // a velocity that was not measured has no constant
        let none = Constants::of_record(&nodes(2e-3), [false, false]);
        assert_eq!(none, Constants::default());
    }
}
