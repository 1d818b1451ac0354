//! A progress bar on a terminal, nothing in a pipe.

use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::voice::Voice;

/// The progress of one stage; shared by threads.
#[derive(Debug, Clone)]
pub struct Progress {
    bar: ProgressBar,
    pace: Pace,
}

impl Progress {
    /// A bar for `total` steps of a stage named so.
    pub fn new(voice: Voice, stage: &'static str, total: u64) -> Self {
        let pace = Pace::default();
        if voice.is_quiet() || !std::io::stderr().is_terminal() {
            let bar = ProgressBar::hidden();
            return Self { bar, pace };
        }
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            let pace = pace.clone();
            let left = move |state: &ProgressState, text: &mut dyn Write| {
                let left = pace.left(Instant::now(), state.pos(), state.len().unwrap_or(0));
                // a bar that cannot be drawn is no fault
                let _ = text.write_str(&words(left));
            };
            bar.set_style(style.with_key("left", left));
        }
        bar.set_message(stage);
        bar.enable_steady_tick(Duration::from_millis(250));
        Self { bar, pace }
    }

    /// Steps done so far and steps in all.
    pub fn set(&self, done: u64, total: u64) {
        self.pace.begin(Instant::now(), done);
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    /// Another stage begins.
    pub fn stage(&self, stage: &'static str) {
        if self.bar.message() != stage {
            self.pace.forget();
            self.bar.set_message(stage);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

const TEMPLATE: &str = "{msg:12} {wide_bar} {pos}/{len}  {left}";

/// When a stage's first step was done and how many steps that was: those that an earlier run had
/// done say nothing about the pace.
#[derive(Debug, Clone, Default)]
struct Pace(Arc<Mutex<Option<(Instant, u64)>>>);

impl Pace {
    fn begin(&self, now: Instant, done: u64) {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert((now, done));
    }

    fn forget(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Time left at the mean pace so far. The mean over all steps is steadier than the last few:
    /// records of one kind of motion follow each other, and each kind has its own pace.
    fn left(&self, now: Instant, done: u64, total: u64) -> Option<Duration> {
        let (begin, first) = (*self.0.lock().unwrap_or_else(PoisonError::into_inner))?;
        let steps = done.checked_sub(first).filter(|s| *s > 0)?;
        let each = now.saturating_duration_since(begin).as_secs_f64() / steps as f64;
        Duration::try_from_secs_f64(each * total.saturating_sub(done) as f64).ok()
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
    fn valid_the_time_left_is_that_of_the_steps_left_at_the_mean_pace() {
        let pace = Pace::default();
        let begin = Instant::now();
        assert_eq!(pace.left(begin, 0, 100), None);
        pace.begin(begin, 40);
        pace.begin(begin + Duration::from_secs(1), 41);
        let left = pace.left(begin + Duration::from_secs(20), 60, 100);
        assert_eq!(left, Some(Duration::from_secs(40)));
        pace.forget();
        assert_eq!(pace.left(begin, 60, 100), None);
    }

    #[test]
    fn valid_times_in_words() {
        let words = |s| words(Some(Duration::from_secs(s)));
        assert_eq!(words(7), "7 s left");
        assert_eq!(words(67), "1 min 07 s left");
        assert_eq!(words(7300), "2 h 01 min left");
    }
}
