//! What the methods found so far: the state that a run passes from step to step.

use std::collections::BTreeMap;

use crate::method::Method;
use crate::method_fit::MethodFit;
use crate::methods::boundaries::posterior::Posterior;
use crate::methods::fit::FitResult;
use crate::methods::joint::Weights;
use crate::parameters::Parameters;

/// The fits of the methods, each alone, and of all together.
#[derive(Debug, Clone)]
pub struct Fits {
    /// Where the first fit of the waveforms starts.
    pub begin: Parameters,
    alone: BTreeMap<Method, FitResult>,
    /// What the brackets say of R where the resonance curve determines the rest.
    pub posterior: Option<Posterior>,
    /// All methods in one fit.
    pub joint: Option<FitResult>,
    /// The weights of their blocks in it.
    pub weights: Weights,
}

impl Fits {
    /// Nothing but a start.
    pub fn new(begin: Parameters) -> Self {
        Self {
            begin,
            alone: BTreeMap::new(),
            posterior: None,
            joint: None,
            weights: Weights::new(),
        }
    }

    /// A method's fit, or why there is none.
    pub fn attempt(&self, method: Method) -> Option<&FitResult> {
        self.alone.get(&method)
    }

    /// A method's fit, if it succeeded.
    pub fn of(&self, method: Method) -> Option<&MethodFit> {
        self.attempt(method)?.as_ref().ok()
    }

    /// Set what a method found, in place of what it found before.
    pub fn set(&mut self, method: Method, fitted: Option<FitResult>) {
        match fitted {
            Some(fitted) => self.alone.insert(method, fitted),
            None => self.alone.remove(&method),
        };
    }

    /// Take what a method found.
    pub fn take(&mut self, method: Method) -> Option<FitResult> {
        self.alone.remove(&method)
    }

    /// The joint fit.
    pub fn together(&self) -> Option<&MethodFit> {
        self.joint.as_ref()?.as_ref().ok()
    }

    /// Where fits start: at the waveforms', which know most.
    pub fn start(&self) -> Parameters {
        self.waveforms().map_or(self.begin, |f| f.fit.parameters)
    }
}
