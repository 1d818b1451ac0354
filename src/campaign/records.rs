//! `[records]` as written to the list of records: files found, datasets listed, settings joined
//! from run table, attributes and defaults.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::faults::{Fault, Notebook, Severity};
use super::quantity::Desk;
use super::resolved::RecordEntry;
use super::run_table::{self, Row, SWEEPS};
use super::written::{Attributes, Excitation, OneOrMany, Placed, Records, WrittenSweep};
use crate::record::calibrate::{self, ChannelKey, ChannelSetup};
use crate::record::source::{DatasetInfo, ReadError, Source};
use crate::record::{Flag, Setting, Sweep};
use crate::units::{self, Dimension};

/// How a file is opened; [`crate::record::open::open`] but for tests.
pub type Opener<'a> = &'a (dyn Fn(&Path) -> Result<Box<dyn Source>, ReadError> + Sync);

/// What a dataset is known by before it is read.
#[derive(Debug, Clone)]
struct Listed {
    file: PathBuf,
    /// Line of the run table; `None` for a glob.
    row: Option<Row>,
    dataset: Option<usize>,
    dataset_name: String,
    attributes: std::collections::BTreeMap<String, String>,
    flags: Vec<Flag>,
}

/// What the records of a campaign share.
#[derive(Debug, Clone, Copy)]
pub struct Shared<'a> {
    /// The folder of campaign.toml.
    pub folder: &'a Path,
    /// The channels by role.
    pub channels: &'a [ChannelSetup],
    /// The channel with the time.
    pub time: Option<&'a ChannelKey>,
}

/// List all records in the order of acquisition: the rows of the run table, else the files'
/// names with numbers in order.
pub fn resolve(
    records: &Records,
    shared: Shared<'_>,
    open: Opener<'_>,
    desk: &mut Desk<'_>,
) -> Vec<RecordEntry> {
    let defaults = defaults(records, desk);
    let listed = match (&records.files, &records.run_table) {
        (Some(files), None) => list_files(files, shared, open, desk),
        (None, Some(table)) => list_rows(table.get_ref(), shared, open, desk),
        (Some(files), Some(_)) => {
            desk.fault(
                files,
                "records.files",
                "files and run_table are both given".to_owned(),
                "keep one of them",
            );
            return Vec::new();
        }
        (None, None) => {
            desk.book.fault(
                None,
                "records",
                "where the records are is not said".to_owned(),
                "write files = \"records/*.h5\" or run_table = \"runs.csv\"",
            );
            return Vec::new();
        }
    };
    note_flags(&listed, desk);
    let entries = entries(&listed, &records.attributes, &defaults, desk);
    note_settings(&entries, desk);
    entries
}

/// Settings of the records that state none.
#[derive(Debug, Clone)]
struct Defaults {
    setting: Setting,
    excitation: Excitation,
}

fn defaults(records: &Records, desk: &mut Desk<'_>) -> Defaults {
    let frequency = desk.positive(
        &records.drive_frequency,
        "records.drive_frequency",
        Dimension::Frequency,
    );
    let clearance = desk.quantity(&records.clearance, "records.clearance", Dimension::Length);
    if clearance.is_some_and(|c| c.abs() > 1.0) {
        let what = "a clearance of more than 1 m".to_owned();
        desk.book
            .fault(None, "records.clearance", what, "mend its unit: mm?");
    }
    let amplitude = records.drive_amplitude.as_ref().map(|a| *a.get_ref());
    if let (Some(placed), Some(value)) = (&records.drive_amplitude, amplitude)
        && (!value.is_finite() || value < 0.0)
    {
        let what = format!("a drive amplitude of {value}");
        desk.fault(
            placed,
            "records.drive_amplitude",
            what,
            "write it relative to the nominal one: 1",
        );
    }
    Defaults {
        setting: Setting {
            stated_frequency_hz: frequency,
            clearance_m: clearance,
            sweep: sweep(&records.sweep),
            drive_amplitude: amplitude.unwrap_or(1.0),
            sequence: 0,
            specimen: None,
        },
        excitation: records
            .excitation
            .as_ref()
            .map_or(Excitation::Harmonic, |e| *e.get_ref()),
    }
}

