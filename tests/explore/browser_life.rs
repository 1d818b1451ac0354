//! Addresses outlive their server, and pages a server that ends.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET, SAMPLE};

/// Another explorer on a port that one before had.
fn again(port: u16) -> Explorer {
    Explorer::start(&["--port", &port.to_string()], &std::env::temp_dir())
}

#[test]
#[ignore = "needs chromium"]
fn browser_an_old_address_asks_for_the_new_one_and_keeps_what_it_showed() {
    let explorer = Explorer::theory();
    let port = explorer.port;
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.parameters({ restitution: 0.71 })");
    let address = browser.evaluate("location.origin + '/#' + impactid.address()");
    drop(browser);
    drop(explorer);
    let explorer = again(port);
    let mut browser = Chromium::open("about:blank", SIZE);
    browser.call("Page.navigate", json!({"url": address}));
    browser.until("document.getElementById('dialog')?.open === true");
    let give = |browser: &mut Chromium, text: &str| {
        browser.evaluate(&format!(
            "(() => {{ const i = document.querySelector('dialog input'); i.value = '{text}'; i.dispatchEvent(new Event('change')); }})()"
        ))
    };
    // Esc and Close leave no empty page: the question comes back
    let dialog = "document.getElementById('dialog')";
    for leave in ["requestClose()", "querySelector('.buttons button').click()"] {
        browser.evaluate(&format!(
            "{dialog}.querySelector('.fault').textContent = ''; void {dialog}.{leave}"
        ));
        browser.until(&format!(
            "{dialog}.open && {dialog}.querySelector('.fault').textContent.includes('nothing to show')"
        ));
    }
    for _ in 0..3 {
        browser.key("Escape", 0);
        browser.until(&format!("{dialog}.open"));
    }
    give(&mut browser, "nothing");
    browser.until("document.querySelector('dialog .fault').textContent.includes('no token')");
    give(&mut browser, &"0".repeat(32));
    browser.until("document.querySelector('dialog .fault').textContent.includes('does not know')");
    give(&mut browser, &explorer.url());
    browser.until("window.impactid?.ready === true");
    browser.until(QUIET);
    assert_eq!(browser.evaluate("impactid.state.restitution"), json!(0.71));
    assert_eq!(browser.evaluate("impactid.token"), json!(explorer.token));
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_page_goes_on_when_its_server_is_back() {
    let explorer = Explorer::theory();
    let port = explorer.port;
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.parameters({ restitution: 0.72 })");
    browser.until(QUIET);
    browser.key("g", 0);
    browser.key("x", 0);
    browser.until("document.getElementById('dialog').open && impactid.run");
    drop(explorer);
    let message = "document.getElementById('message')";
    browser.until(&format!("{message}.textContent.includes('server is gone')"));
    // nothing hides it, and no key moves what nobody computes
    let cursor = browser.evaluate("impactid.state.cursor.eta");
    browser.key("Escape", 0);
    browser.key("ArrowRight", 0);
    assert_eq!(browser.evaluate(&format!("{message}.hidden")), json!(false));
    assert_eq!(browser.evaluate("impactid.state.cursor.eta"), cursor);
    let refused = browser.evaluate("impactid.wire.once({ kind: 'export', file: 'csv' }, impactid.state).catch((e) => e.message)");
    assert_eq!(refused, json!("The server is gone."));
    // the header takes no orders either, and what is not answered is no error of the page
    let orders = "[...document.querySelectorAll('nav, main')].every((e) => e.inert) && !document.getElementById('dialog').open \
         && !impactid.run && document.querySelector('[data-key=g]').getAttribute('aria-pressed') === 'false'";
    browser.until(orders);
    browser.evaluate("impactid.player.start('1 whatever'), impactid.player.picture(1), impactid.dialogs.box.open");
    browser.evaluate(
        "impactid.message('something passing'), new Promise((done) => setTimeout(done, 100))",
    );
    browser.until(&format!(
        "{message}.textContent.includes('server is gone') && !{message}.hidden"
    ));
    let thrown = browser.errors();
    assert!(
        !thrown.iter().any(|e| e.contains("exceptionThrown")),
        "{thrown:?}"
    );
    let explorer = again(port);
    // the new address is opened in another tab
    browser.call("Target.createTarget", json!({"url": explorer.url()}));
    browser.until("window.impactid?.ready === true && !document.body.classList.contains('gone')");
    browser.until(QUIET);
    assert_eq!(browser.evaluate("impactid.state.restitution"), json!(0.72));
}

/// The address of a page in a browser under another explorer.
fn opened_on(browser: &mut Chromium, explorer: &Explorer, state: &str) {
    let written = browser.evaluate(&format!("encodeURIComponent(JSON.stringify({state}))"));
    browser.go("about:blank");
    browser.go(&format!(
        "{}&s={}",
        explorer.url(),
        written.as_str().unwrap()
    ));
    browser.until(QUIET);
}

#[test]
#[ignore = "needs chromium"]
fn browser_an_address_of_the_theory_is_shown_on_a_campaign_and_the_reverse() {
    let (theory, campaign) = (
        Explorer::theory(),
        Explorer::start(&[SAMPLE], &std::env::temp_dir()),
    );
    let mut browser = Chromium::open(&theory.url(), SIZE);
    browser.until(QUIET);
    let message = "document.getElementById('message').textContent";
    opened_on(
        &mut browser,
        &campaign,
        "{ ...impactid.state, restitution: 0.7 }",
    );
    browser.until("impactid.map.frame && document.querySelectorAll('.slider').length === 6");
    browser.until(&format!(
        "{message}.includes('those of this campaign are taken')"
    ));
    assert_eq!(browser.evaluate("[impactid.state.restitution, impactid.state.rig.natural_frequency_hz === impactid.first.rig.natural_frequency_hz]"), json!([0.7, true]));
    // a record that is not there, and then no campaign at all
    let elsewhere = "{ ...impactid.state, panel: 'record', record: 'nope' }";
    opened_on(&mut browser, &campaign, elsewhere);
    browser.until(&format!("{message}.includes('has no record nope')"));
    let shown = "[...document.querySelectorAll('[role=tab][aria-selected=true]')].map((t) => [t.id, t.hidden])";
    assert_eq!(browser.evaluate(shown), json!([["tab-motion", false]]));
    opened_on(&mut browser, &theory, elsewhere);
    browser.until(&format!("{message}.includes('not open here')"));
    assert_eq!(browser.evaluate(shown), json!([["tab-motion", false]]));
    assert_eq!(
        browser.evaluate("[impactid.state.rig, impactid.scale()]"),
        json!([null, null])
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// What a page sends at most: a long recording is kept, and what is larger is refused without losing the server.
#[test]
#[ignore = "needs chromium"]
fn browser_large_messages_are_taken_or_refused_on_the_page() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("k", 0);
    let minutes = "impactid.player.recording.steps = Array.from({ length: 1900 }, (_, i) => \
         [0.25, { ...impactid.state, cursor: { ...impactid.state.cursor, eta: 1 + i / 1900 } }]); true";
    browser.evaluate(minutes);
    browser.key("k", 0);
    browser.until("(impactid.player.recorded?.match(/step]]/g) ?? []).length > 1900");
    let message = "document.getElementById('message').textContent";
    let gone = "document.body.classList.contains('gone')";
    browser.evaluate("impactid.player.once(impactid.player.read('a'.repeat(5e6)), () => {}); true");
    browser.until(&format!("{message}.includes('larger than')"));
    // a table that long would not fit into an address either
    let long = "impactid.parameters({ restitution: { table: Array.from({ length: 30000 }, (_, i) => [i, 0.9]) } })";
    browser.evaluate(long);
    browser.until(&format!("{message}.includes('lines = 30000')"));
    browser.until("impactid.state.restitution === 0.9");
    browser.until(QUIET);
    assert_eq!(browser.evaluate(gone), json!(false));
    assert_eq!(browser.errors(), Vec::<String>::new());
}
