//! A periodic record as the model has it: the values at all its points, and their exact slopes
//! over every parameter, over the drive's phase and over its frequency.

use crate::event::RigKind;
use crate::identify::evidence::direction::{change, relative_length, relative_rate};
use crate::identify::evidence::high_pass::{HighPass, HighPassSlope, Passed, Tail};
use crate::identify::evidence::trajectory::TrajectoryRecord;
use crate::identify::evidence::waveform::{
    Phases, Timing, TimingSlope, Vibration, velocity, velocity_slope,
};
use crate::identify::fit::parameters::{Coordinate, Parameters, gain_index};
use crate::motion::FoldedChannel;
use crate::record::Role;
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::params::{Machine, Setting};
use impact_oscillator::model::path::C64;
use impact_oscillator::model::sensitivity::{Change, MassMotion, OrbitMotion, Sensitivity};

/// The z = 1/n orbit at a record's setting whose closing speed is nearest to the measured one.
pub struct NearestOrbit {
    /// The machine.
    pub machine: Machine,
    /// η and ρ.
    pub setting: Setting,
    /// The orbits at η.
    pub branch: Branch,
    /// Its closing speed, dimensionless.
    pub closing_speed: f64,
}

impl NearestOrbit {
    /// At given parameters; `None` beyond the saddle-node.
    pub fn of(rig: RigKind, record: &TrajectoryRecord, parameters: &Parameters) -> Option<Self> {
        let machine = parameters.machine(rig);
        let setting = parameters.setting(
            record.frequency_hz,
            record.clearance_m,
            record.drive_amplitude,
        );
        let n = record.folded.periods_n;
        let branch = Branch::new(&machine, setting.frequency_ratio, n);
        let restitution = parameters.restitution.clamp(0.0, 1.0);
        let speeds = branch.closing_speeds(restitution, machine.gap(setting.clearance))?;
        let scale =
            parameters.static_deflection_m * record.drive_amplitude * parameters.natural_rate();
        let measured = record.closing_speed_m_s / scale;
        let closing_speed = speeds
            .into_iter()
            .filter(|w| *w > 0.0)
            .min_by(|a, b| (a - measured).abs().total_cmp(&(b - measured).abs()))?;
        Some(Self {
            machine,
            setting,
            branch,
            closing_speed,
        })
    }
}

/// A record's orbit at its points.
pub struct RecordMotion<'a> {
    record: &'a TrajectoryRecord,
    parameters: Parameters,
    machine: Machine,
    sensitivity: Sensitivity,
    orbit: OrbitMotion,
    eta: f64,
    gap: f64,
    /// Of each set of phases, both masses where they are measured.
    vibrations: Vec<[Option<Vibration<'a>>; 2]>,
    channels: Vec<ChannelMotion>,
}

/// What one channel shows of the orbit, dimensionless.
struct ChannelMotion {
    role: Role,
    points: usize,
    /// Its set of phases.
    set: usize,
    /// The mass's displacement or velocity.
    motion: MassMotion,
    filter: Option<Filter>,
}

/// The high-pass that a channel has passed, and what it makes of the motion.
struct Filter {
    high_pass: HighPass,
    passed: Passed,
    tail: Tail,
}

/// A direction in all that a record's values depend on.
struct Direction {
    orbit: OrbitMotion,
    eta: f64,
    /// The coordinate that may change the channels' units.
    coordinate: Option<Coordinate>,
}

impl<'a> RecordMotion<'a> {
    /// At given parameters; `None` where there is no such orbit.
    pub fn new(
        rig: RigKind,
        record: &'a TrajectoryRecord,
        parameters: &Parameters,
    ) -> Option<Self> {
        let NearestOrbit {
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
            parameters: *parameters,
            machine,
            sensitivity,
            orbit,
            eta: branch.eta,
            gap,
            vibrations: vibrations(record, &orbit, timing),
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
            Measured::Velocity => velocity(mass, self.eta),
        };
        let vibration = self.vibrations[set][usize::from(role.is_of_y())].as_ref()?;
        let filter = channel.high_pass_hz.map(|corner_hz| {
            let corner_hz = corner_hz * self.parameters.corner(role);
            let turns = f64::from(self.record.folded.periods_n);
            let corner = corner_hz / self.parameters.natural_frequency_hz;
            let period = turns * std::f64::consts::TAU / self.eta;
            let high_pass = HighPass::new(corner, self.eta, period, motion.exponent);
            Filter {
                high_pass,
                passed: high_pass.pass(&motion),
                tail: Tail::new(high_pass, vibration),
            }
        });
        Some(ChannelMotion {
            role,
            points: channel.points.len(),
            set,
            motion,
            filter,
        })
    }

