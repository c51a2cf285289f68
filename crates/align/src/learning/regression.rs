//! Helpers of both learners for LWPR: one length for all dimensions, and support.

use lwpr::StandardisedModel;
use motion::standard_deviation;
use nalgebra::{DMatrix, DVectorView};

/// A dimension is idle if it varies by less than this share of the one that varies most.
const IDLE: f64 = 1e-3;

/// The largest activation of a receptive field at a state, (n), for the output where it is smallest; 0 if for some
/// output no field takes part in the prediction.
pub(crate) fn support(model: &StandardisedModel, state: DVectorView<'_, f64>) -> f64 {
    let support_of = |output| {
        if model.supports(state, output) { model.predictor().max_activation(state, output) } else { 0.0 }
    };
    (0..model.n_out()).map(support_of).fold(f64::INFINITY, f64::min)
}

/// One length for all dimensions: the root mean square of the states' standard deviations, without idle dimensions; 1 if
/// nothing moves.
///
/// Distances between states are Euclidean in the alignment and in the policy's gradient; receptive fields that are round
/// in this metric are consistent with them.
pub(crate) fn spread(states: &DMatrix<f64>) -> f64 {
    let deviations: Vec<f64> = states.row_iter().map(|row| standard_deviation(row.iter().copied())).collect();
    let largest = deviations.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return 1.0;
    }
    // Relative to the largest, to avoid overflow and underflow of squares.
    let squares = deviations.iter().map(|deviation| deviation / largest).filter(|&share| share >= IDLE);
    let squares: Vec<f64> = squares.map(|share| share * share).collect();
    largest * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    #[test]
    fn spread_ignores_nearly_constant_dimensions() {
        let states = DMatrix::from_row_slice(3, 4, &[3.0, -3.0, 3.0, -3.0, 7.0, 7.0, 7.0, 7.002, 1.0, 0.0, 1.0, 0.0]);
        assert!((spread(&states) - 4.625_f64.sqrt()).abs() < 1e-15);
        assert_eq!(spread(&DMatrix::from_element(2, 5, 0.1)), 1.0);
        assert_eq!(spread(&DMatrix::zeros(2, 5)), 1.0);
    }

    proptest! {
        #[test]
        fn is_the_root_of_the_mean_variance(
            dim in 1usize..6, values in vec(-1.0..1.0, 60), shift in -10.0..10.0, exponent in -900i32..900,
        ) {
            let states = DMatrix::from_vec(dim, 10, values[..10 * dim].to_vec()).add_scalar(shift);
            let variance = states.row_iter().map(|row| row.variance()).sum::<f64>() / dim as f64;
            prop_assert!((spread(&states) / variance.sqrt() - 1.0).abs() < 1e-12);
            let unit = 2.0_f64.powi(exponent);
            prop_assert!((spread(&(&states * unit)) / unit / spread(&states) - 1.0).abs() < 1e-12);
        }
    }
}
