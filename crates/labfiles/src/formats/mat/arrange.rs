//! From the arrays of a file to datasets and channels.

mod labels;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::text;
use super::tree::{Content, Leaf, Tree};
use crate::bytes::to_usize;
use crate::formats::csv::header::name_and_unit;
use crate::numbers::Spacing;
use crate::source::{ChannelInfo, Clock, DatasetInfo};
use crate::timing;
use crate::units::{self, Dimension};

/// Matrices with more columns than this are one channel, not one per column.
const MOST_COLUMNS: u64 = 4096;
/// A matrix this many times wider than tall is read by rows.
const WIDE: u64 = 16;

/// Which part of an array a channel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slice {
    /// All of it, column by column.
    Whole,
    /// One column (higher dimensions counted through).
    Column(u64),
    /// One row of a matrix.
    Row(u64),
}

impl Slice {
    /// The places of its numbers of `width` bytes among those of its array.
    pub(crate) fn spacing(self, leaf: &Leaf, width: usize) -> Spacing {
        let (rows, all) = (to_usize(leaf.dims[0]), to_usize(leaf.count()));
        let (offset, stride, count) = match self {
            Self::Whole => (0, width, all),
            Self::Column(column) => (to_usize(column) * rows * width, width, rows),
            Self::Row(row) => (to_usize(row) * width, rows * width, all / rows.max(1)),
        };
        Spacing {
            offset,
            stride,
            count,
        }
    }
}

/// Where a channel's samples come from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin {
    /// Index into [`Tree::leaves`].
    pub leaf: usize,
    /// The part of that array.
    pub slice: Slice,
}