    /// Values at all points, channel after channel, SI, gains included.
    pub fn values(&self) -> Vec<f64> {
        self.channel_by_channel(|channel, vibration| match &channel.filter {
            None => vibration.values(&channel.motion),
            Some(filter) => {
                let mut values = vibration.values(&filter.passed.motion);
                filter.tail.add(&mut values, filter.passed.tail);
                values
            }
        })
    }

    /// Slopes of the values over a parameter of rig or drive; a gain changes no orbit.
    pub fn slopes(&self, values: &[f64], coordinate: Coordinate) -> Vec<f64> {
        let change = change(&self.machine, self.eta, self.gap, coordinate);
        let direction = Direction {
            orbit: self.sensitivity.slope(&change),
            eta: change.eta,
            coordinate: Some(coordinate),
        };
        self.along(values, &direction)
    }

    /// Slopes over the phase of the drive against the points, per rad.
    pub fn over_phase(&self, values: &[f64]) -> Vec<f64> {
        let turned = |mass: &MassMotion| MassMotion {
            force: C64::new(0.0, -1.0) * mass.force,
            ..MassMotion::default()
        };
        let orbit = OrbitMotion {
            x: turned(&self.orbit.x),
            y: turned(&self.orbit.y),
            phase: 1.0,
            closing_speed: 0.0,
        };
        let direction = Direction {
            orbit,
            eta: 0.0,
            coordinate: None,
        };
        self.along(values, &direction)
    }

    /// Slopes over the logarithm of the drive's frequency.
    pub fn over_frequency(&self, values: &[f64]) -> Vec<f64> {
        let change = Change {
            eta: self.eta,
            ..Change::default()
        };
        let direction = Direction {
            orbit: self.sensitivity.slope(&change),
            eta: self.eta,
            coordinate: None,
        };
        self.along(values, &direction)
    }

    fn along(&self, values: &[f64], direction: &Direction) -> Vec<f64> {
        let mut slopes = self.channel_by_channel(|channel, vibration| {
            self.channel_slopes(channel, vibration, direction)
        });
        let mut start = 0;
        for channel in &self.channels {
            let end = start + channel.points;
            let relative = direction
                .coordinate
                .map_or(0.0, |c| match measured(channel.role) {
                    Measured::Velocity => relative_length(c) + relative_rate(c),
                    Measured::Displacement => relative_length(c),
                });
            if relative != 0.0 {
                let own = slopes[start..end].iter_mut().zip(&values[start..end]);
                own.for_each(|(s, v)| *s += relative * v);
            }
            start = end;
        }
        slopes
    }

    fn channel_slopes(
        &self,
        channel: &ChannelMotion,
        vibration: &Vibration<'_>,
        direction: &Direction,
    ) -> Vec<f64> {
        let own_corner = gain_index(channel.role).map(Coordinate::Corner);
        let is_own = direction.coordinate == own_corner;
        if matches!(direction.coordinate, Some(Coordinate::Corner(_))) && !is_own {
            return vec![0.0; channel.points];
        }
        let timing = TimingSlope {
            eta: direction.eta,
            impact_phase: direction.orbit.phase,
        };
        let (mass, d_mass) = (
            of_role(&self.orbit, channel.role),
            of_role(&direction.orbit, channel.role),
        );
        let change = match measured(channel.role) {
            Measured::Displacement => *d_mass,
            Measured::Velocity => velocity_slope(mass, d_mass, [self.eta, direction.eta]),
        };
        let Some(filter) = &channel.filter else {
            return vibration.slopes(&channel.motion, &change, &timing);
        };
        let relative = match direction.coordinate {
            Some(Coordinate::Frequency) => -1.0,
            Some(Coordinate::Corner(_)) => 1.0,
            _ => 0.0,
        };
        let moved = HighPassSlope {
            corner: relative * filter.high_pass.corner(),
            eta: direction.eta,
        };
        let tail = filter.passed.tail;
        let passed = filter
            .high_pass
            .pass_slope(&channel.motion, tail, &change, &moved);
        let mut slopes = vibration.slopes(&filter.passed.motion, &passed.motion, &timing);
        let tails = [tail, passed.tail];
        filter
            .tail
            .add_slopes(&mut slopes, tails, &moved, vibration, &timing);
        slopes
    }

    /// Of every channel, its points in SI from dimensionless ones.
    fn channel_by_channel(
        &self,
        of: impl Fn(&ChannelMotion, &Vibration<'_>) -> Vec<f64>,
    ) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.channels.iter().map(|c| c.points).sum());
        for channel in &self.channels {
            let vibration = &self.vibrations[channel.set][usize::from(channel.role.is_of_y())];
            if let Some(vibration) = vibration {
                let unit = self.unit(channel.role);
                out.extend(of(channel, vibration).into_iter().map(|v| v * unit));
            }
        }
        out
    }

    /// SI units of a channel, gain included, in one of the model's.
    fn unit(&self, role: Role) -> f64 {
        let p = &self.parameters;
        let length = p.static_deflection_m * self.record.drive_amplitude * p.gain(role);
        match measured(role) {
            Measured::Velocity => length * p.natural_rate(),
            Measured::Displacement => length,
        }
    }
}

