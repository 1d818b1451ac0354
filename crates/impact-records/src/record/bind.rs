//! Channels of a dataset: which one has a role, in which unit, and how its numbers become SI. From
//! metadata alone, before a sample is read.

use serde::{Deserialize, Serialize};

use super::{ContactContent, Flag, LowPass, MeasuredQuantity, Problem, Role, Setting};
use labfiles::units::{self, Dimension, Quantity, Scale, Unit};
use labfiles::{ChannelInfo, DatasetInfo};

/// A channel of a file, by name or by index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChannelKey {
    /// By name; one without its group or its unit, or with its unit, is accepted if only one channel has it.
    Name(String),
    /// By index in the dataset, from 0.
    Index(usize),
}

impl ChannelKey {
    /// The key in messages.
    pub fn text(&self) -> String {
        match self {
            Self::Name(name) => name.clone(),
            Self::Index(index) => format!("number {index}"),
        }
    }

    /// Index of the channel in a dataset; `None` if it has none, or several.
    pub fn find(&self, dataset: &DatasetInfo) -> Option<usize> {
        match self {
            Self::Index(index) => (*index < dataset.channels.len()).then_some(*index),
            Self::Name(name) => find_name(name, dataset),
        }
    }
}

fn find_name(name: &str, dataset: &DatasetInfo) -> Option<usize> {
    let exact = dataset.channels.iter().position(|c| c.name == name);
    let bare = |c: &ChannelInfo| units::split_unit(&c.name).0 == name && !name.is_empty();
    exact
        .or_else(|| only_one(dataset, |c| c.name.rsplit('/').next() == Some(name)))
        // `Latest: Velocity`, as Vernier's programs name what a run has measured
        .or_else(|| only_one(dataset, |c| c.name.rsplit(": ").next() == Some(name)))
        .or_else(|| only_one(dataset, bare))
        .or_else(|| find_headed(name, dataset))
        .or_else(|| find_without_run(name, dataset))
        .or_else(|| find_numbered(name, dataset))
}

/// `column_3`, as a column without a heading is called: the third of the file, whatever its name.
fn find_numbered(name: &str, dataset: &DatasetInfo) -> Option<usize> {
    let number = name.strip_prefix("column_")?;
    let stated = |c: &ChannelInfo| c.properties.get("column").is_some_and(|n| n == number);
    let by_file = dataset.channels.iter().position(stated);
    let index = || number.parse::<usize>().ok()?.checked_sub(1);
    let numbered = dataset
        .channels
        .iter()
        .any(|c| c.properties.contains_key("column"));
    by_file.or_else(|| index().filter(|i| !numbered && *i < dataset.channels.len()))
}

/// The channel whose column is headed so in the file, whose reader splits off the unit, wherever it stands
/// (`Position (m) Run #1`), and the run, if each is a dataset; or the signal of that label.
fn find_headed(name: &str, dataset: &DatasetInfo) -> Option<usize> {
    let (headed, unit) = without_unit_inside(name);
    let run = dataset.name.rsplit('/').next().unwrap_or_default();
    let is = |c: &ChannelInfo| {
        let bare = units::split_unit(&c.name).0;
        let of_run =
            |text: &str| [format!("{text} {run}"), format!("{run}: {text}")].contains(&headed);
        let named = c.name == headed || of_run(&c.name) || bare == headed;
        let label = c
            .properties
            .get("label")
            .is_some_and(|label| *label == headed);
        (named || label) && (unit.is_none() || c.unit == unit)
    };
    only_one(dataset, is)
}

/// The only channel that is called so but for its run, as in one of several files, each of a run: `Position Run #2`;
/// or the only one of a dataset that is called after its run.
fn find_without_run(name: &str, dataset: &DatasetInfo) -> Option<usize> {
    let (headed, unit) = without_unit_inside(name);
    let is = |c: &ChannelInfo| {
        let bare = labfiles::without_run(&c.name).map(|(bare, _)| bare);
        bare.is_some_and(|bare| !bare.is_empty() && bare == headed)
            && (unit.is_none() || c.unit == unit)
    };
    let run = dataset.name.rsplit('/').next().unwrap_or_default();
    let alone = dataset.channels.len() == 1 && !run.is_empty() && run == name;
    only_one(dataset, is).or(alone.then_some(0))
}

