//! Diagnostics of a fit: whether the model describes the data, whether the methods agree, which records
//! are influential, and which mistakes of the laboratory the data give away.

pub mod agreement;
pub mod beyond;
pub mod cause;
pub mod change;
pub mod clock;
pub mod common_error;
pub mod contradicting_gap;
pub mod doubt;
pub mod drives;
pub mod faint_channel;
pub mod gain_change;
pub mod late_channel;
pub mod missing;
pub mod off_stated;
pub mod refuted_gains;
pub mod settling;
pub mod stated_clearances;
pub mod stated_frequencies;
pub mod suspicion;
pub mod swapped_channels;
pub mod uncertain_speeds;
pub mod undeclared_high_pass;
pub mod undeclared_low_pass;
pub mod undetermined;
pub mod verdict;
pub mod wrong_gains;
