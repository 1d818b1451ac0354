//! Records without a closed-form orbit (transient, chaotic, several impacts a period): multiple
//! shooting from impact to impact.
//!
//! The nodes are the states at the impacts, as measured there: each mass's speed before and after,
//! and the gap closed. Between them the flight is exact and linear, and so is Newton's law; the
//! nodes are therefore eliminated by a Kalman filter along the record, and its innovations over
//! their deviations are the residuals. An impact's time is known as well as it was measured, and as the times of
//! a record are found together they may all be off alike as far as each by itself. The impacts of a periodic motion repeat each
//! other, and so do the errors of their times: what these make of the velocities' constant is that of one motion.

use nalgebra::Vector4;

use crate::methods::flights::belief::{Belief, Driven, Shown};
use crate::methods::flights::constants::Constants;
use crate::methods::flights::node::Node;
use crate::methods::flights::repeated::{Repeats, as_one_motion};
use crate::methods::impacts::block::corners_in;
use crate::parameters::own::Circumstances;
use crate::parameters::{CHANNELS, Coordinate, Parameters, gain_index};
use crate::solver::Block;
use crate::solver::group::Group;
use impact_oscillator::model::flight::Drive;
use impact_records::event::{Impact, RigKind, extrapolation_error};
use impact_records::motion::{Motion, Observation};
use impact_records::record::Role;
use impact_records::signal::kalman::Innovation;
use impact_records::signal::robust;

/// The impacts of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightRecord {
    /// Index among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Place of the clearance among those that carry an error of their own.
    pub gap: Option<usize>,
    /// The groups of records that it belongs to.
    pub group: Group,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// The channels that the speeds of x and y come from.
    pub speeds_from: [Option<Role>; 2],
    /// Its impacts, in their order, none missing between them.
    pub nodes: Vec<Node>,
    /// Standard error that their times have in common, s.
    pub late_s: f64,
    /// What the constant of each mass's velocity is off by these times.
    pub constants: Constants,
}

/// All records that are shot from impact to impact.
#[derive(Debug, Clone)]
pub struct FlightBlock {
    /// One or two masses.
    pub rig: RigKind,
    /// The records.
    pub records: Vec<FlightRecord>,
    /// On which corners the speeds depend, by their index.
    corners: [bool; CHANNELS],
    /// Standard deviation of R from impact to impact.
    scatter: f64,
}

/// Fewest impacts of a record: fewer tell nothing but where they began.
const FEWEST_IMPACTS: usize = 4;
/// Relative error of a speed beside the noise: what its extrapolation to the impact leaves open.
const SPEED_SCATTER: f64 = 1e-3;

