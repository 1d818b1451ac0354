//! A synthetic campaign on disk: records, run table, campaign.toml and the truth beside it.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use crate::pipeline::PipelineError;
use crate::pipeline::json::write_json;
use crate::pipeline::store::RECORDS_A_FILE;
use impact_report::kit::csv::Csv;
use labfiles_write::hdf5::{CampaignWriter, ColumnToWrite, RecordTable, Stored};
use labfiles_write::output::write_bytes;
use simulated_rig::acquisition::{FULL_SCALE_V, converter_step};
use simulated_rig::rig::{ROLES, sensitivities};
use simulated_rig::run::RATE_HZ;
use simulated_rig::{
    Faults, Laboratory, Plan, RawRecord, RigEffects, RigSpec, TrueImpact, Truth, blocks,
};

/// What a synthetic campaign is made of.
#[derive(Debug, Clone, Serialize)]
pub struct Recipe {
    /// True parameters.
    pub truth: Truth,
    /// Faults of the rig.
    pub faults: Faults,
    /// Effects beyond the model, with their strengths.
    #[serde(skip_serializing_if = "RigSpec::is_exact")]
    pub rig: RigSpec,
    /// Number of records.
    pub records: usize,
    /// Whether the sweeps pass the motions between ρ′ and z = 1 in small steps.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub beats: bool,
    /// Seed of everything random.
    pub seed: u64,
    /// Seed of the rig's own errors (gains, corners, gaps, effects), if they are those of another
    /// campaign on the same rig.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rig_seed: Option<u64>,
}

impl Recipe {
    /// Seed of the rig's own errors.
    fn seed_of_rig(&self) -> u64 {
        self.rig_seed.unwrap_or(self.seed)
    }
}

/// One record's truth in truth.json.
#[derive(Serialize)]
struct TrueRecord {
    record: String,
    frequency_hz: f64,
    clearance_m: f64,
    sweep: &'static str,
    motion: String,
    periodic: bool,
    impacts: usize,
    /// Sums of approach speed squared and of approach times separation speed.
    #[serde(skip)]
    speeds: [f64; 2],
}

#[derive(Serialize)]
struct TruthFile<'a> {
    synthetic: bool,
    restitution: f64,
    natural_frequency_hz: f64,
    damping_ratio: f64,
    static_deflection_m: f64,
    /// What was drawn of the effects beyond the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    effects: Option<&'a RigEffects>,
    /// Separation speed at the end over approach speed at the start of contact, over all impacts
    /// by least squares: R as it acts, springs and drive included, where impacts last.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed_ratio: Option<f64>,
    recipe: &'a Recipe,
    records: Vec<&'a TrueRecord>,
}

/// The file that holds a campaign's records where one does.
const RECORDS_FILE: &str = "records.h5";
const RUN_TABLE: &str = "runs.csv";
/// What campaigns on one simulated rig have in common beside the instruments.
const SHARED: &str = r#"["clearances", "delays", "asymmetries", "harmonics", "force_frequency"]"#;

