use motion::Potential;
use nalgebra::{DMatrix, DVector};
use rand::Rng;

/// A method to learn a potential from aligned samples. Regressors with the same result type can be in one list.
pub trait Regressor {
    /// The learnt potential.
    type Fitted: Potential;
    /// Reasons for failure.
    type Error: std::error::Error;

    /// Learns from `states` (n, M), one column per sample, and their potentials `values` (M), in units of the state
    /// squared per second.
    ///
    /// # Errors
    /// The regressor's errors, for example if there are no samples.
    fn fit(&self, states: &DMatrix<f64>, values: &DVector<f64>, rng: &mut dyn Rng)
    -> Result<Self::Fitted, Self::Error>;
}
