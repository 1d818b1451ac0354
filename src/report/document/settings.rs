//! The resolved settings as they are printed: one line a setting, in columns.

use serde_json::Value;

use super::model::Block;

/// From how many lines on the settings stand in columns.
const MANY_LINES: usize = 24;

/// The block of settings. JSON becomes one line a value, `channels[2].unit = "V"`, without what is
/// not set; other text stays as it is.
pub fn settings(text: &str) -> Block {
    let text = match serde_json::from_str::<Value>(text) {
        Ok(value) => {
            let mut lines = Vec::new();
            flatten("", &value, &mut lines);
            lines.join("\n")
        }
        Err(_) => text.to_owned(),
    };
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

fn flatten(path: &str, value: &Value, lines: &mut Vec<String>) {
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            for (name, field) in fields {
                let dot = if path.is_empty() { "" } else { "." };
                flatten(&format!("{path}{dot}{name}"), field, lines);
            }
        }
        Value::Array(items) if items.iter().any(|i| i.is_object() || i.is_array()) => {
            for (i, item) in items.iter().enumerate() {
                flatten(&format!("{path}[{i}]"), item, lines);
            }
        }
        Value::Array(items) if items.is_empty() => {}
        plain => lines.push(format!("{path} = {plain}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_json_settings_become_lines() {
        let block = settings(r#"{"rig": {"f": 12.6, "r": null}, "channels": [{"unit": "V"}]}"#);
        let expected = "rig.f = 12.6\nchannels[0].unit = \"V\"";
        assert_eq!(
            block,
            Block::Verbatim {
                text: expected.into(),
                columns: 1
            }
        );
        let plain = settings("[rig]\nf = 12.6");
        assert_eq!(
            plain,
            Block::Verbatim {
                text: "[rig]\nf = 12.6".into(),
                columns: 1
            }
        );
    }
}
