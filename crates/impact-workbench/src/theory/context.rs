//! Where a piece of work writes its results, and to whom it reports.

use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::block_cache::BlockCache;
use impact_campaign::pipeline::table::Table;
use impact_report::kit::Figure;
use impact_report::picture::pictures;
use labfiles_write::output::OutputError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ops::Range;

/// Which pictures of its figures a piece of work makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pictures {
    /// None.
    None,
    /// SVG, PNG and PDF.
    All,
}

/// Receives a file: its name and its bytes.
pub type Output<'a> = &'a (dyn Fn(&str, &[u8]) -> Result<(), OutputError> + Sync);

/// Where a piece of work writes its results, and to whom it reports.
pub struct StudyContext<'a> {
    /// Receives each file of the results.
    pub output: Output<'a>,
    /// The pictures to make.
    pub pictures: Pictures,
    /// Blocks of an earlier, interrupted run.
    pub blocks: &'a BlockCache,
    /// Receives the steps done and the number of steps.
    pub progress: &'a (dyn Fn(u64, u64) + Sync),
    /// Receives messages for the user.
    pub inform: &'a (dyn Fn(&str) + Sync),
}

impl StudyContext<'_> {
    /// Write a table as `NAME.csv` and `NAME.parquet`.
    pub(super) fn table(&self, name: &str, table: &Table) -> Result<(), PipelineError> {
        self.bytes(&format!("{name}.csv"), table.csv().as_bytes())?;
        let parquet = table.parquet().map_err(PipelineError::in_table(name))?;
        self.bytes(&format!("{name}.parquet"), &parquet)
    }

    /// Work in blocks of some rows, which are kept for a resumed run.
    pub(super) fn in_blocks<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        rows: usize,
        size: usize,
        of: impl Fn(Range<usize>) -> Result<Vec<T>, PipelineError>,
    ) -> Result<Vec<T>, PipelineError> {
        let mut all = Vec::new();
        for first in (0..rows).step_by(size) {
            let last = (first + size).min(rows);
            let block = self
                .blocks
                .block(&format!("{name} {first}"), || of(first..last));
            all.extend(block?);
            (self.progress)(last as u64, rows as u64);
        }
        Ok(all)
    }

    /// Write a figure, where there is one, as the pictures that are wanted.
    pub(super) fn figure(&self, figure: Option<&Figure>) -> Result<(), PipelineError> {
        let Some(figure) = figure else {
            return Ok(());
        };
        match self.pictures {
            Pictures::None => Ok(()),
            Pictures::All => {
                let files = pictures(figure)?;
                let mut files = files.iter();
                files.try_for_each(|(name, bytes)| self.bytes(name, bytes))
            }
        }
    }

    pub(super) fn bytes(&self, name: &str, bytes: &[u8]) -> Result<(), PipelineError> {
        Ok((self.output)(name, bytes)?)
    }
}
