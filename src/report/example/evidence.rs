//! The example's evidence: comparisons, resonance, speeds, decays, residuals, profiles.

use std::f64::consts::TAU;

use super::oscillator::{self, State};
use super::{F0, Noise, TRUTH, X_ST};
use crate::record::Role;
use crate::report::content::*;
use crate::report::figures::marks;
use labfiles::units::Dimension;

pub fn fill(content: &mut ReportContent) {
    content.comparisons = comparisons(content);
    content.resonance = vec![resonance(content)];
    content.impacts = vec![impacts()];
    content.free_decays = (0..3).map(decay).collect();
    content.residuals = residuals(content);
    content.profiles = profiles();
    content.correlation = Some(correlation());
    content.left_out = vec![
        LeftOut { what: "records r0042, r0139 and 6 more".into(), why: "The motion had not settled when the record began; the type of motion is undetermined.".into(), count: Some(8) },
        LeftOut { what: "bracket at r = 1.64 mm, upward sweep".into(), why: "A disturbance made the motion jump before the saddle-node; the bracket is one-sided and lies more than 3 of its widths from the fit.".into(), count: Some(1) },
    ];
    content.settings_text = "[rig]\nnatural_frequency_hz = 12.6\ndamping_ratio = 0.07\n\n[channels.contact]\nchannel = \"contact\"\nthreshold = 2.5\nunit = \"V\"\n".into();
    content.command_line = "impactid run campaign.toml --out reports/example".into();
}

fn comparisons(content: &ReportContent) -> Vec<Comparison> {
    let met = marks::met(content.records.iter().map(|r| &r.motion));
    let shown = met
        .into_iter()
        .filter(|m| !matches!(m, crate::motion::Motion::Undetermined { .. }));
    let chosen = shown.filter_map(|m| {
        let all: Vec<_> = content.records.iter().filter(|r| r.motion == *m).collect();
        all.get(all.len() / 2).copied()
    });
    chosen
        .take(8)
        .zip('A'..)
        .map(|(r, letter)| comparison(r, letter))
        .collect()
}

/// Four settled drive periods of a record's motion: states and impacts.
fn settled(record: &RecordRow) -> (Vec<State>, Vec<oscillator::Hit>) {
    let at = (record.eta.unwrap_or(1.0), record.rho.unwrap_or(1.0));
    let start = if record.motion == crate::motion::Motion::Impactless {
        State::default()
    } else {
        State {
            x: 0.0,
            v: -6.0,
            phase: 3.0,
        }
    };
    let (end, _, _) = oscillator::march(&TRUTH, at, start, 120, 40);
    let end = State {
        phase: end.phase.rem_euclid(TAU),
        ..end
    };
    let whole = oscillator::flight(&TRUTH, at.0, end, (TAU - end.phase) / at.0);
    let whole = State {
        phase: 0.0,
        x: whole.x.min(at.1),
        ..whole
    };
    let (_, hits, samples) = oscillator::march(&TRUTH, at, whole, 4, 160);
    (samples, hits)
}

fn comparison(record: &RecordRow, letter: char) -> Comparison {
    let (samples, hits) = settled(record);
    let speed = record.eta.unwrap_or(1.0) * TAU * F0;
    let times: Vec<f64> = samples.iter().map(|s| s.phase / speed).collect();
    let hit_times: Vec<f64> = hits.iter().map(|h| h.phase / speed).collect();
    let traces = traces(&samples, &times, &hit_times, letter as u64);
    let portrait = |mass: &str, i: usize| Portrait {
        mass: mass.into(),
        measured: paired(&traces[i].measured, &traces[i + 2].measured),
        simulated: paired(&traces[i].simulated, &traces[i + 2].simulated),
    };
    let portraits = vec![portrait("x", 0), portrait("y", 1)];
    Comparison {
        letter: letter.to_string(),
        record: record.id.clone(),
        eta: record.eta,
        rho: record.rho,
        drive_period_s: Some(TAU / speed),
        motion: record.motion.clone(),
        simulated_motion: Some(record.motion.clone()),
        traces,
        portraits,
        impacts_s: hit_times.clone(),
        simulated_impacts_s: hit_times,
        note: String::new(),
    }
}

