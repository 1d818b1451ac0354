//! Groups of records whose misfits may be alike, by several partitions of the campaign.

/// Number of partitions.
pub const PARTITIONS: usize = 3;

/// The group of an item in each partition of the campaign's records: by gap and direction of the
/// sweep, by band of drive frequencies, by band of amplitudes.
pub type Group = [usize; PARTITIONS];
