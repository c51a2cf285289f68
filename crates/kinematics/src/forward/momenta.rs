use lanes::{LANES, Lanes, Register};
use nalgebra::{DMatrix, DMatrixView};
use pulp::{Simd, WithSimd};

use super::{LinkPosesBatch, group::lanes_from, jacobian::column_of};
use crate::{Inertial, KinematicsError, RobotModel, nodes::PlacementGroup};

impl LinkPosesBatch<'_> {
    /// Generalised momenta M(q)u, (n, N), of joint velocities u (n, N). Up to rounding, they are the product with
    /// [`LinkPoses::mass_matrix`](crate::LinkPoses::mass_matrix), but computed link by link as Σ J_vᵀ(m J_v u) + J_ωᵀ(RIRᵀ J_ω u). The time
    /// grows with the number of links times the joints that carry each. In kg m²/s for rotating joints, kg m/s for sliding ones.
    ///
    /// # Errors
    /// [`KinematicsError::VelocitiesShape`], or as [`RobotModel::inertials`].
    pub fn momenta(&self, velocities: DMatrixView<'_, f64>) -> Result<DMatrix<f64>, KinematicsError> {
        let expected = (self.robot().n_joints(), self.len());
        if velocities.shape() != expected {
            return Err(KinematicsError::VelocitiesShape { found: velocities.shape(), expected });
        }
        let inertials = self.robot().inertials()?;
        let mut momenta = DMatrix::zeros(expected.0, expected.1);
        pulp::Arch::new().dispatch(Sum { poses: self, inertials, velocities, momenta: &mut momenta });
        Ok(momenta)
    }
}

/// Sums all momenta, compiled for the processor at hand.
struct Sum<'a, 'v> {
    poses: &'a LinkPosesBatch<'a>,
    inertials: &'a [Inertial],
    velocities: DMatrixView<'v, f64>,
    momenta: &'a mut DMatrix<f64>,
}

impl WithSimd for Sum<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Sum { poses, inertials, velocities, momenta } = self;
        let n = velocities.nrows();
        let (mut rates, mut sums) = (vec![Lanes::default(); n], vec![Lanes::default(); n]);
        for (group, placements) in poses.groups().enumerate() {
            let first = group * LANES;
            let columns = lanes_from(&velocities, first);
            for (joint, rate) in rates.iter_mut().enumerate() {
                *rate = std::array::from_fn(|lane| columns[lane][joint]);
            }
            sums.fill(Lanes::default());
            for inertial in inertials {
                for part in 0..Register::<S>::parts() {
                    add_link(simd, part, poses.robot(), placements, inertial, &rates, &mut sums);
                }
            }
            for (lane, mut column) in momenta.columns_range_mut(first..).column_iter_mut().take(LANES).enumerate() {
                for (momentum, sum) in column.iter_mut().zip(&sums) {
                    *momentum = sum[lane];
                }
            }
        }
    }
}

/// Adds one link's part of the momenta: computes its velocity and momentum, and projects the momentum onto the joints that carry it.
#[inline(always)]
fn add_link<S: Simd>(
    simd: S,
    part: usize,
    RobotModel { nodes, couplings, .. }: &RobotModel,
    placements: &[PlacementGroup],
    Inertial { link, origin, mass, tensor }: &Inertial,
    rates: &[Lanes],
    sums: &mut [Lanes],
) {
    let link_at = placements[link.0].load(simd, part);
    let centre = link_at.translated([origin.translation.x, origin.translation.y, origin.translation.z]).origin;
    let zero = Register::load(simd, &Lanes::default(), part);
    let (mut linear, mut angular) = ([zero; 3], [zero; 3]);
    let mut index = link.0;
    while index != 0 {
        let node = &nodes[index];
        if let Some(coupling) = node.coupling {
            let [v, w] = column_of(node, &placements[index].load(simd, part), centre);
            let rate = Register::load(simd, &rates[couplings[coupling].column], part) * couplings[coupling].multiplier;
            for i in 0..3 {
                linear[i] += v[i] * rate;
                angular[i] += w[i] * rate;
            }
        }
        index = node.parent;
    }
    let rotation: &[[f64; 3]; 3] = origin.rotation.matrix().as_ref();
    let axes = link_at.rotated(rotation).axes;
    let mut about = [zero; 3];
    for i in 0..3 {
        linear[i] = linear[i] * *mass;
        about[i] = axes[i][0] * angular[0] + axes[i][1] * angular[1] + axes[i][2] * angular[2];
    }
    let mut spin = [zero; 3];
    for i in 0..3 {
        let along = about[0] * tensor[(i, 0)] + about[1] * tensor[(i, 1)] + about[2] * tensor[(i, 2)];
        for row in 0..3 {
            spin[row] += axes[i][row] * along;
        }
    }
    let mut index = link.0;
    while index != 0 {
        let node = &nodes[index];
        if let Some(coupling) = node.coupling {
            let [v, w] = column_of(node, &placements[index].load(simd, part), centre);
            let mut sum = zero;
            for i in 0..3 {
                sum += v[i] * linear[i] + w[i] * spin[i];
            }
            let momentum = &mut sums[couplings[coupling].column];
            (Register::load(simd, momentum, part) + sum * couplings[coupling].multiplier).store(momentum, part);
        }
        index = node.parent;
    }
}
