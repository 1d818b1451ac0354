//! What becomes of each file while records arrive: growing, settled, taken, replaced, removed. The times
//! are given by the caller.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// By what a change of a file is noticed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    /// Its length, bytes.
    pub(super) length: u64,
    /// When it was changed last, as its file system says.
    pub(super) changed: Option<SystemTime>,
    /// When it was made, where its file system says: a file made later is another one.
    pub(super) made: Option<SystemTime>,
}

impl Stamp {
    /// That of a file as it is now; `None` where there is none.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let metadata = std::fs::metadata(path).ok().filter(|m| m.is_file())?;
        Some(Self {
            length: metadata.len(),
            changed: metadata.modified().ok(),
            made: metadata.created().ok(),
        })
    }

    /// Whether the file is as it was.
    fn is_as(&self, other: &Self) -> bool {
        self.length == other.length && self.changed == other.changed
    }

    /// Whether a file that has changed was rewritten, rather than continued.
    fn replaces(&self, before: &Self) -> bool {
        self.made != before.made || self.length <= before.length
    }
}

/// Something about a file that the user should know.
#[derive(Debug, Clone, PartialEq, Eq, strum::EnumDiscriminants)]
#[strum_discriminants(name(NewsKind), derive(strum::VariantArray))]
#[strum_discriminants(doc = "What happened to a file.")]
pub enum News {
    /// A file that was taken is gone, and its records with it.
    Removed(PathBuf),
    /// A file that was taken is there, and campaign.toml or the run table no longer name it.
    Unlisted(PathBuf),
    /// A file that was taken is another one; it is taken again when it has stopped growing.
    Replaced(PathBuf),
    /// A file is not whole after a long time.
    HalfWritten {
        /// The file.
        path: PathBuf,
        /// Why it cannot be opened; `None`: it still grows.
        reason: Option<String>,
    },
}

/// What a look at the files showed.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Look {
    /// Files that have stopped growing and should be opened now.
    pub(super) settled: Vec<PathBuf>,
    /// What the user should know.
    pub(super) news: Vec<News>,
}

/// One file.
#[derive(Debug)]
struct Entry {
    stamp: Stamp,
    /// Since when it has that stamp.
    since: Duration,
    /// Since when it waits to be taken.
    waiting: Duration,
    /// As it was when it was taken last.
    taken: Option<Stamp>,
    /// When it was opened in vain, and why.
    refused: Option<(Duration, String)>,
    /// Whether it was reported that it is half-written, or replaced, since it waits.
    reported: Reported,
}

#[derive(Debug, Default, Clone, Copy)]
struct Reported {
    half_written: bool,
    replaced: bool,
}

/// Times by which files are judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WatchPatience {
    /// A file that has not changed for so long has stopped growing.
    pub quiet: Duration,
    /// A file that is not whole for so long is named.
    pub half_written: Duration,
}

impl Default for WatchPatience {
    fn default() -> Self {
        Self {
            quiet: Duration::from_secs(5),
            half_written: Duration::from_secs(3600),
        }
    }
}

/// A file that could not be opened is tried again after so long even if it has not changed: another
/// program may have held it.
const RETRY: Duration = Duration::from_secs(30);

/// All files that a campaign names.
#[derive(Debug)]
pub(super) struct Ledger {
    patience: WatchPatience,
    files: BTreeMap<PathBuf, Entry>,
}

impl Ledger {
    /// Of no files.
    pub(super) fn new(patience: WatchPatience) -> Self {
        Self {
            patience,
            files: BTreeMap::new(),
        }
    }

    /// Note how the named files are at a time, counted from any one moment.
    pub(super) fn look(&mut self, now: Duration, seen: &BTreeMap<PathBuf, Stamp>) -> Look {
        let mut look = Look::default();
        self.files.retain(|path, entry| {
            let there = seen.contains_key(path);
            if !there && entry.taken.is_some() {
                look.news.push(News::Removed(path.clone()));
            }
            there
        });
        for (path, stamp) in seen {
            let entry = self.files.entry(path.clone());
            let entry = entry.or_insert_with(|| Entry::new(*stamp, now));
            entry.note(*stamp, now);
            if entry.is_taken() {
                continue;
            }
            look.news.extend(entry.news(path, now, self.patience));
            if entry.is_due(now, self.patience.quiet) {
                look.settled.push(path.clone());
            }
        }
        look
    }

