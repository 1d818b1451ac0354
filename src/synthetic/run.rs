//! Running a plan: the exact motion, sampled through the rig's electronics.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::motion::Motion;
use crate::record::{self, Channel, Record, Role};
use crate::synthetic::acquisition::{self, HighPass};
use crate::synthetic::plan::{Plan, Step};
use crate::synthetic::rig::{ROLES, sensitivities};
use crate::synthetic::truth::{Faults, Truth, draw_corners, draw_gains};
use impact_oscillator::model::contact::ModelImpact;
use impact_oscillator::model::params::{Initial, ModelError, Setting};
use impact_oscillator::model::simulate::{Simulator, Trajectory};

/// Samples per second, Hz.
pub const RATE_HZ: f64 = 2000.0;
/// Samples of a record.
pub const SAMPLES: usize = 2000;
/// The motion is sampled this much finer where a high-pass has to be run.
const FINE: usize = 4;
/// Drive periods between a change of setting and the record.
const SETTLE_PERIODS: f64 = 150.0;
/// Time before a record for the high-pass to settle, s.
const PRE_ROLL_S: f64 = 3.0;

/// One channel of a raw record, in V as the converter gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct RawChannel {
    /// Name in the file.
    pub name: &'static str,
    /// Samples, V.
    pub volts: Vec<f64>,
}

/// A raw record with what is true of it.
#[derive(Debug, Clone)]
pub struct RawRecord {
    /// Name, unique in the campaign.
    pub id: String,
    /// The setting.
    pub step: Step,
    /// The channels, V.
    pub channels: Vec<RawChannel>,
    /// The motion according to the noiseless simulation.
    pub motion: Motion,
    /// True impacts within the record: time since its first sample, s, and closing speed, m/s.
    pub impacts: Vec<(f64, f64)>,
}

/// What a virtual laboratory is made of and what it visits.
#[derive(Debug, Clone, Copy)]
pub struct Laboratory<'a> {
    /// True parameters.
    pub truth: &'a Truth,
    /// Faults of the rig.
    pub faults: &'a Faults,
    /// The settings that are visited.
    pub plan: &'a Plan,
    /// Seed of everything random.
    pub seed: u64,
}

/// All records of a plan, in order. Sweeps run in parallel; the result does not depend on it.
///
/// # Errors
/// [`ModelError`] where the truth or the plan lies outside the model's range.
pub fn records(
    truth: &Truth,
    faults: &Faults,
    plan: &Plan,
    seed: u64,
) -> Result<Vec<RawRecord>, ModelError> {
    let laboratory = Laboratory {
        truth,
        faults,
        plan,
        seed,
    };
    let whole = |_: usize, block: Vec<RawRecord>| Ok::<_, ModelError>(block);
    let parts = blocks(&laboratory, usize::MAX, &|raw| raw, &whole)?;
    Ok(parts.into_iter().flatten().collect())
}

/// All records of a plan in blocks of at most `most` records of one sweep, for campaigns that
/// memory does not hold: `keep` turns each record into what is wanted of it, `write` gets a block
/// with the number of its first record. Gives what `write` gave, in order; sweeps run in
/// parallel, so `write` does too.
///
/// # Errors
/// [`ModelError`] where the truth or the plan lies outside the model's range; what `write` says.
pub fn blocks<K: Send, W: Send, E: From<ModelError> + Send>(
    laboratory: &Laboratory<'_>,
    most: usize,
    keep: &(dyn Fn(RawRecord) -> K + Sync),
    write: &(dyn Fn(usize, Vec<K>) -> Result<W, E> + Sync),
) -> Result<Vec<W>, E> {
    let Laboratory {
        truth,
        faults,
        plan,
        seed,
    } = *laboratory;
    let rig = VirtualRig {
        truth,
        faults,
        gains: draw_gains(faults, sensitivities(truth).len(), seed),
        corners: draw_corners(faults, seed),
        seed,
    };
    let parts: Result<Vec<Vec<W>>, E> = sweeps(plan)
        .par_iter()
        .map(|(first, steps)| {
            let mut simulator = rig.at_rest(steps)?;
            let mut first = *first;
            let mut written = Vec::new();
            for steps in steps.chunks(most.max(1)) {
                let block = steps.iter().enumerate();
                let block =
                    block.map(|(i, step)| keep(rig.record(&mut simulator, first + i, step)));
                written.push(write(first, block.collect())?);
                first += steps.len();
            }
            Ok(written)
        })
        .collect();
    Ok(parts?.into_iter().flatten().collect())
}

