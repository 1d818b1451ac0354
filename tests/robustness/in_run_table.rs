//! Faults in the run table.

use super::{Case, refused, table_edited};

/// The cases.
pub(super) fn cases() -> Vec<Case> {
    let mut all = header();
    all.extend(rows());
    all
}

fn header() -> Vec<Case> {
    vec![
        refused(
            "the run table is not there",
            |lab| lab.remove("runs.csv"),
            &[
                "runs.csv",
                "the run table cannot be read",
                "check run_table",
            ],
        ),
        refused(
            "the run table is empty",
            |lab| lab.write("runs.csv", ""),
            &["runs.csv:1", "the run table is empty"],
        ),
        refused(
            "a header and no rows",
            |lab| lab.write("runs.csv", "file,clearance_mm\n"),
            &["has a header and no records"],
        ),
        refused(
            "no column of files",
            |lab| {
                // a column of cells that name files would be that of files, whatever its heading
                lab.replace("runs.csv", "file,", "name,");
                for (file, cell) in [("r1.csv", "one"), ("r2.csv", "two"), ("r3.csv", "three")] {
                    lab.replace("runs.csv", file, cell);
                }
            },
            &["the run table has no column 'file'"],
        ),
        table_edited(
            "a clearance column without unit",
            "clearance_mm",
            "clearance",
            &[
                "runs.csv:1: clearance",
                "a clearance without unit",
                "call it clearance_mm",
            ],
        ),
        table_edited(
            "a frequency column without unit",
            "drive_frequency_hz",
            "drive_frequency",
            &[
                "a drive frequency without unit",
                "call it drive_frequency_hz",
            ],
        ),
        table_edited(
            "a frequency column in mm",
            "drive_frequency_hz",
            "drive_frequency [mm]",
            &["'mm' is no unit of frequency"],
        ),
        table_edited(
            "an unknown column",
            "sweep",
            "swep",
            &["the column 'swep' is not known", "did you mean 'sweep'"],
        ),
        table_edited(
            "a column that is there twice",
            "sweep",
            "clearance_mm",
            &["the column 'clearance' is there twice"],
        ),
    ]
}

fn rows() -> Vec<Case> {
    vec![
        table_edited(
            "a cell that is no number",
            "r2.csv,12,",
            "r2.csv,twelve,",
            &["runs.csv:3: drive_frequency", "'twelve' is not a number"],
        ),
        table_edited(
            "a row with a decimal comma",
            "r2.csv,12,1.0",
            "r2.csv,12,1,0",
            &["runs.csv:3", "the row has 5 cells, the header 4"],
        ),
        table_edited(
            "a row cut short",
            "r2.csv,12,1.0,up",
            "r2.csv,12",
            &["runs.csv:3", "the row has 2 cells, the header 4"],
        ),
        table_edited(
            "a sweep direction that is none",
            "down",
            "sideways",
            &[
                "runs.csv:4: sweep",
                "'sideways' is not one of up, down, unknown",
            ],
        ),
        refused(
            "a sweep direction that is none, in a table of Windows",
            |lab| {
                let text = lab
                    .read("runs.csv")
                    .replace("down", "sideways")
                    .replace('\n', "\r\n");
                lab.write("runs.csv", &text);
            },
            &[
                "runs.csv:4: sweep",
                "'sideways' is not one of up, down, unknown",
            ],
        ),
        table_edited(
            "a row without a file",
            "r2.csv,",
            ",",
            &["runs.csv:3: file", "no file is named"],
        ),
        table_edited(
            "the same file in two rows",
            "r3.csv",
            "r1.csv",
            &["runs.csv:4", "'r1.csv' is already in line 2"],
        ),
        refused(
            "a row names a file that is not there",
            |lab| lab.remove("r2.csv"),
            &["r2.csv", "2 of 3 records can be used"],
        ),
        refused(
            "a row names a dataset that is not there",
            |lab| {
                lab.write("runs.csv", "file,dataset\nr1.csv,run7\nr2.csv,\n");
            },
            &[
                "r1.csv: r1/run7",
                "no dataset 'run7' in it",
                "fix the column dataset",
            ],
        ),
        refused(
            "a clearance in m that was meant in mm",
            |lab| {
                lab.replace("runs.csv", "clearance_mm", "clearance_m");
                lab.replace("runs.csv", "1.0", "15");
            },
            &["a clearance of 15 m", "check its unit: mm?"],
        ),
        table_edited(
            "a drive frequency of zero",
            "r2.csv,12",
            "r2.csv,0",
            &["r2.csv: drive_frequency", "a drive frequency of 0 Hz"],
        ),
    ]
}