    /// A settled file opened cleanly.
    pub(super) fn take(&mut self, path: &Path) {
        if let Some(entry) = self.files.get_mut(path) {
            entry.taken = Some(entry.stamp);
            entry.refused = None;
            entry.reported = Reported::default();
        }
    }

    /// A settled file could not be opened.
    pub(super) fn refuse(&mut self, path: &Path, now: Duration, reason: String) {
        if let Some(entry) = self.files.get_mut(path) {
            entry.refused = Some((now, reason));
        }
    }

    /// How a file was when it was taken last; `None` if it never was.
    pub(super) fn taken(&self, path: &Path) -> Option<Stamp> {
        self.files.get(path).and_then(|entry| entry.taken)
    }

    /// Files that wait to be taken.
    pub(super) fn waiting(&self) -> usize {
        self.files.values().filter(|e| !e.is_taken()).count()
    }
}

impl Entry {
    fn new(stamp: Stamp, now: Duration) -> Self {
        Self {
            stamp,
            since: now,
            waiting: now,
            taken: None,
            refused: None,
            reported: Reported::default(),
        }
    }

    fn note(&mut self, stamp: Stamp, now: Duration) {
        if stamp.is_as(&self.stamp) {
            return;
        }
        if self.is_taken() {
            self.waiting = now;
        }
        self.stamp = stamp;
        self.since = now;
        self.refused = None;
    }

    fn is_taken(&self) -> bool {
        self.taken.is_some_and(|taken| taken.is_as(&self.stamp))
    }

    fn is_due(&self, now: Duration, quiet: Duration) -> bool {
        let still = now.saturating_sub(self.since) >= quiet;
        let refused = self.refused.as_ref();
        still && refused.is_none_or(|(at, _)| now.saturating_sub(*at) >= RETRY)
    }

