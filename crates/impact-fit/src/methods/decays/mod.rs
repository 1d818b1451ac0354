//! Free decays: f0 and β of each, pooled, and records that are filed under the wrong name.

mod beside;
mod dry_friction;
mod mains;

use std::collections::BTreeMap;

use crate::estimate::{self, Estimate, Status};
use crate::messages::{DampingPoint, Item, LeftOut, Note, Reason, Remark};
use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::decays::dry_friction::{CHANGES, Shared};
use crate::methods::fits::Fits;
use crate::methods::identifier::Identifier;
use crate::methods::selection::Selection;
use crate::parameters::Coordinate;
use crate::parameters::effect::{Effect, Effects};
use crate::statistics::quantile::{NORMAL_975, student_975};
use crate::statistics::scatter::Spread;
use crate::statistics::weighted::{self, Measured};
use impact_records::motion::Observation;
use impact_records::signal::decay::{
    DampingLaw, Decay, Drift, LEAST_TESTED, PartOfDecay, RESOLVED,
};
use impact_records::signal::robust;

/// Free decays.
pub struct FreeDecays;

impl Identifier for FreeDecays {
    fn method(&self) -> Method {
        Method::FreeDecay
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.observed(|o| !o.excluded() && !o.decays.is_empty())
    }

    fn result(&self, selection: &Selection<'_>, _: &Fits) -> Option<MethodResult> {
        pooled(
            selection.evidence.observations,
            selection.evidence.nominal.effects,
        )
    }
}

/// Relative spread of f0 from which decays are not of one oscillator.
const ONE_OSCILLATOR: f64 = 0.02;
/// Relative difference of f0 from its own group's from which a record is looked at.
const STRANGE: f64 = 0.05;
/// Share of the signal that is neither the fitted decay nor noise from which a decay does not fit.
const STRUCTURE: f64 = 0.15;
/// The same of what fades with the decay, so that it is of the motion.
const FADING_STRUCTURE: f64 = 0.05;
/// Ratio of the residual at the beginning to that at the end from which it fades.
const FADES: f64 = 3.0;
/// The same from which the frequency is none.
const DRIFTS: f64 = 5.0;
/// Relative change of the frequency along a decay that matters.
const FREQUENCY_MATTERS: f64 = 1e-3;
/// Drift from which a decay has no single frequency, in half widths of its 95 % interval.
const NO_SINGLE: f64 = 5.0;
/// Relative range of the damping ratio along a decay that matters.
const DAMPING_MATTERS: f64 = 0.15;
/// Difference of the damping ratios of two decays, over the greater one, that is none of one oscillator, and in standard
/// errors: of the furthest two of some, by chance one in a hundred thousand is.
const UNLIKE_DAMPINGS: f64 = 0.2;
const SURELY_UNLIKE: f64 = 6.0;

