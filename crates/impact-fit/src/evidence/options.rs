//! What is wanted of the uncertainty.

use serde::{Deserialize, Serialize};

/// How intervals are found beside the covariance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalMethod {
    /// The covariance at the optimum alone.
    Covariance,
    /// Profile likelihood of each parameter.
    #[default]
    Profile,
    /// Bootstrap over records.
    Bootstrap,
}

/// What is wanted of the uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UncertaintyOptions {
    /// How intervals are found beside the covariance.
    pub intervals: IntervalMethod,
    /// Replicas of a bootstrap.
    pub replicas: usize,
    /// Seed of everything random.
    pub seed: u64,
}

impl Default for UncertaintyOptions {
    fn default() -> Self {
        Self {
            intervals: IntervalMethod::default(),
            replicas: 1000,
            seed: 1,
        }
    }
}