/// The datasets of a file and, for each, the origins of its channels.
#[derive(Debug, Default)]
pub(crate) struct Arranged {
    /// As the user sees them.
    pub datasets: Vec<DatasetInfo>,
    /// One list per dataset, one origin per channel.
    pub origins: Vec<Vec<Origin>>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// Arrange the arrays: a struct or cell array of records gives one dataset per element; all
/// other variables are one dataset without a name.
///
/// Single values of the file are repeated as attributes of every record as far as that takes no
/// more memory than the arrays themselves.
pub(crate) fn arrange(tree: &Tree) -> Arranged {
    let mut by_variable: Vec<Vec<usize>> = vec![Vec::new(); tree.variables.len()];
    for (index, leaf) in tree.leaves.iter().enumerate() {
        by_variable[leaf.variable].push(index);
    }
    let records: Vec<bool> = by_variable
        .iter()
        .map(|leaves| holds_records(tree, leaves))
        .collect();
    let mut builder = Builder::new(tree, &records);
    let common: Vec<usize> = (0..tree.leaves.len())
        .filter(|&leaf| !records[tree.leaves[leaf].variable])
        .collect();
    if !common.is_empty() || !records.contains(&true) {
        builder.common(&common);
    }
    for leaves in by_variable
        .iter()
        .zip(&records)
        .filter(|(_, holds)| **holds)
        .map(|(l, _)| l)
    {
        for element in leaves.chunk_by(|&a, &b| tree.leaves[a].element == tree.leaves[b].element) {
            builder.record(element);
        }
    }
    builder.arranged
}

/// Take the first columns of matrices that climb evenly for times, in datasets that have none; `values` reads a
/// channel of a dataset. Gives what was assumed.
pub(crate) fn take_unnamed_times(
    tree: &Tree,
    origins: &[Vec<Origin>],
    datasets: &mut [DatasetInfo],
    values: impl Fn(usize, usize) -> Option<Vec<f64>>,
) -> Vec<String> {
    let mut notes = Vec::new();
    for (number, (set, origins)) in datasets.iter_mut().zip(origins).enumerate() {
        let rated = set.channels.iter().any(|c| c.sample_rate_hz.is_some());
        if set.time_axis.is_some() || rated {
            continue;
        }
        let climbs = |i: &usize| values(number, *i).is_some_and(|v| timing::climbs_evenly(&v));
        let firsts = (0..origins.len()).filter(|i| is_first_of_several(tree, origins[*i]));
        let times: Vec<usize> = firsts.filter(climbs).collect();
        for &time in &times {
            let own = |i: &usize| *i != time && origins[*i].leaf == origins[time].leaf;
            for i in (0..origins.len()).filter(own) {
                set.channels[i].clock = Clock::Axis(time);
            }
            let name = &set.channels[time].name;
            let note = format!("{name} climbs evenly and has no name: taken as time in seconds");
            notes.push(note);
        }
        set.time_axis = times.first().copied();
    }
    notes
}

/// Whether an array's part is the first column, or row, of a matrix of several.
fn is_first_of_several(tree: &Tree, origin: Origin) -> bool {
    let leaf = &tree.leaves[origin.leaf];
    let first = match origin.slice {
        Slice::Column(0) => leaf.dims[1] > 1,
        Slice::Row(0) => leaf.dims[0] > 1,
        _ => false,
    };
    leaf.dims.len() == 2 && first && matches!(leaf.content, Content::Real(_))
}

/// Whether a variable has several elements of which each looks like a record: a struct with at
/// least one numeric vector, or a matrix of several channels.
fn holds_records(tree: &Tree, leaves: &[usize]) -> bool {
    let looks = |&index: &usize| {
        let leaf = &tree.leaves[index];
        let bare = leaf.tail == leaf.name;
        let vectors = if bare { !is_vector(leaf) } else { true };
        leaf.is_numeric() && leaf.count() > 1 && vectors
    };
    let mut elements = leaves
        .chunk_by(|&a, &b| tree.leaves[a].element == tree.leaves[b].element)
        .peekable();
    let several = leaves
        .first()
        .is_some_and(|&first| tree.leaves[first].element.is_some());
    several && elements.all(|element| element.iter().any(looks))
}

fn is_vector(leaf: &Leaf) -> bool {
    leaf.dims.iter().filter(|&&d| d != 1).count() <= 1
}

/// Lengths of the vectors among arrays; a matrix with one side of that length has it as its time.
fn vector_lengths(tree: &Tree, leaves: &[usize]) -> BTreeSet<u64> {
    let leaves = leaves.iter().map(|&index| &tree.leaves[index]);
    leaves
        .filter(|l| l.is_numeric() && is_vector(l))
        .map(Leaf::count)
        .filter(|&n| n > 1)
        .collect()
}

/// The single numbers of a file by their paths in lower case.
fn scalars(tree: &Tree) -> HashMap<String, &str> {
    let numeric = tree.leaves.iter().filter(|leaf| leaf.is_numeric());
    let valued =
        numeric.filter_map(|leaf| Some((leaf.name.to_lowercase(), leaf.value.as_deref()?)));
    valued.collect()
}

/// The last part of a path: `velocity` of `runs(2).velocity`.
fn last_part(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn is_time_name(name: &str) -> bool {
    timing::is_time_name(last_part(name))
}

/// Names of scalars that give samples per second, lower case.
const RATES: [&str; 17] = [
    "fs",
    "f_s",
    "fsamp",
    "samplerate",
    "sample_rate",
    "samplingrate",
    "sampling_rate",
    "sampling_frequency",
    "samplingfrequency",
    "sample_frequency",
    "samplefrequency",
    "srate",
    "framerate",
    "frame_rate",
    "fps",
    "wf_samples_per_second",
    "capturerate",
];

/// Names of scalars that give the time between two samples, lower case.
const STEPS: [&str; 15] = [
    "dt",
    "delta_t",
    "deltat",
    "tinterval",
    "ts",
    "timestep",
    "time_step",
    "sampleinterval",
    "sample_interval",
    "samplingtime",
    "wf_increment",
    "delta_x",
    "xinc",
    "x_inc",
    "tstep",
];

/// Names of scalars that give the time of the first sample, lower case.
const STARTS: [&str; 11] = [
    "t0",
    "t_0",
    "tstart",
    "t_start",
    "start",
    "start_time",
    "starttime",
    "start_offset",
    "wf_start_offset",
    "x0",
    "toffset",
];

/// The sample rate that a scalar's name and value state, Hz.
fn stated_rate(name: &str, value: &str) -> Option<f64> {
    let name = last_part(name).to_lowercase();
    let (bare, symbol) = units::split_unit(&name);
    let unit = symbol.map(units::parse_split_unit);
    let of = |dimension: Dimension| match unit {
        None => Some(1.0),
        Some(unit) => unit.filter(|u| u.dimension == dimension).map(|u| u.to_si),
    };
    let value = value
        .parse::<f64>()
        .ok()
        .filter(|v| v.is_finite() && *v > 0.0)?;
    let rate = if RATES.contains(&bare) {
        value * of(Dimension::Frequency)?
    } else {
        (STEPS.contains(&bare))
            .then(|| of(Dimension::Time))?
            .map(|s| (value * s).recip())?
    };
    Some(rate).filter(|r| r.is_finite())
}

/// What scalars state of one array alone.
#[derive(Default)]
struct OwnClock {
    rate_hz: Option<f64>,
    start_s: Option<f64>,
}

struct Builder<'t> {
    tree: &'t Tree,
    arranged: Arranged,
    texts: HashMap<&'t str, &'t str>,
    shared: BTreeMap<String, String>,
    times: Vec<usize>,
    /// Single numbers by their paths in lower case.
    scalars: HashMap<String, &'t str>,
}

impl<'t> Builder<'t> {
    fn new(tree: &'t Tree, records: &[bool]) -> Self {
        let common = || tree.leaves.iter().filter(|leaf| !records[leaf.variable]);
        let texts = tree.leaves.iter().filter(|leaf| !leaf.is_numeric());
        let texts = texts
            .filter_map(|l| Some((l.name.as_str(), l.value.as_deref()?)))
            .collect();
        let shared = common().filter_map(|l| Some((l.name.clone(), l.value.clone()?)));
        let sizes = tree.leaves.iter().map(|leaf| leaf.part().bytes + 128);
        let mut left = sizes.sum::<u64>() / tree.leaves.len().max(1) as u64;
        let affordable = |(name, value): &(String, String)| {
            let size = (name.len() + value.len() + 64) as u64;
            let fits = size <= left;
            left = left.saturating_sub(size);
            fits
        };
        let shared = shared.take_while(affordable).collect();
        let is_time = |(_, leaf): &(usize, &Leaf)| {
            let open = !records[leaf.variable] && is_vector(leaf) && leaf.count() > 1;
            open && matches!(leaf.content, Content::Real(_)) && is_time_name(&leaf.name)
        };
        let times = tree
            .leaves
            .iter()
            .enumerate()
            .filter(is_time)
            .map(|(i, _)| i)
            .collect();
        Self {
            tree,
            arranged: Arranged {
                notes: tree.notes.iter().cloned().chain(tree.left_out()).collect(),
                ..Arranged::default()
            },
            texts,
            shared,
            times,
            scalars: scalars(tree),
        }
    }

