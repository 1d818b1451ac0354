//! Boundaries: R from the brackets of s2, s1 and grazing.

pub mod block;
pub mod fit;
pub mod jump;
pub mod midpoints;
pub mod over_restitution;
pub mod posterior;
pub mod propagation;
pub mod result;
mod select;
pub mod surroundings;

use std::collections::BTreeSet;

use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::boundaries::surroundings::Surroundings;
use crate::methods::fits::Fits;
use crate::methods::identifier::Identifier;
use crate::methods::selection::Selection;

/// The brackets.
pub struct Boundaries;

impl Identifier for Boundaries {
    fn method(&self) -> Method {
        Method::Boundaries
    }

    /// By their posterior of R beside a resonance curve, else by least squares.
    fn fit(&self, selection: &mut Selection<'_>, found: &mut Fits) {
        let start = found.start();
        selection.choose_brackets(&start);
        let (blocks, nominal) = (&selection.blocks, &selection.evidence.nominal);
        let waveforms = found.waveforms().map(|f| &f.fit.parameters);
        let posterior = found.curve().and_then(|curve| {
            let surroundings = Surroundings::new(blocks, nominal, curve);
            posterior::of_brackets(&blocks.boundary, &surroundings, waveforms)
        });
        let fitted = match posterior {
            Some(_) => None,
            None => fit::from(blocks, nominal, start),
        };
        found.posterior = posterior;
        found.set(self.method(), fitted);
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        let brackets = selection.blocks.boundary.brackets.iter();
        let names: BTreeSet<&String> = brackets.flat_map(|b| &b.records).collect();
        selection.observed(|o| names.contains(&o.record))
    }

    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult> {
        let blocks = &selection.blocks;
        match found.posterior.as_ref().zip(found.curve()) {
            Some((posterior, curve)) => {
                let curve = &curve.fit.parameters;
                Some(result::by_posterior(blocks, posterior, curve))
            }
            None => Some(result::by_least_squares(
                blocks,
                found.attempt(self.method())?,
            )),
        }
    }
}
