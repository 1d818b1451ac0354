//! What the tests of the file readers share: goldens of the conformance files, statistics of
//! what was read, a mutator of bytes, and a count of the memory a reader takes.
//!
//! The conformance files are not part of the repository: tests named `shared_data_…` read them from
//! `../shared/data` and are ignored unless asked for (`cargo test -p labfiles -- --ignored shared_data`).

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::source::{ReadError, Samples, Source};

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

/// Passes on to the system's allocator and counts what each thread holds.
struct Counting;

fn count(change: isize) {
    let _ = HELD.try_with(|held| {
        held.set(held.get() + change);
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(held.get())));
    });
}

// SAFETY: every call is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Run `work` and give the most bytes this thread held beyond what it held before.
pub(crate) fn peak_bytes<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.with(Cell::get);
    PEAK.with(|peak| peak.set(before));
    let result = work();
    (result, (PEAK.with(Cell::get) - before).max(0) as usize)
}

/// A file of the repository's own folder of formats.
pub(crate) fn own(name: &str) -> PathBuf {
    own_folder("formats").join(name)
}

pub(crate) fn own_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// The sine that the repository's own files hold, at a sample.
pub(crate) fn wave(i: usize) -> f64 {
    (std::f64::consts::TAU * 12.6 * i as f64 / 2000.0).sin()
}

/// The samples of a channel by its name.
#[track_caller]
pub(crate) fn named(source: &dyn Source, dataset: usize, name: &str) -> Samples {
    let channel = source.datasets()[dataset]
        .channel_index(name)
        .unwrap_or_else(|| panic!("no {name}"));
    source.read(dataset, &[channel]).unwrap().remove(0)
}

/// The real numbers of a channel by its name.
#[track_caller]
pub(crate) fn real(source: &dyn Source, dataset: usize, name: &str) -> Vec<f64> {
    named(source, dataset, name).into_real().unwrap()
}

/// A folder of the laboratories' data.
pub(crate) fn shared_data(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data")
        .join(name);
    assert!(path.is_dir(), "{} is absent", path.display());
    path
}

/// The goldens of a conformance folder: file name and what the reference reader gives.
pub(crate) fn goldens(name: &str) -> Vec<(PathBuf, Value)> {
    let folder = shared_data(name);
    let text = std::fs::read_to_string(folder.join("golden.json")).unwrap();
    let all: Map<String, Value> = serde_json::from_str(&text).unwrap();
    let path = |key: &str| folder.join(key.rsplit_once('/').map_or(key, |(_, file)| file));
    all.into_iter()
        .map(|(key, value)| (path(&key), value))
        .collect()
}

/// Statistics of numbers, as the goldens state them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Statistics {
    /// How many.
    pub n: usize,
    /// The first.
    pub first: f64,
    /// The last.
    pub last: f64,
    /// Their sum.
    pub sum: f64,
    /// Sum of their magnitudes: the scale of the sum's rounding.
    pub scale: f64,
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
}

impl Statistics {
    /// Statistics of numbers.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut all = Self {
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            ..Self::default()
        };
        for value in values {
            if all.n == 0 {
                all.first = value;
            }
            all.n += 1;
            all.last = value;
            all.sum += value;
            all.scale += value.abs();
            all.min = all.min.min(value);
            all.max = all.max.max(value);
        }
        all
    }

    /// Check against a golden whose numbers are real; `part` picks one of a complex pair.
    #[track_caller]
    pub(crate) fn check(&self, golden: &Value, part: Option<usize>, what: &str) {
        let number = |key: &str| match (&golden[key], part) {
            (Value::Array(pair), Some(part)) => pair[part].as_f64().unwrap(),
            (value, _) => value.as_f64().unwrap_or_else(|| panic!("{what}: no {key}")),
        };
        assert_eq!(self.n as f64, golden["n"].as_f64().unwrap(), "{what}: n");
        assert_eq!(self.first, number("first"), "{what}: first");
        assert_eq!(self.last, number("last"), "{what}: last");
        let tolerance = 1e-13 * self.scale;
        let sum = number("sum");
        assert!(
            (self.sum - sum).abs() <= tolerance,
            "{what}: sum {} for {sum}",
            self.sum
        );
        if part.unwrap_or(0) == 0 {
            // Goldens of complex numbers state least and greatest real part.
            let (min, max) = (
                golden["min"].as_f64().unwrap(),
                golden["max"].as_f64().unwrap(),
            );
            assert_eq!(
                (self.min, self.max),
                (min, max),
                "{what}: least and greatest"
            );
        }
    }
}

