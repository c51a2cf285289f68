use motion::{SampleIndex, SampleSet};
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::Aligned;

/// Some samples (x_kn, φ̂_kn + b_k) of the kept trajectories (23), in ascending order.
#[derive(Debug, Clone)]
pub struct Samples<'a> {
    aligned: &'a Aligned,
    indices: Vec<SampleIndex>,
}

impl Aligned {
    /// The samples (x_kn, φ̂_kn + b_k) of the kept trajectories (23).
    pub fn samples(&self) -> Samples<'_> {
        Samples::new(self, self.demonstrations().samples_of(self.kept()))
    }
}

impl<'a> Samples<'a> {
    pub(crate) fn new(aligned: &'a Aligned, indices: Vec<SampleIndex>) -> Self {
        Samples { aligned, indices }
    }

    /// Trajectory and sample number of each sample.
    pub fn indices(&self) -> &[SampleIndex] {
        &self.indices
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// States (n, M), one column per sample.
    pub fn states(&self) -> DMatrix<f64> {
        let mut states = DMatrix::zeros(self.aligned.demonstrations().dim(), self.len());
        states.column_iter_mut().zip(self).for_each(|(mut column, (state, _))| column.copy_from(&state));
        states
    }

    /// Aligned potentials φ̂_kn + b_k, (M), in units of the state squared per second.
    pub fn values(&self) -> DVector<f64> {
        DVector::from_iterator(self.len(), self.iter().map(|(_, value)| value))
    }

    /// State x_kn, (n), and aligned potential φ̂_kn + b_k of each sample.
    pub fn iter(&self) -> SampleIter<'a, std::iter::Copied<std::slice::Iter<'_, SampleIndex>>> {
        SampleIter { aligned: self.aligned, indices: self.indices.iter().copied() }
    }

    /// The intersection with `wanted`; other samples are ignored.
    #[must_use]
    pub fn only(&self, wanted: &[SampleIndex]) -> Self {
        let wanted = SampleSet::of(wanted);
        let chosen = self.indices.iter().copied().filter(|&index| wanted.contains(index));
        Samples::new(self.aligned, chosen.collect())
    }

    /// All samples except `held_out`; samples that are not contained are ignored.
    #[must_use]
    pub fn without(&self, held_out: &[SampleIndex]) -> Self {
        let held_out = SampleSet::of(held_out);
        let rest = self.indices.iter().copied().filter(|&index| !held_out.contains(index));
        Samples::new(self.aligned, rest.collect())
    }
}

/// Iterator over samples: the state x_kn, (n), and the aligned potential φ̂_kn + b_k of each.
#[derive(Debug, Clone)]
pub struct SampleIter<'a, I> {
    aligned: &'a Aligned,
    indices: I,
}

impl<'a, I: Iterator<Item = SampleIndex>> Iterator for SampleIter<'a, I> {
    type Item = (DVectorView<'a, f64>, f64);

    fn next(&mut self) -> Option<Self::Item> {
        self.indices.next().map(|index| self.aligned.sample(index))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.indices.size_hint()
    }
}

impl<I: ExactSizeIterator<Item = SampleIndex>> ExactSizeIterator for SampleIter<'_, I> {}

impl<'a> IntoIterator for Samples<'a> {
    type Item = (DVectorView<'a, f64>, f64);
    type IntoIter = SampleIter<'a, std::vec::IntoIter<SampleIndex>>;

    fn into_iter(self) -> Self::IntoIter {
        SampleIter { aligned: self.aligned, indices: self.indices.into_iter() }
    }
}

impl<'a, 's> IntoIterator for &'s Samples<'a> {
    type Item = (DVectorView<'a, f64>, f64);
    type IntoIter = SampleIter<'a, std::iter::Copied<std::slice::Iter<'s, SampleIndex>>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
