use constraints::{ConstraintError, LinearConstraint, PfaffianConstraint};
use nalgebra::{DMatrix, DVector, DVectorView};

/// A constraint A(x) u = b(x) with b ≠ 0: the rows of A perform a task, and the policy acts in their null space.
pub trait TaskConstraint: PfaffianConstraint {
    /// b(x), (k), in the units of A u.
    ///
    /// # Errors
    /// [`ConstraintError`] for a state to which the constraint does not apply.
    fn task(&self, state: DVectorView<'_, f64>) -> Result<DVector<f64>, ConstraintError>;

    /// The velocity A⁺b that the task requires, (n).
    ///
    /// # Errors
    /// Those of [`TaskConstraint::task`] and [`PfaffianConstraint::matrix`]; [`ConstraintError::NotFinite`] also for an entry of b, in
    /// column n.
    fn task_velocity(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DVector<f64>, ConstraintError> {
        least_norm(self.matrix(state, time)?, self.task(state)?)
    }
}

/// A⁺b. Rows are scaled to length 1, so that the rank does not depend on their units; singular values below 1e-12 count as 0.
fn least_norm(mut matrix: DMatrix<f64>, mut right: DVector<f64>) -> Result<DVector<f64>, ConstraintError> {
    for row in 0..matrix.nrows() {
        if let Some(column) = matrix.row(row).iter().position(|entry| !entry.is_finite()) {
            return Err(ConstraintError::NotFinite { row, column, value: matrix[(row, column)] });
        }
        require_finite(row, matrix.ncols(), right[row])?;
        let length = matrix.row(row).norm();
        if length > 0.0 {
            matrix.row_mut(row).unscale_mut(length);
            right[row] /= length;
        }
    }
    let svd = matrix.clone().svd(true, true);
    let solve = |right: &DVector<f64>| svd.solve(right, 1e-12).unwrap_or_else(|_| DVector::zeros(matrix.ncols()));
    let velocity = solve(&right);
    // One step of iterative refinement, against rounding errors of the decomposition.
    let rest = &right - &matrix * &velocity;
    Ok(velocity + solve(&rest))
}

/// Checks that an entry of b is finite; the error names column n.
fn require_finite(row: usize, column: usize, value: f64) -> Result<(), ConstraintError> {
    if value.is_finite() { Ok(()) } else { Err(ConstraintError::NotFinite { row, column, value }) }
}

/// A constraint with the same A and b at every state and time.
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
    /// If the number of entries of b differs from the number of rows of A.
    pub fn new(matrix: DMatrix<f64>, task: DVector<f64>) -> Result<Self, ConstraintError> {
        assert_eq!(matrix.nrows(), task.len(), "one entry of b for each row of A");
        for (row, &value) in task.iter().enumerate() {
            require_finite(row, matrix.ncols(), value)?;
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
