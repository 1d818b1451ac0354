//! Whether records are of two rigs in whatever order: each that tells a parameter has one of two values of it, and no
//! setting tells which.

use std::collections::{BTreeMap, BTreeSet};

use super::found::{FEWEST, LEAST_OF_R, Other, least};
use super::ranks;
use super::search::Search;
use super::speeds::{Impacted, impacts};
use impact_fit::parameters::Coordinate;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Greatest distance of a record's value from one of the two, over the distance of these; of values that scatter about
/// one, or lie evenly, at most half are as near.
const NEAR: f64 = 0.25;
/// Part of the values that are as near.
const MOST: f64 = 0.9;
/// Changes between records of neighbouring settings over those of an order by chance: where there are fewer, the setting
/// tells the value.
const BY_CHANCE: f64 = 0.5;

/// What a record tells of a parameter.
struct Told {
    observation: usize,
    value: f64,
    error: f64,
}

/// The records of the smaller one of two groups, and how much nearer records are to the values of their groups than
/// these are to each other.
struct Groups {
    all: Vec<usize>,
    smaller: BTreeSet<usize>,
    parted: f64,
}

impl Search<'_> {
    /// The records that are of another rig than all others.
    pub(super) fn mixed(&self) -> Option<Other> {
        let observations = self.evidence.observations;
        let of_rows = Coordinate::PHYSICAL
            .iter()
            .filter_map(|c| two_values(&self.told_by_rows(*c), least(*c)));
        let of_impacts = two_values(&self.told_by_impacts(), LEAST_OF_R);
        let groups = of_rows.chain(of_impacts);
        let groups = groups.filter(|groups| !set(groups, observations));
        let groups = groups.max_by(|a, b| a.parted.total_cmp(&b.parted))?;
        let ranks = ranks(observations);
        let names = groups.smaller.iter();
        Some(Other::Mixed {
            ranks: groups.smaller.iter().map(|i| ranks[*i]).collect(),
            records: names.map(|i| observations[*i].record.clone()).collect(),
        })
    }

    /// The step of one parameter to the optimum of each record alone.
    fn told_by_rows(&self, coordinate: Coordinate) -> Vec<Told> {
        let free = &self.fitted.problem.free;
        let Some(place) = free.iter().position(|c| *c == coordinate) else {
            return Vec::new();
        };
        // information and gradient
        let mut of_records: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (observation, rows) in &self.rows {
            let Some(k) = rows.places.iter().position(|p| *p == place) else {
                continue;
            };
            let slopes = rows.slopes.column(k);
            let own = of_records.entry(*observation).or_default();
            own[0] += slopes.norm_squared();
            own[1] += slopes.dot(&rows.residuals);
        }
        let told = of_records.into_iter();
        let told = told.map(|(observation, [information, gradient])| Told {
            observation,
            value: -gradient / information,
            error: information.sqrt().recip(),
        });
        told.filter(|t| t.value.is_finite() && t.error.is_finite())
            .collect()
    }

    /// R of each record's impacts.
    fn told_by_impacts(&self) -> Vec<Told> {
        let mut of_records: BTreeMap<usize, Vec<Impacted>> = BTreeMap::new();
        for impact in impacts(&self.fitted.selection.blocks.impact) {
            let own = of_records.entry(impact.observation).or_default();
            own.push(impact);
        }
        let told = of_records.into_iter().filter_map(|(observation, own)| {
            let ratios: Vec<f64> = own.iter().map(|i| i.ratio).collect();
            let weight: f64 = own.iter().map(|i| i.weight).sum();
            Some(Told {
                observation,
                value: robust::median(&ratios)?,
                error: weight.sqrt().recip(),
            })
        });
        told.collect()
    }
}