/// All free decays of a campaign, pooled; `None` without any. Dry friction is possible if the effects that the rig may
/// have hold it, or if the decays show it.
pub fn pooled(observations: &[Observation], effects: Effects) -> Option<MethodResult> {
    let used = observations.iter().filter(|o| !o.excluded());
    let records = used.clone().filter(|o| !o.decays.is_empty()).count();
    let decays: Vec<&Decay> = used.flat_map(|o| &o.decays).collect();
    if decays.is_empty() {
        return None;
    }
    let shared = Shared::of(&decays);
    let may_have = |effect: Effect| effects.iter().any(|e| e == effect);
    let possible = may_have(Effect::Friction);
    let shared = shared.with_drag(may_have(Effect::Drag));
    let shared = Some(shared).filter(|s| possible || s.is_told());
    let frequencies: Vec<Measured> = decays
        .iter()
        .map(|d| match shared {
            Some(_) => frequency_beside_friction(d),
            None => frequency(d),
        })
        .collect();
    let mut result = MethodResult {
        observations: decays.iter().map(|d| d.samples).sum(),
        records,
        ..MethodResult::default()
    };
    let weights = weighted::by_errors(&frequencies);
    let (f, spread) = weighted::mean(&frequencies, &weights);
    let mut found = estimate::estimate_within(Coordinate::Frequency, f, spread, None);
    if shared.is_some() {
        let beyond = dry_friction::open(&decays, &weights, |o| o.natural_frequency);
        found = reaching(found, beyond, spread);
    }
    result.parameters.natural_frequency_hz = Some(found);
    let longest = decays.iter().map(|d| d.periods).fold(0.0, f64::max);
    result.parameters.damping_ratio = Some(match shared {
        Some(shared) => shared.estimate(longest),
        None => damping_estimate(&decays),
    });
    let rubbed_later = shared.and_then(|_| rubbed_later(&decays));
    result
        .remarks
        .extend(rubbed_later.or_else(|| shared?.remark()));
    let apart = frequencies.iter().map(|p| (p.value - f).abs());
    let apart = apart.fold(0.0, f64::max);
    judge(&mut result, &decays, (apart, shared.is_some()));
    if !shared.is_some_and(|s| s.is_told()) {
        judge_dampings(&mut result, &decays);
    }
    if let Some(periods) = too_short(&decays) {
        leave_weak(&mut result, Note::FewPeriods { periods });
    }
    if are_most(&decays, &may_be_forced, &Decay::relative_error) {
        leave_weak(&mut result, Note::MayBeForced);
    }
    if are_most(&decays, &beside::has_rival, &Decay::relative_error) {
        leave_weak(&mut result, Note::NotOneOscillation);
    }
    if let Some(mains_hz) = hums(&decays) {
        leave_weak(&mut result, Note::MayBeHum { mains_hz });
    }
    let fits = result.fits == Some(true);
    result.remarks.extend(stopped(&decays));
    result.remarks.extend(beside::remarks(&decays, fits));
    Some(result)
}

/// ln f0 of a viscous decay.
fn frequency(decay: &Decay) -> Measured {
    let found = decay.natural_frequency_hz;
    let error = decay.natural_frequency_error_hz;
    logarithm(decay, found, error)
}

/// ln f0 of a decay under viscous damping and dry friction.
fn frequency_beside_friction(decay: &Decay) -> Measured {
    let Some(found) = decay.beside_friction else {
        return frequency(decay);
    };
    let error = found.natural_frequency_error_hz;
    logarithm(decay, found.natural_frequency_hz, error)
}

/// The logarithm of a frequency of a decay, which drifts.
fn logarithm(decay: &Decay, frequency_hz: f64, error_hz: f64) -> Measured {
    Measured {
        value: frequency_hz.ln(),
        error: error_hz
            .hypot(drift_error_hz(decay))
            .hypot(undamped_error_hz(decay))
            / frequency_hz,
        freedom: decay.freedom,
    }
}

/// What damping that is not viscous leaves open of f0, Hz: drag does not lower the frequency as viscous damping of the same
/// loss does.
fn undamped_error_hz(decay: &Decay) -> f64 {
    let changes = decay.course.damping_z_score > CHANGES;
    if !changes || decay.course.law == DampingLaw::Friction {
        return 0.0;
    }
    let lowered = 1.0 - (1.0 - decay.damping_ratio.powi(2)).max(0.0).sqrt();
    lowered * decay.natural_frequency_hz
}

/// f0 whose interval reaches further below and above, relative; its standard error is that of an interval of this width.
fn reaching(mut estimate: Estimate, [below, above]: [f64; 2], spread: Spread) -> Estimate {
    let (Some(value), Some([low, high])) = (estimate.value, estimate.interval95) else {
        return estimate;
    };
    if below.max(above) == 0.0 {
        return estimate;
    }
    let (low, high) = (low * (1.0 - below), high * (1.0 + above));
    let half = 0.5 * (high - low);
    let error = half / student_975(spread.freedom);
    estimate.interval95 = Some([low, high]);
    estimate.standard_error = Some(error);
    if half >= estimate::limits(Coordinate::Frequency).0 * value {
        estimate.doubt(Note::Open {
            parameter: Coordinate::Frequency,
            standard_error: error / value,
        });
    }
    estimate
}

/// Periods of the motion in a decay, which may stick before the decay is over.
fn moving(decay: &Decay) -> f64 {
    let rubbed = decay.beside_friction.filter(|b| b.sticks);
    rubbed.map_or(decay.periods, |b| b.periods)
}

