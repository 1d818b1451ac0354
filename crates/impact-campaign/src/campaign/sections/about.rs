//! `[campaign]`: what was measured.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::values::{Flight, Machine, Placed, value};
use impact_report::Phrase;

keys! {
    /// `[campaign]`.
    #[serde(default)]
    pub struct AboutTable {
        /// name on the first page
        name: Placed<String>, default "the folder's name", init "name = {}";
        /// `"double"`: two masses; `"single"`: one mass against a stop
        machine: Placed<Machine>, default "required",
            init r#"machine = "{}"            # "double": two masses; "single": one mass against a stop"#;
        /// `true` if the records are simulated: the report states so on its first page
        synthetic: bool, default "`false`";
        /// who measured, and where
        laboratory: Placed<String>, default "none";
        /// when it was measured, as text
        measured: Placed<String>, default "the days of the first and the last record, if their files state them";
        /// `"harmonic"`: springs and a harmonic drive; `"constant_force"`: no spring; masses that roll, slide or
        /// fall freely between impacts, each with its own constant acceleration (a ball, a cart on a slope, two
        /// carts)
        flight: Placed<Flight>, default "`\"harmonic\"`",
            init r#"flight = "{}"           # "harmonic": springs and a drive; "constant_force": free flights, as of balls and carts"#;
    }
}

/// What the campaign is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Name on the report's first page.
    pub name: String,
    /// Two masses, or one against a stop.
    pub machine: Machine,
    /// What acts between impacts.
    pub flight: Flight,
    /// Whether its records are simulated.
    #[serde(default)]
    pub synthetic: bool,
    /// Who measured, and where.
    #[serde(default)]
    pub laboratory: Option<String>,
    /// When it was measured, in words.
    #[serde(default)]
    pub measured: Option<String>,
}

impl About {
    /// What of it observations depend on, or may depend on: all but what the report alone states.
    pub(crate) fn observed(&self) -> Self {
        Self {
            name: String::new(),
            synthetic: false,
            laboratory: None,
            measured: None,
            ..self.clone()
        }
    }

    /// What the first page states in the words of campaign.toml.
    pub(crate) fn stated(&self) -> Vec<(Phrase, String)> {
        let rows = [(Phrase::Laboratory, &self.laboratory)];
        let rows = rows.into_iter();
        rows.filter_map(|(label, words)| Some((label, words.clone()?)))
            .collect()
    }
}

/// What the campaign is, defaults included.
pub(crate) fn resolve(
    table: &AboutTable,
    folder: &Path,
    context: &mut ResolveContext<'_>,
) -> About {
    About {
        name: name(&table.name, folder),
        machine: machine(&table.machine, context),
        flight: value(&table.flight).unwrap_or(Flight::Harmonic),
        synthetic: table.synthetic,
        laboratory: value(&table.laboratory),
        measured: value(&table.measured),
    }
}

/// Two masses or one, which must be stated.
fn machine(placed: &Placed<Machine>, context: &mut ResolveContext<'_>) -> Machine {
    if placed.is_none() && !context.faults.blocks() {
        let (key, what) = ("campaign.machine", "it is not given");
        let remedy = "write machine = \"double\" (two masses) or \"single\" (one, and a stop)";
        context.faults.fault(Code::Missing, None, key, what, remedy);
    }
    value(placed).unwrap_or(Machine::Double)
}

/// The campaign's name: that of its folder where none is stated.
fn name(placed: &Placed<String>, folder: &Path) -> String {
    let folder_name = || {
        let whole = std::path::absolute(Path::new(".").join(folder)).ok()?;
        whole.file_name().map(|n| n.to_string_lossy().into_owned())
    };
    value(placed)
        .or_else(folder_name)
        .unwrap_or_else(|| "campaign".to_owned())
}
