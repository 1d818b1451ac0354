//! The evidence of a campaign sorted by what it determines, and the nuisances that come with it.
//!
//! Each kind is a block of residuals of its own: impactless records ([`resonance`]), periodic ones
//! ([`trajectory`]), brackets of boundaries ([`boundary`]), speeds at impacts ([`impacts`]) and records
//! that are followed from impact to impact ([`flights`]).

pub mod boundary;
pub mod contact_law;
pub mod direction;
pub mod flights;
mod groups;
pub mod high_pass;
pub mod impacts;
pub mod influence;
pub mod jump;
pub mod nearest_orbit;
pub mod options;
pub mod pickup;
pub mod record_motion;
pub mod reduced_record;
pub mod resonance;
pub mod shared_error;
pub mod structure;
pub mod trajectory;
pub mod trajectory_record;
pub mod waveform;
pub mod weighing;
mod within_record;

use crate::identify::evidence::boundary::BoundaryBlock;
use crate::identify::evidence::flights::FlightBlock;
use crate::identify::evidence::impacts::{ImpactBlock, SpeedPair};
use crate::identify::evidence::options::UncertaintyOptions;
use crate::identify::evidence::pickup::Pickups;
use crate::identify::evidence::resonance::ResonanceBlock;
use crate::identify::evidence::trajectory::TrajectoryBlock;
use crate::identify::parameters::effect::{Effect, Effects};
use crate::identify::parameters::gap_errors::MOST_GAPS;
use crate::identify::parameters::{CHANNELS, Coordinate, Parameters, gain_index};
use crate::identify::solver::group::Group;
use crate::identify::solver::{Block, Fit, FitProgress, Prior, Problem};
use impact_records::event::{FlightKind, RigKind};
use impact_records::motion::{Bracket, Observation};
use impact_records::signal::robust;

/// What the laboratory states about its rig.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nominal {
    /// R
    pub restitution: Option<f64>,
    /// f0, Hz
    pub natural_frequency_hz: Option<f64>,
    /// β
    pub damping_ratio: Option<f64>,
    /// `x_st`, m
    pub static_deflection_m: Option<f64>,
    /// Standard uncertainty of the channels' gains, relative.
    pub gain_uncertainty: f64,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: f64,
    /// Standard uncertainty of the sampler's clock, relative.
    pub clock_uncertainty: f64,
    /// Standard uncertainty of each stated clearance, and of the zero that all share, m.
    pub clearance_uncertainty_m: f64,
    /// Delay of the motion channels against the drive's, s, by the index of their gains.
    pub delays_s: [f64; CHANNELS],
    /// Standard uncertainties of those delays, s; `None`: half a sample.
    pub delay_uncertainties_s: [Option<f64>; CHANNELS],
    /// ln(`m_x`/`m_y`) with its standard uncertainty; `None`: masses that were made alike.
    pub mass_asymmetry: Option<[f64; 2]>,
    /// Effects that the fit allows beyond the model.
    pub effects: Effects,
    /// What moves the masses between impacts.
    pub flight: FlightKind,
}

impl Nominal {
    /// Parameters with the stated delays and masses.
    pub fn applied(&self, parameters: Parameters) -> Parameters {
        Parameters {
            delays_s: self.delays_s,
            mass_asymmetry: self.mass_asymmetry.map_or(0.0, |[centre, _]| centre),
            ..parameters
        }
    }

    /// The same rig without errors of clearances, delays and effects beyond the model: for a first
    /// fit, whose result the changes by them are taken at.
    #[must_use]
    pub fn ideal(&self) -> Self {
        Self {
            clearance_uncertainty_m: 0.0,
            delay_uncertainties_s: [Some(0.0); CHANNELS],
            mass_asymmetry: self.mass_asymmetry.map(|[centre, _]| [centre, 0.0]),
            effects: Effects::none(),
            ..*self
        }
    }
}

