//! Ctrl-C: a clear message, no partial file, exit code 130.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Exit code of a program that the user interrupted (128 + SIGINT).
const INTERRUPTED: i32 = 130;

/// Whether Ctrl-C was pressed and the program is about to end for it.
static ENDING: AtomicBool = AtomicBool::new(false);

/// If the program is ending after Ctrl-C, wait for that: errors caused by it are not printed.
pub(super) fn give_way() {
    while ENDING.load(Ordering::SeqCst) {
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// From now on Ctrl-C removes the partial files in `folder`, prints a message and ends the program.
pub(super) fn watch(folder: PathBuf) {
    let flag = Arc::new(AtomicBool::new(false));
    let signals = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM];
    if signals
        .iter()
        .any(|s| signal_hook::flag::register(*s, Arc::clone(&flag)).is_err())
    {
        return;
    }
    std::thread::spawn(move || {
        while !flag.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(20));
        }
        ENDING.store(true, Ordering::SeqCst);
        let folder = match folder.as_os_str().is_empty() {
            true => PathBuf::from("."),
            false => folder,
        };
        labfiles::output::clear_own_parts(&folder);
        eprintln!(
            "\nimpactid: interrupted. Outputs in {} are complete or absent; run the same command again \
             (with --resume, if it has that option, it continues).",
            folder.display()
        );
        #[expect(
            clippy::exit,
            reason = "the working threads need not be waited for: outputs are whole"
        )]
        std::process::exit(INTERRUPTED);
    });
}
