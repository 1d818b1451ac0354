//! Times of impacts to a fraction of the sample step.

use crate::event::arc_times::arc_times;
use crate::event::arcs::{Arcs, Instant, fits, jump_centre, speeds, windows};
use crate::event::impact::MassSpeeds;
use crate::event::integrated;
use crate::event::kinematics::{Kinematics, Series};
use crate::signal::local_fit::crossing;

/// Times of all candidates: from the kink of the displacement if it is measured, else from the
/// condition that the relative displacement is the same at every impact, else the middle of the
/// sample interval. An integrated acceleration shows the impulse itself, and its centre.
pub(super) fn instants(kinematics: &Kinematics, arcs: Arcs<'_>) -> Vec<Instant> {
    let velocity = kinematics.relative.velocity.as_ref();
    let smooth = velocity.filter(|v| v.spread > 0);
    let plain: Vec<Instant> = (0..arcs.candidates.len())
        .map(|i| middle(smooth, arcs, i))
        .collect();
    match (
        &kinematics.relative.displacement,
        &kinematics.relative.velocity,
    ) {
        (Some(displacement), Some(velocity)) => (0..plain.len())
            .map(|i| {
                kink((displacement, velocity), arcs, i, kinematics.rate_hz)
                    .filter(|k| k.error < plain[i].error)
                    .unwrap_or(plain[i])
            })
            .collect(),
        (None, Some(velocity)) if velocity.is_integrated() => {
            integrated::instants(velocity, arcs, &plain)
        }
        (None, Some(velocity)) => arc_times(kinematics, velocity, arcs, &plain),
        _ => plain,
    }
}

/// The middle of a candidate's jump; where smoothing has spread it, its centre: smoothing keeps the sum of all samples.
fn middle(smooth: Option<&Series>, arcs: Arcs<'_>, index: usize) -> Instant {
    let candidate = &arcs.candidates[index];
    let jump = candidate.jump;
    let centre = smooth.and_then(|v| Some((v, jump_centre(v, arcs, index, |share| share)?)));
    let (low, high) = (jump.left as f64, (jump.left + jump.gap) as f64);
    match centre.filter(|(_, time)| (low..=high).contains(time)) {
        Some((velocity, time)) => Instant {
            time,
            error: jump.gap as f64 * velocity.noise / jump.height.abs(),
        },
        None => Instant {
            time: jump.middle(),
            error: candidate.middle_error(),
        },
    }
}

/// Where the displacement's flights before and after a candidate cross.
pub(super) fn kink(
    (displacement, velocity): (&Series, &Series),
    arcs: Arcs<'_>,
    index: usize,
    rate_hz: f64,
) -> Option<Instant> {
    let jump = arcs.candidates[index].jump;
    let windows = windows(velocity, arcs, index);
    let [before, after] = fits(&displacement.values, windows, arcs)?;
    let (low, high) = (jump.left as f64, (jump.left + jump.gap) as f64);
    let time = crossing(&before, &after, low, high)?;
    let spread = before.error_factor(time).hypot(after.error_factor(time)) * displacement.noise;
    Some(Instant {
        time,
        error: spread * rate_hz / jump.height.abs(),
    })
}

