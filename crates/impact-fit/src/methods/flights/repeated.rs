//! The impacts of a periodic motion as those of one motion.
//!
//! What readings of times and speeds are off by the place of an impact between samples and arcs is alike in every motion, so
//! that no number of them averages it out; noise is.

use std::f64::consts::TAU;

use crate::methods::flights::node::Node;
use impact_records::signal::robust;

/// Fewest motions that show that they repeat.
const MOTIONS: usize = 3;

/// Part of a motion by which an impact may be off its place: others do not repeat each other.
const IN_PLACE: f64 = 0.05;

/// When a motion repeats itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Repeats {
    /// After so many impacts.
    pub impacts: usize,
    /// After so many periods of the drive.
    pub periods: u32,
    /// Frequency of the drive, Hz.
    pub frequency_hz: f64,
}

impl Repeats {
    /// The time of a motion, s.
    pub(super) fn after_s(self) -> f64 {
        f64::from(self.periods) / self.frequency_hz
    }
}

/// The means of impacts that repeat each other; `None` where they do not.
pub(super) fn as_one_motion(nodes: &[Node], repeats: Repeats) -> Option<Vec<Node>> {
    let repeat_after = repeats.impacts.max(1);
    let motions = nodes.len() / repeat_after;
    if motions < MOTIONS {
        return None;
    }
    let turned = |k: usize| Node {
        time_s: nodes[k].time_s - (k / repeat_after) as f64 * repeats.after_s(),
        ..nodes[k]
    };
    let alike = |place: usize| -> Vec<Node> {
        let places = (0..motions).map(|m| m * repeat_after + place);
        places.map(turned).collect()
    };
    let means = (0..repeat_after).map(|place| mean(&alike(place), repeats));
    means.collect()
}

/// The mean of impacts that repeat each other; `None` where one of them is not in its place.
fn mean(alike: &[Node], repeats: Repeats) -> Option<Node> {
    let first = alike[0];
    let of =
        |value: &dyn Fn(&Node) -> f64| robust::mean(&alike.iter().map(value).collect::<Vec<_>>());
    let time_s = of(&|n| n.time_s);
    if alike
        .iter()
        .any(|n| (n.time_s - time_s).abs() > IN_PLACE * repeats.after_s())
    {
        return None;
    }
    let shown: [fn(&Node) -> f64; 5] = [
        |n| n.time_s,
        |n| n.before_m_s[0],
        |n| n.before_m_s[1],
        |n| n.after_m_s[0],
        |n| n.after_m_s[1],
    ];
    let changes = |value: &fn(&Node) -> f64| has_not_settled(alike.iter().map(value).collect());
    if shown.iter().any(changes) {
        return None;
    }
    let each = |value: fn(&Node) -> [f64; 2]| [0, 1].map(|mass| of(&|n| value(n)[mass]));
    let (before_m_s, after_m_s) = (each(|n| n.before_m_s), each(|n| n.after_m_s));
    let scatters = |value: fn(&Node) -> [f64; 2], mean: [f64; 2]| {
        let square = |mass: usize| of(&|n| (value(n)[mass] - mean[mass]).powi(2));
        square(0).max(square(1))
    };
    let seen = scatters(|n| n.before_m_s, before_m_s).max(scatters(|n| n.after_m_s, after_m_s));
    let noise_m_s = of(&|n| n.noise_m_s);
    let rest = (of(&|n| n.error_m_s).powi(2) - noise_m_s * noise_m_s).max(0.0);
    // R may scatter from impact to impact, and the speeds with it
    let of_mean = noise_m_s.powi(2).max(seen) / alike.len() as f64;
    Some(Node {
        time_s,
        time_error_s: of(&|n| n.time_error_s),
        drive_phase_rad: first.drive_phase_rad
            + TAU * repeats.frequency_hz * (time_s - first.time_s),
        before_m_s,
        after_m_s,
        error_m_s: (of_mean + rest).sqrt(),
        noise_m_s: of_mean.sqrt(),
        ..first
    })
}

/// Standard errors by which the means of both halves differ in a motion that still changes.
const CHANGED: f64 = 4.0;

/// Whether values go on to change from the first half to the second one, by more than they scatter from one to the next: the mean of
/// a motion that has not settled is no motion.
fn has_not_settled(values: Vec<f64>) -> bool {
    let (first, second) = values.split_at(values.len() / 2);
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let scatter = robust::rms(&steps) / 2f64.sqrt();
    let error = scatter * (1.0 / first.len() as f64 + 1.0 / second.len() as f64).sqrt();
    let apart = robust::mean(first) - robust::mean(second);
    apart.abs() > CHANGED * error + 1e-9 * robust::rms(&values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    const REPEATS: Repeats = Repeats {
        impacts: 2,
        periods: 3,
        frequency_hz: 15.0,
    };

    /// Impacts at 0.03 and 0.14 s of a motion of 0.2 s, with noise of the speeds and times that are off alike in every motion.
    fn nodes(motions: usize, noise_m_s: f64) -> Vec<Node> {
        let normal = Normal::new(0.0, noise_m_s).expect("a deviation");
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let node = |k: usize| {
            let time_s = [0.03, 0.14][k % 2] + 0.2 * (k / 2) as f64;
            Node {
                time_s,
                time_error_s: 1e-5,
                drive_phase_rad: (TAU * 15.0 * time_s + 0.4) % TAU,
                before_m_s: [0.3 + normal.sample(&mut rng), 0.2],
                after_m_s: [-0.2, 0.1],
                error_m_s: 5e-3,
                noise_m_s: 3e-3,
                corner_shifts: [None, None],
            }
        };
        (0..2 * motions).map(node).collect()
    }

    #[test]
    fn valid_impacts_that_repeat_count_as_one_motion() {
        // noise falls with the root of 25 motions, what is alike in them does not
        let one = as_one_motion(&nodes(25, 1e-3), REPEATS).expect("a motion");
        assert_eq!(one.len(), 2);
        let error = (3e-3f64.powi(2) / 25.0 + 4e-3f64.powi(2)).sqrt();
        for node in &one {
            assert!((node.time_error_s - 1e-5).abs() < 1e-12);
            assert!((node.before_m_s[0] - 0.3).abs() < 1e-3);
            assert!((node.error_m_s - error).abs() < 1e-9, "{}", node.error_m_s);
        }
    }

    #[test]
    fn speeds_that_scatter_by_more_than_the_noise_leave_the_error_of_their_mean() {
        let found = as_one_motion(&nodes(100, 0.05), REPEATS).expect("a motion");
        let error = (0.05 / 10.0f64).hypot(4e-3);
        assert!((found[0].error_m_s / error - 1.0).abs() < 0.15);
    }

    #[test]
    fn a_motion_that_has_not_settled_is_not_averaged() {
        let mut dying = nodes(25, 1e-5);
        for (k, node) in dying.iter_mut().enumerate() {
            node.after_m_s[0] -= 0.01 * (-0.1 * k as f64).exp();
        }
        assert!(as_one_motion(&dying, REPEATS).is_none());
    }

    #[test]
    fn impacts_that_do_not_repeat_are_no_motion() {
        let mut of_two = nodes(25, 1e-3);
        assert!(as_one_motion(&of_two[..4], REPEATS).is_none());
        of_two.remove(20);
        assert!(as_one_motion(&of_two, REPEATS).is_none());
    }
}
