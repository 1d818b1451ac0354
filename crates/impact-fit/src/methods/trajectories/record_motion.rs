//! A periodic record as the model has it: the terms of its values, and their exact slopes
//! over every parameter, over the drive's phase and over its frequency.

mod effects;
pub mod points;

use crate::evidence::direction::{change, relative_length, relative_rate};
use crate::evidence::high_pass::{HighPass, HighPassSlope, Passed};
use crate::evidence::waveform::{
    Rates, Terms, Timing, TimingSlope, Vibration, delayed, delayed_slope, velocity, velocity_slope,
};
use crate::methods::trajectories::nearest_orbit::NearestOrbit;
use crate::methods::trajectories::record::TrajectoryRecord;
use crate::parameters::effect::Effect;
use crate::parameters::{Coordinate, Parameters, gain_index};
use impact_oscillator::model::params::Machine;
use impact_oscillator::model::path::C64;
use impact_oscillator::model::sensitivity::{Change, MassMotion, OrbitMotion, Sensitivity};
use impact_records::event::RigKind;
use impact_records::motion::FoldedChannel;
use impact_records::record::{LowPass, Role};

/// A record's orbit as its channels show it.
pub struct RecordMotion<'a> {
    record: &'a TrajectoryRecord,
    rig: RigKind,
    /// Of the whole campaign.
    common: Parameters,
    /// Of this record.
    own: Parameters,
    machine: Machine,
    sensitivity: Sensitivity,
    orbit: OrbitMotion,
    eta: f64,
    gap: f64,
    /// When the impact is.
    timing: Timing,
    /// Of both masses.
    vibrations: [Vibration; 2],
    channels: Vec<ChannelMotion>,
}

/// What one channel shows of the orbit, dimensionless.
struct ChannelMotion {
    role: Role,
    /// Its set of phases.
    set: usize,
    /// The mass's displacement or velocity; its velocity where the acceleration is measured, since a
    /// filter passes the impulse of an impact as it passes the jump of the velocity.
    motion: MassMotion,
    /// The high-pass that the channel has passed.
    high_pass: Option<HighPass>,
    /// The motion behind it.
    passed: Passed,
    /// The low-pass that the channel has passed besides.
    low_pass: Option<SettledLowPass>,
    delay: f64,
}

impl ChannelMotion {
    /// Corner of its high-pass; 0 without one.
    fn corner(&self) -> f64 {
        self.high_pass.map_or(0.0, |h| h.corner())
    }

    /// What the channel shows between impacts, without its delay.
    fn shown(&self, eta: f64) -> Passed {
        let passed = self.unsmoothed(eta);
        self.low_pass.map_or(passed, |filter| filter.pass(&passed))
    }

    /// The measured quantity behind the high-pass, before the low-pass.
    fn unsmoothed(&self, eta: f64) -> Passed {
        match measured(self.role) {
            Measured::Acceleration => Passed {
                motion: velocity(&self.passed.motion, eta),
                tail: -self.corner() * self.passed.tail,
            },
            _ => self.passed,
        }
    }

    /// Differential of [`Self::shown`] where the motion behind the high-pass and the filters change, and the natural
    /// frequency by a share.
    fn shown_slope(
        &self,
        change: &Passed,
        moved: &HighPassSlope,
        eta: f64,
        relative_rate: f64,
    ) -> Passed {
        let slope = match measured(self.role) {
            Measured::Acceleration => Passed {
                motion: velocity_slope(&self.passed.motion, &change.motion, [eta, moved.eta]),
                tail: -moved.corner * self.passed.tail - self.corner() * change.tail,
            },
            _ => *change,
        };
        let Some(filter) = self.low_pass else {
            return slope;
        };
        let poles = filter.poles.map(|pole| pole * relative_rate);
        let moved = PolesSlope {
            motion: [
                poles[0] + C64::new(0.0, moved.eta),
                poles[1] + change.motion.exponent,
            ],
            tail: -moved.corner - self.corner() * relative_rate,
        };
        filter.pass_slope(&self.unsmoothed(eta), &slope, &moved)
    }
}

