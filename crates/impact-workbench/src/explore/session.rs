//! What a page is opened on: the theory, a study, or a campaign, which may grow.

use std::sync::{Arc, PoisonError, RwLock};

use tokio::sync::watch;

use super::campaign::OpenCampaign;
use super::state::{Line, Panel, State, Window};
use super::{ExploreError, demo};
use crate::theory::Study;

/// What the explorer was started with.
pub struct Session {
    opened: RwLock<Opened>,
    /// How often the campaign was replaced.
    changes: watch::Sender<u64>,
    title: Option<String>,
    notes: Vec<String>,
    demo: Option<String>,
}

/// What a page shows when it opens.
struct Opened {
    state: State,
    campaign: Option<Arc<OpenCampaign>>,
}

impl Session {
    fn new(state: State, campaign: Option<OpenCampaign>, notes: Vec<String>) -> Self {
        Self {
            opened: RwLock::new(Opened {
                state,
                campaign: campaign.map(Arc::new),
            }),
            changes: watch::Sender::new(0),
            title: None,
            notes,
            demo: None,
        }
    }

    /// The theory alone.
    pub fn theory() -> Self {
        Self::new(State::default(), None, Vec::new())
    }

    /// A campaign with its fit.
    pub fn of_campaign(campaign: OpenCampaign, notes: Vec<String>) -> Self {
        Self::new(campaign.first_state(), Some(campaign), notes)
    }

    /// The campaign has more records, or another fit: pages that are open show it at once.
    pub fn replace_campaign(&self, campaign: OpenCampaign) {
        let opened = Opened {
            state: campaign.first_state(),
            campaign: Some(Arc::new(campaign)),
        };
        *self.opened.write().unwrap_or_else(PoisonError::into_inner) = opened;
        self.changes.send_modify(|count| *count += 1);
    }

    /// Tells when the campaign is replaced.
    pub(super) fn changes(&self) -> watch::Receiver<u64> {
        self.changes.subscribe()
    }

    /// A study: its machine and the first of each of its kinds of work.
    ///
    /// # Errors
    /// [`ExploreError`] where a value is out of range.
    pub fn study(study: &Study) -> Result<Self, ExploreError> {
        let first = State::default();
        let mut state = State {
            damping_ratio: study.damping_ratio,
            restitution: study.restitution.clone(),
            single: study.single,
            asymmetry: study.asymmetry,
            ..first
        };
        if let Some(plan) = study.regions.values().next() {
            state.view = window(plan.eta, plan.rho);
        }
        if let Some(plan) = study.map.values().next() {
            state.view = window(plan.eta, plan.rho);
            state.map_start = plan.map.start;
        }
        if let Some(plan) = study.basins.values().next() {
            state.panel = Panel::Basins;
            (state.cursor.eta, state.cursor.rho) =
                (plan.setting.frequency_ratio, plan.setting.clearance);
            state.cursor.phase = plan.setting.phase;
            state.watch = plan.watch;
            state.basins = Some(super::state::Starting {
                x: (plan.grid.x.0, plan.grid.x.1),
                vx: (plan.grid.vx.0, plan.grid.vx.1),
                cells: (plan.grid.x.2, plan.grid.vx.2),
                starts: plan.grid.starts,
            });
            if let Some(r) = plan.restitution {
                state.restitution = crate::theory::plan::RestitutionLaw::Constant(r);
            }
        }
        if let Some(plan) = study.sweep.values().next() {
            state.panel = Panel::Line;
            state.watch = plan.watch;
            state.line = Some(Line {
                eta: plan.eta,
                rho: plan.rho,
                steps: plan.steps,
                start: plan.start,
            });
            (state.cursor.eta, state.cursor.rho) = (plan.eta.0, plan.rho.0);
        }
        if let Some(plan) = study.time_series.values().next() {
            state.panel = Panel::Motion;
            state.cursor.eta = plan.setting.frequency_ratio;
            state.cursor.rho = plan.setting.clearance;
            state.cursor.phase = plan.setting.phase;
            state.cursor.start = plan.start;
            state.periods = plan.periods;
            state.samples_per_period = plan.samples_per_period;
            state.poincare_phase = plan.poincare_phase;
        }
        state.check()?;
        Ok(Self {
            title: Some(study.title.clone()),
            ..Self::new(state, None, Vec::new())
        })
    }

    /// The state that a page without one starts from.
    pub fn state(&self) -> State {
        let opened = self.opened.read().unwrap_or_else(PoisonError::into_inner);
        opened.state.clone()
    }

    /// The title of the study that is open.
    pub(super) fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// With a demo that the page plays when it opens.
    #[must_use]
    pub fn with_demo(mut self, text: String) -> Self {
        self.demo = Some(text);
        self
    }

    /// The demo that the page plays when it opens.
    pub(super) fn demo(&self) -> Option<&str> {
        self.demo.as_deref()
    }

    /// What the page shows as notes when it opens.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The campaign.
    ///
    /// # Errors
    /// [`ExploreError::Absent`] where the explorer shows the theory alone.
    pub(super) fn campaign(&self) -> Result<Arc<OpenCampaign>, ExploreError> {
        let opened = self.opened.read().unwrap_or_else(PoisonError::into_inner);
        opened.campaign.clone().ok_or_else(|| {
            ExploreError::Absent("no campaign is open: start `impactid explore RESULTS`".into())
        })
    }

    /// Replay a demo of the user's own; returns a line on it.
    ///
    /// # Errors
    /// [`ExploreError`] where it cannot be read.
    pub fn check_demo(text: &str) -> Result<String, ExploreError> {
        let demo = demo::Demo::read(text)?;
        super::check::check_one(&demo)
    }
}

fn window(eta: (f64, f64, usize), rho: (f64, f64, usize)) -> Window {
    Window {
        eta: (eta.0, eta.1),
        rho: (rho.0, rho.1),
    }
}
