//! Which amplitudes of the drives the motion follows, where what is stated and what is measured contradict each other.

use crate::evidence::Evidence;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::misfit::misfit;
use crate::methods::resonance::phases::EXPLAINED;
use impact_records::motion::{Observation, state_drives};
use impact_records::record::FlagCode;

/// Part of the misfit of the measured amplitudes that the stated ones may leave: amplitudes that differ by a tenth leave
/// a misfit hundreds of times that of the noise.
const LEFT: f64 = 0.1;
/// Records whose measured drives contradict the stated ones from which these may be those of the motion: of fewer a row of the
/// run table is wrong.
const FEWEST: usize = 3;

/// Whether impactless records follow the stated amplitudes of their drives and not the measured ones that contradict them.
pub fn follow_stated(evidence: &Evidence<'_>) -> bool {
    let contradicts = |o: &&Observation| o.has_flag(FlagCode::DriveAmplitudeContradicts);
    if evidence.observations.iter().filter(contradicts).count() < FEWEST {
        return false;
    }
    let measured = evidence.impactless();
    let mut stated = measured.clone();
    state_drives(&mut stated);
    let left = |observations: &[Observation]| {
        let of_these = evidence.of_records(observations);
        misfit(&Blocks::new(&of_these), &of_these.nominal)
    };
    match (left(&stated), left(&measured)) {
        (Some(stated), Some(measured)) => measured > EXPLAINED && stated < LEFT * measured,
        _ => false,
    }
}
