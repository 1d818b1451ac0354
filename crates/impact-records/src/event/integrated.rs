//! Velocities by integrating an acceleration: impacts are spikes, and each flight between two of them has a constant
//! of integration of its own.

use crate::event::arcs::{Arcs, Instant, flights, jump_centre};
use crate::event::kinematics::Series;
use crate::signal::local_fit::LocalFit;

/// Times of impacts: an integrated acceleration shows the impulse itself, and its centre; `plain` where it does not.
pub(super) fn instants(velocity: &Series, arcs: Arcs<'_>, plain: &[Instant]) -> Vec<Instant> {
    // It is known to a sample, as the spike is.
    let centre = |i: usize| {
        Some(Instant {
            time: jump_centre(velocity, arcs, i, |share| share.clamp(0.0, 1.0))?,
            error: 12f64.sqrt().recip(),
        })
    };
    (0..plain.len())
        .map(|i| centre(i).unwrap_or(plain[i]))
        .collect()
}

/// Give each flight of an integrated acceleration its own constant: the bodies touch at its ends, so its mean
/// approach velocity is zero. What a spike adds up to does not matter then, be it clipped or not.
pub(super) fn close_flights(velocity: &mut Series, arcs: Arcs<'_>, instants: &[Instant]) {
    let constants: Vec<Option<f64>> = (1..instants.len())
        .map(|next| mean_of_flight(velocity, arcs, (next, instants)))
        .collect();
    let known = |k: &usize| constants.get(*k).copied().flatten();
    let begins = |i: usize| arcs.candidates[i].jump.left + 1;
    for flight in 0..=constants.len() {
        // The first and the last one have but one end: their neighbour's constant is the nearest.
        let inner = flight.clamp(1, constants.len().max(1)) - 1;
        let Some(constant) = known(&inner) else {
            continue;
        };
        let first = flight.checked_sub(1).map_or(0, begins);
        let end = if flight < instants.len() {
            begins(flight)
        } else {
            velocity.values.len()
        };
        let samples = velocity.values.get_mut(first..end).unwrap_or_default();
        samples.iter_mut().for_each(|v| *v -= constant);
    }
}

/// Mean velocity between two impacts, from the samples clear of both and the flights' extrapolations to them.
fn mean_of_flight(
    velocity: &Series,
    arcs: Arcs<'_>,
    (next, instants): (usize, &[Instant]),
) -> Option<f64> {
    let [_, start] = flights(velocity, arcs, next - 1)?;
    let [end, _] = flights(velocity, arcs, next)?;
    let jump = arcs.candidates[next - 1].jump;
    let (first, last) = (jump.left + jump.gap, arcs.candidates[next].jump.left);
    let inside = velocity.values.get(first..=last).filter(|v| v.len() > 1)?;
    let (from, to) = (instants[next - 1].time, instants[next].time);
    let trapezoids = inside.iter().sum::<f64>() - 0.5 * (inside[0] + inside[inside.len() - 1]);
    // Simpson's rule is exact for cubics.
    let polynomial = |fit: &LocalFit, a: f64, b: f64| {
        (b - a) / 6.0 * (fit.value(a) + 4.0 * fit.value(0.5 * (a + b)) + fit.value(b))
    };
    let ends = polynomial(&start, from, first as f64) + polynomial(&end, last as f64, to);
    (to > from).then(|| (trapezoids + ends) / (to - from))
}

/// Standard error of a speed at an impact beside that of the samples next to it: where an acceleration was
/// integrated, its noise adds up from sample to sample of a flight whose mean is zero. `None` at the first and at the last impact, where one flight has but one end.
pub(super) fn error_of_constants(
    velocity: &Series,
    index: usize,
    instants: &[Instant],
) -> Option<f64> {
    if !velocity.is_integrated() {
        return Some(0.0);
    }
    let before = instants.get(index.checked_sub(1)?)?.time;
    let after = instants.get(index + 1)?.time;
    let longest = (instants[index].time - before).max(after - instants[index].time);
    Some(velocity.noise * (longest / 3.0).sqrt())
}

#[cfg(test)]
mod tests {
    use crate::event::{DetectSettings, Impact, RigKind, detect};
    use crate::record::{Flag, Problem, Record, Role};
    use crate::signal::robust;

    const RATE_HZ: f64 = 2000.0;
    /// Flight time in samples, approach speed in m/s, restitution.
    const FLIGHT: f64 = 100.37;
    const SPEED: f64 = 0.5;
    const RESTITUTION: f64 = 0.8;

    fn truth(k: usize) -> f64 {
        FLIGHT * (k as f64 + 0.4)
    }

    /// Flights whose velocities rise from −R to 1 like v = V(−R + as + bs²), s = 0…1, with a mean of zero, as an
    /// accelerometer that averages over a sample shows them, clipped at a rail; the impacts are at (k + 0.4) flights.
    fn accelerometer(rail: f64) -> Record {
        let (a, b) = (4.0 * RESTITUTION - 2.0, 3.0 * (1.0 - RESTITUTION));
        let velocity = |time: f64| {
            let s = (time / FLIGHT + 0.6).fract();
            SPEED * (-RESTITUTION + a * s + b * s * s)
        };
        let times = || (0..1000).map(f64::from);
        let values: Vec<f64> = times()
            .map(|t| ((velocity(t + 1.5) - velocity(t + 0.5)) * RATE_HZ).max(rail))
            .collect();
        let drive: Vec<f64> = times()
            .map(|t| (std::f64::consts::TAU * t / FLIGHT).cos())
            .collect();
        Record::of(
            RATE_HZ,
            &[(Role::Drive, &drive), (Role::AccelerationX, &values)],
        )
    }

    #[test]
    fn valid_speeds_of_an_accelerometer_do_not_rest_on_its_spikes() {
        // A spike adds up to (1 + R)·v·rate = 1800 m/s² in one sample; at 100 m/s² nearly nothing of it is left.
        let spikes = Problem::ClippedSpikes {
            channel: "a".to_owned(),
            count: 10,
            level: -100.0,
            dimension: Default::default(),
        };
        for (rail, clipped) in [(-2000.0, false), (-100.0, true)] {
            let mut record = accelerometer(rail);
            if clipped {
                let flag = Flag::new(None, spikes.clone());
                record.flags.push(flag.excluding(false));
            }
            let found = detect(&record, RigKind::Single, &DetectSettings::default());
            assert_eq!(found.impacts.len(), 10, "{rail}");
            let speeds =
                |i: &Impact| Some((i.approach_speed_before_m_s?, i.approach_speed_after_m_s?));
            let known: Vec<(f64, f64)> = found.impacts.iter().filter_map(speeds).collect();
            // Of the first and of the last impact one flight has no second end.
            assert_eq!(known.len(), 8, "{rail}");
            let ratios: Vec<f64> = known
                .iter()
                .map(|(before, after)| -after / before)
                .collect();
            // Within a sample the time of an impact is not known: 0.5 samples are 2 % of the speeds.
            assert!(
                ratios.iter().all(|r| (r - RESTITUTION).abs() < 0.03),
                "{rail}: {ratios:?}"
            );
            assert!(
                (robust::mean(&ratios) - RESTITUTION).abs() < 5e-3,
                "{rail}: {ratios:?}"
            );
            for (k, impact) in found.impacts.iter().enumerate() {
                assert!(
                    (impact.time_s * RATE_HZ + 1.0 - truth(k)).abs() < 0.6,
                    "{rail} {k}"
                );
            }
        }
    }
}
