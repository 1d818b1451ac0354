//! Periodic records z = 1/n against the closed-form periodic orbit.

use rayon::prelude::*;

use crate::event::Rig;
use crate::identify::parameters::{Coordinate, Parameters, gain_index};
use crate::identify::shared_error::Whitening;
use crate::identify::solver::{Block, difference};
use crate::identify::waveform::{Phases, Waveform};
use crate::model::flight::State;
use crate::model::orbit::{Branch, Orbit, unjudged_orbit};
use crate::motion::Observation;
use crate::motion::fold::{Folded, FoldedChannel};
use crate::record::Role;

/// One folded record.
#[derive(Debug, Clone)]
pub struct TrajectoryRecord {
    /// Index among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// The folded waveform.
    pub folded: Folded,
    /// Phases of the points: usually one set that all channels share.
    pub phases: Vec<Phases>,
    /// Median closing speed before impacts as measured, m/s.
    pub closing_speed_m_s: f64,
    /// Standard error of the drive's frequency, relative.
    pub frequency_error: f64,
    /// Standard error of the drive's phase, rad.
    pub phase_error_rad: f64,
    /// Changes of all points' values, SI, by one standard error of phase and of frequency; empty
    /// until they are found at good parameters.
    pub shared: Vec<Vec<f64>>,
}

/// All periodic records with one impact in n drive periods.
#[derive(Debug, Clone)]
pub struct TrajectoryBlock {
    /// One or two masses.
    pub rig: Rig,
    /// The records.
    pub records: Vec<TrajectoryRecord>,
    /// Relative error added to every point: what instruments and model leave open.
    pub relative_error: f64,
}

impl TrajectoryBlock {
    /// Collect the records that may be used.
    pub fn new(rig: Rig, observations: &[Observation], relative_error: f64) -> Self {
        let records = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| !o.excluded() && o.finding.confidence >= 0.7)
            .filter_map(|(i, o)| trajectory_record(i, o))
            .collect();
        Self {
            rig,
            records,
            relative_error,
        }
    }

    /// Whether any channel of a gain's index is present.
    pub fn has_gain(&self, index: usize) -> bool {
        let mut roles = self
            .records
            .iter()
            .flat_map(|r| &r.folded.channels)
            .map(|c| c.role);
        roles.any(|r| gain_index(r) == Some(index))
    }

    /// The orbit of a record at given parameters: the one whose closing speed is nearer to the
    /// measured one; `None` beyond the saddle-node.
    pub fn orbit(&self, item: usize, parameters: &Parameters) -> Option<Orbit> {
        self.orbit_of(&self.records[item], parameters)
    }

    fn orbit_of(&self, record: &TrajectoryRecord, parameters: &Parameters) -> Option<Orbit> {
        let machine = parameters.machine(self.rig);
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
        let speed = speeds
            .into_iter()
            .filter(|w| *w > 0.0)
            .min_by(|a, b| (a - measured).abs().total_cmp(&(b - measured).abs()))?;
        Some(unjudged_orbit(&machine, setting, n, speed))
    }

    /// Find at good parameters what phase and frequency of the drive change in every record.
    pub fn find_shared_errors(&mut self, parameters: &Parameters) {
        let changes: Vec<Option<Vec<Vec<f64>>>> = self
            .records
            .par_iter()
            .map(|record| self.shared_changes(record, parameters))
            .collect();
        for (record, change) in self.records.iter_mut().zip(changes) {
            record.shared = change.unwrap_or_default();
        }
    }

    fn shared_changes(
        &self,
        record: &TrajectoryRecord,
        parameters: &Parameters,
    ) -> Option<Vec<Vec<f64>>> {
        let slope = |above: Vec<f64>, below: Vec<f64>, error: f64| -> Vec<f64> {
            let factor = error / (2.0 * STEP);
            above
                .iter()
                .zip(&below)
                .map(|(a, b)| (a - b) * factor)
                .collect()
        };
        let turned = |by: f64| self.values(record, parameters, by);
        let shifted = |by: f64| {
            let moved = TrajectoryRecord {
                frequency_hz: record.frequency_hz * (1.0 + by),
                ..record.clone()
            };
            self.values(&moved, parameters, 0.0)
        };
        Some(vec![
            slope(turned(STEP)?, turned(-STEP)?, record.phase_error_rad),
            slope(shifted(STEP)?, shifted(-STEP)?, record.frequency_error),
        ])
    }

    /// The model's values at all points of a record, channel after channel, SI, with the drive's
    /// phase turned by an angle; `None` where there is no orbit.
    fn values(
        &self,
        record: &TrajectoryRecord,
        parameters: &Parameters,
        turn_rad: f64,
    ) -> Option<Vec<f64>> {
        let orbit = self.orbit_of(record, parameters)?;
        let phase = phase_on_fold(&orbit, &record.folded) + turn_rad;
        let paths = [&orbit.paths().x, &orbit.paths().y];
        let waves: Vec<[Option<Waveform>; 2]> = record
            .phases
            .iter()
            .map(|phases| {
                [false, true].map(|of_y| {
                    let seen = record
                        .folded
                        .channels
                        .iter()
                        .any(|c| c.role.is_of_y() == of_y);
                    seen.then(|| Waveform::new(&orbit, paths[usize::from(of_y)], phases, phase))
                })
            })
            .collect();
        let mut out = Vec::new();
        for channel in &record.folded.channels {
            let set = record.phases.iter().position(|p| p.fit(&channel.points))?;
            let wave = waves[set][usize::from(channel.role.is_of_y())].as_ref()?;
            let (unit, values) =
                channel_unit(parameters, record.drive_amplitude, channel.role, wave);
            out.extend(values.iter().map(|v| unit * v));
        }
        Some(out)
    }
}

