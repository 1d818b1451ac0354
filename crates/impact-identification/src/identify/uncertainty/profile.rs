//! Profile likelihoods: the least sum of squares at given values of one parameter.

use serde::{Deserialize, Serialize};

use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::solver::least_squares::LeastSquares;
use impact_fit::solver::{Fit, Precision, Problem};

/// Likelihood of one parameter with all others fitted again at each of its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfileCurve {
    /// The parameter.
    pub parameter: Coordinate,
    /// Its values, SI, ascending.
    pub values: Vec<f64>,
    /// Rise of χ² over its least value.
    pub delta_chi2: Vec<f64>,
    /// Where the rise is 3.84: the 95 % interval.
    pub interval95: Option<[f64; 2]>,
}

/// 95 % point of χ² with one degree of freedom.
const CHI2_95: f64 = 3.841_458_820_694_124;
/// Standard errors at which a profile is evaluated.
const OFFSETS: [f64; 12] = [
    -3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0,
];

/// Profile of one coordinate; `None` where the fits beside the optimum fail.
pub(super) fn profile(
    problem: &Problem<'_>,
    fit: &Fit,
    factor: f64,
    coordinate: Coordinate,
) -> Option<ProfileCurve> {
    let error = fit.error(coordinate)? * factor.sqrt();
    let best = fit.parameters.coordinate(coordinate);
    let mut path = Path::new(problem, fit, coordinate)?;
    let mut rise = |k: f64| Some((path.least_cost(k * factor.sqrt())? - fit.cost) / factor);
    let smooth = smooth_rise(&mut rise);
    let mut points: Vec<(f64, f64)> = OFFSETS
        .iter()
        .filter_map(|k| {
            let rise = match smooth {
                Some([cubic, quartic]) => k * k * (1.0 + cubic * k + quartic * k * k),
                None => rise(*k)?,
            };
            Some((best + k * error, rise))
        })
        .collect();
    points.push((best, 0.0));
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let physical = |v: f64| coordinate.physical(v);
    let below: Vec<(f64, f64)> = points
        .iter()
        .rev()
        .filter(|p| p.0 <= best)
        .copied()
        .collect();
    let above: Vec<(f64, f64)> = points.iter().filter(|p| p.0 >= best).copied().collect();
    let ends = reaches(&below).zip(reaches(&above));
    Some(ProfileCurve {
        parameter: coordinate,
        values: points.iter().map(|p| physical(p.0)).collect(),
        delta_chi2: points.iter().map(|p| p.1.max(0.0)).collect(),
        interval95: ends.map(|(a, b)| [physical(a), physical(b)]),
    })
}

/// Greatest difference of a rise from k²(1 + ak + bk²), as a share of k², where it is taken to be that.
const SMOOTH: f64 = 0.01;

/// The coefficients a and b with which the rise k standard errors from the optimum is k²(1 + ak + bk²):
/// by the rises at ±3, where they are those of k² or those at ±1.5 confirm it; `None` where they do not.
fn smooth_rise(mut rise: impl FnMut(f64) -> Option<f64>) -> Option<[f64; 2]> {
    let mut beyond = |k: f64| Some(rise(k)? / (k * k) - 1.0);
    let (below, above) = (beyond(-3.0)?, beyond(3.0)?);
    let [cubic, quartic] = [(above - below) / 6.0, (above + below) / 18.0];
    let is_square = below.abs().max(above.abs()) < SMOOTH;
    let confirmed = is_square
        || [-1.5, 1.5].into_iter().all(|k| {
            beyond(k).is_some_and(|found| (found - (cubic + quartic * k) * k).abs() < SMOOTH)
        });
    confirmed.then_some([cubic, quartic])
}

/// Where a rise along points away from the optimum reaches [`CHI2_95`]; interpolated in its root,
/// which is nearly a straight line.
fn reaches(points: &[(f64, f64)]) -> Option<f64> {
    points.windows(2).find_map(|w| {
        let (a, b) = (w[0].1.max(0.0).sqrt(), w[1].1.max(0.0).sqrt());
        let level = CHI2_95.sqrt();
        (a <= level && level < b).then(|| w[0].0 + (w[1].0 - w[0].0) * (level - a) / (b - a))
    })
}

/// Share of a rise of the cost to which it is known where the problem is nearly linear.
const NEARLY: f64 = 0.02;

/// Where the other coordinates go as one is moved away from its fitted value.
struct Path<'a> {
    fit: &'a Fit,
    /// Place of the moved coordinate among the free ones.
    place: usize,
    /// The others' problem.
    others: Problem<'a>,
    /// What the others change by beside their straight path, per square of the coordinate's standard
    /// error: found where the straight path does not lead to the least cost.
    bend: Option<Vec<f64>>,
}

impl<'a> Path<'a> {
    /// Of one of a fit's coordinates; `None` if it was not free.
    fn new(problem: &Problem<'a>, fit: &'a Fit, coordinate: Coordinate) -> Option<Self> {
        let free = fit.free.iter().copied();
        Some(Self {
            fit,
            place: fit.free.iter().position(|c| *c == coordinate)?,
            others: problem
                .over(free.filter(|c| *c != coordinate).collect())
                .with_precision(Precision::Start),
            bend: None,
        })
    }

