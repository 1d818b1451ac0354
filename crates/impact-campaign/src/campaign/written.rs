//! campaign.toml exactly as written, before anything is checked against anything else.
//!
//! Every quantity with a dimension is a string with number and unit (`clearance = "1.0 mm"`,
//! `natural_frequency = "12.6 Hz"`); only dimensionless quantities may be bare numbers
//! (`damping_ratio = 0.07`). Unknown keys are refused. All keys are optional here: missing ones
//! are handled by [`super::resolve`], so that every problem is reported at once.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, de};
use toml::Spanned;

pub use impact_identification::identify::evidence::options::IntervalMethod;
pub use impact_records::event::{FlightKind as Flight, RigKind as Machine};
use impact_records::language::Language;
use impact_records::record::ContactContent;
use impact_records::record::calibrate::ChannelKey;
pub use impact_records::record::{Excitation, Sweep};
pub use impact_report::{Format, Paper};

/// A value with its place in the file.
pub type Placed<T> = Option<Spanned<T>>;

/// The value without its place.
pub(super) fn value<T: Clone>(placed: &Placed<T>) -> Option<T> {
    placed.as_ref().map(|p| p.get_ref().clone())
}

/// The whole of campaign.toml.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WrittenCampaign {
    /// What the campaign is.
    pub campaign: About,
    /// Where the records are and at which setting each was taken.
    pub records: Records,
    /// Nominal values of the rig.
    pub rig: Rig,
    /// The channels by role.
    pub channels: Channels,
    /// Settings of the analysis.
    pub analysis: Analysis,
    /// Settings of the report.
    pub report: Report,
    /// Published speeds to be identified from, instead of records.
    pub published: Option<Published>,
}

/// `[published]`: a table of published approach speeds, and values of β that it is tested against.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// CSV table, relative to campaign.toml's folder.
    pub speeds: String,
    /// Damping ratios that were printed with the speeds.
    #[serde(default)]
    pub damping_ratio_hypotheses: Vec<f64>,
}

/// `[campaign]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct About {
    /// Name on the report's first page.
    pub name: Placed<String>,
    /// Two masses against each other, or one against a stop.
    pub machine: Placed<Machine>,
    /// What acts on the masses between impacts.
    pub flight: Placed<Flight>,
    /// Whether its records are simulated: the report then states so.
    pub synthetic: bool,
    /// Who measured, and where.
    pub laboratory: Placed<String>,
    /// When it was measured, as text; default: the times in the files.
    pub measured: Placed<String>,
}

/// `[records]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Records {
    /// A glob or a list of globs, relative to campaign.toml's folder.
    pub files: Placed<OneOrMany>,
    /// A CSV table with one row per record, relative to campaign.toml's folder.
    pub run_table: Placed<String>,
    /// Samples per second, for files that state none.
    pub sample_rate: Placed<Quantity>,
    /// Name or index of the channel that holds the time, if the reader of the file cannot find it.
    pub time: Placed<WrittenKey>,
    /// Unit of the time axes that state none.
    pub time_unit: Placed<String>,
    /// Clearance of the records that state none: r, half the gap of two masses.
    pub clearance: Placed<Quantity>,
    /// Drive frequency of the records that state none.
    pub drive_frequency: Placed<Quantity>,
    /// Drive amplitude, relative to the nominal one, of the records that state none.
    pub drive_amplitude: Placed<f64>,
    /// Sweep direction of records that state none: up, down or unknown.
    pub sweep: Placed<Sweep>,
    /// Excitation of the records that state none.
    pub excitation: Placed<Excitation>,
    /// Which attributes of the files hold the setting.
    pub attributes: Attributes,
}

/// `[records.attributes]`: names of the files' attributes, with the unit in the name
/// (`gap_mm`) or after it in brackets (`"gap [mm]"`).
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Attributes {
    /// Attribute with the clearance r.
    pub clearance: Placed<String>,
    /// Attribute with the stated drive frequency.
    pub drive_frequency: Placed<String>,
    /// Attribute with the drive amplitude, relative to the nominal one.
    pub drive_amplitude: Placed<String>,
    /// Attribute with the sweep direction: up, down or unknown.
    pub sweep: Placed<String>,
    /// Attribute that names the rig, mass or bumper, where the campaign holds several.
    pub specimen: Placed<String>,
}

