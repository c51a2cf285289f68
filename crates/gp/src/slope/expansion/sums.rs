//! Sums over rows in vector registers, one row per lane, added group after group, so that every width gives the same bits.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::{LANES, Number, Register, total};
use nalgebra::DMatrix;
use pulp::Simd;

use super::Expansion;
use crate::kernel::row_table::{Abreast, GROUPS, OverRows, firsts};
use crate::rows::scaling::FEW;

/// Computes Σ α (g n' − h β (z − z')) over all rows at a scaled state `z`, (n + p), into (n).
pub(super) struct Action<'a> {
    pub(super) expansion: &'a Expansion,
    pub(super) z: &'a [f64],
    pub(super) place: &'a mut [f64],
}

/// Computes Σ α g β over all rows.
pub(super) struct PotentialSum<'a> {
    pub(super) expansion: &'a Expansion,
    pub(super) z: &'a [f64],
}

/// Computes C_x of (S13).
pub(super) struct PolicyWithRows<'a> {
    pub(super) expansion: &'a Expansion,
    pub(super) z: &'a [f64],
    pub(super) covariances: &'a mut DMatrix<f64>,
}

/// Some rows, relative to a state.
struct RelativeRows<'a, S: Simd, const U: usize> {
    /// z', (n + p).
    states: &'a [Abreast],
    /// n', (n).
    directions: &'a [Abreast],
    weight: [Register<S>; U],
    /// n'ᵀ(z − z').
    beta: [Register<S>; U],
    g: [Register<S>; U],
    h: [Register<S>; U],
}

impl Expansion {
    /// Register `part` of U groups, from `first` on, of rows that are stored together.
    #[inline(always)]
    fn rows<'a, S: Simd, const U: usize>(
        &self,
        simd: S,
        rows: &'a [Abreast],
        z: &[f64],
        (first, part): (usize, usize),
    ) -> RelativeRows<'a, S, U> {
        let moving = rows.len() - 1 - z.len();
        let (states, rest) = rows.split_at(z.len());
        let (directions, weight) = rest.split_at(moving);
        let [mut squared, mut beta] = [[Register::splat(simd, 0.0); U]; 2];
        let (z, context) = z.split_at(moving);
        for ((&z, state), direction) in z.iter().zip(states).zip(directions) {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            let direction = direction.load::<S, U>(simd, first, part);
            for u in 0..U {
                let apart = z - state[u];
                squared[u] = apart.mul_add(apart, squared[u]);
                beta[u] = direction[u].mul_add(apart, beta[u]);
            }
        }
        let along = squared;
        for (&z, state) in context.iter().zip(&states[moving..]) {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            for u in 0..U {
                let apart = z - state[u];
                squared[u] = apart.mul_add(apart, squared[u]);
            }
        }
        let (g, h) = self.falling.slopes(squared, along);
        RelativeRows { states, directions, weight: weight[0].load(simd, first, part), beta, g, h }
    }
}

impl OverRows for Action<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const U: usize>(self, simd: S) {
        let Action { expansion, z, place } = self;
        for (few, action) in place.chunks_mut(FEW).enumerate() {
            let mut sums = [[0.0; LANES]; FEW];
            let sums = &mut sums[..action.len()];
            for part in 0..Register::<S>::parts() {
                for rows in expansion.table.together() {
                    for first in firsts::<U>() {
                        let rows = expansion.rows::<S, U>(simd, rows, z, (first, part));
                        rows.add_action((z, few * FEW), (first, part), sums);
                    }
                }
            }
            for (action, sum) in action.iter_mut().zip(sums) {
                *action = total(*sum);
            }
        }
    }
}

