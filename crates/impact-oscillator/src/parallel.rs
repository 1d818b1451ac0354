//! Independent pieces of work, on all threads of the current pool with the feature `rayon`, else
//! one after the other. Results come in the items' order, so they do not depend on the threads.

/// Apply a function to every item.
#[cfg(feature = "rayon")]
pub(crate) fn map<T: Sync, U: Send>(items: &[T], f: impl Fn(&T) -> U + Send + Sync) -> Vec<U> {
    use rayon::prelude::*;
    let one = crate::model::patience::carry_each(f);
    items.par_iter().map(one).collect()
}

/// Apply a function to every item.
#[cfg(not(feature = "rayon"))]
pub(crate) fn map<T, U>(items: &[T], f: impl Fn(&T) -> U) -> Vec<U> {
    items.iter().map(f).collect()
}

/// Number of threads that [`map`] uses.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    return 1;
}
