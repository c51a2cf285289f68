//! Marginal likelihood (evidence), and the amplitudes that maximise it.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

pub(crate) mod family_fit;
pub(crate) mod lbfgs;

use std::ops::Range;

use lanes::{LANES, Number, Register};
use linalg::{Factor, subtract_outer};
use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};

use crate::kernel::covariance::{Covariance, add_noise};
use crate::left_out::level::Targets;

/// Centre −4 of the prior on each log parameter, and its strength: the last term of (S8).
const CENTRE: f64 = -4.0;
const STRENGTH: f64 = 0.01;

/// The negative log marginal likelihood J of (S8) and (R2), and its gradient (S9).
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// J, without the constant M/2 · log 2π.
    pub value: f64,
    /// ∂J/∂θ, (B + 1), θ = (log a_1 .. log a_B, log σ²).
    pub gradient: DVector<f64>,
}

impl Evidence {
    /// On all rows at θ; `None` if the covariance has no Cholesky factor.
    pub(crate) fn of(covariance: &impl Covariance, theta: &[f64], targets: &Targets) -> Option<Self> {
        let all: Vec<usize> = (0..targets.values.nrows()).collect();
        let task = Task::of(covariance, &all, targets);
        task.evidence(&DVector::from_column_slice(theta), &mut Workspace::default())
    }
}

/// The rows whose marginal likelihood is maximised, with their targets (h, c): c columns that share one covariance.
#[derive(Debug)]
pub(crate) struct Task {
    pub(crate) blocks: Vec<DMatrix<f64>>,
    pub(crate) noise_weights: Vec<f64>,
    pub(crate) targets: DMatrix<f64>,
}

/// Memory for [`Task::evidence`], reused for every θ: square matrices with as many rows as the task.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    /// The covariance, then its factor.
    covariance: DMatrix<f64>,
    /// L⁻¹.
    triangle: DMatrix<f64>,
    /// c K⁻¹ − AAᵀ.
    slack: DMatrix<f64>,
}

impl Workspace {
    fn fit(&mut self, count: usize) {
        for matrix in [&mut self.covariance, &mut self.triangle, &mut self.slack] {
            if matrix.nrows() != count {
                *matrix = DMatrix::zeros(count, count);
            }
        }
    }
}

impl Task {
    /// These rows of a covariance and of the targets.
    pub(crate) fn of(covariance: &impl Covariance, rows: &[usize], targets: &Targets) -> Task {
        Task {
            blocks: covariance.each_among(rows),
            noise_weights: rows.iter().map(|&row| targets.noise_weights[row]).collect(),
            targets: targets.values.select_rows(rows),
        }
    }

    /// (S8), (S9), (R2) at θ = (log a_1 .. log a_B, log σ²); `None` if the covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub(crate) fn evidence(&self, theta: &DVector<f64>, workspace: &mut Workspace) -> Option<Evidence> {
        assert_eq!(theta.len(), self.blocks.len() + 1, "one log amplitude a block, and the noise");
        let columns = self.targets.ncols() as f64;
        let noise = theta[self.blocks.len()].exp();
        workspace.fit(self.targets.nrows());
        let Workspace { covariance, triangle, slack } = workspace;
        self.covariance_into(theta, noise, covariance);
        let factor = Factor::new(std::mem::take(covariance))?;
        let mut weights = self.targets.clone();
        factor.solve(&mut weights);
        let half_log_determinant = factor.half_log_determinant();
        let fit = 0.5 * self.targets.dot(&weights);
        let prior = 0.5 * STRENGTH * theta.iter().map(|theta| (theta - CENTRE).powi(2)).sum::<f64>();
        let value = fit + columns * half_log_determinant + prior;
        // c K⁻¹ − AAᵀ: every derivative is half its inner product with the derivative of K.
        factor.inverse_into(slack, triangle);
        *covariance = factor.into_matrix();
        if columns > 1.0 {
            *slack *= columns;
        }
        subtract_outer(slack, &weights);
        let slacks = Arch::new().dispatch(InnerProducts { matrix: slack, blocks: &self.blocks });
        let noise_slack: f64 = self.noise_weights.iter().enumerate().map(|(i, weight)| weight * slack[(i, i)]).sum();
        let gradient = DVector::from_fn(theta.len(), |k, _| {
            let product = slacks.get(k).copied().unwrap_or(noise_slack);
            0.5 * theta[k].exp() * product + STRENGTH * (theta[k] - CENTRE)
        });
        value.is_finite().then_some(Evidence { value, gradient })
    }

    fn covariance_into(&self, theta: &DVector<f64>, noise: f64, sum: &mut DMatrix<f64>) {
        let amplitudes: Vec<f64> = theta.iter().take(self.blocks.len()).map(|theta| theta.exp()).collect();
        Arch::new().dispatch(WeightedSum { blocks: &self.blocks, amplitudes: &amplitudes, sum });
        add_noise(sum, noise, self.noise_weights.iter().copied());
    }
}

