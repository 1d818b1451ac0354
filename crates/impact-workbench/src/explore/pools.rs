//! The threads of one page: what it asks for never stops what another one does.

use std::sync::OnceLock;

use impact_oscillator::model::patience::carry;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads of a page, begun when they are first needed; `None` where the system gives none.
#[derive(Default)]
pub(super) struct Pools {
    all: OnceLock<Option<ThreadPool>>,
    first: OnceLock<Option<ThreadPool>>,
    boundaries: OnceLock<Option<ThreadPool>>,
}

impl Pools {
    /// The threads that march maps, basins and lines.
    pub(super) fn work<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        in_pool(self.all.get_or_init(|| pool(threads(), Nice::Last)), work)
    }

    /// The threads that look where boundaries exist, while the map's last tile is marched.
    pub(super) fn boundaries<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let pool = || pool(threads(), Nice::First);
        in_pool(self.boundaries.get_or_init(pool), work)
    }

    /// The thread of the first tiles: one, so that the browser, which is most often on the same machine, draws one
    /// while the next is computed.
    pub(super) fn first_tiles<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        in_pool(self.first.get_or_init(|| pool(1, Nice::First)), work)
    }
}

/// Threads of a pool: where they cannot give way to the browser one fewer than there are.
fn threads() -> usize {
    let spared = if cfg!(target_os = "linux") { 0 } else { 1 };
    let threads = rayon::current_num_threads().saturating_sub(spared);
    threads.max(1)
}

/// Nice values of threads, all of which give way to the browser.
#[derive(Clone, Copy)]
enum Nice {
    /// Of what is looked at first.
    First = 10,
    /// Of what comes after it.
    Last = 15,
}

fn pool(threads: usize, nice: Nice) -> Option<ThreadPool> {
    let builder = ThreadPoolBuilder::new().num_threads(threads);
    builder.start_handler(move |_| give_way(nice)).build().ok()
}

/// Work on the threads of a pool, in the order in which it comes; it is given up with the work of this thread.
fn in_pool<T: Send>(pool: &Option<ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(carry(work)),
        None => work(),
    }
}

/// Let other threads go before this one. Linux has a priority of each thread; where it may not be changed, the
/// map is as quick, and the browser waits for it.
#[cfg(target_os = "linux")]
fn give_way(nice: Nice) {
    let _ = rustix::process::setpriority_process(None, nice as i32);
}

#[cfg(not(target_os = "linux"))]
fn give_way(_: Nice) {}
