//! Points in time as instruments print them: dates, times of day, both together.

use chrono::NaiveDate;

/// A point in time: days since 1970-01-01 where a date is given, and seconds of the day.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Stamp {
    /// Days since 1970-01-01; `None` for a time of day alone.
    pub days: Option<i64>,
    /// Seconds since midnight (or since the clock's zero).
    pub seconds: f64,
    /// What its clock is ahead of universal time, s, where it is stated.
    pub ahead_s: Option<f64>,
    /// Whether it has minutes and seconds alone: after an hour it begins again.
    pub of_hour: bool,
}

const DAY_S: f64 = 86_400.0;
const HOUR_S: f64 = 3600.0;

impl Stamp {
    /// Seconds from `origin` to this stamp; where both state what their clocks are ahead, these may differ, as at the end of
    /// summer time.
    pub(crate) fn since(self, origin: Self) -> f64 {
        let days = match (self.days, origin.days) {
            (Some(a), Some(b)) => (a - b) as f64,
            _ => 0.0,
        };
        let ahead = match (self.ahead_s, origin.ahead_s) {
            (Some(own), Some(first)) => own - first,
            _ => 0.0,
        };
        days * DAY_S + (self.seconds - origin.seconds) - ahead
    }

    /// After how long its clock begins again, s; `None` of one with a date.
    pub(crate) fn turn_s(self) -> Option<f64> {
        let turn = if self.of_hour { HOUR_S } else { DAY_S };
        self.days.is_none().then_some(turn)
    }

    /// ISO 8601 text: `2024-05-01T12:30:00.25`, or the time alone.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "seconds of a day, and fewer than 10^9 nanoseconds"
    )]
    pub(crate) fn iso(self) -> String {
        let whole = self.seconds.floor();
        let nanos = ((self.seconds - whole) * 1e9).round().min(999_999_999.0) as u32;
        let s = whole as i64;
        let mut text = format!("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
        if nanos > 0 {
            text.push_str(format!(".{nanos:09}").trim_end_matches('0'));
        }
        let days = self.days.and_then(|days| i32::try_from(days).ok());
        match days.and_then(NaiveDate::from_epoch_days) {
            Some(date) => format!("{date}T{text}"),
            None => text,
        }
    }
}

/// The stamp or the length of time that a cell of a column holds: as [`parse`], or with its unit, as MATLAB and pandas
/// write durations, `0.0005 sec`, `1.5 min`, `0 days 00:00:00.5`.
pub(crate) fn parse_cell(cell: &str, month_first: bool) -> Option<Stamp> {
    parse(cell, month_first).or_else(|| duration(cell.trim()))
}

/// A length of time with its unit behind it.
fn duration(text: &str) -> Option<Stamp> {
    const UNITS: [(&str, f64); 4] = [("sec", 1.0), ("min", 60.0), ("hr", HOUR_S), ("days", DAY_S)];
    let (number, unit) = text.split_once(' ')?;
    let (unit, clock) = unit.split_once(' ').unwrap_or((unit, ""));
    let (_, to_s) = UNITS.iter().find(|(known, _)| *known == unit)?;
    let number = number.replace(',', ".");
    let plain = |b: u8| b.is_ascii_digit() || b"+-.eE".contains(&b);
    let number: f64 = number.parse().ok().filter(|_| number.bytes().all(plain))?;
    let rest = match clock {
        "" => 0.0,
        clock => parse_time(clock).filter(|_| unit == "days")?.seconds,
    };
    Some(Stamp {
        seconds: number * to_s + rest,
        ..Stamp::default()
    })
}

/// The stamp that a cell holds: `2024-05-01T12:00:00.5Z`, `1.5.2024 12:00:00,5`,
/// `05/01/2024 1:00 PM`, `12:00:00`, `00:01.5`. `None`: the cell is no point in time.
///
/// `month_first` reads `05/01/2024` as the first of May; a number above 12 overrules it.
pub(crate) fn parse(cell: &str, month_first: bool) -> Option<Stamp> {
    let cell = cell.trim();
    if cell.is_empty() || cell.len() > 48 || !cell.is_ascii() {
        return None;
    }
    if let Some((days, time)) = with_named_month(cell) {
        let days = Some(days);
        return with_date(days, time);
    }
    let (date, rest) = cell.split_once(['T', ' ']).unwrap_or((cell, ""));
    let days = parse_date(date, month_first);
    let time = if days.is_some() { rest } else { cell };
    with_date(days, time.trim())
}

