//! How a set of episodes usually moves: what is unusual is measured by it.

use crate::clean::STILL;
use crate::draft::{Draft, Drafts};

/// Of every channel, over all episodes.
#[derive(Debug)]
pub(crate) struct Statistics {
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
    /// Median of |Δx|.
    pub(crate) step: Vec<f64>,
    /// Standard deviation of noise, from third differences; 0 where there are too few.
    pub(crate) noise: Vec<f64>,
}

/// Medians are taken over at most so many values, evenly chosen, since they would need a copy of all.
const MOST_VALUES: usize = 100_000;

impl Statistics {
    pub(crate) fn of(drafts: &Drafts) -> Self {
        let n = drafts.channels.len();
        let mut low = vec![f64::INFINITY; n];
        let mut high = vec![f64::NEG_INFINITY; n];
        for sample in drafts.episodes.iter().flat_map(|draft| draft.positions.chunks_exact(n.max(1))) {
            for ((low, high), &value) in low.iter_mut().zip(&mut high).zip(sample) {
                *low = low.min(value);
                *high = high.max(value);
            }
        }
        let steps = Windows::new(drafts, 2);
        let thirds = Windows::new(drafts, 4);
        let mut values = Vec::new();
        let step = (0..n)
            .map(|channel| {
                values.clear();
                steps.each(|window| values.push((window[n + channel] - window[channel]).abs()));
                median(&mut values).unwrap_or(0.0)
            })
            .collect();
        // 1.4826 makes a median of deviations a standard deviation; 20 is the sum of the squared coefficients.
        let noise = (0..n)
            .map(|channel| {
                values.clear();
                thirds.each(|x| {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|sample| x[sample * n + channel]);
                    values.push((d - 3.0 * c + 3.0 * b - a).abs());
                });
                if values.len() < 50 { 0.0 } else { 1.4826 * median(&mut values).unwrap_or(0.0) / 20f64.sqrt() }
            })
            .collect();
        Self { low, high, step, noise }
    }

    pub(crate) fn spread(&self, channel: usize) -> f64 {
        self.high[channel] - self.low[channel]
    }

    /// How many samples at the start and at the end of an episode only repeat the first or last, 0 if fewer than [`STILL`].
    pub(crate) fn still(&self, draft: &Draft) -> (usize, usize) {
        let n = self.low.len();
        let near = |sample: &[f64], end: &[f64]| {
            (0..n).all(|channel| {
                // Noise as large as the movement itself is no stand-still.
                let noise = (4.0 * self.noise[channel]).min(0.1 * self.spread(channel));
                let bound = noise.max(1e-6 * self.spread(channel));
                (sample[channel] - end[channel]).abs() <= bound
            })
        };
        let count = |samples: &mut dyn Iterator<Item = &[f64]>| {
            let Some(end) = samples.next() else { return 0 };
            let still = samples.take_while(|sample| near(sample, end)).count();
            if still < STILL { 0 } else { still }
        };
        let start = count(&mut draft.positions.chunks_exact(n.max(1)));
        let end = count(&mut draft.positions.chunks_exact(n.max(1)).rev());
        if start + end < draft.len() { (start, end) } else { (0, end) }
    }
}

/// Consecutive samples of all episodes, not more than [`MOST_VALUES`] of them.
pub(crate) struct Windows<'a> {
    drafts: &'a Drafts,
    samples: usize,
    stride: usize,
}

impl<'a> Windows<'a> {
    pub(crate) fn new(drafts: &'a Drafts, samples: usize) -> Self {
        let all: usize = drafts.episodes.iter().map(|draft| (draft.len() + 1).saturating_sub(samples)).sum();
        Self { drafts, samples, stride: all.div_ceil(MOST_VALUES).max(1) }
    }

    /// Calls `visit` with `samples` samples one after another.
    pub(crate) fn each(&self, mut visit: impl FnMut(&[f64])) {
        self.each_at(|draft, sample, n| visit(&draft.positions[sample * n..(sample + self.samples) * n]));
    }

    /// Calls `visit` with the episode, the first sample and n.
    pub(crate) fn each_at(&self, mut visit: impl FnMut(&Draft, usize, usize)) {
        let n = self.drafts.channels.len();
        let mut skip = 0;
        for draft in &self.drafts.episodes {
            let windows = (draft.len() + 1).saturating_sub(self.samples);
            let mut sample = skip;
            while sample < windows {
                visit(draft, sample, n);
                sample += self.stride;
            }
            skip = sample - windows;
        }
    }
}

/// The upper median; none of nothing.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
