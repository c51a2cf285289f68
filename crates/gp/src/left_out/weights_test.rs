//! Tests whether noise weights for certain velocities improve prediction (S18).

use crate::left_out::comparison::{log_ratio, t_of_mean};

/// Minimum t of λ for using the weights.
const LEAST_T: f64 = 2.0;
/// t of λ below which a pilot shows that weights will not help.
const HOPELESS_T: f64 = -1.0;

/// Held-out errors of one model, (M), in units of speed.
pub(crate) type Errors<'a> = &'a [f64];

/// (S18): t of λ = mean_T log((E_T + εR_T)/(E'_T + εR_T)), with E_T of the model with equal weights, E'_T of the model with
/// weights, and R_T the sum of squared speeds, all computed with the same weights.
pub(crate) fn weights_t(
    (alike, weighted): (Errors<'_>, Errors<'_>),
    speeds: &[f64],
    noise_weights: &[f64],
    groups: &[Vec<usize>],
) -> f64 {
    let of_movement = |rows: &Vec<usize>| {
        let sum = |of: &[f64]| rows.iter().map(|&row| of[row].powi(2) / noise_weights[row]).sum::<f64>();
        log_ratio(sum(alike), sum(weighted), sum(speeds))
    };
    t_of_mean(&groups.iter().map(of_movement).collect::<Vec<_>>())
}

/// Whether weights improve the prediction of left-out movements by more than chance.
pub(crate) fn weights_pay(t: f64) -> bool {
    t >= LEAST_T
}

/// Whether a pilot with weights predicts so much worse that a search with them is not worthwhile.
pub(crate) fn weights_cost(t: f64) -> bool {
    t < HOPELESS_T
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The units of weights and speed do not matter, exchanging the models changes the sign, and equal models are
        /// equally good.
        #[test]
        fn t_is_invariant_to_units_and_antisymmetric(
            errors in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 0.1..2.0f64, 1e-3..9.0f64), 12),
            (unit, speed) in (0.01..100.0f64, 0.01..100.0f64),
        ) {
            let column = |of: fn(&(f64, f64, f64, f64)) -> f64| errors.iter().map(of).collect::<Vec<f64>>();
            let (a, b, r, d) = (column(|e| e.0), column(|e| e.1), column(|e| e.2), column(|e| e.3));
            let scaled = |of: &[f64], by: f64| of.iter().map(|value| value * by).collect::<Vec<f64>>();
            let groups: Vec<Vec<usize>> = (0..4).map(|k| (3 * k..3 * k + 3).collect()).collect();
            let t = weights_t((&a, &b), &r, &d, &groups);
            let elsewhere = weights_t((&scaled(&a, speed), &scaled(&b, speed)), &scaled(&r, speed), &scaled(&d, unit), &groups);
            prop_assert!((t - elsewhere).abs() <= 1e-9 * (1.0 + t.abs()), "{t} {elsewhere}");
            let back = weights_t((&b, &a), &r, &d, &groups);
            prop_assert!((t + back).abs() <= 1e-9 * (1.0 + t.abs()), "{t} {back}");
            prop_assert_eq!(weights_t((&a, &a), &r, &d, &groups), 0.0);
        }
    }

    /// A gain in every movement suffices; the same gain in only one of them does not.
    #[test]
    fn a_gain_must_be_general() {
        let groups: Vec<Vec<usize>> = (0..6).map(|row| vec![row]).collect();
        let t = |weighted: &[f64]| weights_t((&[0.5; 6], weighted), &[1.0; 6], &[1.0; 6], &groups);
        assert!(weights_pay(t(&[0.1, 0.12, 0.1, 0.11, 0.1, 0.1])));
        assert!(!weights_pay(t(&[0.001, 0.5, 0.5, 0.5, 0.5, 0.5])));
        assert!(!weights_pay(t(&[0.5; 6])));
    }
}
