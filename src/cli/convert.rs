//! `impactid convert`: records of any format to HDF5, Parquet, CSV or universal files.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::cut::Cut;
use super::patterns::expanded;
use super::read_log::ReadLog;
use super::{Exit, Failure, Verbosity, interrupt};
use impact_records::message::counted;
use labfiles::{ReadError, Source};
use labfiles_write::convert::{self, ConvertError, Options, Target};

/// Arguments of `impactid convert`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Convert {
    /// Record files of any supported format
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// File to write (several records as CSV: a folder of that name)
    #[arg(long, short, value_name = "PATH")]
    out: PathBuf,
    /// Format to write [default: from the extension of --out]
    #[arg(long, value_enum, value_name = "FORMAT")]
    to: Option<To>,
    /// Store numbers in single precision
    #[arg(long)]
    single: bool,
    /// Attribute for every record, with the unit in its name: `clearance_m=0.0005`
    #[arg(long, value_name = "NAME=VALUE", value_parser = name_and_value)]
    set: Vec<(String, String)>,
    /// Cut each record where the frequency of this channel changes: that of the drive, in a file of many settings
    #[arg(long, value_name = "CHANNEL")]
    cut: Option<String>,
    /// Overwrite existing files, but never one that is read
    #[arg(long)]
    force: bool,
}

/// The formats that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum To {
    /// HDF5: one table per record
    Hdf5,
    /// Parquet: one row group per record
    Parquet,
    /// CSV: one file per record
    Csv,
    /// Universal file, binary (58b): one function per channel
    Uff,
    /// Universal file as text (58): about 13 digits of each number
    UffText,
}

const EXAMPLE: &str = "\
Example:
  impactid convert runs/*.tdms --out campaign.h5 --set clearance_m=0.0005
  impactid convert campaign.h5 --out records.parquet
  impactid convert campaign.h5 --out records.uff
  impactid convert sweep.csv --cut generator --set clearance_m=0.0005 --out cut.csv

The layout of the HDF5 file is described in docs/formats.md.
Files that are there are overwritten with --force only.
Exit codes: 0 success; 2 a file could not be read or written (then no output is left).";

/// An attribute that is not a name and a value.
#[derive(Debug, thiserror::Error)]
#[error("write it as NAME=VALUE, for example clearance_m=0.0005")]
struct NotNameAndValue;

fn name_and_value(text: &str) -> Result<(String, String), NotNameAndValue> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err(NotNameAndValue),
    }
}

impl Convert {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let target = match self.to {
            Some(To::Hdf5) => Some(Target::Hdf5),
            Some(To::Parquet) => Some(Target::Parquet),
            Some(To::Csv) => Some(Target::Csv),
            Some(To::Uff) => Some(Target::Uff),
            Some(To::UffText) => Some(Target::UffText),
            None => Target::of(&self.out),
        };
        let unknown = || {
            let message = format!(
                "{}: the extension is not that of a format",
                self.out.display()
            );
            Failure::new(
                message,
                "end it in .h5, .parquet, .csv or .uff, or give --to",
            )
        };
        let target = target.ok_or_else(unknown)?;
        let remedy = "name record files, or a pattern that matches some";
        let files = expanded(&self.files, remedy)?;
        let log = ReadLog::new(verbosity);
        let sources = files
            .iter()
            .map(|p| log.open(p))
            .collect::<Result<Vec<_>, ReadError>>()?;
        log.print();
        let sources = cut(sources, self.cut.as_deref(), verbosity)?;
        let options = Options {
            single_precision: self.single,
            attributes: self.set.into_iter().collect(),
        };
        let written = convert::files(&sources, target, &self.out, &options);
        refuse_inputs(&written, &files)?;
        if !self.force {
            refuse_existing(&written)?;
        }
        interrupt::watch(self.out.parent().map(Path::to_path_buf).unwrap_or_default());
        let done = convert::convert(&sources, target, &self.out, &options).map_err(failure)?;
        done.notes.iter().for_each(|note| verbosity.info(note));
        let count = done.records;
        let many = target == Target::Csv && count > 1;
        let written = if many {
            self.out.with_extension("")
        } else {
            self.out
        };
        let records = counted(count, "record");
        verbosity.info(&format!("{records} written to {}", written.display()));
        Ok(Exit::Done)
    }
}

/// The sources, each cut by a channel if one is named.
fn cut(
    sources: Vec<Box<dyn Source>>,
    channel: Option<&str>,
    verbosity: Verbosity,
) -> Result<Vec<Box<dyn Source>>, Failure> {
    let Some(channel) = channel else {
        return Ok(sources);
    };
    let of = |source| -> Result<Box<dyn Source>, Failure> {
        let cut = Cut::by(channel, source)?;
        verbosity.info(&cut.said());
        Ok(Box::new(cut))
    };
    sources.into_iter().map(of).collect()
}

/// Refuse to write over a file that is read.
fn refuse_inputs(written: &[PathBuf], files: &[PathBuf]) -> Result<(), Failure> {
    let real = |path: &PathBuf| path.canonicalize().ok();
    let written: HashSet<PathBuf> = written.iter().filter_map(real).collect();
    let is_written = |file: &&PathBuf| real(file).is_some_and(|file| written.contains(&file));
    files.iter().find(is_written).map_or(Ok(()), |file| {
        Err(Failure::new(
            format!("{} is read and would be written over", file.display()),
            "name another file with --out",
        ))
    })
}

/// Refuse to write over files that are there.
fn refuse_existing(written: &[PathBuf]) -> Result<(), Failure> {
    let mut existing = written.iter().filter(|path| path.exists());
    let Some(first) = existing.next() else {
        return Ok(());
    };
    let message = match existing.count() {
        0 => format!("{} exists already", first.display()),
        n => format!("{} and {n} more files exist already", first.display()),
    };
    let remedy = "name another file with --out, or add --force to overwrite";
    Err(Failure::new(message, remedy))
}

fn failure(error: ConvertError) -> Failure {
    match error {
        ConvertError::Read(error) => error.into(),
        ConvertError::Write(error) => Failure::new(error.to_string(), error.remedy()),
    }
}
