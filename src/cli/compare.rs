//! `impactid compare`: what changed between campaigns.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::load::load_campaign;
use super::progress::Progress;
use super::report_args::{paper_parser, quoted};
use super::stdout::{print, print_json};
use super::{Exit, Failure, Verbosity, interrupt};
use impact_campaign::pipeline::campaigns;
use impact_campaign::pipeline::{self, Observed};
use impact_identification::compare::{self, Campaign, Comparison};
use impact_report::catalog::Catalog;
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
    /// Title of the report
    #[arg(long, value_name = "TEXT", default_value = "Campaigns compared")]
    title: String,
    /// Language of the report
    #[arg(long, value_name = "LANGUAGE", value_enum, default_value = "en")]
    language: Language,
    /// Paper size; us-letter is the same as letter
    #[arg(long, value_name = "PAPER", value_parser = paper_parser())]
    paper: Option<Paper>,
    /// Print numbers with a decimal comma
    #[arg(long)]
    decimal_comma: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// Language of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Language {
    /// English
    En,
    /// German
    De,
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
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let _lock = interrupt::lock(&self.out)?;
        let mut all = Vec::new();
        for (number, path) in self.campaigns.iter().enumerate() {
            self.refuse_twice(number)?;
            all.extend(of_path(path, number, verbosity)?);
        }
        let places: Vec<String> = self
            .campaigns
            .iter()
            .map(|p| p.display().to_string())
            .collect();
        campaigns::tell_apart(&mut all, &places);
        let comparison = compare::compare(&all).map_err(pipeline::PipelineError::from)?;
        let content = CampaignsContent {
            title: self.title.clone(),
            comparison,
            command_line: self.typed(),
        };
        let comparison = &content.comparison;
        let files = campaigns::files(&content, &self.format, &self.options())?;
        pipeline::report::write(&files, &self.out)?;
        if self.json {
            print_json(comparison)?;
        } else if !verbosity.is_quiet() {
            print(&table(comparison))?;
        }
        for (name, _) in files.iter().filter(|(name, _)| !name.contains('/')) {
            verbosity.info(&format!("Written: {}", self.out.join(name).display()));
        }
        Ok(Exit::Done)
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

    /// The look of the documents.
    fn options(&self) -> ReportOptions {
        let german = self.language == Language::De;
        ReportOptions {
            paper: self.paper.unwrap_or_default(),
            language: if german { "de" } else { "en" }.to_owned(),
            catalog: german.then(|| Catalog::german().clone()),
            decimal_comma: self.decimal_comma,
            ..ReportOptions::default()
        }
    }

    /// The command as typed.
    fn typed(&self) -> String {
        let paths: Vec<String> = self.campaigns.iter().map(|p| quoted(p)).collect();
        let formats: Vec<&str> = self.format.iter().map(|f| f.name()).collect();
        let mut text = format!(
            "impactid compare {} --out {} --format {} --title {}",
            paths.join(" "),
            quoted(&self.out),
            formats.join(","),
            quoted(Path::new(&self.title))
        );
        if self.language == Language::De {
            text.push_str(" --language de");
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

/// The campaigns at a path: results as they are, a campaign.toml identified.
fn of_path(path: &Path, number: usize, verbosity: Verbosity) -> Result<Vec<Campaign>, Failure> {
    if !path.exists() {
        return Err(Failure::new(
            format!("{}: there is no such file or folder", path.display()),
            "give results folders of `impactid run`, or campaign.toml files",
        ));
    }
    let described = path.is_file() && path.extension().is_some_and(|e| e == "toml");
    if !described {
        return Ok(campaigns::read(path, number)?);
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

/// The least p-value that is printed.
const LEAST_P: f64 = 1e-4;

/// A p-value to four decimals.
fn p_value(p: f64) -> String {
    match p < LEAST_P {
        true => format!("< {LEAST_P}"),
        false => format!("{p:.4}"),
    }
}

/// A p-value behind its name.
fn p_equals(p: f64) -> String {
    let equals = if p < LEAST_P { "" } else { "= " };
    format!("p {equals}{}", p_value(p))
}

/// By which tests the outcome is decided, in parentheses.
fn decided_by(comparison: &Comparison) -> String {
    let count = comparison.differences.len();
    let corrected = comparison.p_value().map(|p| match count {
        1 => p_equals(p),
        _ => format!("{}, corrected for {count} differences", p_equals(p)),
    });
    let together = comparison.unchanged.filter(|_| count > 1).map(|test| {
        let (f, p) = (test.statistic, p_equals(test.p_value));
        format!("all together: F = {f:.3}, {p}")
    });
    let all: Vec<String> = corrected.into_iter().chain(together).collect();
    match all.is_empty() {
        true => String::new(),
        false => format!(" ({})", all.join("; ")),
    }
}

/// The differences as lines.
fn table(comparison: &Comparison) -> String {
    let mut text = String::new();
    for (i, campaign) in comparison.campaigns.iter().enumerate() {
        text += &format!("{:>3}  {}\n", i + 1, campaign.name);
    }
    text += &format!(
        "\n{:>8} {:>21} {:>12} {:>27} {:>12} {:>8}\n",
        "campaign", "parameter", "difference", "95 % interval", "independent", "p"
    );
    for d in &comparison.differences {
        let [low, high] = d.interval95;
        let [least, most] = d.independent_interval95;
        text += &format!(
            "{:>8} {:>21} {:>12.4e} {:>27} {:>12} {:>8}\n",
            d.campaign + 1,
            d.parameter.name(),
            d.value,
            format!("{low:.4e} to {high:.4e}"),
            format!("± {:.2e}", 0.5 * (most - least)),
            p_value(d.p_value)
        );
    }
    text += &format!(
        "\n{}{}.\nShared errors: {}; comparison.json names each with its reason.\n",
        comparison.outcome(),
        decided_by(comparison),
        comparison.shared.len()
    );
    for remark in &comparison.remarks {
        text += &format!("note: {remark}\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_p_value_is_never_printed_as_zero() {
        assert_eq!(p_value(0.0), "< 0.0001");
        assert_eq!(p_value(0.000_12), "0.0001");
        assert_eq!(p_value(0.25), "0.2500");
    }
}