/// What a low-pass that has settled passes of the terms of a motion. It follows the high-pass: that one keeps
/// what a jump leaves of it for many periods, and the jump is whole only before the low-pass.
#[derive(Clone, Copy)]
struct SettledLowPass {
    /// Poles of the drive's term and of the free vibration's, dimensionless.
    poles: [C64; 2],
    /// Of these terms, and the slopes over their poles.
    passed: [C64; 2],
    passed_slope: [C64; 2],
    /// Of what the high-pass has kept, and its slope.
    tail: f64,
    tail_slope: f64,
    /// How much later it shows slow motion, dimensionless.
    delay: f64,
}

/// Change of the poles of a motion's terms, dimensionless, as a low-pass has them: over its own corner.
struct PolesSlope {
    /// Of the drive's term and of the free vibration's.
    motion: [C64; 2],
    /// Of what the high-pass has kept.
    tail: f64,
}

impl SettledLowPass {
    /// Of a filter, for terms with the poles of drive and free vibration, behind a high-pass with a corner.
    fn new(filter: LowPass, poles: [C64; 2], corner: f64, natural_rate: f64) -> Self {
        let transfer = |pole: C64| filter.transfer(pole * natural_rate);
        let slope = |pole: C64| filter.transfer_slope(pole * natural_rate) * natural_rate;
        let tail = C64::new(-corner, 0.0);
        Self {
            poles,
            passed: poles.map(transfer),
            passed_slope: poles.map(slope),
            tail: transfer(tail).re,
            tail_slope: slope(tail).re,
            delay: filter.delay_s() * natural_rate,
        }
    }

    fn pass(&self, before: &Passed) -> Passed {
        let [drive, free] = self.passed;
        Passed {
            motion: MassMotion {
                force: before.motion.force * drive,
                mode: before.motion.mode * free,
                ..before.motion
            },
            tail: before.tail * self.tail,
        }
    }

    /// Differential of [`Self::pass`] where the motion before it and the poles of its terms change.
    fn pass_slope(&self, before: &Passed, change: &Passed, moved: &PolesSlope) -> Passed {
        let [drive, free] = [0, 1].map(|i| self.passed_slope[i] * moved.motion[i]);
        let passed = self.pass(change);
        Passed {
            motion: MassMotion {
                force: passed.motion.force + before.motion.force * drive,
                mode: passed.motion.mode + before.motion.mode * free,
                ..passed.motion
            },
            tail: passed.tail + before.tail * self.tail_slope * moved.tail,
        }
    }
}

/// A direction in all that a record's values depend on.
struct Direction {
    orbit: OrbitMotion,
    eta: f64,
    /// The record's own coordinate that may change the channels' units, corners and delays.
    coordinate: Option<Coordinate>,
}

/// Slopes of a record's values over coordinates.
#[derive(Debug, Default)]
pub struct Slopes {
    /// The distinct columns.
    pub columns: Vec<Column>,
    /// Of each coordinate the columns and their multiples that its slopes are the sum of.
    pub sums: Vec<Vec<(usize, f64)>>,
}

/// A column of slopes.
#[derive(Debug)]
pub enum Column {
    /// Of every channel its terms, SI.
    Terms(Vec<Terms>),
    /// What an effect that acts as an extra acceleration adds beside the impact's change, as it was found.
    Effect(Effect),
}

impl Slopes {
    fn add(&mut self, column: Column) -> usize {
        self.columns.push(column);
        self.columns.len() - 1
    }

    fn alone(&mut self, column: Column) -> Vec<(usize, f64)> {
        vec![(self.add(column), 1.0)]
    }
}

impl<'a> RecordMotion<'a> {
    /// At given parameters; `None` where there is no such orbit.
    pub fn new(
        rig: RigKind,
        record: &'a TrajectoryRecord,
        parameters: &Parameters,
    ) -> Option<Self> {
        let NearestOrbit {
            own,
            machine,
            setting,
            branch,
            closing_speed,
        } = NearestOrbit::of(rig, record, parameters)?;
        let periods_n = record.folded.periods_n;
        let gap = machine.gap(setting.clearance);
        let sensitivity = Sensitivity::new(&machine, branch, periods_n, gap, closing_speed);
        let orbit = sensitivity.motion();
        let timing = Timing {
            eta: branch.eta,
            periods_n,
            impact_phase: record.folded.on_fold(orbit.phase),
        };
        let mut motion = Self {
            record,
            rig,
            common: *parameters,
            own,
            machine,
            sensitivity,
            orbit,
            eta: branch.eta,
            gap,
            timing,
            vibrations: [&orbit.x, &orbit.y].map(|mass| Vibration::new(timing, mass.exponent)),
            channels: Vec::with_capacity(record.folded.channels.len()),
        };
        for channel in &record.folded.channels {
            let found = motion.channel(channel)?;
            motion.channels.push(found);
        }
        Some(motion)
    }

