//! Where a mass that is held away from rest is let go.

use crate::signal::robust;

/// Way that a held mass makes over its distance from rest, at most, and that distance over the greatest excursion, at least.
const STAYS: f64 = 0.25;
const FAR: f64 = 0.3;
/// How many times as long as the way from there to rest it is held, at least: an oscillation stays as near to a turn for
/// nine tenths of a quarter period.
const LONG: f64 = 2.0;
/// Fewest samples of the way from there to rest: noise comes to rest, and leaves it, by one.
const WAY: usize = 2;

/// The sample from which a displacement leaves the last place at which it was held, if it was.
pub(super) fn let_go(samples: &[f64]) -> Option<usize> {
    let rest = robust::median(&samples[samples.len() - samples.len() / 3..])?;
    let size = |v: f64| (v - rest).abs();
    let greatest = samples.iter().map(|v| size(*v)).fold(0.0, f64::max);
    let mut found = None;
    let mut first = 0;
    while first < samples.len() {
        let last = first + stays(&samples[first..], rest);
        let from = samples[first] - rest;
        let mut after = samples[last..].iter();
        let is_held = from.abs() > FAR * greatest
            && after
                .position(|v| (v - rest) * from <= 0.0)
                .is_some_and(|way| way >= WAY && (last - first) as f64 > LONG * way as f64);
        if is_held {
            found = Some(last);
        }
        first = last;
    }
    found
}

/// Number of samples, one at least, that stay near the first one.
fn stays(samples: &[f64], rest: f64) -> usize {
    let (mut low, mut high) = (samples[0], samples[0]);
    let leaves = samples.iter().position(|v| {
        (low, high) = (low.min(*v), high.max(*v));
        high - low > STAYS * (samples[0] - rest).abs()
    });
    leaves.unwrap_or(samples.len()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_is_let_go_where_it_was_held_and_not_where_it_turns() {
        let turn = |i: i32| std::f64::consts::TAU * f64::from(i) / 80.0;
        let free = |i: i32| (-0.02 * turn(i)).exp() * turn(i).cos();
        let swings: Vec<f64> = (0..2000).map(free).collect();
        assert_eq!(let_go(&swings), None);
        // swung by hand, held, let go at 900
        let by_hand = |i: i32| match i {
            i if i < 600 => 1.2 * (0.7 * turn(i)).sin(),
            _ => 1.0,
        };
        let held = |i: i32| if i < 900 { by_hand(i) } else { free(i - 900) };
        let values: Vec<f64> = (0..4000).map(held).collect();
        let at = let_go(&values).unwrap();
        assert!((900..912).contains(&at), "{at}");
    }
}
