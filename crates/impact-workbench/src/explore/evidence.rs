//! A campaign at the sliders: a record beside its simulation with the evidence for its label, the
//! residuals of every method, boundaries against brackets, and what to measure next.

use rayon::prelude::*;
use serde_json::{Value, json};

use super::campaign::OpenCampaign;
use super::job::Job;
use super::stop::Stop;
use super::{ExploreError, State};
use impact_fit::methods::boundaries::block::predicted_hz;
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::solver::{Block, Prior};
use impact_fit::{JointFit, Method, MethodResult, Remark};
use impact_identification::identify::plan::propose;
use impact_identification::replay::{BesideRecord, Signal, beside};
use impact_oscillator::model::params::Asymmetry;
use impact_oscillator::model::patience::{carry_each, still_wanted};
use impact_records::message::plain;
use impact_records::motion::{BoundaryKind, Motion, Observation};
use impact_report::style::MotionStyle;

/// Settings that are proposed.
const PROPOSALS: usize = 6;

/// The chosen record, measured beside simulated, with the evidence for its label; or why not.
pub(super) fn record(campaign: &OpenCampaign, state: &State, job: &Job) -> Result<(), Stop> {
    let Some(name) = &state.record else {
        let message = "no record is chosen".to_owned();
        return Err(Stop::Refused(ExploreError::Absent(message)));
    };
    let observations = &campaign.observed.observations;
    let Some(index) = observations.iter().position(|o| o.record == *name) else {
        let message = format!("the campaign has no record {name}");
        return Err(Stop::Refused(ExploreError::Absent(message)));
    };
    let parameters = campaign.at_sliders(state);
    let frame = job
        .frame("record")
        .with("record", name)
        .with("stated", stated(&observations[index]))
        .with("evidence", evidence_of(campaign, index));
    let frame = match &parameters {
        Ok(_) => frame,
        Err(why) => frame.with("not_simulated", why),
    };
    let parameters = parameters.ok();
    let frame = match campaign.with_input(|input| beside(input, index, parameters.as_ref())) {
        BesideRecord::Motion(c) => {
            let traces = c.traces.iter().map(|t| {
                json!({
                    "role": t.role.name(),
                    "unit": t.dimension.si_symbol(),
                    "simulated": t.simulated.is_some(),
                })
            });
            let start = frame
                .with("shown", "motion")
                .with("eta", c.eta)
                .with("rho", c.rho)
                .with("drive_period_s", c.drive_period_s)
                .with(
                    "simulated",
                    c.simulated_motion.as_ref().map(MotionStyle::of),
                )
                .with("traces", traces.collect::<Vec<_>>())
                .column("impacts", c.impacts_s.iter().copied())
                .column("simulated_impacts", c.simulated_impacts_s.iter().copied());
            c.traces.iter().enumerate().fold(start, |frame, (i, t)| {
                let values = |s: &Option<Signal>| s.iter().flat_map(|s| s.values.clone()).collect();
                let (simulated, residual): (Vec<f64>, Vec<f64>) =
                    (values(&t.simulated), values(&t.residual));
                frame
                    .column(&format!("t{i}"), t.measured.time_s.iter().copied())
                    .column(&format!("measured{i}"), t.measured.values.iter().copied())
                    .column(&format!("simulated{i}"), simulated)
                    .column(&format!("residual{i}"), residual)
            })
        }
        BesideRecord::Decay(d) => frame
            .with("shown", "decay")
            .with("unit", d.dimension.si_symbol())
            .with("natural_frequency_hz", d.natural_frequency_hz)
            .with("damping_ratio", d.damping_ratio)
            .column("t0", d.measured.time_s.iter().copied())
            .column("measured0", d.measured.values.iter().copied())
            .column("t1", d.fitted.time_s.iter().copied())
            .column("simulated1", d.fitted.values.iter().copied()),
        BesideRecord::Nothing(why) => {
            let file = campaign.file_of(index);
            let why = format!("{file}: {}", plain(&why));
            frame.with("shown", "nothing").with("why", why)
        }
    };
    Ok(job.send(frame)?)
}

/// What the laboratory states of a record, and what was measured.
fn stated(o: &Observation) -> Value {
    json!({
        "frequency_hz": o.frequency_hz(),
        "clearance_m": o.setting.clearance_m,
        "sweep": o.setting.sweep.name(),
        "specimen": o.setting.specimen,
        "duration_s": o.duration_s,
        "sample_rate_hz": o.sample_rate_hz,
        "motion": MotionStyle::of(&o.classification.motion),
        "confidence": o.classification.confidence,
    })
}

/// What a record's label rests on, its flags, who used it, and why a fit did not.
fn evidence_of(campaign: &OpenCampaign, index: usize) -> Value {
    let o = &campaign.observed.observations[index];
    let reason = match &o.classification.motion {
        Motion::Undetermined { reason } => Some(reason.to_string()),
        _ => None,
    };
    let flags = o
        .flags
        .iter()
        .map(|f| json!({"message": f.message(), "remedy": f.remedy(), "excludes": f.excludes}));
    let used = campaign.identification.methods_using(index);
    let left_out = campaign.identification.left_out.iter();
    let left_out = left_out
        .filter(|l| matches!(&l.item, impact_fit::Item::Record { index: i, .. } if *i == index));
    json!({
        "measures": o.classification.evidence,
        "undetermined": reason,
        "impacts": o.impacts.len(),
        "unsupported_pulses": o.unsupported_pulses,
        "missed_pulses": o.missed_pulses,
        "flags": flags.collect::<Vec<_>>(),
        "used_by": used.map(|m| m.to_string()).collect::<Vec<_>>(),
        "left_out": left_out.map(|l| l.reason.to_string()).collect::<Vec<_>>(),
    })
}

