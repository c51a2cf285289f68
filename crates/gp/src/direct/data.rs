use nalgebra::{DMatrix, DVector};

use crate::direct::model::DirectModel;
use crate::evidence::Evidence;
use crate::evidence::family_fit::{FamilyFit, fit_family};
use crate::inducing::Induced;
use crate::kernel::direct_block::{DirectBlock, DirectCovariance};
use crate::kernel::triangle::Upper;
use crate::kernel::whitening::Whitening;
use crate::left_out::LeftOutPredictions;
use crate::left_out::level::Targets;
use crate::rows::kept::Kept;
use crate::rows::noise_weights::{direct_weights, require_noise_weights};
use crate::rows::scaling::Scaling;
use crate::{GpError, Rows};

/// The direct GP's training data: velocities, in scaled coordinates and with noise weights.
///
/// To fit a policy, use [`DirectGp`](crate::DirectGp); with this type the caller sets the amplitudes.
#[derive(Debug, Clone)]
pub struct DirectData {
    pub(crate) scaling: Scaling,
    /// ū² = (1/M) Σ|u|²/n.
    pub(crate) unit: f64,
    /// Scaled states and contexts z, (n + p, M).
    pub(crate) z: DMatrix<f64>,
    /// Y = u/ū, (M, n).
    targets: Targets,
}

impl DirectData {
    /// Takes every row, with noise weights D, (M); the rows of a trajectory need not be contiguous.
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::OneState`], [`GpError::NoMotion`], [`GpError::Overflow`], or [`GpError::Value`]
    /// for a weight that is not positive.
    pub fn new(rows: &Rows, noise_weights: Vec<f64>) -> Result<Self, GpError> {
        require_noise_weights(rows, &noise_weights)?;
        Self::of(rows.states(), rows.velocities(), |_| noise_weights, rows.groups())
    }

    pub(crate) fn from_kept(kept: &Kept) -> Result<Self, GpError> {
        let weights = |unit_squared| noise_weights(kept, unit_squared);
        Self::of(&kept.states, kept.observed(), weights, kept.groups.clone())
    }

    /// Other rows in the units of these.
    pub(crate) fn of_others(&self, kept: &Kept) -> Self {
        let (units, weights) = ((self.scaling.clone(), self.unit), noise_weights(kept, self.unit.powi(2)));
        Self::in_units(units, &kept.states, kept.observed(), weights, kept.groups.clone())
    }

    fn of(
        states: &DMatrix<f64>,
        velocities: &DMatrix<f64>,
        noise_weights: impl FnOnce(f64) -> Vec<f64>,
        groups: Vec<Vec<usize>>,
    ) -> Result<Self, GpError> {
        let scaling = Scaling::of(states)?;
        let unit_squared = velocities.norm_squared() / velocities.len() as f64;
        if unit_squared == 0.0 {
            return Err(GpError::NoMotion);
        }
        let units = (scaling, unit_squared.sqrt());
        Ok(Self::in_units(units, states, velocities, noise_weights(unit_squared), groups))
    }

    fn in_units(
        (scaling, unit): (Scaling, f64),
        states: &DMatrix<f64>,
        velocities: &DMatrix<f64>,
        noise_weights: Vec<f64>,
        groups: Vec<Vec<usize>>,
    ) -> Self {
        let values = velocities.transpose() / unit;
        let total: f64 = noise_weights.iter().map(|d| 1.0 / d).sum();
        let mut mean = DVector::zeros(values.ncols());
        for (target, d) in values.row_iter().zip(&noise_weights) {
            mean += target.transpose() / (d * total);
        }
        let each = values.row_iter().zip(&noise_weights);
        let spread = each.map(|(target, d)| (target.transpose() - &mean).norm_squared() / d).sum();
        let targets = Targets { values, noise_weights, groups, spread };
        DirectData { z: scaling.apply(states), scaling, unit, targets }
    }

    /// μ and S: z = (x − μ)/S.
    pub fn scaling(&self) -> (&[f64], f64) {
        (&self.scaling.mean, self.scaling.scale)
    }

    /// ū, the unit of speed, in units of the state per second.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// (R2) on all rows at θ = (log a_1 .. log a_B, log σ²); `None` if the covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub fn evidence(&self, blocks: &[DirectBlock], theta: &[f64]) -> Option<Evidence> {
        Evidence::of(&self.covariance(blocks), theta, &self.targets)
    }

    /// The model at θ with the noise increased by κ, and its leave-one-trajectory-out predictions (R3); `None` if the
    /// covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub fn condition(
        &self,
        blocks: &[DirectBlock],
        theta: &[f64],
        kappa: f64,
    ) -> Option<(DirectModel, LeftOutPredictions)> {
        let fit = FamilyFit::at(&self.covariance(blocks), theta, kappa, &self.targets)?;
        let left_out = fit.level.left_out.clone();
        Some((self.model(blocks.to_vec(), fit), left_out))
    }

    /// Determines amplitudes by the marginal likelihood on the hyper rows, noise by held-out prediction.
    pub(crate) fn fit(&self, blocks: &[DirectBlock], hyper: &[usize]) -> Option<FamilyFit> {
        fit_family(&self.covariance(blocks), hyper, &self.targets, None)
    }

    pub(crate) fn model(&self, blocks: Vec<DirectBlock>, fit: FamilyFit) -> DirectModel {
        let FamilyFit { amplitudes, level } = fit;
        let scaled = (self.scaling.clone(), self.unit);
        let weights = level.weights.transpose();
        let whitening =
            Whitening::Rows { noise_weights: self.targets.noise_weights.clone(), factor: level.factor.into() };
        DirectModel::new(scaled, (blocks, amplitudes), self.z.clone(), weights, (level.noise, whitening))
    }

    /// The model with these amplitudes, conditioned on all rows through at most `most` of them; `None` without a
    /// Cholesky factor.
    pub(crate) fn induced(
        &self,
        (blocks, amplitudes): (&[DirectBlock], &[f64]),
        most: usize,
    ) -> Option<(DirectModel, LeftOutPredictions)> {
        let Induced { rows, noise, weights, factor, shrinkage, left_out, .. } =
            Induced::new(&self.covariance(blocks), amplitudes, &self.targets, most)?;
        let scaled = (self.scaling.clone(), self.unit);
        let (prior, z) = ((blocks.to_vec(), amplitudes.to_vec()), self.z.select_columns(&rows));
        let whitening = Whitening::Inducing { shrinkage: Upper::new(&shrinkage), factor: factor.into() };
        Some((DirectModel::new(scaled, prior, z, weights.transpose(), (noise, whitening)), left_out))
    }

    fn covariance<'a>(&'a self, blocks: &'a [DirectBlock]) -> DirectCovariance<'a> {
        DirectCovariance { blocks, z: &self.z }
    }
}

/// D of rows whose velocities have this mean square per component.
fn noise_weights(kept: &Kept, unit_squared: f64) -> Vec<f64> {
    match &kept.variances {
        None => vec![1.0; kept.speeds.len()],
        Some(variances) => direct_weights(variances, unit_squared),
    }
}
