//! Chosen records beside their simulation with the fitted parameters.

use rayon::prelude::*;

use super::window::Window;
use super::{Gathered, rows};
use crate::event::detect::DetectSettings;
use crate::event::{Detection, detect};
use crate::identify::replay::{Replay, Stretch};
use crate::motion::{Motion, Observation};
use crate::record::{Record, Role};
use crate::report::content::{Comparison, Portrait, Signal, Trace};
use crate::signal::drift::fitted_line;
use crate::signal::robust::rms;
use labfiles::units::Dimension;

/// Residual over the signal below which the simulated motion is the measured one.
const SAME_MOTION: f64 = 0.05;
/// Drive periods that are drawn at least.
const SHOWN_PERIODS: u32 = 4;

/// Drive periods that are drawn of a motion without a period.
const IRREGULAR_PERIODS: u32 = 10;

/// The chosen records, lettered in their order; none for a record without a drive.
pub(super) fn comparisons(gathered: &Gathered) -> Vec<Comparison> {
    let letters: Vec<String> = ('A'..='Z').map(String::from).collect();
    let pairs = gathered.chosen.par_iter().zip(gathered.chosen_records);
    pairs
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
    let periods = match o.classification.motion {
        Motion::Periodic { periods_n, .. } => (2 * periods_n).max(SHOWN_PERIODS),
        Motion::Impactless => SHOWN_PERIODS,
        _ => IRREGULAR_PERIODS,
    };
    let window = Window::new(&detection, &drive, f64::from(periods));
    let stretch = Stretch {
        drive,
        start_s: window.start_s,
        length_s: window.length_s,
    };
    let simulation = gathered
        .parameters()
        .and_then(|fitted| Replay::of(gathered.campaign.rig, *fitted, o, &stretch));
    let (eta, rho) = rows::place(gathered, o);
    let traces = traces(record, &detection, &window, simulation.as_ref());
    let motion = &o.classification.motion;
    let simulated_motion = simulation.as_ref().map(|s| match apart(&traces) {
        apart if apart < SAME_MOTION => motion.clone(),
        _ => s.motion.clone(),
    });
    let note = note(motion, simulated_motion.as_ref());
    Some(Comparison {
        letter,
        record: o.record.clone(),
        eta,
        rho,
        drive_period_s: Some(drive.period_s()),
        motion: o.classification.motion.clone(),
        simulated_motion,
        portraits: portraits(&traces),
        traces,
        impacts_s: o
            .impacts
            .iter()
            .map(|i| i.time_s - window.start_s)
            .filter(|t| (0.0..window.length_s).contains(t))
            .collect(),
        simulated_impacts_s: simulation.map(|s| s.impacts_s).unwrap_or_default(),
        note,
    })
}

/// Greatest residual of a channel over its own size.
fn apart(traces: &[Trace]) -> f64 {
    let size = |signal: &Option<Signal>| Some(rms(&signal.as_ref()?.values));
    traces
        .iter()
        .filter_map(|t| Some(size(&t.residual)? / size(&t.measured)?))
        .fold(0.0, f64::max)
}

/// What is to be said of a simulated motion that is not the measured one.
fn note(measured: &Motion, simulated: Option<&Motion>) -> String {
    match simulated {
        Some(simulated) if simulated != measured && measured.is_periodic() => {
            "From none of the starts tried does the fitted model settle on the measured motion."
                .to_owned()
        }
        Some(_) if matches!(measured, Motion::Chaotic | Motion::Beat) => {
            "Two runs of such a motion part from each other: they are alike in kind, not in course."
                .to_owned()
        }
        _ => String::new(),
    }
}

fn traces(
    record: &Record,
    detection: &Detection,
    window: &Window,
    simulation: Option<&Replay>,
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
        (Role::VelocityX, Dimension::Velocity, k.x.velocity.as_ref()),
        (Role::VelocityY, Dimension::Velocity, k.y.velocity.as_ref()),
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

/// One channel beside its simulation. The measured constant part, which no channel knows, and its
/// slow drift are taken out: the straight line through measured less simulated.
fn compared(
    role: Role,
    dimension: Dimension,
    mut measured: Signal,
    simulation: Option<&Replay>,
) -> Trace {
    let simulated = simulation.and_then(|s| {
        let time_s = measured.time_s.clone();
        let values = s.values(role, &time_s)?;
        Some(Signal { time_s, values })
    });
    let residual = simulated.as_ref().map(|s| {
        let apart = difference(&measured.values, &s.values);
        let (offset, slope) = fitted_line(&measured.time_s, &apart);
        for (t, value) in measured.time_s.iter().zip(&mut measured.values) {
            *value -= offset + slope * t;
        }
        Signal {
            time_s: s.time_s.clone(),
            values: difference(&measured.values, &s.values),
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

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
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
