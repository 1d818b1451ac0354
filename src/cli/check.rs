//! `impactid check`: read everything, list every problem at once, change nothing.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::failure::print_diagnostics;
use super::outputs::Output;
use super::read_log::ReadLog;
use super::report_args::language_parser;
use super::speech::Speech;
use super::stdout::print_json;
use super::{Exit, Failure, Progress, Verbosity};
use impact_campaign::campaign::check;
use impact_campaign::campaign::diagnostic::{Code, Diagnostic, Diagnostics, Place, Severity};
use impact_campaign::campaign::load;
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_records::language::Language;
use impact_records::message::counted;

/// Arguments of `impactid check`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Check {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML", default_value = "campaign.toml")]
    campaign: PathBuf,
    /// Language in which what was found in records is printed [default: that of the report]
    #[arg(long, value_name = "LANGUAGE", value_parser = language_parser())]
    language: Option<Language>,
    /// Print JSON: how many records can be used, and every problem
    #[arg(long)]
    json: bool,
}

/// What was found, as JSON.
#[derive(Serialize)]
struct Found<'a> {
    records: u64,
    usable_records: usize,
    problems: &'a [Diagnostic],
}

const EXAMPLE: &str = "\
Example:
  impactid check data-samples/double-oscillator/campaign.toml

Exit codes: 0 nothing but notes; 2 an error that stops the campaign, or a warning: a record is \
left out.";

impl Check {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let log = ReadLog::new(verbosity);
        let mut outcome = load(&self.campaign, &|path| log.open(path));
        log.print();
        let mut usable = None;
        if let Some(campaign) = &outcome.campaign {
            let total = campaign.records.len() as u64;
            let progress = Progress::new(verbosity, "reading", total);
            let open = labfiles::open;
            let checked = check::read_all(campaign, &open, &|done| progress.set(done, total));
            outcome.diagnostics.0.extend(checked.diagnostics);
            if checked.usable == 0
                && total > 0
                && outcome.diagnostics.count(Severity::Campaign) == 0
            {
                outcome.diagnostics.0.push(self.nothing_usable(total));
            }
            outcome.diagnostics.sort();
            usable = Some((checked.usable, total));
        }
        let speech = self.speech(outcome.campaign.as_ref());
        print_diagnostics(&outcome.diagnostics, speech.words().as_ref(), verbosity);
        if self.json {
            let (usable_records, records) = usable.unwrap_or_default();
            print_json(&Found {
                records,
                usable_records,
                problems: &outcome.diagnostics.0,
            })?;
        }
        print_counts(&outcome.diagnostics, usable, &speech, verbosity);
        let all = outcome.diagnostics.0.len();
        Ok(if outcome.diagnostics.count(Severity::Note) == all {
            Exit::Done
        } else {
            Exit::BadInput
        })
    }
}

impl Check {
    /// The language asked for, else that of the campaign's report.
    fn speech(&self, campaign: Option<&ResolvedCampaign>) -> Speech {
        let of_report = || Speech::of(&campaign?.report).ok();
        match self.language {
            Some(language) => Speech::in_language(language),
            None => of_report().unwrap_or_default(),
        }
    }

    fn nothing_usable(&self, records: u64) -> Diagnostic {
        let place = Place {
            file: self.campaign.clone(),
            item: "records".to_owned(),
            ..Place::default()
        };
        let found = format!("none of the {} can be used", counted(records, "record"));
        let remedy = "fix what is wrong with the records, as listed; `run` stops here";
        Diagnostic::new((Code::Missing, Severity::Campaign), place, found, remedy)
    }
}

fn print_counts(
    all: &Diagnostics,
    usable: Option<(usize, u64)>,
    speech: &Speech,
    verbosity: Verbosity,
) {
    if let Some((usable, records)) = usable {
        let records = usize::try_from(records).unwrap_or(usize::MAX);
        verbosity.info(&speech.say(&Output::Usable(usable, records)));
    }
    type Form = fn(usize) -> Output;
    let forms: [(Severity, Form, Form); 3] = [
        (Severity::Campaign, Output::OneError, Output::Errors),
        (Severity::Record, Output::OneWarning, Output::Warnings),
        (Severity::Note, Output::OneNote, Output::Notes),
    ];
    let counts = forms.map(|(severity, one, several)| {
        let count = all.count(severity);
        let form = if count == 1 { one } else { several };
        speech.say(&form(count))
    });
    verbosity.info(&format!("{}.", counts.join(", ")));
}