    /// What scalars beside an array in its struct, or those named after it (`x_dt`, `t0_x`), state of it.
    fn own_clock(&self, name: &str) -> OwnClock {
        let name = name.to_lowercase();
        let parent = name.rsplit_once('.').map_or("", |(parent, _)| parent);
        let find = |key: &str| {
            let beside = (!parent.is_empty()).then(|| self.scalars.get(&format!("{parent}.{key}")));
            let named = [
                format!("{name}_{key}"),
                format!("{key}_{name}"),
                format!("{name}.{key}"),
            ];
            let named = || named.iter().find_map(|n| self.scalars.get(n));
            beside.flatten().or_else(named).copied()
        };
        let rate = RATES
            .iter()
            .chain(&STEPS)
            .find_map(|key| stated_rate(key, find(key)?));
        let start = STARTS.iter().find_map(|key| find(key)?.parse::<f64>().ok());
        OwnClock {
            rate_hz: rate,
            start_s: start.filter(|s| s.is_finite()),
        }
    }

    /// The dataset of all variables that are no records.
    fn common(&mut self, leaves: &[usize]) {
        let named: Vec<_> = leaves
            .iter()
            .map(|&l| (l, self.tree.leaves[l].name.clone()))
            .collect();
        let lengths = vector_lengths(self.tree, leaves);
        let values = leaves.iter().map(|&l| &self.tree.leaves[l]);
        let attributes = values
            .filter_map(|l| Some((l.name.clone(), l.value.clone()?)))
            .collect();
        self.dataset(String::new(), &named, &lengths, attributes);
    }

