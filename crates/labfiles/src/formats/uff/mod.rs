//! Universal files: functions of set 58, as text and binary (58b).
//!
//! How a file maps to datasets and channels:
//!
//! - Every function is a channel. Functions that follow each other with the same abscissa (an
//!   uneven one is compared value by value), or at even times of which they have half in common, form
//!   one dataset, and so do those of `labfiles-write` whose lines state the starts of a record's
//!   channels; a channel that comes again with the same names, or at another time (third line) or load
//!   case, begins the next. A file of one record has a dataset without a name, else datasets are
//!   numbered from 1, but for those of `labfiles-write`, which are named by their second lines.
//! - A channel is named by the response's entity name, else node and direction (`3:+Z`), else the
//!   first line, else the ordinate's label: the first of these that distinguishes the channels of the
//!   dataset apart. All header fields are properties.
//! - An even abscissa of time gives the sample rate, in its unit if it states one. Any other
//!   abscissa (frequency, or uneven time) is the dataset's first channel.
//! - The unit is that of the ordinate (`(numerator)/(denominator)` of a frequency response);
//!   if it is missing and a set 164 names the unit system, it follows from the data type.
//! - Sets 151 and 164 give attributes, and lines 4 and 5 of a function where they are `name=value; …`. All other sets are skipped with a note.
//! - A function that holds fewer points than its header states is read as far as it goes, with a
//!   note: long throughputs are often cut.

mod arrange;
mod ascii;
mod header;
mod samples;
mod sets;
#[cfg(test)]
mod tests;

use std::path::Path;

use samples::Side;
use sets::Sets;

use crate::bytes::FileBytes;
use crate::source::{ReadError, Reader, Samples, Source, opened};

/// Whether a file's first line is the mark that begins a set: `    -1`.
pub(crate) fn recognises(head: &[u8]) -> bool {
    let line = head
        .split(|b| matches!(b, b'\n' | b'\r'))
        .next()
        .unwrap_or(&[]);
    sets::is_mark(line)
}

/// Open a universal file: headers are read and the ends of sets found; of the samples only uneven
/// abscissae are read, which state what belongs to one record.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let file = FileBytes::open(path)?;
    let sets = sets::scan(&file)?;
    let (datasets, origins) = arrange::arrange(&file, &sets);
    let mut notes = sets.notes.clone();
    if !sets.skipped.is_empty() {
        let each = sets
            .skipped
            .iter()
            .map(|(name, count)| format!("{name} ({count})"));
        notes.push(format!(
            "sets not read: {}",
            each.collect::<Vec<_>>().join(", ")
        ));
    }
    let reader = UniversalFile {
        file,
        sets,
        origins,
    };
    opened("uff", path, datasets, notes, reader)
}

struct UniversalFile {
    file: FileBytes,
    sets: Sets,
    /// Function and side of each channel.
    origins: Vec<Vec<(usize, Side)>>,
}

impl Reader for UniversalFile {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        self.file.still_whole()?;
        let read = |&channel: &usize| {
            let (function, side) = self.origins[dataset][channel];
            let function = &self.sets.functions[function];
            samples::read(&self.file, function, side)
                .map_err(|e| e.channel(&function.header.lines[0]))
        };
        channels.iter().map(read).collect()
    }
}
