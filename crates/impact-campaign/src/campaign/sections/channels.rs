//! `[channels]` as written to channel set-ups.

use serde::Deserialize;
use toml::Spanned;

use crate::campaign::context::{ResolveContext, remedy};
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::resolved::RecordEntry;
use crate::campaign::values::{Flight, Machine, Placed, WrittenKey, WrittenQuantity, value};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup};
use impact_records::record::{ContactContent, LowPass, Role};
use labfiles::units::{self, Dimension, Scale, Unit};

keys! {
    /// `[channels.<role>]`.
    #[serde(default)]
    pub struct ChannelTable {
        /// its name in the file, with or without its unit (`Position (m) Run #1` and `Position Run #1` are the same),
        /// also without its run where only one channel is called so, the label of its signal, or its index from 0;
        /// required
        channel: Placed<WrittenKey>;
        /// of the numbers in the file; required if the file states none
        unit: Placed<String>;
        /// from the unit of the numbers to the quantity: `"50 mm/s per V"`, `"0.05 m/s/V"`, a sensor's sensitivity
        /// `"100 mV/g"`, or a plain factor
        scale: Placed<WrittenQuantity>;
        /// value at rest, in the unit of the file
        offset: Placed<WrittenQuantity>;
        /// 1, or -1 if the sensor is positive away from the other mass
        sign: Placed<f64>;
        /// corner of the first-order high-pass in the signal: of an integrator or an AC coupling; `"0 Hz"`: none
        high_pass: Placed<WrittenQuantity>;
        /// corner of the low-pass that the signal has passed: of an anti-alias filter, a vibrometer, an amplifier;
        /// `"0 Hz"`: none. The model is filtered, values near impacts are left out until the filter has settled, and
        /// the speeds at impacts are not used
        low_pass: Placed<WrittenQuantity>;
        /// number of its poles, 1 to 8 (Butterworth); 2 if not given
        low_pass_order: Placed<u32>;
        /// of the channel relative to the drive channel, less than a period; 0 if not given
        delay: Placed<WrittenQuantity>;
        /// standard uncertainty of the delay; half a sample if not given
        delay_uncertainty: Placed<WrittenQuantity>;
        /// of the contact: the level between open and closed
        threshold: Placed<WrittenQuantity>;
        /// of the contact: `"signal"` (default); `"times"` or `"intervals"` of impacts, one in each row or, with `then`,
        /// along each row, which is then a throw of its own; or of changes of the contact, closed, open, closed …, with or
        /// without a column of its state; `"sound"` of a microphone. R
        /// then follows from the flight times, under `flight = "constant_force"`; or `"heights"` of a drop and of the tops
        /// after it, below each other or, with `then`, along each row; `"rebounds"`: each of `then` is one of the drop from
        /// `channel`
        content: Placed<ContactContent>;
        /// of times, intervals and heights: the columns that follow in the same row, `["rebound"]`
        then: Placed<Vec<WrittenKey>>;
        /// of heights: standard uncertainty of each, `"2 mm"`; by their scatter, and at least their last digit, if not given
        height_uncertainty: Placed<WrittenQuantity>;
        /// full scale of the converter; samples there are clipped. Of an acceleration, spikes at impacts may be, and
        /// equal greatest values show it without this key
        range: Placed<WrittenQuantity>;
        /// `true` if the file states a wrong unit
        ignore_file_unit: Placed<bool>;
        /// what recorded it, as text: sensor, amplifier, serial number; in `impactid compare` campaigns with the same
        /// text share the errors of the channel's gain and corner, as long as `scale`, `unit` and `high_pass` are the
        /// same
        instrument: Placed<String>;
    }
}

