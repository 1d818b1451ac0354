//! The document's tables as LaTeX, one file each, to be set in a paper: `booktabs` rules, symbols as
//! mathematics.

use std::collections::BTreeMap;

use super::document::model::{Align, Block, Document, Rich, Table};
use super::kit::richtext::Level;

/// From this many rows on a table may run over pages.
const LONG: usize = 45;

/// The files of a document's tables by their paths relative to the report's folder: `tables/NAME.tex`.
pub(super) fn tables(document: &Document) -> Vec<(String, Vec<u8>)> {
    let blocks = document.sections.iter().flat_map(|s| &s.blocks);
    let in_sections = blocks.filter_map(|block| match block {
        Block::Table(table) => Some(table),
        _ => None,
    });
    let all = document.front.specimens.iter().chain(in_sections);
    let mut taken: BTreeMap<&str, usize> = BTreeMap::new();
    all.filter(|t| !t.name.is_empty())
        .map(|table| {
            let count = taken.entry(table.name).or_default();
            *count += 1;
            let number = if *count > 1 {
                format!("_{count}")
            } else {
                String::new()
            };
            let path = format!("tables/{}{number}.tex", table.name);
            (path, latex(table).into_bytes())
        })
        .collect()
}

/// Letters of usual size in a line of a page.
const LINE: usize = 70;

/// A table as LaTeX: one that is wider than a line is made smaller, and then comes in parts where it is long.
fn latex(table: &Table) -> String {
    let rows = table.cells();
    let (long, wide) = (rows.len() >= LONG, width(table, rows) > LINE);
    let columns: String = table.align.iter().map(|a| column(*a)).collect();
    let caption = match rich(&table.caption) {
        empty if empty.is_empty() => empty,
        caption => format!("\\caption{{{caption}}}\n"),
    };
    let further = match (long, wide) {
        (_, true) => " and \\usepackage{graphicx}",
        (true, false) => " and \\usepackage{longtable}",
        _ => "",
    };
    let mut text = format!("% \\usepackage{{booktabs}}{further}\n");
    let rules = format!("\\toprule\n{} \\\\\n\\midrule\n", cells(&table.heads));
    let body =
        |rows: &[Vec<Rich>]| -> String { rows.iter().map(|row| cells(row) + " \\\\\n").collect() };
    if long && !wide {
        let caption = caption.trim_end();
        let end = if caption.is_empty() { "" } else { " \\\\\n" };
        return text
            + &format!(
                "\\begin{{longtable}}{{{columns}}}\n{caption}{end}{rules}\\endhead\n\
                 \\bottomrule\n\\endfoot\n{}\\end{{longtable}}\n",
                body(rows)
            );
    }
    let (open, close) = if wide {
        (
            "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n",
            "}\n",
        )
    } else {
        ("", "")
    };
    let parts: Vec<&[Vec<Rich>]> = if rows.is_empty() {
        vec![rows]
    } else {
        rows.chunks(LONG).collect()
    };
    for (number, rows) in parts.iter().enumerate() {
        let caption = if number == 0 { caption.as_str() } else { "" };
        text += &format!(
            "\\begin{{table}}\n\\centering\n{caption}{open}\\begin{{tabular}}{{{columns}}}\n{rules}{}\
             \\bottomrule\n\\end{{tabular}}\n{close}\\end{{table}}\n",
            body(rows)
        );
    }
    text
}

/// Letters in a line of a table: of each column its longest cell, and what is between two.
fn width(table: &Table, rows: &[Vec<Rich>]) -> usize {
    let letters = |cell: &Rich| {
        cell.0
            .iter()
            .map(|run| run.text.chars().count())
            .sum::<usize>()
    };
    let of = |column: usize| {
        let cells = rows.iter().chain(std::iter::once(&table.heads));
        cells.filter_map(|row| row.get(column)).map(letters).max()
    };
    let between = 3;
    (0..table.align.len())
        .map(|c| of(c).unwrap_or(0) + between)
        .sum()
}

