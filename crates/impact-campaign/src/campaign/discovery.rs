//! Which records there are: files that match, rows of the run table, datasets in each, and what
//! their metadata alone says to be wrong.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::context::ResolveContext;
use super::diagnostic::{Code, Diagnostic, FaultCollector, Place, Severity, first_of};
use super::names::natural_key;
use super::run_table::{self, Row};
use super::slashes;
use super::sources::Sources;
use super::statement::Statement;
use super::values::OneOrMany;
use impact_records::record::calibrate::{self, ChannelKey, ChannelSetup};
use impact_records::record::{Flag, FlagCode, Problem};
use labfiles::{DatasetInfo, ReadError, Source, StoredType};

/// How a file is opened; [`labfiles::open`] but for tests.
pub type Opener<'a> = &'a (dyn Fn(&Path) -> Result<Box<dyn Source>, ReadError> + Sync);

/// Which files are listed, while others are still being written.
pub type Taken<'a> = &'a (dyn Fn(&Path) -> bool + Sync);

/// A record as its file's metadata and the run table describe it, before it is read.
#[derive(Debug, Clone)]
pub(super) struct Discovered {
    /// Name in the campaign, once all records are known.
    pub(super) id: String,
    pub(super) file: PathBuf,
    /// Line of the run table; `None` for a glob.
    pub(super) row: Option<Row>,
    pub(super) dataset: Option<usize>,
    pub(super) dataset_name: String,
    pub(super) attributes: BTreeMap<String, String>,
    pub(super) flags: Vec<Flag>,
}

/// What the records of a campaign share.
#[derive(Clone, Copy)]
pub(super) struct Shared<'a> {
    /// The folder of campaign.toml.
    pub(super) folder: &'a Path,
    /// The channels by role.
    pub(super) channels: &'a [ChannelSetup],
    /// The channel with the time.
    pub(super) time: Option<&'a ChannelKey>,
    /// The files to list; `None`: all.
    pub(super) taken: Option<Taken<'a>>,
    /// Opens the files and keeps the last.
    pub(super) sources: &'a Sources,
}

impl Shared<'_> {
    fn lists(&self, file: &Path) -> bool {
        self.taken.is_none_or(|taken| taken(file))
    }
}

pub(super) fn list_files(
    files: &toml::Spanned<OneOrMany>,
    shared: Shared<'_>,
    open: Opener<'_>,
    context: &mut ResolveContext<'_>,
) -> Vec<Discovered> {
    let mut paths = Vec::new();
    for pattern in &files.get_ref().0 {
        let found = expand(shared.folder, pattern);
        if found.is_empty() && shared.taken.is_none() {
            let folder = if shared.folder.as_os_str().is_empty() {
                Path::new(".")
            } else {
                shared.folder
            };
            let shown = slashes::shown(pattern);
            let what = format!("no file matches '{shown}' in {}", folder.display());
            let remedy = if pattern.contains('\\') || slashes::is_foreign(pattern) {
                slashes::REMEDY
            } else {
                "check the pattern; it is relative to campaign.toml"
            };
            context.fault(Code::UnreadableFile, files, "records.files", what, remedy);
        }
        paths.extend(found);
    }
    paths.sort_by_cached_key(|p| natural_key(&p.to_string_lossy()));
    paths.dedup();
    paths.retain(|path| shared.lists(path));
    let listed: Vec<(Vec<Discovered>, Option<Diagnostic>)> = paths
        .par_iter()
        .map(|path| list_file(path, shared, open))
        .collect();
    let mut all = Vec::new();
    for (records, left_out) in listed {
        all.extend(records);
        context.faults.extend(left_out);
    }
    all
}

/// The files that a glob matches, links that lead nowhere among them, so that they are named; folders and hidden files
/// are left out, as `init` does.
pub(super) fn expand(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let mut found = match folder.to_str() {
        Some(text) => {
            let whole = Path::new(&glob::Pattern::escape(text)).join(pattern);
            matching(&whole.to_string_lossy())
        }
        None => matching_below(folder, pattern),
    };
    found.retain(|p| p.is_file() || (p.is_symlink() && !p.exists()));
    found
}

/// What is hidden is matched by no wildcard, and a name by none across folders.
const VISIBLE: glob::MatchOptions = glob::MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

/// All that a glob matches but what is hidden, as in a shell; nothing where it is no glob.
pub fn matching(pattern: &str) -> Vec<PathBuf> {
    let visible = glob::MatchOptions {
        require_literal_separator: false,
        ..VISIBLE
    };
    let paths = glob::glob_with(pattern, visible).into_iter().flatten();
    paths.filter_map(Result::ok).collect()
}

/// Folders below each other that `**` may pass.
const MOST_DEPTH: usize = 16;

