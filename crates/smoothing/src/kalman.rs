//! One scalar Kalman filter for all dimensions, with the backward pass of Rauch–Tung–Striebel. Variances are in units
//! of the positions' noise variance ρ.

use nalgebra::DMatrix;

/// Variances at every sample, which also give the gains; they do not depend on the positions.
#[derive(Debug)]
pub(crate) struct Gains {
    /// Variance of the state given samples up to i.
    filtered: Vec<f64>,
    /// Variance of the state given samples before i; the filter starts at the first sample.
    predicted: Vec<f64>,
}

impl Gains {
    /// Variances for `n_samples`, with process noise `ratio` = q/ρ per step; the first sample is known up to the noise.
    pub(crate) fn new(n_samples: usize, ratio: f64) -> Self {
        let (mut filtered, mut predicted) = (vec![1.0], vec![f64::INFINITY]);
        for i in 1..n_samples {
            let before = filtered[i - 1] + ratio;
            predicted.push(before);
            filtered.push(before / (before + 1.0));
        }
        Gains { filtered, predicted }
    }

    /// Variance S_i of the innovation, which is the difference between a sample and its prediction.
    pub(crate) fn innovation_variance(&self, sample: usize) -> f64 {
        self.predicted[sample] + 1.0
    }

    /// Filters positions (n, N), with `steps` (n, N − 1) predicted between them, into `states` (n, N). Calls
    /// `innovation` with every sample but the first and the square Σ_j e_ij² of its innovation.
    pub(crate) fn filter(
        &self,
        positions: &DMatrix<f64>,
        steps: &DMatrix<f64>,
        states: &mut DMatrix<f64>,
        mut innovation: impl FnMut(usize, f64),
    ) {
        states.set_column(0, &positions.column(0));
        for i in 1..positions.ncols() {
            let mut square = 0.0;
            for j in 0..positions.nrows() {
                let predicted = states[(j, i - 1)] + steps[(j, i - 1)];
                let error = positions[(j, i)] - predicted;
                square += error * error;
                states[(j, i)] = predicted + self.filtered[i] * error;
            }
            innovation(i, square);
        }
    }

    /// Smooths filtered `states` (n, N) in place, backwards; returns their variances (N).
    pub(crate) fn smooth(&self, steps: &DMatrix<f64>, states: &mut DMatrix<f64>) -> Vec<f64> {
        let last = states.ncols() - 1;
        let mut variance = self.filtered[..=last].to_vec();
        for i in (0..last).rev() {
            let gain = self.filtered[i] / self.predicted[i + 1];
            for j in 0..states.nrows() {
                states[(j, i)] += gain * (states[(j, i + 1)] - states[(j, i)] - steps[(j, i)]);
            }
            variance[i] += gain * gain * (variance[i + 1] - self.predicted[i + 1]);
        }
        variance
    }
}
