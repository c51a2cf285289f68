//! Noise of velocities in the search for constraints.

use nalgebra::{DMatrix, DVector};

use crate::Rows;
use crate::rows::task_space::TaskSpace;
use crate::stretches::noise::{sharing, velocity_noise};

/// The least of the upper bounds (S20) in all spaces; increased if samples share their errors.
pub(super) fn noise(rows: &Rows, movements: &[&[usize]], spaces: &[TaskSpace]) -> Option<f64> {
    let in_space = |space: &TaskSpace| {
        let (basis, gain) = space.moved(rows.dim())?;
        let jacobians = space.jacobians.as_ref()?;
        let columns = jacobians.iter().zip(rows.velocities().column_iter());
        let velocities: Vec<DVector<f64>> = columns.map(|(j, u)| basis.tr_mul(&(j * u)) / gain.sqrt()).collect();
        velocity_noise(&DMatrix::from_columns(&velocities), rows.variances(), movements)
    };
    let recorded = velocity_noise(rows.velocities(), rows.variances(), movements);
    let least = recorded.into_iter().chain(spaces.iter().filter_map(in_space)).reduce(f64::min)?;
    Some(sharing(rows, movements) * least)
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;
    use crate::stretches::noise::SMOOTHED;

    proptest! {
        /// Independent noise counts once in any number of dimensions, smooth noise more.
        #[test]
        fn smooth_noise_counts_more_than_independent_noise(seed in any::<u64>(), dim in 2usize..24, smooth in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut drawn = || DMatrix::from_fn(dim, 200, |_, _| rng.sample::<f64, _>(StandardNormal));
            let (noise, slow) = (drawn(), drawn());
            let slow = |k: usize| slow.column(0) + slow.column(1) * (k as f64 / 100.0 - 1.0);
            let velocities: Vec<DVector<f64>> =
                (0..200).map(|k| if smooth { slow(k) } else { noise.column(k).into_owned() }).collect();
            let indices = (0..200).map(|sample| SampleIndex { trajectory: 0, sample }).collect();
            let rows = Rows::new(drawn(), DMatrix::from_columns(&velocities), indices).unwrap();
            let rows = rows.with_variances(vec![1.0; 200]).unwrap();
            let all: Vec<usize> = (0..200).collect();
            let found = super::noise(&rows, &[&all], &[]).unwrap();
            let expected = if smooth { SMOOTHED } else { 1.0 };
            prop_assert!((expected..1.5 * expected).contains(&found), "{found} instead of {expected}");
        }
    }
}
