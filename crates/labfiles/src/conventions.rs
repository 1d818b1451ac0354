//! What files that `labfiles-write` writes state beyond their formats, so that records come back as they were: reader and
//! writer agree on it here.

use std::collections::BTreeMap;

use crate::channel::{ChannelInfo, Clock};

/// The remark of a text table that numbers its columns of texts.
pub const TEXTS_KEY: &str = "impactid_texts";
/// The key under which the footer of a Parquet file keeps each record's attributes, as JSON.
pub const RECORDS_KEY: &str = "impactid_records";
/// The key under which the footer of a Parquet file with several records keeps the columns that each has, as JSON.
pub const COLUMNS_KEY: &str = "impactid_columns";
/// When channels begin, s, as `contact=0.3|x=0`.
pub const STARTS_KEY: &str = "channel_starts_s";
/// The time axes and rates of channels that have their own, as `slow=axis:X_Value 2|gauge=rate:500`.
pub const CLOCKS_KEY: &str = "channel_clocks";

/// The attributes that keep the clocks of channels under their names in the output; none where they are all alike.
pub fn attributes_of_clocks(names: &[String], channels: &[ChannelInfo]) -> Vec<(String, String)> {
    let named = || names.iter().zip(channels);
    let mut starts = named()
        .filter_map(|(name, c)| Some((name, c.start_s?)))
        .peekable();
    let first = starts.peek().map(|(_, start)| *start);
    let starts: Vec<(&String, f64)> = starts.collect();
    let unlike = starts.iter().any(|(_, start)| Some(*start) != first);
    let starts = starts.iter().filter(|_| unlike);
    let starts = starts.map(|(name, start)| format!("{name}={start}"));
    let clocks = named().filter_map(|(name, channel)| match channel.clock {
        Clock::Shared => None,
        Clock::Axis(axis) => Some(format!("{name}=axis:{}", names.get(axis)?)),
        Clock::Rate => Some(format!("{name}=rate:{}", channel.sample_rate_hz?)),
    });
    let of = |key: &str, parts: Vec<String>| {
        (!parts.is_empty()).then(|| (key.to_owned(), parts.join("|")))
    };
    let all = [
        of(STARTS_KEY, starts.collect()),
        of(CLOCKS_KEY, clocks.collect()),
    ];
    all.into_iter().flatten().collect()
}

/// Give channels the clocks that the attributes keep.
pub(crate) fn apply_clocks(channels: &mut [ChannelInfo], attributes: &BTreeMap<String, String>) {
    let pairs = |key: &str| {
        let text = attributes.get(key).map_or("", String::as_str);
        text.split('|')
            .filter_map(|pair| pair.rsplit_once('='))
            .collect::<Vec<_>>()
    };
    let place = |channels: &[ChannelInfo], name: &str| channels.iter().position(|c| c.name == name);
    for (name, start) in pairs(STARTS_KEY) {
        if let Some(channel) = place(channels, name) {
            channels[channel].start_s = start.parse::<f64>().ok().filter(|s| s.is_finite());
        }
    }
    for (name, clock) in pairs(CLOCKS_KEY) {
        let Some(channel) = place(channels, name) else {
            continue;
        };
        let rate = clock
            .strip_prefix("rate:")
            .and_then(|r| r.parse::<f64>().ok());
        let axis = clock
            .strip_prefix("axis:")
            .and_then(|axis| place(channels, axis));
        if let Some(axis) = axis {
            channels[channel].clock = Clock::Axis(axis);
        } else if let Some(rate) = rate.filter(|r| r.is_finite() && *r > 0.0) {
            channels[channel].clock = Clock::Rate;
            channels[channel].sample_rate_hz = Some(rate);
        }
    }
}

/// The time that a function of a universal file covers: functions at one time are channels of one record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Of its first sample, s.
    pub start_s: f64,
    /// From it to the end, s.
    pub length_s: f64,
}

impl Span {
    /// Whether two have half of the time of the shorter in common: they then belong to one record, even where one
    /// begins later or has another rate.
    pub fn overlaps(self, other: Self) -> bool {
        let end = |span: Self| span.start_s + span.length_s;
        let common = end(self).min(end(other)) - self.start_s.max(other.start_s);
        common >= 0.5 * self.length_s.min(other.length_s) && common > 0.0
    }
}
