//! What is said on the pictures.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE};

#[test]
#[ignore = "needs chromium"]
fn browser_boundaries_are_named_and_sweeps_lie_apart() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.until("impactid.map.names?.some((n) => n.text === 's₂(1)')");
    browser.until("impactid.map.names.some((n) => n.text === 's₁(1/2)')");
    // a record of a sweep up and one of a sweep down at the same setting
    let apart = "(() => { const all = impactid.campaign.placed(impactid.map.frame); \
         const f = impactid.map.frame, at = (p) => p.y - f.py(impactid.campaign.at(p.r.frequency_hz, p.r)[1]); \
         return all.filter((p) => p.r.sweep !== 'unknown').map(at).every((d) => Math.abs(d) === 4); })()";
    assert_eq!(browser.evaluate(apart), json!(true));
    let residuals = browser.evaluate("document.getElementById('residuals').textContent");
    let residuals = residuals.as_str().unwrap();
    assert!(residuals.contains("(not in the joint fit)"), "{residuals}");
    let red = browser.evaluate("document.querySelectorAll('#residuals .worse').length");
    assert_eq!(red, json!(0), "{residuals}");
    browser.key("t", 0);
    browser.evaluate("impactid.nearest()");
    browser.until("impactid.campaign.frame?.shown !== undefined");
    let key = browser.evaluate("document.getElementById('record-evidence').textContent");
    assert!(!key.as_str().unwrap().contains("Black"), "{key}");
}

#[test]
#[ignore = "needs chromium"]
fn browser_ticks_and_phases_have_no_dust() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let longest = "(async () => { const { around, ticks } = await import('/draw.js'); \
         return Math.max(...[0.1, 1e-3, 3.2, 700, -0.07].flatMap((v) => { const [a, b] = around([[v, v]]), t = ticks(a, b, 4); return t.all.map((x) => t.text(x).length); })); })()";
    let longest = browser.evaluate(longest).as_u64().unwrap();
    assert!(longest <= 8, "{longest}");
    let numbers = "document.getElementById('numbers').textContent";
    for phase in ["8.5265e-14", "2 * Math.PI - 1e-13"] {
        browser.evaluate(&format!(
            "impactid.start({{ x: 0, vx: 0, y: 0, vy: 0 }}, {phase})"
        ));
        browser.until(QUIET);
        browser.until(&format!("{numbers}.includes('phase φ0 rad')"));
    }
    // the swing is seen where the greatest displacement is the contact's
    browser.key("h", 0);
    browser.until("impactid.line.done === true");
    let swing = browser.evaluate(
        "impactid.line.ways.up.x_min.every((v, i) => v < impactid.line.ways.up.x_max[i] - 0.1)",
    );
    assert_eq!(swing, json!(true));
}

#[test]
#[ignore = "needs chromium"]
fn browser_where_motions_coexist_the_map_is_striped_and_names_both() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.until("impactid.map.other?.id === impactid.wire.newest.map");
    // between grazing and the saddle-node z = 0 and z = 1 coexist: at η = 1.3 from 1.4 to 4.15
    let both = "(() => { const { other } = impactid.map, [w, h] = other.size; \
         const at = (eta, rho) => other.styles[other.cells[Math.round((rho - other.rho[0]) / (other.rho[1] - other.rho[0]) * (h - 1)) * w + Math.round((eta - other.eta[0]) / (other.eta[1] - other.eta[0]) * (w - 1))]].label; \
         return [at(1.3, 2.5), at(1.3, 6), at(1.3, 0.7)]; })()";
    assert_eq!(browser.evaluate(both), json!(["0 · 1", "0", "1"]));
    browser.until("impactid.map.labels.some((l) => l.text === '0 · 1')");
    let striped = "(() => { const f = impactid.map.frame, c = document.getElementById('map-tiles').getContext('2d'); \
         const colours = (eta, rho) => new Set(Array.from({ length: 40 }, (_, i) => c.getImageData(f.px(eta) + i, f.py(rho), 1, 1).data.join())).size; \
         return colours(1.3, 2.5) > 1 && colours(2, 6) === 1; })()";
    browser.until(striped);
}
