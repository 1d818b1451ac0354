//! `[records]` and `[records.attributes]`: where the records are, and the settings that none of them states.

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::values::{
    Excitation, OneOrMany, Placed, Sweep, WrittenKey, WrittenQuantity, value,
};
use impact_records::record::Setting;
use impact_records::record::calibrate::StatedTimes;
use labfiles::units::{self, Dimension};

keys! {
    /// `[records]`.
    #[serde(default)]
    pub struct RecordsTable {
        /// a glob or a list of globs: `"records/*.h5"`; `**` goes through folders
        files: Placed<OneOrMany>;
        /// a CSV table, or a workbook with a sheet of settings, instead of `files`, see below
        run_table: Placed<String>;
        /// for files that state none, `"2 kHz"`; of a camera that numbers its frames, their rate
        sample_rate: Placed<WrittenQuantity>;
        /// unit of time axes that state none: `"s"`, `"ms"`, `"us"`, `"ns"` or `"min"`. Whole numbers, or numbers
        /// beyond 10⁹, are not taken as seconds without it
        time_unit: Placed<String>;
        /// name or index of the channel with the time, if the reader cannot find it
        time: Placed<WrittenKey>;
        /// r of records that state none: half the gap of two masses, or the gap to a stop. Without any clearance R
        /// rests on the speeds at impacts alone, whose interval is then about ± 0.006 wide: how long the contacts last
        /// is not known
        clearance: Placed<WrittenQuantity>;
        /// whether the clearances that are stated, here, in the run table or in attributes, are whole gaps between two
        /// masses: half of each is used
        whole_gaps: bool, default "`false`";
        /// of records that state none, relative to the nominal one, to which x_st refers. Where the drive is recorded
        /// the measured amplitude counts: relative to the one that most records have by what they state or, where none
        /// states any, to the median
        drive_amplitude: Placed<f64>;
        /// of records that state none: `"up"`, `"down"` or `"unknown"`
        sweep: Placed<Sweep>, init r#"# sweep = "up"               # of records that state none: up, down or unknown"#;
        /// of records that state none
        drive_frequency: Placed<WrittenQuantity>,
            init r#"# drive_frequency = "12 Hz"  # measured from the drive channel; a stated one is compared with it"#;
        /// of records that state none: `"harmonic"` or `"free_decay"` (blows or a release, then no drive; each blow
        /// gives a decay of its own, fitted from the greatest excursion on, 1.5 periods or more)
        excitation: Placed<Excitation>,
            init r#"# excitation = "free_decay"  # if the records are free decays after a blow"#;
        /// names of attributes of the files, in `[records.attributes]`
        attributes: AttributesTable;
    }
}

keys! {
    /// `[records.attributes]`: names of the files' attributes, with the unit in the name
    /// (`gap_mm`) or after it in brackets (`"gap [mm]"`).
    #[serde(default)]
    pub struct AttributesTable {
        /// the clearance r
        clearance: Placed<String>;
        /// the stated drive frequency
        drive_frequency: Placed<String>;
        /// the drive amplitude, relative to the nominal one
        drive_amplitude: Placed<String>;
        /// the sweep direction: `up`, `down` or `unknown`
        sweep: Placed<String>;
        /// the rig, mass or bumper, if the campaign has several
        specimen: Placed<String>;
    }
}

impl RecordsTable {
    /// What it states of the times of records.
    pub(crate) fn times(&self, context: &mut ResolveContext<'_>) -> StatedTimes {
        let (key, rate) = ("records.sample_rate", Dimension::Frequency);
        StatedTimes {
            time: value(&self.time).map(|t| t.0),
            time_unit_s: self.time_unit_s(context),
            sample_rate_hz: context.positive(&self.sample_rate, key, rate),
        }
    }

    /// Seconds in the stated unit of time.
    fn time_unit_s(&self, context: &mut ResolveContext<'_>) -> Option<f64> {
        let placed = self.time_unit.as_ref()?;
        let unit = units::parse_unit(placed.get_ref()).filter(|u| u.dimension == Dimension::Time);
        if unit.is_none() {
            let what = format!("'{}' is no unit of time", placed.get_ref());
            let remedy = "write s, ms, us, ns or min";
            context.fault(
                Code::InvalidValue,
                placed,
                "records.time_unit",
                what,
                remedy,
            );
        }
        unit.map(|u| u.to_si)
    }
}

/// The setting of records that state none.
pub(crate) fn defaults(records: &RecordsTable, context: &mut ResolveContext<'_>) -> Setting {
    let frequency = context.positive(
        &records.drive_frequency,
        "records.drive_frequency",
        Dimension::Frequency,
    );
    let clearance = context.quantity(&records.clearance, "records.clearance", Dimension::Length);
    if clearance.is_some_and(|c| c.abs() > 1.0) {
        let what = "a clearance of more than 1 m".to_owned();
        context.faults.fault(
            Code::OutOfRange,
            None,
            "records.clearance",
            what,
            "check its unit: mm?",
        );
    }
    let amplitude = value(&records.drive_amplitude);
    if let (Some(placed), Some(value)) = (&records.drive_amplitude, amplitude)
        && (!value.is_finite() || value < 0.0)
    {
        let what = format!("a drive amplitude of {value}");
        context.fault(
            Code::OutOfRange,
            placed,
            "records.drive_amplitude",
            what,
            "write it relative to the nominal one: 1",
        );
    }
    Setting {
        stated_frequency_hz: frequency,
        clearance_m: clearance,
        sweep: value(&records.sweep).unwrap_or_default(),
        drive_amplitude: amplitude.unwrap_or(1.0),
        excitation: value(&records.excitation).unwrap_or_default(),
        ..Setting::default()
    }
}