/// All samples of a dataset, after checking that each channel has the length it states.
pub(crate) fn read_all(source: &dyn Source, dataset: usize) -> Result<Vec<Samples>, ReadError> {
    let infos = &source.datasets()[dataset].channels;
    let all: Vec<usize> = (0..infos.len()).collect();
    let samples = source.read(dataset, &all)?;
    assert_eq!(samples.len(), infos.len());
    for (samples, info) in samples.iter().zip(infos) {
        assert_eq!(
            samples.len() as u64,
            info.samples,
            "{}: {}",
            source.path().display(),
            info.name
        );
    }
    Ok(samples)
}

/// A small reproducible generator of numbers (splitmix64).
#[derive(Debug, Clone)]
pub(crate) struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `limit` (0 where the limit is 0).
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.bits() % (limit.max(1) as u64)) as usize
    }
}

const EXTREMES: [u64; 14] = [
    0,
    1,
    2,
    7,
    8,
    255,
    0x7fff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    1_000_000_000_000,
    i64::MAX as u64,
    u64::MAX,
];

/// Change bytes at random: bits, extreme numbers of any width and order, blocks moved, doubled
/// or cut. Headers are changed more often than samples.
pub(crate) fn mutate(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..=random.below(3) {
        let len = bytes.len();
        if len == 0 {
            bytes.push(random.bits() as u8);
        }
        let reach = if random.below(2) == 0 {
            len.min(512)
        } else {
            len
        };
        let at = random.below(reach);
        match random.below(9) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.bits() as u8,
            2 | 3 => put_extreme(random, bytes, at),
            4 => bytes.truncate(at),
            5 => drop(bytes.drain(at..(at + random.below(64)).min(len))),
            6 => {
                let block = bytes[at..(at + random.below(64)).min(len)].to_vec();
                let to = random.below(len);
                bytes.splice(to..to, block);
            }
            7 => bytes[at] = bytes[at].wrapping_add(1),
            _ => {
                let other = random.below(len);
                bytes.swap(at, other);
            }
        }
    }
}

/// Write an extreme number of any width and order at an offset.
pub(crate) fn put_extreme(random: &mut Random, bytes: &mut [u8], at: usize) {
    let value = match random.below(3) {
        0 => (bytes.len() as u64)
            .wrapping_add(random.below(17) as u64)
            .wrapping_sub(8),
        _ => EXTREMES[random.below(EXTREMES.len())],
    };
    let width = [1, 2, 4, 8][random.below(4)];
    let mut word = value.to_le_bytes()[..width].to_vec();
    if random.below(2) == 0 {
        word.reverse();
    }
    for (byte, new) in bytes[at..].iter_mut().zip(word) {
        *byte = new;
    }
}

