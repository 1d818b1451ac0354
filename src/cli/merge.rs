//! `impactid merge`: the parts of an atlas put together, exactly as one run gives it.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::atlas_part::NAME;
use super::patterns::expanded;
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity};
use impact_oscillator::atlas::shard::{AtlasPart, merge};
use impact_workbench::theory::regions::write_atlas;

/// Arguments of `impactid merge`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Merge {
    /// The parts that `impactid atlas --shard I/N` wrote, all N of them
    #[arg(value_name = "PART.JSON", required = true)]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    out: OutArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid atlas --shard 0/2 --out parts/
  impactid atlas --shard 1/2 --out parts/
  impactid merge parts/part-*.json --out atlas/

A part that is missing, there twice, damaged or of another atlas is refused. The result is bit \
for bit that of `impactid atlas` without --shard, with the study.toml that replays it.";

impl Merge {
    /// Put the parts together and write the atlas.
    ///
    /// # Errors
    /// [`Failure`] where the parts do not make up one atlas, or a file cannot be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let remedy = "name the files that `impactid atlas --shard I/N` wrote";
        let parts: Vec<AtlasPart> = expanded(&self.parts, remedy)?
            .iter()
            .map(|path| read(path))
            .collect::<Result<_, _>>()?;
        whole(&parts, &self.out, verbosity)
    }
}

/// Put parts together and write the atlas with its study.
///
/// # Errors
/// As [`Merge::go`].
pub(super) fn whole(
    parts: &[AtlasPart],
    out: &OutArgs,
    verbosity: Verbosity,
) -> Result<Exit, Failure> {
    let maps = merge(parts).map_err(|e| {
        let remedy = "give every part of one atlas once, all of one --shard …/N";
        Failure::new(e.to_string(), remedy)
    })?;
    let Some(first) = parts.first() else {
        return Ok(Exit::Done);
    };
    verbosity.info(&format!(
        "{} parts make {} cells",
        parts.len(),
        maps[0].len()
    ));
    let key = serde_json::to_string(&first.request)
        .map_err(|e| Failure::new(e.to_string(), "please report it with the command line"))?;
    out.complete(&key, &first.study, "merge", verbosity, |context| {
        Ok(write_atlas(&first.request, &maps, NAME, context)?)
    })
}

fn read(path: &Path) -> Result<AtlasPart, Failure> {
    let bytes = fs::read(path).map_err(|e| Failure::io(path, &e))?;
    serde_json::from_slice(&bytes).map_err(|e| {
        Failure::new(
            format!("{}: no part of an atlas: {e}", path.display()),
            "give files that `impactid atlas --shard I/N` wrote",
        )
    })
}
