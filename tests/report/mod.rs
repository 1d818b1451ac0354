//! The report as a user gets it: its formats, its options, its languages, and the finished example.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The day of the example's report.
const DAY: &str = "1795651200";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn impactid(arguments: &[&str]) -> (i32, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .current_dir(root())
        .env("SOURCE_DATE_EPOCH", DAY)
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&done.stderr).into_owned();
    (done.status.code().unwrap_or(-1), text)
}

/// Output of another program; `None`, with a message, if it is not installed.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    match Command::new(program).args(arguments).output() {
        Ok(done) => Some(String::from_utf8_lossy(&done.stdout).into_owned()),
        Err(_) => {
            println!("skipped: {program} is not installed");
            None
        }
    }
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The sample campaign cut to every `step`-th record, with lines added to campaign.toml.
fn cut_campaign(folder: &Path, step: usize, more: &str) -> PathBuf {
    let sample = root().join("data-samples/double-oscillator");
    let read = |name: &str| fs::read_to_string(sample.join(name)).expect("the sample");
    let runs = read("runs.csv").replace("records.h5", &text(&sample.join("records.h5")));
    let kept = |(i, line): (usize, &str)| (i == 0 || i % step == 5).then(|| line.to_owned());
    let lines: Vec<String> = runs.lines().enumerate().filter_map(kept).collect();
    fs::write(folder.join("runs.csv"), lines.join("\n") + "\n").expect("written");
    let campaign = folder.join("campaign.toml");
    fs::write(&campaign, read("campaign.toml") + more).expect("written");
    campaign
}

fn stems(folder: &Path, ending: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|e| e.expect("an entry").path());
    paths
        .filter(|p| p.extension().is_some_and(|e| e == ending))
        .filter_map(|p| p.file_stem().map(|s| s.to_string_lossy().into_owned()))
        .collect()
}

#[test]
fn every_format_is_written_and_every_figure_has_its_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let campaign = cut_campaign(folder.path(), 25, "");
    let out = folder.path().join("out");
    let arguments = [
        "-q",
        "run",
        &text(&campaign),
        "--out",
        &text(&out),
        "--format",
        "pdf,html,svg,png",
    ];
    assert_eq!(impactid(&arguments).0, 0);
    assert!(out.join("report.pdf").is_file() && out.join("report.html").is_file());
    let figures = out.join("figures");
    let drawn = stems(&figures, "svg");
    assert!(drawn.contains("map") && drawn.contains("comparison_A"));
    assert_eq!(drawn, stems(&figures, "png"));
    // the small map shows the data of the full one
    let small = BTreeSet::from(["map_small".to_owned()]);
    let with_data: BTreeSet<String> = drawn.difference(&small).cloned().collect();
    assert_eq!(with_data, stems(&figures, "csv"));
    let map = fs::read_to_string(figures.join("map.csv")).expect("the map's data");
    for layer in [
        "record,",
        "curve,s2,",
        "curve,grazing,",
        "region,",
        "band95,",
    ] {
        let there = map.lines().any(|l| l.starts_with(layer));
        assert!(there, "the map's data has no layer {layer}");
    }
}

