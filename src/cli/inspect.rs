//! `impactid inspect`: the channels of record files.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;
use serde::Serialize;

use super::patterns::expanded;
use super::sparkline::sparkline;
use super::stdout::{print, print_json};
use super::{Exit, Failure, Verbosity};
use impact_records::message::counted;
use labfiles::open;
use labfiles::summary::{Summary, summarise};
use labfiles::{DatasetInfo, ReadError, Samples, Source};

/// Arguments of `impactid inspect`.
#[derive(Debug, Args)]
#[command(after_help = example())]
pub(super) struct Inspect {
    /// Record files of any supported format
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Print the channels as JSON
    #[arg(long)]
    json: bool,
    /// Plot each channel
    #[arg(long, conflicts_with = "json")]
    plot: bool,
    /// Only this dataset (record) of the files
    #[arg(long, value_name = "NAME")]
    dataset: Option<String>,
    /// Show the channels of every dataset, also of many
    #[arg(long)]
    all: bool,
}

fn example() -> String {
    let titles = labfiles::format_titles().join(", ");
    format!(
        "\
Example:
  impactid inspect record.lvm --plot
  impactid inspect campaign.h5 --dataset run0001 --json

Formats: {titles} and other text tables.
Exit codes: 0 success; 2 a file could not be read."
    )
}

/// A file of more datasets is listed with one line per dataset.
const FEW: usize = 4;
/// Characters of a picture.
const PICTURE: (usize, usize) = (72, 6);

/// A channel in the JSON output.
#[derive(Serialize)]
struct Listed {
    #[serde(flatten)]
    summary: Summary,
    dataset: String,
    file: String,
}

impl Inspect {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut exit = Exit::Done;
        let mut listed = Vec::new();
        let mut text = String::new();
        let remedy = "name record files, or a pattern that matches some";
        for path in &expanded(&self.files, remedy)? {
            let done = open(path).and_then(|s| {
                if self.json {
                    self.list(&*s, &mut listed)
                } else {
                    self.describe(&*s, &mut text)
                }
            });
            print(&std::mem::take(&mut text))?;
            for error in done.unwrap_or_else(|error| vec![error]) {
                Failure::from(error).print(verbosity);
                exit = Exit::BadInput;
            }
        }
        if self.json {
            print_json(&listed)?;
        }
        Ok(exit)
    }

    /// The datasets that are asked for.
    fn chosen(&self, source: &dyn Source) -> Result<Vec<usize>, ReadError> {
        let datasets = source.datasets();
        let Some(name) = &self.dataset else {
            return Ok((0..datasets.len()).collect());
        };
        let found: Vec<usize> = (0..datasets.len())
            .filter(|&d| datasets[d].name == *name)
            .collect();
        if found.is_empty() {
            let (expected, remedy) = match datasets {
                [one] if one.name.is_empty() => (
                    "no name, as the file holds a single dataset without one".to_owned(),
                    "leave --dataset out",
                ),
                _ => (
                    named(datasets),
                    "name one of them, or leave --dataset out to see all",
                ),
            };
            return Err(ReadError::new(
                source.path(),
                expected,
                format!("--dataset {name}"),
                remedy,
            ));
        }
        Ok(found)
    }

    /// List the channels; gives what cannot be read.
    fn list(
        &self,
        source: &dyn Source,
        listed: &mut Vec<Listed>,
    ) -> Result<Vec<ReadError>, ReadError> {
        let chosen = self.chosen(source)?;
        let read: Vec<Inspected> = chosen.par_iter().map(|&d| inspected(source, d)).collect();
        let mut errors = Vec::new();
        for (&d, inspected) in chosen.iter().zip(read) {
            let summaries = inspected.summaries;
            errors.extend(inspected.errors);
            let dataset = &source.datasets()[d].name;
            let file = source.path().display().to_string();
            listed.extend(summaries.into_iter().map(|summary| Listed {
                summary,
                dataset: dataset.clone(),
                file: file.clone(),
            }));
        }
        Ok(errors)
    }

    /// Describe the datasets; gives what cannot be read.
    fn describe(
        &self,
        source: &dyn Source,
        text: &mut String,
    ) -> Result<Vec<ReadError>, ReadError> {
        let chosen = self.chosen(source)?;
        heading(source, text);
        if chosen.len() > FEW && !self.all && !self.plot {
            for &d in &chosen {
                one_line(&source.datasets()[d], text);
            }
            let _ = writeln!(text, "--dataset NAME or --all shows the channels");
            return Ok(Vec::new());
        }
        let mut errors = Vec::new();
        for d in chosen {
            let inspected = inspected(source, d);
            describe(&source.datasets()[d], &inspected.summaries, text);
            if self.plot {
                draw(&inspected.summaries, &inspected.samples, text);
            }
            errors.extend(inspected.errors);
        }
        Ok(errors)
    }
}

