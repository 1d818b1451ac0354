//! A campaign on the map: every kind of record with its evidence, residuals at the sliders, results
//! that are spoiled.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

use super::server::{Explorer, Page};

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data-samples/double-oscillator/campaign.toml")
}

/// A record's frame.
fn shown(page: &mut Page, state: &Value, id: &str) -> super::server::Frame {
    let mut state = state.clone();
    state["record"] = json!(id);
    page.answer(&json!({"kind": "record"}), &state)
}

#[test]
fn valid_each_kind_of_record_is_shown_with_its_evidence() {
    let explorer = Explorer::start(&[&sample().to_string_lossy()], &std::env::temp_dir());
    let mut page = explorer.page();
    let hello = page.hello().header;
    let (state, campaign) = (&hello["state"], &hello["campaign"]);
    let records = campaign["records"].as_array().expect("records");
    assert_eq!(records.len(), 220);
    for label in ["0", "1", "1/2", "2/1", "undetermined"] {
        let record = records.iter().find(|r| r["motion"]["label"] == label);
        let id = record.unwrap_or_else(|| panic!("no record with z = {label}"))["id"].as_str();
        let frame = shown(&mut page, state, id.expect("a name"));
        let evidence = &frame.header["evidence"];
        assert_eq!(frame.header["shown"], "motion", "{label}: {}", frame.header);
        assert!(frame.column("measured0").len() > 100 && !frame.column("simulated0").is_empty());
        assert!(evidence["measures"]["periods_observed"].as_f64() > Some(2.0));
        if label == "undetermined" {
            assert!(evidence["undetermined"].is_string(), "{evidence}");
        } else {
            assert_eq!(frame.header["simulated"]["label"], label);
            let (m, r) = (frame.column("measured0"), frame.column("residual0"));
            let size = |v: &[f32]| v.iter().map(|x| x * x).sum::<f32>();
            // the sample's rig has effects beyond the model
            assert!(
                size(r) < 0.04 * size(m),
                "{label}: measured and simulated differ"
            );
        }
    }
    let missing = shown(&mut page, state, "no such record");
    assert_eq!(missing.kind(), "refused");
    residuals_rise_away_from_the_fit(&mut page, state);
    residuals_are_those_of_the_machine_at_the_sliders(&mut page, state);
    let found = page.answer(&json!({"kind": "proposals"}), state);
    let proposals = found.header["proposals"].as_array().expect("a list");
    assert!(!proposals.is_empty() && proposals[0]["frequency_hz"].as_f64() > Some(5.0));
}

fn residuals_rise_away_from_the_fit(page: &mut Page, state: &Value) {
    let at_fit = page.answer(&json!({"kind": "residuals"}), state).header;
    let joint = at_fit["joint"].as_f64().expect("a joint residual");
    assert!((0.3..1.5).contains(&joint), "{joint}");
    let past = |h: &Value| {
        let all = h["brackets"].as_array().expect("brackets").iter();
        all.filter_map(|b| b["past_hz"].as_f64()).sum::<f64>()
    };
    let mut away = state.clone();
    away["restitution"] = json!(0.8);
    away["rig"]["natural_frequency_hz"] = json!(13.8);
    let off = page.answer(&json!({"kind": "residuals"}), &away).header;
    assert!(
        past(&off) > past(&at_fit) + 0.5,
        "{} {}",
        past(&off),
        past(&at_fit)
    );
    let methods = |h: &Value| h["methods"].as_array().expect("methods").clone();
    for (near, far) in methods(&at_fit).iter().zip(methods(&off)) {
        let (near, far) = (near["rms"].as_f64().expect("a number"), far["rms"].as_f64());
        assert!(far.is_none_or(|far| far > near), "{near} {far:?}");
    }
}

