//! The whole identification: each method alone, all together, and what to make of it.

use std::collections::{BTreeMap, BTreeSet};

use crate::identify::answer::{Allowed, JointFit, MethodResult};
use crate::identify::diagnostics::agreement::{
    agreement, between_methods, carried_on, which_restitution,
};
use crate::identify::diagnostics::beyond;
use crate::identify::diagnostics::change::{self, Change};
use crate::identify::diagnostics::clock;
use crate::identify::diagnostics::contradicting_gap::contradicting_gap;
use crate::identify::diagnostics::doubt::{self, Doubt, Suspicion};
use crate::identify::diagnostics::late_channel;
use crate::identify::diagnostics::missing;
use crate::identify::diagnostics::momentum;
use crate::identify::diagnostics::settling;
use crate::identify::diagnostics::stated_clearances;
use crate::identify::diagnostics::stated_frequencies;
use crate::identify::diagnostics::suspicion::{self, OddGap};
use crate::identify::diagnostics::swapped_channels;
use crate::identify::diagnostics::undeclared_high_pass;
use crate::identify::diagnostics::undeclared_low_pass::{self, Refiltered};
use crate::identify::diagnostics::verdict::{self, Basis};
use crate::identify::diagnostics::wrong_gains;
use crate::identify::estimate::ParameterSet;
use crate::identify::evidence::contact_law;
use crate::identify::evidence::{Blocks, Evidence, Nominal, impact_bias};
use crate::identify::first_values::{start, with_restitution};
use crate::identify::identification::Identification;
use crate::identify::joint::{self, Weights};
use crate::identify::messages::cause::Cause;
use crate::identify::messages::{Finding, Item, LeftOut, Reason, Remark};
use crate::identify::method::Method;
use crate::identify::method_fit::MethodFit;
use crate::identify::methods::{self, FitResult, succeeded};
use crate::identify::parameters::effect::{Effect, EffectKind};
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::residuals::MethodResiduals;
use crate::identify::selection::Selection;
use crate::identify::solver::{Fit, Precision, Problem};
use crate::identify::uncertainty::budget::{self, Further, UncertaintySource};
use crate::identify::uncertainty::posterior::{self, Posterior};
use crate::identify::uncertainty::surroundings::Surroundings;
use crate::identify::uncertainty::{self, Uncertainty};
use crate::identify::{decay, estimate, flight_times, residuals, results};

/// Identify from observations and brackets, as records of one specimen.
///
/// What cannot be identified has no value but a note; what was left out of the fits is in `left_out`.
/// The example of the crate identifies a simulated campaign.
pub fn identify(evidence: &Evidence<'_>) -> Identification {
    match behind_low_pass(evidence) {
        Some(refiltered) => identify_as_stated(&refiltered.evidence(evidence)),
        None => identify_as_stated(evidence),
    }
}

/// The evidence behind the low-pass that fits its waveforms best, where one was found that is not stated.
fn behind_low_pass(evidence: &Evidence<'_>) -> Option<Refiltered> {
    let channels = undeclared_low_pass::filtered(evidence);
    if channels.is_empty() {
        return None;
    }
    let mut selection = Selection::new(evidence);
    let resonance = selection.resonance();
    let found = selection.trajectories(start(evidence, &resonance))?.ok()?;
    let fitted = found.fit.parameters.ideal();
    let records = &selection.blocks.trajectory.records;
    let kept: BTreeSet<usize> = records.iter().map(|r| r.observation).collect();
    let both = Weights::from([(Method::Resonance, 1.0), (Method::Trajectories, 1.0)]);
    let fit = |evidence: &Evidence<'_>| {
        let begin = evidence.nominal.applied(fitted);
        let mut blocks = Blocks::new(evidence);
        blocks
            .trajectory
            .records
            .retain(|r| kept.contains(&r.observation));
        blocks.allow_least(&begin);
        let simple = Nominal {
            effects: evidence.nominal.effects.without(EffectKind::ForceFrequency),
            ..evidence.nominal
        };
        let fitted = |nominal: &Nominal| rough_fit(&blocks, begin, &both, nominal);
        let open = fitted(&evidence.nominal)?;
        Some(undeclared_low_pass::Costs {
            open: open.cost,
            simple: fitted(&simple)?.cost,
            residuals: open.residuals,
        })
    };
    undeclared_low_pass::settled(evidence, &channels, &fit)
}

