use nalgebra::{DMatrix, DVector};

/// A space in whose coordinates a constraint may be constant: the recorded coordinates themselves, or the image of their velocities under a
/// Jacobian, such as a hand's position.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskSpace {
    /// Jacobian of each row, (m, n); `None` for the recorded coordinates.
    pub(crate) jacobians: Option<Vec<DMatrix<f64>>>,
}

impl TaskSpace {
    /// The recorded coordinates: v = u.
    pub fn recorded() -> Self {
        TaskSpace { jacobians: None }
    }

    /// v = J(x) u, with the J (m, n) of each row, in order.
    pub fn of_jacobians(jacobians: Vec<DMatrix<f64>>) -> Self {
        TaskSpace { jacobians: Some(jacobians) }
    }

    /// The same space for velocities that were multiplied by these factors (n), as those learnt from are.
    #[must_use]
    pub fn scaled(mut self, factors: &DVector<f64>) -> Self {
        for jacobian in self.jacobians.iter_mut().flatten() {
            jacobian.column_iter_mut().zip(factors).for_each(|(mut column, factor)| column /= *factor);
        }
        self
    }

    /// Whether there is a Jacobian of the right shape for each of `rows` states (n).
    pub(crate) fn fits(&self, rows: usize, dim: usize) -> bool {
        self.jacobians.as_ref().is_none_or(|jacobians| {
            let first = jacobians.first().map_or(0, DMatrix::nrows);
            let right = |j: &DMatrix<f64>| j.shape() == (first, dim) && j.iter().all(|value| value.is_finite());
            jacobians.len() == rows && first > 0 && jacobians.iter().all(right)
        })
    }

    /// The same space for other rows, whose Jacobians `of` computes from these.
    #[must_use]
    pub(crate) fn with_rows(&self, of: impl FnOnce(&[DMatrix<f64>]) -> Vec<DMatrix<f64>>) -> Self {
        TaskSpace { jacobians: self.jacobians.as_deref().map(of) }
    }

    /// Orthonormal directions (m, m') in which the space ever moves, and the mean square response to unit velocities along the least of
    /// them: a planar arm moves only in a plane of space. `None` if there is none.
    pub(crate) fn moved(&self, dim: usize) -> Option<(DMatrix<f64>, f64)> {
        if self.jacobians.is_none() {
            return Some((DMatrix::identity(dim, dim), 1.0));
        }
        self.gains().map(|(directions, gains)| (directions, gains.min()))
    }

    /// W of (S40), (m', m), for some of the rows, which makes the mean of WJJᵀWᵀ equal I. Noise of u is then the same along all
    /// `directions` of motion (m, m'), whatever their units. `None` for the recorded coordinates, or if nothing moves.
    pub(crate) fn evening(&self, directions: &DMatrix<f64>, rows: &[usize]) -> Option<DMatrix<f64>> {
        let jacobians = self.jacobians.as_ref()?;
        let own = |&row: &usize| directions.tr_mul(&jacobians[row]);
        let sum: DMatrix<f64> = rows.iter().map(own).map(|own| &own * own.transpose()).sum();
        let eigen = (sum / rows.len() as f64).symmetric_eigen();
        let least = NEVER * eigen.eigenvalues.max();
        let evening = eigen.eigenvalues.map(|gain| gain.max(least).sqrt().recip());
        (least > 0.0).then(|| DMatrix::from_diagonal(&evening) * (directions * eigen.eigenvectors).transpose())
    }

    /// Directions of motion, and the mean square response to unit velocities along each.
    pub(crate) fn gains(&self) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let jacobians = self.jacobians.as_ref()?;
        let m = jacobians.first()?.nrows();
        let sum = jacobians.iter().fold(DMatrix::zeros(m, m), |sum, j| sum + j * j.transpose());
        let eigen = (sum / jacobians.len() as f64).symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let moved: Vec<usize> = (0..m).filter(|&k| eigen.eigenvalues[k] > NEVER * largest).collect();
        (largest > 0.0).then(|| (eigen.eigenvectors.select_columns(&moved), eigen.eigenvalues.select_rows(&moved)))
    }
}

/// Share of the mean square below which there is no motion along a direction.
const NEVER: f64 = 1e-12;
