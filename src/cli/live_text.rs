//! What `impactid watch` shows: the map of the motions, the answer so far, news of files.

use std::collections::BTreeMap;
use std::path::Path;

use super::estimate_text::with_error;
use impact_campaign::pipeline::watch::{Live, NewsKind, Outline, Watcher};
use impact_fit::parameters::Coordinate;
use impact_identification::identify::Identification;
use impact_identification::identify::plan::Proposal;
use impact_records::message::counted;
use impact_records::motion::{Bracket, Motion, Observation};
use impact_records::signal::{robust, whole};
use impact_report::budget_source;

/// Most files that are named in one line.
const MOST_NAMES: usize = 4;

/// A line on files to which the same happened.
pub(super) fn news(what: NewsKind, files: &[(&Path, Option<&str>)]) -> String {
    let named = files
        .iter()
        .take(MOST_NAMES)
        .map(|(path, reason)| match reason {
            Some(reason) => format!("{} ({reason})", path.display()),
            None => path.display().to_string(),
        });
    let mut names = named.collect::<Vec<_>>().join(", ");
    if files.len() > MOST_NAMES {
        names += &format!(" and {} more", files.len() - MOST_NAMES);
    }
    let one = files.len() == 1;
    let (is, its) = if one { ("is", "its") } else { ("are", "their") };
    match what {
        NewsKind::Removed => format!("{names} {is} gone: {its} records are left out."),
        NewsKind::Unlisted => {
            format!("{names} {is} no longer named by the campaign: {its} records are left out.")
        }
        NewsKind::Replaced => {
            format!("{names} {is} rewritten: {its} records are observed again.")
        }
        NewsKind::HalfWritten => format!(
            "{names} {is} not whole after an hour, and not used: finish or remove {}.",
            if one { "it" } else { "them" }
        ),
    }
}

/// Everything that is drawn again.
pub(super) fn status(watcher: &Watcher, outline: &Outline) -> String {
    let mut text = map(outline);
    text += &newest_bracket(&outline.brackets);
    if let Some(live) = watcher.last() {
        text += &answer(&live.found.identification);
        text += &next(live.next.as_ref());
    }
    text += &counts(outline, watcher.last(), watcher.waiting());
    text
}

/// Columns of the map.
const COLUMNS: usize = 64;
/// Most rows of the map.
const MOST_ROWS: usize = 12;

/// The motions over drive frequency and clearance, a row for each clearance, with the brackets.
fn map(outline: &Outline) -> String {
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
        text += &format!(
            "{:>8.3} mm {}\n",
            f64::from(*place) * step * 1e3,
            row.trim_end()
        );
    }
    text += &format!(
        "{:>11} {low:<.2} Hz{:>w$.2} Hz\n",
        "",
        high,
        w = COLUMNS - 10
    );
    text += "0 none  1 2 3 z = 1/n  + other  ~ beat  # chaos  j joined  ? unclear  │ bracket\n";
    text
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

fn newest_bracket(brackets: &[Bracket]) -> String {
    let Some(newest) = brackets.last() else {
        return "no bracket yet\n".to_owned();
    };
    format!(
        "{}; newest: {} of z = {}, {:.3} mm, {:.3} to {:.3} Hz, {}\n",
        counted(brackets.len(), "bracket"),
        newest.kind.name(),
        newest.from,
        1e3 * newest.clearance_m,
        newest.frequency_low_hz,
        newest.frequency_high_hz,
        newest.sweep.name()
    )
}

/// R and f0 with their intervals, and the greatest item of R's budget.
fn answer(found: &Identification) -> String {
    let joint = &found.joint.parameters;
    let Some(restitution) = &joint.restitution else {
        return "R is not determined yet\n".to_owned();
    };
    let mut text = format!("R = {}", with_error(restitution));
    if let Some(frequency) = &joint.natural_frequency_hz {
        text += &format!(", f0 = {} Hz", with_error(frequency));
    }
    text += " (95 %)\n";
    if let Some((source, share)) = greatest_item(found) {
        let percent = 1e2 * share;
        text += &format!("most of R's uncertainty: {source} ({percent:.0} % of the variance)\n");
    }
    text
}

/// The source that contributes most to the variance of R, with its share.
fn greatest_item(found: &Identification) -> Option<(String, f64)> {
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
    Some((budget_source(source), share))
}

fn next(proposal: Option<&Proposal>) -> String {
    let Some(next) = proposal else {
        return String::new();
    };
    format!(
        "measure next: {:.3} Hz, {:.3} mm (z = {}): standard error of R then {:.1e}\n",
        next.frequency_hz,
        1e3 * next.clearance_m,
        Motion::periodic(1, next.periods_n).label(),
        next.restitution_error_after
    )
}

fn counts(outline: &Outline, last: Option<&Live>, waiting: usize) -> String {
    let taken = outline.records.len();
    let out = outline.records.iter().filter(|o| o.excluded()).count();
    let fitted = last.map_or(0, |live| live.observed.observations.len());
    let mut text = counted(taken, "record");
    if out > 0 {
        text += &format!(", {out} left out");
    }
    text += &match fitted {
        0 => "; no fit yet".to_owned(),
        fitted => format!("; the fit is of {fitted}"),
    };
    if waiting > 0 {
        text += &format!("; files that are not whole yet: {waiting}");
    }
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::brackets;
    use impact_records::record::Sweep;

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
            map(&Outline {
                brackets: brackets(records),
                records: records.to_vec(),
            })
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
    fn news_name_a_few_files_and_count_the_others() {
        let path = Path::new("r1.csv");
        let all = vec![(path, None); 6];
        assert_eq!(
            news(NewsKind::Removed, &all[..1]),
            "r1.csv is gone: its records are left out."
        );
        let many = news(NewsKind::Replaced, &all);
        assert!(many.contains("r1.csv and 2 more are rewritten"), "{many}");
        let torn = news(NewsKind::HalfWritten, &[(path, Some("no signature"))]);
        assert!(
            torn.starts_with("r1.csv (no signature) is not whole after an hour"),
            "{torn}"
        );
    }
}
