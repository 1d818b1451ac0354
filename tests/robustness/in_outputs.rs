//! Wrong commands and outputs that cannot be written.

use super::Case;
use crate::support::Lab;

/// The cases.
pub(super) fn cases() -> Vec<Case> {
    let mut all = commands();
    all.extend(folders());
    all
}

fn case(
    input: &'static str,
    spoil: impl Fn(&Lab) + 'static,
    run: &'static [&'static str],
    says: &'static [&'static str],
) -> Case {
    Case {
        input,
        spoil: Box::new(spoil),
        run,
        says,
        code: 2,
    }
}

fn commands() -> Vec<Case> {
    vec![
        case("no command", |_| {}, &[], &["Usage: impactid"]),
        case(
            "an unknown command",
            |_| {},
            &["rum"],
            &["unrecognized subcommand 'rum'", "run"],
        ),
        case(
            "a command with two letters exchanged",
            |_| {},
            &["rnu"],
            &[
                "unrecognized subcommand 'rnu'",
                "a similar subcommand exists: 'run'",
            ],
        ),
        case(
            "a command below another, misspelt",
            |_| {},
            &["study", "coverag"],
            &["a similar subcommand exists: 'coverage'"],
        ),
        case(
            "no thread",
            |_| {},
            &["-j", "0", "check"],
            &[
                "invalid value '0' for '--threads <N>'",
                "write a whole number, 1 or more",
            ],
        ),
        case(
            "a map of no column",
            |_| {},
            &["atlas", "--columns", "0", "--out", "atlas"],
            &[
                "invalid value '0' for '--columns <N>'",
                "write a whole number, 2 or more",
            ],
        ),
        case(
            "an unknown flag",
            |_| {},
            &["run", "--outt"],
            &["unexpected argument '--outt'", "--out"],
        ),
        case(
            "run without --out",
            |_| {},
            &["run", "campaign.toml"],
            &["--out"],
        ),
        case(
            "run on a pattern that no campaign matches",
            |_| {},
            &["run", "*/campaign.toml", "--out", "out"],
            &[
                "no file matches '*/campaign.toml'",
                "name the campaign.toml",
            ],
        ),
        case(
            "a folder of results in place of a campaign",
            |lab| {
                std::fs::create_dir(lab.path("results")).expect("a folder");
                lab.write("results/campaign.resolved.json", "{}");
            },
            &["plan", "results", "--out", "out"],
            &[
                "results: it is a folder of results",
                "name the campaign.toml that they were computed from",
            ],
        ),
        case(
            "run on several campaigns, one of which is not there",
            |_| {},
            &[
                "run",
                "campaign.toml",
                "nowhere/campaign.toml",
                "--out",
                "out",
            ],
            &[
                "nowhere/campaign.toml",
                "campaign.toml cannot be read",
                "impactid init",
            ],
        ),
        case(
            "run on a campaign, a record and a folder",
            |_| {},
            &["run", "campaign.toml", "r1.csv", ".", "--out", "out"],
            &["it is a folder", "r1.csv", "it is a record (csv)"],
        ),
        case(
            "convert on a pattern that no file matches",
            |_| {},
            &["convert", "day?/*.tdms", "--out", "all.h5"],
            &["no file matches 'day?/*.tdms'", "name record files"],
        ),
        case(
            "convert onto a file that is there",
            |_| {},
            &["convert", "r1.csv", "--out", "r2.csv"],
            &["r2.csv exists already", "--force"],
        ),
        case(
            "convert onto its input, with --force",
            |_| {},
            &["convert", "r1.csv", "--out", "r1.csv", "--force"],
            &["r1.csv is read and would be written over", "name another"],
        ),
        case(
            "a format behind a blank",
            |_| {},
            &[
                "run",
                "campaign.toml",
                "--out",
                "out",
                "--format",
                "pdf",
                "html",
            ],
            &[
                "html is no campaign but a format; nothing was run",
                "--format pdf,html",
            ],
        ),
        case(
            "a sweep of one point",
            |_| {},
            &["sweep", "--eta", "1", "--rho", "2", "--out", "out"],
            &["η = 1 and ρ = 2 are one point", "--eta 0.8..1.4"],
        ),
        case(
            "an atlas without columns",
            |_| {},
            &["atlas", "--columns", "0", "--out", "out"],
            &["invalid value '0' for '--columns <N>'"],
        ),
        case(
            "a plan of no setting",
            |_| {},
            &["plan", "campaign.toml", "--settings", "0", "--out", "out"],
            &["invalid value '0' for '--settings <N>'"],
        ),
        case(
            "inspect a document",
            |lab| lab.write("report.pdf", "%PDF-1.7\n1,2\n3,4\n"),
            &["inspect", "report.pdf"],
            &["a PDF document", "export them as CSV"],
        ),
        case(
            "inspect a dataset that is not there",
            |_| {},
            &["inspect", "r1.csv", "--dataset", "foo"],
            &["the file holds a single dataset without one"],
        ),
        case(
            "run on a faulty campaign",
            |lab| lab.edit("\"double\"", "\"triple\""),
            &["run", "campaign.toml", "--out", "out"],
            &["unknown variant `triple`"],
        ),
        case(
            "quiet and verbose at once",
            |_| {},
            &["--quiet", "-v", "check"],
            &["cannot be used with"],
        ),
        case(
            "a simulated restitution above 1",
            |_| {},
            &[
                "simulate",
                "campaign",
                "--restitution",
                "1.5",
                "--out",
                "synthetic",
            ],
            &["it must lie between 0 and 1"],
        ),
        case(
            "a simulated rig with an effect that is not known",
            |_| {},
            &[
                "simulate",
                "campaign",
                "--rig",
                "wobble",
                "--out",
                "synthetic",
            ],
            &[
                "no effect is called \"wobble\"",
                "second-harmonic, third-harmonic",
            ],
        ),
        case(
            "a simulated frequency that is no number",
            |_| {},
            &[
                "simulate",
                "campaign",
                "--natural-frequency-hz",
                "low",
                "--out",
                "synthetic",
            ],
            &["it is not a number"],
        ),
    ]
}

