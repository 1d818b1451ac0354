//! Structure of R over impacts, looked for before scatter is allowed for: from bounce to bounce, and
//! between records.

use serde::{Deserialize, Serialize};

use crate::messages::GroupPoint;
use crate::methods::impacts::block::{ImpactBlock, SpeedPair};
use crate::statistics::quantile::NORMAL_975;
use impact_records::motion::Observation;

/// Share of campaigns of one R in which chance may look like a structure: that of three standard deviations.
pub const FALSE_ALARMS: f64 = 0.0027;
/// Normal deviate from which scatter beyond the stated errors, or what a grouping explains of it, is no
/// chance: [`FALSE_ALARMS`] on the upper side, shared by the two groupings.
const SIGNIFICANT: f64 = 3.0;
/// Range of R from which a structure matters.
const MATTERS: f64 = 0.02;
/// Most groups that are kept.
const MOST_GROUPS: usize = 200;

/// R of a group of impacts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImpactGroup {
    /// The record's name, or the number of the bounce, from 1.
    pub group: String,
    /// Number of impacts.
    pub impacts: usize,
    /// Mean approach speed, m/s.
    pub speed_m_s: Option<f64>,
    /// R: the mean weighted by the errors.
    pub restitution: f64,
    /// Its standard error, at least that of the scatter within the group.
    pub standard_error: f64,
}

/// R of each bounce, counted in its record, and of each record.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpactGroups {
    /// Of the first impacts of all records, the second ones ….
    pub by_bounce: Vec<ImpactGroup>,
    /// Of each record.
    pub by_record: Vec<ImpactGroup>,
}

impl From<&ImpactGroup> for GroupPoint {
    fn from(group: &ImpactGroup) -> Self {
        Self {
            group: group.group.clone(),
            restitution: group.restitution.min(1.0),
            half_width: NORMAL_975 * group.standard_error,
        }
    }
}

/// A grouping that explains the scatter of R.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grouping {
    /// R changes from bounce to bounce.
    Bounce,
    /// R differs between records.
    Record,
}

/// A ratio of speeds with the groups that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroupedRatio {
    /// Index of the record.
    pub record: usize,
    /// Number of the bounce in its record, from 0.
    pub bounce: usize,
    /// Approach speed, m/s, if it was measured.
    pub speed_m_s: Option<f64>,
    /// R of this impact.
    pub ratio: f64,
    /// Its standard error.
    pub error: f64,
}

/// The impacts of records without a drive, with their place among all impacts of the record; empty for
/// driven rigs, whose bounces have no order.
pub fn ratios(block: &ImpactBlock, observations: &[Observation]) -> Vec<GroupedRatio> {
    let undriven = |p: &&SpeedPair| observations[p.observation].drive.is_none();
    let mut pairs: Vec<&SpeedPair> = block.pairs.iter().filter(undriven).collect();
    pairs.sort_by(|a, b| {
        let key = |p: &SpeedPair| p.observation;
        key(a).cmp(&key(b)).then(a.time_s.total_cmp(&b.time_s))
    });
    let of = |p: &SpeedPair| {
        let ratio = p.after_m_s / p.before_m_s;
        let impacts = &observations[p.observation].impacts;
        GroupedRatio {
            record: p.observation,
            bounce: impacts.iter().filter(|i| i.time_s < p.time_s).count(),
            speed_m_s: Some(p.before_m_s),
            ratio,
            error: block.error(p, ratio) / p.before_m_s,
        }
    };
    pairs.into_iter().map(of).collect()
}

/// R of each bounce and of each record.
pub fn groups(ratios: &[GroupedRatio], observations: &[Observation]) -> ImpactGroups {
    let record = |i: usize| observations[i].record.clone();
    let named = |grouping, name: &dyn Fn(usize) -> String| {
        let groups = grouped(ratios, grouping).into_iter().take(MOST_GROUPS);
        groups
            .map(|(key, members)| group(name(key), &members))
            .collect()
    };
    ImpactGroups {
        by_bounce: named(Grouping::Bounce, &|bounce| (bounce + 1).to_string()),
        by_record: named(Grouping::Record, &record),
    }
}

fn key(ratio: &GroupedRatio, grouping: Grouping) -> usize {
    match grouping {
        Grouping::Bounce => ratio.bounce,
        Grouping::Record => ratio.record,
    }
}

fn grouped(ratios: &[GroupedRatio], grouping: Grouping) -> Vec<(usize, Vec<GroupedRatio>)> {
    let mut keys: Vec<usize> = ratios.iter().map(|r| key(r, grouping)).collect();
    keys.sort_unstable();
    keys.dedup();
    let members = |k: usize| -> Vec<GroupedRatio> {
        let own = |r: &&GroupedRatio| key(r, grouping) == k;
        ratios.iter().filter(own).copied().collect()
    };
    keys.into_iter().map(|k| (k, members(k))).collect()
}

/// Weighted mean, its standard error for the stated errors, and χ² about it.
fn mean(ratios: &[GroupedRatio]) -> (f64, f64, f64) {
    let weight = |r: &GroupedRatio| r.error.powi(-2);
    let all: f64 = ratios.iter().map(weight).sum();
    let mean = ratios.iter().map(|r| weight(r) * r.ratio).sum::<f64>() / all;
    let chi2 = ratios
        .iter()
        .map(|r| ((r.ratio - mean) / r.error).powi(2))
        .sum();
    (mean, all.recip().sqrt(), chi2)
}

