use crate::spread::representable;
use crate::{MetricsError, Series};

/// Summary of the errors of repeated experiments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Number of values.
    pub n: usize,
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation, with the sum of squares divided by n − 1; `None` for a single value.
    pub sd: Option<f64>,
    /// Median; for an even count, the mean of the middle two.
    pub median: f64,
}

impl Summary {
    /// Summarizes values; their order does not change any bit of the result.
    ///
    /// # Errors
    /// [`MetricsError::Empty`], [`MetricsError::NotFinite`] or [`MetricsError::Overflow`].
    pub fn of(values: &[f64]) -> Result<Self, MetricsError> {
        if values.is_empty() {
            return Err(MetricsError::Empty { rows: 1, columns: 0 });
        }
        if let Some(sample) = values.iter().position(|value| !value.is_finite()) {
            let value = values[sample];
            return Err(MetricsError::NotFinite { series: Series::Errors, sample, dimension: 0, value });
        }
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        let mean = representable(sorted.iter().sum::<f64>() / n as f64)?;
        let squares: f64 = sorted.iter().map(|value| (value - mean).powi(2)).sum();
        let sd = if n > 1 { Some(representable((squares / (n - 1) as f64).sqrt())?) } else { None };
        Ok(Summary { n, mean, sd, median: f64::midpoint(sorted[(n - 1) / 2], sorted[n / 2]) })
    }
}
