//! Which amplitudes of the drives the motion follows, where what is stated and what is measured contradict each other.

use crate::evidence::Evidence;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::misfit::misfit;
use crate::methods::resonance::phases::EXPLAINED;

/// Part of the misfit of the measured amplitudes that the stated ones may leave: amplitudes that differ by a tenth leave
/// a misfit hundreds of times that of the noise.
const LEFT: f64 = 0.1;

/// Whether impactless records follow the stated amplitudes of their drives and not the measured ones.
pub fn follow_stated(stated: &Evidence<'_>, measured: &Evidence<'_>) -> bool {
    let left = |evidence: &Evidence<'_>| misfit(&Blocks::new(evidence), &evidence.nominal);
    match (left(stated), left(measured)) {
        (Some(stated), Some(measured)) => measured > EXPLAINED && stated < LEFT * measured,
        _ => false,
    }
}
