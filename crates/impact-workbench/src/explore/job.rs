//! A job that is being done, and who waits for what it finds.

use std::sync::Arc;
use std::time::{Duration, Instant};

use impact_oscillator::Patience;
use tokio::sync::{mpsc, watch};

use super::ExploreError;
use super::first_tiles::{FirstTiles, Underway};
use super::frame::Frame;
use super::pools::Pools;
use super::stop::Stale;
use super::wire::Request;

/// A job that is being done.
pub(super) struct Job {
    /// The request's number.
    pub id: u32,
    /// The threads of its page.
    pub pools: Arc<Pools>,
    /// Who waits for it.
    pub audience: Audience,
    /// What of the page's maps is through.
    pub first_tiles: Arc<FirstTiles>,
}

/// Who waits for what a job finds.
#[derive(Clone)]
pub(super) struct Audience {
    /// The newest request of the job's slot, where it has one.
    pub newest: Option<watch::Receiver<Option<Request>>>,
    /// Where frames are sent to.
    pub outbox: mpsc::Sender<Frame>,
}

impl Audience {
    /// Whether the page is gone or has asked for something newer.
    fn is_gone(&self) -> bool {
        let replaced = |newest: &watch::Receiver<_>| newest.has_changed().unwrap_or(true);
        self.outbox.is_closed() || self.newest.as_ref().is_some_and(replaced)
    }
}

impl Job {
    /// Simulations go on as long as somebody waits for them, and no longer than a limit.
    pub(super) fn patience(&self, longest: Duration) -> Patience {
        let (audience, begin) = (self.audience.clone(), Instant::now());
        Patience::new(move || begin.elapsed() < longest && !audience.is_gone())
    }

    /// This map's first tiles begin.
    pub(super) fn first_tiles(&self) -> Underway<'_> {
        self.first_tiles.underway(self.id)
    }

    /// Wait until the first tiles of the page's newest map are through.
    pub(super) fn wait_for_first_tiles(&self) {
        self.first_tiles.wait_while(|| !self.is_stale());
    }

    /// Whether the page is gone or has asked for something newer.
    pub(super) fn is_stale(&self) -> bool {
        self.audience.is_gone()
    }

    /// Wait for a time as long as somebody waits for the job.
    pub(super) fn wait_while_wanted(&self, time: Duration) -> Result<(), Stale> {
        /// Between two looks at whether somebody does.
        const LOOK: Duration = Duration::from_millis(20);
        let begin = Instant::now();
        while begin.elapsed() < time {
            if self.is_stale() {
                return Err(Stale);
            }
            std::thread::sleep(LOOK);
        }
        Ok(())
    }

    /// Send a frame.
    pub(super) fn send(&self, frame: Frame) -> Result<(), Stale> {
        self.audience.outbox.blocking_send(frame).map_err(|_| Stale)
    }

    /// A frame in answer to this request.
    pub(super) fn frame(&self, kind: &str) -> Frame {
        Frame::new(kind, self.id)
    }
}

/// A refusal, as the page shows it.
pub(super) fn refusal(id: u32, error: &ExploreError) -> Frame {
    Frame::new("refused", id)
        .with("message", error.to_string())
        .with("remedy", error.remedy())
}