/// `[channels]`: one table a role.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs, reason = "the roles are documented at `record::Role`")]
pub struct ChannelTables {
    pub drive: Placed<ChannelTable>,
    pub contact: Placed<ChannelTable>,
    pub velocity_x: Placed<ChannelTable>,
    pub velocity_y: Placed<ChannelTable>,
    pub displacement_x: Placed<ChannelTable>,
    pub displacement_y: Placed<ChannelTable>,
    pub acceleration_x: Placed<ChannelTable>,
    pub acceleration_y: Placed<ChannelTable>,
    pub frame_x: Placed<ChannelTable>,
    pub frame_y: Placed<ChannelTable>,
}

impl ChannelTables {
    pub(crate) fn of(&self, role: Role) -> &Placed<ChannelTable> {
        match role {
            Role::Drive => &self.drive,
            Role::Contact => &self.contact,
            Role::VelocityX => &self.velocity_x,
            Role::VelocityY => &self.velocity_y,
            Role::DisplacementX => &self.displacement_x,
            Role::DisplacementY => &self.displacement_y,
            Role::AccelerationX => &self.acceleration_x,
            Role::AccelerationY => &self.acceleration_y,
            Role::FrameX => &self.frame_x,
            Role::FrameY => &self.frame_y,
        }
    }
}

/// All channels that campaign.toml names, in the order of the roles.
pub(crate) fn resolve(
    channels: &ChannelTables,
    (machine, flight): (Machine, Flight),
    context: &mut ResolveContext<'_>,
) -> Vec<ChannelSetup> {
    let mut setups = Vec::new();
    for &role in Role::ALL {
        let Some(placed) = channels.of(role) else {
            continue;
        };
        if machine == Machine::Single && role.is_on_y_side() {
            context.fault(
                Code::Conflict,
                placed,
                &format!("channels.{}", role.name()),
                "one mass against a stop has no mass y".to_owned(),
                "remove the table, or set machine = \"double\"",
            );
            continue;
        }
        setups.extend(resolve_one(role, placed, context));
    }
    demand_motion(&setups, flight, context);
    refuse_driven_events(&setups, flight, channels, context);
    refuse_twice(&setups, channels, context);
    setups
}

/// Times of impacts give R under a constant force alone.
fn refuse_driven_events(
    setups: &[ChannelSetup],
    flight: Flight,
    channels: &ChannelTables,
    context: &mut ResolveContext<'_>,
) {
    let events = setups.iter().any(|s| s.content != ContactContent::Signal);
    let placed = channels
        .contact
        .as_ref()
        .and_then(|c| c.get_ref().content.as_ref());
    if let (true, Flight::Harmonic, Some(placed)) = (events, flight, placed) {
        context.fault(
            Code::Conflict,
            placed,
            "channels.contact.content",
            "times of impacts alone tell nothing of a driven rig".to_owned(),
            "set flight = \"constant_force\" for a ball or cart that bounces, or name the contact's signal",
        );
    }
}

fn demand_motion(setups: &[ChannelSetup], flight: Flight, context: &mut ResolveContext<'_>) {
    let motion = setups.iter().any(|s| s.role.is_motion());
    let timed = flight == Flight::ConstantForce && setups.iter().any(|s| s.role == Role::Contact);
    if motion || timed {
        return;
    }
    context.faults.fault(
        Code::Missing,
        None,
        "channels",
        "no channel of motion is named".to_owned(),
        "add at least one of [channels.velocity_x], [channels.displacement_x] and \
         [channels.acceleration_x], with its scale where it is a signal in V, as of a strain gauge; times of \
         impacts are [channels.contact] with content = \"times\" under flight = \"constant_force\"",
    );
}

fn refuse_twice(
    setups: &[ChannelSetup],
    channels: &ChannelTables,
    context: &mut ResolveContext<'_>,
) {
    for (i, one) in setups.iter().enumerate() {
        let Some(other) = setups[..i].iter().find(|o| o.source == one.source) else {
            continue;
        };
        let Some(placed) = channels.of(one.role) else {
            continue;
        };
        context.fault(
            Code::Conflict,
            placed,
            &format!("channels.{}.channel", one.role.name()),
            format!(
                "channel '{}' already serves as {}",
                one.source.text(),
                other.role.name()
            ),
            "name a channel of its own for each role",
        );
    }
}