#[test]
fn paper_logo_template_and_decimal_sign_are_the_user_s() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(
        folder.path().join("logo.svg"),
        "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'><rect width='9' height='9'/></svg>",
    )
    .expect("written");
    let look = "\n[report]\nlogo = \"logo.svg\"\ndecimal_comma = true\npaper = \"us-letter\"\n\
                points = [\"r0079\"]\n";
    let campaign = cut_campaign(folder.path(), 25, look);
    let written = fs::read_to_string(&campaign).expect("campaign.toml");
    let stated = "[campaign]\nlaboratory = \"Laboratory of Mechanics\"\nmeasured = \"May 1971\"";
    fs::write(&campaign, written.replacen("[campaign]", stated, 1)).expect("written");
    let out = text(&folder.path().join("out"));
    let ingest = ["-q", "ingest", &text(&campaign), "--out", &out];
    assert_eq!(impactid(&ingest), (0, String::new()));
    for stage in ["classify", "identify", "report"] {
        assert_eq!(impactid(&["-q", stage, &out]).0, 0, "{stage}");
    }
    let figures = stems(&Path::new(&out).join("figures"), "csv");
    let shown: Vec<&String> = figures
        .iter()
        .filter(|f| f.starts_with("comparison"))
        .collect();
    assert_eq!(shown, ["comparison_A"]);
    let pdf = format!("{out}/report.pdf");
    if let Some(words) = said("pdftotext", &["-layout", &pdf, "-"]) {
        for wanted in [
            "Laboratory of Mechanics",
            "May 1971",
            "R = 0,",
            "Point (A)",
            "impactid ingest",
            "impactid report",
        ] {
            assert!(words.contains(wanted), "'{wanted}' is not in the report");
        }
    }
    if let Some(info) = said("pdfinfo", &[&pdf]) {
        assert!(info.contains("612 x 792"), "{info}");
    }
    let first = fs::read(&pdf).expect("the report");
    assert_eq!(impactid(&["-q", "-j", "1", "report", &out]).0, 0);
    assert!(
        first == fs::read(&pdf).expect("the report"),
        "the same input gave other bytes"
    );
    let template = folder.path().join("own.typ");
    fs::write(
        &template,
        "#let d = json(\"report.json\")\n= Our own: #d.title\n",
    )
    .expect("written");
    assert_eq!(
        impactid(&["-q", "report", &out, "--template", &text(&template)]).0,
        0
    );
    if let Some(words) = said("pdftotext", &[&pdf, "-"]) {
        assert!(words.contains("Our own: Synthetic"), "{words}");
    }
    let (code, complaint) = impactid(&["report", &out, "--template", "nowhere.typ"]);
    assert!(
        code == 2 && complaint.contains("nowhere.typ"),
        "{complaint}"
    );
}

#[test]
fn a_report_of_published_speeds_is_made_again_in_another_format_and_language() {
    let folder = tempfile::tempdir().expect("a folder");
    let published = text(&root().join("data-samples/published-speeds/campaign.toml"));
    let out = text(&folder.path().join("out"));
    let (code, told) = impactid(&["-q", "run", &published, "--out", &out, "--format", "pdf"]);
    assert_eq!(code, 0, "{told}");
    let again = ["-q", "report", &out, "--format", "html", "--language", "de"];
    let (code, told) = impactid(&again);
    assert_eq!(code, 0, "{told}");
    let page = fs::read_to_string(Path::new(&out).join("report.html")).expect("a page");
    let stated = page.contains("veröffentlicht") && page.contains("0,005");
    assert!(stated, "{}", page.len());
}

/// Each table as LaTeX, in a paper of its own.
#[test]
fn every_table_compiles_with_pdflatex() {
    if said("pdflatex", &["--version"]).is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let published = root().join("data-samples/published-speeds/campaign.toml");
    for (i, campaign) in [cut_campaign(folder.path(), 8, ""), published]
        .iter()
        .enumerate()
    {
        let out = folder.path().join(format!("out{i}"));
        let run = ["-q", "run", &text(campaign), "--out", &text(&out)];
        let (code, told) = impactid(&[&run[..], &["--format", "tex"]].concat());
        assert!(code <= 1, "{told}");
        let tables = stems(&out.join("tables"), "tex");
        assert!(!tables.is_empty());
        for name in tables {
            compiles(&out, &name);
        }
    }
}

/// Sets a table in a paper; a small TeX has no booktabs, whose rules are lines then.
fn compiles(out: &Path, name: &str) {
    let paper = format!(
        "\\documentclass{{article}}\\usepackage{{graphicx}}\\usepackage{{longtable}}
\\IfFileExists{{booktabs.sty}}{{\\usepackage{{booktabs}}}}
{{\\let\\toprule\\hline\\let\\midrule\\hline\\let\\bottomrule\\hline}}
\\begin{{document}}\\input{{tables/{name}}}\\end{{document}}
"
    );
    fs::write(out.join("paper.tex"), paper).expect("written");
    let done = Command::new("pdflatex")
        .args(["-interaction=nonstopmode", "-halt-on-error", "paper.tex"])
        .current_dir(out)
        .output()
        .expect("pdflatex");
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(done.status.success(), "{name}: {told}");
    assert!(!told.contains("Overfull \\hbox"), "{name}: {told}");
}

