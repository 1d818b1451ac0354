//! From campaign.toml as written to the campaign as resolved, or every fault at once.

use std::path::Path;

use super::context::ResolveContext;
use super::diagnostic::{Diagnostics, FaultCollector};
use super::discovery::{Opener, Shared, Taken};
use super::lines::Text;
use super::read;
use super::records;
use super::resolved::{RecordEntry, ResolvedCampaign};
use super::sections::{about, analysis, channels, report, rig};
use super::sources::Sources;
use super::values::{Placed, value};
use super::written::WrittenCampaign;

/// A campaign as far as it could be resolved, and everything that is wrong with it.
#[derive(Debug)]
pub struct LoadOutcome {
    /// The campaign; `None` if a problem stops it.
    pub campaign: Option<ResolvedCampaign>,
    /// All problems, the gravest first.
    pub diagnostics: Diagnostics,
}

/// Read campaign.toml and list its records, opening files by `open`.
pub fn load(path: &Path, open: Opener<'_>) -> LoadOutcome {
    load_listed(path, open, None)
}

/// As [`load`], while records are still arriving: only the files that are taken are listed, none at
/// all is no fault, and records that campaign.toml names may not be there yet.
pub fn load_taken(path: &Path, open: Opener<'_>, taken: Taken<'_>) -> LoadOutcome {
    load_listed(path, open, Some(taken))
}

fn load_listed(path: &Path, open: Opener<'_>, taken: Option<Taken<'_>>) -> LoadOutcome {
    let mut faults = FaultCollector::new(path);
    let text = read::text(path, &mut faults);
    let text = text.as_deref();
    let written = text.and_then(|text| read::read(text, &mut faults));
    let mut context = ResolveContext {
        text: Text::new(text.unwrap_or_default()),
        faults,
    };
    let campaign = written.map(|written| resolve(path, &written, open, taken, &mut context));
    let blocks = context.faults.blocks();
    let mut diagnostics = context.faults.into_diagnostics();
    diagnostics.sort();
    LoadOutcome {
        campaign: campaign.filter(|_| !blocks),
        diagnostics,
    }
}

fn resolve(
    path: &Path,
    written: &WrittenCampaign,
    open: Opener<'_>,
    taken: Option<Taken<'_>>,
    context: &mut ResolveContext<'_>,
) -> ResolvedCampaign {
    let folder = path.parent().unwrap_or(Path::new(""));
    let about = about::resolve(&written.campaign, folder, context);
    let channels = match written.published {
        Some(_) => Vec::new(),
        None => channels::resolve(&written.channels, (about.machine, about.flight), context),
    };
    let time = value(&written.records.time).map(|t| t.0);
    let sources = Sources::default();
    let shared = Shared {
        folder,
        channels: &channels,
        time: time.as_ref(),
        taken,
        sources: &sources,
    };
    let mut records = match written.published {
        Some(_) => Vec::new(),
        None => records::resolve(&written.records, shared, open, context),
    };
    let all = taken.is_none();
    exclude(&mut records, &written.analysis.exclude, all, context);
    channels::refuse_long_delays(&channels, &records, &written.channels, context);
    let run_table = value(&written.records.run_table).map(|t| folder.join(t));
    let names: Vec<&str> = records.iter().map(|r| r.id.as_str()).collect();
    let name = about.name.clone();
    let around = report::Around {
        name: &name,
        folder,
        records: &names,
        all,
    };
    ResolvedCampaign {
        about,
        run_table,
        rig: rig::resolve(&written.rig, context),
        times: written.records.times(context),
        analysis: analysis::resolve(&written.analysis, context),
        report: report::resolve(&written.report, &around, context),
        file: path.to_path_buf(),
        channels,
        records,
        published: written.published.clone(),
        sources,
    }
}

fn exclude(
    records: &mut [RecordEntry],
    placed: &Placed<Vec<String>>,
    all: bool,
    context: &mut ResolveContext<'_>,
) {
    let Some(placed) = placed else { return };
    let options = glob::MatchOptions::default();
    for name in placed.get_ref() {
        let pattern = glob::Pattern::new(name).ok();
        let fits = |id: &str| {
            id == name
                || pattern
                    .as_ref()
                    .is_some_and(|p| p.matches_with(id, options))
        };
        let mut found = false;
        for record in records.iter_mut().filter(|r| fits(&r.id)) {
            record.excluded = true;
            found = true;
        }
        if all && !found && !records.is_empty() {
            let names: Vec<&str> = records.iter().map(|r| r.id.as_str()).collect();
            context.unknown_record(placed, "analysis.exclude", name, &names);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::diagnostic::Code;

    #[test]
    fn broken_syntax_is_reported_alone() {
        let folder = tempfile::tempdir().unwrap();
        let toml = folder.path().join("campaign.toml");
        std::fs::write(&toml, "[campaign]\nname = \"x\nmachine = \"double\"\n").unwrap();
        let outcome = load(&toml, &labfiles::open);
        assert!(outcome.campaign.is_none());
        let faults = &outcome.diagnostics.0;
        assert!(!faults.is_empty());
        assert!(faults.iter().all(|f| f.code == Code::Syntax), "{faults:?}");
    }

    #[test]
    fn a_channel_may_state_that_it_has_no_high_pass() {
        let folder = tempfile::tempdir().unwrap();
        let toml = folder.path().join("campaign.toml");
        for (corner, refused) in [("0 Hz", false), ("0.5 Hz", false), ("-0.5 Hz", true)] {
            let text = format!(
                "[campaign]\nmachine = \"double\"\n[records]\nfiles = \"*.csv\"\n\
                 [channels.velocity_x]\nchannel = \"v\"\nhigh_pass = \"{corner}\"\n"
            );
            std::fs::write(&toml, text).unwrap();
            let found = format!("{:?}", load(&toml, &labfiles::open).diagnostics.0);
            assert_eq!(found.contains("high_pass"), refused, "{found}");
        }
    }
}
