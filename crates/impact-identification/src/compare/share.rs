//! Which nuisances campaigns share, and why.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::compare::{Campaign, Common, NotShared, WhyShared};
use impact_fit::parameters::coordinate::Coordinate;
use impact_fit::{GAIN_ROLES, JointFit};
use impact_records::record::Role;

/// A nuisance of several campaigns, and why it is one unknown of them or why not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AcrossCampaigns<Why> {
    /// Its coordinate in the fit of the first of them.
    pub coordinate: Coordinate,
    /// The clearance as stated, m, of an error of a single clearance.
    pub clearance_m: Option<f64>,
    /// The campaigns, by their numbers from 0.
    pub campaigns: Vec<usize>,
    /// Why.
    pub why: Why,
}

/// A nuisance that is one unknown of several campaigns.
pub type SharedNuisance = AcrossCampaigns<WhyShared>;
/// A nuisance that two campaigns might have shared.
pub type SeparateNuisance = AcrossCampaigns<NotShared>;

/// What a nuisance is in every campaign: its coordinate, or the clearance whose error it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Nuisance {
    /// A coordinate that means the same in every fit.
    Of(Coordinate),
    /// Error of a clearance, by its bits: clearances are the same where they are stated so.
    Clearance(u64),
}

impl Nuisance {
    /// The nuisance of a coordinate of a fit; `None` of what is never shared.
    pub(super) fn of(coordinate: Coordinate, fit: &JointFit) -> Option<Self> {
        Common::of(coordinate)?;
        match coordinate {
            Coordinate::Gap(i) => {
                // clearances are stated to a nanometre at most
                let stated_nm = (1e9 * fit.gaps_m.get(i)?).round();
                Some(Self::Clearance(stated_nm.to_bits()))
            }
            other => Some(Self::Of(other)),
        }
    }
}

/// The nuisances that are shared, each by the campaigns that share it, and those that are not although
/// something suggests it.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    pub shared: Vec<(Nuisance, SharedNuisance)>,
    pub separate: Vec<SeparateNuisance>,
}

/// A campaign's coordinate of a nuisance.
#[derive(Clone, Copy)]
struct Member {
    campaign: usize,
    coordinate: Coordinate,
    clearance_m: Option<f64>,
}

/// Find what campaigns share.
pub(super) fn sharing(campaigns: &[Campaign]) -> Sharing {
    let mut members: BTreeMap<Nuisance, Vec<Member>> = BTreeMap::new();
    for (number, campaign) in campaigns.iter().enumerate() {
        let Some(fit) = &campaign.fit else { continue };
        for coordinate in fit.fit.free.iter().copied() {
            let Some(nuisance) = Nuisance::of(coordinate, fit) else {
                continue;
            };
            let clearance_m = match coordinate {
                Coordinate::Gap(i) => fit.gaps_m.get(i).copied(),
                _ => None,
            };
            members.entry(nuisance).or_default().push(Member {
                campaign: number,
                coordinate,
                clearance_m,
            });
        }
    }
    let mut sharing = Sharing::default();
    for (nuisance, members) in members {
        sharing.divide(campaigns, nuisance, &members);
    }
    sharing
}

impl Sharing {
    /// Divide the campaigns that have a nuisance into those that share it.
    fn divide(&mut self, campaigns: &[Campaign], nuisance: Nuisance, members: &[Member]) {
        let mut classes: Vec<(Vec<Member>, WhyShared)> = Vec::new();
        for (i, member) in members.iter().enumerate() {
            let joined = classes.iter_mut().find_map(|(class, why)| {
                let with = class
                    .iter()
                    .map(|other| verdict(campaigns, other, member))
                    .collect::<Result<Vec<_>, _>>()
                    .ok()?;
                class.push(*member);
                why.clone_from(with.last()?);
                Some(())
            });
            if joined.is_none() {
                let alone = WhyShared::StatedAsShared;
                classes.push((vec![*member], alone));
                let before = members[..i].iter();
                self.separate.extend(before.filter_map(|other| {
                    let why = verdict(campaigns, other, member).err()??;
                    Some(SeparateNuisance {
                        coordinate: other.coordinate,
                        clearance_m: other.clearance_m,
                        campaigns: vec![other.campaign, member.campaign],
                        why,
                    })
                }));
            }
        }
        let several = classes.into_iter().filter(|(class, _)| class.len() > 1);
        self.shared.extend(several.map(|(class, why)| {
            let shared = SharedNuisance {
                coordinate: class[0].coordinate,
                clearance_m: class[0].clearance_m,
                campaigns: class.iter().map(|m| m.campaign).collect(),
                why,
            };
            (nuisance, shared)
        }));
    }
}

