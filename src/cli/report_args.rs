//! Options of the report, shared by the commands that write one. They override those of
//! campaign.toml.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Args, Command};

use super::failure::wrapped;
use super::outputs::Output;
use super::speech::Speech;
use super::{Failure, Verbosity};
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_campaign::campaign::sections::report::ReportSettings;
use impact_campaign::campaign::values::LanguageCode;
use impact_campaign::pipeline;
use impact_records::language::Language;
use impact_report::Format;
use impact_report::Paper;
use labfiles_write::output::WrittenBeside;

/// Options of the report.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Report")]
pub(super) struct ReportArgs {
    /// Formats of the report: pdf, html; of its figures: svg, png, figure-pdf; of its tables: tex; csv:
    /// the figures' data alone (several: pdf,html)
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    format: Vec<Format>,
    /// Typst template instead of the built-in one
    #[arg(long, value_name = "FILE")]
    template: Option<PathBuf>,
    /// Table of the report's phrases in another language (report --list-words prints them)
    #[arg(long, value_name = "FILE")]
    words: Option<PathBuf>,
    /// Image for the first page: svg, png or jpg
    #[arg(long, value_name = "FILE")]
    logo: Option<PathBuf>,
    /// Paper size; us-letter is the same as letter
    #[arg(long, value_name = "PAPER", value_parser = paper_parser())]
    paper: Option<Paper>,
    /// Title of the report
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Language of the report
    #[arg(long, value_name = "LANGUAGE", value_parser = language_parser())]
    language: Option<Language>,
    /// Print numbers with a decimal comma; some languages always do
    #[arg(long)]
    decimal_comma: bool,
}

/// Takes names in capitals too, and with blanks around them.
#[derive(Clone)]
struct Lenient(PossibleValuesParser);

impl TypedValueParser for Lenient {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        typed: &OsStr,
    ) -> Result<String, clap::Error> {
        let name = typed.to_string_lossy().trim().to_lowercase();
        self.0.parse_ref(command, argument, OsStr::new(&name))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.0.possible_values()
    }
}

/// The languages of the program, by their codes.
pub(super) fn language_parser() -> impl TypedValueParser<Value = Language> {
    let each = Language::all().map(|l| PossibleValue::new(l.code()).help(l.name()));
    Lenient(PossibleValuesParser::new(each))
        .map(|code| Language::of_code(&code).unwrap_or_default())
}

/// Reads the name of a paper on the command line.
pub(super) fn paper_parser() -> impl TypedValueParser<Value = Paper> {
    let names = [
        PossibleValue::new("a4"),
        PossibleValue::new("letter").alias("us-letter"),
    ];
    Lenient(PossibleValuesParser::new(names)).map(|name| match name.as_str() {
        "a4" => Paper::A4,
        _ => Paper::UsLetter,
    })
}

impl ReportArgs {
    /// The language asked for.
    pub(super) fn language(&self) -> Option<Language> {
        self.language
    }

    /// Override the options of campaign.toml.
    pub(super) fn apply(
        &self,
        report: &mut ReportSettings,
        verbosity: Verbosity,
    ) -> Result<(), Failure> {
        let files = [&self.template, &self.words, &self.logo];
        for file in files.into_iter().flatten() {
            if !file.is_file() {
                return Err(Failure::new(
                    format!("{} is not a file", file.display()),
                    "check the path, or leave the option out",
                ));
            }
        }
        if !self.format.is_empty() {
            report.formats.clone_from(&self.format);
        }
        report.formats = each_once(&report.formats);
        if self.template.is_some() {
            report.template.clone_from(&self.template);
        }
        if self.words.is_some() {
            report.words.clone_from(&self.words);
        }
        if self.logo.is_some() {
            report.logo.clone_from(&self.logo);
        }
        if let Some(paper) = self.paper {
            report.paper = paper;
        }
        if let Some(title) = &self.title {
            report.title.clone_from(title);
        }
        let other = self.language.filter(|l| l.code() != report.language.0);
        if let Some(language) = other {
            report.language = LanguageCode(language.code().to_owned());
            report.decimal_comma = language.decimal_comma();
        }
        report.date = Some(today());
        report.decimal_comma |= self.decimal_comma;
        if let Some(what) = report.without_texts() {
            verbosity.info(&format!("note: {what}"));
        }
        if let Some(catalog) = pipeline::report::catalog(report)? {
            for remark in catalog.remarks() {
                verbosity.info(&format!("note: {remark}"));
            }
        }
        Ok(())
    }

    /// These options as on the command line, with a space before each.
    pub(super) fn typed(&self) -> String {
        let mut text = String::new();
        let mut add = |name: &str, value: &str| text.push_str(&format!(" --{name} {value}"));
        if !self.format.is_empty() {
            let names: Vec<&str> = self.format.iter().map(|f| f.name()).collect();
            add("format", &names.join(","));
        }
        if let Some(file) = &self.template {
            add("template", &quoted(file));
        }
        if let Some(file) = &self.words {
            add("words", &quoted(file));
        }
        if let Some(file) = &self.logo {
            add("logo", &quoted(file));
        }
        if let Some(paper) = self.paper {
            add("paper", paper.name().trim_start_matches("us-"));
        }
        if let Some(title) = &self.title {
            add("title", &quoted(Path::new(title)));
        }
        if let Some(language) = self.language {
            add("language", language.code());
        }
        if self.decimal_comma {
            text.push_str(" --decimal-comma");
        }
        text
    }
}

