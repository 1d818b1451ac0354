//! Impactless records: each channel's complex response against the closed form.

use nalgebra::Complex;

use crate::event::RigKind;
use crate::identify::evidence::direction::{change, relative_length};
use crate::identify::evidence::shared_error::Whitening;
use crate::identify::fit::Block;
use crate::identify::fit::parameters::{Coordinate, Parameters, gain_index};
use crate::motion::Observation;
use crate::motion::Response;
use crate::record::Role;
use impact_oscillator::model::flight::{Drive, forced_amplitude};
use impact_oscillator::model::params::{Machine, Oscillator};
use impact_oscillator::model::sensitivity::{Change, forced_slope};

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
    pub rig: RigKind,
    /// The records.
    pub points: Vec<ResonancePoint>,
    /// Relative error added to every response: what gains and model leave open.
    pub relative_error: f64,
}

impl ResonanceBlock {
    /// Collect the impactless records that may be used.
    pub fn new(rig: RigKind, observations: &[Observation], relative_error: f64) -> Self {
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
                        .filter(|r| rig == RigKind::Double || !r.role.is_of_y())
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

    /// Role and high-pass corner, Hz, of every channel of every record.
    pub fn channels(&self) -> impl Iterator<Item = (Role, Option<f64>)> {
        let responses = self.points.iter().flat_map(|p| &p.responses);
        responses.map(|r| (r.role, r.high_pass_hz))
    }
}

/// A channel's response as the model has it.
struct Predicted {
    /// Complex response, SI, gain included; the drive is cos θ.
    value: Complex<f64>,
    oscillator: Oscillator,
    /// SI units in one of the model's displacement.
    unit: Complex<f64>,
    /// How often the displacement is differentiated.
    order: f64,
    /// Relative change of the value per unit of the corner's logarithm.
    over_corner: Complex<f64>,
}

fn respond(
    parameters: &Parameters,
    machine: &Machine,
    role: Role,
    [frequency_hz, drive_amplitude]: [f64; 2],
) -> Predicted {
    let oscillator = match machine.y {
        Some(y) if role.is_of_y() => y,
        _ => machine.x,
    };
    let eta = frequency_hz / parameters.natural_frequency_hz;
    let rate = Complex::new(0.0, std::f64::consts::TAU * frequency_hz);
    let order: u8 = match role {
        Role::VelocityX | Role::VelocityY => 1,
        Role::AccelerationX | Role::AccelerationY => 2,
        _ => 0,
    };
    let scale = parameters.gain(role) * parameters.static_deflection_m * drive_amplitude;
    let unit = rate.powu(u32::from(order)) * scale;
    Predicted {
        value: forced_amplitude(&oscillator, Drive { eta, phase: 0.0 }) * unit,
        oscillator,
        unit,
        order: f64::from(order),
        over_corner: Complex::new(0.0, 0.0),
    }
}

/// Predicted complex response of a channel, SI, gain included; the drive is cos θ.
pub fn predicted(
    parameters: &Parameters,
    rig: RigKind,
    role: Role,
    frequency_hz: f64,
    drive_amplitude: f64,
) -> Complex<f64> {
    let setting = [frequency_hz, drive_amplitude];
    respond(parameters, &parameters.machine(rig), role, setting).value
}

impl Predicted {
    /// With a high-pass of a corner other than the stated one, which was divided out.
    fn behind(self, stated_hz: f64, corner: f64, frequency_hz: f64) -> Self {
        let divided = Complex::new(stated_hz, frequency_hz);
        let passed = Complex::new(corner * stated_hz, frequency_hz);
        let off = divided / passed;
        Self {
            value: self.value * off,
            unit: self.unit * off,
            over_corner: -corner * stated_hz / passed,
            ..self
        }
    }

    /// Slope where mass and η change; the drive's frequency, and with it the unit, does not.
    fn along(&self, of_y: bool, change: &Change, eta: f64) -> Complex<f64> {
        let mass = if of_y { &change.y } else { &change.x };
        let forced = self.value / self.unit;
        forced_slope(&self.oscillator, mass, forced, [eta, change.eta]) * self.unit
    }

    /// Slope over the logarithm of the drive's frequency.
    fn over_frequency(&self, eta: f64) -> Complex<f64> {
        let change = Change {
            eta,
            ..Change::default()
        };
        self.along(false, &change, eta) + self.value * self.order
    }
}

impl ResonanceBlock {
    fn responses(&self, point: &ResonancePoint, parameters: &Parameters) -> Vec<Predicted> {
        let machine = parameters.machine(self.rig);
        let setting = [point.frequency_hz, point.drive_amplitude];
        let responses = point.responses.iter();
        responses
            .map(|r| {
                let found = respond(parameters, &machine, r.role, setting);
                match r.high_pass_hz {
                    Some(stated_hz) => {
                        let corner = parameters.corner(r.role);
                        found.behind(stated_hz, corner, point.frequency_hz)
                    }
                    None => found,
                }
            })
            .collect()
    }

