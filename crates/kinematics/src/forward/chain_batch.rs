use lanes::LANES;
use nalgebra::{DMatrixView, IsometryMatrix3, Matrix6xX};
use pulp::{Simd, WithSimd};

use super::{
    Chain, Workspace,
    group::{add_columns, lanes_from},
    jacobian::require_columns_each,
};
use crate::{KinematicsError, model::all_placeable};

impl Chain {
    /// The link's pose in the root link's frame, metres, in each of the configurations `q` (n, N) of the whole robot. The
    /// results equal those of [`Chain::pose`] bit for bit, but several are computed at once in vector registers.
    ///
    /// # Errors
    /// [`KinematicsError::InBatch`] with the error of [`Chain::pose`] for the first faulty configuration.
    pub fn poses<'w>(
        &self,
        q: DMatrixView<'_, f64>,
        workspace: &'w mut Workspace,
    ) -> Result<&'w [IsometryMatrix3<f64>], KinematicsError> {
        all_placeable(&q, &self.joints)?;
        Ok(self.evaluate(q, workspace, None))
    }

    /// Writes the geometric Jacobians of the link's frame side by side, (6, n·N): columns i·n to (i + 1)·n equal, bit for
    /// bit, the result of [`Chain::jacobian`] in configuration i of `q` (n, N). Returns the link's poses.
    ///
    /// # Errors
    /// [`KinematicsError::InBatch`] as [`Chain::poses`], or [`KinematicsError::BatchColumns`].
    pub fn jacobians<'w>(
        &self,
        q: DMatrixView<'_, f64>,
        workspace: &'w mut Workspace,
        jacobians: &mut Matrix6xX<f64>,
    ) -> Result<&'w [IsometryMatrix3<f64>], KinematicsError> {
        all_placeable(&q, &self.joints)?;
        require_columns_each(jacobians.ncols(), q.ncols(), &self.joints)?;
        let (columns, _) = jacobians.as_mut_slice().as_chunks_mut::<6>();
        Ok(self.evaluate(q, workspace, Some(columns)))
    }

    fn evaluate<'w>(
        &self,
        q: DMatrixView<'_, f64>,
        workspace: &'w mut Workspace,
        columns: Option<&mut [[f64; 6]]>,
    ) -> &'w [IsometryMatrix3<f64>] {
        workspace.fit_groups(self.nodes.len(), self.couplings.len(), 1);
        workspace.poses.resize(q.ncols(), IsometryMatrix3::identity());
        pulp::Arch::new().dispatch(Evaluate { chain: self, q, workspace, columns });
        &workspace.poses
    }
}

/// Places the chain in all configurations and fills the Jacobians, if any, compiled for the processor at hand.
struct Evaluate<'a, 'q> {
    chain: &'a Chain,
    q: DMatrixView<'q, f64>,
    workspace: &'a mut Workspace,
    columns: Option<&'a mut [[f64; 6]]>,
}

impl WithSimd for Evaluate<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Evaluate { chain, q, workspace, mut columns } = self;
        let (nodes, couplings, n) = (&chain.nodes, &chain.couplings, q.nrows());
        for first in (0..q.ncols()).step_by(LANES) {
            workspace.place_group(simd, nodes, couplings, lanes_from(&q, first), 0);
            let Workspace { groups: placements, poses, .. } = &mut *workspace;
            let end = &placements[nodes.len() - 1];
            for (lane, pose) in poses[first..].iter_mut().take(LANES).enumerate() {
                *pose = end.lane(lane).isometry();
            }
            let Some(columns) = &mut columns else { continue };
            let jacobians = &mut columns[first * n..q.ncols().min(first + LANES) * n];
            jacobians.as_flattened_mut().fill(0.0);
            for (node, placements) in nodes.iter().zip(&*placements) {
                add_columns(simd, node, couplings, placements, end, jacobians, n);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use lanes::dispatch_avx2;
    use nalgebra::DMatrix;
    use pulp::Arch;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

    use super::*;
    use crate::forward::upper_body;

    /// Vector registers of every width, and scalar code, give the same bits.
    #[test]
    fn dispatch_changes_no_bit() {
        let robot = upper_body();
        let chain = robot.chain(robot.link("l_palm").expect("the robot has hands"));
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let columns: Vec<_> = (0..21).map(|_| robot.random_configuration(&mut rng)).collect();
        let q = DMatrix::from_columns(&columns);
        let results = [0, 1, 2].map(|width| {
            let mut workspace = Workspace::new();
            workspace.fit_groups(chain.nodes.len(), chain.couplings.len(), 1);
            workspace.poses.resize(q.ncols(), IsometryMatrix3::identity());
            let mut columns = vec![[f64::NAN; 6]; q.len()];
            let all =
                Evaluate { chain: &chain, q: q.as_view(), workspace: &mut workspace, columns: Some(&mut columns) };
            match width {
                0 => Arch::Scalar.dispatch(all),
                1 => dispatch_avx2(all),
                _ => Arch::new().dispatch(all),
            }
            (columns, workspace.poses)
        });
        assert!(results[0].0.iter().flatten().all(|number| number.is_finite()));
        assert_eq!(results[0], results[1]);
        assert_eq!(results[0], results[2]);
    }
}
