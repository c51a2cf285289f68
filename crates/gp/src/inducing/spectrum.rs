//! All rows represented by the inducing rows: singular values of their features (S35), which give the model at any noise level.

use linalg::{Factor, Svd, qr_triangle, singular_values};
use nalgebra::DMatrix;

use crate::inducing::features::Features;
use crate::inducing::tree::triangle;
use crate::kernel::covariance::Covariance;

/// Range of log σ² that is searched, in equal steps.
const NOISE: (f64, f64) = (-28.0, 2.0);
const STEPS: usize = 600;

/// Φ = D^{-1/2} K_nm L⁻ᵀ = U diag(s) Vᵀ of all rows, with K_mm = LLᵀ of the inducing rows.
#[derive(Debug)]
pub(crate) struct Spectrum {
    /// s, (m).
    pub(crate) singular: Vec<f64>,
    /// V, (m, m).
    v: DMatrix<f64>,
    /// W = L⁻ᵀV, (m, m): ΦV = D^{-1/2} K_nm W.
    pub(crate) w: DMatrix<f64>,
    /// UᵀD^{-1/2}Y, (m, c).
    targets: DMatrix<f64>,
    /// The part of Σ|y|²/D that no feature explains, and the number of rows.
    rest: f64,
    rows: usize,
}

impl Spectrum {
    /// Costs 2 n m² operations. `None` if the singular value decomposition fails.
    pub(crate) fn of<C: Covariance>(features: &Features<'_, C>, lower: &Factor) -> Option<Spectrum> {
        let (count, targets) = (features.inducing.len(), &features.targets.values);
        let columns = count + targets.ncols();
        let all = triangle(targets.nrows(), columns, &|rows| features.with_targets(rows));
        // R of Φ is R of K_nm times L⁻ᵀ; its transpose solves L Xᵀ = Rᵀ.
        let mut transposed = all.view((0, 0), (count, count)).transpose();
        lower.whiten(&mut transposed);
        let Svd { u, singular, v } = singular_values(&transposed.transpose())?;
        let mut w = v.clone();
        lower.whiten_transposed(&mut w);
        let rest = all.view((count, count), (targets.ncols(), targets.ncols())).norm_squared();
        let rows = targets.nrows();
        let targets = u.tr_mul(&all.view((0, count), (count, targets.ncols())));
        Some(Spectrum { singular, v, w, targets, rest, rows })
    }

    /// σ² with the highest marginal likelihood of all rows at these amplitudes (S39). Costs m operations for each trial value of σ².
    pub(crate) fn noise(&self) -> f64 {
        let (least, most) = NOISE;
        let level = |step: usize| (least + (most - least) * step as f64 / STEPS as f64).exp();
        let evidence = |step: &usize| self.evidence(level(*step));
        (0..=STEPS).min_by(|a, b| evidence(a).total_cmp(&evidence(b))).map_or(least.exp(), level)
    }

    /// -2 log p(Y) up to constants: Σ_j [c log(s² + σ²) + |q_j|²/(s² + σ²)] + (n − m) c log σ² + rest/σ².
    pub(super) fn evidence(&self, noise: f64) -> f64 {
        let outputs = self.targets.ncols() as f64;
        let of_features = self.singular.iter().zip(self.targets.row_iter()).map(|(s, targets)| {
            let variance = s * s + noise;
            outputs * variance.ln() + targets.norm_squared() / variance
        });
        let others = self.rows.saturating_sub(self.singular.len()) as f64;
        of_features.sum::<f64>() + others * outputs * noise.ln() + self.rest / noise
    }

    /// V^T times the posterior mean of w at a noise level: s/(s² + σ²) UᵀD^{-1/2}Y, (m, c).
    pub(crate) fn coefficients(&self, noise: f64) -> DMatrix<f64> {
        let mut coefficients = self.targets.clone();
        for (mut row, s) in coefficients.row_iter_mut().zip(&self.singular) {
            row *= s / (s * s + noise);
        }
        coefficients
    }

    /// T, (m, m), upper triangle (S37). TL⁻¹k gives the explained variance of a function with covariances k, instead of L⁻¹k for rows
    /// without noise. The policy is conditioned with the noise κσ², rows have `own` = σ².
    pub(crate) fn shrinkage(&self, noise: f64, own: f64) -> DMatrix<f64> {
        let mut shrunk = self.v.transpose();
        for (mut row, s) in shrunk.row_iter_mut().zip(&self.singular) {
            let variance = s * s + noise;
            row *= s * (variance + noise - own).sqrt() / variance;
        }
        qr_triangle(shrunk)
    }
}
