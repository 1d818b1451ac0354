//! A record to be converted, and what all targets share.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::hdf5::WriteError;
use labfiles::attribute;
use labfiles::conventions::{COLUMNS_KEY, RECORDS_KEY, TEXTS_KEY};
use labfiles::name_and_unit;
use labfiles::{ChannelInfo, ReadError, Samples, Source, StoredType};

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
    /// Store numbers in single precision (HDF5 and Parquet).
    pub single_precision: bool,
    /// Attributes added to every record; they replace those of the file.
    pub attributes: BTreeMap<String, String>,
}

/// What is to be said of records, once for all of which the same is.
pub(super) fn grouped<N: IntoIterator<Item = String>>(
    items: &[Item<'_>],
    notes: impl Fn(&Item<'_>) -> N,
) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for item in items {
        for note in notes(item) {
            match groups.iter_mut().find(|(known, _)| *known == note) {
                Some((_, names)) => names.push(&item.name),
                None => groups.push((note, vec![&item.name])),
            }
        }
    }
    let of = |(note, names): (String, Vec<&str>)| match names[..] {
        [name] => format!("record '{name}': {note}"),
        _ => format!("{} records from '{}' on: {note}", names.len(), names[0]),
    };
    groups.into_iter().map(of).collect()
}

/// One record of a source, read when it is written.
pub(super) struct Item<'a> {
    /// Its name in the output.
    pub(super) name: String,
    pub(super) source: &'a dyn Source,
    pub(super) dataset: usize,
    pub(super) attributes: BTreeMap<String, String>,
}

impl Item<'_> {
    pub(super) fn has_numbers(&self) -> bool {
        let mut channels = self.channels().iter();
        channels.any(|c| c.stored != StoredType::Text)
    }

    pub(super) fn channels(&self) -> &[ChannelInfo] {
        &self.source.datasets()[self.dataset].channels
    }

    /// The channels' names, each once: the second `X_Value` becomes `X_Value 2`.
    pub(super) fn names(&self) -> Vec<String> {
        let mut taken = BTreeSet::new();
        let channels = self.channels().iter();
        channels.map(|c| once(&c.name, ' ', &mut taken)).collect()
    }

    /// The channels in columns of their own: real and imaginary parts apart.
    pub(super) fn columns(&self) -> Result<Vec<Column>, ReadError> {
        let mut all = Vec::new();
        let named = self.names().into_iter().zip(self.channels());
        for ((name, info), samples) in named.zip(self.read()?) {
            let mut push = |name, samples| {
                let unit = info.unit.clone();
                all.push(Column {
                    name,
                    unit,
                    samples,
                });
            };
            match samples {
                Samples::Complex(values) => {
                    let (re, im) = values.into_iter().unzip();
                    push(format!("{name}.re"), Samples::Real(re));
                    push(format!("{name}.im"), Samples::Real(im));
                }
                other => push(name, other),
            }
        }
        Ok(all)
    }

    pub(super) fn read(&self) -> Result<Vec<Samples>, ReadError> {
        let all: Vec<usize> = (0..self.channels().len()).collect();
        self.source.read(self.dataset, &all)
    }

    /// The record's rate: what its channels share, else what its attributes state.
    pub(super) fn sample_rate_hz(&self) -> Option<f64> {
        let shared = self.source.datasets()[self.dataset].sample_rate_hz();
        shared.or_else(|| attribute::sample_rate_hz(&self.attributes))
    }

    pub(super) fn start_time(&self) -> Option<&str> {
        self.channels().iter().find_map(|c| c.start_time.as_deref())
    }

    /// All that the record states, as text: attributes, rate and start.
    pub(super) fn stated(&self) -> impl Iterator<Item = (String, String)> {
        let own = self.described().map(|(k, v)| (k.clone(), v.clone()));
        let rate = self.sample_rate_hz().map(|r| r.to_string());
        let rate = rate.map(|r| ("sample_rate_hz".to_owned(), r));
        let start = self.start_time();
        let start = start.map(|s| ("start_time".to_owned(), s.to_owned()));
        own.chain(rate).chain(start)
    }

    /// The attributes to write: the record's own without those that the target writes otherwise.
    pub(super) fn described(&self) -> impl Iterator<Item = (&String, &String)> {
        const ELSEWHERE: [&str; 12] = [
            "channels",
            "units",
            "scale",
            "offset",
            "sample_rate_hz",
            "impactid_layout",
            "names",
            "columns",
            "start_time",
            RECORDS_KEY,
            COLUMNS_KEY,
            TEXTS_KEY,
        ];
        self.attributes
            .iter()
            .filter(|(k, _)| !ELSEWHERE.contains(&k.as_str()))
    }
}

/// A column of real numbers or texts.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    pub(super) samples: Samples,
}

impl Column {
    pub(super) fn heading(&self) -> String {
        heading(&self.name, self.unit.as_deref())
    }
}

/// A name with its unit, as the heading of a column: `velocity_x [mm/s]`.
pub(super) fn heading(name: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) => format!("{name} [{unit}]"),
        // brackets in the name are no unit
        None if name_and_unit(name).1.is_some() || name.ends_with("[]") => format!("{name} []"),
        None => name.to_owned(),
    }
}

/// A name that is not taken yet: itself, or itself with a number after the mark.
pub(super) fn once(plain: &str, mark: char, taken: &mut BTreeSet<String>) -> String {
    let mut name = plain.to_owned();
    let mut number = 2;
    while !taken.insert(name.clone()) {
        name = format!("{plain}{mark}{number}");
        number += 1;
    }
    name
}

pub(super) fn io(path: &Path) -> impl Fn(std::io::Error) -> WriteError {
    let path: PathBuf = path.to_path_buf();
    move |source| WriteError::Io {
        path: path.clone(),
        source,
    }
}
