//! The masses' ratio by conservation of momentum at impacts of two free masses, against the stated one.

use crate::evidence::Evidence;
use crate::messages::{Finding, Remark};
use crate::methods::impacts::block::ImpactBlock;
use crate::statistics::quantile::NORMAL_975;
use impact_records::event::{Impact, MassSpeeds, RigKind};

/// Standard errors by which the ratio must be off the stated one.
const SIGNIFICANT: f64 = 4.0;
/// Relative difference that matters.
const MATTERS: f64 = 0.02;

/// `m_y/m_x` with its standard error, from the changes of both speeds: `m_x Δx' = m_y Δy'`.
fn ratio(impacts: &[&Impact]) -> Option<(f64, f64)> {
    let logs: Vec<(f64, f64)> = impacts
        .iter()
        .filter_map(|impact| {
            let (x, y) = (impact.x?, impact.y?);
            let change = [x, y].map(MassSpeeds::jump_m_s);
            // The error of the approach speed is that of both masses; each change has two speeds.
            let error = impact.speed_error_m_s()?;
            let relative = (error / change[0]).hypot(error / change[1]);
            let resolved = change[0] > 0.0 && change[1] > 0.0 && relative < 0.5;
            resolved.then(|| ((change[0] / change[1]).ln(), relative.max(1e-4)))
        })
        .collect();
    if logs.is_empty() {
        return None;
    }
    let weight: f64 = logs.iter().map(|(_, e)| e.powi(-2)).sum();
    let mean = logs.iter().map(|(v, e)| v / (e * e)).sum::<f64>() / weight;
    let chi2: f64 = logs.iter().map(|(v, e)| ((v - mean) / e).powi(2)).sum();
    let freedom = logs.len().saturating_sub(1).max(1) as f64;
    let error = ((chi2 / freedom).max(1.0) / weight).sqrt();
    Some((mean.exp(), mean.exp() * error))
}

/// The ratio of the masses as the impacts of a block show it, and the finding that it is not the stated
/// one; of two masses without a drive alone.
pub(super) fn momentum(
    block: &ImpactBlock,
    evidence: &Evidence<'_>,
) -> Option<(Remark, Option<Finding>)> {
    if evidence.rig != RigKind::Double {
        return None;
    }
    let used = |p: &&crate::methods::impacts::block::SpeedPair| {
        evidence.observations[p.observation].drive.is_none()
    };
    let impacts: Vec<&Impact> = block
        .pairs
        .iter()
        .filter(used)
        .filter_map(|p| {
            let all = &evidence.observations[p.observation].impacts;
            all.iter().find(|i| i.time_s == p.time_s)
        })
        .collect();
    let (measured, error) = ratio(&impacts)?;
    let remark = Remark::MassRatio {
        ratio: measured,
        half_width: NORMAL_975 * error,
    };
    let stated = evidence.nominal.mass_asymmetry;
    let finding = stated.and_then(|[asymmetry, deviation]| {
        let stated = (-asymmetry).exp();
        let off = measured / stated - 1.0;
        let z_score = off / (error / measured).hypot(deviation);
        (z_score.abs() > SIGNIFICANT && off.abs() > MATTERS).then_some(
            Finding::MomentumNotConserved {
                measured,
                stated,
                z_score,
            },
        )
    });
    Some((remark, finding))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_the_ratio_of_masses_follows_from_the_changes_of_speed() {
        // Masses 1 and 2, R = 0.5: x from 0.6 to 0, y from 0 to −0.3.
        let impact = Impact {
            x: Some(MassSpeeds {
                before_m_s: 0.6,
                after_m_s: 0.0,
            }),
            y: Some(MassSpeeds {
                before_m_s: 0.0,
                after_m_s: -0.3,
            }),
            speed_errors_m_s: Some([0.003; 2]),
            ..Impact::at(1.0, 0.6)
        };
        let (found, error) = ratio(&[&impact]).expect("a ratio");
        assert!((found - 2.0).abs() < 1e-12);
        assert!((error - 2.0 * (0.005f64).hypot(0.01)).abs() < 1e-12);
        assert_eq!(ratio(&[]), None);
    }
}
