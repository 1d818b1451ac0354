//! The document of several campaigns that were compared.

use super::drawn::Drawn;
use super::layout_phrases;
use super::model::{Answer, Block, Document, Front, Rich, Section};
use super::sections::{paragraph, section};
use super::tables;
use crate::content::CampaignsContent;
use crate::differences::{p_equals, statistic};
use crate::kit::Figure;
use crate::locale::Locale;
use crate::parameters::{self, PARAMETERS};
use crate::phrase::Phrase;
use impact_identification::compare::{Comparison, ComparisonOutcome, Difference, EqualityTest};

/// Builds the document's data.
pub(crate) fn campaigns(
    content: &CampaignsContent,
    figures: &[Figure],
    locale: Locale<'_>,
) -> Document {
    let drawn = Drawn { figures, locale };
    let names = content.comparison.campaigns.iter().map(|c| c.name.as_str());
    Document {
        title: content.title.clone(),
        subtitle: Rich::from(names.collect::<Vec<_>>().join(" · ").replace('$', "")),
        footer: Rich::from(concat!("impactid ", env!("CARGO_PKG_VERSION"))),
        front: front(&content.comparison, locale),
        sections: sections(content, &drawn),
        words: layout_phrases::words(locale),
    }
    .with_numbers()
}

fn front(comparison: &Comparison, locale: Locale<'_>) -> Front {
    Front {
        synthetic: comparison.campaigns.iter().any(|c| c.synthetic),
        verdict: match comparison.outcome() {
            ComparisonOutcome::Changed { .. } | ComparisonOutcome::ChangedTogether => "weak",
            ComparisonOutcome::NothingChanged => "identified",
            ComparisonOutcome::Undetermined => "not_identifiable",
        },
        headline: Rich::from(locale.message(&comparison.outcome())),
        summary: Rich::from(summary(comparison, locale)),
        findings: comparison
            .remarks
            .iter()
            .map(|r| Rich::from(locale.sentence(r)))
            .collect(),
        answers: answers(comparison, locale),
        specimens: None,
        agree: "unknown",
        agreement: Rich::default(),
        facts: Vec::new(),
        map: None,
        estimates: None,
    }
}

fn summary(comparison: &Comparison, locale: Locale<'_>) -> String {
    let corrected = comparison.p_value().map(|p| {
        let count = comparison.differences.len().to_string();
        let p = p_equals(p, locale);
        locale.translate_with(Phrase::NoChange, &[("count", &count), ("p", &p)])
    });
    let together = comparison.unchanged.as_ref();
    let sentences = [corrected, together.map(|test| all_together(test, locale))];
    sentences
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(" ")
}

fn all_together(test: &EqualityTest, locale: Locale<'_>) -> String {
    let count = test.differences.to_string();
    let statistic = statistic(test, locale);
    let p = p_equals(test.p_value, locale);
    let values = [("count", &*count), ("statistic", &*statistic), ("p", &*p)];
    locale.translate_with(Phrase::TestOfNoChange, &values)
}

/// The differences of the last campaign from the first.
fn answers(comparison: &Comparison, locale: Locale<'_>) -> Vec<Answer> {
    let last = comparison.campaigns.len() - 1;
    let of = |parameter| {
        let mut all = comparison.differences.iter();
        all.find(|d| d.campaign == last && d.parameter == parameter)
    };
    PARAMETERS
        .iter()
        .map(|look| answer(look, of(look.parameter), locale))
        .collect()
}

fn answer(
    look: &parameters::ParameterLook,
    difference: Option<&Difference>,
    locale: Locale<'_>,
) -> Answer {
    let half = difference.map(|d| 0.5 * (d.interval95[1] - d.interval95[0]) * look.factor);
    let decimals = parameters::decimals_for(half.unwrap_or(0.0));
    let print = |v: f64| locale.fixed(v * look.factor, decimals);
    let ends = difference.map(|d| d.interval95);
    Answer {
        symbol: Rich::from(format!("Δ{}", look.symbol)),
        name: Rich::from(locale.translate(look.name)),
        value: difference.map(|d| print(d.value)),
        plus_minus: half.map(|h| locale.fixed(h, decimals)),
        unit: look.unit.into(),
        interval: ends.map(|[low, high]| locale.range(&print(low), &print(high))),
        status: difference.map_or("not_asked", |_| "identified"),
        note: None,
    }
}

fn sections(content: &CampaignsContent, drawn: &Drawn<'_>) -> Vec<Section> {
    let (comparison, locale) = (&content.comparison, drawn.locale);
    let list = |blocks: Vec<Option<Block>>| blocks.into_iter().flatten().collect::<Vec<_>>();
    let caption = locale.translate(Phrase::CaptionTrend);
    let of = |phrase, blocks| section(locale.translate(phrase), false, blocks);
    let estimates = list(vec![
        tables::campaigns(comparison, locale).map(|t| t.block("campaigns")),
        drawn.figures_block(&[("trend", &caption)]),
    ]);
    let differences = tables::differences(comparison, locale).map(|t| t.block("differences"));
    let common = list(vec![
        Some(paragraph(locale.translate(Phrase::HowDifferencesAreFound))),
        tables::shared(comparison, locale).map(|t| t.block("shared")),
        tables::separate(comparison, locale).map(|t| t.block("separate")),
        Some(paragraph(locale.translate(Phrase::CommandAgain))),
        Some(Block::Verbatim {
            text: content.command_line.clone(),
            columns: 1,
        }),
    ]);
    [
        of(Phrase::CampaignsCompared, estimates),
        of(Phrase::DifferencesFromTheFirst, list(vec![differences])),
        of(Phrase::ErrorsInCommon, common),
    ]
    .into_iter()
    .flatten()
    .collect()
}
