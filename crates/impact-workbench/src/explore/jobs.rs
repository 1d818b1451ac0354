//! Requests become jobs: of each slot the newest counts, and a job that is no longer the newest stops
//! where it next looks.

use std::collections::BTreeMap;
use std::sync::Arc;

use tokio::sync::{mpsc, watch};

use super::answer::answer;
use super::first_tiles::FirstTiles;
use super::frame::Frame;
use super::job::{Audience, Job, refusal};
use super::pools::Pools;
use super::wire::{Ask, Kind, Request};
use super::{ExploreError, Session, maps};

/// Requests of the queue that wait at most.
const QUEUE: usize = 16;

/// The jobs of one page.
pub(super) struct Jobs {
    newest: BTreeMap<Kind, watch::Sender<Option<Request>>>,
    queue: mpsc::Sender<Request>,
    outbox: mpsc::Sender<Frame>,
    first_tiles: Arc<FirstTiles>,
}

impl Jobs {
    /// Start the slots of a page; frames go to the outbox.
    pub(super) fn start(session: &Arc<Session>, outbox: &mpsc::Sender<Frame>) -> Self {
        let first_tiles = Arc::<FirstTiles>::default();
        let shared = Shared {
            session: Arc::clone(session),
            outbox: outbox.clone(),
            pools: Arc::default(),
            first_tiles: Arc::clone(&first_tiles),
        };
        let mut newest = BTreeMap::new();
        for slot in Kind::NEWEST {
            let (sender, receiver) = watch::channel(None);
            newest.insert(slot, sender);
            tokio::spawn(newest_of(shared.clone(), receiver));
        }
        let (queue, waiting) = mpsc::channel(QUEUE);
        tokio::spawn(one_by_one(shared, waiting));
        Self {
            newest,
            queue,
            outbox: outbox.clone(),
            first_tiles,
        }
    }

    /// Take a request. Bare boundaries that the page does not have are answered at once, before the jobs
    /// that follow take the processors.
    pub(super) async fn take(&self, request: Request) {
        let id = request.id;
        if let Ask::Map {} = request.ask {
            self.first_tiles.wanted(id);
        }
        if let Ask::Boundaries {
            points,
            known: false,
        } = request.ask
        {
            let state = request.state.clone();
            let found = tokio::task::spawn_blocking(move || maps::bare(&state, points, id)).await;
            match found.unwrap_or_else(|_| Err(failed())) {
                Ok(frame) => _ = self.outbox.send(frame).await,
                Err(error) => return self.refuse(id, &error).await,
            }
        }
        if let Some(slot) = self.newest.get(&request.ask.slot()) {
            slot.send_replace(Some(request));
        } else if self.queue.try_send(request).is_err() {
            let busy = ExploreError::Absent("too many requests wait; ask again".into());
            self.refuse(id, &busy).await;
        }
    }

    async fn refuse(&self, id: u32, error: &ExploreError) {
        // a page that is gone needs no refusal
        let _ = self.outbox.send(refusal(id, error)).await;
    }
}

/// What the jobs of a page share.
#[derive(Clone)]
struct Shared {
    session: Arc<Session>,
    outbox: mpsc::Sender<Frame>,
    pools: Arc<Pools>,
    first_tiles: Arc<FirstTiles>,
}

async fn newest_of(shared: Shared, mut newest: watch::Receiver<Option<Request>>) {
    while newest.changed().await.is_ok() {
        let Some(request) = newest.borrow_and_update().clone() else {
            continue;
        };
        shared.work(request, Some(newest.clone())).await;
    }
}

async fn one_by_one(shared: Shared, mut waiting: mpsc::Receiver<Request>) {
    while let Some(request) = waiting.recv().await {
        shared.work(request, None).await;
    }
}

impl Shared {
    /// Do a job on a thread of its own, until its slot has something newer; one that panics is refused, the page
    /// lives on.
    async fn work(&self, request: Request, newest: Option<watch::Receiver<Option<Request>>>) {
        let job = Job {
            id: request.id,
            pools: Arc::clone(&self.pools),
            audience: Audience {
                newest,
                outbox: self.outbox.clone(),
            },
            first_tiles: Arc::clone(&self.first_tiles),
        };
        let (id, session) = (job.id, Arc::clone(&self.session));
        let done = tokio::task::spawn_blocking(move || answer(&session, &request, &job)).await;
        if done.is_err() {
            let _ = self.outbox.send(refusal(id, &failed())).await;
        }
    }
}

fn failed() -> ExploreError {
    ExploreError::Server("this computation failed".into())
}
