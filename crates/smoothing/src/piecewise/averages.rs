//! States and velocities averaged over all windows and degrees, weighted by probability.

use nalgebra::{DMatrix, DVector};

use crate::piecewise::evidence::NoiseModel;
use crate::piecewise::scaled::ScaledMovement;
use crate::piecewise::segmentation::Segmentation;
use crate::piecewise::windows::{Bases, Energy};

/// Least log probability of a window that takes part, if windows have up to [`MANY`] samples.
const LEAST_LOG_PROBABILITY: f64 = -9.0;
const MANY: f64 = 60.0;

/// Least weight of a window with one degree that takes part.
const LEAST_WEIGHT: f64 = 1e-5;

/// Estimates of a movement, averaged over windows, in scaled axes about its mean.
#[derive(Debug)]
pub(crate) struct Averages {
    /// x̂ and û, (d, N).
    pub(crate) states: Average,
    pub(crate) velocities: Average,
    /// P(a window begins at sample i), (N).
    pub(crate) window_begins: DVector<f64>,
}

/// A weighted mean and its variance per axis at every sample: variance inside the windows plus variance between them.
#[derive(Debug)]
pub(crate) struct Average {
    /// Mean, (d, N).
    pub(crate) mean: DMatrix<f64>,
    /// Variance, (N), averaged over the axes.
    pub(crate) variance: DVector<f64>,
}

impl Averages {
    pub(crate) fn new(
        movement: &ScaledMovement<'_>,
        bases: &Bases,
        energies: &[Energy],
        segmentation: &Segmentation,
        model: &NoiseModel<'_>,
    ) -> Self {
        let (dim, n) = (movement.dim, movement.n_samples());
        let mut window_begins = DVector::zeros(n);
        let (mut states, mut velocities) = (Sum::new(dim, n), Sum::new(dim, n));
        let (mut coefficients, mut shrunk) = (Vec::new(), Vec::new());
        let mut by_degree = vec![0.0; model.degrees.len()];
        // About L²/2 windows contain each sample, so that longer windows are individually less likely.
        let least = LEAST_LOG_PROBABILITY + 2.0 * (MANY / segmentation.longest as f64).ln().min(0.0);
        for ((window, log_probability), energy) in segmentation.log_probabilities().zip(energies) {
            window_begins[window.first] += log_probability.exp();
            if log_probability < least {
                continue;
            }
            let polynomials = bases.of(movement, window);
            let half = movement.recorded.seconds(window.first, window.first + window.samples - 1) / 2.0;
            polynomials.project(movement.window(window.first, window.samples), dim, &mut coefficients);
            let factors = &model.shrinkage(window.samples).factors;
            shrunk.clear();
            shrunk.extend(coefficients.iter().enumerate().map(|(at, c)| factors[at / dim] * c));
            model.log_evidence(window.samples, energy, &mut by_degree);
            let whole = segmentation.window_log_evidence(window);
            for (&degree, log_evidence) in model.degrees.iter().zip(&by_degree) {
                let weight = (log_probability + log_evidence - whole).exp();
                if weight < LEAST_WEIGHT {
                    continue;
                }
                let fit = Fit { dim, weight, factors: &factors[..=degree], shrunk: &shrunk, s2: model.noise_variance };
                for i in 0..window.samples {
                    states.add(window.first + i, &fit, polynomials.values(i), 1.0);
                    velocities.add(window.first + i, &fit, polynomials.slopes(i), 1.0 / half);
                }
            }
        }
        Averages { states: states.average(), velocities: velocities.average(), window_begins }
    }
}

/// A window fitted with one degree.
struct Fit<'a> {
    dim: usize,
    weight: f64,
    /// f_k up to the fit's degree.
    factors: &'a [f64],
    /// f_k c_kj at `k * dim + j`.
    shrunk: &'a [f64],
    s2: f64,
}

/// Weighted means and squared deviations, updated with each fit, so that small deviations lose no digits.
struct Sum {
    weights: Vec<f64>,
    mean: DMatrix<f64>,
    deviations: Vec<f64>,
    value: DVector<f64>,
}

impl Sum {
    fn new(dim: usize, n: usize) -> Self {
        Sum {
            weights: vec![0.0; n],
            mean: DMatrix::zeros(dim, n),
            deviations: vec![0.0; n],
            value: DVector::zeros(dim),
        }
    }

    /// Adds a fit's estimate at a sample; `row` holds the polynomials' values there, which are multiplied by `unit`.
    fn add(&mut self, sample: usize, fit: &Fit<'_>, row: &[f64], unit: f64) {
        self.value.fill(0.0);
        let mut inside = 0.0;
        for (k, factor) in fit.factors.iter().enumerate() {
            let q = row[k] * unit;
            inside += factor * q * q;
            for (value, shrunk) in self.value.iter_mut().zip(&fit.shrunk[k * fit.dim..]) {
                *value += q * shrunk;
            }
        }
        self.weights[sample] += fit.weight;
        let share = fit.weight / self.weights[sample];
        let mut between = 0.0;
        for (mean, value) in self.mean.column_mut(sample).iter_mut().zip(&self.value) {
            let step = value - *mean;
            *mean += share * step;
            between += step * (value - *mean);
        }
        self.deviations[sample] += fit.weight * (fit.dim as f64 * fit.s2 * inside + between);
    }

    fn average(self) -> Average {
        let dim = self.mean.nrows() as f64;
        let variance = self.deviations.iter().zip(&self.weights).map(|(sum, weight)| sum / weight / dim);
        let variance = DVector::from_iterator(self.weights.len(), variance);
        Average { mean: self.mean, variance }
    }
}
