//! What names, units and values state of time: which column holds it, and in which unit.

use crate::source::{ChannelInfo, Clock, StoredType};
use crate::units::{Dimension, Unit, parse_quantity_of, parse_unit, symbol_of};

/// First words of the names of time axes, lower case.
const FIRST_WORDS: [&str; 9] = [
    "t", "tout", "zeit", "temps", "tempo", "tiempo", "čas", "cas", "date",
];

/// Words that make a name that of a time axis wherever they stand.
const WORDS: [&str; 12] = [
    "time",
    "datetime",
    "elapsed",
    "stamp",
    "ts",
    "uptime",
    "zeit",
    "timestamp",
    "zeitstempel",
    "epoch",
    "unix",
    "datenum",
];

/// Words of time stamps that count from 1970.
const EPOCHS: [&str; 5] = ["timestamp", "zeitstempel", "epoch", "unix", "posix"];

/// How units below a second begin in the languages that laboratories write, and their lengths in s.
const FRACTIONS: [(&str, f64); 8] = [
    ("milli", 1e-3),
    ("mili", 1e-3),
    ("милли", 1e-3),
    ("micro", 1e-6),
    ("mikro", 1e-6),
    ("микро", 1e-6),
    ("nano", 1e-9),
    ("нано", 1e-9),
];

/// How `second` begins in them.
const SECOND: [&str; 5] = ["sec", "sek", "seg", "san", "сек"];

/// Short forms of units below a second.
const SHORT: [(&str, f64); 8] = [
    ("msecs", 1e-3),
    ("msec", 1e-3),
    ("msek", 1e-3),
    ("мс", 1e-3),
    ("usecs", 1e-6),
    ("usec", 1e-6),
    ("мкс", 1e-6),
    ("nsec", 1e-9),
];

/// Units of a second and longer, spelled out; the first of them name a time axis by themselves.
const LONG: [(&str, f64); 53] = [
    ("seconds", 1.0),
    ("second", 1.0),
    ("secs", 1.0),
    ("sec", 1.0),
    ("sekunden", 1.0),
    ("secondes", 1.0),
    ("segundos", 1.0),
    ("secondi", 1.0),
    ("sekundy", 1.0),
    ("sekunder", 1.0),
    ("секунды", 1.0),
    ("sekunde", 1.0),
    ("sekunda", 1.0),
    ("sekund", 1.0),
    ("seconde", 1.0),
    ("seconden", 1.0),
    ("secondo", 1.0),
    ("segundo", 1.0),
    ("secunde", 1.0),
    ("sekuntia", 1.0),
    ("sekuntti", 1.0),
    ("saniye", 1.0),
    ("másodperc", 1.0),
    ("секунда", 1.0),
    ("секунд", 1.0),
    ("сек", 1.0),
    ("с", 1.0),
    ("minutes", 60.0),
    ("minuten", 60.0),
    ("minutos", 60.0),
    ("minuti", 60.0),
    ("minuty", 60.0),
    ("minuta", 60.0),
    ("minuto", 60.0),
    ("minuter", 60.0),
    ("минуты", 60.0),
    ("мин", 60.0),
    ("min", 60.0),
    ("minute", 60.0),
    ("mins", 60.0),
    ("hours", 3600.0),
    ("hour", 3600.0),
    ("hrs", 3600.0),
    ("hr", 3600.0),
    ("stunde", 3600.0),
    ("stunden", 3600.0),
    ("heures", 3600.0),
    ("heure", 3600.0),
    ("hora", 3600.0),
    ("hodina", 3600.0),
    ("horas", 3600.0),
    ("hodiny", 3600.0),
    ("h", 3600.0),
];

/// Those that name a time axis by themselves.
const SECONDS: usize = 25;

/// Symbols of units below and at a second.
const SYMBOLS: [(&str, f64); 6] = [
    ("s", 1.0),
    ("ms", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("μs", 1e-6),
    ("ns", 1e-9),
];

fn of_time(to_si: f64) -> Unit {
    Unit {
        dimension: Dimension::Time,
        to_si,
    }
}

fn in_table(table: &[(&str, f64)], word: &str) -> Option<Unit> {
    let found = table.iter().find(|(name, _)| *name == word);
    found.map(|(_, to_si)| of_time(*to_si))
}

/// The unit below a second that a word in lower case spells out: `millis`, `Millisekunden`, `milisegundos`, `msec`.
fn spelled(word: &str) -> Option<Unit> {
    let of = |(begin, to_si): &(&str, f64)| {
        let rest = word.strip_prefix(begin)?;
        let second = rest == "s" || SECOND.iter().any(|s| rest.starts_with(s));
        second.then(|| of_time(*to_si))
    };
    FRACTIONS
        .iter()
        .find_map(of)
        .or_else(|| in_table(&SHORT, word))
}

/// The words of a name in lower case, also those of `timeMs`.
fn whole_words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut lower = false;
    for letter in name.chars() {
        if !letter.is_alphanumeric() || (lower && letter.is_uppercase()) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| letter.is_alphanumeric()) {
            word.extend(letter.to_lowercase());
        }
        lower = letter.is_lowercase();
    }
    words.retain(|w| !w.is_empty());
    words
}