    fn error(&self, response: &Response) -> f64 {
        response
            .error
            .hypot(self.relative_error * response.amplitude())
    }

    /// Complex changes of a point's responses over their errors, real and imaginary parts in turn.
    fn weighted(
        &self,
        point: &ResonancePoint,
        changes: impl Iterator<Item = Complex<f64>>,
    ) -> Vec<f64> {
        let responses = point.responses.iter().zip(changes);
        responses
            .flat_map(|(r, c)| {
                let error = self.error(r);
                [c.re / error, c.im / error]
            })
            .collect()
    }

    /// The errors that all responses of a point share: those of the drive's phase and frequency.
    fn whitening(&self, point: &ResonancePoint, found: &[Predicted], eta: f64) -> Whitening {
        let turn = Complex::new(0.0, point.phase_error_rad);
        let turned = found.iter().map(|p| turn * p.value);
        let shifted = found
            .iter()
            .map(|p| p.over_frequency(eta) * point.frequency_error);
        let columns = [self.weighted(point, turned), self.weighted(point, shifted)];
        Whitening::new(columns.into())
    }

    fn apart(&self, point: &ResonancePoint, found: &[Predicted]) -> Vec<f64> {
        let pairs = point.responses.iter().zip(found);
        let apart = pairs.map(|(r, p)| Complex::new(r.real, r.imaginary) - p.value);
        self.weighted(point, apart)
    }
}

impl Block for ResonanceBlock {
    fn items(&self) -> usize {
        self.points.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let point = &self.points[item];
        let eta = point.frequency_hz / parameters.natural_frequency_hz;
        let found = self.responses(point, parameters);
        let mut out = self.apart(point, &found);
        self.whitening(point, &found, eta).apply(&mut out);
        Some(out)
    }

    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let point = &self.points[item];
        let eta = point.frequency_hz / parameters.natural_frequency_hz;
        let machine = parameters.machine(self.rig);
        let found = self.responses(point, parameters);
        let whitening = self.whitening(point, &found, eta);
        let white = |mut column: Vec<f64>| {
            whitening.apply(&mut column);
            column
        };
        let column = |coordinate: &Coordinate| {
            let change = change(&machine, eta, 0.0, *coordinate);
            let pairs = point.responses.iter().zip(&found);
            let falling = pairs.map(|(r, p)| {
                let own = gain_index(r.role);
                let relative = match coordinate {
                    Coordinate::Gain(gain) if own == Some(*gain) => Complex::new(1.0, 0.0),
                    Coordinate::Corner(corner) if own == Some(*corner) => p.over_corner,
                    _ => relative_length(*coordinate).into(),
                };
                -p.along(r.role.is_of_y(), &change, eta) - p.value * relative
            });
            white(self.weighted(point, falling))
        };
        let columns = coordinates.iter().map(column).collect();
        Some((white(self.apart(point, &found)), columns))
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        coordinate != Coordinate::Restitution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::fit::block::difference;

    #[test]
    fn valid_slopes_are_those_of_finite_differences() {
        let roles = [
            Role::VelocityX,
            Role::VelocityY,
            Role::DisplacementX,
            Role::AccelerationY,
        ];
        let block = ResonanceBlock {
            rig: RigKind::Double,
            points: vec![ResonancePoint {
                observation: 0,
                frequency_hz: 14.0,
                drive_amplitude: 1.2,
                frequency_error: 0.0,
                phase_error_rad: 0.0,
                responses: roles
                    .map(|role| Response {
                        role,
                        real: 1e-3,
                        imaginary: 2e-3,
                        error: 1e-4,
                        residual_rms: 1e-4,
                        high_pass_hz: role.is_of_y().then_some(0.5),
                    })
                    .to_vec(),
            }],
            relative_error: 1e-3,
        };
        let p = Parameters {
            drive_asymmetry: 0.03,
            stiffness_asymmetry: -0.02,
            corners: [1.0, 1.1, 1.0, 0.9],
            ..Parameters::symmetric(0.8, 12.6, 0.07, 1e-3)
        };
        let mut coordinates = Coordinate::PHYSICAL[1..].to_vec();
        coordinates.extend([Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry]);
        coordinates.extend([
            Coordinate::Gain(0),
            Coordinate::Gain(2),
            Coordinate::Corner(1),
        ]);
        let (here, columns) = block.slopes(0, &p, &coordinates).expect("slopes");
        for (coordinate, exact) in coordinates.iter().zip(columns) {
            let found = difference(&p, *coordinate, &here, |p| block.residuals(0, p));
            let size = crate::signal::robust::rms(&exact);
            for (e, f) in exact.iter().zip(found.expect("differences")) {
                assert!((e - f).abs() < 1e-6 * size, "{coordinate:?}: {e} {f}");
            }
        }
    }
}