/// Periods of the longest of decays that all were cut off, or stuck, too early for a test whether they are viscous; `None`
/// if one was not.
fn too_short(decays: &[&Decay]) -> Option<f64> {
    let sticks = |d: &&Decay| d.beside_friction.is_some_and(|b| b.sticks);
    let cut_off = |d: &&Decay| {
        let turns = std::f64::consts::TAU * d.periods;
        d.periods < LEAST_TESTED && (-d.damping_ratio * turns).exp() > RESOLVED
    };
    let longest = decays.iter().map(|d| moving(d)).fold(0.0, f64::max);
    let short = |d: &&Decay| cut_off(d) || (sticks(d) && moving(d) < LEAST_TESTED);
    decays.iter().all(short).then_some(longest)
}

/// The mains' frequency, Hz, of which most of what is known of f0 may be a hum.
fn hums(decays: &[&Decay]) -> Option<f64> {
    let of_hum = |d: &Decay| mains::hum_of(d).is_some();
    let all = decays.iter().find_map(|d| mains::hum_of(d));
    all.filter(|_| are_most(decays, &of_hum, &Decay::relative_error))
}

/// Greatest excursion before an undamped motion, over its amplitude, from which another motion went before it.
const ANOTHER: f64 = 1.5;

/// Whether a motion does not decay, and another does beside it or before it.
fn may_be_forced(decay: &Decay) -> bool {
    let beside = decay.beside.mode.is_some() || decay.beside.beat.is_some();
    decay.is_undamped() && (beside || decay.before > ANOTHER)
}

/// Whether most of what decays tell of a quantity, by its errors, is told by some of them.
fn are_most(
    decays: &[&Decay],
    some: &dyn Fn(&Decay) -> bool,
    error: &dyn Fn(&Decay) -> f64,
) -> bool {
    let information = |d: &&&Decay| error(d).max(f64::MIN_POSITIVE.sqrt()).powi(-2);
    let all: f64 = decays.iter().map(|d| information(&d)).sum();
    let of_some = decays.iter().filter(|d| some(d));
    2.0 * of_some.map(|d| information(&d)).sum::<f64>() > all
}

/// Decays in which dry friction begins on the way, if they are most of what is known of β.
fn rubbed_later(decays: &[&Decay]) -> Option<Remark> {
    let begins = |d: &Decay| d.beside_friction.and_then(|b| b.begins);
    let all: Vec<f64> = decays.iter().filter_map(|d| begins(d)).collect();
    let most = are_most(decays, &|d| begins(d).is_some(), &|d| d.damping_ratio_error);
    Some(Remark::DecaysRubbedLater {
        count: all.len(),
        periods: *all.first().filter(|_| most)?,
    })
}

/// Decays that a hand ended.
fn stopped(decays: &[&Decay]) -> Option<Remark> {
    let all: Vec<f64> = decays.iter().filter_map(|d| d.stopped_s).collect();
    Some(Remark::DecaysStopped {
        count: all.len(),
        seconds: *all.first()?,
    })
}

/// Whether an error leaves a damping ratio more open than an identified one.
fn is_open(value: f64, error: f64) -> bool {
    error > estimate::limits(Coordinate::Damping).0 * value
}

/// Make f0 and β weak for a reason, if they are no weaker.
fn leave_weak(result: &mut MethodResult, why: Note) {
    let parameters = &mut result.parameters;
    let both = [
        &mut parameters.natural_frequency_hz,
        &mut parameters.damping_ratio,
    ];
    for estimate in both.into_iter().flatten() {
        estimate.doubt(why.clone());
    }
}

/// β of viscous decays with its interval, which begins at zero where an undamped motion is within it.
fn damping_estimate(decays: &[&Decay]) -> Estimate {
    let measured = |d: &&Decay| Measured {
        value: d.damping_ratio,
        error: d.damping_ratio_error,
        freedom: d.freedom,
    };
    let dampings: Vec<Measured> = decays.iter().map(measured).collect();
    let (value, spread) = weighted::mean(&dampings, &weighted::by_errors(&dampings));
    let half = spread.half95();
    let most = spread.upper_end(value, value + half);
    let undamped = value <= half;
    let status = if undamped || is_open(value, spread.error) {
        Status::Weak
    } else {
        Status::Identified
    };
    Estimate {
        value: Some(value.max(0.0)),
        standard_error: Some(spread.error),
        interval95: Some([(value - half).max(0.0), most]),
        status,
        note: undamped.then_some(Note::Undamped { most }),
    }
}

