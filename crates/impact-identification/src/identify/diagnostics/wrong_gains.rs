//! A gain that is far off its stated value, and what that leaves open in the estimates.
//!
//! What all gains have in common the data hardly tell. The gain that is off by itself with the greatest statistic is named; where
//! another explains the data nearly as well, as of two gains alone, both are, and the data do not tell which.

use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use crate::identify::diagnostics::off_stated::{self, Off};
use impact_fit::evidence::Nominal;
use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::parameters::{Coordinate, GAIN_ROLES};
use impact_fit::solver::Prior;
use impact_records::record::Role;

/// Standard deviations from which a gain is named: chance makes one of two differ so in 0.3 %. What masses
/// that were made alike may differ hides the difference of their gains, so that a gain ten times its
/// uncertainty off is about four standard deviations off.
const SURE: f64 = 3.0;
/// Difference of the squared statistics of two gains below which the data do not tell which is off.
const TOLD: f64 = 9.0;

/// A gain that may be off.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    channel: Role,
    place: usize,
    /// Of its logarithm, if the others are as stated.
    off: Off,
}

impl Candidate {
    fn sure(&self) -> f64 {
        self.off.z_score.abs()
    }
}

/// The gains that are left to the data, with what they leave open: without another channel of motion, a gain and the
/// clearances are two lengths of which the data tell the ratio alone.
pub fn open(found: &MethodFit, nominal: &Nominal) -> Option<Suspicion> {
    let gains = found.fit.free.iter();
    let gains: Vec<usize> = gains.filter_map(|c| c.gain()).collect();
    let mut open: Vec<(Role, f64)> = gains
        .iter()
        .filter(|index| nominal.open_gains[**index].is_some())
        .map(|index| {
            (
                GAIN_ROLES[*index],
                found.fit.parameters.coordinate(Coordinate::Gain(*index)),
            )
        })
        .collect();
    open.sort_by(|a, b| b.1.total_cmp(&a.1));
    let z_score = |off: f64| off / nominal.gain_uncertainty.max(f64::MIN_POSITIVE);
    let [(channel, off)] = open[..] else {
        let (high, low) = (open.first()?, open.last()?);
        let apart = high.1 - low.1;
        return Some(Suspicion::from(Finding::GainsApart {
            channels: [high.0, low.0],
            deviation: apart.exp_m1(),
            z_score: z_score(apart),
        }));
    };
    let (deviation, z_score) = (off.exp_m1(), z_score(off));
    if gains.len() > 1 {
        return Some(Suspicion::from(Finding::WrongGain {
            channel,
            deviation,
            z_score,
        }));
    }
    let doubt = Doubt::material(
        found,
        Coordinate::Deflection,
        off.abs(),
        Note::InstrumentOff,
    );
    Some(Suspicion {
        finding: Finding::GainOrClearances {
            channel,
            deviation,
            z_score,
        },
        doubts: Vec::from_iter(doubt),
    })
}

/// The gain that is off of those that are as stated but for their uncertainty, with what it leaves open.
pub fn wrong_gain(found: &MethodFit, nominal: &Nominal) -> Option<Suspicion> {
    let stated = nominal.gain_uncertainty;
    let mut candidates: Vec<Candidate> = candidates(found, nominal);
    candidates.sort_by(|a, b| b.sure().total_cmp(&a.sure()));
    let worst = *candidates.first().filter(|c| c.sure() > SURE)?;
    let also = candidates.get(1).copied();
    let also = also.filter(|c| worst.sure().powi(2) - c.sure().powi(2) < TOLD);
    let finding = match also {
        None => Finding::WrongGain {
            channel: worst.channel,
            deviation: worst.off.by.exp_m1(),
            z_score: worst.off.z_score,
        },
        Some(other) => apart([worst, other]),
    };
    let moved = |parameter: Coordinate, k: &Candidate| {
        let place = found.fit.free.iter().position(|c| *c == parameter)?;
        let together = found.fit.covariance[(place, k.place)] * found.factor;
        Some((together * k.off.by / stated.powi(2)).abs())
    };
    let open = Coordinate::PHYSICAL.into_iter().filter_map(|parameter| {
        let each = [Some(worst), also].into_iter().flatten();
        let by = each
            .filter_map(|k| moved(parameter, &k))
            .fold(0.0, f64::max);
        Doubt::material(found, parameter, by, Note::InstrumentOff)
    });
    Some(Suspicion {
        finding,
        doubts: open.collect(),
    })
}

