//! Chosen records beside their simulation with the fitted parameters.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::input::{Input, place};
use super::traces::{Cut, Trace, largest_residual, traces};
use crate::identify::replay::{Replay, Stretch};
use impact_fit::parameters::Parameters;
use impact_records::event::{DetectSettings, DetectionSource, DriveTone, Impact, detect};
use impact_records::motion::{Motion, Observation};
use impact_records::record::{Record, Role};

/// A record compared with its simulation, from a zero phase of the drive on.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayedRecord {
    /// The point's letter in the map, `A`, `B` …
    pub letter: char,
    /// The record's name.
    pub record: String,
    /// η, if f0 is known.
    pub eta: Option<f64>,
    /// ρ, if `x_st` is known.
    pub rho: Option<f64>,
    /// Drive period, s.
    pub drive_period_s: f64,
    /// Motion found in the record.
    pub motion: Motion,
    /// Motion of the simulation with the fitted parameters.
    pub simulated_motion: Option<Motion>,
    /// The channels.
    pub traces: Vec<Trace>,
    /// Of how many of the impacts shown the contact has no pulse; `None` without a contact.
    pub missed_by_contact: Option<usize>,
    /// Times of the measured impacts, s on the traces' axis.
    pub impacts_s: Vec<f64>,
    /// Times of the simulated impacts, s on the traces' axis.
    pub simulated_impacts_s: Vec<f64>,
}

/// Most comparisons of one campaign.
const MOST_COMPARISONS: usize = 8;
/// Records of a higher confidence differ in their noise alone.
const SURE: f64 = 0.95;
/// Residual over the signal below which the simulated motion is the measured one.
const SAME_MOTION: f64 = 0.05;
/// Drive periods that are shown at least.
const SHOWN_PERIODS: u32 = 4;
/// Drive periods that are shown of a motion without a period.
const IRREGULAR_PERIODS: u32 = 10;

/// Rank of motions without a period among the types that are compared; they are shown last.
const IRREGULAR: u8 = 1;

/// Indices of the records to compare: those named, else the surest of each type of motion of the campaign, of these
/// one inside a run of the same motion. Where there are more types than comparisons, z = 1/n and p/1 come first, then chaos,
/// other periodic motions and z = 0.
pub(super) fn chosen_records(input: &Input<'_>) -> Vec<usize> {
    let observations = input.observations;
    let find = |name: &String| observations.iter().position(|o| o.record == *name);
    let by_name: Vec<usize> = input.points.iter().filter_map(find).collect();
    if !by_name.is_empty() {
        return by_name;
    }
    let alike = alike_beside(observations);
    let quality = |i: usize| quality(&observations[i], alike[i]);
    let mut best: BTreeMap<(u8, String), usize> = BTreeMap::new();
    for (i, o) in observations.iter().enumerate() {
        let rank = match &o.classification.motion {
            _ if o.excluded() || o.drive.is_none() => continue,
            Motion::Periodic {
                impacts_p,
                periods_n,
                ..
            } if *impacts_p == 1 || *periods_n == 1 => 0,
            Motion::Beat | Motion::Chaotic => IRREGULAR,
            Motion::Periodic { .. } => 2,
            Motion::Impactless => 3,
            _ => continue,
        };
        let key = (rank, o.classification.motion.label());
        let better = |k: &usize| quality(i) > quality(*k);
        if best.get(&key).is_none_or(better) {
            best.insert(key, i);
        }
    }
    let mut shown: Vec<((u8, String), usize)> = best.into_iter().take(MOST_COMPARISONS).collect();
    shown.sort_by_key(|((rank, _), _)| (*rank == IRREGULAR, *rank));
    shown.into_iter().map(|(_, i)| i).collect()
}

/// Confidence first, then the distance from the ends of the motion's region, then the strength of the motion over its noise.
fn quality(o: &Observation, alike: usize) -> (f64, usize, f64) {
    let noise = o.classification.evidence.noise_ratio.unwrap_or(1.0);
    (o.classification.confidence.min(SURE), alike, -noise)
}

/// Of each record how many of the two measured just before and after it at its gap and in its direction have its motion.
fn alike_beside(observations: &[Observation]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..observations.len()).collect();
    order.sort_by_key(|i| observations[*i].setting.sequence);
    let mut alike = vec![0; observations.len()];
    for pair in order.windows(2) {
        let &[i, k] = pair else { continue };
        let (a, b) = (&observations[i], &observations[k]);
        let same = a.setting.clearance_m == b.setting.clearance_m
            && a.setting.sweep == b.setting.sweep
            && a.classification.motion == b.classification.motion;
        if same {
            alike[i] += 1;
            alike[k] += 1;
        }
    }
    alike
}