fn resolve_one(
    role: Role,
    placed: &Spanned<ChannelTable>,
    context: &mut ResolveContext<'_>,
) -> Option<ChannelSetup> {
    let written = placed.get_ref();
    let key = |name: &str| format!("channels.{}.{name}", role.name());
    let unit = unit(&written.unit, &key("unit"), context);
    let scale = scale(&written.scale, &key("scale"), context);
    let setup = ChannelSetup {
        unit,
        scale: scale.unwrap_or(Scale::Factor(1.0)),
        offset: raw_level(&written.offset, &key("offset"), unit, context).unwrap_or(0.0),
        sign: sign(&written.sign, &key("sign"), context),
        high_pass_hz: high_pass(&written.high_pass, &key("high_pass"), context),
        low_pass: low_pass(written, &key, context),
        delay_s: context
            .within(&written.delay, &key("delay"), Dimension::Time, [-1.0, 1.0])
            .unwrap_or(0.0),
        delay_uncertainty_s: context.within(
            &written.delay_uncertainty,
            &key("delay_uncertainty"),
            Dimension::Time,
            [0.0, 1.0],
        ),
        threshold: threshold(role, &written.threshold, &key("threshold"), context),
        range: raw_level(&written.range, &key("range"), unit, context),
        ignore_file_unit: value(&written.ignore_file_unit).unwrap_or(false),
        content: of_contact(
            role,
            &written.content,
            "a content",
            &key("content"),
            context,
        )
        .map_or(ContactContent::Signal, |placed| *placed.get_ref()),
        then: then(role, written, &key, context),
        height_uncertainty_m: context.within(
            &written.height_uncertainty,
            &key("height_uncertainty"),
            Dimension::Length,
            [1e-6, 1.0],
        ),
        instrument: value(&written.instrument),
        ..ChannelSetup::plain(role, source(role, placed, context)?)
    };
    Some(setup)
}

/// The columns that follow in the same row of a list; the content says what they are for.
fn then(
    role: Role,
    written: &ChannelTable,
    key: &dyn Fn(&str) -> String,
    context: &mut ResolveContext<'_>,
) -> Vec<ChannelKey> {
    let content = value(&written.content).unwrap_or_default();
    if content == ContactContent::Rebounds
        && written.then.is_none()
        && let Some(placed) = &written.content
    {
        let what = "no column of rebounds is named".to_owned();
        let remedy =
            "name the columns of the rebounds as then, and that of the drop's height as channel";
        context.fault(Code::Missing, placed, &key("then"), what, remedy);
    }
    let uncertain = written.height_uncertainty.as_ref().map(Spanned::span);
    if let (Some(span), false) = (uncertain, content.is_of_heights()) {
        let placed = Spanned::new(span, ());
        let what = "height_uncertainty is that of heights".to_owned();
        let remedy = "write content = \"heights\" or \"rebounds\", or remove it";
        context.fault(
            Code::Conflict,
            &placed,
            &key("height_uncertainty"),
            what,
            remedy,
        );
    }
    let named = written.then.as_ref().map(Spanned::span);
    if let (Some(span), false) = (named, content.is_list()) {
        let placed = Spanned::new(span, ());
        let what = "then continues the rows of a list".to_owned();
        let remedy =
            "write content = \"times\", \"intervals\", \"heights\" or \"rebounds\", or remove it";
        context.fault(Code::Conflict, &placed, &key("then"), what, remedy);
    }
    let placed = of_contact(role, &written.then, "then", &key("then"), context);
    let keys = placed.map(|placed| placed.get_ref().iter().map(|k| k.0.clone()));
    keys.map(Iterator::collect).unwrap_or_default()
}

