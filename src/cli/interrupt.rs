//! Ctrl-C: a clear message, no partial file, exit code 130.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
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

/// The folders that are written into, in the order in which they were named.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// From now on Ctrl-C removes the partial files in `folder` too, prints a message and ends the program.
pub(super) fn watch(folder: PathBuf) {
    let mut folders = FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
    folders.push(match folder.as_os_str().is_empty() {
        true => PathBuf::from("."),
        false => folder,
    });
    if folders.len() == 1 {
        drop(folders);
        end_at_signal();
    }
}

/// End the program at the first signal.
fn end_at_signal() {
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
        let folders = FOLDERS.lock().map(|f| f.clone()).unwrap_or_default();
        for folder in &folders {
            labfiles::output::clear_own_parts(folder);
        }
        let first = folders.first().map(PathBuf::as_path);
        eprintln!(
            "\nimpactid: interrupted. Outputs in {} are complete or absent; run the same command again \
             (with --resume, if it has that option, it continues).",
            first.unwrap_or(Path::new(".")).display()
        );
        #[expect(
            clippy::exit,
            reason = "the working threads need not be waited for: outputs are whole"
        )]
        std::process::exit(INTERRUPTED);
    });
}
