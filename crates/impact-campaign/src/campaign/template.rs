//! The commented campaign.toml that `impactid init` writes.

use std::fmt::Write;

use super::diagnostic::first_of;
use super::infer::{self, Experiment, FolderContents, InferredChannel};
use super::keys::{Inferred, KeyRow, init_lines};
use super::run_table;
use super::sections::about::AboutTable;
use super::sections::analysis::AnalysisTable;
use super::sections::records::RecordsTable;
use super::sections::report::ReportTable;
use super::sections::rig::RigTable;
use impact_records::message::counted;
use impact_records::record::{ContactContent, Role};
use labfiles::timing::AxisUnit;
use labfiles::units::{self, Dimension};

/// The text of campaign.toml for what was found in a folder named so.
pub fn campaign_toml(name: &str, found: &FolderContents) -> String {
    let mut text = String::new();
    // writing to a String cannot fail
    let _ = head(&mut text, name, found)
        .and_then(|()| records(&mut text, found))
        .and_then(|()| section(&mut text, RIG, RigTable::KEYS))
        .and_then(|()| writeln!(text))
        .and_then(|()| channels(&mut text, found))
        .and_then(|()| section(&mut text, "[analysis]", AnalysisTable::KEYS))
        .and_then(|()| section(&mut text, "\n[report]", ReportTable::KEYS));
    text
}

/// A section whose lines are those of its keys, none of which is inferred.
fn section(text: &mut String, head: &str, keys: &[KeyRow]) -> std::fmt::Result {
    writeln!(text, "{head}")?;
    text.write_str(&init_lines(keys, &[]))
}

/// A text in TOML's quotes.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn has_role(found: &FolderContents, role: Role) -> bool {
    found.channels.iter().any(|c| c.role == Some(role))
}

/// Whether channels of two masses were found.
fn is_double(found: &FolderContents) -> bool {
    let two = [Role::VelocityY, Role::DisplacementY, Role::AccelerationY];
    two.iter().any(|r| has_role(found, *r))
}

fn head(text: &mut String, name: &str, found: &FolderContents) -> std::fmt::Result {
    let flight = match found.experiment {
        Experiment::FreeFlight(_) | Experiment::Events(_) => "constant_force",
        Experiment::Driven | Experiment::FreeDecay => "harmonic",
    };
    let machine = if is_double(found) { "double" } else { "single" };
    let name = quoted(name);
    let asked = found.asks_machine.then_some("see the note below");
    let inferred = [
        Inferred::known("name", &name),
        Inferred::known("machine", machine).asked_if(asked),
        Inferred::known("flight", flight),
    ];
    let lines = init_lines(AboutTable::KEYS, &inferred);
    writeln!(
        text,
        "# A campaign for impactid, inferred from {} ({}); check every line.\n\
         # Every quantity with a dimension is written with its unit in quotes: \"1.0 mm\".\n\
         # Then: impactid check campaign.toml; impactid run campaign.toml --out results\n\n\
         [campaign]\n{}",
        counted(found.files, "file"),
        found.format,
        lines
    )
}

fn records(text: &mut String, found: &FolderContents) -> std::fmt::Result {
    writeln!(text, "[records]")?;
    match (&found.run_table, found.globs.as_slice()) {
        (Some(table), _) => writeln!(text, "run_table = {}", quoted(table))?,
        (None, [one]) => writeln!(text, "files = {}", quoted(one))?,
        (None, many) => {
            let list: Vec<String> = many.iter().map(|g| quoted(g)).collect();
            writeln!(text, "files = [{}]", list.join(", "))?;
        }
    }
    if found.run_table.is_none() {
        text.write_str(RUN_TABLE)?;
    }
    if !found.others.is_empty() {
        writeln!(
            text,
            "# no records but notes or settings: {}",
            first_of(&found.others)
        )?;
    }
    for note in &found.notes {
        writeln!(text, "# {note}")?;
    }
    let listed = matches!(found.experiment, Experiment::Events(content) if content.is_list());
    if !found.timed && !listed {
        let sound = found.experiment == Experiment::Events(ContactContent::Sound);
        let (rate, why) = match (found.counts_frames, sound) {
            (true, _) => (
                "240 Hz",
                "the frames per second: the files number the frames",
            ),
            (_, true) => ("44.1 kHz", "that of the sound: the files state none"),
            _ => ("2 kHz", "the files state none"),
        };
        // a rate that nobody has stated must not count
        writeln!(text, "# sample_rate = \"{rate}\"     # FILL IN: {why}")?;
    }
    let attributes = attributes(found);
    let lacks = |key: &str| !attributes.iter().any(|(k, _)| *k == key);
    if found.run_table.is_none() && lacks("clearance") {
        writeln!(
            text,
            "# clearance = \"1.0 mm\"      # r, half the gap between two masses; the \
                        gap to a stop"
        )?;
    }
    if found.experiment == Experiment::FreeDecay {
        writeln!(
            text,
            "excitation = \"free_decay\"    # the records look like free decays after a release or a blow"
        )?;
    } else {
        text.write_str(&init_lines(RecordsTable::KEYS, &[]))?;
    }
    if !attributes.is_empty() && found.run_table.is_none() {
        writeln!(
            text,
            "\n# Attributes of the files that hold the setting, the unit in brackets"
        )?;
        writeln!(text, "[records.attributes]")?;
        for (key, value) in &attributes {
            writeln!(text, "{key} = {}", quoted(value))?;
        }
        if is_double(found) && attributes.iter().any(|(key, _)| *key == "clearance") {
            text.write_str(CLEARANCE)?;
        }
    }
    writeln!(text)
}

