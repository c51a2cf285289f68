use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::laplacian::Elimination;
use super::linear_term::linear_term;
use super::responsibilities::{Block, Responsibilities};
use lanes::LANES;

/// H is summed in this many parts, each in the order of its samples, so that the bits do not depend on the number of
/// threads.
const PARTS: usize = 8;

/// The alignment objective (13), (14) of the offsets b, (K),
/// E(b) = ½ Σ_m Σ_k Σ_j q_km q_jm ((f_km + b_k) − (f_jm + b_j))² = E₀ + 2aᵀb + bᵀHb,
/// in the paper's scaling: its gradient is 2(a + Hb), its Hessian 2H.
#[derive(Debug, Clone, PartialEq)]
pub struct AlignmentObjective {
    /// H = diag_k(Σ_m q_km) − Σ_m q_m q_mᵀ (15), (K, K): the Laplacian of a graph whose weights measure how much two
    /// trajectories share responsibility for samples.
    pub laplacian: DMatrix<f64>,
    /// a_k = Σ_m q_km (f_km − Σ_j q_jm f_jm) (16), (K), in units of the potential; not finite if differences of
    /// potentials overflow.
    pub linear: DVector<f64>,
    /// E₀ = E(0), in units of the potential squared; infinite if it overflows.
    pub constant: f64,
}

impl AlignmentObjective {
    pub(crate) fn new(responsibilities: &Responsibilities) -> Self {
        let laplacian = laplacian(responsibilities);
        let unaligned = vec![Some(0.0); responsibilities.n_trajectories()];
        let (linear, constant) = linear_term(responsibilities, &unaligned);
        // An overflow on the way gives ∞ − ∞.
        let constant = if constant.is_nan() { f64::INFINITY } else { constant };
        AlignmentObjective { laplacian, linear: linear.into(), constant }
    }

    /// E(b), in units of the potential squared.
    pub fn value(&self, offsets: &DVector<f64>) -> f64 {
        self.constant + offsets.dot(&(2.0 * &self.linear + &self.laplacian * offsets))
    }

    /// ∇E(b) = 2(a + Hb), (K).
    pub fn gradient(&self, offsets: &DVector<f64>) -> DVector<f64> {
        2.0 * (&self.linear + &self.laplacian * offsets)
    }

    /// The minimiser b = −H⁺a (17), (K), whose sum over each connected component of the graph is 0.
    ///
    /// The rounding error is about 1e-16 / λ₂. `laplacian` must be a graph Laplacian: square, symmetric, with rows that
    /// sum to 0 and no positive entry off the diagonal.
    pub fn minimiser(&self) -> DVector<f64> {
        Elimination::new(&self.laplacian).solve((-&self.linear).as_slice()).into()
    }
}

/// H (15): the off-diagonal entries −Σ_m q_km q_jm, and the diagonal from these, because Σ_j q_jm = 1.
fn laplacian(responsibilities: &Responsibilities) -> DMatrix<f64> {
    let count = responsibilities.n_trajectories();
    let parts: Vec<_> =
        responsibilities.blocks.par_chunks(count.div_ceil(PARTS)).map(|part| mutual(part, count)).collect();
    let mut laplacian = DMatrix::zeros(count, count);
    for weights in parts {
        laplacian -= weights;
    }
    laplacian.fill_diagonal(0.0);
    laplacian.fill_upper_triangle_with_lower_triangle();
    for k in 0..count {
        laplacian[(k, k)] = -laplacian.column(k).sum();
    }
    laplacian
}

/// Σ_m q_m q_mᵀ (K, K) over the samples of some blocks; only the lower triangle is valid.
fn mutual(blocks: &[Block], count: usize) -> DMatrix<f64> {
    let mut weights = DMatrix::zeros(count, count);
    for block in blocks {
        let local = gram(block);
        for (at, &k) in block.models.iter().enumerate() {
            for (below, &j) in block.models.iter().enumerate().skip(at + 1) {
                weights[(j, k)] += local[(below, at)];
            }
        }
    }
    weights
}

/// QᵀQ over the samples of one block, for its models only; only the lower triangle is valid.
fn gram(block: &Block) -> DMatrix<f64> {
    linalg::gram(block.shares.as_flattened(), LANES * block.groups)
}
