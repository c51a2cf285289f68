use nalgebra::{DMatrix, DVector};

/// A space in whose coordinates a constraint may be constant: the recorded coordinates themselves, or what a Jacobian makes
/// of their velocities, such as a hand's position.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskSpace {
    /// Of every row, (m, n); none for the recorded coordinates.
    pub(super) jacobians: Option<Vec<DMatrix<f64>>>,
}

impl TaskSpace {
    /// The recorded coordinates: v = u.
    pub fn recorded() -> Self {
        TaskSpace { jacobians: None }
    }

    /// v = J(x) u, with J (m, n) of every row, in their order.
    pub fn of_jacobians(jacobians: Vec<DMatrix<f64>>) -> Self {
        TaskSpace { jacobians: Some(jacobians) }
    }

    /// The same space where velocities are multiplied by these factors (n) first, as those learnt from are.
    #[must_use]
    pub fn scaled(mut self, factors: &DVector<f64>) -> Self {
        for jacobian in self.jacobians.iter_mut().flatten() {
            jacobian.column_iter_mut().zip(factors).for_each(|(mut column, factor)| column /= *factor);
        }
        self
    }

    /// Whether there is a Jacobian of the right shape for each of `rows` states (n).
    pub(super) fn fits(&self, rows: usize, dim: usize) -> bool {
        self.jacobians.as_ref().is_none_or(|jacobians| {
            let first = jacobians.first().map_or(0, DMatrix::nrows);
            let right = |j: &DMatrix<f64>| j.shape() == (first, dim) && j.iter().all(|value| value.is_finite());
            jacobians.len() == rows && first > 0 && jacobians.iter().all(right)
        })
    }

    /// Orthonormal directions (m, m') in which anything ever moves, and the mean square of what unit velocities do along
    /// the least of them: a planar arm moves in a plane of space only. None if there is none.
    pub(super) fn moved(&self, dim: usize) -> Option<(DMatrix<f64>, f64)> {
        let Some(jacobians) = &self.jacobians else { return Some((DMatrix::identity(dim, dim), 1.0)) };
        let m = jacobians.first()?.nrows();
        let sum = jacobians.iter().fold(DMatrix::zeros(m, m), |sum, j| sum + j * j.transpose());
        let eigen = (sum / jacobians.len() as f64).symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let moved: Vec<usize> = (0..m).filter(|&k| eigen.eigenvalues[k] > NEVER * largest).collect();
        let of: DVector<f64> = eigen.eigenvalues.select_rows(&moved);
        (largest > 0.0).then(|| (eigen.eigenvectors.select_columns(&moved), of.min()))
    }
}

/// Share of the mean square below which a direction never moves.
const NEVER: f64 = 1e-12;
