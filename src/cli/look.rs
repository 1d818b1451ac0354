//! How the report looks: options of every verb that writes one. They go before what campaign.toml
//! says.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Failure, Voice};
use crate::campaign::resolved::Report;
use crate::campaign::written::Paper;
use crate::pipeline;
use crate::report::Format;

/// Options of the report's look.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Report")]
pub struct Look {
    /// What the report is written as: pdf, html, svg, png (several: pdf,html)
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    format: Vec<Format>,
    /// A typst template instead of the built-in one
    #[arg(long, value_name = "FILE")]
    template: Option<PathBuf>,
    /// A table of the report's words in another language (report --list-words prints them)
    #[arg(long, value_name = "FILE")]
    words: Option<PathBuf>,
    /// An image for the first page: svg, png or jpg
    #[arg(long, value_name = "FILE")]
    logo: Option<PathBuf>,
    /// Paper: a4 or letter
    #[arg(long, value_name = "PAPER", value_parser = paper)]
    paper: Option<Paper>,
    /// Print numbers with a decimal comma
    #[arg(long)]
    decimal_comma: bool,
}

fn paper(name: &str) -> Result<Paper, String> {
    match name {
        "a4" => Ok(Paper::A4),
        "letter" | "us-letter" => Ok(Paper::UsLetter),
        other => Err(format!("unknown paper '{other}'; known are a4 and letter")),
    }
}

impl Look {
    /// Put these options before those of campaign.toml.
    pub(super) fn apply(&self, report: &mut Report, voice: Voice) -> Result<(), Failure> {
        let files = [&self.template, &self.words, &self.logo];
        for file in files.into_iter().flatten() {
            if !file.is_file() {
                return Err(Failure::new(
                    format!("{} is no file", file.display()),
                    "name the template, the words and the logo as they lie on the disk, or leave them \
                     out",
                ));
            }
        }
        if !self.format.is_empty() {
            report.formats.clone_from(&self.format);
        }
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
        report.decimal_comma |= self.decimal_comma;
        if let Some(catalog) = pipeline::report::catalog(report)? {
            for remark in catalog.remarks() {
                voice.say(&format!("note: {remark}"));
            }
        }
        Ok(())
    }

    /// These options as they are typed, with a space before each.
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
        if self.decimal_comma {
            text.push_str(" --decimal-comma");
        }
        text
    }
}

/// A path as a shell takes it.
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
    fn valid_options_are_typed_as_they_were_given() {
        let look = Look {
            format: vec![Format::Pdf, Format::Html],
            template: Some("my template.typ".into()),
            words: Some("de.toml".into()),
            logo: None,
            paper: Some(Paper::UsLetter),
            decimal_comma: true,
        };
        assert_eq!(
            look.typed(),
            " --format pdf,html --template 'my template.typ' --words de.toml --paper letter --decimal-comma"
        );
        assert_eq!(Look::default().typed(), "");
    }
}
