//! Studies of the theory: small TOML files that list what to simulate. Each writes tables as CSV
//! and Parquet, and a figure as SVG, PNG and PDF.

pub mod basins;
pub mod block_cache;
pub mod map;
pub mod plan;
pub mod regions;
pub mod sweep;
pub mod time_series;

use crate::pipeline::table::{self, Table};
use crate::report::ReportError;
use crate::report::figures::Figure;
use crate::report::picture::pictures;
use block_cache::BlockCache;
use impact_oscillator::model::ModelError;
use labfiles::output::OutputError;
pub use plan::Study;

/// Why a study stopped.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A parameter is out of range.
    #[error("{name}: {source}")]
    Model {
        /// What was computed.
        name: String,
        /// Which parameter.
        source: ModelError,
    },
    /// An output could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A table could not be made.
    #[error("{table}: {reason}")]
    Table {
        /// Which table.
        table: String,
        /// The library's message.
        reason: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] ReportError),
}

impl StudyError {
    /// What the user can do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Model { .. } => "give a value within the range that the message names",
            Self::Output(e) => e.remedy(),
            Self::Table { .. } => "look at the disk, then run again",
            Self::Figure(_) => "the tables are written; draw them with another program",
        }
    }

    /// A model's refusal of a named piece of work.
    pub fn of(name: &str) -> impl Fn(ModelError) -> Self + use<'_> {
        move |source| Self::Model {
            name: name.to_owned(),
            source,
        }
    }
}

/// Which pictures of its figures a piece of work makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pictures {
    /// None.
    None,
    /// SVG alone.
    Svg,
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
    fn table(&self, name: &str, table: &Table) -> Result<(), StudyError> {
        self.bytes(&format!("{name}.csv"), table.csv().as_bytes())?;
        let parquet = table.parquet().map_err(|e| StudyError::Table {
            table: name.to_owned(),
            reason: e.to_string(),
        })?;
        self.bytes(&format!("{name}.parquet"), &parquet)
    }

    /// Write a figure as the pictures that are wanted.
    fn figure(&self, figure: &Figure) -> Result<(), StudyError> {
        match self.pictures {
            Pictures::None => Ok(()),
            Pictures::Svg => self.bytes(&format!("{}.svg", figure.name), figure.svg.as_bytes()),
            Pictures::All => {
                let files = pictures(figure)?;
                let mut files = files.iter();
                files.try_for_each(|(name, bytes)| self.bytes(name, bytes))
            }
        }
    }

    fn bytes(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        Ok((self.output)(name, bytes)?)
    }
}

/// Do all the work of a study.
///
/// # Errors
/// [`StudyError`] with the first piece of work that could not be done.
pub fn run(study: &Study, context: &StudyContext<'_>) -> Result<(), StudyError> {
    let machine = study.machine();
    machine.check().map_err(StudyError::of("machine"))?;
    for (name, plan) in &study.time_series {
        time_series::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.sweep {
        sweep::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.basins {
        basins::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.map {
        map::run(&machine, name, plan, context)?;
    }
    for (name, plan) in &study.regions {
        regions::run(&machine, name, plan, context)?;
    }
    Ok(())
}
