//! Faults in campaign.toml itself.

use super::{Case, edited, refused};

/// The cases.
pub(super) fn cases() -> Vec<Case> {
    let mut all = form();
    all.extend(quantities());
    all.extend(channels());
    all.extend(records());
    all
}

fn form() -> Vec<Case> {
    vec![
        refused(
            "campaign.toml is not there",
            |lab| lab.remove("campaign.toml"),
            &["campaign.toml cannot be read", "impactid init"],
        ),
        refused(
            "campaign.toml is empty",
            |lab| lab.write("campaign.toml", ""),
            &[
                "the location of the records is not given",
                "no channel of motion",
                "campaign.machine",
            ],
        ),
        refused(
            "campaign.toml in Windows-1252",
            |lab| lab.write_bytes("campaign.toml", b"[campaign]\nname = \"Pr\xFCfstand\"\n"),
            &["the text is not in UTF-8", "save it as UTF-8"],
        ),
        refused(
            "a record in place of campaign.toml",
            |lab| lab.write("campaign.toml", &lab.read("r1.csv")),
            &[
                "it is a record (csv), not the description of a campaign",
                "impactid init",
            ],
        ),
        edited(
            "a backslash in a pattern of files",
            "run_table = \"runs.csv\"",
            "files = \"sub\\*.csv\"",
            &["campaign.toml:7", "write / between folders"],
        ),
        edited(
            "a quote is not closed",
            "\"Test rig\"",
            "\"Test rig",
            &["campaign.toml:2", "not valid TOML"],
        ),
        edited(
            "a key is there twice",
            "machine = \"double\"",
            "machine = \"double\"\nmachine = \"single\"",
            &["campaign.toml:4", "duplicate key"],
        ),
        refused(
            "campaign.toml is not UTF-8",
            |lab| lab.write_bytes("campaign.toml", b"[campaign]\nname = \"\xe9\"\n"),
            &["campaign.toml cannot be read", "UTF-8"],
        ),
        edited(
            "an unknown key",
            "run_table =",
            "clearence = \"1 mm\"\nrun_table =",
            &[
                "campaign.toml:7: records.clearence",
                "did you mean 'clearance'",
            ],
        ),
        edited(
            "an unknown section",
            "[report]",
            "[reprot]",
            &["unknown field `reprot`", "did you mean 'report'"],
        ),
        edited(
            "an unknown role",
            "[channels.velocity_y]",
            "[channels.velocity_z]",
            &["velocity_z", "did you mean 'velocity_"],
        ),
        edited(
            "a number where a text is needed",
            "\"Test rig\"",
            "3",
            &[
                "campaign.toml:2: campaign.name",
                "invalid type: integer `3`, expected a string",
            ],
        ),
        edited(
            "a machine that is not known",
            "\"double\"",
            "\"triple\"",
            &[
                "campaign.toml:3: campaign.machine",
                "unknown variant `triple`",
            ],
        ),
        edited(
            "a paper size that is not known",
            "\"a4\"",
            "\"a3\"",
            &["unknown variant `a3`", "did you mean 'a4'"],
        ),
        edited(
            "a negative seed",
            "seed = 1",
            "seed = -1",
            &["analysis.seed", "-1"],
        ),
    ]
}