    fn news(&mut self, path: &Path, now: Duration, patience: WatchPatience) -> Vec<News> {
        let mut news = Vec::new();
        let replaced = self.taken.is_some_and(|t| self.stamp.replaces(&t));
        if replaced && !self.reported.replaced {
            self.reported.replaced = true;
            news.push(News::Replaced(path.to_path_buf()));
        }
        let late = now.saturating_sub(self.waiting) >= patience.half_written;
        if late && !self.reported.half_written {
            self.reported.half_written = true;
            news.push(News::HalfWritten {
                path: path.to_path_buf(),
                reason: self.refused.as_ref().map(|(_, reason)| reason.clone()),
            });
        }
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn stamp(length: u64) -> Stamp {
        Stamp {
            length,
            changed: Some(SystemTime::UNIX_EPOCH + Duration::from_secs(length)),
            made: Some(SystemTime::UNIX_EPOCH),
        }
    }

    fn seen(files: &[(&str, Stamp)]) -> BTreeMap<PathBuf, Stamp> {
        files.iter().map(|(n, s)| (PathBuf::from(n), *s)).collect()
    }

    fn ledger() -> Ledger {
        Ledger::new(WatchPatience::default())
    }

    /// A ledger that has taken the file `a` of so many bytes at 5 s.
    fn with_taken(length: u64) -> Ledger {
        let mut ledger = ledger();
        for at in [0, 5] {
            ledger.look(at * SECOND, &seen(&[("a", stamp(length))]));
        }
        ledger.take(Path::new("a"));
        ledger
    }

    #[test]
    fn a_file_is_settled_once_it_has_stopped_growing() {
        let mut ledger = ledger();
        for (at, length) in [(0, 1), (4, 2), (8, 3), (12, 3)] {
            let look = ledger.look(at * SECOND, &seen(&[("a", stamp(length))]));
            assert_eq!(look, Look::default(), "after {at} s");
        }
        let look = ledger.look(13 * SECOND, &seen(&[("a", stamp(3))]));
        assert_eq!(look.settled, [PathBuf::from("a")]);
        assert_eq!(ledger.taken(Path::new("a")), None);
        ledger.take(Path::new("a"));
        assert_eq!(ledger.taken(Path::new("a")), Some(stamp(3)));
        let look = ledger.look(99 * SECOND, &seen(&[("a", stamp(3))]));
        assert_eq!(look, Look::default());
        assert_eq!(ledger.waiting(), 0);
    }

    #[test]
    fn a_file_that_grows_later_is_settled_again_and_stays_taken_until_then() {
        let mut ledger = with_taken(3);
        let look = ledger.look(20 * SECOND, &seen(&[("a", stamp(9))]));
        assert_eq!(look, Look::default());
        assert_eq!(ledger.taken(Path::new("a")), Some(stamp(3)));
        assert_eq!(ledger.waiting(), 1);
        let look = ledger.look(25 * SECOND, &seen(&[("a", stamp(9))]));
        assert_eq!((look.settled.len(), look.news.len()), (1, 0));
    }

    #[test]
    fn a_file_that_is_replaced_is_named_once() {
        let made_later = Stamp {
            made: Some(SystemTime::UNIX_EPOCH + SECOND),
            ..stamp(9)
        };
        let rewritten = Stamp {
            changed: stamp(9).changed,
            ..stamp(3)
        };
        for new in [stamp(2), made_later, rewritten] {
            let mut ledger = with_taken(3);
            let look = ledger.look(20 * SECOND, &seen(&[("a", new)]));
            assert_eq!(look.news, [News::Replaced("a".into())], "{new:?}");
            let look = ledger.look(25 * SECOND, &seen(&[("a", new)]));
            assert_eq!((look.settled.len(), look.news.len()), (1, 0));
        }
    }

    #[test]
    fn a_file_that_is_removed_is_named_if_it_was_taken() {
        let mut ledger = with_taken(3);
        ledger.look(6 * SECOND, &seen(&[("a", stamp(3)), ("b", stamp(1))]));
        let look = ledger.look(7 * SECOND, &seen(&[]));
        assert_eq!(look.news, [News::Removed("a".into())]);
        assert_eq!(ledger.look(8 * SECOND, &seen(&[])), Look::default());
        assert_eq!(ledger.taken(Path::new("a")), None);
        // it comes back as a new one
        let look = ledger.look(9 * SECOND, &seen(&[("a", stamp(3))]));
        assert_eq!(look, Look::default());
        assert_eq!(
            ledger
                .look(14 * SECOND, &seen(&[("a", stamp(3))]))
                .settled
                .len(),
            1
        );
    }

    #[test]
    fn a_file_that_is_half_written_for_an_hour_is_named_once_with_the_reason() {
        let mut ledger = ledger();
        let mut named = Vec::new();
        for at in (0..7300).step_by(2) {
            // `grows` never stops; `torn` cannot be opened
            let files = [("grows", stamp(at)), ("torn", stamp(5))];
            let now = Duration::from_secs(at);
            let look = ledger.look(now, &seen(&files));
            for path in look.settled {
                ledger.refuse(&path, now, "no superblock".to_owned());
            }
            named.extend(look.news.into_iter().map(|news| (at, news)));
        }
        let half = |name: &str, reason: Option<&str>| News::HalfWritten {
            path: name.into(),
            reason: reason.map(String::from),
        };
        let expected = [
            (3600, half("grows", None)),
            (3600, half("torn", Some("no superblock"))),
        ];
        assert_eq!(named, expected);
        // a later hour counts from its own beginning
        let mut ledger = with_taken(3);
        for at in [4000, 4001] {
            let look = ledger.look(at * SECOND, &seen(&[("a", stamp(u64::from(at)))]));
            assert_eq!(look.news, [], "after {at} s");
        }
        let look = ledger.look(7600 * SECOND, &seen(&[("a", stamp(8))]));
        assert_eq!(look.news, [half("a", None)]);
    }

    #[test]
    fn a_file_that_does_not_open_is_tried_again() {
        let mut ledger = ledger();
        ledger.look(Duration::ZERO, &seen(&[("a", stamp(3))]));
        ledger.look(5 * SECOND, &seen(&[("a", stamp(3))]));
        ledger.refuse(Path::new("a"), 5 * SECOND, "held".to_owned());
        for (at, length, settled) in [(10, 3, 0), (34, 3, 0), (35, 3, 1), (36, 4, 0), (41, 4, 1)] {
            let look = ledger.look(at * SECOND, &seen(&[("a", stamp(length))]));
            assert_eq!(look.settled.len(), settled, "after {at} s");
            if at == 35 {
                ledger.refuse(Path::new("a"), at * SECOND, "held".to_owned());
            }
        }
    }
}
