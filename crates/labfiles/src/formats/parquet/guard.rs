//! The library under this reader panics on some damaged files; here a panic becomes an answer.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Run the library on this thread: what it gives, or `None` if it panicked.
pub(crate) fn caught<T>(run: impl FnOnce() -> T) -> Option<T> {
    let before = CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(run));
    CAUGHT.set(before);
    result.ok()
}

/// Whether a panic on this thread would become an answer, so that its text need not be printed.
pub fn is_caught() -> bool {
    CAUGHT.get()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_are_caught_on_their_own_thread_only() {
        let other = || std::thread::spawn(is_caught).join().unwrap();
        assert_eq!(caught(|| (is_caught(), other())), Some((true, false)));
        assert_eq!(caught(|| -> u8 { panic!("of the library") }), None);
        assert!(!is_caught());
    }
}
