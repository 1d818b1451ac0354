//! A campaign in one workbook: a sheet of settings, and a sheet a record beside it. From `init` to the report.

use std::fmt::Write as _;

use super::rig::{Take, assert_the_answer_is_true, done, state, takes};
use crate::support::Lab;

/// Files of an archive that stores them as they are.
fn archive(files: &[(String, String)]) -> Vec<u8> {
    let (mut out, mut list) = (Vec::new(), Vec::new());
    for (name, text) in files {
        let mut sum = flate2::Crc::new();
        sum.update(text.as_bytes());
        let number = |n: usize| u32::try_from(n).expect("a small file").to_le_bytes();
        // version 2.0, no flags, stored, 1980-01-01
        let mut head = vec![20, 0, 0, 0, 0, 0, 0, 0, 33, 0];
        head.extend(sum.sum().to_le_bytes());
        head.extend([number(text.len()), number(text.len())].concat());
        head.extend([&number(name.len())[..2], &[0, 0]].concat());
        list.extend(b"PK\x01\x02\x14\0");
        list.extend(&head);
        list.extend([0; 10]);
        list.extend(number(out.len()));
        list.extend(name.as_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(head);
        out.extend(name.as_bytes());
        out.extend(text.as_bytes());
    }
    let count = u16::try_from(files.len()).expect("few files").to_le_bytes();
    let place = u32::try_from(out.len())
        .expect("a small file")
        .to_le_bytes();
    let length = u32::try_from(list.len())
        .expect("a small file")
        .to_le_bytes();
    out.extend(list);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend([count, count].concat());
    out.extend([length, place].concat());
    out.extend([0, 0]);
    out
}

/// A sheet's cells, as a program writes them.
fn sheet(rows: &[Vec<String>]) -> String {
    let mut text = String::from(
        "<worksheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><sheetData>",
    );
    for (number, row) in (1..).zip(rows) {
        let _ = write!(text, "<row r=\"{number}\">");
        for (letter, cell) in ('A'..).zip(row) {
            let _ = if cell.parse::<f64>().is_ok() {
                write!(text, "<c r=\"{letter}{number}\"><v>{cell}</v></c>")
            } else {
                write!(
                    text,
                    "<c r=\"{letter}{number}\" t=\"inlineStr\"><is><t>{cell}</t></is></c>"
                )
            };
        }
        text.push_str("</row>");
    }
    text + "</sheetData></worksheet>"
}

/// A workbook of named sheets.
fn workbook(sheets: &[(String, Vec<Vec<String>>)]) -> Vec<u8> {
    let kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006";
    let types = "application/vnd.openxmlformats-officedocument.spreadsheetml";
    let (mut list, mut links, mut parts) = (String::new(), String::new(), String::new());
    for (number, (name, _)) in (1..).zip(sheets) {
        let _ = write!(
            list,
            "<sheet name=\"{name}\" sheetId=\"{number}\" r:id=\"rId{number}\"/>"
        );
        let _ = write!(
            links,
            "<Relationship Id=\"rId{number}\" Type=\"{kind}/worksheet\" Target=\"worksheets/sheet{number}.xml\"/>"
        );
        let _ = write!(
            parts,
            "<Override PartName=\"/xl/worksheets/sheet{number}.xml\" ContentType=\"{types}.worksheet+xml\"/>"
        );
    }
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let mut files = vec![
        (
            "[Content_Types].xml".to_owned(),
            format!(
                "<Types xmlns=\"{package}/content-types\"><Default Extension=\"rels\" \
                 ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Override \
                 PartName=\"/xl/workbook.xml\" ContentType=\"{types}.sheet.main+xml\"/>{parts}</Types>"
            ),
        ),
        (
            "_rels/.rels".to_owned(),
            format!(
                "<Relationships xmlns=\"{package}/relationships\"><Relationship Id=\"rId1\" \
                 Type=\"{kind}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
            ),
        ),
        (
            "xl/workbook.xml".to_owned(),
            format!(
                "<workbook xmlns=\"{main}\" xmlns:r=\"{kind}\"><sheets>{list}</sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels".to_owned(),
            format!("<Relationships xmlns=\"{package}/relationships\">{links}</Relationships>"),
        ),
    ];
    for (number, (_, rows)) in (1..).zip(sheets) {
        files.push((format!("xl/worksheets/sheet{number}.xml"), sheet(rows)));
    }
    archive(&files)
}

fn words(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|c| (*c).to_owned()).collect()
}

/// Columns of the simulated rig, their heads as saved, and the factors from V.
const COLUMNS: [(&str, &str, f64); 4] = [
    ("generator", "drive [V]", 1.0),
    ("contact", "contact [V]", 1.0),
    ("laser_x", "velocity x [m/s]", 0.2),
    ("integrator_x", "displacement x [mm]", 2.0),
];

/// The sheet of a record.
fn saved(take: &Take) -> Vec<Vec<String>> {
    let columns = COLUMNS.map(|(name, _, factor)| take.channel(name, factor));
    let mut rows = vec![words(&[
        "time [s]",
        COLUMNS[0].1,
        COLUMNS[1].1,
        COLUMNS[2].1,
        COLUMNS[3].1,
    ])];
    for (i, time) in take.times().iter().enumerate() {
        let cells = columns.iter().map(|c| format!("{:.6}", c[i]));
        rows.push(std::iter::once(format!("{time:.4}")).chain(cells).collect());
    }
    rows
}

#[test]
fn valid_a_workbook_with_a_sheet_of_settings_from_init_to_the_report() {
    let lab = Lab::new();
    let takes = takes(&lab, &["--rig", "exact", "--seed", "53", "--records", "45"]);
    let mut settings = vec![words(&["sheet", "frequency [Hz]", "gap [mm]", "direction"])];
    let mut sheets = Vec::new();
    for (number, take) in (1..).zip(&takes) {
        let name = format!("run {number}");
        let way = if take.upward { "up" } else { "down" };
        settings.push(words(&[&name, &take.frequency_hz, &take.clearance_mm, way]));
        sheets.push((name, saved(take)));
    }
    sheets.insert(0, ("Settings".to_owned(), settings));
    std::fs::write(lab.path("day/campaign.xlsx"), workbook(&sheets)).expect("room");
    done(&lab, &["init", "day"]);
    let written = lab.read("day/campaign.toml");
    assert!(
        written.contains("\nrun_table = \"campaign.xlsx\"\n"),
        "{written}"
    );
    // what the user knows and no file states
    lab.replace(
        "day/campaign.toml",
        "machine = \"single\"",
        "machine = \"double\"",
    );
    state(&lab, "displacement x", "high_pass = \"0.5 Hz\"");
    assert_the_answer_is_true(&lab, 45);
}
