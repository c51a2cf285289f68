//! Exact sums over all segmentations of a movement into windows, (S16).

use crate::piecewise::evidence::{NoiseModel, log_sum_exp};
use crate::piecewise::windows::{Energy, Window, windows};

/// The evidence of every window of a movement, and of all segmentations into windows.
#[derive(Debug)]
pub(crate) struct Segmentation {
    n_samples: usize,
    pub(crate) longest: usize,
    log_switch: f64,
    log_stay: f64,
    /// S(a, b) at `a * longest + (b − a)`; −∞ if there is no such window.
    window: Vec<f64>,
    /// f_b: evidence of the first b samples.
    forward: Vec<f64>,
}

impl Segmentation {
    /// `switch_probability` is q, the probability that a window ends at a sample.
    pub(crate) fn new(
        n_samples: usize,
        longest: usize,
        switch_probability: f64,
        energies: &[Energy],
        model: &NoiseModel<'_>,
    ) -> Self {
        let mut window = vec![f64::NEG_INFINITY; n_samples * longest];
        let mut by_degree = vec![0.0; model.degrees.len()];
        for (Window { first, samples }, energy) in windows(n_samples, longest).zip(energies) {
            model.log_evidence(samples, energy, &mut by_degree);
            window[first * longest + samples - 1] = log_sum_exp(&by_degree);
        }
        let (log_switch, log_stay) = (switch_probability.ln(), (-switch_probability).ln_1p());
        let mut segmentation = Segmentation { n_samples, longest, log_switch, log_stay, window, forward: Vec::new() };
        segmentation.forward = segmentation.run_forward();
        segmentation
    }

    /// S(a, b).
    pub(crate) fn window_log_evidence(&self, window: Window) -> f64 {
        self.window[window.first * self.longest + window.samples - 1]
    }

    /// S(a, b) + log q + (b − a) log(1 − q).
    fn window_term(&self, window: Window) -> f64 {
        self.window_log_evidence(window) + self.log_switch + (window.samples as f64 - 1.0) * self.log_stay
    }

    /// f_N, the log evidence of the whole movement.
    pub(crate) fn log_evidence(&self) -> f64 {
        self.forward[self.n_samples]
    }

    fn run_forward(&self) -> Vec<f64> {
        let mut forward = vec![f64::NEG_INFINITY; self.n_samples + 1];
        forward[0] = 0.0;
        let mut terms = Vec::with_capacity(self.longest);
        for end in 2..=self.n_samples {
            terms.clear();
            terms.extend((2..=self.longest.min(end)).map(|samples| {
                let first = end - samples;
                forward[first] + self.window_term(Window { first, samples })
            }));
            forward[end] = log_sum_exp(&terms);
        }
        forward
    }

    /// log P(window) for all windows, in the order of [`windows`].
    pub(crate) fn log_probabilities(&self) -> impl Iterator<Item = (Window, f64)> + '_ {
        let backward = self.run_backward();
        windows(self.n_samples, self.longest).map(move |window| {
            let after = backward[window.first + window.samples];
            (window, self.forward[window.first] + self.window_term(window) + after - self.log_evidence())
        })
    }

    /// g_a: evidence of the samples from a on.
    fn run_backward(&self) -> Vec<f64> {
        let mut backward = vec![f64::NEG_INFINITY; self.n_samples + 1];
        backward[self.n_samples] = 0.0;
        let mut terms = Vec::with_capacity(self.longest);
        for first in (0..self.n_samples).rev() {
            terms.clear();
            terms.extend(
                (2..=self.longest.min(self.n_samples - first))
                    .map(|samples| self.window_term(Window { first, samples }) + backward[first + samples]),
            );
            backward[first] = log_sum_exp(&terms);
        }
        backward
    }
}
