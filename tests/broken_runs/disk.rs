//! Disks that are full and folders that cannot be written into.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{campaign, hidden};
use crate::support::Lab;

fn shell(lab: &Lab, script: &str) -> (Option<i32>, String) {
    let program = env!("CARGO_BIN_EXE_impactid");
    let output = Command::new("sh")
        .args(["-c", &script.replace("impactid", program)])
        .current_dir(lab.folder())
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

fn assert_yesterday_is_left(lab: &Lab, said: &str) {
    assert!(
        said.contains("could not be written") && said.contains("free space"),
        "{said}"
    );
    assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
    let parts = hidden(&lab.path("out"));
    assert!(parts.iter().all(|p| !p.contains("part")), "{parts:?}");
}

/// Writes fail beyond a limit of the shell, as on a full disk.
#[test]
fn a_failed_write_is_reported_and_the_old_output_stays() {
    let lab = campaign(8);
    fs::create_dir(lab.path("out")).expect("a folder");
    lab.write("out/report.pdf", "the report of yesterday");
    let limited = "trap '' XFSZ; ulimit -f 8; exec impactid run campaign.toml --out out";
    let (code, said) = shell(&lab, limited);
    assert_eq!(code, Some(2), "{said}");
    // what was computed is not lost
    let answer = said.find("The rig has").or(said.find("The data do not"));
    assert!(answer < said.find("could not be written"), "{said}");
    assert!(answer.is_some(), "{said}");
    assert_yesterday_is_left(&lab, &said);
}

/// A disk in memory, unmounted when it goes.
struct SmallDisk(std::path::PathBuf);

impl SmallDisk {
    /// A disk of so many KiB at a folder; `None` where this user may not mount one.
    fn at(folder: &Path, kib: usize) -> Option<Self> {
        let size = format!("size={kib}k");
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &size, "tmpfs"])
            .arg(folder)
            .output();
        mounted
            .is_ok_and(|o| o.status.success())
            .then(|| Self(folder.to_path_buf()))
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).output();
    }
}

#[test]
fn a_full_disk_is_reported_and_the_old_output_stays() {
    let lab = campaign(8);
    fs::create_dir(lab.path("out")).expect("a folder");
    let Some(_disk) = SmallDisk::at(&lab.path("out"), 64) else {
        println!("skipped: this user may not mount a small disk");
        return;
    };
    lab.write("out/report.pdf", "the report of yesterday");
    for command in [
        "impactid -q run campaign.toml --out out",
        "impactid -q ingest campaign.toml --out out",
    ] {
        let (code, said) = shell(&lab, command);
        assert_eq!(code, Some(2), "{said}");
        assert_yesterday_is_left(&lab, &said);
    }
    for target in ["h5", "parquet", "csv"] {
        let command = format!("impactid -q convert records.h5 --out out/all.{target}");
        let (code, said) = shell(&lab, &command);
        assert_eq!(code, Some(2), "{said}");
        assert!(!lab.path(&format!("out/all.{target}")).exists());
        let parts = hidden(&lab.path("out"));
        assert!(parts.is_empty(), "{target}: {parts:?}");
    }
}

/// A description lies beside its records: `init` has no other folder to name.
#[test]
fn init_into_a_folder_that_is_read_only_names_what_can_be_done() {
    let lab = Lab::new();
    fs::create_dir(lab.path("sealed")).expect("a folder");
    let Some(_disk) = SmallDisk::at(&lab.path("sealed"), 1024) else {
        println!("skipped: this user may not mount a small disk");
        return;
    };
    fs::copy(lab.path("r1.csv"), lab.path("sealed/r1.csv")).expect("a record");
    lab.write("sealed/campaign.toml", "the description of yesterday");
    let (code, said) = shell(&lab, "mount -o remount,ro sealed");
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = shell(&lab, "impactid init sealed --force");
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("could not be written") && said.contains("copy the records into one"),
        "{said}"
    );
    assert!(!said.contains("--out"), "{said}");
    assert_eq!(
        lab.read("sealed/campaign.toml"),
        "the description of yesterday"
    );
}

#[test]
fn a_full_standard_output_is_reported() {
    if !Path::new("/dev/full").exists() {
        println!("skipped: there is no /dev/full");
        return;
    }
    let lab = Lab::new();
    for command in [
        "impactid inspect r1.csv",
        "impactid inspect r1.csv --json",
        "impactid selftest",
        "impactid completions bash",
        "impactid boundary --kind s2 --eta 1.2",
    ] {
        let (code, said) = shell(&lab, &format!("{command} > /dev/full"));
        assert_eq!(code, Some(2), "{command}: {said}");
        assert!(!said.contains("panicked"), "{command}: {said}");
    }
    let (code, said) = shell(&lab, "impactid selftest | true");
    assert!(!said.contains("panicked"), "{code:?}: {said}");
}

#[test]
fn a_folder_that_cannot_be_written_into_is_reported() {
    let lab = campaign(8);
    let (code, said) = shell(&lab, "impactid -q run campaign.toml --out /proc/results");
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("the folder /proc/results cannot be written into"),
        "{said}"
    );
    let closed = "mkdir closed && chmod 555 closed && touch closed/probe 2>/dev/null";
    if shell(&lab, closed).0 == Some(0) {
        println!("skipped in part: this user may write everywhere");
        return;
    }
    let (code, said) = shell(&lab, "impactid -q run campaign.toml --out closed");
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("closed cannot be written into") && said.contains("--out"),
        "{said}"
    );
    assert_eq!(fs::read_dir(lab.path("closed")).expect("it").count(), 0);
}
