//! (S7) and its evaluation.

mod sums;

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};

use crate::kernel::block::Block;
use crate::kernel::falling::Falling;
use crate::kernel::panel::Panel;
use crate::kernel::row_table::{RowTable, TOGETHER, over_rows};
use crate::kernel::slope_covariance::trend;
use crate::kernel::term::Term;
use crate::rows::scaling::Scaling;
use crate::support::each_action;
use sums::{Action, PolicyWithRows, PotentialSum};

/// (S7): the posterior mean as a sum over rows, in a form that is fast to evaluate. The trend's sums are computed once and give a
/// policy c + Qz.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Expansion {
    pub(crate) scaling: Scaling,
    pub(crate) speed: f64,
    pub(crate) blocks: Vec<Block>,
    pub(crate) amplitudes: Vec<f64>,
    /// Scaled states and contexts, (n + p, M).
    pub(crate) z: DMatrix<f64>,
    /// Directions, (n, M).
    pub(crate) n: DMatrix<f64>,
    /// α, (M).
    pub(crate) weights: Vec<f64>,
    /// z', n' and α of every row.
    table: RowTable,
    pub(crate) falling: Falling,
    /// From [`trend`].
    trend: [f64; 3],
    /// c, (n + p), 0 along the context, and Q, (n + p, n + p), symmetric except for the rotation of the state.
    pub(crate) constant: DVector<f64>,
    pub(crate) matrix: DMatrix<f64>,
}

impl Expansion {
    pub(crate) fn new(
        (scaling, speed): (Scaling, f64),
        (blocks, amplitudes): (Vec<Block>, Vec<f64>),
        (z, n): (DMatrix<f64>, DMatrix<f64>),
        weights: Vec<f64>,
    ) -> Self {
        let (moving, dim) = (n.nrows(), z.nrows());
        let [linear, quadratic, skew] = trend(&blocks, &amplitudes, (moving, dim));
        let weighted = weighted(&n, &weights).resize_vertically(dim, 0.0);
        // Σ α n zᵀ: its symmetric part belongs to the quadratic block, its skew part to the skew block.
        let outer = &weighted * z.transpose();
        let constant = weighted.column_sum() * linear;
        let mut rotation = &outer - outer.transpose();
        rotation.columns_mut(moving, dim - moving).fill(0.0);
        rotation.rows_mut(moving, dim - moving).fill(0.0);
        let matrix = (&outer + outer.transpose()) * quadratic + rotation * skew;
        let weight_row = DMatrix::from_row_slice(1, weights.len(), &weights);
        Expansion {
            table: RowTable::new(&[&z, &n, &weight_row]),
            falling: Falling::of_slopes(&Term::of_slopes(&blocks, &amplitudes, dim), moving),
            trend: [linear, quadratic, skew],
            scaling,
            speed,
            blocks,
            amplitudes,
            z,
            n,
            weights,
            constant,
            matrix,
        }
    }

    /// The part with the blocks for which `stays` is true.
    pub(crate) fn part(&self, stays: impl Fn(Block) -> bool) -> Self {
        let both = self.blocks.iter().zip(&self.amplitudes).filter(|(block, _)| stays(**block));
        let (blocks, amplitudes) = both.map(|(block, amplitude)| (*block, *amplitude)).unzip();
        let scaled = (self.scaling.clone(), self.speed);
        Expansion::new(scaled, (blocks, amplitudes), (self.z.clone(), self.n.clone()), self.weights.clone())
    }

    /// α n, (n, M).
    pub(crate) fn weighted(&self) -> DMatrix<f64> {
        weighted(&self.n, &self.weights)
    }

    /// Dimension n of the state, without its context.
    pub(crate) fn moving(&self) -> usize {
        self.n.nrows()
    }

    /// Dimension n + p of state and context.
    pub(crate) fn dim(&self) -> usize {
        self.z.nrows()
    }

