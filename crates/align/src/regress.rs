use motion::{NegativeGradient, Potential};
use nalgebra::{DMatrix, DVector};
use rand::Rng;

/// A way to learn a potential from levelled samples.
pub trait Regressor {
    /// What it learns.
    type Fitted: Potential;
    /// Why it may fail.
    type Error: std::error::Error;

    /// Learns from `states` (n, M), one column a sample, and their potentials `values` (M), in units of the state
    /// squared per second.
    ///
    /// # Errors
    /// Whatever the regressor refuses; no samples at all, for one.
    fn fit<R: Rng + ?Sized>(
        &self,
        states: &DMatrix<f64>,
        values: &DVector<f64>,
        rng: &mut R,
    ) -> Result<Self::Fitted, Self::Error>;
}

/// What was learnt: a potential and the policy that descends it.
#[derive(Debug, Clone, PartialEq)]
pub struct Learnt<P> {
    policy: NegativeGradient<P>,
}

impl<P: Potential> Learnt<P> {
    /// A learnt potential and its policy.
    pub fn new(potential: P) -> Self {
        Learnt { policy: NegativeGradient(potential) }
    }

    /// The potential f (23).
    pub fn potential(&self) -> &P {
        &self.policy.0
    }

    /// The policy π̂(x) = −∇f(x), the gradient being that of the predictor itself.
    pub fn policy(&self) -> &NegativeGradient<P> {
        &self.policy
    }

    /// The potential alone.
    pub fn into_potential(self) -> P {
        self.policy.0
    }

    /// The policy alone.
    pub fn into_policy(self) -> NegativeGradient<P> {
        self.policy
    }
}
