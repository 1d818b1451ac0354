//! A good campaign in a temporary folder, and the program run in it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Samples a second of the records.
pub(crate) const RATE_HZ: f64 = 2000.0;

/// Samples in a record.
pub(crate) const SAMPLES: usize = 2000;

/// The good campaign.toml.
pub(crate) const CAMPAIGN: &str = r#"[campaign]
name = "Test rig"
machine = "double"
flight = "harmonic"

[records]
run_table = "runs.csv"

[rig]
natural_frequency = "12.6 Hz"
damping_ratio = 0.07
restitution = 0.9

[channels.drive]
channel = "drive"
unit = "V"

[channels.contact]
channel = "contact"
unit = "V"
threshold = "2.5 V"

[channels.velocity_x]
channel = "vx"
unit = "V"
scale = "50 mm/s per V"
high_pass = "0.5 Hz"
sign = 1

[channels.velocity_y]
channel = "vy"
unit = "V"
scale = "50 mm/s per V"

[analysis]
longest_period_n = 6
seed = 1

[report]
paper = "a4"
"#;

/// The good run table.
pub(crate) const RUNS: &str = "file,drive_frequency_hz,clearance_mm,sweep\n\
    r1.csv,11,1.0,up\nr2.csv,12,1.0,up\nr3.csv,13,1.0,down\n";

/// A command whose program a test may interrupt: on Windows alone in its group, which is what Ctrl-Break reaches.
pub(crate) fn interruptible(command: &mut Command) -> &mut Command {
    #[cfg(windows)]
    {
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
    }
    command
}

/// Ctrl-C to a program.
#[cfg(unix)]
pub(crate) fn interrupt(program: &std::process::Child) {
    send(program, rustix::process::Signal::INT);
}

/// Ctrl-Break to a program that is alone in its group; Ctrl-C would reach all of the console.
#[cfg(windows)]
pub(crate) fn interrupt(program: &std::process::Child) {
    use windows_sys::Win32::System::Console::{CTRL_BREAK_EVENT, GenerateConsoleCtrlEvent};
    // SAFETY: the call takes two numbers and keeps nothing
    let sent = unsafe { GenerateConsoleCtrlEvent(CTRL_BREAK_EVENT, program.id()) };
    assert!(sent != 0, "the event is sent");
}

/// Send a program a signal.
#[cfg(unix)]
pub(crate) fn send(program: &std::process::Child, signal: rustix::process::Signal) {
    let id = rustix::process::Pid::from_child(program);
    rustix::process::kill_process(id, signal).expect("a signal is sent");
}

/// What a program run left behind.
pub(crate) struct Ran {
    /// Both output streams.
    pub said: String,
    /// Its exit code; -1 where a signal ended it.
    pub code: i32,
}

/// A folder with a campaign.
pub(crate) struct Lab {
    folder: tempfile::TempDir,
}

