//! A periodic record as the fits use it.

use std::sync::Arc;

use crate::evidence::shared_error::Whitening;
use crate::evidence::waveform::{Phases, Rates};
use crate::methods::trajectories::reduced_record::{ReducedRecord, Weighted};
use crate::parameters::effect::Effect;
use crate::parameters::own::Circumstances;
use crate::parameters::{Parameters, gain_index};
use crate::solver::group::Group;
use impact_records::event::RigKind;
use impact_records::motion::{Folded, FoldedChannel};
use impact_records::signal::columns::{dot, subtract};
use impact_records::signal::robust;

/// One folded record.
#[derive(Debug, Clone, Default)]
pub struct TrajectoryRecord {
    /// Index among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// The folded waveform.
    pub folded: Arc<Folded>,
    /// Phases of the points: usually one set that all channels share.
    pub phases: Arc<[Phases]>,
    /// Median closing speed before impacts as measured, m/s.
    pub closing_speed_m_s: f64,
    /// That of the campaign's periodic records, m/s.
    pub typical_approach_m_s: f64,
    /// Standard error of the drive's frequency, relative.
    pub frequency_error: f64,
    /// Standard error of the drive's phase, rad.
    pub phase_error_rad: f64,
    /// Place of the clearance among those that carry an error of their own.
    pub gap: Option<usize>,
    /// Standard error of the clearance, m, where no other record has the same.
    pub lone_clearance_error_m: f64,
    /// Place in the campaign, −½ … ½.
    pub place: f64,
    /// The groups of records that it belongs to.
    pub group: Group,
    /// Acceleration of the masses toward each other at the impacts over the approach speed, 1/s; zero
    /// until it is found at good parameters.
    pub press_per_s: f64,
    /// Changes of all points' values, SI, by one standard error of phase, of frequency and of a lone
    /// clearance; empty until they are found at good parameters.
    pub shared: Vec<Vec<f64>>,
    /// What effects that act as extra accelerations change; empty until it is found at good parameters.
    pub perturbations: Vec<Perturbation>,
    /// How its residuals are weighted.
    pub weighing: Weighing,
    /// Its weighted residuals in few rows near good parameters; none until these are known.
    pub reduced: Option<ReducedRecord>,
}

/// What an effect that acts as an extra acceleration changes, per unit of its strength: the masses'
/// own periodic responses, which are small, and by them the impact, which may move far.
#[derive(Debug, Clone)]
pub struct Perturbation {
    /// The effect.
    pub effect: Effect,
    /// What the responses add to X + Y at the impact and to X' + Y' just before it.
    pub at_impact: [f64; 2],
    /// What they add to all points' values, SI, beside what the impact's change does.
    pub values: Vec<f64>,
}

impl TrajectoryRecord {
    /// Where and when it was taken.
    pub fn circumstances(&self, rig: RigKind) -> Circumstances {
        Circumstances {
            frequency_hz: self.frequency_hz,
            clearance_m: self.clearance_m,
            gap: self.gap,
            place: self.place,
            approach_m_s: self.closing_speed_m_s,
            typical_approach_m_s: self.typical_approach_m_s,
            press_per_s: self.press_per_s,
            masses: if rig == RigKind::Double { 2.0 } else { 1.0 },
        }
    }

    /// Whether it has the channel of a gain.
    pub(in crate::methods) fn has(&self, index: usize) -> bool {
        let mut channels = self.folded.channels.iter();
        channels.any(|c| gain_index(c.role) == Some(index))
    }

    /// Weigh the residuals with a relative error of every point beside the noise.
    pub(in crate::methods) fn weigh(&mut self, relative_error: f64) {
        self.weighing = Weighing::new(self, relative_error);
        self.reduced = None;
    }

    /// Measured less modelled values.
    pub(in crate::methods) fn apart(&self, values: &[f64]) -> Vec<f64> {
        let points = self.folded.channels.iter().flat_map(|c| &c.points);
        points.zip(values).map(|(p, v)| p.value - v).collect()
    }

    /// What an effect that acts as an extra acceleration changes; `None` where it is not known.
    pub(in crate::methods) fn perturbation(&self, effect: Effect) -> Option<&Perturbation> {
        self.perturbations.iter().find(|p| p.effect == effect)
    }

    /// What all effects together add to X + Y at the impact and to X' + Y' just before it.
    pub(in crate::methods) fn extra_at_impact(&self, parameters: &Parameters) -> [f64; 2] {
        let of = |sum: [f64; 2], p: &Perturbation| {
            let strength = parameters.effect(p.effect);
            [0, 1].map(|i| sum[i] + strength * p.at_impact[i])
        };
        self.perturbations.iter().fold([0.0; 2], of)
    }