/// Everything an identification starts from.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// One or two masses.
    pub rig: RigKind,
    /// All records as observed.
    pub observations: &'a [Observation],
    /// All brackets.
    pub brackets: &'a [Bracket],
    /// What is stated.
    pub nominal: Nominal,
    /// What is asked for of the uncertainty.
    pub uncertainty: UncertaintyOptions,
    /// What counts the iterations of the fits, if anything shows them.
    pub progress: Option<&'a FitProgress>,
}

/// Relative error of instruments and model that noise does not show.
const RELATIVE_ERROR: f64 = 3e-4;
/// Robust deviations beyond which an impact's ratio is an outlier.
const OUTLYING_IMPACT: f64 = 5.0;
/// Scatter of single impacts' ratios beside the noise.
const IMPACT_SCATTER: f64 = 1e-3;
/// What the extrapolation of speeds to the impact leaves open in R.
const IMPACT_BIAS: f64 = 2e-4;
/// What it leaves open beside that where a contact has a length: all of it from `SHORT_CONTACT_MS` on, and
/// more per ms.
const CONTACT_BIAS: f64 = 2.5e-3;
const CONTACT_BIAS_PER_MS: f64 = 3e-3;
/// What channels that are late by different delays leave open beside that, per ms between the first and the last.
const DELAY_BIAS_PER_MS: f64 = 3e-3;
/// A contact that the flights' extrapolation begins to notice, ms.
const SHORT_CONTACT_MS: f64 = 0.1;

/// What the extrapolation of speeds to the impacts and the law of contact leave open in R, with the length of a contact and the
/// delays of the channels that a fit of waveforms found. Where the fit tells nothing of the length, all of what
/// a good laboratory would accept is left, if the rig may have it (`effects`) and is driven through its impacts.
pub fn impact_bias(block: &ImpactBlock, waveforms: &Fit, effects: Effects) -> f64 {
    let length = Effect::ContactDuration;
    let untold = !waveforms.free.contains(&Coordinate::Effect(length));
    let contact_ms = if untold && !block.free && effects.iter().any(|e| e == length) {
        length.accepted()
    } else {
        waveforms.parameters.effect(length)
    };
    let noticed = (contact_ms / SHORT_CONTACT_MS).clamp(-1.0, 1.0);
    let delays_s = robust::range(waveforms.parameters.delays_s);
    let apart_ms = delays_s.map_or(0.0, |(first, last)| 1e3 * (last - first));
    IMPACT_BIAS
        .hypot(CONTACT_BIAS * noticed)
        .hypot(CONTACT_BIAS_PER_MS * contact_ms)
        .hypot(DELAY_BIAS_PER_MS * apart_ms)
        .hypot(block.open_by_law())
}

/// Asymmetry that a well-made rig may have.
const ASYMMETRY: f64 = 0.05;
/// Asymmetry of masses that were made alike.
const MASS_ASYMMETRY: f64 = 0.01;

/// The observations sorted by what they tell.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Impactless records.
    pub resonance: ResonanceBlock,
    /// z = 1/n records.
    pub trajectory: TrajectoryBlock,
    /// Brackets of s2, s1 and grazing.
    pub boundary: BoundaryBlock,
    /// Speeds at impacts.
    pub impact: ImpactBlock,
    /// Records that are shot from impact to impact.
    pub flight: FlightBlock,
    /// Impacts left out as outliers.
    pub impact_outliers: Vec<SpeedPair>,
    /// Stated clearances that carry an error of their own, m, rising.
    pub gaps_m: Vec<f64>,
    /// Half a sample, s.
    half_sample_s: f64,
    /// What counts the iterations of the fits.
    pub progress: FitProgress,
}