/// Why two campaigns share a nuisance, or why not; `Err(None)` where nothing suggests it.
fn verdict(
    campaigns: &[Campaign],
    first: &Member,
    second: &Member,
) -> Result<WhyShared, Option<NotShared>> {
    let (a, b) = (&campaigns[first.campaign], &campaigns[second.campaign]);
    let Some(common) = Common::of(first.coordinate) else {
        return Err(None);
    };
    let why = match channel_role(first.coordinate) {
        Some(role) => of_channels(a, b, common, role)?,
        None => stated(a, b, common)?,
    };
    if same_reference(a, b, first.coordinate) {
        Ok(why)
    } else {
        Err(Some(NotShared::StatedOtherwise))
    }
}

/// The channel whose error a coordinate is.
fn channel_role(coordinate: Coordinate) -> Option<Role> {
    match coordinate {
        Coordinate::Gain(i) | Coordinate::Corner(i) | Coordinate::Delay(i) => {
            GAIN_ROLES.get(i).copied()
        }
        _ => None,
    }
}

/// Whether two channels share an error: by the same instrument, or because both campaigns state it and
/// no instrument contradicts it.
fn of_channels(
    a: &Campaign,
    b: &Campaign,
    common: Common,
    role: Role,
) -> Result<WhyShared, Option<NotShared>> {
    let stated_too = stated(a, b, common);
    let instrument = |c: &Campaign| {
        let text = c.channel(role)?.instrument.as_deref()?.trim().to_owned();
        (!text.is_empty()).then_some(text)
    };
    match (instrument(a), instrument(b)) {
        // a delay is between two channels: the motion's instrument alone does not tell it
        (Some(first), Some(second)) if first == second && common != Common::Delays => {
            Ok(WhyShared::SameInstrument { instrument: first })
        }
        (Some(first), Some(second)) if first != second => Err(stated_too
            .ok()
            .map(|_| NotShared::OtherInstrument { first, second })),
        _ => stated_too,
    }
}

/// Whether two campaigns state that they share something.
fn stated(a: &Campaign, b: &Campaign, common: Common) -> Result<WhyShared, Option<NotShared>> {
    let one_campaign = a.measurement == b.measurement
        && !matches!(
            common,
            Common::ClearanceZero | Common::Clearances | Common::Asymmetries
        );
    if one_campaign {
        return Ok(WhyShared::OneCampaign);
    }
    let says = |c: &Campaign| common.is_stated_in(&c.shared);
    match (says(a), says(b)) {
        (true, true) if a.rig == b.rig => Ok(WhyShared::StatedAsShared),
        (true, true) => {
            let name = |c: &Campaign| c.rig.clone().unwrap_or_else(|| "?".to_owned());
            Err(Some(NotShared::OtherRig {
                first: name(a),
                second: name(b),
            }))
        }
        (false, false) => Err(None),
        _ => Err(Some(NotShared::StatedByOne)),
    }
}

/// Whether a nuisance is the error of the same stated value in both campaigns.
fn same_reference(a: &Campaign, b: &Campaign, coordinate: Coordinate) -> bool {
    let channels = channel_role(coordinate).map(|role| (a.channel(role), b.channel(role)));
    match (coordinate, channels) {
        (Coordinate::Gain(_), Some((Some(x), Some(y)))) => x.scale == y.scale && x.unit == y.unit,
        (Coordinate::Corner(_), Some((Some(x), Some(y)))) => x.high_pass_hz == y.high_pass_hz,
        (Coordinate::Delay(_), Some((Some(x), Some(y)))) => x.delay_s == y.delay_s,
        (_, Some(_)) => false,
        (Coordinate::MassAsymmetry, None) => centre(a, coordinate) == centre(b, coordinate),
        _ => true,
    }
}

/// Centre of a coordinate's prior.
fn centre(campaign: &Campaign, coordinate: Coordinate) -> Option<f64> {
    let mut priors = campaign.fit.as_ref()?.priors.iter();
    Some(priors.find(|p| p.coordinate == coordinate)?.centre)
}
