//! All by pointer, and what only a pointer did by keys too.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE};

/// Click the middle of an element.
fn click(browser: &mut Chromium, element: &str) {
    let place = browser.evaluate(&format!(
        "(() => {{ const e = {element}; e.scrollIntoView({{ block: 'nearest' }}); const b = e.getBoundingClientRect(); \
         return [b.left + b.width / 2, b.top + b.height / 2]; }})()"
    ));
    browser.click((place[0].as_f64().unwrap(), place[1].as_f64().unwrap()));
}

#[test]
#[ignore = "needs chromium"]
fn browser_everything_is_done_by_pointer_alone() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let title = "document.getElementById('dialog-title').textContent";
    let legend = "document.getElementById('legend').textContent";
    let cases = [
        ("A", format!("{title}.includes('Initial')")),
        ("B", format!("{title}.includes('system')")),
        ("C", format!("{title}.includes('picture')")),
        ("D", format!("{title}.includes('simulation')")),
        ("E", format!("{title}.includes('R(v)')")),
        ("N", format!("{title}.includes('basins')")),
        (
            "I",
            "impactid.state.line?.eta[0] === impactid.state.line?.eta[1]".to_owned(),
        ),
        ("L", "impactid.map.drawing === true".to_owned()),
        ("P", "impactid.campaign.proposals.length > 0".to_owned()),
        ("Q", "impactid.state.cursor.start.x === 0".to_owned()),
        (
            "U",
            "Math.abs(impactid.state.poincare_phase - Math.PI / 4) < 1e-9".to_owned(),
        ),
        ("W", format!("{legend}.includes('cells: from X′ = Y′ = 3')")),
        (
            "]",
            "impactid.state.record === impactid.campaign.facts.records[0].id".to_owned(),
        ),
    ];
    assert_eq!(
        browser.evaluate(&format!("{legend}.includes('cells: from rest')")),
        json!(true)
    );
    for (key, done) in cases {
        click(
            &mut browser,
            "document.querySelector('nav [data-key=\"?\"]')",
        );
        browser.until(&format!(
            "document.getElementById('dialog').open && {title}.startsWith('Menu')"
        ));
        let entry = "[...document.querySelectorAll('dialog .keys button')]";
        click(
            &mut browser,
            &format!("{entry}.find((b) => b.firstChild.textContent === '{key}')"),
        );
        browser.until(&done);
        browser.evaluate("document.getElementById('dialog').close()");
        browser.until("!document.getElementById('dialog').open");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_start_in_the_basins_is_chosen_by_keys() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("s", 0);
    browser.until("impactid.basins.tile !== null");
    browser.evaluate("impactid.start({ x: 0, vx: 0, y: 0, vy: 0 }, 0)");
    browser.until(QUIET);
    browser.evaluate("document.getElementById('basins').focus()");
    let eta = browser.evaluate("impactid.state.cursor.eta");
    browser.key("ArrowLeft", 0);
    browser.key("ArrowUp", 8);
    browser.until(QUIET);
    // the picture is 8 wide or less and 8 high: X from −4, X′ from −4 to 4
    let start = browser.evaluate("impactid.state.cursor.start");
    let [x, vx] = ["x", "vx"].map(|key| start[key].as_f64().unwrap());
    assert!(x < -0.05 && x > -0.2 && (vx - 1.6).abs() < 1e-9, "{start}");
    assert_eq!(start["x"], start["y"]);
    assert_eq!(browser.evaluate("impactid.state.cursor.eta"), eta);
}

