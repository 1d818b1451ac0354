//! Work that may be given up: simulations end early once nobody waits for what they find.

use std::cell::RefCell;
use std::sync::Arc;

use super::error::ModelError;

/// Says whether work is still wanted. Simulations on the thread that works under it, and on those that it
/// shares its work with, look at it every few hundred flights.
///
/// ```
/// use impact_oscillator::{Impact, Initial, Machine, Patience, Setting, Simulator};
///
/// let setting = Setting::new(1.3, 1.0);
/// let mut simulator = Simulator::new(&Machine::symmetric(0.07, 0.9), setting, Initial::rest())?;
/// let unwanted = Patience::new(|| false);
/// let mut impacts = 0;
/// let work = || simulator.advance(1e15, &mut |_: &Impact| impacts += 1);
/// assert!(unwanted.work(work).is_err());
/// assert_eq!(impacts, 0);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
#[derive(Clone)]
pub struct Patience(Arc<dyn Fn() -> bool + Send + Sync>);

thread_local! {
    static OF_THIS_THREAD: RefCell<Option<Patience>> = const { RefCell::new(None) };
}

impl Patience {
    /// As long as a function returns true.
    pub fn new(is_wanted: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Arc::new(is_wanted))
    }

    /// Do work as long as it is wanted.
    ///
    /// # Errors
    /// [`ModelError::GivenUp`] where it is not at the end: what was found is not whole.
    pub fn work<T>(&self, work: impl FnOnce() -> T) -> Result<T, ModelError> {
        within(Some(self.clone()), || {
            let found = work();
            still_wanted().map(|()| found)
        })
    }
}

/// Before what was found is used.
///
/// # Errors
/// [`ModelError::GivenUp`] where the work of this thread is wanted no longer: what was found is not whole.
pub fn still_wanted() -> Result<(), ModelError> {
    if is_over() {
        Err(ModelError::GivenUp)
    } else {
        Ok(())
    }
}

/// Work for another thread that is given up with the work of this one.
pub fn carry<T>(work: impl FnOnce() -> T) -> impl FnOnce() -> T {
    let now = current();
    move || within(now, work)
}

/// The same for work that is done once for every item, wherever that is.
pub fn carry_each<I, T>(work: impl Fn(I) -> T + Send + Sync) -> impl Fn(I) -> T + Send + Sync {
    let now = current();
    move |item| within(now.clone(), || work(item))
}

/// The patience of this thread.
fn current() -> Option<Patience> {
    OF_THIS_THREAD.with_borrow(Clone::clone)
}

/// Do work under a patience, or under none.
fn within<T>(patience: Option<Patience>, work: impl FnOnce() -> T) -> T {
    /// Puts the one before back, also where the work panics.
    struct Before(Option<Patience>);
    impl Drop for Before {
        fn drop(&mut self) {
            OF_THIS_THREAD.set(self.0.take());
        }
    }
    let _before = Before(OF_THIS_THREAD.replace(patience));
    work()
}

/// Whether the work of this thread is wanted no longer.
pub(crate) fn is_over() -> bool {
    OF_THIS_THREAD.with_borrow(|now| now.as_ref().is_some_and(|patience| !(patience.0)()))
}
