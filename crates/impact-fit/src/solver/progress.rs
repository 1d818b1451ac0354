//! How far the fits of an identification have come.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use argmin::core::observers::Observe;
use argmin::core::{Error, KV, State};

/// Iterations of all fits that share it; its clones count together. Observes argmin's executor; read
/// by whoever shows it.
#[derive(Debug, Clone, Default)]
pub struct FitProgress(Arc<AtomicU64>);

impl FitProgress {
    /// Iterations so far.
    pub fn iterations(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl<I: State> Observe<I> for FitProgress {
    fn observe_iter(&mut self, _: &I, _: &KV) -> Result<(), Error> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}
