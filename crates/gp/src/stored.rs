//! Fits as they are stored: what their policies are made of, to the last bit. The Cholesky factor, which only the
//! uncertainty needs, is made again.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::GpError;
use crate::block::Block;
use crate::direct_block::DirectBlock;
use crate::direct_gp::DirectFit;
use crate::direct_model::DirectModel;
use crate::expansion::Expansion;
use crate::family::Family;
use crate::scaling::Scaling;
use crate::slope_fit::SlopeFit;
use crate::slope_model::SlopeModel;
use crate::trust_report::TrustReport;

/// The form below. A later one reads this too.
const VERSION: u32 = 1;

/// Numbers that both kinds of model have; matrices column after column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored<B> {
    version: u32,
    dim: usize,
    scaling: Scaling,
    /// Unit of speed.
    unit: f64,
    blocks: Vec<(B, f64)>,
    noise: f64,
    /// z, (n, M).
    states: Vec<f64>,
    noise_weights: Vec<f64>,
    /// (M) for slopes, (n, M) for velocities.
    weights: Vec<f64>,
}

/// A [`SlopeFit`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SlopeRecord {
    slope_gp: Stored<Block>,
    /// n, (n, M).
    directions: Vec<f64>,
    report: TrustReport,
}

/// A [`DirectFit`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DirectRecord {
    direct_gp: Stored<DirectBlock>,
    family: Family,
    r_squared: f64,
    z_squared: f64,
}

impl<B> Stored<B> {
    /// The number of rows; `weights_a_row` numbers of `weights` belong to each.
    fn check(&self, weights_a_row: usize) -> Result<usize, GpError> {
        let rows = self.noise_weights.len();
        let finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        let positive = |number: f64| number > 0.0 && number.is_finite();
        let amplitudes = || self.blocks.iter().map(|(_, amplitude)| *amplitude);
        let checks = [
            (self.version == VERSION, "it has another version than 1; use a newer program"),
            (self.dim > 0 && rows > 0 && !self.blocks.is_empty(), "it is empty"),
            (self.scaling.mean.len() == self.dim, "the mean has not one number a dimension"),
            (self.states.len() == rows.saturating_mul(self.dim), "there is not one state a row"),
            (self.weights.len() == rows.saturating_mul(weights_a_row), "there is not one weight a row"),
            (finite(&self.states) && finite(&self.weights) && finite(&self.scaling.mean), "a number is not finite"),
            (positive(self.scaling.scale) && positive(self.unit), "a unit is not positive"),
            (amplitudes().all(|a| a >= 0.0 && a.is_finite()), "an amplitude is negative or not finite"),
            (self.noise >= 0.0 && self.noise.is_finite(), "the noise is negative or not finite"),
            (self.noise_weights.iter().all(|&weight| positive(weight)), "a noise weight is not positive"),
        ];
        match checks.into_iter().find(|(fine, _)| !fine) {
            None => Ok(rows),
            Some((_, reason)) => Err(stored(reason)),
        }
    }
}

fn stored(reason: &str) -> GpError {
    GpError::Stored { reason: reason.to_owned() }
}

impl From<SlopeFit> for SlopeRecord {
    fn from(fit: SlopeFit) -> Self {
        let expansion = fit.model.expansion();
        SlopeRecord {
            slope_gp: Stored {
                version: VERSION,
                dim: expansion.dim(),
                scaling: expansion.scaling.clone(),
                unit: expansion.speed,
                blocks: expansion.blocks.iter().copied().zip(expansion.amplitudes.iter().copied()).collect(),
                noise: fit.model.noise,
                states: expansion.z.as_slice().to_vec(),
                noise_weights: fit.model.noise_weights.clone(),
                weights: expansion.weights.clone(),
            },
            directions: expansion.n.as_slice().to_vec(),
            report: fit.report,
        }
    }
}

impl TryFrom<SlopeRecord> for SlopeFit {
    type Error = GpError;

    fn try_from(record: SlopeRecord) -> Result<Self, GpError> {
        let SlopeRecord { slope_gp, directions, report } = record;
        let rows = slope_gp.check(1)?;
        let dim = slope_gp.dim;
        if directions.len() != slope_gp.states.len() || !directions.iter().all(|n| n.abs() <= 1.0 + 1e-9) {
            return Err(stored("there is not one direction of length 1 a row"));
        }
        let scales = slope_gp.blocks.iter().map(|(block, _)| match block {
            Block::Potential(_, scale) | Block::DivergenceFree(scale) => *scale,
            Block::Linear | Block::Quadratic | Block::Skew => 1.0,
        });
        check_scales(scales)?;
        let matrix = |numbers| DMatrix::from_vec(dim, rows, numbers);
        let expansion = Expansion::new(
            (slope_gp.scaling, slope_gp.unit),
            slope_gp.blocks.into_iter().unzip(),
            (matrix(slope_gp.states), matrix(directions)),
            slope_gp.weights,
        );
        let model = SlopeModel::restored(expansion, slope_gp.noise_weights, slope_gp.noise);
        Ok(SlopeFit { model: model.ok_or_else(|| stored("its covariance has no Cholesky factor"))?, report })
    }
}

fn check_scales(mut scales: impl Iterator<Item = f64>) -> Result<(), GpError> {
    if scales.all(|scale| scale > 1e-9 && scale < 1e9) {
        Ok(())
    } else {
        Err(stored("a block has a scale that cannot be"))
    }
}

impl From<DirectFit> for DirectRecord {
    fn from(fit: DirectFit) -> Self {
        let DirectFit { model, family, r_squared, z_squared } = fit;
        DirectRecord {
            direct_gp: Stored {
                version: VERSION,
                dim: model.z.nrows(),
                scaling: model.scaling.clone(),
                unit: model.unit,
                blocks: model.blocks.iter().copied().zip(model.amplitudes.iter().copied()).collect(),
                noise: model.noise,
                states: model.z.as_slice().to_vec(),
                noise_weights: model.noise_weights.clone(),
                weights: model.weights.as_slice().to_vec(),
            },
            family,
            r_squared,
            z_squared,
        }
    }
}

impl TryFrom<DirectRecord> for DirectFit {
    type Error = GpError;

    fn try_from(record: DirectRecord) -> Result<Self, GpError> {
        let DirectRecord { direct_gp, family, r_squared, z_squared } = record;
        let rows = direct_gp.check(direct_gp.dim)?;
        let dim = direct_gp.dim;
        check_scales(direct_gp.blocks.iter().map(|(block, _)| match block {
            DirectBlock::Shape(_, scale) => *scale,
            DirectBlock::Constant | DirectBlock::Linear | DirectBlock::Quadratic => 1.0,
        }))?;
        let matrix = |numbers| DMatrix::from_vec(dim, rows, numbers);
        let model = DirectModel::restored(
            (direct_gp.scaling, direct_gp.unit),
            direct_gp.blocks.into_iter().unzip(),
            matrix(direct_gp.states),
            matrix(direct_gp.weights),
            (direct_gp.noise, direct_gp.noise_weights),
        );
        let model = model.ok_or_else(|| stored("its covariance has no Cholesky factor"))?;
        Ok(DirectFit { model, family, r_squared, z_squared })
    }
}
