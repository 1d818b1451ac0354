//! Foreign hosts, origins and tokens, oversized and random frames, pages that go away.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use tungstenite::Message;

use super::server::Explorer;

#[test]
fn the_page_and_its_files_come_with_a_strict_policy() {
    let explorer = Explorer::theory();
    for path in ["/", "/main.js", "/style.css", "/regular.otf"] {
        let answer = explorer.get(path).to_lowercase();
        assert!(answer.starts_with("http/1.1 200"), "{path}: {answer}");
        assert!(answer.contains("content-security-policy: default-src 'none'"));
        assert!(answer.contains("x-content-type-options: nosniff"));
    }
    for path in [
        "/../Cargo.toml",
        "/etc/passwd",
        "/%2e%2e/secret",
        "/page/main.js",
    ] {
        let answer = explorer.get(path);
        assert!(answer.starts_with("HTTP/1.1 404"), "{path}: {answer}");
    }
}

#[test]
fn foreign_hosts_origins_and_tokens_are_refused() {
    let explorer = Explorer::theory();
    let port = explorer.port;
    for host in ["example.org", "127.0.0.1.example.org", "0.0.0.0"] {
        let head = format!("GET / HTTP/1.1\r\nHost: {host}:{port}\r\nConnection: close\r\n\r\n");
        assert!(explorer.raw(&head).starts_with("HTTP/1.1 403"), "{host}");
    }
    let own = format!("http://127.0.0.1:{port}");
    let wrong = "0".repeat(32);
    for (origin, token) in [
        (Some("http://example.org"), explorer.token.as_str()),
        (Some("null"), &explorer.token),
        (None, &explorer.token),
        (Some(own.as_str()), &wrong),
        (Some(&own), ""),
        (Some(&own), &explorer.token[..31]),
    ] {
        let refused = explorer.open(origin, token).map(|_| ());
        assert_eq!(refused, Err(403), "{origin:?} {token}");
    }
    assert_eq!(explorer.page().hello().kind(), "hello");
}

#[test]
fn two_explorers_have_two_tokens_and_one_port_each() {
    let first = Explorer::theory();
    let second = Explorer::theory();
    assert_ne!(first.token, second.token);
    let taken = std::process::Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["explore", "--no-browser", "--port", &first.port.to_string()])
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&taken.stderr).into_owned();
    assert_eq!(taken.status.code(), Some(2), "{said}");
    assert!(
        said.contains(&first.port.to_string()) && said.contains("--port"),
        "{said}"
    );
}

#[test]
fn oversized_messages_end_the_page_and_not_the_server() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let _ = page.send(Message::text(" ".repeat(1 << 23)));
    while page.next().is_some() {}
    assert_eq!(explorer.page().hello().kind(), "hello");
}

/// 10,000 messages: noise, requests cut short, requests with random values.
#[test]
fn prop_random_messages_are_refused_and_the_server_lives() {
    let explorer = Explorer::theory();
    let mut random = ChaCha8Rng::seed_from_u64(2026);
    let mut page = explorer.page();
    let hello = page.hello();
    let good =
        json!({"id": 1, "ask": {"kind": "motion"}, "state": hello.header["state"]}).to_string();
    let mut refused = 0;
    for number in 0..10_000 {
        let message = match number % 4 {
            0 => Message::text(noise(&mut random)),
            1 => {
                let end = random.random_range(0..good.len());
                let end = (0..=end)
                    .rev()
                    .find(|i| good.is_char_boundary(*i))
                    .unwrap_or(0);
                Message::text(good[..end].to_owned())
            }
            2 => Message::text(spoiled(&good, &mut random)),
            _ => Message::binary(noise(&mut random).into_bytes()),
        };
        assert!(page.send(message), "message {number}");
        // an answer to each would fill the pipe: read as they come
        if number % 16 == 15 {
            let frame = page.answer(&json!({"kind": "hello"}), &Value::Null);
            assert_eq!(frame.kind(), "hello");
            refused += 1;
        }
    }
    assert_eq!(refused, 625);
    assert_eq!(page.hello().header["state"], hello.header["state"]);
}

fn noise(random: &mut ChaCha8Rng) -> String {
    let length = random.random_range(0..200);
    (0..length).map(|_| random.random::<char>()).collect()
}

/// A good request with one of its digits or letters replaced.
fn spoiled(good: &str, random: &mut ChaCha8Rng) -> String {
    let mut bytes = good.as_bytes().to_vec();
    let at = random.random_range(0..bytes.len());
    bytes[at] = b"0e-.,]}\"xN9"[random.random_range(0..11)];
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn a_page_that_goes_away_in_mid_stream_leaves_the_server_alive() {
    let explorer = Explorer::theory();
    let state = explorer.page().hello().header["state"].clone();
    let mut slow = state.clone();
    slow["asymmetry"]["stiffness"] = json!(0.95);
    for _ in 0..20 {
        let mut page = explorer.page();
        page.ask(&json!({"kind": "map"}), &slow);
        page.ask(&json!({"kind": "basins"}), &slow);
        assert!(page.next().is_some());
    }
    let frame = explorer.page().answer(&json!({"kind": "map"}), &state);
    assert_eq!(frame.kind(), "map");
}

#[test]
fn a_request_that_is_not_finished_is_closed_within_seconds() {
    let explorer = Explorer::theory();
    let half: Vec<TcpStream> = (0..40)
        .map(|_| {
            let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).expect("it listens");
            stream
                .write_all(b"GET / HTTP/1.1\r\nHost: 127")
                .expect("it reads");
            stream
        })
        .collect();
    for mut stream in half {
        let wait = Some(Duration::from_secs(60));
        stream.set_read_timeout(wait).expect("a limit");
        // the server closes: the end comes, not the limit
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("the end");
    }
    assert_eq!(explorer.page().hello().kind(), "hello");
}

/// A page of a computer that sleeps answers no ping; one that only reads does.
#[test]
fn a_page_that_answers_nothing_is_closed_and_one_that_reads_stays() {
    let explorer = Explorer::theory();
    let mut reader = explorer.page();
    reader.hello();
    let mut silent = explorer.page();
    silent.hello();
    let reads = std::thread::spawn(move || {
        reader.pings(5);
        reader.hello()
    });
    let stream = silent.stream();
    let wait = Some(Duration::from_secs(90));
    stream.set_read_timeout(wait).expect("a limit");
    // the server closes: the end comes, not the limit
    stream.read_to_end(&mut Vec::new()).expect("the end");
    assert_eq!(reads.join().expect("it reads").kind(), "hello");
}