/// The same where all filters are known.
fn identify_as_stated(evidence: &Evidence<'_>) -> Identification {
    let mut run = IdentificationRun {
        evidence,
        selection: Selection::new(evidence),
        posterior: None,
    };
    let resonance = run.selection.resonance();
    let fitted = succeeded(&resonance).map(|f| &f.fit.parameters);
    if let Some(contradicted) = fitted.and_then(|f| stated_clearances::contradicted(evidence, f)) {
        return without_clearances(evidence, contradicted);
    }
    let start = start(evidence, &resonance);
    let impacts = methods::impacts(&run.selection.blocks, &evidence.nominal, start);
    let start = with_restitution(start, &impacts, &run.selection.blocks.impact);
    let mut fits = run.fits(start, resonance, impacts);
    let mut odd_gaps: Vec<Suspicion> = Vec::new();
    while let Some(odd) = run.odd_gap(&fits, start, odd_gaps.len()) {
        odd_gaps.push(Finding::from(odd).into());
        if !run.selection.leave_out_gap(odd.stated_m) {
            break;
        }
        fits = run.fits(start, fits.alone.resonance, fits.alone.impacts);
    }
    fits = run.refined(start, fits);
    let (mut suspicions, doubts) = doubt::parted(run.suspicions(&fits, odd_gaps));
    let mut methods = run.results(&fits);
    let mut joint = results::joint(evidence, fits.joint.as_ref(), &methods);
    if observations_are_undriven(evidence) {
        results::widen_common(&mut joint, &run.selection.blocks.impact);
    }
    verdict::carry_over(&mut joint, &methods);
    let over_speed = widen_over_speed(&mut methods, &mut joint);
    let beyond = succeeded(&fits.joint).map_or_else(Vec::new, beyond::beyond);
    let of_joint = succeeded(&fits.joint).map(|f| &f.fit.parameters);
    let ideal = beyond.is_empty() && of_joint.is_none_or(|p| run.is_on_time(p));
    if !ideal {
        widen_ideal(&mut methods, &joint);
    }
    let agreement = match ideal {
        true => agreement(&methods),
        // Flights take the rig for ideal, and its channels for simultaneous.
        false => agreement(&without(&methods, Method::Flights)),
    };
    if let Some(impacts) = methods.get_mut(&Method::Impacts) {
        impacts.remarks.extend(which_restitution(&agreement));
    }
    let apart = between_methods(&methods, &agreement, &joint);
    let apart = widen_apart(&mut joint, apart, &fits);
    let clock_uncertainty = evidence.nominal.clock_uncertainty;
    for result in methods.values_mut().chain([&mut joint]) {
        clock::widen(result, clock_uncertainty);
    }
    let (cause, replaced) = run.one_cause(&fits, (&mut suspicions, &mut joint), &methods);
    doubt::widen(&mut joint, &doubts);
    missing::say_missing(&mut joint, evidence);
    let verdict = verdict::verdict(&Basis {
        cause,
        beyond: &beyond,
        joint: &joint,
        methods: &methods,
        agreement: &agreement,
        suspicions: &suspicions,
    });
    let joint_fit = run.joint_fit(&fits, &joint.parameters);
    Identification {
        verdict,
        joint,
        agreement,
        uncertainty: run
            .uncertainty(
                &fits,
                &further(apart, over_speed, &doubts, clock_uncertainty),
            )
            .without(&replaced),
        suspicions,
        left_out: run.left_out(),
        used_by: run.used_by(&methods),
        residuals: run.residuals(&fits, &methods),
        methods,
        joint_fit,
        specimens: BTreeMap::new(),
    }
}