    /// What it is reduced to, weighted as it is, about a motion.
    pub(in crate::methods) fn reduced_about(&self, rates: &Rates) -> Option<ReducedRecord> {
        let weighing = &self.weighing;
        let phases = |c: &FoldedChannel| self.phases.iter().find(|p| p.fit(&c.points));
        let phases: Option<Vec<&Phases>> = self.folded.channels.iter().map(phases).collect();
        let measured = self.folded.channels.iter().flat_map(|c| &c.points);
        let measured: Vec<f64> = measured.map(|p| p.value).collect();
        let changes = self.perturbations.iter();
        let weighted = Weighted {
            phases: phases?,
            measured: weighing.centred(&measured),
            effects: changes
                .map(|p| (p.effect, weighing.centred(&p.values)))
                .collect(),
            whitening: &weighing.shared,
            weigh: &|channel, values| weighing.centred_of(channel, values),
        };
        ReducedRecord::new(&weighted, rates)
    }

    /// Number of points of all channels.
    pub(in crate::methods) fn points(&self) -> usize {
        self.folded.channels.iter().map(|c| c.points.len()).sum()
    }
}

/// How a record's residuals are weighted: by the errors of the points, the channels' offsets projected
/// out, the errors that all points share made independent. It rests on what was measured, not on the
/// model's values: weights that follow the parameters would reward a model that moves more.
#[derive(Debug, Clone, Default)]
pub struct Weighing {
    channels: Vec<Weights>,
    shared: Whitening,
}

impl Weighing {
    /// With a relative error of every point beside the noise.
    pub(in crate::methods) fn new(record: &TrajectoryRecord, relative_error: f64) -> Self {
        let channels = record.folded.channels.iter();
        let mut weighing = Self {
            channels: channels
                .map(|c| Weights::of(c, relative_error * size(c)))
                .collect(),
            shared: Whitening::none(),
        };
        let columns: Vec<Vec<f64>> = record.shared.iter().map(|c| weighing.centred(c)).collect();
        weighing.shared = Whitening::new(&columns);
        weighing
    }

    /// Differences of all points over their errors, without the channels' offsets.
    fn centred(&self, differences: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(differences.len());
        for weights in &self.channels {
            let end = out.len() + weights.roots.len();
            weights.centred(&differences[out.len()..end], &mut out);
        }
        out
    }

    /// The same of the points of one channel.
    fn centred_of(&self, channel: usize, differences: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(differences.len());
        self.channels[channel].centred(differences, &mut out);
        out
    }

    /// Differences of all points, weighted.
    pub(in crate::methods) fn weighted(&self, differences: &[f64]) -> Vec<f64> {
        let mut out = self.centred(differences);
        self.shared.apply(&mut out);
        out
    }
}

/// Measured less modelled values of a record, with all that their mean square depends on beside the
/// relative error that is allowed.
pub(in crate::methods) struct Misfit<'a> {
    record: &'a TrajectoryRecord,
    apart: &'a [f64],
    /// Of each channel the root mean square of its values.
    sizes: Vec<f64>,
}

impl<'a> Misfit<'a> {
    /// Of a record and its differences from the model.
    pub(in crate::methods) fn new(record: &'a TrajectoryRecord, apart: &'a [f64]) -> Self {
        Self {
            record,
            apart,
            sizes: record.folded.channels.iter().map(size).collect(),
        }
    }

    /// Mean square of the weighted residuals with a relative error of every point beside the noise.
    pub(in crate::methods) fn mean_square(&self, relative_error: f64) -> f64 {
        let channels = self.record.folded.channels.iter().zip(&self.sizes);
        let unshared = Weighing {
            channels: channels
                .map(|(channel, size)| Weights::of(channel, relative_error * size))
                .collect(),
            shared: Whitening::none(),
        };
        let shared = self.record.shared.iter();
        let shared: Vec<Vec<f64>> = shared.map(|c| unshared.centred(c)).collect();
        let residuals = unshared.centred(self.apart);
        let along = Whitening::explained(&shared, &residuals);
        (dot(&residuals, &residuals) - along) / residuals.len().max(1) as f64
    }
}

/// Root mean square of a channel's values about their mean.
fn size(channel: &FoldedChannel) -> f64 {
    let values: Vec<f64> = channel.points.iter().map(|p| p.value).collect();
    let offset = robust::mean(&values);
    let moved: Vec<f64> = values.iter().map(|v| v - offset).collect();
    robust::rms(&moved)
}

/// Weights of a channel's points, with the channel's offset, a nuisance, projected out.
#[derive(Debug, Clone)]
struct Weights {
    roots: Vec<f64>,
    total: f64,
}

impl Weights {
    /// With an error of every point beside the noise, SI.
    fn of(channel: &FoldedChannel, scale: f64) -> Self {
        let roots: Vec<f64> = channel
            .points
            .iter()
            .map(|p| {
                let variance = channel.noise.powi(2) / f64::from(p.samples.max(1)) + scale * scale;
                1.0 / variance.sqrt()
            })
            .collect();
        let total: f64 = roots.iter().map(|w| w * w).sum();
        Self {
            roots,
            total: total.max(f64::MIN_POSITIVE),
        }
    }

    /// Differences less their weighted mean, times the roots of the weights.
    fn centred(&self, differences: &[f64], out: &mut Vec<f64>) {
        let start = out.len();
        out.extend(differences.iter().zip(&self.roots).map(|(d, w)| d * w));
        let weighted = &mut out[start..];
        let offset = dot(weighted, &self.roots) / self.total;
        subtract(weighted, offset, &self.roots);
    }
}
