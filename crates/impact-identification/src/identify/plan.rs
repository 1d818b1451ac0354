//! Which settings to measure next: those whose record would shrink the interval of R most, from
//! the Fisher information of the closed-form orbit that the fitted rig would show there.

use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use impact_fit::JointFit;
use impact_fit::evidence::Evidence;
use impact_fit::methods::trajectories::block::{TrajectoryBlock, distinct_phases};
use impact_fit::methods::trajectories::record::TrajectoryRecord;
use impact_fit::methods::weighing::LEAST_ALLOWANCE;
use impact_fit::parameters::{Coordinate, GAIN_ROLES, Parameters};
use impact_fit::solver::normal::inverse;
use impact_fit::solver::{Fit, Problem};
use impact_oscillator::model::orbit::{Orbit, stable_orbit};
use impact_oscillator::model::patience::{carry_each, still_wanted};
use impact_oscillator::{Machine, Setting, rho_grazing};
use impact_records::motion::Observation;
use impact_records::motion::{Folded, FoldedChannel, FoldedPoint};
use impact_records::record::Role;
use impact_records::signal::robust;
use impact_records::signal::whole;
use impact_records::{message_table, messages};

/// A setting to measure, with what a record there would bring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proposal {
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// η with the fitted f0.
    pub frequency_ratio: f64,
    /// ρ with the fitted `x_st`.
    pub clearance_ratio: f64,
    /// The motion to expect, z = 1/n.
    pub periods_n: u32,
    /// How the rig comes to it.
    pub approach: Approach,
    /// Standard error of R, by all that its interval allows for, once this setting and those before it in
    /// the list are measured.
    pub restitution_error_after: f64,
}

/// How a rig comes to a motion.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum Approach {
    /// From rest, at the setting itself.
    FromRest,
    /// Carried along in a rising frequency, from where no motion without impacts exists.
    Rising,
    /// Carried along in a falling frequency.
    Falling,
    /// By a blow: no sweep of the frequency at this clearance leads to it.
    Blow,
}

impl Approach {
    /// How a machine comes to its stable z = 1/n at a setting: where z = 0 exists beside it, from the nearer of the
    /// frequencies at which it does not and up to which z = 1/n goes on.
    fn of(machine: &Machine, setting: Setting, n: u32) -> Self {
        let alone = |eta: f64| setting.clearance < rho_grazing(machine, eta);
        if alone(setting.frequency_ratio) {
            return Self::FromRest;
        }
        let lasts = |eta: f64| {
            let at = Setting::new(eta, setting.clearance);
            matches!(stable_orbit(machine, at, n), Ok(Some(_)))
        };
        let steps_to = |ratio: f64| {
            let next = |eta: &f64| Some(eta * ratio);
            let etas = std::iter::successors(Some(setting.frequency_ratio * ratio), next);
            let mut etas = etas.take(MOST_APPROACH).take_while(|eta| lasts(*eta));
            etas.position(alone)
        };
        match (steps_to(1.0 / APPROACH_STEP), steps_to(APPROACH_STEP)) {
            (None, None) => Self::Blow,
            (Some(below), Some(above)) if above < below => Self::Falling,
            (None, Some(_)) => Self::Falling,
            _ => Self::Rising,
        }
    }
}

/// Ratio of two frequencies on the way to a setting.
const APPROACH_STEP: f64 = 1.005;
/// Most steps of that way: a factor of four in the frequency.
const MOST_APPROACH: usize = 280;

/// Why no setting can be proposed.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Obstacle {
    /// No record has a drive frequency.
    NoFrequency,
    /// No record states a clearance.
    NoClearance,
    /// No waveform of a velocity or a displacement was folded.
    NoWaveform,
    /// R is no unknown of a joint fit.
    RestitutionNotFitted,
    /// No record at any setting would inform R.
    NothingGained,
}

messages!(Obstacle);

message_table! { "obstacle": Obstacle; }

message_table! { "approach": Approach; }

/// The settings that a rig can reach.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reach {
    /// Lowest and highest drive frequency, Hz.
    frequency_hz: [f64; 2],
    /// Least and greatest clearance, m.
    clearance_m: [f64; 2],
}

impl Reach {
    /// Where the campaign has been.
    fn of(observations: &[Observation]) -> Result<Self, Obstacle> {
        let all = observations.iter();
        let clearances = robust::range(all.clone().filter_map(|o| o.setting.clearance_m));
        let frequencies = robust::range(all.filter_map(Observation::frequency_hz));
        Ok(Self {
            frequency_hz: frequencies.ok_or(Obstacle::NoFrequency)?.into(),
            clearance_m: clearances.ok_or(Obstacle::NoClearance)?.into(),
        })
    }
}