/// Weighted residuals of a method: number, root mean square, and observations without a model.
struct Misfit {
    count: usize,
    squares: f64,
    without: usize,
}

fn misfit(block: &dyn Block, at: &Parameters) -> Misfit {
    let of = |item| {
        still_wanted().ok()?;
        let residuals = block.residuals(item, at);
        residuals.map(|r| (r.len(), r.iter().map(|v| v * v).sum::<f64>()))
    };
    let items = (0..block.items()).into_par_iter().map(carry_each(of));
    let items: Vec<Option<(usize, f64)>> = items.collect();
    let known = || items.iter().flatten();
    Misfit {
        count: known().map(|i| i.0).sum(),
        squares: known().map(|i| i.1).sum(),
        without: items.iter().filter(|i| i.is_none()).count(),
    }
}

fn root_mean(squares: f64, count: usize) -> Option<f64> {
    let mean = squares / count as f64;
    (count > 0 && mean.is_finite()).then(|| mean.sqrt())
}

/// Of brackets, which the joint fit takes as a distribution of R.
const BY_R: &str = "in the joint fit by R";

/// How the joint fit takes a method whose residuals are not among its own; `None` for one whose are.
fn apart(method: Method, own: Option<&MethodResult>, joint: &JointFit) -> Option<&'static str> {
    if joint.weights.get(&method).is_some_and(|w| *w > 0.0) {
        return None;
    }
    let remarks = own.map_or(&[][..], |own| &own.remarks);
    let value = own.and_then(|own| own.parameters.restitution.as_ref()?.value);
    let of_it = |p: &Prior| p.coordinate == Coordinate::Restitution && Some(p.centre) == value;
    let by_r = method.observes_boundaries() && joint.priors.iter().any(of_it);
    Some(if by_r {
        BY_R
    } else if remarks.contains(&Remark::IdealRig) {
        "takes the rig as ideal, not in the joint fit"
    } else {
        "not in the joint fit"
    })
}

/// What the joint fit rests on, as a remark of a method whose residuals are not among its own.
fn rests_on(joint: &JointFit, by_r: bool) -> String {
    let some = joint.weights.iter().filter(|(_, weight)| **weight > 0.0);
    let some: Vec<String> = some.map(|(method, _)| method.to_string()).collect();
    let some = some.join(", ").to_lowercase();
    let also = if by_r {
        " and on the R that the brackets give"
    } else {
        ""
    };
    format!("the joint fit rests on the residuals of {some}{also}")
}

/// Residuals of every method and of the joint fit at the sliders, and where each boundary is then.
pub(super) fn residuals(campaign: &OpenCampaign, state: &State, job: &Job) -> Result<(), Stop> {
    let at = match campaign.at_sliders(state) {
        Ok(at) => at,
        Err(why) => return Ok(job.send(job.frame("residuals").with("none", why))?),
    };
    let mut methods = Vec::new();
    let (mut squares, mut count) = (0.0, 0);
    let joint = campaign.identification.joint_fit.as_ref();
    let weight = |method| joint.map(|j| j.weights.get(&method).copied().unwrap_or(0.0));
    for method in Method::FITTED {
        let block = campaign.blocks.of(method).filter(|b| b.items() > 0);
        let Some(block) = block else { continue };
        let found = misfit(block, &at);
        let weight = weight(method);
        if let Some(weight) = weight.filter(|weight| *weight > 0.0) {
            squares += weight * found.squares;
            count += found.count;
        }
        let own = campaign.identification.methods.get(&method);
        let apart = joint.and_then(|joint| apart(method, own, joint));
        let rests = joint
            .zip(apart)
            .map(|(joint, apart)| rests_on(joint, apart == BY_R));
        let noticed = own.iter().flat_map(|own| &own.remarks);
        let remarks = rests.into_iter().chain(noticed.map(ToString::to_string));
        methods.push(json!({
            "apart": apart,
            "remarks": remarks.collect::<Vec<_>>(),
            "method": method.to_string(),
            "rms": root_mean(found.squares, found.count),
            "weight": weight,
            "count": found.count,
            "without": found.without,
        }));
    }
    let rig = campaign.resolved.about.machine;
    let predicted = campaign.observed.brackets.iter().map(|b| {
        // of unlike masses the place of a period doubling is not computed
        let unlike = !state.single && state.asymmetry != Asymmetry::default();
        let closed_form = match b.kind {
            BoundaryKind::Other => false,
            BoundaryKind::PeriodDoubling => !unlike,
            _ => true,
        };
        let boundary_hz = closed_form.then(|| predicted_hz(b, &at, rig)).flatten();
        let past = boundary_hz.map(|f| (f - b.frequency_high_hz).max(b.frequency_low_hz - f));
        json!({"boundary_hz": boundary_hz, "past_hz": past.map(|p| p.max(0.0))})
    });
    let frame = job
        .frame("residuals")
        .with("methods", methods)
        .with("joint", root_mean(squares, count))
        .with("brackets", predicted.collect::<Vec<_>>());
    Ok(job.send(frame)?)
}

/// The settings to measure next.
pub(super) fn proposals(campaign: &OpenCampaign, job: &Job) -> Result<(), Stop> {
    let evidence = campaign.observed.evidence(&campaign.resolved);
    let joint = campaign.identification.joint_fit.as_ref();
    let found = propose(&evidence, joint, PROPOSALS).unwrap_or_default();
    Ok(job.send(job.frame("proposals").with("proposals", found))?)
}
