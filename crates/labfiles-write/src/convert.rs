//! Records of any format to HDF5, Parquet, CSV or universal files, self-describing.
//!
//! ```
//! use labfiles_write::convert::{Options, Target, convert};
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("run.csv");
//! # std::fs::write(&path, "t [s],x [mm]\n0,1\n0.5,2\n1,3\n")?;
//! let sources = [labfiles::open(&path)?];
//! let out = folder.path().join("run.parquet");
//! let target = Target::of(&out).ok_or("no format has this extension")?;
//! let done = convert(&sources, target, &out, &Options::default())?;
//! assert_eq!(done.records, 1);
//! assert_eq!(labfiles::open(&out)?.read(0, &[1])?, sources[0].read(0, &[1])?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod csv;
mod even;
mod file_names;
mod hdf5;
mod item;
mod parquet;
mod uff;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::convert::item::{Item, grouped, once};
use labfiles::conventions;
use labfiles::{ReadError, Source, StoredType};

pub use crate::convert::item::{ConvertError, Options};

/// What to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// One HDF5 file in the layout of [`crate::hdf5`].
    Hdf5,
    /// One Parquet file: wide for one record, long by record for several.
    Parquet,
    /// One CSV file for one record, a folder of CSV files for several.
    Csv,
    /// One universal file of functions (58b): binary.
    Uff,
    /// The same as text (58), in which numbers have at most about 13 digits.
    UffText,
}

impl Target {
    /// The target of a path's extension.
    ///
    /// ```
    /// use labfiles_write::convert::Target;
    /// assert_eq!(Target::of("all.H5".as_ref()), Some(Target::Hdf5));
    /// assert_eq!(Target::of("all.xlsx".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "h5" | "hdf5" | "hdf" => Some(Self::Hdf5),
            "parquet" | "pq" => Some(Self::Parquet),
            "csv" => Some(Self::Csv),
            "uff" | "unv" | "uf" => Some(Self::Uff),
            _ => None,
        }
    }
}

/// The result of a conversion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Converted {
    /// Number of records.
    pub records: usize,
    /// Notes on what the output cannot hold, for the user.
    pub notes: Vec<String>,
}

/// The files that [`convert`] writes: `out`, or for several records as CSV those of its folder.
pub fn files(
    sources: &[Box<dyn Source>],
    target: Target,
    out: &Path,
    options: &Options,
) -> Vec<PathBuf> {
    match target {
        Target::Csv => csv::files(&items(sources, options), out),
        _ => vec![out.to_path_buf()],
    }
}

/// Convert all records of the sources to one output; files that are there are written over.
///
/// # Errors
/// If a record cannot be read, no record holds numbers or the output cannot be written;
/// nothing is left then.
pub fn convert(
    sources: &[Box<dyn Source>],
    target: Target,
    out: &Path,
    options: &Options,
) -> Result<Converted, ConvertError> {
    let mut items = items(sources, options);
    let (tables, text) = match target {
        Target::Parquet | Target::Csv => (true, false),
        Target::Hdf5 | Target::Uff => (false, false),
        Target::UffText => (false, true),
    };
    let note = match target {
        _ if tables => filled_up,
        Target::Hdf5 => series_of_texts_left_out,
        _ => texts_left_out,
    };
    let mut notes = grouped(&items, note);
    if matches!(target, Target::Uff | Target::UffText) {
        notes.extend(uff::notes(&items, text, options.single_precision));
    }
    items.retain(|item| tables || item.has_numbers());
    if !items.iter().any(Item::has_numbers) {
        return Err(ConvertError::Read(without_numbers(sources)));
    }
    match target {
        Target::Hdf5 => hdf5::write(&items, out, options)?,
        Target::Parquet => parquet::write(&items, out, options)?,
        Target::Csv => csv::write(&items, out)?,
        Target::Uff | Target::UffText => uff::write(&items, out, options, text)?,
    }
    Ok(Converted {
        records: items.len(),
        notes,
    })
}

/// That a record has texts, which universal files cannot hold.
fn texts_left_out(item: &Item<'_>) -> Option<String> {
    left_out(item, |_| true)
}

/// That a record has texts beside those that are its attributes, which its samples in HDF5 cannot hold.
fn series_of_texts_left_out(item: &Item<'_>) -> Option<String> {
    let is_attribute = |name: &str| item.attributes.iter().any(|(own, _)| own == name);
    left_out(item, |name| !is_attribute(name))
}

/// That texts of some names are left out.
fn left_out(item: &Item<'_>, concerns: impl Fn(&str) -> bool) -> Option<String> {
    let texts = item.channels().iter();
    let texts = texts.filter(|c| c.stored == StoredType::Text && concerns(&c.name));
    let names: Vec<&str> = texts.map(|c| c.name.as_str()).collect();
    let said = |names: String| format!("texts are left out ({names}); Parquet and CSV keep them");
    (!names.is_empty()).then(|| said(names.join(", ")))
}

/// That a record has channels of several lengths, which the columns of a table cannot have.
fn filled_up(item: &Item<'_>) -> Option<String> {
    let channels = item.channels();
    let longest = channels.iter().map(|c| c.samples).max()?;
    let shorter = channels.iter().filter(|c| c.samples < longest);
    let names: Vec<&str> = shorter.map(|c| c.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        let names = names.join(", ");
        format!(
            "empty cells fill shorter channels up to {longest} rows ({names}); HDF5 keeps their lengths"
        )
    })
}

fn without_numbers(sources: &[Box<dyn Source>]) -> ReadError {
    let path = sources.first().map_or(Path::new(""), |s| s.path());
    ReadError::new(
        path,
        "a channel of numbers to convert",
        "none",
        "list its channels; the measurement may be in another file",
    )
}

/// The records with unique names: the file's if it holds one, the dataset's if there is one file,
/// else `file/dataset`.
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
            let mut item = Item {
                name,
                source: &**source,
                dataset,
                attributes,
            };
            let clocks = conventions::attributes_of_clocks(&item.names(), &info.channels);
            item.attributes.extend(clocks);
            items.push(item);
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

#[cfg(test)]
mod tests;
