use lwpr::Kernel;
use serde::Deserialize;

use super::error::ExportError;

/// A potential as LWPR predicts it: f = mean + norm_out Σ w y / Σ w.
pub(super) struct LwprTables {
    pub(super) kernel: Kernel,
    /// Fields take part above this.
    pub(super) cutoff: f64,
    /// Inputs are divided by these, (n).
    pub(super) norm_in: Vec<f64>,
    pub(super) norm_out: f64,
    pub(super) mean: f64,
    pub(super) fields: Vec<Field>,
}

/// A field: w by q = (x − c)ᵀD(x − c), y = offset + slopeᵀ(x − c).
pub(super) struct Field {
    pub(super) centre: Vec<f64>,
    /// Its diagonal (n), or all of it (n²).
    pub(super) metric: Vec<f64>,
    pub(super) offset: f64,
    pub(super) slope: Vec<f64>,
}

/// A predictor as it is stored.
#[derive(Deserialize)]
pub(super) struct StoredPredictor {
    kernel: Kernel,
    cutoff: f64,
    norm_in: Vec<f64>,
    norm_out: Vec<f64>,
    outputs: Vec<Vec<StoredField>>,
}

#[derive(Deserialize)]
struct StoredField {
    centre: Vec<f64>,
    metric: Vec<f64>,
    affine: Option<StoredAffine>,
}

#[derive(Deserialize)]
struct StoredAffine {
    offset: f64,
    slope: Vec<f64>,
}

impl LwprTables {
    pub(super) fn new(stored: StoredPredictor, mean: f64) -> Result<Self, ExportError> {
        let StoredPredictor { kernel, cutoff, norm_in, norm_out, outputs } = stored;
        // Fields that are not trustworthy take no part.
        let trusted = |field: StoredField| {
            let StoredAffine { offset, slope } = field.affine?;
            Some(Field { centre: field.centre, metric: field.metric, offset, slope })
        };
        let fields: Vec<_> = outputs.into_iter().next().unwrap_or_default().into_iter().filter_map(trusted).collect();
        if fields.is_empty() {
            return Err(ExportError::Nothing);
        }
        Ok(LwprTables { kernel, cutoff, norm_in, norm_out: norm_out[0], mean, fields })
    }

    pub(super) fn is_full(&self) -> bool {
        self.fields[0].metric.len() != self.norm_in.len()
    }
}
