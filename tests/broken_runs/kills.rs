//! SIGKILL at random moments: while records are observed and observations are kept, while the
//! parameters are fitted, and while the outputs are written.

use impact_records::signal::whole;
use std::collections::BTreeMap;
use std::fs;
use std::time::{Duration, Instant};

use super::{RUN, assert_same, campaign, hidden, outputs, program};
use crate::support::Lab;

/// Moments at which a run is killed; `IMPACTID_KILLS` sets another number.
const KILLS: u64 = 104;

/// Kills of the same run, resumed again and again, before it may end.
const IN_A_ROW: u64 = 8;

fn kills() -> u64 {
    std::env::var("IMPACTID_KILLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(KILLS)
}

/// What is killed: a campaign with a command, and what an undisturbed run of it leaves.
struct Victim {
    lab: Lab,
    command: Vec<&'static str>,
    expected: BTreeMap<String, Vec<u8>>,
    code: i32,
    time: Duration,
}

/// The records of a campaign at its widest gap, where nothing touches: a run that is soon done.
fn resonance_curve() -> Lab {
    let lab = campaign(240);
    let rows: Vec<String> = lab
        .read("runs.csv")
        .lines()
        .take(25)
        .map(String::from)
        .collect();
    lab.write("runs.csv", &(rows.join("\n") + "\n"));
    lab
}

impl Victim {
    fn new(lab: Lab, formats: &'static str) -> Self {
        let mut command = RUN.to_vec();
        command.extend(["--format", formats]);
        let begin = Instant::now();
        let ran = lab.run(&command);
        assert!(ran.code == 0 || ran.code == 1, "{}", ran.said);
        let expected = outputs(&lab.path("out"));
        assert!(expected.contains_key("identification.json"));
        fs::remove_dir_all(lab.path("out")).expect("the outputs");
        Self {
            lab,
            command,
            expected,
            code: ran.code,
            time: begin.elapsed(),
        }
    }

    /// The program, keeping the observations of however few records.
    fn run(&self, resume: bool) -> std::process::Command {
        let mut command = self.command.clone();
        if resume {
            command.push("--resume");
        }
        let mut run = program(&self.lab, &command);
        run.env("IMPACTID_KEEP_FROM", "1");
        run
    }

    /// Chunks of observations that a run has kept.
    fn kept(&self) -> usize {
        let folder = self.lab.path("out").join(".impactid-observed");
        let names = fs::read_dir(folder).into_iter().flatten().flatten();
        names
            .filter(|e| e.file_name().to_string_lossy().ends_with(".json.gz"))
            .count()
    }

    /// Run, and kill at a moment; whether it was still running.
    fn kill(&self, resume: bool, moment: Moment) -> bool {
        let mut run = self.run(resume).spawn().expect("it starts");
        let begin = Instant::now();
        let mut wait_for = |reached: &dyn Fn() -> bool| {
            let late = || begin.elapsed() > Duration::from_secs(60);
            while !reached() && matches!(run.try_wait(), Ok(None)) && !late() {
                std::thread::yield_now();
            }
        };
        match moment {
            Moment::After(part) => std::thread::sleep(self.time.mul_f64(part)),
            Moment::Keeping(chunks) => wait_for(&|| self.kept() >= chunks),
            Moment::Writing(files) => {
                wait_for(&|| outputs(&self.lab.path("out")).len() >= files);
            }
        }
        let running = matches!(run.try_wait(), Ok(None));
        run.kill().expect("it can be killed");
        run.wait().expect("it ends");
        running
    }

    /// Nothing bears a final name that is not whole.
    fn assert_whole(&self, kill: u64) {
        for (name, bytes) in outputs(&self.lab.path("out")) {
            let whole = self.expected.get(&name).is_some_and(|e| *e == bytes);
            assert!(whole, "{name} is half-written after kill {kill}");
        }
    }

    /// What was killed goes on to the bytes of an undisturbed run, and leaves nothing beside.
    fn assert_resumes(&self) {
        let out = self.lab.path("out");
        let ended = self.run(true).status().expect("it runs");
        assert_eq!(ended.code(), Some(self.code));
        assert_same(&outputs(&out), &self.expected);
        assert_eq!(hidden(&out), Vec::<String>::new());
        fs::remove_dir_all(&out).expect("the outputs");
    }
}

#[derive(Clone, Copy)]
enum Moment {
    /// After a part of an undisturbed run's time.
    After(f64),
    /// As soon as so many chunks of observations are kept.
    Keeping(usize),
    /// As soon as so many outputs are there.
    Writing(usize),
}

/// A reproducible number in 0 … 1 (splitmix64).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// What kills met.
#[derive(Default, Clone, Copy)]
struct Met {
    /// Those that met a running program.
    running: u64,
    /// Those that left observations to take over.
    kept: u64,
}

fn kill_again_and_again(victim: &Victim, seed: u64, kills: u64) -> Met {
    let mut state = seed;
    let mut met = Met::default();
    for kill in 0..kills {
        let moment = match kill % 3 {
            0 => {
                let outputs = victim.expected.len() as f64;
                Moment::Writing(1 + whole::index(random(&mut state) * outputs))
            }
            1 => Moment::Keeping(1 + whole::index(random(&mut state) * 3.0)),
            _ => Moment::After(random(&mut state)),
        };
        let resume = kill % IN_A_ROW != 0;
        met.running += u64::from(victim.kill(resume, moment));
        met.kept += u64::from(victim.kept() > 0);
        victim.assert_whole(kill);
        if (kill + 1) % IN_A_ROW == 0 || kill + 1 == kills {
            victim.assert_resumes();
        }
    }
    met
}

#[test]
fn a_killed_run_leaves_nothing_half_written_and_resumes_to_the_same_bytes() {
    let all = kills();
    let victims = [
        (resonance_curve(), "csv", 3, all - all / 4),
        (campaign(8), "html,svg", 5, all / 4),
    ];
    let met: Vec<Met> = std::thread::scope(|scope| {
        let threads = victims.map(|(lab, formats, seed, kills)| {
            scope.spawn(move || {
                let victim = Victim::new(lab, formats);
                kill_again_and_again(&victim, seed, kills)
            })
        });
        threads.map(|t| t.join().expect("no panic")).to_vec()
    });
    let running: u64 = met.iter().map(|m| m.running).sum();
    let kept: u64 = met.iter().map(|m| m.kept).sum();
    let said = format!(
        "of {all} kills {running} met a running program and {kept} left observations to take over"
    );
    assert!(running * 2 > all && kept * 4 > all, "{said}");
    println!("{said}");
}
