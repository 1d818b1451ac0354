//! One impact, with everything that was measured of it.

use serde::{Deserialize, Serialize};

use crate::record::Role;

/// Channels that show an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DetectionSource {
    /// Only the contact channel.
    Contact,
    /// Only a jump of velocity.
    Velocity,
    /// Both.
    Both,
    /// Heights before and after it: the speeds are those of free fall, and their standard error is that of a height as
    /// it is stated, none where it is not; that of the time is the error of the fall's time by a height's last digit.
    Heights,
}

impl DetectionSource {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Velocity => "velocity",
            Self::Both => "both",
            Self::Heights => "heights",
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

/// One impact: its time, its phase of the drive, the speeds before and after, how it was detected.
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
    /// Approach speed after the impact, m/s: minus the separation speed, so negative while the
    /// bodies separate.
    #[serde(rename = "closing_speed_after_m_s")]
    pub approach_speed_after_m_s: Option<f64>,
    /// Standard errors of the approach speeds before and after, m/s, by noise.
    pub speed_errors_m_s: Option<[f64; 2]>,
    /// What either approach speed changes by where the impact is later by the standard error of its
    /// time, m/s; `None` where that is part of their errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speeds_by_time_m_s: Option<[f64; 2]>,
    /// Mass x alone.
    pub x: Option<MassSpeeds>,
    /// Mass y alone.
    pub y: Option<MassSpeeds>,
    /// Change of both approach speeds if a channel's corner is not the stated one.
    #[serde(default)]
    pub corner_shifts: [Option<CornerShift>; 2],
    /// What delays of the channels change of both approach speeds, per mass; `None` where the speeds and the
    /// time are not those of an instantaneous impact at a kink of measured displacements.
    #[serde(default)]
    pub lags: [Option<Lag>; 2],
    /// How long the bodies stayed together after it, s; zero without a dead zone.
    pub dead_zone_s: f64,
    /// Duration of the contact, s; `None` if it cannot be distinguished from an instant. The approach
    /// speeds are those at its start and at its end; `time_s` is the centre of its impulse, to which the
    /// speeds of each mass refer, as if the impact were instantaneous there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_duration_s: Option<f64>,
    /// What springs and drive, not the contact, added to the separation speed during the contact,
    /// m/s (for a linear contact); `None` as above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub external_push_m_s: Option<f64>,
    /// Channels that show it.
    #[serde(rename = "seen")]
    pub source: DetectionSource,
}

/// Change of both approach speeds at an impact per unit of the logarithm of a corner frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CornerShift {
    /// The channel whose corner it is.
    pub role: Role,
    /// m/s, toward each other.
    pub speed_m_s: f64,
}

/// How one mass's velocity was read at the time that the displacements' kink gives. Where its channel is later
/// than assumed, the speeds are those of the flights at another time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lag {
    /// The channel of its velocity.
    pub velocity: Role,
    /// The channel of its displacement.
    pub displacement: Role,
    /// Share of the relative velocity's jump, by which a delay of the displacement moves the kink.
    pub share: f64,
    /// Delay of the velocity against the kink with which the speeds were read, s.
    pub assumed_s: f64,
    /// What the speeds before and after change by where the velocity is later than assumed, m/s per s: the mass's
    /// share of the approach's acceleration, less what a later jump changes of the drift that was removed.
    pub accelerations_m_s2: [f64; 2],
}

impl MassSpeeds {
    /// By how much the impact changes the speed, m/s.
    pub fn jump_m_s(self) -> f64 {
        self.before_m_s - self.after_m_s
    }

    fn over(self, gain: f64) -> Self {
        Self {
            before_m_s: self.before_m_s / gain,
            after_m_s: self.after_m_s / gain,
        }
    }
}

impl Impact {
    /// The same where the channels of both masses read so many times what they should.
    ///
    /// ```
    /// # use impact_records::event::{DetectionSource, Impact, MassSpeeds};
    /// # let of = |before_m_s, after_m_s| Some(MassSpeeds { before_m_s, after_m_s });
    /// # let json = r#"{"time_s":0,"time_error_s":0,"dead_zone_s":0,"seen":"both"}"#;
    /// # let impact: Impact = serde_json::from_str(json)?;
    /// let read = Impact {
    ///     approach_speed_before_m_s: Some(0.5),
    ///     x: of(0.4, -0.2),
    ///     y: of(0.1, -0.1),
    ///     ..impact
    /// };
    /// // x reads twice its speed: it is 0.2 m/s
    /// let right = read.over([2.0, 1.0]);
    /// assert!((right.approach_speed_before_m_s.unwrap() - 0.3).abs() < 1e-12);
    /// # Ok::<(), serde_json::Error>(())
    /// ```
    #[must_use]
    pub fn over(&self, gains: [f64; 2]) -> Self {
        let both = |speed: Option<f64>, of: fn(&MassSpeeds) -> f64| match (self.x, self.y) {
            (Some(x), Some(y)) => {
                let off = [of(&x), of(&y)]
                    .into_iter()
                    .zip(gains)
                    .map(|(v, g)| v / g - v);
                Some(speed? + off.sum::<f64>())
            }
            (Some(_), None) => Some(speed? / gains[0]),
            (None, Some(_)) => Some(speed? / gains[1]),
            (None, None) => speed,
        };
        Self {
            approach_speed_before_m_s: both(self.approach_speed_before_m_s, |m| m.before_m_s),
            approach_speed_after_m_s: both(self.approach_speed_after_m_s, |m| m.after_m_s),
            x: self.x.map(|x| x.over(gains[0])),
            y: self.y.map(|y| y.over(gains[1])),
            ..self.clone()
        }
    }

    /// Standard error of either approach speed, the greater of both, m/s.
    pub fn speed_error_m_s(&self) -> Option<f64> {
        self.speed_errors_m_s
            .map(|[before, after]| before.max(after))
    }

    /// An impact of which nothing is known but its time and the standard error of that.
    pub(crate) fn timed(time_s: f64, time_error_s: f64) -> Self {
        Self {
            time_s,
            time_error_s,
            drive_phase_rad: None,
            approach_speed_before_m_s: None,
            approach_speed_after_m_s: None,
            speed_errors_m_s: None,
            speeds_by_time_m_s: None,
            x: None,
            y: None,
            corner_shifts: [None, None],
            lags: [None, None],
            dead_zone_s: 0.0,
            contact_duration_s: None,
            external_push_m_s: None,
            source: DetectionSource::Contact,
        }
    }
}

impl Impact {
    /// An impact of a time and an approach speed; nothing else is known.
    pub fn at(time_s: f64, approach_speed_m_s: f64) -> Self {
        Self {
            approach_speed_before_m_s: Some(approach_speed_m_s),
            source: DetectionSource::Both,
            ..Self::timed(time_s, 1e-5)
        }
    }
}
