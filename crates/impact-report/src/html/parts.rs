//! The parts of the page, from the document's data.

use crate::document::model::*;
use crate::error::ReportError;
use crate::kit::Figure;
use crate::kit::escape;
use crate::kit::look;
use crate::kit::richtext::Level;
use crate::phrase::Phrase;

/// Longer tables can be scrolled.
const MOST_ROWS: usize = 40;

/// Writes the parts.
pub(super) struct Parts<'a> {
    document: &'a Document,
    figures: &'a [Figure],
}

impl<'a> Parts<'a> {
    /// With the figures that may be referred to.
    pub(super) fn new(document: &'a Document, figures: &'a [Figure]) -> Self {
        Self { document, figures }
    }

    /// The whole body.
    pub(super) fn body(&self) -> Result<String, ReportError> {
        let document = self.document;
        let mut body = format!(
            "<header>\n<h1>{}</h1>\n<div class=\"subtitle\">{}</div>\n</header>\n",
            escape(&document.title),
            rich(&document.subtitle)
        );
        body.push_str(&self.front(&document.front)?);
        for section in &document.sections {
            body.push_str(&format!("<section>\n<h2>{}</h2>\n", rich(&section.title)));
            for block in &section.blocks {
                body.push_str(&self.block(block)?);
            }
            body.push_str("</section>\n");
        }
        body.push_str(&format!("<footer>{}</footer>\n", rich(&document.footer)));
        Ok(body)
    }

    fn front(&self, front: &Front) -> Result<String, ReportError> {
        let mut text = String::new();
        if front.synthetic {
            let synthetic = Phrase::SyntheticData;
            let synthetic = escape(self.document.translate(synthetic));
            text.push_str(&format!("<p class=\"synthetic\">{synthetic}</p>\n"));
        }
        text.push_str(&format!(
            "<div class=\"verdict {}\"><div class=\"headline\">{}</div><p>{}</p></div>\n",
            front.verdict,
            rich(&front.headline),
            rich(&front.summary)
        ));
        let answers: String = front
            .answers
            .iter()
            .map(|a| answer(a, self.document))
            .collect();
        if !answers.is_empty() {
            text.push_str(&format!("<div class=\"answers\">\n{answers}</div>\n"));
        }
        if let Some(specimens) = &front.specimens {
            text.push_str(&table(specimens));
        }
        let pair: Vec<FigureRef> = [&front.map, &front.estimates]
            .into_iter()
            .flatten()
            .cloned()
            .collect();
        text.push_str(&self.figures(&pair)?);
        text.push_str(&agreement(front, self.document));
        let findings: String = front
            .findings
            .iter()
            .map(|f| format!("<li>{}</li>\n", rich(f)))
            .collect();
        if !findings.is_empty() {
            text.push_str(&format!("<ul>\n{findings}</ul>\n"));
        }
        if !front.facts.is_empty() {
            let title = escape(self.document.translate(Phrase::WhatWasMeasured));
            text.push_str(&format!("<h2>{title}</h2>\n"));
            text.push_str(&pairs(
                "facts",
                front.facts.iter().map(|(a, b)| (rich(a), rich(b))),
            ));
        }
        Ok(text)
    }

    fn block(&self, block: &Block) -> Result<String, ReportError> {
        Ok(match block {
            Block::Paragraph { text } => format!("<p>{}</p>\n", rich(text)),
            Block::Figures { figures, .. } => self.figures(figures)?,
            Block::Table(table) => self::table(table),
            Block::Verbatim { text, .. } => format!("<pre>{}</pre>\n", escape(text)),
            Block::Definitions { entries } => pairs(
                "definitions",
                entries.iter().map(|e| (escape(e.plain), rich(&e.meaning))),
            ),
        })
    }

    fn figures(&self, refs: &[FigureRef]) -> Result<String, ReportError> {
        let mut text = String::new();
        for reference in refs {
            if let Some(figure) = self.figures.iter().find(|f| f.name == reference.name) {
                text.push_str(&self.figure(reference, figure)?);
            }
        }
        Ok(if text.is_empty() {
            text
        } else {
            format!("<div class=\"figures\">\n{text}</div>\n")
        })
    }

    fn figure(&self, reference: &FigureRef, figure: &Figure) -> Result<String, ReportError> {
        let class = if figure.drawing.width > look::NARROW {
            " class=\"wide\""
        } else {
            ""
        };
        let mut text = format!(
            "<figure{class}>\n<div class=\"drawing\" data-name=\"{}\" data-width=\"{}\">\n{}",
            escape(&figure.name),
            figure.drawing.width,
            figure.svg()
        );
        if !figure.spots.is_empty() {
            let spots = serde_json::to_string(&figure.spots).map_err(ReportError::Data)?;
            let safe = spots.replace("</", "<\\/");
            text.push_str(&format!(
                "<script type=\"application/json\">{safe}</script>\n"
            ));
        }
        text.push_str("</div>\n");
        if let Some(number) = reference.number {
            let caption = rich(&reference.caption);
            let word = escape(self.document.translate(Phrase::Figure));
            text.push_str(&format!(
                "<figcaption><b>{word} {number}.</b> {caption}</figcaption>\n"
            ));
        }
        text.push_str("</figure>\n");
        Ok(text)
    }
}

