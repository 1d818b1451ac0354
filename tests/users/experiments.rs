//! Experiments without a drive as a new user plays them: a folder of files, `init`, `check`, `run`, and
//! nothing edited in between.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers of a test's own, small and positive"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// A folder with files, and the program run beside it.
pub(super) struct Folder {
    lab: tempfile::TempDir,
}

impl Folder {
    pub(super) fn of(files: &[(String, Vec<u8>)]) -> Self {
        let lab = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir(lab.path().join("day")).expect("a folder");
        for (name, bytes) in files {
            fs::write(lab.path().join("day").join(name), bytes).expect("room");
        }
        Self { lab }
    }

    pub(super) fn run(&self, args: &[&str]) -> (String, i32) {
        let output = Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(args)
            .current_dir(self.lab.path())
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr);
        (said, output.status.code().unwrap_or(-1))
    }

    /// From `init` to the page of the report; the identification.
    pub(super) fn play(&self) -> Value {
        self.play_to("html")
    }

    /// From `init` to the report in a format, of which PDF takes longest to set; the identification.
    fn play_to(&self, format: &str) -> Value {
        let (said, code) = self.run(&["init", "day"]);
        assert_eq!(code, 0, "{said}");
        let (said, code) = self.run(&["check", "day/campaign.toml"]);
        assert_eq!(code, 0, "{said}");
        let run = ["run", "day/campaign.toml", "--out", "results"];
        let (said, code) = self.run(&[&run[..], &["--format", format]].concat());
        assert!(code < 2, "{said}");
        let report = format!("results/report.{format}");
        assert!(self.lab.path().join(report).exists(), "{said}");
        read(&self.lab.path().join("results"))
    }

    pub(super) fn campaign(&self) -> String {
        fs::read_to_string(self.lab.path().join("day/campaign.toml")).expect("campaign.toml")
    }
}

fn read(results: &Path) -> Value {
    let text = fs::read_to_string(results.join("identification.json")).expect("results");
    serde_json::from_str(&text).expect("JSON")
}

/// Whether the 95 % interval of a joint estimate holds a value.
pub(super) fn holds(found: &Value, parameter: &str, truth: f64) -> bool {
    let interval = &found["joint"][parameter]["interval95"];
    let [low, high] = [0, 1].map(|i| interval[i].as_f64().unwrap_or(f64::NAN));
    low <= truth && truth <= high
}

fn scatter(i: usize, k: usize) -> f64 {
    ((i + 31 * k) as f64 * 2.399_963).sin() * std::f64::consts::SQRT_2
}

/// Runs of two carts at 20 Hz as PASCO Capstone exports them: a push, a collision, friction.
fn carts(restitution: f64) -> Vec<(String, Vec<u8>)> {
    let run = |k: usize| {
        let top = 0.4 + 0.1 * k as f64;
        let meet = 1.8 + 0.11 * k as f64;
        let before = |t: f64| match t {
            t if t < 0.3 => 0.0,
            t if t < 0.7 => top * 0.5 * (1.0 - (std::f64::consts::PI * (t - 0.3) / 0.4).cos()),
            t => top - 0.016 * (t - 0.7),
        };
        let speed = before(meet);
        let brake = |v: f64, t: f64| v - v.signum() * (0.016 * (t - meet)).min(v.abs());
        // A magnet's contact of 0.1 s: both speeds change along half a cosine.
        let share = |t: f64| {
            let s = ((t - meet + 0.05) / 0.1).clamp(0.0, 1.0);
            0.5 * (1.0 - (std::f64::consts::PI * s).cos())
        };
        let blue = |t: f64| {
            let after = brake(speed * 0.5 * (1.0 - restitution), t.max(meet));
            before(t.min(meet)) * (1.0 - share(t)) + after * share(t)
        };
        let red = |t: f64| -brake(speed * 0.5 * (1.0 + restitution), t.max(meet)) * share(t);
        let mut text = String::from(
            "Time (s),Blue Force (N),Blue Position (m),Blue Velocity (m/s),\
             Red Force (N),Red Position (m),Red Velocity (m/s)\n",
        );
        let (mut x, mut y) = (0.0, 0.0);
        for i in 0..70 {
            let t = f64::from(i) / 20.0;
            let (u, v) = (blue(t), red(t));
            let noise = 4e-4 * scatter(i as usize, k);
            let _ = writeln!(
                text,
                "{t:.3},{:.4},{x:.6},{:.6},{:.4},{y:.6},{:.6}",
                0.2 + noise,
                u + noise,
                0.02 - noise,
                v - 0.5 * noise
            );
            x += u / 20.0;
            y += v / 20.0;
        }
        (format!("run{k}.csv"), text.into_bytes())
    };
    (0..4).map(run).collect()
}

