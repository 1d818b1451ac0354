//! Exact slopes of a z = 1/n orbit over everything it depends on, through the impact.
//!
//! Each mass moves as Re(F e^{iθ}) + Re(A e^{λt}) with θ the drive's phase and t = (θ − ψ)/η since
//! the impact; F, A, λ, ψ and η are smooth functions of the machine and of the setting, and their
//! differentials are those of the closed forms of [`orbit`](super::orbit), the approach speed's by
//! the implicit function of its quadratic. They grow without bound at the saddle-node.

use super::flight::{Drive, dynamic_stiffness, exponent, forced_amplitude};
use super::orbit::Branch;
use super::params::{Machine, Oscillator};
use super::path::C64;

/// A direction in which one mass changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MassChange {
    /// Of `Ω_i²`, the stiffness over the mass.
    pub stiffness_per_mass: f64,
    /// Of δ = `β_i` `Ω_i`.
    pub decay_rate: f64,
    /// Of the driving amplitude over the mass.
    pub drive_per_mass: f64,
    /// Of the share of an impact's change of speed that the mass takes.
    pub mobility: f64,
}

/// A direction in which machine, setting and what acts beyond them change.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Change {
    /// The first mass.
    pub x: MassChange,
    /// The second mass.
    pub y: MassChange,
    /// Of R.
    pub restitution: f64,
    /// Of η.
    pub eta: f64,
    /// Of the gap at X = Y = 0.
    pub gap: f64,
    /// Of X + Y at the impact, by a small extra acceleration of the masses
    /// ([`PeriodicResponses`](super::perturbation::PeriodicResponses)).
    pub displacement: f64,
    /// Of X' + Y' just before the impact, likewise.
    pub velocity: f64,
}

/// One mass on an orbit: Re(force · e^{iθ}) + Re(mode · e^{exponent · t}), θ the drive's phase and
/// t the time since the impact. Of a change: the differentials of the three.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MassMotion {
    /// F, complex amplitude of the forced response for drive phase 0.
    pub force: C64,
    /// A, complex amplitude of the free vibration just after the impact.
    pub mode: C64,
    /// λ
    pub exponent: C64,
}

/// An orbit, or its differential in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrbitMotion {
    /// The first mass.
    pub x: MassMotion,
    /// The second mass; at rest against a stop.
    pub y: MassMotion,
    /// ψ, the drive's phase at the impact, rad.
    pub phase: f64,
    /// w, the approach speed.
    pub approach_speed: f64,
}

/// Differential of a mass's forced amplitude F for drive phase 0, where η changes by `d_eta`.
pub fn forced_slope(o: &Oscillator, d: &MassChange, forced: C64, [eta, d_eta]: [f64; 2]) -> C64 {
    let decay = o.decay_rate();
    let dynamic = dynamic_stiffness(o, eta);
    let d_dynamic = C64::new(
        d.stiffness_per_mass - 2.0 * eta * d_eta,
        2.0 * (d.decay_rate * eta + decay * d_eta),
    );
    (C64::new(d.drive_per_mass, 0.0) - forced * d_dynamic) / dynamic
}

/// One mass's closed forms, from which the differentials follow.
struct Mass {
    oscillator: Oscillator,
    mobility: f64,
    lambda: C64,
    returned: C64,
    /// 1/(1 − e^{λT})
    sum: C64,
    /// Im(e^{λT} λ/(1 − e^{λT})), ω times the Green's function's velocity before.
    before: C64,
    forced: C64,
}

/// Differentials of one mass's closed forms.
struct MassSlope {
    lambda: C64,
    sum: C64,
    position: f64,
    velocity: f64,
    forced: C64,
    mobility: f64,
}

impl Mass {
    fn new(oscillator: Oscillator, mobility: f64, eta: f64, period: f64) -> Self {
        let lambda = exponent(&oscillator);
        let returned = (lambda * period).exp();
        let sum = (C64::new(1.0, 0.0) - returned).inv();
        Self {
            mobility,
            lambda,
            returned,
            sum,
            before: returned * lambda * sum,
            forced: forced_amplitude(&oscillator, Drive { eta, phase: 0.0 }),
            oscillator,
        }
    }

