//! The range of every number of a state, in one place: the server refuses what is outside, and the page says
//! so at the field. Within these ranges no single motion takes more than seconds.

use serde_json::{Map, Value, json};

use impact_oscillator::ModelError;
use impact_oscillator::model::range;
use impact_records::signal::whole;

/// The range of a quantity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    /// Its name among the limits that the page is given.
    key: &'static str,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Both as text.
    expected: &'static str,
}

macro_rules! limits {
    ($($name:ident $key:literal: $low:literal, $high:literal;)*) => {
        $(pub(super) const $name: Limit = Limit {
            key: $key,
            low: $low as f64,
            high: $high as f64,
            expected: concat!($low, " to ", $high),
        };)*
        const ALL: &[Limit] = &[$($name),*];
    };
}

limits! {
    RESTITUTION "restitution": 0, 1;
    DAMPING_RATIO "damping_ratio": 0, 0.99;
    DRIVE_AMPLITUDE "drive_amplitude": -10, 10;
    STIFFNESS "stiffness": 0.01, 100;
    MASS "mass": 0.01, 100;
    ETA "eta": 0.02, 100;
    RHO "rho": -1000, 1000;
    PHASE "phase": -1000, 1000;
    START "start": -10000, 10000;
    MASSES "masses": 1, 2;
    PERIODS "periods": 0.1, 400;
    SAMPLES "samples": 10, 1000;
    SETTLE_PERIODS "settle_periods": 0, 20000;
    WATCH_PERIODS "watch_periods": 1, 20000;
    TOLERANCE "tolerance": 1e-12, 0.1;
    STEPS "steps": 2, 2001;
    CELLS "cells": 2, 1000;
    ROWS "rows": 1, 1000;
    MESSAGE "message": 0, 4_194_304;
    FREQUENCY "natural_frequency_hz": 1e-6, 1e9;
    DEFLECTION "static_deflection_m": 1e-12, 1000;
}

impl Limit {
    /// Whether a value is within, under the name by which a message calls it.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] where it is not.
    pub(super) fn check(&self, name: &'static str, value: f64) -> Result<(), ModelError> {
        let within = (self.low..=self.high).contains(&value);
        range(name, value, within, self.expected)
    }

    /// The value within that is nearest.
    pub(super) fn nearest(&self, value: f64) -> f64 {
        value.clamp(self.low, self.high)
    }
}

/// Largest message that a page may send, bytes: some thousand steps of a recorded demo.
pub(super) fn largest_message() -> usize {
    whole::index(MESSAGE.high)
}

/// All limits by name, for the page.
pub(super) fn all() -> Map<String, Value> {
    let pair = |l: &Limit| (l.key.to_owned(), json!([l.low, l.high]));
    ALL.iter().map(pair).collect()
}
