use nalgebra::{DMatrix, DVector};

use crate::Metric;
use crate::field::Field;
use crate::settings::Settings;

/// A read-only view of a receptive field of a model.
#[derive(Debug, Clone, Copy)]
pub struct ReceptiveField<'a> {
    field: &'a Field,
    settings: &'a Settings,
}

impl<'a> ReceptiveField<'a> {
    pub(crate) fn new(field: &'a Field, settings: &'a Settings) -> Self {
        ReceptiveField { field, settings }
    }

    /// Centre c (`n_in`), in the units of the inputs.
    pub fn centre(&self) -> DVector<f64> {
        let norm = &self.settings.norm_in;
        DVector::from_fn(norm.len(), |i, _| self.field.centre(self.settings)[i] * norm[i])
    }

    /// Distance metric D (`n_in`, `n_in`), for inputs in their own units: q = (x − c)ᵀD(x − c).
    pub fn distance_metric(&self) -> DMatrix<f64> {
        let norm = &self.settings.norm_in;
        let mut d = metric_of(self.field.m(self.settings), self.settings.params.metric, norm.len());
        for row in 0..norm.len() {
            for column in 0..norm.len() {
                d[(row, column)] /= norm[row] * norm[column];
            }
        }
        d
    }

    /// Number of projection directions R, from 1 to `n_in`.
    pub fn n_projections(&self) -> usize {
        self.field.directions.len()
    }

    /// Effective number of learnt samples (older ones are partly forgotten).
    pub fn n_data(&self) -> f64 {
        self.field.directions[0].n_data
    }

    /// Whether the field has learnt enough (more than 2 `n_in` samples) to take part in
    /// predictions.
    pub fn is_trustworthy(&self) -> bool {
        self.field.is_trustworthy()
    }
}

/// D = MᵀM of a padded M.
pub(crate) fn metric_of(m: &[f64], metric: Metric, n: usize) -> DMatrix<f64> {
    match metric {
        Metric::Diagonal => DMatrix::from_fn(n, n, |i, j| if i == j { m[i] * m[i] } else { 0.0 }),
        Metric::Full => {
            let width = m.len() / n;
            let m = DMatrix::from_fn(n, n, |row, column| m[column * width + row]);
            m.tr_mul(&m)
        }
    }
}