/// A time of day, or midnight, of a day.
fn with_date(days: Option<i64>, time: &str) -> Option<Stamp> {
    let clock = match time {
        "" => Stamp::default(),
        _ => parse_time(time)?,
    };
    Some(Stamp { days, ..clock })
}

/// The first letters of the months.
const MONTHS: [&str; 12] = [
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
];

/// Days since 1970-01-01 and the time of day of a cell whose date names its month: `27-Nov-2025 10:59:57`, `27 Nov 2025`,
/// `Nov 27, 2025 10:59:57 AM`.
fn with_named_month(cell: &str) -> Option<(i64, &str)> {
    let mark = |c: char| matches!(c, '-' | '/' | ' ' | ',' | '.');
    let mut rest = cell;
    let mut next = || {
        let end = rest.find(mark).unwrap_or(rest.len());
        let part = &rest[..end];
        rest = rest[end..].trim_start_matches(mark);
        part
    };
    let parts = [next(), next(), next()];
    let month_of = |part: &str| {
        let begin = part.get(..3)?.to_ascii_lowercase();
        let letters = part.bytes().all(|b| b.is_ascii_alphabetic());
        MONTHS.iter().position(|m| *m == begin).filter(|_| letters)
    };
    let (day, month) = match [month_of(parts[0]), month_of(parts[1])] {
        [None, Some(month)] => (parts[0], month),
        [Some(month), None] => (parts[1], month),
        _ => return None,
    };
    let year = parts[2];
    if !is_digits(day, 2) || !is_digits(year, 4) || year.len() != 4 {
        return None;
    }
    let month = u32::try_from(month + 1).ok()?;
    let date = NaiveDate::from_ymd_opt(year.parse().ok()?, month, day.parse().ok()?)?;
    Some((date.to_epoch_days().into(), rest))
}

/// Days since 1970-01-01 of a date in any of the usual orders.
fn parse_date(text: &str, month_first: bool) -> Option<i64> {
    let mark = text.bytes().find(|b| matches!(b, b'-' | b'/' | b'.'))? as char;
    let mut parts = text.split(mark);
    let [a, b, c] = [parts.next()?, parts.next()?, parts.next()?];
    if parts.next().is_some() || [a, b, c].iter().any(|p| !is_digits(p, 4)) {
        return None;
    }
    let [x, y, z]: [u32; 3] = [a.parse().ok()?, b.parse().ok()?, c.parse().ok()?];
    let (year, month, day) = match (a.len(), c.len()) {
        (4, _) => (x, y, z),
        (_, 4) if (month_first && x <= 12) || y > 12 => (z, x, y),
        (_, 4) => (z, y, x),
        _ => return None,
    };
    let date = NaiveDate::from_ymd_opt(i32::try_from(year).ok()?, month, day)?;
    Some(date.to_epoch_days().into())
}

fn is_digits(text: &str, longest: usize) -> bool {
    (1..=longest).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit())
}

/// The time of `h:mm:ss.fff`, `mm:ss.fff`, either with AM or PM, `Z`, `UTC` or an offset.
fn parse_time(text: &str) -> Option<Stamp> {
    let upper = text.to_ascii_uppercase();
    let half_day = if upper.ends_with("PM") { 12.0 } else { 0.0 };
    let twelve = upper.ends_with("AM") || upper.ends_with("PM");
    let body = if twelve {
        upper[..upper.len() - 2].trim_end()
    } else {
        upper.as_str()
    };
    let (body, ahead_s) = without_zone(body);
    let parts: Vec<&str> = body.split(':').collect();
    let mut of_hour = false;
    let (hours, minutes, seconds) = match parts[..] {
        [h, m] if twelve => (h, m, "0".to_owned()),
        [m, s] if s.contains(['.', ',']) => {
            of_hour = true;
            ("0", m, s.to_owned())
        }
        [h, m] => (h, m, "0".to_owned()),
        [h, m, s] => (h, m, s.to_owned()),
        [h, m, s, fraction] => (h, m, with_fraction(s, fraction)?),
        _ => return None,
    };
    let seconds = parse_clock(hours, minutes, &seconds, twelve.then_some(half_day))?;
    Some(Stamp {
        days: None,
        seconds,
        ahead_s,
        of_hour,
    })
}