impl FlightBlock {
    /// Collect the records with impacts that have no closed-form orbit.
    pub fn new(rig: RigKind, observations: &[Observation]) -> Self {
        let records = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| !o.low_pass)
            .filter(|(_, o)| !o.excluded() && has_no_closed_form(&o.classification.motion))
            .filter_map(|(i, o)| flight_record(rig, i, o))
            .collect();
        Self::of_records(rig, records)
    }

    /// Of given records.
    fn of_records(rig: RigKind, records: Vec<FlightRecord>) -> Self {
        let nodes = records.iter().flat_map(|r| &r.nodes);
        let corners = corners_in(nodes.flat_map(|n| &n.corner_shifts));
        Self {
            rig,
            records,
            corners,
            scatter: 0.0,
        }
    }

    /// Allow R a standard deviation from impact to impact.
    pub fn allow(&mut self, scatter: f64) {
        self.scatter = scatter;
    }

    /// The standard deviation that R is allowed from impact to impact.
    pub fn scatter(&self) -> f64 {
        self.scatter
    }

    /// Minus twice the logarithm of the likelihood at parameters with a scatter of R, but for a constant, large
    /// innovations bounded.
    pub fn deviance(&self, at: &Parameters, scatter: f64) -> f64 {
        let records = self.records.iter();
        let innovations = records.flat_map(|record| self.innovations(record, at, scatter));
        let terms =
            innovations.map(|i| bounded(i.relative).powi(2) / NORMAL_BOUNDED + i.spread.ln());
        terms.filter(|term| term.is_finite()).sum()
    }

    /// The innovations of one record, in their order, with a scatter of R.
    fn innovations(
        &self,
        record: &FlightRecord,
        parameters: &Parameters,
        scatter: f64,
    ) -> Vec<Innovation> {
        self.followed(record, parameters, scatter, |_, _, _, _| {})
    }

    /// Whether the masses of a record would pass through each other between its impacts: one was not seen.
    pub fn lacks_an_impact(&self, record: &FlightRecord, parameters: &Parameters) -> bool {
        let mut passes = false;
        let look = |belief: &Belief, flight: Driven<'_>, gap: f64, time: f64| {
            passes |= belief.passes_through(flight, gap, time);
        };
        self.followed(record, parameters, self.scatter, look);
        passes
    }

    /// The innovations of one record; each flight is shown, with the gap and the time that it lasts.
    fn followed(
        &self,
        record: &FlightRecord,
        parameters: &Parameters,
        scatter: f64,
        mut flown: impl FnMut(&Belief, Driven<'_>, f64, f64),
    ) -> Vec<Innovation> {
        let machine = parameters.machine(self.rig);
        let (_, clearance_m) = parameters.own(&Circumstances {
            frequency_hz: record.frequency_hz,
            clearance_m: record.clearance_m,
            gap: record.gap,
            ..Circumstances::default()
        });
        let setting = parameters.setting(record.frequency_hz, clearance_m, record.drive_amplitude);
        let gap = machine.gap(setting.clearance);
        let rate = parameters.natural_rate();
        let speed = parameters.static_deflection_m * record.drive_amplitude * rate;
        let measured = record.measured(parameters, speed, rate);
        let masses = if machine.y.is_some() { 2 } else { 1 };
        let mut belief = Belief::unknown(masses, record.late_s * rate);
        let mut out = Vec::with_capacity(record.nodes.len() * (1 + 2 * measured.len()));
        for (k, node) in record.nodes.iter().enumerate() {
            let [before, after] = node.speeds_m_s(parameters, record.sum_alone());
            let time_error = node.time_error_s * rate;
            let measure = |belief: &mut Belief, speeds: [f64; 2], out: &mut Vec<Innovation>| {
                for (row, speed_m_s) in measured.iter().zip(speeds) {
                    out.push(belief.learn(row, speed_m_s, node.error_m_s.powi(2)));
                }
            };
            measure(&mut belief, before, &mut out);
            let drive = Drive {
                eta: setting.frequency_ratio,
                phase: node.drive_phase_rad,
            };
            let flight = (&machine, drive);
            out.push(belief.touch_and_bounce(flight, gap, time_error, scatter));
            measure(&mut belief, after, &mut out);
            if let Some(next) = record.nodes.get(k + 1) {
                let time = (next.time_s - node.time_s) * rate;
                flown(&belief, flight, gap, time);
                belief.fly(flight, time);
            }
        }
        out
    }

    /// Whether the speeds depend on a corner, by its index.
    pub fn has_corner(&self, index: usize) -> bool {
        self.corners[index]
    }

    /// Whether speeds come from a channel, by its index.
    pub fn has_gain(&self, index: usize) -> bool {
        let mut roles = self.records.iter().flat_map(|r| &r.speeds_from).flatten();
        roles.any(|role| gain_index(*role) == Some(index))
    }
}

impl FlightRecord {
    /// What is measured at an impact, in m/s: each mass's speed, or their sum where accelerations tell no more; gains
    /// included. The unit of times is the inverse of a rate.
    fn measured(&self, parameters: &Parameters, speed_m_s: f64, rate: f64) -> Vec<Shown> {
        let of = |m: usize| {
            let gain = parameters.gain(self.speeds_from[m]?);
            let mut state = Vector4::zeros();
            state[2 * m + 1] = gain * speed_m_s;
            Some(Shown {
                state,
                late: self.constants.by_late_m_s2[m] / rate,
                constant: self.constants.deviation_m_s[m],
            })
        };
        let rows: Vec<Shown> = (0..2).filter_map(of).collect();
        if self.sum_alone() {
            let sum = |a: Shown, b: &Shown| Shown {
                state: a.state + b.state,
                ..a
            };
            let first = rows[0];
            vec![rows[1..].iter().fold(first, sum)]
        } else {
            rows
        }
    }