    /// Where the coordinate is so many standard errors away, and the others where they are expected.
    fn at(&self, k: f64) -> Parameters {
        let covariance = &self.fit.covariance;
        let error = covariance[(self.place, self.place)].sqrt();
        let mut at = self.fit.parameters;
        for (i, free) in self.fit.free.iter().enumerate() {
            let share = covariance[(i, self.place)] / error;
            at = at.with(*free, at.coordinate(*free) + share * k);
        }
        let bend = self.bend.iter().flatten().map(|b| b * k * k);
        let others = self.others.free.iter().zip(bend);
        others.fold(at, |at, (c, change)| {
            at.with(*c, at.coordinate(*c) + change)
        })
    }

    /// Least cost with the coordinate so many standard errors, for residuals of unit variance, away from its
    /// fitted value; `None` if no fit is found.
    fn least_cost(&mut self, k: f64) -> Option<f64> {
        let start = self.at(k);
        // If the problem is nearly linear, the others are already at their fitted values up to
        // second order, and the cost is right up to fourth.
        let linear = k * k;
        if let Some(cost) = self.others.cost(&start)
            && (cost - self.fit.cost - linear).abs() < NEARLY * linear
        {
            return Some(cost);
        }
        self.cost_of_one_step(&start, k)
            .or_else(|| Some(self.others.fit(start).ok()?.cost))
    }

    /// Least cost as the residuals and slopes at a point predict it: of a step shorter than a standard
    /// error the prediction, of a longer one the cost where it leads, if that is nearly as predicted;
    /// `None` if it is not, or if an item has no model there.
    fn cost_of_one_step(&mut self, at: &Parameters, k: f64) -> Option<f64> {
        let factor = self.others.factor(at).ok()?;
        let step = factor.step(0.0, &vec![0.0; factor.unknowns()])?;
        let length = factor.length(&step);
        let predicted = factor.cost() - length * length;
        self.bend
            .get_or_insert_with(|| step.iter().map(|s| s / (k * k)).collect());
        if length < 1.0 {
            return Some(predicted);
        }
        let cost = self.others.cost(&self.others.moved(at, &step))?;
        ((cost - predicted).abs() < NEARLY * k * k).then_some(cost)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use impact_fit::solver::Block;
    use impact_fit::solver::block::difference;

    /// One measurement of R and one of ln β less a square of R's deviation; counts what is asked for.
    #[derive(Default)]
    struct Curved {
        slopes: AtomicUsize,
    }

    const ERROR: f64 = 0.01;

    impl Block for Curved {
        fn items(&self) -> usize {
            1
        }

        fn residuals(&self, _: usize, at: &Parameters) -> Option<Vec<f64>> {
            let k = (at.restitution - 0.8) / ERROR;
            let damping = at.coordinate(Coordinate::Damping) - 0.05f64.ln();
            Some(vec![k, (damping - 0.02 * k * k) / ERROR])
        }

        fn slopes(
            &self,
            item: usize,
            at: &Parameters,
            coordinates: &[Coordinate],
        ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
            self.slopes.fetch_add(1, Ordering::Relaxed);
            let here = self.residuals(item, at)?;
            let slope = |c: &Coordinate| difference(at, *c, &here, |p| self.residuals(item, p));
            let columns = coordinates.iter().map(slope).collect::<Option<_>>()?;
            Some((here, columns))
        }

        fn touches(&self, coordinate: Coordinate) -> bool {
            matches!(coordinate, Coordinate::Restitution | Coordinate::Damping)
        }
    }

    #[test]
    fn valid_others_follow_a_bent_path_with_slopes_at_one_of_its_points() {
        let block = Curved::default();
        let free = vec![Coordinate::Restitution, Coordinate::Damping];
        let problem = Problem::of(vec![(&block, 1.0)], free);
        let start = Parameters::symmetric(0.8, 10.0, 0.05, 1e-3);
        let fit = problem.fit(start).expect("a fit");
        let mut path = Path::new(&problem, &fit, Coordinate::Restitution).expect("free");
        let before = block.slopes.load(Ordering::Relaxed);
        for k in [-3.0, 3.0, -1.5, 0.5] {
            let rise = path.least_cost(k).expect("a fit") - fit.cost;
            assert!((rise - k * k).abs() < 1e-6, "{k}: {rise}");
        }
        assert_eq!(block.slopes.load(Ordering::Relaxed) - before, 1);
        let curve = profile(&problem, &fit, 1.0, Coordinate::Restitution).expect("a profile");
        let [low, high] = curve.interval95.expect("ends");
        assert!(
            (high - 0.8 - 1.959_964 * ERROR).abs() < 1e-4 * ERROR,
            "{high}"
        );
        assert!(
            (low - 0.8 + 1.959_964 * ERROR).abs() < 1e-4 * ERROR,
            "{low}"
        );
    }

    #[test]
    fn a_rise_that_is_nearly_a_square_is_told_by_four_of_its_points() {
        let rise = smooth_rise(|k| Some(k * k * (1.0 + 0.02 * k + 0.003 * k * k)));
        let [cubic, quartic] = rise.expect("smooth");
        assert!((cubic - 0.02).abs() < 1e-12 && (quartic - 0.003).abs() < 1e-12);
        // A kink between the points, and a point without a fit.
        assert_eq!(smooth_rise(|k| Some(k * k + k.abs())), None);
        assert_eq!(smooth_rise(|k| (k < 2.0).then_some(k * k)), None);
    }
}
