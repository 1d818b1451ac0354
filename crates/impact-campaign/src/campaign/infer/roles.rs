//! The role that each channel probably has, from its name, unit and shape.

use super::found::InferredChannel;
use impact_records::record::Role;
use labfiles::units::{self, Dimension};

/// Give each role to the channel that fits best.
pub(super) fn assign(channels: &mut [InferredChannel]) {
    let axes = Axes::of(channels);
    let groups = Groups::of(channels, &axes);
    let second = axes.has_second(channels) || groups.second.is_some();
    // what is measured of one mass alone is that of mass x, whatever it is called
    let alone = !second || !axes.has_first(channels, &groups);
    let place = |i: usize, c: &InferredChannel| {
        if alone {
            (false, None)
        } else {
            (true, axes.side(i, c))
        }
    };
    for &role in Role::ALL {
        let best = channels
            .iter()
            .enumerate()
            .filter(|(i, c)| c.role.is_none() && is_signal(c) && !axes.others.contains(i))
            .map(|(i, c)| (score(c, role, place(i, c), &groups), i))
            .filter(|(s, _)| *s > 0)
            .max_by_key(|(s, i)| (*s, std::cmp::Reverse(*i)));
        if let Some((_, index)) = best {
            channels[index].role = Some(role);
        }
    }
    leave_out_beside_rates(channels);
}

/// Accelerations in m/s² beside the angular rate of the same body are of another coordinate.
fn leave_out_beside_rates(channels: &mut [InferredChannel]) {
    let turns = |c: &InferredChannel| {
        matches!(c.role, Some(Role::VelocityX | Role::VelocityY)) && is_rate(c)
    };
    if !channels.iter().any(turns) {
        return;
    }
    for channel in channels {
        let unit = units::unit_of(channel.unit.as_deref(), &channel.name);
        let linear = unit.is_some_and(|u| u.dimension == Dimension::Acceleration);
        if linear && channel.role.is_some_and(Role::is_motion) {
            channel.role = None;
        }
    }
}

/// Part of the way of a mass from which a channel beside it moves too.
pub(super) const MOVES: f64 = 0.02;

/// Whether a channel moves, and shows the quantity that another one shows.
pub(super) fn moves_like(own: &InferredChannel, other: &InferredChannel) -> bool {
    let far = |c: &InferredChannel| {
        let unit = units::unit_of(c.unit.as_deref(), &c.name);
        span(c) * unit.map_or(1.0, |u| u.to_si)
    };
    is_signal(other) && kind(other) == kind(own) && far(other) > MOVES * far(own)
}

/// Whether a channel is another coordinate of a body: by the letters of axes, or by a word.
pub(super) fn is_other_axis(channels: &[InferredChannel], index: usize) -> bool {
    const AXES: [&str; 7] = [
        "horiz",
        "vert",
        "lateral",
        "seit",
        "abs",
        "magnitude",
        "betrag",
    ];
    let named = words(shown(&channels[index]));
    Axes::of(channels).others.contains(&index)
        || named.iter().any(|w| AXES.iter().any(|a| w.starts_with(a)))
}

/// Whether a channel may be a signal: neither the time nor a single number, which is an attribute of its record, nor
/// without any value.
fn is_signal(channel: &InferredChannel) -> bool {
    !channel.is_time && channel.samples > 1 && channel.range.is_some()
}

/// Axes of one sensor, or coordinates of one point: two of them are not two masses.
#[derive(Debug, Default)]
struct Axes {
    /// Those along which less happens than along another.
    others: Vec<usize>,
    /// Of each sensor the one along which most happens, with the mass that it refers to.
    chosen: Vec<(usize, Option<char>)>,
}

