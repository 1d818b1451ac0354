//! The running motion in a browser.

use std::time::Duration;

use serde_json::json;

use super::browser_sizes::CUT;
use super::chromium::{Chromium, SIZE};
use super::server::{Explorer, QUIET};

#[test]
#[ignore = "needs chromium"]
fn browser_label_and_numbers_follow_the_running_motion() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate(CUT);
    browser.evaluate("impactid.carry(1.1, 2)");
    browser.until(QUIET);
    let readout = "document.getElementById('readout').textContent";
    let numbers = "document.getElementById('numbers').textContent";
    browser.until(&format!("{readout}.startsWith('z = 1 at η = 1.1')"));
    browser.key("g", 0);
    browser.until(&format!("{numbers}.startsWith('nowz = 1')"));
    // past the saddle-node at 1.5688 no impact is left
    for step in 1..=29 {
        browser.evaluate(&format!("impactid.carry(1.1 + 0.025 * {step}, 2)"));
        std::thread::sleep(Duration::from_millis(30));
    }
    browser.until(&format!("{readout}.startsWith('z = 0 at η = 1.825')"));
    browser.until(&format!("{numbers}.startsWith('nowz = 0')"));
    browser.until(&format!("/approach speed\\s*none/.test({numbers})"));
    browser.until(&format!("/of all starts\\s*z = /.test({numbers})"));
    // what was before the move is told from what is now, in texts that are not cut
    let live = browser.evaluate("impactid.motion.live.moved > 0");
    assert_eq!(live, json!(true));
    assert_eq!(browser.evaluate("[...cut]"), json!([]));
    // and back below the end of z = 0, where the impacts come again
    browser.evaluate("impactid.carry(1.1, 1)");
    browser.until(&format!("{readout}.startsWith('z = 1 at η = 1.1,')"));
    browser.key("g", 0);
    browser.until(QUIET);
    browser.until(&format!("{numbers}.startsWith('settles onz = 1')"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
#[ignore = "needs chromium"]
fn browser_a_run_that_is_stopped_leaves_the_settled_motion_whole() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    for trial in 0..20 {
        browser.key("g", 0);
        browser.until("impactid.motion.live !== null");
        std::thread::sleep(Duration::from_millis(7 * trial));
        browser.key("g", 0);
        browser.until(QUIET);
        std::thread::sleep(Duration::from_millis(60));
        browser.until(QUIET);
        let whole = "[impactid.motion.live === null, Math.round(impactid.motion.span[1]), \
             impactid.motion.frame.column.poincare_x.length]";
        assert_eq!(browser.evaluate(whole), json!([true, 8, 300]), "{trial}");
    }
}

#[test]
#[ignore = "needs chromium"]
fn browser_basins_follow_the_cursor_while_the_motion_runs() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.evaluate("impactid.carry(1.3, 2)");
    browser.until(QUIET);
    browser.key("g", 0);
    browser.until("impactid.motion.live !== null");
    browser.key("s", 0);
    let shares = "document.getElementById('basin-shares').textContent";
    let whole = "impactid.basins.tile?.id === impactid.wire.newest.basins && impactid.basins.tile.level === 1 && impactid.basins.tile.filled === 101";
    browser.until(whole);
    browser.until(&format!(
        "{shares}.includes('z = 0') && {shares}.includes('z = 1')"
    ));
    // above the saddle-node no start leads to impacts
    browser.evaluate("impactid.carry(1.7, 4)");
    browser.until(whole);
    browser.until(&format!("{shares} === 'z = 0: 100.0 %'"));
    browser.key("Escape", 0);
    browser.until(QUIET);
    assert_eq!(
        browser.evaluate(&format!("!impactid.run && {shares} === 'z = 0: 100.0 %'")),
        json!(true)
    );
}

/// What is asked for in the place of the next stretch, several times before it is answered, does not end the run.
#[test]
#[ignore = "needs chromium"]
fn browser_a_run_goes_on_from_every_new_start() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("g", 0);
    for _ in 0..5 {
        browser.until("impactid.motion.live?.end > 0.3");
        browser.evaluate(
            "window.before = impactid.motion.live; impactid.set({ poincare_phase: Math.PI / 4 }, ['motion']); \
             for (let v = 0; v < 6; v++) impactid.start({ x: 0, vx: v, y: 0, vy: v }, 0)",
        );
        browser.until("impactid.motion.live !== before");
    }
    browser.until("impactid.motion.live?.end > 0.3");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// What starts settle on is looked for once its panel is open, also where the cursor moved before.
#[test]
#[ignore = "needs chromium"]
fn browser_shares_of_starts_come_with_their_panel() {
    let explorer = Explorer::theory();
    let mut browser = Chromium::open(&explorer.url(), SIZE);
    browser.until(QUIET);
    browser.key("s", 0);
    browser.key("ArrowRight", 0);
    browser.until(QUIET);
    browser.key("m", 0);
    browser.until("/\\d %/.test(document.querySelectorAll('#numbers dd')[1].textContent)");
}
