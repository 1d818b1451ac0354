//! A progress bar on a terminal, nothing in a pipe.

use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::Verbosity;
use impact_fit::solver::FitProgress;

/// The progress of the stages of a command; shared by threads.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    pace: Pace,
    verbosity: Verbosity,
    /// Iterations of the fits, shown beside the bar.
    fits: FitProgress,
    /// The stage that runs, and when it began.
    stage: Mutex<(&'static str, Instant)>,
}

impl Progress {
    /// A bar for `total` steps of a stage.
    pub(crate) fn new(verbosity: Verbosity, stage: &'static str, total: u64) -> Self {
        let (pace, fits) = (Pace::default(), FitProgress::default());
        let visible = !verbosity.is_quiet() && std::io::stderr().is_terminal();
        let bar = if visible {
            Self::bar(&pace, &fits, stage, total)
        } else {
            ProgressBar::hidden()
        };
        Self {
            bar,
            pace,
            verbosity,
            fits,
            stage: Mutex::new((stage, Instant::now())),
        }
    }

    fn bar(pace: &Pace, fits: &FitProgress, stage: &'static str, total: u64) -> ProgressBar {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            let pace = pace.clone();
            let left = move |state: &ProgressState, text: &mut dyn Write| {
                let left = pace.left(Instant::now(), state.pos(), state.len().unwrap_or(0));
                // a bar that cannot be drawn is no fault
                let _ = text.write_str(&words(left));
            };
            let fits = fits.clone();
            let iterations = move |_: &ProgressState, text: &mut dyn Write| {
                if fits.iterations() > 0 {
                    let _ = write!(text, "{} iterations", fits.iterations());
                }
            };
            let style = style.with_key("left", left);
            bar.set_style(style.with_key("iterations", iterations));
        }
        bar.set_message(stage);
        bar.enable_steady_tick(Duration::from_millis(250));
        bar
    }

    /// What counts the iterations of the fits; the bar shows their number.
    pub(crate) fn fits(&self) -> &FitProgress {
        &self.fits
    }

    /// Steps done so far and steps in all.
    pub(crate) fn set(&self, done: u64, total: u64) {
        self.pace.begin(Instant::now(), done);
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    /// The same bar for a run whose later stages count: the time left is that of all of them.
    #[must_use]
    pub(crate) fn with_later(self, later: Later) -> Self {
        self.pace.clock().later = Some(later);
        self
    }

    /// Steps done so far and steps in all of a stage, which begins where it is another than before.
    pub(crate) fn step(&self, stage: &'static str, done: u64, total: u64) {
        self.stage(stage);
        self.set(done, total);
    }

    /// Another stage begins; with `-v` the time of the one before is printed.
    fn stage(&self, stage: &'static str) {
        let now = Instant::now();
        let (ended, begin) = {
            let mut running = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
            if running.0 == stage {
                return;
            }
            std::mem::replace(&mut *running, (stage, now))
        };
        let total = self.bar.length().unwrap_or(0);
        self.pace.next(now, self.bar.position(), total);
        self.bar.set_message(stage);
        self.bar.suspend(|| self.print_time(ended, begin));
    }

    fn print_time(&self, stage: &'static str, begin: Instant) {
        let seconds = begin.elapsed().as_secs_f64();
        self.verbosity.detail(&format!("{stage}: {seconds:.2} s"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        let (running, begin) = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        self.print_time(running, begin);
    }
}

const TEMPLATE: &str = "{msg:12} {wide_bar} {pos}/{len}  {left} {iterations}";

/// What the stages after the first take, as measured: they grow with the steps of the first and
/// slow down with them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Later {
    /// Their time as a part of the first stage's.
    pub part: f64,
    /// A further part, constant from that many steps on.
    pub bounded: (f64, u64),
    /// What they take however few steps there are.
    pub fixed: Duration,
}

impl Later {
    /// Seconds after `total` steps that take `each` seconds.
    fn seconds(&self, each: f64, total: u64) -> f64 {
        let (bounded, most) = self.bounded;
        let steps = self.part * total as f64 + bounded * total.min(most) as f64;
        steps * each + self.fixed.as_secs_f64()
    }
}

/// Time of fitting, report and writing, measured on campaigns of 846 to 100,000 records
/// (docs/validation.md): of very long campaigns not all waveforms are fitted and not all rows printed.
pub(super) const LATER: Later = Later {
    part: 0.7,
    bounded: (2.9, 2_000),
    fixed: Duration::from_millis(600),
};

/// The clock of a bar, shared by threads.
#[derive(Debug, Clone, Default)]
struct Pace(Arc<Mutex<Clock>>);

#[derive(Debug, Default)]
struct Clock {
    /// When a stage's first step was done and how many steps that was: those of an earlier run do
    /// not count for the pace.
    first: Option<(Instant, u64)>,
    /// What comes after the first stage.
    later: Option<Later>,
    /// When the whole should be done, once the first stage is.
    due: Option<Instant>,
}

impl Pace {
    fn clock(&self) -> MutexGuard<'_, Clock> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn begin(&self, now: Instant, done: u64) {
        self.clock().first.get_or_insert((now, done));
    }

    /// The next stage begins; `done` of `total` steps of the one before are done.
    fn next(&self, now: Instant, done: u64, total: u64) {
        let mut clock = self.clock();
        if clock.due.is_none() {
            clock.due = clock
                .left(now, done, total)
                .filter(|_| clock.later.is_some())
                .and_then(|left| now.checked_add(left));
        }
        clock.first = None;
    }

    fn left(&self, now: Instant, done: u64, total: u64) -> Option<Duration> {
        self.clock().left(now, done, total)
    }
}

