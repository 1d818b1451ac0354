//! A periodic record reduced to the few rows along which its model can move.
//!
//! Whatever the parameters are, a channel shows a sum of few functions of the phase θ since the impact
//! ([`Terms`]). Near reference parameters these are e^{iθ}, e^{κθ}θᵏ, the same times half the square of a
//! point's spread, and e^{−γθ}θᵏ, with κ and γ as they are there: of e^{κ'θ} = e^{κθ} Σ (κ' − κ)ᵏθᵏ/k! the
//! first terms suffice. Weighted residuals are projected orthogonally onto these functions, onto what is
//! measured and onto what effects change beside them, so that sums of squares and products stay as they are.

use crate::evidence::shared_error::Whitening;
use crate::evidence::waveform::{ChannelRates, Phases, Rates, Terms, Timing};
use crate::parameters::effect::Effect;
use crate::solver::rows::Rows;
use impact_oscillator::model::path::C64;
use impact_records::signal::columns::subtract;

/// Greatest change of κθ and γθ: what the series leave out is below 1e-11 of the motion then.
const REACH: f64 = 4e-3;

/// Powers of θ beside e^{κθ}, beside it times half the square of a spread, and beside e^{−γθ}.
const FREE: usize = 4;
const BENT: usize = 3;
const TAIL: usize = 3;

/// A record's weighted residuals and their slopes in few rows.
#[derive(Debug, Clone)]
pub struct ReducedRecord {
    impact_phase: f64,
    channels: Vec<Channel>,
    /// Rows of what is measured and of the effects beside the channels' functions.
    beside: usize,
    whitening: Whitening,
    measured: Vec<f64>,
    /// What the effects that act as extra accelerations change, per unit of their strengths.
    effects: Vec<(Effect, Vec<f64>)>,
}

/// The functions of one channel, projected.
#[derive(Debug, Clone)]
struct Channel {
    rates: ChannelRates,
    /// How much earlier and later the impact may be without passing a point, rad.
    room: [f64; 2],
    height: usize,
    /// One function after the other.
    functions: Vec<f64>,
}

/// What is known of a record at all of its points, over the points' errors and without the channels' offsets.
pub struct Weighted<'a> {
    /// Of each channel the phases of its points.
    pub phases: Vec<&'a Phases>,
    /// Measured values.
    pub measured: Vec<f64>,
    /// Change by each effect that acts as an extra acceleration, per unit of its strength.
    pub effects: Vec<(Effect, Vec<f64>)>,
    /// What makes them independent of the errors that all points share.
    pub whitening: &'a Whitening,
    /// Weighs values at the points of a channel.
    pub weigh: &'a dyn Fn(usize, &[f64]) -> Vec<f64>,
}

impl ReducedRecord {
    /// Of a record about a motion.
    pub fn new(points: &Weighted<'_>, rates: &Rates) -> Option<Self> {
        let changes = points.effects.iter().map(|(_, change)| change);
        let changes: Vec<&Vec<f64>> = changes.chain(points.whitening.directions()).collect();
        let mut projection = Projection::new(changes.len());
        let mut start = 0;
        for (i, (phases, channel)) in points.phases.iter().zip(&rates.channels).enumerate() {
            let functions: Vec<Vec<f64>> = functions(phases, &rates.timing, *channel)
                .iter()
                .map(|function| (points.weigh)(i, function))
                .collect();
            let range = start..start + functions.first()?.len();
            start = range.end;
            let others = changes.iter().map(|change| &change[range.clone()]);
            let others: Vec<&[f64]> = others.chain([&points.measured[range.clone()]]).collect();
            projection.add(&functions, &others, (*channel, room(phases, &rates.timing)));
        }
        let (channels, beside, mut vectors) = projection.finished();
        let mut measured = vectors.pop()?;
        let directions = vectors.split_off(points.effects.len());
        let whitening = points.whitening.along(directions);
        whitening.apply(&mut measured);
        vectors
            .iter_mut()
            .for_each(|change| whitening.apply(change));
        let effects = points.effects.iter().map(|(effect, _)| *effect);
        Some(Self {
            impact_phase: rates.timing.impact_phase,
            channels,
            beside,
            whitening,
            measured,
            effects: effects.zip(vectors).collect(),
        })
    }

