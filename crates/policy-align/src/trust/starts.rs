//! Movements that begin slower than the policy: from rest.

use gp::Rows;
use motion::Policy;
use prepare::numbers::percent;

use crate::along::{Along, along};
use crate::{Finding, Verdict};

/// One in so many samples of a movement is its beginning.
const BEGINNING: usize = 10;
/// Least share of the speed that beginnings lack, beyond what the rest lacks, and its t over movements.
const MISSING: f64 = 0.1;
const LEAST_T: f64 = 4.0;
/// Share from which the policy is doubtful: with less its error was below a tenth.
const MUCH: f64 = 0.4;
/// Fewer movements determine no t.
const FEW: usize = 5;

/// Σ (nᵀπ̂ − r) nᵀπ̂ and Σ (nᵀπ̂)² of samples.
#[derive(Debug, Clone, Copy, Default)]
struct Lack {
    missing: f64,
    wanted: f64,
}

impl Lack {
    fn share(self) -> Option<f64> {
        (self.wanted > 0.0).then(|| self.missing / self.wanted)
    }
}

/// Says that movements are slower than nᵀπ in their first tenth, but not afterwards: a hand or robot that accelerates from rest obeys no
/// policy of the state alone.
pub(crate) fn slow_starts(policy: &dyn Policy, rows: &Rows) -> Option<Finding> {
    let (missing, t) = missing_at_starts(policy, rows)?;
    (missing > MISSING && t > LEAST_T).then(|| Finding {
        verdict: if missing > MUCH { Verdict::Doubtful } else { Verdict::Good },
        what: format!(
            "movements begin too slowly for the policy, by {} in their first tenth: from rest?",
            percent(missing.min(1.0))
        ),
        next: "begin to record when the hand has its speed, or cut the beginnings off".to_owned(),
    })
}

/// The mean over movements of what their beginning lacks beyond the rest, as a share of the speed, and its t.
fn missing_at_starts(policy: &dyn Policy, rows: &Rows) -> Option<(f64, f64)> {
    let movements = rows.indices().iter().map(|index| index.trajectory).max()? + 1;
    let mut lasts = vec![0; movements];
    rows.indices().iter().for_each(|index| lasts[index.trajectory] = index.sample.max(lasts[index.trajectory]));
    let mut lacks = vec![[Lack::default(); 2]; movements];
    for Along { trajectory, sample, speed, wanted, .. } in along(policy, rows) {
        let later = usize::from(sample * BEGINNING > lasts[trajectory]);
        let lack = &mut lacks[trajectory][later];
        lack.missing += (wanted - speed) * wanted;
        lack.wanted += wanted * wanted;
    }
    let differences: Vec<f64> =
        lacks.iter().filter_map(|[first, later]| Some(first.share()? - later.share()?)).collect();
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|own| (own - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (differences.len() >= FEW).then(|| (mean, mean / (variance / count).sqrt()))
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
    use proptest::prelude::*;

    use super::*;

    /// π(x) = −x.
    struct Bowl;

    impl Policy for Bowl {
        fn dim(&self) -> usize {
            2
        }

        fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
            action.copy_from(&-state);
        }
    }

    proptest! {
        /// Movements that accelerate from rest lack at their beginning what they lack; those at a constant share of the speed, with noise,
        /// nothing.
        #[test]
        fn what_a_beginning_lacks_is_found(
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
            let (missing, _) = missing_at_starts(&Bowl, &rows).unwrap();
            prop_assert!((missing - share * ramp).abs() < 0.02, "{missing}");
            prop_assert_eq!(slow_starts(&Bowl, &rows).is_some(), missing > MISSING);
        }
    }
}
