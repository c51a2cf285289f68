//! Goals that differ from one movement to the next.

use nalgebra::{DMatrix, DVector};
use prepare::numbers::percent;
use prepare::{Prepared, end_places};

use super::numbers::TrustNumbers;
use crate::Finding;
use crate::along::MotionSample;

/// Least share of the policy's residuals that a constant velocity of each movement must explain.
const OWN: f64 = 0.35;
/// A smaller held-out error has other causes: limits, friction and varying gains.
const UNPREDICTED: f64 = 0.1;
/// Ridge of the estimate of that velocity, as a share of the number of its rows.
const RIDGE: f64 = 0.05;
const NEXT: &str = "if the goal, an object or a load differs, record it and name its columns with --context, or learn each goal from its own movements";

/// A finding on how movements differ if the policy does not predict them. There is none if the policy predicts them, however many goals
/// there are.
pub(crate) fn differing_goals(
    movements: &[Vec<MotionSample>],
    prepared: &Prepared,
    numbers: &TrustNumbers,
) -> Option<Finding> {
    // Noise is a sufficient explanation.
    if predicts(numbers) || prepared.noise.is_noisy() {
        return None;
    }
    let places = end_places(&prepared.demonstrations).filter(|&places| places > 1);
    let what = match (places, own_share(movements)) {
        (Some(places), _) => format!("movements are not predicted well and end at {places} places"),
        (None, Some(share)) if share > OWN && numbers.held_out_error > UNPREDICTED => format!(
            "something that is constant in a movement and differs between them explains {} of the error",
            percent(share)
        ),
        _ => return None,
    };
    Some(Finding::doubt(what, NEXT))
}

/// Direction n of a velocity, and r − nᵀπ̂.
type Row = (DVector<f64>, f64);

fn predicts(numbers: &TrustNumbers) -> bool {
    numbers.held_out_error <= TrustNumbers::GOOD_HELD_OUT_ERROR
        && numbers.expected_error <= TrustNumbers::GOOD_EXPECTED_ERROR
        && numbers.halves.zip(numbers.good_halves()).is_none_or(|(halves, good)| halves <= good)
}

/// Share of Σ(r − nᵀπ̂)² that nᵀc explains with one c (n) per movement, estimated from every other quarter of it.
fn own_share(movements: &[Vec<MotionSample>]) -> Option<f64> {
    let row = |sample: &MotionSample| (sample.direction.clone(), sample.speed - sample.predicted);
    let errors: Vec<Vec<Row>> = movements.iter().map(|samples| samples.iter().map(row).collect()).collect();
    let all = errors.iter().flatten().map(|(_, error)| error * error).sum::<f64>();
    let left = |errors: &Vec<Row>| {
        let (odd, even) = quarters(errors);
        left_by(&odd, &even) + left_by(&even, &odd)
    };
    (all > 0.0).then(|| 1.0 - errors.iter().map(left).sum::<f64>() / all)
}

/// The first and third quarter of the rows, and the others.
fn quarters(rows: &[Row]) -> (Vec<Row>, Vec<Row>) {
    let quarter = rows.len().div_ceil(4).max(1);
    let every_other_from = |part: usize| rows.chunks(quarter).skip(part).step_by(2).flatten().cloned().collect();
    (every_other_from(0), every_other_from(1))
}

/// Σ(e − nᵀc)² over the rows, with the ridge estimate c from `others`.
fn left_by(rows: &[Row], others: &[Row]) -> f64 {
    let Some(dim) = rows.first().map(|(n, _)| n.len()) else { return 0.0 };
    let mut matrix = DMatrix::identity(dim, dim) * (RIDGE * others.len().max(1) as f64);
    let mut vector = DVector::zeros(dim);
    for (n, error) in others {
        matrix.ger(1.0, n, n, 1.0);
        vector.axpy(*error, n, 1.0);
    }
    let own = matrix.cholesky().map_or_else(|| DVector::zeros(dim), |factor| factor.solve(&vector));
    rows.iter().map(|(n, error)| (error - n.dot(&own)).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use motion::{Policy, SampleIndex};
    use nalgebra::{DVectorView, DVectorViewMut};
    use proptest::prelude::*;

    use super::*;
    use crate::along::along_movements;

    /// π = 0.
    struct Nothing;

    impl Policy for Nothing {
        fn dim(&self) -> usize {
            2
        }

        fn action_into(&self, _: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
            action.fill(0.0);
        }
    }

    proptest! {
        /// If π̂ = 0, a separate velocity of each movement explains everything; one that changes from sample to sample explains nothing.
        #[test]
        fn separate_velocities_per_movement_are_detected(seed in 0..1000u32, size in 0.1..10.0f64) {
            let rows = |every: usize| {
                let at = |axis: usize, i: usize| size * (f64::from(seed) + 1.3 * (i / every) as f64 + 1.6 * axis as f64).sin();
                let indices = (0..240).map(|i| SampleIndex { trajectory: i / 20, sample: i % 20 }).collect();
                gp::Rows::new(DMatrix::zeros(2, 240), DMatrix::from_fn(2, 240, at), indices).unwrap()
            };
            let own = own_share(&along_movements(&Nothing, &rows(20))).unwrap();
            prop_assert!(own > 0.99, "{}", own);
            let others = own_share(&along_movements(&Nothing, &rows(1))).unwrap();
            prop_assert!(others < OWN, "{}", others);
        }
    }
}
