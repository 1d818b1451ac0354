//! Chosen records beside their simulation with the fitted parameters.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::input::{Input, place};
use crate::event::DetectSettings;
use crate::event::{Detection, DriveTone, detect};
use crate::identify::fit::parameters::Parameters;
use crate::identify::replay::{Replay, Stretch};
use crate::motion::{Motion, Observation};
use crate::record::{Record, Role};
use crate::signal::drift::fitted_line;
use crate::signal::robust::rms;
use crate::signal::whole;
use labfiles::units::Dimension;

/// A sampled signal on its own time axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Signal {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Values, SI, one per time.
    pub values: Vec<f64>,
}

/// One channel of a comparison: measured, simulated, and their difference.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// What the channel measures.
    pub role: Role,
    /// Its dimension, hence its SI unit.
    pub dimension: Dimension,
    /// As measured.
    pub measured: Signal,
    /// As simulated, if the model has it.
    pub simulated: Option<Signal>,
    /// Measured less simulated.
    pub residual: Option<Signal>,
}

/// A record compared with its simulation, from a zero phase of the drive on.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The point's letter in the map, `A`, `B` …
    pub letter: char,
    /// The record's name.
    pub record: String,
    /// η, if f0 is known.
    pub eta: Option<f64>,
    /// ρ, if `x_st` is known.
    pub rho: Option<f64>,
    /// Drive period, s.
    pub drive_period_s: f64,
    /// Motion found in the record.
    pub motion: Motion,
    /// Motion of the simulation with the fitted parameters.
    pub simulated_motion: Option<Motion>,
    /// The channels.
    pub traces: Vec<Trace>,
    /// Times of the measured impacts, s on the traces' axis.
    pub impacts_s: Vec<f64>,
    /// Times of the simulated impacts, s on the traces' axis.
    pub simulated_impacts_s: Vec<f64>,
}

/// Most comparisons of one campaign.
const MOST_COMPARISONS: usize = 8;
/// Records of a higher confidence differ in their noise alone.
const SURE: f64 = 0.95;
/// Residual over the signal below which the simulated motion is the measured one.
const SAME_MOTION: f64 = 0.05;
/// Drive periods that are shown at least.
const SHOWN_PERIODS: u32 = 4;
/// Drive periods that are shown of a motion without a period.
const IRREGULAR_PERIODS: u32 = 10;

/// Indices of the records to compare: those named, else the surest of each type of motion of the
/// campaign, periodic motions with impacts first.
pub(super) fn chosen_records(input: &Input<'_>) -> Vec<usize> {
    let observations = input.observations;
    let find = |name: &String| observations.iter().position(|o| o.record == *name);
    let by_name: Vec<usize> = input.points.iter().filter_map(find).collect();
    if !by_name.is_empty() {
        return by_name;
    }
    let mut best: BTreeMap<(u8, String), usize> = BTreeMap::new();
    for (i, o) in observations.iter().enumerate() {
        let rank = match &o.classification.motion {
            _ if o.excluded() || o.drive.is_none() => continue,
            Motion::Periodic { .. } => 0,
            Motion::Impactless => 1,
            Motion::Beat | Motion::Chaotic => 2,
            _ => continue,
        };
        let key = (rank, o.classification.motion.label());
        let better = |k: &usize| quality(o) > quality(&observations[*k]);
        if best.get(&key).is_none_or(better) {
            best.insert(key, i);
        }
    }
    best.into_values().take(MOST_COMPARISONS).collect()
}

/// Confidence first, then the strength of the motion over its noise.
fn quality(o: &Observation) -> f64 {
    let noise = o.classification.evidence.noise_ratio.unwrap_or(1.0);
    o.classification.confidence.min(SURE) - noise
}

/// The chosen records with letters in their order; none for a record without a drive.
pub(super) fn comparisons(input: &Input<'_>, chosen: &[usize]) -> Vec<Comparison> {
    let letters: Vec<char> = ('A'..='Z').collect();
    let lettered = chosen.par_iter().zip(letters);
    lettered
        .filter_map(|(i, letter)| {
            let o = &input.observations[*i];
            comparison(input, o, &(input.read)(*i)?, (letter, input.parameters()))
        })
        .collect()
}

/// A record beside its simulation with parameters; `None` without a drive.
pub(super) fn comparison(
    input: &Input<'_>,
    o: &Observation,
    record: &Record,
    (letter, parameters): (char, Option<&Parameters>),
) -> Option<Comparison> {
    let drive = o.drive?;
    let detection = detect(record, input.rig, &DetectSettings::default());
    let periods = match o.classification.motion {
        Motion::Periodic { periods_n, .. } => (2 * periods_n).max(SHOWN_PERIODS),
        Motion::Impactless => SHOWN_PERIODS,
        _ => IRREGULAR_PERIODS,
    };
    let stretch = stretch(drive, periods);
    let simulation = parameters.and_then(|p| Replay::of(input.rig, *p, o, &stretch));
    let (eta, rho) = parameters.map_or((None, None), |p| place(p, o));
    let traces = traces(record, &detection, &stretch, simulation.as_ref());
    let motion = &o.classification.motion;
    let simulated_motion = simulation.as_ref().map(|s| {
        let same = largest_residual(&traces) < SAME_MOTION;
        if same { motion } else { &s.motion }.clone()
    });
    let impacts = o.impacts.iter().map(|i| i.time_s - stretch.start_s);
    Some(Comparison {
        letter,
        record: o.record.clone(),
        eta,
        rho,
        drive_period_s: drive.period_s(),
        motion: motion.clone(),
        simulated_motion,
        traces,
        impacts_s: impacts
            .filter(|t| (0.0..stretch.length_s).contains(t))
            .collect(),
        simulated_impacts_s: simulation.map(|s| s.impacts_s).unwrap_or_default(),
    })
}