/// Unlike masses change all that is compared; where the records are compared with no such machine, it is said.
fn residuals_are_those_of_the_machine_at_the_sliders(page: &mut Page, state: &Value) {
    let joint = |page: &mut Page, state: &Value| {
        let header = page.answer(&json!({"kind": "residuals"}), state).header;
        header["joint"].as_f64().expect("a joint residual")
    };
    let at_fit = joint(page, state);
    for (key, ratio) in [("drive_amplitude", 0.8), ("stiffness", 1.3), ("mass", 2.0)] {
        let mut unlike = state.clone();
        unlike["asymmetry"][key] = json!(ratio);
        let residual = joint(page, &unlike);
        assert!(residual > 1.2 * at_fit, "{key}: {residual} {at_fit}");
    }
    let mut others = vec![state.clone(); 3];
    others[0]["restitution"] = json!({"table": [[0.0, 0.9], [1.0, 0.3]]});
    others[1]["asymmetry"]["drive_amplitude"] = json!(-1.0);
    others[2]["single"] = json!(true);
    for (other, why) in others.iter().zip(["R(v)", "one sign", "number of masses"]) {
        let header = page.answer(&json!({"kind": "residuals"}), other).header;
        assert!(
            header["none"]
                .as_str()
                .is_some_and(|none| none.contains(why)),
            "{header}"
        );
        let frame = shown(page, other, "r0115");
        let said = frame.header["not_simulated"].as_str().expect("why");
        assert!(
            said.contains(why) && frame.header["simulated"].is_null(),
            "{}",
            frame.header
        );
        assert!(frame.column("measured0").len() > 100 && frame.column("simulated0").is_empty());
    }
}

fn explore(folder: &Path) -> (i32, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["explore", "--no-browser"])
        .arg(folder)
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    (done.status.code().unwrap_or(-1), said)
}

#[test]
fn results_that_are_spoiled_are_refused_or_shown_with_a_note() {
    let folder = tempfile::tempdir().expect("a folder");
    let (campaign, results) = (
        folder.path().join("campaign"),
        folder.path().join("results"),
    );
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_impactid"));
        assert!(command.args(arguments).status().expect("it runs").code() < Some(2));
    };
    let (out, results_text) = (campaign.to_string_lossy(), results.to_string_lossy());
    run(&[
        "-q",
        "simulate",
        "campaign",
        "--seed",
        "7",
        "--records",
        "40",
        "--out",
        &out,
    ]);
    let toml = campaign.join("campaign.toml");
    run(&[
        "-q",
        "run",
        &toml.to_string_lossy(),
        "--out",
        &results_text,
        "--format",
        "csv",
    ]);

    let explorer = Explorer::start(&[&results_text], folder.path());
    let hello = explorer.page().hello().header;
    assert_eq!(hello["notes"], json!([]));
    assert_eq!(
        hello["campaign"]["records"].as_array().map(Vec::len),
        Some(40)
    );
    let id = hello["campaign"]["records"][0]["id"]
        .as_str()
        .expect("a name")
        .to_owned();

    // changed, then gone: a note, and the reason where the record would be
    let files: Vec<PathBuf> = std::fs::read_dir(&campaign)
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "h5"))
        .collect();
    assert!(!files.is_empty());
    let observed = results.join("observations.json.gz");
    assert!(!observed.exists());
    for file in &files {
        std::fs::remove_file(file).expect("removed");
    }
    let name = files[0].file_name().expect("a name").to_string_lossy();
    let shown_now = shown(&mut explorer.page(), &hello["state"], &id);
    assert_eq!(shown_now.header["shown"], "nothing", "{}", shown_now.header);
    opens_without_its_records(&results, &hello, &name);

    let identification = results.join("identification.json");
    let text = std::fs::read_to_string(&identification).expect("results");
    std::fs::write(
        &identification,
        text.replace(
            "\"identification.json\": \"6\"",
            "\"identification.json\": \"1\"",
        ),
    )
    .expect("written");
    let (code, said) = explore(&results);
    assert!(code == 2 && said.contains("layout 1"), "{said}");
    std::fs::remove_file(&identification).expect("removed");
    let (code, said) = explore(&results);
    assert!(code == 2 && said.contains("identification.json"), "{said}");
    let (code, said) = explore(&folder.path().join("nowhere"));
    assert!(code == 2 && said.contains("nowhere"), "{said}");
}

