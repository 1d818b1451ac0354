//! Sentences that other rooms say, recognised by their templates: the rooms write plain English
//! into identification.json, and the report says it again in the reader's words.

use std::collections::BTreeMap;

use super::parts_of;

/// From the template of each English sentence to that of the reader's. Neither has a full stop.
pub(super) type Sentences = BTreeMap<String, String>;

/// What parts one sentence from the next.
const FULL_STOP: &str = ". ";
/// Where a sentence may be parted.
const SEPARATORS: [&str; 2] = ["; ", ": "];
/// Parts of a sentence that one template may take together.
const MOST_PARTS: usize = 6;

/// A text in the reader's words, sentence by sentence; what no template knows stays.
pub(super) fn tell(sentences: &Sentences, text: &str) -> String {
    // one without words of its own would fit everything
    let templates = sentences.iter().map(Template::new);
    let templates: Vec<Template> = templates.filter(|t| t.letters > 0).collect();
    let told = text.split(FULL_STOP).map(|sentence| {
        let (bare, stop) = match sentence.strip_suffix('.') {
            Some(bare) => (bare, "."),
            None => (sentence, ""),
        };
        parted(&templates, bare).text + stop
    });
    told.collect::<Vec<_>>().join(FULL_STOP)
}

/// A text said again, and how many letters of it the templates knew.
#[derive(Debug, Clone, Default)]
struct Told {
    text: String,
    known: usize,
}

/// A text said again in the parts of which the templates know most.
fn parted(templates: &[Template], text: &str) -> Told {
    let marks = SEPARATORS.iter().flat_map(|s| text.match_indices(s));
    let mut marks: Vec<(usize, &str)> = marks.chain([(text.len(), "")]).collect();
    marks.sort_unstable();
    let starts: Vec<usize> = std::iter::once(0)
        .chain(marks.iter().map(|(at, separator)| at + separator.len()))
        .collect();
    // the best from each start on, the last first
    let mut best = vec![Told::default(); starts.len()];
    for from in (0..marks.len()).rev() {
        let mut chosen: Option<Told> = None;
        for (to, (end, separator)) in marks.iter().enumerate().skip(from).take(MOST_PARTS) {
            let part = &text[starts[from]..*end];
            let as_it_is = (to == from).then(|| Told {
                text: part.to_owned(),
                known: 0,
            });
            let Some(told) = whole(templates, part).or(as_it_is) else {
                continue;
            };
            let known = told.known + best[to + 1].known;
            if chosen.as_ref().is_none_or(|c| known > c.known) {
                let text = told.text + separator + &best[to + 1].text;
                chosen = Some(Told { text, known });
            }
        }
        best[from] = chosen.unwrap_or_default();
    }
    best.swap_remove(0)
}

/// The whole text by the template that knows most of it.
fn whole(templates: &[Template], text: &str) -> Option<Told> {
    let told = templates.iter().filter_map(|template| {
        let values = values(&template.parts, text)?;
        let values = values.into_iter();
        let values: Vec<(&str, Told)> = values
            .map(|(name, value)| (name, parted(templates, value)))
            .collect();
        let known = template.letters + values.iter().map(|v| v.1.known).sum::<usize>();
        Some(template.say(&values, known))
    });
    told.max_by_key(|t| t.known)
}

/// A sentence with places for what changes in it, and its translation.
struct Template<'a> {
    parts: Vec<Part<'a>>,
    translation: Vec<Part<'a>>,
    /// How many letters it has of its own.
    letters: usize,
}

impl<'a> Template<'a> {
    fn new((sentence, translation): (&'a String, &'a String)) -> Self {
        let parts = parts_of(sentence);
        let letters = parts.iter().map(|part| match part {
            Part::Words(words) => words.len(),
            Part::Place(_) => 0,
        });
        Self {
            letters: letters.sum(),
            translation: parts_of(translation),
            parts,
        }
    }

    fn say(&self, values: &[(&str, Told)], known: usize) -> Told {
        let said = self.translation.iter().map(|part| match part {
            Part::Words(words) => words,
            Part::Place(name) => {
                let value = values.iter().find(|v| v.0 == *name);
                value.map_or("", |v| v.1.text.as_str())
            }
        });
        let text = said.collect();
        Told { text, known }
    }
}

/// A part of a template.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part<'a> {
    /// Words that stand as they are.
    Words(&'a str),
    /// The place of a value, by its name.
    Place(&'a str),
}

/// The values in a text that follows a template, by their names; `None` where it does not.
fn values<'a, 't>(parts: &[Part<'a>], text: &'t str) -> Option<Vec<(&'a str, &'t str)>> {
    let mut values = Vec::new();
    let mut left = text;
    let mut open: Option<&str> = None;
    for (i, part) in parts.iter().enumerate() {
        match (part, open.take()) {
            (Part::Place(name), None) => open = Some(name),
            // nothing tells where the one ends and the next begins
            (Part::Place(_), Some(_)) => return None,
            (Part::Words(words), None) => left = left.strip_prefix(words)?,
            (Part::Words(words), Some(name)) => {
                let last = i + 1 == parts.len();
                let at = if last {
                    left.rfind(words)?
                } else {
                    left.find(words)?
                };
                values.push((name, &left[..at]));
                left = &left[at + words.len()..];
            }
        }
    }
    match open {
        Some(name) => values.push((name, left)),
        None if !left.is_empty() => return None,
        None => {}
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn german() -> Sentences {
        [
            ("the rig has {values}", "der Prüfstand hat {values}"),
            (
                "the rig has {values}, but not {more}",
                "{more} fehlt: {values}",
            ),
            (
                "it is {way} here{like}; it looks odd",
                "{way}{like}; seltsam",
            ),
            (": as {other}", ": wie {other}"),
            ("high", "hoch"),
        ]
        .map(|(a, b)| (a.to_owned(), b.to_owned()))
        .into()
    }

    #[test]
    fn valid_sentences_are_known_by_their_templates() {
        let told = |text: &str| tell(&german(), text);
        assert_eq!(told("the rig has R = 0.9"), "der Prüfstand hat R = 0.9");
        assert_eq!(told("the rig has R, but not β. Well."), "β fehlt: R. Well.");
        assert_eq!(
            told("it is high here: as m; it looks odd"),
            "hoch: wie m; seltsam"
        );
        assert_eq!(told("it is high here; it looks odd."), "hoch; seltsam.");
    }

    #[test]
    fn valid_what_no_template_knows_stays() {
        let told = |text: &str| tell(&german(), text);
        assert_eq!(told("r1: a word; high"), "r1: a word; hoch");
        assert_eq!(told("the rig has R; high"), "der Prüfstand hat R; hoch");
        assert_eq!(told("low; the rig had: a"), "low; the rig had: a");
        assert_eq!(told(""), "");
    }
}
