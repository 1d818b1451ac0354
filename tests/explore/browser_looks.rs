//! What is said on the pictures.

use serde_json::json;

use super::browser_sizes::CUT;
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
    // the legend has the boundaries that are in view
    let legend = "document.getElementById('legend').textContent";
    let view = browser.evaluate("JSON.stringify(impactid.state.view)");
    for (rho, listed) in [("[-1.1, 4]", true), ("[0, 4]", false)] {
        browser.evaluate(&format!("impactid.look([1.2, 3], {rho})"));
        browser.until(QUIET);
        browser.until(&format!("{legend}.includes('stay together') === {listed}"));
    }
    browser.evaluate(&format!(
        "(({{ eta, rho }}) => impactid.look(eta, rho))(JSON.parse({view}))"
    ));
    browser.until(QUIET);
    // a record of a sweep up and one of a sweep down at the same setting
    let apart = "(() => { const all = impactid.campaign.placed(impactid.map.frame); \
         const f = impactid.map.frame, at = (p) => p.y - f.py(impactid.campaign.at(p.r.frequency_hz, p.r)[1]); \
         return all.filter((p) => p.r.sweep !== 'unknown' && p.strip < 0).map(at).every((d) => Math.abs(d) === 4); })()";
    assert_eq!(browser.evaluate(apart), json!(true));
    let residuals = browser.evaluate("document.getElementById('residuals').textContent");
    let residuals = residuals.as_str().unwrap();
    for why in [
        "(takes the rig as ideal, not in the joint fit)",
        "(in the joint fit by R)",
    ] {
        assert!(residuals.contains(why), "{residuals}");
    }
    let tips = "[...document.querySelectorAll('#residuals span')].map((s) => s.title).join()";
    let tips = browser.evaluate(tips);
    let tips = tips.as_str().unwrap();
    assert!(
        tips.contains("the joint fit rests on the residuals of "),
        "{tips}"
    );
    let red = browser.evaluate("document.querySelectorAll('#residuals .worse').length");
    assert_eq!(red, json!(0), "{residuals}");
    browser.key("t", 0);
    browser.evaluate("impactid.nearest()");
    browser.until("impactid.campaign.frame?.shown !== undefined");
    let key = browser.evaluate("document.getElementById('record-evidence').textContent");
    assert!(!key.as_str().unwrap().contains("Black"), "{key}");
}

/// Clearances far above all impacts do not squeeze the map: they have a strip, as in the report.
#[test]
#[ignore = "needs chromium"]
fn browser_far_clearances_have_a_strip_above_the_map() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let far = "impactid.campaign.placed(impactid.map.frame).filter((p) => p.r.clearance_m > 8e-3)";
    let state = format!(
        "[{far}.length > 10, {far}.every((p) => p.strip === 0), impactid.state.view.rho[1] < 6]"
    );
    assert_eq!(browser.evaluate(&state), json!([true, true, true]));
    // one in the strip is opened by a click, like those on the map
    let place = format!(
        "(() => {{ const p = {far}.find((p) => p.r.sweep === 'up'), b = document.getElementById('map').getBoundingClientRect(); \
         window.wanted = p.r.id; return [b.left + p.x, b.top + p.y]; }})()"
    );
    let place = browser.evaluate(&place);
    let of = |i: usize| place[i].as_f64().expect("a number");
    browser.click((of(0), of(1)));
    browser.until("impactid.state.record === wanted && impactid.state.panel === 'record'");
    // its ring is whole
    let ring = "(() => { const { r, x, y } = impactid.campaign.placed(impactid.map.frame).find((p) => p.r.id === wanted), c = impactid.map.canvas.getContext('2d'); \
         const red = ([r, g, b]) => r > 1.5 * g && r > 1.5 * b; \
         return [-9.6, 9.6].map((by) => red(c.getImageData(Math.round(x), Math.round(y + by), 1, 1).data)); })()";
    browser.until(&format!("{ring}.every((whole) => whole)"));
    // in a view that holds them they are on the map, and no strip is left without them
    browser.evaluate("impactid.look([0.5, 3], [0, 12])");
    browser.until(&format!("{far}.every((p) => p.strip === -1)"));
    assert_eq!(browser.evaluate("impactid.campaign.far"), json!([]));
    // however far the view is, its numbers leave room for the titles
    browser.evaluate(CUT);
    browser.evaluate("impactid.look([1, 1.00000001], [1, 1.00000001])");
    browser.until(QUIET);
    assert_eq!(browser.evaluate("[...cut]"), json!([]));
}

