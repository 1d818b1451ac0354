//! Other kinds of campaign: free decays alone, a cart on a stop, data that do not tell.

use super::*;
use labfiles::units::Dimension;

fn unknown(note: Note) -> Option<Estimate> {
    Some(Estimate {
        value: None,
        standard_error: None,
        interval95: None,
        status: Status::NotIdentifiable,
        note: Some(note),
    })
}

fn bare(kind: VerdictKind, sentence: Sentence) -> Identification {
    let mut id = identification();
    id.verdict = Verdict {
        kind,
        sentences: vec![sentence],
        findings: vec![],
    };
    id.methods.clear();
    id.agreement = Agreement::default();
    id.joint = MethodResult::default();
    id
}

/// Nine free decays and nothing else.
pub fn decays_only() -> ReportContent {
    let mut id = bare(VerdictKind::Weak, Sentence::Specimens { count: 4 });
    for (i, name) in ["mass 1", "mass 2", "mass 3", "mass 4"]
        .into_iter()
        .enumerate()
    {
        let joint = MethodResult {
            parameters: ParameterSet {
                restitution: unknown(Note::NothingToFit),
                natural_frequency_hz: estimate(11.2 + 3.1 * i as f64, 0.004),
                damping_ratio: estimate(0.0138 + 0.002 * i as f64, 0.0002),
                static_deflection_m: None,
            },
            records: 3,
            observations: 4_800,
            reduced_residual: Some(1.3),
            fits: Some(i < 2),
            ..MethodResult::default()
        };
        let kind = if i < 2 {
            VerdictKind::Weak
        } else {
            VerdictKind::DoesNotFit
        };
        let sentence = if i < 2 {
            Sentence::Weak {
                values: Vec::new(),
                parameters: vec![Coordinate::Restitution],
            }
        } else {
            Sentence::DoesNotFit
        };
        let verdict = Verdict {
            kind,
            sentences: vec![sentence],
            findings: vec![],
        };
        let methods = [(Method::FreeDecay, joint.clone())].into();
        let agreement = Agreement::default();
        let result = SpecimenResult {
            verdict,
            joint,
            methods,
            agreement,
        };
        id.specimens.insert(name.into(), result);
    }
    let mut content = ReportContent::new("Blade spring with four tip masses", id);
    content.free_decays = (0..9).map(evidence::decay).collect();
    content.free_decays[5].note = "filed under mass 2, behaves as mass 3.".into();
    content.summary = CampaignSummary {
        name: "cantilever, hammer tests".into(),
        records_total: 9,
        records_used: 9,
        files_total: 9,
        ..CampaignSummary::default()
    };
    content.records = content
        .free_decays
        .iter()
        .map(|d| undriven(&d.record, 0))
        .collect();
    content.command_line = "impactid run campaign.toml --out out".into();
    content
}

fn undriven(id: &str, impacts: usize) -> RecordRow {
    RecordRow {
        id: id.into(),
        specimen: None,
        frequency_hz: None,
        eta: None,
        clearance_m: None,
        rho: None,
        sweep: Sweep::Unknown,
        motion: Motion::Undetermined {
            reason: "no drive".into(),
        },
        impacts_p: None,
        periods_n: None,
        confidence: None,
        impacts,
        flags: vec![],
        used_by: vec!["free_decay".into()],
        left_out: None,
    }
}