impl Clock {
    /// Time left at the mean pace so far. The mean over all steps is steadier than the last few:
    /// records of one kind of motion follow each other, and each kind has its own pace. `None` for
    /// a run that is late.
    fn left(&self, now: Instant, done: u64, total: u64) -> Option<Duration> {
        if let Some(due) = self.due {
            return due.checked_duration_since(now);
        }
        let (begin, first) = self.first?;
        let steps = done.checked_sub(first).filter(|s| *s > 0)?;
        let each = now.saturating_duration_since(begin).as_secs_f64() / steps as f64;
        let here = each * total.saturating_sub(done) as f64;
        let later = self.later.map_or(0.0, |later| later.seconds(each, total));
        Duration::try_from_secs_f64(here + later).ok()
    }
}

fn words(left: Option<Duration>) -> String {
    match left.map(|l| l.as_secs()) {
        None => String::new(),
        Some(s @ 0..60) => format!("{s} s left"),
        Some(s @ 60..3600) => format!("{} min {:02} s left", s / 60, s % 60),
        Some(s) => format!("{} h {:02} min left", s / 3600, s % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_the_steps_left_at_the_mean_pace() {
        let pace = Pace::default();
        let begin = Instant::now();
        assert_eq!(pace.left(begin, 0, 100), None);
        pace.begin(begin, 40);
        pace.begin(begin + Duration::from_secs(1), 41);
        let left = pace.left(begin + Duration::from_secs(20), 60, 100);
        assert_eq!(left, Some(Duration::from_secs(40)));
        pace.next(begin, 60, 100);
        assert_eq!(pace.left(begin, 60, 100), None);
    }

    #[test]
    fn after_a_tenth_the_time_left_of_a_run_is_right_within_a_fifth() {
        // Records, seconds of observing, seconds of all that follows: idle, on one thread, and under
        // a load (docs/validation.md).
        for (records, observing, following) in [
            (846, 0.27, 1.35),
            (4_000, 1.92, 4.93),
            (10_000, 4.39, 7.51),
            (100_000, 40.1, 28.5),
            (846, 0.52, 3.05),
            (4_000, 3.83, 8.73),
            (4_000, 7.51, 19.0),
        ] {
            let (pace, begin) = (Pace::default(), Instant::now());
            pace.clock().later = Some(LATER);
            let at = |seconds| begin + Duration::from_secs_f64(seconds);
            pace.begin(begin, 0);
            let seconds = |left: Option<Duration>| left.map_or(0.0, |l| l.as_secs_f64());
            let said = seconds(pace.left(at(observing / 10.0), records / 10, records));
            let really = 0.9 * observing + following;
            assert!(
                (said / really - 1.0).abs() < 0.2,
                "{records} records: {said} s for {really} s"
            );
            // Once all are observed, the time left runs down to nothing, which is not said.
            pace.next(at(observing), records, records);
            let then = seconds(pace.left(at(observing), 0, 1));
            let soon = seconds(pace.left(at(observing + 1.0), 0, 1));
            assert!((then - soon - 1.0).abs() < 1e-6, "{then} {soon}");
            pace.next(at(observing + 1.0), 0, 1);
            let soon = seconds(pace.left(at(observing + 1.5), 0, 1));
            assert!((then - soon - 1.5).abs() < 1e-6, "{then} {soon}");
            assert_eq!(pace.left(at(observing + then + 1.0), 0, 1), None);
        }
    }

    #[test]
    fn times_in_words() {
        let words = |s| words(Some(Duration::from_secs(s)));
        assert_eq!(words(7), "7 s left");
        assert_eq!(words(67), "1 min 07 s left");
        assert_eq!(words(7300), "2 h 01 min left");
    }
}
