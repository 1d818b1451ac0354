//! The whole identification in steps: first values, each method alone and all together, gaps that are off, records
//! with too much influence, what is suspect, what the results leave open beside their fits, the verdict. One state,
//! [`Fits`], passes between them.

use std::collections::{BTreeMap, BTreeSet};

use crate::identify::diagnostics::beyond;
use crate::identify::diagnostics::cause;
use crate::identify::diagnostics::change::{Change, Fitted, Search};
use crate::identify::diagnostics::clock;
use crate::identify::diagnostics::common_error::{self, CommonError, Stated};
use crate::identify::diagnostics::contradicting_gap::{
    self, Contradicting, Contradiction, exchanged,
};
use crate::identify::diagnostics::doubt::{self, Doubt, Suspicion};
use crate::identify::diagnostics::drives::drives;
use crate::identify::diagnostics::faint_channel::faint_channels;
use crate::identify::diagnostics::gain_change;
use crate::identify::diagnostics::late_channel;
use crate::identify::diagnostics::refuted_gains::{self, Opened};
use crate::identify::diagnostics::settling;
use crate::identify::diagnostics::stated_clearances;
use crate::identify::diagnostics::stated_frequencies;
use crate::identify::diagnostics::suspicion::{self, OddGap};
use crate::identify::diagnostics::swapped_channels;
use crate::identify::diagnostics::uncertain_speeds::uncertain_speeds;
use crate::identify::diagnostics::undeclared_high_pass;
use crate::identify::diagnostics::undeclared_low_pass;
use crate::identify::diagnostics::undetermined::undetermined_motions;
use crate::identify::diagnostics::verdict::{self, Basis};
use crate::identify::diagnostics::wrong_gains;
use crate::identify::first_values::first_values;
use crate::identify::identification::Identification;
use crate::identify::residuals::{self, MethodResiduals};
use crate::identify::restated::Restated;
use crate::identify::uncertainty::budget::{self, Further};
use crate::identify::uncertainty::{self, Uncertainty};
use crate::identify::widening::Widened;
use impact_fit::estimate::ParameterSet;
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::messages::cause::Cause;
use impact_fit::messages::{Finding, Item, LeftOut, Reason};
use impact_fit::method::Method;
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::answer::{Allowed, JointFit, MethodResult};
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::boundaries::Boundaries;
use impact_fit::methods::boundaries::posterior::Posterior;
use impact_fit::methods::fit::FitResult;
use impact_fit::methods::fits::Fits;
use impact_fit::methods::identifier::Identifier;
use impact_fit::methods::impacts::{self, Impacts};
use impact_fit::methods::influence::Places;
use impact_fit::methods::joint::{self, Weights};
use impact_fit::methods::registry::{BY_RECORD, REGISTRY};
use impact_fit::methods::selection::Selection;
use impact_fit::methods::thinning::of_each_gap;
use impact_fit::methods::trajectories::record::TrajectoryRecord;
use impact_fit::parameters::effect::{Effect, EffectKind};
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::solver::{Fit, Precision, Prior, Problem};
use impact_fit::statistics::quantile::chi_squared_99;
use impact_records::event::RigKind;
use impact_records::signal::columns::dot;

/// Identify from observations and brackets, as records of one specimen.
///
/// What cannot be identified has no value but a note; what was left out of the fits is in `left_out`.
/// The example of the crate identifies a simulated campaign.
pub fn identify(evidence: &Evidence<'_>) -> Identification {
    match undeclared_low_pass::behind(evidence) {
        Some(refiltered) => identify_as_stated(&refiltered.evidence(evidence)),
        None => identify_as_stated(evidence),
    }
}

/// The same where all filters are known.
fn identify_as_stated(evidence: &Evidence<'_>) -> Identification {
    let begin = begun(evidence);
    if let Some(contradicted) = contradicted_clearances(evidence, &begin) {
        return match reconciled(evidence, &begin, &contradicted) {
            Some(opened) => with_open_gains(&opened.evidence(evidence), None),
            None => without_clearances(evidence, contradicted),
        };
    }
    with_gains_judged(IdentificationRun::of(evidence, begin, evidence.nominal))
}

/// The same, by gains that are left to the data where these refute them.
fn with_gains_judged(run: IdentificationRun<'_>) -> Identification {
    let shared = run.common_error();
    if let Some(found) = shared.and_then(|error| with_clearances_corrected(&run, error)) {
        return found;
    }
    match run.refuted_gains() {
        Some(opened) => with_open_gains(&opened.evidence(run.evidence), run.contradicted),
        None => completed(run),
    }
}

