//! The document as plain data: what the template and the HTML page lay out.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use crate::kit::richtext::{self, Run};
use crate::phrase::Phrase;

/// A text with markup, split into runs; serialised as a string where it has none.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Rich(pub Vec<Run>);

impl Rich {
    /// A text that has no markup, whatever signs it holds.
    pub(crate) fn verbatim(text: String) -> Self {
        if text.is_empty() {
            return Self::default();
        }
        Self(vec![Run {
            text,
            italic: false,
            level: richtext::Level::Base,
        }])
    }

    /// The text without markup.
    pub(crate) fn plain(&self) -> String {
        self.0.iter().map(|r| r.text.as_str()).collect()
    }
}

impl<T: AsRef<str>> From<T> for Rich {
    fn from(markup: T) -> Self {
        // a number and its per cent stay in one line
        Self(richtext::parse(&markup.as_ref().replace(" %", "\u{a0}%")))
    }
}

impl Serialize for Rich {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [] => serializer.serialize_str(""),
            [run] if !run.italic && run.level == richtext::Level::Base => {
                serializer.serialize_str(&run.text)
            }
            runs => runs.serialize(serializer),
        }
    }
}

/// The whole document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Document {
    /// Title.
    pub title: String,
    /// A line under the title.
    pub subtitle: Rich,
    /// The footer of each page.
    pub footer: Rich,
    /// The first page.
    pub front: Front,
    /// All that follows.
    pub sections: Vec<Section>,
    /// Phrases of the layout itself, and what is printed for them.
    pub words: BTreeMap<&'static str, String>,
}

impl Document {
    /// With its figures numbered in the order of the sections.
    pub(crate) fn with_numbers(mut self) -> Self {
        let blocks = self.sections.iter_mut().flat_map(|s| &mut s.blocks);
        let figures = blocks.flat_map(|block| match block {
            Block::Figures { figures, .. } => figures.as_mut_slice(),
            _ => &mut [],
        });
        let captioned = figures.filter(|f| f.caption != Rich::default());
        for (i, figure) in captioned.enumerate() {
            figure.number = Some(i + 1);
        }
        self
    }

    /// What is printed for a phrase of the layout.
    pub(crate) fn translate(&self, phrase: Phrase) -> &str {
        let english = phrase.english();
        self.words.get(english).map_or(english, String::as_str)
    }
}

/// The first page: the answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Front {
    /// Whether the data are simulated.
    pub synthetic: bool,
    /// One word for the verdict: `identified`, `weak`, `not_identifiable`, `does_not_fit`.
    pub verdict: &'static str,
    /// The verdict as a headline.
    pub headline: Rich,
    /// Two sentences.
    pub summary: Rich,
    /// Reasons and findings.
    pub findings: Vec<Rich>,
    /// The parameters; empty where only each specimen alone has an answer.
    pub answers: Vec<Answer>,
    /// The answer for each specimen, where the campaign holds several.
    pub specimens: Option<Table>,
    /// Whether the methods agree: `yes`, `no` or `unknown`.
    pub agree: &'static str,
    /// The same in words.
    pub agreement: Rich,
    /// What was measured: label and value.
    pub facts: Vec<(Rich, Rich)>,
    /// The small map, where there is one.
    pub map: Option<FigureRef>,
    /// The estimates of all methods, where there are any.
    pub estimates: Option<FigureRef>,
}

/// One parameter with its value and interval, ready to print.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Answer {
    /// Its symbol.
    pub symbol: Rich,
    /// Its name.
    pub name: Rich,
    /// Its value without unit; `None` if not identifiable.
    pub value: Option<String>,
    /// Half the 95 % interval, same decimals.
    pub plus_minus: Option<String>,
    /// The unit; empty for a plain number.
    pub unit: String,
    /// The interval as text.
    pub interval: Option<String>,
    /// `identified`, `weak`, `not_identifiable` or `not_asked`.
    pub status: &'static str,
    /// Why weak or not identifiable.
    pub note: Option<Rich>,
}

/// A figure in its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FigureRef {
    /// Its name, the stem of its file.
    pub name: String,
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// Its number in the document, from 1; `None` without a caption.
    pub number: Option<usize>,
    /// Caption; empty for none.
    pub caption: Rich,
    /// Text for those who cannot see it.
    pub alt: String,
}

