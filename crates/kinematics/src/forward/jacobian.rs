//! The geometric Jacobian, column by column: a rotating joint moves the frame's origin by axis × lever and rotates the frame about
//! the axis; a sliding joint moves it along the axis.

use lanes::Number;

use crate::{
    Joint, KinematicsError,
    nodes::{Coupling, Motion, Node, Padded, Placement, cross},
};

/// Linear and angular velocity of a frame with its origin at `tip`, in root axes, per unit of a node's joint.
#[inline(always)]
pub(crate) fn column_of<T: Number, const W: usize>(
    node: &Node,
    placement: &Placement<T, W>,
    tip: [T; W],
) -> [[T; W]; 2] {
    let axis = node.axis(placement);
    if matches!(node.motion, Motion::Translation(_)) {
        return [axis, [axis[0].like(0.0); W]];
    }
    let mut lever = tip;
    for (part, origin) in lever.iter_mut().zip(placement.origin) {
        *part -= origin;
    }
    [cross(axis, lever), axis]
}

/// Adds a joint's column, for a frame with its origin at `tip`; 3 rows are vx vy vz, 6 rows vx vy vz wx wy wz. It adds because a
/// joint and its mimic joints share a column.
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
    let [linear, angular] = column_of(node, placement, tip);
    let column = &mut columns[column];
    for row in 0..3 {
        column[row] += multiplier * linear[row];
    }
    for row in 3..ROWS {
        column[row] += multiplier * angular[row - 3];
    }
}

/// Checks that a Jacobian has one column for each joint.
pub(crate) fn require_columns(found: usize, joints: &[Joint]) -> Result<(), KinematicsError> {
    let expected = joints.len();
    if found == expected { Ok(()) } else { Err(KinematicsError::JacobianColumns { found, expected }) }
}

/// Checks that Jacobians side by side have one column for each joint in each configuration.
pub(crate) fn require_columns_each(
    found: usize,
    configurations: usize,
    joints: &[Joint],
) -> Result<(), KinematicsError> {
    let joints = joints.len();
    if found == configurations * joints {
        Ok(())
    } else {
        Err(KinematicsError::BatchColumns { found, configurations, joints })
    }
}
