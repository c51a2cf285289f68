//! Movements that begin more slowly than the policy, for instance from rest.

use gp::Rows;
use motion::mean_and_error;
use prepare::numbers::percent_of_all;

use crate::along::{FEW, LEAST_T, MotionSample};
use crate::{Finding, Verdict};

/// The beginning of a movement is one in this many samples.
const BEGINNING: usize = 10;
/// Least share of the speed missing at the beginning, in addition to that missing later.
const MISSING: f64 = 0.1;
/// Share above which the policy is doubtful; below it, its error was below a tenth.
const MUCH: f64 = 0.4;

/// Σ (nᵀπ̂ − r) nᵀπ̂ and Σ (nᵀπ̂)² over samples.
#[derive(Debug, Clone, Copy, Default)]
struct Lack {
    missing: f64,
    predicted: f64,
}

impl Lack {
    fn share(self) -> Option<f64> {
        (self.predicted > 0.0).then(|| self.missing / self.predicted)
    }
}

/// A finding if movements are slower than nᵀπ in their first tenth, but not afterwards. A hand or robot that accelerates from rest does
/// not follow a policy of the state alone.
pub(crate) fn slow_starts(movements: &[Vec<MotionSample>], rows: &Rows) -> Option<Finding> {
    let (missing, t) = missing_at_starts(movements, rows)?;
    (missing > MISSING && t > LEAST_T).then(|| {
        Finding::new(
            if missing > MUCH { Verdict::Doubtful } else { Verdict::Good },
            format!(
                "movements begin too slowly for the policy, by {} in their first tenth: from rest?",
                percent_of_all(missing)
            ),
            "begin to record when the hand has its speed, or cut the beginnings off (--trim-still)",
        )
    })
}

/// The share of speed missing at the beginning minus that missing later, as a mean over movements, and its t.
fn missing_at_starts(movements: &[Vec<MotionSample>], rows: &Rows) -> Option<(f64, f64)> {
    let mut lasts = vec![0; movements.len()];
    rows.indices().iter().for_each(|index| lasts[index.trajectory] = index.sample.max(lasts[index.trajectory]));
    let difference = |(samples, last): (&Vec<MotionSample>, usize)| {
        let mut lacks = [Lack::default(); 2];
        for &MotionSample { index, speed, predicted, .. } in samples {
            let lack = &mut lacks[usize::from(index.sample * BEGINNING > last)];
            lack.missing += (predicted - speed) * predicted;
            lack.predicted += predicted * predicted;
        }
        let [first, later] = lacks;
        Some(first.share()? - later.share()?)
    };
    let differences: Vec<f64> = movements.iter().zip(lasts).filter_map(difference).collect();
    let (mean, error) = mean_and_error(&differences);
    (differences.len() >= FEW).then(|| (mean, mean / error))
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;
    use crate::along::{Bowl, along_movements};

    proptest! {
        /// Movements that accelerate from rest lack the expected share at the beginning. Those at a constant share of the speed, with
        /// noise, lack nothing.
        #[test]
        fn slow_starts_are_found(
            starts in prop::collection::vec(prop::array::uniform2(0.5..2.0f64), 5..12), ramp in 0.0..1.0f64, share in 0.5..1.5f64,
        ) {
            let (mut states, mut velocities, mut indices) = (vec![], vec![], vec![]);
            for (trajectory, start) in starts.iter().enumerate() {
                for sample in 0..50 {
                    let x = DVector::from_column_slice(start) * (1.0 - 0.01 * sample as f64);
                    let noise = 1.0 + 0.01 * ((trajectory * 31 + sample * 17) as f64).sin();
                    let slow = if sample < 5 { 1.0 - ramp } else { 1.0 };
                    velocities.push(&x * (-share * slow * noise));
                    states.push(x);
                    indices.push(SampleIndex { trajectory, sample });
                }
            }
            let rows = Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap();
            let movements = along_movements(&Bowl, &rows);
            let (missing, _) = missing_at_starts(&movements, &rows).unwrap();
            prop_assert!((missing - share * ramp).abs() < 0.02, "{missing}");
            prop_assert_eq!(slow_starts(&movements, &rows).is_some(), missing > MISSING);
        }
    }
}