/// The words are those of a table that campaign.toml or the command line names.
#[test]
fn phrases_are_those_of_the_user_s_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = "\n[report]\nlanguage = \"de\"\n";
    let campaign = cut_campaign(folder.path(), 25, line);
    let out = text(&folder.path().join("out"));
    let formats = ["--format", "html,svg"];
    let run = ["run", &text(&campaign), "--out", &out];
    let (code, told) = impactid(&[&run[..], &formats].concat());
    assert!(code == 0 && !told.contains("note:"), "{told}");
    let map = fs::read_to_string(format!("{out}/figures/map.svg")).expect("the map");
    assert!(map.contains("Erregerfrequenz") && map.contains("Spielverhältnis"));
    assert!(!map.contains("drive") && !map.contains("clearance"));
    let page = fs::read_to_string(format!("{out}/report.html")).expect("the page");
    assert!(page.contains("<html lang=\"de\">") && page.contains("Bewegungsgebiete"));
    for (german, english) in [
        ("Der Prüfstand hat", "The rig has"),
        ("Die Antworten sind die", "The responses are those"),
        ("Die Verfahren stimmen überein", "methods agree.</b>"),
    ] {
        assert!(page.contains(german) && !page.contains(english), "{german}");
    }

    for stage in ["ingest", "classify", "identify"] {
        let from = [stage, &text(&campaign), "--out", &out];
        let given = if stage == "ingest" {
            &from[..]
        } else {
            &[stage, &out]
        };
        assert_eq!(impactid(&[&["-q"], given].concat()).0, 0, "{stage}");
    }
    let own = folder.path().join("own.toml");
    let table =
        "[words]\n\"clearance ratio $ρ$ = $r$/$x_st$\" = \"my $ρ$\"\n\"no phrase\" = \"x\"\n";
    fs::write(&own, table).expect("written");
    let report = ["report", &out, "--words", &text(&own)];
    let (code, told) = impactid(&[&report[..], &formats].concat());
    assert!(code == 0 && told.contains("stay English"), "{told}");
    assert!(told.contains("\"no phrase\""), "{told}");
    let map = fs::read_to_string(format!("{out}/figures/map.svg")).expect("the map");
    assert!(map.contains("my\u{a0}") && map.contains("frequency"));

    fs::write(&own, "[words]\n\"{first} to {last}\" = \"until\"\n").expect("written");
    let (code, told) = impactid(&report);
    assert!(code == 2 && told.contains("{first}"), "{told}");
    let wrong = cut_campaign(folder.path(), 25, "\n[report]\nwords = \"own.toml\"\n");
    let (code, told) = impactid(&["check", &text(&wrong)]);
    assert!(code == 2 && told.contains("{first}"), "{told}");
}

/// The sample campaign is what the README's command writes: settings, run table and truth, byte by byte.
#[test]
fn regress_the_sample_is_what_the_readme_s_command_leaves() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let after = readme.split("`impactid simulate campaign --seed").nth(1);
    let told = after
        .and_then(|t| t.split('`').next())
        .expect("the command");
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(folder.path());
    let mut words = vec!["-q", "simulate", "campaign", "--seed"];
    words.extend(
        told.split_whitespace()
            .map(|w| if w == "DIR" { &out } else { w }),
    );
    assert_eq!(impactid(&words).0, 0);
    let sample = root().join("data-samples/double-oscillator");
    for name in ["campaign.toml", "runs.csv", "truth.json"] {
        let read = |folder: &Path| fs::read_to_string(folder.join(name)).expect("a text");
        assert!(read(folder.path()) == read(&sample), "{name} differs");
    }
}

