use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};

use crate::kernel::panel::Panel;
use crate::kernel::slope_covariance::SlopeCovariance;
use crate::kernel::whitening::Whitening;
use crate::screening_subset::ScreeningSubset;
use crate::slope::expansion::Expansion;
use crate::slope::policy::{SlopePolicy, SlopePotential};
use crate::support::{Variances, supported};

/// The slope GP conditioned on rows: mean (S7) and uncertainty (S13), (S14).
#[derive(Debug, Clone)]
pub struct SlopeModel {
    pub(crate) policy: SlopePolicy,
    potential: Option<SlopePotential>,
    /// σ² without the floor.
    pub(crate) noise: f64,
    pub(crate) whitening: Whitening,
    screening: ScreeningSubset<Expansion>,
}

impl SlopeModel {
    pub(crate) fn new(expansion: Expansion, noise: f64, whitening: Whitening) -> Self {
        let has_potential = expansion.blocks.iter().all(|block| block.has_potential());
        let expansion = Arc::new(expansion);
        let potential = has_potential.then(|| SlopePotential { expansion: Arc::clone(&expansion) });
        SlopeModel {
            policy: SlopePolicy { expansion },
            potential,
            noise,
            whitening,
            screening: ScreeningSubset::default(),
        }
    }

    /// π̂.
    pub fn policy(&self) -> &SlopePolicy {
        &self.policy
    }

    /// φ̂; `None` if the model allows rotation.
    pub fn potential(&self) -> Option<&SlopePotential> {
        self.potential.as_ref()
    }

    /// α = K⁻¹y, (M).
    pub fn weights(&self) -> &[f64] {
        &self.expansion().weights
    }

