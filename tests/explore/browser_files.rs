//! What a browser saves, and that a picture is of one machine.

use serde_json::{Value, json};

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE, STUDIES};

/// The stripes of coexisting motions, which come last, are there.
const STRIPED: &str = "impactid.map.other?.id === impactid.wire.newest.map";

/// From now on files are kept by the page instead of being saved.
const KEPT: &str = "(() => { window.kept = new Map(); const made = new Map(); \
     URL.createObjectURL = (blob) => { const url = `blob:kept/${made.size}`; made.set(url, blob); return url; }; \
     HTMLAnchorElement.prototype.click = function () { const blob = made.get(this.href); kept.set(this.download, null); \
       if (blob.type.startsWith('image/png')) createImageBitmap(blob).then((b) => kept.set(this.download, b)); \
       else blob.text().then((t) => kept.set(this.download, t)); }; })()";

/// Choose an entry of the exports.
fn export(browser: &mut Chromium, beginning: &str) {
    browser.key("x", 0);
    browser.until("document.getElementById('dialog').open");
    browser.evaluate(&format!(
        "[...document.querySelectorAll('#dialog button')].find((b) => b.textContent.startsWith('{beginning}')).click()"
    ));
}

fn kept(browser: &mut Chromium, name: &str) -> Value {
    browser.until(&format!("Boolean(kept.get('{name}'))"));
    browser.evaluate(&format!("kept.get('{name}')"))
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_svg_shows_what_is_seen() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.until(STRIPED);
    browser.evaluate("document.fonts.ready.then(() => true)");
    browser.evaluate(KEPT);
    browser.evaluate("void impactid.said('a passing hint', 1e6)");
    export(&mut browser, "SVG");
    let svg = kept(&mut browser, "explorer.svg");
    let svg = svg.as_str().unwrap();
    let parsed = "(() => { const d = new DOMParser().parseFromString(kept.get('explorer.svg'), 'image/svg+xml'); \
         return { root: d.documentElement.tagName, paths: d.querySelectorAll('path').length, images: d.querySelectorAll('image').length, \
           text: [...d.querySelectorAll('text')].map((t) => t.textContent).join('').replaceAll(' ', '') }; })()";
    let found = browser.evaluate(parsed);
    assert_eq!(found["root"], json!("svg"));
    // the map's cells are a picture; records, brackets, boundaries and curves are lines
    assert!(found["images"].as_u64().unwrap() >= 1, "{found}");
    assert!(found["paths"].as_u64().unwrap() > 300, "{found}");
    let text = found["text"].as_str().unwrap();
    let shown = browser.evaluate(
        "[...document.querySelectorAll('#legend > span, #numbers dt, #numbers dd, #residuals b')].map((e) => e.lastChild.textContent.replaceAll(' ', '')) \
         .concat([...document.querySelectorAll('.slider input[type=text]')].map((e) => e.value)).filter(Boolean)",
    );
    for part in shown.as_array().unwrap() {
        assert!(
            text.contains(part.as_str().unwrap()),
            "{part} is not in: {text}"
        );
    }
    for part in [
        "clearanceratio",
        "drivefrequency,Hz",
        "autocorrelation",
        "η=",
        "impactidSynthetic",
        "dampingβ",
    ] {
        assert!(text.contains(part), "{part} is not in: {text}");
    }
    assert!(!text.contains("passinghint"), "{text}");
    assert!(!svg.contains("undefined") && !svg.contains("NaN"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_png_has_the_keys_the_numbers_and_the_whole_title() {
    let study = format!("{STUDIES}/soft-contact.toml");
    let explorer = Explorer::start(&[&study], &std::env::temp_dir());
    for size in [SIZE, (390, 844)] {
        let mut browser = Chromium::open(&explorer.url(), size);
        browser.until(QUIET);
        browser.until(STRIPED);
        browser.evaluate("document.fonts.ready.then(() => true)");
        browser.evaluate(KEPT);
        export(&mut browser, "PNG");
        browser.until("Boolean(kept.get('explorer.png'))");
        // within the place of each key, number and line of the title there is ink, and none at the edges
        let empty = "(() => { const b = kept.get('explorer.png'), canvas = new OffscreenCanvas(b.width, b.height), c = canvas.getContext('2d'); \
             c.drawImage(b, 0, 0); \
             const all = [...document.querySelectorAll('main canvas, #legend, #readout, #numbers, h1')].filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect()); \
             const left = Math.floor(Math.min(...all.map((b) => b.left))) - 12, top = Math.floor(Math.min(...all.map((b) => b.top))) - 12; \
             const ink = (x, y, w, h) => { const d = c.getImageData(x, y, w, h).data; let n = 0; for (let i = 0; i < d.length; i += 4) if (d[i] + d[i + 1] + d[i + 2] < 400) n++; return n; }; \
             const parts = [...document.querySelectorAll('#legend > span, #numbers dt, #numbers dd, #readout')].map((e) => [e.textContent, e.getBoundingClientRect()]); \
             const lines = [...document.getElementById('title').getClientRects()].map((r) => ['the end of a line of the title', new DOMRect(r.right - 30, r.top, 30, r.height)]); \
             const edges = [ink(0, 0, 3, b.height), ink(b.width - 3, 0, 3, b.height)].some((n) => n > 0) ? ['an edge has ink'] : []; \
             return [...parts, ...lines].filter(([, r]) => ink(r.left - left, r.top - top, r.width, r.height) < 8).map(([t]) => t).concat(edges); })()";
        assert_eq!(browser.evaluate(empty), json!([]), "{size:?}");
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_open_record_is_exported_with_its_simulation() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate(KEPT);
    browser.evaluate(
        "impactid.choose(impactid.campaign.facts.records.find((r) => r.motion.label === '1/2'))",
    );
    browser.until("impactid.campaign.frame?.stated?.motion?.label === '1/2'");
    export(&mut browser, "CSV");
    browser.until("[...kept.keys()].some((n) => n.endsWith('-impacts.csv'))");
    let name = browser.evaluate("[...kept.keys()].find((n) => n.includes('displacement_x'))");
    let table = kept(&mut browser, name.as_str().unwrap());
    let table = table.as_str().unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("time_s,measured_m,simulated,difference"));
    let mut rows = 0;
    for line in lines {
        let values: Vec<f64> = line
            .split(',')
            .map(|v| v.parse().unwrap_or(f64::NAN))
            .collect();
        let [_, measured, simulated, difference] = values[..] else {
            panic!("{line}");
        };
        if difference.is_finite() {
            let size = measured.abs().max(simulated.abs());
            let off = (measured - simulated).abs() - difference.abs();
            assert!(off.abs() <= 1e-4 * size.max(1e-6), "{line}");
            rows += 1;
        }
    }
    assert!(rows > 500, "{rows}");
    let motion = browser.evaluate("kept.has('motion.csv')");
    assert_eq!(motion, json!(false));
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_map_that_is_being_replaced_is_faint() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    // opacity of the map high up, where the strips of a slow map come last
    let opacity = "(() => { const c = document.getElementById('map-tiles'), b = impactid.map.frame.box; \
         return c.getContext('2d').getImageData(b.left + b.width - 30, b.top + 20, 1, 1).data[3] / 255; })()";
    assert_eq!(browser.evaluate(opacity), json!(1));
    browser.evaluate(
        "impactid.parameters({ asymmetry: { ...impactid.state.asymmetry, stiffness: 0.95 } })",
    );
    browser.until("impactid.map.tiles.some((t) => t.id === impactid.wire.newest.map && t.filled > 0 && !t.complete)");
    let both =
        format!("[impactid.map.tiles.every((t) => t.id === impactid.wire.newest.map), {opacity}]");
    let while_filling = browser.evaluate(&both);
    // names and legend of the map before are hidden and faint until there are new ones
    let of_before = "impactid.map.cells128?.id !== impactid.wire.newest.map";
    let hidden =
        "impactid.map.unnamed && document.getElementById('legend').classList.contains('late')";
    browser.until(&format!("!({of_before}) || ({hidden})"));
    let alone = while_filling[0] == json!(true);
    assert!(
        alone || while_filling[1].as_f64().unwrap() < 0.25,
        "{while_filling}"
    );
    browser.until(QUIET);
    assert_eq!(browser.evaluate(opacity), json!(1));
    let late = browser.evaluate("document.getElementById('legend').classList.contains('late')");
    assert_eq!(late, json!(false));
    // a slider that is dragged asks for another map before the one before is there
    let crisp = "(async () => { const { map } = impactid; let crisp = 0, last = performance.now(); \
         for (let i = 1; i <= 24; i++) { impactid.parameters({ damping_ratio: 0.07 + 0.004 * i }); await new Promise((done) => setTimeout(done, 40)); \
           const there = map.cells128?.id === impactid.wire.newest.map, old = map.tiles.some((t) => t.id !== impactid.wire.newest.map && !map.isOld(t)); \
           const faint = !old && map.unnamed && document.getElementById('legend').classList.contains('late'); \
           if (there || faint) last = performance.now(); \
           crisp = Math.max(crisp, performance.now() - last); } \
         return crisp < 300; })()";
    assert_eq!(browser.evaluate(crisp), json!(true));
    browser.until(QUIET);
    assert_eq!(browser.evaluate(opacity), json!(1));
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_campaign_without_records_leads_back_to_what_it_found() {
    let campaign = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data-samples/published-speeds/campaign.toml"
    );
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("results");
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["-q", "run", campaign, "--out"])
        .arg(&results)
        .status();
    assert!(run.is_ok_and(|status| status.code() < Some(2)));
    // by its results and by itself
    for given in [&*results.to_string_lossy(), campaign] {
        let explorer = Explorer::start(&[given], folder.path());
        let mut browser = Chromium::open(&explorer.url(), SIZE);
        browser.until(QUIET);
        assert_eq!(
            browser.evaluate("document.getElementById('tab-record').hidden"),
            json!(true)
        );
        let found = browser.evaluate("impactid.state.damping_ratio");
        browser.evaluate("impactid.parameters({ damping_ratio: 0.2 })");
        browser.key("z", 0);
        assert_eq!(browser.evaluate("impactid.state.damping_ratio"), found);
        browser.until(QUIET);
        assert_eq!(browser.errors(), Vec::<String>::new());
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_results_without_their_records_show_map_boundaries_and_fit() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["campaign.resolved.json", "identification.json"] {
        let example = concat!(env!("CARGO_MANIFEST_DIR"), "/reports/example");
        std::fs::copy(format!("{example}/{name}"), folder.path().join(name)).unwrap();
    }
    let explorer = Explorer::start(&["."], folder.path());
    let mut browser = Chromium::open(&explorer.url(), (390, 844));
    browser.until("document.getElementById('message').textContent.includes('cannot be shown')");
    let place = browser.evaluate(
        "/Not in (\\S+) any more/.exec(document.getElementById('message').textContent)[1]",
    );
    assert!(
        place
            .as_str()
            .is_some_and(|p| p.starts_with('/') && p.contains("double-oscillator")),
        "{place}"
    );
    let wide = browser.evaluate("document.getElementById('message').offsetWidth");
    assert!(wide.as_f64() > Some(350.0), "{wide}");
    browser.until(QUIET);
    browser.until("impactid.campaign.fit !== null && impactid.map.labels.length > 1");
    browser.until("Object.values(impactid.map.curves).some((c) => c.exists)");
    browser.evaluate("impactid.choose(impactid.campaign.facts.records[0])");
    let why = "document.querySelector('#traces .bad')?.textContent";
    browser.until(&format!("{why} !== undefined"));
    let (why, hint) = (browser.evaluate(why), "which file is missing");
    assert!(
        why.as_str().is_some_and(|w| w.contains(".h5")),
        "{hint}: {why}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}
