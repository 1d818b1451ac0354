//! The comparison of campaigns: differences, what they share, and whether anything changed.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::compare::campaign::Known;
use crate::compare::share::{SeparateNuisance, SharedNuisance, sharing};
use crate::compare::stack::Stack;
use crate::compare::{Campaign, ComparisonOutcome, ComparisonRemark, decision};
use impact_fit::parameters::coordinate::Coordinate;
use impact_fit::solver::normal::inverse;
use impact_fit::statistics::distribution::{fisher_tail, student_tail};
use impact_fit::statistics::quantile::student_975;
use impact_fit::{ParameterSet, VerdictKind};
use impact_records::event::{FlightKind, RigKind};

/// What is shown of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonSummary {
    /// Its name.
    pub name: String,
    /// When it was measured, in words.
    pub measured: Option<String>,
    /// Whether its records are simulated.
    pub synthetic: bool,
    /// The verdict on it.
    pub verdict: VerdictKind,
    /// Its joint estimates.
    pub parameters: ParameterSet,
}

/// The difference of one parameter between a campaign and the first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// The campaign, by its number from 0; the first is the reference.
    pub campaign: usize,
    /// The parameter.
    pub parameter: Coordinate,
    /// Value minus the reference's, SI.
    pub value: f64,
    /// Standard error, SI.
    pub standard_error: f64,
    /// 95 % interval, SI.
    pub interval95: [f64; 2],
    /// The same relative to the reference's value: difference, low, high.
    pub relative: [f64; 3],
    /// Degrees of freedom of the interval; `None`: infinitely many.
    pub degrees_of_freedom: Option<f64>,
    /// 95 % interval as it would be if the campaigns shared nothing, SI.
    pub independent_interval95: [f64; 2],
    /// Probability of a difference at least as great if nothing changed.
    pub p_value: f64,
}

/// A test of the hypothesis that nothing changed: Hotelling's, as Fisher's F of all differences together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EqualityTest {
    /// Mean square of the differences over their covariance.
    pub statistic: f64,
    /// Number of differences.
    pub differences: usize,
    /// Degrees of freedom of the covariance; `None`: infinitely many.
    pub degrees_of_freedom: Option<f64>,
    /// Probability of differences at least as great if nothing changed.
    pub p_value: f64,
}

/// The comparison of campaigns: comparison.json.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The campaigns in the order given.
    pub campaigns: Vec<ComparisonSummary>,
    /// The differences from the first, campaign by campaign.
    pub differences: Vec<Difference>,
    /// The test of nothing having changed by all differences together; `None` where that cannot be determined.
    pub unchanged: Option<EqualityTest>,
    /// The same by each parameter alone.
    pub unchanged_by_parameter: Vec<(Coordinate, EqualityTest)>,
    /// What the campaigns share.
    pub shared: Vec<SharedNuisance>,
    /// What two of them do not share although something suggests it.
    pub separate: Vec<SeparateNuisance>,
    /// What to keep in mind.
    pub remarks: Vec<ComparisonRemark>,
}

impl Comparison {
    /// Probability of differences at least as great if nothing changed, by each of them alone and by all
    /// together, corrected for their number; `None` where that cannot be determined.
    pub fn p_value(&self) -> Option<f64> {
        decision::of_no_change(self.unchanged.map(|test| test.p_value), &self.p_values())
    }

    /// Whether anything changed, and what.
    pub fn outcome(&self) -> ComparisonOutcome {
        let Some(p_value) = self.p_value() else {
            return ComparisonOutcome::Undetermined;
        };
        if !decision::is_significant(p_value) {
            return ComparisonOutcome::NothingChanged;
        }
        let parameters = self.changed();
        if parameters.is_empty() {
            ComparisonOutcome::ChangedTogether
        } else {
            ComparisonOutcome::Changed { parameters }
        }
    }

    /// The parameters of which a difference alone shows a change.
    fn changed(&self) -> Vec<Coordinate> {
        let significant = decision::significant(&self.p_values());
        let shown = self.differences.iter().zip(significant);
        let shown: Vec<Coordinate> = shown
            .filter_map(|(d, significant)| significant.then_some(d.parameter))
            .collect();
        let all = Coordinate::PHYSICAL.into_iter();
        all.filter(|parameter| shown.contains(parameter)).collect()
    }

    /// Of each difference alone.
    fn p_values(&self) -> Vec<f64> {
        self.differences.iter().map(|d| d.p_value).collect()
    }
}

