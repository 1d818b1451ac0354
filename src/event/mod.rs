//! Impacts seen in a record, from the contact channel and from velocity jumps, and the drive's
//! tone that strobes them. This room sees no parameter of the model.

pub mod bounce;
pub mod contact;
pub mod contact_profile;
pub mod corner;
pub mod detect;
pub mod drift;
pub mod drive;
pub mod finite_contact;
pub mod impacts;
pub mod jumps;
pub mod kinematics;
pub mod refine;

pub use corner::CornerShift;
pub use detect::{Detection, detect};

use serde::{Deserialize, Serialize};

/// How the rig is built, as far as the detection of impacts has to know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigKind {
    /// Two masses that hit each other; approach speed x' + y'.
    Double,
    /// One mass that hits a fixed stop; approach speed x'.
    Single,
}

/// Through which channel an impact was seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DetectionSource {
    /// Only the contact channel.
    Contact,
    /// Only a jump of velocity.
    Velocity,
    /// Both.
    Both,
}

impl DetectionSource {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            DetectionSource::Contact => "contact",
            DetectionSource::Velocity => "velocity",
            DetectionSource::Both => "both",
        }
    }
}

/// Velocity of one mass just before and just after an impact, m/s, toward the other mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MassSpeeds {
    /// Extrapolated from the arc before to the impact's time.
    pub before_m_s: f64,
    /// Extrapolated from the arc after to the impact's time.
    pub after_m_s: f64,
}

/// One impact: when, at which phase of the drive, how fast before and after, how it was seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// Time since the record's first sample, s, refined below the sample step.
    pub time_s: f64,
    /// Standard error of the time, s.
    pub time_error_s: f64,
    /// Phase of the drive at the impact, rad in [0, 2π); the drive is cos(phase).
    pub drive_phase_rad: Option<f64>,
    /// Approach speed before the impact (x' + y'; for one mass x'), m/s, positive.
    #[serde(rename = "closing_speed_before_m_s")]
    pub approach_speed_before_m_s: Option<f64>,
    /// Approach speed after the impact, m/s: minus the separation speed, so negative while the bodies separate.
    #[serde(rename = "closing_speed_after_m_s")]
    pub approach_speed_after_m_s: Option<f64>,
    /// Standard error of either approach speed, m/s.
    pub speed_error_m_s: Option<f64>,
    /// Mass x alone.
    pub x: Option<MassSpeeds>,
    /// Mass y alone.
    pub y: Option<MassSpeeds>,
    /// What corners other than the stated ones would change of both approach speeds.
    #[serde(default)]
    pub corner_shifts: [Option<CornerShift>; 2],
    /// How long the bodies stayed together after it, s; zero without a dead zone.
    pub dead_zone_s: f64,
    /// How long the contact lasted, s; `None`: indistinguishable from an instant. The approach speeds are
    /// those at its start and at its end; `time_s` is the centre of its impulse, to which the
    /// speeds of each mass belong, as if the impact were an instant there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_duration_s: Option<f64>,
    /// What springs and drive, not the contact, added to the separation speed while the contact
    /// lasted, m/s (a linear contact taken); `None`: indistinguishable from an instant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub external_push_m_s: Option<f64>,
    /// How it was seen.
    #[serde(rename = "seen")]
    pub source: DetectionSource,
}

/// The drive as measured from its channel: amplitude · cos(2π f t + phase).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DriveTone {
    /// Measured frequency, Hz.
    pub frequency_hz: f64,
    /// Its standard error, Hz.
    pub frequency_error_hz: f64,
    /// Amplitude in the channel's SI unit.
    pub amplitude: f64,
    /// Phase at the first sample, rad.
    pub phase_rad: f64,
    /// Root mean square of what the tone leaves over, relative to its amplitude.
    pub residual_ratio: f64,
}

impl DriveTone {
    /// Phase of the drive at a time since the first sample, rad in [0, 2π).
    pub fn phase_at(&self, time_s: f64) -> f64 {
        (std::f64::consts::TAU * self.frequency_hz * time_s + self.phase_rad)
            .rem_euclid(std::f64::consts::TAU)
    }

    /// Drive period, s.
    pub fn period_s(&self) -> f64 {
        1.0 / self.frequency_hz
    }
}
