//! Faults in campaign.toml itself.

use super::{Case, refused};

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
        refused(
            "a backslash in a pattern of files",
            |lab| lab.edit("run_table = \"runs.csv\"", "files = \"sub\\*.csv\""),
            &["campaign.toml:7", "write / between folders"],
        ),
        refused(
            "a quote is not closed",
            |lab| lab.edit("\"Test rig\"", "\"Test rig"),
            &["campaign.toml:2", "not valid TOML"],
        ),
        refused(
            "a key is there twice",
            |lab| {
                lab.edit(
                    "machine = \"double\"",
                    "machine = \"double\"\nmachine = \"single\"",
                );
            },
            &["campaign.toml:4", "duplicate key"],
        ),
        refused(
            "campaign.toml is not UTF-8",
            |lab| lab.write_bytes("campaign.toml", b"[campaign]\nname = \"\xe9\"\n"),
            &["campaign.toml cannot be read", "UTF-8"],
        ),
        refused(
            "an unknown key",
            |lab| lab.edit("run_table =", "clearence = \"1 mm\"\nrun_table ="),
            &[
                "campaign.toml:7: records.clearence",
                "did you mean 'clearance'",
            ],
        ),
        refused(
            "an unknown section",
            |lab| lab.edit("[report]", "[reprot]"),
            &["unknown field `reprot`", "did you mean 'report'"],
        ),
        refused(
            "an unknown role",
            |lab| lab.edit("[channels.velocity_y]", "[channels.velocity_z]"),
            &["velocity_z", "did you mean 'velocity_"],
        ),
        refused(
            "a number where a text is needed",
            |lab| lab.edit("\"Test rig\"", "3"),
            &[
                "campaign.toml:2: campaign.name",
                "invalid type: integer `3`, expected a string",
            ],
        ),
        refused(
            "a machine that is not known",
            |lab| lab.edit("\"double\"", "\"triple\""),
            &[
                "campaign.toml:3: campaign.machine",
                "unknown variant `triple`",
            ],
        ),
        refused(
            "a paper size that is not known",
            |lab| lab.edit("\"a4\"", "\"a3\""),
            &["unknown variant `a3`", "did you mean 'a4'"],
        ),
        refused(
            "a negative seed",
            |lab| lab.edit("seed = 1", "seed = -1"),
            &["analysis.seed", "-1"],
        ),
    ]
}