#[test]
#[ignore = "needs chromium"]
fn browser_ticks_and_phases_have_no_dust() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let longest = "(async () => { const { around, ticks } = await import('/draw.js'); \
         return Math.max(...[0, 1e-13, 0.1, 1e-3, 3.2, 700, -0.07].flatMap((v) => { const [a, b] = around([[v, v]]), t = ticks(a, b, 4); return t.all.map((x) => t.text(x).length); })); })()";
    let longest = browser.evaluate(longest).as_u64().unwrap();
    assert!(longest <= 8, "{longest}");
    // a scale has two numbers, and they leave room for its title
    let scales = "(async () => { const { Frame, ticks } = await import('/draw.js'), canvas = document.getElementById('phase'); \
         const few = [[-1.8, 1.8], [-2.1, 0.2], [0.55, 0.64], [-3.9, 3.9]].filter(([a, b]) => ticks(a, b, 2.4).all.length < 2); \
         const narrow = [[-0.0041, 0.0002], [-1.2e-5, 1e-5], [0, 1]].filter((y) => { const f = new Frame(canvas, [0, 1], y, ['', '']), t = ticks(...y, 4); \
           return t.all.some((v) => f.box.left - 5 - f.context.measureText(t.text(v)).width < 20); }); \
         impactid.motion.draw(); return [few, narrow]; })()";
    assert_eq!(browser.evaluate(scales), json!([[], []]));
    // none is cut, however many digits it has and wherever it lies
    browser.evaluate(CUT);
    for view in ["[0.02, 0.03], [0, 1]", "[1, 1.00000001], [1, 1.00000001]"] {
        browser.evaluate(&format!("impactid.look({view})"));
        browser.until(QUIET);
    }
    assert_eq!(browser.evaluate("[...cut]"), json!([]));
    let numbers = "document.getElementById('numbers').textContent";
    for phase in ["8.5265e-14", "2 * Math.PI - 1e-13"] {
        browser.evaluate(&format!(
            "impactid.start({{ x: 0, vx: 0, y: 0, vy: 0 }}, {phase})"
        ));
        browser.until(QUIET);
        browser.until(&format!("{numbers}.includes('phase φ0 rad')"));
        browser.key("a", 0);
        browser.until("document.getElementById('dialog').open");
        let typed = "[...document.querySelectorAll('dialog label')].find((l) => l.textContent.startsWith('phase')).querySelector('input').value";
        assert_eq!(browser.evaluate(typed), json!("0"));
        browser.key("Escape", 0);
        browser.until("!document.getElementById('dialog').open");
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

#[test]
#[ignore = "needs chromium"]
fn browser_stripes_name_what_is_another_motion_after_longer_settling_too() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.look([0.5, 0.95], [0, 1.6])");
    browser.until(QUIET);
    browser.until("impactid.map.other?.id === impactid.wire.newest.map");
    browser.evaluate(BESIDE);
    // beside a period doubling, in transient chaos, and where two motions coexist
    for place in [
        [0.7374, 0.0168],
        [0.5886, 0.1011],
        [0.7409, 0.0505],
        [0.5992, 1.2126],
        [0.6311, 0.8926],
        [0.5425, 1.1621],
    ] {
        let [eta, rho] = place;
        let found = browser.evaluate(&format!(
            "impactid.wire.once({{ kind: 'coexisting' }}, {{ ...impactid.state, \
             cursor: {{ ...impactid.state.cursor, eta: {eta}, rho: {rho} }}, \
             watch: {{ ...impactid.state.watch, settle_periods: 3000 }} }}).then((f) => f.motions.map((m) => m.label))"
        ));
        let named = browser.evaluate(&format!("at({eta}, {rho})"));
        let named: Vec<&str> = named.as_str().unwrap().split(" · ").collect();
        let found = found.as_array().unwrap();
        let confirmed = |label: &&str| found.iter().any(|f| f == label);
        assert!(
            named.len() == 1 || named.iter().all(confirmed),
            "{named:?} at {place:?}: {found:?}"
        );
        assert_eq!(named.len(), found.len().min(2), "{named:?} at {place:?}");
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_names_on_the_map_have_places_of_their_own() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.until("impactid.map.other?.id === impactid.wire.newest.map");
    browser.until("impactid.map.names.some((n) => n.text === 's₂(1)')");
    browser.until("['0', '1'].every((name) => impactid.map.labels.some((l) => l.text === name))");
    for state in [
        "void impactid.home()",
        "void impactid.look([0.6, 1.3], [0.3, 2.4])",
        "void impactid.choose(impactid.campaign.facts.records.find((r) => r.motion.label === '1'))",
    ] {
        browser.evaluate(state);
        browser.until(QUIET);
        browser.until("impactid.map.other?.id === impactid.wire.newest.map");
        browser.until("!impactid.map.unnamed && impactid.map.labels.length > 1 && impactid.map.due.size === 0");
        assert_eq!(browser.evaluate(COVERED), json!([]), "{state}");
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_names_lie_in_their_regions_and_the_key_has_every_mark() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let legend = "document.getElementById('legend').textContent";
    for text in ["left out", "bracket", "95 % band"] {
        browser.until(&format!("{legend}.includes('{text}')"));
    }
    browser.until("impactid.map.names.some((n) => n.text === 'ρ′')");
    // every motion that is measured and shown has its mark, drawn in its sample
    let marks = "[...document.querySelectorAll('#legend canvas')].filter((c) => new Set(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).size > 3).length";
    browser.until(&format!("{marks} >= 5"));
    let outside = "(() => { const { frame: f, labels, regions } = impactid.map, c = document.createElement('canvas').getContext('2d'); \
         return labels.filter(({ text, x, y, font }) => { c.font = font; const wide = c.measureText(text).width / 2; \
           const places = Array.from({ length: 21 }, (_, i) => [f.ux(x + wide * (i / 10 - 1)), f.uy(y)]); \
           return !regions.some((r) => r.text === text && places.filter((p) => r.holds(...p)).length > 16); }).map((l) => l.text); })()";
    browser.until(
        "impactid.map.other?.id === impactid.wire.newest.map && impactid.map.labels.length > 1",
    );
    assert_eq!(browser.evaluate(outside), json!([]));
    let size = json!({"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": false});
    browser.call("Emulation.setDeviceMetricsOverride", size);
    let demo = "impactid.demos.find((d) => d.startsWith('6 '))";
    browser.evaluate(&format!("void impactid.player.start({demo})"));
    browser.until(QUIET);
    browser.evaluate("impactid.player.stop()");
    browser.until(
        "impactid.map.other?.id === impactid.wire.newest.map && impactid.map.due.size === 0",
    );
    assert_eq!(browser.evaluate(outside), json!([]));
}

/// Names on the map that cover a record, a bracket or another name.
const COVERED: &str = "(() => { const { frame: f, labels, names } = impactid.map, c = document.createElement('canvas').getContext('2d'), { campaign } = impactid; \
     const texts = [...labels, ...names].map(({ text, x, y, font }) => { c.font = font; return [text, x, y, c.measureText(text).width / 2, 6]; }); \
     const records = campaign.placed(f).map(({ r, x, y }) => [`record ${r.id}`, x, y, 4, 4]); \
     const brackets = campaign.brackets(f).map(({ x0, x1, y }) => ['a bracket', (x0 + x1) / 2, y, (x1 - x0) / 2, 4]); \
     const marks = [...records, ...brackets].filter(([, x, y]) => f.holds(x, y)); \
     const over = (a, b) => Math.abs(a[1] - b[1]) < a[3] + b[3] && Math.abs(a[2] - b[2]) < a[4] + b[4]; \
     return texts.flatMap((t, i) => [...texts.slice(i + 1), ...marks].filter((other) => over(t, other)).map((other) => `${t[0]} on ${other[0]}`)); })()";

#[test]
#[ignore = "needs chromium"]
fn browser_trajectories_set_into_a_picture_cover_no_curve() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.along('eta')");
    for eta in [0.8, 1.0, 1.4] {
        browser.evaluate(&format!(
            "impactid.carry({eta}, 1); impactid.state.cursor.eta"
        ));
        browser.until(QUIET);
        browser.evaluate("impactid.inset()");
    }
    browser.until("impactid.line.trajectories.size === 3 && [...impactid.line.trajectories.values()].every(Boolean)");
    browser.until("impactid.line.done === true");
    // the frames that are drawn: the picture's own, and those of the trajectories
    let covering = "(() => { const of = CanvasRenderingContext2D.prototype, before = of.strokeRect, all = []; \
         of.strokeRect = function (...box) { if (this.canvas.id === 'line-x') all.push(box); before.call(this, ...box); }; \
         impactid.line.paint(); of.strokeRect = before; \
         const [own, ...insets] = all; \
         return [insets.length, insets.filter(([, top, , height]) => top + height > own[1] || top < 0).length]; })()";
    assert_eq!(browser.evaluate(covering), json!([3, 0]));
}

/// The boundaries of masses that differ come after the map's first tile: the key lists what is drawn at any time.
#[test]
#[ignore = "needs chromium"]
fn browser_the_key_lists_boundaries_as_they_come() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate(
        "(() => { window.missing = new Set(); window.seen = 0; const of = impactid.map.boundary.bind(impactid.map); \
         impactid.map.boundary = (frame) => { of(frame); seen++; const key = document.getElementById('legend').textContent; \
           for (const { text } of impactid.map.kinds()) if (!key.includes(text.replaceAll('*', ''))) missing.add(text); }; })()",
    );
    browser.evaluate(
        "impactid.parameters({ asymmetry: { ...impactid.state.asymmetry, drive_amplitude: 0.95 } })",
    );
    browser.until("seen >= 10");
    let kinds = browser.evaluate("impactid.map.kinds().length").as_u64();
    assert!(kinds >= Some(3), "{kinds:?}");
    assert_eq!(browser.evaluate("[...missing]"), json!([]));
}

#[test]
#[ignore = "needs chromium"]
fn browser_characteristics_of_another_line_are_gone_at_once() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("h", 0);
    browser.until("impactid.line.done === true");
    let left = "(() => { impactid.along('rho'); impactid.line.paint(); return [Object.keys(impactid.line.ways), impactid.line.done]; })()";
    assert_eq!(browser.evaluate(left), json!([[], false]));
    browser.until("impactid.line.done === true && impactid.line.ways.up.rho.at(-1) === impactid.state.view.rho[1]");
}
