//! What is known of the state along a record, by a Kalman filter from impact to impact.
//!
//! An impact's time is measured late by an error e, a part of its own and one that is common to the record. The flight
//! before the impact, continued until the measured time, is beyond the gap by what it closes in e, and the flight after it began e
//! before: its displacements differ by the jump of the velocities times e, its velocities by the jump of the accelerations and by
//! what the closing speed at the impact lacks of that e later. Both flights are followed through the e that is most likely, as
//! the curvature of the gap over e would take R down, and are linear about it (iterated extended Kalman filter; Bell and Cathey
//! 1993).

use nalgebra::{Matrix4, Matrix5, Matrix6, SVector, Vector4, Vector5, Vector6};

use impact_oscillator::model::flight::{Drive, State, free_flight};
use impact_oscillator::model::params::Machine;
use impact_oscillator::model::variation::free_flow;
use impact_records::signal::kalman::{Innovation, update};

/// Deviation of the state before the first impact, in units of `x_st` and `x_st` Ω: nothing is known.
const UNKNOWN: f64 = 30.0;
/// Deviations of an impact's time up to which its flights are followed: beyond, where parameters are far from those of the
/// rig, their slopes there are taken.
const USUALLY_LATE: f64 = 3.0;
/// Rounds in which the time of an impact is found from the gap that it fills.
const ROUNDS: usize = 3;

/// A machine with the drive that it sees at an instant.
pub(super) type Driven<'a> = (&'a Machine, Drive);

/// Mean and covariance of (X, X', Y, Y') and of what all times of the record are late by, dimensionless.
#[derive(Debug, Clone, Copy)]
pub(super) struct Belief {
    mean: Vector5<f64>,
    covariance: Matrix5<f64>,
}

impl Belief {
    /// A state of which nothing is known, of `masses`, and times that are all late by one error of a deviation.
    pub(super) fn unknown(masses: usize, late: f64) -> Self {
        let state = |mass: usize| {
            if mass < masses {
                UNKNOWN * UNKNOWN
            } else {
                0.0
            }
        };
        let variances = Vector5::new(state(0), state(0), state(1), state(1), late * late);
        Self {
            mean: Vector5::zeros(),
            covariance: Matrix5::from_diagonal(&variances),
        }
    }

    /// Take a measurement of h·(X, X', Y, Y') with a variance in; gives its innovation.
    pub(super) fn learn(&mut self, h: Vector4<f64>, value: f64, variance: f64) -> Innovation {
        let h = h.push(0.0);
        update(&mut self.mean, &mut self.covariance, h, value, variance)
    }

    /// Newton's law at an impact that fills the gap, with an R that scatters by a deviation and a time whose own error
    /// has a deviation; gives the innovation of the gap.
    pub(super) fn touch_and_bounce(
        &mut self,
        driven: Driven<'_>,
        gap: f64,
        time_error: f64,
        scatter: f64,
    ) -> Innovation {
        let mut touching = Touching::new(self, time_error);
        let innovation = touching.fill(driven, gap);
        *self = touching.bounce(driven, scatter);
        innovation
    }

    /// Fly on for a time.
    pub(super) fn fly(&mut self, driven: Driven<'_>, time: f64) {
        let end = flown(driven, &self.mean, time);
        self.mean = Vector5::new(end.x, end.vx, end.y, end.vy, self.mean[4]);
        let mut flow = free_flow(driven.0, time).fixed_resize::<5, 5>(0.0);
        flow[(4, 4)] = 1.0;
        self.covariance = flow * self.covariance * flow.transpose();
    }
}

/// The same at the measured time of an impact, with the impact's own part of e.
struct Touching {
    mean: Vector6<f64>,
    covariance: Matrix6<f64>,
    /// The greatest e through which the flights are followed.
    usual: f64,
}