/// Datasets that a message names.
const NAMED: usize = 20;

/// That one of the file's datasets is expected, with their names.
fn named(datasets: &[DatasetInfo]) -> String {
    let names: Vec<&str> = datasets
        .iter()
        .take(NAMED)
        .map(|d| match d.name.as_str() {
            "" => "the one without a name",
            name => name,
        })
        .collect();
    let more = match datasets.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("one of the file's datasets: {}{more}", names.join(", "))
}

/// The channels of a dataset: their statistics, their samples, and what cannot be read of them.
struct Inspected {
    summaries: Vec<Summary>,
    samples: Vec<Samples>,
    errors: Vec<ReadError>,
}

/// Read all channels of a dataset; where that fails, one at a time, so that a faulty one does not hide
/// the others.
fn inspected(source: &dyn Source, dataset: usize) -> Inspected {
    let channels = &source.datasets()[dataset].channels;
    let all: Vec<usize> = (0..channels.len()).collect();
    let mut errors: Vec<ReadError> = Vec::new();
    let samples = source.read(dataset, &all).unwrap_or_else(|_| {
        let one = |channel: usize| match source.read(dataset, &[channel]) {
            Ok(mut read) => read.pop().unwrap_or(Samples::Text(Vec::new())),
            Err(error) => {
                if !errors.contains(&error) {
                    errors.push(error);
                }
                Samples::Text(Vec::new())
            }
        };
        all.iter().copied().map(one).collect()
    });
    let summaries = channels
        .iter()
        .zip(&samples)
        .map(|(c, s)| summarise(c, s))
        .collect();
    Inspected {
        summaries,
        samples,
        errors,
    }
}

fn heading(source: &dyn Source, text: &mut String) {
    let datasets = counted(source.datasets().len(), "dataset");
    let _ = writeln!(
        text,
        "{}: {}, {datasets}",
        source.path().display(),
        source.format()
    );
    for note in source.notes() {
        let _ = writeln!(text, "  note: {note}");
    }
}

fn one_line(info: &DatasetInfo, text: &mut String) {
    let samples = info.channels.iter().map(|c| c.samples).max().unwrap_or(0);
    let rate = info
        .sample_rate_hz()
        .map_or(String::new(), |r| format!(", {} Hz", rounded(r)));
    let channels = counted(info.channels.len(), "channel");
    let samples = counted(samples, "sample");
    let _ = writeln!(text, "  {}: {channels}, {samples}{rate}", info.name);
}

