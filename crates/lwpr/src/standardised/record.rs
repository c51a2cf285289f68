//! The stored form of a standardised model.

use std::sync::Arc;

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::standardised::check_cutoff;
use crate::{Lwpr, LwprError, StandardisedModel};

/// The version that is written; others are refused.
const VERSION: u32 = 1;

/// Record of a [`StandardisedModel`].
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StandardisedRecord {
    version: u32,
    cutoff: f64,
    mean: Vec<f64>,
    model: Lwpr,
}

impl From<StandardisedModel> for StandardisedRecord {
    fn from(model: StandardisedModel) -> Self {
        StandardisedRecord {
            version: VERSION,
            cutoff: model.cutoff(),
            mean: model.mean().as_slice().to_vec(),
            model: model.model().clone(),
        }
    }
}

impl TryFrom<StandardisedRecord> for StandardisedModel {
    type Error = LwprError;

    fn try_from(record: StandardisedRecord) -> Result<Self, LwprError> {
        let StandardisedRecord { version, cutoff, mean, model } = record;
        let corrupt = |reason: String| Err(LwprError::Corrupt { reason });
        if version != VERSION {
            return corrupt(format!("its version is {version}, this program reads version {VERSION}"));
        }
        check_cutoff(cutoff)?;
        if mean.len() != model.n_out() || !mean.iter().all(|mean| mean.is_finite()) {
            return corrupt(format!("{} means for {} outputs, or one is not finite", mean.len(), model.n_out()));
        }
        Ok(StandardisedModel::new(Arc::new(model), DVector::from_vec(mean), cutoff))
    }
}
