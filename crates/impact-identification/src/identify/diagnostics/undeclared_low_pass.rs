//! Order and corner of a low-pass that is not stated. Jumps show that there is one and about which corner it has;
//! the waveforms tell the rest: behind one pole an amplitude at the frequency f is smaller by ½(f/`f_c`)², behind
//! more of them, as far as second order in f/`f_c` goes, it is not. The waveforms are fitted with either.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::identify::first_values::start;
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::joint;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::effect::EffectKind;
use impact_fit::parameters::gain_index;
use impact_records::motion::{LateChannel, Observation};
use impact_records::record::LowPass;

/// What one pole lowers amplitudes by, over ½(f/`f_c`)² with the corner that jumps show: in equal steps, as it is
/// tried; jumps show corners up to 1.6 times as high as they are (`low_pass_200_1` of tests/scripts, seeds 1001 to
/// 1020).
const LOWERED: [f64; 3] = [0.5, 1.25, 2.0];
/// Range of it that these tell.
const TOLD: [f64; 2] = [0.25, 3.0];
/// The same of two poles: what they turn phases by beyond a delay, which grows as (f/`f_c`)³. Jumps of differentiated
/// displacements behind 100 Hz showed corners of 130 to 144 Hz: 2.2 and 3.0.
const TURNED: [f64; 3] = [1.0, 2.25, 3.5];
const TURN_TOLD: [f64; 2] = [0.5, 5.0];
/// The same about the best of these, over it.
const NEARER: [f64; 3] = [0.5, 1.25, 2.0];
/// Difference of the sums of squares, over what is typical of them, from which one order fits better: three
/// standard errors.
const SURE: f64 = 9.0;

/// The observations and the stated delays, as if channels had passed other filters than was assumed.
pub struct Refiltered {
    /// The observations.
    pub observations: Vec<Observation>,
    /// What is stated; the delays are those beside the filters.
    pub nominal: Nominal,
}

impl Refiltered {
    /// The same evidence with these.
    pub fn evidence<'a>(&'a self, of: &Evidence<'a>) -> Evidence<'a> {
        Evidence {
            observations: &self.observations,
            nominal: self.nominal,
            ..*of
        }
    }
}

/// The evidence behind the low-pass that fits its waveforms best, where one was found that is not stated.
pub fn behind(evidence: &Evidence<'_>) -> Option<Refiltered> {
    let channels = filtered(evidence);
    if channels.is_empty() {
        return None;
    }
    let mut selection = Selection::new(evidence);
    let resonance = selection.fit_resonance();
    let begin = start(evidence, resonance.as_ref());
    let found = selection.fit_trajectories(begin)?.ok()?;
    let fitted = found.fit.parameters.ideal();
    let records = &selection.blocks.trajectory.records;
    let kept: BTreeSet<usize> = records.iter().map(|r| r.observation).collect();
    let both = joint::curve_and_waveforms();
    let fit = |evidence: &Evidence<'_>| {
        let begin = evidence.nominal.applied(fitted);
        let mut blocks = Blocks::new(evidence);
        blocks
            .trajectory
            .records
            .retain(|r| kept.contains(&r.observation));
        blocks.allow_least(&begin);
        blocks.keep_those_with_an_orbit(&begin);
        let simple = Nominal {
            effects: evidence.nominal.effects.without(EffectKind::ForceFrequency),
            ..evidence.nominal
        };
        let fitted = |nominal: &Nominal| joint::rough(&blocks, begin, &both, nominal);
        let open = fitted(&evidence.nominal)?;
        Some(Costs {
            open: open.cost,
            simple: fitted(&simple)?.cost,
            residuals: open.residuals,
        })
    };
    settled(evidence, &channels, &fit)
}

/// The channels whose jumps show a low-pass that is not stated, of an order that they do not tell.
fn filtered(evidence: &Evidence<'_>) -> Vec<LateChannel> {
    let late = evidence.observations.first().map_or(&[][..], |o| &o.late);
    let filtered = late
        .iter()
        .filter(|l| l.low_pass.is_some() && l.order_share >= 1.0);
    filtered.copied().collect()
}

/// Sums of squares of a fit of all waveforms.
#[derive(Clone, Copy)]
struct Costs {
    /// Where the force may change with the frequency.
    open: f64,
    /// Where it may not: such a change and one pole lower amplitudes alike.
    simple: f64,
    /// Residuals.
    residuals: usize,
}

