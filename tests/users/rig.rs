//! A simulated rig's records as numbers, to be saved as laboratories save them, and the way from `init` to the answer.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use crate::support::{Lab, assert_holds_the_truth};

/// Samples a second of the simulated rig.
pub(super) const RATE_HZ: f64 = 2000.0;

/// A record of the simulated rig with its setting.
pub(super) struct Take {
    pub(super) frequency_hz: String,
    pub(super) clearance_mm: String,
    pub(super) upward: bool,
    /// Samples by the channel's name, V.
    volts: BTreeMap<String, Vec<f64>>,
}

impl Take {
    /// A channel in what a volt of it is.
    pub(super) fn channel(&self, name: &str, per_volt: f64) -> Vec<f64> {
        let volts = self.volts.get(name).expect("a channel of the rig");
        volts.iter().map(|v| per_volt * v).collect()
    }

    /// Times of the samples, s.
    pub(super) fn times(&self) -> Vec<f64> {
        let count = self.volts.values().next().map_or(0, Vec::len);
        (0..count).map(|i| i as f64 / RATE_HZ).collect()
    }
}

/// State a key of a channel that `init` has written.
pub(super) fn state(lab: &Lab, channel: &str, key: &str) {
    let line = format!("channel = \"{channel}\"");
    lab.replace("day/campaign.toml", &line, &format!("{line}\n{key}"));
}

/// Run the program; it must do what it is asked.
pub(super) fn done(lab: &Lab, arguments: &[&str]) -> String {
    let ran = lab.run(arguments);
    assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.said);
    ran.said
}

/// The records of a campaign that `impactid simulate campaign` writes into the folder `rig`; an empty folder `day` beside
/// it.
pub(super) fn takes(lab: &Lab, rig: &[&str]) -> Vec<Take> {
    let simulate = ["-q", "simulate", "campaign", "--out", "rig"];
    done(lab, &[&simulate[..], rig].concat());
    done(
        lab,
        &["-q", "convert", "rig/records.h5", "--out", "records.csv"],
    );
    fs::create_dir(lab.path("day")).expect("a folder");
    let take = |run: &str| {
        let cells: Vec<&str> = run.split(',').collect();
        let [_, record, frequency, clearance, sweep] = cells[..] else {
            panic!("{run}")
        };
        Take {
            frequency_hz: frequency.to_owned(),
            clearance_mm: clearance.to_owned(),
            upward: sweep == "up",
            volts: columns(&lab.read(&format!("records/{record}.csv"))),
        }
    };
    lab.read("rig/runs.csv").lines().skip(1).map(take).collect()
}

fn columns(record: &str) -> BTreeMap<String, Vec<f64>> {
    let mut lines = record.lines().filter(|l| !l.starts_with('#'));
    let heads = lines.next().expect("heads").split(',');
    let names: Vec<String> = heads
        .map(|h| h.split(' ').next().unwrap_or(h).to_owned())
        .collect();
    let mut columns = vec![Vec::new(); names.len()];
    for line in lines {
        for (column, cell) in columns.iter_mut().zip(line.split(',')) {
            column.push(cell.parse().expect("a number"));
        }
    }
    names.into_iter().zip(columns).collect()
}

/// `check` and `run` on the campaign in `day`: all records can be used, the report is there, and each interval holds the
/// truth.
pub(super) fn assert_the_answer_is_true(lab: &Lab, records: usize) {
    let checked = done(lab, &["check", "day/campaign.toml"]);
    let all = format!("{records} of {records} records can be used");
    assert!(checked.contains(&all), "{checked}");
    assert!(checked.contains("0 errors, 0 warnings"), "{checked}");
    done(lab, &["run", "day/campaign.toml", "--out", "results"]);
    assert!(lab.path("results/report.pdf").exists());
    let read = |name: &str| -> Value { serde_json::from_str(&lab.read(name)).expect("JSON") };
    let (found, truth) = (read("results/identification.json"), read("rig/truth.json"));
    assert_holds_the_truth(&found, &truth);
}
