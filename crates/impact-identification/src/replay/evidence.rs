//! What each method used: resonance curves, speeds at impacts, residuals, correlation.

use super::input::Input;
use crate::identify::SpecimenResult;
use crate::identify::residuals::MethodResiduals;
use impact_fit::methods::answer::found_by;
use impact_fit::methods::blocks::impacts_of_bulk;
use impact_fit::methods::impacts::block::SpeedPair;
use impact_fit::methods::impacts::contact_law::Law;
use impact_fit::methods::resonance::block::predicted;
use impact_fit::parameters::Coordinate;
use impact_fit::{Method, MethodResult};
use impact_oscillator::atlas::map::even;
use impact_records::motion::Observation;
use impact_records::motion::Response;
use impact_records::record::Role;
use impact_records::signal::thinning::thinned;
use labfiles::units::Dimension;

/// One point of a resonance curve; errors are standard errors.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredAmplitude {
    /// The record's name.
    pub record: String,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude over the drive's relative amplitude, SI unit of the curve's dimension.
    pub amplitude: f64,
    /// Its error.
    pub amplitude_error: f64,
    /// Phase behind the drive, rad; NaN where the drive was not recorded.
    pub phase_rad: f64,
    /// Its error, rad, or NaN.
    pub phase_error_rad: f64,
    /// Whether the fit used it.
    pub used: bool,
}

/// A resonance curve without impacts, with its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct ResonanceCurve {
    /// Which channel.
    pub role: Role,
    /// Dimension of the amplitude.
    pub dimension: Dimension,
    /// The measured points, by frequency.
    pub points: Vec<MeasuredAmplitude>,
    /// The fitted curve: (frequency Hz, amplitude, phase rad).
    pub fitted: Vec<[f64; 3]>,
}

/// One impact's speeds, m/s.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpactPoint {
    /// The record's name.
    pub record: String,
    /// Approach speed before.
    pub before_m_s: f64,
    /// Separation speed after (R times the speed before).
    pub after_m_s: f64,
    /// Standard error of either.
    pub error_m_s: f64,
}

/// Speeds after over before impact, with the fitted restitution.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ImpactScatter {
    /// The specimen, if the campaign has several.
    pub specimen: Option<String>,
    /// The impacts; of very many every second, third …
    pub points: Vec<ImpactPoint>,
    /// Number of impacts used.
    pub total: usize,
    /// The fitted constant R.
    pub restitution: Option<f64>,
    /// Its 95 % interval.
    pub interval95: Option<[f64; 2]>,
    /// Fitted R over approach speed, (m/s, R), if R depends on the speed.
    pub restitution_of_speed: Vec<[f64; 2]>,
}

/// One weighted residual: (measured − fitted) over its standard error.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualPoint {
    /// The record's name.
    pub record: String,
    /// The weighted residual.
    pub residual: f64,
    /// Drive frequency, Hz.
    pub frequency_hz: Option<f64>,
    /// Clearance r, m.
    pub clearance_m: Option<f64>,
}

/// The residuals of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualSet {
    /// The method.
    pub method: Method,
    /// The residuals, in the order of the observations; of very many every second, third …
    pub points: Vec<ResidualPoint>,
    /// Number of residuals.
    pub total: usize,
    /// Autocorrelation at lags 0, 1, 2 …
    pub autocorrelation: Vec<f64>,
}

/// Correlation of the fitted parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlation {
    /// The parameters.
    pub parameters: Vec<Coordinate>,
    /// The matrix, row by row.
    pub matrix: Vec<Vec<f64>>,
}

/// Points of a fitted resonance curve.
const CURVE_POINTS: usize = 240;
/// Fewer points make no resonance curve.
const FEWEST_POINTS: usize = 3;
/// Most resonance curves: one for each mass.
const MOST_CURVES: usize = 2;
/// Most impacts, and most points of a resonance curve.
const MOST_POINTS: usize = 20_000;

/// Resonance curves of the channels that have one, velocities first.
pub(super) fn resonance(input: &Input<'_>) -> Vec<ResonanceCurve> {
    let roles = Role::ALL.iter().copied().filter(|r| r.is_motion());
    let curves = roles.filter_map(|role| curve(input, role));
    curves.take(MOST_CURVES).collect()
}

fn curve(input: &Input<'_>, role: Role) -> Option<ResonanceCurve> {
    let left_out = input.record_reasons();
    let observations = input.observations.iter().enumerate();
    let points = observations.filter_map(|(i, o)| {
        let response = o.response.iter().find(|r| r.role == role)?;
        let used = !o.excluded() && !left_out.contains_key(&i);
        Some(point(o, response, used))
    });
    let points: Vec<MeasuredAmplitude> = points.collect();
    let mut points: Vec<MeasuredAmplitude> = thinned(&points, MOST_POINTS).cloned().collect();
    if points.len() < FEWEST_POINTS {
        return None;
    }
    points.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    Some(ResonanceCurve {
        role,
        dimension: role.dimension().unwrap_or(Dimension::Number),
        fitted: fitted(input, role, &points),
        points,
    })
}

