use constraints::{ConstraintError, PfaffianConstraint};
use nalgebra::{DMatrix, DVectorView};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// A(x) = A₀ + Σ_j x_j B_j: the forbidden directions turn with the state.
#[derive(Debug, Clone, PartialEq)]
pub struct DriftingConstraint {
    /// A₀, (k, n).
    at_origin: DMatrix<f64>,
    /// B_j, (k, n), one for each of the n dimensions.
    drifts: Vec<DMatrix<f64>>,
}

impl DriftingConstraint {
    /// `rank` random rows in `dim` dimensions: entries N(0, 1) at the origin, N(0, 1/16n) per unit of each coordinate.
    pub fn draw<R: Rng + ?Sized>(rank: usize, dim: usize, rng: &mut R) -> Self {
        let mut draw =
            |deviation: f64| DMatrix::from_fn(rank, dim, |_, _| deviation * rng.sample::<f64, _>(StandardNormal));
        let at_origin = draw(1.0);
        let drifts = (0..dim).map(|_| draw(0.25 / (dim as f64).sqrt())).collect();
        DriftingConstraint { at_origin, drifts }
    }
}

impl PfaffianConstraint for DriftingConstraint {
    fn dim(&self) -> usize {
        self.at_origin.ncols()
    }

    fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        if state.len() != self.dim() {
            return Err(ConstraintError::State { found: state.len(), expected: self.dim() });
        }
        let mut matrix = self.at_origin.clone();
        for (x, drift) in state.iter().zip(&self.drifts) {
            matrix.zip_apply(drift, |entry, drift| *entry += x * drift);
        }
        Ok(matrix)
    }
}
