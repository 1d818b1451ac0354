//! A record replayed: the fitted model's motion at its setting, in step with its drive.
//!
//! The model may have several motions there: the one that was seen is looked for from the states after
//! the first measured impacts, from the steady motion of a record without one, from rest and from a lively state.

use std::f64::consts::TAU;

use impact_fit::methods::trajectories::block::channel_value;
use impact_fit::parameters::Parameters;
use impact_oscillator::atlas::MapSettings;
use impact_oscillator::atlas::map::{End, Start, march_from};
use impact_oscillator::model::flight::{Drive, State, forced_amplitude};
use impact_oscillator::model::params::{Initial, Machine, Oscillator, Setting};
use impact_oscillator::model::simulate::{Simulator, Trajectory};
use impact_records::event::{DriveTone, RigKind};
use impact_records::motion::{Motion, Observation};
use impact_records::record::Role;

/// Most measured impacts after which a simulation is started.
const MOST_STARTS: usize = 6;

/// Closing speed, in units of `x_st` Ω, of the lively start.
pub const LIVELY_SPEED: f64 = 3.0;

/// The fitted model's motion at the setting of a record, in step with the drive.
pub struct Replay {
    /// The motion it settled on.
    pub motion: Motion,
    /// Times of its impacts, s from the stretch's start.
    pub impacts_s: Vec<f64>,
    trajectory: Trajectory,
    start_tau: f64,
    omega: f64,
    parameters: Parameters,
    drive_amplitude: f64,
}

/// A stretch of a record that begins at a zero phase of its drive.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// The record's drive.
    pub drive: DriveTone,
    /// Its start, s into the record.
    pub start_s: f64,
    /// Its length, s.
    pub length_s: f64,
}

impl Replay {
    /// Of a record's stretch with fitted parameters; `None` where its clearance is not known though
    /// something touches, or where the model cannot be simulated.
    pub fn of(
        rig: RigKind,
        parameters: Parameters,
        o: &Observation,
        stretch: &Stretch,
    ) -> Option<Self> {
        let drive = &stretch.drive;
        let clearance_m = match (o.setting.clearance_m, &o.classification.motion) {
            (Some(clearance), _) => clearance,
            // Nothing touches: any wide gap will do.
            (None, Motion::Impactless) => 1e6 * parameters.static_deflection_m,
            (None, _) => return None,
        };
        let machine = parameters.machine(rig);
        let drive_amplitude = o.setting.drive_amplitude;
        let setting = parameters.setting(drive.frequency_hz, clearance_m, drive_amplitude);
        let end = settled(&machine, setting, o, &parameters)?;
        let start = setting.at_phase(end.phase);
        let mut simulator = Simulator::new(&machine, start, end.initial).ok()?;
        let to_zero = (TAU - simulator.phase().rem_euclid(TAU)) / setting.frequency_ratio;
        simulator.advance(to_zero, &mut Trajectory::default());
        let skip = cycle_shift(&simulator, o, stretch, setting);
        simulator.advance(
            f64::from(skip) * setting.period(),
            &mut Trajectory::default(),
        );
        let start_tau = simulator.tau();
        let omega = parameters.natural_rate();
        let mut trajectory = Trajectory::default();
        simulator.advance(stretch.length_s * omega, &mut trajectory);
        let impacts_s = trajectory
            .impacts
            .iter()
            .map(|i| (i.tau - start_tau) / omega)
            .collect();
        Some(Self {
            motion: end.motion.into(),
            impacts_s,
            trajectory,
            start_tau,
            omega,
            parameters,
            drive_amplitude,
        })
    }

    /// A channel's values, SI, gain and delay included, at times from the stretch's start; `None` of one that the
    /// model does not have.
    pub fn values(&self, role: Role, times_s: &[f64]) -> Option<Vec<f64>> {
        let value = |state: &State| {
            let value = channel_value(&self.parameters, self.drive_amplitude, role, state);
            value.is_finite().then_some(value)
        };
        let delay_s = self.parameters.delay_s(role);
        let states = times_s.iter().map(|t| {
            let tau = self.start_tau + (t - delay_s) * self.omega;
            self.trajectory.at(tau)
        });
        states.map(|state| value(&state)).collect()
    }
}