/// The words of a name with digits at their ends cut off.
fn words(name: &str) -> Vec<String> {
    let bare = |word: String| match without_digits(&word) {
        // t1 is a temperature as well
        short if short.len() > 1 => short.to_owned(),
        _ => word,
    };
    whole_words(name).into_iter().map(bare).collect()
}

fn without_digits(word: &str) -> &str {
    word.trim_end_matches(|c: char| c.is_ascii_digit())
}

/// Whether a name is that of a time axis: `t`, `Time (Run 1)`, `Zeit`, `timestamp`, `millis`, `t_us`, `in s` ….
pub fn is_time_name(name: &str) -> bool {
    let words = words(name);
    let Some(first) = words.first() else {
        return false;
    };
    let known =
        |w: &String| WORDS.contains(&w.as_str()) || spelled(w).is_some() || glued(w).is_some();
    let alone = words.len() == 1
        && (in_table(&LONG[..SECONDS], first).is_some()
            || ["ms", "us", "µs", "μs"].contains(&first.as_str()));
    let since = words.get(1).is_some_and(|w| w == "since") && unit_of_symbol(first).is_some();
    // a heading of a unit alone
    let bare = first == "in" && words.len() == 2 && unit_of_text(&words[1]).is_some();
    bare || FIRST_WORDS.contains(&first.as_str())
        || is_field_of_time(name)
        || words.iter().any(known)
        || alone
        || since
        || is_x_value(name)
}

/// Whether a name is that of the abscissa in texts of NI, or of a further one that the reader numbers: `X_Value 2`.
fn is_x_value(name: &str) -> bool {
    let bare = without_digits(name.trim()).trim_end();
    bare.eq_ignore_ascii_case("x_value")
}

/// Whether a name is that of a field, or of a channel in a group, that is called as a time alone: `laser.t`.
fn is_field_of_time(name: &str) -> bool {
    let field = name.rsplit_once(['.', '/']).map(|(_, field)| field);
    let whole = !name.contains(char::is_whitespace);
    field.is_some_and(|f| whole && FIRST_WORDS.contains(&f.to_lowercase().as_str()))
}

/// Words that name a column of the numbers of rows.
const NUMBERED: [&str; 15] = [
    "n", "nr", "no", "i", "k", "index", "row", "zeile", "bounce", "hit", "impact", "event",
    "number", "aufprall", "rebond",
];

/// Whether a name is that of a column that numbers the rows: `n`, `#`, `bounce no.` ….
///
/// ```
/// use labfiles::timing::numbers_rows;
/// assert!(["#", "No.", "bounce no.", "Aufprall Nr."].iter().all(|name| numbers_rows(name)));
/// assert!(!["noise", "impact time", ""].iter().any(|name| numbers_rows(name)));
/// ```
pub fn numbers_rows(name: &str) -> bool {
    let words = whole_words(name);
    let numbered = words.iter().all(|w| NUMBERED.contains(&w.as_str()));
    name.trim() == "#" || (!words.is_empty() && numbered)
}

/// `timems`, `tms`: a word of time and a unit below a second in one.
fn glued(word: &str) -> Option<Unit> {
    let unit = ["timestamp", "time", "zeit", "t"]
        .iter()
        .find_map(|time| word.strip_prefix(time))?;
    let short = ["ms", "us", "µs", "μs"].contains(&unit);
    spelled(unit).or_else(|| unit_of_symbol(unit).filter(|_| short))
}

fn unit_of_symbol(word: &str) -> Option<Unit> {
    in_table(&SYMBOLS, word)
}

/// The unit of time that a text such as `ms`, `msec`, `Milliseconds`, `1e-3 s` or `10^-3 s` is.
fn unit_of_text(text: &str) -> Option<Unit> {
    let text = text.trim();
    let known = parse_unit(text).filter(|u| u.dimension == Dimension::Time);
    let lower = text.to_lowercase();
    // milli sec, milli-seconds
    let joined: String = lower.chars().filter(|c| c.is_alphabetic()).collect();
    let power = lower
        .replace("10^", "1e")
        .replace("10⁻³", "1e-3")
        .replace("10⁻⁶", "1e-6");
    known
        .or_else(|| spelled(&lower))
        .or_else(|| spelled(&joined).filter(|_| lower.starts_with(char::is_alphabetic)))
        .or_else(|| in_table(&LONG, &lower))
        .or_else(|| unit_of_symbol(&lower))
        .or_else(|| {
            let scaled = parse_quantity_of(&power, Dimension::Time).ok();
            scaled.filter(|s| *s > 0.0).map(of_time)
        })
}