    fn slope(&self, d: &MassChange, eta: [f64; 2], period: [f64; 2]) -> MassSlope {
        let [period, d_period] = period;
        let (omega, decay) = (self.lambda.im, self.oscillator.decay_rate());
        let d_omega = (d.stiffness_per_mass - 2.0 * decay * d.decay_rate) / (2.0 * omega);
        let lambda = C64::new(-d.decay_rate, d_omega);
        let returned = self.returned * (lambda * period + self.lambda * d_period);
        let sum = self.sum * self.sum * returned;
        let before = returned * self.lambda * self.sum
            + self.returned * (lambda * self.sum + self.lambda * sum);
        MassSlope {
            lambda,
            sum,
            position: (sum.im - self.sum.im * d_omega / omega) / omega,
            velocity: (before.im - self.before.im * d_omega / omega) / omega,
            forced: forced_slope(&self.oscillator, d, self.forced, eta),
            mobility: d.mobility,
        }
    }

    /// −i·jump/(ω(1 − e^{λT})): the free vibration after a jump of the velocity each period.
    fn mode(&self, change: f64) -> C64 {
        self.sum * C64::new(0.0, self.mobility * change / self.lambda.im)
    }

    fn mode_slope(&self, slope: &MassSlope, change: [f64; 2]) -> C64 {
        let [change, d_change] = change;
        let unit = C64::new(0.0, self.lambda.im.recip());
        let relative = slope.lambda.im / self.lambda.im;
        let own = slope.sum * change + self.sum * (d_change - change * relative);
        unit * (own * self.mobility + self.sum * change * slope.mobility)
    }

    /// Displacement and velocity before of the Green's function, each times the mobility.
    fn share_slope(&self, slope: &MassSlope) -> [f64; 2] {
        let omega = self.lambda.im;
        [
            self.mobility * slope.position + slope.mobility * self.sum.im / omega,
            self.mobility * slope.velocity + slope.mobility * self.before.im / omega,
        ]
    }

    fn motion(&self, change: f64) -> MassMotion {
        MassMotion {
            force: self.forced,
            mode: self.mode(change),
            exponent: self.lambda,
        }
    }

    fn motion_slope(&self, slope: &MassSlope, change: [f64; 2]) -> MassMotion {
        MassMotion {
            force: slope.forced,
            mode: self.mode_slope(slope, change),
            exponent: slope.lambda,
        }
    }
}

/// The z = 1/n orbit of approach speed w at constant R and a gap, in coefficients, and its
/// differentials in some directions.
pub struct Sensitivity {
    masses: [Option<Mass>; 2],
    branch: Branch,
    period: f64,
    restitution: f64,
    gap: f64,
    approach_speed: f64,
}

impl Sensitivity {
    /// Of an orbit on a machine's branch whose approach speed solves the quadratic; R is taken as
    /// constant there.
    pub fn new(machine: &Machine, branch: Branch, n: u32, gap: f64, approach_speed: f64) -> Self {
        let eta = branch.eta;
        let period = f64::from(n) * std::f64::consts::TAU / eta;
        let (mx, my) = machine.mobility();
        let of = |o: Oscillator, mobility: f64| Mass::new(o, mobility, eta, period);
        Self {
            masses: [Some(of(machine.x, mx)), machine.y.map(|o| of(o, my))],
            branch,
            period,
            restitution: machine.restitution().at(approach_speed),
            gap,
            approach_speed,
        }
    }

    /// Re(F e^{iψ}) and Im, by the gap and the approach speed.
    fn at_impact(&self) -> C64 {
        let branch = &self.branch;
        branch.at_impact(self.restitution, self.gap, self.approach_speed)
    }

    /// The orbit itself.
    pub fn motion(&self) -> OrbitMotion {
        let change = (1.0 + self.restitution) * self.approach_speed;
        let of = |mass: &Option<Mass>| mass.as_ref().map(|m| m.motion(change)).unwrap_or_default();
        let phase = self.at_impact().arg() - self.branch.forced.arg();
        OrbitMotion {
            x: of(&self.masses[0]),
            y: of(&self.masses[1]),
            phase: phase.rem_euclid(std::f64::consts::TAU),
            approach_speed: self.approach_speed,
        }
    }

