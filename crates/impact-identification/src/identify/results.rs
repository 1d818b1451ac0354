//! What each method found, and all together, as plain results.

use std::collections::BTreeMap;

use impact_fit::evidence::Evidence;
use impact_fit::method::Method;
use impact_fit::methods::answer::MethodResult;
use impact_fit::methods::fit::{self, FitResult};
use impact_fit::methods::fits::Fits;
use impact_fit::methods::registry::REGISTRY;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::Coordinate;

/// What each method found.
pub fn alone(selection: &Selection<'_>, found: &Fits) -> BTreeMap<Method, MethodResult> {
    let each = REGISTRY.iter();
    each.filter_map(|of| Some((of.method(), of.result(selection, found)?)))
        .collect()
}

/// The joint result; without a joint fit, what the free decays or the flight times determine.
pub fn joint(
    evidence: &Evidence<'_>,
    attempt: Option<&FitResult>,
    methods: &BTreeMap<Method, MethodResult>,
) -> MethodResult {
    let Some(attempt) = attempt else {
        let of = REGISTRY.iter().map(|of| of.method());
        let mut apart = of.filter(|method| !Method::FITTED.contains(method));
        let only = apart.find_map(|method| methods.get(&method));
        return only.cloned().unwrap_or_default();
    };
    let tells: Vec<Coordinate> = match attempt {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    let observations = evidence.observations.iter();
    let records = observations.filter(|o| !o.excluded()).count();
    let observations = attempt.as_ref().map_or(0, |f| f.fit.residuals);
    fit::result(attempt, &tells, observations, records)
}
