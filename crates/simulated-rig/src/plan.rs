//! Which settings a synthetic laboratory visits, in which order.

use serde::{Deserialize, Serialize};

use crate::truth::Truth;
use impact_oscillator::model::boundary::{eta_s2, etas_grazing, etas_s1};
use impact_oscillator::model::params::Machine;
use impact_records::record::Sweep;
use impact_records::signal::whole;

/// One setting: a record is taken there once the motion has settled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
    /// Direction of the sweep.
    pub sweep: Sweep,
    /// Whether the motion starts from rest here instead of going on from the step before.
    pub from_rest: bool,
}

/// The settings of a whole campaign in the order of acquisition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The steps.
    pub steps: Vec<Step>,
}

/// Clearance ratios of the gaps: the hysteresis region of z = 1 at several heights, the regions
/// of z = 1/2 and more below, as the paper's Fig. 11 shows them.
const GAPS: [f64; 8] = [0.35, 0.6, 0.95, 1.4, 2.0, 2.7, 3.5, 4.4];

/// Clearance ratio at which nothing touches, as a multiple of the resonance amplitude.
const OPEN_GAP: f64 = 1.25;

impl Plan {
    /// A plan of about `records` records for a rig of roughly these parameters.
    ///
    /// One gap is wide open and gives the resonance curve; at every other gap the frequency is
    /// stepped up and then down again, from η = 0.75 to beyond the end of z = 1 (z = 1/2 and more
    /// appear above it at small gaps). Fewer records mean fewer gaps.
    pub fn for_rig(
        natural_frequency_hz: f64,
        damping_ratio: f64,
        static_deflection_m: f64,
        records: usize,
    ) -> Self {
        let resonance_steps = (records / 10).clamp(4, 24);
        let sweeps = records.saturating_sub(resonance_steps).max(4);
        let gaps = chosen_gaps(sweeps);
        let mut steps = Vec::with_capacity(records);
        let open = OPEN_GAP * 0.5 / damping_ratio * static_deflection_m;
        let grid = frequencies(natural_frequency_hz, (0.7, 1.5), resonance_steps);
        push_sweep(&mut steps, &grid, open, Sweep::Up);
        for (i, rho) in gaps.iter().enumerate() {
            // Shares of what is left, so that the total comes out exactly.
            let (from, to) = (sweeps * i / gaps.len(), sweeps * (i + 1) / gaps.len());
            let (up, down) = ((to - from).div_ceil(2), (to - from) / 2);
            let clearance_m = round_to(rho * static_deflection_m, 1e-5);
            let range = (0.75, highest(damping_ratio, *rho));
            let grid = frequencies(natural_frequency_hz, range, up.max(2));
            push_sweep(&mut steps, &grid, clearance_m, Sweep::Up);
            let mut grid = frequencies(natural_frequency_hz, range, down.max(2));
            grid.reverse();
            push_sweep(&mut steps, &grid, clearance_m, Sweep::Down);
        }
        Self { steps }
    }
}

/// Clearance ratios at which the end of z = 1 is looked for in small steps.
const FINE_GAPS: [f64; 6] = [0.95, 1.4, 2.0, 2.7, 3.5, 4.4];
/// Records without impacts beside them.
const FINE_RESONANCE: usize = 18;
/// η at which z = 1 is begun from rest, and the step by which it is followed.
const FOLLOWED: (f64, f64) = (0.98, 0.04);
/// Share of its frequency below s2 from which on the steps are small: more than contacts that last move it.
const APPROACHED: f64 = 0.03;

