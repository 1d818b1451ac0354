//! Chosen records beside their simulation with the fitted parameters.

use super::{Gathered, rows};
use crate::event::detect::DetectSettings;
use crate::event::kinematics::{Body, Series};
use crate::event::{Detection, DriveTone, detect};
use crate::identify::parameters::Parameters;
use crate::identify::trajectory::channel_value;
use crate::model::flight::State;
use crate::model::params::{Initial, Setting};
use crate::model::simulate::{Simulator, Trajectory};
use crate::motion::{Motion, Observation};
use crate::record::{Record, Role};
use crate::report::content::{Comparison, Portrait, Signal, Trace};
use crate::units::Dimension;

/// Drive periods for a simulated motion to settle.
const SETTLE_PERIODS: f64 = 400.0;
/// Drive periods that are drawn at least.
const SHOWN_PERIODS: u32 = 4;

pub(super) fn comparisons(gathered: &Gathered) -> Vec<Comparison> {
    let letters = ('A'..='Z').map(String::from);
    gathered
        .chosen
        .iter()
        .zip(gathered.chosen_records)
        .zip(letters)
        .filter_map(|((index, record), letter)| {
            comparison(gathered, &gathered.observations[*index], record, letter)
        })
        .collect()
}

fn comparison(
    gathered: &Gathered,
    o: &Observation,
    record: &Record,
    letter: String,
) -> Option<Comparison> {
    let drive = o.drive?;
    let detection = detect(record, gathered.campaign.rig, &DetectSettings::default());
    let periods = match o.finding.motion {
        Motion::Periodic { periods_n, .. } => (2 * periods_n).max(SHOWN_PERIODS),
        Motion::Impactless => SHOWN_PERIODS,
        _ => 10,
    };
    let window = Window::new(&detection, &drive, f64::from(periods));
    let simulation = gathered
        .fit
        .and_then(|_| Simulation::of(gathered, o, &drive, &window));
    let (eta, rho) = rows::place(gathered, o);
    let traces = traces(record, &detection, &window, simulation.as_ref());
    Some(Comparison {
        letter,
        record: o.record.clone(),
        eta,
        rho,
        drive_period_s: Some(drive.period_s()),
        motion: o.finding.motion.clone(),
        simulated_motion: None,
        portraits: portraits(&traces),
        traces,
        impacts_s: o
            .impacts
            .iter()
            .map(|i| i.time_s - window.start_s)
            .filter(|t| (0.0..window.length_s).contains(t))
            .collect(),
        simulated_impacts_s: simulation.map(|s| s.impacts_s).unwrap_or_default(),
        note: String::new(),
    })
}

/// The stretch of a record that is drawn: it begins at a zero phase of the drive.
struct Window {
    start_s: f64,
    length_s: f64,
    rate_hz: f64,
}

impl Window {
    fn new(detection: &Detection, drive: &DriveTone, periods: f64) -> Self {
        let rate_hz = detection.kinematics.rate_hz;
        let period = drive.period_s();
        let start_s = period * (1.0 - drive.phase_at(0.0) / std::f64::consts::TAU);
        Self {
            start_s,
            length_s: periods * period,
            rate_hz,
        }
    }

    fn range(&self, samples: usize) -> std::ops::Range<usize> {
        let first = (self.start_s * self.rate_hz).ceil() as usize;
        let last = ((self.start_s + self.length_s) * self.rate_hz).floor() as usize + 1;
        first.min(samples)..last.min(samples)
    }

    fn signal(&self, values: &[f64]) -> Signal {
        let range = self.range(values.len());
        Signal {
            time_s: range
                .clone()
                .map(|i| i as f64 / self.rate_hz - self.start_s)
                .collect(),
            values: values[range].to_vec(),
        }
    }
}

/// The fitted model's motion at the setting of a record, in step with the drive.
struct Simulation {
    trajectory: Trajectory,
    start_tau: f64,
    omega: f64,
    impacts_s: Vec<f64>,
    parameters: Parameters,
    drive_amplitude: f64,
}

