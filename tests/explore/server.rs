//! A running explorer, and a page that is a WebSocket.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// Of a page: whether everything that was asked for is drawn.
pub(crate) const QUIET: &str = "Object.values(impactid.wire.busy).every((b) => !b) \
     && impactid.map.finished === impactid.wire.newest.map";

/// The campaign that comes with the program.
pub(crate) const SAMPLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/data-samples/double-oscillator/campaign.toml"
);

/// The studies that come with the program.
pub(crate) const STUDIES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data-samples/studies");

/// `impactid explore --no-browser`, ended when it goes out of scope.
pub(crate) struct Explorer {
    child: Child,
    pub(crate) port: u16,
    pub(crate) token: String,
}

impl Explorer {
    /// Start it with further arguments, in a folder.
    pub(crate) fn start(arguments: &[&str], folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(["-q", "explore", "--no-browser"])
            .args(arguments)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut line = String::new();
        let stdout = child.stdout.take().expect("a pipe");
        BufReader::new(stdout)
            .read_line(&mut line)
            .expect("it prints its address");
        let (address, token) = line.trim().split_once("/#t=").expect("an address");
        let port = address.rsplit(':').next().expect("a port");
        Self {
            port: port.parse().expect("a number"),
            token: token.to_owned(),
            child,
        }
    }

    /// The theory, in a folder that holds nothing.
    pub(crate) fn theory() -> Self {
        Self::start(&[], &std::env::temp_dir())
    }

    /// The server's process.
    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// The page's address.
    pub(crate) fn url(&self) -> String {
        format!("http://127.0.0.1:{}/#t={}", self.port, self.token)
    }

    /// A request with its head as it is; the whole answer.
    pub(crate) fn raw(&self, head: &str) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        let wait = Some(Duration::from_secs(60));
        stream.set_read_timeout(wait).expect("a limit");
        stream.write_all(head.as_bytes()).expect("it reads");
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// GET a path with the right host.
    pub(crate) fn get(&self, path: &str) -> String {
        let port = self.port;
        self.raw(&format!(
            "GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n"
        ))
    }

    /// Open a WebSocket with an origin and a token; the HTTP status where it is refused.
    pub(crate) fn open(&self, origin: Option<&str>, token: &str) -> Result<Page, u16> {
        let mut request = format!("ws://127.0.0.1:{}/ws", self.port)
            .into_client_request()
            .expect("a request");
        let headers = request.headers_mut();
        if let Some(origin) = origin {
            headers.insert("Origin", origin.parse().expect("a header"));
        }
        let protocols = format!("impactid.1, token.{token}");
        headers.insert(
            "Sec-WebSocket-Protocol",
            protocols.parse().expect("a header"),
        );
        match tungstenite::connect(request) {
            Ok((socket, _)) => Ok(Page { socket, next: 1 }),
            Err(tungstenite::Error::Http(answer)) => Err(answer.status().as_u16()),
            Err(error) => panic!("{error}"),
        }
    }

    /// A page of its own.
    pub(crate) fn page(&self) -> Page {
        let origin = format!("http://127.0.0.1:{}", self.port);
        self.open(Some(&origin), &self.token).expect("it is let in")
    }
}

impl Drop for Explorer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A frame: its header, its columns, its cells.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub(crate) header: Value,
    pub(crate) columns: Vec<(String, Vec<f32>)>,
    pub(crate) cells: Vec<u16>,
}

impl Frame {
    fn decode(bytes: &[u8]) -> Self {
        let length = u32::from_le_bytes(bytes[..4].try_into().expect("a length")) as usize;
        let header: Value = serde_json::from_slice(&bytes[4..4 + length]).expect("JSON");
        let mut rest = &bytes[4 + length..];
        let mut columns = Vec::new();
        for column in header["columns"].as_array().expect("columns") {
            let count = column[1].as_u64().expect("a length");
            let count = usize::try_from(count).expect("a length");
            let (own, after) = rest.split_at(4 * count);
            let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
            let values = own.chunks_exact(4).map(number).collect();
            columns.push((column[0].as_str().expect("a name").to_owned(), values));
            rest = after;
        }
        assert_eq!(header["cells"].as_u64(), Some(rest.len() as u64 / 2));
        let cell = |b: &[u8]| u16::from_le_bytes(b.try_into().expect("two bytes"));
        Self {
            header,
            columns,
            cells: rest.chunks_exact(2).map(cell).collect(),
        }
    }

    pub(crate) fn kind(&self) -> &str {
        self.header["kind"].as_str().expect("a kind")
    }

    pub(crate) fn column(&self, name: &str) -> &[f32] {
        let found = self.columns.iter().find(|c| c.0 == name);
        &found.unwrap_or_else(|| panic!("no column {name}")).1
    }
}

/// A page without a browser.
pub(crate) struct Page {
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    next: u32,
}

impl Page {
    /// Send a text as it is.
    pub(crate) fn say(&mut self, text: &str) {
        self.socket
            .send(Message::text(text))
            .expect("the page is open");
    }

    /// Send any message; whether the server still takes it.
    pub(crate) fn send(&mut self, message: Message) -> bool {
        self.socket.send(message).is_ok()
    }

    /// Ask; returns the request's number.
    pub(crate) fn ask(&mut self, ask: &Value, state: &Value) -> u32 {
        let id = self.next;
        self.next += 1;
        self.say(&json!({"id": id, "ask": ask, "state": state}).to_string());
        id
    }

    /// The next frame; `None` where the server closed.
    pub(crate) fn next(&mut self) -> Option<Frame> {
        loop {
            match self.socket.read() {
                Ok(Message::Binary(bytes)) => return Some(Frame::decode(&bytes)),
                Ok(_) => {}
                Err(_) => return None,
            }
        }
    }

    /// Ask, and the next frame that answers it.
    pub(crate) fn answer(&mut self, ask: &Value, state: &Value) -> Frame {
        let id = self.ask(ask, state);
        loop {
            let frame = self.next().expect("an answer");
            if frame.header["id"] == id {
                return frame;
            }
        }
    }

    /// Read, and so answer, until so many pings have come.
    pub(crate) fn pings(&mut self, count: u32) {
        let mut seen = 0;
        while seen < count {
            let message = self.socket.read().expect("the page is open");
            seen += u32::from(message.is_ping());
        }
    }

    /// Its stream, on which nothing is answered.
    pub(crate) fn stream(&mut self) -> &mut TcpStream {
        match self.socket.get_mut() {
            MaybeTlsStream::Plain(stream) => stream,
            _ => unreachable!("no page is encrypted"),
        }
    }

    /// What the page starts from.
    pub(crate) fn hello(&mut self) -> Frame {
        self.answer(&json!({"kind": "hello"}), &Value::Null)
    }
}