/// The pairs of speeds at impacts, and apart from them those that lie far from the bulk.
fn impacts(
    rig: RigKind,
    observations: &[Observation],
    scatter: f64,
) -> (ImpactBlock, Vec<SpeedPair>) {
    let mut block = ImpactBlock::new(rig, observations, scatter);
    // Where R differs between bounces or records, an impact far from the others is one of that structure.
    let structure = structure::structure(&structure::ratios(&block, observations));
    // Such ratios differ from record to record.
    let outliers = if block.first_value_only.is_some() || structure.is_some() {
        Vec::new()
    } else {
        block.extract_outliers(OUTLYING_IMPACT)
    };
    within_record::share(&mut block);
    (block, outliers)
}

/// The pairs of speeds at impacts that [`Blocks::new`] has.
pub fn impacts_of_bulk(rig: RigKind, observations: &[Observation]) -> ImpactBlock {
    impacts(rig, observations, IMPACT_SCATTER).0
}

impl Blocks {
    /// Sort the evidence.
    pub fn new(evidence: &Evidence<'_>) -> Self {
        Self::with_errors(evidence, RELATIVE_ERROR, IMPACT_SCATTER)
    }

    /// The evidence without allowance for anything but noise.
    pub fn with_noise_alone(evidence: &Evidence<'_>) -> Self {
        Self::with_errors(evidence, 0.0, 0.0)
    }

    fn with_errors(evidence: &Evidence<'_>, relative_error: f64, impact_scatter: f64) -> Self {
        let Evidence {
            rig,
            observations,
            brackets,
            ..
        } = *evidence;
        let (mut impact, impact_outliers) = impacts(rig, observations, impact_scatter);
        // records of springs whose drive was not recorded have no free flights
        impact.free &= evidence.nominal.flight == FlightKind::ConstantForce;
        let mut blocks = Self {
            resonance: ResonanceBlock::new(rig, observations, relative_error),
            trajectory: TrajectoryBlock::new(rig, observations, relative_error),
            boundary: BoundaryBlock::new(rig, brackets),
            impact,
            flight: FlightBlock::new(rig, observations),
            impact_outliers,
            gaps_m: Vec::new(),
            half_sample_s: half_sample_s(observations),
            progress: evidence.progress.cloned().unwrap_or_default(),
        };
        blocks.place(&places(observations), &groups::groups(observations));
        blocks.give_gaps_errors(evidence.nominal.clearance_uncertainty_m);
        let reach_m = reach_m(observations);
        (blocks.trajectory.reach_m, blocks.resonance.reach_m) = (reach_m, reach_m);
        let pickups = Pickups::of(observations);
        (blocks.trajectory.pickups, blocks.resonance.pickups) = (pickups, pickups);
        blocks.trajectory.effects = evidence.nominal.effects;
        blocks
    }

    /// Half the time between two samples in the median record, s.
    pub fn half_sample_s(&self) -> f64 {
        self.half_sample_s
    }

    /// Read the speeds at impacts with the delays of the channels that waveforms tell; whether any depends on
    /// them.
    pub fn delay_impacts(&mut self, waveforms: &Parameters) -> bool {
        if self.impact.first_value_only.is_some() || !self.impact.has_lags() {
            return false;
        }
        let outliers = std::mem::take(&mut self.impact_outliers);
        self.impact.delay(outliers, waveforms);
        self.impact_outliers = self.impact.extract_outliers(OUTLYING_IMPACT);
        within_record::share(&mut self.impact);
        true
    }

    /// The same with other periodic records.
    #[must_use]
    pub fn with_trajectory(&self, trajectory: TrajectoryBlock) -> Self {
        Self {
            trajectory,
            resonance: self.resonance.clone(),
            boundary: self.boundary.clone(),
            impact: self.impact.clone(),
            flight: self.flight.clone(),
            impact_outliers: self.impact_outliers.clone(),
            gaps_m: self.gaps_m.clone(),
            half_sample_s: self.half_sample_s,
            progress: self.progress.clone(),
        }
    }

