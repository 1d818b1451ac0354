//! From a tree of groups and arrays to datasets (records) of channels.
//!
//! A two-dimensional array is a record: its columns are the channels (its rows, if those are as
//! many as the names). The one-dimensional arrays of a group are a record together. A three-dimensional
//! array is a record for each entry of its first dimension. Arrays of one element beside longer
//! ones are attributes of their group. Attributes are inherited downward.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::attribute;
use crate::bytes::to_usize;
use crate::formats::hdf5::element::Element;
use crate::formats::hdf5::library::Store;
use crate::formats::hdf5::naming::{
    MOST_CHANNELS, NAME_KEYS, Orientation, Scope, UNIT_KEYS, names, natural, scaling, squeezed,
    units,
};
use crate::formats::hdf5::store::{Array, Attr, Attrs, StoreError, Tree};
use crate::numbers::Spacing;
use crate::source::{ChannelInfo, Clock, DatasetInfo};
use crate::timing::{is_time_name, main_axis, own_axes};

/// The spacing of a single element.
const ONE: Spacing = Spacing {
    offset: 0,
    stride: 8,
    count: 1,
};

/// Where the samples of a channel are.
#[derive(Debug, Clone)]
pub(crate) struct Locator {
    /// Index into the plan's arrays.
    pub array: usize,
    /// What they are.
    pub element: Element,
    /// Which of the array's bytes they are.
    pub spacing: Spacing,
    /// Scale and offset: value = stored · scale + offset.
    pub scaling: (f64, f64),
}

/// How to read one dataset.
#[derive(Debug, Clone, Default)]
pub(crate) struct Plan {
    /// The arrays that it takes, each read once.
    pub arrays: Vec<Array>,
    /// Its channels.
    pub channels: Vec<Locator>,
    /// The entry along the first dimension of a three-dimensional array.
    pub slab: Option<u64>,
}

/// The records of a file: how they are described and how they are read.
#[derive(Default)]
pub(crate) struct Plans {
    /// Descriptions.
    pub datasets: Vec<DatasetInfo>,
    /// Ways of reading, one for each description.
    pub plans: Vec<Plan>,
    /// What was left out.
    pub notes: Vec<String>,
}

/// Make records of a tree.
pub(crate) fn plan(store: &Store, tree: &Tree) -> Plans {
    Plans::of_group(store, tree, &Attrs::new())
}

impl Plans {
    fn of_group(store: &Store, tree: &Tree, inherited: &Attrs) -> Self {
        let mut plans = Self::default();
        let mut attributes = Scope::within(inherited, &tree.attributes).merged();
        let sorted = plans.sort(store, tree, &mut attributes);
        plans.tables(&sorted, tree, &attributes);
        for array in &sorted.slabs {
            plans.slabs(array, &attributes);
        }
        for array in &sorted.compounds {
            plans.compound(array, &attributes);
        }
        let mut groups: Vec<&Tree> = tree.groups.iter().collect();
        groups.sort_by(|a, b| natural(&a.path, &b.path));
        let below = groups.par_iter();
        let below = below.map(|group| Self::of_group(store, group, &attributes));
        for group in below.collect::<Vec<_>>() {
            plans.datasets.extend(group.datasets);
            plans.plans.extend(group.plans);
            plans.notes.extend(group.notes);
        }
        plans
    }

