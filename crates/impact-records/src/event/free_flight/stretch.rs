//! The stretch of a record beside an impact that free flight explains.

use crate::event::free_flight::drag::{self, Drag, Loss, Shown};
use crate::event::free_flight::fall::Fall;
use crate::event::kinematics::{Body, Series};
use crate::signal::local_fit::LocalFit;
use crate::signal::whole;

/// Most samples of a stretch.
const MOST: usize = 1500;
/// Samples beside a fall that may still belong to the contact, beside its own.
const BESIDE: usize = 4;
/// Relative scatter of a speed beside the noise: wheels, rails and rolling friction are uneven.
const UNEVEN: f64 = 4e-3;
/// Scatter about a flight, in standard deviations of the noise, above which it is none.
const IN_NOISE: f64 = 2.0;
/// F of one more power of time above which a stretch is no flight.
const BENT: f64 = 16.0;
/// Standard errors by which the speed beside a fall may differ between a stretch and the parts of it next to the fall.
const KINKED: f64 = 3.0;
/// Those up to which chance makes them differ; what is beyond leaves the speed open.
const CHANCE: f64 = 2.0;
/// Those parts, as shares of the stretch.
const NEAREST: [f64; 4] = [0.5, 0.25, 0.125, 0.0625];
/// Standard errors of a velocity from which a sample moves.
const MOVES: f64 = 4.0;
/// Samples by which a stretch is shortened: one in this many.
const STEP: usize = 8;
/// Samples from which a flight shows how its velocity bends.
const MANY: usize = 16;
/// Standard error of a speed beside all others, relative.
const SPEED_SCATTER: f64 = 1e-3;

/// What all flights of a record have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// The greatest speed, m/s.
    pub greatest_m_s: f64,
    /// Drag of the air.
    pub drag: Drag,
}

/// Which flight beside a fall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Before,
    After,
}

/// What is fitted of a flight.
#[derive(Debug, Clone, Copy)]
struct Measured {
    /// Whether it is the displacement, m, else the velocity, m/s.
    is_displacement: bool,
    /// Samples per second, Hz.
    rate_hz: f64,
}

impl Measured {
    /// Velocity of a fit at a time in samples, m/s.
    fn velocity(self, fit: &LocalFit, time: f64) -> f64 {
        if self.is_displacement {
            fit.slope(time) * self.rate_hz
        } else {
            fit.value(time)
        }
    }

    /// Standard error of that velocity over the deviation of the noise.
    fn velocity_error_factor(self, fit: &LocalFit, time: f64) -> f64 {
        if self.is_displacement {
            fit.slope_error_factor(time) * self.rate_hz
        } else {
            fit.error_factor(time)
        }
    }

    /// What drag of 1/m takes from it by a time in samples.
    fn lost(self, loss: &Loss, time: f64) -> f64 {
        if self.is_displacement {
            loss.of_displacement(time)
        } else {
            loss.of_velocity(time) * self.rate_hz
        }
    }
}

/// A stretch of free flight.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    fit: LocalFit,
    measured: Measured,
    /// Standard deviation of the fitted signal about the flight, as far as independent.
    deviation: f64,
    /// Standard deviation of the speed beside the fall between stretches that begin elsewhere, beyond their
    /// errors, m/s.
    unlike: f64,
    /// What drag takes, per unit of it, and the drag.
    loss: (Loss, Drag),
    /// Velocity beside the fall over the drag that is assumed, m/s for 1/m.
    by_drag: f64,
    /// What it shows of the drag.
    pub shown: Option<Shown>,
    /// First sample and the one after the last.
    pub samples: (usize, usize),
}

impl Stretch {
    /// Velocity at a time in samples, m/s.
    pub(super) fn speed(&self, time: f64) -> f64 {
        let (loss, drag) = self.loss;
        let lost = drag.per_m * loss.of_velocity(time) * self.measured.rate_hz;
        self.measured.velocity(&self.fit, time) - lost
    }

    /// Change of the velocity per sample.
    pub(super) fn step(&self, time: f64) -> f64 {
        self.speed(time + 0.5) - self.speed(time - 0.5)
    }

    /// Change of the velocity per sample where it stands out of the noise by a number of standard errors: of the
    /// slope of a line, 12/(n(n² − 1)), or of twice the square's factor of a parabola, 720/(n(n² − 1)(n² − 4)),
    /// times the variance of the noise.
    pub(super) fn sure_step(&self, time: f64, deviates: f64) -> f64 {
        let count = (self.samples.1 - self.samples.0) as f64;
        let squared = count * count;
        let (factor, rate_hz) = if self.measured.is_displacement {
            (720.0 / (squared - 4.0), self.measured.rate_hz)
        } else {
            (12.0, 1.0)
        };
        let error = self.deviation * rate_hz * (factor / (count * (squared - 1.0))).sqrt();
        let step = self.step(time);
        if step.abs() > deviates * error {
            step
        } else {
            0.0
        }
    }

