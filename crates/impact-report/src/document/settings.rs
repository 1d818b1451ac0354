//! The resolved settings as they are printed: one line a setting, in columns.

use serde_json::Value;

use super::model::Block;
use labfiles::units::Dimension;

/// More lines of settings than these are set in columns.
const MANY_LINES: usize = 12;

/// Defaults of a channel: not worth a line.
const DEFAULTS: [&str; 4] = [
    "offset = 0.0",
    "sign = 1.0",
    "scale.factor = 1.0",
    "ignore_file_unit = false",
];

/// The block of settings: one line per value, `channels.drive.range = 5.0`, without what is not set or
/// a default.
pub(super) fn settings(settings: &Value) -> Block {
    let mut lines = Vec::new();
    flatten("", &rounded(settings), &mut lines);
    let text = lines.join("\n");
    let many = text.lines().count() > MANY_LINES;
    let longest = text.lines().map(|l| l.chars().count()).max().unwrap_or(0);
    let columns = match longest {
        _ if !many => 1,
        0..=46 => 3,
        47..=76 => 2,
        _ => 1,
    };
    Block::Verbatim { text, columns }
}

/// The same with its numbers to fifteen digits: a factor of a unit leaves 9.999999999999999e-6 of 10 µm.
fn rounded(value: &Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let digits = number.as_f64().map(|n| format!("{n:.14e}"));
            let number = digits.and_then(|digits| digits.parse::<f64>().ok());
            number.map_or(Value::Null, Value::from)
        }
        Value::Array(items) => items.iter().map(rounded).collect(),
        Value::Object(fields) => {
            let fields = fields.iter();
            fields
                .map(|(key, field)| (key.clone(), rounded(field)))
                .collect()
        }
        other => other.clone(),
    }
}

fn flatten(path: &str, value: &Value, lines: &mut Vec<String>) {
    if let Some(words) = quantity(value)
        .or_else(|| ratio(value))
        .or_else(|| name(value))
    {
        lines.push(format!("{path} = {words}"));
        return;
    }
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            for (name, field) in fields.iter().filter(|(name, _)| *name != "role") {
                let dot = if path.is_empty() { "" } else { "." };
                flatten(&format!("{path}{dot}{name}"), field, lines);
            }
        }
        Value::Array(items) if items.iter().any(|i| i.is_object() || i.is_array()) => {
            for (i, item) in items.iter().enumerate() {
                flatten(&format!("{path}{}", key(i, item)), item, lines);
            }
        }
        Value::Array(items) if items.is_empty() => {}
        plain => {
            let line = format!("{path} = {plain}");
            if !DEFAULTS.iter().any(|d| line.ends_with(d)) {
                lines.push(line);
            }
        }
    }
}

/// An item's place in its list: a channel goes by its role.
fn key(index: usize, item: &Value) -> String {
    match item.get("role").and_then(Value::as_str) {
        Some(role) => format!(".{role}"),
        None => format!("[{index}]"),
    }
}

fn symbol(of: &Value) -> Option<&'static str> {
    let dimension = serde_json::from_value::<Dimension>(of.get("dimension")?.clone());
    Some(dimension.ok()?.si_symbol())
}

/// A value with its dimension as number and unit.
fn quantity(value: &Value) -> Option<String> {
    let fields = value.as_object().filter(|f| f.len() == 2)?;
    Some(format!("{} {}", fields.get("si")?, symbol(value)?))
}

/// A sensor's ratio as it is spoken.
fn ratio(value: &Value) -> Option<String> {
    let ratio = value.get("ratio")?;
    let denominator = ratio.get("denominator")?;
    let count = denominator.get("to_si").and_then(Value::as_f64)?;
    let count = if count == 1.0 {
        String::new()
    } else {
        format!("{count} ")
    };
    let above = quantity(ratio.get("numerator")?)?;
    Some(format!("{above} per {count}{}", symbol(denominator)?))
}

/// The channel of a file by its name.
fn name(value: &Value) -> Option<String> {
    let fields = value.as_object().filter(|f| f.len() == 1)?;
    fields
        .get("name")
        .filter(|n| n.is_string())
        .map(Value::to_string)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn numbers_have_the_digits_that_were_stated() {
        let block = settings(&json!({"gap_m": 10.0 * 1e-6 * 0.999_999_999_999_999_9, "n": 3}));
        let expected = "gap_m = 0.00001\nn = 3";
        assert_eq!(
            block,
            Block::Verbatim {
                text: expected.into(),
                columns: 1
            }
        );
        let block = settings(&json!({"f": 0.1 + 0.2}));
        assert!(matches!(block, Block::Verbatim { text, .. } if text == "f = 0.3"));
    }

    #[test]
    fn json_settings_become_lines() {
        let block = settings(&json!({"rig": {"f": 12.6, "r": null}, "channels": [{"unit": "V"}]}));
        let expected = "rig.f = 12.6\nchannels[0].unit = \"V\"";
        assert_eq!(
            block,
            Block::Verbatim {
                text: expected.into(),
                columns: 1
            }
        );
        let block = settings(
            &json!({"channels": [{"role": "velocity_x", "source": {"name": "laser"}, "sign": 1.0,
            "scale": {"ratio": {"numerator": {"si": 0.2, "dimension": "velocity"},
            "denominator": {"dimension": "voltage", "to_si": 1.0}}}}]}),
        );
        let Block::Verbatim { text, .. } = block else {
            panic!("not verbatim");
        };
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines,
            [
                "channels.velocity_x.source = \"laser\"",
                "channels.velocity_x.scale = 0.2 m/s per V"
            ]
        );
    }
}
