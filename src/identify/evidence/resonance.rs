//! Impactless records: each channel's complex response against the closed form.

use nalgebra::Complex;

use crate::event::RigKind;
use crate::identify::evidence::direction::{change, relative_length};
use crate::identify::evidence::shared_error::Whitening;
use crate::identify::fit::Block;
use crate::identify::fit::effect::{Effect, EffectKind};
use crate::identify::fit::own::Circumstances;
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
    /// Place in the campaign, −½ … ½.
    pub place: f64,
    /// The group of records that it belongs to.
    pub group: usize,
    /// Responses of the channels.
    pub responses: Vec<Response>,
}

impl ResonancePoint {
    fn circumstances(&self) -> Circumstances {
        Circumstances {
            frequency_hz: self.frequency_hz,
            place: self.place,
            ..Circumstances::default()
        }
    }
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
    /// Displacement at which springs harden by the strength of that effect, m.
    pub reach_m: f64,
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
                    place: 0.0,
                    group: 0,
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
            reach_m: 1.0,
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
    /// Dimensionless amplitude of the mass's displacement without effects beyond the model.
    forced: Complex<f64>,
    /// What hardening and friction change of it, per unit of their strengths.
    extra: [Complex<f64>; 2],
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
    let unit = rate.powu(u32::from(order)) * scale * (-rate * parameters.delay_s(role)).exp();
    let forced = forced_amplitude(&oscillator, Drive { eta, phase: 0.0 });
    Predicted {
        value: forced * unit,
        forced,
        extra: [Complex::default(); 2],
        oscillator,
        unit,
        order: f64::from(order),
        over_corner: Complex::new(0.0, 0.0),
    }
}

/// The effects that change an impactless response, in the order of [`Predicted::extra`].
const EXTRA: [Effect; 2] = [Effect::Hardening, Effect::Friction];

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
    /// With hardening springs and friction, by their describing functions: a force εX³ acts at the
    /// drive's frequency like ¾ε|F|²X, one of sign X' like (4/π)X'/|X'|. `hardening` is ε and
    /// `friction` the force per unit of their strengths.
    fn with_effects(self, parameters: &Parameters, [hardening, friction]: [f64; 2]) -> Self {
        let size = self.forced.norm();
        let compliance = self.forced / self.oscillator.drive_per_mass();
        let stiffening = self.forced * (0.75 * hardening * size * size);
        let resisting =
            Complex::new(0.0, friction * 4.0 / std::f64::consts::PI / size) * self.forced;
        let extra = [-compliance * stiffening, -compliance * resisting];
        let changes = EXTRA.iter().zip(extra);
        let change: Complex<f64> = changes.map(|(e, c)| c * parameters.effect(*e)).sum();
        Self {
            value: (self.forced + change) * self.unit,
            extra,
            ..self
        }
    }

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
        forced_slope(&self.oscillator, mass, self.forced, [eta, change.eta]) * self.unit
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
        let (own, _) = parameters.own(&point.circumstances());
        let machine = own.machine(self.rig);
        let setting = [point.frequency_hz, point.drive_amplitude];
        let length_m = own.static_deflection_m * point.drive_amplitude;
        let hardening = (length_m / self.reach_m).powi(2);
        let friction = parameters.static_deflection_m / length_m;
        let responses = point.responses.iter();
        responses
            .map(|r| {
                let found = respond(&own, &machine, r.role, setting);
                let stiffness = found.oscillator.stiffness_per_mass();
                let found = found.with_effects(parameters, [stiffness * hardening, friction]);
                match r.high_pass_hz {
                    Some(stated_hz) => {
                        let corner = own.corner(r.role);
                        found.behind(stated_hz, corner, point.frequency_hz)
                    }
                    None => found,
                }
            })
            .collect()
    }

    /// Slopes of the responses over one coordinate.
    fn over(
        &self,
        point: &ResonancePoint,
        found: &[Predicted],
        parameters: &Parameters,
        coordinate: Coordinate,
    ) -> Vec<Complex<f64>> {
        let at = point.circumstances();
        let (own, _) = parameters.own(&at);
        let machine = own.machine(self.rig);
        let eta = point.frequency_hz / own.natural_frequency_hz;
        let along = |coordinate: Coordinate, r: &Response, p: &Predicted| {
            let change = change(&machine, eta, 0.0, coordinate);
            p.along(r.role.is_of_y(), &change, eta) + p.value * relative_length(coordinate)
        };
        let slope = parameters.own_slope(&at, coordinate);
        let rate = Complex::new(0.0, std::f64::consts::TAU * point.frequency_hz);
        let pairs = point.responses.iter().zip(found);
        pairs
            .map(|(r, p)| match coordinate {
                Coordinate::Gain(i) | Coordinate::Corner(i) | Coordinate::Delay(i)
                    if gain_index(r.role) != Some(i) =>
                {
                    Complex::default()
                }
                Coordinate::Gain(_) => p.value,
                Coordinate::Corner(_) => p.value * p.over_corner,
                Coordinate::Delay(_) => -p.value * rate * 1e-3,
                Coordinate::Effect(Effect::Hardening) => p.extra[0] * p.unit,
                Coordinate::Effect(Effect::Friction) => p.extra[1] * p.unit,
                _ => match &slope {
                    Some(slope) => {
                        let own = Coordinate::PHYSICAL.into_iter().zip(slope.physical).skip(1);
                        let own = own.filter(|(_, weight)| *weight != 0.0);
                        own.map(|(c, weight)| along(c, r, p) * weight).sum()
                    }
                    None => along(coordinate, r, p),
                },
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
        Whitening::new(&columns)
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
        let found = self.responses(point, parameters);
        let whitening = self.whitening(point, &found, eta);
        let white = |mut column: Vec<f64>| {
            whitening.apply(&mut column);
            column
        };
        let column = |coordinate: &Coordinate| {
            let slopes = self.over(point, &found, parameters, *coordinate);
            white(self.weighted(point, slopes.into_iter().map(|s| -s)))
        };
        let columns = coordinates.iter().map(column).collect();
        Some((white(self.apart(point, &found)), columns))
    }

    fn group(&self, item: usize) -> Option<usize> {
        Some(self.points[item].group)
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::Restitution
            | Coordinate::MassAsymmetry
            | Coordinate::ScrewZero
            | Coordinate::Gap(_) => false,
            Coordinate::Effect(effect) => !matches!(
                effect.kind(),
                EffectKind::Harmonics | EffectKind::ContactDuration
            ),
            _ => true,
        }
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
                place: 0.2,
                group: 0,
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
            reach_m: 3e-3,
        };
        let mut effects = [0.0; Effect::COUNT];
        effects[Effect::ForceSlope.place()] = 0.02;
        effects[Effect::DeflectionDrift.place()] = 0.01;
        let p = Parameters {
            drive_asymmetry: 0.03,
            stiffness_asymmetry: -0.02,
            damping_asymmetry: 0.04,
            delays_s: [1e-4, 0.0, 3e-4, 0.0],
            effects,
            corners: [1.0, 1.1, 1.0, 0.9],
            ..Parameters::symmetric(0.8, 12.6, 0.07, 1e-3)
        };
        let mut coordinates = Coordinate::PHYSICAL[1..].to_vec();
        coordinates.extend([Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry]);
        coordinates.extend([
            Coordinate::Gain(0),
            Coordinate::Gain(2),
            Coordinate::Corner(1),
            Coordinate::Delay(0),
            Coordinate::DampingAsymmetry,
        ]);
        let effects = Effect::ALL.map(Coordinate::Effect);
        coordinates.extend(effects.into_iter().filter(|c| block.touches(*c)));
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