fn sweep(written: &Placed<WrittenSweep>) -> Sweep {
    match written.as_ref().map(|s| *s.get_ref()) {
        Some(WrittenSweep::Up) => Sweep::Up,
        Some(WrittenSweep::Down) => Sweep::Down,
        Some(WrittenSweep::Unknown) | None => Sweep::Unknown,
    }
}

fn list_files(
    files: &toml::Spanned<OneOrMany>,
    shared: Shared<'_>,
    open: Opener<'_>,
    desk: &mut Desk<'_>,
) -> Vec<Listed> {
    let mut paths = Vec::new();
    for pattern in &files.get_ref().0 {
        let found = expand(shared.folder, pattern);
        if found.is_empty() {
            let what = format!("no file matches '{pattern}' in {}", shared.folder.display());
            desk.fault(
                files,
                "records.files",
                what,
                "mend the pattern; it is relative to campaign.toml",
            );
        }
        paths.extend(found);
    }
    paths.sort_by_cached_key(|p| natural_key(&p.to_string_lossy()));
    paths.dedup();
    let listed: Vec<Vec<Listed>> = paths
        .par_iter()
        .map(|path| list_file(path, shared, open))
        .collect();
    listed.into_iter().flatten().collect()
}

/// The files that a glob matches, folders left out.
fn expand(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let whole = Path::new(&glob::Pattern::escape(&folder.to_string_lossy())).join(pattern);
    let Ok(paths) = glob::glob(&whole.to_string_lossy()) else {
        return Vec::new();
    };
    paths
        .filter_map(Result::ok)
        .filter(|p| p.is_file())
        .collect()
}

/// A key that puts `run2` before `run10`.
fn natural_key(name: &str) -> Vec<(u8, u64, String)> {
    let mut key: Vec<(u8, u64, String)> = Vec::new();
    for letter in name.chars() {
        match (letter.to_digit(10), key.last_mut()) {
            (Some(d), Some((0, number, text))) if number.checked_mul(10).is_some() => {
                *number = number.saturating_mul(10).saturating_add(u64::from(d));
                text.push(letter);
            }
            (Some(d), _) => key.push((0, u64::from(d), letter.to_string())),
            (None, Some((1, _, text))) => text.push(letter),
            (None, _) => key.push((1, 0, letter.to_string())),
        }
    }
    key
}

fn list_file(path: &Path, shared: Shared<'_>, open: Opener<'_>) -> Vec<Listed> {
    match open(path) {
        Ok(source) => {
            let sets = source.datasets();
            if sets.is_empty() {
                return vec![failed(path, None, empty_file(path))];
            }
            sets.iter()
                .enumerate()
                .map(|(i, set)| listed(path, i, set, None, shared))
                .collect()
        }
        Err(error) => vec![failed(path, None, error_flag(&error))],
    }
}

fn empty_file(path: &Path) -> Flag {
    Flag {
        code: "empty".to_owned(),
        channel: None,
        message: format!("{} holds no dataset", path.display()),
        remedy: "remove the file, or record again".to_owned(),
        excludes: true,
    }
}

fn error_flag(error: &ReadError) -> Flag {
    let place = error
        .channel
        .as_ref()
        .map(|c| format!("channel '{c}': "))
        .unwrap_or_default();
    let byte = error
        .byte
        .map(|b| format!(" (at byte {b})"))
        .unwrap_or_default();
    Flag {
        code: "unreadable".to_owned(),
        channel: error.channel.clone(),
        message: format!("{place}{}; expected {}{byte}", error.found, error.expected),
        remedy: error.remedy.clone(),
        excludes: true,
    }
}

fn failed(path: &Path, row: Option<Row>, flag: Flag) -> Listed {
    Listed {
        file: path.to_path_buf(),
        dataset_name: row
            .as_ref()
            .and_then(|r| r.dataset.clone())
            .unwrap_or_default(),
        row,
        dataset: None,
        attributes: std::collections::BTreeMap::new(),
        flags: vec![flag],
    }
}

fn listed(
    path: &Path,
    index: usize,
    set: &DatasetInfo,
    row: Option<Row>,
    shared: Shared<'_>,
) -> Listed {
    let mut flags: Vec<Flag> = shared
        .channels
        .iter()
        .filter_map(|c| calibrate::bind(c, set).err())
        .collect();
    flags.extend(crate::record::time_axis::find(shared.time, set).err());
    Listed {
        file: path.to_path_buf(),
        row,
        dataset: Some(index),
        dataset_name: set.name.clone(),
        attributes: set.attributes.clone(),
        flags,
    }
}