    /// At a motion; `None` where it is too far from the reference.
    pub fn at(&self, rates: &Rates) -> Option<Reduced<'_>> {
        let later = rates.timing.impact_phase - self.impact_phase;
        let channels = self.channels.iter().zip(&rates.channels);
        let shifts: Option<Vec<Shift>> = channels
            .map(|(channel, to)| {
                let [earlier, latest] = channel.room;
                let passes = later <= -earlier || later >= latest;
                let shift = Shift::new((channel.rates, *to), &rates.timing, later)?;
                (!passes).then_some(shift)
            })
            .collect();
        Some(Reduced {
            record: self,
            shifts: shifts?,
        })
    }
}

/// A reduced record at a motion.
pub struct Reduced<'a> {
    record: &'a ReducedRecord,
    /// Of each channel.
    shifts: Vec<Shift>,
}

impl Reduced<'_> {
    /// Weighted change of the values whose terms are given, channel by channel.
    pub fn weighted(&self, terms: &[Terms]) -> Vec<f64> {
        let heights: usize = self.record.channels.iter().map(|c| c.height).sum();
        let mut out = vec![0.0; heights + self.record.beside];
        let mut rest = out.as_mut_slice();
        for (channel, (shift, terms)) in self
            .record
            .channels
            .iter()
            .zip(self.shifts.iter().zip(terms))
        {
            let own;
            (own, rest) = rest.split_at_mut(channel.height);
            if *terms == Terms::default() || channel.height == 0 {
                continue;
            }
            let functions = channel.functions.chunks_exact(channel.height);
            for (function, times) in functions.zip(shift.coefficients(terms)) {
                subtract(own, -times, function);
            }
        }
        self.record.whitening.apply(&mut out);
        out
    }

    /// Weighted change by an effect that acts as an extra acceleration, per unit of its strength.
    pub fn effect(&self, effect: Effect) -> Vec<f64> {
        let mut effects = self.record.effects.iter();
        let found = effects.find(|(e, _)| *e == effect);
        found.map_or_else(|| vec![0.0; self.record.measured.len()], |(_, c)| c.clone())
    }

    /// Weighted residuals of the values whose terms are given, with the effects at their strengths.
    pub fn residuals(&self, terms: &[Terms], strength: impl Fn(Effect) -> f64) -> Vec<f64> {
        let mut residuals = self.record.measured.clone();
        subtract(&mut residuals, 1.0, &self.weighted(terms));
        for (effect, change) in &self.record.effects {
            subtract(&mut residuals, strength(*effect), change);
        }
        residuals
    }
}

/// What takes terms at a motion to the functions at the reference.
struct Shift {
    eta: f64,
    /// How much later the impact is, rad.
    later: f64,
    /// e^{λt} and e^{−ct} in powers of θ beside e^{κθ} and e^{−γθ}.
    free: [C64; FREE],
    tail: [f64; TAIL],
}

impl Shift {
    /// From the rates at the reference to others; `None` out of reach.
    fn new((from, to): (ChannelRates, ChannelRates), timing: &Timing, later: f64) -> Option<Self> {
        let change = to.0 - from.0;
        let [gamma, gamma_to] = [from.1, to.1].map(|corner| corner.unwrap_or(0.0));
        let decay = gamma - gamma_to;
        if change.norm().max(decay.abs()) * timing.span() > REACH {
            return None;
        }
        let mut free = [(-to.0 * later).exp(); FREE];
        for k in 1..FREE {
            free[k] = free[k - 1] * change / k as f64;
        }
        let mut tail = [(gamma_to * later).exp(); TAIL];
        for k in 1..TAIL {
            tail[k] = tail[k - 1] * decay / k as f64;
        }
        Some(Self {
            eta: timing.eta,
            later,
            free,
            tail,
        })
    }

