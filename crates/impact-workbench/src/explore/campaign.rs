//! A campaign as the page shows it: records, brackets, the fit with its bands.

use std::path::Path;

use serde_json::{Value, json};

use super::ExploreError;
use super::first_view::{FirstView, Place};
use super::limits::{DEFLECTION, ETA, FREQUENCY, RHO};
use super::state::{Cursor, Panel, RigScale, State, Window};
use crate::theory::plan::RestitutionLaw;
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_campaign::pipeline::identify::IdentificationFile;
use impact_campaign::pipeline::observe::read_one;
use impact_campaign::pipeline::watch::Live;
use impact_campaign::pipeline::{
    Observed, PipelineError, Progress, identify, inputs, layout, published, store,
};
use impact_fit::Estimate;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::Parameters;
use impact_identification::identify::Identification;
use impact_identification::replay::{self, Input, PlacedRecord};
use impact_oscillator::model::params::Asymmetry;
use impact_records::event::RigKind;
use impact_records::message::typed;
use impact_records::motion::Observation;
use impact_records::record::Record;
use impact_records::signal::robust;
use impact_report::figures::plane::busy;
use impact_report::style::MotionStyle;

/// Files that a note names.
const NAMED: usize = 5;

/// A campaign with what was observed and identified.
pub struct OpenCampaign {
    pub(super) resolved: ResolvedCampaign,
    pub(super) observed: Observed,
    pub(super) identification: Identification,
    /// The evidence sorted and weighed as at the fit.
    pub(super) blocks: Blocks,
    placed: PlacedRecord,
}

impl OpenCampaign {
    /// Observe and identify a campaign, or what its published speeds say.
    ///
    /// # Errors
    /// [`ExploreError`] where none of its records can be used.
    pub fn of(resolved: ResolvedCampaign, progress: Progress<'_>) -> Result<Self, ExploreError> {
        if let Some(speeds) = &resolved.published {
            let identification = published::identified(&resolved, speeds)?;
            let observed = Observed::whatever_is_there(&resolved, progress)?;
            return Ok(Self::with(resolved, observed, identification));
        }
        let observed = Observed::of(&resolved, progress)?;
        progress("identify", 0, 1);
        let found = identify::identify(&resolved, &observed, None)?;
        Ok(Self::with(resolved, observed, found.identification))
    }

    /// The records that have arrived so far, with their fit.
    pub fn live(live: &Live) -> Self {
        Self::with(
            live.campaign.clone(),
            live.observed.clone(),
            live.found.identification.clone(),
        )
    }

    /// Read a results folder; with it come notes on inputs that are gone or changed: without its records a
    /// campaign has its fit.
    ///
    /// # Errors
    /// [`ExploreError`] where a file of the results is missing or of another version.
    pub fn read(
        folder: &Path,
        progress: Progress<'_>,
    ) -> Result<(Self, Vec<String>), ExploreError> {
        let resolved = store::read_resolved(folder)?;
        let found = store::read_identification(folder)?;
        let name = identify::FILE;
        layout::check_versions(&folder.join(name), name, &found.provenance.versions)?;
        let notes = changed_inputs(&resolved, &found);
        let observed = match store::read_observed(folder) {
            Ok(observed) => observed,
            Err(_) => Observed::whatever_is_there(&resolved, progress)?,
        };
        let known = observed.observations.len();
        let of_fit = resolved.records.len();
        if known != of_fit {
            return Err(ExploreError::Pipeline(PipelineError::Store {
                path: folder.display().to_string(),
                reason: format!("{known} records are observed, the campaign has {of_fit}"),
            }));
        }
        Ok((Self::with(resolved, observed, found.identification), notes))
    }

    fn with(
        resolved: ResolvedCampaign,
        observed: Observed,
        identification: Identification,
    ) -> Self {
        resolved.sources.close();
        let mut blocks = Blocks::new(&observed.evidence(&resolved));
        if let Some(joint) = &identification.joint_fit {
            blocks.weigh(&joint.fit.parameters);
            blocks.boundary.fit_early_scale(&joint.fit.parameters);
        }
        let mut campaign = Self {
            resolved,
            observed,
            identification,
            blocks,
            placed: PlacedRecord::default(),
        };
        campaign.placed = campaign.with_input(replay::placed);
        campaign
    }