/// The groups of records that have one of two values, at least `apart` from each other: so it is of the half that tell them
/// best, and all others are of the group whose value is nearer.
fn two_values(told: &[Told], apart: f64) -> Option<Groups> {
    let errors: Vec<f64> = told.iter().map(|t| t.error).collect();
    let typical = robust::median(&errors)?;
    let best = told.iter().filter(|t| t.error <= typical);
    let mut values: Vec<f64> = best.map(|t| t.value).collect();
    values.sort_by(f64::total_cmp);
    let split = widest(&values)?;
    let of_groups = [&values[..split], &values[split..]].map(robust::median);
    let [Some(low), Some(high)] = of_groups else {
        return None;
    };
    let distance = |value: &f64| (value - low).abs().min((value - high).abs());
    let distances: Vec<f64> = values.iter().map(distance).collect();
    let is_near = |d: &&f64| **d <= NEAR * (high - low);
    let near = distances.iter().filter(is_near).count();
    let clear = high - low > apart && near as f64 >= MOST * values.len() as f64;
    let above = |t: &&Told| t.value > 0.5 * (low + high);
    let (above, below): (Vec<&Told>, Vec<&Told>) = told.iter().partition(above);
    let smaller = if below.len() < above.len() {
        below
    } else {
        above
    };
    clear.then(|| Groups {
        all: told.iter().map(|t| t.observation).collect(),
        smaller: smaller.iter().map(|t| t.observation).collect(),
        parted: (high - low) / robust::median(&distances).unwrap_or(0.0),
    })
}

/// The place in values in order that parts them into two groups with the furthest means for their sizes.
fn widest(values: &[f64]) -> Option<usize> {
    let all: f64 = values.iter().sum();
    let mut before: f64 = values.iter().take(FEWEST).sum();
    let mut best: Option<(f64, usize)> = None;
    for k in FEWEST..=values.len().checked_sub(FEWEST)? {
        let (a, b) = (k as f64, (values.len() - k) as f64);
        let between = a * b * ((all - before) / b - before / a).powi(2);
        if best.is_none_or(|(most, _)| between > most) {
            best = Some((between, k));
        }
        before += values.get(k)?;
    }
    best.map(|(_, k)| k)
}

/// Whether the settings tell the group: records of neighbouring clearances, sweeps and frequencies are of one group more
/// often than by chance.
fn set(groups: &Groups, observations: &[Observation]) -> bool {
    let mut order: Vec<usize> = groups.all.clone();
    let of = |i: &usize| {
        let o = &observations[*i];
        let frequency_hz = o.drive.map_or(0.0, |drive| drive.frequency_hz);
        (
            o.setting.clearance_m.unwrap_or(0.0),
            o.setting.sweep,
            frequency_hz,
        )
    };
    order.sort_by(|i, j| {
        let (a, b) = (of(i), of(j));
        a.0.total_cmp(&b.0)
            .then_with(|| (a.1 as u8).cmp(&(b.1 as u8)))
            .then_with(|| a.2.total_cmp(&b.2))
    });
    let in_smaller: Vec<bool> = order.iter().map(|i| groups.smaller.contains(i)).collect();
    let changes = in_smaller.windows(2).filter(|w| w[0] != w[1]).count() as f64;
    let (all, smaller) = (order.len() as f64, groups.smaller.len() as f64);
    changes < BY_CHANCE * 2.0 * smaller * (all - smaller) / all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn told(values: impl IntoIterator<Item = f64>) -> Vec<Told> {
        let of = |(observation, value)| Told {
            observation,
            value,
            error: 1.0,
        };
        values.into_iter().enumerate().map(of).collect()
    }

    #[test]
    fn prop_values_that_scatter_about_one_are_no_two_groups() {
        let mut rng = ChaCha8Rng::seed_from_u64(91);
        for _ in 0..300 {
            let mut normal = |_| -> f64 { StandardNormal.sample(&mut rng) };
            let scattered: Vec<f64> = (0..30).map(&mut normal).collect();
            assert!(two_values(&told(scattered.iter().copied()), 0.0).is_none());
            // a third of them at another value
            let two = scattered.iter().enumerate();
            let two = two.map(|(i, s)| 0.02 * s + if i.is_multiple_of(3) { 1.0 } else { 0.0 });
            let groups = two_values(&told(two), 0.0).expect("two groups");
            assert_eq!(
                Vec::from_iter(groups.smaller),
                Vec::from_iter((0..30).step_by(3))
            );
        }
        let even = (0..40).map(f64::from);
        assert!(two_values(&told(even), 0.0).is_none());
    }
}
