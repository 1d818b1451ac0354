//! Impacts that are seen although no method tells R from them: their speeds are hardly known.

use std::collections::BTreeMap;

use impact_fit::messages::Finding;
use impact_fit::method::Method;
use impact_fit::methods::answer::MethodResult;
use impact_records::event::Impact;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Share of a speed to which it is known well: R's interval is then as wide as that of one that is weak, 0.05 = 1.96 √2 times it.
const KNOWN_WELL: f64 = 0.05 / (1.96 * std::f64::consts::SQRT_2);

/// How far the speeds at impacts are known, where no method has a result because they hardly are.
pub fn uncertain_speeds(
    observations: &[Observation],
    methods: &BTreeMap<Method, MethodResult>,
) -> Option<Finding> {
    if !methods.is_empty() {
        return None;
    }
    let used = observations.iter().filter(|o| !o.excluded());
    let share = |i: &Impact| Some(i.speed_error_m_s()? / i.approach_speed_before_m_s?);
    let shares: Vec<f64> = used
        .flat_map(|o| &o.impacts)
        .filter_map(share)
        .filter(|share| *share > 0.0)
        .collect();
    let share = robust::median(&shares).filter(|share| *share > KNOWN_WELL)?;
    Some(Finding::UncertainSpeeds {
        impacts: shares.len(),
        share,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Motion;

    #[test]
    fn impacts_whose_speeds_are_hardly_known_are_named_where_no_method_has_a_result() {
        let mut o = Observation::of("r", 12.0, Motion::Impactless);
        let impact = |speed: f64| Impact {
            approach_speed_before_m_s: Some(speed),
            speed_errors_m_s: Some([0.1, 0.1]),
            ..Impact::at(0.5, speed)
        };
        o.impacts = [0.8, 1.0, 1.3].map(impact).into();
        let found = uncertain_speeds(&[o.clone()], &BTreeMap::new());
        let Some(Finding::UncertainSpeeds { impacts: 3, share }) = found else {
            panic!("{found:?}");
        };
        assert!((share - 0.1).abs() < 1e-12);
        let with = BTreeMap::from([(Method::Impacts, MethodResult::default())]);
        assert_eq!(uncertain_speeds(&[o.clone()], &with), None);
        // speeds that are known well do not say why there is no result
        let quiet = |speed: f64| Impact {
            speed_errors_m_s: Some([1e-3, 1e-3]),
            ..impact(speed)
        };
        o.impacts = [0.8, 1.0, 1.3].map(quiet).into();
        assert_eq!(uncertain_speeds(&[o], &BTreeMap::new()), None);
    }
}