fn list_rows(
    table: &str,
    shared: Shared<'_>,
    open: Opener<'_>,
    desk: &mut Desk<'_>,
) -> Vec<Listed> {
    let path = shared.folder.join(table);
    let mut book = Notebook::new(&path);
    let rows = run_table::read(&path, &mut book);
    refuse_twice(&rows, &mut book);
    desk.book.absorb(book.into_faults());
    let mut by_file: HashMap<&str, Vec<&Row>> = HashMap::new();
    for row in &rows {
        by_file.entry(&row.file).or_default().push(row);
    }
    let by_file: Vec<(&str, Vec<&Row>)> = by_file.into_iter().collect();
    let mut all: Vec<Listed> = by_file
        .par_iter()
        .flat_map_iter(|(file, rows)| list_rows_of(&shared.folder.join(file), rows, shared, open))
        .collect();
    all.sort_by_key(|l| (l.row.as_ref().map(|r| r.line), l.dataset));
    all
}

/// The same file and dataset in two rows is a record counted twice.
fn refuse_twice(rows: &[Row], book: &mut Notebook) {
    let mut seen: HashMap<(&str, Option<&str>), usize> = HashMap::new();
    for row in rows {
        let key = (row.file.as_str(), row.dataset.as_deref());
        if let Some(first) = seen.insert(key, row.line) {
            let what = format!("'{}' already stands in line {first}", row.file);
            book.fault(Some(row.line), "file", what, "remove one of the two rows");
        }
    }
}

fn list_rows_of(path: &Path, rows: &[&Row], shared: Shared<'_>, open: Opener<'_>) -> Vec<Listed> {
    let source = match open(path) {
        Ok(source) => source,
        Err(error) => {
            let flag = error_flag(&error);
            return rows
                .iter()
                .map(|r| failed(path, Some((*r).clone()), flag.clone()))
                .collect();
        }
    };
    let sets = source.datasets();
    let mut all = Vec::new();
    for row in rows {
        let wanted = |set: &DatasetInfo| row.dataset.as_ref().is_none_or(|d| names(set, d));
        let before = all.len();
        for (index, set) in sets.iter().enumerate().filter(|(_, set)| wanted(set)) {
            all.push(listed(path, index, set, Some((*row).clone()), shared));
        }
        if all.len() == before {
            all.push(failed(path, Some((*row).clone()), no_dataset(row, sets)));
        }
    }
    all
}

fn names(set: &DatasetInfo, name: &str) -> bool {
    set.name == name || set.name.trim_start_matches('/') == name.trim_start_matches('/')
}

fn no_dataset(row: &Row, sets: &[DatasetInfo]) -> Flag {
    let some: Vec<&str> = sets.iter().take(8).map(|s| s.name.as_str()).collect();
    Flag {
        code: "missing_dataset".to_owned(),
        channel: None,
        message: format!(
            "no dataset '{}' in it; it holds {}",
            row.dataset.as_deref().unwrap_or(""),
            some.join(", ")
        ),
        remedy: "mend the column dataset of the run table".to_owned(),
        excludes: true,
    }
}

/// Tell the flags of the listing: what every record has is one fault of the campaign.
fn note_flags(listed: &[Listed], desk: &mut Desk<'_>) {
    let mut groups: Vec<(&Flag, Vec<&Listed>)> = Vec::new();
    let mut index: HashMap<(&str, &str), usize> = HashMap::new();
    for one in listed {
        for flag in &one.flags {
            let key = (flag.code.as_str(), flag.message.as_str());
            let at = *index.entry(key).or_insert_with(|| {
                groups.push((flag, Vec::new()));
                groups.len() - 1
            });
            groups[at].1.push(one);
        }
    }
    for (flag, records) in groups {
        let all = records.len() == listed.len() && flag.excludes;
        if all && listed.len() > 1 {
            let what = format!("in all {} records: {}", listed.len(), flag.message);
            let key = flag.channel.as_deref().unwrap_or("records").to_owned();
            desk.book.fault(None, &key, what, &flag.remedy);
            continue;
        }
        let severity = match (all, flag.excludes) {
            (true, _) => Severity::Campaign,
            (false, true) => Severity::Record,
            (false, false) => Severity::Note,
        };
        let faults = records
            .iter()
            .map(|one| record_fault(one, flag, severity))
            .collect();
        desk.book.absorb(faults);
    }
}

