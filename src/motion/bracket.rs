//! Brackets of boundaries: between which two settings of a sweep the motion changed.

use serde::{Deserialize, Serialize};

use crate::motion::Motion;
use crate::motion::observation::Observation;
use crate::record::Sweep;

/// Which boundary of motion a bracket holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BoundaryKind {
    /// Saddle-node boundary s2: z = 1/n vanishes.
    SaddleNode,
    /// Period-doubling boundary s1: z = 1/n becomes 2/2n.
    PeriodDoubling,
    /// Grazing boundary ρ': impacts begin or end.
    Grazing,
    /// Another change of motion.
    Other,
}

impl BoundaryKind {
    /// The paper's name of it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SaddleNode => "s2",
            Self::PeriodDoubling => "s1",
            Self::Grazing => "grazing",
            Self::Other => "other",
        }
    }
}

/// Two records next to each other in a sweep, with different motions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bracket {
    /// Which boundary.
    pub kind: BoundaryKind,
    /// n of the z = 1/n motion that ends or doubles; 1 for grazing.
    pub periods_n: u32,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// Lower drive frequency, Hz.
    pub frequency_low_hz: f64,
    /// Upper drive frequency, Hz.
    pub frequency_high_hz: f64,
    /// Direction in which it was crossed.
    pub sweep: Sweep,
    /// Motion before, as a label.
    pub from: String,
    /// Motion after, as a label.
    pub to: String,
    /// Records on both sides, in the order of acquisition.
    pub records: [String; 2],
}

impl Bracket {
    /// Middle frequency, Hz.
    pub fn middle_hz(&self) -> f64 {
        0.5 * (self.frequency_low_hz + self.frequency_high_hz)
    }

    /// Width, Hz.
    pub fn width_hz(&self) -> f64 {
        self.frequency_high_hz - self.frequency_low_hz
    }
}

/// All brackets of a campaign: observations in the order of acquisition, grouped into runs of one
/// clearance and one sweep direction. Records that are excluded or undetermined are passed over;
/// the bracket then spans them.
pub fn brackets(observations: &[Observation]) -> Vec<Bracket> {
    let mut usable: Vec<&Observation> = observations
        .iter()
        .filter(|o| {
            !o.excluded() && !matches!(o.classification.motion, Motion::Undetermined { .. })
        })
        .filter(|o| o.setting.sweep != Sweep::Unknown)
        .filter(|o| o.frequency_hz().is_some() && o.setting.clearance_m.is_some())
        .collect();
    usable.sort_by_key(|o| o.setting.sequence);
    usable
        .windows(2)
        .filter_map(|pair| bracket(pair[0], pair[1]))
        .collect()
}

fn bracket(before: &Observation, after: &Observation) -> Option<Bracket> {
    let (a, b) = (before.frequency_hz()?, after.frequency_hz()?);
    let rising = b > a;
    let one_run = before.setting.clearance_m == after.setting.clearance_m
        && before.setting.sweep == after.setting.sweep
        && (before.setting.drive_amplitude / after.setting.drive_amplitude - 1.0).abs() < 0.02
        && rising == (before.setting.sweep == Sweep::Up);
    if !one_run || before.classification.motion == after.classification.motion {
        return None;
    }
    let (kind, periods_n) = kind(before, after);
    Some(Bracket {
        kind,
        periods_n,
        clearance_m: before.setting.clearance_m?,
        drive_amplitude: 0.5 * (before.setting.drive_amplitude + after.setting.drive_amplitude),
        frequency_low_hz: a.min(b),
        frequency_high_hz: a.max(b),
        sweep: before.setting.sweep,
        from: before.classification.motion.label(),
        to: after.classification.motion.label(),
        records: [before.record.clone(), after.record.clone()],
    })
}

fn kind(before: &Observation, after: &Observation) -> (BoundaryKind, u32) {
    use BoundaryKind::{Grazing, Other, PeriodDoubling, SaddleNode};
    let up = before.setting.sweep == Sweep::Up;
    let (from, to) = (&before.classification.motion, &after.classification.motion);
    match (from, to, before.one_impact_in()) {
        (Motion::Impactless, _, _) => (Grazing, 1),
        // z = 1 vanishes upward at s2; z = 1/n at s2 on either side of its region.
        (_, Motion::Impactless, Some(1)) if up => (SaddleNode, 1),
        (_, Motion::Impactless, Some(n)) if n > 1 => (SaddleNode, n),
        _ => match doubled(from, to).or_else(|| doubled(to, from)) {
            Some(n) => (PeriodDoubling, n),
            None => (Other, before.one_impact_in().unwrap_or(1)),
        },
    }
}

/// n where `one` is z = 1/n and `two` is z = 2/2n.
fn doubled(one: &Motion, two: &Motion) -> Option<u32> {
    match (one, two) {
        (
            Motion::Periodic {
                impacts_p: 1,
                periods_n: n,
                ..
            },
            Motion::Periodic {
                impacts_p: 2,
                periods_n: m,
                ..
            },
        ) if *m == 2 * n => Some(*n),
        _ => None,
    }
}
