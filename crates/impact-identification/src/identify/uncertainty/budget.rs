//! The budget of a joint estimate's uncertainty in the manner of the GUM (JCGM 100): a row for each
//! source, with what it contributes to each parameter.
//!
//! With the joint covariance C = A⁻¹ and the information `F_s` of a source (a block of residuals, or the
//! prior of a stated uncertainty), its contribution to the variance of parameter i is (C `F_s` C)_ii;
//! as A is the sum of all `F_s`, the contributions add up to `C_ii`. Of a prior of standard uncertainty u
//! on coordinate k that is c²u² with the sensitivity c = `C_ik/u²`.

use serde::{Deserialize, Serialize};

use impact_fit::method::Method;
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::Coordinate;
use impact_fit::solver::Problem;
use impact_fit::statistics::quantile::NORMAL_975;

/// Where an uncertainty comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case", tag = "kind")]
#[strum(serialize_all = "snake_case")]
pub enum UncertaintySource {
    /// Noise of what a method measures.
    Noise {
        /// The method.
        method: Method,
    },
    /// Scatter between groups of records beyond noise and what is stated.
    BetweenGroups {
        /// Number of groups.
        groups: usize,
    },
    /// What is stated of an instrument, of the rig, or accepted of an effect beyond the model.
    Stated {
        /// The coordinate of the fit.
        coordinate: Coordinate,
        /// The clearance as stated, m, of an error of a single clearance.
        clearance_m: Option<f64>,
    },
    /// What the first order of the effects beyond the model does not hold.
    FirstOrder,
    /// Gains of two sensors of one mass that may have been calibrated together.
    SharedGains,
    /// A small change of R with the speed.
    RestitutionOverSpeed,
    /// Disagreement between methods beyond their uncertainties.
    BetweenMethods,
    /// What is stated of the sampler's clock.
    Clock,
    /// An instrument that is off, as a finding says.
    InstrumentOff,
}

/// What a source beside the fit leaves open: standard uncertainties, of R absolute, of the others relative.
#[derive(Debug, Clone, PartialEq)]
pub struct Further {
    source: UncertaintySource,
    open: Vec<(Coordinate, f64)>,
}

impl Further {
    /// Of a source.
    pub fn new(source: UncertaintySource, open: Vec<(Coordinate, f64)>) -> Self {
        Self { source, open }
    }

    fn of(&self, parameter: Coordinate) -> f64 {
        let own = self.open.iter().filter(|(c, _)| *c == parameter);
        own.map(|(_, u)| u * u).sum::<f64>().sqrt()
    }

    /// Its row, of a joint fit of so many methods.
    fn row(&self, estimated: &[(usize, Coordinate)], methods: usize) -> Row {
        let by_methods = self.source == UncertaintySource::BetweenMethods;
        let (evaluation, freedom) = if by_methods {
            (Evaluation::A, Some(methods.saturating_sub(1).max(1) as f64))
        } else {
            (Evaluation::B, None)
        };
        let of_clock = (self.source == UncertaintySource::Clock).then_some(1.0);
        Row {
            source: self.source,
            evaluation,
            standard_uncertainty: of_clock.and(self.open.first()).map(|(_, u)| *u),
            degrees_of_freedom: freedom,
            contributions: contributions(estimated, |_, c| {
                let own = self.of(c);
                (of_clock.filter(|_| own > 0.0), own)
            }),
        }
    }
}

/// How an uncertainty was evaluated: from the scatter of observations, or otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Evaluation {
    /// By statistics.
    A,
    /// By other means.
    B,
}

/// What a source contributes to one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contribution {
    /// The parameter.
    pub parameter: Coordinate,
    /// Change of the parameter per unit of the source (of R absolute, of the others relative); `None`
    /// where the source is not one quantity.
    pub sensitivity: Option<f64>,
    /// Standard uncertainty that it contributes: of R absolute, of the others relative.
    pub uncertainty: f64,
}

/// One source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The source.
    #[serde(flatten)]
    pub source: UncertaintySource,
    /// How it was evaluated.
    pub evaluation: Evaluation,
    /// Standard uncertainty of the source as stated, in the unit of its coordinate; `None` of noise.
    pub standard_uncertainty: Option<f64>,
    /// Degrees of freedom; `None`: infinitely many.
    pub degrees_of_freedom: Option<f64>,
    /// Contributions to R, f0, β, `x_st`.
    pub contributions: Vec<Contribution>,
}

/// The combined uncertainty of one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Combined {
    /// The parameter.
    pub parameter: Coordinate,
    /// Combined standard uncertainty: of R absolute, of the others relative.
    pub standard_uncertainty: f64,
    /// Effective degrees of freedom (Welch and Satterthwaite); `None`: infinitely many.
    pub degrees_of_freedom: Option<f64>,
    /// Coverage factor k for 95 %.
    pub coverage_factor: f64,
    /// Expanded uncertainty U = k u.
    pub expanded_uncertainty: f64,
}

/// The budget of the joint estimate.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// The sources.
    pub rows: Vec<Row>,
    /// What they amount to.
    pub combined: Vec<Combined>,
}

/// Number that JSON can hold; `None` where infinite.
fn finite(freedom: f64) -> Option<f64> {
    freedom.is_finite().then_some(freedom)
}