/// The unit of time in a name: spelled out anywhere (`millis since start`), or its symbol at the end, in
/// brackets or before `since` (`time_ms`, `Time (ms) Run 1`, `tMs`).
fn unit_in_name(name: &str) -> Option<Unit> {
    let in_brackets = name.split(['(', '[', '{', '<']).skip(1);
    let mut in_brackets = in_brackets.filter_map(|rest| rest.split([')', ']', '}', '>']).next());
    if let Some(unit) = in_brackets.find_map(unit_of_text) {
        return Some(unit);
    }
    let words = words(name);
    let joined = || {
        let mut pairs = words.windows(2).map(|w| w.concat());
        pairs.find_map(|w| spelled(&w))
    };
    let fraction = words
        .iter()
        .find_map(|w| spelled(w).or_else(|| glued(w)))
        .or_else(joined);
    let long = || words.iter().find_map(|w| in_table(&LONG, w));
    let last = || {
        words
            .last()
            .filter(|_| words.len() > 1)
            .and_then(|w| unit_of_symbol(w))
    };
    let first = || {
        let since = words.len() == 1 || words.get(1).is_some_and(|w| w == "since");
        let symbol = words.first().filter(|w| since && w.chars().count() > 1);
        symbol.and_then(|w| unit_of_symbol(w))
    };
    fraction.or_else(last).or_else(first).or_else(long)
}

/// Whether a text is a unit of time.
pub(crate) fn is_unit_of_time(text: &str) -> bool {
    unit_of_text(text).is_some()
}

/// What is stated of the unit of a time axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum StatedUnit {
    /// A unit of time.
    Known(Unit),
    /// A unit that is none of time, or unknown.
    Other(String),
    /// None.
    Nothing,
}

/// The unit that a time axis states: as its unit, else in its name.
pub(crate) fn stated_unit(unit: Option<&str>, name: &str) -> StatedUnit {
    match unit.map(str::trim).filter(|u| !u.is_empty()) {
        Some(text) => match unit_of_text(text) {
            Some(unit) => StatedUnit::Known(unit),
            None => StatedUnit::Other(text.to_owned()),
        },
        None => match (unit_in_name(name), unknown_in_name(name)) {
            (Some(unit), _) => StatedUnit::Known(unit),
            (None, Some(text)) => StatedUnit::Other(text),
            (None, None) => StatedUnit::Nothing,
        },
    }
}

/// Words in brackets behind a time that are no units.
const NO_UNITS: [&str; 10] = [
    "rel", "abs", "raw", "utc", "gmt", "sim", "exp", "run", "loc", "num",
];

/// What a name has in brackets as a unit, and is none that is known: `t (jiff)`.
fn unknown_in_name(name: &str) -> Option<String> {
    let text = name
        .split_once(['(', '['])?
        .1
        .split([')', ']'])
        .next()?
        .trim();
    let letters = text.chars().all(char::is_alphabetic);
    let short = (1..=4).contains(&text.chars().count());
    let unit = letters && short && !NO_UNITS.contains(&text.to_lowercase().as_str());
    unit.then(|| text.to_owned())
}

/// The unit of a time axis, as it is stated, or as its values leave it.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisUnit {
    /// As its unit or its name states.
    Stated(Unit),
    /// A time stamp that counts from 1970 in this unit.
    Epoch(Unit),
    /// None is stated: days, as MATLAB's `datenum` and spreadsheets count them.
    Days,
    /// None is stated: seconds.
    Seconds,
    /// None is stated, and the numbers may be of any: the first and the usual step.
    Undetermined {
        /// The first number.
        first: f64,
        /// The usual step from one to the next.
        step: f64,
    },
    /// What is stated is no unit of time.
    Other(String),
}

impl AxisUnit {
    /// Of an axis with its unit, its name and its values.
    ///
    /// ```
    /// use labfiles::timing::AxisUnit;
    /// let seconds = |unit, name, values: &[f64]| AxisUnit::of(unit, name, values).seconds();
    /// assert_eq!(seconds(Some("ms"), "Time", &[0.0, 1.0]), Some(1e-3));
    /// assert_eq!(seconds(None, "elapsed_millis", &[0.0, 1.0]), Some(1e-3));
    /// assert_eq!(seconds(None, "timestamp", &[1_486_512_345_678.0]), Some(1e-3));
    /// assert_eq!(seconds(None, "ts", &[1.732_651_2e18, 1.732_651_201e18]), None);
    /// assert_eq!(seconds(None, "ts", &[1.732_651_200_000e18, 1.732_651_200_001e18]), Some(1e-9));
    /// assert_eq!(seconds(None, "Time", &[0.0, 0.5]), Some(1.0));
    /// assert_eq!(seconds(None, "Time", &[0.0, 10.0, 20.0]), None);
    /// // 10:30:00 and on by 0.1 s, as a spreadsheet keeps it
    /// let clock = [0.4375, 0.437501157, 0.437502315, 0.437503472, 0.43750463];
    /// assert_eq!(seconds(None, "Time", &clock), Some(86_400.0));
    /// assert_eq!(seconds(None, "Tiempo (milisegundos)", &[0.0, 0.5]), Some(1e-3));
    /// ```
    pub fn of(unit: Option<&str>, name: &str, values: &[f64]) -> Self {
        let first = values.iter().copied().find(|v| v.is_finite());
        match stated_unit(unit, name) {
            StatedUnit::Known(unit) => Self::Stated(unit),
            StatedUnit::Other(text) => Self::Other(text),
            StatedUnit::Nothing => match epoch_unit(name, values) {
                Some(unit) => Self::Epoch(unit),
                None if counts_days(values) => Self::Days,
                None if is_undetermined(values) => Self::Undetermined {
                    first: first.unwrap_or(f64::NAN),
                    step: crate::rate::median_step(values).unwrap_or(f64::NAN),
                },
                None => Self::Seconds,
            },
        }
    }

