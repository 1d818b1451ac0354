//! `impactid boundary`: single points of the boundaries in the (η, ρ) plane.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::machine::{MachineArgs, motion, refused};
use super::stdout::print;
use super::{Exit, Failure, Verbosity};
use impact_oscillator::atlas::brute::{Way, brute_map};
use impact_oscillator::atlas::continuation::{Edge, EdgeKind};
use impact_oscillator::atlas::map::{MapGrid, MapSettings};
use impact_oscillator::atlas::regions::{AtlasSettings, slices_at, spans_at_clearance};
use impact_oscillator::atlas::resting::{RestingEdge, resting_etas, resting_slices};
use impact_oscillator::model::boundary::{
    BoundaryPoint, etas_grazing, etas_joined, etas_s1, etas_s2, rho_grazing, rho_joined, rho_s1,
    rho_s2,
};
use impact_oscillator::model::{Machine, Setting};

/// Arguments of `impactid boundary`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Boundary {
    /// Which boundary
    #[arg(long, value_enum)]
    kind: Kind,
    /// The motion z = p/n that it bounds; with j behind it where it has a dead zone
    #[arg(long, value_name = "P/N[j]", default_value = "1/1", value_parser = bounded)]
    motion: (u32, u32, bool),
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratio η at which the clearance ρ is asked for
    #[arg(long, value_name = "ETA", required_unless_present = "rho")]
    eta: Option<f64>,
    /// Clearance ρ at which η is asked for, up to η = 2.5 n
    #[arg(
        long,
        value_name = "RHO",
        conflicts_with = "eta",
        allow_negative_numbers = true
    )]
    rho: Option<f64>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// The boundaries that can be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Saddle-node: where an orbit meets its unstable twin
    S2,
    /// Period doubling
    S1,
    /// ρ': where the impactless motion z = 0 touches the contact
    Grazing,
    /// Where a further impact begins within the motion
    FurtherImpact,
    /// 1 | 1j, 2 | 2j: where the masses begin to stay together after an impact
    DeadZone,
    /// ρp: below it the masses stay together for ever (−1 for equal masses)
    Joined,
}

/// A motion z = p/n, with or without a dead zone.
fn bounded(text: &str) -> Result<(u32, u32, bool), String> {
    let plain = text.trim().trim_end_matches('j');
    let (p, n) = motion(plain)?;
    Ok((p, n, plain.len() < text.trim().len()))
}

const EXAMPLE: &str = "\
Example:
  impactid boundary --kind s2 --motion 1/1 --restitution 0.9 --damping-ratio 0.07 --eta 1.3 --json
  impactid boundary --kind dead-zone --motion 1j --restitution 0 --damping-ratio 0.002 --eta 0.8
  impactid boundary --kind s1 --motion 2/1 --restitution 0.9 --damping-ratio 0.07 --rho=-0.3

`valid` tells whether the boundary is one that a machine shows: the marginal orbit closes, meets no
further contact, opens no dead zone, and no other multiplier has left the unit circle. Exit code 1:
the motion has no such boundary there.";

/// Least η that is searched for a point at a clearance.
const LEAST_ETA: f64 = 0.05;
/// Places between it and the greatest at which motions are simulated.
const COLUMNS: usize = 600;

impl Boundary {
    /// Print the point.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range.
    pub fn run(self, _verbosity: Verbosity) -> Result<Exit, Failure> {
        let machine = self.machine.machine()?;
        let points = match (self.eta, self.rho) {
            (Some(eta), _) => self.at_eta(&machine, eta)?,
            (None, Some(rho)) => self.at_rho(&machine, rho)?,
            (None, None) => Vec::new(),
        };
        print(&self.text(&points))?;
        Ok(if points.is_empty() {
            Exit::AnswerIsNo
        } else {
            Exit::Done
        })
    }

    fn at_eta(&self, machine: &Machine, eta: f64) -> Result<Vec<Value>, Failure> {
        Setting::new(eta, 0.0).check().map_err(|e| refused(&e))?;
        let (p, n, _) = self.motion;
        let closed = |found: Option<BoundaryPoint>| found.map(|p| vec![point(&p)]);
        let constant = machine.restitution().constant().is_some();
        let points = match (self.kind, p) {
            (Kind::Grazing, _) => Some(vec![of_rho(rho_grazing(machine, eta), eta)]),
            (Kind::Joined, _) => Some(vec![of_rho(rho_joined(machine, eta), eta)]),
            (Kind::S2, 1) => Some(closed(rho_s2(machine, eta, n)).unwrap_or_default()),
            (Kind::S1, 1) if constant => Some(closed(rho_s1(machine, eta, n)).unwrap_or_default()),
            _ => None,
        };
        match points {
            Some(points) => Ok(points),
            None => self.followed(machine, eta),
        }
    }

