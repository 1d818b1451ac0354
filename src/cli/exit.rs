//! Exit codes mean something.

use std::process::ExitCode;

use impact_fit::VerdictKind;

/// How the program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Done: 0.
    Done,
    /// Done, but the answer is "does not fit" or "not identifiable": 1.
    AnswerIsNo,
    /// Bad input, or an output that could not be written: 2.
    BadInput,
}

impl Exit {
    /// What a verdict means for the shell.
    pub fn of(verdict: VerdictKind) -> Self {
        match verdict {
            VerdictKind::Identified | VerdictKind::Weak => Self::Done,
            VerdictKind::NotIdentifiable | VerdictKind::DoesNotFit => Self::AnswerIsNo,
        }
    }

    /// The number that the shell sees.
    pub fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::AnswerIsNo => 1,
            Self::BadInput => 2,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}