    fn channel(&self, channel: &FoldedChannel) -> Option<ChannelMotion> {
        let phases = &self.record.phases;
        let set = phases.iter().position(|p| p.fit(&channel.points))?;
        let role = channel.role;
        let mass = of_role(&self.orbit, role);
        let motion = match measured(role) {
            Measured::Displacement => *mass,
            Measured::Velocity | Measured::Acceleration => velocity(mass, self.eta),
        };
        let high_pass = channel.high_pass_hz.map(|corner_hz| {
            let corner_hz = corner_hz * self.own.corner(role);
            let corner = corner_hz / self.own.natural_frequency_hz;
            HighPass::new(corner, self.eta, self.period(), motion.exponent)
        });
        let unfiltered = Passed { motion, tail: 0.0 };
        let low_pass = channel.low_pass.map(|filter| {
            let poles = [C64::new(0.0, self.eta), mass.exponent];
            let corner = high_pass.map_or(0.0, |h| h.corner());
            SettledLowPass::new(filter, poles, corner, self.own.natural_rate())
        });
        Some(ChannelMotion {
            role,
            set,
            motion,
            low_pass,
            high_pass,
            passed: high_pass.map_or(unfiltered, |h| h.pass(&motion)),
            delay: self.own.delay_s(role) * self.own.natural_rate(),
        })
    }

    /// Period of the motion, dimensionless.
    fn period(&self) -> f64 {
        f64::from(self.record.folded.periods_n) * std::f64::consts::TAU / self.eta
    }

    /// Add the masses' own responses to the effects that act as extra accelerations: as they were found,
    /// whatever the parameters are now.
    pub fn perturb(&self, values: &mut [f64]) {
        for own in &self.record.perturbations {
            add(values, self.common.effect(own.effect), &own.values);
        }
    }

    /// Strength of an effect beyond the model.
    pub fn effect(&self, effect: Effect) -> f64 {
        self.common.effect(effect)
    }

    /// The terms of every channel, SI, gains included, without the masses' own responses to the effects
    /// that act as extra accelerations; all slopes are taken of these.
    pub fn unperturbed(&self) -> Vec<Terms> {
        self.channel_by_channel(|channel, vibration| {
            let shown = channel.shown(self.eta);
            let later = (channel.corner() * channel.delay).exp();
            Terms {
                tail: [shown.tail * later, 0.0],
                ..vibration.values(&delayed(&shown.motion, self.eta, channel.delay))
            }
        })
    }

    /// How fast the channels' terms change.
    pub fn rates(&self) -> Rates {
        let channels = self.channels.iter().map(|channel| {
            let corner = channel.high_pass.map(|h| h.corner());
            let vibration = &self.vibrations[usize::from(channel.role.is_of_y())];
            (vibration.rate(), corner.map(|c| c / self.eta))
        });
        Rates {
            timing: self.timing,
            channels: channels.collect(),
        }
    }

