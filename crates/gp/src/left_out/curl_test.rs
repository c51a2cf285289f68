//! Is there a potential at all? (S12), (R5).

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::left_out::LeftOutPredictions;
use crate::left_out::comparison::{DIFFERS, LEAST_T, difference, t_of_mean};

/// Whether a model with rotation is tried beside those with a potential.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CurlTest {
    /// A Helmholtz decomposition is fitted too, and used if it predicts held-out trajectories better (R5).
    #[default]
    Fit,
    /// The policy is assumed to have a potential.
    AssumePotential,
}

/// Factor in held-out error by which a potential must be better to be kept.
const BETTER: f64 = 1.1;

/// Policies at the rows, (n, M), and what was predicted of left-out trajectories.
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

/// Smallest change of the policy by rotation, as a share of the potential's held-out error, before t counts.
const NOTICEABLE: f64 = 0.05;
/// Smallest held-out error of a potential, as a share, before prediction alone can reject it.
const UNPREDICTED: f64 = 1e-3;
/// Largest share of that error which the model with rotation may have then.
const DECISIVE: f64 = 1e-3;

/// Whether rotation is taken: seen by (S12), and not so small that what is unpredicted has other reasons; or because it
/// leaves next to nothing where the potential does not predict, whatever t is, which one movement with a large gain can
/// hold down; or by (R5) because dropping the potential changes the policy and costs less than a tenth in prediction.
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

    /// The others' actions, and how much of the first's they differ by: not at all, 4.5 %, or all.
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
    fn rotation_is_seen_by_t_or_where_it_alone_predicts() {
        assert!(taken(2.6, [0.5, 0.6], ALIKE) && !taken(2.4, [0.5, 0.6], ALIKE));
        // A gain that one movement makes most of has a small t; but nothing else predicts.
        assert!(taken(0.5, [-5.8, 1.0 - 4e-9], ALIKE));
        // Where both predict well, prediction alone decides nothing.
        assert!(!taken(0.5, [1.0 - 1e-4, 1.0 - 1e-9], ALIKE));
        assert!(taken(0.5, [0.5, 0.5], OTHER) && !taken(0.5, [0.5, 0.2], OTHER));
    }

    /// However sure t is, a rotation of nothing is none.
    #[test]
    fn rotation_that_changes_nothing_is_not_seen() {
        assert!(!taken(9.0, [0.5, 0.6], SAME));
        assert!(taken(9.0, [1.0 - 1e-6, 1.0 - 1e-9], ALIKE));
    }
}