/// What the records of impacts contradict alike of the clearances, by the fit of the resonance curve.
fn contradicted_clearances(evidence: &Evidence<'_>, begin: &Begin<'_>) -> Option<Finding> {
    let curve = begin.1.as_ref()?.as_ref().ok()?;
    stated_clearances::contradicted(evidence, &curve.fit.parameters)
}

/// The one gain with which the clearances are contradicted no more.
fn reconciled(
    evidence: &Evidence<'_>,
    (selection, curve): &Begin<'_>,
    contradicted: &Finding,
) -> Option<Opened> {
    let curve = &curve.as_ref()?.as_ref().ok()?.fit.parameters;
    let blocks = &selection.blocks;
    let tried = refuted_gains::in_place_of(contradicted, blocks, curve).into_iter();
    let reconciles = |opened: &Opened| {
        let evidence = opened.evidence(evidence);
        let begin = begun(&evidence);
        matches!(begin.1, Some(Ok(_))) && contradicted_clearances(&evidence, &begin).is_none()
    };
    let opened = tried.map(|gains| Opened::of(evidence, blocks, gains));
    let mut reconciling = opened.filter(reconciles);
    reconciling.next().filter(|_| reconciling.next().is_none())
}

/// The identification with gains that are left to the data; `contradicted`: the clearances, if they are.
fn with_open_gains(evidence: &Evidence<'_>, contradicted: Option<Suspicion>) -> Identification {
    let mut run = IdentificationRun::of(evidence, begun(evidence), evidence.nominal);
    run.contradicted = contradicted;
    completed(run)
}

/// The identification by all fits, with masses that are not as stated left to the data.
fn completed(mut run: IdentificationRun<'_>) -> Identification {
    if let Some(pair_m) = run.without_odd_gaps() {
        return with_exchanged(run.evidence, pair_m);
    }
    run.without_contradictions();
    let Some(masses) = run.other_masses() else {
        return run.identification();
    };
    let nominal = Nominal {
        mass_asymmetry: Some(masses),
        ..run.evidence.nominal
    };
    let other = Evidence {
        nominal,
        ..*run.evidence
    };
    let mut again = IdentificationRun::of(&other, begun(&other), run.stated);
    again.contradicted = run.contradicted;
    again.without_odd_gaps();
    again.without_contradictions();
    again.identification()
}

/// The identification with the clearances of two gaps exchanged.
fn with_exchanged(evidence: &Evidence<'_>, pair_m: [f64; 2]) -> Identification {
    let restated = Restated::of(evidence, |own_m| exchanged(own_m, pair_m));
    let other = restated.evidence(evidence);
    let mut run = IdentificationRun::of(&other, begun(&other), other.nominal);
    let finding = Finding::ClearancesExchanged { pair_m };
    run.odd_gaps.push(finding.into());
    completed(run)
}

/// The identification without the error that all clearances share; `None` where the data refute a gain even so.
fn with_clearances_corrected(
    run: &IdentificationRun<'_>,
    error: CommonError,
) -> Option<Identification> {
    let restated = Restated::of(run.evidence, |stated_m| error.corrected_m(stated_m));
    let other = restated.evidence(run.evidence);
    let mut again = IdentificationRun::of(&other, begun(&other), run.stated);
    if again.refuted_gains().is_some() {
        return None;
    }
    again.contradicted = run.contradicted.clone();
    let gaps_m = &run.selection.blocks.gaps_m;
    let found = again.found.together().or(run.found.together());
    let named = found.map(|found| error.suspicion(gaps_m, found));
    again.odd_gaps.extend(named);
    let mut found = completed(again);
    if let Some(joint) = &mut found.joint_fit {
        joint.count_from_stated(gaps_m, |stated_m| error.corrected_m(stated_m));
    }
    Some(found)
}

/// What an identification begins with: everything that may be used, and the fit of the resonance curve.
type Begin<'a> = (Selection<'a>, Option<FitResult>);

/// Everything that may be used, with the fit of the resonance curve, from which all others start.
fn begun<'a>(evidence: &'a Evidence<'a>) -> Begin<'a> {
    let mut selection = Selection::new(evidence);
    let resonance = selection.fit_resonance();
    (selection, resonance)
}

/// Identify as if no clearance were stated, as all of them are `contradicted`.
fn without_clearances(evidence: &Evidence<'_>, contradicted: Finding) -> Identification {
    let restated = Restated::without_clearances(evidence);
    let without = restated.evidence(evidence);
    let mut run = IdentificationRun::of(&without, begun(&without), without.nominal);
    run.contradicted = Some(stated_clearances::suspicion(
        contradicted,
        run.evidence.observations,
    ));
    let mut found = with_gains_judged(run);
    let brackets = evidence.brackets.iter().enumerate();
    let left_out = brackets.map(|(index, bracket)| LeftOut {
        item: Item::bracket(index, bracket),
        reason: Reason::GapNotAsStated,
    });
    found.left_out.extend(left_out);
    found
}