/// Which attributes may hold the setting, by the headings of a run table or parts of names; where the name bears no
/// unit, the usual one.
fn attributes(found: &FolderContents) -> Vec<(&'static str, String)> {
    /// Key, stems of attribute names, usual unit.
    const KEYS: [(&str, &[&str], &str); 4] = [
        ("clearance", &["clearance", "gap"], "mm"),
        ("drive_frequency", &["freq"], "Hz"),
        ("drive_amplitude", &["amplitude"], ""),
        ("sweep", &["sweep", "direction"], ""),
    ];
    // its FREQUENCY is that of the frames
    let motion_capture = found.attributes.contains_key("NO_OF_FRAMES");
    let driven = found.experiment == Experiment::Driven;
    let find = |key: &str, stems: &[&str]| {
        found.attributes.keys().find(|name| {
            let lower = name.to_lowercase();
            let sampling = motion_capture || lower.contains("sampl") || lower.contains("analog");
            let is_heading = run_table::column_name(last_field(name)) == Some(key);
            !sampling && (is_heading || stems.iter().any(|s| lower.contains(s)))
        })
    };
    let asked = KEYS
        .iter()
        .filter(|(key, ..)| driven || *key == "clearance");
    asked
        .filter_map(|(key, stems, usual)| Some((*key, with_unit(find(key, stems)?, usual))))
        .collect()
}

