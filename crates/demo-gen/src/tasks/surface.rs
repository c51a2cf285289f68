use constraints::{ConstraintError, PfaffianConstraint};
use kinematics::{Chain, Workspace};
use nalgebra::{DMatrix, DVector, DVectorView, IsometryMatrix3, Matrix3, Matrix6xX, Vector3};

use super::TaskConstraint;

/// Constraint that keeps a tool flat on a surface with normal n through a point s. It applies to the tool's position along n and its
/// orientation about both tangents t: A(q) = [nᵀJ_v; t₁ᵀJ_ω; t₂ᵀJ_ω] (3, n), with b(q) = −κ [nᵀ(p − s); t₁ᵀ(a × n); t₂ᵀ(a × n)], which
/// brings the tool back. Here p is its position and a its axis, which converges to −n.
#[derive(Debug, Clone)]
pub struct Surface {
    tool: Chain,
    dim: usize,
    /// n, t₁, t₂ as rows.
    axes: Matrix3<f64>,
    /// s, in metres in the root link's frame.
    point: Vector3<f64>,
    /// κ, in 1/s.
    rate: f64,
}

impl Surface {
    /// A surface for the tool at the end of a chain of a robot with `dim` joints; its normal has length 1.
    pub(super) fn new(tool: Chain, dim: usize, normal: Vector3<f64>, point: Vector3<f64>, rate: f64) -> Self {
        // Not parallel to the normal, because surfaces tilt by less than a right angle.
        let first = normal.cross(&Vector3::x()).normalize();
        let axes = Matrix3::from_columns(&[normal, first, normal.cross(&first)]).transpose();
        Surface { tool, dim, axes, point, rate }
    }

    fn placed(&self, state: DVectorView<'_, f64>) -> Result<(IsometryMatrix3<f64>, Matrix6xX<f64>), ConstraintError> {
        let mut jacobian = Matrix6xX::zeros(self.dim);
        let pose = self
            .tool
            .jacobian(state, &mut Workspace::new(), &mut jacobian)
            .map_err(|error| ConstraintError::Jacobian { reason: error.to_string() })?;
        Ok((pose, jacobian))
    }

    /// Deviation of the tool from the surface: −b/κ, in metres and radians.
    pub(super) fn error(&self, pose: &IsometryMatrix3<f64>) -> Vector3<f64> {
        let turned = pose.rotation * Vector3::z();
        let turn = self.axes * turned.cross(&self.normal());
        Vector3::new(self.normal().dot(&(pose.translation.vector - self.point)), turn.y, turn.z)
    }

    fn normal(&self) -> Vector3<f64> {
        self.axes.row(0).transpose()
    }
}

impl PfaffianConstraint for Surface {
    fn dim(&self) -> usize {
        self.dim
    }

    fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        let (_, jacobian) = self.placed(state)?;
        let mut matrix = DMatrix::zeros(3, self.dim);
        matrix.row_mut(0).copy_from(&(self.axes.row(0) * jacobian.fixed_rows::<3>(0)));
        matrix.rows_mut(1, 2).copy_from(&(self.axes.fixed_rows::<2>(1) * jacobian.fixed_rows::<3>(3)));
        Ok(matrix)
    }
}

impl TaskConstraint for Surface {
    fn task(&self, state: DVectorView<'_, f64>) -> Result<DVector<f64>, ConstraintError> {
        let (pose, _) = self.placed(state)?;
        Ok(DVector::from_column_slice((-self.rate * self.error(&pose)).as_slice()))
    }
}