    /// Slopes over coordinates of the fit, by the values that effects do not perturb: few distinct
    /// columns, and of what multiples of them each coordinate's slopes are the sum.
    pub fn slopes(&self, values: &[Terms], coordinates: &[Coordinate]) -> Slopes {
        let at = self.record.circumstances(self.rig);
        let mut slopes = Slopes::default();
        let (mut own, mut extra) = ([None; 5], [None; 2]);
        for coordinate in coordinates {
            let sum = match (coordinate, self.common.own_slope(&at, *coordinate)) {
                // Values are proportional to their gain.
                (Coordinate::Gain(gain), _) => {
                    slopes.alone(Column::Terms(self.only(values, *gain)))
                }
                (Coordinate::Effect(effect), _) if effect.is_perturbation() => {
                    let own = slopes.add(Column::Effect(*effect));
                    let found = self.record.perturbation(*effect);
                    let at_impact = found.map_or([0.0; 2], |p| p.at_impact).into_iter();
                    let impact = at_impact.enumerate().filter(|(_, times)| *times != 0.0);
                    let impact = impact.map(|(i, times)| {
                        let column = || Column::Terms(self.over_extra(values, i));
                        (*extra[i].get_or_insert_with(|| slopes.add(column())), times)
                    });
                    impact.chain([(own, 1.0)]).collect()
                }
                (_, Some(slope)) => {
                    let [r, f, b, x] = slope.physical;
                    let weights = [r, f, b, x, slope.clearance_m].into_iter().enumerate();
                    let parts = weights.filter(|(_, weight)| *weight != 0.0);
                    parts
                        .map(|(i, weight)| {
                            let column = || Column::Terms(self.over_own(values, i));
                            (*own[i].get_or_insert_with(|| slopes.add(column())), weight)
                        })
                        .collect()
                }
                (_, None) => slopes.alone(Column::Terms(self.over_coordinate(values, *coordinate))),
            };
            slopes.sums.push(sum);
        }
        slopes
    }

    /// The terms of the channels that have a gain, none of the others.
    fn only(&self, values: &[Terms], gain: usize) -> Vec<Terms> {
        let all = self.channels.iter().zip(values);
        all.map(|(channel, terms)| {
            if gain_index(channel.role) == Some(gain) {
                *terms
            } else {
                Terms::default()
            }
        })
        .collect()
    }

    /// Slopes over one of the record's own R, ln f0, ln β, ln `x_st`, clearance in m.
    fn over_own(&self, values: &[Terms], i: usize) -> Vec<Terms> {
        match Coordinate::PHYSICAL.get(i) {
            Some(coordinate) => self.over_coordinate(values, *coordinate),
            None => self.over_clearance(values),
        }
    }

    fn over_coordinate(&self, values: &[Terms], coordinate: Coordinate) -> Vec<Terms> {
        let change = change(&self.machine, self.eta, self.gap, coordinate);
        self.along(values, &self.direction(&change, Some(coordinate)))
    }

    /// Slopes over the clearance, per m.
    pub fn over_clearance(&self, values: &[Terms]) -> Vec<Terms> {
        let length_m = self.own.static_deflection_m * self.record.drive_amplitude;
        let change = Change {
            gap: self.machine.gap(1.0) / length_m,
            ..Change::default()
        };
        self.along(values, &self.direction(&change, None))
    }

    /// Slopes over what extra accelerations add to X + Y at the impact (0), or to X' + Y' just before it (1).
    fn over_extra(&self, values: &[Terms], i: usize) -> Vec<Terms> {
        let unit = |k: usize| if k == i { 1.0 } else { 0.0 };
        let change = Change {
            displacement: unit(0),
            velocity: unit(1),
            ..Change::default()
        };
        self.along(values, &self.direction(&change, None))
    }

    fn direction(&self, change: &Change, coordinate: Option<Coordinate>) -> Direction {
        Direction {
            orbit: self.sensitivity.slope(change),
            eta: change.eta,
            coordinate,
        }
    }

    /// Slopes over the phase of the drive against the points, per rad.
    pub fn over_phase(&self, values: &[Terms]) -> Vec<Terms> {
        let turned = |mass: &MassMotion| MassMotion {
            force: C64::new(0.0, -1.0) * mass.force,
            ..MassMotion::default()
        };
        let orbit = OrbitMotion {
            x: turned(&self.orbit.x),
            y: turned(&self.orbit.y),
            phase: 1.0,
            approach_speed: 0.0,
        };
        let direction = Direction {
            orbit,
            eta: 0.0,
            coordinate: None,
        };
        self.along(values, &direction)
    }

    /// Slopes over the logarithm of the drive's frequency.
    pub fn over_frequency(&self, values: &[Terms]) -> Vec<Terms> {
        let change = Change {
            eta: self.eta,
            ..Change::default()
        };
        let mut slopes = self.along(values, &self.direction(&change, None));
        let own = self.common.own_over_drive(self.record.frequency_hz);
        for (coordinate, weight) in own.into_iter().filter(|(_, weight)| *weight != 0.0) {
            let own = self.over_coordinate(values, coordinate);
            let pairs = slopes.iter_mut().zip(&own);
            pairs.for_each(|(slope, own)| *slope = slope.plus(weight, own));
        }
        slopes
    }