/// Judge whether the decays are of one linear oscillator: by what their residuals have beside noise,
/// not by the size of the noise, and by what changes along them.
fn judge(result: &mut MethodResult, decays: &[&Decay], (spread, friction): (f64, bool)) {
    let median = |of: &dyn Fn(&Decay) -> f64| {
        robust::median(&decays.iter().map(|d| of(d)).collect::<Vec<_>>()).unwrap_or(0.0)
    };
    if spread > ONE_OSCILLATOR {
        result.fits = Some(false);
        result.remarks.push(Remark::DecaysDiffer { spread });
    }
    let share = median(&|d| d.residual_ratio);
    let structure = median(&beyond_chance);
    let fades = median(&|d| d.fading) > FADES;
    let plain = structure < if fades { FADING_STRUCTURE } else { STRUCTURE };
    let damping_changes = judge_damping(result, decays, friction);
    let frequency_changes = judge_frequency(result, decays);
    // what changes along a decay is the structure that it leaves
    let told = plain || damping_changes || frequency_changes;
    let fits = result.fits != Some(false) && plain && !damping_changes && !frequency_changes;
    result.fits = Some(fits);
    let of_residuals = if told {
        Remark::DecaysUnexplained { share, structure }
    } else {
        Remark::DecaysHaveStructure { share, structure }
    };
    result.remarks.insert(0, of_residuals);
    if fits {
        return;
    }
    let beats = beside::beat(decays);
    if !told || beats.is_some() {
        let periods = median(&|d| d.periods);
        allow_for_another(result, structure, periods);
    }
    result.remarks.extend(beats);
}

/// Whether the decays are of one damping ratio, where it does not change along them.
fn judge_dampings(result: &mut MethodResult, decays: &[&Decay]) {
    let changes = |r: &Remark| matches!(r, Remark::DecaysDamping { .. });
    if result.remarks.iter().any(changes) {
        return;
    }
    let estimate = result.parameters.damping_ratio.as_mut();
    let Some((estimate, [low, high])) = estimate.zip(unlike_dampings(decays)) else {
        return;
    };
    estimate.weaken(Note::DampingsDiffer);
    if let Some(interval) = &mut estimate.interval95 {
        *interval = [interval[0].min(low), interval[1].max(high)];
    }
    result.fits = Some(false);
    let of_several = |r: &Remark| matches!(r, Remark::DecaysDiffer { .. });
    if !result.remarks.iter().any(of_several) {
        let differ = Remark::DecaysDampingDiffers { low, high };
        result.remarks.push(differ);
    }
}

/// The least and the greatest damping ratio of decays of which two differ by more than their errors, and by an amount that
/// is none of one oscillator.
fn unlike_dampings(decays: &[&Decay]) -> Option<[f64; 2]> {
    let by_value = |a: &&&Decay, b: &&&Decay| a.damping_ratio.total_cmp(&b.damping_ratio);
    let least = decays.iter().min_by(by_value)?;
    let most = decays.iter().max_by(by_value)?;
    let apart = most.damping_ratio - least.damping_ratio;
    let error = most.damping_ratio_error.hypot(least.damping_ratio_error);
    let unlike = apart > UNLIKE_DAMPINGS * most.damping_ratio && apart > SURELY_UNLIKE * error;
    unlike.then_some([least.damping_ratio, most.damping_ratio])
}

/// Widen the intervals by what an oscillation that decays leave, of a share of them and of a frequency near theirs, moves
/// their rates: a phase that is off by s at random over a time T is a line whose slope is off by √12 s/T.
fn allow_for_another(result: &mut MethodResult, share: f64, periods: f64) {
    let off = 12f64.sqrt() * share / (std::f64::consts::TAU * periods.max(1.0));
    let widen = |estimate: &mut Option<Estimate>, more: f64| {
        if let Some([low, high]) = estimate.as_mut().and_then(|e| e.interval95.as_mut()) {
            *low = (*low - more).max(0.0);
            *high += more;
        }
    };
    let parameters = &mut result.parameters;
    let frequency = &mut parameters.natural_frequency_hz;
    let hz = frequency.as_ref().and_then(|e| e.value).unwrap_or(0.0);
    widen(frequency, NORMAL_975 * off * hz);
    widen(&mut parameters.damping_ratio, NORMAL_975 * off);
    leave_weak(result, Note::NotOneOscillation);
}

