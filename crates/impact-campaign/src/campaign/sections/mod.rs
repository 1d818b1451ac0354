//! The sections of campaign.toml, a file each: its keys as written, and what they are once resolved.

pub mod about;
pub mod analysis;
pub mod channels;
pub mod published;
pub mod records;
pub mod report;
pub mod rig;

use super::keys::Key;

/// Each section: its heading in docs/campaign.md, its keys, and the heading of what they state.
pub const SECTIONS: [(&str, &[Key], &str); 8] = [
    ("campaign", about::AboutTable::KEYS, "meaning"),
    ("records", records::RecordsTable::KEYS, "meaning"),
    (
        "records.attributes",
        records::AttributesTable::KEYS,
        "attribute with",
    ),
    ("rig", rig::RigTable::KEYS, "meaning"),
    ("channels.ROLE", channels::ChannelTable::KEYS, "meaning"),
    ("analysis", analysis::AnalysisTable::KEYS, "meaning"),
    ("report", report::ReportTable::KEYS, "meaning"),
    ("published", published::Published::KEYS, "meaning"),
];
