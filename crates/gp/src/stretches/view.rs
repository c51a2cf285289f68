//! Velocities that are searched for stretches: those recorded, or those of a task space (S40).

use std::borrow::Cow;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, DVectorView};

use crate::Rows;

/// Share of the largest singular value below which A has no row.
const SINGULAR: f64 = 1e-9;

/// The rows as recorded, or in one of their task spaces.
pub(crate) struct View<'a> {
    /// Velocities, (m, N).
    pub(super) velocities: Cow<'a, DMatrix<f64>>,
    /// `None` for the recorded coordinates.
    pub(super) through: Option<Through>,
}

/// A task space of some rows, in units that make the noise of u equally large along all directions.
#[derive(Debug, Clone)]
pub(crate) struct Through {
    /// Its index among the task spaces of the rows.
    pub(crate) space: usize,
    /// W of (S40) of each trajectory, (m', m).
    evening: BTreeMap<usize, DMatrix<f64>>,
}

impl<'a> View<'a> {
    pub(crate) fn recorded(rows: &'a Rows) -> Self {
        View { velocities: Cow::Borrowed(rows.velocities()), through: None }
    }

    /// WJu of (S40); `None` for a space without motion.
    pub(crate) fn in_space(rows: &'a Rows, space: usize) -> Option<Self> {
        let all: Vec<usize> = (0..rows.len()).collect();
        let trajectory = |row: &usize| rows.indices()[*row].trajectory;
        let own = &rows.task_spaces()[space];
        let (directions, _) = own.gains()?;
        let evening_of = |part: &[usize]| Some((trajectory(&part[0]), own.evening(&directions, part)?));
        let evening = all.chunk_by(|a, b| trajectory(a) == trajectory(b)).map(evening_of).collect::<Option<_>>()?;
        let through = Through { space, evening };
        let velocities = rows.velocities().column_iter().enumerate();
        let velocities: Vec<DVector<f64>> = velocities.map(|(row, u)| through.jacobian(rows, row) * u).collect();
        Some(View { velocities: Cow::Owned(DMatrix::from_columns(&velocities)), through: Some(through) })
    }

    pub(super) fn dim(&self) -> usize {
        self.velocities.nrows()
    }

    /// The velocity A⁺b in recorded coordinates, (n), that produces this one, (m'), along the normals of a plane with these directions,
    /// at one row.
    pub(super) fn recorded_push(
        &self,
        rows: &Rows,
        row: usize,
        directions: &DMatrix<f64>,
        push: DVector<f64>,
    ) -> DVector<f64> {
        let Some(through) = &self.through else { return push };
        let normals = complement(directions);
        let (matrix, bound) = (normals.tr_mul(&through.jacobian(rows, row)), normals.tr_mul(&push));
        let least = SINGULAR * matrix.amax();
        matrix.svd(true, true).solve(&bound, least).unwrap_or_else(|_| DVector::zeros(rows.dim()))
    }
}

/// A direction v of (S41).
pub(super) struct Free {
    pub(super) direction: DVector<f64>,
    /// ℓ of (S41): the noise divided by the standard deviation of its angle.
    pub(super) length: f64,
}

impl Through {
    /// WJ of one row, (m', n).
    fn jacobian(&self, rows: &Rows, row: usize) -> DMatrix<f64> {
        let evening = &self.evening[&rows.indices()[row].trajectory];
        let jacobians = rows.task_spaces()[self.space].jacobians.as_ref();
        jacobians.map_or_else(|| evening.clone(), |jacobians| evening * &jacobians[row])
    }

    /// (S41): orthonormal directions of the recorded coordinates to which the hand responds along one of `directions` (m', q), or not at
    /// all. The angles of `directions` have the standard deviations s/`lengths` (q).
    pub(super) fn free(&self, rows: &Rows, row: usize, directions: &DMatrix<f64>, lengths: &[f64]) -> Vec<Free> {
        let jacobian = self.jacobian(rows, row);
        let matrix = complement(directions).tr_mul(&jacobian);
        let size = matrix.norm_squared() / matrix.nrows() as f64;
        let along = directions.tr_mul(&jacobian);
        let free = |direction: DVectorView<'_, f64>| {
            let parts = &along * direction;
            let tilt = parts.iter().zip(lengths).map(|(part, length)| (part / length).powi(2)).sum::<f64>();
            Free { direction: direction.into_owned(), length: (size / tilt).sqrt() }
        };
        null_space(&matrix).column_iter().map(free).collect()
    }
}

/// Orthonormal directions (m, m − q) orthogonal to given orthonormal ones, (m, q).
fn complement(directions: &DMatrix<f64>) -> DMatrix<f64> {
    let m = directions.nrows();
    let eigen = (DMatrix::identity(m, m) - directions * directions.transpose()).symmetric_eigen();
    let left: Vec<usize> = (0..m).filter(|&k| eigen.eigenvalues[k] > 0.5).collect();
    eigen.eigenvectors.select_columns(&left)
}

