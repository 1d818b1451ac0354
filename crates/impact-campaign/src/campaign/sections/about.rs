//! `[campaign]`: what was measured.

use std::path::Path;

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::values::{Flight, Machine, Placed, value};

keys! {
    /// `[campaign]`.
    #[serde(default)]
    pub struct AboutTable {
        /// name on the first page
        name: Placed<String>, default "the folder's name";
        /// `"double"`: two masses; `"single"`: one mass against a stop
        machine: Placed<Machine>, default "required";
        /// `true` if the records are simulated: the report states so on its first page
        synthetic: bool, default "`false`";
        /// who measured, and where
        laboratory: Placed<String>, default "none";
        /// when it was measured, as text
        measured: Placed<String>, default "the days of the first and the last record, if their files state them";
        /// `"harmonic"`: springs and a harmonic drive; `"constant_force"`: no spring; masses that roll, slide or
        /// fall freely between impacts, each with its own constant acceleration (a ball, a cart on a slope, two
        /// carts)
        flight: Placed<Flight>, default "`\"harmonic\"`";
    }
}

/// Two masses or one, which must be stated.
pub(crate) fn machine(placed: &Placed<Machine>, context: &mut ResolveContext<'_>) -> Machine {
    if placed.is_none() && !context.faults.blocks() {
        let (key, what) = ("campaign.machine", "it is not given");
        let remedy = "write machine = \"double\" (two masses) or \"single\" (one, and a stop)";
        context.faults.fault(Code::Missing, None, key, what, remedy);
    }
    value(placed).unwrap_or(Machine::Double)
}

/// The campaign's name: that of its folder where none is stated.
pub(crate) fn name(placed: &Placed<String>, folder: &Path) -> String {
    let folder_name = || {
        let whole = std::path::absolute(Path::new(".").join(folder)).ok()?;
        whole.file_name().map(|n| n.to_string_lossy().into_owned())
    };
    value(placed)
        .or_else(folder_name)
        .unwrap_or_else(|| "campaign".to_owned())
}
