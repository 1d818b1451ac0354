//! A deterministic example for the tests of the report: the paper's setting, swept up and down.

mod evidence;
pub mod oscillator;
pub mod others;
mod plane;
mod records;

use std::collections::BTreeMap;

use oscillator::Parameters;

use super::content::*;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::messages::StatedValue;
use crate::identify::*;
use crate::motion::Motion;
use crate::record::{Role, Sweep};

pub const TRUTH: Parameters = Parameters {
    restitution: 0.9,
    damping: 0.07,
};
pub const F0: f64 = 12.6;
pub const X_ST: f64 = 1.25e-3;
/// Drive periods of a settled stretch.
const PERIODS: usize = 30;

/// How large an example is.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    pub clearances: usize,
    pub frequencies: usize,
    pub map: (usize, usize),
}

/// 846 records: nine clearances, 47 frequencies up and down.
pub const LARGE: Extent = Extent {
    clearances: 9,
    frequencies: 47,
    map: (96, 64),
};
/// 8 records: one clearance, four frequencies up and down.
pub const SMALL: Extent = Extent {
    clearances: 1,
    frequencies: 4,
    map: (48, 32),
};

/// Pseudo-random numbers in (−1, 1), the same each time.
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn gauss(&mut self) -> f64 {
        (0..6).map(|_| self.next()).sum::<f64>() / 2f64.sqrt()
    }
}

pub fn estimate(value: f64, error: f64) -> Option<Estimate> {
    Some(Estimate {
        value: Some(value),
        standard_error: Some(error),
        interval95: Some([value - 1.96 * error, value + 1.96 * error]),
        status: Status::Identified,
        note: None,
    })
}

fn method(parameters: ParameterSet, observations: usize, residual: f64) -> MethodResult {
    MethodResult {
        parameters,
        observations,
        records: observations.min(300),
        reduced_residual: Some(residual),
        fits: Some(true),
        ..MethodResult::default()
    }
}

fn set(
    r: Option<Estimate>,
    f0: Option<Estimate>,
    beta: Option<Estimate>,
    x: Option<Estimate>,
) -> ParameterSet {
    ParameterSet {
        restitution: r,
        natural_frequency_hz: f0,
        damping_ratio: beta,
        static_deflection_m: x,
    }
}

/// All four parameters: value and standard error of each.
fn all(told: [[f64; 2]; 4]) -> ParameterSet {
    let [r, f0, beta, x] = told.map(|[value, error]| estimate(value, error));
    set(r, f0, beta, x)
}

/// The example's answer.
pub fn identification() -> Identification {
    let mut methods = BTreeMap::new();
    let boundaries = all([
        [0.897, 0.0052],
        [12.602, 0.006],
        [0.0697, 0.0009],
        [1.254e-3, 6e-6],
    ]);
    methods.insert(Method::Boundaries, method(boundaries, 27, 0.93));
    let trajectories = all([
        [0.9006, 0.0011],
        [12.5991, 0.0021],
        [0.0702, 0.0003],
        [1.249e-3, 3e-6],
    ]);
    methods.insert(Method::Trajectories, method(trajectories, 48_212, 1.04));
    methods.insert(
        Method::Impacts,
        method(set(estimate(0.9012, 0.0019), None, None, None), 5_310, 1.01),
    );
    let resonance = set(
        None,
        estimate(12.601, 0.004),
        estimate(0.0706, 0.0005),
        estimate(1.252e-3, 5e-6),
    );
    methods.insert(Method::Resonance, method(resonance, 204, 0.98));
    let pair = |parameter, methods, z: f64, p: f64| PairAgreement {
        parameter,
        methods,
        values: [1.0, 1.0],
        z_score: z,
        p_value: p,
    };
    let joint = all([
        [0.9005, 0.0009],
        [12.5996, 0.0018],
        [0.0702, 0.0003],
        [1.2503e-3, 2.4e-6],
    ]);
    use Coordinate::{Damping, Deflection, Frequency, Restitution};
    use Method::{Boundaries, Impacts, Resonance, Trajectories};
    let values = Coordinate::PHYSICAL.into_iter().filter_map(|c| {
        let estimate = joint.get(c)?;
        Some(StatedValue {
            parameter: c,
            value: estimate.value?,
            half_width: 1.96 * estimate.standard_error?,
        })
    });
    Identification {
        suspicions: Vec::new(),
        uncertainty: Default::default(),
        left_out: Vec::new(),
        used_by: BTreeMap::new(),
        joint_fit: None,
        verdict: Verdict {
            kind: VerdictKind::Identified,
            sentences: vec![
                Sentence::Identified {
                    values: values.collect(),
                },
                Sentence::MethodsAgree,
            ],
            findings: vec![
                Finding::Misfit {
                    method: Impacts,
                    remark: Remark::RestitutionConstant {
                        slow_m_s: 0.03,
                        fast_m_s: 0.42,
                        within: 0.002,
                    },
                },
                Finding::WrongClearance {
                    stated_m: 1.5e-3,
                    fitting_m: 1.45e-3,
                    z_score: -9.1,
                },
            ],
        },
        joint: method(joint, 53_753, 1.02),
        methods,
        agreement: Agreement {
            agree: Some(true),
            pairs: vec![
                pair(Restitution, [Boundaries, Trajectories], -0.68, 0.50),
                pair(Restitution, [Boundaries, Impacts], -0.76, 0.45),
                pair(Restitution, [Trajectories, Impacts], -0.27, 0.79),
                pair(Frequency, [Boundaries, Resonance], 0.14, 0.89),
                pair(Damping, [Boundaries, Resonance], -0.87, 0.38),
                pair(Deflection, [Trajectories, Resonance], -0.51, 0.61),
            ],
        },
        specimens: BTreeMap::new(),
    }
}

