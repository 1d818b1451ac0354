//! A contact that is recorded alone: a force plate or a switch that a mass bounces on.

use super::found::InferredChannel;
use super::place::Place;
use super::roles;
use impact_records::signal::robust;

/// Noise deviations above the level at rest from which a contact is closed: noise alone does not reach it.
const ABOVE_NOISE: f64 = 8.0;
/// The same as a part of the greatest pulse, which a plate that rings after it does not reach for long.
const ABOVE_REST: f64 = 0.02;
/// Part of a record at most in which the contact is closed.
const MOSTLY_OPEN: f64 = 0.5;
/// Fewest pulses that are bounces.
const FEWEST_PULSES: usize = 4;

/// The contact or the force in which a mass bounces in most records, with the level beyond which it is closed.
pub(super) fn bounced_on(some: &[Place<'_>], channels: &[InferredChannel]) -> Option<(usize, f64)> {
    let may = |(i, c): (usize, &InferredChannel)| {
        let [low, high] = c.range?;
        (!c.is_time && roles::is_touched(c)).then_some((i, high - low))
    };
    let candidates = channels.iter().enumerate().filter_map(may);
    let (index, _) = candidates.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let values = |place: &Place<'_>| Some(place.numbers(channels[index].find(place.set())?));
    let levels: Vec<f64> = some.iter().filter_map(|p| bounces(&values(p)?)).collect();
    let level = levels
        .iter()
        .copied()
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    (2 * levels.len() > some.len()).then_some((index, level))
}

/// The level beyond which a contact is closed in whose record a mass bounces: each flight is shorter than the one before.
fn bounces(values: &[f64]) -> Option<f64> {
    let rest = robust::median(values)?;
    let excursion = values.iter().map(|v| v - rest);
    let greatest = excursion.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    let beyond = (ABOVE_NOISE * robust::noise_deviation(values)).max(ABOVE_REST * greatest.abs());
    let closed: Vec<bool> = values
        .iter()
        .map(|v| (v - rest) * greatest.signum() > beyond)
        .collect();
    let mostly_open =
        closed.iter().filter(|c| **c).count() as f64 <= MOSTLY_OPEN * values.len() as f64;
    let runs: Vec<&[bool]> = closed.chunk_by(|a, b| a == b).collect();
    let pulses = runs.iter().filter(|run| run[0]).count();
    // what precedes the first impact and what follows the last is no flight
    let between = runs.get(1..runs.len() - 1)?.iter();
    let flights: Vec<usize> = between.filter(|run| !run[0]).map(|run| run.len()).collect();
    let level = rest + greatest.signum() * beyond;
    // a stated level tells by its sign which side of it is closed
    let told = (level >= 0.0) == (greatest >= 0.0);
    (mostly_open && pulses >= FEWEST_PULSES && shorten(&flights) && told).then_some(level)
}

/// Whether most flights are shorter than the ones before.
pub(super) fn shorten<T: PartialOrd>(flights: &[T]) -> bool {
    let shorter = flights.windows(2).filter(|w| w[1] < w[0]).count();
    3 * shorter >= 2 * flights.len().saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pulses of a half sine of 3 ms at 10 kHz whose flights and heights fall by R = 0.7, on a level at rest.
    fn plate(rest: f64, sign: f64, ratio: f64) -> Vec<f64> {
        let mut at = 0.3;
        let (mut flight, mut peak) = (0.5, 200.0);
        let mut starts = Vec::new();
        for _ in 0..7 {
            starts.push((at, peak));
            at += 3e-3 + flight;
            flight *= ratio;
            peak *= ratio;
        }
        let value = |i: i32| {
            let t = f64::from(i) * 1e-4;
            let pulse = |(at, peak): &(f64, f64)| {
                let part = (t - at) / 3e-3;
                if (0.0..1.0).contains(&part) {
                    peak * (std::f64::consts::PI * part).sin()
                } else {
                    0.0
                }
            };
            rest + sign * starts.iter().map(pulse).sum::<f64>() + 0.05 * (7919.0 * t * t).sin()
        };
        (0..25_000).map(value).collect()
    }

    #[test]
    fn valid_a_plate_on_which_a_ball_bounces_is_a_contact_whichever_way_it_counts() {
        for (rest, sign) in [(0.0, 1.0), (12.0, 1.0), (0.0, -1.0)] {
            let level = bounces(&plate(rest, sign, 0.7)).expect("bounces");
            assert!((sign * (level - rest) - 4.0).abs() < 0.5, "{level}");
        }
        // pulses that come ever later, as those of footsteps of one who slows down
        assert_eq!(bounces(&plate(0.0, 1.0, 1.2)), None);
    }
}