/// A heading without the unit in its brackets, and the unit: the last brackets count.
fn without_unit_inside(name: &str) -> (String, Option<String>) {
    let brackets = [('[', ']'), ('(', ')')];
    let found = brackets.iter().find_map(|(open, close)| {
        let from = name.rfind(*open)?;
        let length = name[from..].find(*close)?;
        let unit = name[from + 1..from + length].trim();
        let rest = [name[..from].trim(), name[from + length + 1..].trim()];
        let rest: Vec<&str> = rest.into_iter().filter(|part| !part.is_empty()).collect();
        units::parse_unit(unit).map(|_| (rest.join(" "), Some(unit.to_owned())))
    });
    found.unwrap_or_else(|| {
        let (bare, unit) = units::split_unit(name);
        match unit.filter(|u| units::parse_unit(u).is_some()) {
            Some(unit) => (bare.to_owned(), Some(unit.to_owned())),
            None => (name.trim().to_owned(), None),
        }
    })
}

fn only_one(dataset: &DatasetInfo, fits: impl Fn(&ChannelInfo) -> bool) -> Option<usize> {
    let mut all = dataset.channels.iter().enumerate().filter(|(_, c)| fits(c));
    let first = all.next()?.0;
    all.next().is_none().then_some(first)
}

/// How the channel of one role is read: SI value = sign · (number · unit − offset) · scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelSetup {
    /// What it measures.
    pub role: Role,
    /// Which channel of the file.
    pub source: ChannelKey,
    /// Unit of the numbers in the file; `None`: as the file states.
    pub unit: Option<Unit>,
    /// Scale from the numbers to the measured quantity.
    pub scale: Scale,
    /// Value at rest, SI of the file's unit; subtracted before the scale.
    pub offset: f64,
    /// 1 or −1.
    pub sign: f64,
    /// Corner of the first-order high-pass that the signal carries, Hz.
    pub high_pass_hz: Option<f64>,
    /// Low-pass that the signal has passed.
    #[serde(default)]
    pub low_pass: Option<LowPass>,
    /// How much later than the drive's channel it shows what happens, s.
    #[serde(default)]
    pub delay_s: f64,
    /// Standard uncertainty of the delay, s; `None`: half a sample.
    #[serde(default)]
    pub delay_uncertainty_s: Option<f64>,
    /// Level between open and closed contact, after the scale.
    pub threshold: Option<Quantity>,
    /// Greatest magnitude the converter gives, SI of the file's unit.
    pub range: Option<f64>,
    /// Use `unit` although the file states another.
    pub ignore_file_unit: bool,
    /// What the contact's channel contains.
    #[serde(default)]
    pub content: ContactContent,
    /// Of a list: the columns that follow in the same row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub then: Vec<ChannelKey>,
    /// Of heights: standard uncertainty of each, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_uncertainty_m: Option<f64>,
    /// What recorded it, in words.
    #[serde(default)]
    pub instrument: Option<String>,
}

impl ChannelSetup {
    /// How much later than the drive's channel it shows slow motion, its low-pass included, s.
    pub fn whole_delay_s(&self) -> f64 {
        self.delay_s + self.low_pass.map_or(0.0, |filter| filter.delay_s())
    }

    /// A channel read as it is, in the unit the file states.
    pub fn plain(role: Role, source: ChannelKey) -> Self {
        Self {
            role,
            source,
            unit: None,
            scale: Scale::Factor(1.0),
            offset: 0.0,
            sign: 1.0,
            high_pass_hz: None,
            low_pass: None,
            delay_s: 0.0,
            delay_uncertainty_s: None,
            threshold: None,
            range: None,
            ignore_file_unit: false,
            content: ContactContent::Signal,
            then: Vec::new(),
            height_uncertainty_m: None,
            instrument: None,
        }
    }
}

/// A channel of a role found in a dataset, with the conversion settled.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundChannel {
    /// Index in the dataset.
    pub index: usize,
    /// Factor and dimension of the calibrated values.
    pub to_si: Unit,
    /// Subtracted after the factor, SI.
    pub offset_si: f64,
    /// Greatest magnitude the converter gives, SI after the scale.
    pub range_si: Option<f64>,
}

impl BoundChannel {
    /// The same with the other sign.
    pub(super) fn turned(mut self) -> Self {
        self.to_si.to_si = -self.to_si.to_si;
        self.offset_si = -self.offset_si;
        self
    }
}