/// Simulate a campaign and write it: records.h5 (converter counts), runs.csv, campaign.toml and
/// truth.json. A campaign of more than a thousand records is written to several files as it is
/// simulated, `records_000000.h5` …, each named by the number of its first record.
///
/// # Errors
/// Where the truth lies outside the model's range or a file cannot be written.
pub fn write_campaign(recipe: &Recipe, out: &Path) -> Result<usize, PipelineError> {
    let truth = &recipe.truth;
    let plan = if recipe.beats {
        Plan::through_beats(truth, recipe.records)
    } else {
        Plan::for_rig(
            truth.natural_frequency_hz(),
            truth.damping_ratio(),
            truth.static_deflection_m(),
            recipe.records,
        )
    };
    let mut recipe = recipe.clone();
    let rig_seed = recipe.seed_of_rig();
    let effects = recipe.rig.draw(&mut recipe.truth, &plan, rig_seed);
    let recipe = &recipe;
    let laboratory = Laboratory {
        truth: recipe.truth.clone(),
        faults: recipe.faults.clone(),
        effects,
        clearance_uncertainty_m: recipe.rig.clearance_uncertainty_m(&recipe.truth),
        plan,
        rig_seed,
        seed: recipe.seed,
    };
    labfiles_write::output::make_folder(out)?;
    let keep = |raw| kept(raw, &recipe.faults);
    let files: Vec<RecordsFile> = if laboratory.plan.steps.len() <= RECORDS_A_FILE {
        let whole = |_: usize, block: Vec<KeptRecord>| Ok::<_, PipelineError>(block);
        let all = blocks(&laboratory, usize::MAX, &keep, &whole)?;
        let all = all.into_iter().flatten().collect();
        vec![write_records(recipe, all, out, RECORDS_FILE.to_owned())?]
    } else {
        blocks(&laboratory, RECORDS_A_FILE, &keep, &|first, block| {
            write_records(recipe, block, out, format!("records_{first:06}.h5"))
        })?
    };
    write_bytes(&out.join(RUN_TABLE), run_table(&files).as_bytes())?;
    write_bytes(
        &out.join("campaign.toml"),
        campaign_toml(recipe, laboratory.clearance_uncertainty_m).as_bytes(),
    )?;
    write_json(
        &out.join("truth.json"),
        &truth_file(recipe, &laboratory.effects, &files),
    )?;
    Ok(laboratory.plan.steps.len())
}

/// A record as it is written, and its truth.
type KeptRecord = (RecordTable, TrueRecord);

/// A file of records and the truth of what it holds.
struct RecordsFile {
    name: String,
    truths: Vec<TrueRecord>,
}

fn kept(raw: RawRecord, faults: &Faults) -> KeptRecord {
    let truth = TrueRecord {
        record: raw.id.clone(),
        frequency_hz: raw.step.frequency_hz,
        clearance_m: raw.step.clearance_m,
        sweep: raw.step.sweep.name(),
        motion: raw.motion.label(),
        periodic: raw.motion.is_periodic(),
        impacts: raw.impacts.len(),
        speeds: speed_sums(&raw.impacts),
    };
    let columns = raw.channels.iter().map(|c| ColumnToWrite {
        name: c.name.to_owned(),
        unit: "V".to_owned(),
        samples: stored(&c.volts, faults),
    });
    let table = RecordTable {
        name: raw.id,
        sample_rate_hz: Some(RATE_HZ),
        channels: columns.collect(),
        attributes: Vec::new(),
    };
    (table, truth)
}

/// Sums of approach speed squared and of approach times separation speed, of impacts without a
/// dead zone.
fn speed_sums(impacts: &[TrueImpact]) -> [f64; 2] {
    let bounces = impacts.iter().filter(|i| i.dead_zone_s == 0.0);
    bounces.fold([0.0; 2], |[square, product], i| {
        let v = i.approach_m_s;
        [square + v * v, product + v * i.separation_m_s]
    })
}

fn speed_ratio(files: &[RecordsFile]) -> Option<f64> {
    let records = files.iter().flat_map(|f| &f.truths);
    let [square, product] = records.fold([0.0; 2], |[a, b], r| [a + r.speeds[0], b + r.speeds[1]]);
    (square > 0.0).then(|| product / square)
}

fn write_records(
    recipe: &Recipe,
    records: Vec<KeptRecord>,
    out: &Path,
    name: String,
) -> Result<RecordsFile, PipelineError> {
    let mut writer = CampaignWriter::create(&out.join(&name));
    writer.attribute("origin", "synthetic: simulated by impactid, not measured");
    writer.attribute("seed", recipe.seed as f64);
    let mut truths = Vec::with_capacity(records.len());
    for (table, truth) in records {
        writer.add(table)?;
        truths.push(truth);
    }
    writer.finish()?;
    Ok(RecordsFile { name, truths })
}

/// What a converter of 16 bits gives: beyond its range its last number.
#[expect(clippy::cast_possible_truncation, reason = "a converter saturates too")]
fn converter_count(steps: f64) -> i16 {
    steps.round() as i16
}