fn column(align: Align) -> char {
    match align {
        Align::Left => 'l',
        Align::Right => 'r',
        Align::Center => 'c',
    }
}

fn cells(row: &[Rich]) -> String {
    let each: Vec<String> = row.iter().map(rich).collect();
    let row = each.join(" & ");
    // after the end of a row LaTeX takes these for an option
    let guard = if row.starts_with(['[', '*']) {
        "{}"
    } else {
        ""
    };
    format!("{guard}{row}")
}

/// A text with markup.
fn rich(text: &Rich) -> String {
    let runs = text.0.iter().map(|run| {
        let plain = escaped(&run.text);
        let set = if run.italic {
            format!("\\textit{{{plain}}}")
        } else {
            plain
        };
        match run.level {
            Level::Base => set,
            Level::Sub => format!("\\textsubscript{{{set}}}"),
            Level::Super => format!("\\textsuperscript{{{set}}}"),
        }
    });
    runs.collect()
}

/// A text without markup: what LaTeX reads otherwise is escaped, signs beyond Latin letters are named.
fn escaped(text: &str) -> String {
    let mut all = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => all.extend(['\\', c]),
            '\\' => all.push_str("\\textbackslash{}"),
            '~' => all.push_str("\\textasciitilde{}"),
            '^' => all.push_str("\\textasciicircum{}"),
            '<' => all.push_str("\\ensuremath{<}"),
            '>' => all.push_str("\\ensuremath{>}"),
            '|' => all.push_str("\\textbar{}"),
            '\n' => all.push(' '),
            '\u{2009}' | '\u{202f}' => all.push_str("\\,"),
            '\u{a0}' => all.push('~'),
            '\u{2002}' => all.push_str("\\enspace{}"),
            '\u{2003}' => all.push_str("\\quad{}"),
            '\u{2212}' => all.push_str("\\ensuremath{-}"),
            // dashes and quotes that a file in UTF-8 may hold
            '–' => all.push_str("--"),
            '—' => all.push_str("---"),
            '“' => all.push_str("``"),
            '”' => all.push_str("''"),
            '„' => all.push_str(",,"),
            '‘' => all.push('`'),
            '’' => all.push('\''),
            '…' => all.push_str("\\ldots{}"),
            other => match symbol(other) {
                Some(name) => all.push_str(&format!("\\ensuremath{{{name}}}")),
                // pdflatex stops at what is no letter of a Latin alphabet
                None if other > '\u{17f}' => all.push_str(&format!("[U+{:04X}]", u32::from(other))),
                None => all.push(other),
            },
        }
    }
    all
}

