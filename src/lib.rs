//! `impactid`: from a laboratory campaign on an impact oscillator to the coefficient of
//! restitution R, the natural frequency f0 and the damping ratio β, each with an honest interval.
//!
//! Data walks one street, and a room never imports from a room to its right:
//!
//! `units` < `output` < `signal` < `record` < `event` < `motion` < `model` < `atlas` <
//! `synthetic` < `identify` < `compare` < `report` < `campaign` < `pipeline` < `cli`.

pub mod message;

pub mod signal;

pub mod record;

pub mod event;

pub mod motion;

pub mod synthetic;

pub mod identify;

pub mod difference;

pub mod compare;

pub mod report;

pub mod campaign;

pub mod pipeline;

pub mod explore;

pub mod cli;
