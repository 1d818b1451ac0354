//! `impactid boundary`: single points of the boundaries in the (η, ρ) plane.

use clap::{ArgGroup, Args, ValueEnum};
use serde_json::{Value, json};

use super::machine::{MachineArgs, motion, refused};
use super::stdout::print;
use super::{Exit, Failure, Verbosity};
use impact_oscillator::Machine;
use impact_oscillator::atlas::{At, Boundary as Sought, BoundaryQuery, Point, boundary_points};

/// Arguments of `impactid boundary`.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLE,
    group = ArgGroup::new("place").required(true).args(["eta", "rho"])
)]
pub(super) struct Boundary {
    /// Which boundary
    #[arg(long, value_enum)]
    kind: Kind,
    /// The motion z = p/n that it bounds, with j behind it if it has a dead zone [default: 1/1];
    /// not for grazing, which bounds z = 0, and joined
    #[arg(long, value_name = "P/N[j]", value_parser = bounded)]
    motion: Option<(u32, u32, bool)>,
    #[command(flatten)]
    machine: MachineArgs,
    /// Frequency ratio η at which the clearance ρ is sought
    #[arg(long, value_name = "ETA")]
    eta: Option<f64>,
    /// Clearance ρ at which η is sought, up to η = 2.5 n
    #[arg(long, value_name = "RHO", allow_negative_numbers = true)]
    rho: Option<f64>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// The boundaries that can be sought.
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
    /// 1 | 1j, 2 | 2j: where the masses begin to stick together after an impact
    DeadZone,
    /// ρp: below it the masses never separate (−1 for equal masses)
    #[value(name = "joined")]
    Sticking,
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

`valid` states whether the boundary is one that a machine shows: the marginal orbit closes, \
meets no further contact, opens no dead zone, and no other multiplier has left the unit \
circle. Exit code 1: the motion has no such boundary there.";

impl Kind {
    fn boundary(self) -> Sought {
        match self {
            Self::S2 => Sought::SaddleNode,
            Self::S1 => Sought::PeriodDoubling,
            Self::Grazing => Sought::ImpactlessGrazing,
            Self::FurtherImpact => Sought::FurtherImpact,
            Self::DeadZone => Sought::DeadZone,
            Self::Sticking => Sought::Sticking,
        }
    }
}

impl Boundary {
    /// Print the points.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range.
    pub(super) fn run(self, _verbosity: Verbosity) -> Result<Exit, Failure> {
        let machine = self.machine.machine()?;
        if self.motion.is_some() && matches!(self.kind, Kind::Grazing | Kind::Sticking) {
            return Err(Failure::new(
                "--motion is not for the kinds grazing and joined: ρ' bounds the impactless motion \
                 z = 0, ρp the motion in which the masses never separate",
                "leave --motion out, or name another kind",
            ));
        }
        let (p, n, dead_zone) = self.motion.unwrap_or((1, 1, false));
        let query = BoundaryQuery {
            boundary: self.kind.boundary(),
            p,
            n,
            dead_zone,
            at: match (self.eta, self.rho) {
                (Some(eta), _) => At::FrequencyRatio(eta),
                (None, rho) => At::Clearance(rho.unwrap_or(f64::NAN)),
            },
        };
        let points = boundary_points(&machine, &query).map_err(|e| refused(&e))?;
        let name = self.kind.to_possible_value();
        let answer = Answer {
            machine: &machine,
            query: &query,
            points: &points,
            name: name.as_ref().map_or("", |v| v.get_name()),
        };
        print(&if self.json {
            answer.json()
        } else {
            answer.text()
        })?;
        Ok(if points.is_empty() {
            Exit::AnswerIsNo
        } else {
            Exit::Done
        })
    }
}

/// What was sought and what was found.
struct Answer<'a> {
    machine: &'a Machine,
    query: &'a BoundaryQuery,
    points: &'a [Point],
    name: &'a str,
}

