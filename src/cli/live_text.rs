//! What `impactid watch` shows: the map of the motions, the answer so far, news of files.

use std::collections::BTreeMap;
use std::path::Path;

use super::estimate_text::with_error;
use super::speech::Speech;
use impact_campaign::pipeline::watch::{Live, NewsKind, Outline, Watcher};
use impact_fit::parameters::Coordinate;
use impact_identification::identify::Identification;
use impact_identification::identify::plan::Proposal;
use impact_identification::identify::uncertainty::budget::UncertaintySource;
use impact_records::message::{Print, Value};
use impact_records::message_table;
use impact_records::motion::{Bracket, Motion, Observation};
use impact_records::record::Sweep;
use impact_records::signal::{robust, whole};
use impact_report::budget_source;

/// What is said of a watched campaign.
#[derive(Debug, Clone, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum LiveText {
    /// How to end.
    Ends,
    /// A fit is made.
    Fitting,
    /// Where the page is.
    Page(String),
    /// The first of several names, and how many more there are.
    AndMore(String, usize),
    /// A file is gone.
    OneRemoved(String),
    /// Files are gone.
    SomeRemoved(String),
    /// A file is no longer named.
    OneUnlisted(String),
    /// Files are no longer named.
    SomeUnlisted(String),
    /// A file is rewritten.
    OneReplaced(String),
    /// Files are rewritten.
    SomeReplaced(String),
    /// A file is not whole.
    OneHalfWritten(String),
    /// Files are not whole.
    SomeHalfWritten(String),
    /// What the letters of the map mean.
    Key,
    /// There is no bracket.
    NoBracket,
    /// There is one.
    OneBracket(usize, NewestBracket),
    /// How many there are, and the newest of them.
    SomeBrackets(usize, NewestBracket),
    /// R is not determined.
    RestitutionOpen,
    /// R with its interval.
    Restitution(String),
    /// R and f0 with their intervals.
    RestitutionAndFrequency(String, String),
    /// The source of most of R's uncertainty, and its share of the variance.
    MostUncertain(String, f64),
    /// What to measure next.
    Next(NextRecord),
    /// One record.
    OneRecord,
    /// Several records, or none.
    SomeRecords(usize),
    /// How many of them are left out.
    LeftOut(usize),
    /// There is no fit.
    NoFit,
    /// Of how many records the fit is.
    FitOf(usize),
    /// How many files are not whole yet.
    Waiting(usize),
}

message_table! { "live": LiveText;
    Self::Page(path) => path = Value::Name(path);
    Self::AndMore(names, more) => names = Value::Name(names), count = Value::Count(*more);
    Self::OneRemoved(names) | Self::SomeRemoved(names) | Self::OneUnlisted(names) | Self::SomeUnlisted(names)
    | Self::OneReplaced(names) | Self::SomeReplaced(names) | Self::OneHalfWritten(names)
    | Self::SomeHalfWritten(names) => names = Value::Name(names);
    Self::OneBracket(count, newest) | Self::SomeBrackets(count, newest) =>
        count = Value::Count(*count),
        kind = Value::Name(newest.kind),
        motion = Value::Name(&newest.motion),
        clearance = Value::Number(newest.clearance_mm, 3),
        low = Value::Number(newest.low_hz, 3),
        high = Value::Number(newest.high_hz, 3),
        sweep = Value::Message(&newest.sweep);
    Self::Restitution(restitution) => restitution = Value::Name(restitution);
    Self::RestitutionAndFrequency(restitution, frequency) =>
        restitution = Value::Name(restitution),
        frequency = Value::Name(frequency);
    Self::MostUncertain(source, share) => source = Value::Name(source), share = Value::Percent(*share, 0);
    Self::Next(next) =>
        frequency = Value::Number(next.frequency_hz, 3),
        clearance = Value::Number(next.clearance_mm, 3),
        motion = Value::Name(&next.motion),
        error = Value::Digits(format!("{:.1e}", next.error));
    Self::SomeRecords(count) | Self::LeftOut(count) | Self::FitOf(count) | Self::Waiting(count) =>
        count = Value::Count(*count);
}

/// The newest bracket as a line has it.
#[derive(Debug, Clone, Default)]
pub(super) struct NewestBracket {
    kind: &'static str,
    motion: String,
    clearance_mm: f64,
    low_hz: f64,
    high_hz: f64,
    sweep: Sweep,
}