#[test]
fn valid_two_carts_from_init_to_the_report() {
    let folder = Folder::of(&carts(0.9));
    let found = folder.play_to("pdf");
    let campaign = folder.campaign();
    assert!(campaign.contains("machine = \"double\""), "{campaign}");
    assert!(
        campaign.contains("flight = \"constant_force\""),
        "{campaign}"
    );
    assert!(!campaign.contains("[channels.drive]"), "{campaign}");
    assert!(holds(&found, "restitution", 0.9), "{}", found["joint"]);
    let impacts = &found["methods"]["speeds_at_impact"];
    assert_eq!(impacts["records"], 4);
    let remarks = impacts["remarks"].to_string();
    assert!(remarks.contains("conservation of momentum"), "{remarks}");
}

/// Times of bounces as phyphox writes them.
fn bounces(restitution: f64) -> Vec<(String, Vec<u8>)> {
    let list = |k: usize| {
        let mut text = String::from("Event time (s),Interval (s)\n");
        let (mut t, mut flight) = (1.5 + 0.2 * k as f64, 0.55 - 0.01 * k as f64);
        for i in 0..6 {
            let shown = t + 1.5e-3 * scatter(i, k);
            let _ = writeln!(text, "{shown:.6},{:.6}", if i < 5 { flight } else { 0.0 });
            t += flight;
            flight *= restitution;
        }
        (format!("throw {k}.csv"), text.into_bytes())
    };
    (0..4).map(list).collect()
}

#[test]
fn valid_times_of_bounces_from_init_to_the_report() {
    let folder = Folder::of(&bounces(0.76));
    let found = folder.play_to("pdf");
    let campaign = folder.campaign();
    assert!(campaign.contains("content = \"times\""), "{campaign}");
    assert!(holds(&found, "restitution", 0.76), "{}", found["joint"]);
    assert_eq!(found["methods"]["flight_times"]["records"], 4);
    // a list of times was sampled at no rate
    let (said, code) = folder.run(&["report", "results", "--format", "html"]);
    assert_eq!(code, 0, "{said}");
    let page = fs::read_to_string(folder.lab.path().join("results/report.html")).expect("a page");
    let (_, sampling) = page.split_once("sampling").expect("the length");
    let sampling: String = sampling.chars().take(80).collect();
    assert!(
        sampling.contains("s a record") && !sampling.contains("Hz"),
        "{sampling}"
    );
}

/// A ball's bounces as a phone hears them: clicks of 3 kHz in a WAV file of 8 kHz.
fn sound(restitution: f64) -> Vec<u8> {
    let rate = 8000_u32;
    let mut values = vec![0.0f64; 3 * rate as usize];
    for (i, value) in values.iter_mut().enumerate() {
        *value = 2e-4 * scatter(i, 1);
    }
    let (mut t, mut flight, mut size) = (0.3, 0.5, 0.8);
    for _ in 0..7 {
        let from = (t * f64::from(rate)) as usize;
        for (i, value) in values[from..].iter_mut().take(800).enumerate() {
            *value += size * (-(i as f64) / 80.0).exp() * (2.2 * i as f64).sin();
        }
        t += flight;
        flight *= restitution;
        size *= 0.6;
    }
    let mut bytes = b"RIFF".to_vec();
    let data = 2 * values.len() as u32;
    bytes.extend((36 + data).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16_u32.to_le_bytes());
    bytes.extend([1, 0, 1, 0]);
    bytes.extend(rate.to_le_bytes());
    bytes.extend((2 * rate).to_le_bytes());
    bytes.extend([2, 0, 16, 0]);
    bytes.extend(b"data");
    bytes.extend(data.to_le_bytes());
    for value in values {
        bytes.extend(((value * 32_000.0) as i16).to_le_bytes());
    }
    bytes
}

