//! Files of what is shown, by the code of `impactid study`: the same bytes.

use std::sync::Mutex;

use serde_json::json;

use super::ExploreError;
use super::job::Job;
use super::state::State;
use super::stop::Stop;
use crate::theory::{Pictures, StudyContext, run};
use impact_campaign::pipeline::block_cache::BlockCache;

/// The tables that `impactid study` would write of the state's study.
pub(super) fn files(state: &State) -> Result<Vec<(String, String)>, ExploreError> {
    let written = Mutex::new(Vec::new());
    run(
        &state.study(),
        &StudyContext {
            output: &|name, bytes| {
                if let (Ok(text), Ok(mut all)) = (String::from_utf8(bytes.to_vec()), written.lock())
                {
                    all.push((name.to_owned(), text));
                }
                Ok(())
            },
            pictures: Pictures::None,
            blocks: &BlockCache::none(),
            progress: &|_, _| {},
            inform: &|_| {},
        },
    )?;
    Ok(written.into_inner().unwrap_or_default())
}

/// The study as TOML.
pub(super) fn study_text(state: &State) -> Result<String, ExploreError> {
    toml::to_string(&state.study()).map_err(|e| ExploreError::malformed("study", e))
}

/// Send the study that reproduces what is shown.
pub(super) fn study(state: &State, job: &Job) -> Result<(), Stop> {
    send(vec![("study.toml".to_owned(), study_text(state)?)], job)
}

/// Send its tables.
pub(super) fn tables(state: &State, job: &Job) -> Result<(), Stop> {
    send(job.pools.work(|| files(state))?, job)
}

fn send(all: Vec<(String, String)>, job: &Job) -> Result<(), Stop> {
    let files: Vec<_> = all
        .into_iter()
        .filter(|(name, _)| !name.ends_with(".parquet"))
        .map(|(name, text)| json!({"name": name, "text": text}))
        .collect();
    Ok(job.send(job.frame("files").with("files", files))?)
}
