//! The model's orbit that a periodic record shows.

use crate::methods::trajectories::record::TrajectoryRecord;
use crate::parameters::Parameters;
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::params::{Machine, Setting};
use impact_records::event::RigKind;

/// The z = 1/n orbit at a record's setting whose closing speed is nearest to the measured one.
pub struct NearestOrbit {
    /// The record's own parameters.
    pub own: Parameters,
    /// The machine.
    pub machine: Machine,
    /// η and ρ.
    pub setting: Setting,
    /// The orbits at η.
    pub branch: Branch,
    /// Its closing speed, dimensionless.
    pub closing_speed: f64,
}

impl NearestOrbit {
    /// At given parameters; `None` beyond the saddle-node.
    pub fn of(rig: RigKind, record: &TrajectoryRecord, parameters: &Parameters) -> Option<Self> {
        let (own, clearance_m) = parameters.own(&record.circumstances(rig));
        let machine = own.machine(rig);
        let setting = own.setting(record.frequency_hz, clearance_m, record.drive_amplitude);
        let n = record.folded.periods_n;
        let extra = record.extra_at_impact(parameters);
        let branch = Branch::new(&machine, setting.frequency_ratio, n).with_extra(extra);
        let restitution = own.restitution.clamp(0.0, 1.0);
        let speeds = branch.approach_speeds(restitution, machine.gap(setting.clearance))?;
        let scale = own.static_deflection_m * record.drive_amplitude * own.natural_rate();
        let measured = record.closing_speed_m_s / scale;
        let closing_speed = speeds
            .into_iter()
            .filter(|w| *w > 0.0)
            .min_by(|a, b| (a - measured).abs().total_cmp(&(b - measured).abs()))?;
        Some(Self {
            own,
            machine,
            setting,
            branch,
            closing_speed,
        })
    }
}
