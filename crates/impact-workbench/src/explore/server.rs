//! The server on loopback: the page, and one WebSocket for all requests.
//!
//! Loopback alone is no protection, since every page of every browser on the machine can reach it:
//! the Host must name loopback, the Origin must be the page's own, and the WebSocket needs the token that is
//! in the address' fragment, which browsers never send. Nothing that the client names is opened as a file.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Request, State as Shared};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use futures_util::stream::SplitSink;
use futures_util::{SinkExt, StreamExt};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpStream;
use tokio::sync::{Semaphore, mpsc};
use tokio::time::{Instant, timeout, timeout_at};

use super::answer::campaign_now;
use super::frame::Frame;
use super::job::refusal;
use super::jobs::Jobs;
use super::limits::largest_message;
use super::{ExploreError, Session, wire};
use impact_report::style::{FontFace, font};

/// Pages that may be open at a time.
const MOST_PAGES: usize = 12;
/// Frames that wait for a slow page before its jobs pause.
const OUTBOX: usize = 64;
/// The protocol of the WebSocket.
const PROTOCOL: &str = "impactid.1";
/// Before the token in the list of protocols that the page offers.
const TOKEN_PREFIX: &str = "token.";

/// The header with which a page asks at the door.
const TOKEN_HEADER: &str = "x-token";
/// Longest time until a connection has sent a request.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time between two pings, which a browser answers by itself.
const PING: Duration = Duration::from_secs(10);
/// Time after which a page that answers nothing, as one of a computer that sleeps, is gone.
const SILENCE: Duration = Duration::from_secs(30);

/// What the page may do: scripts, styles, fonts and the WebSocket of this server, nothing else.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; \
     img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; \
     frame-ancestors 'none'";

/// The page's files: path, type, content.
const FILES: [(&str, &str, &str); 16] = [
    ("/", HTML, include_str!("page/index.html")),
    ("/style.css", CSS, include_str!("page/style.css")),
    ("/svg.js", SCRIPT, include_str!("page/svg.js")),
    ("/main.js", SCRIPT, include_str!("page/main.js")),
    ("/wire.js", SCRIPT, include_str!("page/wire.js")),
    ("/map.js", SCRIPT, include_str!("page/map.js")),
    ("/draw.js", SCRIPT, include_str!("page/draw.js")),
    ("/plots.js", SCRIPT, include_str!("page/plots.js")),
    ("/campaign.js", SCRIPT, include_str!("page/campaign.js")),
    ("/keys.js", SCRIPT, include_str!("page/keys.js")),
    ("/dialogs.js", SCRIPT, include_str!("page/dialogs.js")),
    ("/door.js", SCRIPT, include_str!("page/door.js")),
    ("/formula.js", SCRIPT, include_str!("page/formula.js")),
    ("/fields.js", SCRIPT, include_str!("page/fields.js")),
    ("/demos.js", SCRIPT, include_str!("page/demos.js")),
    ("/exports.js", SCRIPT, include_str!("page/exports.js")),
];

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// The faces of the report's type.
const FONTS: [(&str, FontFace); 3] = [
    ("/regular.otf", FontFace::Regular),
    ("/italic.otf", FontFace::Italic),
    ("/bold.otf", FontFace::Bold),
];

/// A server that listens on loopback.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    token: String,
    session: Arc<Session>,
}

struct App {
    session: Arc<Session>,
    token: String,
    pages: Arc<Semaphore>,
}

/// Port of an explorer that is given none.
const USUAL_PORT: u16 = 8427;

impl Server {
    /// Listen on a port of 127.0.0.1; without one, on the usual one, so that a bookmark leads to the next explorer
    /// too, or on any that is free.
    ///
    /// # Errors
    /// [`ExploreError::Port`] where it cannot be listened on.
    pub fn bind(session: Session, port: Option<u16>) -> Result<Self, ExploreError> {
        let refused = |e: std::io::Error| ExploreError::Port {
            port: port.unwrap_or(USUAL_PORT),
            reason: labfiles::said(&e),
        };
        let listen = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = match port {
            Some(port) => listen(port),
            None => listen(USUAL_PORT).or_else(|_| listen(0)),
        };
        let listener = listener.map_err(refused)?;
        listener.set_nonblocking(true).map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        let mut secret = [0u8; 16];
        getrandom::fill(&mut secret).map_err(|e| ExploreError::Server(e.to_string()))?;
        let token = secret.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self {
            listener,
            address,
            token,
            session: Arc::new(session),
        })
    }

    /// What is served; its campaign may be replaced while it is.
    pub fn session(&self) -> Arc<Session> {
        Arc::clone(&self.session)
    }

    /// The page's address, with the token in its fragment.
    pub fn url(&self) -> String {
        format!("http://{}/#t={}", self.address, self.token)
    }

    /// Serve until the process ends.
    ///
    /// # Errors
    /// [`ExploreError::Server`] where the system stops it.
    pub fn run(self) -> Result<(), ExploreError> {
        let stopped = |e: std::io::Error| ExploreError::Server(e.to_string());
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()
            .map_err(stopped)?;
        runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(self.listener).map_err(stopped)?;
            let app = App {
                session: self.session,
                token: self.token,
                pages: Arc::new(Semaphore::new(MOST_PAGES)),
            };
            let router = router(app);
            loop {
                let (stream, _) = listener.accept().await.map_err(stopped)?;
                tokio::spawn(serve(stream, router.clone()));
            }
        })
    }
}