impl Simulation {
    fn of(
        gathered: &Gathered,
        o: &Observation,
        drive: &DriveTone,
        window: &Window,
    ) -> Option<Self> {
        let parameters = *gathered.parameters()?;
        let clearance_m = match (o.setting.clearance_m, &o.finding.motion) {
            (Some(clearance), _) => clearance,
            // Nothing touches: any wide gap will do.
            (None, Motion::Impactless) => 1e6 * parameters.static_deflection_m,
            (None, _) => return None,
        };
        let machine = parameters.machine(gathered.campaign.rig);
        let amplitude = o.setting.drive_amplitude;
        let setting = parameters.setting(drive.frequency_hz, clearance_m, amplitude);
        let mut simulator = started(&machine, setting, o, &parameters, amplitude)?;
        let periods = SETTLE_PERIODS - simulator.tau() / setting.period();
        simulator.advance(
            periods.max(0.0) * setting.period(),
            &mut Trajectory::default(),
        );
        let to_zero = (std::f64::consts::TAU - simulator.phase()) / setting.frequency_ratio;
        simulator.advance(to_zero, &mut Trajectory::default());
        let skip = cycle_shift(&mut simulator, o, drive, window, setting);
        simulator.advance(
            f64::from(skip) * setting.period(),
            &mut Trajectory::default(),
        );
        let start_tau = simulator.tau();
        let omega = parameters.natural_rate();
        let mut trajectory = Trajectory::default();
        simulator.advance(window.length_s * omega, &mut trajectory);
        let impacts_s = trajectory
            .impacts
            .iter()
            .map(|i| (i.tau - start_tau) / omega)
            .collect();
        let drive_amplitude = amplitude;
        Some(Self {
            trajectory,
            start_tau,
            omega,
            impacts_s,
            parameters,
            drive_amplitude,
        })
    }

    fn signal(&self, role: Role, times_s: &[f64]) -> Option<Signal> {
        channel_value(&self.parameters, 1.0, role, &State::default())
            .is_finite()
            .then(|| {
                let values = times_s
                    .iter()
                    .map(|t| {
                        let state = self.trajectory.at(self.start_tau + t * self.omega);
                        channel_value(&self.parameters, self.drive_amplitude, role, &state)
                    })
                    .collect();
                Signal {
                    time_s: times_s.to_vec(),
                    values,
                }
            })
    }
}

