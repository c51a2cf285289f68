use std::fmt::Display;

use nalgebra::{DMatrix, DMatrixViewMut, DVectorView};

use crate::{ConstraintError, PfaffianConstraint};

/// A point of a robot, such as a hand, that may not move along given directions: A(x) = nᵀJ(x) (27), where J(x) is the
/// Jacobian of the point's position with respect to the state.
///
/// In space one normal keeps the point in a plane, two keep it on a line; in a plane one normal keeps it on a line.
/// Because the constraint is on the velocity, the plane or line passes through the point's current position.
///
/// The Jacobian is a function, so that any robot library and any mechanism can be used. It receives a state x (n) and a
/// matrix (m, n) to fill; its error becomes [`ConstraintError::Jacobian`]. Entries that it does not fill are NaN, which
/// the projector refuses.
///
/// ```
/// use std::convert::Infallible;
///
/// use constraints::{PfaffianConstraint, PointConstraint};
/// use nalgebra::{DMatrixViewMut, DVectorView, dmatrix, dvector};
///
/// // The tip of two links of length 1 on the plane, which must stay at its height.
/// let tip = |q: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>| {
///     let (a, b) = (q[0], q[0] + q[1]);
///     jacobian.copy_from(&dmatrix![-a.sin() - b.sin(), -b.sin(); a.cos() + b.cos(), b.cos()]);
///     Ok::<(), Infallible>(())
/// };
/// let at_its_height = PointConstraint::new(dmatrix![0.0, 1.0], 2, tip)?;
/// let q = dvector![0.4, 0.9];
/// let free = at_its_height.null_space_projector(q.as_view(), 0.0)?.project(dvector![1.0, 0.0].as_view());
/// let mut jacobian = dmatrix![0.0, 0.0; 0.0, 0.0];
/// tip(q.as_view(), jacobian.as_view_mut())?;
/// let velocity = jacobian * free;
/// assert!(velocity[1].abs() < 1e-15 && velocity[0].abs() > 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct PointConstraint<J> {
    normals: DMatrix<f64>,
    dim: usize,
    jacobian: J,
}

impl<J, E> PointConstraint<J>
where
    J: Fn(DVectorView<'_, f64>, DMatrixViewMut<'_, f64>) -> Result<(), E> + Send + Sync,
    E: Display,
{
    /// The constraint that forbids motion of a point in m dimensions (2 or 3) along the rows of `normals` (k, m), which
    /// may have any length. The point's `jacobian` (m, n) is that for a state of dimension n = `dim`.
    ///
    /// # Errors
    /// [`ConstraintError::NoNormal`] without a row, [`ConstraintError::Normal`] for a row that is zero or not finite.
    pub fn new(normals: DMatrix<f64>, dim: usize, jacobian: J) -> Result<Self, ConstraintError> {
        if normals.is_empty() {
            return Err(ConstraintError::NoNormal);
        }
        let is_direction = |entries: &[f64]| {
            entries.iter().all(|entry| entry.is_finite()) && entries.iter().any(|&entry| entry != 0.0)
        };
        let bad = normals.row_iter().position(|row| !is_direction(row.transpose().as_slice()));
        if let Some(row) = bad {
            return Err(ConstraintError::Normal { row, normal: normals.row(row).iter().copied().collect() });
        }
        Ok(PointConstraint { normals, dim, jacobian })
    }

    /// The directions in which the point may not move, (k, m).
    pub fn normals(&self) -> &DMatrix<f64> {
        &self.normals
    }
}

impl<J, E> PfaffianConstraint for PointConstraint<J>
where
    J: Fn(DVectorView<'_, f64>, DMatrixViewMut<'_, f64>) -> Result<(), E> + Send + Sync,
    E: Display,
{
    fn dim(&self) -> usize {
        self.dim
    }

    fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        let mut jacobian = DMatrix::from_element(self.normals.ncols(), self.dim, f64::NAN);
        (self.jacobian)(state, jacobian.as_view_mut())
            .map_err(|error| ConstraintError::Jacobian { reason: error.to_string() })?;
        Ok(along(&self.normals, &jacobian))
    }
}

/// nᵀJ (27), compiled once and not for every type of Jacobian.
fn along(normals: &DMatrix<f64>, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    normals * jacobian
}
