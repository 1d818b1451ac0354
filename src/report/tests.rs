//! Tests of the whole report.

use super::example;
use super::*;

/// Renders the examples into the folder named by IMPACTID_REPORT_LOOKS, to be looked at.
#[test]
fn regress_examples_can_be_looked_at() {
    let Ok(folder) = std::env::var("IMPACTID_REPORT_LOOKS") else {
        println!("skipped: IMPACTID_REPORT_LOOKS names no folder");
        return;
    };
    for (name, extent) in [("small", example::SMALL), ("large", example::LARGE)] {
        let start = std::time::Instant::now();
        let content = example::content(extent);
        let made = start.elapsed();
        let report = Report::new(&content, &RenderOptions::default());
        let drawn = start.elapsed() - made;
        let pdf = report.pdf().expect("a PDF");
        let set = start.elapsed() - made - drawn;
        if name == "large" {
            for (what, c) in [
                ("no records table", {
                    let mut c = content.clone();
                    c.records.truncate(0);
                    c
                }),
                ("no figures", {
                    let mut c = content.clone();
                    c.comparisons.clear();
                    c.region_map = None;
                    c.curves.clear();
                    c.brackets.clear();
                    for r in &mut c.records {
                        r.eta = None;
                        r.clearance_m = None;
                    }
                    c
                }),
            ] {
                let start = std::time::Instant::now();
                let report = Report::new(&c, &RenderOptions::default());
                let d = start.elapsed();
                let pdf = report.pdf().expect("a PDF");
                println!(
                    "{what}: figures {d:?}, all {:?}, {} bytes",
                    start.elapsed(),
                    pdf.len()
                );
            }
        }
        println!(
            "{name}: content {made:?}, figures {drawn:?}, pdf {set:?}, {} bytes",
            pdf.len()
        );
        std::fs::write(format!("{folder}/{name}.pdf"), pdf).expect("written");
    }
}
