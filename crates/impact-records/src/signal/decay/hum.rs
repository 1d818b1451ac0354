//! Steady tones under a decay: a hum outlasts the decay, so that over the whole record it may be stronger.

use super::blows;
use super::fits::{Rough, peak, rough};
use super::modes::{self, Fitted, Mode, STEADY};
use super::watched::Watched;
use crate::signal::{columns, robust, whole};

/// Most oscillations that are looked for.
const MOST: usize = 4;
/// Rounds in which all are fitted again beside each other.
const ROUNDS: usize = 2;
/// Parts of a record of which the quietest is looked at, at most, and turns of a tone in each, at least.
const PARTS: usize = 32;
const LEAST_TURNS: f64 = 3.0;
/// Chance that noise alone shows an oscillation as strong as a decay.
const BY_CHANCE: f64 = 1e-6;

/// Samples of a channel, the same less the steady tones under its decays, and the rates of these tones.
#[derive(Debug, Clone)]
pub(super) struct Cleared<'a> {
    pub(super) channel: Watched<'a>,
    pub(super) cleared: Vec<f64>,
    pub(super) tones: Vec<[f64; 2]>,
}

impl<'a> Cleared<'a> {
    /// Samples under which nothing is looked for.
    pub(super) fn plain(channel: Watched<'a>) -> Self {
        Self {
            channel,
            cleared: channel.values.to_vec(),
            tones: Vec::new(),
        }
    }

    /// Find the steady tones. They are of the surroundings if what is left of the samples without them begins with a
    /// decay of a greater amplitude; else they are the motion.
    pub(super) fn of(channel: Watched<'a>) -> Self {
        let samples = channel.values;
        let found = all(samples);
        let steady = |f: &&Fitted| is_steady(f.mode.rates, samples.len());
        let (tones, others): (Vec<&Fitted>, Vec<&Fitted>) = found.iter().partition(steady);
        let of_surroundings = |tone: &&&Fitted| {
            let mut others = others.iter();
            others.all(|o| is_apart(&tone.mode, (o.mode.rates, o.mode.amplitude), samples.len()))
        };
        let tones = tones.iter().filter(of_surroundings).copied();
        let tones: Vec<&Fitted> = tones.filter(|t| is_throughout(samples, t)).collect();
        let mut cleared = samples.to_vec();
        for tone in &tones {
            columns::subtract(&mut cleared, 1.0, &tone.values);
        }
        let tones: Vec<Mode> = tones.iter().map(|t| t.mode).collect();
        if tones.is_empty() || !decays(&cleared, &tones) {
            return Self::plain(channel);
        }
        Self {
            channel,
            cleared,
            tones: tones.iter().map(|t| t.rates).collect(),
        }
    }

    /// Whether an oscillation in a number of samples is one of the tones.
    pub(super) fn is_tone(&self, rates: [f64; 2], count: usize) -> bool {
        let near =
            |tone: &[f64; 2]| (tone[0] - rates[0]).abs() <= modes::width(*tone, count as f64);
        self.tones.iter().any(near)
    }

    /// The samples between two.
    pub(super) fn between(&self, first: usize, last: usize) -> Self {
        // what is clipped has been left out where the record was parted
        let values = &self.channel.values[first..last];
        let channel = Watched::new(values, self.channel.quantity);
        Self {
            channel,
            cleared: self.cleared[first..last].to_vec(),
            tones: self.tones.clone(),
        }
    }
}

/// The strongest oscillation of samples.
fn strongest(samples: &[f64]) -> Option<Rough> {
    rough(samples, peak(samples)?)
}

/// The strongest oscillations of samples, each fitted beside the others.
fn all(samples: &[f64]) -> Vec<Fitted> {
    let mut found: Vec<Fitted> = Vec::new();
    let count = samples.len() as f64;
    for _ in 0..MOST {
        let rest = modes::less(samples, &found);
        let next = strongest(&rest).filter(Rough::stands_out);
        let Some(next) = next.and_then(|n| modes::fitted(&rest, n.rates)) else {
            break;
        };
        let rates = next.mode.rates;
        // what is left of one that was found is none
        if found
            .iter()
            .any(|f| modes::are_one(f.mode.rates, rates, count))
        {
            break;
        }
        found.push(next);
        for _ in 0..if found.len() > 1 { ROUNDS } else { 0 } {
            modes::fit_again(&mut found, |found| Some(modes::less(samples, found)));
        }
    }
    found
}

impl Rough {
    /// Whether noise shows an oscillation as strong only by chance: as many frequencies as there are values are tried, and
    /// the squares that each takes are twice an exponential variable of the noise's variance (Fisher 1929).
    fn stands_out(&self) -> bool {
        self.gain > 2.0 * (self.count as f64 / BY_CHANCE).ln()
    }
}

/// Whether a tone is in the quietest part of samples too, as what a fit finds in decays that follow each other is not: with
/// the tone taken from it, such a part has as much less energy as the tone has, else as much more.
fn is_throughout(samples: &[f64], tone: &Fitted) -> bool {
    let turn = std::f64::consts::TAU / tone.mode.rates[0];
    let length = whole::index((LEAST_TURNS * turn).ceil()).max(samples.len() / PARTS);
    let energy = robust::squares_about_mean;
    let parts = samples.chunks_exact(length.min(samples.len()));
    let parts = parts.zip(tone.values.chunks_exact(length.min(samples.len())));
    let quietest = parts.min_by(|a, b| energy(a.0).total_cmp(&energy(b.0)));
    quietest.is_some_and(|(own, values)| {
        let mut rest = own.to_vec();
        columns::subtract(&mut rest, 1.0, values);
        energy(&rest) < energy(own)
    })
}

/// Whether an oscillation neither decays nor grows over a number of samples.
fn is_steady(rates: [f64; 2], count: usize) -> bool {
    rates[1].abs() * (count as f64) < STEADY
}

/// Whether a tone is neither the oscillation of other rates and an amplitude nor an odd harmonic of it by dry friction. Under
/// a square wave of amplitude r ≤ A the harmonic k of a motion of amplitude A has no more than 4 A/(π k (k² − 1)).
fn is_apart(tone: &Mode, (other, amplitude): ([f64; 2], f64), count: usize) -> bool {
    let multiple = tone.rates[0] / other[0];
    let number = 1.0 + 2.0 * (0.5 * (multiple - 1.0)).round().max(0.0);
    let near =
        |k: f64| (tone.rates[0] - k * other[0]).abs() <= modes::width(tone.rates, count as f64);
    let most = 4.0 * amplitude / (std::f64::consts::PI * number * (number * number - 1.0));
    !(near(1.0) || near(number) && tone.amplitude <= most)
}

/// Whether a decay of a greater amplitude than that of tones is among samples.
fn decays(samples: &[f64], tones: &[Mode]) -> bool {
    let of_part = |(first, last): (usize, usize)| {
        let part = &samples[first..last];
        let tail = &part[blows::begin(part)?.1..];
        let found = strongest(blows::lasting(tail))?;
        // a fit to what rounding leaves of a tone may extrapolate to any amplitude
        let (low, high) = robust::range(tail.iter().copied())?;
        let amplitude = found.amplitude.min(high - low);
        let differs = |tone: &Mode| {
            is_apart(tone, (found.rates, amplitude), samples.len()) && amplitude > tone.amplitude
        };
        let decays = found.rates[1] * tail.len() as f64 > STEADY;
        Some(decays && found.stands_out() && tones.iter().all(differs))
    };
    let mut parts = blows::parts(samples).into_iter();
    parts.any(|part| of_part(part) == Some(true))
}
