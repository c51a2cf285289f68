//! Marginal likelihood (evidence), and the amplitudes that maximise it.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

pub(crate) mod family_fit;
pub(crate) mod lbfgs;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};

use crate::kernel::covariance::{Covariance, add_noise};
use crate::kernel::factor::{Factor, add_product_below, view};
use crate::left_out::level::Conditions;

/// Pull of every log parameter towards −4, and its strength: the last term of (S8).
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

/// The rows whose marginal likelihood is maximised, with their targets (h, c): c columns with one covariance for all.
#[derive(Debug)]
pub(crate) struct Task {
    pub(crate) blocks: Vec<DMatrix<f64>>,
    pub(crate) noise_weights: Vec<f64>,
    pub(crate) targets: DMatrix<f64>,
}

/// What [`Task::evidence`] works on, kept from one θ to the next: square matrices of as many rows as the task has.
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
    /// These rows of a covariance and of what it is to explain.
    pub(crate) fn of(covariance: &impl Covariance, rows: &[usize], conditions: &Conditions<'_>) -> Task {
        Task {
            blocks: covariance.each_among(rows),
            noise_weights: rows.iter().map(|&row| conditions.noise_weights[row]).collect(),
            targets: conditions.targets.select_rows(rows),
        }
    }

    /// (S8), (S9), (R2) at θ = (log a_1 .. log a_B, log σ²); none if the covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If there is not one θ a block and one more.
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
        // c K⁻¹ − AAᵀ: every derivative is half its inner product with that of K.
        factor.inverse_into(slack, triangle);
        *covariance = factor.into_matrix();
        *slack *= columns;
        add_product_below(slack, -1.0, view(&weights), view(&weights).transpose());
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

/// Writes Σ a_b K_b into the lower triangle of `sum`: column by column, so that a column stays near while blocks pass by.
struct WeightedSum<'a> {
    blocks: &'a [DMatrix<f64>],
    amplitudes: &'a [f64],
    sum: &'a mut DMatrix<f64>,
}

impl WithSimd for WeightedSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let WeightedSum { blocks, amplitudes, sum } = self;
        for i in 0..sum.ncols() {
            let below = below(sum, i);
            let column = &mut sum.as_mut_slice()[below.clone()];
            column.fill(0.0);
            for (block, amplitude) in blocks.iter().zip(amplitudes) {
                let terms = &block.as_slice()[below.clone()];
                column.iter_mut().zip(terms).for_each(|(sum, term)| *sum += amplitude * term);
            }
        }
    }
}

/// tr(AK_b) for every block, of symmetric matrices of which the lower triangles are given.
struct InnerProducts<'a> {
    matrix: &'a DMatrix<f64>,
    blocks: &'a [DMatrix<f64>],
}

impl WithSimd for InnerProducts<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Vec<f64> {
        let InnerProducts { matrix, blocks } = self;
        let mut products = vec![0.0; blocks.len()];
        for i in 0..matrix.ncols() {
            let below = below(matrix, i);
            let a = &matrix.as_slice()[below.clone()];
            for (product, block) in products.iter_mut().zip(blocks) {
                let b = &block.as_slice()[below.clone()];
                *product += 2.0 * dot(a, b) - a[0] * b[0];
            }
        }
        products
    }
}

/// Where the part of a column from the diagonal down stands.
#[inline(always)]
fn below(matrix: &DMatrix<f64>, column: usize) -> Range<usize> {
    let rows = matrix.nrows();
    column * rows + column..(column + 1) * rows
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums: lanes::Lanes = [0.0; lanes::LANES];
    let (a_groups, a_rest) = a.as_chunks::<{ lanes::LANES }>();
    let (b_groups, b_rest) = b.as_chunks::<{ lanes::LANES }>();
    for (a, b) in a_groups.iter().zip(b_groups) {
        for lane in 0..lanes::LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    lanes::total(sums) + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}
