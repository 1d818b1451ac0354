//! Parameters that a campaign asks for and no method tells: each gets the reason instead of a value.

use impact_fit::estimate::not_identifiable;
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::messages::Note;
use impact_fit::methods::answer::MethodResult;
use impact_fit::parameters::Coordinate;
use impact_records::event::{FlightKind, RigKind};
use impact_records::motion::Observation;
use impact_records::record::Excitation;

/// Give each parameter that a campaign asks for, and that its joint result lacks, the reason why. A result
/// without any parameter stays empty: then nothing was usable.
pub fn say_missing(joint: &mut MethodResult, evidence: &Evidence<'_>) {
    let told = |c: Coordinate| joint.parameters.get(c).is_some();
    if !Coordinate::PHYSICAL.into_iter().any(told) {
        return;
    }
    let all = evidence.observations.iter();
    let observations: Vec<&Observation> = all.filter(|o| !o.excluded()).collect();
    for parameter in asked(evidence, &observations) {
        if let Some(slot) = joint.parameters.slot(parameter)
            && slot.is_none()
        {
            *slot = Some(not_identifiable(why(
                parameter,
                &observations,
                &evidence.nominal,
            )));
        }
    }
}

/// The parameters that records can be asked for: those of springs and drive where any record is a driven
/// one, R where masses may touch.
fn asked(evidence: &Evidence<'_>, observations: &[&Observation]) -> Vec<Coordinate> {
    let harmonic = |o: &&&Observation| o.setting.excitation == Excitation::Harmonic;
    let driven: Vec<&&Observation> = observations.iter().filter(harmonic).collect();
    if evidence.nominal.flight == FlightKind::ConstantForce || driven.is_empty() {
        return Vec::new();
    }
    let touches = |o: &&&Observation| o.setting.clearance_m.is_some() || !o.impacts.is_empty();
    let may_touch = evidence.rig == RigKind::Double || driven.iter().any(touches);
    let others = [
        Coordinate::Frequency,
        Coordinate::Damping,
        Coordinate::Deflection,
    ];
    let r = may_touch.then_some(Coordinate::Restitution);
    r.into_iter().chain(others).collect()
}

/// Why a parameter is missing. Without an impactless record or nominal values the fits of motions with impacts start
/// from a guess.
fn why(parameter: Coordinate, observations: &[&Observation], nominal: &Nominal) -> Note {
    let any = |of: &dyn Fn(&Observation) -> bool| observations.iter().any(|o| of(o));
    if parameter == Coordinate::Restitution {
        return if any(&|o| !o.impacts.is_empty()) {
            Note::NotDetermined { parameter }
        } else {
            Note::WithoutImpact
        };
    }
    let stated = nominal.natural_frequency_hz.is_some() && nominal.static_deflection_m.is_some();
    if !stated && any(&|o| o.drive.is_some()) && !any(&|o| !o.response.is_empty()) {
        Note::GuessedStart
    } else if any(&|o| o.frequency_hz().is_some()) {
        Note::NotDetermined { parameter }
    } else {
        Note::NoFrequency
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::Status;
    use impact_fit::estimate::estimate;
    use impact_records::event::{DriveTone, Impact};
    use impact_records::motion::Motion;

    /// What records are asked for beside the one parameter that they told.
    fn missing(told: Coordinate, observations: &[Observation], rig: RigKind) -> MethodResult {
        let mut joint = MethodResult::default();
        if let Some(slot) = joint.parameters.slot(told) {
            *slot = Some(estimate(told, 0.5, 1e-3));
        }
        let evidence = Evidence {
            rig,
            observations,
            brackets: &[],
            nominal: Nominal::default(),
            uncertainty: Default::default(),
            progress: None,
        };
        say_missing(&mut joint, &evidence);
        joint
    }

    #[test]
    fn what_no_record_tells_is_missing_with_the_reason() {
        let without_impacts = [Observation::of("r", 12.0, Motion::Impactless)];
        let found = missing(Coordinate::Frequency, &without_impacts, RigKind::Double);
        let r = found.parameters.restitution.expect("R is asked for");
        assert_eq!(
            (r.status, r.note),
            (Status::NotIdentifiable, Some(Note::WithoutImpact))
        );
        // a stated frequency, but nothing that shows the damping
        let parameter = Coordinate::Damping;
        let damping = found.parameters.damping_ratio.expect("β is asked for");
        assert_eq!(damping.note, Some(Note::NotDetermined { parameter }));
        let mut alone = Observation::of("r", 12.0, Motion::Impactless);
        alone.setting.stated_frequency_hz = None;
        alone.impacts = vec![Impact::at(0.1, 1.0)];
        let found = missing(Coordinate::Restitution, &[alone], RigKind::Double);
        let f0 = found
            .parameters
            .natural_frequency_hz
            .expect("f0 is asked for");
        assert_eq!(f0.note, Some(Note::NoFrequency));
        let mut driven = Observation::of("r", 12.0, Motion::Chaotic);
        driven.impacts = vec![Impact::at(0.1, 1.0)];
        driven.drive = Some(DriveTone::at(12.0, 1.0));
        let found = missing(Coordinate::Restitution, &[driven], RigKind::Double);
        let f0 = found
            .parameters
            .natural_frequency_hz
            .expect("f0 is asked for");
        assert_eq!(f0.note, Some(Note::GuessedStart));
    }

    #[test]
    fn r_is_not_asked_of_a_spring_alone_nor_a_drive_of_decays() {
        let mut spring = Observation::of("r", 12.0, Motion::Impactless);
        spring.setting.clearance_m = None;
        let alone = std::slice::from_ref(&spring);
        let found = missing(Coordinate::Frequency, alone, RigKind::Single);
        assert_eq!(found.parameters.restitution, None);
        assert!(found.parameters.damping_ratio.is_some());
        spring.setting.excitation = Excitation::FreeDecay;
        let found = missing(Coordinate::Frequency, &[spring], RigKind::Double);
        assert_eq!(found.parameters.damping_ratio, None);
    }
}
