//! Single points of any boundary in the (η, ρ) plane, each by the cheapest method that gives it:
//! closed forms for z = 1/n, continuation from simulated orbits for the other motions.

use serde::{Deserialize, Serialize};

use super::edge::{Edge, EdgeKind};
use super::map::{MapGrid, MapSettings, march_grid};
use super::regions::{slices_at, spans_at_clearance};
use super::resting::{resting_etas, resting_slices};
use super::settings::AtlasSettings;
use crate::model::boundary::{
    BoundaryPoint, etas_grazing, etas_s1, etas_s2, etas_sticking, rho_grazing, rho_s1, rho_s2,
    rho_sticking,
};
use crate::model::{Machine, ModelError, Setting};

/// The boundaries of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// s2: an orbit meets its unstable twin, multiplier +1.
    SaddleNode,
    /// s1: the period doubles, multiplier −1.
    PeriodDoubling,
    /// ρ': the impactless motion touches the contact.
    ImpactlessGrazing,
    /// A further impact begins within the motion.
    FurtherImpact,
    /// The masses begin to stick together after an impact (1 | 1j).
    DeadZone,
    /// ρp: the masses stick together for all time below.
    Sticking,
}

/// The coordinate at which the points of a boundary are sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum At {
    /// All ρ at this η.
    FrequencyRatio(f64),
    /// All η at this ρ.
    Clearance(f64),
}

/// Which points are sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundaryQuery {
    /// The boundary.
    pub boundary: Boundary,
    /// Impacts in a period of the motion that it bounds, at least 1.
    pub p: u32,
    /// Drive periods in a period of that motion, at least 1.
    pub n: u32,
    /// Whether that motion has a dead zone.
    pub dead_zone: bool,
    /// Where.
    pub at: At,
}

/// A point of a boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Point {
    /// Of ρ' or ρp, which have no orbit with impacts.
    Value {
        /// η
        eta: f64,
        /// ρ, infinite at an undamped resonance.
        rho: f64,
    },
    /// Of a closed form, with its marginal orbit.
    ClosedForm(BoundaryPoint),
    /// The edge of a motion that was followed to it.
    Followed {
        /// η
        eta: f64,
        /// ρ
        rho: f64,
        /// Greatest approach speed of the last orbit.
        approach_speed: f64,
        /// Whether it is the upper edge along the coordinate that is sought.
        upper: bool,
    },
    /// The edge of the motion that rests in a dead zone.
    Resting {
        /// η
        eta: f64,
        /// ρ
        rho: f64,
        /// Whether it is the upper edge along the coordinate that is sought.
        upper: bool,
    },
}

impl Point {
    /// η
    #[must_use]
    pub fn eta(&self) -> f64 {
        match self {
            Self::ClosedForm(p) => p.eta,
            Self::Value { eta, .. } | Self::Followed { eta, .. } | Self::Resting { eta, .. } => {
                *eta
            }
        }
    }

    /// ρ
    #[must_use]
    pub fn rho(&self) -> f64 {
        match self {
            Self::ClosedForm(p) => p.rho,
            Self::Value { rho, .. } | Self::Followed { rho, .. } | Self::Resting { rho, .. } => {
                *rho
            }
        }
    }

    /// Whether a machine shows the boundary there.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        match self {
            Self::ClosedForm(p) => p.is_valid(),
            Self::Value { rho, .. } => rho.is_finite(),
            Self::Followed { .. } | Self::Resting { .. } => true,
        }
    }
}

/// Least η that is searched for a point at a clearance.
const LEAST_ETA: f64 = 0.05;
/// Places between it and the greatest at which motions are simulated.
const COLUMNS: usize = 600;
/// Clearances at which motions are simulated for a point at an η.
const ROWS: usize = 400;

/// The points of a boundary at an η (ρ rising within each motion) or at a ρ (η falling: the first
/// is where a rising sweep jumps). None: the motion has no such boundary there.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
///
/// ```
/// use impact_oscillator::atlas::{At, Boundary, BoundaryQuery, boundary_points};
/// use impact_oscillator::Machine;
///
/// let query = BoundaryQuery {
///     boundary: Boundary::SaddleNode,
///     p: 1,
///     n: 1,
///     dead_zone: false,
///     at: At::FrequencyRatio(1.3),
/// };
/// let points = boundary_points(&Machine::symmetric(0.07, 0.9), &query)?;
/// assert!((points[0].rho() - 4.151_754).abs() < 1e-6);
/// assert!(points[0].is_valid());
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn boundary_points(machine: &Machine, query: &BoundaryQuery) -> Result<Vec<Point>, ModelError> {
    machine.check()?;
    match query.at {
        At::FrequencyRatio(eta) => query.at_frequency_ratio(machine, eta),
        At::Clearance(rho) => query.at_clearance(machine, rho),
    }
}

impl BoundaryQuery {
    /// The greatest η that is searched for a point at a clearance: 2.5 n.
    #[must_use]
    pub fn greatest_eta(&self) -> f64 {
        2.5 * f64::from(self.n)
    }

