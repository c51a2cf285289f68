//! Sums over rows in vector registers, one row per lane, added group after group, so that every width gives the same
//! bits.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use lanes::{LANES, Lanes, Number, Register, total};
use pulp::Simd;

use super::DirectModel;
use crate::kernel::row_table::{Abreast, GROUPS, OverRows, firsts};
use crate::rows::scaling::FEW;

/// Computes k(x)ᵀA at a scaled state `z`, (n + p), into (n).
pub(super) struct Action<'a> {
    pub(super) model: &'a DirectModel,
    pub(super) z: &'a [f64],
    pub(super) place: &'a mut [f64],
}

/// Computes k(x), (M), followed by meaningless numbers.
pub(super) struct CovariancesWithRows<'a> {
    pub(super) model: &'a DirectModel,
    pub(super) z: &'a [f64],
    pub(super) covariances: &'a mut [f64],
}

impl DirectModel {
    /// Covariances with register `part` of U groups, from `first` on, of rows that are stored together.
    #[inline(always)]
    fn covariances<S: Simd, const U: usize>(
        &self,
        simd: S,
        states: &[Abreast],
        z: &[f64],
        (first, part): (usize, usize),
    ) -> [Register<S>; U] {
        let [mut squared, mut product] = [[Register::splat(simd, 0.0); U]; 2];
        for (&z, state) in z.iter().zip(states) {
            let (z, state) = (Register::splat(simd, z), state.load::<S, U>(simd, first, part));
            for u in 0..U {
                let apart = z - state[u];
                squared[u] = apart.mul_add(apart, squared[u]);
                product[u] = state[u].mul_add(z, product[u]);
            }
        }
        let [constant, linear, quadratic] = self.trend;
        let [constant, linear] = [Register::splat(simd, constant), Register::splat(simd, linear)];
        let mut values = self.falling.values(squared);
        for u in 0..U {
            let slope = product[u].mul_add(Register::splat(simd, quadratic), linear);
            values[u] += product[u].mul_add(slope, constant);
        }
        values
    }
}

impl OverRows for Action<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const U: usize>(self, simd: S) {
        let Action { model, z, place } = self;
        for (few, action) in place.chunks_mut(FEW).enumerate() {
            let mut sums = [[0.0; LANES]; FEW];
            let sums = &mut sums[..action.len()];
            for part in 0..Register::<S>::parts() {
                for rows in model.table.together() {
                    let (states, weights) = rows.split_at(z.len());
                    for first in firsts::<U>() {
                        let covariances = model.covariances::<S, U>(simd, states, z, (first, part));
                        add(covariances, &weights[few * FEW..], (first, part), sums);
                    }
                }
            }
            for (action, sum) in action.iter_mut().zip(sums) {
                *action = total(*sum);
            }
        }
    }
}

/// Adds covariances times `weights` of each component to register `part` of its sums.
#[inline(always)]
fn add<S: Simd, const U: usize>(
    covariances: [Register<S>; U],
    weights: &[Abreast],
    (first, part): (usize, usize),
    sums: &mut [Lanes],
) {
    let simd = covariances[0].token();
    for (weights, place) in weights.iter().zip(sums) {
        let (weights, mut sum) = (weights.load::<S, U>(simd, first, part), Register::load(simd, place, part));
        for u in 0..U {
            sum = covariances[u].mul_add(weights[u], sum);
        }
        sum.store(place, part);
    }
}

impl OverRows for CovariancesWithRows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const U: usize>(self, simd: S) {
        let CovariancesWithRows { model, z, covariances } = self;
        let groups = covariances.as_chunks_mut().0;
        for part in 0..Register::<S>::parts() {
            for (rows, places) in model.table.together().zip(groups.chunks_exact_mut(GROUPS)) {
                for first in firsts::<U>() {
                    let covariances = model.covariances::<S, U>(simd, &rows[..z.len()], z, (first, part));
                    for (covariance, place) in covariances.into_iter().zip(&mut places[first..]) {
                        covariance.store(place, part);
                    }
                }
            }
        }
    }
}
