//! Tables of heights, from `init` to the answer. The heights are those of h' = R² h with errors of reading.

use crate::users::experiments::{Folder, holds};

const R: f64 = 0.8;

/// A height read to 1 mm.
fn read(height_m: f64, k: usize) -> f64 {
    let error_m = 3e-3 * (k as f64 * 2.399_963).sin();
    ((height_m + error_m) * 1e3).round() / 1e3
}

fn played(text: &str) -> (serde_json::Value, String) {
    let folder = Folder::of(&[("heights.csv".to_owned(), text.as_bytes().to_vec())]);
    (folder.play(), folder.campaign())
}

/// Heights in cm of a drop from 1 m and the tops after it.
fn drop(k: usize) -> Vec<String> {
    let of = |i: usize| 100.0 * read(R.powi(2 * i32::try_from(i).unwrap_or(0)), 7 * k + i);
    (0..6).map(|i| format!("{:.1}", of(i))).collect()
}

#[test]
fn valid_a_drop_below_each_other_in_rows_and_in_columns() {
    let rows = |each: Vec<String>| each.join("\n");
    let below = drop(1).into_iter().enumerate();
    let below = rows(below.map(|(i, h)| format!("{i},{h}")).collect());
    let (found, campaign) = played(&format!("bounce,height (cm)\n{below}\n"));
    assert!(campaign.contains("content = \"heights\""), "{campaign}");
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
    let along = rows(
        (0..4)
            .map(|k| format!("{k},{}", drop(k)[..4].join(",")))
            .collect(),
    );
    let heading = "throw,height 0 (cm),height 1 (cm),height 2 (cm),height 3 (cm)";
    let (found, campaign) = played(&format!("{heading}\n{along}\n"));
    assert!(campaign.contains("then = [\"height 1\""), "{campaign}");
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
    assert_eq!(found["methods"]["flight_times"]["observations"], 12);
    let beside = (0..6).map(|i| format!("{i},{},{},{}", drop(0)[i], drop(1)[i], drop(2)[i]));
    let beside = rows(beside.collect());
    let (found, _) = played(&format!(
        "bounce no.,Trial 1 (cm),Trial 2 (cm),Trial 3 (cm)\n{beside}\n"
    ));
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
    assert_eq!(found["methods"]["flight_times"]["records"], 3);
}

#[test]
fn heights_of_two_balls_beside_each_other_are_no_rebounds() {
    // with one R for both, the second would be 0.9 of the first in each row
    let row = |i: i32| {
        let top = R.powi(2 * i);
        format!("{i},{:.1},{:.1}\n", 100.0 * top, 81.0 * top)
    };
    let rows: String = (0..6).map(row).collect();
    for heading in [
        "bounce,Tennis ball (cm),Squash ball (cm)",
        "bounce,height A (cm),height B (cm)",
    ] {
        let text = format!("{heading}\n{rows}");
        let folder = Folder::of(&[("heights.csv".to_owned(), text.into_bytes())]);
        let (said, code) = folder.run(&["init", "day"]);
        assert_eq!(code, 2, "{said}");
        assert!(
            said.contains("each fall from one impact to the next"),
            "{said}"
        );
        assert!(said.contains("give each throw a file of its own"), "{said}");
    }
}

#[test]
fn valid_pairs_and_repeated_rebounds() {
    let pair = |k: usize| {
        let height = 0.4 + 0.2 * (k % 4) as f64;
        format!(
            "{k},{:.1},{:.1}\n",
            100.0 * height,
            100.0 * read(R * R * height, k)
        )
    };
    let pairs: String = (0..9).map(pair).collect();
    let (found, campaign) = played(&format!("trial,drop_height_cm,rebound_height_cm\n{pairs}"));
    assert!(
        campaign.contains("then = [\"rebound_height_cm\"]"),
        "{campaign}"
    );
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
    let row = |k: usize| {
        let height = 1.0 - 0.2 * k as f64;
        let tops = (0..3).map(|i| format!("{:.3}", read(R * R * height, 5 * k + i)));
        format!("{height:.3},{}\n", tops.collect::<Vec<_>>().join(","))
    };
    let rows: String = (0..4).map(row).collect();
    let (found, campaign) = played(&format!(
        "Drop height (m),Trial 1 (m),Trial 2 (m),Trial 3 (m)\n{rows}"
    ));
    assert!(campaign.contains("content = \"rebounds\""), "{campaign}");
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
}

#[test]
fn one_impact_is_said_to_be_all() {
    let folder = Folder::of(&[(
        "h.csv".to_owned(),
        b"drop height (cm),rebound height (cm)\n100,64\n".to_vec(),
    )]);
    let (said, code) = folder.run(&["init", "day"]);
    assert_eq!(code, 0, "{said}");
    let (said, code) = folder.run(&["check", "day/campaign.toml"]);
    assert_eq!(code, 0, "{said}");
    assert!(
        said.contains("one impact is all that the records show"),
        "{said}"
    );
}
