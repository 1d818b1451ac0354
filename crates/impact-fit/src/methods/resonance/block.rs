//! Impactless records: each channel's complex response against the closed form.

use nalgebra::Complex;

use crate::evidence::direction::{change, relative_length};
use crate::evidence::forces::{self, Forces, Lengths, Resistance};
use crate::evidence::pickup::Pickups;
use crate::evidence::shared_error::Whitening;
use crate::methods::thinning::evenly_over;
use crate::parameters::effect::{Acts, Effect};
use crate::parameters::own::Circumstances;
use crate::parameters::{Coordinate, Parameters, gain_index};
use crate::solver::Block;
use crate::solver::group::Group;
use impact_oscillator::model::flight::{Drive, dynamic_stiffness, forced_amplitude};
use impact_oscillator::model::params::{Machine, Oscillator};
use impact_oscillator::model::sensitivity::{MassChange, forced_slope};
use impact_records::event::RigKind;
use impact_records::motion::Observation;
use impact_records::motion::Response;
use impact_records::record::Role;
use impact_records::signal::columns::{dot, subtract};

/// One impactless record.
#[derive(Debug, Clone, Default)]
pub struct ResonancePoint {
    /// Index of the record among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// Standard error of the drive's frequency, relative.
    pub frequency_error: f64,
    /// Standard error of the drive's phase, rad; `None` where it is not known, as the drive was not recorded.
    pub phase_error_rad: Option<f64>,
    /// Place in the campaign, −½ … ½.
    pub place: f64,
    /// The groups of records that it belongs to.
    pub group: Group,
    /// Responses of the channels.
    pub responses: Vec<Response>,
    /// Relative error that this record alone is allowed.
    pub own_relative_error: f64,
    /// Standard error of each response, SI, with what is allowed beside the noise.
    errors: Vec<f64>,
    /// Slopes of the responses over the logarithm of the drive's frequency; empty until they are found
    /// at good parameters.
    over_frequency: Vec<Complex<f64>>,
    /// The errors that all responses share: those of the drive's phase and frequency.
    shared: Whitening,
}

impl ResonancePoint {
    fn circumstances(&self) -> Circumstances {
        Circumstances {
            frequency_hz: self.frequency_hz,
            place: self.place,
            ..Circumstances::default()
        }
    }

    /// Complex changes of the responses over their errors, real and imaginary parts in turn.
    ///
    /// Where the drive's phase is not known, the changes of the amplitudes, and those of the phases but for
    /// the one that all have in common.
    fn weighted(&self, changes: impl Iterator<Item = Complex<f64>>) -> Vec<f64> {
        let scaled = self.errors.iter().zip(changes).map(|(error, c)| c / error);
        if self.phase_error_rad.is_some() {
            return scaled.flat_map(|c| [c.re, c.im]).collect();
        }
        let along =
            |(c, measured): (Complex<f64>, Complex<f64>)| c * measured.conj() / measured.norm();
        let turned: Vec<Complex<f64>> = scaled.zip(self.measured()).map(along).collect();
        let sizes = self
            .measured()
            .zip(&self.errors)
            .map(|(m, error)| m.norm() / error);
        let across = without_common(turned.iter().map(|c| c.im).collect(), sizes.collect());
        turned.iter().map(|c| c.re).chain(across).collect()
    }

    /// The measured responses.
    fn measured(&self) -> impl Iterator<Item = Complex<f64>> {
        self.responses
            .iter()
            .map(|r| Complex::new(r.real, r.imaginary))
    }

    /// The turn of predicted responses that brings them closest to the measured ones.
    fn turn(&self, predicted: &[Predicted]) -> Complex<f64> {
        let pairs = self.measured().zip(predicted).zip(&self.errors);
        let sum: Complex<f64> = pairs.map(|((m, p), e)| m * p.value.conj() / (e * e)).sum();
        if sum.norm() > 0.0 {
            sum / sum.norm()
        } else {
            Complex::new(1.0, 0.0)
        }
    }
}

