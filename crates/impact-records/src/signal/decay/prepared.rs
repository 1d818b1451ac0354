//! A decay made ready for its fit: where it begins and ends, what lies under it, the noise about it.

use super::beat::{self, Beat};
use super::blows;
use super::fits::{factor, fitted, free, laws, means, peak, rough};
use super::hum::Cleared;
use super::least_squares::{Point, Series};
use super::modes::{self, Mode, STEADY};
use super::noise::{Noise, structured};
use super::shape::{Rates, Shape};
use crate::signal::{columns, robust, whole};

/// Most means that are fitted.
const MOST: usize = 20_000;
/// Time constants of the decay after which it is lost.
const LOST: f64 = 7.0;
/// Part of a period by which the fit begins later where the samples are not those of the decay.
const LATER: f64 = 0.125;
/// Periods within which the fit begins.
const BEGINS: f64 = 3.0;
/// Root mean square of the first quarter of a period, in those of the others, that is no noise.
const NO_NOISE: f64 = 3.0;
/// What a fit leaves over the decay, below which it may be one.
const EXPLAINED: f64 = 0.8;
/// How much more than the least may be left where a fit begins.
const AS_LITTLE: f64 = 1.5;
/// What a fit leaves over the decay, from which one that begins later is looked at, and what that one leaves of it at most
/// where the decay begins there: samples before a blow bend the fit of a few periods as a whole.
const POOR: f64 = 0.05;
const FAR_LESS: f64 = 0.2;

/// Time constants of the first motion after which another that lasts is looked for; its fit begins after one.
const OVER: f64 = 3.0;
/// Damping ratio of two motions, one of which outlasts the other, at most.
const LIGHT: f64 = 0.15;
/// Ratio of the frequencies of the first motion and of the one that lasts, from which one is another mode.
const ANOTHER_MODE: f64 = 1.5;
/// Rate of the motion that lasts over that of the first one, at most.
const SLOWER: f64 = 0.7;
/// Share of the variance that a decay there explains.
const EXPLAINS: f64 = 0.5;

/// Amplitude of a decay that beats over that of the stronger one, from which it is open which of both is the rig's, and what
/// both leave of the squares that one leaves, at most, where they are all that there is: a fifth of the amplitude. They beat
/// once and a half, as a frequency that changes is no beat.
const CLEARLY_WEAKER: f64 = 0.7;
const NEARLY_ALL: f64 = 0.04;
const BEATS: f64 = 1.5;
/// Periods from which a weaker decay is fitted: in fewer of them dry friction and noise that is not white are as well two decays.
const PARTED: f64 = 12.0;

/// Fewest degrees of freedom of a fit.
const LEAST_FREEDOM: usize = 8;
/// Amplitude at the first sample over the greatest excursion, at most.
const MOST_EXTRAPOLATED: f64 = 3.0;

/// Fewest periods that a fit needs, until a mass sticks under dry friction too: one and a half, as far as they are known
/// beforehand.
pub(super) const LEAST_PERIODS: f64 = 1.4;
/// Decay that must stand out of the noise, in standard errors of its amplitude.
const STANDS_OUT: f64 = 12.0;

/// What was measured beside a decay.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Beside {
    /// The strongest steady tone: frequency, Hz, and amplitude over that of the decay.
    pub hum: Option<[f64; 2]>,
    /// The strongest decay of another frequency, likewise.
    pub mode: Option<[f64; 2]>,
    /// Two decays that beat, which one does not explain: both frequencies, Hz, the stronger first, and the amplitude
    /// of the weaker over that of the stronger. They are not fitted with it.
    #[serde(default)]
    pub beat: Option<[f64; 3]>,
    /// Range of the polynomial under the decay over the decay's first amplitude; zero of an offset alone.
    pub drift_ratio: f64,
    /// How many times as wide noise at the decay's frequency makes the intervals as that at high frequencies.
    pub slow_noise: f64,
}

