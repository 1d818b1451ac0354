//! Change of a record's values by effects that act as a small extra acceleration along the orbit.

use super::{Measured, RecordMotion, add, measured};
use crate::identify::fit::effect::Effect;
use impact_oscillator::model::params::Oscillator;
use impact_oscillator::model::perturbation::{Grid, PeriodicResponse};
use impact_oscillator::model::sensitivity::{Change, MassMotion};

/// Nodes of a drive period on which extra accelerations are taken.
const NODES: usize = 128;

impl RecordMotion<'_> {
    /// Change of the values by an effect that acts as a small extra acceleration, per unit of its
    /// strength, to first order; `reach_m` is the displacement at which springs change and drag acts by that much.
    pub fn perturbation(&self, values: &[f64], effect: Effect, reach_m: f64) -> Vec<f64> {
        let intervals = NODES * self.record.folded.periods_n as usize;
        let grid = Grid::new(self.period(), intervals);
        let masses = [
            Some((self.machine.x, self.orbit.x)),
            self.machine.y.map(|y| (y, self.orbit.y)),
        ];
        let responses = masses.map(|mass| {
            let (oscillator, motion) = mass?;
            let p = self.accelerations(&oscillator, &motion, grid, (effect, reach_m));
            Some(PeriodicResponse::new(&oscillator, grid, &p))
        });
        let at_impact = responses.iter().flatten().map(PeriodicResponse::at_impact);
        let [displacement, velocity] =
            at_impact.fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
        let change = Change {
            displacement,
            velocity,
            ..Change::default()
        };
        let mut slopes = self.along(values, &self.direction(&change, None));
        let extra = self.channel_by_channel(|channel, vibration| {
            let Some(response) = &responses[usize::from(channel.role.is_of_y())] else {
                return vec![0.0; channel.points];
            };
            let mut seen = match measured(channel.role) {
                Measured::Displacement => response.displacement(),
                Measured::Velocity => response.velocity(),
            };
            if let Some(filter) = &channel.filter {
                seen = seen.high_passed(filter.high_pass.corner());
            }
            let times = vibration.time().iter();
            let times = times.map(|t| (t - channel.delay).rem_euclid(self.period()));
            times.map(|t| seen.at(t)).collect()
        });
        add(&mut slopes, 1.0, &extra);
        slopes
    }

    /// The extra acceleration of one mass at the nodes, per unit of an effect's strength.
    fn accelerations(
        &self,
        oscillator: &Oscillator,
        motion: &MassMotion,
        grid: Grid,
        (effect, reach_m): (Effect, f64),
    ) -> Vec<f64> {
        let length_m = self.own.static_deflection_m * self.record.drive_amplitude;
        let harmonic = |order: f64, lag: f64| -> Vec<f64> {
            let force = oscillator.drive_per_mass();
            let phase = |t: f64| order * (self.orbit.phase + self.eta * t) - lag;
            grid.times().map(|t| force * phase(t).cos()).collect()
        };
        let states = || grid.states(motion, self.orbit.phase, self.eta);
        match effect {
            Effect::SecondHarmonicCos => harmonic(2.0, 0.0),
            Effect::SecondHarmonicSin => harmonic(2.0, std::f64::consts::FRAC_PI_2),
            Effect::ThirdHarmonicCos => harmonic(3.0, 0.0),
            Effect::ThirdHarmonicSin => harmonic(3.0, std::f64::consts::FRAC_PI_2),
            Effect::Hardening => {
                let share = oscillator.stiffness_per_mass() * (length_m / reach_m).powi(2);
                states().iter().map(|s| -share * s[0].powi(3)).collect()
            }
            Effect::Friction => {
                let force = self.common.static_deflection_m / length_m;
                friction(&states()).iter().map(|p| force * p).collect()
            }
            Effect::Drag => {
                let share = self.common.static_deflection_m * length_m / reach_m.powi(2);
                let drag = |s: &[f64; 2]| -share * s[1] * s[1].abs();
                states().iter().map(drag).collect()
            }
            Effect::SpringAsymmetry => {
                let share = oscillator.stiffness_per_mass() * length_m / reach_m;
                states().iter().map(|s| -share * s[0].powi(2)).collect()
            }
            _ => vec![0.0; grid.intervals + 1],
        }
    }
}

/// Coulomb friction of unit size, −sign X', at the nodes; where X' changes its sign, the mean over
/// the node's neighbourhood.
fn friction(states: &[[f64; 2]]) -> Vec<f64> {
    let change = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(states.len() - 1));
        0.5 * (states[b][1] - states[a][1]).abs()
    };
    let of =
        |(k, s): (usize, &[f64; 2])| -(s[1] / change(k).max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
    states.iter().enumerate().map(of).collect()
}
