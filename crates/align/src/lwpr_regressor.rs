use lwpr::LwprParams;
use nalgebra::{DMatrix, DVector};
use rand::Rng;

use crate::centred_model::{CentredModel, Training};
use crate::{AlignError, GlobalPotential, Regressor};

/// Learns a potential by locally weighted projection regression, from values that are centred and divided by their
/// standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct LwprRegressor {
    /// Parameters of LWPR; `norm_out` is replaced by the standard deviation of the values.
    pub params: LwprParams,
    /// How often all samples are learnt, each time in a fresh random order; 10 by default.
    pub passes: usize,
    /// Receptive fields take part in a prediction if their activation exceeds this; in [0, 1), 1e-3 by default.
    pub cutoff: f64,
}

impl Default for LwprRegressor {
    fn default() -> Self {
        LwprRegressor { params: LwprParams::default(), passes: 10, cutoff: 1e-3 }
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
        let training = Training { params: &self.params, passes: self.passes, cutoff: self.cutoff };
        let outputs = DMatrix::from_row_slice(1, values.len(), values.as_slice());
        CentredModel::fit(training, states, outputs, rng).map(GlobalPotential::new)
    }
}