/// Values in coordinates across a direction: Householder's reflection that brings the direction onto the
/// first axis, without that axis.
fn without_common(mut values: Vec<f64>, mut direction: Vec<f64>) -> Vec<f64> {
    let size = dot(&direction, &direction).sqrt();
    if let Some(first) = direction.first_mut() {
        *first += size.copysign(*first);
        let square = dot(&direction, &direction);
        if square > 0.0 {
            let share = 2.0 * dot(&direction, &values) / square;
            subtract(&mut values, share, &direction);
        }
        values.remove(0);
    }
    values
}

/// Responses of all impactless records.
#[derive(Debug, Clone)]
pub struct ResonanceBlock {
    /// One or two masses.
    pub rig: RigKind,
    /// The records.
    pub points: Vec<ResonancePoint>,
    /// Relative error added to every response: what gains and model leave open.
    relative_error: f64,
    /// Displacement at which springs harden by the strength of that effect, m.
    pub reach_m: f64,
    /// What channels may pick up from the drive.
    pub pickups: Pickups,
}

/// Logarithm of the ratio of both drives from which friction may hold the lesser: a fiftieth, twice the strongest friction that
/// is described.
const HELD: f64 = 4.0;

impl ResonanceBlock {
    /// Collect the impactless records that may be used.
    pub fn new(rig: RigKind, observations: &[Observation], relative_error: f64) -> Self {
        let points = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| !o.excluded() && !o.response.is_empty())
            .filter_map(|(i, o)| {
                let drive = o.tone()?;
                Some(ResonancePoint {
                    observation: i,
                    frequency_hz: drive.frequency_hz,
                    frequency_error: drive.frequency_error_hz / drive.frequency_hz,
                    phase_error_rad: o.drive.map(|_| o.drive_phase_error_rad()),
                    drive_amplitude: o.setting.drive_amplitude,
                    place: 0.0,
                    group: Group::default(),
                    responses: o
                        .response
                        .iter()
                        .filter(|r| rig == RigKind::Double || !r.role.is_of_y())
                        .copied()
                        .collect(),
                    own_relative_error: 0.0,
                    errors: Vec::new(),
                    over_frequency: Vec::new(),
                    shared: Whitening::none(),
                })
            })
            .collect();
        let mut block = Self {
            rig,
            points,
            relative_error,
            reach_m: 1.0,
            pickups: Pickups::default(),
        };
        block.allow(relative_error);
        block
    }

    /// Of so many records at most, evenly chosen over the frequency of the drive.
    #[must_use]
    pub fn few(&self, most: usize) -> Self {
        Self {
            points: evenly_over(&self.points, most, |point| point.frequency_hz),
            ..*self
        }
    }

    /// Relative error that every response is allowed beside the noise.
    pub fn relative_error(&self) -> f64 {
        self.relative_error
    }

    /// Allow every response a relative error beside the noise.
    pub fn allow(&mut self, relative_error: f64) {
        self.relative_error = relative_error;
        let mut points = std::mem::take(&mut self.points);
        for point in &mut points {
            let responses = point.responses.iter();
            let allowed = relative_error.max(point.own_relative_error);
            point.errors = responses
                .map(|r| r.error.hypot(allowed * r.amplitude()))
                .collect();
            point.shared = self.whitening(point);
        }
        self.points = points;
    }

    /// Leave out the responses of a mass that is driven by less than what dry friction may hold, by ln(`F_x`/`F_y`): the friction
    /// is described as a small part of the drive.
    pub fn without_undriven(&mut self, drive_asymmetry: f64) {
        if drive_asymmetry.abs() < HELD {
            return;
        }
        for point in &mut self.points {
            let driven = |r: &Response| r.role.is_of_y() != (drive_asymmetry > 0.0);
            point.responses.retain(driven);
        }
        self.points.retain(|point| !point.responses.is_empty());
        self.allow(self.relative_error);
    }

    /// Find at good parameters what the frequency of the drive changes in every record.
    pub fn find_changes(&mut self, parameters: &Parameters) {
        let mut points = std::mem::take(&mut self.points);
        for point in &mut points {
            let found = self.model(point, parameters);
            let slopes = found.responses.iter();
            let slopes = slopes.map(|p| p.over_frequency(found.eta));
            point.over_frequency = slopes.collect();
        }
        self.points = points;
        self.allow(self.relative_error);
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
    /// Dimensionless amplitude of the mass's displacement.
    amplitude: Complex<f64>,
    /// Hardening, friction and drag.
    resistance: Resistance,
    /// Their forces at the amplitude for effects of strength 1.
    forces: Forces,
    /// What further forces change of the amplitude.
    balance: Balance,
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
    let order = role.derivative().unwrap_or(0);
    let scale = parameters.gain(role) * parameters.static_deflection_m * drive_amplitude;
    let unit = rate.powu(u32::from(order)) * scale * (-rate * parameters.delay_s(role)).exp();
    let forced = forced_amplitude(&oscillator, Drive { eta, phase: 0.0 });
    let resistance = Resistance::default();
    Predicted {
        value: forced * unit,
        amplitude: forced,
        resistance,
        forces: resistance.forces(forced),
        balance: Balance::new(dynamic_stiffness(&oscillator, eta), &resistance, forced),
        oscillator,
        unit,
        order: f64::from(order),
        over_corner: Complex::new(0.0, 0.0),
    }
}

