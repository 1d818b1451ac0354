//! Closed intervals of the contact channel.

use crate::record::Channel;
use crate::signal::{columns, robust};

/// An interval in which the contact was closed; bounces are merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Closed {
    /// First closed sample.
    pub first: usize,
    /// Last closed sample.
    pub last: usize,
    /// Number of pulses merged into it.
    pub pulses: usize,
}

impl Closed {
    /// Number of samples from first to last closed.
    pub(super) fn samples(&self) -> usize {
        self.last - self.first + 1
    }

    /// The same among every `stride`-th sample.
    pub(super) fn every(self, stride: usize) -> Self {
        Self {
            first: self.first / stride,
            last: self.last / stride,
            ..self
        }
    }
}

/// Intervals in which the contact channel is beyond its threshold.
///
/// The threshold is the channel's own, else halfway between its least and greatest sample if
/// these differ by more than eight noise deviations (else the contact never closed). The side of
/// the threshold on which the channel rests most of the time is "open" unless a threshold is
/// stated: closed is then above it (below it for a negative threshold). Pulses at most
/// `bounce_samples` apart are one contact that bounced.
pub(super) fn closed_intervals(channel: &Channel, bounce_samples: usize) -> Vec<Closed> {
    let Some(is_closed) = closed_test(channel) else {
        return Vec::new();
    };
    let mut intervals: Vec<Closed> = Vec::new();
    for (i, value) in channel.values.iter().enumerate() {
        if !is_closed(*value) {
            continue;
        }
        match intervals.last_mut() {
            Some(current) if i - current.last <= bounce_samples.max(1) => {
                current.pulses += usize::from(i - current.last > 1);
                current.last = i;
            }
            _ => intervals.push(Closed {
                first: i,
                last: i,
                pulses: 1,
            }),
        }
    }
    intervals
}

/// Whether a value of the contact channel means closed; `None` where the channel does not tell.
fn closed_test(channel: &Channel) -> Option<impl Fn(f64) -> bool + use<>> {
    let (level, above) = match channel.threshold {
        Some(threshold) => (threshold, threshold >= 0.0),
        None => {
            let (low, high) = columns::extremes(&channel.values);
            let noise = robust::noise_deviation(&channel.values);
            let swing = high - low;
            if swing.is_nan() || swing <= 8.0 * noise.max(1e-9) {
                return None;
            }
            let middle = 0.5 * (low + high);
            let above = channel.values.iter().filter(|v| **v > middle).count();
            (middle, 2 * above <= channel.values.len())
        }
    };
    Some(move |v: f64| if above { v > level } else { v < level })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Role;
    use labfiles::units::Dimension;

    fn channel(values: Vec<f64>, threshold: Option<f64>) -> Channel {
        Channel {
            role: Role::Contact,
            name: "contact".into(),
            dimension: Dimension::Voltage,
            values,
            high_pass_hz: None,
            low_pass: None,
            smoothing: None,
            threshold,
        }
    }

    #[test]
    fn bounces_are_merged_and_pulses_counted() {
        let mut values = vec![0.0; 100];
        for i in [20, 22, 60] {
            values[i] = 5.0;
        }
        let found = closed_intervals(&channel(values.clone(), Some(2.5)), 4);
        assert_eq!(found.len(), 2);
        assert_eq!(
            (found[0].first, found[0].last, found[0].pulses),
            (20, 22, 2)
        );
        assert_eq!(closed_intervals(&channel(values, None), 4).len(), 2);
    }

    #[test]
    fn an_idle_contact_has_no_pulse() {
        use rand::{Rng, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let values: Vec<f64> = (0..2000).map(|_| rng.random_range(-0.05..0.05)).collect();
        assert!(closed_intervals(&channel(values, None), 4).is_empty());
    }
}