fn source(
    role: Role,
    placed: &Spanned<ChannelTable>,
    context: &mut ResolveContext<'_>,
) -> Option<ChannelKey> {
    let key = format!("channels.{}.channel", role.name());
    let Some(channel) = &placed.get_ref().channel else {
        context.fault(
            Code::Missing,
            placed,
            &key,
            "the channel of the file is not given".to_owned(),
            "write channel = \"name\" or its index from 0",
        );
        return None;
    };
    Some(channel.get_ref().0.clone())
}

/// Poles of a low-pass whose order is not stated.
const USUAL_ORDER: u32 = 2;
/// Most poles of a low-pass.
const MOST_POLES: u32 = 8;

/// The low-pass; at 0 Hz there is none.
fn low_pass(
    written: &ChannelTable,
    key: &dyn Fn(&str) -> String,
    context: &mut ResolveContext<'_>,
) -> Option<LowPass> {
    let corner_hz = high_pass(&written.low_pass, &key("low_pass"), context);
    let order = value(&written.low_pass_order);
    let placed = written.low_pass_order.as_ref();
    let wrong = match (order, corner_hz) {
        (Some(order), _) if !(1..=MOST_POLES).contains(&order) => Some((
            format!("a low-pass has no {order} poles"),
            "write a number from 1 to 8",
        )),
        (Some(_), None) if written.low_pass.is_none() => Some((
            "an order is stated, and no low_pass".to_owned(),
            "write low_pass = \"200 Hz\", the corner, beside it, or remove the line",
        )),
        _ => None,
    };
    if let Some(((message, remedy), placed)) = wrong.zip(placed) {
        let key = key("low_pass_order");
        context.fault(Code::OutOfRange, placed, &key, message, remedy);
        return None;
    }
    corner_hz.map(|corner_hz| LowPass {
        corner_hz,
        order: order.unwrap_or(USUAL_ORDER),
    })
}

/// The corner of a high-pass; at 0 Hz there is none.
fn high_pass(
    placed: &Placed<WrittenQuantity>,
    key: &str,
    context: &mut ResolveContext<'_>,
) -> Option<f64> {
    let corner = context.within(placed, key, Dimension::Frequency, [0.0, f64::INFINITY]);
    corner.filter(|hz| *hz > 0.0)
}

fn unit(placed: &Placed<String>, key: &str, context: &mut ResolveContext<'_>) -> Option<Unit> {
    let placed = placed.as_ref()?;
    let symbol = placed.get_ref();
    let found = units::parse_unit(symbol);
    if found.is_none() {
        let what = format!("the unit '{symbol}' is not known");
        context.fault(
            Code::InvalidValue,
            placed,
            key,
            what,
            "write V, mV, m, mm, m/s, mm/s, m/s2, g, N or another SI unit",
        );
    }
    found
}

fn scale(
    placed: &Placed<WrittenQuantity>,
    key: &str,
    context: &mut ResolveContext<'_>,
) -> Option<Scale> {
    let placed = placed.as_ref()?;
    let scale = match placed.get_ref() {
        WrittenQuantity::Bare(factor) => Ok(Scale::Factor(*factor)),
        WrittenQuantity::Text(text) => units::parse_scale(text),
    };
    match scale {
        Ok(scale) if size(scale) > 0.0 => Some(scale),
        Ok(_) => {
            let what = "a scale must be positive and finite".to_owned();
            context.fault(
                Code::OutOfRange,
                placed,
                key,
                what,
                "write its magnitude, and the sign as sign = -1",
            );
            None
        }
        Err(error) => {
            let remedy = match error {
                units::QuantityError::UnknownUnit(_) => {
                    "write one unit per another, such as \"50 mm/s per V\"".to_owned()
                }
                _ => remedy(&error, Dimension::Number),
            };
            context.fault(Code::InvalidValue, placed, key, error.to_string(), &remedy);
            None
        }
    }
}