/// What a force changes of the amplitude at which mass, spring, damper and resistance balance.
#[derive(Debug, Clone, Copy)]
struct Balance {
    dynamic: Complex<f64>,
    /// a and b of the differential a dF + b dF* of all forces.
    along: Complex<f64>,
    across: Complex<f64>,
}

impl Balance {
    fn new(dynamic: Complex<f64>, resistance: &Resistance, amplitude: Complex<f64>) -> Self {
        let [along, across] = resistance.slope(amplitude);
        Self {
            dynamic,
            along: dynamic + along,
            across,
        }
    }

    /// Change dF of the amplitude: a dF + b dF* = force.
    fn yields(&self, force: Complex<f64>) -> Complex<f64> {
        let (along, across) = (self.along, self.across);
        (along.conj() * force - across * force.conj()) / (along.norm_sqr() - across.norm_sqr())
    }
}

/// Newton steps after which the amplitude is taken as it is.
const STEPS: usize = 20;

/// Amplitude at which drive, mass, spring, damper and resistance balance, from the linear one on.
fn balanced(dynamic: Complex<f64>, linear: Complex<f64>, resistance: &Resistance) -> Complex<f64> {
    let mut amplitude = linear;
    for _ in 0..STEPS {
        let missing = dynamic * (linear - amplitude) - resistance.force(amplitude);
        let step = Balance::new(dynamic, resistance, amplitude).yields(missing);
        // Never to another branch, nor past rest, where friction has no direction.
        let step = step * (0.5 * amplitude.norm() / step.norm()).min(1.0);
        amplitude += step;
        if step.norm() < 1e-13 * amplitude.norm() {
            break;
        }
    }
    amplitude
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
    /// With the effects of the campaign.
    fn with_effects(self, resistance: Resistance) -> Self {
        let dynamic = self.balance.dynamic;
        let amplitude = balanced(dynamic, self.amplitude, &resistance);
        Self {
            value: amplitude * self.unit,
            amplitude,
            resistance,
            forces: resistance.forces(amplitude),
            balance: Balance::new(dynamic, &resistance, amplitude),
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

    /// Slope over the strength of an effect on the mass.
    fn over_effect(&self, effect: Effect) -> Complex<f64> {
        forces::place(effect).map_or(Complex::default(), |place| {
            self.balance.yields(-self.forces[place]) * self.unit
        })
    }

    /// Slope where mass and η change, and the unit of length by a share; the drive's frequency, and with
    /// it the unit of time, does not; see [`Resistance::growth`] for `friction_over_length`.
    fn along(
        &self,
        mass: &MassChange,
        [eta, eta_change]: [f64; 2],
        length: f64,
        friction_over_length: f64,
    ) -> Complex<f64> {
        let linear = forced_slope(&self.oscillator, mass, self.amplitude, [eta, eta_change]);
        let stiffness = mass.stiffness_per_mass / self.oscillator.stiffness_per_mass();
        let shares = [stiffness, eta_change / eta, length];
        let grown = self
            .resistance
            .growth(&self.forces, shares, friction_over_length);
        let missing = self.balance.dynamic * linear - grown;
        self.balance.yields(missing) * self.unit + self.value * length
    }

    /// Slope over the logarithm of the drive's frequency.
    fn over_frequency(&self, eta: f64) -> Complex<f64> {
        self.along(&MassChange::default(), [eta, eta], 0.0, 0.0) + self.value * self.order
    }
}

/// An impactless record as the model has it.
struct Model<'a> {
    point: &'a ResonancePoint,
    at: Circumstances,
    parameters: &'a Parameters,
    machine: Machine,
    eta: f64,
    responses: Vec<Predicted>,
    pickups: Pickups,
}

/// Coordinates of a record's own that change its responses: all physical ones but R.
const OWN: usize = Coordinate::PHYSICAL.len() - 1;

/// Slopes of the responses over each coordinate of a record's own.
type OwnSlopes = [Vec<Complex<f64>>; OWN];

impl Model<'_> {
    /// Slopes of the responses over a coordinate of the machine and its setting.
    fn along(&self, coordinate: Coordinate, friction_over_length: f64) -> Vec<Complex<f64>> {
        let change = change(&self.machine, self.eta, 0.0, coordinate);
        let length = relative_length(coordinate);
        let pairs = self.point.responses.iter().zip(&self.responses);
        let along = |(r, p): (&Response, &Predicted)| {
            let mass = [&change.x, &change.y][usize::from(r.role.is_of_y())];
            p.along(mass, [self.eta, change.eta], length, friction_over_length)
        };
        pairs.map(along).collect()
    }

    /// Those over the record's own coordinates; see [`Predicted::along`] for `friction_over_length`.
    fn own_slopes(&self, friction_over_length: f64) -> OwnSlopes {
        let along = |i: usize| self.along(Coordinate::PHYSICAL[i + 1], friction_over_length);
        std::array::from_fn(along)
    }

    /// Slopes of the responses over one coordinate; `own`: those over the record's own where the
    /// campaign's `x_st` stays.
    fn over(&self, coordinate: Coordinate, own: &OwnSlopes) -> Vec<Complex<f64>> {
        match coordinate {
            Coordinate::Gain(_) | Coordinate::Corner(_) | Coordinate::Delay(_) => {
                self.over_channel(coordinate)
            }
            Coordinate::Effect(effect) if effect.acts() == Acts::Masses => {
                let responses = self.responses.iter();
                responses.map(|p| p.over_effect(effect)).collect()
            }
            Coordinate::Effect(effect) if effect.acts() == Acts::Channel => {
                let responses = self.point.responses.iter();
                let unit = |r: &Response| self.pickups.unit(effect, r.role);
                let unit = |r| Complex::from(unit(r) * self.point.drive_amplitude);
                responses.map(unit).collect()
            }
            _ => match self.parameters.own_slope(&self.at, coordinate) {
                // The campaign's x_st moves with the record's own.
                Some(slope) if coordinate == Coordinate::Deflection => {
                    self.combined(&slope.physical, &self.own_slopes(0.0))
                }
                Some(slope) => self.combined(&slope.physical, own),
                None => self.along(coordinate, 1.0),
            },
        }
    }

    /// Sum of slopes over the record's own coordinates, each times what a coordinate changes of it.
    fn combined(
        &self,
        weights: &[f64; Coordinate::PHYSICAL.len()],
        own: &OwnSlopes,
    ) -> Vec<Complex<f64>> {
        let mut sum = vec![Complex::default(); self.responses.len()];
        for (weight, slopes) in weights[1..].iter().zip(own) {
            if *weight != 0.0 {
                let all = sum.iter_mut().zip(slopes);
                all.for_each(|(sum, slope)| *sum += slope * weight);
            }
        }
        sum
    }

    /// Over the gain, the corner or the delay of one channel.
    fn over_channel(&self, coordinate: Coordinate) -> Vec<Complex<f64>> {
        let rate = Complex::new(0.0, std::f64::consts::TAU * self.point.frequency_hz);
        let pairs = self.point.responses.iter().zip(&self.responses);
        let slope = |(r, p): (&Response, &Predicted)| match coordinate {
            Coordinate::Gain(i) if gain_index(r.role) == Some(i) => p.value,
            Coordinate::Corner(i) if gain_index(r.role) == Some(i) => p.value * p.over_corner,
            Coordinate::Delay(i) if gain_index(r.role) == Some(i) => -p.value * rate * 1e-3,
            _ => Complex::default(),
        };
        pairs.map(slope).collect()
    }
}

