//! `impactid compare`: what changed between campaigns.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::wrapped;
use super::load::load_campaign;
use super::out_folder::Work;
use super::outputs::Output;
use super::patterns::expanded;
use super::progress::Progress;
use super::report_args::{each_once, held_by_another, language_parser, paper_parser, quoted};
use super::speech::{plain, said};
use super::stdout::{print, print_json};
use super::{Exit, Failure, Verbosity, out_folder};
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_campaign::pipeline::campaigns;
use impact_campaign::pipeline::{self, Observed};
use impact_identification::compare::{self, Campaign, Comparison};
use impact_records::language::Language;
use impact_records::message::{Message, Value};
use impact_records::message_table;
use impact_report::catalog::Catalog;
use impact_report::differences::{PrintedDifference, p_equals, statistic};
use impact_report::locale::Locale;
use impact_report::{CampaignsContent, Format, Paper, ReportOptions};

/// Arguments of `impactid compare`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Compare {
    /// Results folders, or campaign.toml files, which are identified first; the first is the reference
    #[arg(value_name = "CAMPAIGN", required = true, num_args = 1..)]
    campaigns: Vec<PathBuf>,
    /// Folder for comparison.json, comparison.csv and the report; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Formats of the report: pdf, html; of its figures: svg, png, figure-pdf; of its tables: tex
    /// (several: pdf,html)
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "pdf,html"
    )]
    format: Vec<Format>,
    /// Title of the report [default: "Campaigns compared" in its language]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Language of the report
    #[arg(long, value_name = "LANGUAGE", value_parser = language_parser(), default_value = Language::default().code())]
    language: Language,
    /// Paper size; us-letter is the same as letter
    #[arg(long, value_name = "PAPER", value_parser = paper_parser())]
    paper: Option<Paper>,
    /// Print numbers with a decimal comma; some languages always do
    #[arg(long)]
    decimal_comma: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid compare results-before/ results-after/ --out comparison/
  impactid compare 2023/ 2024/ 2025/campaign.toml --out trend/ --format pdf,html

