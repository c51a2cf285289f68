//! The policy's actions at the states of some rows.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use motion::LearntPolicy;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::Rows;

/// Number of rows whose actions are computed at once.
const TOGETHER: usize = 1024;

/// The policy at every row.
pub(super) struct PolicyAtRows<'a> {
    rows: &'a Rows,
    policy: &'a dyn LearntPolicy,
    /// (n, M).
    pub(super) actions: DMatrix<f64>,
    /// Mean variance of a component, computed on demand, because it costs far more than the action, and few rows are searched. One
    /// thread computes those of a movement, so that the batches are the same at any number of threads.
    variances: Mutex<HashMap<usize, f64>>,
}

impl<'a> PolicyAtRows<'a> {
    pub(super) fn of(rows: &'a Rows, policy: &'a dyn LearntPolicy) -> Self {
        let dim = rows.dim();
        let mut actions = DMatrix::zeros(dim, rows.len());
        let some = |(chunk, actions): (usize, &mut [f64])| {
            let states = rows.states().columns(chunk * TOGETHER, actions.len() / dim);
            let found = policy.actions(states.as_view());
            for (action, found) in actions.chunks_exact_mut(dim).zip(found.column_iter()) {
                action.copy_from_slice(&found.as_slice()[..dim]);
            }
        };
        actions.as_mut_slice().par_chunks_mut(dim * TOGETHER).enumerate().for_each(some);
        PolicyAtRows { rows, policy, actions, variances: Mutex::default() }
    }

    pub(super) fn variances(&self, rows: &[usize]) -> Vec<f64> {
        let known = || self.variances.lock().unwrap_or_else(PoisonError::into_inner);
        let new: Vec<usize> = {
            let known = known();
            rows.iter().copied().filter(|row| !known.contains_key(row)).collect()
        };
        if !new.is_empty() {
            let deviations = self.policy.certainty(self.rows.states().select_columns(&new).as_view()).deviations;
            let dim = self.rows.dim();
            known().extend(new.iter().enumerate().map(|(at, &row)| {
                let deviation = deviations.as_ref().map(|deviations| deviations.column(at));
                let square = deviation.map_or(0.0, |deviation| deviation.rows(0, dim).norm_squared());
                (row, square / dim as f64)
            }));
        }
        let known = known();
        rows.iter().map(|row| known[row]).collect()
    }

    /// Mean square of a component.
    pub(super) fn mean_square(&self) -> f64 {
        self.actions.norm_squared() / self.actions.len() as f64
    }
}
