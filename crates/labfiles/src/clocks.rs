//! How files that this crate writes keep the clocks of channels: as attributes of the record.

use std::collections::BTreeMap;

use crate::channel::{ChannelInfo, Clock};

/// When channels begin, s, as `contact=0.3|x=0`.
pub(crate) const STARTS_KEY: &str = "channel_starts_s";
/// The time axes and rates of channels that have their own, as `slow=axis:X_Value 2|gauge=rate:500`.
pub(crate) const CLOCKS_KEY: &str = "channel_clocks";

/// The attributes that keep the clocks of channels under their names in the output; none where they are all alike.
pub(crate) fn attributes(names: &[String], channels: &[ChannelInfo]) -> Vec<(String, String)> {
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
pub(crate) fn apply(channels: &mut [ChannelInfo], attributes: &BTreeMap<String, String>) {
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