/// Where the example's answer comes from.
fn provenance() -> Provenance {
    Provenance {
        settings: serde_json::json!({}),
        versions: [
            ("impactid", "0.1.0"),
            ("identification.json", "2"),
            ("polars", "0.55.2"),
        ]
        .map(|(k, v)| (k.to_owned(), v.to_owned()))
        .into(),
        inputs_sha256: (1..=3)
            .map(|i| {
                (
                    format!("raw/sweep_{i:02}.h5"),
                    format!("{:064x}", 0x1234_5678_9abc_def0_u128 * i * i),
                )
            })
            .collect(),
    }
}

/// The example's content.
pub fn content(extent: Extent) -> ReportContent {
    let id = identification();
    let mut content = ReportContent::new("Double impact oscillator, gap and frequency sweep", id);
    content.provenance = provenance();
    content.records = records::records(extent);
    content.brackets = records::brackets(&content.records);
    content.curves = plane::curves();
    content.region_map = Some(plane::region_map(extent.map));
    content.summary = summary(&content);
    evidence::fill(&mut content);
    content
}

fn summary(content: &ReportContent) -> CampaignSummary {
    let mut clearances: Vec<f64> = content
        .records
        .iter()
        .filter_map(|r| r.clearance_m)
        .collect();
    clearances.dedup();
    let nominal = |name: &str, value, unit: &str| NominalValue {
        name: name.into(),
        value,
        unit: unit.into(),
    };
    let channel = |role, name: &str, unit: &str, note: &str| ChannelRow {
        role,
        name: name.into(),
        unit: unit.into(),
        note: note.into(),
        high_pass_hz: None,
    };
    CampaignSummary {
        name: "peterka-like, seed 20240611".into(),
        rig: "two masses on blade springs, driven toward each other by two shakers".into(),
        laboratory: Some("Laboratory of Impact Dynamics".into()),
        dates: Some(["2024-06-11".into(), "2024-06-13".into()]),
        records_total: content.records.len(),
        records_used: content
            .records
            .iter()
            .filter(|r| !r.used_by.is_empty())
            .count(),
        impacts_total: content.records.iter().map(|r| r.impacts).sum(),
        files_total: 3,
        record_length_s: Some(1.0),
        sample_rate_hz: Some(2000.0),
        frequency_range_hz: Some([10.332, 36.792]),
        clearances_m: clearances,
        nominal: vec![
            nominal("natural frequency $f_0$", 12.6, "Hz"),
            nominal("damping ratio $β$", 0.07, ""),
        ],
        channels: vec![
            channel(Role::Drive, "gen", "V", ""),
            channel(Role::Contact, "contact", "V", "threshold 2.5 V"),
            channel(Role::VelocityX, "vib", "m/s", "laser vibrometer"),
            channel(
                Role::DisplacementX,
                "int_x",
                "mm",
                "integrated twice, high-pass 0.5 Hz",
            ),
        ],
        synthetic: true,
        notes: vec![],
    }
}
