//! Values that are typed, in a browser: what is out of range never counts.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE};

/// Type a text into the field that an expression names, and leave the field.
fn type_into(browser: &mut Chromium, field: &str, text: &str) {
    browser.evaluate(&format!("{field}.focus(); {field}.select(); true"));
    for letter in text.chars() {
        browser.key(&letter.to_string(), 0);
    }
    browser.evaluate(&format!("{field}.blur()"));
}

/// What the field says is wrong with what was typed.
fn fault(browser: &mut Chromium, field: &str) -> String {
    let said = format!(
        "{field}.getAttribute('aria-invalid') === 'true' ? \
         document.getElementById({field}.getAttribute('aria-errormessage')).textContent : ''"
    );
    browser.evaluate(&said).as_str().unwrap().to_owned()
}

#[test]
#[ignore = "needs chromium"]
fn browser_values_out_of_range_are_refused_in_their_field() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let state = "JSON.stringify({ ...impactid.state, cursor: 0 })";
    let before = browser.evaluate(state);
    let field = "document.querySelectorAll('.slider input[type=text]')[0]";
    for text in ["1.5", "1e308", "-0.1", "none"] {
        type_into(&mut browser, field, text);
        assert_eq!(fault(&mut browser, field), "restitution R: 0 to 1");
        assert_eq!(browser.evaluate(state), before);
    }
    // the motion still follows, and with it the field shows what counts
    browser.evaluate("document.getElementById('map').focus()");
    browser.key("ArrowRight", 0);
    browser.until(QUIET);
    browser.until("Math.abs(impactid.at[0] - impactid.state.cursor.eta) < 1e-12");
    assert_eq!(browser.evaluate(&format!("{field}.value")), json!("0.9"));
    assert_eq!(fault(&mut browser, field), "");
    for (key, name, text, said) in [
        ("a", "X(0)", "1e17", "X(0): −10000 to 10000"),
        (
            "b",
            "stiffness of Y over X",
            "1e9",
            "stiffness of Y over X: 0.01 to 100",
        ),
        (
            "b",
            "mass of Y over X",
            "1e308",
            "mass of Y over X: 0.01 to 100",
        ),
        ("b", "masses (1 or 2)", "1.5", "masses (1 or 2): 1 or 2"),
        ("c", "η from", "1e-6", "η from: 0.02 to 100"),
        ("c", "η from", "3.6", "η from: below 3.5"),
        (
            "d",
            "periods to settle",
            "1e9",
            "periods to settle: 0 to 20000",
        ),
    ] {
        let before = browser.evaluate(state);
        browser.key(key, 0);
        let all = "[...document.querySelectorAll('dialog label')]";
        let field = format!("{all}.find((l) => l.textContent === '{name}').querySelector('input')");
        // each field states its range before anything is typed
        let ranges = "[...document.querySelectorAll('dialog label input')].map((i) => document.getElementById(i.getAttribute('aria-describedby')).textContent)";
        for range in browser.evaluate(ranges).as_array().unwrap() {
            assert!(range.as_str().unwrap().contains(" to "), "{key}: {range}");
        }
        type_into(&mut browser, &field, text);
        assert_eq!(fault(&mut browser, &field), said);
        browser.key("Escape", 0);
        browser.until("!document.getElementById('dialog').open");
        assert_eq!(browser.evaluate(state), before, "{name}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// Values each within its range that together take too long.
#[test]
#[ignore = "needs chromium"]
fn browser_values_that_take_too_long_together_are_refused_in_their_field() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.goTo(0.1, 1); true");
    browser.until(QUIET);
    let before = browser.evaluate("impactid.state.watch");
    browser.key("d", 0);
    let all = "[...document.querySelectorAll('dialog label')]";
    let name = "periods watched";
    let field = format!("{all}.find((l) => l.textContent === '{name}').querySelector('input')");
    type_into(&mut browser, &field, "20000");
    browser.until(&format!("{field}.getAttribute('aria-invalid') === 'true'"));
    let said = fault(&mut browser, &field);
    assert!(
        said.starts_with("periods watched: This takes too long"),
        "{said}"
    );
    browser.until(QUIET);
    assert_eq!(browser.evaluate("impactid.state.watch"), before);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_samples_of_the_series_are_chosen() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.until("impactid.motion.frame.column.periods.length === 8 * 200 + 1");
    browser.key("c", 0);
    let all = "[...document.querySelectorAll('dialog label')]";
    let name = "its samples in a period";
    let field = format!("{all}.find((l) => l.textContent === '{name}').querySelector('input')");
    type_into(&mut browser, &field, "50");
    browser.until("impactid.motion.frame.column.periods.length === 8 * 50 + 1");
    // they are those of the study too
    let study = "impactid.wire.once({ kind: 'study' }, impactid.state).then((f) => f.files.some((f) => f.text.includes('samples_per_period = 50')))";
    assert_eq!(browser.evaluate(study), json!(true));
}

/// A place beside the view moves it as far as it must.
#[test]
#[ignore = "needs chromium"]
fn browser_the_view_follows_the_motion_along_one_axis() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let view = browser.evaluate("impactid.state.view");
    browser.evaluate("impactid.goTo(9, 1); true");
    browser.until("impactid.state.view.eta[0] > 5 && impactid.state.view.eta[1] > 9");
    assert_eq!(browser.evaluate("impactid.state.view.rho"), view["rho"]);
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_thumb_steps_from_a_value_beyond_its_end() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let damping = "document.querySelectorAll('.slider input[type=text]')[1]";
    let thumb = "document.querySelectorAll('.slider input[type=range]')[1]";
    type_into(&mut browser, damping, "0.5");
    browser.until("impactid.state.damping_ratio === 0.5");
    browser.evaluate(&format!("{thumb}.focus()"));
    browser.key("ArrowLeft", 0);
    browser.until("Math.abs(impactid.state.damping_ratio - 0.4995) < 1e-9");
    browser.key("ArrowRight", 0);
    browser.until("Math.abs(impactid.state.damping_ratio - 0.5) < 1e-9");
    // back inside, the ends are those from before
    type_into(&mut browser, damping, "0.1");
    browser.until(&format!(
        "Number({thumb}.max) === 0.3 && Number({thumb}.value) === 0.1"
    ));
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_state_that_is_refused_never_leaves_an_empty_page() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let first = browser.evaluate("JSON.stringify(impactid.first)");
    let address = browser.evaluate("location.pathname + '#' + impactid.address()");
    let address = format!(
        "http://127.0.0.1:{}{}",
        explorer.port,
        address.as_str().unwrap()
    );
    let spoiled = address.replace("%22restitution%22%3A0.9", "%22restitution%22%3A1.5");
    assert_ne!(spoiled, address);
    let bare = explorer.url() + "&s=%7B%22version%22%3A1%7D";
    for (url, word) in [(spoiled, "restitution = 1.5"), (bare, "missing field")] {
        browser.go("about:blank");
        browser.go(&url);
        browser.until(QUIET);
        let message = browser.evaluate("document.getElementById('message').textContent");
        assert!(message.as_str().unwrap().contains(word), "{message}");
        assert_eq!(browser.evaluate("JSON.stringify(impactid.first)"), first);
        browser.until("impactid.map.tiles.length > 0 && impactid.shown.motion.label === '1'");
    }
    // a state that is refused later gives way to the last one that was taken
    browser.evaluate(
        "impactid.set({ restitution: { table: [[1, 0.5], [0, 0.5]] } }, ['map', 'carried'])",
    );
    browser.until("impactid.state.restitution === 0.9");
    browser.key("ArrowRight", 0);
    browser.until(QUIET);
    browser.until("Math.abs(impactid.at[0] - impactid.state.cursor.eta) < 1e-12");
}