impl ResonanceBlock {
    /// Whether the drive was recorded in all records, so that the responses have phases.
    pub fn has_phases(&self) -> bool {
        let mut points = self.points.iter();
        points.all(|p| p.phase_error_rad.is_some())
    }

    /// Predicted complex response of a channel at a point, SI, gain included.
    pub fn response(
        &self,
        parameters: &Parameters,
        point: &ResonancePoint,
        role: Role,
    ) -> Complex<f64> {
        let (frequency_hz, drive) = (point.frequency_hz, point.drive_amplitude);
        predicted(parameters, self.rig, role, frequency_hz, drive)
    }

    fn model<'a>(&self, point: &'a ResonancePoint, parameters: &'a Parameters) -> Model<'a> {
        let at = point.circumstances();
        let (own, _) = parameters.own(&at);
        let machine = own.machine(self.rig);
        let setting = [point.frequency_hz, point.drive_amplitude];
        let lengths = Lengths {
            unit_m: own.static_deflection_m * point.drive_amplitude,
            deflection_m: parameters.static_deflection_m,
            reach_m: self.reach_m,
        };
        let eta = point.frequency_hz / own.natural_frequency_hz;
        let responses = point.responses.iter();
        let responses = responses
            .map(|r| {
                let found = respond(&own, &machine, r.role, setting);
                let resistance = Resistance::new(&found.oscillator, parameters, &lengths, eta);
                let found = found.with_effects(resistance);
                match r.high_pass_hz {
                    Some(stated_hz) => {
                        let corner = own.corner(r.role);
                        found.behind(stated_hz, corner, point.frequency_hz)
                    }
                    None => found,
                }
            })
            .collect();
        let mut responses: Vec<Predicted> = responses;
        if point.phase_error_rad.is_none() {
            let turn = point.turn(&responses);
            for response in &mut responses {
                response.value *= turn;
                response.unit *= turn;
            }
        }
        Model {
            point,
            at,
            parameters,
            machine,
            eta,
            responses,
            pickups: self.pickups,
        }
    }

