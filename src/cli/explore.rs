//! `impactid explore`: the live explorer in the browser.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use clap::Args;

use super::load::load_campaign;
use super::screen::Screen;
use super::speech::Speech;
use super::stdout::print;
use super::watch::{PaceArgs, tell};
use super::{Exit, Failure, Progress, Verbosity};
use impact_campaign::pipeline::watch::Watcher;
use impact_workbench::explore::{ExploreError, OpenCampaign, Server, Session, check};
use impact_workbench::theory::Study;

/// Arguments of `impactid explore`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Explore {
    /// A folder of results, a campaign.toml or a study; without it, the theory
    #[arg(value_name = "RESULTS|CAMPAIGN.TOML|STUDY.TOML")]
    given: Option<PathBuf>,
    /// Port on 127.0.0.1 [default: 8427, or one that is free]
    #[arg(long, value_name = "N")]
    port: Option<u16>,
    /// Print the page's address and open no browser
    #[arg(long)]
    no_browser: bool,
    /// Replay a demo of your own with --check, or open the page with it
    #[arg(long, value_name = "FILE")]
    demo: Option<PathBuf>,
    /// Watch the campaign.toml while its records arrive: the page follows at each fit
    #[arg(long, requires = "given", conflicts_with = "check")]
    watch: bool,
    #[command(flatten)]
    pace: PaceArgs,
    /// Replay all demos without a browser, compare their motions with those stated, and exit
    #[arg(long, conflicts_with_all = ["given", "port", "no_browser"])]
    check: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid explore                                 the theory
  impactid explore results/                        a campaign with its records and its fit
  impactid explore --watch campaign.toml           a campaign whose records are arriving
  impactid explore data-samples/studies/fig5-basins.toml
  impactid explore --port 8080 --no-browser        for a tunnel: ssh -L 8080:127.0.0.1:8080 HOST

The page is served on 127.0.0.1 alone, to whoever has the token in its address. An address of \
an explorer that has ended asks for the new one and keeps what it showed. Press ? there \
for its keys. Ctrl-C ends it. Nothing is written but the files that you export.";

impl From<ExploreError> for Failure {
    fn from(error: ExploreError) -> Self {
        match error {
            ExploreError::Pipeline(error) => error.into(),
            error => Self::new(error.to_string(), error.remedy()),
        }
    }
}

impl Explore {
    /// Serve the page, or replay the demos.
    ///
    /// # Errors
    /// [`Failure`] where the input cannot be used or the port is taken.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        if self.pace.is_given() && !self.watch {
            return Err(Failure::new(
                "--poll and --settle say how files that arrive are waited for",
                "add --watch, or leave them out",
            ));
        }
        let demo = self.demo.as_deref().map(read).transpose()?;
        if self.check {
            return replay(demo.as_deref(), verbosity);
        }
        let mut watched = None;
        let mut session = match &self.given {
            None => Session::theory(),
            Some(path) if self.watch => {
                let mut arriving = Watched::new(path, self.pace, verbosity)?;
                let campaign = arriving.at_next_fit();
                watched = Some(arriving);
                Session::of_campaign(campaign, Vec::new())
            }
            Some(path) => open(path, verbosity)?,
        };
        if let Some(text) = demo {
            Session::check_demo(&text)?;
            session = session.with_demo(text);
        }
        for note in session.notes() {
            verbosity.info(&format!("note: {note}"));
        }
        let server = Server::bind(session, self.port)?;
        if let Some(watched) = watched {
            let session = server.session();
            std::thread::spawn(move || {
                watched.for_each(|campaign| session.replace_campaign(campaign));
            });
        }
        print(&format!("{}\n", server.url()))?;
        verbosity.info("Ctrl-C ends the explorer.");
        if !self.no_browser && !open_browser(&server.url()) {
            verbosity.info("No browser could be started: open the address above.");
        }
        server.run()?;
        Ok(Exit::Done)
    }
}