/// Points of the grid of candidates: frequencies and clearances.
const GRID: [usize; 2] = [40, 24];
/// Longest motion z = 1/n considered.
const MOST_PERIODS: u32 = 3;

/// Propose so many settings, the best first; each takes those before it as measured.
///
/// What R's interval allows for beyond the covariance (scatter between groups, first order of the
/// effects, disagreement of methods) stays in the errors stated: one more record takes none of it away.
///
/// # Errors
/// The [`Obstacle`] where there is none to propose.
pub fn propose(
    evidence: &Evidence<'_>,
    joint: Option<&JointFit>,
    count: usize,
) -> Result<Vec<Proposal>, Obstacle> {
    let reach = Reach::of(evidence.observations)?;
    let usual = UsualRecord::of(evidence.observations).ok_or(Obstacle::NoWaveform)?;
    let restitution = |c: &Coordinate| *c == Coordinate::Restitution;
    let place = |fit: &JointFit| fit.fit.free.iter().position(restitution);
    let fitted = joint.and_then(|fit| Some((fit, place(fit)?)));
    let (joint, at) = fitted.ok_or(Obstacle::RestitutionNotFitted)?;
    let candidates = candidates(evidence, &joint.fit, reach, &usual);
    let variance_of = |covariance: &DMatrix<f64>| covariance[(at, at)] * joint.variance_factor;
    let mut covariance = joint.fit.covariance.clone();
    let allowed = joint.allowed.iter().find(|a| restitution(&a.parameter));
    let beyond = allowed.map_or(0.0, |a| {
        (a.standard_uncertainty.powi(2) - variance_of(&covariance)).max(0.0)
    });
    let machine = joint.fit.parameters.machine(evidence.rig);
    let mut chosen: Vec<Proposal> = Vec::new();
    while chosen.len() < count {
        let best = candidates
            .par_iter()
            .filter(|(place, _)| !chosen.iter().any(|c| near(c, place, reach)))
            .filter_map(|(place, information)| {
                let after = with(&covariance, information)?;
                Some((place, variance_of(&after), after))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, variance, after)) = best else {
            break;
        };
        let at = Setting::new(place.frequency_ratio, place.clearance_ratio);
        chosen.push(Proposal {
            approach: Approach::of(&machine, at, place.periods_n),
            restitution_error_after: (variance.max(0.0) + beyond).sqrt(),
            ..place.clone()
        });
        covariance = after;
    }
    if chosen.is_empty() && count > 0 {
        Err(Obstacle::NothingGained)
    } else {
        Ok(chosen)
    }
}

/// Whether a candidate lies so near to a chosen setting that it would only repeat it.
fn near(chosen: &Proposal, place: &Proposal, reach: Reach) -> bool {
    let [low, high] = reach.frequency_hz;
    let apart = (chosen.frequency_hz - place.frequency_hz) / (high - low).max(1e-9);
    let [least, most] = reach.clearance_m;
    let across = (chosen.clearance_m - place.clearance_m) / (most - least).max(1e-12);
    apart.hypot(across) < 0.08
}

/// Covariance once some information is added: (C⁻¹ + F)⁻¹.
fn with(covariance: &DMatrix<f64>, information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    inverse(&(inverse(covariance)? + information))
}

fn candidates(
    evidence: &Evidence<'_>,
    fit: &Fit,
    reach: Reach,
    usual: &UsualRecord,
) -> Vec<(Proposal, DMatrix<f64>)> {
    let even = |[low, high]: [f64; 2], count: usize, i: usize| {
        low + (high - low) * i as f64 / (count - 1) as f64
    };
    let grid: Vec<(f64, f64, u32)> = (0..GRID[0])
        .flat_map(|i| (0..GRID[1]).map(move |k| (i, k)))
        .map(|(i, k)| {
            (
                even(reach.frequency_hz, GRID[0], i),
                even(reach.clearance_m, GRID[1], k),
            )
        })
        .flat_map(|(f, c)| (1..=MOST_PERIODS).map(move |n| (f, c, n)))
        .collect();
    grid.into_par_iter()
        .filter_map(carry_each(|(frequency_hz, clearance_m, n)| {
            still_wanted().ok()?;
            let parameters = fit.parameters;
            let setting = parameters.setting(frequency_hz, clearance_m, 1.0);
            let machine = parameters.machine(evidence.rig);
            let orbit = stable_orbit(&machine, setting, n).ok().flatten()?;
            let record = usual.at(&orbit, &parameters, (frequency_hz, clearance_m));
            let information = information(evidence, fit, record)?;
            let place = Proposal {
                frequency_hz,
                clearance_m,
                frequency_ratio: setting.frequency_ratio,
                clearance_ratio: setting.clearance,
                periods_n: n,
                // of those that are chosen
                approach: Approach::FromRest,
                restitution_error_after: f64::NAN,
            };
            Some((place, information))
        }))
        .collect()
}

