//! Impactless records: each channel's complex response against the closed form.

use nalgebra::Complex;

use crate::event::Rig;
use crate::identify::parameters::{Coordinate, Parameters, gain_index};
use crate::identify::shared_error::Whitening;
use crate::identify::solver::Block;
use crate::model::flight::{Drive, forced_amplitude};
use crate::motion::Observation;
use crate::motion::response::Response;
use crate::record::Role;

/// One impactless record.
#[derive(Debug, Clone)]
pub struct ResonancePoint {
    /// Index of the record among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// Standard error of the drive's frequency, relative.
    pub frequency_error: f64,
    /// Standard error of the drive's phase, rad.
    pub phase_error_rad: f64,
    /// Responses of the channels.
    pub responses: Vec<Response>,
}

/// Responses of all impactless records.
#[derive(Debug, Clone)]
pub struct ResonanceBlock {
    /// One or two masses.
    pub rig: Rig,
    /// The records.
    pub points: Vec<ResonancePoint>,
    /// Relative error added to every response: what gains and model leave open.
    pub relative_error: f64,
}

impl ResonanceBlock {
    /// Collect the impactless records that may be used.
    pub fn new(rig: Rig, observations: &[Observation], relative_error: f64) -> Self {
        let points = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| !o.excluded() && !o.response.is_empty())
            .filter_map(|(i, o)| {
                let drive = o.drive?;
                Some(ResonancePoint {
                    observation: i,
                    frequency_hz: drive.frequency_hz,
                    frequency_error: drive.frequency_error_hz / drive.frequency_hz,
                    phase_error_rad: o.drive_phase_error_rad(),
                    drive_amplitude: o.setting.drive_amplitude,
                    responses: o
                        .response
                        .iter()
                        .filter(|r| rig == Rig::Double || !r.role.is_of_y())
                        .copied()
                        .collect(),
                })
            })
            .collect();
        Self {
            rig,
            points,
            relative_error,
        }
    }

    /// Whether any channel of a gain's index is present.
    pub fn has_gain(&self, index: usize) -> bool {
        let mut roles = self
            .points
            .iter()
            .flat_map(|p| &p.responses)
            .map(|r| r.role);
        roles.any(|r| gain_index(r) == Some(index))
    }
}

/// Relative step of the difference that gives a response's slope over the frequency.
const FREQUENCY_STEP: f64 = 1e-6;

/// Predicted complex response of a channel, SI, gain included; the drive is cos θ.
pub fn predicted(
    parameters: &Parameters,
    rig: Rig,
    role: Role,
    frequency_hz: f64,
    drive_amplitude: f64,
) -> Complex<f64> {
    let machine = parameters.machine(rig);
    let mass = if role.is_of_y() {
        machine.y.unwrap_or(machine.x)
    } else {
        machine.x
    };
    let eta = frequency_hz / parameters.natural_frequency_hz;
    let forced = forced_amplitude(&mass, Drive { eta, phase: 0.0 });
    let rate = Complex::new(0.0, std::f64::consts::TAU * frequency_hz);
    let power = match role {
        Role::VelocityX | Role::VelocityY => rate,
        Role::AccelerationX | Role::AccelerationY => rate * rate,
        _ => Complex::new(1.0, 0.0),
    };
    let scale = parameters.gain(role) * parameters.static_deflection_m * drive_amplitude;
    Complex::new(forced.re, forced.im) * power * scale
}

impl Block for ResonanceBlock {
    fn items(&self) -> usize {
        self.points.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let point = &self.points[item];
        let mut out = Vec::with_capacity(2 * point.responses.len());
        let mut shared = [out.clone(), out.clone()];
        for r in &point.responses {
            let at = |factor: f64| {
                predicted(
                    parameters,
                    self.rig,
                    r.role,
                    factor * point.frequency_hz,
                    point.drive_amplitude,
                )
            };
            let model = at(1.0);
            let error = r.error.hypot(self.relative_error * r.amplitude());
            out.push((r.real - model.re) / error);
            out.push((r.imaginary - model.im) / error);
            let turned = Complex::new(0.0, point.phase_error_rad / error) * model;
            let shifted = (at(1.0 + FREQUENCY_STEP) - model) / FREQUENCY_STEP
                * (point.frequency_error / error);
            for (column, change) in shared.iter_mut().zip([turned, shifted]) {
                column.extend([change.re, change.im]);
            }
        }
        Whitening::new(shared.into()).apply(&mut out);
        Some(out)
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        coordinate != Coordinate::Restitution
    }
}
