//! What the resonance curve gives, and whether it is that of one degree of freedom.

use crate::messages::{ONE_DEGREE_OF_FREEDOM, Remark};
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::methods::resonance::block::ResonanceBlock;
use crate::methods::resonance::fit::TELLS;
use crate::parameters::Parameters;
use impact_records::signal::robust;

/// f0, β and `x_st` from the impactless records.
pub(super) fn result(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let block = &blocks.resonance;
    let observations = block.points.iter().map(|p| 2 * p.responses.len()).sum();
    let mut result = fit::result(fitted, &TELLS, observations, block.points.len());
    if let Ok(fit) = fitted {
        judge(&mut result, block, &fit.fit.parameters);
    }
    result
}

/// By how much the responses deviate from a curve, as a share of the greater of both: root mean square.
pub(super) fn deviation(block: &ResonanceBlock, fitted: &Parameters) -> f64 {
    let mut deviations = Vec::new();
    for point in &block.points {
        for r in &point.responses {
            let model = block.response(fitted, point, r.role);
            let apart = match point.phase_error_rad {
                Some(_) => (r.real - model.re).hypot(r.imaginary - model.im),
                None => (r.amplitude() - model.norm()).abs(),
            };
            deviations.push(apart / model.norm().max(r.amplitude()));
        }
    }
    robust::rms(&deviations)
}

/// Judge whether the impactless records are those of one degree of freedom for each mass.
fn judge(result: &mut MethodResult, block: &ResonanceBlock, fitted: &Parameters) {
    let deviation = deviation(block, fitted);
    result.fits = Some(deviation < ONE_DEGREE_OF_FREEDOM);
    result.remarks.push(if deviation < ONE_DEGREE_OF_FREEDOM {
        Remark::OneDegreeOfFreedom { deviation }
    } else {
        Remark::NotOneDegreeOfFreedom { deviation }
    });
}
