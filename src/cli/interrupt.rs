//! Ctrl-C: a clear message, no partial file, exit code 130.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use labfiles_write::output::{Lock, OutputError};
use signal_hook::consts::{SIGINT, SIGTERM};

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

/// The right to write into a folder, created where it is not there. From now on Ctrl-C removes its
/// partial files, prints a message and ends the program.
///
/// # Errors
/// Those of [`Lock::take`].
pub(super) fn lock(folder: &Path) -> Result<Lock, OutputError> {
    // first: a signal that comes in between must not end the program without its message
    watch(folder.to_path_buf());
    Lock::take(folder)
}

/// From now on Ctrl-C removes the partial files in `folder` too, prints a message and ends the program.
pub(super) fn watch(folder: PathBuf) {
    if !remember(folder) {
        return;
    }
    if let Some(flag) = flag_of_signals() {
        std::thread::spawn(move || {
            wait_for(&flag);
            end();
        });
    }
}

/// From now on the first Ctrl-C sets what is returned; the second removes the partial files in `folder`
/// and ends the program.
pub(super) fn asked(folder: PathBuf) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    remember(folder);
    if let Some(flag) = flag_of_signals() {
        let asked = Arc::clone(&stop);
        std::thread::spawn(move || {
            wait_for(&flag);
            asked.store(true, Ordering::SeqCst);
            flag.store(false, Ordering::SeqCst);
            say("the results are being completed; Ctrl-C again ends at once.");
            wait_for(&flag);
            end();
        });
    }
    stop
}

/// Note a folder; whether it is the first.
fn remember(folder: PathBuf) -> bool {
    let mut folders = FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
    folders.push(if folder.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        folder
    });
    folders.len() == 1
}

/// What a signal sets; `None` where the system does not allow it.
fn flag_of_signals() -> Option<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    const ENDS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    #[cfg(not(unix))]
    const ENDS: [i32; 2] = [SIGINT, SIGTERM];
    for signal in ENDS {
        signal_hook::flag::register(signal, Arc::clone(&flag)).ok()?;
    }
    #[cfg(windows)]
    when_the_console_is_closed(&flag)?;
    Some(flag)
}

/// Windows ends a program whose console was closed when its handler returns, or after 5 s: until then it has ended by itself.
/// The runtime makes the signal of Ctrl-Break of it.
#[cfg(windows)]
fn when_the_console_is_closed(flag: &Arc<AtomicBool>) -> Option<()> {
    const SIGBREAK: i32 = 21;
    let flag = Arc::clone(flag);
    let set = move || {
        flag.store(true, Ordering::SeqCst);
        std::thread::sleep(Duration::from_secs(5));
    };
    // SAFETY: on Windows a handler runs on a thread of its own, which may do what every thread may
    let registered = unsafe { signal_hook::low_level::register(SIGBREAK, set) };
    registered.ok().map(drop)
}

/// Say something where anybody reads it: a terminal that is gone does not keep the program from ending.
fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "\nimpactid: {text}");
}

fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::SeqCst) {
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// End the program: outputs are complete or absent.
fn end() {
    ENDING.store(true, Ordering::SeqCst);
    let folders = FOLDERS.lock().map(|f| f.clone()).unwrap_or_default();
    for folder in &folders {
        labfiles_write::output::clear_own_parts(folder);
    }
    let first = folders.first().map(PathBuf::as_path);
    say(&format!(
        "interrupted. Outputs in {} are complete or absent; run the same command again \
         (with --resume, if it has that option, it continues).",
        first.unwrap_or(Path::new(".")).display()
    ));
    #[expect(
        clippy::exit,
        reason = "the working threads need not be waited for: outputs are whole"
    )]
    std::process::exit(INTERRUPTED);
}
