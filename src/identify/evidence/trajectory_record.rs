//! A periodic record as the fits use it.

use crate::event::RigKind;
use crate::identify::evidence::waveform::Phases;
use crate::identify::fit::effect::Effect;
use crate::identify::fit::own::Circumstances;
use crate::identify::fit::parameters::gain_index;
use crate::motion::Folded;

/// One folded record.
#[derive(Debug, Clone)]
pub struct TrajectoryRecord {
    /// Index among the observations.
    pub observation: usize,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Drive amplitude relative to the nominal one.
    pub drive_amplitude: f64,
    /// The folded waveform.
    pub folded: Folded,
    /// Phases of the points: usually one set that all channels share.
    pub phases: Vec<Phases>,
    /// Median closing speed before impacts as measured, m/s.
    pub closing_speed_m_s: f64,
    /// Standard error of the drive's frequency, relative.
    pub frequency_error: f64,
    /// Standard error of the drive's phase, rad.
    pub phase_error_rad: f64,
    /// Place of the clearance among those that carry an error of their own.
    pub gap: Option<usize>,
    /// Standard error of the clearance, m, where no other record has the same.
    pub lone_clearance_error_m: f64,
    /// Place in the campaign, −½ … ½.
    pub place: f64,
    /// The group of records that it belongs to.
    pub group: usize,
    /// Acceleration of the masses toward each other at the impacts over the approach speed, 1/s; zero
    /// until it is found at good parameters.
    pub press_per_s: f64,
    /// Changes of all points' values, SI, by one standard error of phase, of frequency and of a lone
    /// clearance; empty until they are found at good parameters.
    pub shared: Vec<Vec<f64>>,
    /// Changes of all points' values, SI, by effects that act as extra accelerations, per unit of
    /// their strengths; empty until they are found at good parameters.
    pub perturbations: Vec<(Effect, Vec<f64>)>,
}

impl TrajectoryRecord {
    /// Where and when it was taken.
    pub fn circumstances(&self, rig: RigKind) -> Circumstances {
        Circumstances {
            frequency_hz: self.frequency_hz,
            clearance_m: self.clearance_m,
            gap: self.gap,
            place: self.place,
            approach_m_s: self.closing_speed_m_s,
            press_per_s: self.press_per_s,
            masses: if rig == RigKind::Double { 2.0 } else { 1.0 },
        }
    }

    /// Whether it has the channel of a gain.
    pub(super) fn has(&self, index: usize) -> bool {
        let mut channels = self.folded.channels.iter();
        channels.any(|c| gain_index(c.role) == Some(index))
    }
}
