use std::sync::Arc;

use nalgebra::{DMatrix, DVector, DVectorView};

use crate::kernel::block::Block;
use crate::kernel::slope_covariance::SlopeCovariance;
use crate::kernel::whitening::Whitening;
use crate::slope::expansion::Expansion;
use crate::slope::policy::{SlopePolicy, SlopePotential};

/// The slope GP conditioned on rows: mean (S7) and uncertainty (S13), (S14).
#[derive(Debug, Clone)]
pub struct SlopeModel {
    pub(crate) policy: SlopePolicy,
    potential: Option<SlopePotential>,
    /// σ² without the floor.
    pub(crate) noise: f64,
    pub(crate) whitening: Whitening,
}

impl SlopeModel {
    pub(crate) fn new(expansion: Expansion, noise: f64, whitening: Whitening) -> Self {
        let has_potential = expansion.blocks.iter().all(|block| block.has_potential());
        let expansion = Arc::new(expansion);
        let potential = has_potential.then(|| SlopePotential { expansion: Arc::clone(&expansion) });
        SlopeModel { policy: SlopePolicy { expansion }, potential, noise, whitening }
    }

    /// π̂.
    pub fn policy(&self) -> &SlopePolicy {
        &self.policy
    }

    /// φ̂; none if the model allows for rotation.
    pub fn potential(&self) -> Option<&SlopePotential> {
        self.potential.as_ref()
    }

    /// α = K⁻¹y, (M).
    pub fn weights(&self) -> &[f64] {
        &self.expansion().weights
    }

    /// Number of inducing rows; none where every row is in the model.
    pub(crate) fn inducing(&self) -> Option<usize> {
        matches!(self.whitening, Whitening::Inducing { .. }).then_some(self.weights().len())
    }

    /// The part of π̂ that has no potential.
    pub fn rotational_part(&self) -> SlopePolicy {
        SlopePolicy { expansion: Arc::new(self.expansion().part(|block| !block.has_potential())) }
    }

    /// (S13): cov π(x), (n, n), in squared units of the state per second. Costs n M².
    pub fn covariance(&self, state: DVectorView<'_, f64>) -> DMatrix<f64> {
        self.covariances(&[state]).remove(0)
    }

    /// Prior covariance of π(x), (n, n), in the same units.
    pub fn prior_covariance(&self, state: DVectorView<'_, f64>) -> DMatrix<f64> {
        let (expansion, z) = (self.expansion(), self.expansion().scaling.of_state(state));
        let moving = expansion.moving();
        let basis = DMatrix::<f64>::identity(moving, moving);
        let z = z.as_view();
        let slopes = |block: Block, i: usize, j: usize| block.slope_slope(z, basis.column(i), z, basis.column(j));
        // Blocks that fall with distance are alike in all directions at one place.
        let alike: Vec<Option<f64>> =
            expansion.blocks.iter().map(|&block| block.falls().then(|| slopes(block, 0, 0))).collect();
        let entry = |i: usize, j: usize| {
            let each = expansion.blocks.iter().zip(&expansion.amplitudes).zip(&alike);
            let own = |block, alike: &Option<f64>| match alike {
                Some(variance) if i == j => *variance,
                Some(_) => 0.0,
                None => slopes(block, i, j),
            };
            each.map(|((&block, a), alike)| a * own(block, alike)).sum::<f64>()
        };
        DMatrix::from_fn(moving, moving, entry) * expansion.speed.powi(2)
    }

    /// (S13) at several states: one solution of triangular systems for all.
    pub(crate) fn covariances(&self, states: &[DVectorView<'_, f64>]) -> Vec<DMatrix<f64>> {
        let (expansion, dim) = (self.expansion(), self.expansion().moving());
        let mut whitened = DMatrix::zeros(expansion.z.ncols(), dim * states.len());
        for (at, state) in states.iter().enumerate() {
            whitened.columns_mut(at * dim, dim).copy_from(&expansion.policy_with_rows(*state));
        }
        self.whiten(&mut whitened);
        let posterior = |(at, state): (usize, &DVectorView<'_, f64>)| {
            let known = whitened.columns(at * dim, dim);
            self.prior_covariance(*state) - known.tr_mul(&known) * expansion.speed.powi(2)
        };
        states.iter().enumerate().map(posterior).collect()
    }

    /// φ̂(x) − φ̂(x₀) and its variance (S14), in units of the state squared per second, and their square; none if there
    /// is no potential.
    pub fn potential_difference(&self, x: DVectorView<'_, f64>, from: DVectorView<'_, f64>) -> Option<(f64, f64)> {
        let (expansion, _) = (self.expansion(), self.potential.as_ref()?);
        let value = expansion.potential(x.as_slice()) - expansion.potential(from.as_slice());
        let (z, z0) = (expansion.scaling.of_state(x), expansion.scaling.of_state(from));
        let mut known = expansion.potential_with_rows(&z) - expansion.potential_with_rows(&z0);
        self.whiten(&mut known);
        let prior = |a: &DVector<f64>, b: &DVector<f64>| {
            let each = expansion.blocks.iter().zip(&expansion.amplitudes);
            each.map(|(block, amplitude)| {
                amplitude * block.potential_potential(a.as_view(), b.as_view()).unwrap_or(0.0)
            })
            .sum::<f64>()
        };
        let scaled = prior(&z, &z) + prior(&z0, &z0) - 2.0 * prior(&z, &z0) - known.norm_squared();
        Some((value, (expansion.speed * expansion.scaling.scale).powi(2) * scaled))
    }

    /// π̂ at each of the states with their contexts (n + p, M), (n, M).
    pub(crate) fn actions(&self, states: &DMatrix<f64>) -> DMatrix<f64> {
        self.expansion().actions(states)
    }

    fn whiten(&self, b: &mut DMatrix<f64>) {
        let Expansion { blocks, z, n, amplitudes, .. } = self.expansion();
        self.whitening.apply(b, &SlopeCovariance { blocks, z, n }, amplitudes, self.noise);
    }

    pub(crate) fn expansion(&self) -> &Expansion {
        &self.policy.expansion
    }
}