impl Plan {
    /// The resonance curve, and at several gaps upward sweeps past the end of z = 1 in steps of a share of f0; `offset`
    /// (0 to 1) is where in a step the boundary of the ideal model lies.
    pub fn past_the_end(truth: &Truth, step: f64, offset: f64) -> Self {
        let (f0, x_st) = (truth.natural_frequency_hz(), truth.static_deflection_m());
        let open = OPEN_GAP * 0.5 / truth.damping_ratio() * x_st;
        let mut steps = Vec::new();
        push_sweep(
            &mut steps,
            &frequencies(f0, (0.7, 1.5), FINE_RESONANCE),
            open,
            Sweep::Up,
        );
        let machine = truth.machine();
        for rho in FINE_GAPS {
            let end = eta_s2(&machine, rho, 1).map(|point| point.eta);
            let Some(end) = end.filter(|eta| (1.08..2.0).contains(eta)) else {
                continue;
            };
            // whole steps below the boundary, and one and a half beyond
            let below = (APPROACHED * end / step).ceil() + offset;
            let first = end - below * step;
            let (from, stride) = FOLLOWED;
            let coarse = (0..).map(|i| from + stride * f64::from(i));
            let coarse = coarse.take_while(|eta| *eta < first - 0.5 * step.min(stride));
            let fine = (0..).map(|i| first + step * f64::from(i));
            let fine = fine.take_while(|eta| *eta < end + 1.5 * step);
            let grid: Vec<f64> = coarse
                .chain(fine)
                .map(|eta| round_to(eta * f0, 1e-3))
                .collect();
            push_sweep(&mut steps, &grid, round_to(rho * x_st, 1e-5), Sweep::Up);
        }
        Self { steps }
    }
}

/// Clearance ratios of sweeps through beats: z = 2/1 below ρ = 1; between ρ′ and z = 1 at 2 z = 2/2, at 3.5 z = 1/3, at 5
/// z = 1/4 and 1/5.
const BEAT_GAPS: [f64; 4] = [0.6, 2.0, 3.5, 5.0];
/// Share of a gap's records between ρ′ and z = 1.
const BEAT_SHARE: f64 = 0.4;

impl Plan {
    /// A plan of about `records` records whose upward sweeps pass the beat motions from ρ′ to s1 of z = 1 in small steps: z
    /// = 1/5 to 1/2, 2/2 and chaos, as in the paper's Figs. 12 and 13.
    pub fn through_beats(truth: &Truth, records: usize) -> Self {
        let (f0, x_st) = (truth.natural_frequency_hz(), truth.static_deflection_m());
        let resonance_steps = (records / 10).clamp(4, 24);
        let sweeps = records.saturating_sub(resonance_steps);
        let open = OPEN_GAP * 0.5 / truth.damping_ratio() * x_st;
        let mut steps = Vec::with_capacity(records);
        let grid = frequencies(f0, (0.7, 1.5), resonance_steps);
        push_sweep(&mut steps, &grid, open, Sweep::Up);
        for (i, rho) in BEAT_GAPS.into_iter().enumerate() {
            let part = |i: usize| sweeps * i / BEAT_GAPS.len();
            let count = (part(i + 1) - part(i)).max(10);
            let fine = beats(truth, rho, whole::index(BEAT_SHARE * count as f64));
            let left = count - fine.len();
            let (up, down) = (left.div_ceil(2), left / 2);
            let lowest = fine.first().copied().unwrap_or(0.75);
            let top = highest(truth.damping_ratio(), rho);
            let coarse = match fine.last() {
                Some(last) => spread((*last, top), up + 1).split_off(1),
                None => spread((lowest, top), up),
            };
            let hertz = |eta: &f64| round_to(eta * f0, 0.01);
            let rising: Vec<f64> = fine.iter().chain(&coarse).map(hertz).collect();
            let falling = spread((lowest, top), down);
            let falling: Vec<f64> = falling.iter().rev().map(hertz).collect();
            let clearance_m = round_to(rho * x_st, 1e-5);
            push_sweep(&mut steps, &rising, clearance_m, Sweep::Up);
            push_sweep(&mut steps, &falling, clearance_m, Sweep::Down);
        }
        Self { steps }
    }
}

/// Frequency ratios from half a step below ρ′ to half a step beyond s1 of z = 1; none where the gap has no ρ′ below
/// resonance.
fn beats(truth: &Truth, rho: f64, count: usize) -> Vec<f64> {
    let machine = truth.machine();
    let Some(grazing) = etas_grazing(&machine, rho)
        .first()
        .copied()
        .filter(|eta| *eta < 1.0)
    else {
        return Vec::new();
    };
    let doublings = etas_s1(&machine, rho, 1);
    let Some(end) = doublings.iter().map(|p| p.eta).find(|eta| *eta > grazing) else {
        return Vec::new();
    };
    let step = (end - grazing) / count.saturating_sub(2).max(1) as f64;
    (0..count)
        .map(|i| grazing + (i as f64 - 0.5) * step)
        .collect()
}

