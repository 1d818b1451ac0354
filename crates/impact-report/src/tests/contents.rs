//! Contents of all kinds of campaign: identified and compared by [`impact_identification::replay::fixture`], with
//! what a campaign states about itself.

use std::sync::OnceLock;

use crate::{CampaignFacts, CampaignsContent, NominalValue, Phrase, ReportContent, Subject};
use impact_fit::VerdictKind;
use impact_fit::parameters::Coordinate;
use impact_identification::compare::{
    Comparison, ComparisonRemark, ComparisonSummary, Difference, EqualityTest, NotShared,
    SeparateNuisance, SharedNuisance, WhyShared,
};
use impact_identification::identify::Provenance;
use impact_identification::replay::fixture::{self, Identified};
use impact_identification::replay::{ImpactScatter, RecordRow};
use impact_records::motion::{Motion, Undetermined};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup};
use impact_records::record::{Role, Sweep};

/// Every kind by its name.
pub(super) fn kinds() -> &'static [(&'static str, ReportContent)] {
    static KINDS: OnceLock<Vec<(&'static str, ReportContent)>> = OnceLock::new();
    KINDS.get_or_init(|| {
        vec![
            ("whole", whole()),
            ("small", small()),
            ("decays", decays()),
            ("cart", cart()),
            ("unidentified", unidentified()),
        ]
    })
}

/// The kind of a name.
pub(super) fn kind(name: &str) -> &'static ReportContent {
    let found = kinds().iter().find(|(n, _)| *n == name);
    &found.expect("one of the kinds").1
}

fn content(title: &str, of: &Identified, subject: Subject) -> ReportContent {
    ReportContent {
        title: title.into(),
        campaign: CampaignFacts {
            name: "synthetic, seed 2026".into(),
            subject,
            files: 3,
            ..CampaignFacts::default()
        },
        identification: of.identification.clone(),
        provenance: Provenance {
            settings: serde_json::json!({"rig": {"gain_uncertainty": 0.005}}),
            versions: [("impactid".to_owned(), "0.1.0".to_owned())].into(),
            inputs_sha256: [("records.h5".to_owned(), format!("{:064x}", 2026))].into(),
        },
        compared: of.compared.clone(),
        proposals: Vec::new(),
        tables: Vec::new(),
        command_line: "impactid run campaign.toml --out out".into(),
        date: Some("2026-11-26".into()),
    }
}

/// A whole campaign of two masses.
fn whole() -> ReportContent {
    let whole = fixture::whole();
    let title = "Double impact oscillator, gap and frequency sweep";
    let mut content = content(title, whole, Subject::TwoMasses);
    let channel = |role: Role, instrument: &str, high_pass_hz| ChannelSetup {
        instrument: Some(instrument.to_owned()).filter(|i| !i.is_empty()),
        high_pass_hz,
        ..ChannelSetup::plain(role, ChannelKey::Name(role.name().to_owned()))
    };
    content.campaign = CampaignFacts {
        stated: vec![(Phrase::Laboratory, "Laboratory of Impact Dynamics".into())],
        dates: Some(["2024-06-11".into(), "2024-06-13".into()]),
        nominal: vec![
            NominalValue {
                name: Phrase::NaturalFrequencySymbol,
                value: 12.6,
                unit: "Hz",
            },
            NominalValue {
                name: Phrase::DampingRatioSymbol,
                value: 0.07,
                unit: "",
            },
        ],
        channels: vec![
            channel(Role::Drive, "", None),
            channel(Role::Contact, "threshold 2.5 V", None),
            channel(Role::VelocityX, "laser vibrometer", None),
            channel(Role::DisplacementX, "integrated", Some(0.5)),
        ],
        synthetic: true,
        ..content.campaign
    };
    content
}

/// Few records, brackets and comparisons: tables in large type.
fn small() -> ReportContent {
    let mut content = whole();
    let compared = &mut content.compared;
    compared.records.truncate(20);
    compared.brackets.truncate(5);
    compared.comparisons.truncate(2);
    content
}

/// Free decays and nothing else.
fn decays() -> ReportContent {
    content(
        "Three masses on a blade spring",
        fixture::decays(),
        Subject::OneMass,
    )
}

/// A cart that bounces on a stop: no drive, no plane of frequency and clearance.
fn cart() -> ReportContent {
    let mut content = whole();
    let whole = &fixture::whole().compared;
    content.title = "Cart on an inclined track".into();
    content.campaign = CampaignFacts {
        subject: Subject::OneMass,
        ..CampaignFacts::default()
    };
    content.compared = impact_identification::replay::Compared {
        impacts: whole
            .impacts
            .iter()
            .map(|scatter| ImpactScatter {
                specimen: Some("spring bumper".into()),
                restitution_of_speed: vec![[0.1, 0.92], [0.3, 0.9], [0.6, 0.87]],
                ..scatter.clone()
            })
            .collect(),
        records: whole.records.iter().take(5).map(undriven).collect(),
        ..Default::default()
    };
    content
}

fn undriven(record: &RecordRow) -> RecordRow {
    RecordRow {
        frequency_hz: None,
        eta: None,
        rho: None,
        clearance_m: None,
        sweep: Sweep::Unknown,
        motion: Motion::Undetermined {
            reason: Undetermined::NoDrive,
        },
        impacts: 18,
        ..record.clone()
    }
}

/// A campaign that cannot tell R, and whose records have no place in the (η, ρ) plane.
fn unidentified() -> ReportContent {
    let title = "Nothing touches";
    let mut content = content(title, fixture::nothing_touches(), Subject::TwoMasses);
    for r in &mut content.compared.records {
        (r.eta, r.rho) = (None, None);
    }
    content
}

/// Two campaigns on one rig, between which R has fallen.
pub(super) fn compared() -> CampaignsContent {
    let parameters = fixture::whole().identification.joint.parameters.clone();
    let campaign = |name: &str| ComparisonSummary {
        name: name.into(),
        measured: Some("May".into()),
        synthetic: true,
        verdict: VerdictKind::Identified,
        parameters: parameters.clone(),
    };
    let test = EqualityTest {
        statistic: 12.0,
        differences: 4,
        degrees_of_freedom: Some(20.0),
        p_value: 1e-5,
    };
    CampaignsContent {
        title: "Before and after".into(),
        comparison: Comparison {
            campaigns: vec![campaign("before"), campaign("after")],
            differences: vec![Difference {
                campaign: 1,
                parameter: Coordinate::Restitution,
                value: -0.03,
                standard_error: 0.001,
                interval95: [-0.032, -0.028],
                relative: [-0.033, -0.035, -0.031],
                degrees_of_freedom: None,
                independent_interval95: [-0.036, -0.024],
                p_value: 1e-6,
            }],
            unchanged: Some(test),
            unchanged_by_parameter: vec![(Coordinate::Restitution, test)],
            shared: vec![SharedNuisance {
                coordinate: Coordinate::Gap(2),
                clearance_m: Some(1.5e-3),
                campaigns: vec![0, 1],
                why: WhyShared::StatedAsShared,
            }],
            separate: vec![SeparateNuisance {
                coordinate: Coordinate::Gain(0),
                clearance_m: None,
                campaigns: vec![0, 1],
                why: NotShared::StatedOtherwise,
            }],
            remarks: vec![ComparisonRemark::NothingShared],
        },
        command_line: "impactid compare before after --out compared".into(),
    }
}