    /// The dataset of one element of an array of records.
    fn record(&mut self, leaves: &[usize]) {
        let tree = self.tree;
        let first = &tree.leaves[leaves[0]];
        let inner = |leaf: &Leaf| {
            if leaf.tail == leaf.name {
                tree.variables[leaf.variable].name.clone()
            } else {
                leaf.tail.clone()
            }
        };
        let mut named: Vec<_> = leaves
            .iter()
            .map(|&l| (l, inner(&tree.leaves[l])))
            .collect();
        let mut lengths = vector_lengths(tree, leaves);
        lengths.extend(self.times.iter().map(|&time| tree.leaves[time].count()));
        let has_time = named.iter().any(|(_, name)| is_time_name(name));
        let fits = |&&time: &&usize| {
            let length = tree.leaves[time].count();
            leaves
                .iter()
                .any(|&l| tree.leaves[l].dims.contains(&length))
        };
        if let Some(&time) = self.times.iter().find(fits).filter(|_| !has_time) {
            named.insert(0, (time, tree.leaves[time].name.clone()));
        }
        let mut attributes = self.shared.clone();
        for leaf in leaves.iter().map(|&l| &tree.leaves[l]) {
            attributes.extend(leaf.value.clone().map(|value| (inner(leaf), value)));
        }
        let path = first.name.strip_suffix(&first.tail).unwrap_or(&first.name);
        let name = if path.is_empty() {
            &first.name
        } else {
            path.trim_end_matches('.')
        };
        self.dataset(name.to_owned(), &named, &lengths, attributes);
    }

    fn dataset(
        &mut self,
        name: String,
        leaves: &[(usize, String)],
        lengths: &BTreeSet<u64>,
        attributes: BTreeMap<String, String>,
    ) {
        let rate = attributes
            .iter()
            .find_map(|(name, value)| stated_rate(name, value));
        let (mut channels, mut origins) = (Vec::new(), Vec::new());
        for (leaf, name) in leaves {
            let slices = self.slices(*leaf, lengths);
            let count = slices.len();
            for (suffix, samples, slice) in slices {
                let mut channel = self.channel(*leaf, format!("{name}{suffix}"), samples, rate);
                if let Some(text) = self.column_label(*leaf, slice, count) {
                    let (label, unit) = name_and_unit(&text);
                    channel.unit = channel.unit.or(unit);
                    channel.properties.insert("label".to_owned(), label);
                }
                channels.push(channel);
                origins.push(Origin { leaf: *leaf, slice });
            }
        }
        timing::own_axes(&mut channels);
        let named = timing::main_axis(&channels);
        let pairs = self.pairs(&origins, &mut channels);
        let time_axis = named.or(pairs);
        self.arranged.datasets.push(DatasetInfo {
            name,
            channels,
            time_axis,
            attributes,
        });
        self.arranged.origins.push(origins);
    }

    /// Matrices of two columns, time and signal, with the signal's name and unit in texts beside them:
    /// name the signals; gives the first time axis.
    fn pairs(&self, origins: &[Origin], channels: &mut [ChannelInfo]) -> Option<usize> {
        let mut first = None;
        for (i, origin) in origins.iter().enumerate() {
            let leaf = &self.tree.leaves[origin.leaf];
            if leaf.dims.len() != 2 || leaf.dims[1] != 2 || origin.slice != Slice::Column(0) {
                continue;
            }
            let unit = self.beside(&leaf.name, &["unit", "units", "yunit", "chanunit"]);
            let name = self.beside(&leaf.name, &["channame", "channelname", "channel", "name"]);
            let [time, signal, ..] = &mut channels[i..] else {
                continue;
            };
            if unit.is_none() && name.is_none() {
                continue;
            }
            time.unit = Some("s".to_owned());
            signal.clock = Clock::Axis(i);
            signal.unit = unit.or(signal.unit.take());
            if let Some(name) = name {
                signal.name = name;
            }
            first = first.or(Some(i));
        }
        first
    }

