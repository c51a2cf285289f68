use constraints::{PfaffianConstraint, PointConstraint};
use kinematics::{Chain, RobotModel, Workspace};
use nalgebra::{DMatrix, DMatrixViewMut, DVectorView, Matrix3xX, Vector3};

use crate::DemoGenError;

/// The Jacobian of a hand's position in the form that [`PointConstraint`] requires: a function that fills a matrix (3, n) at a
/// configuration q (n) of `robot`, rows vx vy vz in the root link's axes.
///
/// Each call allocates separate memory, so that threads share nothing and need not wait.
///
/// # Errors
/// The function returns [`DemoGenError::HandJacobian`] for a matrix of another shape, and [`DemoGenError::Robot`]
/// for a configuration that the robot rejects.
pub fn hand_jacobian(
    robot: &RobotModel,
    hand: &Chain,
) -> impl Fn(DVectorView<'_, f64>, DMatrixViewMut<'_, f64>) -> Result<(), DemoGenError> + Send + Sync + use<> {
    let (hand, expected) = (hand.clone(), (3, robot.n_joints()));
    move |q, mut jacobian| {
        if jacobian.shape() != expected {
            return Err(DemoGenError::HandJacobian { found: jacobian.shape(), expected });
        }
        let mut filled = Matrix3xX::zeros(expected.1);
        hand.position_jacobian(q, &mut Workspace::new(), &mut filled)?;
        jacobian.copy_from(&filled);
        Ok(())
    }
}

/// A constraint that keeps a hand in a plane with this normal, in the root link's axes: A(q) = nᵀJ(q) (27).
pub(crate) fn hand_in_plane(
    robot: &RobotModel,
    hand: &Chain,
    normal: Vector3<f64>,
) -> Result<impl PfaffianConstraint + use<>, DemoGenError> {
    let normals = DMatrix::from_row_slice(1, 3, normal.as_slice());
    PointConstraint::new(normals, robot.n_joints(), hand_jacobian(robot, hand))
        .map_err(|source| DemoGenError::Constraint { sample: 0, source })
}
