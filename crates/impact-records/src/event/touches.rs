//! Where the masses come as close as at the impacts that were found: they cannot come closer, so that an impact
//! too slow to show its jump may be there.

use crate::event::jumps::Jump;
use crate::event::kinematics::{Body, Series};
use crate::signal::robust;

/// Impacts from which the displacement of the stop is known.
const FEWEST: usize = 3;
/// Standard deviations by which a maximum may stay below the stop.
const REACH: f64 = 3.0;
/// Greatest uncertainty of the stop's displacement over the range of the displacement.
const KNOWN: f64 = 0.1;

/// The sample of the greatest relative displacement between each two impacts if it reaches that of the impacts,
/// `clear` samples away from these. Only of a velocity that is differentiated from the displacement: a measured
/// one shows slower impacts than the displacement tells.
pub(super) fn touches(relative: &Body, jumps: &[Jump], clear: usize) -> Vec<usize> {
    let velocity = relative.velocity.as_ref().filter(|v| v.is_differentiated());
    let Some((_, displacement)) = velocity.zip(relative.displacement.as_ref()) else {
        return Vec::new();
    };
    let values = &displacement.values;
    let Some(stop) = lowest_at_the_stop(displacement, jumps) else {
        return Vec::new();
    };
    let bounds = jumps.windows(2).map(|pair| {
        let first = pair[0].left + pair[0].gap + clear;
        (first, pair[1].left.saturating_sub(clear))
    });
    let farthest = bounds.filter_map(|(first, end)| {
        let between = values.get(first..end)?;
        let (at, value) = between
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(b.1))?;
        // at the end of a stretch it still rises toward the impact
        let inside = at > 0 && at + 1 < between.len();
        (inside && *value >= stop).then_some(first + at)
    });
    farthest.collect()
}

/// The least displacement that counts as that of the stop; `None` where it is not known well.
fn lowest_at_the_stop(displacement: &Series, jumps: &[Jump]) -> Option<f64> {
    let values = &displacement.values;
    let reached = |jump: &Jump| {
        let beside = values.get(jump.left..=jump.left + jump.gap)?;
        Some(robust::range(beside.iter().copied())?.1)
    };
    let levels: Vec<f64> = jumps.iter().filter_map(reached).collect();
    if levels.len() < FEWEST {
        return None;
    }
    let scatter = robust::robust_deviation(&levels)?.max(displacement.noise);
    let (low, high) = robust::range(values.iter().copied())?;
    (REACH * scatter < KNOWN * (high - low))
        .then(|| robust::median(&levels).map(|level| level - REACH * scatter))?
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Role;

    /// Ten periods of 200 samples that reach the stop at 1 in sample 50 of each, and `other` in sample 140.
    fn body(other: f64) -> Body {
        let bump = |i: usize, at: usize| {
            let off = i as f64 - at as f64;
            (-off * off / 300.0).exp()
        };
        let one = |i: usize| bump(i % 200, 50) + other * bump(i % 200, 140);
        let series = |values: Vec<f64>| {
            let mut series = Series::clean(values);
            series.role = Role::DisplacementX;
            series.noise = 0.01;
            series
        };
        Body {
            velocity: Some(series(vec![0.0; 2000])),
            displacement: Some(series((0..2000).map(one).collect())),
        }
    }

    fn impacts() -> Vec<Jump> {
        let at = |k: usize| Jump {
            left: 200 * k + 49,
            gap: 3,
            height: -1.0,
            error: 0.1,
        };
        (0..10).map(at).collect()
    }

    #[test]
    fn masses_touch_where_they_come_as_close_as_at_the_impacts() {
        let expected: Vec<usize> = (0..9).map(|k| 200 * k + 140).collect();
        assert_eq!(touches(&body(0.99), &impacts(), 16), expected);
        // a stop that is not reached
        assert!(touches(&body(0.9), &impacts(), 16).is_empty());
        // impacts of which nothing tells where the stop is
        assert!(touches(&body(0.99), &impacts()[..2], 16).is_empty());
    }

    #[test]
    fn a_measured_velocity_needs_no_touches() {
        let mut body = body(0.99);
        let velocity = body.velocity.as_mut().expect("one");
        velocity.role = Role::VelocityX;
        assert!(touches(&body, &impacts(), 16).is_empty());
    }
}