impl Touching {
    fn new(belief: &Belief, time_error: f64) -> Self {
        let mut covariance = belief.covariance.fixed_resize::<6, 6>(0.0);
        covariance[(5, 5)] = time_error * time_error;
        Self {
            mean: belief.mean.push(0.0),
            covariance,
            usual: USUALLY_LATE * (covariance[(4, 4)] + covariance[(5, 5)]).sqrt(),
        }
    }

    /// The e through which the flights are followed, and what a mean has of it beyond.
    fn late(&self, mean: &Vector6<f64>) -> [f64; 2] {
        let whole = mean[4] + mean[5];
        let late = whole.clamp(-self.usual, self.usual);
        [late, whole - late]
    }

    /// Take in that the gap was filled e before the measured time; gives the innovation.
    fn fill(&mut self, driven: Driven<'_>, gap: f64) -> Innovation {
        let round = |about: &Vector6<f64>| {
            let [late, beyond] = self.late(about);
            let at = flown(driven, about, -late);
            let closing = at.vx + at.vy;
            let h = Vector6::new(1.0, -late, 1.0, -late, -closing, -closing);
            let filled = gap - (at.x + at.y - closing * beyond) + h.dot(about);
            let (mut mean, mut covariance) = (self.mean, self.covariance);
            let innovation = update(&mut mean, &mut covariance, h, filled, 0.0);
            (mean, covariance, innovation)
        };
        let first = round(&self.mean);
        let last = (1..ROUNDS).fold(first, |found, _| round(&found.0));
        (self.mean, self.covariance) = (last.0, last.1);
        first.2
    }

    /// Newton's law e before the measured time, and the flight after it until then.
    fn bounce(&self, driven: Driven<'_>, scatter: f64) -> Belief {
        let (machine, drive) = driven;
        let [late, beyond] = self.late(&self.mean);
        let before = flown(driven, &self.mean, -late);
        let closing = before.vx + before.vy;
        let r = machine.restitution().at(closing.max(0.0));
        let (mx, my) = machine.mobility();
        let [lost_x, lost_y] = [mx, my].map(|mobility| mobility * (1.0 + r));
        let mut jump = Matrix4::identity();
        for (row, lost) in [(1, lost_x), (3, lost_y)] {
            jump[(row, 1)] -= lost;
            jump[(row, 3)] -= lost;
        }
        let parting = State {
            vx: before.vx - lost_x * closing,
            vy: before.vy - lost_y * closing,
            ..before
        };
        let at_impact = Drive {
            phase: drive.phase - drive.eta * late,
            ..drive
        };
        let after = free_flight(machine, at_impact, &parting).at(late);
        let changed = Vector4::new(-lost_x, 0.0, -lost_y, 0.0) * closing;
        let accelerations = |s: &State| Vector4::new(0.0, s.ax, 0.0, s.ay);
        let by_late = changed + accelerations(&after) - jump * accelerations(&before);
        let mut through = jump.fixed_resize::<5, 6>(0.0);
        for column in [4, 5] {
            through
                .fixed_view_mut::<4, 1>(0, column)
                .copy_from(&by_late);
        }
        through[(4, 4)] = 1.0;
        let mean = Vector4::new(after.x, after.vx, after.y, after.vy) + by_late * beyond;
        let thrown = Vector5::new(0.0, changed[0], 0.0, changed[2], 0.0) * (scatter / (1.0 + r));
        Belief {
            mean: mean.push(self.mean[4]),
            covariance: through * self.covariance * through.transpose()
                + thrown * thrown.transpose(),
        }
    }
}

/// Flight from (X, X', Y, Y', …) for a time.
fn flown<const N: usize>(
    (machine, drive): Driven<'_>,
    values: &SVector<f64, N>,
    time: f64,
) -> State {
    let start = State {
        x: values[0],
        vx: values[1],
        y: values[2],
        vy: values[3],
        ..State::default()
    };
    free_flight(machine, drive, &start).at(time)
}
