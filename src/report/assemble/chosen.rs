//! Which records are compared with their simulation.

use std::collections::BTreeMap;

use crate::motion::{Motion, Observation};

/// Most comparisons in one report.
const MOST_COMPARISONS: usize = 8;

/// Records to compare with their simulation: those named, else the surest of each type of motion
/// that the campaign shows, periodic motions with impacts first.
pub fn chosen_records(observations: &[Observation], named: &[String]) -> Vec<usize> {
    let find = |name: &String| observations.iter().position(|o| o.record == *name);
    let by_name: Vec<usize> = named.iter().filter_map(find).collect();
    if !by_name.is_empty() {
        return by_name;
    }
    let mut best: BTreeMap<(u8, String), usize> = Default::default();
    for (i, o) in observations.iter().enumerate() {
        let rank = match &o.classification.motion {
            _ if o.excluded() || o.drive.is_none() => continue,
            Motion::Periodic { .. } => 0,
            Motion::Impactless => 1,
            Motion::Beat | Motion::Chaotic => 2,
            _ => continue,
        };
        let key = (rank, o.classification.motion.label());
        let better = |k: &usize| quality(o) > quality(&observations[*k]);
        if best.get(&key).is_none_or(better) {
            best.insert(key, i);
        }
    }
    best.into_values().take(MOST_COMPARISONS).collect()
}

/// Records that are surer than this differ in their noise alone.
const SURE: f64 = 0.95;

/// Sureness first, then the strength of the motion over its noise.
fn quality(o: &Observation) -> f64 {
    let noise = o.classification.evidence.noise_ratio.unwrap_or(1.0);
    o.classification.confidence.min(SURE) - noise
}
