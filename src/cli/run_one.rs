//! One campaign from campaign.toml to the report, for the commands that end in one.

use std::path::Path;

use super::details::{print_fits, print_records};
use super::failure::wrapped;
use super::left_out::print_left_out;
use super::load::load_campaign;
use super::premises::print_premises;
use super::progress::{LATER, Progress};
use super::report_args::{ReportArgs, print_report_paths, quoted};
use super::speech::Speech;
use super::{Failure, Verbosity, out_folder};
use impact_campaign::pipeline::{self, Completed, Destination, PipelineError, checkpoint};
use impact_fit::{Finding, VerdictKind};
use impact_identification::identify::Identification;

/// From how many records on checkpoints are written; `IMPACTID_KEEP_FROM` sets another number, for
/// trials with small campaigns.
pub(super) fn keep_from() -> usize {
    let set = std::env::var("IMPACTID_KEEP_FROM").ok();
    set.and_then(|n| n.parse().ok())
        .unwrap_or(checkpoint::FEWEST)
}

/// How a campaign is run.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunOptions<'a> {
    /// Whether an interrupted run is resumed.
    pub(super) resume: bool,
    /// The report.
    pub(super) report: &'a ReportArgs,
}

impl RunOptions<'_> {
    /// Run one campaign into a folder and print what came of it.
    ///
    /// # Errors
    /// [`Failure`] where the campaign cannot be used or an output cannot be written.
    pub(super) fn run(
        self,
        campaign: &Path,
        out: &Path,
        verbosity: Verbosity,
    ) -> Result<Completed, Failure> {
        let mut resolved = load_campaign(campaign, verbosity)?;
        self.report.apply(&mut resolved.report, verbosity)?;
        let _lock = out_folder::take_for(out, &resolved)?;
        let records = resolved.records.len() as u64;
        let bar = Progress::new(verbosity, "observe", records).with_later(LATER);
        let destination = Destination {
            out,
            resume: self.resume,
            keep_from: keep_from(),
            command_line: &command_line(campaign, out, self.report),
            also: None,
            fits: bar.fits(),
        };
        let done = pipeline::run(&resolved, &destination, &|s, d, t| bar.step(s, d, t));
        drop(bar);
        let speech = Speech::of(&resolved.report)?;
        if let Err(PipelineError::AnswerUnwritten { answer, .. }) = &done {
            print_verdict(answer, &speech, verbosity);
        }
        let done = done?;
        print_premises(&resolved, &done.observations, &speech, verbosity);
        print_completed(&done, &speech, verbosity);
        print_report_paths(&resolved, out, &done.beside, &speech, verbosity);
        Ok(done)
    }
}

/// The command that a report names: one that gives the same results.
pub(super) fn command_line(campaign: &Path, out: &Path, report: &ReportArgs) -> String {
    format!(
        "impactid run {} --out {}{}",
        quoted(campaign),
        quoted(out),
        report.typed()
    )
}

/// Print the answer of a run, and with `-v` what led to it.
pub(super) fn print_completed(done: &Completed, speech: &Speech, verbosity: Verbosity) {
    print_records(&done.observations, verbosity);
    print_fits(&done.identification, verbosity);
    print_left_out(&done.observations, speech, verbosity);
    print_verdict(&done.identification, speech, verbosity);
}

/// Print the verdict and its findings.
pub(super) fn print_verdict(
    identification: &Identification,
    speech: &Speech,
    verbosity: Verbosity,
) {
    let verdict = &identification.verdict;
    let say = |text: &str| verbosity.info(&wrapped(text));
    say(&speech.say_all(&verdict.sentences));
    for finding in &verdict.findings {
        say(&format!("  - {}", speech.say(finding)));
        if let Some(first) = first_of_specimen(finding, identification) {
            say(&format!("      {}", speech.say(first)));
        }
    }
}

/// What was found first of a specimen that the model does not fit, where a finding is the verdict on it.
fn first_of_specimen<'a>(finding: &Finding, found: &'a Identification) -> Option<&'a Finding> {
    let Finding::Specimen { specimen, .. } = finding else {
        return None;
    };
    let verdict = &found.specimens.get(specimen)?.verdict;
    let fits = verdict.kind != VerdictKind::DoesNotFit;
    verdict.findings.first().filter(|_| !fits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_identification::replay::fixture;

    #[test]
    fn a_specimen_that_does_not_fit_shows_its_first_finding() {
        let mut found = fixture::decays().identification.clone();
        let (name, result) = found.specimens.iter_mut().next().expect("specimens");
        let (name, kept) = (name.clone(), result.verdict.kind);
        let finding = Finding::Specimen {
            specimen: name.clone(),
            verdict: Vec::new(),
        };
        let first = Finding::PrintedDampingFits { printed: 0.07 };
        result.verdict.findings = vec![first.clone()];
        assert_ne!(kept, VerdictKind::DoesNotFit);
        assert_eq!(first_of_specimen(&finding, &found), None);
        let result = found.specimens.get_mut(&name).expect("the specimen");
        result.verdict.kind = VerdictKind::DoesNotFit;
        assert_eq!(first_of_specimen(&finding, &found), Some(&first));
        assert_eq!(first_of_specimen(&first, &found), None);
    }
}
