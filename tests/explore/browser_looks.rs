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

/// What the stripes name at places (η, ρ): `at(eta, rho)`.
const BESIDE: &str = "window.at = (eta, rho) => { const { other } = impactid.map, [w, h] = other.size; \
     return other.styles[other.cells[Math.round((rho - other.rho[0]) / (other.rho[1] - other.rho[0]) * (h - 1)) * w + Math.round((eta - other.eta[0]) / (other.eta[1] - other.eta[0]) * (w - 1))]].label; }; true";

/// Everywhere between grazing and the saddle-node z = 0 and z = 1 coexist, above it they do not: the places at which
/// the stripes say something else.
const HYSTERESIS: &str = "(() => { const { curves, other } = impactid.map, s2 = curves['s2:1'], graze = curves.grazing.rho, wrong = []; let seen = 0; \
     s2.eta.forEach((eta, i) => { if (eta < 1 || !(s2.exists[i] > 0 && graze[i] < s2.rho[i])) return; \
       const step = (other.rho[1] - other.rho[0]) / (other.size[1] - 1), room = s2.rho[i] - graze[i] - 4 * step; \
       for (const share of room > 0 ? [0, 0.5, 1] : []) { seen++; const rho = graze[i] + 2 * step + share * room; if (rho < other.rho[1] && !['0 · 1', '1 · 0'].includes(at(eta, rho))) wrong.push([eta, rho, at(eta, rho)]); } \
       if (s2.rho[i] + 2 * step < other.rho[1] && eta > 1.1 && at(eta, s2.rho[i] + 2 * step) !== '0') wrong.push([eta, 'above', at(eta, s2.rho[i] + 2 * step)]); }); \
     return seen < 100 ? `only ${seen} places` : wrong; })()";

#[test]
#[ignore = "needs chromium"]
fn browser_where_motions_coexist_the_map_is_striped_and_names_both() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let there = "impactid.map.other?.id === impactid.wire.newest.map && Object.keys(impactid.map.curves).every((k) => !k.startsWith('s') || k === 'sticking' || impactid.map.curves[k].exists)";
    // up to the saddle-node near resonance, which no start from rest reaches
    browser.evaluate("impactid.look([0.9, 1.9], [0.2, 9])");
    browser.until(QUIET);
    browser.until(there);
    browser.evaluate(BESIDE);
    assert_eq!(browser.evaluate(HYSTERESIS), json!([]));
    browser.until("impactid.map.labels.some((l) => l.text === '0 · 1')");
    let striped = "(() => { const f = impactid.map.frame, c = document.getElementById('map-tiles').getContext('2d'); \
         const colours = (eta, rho) => new Set(Array.from({ length: 40 }, (_, i) => c.getImageData(f.px(eta) + i, f.py(rho), 1, 1).data.join())).size; \
         return colours(1.3, 2.5) > 1 && colours(1.7, 6) === 1; })()";
    browser.until(striped);
    let place = "(() => { const f = impactid.map.frame, b = document.getElementById('map').getBoundingClientRect(); return [b.left + f.px(1.3), b.top + f.py(2.5)]; })()";
    let place = browser.evaluate(place);
    let moved = json!({"type": "mouseMoved", "x": place[0], "y": place[1]});
    browser.call("Input.dispatchMouseEvent", moved);
    browser.until("document.getElementById('map').title === 'z = 0 and z = 1 coexist'");
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_map_of_a_slow_machine_is_striped_too() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.parameters({ asymmetry: { ...impactid.state.asymmetry, stiffness: 0.98 } }); impactid.look([1.2, 1.6], [0.5, 6])");
    browser.until(QUIET);
    browser.until("impactid.map.other?.id === impactid.wire.newest.map");
    browser.evaluate(BESIDE);
    let both = browser.evaluate("[at(1.3, 2.5), at(1.5, 5.5), at(1.3, 0.7)]");
    assert_eq!(both, json!(["0 · 1", "0", "1"]));
}
