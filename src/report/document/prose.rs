//! Words of other rooms as they should be printed: their symbols set as symbols.

use super::model::Rich;

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
}
