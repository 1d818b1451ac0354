//! Whole campaigns of known truth, compared with their fitted model.

use super::fixture::{decay, decays, nothing_touches, one_of_two, whole};
use super::left_out::{UnusableReason, unusable};
use impact_fit::{Finding, Method, Note, Status};
use impact_records::event::{DetectSettings, DriveTone, RigKind};
use impact_records::motion::{BoundaryKind, ClassifySettings, Motion, Undetermined, observe};
use impact_records::record::{Flag, Problem};

#[test]
fn the_fitted_model_replays_the_records_it_was_fitted_to() {
    let compared = &whole().compared;
    let letters: String = compared.comparisons.iter().map(|c| c.letter).collect();
    assert!(
        "ABCDEFGH".starts_with(&letters) && letters.len() >= 3,
        "{letters}"
    );
    let period_one = Motion::periodic(1, 1);
    let simple = |m: &Motion| *m == period_one || *m == Motion::Impactless;
    for c in compared.comparisons.iter().filter(|c| simple(&c.motion)) {
        assert_eq!(c.simulated_motion.as_ref(), Some(&c.motion), "{}", c.record);
        for trace in c.traces.iter().filter(|t| t.simulated.is_some()) {
            let [residual, whole] = trace.residual_and_whole().expect("a residual");
            let ratio = residual / whole;
            assert!(ratio < 0.01, "{} {}: {ratio}", c.record, trace.role.name());
        }
    }
}

/// z = 1 simulated to four drive periods has an impact in each, at the measured times.
#[test]
fn simulated_impacts_are_where_the_measured_ones_are() {
    let compared = &whole().compared;
    let period_one = Motion::periodic(1, 1);
    let found = compared.comparisons.iter().find(|c| c.motion == period_one);
    let c = found.expect("a record with z = 1");
    assert!(c.simulated_impacts_s.len().abs_diff(4) <= 1);
    for t in &c.impacts_s {
        let apart = c.simulated_impacts_s.iter().map(|s| (s - t).abs());
        let nearest = apart.fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.02 * c.drive_period_s, "{nearest} s");
    }
}

/// The saddle-node boundary of the truth, `ρ_s2(1.6)` = 1.812702, is within the band or near it.
#[test]
fn the_simulated_boundary_is_that_of_the_truth() {
    let curves = &whole().compared.curves;
    let s2 = |c: &&super::BoundaryCurve| c.kind == BoundaryKind::SaddleNode && c.periods_n == 1;
    let points = curves.iter().filter(s2).flat_map(|c| &c.band95);
    let nearest = points.min_by(|a, b| (a[0] - 1.6).abs().total_cmp(&(b[0] - 1.6).abs()));
    let [eta, low, high] = *nearest.expect("the s2 boundary at η = 1.6");
    assert!((eta - 1.6).abs() < 0.01);
    // ρ_s2 falls by 0.07 over 0.01 in η; the band is of R and β alone
    assert!(
        low - 0.08 < 1.812_702 && 1.812_702 < high + 0.08,
        "{low} to {high}"
    );
    assert!(high - low < 0.2);
}

#[test]
fn records_state_which_methods_used_them() {
    let compared = &whole().compared;
    assert_eq!(compared.overview.records, 120);
    assert_eq!(compared.records.len(), 120);
    for r in &compared.records {
        assert!(r.eta.is_some() && r.rho.is_some());
        if r.motion == Motion::Impactless && r.left_out.is_none() {
            assert!(r.used_by.contains(&Method::Resonance), "{}", r.id);
        }
    }
}

#[test]
fn without_a_fitted_restitution_there_are_no_regions() {
    let compared = &nothing_touches().compared;
    assert!(compared.region_map.is_none() && compared.curves.is_empty());
    assert!(compared.impacts.is_empty() && compared.brackets.is_empty());
    assert!(!compared.resonance.is_empty());
}

