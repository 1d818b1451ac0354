//! From campaign.toml as written to the campaign as resolved, or every fault at once.

use std::path::{Path, PathBuf};

use toml::Spanned;

use super::channels;
use super::context::ResolveContext;
use super::diagnostic::{Code, Diagnostics, FaultCollector};
use super::discovery::{Opener, Shared, Taken};
use super::read::{self, Text};
use super::records;
use super::resolved::{Analysis, RecordEntry, Report, ResolvedCampaign};
use super::rig;
use super::sources::Sources;
use super::written::{self, Flight, Format, Machine, Paper, Placed, WrittenCampaign, value};
use impact_records::language::Language;
use impact_report::catalog::Catalog;
use labfiles::units::{self, Dimension};

/// A campaign as far as it could be resolved, and everything that is wrong with it.
#[derive(Debug)]
pub struct Outcome {
    /// The campaign; `None` if a problem stops it.
    pub campaign: Option<ResolvedCampaign>,
    /// All problems, the gravest first.
    pub diagnostics: Diagnostics,
}

/// Read campaign.toml and list its records, opening files by `open`.
pub fn load(path: &Path, open: Opener<'_>) -> Outcome {
    load_listed(path, (open, None))
}

/// As [`load`], while records are still arriving: only the files that are taken are listed, none at
/// all is no fault, and records that campaign.toml names may not be there yet.
pub fn load_taken(path: &Path, open: Opener<'_>, taken: Taken<'_>) -> Outcome {
    load_listed(path, (open, Some(taken)))
}

fn load_listed(path: &Path, files: (Opener<'_>, Option<Taken<'_>>)) -> Outcome {
    let mut faults = FaultCollector::new(path);
    let text = read::text(path, &mut faults);
    let text = text.as_deref();
    let written = text.and_then(|text| read::read(text, &mut faults));
    let mut context = ResolveContext {
        text: Text::new(text.unwrap_or_default()),
        faults,
    };
    let campaign = written.map(|written| resolve(path, &written, files, &mut context));
    let blocks = context.faults.blocks();
    let mut diagnostics = context.faults.into_diagnostics();
    diagnostics.sort();
    Outcome {
        campaign: campaign.filter(|_| !blocks),
        diagnostics,
    }
}

fn resolve(
    path: &Path,
    written: &WrittenCampaign,
    (open, taken): (Opener<'_>, Option<Taken<'_>>),
    context: &mut ResolveContext<'_>,
) -> ResolvedCampaign {
    let machine = machine(&written.campaign.machine, context);
    let flight = value(&written.campaign.flight).unwrap_or(Flight::Harmonic);
    let channels = match written.published {
        Some(_) => Vec::new(),
        None => channels::resolve(&written.channels, (machine, flight), context),
    };
    let time = value(&written.records.time).map(|t| t.0);
    let folder = path.parent().unwrap_or(Path::new(""));
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
    exclude(&mut records, (&written.analysis.exclude, all), context);
    rig::refuse_long_delays(&channels, &records, &written.channels, context);
    let name = name(&written.campaign.name, folder);
    let run_table = value(&written.records.run_table).map(|t| folder.join(t));
    ResolvedCampaign {
        run_table,
        machine,
        flight,
        rig: rig::resolve(&written.rig, context),
        time_unit_s: time_unit(&written.records.time_unit, context),
        sample_rate_hz: context.positive(
            &written.records.sample_rate,
            "records.sample_rate",
            Dimension::Frequency,
        ),
        analysis: analysis(&written.analysis, context),
        report: report(&written.report, &name, (folder, &records, all), context),
        synthetic: written.campaign.synthetic,
        laboratory: value(&written.campaign.laboratory),
        measured: value(&written.campaign.measured),
        file: path.to_path_buf(),
        name,
        channels,
        time,
        records,
        published: written.published.clone(),
        sources,
    }
}

/// Seconds in the stated unit of time.
fn time_unit(placed: &Placed<String>, context: &mut ResolveContext<'_>) -> Option<f64> {
    let placed = placed.as_ref()?;
    let unit = units::parse_unit(placed.get_ref()).filter(|u| u.dimension == Dimension::Time);
    if unit.is_none() {
        let what = format!("'{}' is no unit of time", placed.get_ref());
        let remedy = "write s, ms, us, ns or min";
        context.fault(
            Code::InvalidValue,
            placed,
            "records.time_unit",
            what,
            remedy,
        );
    }
    unit.map(|u| u.to_si)
}

fn machine(placed: &Placed<Machine>, context: &mut ResolveContext<'_>) -> Machine {
    if placed.is_none() && !context.faults.blocks() {
        let (key, what) = ("campaign.machine", "it is not given");
        let remedy = "write machine = \"double\" (two masses) or \"single\" (one, and a stop)";
        context.faults.fault(Code::Missing, None, key, what, remedy);
    }
    value(placed).unwrap_or(Machine::Double)
}