/// SI units of a channel, gain included, in one of the model's, and its values in the model's.
fn channel_unit<'w>(
    parameters: &Parameters,
    drive_amplitude: f64,
    role: Role,
    wave: &'w Waveform,
) -> (f64, &'w [f64]) {
    let length = parameters.static_deflection_m * drive_amplitude * parameters.gain(role);
    match role {
        Role::VelocityX | Role::VelocityY => (length * parameters.natural_rate(), &wave.velocity),
        _ => (length, &wave.displacement),
    }
}

/// Step of the differences that give slopes over phase and relative frequency.
const STEP: f64 = 1e-6;

fn trajectory_record(index: usize, o: &Observation) -> Option<TrajectoryRecord> {
    let drive = o.drive?;
    let folded = o.folded.clone()?;
    let speeds: Vec<f64> = o
        .impacts
        .iter()
        .filter_map(|i| i.closing_speed_before_m_s)
        .collect();
    Some(TrajectoryRecord {
        observation: index,
        frequency_hz: drive.frequency_hz,
        frequency_error: drive.frequency_error_hz / drive.frequency_hz,
        phase_error_rad: o.drive_phase_error_rad(),
        shared: Vec::new(),
        clearance_m: o.setting.clearance_m?,
        drive_amplitude: o.setting.drive_amplitude,
        phases: distinct_phases(&folded),
        folded,
        closing_speed_m_s: crate::signal::robust::median(&speeds)?,
    })
}

/// The sets of phases that a record's channels have, each once.
pub fn distinct_phases(folded: &Folded) -> Vec<Phases> {
    let mut all: Vec<Phases> = Vec::new();
    for channel in &folded.channels {
        if !all.iter().any(|p| p.fit(&channel.points)) {
            all.push(Phases::of(&channel.points));
        }
    }
    all
}

/// Value of a motion channel in a state, SI, gain included.
pub fn channel_value(
    parameters: &Parameters,
    drive_amplitude: f64,
    role: Role,
    state: &State,
) -> f64 {
    let length = parameters.static_deflection_m * drive_amplitude;
    let speed = length * parameters.natural_rate();
    let value = match role {
        Role::VelocityX => state.vx * speed,
        Role::VelocityY => state.vy * speed,
        Role::DisplacementX => state.x * length,
        Role::DisplacementY => state.y * length,
        _ => f64::NAN,
    };
    value * parameters.gain(role)
}

/// The orbit's impact phase on the fold's axis: whole turns put it next to the measured one.
pub fn phase_on_fold(orbit: &Orbit, folded: &Folded) -> f64 {
    let measured = folded.impact_phase_rad.unwrap_or(orbit.phase_at_impact);
    let turns = ((measured - orbit.phase_at_impact) / std::f64::consts::TAU).round();
    orbit.phase_at_impact + turns * std::f64::consts::TAU
}

