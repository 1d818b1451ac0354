//! Drag of the air in a flight: an acceleration −c v|v| beside the constant one.

use crate::signal::local_fit::LocalFit;
use crate::signal::spacing;

/// Least and greatest c of a ball, 1/m: half the density of air times the area over the mass, of steel and of a
/// table tennis ball. Each factor between them is as likely before flights are seen.
const USUAL_PER_M: [f64; 2] = [5e-4, 0.15];
/// Values of c that are tried.
const TRIED: usize = 61;

/// Drag in all flights of a body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Drag {
    /// c, 1/m.
    pub(super) per_m: f64,
    /// Its standard error, 1/m.
    pub(super) error_per_m: f64,
}

/// What one flight shows of c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shown {
    /// Least-squares estimate, 1/m.
    pub(super) per_m: f64,
    /// Its standard error by the noise, 1/m.
    pub(super) error_per_m: f64,
}

impl Drag {
    /// Of what flights show; none without any.
    pub(super) fn of(shown: &[Shown]) -> Self {
        let weight = |s: &Shown| s.error_per_m.powi(-2);
        let all: f64 = shown.iter().map(weight).sum();
        if !all.is_finite() || all <= 0.0 {
            return Self::default();
        }
        let mean = shown.iter().map(|s| weight(s) * s.per_m).sum::<f64>() / all;
        let squares = shown.iter().map(|s| weight(s) * (s.per_m - mean).powi(2));
        let excess = squares.sum::<f64>() / (shown.len() as f64 - 1.0).max(1.0);
        let variance = excess.max(1.0) / all;
        let each = spacing::by_ratio(USUAL_PER_M, TRIED)
            .map(|tried| ((-0.5 * (tried - mean).powi(2) / variance).exp(), tried));
        let each: Vec<(f64, f64)> = each.collect();
        let likely: f64 = each.iter().map(|(likely, _)| likely).sum();
        if likely < f64::MIN_POSITIVE {
            return Self::default();
        }
        let per_m = each.iter().map(|(l, c)| l * c).sum::<f64>() / likely;
        let squares = each.iter().map(|(l, c)| l * (c - per_m).powi(2));
        Self {
            per_m,
            error_per_m: (squares.sum::<f64>() / likely).sqrt(),
        }
    }
}

/// What drag takes from a flight from an instant on, per unit of c, where the velocity is a parabola in time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Loss {
    /// The instant, samples.
    from: f64,
    /// Velocity at the instant, m per sample, and its derivatives by time in samples.
    velocity: [f64; 3],
}

impl Loss {
    /// From an instant on, of the velocity at the middle of a flight and its derivatives, in m and samples.
    pub(super) fn new(from: f64, middle: f64, [velocity, first, second]: [f64; 3]) -> Self {
        let way = from - middle;
        Self {
            from,
            velocity: [
                velocity + way * (first + 0.5 * way * second),
                first + way * second,
                second,
            ],
        }
    }

    /// v|v| so many samples after the instant, m² per sample².
    fn square(&self, after: f64) -> f64 {
        let [velocity, first, second] = self.velocity;
        let velocity = velocity + after * (first + 0.5 * after * second);
        velocity * velocity.abs()
    }

    /// Boole's rule for the squares from the instant to a time, each with a weight by its share of the way: exact for
    /// a parabola's, with a weight that is a line.
    fn integral(&self, after: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let parts = [
            (0.0, 7.0),
            (0.25, 32.0),
            (0.5, 12.0),
            (0.75, 32.0),
            (1.0, 7.0),
        ];
        let each = parts.map(|(share, by)| by * weight(share) * self.square(share * after));
        after / 90.0 * each.iter().sum::<f64>()
    }

    /// ∫ v|v| dt from the instant to a time, m² per sample.
    pub(super) fn of_velocity(&self, time: f64) -> f64 {
        self.integral(time - self.from, |_| 1.0)
    }

    /// Its integral over time, m².
    pub(super) fn of_displacement(&self, time: f64) -> f64 {
        let after = time - self.from;
        after * self.integral(after, |share| 1.0 - share)
    }
}

/// What the residuals of a flight show of c beyond that with which it was fitted; `losses`: what drag of 1/m takes
/// from each sample; `deviation`: of the noise. `None` where the fit's polynomial explains the losses.
pub(super) fn shown(
    residuals: &[f64],
    losses: &[f64],
    degree: usize,
    deviation: f64,
) -> Option<Shown> {
    let fit = LocalFit::new(losses, 0, losses.len(), degree)?;
    let products = residuals.iter().zip(losses).enumerate();
    let product: f64 = products
        .map(|(i, (r, loss))| r * (loss - fit.value(i as f64)))
        .sum();
    let squares = fit.residual_squares;
    let error_per_m = deviation / squares.sqrt();
    (squares > 0.0 && error_per_m.is_finite()).then(|| Shown {
        per_m: -product / squares,
        error_per_m,
    })
}
