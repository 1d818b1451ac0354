//! Channels whose delay, sign or filter is not as stated: found by the impacts before the fit, or by the fit.

use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use crate::identify::diagnostics::off_stated;
use impact_fit::evidence::Nominal;
use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::{Coordinate, GAIN_ROLES};
use impact_fit::solver::Prior;
use impact_records::motion::{Observation, one_pole_hz};
use impact_records::record::{LowPass, Role};
use std::collections::BTreeSet;

/// Standard deviations of what is stated from which a delay is named.
const SURE: f64 = 4.0;

/// The channels that are later or earlier than stated; what they showed was moved where impacts told it, and
/// the fit allows for the rest. Of a low-pass that is not stated, what its order leaves open stays in doubt.
pub fn late_channels(
    observations: &[Observation],
    found: Option<&MethodFit>,
    blocks: &Blocks,
    nominal: &Nominal,
) -> Vec<Suspicion> {
    let moved = observations.first().map_or(&[][..], |o| &o.late[..]);
    let of = |(i, channel): (usize, &_)| {
        let moved = moved.iter().find(|l| l.role == *channel);
        if let Some((late, filter)) = moved.and_then(|l| Some((l, l.low_pass?))) {
            let lags = observations.iter().flat_map(|o| &o.lags);
            let step_s = lags
                .map(|lag| lag.step_s)
                .fold(blocks.half_sample_s(), f64::max);
            let finding = Finding::UndeclaredLowPass {
                channel: *channel,
                corner_hz: filter.corner_hz,
                one_pole_hz: one_pole_hz(filter.corner_hz, step_s),
                order: (late.order_share < 1.0).then_some(filter.order),
            };
            return Some(Suspicion {
                finding,
                doubts: found.map_or_else(Vec::new, |f| by_order(f, filter, late.order_share)),
            });
        }
        let moved_ms = moved.map_or(0.0, |l| 1e3 * l.delay_s);
        let stated_s = nominal.delay_uncertainties_s[i].unwrap_or(blocks.half_sample_s());
        let centre_ms = 1e3 * nominal.delays_s[i];
        let by_fit = found.and_then(|f| beyond_stated(f, i, [centre_ms, 1e3 * stated_s]));
        let (rest_ms, sure) = by_fit.unwrap_or((0.0, 0.0));
        let finding = Finding::LateChannel {
            channel: *channel,
            later_ms: moved_ms + rest_ms,
            z_score: sure + moved_ms / (1e3 * stated_s).max(f64::MIN_POSITIVE),
        };
        (moved_ms != 0.0 || sure.abs() > SURE).then(|| finding.into())
    };
    // what drives and closes is not fitted
    let others = moved.iter().filter(|l| !GAIN_ROLES.contains(&l.role));
    let others = others.filter(|l| l.delay_s != 0.0).map(|l| {
        let finding = Finding::LateChannel {
            channel: l.role,
            later_ms: 1e3 * l.delay_s,
            z_score: l.delay_s / blocks.half_sample_s().max(f64::MIN_POSITIVE),
        };
        finding.into()
    });
    let inverted = moved.iter().filter(|l| l.inverted).map(|l| {
        let finding = Finding::InvertedChannel { channel: l.role };
        finding.into()
    });
    let filtered = moved.iter().filter_map(|l| {
        let finding = Finding::DriveHighPass {
            channel: l.role,
            corner_hz: l.high_pass_hz?,
        };
        Some(finding.into())
    });
    let turned = turned_channels(observations).map(Suspicion::from);
    let unsteady = moved.iter().filter_map(|l| {
        let finding = Finding::UnsteadyChannel {
            channel: l.role,
            scatter_ms: 1e3 * l.unsteady_s?,
        };
        Some(finding.into())
    });
    let motion = GAIN_ROLES.iter().enumerate().filter_map(of);
    inverted
        .chain(turned)
        .chain(filtered)
        .chain(unsteady)
        .chain(motion)
        .chain(others)
        .collect()
}

/// The channels that are of the other sign in some records.
fn turned_channels(observations: &[Observation]) -> impl Iterator<Item = Finding> {
    let roles = observations.iter().flat_map(|o| &o.setting.turned);
    let roles: BTreeSet<Role> = roles.copied().collect();
    roles.into_iter().map(move |channel| {
        let turned = |o: &&Observation| o.setting.turned.contains(&channel);
        let own = observations.iter().filter(turned);
        Finding::TurnedChannel {
            channel,
            records: own.map(|o| o.record.clone()).collect(),
            of: observations.len(),
        }
    })
}

/// What is open where a filter's order is not known, or its corner: behind one pole an amplitude at the frequency f
/// is smaller by half of (f/fc)², behind more of them not at all, and a share of that is open. f0 follows from
/// phases, and the delay is fitted.
fn by_order(found: &MethodFit, filter: LowPass, open: f64) -> Vec<Doubt> {
    let p = &found.fit.parameters;
    let share = open * 0.5 * (p.natural_frequency_hz / filter.corner_hz).powi(2);
    let of = |(parameter, by)| Doubt::material(found, parameter, by, Note::InstrumentOff);
    let open = [
        (Coordinate::Restitution, share * p.restitution),
        (Coordinate::Damping, share),
        (Coordinate::Deflection, share),
    ];
    open.into_iter().filter_map(of).collect()
}

/// How far a fit has a delay off the centre of its prior, ms, and the statistic of that.
fn beyond_stated(found: &MethodFit, i: usize, [centre, stated]: [f64; 2]) -> Option<(f64, f64)> {
    let coordinate = Coordinate::Delay(i);
    let off = off_stated::alone(found, Prior::new(coordinate, centre, stated))?;
    let fitted = found.fit.parameters.coordinate(coordinate);
    Some((fitted - centre, off.z_score))
}