/// All that a glob matches below a folder whose name is no Unicode, which no glob can state.
fn matching_below(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let Ok(wanted) = glob::Pattern::new(pattern) else {
        return Vec::new();
    };
    let depth = if pattern.contains("**") {
        MOST_DEPTH
    } else {
        pattern.split('/').count()
    };
    let mut all = Vec::new();
    collect_below(folder, depth, &mut all);
    let is_wanted = |path: &PathBuf| {
        let below = path.strip_prefix(folder).ok();
        below.is_some_and(|below| wanted.matches_with(&slashes::text(below), VISIBLE))
    };
    all.retain(is_wanted);
    all.sort();
    all
}

fn collect_below(folder: &Path, depth: usize, into: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        if depth > 1 && path.is_dir() {
            collect_below(&path, depth - 1, into);
        }
        into.push(path);
    }
}

/// The records of a file, and a note on its datasets that are none.
fn list_file(
    path: &Path,
    shared: Shared<'_>,
    open: Opener<'_>,
) -> (Vec<Discovered>, Option<Diagnostic>) {
    match shared.sources.open_by(path, open) {
        Ok(source) => {
            let sets = source.datasets();
            if sets.is_empty() {
                return (vec![failed(path, None, empty_file(path))], None);
            }
            let used = records_of(sets, shared);
            let note = left_out(path, sets, &used);
            let listed = |i: usize| listed(path, i, &sets[i], None, shared);
            (used.into_iter().map(listed).collect(), note)
        }
        Err(error) => (vec![failed(path, None, calibrate::read_flag(&error))], None),
    }
}

/// The datasets of a file that are records: those with samples of a channel that campaign.toml names, where any
/// has them (a workbook has sheets of notes too), else all.
fn records_of(sets: &[DatasetInfo], shared: Shared<'_>) -> Vec<usize> {
    let named = |i: &usize| {
        let mut found = shared
            .channels
            .iter()
            .filter_map(|c| c.source.find(&sets[*i]));
        found.any(|index| {
            let info = &sets[*i].channels[index];
            info.samples > 1 && info.stored != StoredType::Text
        })
    };
    let all = 0..sets.len();
    let found: Vec<usize> = all.clone().filter(named).collect();
    if found.is_empty() {
        all.collect()
    } else {
        found
    }
}

/// One note on all datasets of a file that are no records.
fn left_out(path: &Path, sets: &[DatasetInfo], used: &[usize]) -> Option<Diagnostic> {
    let others = (0..sets.len()).filter(|i| !used.contains(i));
    let names: Vec<String> = others.map(|i| called(&sets[i])).collect();
    if names.is_empty() {
        return None;
    }
    let place = Place {
        file: path.to_path_buf(),
        ..Place::default()
    };
    let found = format!(
        "{} of {} datasets hold no samples of the channels in campaign.toml and are no records: {}",
        names.len(),
        sets.len(),
        first_of(&names)
    );
    let remedy = "nothing, if they hold notes or settings";
    Some(Diagnostic::new(
        (Code::NoRecord, Severity::Note),
        place,
        found,
        remedy,
    ))
}

fn empty_file(path: &Path) -> Flag {
    let path = path.display().to_string();
    Flag::new(None, Problem::NoDataset { path })
}

fn failed(path: &Path, row: Option<Row>, flag: Flag) -> Discovered {
    Discovered {
        id: String::new(),
        file: path.to_path_buf(),
        dataset_name: row
            .as_ref()
            .and_then(|r| r.dataset.clone())
            .unwrap_or_default(),
        row,
        dataset: None,
        attributes: BTreeMap::new(),
        flags: vec![flag],
    }
}

fn listed(
    path: &Path,
    index: usize,
    set: &DatasetInfo,
    row: Option<Row>,
    shared: Shared<'_>,
) -> Discovered {
    let mut flags: Vec<Flag> = shared
        .channels
        .iter()
        .filter_map(|c| calibrate::bind(c, set).err())
        .collect();
    flags.extend(impact_records::record::time_axis::find(shared.time, set).err());
    Discovered {
        id: String::new(),
        file: path.to_path_buf(),
        row,
        dataset: Some(index),
        dataset_name: set.name.clone(),
        attributes: set.attributes.clone(),
        flags,
    }
}