    fn at_frequency_ratio(&self, machine: &Machine, eta: f64) -> Result<Vec<Point>, ModelError> {
        Setting::new(eta, 0.0).check()?;
        let value = |rho: f64| Ok(vec![Point::Value { eta, rho }]);
        let closed = |p: Option<BoundaryPoint>| Ok(p.map(Point::ClosedForm).into_iter().collect());
        let constant = machine.restitution().constant().is_some();
        match (self.boundary, self.p) {
            (Boundary::ImpactlessGrazing, _) => value(rho_grazing(machine, eta)),
            (Boundary::Sticking, _) => value(rho_sticking(machine, eta)),
            (Boundary::SaddleNode, 1) => closed(rho_s2(machine, eta, self.n)),
            (Boundary::PeriodDoubling, 1) if constant => closed(rho_s1(machine, eta, self.n)),
            _ => self.followed_in_clearance(machine, eta),
        }
    }

    fn at_clearance(&self, machine: &Machine, rho: f64) -> Result<Vec<Point>, ModelError> {
        Setting::new(1.0, rho).check()?;
        let value = |eta: f64| Point::Value { eta, rho };
        let values = |etas: Vec<f64>| etas.into_iter().map(value).collect();
        let closed = |all: Vec<BoundaryPoint>| all.into_iter().map(Point::ClosedForm).collect();
        let constant = machine.restitution().constant().is_some();
        let mut points: Vec<Point> = match (self.boundary, self.p) {
            (Boundary::SaddleNode, 1) if constant => closed(etas_s2(machine, rho, self.n)),
            (Boundary::PeriodDoubling, 1) if constant => closed(etas_s1(machine, rho, self.n)),
            (Boundary::ImpactlessGrazing, _) => values(etas_grazing(machine, rho)),
            (Boundary::Sticking, _) => values(etas_sticking(machine, rho)),
            _ => self.followed_in_frequency(machine, rho)?,
        };
        points.reverse();
        Ok(points)
    }

    /// Edges along ρ, by continuation from orbits that simulation finds.
    fn followed_in_clearance(&self, machine: &Machine, eta: f64) -> Result<Vec<Point>, ModelError> {
        let bottom = 1.05 * rho_sticking(machine, eta);
        let top = 1.1 * rho_grazing(machine, eta).max(1.0) + 1.0;
        let settings = self.settings(MapGrid::even((eta, eta, 1), (bottom, top, ROWS)));
        let mut points = Vec::new();
        if self.boundary == Boundary::DeadZone {
            points = self.resting(machine, &settings)?;
        }
        if !self.dead_zone {
            let slices = slices_at(machine, eta, &settings)?;
            let own = slices.iter().filter(|s| (s.p, s.n) == (self.p, self.n));
            points.extend(self.edges(own.map(|s| (&s.low, &s.high))));
        }
        Ok(points)
    }

    /// Edges along η, likewise.
    fn followed_in_frequency(&self, machine: &Machine, rho: f64) -> Result<Vec<Point>, ModelError> {
        let motion = (self.p, self.n);
        let grid = MapGrid::even((LEAST_ETA, self.greatest_eta(), COLUMNS), (rho, rho, 1));
        let mut points = Vec::new();
        if self.boundary == Boundary::DeadZone {
            let etas = resting_etas(machine, rho, motion, &grid.eta, None);
            let point = |(eta, upper)| Point::Resting { eta, rho, upper };
            points.extend(etas.into_iter().map(point));
        }
        if !self.dead_zone {
            let spans = spans_at_clearance(machine, rho, &self.settings(grid))?;
            let own = spans.iter().filter(|s| (s.p, s.n) == motion);
            points.extend(self.edges(own.map(|s| (&s.low, &s.high))));
        }
        points.sort_by(|a, b| a.eta().total_cmp(&b.eta()));
        Ok(points)
    }

    fn settings(&self, grid: MapGrid) -> AtlasSettings {
        AtlasSettings {
            grid,
            largest_p: self.p,
            largest_n: self.n,
            map: MapSettings::default(),
        }
    }

    /// The edges of the kind that is sought.
    fn edges<'a>(&self, all: impl Iterator<Item = (&'a Edge, &'a Edge)>) -> Vec<Point> {
        let sought = match self.boundary {
            Boundary::SaddleNode => EdgeKind::SaddleNode,
            Boundary::PeriodDoubling => EdgeKind::PeriodDoubling,
            Boundary::FurtherImpact | Boundary::ImpactlessGrazing => EdgeKind::Grazing,
            Boundary::DeadZone | Boundary::Sticking => EdgeKind::DeadZone,
        };
        all.flat_map(|(low, high)| [(low, false), (high, true)])
            .filter(|(edge, _)| edge.kind == sought)
            .map(|(edge, upper)| Point::Followed {
                eta: edge.orbit.eta,
                rho: edge.orbit.rho,
                approach_speed: edge.orbit.greatest_speed(),
                upper,
            })
            .collect()
    }

    /// Edges along ρ of the motion that rests in a dead zone.
    fn resting(&self, machine: &Machine, s: &AtlasSettings) -> Result<Vec<Point>, ModelError> {
        let starts = march_grid(machine, &s.grid, &s.map)?;
        let most = (self.p, self.n);
        let columns = resting_slices(machine, &s.grid, most, s.map.kernel, &[starts]);
        let slices = columns.iter().flatten().filter(|s| s.is(self.p, self.n));
        Ok(slices
            .flat_map(|s| [(s.low, false, s.eta), (s.high, true, s.eta)])
            .filter_map(|(edge, upper, eta)| {
                let (rho, kind) = edge?;
                (kind == EdgeKind::DeadZone).then_some(Point::Resting { eta, rho, upper })
            })
            .collect())
    }
}