/// Change a text at random: as [`mutate`] does, or lines doubled, dropped, swapped or joined,
/// and cells replaced by what instruments print when things go wrong.
pub(crate) fn mutate_text(random: &mut Random, bytes: &mut Vec<u8>) {
    const CELLS: [&str; 16] = [
        "",
        "NaN",
        "-",
        "1e999",
        "-1e-999",
        "1e12",
        "0x1F",
        "1,5",
        "1.5.2024",
        "25:61:61",
        "\"",
        "***End_of_Header***",
        "X_Columns",
        "Samples\t1000000000000",
        "\u{fffd}",
        "1e+",
    ];
    if random.below(3) == 0 {
        return mutate(random, bytes);
    }
    let mut lines: Vec<Vec<u8>> = bytes.split(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
    for _ in 0..=random.below(3) {
        let (at, other) = (random.below(lines.len()), random.below(lines.len()));
        match random.below(5) {
            0 => lines.swap(at, other),
            1 => lines.insert(at, lines[other].clone()),
            2 if lines.len() > 1 => drop(lines.remove(at)),
            _ => {
                let line = &mut lines[at];
                let marks: Vec<usize> = (0..line.len())
                    .filter(|&i| b"\t,; ".contains(&line[i]))
                    .collect();
                let from = if marks.is_empty() {
                    0
                } else {
                    marks[random.below(marks.len())] + 1
                };
                let to = marks
                    .iter()
                    .copied()
                    .find(|&m| m >= from)
                    .unwrap_or(line.len());
                line.splice(from..to, CELLS[random.below(CELLS.len())].bytes());
            }
        }
    }
    *bytes = lines.join(&b'\n');
}

/// The goldens, and the other files of formats of the repository.
pub(crate) fn own_files() -> impl Iterator<Item = PathBuf> {
    let folders = ["formats", "goldens"].into_iter();
    folders.flat_map(|folder| files(&own_folder(folder)))
}

/// Files of the repository's own folders with this ending, as seeds of mutations.
pub(crate) fn own_seeds(ending: &str) -> Vec<Vec<u8>> {
    let fits = |p: &PathBuf| p.extension().is_some_and(|e| e == ending);
    let fitting = own_files().filter(fits);
    fitting.map(|p| std::fs::read(p).unwrap()).collect()
}

/// The files of a folder in order of their names.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Number of mutations per reader: `IMPACTID_MUTATIONS`, else few so that the suite stays quick.
pub(crate) fn mutations() -> usize {
    std::env::var("IMPACTID_MUTATIONS")
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(2000)
}

/// Conformance files of at most `largest` bytes, as seeds of mutations.
pub(crate) fn shared_seeds(folder_name: &str, largest: u64) -> Vec<Vec<u8>> {
    let small = |path: &PathBuf| path.metadata().is_ok_and(|m| m.len() <= largest);
    let paths = files(&shared_data(folder_name)).into_iter().filter(small);
    paths.map(|p| std::fs::read(p).unwrap()).collect()
}

/// Open mutated files and read all they hold: no panic, no run over ten seconds, no memory
/// beyond `factor` times the file plus 1 MiB.
pub(crate) fn survive(
    seeds: &[Vec<u8>],
    open: fn(&Path) -> Result<Box<dyn Source>, ReadError>,
    change: impl Fn(&mut Random, &mut Vec<u8>),
    factor: usize,
) {
    survive_within(seeds, open, change, [factor, 1 << 20]);
}

/// As [`survive`], with memory of a factor times the file plus a number of bytes.
pub(crate) fn survive_within(
    seeds: &[Vec<u8>],
    open: fn(&Path) -> Result<Box<dyn Source>, ReadError>,
    change: impl Fn(&mut Random, &mut Vec<u8>),
    [factor, slack]: [usize; 2],
) {
    assert!(!seeds.is_empty());
    let temp = tempfile::NamedTempFile::new().unwrap();
    let (mut opened, mut refused) = (0, 0);
    for case in 0..mutations() {
        let mut random = Random(case as u64);
        let mut bytes = seeds[random.below(seeds.len())].clone();
        change(&mut random, &mut bytes);
        std::fs::write(temp.path(), &bytes).unwrap();
        let begin = Instant::now();
        let (result, peak) =
            peak_bytes(|| catch_unwind(AssertUnwindSafe(|| read_whole(temp.path(), open))));
        let keep = || std::fs::copy(temp.path(), std::env::temp_dir().join("mutation.failed"));
        let Ok(read) = result else {
            keep().unwrap();
            panic!(
                "case {case} panics; its file is {}/mutation.failed",
                std::env::temp_dir().display()
            );
        };
        if begin.elapsed() > Duration::from_secs(10) || peak > factor * bytes.len() + slack {
            keep().unwrap();
            panic!(
                "case {case}: {:?}, {peak} bytes of memory for {} of file",
                begin.elapsed(),
                bytes.len()
            );
        }
        if read { opened += 1 } else { refused += 1 }
    }
    println!("{opened} mutations read, {refused} refused");
    assert!(
        opened > 0 && refused > 0,
        "{opened} read, {refused} refused: the mutations test nothing"
    );
}

fn read_whole(path: &Path, open: fn(&Path) -> Result<Box<dyn Source>, ReadError>) -> bool {
    let Ok(source) = open(path) else { return false };
    (0..source.datasets().len()).all(|dataset| read_all(source.as_ref(), dataset).is_ok())
}