/// Find a role's channel in a dataset and settle its conversion, from metadata alone.
///
/// # Errors
/// A [`Flag`] with the reason why the channel cannot be used.
pub fn bind(setup: &ChannelSetup, dataset: &DatasetInfo) -> Result<BoundChannel, Flag> {
    let index = setup
        .source
        .find(dataset)
        .ok_or_else(|| missing(setup, dataset))?;
    let info = &dataset.channels[index];
    let unit = settle_unit(setup, info)?;
    let scaled = setup
        .scale
        .apply(unit)
        .ok_or_else(|| unfit_scale(setup, info, unit))?;
    check_dimension(setup, info, scaled.dimension)?;
    let after_scale = scaled.to_si / unit.to_si;
    Ok(BoundChannel {
        index,
        to_si: Unit {
            to_si: scaled.to_si * setup.sign,
            ..scaled
        },
        offset_si: setup.offset * after_scale * setup.sign,
        range_si: setup.range.map(|r| (r * after_scale).abs()),
    })
}

pub(super) fn flag(setup: &ChannelSetup, channel: &str, problem: Problem) -> Flag {
    Flag::new(Some(channel), problem).excluding(!setup.role.is_frame())
}

fn missing(setup: &ChannelSetup, dataset: &DatasetInfo) -> Flag {
    let shown = dataset.channels.iter().take(16).map(|c| c.name.clone());
    let key = setup.source.text();
    let problem = Problem::NoSuchChannel {
        channel: key.clone(),
        role: setup.role,
        channels: shown.collect(),
    };
    flag(setup, &key, problem)
}

/// The unit of the numbers in the file: as stated there, or in the set-up.
fn settle_unit(setup: &ChannelSetup, info: &ChannelInfo) -> Result<Unit, Flag> {
    let stated = info.unit.as_deref().filter(|u| !u.trim().is_empty());
    let known = stated.and_then(units::parse_unit);
    match (setup.unit, known) {
        (Some(ours), Some(theirs)) if !same(ours, theirs) && !setup.ignore_file_unit => {
            Err(contradicts(setup, info, ours))
        }
        (Some(ours), _) => Ok(ours),
        (None, Some(theirs)) => Ok(theirs),
        // The loudness of a sound has no bearing on when it begins.
        (None, None) if setup.content == ContactContent::Sound => Ok(Unit {
            dimension: Dimension::Number,
            to_si: 1.0,
        }),
        (None, None) => Err(without_unit(setup, info, stated)),
    }
}

fn same(a: Unit, b: Unit) -> bool {
    a.dimension == b.dimension && (a.to_si / b.to_si - 1.0).abs() < 1e-9
}

fn contradicts(setup: &ChannelSetup, info: &ChannelInfo, ours: Unit) -> Flag {
    let (channel, role) = (info.name.clone(), setup.role);
    let stated = info.unit.as_deref().unwrap_or_default().trim().to_owned();
    let problem = match units::symbol_of(ours) {
        Some(ours) => Problem::UnitContradicts {
            channel,
            role,
            stated,
            ours: ours.to_owned(),
        },
        None => Problem::UnitContradictsOther {
            channel,
            role,
            stated,
        },
    };
    flag(setup, &info.name, problem)
}

fn without_unit(setup: &ChannelSetup, info: &ChannelInfo, stated: Option<&str>) -> Flag {
    let (channel, role) = (info.name.clone(), setup.role);
    let problem = match stated.map(str::to_owned) {
        Some(unit) => Problem::UnknownUnit {
            channel,
            role,
            unit,
        },
        None => Problem::NoUnit { channel, role },
    };
    flag(setup, &info.name, problem)
}

fn unfit_scale(setup: &ChannelSetup, info: &ChannelInfo, unit: Unit) -> Flag {
    let problem = Problem::UnfitScale {
        channel: info.name.clone(),
        role: setup.role,
        dimension: unit.dimension,
    };
    flag(setup, &info.name, problem)
}

fn check_dimension(setup: &ChannelSetup, info: &ChannelInfo, found: Dimension) -> Result<(), Flag> {
    use MeasuredQuantity::{Accepted, Of, OfThreshold, Times};
    let role = setup.role;
    let wrong = |expected| {
        let problem = wrong_quantity(&info.name, role, found, expected);
        Err(flag(setup, &info.name, problem))
    };
    let list = setup.content.is_list();
    match role.dimension() {
        None if setup.content.is_of_heights() && found != Dimension::Length => {
            return wrong(Of(Dimension::Length));
        }
        None if setup.content.is_of_heights() => return Ok(()),
        None if list && found != Dimension::Time => return wrong(Times),
        None if list => return Ok(()),
        Some(expected) if found != expected => return wrong(Of(expected)),
        None if !serves(role, found) => return wrong(Accepted),
        _ => {}
    }
    match setup.threshold {
        Some(level) if level.dimension != found => wrong(OfThreshold(level.dimension)),
        _ => Ok(()),
    }
}