/// Gaps that may be found wrong before the campaign as a whole is at fault.
const MOST_ODD_GAPS: usize = 2;

/// Relative deviation of a gap from which the first order about a fit does not tell it.
const FAR_OFF: f64 = 0.02;

/// Delay of a channel, in half samples, that multiple shooting does not notice.
const ON_TIME: f64 = 0.05;

/// Rounds of leaving out influential records.
const MOST_ROUNDS: usize = 8;

/// Influential records that may be left out of so many: two, or one in thirty.
fn most_influential(judged: usize) -> usize {
    (judged / 30).max(2)
}

/// Standard errors from which contacts last.
const LASTS: f64 = 4.0;

/// Whether a fit tells a time that contacts last.
fn contacts_last(found: &MethodFit) -> bool {
    let duration = Coordinate::Effect(Effect::ContactDuration);
    let spread = found.spread(duration);
    spread.is_some_and(|s| found.fit.parameters.coordinate(duration) > LASTS * s.error)
}

/// What changes between the records of a campaign.
#[derive(Default)]
struct Changes {
    /// A channel whose gain changes.
    of_gain: Option<Suspicion>,
    /// Records of another rig.
    of_rig: Option<Change>,
}

struct IdentificationRun<'a> {
    evidence: &'a Evidence<'a>,
    /// What the laboratory states, which the evidence may put aside.
    stated: Nominal,
    selection: Selection<'a>,
    found: Fits,
    /// That all clearances are not as stated, so that none is used.
    contradicted: Option<Suspicion>,
    /// What was found of gaps that are not as stated.
    odd_gaps: Vec<Suspicion>,
}

impl<'a> IdentificationRun<'a> {
    /// All fits.
    fn of(evidence: &'a Evidence<'a>, (selection, resonance): Begin<'a>, stated: Nominal) -> Self {
        let mut run = Self {
            evidence,
            stated,
            found: first_values(&selection, resonance),
            selection,
            contradicted: None,
            odd_gaps: Vec::new(),
        };
        run.fit();
        run
    }

    /// Fit again without what contradicts the others.
    fn without_contradictions(&mut self) {
        self.with_contacts_over_speed();
        self.without_straining();
        self.without_influential();
    }

    /// The gains that all data refute, where the joint fit is strained; `None` where another statement of the rig is wrong, or
    /// none is. Records that would lose their orbit may hold fits that start where the joint one ended far from what all others
    /// say: then they start where the first of all did, without those.
    fn refuted_gains(&self) -> Option<Opened> {
        self.strained().filter(|strained| *strained)?;
        let joint = self.found.together()?;
        let start = self.found.start();
        let refuted = |blocks: &Blocks, at: Parameters| {
            let problem = self.problem_of(blocks, start)?;
            refuted_gains::refuted(problem, at, joint.factor)
        };
        let from_begin = || {
            let begin = self.found.begin;
            let mut blocks = self.selection.blocks.clone();
            blocks.keep_those_with_an_orbit(&begin);
            refuted(&blocks, begin)
        };
        let gains = refuted(&self.selection.blocks, joint.fit.parameters).or_else(from_begin)?;
        Some(Opened::of(self.evidence, &self.selection.blocks, gains))
    }

    /// The difference of the masses, with its standard uncertainty, where it is so far off what is stated or assumed
    /// that this is refuted: a prior that is wrong draws all others along.
    fn other_masses(&self) -> Option<[f64; 2]> {
        let joint = self.found.together()?;
        let priors = self.problem(self.found.start())?.priors;
        let unlike = suspicion::sides(&joint.fit, &priors);
        unlike.iter().find_map(|finding| match finding {
            Finding::SidesUnlike {
                coordinate: Coordinate::MassAsymmetry,
                difference,
                ..
            } => Some([*difference, difference.abs()]),
            _ => None,
        })
    }

    /// Fit each method beside what those before it found, and all together.
    fn fit(&mut self) {
        for method in REGISTRY {
            method.fit(&mut self.selection, &mut self.found);
        }
        self.fit_together();
    }

    /// Fit all methods together, each with its weight; those without one stay out.
    fn fit_together(&mut self) {
        let weights = REGISTRY.iter().filter_map(|of| {
            let weight = of.weight(&self.selection, &self.found)?;
            Some((of.method(), weight))
        });
        self.found.weights = weights.collect();
        let start = self.found.start();
        let problem = self.problem(start);
        self.found.joint = problem.map(|problem| joint::fit(&problem, start));
    }

