//! Functions of time in closed form: polynomial + harmonic + damped modes. Displacements, the
//! gap and the press force are all of this class, so one root search serves them all.

use nalgebra::Complex;

/// Complex number of the closed forms.
pub type C64 = Complex<f64>;

/// Most damped modes a path holds.
pub(crate) const MAX_MODES: usize = 4;

/// One damped mode Re(amplitude · e^(exponent·t)).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mode {
    /// Complex amplitude at t = 0.
    pub amplitude: C64,
    /// Complex exponent λ, with Re λ ≤ 0.
    pub exponent: C64,
}

/// Value and first three derivatives of a path at a time, and the bound that the root search
/// rests on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Jet {
    /// f(t)
    pub(crate) value: f64,
    /// f'(t)
    pub(crate) d1: f64,
    /// f''(t)
    pub(crate) d2: f64,
    /// f'''(t)
    pub(crate) d3: f64,
    /// Upper bound of |f''''| for this and all later times.
    pub(crate) d4_bound: f64,
    /// Sum of the amplitudes of modes (now) and of the harmonic.
    pub(crate) amplitude: f64,
}

/// f(t) = c₀ + c₁t + c₂t² + Re(force·e^(iηt)) + Σ Re(amplitude·e^(λt)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path {
    /// c₀, c₁, c₂
    pub polynomial: [f64; 3],
    /// Complex amplitude of the harmonic part at t = 0.
    pub force: C64,
    /// Its angular frequency η.
    pub eta: f64,
    modes: [Mode; MAX_MODES],
    count: usize,
}

/// |z| without the care for overflow that `norm` takes; displacements are far from it.
fn modulus(z: C64) -> f64 {
    z.norm_sqr().sqrt()
}

impl Path {
    /// A constant.
    pub fn constant(value: f64, eta: f64) -> Self {
        Self {
            polynomial: [value, 0.0, 0.0],
            force: C64::default(),
            eta,
            modes: [Mode::default(); MAX_MODES],
            count: 0,
        }
    }

    /// x₀ + v₀t + ½at².
    pub fn parabola(x0: f64, v0: f64, acceleration: f64) -> Self {
        Self {
            polynomial: [x0, v0, 0.5 * acceleration],
            ..Self::constant(0.0, 1.0)
        }
    }

    /// The damped modes.
    pub fn modes(&self) -> &[Mode] {
        &self.modes[..self.count]
    }

    /// Add a mode; modes of the same exponent are merged into one.
    ///
    /// # Panics
    /// Where more than [`MAX_MODES`] different exponents come together (no machine has more).
    pub fn add_mode(&mut self, mode: Mode) {
        let same = self.modes[..self.count]
            .iter_mut()
            .find(|m| m.exponent == mode.exponent);
        match same {
            Some(m) => m.amplitude += mode.amplitude,
            None => {
                self.modes[self.count] = mode;
                self.count += 1;
            }
        }
    }

    /// self + factor·other; both of the same η.
    #[must_use]
    pub fn plus(mut self, factor: f64, other: &Self) -> Self {
        for (a, b) in self.polynomial.iter_mut().zip(other.polynomial) {
            *a += factor * b;
        }
        self.force += other.force * factor;
        for m in other.modes() {
            self.add_mode(Mode {
                amplitude: m.amplitude * factor,
                ..*m
            });
        }
        self
    }

    /// The path times a number.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self::constant(0.0, self.eta).plus(factor, self)
    }

    /// The derivative f'.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let mut d = *self;
        let [_, c1, c2] = self.polynomial;
        d.polynomial = [c1, 2.0 * c2, 0.0];
        d.force = self.force * C64::new(0.0, self.eta);
        for m in &mut d.modes[..d.count] {
            m.amplitude *= m.exponent;
        }
        d
    }

    /// Value, velocity and acceleration: f, f', f''.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let [c0, c1, c2] = self.polynomial;
        let mut out = [c0 + t * (c1 + t * c2), c1 + 2.0 * c2 * t, 2.0 * c2];
        let forced = Mode {
            amplitude: self.force,
            exponent: C64::new(0.0, self.eta),
        };
        let held = (self.force != C64::default()).then_some(&forced);
        for m in self.modes().iter().chain(held) {
            let z = m.amplitude * (m.exponent * t).exp();
            let dz = m.exponent * z;
            out[0] += z.re;
            out[1] += dz.re;
            out[2] += (m.exponent * dz).re;
        }
        out
    }

    /// Value, derivatives and bounds at a time.
    pub(crate) fn jet(&self, t: f64) -> Jet {
        let [c0, c1, c2] = self.polynomial;
        let mut jet = Jet {
            value: c0 + t * (c1 + t * c2),
            d1: c1 + 2.0 * c2 * t,
            d2: 2.0 * c2,
            ..Jet::default()
        };
        self.add_harmonic(t, &mut jet);
        for m in self.modes() {
            add_mode_jet(m, t, &mut jet);
        }
        jet
    }

    fn add_harmonic(&self, t: f64, jet: &mut Jet) {
        if self.force == C64::default() {
            return;
        }
        let (sin, cos) = (self.eta * t).sin_cos();
        let f = self.force * C64::new(cos, sin);
        let (w, w2) = (self.eta, self.eta * self.eta);
        jet.value += f.re;
        jet.d1 -= w * f.im;
        jet.d2 -= w2 * f.re;
        jet.d3 += w * w2 * f.im;
        let a = modulus(self.force);
        jet.amplitude += a;
        jet.d4_bound += w2 * w2 * a;
    }

    /// Sum of all amplitudes at t = 0, the polynomial's constant and the height of its
    /// parabola included: the size by which rounding of the value is judged.
    pub fn size(&self) -> f64 {
        let modes: f64 = self.modes().iter().map(|m| modulus(m.amplitude)).sum();
        let [c0, c1, c2] = self.polynomial;
        let height = if c2 == 0.0 {
            0.0
        } else {
            (c1 * c1 / (4.0 * c2)).abs()
        };
        c0.abs() + height + modulus(self.force) + modes
    }

    /// Fastest angular rate in the path: max(η, |λ|), at least 1e-3.
    pub fn rate(&self) -> f64 {
        let eta = if self.force == C64::default() {
            1e-3
        } else {
            self.eta
        };
        self.modes()
            .iter()
            .map(|m| modulus(m.exponent))
            .fold(eta, f64::max)
    }

    /// Whether the path neither grows nor falls on the average (no t or t² part).
    pub fn is_bounded(&self) -> bool {
        self.polynomial[1] == 0.0 && self.polynomial[2] == 0.0
    }
}

fn add_mode_jet(m: &Mode, t: f64, jet: &mut Jet) {
    let (sin, cos) = (m.exponent.im * t).sin_cos();
    let z0 = m.amplitude * C64::new(cos, sin) * (m.exponent.re * t).exp();
    let z1 = z0 * m.exponent;
    let z2 = z1 * m.exponent;
    let z3 = z2 * m.exponent;
    jet.value += z0.re;
    jet.d1 += z1.re;
    jet.d2 += z2.re;
    jet.d3 += z3.re;
    let a = modulus(z0);
    jet.amplitude += a;
    jet.d4_bound += a * m.exponent.norm_sqr().powi(2);
}