    /// Seconds in the unit; `None` where it is not known.
    pub fn seconds(&self) -> Option<f64> {
        match self {
            Self::Stated(unit) | Self::Epoch(unit) => Some(unit.to_si),
            Self::Seconds => Some(1.0),
            Self::Days => Some(86_400.0),
            Self::Undetermined { .. } | Self::Other(_) => None,
        }
    }

    /// What was assumed of the axis of a name, or why nothing was, in words; `None` where its unit is stated.
    pub fn note(&self, name: &str) -> Option<String> {
        match self {
            Self::Stated(_) => None,
            Self::Epoch(unit) => {
                let symbol = symbol_of(*unit).unwrap_or("s");
                Some(format!(
                    "time axis '{name}' has no unit: taken as {symbol} since 1970"
                ))
            }
            Self::Seconds => Some(format!("time axis '{name}' has no unit: taken as seconds")),
            Self::Days => Some(format!(
                "time axis '{name}' has no unit: taken as days, as MATLAB's datenum and spreadsheets count them"
            )),
            Self::Undetermined { first, step } => Some(format!(
                "time axis '{name}' has no unit, and its numbers, {first} and on by steps of {step}, may be s, \
                 ms, µs or counts of samples"
            )),
            Self::Other(unit) => Some(format!(
                "time axis '{name}' is in '{unit}', which is no unit of time"
            )),
        }
    }
}

impl AxisUnit {
    /// A note on times that are stated in s and go by whole steps of 2 s and more, for longer than five minutes: they may be ms.
    pub(crate) fn slow_note(&self, name: &str, times: &[f64]) -> Option<String> {
        let Self::Stated(unit) = self else {
            return None;
        };
        let step = crate::rate::median_step(times)?;
        let whole = times.iter().all(|t| t.fract() == 0.0);
        let length = times.last()? - times.first()?;
        let slow = unit.to_si == 1.0 && step >= SLOW_STATED_S && length > SLOW_RECORD_S;
        (whole && slow).then(|| {
            format!("time axis '{name}' is stated in s and goes by steps of {step}: check that it is not in ms")
        })
    }
}

/// Whether a channel is a time axis by its name, with a unit of time or none.
pub fn is_time_axis(channel: &ChannelInfo) -> bool {
    let stated = stated_unit(channel.unit.as_deref(), &channel.name);
    let time = !matches!(stated, StatedUnit::Other(_));
    time && is_time_name(&channel.name) && channel.stored != StoredType::Text
}

/// Whether a time axis is named for no channel alone.
pub(crate) fn is_general(name: &str) -> bool {
    stem(name).is_empty()
}

/// Whether a time axis states its unit.
pub(crate) fn states_unit(unit: Option<&str>, name: &str) -> bool {
    matches!(stated_unit(unit, name), StatedUnit::Known(_))
}

/// The time axis of a dataset: of several the one that is named for no channel alone, and of those the first that
/// states its unit.
pub(crate) fn main_axis(channels: &[ChannelInfo]) -> Option<usize> {
    let is_axis = |c: &ChannelInfo| c.samples > 1 && is_time_axis(c);
    let general = |c: &ChannelInfo| is_axis(c) && is_general(&c.name);
    let stated = |c: &ChannelInfo| general(c) && states_unit(c.unit.as_deref(), &c.name);
    let first = |of: &dyn Fn(&ChannelInfo) -> bool| channels.iter().position(of);
    first(&stated)
        .or_else(|| first(&general))
        .or_else(|| first(&is_axis))
}