impl NewestBracket {
    fn of(bracket: &Bracket) -> Self {
        Self {
            kind: bracket.kind.name(),
            motion: bracket.from.clone(),
            clearance_mm: 1e3 * bracket.clearance_m,
            low_hz: bracket.frequency_low_hz,
            high_hz: bracket.frequency_high_hz,
            sweep: bracket.sweep,
        }
    }
}

/// What to measure next, as a line has it.
#[derive(Debug, Clone, Default)]
pub(super) struct NextRecord {
    frequency_hz: f64,
    clearance_mm: f64,
    motion: String,
    error: f64,
}

impl NextRecord {
    fn of(next: &Proposal) -> Self {
        Self {
            frequency_hz: next.frequency_hz,
            clearance_mm: 1e3 * next.clearance_m,
            motion: Motion::periodic(1, next.periods_n).label(),
            error: next.restitution_error_after,
        }
    }
}

/// Most files that are named in one line.
const MOST_NAMES: usize = 4;

/// A line on files to which the same happened.
pub(super) fn news(what: NewsKind, files: &[(&Path, Option<&str>)], words: &dyn Print) -> String {
    let named = files
        .iter()
        .take(MOST_NAMES)
        .map(|(path, reason)| match reason {
            Some(reason) => format!("{} ({reason})", path.display()),
            None => path.display().to_string(),
        });
    let mut names = named.collect::<Vec<_>>().join(", ");
    if files.len() > MOST_NAMES {
        names = words.print(&LiveText::AndMore(names, files.len() - MOST_NAMES));
    }
    let text = match (what, files.len()) {
        (NewsKind::Removed, 1) => LiveText::OneRemoved,
        (NewsKind::Removed, _) => LiveText::SomeRemoved,
        (NewsKind::Unlisted, 1) => LiveText::OneUnlisted,
        (NewsKind::Unlisted, _) => LiveText::SomeUnlisted,
        (NewsKind::Replaced, 1) => LiveText::OneReplaced,
        (NewsKind::Replaced, _) => LiveText::SomeReplaced,
        (NewsKind::HalfWritten, 1) => LiveText::OneHalfWritten,
        (NewsKind::HalfWritten, _) => LiveText::SomeHalfWritten,
    };
    words.print(&text(names))
}

/// Everything that is drawn again.
pub(super) fn status(watcher: &Watcher, outline: &Outline, speech: &Speech) -> String {
    let words = speech.words();
    let words = words.as_ref();
    let mut text = map(outline, words);
    text += &newest_bracket(&outline.brackets, words);
    if let Some(live) = watcher.last() {
        text += &answer(&live.found.identification, speech);
        text += &next(live.next.as_ref(), words);
    }
    text += &counts(outline, watcher.last(), watcher.waiting(), words);
    text
}

/// Columns of the map.
const COLUMNS: usize = 64;
/// Most rows of the map.
const MOST_ROWS: usize = 12;

/// The motions over drive frequency and clearance, a row for each clearance, with the brackets.
fn map(outline: &Outline, words: &dyn Print) -> String {
    let places: Vec<(f64, f64, &Observation)> = outline
        .records
        .iter()
        .filter(|o| !o.excluded())
        .filter_map(|o| Some((o.frequency_hz()?, o.setting.clearance_m?, o)))
        .collect();
    let Some((low, high)) = robust::range(places.iter().map(|p| p.0)) else {
        return String::new();
    };
    let column = |frequency_hz: f64| {
        let share = (frequency_hz - low) / (high - low).max(1e-9);
        (0..COLUMNS)
            .rfind(|i| *i as f64 <= share * (COLUMNS - 1) as f64 + 0.5)
            .unwrap_or(0)
    };
    let mut rows: BTreeMap<i32, [char; COLUMNS]> = BTreeMap::new();
    let step = row_step(&places);
    for (frequency_hz, clearance_m, o) in &places {
        let row = rows
            .entry(row(*clearance_m, step))
            .or_insert([' '; COLUMNS]);
        row[column(*frequency_hz)] = letter(&o.classification.motion);
    }
    for bracket in &outline.brackets {
        if let Some(row) = rows.get_mut(&row(bracket.clearance_m, step)) {
            let (from, to) = (
                column(bracket.frequency_low_hz),
                column(bracket.frequency_high_hz),
            );
            // a bracket closes when nothing is left between its records
            row[(from + to) / 2] = if to - from > 2 { '┊' } else { '│' };
        }
    }
    let mut text = String::new();
    for (place, row) in rows.iter().rev() {
        let row: String = row.iter().collect();
        let clearance = words.number(format!("{:.3}", f64::from(*place) * step * 1e3));
        text += &format!("{clearance:>8} mm {}\n", row.trim_end());
    }
    let [low, high] = [low, high].map(|hz| words.number(format!("{hz:.2}")));
    let w = COLUMNS - 10;
    text += &format!("{:>11} {low} Hz{high:>w$} Hz\n", "");
    text + &words.print(&LiveText::Key) + "\n"
}

