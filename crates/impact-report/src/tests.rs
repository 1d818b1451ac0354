//! Tests of the whole report.

use super::*;
use contents::{kind, kinds};
use std::path::Path;
use std::process::Command;

mod contents;
mod languages;

fn pdf_of(content: &ReportContent, options: &ReportOptions) -> Result<Vec<u8>, ReportError> {
    Report::new(content, options).pdf()
}

/// Output of a program; `None`, with a message, where it is not installed.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    match Command::new(program).args(arguments).output() {
        Ok(done) => Some(String::from_utf8_lossy(&done.stdout).into_owned()),
        Err(_) => {
            println!("skipped: {program} is not installed");
            None
        }
    }
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> String {
    let path = folder.join(name);
    std::fs::write(&path, bytes).expect("written");
    path.display().to_string()
}

/// Renders the examples into the folder named by `IMPACTID_REPORT_LOOKS`.
#[test]
#[ignore = "leaves reports to be looked at; IMPACTID_REPORT_LOOKS names their folder"]
fn regress_examples_can_be_looked_at() {
    let folder = std::env::var("IMPACTID_REPORT_LOOKS").expect("IMPACTID_REPORT_LOOKS");
    for (name, content) in kinds() {
        let report = Report::new(content, &ReportOptions::default());
        let pdf = report.pdf().expect("a PDF");
        written(Path::new(&folder), &format!("{name}.pdf"), &pdf);
        let page = report.html().expect("a page");
        written(Path::new(&folder), &format!("{name}.html"), page.as_bytes());
    }
}

#[test]
fn regress_documents_as_text() {
    for name in ["decays", "unidentified"] {
        let content = kind(name);
        let report = Report::new(content, &ReportOptions::default());
        insta::assert_snapshot!(name, text_of(&report.document));
    }
}

/// The document as lines of text, block by block.
fn text_of(document: &document::model::Document) -> String {
    use document::model::Block;
    let front = &document.front;
    let mut lines = vec![
        document.title.clone(),
        document.subtitle.plain(),
        front.headline.plain(),
    ];
    lines.push(front.summary.plain());
    for a in &front.answers {
        let value = a.value.as_deref().unwrap_or("-");
        let half = a.plus_minus.as_deref().unwrap_or("-");
        lines.push(format!(
            "{} = {value} +- {half} {} [{}]",
            a.symbol.plain(),
            a.unit,
            a.status
        ));
    }
    lines.extend(
        front
            .facts
            .iter()
            .map(|(a, b)| format!("{}: {}", a.plain(), b.plain())),
    );
    for section in &document.sections {
        lines.push(format!("## {}", section.title.plain()));
        for block in &section.blocks {
            match block {
                Block::Paragraph { text } => lines.push(text.plain()),
                Block::Figures { figures, .. } => lines.extend(
                    figures
                        .iter()
                        .map(|f| format!("[figure {}] {}", f.name, f.caption.plain())),
                ),
                Block::Table(t) => {
                    let row = |r: &Vec<document::model::Rich>| {
                        r.iter()
                            .map(document::model::Rich::plain)
                            .collect::<Vec<_>>()
                            .join(" | ")
                    };
                    lines.push(format!("[table] {}", row(&t.heads)));
                    lines.extend(t.rows.iter().map(row));
                }
                Block::Verbatim { text, .. } => lines.push(format!("[verbatim] {text}")),
                Block::Definitions { entries } => {
                    lines.extend(
                        entries
                            .iter()
                            .map(|e| format!("{}: {}", e.plain, e.meaning.plain())),
                    );
                }
            }
        }
    }
    lines.join("\n")
}

#[test]
fn no_text_of_a_figure_is_overfull() {
    for (name, content) in kinds() {
        for decimal_comma in [false, true] {
            let options = ReportOptions {
                decimal_comma,
                ..ReportOptions::default()
            };
            for figure in Report::new(content, &options).figures {
                assert!(
                    figure.overfull.is_empty(),
                    "{name}, {}: {:?}",
                    figure.name,
                    figure.overfull
                );
            }
        }
    }
}

