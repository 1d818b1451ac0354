//! Words of other rooms as they should be printed: as sentences, their symbols set as symbols.

use super::model::Rich;
use crate::report::parameters::method_name;
use crate::report::speech::Speech;

/// Symbols as other rooms write them, and their markup.
const SYMBOLS: [(&str, &str); 13] = [
    ("R", "$R$"),
    ("f", "$f$"),
    ("f0", "$f_0$"),
    ("f_0", "$f_0$"),
    ("x_st", "$x_st$"),
    ("s1", "$s_1$"),
    ("s2", "$s_2$"),
    ("z", "$z$"),
    ("r", "$r$"),
    ("β", "$β$"),
    ("η", "$η$"),
    ("ρ", "$ρ$"),
    ("ρ'", "$ρ$′"),
];

/// A text with its symbols slanted. Text that carries markup already keeps it.
pub fn prose(text: &str) -> Rich {
    if text.contains('$') {
        return Rich::from(text);
    }
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    let mut marked = String::with_capacity(text.len() + 16);
    let mut word = String::new();
    for c in text.chars().chain(std::iter::once('\0')) {
        if is_word(c) {
            word.push(c);
            continue;
        }
        let symbol = SYMBOLS.iter().find(|(name, _)| *name == word);
        marked.push_str(symbol.map_or(word.as_str(), |(_, markup)| markup));
        word.clear();
        if c != '\0' {
            marked.push(c);
        }
    }
    Rich::from(marked)
}

/// A finding as a sentence in the reader's words, with the method that it begins with by its name.
pub fn spoken(finding: &str, speech: Speech) -> String {
    /// Methods as a finding names them at its start.
    const KEYS: [&str; 5] = [
        "boundaries",
        "trajectories",
        "impacts",
        "resonance",
        "free_decay",
    ];
    match finding.split_once(": ") {
        Some((key, rest)) if KEYS.contains(&key) => {
            let method = speech.say(&method_name(key));
            sentence(&format!("{method}: {}", speech.tell(rest)))
        }
        _ => {
            let told = speech.tell(finding);
            match told.split_once(": ") {
                Some((name, rest)) => format!("{name}: {}", sentence(rest)),
                None => sentence(&told),
            }
        }
    }
}

/// A remark as a sentence: a capital at its start, a full stop at its end.
pub fn sentence(remark: &str) -> String {
    let remark = remark.trim();
    let mut chars = remark.chars();
    // A symbol or a record's name keeps its small letter.
    let word = remark.split_whitespace().next().unwrap_or("");
    let plain = word.chars().count() > 1 && word.chars().all(char::is_lowercase);
    let start = match chars.next() {
        Some(first) if plain => first.to_uppercase().chain(chars).collect(),
        _ => remark.to_owned(),
    };
    if start.ends_with(['.', '!', '?']) || start.is_empty() {
        start
    } else {
        format!("{start}.")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_symbols_in_words_are_set_as_symbols() {
        let rich = prose("R = 0.9, x_st = 1 mm; for Rosa's rig, f0 (Hz)");
        let slanted: Vec<&str> = rich
            .0
            .iter()
            .filter(|r| r.italic)
            .map(|r| r.text.as_str())
            .collect();
        assert_eq!(slanted, ["R", "x", "f"]);
        assert_eq!(rich.plain(), "R = 0.9, xst = 1 mm; for Rosa's rig, f0 (Hz)");
    }

    #[test]
    fn valid_remarks_become_sentences() {
        assert_eq!(sentence("the responses follow"), "The responses follow.");
        assert_eq!(sentence("x is clipped."), "x is clipped.");
        assert_eq!(sentence("r0012 was left out"), "r0012 was left out.");
        assert_eq!(sentence(""), "");
        assert_eq!(
            spoken("free_decay: the fit is poor", Speech::default()),
            "Free decay: the fit is poor."
        );
        let odd = spoken("massa4: it is odd", Speech::default());
        assert_eq!(odd, "massa4: It is odd.");
    }
}
