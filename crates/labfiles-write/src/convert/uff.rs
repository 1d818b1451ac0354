//! Records to a universal file: one function (set 58) for each channel, binary or as text.
//!
//! Line 1 of a function is the channel's name, line 2 the record's, line 3 the time, lines 4 and 5 hold
//! attributes as `name=value; …` as far as they go in; the load case numbers the records, so that readers
//! tell their functions apart. Of an even abscissa of time start and step are written in the thirteen columns that
//! the format has for each; a channel without a rate has the sample's number as abscissa, and one whose times cannot
//! be written so is refused.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use chrono::{Datelike, NaiveDateTime};

use crate::convert::even::{self, Even};
use crate::convert::item::{ConvertError, Item, Options, grouped, io};
use crate::output::write_whole_or;
use crate::to_f32;
use labfiles::conventions;
use labfiles::conventions::Span;
use labfiles::units::{Dimension, parse_unit};
use labfiles::{ChannelInfo, Clock, Samples};

/// Columns of a line of identification.
const LINE: usize = 80;
/// Columns of a label of an axis.
const LABEL: usize = 20;
/// Columns of a number of record 7, and of one in single precision.
const NARROW: usize = 13;
/// Columns of a number in double precision.
const WIDE: usize = 20;
/// Lines of text before binary numbers.
const HEADER_LINES: usize = 11;