#[test]
fn no_word_leaves_the_page_s_margins() {
    let folder = tempfile::tempdir().expect("a folder");
    let papers = [Paper::A4, Paper::UsLetter];
    for ((name, content), paper) in kinds().iter().zip(papers.into_iter().cycle()) {
        let options = ReportOptions {
            paper,
            ..ReportOptions::default()
        };
        let pdf = pdf_of(content, &options).expect("a PDF");
        assert!(pdf.len() < 5_000_000, "{name}: {} bytes", pdf.len());
        let path = written(folder.path(), "report.pdf", &pdf);
        let Some(boxes) = output("pdftotext", &["-bbox", &path, "-"]) else {
            return;
        };
        words_within_margins(name, &boxes);
    }
}

#[test]
fn a_long_title_takes_one_line_above_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut content = kind("whole").clone();
    content.title = "Restitution of rubber bumpers of two makes, ".repeat(5);
    let laboratory = "Laboratory for Structural Dynamics, Building 7, Room 12, Annex, ".repeat(3);
    content.campaign.stated = vec![(Phrase::Laboratory, laboratory)];
    let pdf = pdf_of(&content, &ReportOptions::default()).expect("a PDF");
    let path = written(folder.path(), "report.pdf", &pdf);
    let Some(boxes) = output("pdftotext", &["-bbox", &path, "-"]) else {
        return;
    };
    words_within_margins("long title", &boxes);
    let second = boxes.split("<page ").nth(2).expect("a second page");
    let top = |line: &str| -> Option<f64> {
        let rest = line.split("yMin=\"").nth(1)?;
        rest.split('"').next()?.parse().ok()
    };
    let mut tops: Vec<f64> = second
        .lines()
        .filter_map(top)
        .filter(|y| *y < 50.0)
        .collect();
    tops.dedup_by(|a, b| (*a - *b).abs() < 2.0);
    assert_eq!(tops.len(), 1, "{tops:?}");
}

fn words_within_margins(name: &str, boxes: &str) {
    let number = |line: &str, key: &str| -> f64 {
        let rest = line
            .split(&format!("{key}=\""))
            .nth(1)
            .expect("the attribute");
        rest.split('"')
            .next()
            .and_then(|v| v.parse().ok())
            .expect("a number")
    };
    let (mut width, mut height) = (0.0, 0.0);
    assert!(boxes.contains("<word "), "{name} has no words");
    for line in boxes.lines() {
        if line.contains("<page ") {
            (width, height) = (number(line, "width"), number(line, "height"));
        } else if line.contains("<word ") {
            let (left, right) = (number(line, "xMin"), number(line, "xMax"));
            let (top, bottom) = (number(line, "yMin"), number(line, "yMax"));
            let margin = 0.5 * (width - kit::look::FULL_WIDTH) - 2.5;
            let inside =
                left >= margin && right <= width - margin && top > 20.0 && bottom < height - 20.0;
            assert!(inside, "{name}: {line}");
        }
    }
}

/// The share of the room between header and footer that each page's words reach down to.
fn filled_pages(boxes: &str) -> Vec<f64> {
    const TOP: f64 = 56.7;
    const BOTTOM: f64 = 53.9;
    let number = |line: &str, key: &str| -> Option<f64> {
        let rest = line.split(&format!("{key}=\"")).nth(1)?;
        rest.split('"').next()?.parse().ok()
    };
    let pages = boxes.split("<page ").skip(1);
    let filled = pages.map(|page| {
        let height = number(page, "height").expect("a height");
        let words = page.lines().filter_map(|line| number(line, "yMax"));
        let lowest = words.filter(|y| *y < height - BOTTOM).fold(0.0, f64::max);
        (lowest - TOP) / (height - TOP - BOTTOM)
    });
    filled.collect()
}

/// The share of the pages that is filled; `None` where the program that reads them is not installed.
fn filled_in(report: &Report) -> Option<Vec<f64>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = written(folder.path(), "report.pdf", &report.pdf().expect("a PDF"));
    let boxes = output("pdftotext", &["-bbox", &path, "-"])?;
    Some(filled_pages(&boxes))
}