/// A sign's name in mathematics; `None` of letters, which a file in UTF-8 may hold.
fn symbol(sign: char) -> Option<&'static str> {
    Some(match sign {
        '±' => "\\pm",
        '·' => "\\cdot",
        '×' => "\\times",
        '′' => "\\prime",
        '″' => "\\prime\\prime",
        '∞' => "\\infty",
        '≤' => "\\leq",
        '≥' => "\\geq",
        '≈' => "\\approx",
        '√' => "\\surd",
        '→' => "\\rightarrow",
        '↑' => "\\uparrow",
        '↓' => "\\downarrow",
        '½' => "\\frac{1}{2}",
        'α' => "\\alpha",
        'β' => "\\beta",
        'γ' => "\\gamma",
        'δ' => "\\delta",
        'Δ' => "\\Delta",
        'η' => "\\eta",
        'λ' => "\\lambda",
        'µ' | 'μ' => "\\mu",
        'π' => "\\pi",
        'ρ' => "\\rho",
        'σ' => "\\sigma",
        'τ' => "\\tau",
        'φ' => "\\varphi",
        'χ' => "\\chi",
        'Ω' => "\\Omega",
        'ω' => "\\omega",
        'ζ' => "\\zeta",
        'κ' => "\\kappa",
        '⁻' => "^{-}",
        '⁰' => "^{0}",
        '¹' => "^{1}",
        '²' => "^{2}",
        '³' => "^{3}",
        '⁴' => "^{4}",
        '⁵' => "^{5}",
        '⁶' => "^{6}",
        '⁷' => "^{7}",
        '⁸' => "^{8}",
        '⁹' => "^{9}",
        '₊' => "_{+}",
        '₋' => "_{-}",
        '⊙' => "\\odot",
        '●' | '•' => "\\bullet",
        '○' => "\\circ",
        '✓' => "\\checkmark",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: usize) -> Table {
        let row = vec![Rich::from("$x_{st}$ ± 5\u{2009}%"), Rich::from("r_1 & r_2")];
        Table {
            name: "example",
            caption: Rich::from("Estimates of $β$."),
            heads: vec![Rich::from("a"), Rich::from("b")],
            align: vec![Align::Right, Align::Left],
            widths: vec![0, 0],
            ..Table::of(vec![row; rows])
        }
    }

    #[test]
    fn what_latex_reads_otherwise_is_escaped_and_symbols_are_named() {
        let text = latex(&table(1));
        let row =
            "\\textit{x}\\textsubscript{st} \\ensuremath{\\pm} 5\\,\\% & r\\_1 \\& r\\_2 \\\\";
        assert!(text.contains(row), "{text}");
        assert!(text.contains("\\begin{tabular}{rl}"), "{text}");
        assert!(text.contains("\\caption{Estimates of \\textit{\\ensuremath{\\beta}}.}"));
        assert_eq!(
            escaped("a\\b^c~d"),
            "a\\textbackslash{}b\\textasciicircum{}c\\textasciitilde{}d"
        );
    }

    #[test]
    fn a_wide_table_is_made_to_fit_the_line() {
        let wide = |rows: usize| {
            let row = vec![Rich::from("a column of many words that takes much room"); 4];
            Table {
                heads: row.clone(),
                align: vec![Align::Left; 4],
                widths: vec![0; 4],
                ..Table {
                    name: "wide",
                    ..Table::of(vec![row; rows])
                }
            }
        };
        assert_eq!(latex(&wide(3)).matches("\\resizebox").count(), 1);
        let long = latex(&wide(2 * LONG + 1));
        assert_eq!(long.matches("\\begin{table}").count(), 3);
        assert_eq!(long.matches("\\resizebox").count(), 3);
        assert!(!long.contains("longtable"));
        assert_eq!(escaped("ρ′"), "\\ensuremath{\\rho}\\ensuremath{\\prime}");
    }

    #[test]
    fn signs_that_pdflatex_does_not_know_are_named() {
        assert_eq!(escaped("Überlauf 5 – 6 …"), "Überlauf 5 -- 6 \\ldots{}");
        assert_eq!(escaped("x⊗y"), "x[U+2297]y");
    }

    #[test]
    fn no_row_begins_with_what_is_an_option_of_the_row_before() {
        let first = |cell: &str| cells(&[Rich::from(cell), Rich::from("b")]);
        assert_eq!(first("\u{2003}test_1.csv"), "\\quad{}test\\_1.csv & b");
        assert_eq!(first("⊗"), "{}[U+2297] & b");
        assert_eq!(first("[a]"), "{}[a] & b");
        assert_eq!(first("*"), "{}* & b");
        assert_eq!(first("a"), "a & b");
    }

    #[test]
    fn braces_and_environments_are_closed() {
        for rows in [1, LONG] {
            for table in [table(rows), table(rows).densely()] {
                let text = latex(&table);
                let depth = text.replace("\\{", "").replace("\\}", "");
                let count = |c| depth.matches(c).count();
                assert_eq!(count('{'), count('}'), "{text}");
                assert_eq!(
                    text.matches("\\begin{").count(),
                    text.matches("\\end{").count()
                );
                assert_eq!(
                    text.matches(" \\\\\n").count(),
                    rows + if rows < LONG { 1 } else { 2 }
                );
                assert_eq!(text.contains("longtable"), rows == LONG);
            }
        }
    }
}