    /// Leave out, one by one, gaps that are not as stated; nothing where two have each other's clearances, which are returned.
    fn without_odd_gaps(&mut self) -> Option<[f64; 2]> {
        while self.odd_gaps.len() < MOST_ODD_GAPS {
            let odd = match self.odd_gap() {
                Some(Contradicting::One(odd)) => odd,
                Some(Contradicting::Exchanged(pair_m)) => {
                    return Some(pair_m).filter(|_| self.odd_gaps.is_empty());
                }
                None => break,
            };
            let records = self.selection.of_gap(odd.stated_m);
            let others = self.selection.leave_out_gap(odd.stated_m);
            if others {
                self.fit();
            }
            let found = self.searched(odd, records);
            self.odd_gaps.push(Finding::from(found).into());
            if !others {
                break;
            }
        }
        let found = self.odd_gaps.iter().map(|odd| &odd.finding);
        contradicting_gap::exchanged_of(&found.collect::<Vec<_>>())
    }

    /// Whether the joint fit needs clearances and gains that are together unlike what is stated of them.
    fn scales_strained(&self) -> bool {
        let (joint, problem) = (self.found.together(), self.problem(self.found.start()));
        joint.zip(problem).is_some_and(|(joint, problem)| {
            let scales = |c: Coordinate| {
                matches!(c, Coordinate::ScrewZero | Coordinate::Gap(_)) || c.gain().is_some()
            };
            let apart = problem.deviations(&joint.fit.parameters, scales);
            dot(&apart, &apart) > chi_squared_99(apart.len() as f64)
        })
    }

    /// The error that all clearances share, where they are unlike what is stated or most records of impacts are of no motion
    /// with them.
    fn common_error(&self) -> Option<CommonError> {
        let nominal = &self.evidence.nominal;
        let joint = self.found.together();
        let free = joint.map_or(&[][..], |j| &j.fit.free);
        let stated = Stated {
            clearance_m: nominal.clearance_uncertainty_m,
            gain: nominal.gain_uncertainty,
            gains: free.iter().filter(|c| c.gain().is_some()).count(),
        };
        let Selection { blocks, lost, .. } = &self.selection;
        let unlike = self.scales_strained() || lost.len() > blocks.trajectory.records.len();
        if !unlike || stated.clearance_m == 0.0 {
            return None;
        }
        let gaps_m = &blocks.gaps_m;
        let flown_m = stated_clearances::flown_errors_m(self.evidence, &self.found.begin, gaps_m);
        let fit = |from_m: &[f64], most_m: f64| self.open_clearances(from_m, most_m);
        common_error::searched(gaps_m, flown_m, stated, &fit)
    }

    /// A fit of a few records of each gap that starts at some errors of the clearances, m, where each has a standard
    /// uncertainty of so much.
    fn open_clearances(&self, from_m: &[f64], uncertainty_m: f64) -> Option<Fit> {
        let open = Nominal {
            clearance_uncertainty_m: uncertainty_m,
            ..self.evidence.nominal
        };
        let mut begin = self.found.begin;
        for (i, error_m) in from_m.iter().enumerate() {
            begin.gap_errors_m.set(i, *error_m);
        }
        let Selection { blocks, lost, .. } = &self.selection;
        let of_all = blocks.trajectory.records.iter().chain(lost);
        let few = of_each_gap(of_all, common_error::FEW);
        let mut blocks = blocks.with_trajectory(blocks.trajectory.with_records(few));
        blocks.keep_those_with_an_orbit(&begin);
        joint::rough(&blocks, begin, &joint::curve_and_waveforms(), &open)
    }

    /// A gap that is far off with the clearance with which its records fit what all others say: to first order about a
    /// fit that it bends it is not that.
    fn searched(&self, odd: OddGap, records: Vec<TrajectoryRecord>) -> OddGap {
        let is_far = (odd.fitting_m / odd.stated_m - 1.0).abs() > FAR_OFF;
        let found = self
            .found
            .together()
            .filter(|_| is_far && !records.is_empty());
        let fitting_m = found.and_then(|joint| {
            let block = &self.selection.blocks.trajectory;
            let typical = self.selection.typical;
            suspicion::fitting_clearance(block, records, &joint.fit.parameters, typical)
        });
        OddGap {
            fitting_m: fitting_m.unwrap_or(odd.fitting_m),
            ..odd
        }
    }

    /// Let contacts grow shorter with the speed, where they last a time that the data tell: the speed goes with the
    /// gap, and gaps that are off are found before.
    fn with_contacts_over_speed(&mut self) {
        if self.found.together().is_some_and(contacts_last) {
            self.selection.blocks.trajectory.contact_speed = true;
            self.fit();
        }
    }