/// Why campaigns cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ComparisonError {
    /// There are fewer than two.
    #[error("there is {0} campaign to compare")]
    TooFew(usize),
    /// One has two masses, the other one.
    #[error("'{first}' has {of_first}, '{second}' has {of_second}: their parameters are not the same quantities", of_first = machine(*.0), of_second = machine(*.1), first = .2[0], second = .2[1])]
    Machines(RigKind, RigKind, [String; 2]),
    /// One is driven, in the other a constant force acts.
    #[error("'{first}' has {of_first}, '{second}' has {of_second}: their parameters are not the same quantities", of_first = flight(*.0), of_second = flight(*.1), first = .2[0], second = .2[1])]
    Flights(FlightKind, FlightKind, [String; 2]),
    /// They have the same records.
    #[error("'{first}' and '{second}' are the same measurement", first = .0[0], second = .0[1])]
    Same([String; 2]),
    /// No parameter is known in the first and in another.
    #[error("no parameter is known both in '{0}' and in another campaign")]
    NothingCommon(String),
    /// The covariances cannot be combined.
    #[error("the covariances of the joint fits cannot be combined")]
    Singular,
}

fn machine(kind: RigKind) -> &'static str {
    match kind {
        RigKind::Double => "two masses",
        RigKind::Single => "one mass against a stop",
    }
}

fn flight(kind: FlightKind) -> &'static str {
    match kind {
        FlightKind::Harmonic => "springs and a harmonic drive",
        FlightKind::ConstantForce => "a constant force",
    }
}

impl ComparisonError {
    /// What the user can do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::TooFew(_) => "give two or more results folders, or campaign.toml files",
            Self::Machines(..) | Self::Flights(..) => {
                "compare campaigns of one kind of rig; check machine and flight in their campaign.toml"
            }
            Self::Same(_) => "give each measurement once",
            Self::NothingCommon(_) => {
                "read the campaigns' own reports: they say why a parameter is not identifiable"
            }
            Self::Singular => {
                "read the campaigns' own reports: one of them does not determine its parameters"
            }
        }
    }
}

/// Compare campaigns with the first of them.
///
/// # Errors
/// [`ComparisonError`] where they cannot be compared.
pub fn compare(campaigns: &[Campaign]) -> Result<Comparison, ComparisonError> {
    comparable(campaigns)?;
    let sharing = sharing(campaigns);
    let stack = Stack::new(campaigns, &sharing).ok_or(ComparisonError::Singular)?;
    let all = Contrasts::new(campaigns, &stack);
    if all.list.is_empty() {
        return Err(ComparisonError::NothingCommon(campaigns[0].name.clone()));
    }
    let by_parameter = Coordinate::PHYSICAL.into_iter().filter_map(|parameter| {
        let of = |c: &Contrast| c.parameter == parameter;
        Some((parameter, all.unchanged(of)?))
    });
    let shared: Vec<SharedNuisance> = sharing.shared.into_iter().map(|s| s.1).collect();
    Ok(Comparison {
        campaigns: campaigns.iter().map(summary).collect(),
        differences: (0..all.list.len()).map(|i| all.difference(i)).collect(),
        unchanged: all.unchanged(|_| true),
        unchanged_by_parameter: by_parameter.collect(),
        remarks: remarks(campaigns, &shared),
        shared,
        separate: sharing.separate,
    })
}

fn summary(campaign: &Campaign) -> ComparisonSummary {
    ComparisonSummary {
        name: campaign.name.clone(),
        measured: campaign.measured.clone(),
        synthetic: campaign.synthetic,
        verdict: campaign.verdict,
        parameters: campaign.parameters.clone(),
    }
}

/// Whether campaigns have the same quantities and are not the same.
fn comparable(campaigns: &[Campaign]) -> Result<(), ComparisonError> {
    let [first, others @ ..] = campaigns else {
        return Err(ComparisonError::TooFew(0));
    };
    if others.is_empty() {
        return Err(ComparisonError::TooFew(1));
    }
    for other in others {
        let names = || [first.name.clone(), other.name.clone()];
        if first.machine != other.machine {
            let (a, b) = (first.machine, other.machine);
            return Err(ComparisonError::Machines(a, b, names()));
        }
        if first.flight != other.flight {
            let (a, b) = (first.flight, other.flight);
            return Err(ComparisonError::Flights(a, b, names()));
        }
    }
    for (i, a) in campaigns.iter().enumerate() {
        let same = |b: &&Campaign| a.fit.is_some() && same_fit(a, b);
        if let Some(b) = campaigns[i + 1..].iter().find(same) {
            return Err(ComparisonError::Same([a.name.clone(), b.name.clone()]));
        }
    }
    Ok(())
}