    /// Standard error of the velocity at a time by the noise, m/s.
    fn noise_error(&self, time: f64) -> f64 {
        self.deviation * self.measured.velocity_error_factor(&self.fit, time)
    }

    /// Standard error of the velocity at a time, m/s.
    pub(super) fn error(&self, time: f64) -> f64 {
        let by_drag = self.by_drag * self.loss.1.error_per_m;
        self.own_error(time).hypot(self.unlike).hypot(by_drag)
    }

    /// The same without what other stretches leave open.
    fn own_error(&self, time: f64) -> f64 {
        self.noise_error(time)
            .hypot(SPEED_SCATTER * self.speed(time).abs())
    }

    /// The fitted displacement, if it is the one that is fitted.
    pub(super) fn displacement(&self) -> Option<&LocalFit> {
        self.measured.is_displacement.then_some(&self.fit)
    }
}

/// What is fitted: a signal, the degree of its flights, its scatter beside the noise.
struct Signal<'a> {
    values: &'a [f64],
    degree: usize,
    least: usize,
    noise: f64,
    measured: Measured,
    /// Middle of the fall, samples.
    middle: f64,
    drag: Drag,
}

impl<'a> Signal<'a> {
    /// The velocity as measured; a displacement where the velocity was derived from it.
    fn of(body: &'a Body, middle: f64, scale: Scale) -> Option<Self> {
        let Scale {
            rate_hz,
            greatest_m_s,
            drag,
        } = scale;
        let velocity = body.velocity.as_ref()?;
        let derived = |d: &&Series| d.role == velocity.role;
        Some(match body.displacement.as_ref().filter(derived) {
            Some(displacement) => Self {
                values: &displacement.values,
                degree: 2,
                least: 6,
                noise: displacement.noise,
                measured: Measured {
                    is_displacement: true,
                    rate_hz,
                },
                middle,
                drag,
            },
            None => Self {
                values: &velocity.values,
                degree: 1,
                least: 4,
                noise: velocity.noise.max(UNEVEN * greatest_m_s),
                measured: Measured {
                    is_displacement: false,
                    rate_hz,
                },
                middle,
                drag,
            },
        })
    }

    /// The longest stretch of a window that free flight explains and that is one with its part beside the fall and with
    /// itself bent by one more power of time: a push that ends within it, or drag, bends it too little to be seen in its
    /// scatter.
    fn longest(&self, side: Side, (first, last): (usize, usize)) -> Option<Stretch> {
        let nearest = |count: usize| match side {
            Side::Before => (last - count, last),
            Side::After => (first, first + count),
        };
        let edge = match side {
            Side::Before => last as f64,
            Side::After => first as f64,
        };
        let mut count = last - first;
        while count >= self.least {
            if let Some(stretch) = self.flight(nearest(count)) {
                let parts = NEAREST.map(|share| whole::index((share * count as f64).round()));
                let parts = parts.into_iter().filter(|part| *part >= self.least);
                let parts = parts.filter_map(|part| self.flight(nearest(part)));
                let others = parts.chain(self.bent(&stretch));
                let kinks: Vec<Kink> = others
                    .map(|other| Kink::of(&stretch, &other, edge))
                    .collect();
                if kinks.iter().all(|kink| kink.deviates <= KINKED) {
                    let unlike = kinks.iter().map(|kink| kink.beyond_m_s);
                    return Some(Stretch {
                        unlike: unlike.fold(0.0, f64::max),
                        ..stretch
                    });
                }
            }
            count -= (count / STEP).max(1);
        }
        None
    }

    /// A stretch with one more power of time.
    fn bent(&self, stretch: &Stretch) -> Option<Stretch> {
        Some(self.fitted(stretch.samples, self.degree + 1)?.stretch(self))
    }

    /// A polynomial through samples as they would be without drag; `None` of too few.
    fn fitted(&self, samples: (usize, usize), degree: usize) -> Option<Fitted> {
        let (first, last) = samples;
        let freedom = (last.min(self.values.len()) - first).checked_sub(degree + 1)?;
        let (loss, fit) = if self.drag == Drag::default() {
            let fit = LocalFit::new(self.values, first, last, degree)?;
            (Loss::default(), fit)
        } else {
            let loss = self.loss(samples)?;
            let values = self.without_drag(samples, &loss);
            (loss, LocalFit::through(&values, first, degree)?)
        };
        (freedom > 0).then(|| Fitted {
            scatter: (fit.residual_squares / freedom as f64).sqrt(),
            freedom: freedom as f64,
            fit,
            loss,
            samples,
        })
    }

