//! What several campaigns gave, side by side: a row each, as CSV and as JSON.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::identify;
use super::json::write_json;
use super::{Completed, PipelineError};
use impact_fit::parameters::Coordinate;
use impact_fit::{Estimate, ParameterSet, VerdictKind};
use impact_report::kit::csv::Csv;
use labfiles_write::output::write_bytes;

/// Name of the summary as a table.
pub const CSV: &str = "summary.csv";
/// Name of the summary as JSON.
pub const JSON: &str = "summary.json";

/// Versions of the program and of the layouts that it writes, that of the summary among them.
pub(super) fn versions() -> BTreeMap<String, String> {
    let mut versions = identify::versions();
    versions.insert(JSON.to_owned(), "1".to_owned());
    versions
}

/// Several campaigns in their order.
#[derive(Debug, Clone, Serialize)]
pub struct RunSummary {
    /// Versions of the program and of the files' layouts.
    pub versions: BTreeMap<String, String>,
    /// A row for each campaign.
    pub campaigns: Vec<SummaryRow>,
}

/// One campaign.
#[derive(Debug, Clone, Serialize)]
pub struct SummaryRow {
    /// Its campaign.toml, as given.
    pub campaign: String,
    /// The folder of its results in that of the summary.
    pub folder: String,
    /// The exit code of a run of it alone.
    pub exit_code: u8,
    /// What came of it.
    #[serde(flatten)]
    pub outcome: RunOutcome,
}

/// What came of a campaign.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunOutcome {
    /// Its results are in the folder.
    Result(Box<Found>),
    /// It could not be run; what was in its folder is untouched.
    Errors(Vec<Fault>),
}

/// The answer of a campaign.
#[derive(Debug, Clone, Serialize)]
pub struct Found {
    /// The verdict in a word.
    pub verdict: VerdictKind,
    /// Number of records.
    pub records: usize,
    /// Number of those that can be used.
    pub usable_records: usize,
    /// The joint estimate.
    pub joint: ParameterSet,
}

/// Why a campaign could not be run.
#[derive(Debug, Clone, Serialize)]
pub struct Fault {
    /// What happened, with the place.
    pub message: String,
    /// What the user can do.
    pub remedy: String,
}

impl Found {
    /// The answer of a completed run.
    pub fn of(done: &Completed) -> Self {
        let usable = done.observations.iter().filter(|o| !o.excluded());
        Self {
            verdict: done.identification.verdict.kind,
            records: done.observations.len(),
            usable_records: usable.count(),
            joint: done.identification.joint.parameters.clone(),
        }
    }
}

impl RunSummary {
    /// Rows with this program's versions.
    pub fn of(campaigns: Vec<SummaryRow>) -> Self {
        Self {
            versions: versions(),
            campaigns,
        }
    }

    /// Write summary.csv and summary.json into a folder.
    ///
    /// # Errors
    /// Where one cannot be written.
    pub fn write(&self, out: &Path) -> Result<(), PipelineError> {
        write_bytes(&out.join(CSV), self.csv().as_bytes())?;
        write_json(&out.join(JSON), self)
    }

    fn csv(&self) -> String {
        let first = [
            "campaign",
            "folder",
            "exit_code",
            "verdict",
            "records",
            "usable_records",
        ];
        let mut heads: Vec<String> = first.map(String::from).to_vec();
        for parameter in Coordinate::PHYSICAL {
            let name = parameter.name();
            let ends = ["", "_standard_error", "_low", "_high", "_status"];
            heads.extend(ends.map(|end| format!("{name}{end}")));
        }
        heads.push("error".to_owned());
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        let mut csv = Csv::new(&heads);
        for row in &self.campaigns {
            row.write(csv.row());
        }
        csv.finish()
    }
}

impl SummaryRow {
    fn write(&self, csv: &mut Csv) {
        csv.texts(&[&self.campaign, &self.folder])
            .exact(&[Some(f64::from(self.exit_code))]);
        match &self.outcome {
            RunOutcome::Result(found) => {
                csv.texts(&[found.verdict.name()])
                    .exact(&[found.records, found.usable_records].map(|n| Some(n as f64)));
                for parameter in Coordinate::PHYSICAL {
                    write_estimate(found.joint.get(parameter), csv);
                }
            }
            RunOutcome::Errors(faults) => {
                csv.texts(&vec![""; 3 + 5 * Coordinate::PHYSICAL.len()]);
                let messages: Vec<&str> = faults.iter().map(|f| f.message.as_str()).collect();
                csv.texts(&[&messages.join("; ")]);
            }
        }
    }
}

fn write_estimate(estimate: Option<&Estimate>, csv: &mut Csv) {
    let Some(estimate) = estimate else {
        csv.texts(&[""; 5]);
        return;
    };
    csv.exact(&[
        estimate.value,
        estimate.standard_error,
        estimate.interval95.map(|i| i[0]),
        estimate.interval95.map(|i| i[1]),
    ])
    .texts(&[estimate.status.name()]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::Status;

    fn row(folder: &str, exit_code: u8, outcome: RunOutcome) -> SummaryRow {
        SummaryRow {
            campaign: format!("{folder}/campaign.toml"),
            folder: folder.to_owned(),
            exit_code,
            outcome,
        }
    }

    #[test]
    fn the_table_has_a_whole_row_for_each_campaign() {
        let restitution = Estimate {
            value: Some(0.9),
            standard_error: Some(0.01),
            interval95: Some([0.88, 0.92]),
            status: Status::Identified,
            note: None,
        };
        let found = Found {
            verdict: VerdictKind::Weak,
            records: 3,
            usable_records: 2,
            joint: ParameterSet {
                restitution: Some(restitution),
                ..ParameterSet::default()
            },
        };
        let faults = vec![Fault {
            message: "a, \"quoted\" message".to_owned(),
            remedy: "a remedy".to_owned(),
        }];
        let summary = RunSummary::of(vec![
            row("day1", 0, RunOutcome::Result(Box::new(found))),
            row("day2", 2, RunOutcome::Errors(faults)),
        ]);
        let folder = tempfile::tempdir().unwrap();
        summary.write(folder.path()).unwrap();
        let mut table = csv::Reader::from_path(folder.path().join(CSV)).unwrap();
        let heads = table.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        let cell = |i: usize, name: &str| {
            let at = heads.iter().position(|h| h == name).unwrap();
            rows[i][at].to_owned()
        };
        assert_eq!(cell(0, "verdict"), "weak");
        assert_eq!(cell(0, "restitution_low"), "0.88");
        assert_eq!(cell(0, "restitution_status"), "identified");
        assert_eq!(cell(0, "damping_ratio"), "");
        assert_eq!(cell(1, "exit_code"), "2");
        assert_eq!(cell(1, "error"), "a, \"quoted\" message");
        let json = std::fs::read_to_string(folder.path().join(JSON)).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(
            json["campaigns"][0]["result"]["joint"]["restitution"]["value"],
            0.9
        );
        assert_eq!(json["campaigns"][1]["errors"][0]["remedy"], "a remedy");
        assert_eq!(json["versions"][JSON], "1");
    }
}