    /// Whether only the sum of two masses' speeds is known: the flights of each have constants of their own.
    fn sum_alone(&self) -> bool {
        self.speeds_from.iter().all(Option::is_some) && self.has_acceleration()
    }

    /// Whether a speed was integrated from an acceleration, which shows the time of an impact to a sample.
    fn has_acceleration(&self) -> bool {
        let accelerations = [Role::AccelerationX, Role::AccelerationY];
        let mut roles = self.speeds_from.iter().flatten();
        roles.any(|role| accelerations.contains(role))
    }
}

/// Whether speeds are those of a measured velocity, whose constant is not known but from the motion.
fn is_velocity(from: Option<Role>) -> bool {
    matches!(from, Some(Role::VelocityX | Role::VelocityY))
}

fn has_no_closed_form(motion: &Motion) -> bool {
    match motion {
        Motion::Periodic {
            impacts_p,
            dead_zone,
            ..
        } => *impacts_p > 1 && !dead_zone,
        Motion::Chaotic | Motion::Undetermined { .. } => true,
        _ => false,
    }
}

fn flight_record(rig: RigKind, index: usize, o: &Observation) -> Option<FlightRecord> {
    let drive = o.drive?;
    let sound = o.impacts.iter().all(|i| i.dead_zone_s == 0.0);
    if !sound
        || o.speeds_lack_spikes()
        || o.unsupported_pulses > 0
        || o.impacts.len() < FEWEST_IMPACTS
    {
        return None;
    }
    let mut record = FlightRecord {
        observation: index,
        frequency_hz: drive.frequency_hz,
        clearance_m: o.setting.clearance_m?,
        gap: None,
        group: Group::default(),
        drive_amplitude: o.setting.drive_amplitude,
        speeds_from: [
            o.speed_from(false),
            o.speed_from(true).filter(|_| rig == RigKind::Double),
        ],
        nodes: Vec::new(),
        late_s: 0.0,
        constants: Constants::default(),
    };
    // The first and the last impact may be known by their times alone.
    let known = |i: &Impact| i.approach_speed_before_m_s.is_some();
    let first = o.impacts.iter().position(known)?;
    let last = o.impacts.iter().rposition(known)?;
    let impacts = o.impacts[first..=last].iter();
    let together = rig == RigKind::Single || record.sum_alone();
    let per_period = o.sample_rate_hz / drive.frequency_hz;
    let missed = extrapolation_error(per_period, o.jump_samples).hypot(SPEED_SCATTER);
    let integrated = record.has_acceleration();
    record.nodes = impacts
        .map(|i| node(together, i, (missed, integrated)))
        .collect::<Option<_>>()?;
    let times = record.nodes.iter().map(|node| node.time_error_s);
    record.late_s = robust::mean(&times.collect::<Vec<_>>());
    let measured = record.speeds_from.map(is_velocity);
    record.constants = Constants::of_record(&record.nodes, measured);
    if let Motion::Periodic {
        impacts_p,
        periods_n,
        ..
    } = o.classification.motion
    {
        let repeats = Repeats {
            impacts: impacts_p as usize,
            periods: periods_n,
            frequency_hz: drive.frequency_hz,
        };
        let one = as_one_motion(&record.nodes, repeats);
        if let Some(one) = one {
            record.constants = Constants::of_motion(&one, repeats.after_s(), measured);
        }
    }
    (record.nodes.len() >= FEWEST_IMPACTS).then_some(record)
}

