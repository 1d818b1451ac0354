//! Periodic records z = 1/n against the closed-form periodic orbit.

use rayon::prelude::*;

use crate::evidence::pickup::Pickups;
use crate::evidence::waveform::{Phases, Terms};
use crate::methods::thinning::evenly_over;
use crate::methods::trajectories::nearest_orbit::NearestOrbit;
use crate::methods::trajectories::record::{Perturbation, TrajectoryRecord};
use crate::methods::trajectories::record_motion::{Column, RecordMotion, Slopes};
use crate::parameters::effect::{Acts, Effect, Effects};
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Block;
use crate::solver::group::Group;
use crate::solver::rows::Rows;
use impact_oscillator::model::flight::State;
use impact_oscillator::model::orbit::orbit_with_speed;
use impact_records::event::RigKind;
use impact_records::motion::Folded;
use impact_records::motion::Observation;
use impact_records::record::Role;

/// All periodic records with one impact in n drive periods.
#[derive(Debug, Clone)]
pub struct TrajectoryBlock {
    /// One or two masses.
    pub rig: RigKind,
    /// The records.
    pub records: Vec<TrajectoryRecord>,
    /// Relative error added to every point: what instruments and model leave open.
    relative_error: f64,
    /// Effects that the fit allows beyond the model.
    pub effects: Effects,
    /// Displacement at which springs harden by the strength of that effect, m.
    pub reach_m: f64,
    /// What channels may pick up from the drive.
    pub pickups: Pickups,
    /// Whether contacts may grow shorter with the speed.
    pub contact_speed: bool,
}