    /// The errors that all responses of a point share, by what was measured: weights that follow the
    /// parameters would reward a model that moves more.
    fn whitening(&self, point: &ResonancePoint) -> Whitening {
        let shifted = point.over_frequency.iter();
        let shifted = shifted.map(|slope| slope * point.frequency_error);
        let mut columns = Vec::new();
        if let Some(error) = point.phase_error_rad {
            let turn = Complex::new(0.0, error);
            columns.push(point.weighted(point.measured().map(|m| turn * m)));
        }
        if !point.over_frequency.is_empty() {
            columns.push(point.weighted(shifted));
        }
        Whitening::new(&columns)
    }

    fn apart(&self, found: &Model<'_>) -> Vec<f64> {
        let point = found.point;
        let pairs = point.responses.iter().zip(&found.responses);
        let apart = pairs.map(|(r, p)| {
            let picked_up = [Effect::PickupX, Effect::PickupY].map(|effect| {
                let unit = self.pickups.unit(effect, r.role) * point.drive_amplitude;
                found.parameters.effect(effect) * unit
            });
            Complex::new(r.real, r.imaginary) - p.value - picked_up[0] - picked_up[1]
        });
        point.weighted(apart)
    }
}

impl Block for ResonanceBlock {
    fn items(&self) -> usize {
        self.points.len()
    }

