use lwpr::{LwprParams, StandardisedModel, Training};
use nalgebra::{DMatrix, DVector};
use rand::Rng;
use serde::{Deserialize, Serialize};

use super::regression::spread;
use crate::{AlignError, GlobalPotential, Regressor};

/// Locally weighted projection regression on centred values: a potential (23), or velocities in
/// [`DirectPolicyLearning`](crate::DirectPolicyLearning).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LwprRegressor {
    /// Parameters of LWPR, in units of `norm_in`: by default `init_d` 10, `w_gen` 0.5 and `penalty` 1e-5, the rest as in
    /// [`LwprParams::default`]. If `norm_in` is `None`, all dimensions are divided by one number, the root mean square of their
    /// standard deviations; if `norm_out` is `None`, the values are divided by their standard deviation.
    pub params: LwprParams,
    /// Number of passes over all samples, each in a new random order; 10 by default.
    pub passes: usize,
    /// Receptive fields take part in a prediction if their activation exceeds this; in [0, 1), 1e-3 by default.
    pub cutoff: f64,
}

impl Default for LwprRegressor {
    fn default() -> Self {
        // The paper's tables are reproduced with LWPR's own defaults on undivided values: narrower fields (`init_d` 25), fewer
        // of them (`w_gen` 0.1), almost no penalty (1e-6).
        let params = LwprParams { init_d: 10.0, w_gen: 0.5, penalty: 1e-5, ..LwprParams::default() };
        LwprRegressor { params, passes: 10, cutoff: 1e-3 }
    }
}

impl LwprRegressor {
    /// Learns `outputs` (n_out, M) from `states` (n, M), one column per sample.
    pub(crate) fn regression(
        &self,
        states: &DMatrix<f64>,
        outputs: &DMatrix<f64>,
        rng: &mut dyn Rng,
    ) -> Result<StandardisedModel, AlignError> {
        if states.ncols() == 0 {
            return Err(AlignError::NoSamples);
        }
        let LwprRegressor { params, passes, cutoff } = self;
        let norm_in = params.norm_in.clone().unwrap_or_else(|| DVector::repeat(states.nrows(), spread(states)));
        let params = LwprParams { norm_in: Some(norm_in), ..params.clone() };
        let training = Training { params, passes: *passes, cutoff: *cutoff };
        Ok(training.fit(states.as_view(), outputs.as_view(), rng)?)
    }
}

impl Regressor for LwprRegressor {
    type Fitted = GlobalPotential;
    type Error = AlignError;

    fn fit(
        &self,
        states: &DMatrix<f64>,
        values: &DVector<f64>,
        rng: &mut dyn Rng,
    ) -> Result<GlobalPotential, AlignError> {
        let outputs = DMatrix::from_row_slice(1, values.len(), values.as_slice());
        self.regression(states, &outputs, rng).map(GlobalPotential::new)
    }
}
