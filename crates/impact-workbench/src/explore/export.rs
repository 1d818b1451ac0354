//! Files of what is shown, by the code of `impactid study`: the same bytes.

use std::sync::Mutex;

use serde_json::json;

use super::ExploreError;
use super::answer::Stop;
use super::jobs::Job;
use super::state::State;
use super::wire::ExportFile;
use crate::theory::{Pictures, StudyContext, run};
use impact_campaign::pipeline::block_cache::BlockCache;

/// The files that `impactid study` would write of the state's study.
pub(super) fn files(
    state: &State,
    pictures: Pictures,
) -> Result<Vec<(String, String)>, ExploreError> {
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
            pictures,
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

/// Send the files that the page asks for.
pub(super) fn export(state: &State, file: ExportFile, job: &Job) -> Result<(), Stop> {
    let (ending, pictures) = match file {
        ExportFile::Study => {
            let text = study_text(state)?;
            let files = json!([{"name": "study.toml", "text": text}]);
            return Ok(job.send(job.frame("files").with("files", files))?);
        }
        ExportFile::Csv => (".csv", Pictures::None),
        ExportFile::Svg => (".svg", Pictures::Svg),
    };
    let all = files(state, pictures)?;
    let of_kind = all.into_iter().filter(|(name, _)| name.ends_with(ending));
    let files: Vec<_> = of_kind
        .map(|(name, text)| json!({"name": name, "text": text}))
        .collect();
    Ok(job.send(job.frame("files").with("files", files))?)
}