/// Write all records; texts are left out.
pub(super) fn write(
    items: &[Item<'_>],
    out: &Path,
    options: &Options,
    text: bool,
) -> Result<(), ConvertError> {
    let mut read = Vec::with_capacity(items.len());
    for (number, item) in items.iter().enumerate() {
        let samples = item.read()?;
        let record = Record {
            item,
            number: number + 1,
            text,
            single: options.single_precision,
            times: even::of(item, &samples)?,
        };
        record.refuse_lost_starts(&samples)?;
        read.push((record, samples));
    }
    let fill = |file: &mut BufWriter<File>| {
        for (record, samples) in &read {
            record.write(samples, file)?;
        }
        Ok(())
    };
    Ok(write_whole_or(out, fill, |e| e).map_err(io(out))?)
}

/// Notes on what the file cannot hold of the records, each once for all that it concerns.
pub(super) fn notes(items: &[Item<'_>], text: bool, single: bool) -> Vec<String> {
    let rates = |item: &Item<'_>| rates_of(item).into_iter().filter_map(rounded_rate);
    let mut notes = grouped(items, rates);
    if text {
        let digits = if single { 6 } else { 13 };
        notes.push(format!(
            "numbers that need more than about {digits} digits are rounded, as text has fields of \
             fixed width; the binary form (--to uff) keeps every bit"
        ));
    }
    notes
}

/// The rate that a record's channels share, or else the rates that they have, each once.
fn rates_of(item: &Item<'_>) -> Vec<f64> {
    let mut rates: Vec<f64> = match item.sample_rate_hz() {
        Some(shared) => vec![shared],
        None => item
            .channels()
            .iter()
            .filter_map(|c| c.sample_rate_hz)
            .collect(),
    };
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    rates
}

/// A note if the step of a rate needs more than the thirteen columns that it has.
fn rounded_rate(rate: f64) -> Option<String> {
    let step = fitted(rate.recip(), NARROW);
    let kept = step.trim().parse::<f64>().map_or(0.0, f64::recip);
    (kept != rate).then(|| {
        format!(
            "the file states the sample rate as {kept} Hz instead of {rate} Hz: its step has \
             thirteen columns; HDF5 and Parquet keep it"
        )
    })
}

/// A record on its way into the file.
struct Record<'a> {
    item: &'a Item<'a>,
    number: usize,
    /// Numbers as text (58), or binary (58b).
    text: bool,
    single: bool,
    /// Of each channel.
    times: Vec<Option<Even>>,
}

/// Part of a step by which the start that is written may be off.
const START_OFF: f64 = 0.01;

impl Record<'_> {
    /// Refuse a channel whose start needs more columns than there are, or by whose start a reader would take it for
    /// a record of its own.
    fn refuse_lost_starts(&self, samples: &[Samples]) -> Result<(), ConvertError> {
        let refuse = |channel: usize, found: &str| -> Result<(), ConvertError> {
            Err(even::refused(self.item, channel, found).into())
        };
        let timed = self.times.iter().zip(samples).enumerate();
        let mut first = None;
        let stated = self
            .attributes()
            .iter()
            .any(|l| l.contains(conventions::STARTS_KEY));
        for (channel, (times, samples)) in timed {
            let Some(times) = times else { continue };
            let kept = fitted(times.start_s, NARROW).trim().parse::<f64>();
            let near = |kept: f64| (kept - times.start_s).abs() <= START_OFF * times.step_s;
            if !kept.is_ok_and(near) {
                return refuse(
                    channel,
                    "its start has more digits than the thirteen columns hold",
                );
            }
            let span = Span {
                start_s: times.start_s,
                length_s: samples.len() as f64 * times.step_s,
            };
            let first = *first.get_or_insert(span);
            if !(stated || first.overlaps(span)) {
                return refuse(
                    channel,
                    "it was taken long before or after the first channel",
                );
            }
        }
        Ok(())
    }

    fn write(&self, samples: &[Samples], out: &mut dyn Write) -> std::io::Result<()> {
        let named = self.item.names().into_iter().zip(self.item.channels());
        let timed = named.zip(&self.times);
        for (((name, info), times), samples) in timed.zip(samples) {
            let (values, complex) = match samples {
                Samples::Real(values) => (values.clone(), false),
                Samples::Complex(values) => (
                    values.iter().flat_map(|(re, im)| [*re, *im]).collect(),
                    true,
                ),
                Samples::Text(_) => continue,
            };
            let channel = Channel {
                name: &name,
                info,
                times: *times,
            };
            self.function(&channel, &values, complex, out)?;
        }
        Ok(())
    }

    fn function(
        &self,
        channel: &Channel<'_>,
        values: &[f64],
        complex: bool,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        writeln!(out, "    -1")?;
        let width = if self.single { 4 } else { 8 };
        match self.text {
            true => writeln!(out, "    58")?,
            // byte order 1: little-endian, format 2: IEEE 754
            false => writeln!(
                out,
                "    58b{:6}{:6}{HEADER_LINES:12}{:12}{:6}{:6}{:12}{:12}",
                1,
                2,
                values.len() * width,
                0,
                0,
                0,
                0
            )?,
        }
        let points = values.len() / if complex { 2 } else { 1 };
        self.header(channel, points, complex, out)?;
        if self.text {
            self.text(values, out)?;
        } else {
            self.binary(values, out)?;
        }
        writeln!(out, "    -1")
    }

    /// Records 1 to 11 of a function.
    fn header(
        &self,
        channel: &Channel<'_>,
        points: usize,
        complex: bool,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let info = channel.info;
        let [fourth, fifth] = self.attributes();
        let time = self.start_time(info).and_then(date);
        let lines = [
            line(channel.name),
            line(&self.item.name),
            line(&time.unwrap_or_default()),
            fourth,
            fifth,
        ];
        for text in lines {
            writeln!(out, "{text}")?;
        }
        // time response, load case, no names and nodes of freedoms
        writeln!(
            out,
            "{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}",
            1, self.number, 0, self.number, "NONE", 0, 0, "NONE", 0, 0
        )?;
        let kind =
            2 + 2 * u8::from(!self.single) + u8::from(complex) * if self.single { 3 } else { 2 };
        let (start, step) = channel
            .times
            .map_or((0.0, 1.0), |times| (times.start_s, times.step_s));
        writeln!(
            out,
            "{kind:10}{points:10}{:10}{}{}{}",
            1,
            fitted(start, NARROW),
            fitted(step, NARROW),
            fitted(0.0, NARROW)
        )?;
        let abscissa = if channel.times.is_some() {
            axis(17, 0, "time", Some("s"))
        } else {
            axis(0, 0, "sample", None)
        };
        let (kind, length) = data_type(info.unit.as_deref());
        let ordinate = axis(kind, length, "NONE", info.unit.as_deref());
        let none = axis(0, 0, "NONE", None);
        for axis in [abscissa, ordinate, none.clone(), none] {
            writeln!(out, "{axis}")?;
        }
        Ok(())
    }

    /// When a channel was begun: of channels whose starts the abscissae state, the earliest.
    fn start_time<'c>(&'c self, info: &'c ChannelInfo) -> Option<&'c str> {
        let mut times = self.times.iter().flatten();
        if times.all(|t| t.start_s == 0.0) {
            return info.start_time.as_deref();
        }
        let all = self.item.channels().iter();
        all.filter_map(|c| c.start_time.as_deref()).min()
    }

    /// The attributes that keep the starts and rates of channels, as they are written.
    fn clocks(&self) -> Vec<(String, String)> {
        let written = |(info, times): (&ChannelInfo, &Option<Even>)| {
            let own_hz = times.map(|t| t.step_s.recip());
            let (clock, sample_rate_hz) = match info.clock {
                Clock::Shared => (Clock::Shared, info.sample_rate_hz),
                Clock::Rate => (Clock::Rate, info.sample_rate_hz.or(own_hz)),
                Clock::Axis(_) => (Clock::Rate, own_hz),
            };
            ChannelInfo {
                start_s: times.map(|t| t.start_s),
                sample_rate_hz,
                clock,
                ..info.clone()
            }
        };
        let channels = self.item.channels().iter().zip(&self.times);
        let channels: Vec<ChannelInfo> = channels.map(written).collect();
        conventions::attributes_of_clocks(&self.item.names(), &channels)
    }

    /// The record's attributes in two lines, as far as they go in.
    fn attributes(&self) -> [String; 2] {
        let mut lines = [String::new(), String::new()];
        let of_clocks =
            |name: &str| [conventions::STARTS_KEY, conventions::CLOCKS_KEY].contains(&name);
        let others = self.item.described().filter(|(name, _)| !of_clocks(name));
        let others = others.map(|(name, value)| (name.clone(), value.clone()));
        for (name, value) in self.clocks().into_iter().chain(others) {
            let pair = format!("{name}={value}");
            let plain = pair.is_ascii() && !pair.contains([';', '\n', '\r']);
            let fits = |l: &&mut String| l.len() + 2 + pair.len() <= LINE;
            let room = lines.iter_mut().find(fits).filter(|_| plain);
            if let Some(line) = room {
                if !line.is_empty() {
                    line.push_str("; ");
                }
                line.push_str(&pair);
            }
        }
        lines.map(|l| line(&l))
    }

    fn binary(&self, values: &[f64], out: &mut dyn Write) -> std::io::Result<()> {
        for value in values {
            if self.single {
                out.write_all(&to_f32(*value).to_le_bytes())?;
            } else {
                out.write_all(&value.to_le_bytes())?;
            }
        }
        writeln!(out)
    }

    fn text(&self, values: &[f64], out: &mut dyn Write) -> std::io::Result<()> {
        let (columns, width) = if self.single { (6, NARROW) } else { (4, WIDE) };
        for row in values.chunks(columns) {
            for value in row {
                out.write_all(fitted(*value, width).as_bytes())?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

/// A channel on its way into the file.
struct Channel<'a> {
    name: &'a str,
    info: &'a ChannelInfo,
    times: Option<Even>,
}

/// A line of identification: blanks where a file would be read otherwise, NONE for nothing.
fn line(text: &str) -> String {
    let clean: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let short = cut(clean.trim(), LINE);
    if short.is_empty() {
        "NONE".to_owned()
    } else {
        short.to_owned()
    }
}

/// At most so many bytes of a text, in whole characters.
fn cut(text: &str, most: usize) -> &str {
    let ends = text.char_indices().map(|(at, c)| at + c.len_utf8());
    let end = ends.take_while(|end| *end <= most).last().unwrap_or(0);
    &text[..end]
}

/// Records 8 to 11: specific data type, exponents of length, force, temperature, label, unit.
fn axis(kind: u32, length: i32, label: &str, unit: Option<&str>) -> String {
    let unit = unit.map_or("NONE", |u| cut(u, LABEL));
    // columns count bytes, so that names with signs beyond ASCII stay in theirs
    let padded = |text: &str| format!("{text}{}", " ".repeat(LABEL.saturating_sub(text.len())));
    format!(
        "{kind:10}{length:5}{:5}{:5} {} {}",
        0,
        0,
        padded(label),
        padded(unit)
    )
}

/// Specific data type of a unit and the exponent of its length.
fn data_type(unit: Option<&str>) -> (u32, i32) {
    match unit.and_then(parse_unit).map(|u| u.dimension) {
        Some(Dimension::Length) => (8, 1),
        Some(Dimension::Velocity) => (11, 1),
        Some(Dimension::Acceleration) => (12, 1),
        Some(Dimension::Force) => (13, 0),
        Some(Dimension::Time) => (17, 0),
        Some(Dimension::Frequency) => (18, 0),
        _ => (0, 0),
    }
}

/// A number in a field of so many columns, a blank before it: its shortest text if that goes in, else with
/// as many digits as do.
fn fitted(value: f64, width: usize) -> String {
    let room = width - 1;
    let shortest = format!("{value:E}");
    if shortest.len() <= room {
        return format!("{shortest:>width$}");
    }
    let mut digits = room;
    loop {
        let text = format!("{value:.digits$E}");
        if text.len() <= room || digits == 0 {
            return format!("{text:>width$}");
        }
        digits -= 1;
    }
}

/// A time such as `2016-04-18T13:49:58` as `18-Apr-16 13:49:58`; `None` for another form or another
/// century.
fn date(iso: &str) -> Option<String> {
    let iso = iso.replacen(' ', "T", 1);
    let (time, _) = NaiveDateTime::parse_and_remainder(&iso, "%Y-%m-%dT%H:%M:%S").ok()?;
    (1970..2070)
        .contains(&time.year())
        .then(|| time.format("%d-%b-%y %H:%M:%S").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stay_in_their_columns_and_keep_what_goes_in() {
        for value in [
            0.0,
            -0.5,
            1e-3,
            -1.25e-7,
            1.0 / 3.0,
            -1e100 / 3.0,
            f64::MIN_POSITIVE,
        ] {
            for width in [NARROW, WIDE] {
                let text = fitted(value, width);
                assert_eq!(text.len(), width, "{text}");
                assert!(text.starts_with(' '), "{text}");
                let back: f64 = text.trim().parse().expect("a number");
                let least = if width == WIDE { 1e-11 } else { 1e-4 };
                assert!(
                    (back - value).abs() <= least * value.abs(),
                    "{value} {text}"
                );
            }
        }
        assert_eq!(fitted(5e-4, NARROW).trim(), "5E-4");
    }

    #[test]
    fn times_are_those_of_the_format() {
        assert_eq!(
            date("2016-04-18T13:49:58Z").as_deref(),
            Some("18-Apr-16 13:49:58")
        );
        assert_eq!(date("1890-04-18T13:49:58"), None);
        assert_eq!(date("yesterday"), None);
    }

    #[test]
    fn texts_are_cut_between_characters() {
        assert_eq!(cut("m/s²", 4), "m/s");
        assert_eq!(cut("Novák", 80), "Novák");
    }
}
