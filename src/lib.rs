//! `impactid`: from a laboratory campaign on an impact oscillator to the coefficient of
//! restitution R, the natural frequency f0 and the damping ratio β, each with a 95 % interval.
//!
//! Data passes through the modules in one direction; a module imports only from those before it:
//!
//! `message`, `signal`, `record`, `event`, `motion`, `synthetic`, `identify`, `difference`, `compare`, `report`,
//! `campaign`, `pipeline`, `explore`, `cli`. The model itself is the crate `impact-oscillator`, files
//! are read by the crate `labfiles`.

pub mod cli;
