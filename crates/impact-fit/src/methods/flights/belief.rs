//! What is known of the state along a record, by a Kalman filter from impact to impact.
//!
//! An impact's time is measured late by an error e, a part of its own and one that is common to the record. The flight
//! before the impact, continued until the measured time, is beyond the gap by what it closes in e, and the flight after it began e
//! before: its displacements differ by the jump of the velocities times e, its velocities by the jump of the accelerations and by
//! what the closing speed at the impact lacks of that e later. Both flights are followed through the e that is most likely, as
//! the curvature of the gap over e would take R down, and are linear about it (iterated extended Kalman filter; Bell and Cathey
//! 1993).
//!
//! The constant part of a measured velocity is known from the condition that the mass returns. Times that are late count some of the
//! flights before the impacts twice, so that all speeds of the record are off alike.

use nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector4, Vector6};

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

/// Places in the mean: what all times of the record are late by; the constant of its velocities, over its deviation; and what the
/// time of one impact is late by beside.
const LATE: usize = 4;
const CONSTANT: usize = 5;
const OWN_LATE: usize = 6;

/// A measured speed: what it shows of (X, X', Y, Y'), of what the times are late by, and of the velocities' constant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shown {
    pub state: Vector4<f64>,
    pub late: f64,
    pub constant: f64,
}

/// Mean and covariance of (X, X', Y, Y'), of what all times of the record are late by, dimensionless, and of the constant of its
/// velocities, over its deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Belief {
    mean: Vector6<f64>,
    covariance: Matrix6<f64>,
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
        let variances = Vector6::new(state(0), state(0), state(1), state(1), late * late, 1.0);
        Self {
            mean: Vector6::zeros(),
            covariance: Matrix6::from_diagonal(&variances),
        }
    }

    /// Take a measured speed with a variance in; gives its innovation.
    pub(super) fn learn(&mut self, shown: &Shown, value: f64, variance: f64) -> Innovation {
        let h = shown.state.push(shown.late).push(shown.constant);
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
        let state = Vector4::new(end.x, end.vx, end.y, end.vy);
        self.mean = state.push(self.mean[LATE]).push(self.mean[CONSTANT]);
        let mut flow = free_flow(driven.0, time).fixed_resize::<6, 6>(0.0);
        (flow[(LATE, LATE)], flow[(CONSTANT, CONSTANT)]) = (1.0, 1.0);
        self.covariance = flow * self.covariance * flow.transpose();
    }
}

/// Places of a flight at which it is looked whether the masses are still apart.
const LOOKED_AT: u32 = 32;
/// Standard errors by which they must be beyond each other.
const BEYOND: f64 = 5.0;

impl Belief {
    /// Whether the masses would pass through each other within a time: an impact there was not seen.
    pub(super) fn passes_through(&self, driven: Driven<'_>, gap: f64, time: f64) -> bool {
        let beyond = |k: u32| {
            let mut later = *self;
            later.fly(driven, time * f64::from(k) / f64::from(LOOKED_AT));
            let h = Vector6::new(1.0, 0.0, 1.0, 0.0, 0.0, 0.0);
            let variance = (h.transpose() * later.covariance * h)[0].max(0.0);
            h.dot(&later.mean) - gap > BEYOND * variance.sqrt() + 1e-3 * gap.abs()
        };
        (1..LOOKED_AT).any(beyond)
    }
}

/// The same at the measured time of an impact, with the impact's own part of e.
struct Touching {
    mean: SVector<f64, 7>,
    covariance: SMatrix<f64, 7, 7>,
    /// The greatest e through which the flights are followed.
    usual: f64,
}

impl Touching {
    fn new(belief: &Belief, time_error: f64) -> Self {
        let mut covariance = belief.covariance.fixed_resize::<7, 7>(0.0);
        covariance[(OWN_LATE, OWN_LATE)] = time_error * time_error;
        Self {
            mean: belief.mean.push(0.0),
            covariance,
            usual: USUALLY_LATE
                * (covariance[(LATE, LATE)] + covariance[(OWN_LATE, OWN_LATE)]).sqrt(),
        }
    }

    /// The e through which the flights are followed, and what a mean has of it beyond.
    fn late(&self, mean: &SVector<f64, 7>) -> [f64; 2] {
        let whole = mean[LATE] + mean[OWN_LATE];
        let late = whole.clamp(-self.usual, self.usual);
        [late, whole - late]
    }

    /// Take in that the gap was filled e before the measured time; gives the innovation.
    fn fill(&mut self, driven: Driven<'_>, gap: f64) -> Innovation {
        let round = |about: &SVector<f64, 7>| {
            let [late, beyond] = self.late(about);
            let at = flown(driven, about, -late);
            let closing = at.vx + at.vy;
            let h = SVector::from([1.0, -late, 1.0, -late, -closing, 0.0, -closing]);
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
        let mut through = jump.fixed_resize::<6, 7>(0.0);
        for column in [LATE, OWN_LATE] {
            through
                .fixed_view_mut::<4, 1>(0, column)
                .copy_from(&by_late);
        }
        (through[(LATE, LATE)], through[(CONSTANT, CONSTANT)]) = (1.0, 1.0);
        let mean = Vector4::new(after.x, after.vx, after.y, after.vy) + by_late * beyond;
        let thrown =
            Vector6::new(0.0, changed[0], 0.0, changed[2], 0.0, 0.0) * (scatter / (1.0 + r));
        Belief {
            mean: mean.push(self.mean[LATE]).push(self.mean[CONSTANT]),
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
