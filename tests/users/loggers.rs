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
fn valid_an_accelerometer_beside_a_clock_of_its_own() {
    let mut text = String::from(
        "loggingTime(txt),loggingSample(N),accelerometerTimestamp_sinceReboot(s),accelerometerAccelerationX(G),\
         accelerometerAccelerationY(G),accelerometerAccelerationZ(G)\n",
    );
    for (i, value) in decay(100.0, 400).enumerate() {
        let t = i as f64 / 100.0;
        let rest = 1e-3 * (i as f64 * 1.7).sin();
        let _ = writeln!(
            text,
            "2023-05-01T10:00:{t:06.3}+02:00,{},{:.6},{rest:.6},{:.6},{:.6}",
            i + 1,
            12_345.678 + t,
            -rest,
            0.3 * value - 1.0
        );
    }
    let folder = folder(&text);
    holds_the_decay(&folder);
    let campaign = folder.campaign();
    let channel = "[channels.acceleration_x]\nchannel = \"accelerometerAccelerationZ(G)\"";
    assert!(campaign.contains(channel), "{campaign}");
    assert!(campaign.contains("unit = \"g\""), "{campaign}");
}

#[test]
fn counts_of_a_clock_without_a_heading_need_their_unit() {
    let mut text = String::new();
    for (i, value) in decay(100.0, 400).enumerate() {
        let _ = writeln!(text, "{}\t{:.0}", 5321 + 10 * i, 512.0 + 400.0 * value);
    }
    let folder = folder(&text);
    let (said, _) = folder.run(&["init", "day"]);
    let (told, _) = folder.run(&["check", "day/campaign.toml"]);
    assert!(
        told.contains("its numbers, 5321 and on by steps of 10"),
        "{said}{told}"
    );
    assert!(told.contains("time_unit = \"ms\""), "{told}");
}

/// A sound file of two channels, numbers of 64 bits.
fn wav(rate_hz: u32, channels: [&[f64]; 2]) -> Vec<u8> {
    let samples = channels[0].iter().zip(channels[1]);
    let data: Vec<u8> = samples
        .flat_map(|(a, b)| [*a, *b])
        .flat_map(f64::to_le_bytes)
        .collect();
    let size = u32::try_from(data.len()).unwrap();
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + size).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16_u32.to_le_bytes());
    bytes.extend([3, 0, 2, 0]);
    bytes.extend(rate_hz.to_le_bytes());
    bytes.extend((16 * rate_hz).to_le_bytes());
    bytes.extend([16, 0, 64, 0]);
    bytes.extend(b"data");
    bytes.extend(size.to_le_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn valid_blows_of_a_hammer_in_the_first_channel_of_a_sound_file() {
    // blows that follow each other sooner and sooner, as bounces do
    let rate_hz = 4800_u32;
    let blows = [0.3, 3.3, 6.1, 8.7, 11.1];
    let since = |i: usize, blow: f64| i as f64 / f64::from(rate_hz) - blow;
    let noise = |i: usize, k: f64| 2e-3 * (i as f64 * i as f64 * k).sin();
    let pulse = |i: usize| {
        let struck = blows
            .iter()
            .map(|b| since(i, *b))
            .filter(|t| (0.0..4e-3).contains(t));
        struck
            .map(|t| (std::f64::consts::PI * t / 4e-3).sin())
            .sum::<f64>()
    };
    let omega = std::f64::consts::TAU * F0_HZ;
    let swing = |t: f64| (-BETA * omega * t).exp() * (omega * (1.0 - BETA * BETA).sqrt() * t).sin();
    let answer = |i: usize| {
        let all = blows.iter().map(|b| since(i, *b)).filter(|t| *t >= 0.0);
        all.map(|t| 0.7 * swing(t)).sum::<f64>()
    };
    let count = 13 * rate_hz as usize;
    let hammer: Vec<f64> = (0..count).map(|i| pulse(i) + noise(i, 1.732_051)).collect();
    let motion: Vec<f64> = (0..count)
        .map(|i| answer(i) + noise(i, 2.399_963))
        .collect();
    let folder = Folder::of(&[("hits.wav".to_owned(), wav(rate_hz, [&hammer, &motion]))]);
    holds_the_decay(&folder);
    let campaign = folder.campaign();
    assert!(campaign.contains("channel = \"channel 2\""), "{campaign}");
}

#[test]
fn two_modes_that_beat_are_proposed_as_a_free_decay() {
    let mut text = String::from("t (s),v (m/s)\n");
    let swing = |hz: f64, t: f64| {
        (-0.02 * std::f64::consts::TAU * hz * t).exp() * (std::f64::consts::TAU * hz * t).cos()
    };
    for i in 0..2000 {
        let t = f64::from(i) / 200.0;
        let _ = writeln!(text, "{t:.3},{:.5}", swing(3.0, t) + 0.6 * swing(3.18, t));
    }
    let folder = folder(&text);
    let (said, _) = folder.run(&["init", "day"]);
    let campaign = folder.campaign();
    assert!(
        campaign.contains("\nexcitation = \"free_decay\""),
        "{said}{campaign}"
    );
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
