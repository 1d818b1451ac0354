//! Records of any format written anew: HDF5, Parquet or CSV, self-describing.

mod csv;
mod hdf5;
mod parquet;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::attribute;
use crate::csv::TEXTS_KEY;
use crate::csv::header::name_and_unit;
use crate::hdf5_write::WriteError;
use crate::source::{ChannelInfo, ReadError, Samples, Source, StoredType};

/// What to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// One HDF5 file in the layout of `docs/formats.md`.
    Hdf5,
    /// One Parquet file: wide for one record, long by record for several.
    Parquet,
    /// One CSV file for one record, a folder of CSV files for several.
    Csv,
}

impl Target {
    /// The target that a path's extension says.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "h5" | "hdf5" | "hdf" => Some(Self::Hdf5),
            "parquet" | "pq" => Some(Self::Parquet),
            "csv" => Some(Self::Csv),
            _ => None,
        }
    }
}

/// Why records could not be converted.
#[derive(Debug, thiserror::Error)]
pub enum ConvertError {
    /// A record could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The output could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// How to write.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Keep numbers in single precision (HDF5 and Parquet).
    pub single_precision: bool,
    /// Attributes that every record gains, over those of the file.
    pub attributes: BTreeMap<String, String>,
}

/// One record of a source, to be read when its turn comes.
pub struct Item<'a> {
    /// Its name in the output.
    pub name: String,
    source: &'a dyn Source,
    dataset: usize,
    attributes: BTreeMap<String, String>,
}

impl Item<'_> {
    fn has_numbers(&self) -> bool {
        let mut channels = self.channels().iter();
        channels.any(|c| c.stored != StoredType::Text)
    }

    fn channels(&self) -> &[ChannelInfo] {
        &self.source.datasets()[self.dataset].channels
    }

    /// The channels' names, each once: the second `X_Value` becomes `X_Value 2`.
    fn names(&self) -> Vec<String> {
        let mut taken = BTreeSet::new();
        let channels = self.channels().iter();
        channels.map(|c| once(&c.name, ' ', &mut taken)).collect()
    }

    /// What stands above the channels in a table.
    fn headings(&self) -> impl Iterator<Item = Heading<'_>> {
        let named = self.names().into_iter().zip(self.channels());
        named.map(|(name, channel)| Heading {
            name,
            unit: channel.unit.as_deref(),
        })
    }

    fn read(&self) -> Result<Vec<Samples>, ReadError> {
        let all: Vec<usize> = (0..self.channels().len()).collect();
        self.source.read(self.dataset, &all)
    }

    /// The record's rate: what its channels share, else what its attributes state.
    fn sample_rate_hz(&self) -> Option<f64> {
        let shared = self.source.datasets()[self.dataset].sample_rate_hz();
        shared.or_else(|| attribute::sample_rate_hz(&self.attributes))
    }

    fn start_time(&self) -> Option<&str> {
        self.channels().iter().find_map(|c| c.start_time.as_deref())
    }

    /// The attributes to write: the record's own without those that are written in other ways.
    fn described(&self) -> impl Iterator<Item = (&String, &String)> {
        const ELSEWHERE: [&str; 11] = [
            "channels",
            "units",
            "scale",
            "offset",
            "sample_rate_hz",
            "impactid_layout",
            "names",
            "columns",
            "start_time",
            crate::parquet::RECORDS_KEY,
            TEXTS_KEY,
        ];
        self.attributes
            .iter()
            .filter(|(k, _)| !ELSEWHERE.contains(&k.as_str()))
    }
}

/// What a conversion has written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Converted {
    /// Number of records.
    pub records: usize,
    /// What the output cannot hold, for the user.
    pub notes: Vec<String>,
}

/// What stands above a channel in a table.
struct Heading<'a> {
    name: String,
    unit: Option<&'a str>,
}

impl Heading<'_> {
    /// The name with its unit: `velocity_x [mm/s]`.
    fn whole(&self) -> String {
        self.part("")
    }

    /// The name of a part with its unit: `force.re [N]`.
    fn part(&self, part: &str) -> String {
        let name = format!("{}{part}", self.name);
        match self.unit {
            Some(unit) => format!("{name} [{unit}]"),
            // brackets in the name are no unit
            None if name_and_unit(&name).1.is_some() || name.ends_with("[]") => {
                format!("{name} []")
            }
            None => name,
        }
    }
}