    /// Acceleration of the masses toward each other at the impact over the approach speed, 1/s: what
    /// acts on a contact of finite length while it lasts.
    pub fn press_per_s(&self) -> f64 {
        let turn = C64::from_polar(1.0, self.orbit.phase);
        let masses = [&self.orbit.x, &self.orbit.y].into_iter();
        let press: f64 = masses
            .map(|mass| {
                let square = mass.exponent * mass.exponent;
                let forced = -self.eta * self.eta * (mass.force * turn).re;
                let free = square * mass.mode * (mass.exponent * self.period()).exp();
                forced + free.re
            })
            .sum();
        press / self.orbit.approach_speed * self.own.natural_rate()
    }

    fn along(&self, values: &[Terms], direction: &Direction) -> Vec<Terms> {
        let mut slopes = self.channel_by_channel(|channel, vibration| {
            self.channel_slopes(channel, vibration, direction)
        });
        let Some(coordinate) = direction.coordinate else {
            return slopes;
        };
        let channels = self.channels.iter().zip(values);
        for (slope, (channel, own)) in slopes.iter_mut().zip(channels) {
            let relative = match measured(channel.role) {
                Measured::Displacement => relative_length(coordinate),
                Measured::Velocity => relative_length(coordinate) + relative_rate(coordinate),
                Measured::Acceleration => {
                    relative_length(coordinate) + 2.0 * relative_rate(coordinate)
                }
            };
            if relative != 0.0 {
                *slope = slope.plus(relative, own);
            }
        }
        slopes
    }

    fn channel_slopes(
        &self,
        channel: &ChannelMotion,
        vibration: &Vibration,
        direction: &Direction,
    ) -> Terms {
        let own = gain_index(channel.role);
        if let Some(Coordinate::Corner(i) | Coordinate::Delay(i)) = direction.coordinate
            && own != Some(i)
        {
            return Terms::default();
        }
        let timing = TimingSlope {
            eta: direction.eta,
            impact_phase: direction.orbit.phase,
        };
        let (mass, d_mass) = (
            of_role(&self.orbit, channel.role),
            of_role(&direction.orbit, channel.role),
        );
        let eta = [self.eta, direction.eta];
        let change = match measured(channel.role) {
            Measured::Displacement => *d_mass,
            Measured::Velocity | Measured::Acceleration => velocity_slope(mass, d_mass, eta),
        };
        let delay = match direction.coordinate {
            Some(Coordinate::Frequency) => [channel.delay, channel.delay],
            Some(Coordinate::Delay(_)) => [channel.delay, 1e-3 * self.own.natural_rate()],
            _ => [channel.delay, 0.0],
        };
        let relative = match direction.coordinate {
            Some(Coordinate::Frequency) => -1.0,
            Some(Coordinate::Corner(_)) => 1.0,
            _ => 0.0,
        };
        let corner = channel.corner();
        let moved = HighPassSlope {
            corner: relative * corner,
            eta: direction.eta,
        };
        let unfiltered = Passed {
            motion: change,
            tail: 0.0,
        };
        let passed = channel.high_pass.map_or(unfiltered, |h| {
            h.pass_slope(&channel.motion, channel.passed.tail, &change, &moved)
        });
        let shown = channel.shown(self.eta);
        let relative_rate = direction.coordinate.map_or(0.0, relative_rate);
        let slope = channel.shown_slope(&passed, &moved, self.eta, relative_rate);
        let here = delayed(&shown.motion, self.eta, channel.delay);
        let change = delayed_slope(&shown.motion, &slope.motion, eta, delay);
        let later = (corner * delay[0]).exp();
        let stretch = moved.corner * delay[0] + corner * delay[1];
        let tails = [
            shown.tail * later,
            (slope.tail + shown.tail * stretch) * later,
        ];
        let tail = channel.high_pass;
        Terms {
            tail: tail.map_or([0.0; 2], |h| h.tail_slopes(tails, &moved, &timing)),
            ..vibration.slopes(&here, &change, &timing)
        }
    }

