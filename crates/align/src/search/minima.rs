use lanes::{LANES, Lanes, groups_of};

/// The nearest samples found so far; indices are exact in f64, and compare and blend like the distances.
#[derive(Debug, Default)]
pub(crate) struct Minima {
    /// Squared distances, filled up with infinity.
    pub(crate) distances: Vec<Lanes>,
    /// Whole numbers.
    pub(crate) samples: Vec<Lanes>,
}

impl Minima {
    /// Forgets all, and makes room for so many samples.
    pub(crate) fn reset(&mut self, count: usize) {
        self.distances.clear();
        self.distances.resize(groups_of(count), [f64::INFINITY; LANES]);
        self.samples.clear();
        self.samples.resize(groups_of(count), [0.0; LANES]);
    }
}
