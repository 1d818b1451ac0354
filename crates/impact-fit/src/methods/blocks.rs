//! The evidence of a campaign sorted by what it determines, a block of residuals for each method, and the
//! nuisances that come with them.

use crate::evidence::pickup::Pickups;
use crate::evidence::{Evidence, Nominal};
use crate::method::Method;
use crate::methods::boundaries::block::BoundaryBlock;
use crate::methods::flights::block::FlightBlock;
use crate::methods::groups;
use crate::methods::impacts::block::{ImpactBlock, SpeedPair};
use crate::methods::impacts::{structure, within_record};
use crate::methods::resonance::block::ResonanceBlock;
use crate::methods::trajectories::block::TrajectoryBlock;
use crate::parameters::gap_errors::MOST_GAPS;
use crate::parameters::{CHANNELS, Coordinate, Parameters, gain_index};
use crate::solver::group::Group;
use crate::solver::{Block, FitProgress, Prior, Problem};
use impact_records::event::{FlightKind, RigKind};
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Relative error of instruments and model that noise does not show.
const RELATIVE_ERROR: f64 = 3e-4;
/// Robust deviations beyond which an impact's ratio is an outlier, as the remark and docs/theory.md say.
const OUTLYING_IMPACT: f64 = 5.0;
/// Scatter of single impacts' ratios beside the noise.
const IMPACT_SCATTER: f64 = 1e-3;
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
    /// The approach speed at which R is stated where it depends on it, m/s: the median of all impacts or, where their
    /// speeds are not measured, of the periodic records; 0 without impacts.
    pub typical_approach_m_s: f64,
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
        let open_gains = evidence.nominal.open_gains;
        let unlike = evidence.nominal.drive_asymmetry;
        impact.read_by = unlike.map(|_| open_gains.map(|gain| gain.map_or(1.0, f64::exp)));
        let mut blocks = Self {
            resonance: ResonanceBlock::new(rig, observations, relative_error),
            trajectory: TrajectoryBlock::new(rig, observations, relative_error),
            boundary: BoundaryBlock::new(rig, brackets),
            impact,
            flight: FlightBlock::new(rig, observations),
            impact_outliers,
            gaps_m: Vec::new(),
            typical_approach_m_s: 0.0,
            half_sample_s: half_sample_s(observations),
            progress: evidence.progress.cloned().unwrap_or_default(),
        };
        if let Some([asymmetry, _]) = evidence.nominal.drive_asymmetry {
            blocks.resonance.without_undriven(asymmetry);
        }
        blocks.place(&places(observations), &groups::groups(observations));
        blocks.give_gaps_errors(evidence.nominal.clearance_uncertainty_m);
        let reach_m = reach_m(observations);
        (blocks.trajectory.reach_m, blocks.resonance.reach_m) = (reach_m, reach_m);
        let pickups = Pickups::of(observations);
        (blocks.trajectory.pickups, blocks.resonance.pickups) = (pickups, pickups);
        blocks.trajectory.effects = evidence.nominal.effects;
        blocks
    }

    /// The residuals that a method fits; `None` of a method that has no block.
    pub fn of(&self, method: Method) -> Option<&dyn Block> {
        match method {
            Method::Resonance => Some(&self.resonance),
            Method::Trajectories => Some(&self.trajectory),
            Method::Boundaries => Some(&self.boundary),
            Method::Impacts => Some(&self.impact),
            Method::Flights => Some(&self.flight),
            Method::FlightTimes | Method::FreeDecay | Method::PublishedSpeeds => None,
        }
    }

    /// The observation of each item of a method's block; none where an item is of several.
    pub fn owners(&self, method: Method) -> Vec<usize> {
        self.of(method).map_or_else(Vec::new, Block::owners)
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
            typical_approach_m_s: self.typical_approach_m_s,
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
        self.typical_approach_m_s = typical_m_s;
        for record in &mut self.trajectory.records {
            record.typical_approach_m_s = typical_m_s;
            record.place = places[record.observation];
            record.group = groups[record.observation];
        }
        for pair in &mut self.impact.pairs {
            pair.place = places[pair.observation];
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
    pub fn gains(&self) -> impl Iterator<Item = Coordinate> {
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
        free: &mut Vec<Coordinate>,
        priors: &mut Vec<Prior>,
    ) {
        let touched = |c: &Coordinate| fitted.iter().any(|(block, _)| block.touches(*c));
        let gain = |coordinate: Coordinate| {
            let open = coordinate.gain().and_then(|i| nominal.open_gains[i]);
            let stated = [0.0, nominal.gain_uncertainty.max(1e-6)];
            let [centre, deviation] = open.map_or(stated, |value| [value, value.abs()]);
            Prior::new(coordinate, centre, deviation)
        };
        let corner = nominal.corner_uncertainty.max(1e-6);
        let effects = nominal.effects.iter();
        let all = (self.gains().map(gain))
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

    /// How two masses may differ, whether both are measured or the motion of one shows the other. Drive, stiffness and
    /// damping are per unit of mass: where masses are stated that differ, those may differ as much.
    pub fn asymmetries(&self, nominal: &Nominal) -> impl Iterator<Item = Prior> {
        let [centre, deviation] = nominal.mass_asymmetry.unwrap_or([0.0, MASS_ASYMMETRY]);
        let others = ASYMMETRY.hypot(centre);
        let [drives, of_drives] = nominal.drive_asymmetry.unwrap_or([0.0, others]);
        let all = [
            Prior::new(Coordinate::DriveAsymmetry, drives, of_drives),
            Prior::new(Coordinate::StiffnessAsymmetry, 0.0, others),
            Prior::new(Coordinate::DampingAsymmetry, 0.0, others),
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

/// Place of each record that is used in the campaign, −½ (the first) … ½ (the last), by the order of acquisition; zero
/// of the others, which are no part of what was measured.
fn places(observations: &[Observation]) -> Vec<f64> {
    let used = |i: &usize| !observations[*i].excluded();
    let mut order: Vec<usize> = (0..observations.len()).filter(used).collect();
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

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Motion;
    use impact_records::record::{Flag, Problem};

    #[test]
    fn records_that_are_not_there_move_no_other_in_time() {
        let mut all: Vec<Observation> = (0..6)
            .map(|_| Observation::of("r", 10.0, Motion::Impactless))
            .collect();
        for (i, observation) in all.iter_mut().enumerate() {
            observation.setting.sequence = i;
        }
        for missing in &mut all[3..] {
            missing.flags = vec![Flag::new(None, Problem::NoTimes)];
        }
        assert_eq!(places(&all)[..3], [-0.5, 0.0, 0.5]);
    }
}