fn quantities() -> Vec<Case> {
    vec![
        edited(
            "a clearance without unit",
            "run_table =",
            "clearance = 1.0\nrun_table =",
            &[
                "campaign.toml:7: records.clearance",
                "a clearance without unit: 1",
                "\"1 mm\"",
            ],
        ),
        edited(
            "a negative uncertainty of the clearances",
            "restitution = 0.9",
            "restitution = 0.9\nclearance_uncertainty = \"-3 um\"",
            &["rig.clearance_uncertainty", "is out of range"],
        ),
        edited(
            "an uncertainty of the clock that no clock has",
            "restitution = 0.9",
            "restitution = 0.9\nclock_uncertainty = \"20 %\"",
            &["rig.clock_uncertainty", "write a value from 0 to 0.05"],
        ),
        edited(
            "an effect that is not known",
            "restitution = 0.9",
            "restitution = 0.9\neffects = [\"stiction\"]",
            &[
                "rig.effects",
                "no effect is called 'stiction'",
                "friction",
                "remove the line to allow all",
            ],
        ),
        edited(
            "something shared between campaigns that is not known",
            "restitution = 0.9",
            "restitution = 0.9\nshared = [\"weather\"]",
            &[
                "rig.shared",
                "campaigns cannot share 'weather'",
                "gains, corners, delays",
            ],
        ),
        edited(
            "a delay that is longer than a period of the drive",
            "sign = 1",
            "sign = 1\ndelay = \"100 ms\"",
            &[
                "channels.velocity_x.delay",
                "longer than a period of the drive",
            ],
        ),
        edited(
            "a clearance in quotes without unit",
            "run_table =",
            "clearance = \"1.0\"\nrun_table =",
            &[
                "a clearance without unit",
                "write number and unit in quotes",
            ],
        ),
        edited(
            "a clearance in Hz",
            "run_table =",
            "clearance = \"1 Hz\"\nrun_table =",
            &[
                "'1 Hz' is a frequency, where a length is expected",
                "write a number and a unit of length",
            ],
        ),
        edited(
            "a decimal comma",
            "\"12.6 Hz\"",
            "\"12,6 Hz\"",
            &[
                "rig.natural_frequency",
                "is written with a comma",
                "write a decimal point",
            ],
        ),
        edited(
            "a unit that is not known",
            "\"12.6 Hz\"",
            "\"12.6 Hertzes\"",
            &["the unit 'Hertzes' is not known", "rad/s"],
        ),
        edited(
            "a natural frequency below zero",
            "\"12.6 Hz\"",
            "\"-12.6 Hz\"",
            &["rig.natural_frequency", "write a positive value"],
        ),
        edited(
            "a restitution above 1",
            "restitution = 0.9",
            "restitution = 1.2",
            &["rig.restitution", "write a value from 0 to 1"],
        ),
        edited(
            "a negative damping ratio",
            "damping_ratio = 0.07",
            "damping_ratio = -0.07",
            &["rig.damping_ratio", "write a value from 0 to 0.999"],
        ),
        edited(
            "a restitution that is not a number",
            "restitution = 0.9",
            "restitution = nan",
            &["rig.restitution", "not a number"],
        ),
        edited(
            "no impact motion looked for",
            "longest_period_n = 6",
            "longest_period_n = 0",
            &["analysis.longest_period_n", "write a number from 1 to 64"],
        ),
    ]
}

