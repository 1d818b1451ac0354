//! A campaign as it enters a comparison.

use crate::compare::Common;
use impact_fit::parameters::coordinate::Coordinate;
use impact_fit::statistics::quantile::NORMAL_975;
use impact_fit::{Allowed, Estimate, JointFit, ParameterSet, VerdictKind};
use impact_records::event::{FlightKind, RigKind};
use impact_records::record::calibrate::ChannelSetup;

/// An identified campaign, or one specimen of it.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// Its name.
    pub name: String,
    /// Number of the measurement that it is part of: specimens of one campaign have one number.
    pub measurement: usize,
    /// Two masses, or one against a stop.
    pub machine: RigKind,
    /// What acts between impacts.
    pub flight: FlightKind,
    /// When it was measured, in words.
    pub measured: Option<String>,
    /// Whether its records are simulated.
    pub synthetic: bool,
    /// The verdict on it.
    pub verdict: VerdictKind,
    /// Its joint estimates.
    pub parameters: ParameterSet,
    /// Its joint fit; `None` where the estimates rest on no fit (free decays, flight times).
    pub fit: Option<JointFit>,
    /// Which rig it was measured on, as stated.
    pub rig: Option<String>,
    /// What it states to share with other campaigns on that rig.
    pub shared: Vec<Common>,
    /// The channels.
    pub channels: Vec<ChannelSetup>,
}

/// How far one parameter of one campaign may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Known {
    /// Its value: of R itself, of the others the logarithm.
    pub value: f64,
    /// Variance by all that its interval allows for.
    pub variance: f64,
    /// Degrees of freedom of that variance.
    pub freedom: f64,
}

impl Campaign {
    /// What is known of a parameter; `None` where it has no value with an interval.
    pub(super) fn known(&self, parameter: Coordinate) -> Option<Known> {
        let estimate = self.parameters.get(parameter)?;
        let value = estimate.value?;
        let allowed = self.allowed(parameter);
        let (error, freedom) = match allowed {
            Some(a) => (
                a.standard_uncertainty,
                a.degrees_of_freedom.unwrap_or(f64::INFINITY),
            ),
            None => (of_interval(parameter, estimate)?, f64::INFINITY),
        };
        let value = if parameter.is_logarithm() {
            value.ln()
        } else {
            value
        };
        Some(Known {
            value,
            variance: error * error,
            freedom,
        })
    }

    /// All that the joint fit's interval of a parameter allows for.
    fn allowed(&self, parameter: Coordinate) -> Option<&Allowed> {
        let fit = self.fit.as_ref()?;
        fit.allowed.iter().find(|a| a.parameter == parameter)
    }

    /// The channel of a role.
    pub(super) fn channel(&self, role: impact_records::record::Role) -> Option<&ChannelSetup> {
        self.channels.iter().find(|c| c.role == role)
    }
}

/// Standard uncertainty that a 95 % interval stands for, which is at least the standard error: an
/// interval that ends at a bound has its width on the other side.
fn of_interval(parameter: Coordinate, estimate: &Estimate) -> Option<f64> {
    let value = estimate.value?;
    let [low, high] = estimate.interval95?;
    let half = if parameter.is_logarithm() {
        (high / value).ln().max((value / low).ln())
    } else {
        (high - value).max(value - low)
    };
    let error = estimate.standard_error.unwrap_or(0.0);
    Some((half / NORMAL_975).max(error / parameter.slope(value))).filter(|e| e.is_finite())
}
