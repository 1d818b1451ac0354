//! Memory that the allocator keeps for later.

/// Give memory that is free back to the operating system, on all threads of the pool and this one.
///
/// The allocator does so by itself, but late: between two stages that need much, what the first has freed
/// would be held beside what the second takes.
pub(super) fn release() {
    // SAFETY: it takes no pointer and may be called at any time on any thread, also where another allocator
    // is the program's: then there is nothing to give back
    let collect = || unsafe { libmimalloc_sys::mi_collect(true) };
    rayon::broadcast(|_| collect());
    collect();
}
