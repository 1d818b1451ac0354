//! The threads of one page: what it asks for never stops what another one does.

use std::sync::OnceLock;

use impact_oscillator::model::patience::carry;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads of a page, begun when they are first needed; `None` where the system gives none.
#[derive(Default)]
pub(super) struct Pools {
    all: OnceLock<Option<ThreadPool>>,
    first: OnceLock<Option<ThreadPool>>,
}

impl Pools {
    /// The threads that march maps, basins and lines, and look where boundaries exist: where they cannot give way
    /// to the browser one fewer than there are.
    pub(super) fn work<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let spared = if cfg!(target_os = "linux") { 0 } else { 1 };
        let threads = rayon::current_num_threads().saturating_sub(spared);
        in_pool(self.all.get_or_init(|| pool(threads.max(1))), work)
    }

    /// The thread of the first tiles: one, so that the browser, which is most often on the same machine, draws one
    /// while the next is computed.
    pub(super) fn first_tiles<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        in_pool(self.first.get_or_init(|| pool(1)), work)
    }
}

fn pool(threads: usize) -> Option<ThreadPool> {
    let builder = ThreadPoolBuilder::new().num_threads(threads);
    builder.start_handler(|_| give_way()).build().ok()
}

/// Work on the threads of a pool, in the order in which it comes; it is given up with the work of this thread.
fn in_pool<T: Send>(pool: &Option<ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(carry(work)),
        None => work(),
    }
}

/// Nice value of these threads.
#[cfg(target_os = "linux")]
const GIVES_WAY: i32 = 10;

/// Let other threads go before this one. Linux has a priority of each thread; where it may not be changed, the
/// map is as quick, and the browser waits for it.
#[cfg(target_os = "linux")]
fn give_way() {
    let _ = rustix::process::setpriority_process(None, GIVES_WAY);
}

#[cfg(not(target_os = "linux"))]
fn give_way() {}