    /// Edges of a general p/n, by continuation from orbits that simulation finds.
    fn followed(&self, machine: &Machine, eta: f64) -> Result<Vec<Value>, Failure> {
        let (p, n, dead_zone) = self.motion;
        let bottom = 1.05 * rho_joined(machine, eta);
        let top = 1.1 * (rho_grazing(machine, eta)).max(1.0) + 1.0;
        let settings = self.settings(MapGrid::even((eta, eta, 1), (bottom, top, 400)));
        let mut points = Vec::new();
        if self.kind == Kind::DeadZone {
            points = resting(machine, &settings, (p, n))?;
        }
        if !dead_zone {
            let slices = slices_at(machine, eta, &settings).map_err(|e| refused(&e))?;
            let own = slices.iter().filter(|s| (s.p, s.n) == (p, n));
            points.extend(self.edges(own.map(|s| (&s.low, &s.high))));
        }
        Ok(points)
    }

    /// The same along η.
    fn followed_at_rho(&self, machine: &Machine, rho: f64) -> Result<Vec<Value>, Failure> {
        let (p, n, dead_zone) = self.motion;
        let grid = MapGrid::even((LEAST_ETA, self.greatest_eta(), COLUMNS), (rho, rho, 1));
        let mut points = Vec::new();
        if self.kind == Kind::DeadZone {
            let etas = resting_etas(machine, rho, (p, n), &grid.eta, None);
            points.extend(etas.into_iter().map(|(eta, below)| {
                let side = if below { "high" } else { "low" };
                of_resting((rho, eta), side, (p, n))
            }));
        }
        if !dead_zone {
            let settings = self.settings(grid);
            let spans = spans_at_clearance(machine, rho, &settings).map_err(|e| refused(&e))?;
            let own = spans.iter().filter(|s| (s.p, s.n) == (p, n));
            points.extend(self.edges(own.map(|s| (&s.low, &s.high))));
        }
        let eta = |v: &Value| v["eta"].as_f64().unwrap_or(f64::NAN);
        points.sort_by(|a, b| eta(a).total_cmp(&eta(b)));
        Ok(points)
    }

    /// The greatest η that is searched for a point at a clearance.
    fn greatest_eta(&self) -> f64 {
        2.5 * f64::from(self.motion.1)
    }

    fn settings(&self, grid: MapGrid) -> AtlasSettings {
        AtlasSettings {
            grid,
            largest_p: self.motion.0,
            largest_n: self.motion.1,
            map: MapSettings::default(),
        }
    }