/// A decay ready for its fit.
pub(super) struct Prepared {
    /// First sample of the part that is fitted, and how many are.
    pub(super) first: usize,
    samples: Vec<f64>,
    /// Samples of each mean.
    pub(super) factor: usize,
    /// The means, less steady tones.
    pub(super) series: Series,
    /// The fit that leaves the rate of decay free to change, where the decay is long enough to tell: of
    /// those the one that the noise is best beside.
    pub(super) free: Point,
    /// What was taken from the samples: frequency per sample, amplitude, and whether it is steady.
    beside: Vec<Mode>,
    /// What beats with the decay and was not taken.
    beat: Option<Beat>,
}

/// The fit at every sample.
pub(super) struct AtEverySample {
    pub(super) amplitude: f64,
    pub(super) phase_rad: f64,
    pub(super) offset: f64,
    pub(super) residual_ratio: f64,
    pub(super) structured_ratio: f64,
    pub(super) fading: f64,
    pub(super) samples: usize,
}

impl Prepared {
    /// The decay of a part of a record with one blow or release, beside a weaker one that beats with it; else with the one that
    /// beats with it.
    pub(super) fn of(part: &Cleared<'_>) -> Option<Self> {
        let alone = Self::alone(part)?;
        let beat = beat::find(&alone.series, &alone.free);
        let both = beat.and_then(|beat| alone.beside_partner(&beat));
        Some(both.unwrap_or(Self { beat, ..alone }))
    }

    /// The decay of a part of a record with one blow or release. Where its first motion and all of it have
    /// unlike frequencies, as after a hammer's blow that excites a higher mode too, the one that lasts, if it
    /// decays at all; of two modes at once the lower one, if it begins with the greater amplitude.
    pub(super) fn alone(part: &Cleared<'_>) -> Option<Self> {
        let begun = blows::begin(&part.cleared)?;
        let tail = &part.cleared[begun.1..];
        let first_motion = |part: &[f64]| rough(part, peak(part)?);
        let begins = first_motion(blows::lasting(tail)).or_else(|| first_motion(tail))?;
        let lost = whole::index((OVER / begins.rates[1].max(1e-9)).min(1e9));
        let lasts = tail.get(lost..).and_then(|after| {
            let found = rough(after, peak(after)?)?;
            if part.is_tone(found.rates, after.len()) {
                return None;
            }
            let slower = found.rates[1] < SLOWER * begins.rates[1];
            let decays = found.rates[1] * after.len() as f64 > STEADY;
            let slower = slower && found.rates[1] < LIGHT * found.rates[0];
            (slower && decays && found.explains > EXPLAINS).then_some(found)
        });
        let longest = lasts.map_or(begins.rates, |l| l.rates);
        if let Some(lower) = lower_mode(tail, longest) {
            return Self::about(part, begun, lower, Some(longest));
        }
        let Some(lasts) = lasts else {
            return Self::about(part, begun, begins.rates, None);
        };
        if begins.rates[0] < ANOTHER_MODE * lasts.rates[0] {
            return Self::about(part, begun, lasts.rates, None);
        }
        if begins.rates[1] > LIGHT * begins.rates[0] {
            return Self::about(part, begun, begins.rates, None);
        }
        let start = begun.1 + lost / 3;
        Self::about(part, (start, start), lasts.rates, Some(begins.rates))
    }

    /// The decay of about given rates in a part of a record whose motion has begun, beside the one of a known
    /// mode.
    fn about(
        part: &Cleared<'_>,
        begun: (usize, usize),
        rates: [f64; 2],
        mode: Option<[f64; 2]>,
    ) -> Option<Self> {
        let mut cleared = part.cleared.clone();
        if let Some(mode) = mode {
            modes::subtract(&mut cleared[begun.1..], mode);
        }
        let known: Vec<[f64; 2]> = part.tones.iter().copied().chain(mode).collect();
        let quantity = part.channel.quantity;
        let start = if begun.0 < begun.1 {
            blows::earliest(&cleared, begun, std::f64::consts::TAU / rates[0])
        } else {
            begun.1
        };
        let (first, found) = begin(&cleared, start, rates)?;
        let factor = found.factor;
        let mut own = part.channel.values[first..].to_vec();
        let rates_found = found.point.per_sample(factor);
        let beside = modes::remove((&mut own, quantity), rates_found, &known);
        let point = if beside.is_empty() {
            found.point
        } else {
            first_fit(&own, rates)?.point
        };
        own.truncate(end(&own, factor, &point));
        let mut series = Series {
            quantity,
            factor,
            ..Series::plain(means(&own, factor))
        };
        series.taken = overlapping(&beside, point.rates, &series);
        let free = settle(&mut series, &point)?;
        Some(Self {
            first,
            samples: own,
            factor,
            series,
            free,
            beside,
            beat: None,
        })
    }