    /// Call a function of the comparison.
    pub(super) fn with_input<T>(&self, of: impl FnOnce(&Input<'_>) -> T) -> T {
        of(&Input {
            rig: self.resolved.about.machine,
            observations: &self.observed.observations,
            brackets: &self.observed.brackets,
            identification: &self.identification,
            points: &[],
            proposals: &[],
            read: &|index| self.record(index),
        })
    }

    fn record(&self, index: usize) -> Option<Record> {
        let entry = self.resolved.records.get(index)?;
        // Opened for this record only: the laboratory may write to its file.
        let record = read_one(&self.resolved, entry);
        self.resolved.sources.close();
        Some(record)
    }

    /// The file of a record as the campaign names it.
    pub(super) fn file_of(&self, index: usize) -> String {
        let file = self.resolved.records.get(index).map(|r| r.file.as_path());
        let file = file.unwrap_or(Path::new(""));
        let named = file.strip_prefix(self.resolved.folder()).unwrap_or(file);
        named.display().to_string()
    }

    /// The parameters of the machine at the sliders, with gains, delays and effects of the fit; how its masses differ
    /// is on top of what the fit has.
    ///
    /// # Errors
    /// Why there are none: the identification knows machines of one R, of as many masses as the rig has, that are
    /// driven in the same direction.
    pub(super) fn at_sliders(&self, state: &State) -> Result<Parameters, &'static str> {
        let scale = state.rig.unwrap_or_else(|| self.scale());
        let single = self.resolved.about.machine == RigKind::Single;
        if state.single != single {
            return Err("the campaign's rig has another number of masses");
        }
        let machine = state.machine();
        let Some(restitution) = machine.restitution().constant() else {
            return Err("the records are compared with one R, not with R(v)");
        };
        if !(single || state.asymmetry.drive_amplitude > 0.0) {
            return Err("the records are compared with drives of one sign");
        }
        let sliders = Parameters::symmetric(
            restitution,
            scale.natural_frequency_hz,
            state.damping_ratio,
            scale.static_deflection_m,
        );
        let fit = self.identification.joint_fit.as_ref();
        let fitted = fit.map_or(sliders, |joint| Parameters {
            restitution: sliders.restitution,
            natural_frequency_hz: sliders.natural_frequency_hz,
            damping_ratio: sliders.damping_ratio,
            static_deflection_m: sliders.static_deflection_m,
            ..joint.fit.parameters
        });
        Ok(if single {
            fitted
        } else {
            unlike(fitted, state.asymmetry)
        })
    }

    /// f0 and `x_st`: fitted, else stated, else of the campaign's own scale.
    fn scale(&self) -> RigScale {
        let value = |e: &Option<Estimate>| e.as_ref().and_then(|e| e.value);
        let joint = &self.identification.joint.parameters;
        let fit = self.identification.joint_fit.as_ref();
        let fit = fit.map(|j| j.fit.parameters);
        let median = |all: Vec<f64>| robust::median(&all).filter(|v| *v > 0.0);
        let records = &self.observed.observations;
        let frequencies = || median(records.iter().filter_map(|o| o.frequency_hz()).collect());
        let gaps = || {
            median(
                records
                    .iter()
                    .filter_map(|o| o.setting.clearance_m)
                    .collect(),
            )
        };
        let frequency = fit
            .map(|p| p.natural_frequency_hz)
            .or(value(&joint.natural_frequency_hz))
            .or(self.resolved.rig.natural_frequency_hz)
            .or_else(frequencies)
            .unwrap_or(1.0);
        let deflection = fit
            .map(|p| p.static_deflection_m)
            .or(value(&joint.static_deflection_m))
            .or(self.resolved.rig.static_deflection_m)
            .or_else(gaps)
            .unwrap_or(1e-3);
        RigScale {
            natural_frequency_hz: FREQUENCY.nearest(frequency),
            static_deflection_m: DEFLECTION.nearest(deflection),
        }
    }

    /// The state at the fit, with all records in view.
    pub(super) fn first_state(&self) -> State {
        let first = State::default();
        let scale = self.scale();
        let value = |e: &Option<Estimate>| e.as_ref().and_then(|e| e.value);
        let joint = &self.identification.joint.parameters;
        let fit = self.identification.joint_fit.as_ref();
        let fit = fit.map(|j| j.fit.parameters).filter(|p| p.in_range());
        let stated = &self.resolved.rig;
        let restitution = fit.map(|p| p.restitution);
        let restitution = restitution
            .or(value(&joint.restitution))
            .or(stated.restitution);
        let damping = fit.map(|p| p.damping_ratio);
        let damping = damping
            .or(value(&joint.damping_ratio))
            .or(stated.damping_ratio);
        let view = self.first_view(scale).window;
        State {
            restitution: RestitutionLaw::Constant(restitution.unwrap_or(0.9).clamp(0.0, 1.0)),
            damping_ratio: damping.unwrap_or(0.05).clamp(0.0, 0.9),
            single: self.resolved.about.machine == RigKind::Single,
            cursor: self.first_cursor(scale, view),
            view,
            panel: Panel::Motion,
            rig: (self.has_places() || fit.is_some()).then_some(scale),
            ..first
        }
    }