fn information(
    evidence: &Evidence<'_>,
    fit: &Fit,
    record: TrajectoryRecord,
) -> Option<DMatrix<f64>> {
    let mut block = TrajectoryBlock::of_records(evidence.rig, vec![record], LEAST_ALLOWANCE);
    block.find_changes(&fit.parameters);
    let problem = Problem::of(vec![(&block, 1.0)], fit.free.clone());
    let part = problem.item_parts(&fit.parameters).pop()?.pop()?;
    Some(part.matrix)
}

/// A record as the campaign has them: length, channels and their noise.
struct UsualRecord {
    samples: f64,
    channels: Vec<(Role, f64)>,
    frequency_error: f64,
    phase_error_rad: f64,
}

/// Bins of phase in one drive period.
const BINS: usize = 64;

impl UsualRecord {
    /// `None` where no velocity or displacement was folded.
    fn of(observations: &[Observation]) -> Option<Self> {
        let folded: Vec<(&Observation, &Folded)> = observations
            .iter()
            .filter(|o| !o.excluded())
            .filter_map(|o| Some((o, o.folded.as_deref()?)))
            .collect();
        let median = |of: &dyn Fn(&Observation) -> f64| {
            let values: Vec<f64> = folded.iter().map(|(o, _)| of(o)).collect();
            robust::median(&values)
        };
        let noise = |role: Role| {
            let channels = folded.iter().flat_map(|(_, f)| &f.channels);
            let values: Vec<f64> = channels
                .filter(|c| c.role == role)
                .map(|c| c.noise)
                .collect();
            robust::median(&values)
        };
        let channels: Vec<(Role, f64)> = GAIN_ROLES
            .into_iter()
            .filter_map(|r| Some((r, noise(r)?)))
            .collect();
        if channels.is_empty() {
            return None;
        }
        Some(Self {
            samples: median(&|o| o.duration_s * o.sample_rate_hz)?,
            channels,
            frequency_error: median(&|o| {
                o.drive
                    .map_or(0.0, |d| d.frequency_error_hz / d.frequency_hz)
            })?,
            phase_error_rad: median(&Observation::drive_phase_error_rad)?,
        })
    }

    /// Such a record of an orbit.
    fn at(
        &self,
        orbit: &Orbit,
        parameters: &Parameters,
        (frequency_hz, clearance_m): (f64, f64),
    ) -> TrajectoryRecord {
        let bins = BINS * orbit.n as usize;
        let width = std::f64::consts::TAU / BINS as f64;
        let points: Vec<FoldedPoint> = (0..bins)
            .map(|i| FoldedPoint {
                phase_rad: (i as f64 + 0.5) * width,
                spread_rad: width / 12f64.sqrt(),
                value: 0.0,
                samples: whole::count((self.samples / bins as f64).max(1.0)),
            })
            .collect();
        let folded = Folded {
            periods_n: orbit.n,
            impact_phase_rad: Some(orbit.phase_at_impact),
            channels: self
                .channels
                .iter()
                .map(|(role, noise)| FoldedChannel {
                    role: *role,
                    noise: *noise,
                    high_pass_hz: None,
                    low_pass: None,
                    points: points.clone(),
                })
                .collect(),
        };
        let speed = parameters.static_deflection_m * parameters.natural_rate();
        TrajectoryRecord {
            frequency_hz,
            clearance_m,
            drive_amplitude: 1.0,
            phases: distinct_phases(&folded).into(),
            folded: folded.into(),
            closing_speed_m_s: orbit.approach_speed * speed,
            frequency_error: self.frequency_error,
            phase_error_rad: self.phase_error_rad,
            ..TrajectoryRecord::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;
    use impact_records::message::{boxed, faults};

    #[test]
    fn obstacles_and_approaches_have_their_texts() {
        let all: Vec<_> = boxed(Obstacle::iter())
            .chain(boxed(Approach::iter()))
            .collect();
        assert_eq!(faults(&all), Vec::<String>::new());
    }
}
