//! A free decay: offset + e^{−σt}(a cos `ω_d` t + b sin `ω_d` t), fitted by least squares in noise of any
//! colour, with a test whether one frequency and one damping ratio hold from its beginning to its end.
//!
//! All lengths are in periods. The fit begins with the greatest excursion, or later where the samples
//! after it are not those of the decay or are clipped, and ends where the decay is lost. Means over a few samples are fitted,
//! of which a period has some forty at least: they decay alike.

mod beat;
mod blows;
mod breaks;
mod change;
mod creep;
mod descent;
mod fits;
mod friction;
mod held;
mod hum;
mod least_squares;
mod modes;
mod natural;
mod noise;
mod onset;
mod prepared;
mod response;
mod shape;
mod watched;

use hum::Cleared;
use natural::{GROWS, Natural};
use prepared::{LEAST_PERIODS, Prepared};
use shape::Shape;

use crate::signal::{robust, whole};
use nalgebra::{Matrix5, Vector5};

pub use change::{Course, DampingLaw, Drift, LEAST_TESTED, PartOfDecay, RESOLVED};
pub use creep::comes_to_rest;
pub use friction::BesideFriction;
pub use onset::OpenOnset;
pub use prepared::Beside;
pub use watched::{MotionSignal, Rails, Watched};

/// A fitted free decay.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Decay {
    /// Natural frequency f0 = √(σ² + `ω_d²)/2π`, Hz.
    pub natural_frequency_hz: f64,
    /// Its standard error, Hz.
    pub natural_frequency_error_hz: f64,
    /// Damping ratio β = σ/√(σ² + `ω_d²`); noise may leave that of an undamped motion below zero.
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_error: f64,
    /// Degrees of freedom of both errors: independent values of the noise.
    #[serde(default)]
    pub freedom: f64,
    /// Amplitude at the first fitted sample, the samples' unit.
    pub amplitude: f64,
    /// Phase of the cosine there, rad.
    pub phase_rad: f64,
    /// Constant part, the samples' unit.
    pub offset: f64,
    /// Root mean square of the residual over that of the decay, beside dry friction where the damping follows it.
    pub residual_ratio: f64,
    /// The part of it that neighbouring samples share, so that it is no noise: another mode, damping that
    /// is not viscous.
    #[serde(default)]
    pub structured_ratio: f64,
    /// Residual of the first quarter of the fitted samples over that of the last: noise stays, what belongs to
    /// the decay fades with it.
    #[serde(default)]
    pub fading: f64,
    /// What lies under the decay and was fitted with it: a drift, a hum.
    #[serde(default)]
    pub beside: Beside,
    /// f0 and β where the damping may be dry friction in part; `None` if the fit beside it failed.
    #[serde(default)]
    pub beside_friction: Option<BesideFriction>,
    /// How frequency and damping ratio change along the decay.
    #[serde(default)]
    pub course: Course,
    /// The channel whose decay is given: the one that determines f0 best, by its place among those fitted.
    #[serde(default)]
    pub channel: usize,
    /// Periods that are fitted.
    #[serde(default)]
    pub periods: f64,
    /// First fitted sample.
    pub first: usize,
    /// Greatest excursion before that sample over the amplitude.
    #[serde(default)]
    pub before: f64,
    /// Number of fitted samples.
    pub samples: usize,
    /// When the motion was stopped, s from the record's first sample, if it was.
    #[serde(default)]
    pub stopped_s: Option<f64>,
}

impl Decay {
    /// The fitted decay at each of its samples, from the first fitted one on.
    pub fn values(&self, rate_hz: f64) -> Vec<f64> {
        let natural = std::f64::consts::TAU * self.natural_frequency_hz / rate_hz;
        let sigma = self.damping_ratio * natural;
        let omega = natural * (1.0 - self.damping_ratio.powi(2)).max(0.0).sqrt();
        let at = |i: usize| {
            let t = i as f64;
            let envelope = self.amplitude * (-sigma * t).exp();
            self.offset + envelope * (omega * t + self.phase_rad).cos()
        };
        (0..self.samples).map(at).collect()
    }