/// Identify as if no clearance were stated, as all of them are `contradicted`.
fn without_clearances(evidence: &Evidence<'_>, contradicted: Finding) -> Identification {
    let mut observations = evidence.observations.to_vec();
    for o in &mut observations {
        o.setting.clearance_m = None;
    }
    let mut found = identify_as_stated(&Evidence {
        observations: &observations,
        brackets: &[],
        ..*evidence
    });
    let brackets = evidence.brackets.iter().enumerate();
    let left_out = brackets.map(|(index, bracket)| LeftOut {
        item: Item::bracket(index, bracket),
        reason: Reason::GapNotAsStated,
    });
    found.left_out.extend(left_out);
    found.verdict.findings.insert(0, contradicted.clone());
    found.suspicions.insert(0, contradicted);
    found
}

/// What is open in the joint estimates beside the fit.
fn further(
    apart: Vec<(Coordinate, f64)>,
    over_speed: Option<f64>,
    doubts: &[Doubt],
    clock: f64,
) -> [Further; 4] {
    let over_speed = over_speed.map(|by| (Coordinate::Restitution, by));
    let doubtful = doubts.iter().map(|d| (d.parameter, d.by)).collect();
    let of_clock = (clock > 0.0).then_some((Coordinate::Frequency, clock));
    [
        Further::new(
            UncertaintySource::RestitutionOverSpeed,
            Vec::from_iter(over_speed),
        ),
        Further::new(UncertaintySource::BetweenMethods, apart),
        Further::new(UncertaintySource::Clock, Vec::from_iter(of_clock)),
        Further::new(UncertaintySource::InstrumentOff, doubtful),
    ]
}

/// Widen R of all methods and of the joint result by a small change with the speed; gives its standard uncertainty.
fn widen_over_speed(
    methods: &mut BTreeMap<Method, MethodResult>,
    joint: &mut MethodResult,
) -> Option<f64> {
    let by = verdict::open_by_speed(methods)?;
    for result in methods.values_mut().chain([joint]) {
        let parameter = Coordinate::Restitution;
        let parameters = &mut result.parameters;
        parameters.change(parameter, |e| estimate::wider(parameter, e, by));
    }
    Some(by)
}

/// Widen the joint estimates by what a disagreement of methods leaves open, and those that the methods agree on by
/// what follows from it; gives what is open of all.
fn widen_apart(
    joint: &mut MethodResult,
    apart: Vec<(Coordinate, f64)>,
    fits: &Fits,
) -> Vec<(Coordinate, f64)> {
    let fit = succeeded(&fits.joint).map(|f| &f.fit);
    let carried = fit.map_or_else(Vec::new, |fit| carried_on(fit, &apart));
    let parameters = &mut joint.parameters;
    for (parameter, by) in &apart {
        parameters.change(*parameter, |e| estimate::widened(*parameter, e, *by));
    }
    for (parameter, by) in &carried {
        parameters.change(*parameter, |e| estimate::wider(*parameter, e, *by));
    }
    [apart, carried].concat()
}

/// Whether no record has a drive, so that R rests on the impacts alone.
fn observations_are_undriven(evidence: &Evidence<'_>) -> bool {
    evidence.observations.iter().all(|o| o.drive.is_none())
}

/// Widen what multiple shooting, which takes the rig as ideal, is off the joint estimate on a rig that
/// is not.
fn widen_ideal(methods: &mut BTreeMap<Method, MethodResult>, joint: &MethodResult) {
    let Some(flights) = methods.get_mut(&Method::Flights) else {
        return;
    };
    for coordinate in Coordinate::PHYSICAL {
        let value = |set: &ParameterSet| set.get(coordinate)?.value;
        let Some((own, all)) = value(&flights.parameters).zip(value(&joint.parameters)) else {
            continue;
        };
        let unit = coordinate.slope(all);
        if let Some(Some(estimate)) = flights.parameters.slot(coordinate) {
            *estimate = estimate::widened(coordinate, estimate, (own - all).abs() / unit);
            estimate.note = None;
        }
    }
    flights.remarks.push(Remark::IdealRig);
}

