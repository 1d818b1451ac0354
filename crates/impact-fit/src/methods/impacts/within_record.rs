//! Errors that the impacts of a driven record share.
//!
//! What sampling leaves open of an impact's time and speeds depends on where between two samples it falls.
//! Where the period of a motion is close to a whole number of samples, or to a ratio of small ones, all impacts of
//! a record fall at the same few places, and their errors do not average out. Of an error that runs evenly
//! through its range from one sample to the next, two impacts whose places are Δ apart share the correlation
//!
//! c(Δ) = 1 − 6Δ(1 − Δ),
//!
//! and n of them add up as K = Σc/n over all pairs, each with itself too: 0 where the places are spread evenly, n
//! where they are one. The impacts' times are found together, from the flights between them, and what is left open of
//! all of them alike is shared wherever they fall.
//!
//! The variance of the mean of n deviations, of which a is independent, s depends on the place and c is common, is
//! (a + s K + c n)/n. The three follow from the scatter within records and that of their means (analysis of
//! variance), and a + s K + c n is the factor on the variance of each impact. Means are taken about a parabola over
//! the records' speeds, so that a restitution that changes with the speed does not pass for shared errors.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::methods::impacts::block::{ImpactBlock, SpeedPair};
use crate::solver::normal::inverse;
use impact_records::event::correlation_of_places;
use impact_records::signal::robust;

/// Terms of the law over the speed that records may follow.
const TERMS: usize = 3;
/// Fewest records beyond those terms from which what they share is found.
const FEWEST: usize = 4;

/// The deviations of a record's impacts from one R over their errors.
#[derive(Default)]
struct Deviations {
    speeds_m_s: Vec<f64>,
    scores: Vec<f64>,
    places: Vec<Option<f64>>,
    /// What a, s and c count in the variance of the mean, times the count: 1, K and n.
    terms: [f64; 3],
}

impl Deviations {
    fn count(&self) -> f64 {
        self.scores.len() as f64
    }

    fn mean(&self) -> f64 {
        robust::mean(&self.scores)
    }

    /// Sum of squares about the mean.
    fn within(&self) -> f64 {
        let mean = self.mean();
        self.scores.iter().map(|s| (s - mean).powi(2)).sum()
    }

    /// K: the variance of the mean over that of independent errors.
    fn alike(&self) -> f64 {
        let pair = |a: &Option<f64>, b: &Option<f64>| {
            a.zip(*b)
                .map_or(0.0, |(a, b)| correlation_of_places((a - b).abs()))
        };
        let apart = self.places.iter().enumerate().map(|(i, a)| {
            let others = self.places[i + 1..].iter();
            others.map(|b| pair(a, b)).sum::<f64>()
        });
        1.0 + 2.0 * apart.sum::<f64>() / self.count()
    }
}

/// Find what the impacts of each record share, and enlarge their errors by it. Undriven impacts, whose order
/// and records are looked at by themselves, stay as they are.
pub fn share(block: &mut ImpactBlock) {
    block.pairs.iter_mut().for_each(|pair| pair.in_record = 1.0);
    if block.free {
        return;
    }
    let records = records(block);
    let Some(variances) = Variances::of(&records) else {
        return;
    };
    let factor = |r: &Deviations| variances.of_mean(r).max(1.0).sqrt();
    let factors: BTreeMap<usize, f64> = records.iter().map(|(i, r)| (*i, factor(r))).collect();
    for pair in &mut block.pairs {
        pair.in_record = factors[&pair.observation];
    }
}

fn records(block: &ImpactBlock) -> BTreeMap<usize, Deviations> {
    let mut records: BTreeMap<usize, Deviations> = BTreeMap::new();
    let Some(restitution) = block.typical_ratio() else {
        return records;
    };
    let score = |pair: &SpeedPair| {
        (pair.after_m_s - restitution * pair.before_m_s) / block.error(pair, restitution)
    };
    for pair in &block.pairs {
        let record = records.entry(pair.observation).or_default();
        record.scores.push(score(pair));
        record.speeds_m_s.push(pair.before_m_s);
        record.places.push(pair.sample_place);
    }
    for record in records.values_mut() {
        record.terms = [1.0, record.alike(), record.count()];
    }
    records
}

/// The variances of a deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Variances {
    independent: f64,
    by_place: f64,
    common: f64,
}

impl Variances {
    /// Those that explain best the scatter within the records and that of their means; `None` of too few records.
    fn of(records: &BTreeMap<usize, Deviations>) -> Option<Self> {
        let records: Vec<&Deviations> = records.values().collect();
        let known = records.len().checked_sub(TERMS).filter(|n| *n >= FEWEST)? as f64;
        // of the records' means, some follow the law
        let lost = records.len() as f64 / known;
        let means = about_law(&records)?.map(|square| square * lost);
        let all = |of: &dyn Fn(&Deviations) -> f64| records.iter().map(|r| of(r)).sum::<f64>();
        let within = |i: usize| all(&|r| r.terms[2] - r.terms[i]);
        let weighted = |weight: usize| {
            let of_means = |i: usize| all(&|r| r.terms[weight] * r.terms[i]);
            let own = records.iter().zip(means.iter());
            let found = own.map(|(r, square)| r.terms[weight] * square).sum();
            ([0, 1, 2].map(of_means), found)
        };
        let equations = [
            ([0, 1, 2].map(within), all(&Deviations::within)),
            weighted(0),
            weighted(1),
        ];
        let [independent, by_place, common] = positive_solution(&equations)?;
        Some(Self {
            independent,
            by_place,
            common,
        })
    }

    /// Variance of the mean of a record's deviations, times their count.
    fn of_mean(&self, record: &Deviations) -> f64 {
        let [own, alike, count] = record.terms;
        self.independent * own + self.by_place * alike + self.common * count
    }
}