/// `[rig]`: nominal values, all optional.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rig {
    /// Which rig it is, as text: of what `shared` lists, campaigns on other rigs share nothing.
    pub name: Placed<String>,
    /// What stays the same in all campaigns on the rig.
    pub shared: Placed<Vec<String>>,
    /// Natural frequency f0.
    pub natural_frequency: Placed<Quantity>,
    /// Damping ratio β.
    pub damping_ratio: Placed<Quantity>,
    /// Static deflection `x_st` = F0/k.
    pub static_deflection: Placed<Quantity>,
    /// Coefficient of restitution R.
    pub restitution: Placed<Quantity>,
    /// Mass x.
    pub mass_x: Placed<Quantity>,
    /// Mass y.
    pub mass_y: Placed<Quantity>,
    /// Standard uncertainty of the channels' scales, relative.
    pub gain_uncertainty: Placed<Quantity>,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: Placed<Quantity>,
    /// Standard uncertainty of the sampler's clock, relative.
    pub clock_uncertainty: Placed<Quantity>,
    /// Standard uncertainty of the clearances.
    pub clearance_uncertainty: Placed<Quantity>,
    /// Standard uncertainty of the masses, relative.
    pub mass_uncertainty: Placed<Quantity>,
    /// Effects beyond the model that the fit allows; all where it is not given.
    pub effects: Placed<Vec<String>>,
}

/// `[channels]`: one table a role.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs, reason = "the roles are documented at `record::Role`")]
pub struct Channels {
    pub drive: Placed<Channel>,
    pub contact: Placed<Channel>,
    pub velocity_x: Placed<Channel>,
    pub velocity_y: Placed<Channel>,
    pub displacement_x: Placed<Channel>,
    pub displacement_y: Placed<Channel>,
    pub acceleration_x: Placed<Channel>,
    pub acceleration_y: Placed<Channel>,
    pub frame_x: Placed<Channel>,
    pub frame_y: Placed<Channel>,
}

/// `[channels.<role>]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Channel {
    /// Which channel of the file: its name, or its index counted from 0.
    pub channel: Placed<WrittenKey>,
    /// Unit of the numbers in the file; needed if the file states none.
    pub unit: Placed<String>,
    /// A ratio from the file's unit to the quantity's (`"50 mm/s per V"`, or a sensor's
    /// sensitivity `"100 mV/g"`), or a plain factor.
    pub scale: Placed<Quantity>,
    /// Value at rest, in the unit of the file; it is subtracted first.
    pub offset: Placed<Quantity>,
    /// 1, or -1 if the sensor is positive away from the other mass.
    pub sign: Placed<f64>,
    /// Corner of the first-order high-pass (of an integrator, of an AC coupling).
    pub high_pass: Placed<Quantity>,
    /// Corner of the low-pass that the signal has passed (anti-alias filter, vibrometer, amplifier).
    pub low_pass: Placed<Quantity>,
    /// Number of that low-pass's poles.
    pub low_pass_order: Placed<u32>,
    /// How much later than the drive's channel it shows what happens.
    pub delay: Placed<Quantity>,
    /// Standard uncertainty of the delay.
    pub delay_uncertainty: Placed<Quantity>,
    /// Level between open and closed contact, in the unit after the scale.
    pub threshold: Placed<Quantity>,
    /// Full scale of the converter, in the unit of the file.
    pub range: Placed<Quantity>,
    /// Use the unit of this table even if the file states another.
    pub ignore_file_unit: Placed<bool>,
    /// What the contact's channel contains: a signal, times, intervals or sound.
    pub content: Placed<ContactContent>,
    /// What recorded it, as text: sensor, amplifier, serial number.
    pub instrument: Placed<String>,
}