fn record_fault(one: &Listed, flag: &Flag, severity: Severity) -> Fault {
    Fault {
        file: one.file.clone(),
        line: None,
        key: match (one.dataset_name.as_str(), &flag.channel) {
            ("", Some(channel)) => channel.clone(),
            (name, Some(channel)) => format!("{name}: {channel}"),
            (name, None) => name.to_owned(),
        },
        what: flag.message.clone(),
        remedy: flag.remedy.clone(),
        severity,
    }
}

fn entries(
    listed: &[Listed],
    attributes: &Attributes,
    defaults: &Defaults,
    desk: &mut Desk<'_>,
) -> Vec<RecordEntry> {
    let ids = super::names::of(listed.iter().map(|l| super::names::Known {
        file: &l.file,
        dataset: &l.dataset_name,
        given: l.row.as_ref().and_then(|r| r.record.as_deref()),
    }));
    let wanted = Wanted::of(attributes, desk);
    listed
        .iter()
        .zip(ids)
        .enumerate()
        .map(|(sequence, (one, id))| RecordEntry {
            id,
            file: one.file.clone(),
            dataset: one.dataset,
            setting: Setting {
                sequence,
                ..setting(one, &wanted, defaults, desk)
            },
            excitation: one
                .row
                .as_ref()
                .and_then(|r| r.excitation)
                .unwrap_or(defaults.excitation),
            excluded: false,
        })
        .collect()
}

/// Attributes to look for: full name, name without unit, factor to SI.
#[derive(Debug, Default)]
struct Wanted {
    clearance: Option<Attribute>,
    frequency: Option<Attribute>,
    amplitude: Option<Attribute>,
    sweep: Option<String>,
    specimen: Option<String>,
}

#[derive(Debug)]
struct Attribute {
    name: String,
    bare: String,
    to_si: f64,
}

impl Attribute {
    fn text<'a>(&self, of: &'a Listed) -> Option<&'a String> {
        of.attributes
            .get(&self.name)
            .or_else(|| of.attributes.get(&self.bare))
    }
}

impl Wanted {
    fn of(written: &Attributes, desk: &mut Desk<'_>) -> Self {
        Self {
            clearance: attribute(&written.clearance, "clearance", Dimension::Length, desk),
            frequency: attribute(
                &written.drive_frequency,
                "drive_frequency",
                Dimension::Frequency,
                desk,
            ),
            amplitude: attribute(
                &written.drive_amplitude,
                "drive_amplitude",
                Dimension::Number,
                desk,
            ),
            sweep: written.sweep.as_ref().map(|s| s.get_ref().clone()),
            specimen: written.specimen.as_ref().map(|s| s.get_ref().clone()),
        }
    }
}

fn attribute(
    placed: &Placed<String>,
    key: &str,
    dimension: Dimension,
    desk: &mut Desk<'_>,
) -> Option<Attribute> {
    let placed = placed.as_ref()?;
    let name = placed.get_ref();
    let (bare, symbol) = units::split_unit(name);
    let unit = symbol.and_then(units::parse_split_unit);
    let to_si = match unit {
        Some(unit) if unit.dimension == dimension => unit.to_si,
        None if dimension == Dimension::Number => 1.0,
        _ => {
            let what = format!(
                "an attribute '{name}' for a {} without unit",
                key.replace('_', " ")
            );
            let remedy = format!(
                "write the unit after it in brackets, such as \"{bare} [{}]\"",
                units::symbols_of(dimension).first().unwrap_or(&"1")
            );
            desk.fault(placed, &format!("records.attributes.{key}"), what, &remedy);
            return None;
        }
    };
    Some(Attribute {
        name: name.clone(),
        bare: bare.to_owned(),
        to_si,
    })
}