impl Block for TrajectoryBlock {
    fn items(&self) -> usize {
        self.records.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let record = &self.records[item];
        let values = self.values(record, parameters, 0.0)?;
        let weighing = Weighing::new(record, &values, self.relative_error);
        Some(weighing.weighted(&weighing.apart(&values)))
    }

    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let record = &self.records[item];
        let values = self.values(record, parameters, 0.0)?;
        let weighing = Weighing::new(record, &values, self.relative_error);
        let columns = coordinates
            .iter()
            .map(|coordinate| {
                let change = match coordinate {
                    // Values are proportional to their gain.
                    Coordinate::Gain(gain) => weighing.only(&values, *gain),
                    _ => difference(parameters, *coordinate, &values, |p| {
                        self.values(record, p, 0.0)
                    })?,
                };
                let falling: Vec<f64> = change.iter().map(|c| -c).collect();
                Some(weighing.weighted(&falling))
            })
            .collect::<Option<Vec<_>>>()?;
        Some((weighing.weighted(&weighing.apart(&values)), columns))
    }

    fn touches(&self, _coordinate: Coordinate) -> bool {
        true
    }
}

/// How a record's residuals are weighted at given parameters: by the errors of the points, the
/// channels' offsets projected out, the errors that all points share made independent.
struct Weighing<'a> {
    record: &'a TrajectoryRecord,
    channels: Vec<Weights>,
    shared: Whitening,
}

impl<'a> Weighing<'a> {
    fn new(record: &'a TrajectoryRecord, values: &[f64], relative_error: f64) -> Self {
        let mut channels = Vec::with_capacity(record.folded.channels.len());
        let mut rest = values;
        for channel in &record.folded.channels {
            let (own, others) = rest.split_at(channel.points.len());
            channels.push(Weights::of(channel, own, relative_error));
            rest = others;
        }
        let mut weighing = Self {
            record,
            channels,
            shared: Whitening::none(),
        };
        let columns: Vec<Vec<f64>> = record.shared.iter().map(|c| weighing.centred(c)).collect();
        weighing.shared = Whitening::new(columns);
        weighing
    }

    /// Measured less modelled values.
    fn apart(&self, values: &[f64]) -> Vec<f64> {
        let points = self.record.folded.channels.iter().flat_map(|c| &c.points);
        points.zip(values).map(|(p, v)| p.value - v).collect()
    }

    /// Values of the channels that carry one gain, zero for the others.
    fn only(&self, values: &[f64], gain: usize) -> Vec<f64> {
        let mut out = Vec::with_capacity(values.len());
        for channel in &self.record.folded.channels {
            let range = out.len()..out.len() + channel.points.len();
            if gain_index(channel.role) == Some(gain) {
                out.extend_from_slice(&values[range]);
            } else {
                out.resize(range.end, 0.0);
            }
        }
        out
    }

    fn centred(&self, differences: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(differences.len());
        for weights in &self.channels {
            let end = out.len() + weights.roots.len();
            weights.centred(&differences[out.len()..end], &mut out);
        }
        out
    }

    fn weighted(&self, differences: &[f64]) -> Vec<f64> {
        let mut out = self.centred(differences);
        self.shared.apply(&mut out);
        out
    }
}

/// Weights of a channel's points, with the channel's offset, a nuisance, projected out.
struct Weights {
    roots: Vec<f64>,
    total: f64,
}

impl Weights {
    fn of(channel: &FoldedChannel, model: &[f64], relative_error: f64) -> Self {
        let scale = relative_error * crate::signal::robust::rms(model);
        let roots: Vec<f64> = channel
            .points
            .iter()
            .map(|p| {
                let variance = channel.noise.powi(2) / f64::from(p.samples.max(1)) + scale * scale;
                1.0 / variance.sqrt()
            })
            .collect();
        let total: f64 = roots.iter().map(|w| w * w).sum();
        Self {
            roots,
            total: total.max(f64::MIN_POSITIVE),
        }
    }

    /// Differences less their weighted mean, times the roots of the weights.
    fn centred(&self, differences: &[f64], out: &mut Vec<f64>) {
        let pairs = || differences.iter().zip(&self.roots);
        let offset = pairs().map(|(d, w)| d * w * w).sum::<f64>() / self.total;
        out.extend(pairs().map(|(d, w)| (d - offset) * w));
    }
}
