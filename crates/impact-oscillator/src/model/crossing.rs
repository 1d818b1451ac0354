//! The next zero of a path, by steps that cannot pass one: no fixed scan, no bracket.
//!
//! With g = f(t) the distance left, v = −f', a = −f'', j = −f''' and K ≥ |f''''| for all later
//! time, every h ≤ hm satisfies −f(t+h) ≤ −g + vh + M h²/2, M = a + max(0, j·hm/3 + K·hm²/12).
//! The first root of the right side is a safe step, eq. (3); the steps converge to the zero from below.

use super::path::{Jet, Path};
use crate::model::patience;

/// Steps between two looks at whether the zero is still wanted.
const BETWEEN_LOOKS: u64 = 4096;

/// First time in [0, `t_max`] at which the path falls to zero, starting from f(0) ≥ 0 (or below
/// by rounding). A start at f = 0 that moves away is not a zero; one that moves on below zero
/// is a zero at once; touching zero within rounding without passing it is not counted. None either where nobody
/// wants it any longer.
pub(super) fn first_zero(path: &Path, t_max: f64) -> Option<f64> {
    let tolerance = 4e-15 * path.size();
    let longest = 1.6 / path.rate();
    let mut hm = longest;
    let (mut t, mut before) = (0.0, 0.0);
    for step in 1_u64.. {
        if step.is_multiple_of(BETWEEN_LOOKS) && patience::is_over() {
            break;
        }
        let jet = path.jet(t);
        let (g, v) = (jet.value, -jet.d1);
        if never_again(path, &jet) {
            return None;
        }
        let near = g <= tolerance.max(1e-13 * v);
        let h = if near && leaves(&jet, tolerance) {
            leaving_step(&jet, hm)
        } else if near && v >= -STILL * tolerance {
            let zero = accept(before, t, &jet);
            return (zero <= t_max).then_some(zero);
        } else {
            safe_step(g.max(0.0), v, &jet, hm)
        };
        if t + h >= t_max {
            return None;
        }
        before = t;
        t = if t + h > t { t + h } else { t.next_up() };
        hm = (1.5 * h).clamp(1e-3 * longest, longest);
    }
    None
}

/// Exact exit: what is left above zero exceeds all amplitudes, which only decay.
fn never_again(path: &Path, jet: &Jet) -> bool {
    path.is_bounded() && path.polynomial[0] > jet.amplitude
}

/// Speeds and curvatures below this many tolerances are rounding.
const STILL: f64 = 25.0;

/// Whether a path at zero is at rest or only grazes, within rounding, and does not fall.
fn leaves(jet: &Jet, tolerance: f64) -> bool {
    let still = STILL * tolerance;
    let slow = jet.d1.abs() <= still || jet.d1 * jet.d1 <= 2.0 * tolerance * jet.d2.abs();
    slow && jet.d2 >= -still
}

/// Newton's correction of an accepted zero, with the curvature where the speed is small; never
/// back beyond the point before, where the path was above zero.
fn accept(before: f64, t: f64, jet: &Jet) -> f64 {
    let (g, v, a) = (jet.value, -jet.d1, -jet.d2);
    let root = v * v + 2.0 * a * g;
    let dt = if root > 0.0 && v > 0.0 {
        2.0 * g / (v + root.sqrt())
    } else {
        0.0
    };
    t + dt.max(0.5 * (before - t))
}

/// First root of −g + vh + M h²/2, or hm where there is none before.
fn safe_step(g: f64, v: f64, jet: &Jet, hm: f64) -> f64 {
    let m = -jet.d2 + (-jet.d3 * hm / 3.0 + jet.d4_bound * hm * hm / 12.0).max(0.0);
    let root = v * v + 2.0 * m * g;
    if v > 0.0 {
        if root < 0.0 {
            hm
        } else {
            (2.0 * g / (v + root.sqrt())).min(hm)
        }
    } else if m > 0.0 {
        ((root.sqrt() - v) / m).min(hm)
    } else {
        hm
    }
}

/// Step off f = f' = 0: the longest h with a + jh/3 + Kh²/12 ≤ 0, so that f stays above zero.
fn leaving_step(jet: &Jet, hm: f64) -> f64 {
    let (a, j, k) = (-jet.d2, -jet.d3, jet.d4_bound);
    if k <= 0.0 {
        return if j > 0.0 { (-3.0 * a / j).min(hm) } else { hm };
    }
    let root = j * j / 9.0 - k * a / 3.0;
    let h = if root > 0.0 {
        (root.sqrt() - j / 3.0) * 6.0 / k
    } else {
        0.0
    };
    h.clamp(1e-6 * hm, hm)
}
