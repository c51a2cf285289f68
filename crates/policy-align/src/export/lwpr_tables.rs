use lwpr::{Kernel, LocalPrediction, StandardisedModel};

use super::error::ExportError;

/// The tables of LWPR's potential: f = mean + norm_out Σ w y / Σ w.
pub(super) struct LwprTables<'a> {
    pub(super) kernel: Kernel,
    /// Only fields with weights above this take part.
    pub(super) cutoff: f64,
    /// Inputs are divided by these, (n).
    pub(super) norm_in: &'a [f64],
    pub(super) norm_out: f64,
    pub(super) mean: f64,
    pub(super) fields: Vec<LocalPrediction<'a>>,
}

impl<'a> LwprTables<'a> {
    pub(super) fn new(regression: &'a StandardisedModel) -> Result<Self, ExportError> {
        let predictor = regression.predictor();
        let fields: Vec<_> = predictor.fields(0).collect();
        if fields.is_empty() {
            return Err(ExportError::Nothing);
        }
        let (kernel, cutoff, norm_in) = (predictor.kernel(), predictor.cutoff(), predictor.norm_in());
        Ok(LwprTables {
            kernel,
            cutoff,
            norm_in,
            norm_out: predictor.norm_out()[0],
            mean: regression.mean()[0],
            fields,
        })
    }

    pub(super) fn is_full(&self) -> bool {
        self.fields[0].metric.len() != self.norm_in.len()
    }
}
