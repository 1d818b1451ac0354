//! R from measured boundaries alone, and where to step a drive's frequency more finely so that they determine it twice
//! as well.

use serde::{Deserialize, Serialize};

use impact_fit::evidence::Evidence;
use impact_fit::method::Method;
use impact_fit::methods::answer::MethodResult;
use impact_fit::methods::boundaries::Boundaries;
use impact_fit::methods::boundaries::block::{BoundaryBlock, predicted_hz};
use impact_fit::methods::boundaries::posterior::{self, Posterior};
use impact_fit::methods::boundaries::result;
use impact_fit::methods::boundaries::surroundings::Surroundings;
use impact_fit::methods::identifier::Identifier;
use impact_fit::methods::impacts;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::Parameters;
use impact_records::motion::{BoundaryKind, Bracket};

/// A sweep in small steps through a bracket.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FineSweep {
    /// Half the gap, m.
    pub clearance_m: f64,
    /// First drive frequency, Hz: the last before the jump so far.
    pub from_hz: f64,
    /// Last drive frequency at which the motion may still be found, Hz.
    pub to_hz: f64,
    /// Step, Hz.
    pub step_hz: f64,
}

/// What finer sweeps make of R's interval from boundaries alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoundaryPlan {
    /// Half of R's 95 % interval from boundaries alone now.
    pub half_width95_now: f64,
    /// The same once the sweeps are measured.
    pub half_width95_then: f64,
    /// Whether that is half of it or less.
    pub halved: bool,
    /// The sweeps, by clearance.
    pub sweeps: Vec<FineSweep>,
}

/// Parts into which each bracket is divided at most: beyond, what acts on boundaries beside R is what is left.
const MOST_PARTS: u32 = 64;

/// What the boundaries alone say, and what else acts on them.
struct Alone<'a> {
    selection: Selection<'a>,
    surroundings: Surroundings,
    curve: Parameters,
    posterior: Posterior,
}

impl<'a> Alone<'a> {
    /// Of brackets near the boundaries of given parameters, else of those that the resonance curve and the speeds at
    /// impacts tell.
    fn of(evidence: &'a Evidence<'a>, fitted: Option<&Parameters>) -> Option<Self> {
        let mut selection = Selection::new(evidence);
        let resonance = selection.fit_resonance();
        let curve = resonance.as_ref()?.as_ref().ok()?;
        let start = match fitted {
            Some(fitted) => *fitted,
            None => {
                let about = curve.fit.parameters;
                let impacts = impacts::fit::from(&selection.blocks, &evidence.nominal, about);
                let restitution = impacts?.ok()?.fit.parameters.restitution;
                Parameters {
                    restitution: restitution.clamp(0.0, 1.0),
                    ..about
                }
            }
        };
        selection.choose_brackets(&start);
        let surroundings = Surroundings::new(&selection.blocks, &evidence.nominal, curve);
        let block = &selection.blocks.boundary;
        let posterior = posterior::of_brackets(block, &surroundings, None)?;
        Some(Self {
            posterior,
            surroundings,
            curve: curve.fit.parameters,
            selection,
        })
    }

    /// Half of R's interval with other brackets.
    fn half_width(&self, block: &BoundaryBlock) -> Option<f64> {
        let found = posterior::of_brackets(block, &self.surroundings, None)?;
        Some(half_width(&found))
    }
}

fn half_width(found: &Posterior) -> f64 {
    let [low, high] = found.interval95;
    0.5 * (high - low)
}

/// R as the boundaries alone have it, beside the impactless records: no waveform enters. `None` where they do not
/// determine it.
pub fn restitution(evidence: &Evidence<'_>) -> Option<(Method, MethodResult)> {
    let alone = Alone::of(evidence, None)?;
    let blocks = &alone.selection.blocks;
    let found = result::by_posterior(blocks, &alone.posterior, &alone.curve);
    Some((Boundaries.method(), found))
}

