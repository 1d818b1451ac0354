//! Quasi-stationary sweeps: the frequency or the clearance moves in small steps, the motion
//! continues, and every step yields its amplitude, approach speeds and Lyapunov exponent (Figs. 4 and 6 of the paper).

use serde::{Deserialize, Serialize};

use super::lyapunov::{Lyapunov, Variations};
use super::settling::{CHAOTIC_PERIODS, Settled, settle_on};
use crate::model::flight::{Drive, FlightPaths, forced_amplitude};
use crate::model::motion::count;
use crate::model::path::Path;
use crate::model::simulate::Snapshot;
use crate::model::{
    Impact, Initial, Machine, ModelError, Oscillator, Setting, SettledMotion, Simulator,
    Trajectory, Watch,
};

/// What a sweep goes through.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// (η, ρ) step by step, in the order of the sweep.
    pub steps: Vec<(f64, f64)>,
    /// Start of the first step.
    #[serde(default)]
    pub start: Initial,
    /// Settling and watch at every step, in drive periods.
    #[serde(default)]
    pub watch: Watch,
}

/// The motion at one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// The motion.
    pub motion: SettledMotion,
    /// Greatest displacement X in the watch.
    pub x_max: f64,
    /// Least displacement X in the watch.
    #[serde(default)]
    pub x_min: f64,
    /// Greatest displacement Y in the watch.
    pub y_max: f64,
    /// Approach speeds of the last impacts: one period's of a periodic motion, else up to 64.
    pub approach_speeds: Vec<f64>,
    /// X'₋ of the same impacts.
    pub x_speeds: Vec<f64>,
    /// Phases of the drive at the same impacts, rad.
    pub phases: Vec<f64>,
    /// Largest Lyapunov exponent per unit of τ; `None` where a dead zone wipes it out.
    pub lyapunov: Option<f64>,
    /// Its standard error: of a motion that repeats by how exactly it does, else by the scatter between its stretches.
    #[serde(default)]
    pub lyapunov_error: Option<f64>,
    /// Autocorrelation of X at lags of 1, 2, … drive periods; empty where X is at rest.
    pub autocorrelation: Vec<f64>,
}

/// Greatest value of a path over [0, duration], of its negative with the sign −1.
fn maximum(path: &Path, duration: f64, sign: f64) -> f64 {
    let steps = (duration * path.rate() * 8.0).ceil().clamp(2.0, 1e5);
    let at = |k: f64| path.at(duration * k / steps).map(|v| sign * v);
    let mut best = at(0.0)[0].max(at(steps)[0]);
    for k in 0..count(steps) {
        let (mut lo, mut hi) = (f64::from(k), f64::from(k) + 1.0);
        if at(lo)[1] > 0.0 && at(hi)[1] <= 0.0 {
            for _ in 0..50 {
                let mid = 0.5 * (lo + hi);
                if at(mid)[1] > 0.0 { lo = mid } else { hi = mid }
            }
            best = best.max(at(hi)[0]);
        }
    }
    best
}

/// Greatest number of impacts reported of a motion without a period.
const MOST_IMPACTS: usize = 64;

/// Samples of X per drive period in its autocorrelation.
const SAMPLES: usize = 32;
/// Longest lag of a point's autocorrelation, drive periods.
pub const LONGEST_LAG: usize = 6;

/// A motion that continues step by step.
#[derive(Debug, Clone)]
pub struct Carried<'a> {
    machine: &'a Machine,
    watch: Watch,
    simulator: Simulator,
}

impl<'a> Carried<'a> {
    /// From a start at the first (η, ρ); beyond the contact it is moved to it.
    ///
    /// # Errors
    /// [`ModelError`] where a parameter is out of range.
    pub fn start(
        machine: &'a Machine,
        (eta, rho): (f64, f64),
        initial: Initial,
        watch: Watch,
    ) -> Result<Self, ModelError> {
        Self::start_in(machine, Setting::new(eta, rho), initial, watch)
    }

    /// From a start in a setting with its phase of the drive; beyond the contact it is moved to it.
    ///
    /// # Errors
    /// [`ModelError`] where a parameter is out of range.
    pub fn start_in(
        machine: &'a Machine,
        setting: Setting,
        initial: Initial,
        watch: Watch,
    ) -> Result<Self, ModelError> {
        let start = super::grid::clear_of(machine, setting.clearance, initial);
        Ok(Self {
            machine,
            watch,
            simulator: Simulator::new(machine, setting, start)?,
        })
    }

    /// The motion's state and the phase of the drive, rad: where another can start to continue it.
    pub fn place(&self) -> (Initial, f64) {
        (self.simulator.state().into(), self.simulator.phase())
    }

