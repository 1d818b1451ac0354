//! `impactid boundary`: single points of the boundaries in the (η, ρ) plane.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::machine::{MachineArgs, motion, refused};
use super::{Exit, Failure, Voice};
use crate::atlas::continuation::EdgeKind;
use crate::atlas::map::{MapGrid, MapSettings};
use crate::atlas::regions::{AtlasSettings, slices_at};
use crate::model::boundary::{BoundaryPoint, eta_s2, rho_grazing, rho_s1, rho_s2};
use crate::model::{Machine, Setting};

/// Arguments of `impactid boundary`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Boundary {
    /// Which boundary
    #[arg(long, value_enum)]
    kind: Kind,
    /// The motion z = p/n that it bounds
    #[arg(long, value_name = "P/N", default_value = "1/1", value_parser = motion)]
    motion: (u32, u32),
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratio η at which the clearance ρ is asked for
    #[arg(long, value_name = "ETA", required_unless_present = "rho")]
    eta: Option<f64>,
    /// Clearance ρ at which η is asked for (s2 of z = 1/n)
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
    /// ρ': where the impactless motion touches the contact
    Grazing,
    /// Where a further impact begins within the motion
    FurtherImpact,
    /// 1 | 1j: where the masses begin to stay together after an impact
    DeadZone,
}

const EXAMPLE: &str = "\
Example:
  impactid boundary --kind s2 --motion 1/1 --restitution 0.9 --damping-ratio 0.07 --eta 1.3 --json

Exit code 1: the motion has no such boundary there.";

impl Boundary {
    /// Print the point.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range.
    pub fn go(self, _voice: Voice) -> Result<Exit, Failure> {
        let machine = self.machine.machine()?;
        let points = match (self.eta, self.rho) {
            (Some(eta), _) => self.at_eta(&machine, eta)?,
            (None, Some(rho)) => self.at_rho(&machine, rho)?,
            (None, None) => Vec::new(),
        };
        self.print(&points);
        Ok(if points.is_empty() {
            Exit::AnswerIsNo
        } else {
            Exit::Done
        })
    }

    fn at_eta(&self, machine: &Machine, eta: f64) -> Result<Vec<Value>, Failure> {
        Setting::new(eta, 0.0).check().map_err(|e| refused(&e))?;
        let closed = |p: Option<BoundaryPoint>| p.map(|p| point(&p)).into_iter().collect();
        match (self.kind, self.motion) {
            (Kind::Grazing, _) => {
                let rho = rho_grazing(machine, eta);
                Ok(vec![
                    json!({"rho": rho, "valid": true, "eta": eta, "closing_speed": 0.0}),
                ])
            }
            (Kind::S2, (1, n)) => Ok(closed(rho_s2(machine, eta, n))),
            (Kind::S1, (1, n)) => Ok(closed(rho_s1(machine, eta, n))),
            _ => self.followed(machine, eta),
        }
    }

    /// Edges of a general p/n, by continuation from orbits that simulation finds.
    fn followed(&self, machine: &Machine, eta: f64) -> Result<Vec<Value>, Failure> {
        let wanted = match self.kind {
            Kind::S2 => EdgeKind::SaddleNode,
            Kind::S1 => EdgeKind::PeriodDoubling,
            Kind::FurtherImpact | Kind::Grazing => EdgeKind::Grazing,
            Kind::DeadZone => EdgeKind::DeadZone,
        };
        let top = 1.1 * (rho_grazing(machine, eta)).max(1.0) + 1.0;
        let settings = AtlasSettings {
            grid: MapGrid::even((eta, eta, 1), (-0.99, top, 400)),
            largest_p: self.motion.0,
            largest_n: self.motion.1,
            map: MapSettings::default(),
        };
        let slices = slices_at(machine, eta, &settings).map_err(|e| refused(&e))?;
        let edges = slices
            .iter()
            .filter(|s| (s.p, s.n) == self.motion)
            .flat_map(|s| [(&s.low, "low"), (&s.high, "high")])
            .filter(|(edge, _)| edge.kind == wanted);
        Ok(edges
            .map(|(edge, side)| {
                let speed = edge.orbit.speeds.iter().fold(0.0, |m: f64, w| m.max(*w));
                let rho = edge.orbit.rho;
                json!({"rho": rho, "valid": true, "eta": eta, "closing_speed": speed, "side": side})
            })
            .collect())
    }

    fn at_rho(&self, machine: &Machine, rho: f64) -> Result<Vec<Value>, Failure> {
        match (self.kind, self.motion) {
            (Kind::S2, (1, n)) => Ok(eta_s2(machine, rho, n).iter().map(point).collect()),
            _ => Err(Failure::new(
                "--rho answers for s2 of z = 1/n alone",
                "give --eta, or --kind s2 with a motion 1/n",
            )),
        }
    }

    /// One object, the further points of the same boundary beside it under `others`.
    fn print(&self, points: &[Value]) {
        let name = self
            .kind
            .to_possible_value()
            .map_or(String::new(), |v| v.get_name().into());
        let (p, n) = self.motion;
        if !self.json {
            for v in points {
                let valid = if v["valid"] == json!(true) {
                    ""
                } else {
                    "  (no motion there)"
                };
                println!(
                    "{name} of z = {p}/{n}: η = {}  ρ = {}{valid}",
                    v["eta"], v["rho"]
                );
            }
            if points.is_empty() {
                println!("{name} of z = {p}/{n}: none");
            }
            return;
        }
        let mut first = points
            .first()
            .cloned()
            .unwrap_or_else(|| json!({"rho": null, "valid": false}));
        first["kind"] = json!(name);
        first["motion"] = json!(format!("{p}/{n}"));
        if points.len() > 1 {
            first["others"] = json!(points[1..]);
        }
        println!("{first}");
    }
}

fn point(p: &BoundaryPoint) -> Value {
    json!({
        "rho": p.rho,
        "valid": p.is_valid(),
        "eta": p.eta,
        "closing_speed": p.closing_speed,
        "phase_at_impact_rad": p.phase,
        "existence": p.existence,
    })
}
