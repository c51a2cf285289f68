use lwpr::LwprParams;
use nalgebra::{DMatrix, DVector};
use rand::Rng;
use serde::{Deserialize, Serialize};

use super::regression::{default_params, fit};
use crate::{AlignError, GlobalPotential, Regressor};

/// Learns by locally weighted projection regression, from values that are centred: a potential (23), or velocities in
/// [`DirectPolicyLearning`](crate::DirectPolicyLearning).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LwprRegressor {
    /// Parameters of LWPR, in units of `norm_in`: by default `init_d` 10, `w_gen` 0.5 and `penalty` 1e-5, the rest as in
    /// [`LwprParams::default`]. Where `norm_in` is `None`, all dimensions are divided by one number, the root mean square
    /// of their standard deviations; where `norm_out` is `None`, the values are divided by their standard deviation.
    pub params: LwprParams,
    /// How often all samples are learnt, each time in a fresh random order; 10 by default.
    pub passes: usize,
    /// Receptive fields take part in a prediction if their activation exceeds this; in [0, 1), 1e-3 by default.
    pub cutoff: f64,
}

impl Default for LwprRegressor {
    fn default() -> Self {
        LwprRegressor { params: default_params(), passes: 10, cutoff: 1e-3 }
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
        fit(self, states, &outputs, rng).map(GlobalPotential::new)
    }
}