/// Whether two campaigns have the same records: no two measurements have the same noise.
fn same_fit(a: &Campaign, b: &Campaign) -> bool {
    let found = |c: &Campaign| c.fit.as_ref().map(|f| (f.fit.cost, f.fit.parameters));
    found(a) == found(b)
}

fn remarks(campaigns: &[Campaign], shared: &[SharedNuisance]) -> Vec<ComparisonRemark> {
    let poor = campaigns
        .iter()
        .filter(|c| c.verdict == VerdictKind::DoesNotFit);
    let poor = poor.map(|c| ComparisonRemark::CampaignDoesNotFit {
        campaign: c.name.clone(),
        verdict: c.verdict,
    });
    let alone = campaigns.iter().filter(|c| c.fit.is_none());
    let alone = alone.map(|c| ComparisonRemark::NoJointFit {
        campaign: c.name.clone(),
    });
    let fitted = campaigns.iter().all(|c| c.fit.is_some());
    let nothing = (fitted && shared.is_empty()).then_some(ComparisonRemark::NothingShared);
    poor.chain(alone).chain(nothing).collect()
}

/// One parameter of one campaign against that of the first.
struct Contrast {
    campaign: usize,
    parameter: Coordinate,
    /// The places of the reference's and the campaign's value.
    places: [usize; 2],
    /// What is known of each by its own campaign alone.
    known: [Known; 2],
    /// Variance of each beyond the covariance of its fit.
    beyond: [f64; 2],
}

impl Contrast {
    /// The values in SI units, and how much each changes per unit of its coordinate.
    fn scales(&self, coordinates: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let values = coordinates.map(|c| self.parameter.physical(c));
        (values, values.map(|v| self.parameter.slope(v)))
    }

    /// The difference in SI units and its variance.
    fn si(&self, stack: &Stack) -> [f64; 2] {
        let (values, slopes) = self.scales(self.places.map(|place| stack.value(place)));
        let mut row = DMatrix::zeros(1, stack.unknowns());
        row[(0, self.places[0])] = -slopes[0];
        row[(0, self.places[1])] = slopes[1];
        let beyond = slopes.iter().zip(self.beyond).map(|(s, b)| s * s * b);
        let variance = stack.covariance_of(&row)[(0, 0)] + beyond.sum::<f64>();
        [values[1] - values[0], variance]
    }

    /// The same if the campaigns shared nothing, with the degrees of freedom of the variance.
    fn si_alone(&self) -> ([f64; 2], f64) {
        let (values, slopes) = self.scales(self.known.map(|k| k.value));
        let variances = [0, 1].map(|i| slopes[i].powi(2) * self.known[i].variance);
        let sum: f64 = variances.iter().sum();
        let uncertain = variances.iter().zip(self.known);
        let uncertain: f64 = uncertain.map(|(v, k)| v * v / k.freedom).sum();
        ([values[1] - values[0], sum], sum * sum / uncertain)
    }
}

/// All contrasts with their covariance: of R itself, of the other parameters the logarithm, in which the gains
/// that two campaigns share cancel.
struct Contrasts {
    list: Vec<Contrast>,
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    /// The same differences in SI units, each with its variance: there a shared gain cancels only as far as the
    /// two values are equal.
    si: Vec<[f64; 2]>,
}

