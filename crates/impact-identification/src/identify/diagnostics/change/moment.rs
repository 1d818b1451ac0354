//! From which record on the rig may be another one: by the records that a fit lost, and by R of impacts.

use std::collections::BTreeMap;

use super::found::{FEWEST, LEAST_OF_R};
use super::speeds::{Line, impacts};
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::selection::Selection;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Standard deviations from which two parts differ in their lost records or in R of their impacts.
const APART: f64 = 5.0;

/// The rank from which on most of the periodic records are lost, or before which they are.
pub(super) fn by_lost_records(ranks: &[usize], selection: &Selection<'_>) -> Option<usize> {
    let kept = selection.blocks.trajectory.records.iter();
    let mut records: Vec<(usize, f64)> = kept.map(|r| (ranks[r.observation], 0.0)).collect();
    records.extend(selection.lost.iter().map(|r| (ranks[r.observation], 1.0)));
    // a proportion's variance is at least that of one half record
    let share = records.iter().map(|r| r.1).sum::<f64>() / records.len().max(1) as f64;
    furthest(&mut records, (share * (1.0 - share)).sqrt(), 0.0)
}

/// The rank from which on R of the records' impacts is another, by their medians. What its line over the speed
/// explains of masses without a drive, which hit as fast as a hand pushes them, is no change of the rig.
pub(super) fn by_impacts(
    ranks: &[usize],
    observations: &[Observation],
    blocks: &Blocks,
) -> Option<usize> {
    let mut of_records: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    let impacts = impacts(&blocks.impact);
    let driven = |i: usize| observations[i].drive.is_some();
    let free = impacts.iter().filter(|i| !driven(i.observation));
    let slope = Line::through(free, |i| i.speed_m_s, |i| i.ratio).slope;
    for impact in &impacts {
        let own = of_records.entry(ranks[impact.observation]).or_default();
        let by_speed = if driven(impact.observation) {
            0.0
        } else {
            slope * impact.speed_m_s
        };
        own.push(impact.ratio - by_speed);
    }
    let medians = of_records.into_iter();
    let mut records: Vec<(usize, f64)> = medians
        .filter_map(|(rank, ratios)| Some((rank, robust::median(&ratios)?)))
        .collect();
    records.sort_by_key(|r| r.0);
    let mut records = without_lone_ones(&records);
    // the scatter of neighbours, which a change in one place does not widen
    let steps: Vec<f64> = records
        .windows(2)
        .map(|w| (w[1].1 - w[0].1).abs())
        .collect();
    let typical = 1.4826 * robust::median(&steps)? / std::f64::consts::SQRT_2;
    furthest(
        &mut records,
        typical.max(0.5 * LEAST_OF_R),
        0.5 * LEAST_OF_R,
    )
}

/// Values in order, each the median of it and its neighbours: one record of few impacts is no change.
pub(super) fn without_lone_ones(records: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let near = |i: usize| {
        let last = (i + 1).min(records.len() - 1);
        let mut near: Vec<f64> = records[i.saturating_sub(1)..=last]
            .iter()
            .map(|r| r.1)
            .collect();
        near.sort_by(f64::total_cmp);
        near[near.len() / 2]
    };
    let smoothed = records.iter().enumerate().map(|(i, r)| (r.0, near(i)));
    smoothed.collect()
}

/// The rank from which on the mean of values differs most from that before, if that is beyond chance, the
/// values having a standard deviation, and more than a least difference.
pub(super) fn furthest(records: &mut [(usize, f64)], deviation: f64, least: f64) -> Option<usize> {
    records.sort_by_key(|r| r.0);
    let count = records.len();
    let all: f64 = records.iter().map(|r| r.1).sum();
    let (mut before, mut best) = (0.0, None);
    for (k, (rank, value)) in records.iter().enumerate() {
        if k >= FEWEST && count - k >= FEWEST {
            let (a, b) = (k as f64, (count - k) as f64);
            let apart = ((all - before) / b - before / a).abs();
            let z_score = apart / (deviation * (a.recip() + b.recip()).sqrt());
            let beyond = apart > least && z_score > APART;
            if beyond && best.is_none_or(|(most, _)| z_score > most) {
                best = Some((z_score, *rank));
            }
        }
        before += value;
    }
    best.map(|(_, rank)| rank)
}
