//! The map in a browser, pixel by pixel.

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, STUDIES};

/// From now on the page notes which label was sent for which cell of which tile.
const NOTED: &str = "(() => { window.sent = new Map(); const of = impactid.map.tile.bind(impactid.map); \
     impactid.map.tile = (f) => { const t = of(f); \
       if (!sent.has(t)) sent.set(t, []); \
       f.cell.forEach((c, i) => { sent.get(t)[f.first_row * f.size[0] + i] = f.motions[c]; }); \
       return t; }; })()";

/// What is wrong with the finest tile and its legend: cells whose pixel is not the tint of the motion that was
/// sent; `null` where nothing is.
const WRONG: &str = "(async () => { const { tint, named } = await import('/draw.js'); \
     const tile = impactid.map.tiles.at(-1), styles = sent.get(tile), [w, h] = tile.size; \
     const { data } = tile.canvas.getContext('2d').getImageData(0, 0, w, h); \
     let wrong = 0; const counts = new Map(), tints = new Map(); \
     for (let k = 0; k < h; k++) for (let i = 0; i < w; i++) { \
       const s = styles[k * w + i], at = 4 * ((h - 1 - k) * w + i); \
       if (!tints.has(s.label)) tints.set(s.label, tint(s)); \
       const want = tints.get(s.label); \
       if (want.some((v, n) => v !== data[at + n]) || data[at + 3] !== 255) wrong++; \
       counts.set(s.label, (counts.get(s.label) ?? 0) + 1); } \
     const most = [...counts].sort((a, b) => b[1] - a[1])[0][0]; \
     const legend = document.getElementById('legend').textContent; \
     window.greatest = Math.max(window.greatest ?? 0, counts.size); \
     return wrong === 0 && legend.includes(named({ label: most })) ? null : \
       `${wrong} of ${w * h} cells, ${counts.size} motions, most z = ${most}: ${legend}`; })()";

/// The states of all demos that have maps of their own.
const PLANES: &str = "(async () => { const all = new Map(); \
     for (const name of impactid.demos) { \
       const demo = await impactid.wire.once({ kind: 'demo', name }); \
       for (const { state: s } of demo.steps) all.set(JSON.stringify([s.damping_ratio, s.restitution, s.single, s.asymmetry, s.view, s.map_start]), [name, s]); } \
     window.planes = [...all.values()]; return planes.length; })()";

#[test]
#[ignore = "needs chromium"]
fn browser_every_cell_of_the_demos_maps_is_the_motion_that_was_sent() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate(NOTED);
    let planes = browser.evaluate(PLANES).as_u64().unwrap();
    assert!(planes >= 10, "{planes}");
    for number in 0..planes {
        browser.evaluate(&format!(
            "impactid.set({{ ...planes[{number}][1], panel: 'motion' }}, ['map', 'boundaries'])"
        ));
        browser.until(QUIET);
        let wrong = browser.evaluate(WRONG);
        let name = browser.evaluate(&format!("planes[{number}][0]"));
        assert!(wrong.is_null(), "{name}: {wrong}");
    }
    let greatest = browser.evaluate("greatest").as_u64().unwrap();
    assert!(greatest > 500, "{greatest} motions at most");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_every_study_opens_under_its_title_with_every_cell_right() {
    let files = std::fs::read_dir(STUDIES).expect("studies");
    let files: Vec<_> = files.map(|f| f.expect("a file").path()).collect();
    assert!(files.len() >= 9, "{files:?}");
    for file in files {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(&file).expect("a study");
        let line = text.lines().find(|l| l.starts_with("title = "));
        let title = line
            .expect("a title")
            .trim_start_matches("title = ")
            .trim_matches('"');
        let explorer = Explorer::start(&[&name], &std::env::temp_dir());
        let mut browser = Chromium::open(&explorer.url(), SIZE);
        browser.evaluate(NOTED);
        browser.evaluate("impactid.refresh(['map'])");
        let shown = "document.getElementById('title').textContent + document.title";
        let shown = browser.evaluate(shown);
        let shown = shown.as_str().expect("a text");
        assert_eq!(shown.matches(title).count(), 2, "{name}: {shown}");
        browser.until(QUIET);
        let wrong = browser.evaluate(WRONG);
        assert!(wrong.is_null(), "{name}: {wrong}");
    }
}
