//! One scalar Kalman filter for all dimensions, with the Rauch–Tung–Striebel pass back. Variances are in units of the
//! positions' noise variance ρ.

use nalgebra::DMatrix;

/// Variances and gains at every sample; they do not depend on the positions.
#[derive(Debug)]
pub(crate) struct Gains {
    /// Variance after sample i was seen.
    seen: Vec<f64>,
    /// Variance before it was seen; the first sample is where the filter starts.
    foreseen: Vec<f64>,
}

impl Gains {
    /// For `n_samples`, process noise `ratio` = q/ρ a step; the first sample is known to within the noise.
    pub(crate) fn new(n_samples: usize, ratio: f64) -> Self {
        let (mut seen, mut foreseen) = (vec![1.0], vec![f64::INFINITY]);
        for i in 1..n_samples {
            let before = seen[i - 1] + ratio;
            foreseen.push(before);
            seen.push(before / (before + 1.0));
        }
        Gains { seen, foreseen }
    }

    /// Variance S_i of what a sample shows beyond what was foreseen.
    pub(crate) fn innovation_variance(&self, sample: usize) -> f64 {
        self.foreseen[sample] + 1.0
    }

    /// Filters positions (n, N), `steps` (n, N − 1) foreseen between them, into `states` (n, N), and calls
    /// `innovation` with every sample but the first and the square Σ_j e_ij² of what it shows beyond the foreseen.
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
                let foreseen = states[(j, i - 1)] + steps[(j, i - 1)];
                let error = positions[(j, i)] - foreseen;
                square += error * error;
                states[(j, i)] = foreseen + self.seen[i] * error;
            }
            innovation(i, square);
        }
    }

    /// Goes back over filtered `states` (n, N) and leaves smoothed ones; returns their variances (N).
    pub(crate) fn smooth(&self, steps: &DMatrix<f64>, states: &mut DMatrix<f64>) -> Vec<f64> {
        let last = states.ncols() - 1;
        let mut variance = self.seen[..=last].to_vec();
        for i in (0..last).rev() {
            let gain = self.seen[i] / self.foreseen[i + 1];
            for j in 0..states.nrows() {
                states[(j, i)] += gain * (states[(j, i + 1)] - states[(j, i)] - steps[(j, i)]);
            }
            variance[i] += gain * gain * (variance[i + 1] - self.foreseen[i + 1]);
        }
        variance
    }
}