/// Correct the undone high-pass of each body's velocity for every jump, from the jumps' times
/// within their sample intervals; each body may have jumped later than its samples show it.
pub(super) fn correct_jumps(
    kinematics: &mut Kinematics,
    arcs: Arcs<'_>,
    (instants, later): (&[Instant], [f64; 2]),
) {
    let rate_hz = kinematics.rate_hz;
    for (body, later) in [&mut kinematics.x, &mut kinematics.y]
        .into_iter()
        .zip(later)
    {
        let Some(velocity) = body.velocity.as_mut().filter(|v| v.high_pass_hz.is_some()) else {
            continue;
        };
        let known: Vec<Option<MassSpeeds>> = (0..instants.len())
            .map(|i| speeds(velocity, arcs, i, instants[i]))
            .collect();
        for (instant, speeds) in instants.iter().zip(known) {
            if let Some(s) = speeds {
                velocity.correct_jump((instant.time, instant.time + later), s, rate_hz);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::arcs::Candidate;
    use crate::event::impact::DetectionSource;
    use crate::event::impact_speeds::impacts;
    use crate::event::jumps::JumpSearch;
    use crate::event::kinematics::{Body, RelativeSource};
    use crate::record::Role;

    const RATE_HZ: f64 = 2000.0;
    /// Flight time in samples, approach speed in m/s, restitution.
    const FLIGHT: f64 = 100.37;
    const SPEED: f64 = 0.5;
    const RESTITUTION: f64 = 0.8;
    const ARC_SAMPLES: usize = 16;

    /// Velocity and displacement of flights v = V(−R + as + bs²), s = 0…1, whose displacement is
    /// the same at both ends: a = 4R − 2, b = 3(1 − R). The impacts are at (k + 0.4) flights.
    fn flights() -> Kinematics {
        let (a, b) = (4.0 * RESTITUTION - 2.0, 3.0 * (1.0 - RESTITUTION));
        let share = |i: usize| (i as f64 / FLIGHT + 0.6).fract();
        let velocity = |i: usize| {
            let s = share(i);
            SPEED * (-RESTITUTION + a * s + b * s * s)
        };
        let displacement = |i: usize| {
            let s = share(i);
            let area = s * (-RESTITUTION + s * (a / 2.0 + s * b / 3.0));
            SPEED * FLIGHT / RATE_HZ * area
        };
        let series = |role: Role, values: Vec<f64>| Series {
            role,
            values,
            noise: 1e-9,
            high_pass_hz: None,
            spread: 0,
        };
        let body = Body {
            velocity: Some(series(Role::VelocityX, (0..1000).map(velocity).collect())),
            displacement: Some(series(
                Role::DisplacementX,
                (0..1000).map(displacement).collect(),
            )),
        };
        Kinematics {
            rate_hz: RATE_HZ,
            x: body.clone(),
            y: Body::default(),
            relative: body,
            relative_from: Some(RelativeSource::One),
            spikes_clipped: false,
            waveform: None,
        }
    }

    fn candidates(kinematics: &Kinematics) -> Vec<Candidate> {
        let velocity = kinematics.relative.velocity.as_ref().unwrap();
        let candidate = |jump| Candidate {
            jump,
            source: DetectionSource::Velocity,
            dead_samples: 0.0,
            calm_from: 0,
        };
        let found = JumpSearch::new(velocity, 12).find();
        found.into_iter().map(candidate).collect()
    }

    fn arcs(candidates: &[Candidate]) -> Arcs<'_> {
        Arcs {
            candidates,
            samples: ARC_SAMPLES,
        }
    }

    fn truth(k: usize) -> f64 {
        FLIGHT * (k as f64 + 0.4)
    }

    #[test]
    fn valid_the_kink_of_exact_flights_gives_time_and_speeds() {
        let kinematics = flights();
        let candidates = candidates(&kinematics);
        assert_eq!(candidates.len(), 10);
        let instants = instants(&kinematics, arcs(&candidates));
        let impacts = impacts(&kinematics, arcs(&candidates), &instants, None, None);
        for (k, (instant, impact)) in instants.iter().zip(&impacts).enumerate() {
            assert!(
                (instant.time - truth(k)).abs() < 1e-6,
                "{k}: {}",
                instant.time
            );
            let before = impact.approach_speed_before_m_s.unwrap();
            let after = impact.approach_speed_after_m_s.unwrap();
            assert!((before - SPEED).abs() < 1e-6, "{k}: {before}");
            assert!((after + RESTITUTION * SPEED).abs() < 1e-6, "{k}: {after}");
            assert_eq!(impact.x.unwrap().before_m_s, before);
            assert!(impact.y.is_none());
        }
    }

    #[test]
    fn valid_velocity_alone_gives_the_times_of_an_independent_script() {
        let mut kinematics = flights();
        kinematics.relative.displacement = None;
        let candidates = candidates(&kinematics);
        let instants = instants(&kinematics, arcs(&candidates));
        // Time errors in samples and standard errors of the same least squares (trapezoids between
        // the middles, extrapolated speeds, prior of 1/√12) in 70 lines of Python.
        let script = [
            (0.077221, 0.189298),
            (-0.095266, 0.173596),
            (0.045407, 0.138220),
            (-0.069700, 0.134203),
            (0.022440, 0.111019),
            (-0.048753, 0.113471),
            (0.004644, 0.098885),
            (-0.036387, 0.102439),
            (-0.002626, 0.093571),
            (-0.031848, 0.096794),
        ];
        for (k, (instant, (apart, error))) in instants.iter().zip(script).enumerate() {
            assert!((instant.time - truth(k) - apart).abs() < 2e-6, "{k}");
            assert!((instant.error - error).abs() < 2e-6, "{k}");
        }
    }

    #[test]
    fn windows_end_before_the_neighbouring_impacts() {
        let kinematics = flights();
        let velocity = kinematics.relative.velocity.as_ref().unwrap();
        let mut list = candidates(&kinematics);
        list[1].dead_samples = 5.0;
        let wide = Arcs {
            samples: 200,
            ..arcs(&list)
        };
        let found = windows(velocity, wide, 2);
        let (before, own, next) = (list[1].jump, list[2].jump, list[3].jump);
        assert_eq!(found[0], (before.left + before.gap + 5, own.left + 1));
        assert_eq!(found[1], (own.left + own.gap, next.left + 1));
        // After an impact with a dead zone only the samples inside it count.
        let found = windows(velocity, wide, 1);
        assert_eq!(found[1].1 - found[1].0, 5);
    }
}
