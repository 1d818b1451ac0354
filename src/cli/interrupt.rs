//! Ctrl-C: a clear message, no half-written file, exit code 130.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Exit code of a program that the user broke off (128 + SIGINT).
const BROKEN_OFF: i32 = 130;

/// Whether Ctrl-C was pressed and the program is about to end for it.
static ENDING: AtomicBool = AtomicBool::new(false);

/// Where the program ends for Ctrl-C, wait for that: what fails meanwhile is not to be told.
pub fn give_way() {
    while ENDING.load(Ordering::SeqCst) {
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// From now on Ctrl-C clears the half-written files of `folder` away, says so and ends the
/// program.
pub fn watch(folder: PathBuf) {
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
            "\nimpactid: broken off. Nothing half-written is left in {}; the same command begins \
             anew, and with --resume, where it has that, goes on.",
            folder.display()
        );
        #[allow(clippy::exit)] // the working threads need not be waited for: outputs are whole
        std::process::exit(BROKEN_OFF);
    });
}