/// Three numbers, none negative, with the least sum of squares of the relative errors of the equations (coefficients and right
/// side): of all choices of those that are not zero the best.
fn positive_solution(equations: &[([f64; 3], f64); 3]) -> Option<[f64; 3]> {
    let solution = |chosen: &[usize]| {
        let design = DMatrix::from_fn(3, chosen.len(), |i, k| {
            equations[i].0[chosen[k]] / equations[i].1
        });
        let found = inverse(&design.tr_mul(&design))? * design.row_sum().transpose();
        let off = (&design * &found - DVector::repeat(3, 1.0)).norm();
        let mut all = [0.0; 3];
        for (place, value) in chosen.iter().zip(&found) {
            all[*place] = *value;
        }
        (off.is_finite() && found.iter().all(|v| *v >= 0.0)).then_some((off, all))
    };
    let choices: [&[usize]; 7] = [&[0], &[1], &[2], &[0, 1], &[0, 2], &[1, 2], &[0, 1, 2]];
    let found = choices.into_iter().filter_map(solution);
    let best = found.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, all)| all)
}

/// Squares of the records' means about a parabola over their speeds, each times its impacts.
fn about_law(records: &[&Deviations]) -> Option<DVector<f64>> {
    let speeds: Vec<f64> = records
        .iter()
        .map(|r| robust::mean(&r.speeds_m_s))
        .collect();
    let (low, high) = robust::range(speeds.iter().copied())?;
    let middle = 0.5 * (low + high);
    let half = (0.5 * (high - low)).max(f64::MIN_POSITIVE);
    let weights: Vec<f64> = records.iter().map(|r| r.count().sqrt()).collect();
    let powers = |x: f64| [1.0, x, x * x];
    let term = |i: usize, k: usize| weights[i] * powers((speeds[i] - middle) / half)[k];
    let design = DMatrix::from_fn(records.len(), TERMS, term);
    let target = DVector::from_fn(records.len(), |i, _| weights[i] * records[i].mean());
    let square = design.tr_mul(&design);
    let left = match inverse(&square) {
        Some(inverse) => &target - &design * (inverse * design.tr_mul(&target)),
        // one speed in all records
        None => {
            let mean = target.dot(&design.column(0)) / square[(0, 0)];
            &target - design.column(0) * mean
        }
    };
    Some(left.component_mul(&left))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    const ERROR_M_S: f64 = 2e-3;
    const IMPACTS: usize = 12;

    /// Records of impacts with R over the speed, every fourth of a period of so many samples and the others of
    /// one that is no ratio of small numbers; the errors run through their range from one sample to the next.
    fn block(samples: f64, law: fn(f64) -> f64, seed: u64) -> ImpactBlock {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let mut pairs = Vec::new();
        for record in 0..400usize {
            let speed = 0.1 + 7.5e-4 * record as f64;
            let period = if record % 4 == 0 {
                samples
            } else {
                150.618_034
            };
            let first = 17.0 * normal();
            for impact in 0..IMPACTS {
                let place = (period * impact as f64).rem_euclid(1.0);
                let by_place = 12f64.sqrt() * ((first + place).rem_euclid(1.0) - 0.5);
                let error = (by_place + normal()) / 2f64.sqrt();
                let after = law(speed) * speed + ERROR_M_S * 1f64.hypot(law(speed)) * error;
                pairs.push(SpeedPair {
                    observation: record,
                    time_s: impact as f64,
                    sample_place: Some(place),
                    ..SpeedPair::of_speeds(speed, after, ERROR_M_S)
                });
            }
        }
        ImpactBlock::of_pairs(pairs, 0.0)
    }

    /// Factor on the variance in the records of the given period and in the others.
    fn factors(block: &ImpactBlock) -> [f64; 2] {
        [0, IMPACTS].map(|i| block.pairs[i].in_record.powi(2))
    }

    #[test]
    fn valid_errors_at_the_same_place_between_samples_count_once() {
        for seed in 0..4 {
            // half of the variance is shared by all twelve: 0.5 + 0.5 * 12
            let mut block = block(150.0, |_| 0.8, seed);
            share(&mut block);
            let [alike, others] = factors(&block);
            assert!((alike / 6.5 - 1.0).abs() < 0.4, "{seed}: {alike}");
            assert!(others < 1.2, "{seed}: {others}");
            // found once more, it is the same
            share(&mut block);
            assert_eq!(factors(&block), [alike, others]);
        }
    }

    #[test]
    fn valid_errors_that_all_impacts_of_a_record_have_in_common_count_once() {
        let normal = |rng: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(rng) };
        for seed in 0..4 {
            // beside those that are spread over the places, as much again: 1 + 12
            let mut block = block(150.381_966, |_| 0.8, seed);
            let mut rng = ChaCha8Rng::seed_from_u64(90 + seed);
            for record in block
                .pairs
                .chunk_by_mut(|a, b| a.observation == b.observation)
            {
                let common = ERROR_M_S * 1f64.hypot(0.8) * normal(&mut rng);
                record.iter_mut().for_each(|pair| pair.after_m_s += common);
            }
            share(&mut block);
            for factor in factors(&block) {
                assert!((factor / 12.8 - 1.0).abs() < 0.25, "{seed}: {factor}");
            }
        }
    }

    #[test]
    fn places_that_differ_and_a_restitution_that_changes_with_the_speed_are_no_shared_errors() {
        for law in [|_: f64| 0.8, |v: f64| 0.9 - 0.3 * v] {
            let mut block = block(150.381_966, law, 5);
            share(&mut block);
            assert!(factors(&block)[0] < 1.5, "{:?}", factors(&block));
        }
    }
}
