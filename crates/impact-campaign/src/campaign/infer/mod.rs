//! The records in a folder of files, and the role that each channel probably has.

mod axes;
mod bodies;
mod contact;
mod drive;
mod experiment;
mod found;
mod globs;
mod heights;
mod lists;
mod look;
mod names;
mod not_read;
mod place;
mod roles;
mod unlike;

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::discovery::{Opener, called};
use super::resolved::RESOLVED;
use super::run_table;
use impact_records::record::time_axis;
use impact_records::signal::robust;
use labfiles::{ChannelInfo, Clock, DatasetInfo, ReadError, Source};

use globs::slashed;
use place::{Place, spread};

pub use found::{Experiment, FolderContents, InferredChannel, RefusedFile};
pub use roles::implied_unit;

/// Depth of the search below the folder.
const DEPTH: usize = 4;

/// Read the headers of all files below a folder, and infer the channels' roles.
pub fn inspect_folder(folder: &Path, open: Opener<'_>) -> FolderContents {
    let mut paths = Vec::new();
    collect(folder, DEPTH, &mut HashSet::new(), &mut paths);
    paths.sort();
    let mut found = FolderContents::default();
    let mut opened = Vec::new();
    let mut run_sheet = None;
    for path in &paths {
        let relative = path.strip_prefix(folder).unwrap_or(path).to_path_buf();
        if found.run_table.is_none()
            && let Some(head) = head_of_run_table(folder, path)
        {
            found.run_table = Some(slashed(&relative));
            found.states_drive = run_table::states_drive(&head);
            continue;
        }
        let opened_path = open(path);
        let of_book = match &opened_path {
            Ok(source) => source.format() == "excel",
            Err(_) => ends_as_workbook(path),
        };
        if found.run_table.is_none() && of_book {
            run_sheet = run_sheet_of(folder, &slashed(&relative), &mut found);
        }
        let source = record_of(opened_path, slashed(&relative), &mut found);
        opened.extend(source.map(|source| (relative, source)));
    }
    let all = opened.iter().flat_map(|(_, s)| records_in(s.as_ref()));
    let mut places = without_notes(all.collect());
    found.notes.extend(unlike::usual_first(&mut places));
    let of = |source: &dyn Source| {
        let held = places
            .iter()
            .filter(|p| std::ptr::addr_eq(p.source, source));
        held.map(|p| p.dataset).collect::<Vec<_>>()
    };
    let (records, noted): (Vec<_>, Vec<_>) = opened
        .iter()
        .partition(|(_, source)| !of(source.as_ref()).is_empty());
    found
        .others
        .extend(noted.iter().map(|(path, _)| slashed(path)));
    for (path, source) in &records {
        let used = of(source.as_ref());
        let sets = source.datasets().iter().enumerate();
        let lists = |set: &DatasetInfo| Some((slashed(path), set.name.clone())) == run_sheet;
        let others = sets.filter(|(i, set)| !used.contains(i) && !lists(set));
        let named = others.map(|(_, set)| format!("{}: {}", slashed(path), called(set)));
        found.others.extend(named);
    }
    let table = found.run_table.clone();
    found.others.retain(|other| Some(other) != table.as_ref());
    found.files = records.len();
    let named: Vec<&Path> = records.iter().map(|(path, _)| path.as_path()).collect();
    let relative = |path: &PathBuf| path.strip_prefix(folder).unwrap_or(path).to_path_buf();
    let rest: Vec<PathBuf> = paths.iter().map(relative).collect();
    found.globs = globs::of(&named, &rest);
    found.records = places.len();
    let first_file = places.first().and_then(|first| {
        let mut files = opened.iter();
        files.find(|(_, source)| std::ptr::addr_eq(source.as_ref(), first.source))
    });
    if let (Some((path, _)), Some(first)) = (first_file, places.first()) {
        found.example = slashed(path);
        describe(*first, &mut found);
        without_runs(&places, &mut found.channels);
        found.looked_at = 1 + look_at_others(&places, &mut found.channels);
        roles::assign(&mut found.channels);
    }
    experiment::infer(&places, &mut found);
    note_what_is_not_read(folder, &places, &named, &mut found);
    found
}

/// The file that was opened, if it holds records; else why it does not is noted.
fn record_of(
    opened: Result<Box<dyn Source>, ReadError>,
    file: String,
    found: &mut FolderContents,
) -> Option<Box<dyn Source>> {
    let [reason, remedy] = match opened {
        Ok(source) => match not_read::why(source.as_ref()) {
            Some(why) => why,
            None if holds_record(source.as_ref()) => return Some(source),
            None => {
                found.others.push(file);
                return None;
            }
        },
        Err(error) => [error.found, error.remedy],
    };
    found.refused.push(RefusedFile {
        file,
        reason,
        remedy,
    });
    None
}

/// Name of a run table that is made of the names of the files.
const RUN_TABLE: &str = "runs.csv";

/// Take the settings of driven records from the names of their files: into a run table where each states its own and nothing
/// else does, else as a note.
fn of_names(folder: &Path, names: &[&Path], found: &mut FolderContents) {
    let is_clearance = |name: &String| run_table::column_name(name) == Some("clearance");
    let one_each = found.records == found.files && !folder.join(RUN_TABLE).exists();
    let stated = found.attributes.keys().any(is_clearance);
    match names::table(names).filter(|_| one_each && !stated) {
        Some(table) => {
            found.notes.push(format!(
                "{RUN_TABLE} states the frequencies, lengths and directions that are in the names of the files: correct it where the \
                 lengths are no clearances, as the whole gap between two masses is twice their clearance"
            ));
            found.run_table = Some(RUN_TABLE.to_owned());
            found.table_of_names = Some(table);
        }
        None => found.notes.extend(names::note(names)),
    }
}

/// Note what lists have beside their rows, and settings that only the names of driven records state.
fn note_what_is_not_read(
    folder: &Path,
    places: &[Place<'_>],
    names: &[&Path],
    found: &mut FolderContents,
) {
    match found.experiment {
        Experiment::Events(_) => {
            let all = places.iter().flat_map(|place| place.source.notes());
            for note in all {
                if !found.notes.contains(note) {
                    found.notes.push(note.clone());
                }
            }
        }
        Experiment::Driven if found.run_table.is_none() => of_names(folder, names, found),
        _ => {}
    }
}

/// Take a workbook as the run table if one of its sheets is such; its name and that sheet's. One that cannot name its
/// records is noted.
fn run_sheet_of(folder: &Path, book: &str, found: &mut FolderContents) -> Option<(String, String)> {
    let sheet = run_table::sheet_of(folder, book)?;
    if !sheet.names_records {
        found.notes.push(format!(
            "{book} states the settings of datasets that are not in it; it can be the run table with a column file that \
             names the workbook of each"
        ));
        return None;
    }
    found.run_table = Some(book.to_owned());
    found.states_drive = sheet.states_drive;
    Some((book.to_owned(), sheet.name))
}

/// Whether a file is called as a workbook is.
fn ends_as_workbook(path: &Path) -> bool {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    ending.is_some_and(|e| e.starts_with("xls"))
}

/// How many times longer than a table of notes, with times of its own, a record is.
const LONGER_THAN_NOTES: u64 = 4;

/// The records among tables. Those without times beside others with times are notes or settings, and so are those
/// far shorter than the longest that share no channel with it.
fn without_notes(mut places: Vec<Place<'_>>) -> Vec<Place<'_>> {
    let timed = |place: &Place<'_>| {
        let set = place.set();
        let counts = || (0..set.channels.len()).any(|i| time_axis::counts_frames(set, i));
        is_timed(set) || lists::is_list(*place) || counts()
    };
    let any_timed = places.iter().any(timed);
    if any_timed {
        places.retain(timed);
    }
    let rows = |place: &Place<'_>| {
        let channels = place.set().channels.iter();
        channels.map(|c| c.samples).max().unwrap_or(0)
    };
    let Some(longest) = places.iter().copied().max_by_key(rows) else {
        return places;
    };
    let time = |set: &DatasetInfo, i: usize| set.time_axis == Some(i);
    let of_lists = lists::is_list(longest);
    places.retain(|place| {
        let set = place.set();
        let mut signals = set
            .channels
            .iter()
            .enumerate()
            .filter(|(i, _)| !time(set, *i));
        let shares = signals.any(|(_, c)| longest.set().channel_index(&c.name).is_some());
        let long = any_timed && LONGER_THAN_NOTES * rows(place) > rows(&longest);
        shares || long || of_lists && lists::is_list(*place)
    });
    places
}

