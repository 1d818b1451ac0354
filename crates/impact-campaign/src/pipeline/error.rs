//! Why the pipeline stops, and how it reports its progress.

use std::path::PathBuf;

use impact_identification::identify::Identification;
use impact_oscillator::model::ModelError;
use impact_records::record::Flag;
use labfiles::ReadError;
use labfiles_write::output::OutputError;

/// Called with the stage, the steps done and the total steps.
pub type Progress<'a> = &'a (dyn Fn(&'static str, u64, u64) + Sync);

/// A record that cannot be used, with the flags that say why.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedRecord {
    /// Its file.
    pub file: PathBuf,
    /// Its name.
    pub record: String,
    /// Its flags.
    pub flags: Vec<Flag>,
}

/// Why the pipeline stopped.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// An output could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The answer is computed, and an output could not be written.
    #[error("{source}")]
    AnswerUnwritten {
        /// The answer.
        answer: Box<Identification>,
        /// Why.
        source: Box<Self>,
    },
    /// An input could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A table could not be made or read.
    #[error("{table}: {reason}")]
    Table {
        /// Which table.
        table: String,
        /// Message of the library.
        reason: String,
    },
    /// An output of a previous stage is missing or unreadable.
    #[error("{path}: {reason}")]
    Store {
        /// The file.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A folder or a file holds no results.
    #[error("{path}: {reason}")]
    NoResults {
        /// The path.
        path: String,
        /// What is wrong with it.
        reason: String,
        /// What to do.
        remedy: String,
    },
    /// Campaigns cannot be compared.
    #[error(transparent)]
    Comparison(#[from] impact_identification::compare::ComparisonError),
    /// Results were written by another version of the program.
    #[error("{path} has layout {found}; this program reads and writes layout {expected}")]
    Layout {
        /// The file.
        path: String,
        /// Its layout.
        found: String,
        /// The layout of this program.
        expected: String,
    },
    /// No record of the campaign could be used.
    #[error("{}", none_usable(.0.len()))]
    NothingUsable(Vec<RefusedRecord>),
    /// A template, a table of words or a logo could not be read.
    #[error("{path}: {reason}")]
    ReportFile {
        /// The file.
        path: String,
        /// Message of the system.
        reason: String,
    },
    /// The report could not be made.
    #[error(transparent)]
    Report(#[from] impact_report::ReportError),
    /// The simulation refused its parameters.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A study refuses its parameters.
    #[error("{name}: {source}")]
    Study {
        /// What was computed.
        name: String,
        /// Which parameter.
        source: ModelError,
    },
    /// The HDF5 writer failed.
    #[error(transparent)]
    Hdf5(#[from] labfiles_write::hdf5::WriteError),
}

impl PipelineError {
    /// A model's refusal of a named study.
    pub fn in_study(name: &str) -> impl Fn(ModelError) -> Self + use<'_> {
        move |source| Self::Study {
            name: name.to_owned(),
            source,
        }
    }

    /// Why a table could not be made or read.
    pub fn in_table<E: ToString>(table: &str) -> impl Fn(E) -> Self + use<'_, E> {
        move |error| Self::Table {
            table: table.to_owned(),
            reason: error.to_string(),
        }
    }

    /// What the user can do.
    pub fn remedy(&self) -> String {
        match self {
            Self::Output(error) => error.remedy().to_owned(),
            Self::AnswerUnwritten { source, .. } => source.remedy(),
            Self::Read(error) => error.remedy.clone(),
            Self::Store { .. } => {
                "run the previous stage again; the stages are ingest, classify, identify, report"
                    .to_owned()
            }
            Self::NoResults { remedy, .. } => remedy.clone(),
            Self::Comparison(error) => error.remedy().to_owned(),
            Self::Layout { .. } => {
                "run the campaign with this version of impactid into another folder (--out), or remove \
                 the results of the other version"
                    .to_owned()
            }
            Self::NothingUsable(_) => "fix what is wrong with the records, as listed".to_owned(),
            Self::ReportFile { .. } => {
                "check path and content of the template, the words and the logo, save texts as UTF-8, or leave them \
                 out"
                    .to_owned()
            }
            Self::Hdf5(error) => error.remedy().to_owned(),
            Self::Report(_) => "fix the template or the logo, or leave them out".to_owned(),
            Self::Study { .. } => "give a value within the range that the message names".into(),
            Self::Model(_) => "choose parameters within the range that the message names".into(),
            _ => {
                "this is an error of the program: please report it with the command line".to_owned()
            }
        }
    }
}

fn none_usable(records: usize) -> String {
    match records {
        1 => "the record cannot be used".to_owned(),
        many => format!("none of the {many} records can be used"),
    }
}