/// The map, the boundaries and the fit are there without the files, which are named.
fn opens_without_its_records(results: &Path, before: &Value, file: &str) {
    let explorer = Explorer::start(&[&results.to_string_lossy()], &std::env::temp_dir());
    let mut page = explorer.page();
    let hello = page.hello().header;
    assert!(
        hello["notes"].to_string().contains(file),
        "{}",
        hello["notes"]
    );
    assert_eq!(hello["campaign"]["fit"], before["campaign"]["fit"]);
    assert_eq!(hello["state"]["rig"], before["state"]["rig"]);
    let state = &hello["state"];
    assert_eq!(page.answer(&json!({"kind": "map"}), state).kind(), "map");
    for kind in ["motion", "residuals", "proposals", "tables"] {
        let frame = page.answer(&json!({"kind": kind}), state);
        assert_ne!(frame.kind(), "refused", "{}", frame.header);
    }
    let bare = page.answer(&json!({"kind": "boundaries", "points": 50}), state);
    assert_eq!(bare.kind(), "boundaries", "{}", bare.header);
    let records = hello["campaign"]["records"].as_array().expect("records");
    let id = records[0]["id"].as_str().expect("a name");
    let nothing = shown(&mut page, state, id);
    assert_eq!(nothing.header["shown"], "nothing", "{}", nothing.header);
    let why = nothing.header["why"].as_str().expect("a reason");
    assert!(why.contains(file), "{why}");
}

#[test]
fn times_of_waiting_are_refused_without_watch() {
    let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["explore", "--no-browser", "--poll", "3"])
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(
        done.status.code() == Some(2) && said.contains("add --watch"),
        "{said}"
    );
}

/// Settled motion at (η, ρ = 2) of the paper's rig (R = 0.9, β = 0.07) as a record of 12 drive periods:
/// f0 = 12.6 Hz and `x_st` = 1 mm.
fn simulated_record(folder: &Path, name: &str, eta: f64) {
    let out = folder.join(format!("{name}-motion"));
    let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args([
            "simulate",
            "--eta",
            &eta.to_string(),
            "--rho",
            "2",
            "--skip-periods",
            "300",
        ])
        .args([
            "--periods",
            "12",
            "--out",
            &out.to_string_lossy(),
            "--quiet",
        ])
        .status()
        .expect("it runs");
    assert!(done.success());
    let numbers = |line: &str| -> Vec<f64> {
        let cells = line.split(',').map_while(|cell| cell.parse().ok());
        cells.collect()
    };
    let table = |file: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(out.join(file)).expect("a table");
        text.lines().skip(1).map(numbers).collect()
    };
    let impacts: Vec<f64> = table("motion-impacts.csv")
        .iter()
        .map(|row| row[0])
        .collect();
    let (drive_hz, speed_m_s) = (12.6 * eta, std::f64::consts::TAU * 12.6 * 1e-3);
    let mut text = String::from("time [s],drive [V],contact [V],vx [m/s],vy [m/s],x [m],y [m]\n");
    for row in table("motion.csv") {
        let turns = row[0] - 300.0;
        let closed = |at: &f64| (0.0..3e-4 * drive_hz).contains(&(row[0] - at));
        let contact = if impacts.iter().any(closed) { 5.0 } else { 0.0 };
        text += &format!(
            "{:.8},{:.6},{contact},{:.8},{:.8},{:.10},{:.10}\n",
            turns / drive_hz,
            (std::f64::consts::TAU * turns).cos(),
            row[2] * speed_m_s,
            row[4] * speed_m_s,
            row[1] * 1e-3,
            row[3] * 1e-3,
        );
    }
    std::fs::write(folder.join(format!("{name}.csv")), text).expect("written");
}

