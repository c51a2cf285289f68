use nalgebra::DVector;

use super::laplacian::{Elimination, of_group};
use super::linear_term::linear_term;
use super::responsibilities::Responsibilities;
use crate::{AlignError, AlignmentObjective};

/// The first solution is accurate to 1e-16 / λ₂; the second corrects the remainder.
const ROUNDS: usize = 2;

/// The offsets b = −H⁺a (17) of a group of trajectories, in the order of the group and with sum 0, from the mutual
/// weights of its members.
///
/// After each solution, the right-hand side a is computed again from the shifted values f + b. The remainder is small
/// there, and so is its rounding error.
pub(crate) fn group_offsets(
    responsibilities: &Responsibilities,
    objective: &AlignmentObjective,
    group: &[usize],
) -> Result<DVector<f64>, AlignError> {
    let elimination = Elimination::new(&of_group(&objective.laplacian, group));
    let mut offsets = vec![None; objective.linear.len()];
    for &k in group {
        offsets[k] = Some(0.0);
    }
    for round in 0..ROUNDS {
        let known = round == 0 && group.len() == offsets.len();
        let linear =
            if known { objective.linear.as_slice().to_vec() } else { linear_term(responsibilities, &offsets).0 };
        let left: Vec<f64> = group.iter().map(|&k| -linear[k]).collect();
        for (&k, step) in group.iter().zip(elimination.solve(&left)) {
            offsets[k] = offsets[k].map(|offset| offset + step);
        }
    }
    let finite =
        |&k: &usize| offsets[k].filter(|offset| offset.is_finite()).ok_or(AlignError::OffsetOverflow { trajectory: k });
    group.iter().map(finite).collect::<Result<Vec<f64>, _>>().map(DVector::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::offsets::bipartition::bipartition;
    use crate::offsets::responsibilities::squared_radius;
    use crate::search::SearchSpace;
    use motion::Demonstrations;
    use nalgebra::DMatrix;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// Trajectories of 2 to 9 samples in two dimensions, with arbitrary values of the potential.
    fn movements() -> impl Strategy<Value = (Vec<DMatrix<f64>>, Vec<Vec<f64>>)> {
        let movement = (2usize..10).prop_flat_map(|n| {
            (vec(-1.0..1.0, 2 * n).prop_map(move |x| DMatrix::from_vec(2, n, x)), vec(-5.0..5.0, n))
        });
        vec(movement, 1..8).prop_map(|movements| movements.into_iter().unzip())
    }

    /// The kept group, its offsets and λ₂.
    fn level(
        positions: &[DMatrix<f64>],
        potentials: &[Vec<f64>],
        sigma_squared: f64,
    ) -> (Vec<usize>, DVector<f64>, f64) {
        let demonstrations = Demonstrations::from_states(positions.to_vec(), 1.0).unwrap();
        let nearest =
            SearchSpace::new(&demonstrations).nearest(squared_radius(sigma_squared, 1e-20), u64::MAX).unwrap();
        let responsibilities = Responsibilities::new(&nearest, potentials, sigma_squared);
        let objective = AlignmentObjective::new(&responsibilities);
        let partition = bipartition(&objective.laplacian, &vec![1.0; potentials.len()], 1e-8).unwrap();
        let offsets = group_offsets(&responsibilities, &objective, &partition.groups[0]).unwrap();
        (partition.groups[0].clone(), offsets, partition.lambda_2.unwrap_or(1.0))
    }

    proptest! {
        #[test]
        fn raising_a_potential_lowers_its_offset(
            (positions, potentials) in movements(), raises in vec(-100.0_f64..100.0, 8), exponent in -3.0_f64..0.0,
        ) {
            let sigma_squared = 10.0_f64.powf(exponent);
            let (group, offsets, _) = level(&positions, &potentials, sigma_squared);
            let raised: Vec<Vec<f64>> =
                potentials.iter().zip(&raises).map(|(p, raise)| p.iter().map(|value| value + raise).collect()).collect();
            let (same_group, lowered, _) = level(&positions, &raised, sigma_squared);
            prop_assert_eq!(&group, &same_group);
            let mean = group.iter().map(|&k| raises[k]).sum::<f64>() / group.len() as f64;
            for (at, &k) in group.iter().enumerate() {
                let expected = offsets[at] - (raises[k] - mean);
                // Adding 100 changes the potentials themselves by 1e-14, and weak links amplify that at most 1e8-fold.
                prop_assert!((lowered[at] - expected).abs() < 1e-10, "{} {expected}", lowered[at]);
            }
        }

        #[test]
        fn weak_links_lose_no_digits(distance in 5.9..6.05, value in -1.0_f64..1.0) {
            // Two pairs, each at one place, joined only by the weight exp(−d²/2) ≈ 1e-8 between the values at their
            // ends. Whatever the strong links contribute, the step between the pairs is determined by the ends.
            let at = |x: f64| DMatrix::from_row_slice(1, 2, &[x, x]);
            let positions = [at(0.0), at(0.0), at(distance), at(distance)];
            let potentials = [vec![0.0, 0.0], vec![value; 2], vec![3.0; 2], vec![1000.0 * value; 2]];
            let (group, offsets, lambda_2) = level(&positions, &potentials, 1.0);
            prop_assert_eq!(group.len(), 4);
            prop_assert!(lambda_2 < 1e-6);
            let levels: Vec<f64> = (0..4).map(|k| potentials[k][0] + offsets[k]).collect();
            prop_assert!(levels.iter().all(|level| (level - levels[0]).abs() < 1e-11), "{levels:?}");
        }
    }
}
