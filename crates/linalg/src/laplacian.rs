use approx_chol::input::Laplacian;
use approx_chol::{Config, Factor, ScalingPolicy, factorize_with};

/// An approximate Cholesky factor of the Laplacian L of a weighted graph (Kyng, Sachdeva): time and memory grow nearly in
/// proportion to its links.
#[derive(Debug)]
pub struct LaplacianFactor {
    factor: Factor<f64>,
}

impl LaplacianFactor {
    /// Of a graph with `nodes` nodes; link i joins `ones[i]` with `others[i]` by the positive weight `weights[i]`. None if
    /// weights cannot be factorised.
    pub fn new(nodes: usize, ones: &[u32], others: &[u32], weights: &[f64]) -> Option<Self> {
        let laplacian = Laplacian::weighted(nodes, ones, others, weights).ok()?;
        let factor = factorize_with(laplacian, Config::default(), ScalingPolicy::default()).ok()?;
        Some(LaplacianFactor { factor })
    }

    /// About L⁺r, (nodes), in place; 0 where there is no link. Allocates nothing once `scratch` has grown.
    pub fn solve(&self, right: &mut [f64], scratch: &mut Vec<f64>) {
        scratch.resize(self.factor.scratch_len(), 0.0);
        self.factor.solve_in_place(right, scratch).expect("vectors have one length");
    }
}