    /// A part of a record up to a number of periods of the decay, if that is before its end.
    fn part<'a>(&self, part: &Cleared<'a>, periods: f64, rate_hz: f64) -> Option<Cleared<'a>> {
        let frequency_hz = self.beside_friction?.natural_frequency_hz;
        let end = self.first + whole::index((periods / frequency_hz * rate_hz).ceil());
        (end < part.cleared.len()).then(|| part.between(0, end))
    }

    /// Count samples from an earlier one on.
    pub(crate) fn shift(&mut self, by: usize, rate_hz: f64) {
        self.first += by;
        self.stopped_s = self.stopped_s.map(|s| s + by as f64 / rate_hz);
    }

    /// Whether it is a motion of the oscillator of an earlier decay: of its frequency, as far as that is known, and not damped
    /// far more.
    fn goes_on(&self, earlier: &Self) -> bool {
        let error = self.natural_frequency_error_hz;
        let error = error.hypot(earlier.natural_frequency_error_hz);
        let apart = (self.natural_frequency_hz - earlier.natural_frequency_hz).abs();
        let of_both = self.damping_ratio_error.hypot(earlier.damping_ratio_error);
        let same = SAME * earlier.natural_frequency_hz;
        self.natural_frequency_error_hz < same
            && apart < same + GROWS * error
            && self.damping_ratio < 2.0 * earlier.damping_ratio.abs() + GROWS * of_both
    }

    /// Whether the amplitude does not fall by more than its error.
    pub fn is_undamped(&self) -> bool {
        self.damping_ratio < UNDAMPED * self.damping_ratio_error
    }

    /// Whether it is a motion that decays beyond doubt, and the only one of its channel.
    fn is_clear(&self) -> bool {
        let beside = [self.beside.hum, self.beside.mode];
        let other = beside
            .iter()
            .flatten()
            .any(|[_, ratio]| *ratio > CLEAR_LEAVES);
        let alone = !other && self.beside.beat.is_none();
        let fits = self.residual_ratio < CLEAR_LEAVES;
        alone && fits && self.periods >= SURE_PERIODS && !self.is_undamped()
    }

    /// Whether its frequency is another one beyond errors.
    fn is_unlike(&self, other: &Self) -> bool {
        let apart = (self.natural_frequency_hz / other.natural_frequency_hz).ln();
        let error = self.relative_error().hypot(other.relative_error());
        apart.abs() > UNLIKE + GROWS * error
    }

    /// Standard error of f0 over f0.
    pub fn relative_error(&self) -> f64 {
        self.natural_frequency_error_hz / self.natural_frequency_hz
    }
}

/// Damping ratio, in standard errors, below which a motion may be undamped.
const UNDAMPED: f64 = 2.0;

/// Fit the first free decay of the samples of one channel.
///
/// ```
/// use impact_records::signal::decay;
///
/// // f0 = 14 Hz, β = 0.02, released at t = 0.
/// let natural = std::f64::consts::TAU * 14.0;
/// let damped = natural * f64::sqrt(1.0 - 0.02 * 0.02);
/// let value = |t: f64| (-0.02 * natural * t).exp() * (damped * t).cos();
/// let samples: Vec<f64> = (0..2000).map(|i| value(f64::from(i) / 1000.0)).collect();
/// let found = decay::fit(&samples, 1000.0).unwrap();
/// assert!((found.natural_frequency_hz - 14.0).abs() < 1e-6);
/// assert!((found.damping_ratio - 0.02).abs() < 1e-6);
/// ```
pub fn fit(samples: &[f64], rate_hz: f64) -> Option<Decay> {
    fit_channels(&[Watched::displacement(samples)], rate_hz)
        .into_iter()
        .next()
}

/// Difference of the logarithms of f0 from which two channels show no motion of one oscillator.
const UNLIKE: f64 = 0.02;
/// Fewest periods, and greatest part of the signal that the fit leaves and that tones beside it are, with which a channel shows
/// a motion of its own.
const SURE_PERIODS: f64 = 10.0;
const CLEAR_LEAVES: f64 = 0.1;
/// Fewest periods of a decay that are told from what a curve leaves of creep, or from a part of another motion.
const CLEAR_PERIODS: f64 = 5.0;

