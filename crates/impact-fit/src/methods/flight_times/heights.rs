//! Heights before and after impacts: R is the square root of the one over the other.
//!
//! Each height is listed once, also where it is that after one impact and that before the next, so that the errors of
//! neighbouring ratios are correlated.

use nalgebra::{DMatrix, DVector};

use crate::messages::{HeightsCause, Remark};
use crate::methods::answer::MethodResult;
use crate::methods::flight_times::fall::Fall;
use crate::methods::flight_times::rows::{Listed, Row, Rows};
use crate::methods::flight_times::scatter::{Known, RatioRow, Trend, Weighing};
use impact_records::event::{DetectionSource, GRAVITY_M_S2, Impact};
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Difference of times, s, from which impacts are not of one drop: two of a drop are as far apart as the flight between
/// them is long.
const APART_S: f64 = 1e-6;

/// Whether an observation's impacts are listed by heights.
pub(super) fn are_listed(o: &Observation) -> bool {
    let by_heights = |i: &Impact| i.source == DetectionSource::Heights;
    !o.impacts.is_empty() && o.impacts.iter().all(by_heights)
}

/// The heights around each impact.
fn falls(o: &Observation) -> Vec<Fall> {
    let mut falls: Vec<Fall> = Vec::new();
    let mut end_s = f64::NEG_INFINITY;
    for impact in &o.impacts {
        let [before, after] = [
            impact.approach_speed_before_m_s,
            impact.approach_speed_after_m_s,
        ]
        .map(|speed| speed.unwrap_or(0.0).abs());
        let goes_on = (impact.time_s - end_s).abs() < APART_S;
        let bounce = falls
            .last()
            .filter(|_| goes_on)
            .map_or(0, |fall| fall.bounce + 1);
        let [before_m, after_m] = [before, after].map(|speed| 0.5 * speed * speed / GRAVITY_M_S2);
        falls.push(Fall {
            before_m,
            after_m,
            bounce,
        });
        end_s = impact.time_s + 2.0 * after / GRAVITY_M_S2;
    }
    falls
}

/// A row for each record, without the ratios across a top that is not listed.
pub(super) fn rows(records: &[(usize, &Observation)]) -> Rows {
    let each: Vec<(usize, Vec<Fall>)> = records.iter().map(|(i, o)| (*i, falls(o))).collect();
    let logarithm = |fall: &Fall| 0.5 * (fall.after_m / fall.before_m).ln();
    let all: Vec<f64> = each
        .iter()
        .flat_map(|(_, f)| f.iter().map(logarithm))
        .collect();
    let mut found = Rows::default();
    let (Some(median), Some(spread)) = (robust::median(&all), robust::robust_deviation(&all))
    else {
        return found;
    };
    let two = |fall: &Fall| {
        let off = (logarithm(fall) - 2.0 * median).abs();
        all.len() >= FEWEST && FAR * spread < median.abs() && off < AS_TWO * median.abs()
    };
    for (record, falls) in each {
        found.skipped.extend(
            falls
                .iter()
                .filter(|f| two(f))
                .map(|f| (record, f.before_m)),
        );
        let kept = without(falls, &two);
        if !kept.is_empty() {
            found.rows.push(Row {
                record,
                first: 0,
                listed: Listed::Heights(kept),
            });
        }
    }
    found
}

/// Fewest ratios among which one is told to be two.
const FEWEST: usize = 4;
/// How many times its spread R's logarithm is where one ratio is told to be two.
const FAR: f64 = 6.0;
/// How far R² may be off that of the others, in the logarithm over that of R.
const AS_TWO: f64 = 0.25;

/// The falls but those, and what follows begins anew.
fn without(mut falls: Vec<Fall>, left_out: &dyn Fn(&Fall) -> bool) -> Vec<Fall> {
    for k in 1..falls.len() {
        if left_out(&falls[k - 1]) && falls[k].bounce > 0 {
            falls[k].bounce = 0;
        } else if falls[k].bounce > 0 {
            falls[k].bounce = falls[k - 1].bounce + 1;
        }
    }
    falls.retain(|fall| !left_out(fall));
    falls
}

/// Standard error of each height by its last digit, or as it is stated.
pub(super) fn known(records: &[(usize, &Observation)]) -> Known {
    let impacts = || records.iter().flat_map(|(_, o)| &o.impacts);
    let speed = |i: &Impact| i.approach_speed_before_m_s.unwrap_or(0.0);
    let stated = impacts().filter_map(|i| Some(i.speed_error_m_s()? * speed(i) / GRAVITY_M_S2));
    let stated = robust::median(&stated.collect::<Vec<_>>());
    let digit = impacts().map(|i| i.time_error_s * speed(i));
    let digit = robust::median(&digit.collect::<Vec<_>>());
    let least = stated.into_iter().chain(digit).fold(0.0, f64::max);
    Known {
        least: Some(least).filter(|least| *least > 0.0),
        told: stated.is_some(),
        heights: true,
    }
}