    /// Its differential in a direction.
    pub fn slope(&self, change: &Change) -> OrbitMotion {
        let (b, r, w) = (&self.branch, self.restitution, self.approach_speed);
        let eta = [b.eta, change.eta];
        let period = [self.period, -self.period * change.eta / b.eta];
        let [x, y] = [(0, &change.x), (1, &change.y)].map(|(i, d)| {
            self.masses[i]
                .as_ref()
                .map(|m| (m, m.slope(d, eta, period)))
        });
        let shares = [&x, &y].into_iter().flatten();
        let [d_position, d_velocity] = shares
            .map(|(m, s)| m.share_slope(s))
            .fold([0.0; 2], |sum, share| {
                [sum[0] + share[0], sum[1] + share[1]]
            });
        let forced: C64 = [&x, &y].into_iter().flatten().map(|(_, s)| s.forced).sum();
        let d_alpha = -change.restitution * b.position - (1.0 + r) * d_position;
        let d_q = change.restitution * b.velocity + (1.0 + r) * d_velocity;
        // |u|² = |F|² holds along the change; u is linear in w.
        let u = self.at_impact();
        let per_w = C64::new(-b.alpha(r), -b.q(r) / b.eta);
        let held = C64::new(
            change.gap - change.displacement - d_alpha * w,
            ((b.q(r) * w - b.extra[1]) * change.eta / b.eta - d_q * w + change.velocity) / b.eta,
        );
        let product = |a: C64, b: C64| (a.conj() * b).re;
        let d_w = (product(b.forced, forced) - product(u, held)) / product(u, per_w);
        let turned = |z: C64, d: C64| (z.conj() * d).im / z.norm_sqr();
        let jump = [(1.0 + r) * w, change.restitution * w + (1.0 + r) * d_w];
        let of = |m: &Option<(&Mass, MassSlope)>| {
            m.as_ref()
                .map(|(m, s)| m.motion_slope(s, jump))
                .unwrap_or_default()
        };
        OrbitMotion {
            x: of(&x),
            y: of(&y),
            phase: turned(u, held + per_w * d_w) - turned(b.forced, forced),
            approach_speed: d_w,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::orbit::orbits;
    use crate::model::params::{Asymmetry, Restitution, Setting};

    fn machines() -> [Machine; 3] {
        let asymmetry = Asymmetry {
            drive_amplitude: 0.95,
            stiffness: 1.04,
            mass: 0.9,
        };
        [
            Machine::single(0.05, 0.7),
            Machine::symmetric(0.07, 0.9),
            Machine::asymmetric(0.07, 0.8, asymmetry),
        ]
    }

    #[test]
    fn coefficients_are_those_of_the_orbit() {
        for machine in machines() {
            for orbit in orbits(&machine, Setting::new(1.2, 0.8), 1).unwrap() {
                let gap = machine.gap(0.8);
                let branch = Branch::new(&machine, 1.2, 1);
                let motion =
                    Sensitivity::new(&machine, branch, 1, gap, orbit.approach_speed).motion();
                assert!((motion.phase - orbit.phase_at_impact).abs() < 1e-12);
                let turned = motion.x.force * C64::from_polar(1.0, orbit.phase_at_impact);
                assert!((turned - orbit.paths().x.force).norm() < 1e-12);
                let mode = orbit.paths().x.modes()[0];
                assert!((motion.x.mode - mode.amplitude).norm() < 1e-12);
                assert!((motion.x.exponent - mode.exponent).norm() < 1e-15);
                if let (Some(mode), Some(_)) = (orbit.paths().y.modes().first(), machine.y) {
                    assert!((motion.y.mode - mode.amplitude).norm() < 1e-12);
                }
            }
        }
    }

    /// A direction, and machine, η and gap a step along it.
    type Moved = (Change, Machine, f64, f64);

    fn moved_setting(machine: &Machine, eta: f64, gap: f64, step: f64) -> Vec<Moved> {
        let none = Change::default();
        let restitution = Restitution::Constant(machine.restitution().at(1.0) + step);
        let bouncing = machine.clone().with_restitution(restitution);
        let change = Change {
            restitution: 1.0,
            ..none
        };
        vec![
            (change, bouncing, eta, gap),
            (
                Change { eta: 1.0, ..none },
                machine.clone(),
                eta + step,
                gap,
            ),
            (
                Change { gap: 1.0, ..none },
                machine.clone(),
                eta,
                gap + step,
            ),
        ]
    }

    fn moved_mass(machine: &Machine, eta: f64, gap: f64, step: f64) -> Vec<Moved> {
        let none = MassChange::default();
        let o = machine.x;
        let (mut driven, mut damped, mut stiff) = (o, o, o);
        driven.drive_amplitude += step;
        damped.damping_ratio += step;
        stiff.natural_frequency_ratio += step;
        let drive = MassChange {
            drive_per_mass: 1.0 / o.mass,
            ..none
        };
        let decay = MassChange {
            decay_rate: o.natural_frequency_ratio,
            ..none
        };
        let stiffness = MassChange {
            stiffness_per_mass: 2.0 * o.natural_frequency_ratio,
            decay_rate: o.damping_ratio,
            ..none
        };
        let of = |(x, mass): (MassChange, Oscillator)| {
            let change = Change {
                x,
                ..Change::default()
            };
            let machine = Machine {
                x: mass,
                ..machine.clone()
            };
            (change, machine, eta, gap)
        };
        vec![
            of((drive, driven)),
            of((decay, damped)),
            of((stiffness, stiff)),
        ]
    }

    /// All of them, the second mass changed like the first where there is one.
    fn moved(machine: &Machine, eta: f64, gap: f64, step: f64) -> Vec<Moved> {
        let mut all = moved_setting(machine, eta, gap, step);
        all.extend(moved_mass(machine, eta, gap, step));
        if let Some(y) = machine.y {
            let turned = |m: &Machine, y: Oscillator| Machine {
                x: y,
                y: Some(m.x),
                ..m.clone()
            };
            let seen = moved_mass(&turned(machine, y), eta, gap, step);
            all.extend(seen.into_iter().map(|(change, m, eta, gap)| {
                let back = m.y.map_or_else(|| m.clone(), |x| turned(&m, x));
                let change = Change {
                    x: change.y,
                    y: change.x,
                    ..change
                };
                (change, back, eta, gap)
            }));
        }
        all
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        let step = 1e-6;
        for machine in machines() {
            for n in [1, 2] {
                let (eta, rho) = (1.15 * f64::from(n), 0.4);
                let gap = machine.gap(rho);
                let orbits = orbits(&machine, Setting::new(eta, rho), n).unwrap();
                let speed = orbits.last().expect("an orbit").approach_speed;
                let extra = [0.01, -0.02];
                let branch = Branch::new(&machine, eta, n).with_extra(extra);
                let r = machine.restitution().at(1.0);
                let nearest = |roots: [f64; 2], speed: f64| {
                    let nearer = |w: &f64| (w - speed).abs();
                    let nearest = roots.into_iter();
                    nearest
                        .min_by(|a, b| nearer(a).total_cmp(&nearer(b)))
                        .unwrap()
                };
                let speed = nearest(branch.approach_speeds(r, gap).unwrap(), speed);
                let here = Sensitivity::new(&machine, branch, n, gap, speed);
                let above = moved(&machine, eta, gap, step);
                let below = moved(&machine, eta, gap, -step);
                for ((change, ma, ea, ga), (_, mb, eb, gb)) in above.into_iter().zip(below) {
                    let near = |m: &Machine, eta: f64, gap: f64| {
                        let branch = Branch::new(m, eta, n).with_extra(extra);
                        let roots = branch.approach_speeds(m.restitution().at(1.0), gap);
                        let w = nearest(roots.unwrap(), speed);
                        Sensitivity::new(m, branch, n, gap, w).motion()
                    };
                    let (a, b) = (near(&ma, ea, ga), near(&mb, eb, gb));
                    let slope = here.slope(&change);
                    let apart = |exact: f64, a: f64, b: f64| {
                        (exact - (a - b) / (2.0 * step)).abs() / (1.0 + exact.abs())
                    };
                    let complex = |exact: C64, a: C64, b: C64| {
                        apart(exact.re, a.re, b.re).max(apart(exact.im, a.im, b.im))
                    };
                    assert!(apart(slope.approach_speed, a.approach_speed, b.approach_speed) < 1e-7);
                    assert!(apart(slope.phase, a.phase, b.phase) < 1e-7);
                    for (s, a, b) in [(slope.x, a.x, b.x), (slope.y, a.y, b.y)] {
                        assert!(complex(s.force, a.force, b.force) < 1e-7);
                        assert!(complex(s.mode, a.mode, b.mode) < 1e-7);
                        assert!(complex(s.exponent, a.exponent, b.exponent) < 1e-7);
                    }
                }
            }
        }
    }
}
