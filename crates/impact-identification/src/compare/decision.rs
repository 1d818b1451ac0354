//! Whether anything changed, by several differences that are tested each alone and all together.

/// Probability below which a test says that something changed.
const LEVEL: f64 = 0.05;

/// Whether a probability says at the level of 5 % that something changed.
pub(super) fn is_significant(p_value: f64) -> bool {
    p_value < LEVEL
}

/// Probability of differences at least as unlikely if nothing changed, by two ways of looking: the test of all
/// of them together, and the least probability of one alone times their number (Bonferroni). The least of the
/// two times two bounds that probability; a single difference is looked at in one way only. `None` without
/// any probability.
pub(super) fn of_no_change(together: Option<f64>, alone: &[f64]) -> Option<f64> {
    let known = alone.iter().copied().filter(|p| p.is_finite());
    let count = known.clone().count();
    let least = known.reduce(f64::min).map(|p| p * count as f64);
    let together = together.filter(|p| p.is_finite() && count != 1);
    let p_value = match (together, least) {
        (Some(all), Some(one)) => 2.0 * all.min(one),
        (all, one) => all.or(one)?,
    };
    Some(p_value.min(1.0))
}

/// Which of several probabilities are significant if they are tested together (Holm 1979): the least at the
/// level over their number, the next over one less, and so on until the first that is not.
pub(super) fn significant(alone: &[f64]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..alone.len()).filter(|i| alone[*i].is_finite()).collect();
    order.sort_by(|a, b| alone[*a].total_cmp(&alone[*b]));
    let count = order.len();
    let ranked = order.into_iter().enumerate();
    let holding = ranked.take_while(|(rank, i)| is_significant((count - rank) as f64 * alone[*i]));
    let mut found = vec![false; alone.len()];
    holding.for_each(|(_, i)| found[i] = true);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_clear_difference_among_four_decides_where_the_test_of_all_has_few_degrees_of_freedom() {
        // 2 · min(0.37, 4 · 0.0003) = 0.0024
        let alone = [0.0003, 0.94, 0.60, 0.98];
        let p = of_no_change(Some(0.37), &alone).expect("a probability");
        assert!((p - 0.0024).abs() < 1e-15, "{p}");
        assert!(is_significant(p));
        assert_eq!(significant(&alone), [true, false, false, false]);
    }

    #[test]
    fn differences_that_are_clear_together_alone_need_not_be() {
        // 2 · min(0.01, 4 · 0.05) = 0.02
        let alone = [0.05, 0.06, 0.07, 0.08];
        assert_eq!(of_no_change(Some(0.01), &alone), Some(0.02));
        assert_eq!(significant(&alone), [false; 4]);
    }

    #[test]
    fn a_probability_is_at_most_one_and_not_doubled_where_there_is_one_way_of_looking() {
        assert_eq!(of_no_change(Some(0.7), &[0.4, 0.9]), Some(1.0));
        assert_eq!(of_no_change(Some(0.03), &[0.03]), Some(0.03));
        assert_eq!(of_no_change(None, &[0.01, 0.5, f64::NAN]), Some(0.02));
        assert_eq!(of_no_change(Some(0.03), &[]), Some(0.03));
        assert_eq!(of_no_change(None, &[f64::NAN]), None);
    }

    #[test]
    fn holms_levels_rise_until_the_first_that_is_not_reached() {
        // 4 · 0.01 and 3 · 0.015 are below 0.05, 2 · 0.03 is not: 0.04 is not tested any more
        assert_eq!(
            significant(&[0.04, 0.015, 0.03, 0.01]),
            [false, true, false, true]
        );
        assert_eq!(significant(&[f64::NAN, 0.04]), [false, true]);
        assert!(significant(&[]).is_empty());
    }
}
