//! Running a plan: the motion, sampled through the rig's electronics.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::acquisition::{self, Disturbance, SensorHighPass};
use crate::engine::{Engine, Recorded};
use crate::equations::Phase4;
use crate::laboratory::Laboratory;
use crate::plan::{Plan, Step};
use crate::rig::{ROLES, sensitivities};
use crate::settled::true_motion;
use crate::truth::{Faults, TrueImpact, Truth, draw_corners, draw_gains};
use impact_oscillator::model::params::ModelError;
use impact_records::motion::Motion;
use impact_records::record::{self, Channel, Record, Role};
use impact_records::signal::whole;

pub use crate::acquisition::RATE_HZ;

/// Samples of a record.
pub const SAMPLES: usize = 2000;
/// The motion is sampled this much finer where a high-pass has to be run.
const FINE: usize = 4;
/// Drive periods between a change of setting and the record.
const SETTLE_PERIODS: f64 = 150.0;
/// Time before a record for the high-pass to settle, s.
const PRE_ROLL_S: f64 = 3.0;
/// The same in fine steps.
const PRE_ROLL_FINE: usize = whole::index(PRE_ROLL_S * RATE_HZ) * FINE;
/// A fine step, s.
const FINE_STEP_S: f64 = 1.0 / (RATE_HZ * FINE as f64);

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
    /// True impacts that begin within the record.
    pub impacts: Vec<TrueImpact>,
}

/// What a record is made from: the motion and where it was taken.
struct Take<'a> {
    step: &'a Step,
    index: usize,
    /// Phase of the drive at the first sample, rad.
    phase: f64,
    /// Dimensionless time at the start of the pre-roll.
    start_tau: f64,
    recorded: &'a Recorded,
    impacts: &'a [TrueImpact],
}

/// All records of a plan, in order. Sweeps run in parallel; the result does not depend on it.
///
/// # Errors
/// [`ModelError`] if the truth or the plan is outside the model's range.
pub fn records(laboratory: &Laboratory) -> Result<Vec<RawRecord>, ModelError> {
    let whole = |_: usize, block: Vec<RawRecord>| Ok::<_, ModelError>(block);
    let parts = blocks(laboratory, usize::MAX, &|raw| raw, &whole)?;
    Ok(parts.into_iter().flatten().collect())
}

