//! Whether the channels of one record can belong together: the change of a displacement is the
//! integral of the velocity of the same mass, that of a velocity the integral of the
//! acceleration.

use super::{Flag, MistakenUnits, Problem, Record, Role};
use crate::signal::columns::dot;
use crate::signal::robust;

/// Correlation from which two channels count as the same motion.
const SAME: f64 = 0.9;

/// Ratio of scales from which one of them must be wrong.
const SCALE_RATIO: f64 = 1.5;

/// What two numbers that are compared measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComparedChannels {
    /// A displacement and the integral of a velocity.
    Displacement,
    /// A velocity and the integral of an acceleration.
    Velocity,
    /// Two frequencies.
    Frequency,
}

/// Units of length and conventions of amplitude concern both motions.
const MOTIONS: &[ComparedChannels] = &[ComparedChannels::Displacement, ComparedChannels::Velocity];

/// Factors between two units or conventions that are often mistaken for each other, and where they can be.
const MISTAKEN: [(f64, MistakenUnits, &[ComparedChannels]); 7] = [
    (1000.0, MistakenUnits::MetresMillimetres, MOTIONS),
    (
        1000.0,
        MistakenUnits::HertzKilohertz,
        &[ComparedChannels::Frequency],
    ),
    (
        std::f64::consts::TAU,
        MistakenUnits::HertzRadians,
        &[ComparedChannels::Frequency],
    ),
    (
        labfiles::units::STANDARD_GRAVITY_M_S2,
        MistakenUnits::GravityMetres,
        &[ComparedChannels::Velocity],
    ),
    (std::f64::consts::SQRT_2, MistakenUnits::RmsPeak, MOTIONS),
    (25.4, MistakenUnits::InchMillimetres, MOTIONS),
    (
        2.0 * std::f64::consts::SQRT_2,
        MistakenUnits::RmsPeakToPeak,
        MOTIONS,
    ),
];

/// How near a ratio must be to such a factor: the gains of a rig are known to a per cent or two.
const MISTAKEN_WITHIN: f64 = 0.02;

/// The units or conventions that a ratio of two numbers, or its reciprocal, suggests.
pub fn mistaken(ratio: f64, compared: ComparedChannels) -> Option<MistakenUnits> {
    let near = |factor: f64| (ratio.abs() / factor - 1.0).abs() < MISTAKEN_WITHIN;
    MISTAKEN
        .iter()
        .filter(|(_, _, of)| of.contains(&compared))
        .find(|(factor, ..)| near(*factor) || near(1.0 / factor))
        .map(|m| m.1)
}

/// Check for swapped masses, opposite signs and contradicting scales.
pub fn inspect(record: &Record) -> Vec<Flag> {
    let changes = |quantity| Windows::changes(record, quantity);
    let integrals = |rate| Windows::integrals(record, rate);
    let displacements = [Role::DisplacementX, Role::DisplacementY].map(changes);
    let velocities = [Role::VelocityX, Role::VelocityY].map(integrals);
    let compare = |mass: usize, other: usize| {
        Match::of(displacements[mass].as_ref()?, velocities[other].as_ref()?)
    };
    let (x, y) = (compare(0, 0), compare(1, 1));
    if let Some(flag) = swapped(record, [x, y], [compare(0, 1), compare(1, 0)]) {
        return vec![flag];
    }
    if let Some(flag) = opposite_masses(record) {
        return vec![flag];
    }
    let rates = |velocity, acceleration| {
        let integral = integrals(acceleration);
        let found = integral.and_then(|integral| Match::of(&changes(velocity)?, &integral));
        (found, velocity, acceleration)
    };
    let pairs = [
        (x, Role::DisplacementX, Role::VelocityX),
        (y, Role::DisplacementY, Role::VelocityY),
        rates(Role::VelocityX, Role::AccelerationX),
        rates(Role::VelocityY, Role::AccelerationY),
    ];
    pairs
        .into_iter()
        .filter_map(|(match_, d, v)| contradiction(record, match_?, d, v))
        .collect()
}

