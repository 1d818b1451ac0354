//! Each request with what answers it.

use serde_json::json;

use super::frame::Frame;
use super::job::{Job, refusal};
use super::stop::Stop;
use super::wire::{Ask, Request};
use super::{ExploreError, Session, demo, evidence, export, limits, maps, motions};

/// Answer a request.
pub(super) fn answer(session: &Session, request: &Request, job: &Job) {
    let found = match request.ask.longest() {
        Some(longest) => job.patience(longest).work(|| ask(session, request, job)),
        None => Ok(ask(session, request, job)),
    };
    let stop = match found {
        Ok(answered) => answered,
        Err(_) if job.is_stale() => Err(Stop::Stale),
        Err(_) => Err(Stop::Refused(ExploreError::TooLong)),
    };
    if let Err(Stop::Refused(error)) = stop {
        // a page that is gone needs no refusal
        let _ = job.send(refusal(job.id, &error));
    }
}

fn ask(session: &Session, request: &Request, job: &Job) -> Result<(), Stop> {
    let state = &request.state;
    match &request.ask {
        Ask::Hello {} => hello(session, job),
        Ask::Map {} => maps::map(state, job),
        Ask::Boundaries { points, .. } => maps::boundaries(state, *points, job),
        Ask::Ahead { points } => Ok(job.send(maps::bare(state, *points, job.id)?)?),
        Ask::Motion { carried_from } => motions::motion(state, *carried_from, job),
        Ask::Run { periods, facts } => motions::run(state, *periods, *facts, job),
        Ask::Line {} => motions::line(state, job),
        Ask::Basins {} => motions::basins(state, job),
        Ask::Coexisting {} => motions::coexisting(state, job),
        Ask::Inset {} => {
            let cursor = &state.cursor;
            motions::motion(state, Some((cursor.eta, cursor.rho)), job)
        }
        Ask::Record {} => evidence::record(&*session.campaign()?, state, job),
        Ask::Residuals {} => evidence::residuals(&*session.campaign()?, state, job),
        Ask::Proposals {} => evidence::proposals(&*session.campaign()?, job),
        Ask::Study {} => export::study(state, job),
        Ask::Tables {} => export::tables(state, job),
        Ask::Demo { name } => send_demo(&demo::shipped(name)?, job),
        Ask::ReadDemo { text } => send_demo(&demo::Demo::read(text)?, job),
        Ask::WriteDemo { title, steps } => {
            let text = demo::write(title, steps)?;
            Ok(job.send(job.frame("demo_text").with("text", text))?)
        }
    }
}

fn hello(session: &Session, job: &Job) -> Result<(), Stop> {
    let frame = job
        .frame("hello")
        .with("program", env!("CARGO_PKG_VERSION"))
        .with("state", session.state())
        .with("limits", limits::all())
        .with("demos", demo::list())
        .with("title", session.title())
        .with("campaign", session.campaign().ok().map(|c| c.facts()))
        .with("demo", session.demo())
        .with("notes", session.notes());
    Ok(job.send(frame)?)
}

/// The campaign as it is now, which no page asked for.
pub(super) fn campaign_now(session: &Session) -> Option<Frame> {
    let campaign = session.campaign().ok()?;
    let frame = Frame::new("campaign", 0).with("state", session.state());
    Some(frame.with("campaign", campaign.facts()))
}

fn send_demo(demo: &demo::Demo, job: &Job) -> Result<(), Stop> {
    let steps: Vec<_> = demo
        .steps
        .iter()
        .map(|(s, state)| json!({"seconds": s.seconds, "caption": s.caption, "carry": s.carry, "state": state}))
        .collect();
    let frame = job.frame("demo").with("title", &demo.title);
    Ok(job.send(frame.with("steps", steps))?)
}
