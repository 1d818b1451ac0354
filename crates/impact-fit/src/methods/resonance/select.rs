//! Which impactless records the resonance curve rests on.

use crate::messages::Reason;
use crate::methods::fit::FitResult;
use crate::methods::resonance::fit;
use crate::methods::selection::Selection;
use crate::methods::weighing::Bulk;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::mean_squares;

/// Halvings of the gains' uncertainty, by roots of two, from which a record's own error is looked for.
const OWN_STEPS: i32 = 16;

/// Relative changes of f0, β and `x_st` from which two fits are not of one minimum.
const FAR: [(Coordinate, f64); 3] = [
    (Coordinate::Frequency, 0.03),
    (Coordinate::Damping, 0.3),
    (Coordinate::Deflection, 0.1),
];

/// Whether two fits are so far apart that they may be in different minima.
fn is_far(a: &Parameters, b: &Parameters) -> bool {
    let apart = |c: Coordinate| (a.coordinate(c) - b.coordinate(c)).abs();
    FAR.iter().any(|(c, limit)| apart(*c) > *limit)
}

impl Selection<'_> {
    /// Fit the impactless records; those that fit far worse than the bulk are named and left out.
    pub fn fit_resonance(&mut self) -> Option<FitResult> {
        let first = match fit::first(&self.blocks, &self.evidence.nominal)? {
            Ok(first) => first,
            failed => return Some(failed),
        };
        let parameters = first.fit.parameters;
        self.keep_like_responses(&parameters);
        fit::from(&self.blocks, &self.evidence.nominal, parameters)
    }

    /// Weigh the impactless records at good parameters, keep those that fit like the bulk, and name the
    /// others. A record that deviates by less than the gains are uncertain is no other one: it is allowed as
    /// much more error as it shows. At resonance responses are so great, and so well measured, that
    /// any effect beyond the model exceeds their noise.
    fn keep_like_responses(&mut self, parameters: &Parameters) {
        for point in &mut self.blocks.resonance.points {
            point.own_relative_error = 0.0;
        }
        self.blocks.weigh_resonance(parameters);
        let scores = self.response_scores(parameters);
        let bulk = Bulk::of(&scores);
        let most = self.evidence.nominal.gain_uncertainty;
        let mut left = scores.clone();
        for step in 0..=OWN_STEPS {
            if left.iter().all(|score| *score <= bulk.limit) {
                break;
            }
            let own = most * 2f64.powf(0.5 * f64::from(step - OWN_STEPS));
            let block = &mut self.blocks.resonance;
            for (point, score) in block.points.iter_mut().zip(&left) {
                if *score > bulk.limit {
                    point.own_relative_error = own;
                }
            }
            block.allow(block.relative_error());
            left = self.response_scores(parameters);
        }
        let points = std::mem::take(&mut self.blocks.resonance.points);
        for (point, (score, left)) in points.into_iter().zip(scores.into_iter().zip(left)) {
            if left <= bulk.limit {
                self.blocks.resonance.points.push(point);
            } else {
                let times_worse = bulk.times_worse(score);
                let reason = Reason::ResponseUnlikeOthers { times_worse };
                self.note(point.observation, reason);
                self.unlike.push(point);
            }
        }
    }

    /// Mean squares of the impactless records.
    fn response_scores(&self, parameters: &Parameters) -> Vec<f64> {
        let scores = mean_squares(&self.blocks.resonance, parameters);
        scores.into_iter().map(|s| s.unwrap_or(0.0)).collect()
    }

    /// The resonance curve's fit, again from where the waveforms are, if it is far from there or left
    /// records out: few points tell f0 and `x_st` only together, and then also which of them is odd. The better
    /// one of the fits from there and from where it was.
    pub(super) fn fit_resonance_again(
        &mut self,
        found: Option<FitResult>,
        waveforms: &Parameters,
    ) -> Option<FitResult> {
        let before = match found {
            Some(Ok(found)) => found,
            other => return other,
        };
        let parameters = before.fit.parameters;
        if self.unlike.is_empty() && !is_far(&parameters, waveforms) {
            return Some(Ok(before));
        }
        let unlike = |reason: &Reason| matches!(reason, Reason::ResponseUnlikeOthers { .. });
        self.left_out.retain(|left| !unlike(&left.reason));
        self.blocks.resonance.points.append(&mut self.unlike);
        let points = &mut self.blocks.resonance.points;
        points.sort_by_key(|p| p.observation);
        self.keep_like_responses(waveforms);
        let nominal = &self.evidence.nominal;
        let starts = [*waveforms, parameters];
        let fits = starts.map(|start| fit::from(&self.blocks, nominal, start));
        let fits = fits.into_iter().flatten().filter_map(Result::ok);
        let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
        Some(Ok(best.unwrap_or(before)))
    }
}
