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
        println!(
            "{name}: content {made:?}, figures {drawn:?}, pdf {set:?}, {} bytes",
            pdf.len()
        );
        std::fs::write(format!("{folder}/{name}.pdf"), pdf).expect("written");
        let html = report.html().expect("a page");
        std::fs::write(format!("{folder}/{name}.html"), html).expect("written");
    }
}