#[test]
fn free_decays_are_shown_with_their_fit() {
    let compared = &decays().compared;
    assert_eq!(compared.free_decays.len(), 9);
    assert!(compared.comparisons.is_empty() && compared.resonance.is_empty());
    let first = &compared.free_decays[0];
    let [f0, error] = first.natural_frequency_hz;
    assert!((f0 - 11.0).abs() < 0.02 && error > 0.0, "{f0} ± {error}");
    assert!((first.damping_ratio[0] - 0.02).abs() < 0.001);
    let misfiled = &compared.free_decays[8];
    assert!(misfiled.left_out.is_some(), "{}", misfiled.record);
}

#[test]
fn unusable_records_are_grouped_by_flag_and_channel() {
    let clipped = |count| Problem::ClippedSpikes {
        channel: "a".to_owned(),
        count,
        level: 5.0,
        dimension: Default::default(),
    };
    let observation = |id: &str, channel: &str, count: usize, excludes: bool| {
        let mut record = decay(id, 0, 11.0);
        let flag = Flag::new(Some(channel), clipped(count));
        record.flags.push(flag.excluding(excludes));
        let detecting = DetectSettings::default();
        observe(
            &record,
            RigKind::Single,
            &detecting,
            &ClassifySettings::default(),
        )
    };
    let found = unusable(&[
        observation("r1", "b", 5, true),
        observation("r2", "a", 5, true),
        observation("r3", "b", 4, true),
        observation("r4", "b", 4, false),
    ]);
    assert_eq!(found.len(), 2);
    assert_eq!(
        (found[0].channel.as_deref(), found[0].differ),
        (Some("a"), false)
    );
    assert_eq!(found[1].records, ["r1", "r3"]);
    let first = UnusableReason::Flag(clipped(5));
    assert_eq!((&found[1].reason, found[1].differ), (&first, true));
}

#[test]
fn records_are_grouped_by_why_their_motion_is_undetermined() {
    let of = |record: &str, reason| {
        let (detecting, classifying) = (DetectSettings::default(), ClassifySettings::default());
        let decay = decay(record, 0, 11.0);
        let mut one = observe(&decay, RigKind::Single, &detecting, &classifying);
        one.drive = Some(DriveTone::at(11.0, 1.0));
        one.flags.clear();
        one.classification.motion = Motion::Undetermined { reason };
        one
    };
    let found = unusable(&[
        of("r1", Undetermined::FewerThanTwoPeriods),
        of("r2", Undetermined::NearlyCloses { periods_n: 2 }),
        of("r3", Undetermined::FewerThanTwoPeriods),
        of("r4", Undetermined::NearlyCloses { periods_n: 3 }),
    ]);
    let groups: Vec<(Vec<&str>, bool)> = found
        .iter()
        .map(|u| (u.records.iter().map(String::as_str).collect(), u.differ))
        .collect();
    assert_eq!(
        groups,
        [(vec!["r1", "r3"], false), (vec!["r2", "r4"], true)]
    );
}

/// The driving forces differ by 1 %: twice the speed of mass x would be 0.9 % of R off.
#[test]
fn valid_one_of_two_masses_tells_r_by_its_waveforms_alone() {
    let found = &one_of_two().identification;
    let joint = found.joint.parameters.restitution.as_ref().expect("R");
    let [low, high] = joint.interval95.expect("an interval");
    assert!(low < 0.9 && 0.9 < high, "{low} to {high}");
    assert!(high - low < 0.01, "{low} to {high}");
    let impacts = &found.methods[&Method::Impacts];
    let own = impacts.parameters.restitution.as_ref().expect("R");
    assert_eq!(own.status, Status::NotIdentifiable);
    assert_eq!(own.note, Some(Note::OneOfTwo));
    assert_ne!(impacts.fits, Some(false));
    let swapped = |f: &Finding| matches!(f, Finding::SwappedChannels { .. });
    assert!(!found.suspicions.iter().any(swapped));
    assert!(one_of_two().compared.impacts.is_empty());
}
