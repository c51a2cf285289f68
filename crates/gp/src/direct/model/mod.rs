//! The conditioned model and its evaluation.

mod sums;

use motion::Policy;
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};

use crate::dimension::require;
use crate::kernel::direct_block::{DirectBlock, DirectCovariance, trend};
use crate::kernel::falling::Falling;
use crate::kernel::lazy_factor::LazyFactor;
use crate::kernel::panel::Panel;
use crate::kernel::row_table::{RowTable, TOGETHER, over_rows};
use crate::kernel::term::Term;
use crate::kernel::whitening::Whitening;
use crate::rows::scaling::Scaling;
use crate::screening_subset::ScreeningSubset;
use crate::support::{Variances, each_action, supported};
use sums::{Action, CovariancesWithRows};

/// The direct GP conditioned on rows: û and its variance (R4).
#[derive(Debug, Clone)]
pub struct DirectModel {
    pub(crate) scaling: Scaling,
    pub(crate) unit: f64,
    pub(crate) blocks: Vec<DirectBlock>,
    pub(crate) amplitudes: Vec<f64>,
    pub(crate) z: DMatrix<f64>,
    /// A, (n, M).
    pub(crate) weights: DMatrix<f64>,
    pub(crate) noise: f64,
    pub(crate) whitening: Whitening,
    /// z' and A of every row.
    table: RowTable,
    pub(crate) falling: Falling,
    /// From [`trend`].
    trend: [f64; 3],
    screening: ScreeningSubset<Box<DirectModel>>,
}

impl DirectModel {
    pub(crate) fn new(
        (scaling, unit): (Scaling, f64),
        (blocks, amplitudes): (Vec<DirectBlock>, Vec<f64>),
        z: DMatrix<f64>,
        weights: DMatrix<f64>,
        (noise, whitening): (f64, Whitening),
    ) -> Self {
        let table = RowTable::new(&[&z, &weights]);
        let falling = Falling::of_values(&Term::of_velocities(&blocks, &amplitudes, z.nrows()));
        let trend = trend(&blocks, &amplitudes, z.nrows());
        let screening = ScreeningSubset::default();
        DirectModel {
            scaling,
            unit,
            blocks,
            amplitudes,
            z,
            weights,
            noise,
            whitening,
            table,
            falling,
            trend,
            screening,
        }
    }

    /// (R4): variance of each component at a state, in squared units of the state per second. Costs M².
    pub fn variance(&self, state: DVectorView<'_, f64>) -> f64 {
        require(self.dim(), &[state.len()]);
        self.variances(state.as_view()).posterior[0]
    }

    /// Prior variance of each component at a state, in the same units.
    pub fn prior_variance(&self, state: DVectorView<'_, f64>) -> f64 {
        let z = self.scaling.of_state(state);
        let each = self.blocks.iter().zip(&self.amplitudes);
        let scaled: f64 = each.map(|(block, amplitude)| amplitude * block.covariance(z.as_view(), z.as_view())).sum();
        self.unit.powi(2) * scaled
    }

    /// Posterior (R4) and prior variance, equal for all components, at states with their contexts (n + p, N), both (1, N), computed
    /// in parallel. A single state gets the same bits as among others. Costs M² per state.
    pub(crate) fn variances(&self, states: DMatrixView<'_, f64>) -> Variances {
        Variances::of(states, 1, |states, prior, posterior| {
            let mut known = self.with_rows(states);
            let covariance = DirectCovariance { blocks: &self.blocks, z: &self.z };
            self.whitening.apply(&mut known, &covariance, &self.amplitudes, self.noise);
            for (at, known) in known.squared_norms().into_iter().enumerate() {
                prior[at] = self.prior_variance(states.column(at));
                posterior[at] = prior[at] - self.unit.powi(2) * known;
            }
        })
    }

    /// k of (R4) at states, one column each, (M, N).
    fn with_rows(&self, states: DMatrixView<'_, f64>) -> Panel {
        let mut panel = Panel::zeros(self.z.ncols(), states.ncols());
        let mut covariances = vec![0.0; self.z.ncols().next_multiple_of(TOGETHER)];
        for (at, state) in states.column_iter().enumerate() {
            self.scaling.with_coordinates(state.as_slice(), |z| {
                over_rows(CovariancesWithRows { model: self, z, covariances: &mut covariances });
            });
            panel.set_column(at, &covariances[..self.z.ncols()]);
        }
        panel
    }

    /// Whether the support of states with their contexts (n + p, N) is at least `least`, according to their
    /// [`variances`](Self::variances).
    pub(crate) fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        let DirectModel { scaling, unit, blocks, amplitudes, z, weights, noise, whitening, .. } = self;
        let part = |rows: &[usize]| {
            // The part is never whitened as a whole.
            let unused = Whitening::Rows { noise_weights: vec![1.0; rows.len()], factor: LazyFactor::default() };
            let (prior, noise) = ((blocks.clone(), amplitudes.clone()), (*noise, unused));
            let [z, weights] = [z, weights].map(|of| of.select_columns(rows));
            Box::new(DirectModel::new((scaling.clone(), *unit), prior, z, weights, noise))
        };
        let prior_of = (&DirectCovariance { blocks, z }, &amplitudes[..], *noise);
        let some = |states: DMatrixView<'_, f64>| {
            let Some((part, factor)) = self.screening.part(z.ncols(), whitening, prior_of, part) else {
                return vec![false; states.ncols()];
            };
            let prior: Vec<f64> = states.column_iter().map(|state| self.prior_variance(state)).collect();
            self.screening.explains(factor, part.with_rows(states), &prior, (unit.powi(2), least))
        };
        supported(states, 1, least, some, |states| self.variances(states))
    }

    /// û at states with their contexts (n + p, N), (n, N), computed in parallel with the same bits as one by one.
    pub(crate) fn moving_actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        each_action(self.weights.nrows(), states, |state, action| self.moving_action_into(state, action))
    }

    fn moving_action_into(&self, state: &[f64], action: &mut [f64]) {
        self.scaling.with_coordinates(state, |z| over_rows(Action { model: self, z, place: action }));
        for action in action {
            *action *= self.unit;
        }
    }
}

impl Policy for DirectModel {
    fn dim(&self) -> usize {
        self.z.nrows()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        require(self.dim(), &[state.len(), action.len()]);
        let (moving, still) = action.as_mut_slice().split_at_mut(self.weights.nrows());
        self.moving_action_into(state.as_slice(), moving);
        still.fill(0.0);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        require(self.dim(), &[states.nrows()]);
        self.moving_actions(states).resize_vertically(self.dim(), 0.0)
    }
}