#[test]
fn valid_the_sound_of_bounces_from_init_to_the_report() {
    let folder = Folder::of(&[("ball.wav".to_owned(), sound(0.8))]);
    let found = folder.play_to("pdf");
    let campaign = folder.campaign();
    assert!(campaign.contains("content = \"sound\""), "{campaign}");
    assert!(holds(&found, "restitution", 0.8), "{}", found["joint"]);
}

/// A mass on a spring, released: position, velocity and acceleration differentiated from it.
fn springs() -> Vec<(String, Vec<u8>)> {
    let run = |k: usize| {
        let natural = std::f64::consts::TAU * 1.5;
        let x = |i: usize| {
            let t = i as f64 / 100.0;
            let value = 0.02 * (-0.003 * natural * t).exp() * (natural * t).cos();
            0.35 + value + 1e-4 * scatter(i * i, k)
        };
        let mut text = String::from("Time (s),Position (m),Velocity (m/s),Acceleration (m/s²)\n");
        for i in 0..600 {
            let t = i as f64 / 100.0;
            match i {
                0 => {
                    let _ = writeln!(text, "{t:.3},{:.6},,", x(i));
                }
                _ => {
                    let v = (x(i + 1) - x(i - 1)) * 50.0;
                    let a = (x(i + 1) - 2.0 * x(i) + x(i - 1)) * 1e4;
                    let _ = writeln!(text, "{t:.3},{:.6},{v:.6},{a:.5}", x(i));
                }
            }
        }
        (format!("spring{k}.csv"), text.into_bytes())
    };
    (0..3).map(run).collect()
}

#[test]
fn valid_springs_from_init_to_the_report() {
    let folder = Folder::of(&springs());
    let found = folder.play_to("pdf");
    assert!(folder.campaign().contains("excitation = \"free_decay\""));
    assert!(
        holds(&found, "natural_frequency_hz", 1.5),
        "{}",
        found["joint"]
    );
    assert!(holds(&found, "damping_ratio", 0.003), "{}", found["joint"]);
    assert_eq!(found["methods"]["free_decay"]["fits"], true);
}

/// A phone on a spring as phyphox exports "Acceleration (without g)": three axes and their size, one of which moves.
fn phone() -> Vec<(String, Vec<u8>)> {
    let run = |k: usize| {
        let mut text = String::from(
            "\"Time (s)\",\"Linear Acceleration x (m/s^2)\",\"Linear Acceleration y (m/s^2)\",\
             \"Linear Acceleration z (m/s^2)\",\"Absolute acceleration (m/s^2)\"\n",
        );
        let (natural, ratio) = (std::f64::consts::TAU * 1.2, 0.01_f64);
        for i in 0..4000 {
            let t = i as f64 * 0.00997;
            let since = t - 2.0 - 0.3 * k as f64;
            let swing = -0.05
                * natural.powi(2)
                * (-ratio * natural * since).exp()
                * (natural * (1.0 - ratio * ratio).sqrt() * since).cos();
            let noise = |axis: usize| 0.01 * scatter(i * i, k + 7 * axis);
            let [x, y, z] = [0, 1, 2].map(noise);
            let z = if since < 0.0 { z } else { z + swing };
            let size = x.hypot(y).hypot(z);
            let _ = writeln!(text, "{t:.9E},{x:.9E},{y:.9E},{z:.9E},{size:.9E}");
        }
        (
            format!("Acceleration without g {}.csv", k + 1),
            text.into_bytes(),
        )
    };
    (0..3).map(run).collect()
}

#[test]
fn valid_a_phone_on_a_spring_from_init_to_the_report() {
    let folder = Folder::of(&phone());
    let found = folder.play_to("pdf");
    let campaign = folder.campaign();
    assert!(
        campaign.contains("channel = \"Linear Acceleration z\""),
        "{campaign}"
    );
    let joint = &found["joint"];
    assert!(holds(&found, "natural_frequency_hz", 1.2), "{joint}");
    assert!(holds(&found, "damping_ratio", 0.01), "{joint}");
}

