//! Whether the model fits each method's data, and the verdict in plain words.

use std::collections::BTreeMap;

use crate::identify::evidence::Evidence;
use crate::identify::evidence::impacts::ImpactBlock;
use crate::identify::evidence::resonance::{self, ResonanceBlock};
use crate::identify::evidence::trajectory::TrajectoryBlock;
use crate::identify::fit::Block;
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::identify::judgement::suspicion::Suspicion;
use crate::identify::{Agreement, Estimate, MethodResult, Status, Verdict, VerdictKind};
use crate::signal::robust;

/// Relative deviation of responses from which one degree of freedom does not fit.
const RESONANCE_DEVIATION: f64 = 0.15;
/// Relative deviation of waveforms from which the orbit does not fit.
const WAVEFORM_DEVIATION: f64 = 0.08;
/// Change of R over the measured speeds from which a constant R does not fit.
const RESTITUTION_CHANGE: f64 = 0.02;

/// Judge whether the impactless records are those of one degree of freedom for each mass.
pub fn judge_resonance(result: &mut MethodResult, block: &ResonanceBlock, fitted: &Parameters) {
    let mut deviations = Vec::new();
    for point in &block.points {
        for r in &point.responses {
            let model = resonance::predicted(
                fitted,
                block.rig,
                r.role,
                point.frequency_hz,
                point.drive_amplitude,
            );
            let apart = (r.real - model.re).hypot(r.imaginary - model.im);
            deviations.push(apart / model.norm().max(r.amplitude()));
        }
    }
    let deviation = robust::rms(&deviations);
    result.fits = Some(deviation < RESONANCE_DEVIATION);
    result.remarks.push(if deviation < RESONANCE_DEVIATION {
        format!(
            "the responses follow one degree of freedom within {:.2} %",
            100.0 * deviation
        )
    } else {
        format!(
            "the responses deviate by {:.0} % from the curve of one degree of freedom: there is \
             more than one resonance, or the damping is not viscous",
            100.0 * deviation
        )
    });
}

/// Judge whether the waveforms are those of the closed-form orbits.
pub fn judge_trajectories(result: &mut MethodResult, block: &TrajectoryBlock, fitted: &Parameters) {
    let mut ratios = Vec::new();
    for item in 0..block.items() {
        let Some(residuals) = block.residuals(item, fitted) else {
            continue;
        };
        let channels = &block.records[item].folded.channels;
        let (mut apart, mut whole, mut k) = (0.0, 0.0, 0);
        for channel in channels {
            let mean = robust::mean(&channel.points.iter().map(|p| p.value).collect::<Vec<_>>());
            for p in &channel.points {
                let weight = f64::from(p.samples) / channel.noise.powi(2);
                apart += residuals[k].powi(2);
                whole += weight * (p.value - mean).powi(2);
                k += 1;
            }
        }
        ratios.push((apart / whole.max(f64::MIN_POSITIVE)).sqrt());
    }
    let Some(deviation) = robust::median(&ratios) else {
        return;
    };
    result.fits = Some(deviation < WAVEFORM_DEVIATION);
    result.remarks.push(format!(
        "the simulated waveforms leave {:.2} % of the measured ones unexplained",
        100.0 * deviation
    ));
}

/// How R changes with the closing speed: a straight line through after/before over before,
/// weighted by the speed squared (the error of a ratio falls with it).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestitutionTrend {
    /// Slowest speed, m/s, and R there on the line.
    pub slow: (f64, f64),
    /// Fastest speed, m/s, and R there on the line.
    pub fast: (f64, f64),
    /// Slope over its standard error.
    pub z_score: f64,
}

/// Trend of R over the closing speed; `None` with fewer than fifteen impacts.
pub fn restitution_trend(block: &ImpactBlock) -> Option<RestitutionTrend> {
    let pairs = &block.pairs;
    if pairs.len() < 15 {
        return None;
    }
    let weight: f64 = pairs.iter().map(|p| p.before_m_s.powi(2)).sum();
    let mean = |f: &dyn Fn(f64, f64) -> f64| {
        let each = |p: &crate::identify::evidence::impacts::SpeedPair| {
            p.before_m_s.powi(2) * f(p.before_m_s, p.after_m_s / p.before_m_s)
        };
        pairs.iter().map(each).sum::<f64>() / weight
    };
    let (speed, ratio) = (mean(&|v, _| v), mean(&|_, r| r));
    let spread = mean(&|v, _| (v - speed).powi(2));
    let slope = mean(&|v, r| (v - speed) * (r - ratio)) / spread;
    let square = mean(&|v, r| (r - ratio - slope * (v - speed)).powi(2));
    let error = (square / spread / (pairs.len() - 2) as f64).sqrt();
    let at = |v: f64| (v, ratio + slope * (v - speed));
    let speeds = pairs.iter().map(|p| p.before_m_s);
    Some(RestitutionTrend {
        slow: at(speeds.clone().fold(f64::INFINITY, f64::min)),
        fast: at(speeds.fold(0.0, f64::max)),
        z_score: slope / error,
    })
}

