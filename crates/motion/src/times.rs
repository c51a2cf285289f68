use std::borrow::Cow;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::statistics::upper_median;

/// Times at which the samples of a movement were taken, in seconds.
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

    /// Seconds from sample `from` to sample `to`, which must not be before it.
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

    /// The median step, the upper of two; `None` with fewer than two samples. O(N).
    pub fn median_step(&self) -> Option<f64> {
        match self {
            Times::Even { step, len } => (*len > 1).then_some(*step),
            Times::Stamped(_) => upper_median(self.steps().collect()),
        }
    }

    /// The time of every sample, (N); starting at 0 if they are evenly spaced.
    pub fn stamps(&self) -> Cow<'_, [f64]> {
        match self {
            Times::Even { step, len } => Cow::Owned((0..*len).map(|sample| step * sample as f64).collect()),
            Times::Stamped(stamps) => Cow::Borrowed(stamps),
        }
    }

    /// The stamps (N) of unevenly spaced samples; `None` if they are evenly spaced.
    pub fn uneven(&self) -> Option<&[f64]> {
        match self {
            Times::Even { .. } => None,
            Times::Stamped(stamps) => Some(stamps),
        }
    }

    /// The time stamps, mutable.
    pub fn stamps_mut(&mut self) -> &mut Vec<f64> {
        if let Times::Even { .. } = self {
            *self = Times::Stamped(self.stamps().into_owned());
        }
        match self {
            Times::Stamped(stamps) => stamps,
            Times::Even { .. } => unreachable!("even times were made stamps above"),
        }
    }

    /// The times of a range of samples.
    #[must_use]
    pub fn part(&self, samples: Range<usize>) -> Times {
        match self {
            Times::Even { step, .. } => Times::Even { step: *step, len: samples.len() },
            Times::Stamped(stamps) => Times::Stamped(stamps[samples].to_vec()),
        }
    }

    /// The times with all seconds divided by `divisor`.
    #[must_use]
    pub fn divided_by(&self, divisor: f64) -> Times {
        match self {
            Times::Even { step, len } => Times::Even { step: step / divisor, len: *len },
            Times::Stamped(stamps) => Times::Stamped(stamps.iter().map(|time| time / divisor).collect()),
        }
    }
}

/// The unit of numeric stamps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TimeUnit {
    /// s.
    #[serde(rename = "s")]
    Seconds,
    /// ms.
    #[serde(rename = "ms")]
    Milliseconds,
    /// µs.
    #[serde(rename = "us")]
    Microseconds,
    /// ns.
    #[serde(rename = "ns")]
    Nanoseconds,
}

impl TimeUnit {
    /// All units, the longest first.
    pub const ALL: [TimeUnit; 4] =
        [TimeUnit::Seconds, TimeUnit::Milliseconds, TimeUnit::Microseconds, TimeUnit::Nanoseconds];

    /// Number of these in a second.
    pub const fn per_second(self) -> f64 {
        match self {
            TimeUnit::Seconds => 1.0,
            TimeUnit::Milliseconds => 1e3,
            TimeUnit::Microseconds => 1e6,
            TimeUnit::Nanoseconds => 1e9,
        }
    }

    /// The symbol in ASCII: "us".
    pub const fn symbol(self) -> &'static str {
        self.words()[0]
    }

    /// The name in the plural: "microseconds".
    pub const fn name(self) -> &'static str {
        self.words()[1]
    }

    /// The unit with this symbol, name or abbreviation.
    pub fn of(word: &str) -> Option<TimeUnit> {
        TimeUnit::ALL.into_iter().find(|unit| unit.words().contains(&word))
    }

    /// The symbol, the name, and abbreviations in names of columns.
    const fn words(self) -> &'static [&'static str] {
        match self {
            TimeUnit::Seconds => &["s", "seconds", "sec", "secs"],
            TimeUnit::Milliseconds => &["ms", "milliseconds", "msec", "millis"],
            TimeUnit::Microseconds => &["us", "microseconds", "usec", "micros", "µs"],
            TimeUnit::Nanoseconds => &["ns", "nanoseconds", "nsec", "nanos"],
        }
    }
}

/// Collects time stamps.
impl FromIterator<f64> for Times {
    fn from_iter<I: IntoIterator<Item = f64>>(stamps: I) -> Self {
        Times::Stamped(stamps.into_iter().collect())
    }
}

/// A step within this relative distance of a whole one is replaced by it.
const WHOLE: f64 = 1e-3;

/// A measured time step in seconds without the rounding error of its stamps: 1/k s or k ms, whichever is nearer, if it is
/// within 0.1 % of the step.
pub fn whole_step(step: f64) -> f64 {
    let near = |candidate: f64| (candidate > 0.0 && (candidate / step - 1.0).abs() < WHOLE).then_some(candidate);
    let rate = near(1.0 / (1.0 / step).round()).filter(|step| step.is_finite());
    let milliseconds = near((step * 1000.0).round() / 1000.0);
    let off = |candidate: &f64| (candidate - step).abs();
    let nearest = [rate, milliseconds].into_iter().flatten().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.unwrap_or(step)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde::de::value::{self, StrDeserializer};

    use super::*;

    proptest! {
        #[test]
        fn whole_step_is_whole_and_nearest(count in 1u16..2000, of_rate in any::<bool>(), off in -0.9e-3..0.9e-3_f64) {
            let count = f64::from(count);
            let step = (if of_rate { 1.0 / count } else { count / 1000.0 }) * (1.0 + off);
            let found = whole_step(step);
            let distance = |to: f64| (to - step).abs();
            prop_assert!(distance(found) <= distance(step / (1.0 + off)));
            prop_assert!(found == 1.0 / (1.0 / found).round() || found == (found * 1000.0).round() / 1000.0);
        }
    }

    #[test]
    fn time_units_are_stored_as_their_symbols() {
        for unit in TimeUnit::ALL {
            let stored = StrDeserializer::<value::Error>::new(unit.symbol());
            assert_eq!(TimeUnit::deserialize(stored), Ok(unit));
        }
    }

    #[test]
    fn the_nearer_of_two_whole_steps_is_used() {
        assert_eq!(whole_step(0.142_95), 0.143);
        assert_eq!(whole_step(0.142_87), 1.0 / 7.0);
        assert_eq!(whole_step(0.017_01), 0.017);
        assert_eq!(whole_step(0.017_1), 0.017_1);
        assert_eq!(whole_step(0.0), 0.0);
    }
}