/// What the README's command writes is what is in reports/example.
#[test]
fn regress_the_example_is_what_the_readme_s_command_leaves() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let line = readme
        .lines()
        .map(str::trim)
        .find(|l| l.starts_with("cargo run") && l.contains("--out reports/example"))
        .expect("the README shows the command");
    let words: Vec<&str> = line.split_whitespace().collect();
    let verb = words.iter().position(|w| *w == "run").expect("run") + 1;
    let arguments: Vec<&str> = words[verb..]
        .iter()
        .copied()
        .filter(|w| *w != "--")
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(folder.path());
    let here: Vec<&str> = arguments
        .iter()
        .map(|w| {
            if *w == "reports/example" {
                out.as_str()
            } else {
                w
            }
        })
        .collect();
    assert_eq!(impactid(&here).0, 0);
    let example = root().join("reports/example");
    let list = |folder: &Path| -> BTreeSet<String> {
        let entries = walk(folder);
        let relative = entries
            .iter()
            .map(|p| p.strip_prefix(folder).expect("below"));
        relative.map(text).collect()
    };
    assert_eq!(list(folder.path()), list(&example));
    let words = |folder: &Path| {
        let pdf = text(&folder.join("report.pdf"));
        // In the order of writing, which no width of a label changes.
        said("pdftotext", &["-raw", &pdf, "-"]).map(|t| comparable(&t, &out))
    };
    assert_eq!(words(folder.path()), words(&example));
    checked_pdf(&example.join("report.pdf"));
    checked_page(&example.join("report.html"));
    assert!(readme.contains("](reports/example/figures/map.png)"));
}

/// The text of a report, line by line, without the name of its output folder, the residuals of single
/// trajectories and the numbers along their axes: a chaotic one amplifies the last digit of another
/// machine.
fn comparable(words: &str, out: &str) -> String {
    let words = words.replace(out, "reports/example");
    let lines = words.lines().filter(|line| {
        let number = line.trim().replace('−', "-");
        number.parse::<f64>().is_err()
    });
    let told = lines.map(|line| {
        let told = line.split_once("rms residual").map_or(line, |l| l.0);
        told.split_whitespace().collect::<Vec<_>>().join(" ")
    });
    told.collect::<Vec<_>>().join("\n")
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|e| e.expect("an entry").path());
    paths
        .flat_map(|p| if p.is_dir() { walk(&p) } else { vec![p] })
        .collect()
}

/// Few pages, fonts embedded, the answer selectable, not too large.
fn checked_pdf(path: &Path) {
    assert!(fs::metadata(path).expect("the report").len() < 5_000_000);
    let pdf = text(path);
    let Some(words) = said("pdftotext", &["-layout", &pdf, "-"]) else {
        return;
    };
    let pages = words.matches('\u{c}').count();
    assert!((6..=12).contains(&pages), "{pages} pages");
    for wanted in ["R = 0.", "± ", "f0 = 12.", "β = 0.0", "The methods agree"] {
        assert!(words.contains(wanted), "'{wanted}' is not in the text");
    }
    // a line or two after the definitions stays with them
    let mut each = words.split('\u{c}');
    let conventions = each.find(|page| page.contains("Intervals are at 95"));
    assert!(conventions.is_some_and(|page| page.contains("of each mass between impacts")));
    let fonts = said("pdffonts", &[&pdf]).unwrap_or_default();
    for font in fonts.lines().skip(2) {
        let fields: Vec<&str> = font.split_whitespace().rev().collect();
        assert_eq!(fields[4], "yes", "not embedded: {font}");
    }
}

/// A browser opens the page, zooms a figure and hovers over a record.
fn checked_page(path: &Path) {
    let page = fs::read_to_string(path).expect("the page");
    for outside in ["src=\"http", "href=\"http", "url(http"] {
        assert!(
            !page.contains(outside),
            "it loads from elsewhere: {outside}"
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    let profile = format!("--user-data-dir={}", text(folder.path()));
    let address = format!("file://{}#check", text(path));
    let flags = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--virtual-time-budget=3000",
        &profile,
        "--dump-dom",
        &address,
    ];
    let Some(seen) = said("chromium", &flags) else {
        return;
    };
    let after = seen.split("<body").nth(1).expect("a body");
    let body = after.split('>').next().expect("its tag");
    let figures = page.matches("class=\"drawing\"").count();
    assert!(
        body.contains(&format!("data-figures=\"{figures}\"")),
        "{body}"
    );
    assert!(body.contains("data-hovered=\"r0"), "{body}");
    assert!(body.contains("data-zoomed=\"2.00\""), "{body}");
}
