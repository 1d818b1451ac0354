//! Cells that the threads of a pool share.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::kernel::{Cell, Course, Feed, Kernel, Outcome, run};
use crate::model::patience;
use crate::parallel;

/// Cells shared by the threads, each of which takes the next.
#[derive(Clone)]
pub(super) struct Shared<'a> {
    cells: &'a [Cell],
    next: &'a AtomicUsize,
    block: std::ops::Range<usize>,
}

/// Cells a thread takes at a time.
const BLOCK: usize = 8;

impl Shared<'_> {
    /// A cell that no thread has taken; none once nobody wants them.
    pub(super) fn take(&mut self) -> Option<(usize, Cell)> {
        if self.block.is_empty() {
            if patience::is_over() {
                return None;
            }
            let first = self.next.fetch_add(BLOCK, Ordering::Relaxed);
            self.block = first..(first + BLOCK).min(self.cells.len());
        }
        self.block.next().map(|i| (i, self.cells[i]))
    }
}

/// A thread's march, and what became of its cells.
struct March<'a> {
    cells: Shared<'a>,
    done: Vec<(usize, Outcome)>,
}

impl Feed for March<'_> {
    fn next(&mut self) -> Option<(usize, Cell)> {
        self.cells.take()
    }
    fn done(&mut self, index: usize, outcome: Outcome) {
        self.done.push((index, outcome));
    }
}

/// March cells on all threads of the pool; outcomes in the cells' order.
pub fn march_all(course: &Course, cells: &[Cell], kernel: Option<Kernel>) -> Vec<Outcome> {
    let kernel = available(kernel);
    on_all_threads(cells, |shared| {
        let mut march = March {
            cells: shared,
            done: Vec::new(),
        };
        run(kernel, course, &mut march);
        march.done
    })
}

/// The kernel that is asked for, or the widest where it is not to be had.
pub(super) fn available(kernel: Option<Kernel>) -> Kernel {
    kernel
        .filter(|k| k.is_available())
        .unwrap_or_else(Kernel::of_this_machine)
}

/// What becomes of cells that all threads share, in the cells' order.
pub(super) fn on_all_threads<T: Send + Clone>(
    cells: &[Cell],
    march: impl Fn(Shared<'_>) -> Vec<(usize, T)> + Sync,
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let shared = Shared {
        cells,
        next: &next,
        block: 0..0,
    };
    let workers: Vec<usize> = (0..parallel::threads()).collect();
    let mut all = parallel::map(&workers, |_| march(shared.clone())).concat();
    all.sort_unstable_by_key(|p| p.0);
    all.into_iter().map(|p| p.1).collect()
}