impl TrajectoryBlock {
    /// Collect the records that may be used.
    pub fn new(rig: RigKind, observations: &[Observation], relative_error: f64) -> Self {
        let records = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| !o.excluded() && o.classification.confidence >= 0.7)
            .filter_map(|(i, o)| trajectory_record(i, o))
            .collect();
        Self::of_records(rig, records, relative_error)
    }

    /// Of given records, on a rig without effects beyond the model.
    pub fn of_records(rig: RigKind, records: Vec<TrajectoryRecord>, relative_error: f64) -> Self {
        let mut block = Self {
            rig,
            records,
            relative_error,
            effects: Effects::none(),
            reach_m: 1.0,
            pickups: Pickups::default(),
            contact_speed: false,
        };
        block.allow(relative_error);
        block
    }

    /// A block like this one of other records.
    #[must_use]
    pub fn with_records(&self, records: Vec<TrajectoryRecord>) -> Self {
        let mut other = Self { records, ..*self };
        other.allow(self.relative_error);
        other
    }

    /// Of so many records at most, evenly chosen over the frequency of the drive.
    #[must_use]
    pub fn few(&self, most: usize) -> Self {
        self.with_records(evenly_over(&self.records, most, |record| {
            record.frequency_hz
        }))
    }

    /// Relative error that every point is allowed beside the noise.
    pub fn relative_error(&self) -> f64 {
        self.relative_error
    }

    /// Allow every point a relative error beside the noise.
    pub fn allow(&mut self, relative_error: f64) {
        self.relative_error = relative_error;
        self.records
            .par_iter_mut()
            .for_each(|record| record.weigh(relative_error));
    }

    /// Measured less modelled values of each record, not weighted; `None` where there is no such orbit.
    pub fn differences(&self, parameters: &Parameters) -> Vec<Option<Vec<f64>>> {
        let of = |record: &TrajectoryRecord| {
            let motion = RecordMotion::new(self.rig, record, parameters)?;
            Some(record.apart(&motion.values()))
        };
        self.records.par_iter().map(of).collect()
    }

    /// Role and high-pass corner, Hz, of every channel of every record.
    pub fn channels(&self) -> impl Iterator<Item = (Role, Option<f64>)> {
        let channels = self.records.iter().flat_map(|r| &r.folded.channels);
        channels.map(|c| (c.role, c.high_pass_hz))
    }

    /// Greatest modulus of the multipliers of a record's orbit; `None` where there is none.
    pub fn slowest_multiplier(&self, item: usize, parameters: &Parameters) -> Option<f64> {
        let record = &self.records[item];
        let found = NearestOrbit::of(self.rig, record, parameters)?;
        let n = record.folded.periods_n;
        let orbit = orbit_with_speed(&found.machine, found.setting, n, found.closing_speed);
        orbit.multipliers.first().map(|m| m.norm())
    }

    /// Find at good parameters what phase and frequency of the drive, a lone clearance and the
    /// effects beyond the model change in every record.
    pub fn find_changes(&mut self, parameters: &Parameters) {
        let changes: Vec<Option<Changes>> = self
            .records
            .par_iter()
            .map(|record| self.changes(record, parameters))
            .collect();
        for (record, change) in self.records.iter_mut().zip(changes) {
            let change = change.unwrap_or_default();
            (record.shared, record.perturbations) = (change.shared, change.perturbations);
            record.press_per_s = change.press_per_s;
        }
        self.allow(self.relative_error);
    }

    /// Weighted residuals of a record and their slopes: distinct columns, and the sums of multiples of
    /// them that belong to the coordinates.
    fn weighted_slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<WeightedSlopes> {
        let record = &self.records[item];
        let motion = RecordMotion::new(self.rig, record, parameters)?;
        let terms = motion.unperturbed();
        let Slopes { columns, sums } = motion.slopes(&terms, coordinates);
        let reduced = record.reduced.as_ref();
        let near = reduced.and_then(|r| r.at(&motion.rates()));
        let (residuals, mut columns): (Vec<f64>, Vec<Vec<f64>>) = match near {
            Some(reduced) => {
                let weighted = |column: Column| match column {
                    Column::Terms(terms) => reduced.weighted(&terms),
                    Column::Effect(effect) => reduced.effect(effect),
                };
                let residuals = reduced.residuals(&terms, |e| motion.effect(e));
                (residuals, columns.into_iter().map(weighted).collect())
            }
            None => {
                let points = motion.points();
                let weighted = |column: Column| match column {
                    Column::Terms(terms) => record.weighing.weighted(&points.values(&terms)),
                    Column::Effect(effect) => match record.perturbation(effect) {
                        Some(own) => record.weighing.weighted(&own.values),
                        None => vec![0.0; record.points()],
                    },
                };
                let mut values = points.values(&terms);
                motion.perturb(&mut values);
                let residuals = record.weighing.weighted(&record.apart(&values));
                (residuals, columns.into_iter().map(weighted).collect())
            }
        };
        columns.iter_mut().flatten().for_each(|c| *c = -*c);
        Some((residuals, columns, sums))
    }

    /// Reduce the records to few rows about parameters.
    pub fn reduce(&mut self, parameters: &Parameters) {
        let rig = self.rig;
        self.records.par_iter_mut().for_each(|record| {
            let motion = RecordMotion::new(rig, record, parameters);
            record.reduced = motion.and_then(|motion| record.reduced_about(&motion.rates()));
        });
    }

    fn changes(&self, record: &TrajectoryRecord, parameters: &Parameters) -> Option<Changes> {
        let motion = RecordMotion::new(self.rig, record, parameters)?;
        let (terms, points) = (motion.unperturbed(), motion.points());
        let times = |slopes: Vec<Terms>, error: f64| {
            let slopes = points.values(&slopes);
            slopes.iter().map(|s| error * s).collect()
        };
        let mut shared: Vec<Vec<f64>> = vec![
            times(motion.over_phase(&terms), record.phase_error_rad),
            times(motion.over_frequency(&terms), record.frequency_error),
        ];
        if record.lone_clearance_error_m > 0.0 {
            let slopes = motion.over_clearance(&terms);
            shared.push(times(slopes, record.lone_clearance_error_m));
        }
        let allowed = self.effects.iter().filter(|e| e.is_perturbation());
        let (picked_up, forces): (Vec<Effect>, Vec<Effect>) =
            allowed.partition(|e| e.acts() == Acts::Channel);
        let forces = forces.into_iter();
        let mut perturbations = motion.perturbations(&points, forces, self.reach_m);
        let picked_up = picked_up.into_iter().filter(|e| self.pickups.has(*e));
        perturbations.extend(picked_up.map(|effect| Perturbation {
            effect,
            at_impact: [0.0; 2],
            values: motion.picked_up(&points, effect, &self.pickups),
        }));
        Some(Changes {
            shared,
            perturbations,
            press_per_s: motion.press_per_s(),
        })
    }
}