/// The stretch of a record that is shown: from the first zero phase of its drive.
fn stretch(drive: DriveTone, periods: u32) -> Stretch {
    let period_s = drive.period_s();
    Stretch {
        drive,
        start_s: period_s * (1.0 - drive.phase_at(0.0) / std::f64::consts::TAU),
        length_s: f64::from(periods) * period_s,
    }
}

/// The samples of a stretch, their time counted from its start.
fn cut(values: &[f64], rate_hz: f64, stretch: &Stretch) -> Signal {
    let first = whole::index((stretch.start_s * rate_hz).ceil());
    let end = whole::index(((stretch.start_s + stretch.length_s) * rate_hz).floor()) + 1;
    let range = first.min(values.len())..end.min(values.len());
    let time_s = range.clone().map(|i| i as f64 / rate_hz - stretch.start_s);
    Signal {
        time_s: time_s.collect(),
        values: values[range].to_vec(),
    }
}

/// Greatest residual of a channel over its own size.
fn largest_residual(traces: &[Trace]) -> f64 {
    let ratios = traces.iter().filter_map(|t| {
        let residual = t.residual.as_ref()?;
        Some(rms(&residual.values) / rms(&t.measured.values))
    });
    ratios.fold(0.0, f64::max)
}

fn traces(
    record: &Record,
    detection: &Detection,
    stretch: &Stretch,
    simulation: Option<&Replay>,
) -> Vec<Trace> {
    let k = &detection.kinematics;
    let (length, velocity) = (Dimension::Length, Dimension::Velocity);
    let moving = [
        (Role::DisplacementX, length, &k.x.displacement),
        (Role::DisplacementY, length, &k.y.displacement),
        (Role::VelocityX, velocity, &k.x.velocity),
        (Role::VelocityY, velocity, &k.y.velocity),
    ];
    let compared = moving.into_iter().filter_map(|(role, dimension, series)| {
        let measured = cut(&series.as_ref()?.values, k.rate_hz, stretch);
        Some(compared(role, dimension, measured, simulation))
    });
    let others = [Role::Contact, Role::FrameX, Role::FrameY].into_iter();
    let measured_alone = others.filter_map(|role| {
        let channel = record.channel(role)?;
        Some(Trace {
            role,
            dimension: channel.dimension,
            measured: cut(&channel.values, record.sample_rate_hz, stretch),
            simulated: None,
            residual: None,
        })
    });
    compared.chain(measured_alone).collect()
}

/// One channel beside its simulation. Its constant part, which no channel measures, and its slow
/// drift are taken out: the straight line through measured less simulated.
fn compared(
    role: Role,
    dimension: Dimension,
    mut measured: Signal,
    simulation: Option<&Replay>,
) -> Trace {
    let simulated = simulation.and_then(|s| s.values(role, &measured.time_s));
    let signal = |values| Signal {
        time_s: measured.time_s.clone(),
        values,
    };
    let residual = simulated.as_ref().map(|simulated| {
        let (offset, slope) =
            fitted_line(&measured.time_s, &difference(&measured.values, simulated));
        for (t, value) in measured.time_s.iter().zip(&mut measured.values) {
            *value -= offset + slope * t;
        }
        difference(&measured.values, simulated)
    });
    Trace {
        role,
        dimension,
        simulated: simulated.map(signal),
        residual: residual.map(signal),
        measured,
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(samples: usize) -> Vec<f64> {
        (0..samples).map(|i| i as f64).collect()
    }

    fn drive(phase_rad: f64) -> DriveTone {
        DriveTone {
            frequency_hz: 10.0,
            frequency_error_hz: 0.0,
            phase_rad,
            amplitude: 1.0,
            residual_ratio: 0.0,
        }
    }

    #[test]
    fn a_stretch_begins_at_a_zero_phase_of_the_drive() {
        // a quarter of a period has passed at the first sample: three quarters to go
        let quarter = stretch(drive(0.25 * std::f64::consts::TAU), 2);
        assert!((quarter.start_s - 0.075).abs() < 1e-12);
        assert!((quarter.length_s - 0.2).abs() < 1e-12);
        // 75.075 and 275.275 samples
        let cut = cut(&ramp(400), 1001.0, &quarter);
        assert_eq!((cut.values[0], cut.values.len()), (76.0, 200));
        assert!((cut.time_s[0] - 0.925 / 1001.0).abs() < 1e-12);
    }

    #[test]
    fn a_stretch_ends_with_its_record() {
        let whole = stretch(drive(0.0), 4);
        let cut = cut(&ramp(250), 1000.0, &whole);
        assert_eq!((cut.values[0], cut.values.len()), (100.0, 150));
    }

    #[test]
    fn the_largest_residual_counts_relative_to_its_own_channel() {
        let trace = |measured: f64, residual: Option<f64>| {
            let signal = |v| Signal {
                time_s: vec![0.0, 1.0],
                values: vec![v, -v],
            };
            Trace {
                role: Role::VelocityX,
                dimension: Dimension::Velocity,
                measured: signal(measured),
                simulated: None,
                residual: residual.map(signal),
            }
        };
        let traces = [
            trace(2.0, Some(0.1)),
            trace(0.1, Some(0.02)),
            trace(1.0, None),
        ];
        assert!((largest_residual(&traces) - 0.2).abs() < 1e-12);
        assert_eq!(largest_residual(&traces[2..]), 0.0);
    }
}
