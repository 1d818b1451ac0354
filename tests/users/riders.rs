//! Carts as cameras and sonars see them, from `init` to the answer.

use std::fmt::Write as _;

use crate::users::experiments::{Folder, holds};

fn noise(i: usize, k: f64) -> f64 {
    (i as f64 * i as f64 * k).sin()
}

/// Two riders of one mass on a track that is 2° across the axes of a camera, at 500 Hz in mm. Each carries a marker that rings at
/// 25 Hz after the impact, the one toward the other and at half the size.
fn riders(restitution: f64, number: usize) -> String {
    let speed = 0.5 + 0.12 * number as f64;
    let meet = 0.4 / speed;
    let (mean, half) = (0.3 * speed, 0.5 * restitution * 1.4 * speed);
    let (sine, cosine) = 2f64.to_radians().sin_cos();
    let mut text = String::from("t (s)\ta X (mm)\ta Y (mm)\tb X (mm)\tb Y (mm)\n");
    for i in 0..1000 {
        let t = i as f64 / 500.0;
        let along = |before: f64, after: f64| before * t.min(meet) + after * (t - meet).max(0.0);
        let since = (t - meet).max(0.0);
        let omega = std::f64::consts::TAU * 25.0;
        let rings = 0.3 * 1.4 * speed / omega * (-since / 0.08).exp() * (omega * since).sin();
        let a = 1e3 * (along(speed, mean - half) + rings);
        let b = 1e3 * (0.56 + along(-0.4 * speed, mean + half) - 0.5 * rings);
        let scatter = |k: f64| 0.03 * noise(i, k);
        let _ = writeln!(
            text,
            "{t:.3}\t{:.3}\t{:.3}\t{:.3}\t{:.3}",
            a * cosine + scatter(2.399_963),
            50.0 + a * sine + scatter(1.732_051),
            b * cosine + scatter(0.618_034),
            60.0 + b * sine + scatter(1.414_214)
        );
    }
    text
}

#[test]
fn valid_riders_whose_markers_ring_across_the_axes_of_a_camera() {
    for restitution in [0.7, 0.8, 0.9] {
        let file = |k: usize| (format!("m{k}.tsv"), riders(restitution, k).into_bytes());
        let folder = Folder::of(&(0..5).map(file).collect::<Vec<_>>());
        let found = folder.play();
        let campaign = folder.campaign();
        assert!(campaign.contains("\nmachine = \"double\""), "{campaign}");
        assert!(campaign.contains("sign = -1"), "{campaign}");
        assert!(
            holds(&found, "restitution", restitution),
            "{}",
            found["joint"]
        );
    }
}

/// Places of a cart that bounces on a slope of 0.5 m/s² with rolling friction, 12 s at 50 Hz.
fn on_slope(restitution: f64) -> String {
    let step = 1e-4;
    let (mut place, mut speed) = (0.6, 0.0f64);
    let mut text = String::from("Zeit (s);Position (m)\n");
    for i in 0..120_000 {
        if i % 200 == 0 {
            let seen = 0.2 + place + 4e-4 * noise(i / 200, 2.399_963);
            let row = format!("{:.2};{seen:.4}\n", i as f64 * step);
            text.push_str(&row.replace('.', ","));
        }
        speed -= step * (0.5 + 0.02 * speed.signum());
        place += step * speed;
        if place < 0.0 && speed < 0.0 {
            (place, speed) = (0.0, -restitution * speed);
        }
    }
    text
}

#[test]
fn valid_a_cart_that_bounces_on_a_slope_is_no_decay() {
    for restitution in [0.75, 0.85, 0.93] {
        let folder = Folder::of(&[("cart.csv".to_owned(), on_slope(restitution).into_bytes())]);
        let found = folder.play();
        let campaign = folder.campaign();
        assert!(
            campaign.contains("flight = \"constant_force\""),
            "{campaign}"
        );
        assert!(
            holds(&found, "restitution", restitution),
            "{}",
            found["joint"]
        );
    }
}
