//! A record of several settings as one record for each: cut where the frequency of its drive changes.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::Failure;
use impact_records::message::counted;
use impact_records::signal::steps::{DriveStep, steps};
use labfiles::timing::AxisUnit;
use labfiles::{Clock, DatasetInfo, ReadError, Samples, Source};

/// A file whose datasets are parts of those of another.
pub(super) struct Cut {
    source: Box<dyn Source>,
    datasets: Vec<DatasetInfo>,
    parts: Vec<Part>,
    /// The dataset that was read last, with its channels: all parts of it are read in turn.
    last: Mutex<Option<(usize, Vec<Samples>)>>,
}

/// Part of a dataset.
struct Part {
    dataset: usize,
    from: usize,
    to: usize,
}

impl Cut {
    /// The records of a file, each cut where the frequency of one channel changes. Each part has its frequency, and whether
    /// it was reached from below or above, as attributes.
    ///
    /// # Errors
    /// If a dataset lacks the channel, its tone keeps no frequency, or its channels have unlike lengths.
    pub(super) fn by(channel: &str, source: Box<dyn Source>) -> Result<Self, Failure> {
        let (mut datasets, mut parts) = (Vec::new(), Vec::new());
        for (number, set) in source.datasets().iter().enumerate() {
            let found = steps_of(source.as_ref(), number, channel)?;
            let stem = source
                .path()
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy();
            let name = if set.name.is_empty() {
                &*stem
            } else {
                set.name.as_str()
            };
            let digits = found.len().to_string().len();
            for (k, step) in found.iter().enumerate() {
                let own = format!("{name}_{:0digits$}", k + 1);
                datasets.push(part_of(set, own, step, sweep(&found, k)));
                parts.push(Part {
                    dataset: number,
                    from: step.from,
                    to: step.to,
                });
            }
        }
        Ok(Self {
            source,
            datasets,
            parts,
            last: Mutex::default(),
        })
    }

    /// What was cut, in words.
    pub(super) fn said(&self) -> String {
        let path = self.source.path().display();
        let parts = counted(self.parts.len(), "record");
        format!("{path}: cut into {parts}")
    }
}

/// The parts of a dataset in which a channel keeps a frequency.
fn steps_of(source: &dyn Source, number: usize, channel: &str) -> Result<Vec<DriveStep>, Failure> {
    let set = &source.datasets()[number];
    let path = source.path().display();
    let index = set.channel_index(channel).ok_or_else(|| {
        let names: Vec<&str> = set.channels.iter().map(|c| c.name.as_str()).collect();
        let message = format!("{path}: there is no channel '{channel}'");
        Failure::new(
            message,
            format!("name the drive's channel, one of {}", names.join(", ")),
        )
    })?;
    let count = set.channels[index].samples;
    if set
        .channels
        .iter()
        .any(|c| c.samples != count || c.clock != Clock::Shared)
    {
        let message = format!("{path}: its channels have times of their own");
        return Err(Failure::new(
            message,
            "export them with one time, and cut that file",
        ));
    }
    let rate = rate_hz(source, number, index)?.ok_or_else(|| {
        let message =
            format!("{path}: no time axis and no rate states when the samples were taken");
        Failure::new(
            message,
            "export it with its time, or cut it by hand and state sample_rate",
        )
    })?;
    let values = numbers(source, number, index)?;
    let found = steps(&values, rate);
    if found.is_empty() {
        let message = format!("{path}: '{channel}' keeps no frequency for twelve cycles");
        let remedy = "name the channel of the drive; a frequency that glides cannot be cut: let it wait at each setting until \
                      the motion has settled";
        return Err(Failure::new(message, remedy));
    }
    Ok(found)
}

/// Samples a second, by the file or by an even time axis in s.
fn rate_hz(source: &dyn Source, number: usize, index: usize) -> Result<Option<f64>, Failure> {
    let set = &source.datasets()[number];
    if let Some(rate) = set.channels[index].sample_rate_hz {
        return Ok(Some(rate));
    }
    let Some(axis) = set.time_axis else {
        return Ok(None);
    };
    let (info, times) = (&set.channels[axis], numbers(source, number, axis)?);
    let unit = AxisUnit::of(info.unit.as_deref(), &info.name, &times);
    let (Some(to_s), [first, .., last]) = (unit.seconds(), &times[..]) else {
        return Ok(None);
    };
    let rate = (times.len() - 1) as f64 / (to_s * (last - first));
    Ok(Some(rate).filter(|rate| rate.is_finite() && *rate > 0.0))
}

fn numbers(source: &dyn Source, number: usize, channel: usize) -> Result<Vec<f64>, Failure> {
    let read = source.read(number, &[channel])?.pop();
    Ok(read.and_then(Samples::into_real).unwrap_or_default())
}

/// From which side a frequency is reached; the first one as the second.
fn sweep(steps: &[DriveStep], k: usize) -> Option<&'static str> {
    let pair = if k == 0 {
        steps.get(..2)
    } else {
        steps.get(k - 1..=k)
    };
    let [before, after] = pair? else { return None };
    Some(if after.frequency_hz > before.frequency_hz {
        "up"
    } else {
        "down"
    })
}

fn part_of(set: &DatasetInfo, name: String, step: &DriveStep, sweep: Option<&str>) -> DatasetInfo {
    let mut part = DatasetInfo {
        name,
        ..set.clone()
    };
    for channel in &mut part.channels {
        channel.samples = (step.to - step.from) as u64;
    }
    let frequency = format!("{:.6}", step.frequency_hz);
    part.attributes
        .insert("drive_frequency_hz".to_owned(), frequency);
    if let Some(sweep) = sweep {
        part.attributes.insert("sweep".to_owned(), sweep.to_owned());
    }
    part
}

impl Source for Cut {
    fn format(&self) -> &'static str {
        self.source.format()
    }

    fn path(&self) -> &Path {
        self.source.path()
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.datasets
    }

    fn notes(&self) -> &[String] {
        self.source.notes()
    }

    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let part = self.parts.get(dataset);
        let Some(part) = part else {
            return self.source.read(usize::MAX, channels);
        };
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let whole = match last.take() {
            Some((number, whole)) if number == part.dataset => whole,
            _ => {
                let all: Vec<usize> = (0..self.datasets[dataset].channels.len()).collect();
                self.source.read(part.dataset, &all)?
            }
        };
        let taken = channels
            .iter()
            .filter_map(|c| Some(slice(whole.get(*c)?, part)));
        let taken: Vec<Samples> = taken.collect();
        if taken.len() < channels.len() {
            return self.source.read(part.dataset, channels);
        }
        *last = Some((part.dataset, whole));
        Ok(taken)
    }
}

fn slice(samples: &Samples, part: &Part) -> Samples {
    let range = part.from..part.to;
    match samples {
        Samples::Real(values) => Samples::Real(values[range].to_vec()),
        Samples::Complex(values) => Samples::Complex(values[range].to_vec()),
        Samples::Text(values) => Samples::Text(values[range].to_vec()),
    }
}
