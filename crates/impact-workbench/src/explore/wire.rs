//! What the page asks.

use std::time::Duration;

use serde::Deserialize;
use serde_json::Value;

use super::{ExploreError, State};

/// Longest time that one motion may take.
const LONGEST_MOTION: Duration = Duration::from_secs(20);
/// The same of a picture of many, which comes in parts.
const LONGEST_PICTURE: Duration = Duration::from_secs(1800);

/// A request of the page.
#[derive(Debug, Clone)]
pub(super) struct Request {
    /// The page's number of it, repeated in every answer.
    pub id: u32,
    /// What is asked.
    pub ask: Ask,
    /// The state for which; the first one where the page has none yet.
    pub state: State,
}

/// As it comes: the state is read by itself, so that one of another version is refused as such.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    id: u32,
    ask: Ask,
    #[serde(default)]
    state: Option<Value>,
}

/// What is asked.
#[derive(Debug, Clone, PartialEq, Deserialize, strum::EnumDiscriminants)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[strum_discriminants(name(Kind), vis(pub(super)), derive(PartialOrd, Ord))]
pub(super) enum Ask {
    /// What the page starts from: the state, the campaign, the demos.
    Hello {},
    /// Regions of motion, coarse first.
    Map {},
    /// Boundaries, bare first.
    Boundaries {
        /// Number of η.
        points: usize,
        /// Whether the page has them bare already.
        #[serde(default)]
        known: bool,
    },
    /// Boundaries, bare alone, of a state that the page may come to.
    Ahead {
        /// Number of η.
        points: usize,
    },
    /// The motion at the cursor.
    Motion {
        /// Where the start belongs, if the motion is carried from there: (η, ρ).
        #[serde(default)]
        carried_from: Option<(f64, f64)>,
    },
    /// The next stretch of the motion at the cursor.
    Run {
        /// Its length in drive periods.
        periods: f64,
        /// Whether the motion at its end is to be classified.
        #[serde(default)]
        facts: bool,
    },
    /// Characteristics along the line.
    Line {},
    /// Basins at the cursor.
    Basins {},
    /// The motions that starts at the cursor settle on, and their shares.
    Coexisting {},
    /// The motion that the cursor's start settles on, to be set into a picture.
    Inset {},
    /// The record beside its simulation.
    Record {},
    /// Residuals of the methods, and boundaries against brackets.
    Residuals {},
    /// Settings to measure next.
    Proposals {},
    /// The study that reproduces what is shown, as a file.
    Study {},
    /// The tables of that study, as files.
    Tables {},
    /// A demo that comes with the program.
    Demo {
        /// Its name.
        name: String,
    },
    /// A demo as text to be replayed.
    ReadDemo {
        /// The text.
        text: String,
    },
    /// The text of a recorded demo.
    WriteDemo {
        /// Its title.
        title: String,
        /// Its steps: seconds shown, and the state.
        steps: Vec<(f64, Value)>,
    },
}

impl Kind {
    /// Jobs of one of these kinds replace each other: the newest counts. All others wait in a queue.
    pub(super) const NEWEST: [Self; 10] = [
        Self::Map,
        Self::Boundaries,
        Self::Motion,
        Self::Line,
        Self::Basins,
        Self::Coexisting,
        Self::Record,
        Self::Residuals,
        Self::Proposals,
        Self::Tables,
    ];
}

impl Ask {
    /// Longest time that its simulations may take, which are given up in their middle then, or once nobody waits for
    /// them; `None` of what is not simulated on the job's own thread or on those of its page.
    pub(super) fn longest(&self) -> Option<Duration> {
        match self {
            Self::Motion { .. } | Self::Run { .. } | Self::Inset {} | Self::Record {} => {
                Some(LONGEST_MOTION)
            }
            Self::Map {}
            | Self::Boundaries { .. }
            | Self::Line {}
            | Self::Basins {}
            | Self::Coexisting {}
            | Self::Residuals {}
            | Self::Proposals {}
            | Self::Tables {} => Some(LONGEST_PICTURE),
            _ => None,
        }
    }

    /// The kind whose jobs it replaces: the next stretch of a motion counts as the motion.
    pub(super) fn slot(&self) -> Kind {
        match self.into() {
            Kind::Run => Kind::Motion,
            kind => kind,
        }
    }
}

/// Read a request; an error comes with the request's number as far as it can be read.
pub(super) fn read(text: &str) -> Result<Request, (u32, ExploreError)> {
    let malformed = |e: serde_json::Error| ExploreError::malformed("request", e);
    let value: Value = serde_json::from_str(text).map_err(|e| (0, malformed(e)))?;
    let id = value.get("id").and_then(Value::as_u64).unwrap_or(0);
    let id = u32::try_from(id).unwrap_or(0);
    let written: Written = serde_json::from_value(value).map_err(|e| (id, malformed(e)))?;
    let state = match written.state {
        None | Some(Value::Null) => Ok(State::default()),
        Some(state) => State::read(state),
    };
    Ok(Request {
        id: written.id,
        ask: written.ask,
        state: state.map_err(|e| (id, e))?,
    })
}
