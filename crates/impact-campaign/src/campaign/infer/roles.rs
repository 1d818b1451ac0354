//! The role that each channel probably has, from its name, unit and shape.

use super::InferredChannel;
use impact_records::record::Role;
use labfiles::units::{self, Dimension};

/// Give each role to the channel that fits best.
pub(super) fn assign(channels: &mut [InferredChannel]) {
    let axes = Axes::of(channels);
    let groups = Groups::of(channels);
    let y_first = axes.has_second(channels) || groups.second.is_some();
    for &role in Role::ALL {
        let best = channels
            .iter()
            .enumerate()
            .filter(|(i, c)| c.role.is_none() && !c.is_time && !axes.others.contains(i))
            .map(|(i, c)| (score(c, role, (y_first, axes.side(i, c)), &groups), i))
            .filter(|(s, _)| *s > 0)
            .max_by_key(|(s, i)| (*s, std::cmp::Reverse(*i)));
        if let Some((_, index)) = best {
            channels[index].role = Some(role);
        }
    }
}

/// Axes of one sensor, or coordinates of one point: two of them are not two masses.
#[derive(Debug, Default)]
struct Axes {
    /// Those along which less happens than along another.
    others: Vec<usize>,
    /// Of each sensor the one along which most happens, with the words of its name without the axis.
    chosen: Vec<(usize, Vec<String>)>,
}

impl Axes {
    /// There are three of one name, or two whose names are bare (`x`, `y`) or those of a phone, and neither a
    /// drive nor a contact.
    fn of(channels: &[InferredChannel]) -> Self {
        let rig = channels
            .iter()
            .any(|c| matches!(kind(c), Kind::Drive | Kind::Contact));
        let split: Vec<Option<(Vec<String>, char)>> = channels.iter().map(axis).collect();
        let mut axes = Self::default();
        for (i, found) in split.iter().enumerate() {
            let Some((base, 'x')) = found else { continue };
            let same = |letter: char| {
                split
                    .iter()
                    .position(|s| s.as_ref() == Some(&(base.clone(), letter)))
            };
            let Some(y) = same('y') else { continue };
            let z = same('z');
            let phone = base.iter().any(|w| PHONES.contains(&w.as_str()));
            if z.is_none() && (rig || !(base.is_empty() || phone)) {
                continue;
            }
            let all: Vec<usize> = [Some(i), Some(y), z].into_iter().flatten().collect();
            let span = |i: usize| channels[i].range.map_or(0.0, |[low, high]| high - low);
            let most = all
                .iter()
                .copied()
                .max_by(|a, b| span(*a).total_cmp(&span(*b)))
                .unwrap_or(i);
            axes.others
                .extend(all.into_iter().filter(|axis| *axis != most));
            axes.chosen.push((most, base.clone()));
        }
        axes
    }

    /// The mass that a channel's name refers to.
    fn side(&self, index: usize, channel: &InferredChannel) -> Option<char> {
        match self.chosen.iter().find(|(i, _)| *i == index) {
            Some((_, base)) => side_of(base),
            None => side(shown(channel)),
        }
    }

    /// Whether any name refers to the second mass.
    fn has_second(&self, channels: &[InferredChannel]) -> bool {
        let all = channels.iter().enumerate();
        let mut used = all.filter(|(i, _)| !self.others.contains(i));
        used.any(|(i, c)| self.side(i, c) == Some('y'))
    }
}

/// Words by which phones name their sensors.
const PHONES: [&str; 4] = ["linear", "gyroscope", "accelerometer", "magnetometer"];

/// A name as the words that say what was measured, and the letter of an axis at its end.
fn axis(channel: &InferredChannel) -> Option<(Vec<String>, char)> {
    let own = Role::ALL.iter().any(|role| role.name() == channel.name);
    let mut words = words(&channel.name);
    let last = words.pop().filter(|_| !own)?;
    match last.as_str() {
        "x" => Some((words, 'x')),
        "y" => Some((words, 'y')),
        "z" => Some((words, 'z')),
        _ => None,
    }
}

fn words(name: &str) -> Vec<String> {
    name.to_lowercase()
        .split(|c: char| !c.is_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_owned)
        .collect()
}

/// What a channel is called: its label, if it has one.
fn shown(channel: &InferredChannel) -> &str {
    channel.label.as_deref().unwrap_or(&channel.name)
}

/// The mass that a name refers to.
fn side(name: &str) -> Option<char> {
    side_of(&words(name))
}

fn side_of(words: &[String]) -> Option<char> {
    let of = |word: &str| match word {
        "x" | "1" | "left" | "a" | "vx" | "ax" | "dx" | "x1" | "v1" | "mass1" => Some('x'),
        "y" | "2" | "right" | "b" | "vy" | "ay" | "dy" | "x2" | "v2" | "mass2" => Some('y'),
        _ => None,
    };
    words.iter().rev().find_map(|w| of(w))
}