impl<S: Simd, const U: usize> RelativeRows<'_, S, U> {
    /// Adds the rows' parts of the action, from axis `from` on, to register `part` of its sums.
    #[inline(always)]
    fn add_action(&self, (z, from): (&[f64], usize), (first, part): (usize, usize), sums: &mut [[f64; LANES]]) {
        let simd = self.g[0].token();
        let along: [_; U] = std::array::from_fn(|u| self.weight[u] * self.g[u]);
        let apart: [_; U] = std::array::from_fn(|u| self.weight[u] * self.h[u] * self.beta[u]);
        let axes = z[from..].iter().zip(&self.states[from..]).zip(&self.directions[from..]);
        for (((&z, state), direction), place) in axes.zip(sums) {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            let direction = direction.load::<S, U>(simd, first, part);
            let mut sum = Register::load(simd, place, part);
            for u in 0..U {
                sum = apart[u].mul_add(state[u] - z, along[u].mul_add(direction[u], sum));
            }
            sum.store(place, part);
        }
    }
}

impl OverRows for PotentialSum<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Simd, const U: usize>(self, simd: S) -> f64 {
        let mut sums = [0.0; LANES];
        for part in 0..Register::<S>::parts() {
            let mut sum = Register::splat(simd, 0.0);
            for rows in self.expansion.table.together() {
                for first in firsts::<U>() {
                    let rows = self.expansion.rows::<S, U>(simd, rows, self.z, (first, part));
                    for u in 0..U {
                        sum = (rows.weight[u] * rows.g[u]).mul_add(rows.beta[u], sum);
                    }
                }
            }
            sum.store(&mut sums, part);
        }
        total(sums)
    }
}

impl OverRows for PolicyWithRows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const U: usize>(self, simd: S) {
        let PolicyWithRows { expansion, z, covariances } = self;
        let height = covariances.nrows();
        for part in 0..Register::<S>::parts() {
            for (at, rows) in expansion.table.together().enumerate() {
                for first in firsts::<U>() {
                    let rows = expansion.rows::<S, U>(simd, rows, z, (first, part));
                    let columns = covariances.as_mut_slice().chunks_exact_mut(height);
                    let places = columns.map(|column| &mut column.as_chunks_mut().0[at * GROUPS + first..][..U]);
                    rows.covariances(expansion.trend, z, (first, part), places);
                }
            }
        }
    }
}

impl<S: Simd, const U: usize> RelativeRows<'_, S, U> {
    /// Covariances of each axis with the rows' slopes: g n' − h β (z − z'), and a trend's a n' + b (n' zᵀz' + z' n'ᵀz) + c (n'
    /// xᵀx' − z' n'ᵀz), where x is the state in z.
    #[inline(always)]
    fn covariances<'p>(
        &self,
        [linear, quadratic, skew]: [f64; 3],
        z: &[f64],
        (first, part): (usize, usize),
        places: impl Iterator<Item = &'p mut [[f64; LANES]]>,
    ) {
        let simd = self.g[0].token();
        let [mut whole, mut turned] = [[Register::splat(simd, 0.0); U]; 2];
        let mut moving = whole;
        for (k, (&z, state)) in z.iter().zip(self.states).enumerate() {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            for u in 0..U {
                whole[u] = state[u].mul_add(z, whole[u]);
            }
            let Some(direction) = self.directions.get(k) else { continue };
            let direction = direction.load::<S, U>(simd, first, part);
            for u in 0..U {
                moving[u] = state[u].mul_add(z, moving[u]);
                turned[u] = direction[u].mul_add(z, turned[u]);
            }
        }
        let along: [_; U] = std::array::from_fn(|u| self.g[u] + (whole[u] * quadratic + moving[u] * skew + linear));
        let turned = turned.map(|turned| turned * (quadratic - skew));
        let apart: [_; U] = std::array::from_fn(|u| self.h[u] * self.beta[u]);
        let axes = z.iter().zip(self.states).zip(self.directions);
        for (((&z, state), direction), place) in axes.zip(places) {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            let direction = direction.load::<S, U>(simd, first, part);
            for u in 0..U {
                let trend = along[u].mul_add(direction[u], turned[u] * state[u]);
                apart[u].mul_add(state[u] - z, trend).store(&mut place[u], part);
            }
        }
    }
}