fn replay(demo: Option<&str>, verbosity: Verbosity) -> Result<Exit, Failure> {
    let lines = match demo {
        Some(text) => vec![Session::check_demo(text)?],
        None => check()?,
    };
    for line in lines {
        verbosity.info(&line);
    }
    Ok(Exit::Done)
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(|e| Failure::io(path, &e))
}

/// Whether a text is that of a study: it states `damping_ratio` outside of all tables.
fn is_study(text: &str) -> bool {
    toml::from_str::<toml::Table>(text).is_ok_and(|table| table.contains_key("damping_ratio"))
}

/// What a path is: a folder is one of results; a file with `damping_ratio` is a study.
fn open(path: &Path, verbosity: Verbosity) -> Result<Session, Failure> {
    if !path.exists() {
        return Err(Failure::new(
            format!("{}: no such file or folder", path.display()),
            "name a folder of results, a campaign.toml or a study",
        ));
    }
    let bar = || Progress::new(verbosity, "observe", 0);
    if path.is_dir() {
        let bar = bar();
        let (campaign, notes) = OpenCampaign::read(path, &|s, d, t| bar.step(s, d, t))?;
        return Ok(Session::of_campaign(campaign, notes));
    }
    let study = fs::read_to_string(path).ok().filter(|text| is_study(text));
    if let Some(text) = study {
        let study: Study = toml::from_str(&text).map_err(|e| {
            let remedy = "correct the place named; the studies shipped are examples";
            Failure::new(format!("{}: {e}", path.display()), remedy)
        })?;
        return Ok(Session::study(&study)?);
    }
    let campaign = load_campaign(path, verbosity)?;
    let bar = bar();
    let campaign = OpenCampaign::of(campaign, &|s, d, t| bar.step(s, d, t))?;
    Ok(Session::of_campaign(campaign, Vec::new()))
}

/// A campaign whose records are arriving.
struct Watched {
    watcher: Watcher,
    begin: Instant,
    pace: PaceArgs,
    screen: Screen,
}

impl Watched {
    fn new(campaign: &Path, pace: PaceArgs, verbosity: Verbosity) -> Result<Self, Failure> {
        if !campaign.is_file() {
            return Err(Failure::new(
                format!("{} is not a campaign.toml", campaign.display()),
                "name the campaign.toml whose records arrive; `impactid init DIR` writes one",
            ));
        }
        let mut screen = Screen::new(verbosity);
        screen.say("Waiting for records; the page opens at the first fit.");
        Ok(Self {
            watcher: Watcher::new(campaign, pace.pace())?,
            begin: Instant::now(),
            pace,
            screen,
        })
    }

    /// The campaign at its next fit.
    fn at_next_fit(&mut self) -> OpenCampaign {
        loop {
            let seen = self.watcher.look(self.begin.elapsed());
            let report = self.watcher.report().map(Speech::of);
            let speech = report.and_then(Result::ok).unwrap_or_default();
            tell(&seen, &speech, &mut self.screen);
            if self.watcher.is_due(self.begin.elapsed()) {
                let fitted = self.watcher.fit::<Failure>(|_| Ok(()), |_| Ok(()));
                match fitted.map(|live| live.map(OpenCampaign::live)) {
                    Ok(Some(campaign)) => return campaign,
                    Ok(None) => {}
                    Err(failure) => self.screen.fail(&failure),
                }
            }
            self.pace.wait(&AtomicBool::new(false));
        }
    }
}

/// The campaign at each fit, without end.
impl Iterator for Watched {
    type Item = OpenCampaign;

    fn next(&mut self) -> Option<OpenCampaign> {
        Some(self.at_next_fit())
    }
}

/// Open an address in the system's browser; whether a program for it could be started.
fn open_browser(url: &str) -> bool {
    let (program, first): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(first).arg(url);
    let silent = command.stdout(Stdio::null()).stderr(Stdio::null());
    silent.stdin(Stdio::null()).spawn().is_ok()
}