fn quantities() -> Vec<Case> {
    vec![
        refused(
            "a clearance without unit",
            |lab| lab.edit("run_table =", "clearance = 1.0\nrun_table ="),
            &[
                "campaign.toml:7: records.clearance",
                "a clearance without unit: 1",
                "\"1 mm\"",
            ],
        ),
        refused(
            "a negative uncertainty of the clearances",
            |lab| {
                lab.edit(
                    "restitution = 0.9",
                    "restitution = 0.9\nclearance_uncertainty = \"-3 um\"",
                );
            },
            &["rig.clearance_uncertainty", "is out of range"],
        ),
        refused(
            "an uncertainty of the clock that no clock has",
            |lab| {
                lab.edit(
                    "restitution = 0.9",
                    "restitution = 0.9\nclock_uncertainty = \"20 %\"",
                );
            },
            &["rig.clock_uncertainty", "write a value from 0 to 0.05"],
        ),
        refused(
            "an effect that is not known",
            |lab| {
                lab.edit(
                    "restitution = 0.9",
                    "restitution = 0.9\neffects = [\"stiction\"]",
                );
            },
            &[
                "rig.effects",
                "no effect is called 'stiction'",
                "friction",
                "remove the line to allow all",
            ],
        ),
        refused(
            "something shared between campaigns that is not known",
            |lab| {
                lab.edit(
                    "restitution = 0.9",
                    "restitution = 0.9\nshared = [\"weather\"]",
                );
            },
            &[
                "rig.shared",
                "campaigns cannot share 'weather'",
                "gains, corners, delays",
            ],
        ),
        refused(
            "a delay that is longer than a period of the drive",
            |lab| lab.edit("sign = 1", "sign = 1\ndelay = \"100 ms\""),
            &[
                "channels.velocity_x.delay",
                "longer than a period of the drive",
            ],
        ),
        refused(
            "a clearance in quotes without unit",
            |lab| lab.edit("run_table =", "clearance = \"1.0\"\nrun_table ="),
            &[
                "a clearance without unit",
                "write number and unit in quotes",
            ],
        ),
        refused(
            "a clearance in Hz",
            |lab| lab.edit("run_table =", "clearance = \"1 Hz\"\nrun_table ="),
            &[
                "'1 Hz' is a frequency, where a length is expected",
                "write a number and a unit of length",
            ],
        ),
        refused(
            "a decimal comma",
            |lab| lab.edit("\"12.6 Hz\"", "\"12,6 Hz\""),
            &[
                "rig.natural_frequency",
                "is written with a comma",
                "write a decimal point",
            ],
        ),
        refused(
            "a unit that is not known",
            |lab| lab.edit("\"12.6 Hz\"", "\"12.6 Hertzes\""),
            &["the unit 'Hertzes' is not known", "rad/s"],
        ),
        refused(
            "a natural frequency below zero",
            |lab| lab.edit("\"12.6 Hz\"", "\"-12.6 Hz\""),
            &["rig.natural_frequency", "write a positive value"],
        ),
        refused(
            "a restitution above 1",
            |lab| lab.edit("restitution = 0.9", "restitution = 1.2"),
            &["rig.restitution", "write a value from 0 to 1"],
        ),
        refused(
            "a negative damping ratio",
            |lab| lab.edit("damping_ratio = 0.07", "damping_ratio = -0.07"),
            &["rig.damping_ratio", "write a value from 0 to 0.999"],
        ),
        refused(
            "a restitution that is not a number",
            |lab| lab.edit("restitution = 0.9", "restitution = nan"),
            &["rig.restitution", "not a number"],
        ),
        refused(
            "no impact motion looked for",
            |lab| lab.edit("longest_period_n = 6", "longest_period_n = 0"),
            &["analysis.longest_period_n", "write a number from 1 to 64"],
        ),
    ]
}