    fn owners(&self) -> Vec<usize> {
        self.points.iter().map(|item| item.observation).collect()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let point = &self.points[item];
        let mut out = self.apart(&self.model(point, parameters));
        point.shared.apply(&mut out);
        Some(out)
    }

    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let point = &self.points[item];
        let found = self.model(point, parameters);
        let white = |mut column: Vec<f64>| {
            point.shared.apply(&mut column);
            column
        };
        let own = found.own_slopes(1.0);
        let column = |coordinate: &Coordinate| {
            let slopes = found.over(*coordinate, &own);
            white(point.weighted(slopes.into_iter().map(|s| -s)))
        };
        let columns = coordinates.iter().map(column).collect();
        Some((white(self.apart(&found)), columns))
    }

    fn group(&self, item: usize) -> Option<Group> {
        Some(self.points[item].group)
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::Restitution
            | Coordinate::MassAsymmetry
            | Coordinate::ScrewZero
            | Coordinate::Gap(_) => false,
            Coordinate::Effect(effect) => match effect.acts() {
                Acts::Masses => forces::place(effect).is_some(),
                Acts::Channel => self.pickups.has(effect),
                Acts::Oscillator => true,
                Acts::Impacts => false,
            },
            _ => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Problem;
    use crate::solver::block::difference;
    use impact_records::motion::{Amplitude, Motion};

    /// Impactless records of two masses (m, k, b, F), by their own transfer functions.
    fn measured(masses: [[f64; 4]; 2]) -> ResonanceBlock {
        let point = |i: usize| {
            let frequency_hz = 8.0 + 0.5 * i as f64;
            let rate = std::f64::consts::TAU * frequency_hz;
            let roles = [Role::VelocityX, Role::VelocityY];
            let responses = roles.into_iter().zip(masses).map(|(role, [m, k, b, f])| {
                let resists = Complex::new(k - m * rate * rate, b * rate);
                let value = Complex::new(0.0, rate) * f / resists;
                Response {
                    role,
                    real: value.re,
                    imaginary: value.im,
                    error: 1e-6,
                    residual_rms: 1e-6,
                    high_pass_hz: None,
                }
            });
            ResonancePoint {
                observation: i,
                frequency_hz,
                drive_amplitude: 1.0,
                frequency_error: 0.0,
                phase_error_rad: Some(0.0),
                place: 0.0,
                group: Group::default(),
                responses: responses.collect(),
                ..ResonancePoint::default()
            }
        };
        let mut block = ResonanceBlock {
            rig: RigKind::Double,
            points: (0..20).map(point).collect(),
            relative_error: 0.0,
            reach_m: 1.0,
            pickups: Pickups::default(),
        };
        block.allow(0.0);
        block
    }

    #[test]
    fn valid_masses_ten_percent_apart_have_the_means_of_their_own_frequencies() {
        // (2π 12 Hz)² and 2 · 0.05 · 2π 12 Hz per unit of mass; the second mass is 10 % heavier.
        let (k, b) = (5684.89, 7.540);
        let block = measured([[1.0, k, b, 5.0], [1.1, 1.02 * k, 0.95 * b, 5.2]]);
        let free = vec![
            Coordinate::Frequency,
            Coordinate::Damping,
            Coordinate::Deflection,
            Coordinate::DriveAsymmetry,
            Coordinate::StiffnessAsymmetry,
            Coordinate::DampingAsymmetry,
        ];
        let problem = Problem {
            blocks: vec![(&block, 1.0)],
            free,
            ..Problem::default()
        };
        let start = Parameters::symmetric(0.8, 11.9, 0.055, 1e-3);
        let found = problem.fit(start).expect("a fit").parameters;
        let own = [1.0, 1.02 / 1.1].map(|r: f64| (k * r).sqrt());
        let f0_hz = (own[0] * own[1]).sqrt() / std::f64::consts::TAU;
        assert!((found.natural_frequency_hz / f0_hz - 1.0).abs() < 1e-7);
        let ratios = [b / own[0], 0.95 * b / 1.1 / own[1]].map(|d| 0.5 * d);
        let beta = 0.5 * (ratios[0] + ratios[1]);
        assert!((found.damping_ratio / beta - 1.0).abs() < 1e-6);
        let deflection_m = 0.5 * (5.0 / k + 5.2 / (1.02 * k));
        assert!((found.static_deflection_m / deflection_m - 1.0).abs() < 1e-7);
    }

    #[test]
    fn valid_slopes_are_those_of_finite_differences() {
        let roles = [
            Role::VelocityX,
            Role::VelocityY,
            Role::DisplacementX,
            Role::AccelerationY,
        ];
        let mut amplitudes = Observation::of("r", 14.0, Motion::Impactless);
        let of = |role| Amplitude {
            role,
            half_range: 0.2,
            rms: 0.1,
        };
        amplitudes.amplitudes = vec![of(Role::VelocityX), of(Role::VelocityY)];
        let mut block = ResonanceBlock {
            rig: RigKind::Double,
            points: vec![ResonancePoint {
                observation: 0,
                frequency_hz: 14.0,
                drive_amplitude: 1.2,
                frequency_error: 0.0,
                phase_error_rad: Some(0.0),
                place: 0.2,
                group: Group::default(),
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
                ..ResonancePoint::default()
            }],
            relative_error: 1e-3,
            reach_m: 3e-3,
            pickups: Pickups::of(&[amplitudes]),
        };
        block.allow(1e-3);
        let mut effects = [0.0; Effect::COUNT];
        effects[Effect::ForceSlope.place()] = 0.02;
        effects[Effect::DeflectionDrift.place()] = 0.01;
        effects[Effect::Hardening.place()] = 0.02;
        effects[Effect::Friction.place()] = 0.03;
        effects[Effect::Drag.place()] = 0.02;
        effects[Effect::HystereticDamping.place()] = 0.1;
        effects[Effect::PickupX.place()] = 3e-3;
        let p = Parameters {
            drive_asymmetry: 0.03,
            stiffness_asymmetry: -0.02,
            damping_asymmetry: 0.04,
            delays_s: [1e-4, 0.0, 3e-4, 0.0, 0.0, 2e-4],
            effects,
            corners: [1.0, 1.1, 1.0, 0.9, 1.0, 1.05],
            ..Parameters::symmetric(0.8, 12.6, 0.07, 1e-3)
        };
        let mut coordinates = Coordinate::PHYSICAL[1..].to_vec();
        coordinates.extend([Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry]);
        coordinates.extend([
            Coordinate::Gain(0),
            Coordinate::Gain(2),
            Coordinate::Gain(5),
            Coordinate::Delay(5),
            Coordinate::Corner(1),
            Coordinate::Delay(0),
            Coordinate::DampingAsymmetry,
        ]);
        let effects = Effect::ALL.iter().copied().map(Coordinate::Effect);
        coordinates.extend(effects.filter(|c| block.touches(*c)));
        let (here, columns) = block.slopes(0, &p, &coordinates).expect("slopes");
        for (coordinate, exact) in coordinates.iter().zip(columns) {
            let found = difference(&p, *coordinate, &here, |p| block.residuals(0, p));
            let size = impact_records::signal::robust::rms(&exact);
            for (e, f) in exact.iter().zip(found.expect("differences")) {
                assert!((e - f).abs() < 1e-6 * size, "{coordinate:?}: {e} {f}");
            }
        }
    }

    /// A record of two velocities without noise at a rig's parameters, the drive's phase off by some angle.
    fn unphased(angle: f64, at: &Parameters) -> ResonanceBlock {
        let turn = Complex::from_polar(1.0, angle);
        let response = |role: Role| {
            let value = turn * predicted(at, RigKind::Double, role, 14.0, 1.0);
            Response {
                role,
                real: value.re,
                imaginary: value.im,
                error: 1e-3 * value.norm(),
                residual_rms: 0.0,
                high_pass_hz: None,
            }
        };
        let mut block = ResonanceBlock {
            rig: RigKind::Double,
            points: vec![ResonancePoint {
                observation: 0,
                frequency_hz: 14.0,
                drive_amplitude: 1.0,
                frequency_error: 0.0,
                phase_error_rad: None,
                place: 0.0,
                group: Group::default(),
                responses: [Role::VelocityX, Role::VelocityY].map(response).to_vec(),
                ..ResonancePoint::default()
            }],
            relative_error: 0.0,
            pickups: Pickups::default(),
            reach_m: 3e-3,
        };
        block.allow(0.0);
        block
    }

    #[test]
    fn valid_without_a_phase_amplitudes_and_the_phase_between_the_masses_are_compared() {
        let truth = Parameters {
            stiffness_asymmetry: 0.03,
            ..Parameters::symmetric(0.8, 12.6, 0.07, 1e-3)
        };
        for angle in [0.0, 1.0, -2.5] {
            let block = unphased(angle, &truth);
            let here = block.residuals(0, &truth).expect("residuals");
            // two amplitudes and one phase
            assert_eq!(here.len(), 3);
            assert!(here.iter().all(|r| r.abs() < 1e-9), "{here:?}");
            // amplitudes 1 % too small are ten errors of 0.1 % off, whatever the phase
            let small = truth.with(
                Coordinate::Deflection,
                truth.coordinate(Coordinate::Deflection) - 0.01,
            );
            let off = block.residuals(0, &small).expect("residuals");
            for amplitude in &off[..2] {
                assert!(
                    (amplitude - 1e3 * (1.0 - (-0.01f64).exp())).abs() < 1e-6,
                    "{off:?}"
                );
            }
            assert!(off[2].abs() < 1e-6);
            // a phase of y against x of a milliradian is one error over √2
            let mut late = block.clone();
            let y = &mut late.points[0].responses[1];
            let turned = Complex::new(y.real, y.imaginary) * Complex::from_polar(1.0, 1e-3);
            (y.real, y.imaginary) = (turned.re, turned.im);
            late.allow(0.0);
            let off = late.residuals(0, &truth).expect("residuals");
            assert!((off[2].abs() - 0.5f64.sqrt()).abs() < 1e-3, "{off:?}");
        }
    }

    #[test]
    fn valid_slopes_without_a_phase_are_those_of_finite_differences() {
        let truth = Parameters::symmetric(0.8, 12.6, 0.07, 1e-3);
        let block = unphased(0.7, &truth);
        let coordinates = [
            Coordinate::Frequency,
            Coordinate::Damping,
            Coordinate::DriveAsymmetry,
        ];
        let (here, columns) = block.slopes(0, &truth, &coordinates).expect("slopes");
        for (coordinate, exact) in coordinates.iter().zip(columns) {
            let found = difference(&truth, *coordinate, &here, |p| block.residuals(0, p));
            let size = impact_records::signal::robust::rms(&exact);
            for (e, f) in exact.iter().zip(found.expect("differences")) {
                assert!((e - f).abs() < 1e-5 * size, "{coordinate:?}: {e} {f}");
            }
        }
    }
}