/// Step of the rows: 1 µm, or coarser where that gives more rows than fit.
fn row_step(places: &[(f64, f64, &Observation)]) -> f64 {
    let mut step = 1e-6;
    loop {
        let mut rows: Vec<i32> = places.iter().map(|p| row(p.1, step)).collect();
        rows.sort_unstable();
        rows.dedup();
        if rows.len() <= MOST_ROWS {
            return step;
        }
        step *= 2.0;
    }
}

fn row(clearance_m: f64, step: f64) -> i32 {
    whole::integer((clearance_m / step).round())
}

/// A motion in one letter.
fn letter(motion: &Motion) -> char {
    match motion {
        Motion::Impactless => '0',
        Motion::Periodic {
            impacts_p: 1,
            periods_n,
            ..
        } => char::from_digit(*periods_n, 10).unwrap_or('+'),
        Motion::Periodic { .. } => '+',
        Motion::Beat => '~',
        Motion::Chaotic => '#',
        Motion::Sticking => 'j',
        Motion::Undetermined { .. } => '?',
    }
}

fn newest_bracket(brackets: &[Bracket], words: &dyn Print) -> String {
    let text = match brackets {
        [] => LiveText::NoBracket,
        [one] => LiveText::OneBracket(1, NewestBracket::of(one)),
        [.., newest] => LiveText::SomeBrackets(brackets.len(), NewestBracket::of(newest)),
    };
    words.print(&text) + "\n"
}

/// R and f0 with their intervals, and the greatest item of R's budget.
fn answer(found: &Identification, speech: &Speech) -> String {
    let words = speech.words();
    let words = words.as_ref();
    let joint = &found.joint.parameters;
    let Some(restitution) = &joint.restitution else {
        return words.print(&LiveText::RestitutionOpen) + "\n";
    };
    let restitution = with_error(restitution, words);
    let mut text = words.print(&match &joint.natural_frequency_hz {
        Some(f0) => LiveText::RestitutionAndFrequency(restitution, with_error(f0, words)),
        None => LiveText::Restitution(restitution),
    });
    text += "\n";
    if let Some((source, share)) = greatest_item(found) {
        let source = budget_source(source, speech.locale());
        text += &words.print(&LiveText::MostUncertain(source, share));
        text += "\n";
    }
    text
}

/// The source that contributes most to the variance of R, with its share.
fn greatest_item(found: &Identification) -> Option<(UncertaintySource, f64)> {
    let budget = &found.uncertainty.budget;
    let whole = budget.combined.iter();
    let whole = whole
        .clone()
        .find(|c| c.parameter == Coordinate::Restitution)?;
    let of_restitution = budget.rows.iter().filter_map(|row| {
        let mut all = row.contributions.iter();
        let own = all.find(|c| c.parameter == Coordinate::Restitution)?;
        Some((row.source, own.uncertainty))
    });
    let (source, greatest) = of_restitution.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let share = (greatest / whole.standard_uncertainty).powi(2);
    Some((source, share))
}

fn next(proposal: Option<&Proposal>, words: &dyn Print) -> String {
    proposal.map_or(String::new(), |next| {
        words.print(&LiveText::Next(NextRecord::of(next))) + "\n"
    })
}