fn setting(one: &Listed, wanted: &Wanted, defaults: &Defaults, desk: &mut Desk<'_>) -> Setting {
    let row = one.row.as_ref();
    let mut number = |attribute: &Option<Attribute>| {
        let attribute = attribute.as_ref()?;
        attribute_number(one, attribute, desk)
    };
    let frequency = number(&wanted.frequency);
    let clearance = number(&wanted.clearance);
    let amplitude = number(&wanted.amplitude);
    let sweep = wanted
        .sweep
        .as_ref()
        .and_then(|name| attribute_sweep(one, name, desk));
    let specimen = wanted
        .specimen
        .as_ref()
        .and_then(|name| one.attributes.get(name).cloned());
    let default = &defaults.setting;
    Setting {
        stated_frequency_hz: row
            .and_then(|r| r.drive_frequency_hz)
            .or(frequency)
            .or(default.stated_frequency_hz),
        clearance_m: row
            .and_then(|r| r.clearance_m)
            .or(clearance)
            .or(default.clearance_m),
        sweep: row.and_then(|r| r.sweep).or(sweep).unwrap_or(default.sweep),
        drive_amplitude: row
            .and_then(|r| r.drive_amplitude)
            .or(amplitude)
            .unwrap_or(default.drive_amplitude),
        sequence: 0,
        specimen: row.and_then(|r| r.specimen.clone()).or(specimen),
    }
}

fn attribute_number(one: &Listed, wanted: &Attribute, desk: &mut Desk<'_>) -> Option<f64> {
    one.dataset?;
    let Some(text) = wanted.text(one) else {
        let what = format!("it has no attribute '{}'", wanted.name);
        desk.book
            .absorb(vec![attribute_fault(one, &wanted.name, what)]);
        return None;
    };
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Some(value * wanted.to_si),
        _ => {
            let what = format!("its attribute '{}' is '{text}', not a number", wanted.name);
            desk.book
                .absorb(vec![attribute_fault(one, &wanted.name, what)]);
            None
        }
    }
}

fn attribute_sweep(one: &Listed, name: &str, desk: &mut Desk<'_>) -> Option<Sweep> {
    let text = one.attributes.get(name)?;
    let found = SWEEPS
        .iter()
        .find(|(word, _)| word.eq_ignore_ascii_case(text.trim()));
    if found.is_none() {
        let what = format!("its attribute '{name}' is '{text}', not up, down or unknown");
        desk.book.absorb(vec![attribute_fault(one, name, what)]);
    }
    found.map(|(_, sweep)| *sweep)
}

fn attribute_fault(one: &Listed, name: &str, what: String) -> Fault {
    Fault {
        file: one.file.clone(),
        line: None,
        key: match one.dataset_name.as_str() {
            "" => name.to_owned(),
            dataset => format!("{dataset}: {name}"),
        },
        what,
        remedy: "mend [records.attributes], or write a run table".to_owned(),
        severity: Severity::Record,
    }
}

/// Settings that cannot be.
fn note_settings(entries: &[RecordEntry], desk: &mut Desk<'_>) {
    for entry in entries {
        let setting = &entry.setting;
        let mut note = |severity, key: &str, what: String, remedy: &str| {
            desk.book.absorb(vec![Fault {
                file: entry.file.clone(),
                line: None,
                key: format!("{}: {key}", entry.id),
                what,
                remedy: remedy.to_owned(),
                severity,
            }]);
        };
        if let Some(c) = setting.clearance_m.filter(|c| c.abs() > 1.0) {
            note(
                Severity::Record,
                "clearance",
                format!("a clearance of {c} m"),
                "mend its unit: mm?",
            );
        }
        if let Some(c) = setting.clearance_m.filter(|c| *c <= 0.0) {
            let what = format!("a clearance of {c} m: a preload, or a slip");
            note(
                Severity::Note,
                "clearance",
                what,
                "nothing, where the rig was so preloaded",
            );
        }
        if let Some(f) = setting.stated_frequency_hz.filter(|f| *f <= 0.0) {
            let what = format!("a drive frequency of {f} Hz");
            note(
                Severity::Record,
                "drive_frequency",
                what,
                "mend the run table",
            );
        }
        if setting.drive_amplitude <= 0.0 {
            let what = format!("a drive amplitude of {}", setting.drive_amplitude);
            note(
                Severity::Record,
                "drive_amplitude",
                what,
                "write it relative to the nominal one: 1",
            );
        }
    }
}
