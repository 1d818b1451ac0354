//! Which records multiple shooting rests on.

use crate::messages::Reason;
use crate::methods::fit::FitResult;
use crate::methods::flights::fit;
use crate::methods::selection::{ROUNDS, Selection};
use crate::methods::weighing::Bulk;
use crate::parameters::Parameters;
use crate::solver::{Precision, mean_squares};

impl Selection<'_> {
    /// Fit the records that are shot from impact to impact, R allowed the scatter that they show; those that fit far
    /// worse than the bulk, as where an impact was missed, are left out and named.
    pub(super) fn fit_flights(&mut self, start: Parameters) -> Option<FitResult> {
        match self.roughly_flown(start)? {
            Ok(rough) => self.flown(rough.fit.parameters, Precision::Result),
            failed => Some(failed),
        }
    }

    fn flown(&self, start: Parameters, precision: Precision) -> Option<FitResult> {
        fit::from(&self.blocks, &self.evidence.nominal, start, precision)
    }

    /// Rough fits until no record is left out and the scatter of R stays.
    fn roughly_flown(&mut self, start: Parameters) -> Option<FitResult> {
        let mut parameters = start;
        let (mut found, mut changed) = (None, false);
        for _ in 0..=ROUNDS {
            let scores = mean_squares(&self.blocks.flight, &parameters);
            let known: Vec<f64> = scores.iter().flatten().copied().collect();
            let limit = Bulk::of(&known).limit;
            let follows = |score: &Option<f64>| score.is_some_and(|s| s <= limit);
            let block = &self.blocks.flight;
            let records = block.records.iter().zip(&scores);
            let whole = |record| found.is_none() || !block.lacks_an_impact(record, &parameters);
            let kept: Vec<bool> = records
                .map(|(record, score)| follows(score) && whole(record))
                .collect();
            if found.is_some() && kept.iter().all(|kept| *kept) && !changed {
                break;
            }
            let mut kept = kept.into_iter();
            let records = &mut self.blocks.flight.records;
            let gone = records.extract_if(.., |_| !kept.next().unwrap_or(false));
            for record in gone.collect::<Vec<_>>() {
                self.note(record.observation, Reason::ImpactsDoNotFollow);
            }
            match self.flown(parameters, Precision::Start)? {
                Ok(fit) => {
                    parameters = fit.fit.parameters;
                    changed = self.blocks.weigh_flights(&parameters);
                    found = Some(Ok(fit));
                }
                failed => return Some(failed),
            }
        }
        found
    }
}