    /// Computes π̂ at a state with its context, (n + p), into (n), in units of the state per second. Does not allocate.
    pub(crate) fn action_into(&self, state: &[f64], action: &mut [f64]) {
        self.scaling.with_coordinates(state, |z| {
            over_rows(Action { expansion: self, z, place: action });
            for (k, action) in action.iter_mut().enumerate() {
                *action = self.speed * (*action + (self.constant[k] + self.sloped(k, z)));
            }
        });
    }

    /// π̂ at states with their contexts (n + p, N), (n, N), computed in parallel with the same bits as one by one.
    pub(crate) fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        each_action(self.moving(), states, |state, action| self.action_into(state, action))
    }

    /// φ̂(x), in units of the state squared per second; meaningful only without rotational blocks. Does not allocate.
    pub(crate) fn potential(&self, state: &[f64]) -> f64 {
        self.scaling.with_coordinates(state, |z| {
            let falling = over_rows(PotentialSum { expansion: self, z });
            let each = z.iter().enumerate();
            let trend: f64 = each.map(|(k, z_k)| z_k * (self.constant[k] + 0.5 * self.sloped(k, z))).sum();
            -self.speed * self.scaling.scale * (falling + trend)
        })
    }

    /// C_x of (S13): covariances of the policy at x, one column per axis, with every row's slope, (M, n), followed by meaningless
    /// rows.
    pub(crate) fn policy_with_rows(&self, state: &[f64]) -> DMatrix<f64> {
        let mut covariances = DMatrix::zeros(self.weights.len().next_multiple_of(TOGETHER), self.moving());
        self.scaling.with_coordinates(state, |z| {
            over_rows(PolicyWithRows { expansion: self, z, covariances: &mut covariances });
        });
        covariances
    }

    /// [`policy_with_rows`](Self::policy_with_rows) at several states: n columns per state, (M, n N).
    pub(crate) fn policy_with_rows_at(&self, states: &[DVectorView<'_, f64>]) -> Panel {
        let mut panel = Panel::zeros(self.weights.len(), self.moving() * states.len());
        for (at, state) in states.iter().enumerate() {
            let covariances = self.policy_with_rows(state.as_slice());
            for (axis, column) in covariances.as_slice().chunks_exact(covariances.nrows()).enumerate() {
                panel.set_column(at * self.moving() + axis, &column[..self.weights.len()]);
            }
        }
        panel
    }

    /// Element k of Qz.
    fn sloped(&self, k: usize, z: &[f64]) -> f64 {
        z.iter().enumerate().map(|(l, z)| self.matrix[(k, l)] * z).sum()
    }

    /// Prior covariance of the policy at `z`, (n + p), in scaled units, as a and b of a I + b xxᵀ, where x is the state in z: (S3)
    /// with z' = z.
    pub(crate) fn prior(&self, z: &[f64]) -> (f64, f64) {
        let squared_norm = |z: &[f64]| z.iter().map(|z| z * z).sum::<f64>();
        let ([g], _) = self.falling.slopes([0.0], [0.0]);
        let [linear, quadratic, skew] = self.trend;
        (g + linear + quadratic * squared_norm(z) + skew * squared_norm(&z[..self.moving()]), quadratic - skew)
    }

    /// c of (S14): covariances (S4) of the potential at `z`, (n + p), with every row's slope, (M, 1).
    pub(crate) fn potential_with_rows(&self, z: &DVector<f64>) -> DMatrix<f64> {
        let with_row = |row: usize| {
            let each = self.blocks.iter().zip(&self.amplitudes);
            each.map(|(block, amplitude)| {
                amplitude * block.potential_slope(z.as_view(), self.z.column(row), self.n.column(row)).unwrap_or(0.0)
            })
            .sum()
        };
        DMatrix::from_iterator(self.weights.len(), 1, (0..self.weights.len()).map(with_row))
    }
}

fn weighted(n: &DMatrix<f64>, weights: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(n.nrows(), n.ncols(), |k, row| weights[row] * n[(k, row)])
}
