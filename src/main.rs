//! `impactid`: from a laboratory campaign on an impact oscillator to the coefficient of
//! restitution R, the natural frequency f0 and the damping ratio β, each with a 95 % interval.
//!
//! The program is the command line alone; what it calls is in the crates of this workspace.

mod cli;

use std::process::ExitCode;

/// Frees and allocates faster than the system's on two threads or more.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    cli::main()
}
