//! What a policy wants at the states of some rows.

use std::sync::OnceLock;

use motion::LearntPolicy;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::Rows;

/// The policy at every row.
pub(super) struct Wanted<'a> {
    rows: &'a Rows,
    policy: &'a dyn LearntPolicy,
    /// (n, M).
    pub(super) actions: DMatrix<f64>,
    /// Mean variance of a component, once it is asked for: it costs far more than the action, and few rows are searched. Those of one
    /// movement are asked for by one thread, so that the same are asked for together at any number of threads.
    variances: Vec<OnceLock<f64>>,
}

impl<'a> Wanted<'a> {
    pub(super) fn of(rows: &'a Rows, policy: &'a dyn LearntPolicy) -> Self {
        let at = |row: usize| policy.action(rows.states().column(row)).resize_vertically(rows.dim(), 0.0);
        let actions: Vec<DVector<f64>> = (0..rows.len()).into_par_iter().map(at).collect();
        let variances = vec![OnceLock::new(); rows.len()];
        Wanted { rows, policy, actions: DMatrix::from_columns(&actions), variances }
    }

    pub(super) fn variances(&self, rows: &[usize]) -> Vec<f64> {
        let new: Vec<usize> = rows.iter().copied().filter(|&row| self.variances[row].get().is_none()).collect();
        if !new.is_empty() {
            let deviations = self.policy.certainty(self.rows.states().select_columns(&new).as_view()).deviations;
            let dim = self.rows.dim();
            for (at, &row) in new.iter().enumerate() {
                let deviation = deviations.as_ref().map(|deviations| deviations.column(at));
                let square = deviation.map_or(0.0, |deviation| deviation.rows(0, dim).norm_squared());
                self.variances[row].get_or_init(|| square / dim as f64);
            }
        }
        rows.iter().map(|&row| self.variances[row].get().copied().unwrap_or(0.0)).collect()
    }

    /// Of a component.
    pub(super) fn mean_square(&self) -> f64 {
        self.actions.norm_squared() / self.actions.len() as f64
    }
}
