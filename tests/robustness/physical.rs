//! Inputs that are well formed and cannot be.

use super::{Case, noted, refused};
use crate::support::{Lab, RATE_HZ};

/// Add a displacement of x, the integral of its velocity times a factor, to every record.
fn with_displacement(lab: &Lab, factor: f64) {
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        let text = lab.read(name);
        let mut sum = 0.0;
        let mut lines = Vec::new();
        for (i, line) in text.lines().enumerate() {
            if i == 0 {
                lines.push(format!("{line},dx [mm]"));
                continue;
            }
            let v: f64 = line
                .split(',')
                .nth(3)
                .and_then(|c| c.parse().ok())
                .expect("a number");
            sum += 50.0 * v / RATE_HZ;
            lines.push(format!("{line},{:.6}", factor * sum));
        }
        lab.write(name, &(lines.join("\n") + "\n"));
    }
    lab.mend(
        "[analysis]",
        "[channels.displacement_x]\nchannel = \"dx\"\n\n[analysis]",
    );
}

/// The cases.
pub fn cases() -> Vec<Case> {
    vec![
        noted(
            "a drive frequency that is not the stated one",
            |lab| lab.replace("runs.csv", "r2.csv,12", "r2.csv,14"),
            &[
                "r2.csv: r2: drive",
                "the drive channel shows 12.00",
                "states 14.0",
            ],
        ),
        refused(
            "a drive channel without a tone",
            |lab| {
                lab.column("r2.csv", 1, |i, _| {
                    format!("{}", (i * 7919 % 1009) as f64 / 1009.0)
                });
            },
            &[
                "r2.csv: r2: drive",
                "no single harmonic tone",
                "2 of 3 records can be used",
            ],
        ),
        noted(
            "a contact that closes without a jump of the velocity",
            |lab| {
                lab.column("r2.csv", 3, |i, _| smooth(i));
                lab.column("r2.csv", 4, |i, _| smooth(i + 3));
            },
            &["r2.csv: r2: contact", "without a jump of the velocity"],
        ),
        refused(
            "velocities counted away from the other mass",
            |lab| {
                lab.mend("sign = 1", "sign = -1");
                lab.mend("channel = \"vy\"", "channel = \"vy\"\nsign = -1");
            },
            &["jumps of the closing velocity go up", "sign"],
        ),
        noted(
            "a displacement that fits the velocity",
            |lab| with_displacement(lab, 1.0),
            &["3 of 3 records can be used"],
        ),
        refused(
            "a displacement against the velocity",
            |lab| with_displacement(lab, -1.0),
            &[
                "displacement_x and velocity_x have opposite signs",
                "sign = -1",
            ],
        ),
        refused(
            "a displacement in the wrong unit",
            |lab| with_displacement(lab, 25.4),
            &["displacement_x moves 25.", "mend unit or scale"],
        ),
        refused(
            "the same record under two names",
            |lab| {
                let text = lab.read("r1.csv");
                lab.write("r3.csv", &text);
                lab.replace("runs.csv", "r3.csv,13", "r3.csv,11");
            },
            &["r3.csv: r3", "its samples are those of the record 'r1'"],
        ),
        noted(
            "a clearance of zero",
            |lab| lab.replace("runs.csv", "r2.csv,12,1.0", "r2.csv,12,0"),
            &["r2: clearance", "a preload, or a slip"],
        ),
        noted(
            "a negative clearance",
            |lab| lab.replace("runs.csv", "r2.csv,12,1.0", "r2.csv,12,-1.0"),
            &["a clearance of -0.001 m: a preload, or a slip"],
        ),
    ]
}

/// A velocity without jumps.
fn smooth(i: usize) -> String {
    format!(
        "{:.6}",
        (std::f64::consts::TAU * 12.0 * i as f64 / RATE_HZ).sin()
    )
}