impl Contrasts {
    fn new(campaigns: &[Campaign], stack: &Stack) -> Self {
        let others = 1..campaigns.len();
        let pairs = others.flat_map(|k| Coordinate::PHYSICAL.into_iter().map(move |p| (k, p)));
        let list: Vec<Contrast> = pairs
            .filter_map(|(campaign, parameter)| {
                let both = [&campaigns[0], &campaigns[campaign]];
                let [reference, other] = both.map(|c| c.known(parameter));
                let places = [0, campaign].map(|k| stack.place(k, parameter));
                Some(Contrast {
                    campaign,
                    parameter,
                    places: [places[0]?, places[1]?],
                    known: [reference?, other?],
                    beyond: both.map(|c| beyond(c, parameter)),
                })
            })
            .collect();
        let values = list.iter().map(|c| {
            let [reference, other] = c.places.map(|place| stack.value(place));
            other - reference
        });
        let values = DVector::from_iterator(list.len(), values);
        let mut rows = DMatrix::zeros(list.len(), stack.unknowns());
        for (i, contrast) in list.iter().enumerate() {
            let [reference, other] = contrast.places;
            rows[(i, reference)] -= 1.0;
            rows[(i, other)] += 1.0;
        }
        let mut covariance = stack.covariance_of(&rows);
        for (i, a) in list.iter().enumerate() {
            covariance[(i, i)] += a.beyond[1];
            let same = list.iter().enumerate();
            for (k, _) in same.filter(|(_, b)| b.parameter == a.parameter) {
                covariance[(i, k)] += a.beyond[0];
            }
        }
        Self {
            si: list.iter().map(|c| c.si(stack)).collect(),
            list,
            values,
            covariance,
        }
    }

    /// Degrees of freedom of a contrast's variance (Welch and Satterthwaite).
    fn freedom(&self, i: usize) -> f64 {
        let uncertain = self.list[i].known.iter();
        let uncertain = uncertain.map(|k| k.variance.powi(2) / k.freedom);
        self.covariance[(i, i)].powi(2) / uncertain.sum::<f64>()
    }

    fn difference(&self, i: usize) -> Difference {
        let contrast = &self.list[i];
        let freedom = self.freedom(i);
        let quantile = student_975(freedom);
        let interval = |[value, variance]: [f64; 2], quantile: f64| {
            let half = quantile * variance.sqrt();
            [value - half, value + half]
        };
        let (alone, alone_freedom) = contrast.si_alone();
        let [value, variance] = self.si[i];
        let (coordinate, error) = (self.values[i], self.covariance[(i, i)].sqrt());
        let [low, high] = interval([coordinate, error * error], quantile);
        let relative = |difference: f64| {
            if contrast.parameter.is_logarithm() {
                difference.exp_m1()
            } else {
                difference / contrast.known[0].value
            }
        };
        Difference {
            campaign: contrast.campaign,
            parameter: contrast.parameter,
            value,
            standard_error: variance.sqrt(),
            interval95: interval([value, variance], quantile),
            relative: [coordinate, low, high].map(relative),
            degrees_of_freedom: Some(freedom).filter(|f| f.is_finite()),
            independent_interval95: interval(alone, student_975(alone_freedom)),
            p_value: student_tail(coordinate / error, freedom),
        }
    }

    /// The test of nothing having changed in some contrasts; `None` where their covariance is singular.
    fn unchanged(&self, tested: impl Fn(&Contrast) -> bool) -> Option<EqualityTest> {
        let all = self.list.iter().enumerate();
        let chosen: Vec<usize> = all.filter(|(_, c)| tested(c)).map(|(i, _)| i).collect();
        let count = chosen.len();
        if count == 0 {
            return None;
        }
        let part = DMatrix::from_fn(count, count, |i, k| self.covariance[(chosen[i], chosen[k])]);
        let values = DVector::from_fn(count, |i, _| self.values[chosen[i]]);
        let square = (values.transpose() * inverse(&part)? * &values)[(0, 0)];
        let freedom = chosen.iter().map(|i| self.freedom(*i));
        let least = freedom.fold(f64::INFINITY, f64::min);
        // Hotelling's T² with n degrees of freedom is q n/(n − q + 1) times F with q and n − q + 1.
        let rest = (least - count as f64 + 1.0).max(1.0);
        let statistic = if least.is_finite() {
            square * rest / (least.max(rest) * count as f64)
        } else {
            square / count as f64
        };
        Some(EqualityTest {
            statistic,
            differences: count,
            degrees_of_freedom: Some(rest).filter(|f| f.is_finite()),
            p_value: fisher_tail(statistic, count as f64, rest),
        })
    }
}

/// Variance of a parameter by all that its interval allows for beyond the covariance of its fit.
fn beyond(campaign: &Campaign, parameter: Coordinate) -> f64 {
    let fit = campaign.fit.as_ref();
    let in_fit = fit.and_then(|f| Some(f.fit.error(parameter)?.powi(2) * f.variance_factor));
    let known = campaign.known(parameter).map(|k| k.variance);
    match (known, in_fit) {
        (Some(all), Some(covariance)) => (all - covariance).max(0.0),
        _ => 0.0,
    }
}