impl Answer<'_> {
    /// One object on one line: the first point with the boundary's name, the further ones under `others`.
    fn json(&self) -> String {
        let mut rows = self.points.iter().map(|point| self.row(point));
        let mut first = rows.next().unwrap_or_else(|| self.missing());
        first["kind"] = self.name.into();
        first["motion"] = self.motion().into();
        let others: Vec<Value> = rows.collect();
        if !others.is_empty() {
            first["others"] = others.into();
        }
        format!("{first}\n")
    }

    fn missing(&self) -> Value {
        let (eta, rho) = match self.query.at {
            At::FrequencyRatio(eta) => (Some(eta), None),
            At::Clearance(rho) => (None, Some(rho)),
        };
        json!({"rho": rho, "valid": false, "eta": eta, "reason": self.none()})
    }

    fn row(&self, point: &Point) -> Value {
        let mut row = json!({"rho": point.rho(), "valid": point.is_valid(), "eta": point.eta(), "closing_speed": 0.0});
        let side = |upper: bool| if upper { "high" } else { "low" };
        match *point {
            Point::Value { .. } => {}
            Point::ClosedForm(p) => {
                row["closing_speed"] = p.approach_speed.into();
                row["phase_at_impact_rad"] = p.phase.into();
                row["existence"] = json!(p.existence);
                row["ends_stability"] = p.ends_stability.into();
            }
            Point::Followed {
                approach_speed,
                upper,
                ..
            } => {
                row["closing_speed"] = approach_speed.into();
                row["side"] = side(upper).into();
            }
            Point::Resting { upper, .. } => {
                row["side"] = side(upper).into();
                row["of"] = format!("{}/{}j", self.query.p, self.query.n).into();
            }
        }
        row
    }

    /// A line per point.
    fn text(&self) -> String {
        if self.points.is_empty() {
            return format!("{}\n", self.none());
        }
        let line = |point: &Point| {
            let valid = if point.is_valid() {
                ""
            } else {
                "  (no motion there)"
            };
            let (boundary, eta, rho) = (self.boundary(), point.eta(), point.rho());
            format!("{boundary}: η = {eta}  ρ = {rho}{valid}\n")
        };
        self.points.iter().map(line).collect()
    }

    /// The boundary with the motion that it bounds.
    fn boundary(&self) -> String {
        match self.query.boundary {
            Sought::Sticking => "ρp".to_owned(),
            _ => format!("{} of z = {}", self.name, self.motion()),
        }
    }

    /// The motion that it bounds: p/n with j if it has a dead zone, `0` without impacts, `joined`
    /// without separation.
    fn motion(&self) -> String {
        match self.query.boundary {
            Sought::ImpactlessGrazing => "0".to_owned(),
            Sought::Sticking => "joined".to_owned(),
            _ => {
                let j = if self.query.dead_zone { "j" } else { "" };
                format!("{}/{}{j}", self.query.p, self.query.n)
            }
        }
    }

    /// That the motion has no such boundary there.
    fn none(&self) -> String {
        let boundary = self.boundary();
        let none = match (self.query.at, self.query.boundary) {
            (At::FrequencyRatio(eta), _) => format!("{boundary}: none at η = {eta}"),
            (At::Clearance(rho), Sought::Sticking) => {
                format!(
                    "{boundary}: no single η at ρ = {rho}; with equal forces on both masses, or masses \
                     of equal f0 and β, ρp is the same at every η"
                )
            }
            (At::Clearance(rho), Sought::ImpactlessGrazing) => {
                format!("{boundary}: none at ρ = {rho} up to η = 2.5")
            }
            (At::Clearance(rho), _) => {
                let top = self.query.greatest_eta();
                format!("{boundary}: none at ρ = {rho} up to η = {top}")
            }
        };
        match self.never_rests() {
            Some(why) => format!("{none}; {why}"),
            None => none,
        }
    }

    /// What follows from the law of restitution for dead zones, where there is none.
    fn never_rests(&self) -> Option<&'static str> {
        let law = self.machine.restitution();
        if self.query.boundary != Sought::DeadZone {
            None
        } else if law.constant() == Some(1.0) {
            Some("with R = 1 the masses never come to rest against each other")
        } else if !law.is_plastic_somewhere() {
            Some("R > 0 at every speed, so the masses rest only after a complete chatter")
        } else {
            None
        }
    }
}
