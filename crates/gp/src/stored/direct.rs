use nalgebra::DMatrix;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Stored, check_scales, of_whitening, whitening};
use crate::GpError;
use crate::direct::direct_gp::DirectFit;
use crate::direct::model::DirectModel;
use crate::kernel::direct_block::DirectBlock;
use crate::kernel::family::Family;

/// Record of a [`DirectFit`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DirectRecord {
    direct_gp: Stored<DirectBlock>,
    family: Family,
    r_squared: f64,
    z_squared: f64,
}

impl From<&DirectFit> for DirectRecord {
    fn from(fit: &DirectFit) -> Self {
        let &DirectFit { ref model, family, r_squared, z_squared } = fit;
        let (version, noise_weights, shrinkage) = of_whitening(&model.whitening);
        DirectRecord {
            direct_gp: Stored {
                version,
                dim: model.z.nrows(),
                scaling: model.scaling.clone(),
                unit: model.unit,
                blocks: model.blocks.iter().copied().zip(model.amplitudes.iter().copied()).collect(),
                noise: model.noise,
                states: model.z.as_slice().to_vec(),
                noise_weights,
                shrinkage,
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
        let (rows, moving) = direct_gp.check(&direct_gp.weights, |moving| moving)?;
        let dim = direct_gp.dim;
        check_scales(direct_gp.blocks.iter().map(|(block, _)| match block {
            DirectBlock::Shape(_, scale) => *scale,
            DirectBlock::Constant | DirectBlock::Linear | DirectBlock::Quadratic => 1.0,
        }))?;
        let model = DirectModel::new(
            (direct_gp.scaling, direct_gp.unit),
            direct_gp.blocks.into_iter().unzip(),
            DMatrix::from_vec(dim, rows, direct_gp.states),
            DMatrix::from_vec(moving, rows, direct_gp.weights),
            (direct_gp.noise, whitening(rows, direct_gp.noise_weights, &direct_gp.shrinkage)),
        );
        Ok(DirectFit { model, family, r_squared, z_squared })
    }
}

impl Serialize for DirectFit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        DirectRecord::from(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for DirectFit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        DirectRecord::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}