pub(super) fn list_rows(
    table: &str,
    shared: Shared<'_>,
    open: Opener<'_>,
    context: &mut ResolveContext<'_>,
) -> Vec<Discovered> {
    let path = shared.folder.join(table);
    let mut faults = FaultCollector::new(&path);
    let mut rows = run_table::read(shared.folder, table, &mut faults);
    refuse_twice(&rows, &mut faults);
    context.faults.extend(faults.into_diagnostics().0);
    rows.retain(|row| shared.lists(&shared.folder.join(&row.file)));
    let mut by_file: HashMap<&str, Vec<&Row>> = HashMap::new();
    for row in &rows {
        by_file.entry(&row.file).or_default().push(row);
    }
    let by_file: Vec<(&str, Vec<&Row>)> = by_file.into_iter().collect();
    let mut all: Vec<Discovered> = by_file
        .par_iter()
        .flat_map_iter(|(file, rows)| list_rows_of(&shared.folder.join(file), rows, shared, open))
        .collect();
    all.sort_by_key(|l| (l.row.as_ref().map(|r| r.line), l.dataset));
    all
}

/// The same file and dataset in two rows is a record counted twice.
fn refuse_twice(rows: &[Row], faults: &mut FaultCollector) {
    let mut seen: HashMap<(&str, Option<&str>), usize> = HashMap::new();
    for row in rows {
        let key = (row.file.as_str(), row.dataset.as_deref());
        if let Some(first) = seen.insert(key, row.line) {
            let what = format!("'{}' is already in line {first}", row.file);
            faults.fault(
                Code::Conflict,
                Some(row.line),
                "file",
                what,
                "remove one of the two rows",
            );
        }
    }
}

fn list_rows_of(
    path: &Path,
    rows: &[&Row],
    shared: Shared<'_>,
    open: Opener<'_>,
) -> Vec<Discovered> {
    let source = match shared.sources.open_by(path, open) {
        Ok(source) => source,
        Err(error) => {
            let flag = calibrate::read_flag(&error);
            return rows
                .iter()
                .map(|r| failed(path, Some((*r).clone()), flag.clone()))
                .collect();
        }
    };
    let sets = source.datasets();
    let mut places: HashMap<&str, Vec<usize>> = HashMap::new();
    for (index, set) in sets.iter().enumerate() {
        places.entry(bare(&set.name)).or_default().push(index);
    }
    let records = records_of(sets, shared);
    let found = rows.par_iter().flat_map_iter(|row| {
        let wanted = match &row.dataset {
            Some(name) => places.get(bare(name)),
            None => Some(&records).filter(|records| !records.is_empty()),
        };
        let Some(wanted) = wanted else {
            return vec![failed(path, Some((*row).clone()), no_dataset(row, sets))];
        };
        let each = wanted.iter().map(|index| {
            let row = Some((*row).clone());
            listed(path, *index, &sets[*index], row, shared)
        });
        each.collect()
    });
    found.collect()
}

/// A dataset's name without the slash that HDF5 begins it with.
/// The name of a dataset, or of one without a name, as MATLAB's variables are, those of its channels.
pub(super) fn called(set: &DatasetInfo) -> String {
    match bare(&set.name) {
        "" => {
            let channels: Vec<String> = set.channels.iter().map(|c| c.name.clone()).collect();
            first_of(&channels)
        }
        name => name.to_owned(),
    }
}

fn bare(name: &str) -> &str {
    name.trim_start_matches('/')
}

/// Datasets of a file that a flag names.
const NAMED: usize = 8;

fn no_dataset(row: &Row, sets: &[DatasetInfo]) -> Flag {
    let more = (sets.len() > NAMED).then(|| "…".to_owned());
    let names = sets.iter().take(NAMED).map(|s| s.name.clone());
    let problem = Problem::NoSuchDataset {
        dataset: row.dataset.clone().unwrap_or_default(),
        line: row.line,
        datasets: names.chain(more).collect(),
    };
    Flag::new(None, problem)
}

/// A flag that all records have, as one problem of the campaign.
fn of_all(file: &Path, flag: &Flag, records: usize) -> Diagnostic {
    let place = Place {
        file: file.to_path_buf(),
        item: flag.channel.as_deref().unwrap_or("records").to_owned(),
        ..Place::default()
    };
    let problem = flag.problem.clone();
    let kind = (Code::Flag(flag.code), Severity::Campaign);
    Diagnostic::stating(kind, place, Statement::OfAll { records, problem })
}

/// Report the flags of the metadata: what every record has is one problem of the campaign.
pub(super) fn note_flags(listed: &[Discovered], context: &mut ResolveContext<'_>) {
    let mut groups: Vec<(&Flag, Vec<&Discovered>)> = Vec::new();
    let mut index: HashMap<(FlagCode, String), usize> = HashMap::new();
    for one in listed {
        for flag in &one.flags {
            let key = (flag.code, flag.message());
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
            let fault = of_all(context.faults.file(), flag, listed.len());
            context.faults.extend([fault]);
            continue;
        }
        // a campaign of one record stops with it
        context.faults.extend(records.iter().map(|one| {
            let mut problem = Diagnostic::of_flag(&one.file, &one.id, flag);
            if all {
                problem.severity = Severity::Campaign;
            }
            problem
        }));
    }
}
