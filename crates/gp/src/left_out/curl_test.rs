//! Tests whether there is a potential (S12), (R5).

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::left_out::LeftOutPredictions;
use crate::left_out::comparison::{DIFFERS, LEAST_T, difference, t_of_mean};

/// Whether a model with rotation is tried in addition to those with a potential.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CurlTest {
    /// A Helmholtz decomposition is also fitted, and used if it predicts held-out trajectories better (R5).
    #[default]
    Fit,
    /// The policy is assumed to have a potential.
    AssumePotential,
}

/// A model without a potential is rejected if its held-out error is more than this factor times the potential's.
const BETTER: f64 = 1.1;

/// Policies at the rows, (n, M), and predictions of left-out trajectories.
#[derive(Debug)]
pub(crate) struct Contender<'a> {
    pub(crate) actions: &'a DMatrix<f64>,
    pub(crate) left_out: &'a LeftOutPredictions,
}

/// (S12): t of the gain per trajectory, gain_T = Σ w (e² with a potential − e² without), w = 1/D.
pub(crate) fn curl_t(
    potential: &LeftOutPredictions,
    rotation: &LeftOutPredictions,
    noise_weights: &[f64],
    groups: &[Vec<usize>],
) -> f64 {
    let gain = |row: usize| {
        let square = |left_out: &LeftOutPredictions| left_out.residuals.row(row).norm_squared();
        (square(potential) - square(rotation)) / noise_weights[row]
    };
    let gains: Vec<f64> = groups.iter().map(|rows| rows.iter().map(|&row| gain(row)).sum()).collect();
    t_of_mean(&gains)
}

/// Minimum change of the policy by rotation, as a share of the potential's held-out error, for t to count.
const NOTICEABLE: f64 = 0.05;
/// Minimum held-out error of a potential, as a share, for prediction alone to reject it.
const UNPREDICTED: f64 = 1e-3;
/// Maximum share of that error that the model with rotation may then have.
const DECISIVE: f64 = 1e-3;

/// Whether the model with rotation is selected. Either (S12) detects rotation, and it is large enough not to be
/// explained by the unpredicted part. Or the rotation leaves almost no error where the potential does not predict,
/// whatever t is, because one movement with a large gain can make t small. Or, by (R5), dropping the potential changes
/// the policy and costs less than a tenth in prediction.
pub(crate) fn takes_rotation(t: f64, potential: &Contender<'_>, rotation: &Contender<'_>) -> bool {
    let (r2_potential, r2_rotation) = (potential.left_out.r_squared, rotation.left_out.r_squared);
    let (left_by_potential, left_by_rotation) = (1.0 - r2_potential, 1.0 - r2_rotation);
    let differ_by = difference(potential.actions, rotation.actions);
    let seen = t > LEAST_T && r2_rotation > r2_potential && differ_by > NOTICEABLE * left_by_potential;
    let decisive = left_by_potential > UNPREDICTED && left_by_rotation < DECISIVE * left_by_potential;
    let changes = differ_by > DIFFERS;
    let costs_little = left_by_rotation <= BETTER * left_by_potential;
    let hides_less = rotation.actions.norm_squared() <= potential.actions.norm_squared();
    seen || decisive || (changes && costs_little && hides_less)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_out(r_squared: f64) -> LeftOutPredictions {
        LeftOutPredictions { residuals: DMatrix::zeros(1, 1), variances: vec![1.0], r_squared, z_squared: 1.0 }
    }

    /// The other model's actions, which differ from the first's not at all, by 4.5 %, or completely.
    const SAME: [f64; 3] = [1.0, 2.0, 3.0];
    const ALIKE: [f64; 3] = [1.0, 2.0, 2.7];
    const OTHER: [f64; 3] = [3.0, 2.0, 1.0];

    fn taken(t: f64, [potential, rotation]: [f64; 2], others: [f64; 3]) -> bool {
        let actions = DMatrix::from_column_slice(1, 3, &SAME);
        let others = DMatrix::from_column_slice(1, 3, &others);
        let (potential, rotation) = (left_out(potential), left_out(rotation));
        takes_rotation(
            t,
            &Contender { actions: &actions, left_out: &potential },
            &Contender { actions: &others, left_out: &rotation },
        )
    }

    #[test]
    fn rotation_needs_a_significant_t_or_sole_prediction() {
        assert!(taken(2.6, [0.5, 0.6], ALIKE) && !taken(2.4, [0.5, 0.6], ALIKE));
        // A gain concentrated in one movement has a small t, but no other model predicts.
        assert!(taken(0.5, [-5.8, 1.0 - 4e-9], ALIKE));
        // If both predict well, prediction alone decides nothing.
        assert!(!taken(0.5, [1.0 - 1e-4, 1.0 - 1e-9], ALIKE));
        assert!(taken(0.5, [0.5, 0.5], OTHER) && !taken(0.5, [0.5, 0.2], OTHER));
    }

    /// However significant t is, a rotation that changes nothing does not count.
    #[test]
    fn rotation_that_changes_nothing_is_not_seen() {
        assert!(!taken(9.0, [0.5, 0.6], SAME));
        assert!(taken(9.0, [1.0 - 1e-6, 1.0 - 1e-9], ALIKE));
    }
}