/// Two gains of which one is off, the one that reads more first.
fn apart([a, b]: [Candidate; 2]) -> Finding {
    let [high, low] = if a.off.by > b.off.by { [a, b] } else { [b, a] };
    let deviation = 0.5 * (high.off.by - low.off.by);
    Finding::GainsApart {
        channels: [high.channel, low.channel],
        deviation: deviation.exp_m1(),
        z_score: a.sure(),
    }
}

fn candidates(found: &MethodFit, nominal: &Nominal) -> Vec<Candidate> {
    let places = found.fit.free.iter().enumerate();
    let of = |(place, coordinate): (usize, &Coordinate)| {
        let index = coordinate.gain()?;
        if nominal.open_gains[index].is_some() {
            return None;
        }
        let stated = Prior::new(*coordinate, 0.0, nominal.gain_uncertainty);
        Some(Candidate {
            channel: *GAIN_ROLES.get(index)?,
            place,
            off: off_stated::alone(found, stated)?,
        })
    };
    places.filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use impact_fit::fixture::fitted;
    use impact_fit::parameters::Parameters;

    const STATED: f64 = 5e-3;

    fn stated() -> Nominal {
        Nominal {
            gain_uncertainty: STATED,
            ..Nominal::default()
        }
    }

    /// A fit of `x_st` and gains that are off by `true_errors`, of which the data know each one's sum with
    /// ln `x_st` within 1e-4, and `x_st` itself not at all.
    fn found(true_errors: &[f64]) -> MethodFit {
        let count = true_errors.len();
        // Unknowns: ln x_st, then the gains. Information of the data and of the priors.
        let mut information = DMatrix::zeros(count + 1, count + 1);
        let mut score = nalgebra::DVector::zeros(count + 1);
        let weight = 1e8;
        for (i, error) in true_errors.iter().enumerate() {
            for (a, b) in [(0, 0), (0, i + 1), (i + 1, 0), (i + 1, i + 1)] {
                information[(a, b)] += weight;
            }
            score[0] += weight * error;
            score[i + 1] += weight * error;
            information[(i + 1, i + 1)] += STATED.powi(-2);
        }
        let covariance = information.try_inverse().expect("regular");
        let solution: nalgebra::DVector<f64> = &covariance * score;
        let mut free = vec![Coordinate::Deflection];
        let mut parameters = Parameters::symmetric(0.8, 12.0, 0.05, solution[0].exp());
        for i in 0..count {
            free.push(Coordinate::Gain(i));
            parameters = parameters.with(Coordinate::Gain(i), solution[i + 1]);
        }
        fitted(parameters, free, covariance)
    }

    #[test]
    fn of_two_gains_the_data_do_not_tell_which_is_off() {
        let suspicion = wrong_gain(&found(&[0.05, 0.0]), &stated()).expect("a suspicion");
        let Finding::GainsApart {
            channels,
            deviation,
            z_score,
        } = suspicion.finding
        else {
            panic!("{suspicion:?}");
        };
        assert_eq!(channels, [Role::VelocityX, Role::VelocityY]);
        assert!((deviation - 0.05f64.exp_m1()).abs() < 1e-4, "{deviation}");
        // 5 % over √2 · 0.5 %
        assert!((z_score - 7.07).abs() < 0.01, "{z_score}");
        // x_st is off by half of it one way or the other
        let doubt = &suspicion.doubts[0];
        assert_eq!(doubt.parameter, Coordinate::Deflection);
        assert!((doubt.by - 0.025).abs() < 1e-4, "{doubt:?}");
    }

    #[test]
    fn of_three_gains_the_one_that_is_off_is_named() {
        let suspicion = wrong_gain(&found(&[0.0, -0.05, 0.0]), &stated()).expect("a suspicion");
        let Finding::WrongGain {
            channel, deviation, ..
        } = suspicion.finding
        else {
            panic!("{suspicion:?}");
        };
        assert_eq!(channel, Role::VelocityY);
        assert!((deviation - (-0.05f64).exp_m1()).abs() < 1e-4);
    }

    #[test]
    fn gains_within_what_is_stated_and_what_all_have_in_common_are_not_named() {
        assert!(wrong_gain(&found(&[0.005, 0.0]), &stated()).is_none());
        assert!(wrong_gain(&found(&[0.008, -0.006, 0.003]), &stated()).is_none());
        assert!(wrong_gain(&found(&[0.05, 0.05]), &stated()).is_none());
    }
}