/// Seconds of a day.
const DAY: u64 = 86_400;

/// The day, in UTC; with `SOURCE_DATE_EPOCH` that one, so that a report can be made again byte for byte.
fn today() -> String {
    let stated = std::env::var("SOURCE_DATE_EPOCH").ok();
    let now = || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let seconds = stated.and_then(|s| s.parse().ok());
    let seconds = seconds.unwrap_or_else(|| now().map_or(0, |d| d.as_secs()));
    let (year, month, day) = civil(seconds / DAY);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Year, month and day of a number of days since 1 January 1970.
fn civil(days: u64) -> (u64, u64, u64) {
    // eras of 400 years that begin on 1 March
    let shifted = days + 719_468;
    let (era, day) = (shifted / 146_097, shifted % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let next_year = u64::from(month >= 10);
    (
        400 * era + year + next_year,
        if month < 10 { month + 3 } else { month - 9 },
        day - (153 * month + 2) / 5 + 1,
    )
}

/// Formats without those that are there before.
pub(super) fn each_once(formats: &[Format]) -> Vec<Format> {
    let mut once: Vec<Format> = Vec::with_capacity(formats.len());
    for format in formats {
        if !once.contains(format) {
            once.push(*format);
        }
    }
    once
}

/// Refuse formats that stand where campaigns do, as behind a blank, before any campaign is run.
///
/// # Errors
/// [`Failure`] that says how formats are written.
pub(super) fn refuse_formats(campaigns: &[std::path::PathBuf]) -> Result<(), Failure> {
    let is_format = |path: &&std::path::PathBuf| {
        let text = path.to_string_lossy();
        !path.exists() && text.split(',').all(|part| part.parse::<Format>().is_ok())
    };
    let Some(format) = campaigns.iter().find(is_format) else {
        return Ok(());
    };
    Err(Failure::new(
        format!(
            "{} is no campaign but a format; nothing was run",
            format.display()
        ),
        "formats are written with commas and no blanks between them: --format pdf,html",
    ))
}

/// Print the paths of a campaign's report in a folder.
pub(super) fn print_report_paths(
    campaign: &ResolvedCampaign,
    out: &Path,
    beside: &[WrittenBeside],
    speech: &Speech,
    verbosity: Verbosity,
) {
    for format in &campaign.report.formats {
        let name = match format {
            Format::Pdf => "report.pdf",
            Format::Html => "report.html",
            Format::Svg | Format::Png | Format::FigurePdf | Format::Csv => "figures/",
            Format::Tex => "tables/",
        };
        let path = out.join(name);
        let held = beside.iter().find(|file| file.wanted == path);
        let path = held.map_or(path, |file| file.written.clone());
        let path = path.display().to_string();
        verbosity.info(&speech.say(&Output::Report(format.name(), path)));
    }
    for held in beside {
        verbosity.info(&wrapped(&speech.say(&held_by_another(held))));
    }
}

/// What is said of a file that is beside one that another program holds.
pub(super) fn held_by_another(file: &WrittenBeside) -> Output {
    let [held, path] = [&file.wanted, &file.written].map(|path| path.display().to_string());
    Output::Beside(held, path)
}

/// A path quoted for a shell.
pub(super) fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+:,=@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_written_once_and_one_that_is_typed_as_a_campaign_is_named() {
        let twice = [Format::Pdf, Format::Html, Format::Pdf];
        assert_eq!(each_once(&twice), [Format::Pdf, Format::Html]);
        let refused = refuse_formats(&["html".into()]).unwrap_err();
        assert!(refused.problems()[0].1.contains("--format pdf,html"));
        // a campaign that is not there is refused as such
        assert!(refuse_formats(&["none/campaign.toml".into()]).is_ok());
    }

    #[test]
    fn names_are_taken_in_capitals_and_with_blanks() {
        #[derive(clap::Parser)]
        struct Typed {
            #[command(flatten)]
            report: ReportArgs,
        }
        let read = |args: &[&str]| {
            let all = std::iter::once("impactid").chain(args.iter().copied());
            <Typed as clap::Parser>::try_parse_from(all).map(|typed| typed.report.typed())
        };
        let typed = [
            "--format",
            "PDF, html",
            "--paper",
            "A4",
            "--language",
            " DE",
        ];
        let plain = ["--format", "pdf,html", "--paper", "a4", "--language", "de"];
        assert_eq!(read(&typed).unwrap(), read(&plain).unwrap());
        assert!(read(&["--paper", "a5"]).is_err());
    }

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(civil(0), (1970, 1, 1));
        assert_eq!(civil(11_016), (2000, 2, 29));
        assert_eq!(civil(20_783), (2026, 11, 26));
        assert_eq!(civil(47_540), (2100, 2, 28));
        assert_eq!(civil(47_541), (2100, 3, 1));
    }

    #[test]
    fn options_are_typed_as_they_were_given() {
        let options = ReportArgs {
            format: vec![Format::Pdf, Format::Html],
            template: Some("my template.typ".into()),
            words: Some("de.toml".into()),
            logo: None,
            paper: Some(Paper::UsLetter),
            title: Some("Our rig".into()),
            language: Language::of_code("de"),
            decimal_comma: true,
        };
        assert_eq!(
            options.typed(),
            " --format pdf,html --template 'my template.typ' --words de.toml --paper letter --title 'Our rig' --language de \
             --decimal-comma"
        );
        assert_eq!(ReportArgs::default().typed(), "");
    }
}
