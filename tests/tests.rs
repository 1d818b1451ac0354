//! The one integration binary: each module is a subject.

/// A small laboratory in a temporary folder: a good campaign that tests spoil.
mod support;

/// Wrong inputs, each with the message and the exit code it gets; docs/robustness.md is their
/// table.
mod robustness;

/// The verbs: help, exit codes, quiet and verbose, what they write and what they leave alone.
mod command_line;

/// The order of the rooms, and what the house promises of its files.
mod house;
