use nalgebra::DMatrix;

/// The prior of a model: a sum of blocks over rows, each with its amplitude.
pub(crate) trait Covariance: Sync {
    /// Number of blocks B.
    fn n_blocks(&self) -> usize;

    /// The covariance matrix of each block alone among these rows; lower triangles.
    fn each_among(&self, rows: &[usize]) -> Vec<DMatrix<f64>>;

    /// Σ a_b K_b among all rows; lower triangle.
    fn sum(&self, amplitudes: &[f64]) -> DMatrix<f64>;

    /// Writes Σ a_b K_b of a row with each of some rows, (m).
    fn with<'a>(&'a self, rows: &[usize], amplitudes: &'a [f64]) -> impl Fn(usize, &mut [f64]) + Sync + 'a;

    /// Σ a_b K_b of a row with itself.
    fn variance(&self, row: usize, amplitudes: &[f64]) -> f64;
}

/// Minimum noise variance, which (S6) adds to σ².
pub(crate) const NOISE_FLOOR: f64 = 1e-10;

/// Adds (σ² + 1e-10) diag(D), then 1e-12 times the mean of the diagonal: the remaining terms of (S6).
pub(crate) fn add_noise(matrix: &mut DMatrix<f64>, noise: f64, noise_weights: impl Iterator<Item = f64>) {
    let count = matrix.nrows();
    for (i, weight) in noise_weights.enumerate() {
        matrix[(i, i)] += (noise + NOISE_FLOOR) * weight;
    }
    let jitter = JITTER * (0..count).map(|i| matrix[(i, i)]).sum::<f64>() / count as f64;
    for i in 0..count {
        matrix[(i, i)] += jitter;
    }
}

/// Σ a_b K_b among some rows, by [`Covariance::with`].
pub(crate) fn among(covariance: &impl Covariance, rows: &[usize], amplitudes: &[f64]) -> DMatrix<f64> {
    let with = covariance.with(rows, amplitudes);
    let mut matrix = DMatrix::zeros(rows.len(), rows.len());
    matrix.column_iter_mut().zip(rows).for_each(|(mut column, &row)| with(row, column.as_mut_slice()));
    matrix
}

/// Share of the mean diagonal that is added to a covariance among inducing rows, so that it has a Cholesky factor.
const JITTER: f64 = 1e-12;

/// K_mm of (S34).
pub(crate) fn jittered(mut among: DMatrix<f64>) -> DMatrix<f64> {
    let jitter = JITTER * among.diagonal().mean();
    for i in 0..among.nrows() {
        among[(i, i)] += jitter;
    }
    among
}
