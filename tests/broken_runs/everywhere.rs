//! Locks, interrupts and files that another program holds, in a way that every system has.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use labfiles_write::output::Lock;

use super::{RUN, campaign, hidden, outputs, program};
use crate::support::{Lab, interrupt, interruptible};

#[test]
fn a_folder_whose_lock_another_holds_is_refused_until_it_is_let_go() {
    let lab = campaign(8);
    let held = Lock::take(&lab.path("out")).expect("the lock");
    let refused = lab.run(RUN);
    assert_eq!(refused.code, 2, "{}", refused.said);
    assert!(
        refused
            .said
            .contains("another run of impactid writes into out"),
        "{}",
        refused.said
    );
    drop(held);
    let stages = ["-q", "ingest", "campaign.toml", "--out", "out"];
    assert_eq!(lab.run(&stages).code, 0);
    assert!(hidden(&lab.path("out")).is_empty());
}

/// A run with its messages in a pipe, as soon as it has its folder.
fn begun(lab: &Lab) -> Child {
    let mut command = program(lab, &["run", "campaign.toml", "--out", "out"]);
    let command = interruptible(&mut command).stderr(Stdio::piped());
    let run = command.spawn().expect("the program starts");
    let begin = Instant::now();
    while !lab.path("out/.impactid.lock").exists() {
        assert!(begin.elapsed() < Duration::from_secs(300), "it never began");
        std::thread::sleep(Duration::from_millis(5));
    }
    run
}

#[test]
fn a_run_that_is_interrupted_says_so_and_leaves_nothing_half_written() {
    let lab = campaign(66);
    fs::create_dir(lab.path("out")).expect("a folder");
    lab.write("out/report.pdf", "the report of yesterday");
    let mut run = begun(&lab);
    interrupt(&run);
    let mut said = String::new();
    let words = run.stderr.as_mut().expect("its words");
    std::io::Read::read_to_string(words, &mut said).expect("text");
    let code = run.wait().expect("it ends").code();
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("interrupted"), "{said}");
    assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
    let left = outputs(&lab.path("out"));
    assert_eq!(left.keys().collect::<Vec<_>>(), ["report.pdf"]);
    let parts = hidden(&lab.path("out"));
    assert!(parts.iter().all(|p| !p.contains("part")), "{parts:?}");
}

#[test]
fn a_run_whose_terminal_is_gone_ends_all_the_same() {
    let lab = campaign(66);
    let mut run = begun(&lab);
    drop(run.stderr.take());
    interrupt(&run);
    let begin = Instant::now();
    let code = loop {
        if let Some(status) = run.try_wait().expect("its state") {
            break status.code();
        }
        if begin.elapsed() > Duration::from_secs(300) {
            run.kill().expect("it is killed");
            panic!("it never ended");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(code, Some(130));
}

/// A file that cannot be replaced.
struct Held {
    #[cfg(unix)]
    file: PathBuf,
    #[cfg(windows)]
    _open: fs::File,
}

impl Held {
    /// Mount a file onto itself; `None` where this user may not.
    #[cfg(unix)]
    fn at(file: PathBuf) -> Option<Self> {
        let mut mount = std::process::Command::new("mount");
        let mounted = mount.arg("--bind").args([&file, &file]).output();
        let done = mounted.is_ok_and(|o| o.status.success());
        done.then_some(Self { file })
    }

    /// Open a file as viewers do, which let others read alone.
    #[cfg(windows)]
    fn at(file: PathBuf) -> Option<Self> {
        const FILE_SHARE_READ: u32 = 1;
        let mut options = fs::File::options();
        std::os::windows::fs::OpenOptionsExt::share_mode(&mut options, FILE_SHARE_READ);
        let _open = options.read(true).open(file).expect("it is there");
        Some(Self { _open })
    }
}

#[cfg(unix)]
impl Drop for Held {
    fn drop(&mut self) {
        let mut umount = std::process::Command::new("umount");
        let _ = umount.arg(&self.file).output();
    }
}

#[test]
fn a_report_that_another_program_holds_is_written_beside_it() {
    let lab = campaign(8);
    fs::create_dir(lab.path("out")).expect("a folder");
    lab.write("out/report.pdf", "the report of yesterday");
    let Some(_held) = Held::at(lab.path("out/report.pdf")) else {
        println!("skipped: this user may not mount a file");
        return;
    };
    let ran = lab.run(&["run", "campaign.toml", "--out", "out"]);
    assert!(matches!(ran.code, 0 | 1), "{}", ran.said);
    let said = ran.said.split_whitespace().collect::<Vec<_>>().join(" ");
    let of = |name: &str| PathBuf::from("out").join(name).display().to_string();
    for words in [
        format!("Report (pdf): {}", of("report.new.pdf")),
        format!("{} is held by another program", of("report.pdf")),
    ] {
        assert!(said.contains(&words), "{words} is not in {said}");
    }
    assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
    let new = fs::read(lab.path("out/report.new.pdf")).expect("the new report");
    assert!(new.starts_with(b"%PDF"));
    // all else is there as ever, and the report can be written again
    assert!(lab.path("out/identification.json").is_file());
    let again = lab.run(&["report", "out", "--format", "pdf", "--language", "de"]);
    assert_eq!(again.code, 0, "{}", again.said);
    let words = format!("Bericht (pdf): {}", of("report.new.pdf"));
    assert!(again.said.contains(&words), "{}", again.said);
}