/// The evidence with the filter of some channels that fits best, by fits of its waveforms. Where a change of the force explains as
/// much as one pole does, the filter, which is known to be there, is taken, and what it lowers stays open.
fn settled(
    evidence: &Evidence<'_>,
    channels: &[LateChannel],
    fit: &dyn Fn(&Evidence<'_>) -> Option<Costs>,
) -> Option<Refiltered> {
    let refiltered = |order, factor, share| refiltered(evidence, channels, order, factor, share);
    let costs = |order: u32, corner: f64| fit(&refiltered(order, corner, 1.0).evidence(evidence));
    let one_pole = all(LOWERED.map(|lowered| costs(1, corner(lowered))))?;
    let two_poles = all(TURNED.map(|turned| costs(2, corner_of_two(turned))))?;
    let parabola = Parabola::through(LOWERED, TOLD, one_pole.map(|c| c.simple));
    let open = Parabola::through(LOWERED, TOLD, one_pole.map(|c| c.open)).least;
    let [shown, ..] = two_poles;
    let coarse = Parabola::through(TURNED, TURN_TOLD, two_poles.map(|c| c.simple));
    let typical_of = |least: f64| (least / shown.residuals.max(1) as f64).max(1.0);
    // the corner that jumps show, unless the waveforms surely have another one
    let moved = (shown.simple - coarse.least) / typical_of(coarse.least) > SURE;
    let elsewhere = if moved {
        nearer(coarse.at, &|turned| costs(2, corner_of_two(turned)))
    } else {
        None
    };
    let (two_simple, two_open, factor) = elsewhere.unwrap_or((shown.simple, shown.open, 1.0));
    let typical = typical_of(open.min(two_open));
    let better = (two_simple - parabola.least) / typical;
    let surely = (two_open - open) / typical;
    let error = (typical / parabola.curvature).sqrt() / parabola.at;
    let (order, factor, order_share) = match (better > SURE, surely) {
        (true, surely) if surely > SURE => (1, corner(parabola.at), error.min(1.0)),
        (true, _) => (1, corner(parabola.at), 1.0),
        (false, surely) if surely < -SURE => (2, factor, 0.0),
        (false, _) => (2, factor, 1.0),
    };
    Some(refiltered(order, factor, order_share))
}

/// The best of two poles near a value of what they turn: its sums of squares, without and with a change of the force,
/// and its corner over the one that jumps show.
fn nearer(turned: f64, costs: &dyn Fn(f64) -> Option<Costs>) -> Option<(f64, f64, f64)> {
    let at = NEARER.map(|factor| factor * turned);
    let found = all(at.map(costs))?;
    let through = |of: fn(Costs) -> f64| Parabola::through(at, TURN_TOLD, found.map(of));
    let simple = through(|c| c.simple);
    let factor = corner_of_two(simple.at);
    Some((simple.least, through(|c| c.open).least, factor))
}

/// The corner over the one that jumps show at which one pole lowers amplitudes by so much.
fn corner(lowered: f64) -> f64 {
    lowered.sqrt().recip()
}

/// The same of two poles that turn phases by so much.
fn corner_of_two(turned: f64) -> f64 {
    turned.cbrt().recip()
}

/// The costs if there are all of them.
fn all(costs: [Option<Costs>; 3]) -> Option<[Costs; 3]> {
    let [a, b, c] = costs;
    Some([a?, b?, c?])
}

/// A sum of squares over what a filter does to the motion.
struct Parabola {
    at: f64,
    least: f64,
    /// What it grows by over the square of the distance from its least.
    curvature: f64,
}

impl Parabola {
    /// Through the sums of squares at three values in equal steps, within the range that these tell; where they have no
    /// least one, the best of them.
    fn through(at: [f64; 3], told: [f64; 2], [left, middle, right]: [f64; 3]) -> Self {
        let step = at[1] - at[0];
        let slope = (right - left) / (2.0 * step);
        let curvature = (left - 2.0 * middle + right) / (2.0 * step * step);
        if curvature > 0.0 {
            let least_at = (at[1] - slope / (2.0 * curvature)).clamp(told[0], told[1]);
            let off = least_at - at[1];
            return Self {
                at: least_at,
                least: middle + slope * off + curvature * off * off,
                curvature,
            };
        }
        Self {
            at: if left < right { at[0] } else { at[2] },
            least: left.min(right),
            curvature: f64::MIN_POSITIVE,
        }
    }
}

/// As if the channels had passed a low-pass of an order whose corner is that which their jumps show times a factor;
/// `order_share` is what is left open of ½(f/`f_c`)².
fn refiltered(
    evidence: &Evidence<'_>,
    channels: &[LateChannel],
    order: u32,
    factor: f64,
    order_share: f64,
) -> Refiltered {
    let mut observations = evidence.observations.to_vec();
    let mut nominal = evidence.nominal;
    for channel in channels {
        let Some(assumed) = channel.low_pass else {
            continue;
        };
        let other = LowPass {
            corner_hz: factor * assumed.corner_hz,
            order,
        };
        let later_s = assumed.delay_s() - other.delay_s();
        if let Some(i) = gain_index(channel.role) {
            nominal.delays_s[i] += later_s;
        }
        let is = LateChannel {
            delay_s: channel.delay_s + later_s,
            low_pass: Some(other),
            order_share,
            ..*channel
        };
        observations
            .iter_mut()
            .for_each(|o| refilter(o, &is, [assumed, other]));
    }
    Refiltered {
        observations,
        nominal,
    }
}

/// Replace the low-pass that was assumed of a channel of one record by another.
fn refilter(observation: &mut Observation, channel: &LateChannel, filters: [LowPass; 2]) {
    let late = observation.late.iter_mut();
    late.filter(|l| l.role == channel.role)
        .for_each(|l| *l = *channel);
    if let Some(folded) = &mut observation.folded {
        let channels = Arc::make_mut(folded).channels.iter_mut();
        let own = channels.filter(|c| c.role == channel.role);
        own.for_each(|c| c.low_pass = channel.low_pass);
    }
    let frequency_hz = observation.frequency_hz();
    for response in &mut observation.response {
        if let Some(f) = frequency_hz.filter(|_| response.role == channel.role) {
            *response = response.behind_low_pass(filters, f);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;

    use super::*;
    use impact_records::event::RigKind;
    use impact_records::motion::{Motion, Response};
    use impact_records::record::Role;

    /// Impactless records at some frequencies of a velocity of unit amplitude behind a filter, as if jumps had shown
    /// one of second order at 250 Hz.
    fn observations(behind: LowPass, error: f64) -> Vec<Observation> {
        let shown = LowPass {
            corner_hz: 250.0,
            order: 2,
        };
        let one = |frequency_hz: f64| {
            let rate = Complex::new(0.0, std::f64::consts::TAU * frequency_hz);
            let divided = behind.transfer(rate) / shown.transfer(rate);
            let mut o = Observation::of("r", frequency_hz, Motion::Impactless);
            o.late = vec![LateChannel {
                low_pass: Some(shown),
                ..LateChannel::by(Role::VelocityX, 0.0)
            }];
            o.response = vec![Response {
                role: Role::VelocityX,
                real: divided.re,
                imaginary: divided.im,
                error,
                residual_rms: 0.0,
                high_pass_hz: None,
            }];
            o
        };
        [10.0, 15.0, 20.0, 25.0].map(one).to_vec()
    }

    /// The filter that is settled on, and what stays open of it, where fits compare amplitudes with 1; where the
    /// force may change with the frequency they fit anyhow.
    fn found(behind: LowPass, force_changes: f64, error: f64) -> (LowPass, f64) {
        let observations = observations(behind, error);
        let evidence = Evidence {
            rig: RigKind::Double,
            observations: &observations,
            brackets: &[],
            nominal: Nominal::default(),
            uncertainty: Default::default(),
            progress: None,
        };
        let fit = |other: &Evidence<'_>| {
            let responses = other.observations.iter().flat_map(|o| &o.response);
            let off = responses.map(|r| ((r.amplitude() - 1.0) / r.error).powi(2));
            let simple = 4.0 + off.sum::<f64>();
            Some(Costs {
                open: 4.0 + (1.0 - force_changes) * (simple - 4.0),
                simple,
                residuals: 4,
            })
        };
        let settled = settled(&evidence, &filtered(&evidence), &fit).expect("a filter");
        let late = settled.observations[0].late[0];
        // the delay as a whole stays as it was measured
        let filter = late.low_pass.expect("a filter");
        let whole = settled.nominal.delays_s[0] + filter.delay_s();
        let shown = observations[0].late[0].low_pass.expect("a filter");
        assert!((whole - shown.delay_s()).abs() < 1e-12);
        (filter, late.order_share)
    }

    #[test]
    fn valid_order_and_corner_of_a_filter_follow_from_what_it_lowers() {
        let one_pole = LowPass {
            corner_hz: 200.0,
            order: 1,
        };
        let (filter, open) = found(one_pole, 0.0, 1e-4);
        assert_eq!(filter.order, 1);
        assert!((filter.corner_hz - 200.0).abs() < 1.0, "{filter:?}");
        assert!(open < 0.05, "{open}");
        // the same where a change of the force explains it as well: the order stays open
        let (filter, open) = found(one_pole, 1.0, 1e-4);
        assert_eq!((filter.order, open), (1, 1.0));
        let two_poles = LowPass {
            order: 2,
            ..one_pole
        };
        let (filter, open) = found(two_poles, 0.0, 1e-4);
        assert_eq!((filter.order, open), (2, 0.0));
        // jumps show a corner of 250 Hz; the waveforms surely have another one
        let lower = LowPass {
            corner_hz: 180.0,
            order: 2,
        };
        let (filter, open) = found(lower, 0.0, 3e-6);
        assert_eq!((filter.order, open), (2, 0.0));
        assert!((filter.corner_hz - 180.0).abs() < 9.0, "{filter:?}");
    }
}