impl Axes {
    /// There are three of one name, or two beside neither a drive nor a contact whose names are bare (`x`, `y`) or
    /// those of a phone, that are of an accelerometer, or of which one moves far less.
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
            let all: Vec<usize> = [Some(i), Some(y), z].into_iter().flatten().collect();
            let span = |i: usize| span(&channels[i]);
            let sensor = kind(&channels[i]) == Kind::Acceleration;
            let unlike = span(i).max(span(y)) > UNLIKE * span(i).min(span(y));
            let one = base.is_empty() || phone || sensor || unlike;
            if z.is_none() && (rig || !one) {
                continue;
            }
            let most = all
                .iter()
                .copied()
                .max_by(|a, b| span(*a).total_cmp(&span(*b)))
                .unwrap_or(i);
            axes.others
                .extend(all.into_iter().filter(|axis| *axis != most));
            axes.chosen.push((most, side_of(base)));
        }
        axes.two_masses(channels);
        axes
    }

    /// The mass that a channel refers to: by its name, or as one of two markers.
    fn side(&self, index: usize, channel: &InferredChannel) -> Option<char> {
        match self.chosen.iter().find(|(i, _)| *i == index) {
            Some((_, side)) => *side,
            None => side(shown(channel)),
        }
    }

    /// Two markers, or sensors of one quantity, that move alike are two masses where their names refer to none.
    fn two_masses(&mut self, channels: &[InferredChannel]) {
        let [(first, x @ None), (second, y @ None)] = self.chosen.as_mut_slice() else {
            return;
        };
        let [first, second] = [&channels[*first], &channels[*second]];
        let [one, other] = [span(first), span(second)];
        if kind(first) == kind(second) && one.max(other) <= UNLIKE * one.min(other) {
            (*x, *y) = (Some('x'), Some('y'));
        }
    }

    /// The channels of a motion that are not left out.
    fn moving<'a>(
        &'a self,
        channels: &'a [InferredChannel],
    ) -> impl Iterator<Item = (usize, &'a InferredChannel)> {
        let all = channels.iter().enumerate();
        let used = all.filter(|(i, c)| is_signal(c) && !self.others.contains(i));
        used.filter(|(_, c)| kind(c).is_motion() || kind(c) == Kind::Frame)
    }

    /// Whether any name refers to the second mass.
    fn has_second(&self, channels: &[InferredChannel]) -> bool {
        self.moving(channels)
            .any(|(i, c)| self.side(i, c) == Some('y'))
    }

    /// Whether a motion is measured of a mass that is not the second.
    fn has_first(&self, channels: &[InferredChannel], groups: &Groups) -> bool {
        groups.second.is_some()
            || self
                .moving(channels)
                .any(|(i, c)| self.side(i, c) != Some('y'))
    }
}

/// How far a channel goes.
fn span(channel: &InferredChannel) -> f64 {
    channel.range.map_or(0.0, |[low, high]| high - low)
}

/// How many times farther one of two masses moves at most.
const UNLIKE: f64 = 4.0;

/// Words by which phones name their sensors.
const PHONES: [&str; 4] = ["linear", "gyroscope", "accelerometer", "magnetometer"];

/// A name as the words that say what was measured, and the letter of an axis at its end or before the quantity:
/// `Velocity X`, `X Velocity`.
fn axis(channel: &InferredChannel) -> Option<(Vec<String>, char)> {
    let own = Role::ALL.iter().any(|role| role.name() == channel.name);
    let mut words = words(without_unit(shown(channel)));
    if let [.., letter, quantity] = words.as_slice()
        && QUANTITIES.contains(&quantity.as_str())
        && ["x", "y", "z"].contains(&letter.as_str())
    {
        let last = words.len() - 1;
        words.swap(last - 1, last);
    }
    let last = words.pop().filter(|_| !own)?;
    let letter = last.chars().last().filter(|c| "xyz".contains(*c))?;
    let quantity = &last[..last.len() - 1];
    if !quantity.is_empty() {
        // ax, vy, accz, gx of a gyroscope
        let short = ["a", "v", "w", "g", "gf", "acc", "accel", "gyr", "gyro"].contains(&quantity);
        // accelerometerAccelerationX, gyroRotationX
        let long = ["acceleration", "rotation", "rate"]
            .iter()
            .any(|word| quantity.ends_with(word));
        (short || long).then_some(())?;
        words.push(quantity.to_owned());
    }
    Some((words, letter))
}

/// A name without the unit of a motion at its end: `ax_g`, `gy_dps`.
fn without_unit(name: &str) -> &str {
    let (bare, unit) = units::split_unit(name);
    let of_motion = |unit: units::Unit| {
        matches!(
            unit.dimension,
            Dimension::Length
                | Dimension::Velocity
                | Dimension::Acceleration
                | Dimension::Angle
                | Dimension::Frequency
        )
    };
    // a capital letter by which loggers mean gravity
    let known = unit.map(|symbol| if symbol == "G" { "g" } else { symbol });
    let known = known.and_then(units::parse_split_unit);
    if known.is_some_and(of_motion) {
        bare
    } else {
        name
    }
}

