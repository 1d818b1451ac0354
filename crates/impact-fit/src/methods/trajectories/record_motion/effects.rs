//! Change of a record's values by effects that act as a small extra acceleration along the orbit.

use super::points::MotionPoints;
use super::{ChannelMotion, Measured, RecordMotion, measured};
use crate::evidence::forces::{Lengths, MassCourse, acceleration};
use crate::evidence::pickup::Pickups;
use crate::methods::trajectories::record::Perturbation;
use crate::parameters::effect::Effect;
use impact_oscillator::model::params::Oscillator;
use impact_oscillator::model::path::C64;
use impact_oscillator::model::perturbation::{Grid, PeriodicResponses};

/// Nodes of a drive period on which extra accelerations are taken.
const NODES: usize = 128;

/// Effects that are followed together.
const TOGETHER: usize = 4;

/// The responses of a mass to effects that are followed together.
type Responses = PeriodicResponses<TOGETHER>;

/// The orbit at the nodes of a period.
struct Course {
    grid: Grid,
    /// e^{iθ} of the drive's phase θ.
    turns: Vec<C64>,
    /// Of each mass its displacements and velocities.
    masses: [Option<(Oscillator, Vec<[f64; 2]>)>; 2],
}

impl RecordMotion<'_> {
    /// What effects that act as a small extra acceleration change, per unit of their strengths: the masses' own
    /// responses to first order, and what these add at the impact. `reach_m` is the displacement at which springs
    /// change and drag acts by that much.
    pub fn perturbations(
        &self,
        points: &MotionPoints<'_>,
        effects: impl Iterator<Item = Effect>,
        reach_m: f64,
    ) -> Vec<Perturbation> {
        let course = self.course();
        let effects: Vec<Effect> = effects.collect();
        let changes = effects.chunks(TOGETHER);
        changes
            .flat_map(|together| self.perturbed(points, &course, together, reach_m))
            .collect()
    }

    /// What all points show of what a channel picks up from the drive, per unit of an effect's strength.
    pub fn picked_up(&self, points: &MotionPoints<'_>, effect: Effect, of: &Pickups) -> Vec<f64> {
        let channels = self.channels.iter().zip(points.times());
        let values = channels.flat_map(|(channel, times)| {
            let unit = of.unit(effect, channel.role) * self.record.drive_amplitude;
            let phases = times.iter().map(|time| self.orbit.phase + self.eta * time);
            phases.map(move |phase| unit * phase.cos())
        });
        values.collect()
    }

    fn course(&self) -> Course {
        let intervals = NODES * self.record.folded.periods_n as usize;
        let grid = Grid::new(self.period(), intervals);
        let phase = |t: f64| self.orbit.phase + self.eta * t;
        let masses = [
            Some((self.machine.x, self.orbit.x)),
            self.machine.y.map(|y| (y, self.orbit.y)),
        ];
        Course {
            grid,
            turns: grid
                .times()
                .map(|t| C64::from_polar(1.0, phase(t)))
                .collect(),
            masses: masses.map(|mass| {
                let (oscillator, motion) = mass?;
                let states = grid.states(&motion, self.orbit.phase, self.eta);
                Some((oscillator, states))
            }),
        }
    }

    /// What each of at most [`TOGETHER`] effects changes.
    fn perturbed(
        &self,
        points: &MotionPoints<'_>,
        course: &Course,
        effects: &[Effect],
        reach_m: f64,
    ) -> Vec<Perturbation> {
        let lengths = Lengths {
            unit_m: self.own.static_deflection_m * self.record.drive_amplitude,
            deflection_m: self.common.static_deflection_m,
            reach_m,
        };
        let responses = course.masses.each_ref().map(|mass| {
            let (oscillator, states) = mass.as_ref()?;
            let mass = MassCourse {
                oscillator,
                states,
                turns: &course.turns,
            };
            let mut p = vec![[0.0; TOGETHER]; states.len()];
            for (k, effect) in effects.iter().enumerate() {
                let own = acceleration(*effect, &mass, &lengths);
                p.iter_mut().zip(own).for_each(|(p, own)| p[k] = own);
            }
            Some(Responses::new(oscillator, course.grid, &p))
        });
        let at_impact: Vec<_> = responses
            .iter()
            .flatten()
            .map(Responses::at_impact)
            .collect();
        let count = points.times().map(<[f64]>::len).sum();
        let mut changes = vec![vec![0.0; count]; effects.len()];
        let mut place = 0;
        for (channel, times) in self.channels.iter().zip(points.times()) {
            if let Some(responses) = &responses[usize::from(channel.role.is_of_y())] {
                self.add_own(channel, times, responses, &mut changes, place);
            }
            place += times.len();
        }
        let found = effects.iter().zip(changes).enumerate();
        let of = |(k, (effect, values)): (usize, (&Effect, Vec<f64>))| Perturbation {
            effect: *effect,
            at_impact: [0, 1].map(|i| at_impact.iter().map(|at| at[k][i]).sum()),
            values,
        };
        found.map(of).collect()
    }

    /// Add to changes, from a place on, what the responses of a channel's mass are at its points, SI.
    fn add_own(
        &self,
        channel: &ChannelMotion,
        times: &[f64],
        responses: &Responses,
        changes: &mut [Vec<f64>],
        place: usize,
    ) {
        let mut seen = match measured(channel.role) {
            Measured::Displacement => responses.displacements(),
            Measured::Velocity => responses.velocities(),
            Measured::Acceleration => responses.accelerations(),
        };
        if let Some(high_pass) = &channel.high_pass {
            seen = seen.high_passed(high_pass.corner());
        }
        let unit = self.unit(channel.role);
        let delay = channel.delay + channel.low_pass.map_or(0.0, |filter| filter.delay);
        for (i, time) in times.iter().enumerate() {
            let own = seen.at((time - delay).rem_euclid(self.period()));
            let all = changes.iter_mut().zip(own);
            all.for_each(|(change, own)| change[place + i] += unit * own);
        }
    }
}
