use motion::Potential;
use nalgebra::{DMatrix, DVector};
use rand::Rng;

/// A way to learn a potential from levelled samples. Regressors of the same result may stand in one list.
pub trait Regressor {
    /// The learnt potential.
    type Fitted: Potential;
    /// Why it may fail.
    type Error: std::error::Error;

    /// Learns from `states` (n, M), one column a sample, and their potentials `values` (M), in units of the state
    /// squared per second.
    ///
    /// # Errors
    /// Whatever the regressor refuses; no samples at all, for one.
    fn fit(&self, states: &DMatrix<f64>, values: &DVector<f64>, rng: &mut dyn Rng)
    -> Result<Self::Fitted, Self::Error>;
}
