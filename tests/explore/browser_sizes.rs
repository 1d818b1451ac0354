//! The page at every size: nothing is cut, nothing covers another, nothing grows.

use serde_json::{Value, json};

use super::chromium::Chromium;
use super::server::{Explorer, QUIET, SAMPLE};

/// Phone, 200 % of 1280 × 800, and screens.
const SIZES: [(u32, u32); 5] = [
    (390, 844),
    (640, 400),
    (1024, 768),
    (1280, 800),
    (1920, 1080),
];

/// What is wrong with the boxes of what is shown.
const FAULTS: &str = "(() => { const faults = [], box = (e) => e.getBoundingClientRect(); \
     const shown = (e) => e.checkVisibility() && box(e).width > 0; \
     const name = (e) => e.id || e.className || e.textContent || e.tagName; \
     const all = (query) => [...document.querySelectorAll(query)].filter(shown); \
     if (document.documentElement.scrollWidth > innerWidth) faults.push('the page is wider than its window'); \
     for (const e of all('#legend, #readout, .legend, #residuals, #sliders, h1, #numbers')) \
       if (e.scrollHeight > e.clientHeight + 1 || e.scrollWidth > e.clientWidth + 1) faults.push(`${name(e)} is cut`); \
     for (const e of all('button, input, select, canvas, dt, dd, h1, #legend > span')) \
       if (box(e).left < -1 || box(e).right > innerWidth + 1) faults.push(`${name(e)} leaves the window`); \
     for (const e of all('input, button, select')) if (box(e).height < 24) faults.push(`${name(e)} is ${box(e).height} px high`); \
     for (const e of all('input[type=range]')) if (box(e).width < 100) faults.push(`a track of ${box(e).width} px`); \
     for (const e of all('canvas:not(#legend canvas)')) if (box(e).height < 60) faults.push(`${name(e)} is ${box(e).height} px high`); \
     for (const parent of all('body, #left, #right, .panel, #sliders, header, .row')) { \
       const inside = [...parent.children].filter((e) => shown(e) && getComputedStyle(e).position !== 'fixed'); \
       inside.forEach((a, i) => inside.slice(i + 1).forEach((b) => { \
         const [p, q] = [box(a), box(b)]; \
         const across = Math.min(p.right, q.right) - Math.max(p.left, q.left), down = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top); \
         if (across > 1 && down > 1) faults.push(`${name(a)} and ${name(b)} overlap`); })); } \
     const map = box(document.getElementById('mapbox')).height; \
     if (map < Math.max(250, 0.5 * innerHeight)) faults.push(`the map is ${map} px high`); \
     return faults; })()";

/// The motion under the longest title of the sample studies.
const TITLE: &str = "panel('motion'); document.getElementById('title').textContent = \
     'Soft contact: z = 1 at eta = 1.25, rho = 1 as the contact stiffens to the rigid one (last)'";

/// From now on the page notes texts that leave their picture.
pub(super) const CUT: &str = "(() => { window.cut = new Set(); const of = CanvasRenderingContext2D.prototype, fill = of.fillText; \
     of.fillText = function (text, x, y) { \
       const wide = this.measureText(text).width, left = { left: 0, center: wide / 2, right: wide }[this.textAlign], m = this.getTransform(); \
       for (const by of [-left, wide - left]) { const p = m.transformPoint({ x: x + by, y }); \
         if (this.canvas.isConnected && (p.x < -1 || p.y < -1 || p.x > this.canvas.width + 1 || p.y > this.canvas.height + 1)) cut.add(`${text} in ${this.canvas.id}`); } \
       fill.call(this, text, x, y); }; return true; })()";

/// What is wrong with the open dialog.
const DIALOG: &str = "(() => { const d = document.getElementById('dialog'), faults = []; \
     if (d.scrollWidth > d.clientWidth + 1) faults.push('the dialog is wider than its box'); \
     for (const e of [d, ...d.querySelectorAll('label, input, button, select, textarea, p, h2')]) { const b = e.getBoundingClientRect(); \
       if (b.width > 0 && (b.left < 0 || b.right > innerWidth)) faults.push(`${e.textContent || e.tagName} leaves the window`); } \
     return faults; })()";