    /// Leave out the few records without which the rig is what is stated of it. Gains, masses and gaps bend to such
    /// records, so that these fit: they are judged where a fit ends that is drawn to what is stated, and left out
    /// where the fit of all others then ends near it by itself.
    fn without_straining(&mut self) {
        let Some((near, straining)) = self.straining() else {
            return;
        };
        let before = (self.selection.clone(), self.found.clone());
        let gone: BTreeSet<Method> = straining.iter().map(|(method, _)| *method).collect();
        self.selection.leave_out(straining);
        self.fit_again(near, &gone);
        if self.strained().is_none_or(|strained| strained) {
            (self.selection, self.found) = before;
        }
    }

    /// Whether the joint fit needs what is stated of the rig to be far off; `None` without a fit.
    fn strained(&self) -> Option<bool> {
        let at = self.found.together()?.fit.parameters;
        Some(self.problem(self.found.start())?.strained(&at))
    }

    /// The records that contradict all others most where a fit ends that is drawn to what is stated, and where that
    /// is; `None` where the joint fit is not strained, or no record does.
    fn straining(&self) -> Option<(Parameters, Places)> {
        let at = self.found.together()?.fit.parameters;
        let problem = self.problem(self.found.start())?;
        let drawn = problem.drawn(&at).filter(|_| problem.strained(&at))?;
        let near = drawn.fit(at).ok()?.parameters;
        let present = joint::present(&self.selection.blocks, &self.found.weights);
        let most = most_influential(self.selection.judged());
        let (found, _) = self.selection.influential(&drawn, &present, &near, most);
        (!found.is_empty()).then_some((near, found))
    }

    /// Leave out the records that draw the joint fit away from what all others state.
    fn without_influential(&mut self) {
        let mut left_out = 0;
        for _ in 0..MOST_ROUNDS {
            let Some(joint) = self.found.together() else {
                break;
            };
            let start = joint.fit.parameters;
            let blocks = &self.selection.blocks;
            let present = joint::present(blocks, &self.found.weights);
            let Some(problem) = self.problem(self.found.start()) else {
                break;
            };
            let judged = self.selection.judged() + left_out;
            let most = most_influential(judged).saturating_sub(left_out);
            // More than that do not err alone: it is the model, and their scatter widens the intervals.
            let (influential, too_many) =
                self.selection.influential(&problem, &present, &start, most);
            if influential.is_empty() {
                break;
            }
            left_out += influential.len();
            let gone: BTreeSet<Method> = influential.iter().map(|(method, _)| *method).collect();
            self.selection.leave_out(influential);
            self.fit_again(start, &gone);
            if too_many {
                break;
            }
        }
    }

    /// Fit methods again whose records were left out, from a start near the optimum, then what rests on them.
    fn fit_again(&mut self, start: Parameters, of: &BTreeSet<Method>) {
        self.found.begin = start;
        for method in BY_RECORD.iter().filter(|m| of.contains(&m.method())) {
            let fitted = method.fit_again(&self.selection, &self.found);
            self.found.set(method.method(), fitted);
        }
        Boundaries.fit(&mut self.selection, &mut self.found);
        self.fit_together();
    }