fn stored(volts: &[f64], faults: &Faults) -> Stored {
    match converter_step(faults) {
        Some(scale) if FULL_SCALE_V / scale <= f64::from(i16::MAX) => Stored::Counts {
            counts: volts.iter().map(|v| converter_count(v / scale)).collect(),
            scale,
            offset: 0.0,
        },
        _ => Stored::Numbers(volts.to_vec()),
    }
}

fn run_table(files: &[RecordsFile]) -> String {
    let mut csv = Csv::new(&[
        "file",
        "dataset",
        "drive_frequency_hz",
        "clearance_mm",
        "sweep",
    ]);
    for file in files {
        for r in &file.truths {
            let clearance_mm = (r.clearance_m * 1e6).round() / 1e3;
            csv.row()
                .texts(&[&file.name, &r.record])
                .exact(&[Some(r.frequency_hz), Some(clearance_mm)])
                .texts(&[r.sweep]);
        }
    }
    csv.finish()
}

fn truth_file<'a>(
    recipe: &'a Recipe,
    effects: &'a RigEffects,
    files: &'a [RecordsFile],
) -> TruthFile<'a> {
    TruthFile {
        synthetic: true,
        restitution: recipe.truth.restitution,
        natural_frequency_hz: recipe.truth.natural_frequency_hz(),
        damping_ratio: recipe.truth.damping_ratio(),
        static_deflection_m: recipe.truth.static_deflection_m(),
        effects: (!recipe.rig.is_exact()).then_some(effects),
        speed_ratio: speed_ratio(files).filter(|_| effects.contact_duration_s > 0.0),
        recipe,
        records: files.iter().flat_map(|f| &f.truths).collect(),
    }
}

/// campaign.toml as the virtual laboratory would have filled it in: nominal values only.
fn campaign_toml(recipe: &Recipe, clearance_uncertainty_m: Option<f64>) -> String {
    let mut text = String::from(
        "# A SYNTHETIC campaign: simulated by `impactid simulate campaign`, not measured.\n\
         # The truth behind it is in truth.json; it is not stated here.\n\n\
         [campaign]\n\
         name = \"Synthetic double impact oscillator\"\n\
         synthetic = true\n\
         machine = \"double\"\n\
         flight = \"harmonic\"\n\n\
         [records]\n\
         run_table = \"runs.csv\"\n\n\
         [rig]\n\
         gain_uncertainty = \"0.5 %\"\n\
         corner_uncertainty = \"2 %\"\n",
    );
    if let Some(uncertainty_m) = clearance_uncertainty_m {
        let _ = writeln!(
            text,
            "clearance_uncertainty = \"{:.3} um\"",
            1e6 * uncertainty_m
        );
    }
    if let Some(seed) = recipe.rig_seed {
        let _ = writeln!(text, "name = \"simulated rig {seed}\"\nshared = {SHARED}");
    }
    for (sensitivity, (role, dimension, filtered)) in sensitivities(&recipe.truth).iter().zip(ROLES)
    {
        let _ = write!(
            text,
            "\n[channels.{}]\nchannel = \"{}\"\n",
            role.name(),
            sensitivity.name
        );
        let symbol = dimension.si_symbol();
        if symbol != "V" {
            let _ = writeln!(text, "scale = \"{} {symbol}/V\"", sensitivity.si_per_volt);
        }
        if let (Some(corner), true) = (recipe.faults.high_pass_hz, filtered) {
            let _ = writeln!(text, "high_pass = \"{corner} Hz\"");
        }
        if let Some(seed) = recipe.rig_seed {
            let _ = writeln!(
                text,
                "instrument = \"simulated {}, no. {seed}\"",
                sensitivity.name
            );
        }
        if role == impact_records::record::Role::Contact {
            text.push_str("threshold = \"2.5 V\"\n");
        } else {
            let _ = writeln!(text, "range = \"{FULL_SCALE_V} V\"");
        }
    }
    text
}
