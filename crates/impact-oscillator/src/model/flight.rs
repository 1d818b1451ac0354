//! The exact flight of each mass between impacts: homogeneous and forced response, eqs. (1), (2);
//! and of masses that stick together, eq. (5).

use super::params::{Flight, Initial, Machine, ModelError, Oscillator};
use super::path::{C64, Mode, Path};

/// Displacements, velocities and accelerations of both masses.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct State {
    /// X
    pub x: f64,
    /// X'
    pub vx: f64,
    /// X''
    pub ax: f64,
    /// Y (0 against a stop)
    pub y: f64,
    /// Y'
    pub vy: f64,
    /// Y''
    pub ay: f64,
}

impl From<State> for Initial {
    fn from(State { x, vx, y, vy, .. }: State) -> Self {
        Self { x, vx, y, vy }
    }
}

impl Initial {
    /// The state of a machine that starts so, without accelerations; y is left out against a stop.
    ///
    /// # Errors
    /// [`ModelError`] where it is not finite or lies beyond the contact.
    pub(super) fn state(self, machine: &Machine, clearance: f64) -> Result<State, ModelError> {
        self.check()?;
        let (y, vy) = if machine.y.is_some() {
            (self.y, self.vy)
        } else {
            (0.0, 0.0)
        };
        let depth = -(machine.gap(clearance) - self.x - y);
        if depth > 1e-12 * (1.0 + self.x.abs() + y.abs()) {
            return Err(ModelError::StartsInContact { depth });
        }
        Ok(State {
            x: self.x,
            vx: self.vx,
            y,
            vy,
            ..State::default()
        })
    }
}

/// The drive as the flight sees it at its start: η and the phase there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// η
    pub eta: f64,
    /// Phase of cos(ητ + φ) at the flight's start, rad.
    pub phase: f64,
}

/// The flight of both masses from one instant, in time t since then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightPaths {
    /// X(t)
    pub x: Path,
    /// Y(t)
    pub y: Path,
    /// How long the closed form holds (until dry friction turns); infinite otherwise.
    pub valid_for: f64,
}

impl FlightPaths {
    /// Paths that hold for ever.
    pub(super) fn lasting(x: Path, y: Path) -> Self {
        Self {
            x,
            y,
            valid_for: f64::INFINITY,
        }
    }

    /// Displacements, velocities, accelerations at time t since the start.
    pub fn at(&self, t: f64) -> State {
        let ([x, vx, ax], [y, vy, ay]) = (self.x.at(t), self.y.at(t));
        State {
            x,
            vx,
            ax,
            y,
            vy,
            ay,
        }
    }

    /// The gap left: `gap` − X − Y.
    pub fn gap(&self, gap: f64) -> Path {
        Path::constant(gap, self.x.eta)
            .plus(-1.0, &self.x)
            .plus(-1.0, &self.y)
    }
}

/// Ω² − η² + 2iδη of a mass: what the amplitude of its displacement at η multiplies in the equation of motion.
pub fn dynamic_stiffness(o: &Oscillator, eta: f64) -> C64 {
    C64::new(
        o.stiffness_per_mass() - eta * eta,
        2.0 * o.decay_rate() * eta,
    )
}

/// Complex amplitude of the forced response to a·cos(ητ+φ): a e^{iφ}/(Ω² − η² + 2iδη).
pub fn forced_amplitude(o: &Oscillator, drive: Drive) -> C64 {
    let dynamic = dynamic_stiffness(o, drive.eta);
    let force = if drive.phase == 0.0 {
        C64::new(o.drive_per_mass(), 0.0)
    } else {
        C64::from_polar(o.drive_per_mass(), drive.phase)
    };
    force * dynamic.conj() / dynamic.norm_sqr()
}

/// λ = −δ + i√(Ω² − δ²): the free vibration's exponent.
pub(crate) fn exponent(o: &Oscillator) -> C64 {
    let d = o.decay_rate();
    C64::new(-d, (o.stiffness_per_mass() - d * d).sqrt())
}

/// The free mode with displacement x0 and velocity v0 at t = 0.
pub(crate) fn free_mode(lambda: C64, x0: f64, v0: f64) -> Mode {
    // Re z = x0, Re(λz) = v0
    Mode {
        amplitude: C64::new(x0, (lambda.re * x0 - v0) / lambda.im),
        exponent: lambda,
    }
}

/// Flight of one mass under spring, dashpot and drive.
pub(crate) fn harmonic_path(o: &Oscillator, drive: Drive, x0: f64, v0: f64) -> Path {
    let mut path = Path::constant(0.0, drive.eta);
    path.force = forced_amplitude(o, drive);
    let forced_v = -drive.eta * path.force.im;
    path.add_mode(free_mode(exponent(o), x0 - path.force.re, v0 - forced_v));
    path
}