/// The sweeps of a plan, each with the number of its first record: a sweep begins where the
/// motion starts from rest.
fn sweeps(plan: &Plan) -> Vec<(usize, Vec<Step>)> {
    let mut sweeps: Vec<(usize, Vec<Step>)> = Vec::new();
    for (i, step) in plan.steps.iter().enumerate() {
        match sweeps.last_mut() {
            Some(sweep) if !step.from_rest => sweep.1.push(*step),
            _ => sweeps.push((i, vec![*step])),
        }
    }
    sweeps
}

struct VirtualRig<'a> {
    truth: &'a Truth,
    faults: &'a Faults,
    gains: Vec<f64>,
    /// Of the three integrators, over the stated corner.
    corners: [f64; 3],
    seed: u64,
}

impl VirtualRig<'_> {
    fn setting(&self, step: &Step) -> Setting {
        Setting::new(
            step.frequency_hz / self.truth.natural_frequency_hz,
            step.clearance_m / self.truth.static_deflection_m,
        )
    }

    /// A simulator at the first step of a sweep.
    fn at_rest(&self, steps: &[Step]) -> Result<Simulator, ModelError> {
        Simulator::new(
            &self.truth.machine(),
            self.setting(&steps[0]),
            Initial::rest(),
        )
    }

    /// Settle at a step, then record.
    fn record(&self, simulator: &mut Simulator, index: usize, step: &Step) -> RawRecord {
        let setting = self.setting(step);
        let omega = self.truth.natural_rate();
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed.wrapping_add(1));
        rng.set_stream(index as u64);
        simulator.set(setting.frequency_ratio, setting.clearance);
        // A random fraction of a period, so that records start at any phase of the drive.
        let settle = (SETTLE_PERIODS + rng.random_range(0.0..1.0)) * setting.period();
        simulator.advance(settle, &mut |_: &ModelImpact| {});
        let start_tau = simulator.tau();
        let mut trajectory = Trajectory::default();
        let duration = PRE_ROLL_S + SAMPLES as f64 / RATE_HZ;
        simulator.advance(duration * omega, &mut trajectory);
        let first_tau = start_tau + PRE_ROLL_S * omega;
        let motion = true_motion(simulator.clone(), setting);
        let impacts: Vec<(f64, f64, f64)> = trajectory
            .impacts
            .iter()
            .map(|i| {
                (
                    (i.tau - first_tau) / omega,
                    i.closing_before * self.speed(),
                    i.dead_zone / omega,
                )
            })
            .collect();
        let phase = simulator.phase() - setting.frequency_ratio * (simulator.tau() - first_tau);
        let channels = self.channels(&trajectory, start_tau, &impacts, (phase, step), &mut rng);
        RawRecord {
            id: format!("r{index:04}"),
            step: *step,
            channels,
            motion,
            impacts: impacts
                .iter()
                .filter(|i| (0.0..SAMPLES as f64 / RATE_HZ).contains(&i.0))
                .map(|i| (i.0, i.1))
                .collect(),
        }
    }

    fn speed(&self) -> f64 {
        self.truth.static_deflection_m * self.truth.natural_rate()
    }

    fn channels(
        &self,
        trajectory: &Trajectory,
        start_tau: f64,
        impacts: &[(f64, f64, f64)],
        (phase, step): (f64, &Step),
        rng: &mut ChaCha8Rng,
    ) -> Vec<RawChannel> {
        let times: Vec<f64> = (0..SAMPLES).map(|i| i as f64 / RATE_HZ).collect();
        let drive = times
            .iter()
            .map(|t| 2.0 * (std::f64::consts::TAU * step.frequency_hz * t + phase).cos())
            .collect();
        let events: Vec<(f64, f64)> = impacts.iter().map(|i| (i.0, i.2)).collect();
        let contact = acquisition::contact_volts(&times, &events, self.faults, rng);
        let [vx, vy, x, y] = self.motion_samples(trajectory, start_tau);
        let frame = x.iter().map(|x| 2e-3 * x).collect();
        let signals: [Vec<f64>; 7] = [drive, contact, vx, vy, x, y, frame];
        sensitivities(self.truth)
            .iter()
            .zip(signals)
            .zip(&self.gains)
            .map(|((sensitivity, values), gain)| {
                let factor = match sensitivity.name {
                    "generator" | "contact" => 1.0,
                    _ => gain / sensitivity.si_per_volt,
                };
                let mut volts: Vec<f64> = values.iter().map(|v| v * factor).collect();
                acquisition::convert(&mut volts, self.faults, rng);
                RawChannel {
                    name: sensitivity.name,
                    volts,
                }
            })
            .collect()
    }

    /// Velocities and displacements of both masses, SI, each through its filter: the laser's
    /// velocity of x has none, the integrators' signals have a high-pass.
    fn motion_samples(&self, trajectory: &Trajectory, start_tau: f64) -> [Vec<f64>; 4] {
        let omega = self.truth.natural_rate();
        let (x_st, speed) = (self.truth.static_deflection_m, self.speed());
        let pre = (PRE_ROLL_S * RATE_HZ) as usize * FINE;
        let step_s = 1.0 / (RATE_HZ * FINE as f64);
        let count = pre + (SAMPLES - 1) * FINE + 1;
        let taus = (0..count).map(|i| start_tau + i as f64 * step_s * omega);
        let mut filters = self.corners.map(|corner| {
            let stated_hz = self.faults.high_pass_hz;
            stated_hz.map(|c| HighPass::new(corner * c, step_s))
        });
        let mut out = [(); 4].map(|()| Vec::with_capacity(SAMPLES));
        let mut before: Option<[f64; 4]> = None;
        for (i, state) in trajectory.sample(taus).into_iter().enumerate() {
            let raw = [
                state.vx * speed,
                state.vy * speed,
                state.x * x_st,
                state.y * x_st,
            ];
            let last = before.replace(raw).unwrap_or(raw);
            // The mean velocity is the displacement's difference, jumps included.
            let means = [
                (raw[3] - last[3]) / step_s,
                0.5 * (raw[2] + last[2]),
                0.5 * (raw[3] + last[3]),
            ];
            let mut seen = raw;
            for ((value, mean), filter) in seen[1..].iter_mut().zip(means).zip(&mut filters) {
                if let Some(filter) = filter {
                    *value = filter.next(*value, mean);
                }
            }
            if i >= pre && (i - pre).is_multiple_of(FINE) {
                for (channel, value) in out.iter_mut().zip(seen) {
                    channel.push(value);
                }
            }
        }
        out
    }
}