/// The results of all methods but one.
fn without(
    methods: &BTreeMap<Method, MethodResult>,
    left_out: Method,
) -> BTreeMap<Method, MethodResult> {
    let others = methods.iter().filter(|(method, _)| **method != left_out);
    others
        .map(|(method, result)| (*method, result.clone()))
        .collect()
}

/// Every method's fit, and all together.
struct Fits {
    alone: Alone,
    /// Where the resonance curve determines nothing; else the brackets' posterior stands for them.
    boundaries: Option<FitResult>,
    joint: Option<FitResult>,
    /// Where the joint fit started, and the weights of its blocks.
    start: Parameters,
    weights: Weights,
}

/// The fits that rest on no other.
struct Alone {
    resonance: Option<FitResult>,
    impacts: Option<FitResult>,
    trajectories: Option<FitResult>,
    flights: Option<FitResult>,
}

/// Gaps that may be found wrong before the campaign as a whole is at fault.
const MOST_ODD_GAPS: usize = 2;

/// Delay of a channel, in half samples, that multiple shooting does not notice.
const ON_TIME: f64 = 0.05;

/// Rounds of leaving out influential records.
const MOST_ROUNDS: usize = 8;

/// Influential records that may always be left out.
const MOST_INFLUENTIAL: usize = 2;

/// A fit of some methods that is close enough to tell which of two arrangements fits.
fn rough_fit(
    blocks: &Blocks,
    start: Parameters,
    weights: &Weights,
    nominal: &Nominal,
) -> Option<Fit> {
    let problem = Problem {
        precision: Precision::Start,
        ..joint::problem(blocks, start, weights, nominal, None)?
    };
    problem.fit(start).ok()
}

/// Standard errors from which contacts last.
const LASTS: f64 = 4.0;

/// Whether a fit tells a time that contacts last.
fn contacts_last(found: &MethodFit) -> bool {
    let duration = Coordinate::Effect(Effect::ContactDuration);
    let spread = found.spread(duration);
    spread.is_some_and(|s| found.fit.parameters.coordinate(duration) > LASTS * s.error)
}

struct IdentificationRun<'a> {
    evidence: &'a Evidence<'a>,
    selection: Selection<'a>,
    /// What the brackets say of R where the resonance curve determines the rest.
    posterior: Option<Posterior>,
}

