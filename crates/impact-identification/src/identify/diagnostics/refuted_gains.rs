//! A gain so far off its stated value that everything else stated of the rig would bend to it.
//!
//! A wrong gain of one channel looks like unlike masses, springs and drives, and like clearances that are off, each of which
//! has a prior: a fit that keeps all of them spreads the error over all. Which single statement is wrong is decided by
//! leaving each of them in turn to the data: the one without which the least squares fall most is, if they fall beyond chance and
//! no other does as well.

use impact_fit::evidence::{Evidence, Nominal, OpenGains};
use impact_fit::messages::Finding;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::{Coordinate, GAIN_ROLES, Parameters, gain_index};
use impact_fit::solver::{Fit, Precision, Prior, Problem};
use impact_records::motion::Observation;
use impact_records::record::Role;

/// Fall of the squares, in variances, from which a statement is refuted: five standard deviations, of some twenty statements.
const REFUTED: f64 = 25.0;
/// Difference of the squares below which the data do not tell which statement is wrong: three standard deviations.
const TOLD: f64 = 9.0;

/// Difference of the responses of both sides, as a logarithm, that is none of sides that were made alike: four times the
/// 5 % that their drives may differ by.
const UNLIKE: f64 = 0.2;

/// Part of the fall that refutes a statement from which it is tried without it: to first order it falls by that.
const TRIED: f64 = 0.25;

/// By how much the least squares fall without a prior, to first order about a fit with it: z² with z = d/√(σ² − s²), d how far
/// the fit is from it, σ its deviation and s the standard error of the fit.
fn fall(fit: &Fit, prior: &Prior) -> f64 {
    let off = fit.parameters.coordinate(prior.coordinate) - prior.centre;
    let error = fit.error(prior.coordinate).unwrap_or(0.0);
    // what the data do not tell cannot be wrong
    let told = prior.deviation.powi(2) - error.powi(2);
    if told > UNTOLD * prior.deviation.powi(2) {
        off * off / told
    } else {
        0.0
    }
}

/// Share of a prior's variance that a fit must take away to tell of it.
const UNTOLD: f64 = 1e-6;

/// A fit without one of the statements.
struct Without {
    coordinate: Coordinate,
    /// Its value in that fit.
    value: f64,
    /// The least squares.
    squares: f64,
}

/// The gains that all data refute, by fits from a start; `factor`: the variance that the joint fit has. `None` where another
/// statement is wrong, or none is.
pub fn refuted(problem: Problem<'_>, at: Parameters, factor: f64) -> Option<OpenGains> {
    let problem = problem.with_precision(Precision::Start);
    let with_all = problem.fit(at).ok()?;
    let variance = factor.max(1.0);
    let priors = problem.priors.iter();
    let stated = priors.filter(|prior| prior.coordinate.is_stated());
    let may_be_wrong = stated.filter(|prior| fall(&with_all, prior) > TRIED * REFUTED * variance);
    let mut each: Vec<Without> = may_be_wrong
        .filter_map(|prior| {
            let coordinate = prior.coordinate;
            let fit = problem.without(coordinate).fit(at).ok()?;
            Some(Without {
                coordinate,
                value: fit.parameters.coordinate(coordinate),
                squares: fit.cost,
            })
        })
        .collect();
    each.sort_by(|a, b| a.squares.total_cmp(&b.squares));
    let best = each.first()?.squares;
    if with_all.cost - best < REFUTED * variance {
        return None;
    }
    let mut open = OpenGains::default();
    for without in each.iter().filter(|w| w.squares - best < TOLD * variance) {
        match without.coordinate {
            Coordinate::Gain(index) => open[index] = Some(without.value),
            // one clearance alone is a length as a gain is: what reads both is not told
            Coordinate::Gap(_) | Coordinate::ScrewZero => (),
            _ => return None,
        }
    }
    open.iter().any(Option::is_some).then_some(open)
}

/// Each gain that by itself may explain that all clearances seem to be off alike: of several the one of a side whose responses
/// differ from those of the other more than sides do that were made alike, or the only one.
pub fn in_place_of(clearances: &Finding, blocks: &Blocks, curve: &Parameters) -> Vec<OpenGains> {
    let gains: Vec<usize> = blocks.gains().filter_map(Coordinate::gain).collect();
    let open = |index: usize, value: f64| {
        let mut open = OpenGains::default();
        open[index] = Some(value);
        open
    };
    match (&gains[..], clearances) {
        // speeds and clearances are read alike
        ([only], Finding::ClearancesOffAlike { ratio, .. }) => vec![open(*only, ratio.ln())],
        (_, _) if curve.drive_asymmetry.abs() < UNLIKE => Vec::new(),
        (several, _) => {
            let apart = curve.drive_asymmetry;
            let value = |i: usize| {
                if GAIN_ROLES[i].is_of_y() {
                    -apart
                } else {
                    apart
                }
            };
            several.iter().map(|i| open(*i, value(*i))).collect()
        }
    }
}

/// The channels of the motion of each mass, those first by which the speeds at impacts are known best.
const SIDES: [[Role; 3]; 2] = [
    [Role::VelocityX, Role::DisplacementX, Role::AccelerationX],
    [Role::VelocityY, Role::DisplacementY, Role::AccelerationY],
];

/// Observations whose speeds at impacts are read by gains that are left to the data.
pub struct Opened {
    observations: Vec<Observation>,
    gains: OpenGains,
}

impl Opened {
    /// The observations of some blocks as gains read them.
    pub fn of(evidence: &Evidence<'_>, blocks: &Blocks, gains: OpenGains) -> Self {
        let present: Vec<usize> = blocks.gains().filter_map(Coordinate::gain).collect();
        let of_sides = SIDES.map(|roles| {
            let mut channels = roles.into_iter().filter_map(gain_index);
            let channel = channels.find(|index| present.contains(index));
            channel.and_then(|index| gains[index]).map_or(1.0, f64::exp)
        });
        let mut observations = evidence.observations.to_vec();
        for impact in observations.iter_mut().flat_map(|o| &mut o.impacts) {
            *impact = impact.over(of_sides);
        }
        Self {
            observations,
            gains,
        }
    }

    /// The same evidence with these, and the gains left to the data.
    pub fn evidence<'a>(&'a self, of: &Evidence<'a>) -> Evidence<'a> {
        let nominal = Nominal {
            open_gains: self.gains,
            ..of.nominal
        };
        Evidence {
            observations: &self.observations,
            nominal,
            ..*of
        }
    }
}