/// What neighbouring samples share of a residual over the decay, if white noise does not show as much by chance: their mean
/// product scatters by its variance over the root of the number of samples.
fn beyond_chance(decay: &Decay) -> f64 {
    let by_chance = (CHANGES / (decay.samples.max(1) as f64).sqrt()).sqrt();
    let is_told = decay.structured_ratio > by_chance * decay.residual_ratio;
    if is_told { decay.structured_ratio } else { 0.0 }
}

/// Whether one damping ratio does not hold along most of the decays, beside dry friction where β is without it.
fn judge_damping(result: &mut MethodResult, decays: &[&Decay], friction: bool) -> bool {
    let range = |d: &Decay| {
        let [low, high] = d.course.damping_range?;
        let sure = d.course.damping_z_score > CHANGES && d.course.parts.len() > 1;
        sure.then_some([low, high])
    };
    let changing: Vec<(&Decay, [f64; 2])> = decays
        .iter()
        .filter_map(|d| Some((*d, range(d)?)))
        .collect();
    let Some(estimate) = &mut result.parameters.damping_ratio else {
        return false;
    };
    let matters = |(d, [low, high]): &(&Decay, [f64; 2])| {
        high - low > DAMPING_MATTERS * d.damping_ratio.abs()
    };
    let explained = |d: &Decay| friction && d.course.law == DampingLaw::Friction;
    if let Some([low, high]) = &mut estimate.interval95 {
        for (d, [least, most]) in changing.iter().filter(|c| !explained(c.0)) {
            let half = NORMAL_975 * d.damping_ratio_error;
            *low = low.min(least - half).max(0.0);
            *high = high.max(most + half);
        }
    }
    // what changes along a decay widened it
    let widened = estimate.value.zip(estimate.interval95);
    let is_widened = changing.iter().any(|c| !explained(c.0));
    let is_open =
        widened.is_some_and(|(value, [low, high])| is_open(value, 0.5 * (high - low) / NORMAL_975));
    if is_widened && is_open {
        estimate.doubt(Note::DampingChanges);
    }
    let telling: Vec<(&Decay, [f64; 2])> = changing.into_iter().filter(matters).collect();
    let width = |(d, [low, high]): &&(&Decay, [f64; 2])| (high - low) / d.damping_ratio.abs();
    let Some((worst, _)) = telling.iter().max_by(|a, b| width(a).total_cmp(&width(b))) else {
        return false;
    };
    result.remarks.push(Remark::DecaysDamping {
        count: telling.len(),
        points: DampingPoint::of(&worst.course.parts),
        law: worst.course.law,
    });
    let changes = |d: &Decay| {
        telling
            .iter()
            .any(|c| std::ptr::eq(c.0, d) && !explained(d))
    };
    let most = are_most(decays, &changes, &|d| d.damping_ratio_error);
    if most {
        estimate.weaken(Note::DampingChanges);
    }
    most
}

/// Whether one frequency does not hold along most of the decays.
fn judge_frequency(result: &mut MethodResult, decays: &[&Decay]) -> bool {
    let sure = |d: &&&Decay| d.course.drift.is_some_and(|d| d.z_score().abs() > DRIFTS);
    let drifting: Vec<&Decay> = decays.iter().filter(sure).copied().collect();
    let half = |d: &Decay| NORMAL_975 * d.natural_frequency_error_hz;
    let change = |d: &Decay| d.course.drift.map_or(0.0, |d| d.last_hz - d.first_hz);
    let matters = |d: &&Decay| {
        let change = change(d).abs();
        change > NO_SINGLE * half(d) && change > FREQUENCY_MATTERS * d.natural_frequency_hz
    };
    let drifting: Vec<&Decay> = drifting.into_iter().filter(matters).collect();
    let worst = drifting
        .iter()
        .max_by(|a, b| change(a).abs().total_cmp(&change(b).abs()));
    let Some((worst, drift)) = worst.and_then(|d| Some((d, d.course.drift?))) else {
        return false;
    };
    result.remarks.push(Remark::DecaysDrift {
        count: drifting.len(),
        first_hz: drift.first_hz,
        last_hz: drift.last_hz,
        intervals: change(worst).abs() / half(worst).max(f64::MIN_POSITIVE),
    });
    let drifts = |d: &Decay| drifting.iter().any(|own| std::ptr::eq(*own, d));
    let most = are_most(decays, &drifts, &Decay::relative_error);
    if most && let Some(estimate) = &mut result.parameters.natural_frequency_hz {
        estimate.weaken(Note::Drifts);
    }
    most
}

