//! The clock of the sampler: what its stated uncertainty leaves open, and whether the stated frequencies
//! contradict it together.
//!
//! Times are counted in samples, so that every measured frequency is off by the error of the clock's. Where
//! the frequencies that the laboratory states are off by one ratio, the clock is off, or the generator whose
//! frequencies they are.

use std::collections::BTreeMap;

use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use crate::identify::diagnostics::stated_frequencies;
use impact_fit::estimate;
use impact_fit::messages::{Finding, Note};
use impact_fit::methods::answer::MethodResult;
use impact_fit::parameters::Coordinate;
use impact_fit::statistics::quantile::{NORMAL_975, student_975};
use impact_records::motion::Observation;
use impact_records::record::FlagCode;
use impact_records::signal::robust;

/// Standard deviations from which a common ratio is named.
const SURE: f64 = 3.0;
/// Different stated frequencies from which their scatter shows how exactly they are stated.
const FEWEST: usize = 3;

/// Stated frequencies that are off by one ratio, with what that leaves open in f0 and `x_st`; `clock`: the relative
/// standard uncertainty of the clock.
pub fn suspicion(observations: &[Observation], clock: f64) -> Option<Suspicion> {
    let shifted = stated_frequencies::shifted(observations, clock);
    let contradicted = || stated_frequencies::contradicted(observations);
    let together = || off_together(observations, clock);
    let finding = shifted.or_else(contradicted).or_else(together)?;
    let ratio = match &finding {
        Finding::FrequenciesOffAlike { ratio, .. } | Finding::ClockOrGenerator { ratio, .. } => {
            Some(*ratio)
        }
        _ => None,
    };
    let left_open = |ratio: f64| left_open(observations, ratio.ln().abs());
    Some(Suspicion {
        finding,
        doubts: ratio.map_or_else(Vec::new, left_open),
    })
}

/// What a relative error of all times leaves open: f0, and `x_st` once for each time that displacements are
/// integrated from what is measured.
fn left_open(observations: &[Observation], by: f64) -> Vec<Doubt> {
    let measured = observations.iter().flat_map(|o| &o.amplitudes);
    let integrations = measured.filter_map(|a| a.role.derivative()).max();
    let doubt = |parameter, by| Doubt {
        parameter,
        by,
        note: Note::InstrumentOff,
    };
    let deflection = doubt(
        Coordinate::Deflection,
        f64::from(integrations.unwrap_or(0)) * by,
    );
    let open = [doubt(Coordinate::Frequency, by), deflection];
    open.into_iter().filter(|d| d.by > 0.0).collect()
}

/// The mean ratio of measured to stated frequencies, where it is off one by more than the clock's
/// uncertainty and the scatter between the stated frequencies allow. Each stated frequency counts once: in
/// what it is rounded by, its records agree.
fn off_together(observations: &[Observation], clock: f64) -> Option<Finding> {
    let mut by_stated: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    let mut records = 0;
    for o in observations {
        let alone = o.excluded() || o.has_flag(FlagCode::DriveFrequencyContradicts);
        let compared = o.drive.zip(o.setting.stated_frequency_hz);
        if let Some((drive, stated_hz)) = compared.filter(|_| !alone) {
            let ratio = (drive.frequency_hz / stated_hz).ln();
            by_stated
                .entry(stated_hz.to_bits())
                .or_default()
                .push(ratio);
            records += 1;
        }
    }
    let each: Vec<f64> = by_stated
        .values()
        .filter_map(|r| robust::median(r))
        .collect();
    if each.len() < FEWEST {
        return None;
    }
    let count = each.len() as f64;
    let mean = robust::mean(&each);
    let squares: f64 = each.iter().map(|r| (r - mean).powi(2)).sum();
    let standard_error = (squares / (count - 1.0) / count).sqrt();
    let widened = standard_error * student_975(count - 1.0) / NORMAL_975;
    let z_score = mean / clock.hypot(widened).max(f64::MIN_POSITIVE);
    (z_score.abs() > SURE).then(|| Finding::ClockOrGenerator {
        ratio: mean.exp(),
        standard_error,
        clock_uncertainty: clock,
        records,
        z_score,
    })
}

/// Widen f0 by the uncertainty of the clock, which all methods share.
pub fn widen(result: &mut MethodResult, clock: f64) {
    let parameter = Coordinate::Frequency;
    if let Some(Some(estimate)) = result.parameters.slot(parameter).filter(|_| clock > 0.0) {
        *estimate = estimate::wider(parameter, estimate, clock);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::event::DriveTone;
    use impact_records::motion::{Amplitude, Motion};
    use impact_records::record::Role;

    /// Records at stated frequencies, and the ratio at which each is measured.
    fn observed(ratios: impl Fn(usize) -> f64) -> Vec<Observation> {
        let one = |i: usize| {
            let stated_hz = 8.0 + 0.5 * (i / 2) as f64;
            let mut o = Observation::of("r", stated_hz, Motion::Impactless);
            o.setting.stated_frequency_hz = Some(stated_hz);
            o.drive = Some(DriveTone::at(stated_hz * ratios(i), 1.0));
            o
        };
        (0..24).map(one).collect()
    }

    /// A deviation of either sign, by turns of the stated frequencies.
    fn either(i: usize, size: f64) -> f64 {
        if (i / 2).is_multiple_of(2) {
            size
        } else {
            -size
        }
    }

    #[test]
    fn a_clock_ten_times_its_uncertainty_off_is_named_and_f0_widened() {
        let all = observed(|i| 1.0 - 5e-4 + either(i, 1e-5));
        let found = suspicion(&all, 5e-5).expect("a suspicion");
        assert!((found.doubts[0].by - 5e-4).abs() < 1e-6);
        assert_eq!(
            found.finding.to_string(),
            "the measured drive is at 0.99950 times the stated frequencies on average over 24 \
             records, which the clock's 50 ppm do not explain: the sampler's clock or the generator \
             is off; measure both with a frequency counter and correct sample_rate or the stated \
             frequencies: until then $f_0$ is known no better than that"
                .replace("$f_0$", "f0")
        );
    }

    #[test]
    fn valid_a_clock_off_scales_the_deflection_once_for_each_integration() {
        for (role, times) in [
            (Role::DisplacementX, 0.0),
            (Role::VelocityX, 1.0),
            (Role::AccelerationX, 2.0),
        ] {
            let mut all = observed(|_| 1.01);
            all[0].amplitudes = vec![Amplitude {
                role,
                half_range: 1.0,
                rms: 0.5,
            }];
            let doubts = suspicion(&all, 5e-5).expect("a suspicion").doubts;
            let deflection = doubts
                .iter()
                .find(|d| d.parameter == Coordinate::Deflection);
            let by = deflection.map_or(0.0, |d| d.by);
            assert!((by - times * 1.01f64.ln()).abs() < 1e-9, "{role:?}: {by}");
        }
    }

    #[test]
    fn a_clock_within_its_uncertainty_and_frequencies_that_are_rounded_are_not_named() {
        assert_eq!(suspicion(&observed(|_| 1.0 + 5e-5), 5e-5), None);
        // stated to a tenth of a hertz, the mean off by a third of what is left of that
        let rounded = observed(|i| 1.0 + 5e-4 + either(i, 5e-3));
        assert_eq!(suspicion(&rounded, 5e-5), None);
    }
}
