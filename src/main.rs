//! The `impactid` program: see [`impactid::cli`].

use std::process::ExitCode;

/// Frees and allocates faster than the system's on two threads or more.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    impactid::cli::main()
}
