//! A subset of a model's rows that suffices to show that many states have enough support.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use linalg::Factor;
use nalgebra::DMatrix;

use crate::inducing::pivots::pivots;
use crate::kernel::covariance::{Covariance, NOISE_FLOOR, among, jittered};
use crate::kernel::panel::Panel;
use crate::kernel::triangle::InverseOfLower;
use crate::kernel::whitening::Whitening;

/// The subset contains one in this many rows, and at most [`MOST`].
const ONE_OF: usize = 4;
const MOST: usize = 96;
/// Share of a covariance's mean diagonal to add, so that rounding never makes the subset explain more than all rows do.
const CAUTION: f64 = 1e-8;
/// A triangle is not inverted if its diagonal falls below this share of its largest entry.
const SINGULAR: f64 = 1e-7;
/// Share of a prior variance by which the subset must explain more than required, as a margin for rounding.
const MARGIN: f64 = 1e-3;
/// After this many states, the subset stays in use if it decided at least one in [`ONE_OF`].
const TRIED: usize = 256;

/// A part P of a model: rows S and the factor of G_SS. All rows explain bᵀG⁻¹b of a variance, where b are its covariances with them. G is
/// the rows' covariance with noise (S6), or L(TᵀT)⁻¹Lᵀ of (S37) for inducing rows. b_SᵀG_SS⁻¹b_S ≤ bᵀG⁻¹b holds for every S, as for every
/// positive matrix.
#[derive(Debug)]
pub(crate) struct ScreeningSubset<P> {
    part: OnceLock<Option<(P, InverseOfLower)>>,
    /// Number of states that were tried, and of those with enough support from these rows.
    tried: AtomicUsize,
    told: AtomicUsize,
}

impl<P> Default for ScreeningSubset<P> {
    fn default() -> Self {
        Self { part: OnceLock::new(), tried: AtomicUsize::new(0), told: AtomicUsize::new(0) }
    }
}

/// A clone starts empty and recomputes its part.
impl<P> Clone for ScreeningSubset<P> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<P> ScreeningSubset<P> {
    /// The part that `part` makes of some of the model's `rows` rows; `None` if no rows can be separated, or if the part has decided too
    /// few states so far.
    pub(crate) fn part(
        &self,
        rows: usize,
        whitening: &Whitening,
        (covariance, amplitudes, noise): (&impl Covariance, &[f64], f64),
        part: impl FnOnce(&[usize]) -> P,
    ) -> Option<&(P, InverseOfLower)> {
        let (tried, told) = (self.tried.load(Ordering::Relaxed), self.told.load(Ordering::Relaxed));
        if tried >= TRIED && told < tried / ONE_OF {
            return None;
        }
        let new = || {
            let every: Vec<usize> = (0..rows).collect();
            let groups = [every.clone()];
            let chosen = pivots(covariance, amplitudes, &groups, MOST.min(rows / ONE_OF));
            let mut matrix = match whitening {
                Whitening::Rows { noise_weights, .. } => {
                    let mut matrix = among(covariance, &chosen, amplitudes);
                    for (at, &row) in chosen.iter().enumerate() {
                        matrix[(at, at)] += (noise + NOISE_FLOOR) * noise_weights[row];
                    }
                    matrix
                }
                Whitening::Inducing { shrinkage, .. } => {
                    let factor = Factor::new(jittered(among(covariance, &every, amplitudes)))?.into_matrix();
                    let triangle = shrinkage.transposed();
                    let least = SINGULAR * triangle.amax();
                    if triangle.diagonal().iter().any(|entry| entry.abs() <= least) {
                        return None;
                    }
                    let lower = |column: usize, at: usize| {
                        if column <= chosen[at] { factor[(chosen[at], column)] } else { 0.0 }
                    };
                    let root = triangle.solve_lower_triangular(&DMatrix::from_fn(rows, chosen.len(), lower))?;
                    root.tr_mul(&root)
                }
            };
            if chosen.is_empty() {
                return None;
            }
            let caution = CAUTION * matrix.diagonal().mean();
            (0..chosen.len()).for_each(|at| matrix[(at, at)] += caution);
            let factor = Factor::new(matrix)?;
            Some((part(&chosen), factor.into()))
        };
        self.part.get_or_init(new).as_ref()
    }

    /// Whether these rows explain the share `least` of the prior variance of each state. `b` are covariances (S, k c) of c components per
    /// state; `unit` multiplies their squares. An infinite variance is never counted as explained.
    pub(crate) fn explains(
        &self,
        factor: &InverseOfLower,
        mut b: Panel,
        prior: &[f64],
        (unit, least): (f64, f64),
    ) -> Vec<bool> {
        factor.apply(&mut b);
        let norms = b.squared_norms();
        let components = norms.len().checked_div(prior.len()).unwrap_or(0).max(1);
        let enough = |(norms, prior): (&[f64], &f64)| {
            prior.is_finite() && unit * norms.iter().sum::<f64>() >= (least + MARGIN) * prior
        };
        let told: Vec<bool> = norms.chunks_exact(components).zip(prior).map(enough).collect();
        self.tried.fetch_add(told.len(), Ordering::Relaxed);
        self.told.fetch_add(told.iter().filter(|told| **told).count(), Ordering::Relaxed);
        told
    }
}