Each campaign is compared with the first. Errors that campaigns have in common cancel: those \
of channels with the same instrument (a serial number in the channel's key `instrument`), and \
what both campaigns state in campaign.toml as `[rig] shared = [...]`. A campaign with several \
specimens gives one entry for each.
Outputs: comparison.json, comparison.csv, comparison.pdf, comparison.html, figures/trend.csv.
Exit codes: 0 success, whether anything changed or not; 2 bad input.";

impl Compare {
    /// Read or identify, compare, write.
    ///
    /// # Errors
    /// [`Failure`] where a campaign cannot be used, they cannot be compared or an output cannot be written.
    pub(super) fn run(mut self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let remedy = "give results folders of `impactid run`, or campaign.toml files";
        self.campaigns = expanded(&self.campaigns, remedy)?;
        // what is wrong with one of them is told before any is identified
        for number in 0..self.campaigns.len() {
            self.refuse_twice(number)?;
        }
        let given = self.campaigns.iter().enumerate();
        let given: Vec<Given> = given
            .map(|(number, path)| Given::at(path, number, verbosity))
            .collect::<Result<_, _>>()?;
        let new = !self.out.exists();
        let lock = out_folder::take(&self.out, Work::Comparison)?;
        let comparison = match self.compared(given, verbosity) {
            Ok(comparison) => comparison,
            Err(failure) => {
                drop(lock);
                if new {
                    // one that holds something stays
                    let _ = std::fs::remove_dir(&self.out);
                }
                return Err(failure);
            }
        };
        let content = CampaignsContent {
            title: self.title(),
            comparison,
            command_line: self.typed(),
        };
        let comparison = &content.comparison;
        let files = campaigns::files(&content, &each_once(&self.format), &self.options())?;
        let beside = pipeline::report::write(&files, &self.out)?;
        if self.json {
            print_json(comparison)?;
        } else if !verbosity.is_quiet() {
            print(&table(comparison, self.options().locale()))?;
        }
        for (name, _) in files.iter().filter(|(name, _)| !name.contains('/')) {
            let path = self.out.join(name).display().to_string();
            verbosity.info(&said(&Output::Written(path), self.options().locale()));
        }
        for held in &beside {
            let words = said(&held_by_another(held), self.options().locale());
            verbosity.info(&wrapped(&words));
        }
        Ok(Exit::Done)
    }

    /// What the campaigns differ in.
    fn compared(&self, given: Vec<Given>, verbosity: Verbosity) -> Result<Comparison, Failure> {
        let mut all = Vec::new();
        for (number, given) in given.into_iter().enumerate() {
            all.extend(given.identified(number, verbosity)?);
        }
        let places = self.campaigns.iter().map(|p| p.display().to_string());
        campaigns::tell_apart(&mut all, &places.collect::<Vec<_>>());
        let comparison = compare::compare(&all).map_err(pipeline::PipelineError::from)?;
        Ok(comparison)
    }

    /// Refuse a path that was given before.
    fn refuse_twice(&self, number: usize) -> Result<(), Failure> {
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let path = &self.campaigns[number];
        let before = self.campaigns[..number].iter();
        if before.map(|p| real(p)).any(|p| p == real(path)) {
            return Err(Failure::new(
                format!("{} is given twice", path.display()),
                "give each measurement once",
            ));
        }
        Ok(())
    }

    fn title(&self) -> String {
        let usual = || Word::Title.template(self.language).to_owned();
        self.title.clone().unwrap_or_else(usual)
    }

    /// The look of the documents.
    fn options(&self) -> ReportOptions {
        let translated = self.language != Language::default();
        ReportOptions {
            paper: self.paper.unwrap_or_default(),
            language: self.language.code().to_owned(),
            catalog: translated.then(|| Catalog::of(self.language)),
            decimal_comma: self.decimal_comma || self.language.decimal_comma(),
            ..ReportOptions::default()
        }
    }

    /// The command as typed.
    fn typed(&self) -> String {
        let paths: Vec<String> = self.campaigns.iter().map(|p| quoted(p)).collect();
        let formats: Vec<&str> = self.format.iter().map(|f| f.name()).collect();
        let mut text = format!(
            "impactid compare {} --out {} --format {}",
            paths.join(" "),
            quoted(&self.out),
            formats.join(",")
        );
        if let Some(title) = &self.title {
            text += &format!(" --title {}", quoted(Path::new(title)));
        }
        if self.language != Language::default() {
            text += &format!(" --language {}", self.language.code());
        }
        if let Some(paper) = self.paper {
            text += &format!(" --paper {}", paper.name().trim_start_matches("us-"));
        }
        if self.decimal_comma {
            text.push_str(" --decimal-comma");
        }
        text
    }
}

/// What a path on the command line is.
enum Given {
    /// Results.
    Results(Vec<Campaign>),
    /// A campaign that must be identified first.
    Described(Box<ResolvedCampaign>),
}

impl Given {
    /// Results as they are, or a campaign.toml that is read, not yet identified.
    fn at(path: &Path, number: usize, verbosity: Verbosity) -> Result<Self, Failure> {
        if !path.exists() {
            return Err(Failure::new(
                format!("{}: there is no such file or folder", path.display()),
                "give results folders of `impactid run`, or campaign.toml files",
            ));
        }
        let described = path.is_file() && path.extension().is_none_or(|e| e != "json");
        if !described {
            return Ok(Self::Results(campaigns::read(path, number)?));
        }
        let campaign = load_campaign(path, verbosity)?;
        if campaign.published.is_some() {
            return Err(Failure::new(
                format!(
                    "{}: published speeds are no measurement of a rig",
                    path.display()
                ),
                "compare campaigns that have records",
            ));
        }
        Ok(Self::Described(Box::new(campaign)))
    }

    /// The campaigns: results as they are, a campaign.toml identified.
    fn identified(self, number: usize, verbosity: Verbosity) -> Result<Vec<Campaign>, Failure> {
        let campaign = match self {
            Self::Results(campaigns) => return Ok(campaigns),
            Self::Described(campaign) => campaign,
        };
        let bar = Progress::new(verbosity, "observe", campaign.records.len() as u64);
        let observed = Observed::of(&campaign, &|s, d, t| bar.step(s, d, t))?;
        bar.step("identify", 0, 1);
        let found = pipeline::identify::identify(&campaign, &observed, Some(bar.fits()))?;
        drop(bar);
        Ok(campaigns::campaigns(
            &campaign,
            found.identification,
            number,
        ))
    }
}

/// Words of the table, and the report's usual title.
#[derive(Debug, Clone, Copy, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
enum Word {
    Title,
    Campaign,
    Parameter,
    Difference,
    Interval,
    Independent,
    P,
    CorrectedFor(usize),
    Together,
    Shared,
    Named,
    Note,
}

message_table! { "compare_table": Word;
    Self::CorrectedFor(count) => count = Value::Count(*count);
}

/// By which tests the outcome is decided, in parentheses.
fn decided_by(comparison: &Comparison, locale: Locale<'_>) -> String {
    let count = comparison.differences.len();
    let word = |word: Word| locale.message(&word);
    let corrected = comparison.p_value().map(|p| match count {
        1 => format!("p {}", p_equals(p, locale)),
        _ => {
            let corrected = word(Word::CorrectedFor(count));
            format!("p {}, {corrected}", p_equals(p, locale))
        }
    });
    let together = comparison.unchanged.filter(|_| count > 1).map(|test| {
        let (f, p) = (statistic(&test, locale), p_equals(test.p_value, locale));
        format!("{}: F = {f}, p {p}", word(Word::Together))
    });
    let all: Vec<String> = corrected.into_iter().chain(together).collect();
    if all.is_empty() {
        String::new()
    } else {
        format!(" ({})", all.join("; "))
    }
}

/// The differences as lines.
fn table(comparison: &Comparison, locale: Locale<'_>) -> String {
    let word = |word: Word| locale.message(&word);
    let said = |message: &dyn Message| said(message, locale);
    let mut text = String::new();
    for (i, campaign) in comparison.campaigns.iter().enumerate() {
        text += &format!("{:>3}  {}\n", i + 1, campaign.name);
    }
    let heads = [
        Word::Campaign,
        Word::Parameter,
        Word::Difference,
        Word::Interval,
        Word::Independent,
        Word::P,
    ];
    let [campaign, parameter, difference, interval, independent, p] = heads.map(word);
    let line = |cells: [&str; 6]| {
        let [campaign, parameter, difference, interval, independent, p] = cells;
        format!(
            "{campaign:>9} {parameter:>9} {difference:>22} {interval:>28} {independent:>14} {p:>8}\n"
        )
    };
    text.push('\n');
    text += &line([
        &campaign,
        &parameter,
        &difference,
        &interval,
        &independent,
        &p,
    ]);
    let differences = comparison.differences.iter();
    for d in differences.filter_map(|d| PrintedDifference::of(d, locale)) {
        text += &line([
            &d.campaign,
            &plain(d.parameter),
            &d.value,
            &d.interval,
            &d.independent,
            &d.p_value,
        ]);
    }
    let [shared, named] = [Word::Shared, Word::Named].map(word);
    text += &format!(
        "\n{}{}.\n{shared}: {}; {named}.\n",
        said(&comparison.outcome()),
        decided_by(comparison, locale),
        comparison.shared.len()
    );
    for remark in &comparison.remarks {
        text += &format!("{}: {}\n", word(Word::Note), said(remark));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::{boxed, faults};
    use impact_report::differences::p_value;

    #[test]
    fn a_p_value_is_never_printed_as_zero() {
        let english = Locale::default();
        assert_eq!(p_value(0.0, english), "< 0.001");
        assert_eq!(p_value(0.001_2, english), "0.001");
        assert_eq!(p_value(0.25, english), "0.250");
        let catalog = Catalog::of(Language::of_code("de").expect("German"));
        let german = Locale {
            decimal_comma: true,
            catalog: Some(&catalog),
        };
        assert_eq!(p_value(0.25, german), "0,250");
        assert_eq!(p_equals(0.0, german), "< 0,001");
    }
    #[test]
    fn every_word_has_its_texts() {
        let words = boxed(<Word as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&words.collect::<Vec<_>>()), Vec::<String>::new());
    }
}