/// A section with its heading.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Section {
    /// Heading.
    pub title: Rich,
    /// Depth: 1 or 2.
    pub level: u8,
    /// Whether it begins a page.
    pub new_page: bool,
    /// Whether it is an appendix.
    pub appendix: bool,
    /// Its content.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub(crate) enum Block {
    /// A paragraph.
    Paragraph {
        /// The text.
        text: Rich,
    },
    /// Figures; narrow ones are side by side.
    Figures {
        /// The figures.
        figures: Vec<FigureRef>,
        /// Where on the page.
        placement: Placement,
    },
    /// A table.
    Table(Table),
    /// Text as typed.
    Verbatim {
        /// The text.
        text: String,
        /// In how many columns.
        columns: u8,
    },
    /// Terms and what they mean; formulas are typst maths.
    Definitions {
        /// The entries.
        entries: Vec<Definition>,
    },
}

/// Where figures are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Placement {
    /// Where the text has them.
    InText,
    /// In the order that fills the pages: of those that are left the first that has room.
    Filling,
}

/// A convention: a formula and its meaning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Definition {
    /// The formula as typst maths.
    pub formula: &'static str,
    /// The formula as plain text.
    pub plain: &'static str,
    /// What it means.
    pub meaning: Rich,
}

/// Alignment of the cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub(crate) enum Align {
    /// At the left.
    Left,
    /// At the right.
    Right,
    /// In the middle.
    Center,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Table {
    /// Stem of the file that it is written into by itself; empty for none.
    #[serde(skip)]
    pub name: &'static str,
    /// Caption; empty for none.
    pub caption: Rich,
    /// Heads of the columns.
    pub heads: Vec<Rich>,
    /// Alignment of the cells of each column.
    pub align: Vec<Align>,
    /// Relative width of each column; 0: as wide as its content.
    pub widths: Vec<u16>,
    /// The cells, row by row.
    pub rows: Vec<Vec<Rich>>,
    /// Size of the type, points.
    pub size: f64,
    /// Whether the cells are codes and names of files: in the type of code, of which nothing is broken that has room.
    pub code: bool,
    /// How many copies of the columns are side by side.
    pub side_by_side: u8,
    /// Where the rows are many and short: whole columns as text, one line a row, and no `rows`.
    pub dense: bool,
    /// The columns' text of a dense table.
    pub columns_text: Vec<String>,
    /// The rows of a dense table, without markup, for what is not set by the template.
    #[serde(skip)]
    pub dense_rows: Vec<Vec<Rich>>,
}

/// Default size of the type of a table, points.
const TABLE_SIZE: f64 = 8.5;

impl Table {
    /// A table of some rows, without caption and heads, set once and in the usual size.
    pub(crate) fn of(rows: Vec<Vec<Rich>>) -> Self {
        Self {
            name: "",
            caption: Rich::default(),
            heads: Vec::new(),
            align: Vec::new(),
            widths: Vec::new(),
            rows,
            size: TABLE_SIZE,
            code: false,
            side_by_side: 1,
            dense: false,
            columns_text: Vec::new(),
            dense_rows: Vec::new(),
        }
    }

    /// The same table with a name for a file of its own.
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// The table as a part of a section.
    pub(crate) fn block(self, name: &'static str) -> Block {
        Block::Table(self.named(name))
    }

    /// The cells, row by row, of a dense table too.
    pub(crate) fn cells(&self) -> &[Vec<Rich>] {
        if self.dense {
            &self.dense_rows
        } else {
            &self.rows
        }
    }

    /// The same table with its columns as text, which is set far faster and drops all markup.
    pub(crate) fn densely(self) -> Self {
        let column = |i: usize| {
            let cells: Vec<String> = self.rows.iter().map(|row| row[i].plain()).collect();
            cells.join("\n")
        };
        let plain = |row: &Vec<Rich>| row.iter().map(|c| Rich::verbatim(c.plain())).collect();
        Self {
            dense: true,
            columns_text: (0..self.heads.len()).map(column).collect(),
            dense_rows: self.rows.iter().map(plain).collect(),
            rows: Vec::new(),
            ..self
        }
    }
}