/// The budget of a joint fit of a problem whose blocks belong to the methods, with what is open beside the
/// fit.
pub fn budget(
    problem: &Problem<'_>,
    methods: &[Method],
    found: &MethodFit,
    blocks: &Blocks,
    further: &[Further],
) -> Budget {
    let estimated = found.fit.estimated();
    let mut rows = noise_rows(methods, found, &estimated);
    rows.extend(stated_rows(problem, found, blocks, &estimated));
    let spreads: Vec<_> = estimated
        .iter()
        .filter_map(|(_, c)| found.spread(*c))
        .collect();
    let freedom = spreads
        .iter()
        .map(|s| s.freedom)
        .fold(f64::INFINITY, f64::min);
    rows.push(Row {
        source: UncertaintySource::BetweenGroups {
            groups: found.scatter.groups,
        },
        evaluation: Evaluation::A,
        standard_uncertainty: None,
        degrees_of_freedom: finite(freedom),
        contributions: contributions(&estimated, |_, c| {
            (None, found.spread(c).map_or(0.0, |s| s.between_groups))
        }),
    });
    rows.push(Row {
        source: UncertaintySource::FirstOrder,
        evaluation: Evaluation::B,
        standard_uncertainty: None,
        degrees_of_freedom: None,
        contributions: contributions(&estimated, |_, c| {
            (None, found.first_order(c).unwrap_or(0.0))
        }),
    });
    if !found.shared_gains.is_empty() {
        rows.push(Row {
            source: UncertaintySource::SharedGains,
            evaluation: Evaluation::B,
            standard_uncertainty: None,
            degrees_of_freedom: None,
            contributions: contributions(&estimated, |_, c| (None, found.by_shared_gains(c))),
        });
    }
    let present = further.iter().filter(|f| !f.open.is_empty());
    rows.extend(present.map(|f| f.row(&estimated, methods.len())));
    let apart = |c: Coordinate| further.iter().map(|f| f.of(c)).fold(0.0, f64::hypot);
    let combined = estimated.iter().filter_map(|(_, parameter)| {
        let spread = found.spread(*parameter)?;
        let further = apart(*parameter);
        let whole = spread.with(further);
        // as the estimate's interval is widened
        let expanded_uncertainty = spread.half95().hypot(NORMAL_975 * further);
        Some(Combined {
            parameter: *parameter,
            standard_uncertainty: whole.error,
            degrees_of_freedom: finite(whole.freedom),
            coverage_factor: expanded_uncertainty / whole.error,
            expanded_uncertainty,
        })
    });
    Budget {
        combined: combined.collect(),
        rows,
    }
}

/// The noise of each method's residuals.
fn noise_rows(
    methods: &[Method],
    found: &MethodFit,
    estimated: &[(usize, Coordinate)],
) -> Vec<Row> {
    let fit = &found.fit;
    let covariance = &fit.covariance * found.factor;
    let mut rows = Vec::new();
    for (method, part) in methods.iter().zip(&found.parts) {
        let spread = &fit.covariance * &part.matrix * &covariance;
        rows.push(Row {
            source: UncertaintySource::Noise { method: *method },
            evaluation: Evaluation::A,
            standard_uncertainty: None,
            degrees_of_freedom: finite(part.count.saturating_sub(fit.free.len()).max(1) as f64),
            contributions: contributions(estimated, |i, _| (None, spread[(i, i)].max(0.0).sqrt())),
        });
    }
    rows
}

/// What the laboratory states with an uncertainty.
fn stated_rows(
    problem: &Problem<'_>,
    found: &MethodFit,
    blocks: &Blocks,
    estimated: &[(usize, Coordinate)],
) -> Vec<Row> {
    let fit = &found.fit;
    let covariance = &fit.covariance * found.factor;
    let mut rows = Vec::new();
    for prior in &problem.priors {
        let Some(k) = fit.free.iter().position(|c| *c == prior.coordinate) else {
            continue;
        };
        // The wide priors of the parameters themselves state nothing.
        if Coordinate::PHYSICAL.contains(&prior.coordinate) {
            continue;
        }
        let sensitivity = |i: usize| covariance[(i, k)] / prior.deviation.powi(2) / found.factor;
        let size = prior.deviation * found.factor.sqrt();
        rows.push(Row {
            source: UncertaintySource::Stated {
                coordinate: prior.coordinate,
                clearance_m: match prior.coordinate {
                    Coordinate::Gap(i) => blocks.gaps_m.get(i).copied(),
                    _ => None,
                },
            },
            evaluation: Evaluation::B,
            standard_uncertainty: Some(prior.deviation),
            degrees_of_freedom: None,
            contributions: contributions(estimated, |i, _| {
                (Some(sensitivity(i)), (sensitivity(i) * size).abs())
            }),
        });
    }
    rows
}

fn contributions(
    estimated: &[(usize, Coordinate)],
    of: impl Fn(usize, Coordinate) -> (Option<f64>, f64),
) -> Vec<Contribution> {
    let each = estimated.iter().map(|(i, parameter)| {
        let (sensitivity, uncertainty) = of(*i, *parameter);
        Contribution {
            parameter: *parameter,
            sensitivity,
            uncertainty,
        }
    });
    each.collect()
}
