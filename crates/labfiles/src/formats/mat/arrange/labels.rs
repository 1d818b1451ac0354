//! What texts beside arrays call them, and their units.

use super::{Builder, Slice, is_time_name};
use crate::bytes::to_usize;
use crate::formats::mat::tree::Leaf;
use crate::timing;

/// Names of cell arrays of texts that name the columns of a matrix.
const COLUMN_NAMES: [&str; 14] = [
    "channels",
    "Channels",
    "channelNames",
    "channel_names",
    "ChannelNames",
    "names",
    "Names",
    "labels",
    "Labels",
    "header",
    "headers",
    "columns",
    "signals",
    "varnames",
];

impl Builder<'_> {
    /// The label beside the values of a signal, as Simulink's structures with time have it.
    pub(super) fn label(&self, name: &str) -> Option<String> {
        let parent = name.strip_suffix(".values")?;
        let label = self.texts.get(format!("{parent}.label").as_str())?;
        Some(label.trim().to_owned()).filter(|label| !label.is_empty())
    }

    /// What a cell array of texts beside a matrix, or in the file, calls one of its columns: it has as many texts as the matrix has
    /// columns.
    pub(super) fn column_label(&self, leaf: usize, slice: Slice, count: usize) -> Option<String> {
        let (Slice::Column(place) | Slice::Row(place)) = slice else {
            return None;
        };
        let name = &self.tree.leaves[leaf].name;
        let parent = name.rsplit_once('.').map(|(parent, _)| parent);
        let lists = parent
            .into_iter()
            .flat_map(|parent| COLUMN_NAMES.map(|list| format!("{parent}.{list}")));
        let mut lists = lists.chain(COLUMN_NAMES.map(str::to_owned));
        let text = |list: &str, number: usize| {
            let text = self.texts.get(format!("{list}{{{number}}}").as_str())?;
            Some(text.trim()).filter(|text| !text.is_empty())
        };
        let whole = |list: &String| text(list, count).is_some() && text(list, count + 1).is_none();
        let list = lists.find(whole).filter(|_| count > 1)?;
        text(&list, to_usize(place) + 1).map(str::to_owned)
    }

    /// The unit of an array, where a text beside it states one: `x_unit`, `x_units`, the field `x` of a struct `Units`
    /// beside it, or `unit` beside the only signal of its struct.
    pub(super) fn unit(&self, name: &str) -> Option<String> {
        let (parent, last) = name.rsplit_once('.').unwrap_or(("", name));
        let beside = |units: &str| match parent {
            "" => format!("{units}.{last}"),
            _ => format!("{parent}.{units}.{last}"),
        };
        let candidates = [
            format!("{name}_unit"),
            format!("{name}_units"),
            beside("Units"),
            beside("units"),
        ];
        candidates
            .iter()
            .filter_map(|c| self.texts.get(c.as_str()))
            .map(|unit| unit.trim())
            .find(|unit| !unit.is_empty())
            .map(str::to_owned)
            .or_else(|| self.unit_of_struct(parent, name))
    }

    /// The unit that a struct states for all in it, if it contains one signal and no other but its times.
    fn unit_of_struct(&self, parent: &str, name: &str) -> Option<String> {
        let beside = |word: &str| self.texts.get(format!("{parent}.{word}").as_str());
        let unit = beside("unit").or_else(|| beside("units"))?.trim();
        let signal = |leaf: &&Leaf| {
            let (within, last) = leaf.name.rsplit_once('.').unwrap_or(("", &leaf.name));
            within == parent && leaf.is_numeric() && leaf.count() > 1 && !is_time_name(last)
        };
        let mut signals = self.tree.leaves.iter().filter(signal);
        let only = signals.next().is_some_and(|leaf| leaf.name == name) && signals.next().is_none();
        (only && !unit.is_empty() && !timing::is_unit_of_time(unit)).then(|| unit.to_owned())
    }
}