/// Seconds after a third colon, as `12:00:07:250` has them: three digits are milliseconds, six microseconds. Fewer
/// may be a film's frames.
fn with_fraction(seconds: &str, fraction: &str) -> Option<String> {
    let counted = is_digits(fraction, 6) && matches!(fraction.len(), 3 | 6);
    (counted && is_digits(seconds, 2)).then(|| format!("{seconds}.{fraction}"))
}

/// Seconds of hours, minutes and seconds; `half_day`: the hours to add to a clock of twelve, `None` of one of 24.
fn parse_clock(hours: &str, minutes: &str, seconds: &str, half_day: Option<f64>) -> Option<f64> {
    let whole = seconds.split(['.', ',']).next()?;
    if !is_digits(hours, 5) || !is_digits(minutes, 2) || !is_digits(whole, 2) {
        return None;
    }
    let seconds: f64 = seconds.replace(',', ".").parse().ok()?;
    let (hours, minutes): (f64, f64) = (hours.parse().ok()?, minutes.parse().ok()?);
    let hours = half_day.map_or(hours, |half_day| hours % 12.0 + half_day);
    (minutes < 60.0 && seconds < 61.0).then_some(hours * 3600.0 + minutes * 60.0 + seconds)
}

/// A time in capitals without its `Z`, ` UTC` or `+01:00`, and what these say that its clock is ahead of universal time, s.
fn without_zone(text: &str) -> (&str, Option<f64>) {
    if let Some(time) = text.strip_suffix('Z') {
        return (time.trim_end_matches('Z'), Some(0.0));
    }
    let named = text.rsplit_once(' ').filter(|(_, zone)| {
        (2..=5).contains(&zone.len()) && zone.bytes().all(|b| b.is_ascii_uppercase())
    });
    if let Some((time, zone)) = named {
        let universal = ["UTC", "GMT"].contains(&zone);
        let (time, stated) = without_offset(time);
        return (time, stated.or(universal.then_some(0.0)));
    }
    without_offset(text)
}

