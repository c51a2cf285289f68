use approx_chol::input::Laplacian;
use approx_chol::{Config, Factor, ScalingPolicy, factorize_with};

/// An approximate Cholesky factor of the Laplacian L of a weighted graph (Kyng, Sachdeva). Time and memory are nearly
/// proportional to the number of links.
#[derive(Debug)]
pub struct LaplacianFactor {
    factor: Factor<f64>,
}

impl LaplacianFactor {
    /// Factorizes a graph with `nodes` nodes; link i joins `ones[i]` with `others[i]` and has the positive weight
    /// `weights[i]`. `None` if the weights cannot be factorized.
    pub fn new(nodes: usize, ones: &[u32], others: &[u32], weights: &[f64]) -> Option<Self> {
        let laplacian = Laplacian::weighted(nodes, ones, others, weights).ok()?;
        let factor = factorize_with(laplacian, Config::default(), ScalingPolicy::default()).ok()?;
        Some(LaplacianFactor { factor })
    }

    /// Approximates L⁺r, (nodes), in place; 0 at nodes without links. Does not allocate once `scratch` has grown.
    pub fn solve(&self, right: &mut [f64], scratch: &mut Vec<f64>) {
        scratch.resize(self.factor.scratch_len(), 0.0);
        self.factor.solve_in_place(right, scratch).expect("vectors have one length");
    }
}