fn counts(outline: &Outline, last: Option<&Live>, waiting: usize, words: &dyn Print) -> String {
    let taken = match outline.records.len() {
        1 => LiveText::OneRecord,
        count => LiveText::SomeRecords(count),
    };
    let out = outline.records.iter().filter(|o| o.excluded()).count();
    let fit = match last.map_or(0, |live| live.observed.observations.len()) {
        0 => LiveText::NoFit,
        count => LiveText::FitOf(count),
    };
    let out = (out > 0).then_some(LiveText::LeftOut(out));
    let waiting = (waiting > 0).then_some(LiveText::Waiting(waiting));
    let all = [Some(taken), out, Some(fit), waiting].into_iter().flatten();
    let text: String = all.map(|part| words.print(&part)).collect();
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::language::Language;
    use impact_records::message::{Typed, boxed, faults};
    use impact_records::motion::brackets;

    fn observed(sequence: usize, frequency_hz: f64, motion: Motion) -> Observation {
        let mut o = Observation::of("r", frequency_hz, motion);
        o.setting.sequence = sequence;
        o.setting.sweep = Sweep::Up;
        o.setting.clearance_m = Some(if sequence < 4 { 1e-3 } else { 2e-3 });
        o
    }

    #[test]
    fn the_map_has_a_row_for_each_clearance_and_shows_how_brackets_close() {
        let one = || Motion::periodic(1, 1);
        let mut records = vec![
            observed(0, 10.0, Motion::Impactless),
            observed(1, 12.0, one()),
            observed(3, 14.0, Motion::periodic(2, 2)),
            observed(4, 10.0, Motion::Chaotic),
        ];
        let drawn = |records: &[Observation]| {
            let outline = Outline {
                brackets: brackets(records),
                records: records.to_vec(),
            };
            map(&outline, &Typed)
        };
        let open = drawn(&records);
        let lines: Vec<&str> = open.lines().collect();
        assert!(lines[0].starts_with("   2.000 mm #"), "{open}");
        assert!(lines[1].starts_with("   1.000 mm 0"), "{open}");
        assert!(lines[1].ends_with('+') && lines[1].matches('┊').count() == 2);
        assert!(lines[2].contains("10.00 Hz") && lines[2].ends_with("14.00 Hz"));
        records.insert(2, observed(2, 13.97, one()));
        let closed = drawn(&records);
        let row = closed.lines().nth(1).unwrap();
        assert_eq!((row.matches('┊').count(), row.matches('│').count()), (1, 1));
        assert!(
            closed.lines().all(|line| line.chars().count() < 80),
            "{closed}"
        );
        assert_eq!(drawn(&[]), "");
    }

    #[test]
    fn everything_that_is_said_has_its_texts_and_the_key_fits_into_a_line() {
        let all = boxed(<LiveText as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
        for language in Language::all() {
            let key = language.text("live", "key");
            assert!(key.chars().count() < 80, "{key}");
        }
    }

    #[test]
    fn a_bracket_is_said_in_the_language_of_the_report() {
        let records = [
            observed(0, 10.0, Motion::Impactless),
            observed(1, 12.5, Motion::periodic(1, 1)),
        ];
        let german = Speech::in_language(Language::of_code("de").unwrap());
        let said = |speech: &Speech| newest_bracket(&brackets(&records), speech.words().as_ref());
        assert_eq!(
            said(&Speech::default()),
            "1 bracket; newest: grazing of z = 0, 1.000 mm, 10.000 to 12.500 Hz, up\n"
        );
        assert_eq!(
            said(&german),
            "1 Schranke; neueste: grazing von z = 0, 1,000 mm, 10,000 bis 12,500 Hz, aufwärts\n"
        );
    }

    #[test]
    fn news_name_a_few_files_and_count_the_others() {
        let path = Path::new("r1.csv");
        let all = vec![(path, None); 6];
        assert_eq!(
            news(NewsKind::Removed, &all[..1], &Typed),
            "r1.csv is gone: its records are left out."
        );
        let many = news(NewsKind::Replaced, &all, &Typed);
        assert!(many.contains("r1.csv and 2 more are rewritten"), "{many}");
        let torn = news(
            NewsKind::HalfWritten,
            &[(path, Some("no signature"))],
            &Typed,
        );
        assert!(
            torn.starts_with("r1.csv (no signature) is not whole after an hour"),
            "{torn}"
        );
    }
}
