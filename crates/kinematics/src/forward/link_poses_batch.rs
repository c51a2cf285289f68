use lanes::{LANES, groups_of};
use nalgebra::{DMatrixView, IsometryMatrix3, Matrix6xX, Point3};
use pulp::{Simd, WithSimd};

use super::{
    Workspace,
    group::{add_columns, lanes_from},
    jacobian::require_columns_each,
};
use crate::{
    KinematicsError, LinkId, RobotModel,
    model::all_placeable,
    nodes::{Placement, PlacementGroup},
};

/// Poses of all links in several configurations, the result of [`RobotModel::forward_kinematics_batch`].
#[derive(Debug, Clone, Copy)]
pub struct LinkPosesBatch<'a> {
    robot: &'a RobotModel,
    /// Placements of all nodes, group after group of configurations.
    groups: &'a [PlacementGroup],
    len: usize,
}

impl RobotModel {
    /// Places all links in each of the configurations `q` (n, N), radians or metres. The results equal those of
    /// [`RobotModel::forward_kinematics`] bit for bit, but several are computed at once in vector registers. A multiple of
    /// eight is most efficient. Each configuration takes 96 bytes of the workspace per link; some dozens at a time, which
    /// fit into the processor's cache, are faster than thousands.
    ///
    /// # Errors
    /// [`KinematicsError::InBatch`] with the error of [`RobotModel::forward_kinematics`] for the first faulty configuration.
    pub fn forward_kinematics_batch<'a>(
        &'a self,
        q: DMatrixView<'_, f64>,
        workspace: &'a mut Workspace,
    ) -> Result<LinkPosesBatch<'a>, KinematicsError> {
        all_placeable(&q, &self.joints)?;
        workspace.fit_groups(self.nodes.len(), self.couplings.len(), groups_of(q.ncols()));
        pulp::Arch::new().dispatch(PlaceAll { robot: self, q, workspace });
        Ok(LinkPosesBatch { robot: self, groups: &workspace.groups, len: q.ncols() })
    }
}

impl LinkPosesBatch<'_> {
    /// Number N of configurations.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no configurations.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The link's pose in the root link's frame, metres, in configuration `index`.
    ///
    /// # Panics
    /// If `index` is not below [`LinkPosesBatch::len`].
    pub fn pose(&self, link: LinkId, index: usize) -> IsometryMatrix3<f64> {
        self.placement(link, index).isometry()
    }

    /// The origin of the link's frame in the root link's frame, metres, in configuration `index`.
    ///
    /// # Panics
    /// If `index` is not below [`LinkPosesBatch::len`].
    pub fn position(&self, link: LinkId, index: usize) -> Point3<f64> {
        self.placement(link, index).position()
    }

    /// Writes the geometric Jacobians of the link's frame side by side, (6, n·N): columns i·n to (i + 1)·n equal, bit for
    /// bit, the result of [`LinkPoses::jacobian`](crate::LinkPoses::jacobian) in configuration i.
    ///
    /// # Errors
    /// [`KinematicsError::BatchColumns`].
    pub fn jacobians(&self, link: LinkId, jacobians: &mut Matrix6xX<f64>) -> Result<(), KinematicsError> {
        require_columns_each(jacobians.ncols(), self.len, &self.robot.joints)?;
        let (columns, _) = jacobians.as_mut_slice().as_chunks_mut::<6>();
        pulp::Arch::new().dispatch(Fill { poses: self, link, columns });
        Ok(())
    }

    pub(super) fn robot(&self) -> &RobotModel {
        self.robot
    }

    /// The placements of all nodes in each group of configurations.
    #[inline(always)]
    pub(super) fn groups(&self) -> impl Iterator<Item = &[PlacementGroup]> {
        self.groups.chunks_exact(self.robot.nodes.len())
    }

    fn placement(&self, link: LinkId, index: usize) -> Placement {
        assert!(index < self.len, "configuration {index} of {}", self.len);
        self.groups[index / LANES * self.robot.nodes.len() + link.0].lane(index % LANES)
    }
}

/// Places all links in all configurations, compiled for the processor at hand.
struct PlaceAll<'a, 'q> {
    robot: &'a RobotModel,
    q: DMatrixView<'q, f64>,
    workspace: &'a mut Workspace,
}

impl WithSimd for PlaceAll<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let PlaceAll { robot: RobotModel { nodes, couplings, .. }, q, workspace } = self;
        for group in 0..groups_of(q.ncols()) {
            workspace.place_group(simd, nodes, couplings, lanes_from(&q, group * LANES), group);
        }
    }
}

/// Fills the Jacobians, compiled for the processor at hand.
struct Fill<'a> {
    poses: &'a LinkPosesBatch<'a>,
    link: LinkId,
    columns: &'a mut [[f64; 6]],
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Fill { poses, link, columns } = self;
        let (robot, n) = (poses.robot, poses.robot.n_joints());
        if n == 0 {
            return;
        }
        for (placements, jacobians) in poses.groups().zip(columns.chunks_mut(LANES * n)) {
            jacobians.as_flattened_mut().fill(0.0);
            let mut index = link.0;
            while index != 0 {
                let node = &robot.nodes[index];
                add_columns(simd, node, &robot.couplings, &placements[index], &placements[link.0], jacobians, n);
                index = node.parent;
            }
        }
    }
}
