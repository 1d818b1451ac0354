//! A small impact oscillator for examples: exact flights, crossings by bisection, closed forms of
//! the z = 1/n boundaries. One mass against a stop at ρ, unit drive.

use std::f64::consts::TAU;

use crate::motion::Motion;

/// Parameters of the example.
#[derive(Debug, Clone, Copy)]
pub struct Parameters {
    pub restitution: f64,
    pub damping: f64,
}

/// State at a drive phase.
#[derive(Debug, Clone, Copy, Default)]
pub struct State {
    pub x: f64,
    pub v: f64,
    /// η τ.
    pub phase: f64,
}

/// An impact: drive phase counted from the start, and speed before.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    pub phase: f64,
    pub speed: f64,
}

/// Forced motion: amplitude factors of cos and sin.
fn forced(p: &Parameters, eta: f64) -> (f64, f64) {
    let d = (1.0 - eta * eta).powi(2) + 4.0 * p.damping * p.damping * eta * eta;
    ((1.0 - eta * eta) / d, 2.0 * p.damping * eta / d)
}

/// State a time later in free flight.
pub fn flight(p: &Parameters, eta: f64, from: State, time: f64) -> State {
    let (c, s) = forced(p, eta);
    let omega = (1.0 - p.damping * p.damping).sqrt();
    let force = |phase: f64| c * phase.cos() + s * phase.sin();
    let force_v = |phase: f64| eta * (s * phase.cos() - c * phase.sin());
    let a = from.x - force(from.phase);
    let b = (from.v - force_v(from.phase) + p.damping * a) / omega;
    let (sin, cos) = (omega * time).sin_cos();
    let decay = (-p.damping * time).exp();
    let phase = from.phase + eta * time;
    let x = decay * (a * cos + b * sin);
    let v = decay * ((b * omega - p.damping * a) * cos - (a * omega + p.damping * b) * sin);
    State {
        x: x + force(phase),
        v: v + force_v(phase),
        phase,
    }
}

/// Marches some drive periods; gives the last state, the impacts, and samples if asked for.
pub fn march(
    p: &Parameters,
    (eta, rho): (f64, f64),
    start: State,
    periods: usize,
    steps: usize,
) -> (State, Vec<Hit>, Vec<State>) {
    let step = TAU / eta / steps as f64;
    let (mut state, mut hits, mut samples) = (start, Vec::new(), Vec::new());
    for _ in 0..periods * steps {
        samples.push(state);
        state = one_step(p, (eta, rho), state, step, &mut hits);
    }
    (state, hits, samples)
}

fn one_step(
    p: &Parameters,
    (eta, rho): (f64, f64),
    from: State,
    step: f64,
    hits: &mut Vec<Hit>,
) -> State {
    let (mut state, mut left) = (from, step);
    for _ in 0..6 {
        let next = flight(p, eta, state, left);
        if next.x <= rho {
            return next;
        }
        let (mut low, mut high) = (0.0, left);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if flight(p, eta, state, middle).x > rho {
                high = middle;
            } else {
                low = middle;
            }
        }
        let hit = flight(p, eta, state, low);
        hits.push(Hit {
            phase: hit.phase,
            speed: hit.v,
        });
        state = State {
            x: rho,
            v: -p.restitution * hit.v.abs(),
            phase: hit.phase,
        };
        left -= low;
    }
    State {
        x: rho.min(state.x),
        v: 0.0,
        phase: from.phase + eta * step,
    }
}

/// Type of motion of a settled stretch of some periods.
pub fn classify(hits: &[Hit], end_phase: f64, periods: usize) -> Motion {
    let recent: Vec<&Hit> = hits
        .iter()
        .filter(|h| h.phase > end_phase - TAU * periods as f64)
        .collect();
    if recent.is_empty() {
        return Motion::Impactless;
    }
    for n in 1..=5usize {
        let per = recent.len() as f64 * n as f64 / periods as f64;
        let count = per.round() as usize;
        if count == 0 || (per - per.round()).abs() > 0.3 || recent.len() <= count {
            continue;
        }
        let closes = recent.windows(count + 1).all(|w| {
            let (a, b) = (w[0], w[count]);
            (b.phase - a.phase - TAU * n as f64).abs() < 2e-2
                && (b.speed - a.speed).abs() < 2e-2 * (1.0 + a.speed)
        });
        if closes {
            return Motion::periodic(count as u32, n as u32);
        }
    }
    let gap = recent
        .windows(2)
        .map(|w| w[1].phase - w[0].phase)
        .fold(0.0, f64::max);
    if gap > 2.6 * TAU {
        Motion::Beat
    } else {
        Motion::Chaotic
    }
}

/// ρ' = A(η), the amplitude of the impactless motion.
pub fn grazing(p: &Parameters, eta: f64) -> f64 {
    let (c, s) = forced(p, eta);
    c.hypot(s)
}

/// (ρ_s2, ρ_s1) of z = 1/n in closed form; not finite where there is none.
pub fn boundaries(p: &Parameters, eta: f64, n: u32) -> (f64, f64) {
    let (c_force, s_force) = forced(p, eta);
    let amplitude = c_force.hypot(s_force);
    let omega = (1.0 - p.damping * p.damping).sqrt();
    let period = TAU * f64::from(n) / eta;
    let decay = (-p.damping * period).exp();
    let (s, c) = (omega * period).sin_cos();
    let kappa = decay * s / (1.0 - decay * c);
    let b = (1.0 + p.restitution) / (omega * (decay * (c - s * kappa) - 1.0));
    let alpha = kappa * b;
    let q = -p.restitution + p.damping * alpha - omega * b;
    let s2 = amplitude * (1.0 + (alpha * eta / q).powi(2)).sqrt();
    let rr = 1.0 + (p.restitution * decay).powi(2);
    let g1 = (2.0 * p.restitution * decay * c - rr) * omega / (decay * s);
    let a2 = amplitude * amplitude;
    let kappa1 = (g1 / (1.0 + p.restitution) + (c_force * alpha - s_force * q / eta) / a2)
        / (c_force / a2 - 1.0);
    let v = amplitude / ((kappa1 - alpha).powi(2) + (q / eta).powi(2)).sqrt();
    (s2, kappa1 * v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_closed_forms_meet_the_published_numbers() {
        let p = Parameters {
            restitution: 0.9,
            damping: 0.07,
        };
        assert!((boundaries(&p, 1.1, 1).0 - 6.351_142).abs() < 1e-6);
        assert!((boundaries(&p, 1.6, 1).0 - 1.812_702).abs() < 1e-6);
        assert!((boundaries(&p, 0.9, 1).1 - 1.760_461).abs() < 1e-6);
        let (_, hits, _) = march(&p, (1.2, 2.0), State::default(), 400, 48);
        assert!((hits[hits.len() - 1].speed - 2.413_516).abs() < 1e-4);
    }
}
