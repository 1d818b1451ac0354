//! How the amplitude and the frequency of a decay change over time.

/// The course of an amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// A' = −σA, at one frequency.
    Viscous,
    /// The same with dry friction that shifts the equilibrium of each swing, as a column of its own; the last rate is
    /// the time of a turning point.
    Rubbed,
    /// A' = −(σ + g t)A: a rate of decay that changes, whatever changes it.
    Bent,
    /// A' = −σA − g: dry friction.
    Friction,
    /// A' = −σA − gA²: drag of a turbulent flow.
    Drag,
}

/// `ω_d` and σ at the first sample, the change of `ω_d`, and the strength g of the shape, all per sample; g
/// refers to an amplitude of one at the first sample.
pub(super) type Rates = [f64; 4];

/// Amplitude with its slopes over σ and g.
#[derive(Debug, Clone, Copy)]
pub(super) struct Envelope {
    pub(super) value: f64,
    pub(super) of_sigma: f64,
    pub(super) of_strength: f64,
}

impl Shape {
    /// How many of the rates are free.
    pub(super) fn free(self) -> usize {
        match self {
            Self::Viscous | Self::Rubbed => 2,
            _ => 4,
        }
    }

    /// The amplitude, one at the first sample, at t samples after it.
    pub(super) fn envelope(self, rates: &Rates, t: f64) -> Envelope {
        let [_, sigma, _, strength] = *rates;
        let decayed = (-sigma * t).exp();
        // ∫ e^{−σt} dt and its slope over σ
        let small = (sigma * t).abs() < 1e-4;
        let lasted = if small {
            t * (1.0 - 0.5 * sigma * t)
        } else {
            (1.0 - decayed) / sigma
        };
        let lasted_slope = if small {
            -0.5 * t * t
        } else {
            (t * decayed - lasted) / sigma
        };
        match self {
            Self::Viscous | Self::Rubbed => Envelope {
                value: decayed,
                of_sigma: -t * decayed,
                of_strength: 0.0,
            },
            Self::Bent => {
                let value = decayed * (-0.5 * strength * t * t).exp();
                Envelope {
                    value,
                    of_sigma: -t * value,
                    of_strength: -0.5 * t * t * value,
                }
            }
            Self::Friction => {
                let value = decayed - strength * lasted;
                let moves = if value > 0.0 { 1.0 } else { 0.0 };
                Envelope {
                    value: moves * value,
                    of_sigma: moves * (-t * decayed - strength * lasted_slope),
                    of_strength: -moves * lasted,
                }
            }
            Self::Drag => {
                let over = 1.0 + strength * lasted;
                let value = decayed / over;
                Envelope {
                    value,
                    of_sigma: -t * value - value * strength * lasted_slope / over,
                    of_strength: -value * lasted / over,
                }
            }
        }
    }

    /// Rate of decay −A'/A where the amplitude is a share of that at the first sample, t samples after it.
    pub(super) fn rate(self, rates: &Rates, t: f64) -> f64 {
        let [_, sigma, _, strength] = *rates;
        let share = self.envelope(rates, t).value;
        match self {
            Self::Viscous | Self::Rubbed => sigma,
            Self::Bent => sigma + strength * t,
            Self::Friction => sigma + strength / share.max(f64::MIN_POSITIVE),
            Self::Drag => sigma + strength * share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_each_envelope_solves_its_equation_and_its_slopes_are_those_of_differences() {
        let rates = [0.3, 0.01, 0.0, 0.004];
        for shape in [Shape::Viscous, Shape::Bent, Shape::Friction, Shape::Drag] {
            for t in [0.0, 3.0, 40.0] {
                let here = shape.envelope(&rates, t);
                let step = 1e-5;
                let later = shape.envelope(&rates, t + step).value;
                let earlier = shape.envelope(&rates, t - step).value;
                let rate = -(later - earlier) / (2.0 * step) / here.value;
                assert!((rate - shape.rate(&rates, t)).abs() < 1e-7, "{shape:?} {t}");
                for (index, slope) in [(1, here.of_sigma), (3, here.of_strength)] {
                    let moved = |by: f64| {
                        let mut rates = rates;
                        rates[index] += by;
                        shape.envelope(&rates, t).value
                    };
                    let apart = (moved(1e-7) - moved(-1e-7)) / 2e-7 - slope;
                    assert!(
                        apart.abs() < 1e-5 * slope.abs().max(1.0),
                        "{shape:?} {index}"
                    );
                }
            }
        }
    }
}
