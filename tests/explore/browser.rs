//! The page in a browser. These tests need chromium; `scripts/check` runs them where it is installed.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE};

#[test]
#[ignore = "needs chromium"]
fn browser_the_page_draws_and_nothing_leaves_loopback() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    for key in [
        "h", "s", "m", "x", "Escape", "?", "Escape", "t", "g", "Escape", "6", "3",
    ] {
        browser.key(key, 0);
    }
    browser.until(QUIET);
    let own = [
        format!("http://127.0.0.1:{}/", explorer.port),
        format!("ws://127.0.0.1:{}/ws", explorer.port),
    ];
    let requests = browser.requests();
    assert!(requests.len() >= 12, "{requests:?}");
    for url in requests {
        let inside = url == "about:blank" || url.starts_with("data:") || url.starts_with("blob:");
        assert!(inside || own.iter().any(|o| url.starts_with(o)), "{url}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_keyboard_alone_reaches_everything() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let before = browser.evaluate("impactid.state.cursor.eta");
    browser.key("ArrowRight", 0);
    browser.until(QUIET);
    let after = browser.evaluate("impactid.state.cursor.eta");
    let step = after.as_f64().unwrap() - before.as_f64().unwrap();
    assert!((step - 3.0 / 200.0).abs() < 1e-9, "{step}");
    browser.key("ArrowUp", 8);
    browser.until(&format!(
        "Math.abs(impactid.state.cursor.rho - {}) < 1e-9",
        1.0 + 0.35
    ));
    for (key, shown) in [
        ("h", "line"),
        ("s", "basins"),
        ("m", "motion"),
        ("i", "line"),
    ] {
        browser.key(key, 0);
        browser.until(&format!("!document.getElementById('panel-{shown}').hidden"));
        browser.until(&format!("impactid.state.panel === '{shown}'"));
    }
    browser.until("impactid.line.done === true");
    for (key, title) in [
        ("a", "Initial conditions"),
        ("b", "system"),
        ("c", "picture"),
        ("d", "simulation"),
        ("e", "R(v)"),
        ("f", "Demos"),
        ("x", "Export"),
        ("?", "Menu"),
    ] {
        browser.key(key, 0);
        browser.until("document.getElementById('dialog').open");
        let text = browser.evaluate("document.getElementById('dialog-title').textContent");
        assert!(text.as_str().unwrap().contains(title), "{key}: {text}");
        browser.key("Escape", 0);
        browser.until("!document.getElementById('dialog').open");
    }
    // Tab goes round through every button, tab and field, and comes back
    let count = "document.querySelectorAll('button:not([tabindex=\"-1\"]), input, select, [tabindex=\"0\"]').length";
    let stops = browser.evaluate(count).as_u64().unwrap();
    // the page itself notes what is reached: between two questions the focus may move twice
    browser.evaluate(
        "document.activeElement.blur(); window.seen = new Set(); \
         document.addEventListener('focusin', (e) => seen.add(e.target)); true",
    );
    for _ in 0..stops {
        browser.key("Tab", 0);
    }
    browser.until("[...document.querySelectorAll('nav button, #map, .slider input')].every((e) => seen.has(e))");
    // the last Tab may have ended in a field, in which digits are digits: Esc leads back to the map
    browser.key("Escape", 0);
    browser
        .until("document.activeElement.id === 'map' || document.activeElement === document.body");
    for digit in 0..10 {
        browser.key(&digit.to_string(), 0);
    }
    browser.until(
        "impactid.state.restitution?.table === undefined && impactid.state.view.eta[1] === 2.2",
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_address_restores_the_state_in_a_fresh_browser() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.parameters({ restitution: 0.71, damping_ratio: 0.031 })");
    browser.evaluate("impactid.look([0.8, 2.1], [0.2, 3.3]); impactid.carry(1.456, 1.2)");
    browser.until(QUIET);
    browser.evaluate("impactid.panel('basins')");
    let state = browser.evaluate("JSON.stringify(impactid.state)");
    let address = browser.evaluate("location.pathname + '#' + impactid.address()");
    drop(browser);
    let url = format!(
        "http://127.0.0.1:{}{}",
        explorer.port,
        address.as_str().unwrap()
    );
    let mut fresh = Chromium::open(&url, SIZE);
    fresh.until(QUIET);
    assert_eq!(fresh.evaluate("JSON.stringify(impactid.state)"), state);
    let older = url.replace("%22version%22%3A1", "%22version%22%3A0");
    assert_ne!(older, url);
    fresh.go("about:blank");
    fresh.go(&older);
    let message = fresh.evaluate("document.getElementById('message').textContent");
    assert!(message.as_str().unwrap().contains("version 0"), "{message}");
}

/// The key repeats some 30 times a second for ten seconds: when it is let go, what is drawn is
/// where the key led, and nothing waits.
#[test]
#[ignore = "needs chromium"]
fn browser_an_arrow_held_for_ten_seconds_never_falls_behind() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let held = "new Promise((done) => { let n = 0; window.behind = 0; const t = setInterval(() => { \
         document.dispatchEvent(new KeyboardEvent('keydown', { key: n % 100 < 50 ? 'ArrowRight' : 'ArrowLeft', bubbles: true })); \
         window.behind = Math.max(window.behind, Object.keys(impactid.wire.waiting).length); \
         if (++n === 300) { clearInterval(t); done(n); } }, 33); })";
    // the keys are dispatched on the map, as a user has it in focus
    browser.evaluate("document.getElementById('map').focus()");
    let held = held.replace(
        "document.dispatchEvent",
        "document.getElementById('map').dispatchEvent",
    );
    assert_eq!(browser.evaluate(&held), json!(300));
    browser.until(QUIET);
    // at most one request of the slot ever waited
    assert!(browser.evaluate("window.behind").as_u64().unwrap() <= 1);
    let same = "Math.abs(impactid.at[0] - impactid.state.cursor.eta) < 1e-12 && Object.keys(impactid.wire.waiting).length === 0";
    browser.until(same);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_dark_theme_is_dark() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("t", 0);
    browser.until("document.documentElement.dataset.theme === 'dark'");
    let paper = browser.evaluate("getComputedStyle(document.body).backgroundColor");
    assert_eq!(paper, json!("rgb(22, 25, 29)"));
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_click_on_the_map_carries_the_motion_there() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let place = "(() => { const b = document.getElementById('map').getBoundingClientRect(), f = impactid.map.frame; \
         return [b.left + f.px(2.5), b.top + f.py(4)]; })()";
    let place = browser.evaluate(place);
    browser.click((place[0].as_f64().unwrap(), place[1].as_f64().unwrap()));
    browser.until(QUIET);
    browser.until("impactid.shown.motion.label === '0'");
    let near =
        "Math.abs(impactid.state.cursor.eta - 2.5) < 0.01 && Math.abs(impactid.at[1] - 4) < 0.03";
    browser.until(near);
}

#[test]
#[ignore = "needs chromium"]
fn browser_boundaries_asked_for_ahead_are_those_of_the_state() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("document.querySelector('.slider input').focus()");
    browser.until("impactid.ahead.size === 2");
    let before = browser.evaluate("impactid.state.restitution");
    // as an arrow key does, and what is drawn before any answer can have come
    let moved = "(() => { const range = document.activeElement; range.value -= 0.001; \
         range.dispatchEvent(new Event('input')); return Array.from(impactid.map.curves['s2:1'].rho); })()";
    let ahead = browser.evaluate(moved);
    browser.until(QUIET);
    let after = browser.evaluate("impactid.state.restitution");
    let step = before.as_f64().unwrap() - after.as_f64().unwrap();
    assert!((step - 1e-3).abs() < 1e-12, "{step}");
    let answered = browser.evaluate("Array.from(impactid.map.curves['s2:1'].rho)");
    let [ahead, answered] = [&ahead, &answered].map(|v| v.as_array().unwrap());
    assert_eq!(ahead.len(), answered.len());
    for (a, b) in ahead.iter().zip(answered) {
        // an s2 that has no value comes as null
        if let Some((a, b)) = a.as_f64().zip(b.as_f64()) {
            assert!((a - b).abs() < 1e-5, "{a} {b}");
        }
    }
}

