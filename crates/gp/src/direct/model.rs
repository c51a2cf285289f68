#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use motion::Policy;
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::dimension::require;
use crate::kernel::chunks::{CHUNK, Chunks, sum};
use crate::kernel::direct_block::{DirectBlock, DirectCovariance, combined, covariances_with};
use crate::kernel::whitening::Whitening;
use crate::rows::scaling::Scaling;

/// States whose triangular systems are solved together.
const TOGETHER: usize = 32;

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
    states: Chunks,
    weight_chunks: Chunks,
}

impl DirectModel {
    pub(crate) fn new(
        (scaling, unit): (Scaling, f64),
        (blocks, amplitudes): (Vec<DirectBlock>, Vec<f64>),
        z: DMatrix<f64>,
        weights: DMatrix<f64>,
        (noise, whitening): (f64, Whitening),
    ) -> Self {
        let (states, weight_chunks) = (Chunks::new(&z), Chunks::new(&weights));
        DirectModel { scaling, unit, blocks, amplitudes, z, weights, noise, whitening, states, weight_chunks }
    }

    /// (R4): variance of every component at a state, in squared units of the state per second. Costs M².
    pub fn variance(&self, state: DVectorView<'_, f64>) -> f64 {
        self.variances_of(&[state]).remove(0)
    }

    /// The same at each of some states, (n + p, N).
    pub(crate) fn variances(&self, states: &DMatrix<f64>) -> Vec<f64> {
        let states: Vec<DVectorView<'_, f64>> = states.column_iter().collect();
        states.chunks(TOGETHER).flat_map(|states| self.variances_of(states)).collect()
    }

    /// One solution of triangular systems for all.
    fn variances_of(&self, states: &[DVectorView<'_, f64>]) -> Vec<f64> {
        let mut known = DMatrix::zeros(self.z.ncols(), states.len());
        for (state, mut known) in states.iter().zip(known.column_iter_mut()) {
            require(self.dim(), &[state.len()]);
            let z = self.scaling.of_state(*state);
            for (chunk, place) in known.as_mut_slice().chunks_mut(CHUNK).enumerate() {
                let values = covariances_with(z.as_slice(), self.states.get(chunk), &self.blocks, &self.amplitudes);
                place.copy_from_slice(&values[..place.len()]);
            }
        }
        let covariance = DirectCovariance { blocks: &self.blocks, z: &self.z };
        self.whitening.apply(&mut known, &covariance, &self.amplitudes, self.noise);
        let each = states.iter().zip(known.column_iter());
        each.map(|(state, known)| self.prior_variance(*state) - self.unit.powi(2) * known.norm_squared()).collect()
    }

    /// Prior variance of every component at a state, in the same units.
    pub fn prior_variance(&self, state: DVectorView<'_, f64>) -> f64 {
        let z = self.scaling.of_state(state);
        let each = self.blocks.iter().zip(&self.amplitudes);
        let scaled: f64 = each.map(|(block, amplitude)| amplitude * block.covariance(z.as_view(), z.as_view())).sum();
        self.unit.powi(2) * scaled
    }

    /// û at each of the states with their contexts (n + p, M), (n, M).
    pub(crate) fn actions(&self, states: &DMatrix<f64>) -> DMatrix<f64> {
        let mut actions = DMatrix::zeros(self.weights.nrows(), states.ncols());
        let places = actions.as_mut_slice().par_chunks_mut(self.weights.nrows());
        places
            .zip(states.as_slice().par_chunks(states.nrows()))
            .for_each(|(action, state)| Arch::new().dispatch(Action { model: self, state, place: action }));
        actions
    }
}

/// û(x) = ū k(x)ᵀA.
struct Action<'a> {
    model: &'a DirectModel,
    state: &'a [f64],
    place: &'a mut [f64],
}

impl WithSimd for Action<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Action { model, state, place: action } = self;
        action.fill(0.0);
        let z = |k: usize| model.scaling.coordinate(k, state[k]);
        for chunk in 0..model.states.len() {
            let covariances = combined(z, model.states.get(chunk), &model.blocks, &model.amplitudes);
            for (action, weights) in action.iter_mut().zip(model.weight_chunks.get(chunk)) {
                let mut terms = [0.0; CHUNK];
                for lane in 0..CHUNK {
                    terms[lane] = covariances[lane] * weights[lane];
                }
                *action += sum(&terms);
            }
        }
        for action in action {
            *action *= model.unit;
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
        Arch::new().dispatch(Action { model: self, state: state.as_slice(), place: moving });
        still.fill(0.0);
    }
}
