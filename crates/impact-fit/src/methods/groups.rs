//! The groups of each record, whose scatter shows what the model does not contain.

use std::collections::BTreeMap;

use crate::solver::group::Group;
use impact_records::motion::Observation;
use impact_records::record::Role;
use impact_records::signal::robust;

/// Fewest groups by setting that are looked for.
const FEWEST_GROUPS: usize = 8;
/// Bands of drive frequencies and of amplitudes.
const BANDS: usize = 8;

/// The groups of each record.
pub(super) fn groups(observations: &[Observation]) -> Vec<Group> {
    let by_setting = by_setting(observations);
    let frequencies: Vec<f64> = observations
        .iter()
        .map(|o| o.frequency_hz().unwrap_or(0.0))
        .collect();
    let amplitudes: Vec<f64> = observations.iter().map(amplitude).collect();
    let (by_frequency, by_amplitude) = (bands(&frequencies), bands(&amplitudes));
    (0..observations.len())
        .map(|i| [by_setting[i], by_frequency[i], by_amplitude[i]])
        .collect()
}

/// Records of one gap and direction of the sweep; parts of them, in the order of acquisition, where
/// that makes too few groups.
fn by_setting(observations: &[Observation]) -> Vec<usize> {
    let mut of: BTreeMap<(u64, &str), Vec<usize>> = BTreeMap::new();
    let mut order: Vec<usize> = (0..observations.len()).collect();
    order.sort_by_key(|i| observations[*i].setting.sequence);
    for i in order {
        let setting = &observations[i].setting;
        let gap = setting.clearance_m.unwrap_or(f64::NAN).to_bits();
        of.entry((gap, setting.sweep.name())).or_default().push(i);
    }
    let parts = FEWEST_GROUPS.div_ceil(of.len().max(1));
    let mut groups = vec![0; observations.len()];
    for (number, records) in of.values().enumerate() {
        for (rank, i) in records.iter().enumerate() {
            groups[*i] = number * parts + rank * parts / records.len();
        }
    }
    groups
}

/// The band of each value among bands that hold as many values each.
fn bands(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut bands = vec![0; values.len()];
    for (rank, i) in order.into_iter().enumerate() {
        bands[i] = rank * BANDS / values.len();
    }
    bands
}

/// Half the range of the displacement, m: as measured, else by velocity or acceleration and frequency.
pub(super) fn amplitude(observation: &Observation) -> f64 {
    let rate = || Some(std::f64::consts::TAU * observation.frequency_hz()?);
    let of = |role: Role, half_range: f64| match role {
        Role::DisplacementX | Role::DisplacementY => Some(half_range),
        Role::VelocityX | Role::VelocityY => Some(half_range / rate()?),
        Role::AccelerationX | Role::AccelerationY => {
            let half_range = between_spikes(observation, role, half_range)?;
            Some(half_range / rate()?.powi(2))
        }
        _ => None,
    };
    let all = observation.amplitudes.iter();
    let all = all.filter_map(|a| of(a.role, a.half_range));
    all.filter(|a| a.is_finite()).fold(0.0, f64::max)
}

/// Half the range of an acceleration, m/s², without its spikes at impacts; `None` where they cannot be told apart.
fn between_spikes(observation: &Observation, role: Role, half_range: f64) -> Option<f64> {
    if observation.impacts.is_empty() {
        return Some(half_range);
    }
    let mut channels = observation.folded.as_ref()?.channels.iter();
    let points = &channels.find(|c| c.role == role)?.points;
    let values: Vec<f64> = points.iter().map(|p| p.value).collect();
    let (low, high) = robust::range(values)?;
    Some(0.5 * (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_bands_hold_as_many_values_each_in_their_order() {
        // 0, 7, 14, 21, 4, …: each of 0 to 23 once, three to a band
        let ranks: Vec<u8> = (0..24).map(|i| i * 7 % 24).collect();
        let values: Vec<f64> = ranks.iter().map(|r| f64::from(*r)).collect();
        for (rank, band) in ranks.iter().zip(bands(&values)) {
            assert_eq!(band, usize::from(*rank / 3));
        }
        assert!(bands(&[]).is_empty());
    }
}
