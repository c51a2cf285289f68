use crate::SampleIndex;

/// A set of samples; a look-up costs O(log size).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SampleSet {
    /// Ascending.
    samples: Vec<SampleIndex>,
}

impl SampleSet {
    /// The set of these samples, which may be in any order and repeated.
    pub fn of(samples: &[SampleIndex]) -> Self {
        let mut samples = samples.to_vec();
        samples.sort_unstable();
        SampleSet { samples }
    }

    /// Whether the set contains a sample.
    pub fn contains(&self, sample: SampleIndex) -> bool {
        self.samples.binary_search(&sample).is_ok()
    }
}
