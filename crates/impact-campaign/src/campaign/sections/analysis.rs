//! `[analysis]`: what is left out, what is looked for, and how intervals are found.

use serde::{Deserialize, Serialize};

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::values::{Placed, WrittenQuantity, value};
use impact_fit::evidence::options::IntervalMethod;
use labfiles::units::Dimension;

keys! {
    /// `[analysis]`.
    #[serde(default)]
    pub struct AnalysisTable {
        /// records to leave out, by name; `*` and `?` are wildcards
        exclude: Placed<Vec<String>>, default "none",
            init r#"# exclude = ["record_12"]    # records to leave out, by name; * and ? are wildcards"#;
        /// part of each record that is skipped at its start; what is wrong there does not count
        skip: Placed<WrittenQuantity>, default "0 s",
            init r#"# skip = "0.1 s"             # part of each record to leave out at its start"#;
        /// longest period n of a motion z = p/n that is searched
        longest_period_n: Placed<u32>, default "6",
            init "longest_period_n = 6         # longest motion z = p/n looked for";
        /// most impacts p in one period that are searched
        most_impacts_p: Placed<u32>, default "12";
        /// beside the covariance: `profile` (profile likelihoods), `bootstrap` (over records) or `covariance`
        /// (neither)
        uncertainty: Placed<IntervalMethod>, default "`profile`",
            init r#"uncertainty = "profile"      # beside the covariance: profile, bootstrap or covariance"#;
        /// of everything random
        seed: Placed<u64>, default "1", init "seed = 1";
        /// of a bootstrap
        replicas: Placed<u32>, default "1000";
    }
}

/// Settings of the analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    /// Part of each record skipped at its start, s.
    pub skip_s: f64,
    /// Longest motion searched, in drive periods.
    pub longest_period_n: u32,
    /// Most impacts searched in one period of a motion.
    pub most_impacts_p: u32,
    /// Seed of everything random.
    pub seed: u64,
    /// Method of the intervals, in addition to the covariance.
    #[serde(default)]
    pub uncertainty: IntervalMethod,
    /// Replicas of a bootstrap.
    #[serde(default)]
    pub replicas: usize,
}

/// The settings, defaults included.
pub(crate) fn resolve(table: &AnalysisTable, context: &mut ResolveContext<'_>) -> Analysis {
    let skip = context.within(
        &table.skip,
        "analysis.skip",
        Dimension::Time,
        [0.0, f64::INFINITY],
    );
    let mut count = |placed: &Placed<u32>, key: &str, default: u32| {
        let Some(placed) = placed else { return default };
        let value = *placed.get_ref();
        if !(1..=64).contains(&value) {
            let what = format!("{value} is out of range");
            context.fault(
                Code::OutOfRange,
                placed,
                key,
                what,
                "write a number from 1 to 64",
            );
        }
        value
    };
    Analysis {
        skip_s: skip.unwrap_or(0.0),
        longest_period_n: count(&table.longest_period_n, "analysis.longest_period_n", 6),
        most_impacts_p: count(&table.most_impacts_p, "analysis.most_impacts_p", 12),
        seed: value(&table.seed).unwrap_or(1),
        uncertainty: value(&table.uncertainty).unwrap_or_default(),
        replicas: value(&table.replicas).unwrap_or(1000).max(2) as usize,
    }
}