    /// What drag takes from a flight from the fall on, by the parabola of its velocity, of few samples the line.
    fn loss(&self, (first, last): (usize, usize)) -> Option<Loss> {
        let more = usize::from(last - first >= MANY);
        let fit = LocalFit::new(self.values, first, last, self.degree + more)?;
        let middle = 0.5 * (first + last) as f64;
        let velocity = |time: f64| self.measured.velocity(&fit, time) / self.measured.rate_hz;
        let [before, at, after] = [-1.0, 0.0, 1.0].map(|by| velocity(middle + by));
        let derivatives = [at, 0.5 * (after - before), after - 2.0 * at + before];
        Some(Loss::new(self.middle, middle, derivatives))
    }

    fn without_drag(&self, (first, last): (usize, usize), loss: &Loss) -> Vec<f64> {
        let range = first..last.min(self.values.len());
        let without =
            |i: usize| self.values[i] + self.drag.per_m * self.measured.lost(loss, i as f64);
        range.map(without).collect()
    }

    /// A stretch with what it shows of the drag, and what that changes of it.
    fn with_drag(&self, stretch: Stretch) -> Stretch {
        let (first, last) = stretch.samples;
        let Some(loss) = self.loss(stretch.samples) else {
            return stretch;
        };
        let lost = (first..last).map(|i| self.measured.lost(&loss, i as f64));
        let lost: Vec<f64> = lost.collect();
        let values = self.without_drag(stretch.samples, &loss);
        let residuals = values.iter().zip(first..);
        let residuals = residuals.map(|(value, i)| value - stretch.fit.value(i as f64));
        let residuals: Vec<f64> = residuals.collect();
        let shown = drag::shown(&residuals, &lost, self.degree, stretch.deviation);
        let by_drag = LocalFit::through(&lost, first, self.degree);
        let by_drag = by_drag.map_or(0.0, |fit| self.measured.velocity(&fit, self.middle));
        Stretch {
            by_drag,
            shown: shown.map(|shown| Shown {
                per_m: shown.per_m + self.drag.per_m,
                ..shown
            }),
            ..stretch
        }
    }

    /// A fit of samples that free flight explains; `None` where it does not.
    fn flight(&self, samples: (usize, usize)) -> Option<Stretch> {
        let fitted = self.fitted(samples, self.degree)?;
        if fitted.scatter > IN_NOISE * self.noise {
            return None;
        }
        if fitted.freedom >= 2.0 {
            let bent = self.fitted(samples, self.degree + 1)?;
            let left = bent.scatter.powi(2).max(0.25 * self.noise.powi(2));
            if (fitted.fit.residual_squares - bent.fit.residual_squares) / left > BENT {
                return None;
            }
        }
        Some(fitted.stretch(self))
    }
}

/// A polynomial through samples.
struct Fitted {
    fit: LocalFit,
    /// Standard deviation about it.
    scatter: f64,
    freedom: f64,
    loss: Loss,
    samples: (usize, usize),
}

impl Fitted {
    fn stretch(self, of: &Signal<'_>) -> Stretch {
        let (first, _) = self.samples;
        let values = of.without_drag(self.samples, &self.loss);
        let correlated = correlation(&values, &self.fit, first);
        Stretch {
            fit: self.fit,
            measured: of.measured,
            deviation: self.scatter.max(0.5 * of.noise) * correlated,
            unlike: 0.0,
            loss: (self.loss, of.drag),
            by_drag: 0.0,
            shown: None,
            samples: self.samples,
        }
    }
}

/// How far the speeds of a stretch and of a part of it, or of it bent, differ beside the fall.
struct Kink {
    /// In standard errors of the difference.
    deviates: f64,
    /// Beyond its standard error, m/s.
    beyond_m_s: f64,
}

impl Kink {
    /// The variance of the difference of two nested fits is that of their variances, both by the scatter about the part,
    /// which what is no flight has not enlarged.
    fn of(whole: &Stretch, part: &Stretch, time: f64) -> Self {
        let apart = (whole.speed(time) - part.speed(time)).abs();
        let same_scatter = part.deviation / whole.deviation;
        let variance =
            part.noise_error(time).powi(2) - (same_scatter * whole.noise_error(time)).powi(2);
        let expected = variance.max(0.0) + (SPEED_SCATTER * whole.speed(time)).powi(2);
        let deviates = apart / expected.sqrt().max(f64::MIN_POSITIVE);
        Self {
            deviates,
            beyond_m_s: if deviates > CHANCE {
                (apart.powi(2) - expected).sqrt()
            } else {
                0.0
            },
        }
    }
}

