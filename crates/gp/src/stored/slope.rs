use nalgebra::DMatrix;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Stored, check_scales, of_whitening, stored, whitening};
use crate::GpError;
use crate::kernel::block::Block;
use crate::report::trust_report::TrustReport;
use crate::slope::expansion::Expansion;
use crate::slope::fit::SlopeFit;
use crate::slope::model::SlopeModel;

/// Record of a [`SlopeFit`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SlopeRecord {
    slope_gp: Stored<Block>,
    /// n, (n, M).
    directions: Vec<f64>,
    report: TrustReport,
}

impl From<&SlopeFit> for SlopeRecord {
    fn from(fit: &SlopeFit) -> Self {
        let expansion = fit.model.expansion();
        let (version, noise_weights, shrinkage) = of_whitening(&fit.model.whitening);
        SlopeRecord {
            slope_gp: Stored {
                version,
                dim: expansion.dim(),
                scaling: expansion.scaling.clone(),
                unit: expansion.speed,
                blocks: expansion.blocks.iter().copied().zip(expansion.amplitudes.iter().copied()).collect(),
                noise: fit.model.noise,
                states: expansion.z.as_slice().to_vec(),
                noise_weights,
                shrinkage,
                weights: expansion.weights.clone(),
            },
            directions: expansion.n.as_slice().to_vec(),
            report: fit.report.clone(),
        }
    }
}

impl TryFrom<SlopeRecord> for SlopeFit {
    type Error = GpError;

    fn try_from(record: SlopeRecord) -> Result<Self, GpError> {
        let SlopeRecord { slope_gp, directions, report } = record;
        let (rows, moving) = slope_gp.check(&directions, |_| 1)?;
        let dim = slope_gp.dim;
        if !directions.iter().all(|n| n.abs() <= 1.0 + 1e-9) {
            return Err(stored("the directions are not one of length 1 for each row"));
        }
        let scales = slope_gp.blocks.iter().map(|(block, _)| match block {
            Block::Potential(_, scale) | Block::DivergenceFree(scale) => *scale,
            Block::Linear | Block::Quadratic | Block::Skew => 1.0,
        });
        check_scales(scales)?;
        let whitening = whitening(rows, slope_gp.noise_weights, &slope_gp.shrinkage);
        let expansion = Expansion::new(
            (slope_gp.scaling, slope_gp.unit),
            slope_gp.blocks.into_iter().unzip(),
            (DMatrix::from_vec(dim, rows, slope_gp.states), DMatrix::from_vec(moving, rows, directions)),
            slope_gp.weights,
        );
        let model = SlopeModel::new(expansion, slope_gp.noise, whitening);
        Ok(SlopeFit { model, report })
    }
}

impl Serialize for SlopeFit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        SlopeRecord::from(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SlopeFit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        SlopeRecord::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}