/// The words of a name, lower case.
pub(super) fn words(name: &str) -> Vec<String> {
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

/// The number behind the word of a quantity, a sensor or a body, `vel1`, `mass2`; else the word.
fn numbered(word: &str) -> &str {
    const NUMBERED: [&str; 14] = [
        "x", "v", "s", "a", "d", "vel", "disp", "pos", "acc", "laser", "ldv", "mass", "masse",
        "cart",
    ];
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    if letters.len() < word.len() && NUMBERED.contains(&letters) {
        &word[letters.len()..]
    } else {
        word
    }
}

fn side_of(words: &[String]) -> Option<char> {
    let of = |word: &str| match numbered(word) {
        "x" | "1" | "left" | "links" | "a" | "vx" | "ax" | "dx" => Some('x'),
        "y" | "2" | "right" | "rechts" | "b" | "vy" | "ay" | "dy" => Some('y'),
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

/// Symbols of units of angular rates.
const RATES: [&str; 6] = ["rad/s", "rad_s", "deg/s", "deg_s", "°/s", "dps"];

/// Whether a channel is an angular rate: by its unit, or without one by its name.
fn is_rate(channel: &InferredChannel) -> bool {
    let words = words(shown(channel));
    let any = |stems: &[&str]| words.iter().any(|w| stems.iter().any(|s| w.starts_with(s)));
    let (_, in_name) = units::split_unit(&channel.name);
    match channel.unit.as_deref().or(in_name) {
        Some(unit) => RATES.contains(&unit.trim()),
        None => {
            any(&["gyro", "omega", "angularvel", "winkelgeschw", "drehrate"])
                || (any(&["angular"]) && any(&["vel", "rate", "speed"]))
        }
    }
}

/// Words by which phones name accelerations.
const ACCELERATIONS: [&str; 6] = ["ax", "ay", "az", "gfx", "gfy", "gfz"];
/// Those in multiples of gravity.
const G_FORCES: [&str; 3] = ["gfx", "gfy", "gfz"];

/// The unit that a channel's name implies where none is stated.
pub fn implied_unit(channel: &InferredChannel) -> Option<&'static str> {
    let is_g_force = || matches!(&words(shown(channel))[..], [word] if G_FORCES.contains(&&**word));
    let (_, in_name) = units::split_unit(&channel.name);
    let in_gravity = || {
        let stated = channel.unit.as_deref().or(in_name);
        stated == Some("G") && kind(channel) == Kind::Acceleration
    };
    if is_rate(channel) {
        Some("rad/s")
    } else {
        (is_g_force() || in_gravity()).then_some("g")
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

impl Kind {
    fn is_motion(self) -> bool {
        matches!(
            self,
            Self::Velocity | Self::Displacement | Self::Acceleration
        )
    }
}

/// Most changes of a trigger in a record: to its other level, and back.
const OF_TRIGGER: usize = 2;

/// Stems of the names of forces, whatever their unit: a plate in V.
const FORCES: [&str; 5] = ["force", "kraft", "load", "plate", "platte"];

/// Whether a channel is a contact, or a force that may be one's.
pub(super) fn is_touched(channel: &InferredChannel) -> bool {
    let unit = units::unit_of(channel.unit.as_deref(), &channel.name);
    let name = channel.name.to_lowercase();
    let named = FORCES.iter().any(|word| name.contains(word));
    let force = named || unit.is_some_and(|u| u.dimension == Dimension::Force);
    kind(channel) == Kind::Contact || (force && kind(channel) == Kind::Drive)
}

/// Channels that neither names, units nor shapes give a role, of which another such one has the same unit and goes as far.
pub(super) fn alike_without_role(channels: &[InferredChannel]) -> Vec<usize> {
    let free =
        |c: &InferredChannel| c.role.is_none() && is_unknown(c) && is_signal(c) && span(c) > 0.0;
    let alike = |a: &InferredChannel, b: &InferredChannel| {
        a.unit == b.unit && span(a).max(span(b)) <= UNLIKE * span(a).min(span(b))
    };
    let has_other = |(i, c): &(usize, &InferredChannel)| {
        let mut others = channels.iter().enumerate();
        free(c) && others.any(|(j, other)| j != *i && free(other) && alike(c, other))
    };
    let each = channels.iter().enumerate();
    each.filter(has_other).map(|(i, _)| i).collect()
}

/// Whether neither name, unit nor shape shows what a channel measures.
pub(super) fn is_unknown(channel: &InferredChannel) -> bool {
    kind(channel) == Kind::Unknown
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
        // of a further clock, whatever sensor it is named after
        Some(Dimension::Time) => return Kind::Unknown,
        _ if is_rate(channel) => return Kind::Velocity,
        Some(Dimension::Force) => return Kind::Drive,
        _ => {}
    }
    const DRIVES: [&str; 11] = [
        "drive", "gen", "exc", "hammer", "force", "load", "input", "shaker", "erreg", "anreg",
        "kraft",
    ];
    const VELOCITIES: [&str; 9] = [
        "vel", "speed", "laser", "ldv", "vib", "vx", "vy", "geschw", "schnelle",
    ];
    const DISPLACEMENTS: [&str; 9] = [
        "disp", "pos", "dx", "dy", "angle", "winkel", "weg", "auslenk", "encoder",
    ];
    match () {
        () if has(&DRIVES) => Kind::Drive,
        () if has(&VELOCITIES) => Kind::Velocity,
        () if is_symbol_of_velocity(shown(channel), &words) => Kind::Velocity,
        () if has(&DISPLACEMENTS) => Kind::Displacement,
        () if has(&["acc", "beschl"]) || words.iter().any(|w| ACCELERATIONS.contains(&&**w)) => {
            Kind::Acceleration
        }
        () if channel.levels.is_some() && channel.changes > OF_TRIGGER => Kind::Contact,
        // a coordinate, in pixels too
        () if unit.is_none() && is_coordinate(channel, &words) => Kind::Displacement,
        () => Kind::Unknown,
    }
}

/// Whether a channel is called `v1`, `v_x` or, beside the side of a mass, `v`: a small letter, as `V` are volts.
fn is_symbol_of_velocity(name: &str, words: &[String]) -> bool {
    let mut written = name.split(|c: char| !c.is_alphanumeric());
    let symbol = written.any(|word| ["v", "v1", "v2"].contains(&word));
    symbol && side_of(words).is_some()
}

/// Whether a channel is called `x`, `y`, `x1` …, without a unit or in pixels.
fn is_coordinate(channel: &InferredChannel, words: &[String]) -> bool {
    let pixels = channel
        .unit
        .as_deref()
        .is_none_or(|u| ["px", "pixel", "pixels"].contains(&u));
    let Some((word, before)) = words.split_last() else {
        return false;
    };
    let letter = word.trim_end_matches(|c: char| c.is_ascii_digit());
    // of a named marker in pixels
    let of_marker = before.is_empty() || channel.unit.is_some();
    pixels && of_marker && ["x", "y", "z"].contains(&letter)
}

/// Channels named alike but for what they measure: "Blue Position", "Blue Velocity", "Red Position" ….
/// Two such groups that move are the two masses, and a force among them is one that the mass carries.
#[derive(Debug, Default)]
struct Groups {
    first: Option<String>,
    second: Option<String>,
    /// All groups with a motion, also one at rest.
    all: Vec<String>,
    /// Whether all motions are of one quantity along one axis, so that its letter tells no more than a quantity does: "cart A x", "cart B x".
    of_one_axis: bool,
}

impl Groups {
    fn of(channels: &[InferredChannel], axes: &Axes) -> Self {
        let mut names: Vec<String> = Vec::new();
        let alive = |c: &InferredChannel| c.range.is_some_and(|[low, high]| high > low);
        let moves = |c: &&InferredChannel| matches!(kind(c), Kind::Velocity | Kind::Displacement);
        let moving = || channels.iter().filter(moves);
        // of one quantity: a velocity and a displacement may be of one mass
        let mut along = moving().filter_map(|c| Some((axis(c)?.1, kind(c))));
        let first = along.next();
        let mut groups = Self {
            of_one_axis: first.is_some() && along.all(|other| Some(other) == first),
            ..Self::default()
        };
        groups.all = moving().filter_map(|c| groups.of_channel(c)).collect();
        let used = axes.moving(channels).map(|(_, c)| c);
        for channel in used.filter(moves).filter(|c| alive(c)) {
            let Some(group) = groups.of_channel(channel) else {
                continue;
            };
            if !names.contains(&group) {
                names.push(group);
            }
        }
        let mut names = names.into_iter();
        if let (first, second, None) = (names.next(), names.next(), names.next()) {
            (groups.first, groups.second) = (first, second);
        }
        groups
    }

    /// The group of a channel: what comes before its quantity, or before the axis that all motions are along.
    fn of_channel(&self, channel: &InferredChannel) -> Option<String> {
        let by_axis = || {
            let (base, _) = axis(channel).filter(|_| self.of_one_axis)?;
            (!base.is_empty()).then(|| base.join(" "))
        };
        group(&channel.name).or_else(by_axis)
    }

    /// The mass that a channel's group is; `None` unless there are two.
    fn side(&self, channel: &InferredChannel) -> Option<char> {
        let second = self.second.as_ref()?;
        let group = self.of_channel(channel)?;
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

/// Words for what is measured of a motion.
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

/// What comes before the quantity in a name, or the colour behind it: "blue" of "Blue:Acceleration - x".
fn group(name: &str) -> Option<String> {
    let words = words(name);
    let at = words
        .iter()
        .position(|w| QUANTITIES.contains(&w.as_str()))?;
    let behind = || words.get(at + 1).filter(|w| COLOURS.contains(&w.as_str()));
    match at {
        0 => behind().cloned(),
        _ => Some(words[..at].join(" ")),
    }
}

/// By what carts and their sensors are told apart, also behind the quantity: `Position, Red`.
const COLOURS: [&str; 12] = [
    "red", "blue", "green", "yellow", "orange", "purple", "black", "white", "grey", "gray", "rot",
    "blau",
];