    /// Sort a group's arrays by what they are good for; small ones become attributes.
    fn sort<'a>(&mut self, store: &Store, tree: &'a Tree, attributes: &mut Attrs) -> Sorted<'a> {
        let mut sorted = Sorted::default();
        let long = tree
            .arrays
            .iter()
            .any(|a| a.element.is_number() && a.count() > Some(1));
        for array in &tree.arrays {
            let small = array.count() == Some(1) && (long || array.shape.is_empty());
            match (&array.element, squeezed(&array.shape).len()) {
                (Element::Text, _)
                    if small
                        || NAME_KEYS.contains(&array.name.as_str())
                        || UNIT_KEYS.contains(&array.name.as_str()) =>
                {
                    match store.texts(array) {
                        Ok(texts) => {
                            attributes.insert(array.name.clone(), Attr::Text(texts));
                        }
                        Err(e) => self.unread(array, &e),
                    }
                }
                (e, _) if e.is_number() && small => {
                    let raw = store.raw(array).map_err(|fault| self.unread(array, &fault));
                    let value = raw.ok().and_then(|r| e.decode(&r, ONE)?.into_real());
                    attributes.extend(value.map(|v| (array.name.clone(), Attr::Numbers(v))));
                }
                (e, 1) if e.is_number() && is_named_table(array) => sorted.tables.push(array),
                (Element::Text, 0 | 1) => sorted.columns.push(array),
                (e, 0 | 1) if e.is_number() => sorted.columns.push(array),
                (e, 2) if e.is_number() => sorted.tables.push(array),
                (e, 3) if e.is_number() => sorted.slabs.push(array),
                (Element::Fields { .. }, 0 | 1) => sorted.compounds.push(array),
                (e, n) => self.notes.push(format!(
                    "dataset '{}' left out: {n} dimensions of {e:?}",
                    array.path
                )),
            }
        }
        sorted.tables.sort_by(|a, b| natural(&a.path, &b.path));
        sorted
    }

    /// Note that an array which would be an attribute cannot be read.
    fn unread(&mut self, array: &Array, fault: &StoreError) {
        let note = format!("dataset '{}' left out: {fault}", array.path);
        self.notes.push(note);
    }

    /// Records of a group's tables and columns; a column as long as a table's rows that is
    /// a time axis goes with the table.
    fn tables(&mut self, sorted: &Sorted<'_>, tree: &Tree, attributes: &Attrs) {
        let Sorted {
            tables, columns, ..
        } = sorted;
        let matches = |table: &Array| {
            let rows = Orientation::of(table, attributes).samples(table);
            !columns.is_empty() && columns.iter().all(|c| c.count() == Some(rows))
        };
        if let [table] = tables[..]
            && matches(table)
        {
            let mut record = Record::new(tree.path.clone(), Scope::of(attributes));
            columns.iter().for_each(|c| record.column(c));
            record.table(table, attributes);
            return self.push(record);
        }
        let of_table = |table: &&Array| Record::of_table(table, columns, attributes);
        let described: Vec<_> = tables.par_iter().map(of_table).collect();
        for (record, note) in described {
            self.notes.extend(note);
            self.push(record);
        }
        if !columns.is_empty() {
            let mut record = Record::new(tree.path.clone(), Scope::of(attributes));
            columns.iter().for_each(|c| record.column(c));
            self.push(record);
        }
    }

    fn slabs(&mut self, array: &Array, attributes: &Attrs) {
        let scope = Scope::within(attributes, &array.attributes);
        let Some((&slabs, inner)) = array.shape.split_first() else {
            return;
        };
        if slabs > MOST_SLABS || inner.len() != 2 {
            return self.notes.push(format!(
                "dataset '{}' left out: {slabs} records",
                array.path
            ));
        }
        let table = Array {
            shape: inner.to_vec(),
            ..array.clone()
        };
        for slab in 0..slabs {
            let mut record = Record::new(format!("{}[{slab}]", array.path), scope);
            record.table(&table, attributes);
            record.plan.arrays = vec![array.clone()];
            record.plan.slab = Some(slab);
            self.push(record);
        }
    }

    fn compound(&mut self, array: &Array, attributes: &Attrs) {
        let Element::Fields { fields, .. } = &array.element else {
            return;
        };
        let scope = Scope::within(attributes, &array.attributes);
        let units = units(Scope::of(&array.attributes), fields.len());
        let mut record = Record::new(array.path.clone(), scope);
        record.plan.arrays.push(array.clone());
        for (i, (name, offset, element)) in fields.iter().enumerate() {
            if element.is_number() {
                let locator = Locator {
                    array: 0,
                    element: element.clone(),
                    spacing: Spacing {
                        offset: *offset,
                        ..whole(array)
                    },
                    scaling: (1.0, 0.0),
                };
                record.channel(name.clone(), units.get(i).cloned().flatten(), locator);
            }
        }
        self.push(record);
    }

    fn push(&mut self, record: Record) {
        if !record.info.channels.is_empty() {
            let (info, plan) = record.finish();
            self.datasets.push(info);
            self.plans.push(plan);
        }
    }
}

/// The most entries of a three-dimensional array.
const MOST_SLABS: u64 = 1 << 20;

#[derive(Default)]
struct Sorted<'a> {
    columns: Vec<&'a Array>,
    tables: Vec<&'a Array>,
    slabs: Vec<&'a Array>,
    compounds: Vec<&'a Array>,
}

/// A record being put together.
struct Record {
    info: DatasetInfo,
    plan: Plan,
}

