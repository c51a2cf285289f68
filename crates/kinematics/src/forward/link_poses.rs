use lanes::dispatch_avx2;
use nalgebra::{DVectorView, IsometryMatrix3, Matrix3xX, Matrix6xX, Point3};
use pulp::{Simd, WithSimd};

use super::{
    Workspace,
    jacobian::{add_column, require_columns},
};
use crate::{
    KinematicsError, LinkId, RobotModel,
    model::placeable,
    nodes::{Padded, Placement, padded},
};

/// Poses of all links in one configuration, the result of [`RobotModel::forward_kinematics`].
#[derive(Debug, Clone, Copy)]
pub struct LinkPoses<'a> {
    robot: &'a RobotModel,
    placements: &'a [Placement],
}

impl RobotModel {
    /// Places all links. `q` (n) holds one value for each of [`RobotModel::joints`], in radians or metres.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`], [`KinematicsError::NotFinite`] or [`KinematicsError::TooFar`]. Values
    /// beyond the limits are accepted.
    pub fn forward_kinematics<'a>(
        &'a self,
        q: DVectorView<'_, f64>,
        workspace: &'a mut Workspace,
    ) -> Result<LinkPoses<'a>, KinematicsError> {
        let q = placeable(&q, &self.joints)?;
        Ok(LinkPoses { robot: self, placements: workspace.place(&self.nodes, &self.couplings, q) })
    }
}

impl LinkPoses<'_> {
    /// The link's pose in the root link's frame, metres.
    pub fn pose(&self, link: LinkId) -> IsometryMatrix3<f64> {
        self.placements[link.0].isometry()
    }

    /// The link's pose in its parent's frame, metres; `None` for the root.
    pub fn pose_in_parent(&self, link: LinkId) -> Option<IsometryMatrix3<f64>> {
        let parent = self.robot.parent(link)?;
        Some(self.pose(parent).inv_mul(&self.pose(link)))
    }

    /// The origin of the link's frame in the root link's frame, metres.
    pub fn position(&self, link: LinkId) -> Point3<f64> {
        self.placements[link.0].position()
    }

    /// A point in the link's frame, converted to the root link's frame, metres.
    pub fn transform_point(&self, link: LinkId, point: &Point3<f64>) -> Point3<f64> {
        self.placements[link.0].translated(padded(&point.coords)).position()
    }

    /// Writes the geometric Jacobian (6, n) of the link's frame: rows vx vy vz wx wy wz, the velocity of the frame's
    /// origin and the angular velocity, both in root axes; column j for joint j, in metres and radians per unit of
    /// that joint.
    ///
    /// # Errors
    /// [`KinematicsError::JacobianColumns`].
    pub fn jacobian(&self, link: LinkId, jacobian: &mut Matrix6xX<f64>) -> Result<(), KinematicsError> {
        require_columns(jacobian.ncols(), &self.robot.joints)?;
        self.fill::<6>(link, jacobian.as_mut_slice());
        Ok(())
    }

    /// Writes the upper three rows (3, n) of [`LinkPoses::jacobian`]: the velocity vx vy vz of the frame's origin in
    /// root axes.
    ///
    /// # Errors
    /// [`KinematicsError::JacobianColumns`].
    pub fn position_jacobian(&self, link: LinkId, jacobian: &mut Matrix3xX<f64>) -> Result<(), KinematicsError> {
        require_columns(jacobian.ncols(), &self.robot.joints)?;
        self.fill::<3>(link, jacobian.as_mut_slice());
        Ok(())
    }

    pub(crate) fn robot(&self) -> &RobotModel {
        self.robot
    }

    fn fill<const ROWS: usize>(&self, link: LinkId, jacobian: &mut [f64]) {
        self.fill_at::<ROWS>(link, &self.position(link), jacobian);
    }

    /// Fills the Jacobian (ROWS, n) of a point that is fixed to a link and given in the root link's frame.
    pub(crate) fn fill_at<const ROWS: usize>(&self, link: LinkId, tip: &Point3<f64>, jacobian: &mut [f64]) {
        let (columns, _) = jacobian.as_chunks_mut::<ROWS>();
        dispatch_avx2(Fill { poses: self, link, tip: padded(&tip.coords), columns });
    }
}

/// Fills a Jacobian, compiled for the processor at hand.
struct Fill<'a, const ROWS: usize> {
    poses: &'a LinkPoses<'a>,
    link: LinkId,
    tip: Padded,
    columns: &'a mut [[f64; ROWS]],
}

impl<const ROWS: usize> WithSimd for Fill<'_, ROWS> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Fill { poses: LinkPoses { robot, placements }, link, tip, columns } = self;
        columns.as_flattened_mut().fill(0.0);
        let mut index = link.0;
        while index != 0 {
            let node = &robot.nodes[index];
            add_column(node, &robot.couplings, &placements[index], tip, columns);
            index = node.parent;
        }
    }
}
