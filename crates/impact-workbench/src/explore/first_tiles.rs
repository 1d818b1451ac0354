//! Which map of a page has shown its first tiles: what is less urgent waits for them.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Numbers of the newest map that a page has asked for, and of the newest whose first tiles are through.
#[derive(Debug, Default)]
pub(super) struct FirstTiles {
    numbers: Mutex<Numbers>,
    through: Condvar,
}

#[derive(Debug, Default)]
struct Numbers {
    wanted: u32,
    through: u32,
}

/// The first tiles of a map while they are computed; they are through when it goes out of scope.
pub(super) struct Underway<'a> {
    tiles: &'a FirstTiles,
    map: u32,
}

/// Time between two looks at whether waiting still makes sense.
const PATIENCE: Duration = Duration::from_millis(50);

impl FirstTiles {
    /// The page has asked for a map by its number.
    pub(super) fn wanted(&self, map: u32) {
        self.numbers().wanted = map;
    }

    /// The map begins.
    pub(super) fn underway(&self, map: u32) -> Underway<'_> {
        Underway { tiles: self, map }
    }

    /// Wait until the first tiles of the newest map are through, or nobody wants to.
    pub(super) fn wait_while(&self, wanted: impl Fn() -> bool) {
        let mut numbers = self.numbers();
        while numbers.through < numbers.wanted && wanted() {
            let waited = self.through.wait_timeout(numbers, PATIENCE);
            numbers = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn numbers(&self) -> MutexGuard<'_, Numbers> {
        // two numbers that no panic leaves half written
        self.numbers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Underway<'_> {
    fn drop(&mut self) {
        self.tiles.numbers().through = self.map;
        self.tiles.through.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_map_is_waited_for_until_its_first_tiles_are_through() {
        let tiles = FirstTiles::default();
        tiles.wait_while(|| true);
        tiles.wanted(3);
        // nobody wants to wait
        tiles.wait_while(|| false);
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| tiles.wait_while(|| true));
            drop(tiles.underway(2));
            std::thread::sleep(PATIENCE);
            assert!(!waiting.is_finished());
            drop(tiles.underway(3));
        });
    }
}