    /// Of every channel, its terms in SI from dimensionless ones.
    fn channel_by_channel(&self, of: impl Fn(&ChannelMotion, &Vibration) -> Terms) -> Vec<Terms> {
        let channels = self.channels.iter().map(|channel| {
            let vibration = &self.vibrations[usize::from(channel.role.is_of_y())];
            of(channel, vibration).scaled(self.unit(channel.role))
        });
        channels.collect()
    }

    /// SI units of a channel, gain included, in one of the model's.
    fn unit(&self, role: Role) -> f64 {
        let p = &self.own;
        let length = p.static_deflection_m * self.record.drive_amplitude * p.gain(role);
        match measured(role) {
            Measured::Displacement => length,
            Measured::Velocity => length * p.natural_rate(),
            Measured::Acceleration => length * p.natural_rate().powi(2),
        }
    }
}

/// Add a multiple of a column.
fn add(to: &mut [f64], share: f64, column: &[f64]) {
    if share != 0.0 {
        to.iter_mut().zip(column).for_each(|(t, c)| *t += share * c);
    }
}

fn of_role(orbit: &OrbitMotion, role: Role) -> &MassMotion {
    if role.is_of_y() { &orbit.y } else { &orbit.x }
}

/// What a channel measures of a mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measured {
    Displacement,
    Velocity,
    Acceleration,
}

