//! The watcher with times that the test gives.

use std::time::Duration;

use impact_campaign::pipeline::watch::{News, Pace, Seen, WatchPatience, Watcher};

use crate::support::{Lab, table};

/// Looks at a campaign every five seconds, after which files have settled.
struct Looking {
    watcher: Watcher,
    now: Duration,
}

impl Looking {
    fn at(lab: &Lab) -> Self {
        let pace = Pace {
            patience: WatchPatience::default(),
            idle: Duration::from_secs(20),
        };
        let watcher = Watcher::new(&lab.path("campaign.toml"), pace).expect("a good campaign");
        Self {
            watcher,
            now: Duration::ZERO,
        }
    }

    fn look(&mut self) -> Seen {
        let seen = self.watcher.look(self.now);
        self.now += Duration::from_secs(5);
        assert!(seen.faults.0.is_empty(), "{:?}", seen.faults);
        seen
    }

    /// How many records were observed at each of so many looks.
    fn observed(&mut self, looks: usize) -> Vec<usize> {
        (0..looks).map(|_| self.look().observed).collect()
    }

    fn records(&self) -> Vec<String> {
        let outline = self.watcher.outline();
        outline.records.into_iter().map(|o| o.record).collect()
    }
}

#[test]
fn each_record_is_observed_once_and_again_only_when_it_changes() {
    let lab = Lab::new();
    let mut looking = Looking::at(&lab);
    assert_eq!(looking.observed(4), [0, 3, 0, 0]);
    assert_eq!(looking.records(), ["r1", "r2", "r3"]);
    // a row more
    lab.write(
        "r2.csv",
        &(lab.read("r2.csv") + "1.000000,0.1,0.02,0.1,0.1\n"),
    );
    assert_eq!(looking.observed(3), [0, 1, 0]);
    // a line of the run table for a file that is already there: first the table settles, then the file
    lab.write("r4.csv", &table(12.5));
    lab.write(
        "runs.csv",
        &(lab.read("runs.csv") + "r4.csv,12.5,1.0,down\n"),
    );
    assert_eq!(looking.observed(5).iter().sum::<usize>(), 1);
    assert_eq!(looking.records(), ["r1", "r2", "r3", "r4"]);
    // the setting of one record
    lab.replace("runs.csv", "r3.csv,13,1.0", "r3.csv,13,1.1");
    assert_eq!(looking.observed(3), [1, 0, 0]);
    // what all observations depend on
    lab.edit("longest_period_n = 6", "longest_period_n = 5");
    assert_eq!(looking.observed(3), [4, 0, 0]);
    // what none depends on
    lab.edit("paper = \"a4\"", "paper = \"us-letter\"");
    assert_eq!(looking.observed(3), [0, 0, 0]);
    assert_eq!(looking.watcher.waiting(), 0);
}

#[test]
fn of_a_file_that_grows_only_the_new_records_are_observed() {
    let lab = Lab::new();
    let files = |names: &[&str], out: &str| {
        let made = lab.run(&[&["-q", "convert"], names, &["--out", out]].concat());
        assert_eq!(made.code, 0, "{}", made.said);
    };
    files(&["r1.csv", "r2.csv"], "two.h5");
    files(&["r1.csv", "r2.csv", "r3.csv"], "three.h5");
    let place = |name: &str| std::fs::copy(lab.path(name), lab.path("day.h5")).expect("a copy");
    lab.edit("run_table = \"runs.csv\"", "files = \"day.h5\"");
    let mut looking = Looking::at(&lab);
    assert_eq!(looking.observed(2), [0, 0]);
    place("two.h5");
    assert_eq!(looking.observed(3), [0, 2, 0]);
    place("three.h5");
    let seen = looking.look();
    assert_eq!((seen.observed, seen.news.len()), (0, 0));
    // what was taken stays until the file has settled
    assert_eq!((looking.records().len(), looking.watcher.waiting()), (2, 1));
    assert_eq!(looking.observed(2), [1, 0]);
    assert_eq!(looking.records().len(), 3);
}

#[test]
fn records_that_are_gone_leave_the_answer() {
    let lab = Lab::new();
    let mut looking = Looking::at(&lab);
    looking.observed(2);
    lab.remove("r2.csv");
    let seen = looking.look();
    assert_eq!(seen.news, [News::Removed(lab.path("r2.csv"))]);
    assert_eq!(looking.records(), ["r1", "r3"]);
    lab.replace("runs.csv", "r3.csv,13,1.0,down\n", "");
    let seen = looking.look();
    assert_eq!(seen.news, []);
    assert_eq!(looking.records(), ["r1"]);
    let seen = looking.look();
    assert_eq!(seen.news, [News::Unlisted(lab.path("r3.csv"))]);
    assert_eq!(looking.records(), ["r1"]);
}