/// A text with symbols as HTML.
fn rich(text: &Rich) -> String {
    let run = |r: &crate::kit::richtext::Run| {
        let body = escape(&r.text);
        let body = if r.italic {
            format!("<i>{body}</i>")
        } else {
            body
        };
        match r.level {
            Level::Base => body,
            Level::Sub => format!("<sub>{body}</sub>"),
            Level::Super => format!("<sup>{body}</sup>"),
        }
    };
    text.0.iter().map(run).collect()
}

fn answer(a: &Answer, document: &Document) -> String {
    let say = |phrase: Phrase| escape(document.translate(phrase));
    let mut text = format!(
        "<div class=\"answer\"><div class=\"label\">{}</div>",
        rich(&a.name)
    );
    match &a.value {
        Some(value) => {
            text.push_str(&format!(
                "<div class=\"value\">{} = {value}</div>",
                rich(&a.symbol)
            ));
            if let Some(half) = &a.plus_minus {
                text.push_str(&format!("<div>± {half} {} (95\u{a0}%)</div>", a.unit));
            }
            if let Some(interval) = &a.interval {
                text.push_str(&format!(
                    "<div class=\"interval\">95 %: {interval} {}</div>",
                    a.unit
                ));
            }
            if a.status == "weak" {
                let weak = say(Phrase::WeaklyIdentified);
                text.push_str(&format!("<div class=\"warn\">{weak}</div>"));
            }
        }
        None => {
            text.push_str(&format!(
                "<div class=\"value label\">{}</div>",
                rich(&a.symbol)
            ));
            let (class, phrase) = match a.status {
                "not_identifiable" => ("bad", Phrase::NotIdentifiable),
                _ => ("label", Phrase::NotDetermined),
            };
            text.push_str(&format!("<div class=\"{class}\">{}</div>", say(phrase)));
        }
    }
    if let Some(note) = a.note.as_ref().filter(|_| a.status != "identified") {
        text.push_str(&format!("<div class=\"note\">{}</div>", rich(note)));
    }
    text.push_str("</div>\n");
    text
}

fn agreement(front: &Front, document: &Document) -> String {
    let text = rich(&front.agreement);
    if text.is_empty() {
        return text;
    }
    let word = match front.agree {
        "yes" => Phrase::MethodsAgree,
        "no" => Phrase::MethodsDisagree,
        _ => Phrase::AgreementUnknown,
    };
    let word = escape(document.translate(word));
    format!("<p><b class=\"{}\">{word}</b> {text}</p>\n", front.agree)
}

fn pairs(class: &str, entries: impl Iterator<Item = (String, String)>) -> String {
    let entries: String = entries
        .map(|(term, text)| format!("<dt>{term}</dt><dd>{text}</dd>\n"))
        .collect();
    format!("<dl class=\"{class}\">\n{entries}</dl>\n")
}

fn table(table: &Table) -> String {
    let rows = table.cells();
    let cell = |tag: &str, i: usize, text: &str| {
        let align = table.align.get(i).map_or("left", <&str>::from);
        format!("<{tag} class=\"{align}\">{text}</{tag}>")
    };
    let heads = table.heads.iter().enumerate();
    let heads: String = heads.map(|(i, h)| cell("th", i, &rich(h))).collect();
    let caption = rich(&table.caption);
    let caption = if caption.is_empty() {
        caption
    } else {
        format!("<caption>{caption}</caption>\n")
    };
    let class = if table.code { " class=\"code\"" } else { "" };
    let mut text = format!("<table{class}>\n{caption}<thead><tr>{heads}</tr></thead>\n<tbody>\n");
    for row in rows {
        let cells: String = row
            .iter()
            .enumerate()
            .map(|(i, t)| cell("td", i, &rich(t)))
            .collect();
        text.push_str(&format!("<tr>{cells}</tr>\n"));
    }
    text.push_str("</tbody>\n</table>\n");
    let class = if rows.len() > MOST_ROWS {
        "scroll"
    } else {
        "across"
    };
    format!("<div class=\"{class}\">\n{text}</div>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_wider_than_the_page_scrolls_by_itself() {
        let of = |rows: usize| table(&Table::of(vec![vec![Rich::verbatim("a".into())]; rows]));
        assert!(of(3).starts_with("<div class=\"across\">"));
        assert!(of(MOST_ROWS + 1).starts_with("<div class=\"scroll\">"));
        assert!(super::super::STYLE.contains(".across { overflow-x: auto; }"));
    }
}
