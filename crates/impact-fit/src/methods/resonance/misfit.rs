//! How well a resonance curve can fit at all, and the value of something stated with which it fits best.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::fit;
use crate::parameters::Parameters;
use crate::solver::mean_squares;

/// Steps of the parabolas by which the least misfit is found, over that of the search.
const NEARER: [f64; 4] = [1.0, 0.2, 0.04, 0.01];

/// Mean square of what the best curve leaves of the responses.
pub(super) fn misfit(blocks: &Blocks, nominal: &Nominal) -> Option<f64> {
    left_by(blocks, &fit::start(blocks, nominal)?)
}

/// Mean square of what a curve leaves of the responses.
pub(super) fn left_by(blocks: &Blocks, curve: &Parameters) -> Option<f64> {
    let left = mean_squares(&blocks.resonance, curve);
    let count = left.iter().flatten().count();
    (count > 0).then(|| left.iter().flatten().sum::<f64>() / count as f64)
}

/// Where a misfit is least, from −`most` to `most` in equal steps and then nearer by parabolas; `None` where that is
/// at an end.
pub(super) fn least_of(most: f64, step: f64, misfit: &impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let count = (most / step).round();
    let places = std::iter::successors(Some(-count), |i| (*i < count).then_some(i + 1.0));
    let found = places.filter_map(|i| Some((i * step, misfit(i * step)?)));
    let (coarse, _) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
    if coarse.abs() > (count - 0.5) * step {
        return None;
    }
    NEARER
        .iter()
        .try_fold(coarse, |near, share| vertex(near, share * step, misfit))
}

/// Where the parabola through three values, a step apart, has its least value, within the steps.
fn vertex(middle: f64, step: f64, value: &impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let [low, at, high] = [middle - step, middle, middle + step].map(value);
    let (low, at, high) = (low?, at?, high?);
    let bend = low - 2.0 * at + high;
    let shift = if bend > 0.0 {
        (0.5 * (low - high) / bend).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    Some(middle + shift * step)
}