#[test]
fn longer_periods_chaos_and_records_left_out_are_shown_with_their_evidence() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, eta) in [("doubled", 0.79), ("chaos", 0.725), ("excluded", 1.1)] {
        simulated_record(folder.path(), name, eta);
    }
    let campaign = "[campaign]\nmachine = \"double\"\n[records]\nfiles = \"*.csv\"\n\
         clearance = \"2 mm\"\n\
         [rig]\nnatural_frequency = \"12.6 Hz\"\ndamping_ratio = 0.07\n\
         static_deflection = \"1 mm\"\nrestitution = 0.9\n\
         [channels.drive]\nchannel = \"drive\"\n\
         [channels.contact]\nchannel = \"contact\"\nthreshold = \"2.5 V\"\n\
         [channels.velocity_x]\nchannel = \"vx\"\n[channels.velocity_y]\nchannel = \"vy\"\n\
         [channels.displacement_x]\nchannel = \"x\"\n[channels.displacement_y]\nchannel = \"y\"\n\
         [analysis]\nexclude = [\"excluded\"]\n";
    std::fs::write(folder.path().join("campaign.toml"), campaign).expect("written");
    let explorer = Explorer::start(&["campaign.toml"], folder.path());
    let mut page = explorer.page();
    let hello = page.hello().header;
    for (name, label) in [("doubled", "2/2"), ("chaos", "chaotic")] {
        let frame = shown(&mut page, &hello["state"], name);
        assert_eq!(frame.header["shown"], "motion", "{name}: {}", frame.header);
        let evidence = &frame.header["evidence"];
        assert_eq!(frame.header["stated"]["motion"]["label"], label);
        assert_eq!(frame.header["simulated"]["label"], label);
        assert!(evidence["measures"]["periods_observed"].as_f64() > Some(10.0));
        assert!(frame.column("measured0").len() > 500 && !frame.column("simulated0").is_empty());
    }
    let left_out = shown(&mut page, &hello["state"], "excluded");
    let evidence = &left_out.header["evidence"];
    assert!(evidence["used_by"].as_array().is_some_and(Vec::is_empty));
    let flag = evidence["flags"][0]["message"]
        .as_str()
        .expect("why it is left out");
    assert!(flag.contains("excludes this record"), "{flag}");
    assert!(left_out.column("measured0").len() > 500);
}

/// Two releases of a mass on a spring, and a record without drive or decay.
#[test]
fn a_free_decay_is_shown_with_its_fit_and_a_record_with_nothing_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    let table = |x: &dyn Fn(f64) -> f64| {
        let rows = (0..4000).map(|i| f64::from(i) / 2000.0);
        let rows = rows.map(|t| format!("{t:.6},{:.9}\n", x(t)));
        String::from("time [s],x [mm]\n") + &rows.collect::<String>()
    };
    let omega = std::f64::consts::TAU * 12.0;
    let decay = |t: f64| (-0.02 * omega * t).exp() * (omega * (1.0 - 4e-4_f64).sqrt() * t).cos();
    write("a.csv", &table(&decay));
    write("b.csv", &table(&|t| 0.5 * decay(t)));
    write("c.csv", &table(&|_| 0.25));
    write(
        "runs.csv",
        "file,record,excitation\na.csv,a,free_decay\nb.csv,b,free_decay\nc.csv,c,free_decay\n",
    );
    write(
        "campaign.toml",
        "[campaign]\nmachine = \"single\"\n[records]\nrun_table = \"runs.csv\"\n\
         [channels.displacement_x]\nchannel = \"x\"\nunit = \"mm\"\n",
    );
    let explorer = Explorer::start(&["campaign.toml"], folder.path());
    let mut page = explorer.page();
    let hello = page.hello().header;
    let frame = shown(&mut page, &hello["state"], "a");
    assert_eq!(frame.header["shown"], "decay", "{}", frame.header);
    let fitted = |key: &str| frame.header[key][0].as_f64().expect("a number");
    assert!((fitted("natural_frequency_hz") - 12.0).abs() < 1e-3);
    assert!((fitted("damping_ratio") - 0.02).abs() < 1e-4);
    assert!(frame.column("measured0").len() > 1000 && frame.column("simulated1").len() > 1000);
    let nothing = shown(&mut page, &hello["state"], "c");
    assert_eq!(nothing.header["shown"], "nothing", "{}", nothing.header);
    assert!(
        nothing.header["why"]
            .as_str()
            .expect("a reason")
            .contains("decay")
    );
    assert!(
        !nothing.header["evidence"]["flags"]
            .as_array()
            .expect("flags")
            .is_empty()
    );
}

#[test]
fn results_are_opened_from_any_directory_with_their_inputs() {
    let results = concat!(env!("CARGO_MANIFEST_DIR"), "/reports/example");
    let elsewhere = tempfile::tempdir().expect("a folder");
    let explorer = Explorer::start(&[results], elsewhere.path());
    let hello = explorer.page().hello();
    let notes = hello.header["notes"].to_string();
    assert!(!notes.contains("any more"), "{notes}");
}