    /// The same less a weaker decay that beats with it, where both explain nearly all that one leaves.
    fn beside_partner(&self, beat: &Beat) -> Option<Self> {
        let turns =
            |rate: f64| rate.abs() * self.series.values.len() as f64 / std::f64::consts::TAU;
        let [[own, _], [other, _]] = beat.rates;
        let parted = turns(own) > PARTED && turns(own - other) > BEATS;
        if beat.ratio > CLEARLY_WEAKER || beat.remains > NEARLY_ALL || !parted {
            return None;
        }
        let per_sample = |rates: [f64; 2]| rates.map(|r| r / self.factor as f64);
        let rates = beat.rates.map(per_sample);
        let mut samples = self.samples.clone();
        let amplitude = beat::take_weaker(&mut samples, rates)?;
        let mut beside = self.beside.clone();
        beside.push(Mode {
            rates: rates[1],
            amplitude,
            steady: false,
        });
        let mut series = Series {
            quantity: self.series.quantity,
            factor: self.factor,
            ..Series::plain(means(&samples, self.factor))
        };
        let [omega, sigma] = beat.rates[0];
        let start = free(&series, [omega, sigma, 0.0, 0.0])?;
        series.taken = overlapping(&beside, start.rates, &series);
        let free = settle(&mut series, &start)?;
        Some(Self {
            samples,
            series,
            free,
            beside,
            ..*self
        })
    }

    /// Degrees of freedom that a fit leaves.
    pub(super) fn degrees(&self, point: &Point) -> Option<f64> {
        let left = self.series.values.len().checked_sub(point.parameters())?;
        (left > 0).then_some(left as f64)
    }

    /// Whether a decay stands out of the noise, and above what is before and after it.
    pub(super) fn stands_out(&self, point: &Point, deviation: f64) -> bool {
        let count = self.series.values.len();
        let lasts = (count as f64).min(1.0 / point.rates[1].abs().max(f64::MIN_POSITIVE));
        let [a, b] = point.amplitudes();
        let sizes = self
            .series
            .values
            .iter()
            .map(|v| (v - point.offset()).abs());
        let greatest = sizes.fold(0.0, f64::max);
        let amplitude = a.hypot(b);
        count >= point.parameters() + LEAST_FREEDOM
            && amplitude < MOST_EXTRAPOLATED * greatest
            && amplitude * (0.5 * lasts).sqrt() > STANDS_OUT * deviation
    }

    /// What lies beside a decay of an amplitude.
    pub(super) fn beside(&self, amplitude: f64, rate_hz: f64) -> Beside {
        let strongest = |steady: bool| {
            let of_kind = self.beside.iter().filter(|m| m.steady == steady);
            let found = of_kind.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            found.map(|m| {
                [
                    m.rates[0] / std::f64::consts::TAU * rate_hz,
                    m.amplitude / amplitude,
                ]
            })
        };
        let beat = self.beat.map(|found| {
            let hz = rate_hz / self.factor as f64 / std::f64::consts::TAU;
            let [strong, weak] = found.rates.map(|[omega, _]| omega * hz);
            [strong, weak, found.ratio]
        });
        Beside {
            hum: strongest(true),
            mode: strongest(false),
            beat,
            drift_ratio: self.free.drift(self.series.degree) / amplitude,
            slow_noise: self.series.noise.slow(self.free.rates[0]),
        }
    }

