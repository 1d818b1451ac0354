//! `impactid atlas`: regions of all motions in the (η, ρ) plane, their boundaries as curves, and
//! the brute-force map beside them; parts of a map for many machines, and their merge.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::machine::{MachineArgs, range, refused};
use super::{Exit, Failure, Voice};
use crate::atlas::map::{CellMotion, MapGrid, MapSettings, RegionMap};
use crate::atlas::regions::{Atlas as Regions, AtlasSettings, atlas};
use crate::atlas::shard::{MapPart, MapRequest, merge, part};
use crate::motion::Motion;
use crate::output::{OutputError, write_bytes};

/// Arguments of `impactid atlas`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Atlas {
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratios η
    #[arg(long, value_name = "LOW..HIGH", default_value = "0.3..5", value_parser = range)]
    eta: (f64, f64),
    /// Clearances ρ
    #[arg(long, value_name = "LOW..HIGH", default_value = "-1.2..8", value_parser = range,
          allow_hyphen_values = true)]
    rho: (f64, f64),
    /// Columns (η) of the grid
    #[arg(long, value_name = "N", default_value_t = 200)]
    columns: usize,
    /// Rows (ρ) of the grid
    #[arg(long, value_name = "N", default_value_t = 120)]
    rows: usize,
    /// Most impacts p in a period of the motion
    #[arg(long, value_name = "P", default_value_t = 4)]
    largest_p: u32,
    /// Most drive periods n in a period of the motion
    #[arg(long, value_name = "N", default_value_t = 6)]
    largest_n: u32,
    /// Compute only part I of N of the map alone, I from 0
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<(usize, usize)>,
    /// Put parts of a map together
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with = "shard")]
    merge: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

const EXAMPLE: &str = "\
Example:
  impactid atlas --restitution 0.9 --damping-ratio 0.07 --out atlas/
  impactid atlas --columns 2000 --rows 1500 --shard 3/16 --out parts/
  impactid atlas --merge parts/*.json --out atlas/

It writes curves.csv, map.csv and atlas.json; with --shard part-I-of-N.json.";

fn shard(text: &str) -> Result<(usize, usize), String> {
    let wrong = || format!("“{text}” is no part: write I/N with I from 0 to N−1, such as 3/16");
    let (number, of) = text.split_once('/').ok_or_else(wrong)?;
    match (number.trim().parse(), of.trim().parse()) {
        (Ok(number), Ok(of)) if number < of => Ok((number, of)),
        _ => Err(wrong()),
    }
}

impl Atlas {
    /// Compute and write.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range, parts do not fit, or a file cannot be
    /// written.
    pub fn go(self, voice: Voice) -> Result<Exit, Failure> {
        fs::create_dir_all(&self.out).map_err(|e| Failure::io(&self.out, &e))?;
        if !self.merge.is_empty() {
            return self.put_together(voice);
        }
        let machine = self.machine.machine()?;
        let (eta, rho) = (self.eta, self.rho);
        let grid = MapGrid::even((eta.0, eta.1, self.columns), (rho.0, rho.1, self.rows));
        if let Some((number, of)) = self.shard {
            let request = MapRequest::new(machine, grid, MapSettings::default());
            let part = part(&request, number, of).map_err(|e| refused(&e))?;
            let name = format!("part-{number}-of-{of}.json");
            return write(
                &self.out,
                &name,
                &serde_json::to_vec(&part).unwrap_or_default(),
            );
        }
        let settings = AtlasSettings {
            grid,
            largest_p: self.largest_p,
            largest_n: self.largest_n,
            map: MapSettings::default(),
        };
        let regions = atlas(&machine, &settings).map_err(|e| refused(&e))?;
        say(voice, &regions);
        write(&self.out, "curves.csv", curves_csv(&regions).as_bytes())?;
        write(
            &self.out,
            "map.csv",
            maps_csv(&settings.grid, &regions).as_bytes(),
        )?;
        let summary = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "machine": machine,
            "settings": settings,
            "agreement": regions.agreement,
        });
        write(&self.out, "atlas.json", format!("{summary:#}\n").as_bytes())
    }

    fn put_together(&self, voice: Voice) -> Result<Exit, Failure> {
        let parts: Vec<MapPart> = self
            .merge
            .iter()
            .map(|path| read_part(path))
            .collect::<Result<_, _>>()?;
        let map = merge(&parts).map_err(|e| {
            Failure::new(
                e.to_string(),
                "give every part of one map once, all of one --shard …/N",
            )
        })?;
        voice.say(&format!(
            "{} parts make {} cells",
            parts.len(),
            map.cells.len()
        ));
        write(&self.out, "map.csv", map_csv(&map).as_bytes())
    }
}

fn read_part(path: &Path) -> Result<MapPart, Failure> {
    let bytes = fs::read(path).map_err(|e| Failure::io(path, &e))?;
    serde_json::from_slice(&bytes).map_err(|e| {
        Failure::new(
            format!("{}: no part of a map: {e}", path.display()),
            "give files that `impactid atlas --shard I/N` wrote",
        )
    })
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<Exit, Failure> {
    let told = |e: OutputError| Failure::new(e.to_string(), e.remedy());
    write_bytes(&folder.join(name), bytes).map_err(told)?;
    Ok(Exit::Done)
}

/// How curves and maps agree, as every run prints it.
fn say(voice: Voice, regions: &Regions) {
    let a = &regions.agreement;
    voice.say(&format!(
        "{} curves; brute force: {} cells compared, {} differ from the curves, {} aperiodic, {} \
         beyond the largest p or n",
        regions.curves.len(),
        a.compared,
        a.differing.len(),
        a.aperiodic,
        a.beyond
    ));
    for (eta, rho, motion) in a.differing.iter().take(20) {
        voice.say(&format!(
            "  η = {eta:.4}  ρ = {rho:.4}  z = {}",
            label(*motion)
        ));
    }
}

fn label(motion: CellMotion) -> String {
    Motion::from(motion).label()
}

fn curves_csv(regions: &Regions) -> String {
    let mut text = String::from("curve,kind,motion,side,eta,rho,closing_speed\n");
    for (number, c) in regions.curves.iter().enumerate() {
        let j = if c.dead_zone { "j" } else { "" };
        let side = if c.upper { "upper" } else { "lower" };
        for p in &c.points {
            let _ = writeln!(
                text,
                "{number},{},{}/{}{j},{side},{},{},{}",
                c.kind, c.p, c.n, p.eta, p.rho, p.closing_speed
            );
        }
    }
    text
}

fn maps_csv(grid: &MapGrid, regions: &Regions) -> String {
    let mut text = String::from("eta,rho,from_start,rising,falling\n");
    for i in 0..grid.len() {
        let (eta, rho) = grid.at(i);
        let [a, b, c] = [0, 1, 2].map(|k| label(regions.maps[k][i]));
        let _ = writeln!(text, "{eta},{rho},{a},{b},{c}");
    }
    text
}

fn map_csv(map: &RegionMap) -> String {
    let mut text = String::from("eta,rho,from_start\n");
    for (i, cell) in map.cells.iter().enumerate() {
        let (eta, rho) = (map.eta[i % map.eta.len()], map.rho[i / map.eta.len()]);
        let _ = writeln!(text, "{eta},{rho},{}", label(*cell));
    }
    text
}