/// Largest period looked for in the noiseless motion, drive periods.
const LONGEST: usize = 16;
/// Drive periods over which the noiseless motion must repeat itself.
const WATCHED: usize = 96;
/// Relative closure of a periodic noiseless motion.
const CLOSED: f64 = 1e-3;

/// The motion after a record according to the noiseless simulation itself: states strobed once a
/// drive period must repeat after n periods within a thousandth of the motion's size.
fn true_motion(mut simulator: Simulator, setting: Setting) -> Motion {
    let mut states = Vec::with_capacity(WATCHED);
    let mut counts = Vec::with_capacity(WATCHED);
    let mut dead_zones = 0;
    for _ in 0..WATCHED {
        let mut count = 0;
        simulator.advance(setting.period(), &mut |impact: &ModelImpact| {
            count += 1;
            dead_zones += usize::from(impact.dead_zone > 0.0);
        });
        let s = simulator.state();
        states.push([s.x, s.vx, s.y, s.vy]);
        counts.push(count);
    }
    let size = states
        .iter()
        .flatten()
        .fold(0.0f64, |m, v| m.max(v.abs()))
        .max(1e-9);
    let closes = |n: usize| {
        (n..WATCHED).all(|i| {
            states[i]
                .iter()
                .zip(states[i - n])
                .all(|(a, b)| (a - b).abs() < CLOSED * size)
                && counts[i] == counts[i - n]
        })
    };
    let impacts: usize = counts.iter().sum();
    match (1..=LONGEST).find(|n| closes(*n)) {
        Some(1) if impacts == 0 => Motion::Impactless,
        Some(n) => Motion::Periodic {
            impacts_p: counts[..n].iter().sum::<usize>() as u32,
            periods_n: n as u32,
            dead_zone: 2 * dead_zones >= impacts.max(1),
        },
        None => Motion::Undetermined {
            reason: "the noiseless simulation is not periodic".into(),
        },
    }
}

/// A raw record calibrated with the nominal sensitivities, as ingest would do it.
pub fn calibrated(raw: &RawRecord, truth: &Truth, faults: &Faults) -> Record {
    let channels = raw
        .channels
        .iter()
        .zip(sensitivities(truth))
        .zip(ROLES)
        .map(
            |((channel, sensitivity), (role, dimension, filtered))| Channel {
                role,
                name: channel.name.into(),
                dimension,
                values: channel
                    .volts
                    .iter()
                    .map(|v| v * sensitivity.si_per_volt)
                    .collect(),
                high_pass_hz: faults.high_pass_hz.filter(|_| filtered),
                threshold: (role == Role::Contact).then_some(2.5),
            },
        )
        .collect();
    Record {
        id: raw.id.clone(),
        sample_rate_hz: RATE_HZ,
        channels,
        setting: record::Setting {
            stated_frequency_hz: Some(raw.step.frequency_hz),
            clearance_m: Some(raw.step.clearance_m),
            sweep: raw.step.sweep,
            drive_amplitude: 1.0,
            sequence: 0,
            specimen: None,
            excitation: Default::default(),
        },
        flags: Vec::new(),
    }
}