/// How the change of a quantity compares with the integral of its rate over the same windows.
#[derive(Debug, Clone, Copy)]
struct Match {
    /// Correlation coefficient.
    correlation: f64,
    /// The quantity's change over the rate's integral.
    gain: f64,
}

/// A quantity's changes, or a rate's integrals, over all windows of one width, and their squares' sum.
struct Windows {
    values: Vec<f64>,
    squares: f64,
}

impl Windows {
    /// Changes over windows, less their mean.
    fn changes(record: &Record, quantity: Role) -> Option<Self> {
        let (values, width) = long(record, quantity)?;
        let pairs = values[width..].iter().zip(values);
        let mut moved: Vec<f64> = pairs.map(|(b, a)| b - a).collect();
        let drift = robust::mean(&moved);
        moved.iter_mut().for_each(|m| *m -= drift);
        Some(Self::new(moved))
    }

    /// Integrals over windows, the rate's mean left out.
    fn integrals(record: &Record, rate: Role) -> Option<Self> {
        let (values, width) = long(record, rate)?;
        let rest = robust::mean(values);
        let step_s = record.sample_rate_hz.recip();
        let mut sum: f64 = values[..width].iter().map(|v| v - rest).sum();
        let pairs = values[width..].iter().zip(values);
        let integral = pairs.map(|(b, a)| {
            let before = sum;
            sum += b - a;
            before * step_s
        });
        Some(Self::new(integral.collect()))
    }

    fn new(values: Vec<f64>) -> Self {
        let squares = dot(&values, &values);
        Self { values, squares }
    }
}

/// A channel's values and a window's width; `None` if it is short of windows.
fn long(record: &Record, role: Role) -> Option<(&[f64], usize)> {
    let values = record.values(role)?;
    let width = (values.len() / 100).clamp(2, 64);
    (values.len() >= 8 * width && record.sample_rate_hz > 0.0).then_some((values, width))
}

impl Match {
    fn of(quantity: &Windows, rate: &Windows) -> Option<Self> {
        let product = dot(&quantity.values, &rate.values);
        let size = (quantity.squares * rate.squares).sqrt();
        (size > 0.0 && size.is_finite()).then(|| Self {
            correlation: product / size,
            gain: product / rate.squares,
        })
    }
}

fn flag(record: &Record, role: Role, problem: Problem) -> Flag {
    let channel = record.channel(role).map(|c| c.name.as_str());
    Flag::new(channel, problem)
}

/// Each displacement follows the velocity of the other mass better than that of its own.
fn swapped(
    record: &Record,
    [x, y]: [Option<Match>; 2],
    [x_with_y, y_with_x]: [Option<Match>; 2],
) -> Option<Flag> {
    let (own_x, own_y) = (x?.correlation, y?.correlation);
    let (crossed_x, crossed_y) = (x_with_y?.correlation, y_with_x?.correlation);
    let crossed = crossed_x > SAME && crossed_y > SAME;
    let own = own_x > SAME - 0.1 || own_y > SAME - 0.1;
    let better = crossed_x - own_x > 0.05 && crossed_y - own_y > 0.05;
    (crossed && (better || !own)).then(|| {
        let problem = Problem::FollowsOtherMass {
            crossed: crossed_x,
            own: own_x,
        };
        flag(record, Role::VelocityX, problem)
    })
}

/// Samples before and after a contact's beginning between which velocities are compared.
const AROUND_CONTACT: usize = 4;

/// Contacts below which nothing is said about them.
const FEWEST_CONTACTS: usize = 4;