/// The map's boxes that were drawn since it is called first.
const BOXES: &str = "(() => { if (!window.boxes) { window.boxes = new Set(); (function look() { \
     const b = document.getElementById('map').getBoundingClientRect(); \
     boxes.add([b.left, b.top, b.width, b.height].join()); requestAnimationFrame(look); })(); } \
     return [...boxes]; })()";

#[test]
#[ignore = "needs chromium"]
fn browser_the_map_keeps_its_place_while_all_beside_it_changes() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.evaluate(BOXES);
    browser.until(QUIET);
    for action in [
        "carry(0.123456, 0.654321)",
        "parameters({ restitution: 0.612345, damping_ratio: 0.0123456 })",
        "look([0.2, 0.6], [0, 0.3])",
        "look([0.5, 3], [0, 6])",
    ] {
        browser.evaluate(&format!("impactid.{action}"));
        browser.until(QUIET);
    }
    let boxes = browser.evaluate(BOXES);
    assert_eq!(boxes.as_array().unwrap().len(), 1, "{boxes}");
}

#[test]
#[ignore = "needs chromium"]
fn browser_trajectories_are_set_into_the_characteristics() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let shares = "document.getElementById('numbers').textContent";
    browser.until(&format!("/of all starts\\s*z = 1: 100 %/.test({shares})"));
    browser.key("h", 0);
    browser.until("impactid.line.done === true");
    let there = "[...impactid.line.trajectories.values()].filter((t) => t).length";
    browser.key("o", 0);
    browser.until(&format!("{there} === 1"));
    browser.key("ArrowRight", 8);
    browser.until(QUIET);
    browser.key("o", 0);
    browser.until(&format!("{there} === 2"));
    browser.key("v", 0);
    browser.until("impactid.state.characteristic === 'autocorrelation'");
    let address = browser.evaluate("location.href.split('#')[0] + '#' + impactid.address()");
    let mut fresh = Chromium::open(address.as_str().unwrap(), SIZE);
    fresh.until(&format!("{there} === 2 && impactid.line.done === true"));
    let shown = "document.getElementById('characteristic').value";
    assert_eq!(fresh.evaluate(shown), json!("autocorrelation"));
    fresh.key("o", 0);
    fresh.until(&format!("{there} === 1"));
    for errors in [browser.errors(), fresh.errors()] {
        assert_eq!(errors, Vec::<String>::new());
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_campaign_is_explored() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let place = "(() => { const b = document.getElementById('map').getBoundingClientRect(); \
         const all = impactid.campaign.placed(impactid.map.frame); \
         const r = all.find((p) => p.r.motion.label === '1/2'); return [b.left + r.x, b.top + r.y]; })()";
    let place = browser.evaluate(place);
    browser.click((place[0].as_f64().unwrap(), place[1].as_f64().unwrap()));
    browser.until("impactid.campaign.frame?.stated?.motion?.label === '1/2'");
    let evidence = "document.getElementById('record-evidence').textContent";
    browser.until(&format!("{evidence}.includes('periods observed')"));
    let text = browser.evaluate("document.getElementById('record-head').textContent");
    assert!(
        text.as_str().unwrap().contains("simulated z = 1/2"),
        "{text}"
    );
    browser.key("]", 0);
    browser.until(QUIET);
    let joint = "impactid.campaign.residual.joint";
    let at_fit = browser.evaluate(joint).as_f64().unwrap();
    browser.evaluate("impactid.parameters({ restitution: 0.85 })");
    browser.until(&format!("{joint} > {}", 3.0 * at_fit));
    browser.key("z", 0);
    browser.until(&format!("Math.abs({joint} - {at_fit}) < 1e-9"));
    browser.key("p", 0);
    browser.until("impactid.campaign.proposals.length > 0");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
