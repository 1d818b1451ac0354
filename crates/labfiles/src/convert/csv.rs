//! Records to CSV: remarks, a header with units, one row per sample.

use std::io::Write;
use std::path::Path;

use crate::convert::item::{ConvertError, Item, io};
use crate::csv::TEXTS_KEY;
use crate::output::{write_folder_whole_or, write_whole_or};
use crate::source::Samples;

/// Write one record to a file, or several to the files of a folder.
pub(super) fn write(items: &[Item<'_>], out: &Path) -> Result<(), ConvertError> {
    if let [item] = items {
        return one(item, out, out);
    }
    let target = out.with_extension("");
    let fill = |folder: &Path| {
        let each = |item| {
            let name = file_name(item);
            one(item, &folder.join(&name), &target.join(&name))
        };
        items.iter().try_for_each(each)
    };
    write_folder_whole_or(&target, fill, |source| io(&target)(source).into())
}

fn file_name(item: &Item<'_>) -> String {
    format!("{}.csv", item.name.replace('/', "_"))
}

/// Write a record to a file that has another name in an error.
fn one(item: &Item<'_>, path: &Path, named: &Path) -> Result<(), ConvertError> {
    let samples = item.read()?;
    write_whole_or(path, |out| rows(item, &samples, out), |e| e).map_err(io(named))?;
    Ok(())
}

fn rows(item: &Item<'_>, samples: &[Samples], mut out: impl Write) -> std::io::Result<()> {
    for (key, value) in item.described() {
        writeln!(out, "# {key} = {}", value.replace(['\n', '\r'], " "))?;
    }
    if let Some(rate) = item.sample_rate_hz() {
        writeln!(out, "# sample_rate_hz = {rate}")?;
    }
    if let Some(start) = item.start_time() {
        writeln!(out, "# start_time = {start}")?;
    }
    let columns = columns(item, samples);
    let texts = columns.iter().enumerate().filter(|(_, c)| c.text);
    let texts: Vec<String> = texts.map(|(i, _)| (i + 1).to_string()).collect();
    if !texts.is_empty() {
        writeln!(out, "# {TEXTS_KEY} = {}", texts.join(" "))?;
    }
    let headings: Vec<String> = columns.into_iter().map(|c| c.heading).collect();
    writeln!(out, "{}", headings.join(","))?;
    let longest = samples.iter().map(Samples::len).max().unwrap_or(0);
    for row in 0..longest {
        let mut first = true;
        for samples in samples {
            if !std::mem::replace(&mut first, false) {
                out.write_all(b",")?;
            }
            cell(&mut out, samples, row)?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn cell(out: &mut impl Write, samples: &Samples, row: usize) -> std::io::Result<()> {
    match samples {
        Samples::Real(values) => values.get(row).map_or(Ok(()), |v| write!(out, "{v}")),
        Samples::Complex(values) => match values.get(row) {
            Some((re, im)) => write!(out, "{re},{im}"),
            None => out.write_all(b","),
        },
        Samples::Text(values) => values
            .get(row)
            .map_or(Ok(()), |t| out.write_all(quoted(t).as_bytes())),
    }
}

/// A column of the table.
struct Column {
    heading: String,
    text: bool,
}

/// The columns, two for complex numbers. Headings of texts are quoted in any case: a reader learns
/// early that there are quotes.
fn columns(item: &Item<'_>, samples: &[Samples]) -> Vec<Column> {
    let mut all = Vec::new();
    for (heading, samples) in item.headings().zip(samples) {
        let text = matches!(samples, Samples::Text(_));
        let headings = match samples {
            Samples::Complex(_) => [".re", ".im"].map(|p| quoted(&heading.part(p))).to_vec(),
            Samples::Text(_) => vec![in_quotes(&heading.whole())],
            Samples::Real(_) => vec![quoted(&heading.whole())],
        };
        all.extend(headings.into_iter().map(|heading| Column { heading, text }));
    }
    all
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
