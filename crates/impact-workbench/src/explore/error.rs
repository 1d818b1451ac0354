//! Why the explorer cannot start, or refuses a request.

use impact_oscillator::ModelError;

/// Why the explorer cannot do something.
#[derive(Debug, thiserror::Error)]
pub enum ExploreError {
    /// A state is of another version of the explorer.
    #[error("the state has version {found}, this program reads version {expected}")]
    Version {
        /// The version that it has.
        found: String,
        /// The version that this program reads.
        expected: u32,
    },
    /// A text is not what it should be.
    #[error("{what}: {reason}")]
    Malformed {
        /// What was read.
        what: String,
        /// The reader's message.
        reason: String,
    },
    /// A value is outside its range, or the model refuses it.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A motion, or a picture of many, takes too long.
    #[error("this takes too long to compute")]
    TooLong,
    /// A record has no place here, or no such thing exists.
    #[error("{0}")]
    Absent(String),
    /// The port cannot be listened on.
    #[error("port {port} of 127.0.0.1: {reason}")]
    Port {
        /// The port.
        port: u16,
        /// The system's message.
        reason: String,
    },
    /// The server stopped.
    #[error("the server stopped: {0}")]
    Server(String),
    /// A stage of the pipeline failed.
    #[error(transparent)]
    Pipeline(#[from] impact_campaign::pipeline::PipelineError),
    /// Steps of demos did not show what they state.
    #[error("{} of the demos' steps differ: {}", .0.len(), .0.join("; "))]
    Demos(Vec<String>),
}

impl ExploreError {
    /// That a text is not what it should be.
    pub(super) fn malformed(what: &str, reason: impl ToString) -> Self {
        Self::Malformed {
            what: what.into(),
            reason: reason.to_string(),
        }
    }

    /// What the user can do.
    pub fn remedy(&self) -> String {
        match self {
            Self::Version { .. } => {
                "open it with the version of impactid that wrote it, or start from the page's first \
                 state"
            }
            Self::Malformed { .. } => "correct the place named",
            Self::Model(_) => {
                "give a value within the range that the message names"
            }
            Self::TooLong => "let it settle for fewer periods, choose a greater η, or fewer cells or steps",
            Self::Absent(_) => "choose one that the page lists",
            Self::Port { .. } => {
                "another program listens there, perhaps another explorer: choose another --port, or \
                 leave it out"
            }
            Self::Server(_) => "start `impactid explore` again",
            Self::Demos(_) => "correct the demos' `expect`, or report the difference",
            Self::Pipeline(error) => return error.remedy(),
        }
        .to_owned()
    }
}
