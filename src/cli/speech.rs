//! How a command speaks of its results: in the language of the report.

use super::Failure;
use impact_campaign::campaign::sections::report::ReportSettings;
use impact_campaign::pipeline;
use impact_records::language::Language;
use impact_records::message::{Message, Print, Typed, Value};
use impact_records::message_table;
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

/// What a command has written.
#[derive(Debug, Clone, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Output {
    /// A file.
    Written(String),
    /// A report: its format and its path.
    Report(&'static str, String),
    /// A file that another program holds, and that beside it which is the new one.
    Beside(String, String),
    /// A record that is left out: of how many, why, and what to do.
    OneLeftOut(LeftOutRecords),
    /// Several records.
    SomeLeftOut(LeftOutRecords),
    /// Records that contradict what is stated of them and are not left out.
    Contradicting(LeftOutRecords),
    /// How many records can be used, and of how many.
    Usable(usize, usize),
    /// What stops the campaign.
    OneError(usize),
    /// Several of these.
    Errors(usize),
    /// What leaves a record out.
    OneWarning(usize),
    /// Several of these.
    Warnings(usize),
    /// What is worth knowing.
    OneNote(usize),
    /// Several of these.
    Notes(usize),
    /// How to see each of the problems that are printed as one.
    SeeEach,
    /// What stands before a remedy.
    Help,
}

/// Records with one kind of fault.
#[derive(Debug, Clone, Default)]
pub(super) struct LeftOutRecords {
    /// How many.
    pub(super) count: usize,
    /// Of how many.
    pub(super) of: usize,
    /// What is wrong with them.
    pub(super) fault: String,
    /// What to do.
    pub(super) remedy: String,
}

message_table! { "output": Output;
    Self::Written(path) => path = Value::Name(path);
    Self::Report(format, path) => format = Value::Name(format), path = Value::Name(path);
    Self::Beside(held, path) => held = Value::Name(held), path = Value::Name(path);
    Self::OneLeftOut(left) | Self::SomeLeftOut(left) | Self::Contradicting(left) =>
        count = Value::Count(left.count),
        of = Value::Count(left.of),
        fault = Value::Name(&left.fault),
        remedy = Value::Name(&left.remedy);
    Self::Usable(usable, records) => usable = Value::Count(*usable), records = Value::Count(*records);
    Self::OneError(count) | Self::Errors(count) | Self::OneWarning(count) | Self::Warnings(count)
    | Self::OneNote(count) | Self::Notes(count) => count = Value::Count(*count);
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::messages::Sentence;
    use impact_records::message::{boxed, faults};

    #[test]
    fn every_output_has_its_texts() {
        let all = boxed(<Output as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
    }

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