impl Record {
    fn new(name: String, scope: Scope<'_>) -> Self {
        let info = DatasetInfo {
            name,
            attributes: scope.texts(),
            ..DatasetInfo::default()
        };
        let plan = Plan::default();
        Self { info, plan }
    }

    /// A table by itself, with the time axis among the columns beside it; and a note if it has more
    /// channels than are read.
    fn of_table(table: &Array, columns: &[&Array], inherited: &Attrs) -> (Self, Option<String>) {
        let scope = Scope::within(inherited, &table.attributes);
        let mut record = Self::new(table.path.clone(), scope);
        let orientation = Orientation::of(table, inherited);
        let rows = orientation.samples(table);
        let time = columns
            .iter()
            .find(|c| is_time_name(&c.name) && c.count() == Some(rows));
        time.into_iter().for_each(|c| record.column(c));
        record.table(table, inherited);
        let cells = table.count().unwrap_or(u64::MAX);
        let channels = cells.checked_div(rows).unwrap_or(0);
        let note = (channels > orientation.channels(table)).then(|| {
            format!(
                "dataset '{}' has {channels} channels: the first {MOST_CHANNELS} are read",
                table.path
            )
        });
        (record, note)
    }

    fn channel(&mut self, name: String, unit: Option<String>, locator: Locator) {
        self.info.channels.push(ChannelInfo {
            name,
            unit: unit.filter(|u| !u.is_empty()),
            stored: locator.element.stored(),
            samples: locator.spacing.count as u64,
            sample_rate_hz: None,
            start_time: None,
            clock: Clock::Shared,
            start_s: None,
            properties: BTreeMap::new(),
        });
        self.plan.channels.push(locator);
    }

    /// Add a one-dimensional array as a channel.
    fn column(&mut self, array: &Array) {
        let unit = UNIT_KEYS
            .iter()
            .find_map(|k| array.attributes.get(*k))
            .map(Attr::text);
        let locator = Locator {
            array: self.plan.arrays.len(),
            element: array.element.clone(),
            spacing: whole(array),
            scaling: scaling(array, 1)[0],
        };
        self.channel(array.name.clone(), unit, locator);
        self.plan.arrays.push(array.clone());
        if let Some(channel) = self.info.channels.last_mut() {
            let texts = Scope::of(&array.attributes).texts();
            channel.sample_rate_hz = attribute::sample_rate_hz(&texts);
            channel.start_time = attribute::start_time(&texts);
            channel.start_s = attribute::start_s(&texts);
            channel.properties = texts;
        }
    }

    /// Add the channels of a table.
    fn table(&mut self, table: &Array, inherited: &Attrs) {
        let orientation = Orientation::of(table, inherited);
        let channels = orientation.channels(table);
        let scope = Scope::within(inherited, &table.attributes);
        let names = names(scope, channels);
        let units = units(scope, to_usize(channels));
        let scaling = scaling(table, to_usize(channels));
        let number = self.plan.arrays.len();
        self.plan.arrays.push(table.clone());
        for (i, scaling) in (0..channels).zip(scaling) {
            let name = names
                .as_ref()
                .map_or_else(|| format!("column_{}", i + 1), |n| n[to_usize(i)].clone());
            let locator = Locator {
                array: number,
                element: table.element.clone(),
                spacing: orientation.spacing(table, i),
                scaling,
            };
            self.channel(name, units.get(to_usize(i)).cloned().flatten(), locator);
        }
        for (key, value) in &table.attributes {
            self.info
                .attributes
                .entry(key.clone())
                .or_insert_with(|| value.text());
        }
    }

    /// Give the channels the record's rate and start and find the time axis.
    fn finish(mut self) -> (DatasetInfo, Plan) {
        let rate = attribute::sample_rate_hz(&self.info.attributes);
        let start = attribute::start_time(&self.info.attributes);
        for channel in &mut self.info.channels {
            channel.sample_rate_hz = channel.sample_rate_hz.or(rate);
            channel.start_time = channel.start_time.take().or_else(|| start.clone());
        }
        self.info.time_axis = main_axis(&self.info.channels);
        own_axes(&mut self.info.channels);
        (self.info, self.plan)
    }
}

/// All elements of an array, one after the other.
fn whole(array: &Array) -> Spacing {
    Spacing {
        offset: 0,
        stride: array.element.bytes(),
        count: to_usize(array.count().unwrap_or(0)),
    }
}

/// Whether an array of samples × 1 names its one channel.
fn is_named_table(array: &Array) -> bool {
    array.shape.len() == 2 && names(Scope::of(&array.attributes), 1).is_some()
}