    /// Multiples of the functions, in their order.
    fn coefficients(&self, terms: &Terms) -> impl Iterator<Item = f64> {
        // a + bt with t = (θ − later)/η
        let growth = |b: C64| b / self.eta;
        let power = |[a, b]: [C64; 2], k: usize| {
            let constant = (a - growth(b) * self.later) * self.free[k];
            k.checked_sub(1)
                .map_or(constant, |k| constant + growth(b) * self.free[k])
        };
        let [constant, growing] = terms.tail;
        let growing = growing / self.eta;
        let tail = |k: usize| {
            let before = k.checked_sub(1).map_or(0.0, |k| growing * self.tail[k]);
            (constant - growing * self.later) * self.tail[k] + before
        };
        let free: [C64; FREE] = std::array::from_fn(|k| power(terms.free, k));
        let bent: [C64; BENT] = std::array::from_fn(|k| power(terms.bent, k));
        let tail: [f64; TAIL] = std::array::from_fn(tail);
        let complex = [terms.force].into_iter().chain(free).chain(bent);
        complex.flat_map(|c| [c.re, c.im]).chain(tail)
    }
}

/// The functions of a channel at its points.
fn functions(phases: &Phases, timing: &Timing, (kappa, gamma): ChannelRates) -> Vec<Vec<f64>> {
    let since: Vec<f64> = phases.since(timing.impact_phase, timing.span()).collect();
    let turns: Vec<C64> = phases.turns().map(|(turn, _)| turn).collect();
    let free: Vec<C64> = since.iter().map(|theta| (kappa * theta).exp()).collect();
    let halves = free.iter().zip(phases.turns());
    let bent: Vec<C64> = halves.map(|(free, (_, half))| free * half).collect();
    // Re(c f) = Re c · Re f − Im c · Im f
    let both = |f: &[C64]| {
        let real = f.iter().map(|f| f.re).collect();
        [real, f.iter().map(|f| -f.im).collect()]
    };
    let mut all: Vec<Vec<f64>> = both(&turns).into();
    for (function, powers) in [(free, FREE), (bent, BENT)] {
        for k in 0..powers {
            let pairs = function.iter().zip(&since);
            let grown: Vec<C64> = pairs.map(|(f, theta)| f * power(*theta, k)).collect();
            all.extend(both(&grown));
        }
    }
    if let Some(gamma) = gamma {
        for k in 0..TAIL {
            let tail = |theta: &f64| (-gamma * theta).exp() * power(*theta, k);
            all.push(since.iter().map(tail).collect());
        }
    }
    all
}

/// θᵏ
fn power(theta: f64, k: usize) -> f64 {
    (0..k).fold(1.0, |product, _| product * theta)
}

/// From the last point before an impact to it, and from it to the first point after, rad.
fn room(phases: &Phases, timing: &Timing) -> [f64; 2] {
    let since = || phases.since(timing.impact_phase, timing.span());
    let last = since().fold(0.0, f64::max);
    [timing.span() - last, since().fold(timing.span(), f64::min)]
}

/// Functions of the channels and vectors over all points, as they are projected channel by channel.
struct Projection {
    channels: Vec<Channel>,
    /// Of each vector its rows along the channels' functions, and those beside them.
    along: Vec<Vec<f64>>,
    beside: Vec<Vec<f64>>,
}

impl Projection {
    /// Of so many vectors beside what is measured.
    fn new(vectors: usize) -> Self {
        Self {
            channels: Vec::new(),
            along: vec![Vec::new(); vectors + 1],
            beside: vec![Vec::new(); vectors + 1],
        }
    }

    /// Add a channel: its functions, its part of all vectors, its rates and room.
    fn add(
        &mut self,
        functions: &[Vec<f64>],
        vectors: &[&[f64]],
        (rates, room): (ChannelRates, [f64; 2]),
    ) {
        let Some((last, others)) = vectors.split_last() else {
            return;
        };
        let others = others.iter().map(|v| v.to_vec());
        let columns: Vec<Vec<f64>> = functions.iter().cloned().chain(others).collect();
        let rows = Rows::of(last, &columns, 1.0);
        let filled = |i: usize| rows.column(i).iter().rposition(|x| *x != 0.0);
        let height = (0..functions.len())
            .filter_map(filled)
            .max()
            .map_or(0, |i| i + 1);
        for i in 0..vectors.len() {
            let (along, beside) = rows.column(functions.len() + i).split_at(height);
            self.along[i].extend_from_slice(along);
            self.beside[i].extend_from_slice(beside);
        }
        let own = (0..functions.len()).flat_map(|i| &rows.column(i)[..height]);
        self.channels.push(Channel {
            rates,
            room,
            height,
            functions: own.copied().collect(),
        });
    }