/// The name of a field without those of the structs that hold it.
fn last_field(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn with_unit(name: &str, usual: &str) -> String {
    let own = units::unit_of(None, name);
    match units::parse_unit(usual) {
        Some(unit) if own.is_none_or(|u| u.dimension != unit.dimension) => {
            format!("{name} [{usual}]")
        }
        _ => name.to_owned(),
    }
}

fn channels(text: &mut String, found: &FolderContents) -> std::fmt::Result {
    let values = match found.looked_at {
        0 | 1 => String::new(),
        count => format!(", with their values in {count} records looked at"),
    };
    writeln!(text, "# The channels of {}{values}:", found.example)?;
    for (index, channel) in found.channels.iter().enumerate() {
        writeln!(text, "#   {index:>2}  {}", describe(channel))?;
    }
    text.write_str(CHANNELS)?;
    let mut named = 0;
    for &role in Role::ALL {
        let Some(channel) = found.channels.iter().find(|c| c.role == Some(role)) else {
            continue;
        };
        table(text, role, channel, found)?;
        named += 1;
    }
    if named == 0 {
        writeln!(
            text,
            "# FILL IN: no channel could be assigned to a role\n# [channels.velocity_x]\n# channel = \"…\"\n"
        )?;
    }
    Ok(())
}

fn describe(channel: &InferredChannel) -> String {
    let unit = channel.unit.as_deref().unwrap_or("no unit");
    let time = if channel.is_time { ", the time" } else { "" };
    let range = match channel.range {
        Some([low, high]) => format!(", {low:.4} to {high:.4}"),
        None => ", no numbers".to_owned(),
    };
    let name = channel.name.replace(['\n', '\r'], " ");
    let plural = if channel.samples == 1 { "" } else { "s" };
    format!(
        "{name} ({unit}, {} sample{plural}{range}{time})",
        channel.samples
    )
}

/// The line of a channel's unit; the unit, if the file states one or the channel's name implies it.
fn unit_line(
    text: &mut String,
    role: Role,
    channel: &InferredChannel,
    found: &FolderContents,
) -> Result<Option<units::Unit>, std::fmt::Error> {
    let known = channel.unit.as_deref().and_then(units::parse_unit);
    let stated = units::unit_of(channel.unit.as_deref(), &channel.name);
    let implied = infer::implied_unit(channel).filter(|_| stated.is_none());
    let unit = stated.or_else(|| implied.and_then(units::parse_unit));
    let usual = implied.or_else(|| role.dimension().map(Dimension::si_symbol));
    match (known, stated.and_then(units::symbol_of), usual) {
        (Some(_), ..) => writeln!(text, "# unit = as the file states")?,
        (None, Some(symbol), _) => {
            writeln!(text, "unit = \"{symbol}\"                 # from its name")?;
        }
        (None, None, _) if found.experiment == Experiment::Events(ContactContent::Sound) => {}
        (None, None, _) if matches!(found.experiment, Experiment::Events(c) if c.is_of_heights()) =>
        {
            writeln!(
                text,
                "# unit = \"cm\"              # FILL IN: the file states none"
            )?;
        }
        (None, None, _) if channel.counted_in.is_some() => unit_of_times(text, channel)?,
        (None, None, _) if role == Role::Drive && channel.unit.is_some() => {
            let stated = channel.unit.as_deref().unwrap_or_default();
            writeln!(
                text,
                "unit = \"1\"                  # the file states {stated}: of a drive its frequency and phase count"
            )?;
        }
        (None, None, Some(usual))
            if implied.is_some() || found.experiment != Experiment::Driven =>
        {
            let usual = usual.replace('²', "2");
            let stated = channel.unit.as_deref().unwrap_or("none");
            writeln!(
                text,
                "unit = \"{usual}\"               # CHECK: the file states {stated}"
            )?;
        }
        (None, None, usual) => {
            let calibrated = usual.map_or(String::new(), |symbol| {
                format!("; \"{}\" if it is calibrated", symbol.replace('²', "2"))
            });
            writeln!(
                text,
                "# unit = \"V\"               # FILL IN: the file states none{calibrated}"
            )?;
        }
    }
    Ok(unit)
}

/// The line of the unit of times that the file does not state.
fn unit_of_times(text: &mut String, channel: &InferredChannel) -> std::fmt::Result {
    let (unit, why) = match &channel.counted_in {
        Some(AxisUnit::Stated(unit)) => (units::symbol_of(*unit), "# from its name"),
        Some(AxisUnit::Epoch(unit)) => (units::symbol_of(*unit), "# CHECK: counted since 1970"),
        Some(AxisUnit::Seconds) => (Some("s"), "# CHECK: the file states none"),
        _ => (None, ""),
    };
    match unit {
        Some(unit) => writeln!(text, "unit = {:<21}{why}", quoted(unit)),
        None => writeln!(
            text,
            "# unit = \"ms\"              # FILL IN: the file states none"
        ),
    }
}

fn table(
    text: &mut String,
    role: Role,
    channel: &InferredChannel,
    found: &FolderContents,
) -> std::fmt::Result {
    writeln!(text, "[channels.{}]", role.name())?;
    writeln!(text, "channel = {}", quoted(&channel.name))?;
    let unit = unit_line(text, role, channel, found)?;
    if let Experiment::Events(content) = found.experiment {
        return events(text, content, &found.then);
    }
    let guessed = unit.is_none() && found.experiment != Experiment::Driven;
    let volts = !guessed && unit.is_none_or(|u| u.dimension == Dimension::Voltage);
    match (role.dimension(), role) {
        (Some(_), _) if unit.is_some_and(|u| u.dimension == Dimension::Angle) => {
            writeln!(
                text,
                "scale = \"1 m per rad\"        # CHECK: the arm at which the mass touches"
            )?;
        }
        (Some(_), _) if unit.is_some_and(|u| u.dimension == Dimension::Frequency) => {
            writeln!(
                text,
                "scale = \"1 m/s per rad/s\"    # CHECK: the arm at which the mass touches"
            )?;
        }
        (Some(dimension), _) if volts => {
            let symbol = dimension.si_symbol().replace('²', "2");
            // f0 and β of decays do not depend on it
            match found.experiment {
                Experiment::FreeDecay => writeln!(
                    text,
                    "scale = \"1 {symbol} per V\"     # CHECK: what one volt corresponds to; f0 and β do not depend on it"
                )?,
                _ => writeln!(
                    text,
                    "# scale = \"0.05 {symbol} per V\"   # FILL IN: what one volt corresponds to"
                )?,
            }
        }
        (None, Role::Contact) => threshold(text, channel, unit)?,
        (None, role) if role.is_frame() && volts => writeln!(
            text,
            "# scale = \"0.05 m/s per V\"   # FILL IN: what one volt corresponds to"
        )?,
        _ => {}
    }
    if role.dimension().is_some() {
        writeln!(
            text,
            "sign = {:<21}# -1 if it is positive away from the other mass or the stop",
            channel.sign
        )?;
    }
    let integrated = [
        Role::VelocityX,
        Role::VelocityY,
        Role::DisplacementX,
        Role::DisplacementY,
    ];
    if integrated.contains(&role) {
        writeln!(
            text,
            "# high_pass = \"0.5 Hz\"       # corner of an integrator's high-pass"
        )?;
    }
    writeln!(text)
}

/// What the contact's channel contains.
fn events(text: &mut String, content: ContactContent, then: &[String]) -> std::fmt::Result {
    let (word, what) = match content {
        ContactContent::Signal => return writeln!(text),
        ContactContent::Times if !then.is_empty() => {
            ("times", "each row is a throw: the times of its impacts")
        }
        ContactContent::Intervals if !then.is_empty() => (
            "intervals",
            "each row is a throw: the times from an impact to the next",
        ),
        ContactContent::Times => (
            "times",
            "each row is the time of an impact, or of a change of the contact: those that close it count",
        ),
        ContactContent::Intervals => (
            "intervals",
            "each row is the time from an impact to the next",
        ),
        ContactContent::Sound => ("sound", "a microphone: the impacts are heard in it"),
        ContactContent::Heights if then.is_empty() => (
            "heights",
            "the height of the drop and of the tops after it, from where the mass touches the plate",
        ),
        ContactContent::Heights => (
            "heights",
            "each row is a drop: its height, and those after its impacts, from where the mass touches the plate",
        ),
        ContactContent::Rebounds => (
            "rebounds",
            "the height of the drop; each of then is one after an impact, from where the mass touches the plate",
        ),
    };
    writeln!(text, "content = \"{word}\"          # {what}")?;
    if !then.is_empty() {
        let names: Vec<String> = then.iter().map(|name| quoted(name)).collect();
        writeln!(text, "then = [{}]", names.join(", "))?;
    }
    if content.is_of_heights() {
        writeln!(
            text,
            "# height_uncertainty = \"2 mm\" # of each height; their scatter tells it if not given"
        )?;
    }
    writeln!(text)
}

fn threshold(
    text: &mut String,
    channel: &InferredChannel,
    unit: Option<units::Unit>,
) -> std::fmt::Result {
    let symbol = unit.and_then(units::symbol_of).unwrap_or("V");
    match (channel.closes_at, channel.levels) {
        (Some(level), _) => writeln!(
            text,
            "threshold = \"{level:.3} {symbol}\"       # CHECK: where the mass lifts off, above the noise"
        ),
        (None, Some([low, high])) => {
            let level = 0.5 * (low + high);
            writeln!(
                text,
                "threshold = \"{level:.4} {symbol}\"      # midway between its two levels"
            )
        }
        (None, None) => writeln!(
            text,
            "# threshold = \"2.5 {symbol}\"   # level between open and closed"
        ),
    }
}

const RUN_TABLE: &str = "\
# run_table = \"runs.csv\"      # instead of files: one row per record, with the columns file, dataset,
#                             # drive_frequency_hz, clearance_mm, sweep (up, down), drive_amplitude
";

const RIG: &str = "\
# Nominal values of the rig, all optional: where the fit starts
[rig]";

const CLEARANCE: &str = "\
#                              # r is half the gap between two masses; of whole gaps state whole_gaps = true in [records]
";

const CHANNELS: &str = "\
# One table per role: drive, contact, velocity_x, velocity_y, displacement_x, displacement_y,
# acceleration_x, acceleration_y, frame_x, frame_y. x and y are positive toward the other mass.
";
