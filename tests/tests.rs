//! The one integration binary: each module is a subject.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    clippy::too_many_lines,
    reason = "a test fails by panicking, and a table of cases is as long as it has cases"
)]

/// A small laboratory in a temporary folder: a good campaign that tests spoil.
mod support;

/// Wrong inputs, each with the message and the exit code it gets; docs/robustness.md is their
/// table.
mod robustness;

/// Runs killed, run twice, without room on the disk; determinism.
mod broken_runs;

/// The verbs: help, exit codes, quiet and verbose, what they write and what they leave alone.
mod command_line;

/// Campaigns compared, from records to the report.
mod campaigns;

/// The explorer: protocol, defences, campaigns, the page in a browser.
mod explore;

/// What record files hold and how they are written anew.
mod formats;

/// The order of the rooms, and what the house promises of its files.
mod house;

/// The main job on campaigns with known truth.
mod main_job;

/// Records that nobody here wrote.
mod real_data;

/// The report as a user gets it, and the finished example.
mod report;

/// The verbs of the theory: what they leave, replays, parts and their merge, runs broken off.
mod theory;

/// Campaigns whose records are still arriving.
mod watch;

/// The tutorial as it stands, the script that reads the results, manual pages, completions.
mod users;