    /// The channels, the number of rows beside their functions, and the vectors.
    fn finished(self) -> (Vec<Channel>, usize, Vec<Vec<f64>>) {
        let Some((last, others)) = self.beside.split_last() else {
            return (self.channels, 0, self.along);
        };
        let rows = Rows::of(last, others, 1.0);
        let mut vectors = self.along;
        for (i, vector) in vectors.iter_mut().enumerate() {
            vector.extend_from_slice(rows.column(i));
        }
        (self.channels, rows.height(), vectors)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use crate::methods::trajectories::block::TrajectoryBlock;
    use crate::methods::trajectories::record_motion::RecordMotion;
    use crate::methods::trajectories::record_motion::tests::{parameters, record};
    use crate::parameters::effect::Effects;
    use crate::parameters::{Coordinate, Parameters};
    use crate::solver::Block;
    use crate::solver::normal::Normal;
    use impact_records::event::RigKind;

    const RIG: RigKind = RigKind::Double;

    /// Two records with noise of a thousandth of a m/s on what the model has at the parameters, whose
    /// effects and shared errors are known.
    fn block(at: &Parameters) -> TrajectoryBlock {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let measured = [record(1, 15.0), record(2, 31.0)].map(|mut record| {
            let motion = RecordMotion::new(RIG, &record, at).expect("an orbit");
            let values = motion.values();
            let channels = Arc::make_mut(&mut record.folded).channels.iter_mut();
            let points = channels.flat_map(|channel| {
                channel.noise = 1e-3;
                &mut channel.points
            });
            for (point, value) in points.zip(values) {
                point.value = value + 1e-3 * random.random_range(-1.0..1.0);
            }
            record
        });
        let mut block = TrajectoryBlock::of_records(RIG, measured.to_vec(), 1e-4);
        block.effects = Effects::all();
        block.find_changes(at);
        block
    }

    fn normal(block: &TrajectoryBlock, item: usize, at: &Parameters) -> Normal {
        let touched = |c: &Coordinate| block.item_touches(item, *c);
        let free: Vec<Coordinate> = Coordinate::all().filter(touched).collect();
        let places: Vec<usize> = (0..free.len()).collect();
        let rows = block.rows(item, at, &free, 1.0).expect("an orbit");
        rows.normal(&places, free.len())
    }

    #[test]
    fn prop_reduced_records_have_the_normal_equations_of_all_points() {
        let p = parameters();
        let all = block(&p);
        let mut reduced = all.clone();
        reduced.reduce(&p);
        let mut random = ChaCha8Rng::seed_from_u64(6);
        for item in [0, 0, 0, 1, 1, 1] {
            let record = &reduced.records[item];
            let rows = record.reduced.as_ref().expect("a reduced record");
            assert!(rows.measured.len() * 2 < record.points());
            let at = Coordinate::PHYSICAL.into_iter().fold(p, |at, c| {
                at.with(c, at.coordinate(c) + 2e-4 * random.random_range(-1.0..1.0))
            });
            let motion = RecordMotion::new(RIG, record, &at).expect("an orbit");
            assert!(rows.at(&motion.rates()).is_some());
            let (found, want) = (normal(&reduced, item, &at), normal(&all, item, &at));
            assert_eq!(found.count, want.count);
            assert!((found.cost - want.cost).abs() < 1e-7 * want.cost);
            let size = |i: usize| want.matrix[(i, i)].sqrt();
            for i in 0..want.gradient.len() {
                let apart = (found.gradient[i] - want.gradient[i]).abs();
                assert!(apart <= 1e-6 * size(i) * want.cost.sqrt(), "{i}");
                for k in 0..=i {
                    let apart = (found.matrix[(i, k)] - want.matrix[(i, k)]).abs();
                    assert!(apart <= 1e-6 * size(i) * size(k), "{i} {k}");
                }
            }
        }
    }

    #[test]
    fn out_of_reach_all_points_are_taken() {
        let p = parameters();
        let all = block(&p);
        let mut reduced = all.clone();
        reduced.reduce(&p);
        let far = p.with(
            Coordinate::Frequency,
            p.coordinate(Coordinate::Frequency) + 0.01,
        );
        let (found, want) = (normal(&reduced, 0, &far), normal(&all, 0, &far));
        assert_eq!((found.cost, found.matrix), (want.cost, want.matrix));
    }
}
