//! What the resonance curve gives, and whether it is that of one degree of freedom.

use crate::messages::{ONE_DEGREE_OF_FREEDOM, Remark};
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::methods::resonance::block::{ResonanceBlock, ResonancePoint};
use crate::methods::resonance::fit::TELLS;
use crate::parameters::Parameters;
use impact_records::motion::Response;
use impact_records::signal::robust;
use nalgebra::Complex;

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

/// By how much the responses deviate from a curve, as a share of the greatest response of their quantity, measured or of the
/// curve, in their record: root mean square. What a mass that is driven less shows of the other is small beside that.
pub(super) fn deviation(block: &ResonanceBlock, fitted: &Parameters) -> f64 {
    let of_point = |point| deviations(block, point, fitted);
    robust::rms(&block.points.iter().flat_map(of_point).collect::<Vec<f64>>())
}

/// The deviations of the responses of a record.
fn deviations(block: &ResonanceBlock, point: &ResonancePoint, fitted: &Parameters) -> Vec<f64> {
    let of_model = |r: &Response| block.response(fitted, point, r.role);
    let each: Vec<(&Response, Complex<f64>)> =
        point.responses.iter().map(|r| (r, of_model(r))).collect();
    let deviation = |(r, model): &(&Response, Complex<f64>)| {
        let apart = match point.phase_error_rad {
            Some(_) => (r.real - model.re).hypot(r.imaginary - model.im),
            None => (r.amplitude() - model.norm()).abs(),
        };
        let alike = each
            .iter()
            .filter(|(other, _)| other.role.derivative() == r.role.derivative());
        let greatest = alike.map(|(r, model)| r.amplitude().max(model.norm()));
        apart / greatest.fold(0.0, f64::max)
    };
    each.iter().map(deviation).collect()
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