fn name(placed: &Placed<String>, folder: &Path) -> String {
    let folder_name = || {
        let whole = std::path::absolute(Path::new(".").join(folder)).ok()?;
        whole.file_name().map(|n| n.to_string_lossy().into_owned())
    };
    value(placed)
        .or_else(folder_name)
        .unwrap_or_else(|| "campaign".to_owned())
}

fn analysis(written: &written::Analysis, context: &mut ResolveContext<'_>) -> Analysis {
    let skip = context.within(
        &written.skip,
        "analysis.skip",
        Dimension::Time,
        [0.0, f64::INFINITY],
    );
    let mut count = |placed: &Placed<u32>, key: &str, default: u32| {
        let Some(placed) = placed else { return default };
        let value = *placed.get_ref();
        if !(1..=64).contains(&value) {
            let what = format!("{value} is out of range");
            context.fault(
                Code::OutOfRange,
                placed,
                key,
                what,
                "write a number from 1 to 64",
            );
        }
        value
    };
    Analysis {
        skip_s: skip.unwrap_or(0.0),
        longest_period_n: count(&written.longest_period_n, "analysis.longest_period_n", 6),
        most_impacts_p: count(&written.most_impacts_p, "analysis.most_impacts_p", 12),
        seed: value(&written.seed).unwrap_or(1),
        uncertainty: value(&written.uncertainty).unwrap_or_default(),
        replicas: value(&written.replicas).unwrap_or(1000).max(2) as usize,
    }
}

fn report(
    written: &written::Report,
    name: &str,
    (folder, records, all): (&Path, &[RecordEntry], bool),
    context: &mut ResolveContext<'_>,
) -> Report {
    let known = |point: &String| records.iter().any(|r| r.id == *point);
    if let Some(points) = written.points.as_ref().filter(|_| all) {
        for point in points.get_ref() {
            if !known(point) && !records.is_empty() {
                unknown_record(points, "report.points", point, records, context);
            }
        }
    }
    let language = value(&written.language).unwrap_or_default();
    let comma = Language::of_code(&language.0).is_some_and(Language::decimal_comma);
    Report {
        title: value(&written.title).unwrap_or_else(|| name.to_owned()),
        points: value(&written.points)
            .unwrap_or_default()
            .into_iter()
            .filter(|point| all || known(point))
            .collect(),
        paper: value(&written.paper).unwrap_or(Paper::A4),
        language,
        decimal_comma: value(&written.decimal_comma).unwrap_or(comma),
        formats: value(&written.formats)
            .filter(|formats| !formats.is_empty())
            .unwrap_or_else(|| vec![Format::Pdf]),
        template: beside(&written.template, "report.template", folder, context),
        words: words_file(&written.words, folder, context),
        logo: beside(&written.logo, "report.logo", folder, context),
    }
}

/// A table of words that campaign.toml names; a fault where it cannot be used.
fn words_file(
    placed: &Placed<String>,
    folder: &Path,
    context: &mut ResolveContext<'_>,
) -> Option<PathBuf> {
    let key = "report.words";
    let path = beside(placed, key, folder, context)?;
    if let (Some(placed), Ok(text)) = (placed, labfiles::read_text(&path))
        && let Err(error) = Catalog::read(&text)
    {
        let what = format!("{}: {error}", path.display());
        context.fault(
            Code::UnreadableFile,
            placed,
            key,
            what,
            "fix the table, or remove the line",
        );
    }
    Some(path)
}

/// A file that campaign.toml names; a fault where it is not there.
fn beside(
    placed: &Placed<String>,
    key: &str,
    folder: &Path,
    context: &mut ResolveContext<'_>,
) -> Option<PathBuf> {
    let placed = placed.as_ref()?;
    let path = folder.join(placed.get_ref());
    if !path.is_file() {
        let what = format!("{} is not a file", path.display());
        let remedy = "write its path as seen from campaign.toml's folder, or remove the line";
        context.fault(Code::UnreadableFile, placed, key, what, remedy);
    }
    Some(path)
}

fn unknown_record<T>(
    placed: &Spanned<T>,
    key: &str,
    name: &str,
    records: &[RecordEntry],
    context: &mut ResolveContext<'_>,
) {
    let names: Vec<&str> = records.iter().map(|r| r.id.as_str()).collect();
    let what = format!("no record is called '{name}'");
    let remedy = match read::nearest(name, &names) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!(
            "the first records are {}",
            names[..names.len().min(4)].join(", ")
        ),
    };
    context.fault(Code::UnknownRecord, placed, key, what, &remedy);
}

fn exclude(
    records: &mut [RecordEntry],
    (placed, all): (&Placed<Vec<String>>, bool),
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
            unknown_record(placed, "analysis.exclude", name, records, context);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
