//! What prediction needs of one receptive field.

use serde::{Deserialize, Serialize};

use crate::element::Element;
use crate::field::{DIRECTION_ROWS, Field, Layout};
use crate::full_metric::add_scaled;
use crate::settings::Settings;

/// A receptive field, frozen. Vectors are not padded; everything is in normalised units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LocalModel {
    pub(crate) centre: Vec<f64>,
    /// D: its diagonal, or its columns.
    pub(crate) metric: Vec<f64>,
    /// The affine model y = offset + slopeᵀ(x − c); `None` while the field is not trustworthy.
    pub(crate) affine: Option<Affine>,
}

/// A local prediction and what its confidence needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Affine {
    pub(crate) offset: f64,
    pub(crate) slope: Vec<f64>,
    /// Noise variance Γ; `None` before errors were collected.
    pub(crate) noise: Option<f64>,
    /// One row aⱼ a direction: the loading of x, over the spread of the loadings seen, is aⱼᵀ(x − mean).
    pub(crate) mean: Vec<f64>,
    pub(crate) loadings: Vec<f64>,
}

impl LocalModel {
    /// `None` where learning has run into numbers that are not finite, so that the field is of no use.
    pub(crate) fn new(field: &Field, settings: &Settings) -> Option<Self> {
        let n = settings.n_in;
        let centre = field.centre(settings).to_vec();
        let d = crate::receptive_field::metric_of(field.m(settings), settings.params.metric, n);
        let metric = match settings.params.metric {
            crate::Metric::Diagonal => d.diagonal().as_slice().to_vec(),
            crate::Metric::Full => d.as_slice().to_vec(),
        };
        let affine = field.is_trustworthy().then(|| Affine::new(field, settings));
        let model = LocalModel { centre, metric, affine };
        model.is_finite().then_some(model)
    }

    /// Whether all vectors fit `n` inputs.
    pub(crate) fn has_shape(&self, n: usize) -> bool {
        let affine_has = |affine: &Affine| {
            affine.slope.len() == n && affine.mean.len() == n && affine.loadings.len().is_multiple_of(n)
        };
        self.centre.len() == n
            && (self.metric.len() == n || self.metric.len() == n * n)
            && self.affine.as_ref().is_none_or(affine_has)
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let affine_is = |affine: &Affine| {
            affine.offset.is_finite()
                && finite(&affine.slope)
                && finite(&affine.mean)
                && finite(&affine.loadings)
                && affine.noise.is_none_or(f64::is_finite)
        };
        finite(&self.centre) && finite(&self.metric) && self.affine.as_ref().is_none_or(affine_is)
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
        // Slope Σⱼ βⱼ ∂sⱼ/∂x by the adjoint of the deflations x ← x − P s, O(n) a direction.
        let mut slope = vec![0.0; w];
        for j in (0..usable).rev() {
            let factor = field.directions[j].beta - f64::dot((), p(j), &slope);
            add_scaled::<f64, f64>((), &mut slope, factor, u(j));
        }
        // ∂sⱼ/∂x likewise, each alone.
        let mut loadings = Vec::with_capacity(usable * n);
        for j in 0..usable {
            let mut loading = u(j).to_vec();
            for i in (0..j).rev() {
                let factor = -f64::dot((), p(i), &loading);
                add_scaled::<f64, f64>((), &mut loading, factor, u(i));
            }
            let scale = 1.0 / field.directions[j].ss2.sqrt();
            loadings.extend(loading[..n].iter().map(|a| a * scale));
        }
        let mean = field.rows[w..][..n].to_vec();
        let offset = field.beta0 + (0..n).map(|i| slope[i] * (field.rows[i] - mean[i])).sum::<f64>();
        slope.truncate(n);
        Affine { offset, slope, noise: noise(field, usable), mean, loadings }
    }
}

/// Γ = Σ w e² / (Σ w − p): the noise variance, once leave-one-out errors have been collected.
fn noise(field: &Field, usable: usize) -> Option<f64> {
    let last = &field.directions[usable.checked_sub(1)?];
    let weight = last.sum_w - field.ss_p;
    (last.sum_e_cv2 > 0.0 && weight > 0.0).then(|| last.sum_e_cv2 / weight)
}