    /// Number of inducing rows; `None` if the model contains every row.
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
        let expansion = self.expansion();
        let z = expansion.scaling.of_state(state);
        let (along, beside) = expansion.prior(z.as_slice());
        let x = z.rows(0, expansion.moving());
        let isotropic = DMatrix::from_diagonal_element(x.len(), x.len(), along);
        (x * x.transpose() * beside + isotropic) * expansion.speed.powi(2)
    }

    /// (S13) at several states, with one solution of triangular systems for all. A single state gets the same bits as among others.
    pub(crate) fn covariances(&self, states: &[DVectorView<'_, f64>]) -> Vec<DMatrix<f64>> {
        let (dim, speed) = (self.expansion().moving(), self.expansion().speed);
        let whitened = self.whitened(states);
        let (norms, whitened) = (whitened.squared_norms(), whitened.into_matrix());
        let posterior = |(at, state): (usize, &DVectorView<'_, f64>)| {
            let known = whitened.columns(at * dim, dim);
            let mut explained = known.tr_mul(&known);
            // Uses the same bits as `variances`.
            explained.set_diagonal(&DVectorView::from_slice(&norms[at * dim..], dim));
            self.prior_covariance(*state) - explained * speed.powi(2)
        };
        states.iter().enumerate().map(posterior).collect()
    }

    /// C_x of (S13) at several states, whitened, as the part that the rows explain: n columns per state.
    fn whitened(&self, states: &[DVectorView<'_, f64>]) -> Panel {
        let mut panel = self.expansion().policy_with_rows_at(states);
        self.whiten(&mut panel);
        panel
    }

    /// Posterior and prior variances of each component at states with their contexts (n + p, N), both (n, N), in squared units of the
    /// state per second, computed in parallel: the diagonal of (S13). A single state gets the same bits as among others. Costs n M²
    /// per state.
    pub(crate) fn variances(&self, states: DMatrixView<'_, f64>) -> Variances {
        let (dim, speed) = (self.expansion().moving(), self.expansion().speed);
        Variances::of(states, dim, |states, prior, posterior| {
            let known = self.whitened(&states.column_iter().collect::<Vec<_>>()).squared_norms();
            for (state, prior) in states.column_iter().zip(prior.chunks_exact_mut(dim)) {
                self.prior_variances(state, prior);
            }
            for ((posterior, prior), known) in posterior.iter_mut().zip(prior).zip(known) {
                *posterior = *prior - known * speed.powi(2);
            }
        })
    }

    /// Prior variance of each component at a state with its context, (n), in squared units of the state per second.
    fn prior_variances(&self, state: DVectorView<'_, f64>, variances: &mut [f64]) {
        let speed = self.expansion().speed;
        self.expansion().scaling.with_coordinates(state.as_slice(), |z| {
            let (along, beside) = self.expansion().prior(z);
            for (variance, z) in variances.iter_mut().zip(z) {
                *variance = (z * z * beside + along) * speed.powi(2);
            }
        });
    }

    /// Whether the support of states with their contexts (n + p, N) is at least `least`, according to their
    /// [`variances`](Self::variances).
    pub(crate) fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        let (dim, speed) = (self.expansion().moving(), self.expansion().speed);
        let Expansion { blocks, z, n, amplitudes, scaling, weights, .. } = self.expansion();
        let part = |rows: &[usize]| {
            let (prior, of_rows) =
                ((blocks.clone(), amplitudes.clone()), (z.select_columns(rows), n.select_columns(rows)));
            Expansion::new((scaling.clone(), speed), prior, of_rows, vec![0.0; rows.len()])
        };
        let prior_of = (&SlopeCovariance { blocks, z, n }, &amplitudes[..], self.noise);
        let some = |states: DMatrixView<'_, f64>| {
            let Some((part, factor)) = self.screening.part(weights.len(), &self.whitening, prior_of, part) else {
                return vec![false; states.ncols()];
            };
            let mut each = vec![0.0; dim];
            let prior = |state| {
                self.prior_variances(state, &mut each);
                each.iter().sum::<f64>()
            };
            let prior: Vec<f64> = states.column_iter().map(prior).collect();
            let covariances = part.policy_with_rows_at(&states.column_iter().collect::<Vec<_>>());
            self.screening.explains(factor, covariances, &prior, (speed.powi(2), least))
        };
        supported(states, dim, least, some, |states| self.variances(states))
    }

    /// φ̂(x) − φ̂(x₀) and its variance (S14), in units of the state squared per second, and their square; `None` without a potential.
    pub fn potential_difference(&self, x: DVectorView<'_, f64>, from: DVectorView<'_, f64>) -> Option<(f64, f64)> {
        let (expansion, _) = (self.expansion(), self.potential.as_ref()?);
        let value = expansion.potential(x.as_slice()) - expansion.potential(from.as_slice());
        let (z, z0) = (expansion.scaling.of_state(x), expansion.scaling.of_state(from));
        let mut known = Panel::of(&(expansion.potential_with_rows(&z) - expansion.potential_with_rows(&z0)));
        self.whiten(&mut known);
        let prior = |a: &DVector<f64>, b: &DVector<f64>| {
            let each = expansion.blocks.iter().zip(&expansion.amplitudes);
            each.map(|(block, amplitude)| {
                amplitude * block.potential_potential(a.as_view(), b.as_view()).unwrap_or(0.0)
            })
            .sum::<f64>()
        };
        let scaled = prior(&z, &z) + prior(&z0, &z0) - 2.0 * prior(&z, &z0) - known.squared_norms()[0];
        Some((value, (expansion.speed * expansion.scaling.scale).powi(2) * scaled))
    }

    /// π̂ at states with their contexts (n + p, M), (n, M).
    pub(crate) fn actions(&self, states: &DMatrix<f64>) -> DMatrix<f64> {
        self.expansion().actions(states.as_view())
    }

    fn whiten(&self, b: &mut Panel) {
        let Expansion { blocks, z, n, amplitudes, .. } = self.expansion();
        self.whitening.apply(b, &SlopeCovariance { blocks, z, n }, amplitudes, self.noise);
    }

    pub(crate) fn expansion(&self) -> &Expansion {
        &self.policy.expansion
    }
}
