//! A drive's channel that is not as stated, as impactless records show it by the phases of the motion behind it: later
//! or earlier than the channels of the motion, of the other sign, or behind a high-pass.

use crate::evidence::{Evidence, Nominal};
use crate::messages::ONE_DEGREE_OF_FREEDOM;
use crate::methods::blocks::Blocks;
use crate::methods::resonance::misfit::{least_of, misfit};
use crate::methods::resonance::phases::{
    EXPLAINED, Misstated, ONE, Phases, fastest_hz, with_responses,
};
use crate::methods::resonance::result::deviation;
use impact_records::motion::LateChannel;
use impact_records::record::{Role, before_high_pass};
use impact_records::signal::robust;

/// Greatest lag that is looked for, in periods of the fastest drive.
const WIDEST: f64 = 1.0;
/// Steps of the search in such a period: a tenth of a radian apart.
const STEPS: f64 = 60.0;
/// Corner over the slowest drive's frequency about which one is looked for, and powers of ten to both sides and in a step: it
/// turns phases by 0.001 to 0.8 rad.
const CORNER: f64 = 0.03;
const DECADES: f64 = 1.5;
const STEP: f64 = 0.25;

/// The causes by which the drive's channel may be other than stated in all records alike.
pub(super) fn causes(phases: &Phases<'_>) -> impl Iterator<Item = Misstated> {
    let late = phases.lag().map(|(lag_s, left)| Misstated {
        channels: vec![LateChannel::by(Role::Drive, lag_s)],
        left,
    });
    let turned = with_responses(phases.blocks, |_, _| -ONE);
    let turned = misfit(&turned, &phases.evidence.nominal).map(|left| Misstated {
        channels: vec![LateChannel::inverted(Role::Drive)],
        left,
    });
    let passed = (phases.at_once > EXPLAINED)
        .then(|| phases.high_pass())
        .flatten();
    late.into_iter().chain(turned).chain(passed)
}

impl Phases<'_> {
    /// The lag of the drive's channel with which the phases fit best, s, if it is noticed, and the misfit that it leaves.
    fn lag(&self) -> Option<(f64, f64)> {
        let misfit = |lag_s: f64| misfit(self.blocks, &behind(&self.evidence.nominal, lag_s));
        let unnoticed_s = self.unnoticed_s();
        let fits = deviation(&self.blocks.resonance, self.stated) < ONE_DEGREE_OF_FREEDOM;
        // the phases fit, and best near no lag
        if fits
            && [-unnoticed_s, unnoticed_s]
                .into_iter()
                .all(|lag_s| misfit(lag_s).is_none_or(|with| with > self.at_once))
        {
            return None;
        }
        let step_s = 1.0 / (STEPS * fastest_hz(self.blocks));
        let lag_s = least_of(WIDEST * STEPS * step_s, step_s, &misfit)?;
        let left = misfit(lag_s)?;
        (lag_s.abs() > unnoticed_s).then_some((lag_s, left))
    }

    /// The high-pass that the drive's channel has passed, as with an AC coupling: all motion then lags by as much as it
    /// leads.
    ///
    /// A corner below those that channels of the motion are stated to have may as well be an error of these.
    fn high_pass(&self) -> Option<Misstated> {
        let slowest_hz = slowest_hz(self.blocks);
        let corner = |decades: f64| CORNER * slowest_hz * 10f64.powf(decades);
        let behind = |decades: f64| {
            misfit(
                &undone(self.evidence, corner(decades)),
                &self.evidence.nominal,
            )
        };
        let decades = least_of(DECADES, STEP, &behind)?;
        let corner_hz = corner(decades);
        let stated = self.blocks.resonance.channels();
        let stated_hz = stated.filter_map(|(_, own_hz)| own_hz).fold(0.0, f64::max);
        (corner_hz > stated_hz).then_some(())?;
        Some(Misstated {
            left: behind(decades)?,
            channels: vec![LateChannel::behind(Role::Drive, corner_hz)],
        })
    }
}

/// Impactless records as the drive was before a high-pass of its channel: its phases and its amplitudes, over their median.
fn undone(evidence: &Evidence<'_>, corner_hz: f64) -> Blocks {
    let mut observations = evidence.observations.to_vec();
    let mut amplitudes = Vec::new();
    for o in &mut observations {
        let Some(drive) = &mut o.drive else { continue };
        let passed = before_high_pass(corner_hz, drive.frequency_hz).inv();
        drive.amplitude /= passed.norm();
        amplitudes.push(drive.amplitude);
        let turned = passed / passed.norm();
        o.response.iter_mut().for_each(|r| *r = r.times(turned));
    }
    let nominal = robust::median(&amplitudes).unwrap_or(1.0);
    for o in &mut observations {
        let relative = o.drive.map(|drive| drive.amplitude / nominal);
        if let Some(relative) = relative {
            o.setting.drive_amplitude *= relative / o.stated_drive();
        }
    }
    Blocks::new(&Evidence {
        observations: &observations,
        ..*evidence
    })
}

/// What is stated, with the motion's channels as much earlier as the drive is later.
fn behind(nominal: &Nominal, lag_s: f64) -> Nominal {
    Nominal {
        delays_s: nominal.delays_s.map(|delay_s| delay_s - lag_s),
        ..*nominal
    }
}

/// The frequency of the slowest drive, Hz.
fn slowest_hz(blocks: &Blocks) -> f64 {
    let points = blocks.resonance.points.iter();
    points.map(|p| p.frequency_hz).fold(f64::INFINITY, f64::min)
}
