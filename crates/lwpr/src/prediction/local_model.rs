//! The part of a receptive field that prediction needs.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::field::element::{Element, add_scaled};
use crate::field::{DIRECTION_ROWS, Field, Layout};
use crate::settings::Settings;

/// Bound on normalised inputs and on all other numbers of a field.
const FARTHEST: f64 = 1e51;
const LARGEST: f64 = 1e150;

/// A frozen receptive field. Vectors are not padded; everything is in normalised units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct LocalModel {
    pub(super) centre: Vec<f64>,
    /// D: its diagonal, or its columns.
    pub(super) metric: Vec<f64>,
    /// The affine model y = offset + slopeᵀ(x − c); `None` while the field is not trustworthy.
    pub(super) affine: Option<Affine>,
}

/// A local prediction and the data for its confidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Affine {
    pub(super) offset: f64,
    pub(super) slope: Vec<f64>,
    /// Noise variance Γ; `None` until errors have been collected.
    pub(super) noise: Option<f64>,
    /// One row aⱼ per direction: aⱼᵀ(x − mean) is the loading of x divided by the spread of the observed loadings.
    pub(super) mean: Vec<f64>,
    pub(super) loadings: Vec<f64>,
}

/// The prediction of one receptive field at a divided input z: offset + slopeᵀ(z − c), with an activation that depends on
/// q = (z − c)ᵀD(z − c).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalPrediction<'a> {
    /// c, (n).
    pub centre: &'a [f64],
    /// D: its diagonal (n), or its columns (n²).
    pub metric: &'a [f64],
    /// Offset of the prediction.
    pub offset: f64,
    /// Slope of the prediction, (n).
    pub slope: &'a [f64],
}

impl LocalModel {
    /// `None` while the field is not trustworthy.
    pub(super) fn prediction(&self) -> Option<LocalPrediction<'_>> {
        let Affine { offset, slope, .. } = self.affine.as_ref()?;
        Some(LocalPrediction { centre: &self.centre, metric: &self.metric, offset: *offset, slope })
    }

    /// `None` if learning has produced numbers that are not finite or absurdly large, so that the field is useless.
    pub(super) fn new(field: &Field, settings: &Settings) -> Option<Self> {
        let n = settings.n_in;
        let centre = field.centre(settings).to_vec();
        let d = crate::field::receptive_field::metric_of(field.m(settings), settings.params.metric, n);
        let metric = match settings.params.metric {
            crate::Metric::Diagonal => d.diagonal().as_slice().to_vec(),
            crate::Metric::Full => d.as_slice().to_vec(),
        };
        let affine = field.is_trustworthy().then(|| Affine::new(field, settings));
        let model = LocalModel { centre, metric, affine };
        model.is_sound().then_some(model)
    }

    /// Whether all vectors have the right length for `n` inputs.
    pub(super) fn has_shape(&self, n: usize) -> bool {
        let affine_has = |affine: &Affine| {
            affine.slope.len() == n && affine.mean.len() == n && affine.loadings.len().is_multiple_of(n)
        };
        self.centre.len() == n
            && (self.metric.len() == n || self.metric.len() == n * n)
            && self.affine.as_ref().is_none_or(affine_has)
    }

    /// Whether every number is finite and not too large for finite predictions, and the metric is valid.
    pub(super) fn is_sound(&self) -> bool {
        let below = |values: &[f64], limit: f64| values.iter().all(|value| value.abs() <= limit);
        let affine_is = |affine: &Affine| {
            below(&[affine.offset], LARGEST)
                && below(&affine.slope, LARGEST)
                && below(&affine.mean, FARTHEST)
                && below(&affine.loadings, LARGEST)
                && affine.noise.is_none_or(|noise| (0.0..=LARGEST).contains(&noise))
        };
        below(&self.centre, FARTHEST)
            && below(&self.metric, LARGEST)
            && self.has_metric()
            && self.affine.as_ref().is_none_or(affine_is)
    }

    /// Whether D is symmetric and, up to rounding, positive semidefinite.
    fn has_metric(&self) -> bool {
        let n = self.centre.len();
        if self.metric.len() == n {
            return self.metric.iter().all(|&d| d >= 0.0);
        }
        let d = DMatrix::from_column_slice(n, n, &self.metric);
        let rounding = 1e-12 * d.amax() + f64::MIN_POSITIVE;
        let asymmetry = (&d - d.transpose()).amax();
        asymmetry <= rounding && (d + DMatrix::from_diagonal_element(n, n, rounding)).cholesky().is_some()
    }
}

impl Affine {
    fn new(field: &Field, settings: &Settings) -> Self {
        let (n, w) = (settings.n_in, settings.width);
        let usable = field.n_usable(n);
        let rows = &field.rows[Layout::new(settings, w).directions()..];
        let (u, p) = (
            |j: usize| &rows[(DIRECTION_ROWS * j + 2) * w..][..w],
            |j: usize| &rows[(DIRECTION_ROWS * j + 3) * w..][..w],
        );
        // Slope Σⱼ βⱼ ∂sⱼ/∂x by the adjoint of the deflations x ← x − P s, O(n) per direction.
        let mut slope = vec![0.0; w];
        for j in (0..usable).rev() {
            let factor = field.directions[j].beta - f64::dot((), p(j), &slope);
            add_scaled::<f64, f64>((), &mut slope, factor, u(j));
        }
        // ∂sⱼ/∂x likewise, one direction at a time.
        let mut loadings = Vec::with_capacity(usable * n);
        for j in 0..usable {
            let mut loading = u(j).to_vec();
            for i in (0..j).rev() {
                let factor = -f64::dot((), p(i), &loading);
                add_scaled::<f64, f64>((), &mut loading, factor, u(i));
            }
            let scale = 1.0 / field.directions[j].sum_ws2.sqrt();
            loadings.extend(loading[..n].iter().map(|a| a * scale));
        }
        let mean = field.rows[w..][..n].to_vec();
        let offset = field.beta0 + (0..n).map(|i| slope[i] * (field.rows[i] - mean[i])).sum::<f64>();
        slope.truncate(n);
        Affine { offset, slope, noise: noise(field, usable), mean, loadings }
    }
}

/// Γ = Σ w e² / (Σ w − p): the noise variance, once leave-one-out errors have been collected.
pub(super) fn noise(field: &Field, usable: usize) -> Option<f64> {
    let last = &field.directions[usable.checked_sub(1)?];
    let weight = last.sum_w - field.degrees_of_freedom;
    (last.sum_loo_error2 > 0.0 && weight > 0.0).then(|| last.sum_loo_error2 / weight)
}
