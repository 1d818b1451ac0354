//! Ctrl-C, and two runs into one folder.
#![cfg(unix)]

use std::cell::Cell;
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, waitid};

use super::{RUN, campaign, hidden, outputs, program};
use crate::support::{Lab, send};

/// Whether the program now stands still; `false` where it has ended.
fn halt(child: &Child) -> bool {
    send(child, Signal::STOP);
    let either = WaitIdOptions::STOPPED | WaitIdOptions::EXITED | WaitIdOptions::NOWAIT;
    let state = waitid(WaitId::Pid(Pid::from_child(child)), either).expect("its state");
    state.expect("it stands still or has ended").stopped()
}

/// Start a command and halt it as soon as `reached` holds while it stands still: what the test does
/// meanwhile may take as long as a busy machine needs. A command that was done first is started
/// again, after `again`.
fn halted_when(mut command: Command, reached: impl Fn() -> bool, again: impl Fn()) -> Child {
    for _ in 0..20 {
        let mut child = command.spawn().expect("the program starts");
        while halt(&child) {
            if reached() {
                return child;
            }
            send(&child, Signal::CONT);
            std::thread::sleep(Duration::from_millis(1));
        }
        child.wait().expect("it ends");
        again();
    }
    panic!("the command was done each time before it could be halted");
}

/// Whether a program holds the right to write into the results' folder.
fn is_locked(lab: &Lab) -> bool {
    let lock = fs::File::open(lab.path("out/.impactid.lock"));
    lock.is_ok_and(|file| matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)))
}

#[test]
fn a_second_run_into_the_same_folder_is_refused() {
    let lab = campaign(66);
    let mut first = halted_when(program(&lab, RUN), || is_locked(&lab), || ());
    let second = lab.run(RUN);
    let stage = lab.run(&["-q", "classify", "out"]);
    send(&first, Signal::CONT);
    assert_eq!(first.wait().expect("it ends").code(), Some(0));
    for ran in [second, stage] {
        assert_eq!(ran.code, 2);
        assert!(
            ran.said.contains("another run of impactid writes into out"),
            "{}",
            ran.said
        );
    }
    assert!(hidden(&lab.path("out")).is_empty());
    assert!(outputs(&lab.path("out")).contains_key("report.pdf"));
}

fn spoken(mut run: Child) -> (String, Option<i32>) {
    let mut said = String::new();
    let words = run.stderr.as_mut().expect("its words");
    std::io::Read::read_to_string(words, &mut said).expect("text");
    (said, run.wait().expect("it ends").code())
}

/// The program with its messages in a pipe.
fn speaking(lab: &Lab, args: &[&str]) -> Command {
    let mut command = program(lab, args);
    command.stderr(Stdio::piped());
    command
}

#[test]
fn ctrl_c_is_reported_ends_with_130_and_loses_nothing() {
    let lab = campaign(66);
    fs::create_dir(lab.path("out")).expect("a folder");
    let of_yesterday = || lab.write("out/report.pdf", "the report of yesterday");
    of_yesterday();
    for signal in [Signal::INT, Signal::TERM] {
        let command = speaking(&lab, &["run", "campaign.toml", "--out", "out"]);
        // in the middle of the run: it goes on for a while after it took its folder
        let looks = Cell::new(0);
        let is_under_way = || {
            looks.set(looks.get() + usize::from(is_locked(&lab)));
            is_locked(&lab) && looks.get() > 100
        };
        let run = halted_when(command, is_under_way, of_yesterday);
        send(&run, signal);
        send(&run, Signal::CONT);
        let (said, code) = spoken(run);
        assert_eq!(code, Some(130), "{said}");
        assert!(
            said.contains("interrupted") && said.contains("--resume"),
            "{said}"
        );
        assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
        let parts = hidden(&lab.path("out"));
        assert!(parts.iter().all(|p| !p.contains("part")), "{parts:?}");
    }
}

#[test]
fn ctrl_c_leaves_no_file_of_a_folder_that_is_being_written() {
    // so many that writing them takes far longer than noticing a signal
    let lab = campaign(300);
    fs::create_dir(lab.path("tables")).expect("a folder");
    lab.write("tables/other.csv", "of another program");
    let convert = ["convert", "records.h5", "--out", "tables/day.csv"];
    let is_writing = || {
        let parts = hidden(&lab.path("tables"));
        parts.iter().any(|p| p.contains("part"))
    };
    let run = halted_when(speaking(&lab, &convert), is_writing, || {
        let _ = fs::remove_dir_all(lab.path("tables/day"));
    });
    send(&run, Signal::INT);
    send(&run, Signal::CONT);
    let (said, code) = spoken(run);
    assert_eq!(code, Some(130), "{said}");
    assert!(
        said.contains("interrupted") && !said.contains("could not"),
        "{said}"
    );
    let left = outputs(&lab.path("tables"));
    assert_eq!(left.keys().collect::<Vec<_>>(), ["other.csv"]);
    assert!(hidden(&lab.path("tables")).is_empty());
    // the same command starts again
    let again = lab.run(&["-q", "convert", "records.h5", "--out", "tables/day.csv"]);
    assert_eq!(again.code, 0, "{}", again.said);
    assert_eq!(outputs(&lab.path("tables/day")).len(), 300);
}