/// Convert all records of the sources to one output.
///
/// # Errors
/// Where a record cannot be read, no record holds numbers or the output cannot be written;
/// nothing is left then.
pub fn convert(
    sources: &[Box<dyn Source>],
    target: Target,
    out: &Path,
    options: &Options,
) -> Result<Converted, ConvertError> {
    let mut items = items(sources, options);
    let notes = match target {
        Target::Hdf5 => items.iter().filter_map(texts_left_out).collect(),
        Target::Parquet | Target::Csv => items.iter().filter_map(filled_up).collect(),
    };
    if target == Target::Hdf5 {
        items.retain(Item::has_numbers);
    }
    if !items.iter().any(Item::has_numbers) {
        return Err(ConvertError::Read(without_numbers(sources)));
    }
    match target {
        Target::Hdf5 => hdf5::write(&items, out, options)?,
        Target::Parquet => parquet::write(&items, out, options)?,
        Target::Csv => csv::write(&items, out)?,
    }
    Ok(Converted {
        records: items.len(),
        notes,
    })
}

/// A note where a record has texts, which the layout of the HDF5 file has no place for.
fn texts_left_out(item: &Item) -> Option<String> {
    let texts = item.channels().iter();
    let texts = texts.filter(|c| c.stored == StoredType::Text);
    let names: Vec<&str> = texts.map(|c| c.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        let names = names.join(", ");
        format!(
            "record '{}': texts are left out ({names}); Parquet and CSV keep them",
            item.name
        )
    })
}

/// A note where a record has channels of several lengths, which the columns of a table cannot be.
fn filled_up(item: &Item) -> Option<String> {
    let channels = item.channels();
    let longest = channels.iter().map(|c| c.samples).max()?;
    let shorter = channels.iter().filter(|c| c.samples < longest);
    let names: Vec<&str> = shorter.map(|c| c.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        let names = names.join(", ");
        format!(
            "record '{}': empty cells fill shorter channels up to {longest} rows ({names}); HDF5 \
             keeps their lengths",
            item.name
        )
    })
}

fn without_numbers(sources: &[Box<dyn Source>]) -> ReadError {
    let path = sources.first().map_or(Path::new(""), |s| s.path());
    ReadError::new(
        path,
        "a channel of numbers to convert",
        "none",
        "Look at the file with `impactid inspect`; the measurement may lie in another one.",
    )
}

/// The records with names that are unique: the file's where it holds one, `file/dataset` where
/// there are several files, the dataset's where there is one file.
fn items<'a>(sources: &'a [Box<dyn Source>], options: &Options) -> Vec<Item<'a>> {
    let mut taken = BTreeSet::new();
    let mut items = Vec::new();
    for source in sources {
        let stem = source
            .path()
            .file_stem()
            .map_or("record".into(), |s| s.to_string_lossy());
        for (dataset, info) in source.datasets().iter().enumerate() {
            let plain = match (info.name.is_empty(), sources.len()) {
                (true, _) => stem.to_string(),
                (false, 1) => info.name.clone(),
                (false, _) => format!("{stem}/{}", info.name),
            };
            let name = unique(&plain, &mut taken);
            let mut attributes = info.attributes.clone();
            attributes.extend(options.attributes.clone());
            items.push(Item {
                name,
                source: &**source,
                dataset,
                attributes,
            });
        }
    }
    items
}

fn unique(plain: &str, taken: &mut BTreeSet<String>) -> String {
    let parts: Vec<&str> = plain
        .split('/')
        .filter(|p| !p.is_empty() && *p != ".")
        .collect();
    let plain = if parts.is_empty() {
        "record".to_owned()
    } else {
        parts.join("/")
    };
    once(&plain, '_', taken)
}

/// A name that is not taken yet: itself, or itself with a number behind the mark.
fn once(plain: &str, mark: char, taken: &mut BTreeSet<String>) -> String {
    let mut name = plain.to_owned();
    let mut number = 2;
    while !taken.insert(name.clone()) {
        name = format!("{plain}{mark}{number}");
        number += 1;
    }
    name
}

fn io(path: &Path) -> impl Fn(std::io::Error) -> WriteError {
    let path: PathBuf = path.to_path_buf();
    move |source| WriteError::Io {
        path: path.clone(),
        source,
    }
}

#[cfg(test)]
mod tests;