/// A rate to a thousandth, below 1 Hz to a millionth, without trailing zeros.
fn rounded(rate_hz: f64) -> String {
    let text = if rate_hz < 1.0 {
        format!("{rate_hz:.6}")
    } else {
        format!("{rate_hz:.3}")
    };
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn describe(info: &DatasetInfo, summaries: &[Summary], text: &mut String) {
    if !info.name.is_empty() {
        let _ = writeln!(text, "{}", info.name);
    }
    for (key, value) in &info.attributes {
        let _ = writeln!(text, "  {key} = {value}");
    }
    let mut rows = vec![
        [
            "channel", "unit", "type", "samples", "rate Hz", "first", "last", "min", "max",
        ]
        .map(str::to_owned),
    ];
    for (i, s) in summaries.iter().enumerate() {
        let axis = if info.time_axis == Some(i) {
            " (time axis)"
        } else {
            ""
        };
        rows.push([
            format!("{}{axis}", s.name),
            s.unit.clone().unwrap_or_else(|| "-".to_owned()),
            s.stored.clone(),
            s.samples.to_string(),
            s.sample_rate_hz.map_or_else(|| "-".to_owned(), rounded),
            s.texts
                .as_ref()
                .map_or_else(|| s.first.to_string(), |t| t[0].clone()),
            s.texts
                .as_ref()
                .map_or_else(|| s.last.to_string(), |t| t[1].clone()),
            s.min.to_string(),
            s.max.to_string(),
        ]);
    }
    table(&rows, text);
}

/// Aligned columns: words to the left, numbers to the right.
fn table(rows: &[[String; 9]], text: &mut String) {
    let width = |column: usize| {
        rows.iter()
            .map(|r| r[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: [usize; 9] = std::array::from_fn(width);
    for row in rows {
        let cells = row
            .iter()
            .zip(widths)
            .enumerate()
            .map(|(i, (cell, w))| match i {
                0..=2 => format!("{cell:<w$}"),
                _ => format!("{cell:>w$}"),
            });
        let _ = writeln!(
            text,
            "  {}",
            cells.collect::<Vec<_>>().join("  ").trim_end()
        );
    }
}

fn draw(summaries: &[Summary], samples: &[Samples], text: &mut String) {
    for (summary, samples) in summaries.iter().zip(samples) {
        let real: Vec<f64> = match samples {
            Samples::Real(values) => values.clone(),
            Samples::Complex(values) => values.iter().map(|v| v.0.hypot(v.1)).collect(),
            Samples::Text(_) => continue,
        };
        let lines = sparkline(&real, PICTURE.0, PICTURE.1);
        let unit = summary.unit.as_deref().unwrap_or("");
        let _ = writeln!(text, "\n  {} {unit}", summary.name);
        for (i, line) in lines.iter().enumerate() {
            let mark = match i {
                0 => summary.max.to_string(),
                i if i + 1 == lines.len() => summary.min.to_string(),
                _ => String::new(),
            };
            let _ = writeln!(text, "  {mark:>11} {line}");
        }
        let _ = writeln!(
            text,
            "  {:>11} {}",
            "",
            time_axis(summary.samples, summary.sample_rate_hz)
        );
    }
}

/// The line below a picture: where it begins and ends, in seconds, or in samples where no rate is known.
fn time_axis(samples: u64, rate_hz: Option<f64>) -> String {
    let last = samples.saturating_sub(1);
    let (begin, end) = match rate_hz.filter(|rate| *rate > 0.0) {
        Some(rate) => (
            "0 s".to_owned(),
            format!("{} s", rounded(last as f64 / rate)),
        ),
        None => ("sample 0".to_owned(), last.to_string()),
    };
    let room = PICTURE.0.saturating_sub(begin.len());
    format!("{begin}{end:>room$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_states_its_times() {
        let line = time_axis(2001, Some(1000.0));
        assert!(line.starts_with("0 s ") && line.ends_with(" 2 s"), "{line}");
        assert_eq!(line.chars().count(), PICTURE.0);
        assert!(time_axis(2001, None).ends_with(" 2000"));
    }

    #[test]
    fn datasets_without_a_name_are_listed_as_such() {
        let set = |name: &str| DatasetInfo {
            name: name.to_owned(),
            ..DatasetInfo::default()
        };
        assert_eq!(
            named(&[set(""), set("S(1)")]),
            "one of the file's datasets: the one without a name, S(1)"
        );
    }

    #[test]
    fn rates_are_rounded() {
        let rounded: Vec<String> = [2000.0, 9.448_598_374_562_737, 0.012_345_678, 0.5]
            .into_iter()
            .map(rounded)
            .collect();
        assert_eq!(rounded, ["2000", "9.449", "0.012346", "0.5"]);
    }
}