fn measured(role: Role) -> Measured {
    match role {
        Role::VelocityX | Role::VelocityY => Measured::Velocity,
        Role::AccelerationX | Role::AccelerationY => Measured::Acceleration,
        _ => Measured::Displacement,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::methods::trajectories::block::distinct_phases;
    use crate::methods::trajectories::record::Perturbation;
    use crate::parameters::GAIN_ROLES;
    use crate::parameters::effect::Effect;
    use crate::parameters::effect::Effects;
    use impact_records::motion::{Folded, FoldedPoint};

    /// Everything in effect that is not a perturbation.
    pub(in crate::methods) fn parameters() -> Parameters {
        let own = Effect::ALL.iter().filter(|e| !e.is_perturbation());
        let mut effects = [0.0; Effect::COUNT];
        own.for_each(|e| effects[e.place()] = 0.5 * e.accepted());
        Parameters {
            drive_asymmetry: 0.02,
            stiffness_asymmetry: -0.03,
            damping_asymmetry: 0.05,
            mass_asymmetry: 0.01,
            gains: [1.01, 0.99, 1.0, 1.02, 0.98, 1.03],
            corners: [1.0, 1.03, 0.97, 1.0, 1.02, 0.96],
            delays_s: [1e-4, 0.0, -2e-4, 3e-4, 2e-4, -1e-4],
            effects,
            screw_zero_m: 3e-6,
            gap_errors_m: vec![0.0, 4e-6].into(),
            ..Parameters::symmetric(0.85, 12.6, 0.06, 1e-3)
        }
    }

    /// A record without values of a motion of n periods.
    pub(in crate::methods) fn record(periods_n: u32, frequency_hz: f64) -> TrajectoryRecord {
        let points: Vec<FoldedPoint> = (0..64 * periods_n)
            .map(|i| FoldedPoint {
                phase_rad: 0.1 * (f64::from(i) + 0.37 + 0.2 * f64::from(i % 3)),
                spread_rad: 0.03,
                value: 0.0,
                samples: 5,
            })
            .collect();
        let folded = Folded {
            periods_n,
            impact_phase_rad: Some(0.2),
            channels: GAIN_ROLES
                .map(|role| FoldedChannel {
                    role,
                    noise: 1.0,
                    high_pass_hz: (role != Role::VelocityX).then_some(0.5),
                    low_pass: role.is_of_y().then_some(LowPass {
                        corner_hz: 60.0,
                        order: 2,
                    }),
                    points: points.clone(),
                })
                .to_vec(),
        };
        TrajectoryRecord {
            frequency_hz,
            clearance_m: 0.4e-3,
            drive_amplitude: 1.1,
            phases: distinct_phases(&folded).into(),
            folded: folded.into(),
            closing_speed_m_s: 1.0,
            typical_approach_m_s: 0.7,
            frequency_error: 1e-5,
            phase_error_rad: 1e-3,
            gap: Some(1),
            place: 0.3,
            press_per_s: -40.0,
            ..TrajectoryRecord::default()
        }
    }

    fn values(record: &TrajectoryRecord, parameters: &Parameters) -> Vec<f64> {
        RecordMotion::new(RigKind::Double, record, parameters)
            .expect("an orbit")
            .values()
    }

    /// Channel by channel, as their units differ.
    fn agree(exact: &[f64], above: &[f64], below: &[f64], width: f64) {
        assert!(impact_records::signal::robust::rms(exact) > 0.0);
        let points = exact.len() / GAIN_ROLES.len();
        let channels = exact.chunks(points).zip(above.chunks(points));
        for ((exact, above), below) in channels.zip(below.chunks(points)) {
            let size = impact_records::signal::robust::rms(exact);
            // Values are rounded by units of the last place of their terms, over the width: of tenths of a m/s,
            // and of accelerations of tens of m/s².
            let largest = above.iter().fold(0.0f64, |most, a| most.max(a.abs()));
            let rounded = (64.0 * f64::EPSILON * largest / width).max(3e-10);
            for ((e, a), b) in exact.iter().zip(above).zip(below) {
                let found = (a - b) / width;
                let apart = (e - found).abs();
                assert!(apart < 1e-6 * size + rounded, "{e} {found} of {size}");
            }
        }
    }

    #[test]
    fn valid_slopes_of_a_record_are_those_of_finite_differences() {
        let (p, step) = (parameters(), 1e-6);
        for mut record in [record(1, 15.0), record(2, 31.0)] {
            let points = (0..record.points()).map(|i| 0.01 * (0.3 * i as f64).sin());
            record.perturbations = vec![Perturbation {
                effect: Effect::Drag,
                at_impact: [0.4, -0.7],
                values: points.collect(),
            }];
            let p = p.with(Coordinate::Effect(Effect::Drag), 0.02);
            let motion = RecordMotion::new(RigKind::Double, &record, &p).expect("an orbit");
            let here = motion.unperturbed();
            let points = motion.points();
            let mut coordinates = Coordinate::PHYSICAL.to_vec();
            coordinates.extend([Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry]);
            coordinates.extend([Coordinate::DampingAsymmetry, Coordinate::MassAsymmetry]);
            coordinates.extend([1, 2, 4].map(Coordinate::Corner));
            coordinates.extend([0, 3, 5].map(Coordinate::Delay));
            coordinates.extend([Coordinate::ScrewZero, Coordinate::Gap(1)]);
            let effects = Effects::all().iter().filter(|e| !e.is_perturbation());
            coordinates.extend(effects.map(Coordinate::Effect));
            coordinates.push(Coordinate::Effect(Effect::Drag));
            let slopes = motion.slopes(&here, &coordinates);
            for (coordinate, sum) in coordinates.into_iter().zip(&slopes.sums) {
                let at =
                    |by: f64| values(&record, &p.with(coordinate, p.coordinate(coordinate) + by));
                let mut exact = vec![0.0; points.values(&here).len()];
                for (i, times) in sum {
                    match &slopes.columns[*i] {
                        Column::Terms(column) => add(&mut exact, *times, &points.values(column)),
                        Column::Effect(effect) => {
                            let own = record.perturbation(*effect).expect("known");
                            add(&mut exact, *times, &own.values);
                        }
                    }
                }
                agree(&exact, &at(step), &at(-step), 2.0 * step);
            }
            let driven = |by: f64| {
                let mut moved = record.clone();
                moved.frequency_hz *= 1.0 + by;
                values(&moved, &p)
            };
            let exact = points.values(&motion.over_frequency(&here));
            agree(&exact, &driven(step), &driven(-step), 2.0 * step);
            // A drive that is ahead by a phase shows the points at phases that lie before theirs.
            let turned = |by: f64| {
                let mut moved = record.clone();
                for point in Arc::make_mut(&mut moved.folded)
                    .channels
                    .iter_mut()
                    .flat_map(|c| &mut c.points)
                {
                    point.phase_rad -= by;
                }
                moved.phases = distinct_phases(&moved.folded).into();
                values(&moved, &p)
            };
            let exact = points.values(&motion.over_phase(&here));
            agree(&exact, &turned(step), &turned(-step), 2.0 * step);
        }
    }
}
