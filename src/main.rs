//! The `impactid` program: see [`impactid::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    impactid::cli::main()
}
