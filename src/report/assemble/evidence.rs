//! What each method rests on: resonance curve, speeds at impacts, residuals, correlation.

use super::{Gathered, moves};
use crate::identify::evidence::impacts::SpeedPair;
use crate::identify::evidence::resonance::predicted;
use crate::identify::evidence::{Blocks, Evidence, Nominal};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::judgement::contact_law::Law;
use crate::identify::residuals::{MethodResiduals, residuals as methods_residuals};
use crate::identify::{Method, MethodResult, SpecimenResult};
use crate::motion::Observation;
use crate::motion::response::Response;
use crate::record::Role;
use crate::report::content::{
    Correlation, ImpactPoint, ImpactScatter, Profile, ResidualPoint, ResidualSet, ResonanceCurve,
    ResonancePoint,
};
use labfiles::units::Dimension;

/// Points of a fitted resonance curve.
const CURVE_POINTS: usize = 240;
/// Fewer points make no resonance curve.
const FEWEST_POINTS: usize = 3;
/// Most resonance curves: one for each mass.
const MOST_CURVES: usize = 2;
/// Most residuals of one method that are drawn.
const MOST_RESIDUALS: usize = 4000;
/// Most impacts, and most points of a resonance curve, that are drawn.
const MOST_POINTS: usize = 20_000;

/// Every second, third … of points that are too many to be drawn.
fn thinned<T>(points: &[T], most: usize) -> impl Iterator<Item = &T> {
    points.iter().step_by(points.len().div_ceil(most).max(1))
}

/// What a method noticed.
fn remarks(method: &MethodResult) -> String {
    let each: Vec<String> = method.remarks.iter().map(ToString::to_string).collect();
    each.join("; ")
}

/// Impactless resonance curves of the channels that have one, velocities first.
pub(super) fn resonance(gathered: &Gathered) -> Vec<ResonanceCurve> {
    let roles = Role::ALL.into_iter().filter(|r| moves(*r));
    roles
        .filter_map(|role| curve(gathered, role))
        .take(MOST_CURVES)
        .collect()
}

fn curve(gathered: &Gathered, role: Role) -> Option<ResonanceCurve> {
    let left = gathered.record_reasons();
    let points = gathered
        .observations
        .iter()
        .enumerate()
        .filter_map(|(i, o)| {
            let response = o.response.iter().find(|r| r.role == role)?;
            Some(point(o, response, left.contains_key(&i)))
        });
    let points: Vec<ResonancePoint> = points.collect();
    let mut points: Vec<ResonancePoint> = thinned(&points, MOST_POINTS).cloned().collect();
    if points.len() < FEWEST_POINTS {
        return None;
    }
    points.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let method = gathered.identification.methods.get(&Method::Resonance);
    Some(ResonanceCurve {
        name: role.name().replace('_', " "),
        dimension: role.dimension().unwrap_or(Dimension::Number),
        unit: None,
        fitted: fitted(gathered, role, &points),
        points,
        fits: method.and_then(|m| m.fits),
        note: method.map(remarks).unwrap_or_default(),
    })
}

fn point(o: &Observation, response: &Response, left: bool) -> ResonancePoint {
    let amplitude = response.amplitude();
    ResonancePoint {
        record: o.record.clone(),
        frequency_hz: o.frequency_hz().unwrap_or(f64::NAN),
        amplitude: amplitude / o.setting.drive_amplitude,
        amplitude_error: Some(response.error / o.setting.drive_amplitude),
        phase_rad: Some(-response.imaginary.atan2(response.real)),
        phase_error_rad: Some(response.error / amplitude),
        used: !o.excluded() && !left,
    }
}

fn fitted(gathered: &Gathered, role: Role, points: &[ResonancePoint]) -> Vec<[f64; 3]> {
    let (Some(parameters), Some(first), Some(last)) =
        (gathered.parameters(), points.first(), points.last())
    else {
        return Vec::new();
    };
    impact_oscillator::atlas::map::even((first.frequency_hz, last.frequency_hz, CURVE_POINTS))
        .into_iter()
        .map(|f| {
            let z = predicted(parameters, gathered.campaign.rig, role, f, 1.0);
            [f, z.norm(), -z.im.atan2(z.re)]
        })
        .collect()
}

/// What the methods' own blocks are made of; nominal values weigh nothing here.
fn evidence<'a>(gathered: &Gathered<'a>) -> Evidence<'a> {
    Evidence {
        rig: gathered.campaign.rig,
        observations: gathered.observations,
        brackets: gathered.brackets,
        nominal: Nominal::default(),
        uncertainty: Default::default(),
    }
}