/// `together`: the approach speed is all that is known, or that there is; `missed`: relative error of a speed beside
/// its noise; `integrated`: whether the error of the impact's time counts in it.
fn node(together: bool, impact: &Impact, (missed, integrated): (f64, bool)) -> Option<Node> {
    let (before_m_s, after_m_s, masses) = if together {
        (
            [impact.approach_speed_before_m_s?, 0.0],
            [impact.approach_speed_after_m_s?, 0.0],
            1.0,
        )
    } else {
        let (x, y) = (impact.x?, impact.y?);
        (
            [x.before_m_s, y.before_m_s],
            [x.after_m_s, y.after_m_s],
            2.0f64,
        )
    };
    let closing = impact.approach_speed_before_m_s?;
    let noise = impact.speed_error_m_s()? / masses.sqrt();
    let by_time = impact.speeds_by_time_m_s.filter(|_| integrated);
    let late = by_time.map_or(0.0, |[before, after]| before.abs().max(after.abs()));
    (closing > 6.0 * noise).then_some(Node {
        time_s: impact.time_s,
        time_error_s: impact.time_error_s,
        drive_phase_rad: impact.drive_phase_rad?,
        before_m_s,
        after_m_s,
        error_m_s: noise.hypot(missed * closing).hypot(late),
        noise_m_s: noise,
        corner_shifts: impact.corner_shifts,
    })
}

/// Deviations from which an innovation counts less than its square.
const USUAL: f64 = 1.5;

/// What makes the most likely deviation by bounded residuals that of normal ones: the mean of r²/√(1 + (r/`USUAL`)²).
const NORMAL_BOUNDED: f64 = 0.699_75;

/// A residual whose square is the pseudo-Huber loss: as it is where small, its root where large.
fn bounded(residual: f64) -> f64 {
    let square = USUAL * USUAL;
    let loss = 2.0 * square * ((residual * residual / square).ln_1p() * 0.5).exp_m1();
    loss.sqrt().copysign(residual)
}

impl Block for FlightBlock {
    fn items(&self) -> usize {
        self.records.len()
    }

