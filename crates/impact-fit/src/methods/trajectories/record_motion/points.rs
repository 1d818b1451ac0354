//! A record's motion at all of its points.

use super::RecordMotion;
use crate::evidence::waveform::{Terms, VibrationPoints};
use impact_records::record::Role;

/// Where the terms of a record's motion are taken at all of its points.
pub struct MotionPoints<'a> {
    /// Of each set of phases, both masses where they are measured.
    vibrations: Vec<[Option<VibrationPoints<'a>>; 2]>,
    channels: Vec<ChannelPoints>,
}

/// What a channel's points add to those of its mass.
struct ChannelPoints {
    /// Its set of phases.
    set: usize,
    role: Role,
    /// e^{−ct}, behind a high-pass; the little that a point's spread makes of it is left out.
    tail: Option<Vec<f64>>,
}

impl<'a> RecordMotion<'a> {
    /// Values at all points, channel after channel, SI, gains and effects included.
    pub fn values(&self) -> Vec<f64> {
        let mut values = self.points().values(&self.unperturbed());
        self.perturb(&mut values);
        values
    }

    /// Where terms are taken at all points.
    pub fn points(&self) -> MotionPoints<'a> {
        MotionPoints::new(self)
    }
}

impl<'a> MotionPoints<'a> {
    fn new(motion: &RecordMotion<'a>) -> Self {
        let record = motion.record;
        let measured = |of_y: bool| motion.channels.iter().any(|c| c.role.is_of_y() == of_y);
        let vibrations = record.phases.iter().map(|phases| {
            [false, true].map(|of_y| {
                let vibration = &motion.vibrations[usize::from(of_y)];
                measured(of_y).then(|| VibrationPoints::new(phases, vibration))
            })
        });
        let mut points = Self {
            vibrations: vibrations.collect(),
            channels: Vec::with_capacity(motion.channels.len()),
        };
        for channel in &motion.channels {
            let (set, role) = (channel.set, channel.role);
            let time = points.vibrations[set][usize::from(role.is_of_y())].as_ref();
            let tail = channel.high_pass.zip(time).map(|(high_pass, at)| {
                let corner = high_pass.corner();
                at.time().iter().map(|t| (-corner * t).exp()).collect()
            });
            points.channels.push(ChannelPoints { set, role, tail });
        }
        points
    }

    /// Terms of every channel at its points, channel after channel.
    pub fn values(&self, terms: &[Terms]) -> Vec<f64> {
        let mut out = Vec::new();
        for (channel, terms) in self.channels.iter().zip(terms) {
            if let Some(vibration) = self.vibration(channel) {
                out.extend(vibration.values(terms, channel.tail.as_deref()));
            }
        }
        out
    }

    /// Times since the impact at the points of each channel.
    pub(super) fn times(&self) -> impl Iterator<Item = &[f64]> {
        let channels = self.channels.iter();
        channels.filter_map(|channel| Some(self.vibration(channel)?.time()))
    }

    fn vibration(&self, channel: &ChannelPoints) -> Option<&VibrationPoints<'a>> {
        self.vibrations[channel.set][usize::from(channel.role.is_of_y())].as_ref()
    }
}
