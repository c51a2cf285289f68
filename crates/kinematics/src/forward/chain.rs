use std::sync::Arc;

use lanes::dispatch_avx2;
use nalgebra::{DVectorView, IsometryMatrix3, Matrix3xX, Matrix6xX, Point3};
use pulp::{Simd, WithSimd};

use super::{
    Workspace,
    jacobian::{add_column, require_columns},
};
use crate::{
    Joint, KinematicsError, LinkId, RobotModel,
    model::placeable,
    nodes::{Coupling, Motion, Node, Placement},
};

/// The joints between the root and one link only: the cheap way to compute one hand. Fixed joints are merged into the
/// joints after them. Configurations and Jacobians keep the size of the whole robot; columns of joints off the chain
/// are zero.
#[derive(Debug, Clone)]
pub struct Chain {
    pub(super) joints: Arc<[Joint]>,
    pub(super) nodes: Vec<Node>,
    pub(super) couplings: Vec<Coupling>,
}

impl RobotModel {
    /// The joints from the root to one link, prepared for repeated use.
    pub fn chain(&self, link: LinkId) -> Chain {
        Chain::new(self, link)
    }
}

impl Chain {
    pub(crate) fn new(robot: &RobotModel, link: LinkId) -> Self {
        let mut nodes = vec![robot.nodes[0].clone()];
        let mut couplings = Vec::new();
        let mut folded = IsometryMatrix3::identity();
        for index in robot.path(link) {
            let node = &robot.nodes[index];
            folded *= robot.origins[index];
            if let Some(coupling) = node.coupling {
                nodes.push(Node::new(nodes.len() - 1, Some(couplings.len()), node.motion, &folded));
                couplings.push(robot.couplings[coupling]);
                folded = IsometryMatrix3::identity();
            }
        }
        if folded != IsometryMatrix3::identity() {
            nodes.push(Node::new(nodes.len() - 1, None, Motion::Fixed, &folded));
        }
        Chain { joints: Arc::clone(&robot.joints), nodes, couplings }
    }

    /// The link's pose in the root link's frame, metres. `q` (n) is a configuration of the whole robot.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`], [`KinematicsError::NotFinite`] or [`KinematicsError::TooFar`].
    pub fn pose(
        &self,
        q: DVectorView<'_, f64>,
        workspace: &mut Workspace,
    ) -> Result<IsometryMatrix3<f64>, KinematicsError> {
        let q = placeable(&q, &self.joints)?;
        let placements = workspace.place(&self.nodes, &self.couplings, q);
        Ok(placements[self.nodes.len() - 1].isometry())
    }

    /// Writes the geometric Jacobian (6, n) of the link's frame, rows vx vy vz wx wy wz at the frame's origin in root
    /// axes, and returns the link's pose. `q` (n) is a configuration of the whole robot.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`], [`KinematicsError::NotFinite`], [`KinematicsError::TooFar`] or
    /// [`KinematicsError::JacobianColumns`].
    pub fn jacobian(
        &self,
        q: DVectorView<'_, f64>,
        workspace: &mut Workspace,
        jacobian: &mut Matrix6xX<f64>,
    ) -> Result<IsometryMatrix3<f64>, KinematicsError> {
        let q = placeable(&q, &self.joints)?;
        require_columns(jacobian.ncols(), &self.joints)?;
        Ok(self.fill::<6>(q, workspace, jacobian.as_mut_slice()).isometry())
    }

    /// Writes the upper three rows (3, n) of [`Chain::jacobian`], vx vy vz of the frame's origin in root axes, and
    /// returns that origin. `q` (n) is a configuration of the whole robot.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`], [`KinematicsError::NotFinite`], [`KinematicsError::TooFar`] or
    /// [`KinematicsError::JacobianColumns`].
    pub fn position_jacobian(
        &self,
        q: DVectorView<'_, f64>,
        workspace: &mut Workspace,
        jacobian: &mut Matrix3xX<f64>,
    ) -> Result<Point3<f64>, KinematicsError> {
        let q = placeable(&q, &self.joints)?;
        require_columns(jacobian.ncols(), &self.joints)?;
        Ok(self.fill::<3>(q, workspace, jacobian.as_mut_slice()).position())
    }

    fn fill<const ROWS: usize>(&self, q: &[f64], workspace: &mut Workspace, jacobian: &mut [f64]) -> Placement {
        workspace.fit(self.nodes.len(), self.couplings.len());
        let (columns, _) = jacobian.as_chunks_mut::<ROWS>();
        dispatch_avx2(Fill { chain: self, q, workspace, columns })
    }
}

/// Places the chain and fills a Jacobian, compiled for the processor at hand.
struct Fill<'a, const ROWS: usize> {
    chain: &'a Chain,
    q: &'a [f64],
    workspace: &'a mut Workspace,
    columns: &'a mut [[f64; ROWS]],
}

impl<const ROWS: usize> WithSimd for Fill<'_, ROWS> {
    type Output = Placement;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Placement {
        let Fill { chain: Chain { nodes, couplings, .. }, q, workspace, columns } = self;
        let placements = workspace.place_inline(simd, nodes, couplings, q);
        let end = placements[nodes.len() - 1];
        columns.as_flattened_mut().fill(0.0);
        for (node, placement) in nodes.iter().zip(placements) {
            add_column(node, couplings, placement, end.origin, columns);
        }
        end
    }
}