    /// Whether any record has a place in the plane: a frequency and a clearance.
    fn has_places(&self) -> bool {
        let mut all = self.observed.observations.iter();
        all.any(|o| o.frequency_hz().is_some() && o.setting.clearance_m.is_some())
    }

    /// The surest record with z = 1, else the middle of what is shown.
    fn first_cursor(&self, scale: RigScale, view: Window) -> Cursor {
        let one = self
            .observed
            .observations
            .iter()
            .filter(|o| o.one_impact_in() == Some(1));
        let place = one
            .max_by(|a, b| {
                let sure = |o: &Observation| o.classification.confidence;
                sure(a).total_cmp(&sure(b))
            })
            .and_then(|o| {
                let x_st = scale.static_deflection_m * o.setting.drive_amplitude;
                let rho = o.setting.clearance_m? / x_st;
                Some((o.frequency_hz()? / scale.natural_frequency_hz, rho))
            });
        let middle = |r: (f64, f64)| 0.5 * (r.0 + r.1);
        let (eta, rho) = place.unwrap_or((middle(view.eta), middle(view.rho)));
        Cursor {
            eta: ETA.nearest(eta),
            rho: RHO.nearest(rho),
            ..State::default().cursor
        }
    }

    fn first_view(&self, scale: RigScale) -> FirstView {
        let rho = |clearance_m: f64, drive: f64| clearance_m / (scale.static_deflection_m * drive);
        let observed = &self.observed;
        let rows = observed.observations.iter().zip(&self.placed.records);
        let places = rows.filter_map(|(o, row)| {
            Some(Place {
                eta: o.frequency_hz()? / scale.natural_frequency_hz,
                rho: rho(o.setting.clearance_m?, o.setting.drive_amplitude),
                strikes: busy(&row.motion),
            })
        });
        let places: Vec<Place> = places.collect();
        let brackets = observed.brackets.iter();
        let brackets = brackets.map(|b| rho(b.clearance_m, b.drive_amplitude));
        FirstView::of(&places, brackets.collect())
    }

    /// Everything about the campaign that does not depend on the sliders.
    pub(super) fn facts(&self) -> Value {
        let observations = self.observed.observations.iter();
        let records: Vec<Value> = observations
            .zip(&self.placed.records)
            .map(|(o, row)| {
                let excluded = row.excluded.as_ref().map(|problem| typed(problem));
                json!({
                    "id": row.id,
                    "frequency_hz": row.frequency_hz,
                    "clearance_m": row.clearance_m,
                    "drive_amplitude": o.setting.drive_amplitude,
                    "sweep": row.sweep.name(),
                    "motion": MotionStyle::of(&row.motion),
                    "confidence": row.confidence,
                    "impacts": row.impacts,
                    "used_by": row.used_by.iter().map(ToString::to_string).collect::<Vec<_>>(),
                    "out": excluded.or(row.left_out.as_ref().map(ToString::to_string)),
                    "decay": !o.decays.is_empty(),
                })
            })
            .collect();
        let brackets = self.placed.brackets.iter().zip(&self.observed.brackets);
        let brackets: Vec<Value> = brackets
            .map(|(row, b)| {
                json!({
                    "kind": row.kind.name(),
                    "n": b.periods_n,
                    "motion": row.motion.label(),
                    "clearance_m": row.clearance_m,
                    "drive_amplitude": b.drive_amplitude,
                    "low_hz": row.frequency_low_hz,
                    "high_hz": row.frequency_high_hz,
                    "sweep": row.sweep.name(),
                    "records": b.records,
                    "out": row.left_out.as_ref().map(ToString::to_string),
                })
            })
            .collect();
        let curves = self.placed.curves.iter().map(|c| {
            json!({"kind": c.kind.name(), "n": c.periods_n, "points": c.points, "band": c.band95})
        });
        let scale = self.scale();
        let strips = self.first_view(scale).strips;
        let strips = strips.iter().map(|rho| rho * scale.static_deflection_m);
        let sentences = &self.identification.verdict.sentences;
        json!({
            "name": self.resolved.about.name,
            "synthetic": self.resolved.about.synthetic,
            "single": self.resolved.about.machine == RigKind::Single,
            "verdict": sentences.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "fit": self.identification.joint_fit.as_ref().map(|j| fitted(&j.fit.parameters)),
            "intervals": self.identification.joint.parameters,
            "records": records,
            "brackets": brackets,
            "curves": curves.collect::<Vec<_>>(),
            "strips_m": strips.collect::<Vec<_>>(),
        })
    }
}