/// A simulator started so that it reaches the motion seen: at the first measured impact where
/// there is one, else from rest.
fn started(
    machine: &crate::model::params::Machine,
    setting: Setting,
    o: &Observation,
    parameters: &Parameters,
    amplitude: f64,
) -> Option<Simulator> {
    let rest = || Simulator::new(machine, setting, Initial::rest()).ok();
    let Some(impact) = o
        .impacts
        .iter()
        .find(|i| i.closing_speed_after_m_s.is_some())
    else {
        return rest();
    };
    let scale = parameters.static_deflection_m * amplitude * parameters.natural_rate();
    let after = impact.closing_speed_after_m_s? / scale;
    let phase = impact.drive_phase_rad?;
    let start = Setting { phase, ..setting };
    let initial = match machine.y {
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
    Simulator::new(machine, start, initial).ok().or_else(rest)
}

/// Whole drive periods by which the simulation has to be shifted so that its impacts fall where
/// the measured ones do (a motion of period n may be met in any of n drive periods).
fn cycle_shift(
    simulator: &mut Simulator,
    o: &Observation,
    drive: &DriveTone,
    window: &Window,
    setting: Setting,
) -> u32 {
    let Motion::Periodic { periods_n, .. } = o.finding.motion else {
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
        .map(|i| ((i.tau - begin) / setting.period(), i.closing_before))
        .collect();
    let measured: Vec<(f64, f64)> = o
        .impacts
        .iter()
        .filter_map(|i| {
            let turns = (i.time_s - window.start_s) / drive.period_s();
            Some((turns, i.closing_speed_before_m_s?))
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

fn traces(
    record: &Record,
    detection: &Detection,
    window: &Window,
    simulation: Option<&Simulation>,
) -> Vec<Trace> {
    let k = &detection.kinematics;
    let moving = [
        (
            Role::DisplacementX,
            Dimension::Length,
            k.x.displacement.as_ref(),
        ),
        (
            Role::DisplacementY,
            Dimension::Length,
            k.y.displacement.as_ref(),
        ),
        (
            Role::VelocityX,
            Dimension::Velocity,
            measured_velocity(&k.x),
        ),
        (
            Role::VelocityY,
            Dimension::Velocity,
            measured_velocity(&k.y),
        ),
    ];
    let mut out: Vec<Trace> = moving
        .into_iter()
        .filter_map(|(role, dimension, series)| {
            let measured = window.signal(&series?.values);
            Some(compared(role, dimension, measured, simulation))
        })
        .collect();
    for role in [Role::Contact, Role::FrameX, Role::FrameY] {
        if let Some(channel) = record.channel(role) {
            out.push(Trace {
                role,
                dimension: channel.dimension,
                measured: Some(window.signal(&channel.values)),
                simulated: None,
                residual: None,
            });
        }
    }
    out
}

fn measured_velocity(body: &Body) -> Option<&Series> {
    body.velocity.as_ref()
}

/// One channel beside its simulation; the measured constant part, which no channel knows, is set
/// so that both have the same mean.
fn compared(
    role: Role,
    dimension: Dimension,
    mut measured: Signal,
    simulation: Option<&Simulation>,
) -> Trace {
    let simulated = simulation.and_then(|s| s.signal(role, &measured.time_s));
    let residual = simulated.as_ref().map(|s| {
        let line = fitted_line(&measured, s);
        for (t, value) in measured.time_s.iter().zip(&mut measured.values) {
            *value -= line.0 + line.1 * t;
        }
        Signal {
            time_s: s.time_s.clone(),
            values: measured
                .values
                .iter()
                .zip(&s.values)
                .map(|(m, s)| m - s)
                .collect(),
        }
    });
    Trace {
        role,
        dimension,
        measured: Some(measured),
        simulated,
        residual,
    }
}

/// Offset and slope of measured − simulated over time, by least squares.
fn fitted_line(measured: &Signal, simulated: &Signal) -> (f64, f64) {
    let count = measured.values.len().max(1) as f64;
    let difference: Vec<f64> = measured
        .values
        .iter()
        .zip(&simulated.values)
        .map(|(m, s)| m - s)
        .collect();
    let mean_t = measured.time_s.iter().sum::<f64>() / count;
    let mean_d = difference.iter().sum::<f64>() / count;
    let (mut shear, mut spread) = (0.0, 0.0);
    for (t, d) in measured.time_s.iter().zip(&difference) {
        shear += (t - mean_t) * (d - mean_d);
        spread += (t - mean_t).powi(2);
    }
    let slope = if spread > 0.0 { shear / spread } else { 0.0 };
    (mean_d - slope * mean_t, slope)
}

fn portraits(traces: &[Trace]) -> Vec<Portrait> {
    [
        ("x", Role::DisplacementX, Role::VelocityX),
        ("y", Role::DisplacementY, Role::VelocityY),
    ]
    .into_iter()
    .filter_map(|(mass, displacement, velocity)| {
        let of = |role: Role| traces.iter().find(|t| t.role == role);
        let (d, v) = (of(displacement)?, of(velocity)?);
        let pair = |a: &Option<Signal>, b: &Option<Signal>| match (a, b) {
            (Some(a), Some(b)) => a
                .values
                .iter()
                .zip(&b.values)
                .map(|(x, y)| [*x, *y])
                .collect(),
            _ => Vec::new(),
        };
        Some(Portrait {
            mass: mass.to_owned(),
            measured: pair(&d.measured, &v.measured),
            simulated: pair(&d.simulated, &v.simulated),
        })
    })
    .collect()
}
