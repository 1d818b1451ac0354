//! Simulated against measured: the fitted model beside a campaign's records, as plain typed data.
//!
//! [`replay()`] simulates the regions of motion and the boundaries with their 95 % bands in the (η, ρ)
//! plane, replays chosen records, and collects what each method of the identification used: resonance
//! curves, speeds at impacts, free decays and residuals. Nothing is identified here, and nothing drawn.

mod decays;
mod evidence;
mod input;
mod left_out;
mod plane;
mod records;
mod replays;
mod single;
mod traces;

pub use decays::FreeDecay;
pub use evidence::{
    Correlation, ImpactPoint, ImpactScatter, MeasuredAmplitude, ResidualPoint, ResidualSet,
    ResonanceCurve,
};
pub use input::Input;
pub use left_out::{Unusable, UnusableReason};
pub use plane::{BoundaryCurve, RegionMap};
pub use records::{BracketRow, Overview, RecordRow};
pub use replays::ReplayedRecord;
pub use single::{BesideRecord, WhyNot, beside};
pub use traces::{Signal, Trace};

/// The fitted model and the measurement, side by side. All quantities are SI; every list may be empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Compared {
    /// Counts and ranges of what was measured.
    pub overview: Overview,
    /// One row per record; of very many every second, third …
    pub records: Vec<RecordRow>,
    /// Measured brackets of the boundaries.
    pub brackets: Vec<BracketRow>,
    /// Simulated boundaries in the (η, ρ) plane.
    pub curves: Vec<BoundaryCurve>,
    /// Simulated regions of motion in the (η, ρ) plane.
    pub region_map: Option<RegionMap>,
    /// Records beside their simulation.
    pub comparisons: Vec<ReplayedRecord>,
    /// Resonance curves without impacts.
    pub resonance: Vec<ResonanceCurve>,
    /// Speeds after over before impact, one entry per specimen.
    pub impacts: Vec<ImpactScatter>,
    /// Free decays with their fits.
    pub free_decays: Vec<FreeDecay>,
    /// Residuals of each method.
    pub residuals: Vec<ResidualSet>,
    /// Correlation of the parameters that were fitted together.
    pub correlation: Option<Correlation>,
    /// Records that no method could use, by reason.
    pub unusable: Vec<Unusable>,
}

/// The fitted model beside a campaign's records.
pub fn replay(input: &Input<'_>) -> Compared {
    let chosen = replays::chosen_records(input);
    // the map's cells keep all threads busy, what rests on the blocks of the identification few
    let ((region_map, curves, comparisons), (residuals, impacts)) = rayon::join(
        || {
            (
                plane::region_map(input),
                plane::curves(input),
                replays::comparisons(input, &chosen),
            )
        },
        || (evidence::residuals(input), evidence::impacts(input)),
    );
    Compared {
        overview: records::overview(input),
        records: records::records(input, &chosen),
        brackets: records::brackets(input),
        curves,
        region_map,
        comparisons,
        resonance: evidence::resonance(input),
        impacts,
        free_decays: decays::free_decays(input),
        residuals,
        correlation: evidence::correlation(input),
        unusable: left_out::unusable(input.observations),
    }
}

/// Where a campaign's records, brackets and fitted boundaries are in the (η, ρ) plane.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlacedRecord {
    /// One row per record.
    pub records: Vec<RecordRow>,
    /// Measured brackets of the boundaries.
    pub brackets: Vec<BracketRow>,
    /// Simulated boundaries with their 95 % bands.
    pub curves: Vec<BoundaryCurve>,
}

/// Place every record, bracket and boundary; nothing is replayed.
pub fn placed(input: &Input<'_>) -> PlacedRecord {
    PlacedRecord {
        records: records::all_records(input),
        brackets: records::brackets(input),
        curves: plane::curves(input),
    }
}

#[cfg(any(test, feature = "fixture"))]
pub mod fixture;
#[cfg(test)]
mod tests;