/// The chosen records with letters in their order; none for a record without a drive.
pub(super) fn comparisons(input: &Input<'_>, chosen: &[usize]) -> Vec<ReplayedRecord> {
    let letters: Vec<char> = ('A'..='Z').collect();
    let lettered = chosen.par_iter().zip(letters);
    lettered
        .filter_map(|(i, letter)| {
            let o = &input.observations[*i];
            comparison(input, o, &(input.read)(*i)?, letter, input.parameters())
        })
        .collect()
}

/// A record beside its simulation with parameters; `None` without a drive.
pub(super) fn comparison(
    input: &Input<'_>,
    o: &Observation,
    record: &Record,
    letter: char,
    parameters: Option<&Parameters>,
) -> Option<ReplayedRecord> {
    let drive = o.drive?;
    let detection = detect(record, input.rig, &DetectSettings::default());
    let periods = match o.classification.motion {
        Motion::Periodic { periods_n, .. } => (2 * periods_n).max(SHOWN_PERIODS),
        Motion::Impactless => SHOWN_PERIODS,
        _ => IRREGULAR_PERIODS,
    };
    let stretch = stretch(drive, periods);
    let simulation = parameters.and_then(|p| Replay::of(input.rig, *p, o, &stretch));
    let (eta, rho) = parameters.map_or((None, None), |p| place(p, o));
    let motion = &o.classification.motion;
    let cut = Cut {
        stretch,
        repeats_after_s: repeats_after_periods(motion).map(|n| n * drive.period_s()),
        impacts: &o.impacts,
        simulation: simulation.as_ref(),
    };
    let traces = traces(record, &detection.kinematics, &cut);
    let simulated_motion = simulation.as_ref().map(|s| {
        let same = largest_residual(&traces) < SAME_MOTION;
        if same { motion } else { &s.motion }.clone()
    });
    let shown = |i: &&Impact| (0.0..stretch.length_s).contains(&(i.time_s - stretch.start_s));
    let impacts: Vec<&Impact> = o.impacts.iter().filter(shown).collect();
    let without = |i: &&&Impact| i.source == DetectionSource::Velocity;
    let missed = impacts.iter().filter(without).count();
    Some(ReplayedRecord {
        letter,
        record: o.record.clone(),
        eta,
        rho,
        drive_period_s: drive.period_s(),
        motion: motion.clone(),
        simulated_motion,
        traces,
        missed_by_contact: record.channel(Role::Contact).map(|_| missed),
        impacts_s: impacts.iter().map(|i| i.time_s - stretch.start_s).collect(),
        simulated_impacts_s: simulation.map(|s| s.impacts_s).unwrap_or_default(),
    })
}

/// Drive periods after which a motion repeats; `None` where it does not.
fn repeats_after_periods(motion: &Motion) -> Option<f64> {
    match motion {
        Motion::Periodic { periods_n, .. } => Some(f64::from(*periods_n)),
        Motion::Impactless => Some(1.0),
        _ => None,
    }
}

/// The stretch of a record that is shown: from the first zero phase of its drive.
fn stretch(drive: DriveTone, periods: u32) -> Stretch {
    let period_s = drive.period_s();
    Stretch {
        drive,
        start_s: period_s * (1.0 - drive.phase_at(0.0) / std::f64::consts::TAU),
        length_s: f64::from(periods) * period_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_inside_a_run_of_a_motion_are_told_from_those_at_its_ends() {
        let quarter = Motion::periodic(1, 4);
        let motions = [Motion::Chaotic, quarter.clone(), quarter.clone(), quarter];
        let mut run: Vec<Observation> = motions
            .into_iter()
            .map(|motion| Observation::of("r", 12.0, motion))
            .collect();
        for (i, o) in run.iter_mut().enumerate() {
            o.setting.sequence = i;
        }
        assert_eq!(alike_beside(&run), [0, 1, 2, 1]);
        // the last one at another gap is no neighbour
        run[3].setting.clearance_m = Some(2e-3);
        assert_eq!(alike_beside(&run), [0, 1, 1, 0]);
    }

    #[test]
    fn a_stretch_begins_at_a_zero_phase_of_the_drive() {
        let drive = DriveTone {
            phase_rad: 0.25 * std::f64::consts::TAU,
            ..DriveTone::at(10.0, 1.0)
        };
        // a quarter of a period has passed at the first sample: three quarters to go
        let quarter = stretch(drive, 2);
        assert!((quarter.start_s - 0.075).abs() < 1e-12);
        assert!((quarter.length_s - 0.2).abs() < 1e-12);
    }
}