fn channels() -> Vec<Case> {
    vec![
        edited(
            "a channel's unit that is not known",
            "channel = \"vx\"\nunit = \"V\"",
            "channel = \"vx\"\nunit = \"Vlt\"",
            &["channels.velocity_x.unit", "the unit 'Vlt' is not known"],
        ),
        edited(
            "a scale that does not say per what",
            "scale = \"50 mm/s per V\"\nhigh",
            "scale = \"50 mm/s\"\nhigh",
            &["channels.velocity_x.scale", "\"50 mm/s per V\""],
        ),
        edited(
            "a scale of zero",
            "scale = \"50 mm/s per V\"\nhigh",
            "scale = \"0 mm/s per V\"\nhigh",
            &["channels.velocity_x.scale", "a scale must be positive"],
        ),
        edited(
            "a scale from another unit than the channel's",
            "scale = \"50 mm/s per V\"\nhigh",
            "scale = \"50 mm/s per N\"\nhigh",
            &[
                "the scale of channel 'vx' does not start from its unit",
                "[channels.velocity_x]",
            ],
        ),
        edited(
            "a velocity channel left in V",
            "scale = \"50 mm/s per V\"\nhigh",
            "high",
            &[
                "comes out as a voltage, not as a velocity",
                "correct unit and scale",
            ],
        ),
        edited(
            "a sign of 2",
            "sign = 1",
            "sign = 2",
            &[
                "channels.velocity_x.sign",
                "a sign is 1 or -1",
                "put a factor into scale",
            ],
        ),
        edited(
            "a negative high-pass corner",
            "\"0.5 Hz\"",
            "\"-0.5 Hz\"",
            &[
                "channels.velocity_x.high_pass",
                "write 0 or a positive value",
            ],
        ),
        edited(
            "a low-pass of nine poles",
            "sign = 1",
            "low_pass = \"200 Hz\"\nlow_pass_order = 9",
            &[
                "channels.velocity_x.low_pass_order",
                "write a number from 1 to 8",
            ],
        ),
        edited(
            "the order of no low-pass",
            "sign = 1",
            "low_pass_order = 2",
            &[
                "channels.velocity_x.low_pass_order",
                "write low_pass = \"200 Hz\"",
            ],
        ),
        edited(
            "a threshold for a velocity",
            "sign = 1",
            "threshold = \"1 V\"",
            &[
                "a threshold means nothing for velocity_x",
                "[channels.contact]",
            ],
        ),
        edited(
            "a threshold without unit",
            "threshold = \"2.5 V\"",
            "threshold = 2.5",
            &[
                "channels.contact.threshold",
                "a level without unit",
                "\"2.5 V\"",
            ],
        ),
        edited(
            "a threshold in another unit than its channel",
            "threshold = \"2.5 V\"",
            "threshold = \"2.5 N\"",
            &["contact", "as its threshold does"],
        ),
        edited(
            "a role without a channel",
            "channel = \"drive\"\n",
            "",
            &[
                "channels.drive.channel",
                "the channel of the file is not given",
            ],
        ),
        edited(
            "one channel for two roles",
            "channel = \"vy\"",
            "channel = \"vx\"",
            &[
                "channels.velocity_y.channel",
                "already serves as velocity_x",
            ],
        ),
        refused(
            "no channel of motion",
            |lab| {
                let text = lab.read("campaign.toml");
                let (head, rest) = text
                    .split_once("[channels.velocity_x]")
                    .expect("it is there");
                let (_, tail) = rest.split_once("[analysis]").expect("it is there");
                lab.write("campaign.toml", &format!("{head}[analysis]{tail}"));
            },
            &["no channel of motion is named", "[channels.velocity_x]"],
        ),
        edited(
            "a second mass against a stop",
            "\"double\"",
            "\"single\"",
            &[
                "channels.velocity_y",
                "one mass against a stop has no mass y",
            ],
        ),
        edited(
            "times of impacts of a driven rig",
            "channel = \"contact\"\n",
            "channel = \"contact\"\ncontent = \"times\"\n",
            &[
                "channels.contact.content",
                "set flight = \"constant_force\"",
            ],
        ),
    ]
}

fn records() -> Vec<Case> {
    vec![
        edited(
            "files and run_table both given",
            "run_table =",
            "files = \"*.csv\"\nrun_table =",
            &["files and run_table are both given", "keep one of them"],
        ),
        edited(
            "neither files nor run_table given",
            "run_table = \"runs.csv\"",
            "",
            &[
                "the location of the records is not given",
                "files = \"records/*.h5\"",
            ],
        ),
        edited(
            "a pattern that no file matches",
            "run_table = \"runs.csv\"",
            "files = \"*.tdms\"",
            &["no file matches '*.tdms'", "relative to campaign.toml"],
        ),
        edited(
            "exclude names no record",
            "seed = 1",
            "seed = 1\nexclude = [\"r9\"]",
            &["analysis.exclude", "no record is called 'r9'"],
        ),
        edited(
            "report.points names no record",
            "paper = \"a4\"",
            "points = [\"r11\"]",
            &[
                "report.points",
                "no record is called 'r11'",
                "did you mean 'r1'?",
            ],
        ),
        edited(
            "an attribute for a clearance without unit",
            "[rig]",
            "[records.attributes]\nclearance = \"gap\"\n[rig]",
            &[
                "an attribute 'gap' for a clearance without unit",
                "\"gap [m]\"",
            ],
        ),
        edited(
            "a time channel that no file has",
            "run_table =",
            "time = \"clock\"\nrun_table =",
            &["in all 3 records", "no channel 'clock' for the time axis"],
        ),
        edited(
            "more is skipped than a record holds",
            "seed = 1",
            "skip = \"2 s\"",
            &[
                "the record lasts 1 s, and 2 s of it are skipped",
                "lower skip in [analysis]",
            ],
        ),
    ]
}