fn traces(samples: &[State], times: &[f64], hit_times: &[f64], seed: u64) -> Vec<Trace> {
    let x: Vec<f64> = samples.iter().map(|s| s.x * X_ST).collect();
    let v: Vec<f64> = samples.iter().map(|s| s.v * X_ST * TAU * F0).collect();
    let mut noise = Noise::new(seed);
    let mut noisy = |values: &[f64], gain: f64, sigma: f64| -> Vec<f64> {
        values
            .iter()
            .map(|v| gain * v + sigma * noise.gauss())
            .collect()
    };
    let is_closed = |t: &f64| hit_times.iter().any(|h| (t - h).abs() < 6e-4);
    let contact = times
        .iter()
        .map(|t| if is_closed(t) { 5.0 } else { 0.0 })
        .collect();
    let (length, velocity) = (Dimension::Length, Dimension::Velocity);
    vec![
        trace(
            Role::DisplacementX,
            length,
            times,
            &x,
            noisy(&x, 1.004, 6e-6),
        ),
        trace(
            Role::DisplacementY,
            length,
            times,
            &x,
            noisy(&x, 0.97, 6e-6),
        ),
        trace(
            Role::VelocityX,
            velocity,
            times,
            &v,
            noisy(&v, 1.003, 1.2e-3),
        ),
        trace(
            Role::VelocityY,
            velocity,
            times,
            &v,
            noisy(&v, 0.98, 1.2e-3),
        ),
        measured_alone(Role::Contact, Dimension::Voltage, times, contact),
        measured_alone(Role::FrameX, length, times, noisy(&x, 1.2e-3, 2e-7)),
    ]
}

fn measured_alone(role: Role, dimension: Dimension, times: &[f64], values: Vec<f64>) -> Trace {
    let measured = Some(Signal {
        time_s: times.to_vec(),
        values,
    });
    Trace {
        role,
        dimension,
        measured,
        simulated: None,
        residual: None,
    }
}

fn paired(x: &Option<Signal>, v: &Option<Signal>) -> Vec<[f64; 2]> {
    match (x, v) {
        (Some(x), Some(v)) => x
            .values
            .iter()
            .zip(&v.values)
            .map(|(x, v)| [*x, *v])
            .collect(),
        _ => Vec::new(),
    }
}

fn trace(
    role: Role,
    dimension: Dimension,
    times: &[f64],
    simulated: &[f64],
    measured: Vec<f64>,
) -> Trace {
    let residual = measured.iter().zip(simulated).map(|(m, s)| m - s).collect();
    let signal = |values| {
        Some(Signal {
            time_s: times.to_vec(),
            values,
        })
    };
    Trace {
        role,
        dimension,
        measured: signal(measured),
        simulated: signal(simulated.to_vec()),
        residual: signal(residual),
    }
}

fn resonance(content: &ReportContent) -> ResonanceCurve {
    let mut noise = Noise::new(5);
    let curve = |f: f64| {
        let eta = f / F0;
        let phase = (2.0 * TRUTH.damping * eta).atan2(1.0 - eta * eta);
        [f, X_ST * oscillator::grazing(&TRUTH, eta), phase]
    };
    let impactless = content
        .records
        .iter()
        .filter(|r| r.motion == crate::motion::Motion::Impactless);
    let points = impactless.enumerate().map(|(i, r)| {
        let [f, a, phase] = curve(r.frequency_hz.unwrap_or(F0));
        let error = 0.01 * a + 2e-6;
        ResonancePoint {
            record: r.id.clone(),
            frequency_hz: f,
            amplitude: a + error * noise.gauss(),
            amplitude_error: Some(error),
            phase_rad: Some(phase + 0.01 * noise.gauss()),
            phase_error_rad: Some(0.01),
            used: i % 23 != 7,
        }
    });
    ResonanceCurve {
        name: String::new(),
        dimension: Dimension::Length,
        unit: None,
        points: points.collect(),
        fitted: (0..=200)
            .map(|i| curve(9.8 + 28.0 * f64::from(i) / 200.0))
            .collect(),
        fits: Some(true),
        note: String::new(),
    }
}

