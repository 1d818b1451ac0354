//! Whether the model fits each method's data, and the verdict in plain words.

use std::collections::{BTreeMap, BTreeSet};

use crate::identify::estimate::NORMAL_975;
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

/// Judge by the contact law whether impacts are instantaneous with one R; the records of the impacts
/// that it rests on say how long a contact lasts.
pub fn judge_impacts(result: &mut MethodResult, block: &ImpactBlock, evidence: &Evidence) {
    let Some(law) = &result.contact_law else {
        return;
    };
    let (Some([a, b]), [Some(slow), Some(fast)]) =
        (law.extremes(), [law.curve.first(), law.curve.last()])
    else {
        return;
    };
    let change = (a.restitution - b.restitution).abs();
    let changes = law.is_not_constant() && change > RESTITUTION_CHANGE;
    let speeds = match changes {
        true => format!(
            "R goes from {:.3} at {:.3} m/s to {:.3} at {:.3} m/s",
            a.restitution, a.speed_m_s, b.restitution, b.speed_m_s
        ),
        false => format!(
            "R is the same from {:.3} to {:.3} m/s within {:.3}",
            slow.speed_m_s,
            fast.speed_m_s,
            change.max(NORMAL_975 * a.standard_error).max(1e-3)
        ),
    };
    result.fits = Some(!changes);
    if !changes {
        result.remarks.push(speeds);
        return;
    }
    let samples = contact_samples(block, evidence);
    result.remarks.push(if samples > 1.5 {
        format!(
            "{speeds}, and a contact lasts {samples:.0} samples: it is not an instantaneous \
             impact, so one coefficient of restitution does not describe it"
        )
    } else {
        format!("{speeds}: R depends on the speed, one constant does not describe it")
    });
    if let Some(estimate) = &mut result.parameters.restitution {
        estimate.status = Status::Weak;
        estimate.note = Some("R is not one number here: see the remark on its change".into());
    }
}

/// Samples over which a velocity jumps at the impacts, in the median record.
fn contact_samples(block: &ImpactBlock, evidence: &Evidence) -> f64 {
    let used: BTreeSet<usize> = block.pairs.iter().map(|p| p.observation).collect();
    let samples: Vec<f64> = used
        .into_iter()
        .map(|i| evidence.observations[i].jump_samples as f64)
        .collect();
    robust::median(&samples).unwrap_or(1.0)
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