#[test]
#[ignore = "needs chromium"]
fn browser_thumbs_agree_after_going_back_to_the_fit() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let range = "document.querySelector('.slider input[type=range]')";
    let fit = browser
        .evaluate("impactid.state.restitution")
        .as_f64()
        .unwrap();
    browser.evaluate(&format!(
        "{range}.focus(); {range}.value = 0.724; {range}.dispatchEvent(new Event('input'))"
    ));
    let dragged = "Math.abs(impactid.state.restitution - 0.724) < 0.0006";
    browser.until(dragged);
    browser.key("z", 0);
    browser.until(&format!("!({dragged})"));
    let thumb = browser.evaluate(&format!("Number({range}.value)"));
    assert!(
        (thumb.as_f64().unwrap() - fit).abs() <= 0.0005,
        "{thumb} {fit}"
    );
    browser.key("ArrowRight", 0);
    let next = browser
        .evaluate("impactid.state.restitution")
        .as_f64()
        .unwrap();
    assert!((next - fit - 0.001).abs() < 1e-9, "{next} {fit}");
    browser.key("ArrowLeft", 0);
    let back = browser
        .evaluate("impactid.state.restitution")
        .as_f64()
        .unwrap();
    assert!((back - fit).abs() < 1e-9, "{back} {fit}");
    // the fit is of a machine whose masses are alike
    let machine = "JSON.stringify([impactid.state.asymmetry, impactid.state.single, impactid.state.restitution])";
    browser.evaluate("impactid.backToFit()");
    let fitted = browser.evaluate(machine);
    browser.evaluate("impactid.parameters({ single: true, asymmetry: { ...impactid.state.asymmetry, drive_amplitude: 0.9 } })");
    browser.key("z", 0);
    assert_eq!(browser.evaluate(machine), fitted);
    browser.key("ArrowRight", 0);
    let next = browser
        .evaluate("impactid.state.restitution")
        .as_f64()
        .unwrap();
    // Esc gives the arrows back to the map
    browser.key("Escape", 0);
    browser.key("ArrowRight", 0);
    browser.until("document.activeElement.id === 'map'");
    assert_eq!(browser.evaluate("impactid.state.restitution"), json!(next));
}

