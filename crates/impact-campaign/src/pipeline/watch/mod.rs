//! A campaign whose records are still arriving: each file is taken once it has stopped growing, each
//! record observed once, and the fit made again from the kept observations at times. The end is that
//! of [`super::run()`], with the same bytes.
//!
//! The caller gives the time and asks: [`Watcher::look`] every few seconds, [`Watcher::fit`] when
//! [`Watcher::is_due`], [`Watcher::complete`] at the end.

mod kept;
mod ledger;
mod listing;
mod live;
mod processor_time;
mod spacing;

pub use ledger::{News, NewsKind, WatchPatience};
pub use live::{Live, write_live};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use kept::Kept;
use ledger::{Ledger, Stamp};
use listing::Listings;
use processor_time::Meter;
use spacing::Spacing;

use super::run::{Completed, Destination, complete};
use super::{Observed, PipelineError, Progress, identify};
use crate::campaign::diagnostic::{Diagnostic, Diagnostics};
use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::sections::report::ReportSettings;
use crate::campaign::{NamedFiles, load_taken};
use impact_records::motion::{Bracket, Observation, brackets, scale_drives};

/// A campaign that is watched.
pub struct Watcher {
    /// campaign.toml.
    path: PathBuf,
    named: NamedFiles,
    ledger: Ledger,
    listings: Listings,
    kept: Kept,
    spacing: Spacing,
    meter: Meter,
    /// campaign.toml and the run table as they were read last.
    described: Vec<Option<Stamp>>,
    /// The campaign with the records taken so far; `None` before any could be listed.
    campaign: Option<ResolvedCampaign>,
    /// What was reported to be wrong with it.
    reported: Vec<Diagnostic>,
    /// When a record came or went last.
    changed: Duration,
    /// Records that can be used.
    usable: usize,
    last: Option<Live>,
    /// Whether the last fit is of the campaign as it is.
    is_fitted: bool,
}

/// What a look at the campaign's files brought.
#[derive(Debug, Default)]
pub struct Seen {
    /// Files that the user should know of.
    pub news: Vec<News>,
    /// Whether records came or went, or the campaign's description changed.
    pub changed: bool,
    /// How many records were observed.
    pub observed: usize,
    /// What is wrong with the campaign and was not yet reported.
    pub faults: Diagnostics,
}

/// Where the records taken so far are, and what they bracket.
#[derive(Debug, Default)]
pub struct Outline {
    /// The records without their impacts and waveforms.
    pub records: Vec<Observation>,
    /// The brackets of boundaries.
    pub brackets: Vec<Bracket>,
}

/// How patiently a campaign is watched.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// When files count as whole, or as half-written.
    pub patience: WatchPatience,
    /// When no record has arrived for so long, it is time for a fit.
    pub idle: Duration,
}

impl Watcher {
    /// Watch a campaign; nothing is taken yet.
    ///
    /// # Errors
    /// What is wrong with the form of campaign.toml, or that it states published speeds, not records.
    pub fn new(campaign: &Path, pace: Pace) -> Result<Self, Diagnostics> {
        Ok(Self {
            path: campaign.to_path_buf(),
            named: NamedFiles::read(campaign)?,
            ledger: Ledger::new(pace.patience),
            listings: Listings::default(),
            kept: Kept::default(),
            spacing: Spacing::new(pace.idle),
            meter: Meter::start(),
            described: Vec::new(),
            campaign: None,
            reported: Vec::new(),
            changed: Duration::ZERO,
            usable: 0,
            last: None,
            is_fitted: false,
        })
    }