/// An impact takes speed from both masses: if their velocities, counted toward each other, jump in
/// opposite directions, one of them has the wrong sign. Which one it is the impacts of the whole campaign tell
/// ([`inverted_channels`](crate::motion::inverted_channels)), so the record is kept.
fn opposite_masses(record: &Record) -> Option<Flag> {
    let contact = record.channel(Role::Contact)?;
    let level = contact.threshold?;
    let (x, y) = (
        record.values(Role::VelocityX)?,
        record.values(Role::VelocityY)?,
    );
    let begins: Vec<usize> = (AROUND_CONTACT..contact.values.len().saturating_sub(AROUND_CONTACT))
        .filter(|&i| contact.values[i - 1] < level && contact.values[i] >= level)
        .collect();
    if begins.len() < FEWEST_CONTACTS {
        return None;
    }
    let jump = |v: &[f64], i: usize| v[i + AROUND_CONTACT] - v[i - AROUND_CONTACT];
    let jumps: Vec<[f64; 2]> = begins.iter().map(|&i| [jump(x, i), jump(y, i)]).collect();
    // a velocity that does not jump there more than it moves elsewhere shows no impact
    let usual = |v: &[f64]| {
        let all = (AROUND_CONTACT..v.len() - AROUND_CONTACT).map(|i| jump(v, i).powi(2));
        all.sum::<f64>() / v.len() as f64
    };
    let at_contact =
        |k: usize| jumps.iter().map(|j| j[k].powi(2)).sum::<f64>() / jumps.len() as f64;
    let seen = at_contact(0) > 4.0 * usual(x) && at_contact(1) > 4.0 * usual(y);
    let product: f64 = jumps.iter().map(|j| j[0] * j[1]).sum::<f64>() / jumps.len() as f64;
    let correlation = product / (at_contact(0) * at_contact(1)).sqrt();
    let opposite = seen && correlation < -SAME;
    opposite.then(|| flag(record, Role::VelocityY, Problem::OppositeJumps).excluding(false))
}

/// How far from 1 the scales of two channels may be together where only a sign is wrong.
const ONLY_SIGN: f64 = 0.1;

/// A quantity that falls as the integral of its rate rises. Of a harmonic motion, so do a rate and the integral
/// of its quantity: channels that are swapped look alike, but for their scales.
fn opposite(record: &Record, gain: f64, d: Role, v: Role) -> Flag {
    let (quantity, rate, factor) = (d, v, gain.abs());
    let problem = if (factor - 1.0).abs() < ONLY_SIGN {
        Problem::OppositeChannels { quantity, rate }
    } else {
        Problem::OppositeUnlikeChannels {
            quantity,
            rate,
            factor,
        }
    };
    flag(record, v, problem)
}

fn contradiction(record: &Record, found: Match, d: Role, v: Role) -> Option<Flag> {
    if found.correlation < -SAME {
        return Some(opposite(record, found.gain, d, v));
    }
    let compared = match d {
        Role::DisplacementX | Role::DisplacementY => ComparedChannels::Displacement,
        _ => ComparedChannels::Velocity,
    };
    let suspected = mistaken(found.gain, compared);
    let off = found.gain > SCALE_RATIO || found.gain < 1.0 / SCALE_RATIO || suspected.is_some();
    let contradicts = found.correlation > SAME && off;
    contradicts.then(|| {
        flag(
            record,
            v,
            scales_contradict(compared, [d, v], found.gain, suspected),
        )
    })
}