/// Whether a file states when the samples of a dataset were taken.
fn is_timed(set: &DatasetInfo) -> bool {
    set.time_axis.is_some() || set.channels.iter().any(|c| c.sample_rate_hz.is_some())
}

/// The records of a file.
fn records_in(source: &dyn Source) -> impl Iterator<Item = Place<'_>> {
    let places = (0..source.datasets().len()).map(move |dataset| Place { source, dataset });
    places.filter(|place| is_record(*place))
}

/// The files below a folder, also through links, each folder once; folders of results are left out.
fn collect(folder: &Path, depth: usize, seen: &mut HashSet<PathBuf>, paths: &mut Vec<PathBuf>) {
    let real = folder.canonicalize();
    let new = real.is_ok_and(|real| seen.insert(real));
    let entries = std::fs::read_dir(folder);
    let (Ok(entries), true) = (entries, new && !folder.join(RESOLVED).exists()) else {
        return;
    };
    let mut entries: Vec<_> = entries.filter_map(Result::ok).collect();
    // a folder before the links to it
    entries.sort_by_key(|e| (e.path().is_symlink(), e.path()));
    for entry in entries {
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        let path = entry.path();
        match path.metadata() {
            Ok(kind) if kind.is_dir() && !hidden && depth > 0 => {
                collect(&path, depth - 1, seen, paths);
            }
            Ok(kind) if kind.is_file() && !hidden && !is_other(&path) => paths.push(path),
            _ => {}
        }
    }
}

/// Files that hold no records by their ending.
fn is_other(path: &Path) -> bool {
    const OTHER: [&str; 10] = [
        "toml", "json", "md", "pdf", "svg", "png", "py", "m", "tex", "zip",
    ];
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    ending.is_none_or(|e| OTHER.contains(&e.as_str()))
}

/// Bytes at the front of a file that show whether it is a run table.
const HEAD_BYTES: u64 = 1 << 16;

/// The front of a file below a folder that is a text table with a column of files.
fn head_of_run_table(folder: &Path, path: &Path) -> Option<Vec<u8>> {
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    if !["csv", "tsv", "txt"].contains(&ending.as_str()) {
        return None;
    }
    let mut head = Vec::new();
    let read = File::open(path).and_then(|f| f.take(HEAD_BYTES).read_to_end(&mut head));
    read.ok()?;
    run_table::is_run_table(&head, &run_table::is_file(folder, path)).then_some(head)
}

fn holds_record(source: &dyn Source) -> bool {
    records_in(source).next().is_some()
}

/// Fewest samples of a record.
const FEWEST_SAMPLES: u64 = 16;

/// Whether a dataset is a record: of many samples, a list of events, or heights.
fn is_record(place: Place<'_>) -> bool {
    let mut channels = place.set().channels.iter();
    channels.any(|c| c.samples >= FEWEST_SAMPLES)
        || lists::is_list(place)
        || heights::of(place).is_some()
}

fn describe(first: Place<'_>, found: &mut FolderContents) {
    let set = first.set();
    found.format = first.source.format();
    found.datasets = first.source.datasets().len();
    found.attributes = set.attributes.clone();
    found.timed = is_timed(set);
    found.states_drive |= set.attributes.keys().any(|name| is_drive_frequency(name));
    let frames = |i| time_axis::counts_frames(set, i);
    found.counts_frames = !found.timed && (0..set.channels.len()).any(frames);
    found.channels = channels(first);
}

/// Whether an attribute is called as the frequency of a drive.
fn is_drive_frequency(name: &str) -> bool {
    let lower = name.to_lowercase();
    let driven = ["drive", "exc", "forc", "anreg", "erreg"];
    lower.contains("freq") && driven.iter().any(|word| lower.contains(word))
}

fn channels(first: Place<'_>) -> Vec<InferredChannel> {
    let set = first.set();
    let seen = |(i, info): (usize, &ChannelInfo)| {
        let values = first.numbers(i);
        let levels = two_levels(&values);
        InferredChannel {
            name: info.name.clone(),
            label: info.properties.get("label").cloned(),
            unit: info.unit.clone(),
            samples: info.samples,
            range: range(&values),
            is_time: set.time_axis == Some(i)
                || time_axis::counts_frames(set, i)
                || is_clock(set, i)
                || counts_rows(&values),
            role: None,
            levels,
            closes_at: None,
            changes: levels.map_or(0, |levels| changes(&values, levels)),
            sign: 1,
            counted_in: None,
        }
    };
    set.channels.iter().enumerate().map(seen).collect()
}