/// Flight of both masses from a state, eq. (2).
pub fn free_flight(machine: &Machine, drive: Drive, start: &State) -> FlightPaths {
    match machine.flight {
        Flight::Harmonic => {
            let x = harmonic_path(&machine.x, drive, start.x, start.vx);
            let y = match &machine.y {
                Some(o) => harmonic_path(o, drive, start.y, start.vy),
                None => Path::constant(0.0, drive.eta),
            };
            FlightPaths::lasting(x, y)
        }
        Flight::ConstantForce {
            acceleration,
            friction,
        } => {
            let (a, valid_for) = with_friction(acceleration, friction, start.vx);
            let mut x = Path::parabola(start.x, start.vx, a);
            x.eta = drive.eta;
            FlightPaths {
                x,
                y: Path::constant(0.0, drive.eta),
                valid_for,
            }
        }
    }
}

/// Acceleration of a mass under a constant force with dry friction, and how long until its
/// velocity turns and friction with it.
pub(crate) fn with_friction(force: f64, friction: f64, v: f64) -> (f64, f64) {
    let direction = if v != 0.0 { v.signum() } else { force.signum() };
    if v == 0.0 && force.abs() <= friction {
        return (0.0, f64::INFINITY);
    }
    let a = force - direction * friction;
    let turns = if v * a < 0.0 { -v / a } else { f64::INFINITY };
    (a, turns)
}

/// Paths while the masses stay together, X = ρ + J, Y = ρ − J:
/// (m₁+m₂)J'' + (b₁+b₂)J' + (k₁+k₂)J = (k₂−k₁)ρ + (F₁−F₂)cos(ητ+φ), eq. (5). Against a stop X rests at ρ.
pub(crate) fn sticking_flight(
    machine: &Machine,
    drive: Drive,
    clearance: f64,
    start: &State,
) -> FlightPaths {
    let Some(oy) = &machine.y else {
        let x = Path::constant(clearance, drive.eta);
        return FlightPaths::lasting(x, Path::constant(0.0, drive.eta));
    };
    let pair = pair_oscillator(&machine.x, oy);
    let (kx, ky) = (stiffness(&machine.x), stiffness(oy));
    let shift = (ky - kx) * clearance / (kx + ky);
    let mut j = harmonic_path(&pair, drive, start.x - clearance - shift, start.vx);
    j.polynomial[0] = shift;
    let x = Path::constant(clearance, drive.eta).plus(1.0, &j);
    let y = Path::constant(clearance, drive.eta).plus(-1.0, &j);
    FlightPaths::lasting(x, y)
}

fn stiffness(o: &Oscillator) -> f64 {
    o.mass * o.stiffness_per_mass()
}

/// Both masses as one oscillator in J: masses, springs and dashpots add, drives subtract.
fn pair_oscillator(x: &Oscillator, y: &Oscillator) -> Oscillator {
    if x == y {
        return Oscillator {
            mass: 2.0 * x.mass,
            drive_amplitude: 0.0,
            ..*x
        };
    }
    let mass = x.mass + y.mass;
    let ratio = ((stiffness(x) + stiffness(y)) / mass).sqrt();
    let decay = (x.mass * x.decay_rate() + y.mass * y.decay_rate()) / mass;
    Oscillator {
        mass,
        natural_frequency_ratio: ratio,
        damping_ratio: decay / ratio,
        drive_amplitude: x.drive_amplitude - y.drive_amplitude,
    }
}

/// Free acceleration toward the contact that one mass would have on a given path, as a path:
/// (F/m)cos(ητ+φ) − 2δX' − Ω²X.
fn fictive_acceleration(o: &Oscillator, drive: Drive, path: &Path) -> Path {
    let mut a = Path::constant(0.0, drive.eta);
    a.force = C64::from_polar(o.drive_per_mass(), drive.phase);
    a.plus(-2.0 * o.decay_rate(), &path.derivative())
        .plus(-o.stiffness_per_mass(), path)
}

/// The press force's measure along the paths of sticking masses: the fictive relative acceleration X'' + Y''
/// that the masses would have without the contact (the paper's eq. 6); pressed while it is positive.
pub(crate) fn press(machine: &Machine, drive: Drive, sticking: &FlightPaths) -> Path {
    if let Flight::ConstantForce {
        acceleration,
        friction,
    } = machine.flight
    {
        return Path::constant(acceleration - friction, drive.eta);
    }
    let ax = fictive_acceleration(&machine.x, drive, &sticking.x);
    match &machine.y {
        None => ax,
        Some(o) => ax.plus(1.0, &fictive_acceleration(o, drive, &sticking.y)),
    }
}
