//! Short texts with symbols: between dollars letters are slanted, `_` lowers and `^` raises
//! what follows, as in `$f$/$f_0$ (1)` or `$x_st$`.

use super::fonts::{self, Face};

/// Level of a run relative to the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Level {
    /// On the baseline.
    Base,
    /// Lowered.
    Sub,
    /// Raised.
    Super,
}

/// A run of text in one face at one level.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub(crate) struct Run {
    /// The characters.
    pub text: String,
    /// Whether it is slanted.
    pub italic: bool,
    /// Its level.
    pub level: Level,
}

/// Size of what is lowered or raised, over that of its text.
const SCRIPT_SIZE: f64 = 0.72;

/// Splits a marked-up text into runs.
pub(crate) fn parse(markup: &str) -> Vec<Run> {
    let mut runs = Vec::new();
    for (i, part) in markup.split('$').enumerate() {
        if i % 2 == 0 {
            push(&mut runs, part.to_owned(), false, Level::Base);
        } else {
            parse_symbols(part, &mut runs);
        }
    }
    runs
}

fn parse_symbols(part: &str, runs: &mut Vec<Run>) {
    let mut chars = part.chars().peekable();
    while let Some(c) = chars.next() {
        let level = match c {
            '_' => Level::Sub,
            '^' => Level::Super,
            c => {
                push(runs, c.to_string(), c.is_alphabetic(), Level::Base);
                continue;
            }
        };
        let index: String = if chars.next_if_eq(&'{').is_some() {
            chars.by_ref().take_while(|&c| c != '}').collect()
        } else {
            std::iter::from_fn(|| chars.next_if(|c| c.is_alphanumeric())).collect()
        };
        push(runs, index, false, level);
    }
}

fn push(runs: &mut Vec<Run>, text: String, italic: bool, level: Level) {
    if text.is_empty() {
        return;
    }
    match runs.last_mut() {
        Some(last) if last.italic == italic && last.level == level => last.text.push_str(&text),
        _ => runs.push(Run {
            text,
            italic,
            level,
        }),
    }
}

impl Run {
    /// Face of the run inside a text of the given face.
    pub(crate) fn face(&self, around: Face) -> Face {
        if self.italic && around != Face::Bold {
            Face::Italic
        } else {
            around
        }
    }

    /// Size of the run inside a text of the given size.
    pub(crate) fn size(&self, around: f64) -> f64 {
        if self.level == Level::Base {
            around
        } else {
            around * SCRIPT_SIZE
        }
    }

    /// How far its baseline is below the text's.
    pub(crate) fn shift(&self, around: f64) -> f64 {
        match self.level {
            Level::Base => 0.0,
            Level::Sub => 0.18 * around,
            Level::Super => -0.34 * around,
        }
    }
}

/// Width of a marked-up text.
pub(crate) fn width(markup: &str, face: Face, size: f64) -> f64 {
    parse(markup)
        .iter()
        .map(|r| fonts::width(&r.text, r.face(face), r.size(size)))
        .sum()
}

/// The text without its markup.
pub(crate) fn plain(markup: &str) -> String {
    parse(markup).into_iter().map(|r| r.text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_are_slanted_and_indices_lowered() {
        let runs = parse("$f_0$ (Hz), $x_{st}$");
        let seen: Vec<_> = runs
            .iter()
            .map(|r| (r.text.as_str(), r.italic, r.level))
            .collect();
        assert_eq!(
            seen,
            [
                ("f", true, Level::Base),
                ("0", false, Level::Sub),
                (" (Hz), ", false, Level::Base),
                ("x", true, Level::Base),
                ("st", false, Level::Sub)
            ]
        );
        assert_eq!(plain("$f_0$ (Hz)"), "f0 (Hz)");
    }

    #[test]
    fn greek_has_the_font_s_own_width() {
        let eta = width("$η$", Face::Regular, 10.0);
        assert!(eta > 3.0 && eta < 7.0, "{eta}");
        let twice = width("$ηη$", Face::Regular, 10.0);
        assert!((twice - 2.0 * eta).abs() < 1e-9);
    }
}