/// With a second mass that differs from the first, which stays as it is: parameters are means over both masses, and
/// ratios of the first over the second per unit of mass.
fn unlike(of_first: Parameters, of_second: Asymmetry) -> Parameters {
    let Asymmetry {
        drive_amplitude,
        stiffness,
        mass,
    } = of_second;
    let mean = |of_second: f64| 0.5 * (1.0 + of_second);
    Parameters {
        natural_frequency_hz: of_first.natural_frequency_hz * (stiffness / mass).powf(0.25),
        damping_ratio: of_first.damping_ratio * mean(1.0 / (stiffness * mass).sqrt()),
        static_deflection_m: of_first.static_deflection_m * mean(drive_amplitude / stiffness),
        drive_asymmetry: of_first.drive_asymmetry + (mass / drive_amplitude).ln(),
        stiffness_asymmetry: of_first.stiffness_asymmetry + (mass / stiffness).ln(),
        damping_asymmetry: of_first.damping_asymmetry + mass.ln(),
        mass_asymmetry: of_first.mass_asymmetry - mass.ln(),
        ..of_first
    }
}

fn fitted(p: &Parameters) -> Value {
    json!({
        "restitution": p.restitution,
        "damping_ratio": p.damping_ratio,
        "natural_frequency_hz": p.natural_frequency_hz,
        "static_deflection_m": p.static_deflection_m,
    })
}

/// Inputs that are gone or differ from those that were identified from.
fn changed_inputs(resolved: &ResolvedCampaign, found: &IdentificationFile) -> Vec<String> {
    let now = inputs::hashes(resolved);
    let (mut gone, mut changed) = (Vec::new(), Vec::new());
    for (name, then) in &found.provenance.inputs_sha256 {
        match now.get(name).map(String::as_str) {
            Some(hash) if hash == then => {}
            None | Some("unreadable") => gone.push(name.as_str()),
            Some(_) => changed.push(name.as_str()),
        }
    }
    let folder = Path::new(".").join(resolved.folder());
    let folder = std::path::absolute(&folder).unwrap_or(folder);
    let gone = named(&gone).map(|names| {
        let folder = folder.display();
        format!("Not in {folder} any more: {names}. What was measured there cannot be shown.")
    });
    let changed =
        named(&changed).map(|names| format!("Changed since the campaign was identified: {names}."));
    gone.into_iter().chain(changed).collect()
}

/// The first of some names, and how many more there are; `None` of none.
fn named(names: &[&str]) -> Option<String> {
    let (first, more) = names.split_at(names.len().min(NAMED));
    let more = (!more.is_empty()).then(|| format!(" and {} more", more.len()));
    (!names.is_empty()).then(|| first.join(", ") + &more.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_oscillator::Machine;

    /// Both masses' natural frequency, damping ratio, static deflection and mass over the first mass' ones of the
    /// page: the same machine, however it is described.
    #[test]
    fn unlike_masses_are_those_of_the_map() {
        let (f0, beta, x_st) = (12.0, 0.05, 2e-3);
        let like = Parameters::symmetric(0.9, f0, beta, x_st);
        for (drive_amplitude, stiffness, mass) in [
            (1.0, 1.0, 1.0),
            (0.95, 1.0, 1.0),
            (1.0, 4.0, 1.0),
            (0.7, 0.8, 1.7),
        ] {
            let asymmetry = Asymmetry {
                drive_amplitude,
                stiffness,
                mass,
            };
            let wanted = Machine::asymmetric(beta, 0.9, asymmetry);
            let found = unlike(like, asymmetry);
            let machine = found.machine(RigKind::Double);
            let pairs = [
                (&machine.x, &wanted.x),
                (machine.y.as_ref().unwrap(), wanted.y.as_ref().unwrap()),
            ];
            for (of_fit, of_map) in pairs {
                let deflection = |o: &impact_oscillator::model::params::Oscillator| {
                    o.drive_amplitude / (o.mass * o.natural_frequency_ratio.powi(2))
                };
                let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b, "{a} {b}");
                near(
                    found.natural_frequency_hz * of_fit.natural_frequency_ratio,
                    f0 * of_map.natural_frequency_ratio,
                );
                near(of_fit.damping_ratio, of_map.damping_ratio);
                near(
                    found.static_deflection_m * deflection(of_fit),
                    x_st * deflection(of_map),
                );
                near(of_fit.mass / machine.x.mass, of_map.mass);
            }
        }
    }
}
