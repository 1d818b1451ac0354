//! Inputs that are well formed and cannot be.

use super::{Case, noted, refused};
use crate::support::{Lab, RATE_HZ};

/// Add the displacements of both masses, whose motions differ, to every record; campaign.toml
/// names them the wrong way round where asked for.
fn with_both_displacements(lab: &Lab, swapped: bool) {
    for (name, frequency_hz) in [("r1.csv", 11.0), ("r2.csv", 12.0), ("r3.csv", 13.0)] {
        let (mut sums, mut lines) = ([0.0, 0.0], Vec::new());
        for (i, line) in lab.read(name).lines().enumerate() {
            if i == 0 {
                lines.push(format!("{line},dx [mm],dy [mm]"));
                continue;
            }
            let phase = 3.0 * std::f64::consts::TAU * frequency_hz * i as f64 / RATE_HZ;
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            let number = |cell: &String| cell.parse::<f64>().expect("a number");
            let speeds = [number(&cells[3]), number(&cells[4]) + 1.5 * phase.sin()];
            cells[4] = format!("{:.6}", speeds[1]);
            for (sum, v) in sums.iter_mut().zip(speeds) {
                *sum += 50.0 * v / RATE_HZ;
                cells.push(format!("{sum:.6}"));
            }
            lines.push(cells.join(","));
        }
        lab.write(name, &(lines.join("\n") + "\n"));
    }
    let [x, y] = if swapped { ["dy", "dx"] } else { ["dx", "dy"] };
    let channels = format!(
        "[channels.displacement_x]\nchannel = \"{x}\"\n\n\
         [channels.displacement_y]\nchannel = \"{y}\"\n\n[analysis]"
    );
    lab.edit("[analysis]", &channels);
}

/// Add the acceleration of x to every record: smooth, in m/s² times a factor; the velocity of x
/// becomes its integral.
fn with_acceleration(lab: &Lab, factor: f64) {
    for (name, frequency_hz) in [("r1.csv", 11.0), ("r2.csv", 12.0), ("r3.csv", 13.0)] {
        let rate = std::f64::consts::TAU * frequency_hz;
        lab.lines(name, |i, line| {
            if i == 0 {
                return Some(format!("{line},ax [m/s^2]"));
            }
            let (sin, cos) = (rate * i as f64 / RATE_HZ).sin_cos();
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[3] = format!("{:.6}", 2.0 * sin);
            cells.push(format!("{:.6}", factor * 0.1 * rate * cos));
            Some(cells.join(","))
        });
    }
    lab.edit(
        "[analysis]",
        "[channels.acceleration_x]\nchannel = \"ax\"\n\n[analysis]",
    );
}

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
    lab.edit(
        "[analysis]",
        "[channels.displacement_x]\nchannel = \"dx\"\n\n[analysis]",
    );
}

/// The cases.
pub(super) fn cases() -> Vec<Case> {
    vec![
        noted(
            "a drive frequency that is not the stated one",
            |lab| lab.replace("runs.csv", "r2.csv,12", "r2.csv,14"),
            &[
                "r2.csv: drive",
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
                "r2.csv: drive",
                "no single harmonic tone",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "a contact that closes without a jump of the velocity",
            |lab| {
                lab.column("r2.csv", 3, |i, _| smooth(i));
                lab.column("r2.csv", 4, |i, _| smooth(i + 3));
            },
            &["r2.csv: contact", "show no jump of velocity"],
        ),
        refused(
            "velocities counted away from the other mass",
            |lab| {
                lab.edit("sign = 1", "sign = -1");
                lab.edit("channel = \"vy\"", "channel = \"vy\"\nsign = -1");
            },
            &["jumps of the approach velocity go up", "sign"],
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
            &["displacement_x moves 25.", "correct unit or scale"],
        ),
        refused(
            "a displacement in m that was meant in mm",
            |lab| with_displacement(lab, 1000.0),
            &["displacement_x moves 99", "the factor between m and mm"],
        ),
        refused(
            "a displacement's peak that is an RMS",
            |lab| with_displacement(lab, std::f64::consts::FRAC_1_SQRT_2),
            &[
                "displacement_x moves 0.70",
                "the factor between RMS and peak",
            ],
        ),
        refused(
            "an acceleration in g that is taken for m/s²",
            |lab| with_acceleration(lab, 1.0 / 9.80665),
            &[
                "velocity_x changes 9.8",
                "the factor between g and m/s²",
                "[channels.acceleration_x]",
            ],
        ),
        noted(
            "a drive frequency stated in rad/s that is taken for Hz",
            |lab| lab.replace("runs.csv", "r2.csv,12", "r2.csv,75.398"),
            &["r2.csv: drive", "the factor between Hz and rad/s"],
        ),
        noted(
            "displacements of both masses as they belong",
            |lab| with_both_displacements(lab, false),
            &["3 of 3 records can be used"],
        ),
        refused(
            "masses x and y swapped in the displacements",
            |lab| with_both_displacements(lab, true),
            &[
                "the displacement of x follows the velocity of y",
                "swap [channels.velocity_x] and [channels.velocity_y]",
            ],
        ),
        noted(
            "the velocity of one mass counted away from the other",
            |lab| lab.edit("channel = \"vy\"", "channel = \"vy\"\nsign = -1"),
            &[
                "velocity_x and velocity_y jump in opposite directions",
                "turn the sign in [channels.velocity_x] or in [channels.velocity_y]",
            ],
        ),
        refused(
            "the same record under two names",
            |lab| {
                let text = lab.read("r1.csv");
                lab.write("r3.csv", &text);
                lab.replace("runs.csv", "r3.csv,13", "r3.csv,11");
            },
            &[
                "r3.csv: its samples",
                "its samples are those of the record 'r1'",
            ],
        ),
        noted(
            "a clearance of zero",
            |lab| lab.replace("runs.csv", "r2.csv,12,1.0", "r2.csv,12,0"),
            &["r2.csv: clearance", "a preload, or a typing error"],
        ),
        noted(
            "a negative clearance",
            |lab| lab.replace("runs.csv", "r2.csv,12,1.0", "r2.csv,12,-1.0"),
            &["a clearance of -0.001 m: a preload, or a typing error"],
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