fn without_faults(browser: &mut Chromium, where_: &str) {
    let faults = browser.evaluate(FAULTS);
    assert_eq!(faults, json!([]), "{where_}");
    assert_eq!(browser.evaluate("[...cut]"), json!([]), "{where_}");
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_caption_of_a_demo_covers_no_key() {
    let explorer = Explorer::theory();
    for size in &SIZES[2..] {
        let mut browser = Chromium::open(&explorer.url(), *size);
        browser.until(QUIET);
        browser.key("3", 0);
        browser.until(
            "!document.getElementById('caption').hidden && impactid.basins.tile?.filled > 0",
        );
        let covered = "(() => { const c = document.getElementById('caption').getBoundingClientRect(); \
             return [...document.querySelectorAll('#legend > span, #basin-shares > span, #readout, canvas')].filter((e) => e.checkVisibility()) \
               .filter((e) => { const b = e.getBoundingClientRect(); return b.left < c.right && b.right > c.left && b.top < c.bottom && b.bottom > c.top; }) \
               .map((e) => e.id || e.textContent); })()";
        assert_eq!(browser.evaluate(covered), json!([]), "{size:?}");
        // that of a demo that plays stays for long, and covers no field and no button either
        browser.evaluate("void impactid.player.start(impactid.demos[2])");
        browser.until("document.querySelector('#caption.demo:not([hidden])') !== null");
        browser.until(QUIET);
        let all = covered.replace("canvas'", "canvas, input, button, h1, #residuals'");
        assert_eq!(browser.evaluate(&all), json!([]), "{size:?}");
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_dialogs_fit_a_phone_and_twice_the_size() {
    let explorer = Explorer::theory();
    for size in &SIZES[..2] {
        let mut browser = Chromium::open(&explorer.url(), *size);
        browser.until(QUIET);
        for key in ["a", "b", "c", "d", "e", "n", "f", "x", "?"] {
            browser.key(key, 0);
            browser.until("document.getElementById('dialog').open");
            assert_eq!(browser.evaluate(DIALOG), json!([]), "{key} at {size:?}");
            browser.key("Escape", 0);
            browser.until("!document.getElementById('dialog').open");
        }
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_nothing_is_cut_or_covered_at_any_size() {
    let theory = Explorer::theory();
    let campaign = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    for explorer in [&theory, &campaign] {
        for size in SIZES {
            let mut browser = Chromium::open(&explorer.url(), size);
            browser.evaluate(CUT);
            browser.until(QUIET);
            for action in [
                "panel('motion')",
                // hundreds of motions with long names
                "parameters({ restitution: 0.6 }); impactid.look([0.3, 5], [-1.1, 7])",
                "along('eta')",
                "panel('basins')",
                "nearest?.()",
                TITLE,
            ] {
                browser.evaluate(&format!("void impactid.{action}"));
                browser.until(QUIET);
                browser.evaluate("new Promise((done) => setTimeout(done, 150))");
                without_faults(&mut browser, &format!("{action} at {size:?}"));
            }
            assert_eq!(browser.errors(), Vec::<String>::new());
        }
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_no_picture_grows_while_the_motion_moves() {
    let explorer = Explorer::theory();
    let heights = "[...document.querySelectorAll('canvas, #panel')].map((e) => e.getBoundingClientRect().height)";
    for size in SIZES {
        let mut browser = Chromium::open(&explorer.url(), size);
        browser.until(QUIET);
        browser.key("ArrowRight", 0);
        browser.until(QUIET);
        let before = browser.evaluate(heights);
        for _ in 0..10 {
            browser.key("ArrowRight", 0);
            browser.until(QUIET);
        }
        browser.key("g", 0);
        browser.until("impactid.motion.live?.end > 2");
        browser.key("g", 0);
        browser.until(QUIET);
        assert_eq!(browser.evaluate(heights), before, "{size:?}");
    }
}

/// The middle of an element in the window.
fn middle(browser: &mut Chromium, id: &str) -> Value {
    let place = format!(
        "(() => {{ const e = document.getElementById('{id}'); e.scrollIntoView({{ block: 'center' }}); \
         const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]; }})()"
    );
    browser.evaluate(&place)
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_finger_scrolls_the_page_and_drags_the_cursor() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZES[0]);
    let touch = json!({"enabled": true, "maxTouchPoints": 2});
    browser.call("Emulation.setTouchEmulationEnabled", touch);
    browser.until(QUIET);
    for picture in ["phase", "poincare", "autocorrelation", "series"] {
        let at = middle(&mut browser, picture);
        let before = browser.evaluate("scrollY").as_f64().unwrap();
        drag(&mut browser, &at);
        browser.until(&format!("{before} - scrollY > 60"));
    }
    let at = middle(&mut browser, "map");
    // two fingers zoom the page: the cursor stays
    let before = browser.evaluate("impactid.state.cursor");
    let (x, y) = (at[0].as_f64().unwrap(), at[1].as_f64().unwrap());
    for (kind, apart) in [
        ("touchStart", None),
        ("touchStart", Some(60.0)),
        ("touchMove", Some(90.0)),
    ] {
        let second = apart.map(|by| json!({"x": x + by, "y": y, "id": 1}));
        let first = json!({"x": x - apart.map_or(0.0, |by| by - 60.0), "y": y, "id": 0});
        let points: Vec<Value> = std::iter::once(first).chain(second).collect();
        browser.call(
            "Input.dispatchTouchEvent",
            json!({"type": kind, "touchPoints": points}),
        );
    }
    browser.call(
        "Input.dispatchTouchEvent",
        json!({"type": "touchEnd", "touchPoints": []}),
    );
    assert_eq!(browser.evaluate("impactid.state.cursor"), before);
    browser.call("Emulation.resetPageScaleFactor", json!({}));
    let at = middle(&mut browser, "map");
    let scrolled = browser.evaluate("scrollY");
    let cursor = browser
        .evaluate("impactid.state.cursor.rho")
        .as_f64()
        .unwrap();
    drag(&mut browser, &at);
    browser.until(QUIET);
    let dragged = browser
        .evaluate("impactid.state.cursor.rho")
        .as_f64()
        .unwrap();
    assert!((dragged - cursor).abs() > 0.3, "{cursor} {dragged}");
    assert_eq!(browser.evaluate("scrollY"), scrolled);
}

/// A finger set down at a place, drawn downwards, and lifted.
fn drag(browser: &mut Chromium, at: &Value) {
    let (x, y) = (at[0].as_f64().unwrap(), at[1].as_f64().unwrap());
    for (kind, by) in [
        ("touchStart", 0.0),
        ("touchMove", 20.0),
        ("touchMove", 60.0),
        ("touchMove", 120.0),
    ] {
        let point = json!({"type": kind, "touchPoints": [{"x": x, "y": y + by}]});
        browser.call("Input.dispatchTouchEvent", point);
        std::thread::sleep(std::time::Duration::from_millis(30));
    }
    let end = json!({"type": "touchEnd", "touchPoints": []});
    browser.call("Input.dispatchTouchEvent", end);
}
