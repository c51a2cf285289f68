use constraints::{ConstraintError, LinearConstraint, PfaffianConstraint};
use nalgebra::{DMatrix, DVector, DVectorView};

/// A constraint A(x) u = b(x) with b ≠ 0: the rows of A carry out a task, and the policy acts in their null space.
pub trait TaskConstraint: PfaffianConstraint {
    /// b(x), (k), in the units of A u.
    ///
    /// # Errors
    /// [`ConstraintError`] for a state that the constraint is not for.
    fn task(&self, state: DVectorView<'_, f64>) -> Result<DVector<f64>, ConstraintError>;

    /// The velocity A⁺b that the task demands, (n).
    ///
    /// # Errors
    /// Those of [`TaskConstraint::task`] and [`PfaffianConstraint::matrix`]; [`ConstraintError::NotFinite`] for entries of A that are not
    /// finite.
    fn task_velocity(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DVector<f64>, ConstraintError> {
        Ok(least_norm(&self.matrix(state, time)?, &self.task(state)?))
    }
}

/// A⁺b, with singular values below 1e-12 of the largest entry taken for 0.
fn least_norm(matrix: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    if matrix.iter().chain(right).any(|entry| !entry.is_finite()) {
        return DVector::repeat(matrix.ncols(), f64::NAN);
    }
    let svd = matrix.clone().svd(true, true);
    svd.solve(right, 1e-12 * matrix.amax()).unwrap_or_else(|_| DVector::zeros(matrix.ncols()))
}

/// The same A and b at every state and time.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearTask {
    constraint: LinearConstraint,
    task: DVector<f64>,
}

impl LinearTask {
    /// A u = b with A (k, n) and b (k).
    ///
    /// # Errors
    /// Those of [`LinearConstraint::new`]; [`ConstraintError::NotFinite`] also for an entry of b, in column n.
    ///
    /// # Panics
    /// If b has not one entry for each row of A.
    pub fn new(matrix: DMatrix<f64>, task: DVector<f64>) -> Result<Self, ConstraintError> {
        assert_eq!(matrix.nrows(), task.len(), "one entry of b for each row of A");
        if let Some((row, &value)) = task.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(ConstraintError::NotFinite { row, column: matrix.ncols(), value });
        }
        Ok(LinearTask { constraint: LinearConstraint::new(matrix)?, task })
    }
}

impl PfaffianConstraint for LinearTask {
    fn dim(&self) -> usize {
        self.constraint.dim()
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        self.constraint.matrix(state, time)
    }
}

impl TaskConstraint for LinearTask {
    fn task(&self, _state: DVectorView<'_, f64>) -> Result<DVector<f64>, ConstraintError> {
        Ok(self.task.clone())
    }
}
