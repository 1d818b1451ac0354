//! The impacts at their refined times, with the speeds extrapolated to them.

use crate::event::arcs::{Arcs, Instant, Reading, flights, read, speeds};
use crate::event::corner::Shifts;
use crate::event::drive::DriveTone;
use crate::event::finite_contact::FiniteContact;
use crate::event::impact::{Impact, MassSpeeds};
use crate::event::kinematics::{Body, Kinematics, RelativeSource, Series};
use crate::event::{integrated, lag};
use crate::signal::local_fit::LocalFit;

/// The impacts at the refined times. If impacts are not instantaneous the approach speeds are those
/// at the start and at the end of contact.
pub(super) fn impacts(
    kinematics: &Kinematics,
    arcs: Arcs<'_>,
    instants: &[Instant],
    drive: Option<&DriveTone>,
    contact: Option<&FiniteContact>,
) -> Vec<Impact> {
    let candidates = arcs.candidates;
    let of = |body: &Body, i: usize, delay: f64| {
        let velocity = body.velocity.as_ref()?;
        speeds(velocity, arcs, i, instants[i].later(delay))
    };
    let relative = |i: usize| {
        let velocity = kinematics.relative.velocity.as_ref()?;
        let mut reading = read(velocity, arcs, i, instants[i])?;
        let constants = integrated::error_of_constants(velocity, i, instants)?;
        reading.errors_m_s = reading.errors_m_s.map(|error| error.hypot(constants));
        Some(reading)
    };
    let delays = contact.map_or([0.0; 2], |c| c.delays);
    let rate_hz = kinematics.rate_hz;
    let times: Vec<f64> = instants.iter().map(|i| i.time).collect();
    let shifts = Shifts::of(kinematics, &times, drive);
    let lags = lag::lags(kinematics, arcs, instants, contact);
    let velocity = kinematics.relative.velocity.as_ref();
    let integrated = velocity.is_some_and(Series::is_integrated);
    (0..candidates.len())
        .map(|i| {
            let time_s = instants[i].time / rate_hz;
            let lasting = contact
                .filter(|_| candidates[i].dead_samples == 0.0)
                .and_then(|c| contact_speeds(kinematics, arcs, i, (instants[i], c)));
            let external_push_m_s = lasting.as_ref().map(|c| c.external_push_m_s);
            let lasts = lasting.is_some();
            let approach = lasting.map(|c| c.reading).or_else(|| relative(i));
            let by_time = |reading: &Reading| reading.slopes_m_s.map(|s| s * instants[i].error);
            let single = |of: Option<MassSpeeds>| match kinematics.relative_from {
                // The flights of one of two masses end at different places: their constants are not known.
                _ if !integrated => of,
                Some(RelativeSource::One) => approach.as_ref().map(|r| r.speeds),
                _ => None,
            };
            let duration = contact.map(|c| c.duration / rate_hz);
            Impact {
                time_s,
                time_error_s: instants[i].error / rate_hz,
                drive_phase_rad: drive.map(|d| d.phase_at(time_s)),
                approach_speed_before_m_s: approach.as_ref().map(|r| r.speeds.before_m_s),
                approach_speed_after_m_s: approach.as_ref().map(|r| r.speeds.after_m_s),
                speed_errors_m_s: approach.as_ref().map(|r| r.errors_m_s),
                speeds_by_time_m_s: approach.as_ref().map(by_time),
                x: single(of(&kinematics.x, i, delays[0])),
                y: single(of(&kinematics.y, i, delays[1])),
                corner_shifts: shifts.at(instants[i].time),
                lags: lags[i],
                dead_zone_s: candidates[i].dead_samples / rate_hz,
                contact_duration_s: duration.filter(|d| lasts && *d > 0.0),
                external_push_m_s: external_push_m_s.filter(|p| *p != 0.0),
                source: candidates[i].source,
            }
        })
        .collect()
}

/// Approach speeds at the start and at the end of a contact of finite duration.
struct ContactSpeeds {
    reading: Reading,
    external_push_m_s: f64,
}

/// Approach speed at first touch from the flight before, at the end of contact from the flight
/// after. Each body's velocity is taken as late as its channel shows it.
fn contact_speeds(
    kinematics: &Kinematics,
    arcs: Arcs<'_>,
    index: usize,
    (instant, contact): (Instant, &FiniteContact),
) -> Option<ContactSpeeds> {
    let relative = kinematics.relative.velocity.as_ref()?;
    let [before, after] = flights(relative, arcs, index)?;
    let bodies: Vec<([LocalFit; 2], f64)> = [&kinematics.x, &kinematics.y]
        .into_iter()
        .zip(contact.delays)
        .filter_map(|(body, delay)| {
            let velocity = body.velocity.as_ref()?;
            Some((flights(velocity, arcs, index)?, delay))
        })
        .collect();
    let delay = bodies.iter().map(|b| b.1).sum::<f64>() / bodies.len().max(1) as f64;
    let (start, end) = contact.span(instant.time + delay);
    // The bodies' own delays differ from the mean one: to first order their slopes correct that.
    let own = |side: usize, time: f64| -> f64 {
        let shift = |(fits, own): &([LocalFit; 2], f64)| fits[side].slope(time) * (own - delay);
        bodies.iter().map(shift).sum()
    };
    let acceleration = 0.5 * (before.slope(start) + after.slope(end));
    let push = -contact.profile.drift() * contact.duration * acceleration;
    let errors = [before.error_factor(start), after.error_factor(end)];
    let reading = Reading {
        speeds: MassSpeeds {
            before_m_s: before.value(start) + own(0, start),
            after_m_s: after.value(end) + own(1, end),
        },
        errors_m_s: errors.map(|factor| relative.noise * factor),
        slopes_m_s: [before.slope(start), after.slope(end)],
    };
    Some(ContactSpeeds {
        reading,
        external_push_m_s: push,
    })
}