impl Lab {
    /// A good campaign: three records with one impact a drive period.
    pub(crate) fn new() -> Self {
        let lab = Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        };
        lab.write("campaign.toml", CAMPAIGN);
        lab.write("runs.csv", RUNS);
        for (name, frequency_hz) in [("r1.csv", 11.0), ("r2.csv", 12.0), ("r3.csv", 13.0)] {
            lab.write(name, &table(frequency_hz));
        }
        lab
    }

    /// Path of a file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The folder.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Write a file.
    pub(crate) fn write(&self, name: &str, text: &str) {
        self.write_bytes(name, text.as_bytes());
    }

    /// Write a file of bytes.
    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).expect("the test folder can be written");
    }

    /// Remove a file.
    pub(crate) fn remove(&self, name: &str) {
        fs::remove_file(self.path(name)).expect("it is there");
    }

    /// Read a file.
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("it is there")
    }

    /// Replace a text that must be in a file.
    pub(crate) fn replace(&self, name: &str, from: &str, to: &str) {
        let text = self.read(name);
        assert!(text.contains(from), "'{from}' is not in {name}");
        self.write(name, &text.replace(from, to));
    }

    /// Replace in campaign.toml.
    pub(crate) fn edit(&self, from: &str, to: &str) {
        self.replace("campaign.toml", from, to);
    }

    /// Change the lines of a record: header is line 0; `None` drops the line.
    pub(crate) fn lines(&self, name: &str, change: impl Fn(usize, &str) -> Option<String>) {
        let text = self.read(name);
        let lines: Vec<String> = text
            .lines()
            .enumerate()
            .filter_map(|(i, l)| change(i, l))
            .collect();
        self.write(name, &(lines.join("\n") + "\n"));
    }

    /// Change one column of a record by sample number and value.
    pub(crate) fn column(&self, name: &str, column: usize, change: impl Fn(usize, f64) -> String) {
        self.lines(name, |i, line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if i > 0 {
                let value = cells[column].parse().expect("a number");
                cells[column] = change(i - 1, value);
            }
            Some(cells.join(","))
        });
    }

    /// Run the program in the folder.
    pub(crate) fn run(&self, args: &[&str]) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(args)
            .current_dir(self.folder())
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr);
        Ran {
            said,
            code: output.status.code().unwrap_or(-1),
        }
    }
}

/// The format chunk of a WAV file: one channel of 16 bits, 2,000 samples a second.
pub(crate) fn wav_format() -> Vec<u8> {
    let mut chunk = b"fmt ".to_vec();
    chunk.extend(16_u32.to_le_bytes());
    chunk.extend([1, 0, 1, 0]);
    chunk.extend(2000_u32.to_le_bytes());
    chunk.extend(4000_u32.to_le_bytes());
    chunk.extend([2, 0, 16, 0]);
    chunk
}

/// Velocity of a mass in one period of a motion with one impact: from -0.9 v up to v.
fn velocity(phase: f64) -> f64 {
    let s = phase.rem_euclid(1.0);
    -0.9 + 1.9 * s + 0.3 * (std::f64::consts::TAU * s).sin()
}

/// A record as CSV: time, drive, contact, both velocities in V.
pub(crate) fn table(frequency_hz: f64) -> String {
    let mut text = String::from("time [s],drive [V],contact [V],vx [V],vy [V]\n");
    for i in 0..SAMPLES {
        let t = i as f64 / RATE_HZ;
        let phase = frequency_hz * t;
        let drive = (std::f64::consts::TAU * phase).cos();
        let closed = (phase - 0.3).rem_euclid(1.0) < frequency_hz * 1.2e-3;
        let contact = if closed { 5.0 } else { 0.02 };
        let noise = 1e-4 * ((i * 7919 % 1009) as f64 / 1009.0 - 0.5);
        let v = 2.0 * velocity(phase - 0.3) + noise;
        let _ = writeln!(
            text,
            "{t:.6},{:.6},{contact:.3},{v:.6},{:.6}",
            drive + noise,
            0.98 * v + 2.0 * noise
        );
    }
    text
}

/// The files of a folder and of those below it, by their paths.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        if path.is_dir() {
            let below = files(&path).into_iter();
            all.extend(below.map(|(n, bytes)| (format!("{name}/{n}"), bytes)));
        } else {
            all.insert(name.into_owned(), fs::read(&path).expect("a file"));
        }
    }
    all
}

/// That the joint interval of each parameter of an identification holds the truth of a simulated campaign.
pub(crate) fn assert_holds_the_truth(found: &serde_json::Value, truth: &serde_json::Value) {
    for parameter in [
        "restitution",
        "natural_frequency_hz",
        "damping_ratio",
        "static_deflection_m",
    ] {
        let interval = &found["joint"][parameter]["interval95"];
        let [low, high] = [0, 1].map(|i| interval[i].as_f64().expect("an interval"));
        let value = truth[parameter].as_f64().expect("a number");
        assert!(
            low < value && value < high,
            "{parameter}: {value} not in {interval}"
        );
    }
}
