//! A headless chromium over the `DevTools` protocol: enough to press keys, evaluate and take pictures.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// The window of most tests, CSS px.
pub(crate) const SIZE: (u32, u32) = (1280, 800);

/// Longest wait for anything in the browser.
const LONGEST: Duration = Duration::from_secs(300);

/// A browser with one tab.
pub(crate) struct Chromium {
    child: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    next: u64,
    session: String,
    /// Events that came while an answer was waited for.
    pub(crate) events: VecDeque<Value>,
    _profile: tempfile::TempDir,
}

/// Where chromium is: `IMPACTID_CHROMIUM`, else in the path.
pub(crate) fn program() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("IMPACTID_CHROMIUM") {
        return Some(path.into());
    }
    let folders = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let all = std::env::split_paths(&folders).flat_map(|f| names.map(|n| f.join(n)));
    all.into_iter().find(|p| p.is_file())
}

impl Chromium {
    /// Start it with an empty profile and open an address in a window of a size.
    pub(crate) fn open(url: &str, (width, height): (u32, u32)) -> Self {
        let program = program().expect("chromium is installed");
        let profile = tempfile::tempdir().expect("a folder");
        let mut child = Command::new(program)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-quic",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--remote-debugging-port=0",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("--window-size={width},{height}"))
            .arg("about:blank")
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .expect("chromium starts");
        let stderr = child.stderr.take().expect("a pipe");
        let mut lines = BufReader::new(stderr).lines().map_while(Result::ok);
        let address = lines
            .find_map(|line| Some(line.strip_prefix("DevTools listening on ")?.to_owned()))
            .expect("the browser's address");
        // what it prints later must not fill the pipe
        std::thread::spawn(move || lines.for_each(drop));
        let (socket, _) = tungstenite::connect(address).expect("the browser answers");
        let mut browser = Self {
            child,
            socket,
            next: 1,
            session: String::new(),
            events: VecDeque::new(),
            _profile: profile,
        };
        browser.tab((width, height));
        browser.go(url);
        browser
    }

    fn tab(&mut self, (width, height): (u32, u32)) {
        let target = self.call("Target.createTarget", json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        let attached = self.call("Target.attachToTarget", attach);
        self.session = attached["sessionId"]
            .as_str()
            .expect("a session")
            .to_owned();
        for domain in ["Page", "Runtime", "Network", "Log"] {
            self.call(&format!("{domain}.enable"), json!({}));
        }
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    /// Open an address and wait for the explorer's page to be ready.
    pub(crate) fn go(&mut self, url: &str) {
        self.call("Page.navigate", json!({"url": url}));
        if url.contains("#t=") {
            self.until("window.impactid?.ready === true");
        }
    }

    /// Call a method and wait for its result.
    pub(crate) fn call(&mut self, method: &str, parameters: Value) -> Value {
        let answer = self.answer(method, parameters);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Call a method and wait for its answer, which may be an error.
    fn answer(&mut self, method: &str, parameters: Value) -> Value {
        let id = self.next;
        self.next += 1;
        let mut message = json!({"id": id, "method": method, "params": parameters});
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.socket
            .send(Message::text(message.to_string()))
            .expect("the browser listens");
        loop {
            let Message::Text(text) = self.socket.read().expect("the browser answers") else {
                continue;
            };
            let value: Value = serde_json::from_str(text.as_str()).expect("JSON");
            if value["id"] == id {
                return value;
            }
            self.events.push_back(value);
        }
    }

    /// The value of an expression; promises are waited for.
    pub(crate) fn evaluate(&mut self, expression: &str) -> Value {
        let done = self.call("Runtime.evaluate", asked(expression));
        let thrown = done.get("exceptionDetails");
        assert!(
            thrown.is_none(),
            "{expression}: {}",
            done["exceptionDetails"]
        );
        done["result"]["value"].clone()
    }

    /// Wait until an expression is true, also while the page loads again.
    pub(crate) fn until(&mut self, expression: &str) {
        let begin = Instant::now();
        loop {
            let answer = self.answer("Runtime.evaluate", asked(expression));
            let loads = |error: &str| error.contains("navigated") || error.contains("context");
            let error = answer["error"]["message"].as_str();
            assert!(error.is_none_or(loads), "{expression}: {answer}");
            let thrown = answer["result"].get("exceptionDetails");
            assert!(thrown.is_none(), "{expression}: {thrown:?}");
            if answer["result"]["result"]["value"] == json!(true) {
                return;
            }
            assert!(
                begin.elapsed() < LONGEST,
                "not within {LONGEST:?}: {expression}"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Press and release a key: a letter, or a name such as `ArrowLeft`; 8: with Shift.
    pub(crate) fn key(&mut self, key: &str, modifiers: u32) {
        self.key_event("keyDown", key, modifiers);
        self.key_event("keyUp", key, modifiers);
    }

    /// One event of a key.
    pub(crate) fn key_event(&mut self, kind: &str, key: &str, modifiers: u32) {
        let code = match key {
            "Tab" => 9,
            "Enter" => 13,
            "Escape" => 27,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            _ => 0,
        };
        let mut event = json!({"type": kind, "key": key, "modifiers": modifiers,
            "windowsVirtualKeyCode": code});
        if key.chars().count() == 1 && kind == "keyDown" {
            event["text"] = json!(key);
        }
        if key == "Enter" && kind == "keyDown" {
            event["text"] = json!("\r");
        }
        self.call("Input.dispatchKeyEvent", event);
    }

    /// A click at a place of the window.
    pub(crate) fn click(&mut self, (x, y): (f64, f64)) {
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1});
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Addresses that the tab asked for so far.
    pub(crate) fn requests(&self) -> Vec<String> {
        let urls = self.events.iter().filter_map(|e| {
            let params = &e["params"];
            match e["method"].as_str()? {
                "Network.requestWillBeSent" => params["request"]["url"].as_str(),
                "Network.webSocketCreated" => params["url"].as_str(),
                _ => None,
            }
        });
        urls.map(str::to_owned).collect()
    }

    /// Errors of scripts and of the console.
    pub(crate) fn errors(&self) -> Vec<String> {
        let bad = self.events.iter().filter(|e| match e["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Log.entryAdded") => e["params"]["entry"]["level"] == "error",
            _ => false,
        });
        bad.map(ToString::to_string).collect()
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What asks for the value of an expression; promises are waited for.
fn asked(expression: &str) -> Value {
    json!({"expression": expression, "returnByValue": true, "awaitPromise": true})
}