/// Apply a text as R(v) in one of the forms; what the open dialog says.
fn apply(browser: &mut Chromium, form: &str, text: &str) -> String {
    browser.evaluate(&format!(
        "(() => {{ const d = document.getElementById('dialog-body'), s = d.querySelector('select'); s.value = '{form}'; \
         s.dispatchEvent(new Event('change')); d.querySelector('textarea').value = '{text}'; \
         [...d.querySelectorAll('button')].find((b) => b.textContent === 'Apply').click(); }})()"
    ));
    let said = browser.evaluate("document.querySelector('#dialog-body p').textContent");
    said.as_str().unwrap().to_owned()
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_law_of_restitution_that_is_none_is_refused_in_its_field() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("e", 0);
    browser.until("document.getElementById('dialog').open");
    for (form, text, said) in [
        ("constant", "1.5", "R = 1.5 is not between 0 and 1"),
        ("constant", "0.9 0.8", "2 of 1 numbers"),
        ("table", "0 0.9\\n6", "Line 2 has 1 of 2 numbers"),
        ("table", "0 0.9\\n6 1.2", "Line 2: R = 1.2 is not between"),
        ("table", "6 0.9\\n0 0.8", "Line 2: speeds rise"),
        ("table", "-1 0.9\\n6 0.8", "Line 1: speeds rise"),
        ("table", "0 0.9\\n6 much", "Numbers alone"),
        ("table", "", "Numbers alone"),
        ("power_law", "0.05 0.4", "2 of 3 numbers"),
        ("power_law", "-0.05 0.4 0", "coefficient = -0.05"),
        ("power_law", "0.05 0 0", "exponent = 0"),
        ("power_law", "0.05 0.4 2", "floor = 2"),
        ("exponential", "0.95 0.8", "2 of 3 numbers"),
        ("exponential", "1.2 0.8 3", "slow = 1.2"),
        ("exponential", "0.95 -1 3", "fast = -1"),
        ("exponential", "0.95 0.8 0", "speed = 0"),
    ] {
        let note = apply(&mut browser, form, text);
        assert!(note.contains(said), "{form} {text}: {note}");
        let kept = format!(
            "(() => {{ const t = document.querySelector('#dialog-body textarea'); \
             return t.value === '{text}' && t.getAttribute('aria-invalid') === 'true' && document.getElementById('dialog').open; }})()"
        );
        assert_eq!(browser.evaluate(&kept), json!(true), "{form} {text}");
        assert_eq!(browser.evaluate("impactid.state.restitution"), json!(0.9));
    }
    for (form, text, taken) in [
        ("power_law", "0,05 0,4 0.2", "power_law.floor === 0.2"),
        ("exponential", "0.95 0.8 3", "exponential.speed === 3"),
        ("table", "0 0.95\\n6 0.85", "table.length === 2"),
    ] {
        apply(&mut browser, form, text);
        browser.until(&format!(
            "!document.getElementById('dialog').open && impactid.state.restitution.{taken}"
        ));
        browser.until(QUIET);
        let message = browser.evaluate("document.getElementById('message').hidden");
        assert_eq!(message, json!(true), "{form}");
        browser.key("e", 0);
        browser.until("document.getElementById('dialog').open");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_how_to_draw_a_line_is_said_until_it_is_drawn() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let said = "!document.getElementById('caption').hidden && document.getElementById('caption').textContent.startsWith('drag the line')";
    browser.key("l", 0);
    browser.until(said);
    // what else is said for a moment gives way to it again
    browser.evaluate("void impactid.said('something else', 50)");
    browser.until(said);
    browser.evaluate("new Promise((done) => setTimeout(done, 4300))");
    assert_eq!(browser.evaluate(said), json!(true));
    // a line without a length is none
    browser.key("l", 0);
    browser.until("impactid.map.drawing && impactid.state.line === null && document.getElementById('caption').textContent.startsWith('a line has two ends')");
    browser.key("ArrowRight", 0);
    browser.key("l", 0);
    browser.until("impactid.state.panel === 'line' && document.getElementById('caption').hidden");
    browser.key("l", 0);
    browser.until(said);
    browser.key("Escape", 0);
    browser.until("!impactid.map.drawing && document.getElementById('caption').hidden");
}

/// A key that is held steps on, but does not turn on and off.
#[test]
#[ignore = "needs chromium"]
fn browser_a_held_key_counts_once_where_it_is_no_step() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let hold = |browser: &mut Chromium, key: &str| {
        browser.key_event("keyDown", key, 0);
        for _ in 0..3 {
            let again = json!({"type": "keyDown", "key": key, "text": key, "autoRepeat": true});
            browser.call("Input.dispatchKeyEvent", again);
        }
        browser.key_event("keyUp", key, 0);
    };
    browser.evaluate("document.getElementById('map').focus()");
    hold(&mut browser, "g");
    assert_eq!(browser.evaluate("impactid.run"), json!(true));
    hold(&mut browser, "k");
    assert_eq!(
        browser.evaluate("impactid.player.recording !== null"),
        json!(true)
    );
    let width = "impactid.state.view.eta[1] - impactid.state.view.eta[0]";
    let before = browser.evaluate(width).as_f64().unwrap();
    hold(&mut browser, "+");
    let after = browser.evaluate(width).as_f64().unwrap();
    assert!((before / after / 1.25_f64.powi(4) - 1.0).abs() < 1e-6);
    // from a choice of the panel Esc leads back to the map
    browser.key("h", 0);
    browser.evaluate("document.getElementById('characteristic').focus()");
    browser.key("Escape", 0);
    browser.until("document.activeElement.id === 'map'");
}

#[test]
#[ignore = "needs chromium"]
fn browser_restitution_is_a_formula() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("e", 0);
    browser.until("document.getElementById('dialog').open");
    for (text, said) in [
        ("0.9 +", "the end"),
        ("2 - v", "not between 0 and 1"),
        ("alert(1)", "alert"),
        ("0.9)", "not understood"),
        ("exp(1,5; 2)/10", "exp takes one value, not 2"),
        ("min(0,9)", "min takes two values or more"),
    ] {
        let note = apply(&mut browser, "formula", text);
        assert!(note.contains(said), "{text}: {note}");
        assert_eq!(browser.evaluate("impactid.state.restitution"), json!(0.9));
    }
    apply(&mut browser, "formula", "max(0.5, 0.95 - 0.05*v^(1/2))");
    browser.until("!document.getElementById('dialog').open");
    let off = "Math.max(...impactid.state.restitution.table.map(([v, r]) => Math.abs(r - Math.max(0.5, 0.95 - 0.05 * Math.sqrt(v)))))";
    let off = browser.evaluate(off).as_f64().unwrap();
    assert!(off < 1e-8, "{off}");
    browser.until(QUIET);
    // it is seen, and stays a formula when it is opened again and in the address
    let law = "max(0.5, 0.95 - 0.05*v^(1/2))";
    browser.until(&format!(
        "document.getElementById('readout').textContent.includes('R(v) = {law}')"
    ));
    let kept = "document.querySelector('#dialog-body select').value + ' ' + document.querySelector('#dialog-body textarea').value";
    let address = browser.evaluate("location.origin + '/#' + impactid.address()");
    let address = address.as_str().unwrap();
    assert!(address.len() < 2500, "{address}");
    browser.go("about:blank");
    browser.go(address);
    browser.until(QUIET);
    assert_eq!(
        browser.evaluate("impactid.state.restitution.table.length"),
        json!(121)
    );
    browser.key("e", 0);
    browser.until("document.getElementById('dialog').open");
    assert_eq!(browser.evaluate(kept), json!(format!("formula {law}")));
    // as it is written elsewhere
    apply(&mut browser, "formula", "R(V) = 0,95 - 0,02v");
    browser.until("!document.getElementById('dialog').open && Math.abs(impactid.state.restitution.table[60][1] - 0.8) < 1e-9");
    browser.until(QUIET);
    assert_eq!(browser.errors(), Vec::<String>::new());
}