/// Fit the free decays that several channels of equal length show, one after each blow or release: those of
/// the channel that determines f0 best, then those of others that clearly swing at another frequency.
///
/// Channels are often computed from each other, so that together they tell no more than the best one. Empty
/// with fewer than one and a half periods to fit, or if nothing decays.
pub fn fit_channels(channels: &[Watched<'_>], rate_hz: f64) -> Vec<Decay> {
    let of_channel = |(index, channel): (usize, &Watched<'_>)| {
        let mut decays = of_channel(*channel, rate_hz);
        decays.iter_mut().for_each(|d| d.channel = index);
        decays
    };
    let all = channels.iter().enumerate().map(of_channel);
    let mut all: Vec<Vec<Decay>> = all.filter(|decays| !decays.is_empty()).collect();
    let error = |decays: &[Decay]| best(decays).map_or(f64::INFINITY, Decay::relative_error);
    all.sort_by(|a, b| error(a).total_cmp(&error(b)));
    let mut all = all.into_iter();
    let mut found = all.next().unwrap_or_default();
    all.for_each(|others| append_unlike(&mut found, others));
    found
}

/// Add the decays of another channel, or of another mass, if they clearly are of another frequency than those found.
pub fn append_unlike(found: &mut Vec<Decay>, others: Vec<Decay>) {
    let both = best(&others).zip(best(found));
    if both.is_some_and(|(other, own)| other.is_clear() && other.is_unlike(own)) {
        found.extend(others);
    }
}

/// The decay that determines f0 best.
pub fn best(decays: &[Decay]) -> Option<&Decay> {
    let by_error = |a: &&Decay, b: &&Decay| a.relative_error().total_cmp(&b.relative_error());
    decays.iter().min_by(by_error)
}

/// How many times as much the decays may leave with steady tones taken away as without: more is left where the tones
/// are what a record in which the mass is first held has in common with an oscillation.
const MORE_LEFT: f64 = 2.0;

/// The decays of one channel, one after each blow. Where none is found: of what follows the last place at which the mass was
/// held, or of what is left without a drift.
fn of_channel(channel: Watched<'_>, rate_hz: f64) -> Vec<Decay> {
    let without = |drift: &dyn Fn(&[f64]) -> Vec<f64>| {
        let level = drift(channel.values);
        let channel = Watched {
            values: &level,
            ..channel
        };
        of_values(channel, rate_hz)
    };
    let found = of_values(channel, rate_hz);
    let found = or_else(found, || lasting(let_go(channel, rate_hz)));
    let found = or_else(found, || without(&without_line));
    // what the curve leaves of another one swings two or three times
    or_else(found, || lasting(without(&without_curve)))
}

/// Decays, or others if there are none.
fn or_else(found: Vec<Decay>, others: impl FnOnce() -> Vec<Decay>) -> Vec<Decay> {
    if found.is_empty() { others() } else { found }
}

/// Decays of periods enough to be told from what a part of another motion shows.
fn lasting(mut found: Vec<Decay>) -> Vec<Decay> {
    found.retain(|decay| decay.periods >= CLEAR_PERIODS);
    found
}

/// The decays after the last place at which the mass was held; a velocity does not show where that is.
fn let_go(channel: Watched<'_>, rate_hz: f64) -> Vec<Decay> {
    let places = channel.quantity == MotionSignal::Displacement;
    let Some(at) = places.then(|| held::let_go(channel.values)).flatten() else {
        return Vec::new();
    };
    let from = channel.clear_from(0..channel.values.len()).max(at);
    let later = Watched::new(&channel.values[from..], channel.quantity);
    if later.values.is_empty() {
        return Vec::new();
    }
    let mut found = of_values(later, rate_hz);
    found.iter_mut().for_each(|d| d.shift(from, rate_hz));
    found
}

/// Samples less the polynomial of the fourth degree that is nearest to them: what creeps to rest, as e^(−t/τ).
fn without_curve(samples: &[f64]) -> Vec<f64> {
    let last = samples.len().saturating_sub(1).max(1) as f64;
    let powers = |i: usize| {
        let x = 2.0 * i as f64 / last - 1.0;
        Vector5::from_fn(|k, _| x.powi(i32::try_from(k).unwrap_or(0)))
    };
    let mut squares = Matrix5::zeros();
    let mut products = Vector5::zeros();
    for (i, value) in samples.iter().enumerate() {
        let row = powers(i);
        squares += row * row.transpose();
        products += row * *value;
    }
    let Some(solved) = squares.cholesky().map(|c| c.solve(&products)) else {
        return samples.to_vec();
    };
    let values = samples.iter().enumerate();
    values.map(|(i, v)| v - powers(i).dot(&solved)).collect()
}

/// Samples less the straight line through the medians of their first and their last third.
fn without_line(samples: &[f64]) -> Vec<f64> {
    let third = samples.len() / 3;
    let ends = [&samples[..third], &samples[samples.len() - third..]].map(robust::median);
    let [Some(first), Some(last)] = ends else {
        return samples.to_vec();
    };
    let slope = (last - first) / (2.0 * third as f64);
    let line = |i: usize| first + slope * (i as f64 - 0.5 * third as f64);
    let values = samples.iter().enumerate();
    values.map(|(i, v)| v - line(i)).collect()
}

/// The decays of the samples of one channel.
fn of_values(channel: Watched<'_>, rate_hz: f64) -> Vec<Decay> {
    let cleared = Cleared::of(channel);
    let decays = of_blows(&cleared, rate_hz);
    if cleared.tones.is_empty() {
        return decays;
    }
    let plain = of_blows(&Cleared::plain(channel), rate_hz);
    // a tone that is found once more is no decay
    let is_tone = |d: &Decay| {
        let omega = std::f64::consts::TAU * d.natural_frequency_hz / rate_hz;
        cleared.is_tone([omega, 0.0], d.samples) && d.is_undamped()
    };
    let leaves_more = left(&decays, rate_hz) > MORE_LEFT * left(&plain, rate_hz);
    if leaves_more && !plain.iter().all(is_tone) {
        plain
    } else {
        decays
    }
}

/// Root mean square of what decays leave of the samples that they are fitted to; infinite without a decay.
fn left(decays: &[Decay], rate_hz: f64) -> f64 {
    let squares = |d: &Decay| {
        let own = d
            .values(rate_hz)
            .iter()
            .map(|v| (v - d.offset).powi(2))
            .sum::<f64>();
        d.residual_ratio.powi(2) * own
    };
    let samples: usize = decays.iter().map(|d| d.samples).sum();
    if samples == 0 {
        return f64::INFINITY;
    }
    (decays.iter().map(squares).sum::<f64>() / samples as f64).sqrt()
}

/// The decays of a channel, one after each blow.
fn of_blows(whole: &Cleared<'_>, rate_hz: f64) -> Vec<Decay> {
    let of_part = |(begin, last): (usize, usize)| {
        let first = whole.channel.clear_from(begin..last);
        let mut decays = of_motions(&whole.between(first, last), rate_hz);
        decays.iter_mut().for_each(|d| d.shift(first, rate_hz));
        decays
    };
    let parts = blows::parts(&whole.cleared).into_iter();
    parts.flat_map(of_part).collect()
}

/// The decays of a part of a record: one, or one before each moment at which the motion breaks off and the last one.
fn of_motions(part: &Cleared<'_>, rate_hz: f64) -> Vec<Decay> {
    let split = breaks::find(part).map(|end| {
        let count = part.cleared.len();
        let mut before = of_part(&part.between(0, end), rate_hz);
        let mut after = of_motions(&part.between(end, count), rate_hz);
        after.iter_mut().for_each(|d| d.shift(end, rate_hz));
        if let Some(before) = &mut before {
            // a hand on the mass is no damping of the rig
            after.retain(|d| d.goes_on(before));
            if after.is_empty() {
                before.stopped_s = Some(end as f64 / rate_hz);
            }
        }
        before.into_iter().chain(after).collect::<Vec<Decay>>()
    });
    let split = split.filter(|decays| !decays.is_empty());
    split.unwrap_or_else(|| of_part(part, rate_hz).into_iter().collect())
}

/// What a decay leaves, over itself, at most: of what neighbouring samples share, and of all.
const MOST_LEFT: f64 = 1.0;
const MOST_NOISE: f64 = 4.0;
/// Relative difference of the frequencies of motions of one oscillator, at most.
const SAME: f64 = 0.02;

/// The decay of a part of a record with one blow or release, up to where dry friction holds the mass or something begins to
/// rub on the way, if it does: what follows is no part of the motion.
fn of_part(part: &Cleared<'_>, rate_hz: f64) -> Option<Decay> {
    let decay = fitted(part, rate_hz)?;
    let decay = until_rest(part, &decay, rate_hz).unwrap_or(decay);
    let before = before_rub(part, &decay, rate_hz);
    Some(before.unwrap_or(decay))
}

/// A decay of a part up to where dry friction holds the mass.
fn until_rest(part: &Cleared<'_>, decay: &Decay, rate_hz: f64) -> Option<Decay> {
    let moving = decay.beside_friction?.rest()?;
    let mut cut = fitted(&decay.part(part, moving, rate_hz)?, rate_hz)?;
    cut.beside_friction.as_mut()?.sticks = true;
    Some(cut)
}

/// A decay of a part up to where something begins to rub; `None` where another decay beside it explains the whole.
fn before_rub(part: &Cleared<'_>, decay: &Decay, rate_hz: f64) -> Option<Decay> {
    if decay.beside.beat.is_some() {
        return None;
    }
    let friction = decay.beside_friction?;
    let before = decay.part(part, friction.unchanged?, rate_hz)?;
    let mut cut = of_part(&before, rate_hz)?;
    let own = cut.beside_friction.as_mut()?;
    own.begins = own.begins.or(friction.begins);
    Some(cut)
}

/// Greatest excursion of samples from an offset.
fn greatest(samples: &[f64], offset: f64) -> f64 {
    samples
        .iter()
        .map(|v| (v - offset).abs())
        .fold(0.0, f64::max)
}

/// The decay of a part of a record with one blow or release.
fn fitted(part: &Cleared<'_>, rate_hz: f64) -> Option<Decay> {
    let prepared = Prepared::of(part)?;
    let series = &prepared.series;
    let viscous = series.descend(Shape::Viscous, prepared.free.rates)?;
    let rms = (viscous.squares / prepared.degrees(&viscous)?).sqrt();
    let covariance = series.covariance(&viscous)?;
    let error_of_sigma = covariance[(1, 1)].sqrt();
    if viscous.rates[1] < -GROWS * error_of_sigma || !prepared.stands_out(&viscous, rms) {
        return None;
    }
    let natural = Natural::of(&viscous.rates, &covariance);
    let hz = rate_hz / prepared.factor as f64;
    let whole = prepared.at_every_sample(&viscous)?;
    // white noise may be greater than the decay, from which its many samples tell it
    if !(whole.structured_ratio < MOST_LEFT && whole.residual_ratio < MOST_NOISE) {
        return None;
    }
    // where dry friction is what the damping follows, what it leaves beside friction is what is not explained
    let explained = Some(&prepared.free).filter(|free| free.shape == Shape::Rubbed);
    let explained = explained.and_then(|free| prepared.at_every_sample(free));
    let explained = explained.filter(|e| e.residual_ratio < whole.residual_ratio);
    let explained = explained.as_ref().unwrap_or(&whole);
    let beside_friction = friction::beside(&prepared, &viscous, hz);
    let periods = whole.samples as f64 * natural.frequency / prepared.factor as f64;
    let moving = beside_friction.filter(|b| b.sticks);
    if moving.map_or(periods, |b| b.periods) < LEAST_PERIODS {
        return None;
    }
    Some(Decay {
        natural_frequency_hz: natural.frequency * hz,
        natural_frequency_error_hz: natural.frequency_error * hz,
        damping_ratio: natural.damping_ratio,
        damping_ratio_error: natural.damping_ratio_error,
        freedom: series.freedom(&viscous),
        amplitude: whole.amplitude,
        phase_rad: whole.phase_rad,
        offset: whole.offset,
        residual_ratio: explained.residual_ratio,
        structured_ratio: explained.structured_ratio,
        fading: explained.fading,
        beside: prepared.beside(whole.amplitude, rate_hz),
        beside_friction,
        course: change::course(&prepared, &viscous, rate_hz),
        channel: 0,
        periods,
        first: prepared.first,
        before: greatest(&part.cleared[..prepared.first], whole.offset) / whole.amplitude,
        samples: whole.samples,
        stopped_s: None,
    })
}

#[cfg(test)]
mod tests;