fn folders() -> Vec<Case> {
    vec![
        case(
            "a file where the output folder should be",
            |lab| lab.write("out", "mine"),
            &["run", "campaign.toml", "--out", "out"],
            &[
                "the folder out cannot be written into",
                "name another folder with --out",
            ],
        ),
        case(
            "several campaigns into a folder with a summary of another version",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/summary.json", r#"{"versions": {"summary.json": "0"}}"#);
                lab.write("other.toml", &lab.read("campaign.toml"));
            },
            &["run", "campaign.toml", "other.toml", "--out", "out"],
            &["summary.json has layout 0", "into another folder (--out)"],
        ),
        case(
            "a sweep into the folder of an atlas",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/study.toml", "title = \"Regions\"\n[regions.atlas]\n");
            },
            &["sweep", "--eta", "1..1.1", "--rho", "2", "--out", "out"],
            &[
                "out holds results of other work",
                "name another folder with --out",
            ],
        ),
        case(
            "a campaign into the folder of a study",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/study.toml", "title = \"Regions\"\n[regions.atlas]\n");
            },
            &["run", "campaign.toml", "--out", "out"],
            &[
                "out holds results of other work",
                "name another folder with --out",
            ],
        ),
        case(
            "a comparison into results of a campaign",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/identification.json", "{}");
                lab.write("other.toml", &lab.read("campaign.toml"));
            },
            &["compare", "campaign.toml", "other.toml", "--out", "out"],
            &[
                "out holds results of other work",
                "name another folder with --out",
            ],
        ),
        case(
            "watch into results of another version",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/identification.json", r#"{"versions": {}}"#);
            },
            &["watch", "campaign.toml", "--out", "out"],
            &[
                "identification.json has layout none",
                "into another folder (--out)",
            ],
        ),
        case(
            "watch a campaign that is not there",
            |_| {},
            &["watch", "nowhere/campaign.toml", "--out", "out"],
            &["campaign.toml cannot be read", "impactid init"],
        ),
        case(
            "a folder in place of campaign.toml",
            |_| {},
            &["check", "."],
            &[
                "it is a folder",
                "name the campaign.toml in it",
                "impactid init",
            ],
        ),
        case(
            "explore --watch on a folder",
            |_| {},
            &["explore", "--watch", "."],
            &["is not a campaign.toml", "impactid init"],
        ),
        case(
            "watch without a pause between two looks",
            |_| {},
            &["watch", "campaign.toml", "--out", "out", "--poll", "0"],
            &["it must lie between 0.05 and 86400 seconds"],
        ),
        case(
            "a stage on a folder that is not there",
            |_| {},
            &["classify", "nowhere"],
            &["nowhere is not a folder with results", "impactid ingest"],
        ),
        case(
            "a stage on results of run",
            |lab| {
                std::fs::create_dir(lab.path("out")).expect("a folder");
                lab.write("out/identification.json", "{}");
            },
            &["classify", "out"],
            &[
                "out: there are no calibrated records: `impactid run` does not keep them",
                "ingest, classify, identify, report",
            ],
        ),
        case(
            "a comparison with a folder that is not there",
            |_| {},
            &["compare", "before", "after", "--out", "out"],
            &[
                "before: there is no such file or folder",
                "results folders of `impactid run`",
            ],
        ),
        case(
            "a comparison with a folder of records",
            |lab| {
                std::fs::create_dir(lab.path("records")).expect("a folder");
                lab.write("records/campaign.toml", "[campaign]\n");
            },
            &["compare", "records", "campaign.toml", "--out", "out"],
            &[
                "records/identification.json",
                "this folder holds records, not results: give records/campaign.toml",
            ],
        ),
        case(
            "a comparison with results of another version",
            |lab| {
                std::fs::create_dir(lab.path("old")).expect("a folder");
                let versions = r#"{"versions": {"impactid": "0.1.0", "identification.json": "1"}}"#;
                lab.write("old/identification.json", versions);
            },
            &["compare", "old", "campaign.toml", "--out", "out"],
            &[
                "old/identification.json has layout 1; this program reads and writes layout 6",
                "run the campaign with this version of impactid into another folder",
            ],
        ),
        case(
            "a comparison of a campaign with itself",
            |lab| {
                let versions = r#"{"versions": {"identification.json": "1"}}"#;
                lab.write("identification.json", versions);
            },
            &[
                "compare",
                "campaign.toml",
                "./campaign.toml",
                "--out",
                "out",
            ],
            &[
                "./campaign.toml is given twice",
                "give each measurement once",
            ],
        ),
        case(
            "init in a folder without records",
            |lab| std::fs::create_dir(lab.path("empty")).expect("a folder"),
            &["init", "empty"],
            &["no record found in empty"],
        ),
        case(
            "init in no folder",
            |_| {},
            &["init", "nowhere"],
            &["nowhere is not a folder"],
        ),
        case(
            "init where campaign.toml is",
            |_| {},
            &["init", "."],
            &["campaign.toml exists already", "--force"],
        ),
        case(
            "simulate where a campaign is",
            |_| {},
            &["simulate", "campaign", "--out", "."],
            &["holds a campaign already", "--force"],
        ),
    ]
}
