//! Rows of further trajectories, whose samples are not in memory.

use std::sync::Arc;

use motion::SampleIndex;
use nalgebra::DMatrix;

use crate::{GpError, Rows};

/// Rows of further trajectories, and the counts of their origin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Further {
    rows: Arc<Rows>,
    /// Number of samples of those trajectories.
    samples: usize,
    /// Number of rows that were thinned.
    thinned: usize,
}

impl Rows {
    /// Adds rows of further trajectories, in the units of these: reduced rows of recordings too large for memory, such as their
    /// [means](Rows::averaged) or [some of them](Rows::at_most). They are learnt from like all others, but no stretches are found in them.
    /// Their trajectories count from 0 and follow those of these rows. `samples` is the number of samples they were made of, `thinned` the
    /// number of rows that were dropped.
    ///
    /// # Errors
    /// [`GpError::Lengths`] if dimensions differ, or only one has variances. Momenta and task spaces cannot be combined with further rows.
    pub fn with_further(self, further: Rows, samples: usize, thinned: usize) -> Result<Self, GpError> {
        let same = |what, found, expected| {
            if found == expected { Ok(()) } else { Err(GpError::Lengths { what, found, expected }) }
        };
        same("dimensions of further rows", further.states.nrows(), self.states.nrows())?;
        same("dimensions of further velocities", further.dim(), self.dim())?;
        let variances = |of: &Rows| of.variances.as_ref().map_or(0, |_| of.len());
        let expected = if self.variances.is_some() { further.len() } else { 0 };
        same("variances of further rows", variances(&further), expected)?;
        let whole = self.momenta.is_none() && further.momenta.is_none() && self.task_spaces.is_empty();
        same("further rows with momenta or task spaces", if whole { 0 } else { further.len() }, 0)?;
        same("samples of further rows", samples, samples.max(further.len() + thinned))?;
        let first = self.indices.iter().map(|index| index.trajectory + 1).max().unwrap_or(0);
        let following = |index: SampleIndex| SampleIndex { trajectory: first + index.trajectory, ..index };
        let indices = further.indices.iter().copied().map(following).collect();
        let rows = Arc::new(Rows { indices, ..further });
        Ok(Rows { further: Some(Further { rows, samples, thinned }), ..self })
    }

    /// Number of samples of these rows, including those of further rows.
    pub(crate) fn recorded(&self) -> usize {
        self.len() + self.further.as_ref().map_or(0, |further| further.samples)
    }

    /// Number of further rows that were thinned.
    pub(crate) fn thinned_before(&self) -> usize {
        self.further.as_ref().map_or(0, |further| further.thinned)
    }
}

impl Further {
    /// The rows whose sample is not held out.
    pub(crate) fn without(&self, held_out: &dyn Fn(usize, usize) -> bool) -> Further {
        Further { rows: Arc::new(self.rows.without(held_out)), ..self.clone() }
    }

    /// `rows`, followed by these.
    pub(crate) fn after(&self, rows: &Rows) -> Rows {
        let beside = |a: &DMatrix<f64>, b: &DMatrix<f64>| {
            DMatrix::from_vec(a.nrows(), a.ncols() + b.ncols(), [a.as_slice(), b.as_slice()].concat())
        };
        let more = &*self.rows;
        // A property that only one part has is dropped for all rows.
        let both = rows.variances.as_ref().zip(more.variances.as_ref());
        Rows {
            states: beside(&rows.states, &more.states),
            velocities: beside(&rows.velocities, &more.velocities),
            variances: both.map(|(own, more)| [own.as_slice(), more.as_slice()].concat()),
            indices: [rows.indices.as_slice(), more.indices.as_slice()].concat(),
            momenta: None,
            noise: rows.noise,
            switches: rows.switches.clone(),
            labels: None,
            means: rows.means,
            task_spaces: Vec::new(),
            further: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Rows of movements of these lengths, with or without noise of velocities.
    fn rows(lengths: &[usize], variance: Option<f64>, seed: u64) -> Rows {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let index = |(trajectory, &length): (usize, &usize)| {
            (0..length).map(move |sample| SampleIndex { trajectory, sample }).collect::<Vec<_>>()
        };
        let indices: Vec<SampleIndex> = lengths.iter().enumerate().flat_map(index).collect();
        let count = indices.len();
        let mut drawn = || DMatrix::from_fn(2, count, |_, _| rng.random_range(0.5..1.0));
        let rows = Rows::new(drawn(), drawn(), indices).expect("rows");
        match variance {
            Some(variance) => rows.with_variances(vec![variance; count]).expect("variances"),
            None => rows,
        }
    }

    /// Selected trajectories, counted from `first`.
    fn part(rows: &Rows, is_chosen: impl Fn(usize) -> bool, first: usize) -> Rows {
        let part = rows.without(|trajectory, _| !is_chosen(trajectory));
        let counted = |index: &SampleIndex| SampleIndex { trajectory: index.trajectory - first, ..*index };
        Rows { indices: part.indices.iter().map(counted).collect(), ..part }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Rows of all trajectories have the same means as rows of some with the means of the others appended.
        #[test]
        fn means_of_further_rows_are_those_of_all(
            lengths in prop::collection::vec(1usize..20, 2..8),
            own in 1usize..7,
            variance in prop::option::of(1e-4f64..0.1),
            seed in any::<u64>(),
        ) {
            let own = own.min(lengths.len() - 1);
            let all = rows(&lengths, variance, seed);
            let (mine, others) = (part(&all, |k| k < own, 0), part(&all, |k| k >= own, own));
            let means = others.averaged().into_owned();
            let samples = others.len();
            let both = mine.with_further(means, samples, 0).expect("of the same kind");
            let (found, literal) = (both.averaged(), all.averaged());
            prop_assert_eq!(&found.states, &literal.states);
            prop_assert_eq!(&found.velocities, &literal.velocities);
            prop_assert_eq!(&found.variances, &literal.variances);
            prop_assert_eq!(&found.indices, &literal.indices);
            prop_assert_eq!(both.recorded(), all.len());
            // Held-out trajectories are removed from both.
            let gone = seed as usize % lengths.len();
            let (found, literal) = (both.without(|k, _| k == gone), all.without(|k, _| k == gone));
            prop_assert_eq!(&found.averaged().states, &literal.averaged().states);
        }

        /// Incompatible rows are refused.
        #[test]
        fn other_dimensions_and_noise_are_refused(variance in 1e-4f64..0.1, samples in 0usize..12) {
            let (noisy, certain) = (rows(&[5, 6], Some(variance), 1), rows(&[5, 6], None, 1));
            prop_assert!(noisy.clone().with_further(certain.clone(), 11, 0).is_err());
            prop_assert!(certain.clone().with_further(noisy.clone(), 11, 0).is_err());
            prop_assert_eq!(noisy.clone().with_further(noisy.clone(), samples, 0).is_ok(), samples >= 11);
            let other = certain.clone().with_context(&DMatrix::zeros(1, 11)).expect("a context");
            prop_assert!(certain.with_further(other, 11, 0).is_err());
        }
    }
}
