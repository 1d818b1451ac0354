//! Points in time as instruments print them: dates, times of day, both together.

use chrono::NaiveDate;

/// A point in time: days since 1970-01-01 where a date is given, and seconds of the day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stamp {
    /// Days since 1970-01-01; `None` for a time of day alone.
    pub days: Option<i64>,
    /// Seconds since midnight (or since the clock's zero).
    pub seconds: f64,
}

impl Stamp {
    /// Seconds from `origin` to this stamp; a clock that passed midnight gains a day.
    pub(crate) fn since(self, origin: Self) -> f64 {
        let days = match (self.days, origin.days) {
            (Some(a), Some(b)) => (a - b) as f64,
            _ => 0.0,
        };
        days * 86_400.0 + (self.seconds - origin.seconds)
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
        let seconds = if time.is_empty() {
            0.0
        } else {
            parse_time(time)?
        };
        let days = Some(days);
        return Some(Stamp { days, seconds });
    }
    let (date, rest) = cell.split_once(['T', ' ']).unwrap_or((cell, ""));
    let days = parse_date(date, month_first);
    let time = if days.is_some() { rest } else { cell };
    let seconds = match time {
        "" => 0.0,
        _ => parse_time(time.trim())?,
    };
    Some(Stamp { days, seconds })
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

/// Seconds of `h:mm:ss.fff`, `mm:ss.fff`, either with AM or PM, `Z`, `UTC` or an offset (left out:
/// all stamps of a file share it).
fn parse_time(text: &str) -> Option<f64> {
    let upper = text.to_ascii_uppercase();
    let half_day = if upper.ends_with("PM") { 12.0 } else { 0.0 };
    let twelve = upper.ends_with("AM") || upper.ends_with("PM");
    let body = if twelve {
        upper[..upper.len() - 2].trim_end()
    } else {
        upper.as_str()
    };
    let body = without_zone(body);
    let parts: Vec<&str> = body.split(':').collect();
    let (hours, minutes, seconds) = match parts[..] {
        [h, m] if twelve => (h, m, "0"),
        [m, s] if s.contains(['.', ',']) => ("0", m, s),
        [h, m] => (h, m, "0"),
        [h, m, s] => (h, m, s),
        [h, m, s, fraction] => {
            let seconds = with_fraction(s, fraction)?;
            return parse_clock(h, m, &seconds, twelve.then_some(half_day));
        }
        _ => return None,
    };
    parse_clock(hours, minutes, seconds, twelve.then_some(half_day))
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

/// A time in capitals without its `Z`, ` UTC` or `+01:00`.
fn without_zone(text: &str) -> &str {
    let text = text.trim_end_matches('Z');
    let named = text.rsplit_once(' ').filter(|(_, zone)| {
        (2..=5).contains(&zone.len()) && zone.bytes().all(|b| b.is_ascii_uppercase())
    });
    let text = named.map_or(text, |(time, _)| time);
    match text.rfind(['+', '-']) {
        Some(i) if i > 0 => text[..i].trim_end(),
        _ => text,
    }
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
            assert_eq!(
                parse(text, false),
                Some(Stamp { days: may, seconds }),
                "{text}"
            );
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
        let morning = Some(Stamp {
            days: Some(20_419),
            seconds: 39_597.25,
        });
        for text in [
            "27-Nov-2025 10:59:57.250",
            "27 Nov 2025 10:59:57.25",
            "Nov 27, 2025 10:59:57.25 AM",
            "2025-11-27 10:59:57.250000 +01:00",
            "2025-11-27 10:59:57.250 UTC",
            "2025-11-27T10:59:57.250000000Z",
        ] {
            assert_eq!(parse(text, false), morning, "{text}");
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
            let _ = parse(&text, false);
        }
    }
}