fn impacts() -> ImpactScatter {
    let mut noise = Noise::new(11);
    let points = (0..5310).map(|i| {
        let before = 0.03 + 0.39 * (0.5 + 0.5 * noise.next());
        ImpactPoint {
            record: format!("r{:04}", i / 13 + 1),
            before_m_s: before,
            after_m_s: 0.9 * before + 0.004 * noise.gauss(),
            error_m_s: Some(0.004),
            used: before > 0.05,
        }
    });
    ImpactScatter {
        points: points.collect(),
        restitution: Some(0.9012),
        interval95: Some([0.8975, 0.9049]),
        ..ImpactScatter::default()
    }
}

pub fn decay(index: u64) -> FreeDecay {
    let mut noise = Noise::new(31 + index);
    let (f, beta) = (F0 * (1.0 + 0.1 * index as f64), 0.02 + 0.002 * index as f64);
    let at = |t: f64| 3.0 * (-beta * TAU * f * t).exp() * (TAU * f * t).cos();
    let times: Vec<f64> = (0..1600).map(|i| f64::from(i) / 800.0).collect();
    FreeDecay {
        record: format!("test1-{}", index + 1),
        dimension: Dimension::Acceleration,
        measured: Signal {
            values: times
                .iter()
                .map(|t| at(*t) + 0.03 * noise.gauss())
                .collect(),
            time_s: times.clone(),
        },
        fitted: Some(Signal {
            values: times.iter().map(|t| at(*t)).collect(),
            time_s: times,
        }),
        natural_frequency_hz: Some(f),
        natural_frequency_error_hz: Some(0.002),
        damping_ratio: Some(beta),
        damping_ratio_error: Some(0.0001),
        note: String::new(),
    }
}

fn residuals(content: &ReportContent) -> Vec<ResidualSet> {
    let mut noise = Noise::new(77);
    let mut set = |method: &str, every: usize| {
        let points = content
            .records
            .iter()
            .step_by(every)
            .map(|r| ResidualPoint {
                record: r.id.clone(),
                residual: noise.gauss(),
                frequency_hz: r.frequency_hz,
                clearance_m: r.clearance_m,
            });
        ResidualSet {
            method: method.into(),
            total: 0,
            points: points.collect(),
            autocorrelation: (0..25)
                .map(|k| if k == 0 { 1.0 } else { 0.05 * noise.next() })
                .collect(),
            note: "No trend with frequency or gap; the scatter is as the stated noise.".into(),
        }
    };
    vec![
        set("trajectories", 1),
        set("resonance", 3),
        set("boundaries", 25),
    ]
}

fn profiles() -> Vec<Profile> {
    let parameters = [
        ("restitution", 0.9005, 0.0009),
        ("natural_frequency_hz", 12.5996, 0.0018),
        ("damping_ratio", 0.0702, 0.0003),
        ("static_deflection_m", 1.2503e-3, 2.4e-6),
    ];
    let profile = |(name, best, error): (&str, f64, f64)| {
        let values: Vec<f64> = (-20..=20)
            .map(|i| best + 0.17 * f64::from(i) * error)
            .collect();
        Profile {
            parameter: name.into(),
            method: String::new(),
            delta_chi2: values
                .iter()
                .map(|v| ((v - best) / error).powi(2) * (1.0 + 0.05 * (v - best) / error))
                .collect(),
            values,
            best: Some(best),
            interval95: Some([best - 1.96 * error, best + 1.96 * error]),
        }
    };
    parameters.into_iter().map(profile).collect()
}

fn correlation() -> Correlation {
    let names = [
        "restitution",
        "natural_frequency_hz",
        "damping_ratio",
        "static_deflection_m",
    ];
    Correlation {
        parameters: names.map(String::from).to_vec(),
        matrix: vec![
            vec![1.0, 0.22, -0.41, 0.63],
            vec![0.22, 1.0, 0.08, -0.35],
            vec![-0.41, 0.08, 1.0, 0.71],
            vec![0.63, -0.35, 0.71, 1.0],
        ],
    }
}
