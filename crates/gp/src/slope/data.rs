use nalgebra::DMatrix;

use crate::evidence::Evidence;
use crate::evidence::family_fit::{FamilyFit, fit_family};
use crate::inducing::Induced;
use crate::kernel::block::Block;
use crate::kernel::covariance::Covariance;
use crate::kernel::slope_covariance::SlopeCovariance;
use crate::kernel::triangle::Upper;
use crate::kernel::whitening::Whitening;
use crate::left_out::LeftOutPredictions;
use crate::left_out::level::{Level, Targets, kappas};
use crate::rows::kept::Kept;
use crate::rows::noise_weights::{require_noise_weights, require_positive};
use crate::rows::scaling::Scaling;
use crate::slope::expansion::Expansion;
use crate::slope::model::SlopeModel;
use crate::{GpError, Rows};

/// The slope GP's training data: (S1), in scaled coordinates and with noise weights.
///
/// To fit a policy, use [`SlopeGp`](crate::SlopeGp); with this type the caller sets the amplitudes.
#[derive(Debug, Clone)]
pub struct SlopeData {
    pub(crate) scaling: Scaling,
    /// r̄² = Σ(r²/D)/Σ(1/D).
    pub(crate) unit: f64,
    /// Scaled states and contexts z, (n + p, M).
    pub(crate) z: DMatrix<f64>,
    /// Directions of motion n = u/r, (n, M).
    pub(crate) n: DMatrix<f64>,
    /// y = r/r̄, (M, 1).
    pub(crate) targets: Targets,
}

/// The matrices of (S25), (n, n) each.
#[derive(Debug)]
pub(crate) struct AxisErrors {
    pub(crate) errors: DMatrix<f64>,
    pub(crate) targets: DMatrix<f64>,
}

impl SlopeData {
    /// Takes every row, with noise weights D, (M); the rows of a trajectory need not be contiguous.
    ///
    /// # Errors
    /// [`GpError::Lengths`], [`GpError::OneState`], [`GpError::Overflow`], or [`GpError::Value`] for a row without motion or a
    /// weight that is not positive.
    pub fn new(rows: &Rows, noise_weights: Vec<f64>) -> Result<Self, GpError> {
        require_noise_weights(rows, &noise_weights)?;
        let parts = rows.parts();
        let speeds: Vec<f64> = parts.column_iter().map(|part| part.norm()).collect();
        require_positive("speed", &speeds)?;
        Self::of(rows.states(), &parts, &speeds, noise_weights, rows.groups())
    }

    pub(crate) fn from_kept(kept: &Kept, noise_weights: Vec<f64>) -> Result<Self, GpError> {
        Self::of(&kept.states, &kept.velocities, &kept.speeds, noise_weights, kept.groups.clone())
    }

    /// Other rows in the units of these.
    pub(crate) fn of_others(&self, kept: &Kept, noise_weights: Vec<f64>) -> Self {
        let units = (self.scaling.clone(), self.unit);
        Self::in_units(units, &kept.states, &kept.velocities, &kept.speeds, noise_weights, kept.groups.clone())
    }

    fn of(
        states: &DMatrix<f64>,
        velocities: &DMatrix<f64>,
        speeds: &[f64],
        noise_weights: Vec<f64>,
        groups: Vec<Vec<usize>>,
    ) -> Result<Self, GpError> {
        let power: f64 = speeds.iter().zip(&noise_weights).map(|(r, d)| r * r / d).sum();
        let unit = (power / noise_weights.iter().map(|d| 1.0 / d).sum::<f64>()).sqrt();
        Ok(Self::in_units((Scaling::of(states)?, unit), states, velocities, speeds, noise_weights, groups))
    }

    fn in_units(
        (scaling, unit): (Scaling, f64),
        states: &DMatrix<f64>,
        velocities: &DMatrix<f64>,
        speeds: &[f64],
        noise_weights: Vec<f64>,
        groups: Vec<Vec<usize>>,
    ) -> Self {
        let values = DMatrix::from_iterator(speeds.len(), 1, speeds.iter().map(|r| r / unit));
        let spread = values.iter().zip(&noise_weights).map(|(y, d)| y * y / d).sum();
        let mut n = velocities.clone();
        for (mut direction, r) in n.column_iter_mut().zip(speeds) {
            direction /= *r;
        }
        let targets = Targets { values, noise_weights, groups, spread };
        SlopeData { z: scaling.apply(states), scaling, unit, n, targets }
    }

    /// μ and S: z = (x − μ)/S.
    pub fn scaling(&self) -> (&[f64], f64) {
        (&self.scaling.mean, self.scaling.scale)
    }