    /// Look at the files, take those that are whole, and observe their records. `now` is counted from
    /// any one moment.
    pub fn look(&mut self, now: Duration) -> Seen {
        let begin = self.meter.read();
        let stamps = self.stamps();
        let edited = self.reread(&stamps);
        let look = self.ledger.look(now, &stamps);
        let mut seen = Seen {
            changed: edited,
            ..Seen::default()
        };
        for news in look.news {
            seen.changed |= matches!(news, News::Removed(_));
            if let News::Removed(path) | News::Replaced(path) = &news
                && !self.is_description(path)
            {
                self.spacing.outdated();
            }
            seen.news.extend(self.worth_telling(news));
        }
        for path in look.settled {
            seen.changed |= self.take(&path, now, &mut seen.faults);
        }
        if seen.changed {
            let is_other = self.reload(edited, &mut seen.faults);
            let listed = self.meter.read();
            seen.observed = self.observe();
            seen.changed = is_other || seen.observed > 0;
            if seen.changed {
                self.changed = now;
                self.is_fitted = false;
            }
            self.spacing.managed(listed.saturating_sub(begin));
            self.spacing
                .observed(self.meter.read().saturating_sub(listed));
        }
        self.report_once(&mut seen.faults);
        seen
    }

    /// The files that count: campaign.toml, the run table, and the records that they name.
    fn stamps(&self) -> BTreeMap<PathBuf, Stamp> {
        let descriptions = [Some(&self.path), self.named.run_table.as_ref()];
        let descriptions = descriptions.into_iter().flatten().cloned();
        let files = self.named.files().into_iter().chain(descriptions);
        let stamped = |path: PathBuf| Stamp::of(&path).map(|stamp| (path, stamp));
        files.filter_map(stamped).collect()
    }

    /// Read campaign.toml and the run table as soon as they have changed, for a table may never stop growing;
    /// whether they have.
    fn reread(&mut self, stamps: &BTreeMap<PathBuf, Stamp>) -> bool {
        let descriptions = [Some(&self.path), self.named.run_table.as_ref()];
        let now: Vec<_> = descriptions.map(|d| stamps.get(d?).copied()).into();
        if now == self.described {
            return false;
        }
        self.described = now;
        if let Ok(named) = NamedFiles::read(&self.path) {
            self.named = named;
        }
        true
    }

    fn is_description(&self, path: &Path) -> bool {
        path == self.path || self.named.run_table.as_deref() == Some(path)
    }

    /// News of a file as the user should know it: descriptions are meant to be edited, and a file that
    /// is no longer named may still be there.
    fn worth_telling(&self, news: News) -> Option<News> {
        match news {
            News::Replaced(path) if self.is_description(&path) => None,
            News::Removed(path) if path.is_file() => Some(News::Unlisted(path)),
            news => Some(news),
        }
    }

    /// Take a file that has stopped growing; whether it could be.
    fn take(&mut self, path: &Path, now: Duration, faults: &mut Diagnostics) -> bool {
        let taken = if self.is_description(path) {
            NamedFiles::read(&self.path).map_err(|found| {
                faults.0.extend(found.0);
                "it is faulty".to_owned()
            })
        } else {
            match self.listings.take(path) {
                Ok(()) => Ok(self.named.clone()),
                Err(error) => Err(error.fault()),
            }
        };
        match taken {
            Ok(named) => {
                self.named = named;
                self.ledger.take(path);
                true
            }
            Err(reason) => {
                self.ledger.refuse(path, now, reason);
                false
            }
        }
    }

    /// List the records of the files taken so far. A campaign that cannot be read at the moment stays
    /// as it was; that is reported once what was edited has settled. Returns whether it is another one.
    fn reload(&mut self, edited: bool, faults: &mut Diagnostics) -> bool {
        let ledger = &self.ledger;
        let taken = |path: &Path| ledger.taken(path).is_some();
        self.listings.keep(taken);
        let outcome = load_taken(&self.path, &|path| self.listings.open(path), &taken);
        if outcome.campaign.is_some() || !edited {
            faults.0.extend(outcome.diagnostics.0);
        }
        let is_other = outcome.campaign.is_some() && outcome.campaign != self.campaign;
        if is_other {
            self.campaign = outcome.campaign;
        }
        is_other
    }

