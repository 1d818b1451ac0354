//! What waveforms give, and whether they are those of the closed-form orbits.

use crate::evidence::Evidence;
use crate::messages::Remark;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::methods::trajectories::block::TrajectoryBlock;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Block;
use impact_records::signal::robust;

/// Relative deviation of waveforms from which the orbit does not fit.
const WAVEFORM_DEVIATION: f64 = 0.08;

/// All four parameters from the waveforms.
pub(super) fn result(blocks: &Blocks, fitted: &FitResult, evidence: &Evidence<'_>) -> MethodResult {
    let block = &blocks.trajectory;
    let observations = fitted.as_ref().map_or(0, |f| f.fit.residuals);
    let mut result = fit::result(
        fitted,
        &Coordinate::PHYSICAL,
        observations,
        block.records.len(),
    );
    if let Ok(fit) = fitted {
        judge(&mut result, block, &fit.fit.parameters);
    }
    result.remarks.extend(thinned(evidence));
    result
}

/// How many waveforms the trajectories rest on where not all were kept.
fn thinned(evidence: &Evidence<'_>) -> Option<Remark> {
    let periodic = evidence.observations.iter().filter(|o| {
        let pair = o.classification.impacts_and_periods();
        !o.excluded() && pair.is_some_and(|(impacts_p, _)| impacts_p == 1)
    });
    let (kept, let_go): (Vec<_>, Vec<_>) = periodic.partition(|o| o.folded.is_some());
    (3 * let_go.len() > kept.len()).then(|| Remark::WaveformsThinned {
        fitted: kept.len(),
        periodic: kept.len() + let_go.len(),
    })
}

/// Judge whether the waveforms are those of the closed-form orbits.
fn judge(result: &mut MethodResult, block: &TrajectoryBlock, fitted: &Parameters) {
    let (mut ratios, mut beside_noise) = (Vec::new(), Vec::new());
    for item in 0..block.items() {
        let Some(residuals) = block.residuals(item, fitted) else {
            continue;
        };
        let channels = &block.records[item].folded.channels;
        let (mut apart, mut whole, mut k) = (0.0, 0.0, 0);
        for channel in channels {
            let mean = robust::mean(&channel.points.iter().map(|p| p.value).collect::<Vec<_>>());
            for p in &channel.points {
                let weight = f64::from(p.samples) / channel.noise.powi(2);
                apart += residuals[k].powi(2);
                whole += weight * (p.value - mean).powi(2);
                k += 1;
            }
        }
        let [all, beside] = left(apart, whole, k);
        ratios.push(all);
        beside_noise.push(beside);
    }
    let (Some(share), Some(deviation)) = (robust::median(&ratios), robust::median(&beside_noise))
    else {
        return;
    };
    result.fits = Some(deviation < WAVEFORM_DEVIATION);
    result.remarks.push(Remark::WaveformsUnexplained { share });
}

/// What is left of a waveform over the whole, by squares in units of the points' noise, and the same beside what noise
/// alone leaves of so many points.
fn left(apart: f64, whole: f64, points: usize) -> [f64; 2] {
    let beside = (apart - points as f64).max(0.0);
    [apart, beside].map(|squares| (squares / whole.max(f64::MIN_POSITIVE)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_alone_is_no_misfit_of_a_waveform() {
        // points of a waveform five times their noise, and another one off by a fifth of it
        assert_eq!(left(100.0, 2500.0, 100), [0.2, 0.0]);
        let [all, beside] = left(200.0, 2500.0, 100);
        assert!((all * all - 0.08).abs() < 1e-12 && (beside - 0.2).abs() < 1e-12);
    }
}
