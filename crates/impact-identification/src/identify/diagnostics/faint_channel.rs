//! Whether a channel shows hardly anything of a motion that the other mass shows: a sensor that is not connected, or a scale in
//! another unit.

use impact_fit::messages::Finding;
use impact_records::event::RigKind;
use impact_records::motion::Observation;
use impact_records::record::Role;
use impact_records::signal::robust;

/// Impacts of a record from which both masses are known to move.
const FEWEST_IMPACTS: usize = 3;
/// Share of what masses of these weights would show, below which a channel is faint. At an impact both change their speeds by
/// the inverse of their masses; what drives and springs add is of the same size in a rig of two masses alike.
const FAINT: f64 = 0.1;

/// The channels that show hardly anything of the impacts of two masses; `lighter`:
/// ln(`m_x`/`m_y`) if it is stated.
pub fn faint_channels(
    rig: RigKind,
    observations: &[Observation],
    lighter: Option<f64>,
) -> impl Iterator<Item = Finding> {
    let pairs = Role::OF_BOTH
        .into_iter()
        .filter(move |_| rig == RigKind::Double);
    let expected = lighter.unwrap_or(0.0);
    pairs.flat_map(move |[x, y]| {
        // of y over that of x, as a logarithm
        let ratio = |o: &Observation| Some((rms(o, y)? / rms(o, x)?).ln() - expected);
        let hit = observations
            .iter()
            .filter(|o| o.impacts.len() >= FEWEST_IMPACTS);
        let ratios: Vec<f64> = hit.filter_map(ratio).collect();
        [(y, x, 1.0), (x, y, -1.0)]
            .into_iter()
            .filter_map(move |(channel, other, sign)| faint([channel, other], &ratios, sign))
    })
}

/// That a channel is faint beside another one, by the logarithms of their ratios times a sign.
fn faint([channel, other]: [Role; 2], ratios: &[f64], sign: f64) -> Option<Finding> {
    let shares = ratios.iter().map(|ratio| (sign * ratio).exp());
    let faint: Vec<f64> = shares.filter(|share| *share < FAINT).collect();
    Some(Finding::FaintChannel {
        channel,
        other,
        records: faint.len(),
        of: ratios.len(),
        share: robust::median(&faint)?,
    })
}

/// Root mean square of a channel, SI; `None` where it is not recorded, or constant.
fn rms(o: &Observation, role: Role) -> Option<f64> {
    let of = o.amplitudes.iter().find(|a| a.role == role)?;
    Some(of.rms).filter(|rms| *rms > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::event::Impact;
    use impact_records::motion::{Amplitude, Motion};

    /// Records of two masses, each with its rms of both velocities, m/s, and a number of impacts.
    fn found(records: &[([f64; 2], usize)], lighter: Option<f64>) -> Vec<Finding> {
        let one = |(rms, impacts): &([f64; 2], usize)| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.impacts = vec![Impact::at(0.1, 1.0); *impacts];
            o.amplitudes = [Role::VelocityX, Role::VelocityY]
                .into_iter()
                .zip(rms)
                .map(|(role, rms)| Amplitude {
                    role,
                    half_range: 2.0 * rms,
                    rms: *rms,
                })
                .collect();
            o
        };
        let observations: Vec<Observation> = records.iter().map(one).collect();
        faint_channels(RigKind::Double, &observations, lighter).collect()
    }

    #[test]
    fn a_channel_that_shows_a_thousandth_of_the_other_is_named_and_others_are_not() {
        let alike = [([0.3, 0.2], 12), ([0.2, 0.3], 12)];
        assert_eq!(found(&alike, None), []);
        let with_one_faint = |impacts| [alike.as_slice(), &[([0.3, 3e-4], impacts)]].concat();
        let [
            Finding::FaintChannel {
                channel,
                other,
                records,
                of,
                share,
            },
        ] = found(&with_one_faint(12), None)[..]
        else {
            panic!("one channel is faint");
        };
        assert_eq!((channel, other), (Role::VelocityY, Role::VelocityX));
        assert_eq!((records, of), (1, 3));
        assert!((share / 1e-3 - 1.0).abs() < 1e-12);
        // a mass that is not driven moves only where it is hit
        assert_eq!(found(&with_one_faint(0), None), []);
    }

    #[test]
    fn a_mass_that_is_stated_to_be_heavy_moves_less() {
        let heavy = [([0.3, 0.01], 12)];
        let names = |lighter| found(&heavy, lighter).len();
        assert_eq!((names(None), names(Some(-30_f64.ln()))), (1, 0));
        // in the other direction nothing is expected to be fainter
        assert_eq!(names(Some(30_f64.ln())), 1);
    }
}