    /// r̄, the unit of speed, in units of the state per second.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// (S8), (S9) on all rows at θ = (log a_1 .. log a_B, log σ²); `None` if the covariance has no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub fn evidence(&self, blocks: &[Block], theta: &[f64]) -> Option<Evidence> {
        Evidence::of(&self.covariance(blocks), theta, &self.targets)
    }

    /// The model at θ with the noise increased by κ, and its leave-one-trajectory-out predictions; `None` if the covariance has
    /// no Cholesky factor.
    ///
    /// # Panics
    /// If `theta` does not have one entry per block and one more.
    pub fn condition(&self, blocks: &[Block], theta: &[f64], kappa: f64) -> Option<(SlopeModel, LeftOutPredictions)> {
        let fit = FamilyFit::at(&self.covariance(blocks), theta, kappa, &self.targets)?;
        let left_out = fit.level.left_out.clone();
        Some((self.model(blocks.to_vec(), fit), left_out))
    }

    /// Determines amplitudes by the marginal likelihood on the hyper rows, noise by held-out prediction: (S8), (S11). Searches a
    /// second time from the amplitudes `second_start`, if given.
    pub(crate) fn fit(&self, blocks: &[Block], hyper: &[usize], second_start: Option<&[f64]>) -> Option<FamilyFit> {
        fit_family(&self.covariance(blocks), hyper, &self.targets, second_start)
    }

    /// The same amplitudes with every noise level κ > `from` that has a Cholesky factor.
    pub(crate) fn raised<'a>(
        &'a self,
        blocks: &'a [Block],
        amplitudes: &'a [f64],
        (found, from): (f64, f64),
    ) -> impl Iterator<Item = FamilyFit> + 'a {
        let covariance = self.covariance(blocks).sum(amplitudes);
        let level = move |kappa| Level::at(&covariance, found, kappa, &self.targets);
        let fit = |level| FamilyFit { amplitudes: amplitudes.to_vec(), level };
        kappas().filter(move |&kappa| kappa > from).map_while(level).map(fit)
    }

    /// (S25): products of left-out errors, and of targets, for every pair of axes. The targets of axis j are n_ij u_ij, with
    /// whole velocities u, (n, M). `None` without a Cholesky factor.
    pub(crate) fn axis_errors(
        &self,
        velocities: &DMatrix<f64>,
        blocks: &[Block],
        fit: &FamilyFit,
    ) -> Option<AxisErrors> {
        let targets = self.n.component_mul(velocities).transpose() / self.unit;
        let targets = Targets { values: targets, ..self.targets.clone() };
        let covariance = self.covariance(blocks).sum(&fit.amplitudes);
        let level = Level::at(&covariance, fit.level.found, fit.level.kappa, &targets)?;
        let product = |of: &DMatrix<f64>| {
            let mut weighed = of.clone();
            for (mut row, weight) in weighed.row_iter_mut().zip(&targets.noise_weights) {
                row /= *weight;
            }
            weighed.tr_mul(of)
        };
        Some(AxisErrors { errors: product(&level.left_out.residuals), targets: product(&targets.values) })
    }

    pub(crate) fn model(&self, blocks: Vec<Block>, fit: FamilyFit) -> SlopeModel {
        let FamilyFit { amplitudes, level } = fit;
        let scaled = (self.scaling.clone(), self.unit);
        let weights = level.weights.as_slice().to_vec();
        let expansion = Expansion::new(scaled, (blocks, amplitudes), (self.z.clone(), self.n.clone()), weights);
        let whitening =
            Whitening::Rows { noise_weights: self.targets.noise_weights.clone(), factor: level.factor.into() };
        SlopeModel::new(expansion, level.noise, whitening)
    }

    /// The model with these amplitudes, conditioned on all rows through at most `most` of them; `None` without a Cholesky
    /// factor.
    pub(crate) fn induced(
        &self,
        (blocks, amplitudes): (&[Block], &[f64]),
        most: usize,
    ) -> Option<(SlopeModel, LeftOutPredictions, f64)> {
        let Induced { rows, kappa, noise, weights, factor, shrinkage, left_out } =
            Induced::new(&self.covariance(blocks), amplitudes, &self.targets, most)?;
        let scaled = (self.scaling.clone(), self.unit);
        let of_rows = (self.z.select_columns(&rows), self.n.select_columns(&rows));
        let prior = (blocks.to_vec(), amplitudes.to_vec());
        let expansion = Expansion::new(scaled, prior, of_rows, weights.as_slice().to_vec());
        let whitening = Whitening::Inducing { shrinkage: Upper::new(&shrinkage), factor: factor.into() };
        Some((SlopeModel::new(expansion, noise, whitening), left_out, kappa))
    }

    fn covariance<'a>(&'a self, blocks: &'a [Block]) -> SlopeCovariance<'a> {
        SlopeCovariance { blocks, z: &self.z, n: &self.n }
    }
}
