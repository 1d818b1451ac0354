//! `impactid watch`: the answer grows while records arrive.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::Args;
use strum::VariantArray;

use super::live_text::{self, LiveText};
use super::load::load_campaign;
use super::premises::print_premises;
use super::progress::Progress;
use super::report_args::{ReportArgs, print_report_paths};
use super::run_one::{command_line, keep_from, print_completed};
use super::screen::Screen;
use super::speech::Speech;
use super::{Exit, Failure, Verbosity, interrupt};
use impact_campaign::pipeline::watch::{
    News, NewsKind, Pace, Seen, WatchPatience, Watcher, write_live,
};
use impact_campaign::pipeline::{Completed, Destination, layout};
use impact_report::Format;
use labfiles_write::output::Lock;

/// Arguments of `impactid watch`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Watch {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Folder for the results; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    pace: PaceArgs,
    #[command(flatten)]
    options: ReportArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid watch campaign.toml --out results/
  impactid watch campaign.toml --out results/ --poll 10 --settle 60      a slow network drive

While records arrive: a file is taken once it has stopped growing and can be opened; its \
records are observed once. From time to time the parameters are fitted again, and report.html \
and identification.json are replaced; the page reloads itself. The terminal shows the map of \
the motions with the brackets that have closed, R with what its uncertainty is made of, and \
the setting to measure next. New lines of the run table and changes of campaign.toml are \
picked up. A file that was taken and is removed or replaced is named, and one that is not \
whole after an hour.
Fits are so rare that all of it takes at most three times the processor time of one run; a fit \
whose records were removed or rewritten is made again in any case.
Ctrl-C ends it with all files as `impactid run` with the same options would leave them, and \
report.html. A second Ctrl-C ends it at once.
Exit codes: those of `impactid run`.";

/// How patiently files are waited for.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct PaceArgs {
    /// Seconds between two looks at the files [default: 2]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    poll: Option<Duration>,
    /// Seconds for which a file must not have changed to count as whole [default: 5]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    settle: Option<Duration>,
}

/// Time between two looks at the files.
const POLL: Duration = Duration::from_secs(2);
/// Time for which a file must not have changed.
const SETTLE: Duration = Duration::from_secs(5);

/// A pause of so many times `--settle` is a good time for a fit.
const PAUSE: u32 = 4;

fn seconds(text: &str) -> Result<Duration, String> {
    let value: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if (0.05..=86_400.0).contains(&value) {
        Ok(Duration::from_secs_f64(value))
    } else {
        Err("it must lie between 0.05 and 86400 seconds".to_owned())
    }
}

impl PaceArgs {
    /// For the library.
    pub(super) fn pace(self) -> Pace {
        let settle = self.settle.unwrap_or(SETTLE);
        Pace {
            patience: WatchPatience {
                quiet: settle,
                ..WatchPatience::default()
            },
            idle: PAUSE * settle,
        }
    }

    /// Whether either was given.
    pub(super) fn is_given(self) -> bool {
        self.poll.is_some() || self.settle.is_some()
    }

    /// Wait until the next look, or until the end is asked for.
    pub(super) fn wait(self, stop: &AtomicBool) {
        let (begin, poll) = (Instant::now(), self.poll.unwrap_or(POLL));
        while begin.elapsed() < poll && !stop.load(Ordering::SeqCst) {
            let left = poll.saturating_sub(begin.elapsed());
            std::thread::sleep(left.min(Duration::from_millis(50)));
        }
    }
}