/// Of each set of phases, the free vibrations of the masses that are measured.
fn vibrations<'a>(
    record: &'a TrajectoryRecord,
    orbit: &OrbitMotion,
    timing: Timing,
) -> Vec<[Option<Vibration<'a>>; 2]> {
    let of = |phases: &'a Phases, of_y: bool, mass: &MassMotion| {
        let mut channels = record.folded.channels.iter();
        channels
            .any(|c| c.role.is_of_y() == of_y)
            .then(|| Vibration::new(phases, timing, mass.exponent))
    };
    let sets = record.phases.iter();
    sets.map(|phases| [of(phases, false, &orbit.x), of(phases, true, &orbit.y)])
        .collect()
}

fn of_role(orbit: &OrbitMotion, role: Role) -> &MassMotion {
    if role.is_of_y() { &orbit.y } else { &orbit.x }
}

/// What a channel measures of a mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measured {
    Displacement,
    Velocity,
}

fn measured(role: Role) -> Measured {
    match role {
        Role::VelocityX | Role::VelocityY => Measured::Velocity,
        _ => Measured::Displacement,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::evidence::trajectory::distinct_phases;
    use crate::motion::{Folded, FoldedPoint};

    const ROLES: [Role; 4] = [
        Role::VelocityX,
        Role::VelocityY,
        Role::DisplacementX,
        Role::DisplacementY,
    ];

    fn parameters() -> Parameters {
        Parameters {
            drive_asymmetry: 0.02,
            stiffness_asymmetry: -0.03,
            gains: [1.01, 0.99, 1.0, 1.02],
            corners: [1.0, 1.03, 0.97, 1.0],
            ..Parameters::symmetric(0.85, 12.6, 0.06, 1e-3)
        }
    }

    fn record(periods_n: u32, frequency_hz: f64) -> TrajectoryRecord {
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
            channels: ROLES
                .map(|role| FoldedChannel {
                    role,
                    noise: 1.0,
                    high_pass_hz: (role != Role::VelocityX).then_some(0.5),
                    points: points.clone(),
                })
                .to_vec(),
        };
        TrajectoryRecord {
            observation: 0,
            frequency_hz,
            clearance_m: 0.4e-3,
            drive_amplitude: 1.1,
            phases: distinct_phases(&folded),
            folded,
            closing_speed_m_s: 1.0,
            frequency_error: 1e-5,
            phase_error_rad: 1e-3,
            shared: Vec::new(),
        }
    }

    fn values(record: &TrajectoryRecord, parameters: &Parameters) -> Vec<f64> {
        RecordMotion::new(RigKind::Double, record, parameters)
            .expect("an orbit")
            .values()
    }

    fn agree(exact: &[f64], above: &[f64], below: &[f64], width: f64) {
        let size = crate::signal::robust::rms(exact);
        assert!(size > 0.0);
        for ((e, a), b) in exact.iter().zip(above).zip(below) {
            let found = (a - b) / width;
            assert!((e - found).abs() < 1e-6 * size, "{e} {found} of {size}");
        }
    }

    #[test]
    fn valid_slopes_of_a_record_are_those_of_finite_differences() {
        let (p, step) = (parameters(), 1e-6);
        for record in [record(1, 15.0), record(2, 31.0)] {
            let motion = RecordMotion::new(RigKind::Double, &record, &p).expect("an orbit");
            let here = motion.values();
            let mut coordinates = Coordinate::PHYSICAL.to_vec();
            coordinates.extend([Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry]);
            coordinates.extend([Coordinate::Corner(1), Coordinate::Corner(2)]);
            for coordinate in coordinates {
                let at =
                    |by: f64| values(&record, &p.with(coordinate, p.coordinate(coordinate) + by));
                let exact = motion.slopes(&here, coordinate);
                agree(&exact, &at(step), &at(-step), 2.0 * step);
            }
            let driven = |by: f64| {
                let mut moved = record.clone();
                moved.frequency_hz *= 1.0 + by;
                values(&moved, &p)
            };
            let exact = motion.over_frequency(&here);
            agree(&exact, &driven(step), &driven(-step), 2.0 * step);
            // A drive that is ahead by a phase shows the points at phases that lie before theirs.
            let turned = |by: f64| {
                let mut moved = record.clone();
                for point in moved.folded.channels.iter_mut().flat_map(|c| &mut c.points) {
                    point.phase_rad -= by;
                }
                moved.phases = distinct_phases(&moved.folded);
                values(&moved, &p)
            };
            let exact = motion.over_phase(&here);
            agree(&exact, &turned(step), &turned(-step), 2.0 * step);
        }
    }
}
