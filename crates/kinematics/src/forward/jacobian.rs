//! The geometric Jacobian, column by column: a turning joint moves the frame's origin by axis × lever and turns it
//! about the axis; a sliding joint moves it along the axis.

use crate::{
    Joint, KinematicsError,
    nodes::{Coupling, Motion, Node, Padded, Placement, cross},
};

/// Adds a joint's column, for a frame with its origin at `tip`; 3 rows are vx vy vz, 6 rows vx vy vz wx wy wz. Joints
/// that follow one another share a column, therefore "adds".
#[inline(always)]
pub(crate) fn add_column<const ROWS: usize>(
    node: &Node,
    couplings: &[Coupling],
    placement: &Placement,
    tip: Padded,
    columns: &mut [[f64; ROWS]],
) {
    let Some(coupling) = node.coupling else { return };
    let Coupling { column, multiplier, .. } = couplings[coupling];
    let axis = node.axis(placement);
    let (linear, angular) = match node.motion {
        Motion::Translation(_) => (axis, [0.0; 4]),
        _ => (cross(axis, std::array::from_fn(|i| tip[i] - placement.origin[i])), axis),
    };
    let column = &mut columns[column];
    for row in 0..3 {
        column[row] += multiplier * linear[row];
    }
    for row in 3..ROWS {
        column[row] += multiplier * angular[row - 3];
    }
}

/// A Jacobian to be filled has one column for each joint.
pub(crate) fn require_columns(found: usize, joints: &[Joint]) -> Result<(), KinematicsError> {
    let expected = joints.len();
    if found == expected { Ok(()) } else { Err(KinematicsError::JacobianColumns { found, expected }) }
}
