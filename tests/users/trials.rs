//! Tables whose rows are trials, from `init` to the answer: each row is a throw, with its flights or the times of its
//! impacts along it. The flights follow T' = R T from a first one that the hand makes, read to a millisecond.

use crate::users::experiments::{Folder, holds};

const R: f64 = 0.83;

/// The flights of a throw, s, of which the last may not have been timed.
fn flights(trial: usize, count: usize) -> Vec<f64> {
    let first = 0.6 + 0.05 * (trial as f64 * 2.399_963).sin();
    let read = |i: usize| 1e-3 * ((7 * trial + i) as f64 * 2.399_963).cos();
    let of = |i: usize| first * R.powi(i32::try_from(i).unwrap_or(0)) + read(i);
    (0..count).map(of).collect()
}

fn cells(values: impl Iterator<Item = f64>, unit_s: f64, digits: usize) -> String {
    let cells = values.map(|t| format!("{:.digits$}", t / unit_s));
    cells.collect::<Vec<_>>().join(",")
}

fn played(text: &str) -> (serde_json::Value, String) {
    let folder = Folder::of(&[("trials.csv".to_owned(), text.as_bytes().to_vec())]);
    (folder.play(), folder.campaign())
}

#[test]
fn valid_flights_along_the_rows_of_trials() {
    // the last flight of every third trial is missing
    let row = |k: usize| {
        let count = if k.is_multiple_of(3) { 3 } else { 4 };
        let empty = ",".repeat(4 - count);
        format!(
            "{k},{}{empty}\n",
            cells(flights(k, count).into_iter(), 1e-3, 0)
        )
    };
    let rows: String = (1..9).map(row).collect();
    let (found, campaign) = played(&format!(
        "trial,flight 1 (ms),flight 2 (ms),flight 3 (ms),flight 4 (ms)\n{rows}"
    ));
    assert!(campaign.contains("then = [\"flight 2\""), "{campaign}");
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
    // each trial has an impact more than flights
    assert_eq!(
        found["methods"]["flight_times"]["observations"],
        6 * 5 + 2 * 4
    );
}

#[test]
fn valid_times_along_the_rows_of_trials() {
    let row = |k: usize| {
        let begin = 0.2 + 0.1 * (k % 3) as f64;
        let times = flights(k, 4).into_iter().scan(begin, |time, flight| {
            *time += flight;
            Some(*time)
        });
        let times = std::iter::once(begin).chain(times);
        format!("{k},{}\n", cells(times, 1.0, 3))
    };
    let rows: String = (1..7).map(row).collect();
    let (found, campaign) = played(&format!(
        "trial,bounce 1 (s),bounce 2 (s),bounce 3 (s),bounce 4 (s),bounce 5 (s)\n{rows}"
    ));
    assert!(campaign.contains("content = \"times\""), "{campaign}");
    assert!(holds(&found, "restitution", R), "{}", found["joint"]);
}

#[test]
fn flights_of_trials_below_each_other_determine_no_restitution() {
    let rows: String = (1..11)
        .map(|k| format!("{:.3}\n", flights(k, 1)[0]))
        .collect();
    let folder = Folder::of(&[(
        "trials.csv".to_owned(),
        format!("flight (s)\n{rows}").into_bytes(),
    )]);
    let found = folder.play();
    let restitution = &found["joint"]["restitution"];
    assert_eq!(
        restitution["note"]["kind"], "flights_alike",
        "{restitution}"
    );
    assert_eq!(found["verdict"]["kind"], "weak");
}
