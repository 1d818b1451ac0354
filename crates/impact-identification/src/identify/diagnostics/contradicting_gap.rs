//! Gaps that are stated so far off that a fit of all records is nowhere near the rig: each is left out in turn, or two have
//! each other's clearances, and what remains is fitted again.
//!
//! The first order about a fit, which finds smaller errors of a gap, may then accuse another gap.

use crate::identify::diagnostics::suspicion::{OddGap, fitting_clearance, recover};
use impact_fit::messages::Finding;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::thinning::of_each_gap;
use impact_fit::methods::trajectories::record::TrajectoryRecord;
use impact_fit::methods::weighing::Bulk;
use impact_fit::parameters::Parameters;
use impact_fit::solver::mean_squares;

/// Mean square of the residuals from which the records contradict each other.
const MISFIT: f64 = 4.0;
/// Greatest share of it that may remain with what is odd changed, and of what remains with any other change.
const REMAINS: f64 = 0.25;
/// Waveforms of each gap that are looked at.
const FEW: usize = 8;
/// Relative difference within which two gaps fit with each other's clearances: half of what one is looked for in.
const ABOUT: f64 = 0.17;
/// Fewest gaps that can outvote one.
const FEWEST_GAPS: usize = 3;

/// A fit of some records: its parameters, and the mean square of its residuals.
pub type FittedWithMeanSquare = (Parameters, f64);

/// A fit `of` blocks from where it starts.
pub type FitOf<'a> = &'a dyn Fn(&Blocks, &Parameters) -> Option<FittedWithMeanSquare>;

/// Gaps that contradict the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contradicting {
    /// One that is off.
    One(OddGap),
    /// Two that have each other's clearances, m.
    Exchanged([f64; 2]),
}

/// A few records of each gap, which contradict each other.
pub struct Contradiction<'a> {
    /// With the records that have an orbit where fits start.
    few: Blocks,
    /// All of them, those of a gap that is stated so far off that they have none among them.
    records: Vec<TrajectoryRecord>,
    gaps_m: Vec<f64>,
    /// Mean square that a fit of all leaves.
    all: f64,
    /// Where the fits of others start, which no gap has led astray.
    start: &'a Parameters,
    fit: FitOf<'a>,
}

