//! Records by the inferred roles, and what the detection of impacts finds in them.

use super::found::InferredChannel;
use super::place::Place;
use impact_records::event::{
    DetectSettings, Detection, FlightKind, Impact, MassSpeeds, RigKind, detect,
};
use impact_records::record::calibrate::{
    ChannelKey, ChannelSetup, RecordSetup, StatedTimes, calibrate,
};
use impact_records::record::{FlagCode, Record, Role, Setting};
use impact_records::signal::columns::dot;
use impact_records::signal::robust;
use labfiles::units;

/// A record by the inferred roles, in SI as far as units are known; of one with gaps the longest part between them.
pub(super) fn read(place: Place<'_>, channels: &[InferredChannel]) -> Record {
    let setups: Vec<ChannelSetup> = channels
        .iter()
        .filter_map(|c| {
            let role = c.role.filter(|r| r.is_motion())?;
            Some(ChannelSetup {
                unit: role.dimension().map(|dimension| units::Unit {
                    dimension,
                    to_si: 1.0,
                }),
                ignore_file_unit: true,
                ..ChannelSetup::plain(role, ChannelKey::Name(c.name.clone()))
            })
        })
        .collect();
    let setup = RecordSetup {
        id: "",
        dataset: place.dataset,
        channels: &setups,
        times: &StatedTimes {
            // of a camera: neither decays nor flights depend on it
            sample_rate_hz: Some(USUAL_FRAMES_HZ),
            ..StatedTimes::default()
        },
        setting: &Setting::default(),
        driven: false,
        skip_s: 0.0,
    };
    let record = calibrate(place.source, &setup);
    let parts = match record.has_gaps() {
        true => record.between_gaps(),
        false => Vec::new(),
    };
    let longest = parts.into_iter().max_by_key(|(_, part)| part.samples());
    longest.map_or(record, |(_, part)| part)
}

/// Pictures a second by which records are looked at that number them, and state no rate.
const USUAL_FRAMES_HZ: f64 = 240.0;

/// What the detection under a constant force finds in some records.
pub(super) struct Detected {
    each: Vec<Detection>,
    /// All records, those too that have no rate.
    records: usize,
}

impl Detected {
    /// The detection in records of a rig.
    pub(super) fn of(records: &[Record], rig: RigKind) -> Self {
        let settings = DetectSettings {
            flight: FlightKind::ConstantForce,
            ..DetectSettings::default()
        };
        let sampled = records.iter().filter(|r| r.sample_rate_hz > 0.0);
        Self {
            each: sampled.map(|r| detect(r, rig, &settings)).collect(),
            records: records.len(),
        }
    }

    /// Whether most records are so.
    pub(super) fn most(&self, are: impl Fn(&Detection) -> bool) -> bool {
        2 * self.each.iter().filter(|d| are(d)).count() > self.records
    }
}

/// Whether a detection has a flag.
pub(super) fn notes(found: &Detection, code: FlagCode) -> bool {
    found.flags.iter().any(|f| f.code == code)
}

/// Fewest impacts by which two masses strike each other again and again.
const FEWEST_STRIKES: usize = 3;
/// Change of the approach speed over its error from which it is that of an impact.
const STRIKES: f64 = 10.0;

/// Whether two masses strike each other again and again.
pub(super) fn strikes(found: &Detection) -> bool {
    strikes_once(found) && count_strikes(found) >= FEWEST_STRIKES
}

/// Whether two masses strike each other at most impacts, of which there may be one.
pub(super) fn strikes_once(found: &Detection) -> bool {
    2 * count_strikes(found) > found.impacts.len()
}

/// Whether a mass bounces again and again, as a cart does on a slope: a decay of that shape leaves much of it.
pub(super) fn bounces(found: &Detection) -> bool {
    found.impacts.iter().filter(|i| turns(i)).count() >= FEWEST_STRIKES
}

/// Whether an impact turns an approach into a separation, by far more than its error.
fn turns(impact: &Impact) -> bool {
    let before = impact.approach_speed_before_m_s.unwrap_or(0.0);
    let after = impact.approach_speed_after_m_s.unwrap_or(0.0);
    let error = impact.speed_error_m_s().unwrap_or(f64::INFINITY);
    before > 0.0 && after < 0.0 && before - after > STRIKES * error
}

/// Impacts that turn the approach of two masses into a separation, and by which each mass loses speed toward the other.
fn count_strikes(found: &Detection) -> usize {
    let is = |impact: &&Impact| {
        let error = impact.speed_error_m_s().unwrap_or(f64::INFINITY);
        let pushed = |mass: Option<MassSpeeds>| mass.is_some_and(|m| m.jump_m_s() > error);
        turns(impact) && pushed(impact.x) && pushed(impact.y)
    };
    found.impacts.iter().filter(is).count()
}

/// Part of a motion by which two sensors of one body differ at most: noise, a filter, the unit's last digit.
const SAME: f64 = 0.02;

/// Whether a record's sensors of both masses see one motion, whichever way they point, or the size of it.
pub(super) fn sees_same(record: &Record) -> bool {
    let pairs = [
        (Role::VelocityX, Role::VelocityY),
        (Role::DisplacementX, Role::DisplacementY),
    ];
    let alike = |(x, y): (Role, Role)| {
        let (Some(x), Some(y)) = (record.values(x), record.values(y)) else {
            return false;
        };
        // a tracker's speed is the size of a velocity
        let size = |v: &[f64]| v.iter().map(|v| v.abs()).collect::<Vec<f64>>();
        let like = |x: &[f64], y: &[f64]| 1.0 - correlation(x, y).powi(2) < SAME * SAME;
        like(x, y) || like(&size(x), &size(y))
    };
    pairs.into_iter().any(alike)
}

/// Correlation of two series of equal length.
pub(super) fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let centred = |v: &[f64]| -> Vec<f64> {
        let mean = robust::mean(v);
        v.iter().map(|value| value - mean).collect()
    };
    let (x, y) = (centred(x), centred(y));
    let size = (dot(&x, &x) * dot(&y, &y)).sqrt();
    if size > 0.0 { dot(&x, &y) / size } else { 0.0 }
}
