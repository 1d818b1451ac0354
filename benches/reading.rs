//! How fast records are read, on one thread from the page cache, in MB/s of samples (eight bytes
//! each): 200 records of 16 channels and 2,000 samples.
//!
//! `cargo bench --bench reading` measures the formats that this program writes;
//! `cargo bench --bench reading -- DIR` measures every file in DIR, which `benches/reading.py DIR`
//! makes and reads with the field's Python readers, too.

use std::path::{Path, PathBuf};
use std::time::Instant;

use labfiles::Samples;
use labfiles::open;
use labfiles_write::convert::{Options, Target, convert};
use labfiles_write::hdf5::{CampaignWriter, ColumnToWrite, RecordTable};

const RECORDS: usize = 200;
const CHANNELS: usize = 16;
const SAMPLES: usize = 2000;
const REPETITIONS: usize = 5;

fn main() {
    // `cargo bench` passes --bench; under `cargo test` nothing is measured
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    let named = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let own = tempfile::tempdir();
    let folder = match (&named, &own) {
        (Some(folder), _) => PathBuf::from(folder),
        (None, Ok(own)) => {
            if let Err(error) = make(own.path()) {
                println!("the files cannot be made: {error}");
                return;
            }
            own.path().to_path_buf()
        }
        (None, Err(error)) => {
            println!("no temporary folder: {error}");
            return;
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let Ok(pool) = pool else { return };
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("{} cannot be read", folder.display());
        return;
    };
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        match pool.install(|| best(&path).map_err(|e| e.to_string())) {
            Ok((bytes, seconds)) => println!(
                "{:32} {:8.0} MB/s",
                path.file_name().unwrap_or_default().to_string_lossy(),
                bytes as f64 / seconds / 1e6
            ),
            Err(error) => println!("{}: {error}", path.display()),
        }
    }
}

/// Bytes of samples in a file, or in all files of a folder, and the shortest time to read them.
fn best(path: &Path) -> Result<(usize, f64), Box<dyn std::error::Error>> {
    let mut shortest = f64::INFINITY;
    let mut bytes = 0;
    // A program keeps something of what it read, so that its memory is not handed back to the
    // system after every file and taken again, page by page, for the next.
    let mut kept = Vec::new();
    for _ in 0..=REPETITIONS {
        let begin = Instant::now();
        bytes = 8 * if path.is_dir() {
            let mut samples = 0;
            for entry in std::fs::read_dir(path)? {
                samples += read(&entry?.path(), &mut kept)?;
            }
            samples
        } else {
            read(path, &mut kept)?
        };
        shortest = shortest.min(begin.elapsed().as_secs_f64());
    }
    Ok((bytes, shortest))
}

/// Read all of a file, of which the last channel is kept; how many samples it holds.
fn read(path: &Path, kept: &mut Vec<Samples>) -> Result<usize, Box<dyn std::error::Error>> {
    let source = open(path)?;
    let mut samples = 0;
    for (dataset, info) in source.datasets().iter().enumerate() {
        let all: Vec<usize> = (0..info.channels.len()).collect();
        let mut read = source.read(dataset, &all)?;
        samples += read.iter().map(Samples::len).sum::<usize>();
        if dataset + 1 == source.datasets().len() {
            kept.extend(read.pop());
        }
    }
    Ok(samples)
}

/// A sample of a channel that does not pack away to nothing.
fn value(record: usize, channel: usize, sample: usize) -> f64 {
    let noise = (record * 7919 + channel * 104_729 + sample * 1_299_709) % 65_537;
    (0.01 * (sample + channel) as f64).sin() + 1e-3 * noise as f64 / 65_537.0
}

/// The campaign in the formats that this program writes.
fn make(folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let packed = folder.join("gzip_shuffle.h5");
    let mut writer = CampaignWriter::create(&packed);
    for record in 0..RECORDS {
        let channels = (0..CHANNELS).map(|channel| {
            let values = (0..SAMPLES).map(|i| value(record, channel, i)).collect();
            ColumnToWrite::numbers(format!("c{channel}"), "V", values)
        });
        writer.add(RecordTable {
            name: format!("r{record:03}"),
            sample_rate_hz: Some(2000.0),
            channels: channels.collect(),
            attributes: Vec::new(),
        })?;
    }
    writer.finish()?;
    let sources = [open(&packed)?];
    let options = Options::default();
    convert(
        &sources,
        Target::Parquet,
        &folder.join("long.parquet"),
        &options,
    )?;
    convert(&sources, Target::Csv, &folder.join("csv.csv"), &options)?;
    Ok(())
}