/// Residuals, distinct columns of slopes, and the sums of multiples of them.
type WeightedSlopes = (Vec<f64>, Vec<Vec<f64>>, Vec<Vec<(usize, f64)>>);

/// What is found of a record at good parameters.
#[derive(Default)]
struct Changes {
    shared: Vec<Vec<f64>>,
    perturbations: Vec<Perturbation>,
    press_per_s: f64,
}

fn trajectory_record(index: usize, o: &Observation) -> Option<TrajectoryRecord> {
    let drive = o.drive?;
    let folded = o.folded.clone()?;
    let speeds: Vec<f64> = o
        .impacts
        .iter()
        .filter_map(|i| i.approach_speed_before_m_s)
        .collect();
    Some(TrajectoryRecord {
        observation: index,
        frequency_hz: drive.frequency_hz,
        frequency_error: drive.frequency_error_hz / drive.frequency_hz,
        phase_error_rad: o.drive_phase_error_rad(),
        clearance_m: o.setting.clearance_m?,
        drive_amplitude: o.setting.drive_amplitude,
        phases: distinct_phases(&folded).into(),
        folded,
        closing_speed_m_s: impact_records::signal::robust::median(&speeds)?,
        ..TrajectoryRecord::default()
    })
}

/// The sets of phases that a record's channels have, each once.
pub fn distinct_phases(folded: &Folded) -> Vec<Phases> {
    let mut all: Vec<Phases> = Vec::new();
    for channel in &folded.channels {
        if !all.iter().any(|p| p.fit(&channel.points)) {
            all.push(Phases::of(&channel.points));
        }
    }
    all
}

/// Value of a motion channel in a state, SI, gain included.
pub fn channel_value(
    parameters: &Parameters,
    drive_amplitude: f64,
    role: Role,
    state: &State,
) -> f64 {
    let length = parameters.static_deflection_m * drive_amplitude;
    let speed = length * parameters.natural_rate();
    let value = match role {
        Role::VelocityX => state.vx * speed,
        Role::VelocityY => state.vy * speed,
        Role::DisplacementX => state.x * length,
        Role::DisplacementY => state.y * length,
        _ => f64::NAN,
    };
    value * parameters.gain(role)
}

impl Block for TrajectoryBlock {
    fn items(&self) -> usize {
        self.records.len()
    }

    fn owners(&self) -> Vec<usize> {
        self.records.iter().map(|item| item.observation).collect()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let record = &self.records[item];
        let values = RecordMotion::new(self.rig, record, parameters)?.values();
        Some(record.weighing.weighted(&record.apart(&values)))
    }

    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let (residuals, columns, sums) = self.weighted_slopes(item, parameters, coordinates)?;
        let total = |sum: &Vec<(usize, f64)>| {
            let mut total = vec![0.0; residuals.len()];
            for (i, times) in sum {
                total
                    .iter_mut()
                    .zip(&columns[*i])
                    .for_each(|(t, c)| *t += times * c);
            }
            total
        };
        let slopes = sums.iter().map(total).collect();
        Some((residuals, slopes))
    }

    fn rows(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
        weight: f64,
    ) -> Option<Rows> {
        let (residuals, columns, sums) = self.weighted_slopes(item, parameters, coordinates)?;
        let mut rows = Rows::of(&residuals, &columns, weight).combined(&sums);
        rows.count = self.records[item].points();
        Some(rows)
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        (0..self.records.len()).any(|item| self.item_touches(item, coordinate))
    }

    fn group(&self, item: usize) -> Option<Group> {
        Some(self.records[item].group)
    }

    fn item_touches(&self, item: usize, coordinate: Coordinate) -> bool {
        let record = &self.records[item];
        match coordinate {
            Coordinate::Gap(i) => record.gap == Some(i),
            Coordinate::Gain(i) | Coordinate::Corner(i) | Coordinate::Delay(i) => record.has(i),
            Coordinate::Effect(Effect::ContactSpeed) => self.contact_speed,
            Coordinate::Effect(effect) if effect.is_perturbation() => {
                record.perturbation(effect).is_some()
            }
            _ => true,
        }
    }
}