    /// A text beside an array: a variable or field of one of these names, whatever its case.
    fn beside(&self, name: &str, keys: &[&str]) -> Option<String> {
        let parent = name.rsplit_once('.').map_or("", |(parent, _)| parent);
        let is_it = |text: &str| {
            let (own, last) = text.rsplit_once('.').unwrap_or(("", text));
            own == parent && keys.contains(&last.to_lowercase().as_str())
        };
        let mut found: Vec<&str> = self
            .texts
            .iter()
            .filter(|(text, value)| is_it(text) && !value.trim().is_empty())
            .map(|(_, value)| value.trim())
            .collect();
        found.sort_unstable();
        found.first().map(|text| (*text).to_owned())
    }

    fn channel(&self, leaf: usize, name: String, samples: u64, rate: Option<f64>) -> ChannelInfo {
        let leaf = &self.tree.leaves[leaf];
        let mut properties = BTreeMap::from([("class".to_owned(), leaf.class.clone())]);
        if leaf.logical {
            properties.insert("logical".into(), "true".into());
        }
        if samples != leaf.count() && leaf.is_numeric() {
            let dims: Vec<String> = leaf.dims.iter().map(u64::to_string).collect();
            properties.insert("shape".into(), dims.join("x"));
        }
        let own = self.own_clock(&leaf.name);
        let differs = own
            .rate_hz
            .filter(|own| rate.is_none_or(|rate| (own / rate - 1.0).abs() > 1e-9));
        let (label, in_label) = self.label(&leaf.name).map_or((None, None), |text| {
            let (label, unit) = name_and_unit(&text);
            (Some(label), unit)
        });
        properties.extend(label.map(|label| ("label".to_owned(), label)));
        ChannelInfo {
            unit: self.unit(&leaf.name).or(in_label),
            name,
            stored: leaf.stored(),
            samples,
            sample_rate_hz: differs
                .or(rate)
                .filter(|_| samples > 1 && leaf.is_numeric()),
            start_time: None,
            clock: differs.map_or(Clock::Shared, |_| Clock::Rate),
            start_s: own.start_s,
            properties,
        }
    }

    /// The channels of an array: suffix of the name, samples and slice of each.
    fn slices(&mut self, leaf: usize, lengths: &BTreeSet<u64>) -> Vec<(String, u64, Slice)> {
        let leaf = &self.tree.leaves[leaf];
        if !leaf.is_numeric() {
            return vec![(String::new(), text::row_count(leaf), Slice::Whole)];
        }
        let count = leaf.count();
        let rows = leaf.dims[0];
        if count == 0 || is_vector(leaf) || rows == 0 {
            return vec![(String::new(), count, Slice::Whole)];
        }
        let columns = count / rows;
        if leaf.dims.len() == 2 && is_by_rows(rows, columns, lengths) {
            let note = format!("matrix {} of {rows}x{columns} read by rows", leaf.name);
            self.arranged.notes.push(note);
            let row = |row: u64| (format!("({},:)", row + 1), columns, Slice::Row(row));
            return (0..rows).map(row).collect();
        }
        if columns > MOST_COLUMNS {
            let note = format!(
                "array {} has {columns} columns: read as one channel",
                leaf.name
            );
            self.arranged.notes.push(note);
            return vec![(String::new(), count, Slice::Whole)];
        }
        let column = |column: u64| {
            (
                column_suffix(&leaf.dims, column),
                rows,
                Slice::Column(column),
            )
        };
        (0..columns).map(column).collect()
    }
}

/// Whether a matrix holds a channel in each row: where the length of its rows is that of a
/// vector beside it, or if it is far wider than tall.
fn is_by_rows(rows: u64, columns: u64, lengths: &BTreeSet<u64>) -> bool {
    let stated = lengths.contains(&columns) && !lengths.contains(&rows);
    let wide = columns >= rows.saturating_mul(WIDE) && !lengths.contains(&rows);
    columns > rows && rows <= MOST_COLUMNS && (stated || wide)
}

/// `(:,2)` for a matrix, `(:,2,1)` for an array of three dimensions.
fn column_suffix(dims: &[u64], mut column: u64) -> String {
    let mut parts = vec![":".to_owned()];
    for &dim in &dims[1..] {
        parts.push((column % dim.max(1) + 1).to_string());
        column /= dim.max(1);
    }
    format!("({})", parts.join(","))
}
