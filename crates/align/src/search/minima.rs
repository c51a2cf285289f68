use lanes::{LANES, Lanes, groups_of};

/// The nearest samples found so far. Indices are stored as f64, which is exact, so that they are
/// compared and blended like the distances.
#[derive(Debug, Default)]
pub(crate) struct Minima {
    /// Squared distances, padded with infinity.
    pub(crate) distances: Vec<Lanes>,
    /// Sample indices, as integers in f64.
    pub(crate) samples: Vec<Lanes>,
}

impl Minima {
    /// Resets everything, and makes room for `count` samples.
    pub(crate) fn reset(&mut self, count: usize) {
        self.distances.clear();
        self.distances.resize(groups_of(count), [f64::INFINITY; LANES]);
        self.samples.clear();
        self.samples.resize(groups_of(count), [0.0; LANES]);
    }
}
