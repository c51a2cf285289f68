use nalgebra::{DMatrix, DVectorView};

use crate::{ConstraintError, NullSpaceProjector, PfaffianConstraint};

/// The same A at every state and time.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearConstraint {
    matrix: DMatrix<f64>,
    // A is constant, and so N is computed once.
    projector: NullSpaceProjector,
}

impl LinearConstraint {
    /// The constraint A u = 0 with A (k, n).
    ///
    /// # Errors
    /// As [`NullSpaceProjector::new`].
    pub fn new(matrix: DMatrix<f64>) -> Result<Self, ConstraintError> {
        let projector = NullSpaceProjector::new(&matrix)?;
        Ok(LinearConstraint { matrix, projector })
    }
}

impl PfaffianConstraint for LinearConstraint {
    fn dim(&self) -> usize {
        self.matrix.ncols()
    }

    fn matrix(&self, _state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        Ok(self.matrix.clone())
    }

    fn null_space_projector(
        &self,
        _state: DVectorView<'_, f64>,
        _time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        Ok(self.projector.clone())
    }
}