/// A time without `+01:00`, `-0530` or `+01`, and these in s.
fn without_offset(text: &str) -> (&str, Option<f64>) {
    let Some(at) = text.rfind(['+', '-']).filter(|at| *at > 0) else {
        return (text, None);
    };
    let (time, offset) = text.split_at(at);
    let sign = if offset.starts_with('-') { -1.0 } else { 1.0 };
    let digits = offset[1..].replace(':', "");
    let number = |part: Option<&str>| part?.parse::<f64>().ok();
    let ahead_s = match digits.len() {
        _ if !is_digits(&digits, 4) => None,
        2 => number(Some(&digits)).map(|hours| sign * hours * HOUR_S),
        4 => number(digits.get(..2))
            .zip(number(digits.get(2..)))
            .map(|(hours, minutes)| sign * (hours * HOUR_S + minutes * 60.0)),
        _ => None,
    };
    (time.trim_end(), ahead_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stamps_in_the_usual_orders() {
        let may = Some(19_844);
        for (text, seconds) in [
            ("2024-05-01T12:00:00.5Z", 43_200.5),
            ("2024/05/01 12:00:00,5", 43_200.5),
            ("1.5.2024 0:00:01", 1.0),
            ("2024-05-01T12:00:00+02:00", 43_200.0),
            ("2024-05-01", 0.0),
            ("01/05/2024 01:00:00 PM", 46_800.0),
        ] {
            let found = parse(text, false).unwrap();
            assert_eq!((found.days, found.seconds), (may, seconds), "{text}");
        }
        assert_eq!(parse("05/01/2024 1:00 PM", true).unwrap().days, may);
        assert_eq!(parse("00:01.5", false).unwrap().seconds, 1.5);
        assert_eq!(parse("10:45:47.25", false).unwrap().seconds, 38_747.25);
        // milliseconds and microseconds after a third colon; two digits are frames of a film
        assert_eq!(parse("10:45:47:250", false).unwrap().seconds, 38_747.25);
        assert_eq!(
            parse("10:45:47:000250", false).unwrap().seconds,
            38_747.000_25
        );
        assert_eq!(
            parse("2024-05-01 1:45:47:250 PM", false).unwrap().seconds,
            49_547.25
        );
        assert_eq!(parse("10:45:47:12", false), None);
        let morning = Some((Some(20_419), 39_597.25));
        for text in [
            "27-Nov-2025 10:59:57.250",
            "27 Nov 2025 10:59:57.25",
            "Nov 27, 2025 10:59:57.25 AM",
            "2025-11-27 10:59:57.250000 +01:00",
            "2025-11-27 10:59:57.250 UTC",
            "2025-11-27T10:59:57.250000000Z",
        ] {
            let found = parse(text, false).map(|s| (s.days, s.seconds));
            assert_eq!(found, morning, "{text}");
        }
        for text in ["Nov 27", "nov-27-25", "10:59:57 o'clock", "mass 12 2025"] {
            assert_eq!(parse(text, false), None, "{text}");
        }
        for text in ["1.5", "12", "", "a:b", "2024-13-01", "12:61:00", "-1:00:00"] {
            assert_eq!(parse(text, false), None, "{text}");
        }
        assert_eq!(parse("2000-03-01", false).unwrap().days, Some(11_017));
        assert_eq!(
            parse("2024-05-01T12:00:00.5Z", false).unwrap().iso(),
            "2024-05-01T12:00:00.5"
        );
    }

    #[test]
    fn valid_clocks_that_are_ahead_by_unlike_offsets_go_on() {
        let since = |a: &str, b: &str| {
            let [a, b] = [a, b].map(|text| parse(text, false).unwrap());
            b.since(a)
        };
        let summer = "2024-10-27T02:59:59.990+02:00";
        assert!((since(summer, "2024-10-27T02:00:00.000+01:00") - 0.01).abs() < 1e-6);
        assert!((since(summer, "2024-10-27T01:00:00Z") - 0.01).abs() < 1e-6);
        assert!((since(summer, "2024-10-27 06:30:00.000 +0530") - 0.01).abs() < 1e-6);
        assert!((since(summer, "2024-10-27 01:00:00 UTC") - 0.01).abs() < 1e-6);
        // one alone states none: both are of one clock
        assert_eq!(since("12:00:00+02", "12:00:01"), 1.0);
    }

    #[test]
    fn valid_durations_with_their_unit_are_lengths_of_time() {
        let seconds = |text| parse_cell(text, false).map(|s| s.seconds);
        assert_eq!(seconds("0.000833333 sec"), Some(0.000_833_333));
        assert_eq!(seconds("8.3333e-05 sec"), Some(8.3333e-5));
        assert_eq!(seconds("1,5 min"), Some(90.0));
        assert_eq!(seconds("0 days 00:00:00.5"), Some(0.5));
        for text in ["5 mm", "sec", "inf sec", "5 sec 1", "1 days 5", "5 seconds"] {
            assert_eq!(seconds(text), None, "{text}");
        }
        assert_eq!(parse("0.5 sec", false), None);
    }

    proptest! {
        #[test]
        fn prop_dates_come_back(days in -700_000i32..700_000) {
            let date = NaiveDate::from_epoch_days(days).unwrap().to_string();
            let stamp = parse(&date, false).unwrap();
            prop_assert_eq!(stamp.days, Some(days.into()));
            prop_assert!(stamp.iso().starts_with(&date), "{} {}", stamp.iso(), date);
        }

        #[test]
        fn prop_no_text_panics(text in ".{0,40}") {
            let _ = parse_cell(&text, false);
        }
    }
}