fn chosen_gaps(sweeps: usize) -> Vec<f64> {
    let wanted = (sweeps / 40).clamp(1, GAPS.len());
    // Spread over the list, the middle of the hysteresis region first.
    (0..wanted)
        .map(|i| GAPS[((2 * i + 1) * GAPS.len()) / (2 * wanted)])
        .collect()
}

/// Highest η of the sweeps at a gap: beyond the end of z = 1 for elastic impacts, and at small
/// gaps on to the regions of z = 1/2 and 1/3.
fn highest(damping_ratio: f64, rho: f64) -> f64 {
    if rho < 0.7 {
        return 3.2;
    }
    let elastic = Machine::symmetric(damping_ratio, 0.95);
    let end = eta_s2(&elastic, rho, 1).map_or(2.0, |point| point.eta);
    (end + 0.2).clamp(1.3, 2.3)
}

fn frequencies(natural_frequency_hz: f64, range: (f64, f64), count: usize) -> Vec<f64> {
    let etas = spread(range, count);
    etas.iter()
        .map(|eta| round_to(eta * natural_frequency_hz, 0.01))
        .collect()
}

/// Evenly spread values, both ends among them.
fn spread((from, to): (f64, f64), count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|i| from + (to - from) * i as f64 / last)
        .collect()
}

fn round_to(value: f64, step: f64) -> f64 {
    // Division by the reciprocal keeps the decimal short: 12.6, not 12.600000000000001.
    (value / step).round() / (1.0 / step).round()
}

fn push_sweep(steps: &mut Vec<Step>, grid: &[f64], clearance_m: f64, sweep: Sweep) {
    for (i, frequency_hz) in grid.iter().enumerate() {
        let from_rest = i == 0 && sweep == Sweep::Up;
        steps.push(Step {
            frequency_hz: *frequency_hz,
            clearance_m,
            sweep,
            from_rest,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_steps_pass_the_end_of_z_1() {
        let truth = Truth::symmetric(0.8, 12.0, 0.05, 1e-3);
        for step in [0.07, 0.03, 0.01, 0.003] {
            let plan = Plan::past_the_end(&truth, step, 0.4);
            let mut gaps: Vec<f64> = plan.steps.iter().map(|s| s.clearance_m).collect();
            gaps.dedup();
            assert!(gaps.len() > 4);
            for gap in &gaps[1..] {
                let end = eta_s2(&truth.machine(), gap / 1e-3, 1).unwrap().eta;
                let at = plan.steps.iter().filter(|s| s.clearance_m == *gap);
                let etas: Vec<f64> = at.map(|s| s.frequency_hz / 12.0).collect();
                let above = etas
                    .iter()
                    .position(|eta| *eta > end)
                    .expect("a record beyond");
                // frequencies are rounded to 1 mHz
                let bracket = etas[above] - etas[above - 1];
                assert!((bracket - step).abs() < 2e-4, "{step} {etas:?}");
                assert!(
                    ((end - etas[above - 1]) / step - 0.4).abs() < 0.05,
                    "{step}"
                );
            }
        }
    }

    #[test]
    fn sweeps_through_beats_begin_below_grazing_and_end_beyond_z_1() {
        let truth = Truth::symmetric(0.9, 12.6, 0.07, 1e-3);
        let plan = Plan::through_beats(&truth, 220);
        assert_eq!(plan.steps.len(), 220);
        for (rho, grazing, doubling) in [(2.0, 0.7142, 0.9586), (5.0, 0.9203, 0.9917)] {
            let at = |s: &&Step| s.clearance_m == rho * 1e-3 && s.sweep == Sweep::Up;
            let rising = plan.steps.iter().filter(at).map(|s| s.frequency_hz / 12.6);
            let rising: Vec<f64> = rising.collect();
            assert!(
                rising[0] < grazing && rising[1] > grazing - 2e-3,
                "{rising:?}"
            );
            let within = rising.iter().filter(|eta| **eta < doubling);
            assert!((17..=19).contains(&within.count()), "{rising:?}");
        }
    }

    #[test]
    fn prop_a_plan_has_the_records_asked_for() {
        for records in [40, 100, 200, 333, 846] {
            let plan = Plan::for_rig(12.6, 0.07, 5e-4, records);
            assert_eq!(plan.steps.len(), records);
        }
    }
}