/// A cart that bounces on a stop: no drive, no plane of frequency and clearance.
pub fn cart() -> ReportContent {
    let mut id = bare(
        VerdictKind::Identified,
        Sentence::Identified {
            values: vec![StatedValue {
                parameter: Coordinate::Restitution,
                value: 0.9003,
                half_width: 0.0041,
            }],
        },
    );
    id.joint.parameters.restitution = estimate(0.9003, 0.0021);
    id.methods.insert(
        Method::Impacts,
        MethodResult {
            observations: 87,
            records: 5,
            fits: Some(true),
            ..id.joint.clone()
        },
    );
    let mut content = ReportContent::new("Cart on an inclined track", id);
    let mut noise = Noise::new(3);
    let point = |i: usize, noise: &mut Noise| {
        let before = 0.62 * 0.9f64.powi(i as i32 % 18) + 0.01;
        ImpactPoint {
            record: format!("run {}", 7 + i / 18),
            before_m_s: before,
            after_m_s: 0.9 * before + 0.003 * noise.gauss(),
            error_m_s: Some(0.003),
            used: i % 18 < 15,
        }
    };
    content.impacts = vec![ImpactScatter {
        name: "spring bumper".into(),
        points: (0..87).map(|i| point(i, &mut noise)).collect(),
        restitution: Some(0.9003),
        interval95: Some([0.8962, 0.9044]),
        ..ImpactScatter::default()
    }];
    content.comparisons = vec![bounces()];
    content.records = (7..12).map(|i| undriven(&format!("run {i}"), 18)).collect();
    content.left_out = vec![LeftOut {
        what: "runs 2 to 6".into(),
        why: "The magnet bumper's contact is long against the flight: not an instantaneous impact."
            .into(),
        count: Some(5),
    }];
    content
}

/// Speed of the cart over time, saw teeth that shrink.
fn bounces() -> Comparison {
    let (mut speed, mut t0, mut hits) = (-0.62, 0.0, Vec::new());
    let acceleration = 0.4;
    let (mut times, mut speeds) = (Vec::new(), Vec::new());
    while hits.len() < 8 {
        let length = 2.0 * -speed / acceleration;
        let steps = (length / 0.05) as usize;
        for i in 0..steps {
            times.push(t0 + 0.05 * i as f64);
            speeds.push(speed + acceleration * 0.05 * i as f64);
        }
        t0 += length;
        hits.push(t0);
        speed *= 0.9;
    }
    let mut noise = Noise::new(8);
    let measured: Vec<f64> = speeds.iter().map(|v| v + 0.004 * noise.gauss()).collect();
    let residual = measured.iter().zip(&speeds).map(|(m, s)| m - s).collect();
    let signal = |values| {
        Some(Signal {
            time_s: times.clone(),
            values,
        })
    };
    Comparison {
        letter: "A".into(),
        record: "run 7".into(),
        eta: None,
        rho: None,
        drive_period_s: None,
        motion: Motion::Undetermined {
            reason: "no drive".into(),
        },
        simulated_motion: None,
        traces: vec![Trace {
            role: Role::VelocityX,
            dimension: Dimension::Velocity,
            measured: signal(measured),
            simulated: signal(speeds.clone()),
            residual: signal(residual),
        }],
        portraits: vec![],
        impacts_s: hits.clone(),
        simulated_impacts_s: hits,
        note: String::new(),
    }
}

/// A campaign that knows frequencies and clearances, but neither f0 nor x_st.
pub fn unidentified() -> ReportContent {
    let mut content = content(SMALL);
    let mut id = bare(
        VerdictKind::NotIdentifiable,
        Sentence::NotIdentifiable {
            parameters: vec![Coordinate::Restitution, Coordinate::Deflection],
        },
    );
    id.joint.parameters.restitution = unknown(Note::Open {
        parameter: Coordinate::Restitution,
        standard_error: Some(0.31),
    });
    id.joint.parameters.natural_frequency_hz = Some(Estimate {
        status: Status::Weak,
        note: Some(Note::LeansOn {
            parameter: Coordinate::Damping,
            correlation: 0.91,
        }),
        ..estimate(12.6, 0.2).unwrap_or_else(|| unreachable!())
    });
    id.joint.parameters.static_deflection_m = unknown(Note::NotSeparable);
    content.identification = id;
    content.curves.clear();
    content.region_map = None;
    content.profiles.clear();
    content.correlation = None;
    content.resonance.clear();
    content.comparisons.truncate(1);
    for r in &mut content.records {
        r.eta = None;
        r.rho = None;
    }
    for b in &mut content.brackets {
        b.rho = None;
        b.simulated_hz = None;
    }
    content
}