/// Number of blocks whose columns are read side by side.
const ABREAST: usize = 4;

/// Writes Σ a_b K_b into the lower triangle of `sum`, column by column, so that the column stays in the cache for all
/// blocks.
struct WeightedSum<'a> {
    blocks: &'a [DMatrix<f64>],
    amplitudes: &'a [f64],
    sum: &'a mut DMatrix<f64>,
}

impl WithSimd for WeightedSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let WeightedSum { blocks, amplitudes, sum } = self;
        let (fours, rest) = blocks.as_chunks::<ABREAST>();
        let (amplitudes, of_rest) = amplitudes.as_chunks::<ABREAST>();
        for i in 0..sum.ncols() {
            let below = below(sum, i);
            let column = &mut sum.as_mut_slice()[below.clone()];
            column.fill(0.0);
            for (blocks, amplitudes) in fours.iter().zip(amplitudes) {
                add(simd, column, blocks.each_ref().map(|block| &block.as_slice()[below.clone()]), *amplitudes);
            }
            for (block, amplitude) in rest.iter().zip(of_rest) {
                add(simd, column, [&block.as_slice()[below.clone()]], [*amplitude]);
            }
        }
    }
}

/// tr(AK_b) for every block, from the lower triangles of symmetric matrices.
struct InnerProducts<'a> {
    matrix: &'a DMatrix<f64>,
    blocks: &'a [DMatrix<f64>],
}

impl WithSimd for InnerProducts<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
        let InnerProducts { matrix, blocks } = self;
        let mut products = vec![0.0; blocks.len()];
        let (fours, rest) = blocks.as_chunks::<ABREAST>();
        let (of_fours, of_rest) = products.as_chunks_mut::<ABREAST>();
        for i in 0..matrix.ncols() {
            let below = below(matrix, i);
            let a = &matrix.as_slice()[below.clone()];
            for (products, blocks) in of_fours.iter_mut().zip(fours) {
                add_products(simd, products, a, blocks.each_ref().map(|block| &block.as_slice()[below.clone()]));
            }
            for (product, block) in of_rest.iter_mut().zip(rest) {
                add_products(simd, std::array::from_mut(product), a, [&block.as_slice()[below.clone()]]);
            }
        }
        products
    }
}

/// Range of the part of a column from the diagonal down.
#[inline(always)]
fn below(matrix: &DMatrix<f64>, column: usize) -> Range<usize> {
    let rows = matrix.nrows();
    column * rows + column..(column + 1) * rows
}

/// Adds a_b k_b to a column, block after block.
#[inline(always)]
fn add<S: Simd, const N: usize>(simd: S, column: &mut [f64], blocks: [&[f64]; N], amplitudes: [f64; N]) {
    let (groups, rest) = column.as_chunks_mut::<LANES>();
    let blocks = blocks.map(|block| block.as_chunks::<LANES>());
    let registers = amplitudes.map(|amplitude| Register::splat(simd, amplitude));
    for (at, group) in groups.iter_mut().enumerate() {
        for part in 0..Register::<S>::parts() {
            let mut sum = Register::load(simd, group, part);
            for ((block, _), amplitude) in blocks.iter().zip(registers) {
                sum += amplitude * Register::load(simd, &block[at], part);
            }
            sum.store(group, part);
        }
    }
    for ((_, block), amplitude) in blocks.iter().zip(amplitudes) {
        rest.iter_mut().zip(*block).for_each(|(sum, term)| *sum += amplitude * term);
    }
}

/// Adds, for every block, twice the inner product of a column with the block's column, counting the diagonal once.
#[inline(always)]
fn add_products<S: Simd, const N: usize>(simd: S, products: &mut [f64; N], a: &[f64], blocks: [&[f64]; N]) {
    let (a_groups, a_rest) = a.as_chunks::<LANES>();
    let mut sums = [[0.0; LANES]; N];
    for part in 0..Register::<S>::parts() {
        let mut totals = [Register::splat(simd, 0.0); N];
        for (at, group) in a_groups.iter().enumerate() {
            let group = Register::load(simd, group, part);
            for (total, block) in totals.iter_mut().zip(blocks) {
                *total += group * Register::load(simd, &block.as_chunks::<LANES>().0[at], part);
            }
        }
        totals.into_iter().zip(&mut sums).for_each(|(total, sums)| total.store(sums, part));
    }
    for ((product, b), sums) in products.iter_mut().zip(blocks).zip(sums) {
        let rest: f64 = a_rest.iter().zip(b.as_chunks::<LANES>().1).map(|(a, b)| a * b).sum();
        *product += 2.0 * (lanes::total(sums) + rest) - a[0] * b[0];
    }
}