/// Serve a connection; one that does not send a request within seconds is closed.
async fn serve(stream: TcpStream, router: Router) {
    // without it the frames are only slower
    let _ = stream.set_nodelay(true);
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(PATIENCE)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router))
        .with_upgrades();
    // a connection that breaks is the browser's to open again
    let _ = connection.await;
}

fn router(app: App) -> Router {
    let app = Arc::new(app);
    let door = Router::new().route("/door", get(door));
    let mut router = door.route("/ws", get(upgrade));
    for (path, kind, content) in FILES {
        router = router.route(path, get(move || async move { file(kind, content) }));
    }
    for (path, face) in FONTS {
        let content = font(face).unwrap_or_default();
        router = router.route(path, get(move || async move { file("font/otf", content) }));
    }
    router
        .fallback(|| async { (StatusCode::NOT_FOUND, "no such page\n") })
        .layer(middleware::from_fn(guarded))
        .with_state(app)
}

fn file(kind: &'static str, content: impl IntoResponse) -> Response {
    let mut response = content.into_response();
    let kind = HeaderValue::from_static(kind);
    response.headers_mut().insert(header::CONTENT_TYPE, kind);
    response
}

/// Refuse foreign hosts and origins, and restrict what the page may do.
async fn guarded(request: Request, next: Next) -> Response {
    let mut response = match permitted(request.headers()) {
        Ok(()) => next.run(request).await,
        Err(why) => (StatusCode::FORBIDDEN, why).into_response(),
    };
    let fixed = [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ];
    for (name, value) in fixed {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

/// Whether Host names loopback, and Origin, where there is one, is that of the page itself.
fn permitted(headers: &HeaderMap) -> Result<(), &'static str> {
    let text = |name| {
        headers
            .get(name)
            .map(|v: &HeaderValue| v.to_str().unwrap_or("?"))
    };
    let host = text(header::HOST).ok_or("the request names no host\n")?;
    if !is_loopback(host) {
        return Err("this server answers on 127.0.0.1 and localhost alone\n");
    }
    let own = |origin: &str| origin.strip_prefix("http://") == Some(host);
    match text(header::ORIGIN) {
        Some(origin) if !own(origin) => Err("requests of other pages are refused\n"),
        _ => Ok(()),
    }
}

/// Whether a Host names loopback; any port, for tunnels.
fn is_loopback(host: &str) -> bool {
    let bare = |name: &str| ["127.0.0.1", "localhost", "[::1]"].contains(&name);
    let port = |port: &str| port.parse::<u16>().is_ok();
    bare(host) || matches!(host.rsplit_once(':'), Some((name, p)) if bare(name) && port(p))
}

/// Whether a token opens a WebSocket: the browser does not tell a page why one was refused.
async fn door(Shared(app): Shared<Arc<App>>, headers: HeaderMap) -> StatusCode {
    let token = headers.get(TOKEN_HEADER).and_then(|v| v.to_str().ok());
    if !token.is_some_and(|token| same(token, &app.token)) {
        StatusCode::FORBIDDEN
    } else if app.pages.available_permits() == 0 {
        StatusCode::SERVICE_UNAVAILABLE
    } else {
        StatusCode::NO_CONTENT
    }
}

/// Open a WebSocket for a page that has the token.
async fn upgrade(
    Shared(app): Shared<Arc<App>>,
    headers: HeaderMap,
    socket: WebSocketUpgrade,
) -> Response {
    if !headers.contains_key(header::ORIGIN) {
        return (StatusCode::FORBIDDEN, "the request names no origin\n").into_response();
    }
    let token_of = |v: &HeaderValue| Some(v.to_str().ok()?.strip_prefix(TOKEN_PREFIX)?.to_owned());
    let offered: Vec<String> = socket.requested_protocols().filter_map(token_of).collect();
    let known = offered.iter().any(|token| same(token, &app.token));
    if !known {
        return (StatusCode::FORBIDDEN, "the token is wrong\n").into_response();
    }
    let Ok(permit) = Arc::clone(&app.pages).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pages are open\n").into_response();
    };
    let session = Arc::clone(&app.session);
    socket
        .protocols([PROTOCOL])
        .max_message_size(largest_message())
        .max_frame_size(largest_message())
        .write_buffer_size(0)
        .on_upgrade(move |socket| async move {
            page(socket, session).await;
            drop(permit);
        })
}

