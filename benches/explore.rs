//! Latencies of the explorer in a real browser: from the key until it is drawn, and on the screen.
//!
//! `cargo bench --bench explore` (needs chromium). Each row: median and 95 % point of many keys.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    dead_code,
    reason = "a benchmark fails by panicking, and uses a part of what the tests use"
)]

#[path = "../tests/explore/chromium.rs"]
mod chromium;
#[path = "../tests/explore/server.rs"]
mod server;

use chromium::Chromium;
use server::{Explorer, QUIET};

/// Keys pressed for each row.
const KEYS: usize = 120;

fn main() {
    // `cargo bench` passes --bench; under `cargo test` nothing is measured
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    if chromium::program().is_none() {
        println!("skipped: chromium is not installed");
        return;
    }
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), (1280, 800));
    browser.until(QUIET);
    println!(
        "{:46} {:^19} {:^19}",
        "from the key, ms", "drawn", "on the screen"
    );
    println!(
        "{:46} {:>9} {:>9} {:>9} {:>9} {:>6}",
        "", "p50", "p95", "p50", "p95", "keys"
    );
    browser
        .evaluate("document.querySelector('.slider input').focus(); impactid.timings.length = 0");
    press(&mut browser, KEYS);
    report(&mut browser, "R moved: boundaries, bare", "boundaries", 0);
    report(
        &mut browser,
        "R moved: boundaries with their existence",
        "boundaries",
        1,
    );
    report(&mut browser, "R moved: first tile, 32 x 24", "map", 0);
    report(&mut browser, "R moved: tile of 128 x 96", "map", 1);
    report(&mut browser, "R moved: the carried motion", "motion", 0);
    browser.evaluate("document.getElementById('map').focus(); impactid.timings.length = 0");
    press(&mut browser, KEYS);
    report(&mut browser, "η moved: the carried motion", "motion", 0);
    held(&mut browser);
}

/// Press an arrow again and again, each time when the one before is drawn.
fn press(browser: &mut Chromium, keys: usize) {
    for number in 0..keys {
        let key = if number % 40 < 20 {
            "ArrowLeft"
        } else {
            "ArrowRight"
        };
        browser.key(key, 0);
        browser.until(QUIET);
    }
}

/// An arrow held for ten seconds: the motions drawn meanwhile, and how late each was.
fn held(browser: &mut Chromium) {
    browser.evaluate("impactid.timings.length = 0");
    for number in 0..300 {
        let key = if number % 100 < 50 {
            "ArrowRight"
        } else {
            "ArrowLeft"
        };
        browser.key_event("keyDown", key, 0);
        std::thread::sleep(std::time::Duration::from_millis(30));
    }
    browser.until(QUIET);
    report(
        browser,
        "an arrow held for 10 s: the carried motion",
        "motion",
        0,
    );
}

/// One row: until it is drawn on the page's canvas, and until the next picture of the screen is made of it.
fn report(browser: &mut Chromium, what: &str, kind: &str, level: u32) {
    let drawn = Times::of(browser, kind, level, "drawn");
    let seen = Times::of(browser, kind, level, "ms");
    println!(
        "{what:46} {:9.1} {:9.1} {:9.1} {:9.1} {:6}",
        drawn.at(50),
        drawn.at(95),
        seen.at(50),
        seen.at(95),
        seen.0.len()
    );
}

/// Times in ascending order, ms.
struct Times(Vec<f64>);

impl Times {
    /// Those of one of the page's entries.
    fn of(browser: &mut Chromium, kind: &str, level: u32, entry: &str) -> Self {
        let expression = format!(
            "impactid.timings.filter((t) => t.kind === '{kind}' && t.level === {level}).map((t) => t.{entry})"
        );
        let found = browser.evaluate(&expression);
        let found = found.as_array().expect("a list").iter();
        let mut times: Vec<f64> = found.filter_map(serde_json::Value::as_f64).collect();
        times.sort_by(f64::total_cmp);
        Self(times)
    }

    /// The time that so many hundredths of the keys did not exceed.
    fn at(&self, share: usize) -> f64 {
        let place = (share * self.0.len().saturating_sub(1) + 50) / 100;
        self.0.get(place).copied().unwrap_or(f64::NAN)
    }
}
