//! Drives of two masses that are unlike by far, down to one mass that is driven alone: by the responses of impactless records,
//! whose channels the speeds at impacts compare, as these change both masses alike whatever drives them.

use impact_records::event::{Impact, MassSpeeds, RigKind};
use impact_records::motion::{Motion, Observation};
use impact_records::signal::robust;
use std::f64::consts::TAU;

use crate::parameters::MOST_UNLIKE_DRIVES;

/// Logarithm of the ratio of both drives from which they are unlike by far: ten times the uncertainty of drives made alike.
const UNLIKE: f64 = 0.5;
/// Impactless records, and impacts, from which a ratio is known.
const FEWEST: usize = 3;

/// ln(`F_x`/`F_y`) per unit of mass with its standard uncertainty, which is as large as itself; `None` where the drives are not
/// unlike by far or that is not known. `heavier`: ln(`m_x`/`m_y`).
pub fn unlike_drives(rig: RigKind, observations: &[Observation], heavier: f64) -> Option<[f64; 2]> {
    let impactless = observations
        .iter()
        .filter(|o| o.classification.motion == Motion::Impactless && !o.excluded());
    let responses: Vec<f64> = impactless.filter_map(response_ratio).collect();
    let impacts = observations.iter().flat_map(|o| &o.impacts);
    let changes: Vec<f64> = impacts.filter_map(change_ratio).collect();
    if rig == RigKind::Single || responses.len().min(changes.len()) < FEWEST {
        return None;
    }
    // gains of both channels over each other, as an impact changes the speeds by the inverse of the masses
    let gains = robust::median(&changes)? + heavier;
    let unlike = robust::median(&responses)? - gains;
    // a channel that is dead in a part of the records is no drive
    let alike = responses.iter().filter(|own| (*own - gains).abs() < UNLIKE);
    let consistent = 4 * alike.count() < responses.len();
    // a fit moves from there
    let most = 0.9 * MOST_UNLIKE_DRIVES;
    let bounded = unlike.clamp(-most, most);
    (consistent && unlike.abs() > UNLIKE).then_some([bounded, bounded.abs()])
}

/// Logarithm of the ratio of the displacements' amplitudes, x over y, of a record in which both masses are measured.
fn response_ratio(o: &Observation) -> Option<f64> {
    let rate = TAU * o.frequency_hz()?;
    let amplitude = |of_y: bool| {
        let own = o.response.iter().find(|r| r.role.is_of_y() == of_y)?;
        let derivative = i32::from(own.role.derivative()?);
        // what is not seen is not more than its error
        Some(own.amplitude().max(own.error) / rate.powi(derivative))
    };
    // one that shows nothing at all is infinitely less
    Some((amplitude(false)? / amplitude(true)?).ln()).filter(|ratio| !ratio.is_nan())
}

/// Logarithm of the ratio by which an impact changes both speeds, x over y.
fn change_ratio(impact: &Impact) -> Option<f64> {
    let [x, y] = [impact.x?, impact.y?].map(MassSpeeds::jump_m_s);
    Some((x / y).ln()).filter(|ratio| ratio.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Response;
    use impact_records::record::Role;

    /// Four impactless records with these amplitudes of both velocities, m/s, and one with impacts that change the speeds of the
    /// masses by 0.3 m/s, as channels with these gains show them.
    fn observed(amplitudes: [f64; 2], gains: [f64; 2]) -> Vec<Observation> {
        let response = |(role, amplitude, gain): (Role, f64, f64)| Response {
            role,
            real: 0.6 * gain * amplitude,
            imaginary: -0.8 * gain * amplitude,
            error: 1e-6,
            residual_rms: 1e-5,
            high_pass_hz: None,
        };
        let impactless = |i: u8| {
            let mut o = Observation::of("r", 12.0 + f64::from(i), Motion::Impactless);
            o.response = vec![
                response((Role::VelocityX, amplitudes[0], gains[0])),
                response((Role::VelocityY, amplitudes[1], gains[1])),
            ];
            o
        };
        let mut hit = Observation::of("h", 12.0, Motion::Chaotic);
        let speeds = gains.map(|gain| {
            Some(MassSpeeds {
                before_m_s: 0.2 * gain,
                after_m_s: -0.1 * gain,
            })
        });
        let [x, y] = speeds;
        let impact = Impact {
            x,
            y,
            ..Impact::at(0.1, 0.4)
        };
        hit.impacts = vec![impact; 5];
        (0..4).map(impactless).chain([hit]).collect()
    }

    fn found(amplitudes: [f64; 2], gains: [f64; 2]) -> Option<f64> {
        let observations = observed(amplitudes, gains);
        unlike_drives(RigKind::Double, &observations, 0.0).map(|[centre, _]| centre)
    }

    #[test]
    fn drives_are_unlike_where_responses_are_and_impacts_are_not() {
        let fifth = found([0.5, 0.1], [1.0; 2]).expect("unlike drives");
        assert!((fifth - 5_f64.ln()).abs() < 1e-12, "{fifth}");
        let of_x = found([0.1, 0.5], [1.0; 2]).expect("unlike drives");
        assert!((fifth + of_x).abs() < 1e-12, "{of_x}");
        // a gain changes both alike
        assert_eq!(found([0.5, 0.5], [1.0, 0.1]), None);
        assert_eq!(found([0.5, 0.45], [1.0; 2]), None);
    }

    #[test]
    fn a_channel_that_is_dead_in_half_of_the_records_is_no_drive() {
        let mut half = observed([0.5, 0.0], [1.0; 2]);
        half.extend(observed([0.5, 0.5], [1.0; 2]));
        assert_eq!(unlike_drives(RigKind::Double, &half, 0.0), None);
    }

    #[test]
    fn a_mass_that_is_not_driven_at_all_is_at_the_limit() {
        let none = found([0.5, 0.0], [1.0, 0.1]).expect("unlike drives");
        assert!((5.0..MOST_UNLIKE_DRIVES).contains(&none), "{none}");
        let mut silent = observed([0.5, 0.0], [1.0; 2]);
        for o in &mut silent {
            o.response.iter_mut().for_each(|r| r.error = 0.0);
        }
        let found = unlike_drives(RigKind::Double, &silent, 0.0);
        assert_eq!(
            found.map(|[centre, _]| centre),
            Some(0.9 * MOST_UNLIKE_DRIVES)
        );
        assert_eq!(unlike_drives(RigKind::Single, &silent, 0.0), None);
    }
}