impl<'a> Contradiction<'a> {
    /// Of blocks and of the records `lost`, which they have no more, where a fit of all leaves more than the noise. It starts
    /// at what was `found` of them, the others at `start`.
    pub fn of(
        blocks: &Blocks,
        lost: &[TrajectoryRecord],
        [start, found]: [&'a Parameters; 2],
        fit: FitOf<'a>,
    ) -> Option<Self> {
        let records = of_each_gap(blocks.trajectory.records.iter().chain(lost), FEW);
        let mut few = blocks.with_trajectory(blocks.trajectory.with_records(records));
        few.allow_least(start);
        let records = few.trajectory.records.clone();
        let mut gaps_m: Vec<f64> = records.iter().map(|r| r.clearance_m).collect();
        gaps_m.dedup();
        few.keep_those_with_an_orbit(start);
        let (_, all) = fit(&few, found).or_else(|| fit(&few, start))?;
        let contradictory = gaps_m.len() >= FEWEST_GAPS && all >= MISFIT;
        contradictory.then_some(Self {
            few,
            records,
            gaps_m,
            all,
            start,
            fit,
        })
    }

    /// The gaps that contradict the others, where that is clear.
    pub fn told(&self) -> Option<Contradicting> {
        let exchanged = self.exchanged().map(Contradicting::Exchanged);
        exchanged.or_else(|| self.one_gap().map(Contradicting::One))
    }

    /// The gap without which all other records fit far better, where that is so of one gap alone.
    fn one_gap(&self) -> Option<OddGap> {
        let without = |gap: &f64| {
            let mut others = self.few.clone();
            others.trajectory.records.retain(|r| r.clearance_m != *gap);
            Some((*gap, (self.fit)(&others, self.start)?))
        };
        let (gap_m, (without, _)) = self.alone(self.gaps_m.iter().filter_map(without))?;
        let block = &self.few.trajectory;
        let own = self.records.iter().filter(|r| r.clearance_m == gap_m);
        let own: Vec<TrajectoryRecord> = own.cloned().collect();
        let scores: Vec<f64> = mean_squares(block, &without)
            .into_iter()
            .flatten()
            .collect();
        let typical = Bulk::of(&scores).typical;
        // what the others leave open of all else is more than the noise of these records
        let about_m = fitting_clearance(block, own.clone(), &without, typical)?;
        let (with, _) = (self.fit)(&self.with_clearance(gap_m, about_m, &without), &without)?;
        recover(block, own, &with, typical)
    }

    /// All records, one gap with another clearance, as far as they have an orbit at parameters.
    fn with_clearance(&self, gap_m: f64, other_m: f64, at: &Parameters) -> Blocks {
        let mut records = self.records.clone();
        for record in records.iter_mut().filter(|r| r.clearance_m == gap_m) {
            record.clearance_m = other_m;
        }
        let trajectory = self.few.trajectory.with_records(records);
        let mut all = self.few.with_trajectory(trajectory);
        all.keep_those_with_an_orbit(at);
        all
    }

    /// The two gaps with each other's clearances of which all records fit far better, where that is so of one pair alone.
    fn exchanged(&self) -> Option<[f64; 2]> {
        let with = |pair: [f64; 2]| {
            let mut others = self.few.clone();
            for record in &mut others.trajectory.records {
                record.clearance_m = exchanged(record.clearance_m, pair);
            }
            Some((pair, (self.fit)(&others, self.start)?))
        };
        let gaps = self.gaps_m.iter().enumerate();
        let pairs = gaps.flat_map(|(i, a)| self.gaps_m[i + 1..].iter().map(|b| [*a, *b]));
        self.alone(pairs.filter_map(with)).map(|(pair, _)| pair)
    }

    /// The change with which the fit leaves least, if that is little, and far less than with any other.
    fn alone<T>(
        &self,
        fits: impl Iterator<Item = (T, FittedWithMeanSquare)>,
    ) -> Option<(T, FittedWithMeanSquare)> {
        let mut fits: Vec<(T, FittedWithMeanSquare)> = fits.collect();
        fits.sort_by(|a, b| a.1.1.total_cmp(&b.1.1));
        // what has no fit leaves all
        let next = fits.get(1).map_or(self.all, |(_, (_, next))| *next);
        let most = REMAINS * next.min(self.all);
        fits.into_iter()
            .next()
            .filter(|(_, (_, best))| *best < most)
    }
}

/// The clearance of a gap where two have each other's.
pub fn exchanged(own_m: f64, [one_m, other_m]: [f64; 2]) -> f64 {
    if own_m == one_m {
        other_m
    } else if own_m == other_m {
        one_m
    } else {
        own_m
    }
}

/// Two gaps that were found off one after the other and fit with about each other's clearances: of two the second one bends
/// what the first is found to be.
pub fn exchanged_of(odd: &[&Finding]) -> Option<[f64; 2]> {
    let of = |finding: &Finding| match finding {
        Finding::WrongClearance {
            stated_m,
            fitting_m,
            ..
        } => Some([*stated_m, *fitting_m]),
        _ => None,
    };
    let [one, other] = odd else { return None };
    let ([one_m, fits_one_m], [other_m, fits_other_m]) = (of(one)?, of(other)?);
    let near = |fits: f64, stated: f64| (fits / stated - 1.0).abs() < ABOUT;
    let exchanged = near(fits_one_m, other_m) && near(fits_other_m, one_m);
    exchanged.then(|| [one_m.min(other_m), one_m.max(other_m)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::run::identify;
    use impact_fit::VerdictKind;
    use impact_fit::estimate::Status;
    use impact_fit::fixture::{evidence, observed, recorded};

    #[test]
    fn valid_two_gaps_with_each_other_s_clearances_are_named_and_taken_as_they_are() {
        let mut observations = observed(&recorded(0.8, 12.0, 240, 12));
        let stated = observations.iter().filter_map(|o| o.setting.clearance_m);
        let mut gaps_m: Vec<f64> = stated.collect();
        gaps_m.sort_by(f64::total_cmp);
        gaps_m.dedup();
        assert!(gaps_m.len() >= FEWEST_GAPS, "{gaps_m:?}");
        let pair_m = [gaps_m[0], gaps_m[1]];
        for o in &mut observations {
            o.setting.clearance_m = o.setting.clearance_m.map(|own| exchanged(own, pair_m));
        }
        let found = identify(&evidence(&observations));
        let named = [Finding::ClearancesExchanged { pair_m }];
        assert_eq!(found.suspicions, named);
        assert_eq!(found.verdict.kind, VerdictKind::Identified);
        let r = found.joint.parameters.restitution.expect("R");
        assert_eq!(r.status, Status::Identified);
        let [low, high] = r.interval95.expect("an interval");
        assert!(low < 0.8 && 0.8 < high, "{low} {high}");
    }
}