/// Speeds before and after impact; each specimen by itself where there are several.
pub(super) fn impacts(gathered: &Gathered) -> Vec<ImpactScatter> {
    let block = Blocks::new(&evidence(gathered)).impact;
    let specimens = &gathered.identification.specimens;
    if specimens.is_empty() {
        let method = gathered.identification.methods.get(&Method::Impacts);
        let pairs: Vec<&SpeedPair> = block.pairs.iter().collect();
        return scatter(gathered, "", &pairs, method).into_iter().collect();
    }
    let of_specimen = |(name, result): (&String, &SpecimenResult)| {
        let specimen = |p: &&SpeedPair| {
            let setting = &gathered.observations[p.observation].setting;
            setting.specimen.as_ref() == Some(name)
        };
        let pairs: Vec<&SpeedPair> = block.pairs.iter().filter(specimen).collect();
        scatter(gathered, name, &pairs, result.methods.get(&Method::Impacts))
    };
    specimens.iter().filter_map(of_specimen).collect()
}

fn scatter(
    gathered: &Gathered,
    name: &str,
    pairs: &[&SpeedPair],
    method: Option<&MethodResult>,
) -> Option<ImpactScatter> {
    let estimate = method.and_then(|m| m.parameters.restitution.as_ref());
    let point = |p: &&SpeedPair| ImpactPoint {
        record: gathered.observations[p.observation].record.clone(),
        before_m_s: p.before_m_s,
        after_m_s: p.after_m_s,
        error_m_s: Some(p.error_m_s),
        used: true,
    };
    (!pairs.is_empty()).then(|| ImpactScatter {
        name: name.to_owned(),
        total: pairs.len(),
        points: thinned(pairs, MOST_POINTS).map(point).collect(),
        restitution: estimate.and_then(|e| e.value),
        interval95: estimate.and_then(|e| e.interval95),
        restitution_of_speed: method.map(law_curve).unwrap_or_default(),
        note: method.map(remarks).unwrap_or_default(),
    })
}

/// R over the closing speed, where it is not one number.
fn law_curve(method: &MethodResult) -> Vec<[f64; 2]> {
    let law = method.contact_law.as_ref();
    law.filter(|l| l.law != Law::Constant && method.fits == Some(false))
        .map(|l| {
            l.curve
                .iter()
                .map(|p| [p.speed_m_s, p.restitution])
                .collect()
        })
        .unwrap_or_default()
}

/// The residuals of each method at the fitted parameters.
pub(super) fn residuals(gathered: &Gathered) -> Vec<ResidualSet> {
    let Some(parameters) = gathered.parameters() else {
        return Vec::new();
    };
    let left = gathered.record_reasons();
    let left_out = |i: usize| left.contains_key(&i);
    let found = methods_residuals(&evidence(gathered), parameters, left_out);
    found.into_iter().map(|m| set(gathered, m)).collect()
}

fn set(gathered: &Gathered, found: MethodResiduals) -> ResidualSet {
    let point = |(owner, residual): &(usize, f64)| {
        let o = &gathered.observations[*owner];
        ResidualPoint {
            record: o.record.clone(),
            residual: *residual,
            frequency_hz: o.frequency_hz(),
            clearance_m: o.setting.clearance_m,
        }
    };
    ResidualSet {
        method: found.method.name().to_owned(),
        total: found.residuals.len(),
        points: thinned(&found.residuals, MOST_RESIDUALS)
            .map(point)
            .collect(),
        autocorrelation: found.autocorrelation,
        note: String::new(),
    }
}

/// Correlation of the parameters that were fitted together.
pub(super) fn correlation(gathered: &Gathered) -> Option<Correlation> {
    let fit = gathered.fit()?;
    let matrix = fit
        .free
        .iter()
        .map(|a| {
            fit.free
                .iter()
                .map(|b| fit.correlation(*a, *b).unwrap_or(0.0))
                .collect()
        })
        .collect();
    Some(Correlation {
        parameters: fit.free.iter().map(|c| c.name().to_owned()).collect(),
        matrix,
    })
}

/// Profile likelihoods of the joint estimate.
pub(super) fn profiles(gathered: &Gathered) -> Vec<Profile> {
    let id = gathered.identification;
    let best = |parameter: Coordinate| id.joint.parameters.get(parameter)?.value;
    id.uncertainty
        .profiles
        .iter()
        .map(|p| Profile {
            parameter: p.parameter.name().to_owned(),
            method: String::new(),
            values: p.values.clone(),
            delta_chi2: p.delta_chi2.clone(),
            best: best(p.parameter),
            interval95: p.interval95,
        })
        .collect()
}