/// Give the channels of a dataset with several time axes the one that is named for each: `contact.time` or
/// `t_contact` for `contact`, or for `contact.values`.
pub(crate) fn own_axes(channels: &mut [ChannelInfo]) {
    let is_axis = |c: &ChannelInfo| c.samples > 1 && is_time_axis(c);
    let stems = |(i, c): (usize, &ChannelInfo)| (i, stem(&c.name), c.samples);
    let axes = channels.iter().enumerate().filter(|(_, c)| is_axis(c));
    let axes: Vec<(usize, Vec<String>, u64)> = axes.map(stems).collect();
    if axes.len() < 2 {
        return;
    }
    for channel in channels.iter_mut().filter(|c| c.samples > 1 && !is_axis(c)) {
        let mut named = whole_words(&channel.name);
        let numbers = named
            .iter()
            .map(|w| w[without_digits(w).len()..].to_owned());
        named.extend(numbers.collect::<Vec<_>>());
        let fits = |(_, stem, samples): &&(usize, Vec<String>, u64)| {
            *samples == channel.samples
                && !stem.is_empty()
                && stem.iter().all(|w| named.contains(w))
        };
        if let Some((axis, ..)) = axes
            .iter()
            .filter(fits)
            .max_by_key(|(_, stem, _)| stem.len())
        {
            channel.clock = Clock::Axis(*axis);
        }
    }
}

/// The words of a time axis' name that are none of time, and the number after one of time: whose time it is.
fn stem(name: &str) -> Vec<String> {
    let of_time = |w: &str| {
        let known = FIRST_WORDS.contains(&w) || WORDS.contains(&w);
        known || unit_of_text(w).is_some() || glued(w).is_some()
    };
    let rest = |word: String| match without_digits(&word) {
        bare if of_time(bare) => word[bare.len()..].to_owned(),
        _ => word,
    };
    whole_words(name)
        .into_iter()
        .map(rest)
        .filter(|w| !w.is_empty())
        .collect()
}

/// Seconds since 1970 of the years 1973 and 2128: what a time stamp in s lies between.
const EPOCH_S: [f64; 2] = [1e8, 5e9];

/// Seconds since 1970 of the years 2000 and 2100: dates of records, whatever their column is called.
const DATES_S: [f64; 2] = [946_684_800.0, 4_102_444_800.0];
/// The longest step, s, of numbers that are taken as dates by their size alone: µs since a start are as great as s
/// since 1970 after half an hour, with steps of hundreds.
const LONGEST_STEP_S: f64 = 0.5;

/// The unit of a column that counts from 1970. Of one that is called a time stamp, or an epoch: of s, ms, µs and ns
/// the one that puts its first value into this age. Of any other: the one that makes numbers beyond 10⁹ a date of
/// 2000 to 2100, with steps of samples.
fn epoch_unit(name: &str, values: &[f64]) -> Option<Unit> {
    let first = values.iter().copied().find(|v| v.is_finite())?;
    let words = words(name);
    let counts = words
        .iter()
        .any(|w| EPOCHS.iter().any(|e| w.starts_with(e)));
    let split = words.windows(2).any(|w| w[0] == "time" && w[1] == "stamp");
    let of_age = |[from, to]: [f64; 2]| {
        let fits = |to_si: &f64| (from..to).contains(&(first * to_si));
        [1.0, 1e-3, 1e-6, 1e-9].into_iter().find(fits)
    };
    if counts || split {
        return of_age(EPOCH_S).map(of_time);
    }
    let to_si = of_age(DATES_S).filter(|_| first > LONGEST_S)?;
    let step = crate::rate::median_step(values)?;
    (step * to_si < LONGEST_STEP_S).then(|| of_time(to_si))
}

/// Whether values without a name climb evenly, as a time axis does, and are no mere count of rows.
pub(crate) fn climbs_evenly(values: &[f64]) -> bool {
    let head = &values[..values.len().min(crate::rate::HEAD_SAMPLES)];
    let counts = head.iter().all(|v| v.fract() == 0.0);
    steps_evenly(values) && !counts
}

/// Fewest counts from one sample to the next of a clock, as one of a microcontroller; rows, frames and encoders count by one.
const FEWEST_TICKS: f64 = 2.0;

/// Whether whole numbers without a name climb by even steps of several, as the counts of a clock do.
pub(crate) fn ticks_evenly(values: &[f64]) -> bool {
    let head = &values[..values.len().min(crate::rate::HEAD_SAMPLES)];
    let counts = head.iter().all(|v| v.fract() == 0.0);
    let step = crate::rate::median_step(head).unwrap_or(0.0);
    counts && step >= FEWEST_TICKS && steps_evenly(values)
}

/// Whether values climb by even steps at their front, and never fall.
pub(crate) fn steps_evenly(values: &[f64]) -> bool {
    let head = &values[..values.len().min(crate::rate::HEAD_SAMPLES)];
    let Some(step) = crate::rate::median_step(head) else {
        return false;
    };
    let mut steps = head.windows(2).map(|w| w[1] - w[0]);
    let even = steps.all(|own| (own - step).abs() < 0.5 * step);
    let on = values.windows(2).all(|w| w[1] >= w[0]);
    head.len() > 2 && even && on
}