/// Orthonormal directions (n, n − k) in the null space of a matrix (k, n), rotated so that none is an axis without motion.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.ncols();
    let svd = matrix.transpose().svd(true, false);
    let least = SINGULAR * svd.singular_values.max();
    let blocked: Vec<usize> = (0..svd.singular_values.len()).filter(|&k| svd.singular_values[k] > least).collect();
    let blocked = svd.u.map_or_else(|| DMatrix::zeros(n, 0), |u| u.select_columns(&blocked));
    let free = complement(&blocked);
    let axis = DVector::from_fn(free.ncols(), |k, _| (k + 1) as f64);
    let turned = &free * &axis * (2.0 / axis.norm_squared().max(1.0));
    free - turned * axis.transpose()
}

#[cfg(test)]
mod tests {
    use kinematics::{RobotModel, Workspace};
    use motion::SampleIndex;
    use nalgebra::Matrix6xX;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::TaskSpace;
    use crate::stretches::{Stretches, Switches};

    const ROBOTS: [(&str, &str); 3] = [
        (include_str!("../../../../robots/seven_joint_arm.urdf"), "tool"),
        (include_str!("../../../../robots/planar_three_link.urdf"), "hand"),
        (include_str!("../../../../robots/asimo_upper_body.urdf"), "l_palm"),
    ];
    /// Samples of a movement.
    const COUNT: usize = 30;

    proptest! {
        /// For any policy at random poses of a robot, under ΛJu = b with random Λ and b for each movement: vᵀu = vᵀπ holds for the n − k
        /// directions v of each sample, which are found without Λ and b.
        #[test]
        fn rows_hold_under_any_constraint_of_a_link(
            robot in 0usize..3,
            first in 0usize..4,
            rank in 1usize..6,
            pushed in any::<bool>(),
            seed in any::<u64>(),
        ) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut draw = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| 2.0 * rng.random::<f64>() - 1.0);
            let model = RobotModel::from_urdf(ROBOTS[robot].0).unwrap();
            let chain = model.chain(model.link(ROBOTS[robot].1).unwrap());
            let (n, mut workspace) = (model.n_joints(), Workspace::new());
            let states = draw(n, 3 * COUNT);
            let mut jacobians = Vec::new();
            for state in states.column_iter() {
                let mut jacobian = Matrix6xX::zeros(n);
                chain.jacobian(state, &mut workspace, &mut jacobian).unwrap();
                // Position, orientation, or both.
                let rows = [(0, 3), (3, 3), (0, 6), (0, 6)][first];
                jacobians.push(DMatrix::from_fn(rows.1, n, |row, joint| jacobian[(rows.0 + row, joint)]));
            }
            let space = TaskSpace::of_jacobians(jacobians.clone());
            let (moved, _) = space.moved(n).unwrap();
            prop_assume!(moved.ncols() > 1);
            let rank = 1 + rank % (moved.ncols().min(n) - 1);
            let (wanted, mut velocities) = (draw(n, 3 * COUNT), DMatrix::zeros(n, 3 * COUNT));
            // Amplification of rounding at nearly singular poses.
            let condition_of = |matrix: &DMatrix<f64>| {
                let lengths = matrix.singular_values();
                lengths.max() / lengths.min()
            };
            let mut condition: f64 = 1.0;
            for movement in 0..3 {
                let matrix = draw(rank, moved.ncols()) * moved.transpose();
                let bound = draw(rank, 1) * f64::from(u8::from(pushed));
                for (at, jacobian) in jacobians.iter().enumerate().skip(movement * COUNT).take(COUNT) {
                    let own = &matrix * jacobian;
                    condition = condition.max(condition_of(&own) * condition_of(&moved.tr_mul(jacobian)));
                    let inverse = (&own * own.transpose()).try_inverse().unwrap();
                    let off = &own * wanted.column(at) - bound.column(0);
                    velocities.set_column(at, &(wanted.column(at) - own.tr_mul(&(inverse * off))));
                }
            }
            prop_assume!(condition < 1e5);
            let allowed = (1e-14 * condition * velocities.amax()).max(1e-10);
            let indices = (0..3 * COUNT).map(|at| SampleIndex { trajectory: at / COUNT, sample: at % COUNT }).collect();
            let rows = Rows::new(states, velocities, indices).unwrap().with_task_spaces(vec![space]).unwrap();
            let found = Stretches::of(&rows, &View::in_space(&rows, 0).unwrap(), Switches::None).unwrap();
            prop_assert_eq!(found.all.len(), 3);
            for row in 0..rows.len() {
                let stretch = &found.all[row / COUNT];
                let free = found.through.as_ref().unwrap().free(&rows, row, &stretch.directions, &stretch.lengths);
                prop_assert_eq!(free.len(), n - rank);
                for Free { direction, .. } in free {
                    let apart = direction.dot(&(wanted.column(row) - rows.velocities().column(row)));
                    prop_assert!(apart.abs() < allowed && (direction.norm() - 1.0).abs() < 1e-12, "{apart} {condition}");
                }
            }
        }
    }
}
