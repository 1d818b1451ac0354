//! Many campaigns as an array of jobs: docs/slurm-campaigns.sh with the variables that Slurm sets.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Command;

/// A script of bash in a folder, with the program on the path: its exit code and what it said.
fn bash(folder: &Path, arguments: &[&str], variable: (&str, &str)) -> (Option<i32>, String) {
    let program = Path::new(env!("CARGO_BIN_EXE_impactid"));
    let here = program.parent().expect("a folder").display();
    let path = std::env::var("PATH").unwrap_or_default();
    let out = Command::new("bash")
        .args(arguments)
        .current_dir(folder)
        .env("PATH", format!("{here}:{path}"))
        .env("SLURM_CPUS_PER_TASK", "2")
        .env(variable.0, variable.1)
        .output()
        .expect("bash");
    let said = [out.stdout, out.stderr].concat();
    (out.status.code(), String::from_utf8_lossy(&said).into())
}

#[test]
fn campaigns_of_an_array_of_jobs_are_compared() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/slurm-campaigns.sh");
    let script = script.to_str().expect("a path that is text");
    let lab = tempfile::tempdir().expect("a temporary folder");
    for (name, seed) in [("day 1", "5"), ("day2", "6")] {
        let line =
            format!("impactid -q simulate campaign --records 20 --seed {seed} --out '{name}'");
        let (code, said) = bash(lab.path(), &["-c", &line], ("SEED", seed));
        assert_eq!(code, Some(0), "{said}");
    }
    let list = "day 1/campaign.toml\nnone/campaign.toml\nday2/campaign.toml\n";
    fs::write(lab.path().join("list.txt"), list).expect("room");
    let job = |variable| bash(lab.path(), &[script, "list.txt", "results"], variable);

    for (task, expected) in [("1", 0), ("2", 2), ("3", 0)] {
        let (code, said) = job(("SLURM_ARRAY_TASK_ID", task));
        assert_eq!(code, Some(expected), "task {task}: {said}");
    }
    for folder in ["0001-day 1", "0003-day2"] {
        let report = lab.path().join("results").join(folder).join("report.pdf");
        assert!(report.is_file(), "{folder}");
    }
    let (code, said) = job(("COMPARE", "1"));
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("none/campaign.toml has no results and is left out"),
        "{said}"
    );
    let comparison = lab.path().join("results/comparison/comparison.json");
    assert!(comparison.is_file(), "{said}");
}
