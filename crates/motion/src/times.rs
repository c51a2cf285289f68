use std::borrow::Cow;
use std::ops::Range;

use crate::median::upper_median;

/// When the samples of a movement were taken, in seconds.
#[derive(Debug, Clone, PartialEq)]
pub enum Times {
    /// Evenly spaced.
    Even {
        /// Seconds between two samples.
        step: f64,
        /// Number of samples N.
        len: usize,
    },
    /// A time stamp for every sample, (N).
    Stamped(Vec<f64>),
}

impl Times {
    /// Number of samples N.
    pub fn len(&self) -> usize {
        match self {
            Times::Even { len, .. } => *len,
            Times::Stamped(stamps) => stamps.len(),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Seconds from sample `from` to sample `to`, which is not before it.
    pub fn seconds(&self, from: usize, to: usize) -> f64 {
        match self {
            Times::Even { step, .. } => step * (to - from) as f64,
            Times::Stamped(stamps) => stamps[to] - stamps[from],
        }
    }

    /// Seconds from the first sample to the last; 0 without samples.
    pub fn duration(&self) -> f64 {
        self.len().checked_sub(1).map_or(0.0, |last| self.seconds(0, last))
    }

    /// Seconds of every step, N − 1 of them.
    pub fn steps(&self) -> impl Iterator<Item = f64> {
        (1..self.len()).map(|sample| self.seconds(sample - 1, sample))
    }

    /// The median step, the upper of two; none with fewer than two samples. O(N).
    pub fn median_step(&self) -> Option<f64> {
        match self {
            Times::Even { step, len } => (*len > 1).then_some(*step),
            Times::Stamped(_) => upper_median(self.steps().collect()),
        }
    }

    /// The time of every sample, (N); from 0 where they are evenly spaced.
    pub fn stamps(&self) -> Cow<'_, [f64]> {
        match self {
            Times::Even { step, len } => Cow::Owned((0..*len).map(|sample| step * sample as f64).collect()),
            Times::Stamped(stamps) => Cow::Borrowed(stamps),
        }
    }

    /// The time stamps, to be changed.
    pub fn stamps_mut(&mut self) -> &mut Vec<f64> {
        if let Times::Even { .. } = self {
            *self = Times::Stamped(self.stamps().into_owned());
        }
        match self {
            Times::Stamped(stamps) => stamps,
            Times::Even { .. } => unreachable!("even times were made stamps above"),
        }
    }

    /// Those of some samples in a row.
    #[must_use]
    pub fn part(&self, samples: Range<usize>) -> Times {
        match self {
            Times::Even { step, .. } => Times::Even { step: *step, len: samples.len() },
            Times::Stamped(stamps) => Times::Stamped(stamps[samples].to_vec()),
        }
    }

    /// With all seconds divided by `divisor`.
    #[must_use]
    pub fn divided_by(&self, divisor: f64) -> Times {
        match self {
            Times::Even { step, len } => Times::Even { step: step / divisor, len: *len },
            Times::Stamped(stamps) => Times::Stamped(stamps.iter().map(|time| time / divisor).collect()),
        }
    }
}

/// Time stamps, one after another.
impl FromIterator<f64> for Times {
    fn from_iter<I: IntoIterator<Item = f64>>(stamps: I) -> Self {
        Times::Stamped(stamps.into_iter().collect())
    }
}