#[test]
#[ignore = "needs chromium"]
fn browser_the_widest_view_and_exact_places_can_be_typed() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    let typed = |browser: &mut Chromium, key: &str, name: &str, text: &str| {
        browser.key(key, 0);
        let all = "[...document.querySelectorAll('dialog label')]";
        let field = format!("{all}.find((l) => l.textContent === '{name}').querySelector('input')");
        type_into(browser, &field, text);
        assert_eq!(fault(browser, &field), "", "{name}");
        browser.key("Escape", 0);
        browser.until("!document.getElementById('dialog').open");
    };
    typed(&mut browser, "c", "η from", "0.02");
    typed(&mut browser, "c", "η to", "100");
    browser.until(QUIET);
    let wide = "JSON.stringify(impactid.state.view.eta)";
    assert_eq!(browser.evaluate(wide), json!("[0.02,100]"));
    browser.evaluate("impactid.home()");
    for _ in 0..18 {
        browser.key("-", 0);
    }
    browser.until(QUIET);
    assert_eq!(browser.evaluate(wide), json!("[0.02,100]"));
    assert_eq!(
        browser.evaluate("document.getElementById('message').hidden"),
        json!(true)
    );
    browser.evaluate("impactid.home()");
    // the motion, the line's ends, and the map's start
    typed(&mut browser, "b", "η of the motion", "1,234");
    typed(&mut browser, "b", "ρ of the motion", "8.5");
    browser.until(QUIET);
    assert_eq!(
        browser.evaluate("[impactid.state.cursor.eta, impactid.state.cursor.rho]"),
        json!([1.234, 8.5])
    );
    browser.until("impactid.state.view.rho[0] < 8.5 && impactid.state.view.rho[1] > 8.5");
    for (name, text) in [
        ("line from η", "1"),
        ("line from ρ", "2"),
        ("line to η", "1.5"),
        ("line to ρ", "3"),
    ] {
        typed(&mut browser, "d", name, text);
    }
    assert_eq!(
        browser.evaluate("[impactid.state.line.eta, impactid.state.line.rho]"),
        json!([[1, 1.5], [2, 3]])
    );
    typed(&mut browser, "a", "X′ = Y′ of the map\\'s start", "0.6");
    assert_eq!(
        browser.evaluate("impactid.state.map_start"),
        json!({"x": 0, "vx": 0.6, "y": 0, "vy": 0.6})
    );
    // what is said is two sentences
    browser.evaluate(
        "impactid.message('this takes too long to compute', 'let it settle for fewer periods')",
    );
    let said = browser.evaluate("document.getElementById('message').firstChild.textContent");
    assert_eq!(
        said,
        json!("This takes too long to compute. Let it settle for fewer periods.")
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}