    /// The linear part of a fit at every sample.
    pub(super) fn at_every_sample(&self, point: &Point) -> Option<AtEverySample> {
        let rates = point.per_sample(self.factor);
        let series = Series {
            quantity: self.series.quantity,
            ..Series::white(self.samples.clone(), self.series.degree)
        };
        let own = series.project(point.shape, rates)?;
        let residuals = series.residuals(&own);
        let [a, b] = own.amplitudes();
        let amplitude = a.hypot(b);
        let level = own.level(series.values.len());
        let quarter = residuals.len() / 4;
        let last = robust::rms(&residuals[residuals.len() - quarter..]);
        Some(AtEverySample {
            fading: robust::rms(&residuals[..quarter]) / last.max(f64::MIN_POSITIVE),
            amplitude,
            phase_rad: (-b).atan2(a),
            offset: own.offset(),
            residual_ratio: robust::rms(&residuals) / level,
            structured_ratio: structured(&residuals) / level,
            samples: series.values.len(),
        })
    }
}

/// The rates of a mode below the one of given rates, beside which it begins with the greater amplitude though it may be over
/// sooner.
fn lower_mode(samples: &[f64], rates: [f64; 2]) -> Option<[f64; 2]> {
    let known = modes::fitted(samples, rates)?;
    let mut rest = samples.to_vec();
    columns::subtract(&mut rest, 1.0, &known.values);
    let lower = rough(&rest, peak(&rest)?)?;
    let [omega, sigma] = lower.rates;
    let is_motion = sigma > 0.0 && modes::lasts(lower.rates, samples.len() as f64);
    let stands_out = is_motion && lower.explains > EXPLAINS;
    let below = ANOTHER_MODE * omega < known.mode.rates[0];
    (stands_out && below && lower.amplitude > known.mode.amplitude).then_some(lower.rates)
}

/// Lines of the spectrum, and half widths of the resonance, from which two oscillations do not move each other: they
/// share less than a thousandth of their energy.
const APART: f64 = 10.0;

/// The rates, per value of a series, of modes whose errors move a decay.
fn overlapping(modes: &[Mode], [omega, sigma, ..]: Rates, series: &Series) -> Vec<[f64; 2]> {
    let line = std::f64::consts::TAU / series.values.len() as f64;
    let rates = modes
        .iter()
        .map(|m| m.rates.map(|r| r * series.factor as f64));
    let near = |own: &[f64; 2]| {
        let widest = line.max(sigma.abs()).max(own[1].abs());
        (own[0] - omega).abs() < APART * widest
    };
    rates.filter(near).collect()
}

/// First sample and the first fit: later than the start by parts of a period while the first quarter of a
/// period does not follow the rest. If it never does, the first from which as little is left as from any.
fn begin(samples: &[f64], start: usize, rough: [f64; 2]) -> Option<(usize, FirstFit)> {
    let period = std::f64::consts::TAU / rough[0];
    let mut found: Vec<(usize, FirstFit)> = Vec::new();
    let mut skipped = 0.0;
    while skipped <= BEGINS {
        let first = start + whole::index((skipped * period).round());
        let Some(fit) = samples.get(first..).and_then(|tail| first_fit(tail, rough)) else {
            break;
        };
        if fit.follows && fit.left < POOR {
            return Some((first, fit));
        }
        found.push((first, fit));
        skipped += LATER * (1.0f64 + skipped).floor();
    }
    let left = found.iter().map(|f| f.1.left);
    let least = left.fold(f64::INFINITY, f64::min);
    let follows = |f: &&(usize, FirstFit)| f.1.follows && least > FAR_LESS * f.1.left;
    let at = found.iter().find(follows).map(|f| f.0);
    let mut found = found.into_iter();
    match at {
        Some(first) => found.find(|f| f.0 == first),
        None => found.find(|f| f.1.left <= AS_LITTLE * least),
    }
}

/// A fit from a sample on.
struct FirstFit {
    /// Samples of each mean.
    factor: usize,
    point: Point,
    /// Whether its first quarter of a period follows the rest.
    follows: bool,
    /// What it leaves over the signal.
    left: f64,
}