/// Whether the frequency of a decay drifts significantly.
fn drifts(decay: &Decay) -> bool {
    let drift = decay.course.drift;
    drift.is_some_and(|d| d.z_score().abs() > CHANGES)
}

/// What is left of the squared amplitude from which on it hardly falls: nine tenths of the amplitude.
const HARDLY_FALLS: f64 = 0.81;

/// What a significant drift leaves open of the frequency, Hz: it is anywhere between that at the beginning and that at
/// rest, and the standard error is that of an interval that reaches the farther one.
fn drift_error_hz(decay: &Decay) -> f64 {
    let course = &decay.course;
    let Some(drift) = course.drift.filter(|_| drifts(decay)) else {
        return 0.0;
    };
    let ends = [
        drift.first_hz,
        drift.last_hz,
        at_rest_hz(&drift, &course.parts),
    ];
    let distances = ends.map(|end| (end - decay.natural_frequency_hz).abs());
    distances.into_iter().fold(0.0, f64::max) / NORMAL_975
}

/// The frequency toward which a drift leads as the motion dies away, Hz, if it goes with the square of the amplitude, as
/// that of a pendulum and of springs that harden does; that of the last quarter where the amplitude hardly
/// falls, so that the drift has another cause, or is not known.
fn at_rest_hz(drift: &Drift, parts: &[PartOfDecay]) -> f64 {
    let [Some(first), Some(last)] = [parts.first(), parts.last()].map(|p| p.map(|p| p.amplitude))
    else {
        return drift.last_hz;
    };
    // the middles of the first and the last part on the line through those of the quarters
    let middle = 0.5 / parts.len() as f64;
    let per_length_hz = (drift.last_hz - drift.first_hz) / 0.75;
    let last_hz = drift.last_hz + per_length_hz * (0.125 - middle);
    let between_hz = per_length_hz * (1.0 - 2.0 * middle);
    let left = (last / first).powi(2);
    if left > HARDLY_FALLS {
        return drift.last_hz;
    }
    last_hz + between_hz * left / (1.0 - left)
}

/// Records whose natural frequency is not that of their specimen but that of another.
pub fn misfiled(observations: &[Observation]) -> Vec<LeftOut> {
    let mut groups: BTreeMap<&str, Vec<(usize, f64)>> = BTreeMap::new();
    for (index, o) in observations.iter().enumerate() {
        if let (Some(specimen), Some(decay)) = (&o.setting.specimen, o.best_decay()) {
            let group = groups.entry(specimen).or_default();
            group.push((index, decay.natural_frequency_hz));
        }
    }
    let centres: BTreeMap<&str, f64> = groups
        .iter()
        .filter_map(|(name, members)| {
            let f: Vec<f64> = members.iter().map(|m| m.1).collect();
            Some((*name, robust::median(&f)?))
        })
        .collect();
    let mut out = Vec::new();
    for (name, members) in &groups {
        for (index, f) in members {
            let own = centres[name];
            if members.len() < 3 || (f / own - 1.0).abs() < STRANGE {
                continue;
            }
            let other = centres
                .iter()
                .filter(|(other, _)| *other != name)
                .min_by(|a, b| (a.1 / f - 1.0).abs().total_cmp(&(b.1 / f - 1.0).abs()))
                .filter(|(_, centre)| (*centre / f - 1.0).abs() < 0.5 * STRANGE);
            out.push(LeftOut {
                item: Item::Record {
                    index: *index,
                    record: observations[*index].record.clone(),
                },
                reason: match other {
                    Some((like, like_hz)) => Reason::MisfiledLike {
                        specimen: (*name).to_owned(),
                        specimen_hz: own,
                        frequency_hz: *f,
                        like: (*like).to_owned(),
                        like_hz: *like_hz,
                    },
                    None => Reason::Misfiled {
                        specimen: (*name).to_owned(),
                        specimen_hz: own,
                        frequency_hz: *f,
                    },
                },
            });
        }
    }
    out
}

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod statuses;
