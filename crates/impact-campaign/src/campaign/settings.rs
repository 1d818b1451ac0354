//! The setting of each record, joined from run table, attributes and defaults.

use super::context::ResolveContext;
use super::diagnostic::{Code, Diagnostic, Place, Severity};
use super::discovery::Discovered;
use super::resolved::RecordEntry;
use super::run_table::{in_english, states_whole_gaps};
use super::sections::records::RecordsTable;
use super::values::{Placed, value};
use impact_records::record::{Setting, Sweep};
use labfiles::units::{self, Dimension};

/// Attributes to look for: full name, name without unit, factor to SI.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    clearance: Option<Attribute>,
    frequency: Option<Attribute>,
    amplitude: Option<Attribute>,
    sweep: Option<String>,
    specimen: Option<String>,
    whole_gaps: bool,
}

#[derive(Debug)]
struct Attribute {
    name: String,
    bare: String,
    to_si: f64,
}

impl Attribute {
    fn text<'a>(&self, of: &'a Discovered) -> Option<&'a String> {
        of.attributes
            .get(&self.name)
            .or_else(|| of.attributes.get(&self.bare))
    }
}

impl Wanted {
    pub(super) fn of(records: &RecordsTable, context: &mut ResolveContext<'_>) -> Self {
        let written = &records.attributes;
        Self {
            whole_gaps: records.whole_gaps,
            clearance: attribute(&written.clearance, "clearance", Dimension::Length, context),
            frequency: attribute(
                &written.drive_frequency,
                "drive_frequency",
                Dimension::Frequency,
                context,
            ),
            amplitude: attribute(
                &written.drive_amplitude,
                "drive_amplitude",
                Dimension::Number,
                context,
            ),
            sweep: value(&written.sweep),
            specimen: value(&written.specimen),
        }
    }
}

fn attribute(
    placed: &Placed<String>,
    key: &str,
    dimension: Dimension,
    context: &mut ResolveContext<'_>,
) -> Option<Attribute> {
    let placed = placed.as_ref()?;
    let name = placed.get_ref();
    let (bare, symbol) = units::split_unit(name);
    let unit = symbol.and_then(units::parse_split_unit);
    let to_si = match unit {
        Some(unit) if unit.dimension == dimension => unit.to_si,
        None if dimension == Dimension::Number => 1.0,
        _ => {
            let what = format!(
                "an attribute '{name}' for a {} without unit",
                key.replace('_', " ")
            );
            let remedy = format!(
                "write the unit after it in brackets, such as \"{bare} [{}]\"",
                units::symbols_of(dimension).first().unwrap_or(&"1")
            );
            context.fault(
                Code::InvalidValue,
                placed,
                &format!("records.attributes.{key}"),
                what,
                &remedy,
            );
            return None;
        }
    };
    Some(Attribute {
        name: name.clone(),
        bare: bare.to_owned(),
        to_si,
    })
}

pub(super) fn setting(
    one: &Discovered,
    wanted: &Wanted,
    default: &Setting,
    context: &mut ResolveContext<'_>,
) -> Setting {
    let row = one.row.as_ref();
    let mut number = |attribute: &Option<Attribute>| {
        let attribute = attribute.as_ref()?;
        attribute_number(one, attribute, context)
    };
    let frequency = number(&wanted.frequency);
    let clearance = number(&wanted.clearance);
    let amplitude = number(&wanted.amplitude);
    let sweep = wanted
        .sweep
        .as_ref()
        .and_then(|name| attribute_sweep(one, name, context));
    let specimen = wanted
        .specimen
        .as_ref()
        .and_then(|name| one.attributes.get(name).cloned());
    let stated_m = row
        .and_then(|r| r.clearance_m)
        .or(clearance)
        .or(default.clearance_m);
    let of_row = row.filter(|r| r.clearance_m.is_some());
    let by_heading = match of_row {
        Some(row) => row.whole_gap,
        None => wanted
            .clearance
            .as_ref()
            .is_some_and(|a| states_whole_gaps(&a.name)),
    };
    let whole = wanted.whole_gaps || by_heading;
    let share = if whole { 0.5 } else { 1.0 };
    Setting {
        stated_frequency_hz: row
            .and_then(|r| r.drive_frequency_hz)
            .or(frequency)
            .or(default.stated_frequency_hz),
        clearance_m: stated_m.map(|m| share * m),
        sweep: row.and_then(|r| r.sweep).or(sweep).unwrap_or(default.sweep),
        drive_amplitude: row
            .and_then(|r| r.drive_amplitude)
            .or(amplitude)
            .unwrap_or(default.drive_amplitude),
        sequence: 0,
        excitation: row.and_then(|r| r.excitation).unwrap_or(default.excitation),
        specimen: row.and_then(|r| r.specimen.clone()).or(specimen),
        turned: Vec::new(),
    }
}