    /// A problem over some of the blocks, whose fits are counted.
    pub fn problem<'b>(
        &self,
        blocks: Vec<(&'b dyn Block, f64)>,
        free: Vec<Coordinate>,
        priors: Vec<Prior>,
    ) -> Problem<'b> {
        Problem {
            blocks,
            priors,
            free,
            progress: self.progress.clone(),
            ..Problem::default()
        }
    }

    /// Set when in the campaign each record was taken, and its group.
    fn place(&mut self, places: &[f64], groups: &[Group]) {
        for point in &mut self.resonance.points {
            point.place = places[point.observation];
            point.group = groups[point.observation];
        }
        let records = self.trajectory.records.iter();
        let speeds: Vec<f64> = records.map(|r| r.closing_speed_m_s).collect();
        let by_impacts = Some(self.impact.typical_approach_m_s).filter(|v| *v > 0.0);
        let typical_m_s = by_impacts.or_else(|| robust::median(&speeds));
        let typical_m_s = typical_m_s.unwrap_or(0.0);
        for record in &mut self.trajectory.records {
            record.typical_approach_m_s = typical_m_s;
            record.place = places[record.observation];
            record.group = groups[record.observation];
        }
        for record in &mut self.flight.records {
            record.group = groups[record.observation];
        }
    }

    /// Give each stated clearance an error of its own: a coordinate where several records have it, a
    /// shared error of its points where one has.
    fn give_gaps_errors(&mut self, uncertainty_m: f64) {
        let mut counts: Vec<(f64, usize)> = Vec::new();
        let folded = self.trajectory.records.iter().map(|r| r.clearance_m);
        // A record that is shot from impact to impact shares no error of its points: its clearance has its own.
        let shot = self.flight.records.iter();
        let shot = shot.flat_map(|r| [r.clearance_m; 2]);
        let mut stated: Vec<f64> = folded.chain(shot).collect();
        stated.sort_by(f64::total_cmp);
        for clearance_m in stated {
            match counts.last_mut() {
                Some((last, count)) if *last == clearance_m => *count += 1,
                _ => counts.push((clearance_m, 1)),
            }
        }
        let several = counts.iter().filter(|(_, count)| *count > 1);
        let gaps_m: Vec<f64> = several.map(|(gap, _)| *gap).collect();
        if gaps_m.len() <= MOST_GAPS {
            self.gaps_m = gaps_m;
        }
        let of = |clearance_m: f64| self.gaps_m.iter().position(|gap| *gap == clearance_m);
        for record in &mut self.trajectory.records {
            record.gap = of(record.clearance_m);
            record.lone_clearance_error_m = match record.gap {
                Some(_) => 0.0,
                None => uncertainty_m,
            };
        }
        for record in &mut self.flight.records {
            record.gap = of(record.clearance_m);
        }
    }

    /// Whether any channel of an index is measured whose corner passes a test.
    fn measures(&self, index: usize, test: impl Fn(Option<f64>) -> bool) -> bool {
        let mut channels = self.resonance.channels().chain(self.trajectory.channels());
        channels.any(|(role, corner_hz)| gain_index(role) == Some(index) && test(corner_hz))
    }

    /// Whether the channel of an index is measured.
    pub fn sees(&self, index: usize) -> bool {
        self.measures(index, |_| true)
    }

    /// Gains of which any channel is measured.
    fn gains(&self) -> impl Iterator<Item = Coordinate> {
        (0..CHANNELS)
            .filter(|i| self.sees(*i) || self.flight.has_gain(*i))
            .map(Coordinate::Gain)
    }

    /// Corners of the channels that have passed a high-pass.
    fn corners(&self) -> impl Iterator<Item = Coordinate> {
        let filtered = |i: &usize| {
            let speeds = self.impact.has_corner(*i) || self.flight.has_corner(*i);
            speeds || self.measures(*i, |corner_hz| corner_hz.is_some())
        };
        (0..CHANNELS).filter(filtered).map(Coordinate::Corner)
    }

    /// Add the nuisance coordinates on which a fit of some blocks depends, with their priors: the
    /// channels' gains and corners, and asymmetry.
    pub fn add_nuisances(
        &self,
        nominal: &Nominal,
        fitted: &[(&dyn Block, f64)],
        (free, priors): (&mut Vec<Coordinate>, &mut Vec<Prior>),
    ) {
        let touched = |c: &Coordinate| fitted.iter().any(|(block, _)| block.touches(*c));
        let gain = nominal.gain_uncertainty.max(1e-6);
        let corner = nominal.corner_uncertainty.max(1e-6);
        let effects = nominal.effects.iter();
        let all = (self.gains().map(|c| Prior::new(c, 0.0, gain)))
            .chain(self.corners().map(|c| Prior::new(c, 0.0, corner)))
            .chain(self.delays(nominal))
            .chain(self.asymmetries(nominal))
            .chain(self.clearances(nominal))
            .chain(effects.map(|e| Prior::new(Coordinate::Effect(e), 0.0, e.accepted())));
        for prior in all.filter(|p| p.deviation > 0.0 && touched(&p.coordinate)) {
            free.push(prior.coordinate);
            priors.push(prior);
        }
    }

    /// Delays of the channels that are measured, ms.
    fn delays(&self, nominal: &Nominal) -> impl Iterator<Item = Prior> {
        let measured = (0..CHANNELS).filter(|i| self.sees(*i));
        measured.map(|i| {
            let uncertainty_s = nominal.delay_uncertainties_s[i].unwrap_or(self.half_sample_s);
            let centre = 1e3 * nominal.delays_s[i];
            Prior::new(Coordinate::Delay(i), centre, 1e3 * uncertainty_s)
        })
    }

    /// How two masses may differ, whether both are measured or the motion of one shows the other.
    fn asymmetries(&self, nominal: &Nominal) -> impl Iterator<Item = Prior> {
        let [centre, deviation] = nominal.mass_asymmetry.unwrap_or([0.0, MASS_ASYMMETRY]);
        let all = [
            Prior::new(Coordinate::DriveAsymmetry, 0.0, ASYMMETRY),
            Prior::new(Coordinate::StiffnessAsymmetry, 0.0, ASYMMETRY),
            Prior::new(Coordinate::DampingAsymmetry, 0.0, ASYMMETRY),
            Prior::new(Coordinate::MassAsymmetry, centre, deviation),
        ];
        let two = self.resonance.rig == RigKind::Double;
        all.into_iter().filter(move |_| two)
    }

    /// Errors of the clearances, mm: one that all share and one of each stated.
    fn clearances(&self, nominal: &Nominal) -> impl Iterator<Item = Prior> {
        let deviation = 1e3 * nominal.clearance_uncertainty_m;
        let gaps = (0..self.gaps_m.len()).map(Coordinate::Gap);
        let all = std::iter::once(Coordinate::ScrewZero).chain(gaps);
        all.map(move |coordinate| Prior::new(coordinate, 0.0, deviation))
    }
}

/// Place of each record in the campaign, −½ (first) … ½ (last), by the order of acquisition.
fn places(observations: &[Observation]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..observations.len()).collect();
    order.sort_by_key(|i| observations[*i].setting.sequence);
    let last = order.len().saturating_sub(1).max(1) as f64;
    let mut places = vec![0.0; observations.len()];
    for (rank, i) in order.into_iter().enumerate() {
        places[i] = rank as f64 / last - 0.5;
    }
    places
}

/// Half the time between two samples in the median record, s.
fn half_sample_s(observations: &[Observation]) -> f64 {
    let rates: Vec<f64> = observations.iter().map(|o| o.sample_rate_hz).collect();
    robust::median(&rates)
        .filter(|r| *r > 0.0)
        .map_or(0.0, |r| 0.5 / r)
}

/// The greatest displacement of the campaign, m.
fn reach_m(observations: &[Observation]) -> f64 {
    let usable = observations.iter().filter(|o| !o.excluded());
    let most = usable.map(groups::amplitude).fold(0.0, f64::max);
    if most > 0.0 { most } else { 1.0 }
}
