//! NI TDMS files of versions 4712 and 4713.
//!
//! How a file maps to datasets and channels:
//!
//! - Each group that has channels is a dataset, named as the group; its channels carry their own
//!   names, so that records kept as groups of one file have channels of the same names. The
//!   properties of the file and of the group are the dataset's attributes.
//! - `unit_string` (else `NI_UnitDescription`) is the unit, 1/`wf_increment` the sample rate
//!   in the unit of time that `wf_xunit_string` names (none of another quantity), `wf_start_time` the start. All
//!   properties are kept as text.
//! - `wf_start_time` and `wf_start_offset` state when a channel's first sample was taken.
//! - `NI_Scale` chains of linear, polynomial and table scales are applied, also to `DAQmx` raw
//!   data; a channel with another scaling is listed, and reading it is refused by the scaling's
//!   name. A scaled channel is described as 64-bit floating point, with the raw type as a property.
//! - A channel of time stamps gives seconds since its first stamp (no precision is lost that
//!   way); the first stamp is its start time, and it is the dataset's time axis.
//! - A last segment that was cut short is read as far as it goes, with a note.

mod content;
mod index;
mod layout;
mod samples;
mod scale;
mod segment;
#[cfg(test)]
mod tests;
mod value;

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use content::{Content, Object};
use samples::Chunks;
use scale::{Scaling, ScalingFault};
use value::{Kind, Stamp, Value};

use crate::bytes::FileBytes;
use crate::source::{
    ChannelInfo, Clock, DatasetInfo, ReadError, Reader, Samples, Source, StoredType, opened,
};
use crate::timing::{StatedUnit, stated_unit};

/// The scaling of a channel, or what of it is not done; shared by channels that inherit it.
type Scale = Arc<Result<Scaling, ScalingFault>>;

/// Whether a file's first bytes are those of a TDMS file, or of its index, which [`open`] refuses
/// with the remedy.
pub(crate) fn recognises(head: &[u8]) -> bool {
    head.starts_with(b"TDSm") || head.starts_with(b"TDSh")
}

/// Open a TDMS file: the metadata of all segments is read, no samples are.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let file = FileBytes::open(path)?;
    if file.all().starts_with(b"TDSh") {
        let remedy = "open the .tdms file itself";
        return Err(file.unsupported(0, "a TDMS index (.tdms_index)", "a TDMS file", remedy));
    }
    let content = segment::scan(&file)?;
    let (datasets, channels) = records(&file, &content)?;
    let notes = content.notes.clone();
    let reader = TdmsFile {
        file,
        content,
        channels,
    };
    opened("tdms", path, datasets, notes, reader)
}

/// Records, and for each of their channels its object and its scaling.
type Records = (Vec<DatasetInfo>, Vec<Vec<(usize, Scale)>>);

struct TdmsFile {
    file: FileBytes,
    content: Content,
    /// For each dataset its channels: the object and its scaling.
    channels: Vec<Vec<(usize, Scale)>>,
}

impl TdmsFile {
    /// The samples of a channel that exists.
    fn channel(&self, dataset: usize, channel: usize) -> Result<Samples, ReadError> {
        let (object, scale) = &self.channels[dataset][channel];
        let object = &self.content.objects[*object];
        let unread = |fault: &ScalingFault| {
            let expected = "linear, polynomial or table scaling";
            let remedy =
                "save the channel scaled, or scale it in campaign.toml from its raw values";
            ReadError::new(self.file.path(), expected, fault.to_string(), remedy)
        };
        let reader = Chunks {
            file: &self.file,
            content: &self.content,
        };
        let scaling = scale.as_ref().as_ref().map_err(unread);
        scaling
            .and_then(|scaling| reader.samples(object, scaling))
            .map_err(|e| e.channel(object.path.join("/")))
    }
}

impl Reader for TdmsFile {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        self.file.still_whole()?;
        channels
            .iter()
            .map(|&channel| self.channel(dataset, channel))
            .collect()
    }
}

/// The groups of a file as records, and for each channel its object and scaling: its own, its
/// group's or the file's.
fn records(file: &FileBytes, content: &Content) -> Result<Records, ReadError> {
    let own = |object: &Object| Scaling::of(&object.properties).map(Arc::new);
    let owners = content.objects.iter().filter(|o| o.path.len() < 2);
    let owners: HashMap<&[String], (&Object, Option<Scale>)> =
        owners.map(|o| (&o.path[..], (o, own(o)))).collect();
    let mut groups: HashMap<&str, usize> = HashMap::new();
    let (mut datasets, mut channels): Records = Default::default();
    for (index, object) in content.objects.iter().enumerate() {
        let [group, name] = object.path.as_slice() else {
            continue;
        };
        let owner = owners.get(&object.path[..1]);
        let dataset = *groups.entry(group).or_insert_with(|| {
            datasets.push(DatasetInfo {
                name: group.clone(),
                channels: Vec::new(),
                time_axis: None,
                attributes: owner.map_or(BTreeMap::new(), |(o, _)| texts(&o.properties)),
            });
            channels.push(Vec::new());
            datasets.len() - 1
        });
        let scale = own(object)
            .or_else(|| owner?.1.clone())
            .or_else(|| owners.get(&[][..])?.1.clone())
            .unwrap_or_else(|| Arc::new(Ok(Scaling::default())));
        let reader = Chunks { file, content };
        let info = info(&reader, object, name, &scale)?;
        let target = &mut datasets[dataset];
        if info.stored == StoredType::Time && target.time_axis.is_none() {
            target.time_axis = Some(target.channels.len());
        }
        target.channels.push(info);
        channels[dataset].push((index, scale));
    }
    for (dataset, channels) in datasets.iter_mut().zip(&channels) {
        state_starts(dataset, channels, content);
    }
    if let Some((root, _)) = owners.get(&[][..]) {
        share_root(root, &mut datasets, file.size());
    }
    Ok((datasets, channels))
}