    /// The problem of all methods with their weights, at a start.
    fn problem(&self, start: Parameters) -> Option<Problem<'_>> {
        self.problem_of(&self.selection.blocks, start)
    }

    /// The same of some blocks.
    fn problem_of<'b>(&self, blocks: &'b Blocks, start: Parameters) -> Option<Problem<'b>> {
        let (weights, nominal) = (&self.found.weights, &self.evidence.nominal);
        joint::problem(blocks, start, weights, nominal, self.of_brackets())
    }

    /// What the brackets say of R where the resonance curve determines the rest.
    fn of_brackets(&self) -> Option<Prior> {
        self.found.posterior.as_ref().map(Posterior::as_prior)
    }

    /// What to make of the fits.
    fn identification(&self) -> Identification {
        let (mut suspicions, mut doubts) = doubt::parted(self.suspicions());
        let speed_m_s = self.selection.blocks.typical_approach_m_s;
        let joint = self.found.together();
        let beyond = joint.map_or_else(Vec::new, |found| beyond::beyond(found, speed_m_s));
        let mut results = Widened::new(&self.selection, &self.found);
        results.by_impacts(&self.selection);
        let agreement = results.by_agreement(&self.found, beyond.is_empty() && self.is_on_time());
        results.by_clock(self.evidence.nominal.clock_uncertainty);
        let (cause, replaced) = self.one_cause(&mut suspicions, &mut doubts, &mut results);
        results.by_doubts(&doubts, self.evidence);
        let beyond = beyond::unexplained(beyond, &suspicions);
        let Widened {
            methods,
            joint,
            further,
        } = results;
        let verdict = verdict::verdict(&Basis {
            strikes_a_stop: self.strikes_a_stop(),
            cause,
            beyond: &beyond,
            joint: &joint,
            methods: &methods,
            agreement: &agreement,
            suspicions: &suspicions,
        });
        Identification {
            verdict,
            joint_fit: self.joint_fit(&joint.parameters),
            joint,
            agreement,
            uncertainty: self.uncertainty(&further).without(&replaced),
            suspicions,
            left_out: self.left_out(),
            used_by: self.used_by(&methods),
            residuals: self.residuals(&methods),
            methods,
            specimens: BTreeMap::new(),
        }
    }

    /// Whether the records are of one driven mass that strikes something: a stop is stated, and may be a mass that moves.
    fn strikes_a_stop(&self) -> bool {
        let blocks = &self.selection.blocks;
        let struck = blocks.typical_approach_m_s > 0.0;
        blocks.resonance.rig == RigKind::Single && !blocks.resonance.points.is_empty() && struck
    }

    /// Whether no channel is late by more than a small share of half a sample.
    fn is_on_time(&self) -> bool {
        let latest = ON_TIME * self.selection.blocks.half_sample_s();
        let delays_s = self.found.together().map(|f| f.fit.parameters.delays_s);
        delays_s.is_none_or(|all| all.iter().all(|d| d.abs() < latest))
    }

    /// The joint fit with all that other campaigns' fits are combined with it by; `estimates`: what was
    /// made of it.
    fn joint_fit(&self, estimates: &ParameterSet) -> Option<JointFit> {
        let blocks = &self.selection.blocks;
        let found = self.found.together()?;
        let priors = self.problem(self.found.start())?.priors;
        let allowed = Coordinate::PHYSICAL.into_iter().filter_map(|parameter| {
            let estimate = estimates.get(parameter)?;
            let value = estimate.value?;
            let unit = parameter.slope(value);
            let spread = found.spread(parameter)?;
            // what the estimate is off this fit where it is that of a method alone
            let off = found.fit.parameters.coordinate(parameter) - parameter.of_physical(value);
            let standard_uncertainty = (estimate.standard_error? / unit).hypot(off);
            let further = standard_uncertainty.powi(2) - spread.error.powi(2);
            let freedom = spread.with(further.max(0.0).sqrt()).freedom;
            Some(Allowed {
                parameter,
                standard_uncertainty,
                degrees_of_freedom: freedom.is_finite().then_some(freedom),
            })
        });
        Some(JointFit {
            allowed: allowed.collect(),
            fit: found.fit.clone(),
            variance_factor: found.factor,
            weights: self.found.weights.clone(),
            priors,
            gaps_m: blocks.gaps_m.clone(),
        })
    }

    /// The uncertainty of the joint fit as the options want it, with what is open beside it.
    fn uncertainty(&self, further: &[Further]) -> Uncertainty {
        let blocks = &self.selection.blocks;
        let problem = self.problem(self.found.start());
        let Some((problem, joint)) = problem.zip(self.found.together()) else {
            return Uncertainty::default();
        };
        let present = joint::present(blocks, &self.found.weights);
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
        suspicions: &mut Vec<Finding>,
        doubts: &mut Vec<Doubt>,
        results: &mut Widened,
    ) -> (Option<Cause>, Vec<Coordinate>) {
        let observations = self.evidence.observations;
        let Widened { methods, joint, .. } = results;
        suspicions.extend(settling::not_settled(observations, &joint.parameters));
        suspicions.extend(undetermined_motions(observations));
        suspicions.extend(uncertain_speeds(observations, methods));
        suspicions.extend(self.one_side_moves_less());
        let changes = self.changes(cause::leading(suspicions, methods));
        let Changes {
            of_gain,
            of_rig: change,
        } = changes.unwrap_or_default();
        let (named, open) = doubt::parted(Vec::from_iter(of_gain));
        if !named.is_empty() {
            suspicions.retain(|finding| !gain_change::explains(finding));
        }
        suspicions.extend(named);
        doubts.extend(open);
        suspicions.extend(change.as_ref().map(|c| c.finding(observations.len())));
        let leading = cause::leading(suspicions, methods);
        let withdraw = |cause| cause::withdraw(cause, joint, methods);
        let mut replaced = leading.map_or_else(Vec::new, withdraw);
        if let Some(change) = change.filter(|_| leading == Some(Cause::Change)) {
            replaced.extend(change.tell(joint));
        }
        cause::doubt_without_one_degree_of_freedom(joint, methods);
        suspicions.retain(|finding| !leading.is_some_and(|c| cause::explains(c, finding)));
        (leading, replaced)
    }

    /// Channels that show less of one mass than of the other or, where few do, drives that are unlike.
    fn one_side_moves_less(&self) -> Vec<Finding> {
        let nominal = &self.evidence.nominal;
        let lighter = nominal.mass_asymmetry.map(|[ratio, _]| ratio);
        let faint = faint_channels(self.evidence.rig, self.evidence.observations, lighter);
        let faint: Vec<Finding> = faint.collect();
        match nominal.drive_asymmetry {
            Some([drive_asymmetry, _]) if faint.iter().all(|f| f.cause().is_none()) => {
                vec![Finding::DrivesUnlike { drive_asymmetry }]
            }
            _ => faint,
        }
    }

    /// What changes in the course of the campaign, and which part of it is of another rig, if one is: from some record on
    /// or, where nothing else than the contact explains the data, by clearance or direction of the sweep.
    fn changes(&self, cause: Option<Cause>) -> Option<Changes> {
        let joint = self.found.together()?;
        let blocks = &self.selection.blocks;
        // Speeds go with the gap, and the gap with the time: R over the speed would take up some of a change.
        let nominal = &self.evidence.nominal;
        let constant = Nominal {
            effects: nominal.effects.without(EffectKind::RestitutionSpeed),
            ..*nominal
        };
        let weights = &self.found.weights;
        let start = self.found.start();
        let problem = joint::problem(blocks, start, weights, &constant, self.of_brackets())?;
        let present = joint::present(blocks, &self.found.weights);
        let search_in = |problem, at| {
            let fitted = Fitted {
                selection: &self.selection,
                problem,
                present: &present,
                at,
                factor: joint.factor,
            };
            Search::new(self.evidence, fitted)
        };
        let over_speed = Coordinate::Effect(Effect::RestitutionSpeed);
        let at = joint.fit.parameters.with(over_speed, 0.0);
        let search = search_in(&problem, &at);
        let groups = cause.is_none_or(|cause| cause == Cause::Contact);
        // where no speeds at impacts tell R over the speed from groups of records, the fit has to
        let by_fit = groups && !blocks.impact.tells();
        let beside_speed = by_fit.then(|| self.problem(start)).flatten();
        let of_groups = match &beside_speed {
            Some(problem) => &search_in(problem, &joint.fit.parameters),
            None => &search,
        };
        let between_groups = || groups.then(|| of_groups.between_groups()).flatten();
        let in_no_order = || groups.then(|| of_groups.in_no_order()).flatten();
        let of_gain = search.gain_in_time();
        let in_time = || of_gain.is_none().then(|| search.in_time()).flatten();
        Some(Changes {
            of_rig: in_time().or_else(between_groups).or_else(in_no_order),
            of_gain: of_gain.map(|change| change.suspicion(self.evidence, joint)),
        })
    }

    /// The error that all clearances share within what the joint fit carries of them, if they do.
    fn carried_error(&self) -> Option<CommonError> {
        let uncertainty_m = self.evidence.nominal.clearance_uncertainty_m;
        CommonError::carried(
            &self.selection.blocks.gaps_m,
            self.found.together()?,
            uncertainty_m,
        )
    }

    /// The gap that deviates most from what the others say, if one does and not all do alike, or two that are exchanged.
    fn odd_gap(&self) -> Option<Contradicting> {
        let joint = self.found.together()?;
        if self.carried_error().is_some() {
            return None;
        }
        let Selection {
            blocks,
            lost,
            typical,
            ..
        } = &self.selection;
        let weight = 1.0 / self.found.waveforms()?.factor;
        let uncertainty_m = self.evidence.nominal.clearance_uncertainty_m;
        let contradicting = match self.contradiction(joint) {
            Some(Contradicting::One(odd)) => Some(odd),
            Some(exchanged) => return Some(exchanged),
            None => None,
        };
        let lost = suspicion::lost_gap(&blocks.trajectory, lost, &joint.fit.parameters, *typical);
        let allowed = |odd: &OddGap| (odd.fitting_m - odd.stated_m).abs() > 4.0 * uncertainty_m;
        contradicting
            .or(lost)
            .filter(allowed)
            .or_else(|| suspicion::odd_gap(blocks, weight, joint, uncertainty_m))
            .map(Contradicting::One)
    }

    /// What a few records of each gap tell that contradict each other, if they do.
    fn contradiction(&self, joint: &MethodFit) -> Option<Contradicting> {
        let Selection { blocks, lost, .. } = &self.selection;
        let both = joint::curve_and_waveforms();
        let fit = |blocks: &Blocks, start: &Parameters| {
            let found = joint::rough(blocks, *start, &both, &self.evidence.nominal)?;
            let mean_square = found.cost / found.residuals.max(1) as f64;
            Some((found.parameters, mean_square))
        };
        let starts = [&self.found.begin, &joint.fit.parameters];
        Contradiction::of(blocks, lost, starts, &fit)?.told()
    }

    /// Mistakes of the laboratory that the data give away, gaps that were found odd among them.
    fn suspicions(&self) -> Vec<Suspicion> {
        let observations = self.evidence.observations;
        let clock = self.evidence.nominal.clock_uncertainty;
        let mut found = Vec::from_iter(self.contradicted.clone());
        found.extend(clock::suspicion(observations, clock));
        found.extend(stated_frequencies::no_drive(observations).map(Suspicion::from));
        found.extend(drives(observations).into_iter().map(Suspicion::from));
        found.extend(self.odd_gaps.iter().cloned());
        found.extend(late_channel::late_channels(
            observations,
            self.found.together(),
            &self.selection.blocks,
            &self.evidence.nominal,
        ));
        found.extend(self.other_suspicions());
        let of_masses = Impacts::contradicted_masses(&self.selection);
        found.extend(of_masses.map(Suspicion::from));
        found
    }

    /// Gains and corners far off, and interchanged channels.
    fn other_suspicions(&self) -> Vec<Suspicion> {
        let Some(joint) = self.found.together() else {
            return Vec::new();
        };
        let nominal = &self.evidence.nominal;
        let start = joint.fit.parameters;
        let cost = |blocks: &Blocks, weights: &Weights| {
            let problem = joint::problem(blocks, start, weights, nominal, self.of_brackets())?;
            let problem = problem.with_precision(Precision::Start);
            let found = joint::fit(&problem, start).ok()?;
            Some((found.fit.cost, found.fit.residuals))
        };
        // what a low-pass that is not stated leaves of jumps fits neither way
        let mut late = self.evidence.observations.iter().flat_map(|o| &o.late);
        let filtered = late.any(|l| l.low_pass.is_some());
        let swapped = || swapped_channels::swapped(&self.selection.blocks, &cost);
        if let Some(found) = (!filtered).then(swapped).flatten() {
            return vec![found.into()];
        }
        let open = Nominal {
            corner_uncertainty: undeclared_high_pass::WIDE,
            // in phase with the drive at resonance, as what a high-pass shifts is
            effects: nominal.effects.without(EffectKind::Pickup),
            ..*nominal
        };
        let both = joint::curve_and_waveforms();
        // without what delays, gains and asymmetries took of it
        let begin = nominal.applied(start.ideal());
        let fit = |blocks: &Blocks| joint::rough(blocks, begin, &both, &open);
        let picking_up = |blocks: &Blocks| joint::rough(blocks, begin, &both, nominal);
        let mut found = undeclared_high_pass::undeclared(&self.selection.blocks, &fit, &picking_up);
        found.extend(suspicion::corners(&joint.fit, joint.factor, nominal));
        let stated = self.selection.blocks.asymmetries(&self.stated);
        found.extend(suspicion::sides(&joint.fit, &Vec::from_iter(stated)));
        let mut found: Vec<Suspicion> = found.into_iter().map(Suspicion::from).collect();
        found.extend(wrong_gains::open(joint, nominal));
        let gaps_m = &self.selection.blocks.gaps_m;
        found.extend(match self.carried_error() {
            Some(error) => Some(error.suspicion(gaps_m, joint)),
            None => wrong_gains::wrong_gain(joint, nominal),
        });
        found
    }

    /// What was left out: records and brackets by the selection, outlying impacts.
    fn left_out(&self) -> Vec<LeftOut> {
        let outlying = &self.selection.blocks.impact_outliers;
        let impacts = outlying.iter().map(|pair| LeftOut {
            item: impacts::impact(pair, self.evidence),
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
        let fitted = REGISTRY.iter();
        let fitted = fitted.filter(|of| methods.contains_key(&of.method()));
        let records = fitted.map(|of| {
            let records: BTreeSet<usize> = of.records(&self.selection).into_iter().collect();
            (of.method(), records.into_iter().collect())
        });
        records.collect()
    }

    /// The residuals of the methods that gave a result, at the joint fit.
    fn residuals(&self, methods: &BTreeMap<Method, MethodResult>) -> Vec<MethodResiduals> {
        let Some(joint) = self.found.together() else {
            return Vec::new();
        };
        let mut found = residuals::residuals(&self.selection.blocks, &joint.fit.parameters);
        found.retain(|of| methods.contains_key(&of.method));
        found
    }
}