/// That a channel measures another quantity than expected, with the scale that its role needs where one is known.
fn wrong_quantity(
    channel: &str,
    role: Role,
    found: Dimension,
    expected: MeasuredQuantity,
) -> Problem {
    let channel = channel.to_owned();
    let turning = |found, scale: &str| Problem::TurningMotion {
        channel: channel.clone(),
        role,
        found,
        expected,
        scale: scale.to_owned(),
    };
    match (found, role.dimension()) {
        (Dimension::Angle, Some(_)) => turning(MeasuredQuantity::Of(found), "0.15 m per rad"),
        (Dimension::Frequency, Some(_)) => {
            turning(MeasuredQuantity::AngularRate, "0.15 m/s per rad/s")
        }
        (Dimension::Voltage, Some(wanted)) => Problem::VoltageOfMotion {
            channel,
            role,
            expected,
            unit: wanted.si_symbol().replace('²', "2"),
        },
        (Dimension::Voltage, None) if role.is_frame() => Problem::VoltageOfMotion {
            channel,
            role,
            expected,
            unit: "m/s2".to_owned(),
        },
        _ => Problem::WrongQuantity {
            channel,
            role,
            found: MeasuredQuantity::Of(found),
            expected,
        },
    }
}

/// Whether a role that accepts several dimensions accepts this one.
fn serves(role: Role, found: Dimension) -> bool {
    use Dimension::{Acceleration, Force, Length, Number, Velocity, Voltage};
    match role {
        Role::Drive => matches!(found, Voltage | Force | Length | Acceleration | Number),
        Role::Contact => matches!(found, Voltage | Force | Number),
        Role::FrameX | Role::FrameY => matches!(found, Length | Velocity | Acceleration),
        _ => true,
    }
}

pub(super) type BoundRole<'a> = (&'a ChannelSetup, BoundChannel);

/// What is stated of the times of records whose files do not state it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StatedTimes {
    /// The channel with the time, if the reader of the files cannot find it.
    pub time: Option<ChannelKey>,
    /// Seconds in the unit of time axes that state none.
    #[serde(default)]
    pub time_unit_s: Option<f64>,
    /// Samples per second, Hz, for files that state none.
    pub sample_rate_hz: Option<f64>,
}