/// All records of a plan in blocks of at most `most` records of one sweep, for campaigns that
/// memory does not hold: `keep` turns each record into what is wanted of it, `write` gets a block
/// with the number of its first record. Gives what `write` gave, in order; sweeps run in
/// parallel, so `write` does too.
///
/// # Errors
/// [`ModelError`] if the truth or the plan is outside the model's range; what `write` says.
pub fn blocks<K: Send, W: Send, E: From<ModelError> + Send>(
    laboratory: &Laboratory,
    most: usize,
    keep: &(dyn Fn(RawRecord) -> K + Sync),
    write: &(dyn Fn(usize, Vec<K>) -> Result<W, E> + Sync),
) -> Result<Vec<W>, E> {
    let Laboratory {
        truth,
        faults,
        rig_seed,
        ..
    } = laboratory;
    let rig = VirtualRig {
        laboratory,
        gains: draw_gains(faults, sensitivities(truth).len(), *rig_seed),
        corners: draw_corners(faults, *rig_seed),
    };
    let parts: Result<Vec<Vec<W>>, E> = sweeps(&laboratory.plan)
        .par_iter()
        .map(|(first, steps)| {
            let mut engine = laboratory.at_rest(*first, &steps[0])?;
            let mut first = *first;
            let mut written = Vec::new();
            for steps in steps.chunks(most.max(1)) {
                let block = steps.iter().enumerate();
                let block = block.map(|(i, step)| keep(rig.record(&mut engine, first + i, step)));
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
    laboratory: &'a Laboratory,
    gains: Vec<f64>,
    /// Of the three integrators, over the stated corner.
    corners: [f64; 3],
}

impl VirtualRig<'_> {
    /// Settle at a step, then record.
    fn record(&self, engine: &mut Engine, index: usize, step: &Step) -> RawRecord {
        let setting = self.laboratory.setting(step);
        let omega = self.laboratory.truth.natural_rate();
        let mut rng = ChaCha8Rng::seed_from_u64(self.laboratory.seed.wrapping_add(1));
        rng.set_stream(index as u64);
        self.laboratory.set(engine, index, step);
        // A random fraction of a period, so that records start at any phase of the drive.
        let settle = (SETTLE_PERIODS + rng.random_range(0.0..1.0)) * setting.period();
        engine.settle(settle, setting.period());
        let start_tau = engine.tau();
        let duration = PRE_ROLL_S + SAMPLES as f64 / RATE_HZ;
        let recorded = engine.record(duration * omega);
        let first_tau = start_tau + PRE_ROLL_S * omega;
        let impacts: Vec<TrueImpact> = recorded
            .impacts()
            .iter()
            .map(|i| TrueImpact {
                time_s: (i.tau - first_tau) / omega,
                approach_m_s: i.approach * self.speed(),
                separation_m_s: i.separation * self.speed(),
                duration_s: i.duration / omega,
                dead_zone_s: i.dead_zone / omega,
            })
            .collect();
        let phase = engine.phase() - setting.frequency_ratio * (engine.tau() - first_tau);
        let take = Take {
            step,
            index,
            phase,
            start_tau,
            recorded: &recorded,
            impacts: &impacts,
        };
        RawRecord {
            id: format!("r{index:04}"),
            step: *step,
            channels: self.channels(&take, &mut rng),
            motion: true_motion(engine.clone(), setting),
            impacts: impacts
                .into_iter()
                .filter(|i| (0.0..SAMPLES as f64 / RATE_HZ).contains(&i.time_s))
                .collect(),
        }
    }

    fn speed(&self) -> f64 {
        self.laboratory.truth.static_deflection_m() * self.laboratory.truth.natural_rate()
    }

    fn channels(&self, take: &Take<'_>, rng: &mut ChaCha8Rng) -> Vec<RawChannel> {
        let delays = self.laboratory.effects.delays_s;
        let times: Vec<f64> = (0..SAMPLES).map(|i| i as f64 / RATE_HZ).collect();
        let rate = std::f64::consts::TAU * take.step.frequency_hz;
        let drive = times
            .iter()
            .map(|t| 2.0 * (rate * (t - delays[0]) + take.phase).cos())
            .collect();
        let late: Vec<f64> = times.iter().map(|t| t - delays[1]).collect();
        let contact = acquisition::contact_volts(&late, take.impacts, &self.laboratory.faults, rng);
        let [vx, vy, x, y, frame] = self.motion_samples(take);
        let signals: [Vec<f64>; 7] = [drive, contact, vx, vy, x, y, frame];
        let mut disturbance =
            Disturbance::new(&self.laboratory.effects, self.laboratory.seed, take.index);
        sensitivities(&self.laboratory.truth)
            .iter()
            .zip(signals)
            .zip(&self.gains)
            .map(|((sensitivity, values), gain)| {
                let factor = match sensitivity.name {
                    "generator" | "contact" => 1.0,
                    _ => gain / sensitivity.si_per_volt,
                };
                let bend = self.bend(sensitivity.name);
                let mut volts: Vec<f64> = values
                    .iter()
                    .map(|v| v * factor * (1.0 - bend * v * v))
                    .collect();
                disturbance.add(&mut volts);
                acquisition::convert(&mut volts, &self.laboratory.faults, rng);
                RawChannel {
                    name: sensitivity.name,
                    volts,
                }
            })
            .collect()
    }

    /// Relative loss of a channel per square of its signal, SI.
    fn bend(&self, channel: &str) -> f64 {
        let effects = &self.laboratory.effects;
        let full = match channel {
            "generator" | "contact" | "frame_x" => return 0.0,
            "integrator_x" | "integrator_y" => effects.resonance_amplitude_m,
            _ => effects.resonance_amplitude_m * self.laboratory.truth.natural_rate(),
        };
        if effects.compression == 0.0 {
            0.0
        } else {
            effects.compression / (full * full)
        }
    }

    /// Velocities and displacements of both masses and the frame's, SI, each through its filter
    /// and late by its delay: the laser's velocity of x has no filter, the integrators' signals
    /// have a high-pass.
    fn motion_samples(&self, take: &Take<'_>) -> [Vec<f64>; 5] {
        let delays = &self.laboratory.effects.delays_s;
        let corner = |i: usize| Some(self.corners[i] * self.laboratory.faults.high_pass_hz?);
        let channels: [(usize, f64, Option<f64>); 5] = [
            (1, delays[2], None),
            (3, delays[3], corner(0)),
            (0, delays[4], corner(1)),
            (2, delays[5], corner(2)),
            (0, delays[6], corner(1)),
        ];
        let mut fine: Option<(f64, Vec<Phase4>)> = None;
        let mut out = channels.map(|(component, delay, corner_hz)| {
            let states = match fine.take() {
                Some((at, states)) if at == delay => states,
                _ => self.fine_states(take, delay),
            };
            let samples = filtered(&states, component, corner_hz);
            fine = Some((delay, states));
            samples
        });
        for frame in &mut out[4] {
            *frame *= 2e-3;
        }
        out
    }

    /// [x, x', y, y'] in SI at [`FINE`] times the rate of sampling, the pre-roll included.
    fn fine_states(&self, take: &Take<'_>, delay_s: f64) -> Vec<Phase4> {
        let omega = self.laboratory.truth.natural_rate();
        let (x_st, speed) = (self.laboratory.truth.static_deflection_m(), self.speed());
        let count = PRE_ROLL_FINE + (SAMPLES - 1) * FINE + 1;
        let taus = (0..count).map(|i| take.start_tau + (i as f64 * FINE_STEP_S - delay_s) * omega);
        let states = take.recorded.sample(taus).into_iter();
        states
            .map(|[x, vx, y, vy]| [x * x_st, vx * speed, y * x_st, vy * speed])
            .collect()
    }
}

/// One component of a motion through a high-pass, at the rate of sampling.
fn filtered(states: &[Phase4], component: usize, corner_hz: Option<f64>) -> Vec<f64> {
    let mut filter = corner_hz.map(|c| SensorHighPass::new(c, FINE_STEP_S));
    let mut last = states.first().copied().unwrap_or_default();
    let mut out = Vec::with_capacity(SAMPLES);
    for (i, state) in states.iter().enumerate() {
        let mut value = state[component];
        if let Some(filter) = &mut filter {
            let mean = if component % 2 == 1 {
                // The mean velocity is the displacement's difference, jumps included.
                (state[component - 1] - last[component - 1]) / FINE_STEP_S
            } else {
                0.5 * (state[component] + last[component])
            };
            value = filter.next(value, mean);
        }
        last = *state;
        if i >= PRE_ROLL_FINE && (i - PRE_ROLL_FINE).is_multiple_of(FINE) {
            out.push(value);
        }
    }
    out
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
                low_pass: None,
                smoothing: None,
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
            ..record::Setting::default()
        },
        listed: Default::default(),
        flags: Vec::new(),
    }
}