    fn owners(&self) -> Vec<usize> {
        self.records.iter().map(|item| item.observation).collect()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let innovations = self.innovations(&self.records[item], parameters, self.scatter);
        let innovations = innovations.into_iter();
        let out: Vec<f64> = innovations.map(|i| bounded(i.relative)).collect();
        out.iter().all(|r| r.is_finite()).then_some(out)
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::Corner(index) => self.has_corner(index),
            Coordinate::Gap(_) => self
                .records
                .iter()
                .any(|r| r.gap.map(Coordinate::Gap) == Some(coordinate)),
            Coordinate::Gain(index) => self.has_gain(index),
            Coordinate::Delay(_) | Coordinate::Effect(_) => false,
            _ => true,
        }
    }

    fn group(&self, item: usize) -> Option<Group> {
        Some(self.records[item].group)
    }

    fn item_touches(&self, item: usize, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::Gap(i) => self.records[item].gap == Some(i),
            _ => self.touches(coordinate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::fit::wide_priors;
    use crate::methods::weighing::most_likely_scatter;
    use crate::solver::Problem;
    use impact_oscillator::model::flight::{State, free_flight};
    use impact_oscillator::model::params::Initial;
    use impact_oscillator::model::simulate::simulate;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};
    use std::f64::consts::TAU;

    fn truth() -> Parameters {
        Parameters {
            drive_asymmetry: 0.03,
            ..Parameters::symmetric(0.75, 12.0, 0.05, 1e-3)
        }
    }

    /// Impacts of irregular motions, exact but for the stated errors.
    fn block(rig: RigKind) -> FlightBlock {
        let p = truth();
        let speed = p.static_deflection_m * p.natural_rate();
        let records = [(24.0, 0.2e-3), (20.0, 0.1e-3), (29.0, 0.15e-3)]
            .map(|(frequency_hz, clearance_m)| {
                let setting = p.setting(frequency_hz, clearance_m, 1.0);
                let machine = p.machine(rig);
                let motion = simulate(&machine, setting, Initial::rest(), 90.0).expect("a motion");
                let nodes = motion.impacts.iter().skip(3).take(14);
                let nodes = nodes.map(|i| Node {
                    time_s: i.tau / p.natural_rate(),
                    time_error_s: 1e-7,
                    drive_phase_rad: i.phase,
                    before_m_s: [i.vx_before * speed, i.vy_before * speed],
                    after_m_s: [i.vx_after * speed, i.vy_after * speed],
                    error_m_s: 1e-4,
                    noise_m_s: 1e-4,
                    corner_shifts: [None, None],
                });
                FlightRecord {
                    observation: 0,
                    frequency_hz,
                    clearance_m,
                    gap: None,
                    group: Group::default(),
                    drive_amplitude: 1.0,
                    speeds_from: [
                        Some(Role::VelocityX),
                        Some(Role::VelocityY).filter(|_| rig == RigKind::Double),
                    ],
                    nodes: nodes.collect(),
                    late_s: 1e-7,
                    constants: Constants::default(),
                }
            })
            .to_vec();
        FlightBlock::of_records(rig, records)
    }

    #[test]
    fn valid_exact_impacts_follow_from_each_other() {
        for rig in [RigKind::Double, RigKind::Single] {
            let block = block(rig);
            for item in 0..block.items() {
                assert!(block.records[item].nodes.len() >= 10);
                let residuals = block.residuals(item, &truth()).expect("residuals");
                // The first node's own measurements meet a state of which nothing is known.
                let first = if rig == RigKind::Double { 3 } else { 2 };
                let later = residuals[first..].iter();
                let worst = later.fold(0.0f64, |m, r| m.max(r.abs()));
                assert!(worst < 0.01, "{worst}");
            }
        }
    }

    #[test]
    fn valid_an_impact_that_was_not_seen_is_missed_by_its_flight() {
        for rig in [RigKind::Double, RigKind::Single] {
            let block = block(rig);
            for record in &block.records {
                assert!(!block.lacks_an_impact(record, &truth()));
                for missing in 3..record.nodes.len() - 1 {
                    let mut seen = record.clone();
                    seen.nodes.remove(missing);
                    assert!(block.lacks_an_impact(&seen, &truth()), "{missing}");
                }
            }
        }
    }

    #[test]
    fn prop_speeds_follow_the_gain_of_the_channel_that_they_come_from() {
        use Role::{AccelerationX, AccelerationY, DisplacementX, DisplacementY};
        for (roles, gains) in [
            ([DisplacementX, DisplacementY], [1.02, 0.97]),
            ([AccelerationX, AccelerationY], [1.03, 1.03]),
        ] {
            let mut block = block(RigKind::Double);
            let mut parameters = truth();
            for record in &mut block.records {
                record.speeds_from = roles.map(Some);
                let together = record.sum_alone();
                for node in &mut record.nodes {
                    for speeds in [&mut node.before_m_s, &mut node.after_m_s] {
                        *speeds = [speeds[0] * gains[0], speeds[1] * gains[1]];
                        if together {
                            *speeds = [speeds[0] + speeds[1], 0.0];
                        }
                    }
                }
            }
            for (role, gain) in roles.iter().zip(gains) {
                let index = gain_index(*role).expect("a gain");
                assert!(block.touches(Coordinate::Gain(index)));
                parameters.gains[index] = gain;
            }
            assert!(!block.touches(Coordinate::Gain(0)));
            for item in 0..block.items() {
                let residuals = block.residuals(item, &parameters).expect("residuals");
                let worst = residuals[3..].iter().fold(0.0f64, |m, r| m.max(r.abs()));
                assert!(worst < 1e-3, "{roles:?}: {worst}");
            }
        }
    }

    #[test]
    fn valid_irregular_motions_alone_tell_all_four_parameters() {
        let mut block = block(RigKind::Double);
        // of times known to a tenth of a microsecond the likelihood has more than one maximum between the starts and the truth
        for record in &mut block.records {
            record.late_s = 1e-5;
            for node in &mut record.nodes {
                node.time_error_s = 1e-5;
            }
        }
        let start = Parameters {
            restitution: 0.77,
            natural_frequency_hz: 12.03,
            damping_ratio: 0.052,
            static_deflection_m: 1.01e-3,
            ..truth()
        };
        let mut free = Coordinate::PHYSICAL.to_vec();
        free.push(Coordinate::DriveAsymmetry);
        let problem = Problem {
            blocks: vec![(&block, 1.0)],
            priors: wide_priors(&start, &free),
            free,
            ..Problem::default()
        };
        for restitution in [0.75, 0.77, 0.83] {
            let start = Parameters {
                restitution,
                ..start
            };
            let found = problem.fit(start).expect("a fit").parameters;
            for coordinate in Coordinate::PHYSICAL {
                let apart = found.coordinate(coordinate) - truth().coordinate(coordinate);
                assert!(apart.abs() < 1e-5, "{coordinate:?}: {apart}");
            }
        }
    }

    /// Impacts one after the other, until two follow at once, each with an R of its own drawn around that of the truth, and
    /// read too late by a time of a deviation.
    fn shot(scatter: f64, late_s: f64, seed: u64) -> FlightBlock {
        let p = truth();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let own = Normal::new(p.restitution, scatter).expect("a distribution");
        let delay = Normal::new(0.0, late_s * p.natural_rate()).expect("a distribution");
        let mut block = block(RigKind::Double);
        for record in &mut block.records {
            let setting = p.setting(record.frequency_hz, record.clearance_m, 1.0);
            let machine = p.machine(RigKind::Double);
            let gap = machine.gap(setting.clearance);
            let speed = p.static_deflection_m * p.natural_rate();
            let first = record.nodes[0];
            let (mut state, mut time, mut phase) = (State::default(), 0.0, first.drive_phase_rad);
            (state.x, state.y) = (gap / 2.0, gap / 2.0);
            [state.vx, state.vy] = first.after_m_s.map(|v| v / speed);
            record.nodes.clear();
            record.late_s = late_s;
            while record.nodes.len() < 40 {
                let drive = Drive {
                    eta: setting.frequency_ratio,
                    phase,
                };
                let flight = free_flight(&machine, drive, &state);
                let apart = |t: f64| flight.at(t).x + flight.at(t).y - gap;
                let (mut low, mut high) = (0.0, 0.02);
                while apart(high) < 0.0 {
                    (low, high) = (high, high + 0.02);
                }
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    *(if apart(middle) < 0.0 {
                        &mut low
                    } else {
                        &mut high
                    }) = middle;
                }
                let end = flight.at(high);
                (time, phase) = (time + high, phase + setting.frequency_ratio * high);
                let jump = 0.5 * (1.0 + own.sample(&mut rng)) * (end.vx + end.vy);
                (state.x, state.y) = (end.x, end.y);
                (state.vx, state.vy) = (end.vx - jump, end.vy - jump);
                if high < 0.3 {
                    break;
                }
                let late = delay.sample(&mut rng);
                let drive = Drive { phase, ..drive };
                let parted = free_flight(&machine, drive, &state).at(late);
                let approaching = flight.at(high + late);
                record.nodes.push(Node {
                    time_s: (time + late) / p.natural_rate(),
                    time_error_s: late_s,
                    drive_phase_rad: phase + setting.frequency_ratio * late,
                    before_m_s: [approaching.vx, approaching.vy].map(|v| v * speed),
                    after_m_s: [parted.vx, parted.vy].map(|v| v * speed),
                    ..first
                });
            }
        }
        block
            .records
            .retain(|record| record.nodes.len() >= FEWEST_IMPACTS);
        block
    }

    #[test]
    fn valid_scatter_of_restitution_is_found_and_enters_the_interval() {
        let mut squares = Vec::new();
        for seed in 0..12 {
            let mut selected = shot(0.02, 1e-7, seed);
            let start = truth();
            let free = Coordinate::PHYSICAL.to_vec();
            let found = most_likely_scatter(&selected, &start);
            selected.allow(found);
            assert!((found / 0.02 - 1.0).abs() < 0.25, "{found}");
            let problem = Problem {
                blocks: vec![(&selected, 1.0)],
                priors: wide_priors(&start, &free),
                free,
                ..Problem::default()
            };
            let found = problem.fit(start).expect("a fit");
            let apart = found.parameters.restitution - start.restitution;
            let error = found.covariance[(0, 0)].sqrt();
            squares.push((apart / error).powi(2));
        }
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((0.2..2.5).contains(&mean), "{mean} {squares:?}");
    }

    #[test]
    fn valid_speeds_that_are_read_too_late_are_those_of_the_flights_then() {
        // times off by three thousandths of a radian, speeds by a thousandth of x_st Ω
        let p = truth();
        let error_m_s = 1e-3 * p.static_deflection_m * p.natural_rate();
        let normal = Normal::new(0.0, error_m_s).expect("a distribution");
        let (mut squares, mut scores) = (Vec::new(), Vec::new());
        for seed in 0..24 {
            let mut rng = ChaCha8Rng::seed_from_u64(100 + seed);
            let mut block = shot(0.0, 0.006 / p.natural_rate(), seed);
            for node in block.records.iter_mut().flat_map(|r| &mut r.nodes) {
                node.error_m_s = error_m_s;
                for speeds in [&mut node.before_m_s, &mut node.after_m_s] {
                    *speeds = speeds.map(|v| v + normal.sample(&mut rng));
                }
            }
            let of_record = |r| block.innovations(r, &p, 0.0);
            squares.extend(
                block
                    .records
                    .iter()
                    .flat_map(of_record)
                    .map(|i| i.relative.powi(2)),
            );
            let problem = Problem {
                blocks: vec![(&block, 1.0)],
                priors: wide_priors(&p, &Coordinate::PHYSICAL),
                free: Coordinate::PHYSICAL.to_vec(),
                ..Problem::default()
            };
            let found = problem.fit(p).expect("a fit");
            let apart = found.parameters.restitution - p.restitution;
            scores.push(apart * apart / found.covariance[(0, 0)]);
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean(&squares) - 1.0).abs() < 0.1, "{}", mean(&squares));
        assert!((0.4..2.0).contains(&mean(&scores)), "{scores:?}");
    }

    #[test]
    fn valid_innovations_have_the_errors_that_times_and_speeds_make() {
        // noise of a tenth of the closing speeds, and times off by a fiftieth of a radian
        let p = truth();
        let [error_m_s, late_s] = [
            0.5 * p.static_deflection_m * p.natural_rate(),
            0.02 / p.natural_rate(),
        ];
        let normal = Normal::new(0.0, 1.0).expect("a distribution");
        for rig in [RigKind::Double, RigKind::Single] {
            let mut squares = Vec::new();
            for seed in 0..24 {
                let mut rng = ChaCha8Rng::seed_from_u64(seed);
                let mut block = block(rig);
                // closing speeds of the last one are not ten times the noise
                block.records.truncate(2);
                for record in &mut block.records {
                    record.late_s = late_s;
                    for node in &mut record.nodes {
                        let late = late_s * normal.sample(&mut rng);
                        node.time_s += late;
                        node.drive_phase_rad += TAU * record.frequency_hz * late;
                        (node.time_error_s, node.error_m_s) = (late_s, error_m_s);
                        for speeds in [&mut node.before_m_s, &mut node.after_m_s] {
                            *speeds = speeds.map(|v| v + error_m_s * normal.sample(&mut rng));
                        }
                    }
                }
                let records = block.records.iter();
                let innovations = records.flat_map(|r| block.innovations(r, &p, 0.0));
                squares.extend(innovations.map(|i| i.relative.powi(2)));
            }
            let count = squares.len() as f64;
            let mean = squares.iter().sum::<f64>() / count;
            // as many innovations as there are states tell nothing else
            let states = if rig == RigKind::Double { 4.0 } else { 2.0 };
            let expected = 1.0 - states * 2.0 * 24.0 / count;
            assert!((mean - expected).abs() < 0.05, "{rig:?}: {mean}");
        }
    }

    #[test]
    fn prop_a_bounded_residual_keeps_its_sign_and_never_grows() {
        for r in [-50.0, -3.0, -1e-9, 0.0, 1e-6, 0.7, 8.0] {
            let b = bounded(r);
            assert!(b.abs() <= r.abs() * (1.0 + 1e-12) && b * r >= 0.0);
            assert!(r.abs() > 0.1 || (b - r).abs() <= 1e-3 * r.abs());
        }
    }
}
