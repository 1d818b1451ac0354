//! The processor time that the program has used so far.

use std::time::{Duration, Instant};

/// Measures processor time; where the system does not tell it, the time on the clock on every thread,
/// which is no less.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meter {
    begin: Instant,
}

impl Meter {
    pub(super) fn start() -> Self {
        Self {
            begin: Instant::now(),
        }
    }

    /// Processor time since some moment before.
    pub(super) fn read(&self) -> Duration {
        of_the_system().unwrap_or_else(|| {
            let threads = u32::try_from(rayon::current_num_threads()).unwrap_or(1);
            self.begin.elapsed() * threads
        })
    }
}

/// User and system time of all threads, as Linux gives them: in hundredths of a second.
#[cfg(target_os = "linux")]
fn of_the_system() -> Option<Duration> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // the second field is the program's name in brackets, which may hold anything
    let (_, after) = stat.rsplit_once(')')?;
    let mut ticks = after.split_whitespace().skip(11);
    let user: u64 = ticks.next()?.parse().ok()?;
    let system: u64 = ticks.next()?.parse().ok()?;
    Some(Duration::from_millis(10 * (user + system)))
}

#[cfg(not(target_os = "linux"))]
fn of_the_system() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_time_never_runs_backwards_and_grows_with_work() {
        let meter = Meter::start();
        let before = meter.read();
        let mut sum = 0u64;
        while meter.read() == before {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        assert!(meter.read() > before);
    }
}