    /// Go on from where another was, bit for bit.
    ///
    /// # Errors
    /// [`ModelError`] where a parameter is out of range.
    pub fn resume(
        machine: &'a Machine,
        snapshot: &Snapshot,
        watch: Watch,
    ) -> Result<Self, ModelError> {
        Ok(Self {
            machine,
            watch,
            simulator: Simulator::resume(machine, snapshot)?,
        })
    }

    /// Where the motion is.
    pub fn snapshot(&self) -> Snapshot {
        self.simulator.snapshot()
    }

    /// Take the motion along a straight way to (η, ρ) in a number of equal steps, each for some drive
    /// periods, without classifying it.
    ///
    /// # Errors
    /// [`ModelError`] where η or ρ is out of range.
    pub fn go(
        &mut self,
        (from, to): ((f64, f64), (f64, f64)),
        steps: u32,
        periods: f64,
    ) -> Result<(), ModelError> {
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            let setting = Setting::new(
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            );
            setting.check()?;
            let (eta, rho) = (setting.frequency_ratio, setting.clearance);
            self.simulator.set(eta, rho);
            self.simulator
                .advance(periods * setting.period(), &mut |_: &Impact| {});
        }
        Ok(())
    }

    /// Continue the motion at (η, ρ) and classify it there.
    ///
    /// # Errors
    /// [`ModelError`] where η or ρ is out of range.
    pub fn step(&mut self, (eta, rho): (f64, f64)) -> Result<SweepPoint, ModelError> {
        let setting = Setting::new(eta, rho);
        setting.check()?;
        self.simulator.set(eta, rho);
        let (period, watch) = (setting.period(), self.watch);
        let Settled {
            begin: mut follower,
            motion,
            impacts,
        } = settle_on(self.machine, &mut self.simulator, setting, &watch);
        let mut watched = Trajectory::default();
        let begin = follower.tau();
        follower
            .clone()
            .advance(watch.watch_periods * period, &mut watched);
        let (motion, exponent, error) = self.exponent(&mut follower, setting, motion);
        let exponent = Some(exponent).filter(|l| l.is_finite());
        let greatest = |of: fn(&FlightPaths) -> &Path, sign: f64| {
            let arcs = watched.arcs.iter();
            arcs.map(|arc| maximum(of(&arc.paths), arc.duration, sign))
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let next = |tau: &f64| Some(tau + period / SAMPLES as f64);
        let even = std::iter::successors(Some(begin), next).take_while(|tau| *tau < watched.end());
        let x: Vec<f64> = watched.sample(even).iter().map(|s| s.x).collect();
        let lags = (1..=LONGEST_LAG).map(|periods| periods * SAMPLES);
        let shown = match motion {
            SettledMotion::Periodic {
                p, chatter: false, ..
            } => p as usize,
            _ => MOST_IMPACTS,
        };
        let last = &impacts[impacts.len().saturating_sub(shown)..];
        let of = |f: fn(&Impact) -> f64| last.iter().map(f).collect();
        Ok(SweepPoint {
            eta: setting.frequency_ratio,
            rho: setting.clearance,
            motion,
            x_max: greatest(|paths| &paths.x, 1.0),
            x_min: -greatest(|paths| &paths.x, -1.0),
            y_max: greatest(|paths| &paths.y, 1.0),
            approach_speeds: of(|i| i.approach_speed),
            x_speeds: of(|i| i.vx_before),
            phases: of(|i| i.phase),
            lyapunov: exponent,
            lyapunov_error: exponent.and(error),
            autocorrelation: autocorrelation(&x, lags),
        })
    }

    /// The motion, with its greatest Lyapunov exponent and the exponent's standard error: by the greatest multiplier of
    /// one that repeats, which is known as its state is; else by the growth of its variations.
    fn exponent(
        &self,
        follower: &mut Simulator,
        setting: Setting,
        motion: SettledMotion,
    ) -> (SettledMotion, f64, Option<f64>) {
        let (period, watch) = (setting.period(), &self.watch);
        let mut lyapunov = Lyapunov::new(self.machine, setting.frequency_ratio);
        if let Some(repeats_after) = repeats_after_periods(&motion) {
            follower.advance(repeats_after * period, &mut lyapunov);
            let once = lyapunov.of_multiplier();
            let times = (watch.watch_periods / repeats_after).floor().max(2.0);
            follower.advance((times - 1.0) * repeats_after * period, &mut lyapunov);
            let exponent = lyapunov.of_multiplier();
            let error = (exponent - once).abs() + watch.tolerance / period;
            return (motion, exponent, Some(error));
        }
        let followed = match motion {
            SettledMotion::Chaotic => watch.watch_periods.max(CHAOTIC_PERIODS),
            _ => watch.watch_periods,
        };
        follower.advance(followed * period, &mut lyapunov);
        // the watch alone may take a slow convergence for growth: a label agrees with the exponent stated beside it
        let judged = watch.settle_periods > 0.0 && motion == SettledMotion::Chaotic;
        let motion = match lyapunov.variations() {
            Variations::Decay | Variations::Open if judged => SettledMotion::NotSettled,
            _ => motion,
        };
        (motion, lyapunov.exponent(), lyapunov.standard_error())
    }
}