/// The coarsest steps through the ends of z = 1 with which the boundaries alone would hold R in half of its interval now,
/// or the finest considered; `None` where boundaries do not determine R, or none is the end of z = 1.
pub fn halving(evidence: &Evidence<'_>, fitted: &Parameters) -> Option<BoundaryPlan> {
    let alone = Alone::of(evidence, Some(fitted))?;
    let block = &alone.selection.blocks.boundary;
    if !block.brackets.iter().any(is_end) {
        return None;
    }
    let now = half_width(&alone.posterior);
    let mut parts = 1;
    loop {
        parts *= 2;
        let finer = divided(block, &alone.posterior, alone.curve, parts);
        let then = alone.half_width(&finer)?;
        let halved = then <= 0.5 * now;
        if halved || parts == MOST_PARTS {
            return Some(BoundaryPlan {
                half_width95_now: now,
                half_width95_then: then,
                halved,
                sweeps: sweeps(block, parts),
            });
        }
    }
}

/// The end of z = 1 in an upward sweep.
fn is_end(bracket: &Bracket) -> bool {
    bracket.kind == BoundaryKind::SaddleNode && bracket.periods_n == 1
}

/// The brackets with each end of z = 1 narrowed to that of so many equal parts where it is to be expected.
fn divided(
    block: &BoundaryBlock,
    found: &Posterior,
    about: Parameters,
    parts: u32,
) -> BoundaryBlock {
    let parameters = Parameters {
        restitution: found.restitution.0,
        ..about
    };
    let mut finer = block.clone();
    for bracket in finer.brackets.iter_mut().filter(|b| is_end(b)) {
        let width = bracket.width_hz() / f64::from(parts);
        let expected = predicted_hz(bracket, &parameters, block.rig);
        let above = expected.map_or(0.5, |f| (f - bracket.frequency_low_hz) / bracket.width_hz());
        let last = f64::from(parts - 1);
        let part = (above * f64::from(parts)).floor().clamp(0.0, last);
        bracket.frequency_low_hz += part * width;
        bracket.frequency_high_hz = bracket.frequency_low_hz + width;
    }
    finer
}

fn sweeps(block: &BoundaryBlock, parts: u32) -> Vec<FineSweep> {
    let ends = block.brackets.iter().filter(|b| is_end(b));
    let mut sweeps: Vec<FineSweep> = ends
        .map(|b| FineSweep {
            clearance_m: b.clearance_m,
            from_hz: b.frequency_low_hz,
            to_hz: b.frequency_high_hz,
            step_hz: b.width_hz() / f64::from(parts),
        })
        .collect();
    sweeps.sort_by(|a, b| a.clearance_m.total_cmp(&b.clearance_m));
    sweeps
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::fixture::bracket;
    use impact_records::event::RigKind;

    #[test]
    fn a_bracket_is_narrowed_to_the_part_that_holds_the_boundary() {
        let p = Parameters::symmetric(0.8, 12.0, 0.06, 1e-3);
        let held = bracket(BoundaryKind::SaddleNode, 1.3, &p, 0.0);
        let grazing = bracket(BoundaryKind::Grazing, 1.2, &p, 0.0);
        let block = BoundaryBlock::new(RigKind::Double, &[held.clone(), grazing.clone()]);
        let found = Posterior {
            restitution: (0.8, 0.01),
            interval95: [0.78, 0.82],
            early: None,
            evidence: 0.0,
        };
        let finer = divided(&block, &found, p, 8);
        let [narrow, kept] = &finer.brackets[..] else {
            panic!("{finer:?}");
        };
        assert_eq!(*kept, grazing);
        assert!((narrow.width_hz() - held.width_hz() / 8.0).abs() < 1e-12);
        let at = 1.3 * 12.0 + 1e-9;
        assert!(narrow.frequency_low_hz <= at && at <= narrow.frequency_high_hz + 1e-6);
        let sweeps = sweeps(&block, 8);
        assert_eq!(sweeps.len(), 1);
        assert!((sweeps[0].step_hz - held.width_hz() / 8.0).abs() < 1e-12);
    }
}
