use gp::{Block, DirectBlock, DirectFit, SlopeFit};
use nalgebra::DVector;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::error::ExportError;
use super::gp_tables::{DirectTables, SlopeTables};
use super::lwpr_tables::LwprTables;
use super::support_radius::squared_radius;
use crate::{Learnt, Model};

/// A policy as tables of numbers, with what every learner's has in common.
pub(super) struct Tables {
    /// The state is multiplied by this before it is asked, the action divided, (n).
    pub(super) scale: DVector<f64>,
    /// What counts as known lies between, (n).
    pub(super) bounds: Vec<[f64; 2]>,
    /// Of the potential, by this.
    pub(super) per_unit: f64,
    pub(super) learner: LearnerTables,
}

/// Parameters of each learner's policy.
pub(super) enum LearnerTables {
    Lwpr(LwprTables),
    Slope(SlopeTables),
    Direct(DirectTables),
}

impl Tables {
    pub(super) fn of(model: &Model) -> Result<Tables, ExportError> {
        let scale = DVector::from_iterator(model.state.len(), model.state.iter().map(|channel| channel.scale));
        let shared = scale.iter().all(|&s| s == scale[0]);
        let slope = |fit: &SlopeFit| SlopeTables::new(stored::<_, StoredSlope>(fit)?, |z| squared_radius(model, z));
        let direct = |fit: &DirectFit| {
            DirectTables::new(stored::<_, StoredDirect>(fit)?.direct_gp, |z| squared_radius(model, z))
        };
        let learner = match &model.learnt {
            Learnt::PolicyAlign(policy) => {
                let regression = policy.global_potential().regression();
                let predictor = stored(regression.predictor())?;
                LearnerTables::Lwpr(LwprTables::new(predictor, regression.mean()[0])?)
            }
            Learnt::Slope(fit) => LearnerTables::Slope(slope(fit)?),
            Learnt::Direct(fit) => LearnerTables::Direct(direct(fit)?),
            Learnt::Auto(both) if both.takes_slope() => LearnerTables::Slope(slope(both.slope())?),
            Learnt::Auto(both) => LearnerTables::Direct(direct(both.direct())?),
        };
        Ok(Tables { per_unit: if shared { scale[0].powi(-2) } else { 1.0 }, scale, bounds: model.bounds(), learner })
    }

    pub(super) fn dim(&self) -> usize {
        self.scale.len()
    }
}

/// The numbers of a value, by the form in which it is stored.
fn stored<T: Serialize, S: DeserializeOwned>(value: &T) -> Result<S, ExportError> {
    let form = |error: serde_json::Error| ExportError::Form { reason: error.to_string() };
    serde_json::from_value(serde_json::to_value(value).map_err(form)?).map_err(form)
}

/// The stored parameters of the two Gaussian processes' means.
#[derive(serde::Deserialize)]
pub(super) struct StoredGp<B> {
    pub(super) dim: usize,
    pub(super) scaling: StoredScaling,
    pub(super) unit: f64,
    pub(super) blocks: Vec<(B, f64)>,
    pub(super) states: Vec<f64>,
    pub(super) weights: Vec<f64>,
}

#[derive(serde::Deserialize)]
pub(super) struct StoredScaling {
    pub(super) mean: Vec<f64>,
    pub(super) scale: f64,
}

#[derive(serde::Deserialize)]
pub(super) struct StoredSlope {
    pub(super) slope_gp: StoredGp<Block>,
    pub(super) directions: Vec<f64>,
}

#[derive(serde::Deserialize)]
struct StoredDirect {
    direct_gp: StoredGp<DirectBlock>,
}