/// How well a channel fits a role; 0: not at all.
fn score(
    channel: &InferredChannel,
    role: Role,
    (two_sided, named): (bool, Option<char>),
    groups: &Groups,
) -> u32 {
    let kind = kind(channel);
    if kind == Kind::Drive && groups.carries(&channel.name) {
        return 0;
    }
    let side = groups.side(channel).or(named);
    let fits = match role {
        Role::Drive => kind == Kind::Drive,
        Role::Contact => kind == Kind::Contact,
        Role::VelocityX | Role::VelocityY => kind == Kind::Velocity,
        Role::DisplacementX | Role::DisplacementY => kind == Kind::Displacement,
        Role::AccelerationX | Role::AccelerationY => kind == Kind::Acceleration,
        Role::FrameX | Role::FrameY => kind == Kind::Frame,
    };
    let of_y = role.is_on_y_side();
    let alive = channel.range.is_some_and(|[low, high]| high > low);
    let base = 1 + 4 * u32::from(alive) + u32::from(channel.unit.is_some());
    match (fits, role.is_motion() || kind == Kind::Frame, side) {
        (false, _, _) => 0,
        (true, false, _) => base,
        (true, true, Some('y')) if of_y => base + 2,
        (true, true, _) if of_y => 0,
        (true, true, Some('x')) if two_sided => base + 2,
        (true, true, Some('y')) => 0,
        _ => base,
    }
}

/// Whether a channel's unit is that of an angular rate.
fn is_rate(channel: &InferredChannel) -> bool {
    channel
        .unit
        .as_deref()
        .is_some_and(|unit| unit.trim() == "rad/s")
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Drive,
    Contact,
    Velocity,
    Displacement,
    Acceleration,
    Frame,
    Unknown,
}

/// Quantity of a channel, from its name, unit and shape.
fn kind(channel: &InferredChannel) -> Kind {
    let words = words(shown(channel));
    let has = |stems: &[&str]| words.iter().any(|w| stems.iter().any(|s| w.starts_with(s)));
    if has(&["frame", "base", "found", "housing", "rahmen", "gestell"]) {
        return Kind::Frame;
    }
    if has(&["contact", "touch", "switch", "kontakt"]) {
        return Kind::Contact;
    }
    let unit = units::unit_of(channel.unit.as_deref(), &channel.name);
    match unit.map(|u| u.dimension) {
        Some(Dimension::Velocity) => return Kind::Velocity,
        Some(Dimension::Length) => return Kind::Displacement,
        Some(Dimension::Acceleration) => return Kind::Acceleration,
        // of a rig that turns
        Some(Dimension::Angle) => return Kind::Displacement,
        Some(Dimension::Frequency) if is_rate(channel) => return Kind::Velocity,
        Some(Dimension::Force) => return Kind::Drive,
        _ => {}
    }
    const DRIVES: [&str; 9] = [
        "drive", "gen", "exc", "hammer", "force", "input", "shaker", "erreg", "anreg",
    ];
    match () {
        () if has(&DRIVES) => Kind::Drive,
        () if has(&["vel", "speed", "laser", "ldv", "vib", "vx", "vy"]) => Kind::Velocity,
        () if has(&["disp", "pos", "dx", "dy"]) => Kind::Displacement,
        () if has(&["acc"]) => Kind::Acceleration,
        () if channel.levels.is_some() => Kind::Contact,
        () => Kind::Unknown,
    }
}

/// Channels named alike but for what they measure: "Blue Position", "Blue Velocity", "Red Position" ….
/// Two such groups that move are the two masses, and a force among them is one that the mass carries.
#[derive(Debug, Default)]
struct Groups {
    first: Option<String>,
    second: Option<String>,
    /// All groups with a motion, also one at rest.
    all: Vec<String>,
}

impl Groups {
    fn of(channels: &[InferredChannel]) -> Self {
        let mut names: Vec<String> = Vec::new();
        let alive = |c: &InferredChannel| c.range.is_some_and(|[low, high]| high > low);
        let moves = |c: &&InferredChannel| matches!(kind(c), Kind::Velocity | Kind::Displacement);
        let all: Vec<String> = channels
            .iter()
            .filter(moves)
            .filter_map(|c| group(&c.name))
            .collect();
        for channel in channels.iter().filter(moves).filter(|c| alive(c)) {
            let Some(group) = group(&channel.name) else {
                continue;
            };
            if !names.contains(&group) {
                names.push(group);
            }
        }
        let mut names = names.into_iter();
        match (names.next(), names.next(), names.next()) {
            (first, second, None) => Self { first, second, all },
            _ => Self {
                all,
                ..Self::default()
            },
        }
    }

    /// The mass that a channel's group is; `None` unless there are two.
    fn side(&self, channel: &InferredChannel) -> Option<char> {
        let second = self.second.as_ref()?;
        let group = group(&channel.name)?;
        if Some(&group) == self.first.as_ref() {
            Some('x')
        } else {
            (group == *second).then_some('y')
        }
    }

    /// Whether a mass of these groups carries the sensor.
    fn carries(&self, name: &str) -> bool {
        group(name).is_some_and(|g| self.all.contains(&g))
    }
}

/// What comes before the quantity in a name: "blue" of "Blue:Acceleration - x".
fn group(name: &str) -> Option<String> {
    const QUANTITIES: [&str; 12] = [
        "position",
        "velocity",
        "speed",
        "acceleration",
        "force",
        "displacement",
        "posizione",
        "velocità",
        "accelerazione",
        "forza",
        "weg",
        "geschwindigkeit",
    ];
    let words = words(name);
    let at = words
        .iter()
        .position(|w| QUANTITIES.contains(&w.as_str()))?;
    (at > 0).then(|| words[..at].join(" "))
}