fn size(scale: Scale) -> f64 {
    let value = match scale {
        Scale::Factor(factor) => factor,
        Scale::Ratio { numerator, .. } => numerator.si,
    };
    if value.is_finite() { value } else { 0.0 }
}

fn sign(placed: &Placed<f64>, key: &str, context: &mut ResolveContext<'_>) -> f64 {
    match placed {
        Some(placed) if placed.get_ref().abs() == 1.0 => *placed.get_ref(),
        Some(placed) => {
            let what = format!("a sign is 1 or -1, not {}", placed.get_ref());
            context.fault(
                Code::InvalidValue,
                placed,
                key,
                what,
                "put a factor into scale",
            );
            1.0
        }
        None => 1.0,
    }
}

/// A level in the file's unit, SI.
fn raw_level(
    placed: &Placed<WrittenQuantity>,
    key: &str,
    unit: Option<Unit>,
    context: &mut ResolveContext<'_>,
) -> Option<f64> {
    let found = any_quantity(placed, key, context)?;
    match unit {
        Some(unit) if unit.dimension != found.dimension => {
            let what = format!(
                "it is {}, the channel's unit {}",
                found.dimension.with_article(),
                unit.dimension.with_article()
            );
            if let Some(placed) = placed {
                context.fault(
                    Code::InvalidValue,
                    placed,
                    key,
                    what,
                    "give it in the unit of the numbers in the file",
                );
            }
            None
        }
        _ => Some(found.si),
    }
}

fn any_quantity(
    placed: &Placed<WrittenQuantity>,
    key: &str,
    context: &mut ResolveContext<'_>,
) -> Option<units::Quantity> {
    let placed = placed.as_ref()?;
    let found = match placed.get_ref() {
        WrittenQuantity::Text(text) => units::parse_quantity(text).map_err(|e| e.to_string()),
        WrittenQuantity::Bare(value) => Err(format!("a level without unit: {value}")),
    };
    if let Err(message) = &found {
        let remedy = "write number and unit in quotes, such as \"2.5 V\"";
        context.fault(Code::InvalidValue, placed, key, message.as_str(), remedy);
    }
    found.ok()
}

fn threshold(
    role: Role,
    placed: &Placed<WrittenQuantity>,
    key: &str,
    context: &mut ResolveContext<'_>,
) -> Option<units::Quantity> {
    let found = any_quantity(placed, key, context)?;
    of_contact(role, placed, "a threshold", key, context).map(|_| found)
}

/// What is stated of a contact; a fault where it is stated of another channel.
fn of_contact<'a, T>(
    role: Role,
    placed: &'a Placed<T>,
    what: &str,
    key: &str,
    context: &mut ResolveContext<'_>,
) -> Option<&'a Spanned<T>> {
    let placed = placed.as_ref()?;
    if role == Role::Contact {
        return Some(placed);
    }
    let what = format!("{what} means nothing for {}", role.name());
    let remedy = "move it to [channels.contact]";
    context.fault(Code::Conflict, placed, key, what, remedy);
    None
}

/// The delay of a channel must be less than a period of the drive.
pub(crate) fn refuse_long_delays(
    channels: &[ChannelSetup],
    records: &[RecordEntry],
    written: &ChannelTables,
    context: &mut ResolveContext<'_>,
) {
    let stated = records.iter().filter_map(|r| r.setting.stated_frequency_hz);
    let fastest = stated.fold(0.0, f64::max);
    for channel in channels.iter().filter(|c| c.delay_s.abs() * fastest >= 1.0) {
        let Some(placed) = written.of(channel.role) else {
            continue;
        };
        let what = format!(
            "{:.4} s is longer than a period of the drive at {fastest} Hz",
            channel.delay_s
        );
        context.fault(
            Code::OutOfRange,
            placed,
            &format!("channels.{}.delay", channel.role.name()),
            what,
            "state the delay against the drive's channel, with its unit",
        );
    }
}
