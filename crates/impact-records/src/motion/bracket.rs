//! Brackets of boundaries: between which two settings of a sweep the motion changed.

use serde::{Deserialize, Serialize};

use crate::motion::kind::Motion;
use crate::motion::observation::Observation;
use crate::record::Sweep;

/// Which boundary of motion a bracket holds.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum BoundaryKind {
    /// Saddle-node boundary s2: z = 1/n vanishes.
    #[default]
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

crate::message_table! { "boundary": BoundaryKind; }

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
    /// Place in the campaign by the order of acquisition: −½ (first record) to ½ (last).
    #[serde(default)]
    pub place: f64,
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
///
/// ```
/// use impact_records::event::{DetectSettings, RigKind};
/// use impact_records::motion::{BoundaryKind, ClassifySettings, Motion, brackets, observe};
/// use impact_records::record::{Record, Setting, Sweep};
///
/// let observed = |sequence: usize, frequency_hz: f64, motion: Motion| {
///     let record = Record {
///         id: format!("r{sequence}"),
///         sample_rate_hz: 2000.0,
///         channels: Vec::new(),
///         setting: Setting {
///             stated_frequency_hz: Some(frequency_hz),
///             clearance_m: Some(1e-3),
///             sweep: Sweep::Up,
///             drive_amplitude: 1.0,
///             sequence,
///             specimen: None,
///             ..Setting::default()
///         },
///         listed: Default::default(),
///         flags: Vec::new(),
///     };
///     let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
///     let mut observation = observe(&record, RigKind::Double, &detect, &classify);
///     observation.classification.motion = motion;
///     observation
/// };
/// let one = Motion::Periodic { impacts_p: 1, periods_n: 1, dead_zone: false };
/// let found = brackets(&[observed(0, 13.8, one), observed(1, 13.9, Motion::Impactless)]);
/// assert_eq!(found[0].kind, BoundaryKind::SaddleNode);
/// assert_eq!([found[0].frequency_low_hz, found[0].frequency_high_hz], [13.8, 13.9]);
/// ```
pub fn brackets(observations: &[Observation]) -> Vec<Bracket> {
    let mut ordered: Vec<&Observation> = observations.iter().collect();
    ordered.sort_by_key(|o| o.setting.sequence);
    let last = ordered.len().saturating_sub(1).max(1) as f64;
    let usable: Vec<(f64, &Observation)> = ordered
        .into_iter()
        .enumerate()
        .filter(|(_, o)| {
            !o.excluded() && !matches!(o.classification.motion, Motion::Undetermined { .. })
        })
        .filter(|(_, o)| o.setting.sweep != Sweep::Unknown)
        .filter(|(_, o)| o.frequency_hz().is_some() && o.setting.clearance_m.is_some())
        .map(|(rank, o)| (rank as f64 / last - 0.5, o))
        .collect();
    let found = usable.windows(2).filter_map(|pair| {
        let [(before_place, before), (after_place, after)] = pair else {
            return None;
        };
        let place = 0.5 * (before_place + after_place);
        bracket(before, after, place)
    });
    found.collect()
}

fn bracket(before: &Observation, after: &Observation, place: f64) -> Option<Bracket> {
    let (a, b) = (before.frequency_hz()?, after.frequency_hz()?);
    let rising = b > a;
    let one_run = before.setting.clearance_m == after.setting.clearance_m
        && before.setting.sweep == after.setting.sweep
        && (before.stated_drive() / after.stated_drive() - 1.0).abs() < 0.02
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
        place,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Flag, Problem};

    fn periodic(impacts_p: u32, periods_n: u32) -> Motion {
        Motion::Periodic {
            impacts_p,
            periods_n,
            dead_zone: false,
        }
    }

    /// Records in the order of acquisition, named a, b, c …
    fn run(list: &[(f64, Motion)]) -> Vec<Observation> {
        let named = list.iter().zip('a'..);
        named
            .enumerate()
            .map(|(i, ((frequency_hz, motion), name))| {
                let mut o = Observation::of(&name.to_string(), *frequency_hz, motion.clone());
                o.setting.sequence = i;
                o
            })
            .collect()
    }

    fn found(observations: &[Observation]) -> Vec<(BoundaryKind, u32, [String; 2])> {
        let all = brackets(observations).into_iter();
        all.map(|b| (b.kind, b.periods_n, b.records)).collect()
    }

    fn pair(a: &str, b: &str) -> [String; 2] {
        [a.to_owned(), b.to_owned()]
    }

    use BoundaryKind::{Grazing, PeriodDoubling, SaddleNode};

    #[test]
    fn an_upward_sweep_brackets_grazing_doubling_and_saddle_node() {
        let list = run(&[
            (11.0, Motion::Impactless),
            (11.1, periodic(1, 1)),
            (11.2, periodic(1, 1)),
            (11.3, periodic(2, 2)),
            (11.4, periodic(1, 1)),
            (11.5, Motion::Impactless),
        ]);
        let want = [
            (Grazing, 1, pair("a", "b")),
            (PeriodDoubling, 1, pair("c", "d")),
            (PeriodDoubling, 1, pair("d", "e")),
            (SaddleNode, 1, pair("e", "f")),
        ];
        assert_eq!(found(&list), want);
        let first = &brackets(&list)[0];
        assert_eq!(
            (first.frequency_low_hz, first.frequency_high_hz),
            (11.0, 11.1)
        );
        assert_eq!((first.from.as_str(), first.to.as_str()), ("0", "1"));
    }

    #[test]
    fn excluded_and_undetermined_records_are_passed_over() {
        let reason = crate::motion::Undetermined::NoDrive;
        let mut list = run(&[
            (11.0, periodic(1, 2)),
            (11.1, Motion::Undetermined { reason }),
            (11.2, periodic(1, 2)),
            (11.3, Motion::Impactless),
        ]);
        list[2].flags.push(Flag::new(None, Problem::NoSamples));
        assert_eq!(found(&list), [(SaddleNode, 2, pair("a", "d"))]);
    }

    #[test]
    fn another_gap_drive_or_direction_begins_another_run() {
        let base = || run(&[(11.0, periodic(1, 1)), (11.1, Motion::Impactless)]);
        assert_eq!(found(&base()).len(), 1);
        let mut gap = base();
        gap[1].setting.clearance_m = Some(2e-3);
        assert!(found(&gap).is_empty());
        let mut drive = base();
        drive[1].setting.drive_amplitude = 1.03;
        assert!(found(&drive).is_empty());
        // A stated downward sweep whose frequency rises is the start of another one.
        let mut down = base();
        down.iter_mut().for_each(|o| o.setting.sweep = Sweep::Down);
        assert!(found(&down).is_empty());
        down.swap(0, 1);
        down[0].setting.sequence = 0;
        down[1].setting.sequence = 1;
        assert_eq!(found(&down), [(Grazing, 1, pair("b", "a"))]);
    }
}
