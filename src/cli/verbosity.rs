//! How much the program prints on the standard error stream.

/// Prints on the standard error stream what `--quiet`, `-v` and `-vv` ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verbosity {
    /// `--quiet`: errors only.
    Quiet,
    /// Results and warnings.
    Normal,
    /// `-v`: also versions, files, times of the stages and how each fit ended.
    Detailed,
    /// `-vv`: also each record and what the readers noted.
    Everything,
}

impl Verbosity {
    /// From the flags of the command line.
    pub(super) fn new(quiet: bool, verbose: u8) -> Self {
        match (quiet, verbose) {
            (true, _) => Self::Quiet,
            (false, 0) => Self::Normal,
            (false, 1) => Self::Detailed,
            (false, _) => Self::Everything,
        }
    }

    /// Whether only errors are printed.
    pub(super) fn is_quiet(self) -> bool {
        self == Self::Quiet
    }

    /// Whether details are asked for, by `-v` or `-vv`.
    pub(super) fn is_detailed(self) -> bool {
        self >= Self::Detailed
    }

    /// Whether everything is asked for, by `-vv`.
    pub(super) fn is_everything(self) -> bool {
        self == Self::Everything
    }

    /// Print what every user wants to know.
    pub(super) fn info(self, text: &str) {
        if self >= Self::Normal {
            eprintln!("{text}");
        }
    }

    /// Print a detail, with `-v`.
    pub(super) fn detail(self, text: &str) {
        if self >= Self::Detailed {
            eprintln!("{text}");
        }
    }

    /// Print a detail of a single record or file, with `-vv`.
    pub(super) fn everything(self, text: &str) {
        if self >= Self::Everything {
            eprintln!("{text}");
        }
    }
}