fn first_fit(tail: &[f64], rough: [f64; 2]) -> Option<FirstFit> {
    let factor = factor(rough[0]);
    let most = whole::index((LOST / rough[1].abs().max(f64::MIN_POSITIVE)).min(1e9));
    let periods = tail.len() as f64 * rough[0] / std::f64::consts::TAU;
    if periods < LEAST_PERIODS {
        return None;
    }
    let tail = &tail[..tail.len().min(most.max(16 * factor)).min(MOST * factor)];
    let series = Series::plain(means(tail, factor));
    let rates = [rough[0] * factor as f64, rough[1] * factor as f64, 0.0, 0.0];
    let point = free(&series, rates)?;
    let residuals = series.residuals(&point);
    let quarter = std::f64::consts::TAU / point.rates[0] / 4.0;
    let quarter = whole::index(quarter.round()).max(2);
    let blocks: Vec<f64> = residuals.chunks(quarter).map(robust::rms).collect();
    let usual = robust::median(&blocks[1..])?;
    let left = robust::rms(&residuals) / point.level(series.values.len());
    Some(FirstFit {
        factor,
        follows: left < EXPLAINED && (blocks[0] <= NO_NOISE * usual || left < 1e-9),
        left,
        point,
    })
}

/// Number of samples until the decay is lost, or is no more than a step of the digits.
fn end(samples: &[f64], factor: usize, point: &Point) -> usize {
    let [a, b] = point.amplitudes();
    let amplitude = a.hypot(b);
    let step = columns::digit(samples);
    let sigma = point.rates[1].max(f64::MIN_POSITIVE);
    let lost = (LOST / sigma).min(1e9);
    let counted = if step > 0.0 && amplitude > 4.0 * step {
        ((amplitude / (1.5 * step)).ln() / sigma).min(1e9)
    } else {
        f64::INFINITY
    };
    let periods = 4.0 * std::f64::consts::TAU / point.rates[0];
    let least = periods.min(lost).max(16.0);
    let means = whole::index(lost.min(counted).max(least)).min(MOST);
    samples.len().min(means * factor)
}

/// Highest degree of a background.
const HIGHEST_DEGREE: usize = 3;

/// Find the background and the noise of a series, and the fit that leaves the rates free to change.
fn settle(series: &mut Series, start: &Point) -> Option<Point> {
    let shape = start.shape;
    let periods = series.values.len() as f64 * start.rates[0] / std::f64::consts::TAU;
    let highest = if periods > 4.0 { HIGHEST_DEGREE } else { 0 };
    let mut best: Option<(f64, Series, Point)> = None;
    for degree in 0..=highest {
        let mut own = Series {
            degree,
            noise: Noise::default(),
            ..series.clone()
        };
        let Some(point) = fitted(&mut own, shape, start) else {
            continue;
        };
        let criterion = own.criterion(&point);
        if best.as_ref().is_none_or(|b| criterion < b.0 - 4.0) {
            best = Some((criterion, own, point));
        } else if degree > 1 {
            break;
        }
    }
    let (criterion, own, point) = best?;
    *series = own;
    if shape != Shape::Bent {
        return Some(point);
    }
    Some(better(series, criterion, point))
}

/// A law of damping that the noise is better beside than the bent decay, if there is one.
fn better(series: &mut Series, criterion: f64, bent: Point) -> Point {
    let mut best = (criterion, series.clone(), bent.clone());
    let rubbed = series.descend(Shape::Rubbed, bent.rates);
    for point in laws(series, &bent).into_iter().chain(rubbed) {
        let mut own = series.clone();
        let Some(point) = fitted(&mut own, point.shape, &point) else {
            continue;
        };
        let criterion = own.criterion(&point);
        let strength = point.friction().unwrap_or(point.rates[3]);
        if strength > 0.0 && criterion < best.0 {
            best = (criterion, own, point);
        }
    }
    *series = best.1;
    best.2
}
