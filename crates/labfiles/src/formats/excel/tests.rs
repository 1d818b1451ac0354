use super::*;
use crate::conformance::{own, shared_data, wave};

fn real(source: &dyn Source, dataset: usize, channel: usize) -> Vec<f64> {
    let samples = source.read(dataset, &[channel]).unwrap().remove(0);
    samples.into_real().unwrap()
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_shared_data_workbooks_of_a_phone_are_read() {
    let folder = shared_data("bouncing_balls");
    for file in [
        "original/Lancio 1, tennis, 65.xls",
        "original/Lancio4,10cm.xlsx",
    ] {
        let source = open(&folder.join(file)).unwrap();
        for set in source.datasets() {
            println!("{file}: {set:?}");
        }
    }
    // The CSV of the same throw was written from the workbook by other people.
    let source = open(&folder.join("original/Lancio 1, tennis, 65.xls")).unwrap();
    let table = crate::open(&folder.join("tennis/Lancio_1-_tennis-_65.csv")).unwrap();
    let times = real(table.as_ref(), 0, 0);
    let same = (0..source.datasets()[0].channels.len()).any(|c| {
        real(source.as_ref(), 0, c)
            .iter()
            .zip(&times)
            .all(|(a, b)| (a - b).abs() < 1e-9)
    });
    assert!(same, "{times:?}");
}

#[test]
fn valid_sheets_of_other_programs_are_records() {
    let source = open(&own("two_runs.xlsx")).unwrap();
    let names: Vec<&str> = source.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(names, ["Run 1", "Run 2"]);
    assert!(
        source.notes()[0].contains("'Notes' is no table"),
        "{:?}",
        source.notes()
    );
    let info = &source.datasets()[0];
    assert_eq!(info.channels[1].name, "Position");
    assert_eq!(info.channels[1].unit.as_deref(), Some("mm"));
    assert_eq!(info.time_axis, Some(0));
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
    for (i, v) in real(source.as_ref(), 0, 1).iter().enumerate() {
        assert!((v - wave(i)).abs() < 1e-15);
    }
    assert!((real(source.as_ref(), 1, 1)[9] - 2.0 * wave(9)).abs() < 1e-15);
    let old = open(&own("one_run.xls")).unwrap();
    assert_eq!(old.datasets()[0].channels[1].unit.as_deref(), Some("mm"));
    assert!((real(old.as_ref(), 0, 1)[9] - wave(9)).abs() < 1e-15);
}

#[test]
fn cells_become_a_table_and_scattered_ones_are_refused() {
    let path = Path::new("book.xlsx");
    let mut sheet = SheetCells::default();
    let rows = [("t (s)", "x\t(mm)"), ("0", "1.5"), ("0.5", "2.5")];
    for (row, (a, b)) in (3..).zip(rows) {
        sheet.push(row, 2, cells::text(a));
        sheet.push(row, 4, cells::text(b));
    }
    let text = sheet.table(path, "s").unwrap();
    assert_eq!(text, b"t (s)\t\tx (mm)\n0\t\t1.5\n0.5\t\t2.5\n");
    let mut scattered = SheetCells::default();
    for row in 0..1000 {
        scattered.push(row, 0, "1".into());
        scattered.push(row, 16_383, "1".into());
    }
    assert!(scattered.table(path, "s").is_err());
    assert!(SheetCells::default().table(path, "s").is_err());
}

#[test]
fn an_archive_that_unpacks_to_far_more_than_its_size_is_refused() {
    let mut bytes = ZIP.to_vec();
    bytes.extend_from_slice(b"PK\x01\x02");
    bytes.extend_from_slice(&[0; 20]);
    bytes.extend_from_slice(&u32::MAX.to_le_bytes());
    assert!(refuse_bomb(Path::new("bomb.xlsx"), &bytes).is_err());
}