impl IdentificationRun<'_> {
    /// Whether no channel is late by more than a small share of half a sample.
    fn is_on_time(&self, parameters: &Parameters) -> bool {
        let latest = ON_TIME * self.selection.blocks.half_sample_s();
        parameters.delays_s.iter().all(|d| d.abs() < latest)
    }

    /// The fits once gaps are settled: with contacts over the speed, without influential records.
    fn refined(&mut self, start: Parameters, fits: Fits) -> Fits {
        let fits = self.with_contacts_over_speed(start, fits);
        self.without_influential(fits)
    }

    /// The fits with contacts that may grow shorter with the speed, where contacts last a time that the data tell: the
    /// speed goes with the gap, and gaps that are off are found before.
    fn with_contacts_over_speed(&mut self, start: Parameters, fits: Fits) -> Fits {
        if !succeeded(&fits.joint).is_some_and(contacts_last) {
            return fits;
        }
        self.selection.blocks.trajectory.contact_speed = true;
        self.fits(start, fits.alone.resonance, fits.alone.impacts)
    }

    /// Trajectories, boundaries and all together, beside the resonance curve and the impacts.
    fn fits(
        &mut self,
        start: Parameters,
        resonance: Option<FitResult>,
        impacts: Option<FitResult>,
    ) -> Fits {
        let trajectories = self.selection.trajectories(start);
        let start = succeeded(&trajectories).map_or(start, |f| f.fit.parameters);
        let resonance = match succeeded(&trajectories) {
            Some(_) => self.selection.resonance_again(resonance, &start),
            None => resonance,
        };
        let waveforms = succeeded(&trajectories).or(succeeded(&resonance));
        let delayed = waveforms.is_some() && self.selection.blocks.delay_impacts(&start);
        let impacts = if delayed {
            methods::impacts(&self.selection.blocks, &self.evidence.nominal, start)
        } else {
            impacts
        };
        let flights = self.selection.flights(start);
        self.together(
            start,
            Alone {
                resonance,
                impacts,
                trajectories,
                flights,
            },
        )
    }

    /// Boundaries and all together, beside what the other methods tell alone.
    fn together(&mut self, start: Parameters, alone: Alone) -> Fits {
        self.selection.choose_brackets(&start);
        let (blocks, nominal) = (&self.selection.blocks, &self.evidence.nominal);
        let waveforms = succeeded(&alone.trajectories).map(|f| &f.fit.parameters);
        self.posterior = succeeded(&alone.resonance).and_then(|found| {
            let surroundings = Surroundings::new(blocks, nominal, found);
            posterior::of_brackets(&blocks.boundary, &surroundings, waveforms)
        });
        let boundaries = match self.posterior {
            Some(_) => None,
            None => methods::boundaries(blocks, nominal, start),
        };
        let weight = |attempt: &Option<FitResult>| succeeded(attempt).map(|f| 1.0 / f.factor);
        // Flights rest on the speeds at impacts; waveforms tell the same better than either.
        let flown = weight(&alone.flights).filter(|_| succeeded(&alone.trajectories).is_none());
        // Speeds that impacts seem to gain tell no R.
        let law = contact_law::contact_law(&self.selection.blocks.impact);
        let gained = law.is_some_and(|law| law.gained().is_some());
        let impacts = succeeded(&alone.impacts).filter(|_| !gained);
        let impact_weight = impacts.map(|found| {
            let told = [&alone.trajectories, &alone.resonance];
            let waveforms = told.into_iter().find_map(succeeded).unwrap_or(found);
            let effects = self.evidence.nominal.effects;
            let bias = impact_bias(&self.selection.blocks.impact, &waveforms.fit, effects);
            joint::impact_weight(found, bias)
        });
        let weights: Weights = [
            (Method::Resonance, weight(&alone.resonance)),
            (Method::Trajectories, weight(&alone.trajectories)),
            (Method::Boundaries, weight(&boundaries)),
            (Method::Impacts, impact_weight.filter(|_| flown.is_none())),
            (Method::Flights, flown),
        ]
        .into_iter()
        .filter_map(|(method, weight)| Some((method, weight?)))
        .collect();
        let joint = self.joint(&self.selection.blocks, start, &weights);
        Fits {
            alone,
            boundaries,
            joint,
            start,
            weights,
        }
    }

    /// The fits without the records that draw them away from what all others state.
    fn without_influential(&mut self, mut fits: Fits) -> Fits {
        let mut left_out = 0;
        for _ in 0..MOST_ROUNDS {
            let Some(joint) = succeeded(&fits.joint) else {
                break;
            };
            let start = joint.fit.parameters;
            let blocks = &self.selection.blocks;
            let present = joint::present(blocks, &fits.weights);
            let Some(problem) = self.problem(blocks, fits.start, &fits.weights) else {
                break;
            };
            let judged = self.selection.judged() + left_out;
            let most = MOST_INFLUENTIAL.max(judged / 30).saturating_sub(left_out);
            // More than that do not err alone: it is the model, and their scatter widens the intervals.
            let (influential, too_many) =
                self.selection
                    .influential(&problem, &present, (&start, most));
            if influential.is_empty() {
                break;
            }
            left_out += influential.len();
            let gone: BTreeSet<Method> = influential.iter().map(|(method, _)| *method).collect();
            self.selection.leave_out(influential);
            fits = self.fitted_again(start, fits, &gone);
            if too_many {
                break;
            }
        }
        fits
    }

    /// The fits after influential records of some methods were left out, from a start near the optimum.
    fn fitted_again(&mut self, start: Parameters, fits: Fits, of: &BTreeSet<Method>) -> Fits {
        let (blocks, nominal) = (&self.selection.blocks, &self.evidence.nominal);
        let mut alone = fits.alone;
        if of.contains(&Method::Resonance) {
            alone.resonance = methods::resonance_from(blocks, nominal, start);
        }
        if of.contains(&Method::Trajectories) {
            let precision = Precision::Result;
            alone.trajectories = methods::trajectories(blocks, nominal, start, precision);
        }
        let start = succeeded(&alone.trajectories).map_or(start, |f| f.fit.parameters);
        self.together(start, alone)
    }

    /// All blocks in one fit, each with its weight; those without one stay out.
    fn joint(&self, blocks: &Blocks, start: Parameters, weights: &Weights) -> Option<FitResult> {
        let problem = self.problem(blocks, start, weights)?;
        Some(joint::fit(&problem, start))
    }

    fn problem<'b>(
        &self,
        blocks: &'b Blocks,
        start: Parameters,
        weights: &Weights,
    ) -> Option<Problem<'b>> {
        self.problem_with(&self.evidence.nominal, blocks, (start, weights))
    }

    /// The same with other statements of the laboratory.
    fn problem_with<'b>(
        &self,
        nominal: &Nominal,
        blocks: &'b Blocks,
        (start, weights): (Parameters, &Weights),
    ) -> Option<Problem<'b>> {
        let of_brackets = self.posterior.as_ref().map(Posterior::as_prior);
        joint::problem(blocks, start, weights, nominal, of_brackets)
    }

    /// The joint fit with all that other campaigns' fits are combined with it by; `estimates`: what was
    /// made of it.
    fn joint_fit(&self, fits: &Fits, estimates: &ParameterSet) -> Option<JointFit> {
        let blocks = &self.selection.blocks;
        let found = succeeded(&fits.joint)?;
        let priors = self.problem(blocks, fits.start, &fits.weights)?.priors;
        let allowed = Coordinate::PHYSICAL.into_iter().filter_map(|parameter| {
            let estimate = estimates.get(parameter)?;
            let value = estimate.value?;
            let unit = parameter.slope(value);
            let freedom = found.spread(parameter)?.freedom;
            // what the estimate is off this fit where it is that of a method alone
            let off = found.fit.parameters.coordinate(parameter) - parameter.of_physical(value);
            Some(Allowed {
                parameter,
                standard_uncertainty: (estimate.standard_error? / unit).hypot(off),
                degrees_of_freedom: freedom.is_finite().then_some(freedom),
            })
        });
        Some(JointFit {
            allowed: allowed.collect(),
            fit: found.fit.clone(),
            variance_factor: found.factor,
            weights: fits.weights.clone(),
            priors,
            gaps_m: blocks.gaps_m.clone(),
        })
    }

    /// The uncertainty of the joint fit as the options want it, with what is open beside it.
    fn uncertainty(&self, fits: &Fits, further: &[Further]) -> Uncertainty {
        let blocks = &self.selection.blocks;
        let problem = self.problem(blocks, fits.start, &fits.weights);
        let Some((problem, joint)) = problem.zip(succeeded(&fits.joint)) else {
            return Uncertainty::default();
        };
        let present = joint::present(blocks, &fits.weights);
        let options = &self.evidence.uncertainty;
        Uncertainty {
            budget: budget::budget(&problem, &present, joint, blocks, further),
            scatter: joint.scatter.clone(),
            ..uncertainty::uncertainty(&problem, &present, joint, options)
        }
    }

    /// What explains other findings, which go, and withdraws what it reaches from the joint result; gives
    /// that cause and the parameters that are no longer those of the joint fit.
    fn one_cause(
        &self,
        fits: &Fits,
        (suspicions, joint): (&mut Vec<Finding>, &mut MethodResult),
        methods: &BTreeMap<Method, MethodResult>,
    ) -> (Option<Cause>, Vec<Coordinate>) {
        let observations = self.evidence.observations;
        suspicions.extend(settling::not_settled(observations, &joint.parameters));
        let change = self.change(fits);
        suspicions.extend(change.as_ref().map(|c| c.finding(observations.len())));
        let cause = Cause::leading(suspicions, methods);
        let mut replaced = cause.map_or_else(Vec::new, |c| c.withdraw(joint, methods));
        if let Some(change) = change.filter(|_| cause == Some(Cause::Change)) {
            replaced.extend(change.tell(joint));
        }
        suspicions.retain(|finding| !cause.is_some_and(|c| c.explains(finding)));
        (cause, replaced)
    }

    /// Where the campaign's rig became another one, if it did.
    fn change(&self, fits: &Fits) -> Option<Change> {
        let joint = succeeded(&fits.joint)?;
        let blocks = &self.selection.blocks;
        // Speeds go with the gap, and the gap with the time: R over the speed would take up some of a change.
        let nominal = &self.evidence.nominal;
        let constant = Nominal {
            effects: nominal.effects.without(EffectKind::RestitutionSpeed),
            ..*nominal
        };
        let problem = self.problem_with(&constant, blocks, (fits.start, &fits.weights))?;
        let present = joint::present(blocks, &fits.weights);
        let fitted = (&self.selection, &problem, &present[..]);
        let over_speed = Coordinate::Effect(Effect::RestitutionSpeed);
        let at = joint.fit.parameters.with(over_speed, 0.0);
        change::change(self.evidence, fitted, (&at, joint.factor))
    }

    /// The gap that deviates most from what the others say, if one does.
    fn odd_gap(&self, fits: &Fits, start: Parameters, found: usize) -> Option<OddGap> {
        if found >= MOST_ODD_GAPS {
            return None;
        }
        let joint = succeeded(&fits.joint)?;
        let Selection {
            blocks,
            lost,
            typical,
            ..
        } = &self.selection;
        let weight = 1.0 / succeeded(&fits.alone.trajectories)?.factor;
        let uncertainty_m = self.evidence.nominal.clearance_uncertainty_m;
        let both = Weights::from([(Method::Resonance, 1.0), (Method::Trajectories, 1.0)]);
        let fit = |blocks: &Blocks| {
            let found = rough_fit(blocks, start, &both, &self.evidence.nominal)?;
            let mean_square = found.cost / found.residuals.max(1) as f64;
            Some((found.parameters, mean_square))
        };
        let contradicting = contradicting_gap(blocks, lost, &start, &fit);
        let lost = suspicion::lost_gap(&blocks.trajectory, lost, &joint.fit.parameters, *typical);
        let allowed = |odd: &OddGap| (odd.fitting_m - odd.stated_m).abs() > 4.0 * uncertainty_m;
        contradicting
            .or(lost)
            .filter(allowed)
            .or_else(|| suspicion::odd_gap(blocks, weight, joint, uncertainty_m))
    }

    /// Mistakes of the laboratory that the data give away, gaps that were found odd among them.
    fn suspicions(&self, fits: &Fits, odd_gaps: Vec<Suspicion>) -> Vec<Suspicion> {
        let observations = self.evidence.observations;
        let clock = self.evidence.nominal.clock_uncertainty;
        let mut found = Vec::from_iter(clock::suspicion(observations, clock));
        found.extend(stated_frequencies::no_drive(observations).map(Suspicion::from));
        found.extend(odd_gaps);
        found.extend(late_channel::late_channels(
            observations,
            succeeded(&fits.joint),
            (&self.selection.blocks, &self.evidence.nominal),
        ));
        found.extend(self.other_suspicions(fits));
        let of_masses = momentum::momentum(&self.selection.blocks.impact, self.evidence);
        found.extend(of_masses.and_then(|m| m.1).map(Suspicion::from));
        found
    }

    /// Gains and corners far off, and interchanged channels.
    fn other_suspicions(&self, fits: &Fits) -> Vec<Suspicion> {
        let Some(joint) = succeeded(&fits.joint) else {
            return Vec::new();
        };
        let start = joint.fit.parameters;
        let cost = |blocks: &Blocks, weights: &Weights| {
            let problem = Problem {
                precision: Precision::Start,
                ..self.problem(blocks, start, weights)?
            };
            let found = joint::fit(&problem, start).ok()?;
            Some((found.fit.cost, found.fit.residuals))
        };
        if let Some(found) = swapped_channels::swapped(&self.selection.blocks, &cost) {
            return vec![found.into()];
        }
        let nominal = &self.evidence.nominal;
        let open = Nominal {
            corner_uncertainty: undeclared_high_pass::WIDE,
            // in phase with the drive at resonance, as what a high-pass shifts is
            effects: nominal.effects.without(EffectKind::Pickup),
            ..*nominal
        };
        let curve = Weights::from([(Method::Resonance, 1.0)]);
        // without what delays, gains and asymmetries took of it
        let begin = nominal.applied(start.ideal());
        let fit = |blocks: &Blocks| rough_fit(blocks, begin, &curve, &open);
        let mut found = undeclared_high_pass::undeclared(&self.selection.blocks, &fit);
        found.extend(suspicion::corners(&joint.fit, joint.factor, nominal));
        let problem = self.problem(&self.selection.blocks, fits.start, &fits.weights);
        found.extend(problem.map_or_else(Vec::new, |p| suspicion::sides(&joint.fit, &p.priors)));
        let mut found: Vec<Suspicion> = found.into_iter().map(Suspicion::from).collect();
        found.extend(wrong_gains::wrong_gain(joint, nominal.gain_uncertainty));
        found
    }

    /// What was left out: records and brackets by the selection, outlying impacts.
    fn left_out(&self) -> Vec<LeftOut> {
        let outlying = &self.selection.blocks.impact_outliers;
        let impacts = outlying.iter().map(|pair| LeftOut {
            item: results::impact(pair, self.evidence),
            reason: Reason::OutlyingImpact {
                before_m_s: pair.before_m_s,
                after_m_s: pair.after_m_s,
            },
        });
        let selected = self.selection.left_out.iter().cloned();
        selected.chain(impacts).collect()
    }

    /// The records that each method's fit used, by their indices.
    fn used_by(&self, methods: &BTreeMap<Method, MethodResult>) -> BTreeMap<Method, Vec<usize>> {
        let fitted = methods.keys().map(|method| {
            let mut records = self.selection.records_of(*method);
            records.sort_unstable();
            records.dedup();
            (*method, records)
        });
        fitted.collect()
    }

    /// The residuals of the methods that gave a result, at the joint fit.
    fn residuals(
        &self,
        fits: &Fits,
        methods: &BTreeMap<Method, MethodResult>,
    ) -> Vec<MethodResiduals> {
        let Some(joint) = succeeded(&fits.joint) else {
            return Vec::new();
        };
        let mut found = residuals::residuals(&self.selection.blocks, &joint.fit.parameters);
        found.retain(|of| methods.contains_key(&of.method));
        found
    }

    /// What each method found.
    fn results(&self, fits: &Fits) -> BTreeMap<Method, MethodResult> {
        let blocks = &self.selection.blocks;
        let together = succeeded(&fits.joint).map(|j| &j.fit);
        let curve = succeeded(&fits.alone.resonance).map(|f| &f.fit.parameters);
        let boundaries = match self.posterior.as_ref().zip(curve) {
            Some((found, curve)) => Some(results::posterior(blocks, found, curve)),
            None => fits
                .boundaries
                .as_ref()
                .map(|a| results::boundaries(blocks, a)),
        };
        let found = [
            fits.alone
                .resonance
                .as_ref()
                .map(|a| (Method::Resonance, results::resonance(blocks, a))),
            fits.alone.trajectories.as_ref().map(|a| {
                let result = results::trajectories(blocks, a, self.evidence);
                (Method::Trajectories, result)
            }),
            boundaries.map(|result| (Method::Boundaries, result)),
            fits.alone.impacts.as_ref().map(|a| {
                let result = results::impacts(blocks, a, self.evidence, together);
                (Method::Impacts, result)
            }),
            fits.alone
                .flights
                .as_ref()
                .map(|a| (Method::Flights, results::flights(blocks, a))),
            decay::pooled(self.evidence.observations, self.evidence.nominal.effects)
                .map(|result| (Method::FreeDecay, result)),
            flight_times::pooled(self.evidence.observations)
                .map(|result| (Method::FlightTimes, result)),
        ];
        found.into_iter().flatten().collect()
    }
}