fn attribute_number(
    one: &Discovered,
    wanted: &Attribute,
    context: &mut ResolveContext<'_>,
) -> Option<f64> {
    one.dataset?;
    let name = &wanted.name;
    let text = wanted.text(one);
    let number = text.and_then(|text| text.trim().parse::<f64>().ok());
    let number = number.filter(|number| number.is_finite());
    if number.is_none() {
        let what = match text {
            Some(text) => format!("its attribute '{name}' is '{text}', not a number"),
            None => format!("it has no attribute '{name}'"),
        };
        context.faults.extend([attribute_fault(one, name, what)]);
    }
    number.map(|number| number * wanted.to_si)
}

fn attribute_sweep(
    one: &Discovered,
    name: &str,
    context: &mut ResolveContext<'_>,
) -> Option<Sweep> {
    let text = one.attributes.get(name)?;
    let found = in_english(text).parse().ok();
    if found.is_none() {
        let what = format!("its attribute '{name}' is '{text}', not up, down or unknown");
        context.faults.extend([attribute_fault(one, name, what)]);
    }
    found
}

fn attribute_fault(one: &Discovered, name: &str, message: String) -> Diagnostic {
    Diagnostic::new(
        (Code::Attribute, Severity::Record),
        Place::of_record(&one.file, &one.id, name),
        message,
        "fix [records.attributes], or write a run table",
    )
}

/// Settings that are impossible.
pub(super) fn note_settings(entries: &[RecordEntry], context: &mut ResolveContext<'_>) {
    for entry in entries {
        let setting = &entry.setting;
        let mut note = |severity, item: &str, message: String, remedy: &str| {
            let place = Place::of_record(&entry.file, &entry.id, item);
            let what = (Code::OutOfRange, severity);
            context
                .faults
                .extend([Diagnostic::new(what, place, message, remedy)]);
        };
        if let Some(c) = setting.clearance_m.filter(|c| c.abs() > 1.0) {
            // what is left of the conversion to metres is not printed
            let message = format!("a clearance of {} m", (1e9 * c).round() / 1e9);
            note(
                Severity::Record,
                "clearance",
                message,
                "check its unit: mm?",
            );
        }
        if let Some(c) = setting.clearance_m.filter(|c| *c <= 0.0) {
            let message = format!("a clearance of {c} m: a preload, or a typing error");
            let remedy = "nothing, if the rig was preloaded like this";
            note(Severity::Note, "clearance", message, remedy);
        }
        if let Some(f) = setting.stated_frequency_hz.filter(|f| *f <= 0.0) {
            let message = format!("a drive frequency of {f} Hz");
            note(
                Severity::Record,
                "drive_frequency",
                message,
                "fix the run table",
            );
        }
        if setting.drive_amplitude <= 0.0 {
            let message = format!("a drive amplitude of {}", setting.drive_amplitude);
            let remedy = "write it relative to the nominal one: 1";
            note(Severity::Record, "drive_amplitude", message, remedy);
        }
    }
}