fn group(name: String, members: &[GroupedRatio]) -> ImpactGroup {
    let (restitution, error, chi2) = mean(members);
    let freedom = members.len().saturating_sub(1).max(1) as f64;
    let speeds: Vec<f64> = members.iter().filter_map(|m| m.speed_m_s).collect();
    ImpactGroup {
        group: name,
        impacts: members.len(),
        speed_m_s: (!speeds.is_empty()).then(|| impact_records::signal::robust::mean(&speeds)),
        restitution,
        standard_error: error * (chi2 / freedom).max(1.0).sqrt(),
    }
}

/// The grouping that explains the scatter of R, if one does significantly and by an amount that
/// matters.
pub fn structure(ratios: &[GroupedRatio]) -> Option<Grouping> {
    if ratios.len() < 2 {
        return None;
    }
    let (_, _, constant) = mean(ratios);
    if deviate(constant, ratios.len() - 1) < SIGNIFICANT {
        return None;
    }
    [Grouping::Bounce, Grouping::Record]
        .into_iter()
        .filter_map(|grouping| Some((explains(ratios, grouping, constant)?, grouping)))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, grouping)| grouping)
}

/// Whether values differ by more than their errors, and by an amount that matters.
pub fn differ(ratios: &[GroupedRatio]) -> bool {
    let (_, _, chi2) = mean(ratios);
    let values = ratios.iter().map(|r| r.ratio);
    let range = impact_records::signal::robust::range(values).map_or(0.0, |(low, high)| high - low);
    ratios.len() > 1 && deviate(chi2, ratios.len() - 1) > SIGNIFICANT && range > MATTERS
}

/// Normal deviate of what a grouping explains of χ²; `None` if it is chance or too little to matter.
fn explains(ratios: &[GroupedRatio], grouping: Grouping, constant: f64) -> Option<f64> {
    let groups = grouped(ratios, grouping);
    let freedom = ratios.len() - groups.len();
    let means: Vec<(f64, f64, f64)> = groups.iter().map(|(_, members)| mean(members)).collect();
    if groups.len() < 2 {
        return None;
    }
    let left: f64 = means.iter().map(|m| m.2).sum();
    // Scatter within the groups is the measure of what they explain, once there is enough of it.
    let scale = if freedom >= 3 {
        (left / freedom as f64).max(1.0)
    } else {
        1.0
    };
    let explained = deviate((constant - left) / scale, groups.len() - 1);
    let range = 12f64.sqrt() * between(&means, (constant - left) / scale);
    (explained > SIGNIFICANT && range > MATTERS).then_some(explained)
}

/// Standard deviation of groups beyond the errors of their means, by what they explain of χ² (`DerSimonian` and Laird 1986);
/// of values that lie evenly it is their range over √12.
fn between(means: &[(f64, f64, f64)], explained: f64) -> f64 {
    let weights = || means.iter().map(|m| m.1.powi(-2));
    let all: f64 = weights().sum();
    let squares: f64 = weights().map(|w| w * w).sum();
    let beyond = explained - (means.len() - 1) as f64;
    (beyond.max(0.0) / (all - squares / all)).sqrt()
}

/// The normal deviate of a χ² (Wilson and Hilferty 1931).
fn deviate(chi2: f64, freedom: usize) -> f64 {
    let k = freedom.max(1) as f64;
    let width = 2.0 / (9.0 * k);
    ((chi2.max(0.0) / k).cbrt() - (1.0 - width)) / width.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(record: usize, bounce: usize, ratio: f64, error: f64) -> GroupedRatio {
        GroupedRatio {
            record,
            bounce,
            speed_m_s: Some(1.0),
            ratio,
            error,
        }
    }

    #[test]
    fn a_first_and_a_second_bounce_that_differ_are_a_structure() {
        let paper = [ratio(0, 0, 0.408, 0.005), ratio(0, 1, 0.504, 0.013)];
        assert_eq!(structure(&paper), Some(Grouping::Bounce));
        let alike = [ratio(0, 0, 0.490, 0.005), ratio(0, 1, 0.496, 0.008)];
        assert_eq!(structure(&alike), None);
    }

    #[test]
    fn records_that_differ_are_a_structure_and_scatter_alone_is_none() {
        let scatter = [0.01, -0.012, 0.004, -0.006, 0.011, -0.007];
        let of = |r: f64, record: usize| {
            let with = move |(i, s): (usize, &f64)| ratio(record, i, r + s, 0.01);
            scatter.iter().enumerate().map(with).collect::<Vec<_>>()
        };
        let two = [of(0.72, 0), of(0.30, 1)].concat();
        assert_eq!(structure(&two), Some(Grouping::Record));
        assert_eq!(structure(&[of(0.72, 0), of(0.721, 1)].concat()), None);
        // Errors stated five times too small: much scatter, but neither grouping explains it.
        let mut bold = [of(0.72, 0), of(0.72, 1)].concat();
        bold.iter_mut().for_each(|r| r.error = 0.002);
        bold.swap(0, 6);
        assert_ne!(structure(&bold), Some(Grouping::Record));
    }

    #[test]
    fn valid_the_limit_is_that_of_the_false_alarms_shared_by_the_groupings() {
        // both are one-sided: half of the two-sided tail of the normal distribution
        let tail = crate::statistics::distribution::normal_tail(SIGNIFICANT);
        assert!(
            (0.5 * tail * 2.0 / FALSE_ALARMS - 1.0).abs() < 0.01,
            "{tail}"
        );
    }

    #[test]
    fn valid_the_deviate_of_chi2_is_that_of_its_quantile() {
        // The 99.87 % quantiles (three deviations) of 1 and of 10 degrees of freedom: 10.34 and 28.8.
        assert!((deviate(10.34, 1) - 3.0).abs() < 0.1);
        assert!((deviate(28.8, 10) - 3.0).abs() < 0.05);
    }
}