/// Days of the years 1950 to 2100 since the year 0, as MATLAB counts, and since 1900, as spreadsheets do.
const DAYS: [[f64; 2]; 2] = [[712_224.0, 767_376.0], [18_264.0, 73_416.0]];
/// Steps below this are of no time in s since a start so long ago: 80 kHz and more, after hours or days.
const LEAST_STEP_S: f64 = 1.25e-5;

/// Whether times without a unit count days from a date of this age, or from midnight, and go on by less than a second.
fn counts_days(times: &[f64]) -> bool {
    let first = times.iter().copied().find(|t| t.is_finite());
    let of_age = first.is_some_and(|t| DAYS.iter().any(|[from, to]| (*from..*to).contains(&t)));
    (of_age || is_clock(times))
        && crate::rate::median_step(times).is_some_and(|step| step < LEAST_STEP_S)
}

/// Times of day over the length of a record, at least, from which numbers below 1 may be parts of a day.
const AFTER_MIDNIGHT: f64 = 20.0;
/// Digits of steps that people choose, and how near a step is to one.
const ROUND: [f64; 6] = [1.0, 2.0, 2.5, 4.0, 5.0, 10.0];
const NEARLY: f64 = 2e-3;

/// Whether numbers below 1 are a clock's, as parts of a day, the way spreadsheets keep it: long after midnight, and by a
/// step that is round in seconds of a day alone.
fn is_clock(times: &[f64]) -> bool {
    let finite = || times.iter().copied().filter(|t| t.is_finite());
    let (Some(first), Some(last)) = (finite().next(), finite().next_back()) else {
        return false;
    };
    let length = last - first;
    let step = length / finite().count().saturating_sub(1).max(1) as f64;
    let round = |step: f64| {
        let digits = step / 10f64.powf(step.log10().floor());
        ROUND.iter().any(|r| (digits / r - 1.0).abs() < NEARLY)
    };
    let in_a_day = first < 1.0 && last < 1.0 && length > 0.0 && first > AFTER_MIDNIGHT * length;
    in_a_day && round(86_400.0 * step) && !round(step)
}

/// A time without a unit beyond this is no time in s since the start of a record: 32 years.
const LONGEST_S: f64 = 1e9;

/// A step and a length in s of records that are too slow and too long to be of vibrations: more likely ms.
const SLOW_STEP_S: f64 = 0.05;
const SLOW_RECORD_S: f64 = 300.0;

/// A step of whole seconds from which on stated times are noted, s.
const SLOW_STATED_S: f64 = 2.0;

