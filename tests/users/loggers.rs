//! Files as programs and instruments write them that are no plain tables, from `init` to the answer.

use std::fmt::Write as _;

use crate::users::experiments::{Folder, holds};

const F0_HZ: f64 = 8.0;
const BETA: f64 = 0.02;

/// Values of a free decay of 1 with noise of 0.1 %.
fn decay(rate_hz: f64, count: usize) -> impl Iterator<Item = f64> {
    let omega = std::f64::consts::TAU * F0_HZ;
    (0..count).map(move |i| {
        let t = i as f64 / rate_hz;
        let noise = 1e-3 * (i as f64 * i as f64 * 2.399_963).sin();
        (-BETA * omega * t).exp() * (omega * (1.0 - BETA * BETA).sqrt() * t).cos() + noise
    })
}

fn folder(text: &str) -> Folder {
    Folder::of(&[("log.txt".to_owned(), text.as_bytes().to_vec())])
}

fn holds_the_decay(folder: &Folder) {
    let found = folder.play();
    assert!(
        holds(&found, "natural_frequency_hz", F0_HZ),
        "{}",
        found["joint"]
    );
    assert!(holds(&found, "damping_ratio", BETA), "{}", found["joint"]);
}

#[test]
fn valid_a_signal_express_export() {
    let mut text = String::from(
        "channel names: \nDev1_ai0\t\nstart times: \n4/12/2010 14:22:31.123456\t\ndt: \n0.002000\t\ndata: \n",
    );
    for value in decay(500.0, 1500) {
        let _ = writeln!(text, "{value:.6E}\t");
    }
    holds_the_decay(&folder(&text));
}

#[test]
fn valid_a_hantek_file_with_its_clock() {
    let mut text = String::from("#CLOCK=2.000mS\n#SIZE=1500\n#PROBE=1\n#VOLTDIV=5\n");
    for value in decay(500.0, 1500) {
        let _ = writeln!(text, "{value:.4},0,0");
    }
    holds_the_decay(&folder(&text));
}

#[test]
fn valid_labels_of_a_microcontroller() {
    let mut text = String::from("MPU6050 ready\nillis:1224 ax:0.1\n");
    for (i, value) in decay(100.0, 600).enumerate() {
        let _ = writeln!(text, "millis:{} ax:{value:.4}", 1234 + 10 * i);
    }
    holds_the_decay(&folder(&text));
}

#[test]
fn a_rate_beside_a_decimation_is_said_to_be_that_of_the_samples() {
    let mut text = String::from("# Sample rate: 500 Hz\n# Decimation: 4\nx (mm)\n");
    for value in decay(500.0, 1500) {
        let _ = writeln!(text, "{value:.6}");
    }
    let folder = folder(&text);
    holds_the_decay(&folder);
    let (said, _) = folder.run(&["check", "day/campaign.toml"]);
    assert!(
        said.contains("500 Hz beside a decimation of 4: taken as the rate of the stored samples"),
        "{said}"
    );
    assert!(said.contains("or \"125 Hz\""), "{said}");
}

#[test]
fn valid_carts_that_are_called_by_their_colours() {
    // two carts of one mass meet with R = 0.8
    let run = |k: usize| {
        let speed = 0.25 + 0.05 * k as f64;
        let meet = 0.6 / (1.3 * speed);
        let (mean, half) = (0.35 * speed, 0.5 * 0.8 * 1.3 * speed);
        let mut text = String::from("\"Time (s)\",\"Position, Red (m)\",\"Position, Blue (m)\"\n");
        for i in 0..150 {
            let t = f64::from(i) / 50.0;
            let along =
                |before: f64, after: f64| before * t.min(meet) + after * (t - meet).max(0.0);
            let noise = 2e-4 * (f64::from(i) * f64::from(i) * 2.399_963).sin();
            let (red, blue) = (
                0.2 + along(speed, mean - half) + noise,
                0.9 + along(-0.3 * speed, mean + half) - 0.7 * noise,
            );
            let _ = writeln!(text, "{t:.2},{red:.4},{blue:.4}");
        }
        (format!("run{k}.csv"), text.into_bytes())
    };
    let folder = Folder::of(&(0..4).map(run).collect::<Vec<_>>());
    let found = folder.play();
    let campaign = folder.campaign();
    assert!(campaign.contains("machine = \"double\""), "{campaign}");
    assert!(holds(&found, "restitution", 0.8), "{}", found["joint"]);
}
