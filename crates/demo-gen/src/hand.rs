use std::sync::{Mutex, PoisonError};

use constraints::{PfaffianConstraint, PointConstraint};
use kinematics::{Chain, RobotModel, Workspace};
use nalgebra::{DMatrix, DMatrixViewMut, DVectorView, Matrix3xX, Vector3};

use crate::DemoGenError;

/// The Jacobian of a hand's position as a [`PointConstraint`] wants it: a function that fills a matrix (3, n) at a
/// configuration q (n) of `robot`, rows vx vy vz in the root link's axes.
///
/// It allocates nothing after its first call. A configuration that the robot refuses, or a matrix of another shape, is
/// left as it was.
pub fn hand_jacobian(
    robot: &RobotModel,
    hand: &Chain,
) -> impl Fn(DVectorView<'_, f64>, DMatrixViewMut<'_, f64>) + Send + Sync + use<> {
    let hand = hand.clone();
    // Calls from several threads at once take turns.
    let memory = Mutex::new((Workspace::new(), Matrix3xX::zeros(robot.n_joints())));
    move |q, mut jacobian| {
        let mut memory = memory.lock().unwrap_or_else(PoisonError::into_inner);
        let (workspace, filled) = &mut *memory;
        if jacobian.shape() == filled.shape() && hand.position_jacobian(q, workspace, filled).is_ok() {
            jacobian.copy_from(filled);
        }
    }
}

/// A hand that may not leave a plane with this normal, in the root link's axes: A(q) = nᵀJ(q) (27).
pub(crate) fn hand_in_plane(
    robot: &RobotModel,
    hand: &Chain,
    normal: Vector3<f64>,
) -> Result<impl PfaffianConstraint + use<>, DemoGenError> {
    let normals = DMatrix::from_row_slice(1, 3, normal.as_slice());
    PointConstraint::new(normals, robot.n_joints(), hand_jacobian(robot, hand))
        .map_err(|source| DemoGenError::Constraint { sample: 0, source })
}