    /// Observe the records that are new.
    fn observe(&mut self) -> usize {
        let Some(campaign) = &self.campaign else {
            return 0;
        };
        let ledger = &self.ledger;
        let observed = self.kept.observe(campaign, |path| ledger.taken(path));
        let usable = self.kept.outlines(campaign);
        self.usable = usable.iter().filter(|o| !o.excluded()).count();
        observed
    }

    /// Keep what was not reported yet.
    fn report_once(&mut self, faults: &mut Diagnostics) {
        faults.0.retain(|fault| !self.reported.contains(fault));
        self.reported.extend(faults.0.iter().cloned());
        faults.sort();
    }

    /// Whether to fit now.
    pub fn is_due(&self, now: Duration) -> bool {
        !self.is_fitted
            && self
                .spacing
                .is_due(self.usable, now.saturating_sub(self.changed))
    }

    /// The records taken so far.
    pub fn outline(&self) -> Outline {
        let Some(campaign) = &self.campaign else {
            return Outline::default();
        };
        let mut records = self.kept.outlines(campaign);
        scale_drives(&mut records);
        Outline {
            brackets: brackets(&records),
            records,
        }
    }

    /// What the campaign states of its report; `None` before any record could be listed.
    pub fn report(&self) -> Option<&ReportSettings> {
        self.campaign.as_ref().map(|campaign| &campaign.report)
    }

    /// Files that are there and not whole yet.
    pub fn waiting(&self) -> usize {
        self.ledger.waiting()
    }

    /// The last fit.
    pub fn last(&self) -> Option<&Live> {
        self.last.as_ref()
    }

    /// Fit the records taken so far; `adjust` sets the options of the report, `then` does what belongs to
    /// the fit, such as writing it, and is counted with it. `None`: no record can be used.
    ///
    /// # Errors
    /// Those of the fit, and of `then`.
    pub fn fit<E: From<PipelineError>>(
        &mut self,
        adjust: impl Fn(&mut ReportSettings) -> Result<(), E>,
        then: impl FnOnce(&Live) -> Result<(), E>,
    ) -> Result<Option<&Live>, E> {
        let begin = self.meter.read();
        self.is_fitted = true;
        let Some(mut campaign) = self.campaign.clone() else {
            return Ok(None);
        };
        adjust(&mut campaign.report)?;
        let observations = self.kept.observations(&campaign);
        let unseen: Progress<'_> = &|_, _, _| ();
        let observed = match Observed::from_observations(&campaign, observations, unseen) {
            Ok(observed) => observed,
            Err(PipelineError::NothingUsable(_)) => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        let (live, identified) = Live::of(campaign, observed, self.meter)?;
        then(&live)?;
        let identifying = identified.saturating_sub(begin);
        let showing = self.meter.read().saturating_sub(identified);
        self.spacing.fitted(identifying, showing, self.usable);
        Ok(Some(self.last.insert(live)))
    }

    /// What a run of the campaign as it is now leaves: `campaign` is loaded as for [`super::run()`]. The
    /// records that are kept are not observed again, and the last fit is not repeated if it is of
    /// the same records.
    ///
    /// # Errors
    /// As [`super::run()`].
    pub fn complete(
        &mut self,
        campaign: &ResolvedCampaign,
        destination: &Destination<'_>,
        progress: Progress<'_>,
    ) -> Result<Completed, PipelineError> {
        self.kept.observe(campaign, Stamp::of);
        let observations = self.kept.observations(campaign);
        let observed = Observed::from_observations(campaign, observations, progress)?;
        let found = self.last.take();
        let found = found.filter(|live| live.is_of(campaign, &observed));
        let found = match found {
            Some(live) => Some(identify::IdentificationFile {
                identification: live.found.identification,
                provenance: identify::provenance(campaign)?,
            }),
            None => None,
        };
        complete(campaign, observed, found, destination, progress)
    }
}
