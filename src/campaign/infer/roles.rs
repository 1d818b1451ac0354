//! The role that each channel probably has, from its name, unit and shape.

use super::InferredChannel;
use crate::record::Role;
use labfiles::units::{self, Dimension};

/// Give each role to the channel that fits best.
pub(super) fn assign(channels: &mut [InferredChannel]) {
    let groups = Groups::of(channels);
    let y_first = sides(channels) || groups.second.is_some();
    for &role in Role::ALL {
        let best = channels
            .iter()
            .enumerate()
            .filter(|(_, c)| c.role.is_none() && !c.is_time)
            .map(|(i, c)| (score(c, role, y_first, &groups), i))
            .filter(|(s, _)| *s > 0)
            .max_by_key(|(s, i)| (*s, std::cmp::Reverse(*i)));
        if let Some((_, index)) = best {
            channels[index].role = Some(role);
        }
    }
}

/// Whether any name refers to the second mass.
fn sides(channels: &[InferredChannel]) -> bool {
    channels.iter().any(|c| side(&c.name) == Some('y'))
}

fn words(name: &str) -> Vec<String> {
    name.to_lowercase()
        .split(|c: char| !c.is_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The mass that a name refers to.
fn side(name: &str) -> Option<char> {
    let of = |word: &str| match word {
        "x" | "1" | "left" | "a" | "vx" | "ax" | "dx" | "x1" | "v1" | "mass1" => Some('x'),
        "y" | "2" | "right" | "b" | "vy" | "ay" | "dy" | "x2" | "v2" | "mass2" => Some('y'),
        _ => None,
    };
    words(name).iter().rev().find_map(|w| of(w))
}

/// How well a channel fits a role; 0: not at all.
fn score(channel: &InferredChannel, role: Role, two_sided: bool, groups: &Groups) -> u32 {
    let kind = kind(channel);
    if kind == Kind::Drive && groups.carries(&channel.name) {
        return 0;
    }
    let side = groups.side(channel).or_else(|| side(&channel.name));
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
    let words = words(&channel.name);
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
