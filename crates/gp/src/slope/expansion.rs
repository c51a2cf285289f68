#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::{DMatrix, DVector, DVectorView};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::kernel::block::Block;
use crate::kernel::chunks::{CHUNK, Chunk, Chunks, sum};
use crate::kernel::slope_covariance::{falling, policy_with, trend};
use crate::rows::scaling::Scaling;

/// (S7): the posterior mean as a sum over rows, in the form in which it is evaluated fast. The trend's sums are taken
/// once: they make a policy c + Qz.
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
    states: Chunks,
    directions: Chunks,
    weight_chunks: Vec<Chunk>,
    /// c, (n + p), 0 along the context, and Q, (n + p, n + p), symmetric but for the rotation of the state.
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
        // Σ α n zᵀ: its symmetric part is the quadratic block's, its skew part the skew block's.
        let outer = &weighted * z.transpose();
        let constant = weighted.column_sum() * linear;
        let mut rotation = &outer - outer.transpose();
        rotation.columns_mut(moving, dim - moving).fill(0.0);
        rotation.rows_mut(moving, dim - moving).fill(0.0);
        let matrix = (&outer + outer.transpose()) * quadratic + rotation * skew;
        let weight_row = DMatrix::from_row_slice(1, weights.len(), &weights);
        let weight_chunks = Chunks::new(&weight_row);
        Expansion {
            weight_chunks: (0..weight_chunks.len()).map(|chunk| weight_chunks.get(chunk)[0]).collect(),
            states: Chunks::new(&z),
            directions: Chunks::new(&n),
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

    /// The part of the blocks for which `stays`.
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

    /// π̂ at a state with its context, (n + p), into (n), in units of the state per second. Allocates nothing.
    pub(crate) fn action_into(&self, state: &[f64], action: &mut [f64]) {
        Arch::new().dispatch(Action { expansion: self, state, place: action });
        let z = |k: usize| self.scaling.coordinate(k, state[k]);
        for (k, action) in action.iter_mut().enumerate() {
            let sloped: f64 = (0..state.len()).map(|l| self.matrix[(k, l)] * z(l)).sum();
            *action = self.speed * (*action + (self.constant[k] + sloped));
        }
    }

    /// π̂ at each of the states with their contexts (n + p, M), (n, M).
    pub(crate) fn actions(&self, states: &DMatrix<f64>) -> DMatrix<f64> {
        let mut actions = DMatrix::zeros(self.moving(), states.ncols());
        let places = actions.as_mut_slice().par_chunks_mut(self.moving());
        places
            .zip(states.as_slice().par_chunks(self.dim()))
            .for_each(|(action, state)| self.action_into(state, action));
        actions
    }

    /// φ̂(x), in units of the state squared per second; meaningful without rotational blocks only. Allocates nothing.
    pub(crate) fn potential(&self, state: &[f64]) -> f64 {
        let falling = Arch::new().dispatch(Potential { expansion: self, state });
        let z = |k: usize| self.scaling.coordinate(k, state[k]);
        let sloped = |k: usize| (0..state.len()).map(|l| self.matrix[(k, l)] * z(l)).sum::<f64>();
        let trend: f64 = (0..state.len()).map(|k| z(k) * (self.constant[k] + 0.5 * sloped(k))).sum();
        -self.speed * self.scaling.scale * (falling + trend)
    }

    /// C_x of (S13): covariances of the policy at x, one column an axis, with every row's slope, (M, n).
    pub(crate) fn policy_with_rows(&self, state: DVectorView<'_, f64>) -> DMatrix<f64> {
        let z = self.scaling.of_state(state);
        let mut components = vec![[0.0; CHUNK]; self.moving()];
        let mut covariances = DMatrix::zeros(self.weights.len(), self.moving());
        for chunk in 0..self.states.len() {
            let rows = (self.states.get(chunk), self.directions.get(chunk));
            policy_with(z.as_slice(), rows, &self.blocks, &self.amplitudes, &mut components);
            let first = chunk * CHUNK;
            for (component, mut column) in components.iter().zip(covariances.column_iter_mut()) {
                let place = &mut column.as_mut_slice()[first..self.weights.len().min(first + CHUNK)];
                place.copy_from_slice(&component[..place.len()]);
            }
        }
        covariances
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

    /// Of one chunk of rows: n'ᵀ(z − z'), g and h.
    #[inline(always)]
    fn chunk(&self, chunk: usize, state: &[f64]) -> (Chunk, Chunk, Chunk) {
        let (states, directions) = (self.states.get(chunk), self.directions.get(chunk));
        let [mut squared, mut beta] = [[0.0; CHUNK]; 2];
        let moving_dim = self.moving();
        for (k, &x) in state[..moving_dim].iter().enumerate() {
            let z = self.scaling.coordinate(k, x);
            for lane in 0..CHUNK {
                let apart = z - states[k][lane];
                squared[lane] += apart * apart;
                beta[lane] += directions[k][lane] * apart;
            }
        }
        let moving = squared;
        for (k, &x) in state.iter().enumerate().skip(moving_dim) {
            let z = self.scaling.coordinate(k, x);
            for lane in 0..CHUNK {
                let apart = z - states[k][lane];
                squared[lane] += apart * apart;
            }
        }
        let sizes = (moving_dim, state.len());
        let (g, h) = falling(&self.blocks, &self.amplitudes, sizes, (&squared, &moving));
        (beta, g, h)
    }
}

fn weighted(n: &DMatrix<f64>, weights: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(n.nrows(), n.ncols(), |k, row| weights[row] * n[(k, row)])
}

/// Σ α (g n' − h β (z − z')) over all rows.
struct Action<'a> {
    expansion: &'a Expansion,
    state: &'a [f64],
    place: &'a mut [f64],
}

impl WithSimd for Action<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Action { expansion, state, place: action } = self;
        action.fill(0.0);
        for chunk in 0..expansion.states.len() {
            let (beta, g, h) = expansion.chunk(chunk, state);
            let weights = &expansion.weight_chunks[chunk];
            let [mut along, mut apart] = [[0.0; CHUNK]; 2];
            for lane in 0..CHUNK {
                along[lane] = weights[lane] * g[lane];
                apart[lane] = weights[lane] * h[lane] * beta[lane];
            }
            let (states, directions) = (expansion.states.get(chunk), expansion.directions.get(chunk));
            for (k, action) in action.iter_mut().enumerate() {
                let z = expansion.scaling.coordinate(k, state[k]);
                let mut terms = [0.0; CHUNK];
                for lane in 0..CHUNK {
                    terms[lane] = along[lane] * directions[k][lane] - apart[lane] * (z - states[k][lane]);
                }
                *action += sum(&terms);
            }
        }
    }
}

/// Σ α g β over all rows.
struct Potential<'a> {
    expansion: &'a Expansion,
    state: &'a [f64],
}

impl WithSimd for Potential<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> f64 {
        let mut total = 0.0;
        for chunk in 0..self.expansion.states.len() {
            let (beta, g, _) = self.expansion.chunk(chunk, self.state);
            let weights = &self.expansion.weight_chunks[chunk];
            let mut terms = [0.0; CHUNK];
            for lane in 0..CHUNK {
                terms[lane] = weights[lane] * g[lane] * beta[lane];
            }
            total += sum(&terms);
        }
        total
    }
}