/// The same of a phone that is late now and then, so that samples are missing.
#[test]
fn valid_a_phone_that_drops_samples() {
    let dropped = |(name, bytes): (String, Vec<u8>)| {
        let text = String::from_utf8(bytes).expect("text");
        let rows = text.lines().enumerate().filter(|(i, _)| i % 97 != 50);
        let rows: Vec<&str> = rows.map(|(_, row)| row).collect();
        (name, rows.join("\n").into_bytes())
    };
    let folder = Folder::of(&phone().into_iter().map(dropped).collect::<Vec<_>>());
    let found = folder.play();
    let joint = &found["joint"];
    assert!(holds(&found, "natural_frequency_hz", 1.2), "{joint}");
    assert!(holds(&found, "damping_ratio", 0.01), "{joint}");
    let (said, code) = folder.run(&["check", "day/campaign.toml"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("the samples are at uneven times"), "{said}");
}

/// The same as Physics Toolbox names it: multiples of gravity without a unit.
#[test]
fn valid_g_forces_of_a_phone_are_accelerations() {
    let renamed = |(name, bytes): (String, Vec<u8>)| {
        let text = String::from_utf8(bytes).expect("text");
        let (_, rows) = text.split_once('\n').expect("a head");
        (name, format!("time,gFx,gFy,gFz,TgF\n{rows}").into_bytes())
    };
    let folder = Folder::of(&phone().into_iter().map(renamed).collect::<Vec<_>>());
    let found = folder.play();
    let campaign = folder.campaign();
    for words in [
        "[channels.acceleration_x]",
        "channel = \"gFz\"",
        "unit = \"g\"",
    ] {
        assert!(campaign.contains(words), "{words} is not in {campaign}");
    }
    let joint = &found["joint"];
    assert!(holds(&found, "natural_frequency_hz", 1.2), "{joint}");
    assert!(holds(&found, "damping_ratio", 0.01), "{joint}");
}

/// A ball on paper followed by a camera of 1000 frames a second, in millimetres below the start; R falls
/// with the speed.
fn paper() -> Vec<(String, Vec<u8>)> {
    let run = |k: usize| {
        let mut text = String::from("time (s),height below start (mm)\n");
        let (g, floor) = (9810.0, 300.0 + 5.0 * k as f64);
        let mut start = -(2.0 * floor / g).sqrt();
        let mut speed = 0.0;
        let mut from = 0.0;
        let mut next = 0.0;
        let mut bounce = 0;
        for i in 0..520 {
            let t = i as f64 / 1000.0 - 0.26;
            while t >= next && bounce < 4 {
                let arrival = (2.0 * g * (floor - from) + speed * speed).sqrt();
                let ratio = if bounce == 0 { 0.41 } else { 0.50 };
                speed = -ratio * arrival;
                from = floor;
                start = next;
                next += 2.0 * ratio * arrival / g;
                bounce += 1;
            }
            let s = t - start;
            let height = if t < start {
                0.0
            } else {
                from + speed * s + 0.5 * g * s * s
            };
            let _ = writeln!(
                text,
                "{:.3},{:.4}",
                i as f64 / 1000.0,
                height + 0.02 * scatter(i, k)
            );
        }
        (format!("paper{k}.csv"), text.into_bytes())
    };
    (0..3).map(run).collect()
}

#[test]
fn valid_a_ball_on_paper_is_not_one_number() {
    let folder = Folder::of(&paper());
    let found = folder.play();
    assert!(folder.campaign().contains("flight = \"constant_force\""));
    assert_eq!(
        found["verdict"]["kind"], "does_not_fit",
        "{}",
        found["verdict"]
    );
    let bounces = &found["methods"]["speeds_at_impact"]["impact_groups"]["by_bounce"];
    for (i, truth) in [0.41, 0.50].into_iter().enumerate() {
        let r = bounces[i]["restitution"].as_f64().expect("R");
        let error = bounces[i]["standard_error"].as_f64().expect("an error");
        assert!((r - truth).abs() < 2.5 * error, "{i}: {r} ± {error}");
        assert!(error < 0.02, "{error}");
    }
    let remarks = found["methods"]["speeds_at_impact"]["remarks"].to_string();
    assert!(
        remarks.contains("bounce to bounce") || remarks.contains("depends on"),
        "{remarks}"
    );
}