/// Whether two texts are the same, in a time that does not depend on where they differ.
fn same(a: &str, b: &str) -> bool {
    let different = a.bytes().zip(b.bytes()).fold(0, |d, (a, b)| d | (a ^ b));
    a.len() == b.len() && different == 0
}

/// Serve a page until it goes away.
async fn page(socket: WebSocket, session: Arc<Session>) {
    let (sink, mut stream) = socket.split();
    let (outbox, frames) = mpsc::channel::<Frame>(OUTBOX);
    let writer = tokio::spawn(write(sink, frames));
    let news = tokio::spawn(tell_changes(Arc::clone(&session), outbox.clone()));
    let jobs = Jobs::start(&session, &outbox);
    while let Ok(Some(Ok(message))) = timeout(SILENCE, stream.next()).await {
        let request = match &message {
            Message::Text(text) => wire::read(text.as_str()),
            Message::Binary(_) => {
                let reason = "a binary message; requests are text";
                Err((0, ExploreError::malformed("request", reason)))
            }
            Message::Close(_) => break,
            Message::Ping(_) | Message::Pong(_) => continue,
        };
        match request {
            Ok(request) => jobs.take(request).await,
            Err((id, error)) => {
                let untaken = refusal(id, &error).with("taken", false);
                if outbox.send(untaken).await.is_err() {
                    break;
                }
            }
        }
    }
    news.abort();
    writer.abort();
}

/// Send frames as they come, and pings between them.
async fn write(mut sink: SplitSink<WebSocket, Message>, mut frames: mpsc::Receiver<Frame>) {
    let mut due = Instant::now() + PING;
    loop {
        let message = if Instant::now() >= due {
            due = Instant::now() + PING;
            Message::Ping(Bytes::new())
        } else {
            match timeout_at(due, frames.recv()).await {
                Ok(Some(frame)) => Message::Binary(frame.bytes().into()),
                Ok(None) => return,
                Err(_) => continue,
            }
        };
        if sink.send(message).await.is_err() {
            return;
        }
    }
}

/// Send the campaign whenever it is replaced.
async fn tell_changes(session: Arc<Session>, outbox: mpsc::Sender<Frame>) {
    let mut changes = session.changes();
    while changes.changed().await.is_ok() {
        let now = campaign_now(&session);
        if let Some(frame) = now
            && outbox.send(frame).await.is_err()
        {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut all = HeaderMap::new();
        all.insert(header::HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            all.insert(header::ORIGIN, origin.parse().unwrap());
        }
        all
    }

    #[test]
    fn only_loopback_and_the_page_itself_are_permitted() {
        for (host, origin) in [
            ("127.0.0.1:8080", None),
            ("localhost:9", Some("http://localhost:9")),
            ("[::1]:8080", Some("http://[::1]:8080")),
            ("localhost", None),
        ] {
            assert_eq!(permitted(&headers(host, origin)), Ok(()), "{host}");
        }
        for (host, origin) in [
            ("example.org", None),
            ("127.0.0.1.example.org:8080", None),
            ("localhost:9@example.org", None),
            ("127.0.0.1:8080", Some("http://example.org")),
            ("127.0.0.1:8080", Some("http://127.0.0.1:8081")),
            ("127.0.0.1:8080", Some("null")),
            ("127.0.0.1:x", None),
        ] {
            assert!(
                permitted(&headers(host, origin)).is_err(),
                "{host} {origin:?}"
            );
        }
        assert!(permitted(&HeaderMap::new()).is_err());
    }

    #[test]
    fn tokens_are_compared_whole() {
        assert!(same("abc", "abc"));
        assert!(!same("abc", "abd") && !same("abc", "ab") && !same("", "a"));
    }
}