/// Whether times without a unit may be of any unit: whole numbers, as counts of ms and of samples are, beyond 10⁹, or
/// with steps and a length that are those of ms.
fn is_undetermined(times: &[f64]) -> bool {
    let mut finite = times.iter().filter(|t| t.is_finite()).peekable();
    let Some(&&first) = finite.peek() else {
        return false;
    };
    let whole = finite.clone().all(|t| t.fract() == 0.0);
    let moves = finite.clone().any(|t| *t != first);
    let step = crate::rate::median_step(times).unwrap_or(0.0);
    let slow = step >= SLOW_STEP_S && finite.clone().any(|t| t - first > SLOW_RECORD_S);
    (whole && moves) || slow || finite.any(|t| t.abs() > LONGEST_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_time() {
        for name in [
            "time_s",
            "Time",
            "t",
            "X_Value",
            "X_Value 2",
            "Time (Run 1)",
            "Zeit",
            "millis",
            "Millis()",
            "micros",
            "timestamp",
            "Time Stamp",
            "elapsed_ms",
            "timeMs",
            "tMillis",
            "t_us",
            "ms",
            "tms",
            "epoch_ms",
            "Run 1: Time",
            "Elapsed Time",
            "Zeitstempel",
            "ms since start",
            "seconds",
            "seconds_elapsed",
            "Time2",
            "tout",
            "in s",
            "in ms",
            "rec.t",
            "ts",
            "ts_ns",
            ".header.stamp",
            "datetime",
            "Sekunde",
            "segundos",
        ] {
            assert!(is_time_name(name), "{name}");
        }
        for name in [
            "times", "velocity", "tone", "s", "min", "h", "items", "minimum", "bus", "tens",
            "in V", "in mm", "t1", "touch", "volts",
        ] {
            assert!(!is_time_name(name), "{name}");
        }
    }

    #[test]
    fn channels_with_times_of_their_own_find_them_by_name() {
        let channel = |name: &str| ChannelInfo {
            name: name.into(),
            unit: None,
            stored: StoredType::Float(64),
            samples: 100,
            sample_rate_hz: None,
            start_time: None,
            clock: Clock::Shared,
            start_s: None,
            properties: Default::default(),
        };
        let clocks = |names: &[&str]| -> Vec<Clock> {
            let mut channels: Vec<ChannelInfo> = names.iter().map(|n| channel(n)).collect();
            own_axes(&mut channels);
            channels.iter().map(|c| c.clock).collect()
        };
        let axis = Clock::Axis;
        assert_eq!(
            clocks(&["x.time", "x.values", "contact.time", "contact.values"])[1..],
            [axis(0), Clock::Shared, axis(2)]
        );
        assert_eq!(
            clocks(&["geo.t", "geo.y", "laser.t", "laser.y"])[1..],
            [axis(0), Clock::Shared, axis(2)]
        );
        assert_eq!(
            clocks(&["time_ch1", "time_ch2", "ch1", "ch2"])[2..],
            [axis(0), axis(1)]
        );
        assert_eq!(
            clocks(&["t", "t_contact", "x", "contact"])[2..],
            [Clock::Shared, axis(1)]
        );
        assert_eq!(clocks(&["time", "x", "y"])[1..], [Clock::Shared; 2]);
    }

    #[test]
    fn every_way_of_milliseconds_and_microseconds() {
        let unit = |unit: Option<&str>, name: &str| match stated_unit(unit, name) {
            StatedUnit::Known(unit) => Some(unit.to_si),
            _ => None,
        };
        for name in [
            "time_ms",
            "Time (ms)",
            "Time [ms]",
            "Time, ms",
            "Time/ms",
            "Time / ms",
            "Zeit in ms",
            "timeMs",
            "TIME_MS",
            "tms",
            "t_ms",
            "ms",
            "millis",
            "millis()",
            "time_millis",
            "Time (msec)",
            "Time (Milliseconds)",
            "elapsed milliseconds",
            "ms since start",
            "timestamp_ms",
            "Time.ms",
            "Time (ms) Run #1",
            "Zeit (Millisekunden)",
            "Time (1e-3 s)",
            "Time (10^-3 s)",
            "Time{ms}",
            "Time (milli sec)",
            "time milli-seconds",
        ] {
            assert_eq!(unit(None, name), Some(1e-3), "{name}");
        }
        for name in [
            "time_us",
            "Time (µs)",
            "Time (μs)",
            "t_us",
            "micros",
            "timestamp_us",
            "Time (usec)",
            "timeUs",
            "microseconds since boot",
            "tus",
            "Zeit in µs",
        ] {
            assert_eq!(unit(None, name), Some(1e-6), "{name}");
        }
        for symbol in ["ms", "msec", "MS", "Milliseconds", "1e-3 s", "0.001 s"] {
            assert_eq!(unit(Some(symbol), "Time"), Some(1e-3), "{symbol}");
        }
        for name in ["Time", "t", "timestamp", "Time US Eastern", "Time Run 1"] {
            assert_eq!(stated_unit(None, name), StatedUnit::Nothing, "{name}");
        }
        assert_eq!(unit(None, "Time (s)"), Some(1.0));
        assert_eq!(unit(None, "time_min"), Some(60.0));
        assert_eq!(unit(None, "t (hrs)"), Some(3600.0));
        assert_eq!(
            stated_unit(None, "t (jif)"),
            StatedUnit::Other("jif".into())
        );
        for name in ["Time (UTC)", "Time (Run 1)", "Time [3]"] {
            assert_eq!(stated_unit(None, name), StatedUnit::Nothing, "{name}");
        }
        assert_eq!(
            stated_unit(Some("ticks"), "Time"),
            StatedUnit::Other("ticks".into())
        );
    }

    #[test]
    fn valid_seconds_minutes_and_hours_are_spelled_out_in_several_languages() {
        let unit = |unit: Option<&str>, name: &str| match stated_unit(unit, name) {
            StatedUnit::Known(unit) => Some(unit.to_si),
            _ => None,
        };
        for symbol in [
            "Sekunde",
            "Sekunden",
            "seconde",
            "Secondes",
            "segundo",
            "segundos",
            "secondo",
            "secondi",
            "sekunda",
            "sekundy",
            "seconden",
            "секунда",
            "с",
        ] {
            assert_eq!(unit(Some(symbol), "t"), Some(1.0), "{symbol}");
            assert_eq!(unit(None, &format!("t ({symbol})")), Some(1.0), "{symbol}");
        }
        for (symbol, seconds) in [("minuta", 60.0), ("Minuto", 60.0), ("heure", 3600.0)] {
            assert_eq!(unit(Some(symbol), "t"), Some(seconds), "{symbol}");
        }
    }

    #[test]
    fn whole_numbers_that_climb_by_several_are_counts_of_a_clock() {
        let column = |step: i32| {
            (0..40)
                .map(|i| f64::from(5321 + step * i))
                .collect::<Vec<f64>>()
        };
        assert!(ticks_evenly(&column(10)));
        // rounded down to whole milliseconds
        let rounded: Vec<f64> = (0..40).map(|i| (f64::from(i) * 9.77).floor()).collect();
        assert!(ticks_evenly(&rounded));
        // rows, a signal, and times in parts
        assert!(!ticks_evenly(&column(1)));
        let wave: Vec<f64> = (0..40)
            .map(|i| (f64::from(i).sin() * 100.0).round())
            .collect();
        assert!(!ticks_evenly(&wave));
        assert!(!ticks_evenly(&[0.0, 2.5, 5.0, 7.5]));
    }

    #[test]
    fn a_column_without_a_name_is_time_where_it_climbs_evenly_by_parts() {
        let column = |step: f64| (0..600).map(|i| f64::from(i) * step).collect::<Vec<f64>>();
        assert!(climbs_evenly(&column(2e-3)));
        // a count of rows, a signal, a time that goes back
        assert!(!climbs_evenly(&column(1.0)));
        let wave: Vec<f64> = column(0.1).iter().map(|t| t.sin()).collect();
        assert!(!climbs_evenly(&wave));
        let mut twice = column(2e-3);
        twice.extend(column(2e-3));
        assert!(!climbs_evenly(&twice));
        assert!(!climbs_evenly(&[0.5, 0.5]));
    }

    #[test]
    fn time_stamps_count_from_1970_in_the_unit_that_gives_this_age() {
        let unit = |name, first: f64| epoch_unit(name, &[first]).map(|u| u.to_si);
        assert_eq!(unit("timestamp", 1_700_000_000.0), Some(1.0));
        assert_eq!(unit("Time Stamp", 1.7e12), Some(1e-3));
        assert_eq!(unit("epoch", 1.7e15), Some(1e-6));
        assert_eq!(unit("unix time", 1.7e18), Some(1e-9));
        assert_eq!(unit("time", 1.7e12), None);
        assert_eq!(unit("timestamp", 12_000.0), None);
    }

    #[test]
    fn valid_great_numbers_are_dates_where_one_unit_alone_makes_them_so() {
        let unit = |first: f64, step: f64| {
            let values: Vec<f64> = (0..20).map(|i| first + f64::from(i) * step).collect();
            AxisUnit::of(None, "time", &values).seconds()
        };
        // steps of 10 ms
        assert_eq!(unit(1.701_234_567e9, 1e-2), Some(1.0));
        assert_eq!(unit(1.701_234_567e12, 10.0), Some(1e-3));
        assert_eq!(unit(1.701_234_567e15, 1e4), Some(1e-6));
        assert_eq!(unit(1.701_234_567e18, 1e7), Some(1e-9));
        // µs since a start 28 minutes ago, and counts of no age
        assert_eq!(unit(1.7e9, 500.0), None);
        assert_eq!(unit(5e9, 500.0), None);
        assert_eq!(unit(9e17, 1e7), None);
    }

    #[test]
    fn of_several_time_axes_the_one_that_states_its_unit_is_taken() {
        let channel = |name: &str, unit: Option<&str>| ChannelInfo {
            name: name.into(),
            unit: unit.map(str::to_owned),
            stored: StoredType::Float(64),
            samples: 100,
            sample_rate_hz: None,
            start_time: None,
            clock: Clock::Shared,
            start_s: None,
            properties: Default::default(),
        };
        let main = |names: &[(&str, Option<&str>)]| {
            let channels: Vec<ChannelInfo> = names.iter().map(|(n, u)| channel(n, *u)).collect();
            main_axis(&channels)
        };
        let elapsed = ("seconds_elapsed", None);
        assert_eq!(main(&[("time", None), elapsed, ("x", None)]), Some(1));
        assert_eq!(main(&[("time", None), ("Time", Some("ms"))]), Some(1));
        assert_eq!(main(&[("t", None), ("t_contact", Some("s"))]), Some(0));
        assert_eq!(main(&[("tout", None), ("yout", None)]), Some(0));
    }

    #[test]
    fn dates_that_are_counted_in_days_are_told_by_their_step() {
        let unit = |first: f64, step: f64| {
            let times: Vec<f64> = (0..50).map(|i| first + f64::from(i) * step).collect();
            AxisUnit::of(None, "time", &times).seconds()
        };
        assert_eq!(unit(738_000.5, 1e-3 / 86_400.0), Some(86_400.0));
        assert_eq!(unit(46_352.5, 1e-3 / 86_400.0), Some(86_400.0));
        // s since midnight
        assert_eq!(unit(46_352.5, 1e-3), Some(1.0));
        assert_eq!(unit(0.5, 1e-6), Some(1.0));
    }

    #[test]
    fn whole_numbers_and_great_ones_may_be_of_any_unit() {
        assert!(is_undetermined(&[0.0, 10.0, 20.0]));
        assert!(is_undetermined(&[1.7e9, 1.7e9 + 0.01]));
        assert!(!is_undetermined(&[0.0, 0.5, 1.0]));
        assert!(!is_undetermined(&[0.0, 0.0]));
    }
}