fn scales_contradict(
    compared: ComparedChannels,
    [quantity, rate]: [Role; 2],
    ratio: f64,
    units: Option<MistakenUnits>,
) -> Problem {
    match (compared, units) {
        (ComparedChannels::Displacement, Some(units)) => Problem::PathsDifferByUnits {
            quantity,
            rate,
            ratio,
            units,
        },
        (ComparedChannels::Displacement, None) => Problem::PathsDiffer {
            quantity,
            rate,
            ratio,
        },
        (_, Some(units)) => Problem::SpeedsDifferByUnits {
            quantity,
            rate,
            ratio,
            units,
        },
        (_, None) => Problem::SpeedsDiffer {
            quantity,
            rate,
            ratio,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Channel, Setting};

    fn record(signals: &[(Role, &dyn Fn(f64) -> f64)]) -> Record {
        let channels = signals
            .iter()
            .map(|(role, of)| Channel {
                role: *role,
                name: role.name().to_owned(),
                dimension: role.dimension().unwrap(),
                values: (0..2000).map(|i| of(f64::from(i) / 2000.0)).collect(),
                high_pass_hz: None,
                low_pass: None,
                smoothing: None,
                threshold: None,
            })
            .collect();
        Record {
            id: "r".into(),
            sample_rate_hz: 2000.0,
            channels,
            setting: Setting::default(),
            listed: Default::default(),
            flags: Vec::new(),
        }
    }

    const W: f64 = 80.0;

    #[test]
    fn factors_between_units_are_named() {
        use ComparedChannels::{Displacement, Frequency, Velocity};
        use MistakenUnits::{
            GravityMetres, HertzKilohertz, HertzRadians, MetresMillimetres, RmsPeak,
        };
        for (ratio, compared, named) in [
            (1000.0, Displacement, MetresMillimetres),
            (0.001, Velocity, MetresMillimetres),
            (1000.0, Frequency, HertzKilohertz),
            (9.81, Velocity, GravityMetres),
            (-0.1592, Frequency, HertzRadians),
            (1.41, Displacement, RmsPeak),
        ] {
            assert_eq!(mistaken(ratio, compared), Some(named), "{ratio}");
        }
        for ratio in [1.0, 1.2, f64::NAN] {
            assert_eq!(mistaken(ratio, Velocity), None);
        }
    }

    #[test]
    fn factors_that_the_quantities_compared_cannot_have_are_not_named() {
        use ComparedChannels::{Displacement, Frequency, Velocity};
        for (ratio, compared) in [
            (10.0, Displacement),
            (std::f64::consts::TAU, Displacement),
            (std::f64::consts::TAU, Velocity),
            (std::f64::consts::SQRT_2, Frequency),
            (9.81, Frequency),
            (25.4, Frequency),
        ] {
            assert_eq!(mistaken(ratio, compared), None, "{ratio} {compared:?}");
        }
    }

    fn codes(signals: &[(Role, &dyn Fn(f64) -> f64)]) -> Vec<&'static str> {
        inspect(&record(signals))
            .into_iter()
            .map(|f| f.code.name())
            .collect()
    }

    #[test]
    fn channels_that_belong_together_pass_and_others_are_reported() {
        let dx = |t: f64| 1e-3 * (W * t).sin();
        let vx = |t: f64| 1e-3 * W * (W * t).cos();
        let dy = |t: f64| 1e-3 * (2.0 * W * t).sin();
        let vy = |t: f64| 2e-3 * W * (2.0 * W * t).cos();
        let against = |t: f64| -vx(t);
        let thousandfold = |t: f64| 1e3 * vx(t);
        use Role::{DisplacementX, DisplacementY, VelocityX, VelocityY};
        assert!(codes(&[(DisplacementX, &dx), (VelocityX, &vx)]).is_empty());
        assert_eq!(
            codes(&[(DisplacementX, &dx), (VelocityX, &against)]),
            ["opposite_sign"]
        );
        assert_eq!(
            codes(&[(DisplacementX, &dx), (VelocityX, &thousandfold)]),
            ["scales_contradict"]
        );
        let good = [
            (DisplacementX, &dx as &dyn Fn(f64) -> f64),
            (DisplacementY, &dy),
            (VelocityX, &vx),
            (VelocityY, &vy),
        ];
        assert!(codes(&good).is_empty());
        let swapped = [
            (DisplacementX, &dx as &dyn Fn(f64) -> f64),
            (DisplacementY, &dy),
            (VelocityX, &vy),
            (VelocityY, &vx),
        ];
        assert_eq!(codes(&swapped), ["swapped_masses"]);
    }
}
