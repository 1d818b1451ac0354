//! How a command speaks of its results: in the language of the report.

use super::Failure;
use impact_campaign::campaign::sections::report::ReportSettings;
use impact_campaign::pipeline;
use impact_records::language::Language;
use impact_records::message::{Message, Print, Typed};
use impact_report::catalog::Catalog;
use impact_report::locale::Locale;

/// Language and decimal sign.
#[derive(Debug, Default)]
pub(super) struct Speech {
    catalog: Option<Catalog>,
    decimal_comma: bool,
}

impl Speech {
    /// Those of a campaign's report.
    ///
    /// # Errors
    /// [`Failure`] where its table of words cannot be read.
    pub(super) fn of(report: &ReportSettings) -> Result<Self, Failure> {
        Ok(Self {
            catalog: pipeline::report::catalog(report)?,
            decimal_comma: report.decimal_comma,
        })
    }

    /// Those of a language.
    pub(super) fn in_language(language: Language) -> Self {
        let translated = language != Language::default();
        Self {
            catalog: translated.then(|| Catalog::of(language)),
            decimal_comma: language.decimal_comma(),
        }
    }

    /// A message without markup.
    pub(super) fn say(&self, message: &dyn Message) -> String {
        said(message, self.locale())
    }

    /// Messages without markup, one after the other.
    pub(super) fn say_all<M: Message>(&self, messages: &[M]) -> String {
        let each: Vec<String> = messages.iter().map(|m| self.say(m)).collect();
        each.join(" ")
    }

    /// How problems are printed: in English their numbers are as they are typed.
    pub(super) fn words(&self) -> Box<dyn Print + '_> {
        match self.catalog {
            Some(_) => Box::new(Plain(self.locale())),
            None => Box::new(Typed),
        }
    }

    /// Language and decimal sign, as the report has them.
    pub(super) fn locale(&self) -> Locale<'_> {
        Locale {
            decimal_comma: self.decimal_comma,
            catalog: self.catalog.as_ref(),
        }
    }
}

/// A message without markup.
pub(super) fn said(message: &dyn Message, locale: Locale<'_>) -> String {
    Plain(locale).print(message)
}

/// A locale without the markup of symbols; names are as they are.
struct Plain<'a>(Locale<'a>);

impl Print for Plain<'_> {
    fn template(&self, message: &dyn Message) -> String {
        let template = self.0.template(message);
        template.replace("$f_0$", "f0").replace('$', "")
    }

    fn number(&self, digits: String) -> String {
        self.0.number(digits)
    }

    fn name(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// A text without the markup of symbols, which a terminal does not set: `f0` and `x_st`.
pub(super) fn plain(text: &str) -> String {
    text.replace(['$', '{', '}'], "").replace("f_0", "f0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::outputs::Output;
    use impact_fit::messages::Sentence;

    #[test]
    fn a_verdict_is_said_in_the_language_of_the_report() {
        let german = Speech::in_language(Language::of_code("de").expect("German"));
        let one = [Sentence::MethodsAgree];
        assert_eq!(Speech::default().say_all(&one), "The methods agree.");
        assert_ne!(german.say_all(&one), "The methods agree.");
        let written = Output::Written("half_01/$x.pdf".to_owned());
        assert_eq!(german.say(&written), "Geschrieben: half_01/$x.pdf");
    }
}