/// Reports of small campaigns and of comparisons, the former with few and with many inputs.
fn small_reports(options: &ReportOptions) -> Vec<(String, Report)> {
    let with_inputs = |name: &'static str, count: usize| {
        let mut content = kind(name).clone();
        let input = |i: usize| (format!("hall 3/throw {i:02}.csv"), format!("{i:064x}"));
        content.provenance.inputs_sha256 = (0..count).map(input).collect();
        let report = Report::new(&content, options);
        (format!("{name}, {count} inputs"), report)
    };
    let counts = [1, 30, 110];
    let names = ["decays", "cart", "unidentified"];
    let each = names.into_iter().zip(std::iter::repeat(counts));
    let mut reports: Vec<_> = each
        .flat_map(|(name, counts)| counts.map(|count| with_inputs(name, count)))
        .collect();
    let compared = Report::of_campaigns(&contents::compared(), options);
    reports.push(("compared".into(), compared));
    reports
}

#[test]
fn no_page_is_more_than_half_empty_but_that_of_a_report_of_one() {
    for (language, paper) in [("en", Paper::A4), ("de", Paper::UsLetter)] {
        let options = ReportOptions {
            paper,
            language: language.into(),
            ..ReportOptions::default()
        };
        let whole = ["whole", "small"].map(|name| {
            let report = Report::new(kind(name), &options);
            (name.to_owned(), report)
        });
        for (name, report) in small_reports(&options).into_iter().chain(whole) {
            let Some(filled) = filled_in(&report) else {
                return;
            };
            let full = filled.iter().all(|f| *f > 0.5);
            assert!(full || filled.len() == 1, "{name}, {paper:?}: {filled:?}");
        }
    }
}

#[test]
fn figures_stay_in_their_section_and_are_numbered_as_they_follow() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, content) in kinds() {
        let pdf = pdf_of(content, &ReportOptions::default()).expect("a PDF");
        let path = written(folder.path(), "report.pdf", &pdf);
        let Some(words) = output("pdftotext", &["-raw", &path, "-"]) else {
            return;
        };
        let captions: Vec<(usize, usize)> = words
            .match_indices("Figure ")
            .filter_map(|(at, _)| {
                let (number, _) = words[at + 7..].split_once(". ")?;
                Some((at, number.parse().ok()?))
            })
            .collect();
        let numbers: Vec<usize> = captions.iter().map(|c| c.1).collect();
        let expected: Vec<usize> = (1..=numbers.len()).collect();
        assert_eq!(numbers, expected, "{name}");
        let after = words.rfind("\nUncertainty, and effects beyond the model\n");
        let after = after
            .or(words.rfind("\nAppendix A."))
            .expect("what follows");
        assert!(captions.iter().all(|c| c.0 < after), "{name}");
    }
}

#[test]
fn what_is_left_out_for_one_reason_is_one_row_with_symbols_set() {
    use impact_fit::{Item, LeftOut, Method, Reason};
    use impact_records::motion::BoundaryKind;
    let mut content = kind("whole").clone();
    content.compared.unusable.clear();
    let record = |k: usize| LeftOut {
        item: Item::Record {
            index: k,
            record: format!("r{k}"),
        },
        reason: Reason::Influential {
            method: Method::default(),
        },
    };
    let bracket = LeftOut {
        item: Item::Bracket {
            index: 0,
            boundary: BoundaryKind::PeriodDoubling,
            frequency_low_hz: 12.0,
            frequency_high_hz: 12.5,
            clearance_m: 5e-3,
        },
        reason: Reason::FarFromBoundary,
    };
    content.identification.left_out = (1..=5).map(record).chain([bracket]).collect();
    let report = Report::new(&content, &ReportOptions::default());
    let mut blocks = report.document.sections.iter().flat_map(|s| &s.blocks);
    let table = blocks.find_map(|block| match block {
        document::model::Block::Table(t) if t.name == "left_out" => Some(t),
        _ => None,
    });
    let rows = &table.expect("a table").rows;
    let cell = |i: usize, j: usize| rows[i][j].plain();
    assert_eq!(rows.len(), 2);
    assert_eq!(
        (cell(0, 0), cell(0, 1)),
        ("r1, r2, r3 …".into(), "5".into())
    );
    assert!(
        cell(0, 2).contains("left out of the method “"),
        "{}",
        cell(0, 2)
    );
    assert_eq!(cell(1, 0), "bracket s1 12.00–12.50 Hz at 5.000 mm");
    assert_eq!(rows[1][0].0[1].text, "s");
}