/// `[analysis]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Analysis {
    /// Records to leave out, by name; `*` and `?` are wildcards.
    pub exclude: Placed<Vec<String>>,
    /// Part of each record to leave out at its start, while the motion settles.
    pub skip: Placed<Quantity>,
    /// Longest motion searched, in drive periods.
    pub longest_period_n: Placed<u32>,
    /// Most impacts searched in one period of a motion.
    pub most_impacts_p: Placed<u32>,
    /// Seed of everything random (resampling).
    pub seed: Placed<u64>,
    /// Method of the intervals, in addition to the covariance.
    pub uncertainty: Placed<IntervalMethod>,
    /// Replicas of a bootstrap.
    pub replicas: Placed<u32>,
}

/// `[report]`.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Report {
    /// Title; the campaign's name where none is given.
    pub title: Placed<String>,
    /// Records whose time series and phase portraits are drawn, by name.
    pub points: Placed<Vec<String>>,
    /// Paper size.
    pub paper: Placed<Paper>,
    /// Language of dates and hyphenation.
    pub language: Placed<LanguageCode>,
    /// Whether numbers are printed with a decimal comma.
    pub decimal_comma: Placed<bool>,
    /// What it is written as: pdf, html, svg, png, figure-pdf, tex, csv.
    pub formats: Placed<Vec<Format>>,
    /// A typst template instead of the built-in one, relative to campaign.toml's folder.
    pub template: Placed<String>,
    /// A table of the report's words in another language, relative to campaign.toml's folder.
    pub words: Placed<String>,
    /// An image for the first page, relative to campaign.toml's folder.
    pub logo: Placed<String>,
}

/// Code of the report's language as ISO 639-1 writes it. The program has texts in some languages; in others
/// the report is in English, or in the words of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LanguageCode(pub String);

impl Default for LanguageCode {
    fn default() -> Self {
        Self(Language::default().code().to_owned())
    }
}

/// One text or a list of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OneOrMany(pub Vec<String>);

/// A channel of a file as written: its name or its index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenKey(pub ChannelKey);

/// A quantity as written: text with number and unit, or a bare number.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// Number and unit, not yet read.
    Text(String),
    /// A number without unit.
    Bare(f64),
}

macro_rules! deserialize_with {
    ($visitor:ident for $target:ty, $what:literal, { $($methods:tt)* }) => {
        struct $visitor;
        impl<'de> de::Visitor<'de> for $visitor {
            type Value = $target;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str($what)
            }
            $($methods)*
        }
        impl<'de> Deserialize<'de> for $target {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                d.deserialize_any($visitor)
            }
        }
    };
}

deserialize_with!(QuantityVisitor for Quantity, "a text with number and unit", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<Quantity, E> {
        Ok(Quantity::Text(v.to_owned()))
    }
    fn visit_f64<E: de::Error>(self, v: f64) -> Result<Quantity, E> {
        Ok(Quantity::Bare(v))
    }
    fn visit_i64<E: de::Error>(self, v: i64) -> Result<Quantity, E> {
        Ok(Quantity::Bare(v as f64))
    }
});

deserialize_with!(ChannelVisitor for WrittenKey, "a channel's name, or its index from 0", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<WrittenKey, E> {
        Ok(WrittenKey(ChannelKey::Name(v.to_owned())))
    }
    fn visit_i64<E: de::Error>(self, v: i64) -> Result<WrittenKey, E> {
        usize::try_from(v)
            .map(|index| WrittenKey(ChannelKey::Index(index)))
            .map_err(|_| E::custom(format!("a channel's index is counted from 0, not {v}")))
    }
});

deserialize_with!(LanguageVisitor for LanguageCode, "a language as ISO 639-1 writes it, such as \"en\"", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<LanguageCode, E> {
        let two_letters = v.len() == 2 && v.bytes().all(|b| b.is_ascii_lowercase());
        two_letters
            .then(|| LanguageCode(v.to_owned()))
            .ok_or_else(|| E::invalid_value(de::Unexpected::Str(v), &self))
    }
});

deserialize_with!(FilesVisitor for OneOrMany, "a text or a list of texts", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<OneOrMany, E> {
        Ok(OneOrMany(vec![v.to_owned()]))
    }
    fn visit_seq<A: de::SeqAccess<'de>>(self, mut a: A) -> Result<OneOrMany, A::Error> {
        let mut all = Vec::new();
        while let Some(one) = a.next_element()? {
            all.push(one);
        }
        Ok(OneOrMany(all))
    }
});