/// Factor on a standard error for residuals that are correlated with their neighbours.
fn correlation(values: &[f64], fit: &LocalFit, first: usize) -> f64 {
    let residuals = values.iter().zip(first..);
    let residuals: Vec<f64> = residuals.map(|(v, i)| v - fit.value(i as f64)).collect();
    let products: f64 = residuals.windows(2).map(|w| w[0] * w[1]).sum();
    let share = products / fit.residual_squares.max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 0.8);
    ((1.0 + share) / (1.0 - share)).sqrt()
}

/// The longest stretch beside a fall that free flight explains: a line of the velocity or a parabola
/// of the displacement.
///
/// `rings`: samples after the fall in which its bumpers may ring; `bounds`: samples between the neighbouring falls. Samples
/// beside the fall that still belong to the contact are left out; of the possible stretches the one
/// with the least error at the fall's middle is taken.
pub(super) fn find(
    body: &Body,
    (side, rings): (Side, usize),
    fall: Fall,
    bounds: (usize, usize),
    scale: Scale,
) -> Option<Stretch> {
    let middle = 0.5 * (fall.first + fall.last) as f64;
    let signal = Signal::of(body, middle, scale)?;
    let velocity = body.velocity.as_ref()?;
    let greatest_m_s = scale.greatest_m_s;
    let beside = BESIDE + (fall.last - fall.first) / 2;
    // what rings after the contact goes on for several times as long
    let ringing = match side {
        Side::Before => beside,
        Side::After => beside.max(rings),
    };
    let later = std::iter::successors(Some(0), |s| Some(s + s / 4 + 1));
    let later = later.take_while(|s| *s <= ringing);
    let stretches = later.filter_map(|skipped| {
        signal.longest(
            side,
            window(velocity, side, fall, bounds, (skipped, greatest_m_s))?,
        )
    });
    let stretches: Vec<Stretch> = stretches.collect();
    let best = stretches
        .iter()
        .min_by(|a, b| a.error(middle).total_cmp(&b.error(middle)))?;
    let edge = match side {
        Side::Before => fall.first,
        Side::After => fall.last,
    };
    Some(signal.with_drag(Stretch {
        unlike: best.unlike.hypot(unlike(&stretches, best, edge as f64)),
        ..best.clone()
    }))
}

/// How far the speeds of the stretches that overlap the best one are from its own beyond their errors: bumpers that
/// ring and friction that changes make flights that look straight but are not the same. What a hand does before or
/// after is no part of the flight.
fn unlike(stretches: &[Stretch], best: &Stretch, time: f64) -> f64 {
    let (mut weights, mut squares) = (0.0, 0.0);
    let overlaps =
        |one: &&Stretch| one.samples.0 < best.samples.1 && best.samples.0 < one.samples.1;
    for one in stretches.iter().filter(overlaps) {
        let variance = one.own_error(time).powi(2);
        let apart = (one.speed(time) - best.speed(time)).powi(2);
        weights += variance.recip();
        squares += apart / variance - 1.0;
    }
    (squares.max(0.0) / weights).sqrt()
}

/// Samples beside a fall, some of them skipped, on which the body moves in one direction: friction changes where it
/// turns. One that is at rest moves by the noise of its velocity to either side.
fn window(
    velocity: &Series,
    side: Side,
    fall: Fall,
    (low, high): (usize, usize),
    (skipped, greatest_m_s): (usize, f64),
) -> Option<(usize, usize)> {
    let moves_m_s = (0.02 * greatest_m_s).max(MOVES * velocity.noise);
    let velocity = &velocity.values;
    let turned =
        |edge: usize, i: usize| velocity[i] * velocity[edge] < 0.0 && velocity[i].abs() > moves_m_s;
    match side {
        Side::Before => {
            let edge = fall.first.checked_sub(skipped).filter(|e| *e >= low)?;
            let from = low.max((edge + 1).saturating_sub(MOST));
            let turn = (from..edge).rev().find(|i| turned(edge, *i));
            Some((turn.map_or(from, |i| i + 1), edge + 1))
        }
        Side::After => {
            let edge = Some(fall.last + skipped).filter(|e| *e < high)?;
            let to = high.min(edge + MOST);
            let turn = (edge..to).find(|i| turned(edge, *i));
            Some((edge, turn.unwrap_or(to)))
        }
    }
}