/// Drive periods after which a motion repeats; `None` where it does not.
fn repeats_after_periods(motion: &SettledMotion) -> Option<f64> {
    match motion {
        SettledMotion::Periodic { n, .. } => Some(f64::from(*n)),
        SettledMotion::Impactless => Some(1.0),
        _ => None,
    }
}

/// Take a motion through a sweep. `observer` receives every point as it is done and ends the sweep
/// by returning false.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
///
/// ```
/// use impact_oscillator::atlas::{Sweep, sweep};
/// use impact_oscillator::{Initial, Machine, SettledMotion, Watch};
///
/// // η rising at ρ = 2 through the hysteresis region: z = 1 ends at η_s2 = 1.5688
/// let steps = (0..=50).map(|i| (1.1 + 0.01 * f64::from(i), 2.0)).collect();
/// let plan = Sweep { steps, start: Initial::rest(), watch: Watch::default() };
/// let points = sweep(&Machine::symmetric(0.07, 0.9), &plan, |_| true)?;
/// let impacts = points.iter().rfind(|p| p.motion != SettledMotion::Impactless);
/// let last = impacts.expect("impacts").eta;
/// assert!(last < 1.5688 && last > 1.53, "{last}");
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn sweep(
    machine: &Machine,
    plan: &Sweep,
    mut observer: impl FnMut(&SweepPoint) -> bool,
) -> Result<Vec<SweepPoint>, ModelError> {
    let mut points = Vec::with_capacity(plan.steps.len());
    let Some(&first) = plan.steps.first() else {
        return Ok(points);
    };
    let mut carried = Carried::start(machine, first, plan.start, plan.watch)?;
    for &at in &plan.steps {
        let point = carried.step(at)?;
        let go_on = observer(&point);
        points.push(point);
        if !go_on {
            break;
        }
    }
    Ok(points)
}

/// Autocorrelation of a uniformly sampled signal at the lags that are below its length: the correlation
/// coefficient of the signal with itself shifted, mean removed, each over the samples that both have; 1 at
/// lag 0, and at every whole period of a periodic signal. Empty for a constant signal.
pub fn autocorrelation(samples: &[f64], lags: impl IntoIterator<Item = usize>) -> Vec<f64> {
    let count = samples.len();
    let mean = samples.iter().sum::<f64>() / count.max(1) as f64;
    let centred: Vec<f64> = samples.iter().map(|x| x - mean).collect();
    let size = centred.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !(size > 0.0) {
        return Vec::new();
    }
    let squares = |values: &mut dyn Iterator<Item = &f64>| -> Vec<f64> {
        let growing = values.scan(0.0, |sum, x| {
            *sum += x * x;
            Some(*sum)
        });
        std::iter::once(0.0).chain(growing).collect()
    };
    let (first, last) = (
        squares(&mut centred.iter()),
        squares(&mut centred.iter().rev()),
    );
    let at = |lag: usize| -> f64 {
        let shared = count - lag;
        let scale = (first[shared] * last[shared]).sqrt();
        let product = inner_product(&centred[..shared], &centred[lag..]);
        if scale > 0.0 { product / scale } else { 0.0 }
    };
    lags.into_iter()
        .filter(|lag| *lag < count)
        .map(at)
        .collect()
}

/// Σ aᵢbᵢ, in eight sums that the processor forms side by side.
fn inner_product(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| a * b);
    sums.into_iter().chain(rest).sum()
}

/// Amplitude and phase of the impactless motion of each mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Impactless {
    /// Amplitude of X, and its phase behind the drive in [0, π], rad.
    pub x: (f64, f64),
    /// The same of Y; `None` for one mass.
    pub y: Option<(f64, f64)>,
}

/// Amplitude and phase characteristic of the impactless motion at η.
pub fn impactless(machine: &Machine, eta: f64) -> Impactless {
    let of = |o: &Oscillator| {
        let forced = forced_amplitude(o, Drive { eta, phase: 0.0 });
        (forced.norm(), (-forced.im).atan2(forced.re))
    };
    Impactless {
        x: of(&machine.x),
        y: machine.y.as_ref().map(of),
    }
}
