use motion::Certainty;
use nalgebra::{DMatrix, DMatrixView, DVectorViewMut};
use rayon::prelude::*;

/// Share of the prior variance that the rows explain, from 0 to 1; 0 if numbers overflow, so far from the rows that they explain nothing.
fn support(posterior: f64, prior: f64) -> f64 {
    let left = posterior / prior;
    if left.is_nan() { 0.0 } else { 1.0 - left.clamp(0.0, 1.0) }
}

/// Number of states whose actions are worth a task of their own.
const STATES_A_TASK: usize = 32;

/// Actions (n, N) at states with their contexts (n + p, N), computed in parallel; `action_into` writes one at a time.
pub(crate) fn each_action(
    moving: usize,
    states: DMatrixView<'_, f64>,
    action_into: impl Fn(&[f64], &mut [f64]) + Sync,
) -> DMatrix<f64> {
    let mut actions = DMatrix::zeros(moving, states.ncols());
    let part = |(part, actions): (usize, &mut [f64])| {
        for (at, action) in actions.chunks_exact_mut(moving).enumerate() {
            action_into(states.column(part * STATES_A_TASK + at).as_slice(), action);
        }
    };
    if states.ncols() <= STATES_A_TASK {
        part((0, actions.as_mut_slice()));
    } else {
        actions.as_mut_slice().par_chunks_mut(STATES_A_TASK * moving).enumerate().for_each(part);
    }
    actions
}

/// Number of columns of covariances that are whitened together: a panel of 1,500 rows then fits in the processor's level 2 cache.
const COLUMNS: usize = 64;

/// Variances of an action at some states, in squared units of the state per second.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Variances {
    /// Prior variances, (c, N).
    pub(crate) prior: DMatrix<f64>,
    /// Posterior variances given the rows, (c, N); rounding may make them negative.
    pub(crate) posterior: DMatrix<f64>,
}

impl Variances {
    /// Variances of `components` at states (n + p, N), computed in parallel blocks. `fill` writes the prior and posterior of a block of
    /// states, for which it whitens as many columns per state.
    pub(crate) fn of(
        states: DMatrixView<'_, f64>,
        components: usize,
        fill: impl Fn(DMatrixView<'_, f64>, &mut [f64], &mut [f64]) + Sync,
    ) -> Self {
        let count = states.ncols();
        let [mut prior, mut posterior] = [(); 2].map(|()| DMatrix::zeros(components, count));
        let together = (COLUMNS / components).max(1);
        let size = together * components;
        if count <= together {
            // Avoids a switch to another thread.
            fill(states, prior.as_mut_slice(), posterior.as_mut_slice());
            return Variances { prior, posterior };
        }
        let parts = prior.as_mut_slice().par_chunks_mut(size).zip(posterior.as_mut_slice().par_chunks_mut(size));
        parts.enumerate().for_each(|(part, (prior, posterior))| {
            fill(states.columns(part * together, prior.len() / components), prior, posterior);
        });
        Variances { prior, posterior }
    }

    /// The result of [`LearntPolicy::certainty`](motion::LearntPolicy::certainty) for variances `factor` times as large, where only
    /// `moving` of `dim` components vary.
    pub(crate) fn certainty(&self, factor: f64, moving: usize, dim: usize) -> Certainty {
        let columns = self.posterior.column_iter().zip(self.prior.column_iter());
        let support = columns.map(|(posterior, prior)| support(posterior.sum(), prior.sum())).collect();
        let deviation = |axis: usize, state: usize| {
            let variance = self.posterior[(axis.min(self.posterior.nrows() - 1), state)];
            if axis < moving { (factor * variance.max(0.0)).sqrt() } else { 0.0 }
        };
        Certainty { support, deviations: Some(DMatrix::from_fn(dim, self.posterior.ncols(), deviation)) }
    }
}

/// Whether states (n + p, N) have lost at least the share `least` of their prior variance. `some` decides for a block of states if few rows
/// suffice; otherwise `all` provides the variances.
pub(crate) fn supported(
    states: DMatrixView<'_, f64>,
    components: usize,
    least: f64,
    some: impl Fn(DMatrixView<'_, f64>) -> Vec<bool> + Sync,
    all: impl Fn(DMatrixView<'_, f64>) -> Variances,
) -> Vec<bool> {
    let together = (COLUMNS / components).max(1);
    let blocks = states.ncols().div_ceil(together);
    let block = |part: usize| {
        let first = part * together;
        some(states.columns(first, together.min(states.ncols() - first)))
    };
    let mut supported: Vec<bool> = if blocks <= 1 {
        (0..blocks).flat_map(block).collect()
    } else {
        (0..blocks).into_par_iter().flat_map_iter(block).collect()
    };
    let open: Vec<usize> = (0..supported.len()).filter(|&at| !supported[at]).collect();
    if !open.is_empty() {
        let Certainty { support, .. } = all(states.select_columns(&open).as_view()).certainty(1.0, 0, 0);
        for (at, support) in open.into_iter().zip(support) {
            supported[at] = support >= least;
        }
    }
    supported
}

/// Writes the deviations at the one requested state.
pub(crate) fn only_deviation_into(certainty: &Certainty, mut deviation: DVectorViewMut<'_, f64>) -> bool {
    let Some(deviations) = &certainty.deviations else { return false };
    deviation.copy_from(&deviations.column(0));
    true
}
