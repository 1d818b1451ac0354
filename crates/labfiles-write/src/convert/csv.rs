//! Records to CSV: remarks, a header with units, one row per sample.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::convert::file_names;
use crate::convert::item::{Column, ConvertError, Item, io};
use crate::output::{write_folder_whole_or, write_whole_or};
use labfiles::Samples;
use labfiles::conventions::TEXTS_KEY;

/// Write one record to a file, or several to the files of a folder.
pub(super) fn write(items: &[Item<'_>], out: &Path) -> Result<(), ConvertError> {
    if let [item] = items {
        return one(item, out, out);
    }
    let target = out.with_extension("");
    let fill = |folder: &Path| {
        items
            .iter()
            .zip(names(items))
            .try_for_each(|(item, name)| one(item, &folder.join(&name), &target.join(&name)))
    };
    write_folder_whole_or(&target, fill, |source| io(&target)(source).into())
}

/// The files that [`write`] writes.
pub(super) fn files(items: &[Item<'_>], out: &Path) -> Vec<PathBuf> {
    if items.len() == 1 {
        return vec![out.to_path_buf()];
    }
    let target = out.with_extension("");
    names(items).iter().map(|name| target.join(name)).collect()
}

/// The names of the files of several records.
fn names(items: &[Item<'_>]) -> Vec<String> {
    let names = file_names::of_records(items.iter().map(|item| item.name.as_str()));
    names.iter().map(|name| format!("{name}.csv")).collect()
}

/// Write a record to a file that has another name in an error.
fn one(item: &Item<'_>, path: &Path, named: &Path) -> Result<(), ConvertError> {
    let columns = item.columns()?;
    Ok(write_whole_or(path, |out| rows(item, &columns, out), |e| e).map_err(io(named))?)
}

fn rows(item: &Item<'_>, columns: &[Column], mut out: impl Write) -> std::io::Result<()> {
    for (key, value) in item.stated() {
        writeln!(out, "# {key} = {}", value.replace(['\n', '\r'], " "))?;
    }
    let text = |c: &Column| matches!(c.samples, Samples::Text(_));
    let texts = columns.iter().enumerate().filter(|(_, c)| text(c));
    let texts: Vec<String> = texts.map(|(i, _)| (i + 1).to_string()).collect();
    if !texts.is_empty() {
        writeln!(out, "# {TEXTS_KEY} = {}", texts.join(" "))?;
    }
    // Headings of texts are quoted in any case: a reader learns early that there are quotes.
    let heading = |c: &Column| {
        if text(c) {
            in_quotes(&c.heading())
        } else {
            quoted(&c.heading())
        }
    };
    let headings: Vec<String> = columns.iter().map(heading).collect();
    writeln!(out, "{}", headings.join(","))?;
    let longest = columns.iter().map(|c| c.samples.len()).max().unwrap_or(0);
    for row in 0..longest {
        for (i, column) in columns.iter().enumerate() {
            if i > 0 {
                out.write_all(b",")?;
            }
            cell(&mut out, &column.samples, row)?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn cell(out: &mut impl Write, samples: &Samples, row: usize) -> std::io::Result<()> {
    match samples {
        Samples::Real(values) => values.get(row).map_or(Ok(()), |v| write!(out, "{v}")),
        Samples::Text(values) => values
            .get(row)
            .map_or(Ok(()), |t| out.write_all(quoted(t).as_bytes())),
        Samples::Complex(_) => Ok(()),
    }
}

/// A text as a cell: quoted if it holds a separator, a quote or a line end, begins or ends with
/// a blank, or could be taken for a comment.
fn quoted(text: &str) -> String {
    let special = text.contains([',', ';', '\t', '|', '"', '\n', '\r']);
    if special || text.starts_with(['#', '%', '!']) || text.trim() != text {
        return in_quotes(text);
    }
    text.to_owned()
}

fn in_quotes(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
