//! A virtual laboratory, and random ones: truth, noise and faults drawn from the ranges that laboratories
//! have.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::effects::RigEffects;
use super::plan::Plan;
use super::rig_spec::RigSpec;
use super::truth::{Faults, Truth, draw_differences};
use impact_records::signal::whole;

/// A virtual laboratory: what it is made of, what it visits and what it states.
#[derive(Debug, Clone, PartialEq)]
pub struct Laboratory {
    /// True parameters.
    pub truth: Truth,
    /// Faults of the rig.
    pub faults: Faults,
    /// Effects beyond the model.
    pub effects: RigEffects,
    /// Standard uncertainty that the laboratory states of its gaps, m, if they are off.
    pub clearance_uncertainty_m: Option<f64>,
    /// The settings that are visited.
    pub plan: Plan,
    /// Seed of the rig's own errors: its gains and corners.
    pub rig_seed: u64,
    /// Seed of everything else that is random.
    pub seed: u64,
}

/// What a campaign visits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// Several gaps, up and down, and the resonance curve.
    Full,
    /// A gap so wide that nothing touches: R cannot be identified.
    NothingTouches,
}

/// Draw the laboratory of campaign number `index` of a study; the same seed and index always give the same.
///
/// R 0.5 to 0.93, β 0.025 to 0.09, f0 8 to 17 Hz, `x_st` 0.3 to 3 mm, 120 to 260 records, noise 1 to
/// 8 mV on ±5 V, integrators' corner 0.2 to 0.8 Hz, masses unlike by up to 2 %, and the effects of `rig`.
pub fn draw(seed: u64, index: u64, reach: Reach, rig: &RigSpec) -> Laboratory {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(index);
    let mut between = |low: f64, high: f64| rng.random_range(low..high);
    let restitution = between(0.5, 0.93);
    let damping_ratio = between(0.025f64.ln(), 0.09f64.ln()).exp();
    let natural_frequency_hz = between(8.0, 17.0);
    let static_deflection_m = between(0.3e-3f64.ln(), 3e-3f64.ln()).exp();
    let records = whole::index(between(120.0, 260.0));
    let faults = Faults {
        noise_v: between(1e-3f64.ln(), 8e-3f64.ln()).exp(),
        high_pass_hz: Some(between(0.2, 0.8)),
        asymmetry: between(0.0, 0.02),
        missed_probability: between(0.0, 0.1),
        bounce_probability: between(0.0, 0.4),
        ..Faults::default()
    };
    let own_seed = rng.random();
    let differences = draw_differences(&faults, own_seed);
    let mut plan = Plan::for_rig(
        natural_frequency_hz,
        damping_ratio,
        static_deflection_m,
        records,
    );
    if reach == Reach::NothingTouches {
        let widest = plan.steps[0].clearance_m;
        plan.steps.retain(|s| s.clearance_m == widest);
    }
    let mut truth = Truth::symmetric(
        restitution,
        natural_frequency_hz,
        damping_ratio,
        static_deflection_m,
    )
    .with_differences(&differences);
    let effects = rig.draw(&mut truth, &plan, own_seed);
    Laboratory {
        clearance_uncertainty_m: rig.clearance_uncertainty_m(&truth),
        truth,
        faults,
        effects,
        plan,
        rig_seed: own_seed,
        seed: own_seed,
    }
}

impl Laboratory {
    /// The same with about another number of records, on the same rig.
    #[must_use]
    pub fn with_records(mut self, records: usize, rig: &RigSpec) -> Self {
        self.plan = Plan::for_rig(
            self.truth.natural_frequency_hz(),
            self.truth.damping_ratio(),
            self.truth.static_deflection_m(),
            records,
        );
        self.effects = rig.draw(&mut self.truth, &self.plan, self.rig_seed);
        self
    }

    /// The same rig with sweeps past the end of z = 1 in steps of a share of f0.
    #[must_use]
    pub fn with_step(mut self, step: f64, rig: &RigSpec) -> Self {
        let offset = ChaCha8Rng::seed_from_u64(self.rig_seed ^ 0x57E9).random_range(0.0..1.0);
        self.plan = Plan::past_the_end(&self.truth, step, offset);
        self.effects = rig.draw(&mut self.truth, &self.plan, self.rig_seed);
        self
    }

    /// The same rig measured again, with the same plan: its parameters may have changed.
    #[must_use]
    pub fn again(&self, truth: Truth, seed: u64) -> Self {
        Self {
            truth,
            seed,
            ..self.clone()
        }
    }
}