fn point(o: &Observation, response: &Response, used: bool) -> MeasuredAmplitude {
    let amplitude = response.amplitude();
    // without the drive's phase the response has none
    let known = |phase: f64| o.drive.map_or(f64::NAN, |_| phase);
    MeasuredAmplitude {
        record: o.record.clone(),
        frequency_hz: o.frequency_hz().unwrap_or(f64::NAN),
        amplitude: amplitude / o.setting.drive_amplitude,
        amplitude_error: response.error / o.setting.drive_amplitude,
        phase_rad: known(-response.imaginary.atan2(response.real)),
        phase_error_rad: known(response.error / amplitude),
        used,
    }
}

fn fitted(input: &Input<'_>, role: Role, points: &[MeasuredAmplitude]) -> Vec<[f64; 3]> {
    let (Some(parameters), Some(first), Some(last)) =
        (input.parameters(), points.first(), points.last())
    else {
        return Vec::new();
    };
    let at = |f: f64| {
        let z = predicted(parameters, input.rig, role, f, 1.0);
        [f, z.norm(), -z.im.atan2(z.re)]
    };
    let frequencies = even((first.frequency_hz, last.frequency_hz, CURVE_POINTS));
    frequencies.into_iter().map(at).collect()
}

/// Speeds before and after impact; each specimen by itself if there are several. None where the speeds
/// do not tell R.
pub(super) fn impacts(input: &Input<'_>) -> Vec<ImpactScatter> {
    let block = impacts_of_bulk(input.rig, input.observations);
    if block.first_value_only.is_some() {
        return Vec::new();
    }
    let specimens = &input.identification.specimens;
    if specimens.is_empty() {
        let method = found_by(&input.identification.methods, Method::observes_contact);
        let pairs: Vec<&SpeedPair> = block.pairs.iter().collect();
        return scatter(input, None, &pairs, method).into_iter().collect();
    }
    let of_specimen = |(name, result): (&String, &SpecimenResult)| {
        let specimen = |p: &&SpeedPair| {
            let setting = &input.observations[p.observation].setting;
            setting.specimen.as_ref() == Some(name)
        };
        let pairs: Vec<&SpeedPair> = block.pairs.iter().filter(specimen).collect();
        scatter(
            input,
            Some(name),
            &pairs,
            found_by(&result.methods, Method::observes_contact),
        )
    };
    specimens.iter().filter_map(of_specimen).collect()
}

fn scatter(
    input: &Input<'_>,
    specimen: Option<&String>,
    pairs: &[&SpeedPair],
    method: Option<&MethodResult>,
) -> Option<ImpactScatter> {
    let estimate = method.and_then(|m| m.parameters.restitution.as_ref());
    let point = |p: &&SpeedPair| ImpactPoint {
        record: input.observations[p.observation].record.clone(),
        before_m_s: p.before_m_s,
        after_m_s: p.after_m_s,
        error_m_s: p.error_m_s(),
    };
    (!pairs.is_empty()).then(|| ImpactScatter {
        specimen: specimen.cloned(),
        total: pairs.len(),
        points: thinned(pairs, MOST_POINTS).map(point).collect(),
        restitution: estimate.and_then(|e| e.value),
        interval95: estimate.and_then(|e| e.interval95),
        restitution_of_speed: method.map(law_curve).unwrap_or_default(),
    })
}

/// R over the approach speed, if it is not one number.
fn law_curve(method: &MethodResult) -> Vec<[f64; 2]> {
    let law = method.contact_law.as_ref();
    let law = law.filter(|l| l.law != Law::Constant && method.fits == Some(false));
    let curve = law.into_iter().flat_map(|l| &l.curve);
    curve.map(|p| [p.speed_m_s, p.restitution]).collect()
}

/// The residuals of each method at the fitted parameters.
pub(super) fn residuals(input: &Input<'_>) -> Vec<ResidualSet> {
    let found = input.identification.residuals.iter();
    found.map(|of| residual_set(input, of)).collect()
}

fn residual_set(input: &Input<'_>, found: &MethodResiduals) -> ResidualSet {
    let point = |(owner, residual): &(usize, f64)| {
        let o = &input.observations[*owner];
        ResidualPoint {
            record: o.record.clone(),
            residual: *residual,
            frequency_hz: o.frequency_hz(),
            clearance_m: o.setting.clearance_m,
        }
    };
    ResidualSet {
        method: found.method,
        points: found.residuals.iter().map(point).collect(),
        total: found.total,
        autocorrelation: found.autocorrelation.clone(),
    }
}

/// Correlation of the parameters that were fitted together.
pub(super) fn correlation(input: &Input<'_>) -> Option<Correlation> {
    let fit = &input.identification.joint_fit.as_ref()?.fit;
    let between = |a, b| fit.correlation(a, b).unwrap_or(0.0);
    let row = |a| fit.free.iter().map(|b| between(a, *b)).collect();
    Some(Correlation {
        parameters: fit.free.clone(),
        matrix: fit.free.iter().map(|a| row(*a)).collect(),
    })
}