impl Watch {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut watcher = Watcher::new(&self.campaign, self.pace.pace())?;
        layout::check(&self.out)?;
        let stop = interrupt::asked(self.out.clone());
        let _lock = Lock::take(&self.out)?;
        let mut screen = Screen::new(verbosity);
        let mut speech = self.speech(&watcher);
        screen.say(&speech.words().print(&LiveText::Ends));
        let begin = Instant::now();
        let mut brackets = 0;
        while !stop.load(Ordering::SeqCst) {
            let seen = watcher.look(begin.elapsed());
            speech = self.speech(&watcher);
            tell(&seen, &speech, &mut screen);
            if seen.changed {
                let outline = watcher.outline();
                let has_closed = outline.brackets.len() > brackets;
                brackets = outline.brackets.len();
                screen.draw(&live_text::status(&watcher, &outline, &speech), has_closed);
            }
            if watcher.is_due(begin.elapsed()) {
                screen.busy(&speech.words().print(&LiveText::Fitting));
                self.fit(&mut watcher, &mut screen);
                let status = live_text::status(&watcher, &watcher.outline(), &speech);
                screen.draw(&status, true);
            }
            self.pace.wait(&stop);
        }
        screen.leave();
        let done = self.complete(&mut watcher, verbosity)?;
        Ok(Exit::of(done.identification.verdict.kind))
    }

    /// The language of the report; before the campaign is read, that which is asked for.
    fn speech(&self, watcher: &Watcher) -> Speech {
        let Some(report) = watcher.report() else {
            return self
                .options
                .language()
                .map(Speech::in_language)
                .unwrap_or_default();
        };
        let mut report = report.clone();
        let applied = self.options.apply(&mut report, Verbosity::Quiet);
        let speech = applied.and_then(|()| Speech::of(&report));
        speech.unwrap_or_default()
    }

    /// Fit, and replace the page and identification.json; what fails is reported, and the watch goes on.
    fn fit(&self, watcher: &mut Watcher, screen: &mut Screen) {
        let command = command_line(&self.campaign, &self.out, &self.options);
        let fitted = watcher.fit(
            |report| self.options.apply(report, Verbosity::Quiet),
            |live| Ok(write_live(live, &command, &self.out)?),
        );
        if let Err(failure) = fitted {
            screen.fail(&failure);
        }
    }

    /// Everything that a run would leave, from what is kept.
    fn complete(&self, watcher: &mut Watcher, verbosity: Verbosity) -> Result<Completed, Failure> {
        let mut campaign = load_campaign(&self.campaign, verbosity)?;
        self.options.apply(&mut campaign.report, verbosity)?;
        let bar = Progress::new(verbosity, "observe", campaign.records.len() as u64);
        let destination = Destination {
            out: &self.out,
            resume: false,
            keep_from: keep_from(),
            command_line: &command_line(&self.campaign, &self.out, &self.options),
            also: Some(Format::Html),
            fits: bar.fits(),
        };
        let done = watcher.complete(&campaign, &destination, &|s, d, t| bar.step(s, d, t))?;
        drop(bar);
        let speech = Speech::of(&campaign.report)?;
        print_premises(&campaign, &done.observations, &speech, verbosity);
        print_completed(&done, &speech, verbosity);
        print_report_paths(&campaign, &self.out, &done.beside, &speech, verbosity);
        let page = self.out.join("report.html").display().to_string();
        verbosity.info(&speech.words().print(&LiveText::Page(page)));
        Ok(done)
    }
}

/// Tell what a look brought.
pub(super) fn tell(seen: &Seen, speech: &Speech, screen: &mut Screen) {
    if !seen.faults.0.is_empty() {
        screen.problems(&seen.faults, speech);
    }
    for (name, paths) in grouped(&seen.news) {
        screen.say(&live_text::news(name, &paths, speech.words().as_ref()));
    }
}

/// News of the same kind together, each with its files and, where there is one, the reason.
fn grouped(news: &[News]) -> Vec<(NewsKind, Vec<(&Path, Option<&str>)>)> {
    let each = NewsKind::VARIANTS.iter().map(|kind| {
        let same = news.iter().filter(|n| NewsKind::from(*n) == *kind);
        (*kind, same.map(file_of).collect::<Vec<_>>())
    });
    each.filter(|(_, files)| !files.is_empty()).collect()
}

fn file_of(news: &News) -> (&Path, Option<&str>) {
    match news {
        News::Removed(path) | News::Unlisted(path) | News::Replaced(path) => (path, None),
        News::HalfWritten { path, reason } => (path, reason.as_deref()),
    }
}