/// Where the model settles on the motion seen, from the first start that leads there; else from
/// the first start of all.
fn settled(
    machine: &Machine,
    setting: Setting,
    o: &Observation,
    parameters: &Parameters,
) -> Option<End> {
    let at = (setting.frequency_ratio, setting.clearance);
    let place = |(initial, phase)| Start { at, initial, phase };
    let starts: Vec<Start> = starts(machine, setting, o, parameters)
        .into_iter()
        .map(place)
        .collect();
    let ends = march_from(machine, &starts, &MapSettings::default()).ok()?;
    let same = |end: &&End| Motion::from(end.motion) == o.classification.motion;
    ends.iter().find(same).or(ends.first()).copied()
}

/// Starts to be tried: after each of the first measured impacts or, without one, the steady motion; from rest, from
/// a lively state.
fn starts(
    machine: &Machine,
    setting: Setting,
    o: &Observation,
    parameters: &Parameters,
) -> Vec<(Initial, f64)> {
    let scale =
        parameters.static_deflection_m * o.setting.drive_amplitude * parameters.natural_rate();
    let touching = |after: f64| match machine.y {
        Some(_) => Initial {
            x: setting.clearance,
            vx: 0.5 * after,
            y: setting.clearance,
            vy: 0.5 * after,
        },
        None => Initial {
            x: setting.clearance,
            vx: after,
            y: 0.0,
            vy: 0.0,
        },
    };
    let measured = o.impacts.iter().filter_map(|i| {
        let after = i.approach_speed_after_m_s? / scale;
        Some((touching(after), i.drive_phase_rad?))
    });
    let mut starts: Vec<(Initial, f64)> = measured.take(MOST_STARTS).collect();
    if o.classification.motion == Motion::Impactless {
        starts.push((steady(machine, setting), 0.0));
    }
    let lively = match machine.y {
        Some(_) => Initial::both(0.0, LIVELY_SPEED),
        None => touching(-LIVELY_SPEED),
    };
    starts.extend([(Initial::rest(), 0.0), (lively, 0.0)]);
    starts
}

/// The steady motion without impacts, at phase 0 of the drive.
fn steady(machine: &Machine, setting: Setting) -> Initial {
    let eta = setting.frequency_ratio;
    let drive = Drive { eta, phase: 0.0 };
    let state = |mass: &Oscillator| {
        let amplitude = forced_amplitude(mass, drive);
        // Re(F e^{iητ}) and its rate at τ = 0
        (amplitude.re, -eta * amplitude.im)
    };
    let (x, vx) = state(&machine.x);
    let (y, vy) = machine.y.as_ref().map_or((0.0, 0.0), state);
    Initial { x, vx, y, vy }
}

/// Whole drive periods by which the simulation has to be shifted so that its impacts fall where
/// the measured ones do (a motion of period n may be met in any of n drive periods).
fn cycle_shift(simulator: &Simulator, o: &Observation, stretch: &Stretch, setting: Setting) -> u32 {
    let Motion::Periodic { periods_n, .. } = o.classification.motion else {
        return 0;
    };
    if periods_n < 2 {
        return 0;
    }
    let mut ahead = simulator.clone();
    let mut run = Trajectory::default();
    let begin = ahead.tau();
    let span = f64::from(3 * periods_n) * setting.period();
    ahead.advance(span, &mut run);
    let simulated: Vec<(f64, f64)> = run
        .impacts
        .iter()
        .map(|i| ((i.tau - begin) / setting.period(), i.approach_speed))
        .collect();
    let measured: Vec<(f64, f64)> = o
        .impacts
        .iter()
        .filter_map(|i| {
            let turns = (i.time_s - stretch.start_s) / stretch.drive.period_s();
            Some((turns, i.approach_speed_before_m_s?))
        })
        .filter(|(t, _)| (0.0..f64::from(periods_n)).contains(t))
        .collect();
    let scale =
        |list: &[(f64, f64)]| list.iter().map(|i| i.1).sum::<f64>() / list.len().max(1) as f64;
    let (of_model, of_record) = (scale(&simulated), scale(&measured));
    let mismatch = |shift: u32| -> f64 {
        measured
            .iter()
            .map(|m| {
                simulated
                    .iter()
                    .map(|s| {
                        let apart = s.0 - f64::from(shift) - m.0;
                        apart.abs() + (s.1 / of_model - m.1 / of_record).abs()
                    })
                    .fold(f64::INFINITY, f64::min)
            })
            .sum()
    };
    (0..periods_n)
        .min_by(|a, b| mismatch(*a).total_cmp(&mismatch(*b)))
        .unwrap_or(0)
}