/// State that R changes with the height, and what may be the cause.
pub(super) fn judge(result: &mut MethodResult, rows: &[&Row], trend: &Trend) {
    result.fits = Some(false);
    result.remarks.push(Remark::RestitutionByHeight {
        low: trend.ends[0],
        high: trend.ends[1],
        cause: cause(rows),
    });
    if let Some(estimate) = &mut result.parameters.restitution {
        estimate.is_not_one_number(&trend.ends);
    }
}

/// Greatest drag of a ball, 1/m: half the density of air times its area and its coefficient of drag over its mass, of a
/// table tennis ball, with a margin.
const MOST_DRAG_PER_M: f64 = 0.3;

/// What may make R change with the height: drag of the air, by which the logarithm falls as the mean of both heights
/// rises, or a height that all contain too much or too little, as half the difference of the heights' reciprocals.
fn cause(rows: &[&Row]) -> HeightsCause {
    let each: Vec<(RatioRow, &[Fall])> = rows
        .iter()
        .filter_map(|row| Some((RatioRow::of(row), row.falls()?)))
        .collect();
    let air = explained(&each, &|f| -0.5 * (f.before_m + f.after_m));
    let offset = explained(&each, &|f| 0.5 * (f.after_m.recip() - f.before_m.recip()));
    let heights = each
        .iter()
        .flat_map(|(_, falls)| falls.iter().map(|f| f.after_m));
    let lowest_m = heights.fold(f64::INFINITY, f64::min);
    match (air, offset) {
        (Some((drag, left)), Some((_, beside)))
            if left <= beside && drag > 0.0 && drag < MOST_DRAG_PER_M =>
        {
            HeightsCause::Air { drag_per_m: drag }
        }
        (Some((_, beside)), Some((offset_m, left))) if left < beside && offset_m < lowest_m => {
            HeightsCause::Offset { offset_m }
        }
        _ => HeightsCause::Speed,
    }
}