/// Judge whether impacts are instantaneous with one R.
pub fn judge_impacts(result: &mut MethodResult, block: &ImpactBlock, evidence: &Evidence) {
    let used: std::collections::BTreeSet<usize> =
        block.pairs.iter().map(|p| p.observation).collect();
    let gaps: Vec<f64> = used
        .iter()
        .map(|i| evidence.observations[*i].jump_samples as f64)
        .collect();
    let gap = robust::median(&gaps).unwrap_or(1.0);
    let long = gap > 1.5;
    let Some(trend) = restitution_trend(block) else {
        return;
    };
    let change = trend.fast.1 - trend.slow.1;
    let changes = change.abs() > RESTITUTION_CHANGE && trend.z_score.abs() > 4.0;
    result.fits = Some(!changes);
    if !changes {
        result.remarks.push(format!(
            "R is the same from {:.3} to {:.3} m/s within {:.3}",
            trend.slow.0,
            trend.fast.0,
            change.abs().max(1e-3)
        ));
        return;
    }
    let speeds = format!(
        "R goes from {:.3} at {:.3} m/s to {:.3} at {:.3} m/s",
        trend.slow.1, trend.slow.0, trend.fast.1, trend.fast.0
    );
    result.remarks.push(if long {
        format!(
            "{speeds}, and a contact lasts {gap:.0} samples: it is not an instantaneous impact, \
             so one coefficient of restitution does not describe it"
        )
    } else {
        format!("{speeds}: R depends on the speed, one constant does not describe it")
    });
    if let Some(estimate) = &mut result.parameters.restitution {
        estimate.status = Status::Weak;
        estimate.note = Some("R is not one number here: see the remark on its change".into());
    }
}

/// What the verdict rests on.
pub struct Findings<'a> {
    /// The joint result.
    pub joint: &'a MethodResult,
    /// Each method.
    pub methods: &'a BTreeMap<String, MethodResult>,
    /// Their agreement.
    pub agreement: &'a Agreement,
    /// Mistakes of the laboratory that the data give away.
    pub suspicions: &'a [Suspicion],
}

/// One word and plain sentences.
pub fn verdict(found: &Findings) -> Verdict {
    let mut findings: Vec<String> = found.suspicions.iter().map(|s| s.message.clone()).collect();
    for (name, method) in found.methods {
        if method.fits == Some(false) {
            findings.extend(method.remarks.iter().map(|r| format!("{name}: {r}")));
        }
    }
    let misfit = found.methods.values().any(|m| m.fits == Some(false));
    let told: Vec<(Coordinate, &Estimate)> = Coordinate::PHYSICAL
        .into_iter()
        .filter_map(|c| Some((c, found.joint.parameters.get(c)?)))
        .collect();
    let unknown: Vec<Coordinate> = with_status(&told, Status::NotIdentifiable);
    let weak: Vec<Coordinate> = with_status(&told, Status::Weak);
    for (coordinate, estimate) in &told {
        if let Some(note) = &estimate.note {
            findings.push(format!("{}: {note}", coordinate.symbol()));
        }
    }
    if found.agreement.agree == Some(false) {
        findings.push(found.agreement.summary.clone());
    }
    let kind = if misfit {
        VerdictKind::DoesNotFit
    } else if told.is_empty() || !unknown.is_empty() {
        VerdictKind::NotIdentifiable
    } else if !weak.is_empty() {
        VerdictKind::Weak
    } else {
        VerdictKind::Identified
    };
    Verdict {
        kind,
        summary: sentences(kind, &told, &unknown, &weak, found),
        findings,
    }
}

fn with_status(told: &[(Coordinate, &Estimate)], status: Status) -> Vec<Coordinate> {
    told.iter()
        .filter(|(_, e)| e.status == status)
        .map(|(c, _)| *c)
        .collect()
}

fn symbols(coordinates: &[Coordinate]) -> String {
    coordinates
        .iter()
        .map(|c| c.symbol())
        .collect::<Vec<_>>()
        .join(", ")
}

fn sentences(
    kind: VerdictKind,
    told: &[(Coordinate, &Estimate)],
    unknown: &[Coordinate],
    weak: &[Coordinate],
    found: &Findings,
) -> String {
    let values: Vec<String> = told.iter().filter_map(|(c, e)| phrase(*c, e)).collect();
    let first = match kind {
        VerdictKind::DoesNotFit => {
            "The model does not describe these data: see the findings.".to_owned()
        }
        VerdictKind::NotIdentifiable if told.is_empty() => {
            "Nothing could be identified: no record is usable for any method.".to_owned()
        }
        VerdictKind::NotIdentifiable if values.is_empty() => {
            format!("These data cannot tell {}.", symbols(unknown))
        }
        VerdictKind::NotIdentifiable => format!(
            "The rig has {}, but these data cannot tell {}.",
            values.join(", "),
            symbols(unknown)
        ),
        VerdictKind::Weak => {
            format!(
                "The rig has {}; {} only weakly.",
                values.join(", "),
                symbols(weak)
            )
        }
        VerdictKind::Identified => format!("The rig has {}.", values.join(", ")),
    };
    let second = match found.agreement.agree {
        Some(true) => "The methods agree.",
        Some(false) => "The methods do not agree.",
        None => "Only one method tells each parameter.",
    };
    format!("{first} {second}")
}

fn phrase(coordinate: Coordinate, estimate: &Estimate) -> Option<String> {
    let (value, interval) = (estimate.value?, estimate.interval95?);
    let half = 0.5 * (interval[1] - interval[0]);
    let (scale, unit) = match coordinate {
        Coordinate::Frequency => (1.0, " Hz"),
        Coordinate::Deflection => (1e3, " mm"),
        _ => (1.0, ""),
    };
    let (value, half) = (value * scale, half * scale);
    let digits = (1.0 - half.max(1e-9).log10().floor()).clamp(0.0, 8.0) as usize;
    Some(format!(
        "{} = {value:.digits$} ± {half:.digits$}{unit}",
        coordinate.symbol()
    ))
}
