//! `impactid convert`: records of any format to HDF5, Parquet or CSV.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::{Exit, Failure, Voice, interrupt};
use labfiles::convert::{self, ConvertError, Options, Target};
use labfiles::open;
use labfiles::ReadError;

/// Arguments of `impactid convert`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Convert {
    /// Record files of any supported format
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// The file to write (several records as CSV: a folder of that name)
    #[arg(long, short, value_name = "PATH")]
    out: PathBuf,
    /// What to write; without it the extension of --out says
    #[arg(long, value_enum, value_name = "FORMAT")]
    to: Option<To>,
    /// Keep numbers in single precision
    #[arg(long)]
    single: bool,
    /// An attribute for every record, unit in its name: clearance_m=0.0005
    #[arg(long, value_name = "NAME=VALUE", value_parser = name_and_value)]
    set: Vec<(String, String)>,
}

/// The formats that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum To {
    /// HDF5: one table a record
    Hdf5,
    /// Parquet: a row group a record
    Parquet,
    /// CSV: a file a record
    Csv,
}

const EXAMPLE: &str = "\
Example:
  impactid convert runs/*.tdms --out campaign.h5 --set clearance_m=0.0005
  impactid convert campaign.h5 --out records.parquet

The layout of the HDF5 file is described in docs/formats.md.
Exit codes: 0 done; 2 a file could not be read or written, and nothing is left of the output.";

fn name_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write it as NAME=VALUE, for example clearance_m=0.0005".to_owned()),
    }
}

impl Convert {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let target = match self.to {
            Some(To::Hdf5) => Some(Target::Hdf5),
            Some(To::Parquet) => Some(Target::Parquet),
            Some(To::Csv) => Some(Target::Csv),
            None => Target::of(&self.out),
        };
        let unknown = || {
            let message = format!("{}: its extension names no format", self.out.display());
            Failure::new(message, "End it in .h5, .parquet or .csv, or state --to.")
        };
        let target = target.ok_or_else(unknown)?;
        let sources = self
            .files
            .iter()
            .map(|p| open(p))
            .collect::<Result<Vec<_>, ReadError>>()?;
        for source in &sources {
            source
                .notes()
                .iter()
                .for_each(|n| voice.detail(&format!("{}: {n}", source.path().display())));
        }
        interrupt::watch(self.out.parent().map(Path::to_path_buf).unwrap_or_default());
        let options = Options {
            single_precision: self.single,
            attributes: self.set.into_iter().collect(),
        };
        let done = convert::convert(&sources, target, &self.out, &options).map_err(failure)?;
        done.notes.iter().for_each(|note| voice.say(note));
        let count = done.records;
        let many = target == Target::Csv && count > 1;
        let written = if many {
            self.out.with_extension("")
        } else {
            self.out
        };
        let records = if count == 1 { "record" } else { "records" };
        voice.say(&format!(
            "{count} {records} written to {}",
            written.display()
        ));
        Ok(Exit::Done)
    }
}

fn failure(error: ConvertError) -> Failure {
    match error {
        ConvertError::Read(error) => error.into(),
        ConvertError::Write(error) => Failure::new(error.to_string(), error.remedy()),
    }
}
