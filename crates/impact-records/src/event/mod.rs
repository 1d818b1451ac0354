//! Impacts of a record, from the contact channel and from velocity jumps, and the drive's tone that
//! gives their phase. This module uses no parameter of the model.
//!
//! Times become sample indices by `as usize`, which saturates (negative and NaN give 0); an index is
//! bounded by the number of samples before it is used.

mod arc_times;
mod arcs;
mod calming;
mod channel_lags;
mod contact;
mod contact_profile;
mod contact_samples;
mod corner;
mod detect;
mod directions;
mod drift;
mod drive;
mod finite_contact;
mod free_flight;
mod heights;
mod impact;
mod impact_speeds;
mod integrated;
mod jumps;
mod kinematics;
mod lag;
mod refine;
mod ringing;
mod touches;

pub use arc_times::correlation_of_places;
pub(crate) use calming::calmed;
pub use channel_lags::ChannelLag;
pub(crate) use detect::detect_at;
pub use detect::extrapolation_error;
pub use detect::{DetectSettings, Detection, FlightKind, detect};
pub use directions::JumpDirections;
pub use drive::{DriveTone, of_motion};
pub use heights::GRAVITY_M_S2;
pub use impact::{CornerShift, DetectionSource, Impact, Lag, MassSpeeds};
pub(crate) use kinematics::noise_with_converter;
pub use kinematics::{Kinematics, RigKind, Series};
