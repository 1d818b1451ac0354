//! Addresses outlive their server, and pages a server that ends.

use serde_json::json;

use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET};

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
    let explorer = again(port);
    // the new address is opened in another tab
    browser.call("Target.createTarget", json!({"url": explorer.url()}));
    browser.until("window.impactid?.ready === true && !document.body.classList.contains('gone')");
    browser.until(QUIET);
    assert_eq!(browser.evaluate("impactid.state.restitution"), json!(0.72));
}