#[test]
fn a_clearance_is_printed_alike_everywhere() {
    let report = Report::new(kind("small"), &ReportOptions::default());
    let blocks = report.document.sections.iter().flat_map(|s| &s.blocks);
    let tables: Vec<_> = blocks
        .filter_map(|block| match block {
            document::model::Block::Table(t) => Some(t),
            _ => None,
        })
        .collect();
    let column = |name: &str| -> Vec<String> {
        let table = tables.iter().find(|t| t.name == name).expect(name);
        let column = table.heads.iter().position(|h| h.plain() == "r (mm)");
        let column = column.expect("clearances");
        table
            .cells()
            .iter()
            .map(|row| row[column].plain())
            .collect()
    };
    for name in ["brackets", "records"] {
        let decimals = |c: &String| c.split_once('.').map(|(_, d)| d.len());
        let found = column(name);
        assert!(
            found.iter().all(|c| decimals(c) == Some(3)),
            "{name}: {found:?}"
        );
    }
}

#[test]
fn regress_campaigns_compared_as_text() {
    let report = Report::of_campaigns(&contents::compared(), &ReportOptions::default());
    insta::assert_snapshot!("compared", text_of(&report.document));
    assert_eq!(report.figures[0].overfull, Vec::<String>::new());
    assert!(report.figures[0].csv.contains("before,restitution"));
}

#[test]
fn prop_same_content_gives_same_bytes() {
    let content = kind("cart");
    let options = ReportOptions::default();
    let pdf = || pdf_of(content, &options).ok();
    assert!(pdf().is_some() && pdf() == pdf());
    let page = || Report::new(content, &options).html().ok();
    assert!(page().is_some() && page() == page());
}

#[test]
fn decimal_comma_reaches_text_and_figures() {
    let options = ReportOptions {
        decimal_comma: true,
        ..ReportOptions::default()
    };
    let report = Report::new(kind("small"), &options);
    let value = report.document.front.answers[0].value.as_deref();
    assert!(value.is_some_and(|v| v.starts_with("0,")), "{value:?}");
    let map = report
        .figures
        .iter()
        .find(|f| f.name == "map")
        .expect("a map");
    let svg = map.svg();
    assert!(svg.contains(">1,5<") && !svg.contains(">1.5<"));
}

#[test]
fn own_template_and_logo_are_used() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'><rect width='40' height='20'/></svg>";
    let options = ReportOptions {
        template: Some("#let d = json(\"report.json\")\n= #d.title\n#image(d.logo)".into()),
        logo: Some(Logo {
            bytes: svg.into(),
            extension: "svg".into(),
        }),
        ..ReportOptions::default()
    };
    let own = pdf_of(kind("cart"), &options).expect("a PDF");
    let with_logo = ReportOptions {
        template: None,
        ..options
    };
    let ours = pdf_of(kind("cart"), &with_logo).expect("a PDF");
    let plain = pdf_of(kind("cart"), &ReportOptions::default()).expect("a PDF");
    assert!(
        own.len() < plain.len(),
        "the own template holds a title and a logo alone"
    );
    assert!(ours != plain, "the logo is not in the report");
}

#[test]
fn wrong_template_is_named_with_its_line() {
    let options = ReportOptions {
        template: Some("text\n#unknown-thing".into()),
        ..ReportOptions::default()
    };
    let error = pdf_of(kind("cart"), &options).expect_err("a wrong template");
    let text = error.to_string();
    assert!(
        text.contains("unknown variable: unknown-thing") && text.contains("line 2"),
        "{text}"
    );
}

#[test]
fn every_format_has_its_files() {
    let report = Report::new(kind("cart"), &ReportOptions::default());
    for &format in Format::ALL {
        let files = report.files(format).expect("files");
        assert!(!files.is_empty() && files.iter().all(|(_, bytes)| !bytes.is_empty()));
        for (path, bytes) in files {
            let ending = format.name().trim_start_matches("figure-");
            assert!(path.ends_with(ending), "{path}");
            if format == Format::Png {
                assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
            }
        }
    }
}