/// Everything that turns one dataset into one record.
#[derive(Debug, Clone)]
pub struct RecordSetup<'a> {
    /// The record's name.
    pub id: &'a str,
    /// Index of the dataset in the source.
    pub dataset: usize,
    /// The channels by role.
    pub channels: &'a [ChannelSetup],
    /// What is stated of its times.
    pub times: &'a StatedTimes,
    /// The setting as the laboratory states it.
    pub setting: &'a Setting,
    /// Whether a harmonic drive must be seen.
    pub driven: bool,
    /// Part to leave out at the start, s.
    pub skip_s: f64,
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use labfiles::StoredType;

    use super::*;

    #[test]
    fn an_angular_rate_needs_the_arm() {
        let channel = ChannelInfo {
            name: "gyro".into(),
            unit: Some("rad/s".into()),
            stored: StoredType::Float(64),
            samples: 100,
            sample_rate_hz: None,
            start_time: None,
            clock: labfiles::Clock::Shared,
            start_s: None,
            properties: BTreeMap::new(),
        };
        let dataset = DatasetInfo {
            channels: vec![channel],
            ..DatasetInfo::default()
        };
        let mut setup = ChannelSetup::plain(Role::VelocityX, ChannelKey::Name("gyro".into()));
        let flag = bind(&setup, &dataset).unwrap_err();
        assert_eq!(
            flag.message(),
            "channel 'gyro' of the role velocity_x comes out as an angular rate, not as a velocity"
        );
        assert!(
            flag.remedy().ends_with("scale = \"0.15 m/s per rad/s\""),
            "{}",
            flag.remedy()
        );
        let volts = DatasetInfo {
            channels: vec![ChannelInfo {
                unit: Some("V".into()),
                ..dataset.channels[0].clone()
            }],
            ..DatasetInfo::default()
        };
        let wanted = ChannelSetup::plain(Role::AccelerationX, ChannelKey::Name("gyro".into()));
        let flag = bind(&wanted, &volts).unwrap_err();
        assert!(
            flag.message()
                .ends_with("as a voltage, not as an acceleration"),
            "{}",
            flag.message()
        );
        assert!(
            flag.remedy().ends_with("scale = \"0.05 m/s2 per V\""),
            "{}",
            flag.remedy()
        );
        let frame = ChannelSetup::plain(Role::FrameX, ChannelKey::Name("gyro".into()));
        let flag = bind(&frame, &volts).unwrap_err();
        assert!(
            flag.remedy().ends_with("scale = \"0.05 m/s2 per V\""),
            "{}",
            flag.remedy()
        );
        setup.scale = units::parse_scale("0.15 m/s per rad/s").unwrap();
        let bound = bind(&setup, &dataset).unwrap();
        assert!((bound.to_si.to_si - 0.15).abs() < 1e-12);
        assert_eq!(bound.to_si.dimension, Dimension::Velocity);
    }

    fn channel(name: &str, unit: &str) -> ChannelInfo {
        ChannelInfo {
            name: name.into(),
            unit: Some(unit.into()),
            stored: StoredType::Float(64),
            samples: 100,
            sample_rate_hz: None,
            start_time: None,
            clock: labfiles::Clock::Shared,
            start_s: None,
            properties: BTreeMap::new(),
        }
    }

    #[test]
    fn a_channel_is_found_without_its_run() {
        let runs = DatasetInfo {
            name: "Run #1".into(),
            channels: vec![channel("Time", "s"), channel("Position", "m")],
            ..DatasetInfo::default()
        };
        for heading in [
            "Position (m) Run #1",
            "Position Run #1",
            "Position (m)",
            "Position",
        ] {
            assert_eq!(
                ChannelKey::Name(heading.into()).find(&runs),
                Some(1),
                "{heading}"
            );
        }
        for heading in ["Position (m) Run #2", "Position (mm) Run #1"] {
            assert_eq!(
                ChannelKey::Name(heading.into()).find(&runs),
                None,
                "{heading}"
            );
        }
        let single = DatasetInfo {
            channels: vec![channel("Time Run #1", "s"), channel("Position Run #1", "m")],
            ..DatasetInfo::default()
        };
        for heading in ["Position (m) Run #1", "Position Run #1"] {
            assert_eq!(
                ChannelKey::Name(heading.into()).find(&single),
                Some(1),
                "{heading}"
            );
        }
        // one file for each run
        for (heading, found) in [
            ("Position", Some(1)),
            ("Position (m)", Some(1)),
            ("Position (mm)", None),
            ("Velocity", None),
            ("", None),
        ] {
            let key = ChannelKey::Name(heading.into());
            assert_eq!(key.find(&single), found, "{heading}");
        }
        let list = DatasetInfo {
            name: "Throw 2".into(),
            channels: vec![channel("time", "ms")],
            ..DatasetInfo::default()
        };
        let of_list = |name: &str| ChannelKey::Name(name.into()).find(&list);
        assert_eq!((of_list("Throw 2"), of_list("Throw 1")), (Some(0), None));
        let third = ChannelKey::Name("column_2".into());
        assert_eq!(third.find(&runs), Some(1));
    }

    #[test]
    fn a_channel_is_found_with_its_unit_as_its_column_is_headed() {
        let mut labelled = channel("scope.signals(1).values", "m/s");
        labelled
            .properties
            .insert("label".into(), "velocity".into());
        let scope = DatasetInfo {
            channels: vec![labelled],
            ..DatasetInfo::default()
        };
        assert_eq!(ChannelKey::Name("velocity".into()).find(&scope), Some(0));
        let third = ChannelKey::Name("column_2".into());
        assert_eq!(third.find(&scope), None);
        let dataset = DatasetInfo {
            channels: vec![
                channel("time", "s"),
                channel("generator", "V"),
                channel("x", "mm"),
            ],
            ..DatasetInfo::default()
        };
        let find = |name: &str| ChannelKey::Name(name.into()).find(&dataset);
        assert_eq!(find("generator"), Some(1));
        assert_eq!(find("generator in V"), Some(1));
        assert_eq!(find("x [mm]"), Some(2));
        assert_eq!(find("x [m]"), None);
        assert_eq!(find("y"), None);
    }
}