fn channels() -> Vec<Case> {
    vec![
        refused(
            "a channel's unit that is not known",
            |lab| {
                lab.edit(
                    "channel = \"vx\"\nunit = \"V\"",
                    "channel = \"vx\"\nunit = \"Vlt\"",
                );
            },
            &["channels.velocity_x.unit", "the unit 'Vlt' is not known"],
        ),
        refused(
            "a scale that does not say per what",
            |lab| {
                lab.edit(
                    "scale = \"50 mm/s per V\"\nhigh",
                    "scale = \"50 mm/s\"\nhigh",
                );
            },
            &["channels.velocity_x.scale", "\"50 mm/s per V\""],
        ),
        refused(
            "a scale of zero",
            |lab| {
                lab.edit(
                    "scale = \"50 mm/s per V\"\nhigh",
                    "scale = \"0 mm/s per V\"\nhigh",
                );
            },
            &["channels.velocity_x.scale", "a scale must be positive"],
        ),
        refused(
            "a scale from another unit than the channel's",
            |lab| {
                lab.edit(
                    "scale = \"50 mm/s per V\"\nhigh",
                    "scale = \"50 mm/s per N\"\nhigh",
                );
            },
            &[
                "the scale of channel 'vx' does not start from its unit",
                "[channels.velocity_x]",
            ],
        ),
        refused(
            "a velocity channel left in V",
            |lab| lab.edit("scale = \"50 mm/s per V\"\nhigh", "high"),
            &[
                "comes out as a voltage, not as a velocity",
                "correct unit and scale",
            ],
        ),
        refused(
            "a sign of 2",
            |lab| lab.edit("sign = 1", "sign = 2"),
            &[
                "channels.velocity_x.sign",
                "a sign is 1 or -1",
                "put a factor into scale",
            ],
        ),
        refused(
            "a negative high-pass corner",
            |lab| lab.edit("\"0.5 Hz\"", "\"-0.5 Hz\""),
            &[
                "channels.velocity_x.high_pass",
                "write 0 or a positive value",
            ],
        ),
        refused(
            "a low-pass of nine poles",
            |lab| lab.edit("sign = 1", "low_pass = \"200 Hz\"\nlow_pass_order = 9"),
            &[
                "channels.velocity_x.low_pass_order",
                "write a number from 1 to 8",
            ],
        ),
        refused(
            "the order of no low-pass",
            |lab| lab.edit("sign = 1", "low_pass_order = 2"),
            &[
                "channels.velocity_x.low_pass_order",
                "write low_pass = \"200 Hz\"",
            ],
        ),
        refused(
            "a threshold for a velocity",
            |lab| lab.edit("sign = 1", "threshold = \"1 V\""),
            &[
                "a threshold means nothing for velocity_x",
                "[channels.contact]",
            ],
        ),
        refused(
            "a threshold without unit",
            |lab| lab.edit("threshold = \"2.5 V\"", "threshold = 2.5"),
            &[
                "channels.contact.threshold",
                "a level without unit",
                "\"2.5 V\"",
            ],
        ),
        refused(
            "a threshold in another unit than its channel",
            |lab| lab.edit("threshold = \"2.5 V\"", "threshold = \"2.5 N\""),
            &["contact", "as its threshold does"],
        ),
        refused(
            "a role without a channel",
            |lab| lab.edit("channel = \"drive\"\n", ""),
            &[
                "channels.drive.channel",
                "the channel of the file is not given",
            ],
        ),
        refused(
            "one channel for two roles",
            |lab| lab.edit("channel = \"vy\"", "channel = \"vx\""),
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
        refused(
            "a second mass against a stop",
            |lab| lab.edit("\"double\"", "\"single\""),
            &[
                "channels.velocity_y",
                "one mass against a stop has no mass y",
            ],
        ),
        refused(
            "times of impacts of a driven rig",
            |lab| {
                lab.edit(
                    "channel = \"contact\"\n",
                    "channel = \"contact\"\ncontent = \"times\"\n",
                );
            },
            &[
                "channels.contact.content",
                "set flight = \"constant_force\"",
            ],
        ),
    ]
}

fn records() -> Vec<Case> {
    vec![
        refused(
            "files and run_table both given",
            |lab| lab.edit("run_table =", "files = \"*.csv\"\nrun_table ="),
            &["files and run_table are both given", "keep one of them"],
        ),
        refused(
            "neither files nor run_table given",
            |lab| lab.edit("run_table = \"runs.csv\"", ""),
            &[
                "the location of the records is not given",
                "files = \"records/*.h5\"",
            ],
        ),
        refused(
            "a pattern that no file matches",
            |lab| lab.edit("run_table = \"runs.csv\"", "files = \"*.tdms\""),
            &["no file matches '*.tdms'", "relative to campaign.toml"],
        ),
        refused(
            "exclude names no record",
            |lab| lab.edit("seed = 1", "seed = 1\nexclude = [\"r9\"]"),
            &["analysis.exclude", "no record is called 'r9'"],
        ),
        refused(
            "report.points names no record",
            |lab| lab.edit("paper = \"a4\"", "points = [\"r11\"]"),
            &[
                "report.points",
                "no record is called 'r11'",
                "did you mean 'r1'?",
            ],
        ),
        refused(
            "an attribute for a clearance without unit",
            |lab| lab.edit("[rig]", "[records.attributes]\nclearance = \"gap\"\n[rig]"),
            &[
                "an attribute 'gap' for a clearance without unit",
                "\"gap [m]\"",
            ],
        ),
        refused(
            "a time channel that no file has",
            |lab| lab.edit("run_table =", "time = \"clock\"\nrun_table ="),
            &["in all 3 records", "no channel 'clock' for the time axis"],
        ),
        refused(
            "more is skipped than a record holds",
            |lab| lab.edit("seed = 1", "skip = \"2 s\""),
            &[
                "the record lasts 1 s, and 2 s of it are skipped",
                "lower skip in [analysis]",
            ],
        ),
    ]
}
