use nalgebra::{DMatrix, DMatrixView, DVector};

use crate::{MetricsError, Series};

/// A deviation of at most this share of the magnitude is a rounding error: a potential computed from states differs by
/// a few machine epsilons (2e-16) between states where it is truly the same. A truth that varies so little cannot serve
/// as a reference.
const ROUNDING: f64 = 1e-12;

/// The true series' variance, with its unit.
pub(crate) struct Spread {
    /// The largest magnitude in the truth. Values are divided by it before they are squared, so that very large and
    /// very small ones neither overflow nor underflow.
    pub(crate) unit: f64,
    /// Trace of the covariance (divided by N) in that unit, squared: σ² = variance · unit².
    pub(crate) variance: f64,
}

/// Checks two series (n, N), then finds the variance of the truth.
pub(crate) fn spread(truth: DMatrixView<'_, f64>, learnt: DMatrixView<'_, f64>) -> Result<Spread, MetricsError> {
    if truth.shape() != learnt.shape() {
        return Err(MetricsError::Shape { truth: truth.shape(), learnt: learnt.shape() });
    }
    if truth.is_empty() {
        return Err(MetricsError::Empty { rows: truth.nrows(), columns: truth.ncols() });
    }
    require_finite(truth, Series::Truth)?;
    require_finite(learnt, Series::Learnt)?;

    let samples = truth.ncols();
    let unit = truth.amax();
    let scaled: DMatrix<f64> = if unit > 0.0 { truth.map(|value| value / unit) } else { truth.into_owned() };
    let mean = mean(&scaled);
    let deviation = scaled.column_iter().map(|sample| (sample - &mean).norm_squared());
    let variance = deviation.sum::<f64>() / samples as f64;
    let mean_square = scaled.norm_squared() / samples as f64;
    if variance <= ROUNDING * ROUNDING * mean_square {
        let (magnitude, deviation) = (unit * mean_square.sqrt(), unit * variance.sqrt());
        return Err(MetricsError::ConstantTruth { samples, magnitude, deviation });
    }
    Ok(Spread { unit, variance })
}

/// The mean of the columns. The second step removes the rounding error of the first, so that the deviations of a
/// constant do not grow with the number of samples.
fn mean(samples: &DMatrix<f64>) -> DVector<f64> {
    let first = samples.column_mean();
    let rest = samples.column_iter().fold(DVector::zeros(samples.nrows()), |sum, sample| sum + (sample - &first));
    first + rest / samples.ncols() as f64
}

fn require_finite(values: DMatrixView<'_, f64>, series: Series) -> Result<(), MetricsError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let (sample, dimension) = (at / values.nrows(), at % values.nrows());
            Err(MetricsError::NotFinite { series, sample, dimension, value: values[(dimension, sample)] })
        }
    }
}

/// Checks that a result has not overflowed.
pub(crate) fn representable(result: f64) -> Result<f64, MetricsError> {
    if result.is_finite() { Ok(result) } else { Err(MetricsError::Overflow) }
}