/// Repeat the file's properties with every group, or with the first only where that would
/// take more memory than the file.
fn share_root(root: &Object, datasets: &mut [DatasetInfo], size_of_file: u64) {
    let all = texts(&root.properties);
    let size: usize = all
        .iter()
        .map(|(name, value)| name.len() + value.len() + 64)
        .sum();
    let affordable = (size * datasets.len()) as u64 <= size_of_file.max(1 << 16);
    let reach = if affordable { datasets.len() } else { 1 };
    for dataset in datasets.iter_mut().take(reach) {
        for (name, value) in &all {
            dataset
                .attributes
                .entry(name.clone())
                .or_insert_with(|| value.clone());
        }
    }
}

fn info(
    reader: &Chunks<'_>,
    object: &Object,
    name: &str,
    scale: &Scale,
) -> Result<ChannelInfo, ReadError> {
    let kind = object
        .kind
        .unwrap_or(Kind::Number(crate::numbers::Number::F64));
    let mut properties = texts(&object.properties);
    let raw = match reader.first_device(object) {
        Some(device) => device.scalers[0].number.stored(),
        None => kind.stored(),
    };
    use StoredType::{Bool, Complex, Text, Time};
    let number = !matches!(raw, Text | Time | Bool | Complex(_));
    let scaled = number && scale.as_ref().as_ref().map_or(true, Scaling::changes);
    if scaled {
        properties.insert("raw_type".into(), format!("{raw:?}"));
    }
    let is_time = kind == Kind::Time;
    let first = if is_time {
        reader.first_stamp(object)?
    } else {
        None
    };
    let property = |key: &str| object.properties.get(key);
    let stated = ["unit_string", "NI_UnitDescription"]
        .into_iter()
        .filter_map(property);
    let unit = stated.map(Value::text).find(|unit| !unit.is_empty());
    let start = match property("wf_start_time") {
        Some(Value::Time(stamp)) => stamp.iso8601(),
        _ => None,
    };
    Ok(ChannelInfo {
        name: name.to_owned(),
        unit: if is_time { Some("s".into()) } else { unit },
        stored: if scaled { StoredType::Float(64) } else { raw },
        samples: object.samples,
        sample_rate_hz: sample_rate(&object.properties),
        start_time: first.and_then(Stamp::iso8601).or(start),
        clock: Clock::Shared,
        start_s: None,
        properties,
    })
}

fn texts(properties: &BTreeMap<String, Value>) -> BTreeMap<String, String> {
    properties
        .iter()
        .map(|(name, value)| (name.clone(), value.text()))
        .collect()
}

/// When the first samples of a group's channels were taken, s after the first start that any of them states:
/// `wf_start_time` and `wf_start_offset` together.
fn state_starts(dataset: &mut DatasetInfo, channels: &[(usize, Scale)], content: &Content) {
    let properties = channels
        .iter()
        .map(|(object, _)| &content.objects[*object].properties);
    let starts: Vec<Start> = properties.map(Start::of).collect();
    let origin = starts.iter().find_map(|s| s.stamp);
    for (channel, start) in dataset.channels.iter_mut().zip(starts) {
        let after = |origin| start.stamp.map(|stamp| stamp.seconds_since(origin));
        let known = match origin {
            Some(origin) => after(origin).map(|s| s + start.offset_s.unwrap_or(0.0)),
            None => start.offset_s,
        };
        channel.start_s = known.filter(|s| s.is_finite() && channel.sample_rate_hz.is_some());
    }
}

/// What a channel's properties state of its start.
struct Start {
    stamp: Option<Stamp>,
    offset_s: Option<f64>,
}

impl Start {
    fn of(properties: &BTreeMap<String, Value>) -> Self {
        let stamp = match properties.get("wf_start_time") {
            Some(Value::Time(stamp)) => Some(*stamp).filter(|s| s.seconds != 0),
            _ => None,
        };
        let offset = properties.get("wf_start_offset").and_then(Value::number);
        let offset_s = offset.zip(abscissa_s(properties)).map(|(n, unit)| n * unit);
        Self { stamp, offset_s }
    }
}

/// Seconds in the unit of the abscissa; `None` where it is not time.
fn abscissa_s(properties: &BTreeMap<String, Value>) -> Option<f64> {
    let text = properties
        .get("wf_xunit_string")
        .map(Value::text)
        .unwrap_or_default();
    match stated_unit(Some(&text), "") {
        StatedUnit::Known(unit) => Some(unit.to_si),
        StatedUnit::Nothing => Some(1.0),
        StatedUnit::Other(_) => None,
    }
}

/// 1/`wf_increment` where the abscissa is time.
fn sample_rate(properties: &BTreeMap<String, Value>) -> Option<f64> {
    let increment = properties.get("wf_increment").and_then(Value::number)?;
    let rate = (increment * abscissa_s(properties)?).recip();
    (rate.is_finite() && rate > 0.0).then_some(rate)
}