/// How much of something per unit explains the logarithms best, and the squares that it leaves.
fn explained(rows: &[(RatioRow, &[Fall])], of: &dyn Fn(&Fall) -> f64) -> Option<(f64, f64)> {
    let [mut squares, mut products, mut values] = [0.0; 3];
    for (row, falls) in rows {
        // R itself scatters as much as the errors of the heights, in the median
        let diagonal: Vec<f64> = row.by_errors().diagonal().iter().copied().collect();
        let own = robust::median(&diagonal)?;
        let count = diagonal.len();
        let weighing = Weighing::of(row.by_errors() + DMatrix::identity(count, count) * own)?;
        let unit = DVector::from_iterator(count, falls.iter().map(of));
        let [unit, logarithms] = [&unit, &row.values].map(|v| weighing.centred(v));
        let solved = weighing.factor.solve(&unit);
        squares += unit.dot(&solved);
        products += logarithms.dot(&solved);
        values += logarithms.dot(&weighing.factor.solve(&logarithms));
    }
    let amount = products / squares;
    amount
        .is_finite()
        .then_some((amount, values - amount * products))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::flight_times::pooled;
    use impact_records::motion::Motion;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A record of drops with their heights, to so many m.
    fn listed(name: &str, drops: &[Vec<f64>], digit_m: f64) -> Observation {
        let mut o = Observation::of(name, 1.0, Motion::Impactless);
        let mut at_s = 0.0;
        for drop in drops {
            let speeds: Vec<f64> = drop
                .iter()
                .map(|h| (2.0 * GRAVITY_M_S2 * h).sqrt())
                .collect();
            for pair in speeds.windows(2) {
                at_s += pair[0] / GRAVITY_M_S2;
                o.impacts.push(Impact {
                    approach_speed_after_m_s: Some(-pair[1]),
                    source: DetectionSource::Heights,
                    time_error_s: digit_m / 12f64.sqrt() / pair[0],
                    ..Impact::at(at_s, pair[0])
                });
                at_s += pair[1] / GRAVITY_M_S2;
            }
            at_s += 1.0;
        }
        o
    }

    /// Heights of a ball of drag k in 1/m, of which v' = −g − k v |v|: its speed at the plate is that of
    /// v² = g/k (1 − exp(−2kh)), and it rises to ln(1 + k v²/g)/(2k).
    fn drop(height_m: f64, impacts: usize, restitution: f64, drag: f64) -> Vec<f64> {
        let next = |h: &f64| {
            let down = GRAVITY_M_S2 / drag * -(-2.0 * drag * h).exp_m1();
            Some((drag * restitution * restitution * down / GRAVITY_M_S2).ln_1p() / (2.0 * drag))
        };
        std::iter::successors(Some(height_m), next)
            .take(impacts + 1)
            .collect()
    }

    fn said(result: &MethodResult) -> String {
        let each = result.remarks.iter().map(ToString::to_string);
        each.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn valid_the_square_root_of_heights_is_r() {
        let exact: Vec<f64> = (0..6).map(|k| 0.64_f64.powi(k)).collect();
        let found = pooled(&[listed("a", &[exact], 1e-3)]).expect("a result");
        let r = found.parameters.restitution.expect("R");
        assert!((r.value.expect("a value") - 0.8).abs() < 2e-3, "{r:?}");
        // one impact tells nothing of its own error
        let one = pooled(&[listed("a", &[vec![1.0, 0.7]], 1e-2)]).expect("a result");
        let r = one.parameters.restitution.expect("R");
        assert!(
            matches!(r.note, Some(crate::messages::Note::HeightsNotTold { .. })),
            "{r:?}"
        );
    }

    #[test]
    fn prop_intervals_of_heights_hold_r_in_air() {
        let mut rng = ChaCha8Rng::seed_from_u64(20_261_129);
        let (mut held, mut all) = (0, 0);
        for _ in 0..300 {
            let restitution = rng.random_range(0.5..0.92);
            let drag = 10f64.powf(rng.random_range(-3.3..-0.9));
            let error_m = 10f64.powf(rng.random_range(-3.3..-2.0));
            let pairs = rng.random_bool(0.5);
            let (drops, impacts) = if pairs {
                (rng.random_range(4..12), 1)
            } else {
                (rng.random_range(1..4), 4)
            };
            let mut read = |h: f64| {
                let noise: f64 = (0..12).map(|_| rng.random_range(-0.5..0.5)).sum();
                ((h + error_m * noise) * 1e3).round() / 1e3
            };
            let heights: Vec<Vec<f64>> = (0..drops)
                .map(|k| {
                    let height_m = if pairs {
                        0.4 + 0.15 * f64::from(k % 5)
                    } else {
                        1.0
                    };
                    drop(height_m, impacts, restitution, drag)
                        .into_iter()
                        .map(&mut read)
                        .take_while(|h| *h > 0.03)
                        .collect()
                })
                .collect();
            let found = pooled(&[listed("a", &heights, 1e-3)]).expect("a result");
            let estimate = found.parameters.restitution.expect("R");
            let Some([low, high]) = estimate.interval95 else {
                continue;
            };
            all += 1;
            held += i32::from(low <= restitution && restitution <= high);
        }
        assert!(
            all > 250 && f64::from(held) > 0.93 * f64::from(all),
            "{held} of {all}"
        );
    }

    #[test]
    fn valid_heights_of_the_centre_and_of_a_light_ball_are_named() {
        // a table tennis ball: k = 0.13/m
        let light: Vec<Vec<f64>> = (0..3).map(|_| drop(2.0, 6, 0.85, 0.13)).collect();
        let found = pooled(&[listed("a", &light, 1e-3)]).expect("a result");
        assert!(
            said(&found).contains("as drag of the air does that slows a ball by 0.127"),
            "{}",
            said(&found)
        );
        // the centre of a ball of 3 cm of radius
        for (offset_m, impacts) in [(0.03, 4), (0.03, 6), (0.06, 6), (0.1, 6), (0.03, 9)] {
            let heights = drop(1.0, impacts, 0.8, 1e-4).into_iter();
            let heights = heights.map(|h| h + offset_m).collect();
            let found = pooled(&[listed("a", &[heights], 1e-3)]).expect("a result");
            let r = found.parameters.restitution.as_ref().expect("R");
            let [low, high] = r.interval95.expect("an interval");
            assert!(low < 0.8 && 0.8 < high, "{offset_m}: {r:?}");
        }
    }

    #[test]
    fn a_top_that_is_not_listed_is_named() {
        let mut heights = drop(1.0, 7, 0.8, 1e-4);
        heights.remove(3);
        let found = pooled(&[listed("a", &[heights], 1e-3)]).expect("a result");
        let text = said(&found);
        assert!(
            text.contains("heights missing: 1, the first in a after 0.409 m"),
            "{text}"
        );
        let r = found
            .parameters
            .restitution
            .and_then(|r| r.value)
            .expect("R");
        assert!((r - 0.8).abs() < 5e-3, "{r}");
    }

    #[test]
    fn valid_rebounds_of_one_height_that_scatter_show_no_change_with_the_height() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        for _ in 0..40 {
            let drop = |_| {
                let r: f64 = 0.8 + rng.random_range(-0.02..0.02);
                vec![1.0, r * r]
            };
            let drops: Vec<Vec<f64>> = (0..12).map(drop).collect();
            let found = pooled(&[listed("one height", &drops, 1e-3)]).expect("R");
            let changes = |r: &Remark| matches!(r, Remark::RestitutionByHeight { .. });
            assert!(!found.remarks.iter().any(changes), "{:?}", found.remarks);
        }
    }
}
