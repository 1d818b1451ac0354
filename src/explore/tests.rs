//! The explorer without a browser: states, demos, frames.
