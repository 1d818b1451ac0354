//! What an identification costs on this machine: all fits of a campaign of 846 records with and
//! without profiles, and with 1,000 bootstrap replicas.
//!
//! `cargo bench --bench identification`. Times are by the clock on all processors, the least and
//! the median of several runs; simulating and observing the records is not counted.

use std::time::Instant;

use rayon::prelude::*;

use impact_fit::evidence::options::{IntervalMethod, UncertaintyOptions};
use impact_fit::evidence::{Evidence, Nominal};
use impact_identification::identify::run::identify;
use impact_oscillator::model::params::ModelError;
use impact_records::event::DetectSettings;
use impact_records::event::RigKind;
use impact_records::motion::{ClassifySettings, Observation, brackets, observe, scale_drives};
use simulated_rig::run::calibrated;
use simulated_rig::{Differences, Faults, Laboratory, Plan, RigEffects, Truth, records};

const RECORDS: usize = 846;

fn main() -> Result<(), ModelError> {
    // `cargo bench` passes --bench; under `cargo test` nothing is measured
    if !std::env::args().any(|a| a == "--bench") {
        return Ok(());
    }
    let observations = campaign()?;
    let brackets = brackets(&observations);
    println!(
        "{} records, {} brackets",
        observations.len(),
        brackets.len()
    );
    for (name, intervals, runs) in [
        ("all fits", IntervalMethod::Covariance, 9),
        ("all fits and profiles", IntervalMethod::Profile, 5),
        (
            "all fits and 1,000 bootstrap replicas",
            IntervalMethod::Bootstrap,
            3,
        ),
    ] {
        let evidence = Evidence {
            rig: RigKind::Double,
            observations: &observations,
            brackets: &brackets,
            nominal: Nominal {
                gain_uncertainty: 5e-3,
                ..Nominal::default()
            },
            uncertainty: UncertaintyOptions {
                intervals,
                ..UncertaintyOptions::default()
            },
            progress: None,
        };
        let mut seconds: Vec<f64> = (0..runs).map(|_| time(&evidence)).collect();
        seconds.sort_by(f64::total_cmp);
        let (least, median) = (seconds[0], seconds[runs / 2]);
        println!("{name:40} {least:7.3} s least, {median:7.3} s median");
    }
    Ok(())
}

fn time(evidence: &Evidence<'_>) -> f64 {
    let start = Instant::now();
    let outcome = identify(evidence);
    let seconds = start.elapsed().as_secs_f64();
    assert!(outcome.joint_fit.is_some(), "nothing was fitted");
    seconds
}

/// A campaign as `simulate campaign` makes it, observed.
fn campaign() -> Result<Vec<Observation>, ModelError> {
    let truth = Truth::symmetric(0.9, 12.6, 0.07, 1e-3).with_differences(&Differences {
        force: 0.01,
        stiffness: -0.01,
        ..Differences::default()
    });
    let plan = Plan::for_rig(
        truth.natural_frequency_hz(),
        truth.damping_ratio(),
        truth.static_deflection_m(),
        RECORDS,
    );
    let laboratory = Laboratory {
        truth,
        faults: Faults::default(),
        effects: RigEffects::default(),
        clearance_uncertainty_m: None,
        plan,
        rig_seed: 1,
        seed: 1,
    };
    let raw = records(&laboratory)?;
    let mut observations: Vec<Observation> = raw
        .par_iter()
        .map(|raw| {
            let record = calibrated(raw, &laboratory.truth, &laboratory.faults);
            let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
            observe(&record, RigKind::Double, &detect, &classify)
        })
        .collect();
    scale_drives(&mut observations);
    Ok(observations)
}