/// Leave the names of runs out of those of channels, where each record has one channel that is called so without:
/// `Position Run #1`, `Position Run #2` in files of their own.
fn without_runs(places: &[Place<'_>], channels: &mut [InferredChannel]) {
    for (index, channel) in channels.iter_mut().enumerate() {
        let Some((bare, _)) = labfiles::without_run(&channel.name) else {
            continue;
        };
        let shorter = InferredChannel {
            name: bare,
            ..channel.clone()
        };
        let own = places.first().and_then(|place| shorter.find(place.set()));
        let all = places
            .iter()
            .all(|place| shorter.find(place.set()).is_some());
        if all && own == Some(index) {
            *channel = shorter;
        }
    }
}

/// Whether values are the numbers of their rows.
fn counts_rows(values: &[f64]) -> bool {
    let whole = values.first().is_some_and(|first| first.fract() == 0.0);
    whole && values.len() as u64 >= FEWEST_SAMPLES && values.windows(2).all(|w| w[1] - w[0] == 1.0)
}

/// Whether a channel holds the times of others.
fn is_clock(set: &DatasetInfo, index: usize) -> bool {
    set.channels.iter().any(|c| c.clock == Clock::Axis(index))
}

/// Records whose signals are looked at, the first among them.
const MOST_RECORDS: usize = 12;
/// Most samples of all channels of those after the first.
const MOST_SAMPLES: u64 = 20_000_000;

/// Add what other records show of the channels of the first: impacts may not be in every record. The
/// number of records looked at.
fn look_at_others(places: &[Place<'_>], channels: &mut [InferredChannel]) -> usize {
    let mut looked_at = 0;
    let mut left = MOST_SAMPLES;
    for place in spread(places, MOST_RECORDS).into_iter().skip(1) {
        let size = place.set().channels.iter().map(|c| c.samples).sum();
        let Some(rest) = left.checked_sub(size) else {
            continue;
        };
        (left, looked_at) = (rest, looked_at + 1);
        for channel in channels.iter_mut() {
            let Some(index) = channel.find(place.set()) else {
                continue;
            };
            let values = place.numbers(index);
            let levels = two_levels(&values);
            let changes = levels.map_or(0, |levels| changes(&values, levels));
            channel.range = hull(channel.range, range(&values));
            channel.levels = wider(channel.levels, levels);
            channel.changes = channel.changes.max(changes);
        }
    }
    looked_at
}

fn range(values: &[f64]) -> Option<[f64; 2]> {
    robust::range(values.iter().copied()).map(Into::into)
}

/// The least range that holds both.
fn hull(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    robust::range(a.into_iter().chain(b).flatten()).map(Into::into)
}

/// The levels that are farther apart: noise has two as well, where it is coarsely digitised.
fn wider(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let apart = |[low, high]: &[f64; 2]| high - low;
    a.into_iter()
        .chain(b)
        .max_by(|x, y| apart(x).total_cmp(&apart(y)))
}

/// The two levels of a signal that is nearly always at one of them, as a contact.
fn two_levels(values: &[f64]) -> Option<[f64; 2]> {
    if (values.len() as u64) < FEWEST_SAMPLES {
        return None;
    }
    let (low, high) = robust::range(values.iter().copied())?;
    let near = |level: f64| {
        let width = 0.15 * (high - low);
        values
            .iter()
            .filter(|v| (**v - level).abs() < width)
            .count()
    };
    let (below, above) = (near(low), near(high));
    let kept = (below + above) as f64 >= 0.9 * values.len() as f64;
    let crossings = changes(values, [low, high]);
    // a sine is long near its crests too, but takes more than two samples between them
    let steep = values
        .windows(2)
        .filter(|w| (w[1] - w[0]).abs() > 0.4 * (high - low))
        .count();
    (high > low && kept && below > 0 && above > 0 && crossings > 0 && 2 * steep >= crossings)
        .then_some([low, high])
}

/// How often values go from one of two levels to the other.
fn changes(values: &[f64], [low, high]: [f64; 2]) -> usize {
    let middle = 0.5 * (low + high);
    let pairs = values.windows(2);
    pairs.filter(|w| (w[0] < middle) != (w[1] < middle)).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::event::RigKind;
    use impact_records::record::Role;

    fn seen(name: &str, unit: Option<&str>) -> InferredChannel {
        InferredChannel {
            name: name.into(),
            label: None,
            unit: unit.map(str::to_owned),
            samples: 100,
            range: Some([-1.0, 1.0]),
            is_time: false,
            role: None,
            levels: None,
            closes_at: None,
            changes: 0,
            sign: 1,
            counted_in: None,
        }
    }

    #[test]
    fn roles_are_inferred_from_names_and_units() {
        let mut channels = vec![
            seen("ch1/generator", Some("V")),
            seen("ch2/vibrometer left", Some("V")),
            seen("ch3/vibrometer right", Some("V")),
            seen("ch4/contact", Some("V")),
            seen("acc y", Some("g")),
            seen("temperature", None),
        ];
        roles::assign(&mut channels);
        let roles: Vec<_> = channels.iter().map(|c| c.role).collect();
        assert_eq!(
            roles,
            [
                Some(Role::Drive),
                Some(Role::VelocityX),
                Some(Role::VelocityY),
                Some(Role::Contact),
                Some(Role::AccelerationY),
                None
            ]
        );
    }

    #[test]
    fn two_velocities_are_told_by_numbers_and_sides_in_their_names() {
        for names in [
            ["v1", "v2"],
            ["vel1_mps", "vel2_mps"],
            ["Masse links v", "Masse rechts v"],
            ["laser1", "laser2"],
        ] {
            let mut channels: Vec<_> = names.iter().map(|name| seen(name, None)).collect();
            channels.push(seen("force_N", None));
            roles::assign(&mut channels);
            let given: Vec<_> = channels.iter().map(|c| c.role).collect();
            let roles = [Role::VelocityX, Role::VelocityY, Role::Drive];
            assert_eq!(given, roles.map(Some), "{names:?}");
        }
        // of an oscilloscope
        let mut channels = vec![seen("V1", None), seen("V2", None)];
        roles::assign(&mut channels);
        assert!(channels.iter().all(|c| c.role.is_none()));
    }

    #[test]
    fn a_driven_rig_with_like_channels_without_a_role_is_asked_for_its_machine() {
        let named = |names: [&str; 3]| {
            let mut found = FolderContents {
                channels: names.iter().map(|name| seen(name, None)).collect(),
                ..FolderContents::default()
            };
            roles::assign(&mut found.channels);
            bodies::ask_of_driven(&mut found);
            (found.asks_machine, found.notes.join(" "))
        };
        let (asks, note) = named(["drive", "links", "rechts"]);
        assert!(
            asks && note.contains("no role is known for links, rechts"),
            "{note}"
        );
        assert_eq!(named(["drive", "v1", "v2"]), (false, String::new()));
        assert!(!named(["drive", "v1", "temp"]).0);
    }

    #[test]
    fn german_names_of_drive_contact_frame_and_motions_are_known() {
        let mut channels = vec![
            seen("Erreger", Some("V")),
            seen("Kontakt", Some("V")),
            seen("Rahmen", Some("mm/s")),
            seen("Gestell rechts y", Some("V")),
        ];
        roles::assign(&mut channels);
        let given: Vec<_> = channels.iter().map(|c| c.role).collect();
        let roles = [Role::Drive, Role::Contact, Role::FrameX, Role::FrameY];
        assert_eq!(given, roles.map(Some));
        let mut channels = vec![seen("Anregung in V", None)];
        roles::assign(&mut channels);
        assert_eq!(channels[0].role, Some(Role::Drive));
        let motions = ["Laser X", "Geschw. Y", "Weg X", "Weg Y"];
        let mut channels = vec![seen("Erreger", Some("V"))];
        channels.extend(motions.map(|name| seen(name, Some("V"))));
        roles::assign(&mut channels);
        let given: Vec<_> = channels.iter().skip(1).map(|c| c.role).collect();
        let roles = [
            Role::VelocityX,
            Role::VelocityY,
            Role::DisplacementX,
            Role::DisplacementY,
        ];
        assert_eq!(given, roles.map(Some));
    }

    #[test]
    fn like_named_groups_are_the_masses_and_their_forces_no_drive() {
        let mut channels: Vec<InferredChannel> = ["Blue", "Red"]
            .iter()
            .flat_map(|group| {
                [("Force", "N"), ("Position", "m"), ("Velocity", "m/s")]
                    .map(|(quantity, unit)| seen(&format!("{group} {quantity}"), Some(unit)))
            })
            .collect();
        roles::assign(&mut channels);
        let roles: Vec<_> = channels.iter().map(|c| c.role).collect();
        assert_eq!(
            roles,
            [
                None,
                Some(Role::DisplacementX),
                Some(Role::VelocityX),
                None,
                Some(Role::DisplacementY),
                Some(Role::VelocityY),
            ]
        );
        // The second cart of a run with one stands still.
        for channel in &mut channels[3..] {
            channel.range = Some([0.0, 0.0]);
        }
        channels.iter_mut().for_each(|c| c.role = None);
        roles::assign(&mut channels);
        assert!(channels[3..].iter().all(|c| c.role.is_none()));
    }

    #[test]
    fn a_list_of_changes_is_one_of_times() {
        let folder = tempfile::tempdir().unwrap();
        // bounces as a logic analyser lists them: the contact is closed for 2 ms
        let closings = (0..12).scan(0.5, |at, k| {
            let closed = *at;
            *at += 0.5 * 0.8f64.powi(k);
            Some(format!("{closed:.9},1\n{:.9},0\n", closed + 2e-3))
        });
        let list = format!(
            "Time [s],Channel 0\n0.000000000,0\n{}",
            closings.collect::<String>()
        );
        std::fs::write(folder.path().join("digital.csv"), list).unwrap();
        let found = inspect_folder(folder.path(), &labfiles::open);
        assert_eq!(
            found.experiment,
            Experiment::Events(impact_records::record::ContactContent::Times)
        );
        let role = |name: &str| found.channels.iter().find(|c| c.name == name).unwrap().role;
        assert_eq!(
            (role("Time"), role("Channel 0")),
            (Some(Role::Contact), None)
        );
        let text = super::super::template::campaign_toml("digital", &found);
        assert!(text.contains("channel = \"Time\""), "{text}");
        assert!(text.contains("content = \"times\""), "{text}");
    }

    #[test]
    fn a_list_of_changes_of_several_lines_is_one_of_times() {
        let folder = tempfile::tempdir().unwrap();
        // a contact on the second line, a slow clock on the third, the first idle
        let closings = (0..10).scan(0.5, |at, k| {
            let closed = *at;
            *at += 0.5 * 0.8f64.powi(k);
            Some([(closed, 1), (closed + 2e-3, 0)])
        });
        let mut rows: Vec<(f64, usize, i32)> = closings.flatten().map(|(t, s)| (t, 1, s)).collect();
        rows.extend((0..9).map(|k| (0.31 + 0.3 * f64::from(k), 2, k % 2)));
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut state = [0, 0, 1];
        let mut list = String::from("Time [s],Channel 0,Channel 1,Channel 2\n0.0,0,0,1\n");
        for (time, line, level) in rows {
            state[line] = level;
            list += &format!("{time:.9},{},{},{}\n", state[0], state[1], state[2]);
        }
        std::fs::write(folder.path().join("digital.csv"), list).unwrap();
        let found = inspect_folder(folder.path(), &labfiles::open);
        assert_eq!(
            found.experiment,
            Experiment::Events(impact_records::record::ContactContent::Times)
        );
        let time = found.channels.iter().find(|c| c.name == "Time").unwrap();
        assert_eq!(time.role, Some(Role::Contact));
    }

    #[test]
    fn a_decay_on_an_oscilloscope_is_ready_to_run() {
        let folder = tempfile::tempdir().unwrap();
        let row = |i: i32| {
            let t = f64::from(i) * 4e-4;
            let decay = (-0.02 * 75.4 * t).exp() * (75.4 * t).cos();
            format!("{i},{decay:.3e},\n")
        };
        let rows: String = (0..2500).map(row).collect();
        let heading = "X,CH1,Start,Increment,\nSequence,Volt,0.0e+00,4.0e-04\n";
        std::fs::write(folder.path().join("scope.csv"), format!("{heading}{rows}")).unwrap();
        let found = inspect_folder(folder.path(), &labfiles::open);
        assert_eq!(found.experiment, Experiment::FreeDecay);
        let text = super::super::template::campaign_toml("scope", &found);
        assert!(
            text.contains("[channels.velocity_x]\nchannel = \"CH1\""),
            "{text}"
        );
        assert!(text.contains("\nscale = \"1 m/s per V\""), "{text}");
        assert!(!text.contains("FILL IN: the files state none"), "{text}");
    }

    #[test]
    fn runs_side_by_side_are_all_counted() {
        let folder = tempfile::tempdir().unwrap();
        let row = |i: i32| {
            let y = (f64::from(i) * 0.2).sin();
            format!(
                "{:.2},{y:.4},{:.2},{y:.4}\n",
                f64::from(i) * 0.02,
                f64::from(i) * 0.02
            )
        };
        let rows: String = (0..60).map(row).collect();
        let text = format!("Time (s),Position (m),Time (s),Position (m)\n{rows}");
        std::fs::write(folder.path().join("throws.csv"), text).unwrap();
        let found = inspect_folder(folder.path(), &labfiles::open);
        assert_eq!((found.files, found.records), (1, 2));
        let position = found.channels.iter().find(|c| c.name == "Position");
        assert_eq!(position.unwrap().role, Some(Role::DisplacementX));
    }

    fn roles_of(names: &[(&str, &str, f64)]) -> Vec<Option<Role>> {
        let channel = |(name, unit, span): &(&str, &str, f64)| InferredChannel {
            range: Some([-*span, *span]),
            ..seen(name, Some(unit).filter(|u| !u.is_empty()).copied())
        };
        let mut channels: Vec<InferredChannel> = names.iter().map(channel).collect();
        roles::assign(&mut channels);
        channels.iter().map(|c| c.role).collect()
    }

    #[test]
    fn axes_of_a_phone_and_coordinates_of_a_point_are_one_mass() {
        let phone = ["x", "y", "z"].map(|axis| format!("Linear Acceleration {axis}"));
        let spans = [0.1, 5.0, 0.2];
        let named: Vec<(&str, &str, f64)> = phone
            .iter()
            .zip(spans)
            .map(|(n, s)| (n.as_str(), "m/s^2", s))
            .collect();
        assert_eq!(roles_of(&named), [None, Some(Role::AccelerationX), None]);
        let point = [("x", "m", 0.1), ("y", "m", 2.0)];
        assert_eq!(roles_of(&point), [None, Some(Role::DisplacementX)]);
        // a video with the velocities of its coordinates
        let video = [
            ("Video: X", "m", 0.1),
            ("Video: Y", "m", 2.0),
            ("Video: X Velocity", "m/s", 0.3),
            ("Video: Y Velocity", "m/s", 9.0),
        ];
        let of_y = [Role::DisplacementX, Role::VelocityX].map(Some);
        assert_eq!(roles_of(&video), [None, of_y[0], None, of_y[1]]);
        // two masses beside their drive, or two markers with three coordinates each
        let rig = [
            ("generator", "V", 1.0),
            ("x", "mm/s", 1.0),
            ("y", "mm/s", 1.0),
        ];
        assert_eq!(
            roles_of(&rig),
            [
                Some(Role::Drive),
                Some(Role::VelocityX),
                Some(Role::VelocityY)
            ]
        );
        let markers = [
            ("b X", "mm", 500.0),
            ("b Y", "mm", 1.0),
            ("b Z", "mm", 1.0),
            ("a X", "mm", 400.0),
            ("a Y", "mm", 1.0),
            ("a Z", "mm", 1.0),
        ];
        let roles = roles_of(&markers);
        assert_eq!(
            (roles[0], roles[3]),
            (Some(Role::DisplacementY), Some(Role::DisplacementX))
        );
        assert!(roles.iter().flatten().count() == 2, "{roles:?}");
    }

    #[test]
    fn carts_along_one_axis_are_two_masses_in_any_unit() {
        for [one, other] in [
            ["cart A x", "cart B x"],
            ["cart1_x", "cart2_x"],
            ["Rider 1 X", "Rider 2 X"],
            ["red X", "blue X"],
        ] {
            for unit in ["m", "px"] {
                let roles = roles_of(&[(one, unit, 0.5), (other, unit, 0.4)]);
                let both = [Role::DisplacementX, Role::DisplacementY].map(Some);
                assert_eq!(roles, both, "{one} {unit}");
            }
        }
        let one_mass = roles_of(&[("velocity x", "mm/s", 0.5), ("displacement x", "mm", 0.4)]);
        assert_eq!(one_mass, [Role::VelocityX, Role::DisplacementX].map(Some));
        // one marker beside the time alone is one mass
        assert_eq!(
            roles_of(&[("marker x", "m", 0.5)]),
            [Some(Role::DisplacementX)]
        );
    }

    #[test]
    fn axes_of_one_sensor_are_those_of_one_body() {
        let imu = [
            ("ax_g", "", 0.02),
            ("ay_g", "", 0.004),
            ("az_g", "", 0.003),
            ("gx_dps", "", 1.0),
            ("gy_dps", "", 57.0),
            ("gz_dps", "", 1.0),
        ];
        let mut expected = [None; 6];
        expected[4] = Some(Role::VelocityX);
        assert_eq!(roles_of(&imu), expected);
        assert_eq!(roles_of(&imu[..3]), [Some(Role::AccelerationX), None, None]);
    }

    #[test]
    fn a_list_of_flights_is_one_of_intervals() {
        for (heading, list, channel, content) in [
            (
                "Flugzeit (ms)",
                "685.4\n548.3\n438.6\n350.9\n280.7\n",
                "Flugzeit",
                "intervals",
            ),
            ("n,t (s)", "1,0.0\n2,0.6\n3,1.1\n4,1.5\n", "t", "times"),
        ] {
            let (_, text) = toml_of(&[("z.csv", format!("{heading}\n{list}"))]);
            assert!(text.contains(&format!("channel = \"{channel}\"")), "{text}");
            assert!(text.contains(&format!("content = \"{content}\"")), "{text}");
        }
    }

    /// A folder of records of a generator and an unnamed switch, closed in those of the numbers given.
    fn folder_of_switches(records: usize, closed: &[usize]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..records {
            let pulse = if closed.contains(&number) { 5.0 } else { 0.01 };
            let row = |i: i32| {
                let drive = (f64::from(i) * 0.1).sin();
                // noise of two codes of a converter
                let noise = if i % 7 < 3 { 0.002 } else { 0.0 };
                let level = if i % 50 < 3 { pulse } else { 0.01 };
                format!("{},{drive},{}\n", f64::from(i) * 1e-3, level + noise)
            };
            let rows: String = (0..500).map(row).collect();
            let text = format!("t [s],generator [V],closing contact [V]\n{rows}");
            std::fs::write(folder.path().join(format!("r{number:02}.csv")), text).unwrap();
        }
        folder
    }

    #[test]
    fn levels_of_a_contact_are_those_of_any_record_looked_at() {
        for (records, closed, looked_at, of_pulses) in [
            (3, &[2][..], 3, true),
            (30, &[15], 12, true),
            (3, &[], 3, false),
        ] {
            let folder = folder_of_switches(records, closed);
            let found = inspect_folder(folder.path(), &labfiles::open);
            assert_eq!(found.looked_at, looked_at);
            let contact = found
                .channels
                .iter()
                .find(|c| c.role == Some(Role::Contact));
            let [_, high] = contact.unwrap().levels.unwrap();
            assert_eq!(high > 4.0, of_pulses, "{records}: {high}");
        }
    }

    #[test]
    fn records_looked_at_are_spread_over_all() {
        let all: Vec<usize> = (0..30).collect();
        assert_eq!(spread(&all, 4), [0, 7, 15, 22]);
        assert_eq!(spread(&all[..3], 4), [0, 1, 2]);
        assert!(spread::<usize>(&[], 4).is_empty());
    }

    #[test]
    fn a_few_numbers_are_no_contact() {
        assert!(two_levels(&[0.0, 5.0, 0.0, 5.0]).is_none());
    }

    #[test]
    fn a_contact_has_two_levels_and_a_sine_has_not() {
        let contact: Vec<f64> = (0..500)
            .map(|i| if i % 50 < 3 { 5.0 } else { 0.01 })
            .collect();
        let sine: Vec<f64> = (0..500).map(|i| (f64::from(i) * 0.1).sin()).collect();
        assert!(two_levels(&contact).is_some());
        assert!(two_levels(&sine).is_none());
    }

    /// Rows of a decay at 500 Hz, a time and its values.
    fn decay_rows(frequency_hz: f64, damping: f64, count: i32) -> String {
        let row = |i: i32| {
            let t = f64::from(i) / 500.0;
            let w = std::f64::consts::TAU * frequency_hz;
            format!("{t:.4},{:.6}\n", (-damping * w * t).exp() * (w * t).cos())
        };
        (0..count).map(row).collect()
    }

    fn toml_of(files: &[(&str, String)]) -> (FolderContents, String) {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let found = inspect_folder(folder.path(), &labfiles::open);
        let text = super::super::template::campaign_toml("folder", &found);
        (found, text)
    }

    #[test]
    fn laboratory_books_and_sheets_of_settings_are_no_records() {
        let record = |k: i32| {
            format!(
                "t [s],v [m/s]\n{}",
                decay_rows(5.0 + f64::from(k), 0.02, 600)
            )
        };
        let rows: String = (0..40)
            .map(|k| format!("{k},{},1.0\n", 8.0 + f64::from(k)))
            .collect();
        let book = format!("run,frequency [Hz],gap [mm]\n{rows}");
        let clock = |k: i32| format!("{:02}:{:02}:00,{}\n", 8 + k / 60, k % 60, 8 + k);
        let clocks: String = (0..40).map(clock).collect();
        let files = [
            ("a book.csv", book),
            ("a day.csv", format!("time,frequency [Hz]\n{clocks}")),
            ("run01.csv", record(1)),
            ("run02.csv", record(2)),
        ];
        let (found, text) = toml_of(&files);
        assert_eq!((found.files, found.records), (2, 2));
        assert!(text.contains("files = \"run*.csv\""), "{text}");
        assert!(
            text.contains("notes or settings: a book.csv, a day.csv"),
            "{text}"
        );
        assert!(
            text.contains("[channels.velocity_x]\nchannel = \"v\""),
            "{text}"
        );
    }

    #[test]
    fn single_numbers_beside_signals_are_no_channels() {
        let matrix = |name: &str, column: usize| {
            let rows = decay_rows(5.0, 0.02, 600);
            let cells: String = rows
                .lines()
                .map(|l| format!(" {}\n", l.split(',').nth(column).unwrap()))
                .collect();
            format!("# name: {name}\n# type: matrix\n# rows: 600\n# columns: 1\n{cells}\n\n")
        };
        let scalar = "# name: gap_mm\n# type: scalar\n20\n\n\n";
        let text = format!(
            "# Created by Octave 8.4.0\n{scalar}{}{}",
            matrix("t", 0),
            matrix("vx", 1)
        );
        let (found, text) = toml_of(&[("run.txt", text)]);
        let gap = found.channels.iter().find(|c| c.name == "gap_mm");
        assert_eq!(gap.and_then(|c| c.role), None);
        assert!(text.contains("clearance = \"gap_mm\""), "{text}");
        assert!(
            text.contains("[channels.velocity_x]\nchannel = \"vx\""),
            "{text}"
        );
    }

    #[test]
    #[cfg(unix)]
    fn links_are_followed_once() {
        let store = tempfile::tempdir().unwrap();
        let text = format!("t [s],v [m/s]\n{}", decay_rows(5.0, 0.02, 600));
        std::fs::write(store.path().join("run.csv"), text).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let link = |to: &Path, name: &str| std::os::unix::fs::symlink(to, folder.path().join(name));
        link(&store.path().join("run.csv"), "first.csv").unwrap();
        link(store.path(), "store").unwrap();
        link(folder.path(), "itself").unwrap();
        let found = inspect_folder(folder.path(), &labfiles::open);
        assert_eq!(found.globs, ["*.csv", "store/*.csv"]);
        assert_eq!(found.files, 2);
    }

    #[test]
    fn angular_rates_have_their_unit_and_an_arm() {
        for (heading, unit) in [
            ("angular_velocity", "unit = \"rad/s\""),
            ("gyro_z", "unit = \"rad/s\""),
            ("omega (deg/s)", "# unit = as the file states"),
        ] {
            let text = format!("time (s),{heading}\n{}", decay_rows(2.4, 0.015, 1000));
            let (found, text) = toml_of(&[("wheel.csv", text)]);
            assert_eq!(found.experiment, Experiment::FreeDecay, "{heading}");
            let channel = heading.split(' ').next().unwrap();
            let table = format!("[channels.velocity_x]\nchannel = \"{channel}\"\n{unit}");
            assert!(text.contains(&table), "{text}");
            assert!(text.contains("\nscale = \"1 m/s per rad/s\""), "{text}");
        }
    }

    #[test]
    fn a_rate_that_nobody_states_does_not_count() {
        let values = |line: &str| format!("{}\n", line.split(',').nth(1).unwrap());
        let text: String = decay_rows(3.0, 0.02, 1500).lines().map(values).collect();
        let (_, text) = toml_of(&[("r.csv", format!("v (m/s)\n{text}"))]);
        assert!(
            text.contains("\n# sample_rate = \"2 kHz\"     # FILL IN"),
            "{text}"
        );
        let front = "NO_OF_FRAMES\t600\nFREQUENCY\t500\nANALOG_FREQUENCY\t0\nMARKER_NAMES\ta\n";
        let row = |line: &str| format!("{}\t1.5\t2.5\n", line.split(',').nth(1).unwrap());
        let rows: String = decay_rows(3.0, 0.02, 600).lines().map(row).collect();
        let (_, text) = toml_of(&[("r.tsv", format!("{front}{rows}"))]);
        assert!(!text.contains("drive_frequency = "), "{text}");
        assert!(text.contains("channel = \"a X\""), "{text}");
    }

    #[test]
    fn heavy_and_short_decays_are_decays() {
        for (damping, count) in [(0.35, 1500), (0.15, 1500), (0.004, 600)] {
            let text = format!("t (s),v (m/s)\n{}", decay_rows(3.0, damping, count));
            let (found, _) = toml_of(&[("r.csv", text)]);
            assert_eq!(found.experiment, Experiment::FreeDecay, "{damping}");
        }
    }

    /// Rows at 2 kHz of a driven mass that strikes a stop in each second period: a sine of a frequency, the motion, the contact.
    fn driven_rows(frequency_hz: f64) -> String {
        let row = |i: i32| {
            let t = f64::from(i) / 2000.0;
            let phase = std::f64::consts::TAU * frequency_hz * t;
            let motion = phase.sin() + 0.5 * (0.5 * phase).cos();
            let contact = if (0.5 * phase).sin() > 0.995 {
                4.8
            } else {
                0.0
            };
            format!("{t:.4},{:.5},{motion:.5},{contact:.2}\n", 1.5 * phase.cos())
        };
        (0..3000).map(row).collect()
    }

    #[test]
    fn records_that_have_other_channels_than_most_are_named() {
        let rows = driven_rows(8.0);
        let whole = format!("t (s),current (V),vibrometer (V),contact (V)\n{rows}");
        let bare = |row: &str| row.rsplit_once(',').map(|(kept, _)| format!("{kept}\n"));
        let fewer: String = whole.lines().filter_map(bare).collect();
        let [one, two] = ["b.csv", "c.csv"].map(|name| (name, whole.clone()));
        let (found, _) = toml_of(&[("a.csv", fewer), one, two]);
        assert_eq!(found.example, "b.csv");
        let note = found.notes.first().expect("a note");
        let start = "1 of 3 records have other channels than the others (without contact)";
        assert!(note.starts_with(start), "{note}");
    }

    #[test]
    fn a_pure_sine_beside_a_motion_of_its_frequency_is_the_drive() {
        let record = |k: i32| {
            let rows = driven_rows(9.0 + 0.5 * f64::from(k));
            format!("t (s),current (V),vibrometer (V),contact (V)\n{rows}")
        };
        let (_, text) = toml_of(&[("a.csv", record(0)), ("b.csv", record(1))]);
        assert!(
            text.contains("[channels.drive]\nchannel = \"current\""),
            "{text}"
        );
        assert!(text.contains("flight = \"harmonic\""), "{text}");
    }

    #[test]
    fn a_run_table_of_drive_frequencies_is_of_a_driven_rig() {
        // bounces of R = 0.8, as far as the record shows
        let (mut speed, mut began) = (4.0, 0.0);
        let mut row = |i: i32| {
            let t = f64::from(i) / 500.0;
            while t > began + 2.0 * speed / 9.81 {
                began += 2.0 * speed / 9.81;
                speed *= 0.8;
            }
            let flown = t - began;
            format!("{t:.3},{:.5}\n", speed * flown - 4.905 * flown * flown)
        };
        let rows: String = (0..1500).map(&mut row).collect();
        let record = format!("t (s),y (m)\n{rows}");
        let table = |heading: &str| format!("Datei;{heading}\na.csv;8,5\n");
        let flight_of = |heading: &str| {
            let files = [("a.csv", record.clone()), ("runs.csv", table(heading))];
            let (found, text) = toml_of(&files);
            assert!(text.contains("run_table = \"runs.csv\""), "{text}");
            found.experiment
        };
        assert_eq!(flight_of("Frequenz [Hz]"), Experiment::Driven);
        let of_gaps = flight_of("Spalt [mm]");
        assert!(matches!(of_gaps, Experiment::FreeFlight(_)), "{of_gaps:?}");
    }

    #[test]
    fn a_hammer_and_a_force_that_fades_are_no_drive() {
        let row = |i: i32, beside: &dyn Fn(f64, f64) -> f64| {
            let t = f64::from(i) / 500.0;
            let w = std::f64::consts::TAU * 5.0;
            let after = (t - 0.2).max(0.0);
            let motion = (-0.02 * w * after).exp() * (w * after).sin();
            format!("{t:.3},{motion:.5},{:.4}\n", beside(t, motion))
        };
        let hammer = |t: f64, _: f64| {
            if (t - 0.2).abs() < 5e-3 {
                3.0
            } else {
                0.01 * (7919.0 * t).sin()
            }
        };
        let load = |_: f64, motion: f64| 2500.0 + 900.0 * motion;
        let cases: [(&str, &dyn Fn(f64, f64) -> f64); 2] =
            [("hammer (V)", &hammer), ("\"Load, lbf\"", &load)];
        for (heading, beside) in cases {
            let rows: String = (0..2500).map(|i| row(i, beside)).collect();
            let (found, text) = toml_of(&[("r.csv", format!("t (s),v (m/s),{heading}\n{rows}"))]);
            assert_eq!(found.experiment, Experiment::FreeDecay, "{heading}");
            assert!(!text.contains("\n[channels.drive]"), "{text}");
        }
    }

    #[test]
    fn a_trigger_beside_a_decay_is_no_contact() {
        let rows: String = decay_rows(5.0, 0.02, 1500)
            .lines()
            .enumerate()
            .fold(String::new(), |rows, (i, line)| {
                format!("{rows}{line},{}\n", if i > 100 { 5.0 } else { 0.0 })
            });
        let text = format!("x-axis,1,2\nsecond,Volt,Volt\n{rows}");
        let (found, text) = toml_of(&[("scope.csv", text)]);
        assert_eq!(found.experiment, Experiment::FreeDecay);
        assert!(
            text.contains("[channels.velocity_x]\nchannel = \"1\""),
            "{text}"
        );
    }

    #[test]
    fn lists_of_times_are_ready_to_run_but_for_units_that_nobody_states() {
        let labels = "3.9504\t3.9504\tbounce 1\n4.5410\t4.5410\tbounce 2\n5.0400\t5.0400\tbounce 3\n\
                      5.4616\t5.4616\tbounce 4\n";
        let edges = "t_us,state\n5602888,CLOSED\n5604188,OPEN\n6076704,CLOSED\n6078028,OPEN\n6446580,CLOSED\n";
        let epoch = "Timestamp,Peak\n1684140000690,0.9\n1684140001163,0.8\n1684140001581,0.7\n1684140001952,0.6\n";
        let counts = "ticks\n1000\n5000\n8000\n10000\n";
        for (list, channel, unit) in [
            (labels, "column_1", "\nunit = \"s\""),
            (edges, "t_us", "\n# unit = as the file states"),
            (epoch, "Timestamp", "\nunit = \"ms\""),
            (counts, "ticks", "\n# unit = \"ms\"              # FILL IN"),
        ] {
            let (_, text) = toml_of(&[("list.txt", list.to_owned())]);
            let table = format!("[channels.contact]\nchannel = \"{channel}\"{unit}");
            assert!(text.contains(&table), "{text}");
            assert!(text.contains("\ncontent = \"times\""), "{text}");
            assert!(text.contains("flight = \"constant_force\""), "{text}");
        }
    }

    #[test]
    fn a_force_or_a_switch_alone_on_which_a_mass_bounces_is_a_contact() {
        let pulses = |height: f64| {
            let starts = [300, 800, 1200, 1520, 1776, 1981, 2145];
            let force = |i: i32| {
                let size = |(k, start): (usize, &i32)| {
                    let inside = (*start..start + 5).contains(&i);
                    if inside {
                        height * 0.8f64.powf(k as f64)
                    } else {
                        0.0
                    }
                };
                starts.iter().enumerate().map(size).sum::<f64>() + 0.01 * f64::from(i % 7)
            };
            let row = |i: i32| format!("{},{}\n", f64::from(i) * 1e-3, force(i));
            (0..2400).map(row).collect::<String>()
        };
        for (heading, height, threshold) in [
            ("Force (N)", 90.0, "threshold = \"1.8"),
            ("Fz (N)", -90.0, "threshold = \"-1."),
            ("Kontakt (V)", 5.0, "threshold = \"0.1"),
        ] {
            let file = format!("Time (s),{heading}\n{}", pulses(height));
            let (found, text) = toml_of(&[("drop.csv", file)]);
            assert_eq!(found.experiment, Experiment::FreeFlight(RigKind::Single));
            assert!(text.contains("flight = \"constant_force\""), "{text}");
            let table = text.split("[channels.contact]").nth(1).expect(heading);
            assert!(table.contains(threshold), "{table}");
        }
    }

    #[test]
    fn throws_side_by_side_in_a_list_are_records() {
        let rows = "1,0.1,0.2\n2,500.0,510.0\n3,900.0,930.0\n4,1220.0,\n";
        let text = format!("bounce no.,Throw 1 (ms),Throw 2 (ms)\n{rows}");
        let (found, text) = toml_of(&[("throws.csv", text)]);
        assert_eq!((found.files, found.records), (1, 2));
        assert!(
            text.contains("[channels.contact]\nchannel = \"time\""),
            "{text}"
        );
    }

    #[test]
    fn names_are_those_without_the_run_and_two_sensors_are_two_masses() {
        let record = |run: usize| {
            let row = |i: i32| {
                let t = f64::from(i) * 0.02;
                let far = (t - 1.0).max(0.0);
                format!(
                    "{t:.2},{:.4},{:.4}\n",
                    0.3 + 0.5 * t - 0.7 * far,
                    0.9 - 0.6 * far
                )
            };
            let rows: String = (0..110).map(row).collect();
            let heads = ["Time (s)", "Position - Ch 1 (m)", "Position - Ch 2 (m)"];
            format!(
                "{}\n{rows}",
                heads.map(|head| format!("{head} Run #{run}")).join(",")
            )
        };
        let (_, text) = toml_of(&[("run1.csv", record(1)), ("run2.csv", record(2))]);
        assert!(text.contains("machine = \"double\""), "{text}");
        for (role, name) in [("x", "Position - Ch 1"), ("y", "Position - Ch 2")] {
            let table = format!("[channels.displacement_{role}]\nchannel = \"{name}\"");
            assert!(text.contains(&table), "{text}");
        }
    }

    #[test]
    fn two_markers_of_any_names_are_two_masses() {
        let markers = [
            "riderA X", "riderA Y", "riderA Z", "riderB X", "riderB Y", "riderB Z",
        ];
        let spans = [800.0, 1.0, 1.0, 600.0, 1.0, 1.0];
        let named: Vec<(&str, &str, f64)> = markers
            .into_iter()
            .zip(spans)
            .map(|(n, s)| (n, "mm", s))
            .collect();
        let mut expected = [None; 6];
        expected[0] = Some(Role::DisplacementX);
        expected[3] = Some(Role::DisplacementY);
        assert_eq!(roles_of(&named), expected);
        // sensors of two quantities are on one body
        let phone = ["accX", "accY", "accZ", "gyroX", "gyroY", "gyroZ"];
        let units = ["m/s^2", "rad/s"].map(|unit| [unit; 3]).concat();
        let named: Vec<_> = phone
            .into_iter()
            .zip(units)
            .map(|(n, u)| (n, u, 1.0))
            .collect();
        let roles = roles_of(&named);
        assert!(roles.iter().flatten().all(|r| !r.is_of_y()), "{roles:?}");
    }

    /// A cart of 0.5 kg that strikes one of 0.8 kg at rest with R = 0.7, from their momentum, under two headings.
    fn collision(heads: &str, speed: f64, sign: f64) -> String {
        let (at, after_a) = (0.6 / speed, speed * (0.5 - 0.8 * 0.7) / 1.3);
        let after_b = after_a + 0.7 * speed;
        let row = |i: i32| {
            let t = f64::from(i) * 0.02;
            let (flown, since) = (t.min(at), (t - at).max(0.0));
            // the last digit of a motion detector
            let read = |v: f64| (v * 1e3 + 0.4 * f64::sin(f64::from(i * i))).round() / 1e3;
            let a = read(0.2 + speed * flown + after_a * since);
            let b = read(sign * (0.8 + after_b * since));
            format!("{t:.2},{a:.3},{b:.3}\n")
        };
        let rows: String = (0..140).map(row).collect();
        format!("Time (s),{heads}\n{rows}")
    }

    #[test]
    fn valid_two_bodies_that_strike_each_other_are_two_masses_whatever_they_are_called() {
        let double = Experiment::FreeFlight(RigKind::Double);
        for heads in [
            "Position 3 (m),Position 4 (m)",
            "front (m),rear (m)",
            "Cart (m),Glider (m)",
            "positionA,positionB",
            "ultrasonic one (m),ultrasonic two (m)",
        ] {
            for sign in [1.0, -1.0] {
                let record = |speed| collision(heads, speed, sign);
                let (found, text) = toml_of(&[("a.csv", record(0.5)), ("b.csv", record(0.7))]);
                assert_eq!(found.experiment, double, "{heads} {sign}: {text}");
                assert!(text.contains("machine = \"double\""), "{text}");
            }
        }
    }

    #[test]
    fn a_channel_that_moves_beside_a_mass_is_asked_for_unless_it_shows_the_same() {
        let asks = |rows: &[(&str, String)]| {
            let (found, text) = toml_of(rows);
            let asked = text.contains("# FILL IN, see the note below: machine");
            assert_eq!(found.asks_machine, asked, "{text}");
            (asked, found.notes.join("; "), text)
        };
        // a ball of R = 0.8 and what is measured beside it
        let ball = |heads: &str, other: &dyn Fn(f64, f64) -> f64| {
            let mut at = 0.0;
            let (mut height, mut speed) = (1.0, 0.0);
            let mut rows = String::new();
            for _ in 0..400 {
                rows += &format!("{at:.3},{height:.4},{:.4}\n", other(at, height));
                (at, height, speed) = (at + 0.005, height + 0.005 * speed, speed - 0.005 * 9.81);
                if height <= 0.0 && speed < 0.0 {
                    (height, speed) = (0.0, -0.8 * speed);
                }
            }
            vec![("ball.csv", format!("Time (s),{heads}\n{rows}"))]
        };
        let (asked, note, text) = asks(&ball("Height (m),String (m)", &|t, _| {
            0.3 * (2.0 * t).sin()
        }));
        assert!(
            asked && note.starts_with("String moves too"),
            "{note} {text}"
        );
        let (asked, _, text) = asks(&ball("Height (m),Laser (cm)", &|_, h| 100.0 * h));
        assert!(!asked, "{text}");
        let (asked, note, text) = asks(&ball("Height (m),Horizontal (m)", &|t, _| 0.2 * t));
        assert!(
            !asked && note.contains("other coordinates"),
            "{note} {text}"
        );
    }

    #[test]
    fn pendulums_that_strike_each_other_are_no_free_decay() {
        // two of equal mass and R = 0.9, released from one side; x and y are positive toward the other mass
        let (step, w) = (1e-3, std::f64::consts::TAU);
        let mut at = [-0.1, 0.0, 0.0, 0.0];
        let mut rows = String::new();
        for i in 0..6000 {
            let [x, y, u, v] = at;
            if i % 2 == 0 {
                rows += &format!("{:.3},{x:.6},{y:.6},{u:.5},{v:.5}\n", f64::from(i) * step);
            }
            let (u, v) = (u - step * w * w * x, v - step * w * w * y);
            let (x, y) = (x + step * u, y + step * v);
            let (mean, half) = (0.5 * (u - v), 0.45 * (u + v));
            let strikes = x + y >= 0.0 && half > 0.0;
            let after = if strikes {
                [mean - half, -mean - half]
            } else {
                [u, v]
            };
            at = [x, y, after[0], after[1]];
        }
        let heads = "t (s),pos left (m),pos right (m),vel left (m/s),vel right (m/s)";
        let (found, text) = toml_of(&[("cradle.csv", format!("{heads}\n{rows}"))]);
        let flights = Experiment::FreeFlight(RigKind::Double);
        assert_eq!(found.experiment, flights, "{text}");
    }

    #[test]
    fn one_coordinate_that_is_called_y_is_that_of_one_mass() {
        assert_eq!(roles_of(&[("y", "m", 1.0)]), [Some(Role::DisplacementX)]);
        assert_eq!(
            roles_of(&[("ax", "m/s^2", 0.1), ("ay", "m/s^2", 9.0)]),
            [None, Some(Role::AccelerationX)]
        );
        assert_eq!(
            roles_of(&[("x", "", 1.0), ("y", "px", 800.0)]),
            [None, Some(Role::DisplacementX)]
        );
        for [x, y] in [["vx", "vy"], ["v x", "v y"], ["Laser x", "v_y"]] {
            let unit = if x == "vx" { "m/s" } else { "V" };
            assert_eq!(
                roles_of(&[(x, unit, 0.5), (y, unit, 0.4)]),
                [Some(Role::VelocityX), Some(Role::VelocityY)],
                "{x} {y}"
            );
        }
    }

    #[test]
    fn a_table_whose_cells_are_names_of_files_is_the_run_table_and_others_are_named() {
        let record = |k: i32| format!("t (s),v (m/s)\n{}", decay_rows(f64::from(5 + k), 0.02, 600));
        for heading in ["Durchlauf", "Messung", "File"] {
            let table = format!("{heading};f [Hz];Luftspalt [mm]\na.csv;8,5;2\nb.csv;9;2\n");
            let files = [
                ("a.csv", record(0)),
                ("b.csv", record(1)),
                ("labbook.csv", "record,gap\n1,2\n2,3\n".to_owned()),
                ("z runs.csv", table),
            ];
            let (found, text) = toml_of(&files);
            assert_eq!(found.run_table.as_deref(), Some("z runs.csv"), "{heading}");
            assert!(found.states_drive, "{heading}");
            assert!(text.contains("notes or settings: labbook.csv\n"), "{text}");
        }
    }
}
