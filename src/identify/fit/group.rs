//! Groups of records whose misfits may be alike, by several partitions of the campaign.

/// The groups of an item, one of each partition of the campaign's records.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Group {
    /// Records of one gap and direction of the sweep.
    pub setting: usize,
    /// Records of one band of drive frequencies.
    pub frequency: usize,
    /// Records of one band of amplitudes.
    pub amplitude: usize,
}

impl Group {
    /// Number of partitions.
    pub const PARTITIONS: usize = 3;

    /// The group of each partition; that by setting first.
    pub fn of_each(self) -> [usize; Self::PARTITIONS] {
        [self.setting, self.frequency, self.amplitude]
    }
}