    /// The edges of the kind asked for.
    fn edges<'a>(&self, all: impl Iterator<Item = (&'a Edge, &'a Edge)>) -> Vec<Value> {
        let wanted = match self.kind {
            Kind::S2 => EdgeKind::SaddleNode,
            Kind::S1 => EdgeKind::PeriodDoubling,
            Kind::FurtherImpact | Kind::Grazing => EdgeKind::Grazing,
            Kind::DeadZone | Kind::Joined => EdgeKind::DeadZone,
        };
        all.flat_map(|(low, high)| [(low, "low"), (high, "high")])
            .filter(|(edge, _)| edge.kind == wanted)
            .map(|(edge, side)| followed_edge(edge, side))
            .collect()
    }

    fn at_rho(&self, machine: &Machine, rho: f64) -> Result<Vec<Value>, Failure> {
        Setting::new(1.0, rho).check().map_err(|e| refused(&e))?;
        let (p, n, _) = self.motion;
        let constant = machine.restitution().constant().is_some();
        let plain = |etas: Vec<f64>| etas.into_iter().map(|eta| of_rho(rho, eta)).collect();
        let mut points: Vec<Value> = match (self.kind, p) {
            (Kind::S2, 1) if constant => etas_s2(machine, rho, n).iter().map(point).collect(),
            (Kind::S1, 1) if constant => etas_s1(machine, rho, n).iter().map(point).collect(),
            (Kind::Grazing, _) => plain(etas_grazing(machine, rho)),
            (Kind::Joined, _) => plain(etas_joined(machine, rho)),
            _ => self.followed_at_rho(machine, rho)?,
        };
        // the one at the greatest η first: where a rising sweep jumps
        points.reverse();
        Ok(points)
    }

    /// What the law of restitution says of dead zones, where there is none.
    fn never_rests(&self) -> Option<&'static str> {
        let machine = self.machine.machine().ok()?;
        let law = machine.restitution();
        if self.kind != Kind::DeadZone {
            None
        } else if law.constant() == Some(1.0) {
            Some("with R = 1 the masses never come to rest against each other")
        } else if !law.is_plastic_somewhere() {
            Some("R > 0 at every speed, so the masses rest only after a complete chatter")
        } else {
            None
        }
    }

    /// That the motion has no such boundary there.
    fn none(&self, name: &str, z: &str) -> String {
        let none = self.none_there(name, z);
        match self.never_rests() {
            Some(why) => format!("{none}; {why}"),
            None => none,
        }
    }

    fn none_there(&self, name: &str, z: &str) -> String {
        match (self.eta, self.rho, self.kind) {
            (Some(eta), _, _) => format!("{name} of z = {z}: none at η = {eta}"),
            (_, Some(rho), Kind::Joined) => {
                format!("{name}: no single η at ρ = {rho}; with equal masses ρp is −1 at every η")
            }
            (_, Some(rho), Kind::Grazing) => format!("{name}: none at ρ = {rho} up to η = 2.5"),
            (_, rho, _) => {
                let (rho, top) = (rho.unwrap_or(f64::NAN), self.greatest_eta());
                format!("{name} of z = {z}: none at ρ = {rho} up to η = {top}")
            }
        }
    }

    /// One object, the further points of the same boundary beside it under `others`.
    fn text(&self, points: &[Value]) -> String {
        let name = self
            .kind
            .to_possible_value()
            .map_or(String::new(), |v| v.get_name().into());
        let (p, n, dead_zone) = self.motion;
        let z = format!("{p}/{n}{}", if dead_zone { "j" } else { "" });
        if !self.json {
            let mut text = String::new();
            for v in points {
                let valid = if v["valid"] == json!(true) {
                    ""
                } else {
                    "  (no motion there)"
                };
                text += &format!(
                    "{name} of z = {z}: η = {}  ρ = {}{valid}\n",
                    v["eta"], v["rho"]
                );
            }
            if points.is_empty() {
                text = format!("{}\n", self.none(&name, &z));
            }
            return text;
        }
        let mut first = points.first().cloned().unwrap_or_else(|| {
            let reason = self.none(&name, &z);
            json!({"rho": self.rho, "valid": false, "eta": self.eta, "reason": reason})
        });
        first["kind"] = json!(name);
        first["motion"] = json!(z);
        if points.len() > 1 {
            first["others"] = json!(points[1..]);
        }
        format!("{first}\n")
    }
}

/// A point without an orbit; not valid where it lies at infinity (an undamped resonance).
fn of_rho(rho: f64, eta: f64) -> Value {
    json!({"rho": rho, "valid": rho.is_finite(), "eta": eta, "closing_speed": 0.0})
}

fn followed_edge(edge: &Edge, side: &str) -> Value {
    let speed = edge.orbit.speeds.iter().fold(0.0, |m: f64, w| m.max(*w));
    let (eta, rho) = (edge.orbit.eta, edge.orbit.rho);
    json!({"rho": rho, "valid": true, "eta": eta, "closing_speed": speed, "side": side})
}

/// Edges of the motion p/n that rests in a dead zone.
fn resting(
    machine: &Machine,
    settings: &AtlasSettings,
    (p, n): (u32, u32),
) -> Result<Vec<Value>, Failure> {
    let (grid, map) = (&settings.grid, &settings.map);
    let starts = brute_map(machine, grid, map, Way::FromStart).map_err(|e| refused(&e))?;
    let columns = resting_slices(machine, grid, (p, n), map.kernel, &[starts]);
    let slices = columns.iter().flatten().filter(|s| s.is(p, n));
    Ok(slices
        .flat_map(|s| [(s.low, "low", s.eta), (s.high, "high", s.eta)])
        .filter_map(|(edge, side, eta)| {
            let (rho, kind) = edge?;
            let edge = of_resting((rho, eta), side, (p, n));
            (kind == RestingEdge::DeadZone).then_some(edge)
        })
        .collect())
}

fn of_resting((rho, eta): (f64, f64), side: &str, (p, n): (u32, u32)) -> Value {
    json!({
        "rho": rho, "valid": true, "eta": eta, "closing_speed": 0.0, "side": side,
        "of": format!("{p}/{n}j"),
    })
}

fn point(p: &BoundaryPoint) -> Value {
    json!({
        "rho": p.rho,
        "valid": p.is_valid(),
        "eta": p.eta,
        "closing_speed": p.closing_speed,
        "phase_at_impact_rad": p.phase,
        "existence": p.existence,
        "ends_stability": p.ends_stability,
    })
}
