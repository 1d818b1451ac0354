//! What is stated and what was observed, as an identification takes it.

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::sections::rig::NominalValues;
use impact_fit::evidence::options::UncertaintyOptions;
use impact_fit::evidence::unlike_drives::unlike_drives;
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::parameters::effect::Effects;
use impact_fit::parameters::gain_index;
use impact_records::motion::{Bracket, LateChannel, Observation};
use impact_records::record::Role;
use impact_records::record::late::remainder_s;
use impact_records::signal::robust;

/// What is stated, with what is left of the delays of channels whose whole samples were removed.
fn nominal(campaign: &ResolvedCampaign, observations: &[Observation]) -> Nominal {
    let mass_asymmetry = mass_asymmetry(&campaign.rig);
    let heavier = mass_asymmetry.map_or(0.0, |[centre, _]| centre);
    Nominal {
        restitution: campaign.rig.restitution,
        natural_frequency_hz: campaign.rig.natural_frequency_hz,
        damping_ratio: campaign.rig.damping_ratio,
        static_deflection_m: campaign.rig.static_deflection_m,
        gain_uncertainty: campaign.rig.gain_uncertainty,
        corner_uncertainty: campaign.rig.corner_uncertainty,
        clock_uncertainty: campaign.rig.clock_uncertainty,
        clearance_uncertainty_m: campaign.rig.clearance_uncertainty_m,
        mass_asymmetry,
        drive_asymmetry: unlike_drives(campaign.about.machine, observations, heavier),
        effects: match &campaign.rig.effects {
            Some(kinds) => Effects::of(kinds),
            None => Effects::all(),
        },
        flight: campaign.about.flight,
        ..delays(campaign, observations)
    }
}

/// ln(`m_x`/`m_y`) of the stated masses, with its standard uncertainty; `None` unless both are stated.
fn mass_asymmetry(rig: &NominalValues) -> Option<[f64; 2]> {
    let (x, y) = rig.mass_x_kg.zip(rig.mass_y_kg)?;
    let deviation = rig.mass_uncertainty * std::f64::consts::SQRT_2;
    Some([(x / y).ln(), deviation])
}

/// Greatest uncertainty of the delay of a low-pass that is not stated, relative: its corner and order as jumps tell
/// them.
const ROUGHLY: f64 = 0.5;

/// What is left of the delays of the motion channels beside the drive's, and their uncertainties.
fn delays(campaign: &ResolvedCampaign, observations: &[Observation]) -> Nominal {
    let mut nominal = Nominal::default();
    let late = late(observations);
    let channels = campaign.with_late(late).channels;
    let rates: Vec<f64> = observations.iter().map(|o| o.sample_rate_hz).collect();
    // without a rate nothing was removed
    let rate_hz = robust::median(&rates).unwrap_or(0.0);
    let drive = channels.iter().find(|c| c.role == Role::Drive);
    let of_drive_s = drive.map_or(0.0, |setup| remainder_s(setup, rate_hz));
    for setup in &channels {
        let Some(i) = gain_index(setup.role) else {
            continue;
        };
        nominal.delays_s[i] = remainder_s(setup, rate_hz) - of_drive_s;
        let found = late.iter().find(|l| l.role == setup.role);
        let filter = found.and_then(|l| Some((l.low_pass?, l.order_share.min(ROUGHLY))));
        // its corner is known roughly, and with it its delay
        let of_filter_s = filter.map(|(filter, open)| open * filter.delay_s());
        nominal.delay_uncertainties_s[i] = of_filter_s.or(setup.delay_uncertainty_s);
    }
    nominal
}

/// The channels that were found late, and whose samples were moved back.
pub(super) fn late(observations: &[Observation]) -> &[LateChannel] {
    observations.first().map_or(&[], |o| &o.late)
}

/// What an identification of a campaign starts from.
pub(super) fn evidence<'a>(
    campaign: &ResolvedCampaign,
    observations: &'a [Observation],
    brackets: &'a [Bracket],
) -> Evidence<'a> {
    Evidence {
        rig: campaign.about.machine,
        observations,
        brackets,
        nominal: nominal(campaign, observations),
        uncertainty: UncertaintyOptions {
            intervals: campaign.analysis.uncertainty,
            replicas: campaign.analysis.replicas,
            seed: campaign.analysis.seed,
        },
        progress: None,
    }
}
